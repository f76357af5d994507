"""Both methods against the truth, and how often their intervals hold it."""

from __future__ import annotations

from functools import cache
from itertools import product

import numpy as np
import pytest
from scipy.signal import lfilter

import equipoise as eq
from equipoise.measured.decay import Decay, _on_fit, identify_decay
from equipoise.measured.fits import line_of_swings
from equipoise.measured.turning import find_turns
from support.chosen import EXHAUSTIVE, few
from support.sentences import notes_by
from unit.measured.samples import OMEGA, simulated

RUNS, FEW = 80, 30
LEAST, MOST = 0.89, 0.995
"""Coverage of 95 % intervals in so many records: 2.5 standard errors of a share below; not all."""


def test_without_noise_the_whole_record_gives_the_truth() -> None:
    """To rounding; the line to 1e-3, since its polynomials are no cosines."""
    for ratio, coulomb in ((0.02, 0.03), (0.1, 0.0), (0.0, 0.05), (0.25, 0.01)):
        decay = identify_decay(simulated(ratio=ratio, coulomb=coulomb, center=3.0))
        truth = {
            "natural_angular_frequency": OMEGA,
            "damping_ratio": ratio,
            "coulomb_displacement": coulomb,
        }
        for name, value in truth.items():
            assert decay.by_record[name].value == pytest.approx(value, rel=1e-9, abs=1e-12)
            assert decay.by_line[name].value == pytest.approx(value, rel=1e-3, abs=1e-3)


@cache
def identified(
    ratio: float, coulomb: float, noise: float, colour: float = 0.0, runs: int = RUNS
) -> list[Decay]:
    actual = []
    for seed in range(runs):
        rng = np.random.default_rng(seed)
        white = rng.normal(0.0, noise * (1 - colour**2) ** 0.5, 900)
        added = lfilter([1.0], [1.0, -colour], white)[-600:]
        record = simulated(4.0, 600, ratio, coulomb, center=0.2, start=1.2)
        actual.append(identify_decay(eq.measured.Record(record.time, record.displacement + added)))
    return actual


CASES = {
    "both": (0.03, 0.02, 0.01),
    "viscous only": (0.05, 0.0, 0.01),
    "Coulomb only": (0.0, 0.03, 0.01),
    "much noise": (0.02, 0.01, 0.05),
}
NAMES = ("natural_angular_frequency", "damping_ratio", "coulomb_displacement")


# Intervals and their width: the other tests of this file.
@pytest.mark.exhaustive
@pytest.mark.parametrize("case", few(CASES.values(), [CASES["Coulomb only"]]), ids=CASES)
def test_intervals_hold_the_truth_as_often_as_they_say(case: tuple[float, float, float]) -> None:
    """Nineteen times in twenty; the line's frequency more often, its intervals being wide."""
    truth = dict(zip(NAMES, (OMEGA, *case[:2]), strict=True))
    for method, (name, value) in product(("by_record", "by_line"), truth.items()):
        held = [
            q.low <= value <= q.high for q in (getattr(d, method)[name] for d in identified(*case))
        ]
        wide = method == "by_line" and name == NAMES[0]
        assert LEAST <= np.mean(held) <= (1.0 if wide else MOST), (method, name)


@pytest.mark.parametrize("case", few(CASES.values(), [CASES["Coulomb only"]]), ids=CASES)
def test_estimates_do_not_lean_to_one_side(case: tuple[float, float, float]) -> None:
    """Their mean is within half a standard deviation of the truth, by both methods; the mean of so
    few has a fifth of one.
    """
    truth = dict(zip(NAMES, (OMEGA, *case[:2]), strict=True))
    for method, (name, value) in product(("by_record", "by_line"), truth.items()):
        values = np.array(
            [getattr(decay, method)[name].value for decay in identified(*case, runs=FEW)]
        )
        assert abs(np.mean(values) - value) < 0.5 * np.std(values), (method, name)


# Intervals by noise that is white fail above of the same mistake, but for one in the factor.
@EXHAUSTIVE
def test_correlated_noise_widens_the_intervals() -> None:
    """Noise that stays for 30 samples; as white noise it would be held one time in three."""
    case = (0.03, 0.02, 0.01)
    for name, value in zip(NAMES, (OMEGA, *case[:2]), strict=True):
        quantities = [d.by_record[name] for d in identified(*case, 0.9, FEW)]
        assert np.mean([q.low <= value <= q.high for q in quantities]) > 0.85, name
    decays = identified(*case, 0.0, FEW), identified(*case, 0.9, FEW)
    white, coloured = (np.median([_width(item) for item in each]) for each in decays)
    assert coloured > 2 * white


def _width(decay: Decay) -> float:
    quantity = decay.by_record["damping_ratio"]
    assert quantity.low is not None and quantity.high is not None
    return quantity.high - quantity.low


def test_a_higher_confidence_gives_wider_intervals() -> None:
    record = simulated(noise=0.01)
    widths = [_width(identify_decay(record, confidence=share)) for share in (0.5, 0.95, 0.99)]
    assert widths[0] == pytest.approx(widths[1] * 0.6745 / 1.96, rel=0.01)
    assert widths[2] == pytest.approx(widths[1] * 2.576 / 1.96, rel=0.01)


@EXHAUSTIVE
def test_a_plain_regression_would_lean() -> None:
    """Errors in both variables make the slope of a regression too small, not that of this line."""
    slopes, plain = [], []
    for seed in range(60):
        turns = find_turns(simulated(ratio=0.005, coulomb=0.0, noise=0.1, seed=seed))
        slopes.append(np.exp(-line_of_swings(turns, 0.95).loss))
        plain.append(np.polyfit(turns.heights[:-1], turns.heights[1:], 1)[0])
    truth = np.exp(-np.pi * 0.005)
    assert abs(np.median(slopes) - truth) < 0.02
    assert np.median(plain) < truth - 0.03


def test_a_large_record_is_fitted_by_means() -> None:
    record = simulated(count=200_000, noise=0.02)
    decay = identify_decay(record)
    assert 10_000 < len(decay.whole.time) <= 20_000
    assert notes_by(_on_fit, decay.notes, "count", "samples")
    for name, value in zip(NAMES, (OMEGA, 0.03, 0.02), strict=True):
        quantity = decay.by_record[name]
        assert quantity.value == pytest.approx(value, rel=0.01)
        assert quantity.low is not None and quantity.high is not None
        assert quantity.low <= value <= quantity.high
