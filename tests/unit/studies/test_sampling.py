"""Designs by number: the same whichever part is asked for, and distributed as they should be."""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from itertools import product

import numpy as np
import pytest
from scipy import stats
from scipy.stats import qmc

from equipoise.design.variables import Choices, Normal, Range, Uniform
from equipoise.errors import UsageError
from equipoise.studies.study import Correlation, Study, samples, unit_samples, values_at
from support.refusals import refused
from unit.studies.samples import correlated, study

RANDOM = ("sobol", "latin-hypercube", "monte-carlo")
THREE = (Range(0.1, 0.2), Normal(0.07, 0.001, 3.0), Choices((10.0, 20.0, 30.0)))


def parts(size: int, seed: int) -> Iterator[tuple[int, int]]:
    """Start and count of parts of all designs, out of order, some of them empty."""
    random = np.random.default_rng(seed)
    cuts = np.sort(random.integers(0, size, 12))
    ends = np.concatenate([[0], cuts, [size]])
    for place in random.permutation(len(ends) - 1):
        yield int(ends[place]), int(ends[place + 1] - ends[place])


@pytest.mark.parametrize("method", [*RANDOM, "grid"])
def test_any_part_is_the_same_bytes(method: str) -> None:
    if method == "grid":
        varied = study(Range(0.1, 0.2, 17), THREE[2], Range(1, 2, 9), method=method, designs=None)
    else:
        varied = study(*THREE, method=method, designs=459)
    whole, unit = samples(varied, 0, varied.size), unit_samples(varied, 0, varied.size)
    assert whole.shape == unit.shape == (459, 3)
    assert whole.dtype == unit.dtype == np.float64
    for start, count in parts(varied.size, 5):
        assert samples(varied, start, count).tobytes() == whole[start : start + count].tobytes()
        assert unit_samples(varied, start, count).tobytes() == unit[start : start + count].tobytes()
    assert np.all((unit > 0) & (unit < 1))


@pytest.mark.parametrize("method", RANDOM)
def test_threads_do_not_disturb_each_other(method: str) -> None:
    varied = study(*THREE, method=method, designs=20_000)
    whole = samples(varied, 0, 20_000)
    starts = range(0, 20_000, 500)
    with ThreadPoolExecutor(4) as threads:
        drawn = threads.map(lambda start: samples(varied, start, 500), [*starts[::-1]])
    assert np.array_equal(np.concatenate([*drawn][::-1]), whole)


@pytest.mark.parametrize("method", RANDOM)
def test_seeds_differ_and_hold(method: str) -> None:
    first, again, other = (
        unit_samples(study(*THREE, method=method, seed=seed), 0, 64) for seed in (1, 1, 2)
    )
    assert np.array_equal(first, again)
    assert not np.any(first == other)


def test_studies_in_turn() -> None:
    """A thread that computes two studies in turn gives each its own designs."""
    first, two = study(*THREE[:2]), study(*THREE)
    whole = [samples(first, 0, 64), samples(two, 0, 64)]
    for start in (0, 32, 16):
        assert np.array_equal(samples(first, start, 16), whole[0][start : start + 16])
        assert np.array_equal(samples(two, start, 16), whole[1][start : start + 16])


# -- each method -----------------------------------------------------------------------------------


def test_grid() -> None:
    """Every combination once, the last number first; as places, the middle of each step."""
    varied = study(Range(0.1, 0.2, 3), Choices((5.0, 4.0)), method="grid", designs=None)
    assert varied.shape == (3, 2)
    expected = [*product(np.linspace(0.1, 0.2, 3), (5.0, 4.0))]
    assert samples(varied, 0, 6).tolist() == [list(pair) for pair in expected]
    places = [*product((1 / 6, 1 / 2, 5 / 6), (1 / 4, 3 / 4))]
    assert unit_samples(varied, 0, 6) == pytest.approx(np.array(places))


def test_sobol_is_a_sobol_sequence() -> None:
    """Each of all 2^k boxes of the same shape holds as many points, and far less discrepancy."""
    varied = study(*THREE[:2], designs=1024)
    unit = unit_samples(varied, 0, 1024)
    for exponent in range(11):
        boxes = np.floor(unit * [2**exponent, 2 ** (10 - exponent)]) @ [1, 2**exponent]
        assert len(np.unique(boxes)) == 1024
    random = unit_samples(study(*THREE[:2], method="monte-carlo", designs=1024), 0, 1024)
    assert qmc.discrepancy(unit) < 0.05 * qmc.discrepancy(random)


