"""Dampers of a machine on a support, whose crank a motor turns at a speed that is not constant."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import equipoise as eq
from equipoise.errors import ModelError
from equipoise.mechanism import Machine, TorsionDamper
from equipoise.running.equation import CrankEquation
from equipoise.vibration.exact import solve_exact

DAMPERS = (TorsionDamper("crank", damping=0.05), TorsionDamper("coupler", "rocker", 0.02))


def rig(heavier: float, *dampers: TorsionDamper) -> Machine:
    """A planting mechanism on a rig that is so many times as hard to swing."""
    machine = eq.load("yamashita-rig").without_friction()
    assert machine.support is not None
    inertia = machine.support.pivot_inertia
    assert inertia is not None
    support = replace(machine.support, pivot_inertia=heavier * inertia)
    return replace(machine, support=support, torsion_dampers=dampers)


def test_on_a_support_that_stands_still_the_crank_obeys_the_equation_of_a_run() -> None:
    """J q.. + J' q.^2 / 2 = Q + T, with q.. by the derivative of the speed along the way.

    The support still swings by 1e-8 of what it would; the derivative is good to 1e-6.
    """
    machine = rig(1e8, *DAMPERS)
    solution = solve_exact(machine, machine.drive.speed, True)
    system = solution.system
    theta = np.linspace(0.0, 2 * np.pi, 401)[:-1]
    states = np.asarray(solution.found.orbit.at(theta))
    speed = system.crank_speed(states)
    orders = np.fft.rfftfreq(400, 1 / 400)
    slope = np.fft.irfft(1j * orders * np.fft.rfft(speed), 400)
    driving = system.drive_torque(system.sums(theta), states)
    equation = CrankEquation(replace(machine, support=None))
    inertia, change = equation.inertia(theta)
    needed = inertia * speed * slope + change * speed**2 / 2 - driving
    pairs = zip(theta.tolist(), speed.tolist(), strict=True)
    torques = np.array([equation.at(angle, rate)[2] for angle, rate in pairs])
    scale = np.max(np.abs(driving))
    np.testing.assert_allclose(np.sum(torques, axis=1), needed, atol=1e-5 * scale)
    assert np.ptp(speed) > 2.0 and np.max(torques[:, -1]) < -0.5


def test_drive_and_dampers_close_over_a_period() -> None:
    """Of a rig that swings: what motor and dampers feed in is what the mounts lose."""
    machine = rig(1.0, *DAMPERS)
    energy = solve_exact(machine, machine.drive.speed, True).energy()
    assert energy.lost > 0
    assert energy.fed_in == pytest.approx(energy.lost, rel=1e-6)


def test_a_motor_goes_with_linear_dampers_only() -> None:
    tabled = TorsionDamper("crank", speeds=(-1.0, 0.0, 1.0), torques=(-1.0, 0.0, 0.5))
    machine = rig(1.0, tabled)
    with pytest.raises(ModelError, match=r"^torsion_dampers\[1\]: a motor on a support is"):
        solve_exact(machine, machine.drive.speed, True)
    assert solve_exact(machine, machine.drive.speed, False).energy().lost > 0
