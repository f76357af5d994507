"""Steady vibration against MuJoCo's inertia matrix and inverse dynamics, integrated in time.

1e-8 of the amplitude: the integration there is good to 1e-11 a step, and the loop of the links is
a Fourier series of 256 orders, which leaves rounding.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest

from equipoise.vibration.exact import solve_exact
from equipoise.vibration.forced import respond
from support import rig_mujoco
from support.conformance import compared
from support.rig_reference import Rig
from support.rigs import RPM, in_package, on_feet, one_row, two_rows
from support.sources import MUJOCO

SAMPLES = 48
CLOSE = 1e-8


@dataclass(frozen=True)
class Case:
    """A rig at a speed, rad/s."""

    rig: Rig
    speed: float


@pytest.mark.exhaustive(but=["rig of one row", "rig on free supports, reversed"])
@compared(MUJOCO, "steady vibration: gauge, forces of mounts, drive torque", CLOSE)
@pytest.mark.parametrize(
    "case",
    [
        Case(one_row(), 193 * RPM),
        Case(two_rows(), 193 * RPM),
        Case(on_feet(), -140 * RPM),
    ],
    ids=["rig of one row", "rig of two rows", "rig on free supports, reversed"],
)
def test_steady_motion(case: Case) -> None:
    """Gauge, mounts and drive torque; MuJoCo starts to look where the package's solution is."""
    machine = in_package(case.rig)
    exact = solve_exact(machine, case.speed, False)
    start = exact.steady.orbit.starts[: 2 * case.rig.freedoms, 0]
    wanted = rig_mujoco.steady(case.rig, case.speed, SAMPLES, start_state=start)
    response = respond(machine, case.speed, "exact")
    theta = case.speed * wanted.times
    gauge = response.gauges["gauge"].displacement
    signals = [(gauge, wanted.gauge), (response.drive.torque, wanted.motor)]
    signals += [(response.mounts[str(k)].force, force) for k, force in enumerate(wanted.mounts.T)]
    for signal, values in signals:
        swing = float(np.ptp(values))
        np.testing.assert_allclose(signal.values(theta), values, rtol=0, atol=CLOSE * swing)
    assert float(gauge.peak_to_peak) == pytest.approx(wanted.peak_to_peak, rel=1e-7)
