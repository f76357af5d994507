"""Forces in the line between two points, over the crank angle and over the time of a run: against
springs of the same force at every length, and against the change of the distance.
"""

from __future__ import annotations

import shutil
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import equipoise as eq
from equipoise.codegen.batch import Batch
from equipoise.codegen.figures import Figure
from equipoise.errors import ModelError
from equipoise.mechanism import LinkSection, Load, LoadTable, Machine, Spring, TimedLoad
from equipoise.mechanism.dynamics import assessment
from equipoise.mechanism.dynamics.loads import work_in_cycle
from equipoise.results.machine_blocks import model_blocks
from equipoise.schema.writing import Writer, toml_text
from support.own_kinds import drawn, scripted
from support.refusals import refused
from support.sentences import notes_by

PULL = 35.0
MORE_POINTS = {"coupler": {"Q": (0.07, 0.11)}, "crank": {"R": (-0.05, 0.02)}}
BASE = replace(eq.load("yamashita-1"), balance=None)
BASE = replace(BASE, frame={**BASE.frame, "S": (0.1, 0.6)})
BASE = replace(BASE, links={
    name: replace(link, points={**link.points, **MORE_POINTS.get(name, {})})
    for name, link in BASE.links.items()
})  # fmt: skip
TO_FRAME = Load("coupler", "Q", (PULL, 0.0), toward="S", reaction="frame")
TO_CRANK = replace(TO_FRAME, toward="R", reaction="crank")
TABLE = LoadTable((0.0, 1.0, 2.5, 4.0), ((0.0, 60.0, -20.0, 0.0), (0.0,) * 4))
BY_ANGLE = Load("coupler", "Q", table=TABLE, outside="zero", toward="R", reaction="crank")


def loaded(*loads: Load) -> Machine:
    return replace(BASE, loads=loads)


def same_spring(load: Load) -> Machine:
    """The machine with a spring that has the force of the load at every length."""
    spring = Spring("coupler", "Q", load.toward or "", on=load.reaction or "",
                    lengths=(0.0, 10.0), forces=(PULL, PULL))  # fmt: skip
    return replace(BASE, springs=(spring,))


@pytest.mark.parametrize("load", [TO_FRAME, TO_CRANK])
def test_a_constant_force_is_a_spring_of_that_force(load: Load) -> None:
    """Joint forces, torque, stress along a link with a section, and a run."""
    section = LinkSection(between=("B", "Q"), width=0.02, height=0.03)
    with_load, with_spring = (
        eq.analyze(machine.with_link("coupler", section=section), 90)
        for machine in (loaded(load), same_spring(load))
    )
    for name, figures in with_load.summary.items():
        assert with_spring.summary[name].peak == pytest.approx(figures.peak, rel=1e-9, abs=1e-9)
    assert "links.coupler.stress" in with_load.summary
    runs = [eq.run(machine, "0.3 s", speed=8.0) for machine in (loaded(load), same_spring(load))]
    assert runs[0].crank_speed[-1] == pytest.approx(runs[1].crank_speed[-1], rel=1e-9)
    assert runs[0].crank_speed[-1] != pytest.approx(8.0, rel=1e-3)


def test_a_force_over_the_crank_angle_gives_its_power_to_the_drive() -> None:
    """Less force times the change of the distance for each angle, by differences; and its work in
    a cycle is the mean of that.
    """
    actual, bare = (eq.analyze(loaded(*loads), 720) for loads in ((BY_ANGLE,), ()))
    motion = actual.motion
    apart = np.abs(motion.point("R").place - motion.point("Q").place)
    around = np.concatenate([apart[-3:], apart, apart[:3]])
    weights = np.array([-1, 9, -45, 0, 45, -9, 1]) / 60  # differences of sixth order
    rate = np.convolve(around, weights[::-1], "valid") / (2 * np.pi / 720)
    columns = (TABLE.crank_angle, TABLE.values[0])
    wanted = np.interp(motion.crank_angle, *columns, left=0.0, right=0.0) * rate
    added = actual.forces.drive_torque - bare.forces.drive_torque
    np.testing.assert_allclose(added, wanted, atol=1e-8 * np.max(np.abs(wanted)))
    work = work_in_cycle(loaded(BY_ANGLE), BY_ANGLE)
    # to what a sum over 720 angles makes of the bends of the table
    assert work.net == pytest.approx(-2 * np.pi * np.mean(wanted), abs=1e-4 * work.both)


