"""How long a part bears a load that repeats: rainflow counting, Haigh's diagram, Miner's rule.

A load is cut into cycles as the material feels them, closed loops of stress and strain (ASTM
E1049).  Haigh's diagram, here as Goodman's straight line, makes the amplitude of each an amplitude
about 0 that does as much; the Woehler line says how many of these break the part; and the shares
that all cycles use up add to 1 where it breaks (Palmgren and Miner).
"""

from __future__ import annotations

from itertools import pairwise
from math import inf

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.errors import UsageError
from equipoise.i18n import Note
from equipoise.signals import Array

SMALL = 1e-9
"""Share of the largest size of a load below which a turn back is rounding."""


@dataclass(frozen=True, eq=False)
class LoadCycles:
    """Cycles of a load: (K,) each.

    ranges : highest less lowest.  means : middle of both.  counts : 1, or 0.5 of half cycles.
    """

    ranges: Array
    means: Array
    counts: Array

    def by_range(self) -> list[tuple[float, float]]:
        """Ranges that occur, rising, and how many cycles have each."""
        sizes, where = np.unique(self.ranges, return_inverse=True)
        return [*zip(sizes.tolist(), np.bincount(where, self.counts).tolist(), strict=True)]


def reversals(load: Array) -> Array:
    """Values (K,) at which a load (N,) turns back, with the first and the last one."""
    load = np.asarray(load, float)
    if load.size > 2:  # most values lie on the way up or down
        turns = np.diff(load)[:-1] * np.diff(load)[1:] <= 0
        load = load[np.concatenate([[True], turns, [True]])]
    least = SMALL * float(np.max(np.abs(load), initial=0.0))
    turning_points: list[float] = []
    for value in load.tolist():
        if turning_points and abs(value - turning_points[-1]) <= least:
            continue
        if (
            len(turning_points) > 1
            and (turning_points[-1] - turning_points[-2]) * (value - turning_points[-1]) > 0
        ):
            turning_points[-1] = value
        else:
            turning_points.append(value)
    return np.array(turning_points)


def rainflow(load: Array, repeats: bool = False) -> LoadCycles:
    """Cycles of a load (N,) by ASTM E1049, 5.4.4.

    repeats : whether the load goes on from its end with its begin, as in the cycle of a machine:
        it is counted from its largest size on, and all cycles are whole (5.4.5).

    Raises
    ------
    UsageError : a value is not finite, or there is none.
    """
    load = np.asarray(load, float)
    if load.ndim != 1 or not load.size or not np.all(np.isfinite(load)):
        raise UsageError(Note("rainflow counting needs a list of finite numbers"))
    if repeats:
        load = np.roll(load, -int(np.argmax(np.abs(load))))
        load = np.append(load, load[0])
    parts: list[tuple[float, float, float]] = []
    open_ends: list[float] = []
    for value in reversals(load).tolist():
        open_ends.append(value)
        while len(open_ends) > 2:
            first, second, third = open_ends[-3:]
            if abs(third - second) < abs(second - first):
                break
            mean = (first + second) / 2
            if len(open_ends) > 3:
                parts.append((abs(second - first), mean, 1.0))
                del open_ends[-3:-1]
            else:  # it begins at the start of the load, with which nothing closes it
                parts.append((abs(second - first), mean, 0.5))
                del open_ends[0]
    for first, second in pairwise(open_ends):
        parts.append((abs(second - first), (first + second) / 2, 0.5))
    if repeats and open_ends:  # what is left pairs up, as the load comes back to its begin
        parts = _paired(parts)
    ranges, means, counts = np.array(parts).reshape(-1, 3).T
    return LoadCycles(ranges, means, counts)


def _paired(cycles: list[tuple[float, float, float]]) -> list[tuple[float, float, float]]:
    """Cycles with both halves of each that is cut in two made one."""
    whole = [cycle for cycle in cycles if cycle[2] == 1.0]
    halves = sorted(cycle[:2] for cycle in cycles if cycle[2] == 0.5)
    return whole + [(*half, 1.0) for half in halves[::2]]


def amplitudes_about_zero(cycles: LoadCycles, tensile_strength: float | None) -> Array:
    """Amplitudes (K,), Pa, about a mean of 0 that do as much as cycles of stress: by Goodman's line
    in Haigh's diagram; infinite where the mean alone breaks the part.

    tensile_strength : Pa; means do nothing if None.  Means in compression do nothing, which is on
        the safe side.
    """
    amplitudes = cycles.ranges / 2
    if tensile_strength is None:
        return amplitudes
    left = 1 - np.maximum(cycles.means, 0.0) / tensile_strength
    safe = np.where(left > 0, left, 1.0)
    return np.where((left > 0) | (amplitudes == 0), amplitudes / safe, inf)


@dataclass(frozen=True)
class WoehlerLine:
    """Amplitude of stress about 0 and number of cycles to failure: N = knee (limit / s)^slope.

    limit : amplitude, Pa, at the knee.  knee : cycles.  slope : of the line, on scales of decades.
    endless : whether amplitudes below the limit never break it; else the line goes on as it is.
    """

    limit: float
    knee: float = 1e6
    slope: float = 5.0
    endless: bool = True

    def cycles(self, amplitudes: Array) -> Array:
        """To failure (K,), at amplitudes (K,), Pa."""
        amplitudes = np.asarray(amplitudes, float)
        with np.errstate(divide="ignore", over="ignore"):
            value = self.knee * (self.limit / amplitudes) ** self.slope
        return np.where(self.endless & (amplitudes < self.limit), inf, value)


def damage(cycles: LoadCycles, line: WoehlerLine, tensile_strength: float | None = None) -> float:
    """Share of its life that a part has used up after these cycles, by Miner's rule; infinite where
    it does not outlast the first of them.
    """
    amplitudes = amplitudes_about_zero(cycles, tensile_strength)
    with np.errstate(divide="ignore"):
        return float(np.sum(cycles.counts / line.cycles(amplitudes)))
