"""Strokes of sliders and rockers: dead positions, time ratio, dwell.

All is found on the continuous motion: samples only say between which crank angles to look.  A
rocker is a link that is pinned to the frame and swings.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import MISSING, Field, field, fields, replace
from math import isfinite, pi
from typing import Any, Literal

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.errors import ChangePointError, RangeError, UsageError
from equipoise.i18n import Note, to_say
from equipoise.mechanism.assembly.cycle import FEWER_POINTS, MANY_TURNS, POINTS_PER_TURN
from equipoise.mechanism.assembly.linkage import Linkage
from equipoise.mechanism.checks import NamedItems, unknown
from equipoise.mechanism.kinematics.motion import Motion
from equipoise.mechanism.kinematics.tip import largest, roots
from equipoise.mechanism.outputs.declared import guided, pinned
from equipoise.mechanism.parts.machine import Machine
from equipoise.quantities import Dimension
from equipoise.signals import EQUAL, Array, highest_at, within_period

StrokeKind = Literal["slider", "rocker"]
OF_KIND: dict[StrokeKind, Dimension] = {"slider": "length", "rocker": "angle"}


def figure(
    label: str,
    dimension: Dimension | None = None,
    own: bool = False,
    default: Any = MISSING,
    at_least: float | str | None = None,
    unless: str = "",
    limits_crank: str = "",
) -> Any:
    """A figure: its label for readers, and its dimension, or whether it has that of the stroke.

    at_least : what it has to be for a part not to fail, SI units, or the key of the part's table
        that gives it; None where there is no such value.
    unless : key of that table with which nothing is asked of this figure.
    limits_crank : of a speed of the crank from which a contact is lost the field with the crank
        angle of it.
    """
    text = {"label": label, "dimension": dimension, "own": own}
    least = {"at_least": at_least, "unless": unless, "limits_crank": limits_crank}
    return field(metadata=text | least, default=default)


def least_value(declared: Field[Any], part: Any) -> float | None:
    """What a figure has to be at least, SI units; None where nothing is asked of it.

    part : what the file gives of the part, such as the section of a link.
    """
    least, unless = declared.metadata["at_least"], declared.metadata["unless"]
    if unless and getattr(part, unless) is not None:
        return None
    limit: float | None = getattr(part, least) if isinstance(least, str) else least
    return limit


@dataclass(frozen=True)
class DeadPosition:
    """Where something turns back: crank angle, rad, and place there, m or rad; how long it rests
    there from this crank angle on, rad.
    """

    crank_angle: float = figure(to_say("crank angle"), "angle")
    place: float = figure(to_say("place"), own=True)
    rest: float = figure(to_say("rest"), "angle", default=0.0)

    def gone(self, way: int) -> float:
        """Crank angle, rad, at which it goes on as the crank turns, or backwards came."""
        return self.crank_angle + (self.rest if way > 0 else 0.0)


@dataclass(frozen=True)
class Stroke:
    """Figures of a slider (m) or of a rocker (rad); crank angles in rad.

    stroke : largest less smallest place.
    lowest, highest : the smallest and largest place, both dead positions.
    rise, fall : crank angle from the lowest place, after a rest there, to the highest that comes
        next as the crank turns, and from there, after a rest, to the lowest that comes next.
    lowest_rest, highest_rest : crank angle over which it stands still there.
    time_ratio : the longer of these over the shorter: how quick the return is.
    dwell : longest crank angle over which it moves by no more than a hundredth of the stroke.
    least_advantage : smallest force (per m) or torque on it, over the torque of the crank, by
        virtual power; None of what slides on a moving link.  Towards dead positions it has no
        bound.
    dead_positions : all of them, in the order of the crank angle.
    """

    kind: StrokeKind
    stroke: float = figure(to_say("stroke"), own=True)
    lowest: float = figure(to_say("lowest place"), own=True)
    lowest_at: float = figure(to_say("lowest at crank angle"), "angle")
    highest: float = figure(to_say("highest place"), own=True)
    highest_at: float = figure(to_say("highest at crank angle"), "angle")
    rise: float = figure(to_say("crank turns while it rises"), "angle")
    fall: float = figure(to_say("crank turns while it falls"), "angle")
    lowest_rest: float = figure(to_say("crank turns while it rests at the lowest place"), "angle")
    highest_rest: float = figure(to_say("crank turns while it rests at the highest place"), "angle")
    time_ratio: float = figure(to_say("time ratio"))
    dwell: float = figure(to_say("dwell"), "angle")
    dwell_at: float = figure(to_say("dwell begins at crank angle"), "angle")
    least_advantage: float | None = figure(to_say("least mechanical advantage"))
    least_advantage_at: float | None = figure(to_say("least mechanical advantage at"), "angle")
    dead_positions: tuple[DeadPosition, ...] = ()

    @property
    def dimension(self) -> Dimension:
        """Of its places."""
        return OF_KIND[self.kind]

    def to_dict(self) -> dict[str, Any]:
        """As plain data."""
        return vars(self) | {
            "dead_positions": [dict(vars(dead_position)) for dead_position in self.dead_positions]
        }


def declared_figures(of: type = Stroke) -> Iterator[Field[Any]]:
    """Those of a stroke, or of a dead position."""
    return (item for item in fields(of) if "label" in item.metadata)


def dimension_of(machine: Machine, path: str) -> Dimension | None:
    """Dimension of a figure by its path in the strokes of a machine, without places in lists."""
    name, _, last = path.rpartition(".")
    whole = name.removesuffix(".dead_positions")
    for of in (Stroke,) if whole == name else (DeadPosition,):
        for declared_figure in declared_figures(of):
            if declared_figure.name == last:
                slides = any(slider.name == whole for slider in machine.sliders)
                own = OF_KIND["slider" if slides else "rocker"]
                dimension: Dimension | None = (
                    own
                    if declared_figure.metadata["own"]
                    else declared_figure.metadata["dimension"]
                )
                return dimension
    return None


RIVALS = 4
"""Dwells between the samples that are looked at closely: the longest by samples may not be it."""
ZONE, INNER, ROUNDS = 65, 513, 5
"""Crank angles about each end and between both, and how often the ends are looked at closer."""
DIRECTIONS = 64
HALVINGS = 44
"""Of a step, at one end of a rest."""
ALIKE = 1e-5
"""rad: dwells that differ by less are equal, and the first in the cycle is reported."""


@dataclass(frozen=True)
class Dwell:
    """Crank angle over which something moves by no more than a tolerance.

    tolerance : m, or rad.  angle : of the crank, rad.
    begin : crank angle at which it begins, rad, where crank angles rise.
    """

    tolerance: float
    angle: float
    begin: float


@dataclass(frozen=True)
class Path:
    """A closed path of the crank angle: places and derivatives at N equal steps of a cycle.

    Between them it is the polynomial of fifth degree that they determine, whose error is that of
    rounding.

    place : complex (N,).  first, second : derivatives by crank angle.  period : rad.
    """

    place: Array
    first: Array
    second: Array
    period: float = 2 * pi

    @property
    def step(self) -> float:
        """rad between samples."""
        return self.period / len(self.place)

    def at(self, theta: Array) -> Array:
        """Places (K,) at crank angles (K,)."""
        h, count = self.step, len(self.place)
        whole = np.floor(theta / h)
        t, k = theta / h - whole, whole.astype(int) % count
        n = (k + 1) % count
        p, v, a = self.place[k], h * self.first[k], h * h * self.second[k]
        way = self.place[n] - p
        w, b = h * self.first[n], h * h * self.second[n]
        cubic = 10 * way - 6 * v - 4 * w - 1.5 * a + 0.5 * b
        quartic = -15 * way + 8 * v + 7 * w + 1.5 * a - b
        quintic = 6 * way - 3 * (v + w) - 0.5 * (a - b)
        values: Array = p + t * (v + t * (0.5 * a + t * (cubic + t * (quartic + t * quintic))))
        return values


def rests(
    theta: Array, speed: Array, speed_at: Callable[[Array], Array], least: float
) -> list[tuple[float, float]]:
    """Where something stands still: crank angles at which rests begin, and how long they are, rad.

    theta, speed : (N,) equal steps of a cycle, and the derivative there.
    speed_at : that at any crank angles (K,).  least : what is slower stands still.
    """
    still, step = np.abs(speed) <= least, theta[1] - theta[0]
    still &= np.roll(still, 1) | np.roll(still, -1)  # a dead point may be at one sample
    if not np.any(still) or np.all(still):
        return []
    begins = theta[still & ~np.roll(still, 1)]
    ends = theta[still & ~np.roll(still, -1)]
    ends = ends if ends[0] >= begins[0] else np.roll(ends, -1)

    def edge(inside: Array, outside: Array) -> Array:
        for _ in range(HALVINGS):
            middle = 0.5 * (inside + outside)
            rested = np.abs(speed_at(middle)) <= least
            inside, outside = np.where(rested, middle, inside), np.where(rested, outside, middle)
        return inside

    first, last = edge(begins, begins - step), edge(ends, ends + step)
    period = step * len(theta)
    lengths = (last - first) % period
    return list(zip((first % period).tolist(), lengths.tolist(), strict=True))


def longest_dwell(path: Path, tolerance: float) -> Dwell:
    """The longest part of a cycle in which no two places are further apart than a tolerance."""
    if _extent(path.place) <= tolerance:
        return Dwell(tolerance, path.period, 0.0)
    starts, lengths = _sampled(path.place, tolerance)
    if np.max(lengths) >= len(path.place) - 1:
        return Dwell(tolerance, path.period, 0.0)
    pairs: list[tuple[float, float]] = []
    for k in np.argsort(-lengths, kind="stable"):
        low, high = path.step * starts[k], path.step * (starts[k] + lengths[k])
        if len(pairs) == RIVALS or lengths[k] < np.max(lengths) - 2:
            break
        if all(_apart(low, item, path.period) > 2 * path.step for item, _ in pairs):
            pairs.append(_refined(path, low, high, tolerance))
    ends = sorted((float(within_period(np.array(a), path.period)), b - a) for a, b in pairs)
    longest = max(angle for _, angle in ends)
    begin, angle = next((a, b) for a, b in ends if b >= longest - ALIKE)
    return Dwell(tolerance, angle, begin)


def _extent(place: Array) -> float:
    """Distance of two places that are as far apart as any, but for a thousandth of it.

    It is one of those that lie farthest in some direction.
    """
    ways = np.exp(1j * np.arange(DIRECTIONS) * (2 * pi / DIRECTIONS))
    outer = place[[int(np.argmax((place * way).real)) for way in ways]]
    return float(np.max(np.abs(outer[:, None] - outer)))


def _apart(first: float, other: float, period: float) -> float:
    away = abs(first - other) % period
    return min(away, period - away)


def _sampled(place: Array, tolerance: float) -> tuple[Array, Array]:
    """Numbers of the first samples of parts that end at each sample, and their lengths, (N,).

    A part must begin behind every sample that is too far from one of its own.
    """
    count = len(place)
    reach = np.full(count, count)  # samples from each back to the last that is too far from it
    active = np.arange(count)
    for back in range(1, count + 1):
        far = np.abs(place[active] - place[active - back]) > tolerance
        reach[active[far]] = back
        active = active[~far]
        if back & (back - 1) == 0:  # now and then: what others hold back need not look further
            active = active[back < _held_back(reach)[active]]
        if not active.size:
            break
    lengths = _held_back(reach) - 1
    return (np.arange(count) - lengths) % count, lengths


def _held_back(reach: Array) -> Array:
    """Samples (N,) from each back to the last that is too far from it or one between."""
    count = len(reach)
    ends = np.arange(3 * count)  # two cycles before, so that what holds there is known
    last = np.maximum.accumulate(ends - np.tile(reach, 3))
    return np.asarray((ends - last)[2 * count :])


def _refined(path: Path, low: float, high: float, tolerance: float) -> tuple[float, float]:
    """Both ends of a dwell, from those among samples."""
    width = 2 * path.step
    inner = np.linspace(low, high, INNER)
    for _ in range(ROUNDS):
        middle, offsets = 0.5 * (low + high), width * np.linspace(-1.0, 1.0, ZONE)
        left, right = np.minimum(low + offsets, middle), np.maximum(high + offsets, middle)
        between = inner[(inner > left[-1]) & (inner < right[0])]
        theta = np.concatenate([left, between, right])
        places = path.at(theta)
        far = np.abs(places[:ZONE, None] - places) > tolerance
        far &= theta > left[:, None]
        first = np.min(np.where(far, theta, np.inf), axis=1)
        first = np.minimum.accumulate(first[::-1])[::-1]  # what begins earlier holds the later ones
        far = np.abs(places[-ZONE:, None] - places) > tolerance
        far &= theta < right[:, None]
        last = np.maximum.accumulate(np.max(np.where(far, theta, -np.inf), axis=1))
        good = (right < first[:, None]) & (left[:, None] > last)
        lengths = np.where(good, right - left[:, None], 0.0)
        item, other = np.unravel_index(np.argmax(lengths), lengths.shape)
        if good[item, other]:
            low, high = float(left[item]), float(right[other])
        width *= 4 / (ZONE - 1)
    return low, high


SHARE = 0.01
"""Of a stroke, or of the extent of a path: the usual tolerance of a dwell."""
STILL = 1e-12
"""Of the largest rate of all: what is slower stands still."""


# -- what moves ------------------------------------------------------------------------------------


@dataclass(frozen=True)
class _Output:
    """A slider or a rocker that is looked at."""

    name: str
    kind: StrokeKind

    def of(self, motion: Motion) -> tuple[Array, Array, Array]:
        """Place and its derivatives by crank angle, (N,)."""
        if self.kind == "slider":
            slider = motion.sliders[self.name]
            return slider.travel, slider.travel_1, slider.travel_2
        link = motion.links[self.name]
        return link.angle, link.angle_1, link.angle_2


def rockers(linkage: Linkage) -> list[str]:
    """Links that turn about a pin in the frame and swing, driven or not; the cycle is known."""
    machine = linkage.machine
    links = [machine.drive.link] * (not machine.drive.crank) + pinned(machine)
    return [link for link in links if linkage.cycle.windings[link] == 0]


def _motion(linkage: Linkage, theta: Array) -> Motion:
    return Motion(linkage, theta, 1.0, 0.0, False, linkage.solve(theta))


def _grid(linkage: Linkage) -> Array:
    turns = linkage.cycle.turns
    points = POINTS_PER_TURN if turns <= MANY_TURNS else FEWER_POINTS
    return np.arange(points * turns) * (2 * pi / points)


@dataclass(frozen=True)
class _Outputs:
    """Several of them, of which signals (P, K) are had at crank angles (P, K) of their own."""

    linkage: Linkage
    ones: tuple[_Output, ...]

    def at(self, theta: Array) -> tuple[Array, Array, Array]:
        """Places and their derivatives, (P, K)."""
        motion = _motion(self.linkage, theta.ravel())
        rows = range(len(self.ones))
        read = [output.of(motion) for output in self.ones]
        values: Array = np.array(read).reshape(len(rows), 3, *theta.shape)
        place, first, second = (values[rows, k, rows] for k in range(3))
        return place, first, second

    def speed(self, theta: Array) -> Array:
        """First derivative."""
        return self.at(theta)[1]

    def size(self, theta: Array) -> Array:
        """Its size."""
        return np.abs(self.speed(theta))

    def gain(self, theta: Array) -> Array:
        """What has the sign of the derivative of its size."""
        _, first, second = self.at(theta)
        return first * second


def dead_positions(linkage: Linkage, slider: str) -> tuple[DeadPosition, ...]:
    """Where a slider turns back in a cycle, by crank angle; none where it does not.

    Raises
    ------
    MotionError : the crank cannot turn fully.
    """
    output, theta = _Output(slider, "slider"), _grid(linkage)
    table = np.array([output.of(_motion(linkage, theta))])
    return tuple(_dead_positions(_Outputs(linkage, (output,)), theta, table)[0])


# -- figures of a machine --------------------------------------------------------------------------


def strokes(linkage: Linkage) -> Mapping[str, Stroke]:
    """Figures of every slider and rocker by name; none where the crank cannot turn fully."""
    try:
        theta = _grid(linkage)
    except (RangeError, ChangePointError):
        return NamedItems("slider or rocker", ())
    machine = linkage.machine
    ones = [_Output(slider.name, "slider") for slider in machine.sliders]
    ones += [_Output(link, "rocker") for link in rockers(linkage)]
    motion = _motion(linkage, theta)
    samples = {item: np.array(item.of(motion)) for item in ones}
    rates = {item: float(np.max(np.abs(sample[1]))) for item, sample in samples.items()}
    least = STILL * max(rates.values(), default=0.0)
    ways = {
        item: np.ptp(sample[0]) > EQUAL * np.max(np.abs(sample[0]))
        for item, sample in samples.items()
    }
    moving = tuple(item for item in ones if rates[item] > least and ways[item])
    if not moving:
        return NamedItems("slider or rocker", ())
    outputs = _Outputs(linkage, moving)
    table = np.array([samples[item] for item in moving])
    fastest = largest(outputs.size, outputs.gain, theta, np.abs(table[:, 1]))
    dead = _dead_positions(outputs, theta, table)
    for k, entry in enumerate(moving):
        if len(dead[k]) > 1:
            own = _Outputs(linkage, (entry,))
            dead[k] = _rested(own, dead[k], theta, table[k, 1], STILL * rates[entry])
    by_name = {
        item.name: _stroke(item, linkage, table[k], dead[k], (fastest[0][k], fastest[1][k]))
        for k, item in enumerate(moving)
        if len(dead[k]) > 1
    }
    return NamedItems("slider or rocker", by_name.items())


def _dead_positions(
    outputs: _Outputs, theta: Array, table: Array
) -> list[tuple[DeadPosition, ...]]:
    """Where each output turns back: zeros of its speed, all closed in on together.

    table : (P, 3, N), places and derivatives at crank angles theta (N,).
    """
    step = theta[1] - theta[0]
    negative = table[:, 1] < 0
    values = [np.flatnonzero(row) for row in negative != np.roll(negative, -1, axis=1)]
    most = max(map(len, values))
    if not most:
        return [()] * len(values)
    low = np.array([np.resize(theta[k], most) if len(k) else np.zeros(most) for k in values])
    at = roots(outputs.speed, low, low + step)
    place = outputs.at(at)[0]
    period = len(theta) * step
    return [
        tuple(_turning(at[p, : len(k)] % period, place[p, : len(k)])) for p, k in enumerate(values)
    ]


def _rested(
    output: _Outputs, dead: tuple[DeadPosition, ...], theta: Array, speed: Array, least: float
) -> tuple[DeadPosition, ...]:
    """Dead positions of one output, each where a rest begins that it lies in."""
    resting = rests(theta, speed, lambda at: output.speed(at[None])[0], least)
    step = theta[1]
    period, result = step * len(theta), []
    for item in dead:
        inside = (r for r in resting if (item.crank_angle - r[0] + step) % period < r[1] + 2 * step)
        begin, rest = next(inside, (item.crank_angle, 0.0))
        result.append(replace(item, crank_angle=begin, rest=rest))
    return tuple(sorted(result, key=lambda position: position.crank_angle))


def _turning(angles: Array, places: Array) -> list[DeadPosition]:
    """Dead positions by crank angle, without those between which it moves by rounding alone."""
    order = np.argsort(angles)
    dead_positions = [DeadPosition(float(angles[k]), float(places[k])) for k in order]
    least = EQUAL * float(np.ptp(places)) if len(places) else 0.0
    k = 0
    while len(dead_positions) > 2 and k < len(dead_positions):
        if abs(dead_positions[k].place - dead_positions[k - 1].place) <= least:
            del dead_positions[k], dead_positions[k - 1 if k else -1]
            k = 0
        else:
            k += 1
    return dead_positions


def _stroke(
    output: _Output,
    linkage: Linkage,
    samples: Array,
    dead: tuple[DeadPosition, ...],
    fastest: tuple[float, float],
) -> Stroke:
    places = np.array([position.place for position in dead])
    low, high = (dead[highest_at(sign * places, smooth=False)] for sign in (-1, 1))
    period = 2 * pi * linkage.cycle.turns
    stroke = high.place - low.place
    way = 1 if linkage.machine.drive.speed >= 0 else -1
    angles = np.array([position.gone(-way) for position in dead])
    tops, bottoms = (np.abs(places - end.place) <= EQUAL * stroke for end in (high, low))
    rise = float(np.min(way * (angles[tops] - low.gone(way)) % period))
    top = dead[int(np.argmin(np.where(tops, way * (angles - low.gone(way)) % period, np.inf)))]
    fall = float(np.min(way * (angles[bottoms] - top.gone(way)) % period))
    dwell = longest_dwell(_along(samples[0], samples[1], samples[2], period), SHARE * stroke)
    advantage, at = None, None
    holds = output.kind == "rocker" or output.name in guided(linkage.machine)
    if holds and linkage.machine.has_crank:
        advantage, at = 1 / float(fastest[0]), float(fastest[1] % period)
    return Stroke(
        output.kind,
        stroke,
        low.place,
        low.crank_angle,
        high.place,
        high.crank_angle,
        rise,
        fall,
        low.rest,
        top.rest,
        max(rise, fall) / min(rise, fall) if min(rise, fall) else float("nan"),
        dwell.angle,
        dwell.begin,
        advantage,
        at,
        dead,
    )


# -- dwells of anything ----------------------------------------------------------------------------


def dwell(linkage: Linkage, name: str, tolerance: float | None = None) -> Dwell:
    """Longest crank angle over which a slider, link or point moves by no more than a tolerance.

    Of a point, no two of its places there are further apart; of a link, its angle varies by no
    more.

    Parameters
    ----------
    name : of a slider, a link, or a point, in this order.
    tolerance : m, of a link rad; a hundredth of its stroke, of the extent of a point's path, or of
        half a turn of a link that turns fully, if None.

    Raises
    ------
    MotionError : the crank cannot turn fully.
    UsageError : nothing goes by that name, or the tolerance is none.
    """
    if tolerance is not None and not (isfinite(tolerance) and tolerance > 0):
        raise UsageError(
            Note(
                "got {tolerance:g} for the tolerance of a dwell; give more than 0",
                tolerance=tolerance,
            )
        )
    motion, period = _motion(linkage, _grid(linkage)), 2 * pi * linkage.cycle.turns
    if tolerance is None and name in (known := strokes(linkage)):
        tolerance = SHARE * known[name].stroke
    if name in motion.sliders:
        slider = motion.sliders[name]
        parts = (slider.travel, slider.travel_1, slider.travel_2)
        return _dwell_of(_along(*parts, period), tolerance)
    if name in motion.links:
        link = motion.links[name]
        u = np.exp(1j * link.angle)
        path = Path(u, 1j * link.angle_1 * u, (1j * link.angle_2 - link.angle_1**2) * u, period)
        usual = SHARE * min(float(np.ptp(link.angle)), pi)
        angle = usual if tolerance is None else min(tolerance, pi)
        return Dwell(angle, *_ends_of(_dwell_of(path, 2 * np.sin(angle / 2))))
    if name in motion.points:
        point = motion.points[name]
        return _dwell_of(Path(point.place, point.place_1, point.place_2, period), tolerance)
    every = [*motion.sliders, *motion.links, *motion.points]
    raise UsageError(unknown(name, every, "slider, link or point"))


def _along(place: Array, first: Array, second: Array, period: float) -> Path:
    """The path of what moves to and fro."""
    return Path(place + 0j, first + 0j, second + 0j, period)


def _dwell_of(path: Path, tolerance: float | None) -> Dwell:
    if tolerance is None:
        size = abs(complex(np.ptp(path.place.real), np.ptp(path.place.imag)))
        tolerance = SHARE * size
    return longest_dwell(path, tolerance)


def _ends_of(dwell: Dwell) -> tuple[float, float]:
    return dwell.angle, dwell.begin
