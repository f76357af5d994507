"""No figure without meaning is printed: what is nothing beside the largest of its kind is 0."""

from __future__ import annotations

import re
from dataclasses import replace
from functools import cache
from types import SimpleNamespace

import numpy as np
import pytest

import equipoise as eq
from equipoise.balancing.advice import advise
from equipoise.balancing.blocks import _speeds, balanced_headline, before_after
from equipoise.balancing.comparison import FAINT as CONCERN
from equipoise.present.cells import FAINT, FAINT_IN_ROW, grid
from equipoise.quantities import PER_RPM
from equipoise.results.blocks import Column, Span, Table, Text, Value
from equipoise.results.machine_blocks import scale_of
from support.findings import findings_of

MACHINES = (
    *("hydraulic-loader", "pick-and-place", "sieve", "twin-engine", "exudyn-slider-crank"),
    *("planetary-planting-arm", "knife-drive", "yamashita-rig", "straw-walker"),
)


@cache
def tables(name: str) -> tuple[Table, ...]:
    findings = findings_of(name)
    results = (findings.analysis, findings.balanced, findings.response, findings.sweep)
    return tuple(
        block for result in results if result is not None for block in result.blocks()
        if isinstance(block, Table)
    )  # fmt: skip


@pytest.mark.parametrize("name", MACHINES)
def test_a_number_stands_beside_others_of_its_size_or_is_0(name: str) -> None:
    """Cells of a dimension, against all of their unit in the table and in the row."""
    for table in tables(name):
        shown = grid(table)
        for row in shown.rows:
            sizes = [float(cell.text) for cell in row if re.fullmatch(r"-?[\d.e+-]+", cell.text)]
            units = {head.unit for head in shown.heads if head.unit}
            if sizes and len(units) <= 1 and "," in row[0].text:  # one unit, said with the row
                faint = FAINT_IN_ROW * max(map(abs, sizes))
                assert all(size == 0 or abs(size) >= faint for size in sizes), (table.title, row)
        for text in (cell.text for row in shown.rows for cell in row):
            assert not re.search(r"e-(0[6-9]|[1-9])", text), (table.title, text)


def test_a_mean_of_rounding_is_0_and_the_json_keeps_it() -> None:
    analysis = eq.analyze(eq.load("hydraulic-loader"))
    mean = analysis.to_dict()["summary"]["shaking_force.x"]["mean"]
    assert 0 < abs(mean) < FAINT_IN_ROW * analysis.summary["shaking_force.x"].peak
    (frame,) = (
        block for block in analysis.blocks() if isinstance(block, Table) and "frame" in block.title
    )
    (row,) = (row for row in grid(frame).rows if row[0].text.startswith("shaking force x"))
    assert row[1].text == "0"


def test_work_that_comes_back_is_none() -> None:
    """A boom that is lifted and lowered without losses."""
    (work,) = (
        table for table in tables("hydraulic-loader") if table.title.startswith("Work of the")
    )
    assert [cell.text for cell in grid(work).rows[0]] == ["boom", "0"]
    analysis = eq.analyze(eq.load("quick-return"))
    both, net = analysis.forces.work_both_ways["crank"], analysis.forces.work["crank"]
    torque = analysis.forces.drive_torque
    assert both == pytest.approx(2 * np.pi * float(np.mean(np.abs(torque))), rel=1e-9)
    assert both > net > 0


def test_what_is_small_in_its_own_row_or_in_the_table_is_0() -> None:
    columns = (Column("what"), Column("mean", "force"), Column("peak", "force"))
    rows = [
        ("large", Value(2e3), Value(1e4)),
        ("tiny in the row", Value(-0.5 * FAINT_IN_ROW * 40.0), Value(40.0)),
        ("tiny in the table", Value(0.5 * FAINT * 1e4), Value(0.9 * FAINT * 1e4)),
        ("range", Span(0.3 * FAINT_IN_ROW * 50, 50.0), Value(50.0)),
        ("angle", Value(5.0, at=0.0), Value(5.0)),
    ]
    texts = [[cell.text for cell in row[1:]] for row in grid(Table.of("", columns, rows)).rows]
    assert texts[1] == ["0", "40.00"] and texts[2] == ["0", "0"]
    assert texts[3] == ["0 to 50.00", "50.00"]
    assert grid(Table.of("", columns, rows)).rows[4][1].at == "0.0"
    loose = (columns[0], replace(columns[1], alike=False), columns[2])
    assert grid(Table.of("", loose, rows[:2])).rows[1][1].text != "0"


def test_a_crank_turns_fully_and_a_rocker_from_one_angle_to_another() -> None:
    for name, turning, swinging in (
        ("planetary-planting-arm", {"carrier", "idler", "planet"}, set()),
        ("four-stroke-engine", {"crank"}, {"rod", "piston"}),
    ):
        analysis = eq.analyze(eq.load(name))
        (table,) = (block for block in analysis.blocks() if isinstance(block, Table)
                    and block.title.startswith("Links:"))  # fmt: skip
        texts = {row[0].text: row[1].text for row in grid(table).rows}
        assert {link for link, text in texts.items() if text == "turns fully"} == turning
        assert swinging <= texts.keys()
    part = eq.analyze(eq.load("four-stroke-engine"), np.radians([0.0, 90.0]).tolist())
    assert "turns fully" not in str([*part.blocks()])


