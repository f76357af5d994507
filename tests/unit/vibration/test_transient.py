"""From rest: into the steady state, with a constant speed and with a motor that runs up."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from math import pi, radians

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import equipoise as eq
from equipoise.errors import ModelError, UsageError
from equipoise.mechanism.parts.motors import Motor
from equipoise.mechanism.parts.support import Row
from equipoise.vibration.coupled import StallError
from equipoise.vibration.forced import respond
from equipoise.vibration.free import Transient
from support.chosen import EXHAUSTIVE, few
from support.refusals import refused, values_of
from unit.mechanism.build import slider_crank
from unit.vibration.build import DAMPING, PIVOT, SPEED, STIFFNESS, Mount, block, cart, rig

DAMPED = {"s": Mount(axis="pitch", torsional_stiffness=STIFFNESS, torsional_damping=100 * DAMPING)}
LINE = Motor(26.0, 6.0, inertia=0.002)


# Decay and steady state: the tests beside it and tests/secondroute/test_vibration.py.
@pytest.mark.exhaustive
@pytest.mark.parametrize("speed", few([SPEED, -SPEED], {-SPEED}))
def test_it_dies_out_into_the_steady_state(speed: float) -> None:
    """100 times the paper's damping takes 1e-10 of the start in 3 s.

    The rest: 1e-9 of the integration, and 1e-9 by splines of the linkages over 0.25 deg.
    """
    machine = rig(mounts=DAMPED).with_rows([Row(), Row(phase=2.0)])
    simulation = eq.simulate(machine, 3.4, speed, samples=1001)
    late = simulation.time > 3.0
    steady = respond(machine, speed, "exact")
    wanted = steady.gauges["gauge"].displacement.values(simulation.crank_angle[late])
    size = float(steady.gauges["gauge"].displacement.peak_to_peak)
    np.testing.assert_allclose(simulation.gauges["gauge"][late], wanted, rtol=0, atol=1e-7 * size)
    force = steady.mounts["s"].force.values(simulation.crank_angle[late])
    np.testing.assert_allclose(
        simulation.mounts["s"][late], force, rtol=0, atol=1e-6 * np.max(force)
    )


def test_it_begins_at_rest_with_the_crank_turning() -> None:
    simulation = eq.simulate(rig(), 1.0, samples=11)
    np.testing.assert_allclose(simulation.time, np.linspace(0, 1, 11))
    np.testing.assert_array_equal(simulation.states[:, 0], 0)
    np.testing.assert_allclose(simulation.crank_speed, SPEED)
    np.testing.assert_allclose(
        simulation.crank_angle, SPEED * simulation.time, rtol=1e-12, atol=1e-12
    )


# Free decay: tests/literature/test_yamashita_decay.py and the tests beside it.
@pytest.mark.exhaustive
def test_free_decay_of_a_body_alone() -> None:
    """A pendulum beside its equilibrium, with links that weigh nothing, by its own equation."""
    inertia, arm, damping = 0.4, 0.5, 0.3
    mounts = {
        "hinge": Mount(axis="pitch", torsional_damping=damping),
        "nothing": Mount((0.0, 0.0, 0.0), damping=1e-12, preload=0.0),
    }
    center = (PIVOT[0] + arm, 0.0, 0.0)
    machine = block(pivot=PIVOT, center_of_mass=center, mounts=mounts)
    simulation = eq.simulate(machine, 2.0, samples=81)
    whole = inertia + 10 * arm**2

    def falling(_: float, y: np.ndarray) -> list[float]:
        return [y[1], (-10 * 9.80665 * arm * np.cos(y[0]) - damping * y[1]) / whole]

    wanted = solve_ivp(
        falling, (0, 2), [0.0, 0.0], "DOP853", t_eval=simulation.time, rtol=1e-11, atol=1e-12
    )
    assert np.min(wanted.y[0]) < -2
    np.testing.assert_allclose(simulation.states, wanted.y, rtol=0, atol=1e-6)


@pytest.fixture(scope="module")
def run_up() -> Transient:
    return eq.simulate(rig(mounts=DAMPED).with_drive(motor=LINE), 4.5, drive=True, samples=3001)


# A motor that runs up in time fails in `test_on_solid_ground` too.
@pytest.mark.exhaustive
def test_a_motor_runs_up_to_the_steady_speed(run_up: Transient) -> None:
    """Held: the curve is shifted so that the mean speed is that of the drive."""
    steady = respond(run_up.machine, drive=True)
    assert run_up.crank_speed[0] == 0
    turns = np.arange(4, 1, -1) * 2 * pi
    end = run_up.crank_angle[-1]
    times = np.interp(end - turns, run_up.crank_angle, run_up.time)
    # Interpolated between samples 1.5 ms apart: 1e-5 of a turn's time.
    assert 2 * pi / np.diff(times) == pytest.approx([SPEED, SPEED], rel=1e-4)
    late = run_up.crank_speed[run_up.time > 4.0]
    assert steady.drive.speed is not None
    assert np.max(late) == pytest.approx(float(steady.drive.speed.extreme(1)[0]), rel=1e-4)
    assert np.min(late) == pytest.approx(float(steady.drive.speed.extreme(-1)[0]), rel=1e-4)
    gauge = run_up.gauges["gauge"][run_up.time > 4.0]
    wanted = float(steady.gauges["gauge"].displacement.peak_to_peak)
    assert np.ptp(gauge) == pytest.approx(wanted, rel=1e-4)


def test_crank_never_outruns_its_motor(run_up: Transient) -> None:
    """It turns forward all the time, and slower than without load."""
    assert np.all(np.diff(run_up.crank_angle) > 0)
    assert np.max(run_up.crank_speed) < 26


def test_on_solid_ground() -> None:
    """Without losses, the motor's own slope settles the speed in 0.2 s."""
    simulation = eq.simulate(
        eq.load("yamashita-1").with_drive(motor=LINE), 2.0, drive=True, samples=801
    )
    steady = respond(simulation.machine, drive=True)
    assert simulation.gauges == {} and simulation.mounts == {}
    assert steady.drive.speed is not None
    late = simulation.crank_speed[simulation.time > 1.5]
    # 2.5 ms between samples: a top is missed by up to 1e-3 of the swing.
    assert np.max(late) == pytest.approx(float(steady.drive.speed.extreme(1)[0]), rel=1e-3)
    assert np.min(late) == pytest.approx(float(steady.drive.speed.extreme(-1)[0]), rel=1e-3)


