"""Resistances: what they do against the motion, in analyses, loops, scripts and runs."""

from __future__ import annotations

import shutil
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import equipoise as eq
from equipoise.errors import ModelError
from equipoise.exchange.export import export
from equipoise.mechanism import Machine, Resistance, ResistanceTable
from equipoise.schema.writing import Writer, toml_text
from support.own_kinds import (
    crank_rocker_with,
    designs_by_numbers,
    drawn,
    on_the_page,
    read_back,
    scripted,
)
from support.refusals import refused
from surface.running import example_text

ANY_WAY = Resistance("coupler", "Q", "S", force=25.0, damping=8.0, speed=0.05)
ON_LINK = Resistance(
    "rocker", "F", "Q", on="coupler", direction=0.5, one_way=True,
    positions=(-0.03, 0.0, 0.04), forces=(0.0, 60.0, 10.0), damping=3.0, speed=0.03,
)  # fmt: skip


def resisted(*resistances: Resistance) -> Machine:
    """A crank-rocker whose links are resisted."""
    return crank_rocker_with(resistances=resistances)


MACHINE = resisted(ANY_WAY, ON_LINK)


def test_its_law_by_places_and_their_differences() -> None:
    """Places in the axes of the other body, velocities by differences of these."""
    analysis = eq.analyze(MACHINE, 360)
    theta, step = analysis.motion.crank_angle, 1e-6

    def place(at: Any, item: Resistance) -> Any:
        motion = eq.move(MACHINE, at)
        turned = 0.0 if item.on == "frame" else motion.links[item.on].angle
        apart = motion.point(item.point).place - motion.point(item.to).place
        return apart * np.exp(-1j * (turned + (item.direction or 0.0)))

    speeds = [
        (place(theta + step, resistance) - place(theta - step, resistance))
        / (2 * step)
        * analysis.motion.speed
        for resistance in MACHINE.resistances
    ]
    free = np.abs(speeds[0])
    sizes = [25.0 * free / np.hypot(free, 0.05) + 8.0 * free]
    x, forward = place(theta, ON_LINK).real, np.maximum(speeds[1].real, 0.0)
    rows = np.interp(x, ON_LINK.positions, ON_LINK.forces)
    sizes.append(rows * forward / np.hypot(forward, 0.03) + 3.0 * forward)
    assert 0 < np.sum(forward > 0) < 360
    for number, wanted in enumerate(sizes):
        values = analysis.motion.element_values("resistances", number)
        size = np.max(wanted)
        np.testing.assert_allclose(values["force"], wanted, atol=1e-6 * size)
        way = free if number == 0 else speeds[1].real
        np.testing.assert_allclose(values["speed"], way, atol=1e-6 * np.max(free))
        loss = wanted * (free if number == 0 else forward)
        np.testing.assert_allclose(values["loss"], loss, atol=1e-6 * size * np.max(np.abs(way)))


def test_the_drive_gives_what_they_take_and_the_frame_bears_nothing_more() -> None:
    """Moments on a turning body included: power is balanced at every instant."""
    actual, bare = (eq.analyze(item, 360) for item in (MACHINE, resisted()))
    loss = sum(actual.motion.element_values("resistances", number)["loss"] for number in range(2))
    power = actual.forces.power - bare.forces.power
    assert np.max(loss) > 1.0 and np.min(loss) >= 0.0
    np.testing.assert_allclose(power, loss, atol=1e-11 * np.max(loss))
    frame, wanted = (item.forces.frame_force.value for item in (actual, bare))
    np.testing.assert_allclose(frame, wanted, atol=1e-8)


