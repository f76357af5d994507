"""Groups of loops in loops over designs: the same figures and reasons as each design's own machine.

The figures of one machine go other ways: full coordinates from the rough position in the file,
posts and arrays of crank angles, NumPy's solver of linear equations.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import cache
from math import pi
from pathlib import Path

import numpy as np
import pytest

import equipoise as eq
from equipoise.codegen.batch import Batch
from equipoise.codegen.emit import can_emit
from equipoise.codegen.figures import COMPUTED, NO_FULL_TURN, NOT_COMPUTED, Figure
from equipoise.errors import ModelError, MotionError
from equipoise.mechanism.assembly.linkage import assemble
from equipoise.mechanism.parts.machine import Machine
from equipoise.studies.evaluate import Routes, evaluator
from support.batches import by_numpy
from support.chosen import few
from support.designs import Array, Number, design, drawn, geometry_of, named, paths_of
from unit.mechanism.test_newton import only_loops, places_of, subject, with_position
from unit.studies.test_evaluate import study

TRIAD = eq.load("class-three")
WANTED = [
    Figure("shaking_force.y", "rms"), Figure("shaking_moment", "peak"),
    Figure("drive_torque", "max_at"), Figure("points.Q.ax", "mean"),
    Figure("links.plate.angular_acceleration", "peak_to_peak"),
]  # fmt: skip
ANGLES = 90


def figures_or_reason(base: Machine, numbers: Sequence[Number], row: Array) -> list[float] | int:
    """Figures of a design's own machine, or the reason why it has none."""
    try:
        analysis = eq.analyze(design(base, numbers, row), ANGLES)
    except ModelError:
        return 4
    except MotionError:
        return NO_FULL_TURN
    forces, motion = analysis.forces, analysis.motion
    turning = motion.figures(motion.links["plate"].angular_acceleration)
    return [
        float(np.sqrt(np.mean(forces.shaking_force.y**2))),
        motion.figures(forces.shaking_moment).peak,
        motion.figures(forces.drive_torque).max_at,
        float(np.mean(motion.points["Q"].ax)),
        turning.peak_to_peak,
    ]


@cache
def compiled() -> tuple[Batch, list[Number]]:
    numbers = geometry_of(TRIAD, 0.05)
    return Batch(TRIAD, paths_of(numbers), WANTED, ANGLES, threads=1), numbers


def designs(count: int, share: float) -> Array:
    return drawn(geometry_of(TRIAD, share), count, 7)


# Loops against dyads: `test_loops_give_what_dyads_give`; against machines: the test below.
@pytest.mark.exhaustive
def test_designs_are_what_their_own_machines_are() -> None:
    """Those that turn, and those that fail at the start or half way round the cycle."""
    batch, numbers = compiled()
    values = np.concatenate([designs(2, 0.01), designs(8, 0.06)])
    figures, reasons = batch(values)
    own = [figures_or_reason(TRIAD, numbers, row) for row in values]
    assert {COMPUTED, NO_FULL_TURN} <= set(reasons)
    for row, reason, actual in zip(figures, reasons, own, strict=True):
        if reason == NOT_COMPUTED:  # from another start perhaps: one by one
            continue
        assert (reason == COMPUTED) == isinstance(actual, list)
        if isinstance(actual, list):
            np.testing.assert_allclose(row, actual, rtol=1e-9, atol=1e-9)
        else:
            assert reason == actual


# Loops against dyads, compiled: `test_loops_give_what_dyads_give`.
@pytest.mark.exhaustive
def test_numpy_gives_the_same(tmp_path: Path) -> None:
    batch, _ = compiled()
    values = designs(24, 0.06)
    right, reasons = batch(values)
    with by_numpy(tmp_path):
        figures, numpy_reasons = batch(values)
    np.testing.assert_array_equal(numpy_reasons, reasons)
    np.testing.assert_allclose(figures, right, rtol=1e-9, atol=1e-9)