# One-sided mounts: tests/secondroute/test_vibration.py.
@pytest.mark.exhaustive
def test_a_one_sided_mount_never_pulls() -> None:
    feet = {
        "foot": Mount((0.16, -0.2, 0.0), stiffness=900.0, damping=20.0, one_sided=True),
        "axle": Mount(axis="pitch", torsional_damping=10.0),
    }
    simulation = eq.simulate(rig(mounts=feet, mass=4.0, center_of_mass=(-1.2, 0.0, 0.0)), 1.5)
    force = simulation.mounts["foot"]
    assert np.min(force) == 0
    assert np.max(force) > 0


def test_reported_values() -> None:
    simulation = eq.simulate(rig(), 0.5, samples=9)
    values = simulation.to_dict()
    assert len(values["time"]) == 9
    assert set(values["gauges"]) == {"gauge"}
    assert set(values["mounts"]) == {"spring"}
    columns = {name: unit for name, unit, _ in simulation.columns()}
    assert columns == {
        "time": "s",
        "crank_angle": "rad",
        "crank_speed": "rad/s",
        "gauges.gauge.displacement": "m",
        "mounts.spring.force": "N m",
    }


@pytest.mark.parametrize("duration", [0.0, -1.0, 700.0])
def test_wrong_durations(duration: float) -> None:
    turns = abs(SPEED) * duration / (2 * pi)
    longest = 4000 * pi / abs(SPEED)
    with refused(UsageError, duration=duration, turns=turns, most_turns=2000, longest=longest):
        eq.simulate(rig(), duration)


def test_refusals() -> None:
    with refused(ModelError, "support"):
        eq.simulate(eq.load("yamashita-1"), 1.0)
    with refused(ModelError, "drive.motor"):
        eq.simulate(rig(), 1.0, drive=True)
    with refused(ModelError, "support.freedoms"):
        eq.simulate(cart(), 1.0)


@pytest.mark.parametrize("samples", [1, 0, -3])
def test_too_few_samples(samples: int) -> None:
    with refused(UsageError, samples=samples):
        eq.simulate(rig(), 0.5, samples=samples)


# -- a motor that is too weak ----------------------------------------------------------------------


def press(force: float, mean_speed: str, way: int = 1) -> eq.Machine:
    """A slider-crank that pushes against a force over the last part of its stroke."""
    motor = Motor(157.0, 4.0, ratio=22.0, inertia=4e-5, mean_speed=mean_speed)  # type: ignore[arg-type]
    given = slider_crank(
        drive=eq.Drive("crank", way * 6.0, motor=motor, flywheel=0.5), gravity=(0.0, 0.0)
    )
    ends = (radians(300), 0.0) if way > 0 else (0.0, radians(60))
    load = eq.mechanism.Load("piston", "C", (-force, 0.0), start=ends[0], stop=ends[1])
    return replace(given, loads=(load,))


@pytest.mark.exhaustive(but=["respond-held--1", "simulate-free--1"])
@pytest.mark.parametrize("way", few([1, -1], {-1}))
@pytest.mark.parametrize("mean_speed", ["held", "free"])
@pytest.mark.parametrize("of", ["respond", "simulate"])
def test_a_motor_that_stalls(of: str, mean_speed: str, way: int) -> None:
    """The torque that is needed is that of the force, by virtual work: where it stalls, and where
    a steady state is asked for, in the mean.
    """
    machine, force = press(8000.0, mean_speed, way), 8000.0
    follow = partial(eq.simulate, duration=3.0) if of == "simulate" else respond
    with pytest.raises(StallError) as caught:
        follow(machine, drive=True)
    values = dict(values_of(caught.value.note))
    if of == "respond" or mean_speed == "held":
        at_ends = eq.move(machine, [0.0, radians(60)]).points["C"].place.real
        mean = force * abs(at_ends[0] - at_ends[1]) / (2 * pi)
        torques = [float(values[name]) for name in ("needed", "given")]
        assert "angle" not in values
        assert torques == pytest.approx([mean, 88.0], rel=1e-3)
        return
    at, needed, given = (float(values[name]) for name in ("angle", "needed", "given"))
    motion = eq.move(machine, [radians(at)])
    lever = abs(motion.points["C"].place_1[0].real)
    assert needed == pytest.approx(force * lever, rel=2e-2)
    assert 0 < given < needed
    assert given == pytest.approx(4.0 * 22.0, rel=1e-3)  # its torque at standstill


# A motor that runs up in time fails in `test_on_solid_ground` too.
@EXHAUSTIVE
def test_a_motor_that_does_not_stall() -> None:
    """A weaker press is not refused, and its solution is what it settles into from rest."""
    machine = press(100.0, "free")
    response = respond(machine, drive=True)
    followed = eq.simulate(machine, 8.0, drive=True)
    late = followed.crank_speed[followed.time > 6.0]
    assert response.drive.speed is not None
    for sense, end in ((1, np.max(late)), (-1, np.min(late))):
        assert end == pytest.approx(float(response.drive.speed.extreme(sense)[0]), rel=1e-3)
