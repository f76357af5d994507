"""Loads in the axes of a link and along a slider: what they do, in analyses, loops, scripts, runs
and files of other programs.
"""

from __future__ import annotations

import shutil
from dataclasses import replace
from pathlib import Path
from typing import Any

import mujoco
import numpy as np
import pytest

import equipoise as eq
from equipoise.codegen.batch import Batch
from equipoise.codegen.figures import Figure
from equipoise.errors import ModelError
from equipoise.mechanism import Load, LoadTable, Machine
from equipoise.mechanism.dynamics.loads import work_in_cycle
from equipoise.results.machine_blocks import model_blocks
from equipoise.schema.writing import Writer, toml_text
from support.own_kinds import scripted
from support.refusals import refused

RADIUS, PUSH = 0.3, 40.0
ANGLES = 2 * np.pi * np.arange(13) / 12


def wheel(*loads: Load) -> Machine:
    """A link that turns about its centre of mass, without weight."""
    link = eq.Link({"A": (0.0, 0.0), "B": (RADIUS, 0.0)}, 2.0, (0.0, 0.0), 0.05)
    return eq.Machine("wheel", eq.Drive("wheel", 3.0), {"A": (0.0, 0.0)}, {"wheel": link},
                      gravity=(0.0, 0.0), loads=loads)  # fmt: skip


def shaper(*loads: Load) -> Machine:
    """A crank whose block slides in a lever that swings."""
    return replace(eq.load("quick-return"), loads=loads)


TANGENTIAL = Load("wheel", "B", (0.0, PUSH), axes="link")
IN_LEVER = Load("block", "B", (PUSH, 15.0), axes="slider")
CUT = LoadTable((0.0, 1.0, 2.0), ((0.0, 90.0, 0.0), (5.0, 0.0, 5.0)))
ON_ROD = Load("connecting-link", "F", table=CUT, outside="zero", axes="link")
MACHINE = shaper(IN_LEVER, ON_ROD)


def test_a_force_that_turns_with_its_link_is_a_torque() -> None:
    """Tangential at a radius: the same torque at every angle, and its work in a turn; the pin
    bears what turns with the link.
    """
    machine = wheel(TANGENTIAL)
    analysis = eq.analyze(machine, 36)
    np.testing.assert_allclose(analysis.forces.drive_torque, -RADIUS * PUSH, rtol=1e-14)
    work = work_in_cycle(machine, TANGENTIAL)
    assert work.net == pytest.approx(2 * np.pi * RADIUS * PUSH, rel=1e-14)
    assert work.both == pytest.approx(work.net, rel=1e-14) and work.largest == PUSH
    turn = np.exp(1j * analysis.motion.crank_angle)
    wanted = 1j * PUSH * turn  # the frame bears the force, and a wheel in balance adds nothing
    np.testing.assert_allclose(analysis.forces.frame_force.value, wanted, atol=1e-12 * PUSH)


def test_a_run_gets_the_work_of_a_force_that_turns() -> None:
    """From rest by a constant torque: speed after a time is torque over inertia times the time."""
    run = eq.run(wheel(TANGENTIAL), "0.4 s", speed=0.0)
    assert run.crank_speed[-1] == pytest.approx(RADIUS * PUSH / 0.05 * 0.4, rel=1e-9)
    assert run.energy_error < 1e-9


def test_a_force_along_a_guide_that_swings_has_its_power() -> None:
    """In directions of the guide, by points of the lever, and with velocities by differences."""
    actual, bare = (eq.analyze(item, 720) for item in (shaper(IN_LEVER), shaper()))
    motion = actual.motion
    lever = motion.point("E").place - motion.point("D").place
    force = complex(*IN_LEVER.force) * lever / np.abs(lever)
    around = np.concatenate([motion.point("B").place[-3:], motion.point("B").place,
                             motion.point("B").place[:3]])  # fmt: skip
    weights = np.array([-1, 9, -45, 0, 45, -9, 1]) / 60  # differences of sixth order
    rate = np.convolve(around, weights[::-1], "valid") / (2 * np.pi / 720) * motion.speed
    power = (np.conj(force) * rate).real
    added = bare.forces.power - actual.forces.power
    assert np.max(np.abs(power)) > 1.0
    np.testing.assert_allclose(added, power, atol=1e-9 * np.max(np.abs(power)))
    borne = actual.forces.frame_force.value - bare.forces.frame_force.value
    np.testing.assert_allclose(borne, force, atol=1e-10 * PUSH)


def test_the_sum_of_works_is_the_mean_torque_and_a_run_keeps_its_energy() -> None:
    actual, bare = eq.analyze(MACHINE, 720), eq.analyze(shaper(), 720)
    work = sum(work_in_cycle(MACHINE, load).net for load in MACHINE.loads)
    mean = actual.motion.mean(actual.forces.drive_torque)
    none = bare.motion.mean(bare.forces.drive_torque)
    assert abs(work) > 1.0
    # to what a sum over 720 angles makes of the bends of a table
    assert 2 * np.pi * (none - mean) == pytest.approx(work, rel=5e-5)
    run = eq.run(MACHINE, "1 s", speed=6.0)
    assert run.energy_error < 1e-9 and abs(run.work["loads"][-1]) > 0.5