def test_sobol_says_nothing_of_odd_numbers() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert len(samples(study(*THREE, designs=1000, seed=77), 0, 1000)) == 1000


@pytest.mark.parametrize("size", [1, 7, 1000])
def test_latin_hypercube_hits_each_stratum_once(size: int) -> None:
    varied = study(*THREE, method="latin-hypercube", designs=size)
    pieces = [unit_samples(varied, *part) for part in sorted(parts(size, 3))]
    strata = np.floor(np.concatenate(pieces) * size).astype(int)
    assert np.array_equal(np.sort(strata, axis=0), np.tile(np.arange(size)[:, None], 3))
    if size == 1000:  # the columns are shuffled each for itself
        assert np.all(np.abs(np.corrcoef(strata.T) - np.eye(3)) < 4 / np.sqrt(size))


def test_monte_carlo_is_random() -> None:
    unit = unit_samples(study(*THREE, method="monte-carlo", designs=50_000), 0, 50_000)
    for column in unit.T:
        assert stats.kstest(column, "uniform").pvalue > 1e-3
    assert np.all(np.abs(np.corrcoef(unit.T) - np.eye(3)) < 4 / np.sqrt(50_000))


def test_far_designs() -> None:
    """The last of very many cost no more than the way there."""
    varied = study(*THREE, designs=10_000_000)
    assert np.array_equal(samples(varied, 9_999_990, 10)[5:], samples(varied, 9_999_995, 5))


@pytest.mark.parametrize(("start", "count"), [(-1, 2), (60, 5), (65, 0), (0, -1)])
def test_designs_that_there_are_not(start: int, count: int) -> None:
    with refused(UsageError, size=64):
        samples(study(*THREE), start, count)


# -- correlations ----------------------------------------------------------------------------------


def many(varied: Study) -> np.ndarray:
    return samples(varied, 0, varied.size)


def test_correlations_are_those_asked_for() -> None:
    """Of two normal spreads by Pearson, of others by rank: 6 / pi asin(r / 2) of a copula."""
    spreads = (Normal(0.2, 0.01), Normal(0.07, 0.001), Uniform(20, 1), Range(0.1, 0.2))
    asked = {(0, 1): 0.8, (0, 2): -0.5, (1, 2): -0.3}
    base = study(*spreads, designs=100_000, method="monte-carlo")
    paths = base.paths
    together = tuple(Correlation(paths[i], paths[j], r) for (i, j), r in asked.items())
    values = many(study(*spreads, designs=100_000, method="monte-carlo", correlations=together))
    near = 4 / np.sqrt(100_000)
    assert np.corrcoef(values.T)[0, 1] == pytest.approx(0.8, abs=near)
    ranks = stats.spearmanr(values).statistic
    for (i, j), r in asked.items():
        assert ranks[i, j] == pytest.approx(6 / np.pi * np.arcsin(r / 2), abs=near)
    assert np.all(np.abs(ranks[3, :3]) < near)
    assert np.array_equal(values[:, 3], many(base)[:, 3])


@pytest.mark.parametrize("method", RANDOM)
def test_correlations_leave_each_spread_alone(method: str) -> None:
    """By Kolmogorov and Smirnov's test."""
    varied = correlated(0.95)
    varied = study(
        *(item.spread for item in varied.vary),
        method=method, designs=4096, correlations=varied.correlations,
    )  # fmt: skip
    mass, length, speed = many(varied).T
    assert stats.kstest(mass, stats.norm(0.2, 0.01).cdf).pvalue > 1e-3
    assert stats.kstest(length, stats.uniform(0.069, 0.002).cdf).pvalue > 1e-3
    assert stats.kstest(speed, stats.truncnorm(-2, 2, 20, 1).cdf).pvalue > 1e-3
    assert np.max(np.abs(speed - 20)) <= 2
    assert stats.spearmanr(mass, speed).statistic == pytest.approx(
        6 / np.pi * np.arcsin(0.95 / 2), abs=0.01
    )


def test_places_of_ones_own() -> None:
    """As the analysis of variance uses them: the middle is the median of every spread."""
    values = values_at(correlated(), np.full((1, 3), 0.5))
    assert values[0] == pytest.approx([0.2, 0.07, 20.0], rel=1e-15)
