"""The exact motion, against an integrator, the equation of motion and the line of half-swings."""

from __future__ import annotations

from math import exp, pi, sqrt
from typing import Any

import numpy as np
import pytest

import equipoise as eq
from support.refusals import refused
from unit.measured.samples import OMEGA, integrated, simulated

CASES = {
    "viscous": (0.05, 0.0, 1.0, 0.0),
    "Coulomb": (0.0, 0.04, -1.0, 0.0),
    "both": (0.03, 0.05, 1.0, 0.0),
    "neither": (0.0, 0.0, 0.7, 0.0),
    "pushed": (0.02, 0.03, 0.1, 9.0),
    "pushed back": (0.02, 0.03, -0.4, -5.0),
    "pushed to the middle": (0.3, 0.2, -1.0, 0.01),
    "barely moves": (0.1, 0.2, -0.1, 1.0),
    "strongly damped": (0.6, 0.02, 1.0, -3.0),
    "held by friction": (0.1, 0.2, 0.15, 0.0),
}


@pytest.mark.parametrize("case", CASES.values(), ids=CASES)
def test_an_integrator_goes_the_same_way(case: tuple[float, float, float, float]) -> None:
    """To 1e-8, which is what the integrator's tolerance leaves after a dozen half-swings."""
    ratio, coulomb, start, velocity = case
    time = np.linspace(0.3, 4.3, 801)
    record = eq.measured.simulate_decay(
        time,
        natural_frequency=OMEGA,
        damping_ratio=ratio,
        coulomb=coulomb,
        start=start + 0.2,
        velocity=velocity,
        center=0.2,
    )
    wanted = integrated(time, OMEGA, ratio, coulomb, start, velocity)
    np.testing.assert_allclose(record.displacement - 0.2, wanted, rtol=0, atol=1e-8)


def turning_points(ratio: float, coulomb: float) -> tuple[Any, float]:
    """Exact displacements at turning points, and the ratio of amplitudes without friction."""
    half = pi / (OMEGA * sqrt(1 - ratio**2))
    record = eq.measured.simulate_decay(
        half * np.arange(12), natural_frequency=OMEGA, damping_ratio=ratio, coulomb=coulomb
    )
    return record.displacement, exp(-pi * ratio / sqrt(1 - ratio**2))


def test_half_swings_lie_on_a_line() -> None:
    """Slope n and intercept m = -2 d (1 + n): (62), with Kf = 1 and so Tf = d."""
    displacement, n = turning_points(0.02, 0.01)
    heights = np.abs(np.diff(displacement))
    m = -2 * 0.01 * (1 + n)
    np.testing.assert_allclose(heights[1:], n * heights[:-1] + m, rtol=1e-13)
    assert -m / (2 * (1 + n)) == pytest.approx(0.01, rel=1e-15)


def test_it_sticks_within_the_friction_of_the_center() -> None:
    record = simulated(duration=30.0, count=3000, ratio=0.0, coulomb=0.03, center=5.0)
    end = record.displacement[-1]
    assert abs(end - 5.0) <= 0.03
    assert np.all(record.displacement[-1000:] == end)


def test_noise_is_the_same_for_the_same_seed() -> None:
    first, other = (simulated(noise=0.01, seed=seed).displacement for seed in (4, 4))
    assert np.array_equal(first, other)
    assert not np.array_equal(first, simulated(noise=0.01, seed=5).displacement)
    assert np.std(first - simulated().displacement) == pytest.approx(0.01, rel=0.1)


@pytest.mark.parametrize(
    ("change", "expected"),
    [
        ({"natural_frequency": 0.0}, {"place": "natural_frequency", "value": 0.0}),
        ({"natural_frequency": "12"}, {"by": "call"}),
        ({"damping_ratio": 1.0}, {"place": "damping_ratio", "damping_ratio": 1.0}),
        ({"coulomb": -0.1}, {"place": "coulomb", "value": -0.1}),
        ({"noise": -1}, {"place": "noise", "value": -1}),
        ({"kind": "volume"}, {"place": "kind"}),
        ({"time": [0.0, 1.0]}, {"count": 2, "least_samples": 12}),
        ({"time": np.zeros(20)}, {"place": "time"}),
        ({"time": [[0.0]]}, {"place": "time", "ndim": 2}),
        ({"time": [*range(12), np.nan]}, {"place": "time", "by": "_column"}),
        ({"time": "long"}, {"place": "time", "by": "_column"}),
    ],
)
def test_what_cannot_be_simulated(change: dict[str, Any], expected: dict[str, Any]) -> None:
    values = {"time": np.arange(20.0), "natural_frequency": 1.0, **change}
    with refused(eq.EquipoiseError, **expected):
        eq.measured.simulate_decay(values.pop("time"), **values)


def test_a_record_needs_as_many_displacements_as_times() -> None:
    with refused(eq.EquipoiseError, count=20, moved=19):
        eq.measured.Record(np.arange(20.0), np.zeros(19))


def test_a_record_cannot_be_changed() -> None:
    values = np.arange(20.0)
    record = eq.measured.Record(values, values)
    values[0] = 7
    assert record.time[0] == 0
    with pytest.raises(ValueError, match="read-only"):
        record.displacement[0] = 1.0