def test_a_study_reports_of_every_design_what_its_machine_does() -> None:
    """Also of those that a loop leaves open, which go one by one."""
    numbers = named(TRIAD, "links.crank.points.B.x")
    given = study("class-three", numbers[0].path, "shaking_force.y.rms", angles=ANGLES)
    result = evaluator(given)
    assert isinstance(result, Routes) and result.compiled
    values = np.array([[0.02], [0.024], [0.05], [0.1], [0.3]])
    outcome = result(values)
    own = [figures_or_reason(TRIAD, numbers, row) for row in values]
    expected = [COMPUTED if isinstance(item, list) else item for item in own]
    assert outcome.reason.tolist() == expected
    assert len(set(expected)) > 1


@pytest.mark.parametrize("angle", few([0.3, -2.0, 7.0], {7.0}))
def test_the_march_begins_where_the_file_reports_the_pose(angle: float, tmp_path: Path) -> None:
    points = places_of(eq.move(TRIAD, [angle]), "BCPQ")
    moved = replace(TRIAD, position=eq.mechanism.Position(angle, points))
    values = np.array([[0.105], [0.106]])
    paths = ["links.rod.points.C.x"]
    with by_numpy(tmp_path):
        (right, _), (actual, reasons) = (
            Batch(machine, paths, WANTED, ANGLES, threads=1)(values) for machine in (TRIAD, moved)
        )
    assert not reasons.any()
    np.testing.assert_allclose(actual, right, rtol=1e-9, atol=1e-9)


@pytest.mark.exhaustive(but=["floating_watt", "slider-crank-engine", "scotch-yoke"])
@pytest.mark.parametrize("name", ["yamashita-1", "slider-crank-engine", "quick-return",
                                  "scotch-yoke", "watt-six-bar", "floating_watt"])  # fmt: skip
def test_loops_give_what_dyads_give(name: str, tmp_path: Path) -> None:
    """A linkage of dyads, solved as loops: slides in the tree and among the equations too."""
    given = subject(name)
    wanted = [Figure(signal, "rms") for signal in ("shaking_force.x", "drive_torque")]
    numbers = geometry_of(given, 0.002)
    values = drawn(numbers, 6, 1)
    with by_numpy(tmp_path):
        right, why = Batch(given, paths_of(numbers), wanted, ANGLES)(values)
        with only_loops():
            rough = with_position(given)
            assert can_emit(assemble(rough))
            actual, reasons = Batch(rough, paths_of(numbers), wanted, ANGLES)(values)
    np.testing.assert_array_equal(reasons, why)
    scale = np.nanmax(np.abs(right))
    np.testing.assert_allclose(actual, right, rtol=0, atol=1e-9 * scale)


def test_far_crank_angles_are_come_to_by_small_steps() -> None:
    """Eight crank angles in a turn are too far apart for one step of Newton's method."""
    few = Batch(TRIAD, ["drive.speed"], WANTED[:1], 8, threads=1)
    figures, reasons = few(np.array([[TRIAD.drive.speed]]))
    forces = eq.analyze(TRIAD, 8).forces
    assert reasons.tolist() == [COMPUTED]
    assert figures[0, 0] == pytest.approx(np.sqrt(np.mean(forces.shaking_force.y**2)), rel=1e-10)


# -- the way round ---------------------------------------------------------------------------------


def test_a_march_comes_to_every_crank_angle_once() -> None:
    march = compiled()[0].march
    assert march is not None
    theta = np.array([0.5, 0.1, 6.0, 2 * pi])
    number, _, given = march.way(theta)
    step, marked, steady = given.values()
    assert sorted(number[number >= 0]) == [0, 1, 2, 3]
    assert step.max() <= np.radians(4) + 1e-12
    assert step.sum() == pytest.approx(2 * pi)
    assert marked.sum() == 1
    assert steady[np.argmax(marked) :].all() and not steady[: np.argmax(marked)].any()
