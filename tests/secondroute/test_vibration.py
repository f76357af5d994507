"""Steady vibration against free bodies that are solved at every instant and followed in time.

`support.rig_reference` shares nothing with the package: crank, coupler, rocker and support are cut
free, and the motion is integrated turn by turn until it comes back.

Tolerances.  The reference integrates with a relative error of 1e-11 a step and looks for the start
that comes back to 1e-11 m; a lightly damped support makes that larger by 1 / (1 - |multiplier|),
50 times at most.  Where a mount lifts off, a step of the integration passes over the kink: that
costs another digit.  Of the package's solutions, the residual of each interval is below 1e-11.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from math import pi

import numpy as np
import pytest
from numpy.typing import NDArray

import equipoise as eq
from equipoise.mechanism.parts.motors import Motor
from equipoise.vibration.exact import ExactSolution, solve_exact
from equipoise.vibration.forced import respond
from equipoise.vibration.response import ExcitationModel
from support import rig_reference
from support.chosen import EXHAUSTIVE, few
from support.conformance import compared, equation
from support.rig_reference import Rig
from support.rigs import RPM, in_package, on_feet, one_row, rows_apart, tied, two_rows
from support.sources import IN_TIME, YAMASHITA

Array = NDArray[np.float64]

SAMPLES = 64
TRAVEL = np.arange(SAMPLES) * 2 * pi / SAMPLES
CLOSE = 2e-8
"""Of the largest value of each signal; see above."""


@dataclass(frozen=True)
class Case:
    """A rig, its speed in rad/s, and the motor of the package that belongs to its drive."""

    rig: Rig
    speed: float
    motor: Motor | None = None
    tolerance: float = CLOSE


def line(stall: float, slope: float, sense: float = 1.0) -> Callable[[Array], Array]:
    """Torque of a motor on the crank, T = sense (a - b |speed|)."""
    return lambda speed: sense * stall - slope * speed


def driven(rig: Rig, speed: float, flywheel: float = 0.01) -> Case:
    """A motor of 9 N m at rest, which its speed takes by 0.4 N m s/rad."""
    sense = float(np.sign(speed))
    motor = Motor(9.0 / 0.4, 9.0, mean_speed="free")
    return Case(replace(rig, drive=line(9.0, 0.4, sense), flywheel=flywheel), speed, motor)


CASES = {
    "60 rpm": Case(one_row(), 60 * RPM),
    "150 rpm": Case(one_row(), 150 * RPM),
    "193 rpm": Case(one_row(), 193 * RPM),
    "250 rpm": Case(one_row(), 250 * RPM),
    "reversed": Case(one_row(), -193 * RPM),
    "two rows": Case(two_rows(), 193 * RPM),
    "two rows, reversed": Case(two_rows(), -150 * RPM),
    "rows apart": Case(rows_apart(), 193 * RPM),
    "free": Case(on_feet(), 193 * RPM),
    "free, reversed": Case(on_feet(), -120 * RPM),
    "lifting off": Case(on_feet(one_sided=True, stiffer=1.5), 260 * RPM, tolerance=1e-7),
    "motor": driven(one_row(), 193 * RPM),
    "motor, reversed": driven(one_row(), -193 * RPM),
    "motor on two rows": driven(two_rows(), 193 * RPM, flywheel=0.002),
    "motor, free": driven(on_feet(), 193 * RPM),
    "springs": Case(tied(one_row()), 193 * RPM),
    "springs on two rows, free": Case(tied(replace(on_feet(), rows=rows_apart().rows)), -120 * RPM),
    "springs and motor": driven(tied(one_row()), 193 * RPM),
}


KINDS = ("193 rpm", "free, reversed", "lifting off", "motor on two rows")
"""One of each kind of rig and drive."""
EVERYTHING = "motion, gauge, mounts, drive, joints, work of a turn"


@dataclass(frozen=True)
class Pair:
    """One case by both ways, at the same crank angles."""

    case: Case
    wanted: rig_reference.Steady
    solution: ExactSolution
    states: Array
    """(n, N), of the package's solution at the reference's crank angles."""

    @property
    def places(self) -> tuple[Array, Array]:
        return self.solution.system.place_and_rate(self.states)

    def close(self, result: Array, wanted: Array, size: float = 0.0) -> None:
        size = size or float(np.max(np.abs(wanted)))
        np.testing.assert_allclose(result, wanted, rtol=0, atol=self.case.tolerance * size)


def solved(name: str) -> Pair:
    """Solve a case both ways.

    The package's solution is where the reference starts to look; where it comes back, it tells.
    """
    case = CASES[name]
    machine = in_package(case.rig, case.motor).with_drive(speed=case.speed)
    solution = solve_exact(machine, case.speed, case.motor is not None)
    states = solution.steady.orbit.at(TRAVEL)
    start = states[: rig_reference.difference_steps(case.rig, 1.0).size, 0]
    wanted = rig_reference.steady(case.rig, case.speed, SAMPLES, start_state=start)
    return Pair(case, wanted, solution, states)


@pytest.mark.exhaustive(but=["lifting off", "193 rpm"])
@compared(IN_TIME, EVERYTHING, 1e-7)
@pytest.mark.parametrize("name", few(CASES, KINDS))
def test_steady_state(name: str) -> None:
    pair = solved(name)
    same_motion(pair)
    same_gauge(pair)
    same_mounts(pair)
    same_drive(pair)
    same_joints(pair)
    same_work(pair)


def same_motion(pair: Pair) -> None:
    place, rate = pair.places
    n = pair.case.rig.freedoms
    kept = slice(3 - n, 3)
    for actual, wanted in zip(place[kept], pair.wanted.state[:, :n].T, strict=True):
        pair.close(actual, wanted)
    for actual, wanted in zip(rate[kept], pair.wanted.state[:, n : 2 * n].T, strict=True):
        pair.close(actual, wanted)


def same_gauge(pair: Pair) -> None:
    response = respond(pair.solution.machine, None, "exact", pair.case.motor is not None)
    signal = response.gauges["gauge"].displacement
    mean_speed = response.speed
    # Signals go with time: at the mean speed, this is where the crank is by then.
    pair.close(signal.values(mean_speed * pair.wanted.times), pair.wanted.gauge)
    assert float(signal.peak_to_peak) == pytest.approx(pair.wanted.peak_to_peak, rel=1e-7)


def same_mounts(pair: Pair) -> None:
    """Pushes, and what of them holds the weight."""
    place, rate = pair.places
    forces = {contact.name: contact.force(place, rate) for contact in pair.solution.system.contacts}
    for k, wanted in enumerate(pair.wanted.mounts.T):
        pair.close(forces[str(k)], wanted)
    for k, wanted in enumerate(pair.wanted.torsions.T):
        pair.close(forces[f"t{k}"], wanted)
    if any(mount.one_sided for mount in pair.case.rig.mounts):
        assert 0.1 < np.mean(pair.wanted.mounts[:, 0] == 0) < 0.9
    assert pair.solution.linear is not None
    given = np.concatenate(pair.case.rig.preloads)
    result = list(pair.solution.linear.rest.preload.values())
    np.testing.assert_allclose(result, given, rtol=1e-11)


def same_drive(pair: Pair) -> None:
    """Torque of motor or drive; with a motor, the crank's speed and the time too."""
    system = pair.solution.system
    table = system.sums(system.sense * TRAVEL)
    pair.close(system.drive_torque(table, pair.states), pair.wanted.motor)
    n = 2 * pair.case.rig.freedoms
    if pair.case.motor is not None:
        pair.close(pair.states[n], pair.wanted.state[:, n])
        pair.close(pair.states[n + 1], pair.wanted.times)