def test_only_speeds_that_say_something_are_reported() -> None:
    """A machine of which next to nothing is left shakes as before at millions of rpm."""
    machine = eq.load("yamashita-1")
    own = machine.drive.speed
    speeds = {"shaking_force.rms": 1.4 * own, "shaking_moment.rms": 6.101e6 * PER_RPM}
    result = SimpleNamespace(original=machine, equivalent_speeds=speeds)
    assert [(str(row[0]), row[1]) for row in _speeds(result)] == [
        ("shaking force, RMS", Value(1.4 * own))
    ]


@pytest.mark.parametrize(("grown", "concern"), [(0.5, False), (2.0, True)])
def test_a_grown_figure_stands_out_only_beside_what_matters(grown: float, concern: bool) -> None:
    """0.18 N in a joint without force before, beside 10 kN, is nobody's concern."""
    balanced = findings_of("yamashita-1").balanced
    assert balanced is not None
    name = next(
        item for item in balanced.before if item.startswith("joints.") and item.endswith(".peak")
    )
    largest = 1e4
    before = {**balanced.before, name: 0.0, "shaking_force.peak": largest}
    after = {**balanced.after, name: grown * CONCERN * largest, "shaking_force.peak": largest}
    like = SimpleNamespace(before=before, after=after, original=balanced.original)
    table = before_after(like)
    cells = [cell for row in table.rows for cell in row if isinstance(cell, Value)]
    (cell,) = (item for item in cells if item.value == after[name])
    assert (cell.emphasis == "worse") is concern


PUNCH = """
schema = 1
title = "punch"
[drive]
link = "camshaft"
speed = "300 rpm"
[frame]
points.O = ["0 mm", "0 mm"]
points.S = ["0 mm", "-120 mm"]
[links.camshaft]
points.O = ["0 mm", "0 mm"]
mass = "3 kg"
center_of_mass = ["0 mm", "0 mm"]
inertia = "4000 kg mm^2"
[links.punch]
points.R = ["0 mm", "0 mm"]
points.F = ["30 mm", "0 mm"]
points.T = ["180 mm", "0 mm"]
mass = "1.8 kg"
center_of_mass = ["80 mm", "0 mm"]
inertia = "6000 kg mm^2"
section = { between = ["R", "T"], diameter = "14 mm", elastic_modulus = "206 GPa" }
[[sliders]]
link = "punch"
point = "R"
on = "frame"
through = "O"
direction = "-90 deg"
[[cams]]
cam = "camshaft"
follower = "punch"
rides = "roller"
point = "R"
closed_by = "spring"
base_radius = "30 mm"
roller_radius = "10 mm"
[cams.lift]
segments = [
  { over = "180 deg", to = "20 mm", law = "modified sine" },
  { over = "180 deg", to = "0 mm", law = "modified sine" },
]
[[springs]]
link = "punch"
point = "F"
to = "S"
stiffness = "8 N/mm"
free_length = "60 mm"
"""


def test_moments_of_forces_along_one_line_are_0_in_the_usual_unit() -> None:
    """All forces on a punch are along its line: what is left of moments is rounding of them."""
    tables = {block.title: grid(block) for block in eq.analyze(eq.loads(PUNCH)).blocks()
              if isinstance(block, Table)}  # fmt: skip
    for title, label in (
        ("Loads along links, largest", "bending moment"),
        ("Force in each joint; largest with its crank angle", "moment"),
    ):
        table = tables[title]
        (place,) = (k for k, head in enumerate(table.heads) if head.label == label)
        assert table.heads[place].unit == "N m"
        assert {row[place].text for row in table.rows} <= {"0", ""}


def test_rounding_of_a_total_is_rounding_beside_the_largest_force_in_a_joint() -> None:
    """Forces of joints that cancel on the frame leave rounding of themselves there."""
    analysis = eq.analyze(eq.loads(PUNCH))
    contacts = analysis.forces.solved.contacts.values()
    largest = max(float(np.max(contact.size)) for contact in contacts)
    assert scale_of(analysis, "force") >= largest
    assert scale_of(analysis, "torque") >= 0.18 * largest > analysis.summary["frame_moment"].peak


def test_balance_names_the_preload_that_holds_a_follower() -> None:
    """Where masses are best left, the first page has what holds it; nothing where all is held."""
    slow = eq.loads(PUNCH)
    spoken = []
    for speed in (1.0, 4.0):
        machine = slow.with_drive(speed=speed * slow.drive.speed)
        balanced = advise(machine)
        texts = [block.text for block in balanced_headline(balanced, alone=True)
                 if isinstance(block, Text)]  # fmt: skip
        spoken.append([text for text in texts if text.startswith("A preload of")])
    slowly, (line,) = spoken
    assert slowly == []
    assert line.endswith("of the spring from F to S just holds punch on camshaft at 1200 rpm.")


def test_balance_names_the_preload_beside_a_change_that_is_offered() -> None:
    """Of a camshaft out of balance, whose counterweight does not hold the follower."""
    at = 'center_of_mass = ["{} mm", "0 mm"]'
    machine = eq.loads(PUNCH.replace(at.format(0), at.format(20)))
    balanced = advise(machine.with_drive(speed=4 * machine.drive.speed))
    assert balanced.helps
    texts = [block.text for block in balanced_headline(balanced, alone=True)
             if isinstance(block, Text)]  # fmt: skip
    (line,) = (text for text in texts if text.startswith("A preload of"))
    assert line.endswith("just holds punch on camshaft at 1200 rpm.")