def shear(*resistances: Resistance) -> Machine:
    """A slider-crank with a crank of 60 mm: a blade with a stroke of 120 mm."""
    crank = eq.Link({"A": (0.0, 0.0), "B": (0.06, 0.0)}, 4.0, (0.0, 0.0), 0.9)
    rod = eq.Link({"B": (0.0, 0.0), "C": (0.25, 0.0)}, 1.2, (0.1, 0.0), 0.01)
    blade = eq.Link({"C": (0.0, 0.0)}, 6.0, (0.0, 0.0), 0.05)
    return eq.Machine(
        "shear", eq.Drive("crank", 8.0), {"A": (0.0, 0.0), "S": (0.27, 0.0)},
        {"crank": crank, "rod": rod, "blade": blade}, assembly={"C": "forward"},
        sliders=(eq.mechanism.Slider("blade", "C", "frame", "A", 0.0),),
        gravity=(0.0, 0.0), resistances=resistances,
    )  # fmt: skip


CUT = Resistance("blade", "C", "S", direction=0.0, one_way=True, positions=(0.0, 0.004, 0.02),
                 forces=(0.0, 3000.0, 0.0), speed=1e-4)  # fmt: skip
RUBBED = Resistance("blade", "C", "S", direction=0.0, force=40.0, speed=1e-4)


def test_a_cut_takes_the_area_below_its_force_and_dry_friction_twice_the_stroke() -> None:
    """Known answers as the speed at which the sense changes vanishes beside that of the blade."""
    works = []
    for machine in (shear(), shear(CUT), shear(RUBBED)):
        analysis = eq.analyze(machine, 7200)
        works.append(2 * np.pi * analysis.motion.mean(analysis.forces.drive_torque))
    # rows are kinks and turning back is steep: to some 1e-5 by a sum over 7200 angles
    assert works[1] - works[0] == pytest.approx(0.5 * 3000.0 * 0.02, rel=1e-4)
    assert works[2] - works[0] == pytest.approx(2 * 0.12 * 40.0, rel=1e-4)


def test_a_table_is_the_same_as_its_lists(tmp_path: Path) -> None:
    """Read from CSV in any units, written again, and refused where it is wrong."""
    listed = replace(CUT, speed=1e-3)
    file = tmp_path / "cut.toml"
    text = toml_text(Machine, Writer({}).content(Machine, shear(listed)))
    lists = 'positions = ["0 mm", "4 mm", "20 mm"]\nforces = ["0 N", "3000 N", "0 N"]\n'
    assert lists in text
    file.write_text(text.replace(lists, 'table = "cut.csv"\n'), encoding="utf-8")
    rows = tmp_path / "cut.csv"
    rows.write_text("position [cm],force [kN]\n0,0\n0.4,3\n2,0\n", encoding="utf-8")
    machine = eq.load(file)
    actual, wanted = (eq.analyze(item, 90).forces for item in (machine, shear(listed)))
    np.testing.assert_allclose(actual.drive_torque, wanted.drive_torque, rtol=1e-13, atol=1e-13)
    eq.save(machine, tmp_path / "again.toml")
    assert eq.load(tmp_path / "again.toml").resistances == machine.resistances
    rows.write_text("position [cm],force [kN]\n0,0\n0.4,-3\n", encoding="utf-8")
    with refused(ModelError, "resistances[1].table"):
        eq.load(file)


def test_a_run_loses_the_work_of_cuts() -> None:
    """A crank that coasts through one cut: its energy falls by the area below the force."""
    run = eq.run(shear(replace(CUT, speed=1e-3)), "0.6 s", speed=12.0)
    turns = (run.crank_angle[-1] - run.crank_angle[0]) / (2 * np.pi)
    assert 0.9 < turns < 1.5  # it cuts in the last quarter of a turn
    assert run.work["resistances"][-1] == pytest.approx(-30.0, rel=1e-4)
    assert run.energy_error < 1e-9


def wheel(**parts: Any) -> eq.Machine:
    """A wheel whose rim is rubbed by 4 N at 0.3 m."""
    link = eq.Link({"A": (0.0, 0.0), "B": (0.3, 0.0)}, 2.0, (0.0, 0.0), 0.05)
    rim = Resistance("wheel", "B", "A", force=4.0, speed=1.0)
    return eq.Machine("wheel", eq.Drive("wheel", 20.0), {"A": (0.0, 0.0)}, {"wheel": link},
                      gravity=(0.0, 0.0), resistances=(rim,), **parts)  # fmt: skip