def same_joints(pair: Pair) -> None:
    """Forces in the joints and torque of each row, and accelerations of the support.

    The reference's forces are in space, the package's in the axes of the support.
    """
    exact = replace(pair.solution)
    exact.__dict__["turned"] = TRAVEL  # equal steps of the crank instead of time
    ride, kept = exact.base_motion, slice(3 - pair.case.rig.freedoms, 3)
    for actual, wanted in zip(ride.change[kept], pair.wanted.acceleration.T[kept], strict=True):
        pair.close(actual, wanted)
    turn = np.exp(1j * ride.place[2])
    size = max(float(np.max(np.abs(force))) for force in pair.wanted.joints.values())
    torque = float(np.max(np.abs(pair.wanted.torque)))
    for k, reactions in enumerate(exact.passes):
        for name in rig_reference.JOINTS:
            wanted = pair.wanted.joints[name][:, k]
            pair.close(turn * reactions.joints[name].value, wanted, size)
        pair.close(reactions.drive_torque, pair.wanted.torque[:, k], torque)


def same_work(pair: Pair) -> None:
    """Of motor and mounts in a turn, which the reference integrates beside the motion.

    What the motor gives and takes back in a turn is much more, and as good as it is integrated.
    """
    result = pair.solution.energy()
    swing = 2 * pi * float(np.max(np.abs(pair.wanted.motor)))
    assert result.fed_in == pytest.approx(pair.wanted.work, abs=pair.case.tolerance * swing)
    assert result.lost == pytest.approx(pair.wanted.loss, abs=pair.case.tolerance * swing)


