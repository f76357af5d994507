"""Dampers, stops and resistances of a machine on a support, whose crank a motor turns at a speed
that is not constant.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import equipoise as eq
from equipoise.mechanism import Machine, TorsionDamper
from equipoise.mechanism.parts.resistances import Resistance
from equipoise.mechanism.parts.stops import Stop
from equipoise.running.equation import CrankEquation
from equipoise.vibration.exact import solve_exact

SAMPLES = 1600
DAMPERS = (TorsionDamper("crank", damping=0.05), TorsionDamper("coupler", "rocker", 0.02))
TABLED = TorsionDamper("crank", speeds=(-10.0, 0.0, 20.0, 30.0), torques=(-1.0, 0.0, 0.5, 2.0))
LAWS = {
    "linear": {"torsion_dampers": DAMPERS},
    "tabled": {"torsion_dampers": (TABLED,)},
    "stop": {"stops": (Stop("coupler", "P", "A", 200.0, restitution=0.5, speed=2.0),)},
    "dry": {"resistances": (Resistance("coupler", "P", "A", force=3.0, damping=0.5, speed=0.4),)},
}
"""Of each law, keys of a machine; the tip P is beyond the stop for half of a turn."""


def rig(heavier: float, **elements: Any) -> Machine:
    """A planting mechanism on a rig that is so many times as hard to swing."""
    machine = eq.load("yamashita-rig").without_friction()
    assert machine.support is not None
    inertia = machine.support.pivot_inertia
    assert inertia is not None
    support = replace(machine.support, pivot_inertia=heavier * inertia)
    return replace(machine, support=support, **elements)


@pytest.mark.exhaustive(but=["stop", "linear"])
@pytest.mark.parametrize("law", LAWS)
def test_on_a_support_that_stands_still_the_crank_obeys_the_equation_of_a_run(law: str) -> None:
    """J q.. + J' q.^2 / 2 = Q + T, with q.. by the derivative of the speed along the way.

    The support still swings by 1e-8 of what it would; the derivative is good to 1e-6, and beside
    the corners of a table or of a stop to 1e-3.
    """
    machine = rig(1e8, **LAWS[law])
    solution = solve_exact(machine, machine.drive.speed, True)
    system = solution.system
    theta = np.linspace(0.0, 2 * np.pi, SAMPLES + 1)[:-1]
    states = np.asarray(solution.steady.orbit.at(theta))
    speed = system.crank_speed(states)
    orders = np.fft.rfftfreq(SAMPLES, 1 / SAMPLES)
    slope = np.fft.irfft(1j * orders * np.fft.rfft(speed), SAMPLES)
    driving = system.drive_torque(system.sums(theta), states)
    equation = CrankEquation(replace(machine, support=None))
    inertia, change = equation.inertia(theta)
    needed = inertia * speed * slope + change * speed**2 / 2 - driving
    pairs = zip(theta.tolist(), speed.tolist(), strict=True)
    torques = np.array([
        [source.torque(values[part], np.asarray(rate), ())
         for source, part in zip(equation.sources, equation.slices, strict=True)]
        for angle, rate in pairs for values in [equation.table.at(angle)[0]]
    ])  # fmt: skip
    scale = np.max(np.abs(driving))
    smooth = law in ("linear", "dry")
    np.testing.assert_allclose(
        np.sum(torques, axis=1), needed, atol=(1e-5 if smooth else 1e-3) * scale
    )
    assert np.ptp(speed) > 2.0 and np.ptp(torques[:, -1]) > 0.05 * scale


@pytest.mark.parametrize("law", LAWS)
def test_drive_and_force_elements_close_over_a_period(law: str) -> None:
    """Of a rig that swings: what motor and force elements feed in is what the mounts lose."""
    machine = rig(1.0, **LAWS[law])
    energy = solve_exact(machine, machine.drive.speed, True).energy()
    assert energy.lost > 0
    assert energy.fed_in == pytest.approx(energy.lost, rel=1e-6)


def test_a_table_of_one_line_is_a_linear_damper() -> None:
    line = TorsionDamper("crank", speeds=(-1.0, 0.0, 1.0), torques=(-0.05, 0.0, 0.05))
    tabled, linear = (
        solve_exact(machine, machine.drive.speed, True).steady.orbit.starts
        for machine in (rig(1.0, torsion_dampers=(item,)) for item in (line, DAMPERS[0]))
    )
    np.testing.assert_allclose(tabled[:-2], linear[:-2], rtol=1e-9, atol=1e-12)
