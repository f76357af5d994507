"""Where a decay turns: which swings there are, and each turning point by a fit around it.

Three passes: the length of a half-swing from the steepest parts of the largest swings; the swings
that stand out of the noise, from means over a sixteenth of a half-swing; each turning point from a
polynomial through the samples around it, so that its place does not depend on single samples.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from math import inf
from typing import Any

import numpy as np

from equipoise.errors import UsageError
from equipoise.measured.record import Record
from equipoise.measured.smoothing import Local, fitted, means, steepest_time, top, zigzag

Array = np.ndarray[Any, Any]

ROUGH = 0.3
"""Of the whole range: swings above it show at once."""
BINS, MOST_BINS = 16, 20_000
"""Means in a half-swing; means, or samples, in the first pass."""
ABOVE_NOISE, LEAST = 8.0, 0.002
"""A swing counts from so many standard deviations of the means on, and of the range."""
AS_LARGE = 0.98
"""The decay begins with the first swing that is so large beside the largest."""
UNEVEN = (0.6, 1.5)
"""Spacing of turning points over the half-period: what lies outside is no free swing."""
PER_HALF_SWING = 6
"""Samples; with fewer the turning points are not seen."""
NEEDED = 3
"""Half-swings: two points of the line."""


@dataclass(frozen=True, eq=False)
class Turns:
    """The turning points of a free decay; one more than there are half-swings.

    time, displacement : (K,), s and m or rad.
    spread : (K,), standard error of each displacement over that of one sample.
    passed : (K - 1,), times at which each half-swing is half done, s.
    passed_spread : (K - 1,), standard error of these times, s.
    noise : standard deviation of the samples about smooth motion.
    """

    time: Array
    displacement: Array
    spread: Array
    passed: Array
    passed_spread: Array
    noise: float

    @property
    def heights(self) -> Array:
        """Each half-swing from its peak to its valley or the other way round, (K - 1,)."""
        return np.abs(np.diff(self.displacement))

    @property
    def side(self) -> float:
        """+1 where the first turning point is a peak, -1 where it is a valley."""
        return 1.0 if self.displacement[0] > self.displacement[1] else -1.0


def find_turns(record: Record) -> Turns:
    """The turning points of the free decay in a record.

    What comes before the largest swing, such as a push and a hold, and what is no longer above the
    noise is left out.

    Raises
    ------
    UsageError
        The displacement does not change, swings grow, too few half-swings or samples in each.
    """
    time, values = record.time, record.displacement
    if np.ptp(values) <= 1e-9 * np.max(np.abs(values)):
        raise UsageError("the displacement does not change; give a record of a free decay")
    half = _half_swing(time, values)
    places = _seen([top(time, values, at, half) for at in _swings(time, values, half)])
    half, places = _even(time, values, places)
    places = _seen(places)
    ends = (_end(record, places, half, -1), _end(record, places, half, 1))
    places = [place for place in (ends[0], *places, ends[1]) if place is not None]
    if len(places) <= NEEDED:
        raise _too_few(len(places) - 1)
    rows = _half_done(time, values, places, half)
    noise = _noise(time, values, half)
    return Turns(
        np.array([place.at for place in places]),
        np.array([place.value for place in places]),
        np.array([place.spread for place in places]),
        np.array([row[0] for row in rows]),
        np.array([row[1] for row in rows]),
        noise,
    )


def _seen(places: list[Local]) -> list[Local]:
    """Those before the first that a gap in the record hides."""
    hidden = [place.spread == inf for place in places]
    kept = hidden.index(True) if True in hidden else len(places)
    if kept < 2:
        raise _too_few(kept - 1)
    return places[:kept]


def _even(time: Array, values: Array, tops: list[Local]) -> tuple[float, list[Local]]:
    """The half-period, s, and the turning points at evenly spaced times instead of at tops.

    Free turning points are evenly spaced whatever the friction; tops are not, since the noise moves
    them to where it adds to the swing, the more the smaller that is.
    """
    times = np.array([place.at for place in tops])
    heights = np.abs(np.diff([place.value for place in tops]))
    half = float(np.median(np.diff(times)))
    if len(heights) > 1:  # friction moves the steepest places less than the tops of small swings
        passed = [at for at, _ in _half_done(time, values, tops, half)]
        half = float(np.polyfit(np.arange(len(heights)), passed, 1, w=heights)[0])
    size = np.minimum(np.append(heights, heights[-1]), np.append(heights[0], heights))
    number = np.arange(len(tops))
    first = _first(times - half * number, size)
    return half, [_near(time, values, first + k * half, half) for k in number]


def _first(times: Array, size: Array) -> float:
    """Time of the first from the times of all (K,), each moved back by whole half-periods, s.

    Friction bends a top more on one side than on the other, which moves it by so much over its
    size; where sizes differ enough to tell, that is taken out.
    """
    if len(times) > 3 and np.max(size) > 2 * np.min(size):
        design = np.column_stack([size, np.ones(len(size))])
        return float(np.linalg.lstsq(design, size * times, rcond=None)[0][0])
    return float(np.average(times, weights=size**2))


def _near(time: Array, values: Array, at: float, half: float) -> Local:
    """The turning point at a time; where a gap in the record leaves little, without slope."""
    place = fitted(time, values, at, half / 3)
    return place if place.spread < 1 else fitted(time, values, at, half / 2, still=True)


def _half_done(
    time: Array, values: Array, places: list[Local], half: float
) -> list[tuple[float, float]]:
    return [steepest_time(time, values, before, after, half) for before, after in pairwise(places)]


def _too_few(count: int) -> UsageError:
    return UsageError(
        f"found {max(count, 0)} of at least {NEEDED} free half-swings above the noise, each from a "
        "peak to a valley or back; give a longer or a clearer record"
    )


# -- first pass ------------------------------------------------------------------------------------


def _half_swing(time: Array, values: Array) -> float:
    """Half a period, s: three times what the largest swings need for the middle half of their way.

    A cosine takes a third of the half-swing for it, and neither a hold before the release nor the
    rest at the end change that.
    """
    time, values = means(time, values, _even_edges(time))
    turns = zigzag(values, ROUGH * float(np.ptp(values)), last=True)
    heights = np.abs(np.diff(values[turns]))
    spans = [
        _middle(time[a : b + 1], values[a : b + 1])
        for a, b, height in zip(turns, turns[1:], heights, strict=False)
        if height >= 0.5 * np.max(heights)
    ]
    half = 3 * float(np.median(spans))
    if half < PER_HALF_SWING * float(np.median(np.diff(time))):
        raise UsageError(
            f"the largest swings take about {half / float(np.median(np.diff(time))):.0f} samples "
            f"each; take {PER_HALF_SWING} or more in a half-swing, and swings that stand out of "
            "the noise"
        )
    return half


def _middle(time: Array, values: Array) -> float:
    """Time from a quarter to three quarters of the way between the ends of a swing."""
    way = (values - values[0]) / (values[-1] - values[0])
    crossed = []
    for share in (0.25, 0.75):
        k = int(np.argmax(way >= share))
        k0 = max(k - 1, 0)
        part = (share - way[k0]) / (way[k] - way[k0]) if way[k] > way[k0] else 0.0
        crossed.append(time[k0] + part * (time[k] - time[k0]))
    return float(crossed[1] - crossed[0])


def _even_edges(time: Array) -> Array:
    """Starts of groups of samples, as many as the first pass can take."""
    step = -(-len(time) // MOST_BINS)
    return np.arange(0, len(time), step)


# -- second pass -----------------------------------------------------------------------------------


def _noise(time: Array, values: Array, half: float) -> float:
    """Standard deviation of the samples about smooth curves, the median over the record."""
    width = half / 3
    centers = np.arange(time[0] + width, time[-1] - width, 2 * width)
    step = max(1, len(centers) // 200)
    found = [fitted(time, values, at, width).noise for at in centers[::step]]
    known = [noise for noise in found if noise is not None]
    return float(np.median(known)) if known else 0.0


def _swings(time: Array, values: Array, half: float) -> list[float]:
    """Times of the inner turning points of the decay, s: the second to the last that is sure."""
    bins = np.floor((time - time[0]) / (half / BINS)).astype(int)
    starts = np.flatnonzero(np.diff(bins, prepend=-1))
    rough_time, rough = means(time, values, starts)
    least = max(ABOVE_NOISE * _noise(rough_time, rough, half), LEAST * float(np.ptp(rough)))
    turns = zigzag(rough, least)
    heights = np.abs(np.diff(rough[turns]))
    if not len(heights):
        raise _too_few(len(turns))
    first = int(np.argmax(heights >= AS_LARGE * np.max(heights) - least))
    places = rough_time[turns[first + 1 :]]
    spacing = np.diff(places) / half
    uneven = (spacing < UNEVEN[0]) | (spacing > UNEVEN[1])
    kept = int(np.argmax(uneven)) + 1 if uneven.any() else len(places)
    if kept < 2:
        if first >= 2 and _regular(rough_time[turns], half):
            raise UsageError(
                "the swings grow from the first to the last; give a record of a decay, in which "
                "they become smaller"
            )
        raise _too_few(len(turns))
    return [float(at) for at in places[:kept]]


def _regular(times: Array, half: float) -> bool:
    spacing = np.diff(times[1:]) / half
    return bool(np.all((spacing > UNEVEN[0]) & (spacing < UNEVEN[1])))


# -- the first and the last turning point ----------------------------------------------------------


def _end(record: Record, inner: list[Local], half: float, sense: int) -> Local | None:
    """The turning point before the first inner one (sense -1) or after the last (1), if any.

    It may be a release or a stop, so only the samples on the side of the swing are used, and the
    swing has to be half done at half its time, as a free one is.
    """
    time, values = record.time, record.displacement
    neighbour = inner[0] if sense < 0 else inner[-1]
    at = neighbour.at + sense * half
    outside = (time[0] - at) if sense < 0 else (at - time[-1])
    if outside > 0.1 * half:
        return None
    window = (at, at + 0.5 * half) if sense < 0 else (at - 0.5 * half, at)
    place = fitted(time, values, at, 0.5 * half, window=window, still=True)
    middle = fitted(time, values, at - sense * 0.5 * half, half / 4)
    height = abs(place.value - neighbour.value)
    least = max(ABOVE_NOISE * (place.noise or 0.0) * place.spread, 1e-9 * abs(neighbour.value))
    if not np.isfinite(height) or height <= least or place.spread == inf:
        return None
    done = abs(middle.value - neighbour.value) / height
    return place if 0.3 < done < 0.7 else None
