"""How a number varies: its values, their distribution, and what is refused."""

from __future__ import annotations

from math import inf, nan
from typing import Any

import numpy as np
import pytest
from scipy import stats

from equipoise.design.variables import SPREADS, Choices, Normal, NumberSpread, Range, Uniform
from equipoise.errors import UsageError
from support.refusals import refused

EVEN = (np.arange(20_000) + 0.5) / 20_000
"""Places so even that a distribution function is met to 1 / 20000."""

DISTRIBUTIONS = {
    "range": (Range(-1.0, 3.0), stats.uniform(-1, 4).cdf),
    "normal": (Normal(2.0, 0.5), stats.norm(2, 0.5).cdf),
    "cut": (Normal(2.0, 0.5, 1.5), stats.truncnorm(-1.5, 1.5, 2, 0.5).cdf),
    "uniform": (Uniform(1.0, 0.25), stats.uniform(0.75, 0.5).cdf),
}


@pytest.mark.parametrize(("spread", "cdf"), DISTRIBUTIONS.values(), ids=DISTRIBUTIONS)
def test_distributions(spread: NumberSpread, cdf: object) -> None:
    """Against the distribution functions of SciPy."""
    assert stats.kstest(spread.at(EVEN), cdf).statistic < 1 / 20_000


def test_the_ends() -> None:
    """Places next to 0 and 1, and these themselves, give finite values inside the limits."""
    ends = np.array([0.0, 2.0**-54, 1 - 2.0**-53, 1.0])
    assert list(Range(0.1, 0.7).at(ends)[[0, -1]]) == [0.1, 0.7]
    assert list(Choices((5.0, 4.0)).at(ends)) == [5, 5, 4, 4]
    assert np.all(np.abs(Normal(0.0, 1.0).at(ends)) < 8.4)
    assert Normal(1.0, 1.0, 3.0).at(ends)[[0, -1]] == pytest.approx([-2.0, 4.0], abs=1e-12)
    assert list(Uniform(2.0, 1.0).at(ends)[[0, -1]]) == [1.0, 3.0]


def test_lists_are_hit_alike() -> None:
    values, counts = np.unique(Choices((1, 2, 5)).at(EVEN[:19_998]), return_counts=True)
    assert list(values) == [1, 2, 5]
    assert np.ptp(counts) <= 2


def test_whole_numbers() -> None:
    spread = Range(17, 20, whole=True)
    values, counts = np.unique(spread.at(EVEN), return_counts=True)
    assert list(values) == [17, 18, 19, 20]
    assert set(counts) == {5000}
    assert spread.at(np.array([1.0]))[0] == 20
    assert list(Range(17, 23, 4, whole=True).levels) == [17, 19, 21, 23]


def test_levels() -> None:
    assert list(Range(0.0, 1.0, 5).levels) == [0, 0.25, 0.5, 0.75, 1]
    assert list(Choices((3, 1)).levels) == [3, 1]


def test_which_are_tolerances() -> None:
    spreads = (Range(0, 1), Choices((1,)), Normal(0, 1), Uniform(0, 1))
    assert [spread.tolerance for spread in spreads] == [False, False, True, True]
    assert tuple(SPREADS.values()) == tuple(map(type, spreads))


REFUSED = {
    "order": (lambda: Range(2, 1), {"by": "Range.__post_init__"}),
    "same": (lambda: Range(1, 1), {"by": "Range.__post_init__"}),
    "infinite": (lambda: Range(0, inf), {"value": "inf"}),
    "nan": (lambda: Choices((1, nan)), {"value": "nan"}),
    "steps": (lambda: Range(0, 1, 1), {"steps": 1, "most_steps": 1000000}),
    "no whole": (lambda: Range(1.5, 3, whole=True), {"end": 1.5}),
    "nothing": (lambda: Choices(()), {"by": "Choices.__post_init__"}),
    "twice": (lambda: Choices((1, 2, 1)), {"by": "Choices.__post_init__"}),
    "deviation": (lambda: Normal(0, 0), {"deviation": 0}),
    "cut": (lambda: Normal(0, 1, 0), {"cut": 0}),
    "half width": (lambda: Uniform(0, -1), {"half_width": -1}),
    "no steps": (lambda: Range(0, 1).levels, {"by": "Range.levels"}),
    "normal grid": (lambda: Normal(0, 1).levels, {"by": "Normal.levels"}),
    "uniform grid": (lambda: Uniform(0, 1).levels, {"by": "Uniform.levels"}),
    "odd steps": (
        lambda: Range(1, 4, 3, whole=True).levels,
        {"steps": 3, "low": 1, "high": 4, "count": 4},
    ),
}


@pytest.mark.parametrize(("make", "expected"), REFUSED.values(), ids=REFUSED)
def test_refused(make: object, expected: dict[str, Any]) -> None:
    with refused(UsageError, **expected):
        make()  # type: ignore[operator]