def test_a_run_against_a_dry_force_alone_slows_as_by_constant_torque_and_stands_still() -> None:
    """Speed falls by force times radius over inertia, however near to rest."""
    run = eq.run(wheel(), speed=20.0)
    slows = 4.0 * 0.3 / 0.05
    np.testing.assert_allclose(run.crank_speed, 20.0 - slows * run.time, atol=1e-9)
    assert run.end.kind == "standstill" and run.energy_error < 1e-9
    assert run.end.time == pytest.approx(20.0 / slows, rel=1e-9)
    assert run.end.crank_angle == pytest.approx(20.0**2 / (2 * slows), rel=1e-9)


@pytest.mark.parametrize(("share", "moves"), [(0.999, False), (1.001, True), (-0.999, False)])
def test_a_dry_force_holds_a_crank_up_to_its_size(share: float, moves: bool) -> None:
    load = eq.Load("wheel", torque=share * 4.0 * 0.3)
    run = eq.run(wheel(loads=(load,)), "1 s", speed=0.0)
    assert (run.end.kind == "time") == moves
    if moves:
        assert run.end.crank_angle == pytest.approx(0.001 * 4.0 * 0.3 / 0.05 / 2, rel=1e-6)
    else:
        assert (run.end.kind, run.turned) == ("standstill", 0.0)


def test_what_cuts_one_way_holds_one_way() -> None:
    """The rim at crank angle 0 moves along y: up is resisted, and down is free."""
    machine = replace(
        wheel(),
        resistances=(
            Resistance("wheel", "B", "A", direction=np.pi / 2, one_way=True, force=4.0, speed=1.0),
        ),
    )
    up, down = (
        eq.run(replace(machine, loads=(eq.Load("wheel", torque=torque),)), "0.1 s", speed=0.0)
        for torque in (1.0, -1.0)
    )
    assert up.end.kind == "standstill" and up.turned == 0.0
    assert down.end.crank_angle == pytest.approx(-1.0 / 0.05 * 0.1**2 / 2, rel=1e-8)


def test_a_coasting_machine_loses_force_times_way_until_it_stands_still() -> None:
    """The way of the blade, by sums of its places at crank angles between start and end."""
    run = eq.run(shear(replace(RUBBED, speed=0.1)), speed=12.0, angle=0.3)
    assert run.end.kind == "standstill" and run.energy_error < 1e-9
    angles = np.linspace(0.3, run.end.crank_angle, 200_001)
    way = np.sum(np.abs(np.diff(eq.move(shear(), angles).points["C"].x)))
    assert run.work["resistances"][-1] == pytest.approx(-40.0 * way, rel=1e-8)
    assert 2.0 < run.turned < 200.0


# Resistances in a turn: the other tests of this file.
@pytest.mark.exhaustive
def test_the_cutter_bar_of_the_examples() -> None:
    """A turn costs twice the area below the cut's force, and the guide's over twice the stroke, to
    what the speed of a steady state may differ by.  Later friction holds the bar.
    """
    machine = eq.load("cutter-bar")
    cycle = eq.run(replace(machine, run=None)).last_cycle
    stroke = np.ptp(eq.move(machine, np.linspace(0, 2 * np.pi, 20_001)).points["C"].x)
    assert cycle is not None
    wanted = 2 * 620.0 * (0.016 + 0.014) + 2 * 70.0 * stroke
    assert cycle.energy_per_turn == pytest.approx(wanted, rel=1e-5)
    run = eq.run(machine)
    acting, holding = run.equation.at_rest(run.end.crank_angle)
    assert run.end.kind == "standstill" and run.stopping is not None
    assert abs(acting) < holding[np.copysign(1.0, acting)]


def test_it_is_read_written_and_refused() -> None:
    rows = '[[resistances]]\nlink = "coupler"\npoint = "Q"\nto = "S"\n'
    read_back(MACHINE, "resistances", rows, ("coupler", "couplr"),
              "resistances[1].link", "coupler")  # fmt: skip