def test_the_frame_bears_the_opposite_where_it_is_the_reaction() -> None:
    """A cylinder's head: nothing of the load shakes the frame, whatever its axes."""
    inner = replace(IN_LEVER, reaction="frame")
    actual, bare, outer = (eq.analyze(shaper(*loads), 90) for loads in ((inner,), (), (IN_LEVER,)))
    frame = bare.forces.frame_force.value
    np.testing.assert_allclose(actual.forces.frame_force.value, frame, atol=1e-9)
    np.testing.assert_allclose(actual.forces.drive_torque, outer.forces.drive_torque, rtol=1e-12)


def test_gas_over_two_turns_drives_the_crank_and_does_not_shake_the_frame() -> None:
    """An indicator diagram by the crank angle, whose reaction the cylinder's head bears: the mean
    power is its work in two turns, the pins bear it, and the frame as a whole bears nothing of it.
    """
    machine = replace(eq.load("four-stroke-engine"), balance=None)
    analysis = eq.analyze(machine)
    assert analysis.motion.turns == 2
    bare = eq.analyze(replace(machine, loads=()), analysis.motion.crank_angle)
    work = work_in_cycle(machine, machine.loads[0]).net
    mean = analysis.motion.mean(analysis.forces.drive_torque)
    # to what a sum over 360 angles a turn makes of the bends of its table
    assert 4 * np.pi * mean == pytest.approx(-work, rel=1e-4)
    force, moment = bare.forces.frame_force.value, bare.forces.frame_moment
    size = np.max(np.abs(analysis.forces.joints["A"].value))
    assert size > 10 * np.max(np.abs(force))
    np.testing.assert_allclose(analysis.forces.frame_force.value, force, atol=1e-12 * size)
    np.testing.assert_allclose(analysis.forces.frame_moment, moment, atol=1e-12 * size)


def test_loops_and_scripts_have_them(tmp_path: Path) -> None:
    """Of designs whose guides have other directions, too."""
    names = ("drive_torque", "joints.E", "frame_force")
    paths = ["sliders[1].angle", "links.lever.points.E.x"]
    sizes = [(0.0, 0.38), (0.3, 0.36), (-1.2, 0.4)]
    batch = Batch(MACHINE, paths, [Figure(name, "peak") for name in names], angles=90)
    figures, reason = batch(np.array(sizes))
    assert not reason.any()
    for row, (angle, x) in zip(figures, sizes, strict=True):
        guide, *others = MACHINE.sliders
        lever = MACHINE.links["lever"]
        made = replace(
            MACHINE,
            sliders=(replace(guide, angle=angle), *others),
            links={
                **MACHINE.links,
                "lever": replace(lever, points={**lever.points, "E": (x, 0.0)}),
            },
        )
        summary = eq.analyze(made, 90).summary
        np.testing.assert_allclose(row, [summary[name].peak for name in names], rtol=1e-9)
    if shutil.which("node") is not None:
        scripted(MACHINE, ["drive_torque", "frame_force.x"], tmp_path)


def test_it_is_written_read_and_said() -> None:
    text = toml_text(Machine, Writer({}).content(Machine, shaper(IN_LEVER)))
    assert 'axes = "slider"' in text
    assert eq.loads(text) == shaper(IN_LEVER)
    report = "\n".join(map(str, model_blocks(MACHINE)))
    assert "in the axes of its slider" in report and "turns with the link" in report


def test_mujoco_has_them(tmp_path: Path) -> None:
    """The crank's own part of a force that turns with it, at rest: its arm times the force."""
    load = Load("crank", "B", (3.0, 4.0), axes="link")
    machine = replace(eq.load("yamashita-1"), loads=(load,))
    eq.export(machine, tmp_path / "model.xml", crank_angle=0.7)
    model = mujoco.MjModel.from_xml_path(str(tmp_path / "model.xml"))
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    data.qvel[:], data.ctrl[:] = 0.0, 0.0
    mujoco.mj_forward(model, data)
    arm = np.subtract(machine.links["crank"].points["B"], machine.links["crank"].points["A"])
    crank = model.joint("crank").qposadr[0]
    wanted = arm[0] * 4.0 - arm[1] * 3.0
    assert data.qfrc_actuator[crank] == pytest.approx(wanted, rel=1e-9)


WRONG: list[tuple[Load, dict[str, Any]]] = [
    (replace(IN_LEVER, link="lever", point="E"),
     {"place": "loads[1].axes", "link": "lever"}),
    (Load("lever", torque=2.0, axes="link"), {"place": "loads[1].axes"}),
    (replace(IN_LEVER, axes="guide"), {"place": "loads[1].axes", "leaf": "guide"}),
]  # fmt: skip


@pytest.mark.parametrize(("load", "expected"), WRONG)
def test_what_is_wrong_is_said(load: Any, expected: dict[str, Any]) -> None:
    with refused(ModelError, **expected):
        shaper(load)


def test_a_link_in_two_guides_needs_the_point_of_one() -> None:
    machine = eq.load("scotch-yoke")
    two = next(s for s in machine.sliders if sum(o.link == s.link for o in machine.sliders) == 1)
    more = replace(two, label="other", direction=two.direction + 1.0)
    with refused(ModelError, "loads[1].axes"):
        replace(machine, sliders=(*machine.sliders, more),
                loads=(Load(two.link, two.point, (1.0, 0.0), axes="slider"),))  # fmt: skip