def test_a_force_over_time_is_the_constant_one_while_its_factor_is_1() -> None:
    timed = TimedLoad("coupler", (0.0, 1.0), (1.0, 1.0), point="Q", on="crank", force=(PULL, 0.0),
                      toward="R")  # fmt: skip
    run = eq.run(replace(BASE, timed_loads=(timed,)), "0.3 s", speed=8.0)
    wanted = eq.run(loaded(TO_CRANK), "0.3 s", speed=8.0)
    assert run.crank_speed[-1] == pytest.approx(wanted.crank_speed[-1], rel=1e-9)
    assert run.energy_error < 1e-9 and abs(run.work["timed_loads"][-1]) > 0.01


def test_loops_and_scripts_have_it(tmp_path: Path) -> None:
    """Of designs with other points, too."""
    machine, names = loaded(TO_FRAME, BY_ANGLE), ("drive_torque", "joints.B", "frame_force")
    batch = Batch(
        machine, ["links.crank.points.R.x"], [Figure(n, "peak") for n in names], angles=90
    )
    figures, reason = batch(np.array([[-0.05], [0.02]]))
    assert not reason.any()
    for row, x in zip(figures, (-0.05, 0.02), strict=True):
        crank = machine.links["crank"]
        other = machine.with_link("crank", points={**crank.points, "R": (x, crank.points["R"][1])})
        summary = eq.analyze(other, 90).summary
        np.testing.assert_allclose(row, [summary[name].peak for name in names], rtol=1e-9)
    if shutil.which("node") is not None:
        scripted(machine, ["drive_torque", "joints.B"], tmp_path)


def test_it_is_written_read_said_and_exported(tmp_path: Path) -> None:
    machine = loaded(TO_FRAME, TO_CRANK)
    text = toml_text(Machine, Writer({}).content(Machine, machine))
    assert eq.loads(text) == machine
    assert not notes_by(assessment.questions, eq.analyze(machine, 12).notes, point="S")
    assert "from Q of coupler towards S" in "\n".join(map(str, model_blocks(machine)))
    assert not any("load" in str(note) for note in eq.export(machine, tmp_path / "model.mo"))
    assert "sqrt(" in (tmp_path / "model.mo").read_text()
    for name in ("model.xml", "model.py"):
        assert not eq.export(machine, tmp_path / name)


def test_drawings_have_its_line() -> None:
    scene, shapes = drawn(loaded(TO_FRAME, BY_ANGLE), "pull")
    assert len(shapes) == 2 and len(drawn(loaded(TO_FRAME), "pull-head")[1]) == 2
    assert {("Q", "S"), ("Q", "R")} <= set(scene.stretched)


@pytest.mark.parametrize(
    ("place", "changes"),
    [
        ("toward", {"toward": "SS"}),
        ("toward", {"toward": "A", "reaction": "crank", "point": "B"}),
        ("toward", {"toward": "SS", "reaction": None}),
        ("axes", {"axes": "link"}),
        ("toward", {"point": None, "force": None, "torque": 2.0}),
        ("force", {"force": (PULL, 1.0)}),
        ("table", {"force": None, "table": LoadTable((0.0, 1.0), ((PULL, PULL), (0.0, 1.0)))}),
    ],
)
def test_what_is_wrong_is_said(place: str, changes: dict[str, Any]) -> None:
    with refused(ModelError, f"loads[1].{place}"):
        loaded(replace(TO_FRAME, **changes))


def test_the_body_that_bears_the_opposite_is_proposed() -> None:
    with refused(ModelError, "loads[1].reaction", example='reaction = "frame"'):
        loaded(replace(TO_FRAME, reaction=None))


def test_points_that_meet_have_no_line() -> None:
    start = complex(eq.move(BASE, [0.0]).point("Q").place[0])
    frame = {**BASE.frame, "S": (start.real, start.imag)}
    with refused(ModelError, "loads[1]"):
        eq.analyze(replace(loaded(TO_FRAME), frame=frame), 90)
