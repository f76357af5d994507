"""The linear steps: closed forms of a rotating unbalance, mounts, and what each step hands over."""

from __future__ import annotations

from dataclasses import replace
from math import pi, sqrt

import numpy as np
import pytest

import equipoise as eq
from equipoise.errors import ModelError, ResponseError
from equipoise.vibration.forced import respond
from equipoise.vibration.linear import Linear
from equipoise.vibration.simplified import linear_of
from support.refusals import refused
from unit.vibration.build import SPEED, Gauge, Mount, block, cart, close, rig, springs

MASS, ECCENTRIC, RADIUS = 10.0, 0.2, 0.03
STIFF, DAMP = 2000.0, 20.0


def unbalance(**changes: object) -> eq.Machine:
    """Make a body that heaves on two mounts, shaken by a mass on its crank alone."""
    feet = {
        name: Mount((x, 0.0, 0.0), stiffness=STIFF / 2, damping=DAMP / 2)
        for name, x in (("a", -0.5), ("b", 0.5))
    }
    values = {"freedoms": ("heave",), "mounts": feet, "gauges": {"up": Gauge((0.0, 0.0, 0.0))}}
    machine = block(**{**values, **changes})
    return machine.with_link("crank", mass=ECCENTRIC, center_of_mass=(RADIUS, 0.0))


@pytest.mark.parametrize("speed", [3.0, 13.0, 14.2, 40.0, -20.0])
@pytest.mark.parametrize("model", ["linear", "torque", "moment"])
def test_rotating_unbalance(speed: float, model: str) -> None:
    """Y = m e w^2 / (k - M w^2 + i c w), of order 1 alone, in every step.

    M counts the unbalance.  It shakes up as -sin of the crank angle's second derivative.
    """
    response = respond(unbalance(), speed, model)
    gain = ECCENTRIC * RADIUS * speed**2
    gain = gain / (STIFF - (MASS + ECCENTRIC) * speed**2 + 1j * DAMP * speed)
    moved = response.gauges["up"].displacement
    # Up goes sin theta: Re(-i exp(i theta)).
    close(moved.amplitudes, [0, -1j * gain], 1e-11)
    close(response.gauges["up"].velocity.amplitudes, [0, gain * speed], 1e-11)
    close(response.gauges["up"].acceleration.amplitudes, [0, 1j * gain * speed**2], 1e-11)
    assert moved.peak_to_peak == pytest.approx(2 * abs(gain))


@pytest.mark.parametrize("speed", [3.0, 14.2, 40.0])
def test_transmissibility(speed: float) -> None:
    """sqrt(1 + (2 D r)^2) / sqrt((1 - r^2)^2 + (2 D r)^2), halved for each of two mounts.

    The linkages' force counts with both of its components: a rotating one F as sqrt(2) F.
    """
    mounts = respond(unbalance(), speed, "moment").mounts
    natural = sqrt(STIFF / (MASS + ECCENTRIC))
    r, damping = speed / natural, DAMP / (2 * sqrt(STIFF * (MASS + ECCENTRIC)))
    whole = sqrt((1 + (2 * damping * r) ** 2) / ((1 - r**2) ** 2 + (2 * damping * r) ** 2))
    for mount in mounts.values():
        assert mount.transmissibility[1] == pytest.approx(whole / 2 / sqrt(2))
        assert mount.whole == pytest.approx(whole / 2 / sqrt(2))
        assert np.isnan(mount.transmissibility[0])
        assert mount.force.mean == pytest.approx((MASS + ECCENTRIC) * 9.80665 / 2)
        amplitude = ECCENTRIC * RADIUS * speed**2 * whole / 2
        assert mount.force.peak_to_peak == pytest.approx(2 * amplitude)
        assert mount.lifts_off == 0


def test_links_that_cancel_hand_on_nothing() -> None:
    """A force that is rounding beside mass times size times the speed's square counts as none."""
    still = unbalance().with_link("crank", mass=ECCENTRIC, center_of_mass=(1e-17, 0.0))
    assert all(np.isnan(mount.whole) for mount in respond(still, 3.0, "moment").mounts.values())


def test_without_damping_at_resonance_there_is_no_answer() -> None:
    """10.25 kg on 2624 N/m at 16 rad/s: all exact in binary."""
    feet = {"a": Mount((0.0, 0.0, 0.0), stiffness=2624.0)}
    machine = unbalance(mounts=feet).with_link("crank", mass=0.25)
    with refused(ResponseError, speed=16.0):
        respond(machine, 16.0, "moment")


@pytest.mark.parametrize("model", ["linear", "torque", "moment"])
def test_response_meets_its_equation(model: str) -> None:
    """M q.. + C q. + K q = W at every angle, of the planar and of the spatial support."""
    for machine in (springs(), cart()):
        linear = linear_of(machine, model)
        moved, wrench = linear.motion(SPEED), linear.wrench(SPEED)
        theta = np.linspace(0, 6, 25)
        left = linear.stiffness @ moved.values(theta)
        left = left + linear.damping @ (moved.derivative() * SPEED).values(theta)
        left = left + linear.mass @ (moved.derivative(2) * SPEED**2).values(theta)
        close(left, wrench.values(theta), 1e-11)


# -- what excites ----------------------------------------------------------------------------------


