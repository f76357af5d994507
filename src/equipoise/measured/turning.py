"""Where a decay turns: which swings there are, and each turning point by a fit around it.

Three passes: the length of a half-swing from the steepest parts of the largest swings; the swings
that stand out of the noise, from means over a sixteenth of a half-swing; each turning point from a
polynomial through the samples around it, so that its place does not depend on single samples.
"""

from __future__ import annotations

from itertools import pairwise
from math import inf

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.decompositions import lstsq
from equipoise.errors import UsageError
from equipoise.i18n import Note
from equipoise.measured.record import (
    Local,
    Record,
    Samples,
    fitted,
    means,
    steepest_time,
    top,
    zigzag,
)
from equipoise.signals import Array

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
    whole = Samples(record.time, record.displacement)
    if np.ptp(whole.values) <= 1e-9 * np.max(np.abs(whole.values)):
        raise UsageError(Note("the displacement does not change; give a record of a free decay"))
    half = _half_swing(whole)
    places = _visible([top(whole, at, half) for at in _swings(whole, half)])
    half, places = _even(whole, places)
    places = _visible(places)
    first, last = (_end(whole, places, half, sense) for sense in (-1, 1))
    places = [place for place in (first, *places, last) if place is not None]
    if len(places) <= NEEDED:
        raise _too_few(len(places) - 1)
    time, displacement, spread = np.array(
        [(place.at, place.value, place.spread) for place in places]
    ).T
    halves = [steepest_time(whole, *ends, half) for ends in pairwise(places)]
    passed, passed_spread = np.array(halves).T
    return Turns(time, displacement, spread, passed, passed_spread, _noise(whole, half))


def _visible(places: list[Local]) -> list[Local]:
    """Those before the first that a gap in the record hides."""
    hidden = [place.spread == inf for place in places]
    count = hidden.index(True) if True in hidden else len(places)
    if count < 2:
        raise _too_few(count - 1)
    return places[:count]


def _even(whole: Samples, tops: list[Local]) -> tuple[float, list[Local]]:
    """The half-period, s, and the turning points at evenly spaced times instead of at tops.

    Free turning points are evenly spaced whatever the friction; tops are not, since the noise moves
    them to where it adds to the swing, the more the smaller that is.
    """
    times = np.array([place.at for place in tops])
    heights = np.abs(np.diff([place.value for place in tops]))
    half = float(np.median(np.diff(times)))
    if len(heights) > 1:  # friction moves the steepest places less than the tops of small swings
        passed = [steepest_time(whole, *ends, half)[0] for ends in pairwise(tops)]
        line = np.column_stack([np.arange(len(heights)), np.ones(len(heights))])
        half = float(lstsq(line * heights[:, None], heights * passed)[0][0])
    size = np.minimum(np.append(heights, heights[-1]), np.append(heights[0], heights))
    number = np.arange(len(tops))
    first = _first(times - half * number, size)
    places = []
    for at in first + number * half:
        place = fitted(whole, at, half / 3)
        if not place.spread < 1:  # a gap in the record leaves little: without slope
            place = fitted(whole, at, half / 2, still=True)
        places.append(place)
    return half, places


def _first(times: Array, size: Array) -> float:
    """Time of the first from the times of all (K,), each moved back by whole half-periods, s.

    Friction bends a top more on one side than on the other, which moves it by so much over its
    size; where sizes differ enough to estimate that shift, it is removed.
    """
    if len(times) > 3 and np.max(size) > 2 * np.min(size):
        design = np.column_stack([size, np.ones(len(size))])
        return float(lstsq(design, size * times, rcond=None)[0][0])
    return float(np.average(times, weights=size**2))


def _too_few(count: int) -> UsageError:
    return UsageError(
        Note(
            "found {count} of at least {needed} free half-swings above the noise, "
            "each from a peak to a valley or back; give a longer or a clearer record",
            count=max(count, 0),
            needed=NEEDED,
        )
    )


# -- first pass ------------------------------------------------------------------------------------


