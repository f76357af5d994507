"""What designers read off a slider or rocker: stroke, dead positions, time ratio, dwell.

All is found on the continuous motion: samples only say between which crank angles to look.  A
rocker is a link that is pinned to the frame and swings.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from math import isfinite, pi

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.errors import ChangePointError, RangeError, UsageError
from equipoise.i18n import Note
from equipoise.mechanism.assembly.cycle import FEWER_POINTS, MANY_TURNS, POINTS_PER_TURN
from equipoise.mechanism.assembly.linkage import Linkage
from equipoise.mechanism.assembly.steps import Array
from equipoise.mechanism.checks import NamedItems, unknown
from equipoise.mechanism.kinematics.dwell import Dwell, Path, longest_dwell, rests
from equipoise.mechanism.kinematics.motion import Motion
from equipoise.mechanism.kinematics.stroke_figures import DeadPosition, Kind, Stroke
from equipoise.mechanism.kinematics.tip import largest, roots
from equipoise.mechanism.outputs.poles import guided, pinned
from equipoise.signals import EQUAL, highest_at

SHARE = 0.01
"""Of a stroke, or of the extent of a path: the usual tolerance of a dwell."""
STILL = 1e-12
"""Of the largest rate of all: what is slower stands still."""


# -- what moves ------------------------------------------------------------------------------------


@dataclass(frozen=True)
class _Output:
    """A slider or a rocker that is looked at."""

    name: str
    kind: Kind

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