def test_steps_hand_over_force_torque_and_moment() -> None:
    """(59): force at A alone; (57): and minus the drive torque; whole: moment of all joints.

    About the reference point of the rig, 1.34 m behind A.
    """
    machine = rig()
    solved = eq.analyze(machine, 720, speed=SPEED, acceleration=0.0, about=(-1.34, 0.0)).forces
    theta = solved.motion.crank_angle
    varying = solved.frame_force.value - solved.weight.value
    wanted = {
        "linear": 1.34 * varying.imag,
        "torque": 1.34 * varying.imag - solved.drive_torque,
        "moment": solved.frame_moment - np.mean(solved.weight_moment),
    }
    for step, moment in wanted.items():
        wrench = linear_of(machine, step).excitation.at(SPEED).values(theta)
        close(wrench[5], moment, 1e-12)
        close(wrench[:2], [varying.real, varying.imag], 1e-12)


@pytest.mark.parametrize("step", ["linear", "torque", "moment"])
def test_springs_to_the_support_do_not_shake_it(step: str) -> None:
    """What they do to it directly and through joints and drive cancels."""
    machine = eq.load("spring-balanced-crank").with_support(
        mass=20.0, center_of_mass=(0.0, -0.1, 0.0), inertia=(0.5,)
    )
    theta = np.linspace(0, 6, 9)
    actual, wanted = (
        linear_of(given, step).excitation.samples(theta, 15.0)
        for given in (machine, machine.with_springs(()))
    )
    close(actual, wanted, 1e-12)


def test_a_row_aside_excites_roll_and_yaw() -> None:
    """Force f at z: moment -z f_y about x and z f_x about y."""
    plain = Linear.of(cart()).excitation
    row = eq.Row(lateral=0.3)
    aside = Linear.of(cart().with_rows([row])).excitation
    there, here = aside.at(SPEED).amplitudes, plain.at(SPEED).amplitudes
    close(there[[0, 1, 5]], here[[0, 1, 5]], 1e-13)
    close(there[3] - here[3], -0.3 * here[1], 1e-12)
    close(there[4] - here[4], 0.3 * here[0], 1e-12)


def test_what_depends_on_speed_grows_with_its_square() -> None:
    linear = Linear.of(springs())
    first, two, still = (linear.excitation.at(speed) for speed in (10.0, 20.0, 0.0))
    theta = np.linspace(0, 6, 20)
    moving = first.values(theta) - still.values(theta)
    close(two.values(theta) - still.values(theta), 4 * moving, 1e-12)


def test_drive_torque_of_all_rows() -> None:
    machine = rig().with_rows([eq.Row(), eq.Row(phase=1.2)])
    torque = respond(machine, SPEED).drive.torque
    first = eq.analyze(rig(), 360, speed=SPEED, acceleration=0.0)
    theta = first.motion.crank_angle
    ahead = eq.analyze(rig(), theta + 1.2, speed=SPEED, acceleration=0.0)
    close(torque.values(theta), first.forces.drive_torque + ahead.forces.drive_torque, 1e-12)


# -- mounts that cannot pull, and remarks ----------------------------------------------------------


def test_mount_that_does_not_touch_is_left_out() -> None:
    mounts = {
        name: Mount((x, 0.0, 0.0), stiffness=5e3, damping=9.0, one_sided=True)
        for name, x in (("a", -0.5), ("b", 0.0), ("c", 0.5))
    }
    machine = springs(center_of_mass=(0.4, 0.0, 0.0), mounts=mounts, freedoms=("heave", "pitch"))
    response = respond(machine, SPEED, "moment")
    assert "a has no contact at rest and is ignored" in map(str, response.notes)
    assert response.mounts["a"].force.extreme(1)[0] == 0


def test_mount_that_would_have_to_pull() -> None:
    feet = {
        name: Mount((x, 0.0, 0.0), stiffness=STIFF / 2, damping=DAMP / 2, one_sided=True)
        for name, x in (("a", -0.5), ("b", 0.5))
    }
    machine = unbalance(mounts=feet).with_link("crank", mass=5.0)
    words = (
        "would be in tension, which a one-sided mount cannot transmit; the exact model includes "
        "the loss of contact"
    )
    assert not respond(machine, 1.0, "moment").notes
    response = respond(machine, sqrt(STIFF / 15), "moment")
    assert [*map(str, response.notes)][-2:] == [f"a {words}", f"b {words}"]


def test_a_constant_force_on_what_nothing_holds() -> None:
    """Without a spring along x a load from there drives the machine away; shaking does not."""
    up = {n: Mount((x, 0.0, 0.0), stiffness=4e3, damping=9.0) for n, x in (("a", -1.0), ("b", 1.0))}
    machine = springs(mounts=up)
    moved = respond(machine, SPEED, "moment").gauges["seat"].displacement
    assert np.isfinite(moved.peak_to_peak)
    pushed = replace(machine, loads=(eq.Load("coupler", "P", (5.0, 0.0)),))
    with refused(ModelError, "support.mounts", by="Linear._mean"):
        respond(pushed, SPEED, "moment")


def test_a_period_of_several_turns() -> None:
    """A counterweight geared down by 2 comes back every other turn: orders are halves."""
    machine = rig("geared-counterweight")
    turns = eq.move(machine, 10).turns
    response = respond(machine, 10.0)
    assert response.turns == turns
    moved = response.gauges["gauge"].displacement
    assert moved.turns == turns
    assert moved.orders[1] == 1 / turns
    assert moved.period == pytest.approx(2 * pi * turns)