def test_loops_and_scripts_have_them(tmp_path: Path) -> None:
    def alone(force: float, damping: float, first: float) -> Machine | None:
        moved = replace(ON_LINK, positions=(first, *ON_LINK.positions[1:]))
        if force < 0 or first > 0:
            return None
        return resisted(replace(ANY_WAY, force=force, damping=damping), moved)

    names = ("drive_torque", "joints.C", "resistances.1.force", "resistances.2.loss")
    paths = ["resistances[1].force", "resistances[1].damping", "resistances[2].positions[1]"]
    sizes = [(25.0, 8.0, -0.03), (60.0, 0.0, -0.01), (-1.0, 1.0, -0.03), (5.0, 1.0, 0.01)]
    designs_by_numbers(MACHINE, paths, names, sizes, alone)
    if shutil.which("node") is not None:
        wanted = ["drive_torque", "resistances.1.force", "resistances.2.loss"]
        scripted(MACHINE, wanted, tmp_path)


def test_drawings_and_the_page_have_them() -> None:
    assert len(drawn(MACHINE, "resistance")[1]) == 5
    first = replace(ON_LINK, on="frame", to="S")
    keys = ["link", "point", "to", "on", "direction", "one_way", "force", "damping", "positions",
            "forces", "table", "speed"]  # fmt: skip
    on_the_page(resisted(replace(first, force=3.0)), "resistances", keys, ["force", "direction"])


def test_formats_without_them_leave_them_out(tmp_path: Path) -> None:
    assert "resistances" in export(MACHINE, tmp_path / "mine", "urdf")


def test_an_example_of_what_is_missing_names_a_point_of_the_file() -> None:
    text = example_text("spring-balanced-crank")
    missing = '[[resistances]]\nlink = "rocker"\npoint = "C"\non = "crank"\nforce = "2 N"\n'
    with refused(ModelError, "resistances[1].to", example='to = "B"'):
        eq.loads(text + missing)


@pytest.mark.parametrize(
    "points", ['points.A = ["0 mm", "0 mm"]\npoints.U = ["9 mm", "0 mm"]', 'points = ["U", "V"]']
)
def test_an_example_of_a_point_is_one_that_moves(points: str) -> None:
    text = f"""
schema = 1
title = "arm"
drive = {{ link = "arm", speed = "1 rpm" }}
frame.points.A = ["0 mm", "0 mm"]
[links.arm]
{points}
[[springs]]
link = "arm"
"""
    with refused(ModelError, "springs[1].point", example='point = "U"'):
        eq.loads(text)


WRONG: list[tuple[dict[str, Any], dict[str, Any]]] = [
    ({"on": "rocker"}, {"place": "resistances[1].on", "link": "rocker"}),
    ({"point": "Q"}, {"place": "resistances[1].point", "given": "Q", "body": "rocker"}),
    ({"to": "X"}, {"place": "resistances[1].to", "given": "X", "body": "coupler"}),
    ({"force": -1.0}, {"place": "resistances[1].force", "text": "-1 N"}),
    ({"speed": None}, {"place": "resistances[1].speed"}),
    ({"direction": None}, {"place": "resistances[1].direction"}),
    ({"positions": (), "forces": (), "damping": None}, {"place": "resistances[1]"}),
    ({"table": ResistanceTable((0.0, 0.1), (1.0, 2.0))}, {"place": "resistances[1].table"}),
    (
        {"forces": (1.0, 2.0)},
        {
            "place": "resistances[1].positions",
            "places": "positions",
            "others": 2,
            "values": "forces",
            "count": 3,
        },
    ),
    ({"positions": (0.0, -0.1, 0.2)}, {"place": "resistances[1].positions", "what": "positions"}),
    ({"forces": (0.0, -5.0, 1.0)}, {"place": "resistances[1].forces"}),
]


@pytest.mark.parametrize(("changes", "expected"), WRONG)
def test_what_is_wrong_is_said(changes: dict[str, Any], expected: dict[str, Any]) -> None:
    with refused(ModelError, **expected):
        resisted(replace(ON_LINK, **changes))