@pytest.mark.exhaustive(but=["reversed", "motor"])
@pytest.mark.parametrize(
    "name", few(["193 rpm", "reversed", "lifting off", "motor"], {"193 rpm", "reversed", "motor"})
)
def test_multipliers(name: str) -> None:
    """The reference takes differences over 1e-4 m and 1e-4 of the speed: good to some 1e-7.

    With a motor it maps crank angle 0 to crank angle 0, as the package does.  Where a mount lifts
    off, the differences meet the kink: 5e-5.
    """
    case = CASES[name]
    solution = solve_exact(in_package(case.rig, case.motor), case.speed, case.motor is not None)
    count = rig_reference.difference_steps(case.rig, 1.0).size
    start = solution.steady.orbit.starts[:count, 0]
    wanted = rig_reference.multipliers(case.rig, case.speed, start)
    values = solution.steady.multipliers(count)
    tolerance = 5e-5 if name == "lifting off" else 1e-6
    values, wanted = np.sort_complex(values), np.sort_complex(wanted)
    np.testing.assert_allclose(values, wanted, rtol=0, atol=tolerance)


# -- steps of the paper ----------------------------------------------------------------------------

STEPS: dict[int, ExcitationModel] = {59: "linear", 57: "torque", 54: "coupled"}


@pytest.mark.exhaustive(but=["59-one row", "57-one row"])
@equation(YAMASHITA, "(54), (57), (59)", "steady vibration of the rig, in time", 1e-9)
@pytest.mark.parametrize(
    ("rig", "speed"),
    [
        (one_row(), 193 * RPM),
        pytest.param(one_row(), -150 * RPM, marks=EXHAUSTIVE),
        pytest.param(two_rows(), 193 * RPM, marks=EXHAUSTIVE),
    ],
    ids=["one row", "reversed", "two rows"],
)
@pytest.mark.parametrize("step", STEPS)
def test_steps_of_the_paper(rig: Rig, speed: float, step: int) -> None:
    """Each integrated in time from its equation as printed, with damping.

    1e-9 of the amplitude, or what the reference leaves: it stops where a turn brings the tilt back
    to 1e-11 rad, which near resonance is 5 times as much at the gauge.
    """
    wanted = rig_reference.reduced_steady(rig, speed, step, SAMPLES)
    response = respond(in_package(rig), speed, STEPS[step])
    signal = response.gauges["gauge"].displacement
    size = float(np.max(np.abs(wanted.gauge)))
    values = signal.values(wanted.crank_angle)
    np.testing.assert_allclose(values, wanted.gauge, rtol=0, atol=max(1e-9 * size, 5e-11))
    if step == 54:
        assert response.multipliers is not None
        first, other = (np.sort_complex(m) for m in (response.multipliers, wanted.multipliers))
        np.testing.assert_allclose(first, other, atol=1e-7)


@pytest.mark.parametrize(
    ("rig", "model", "millimetres"),
    [
        (one_row(), "linear", 12.6217204),
        (one_row(), "torque", 12.6127507),
        (one_row(), "coupled", 12.6129354),
        (one_row(), "exact", 12.0028345),
        (two_rows(), "linear", 0.8068215),
        (two_rows(), "torque", 0.8222371),
        (two_rows(), "coupled", 0.8221929),
        (two_rows(), "exact", 0.7280282),
    ],
)
def test_figures_of_the_rig(rig: Rig, model: ExcitationModel, millimetres: float) -> None:
    """Peak to peak at the gauge at 193 rpm, as the reference has it to all these digits."""
    displacement = respond(in_package(rig), 193 * RPM, model).gauges["gauge"].displacement
    assert 1e3 * float(displacement.peak_to_peak) == pytest.approx(millimetres, abs=1e-7)


def test_multipliers_of_the_rig() -> None:
    multipliers = respond(in_package(one_row()), 193 * RPM, "exact").multipliers
    assert multipliers is not None
    np.testing.assert_allclose(multipliers.real, -0.73131820, atol=6e-9)
    np.testing.assert_allclose(np.abs(multipliers.imag), 0.64657931, atol=6e-9)


def test_motor_with_its_mean_speed_held() -> None:
    """The reference with the curve moved by the shift that was found turns at the same speed."""
    motor = Motor(9.0 / 0.4, 9.0)
    machine: eq.Machine = in_package(replace(one_row(), flywheel=0.01), motor)
    solution = solve_exact(machine, 193 * RPM, True)
    shift = solution.response().drive.shift
    rig = replace(one_row(), drive=line(9.0 + 0.4 * shift, 0.4), flywheel=0.01)
    start = solution.steady.orbit.starts[:3, 0]
    wanted = rig_reference.steady(rig, 193 * RPM, SAMPLES, start_state=start)
    np.testing.assert_allclose(wanted.state[0], start, rtol=1e-8, atol=1e-10)
    states = solution.steady.orbit.at(TRAVEL)
    np.testing.assert_allclose(states[3], wanted.times, rtol=0, atol=1e-9)
