"""How one figure scatters over many machines, and how many of them are within its limits."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from math import isnan
from typing import TYPE_CHECKING, Any

import numpy as np

from equipoise.studies.selection import kept
from equipoise.studies.variance import Estimate

if TYPE_CHECKING:
    from equipoise.studies.study import Output

Array = np.ndarray[Any, Any]

PERCENTILES = (0.1, 1.0, 5.0, 50.0, 95.0, 99.0, 99.9)
BEYOND = 10
"""Machines that have to lie beyond a percentile for it to be told."""
BINS, ROUNDING = 40, 1e-12
"""Of a histogram; share of a figure below which its differences are rounding."""


@dataclass(frozen=True, eq=False)
class Scatter:
    """How one figure scatters over the machines that can be computed; in its own SI unit.

    base : of the model as its file has it; NaN where it lacks the figure.
    percentiles : percentage -> the figure below which so many machines are; only those that enough
        machines lie beyond.
    edges, counts : (B + 1,) and (B,) of a histogram.
    below, above : share of all machines under the lower and over the upper limit.
    within : share of all machines within the limits, failed ones counting as outside; None without
        limits.
    """

    output: Output
    base: float
    mean: float
    deviation: float
    least: float
    largest: float
    percentiles: Mapping[float, float]
    edges: Array
    counts: Array
    below: float
    above: float
    within: Estimate | None

    def to_dict(self) -> dict[str, Any]:
        """As plain values in SI units."""
        return {
            "base": None if isnan(self.base) else self.base,
            "mean": self.mean,
            "deviation": self.deviation,
            "least": self.least,
            "largest": self.largest,
            "percentiles": {f"{p:g}": value for p, value in self.percentiles.items()},
            "histogram": {"edges": self.edges, "counts": self.counts},
            "at_least": self.output.at_least,
            "at_most": self.output.at_most,
            "below": self.below,
            "above": self.above,
            "within": None if self.within is None else asdict(self.within),
        }


def scatter_of(output: Output, base: float, figures: Array) -> Scatter:
    """Scatter of one figure, (P,) with NaN where it failed."""
    there = figures[np.isfinite(figures)]
    varies = np.ptp(there) > ROUNDING * np.max(np.abs(there))
    bins = int(np.clip(np.sqrt(there.size), 5, BINS)) if varies else 1
    counts, edges = np.histogram(there, bins)
    enough = [p for p in PERCENTILES if min(p, 100 - p) / 100 * there.size >= BEYOND]
    limited = (output.at_least, output.at_most) != (None, None)
    below = -np.inf if output.at_least is None else output.at_least
    above = np.inf if output.at_most is None else output.at_most
    return Scatter(
        output=output,
        base=float(base),
        mean=float(np.mean(there)),
        deviation=float(np.std(there)),
        least=float(np.min(there)),
        largest=float(np.max(there)),
        percentiles={p: float(np.percentile(there, p)) for p in enough},
        edges=edges,
        counts=counts,
        below=float(np.sum(there < below)) / len(figures),
        above=float(np.sum(there > above)) / len(figures),
        within=share_of(kept([output], figures[:, None])[:, 0]) if limited else None,
    )


def share_of(good: Array) -> Estimate:
    """Share of machines (P,) with its 95 % interval, by Wilson's score."""
    from scipy.stats import binomtest

    number = int(np.sum(good))
    interval = binomtest(number, len(good)).proportion_ci(0.95, method="wilson")
    return Estimate(number / len(good), float(interval.low), float(interval.high))