def _half_swing(whole: Samples) -> float:
    """Half a period, s: three times what the largest swings need for the middle half of their way.

    A cosine takes a third of the half-swing for it, and neither a hold before the release nor the
    rest at the end change that.
    """
    step = -(-len(whole.time) // MOST_BINS)
    time, values = means(whole, np.arange(0, len(whole.time), step))
    turns = zigzag(values, ROUGH * float(np.ptp(values)), last=True)
    heights = np.abs(np.diff(values[turns]))
    spans = [
        _middle(time[a : b + 1], values[a : b + 1])
        for a, b, height in zip(turns, turns[1:], heights, strict=False)
        if height >= 0.5 * np.max(heights)
    ]
    half = 3 * float(np.median(spans))
    samples = half / float(np.median(np.diff(time)))
    if samples < PER_HALF_SWING:
        raise UsageError(
            Note(
                "the largest swings take about {samples:.0f} samples each; take "
                "{per_half_swing} or more in a half-swing, and swings that stand out of "
                "the noise",
                samples=samples,
                per_half_swing=PER_HALF_SWING,
            )
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


# -- second pass -----------------------------------------------------------------------------------


def _noise(samples: Samples, half: float) -> float:
    """Standard deviation of the samples about smooth curves, the median over the record."""
    width = half / 3
    centers = np.arange(samples.time[0] + width, samples.time[-1] - width, 2 * width)
    step = max(1, len(centers) // 200)
    noises = [fitted(samples, at, width).noise for at in centers[::step]]
    known = [noise for noise in noises if noise is not None]
    return float(np.median(known)) if known else 0.0


def _swings(whole: Samples, half: float) -> list[float]:
    """Times of the inner turning points of the decay, s: the second to the last that is sure."""
    bins = np.floor((whole.time - whole.time[0]) / (half / BINS)).astype(int)
    rough = means(whole, np.flatnonzero(np.diff(bins, prepend=-1)))
    least = max(ABOVE_NOISE * _noise(rough, half), LEAST * float(np.ptp(rough.values)))
    turns = zigzag(rough.values, least)
    heights = np.abs(np.diff(rough.values[turns]))
    if not len(heights):
        raise _too_few(len(turns))
    first = int(np.argmax(heights >= AS_LARGE * np.max(heights) - least))
    places = rough.time[turns[first + 1 :]]
    uneven = _uneven(places, half)
    count = int(np.argmax(uneven)) + 1 if uneven.any() else len(places)
    if count < 2:
        if first >= 2 and not _uneven(rough.time[turns[1:]], half).any():
            raise UsageError(
                Note(
                    "the swings grow from the first to the last; give a record of a decay, "
                    "in which they become smaller"
                )
            )
        raise _too_few(len(turns))
    return [float(at) for at in places[:count]]


def _uneven(times: Array, half: float) -> Array:
    """Which spacings of turning points no free swing has."""
    spacing = np.diff(times) / half
    return np.asarray((spacing < UNEVEN[0]) | (spacing > UNEVEN[1]))


# -- the first and the last turning point ----------------------------------------------------------


def _end(whole: Samples, inner: list[Local], half: float, sense: int) -> Local | None:
    """The turning point before the first inner one (sense -1) or after the last (1), if any.

    It may be a release or a stop, so only the samples on the side of the swing are used, and the
    swing has to be half done at half its time, as a free one is.
    """
    neighbour, end = (inner[0], whole.time[0]) if sense < 0 else (inner[-1], whole.time[-1])
    at = neighbour.at + sense * half
    if sense * (at - end) > 0.1 * half:
        return None
    place = fitted(whole, at, 0.5 * half, still=True, side=-sense)
    middle = fitted(whole, at - sense * 0.5 * half, half / 4)
    height = abs(place.value - neighbour.value)
    least = max(ABOVE_NOISE * (place.noise or 0.0) * place.spread, 1e-9 * abs(neighbour.value))
    if not np.isfinite(height) or height <= least or place.spread == inf:
        return None
    done = abs(middle.value - neighbour.value) / height
    return place if 0.3 < done < 0.7 else None
