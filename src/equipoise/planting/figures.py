"""Figures of the tip's motion, its path over ground, and what inertia does to the machine.

Everything runs in the sense of time: ``way`` is the crank angle that the drive has turned, counted
positive whichever way it turns.

Every figure has a dotted name, as in the output, and an array (P,) of values in SI units; NaN
where a design does not have it.  Those of a further arm have its tip in front of their name.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Mapping
from functools import partial
from itertools import chain, takewhile
from typing import Any, ClassVar, TypeVar

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.mechanism.assembly.family import column
from equipoise.mechanism.assembly.steps import State, p, u
from equipoise.mechanism.dynamics.forces import inertia_moved, massless
from equipoise.mechanism.formulas import kernels
from equipoise.mechanism.formulas.kernels import cross, dot
from equipoise.mechanism.kinematics.tip import (
    STEP,
    CurveFunction,
    TipCurve,
    crossings,
    integral,
    largest,
    lowest_within,
    roots,
    smallest,
)
from equipoise.planting.names import SHAKING_FIGURES
from equipoise.planting.stroke import (
    StrokeFigures,
    acceleration_of_drive,
    clearances,
    direction,
    finger_base,
    ground_drive,
    in_time,
    in_time_slope,
    instant,
    pick_up,
    release,
    soil_crossings,
    while_driving,
    whole_cycle,
    wrapped,
)
from equipoise.results.declaring import Declarations, ResultOutput
from equipoise.signals import Array

STILL = 1e-9
"""Rate of the path, over its largest, at which the tip counts as standing still over ground."""
NEAREST = 14
"""Halvings of a step, by which samples crowd about a place where the path is slow: a loop may be
as small as the last of them."""
SMALLEST_LOOP = 1e-9
"""Height and width of a loop, over the height of the whole curve, below which it is a cusp."""
MOST_NODES = 6000
"""Pieces of a cycle among which crossings are looked for, whose number goes with the square."""
AT_ONCE, PIECES = 256, 4096
"""Loops that are measured, and pieces of the path that are followed, in one call: memory."""
MOST_STEPS, CLOSED = 20, 1e-12
"""Steps of Newton's method for a crossing, and the step (rad) at which it has been found."""


@dataclass(frozen=True)
class Loop:
    """A loop of the path over ground: the tip comes back to a place where it has been.

    first, second : crank angles, rad.  way : crank angle turned in between, rad.
    y : height of the crossing in the frame, m.  height, width : m.  area : m2.
    in_soil : whether the crossing lies below the surface.
    """

    first: float
    second: float
    way: float
    y: float
    height: float
    width: float
    area: float
    in_soil: bool

    declared: ClassVar[Declarations] = {
        "first": ResultOutput("crank angle of the first pass of the crossing", "angle"),
        "second": ResultOutput("crank angle of the second pass", "angle"),
        "way": ResultOutput("crank angle turned in between", "angle"),
        "y": ResultOutput("height of the crossing in the frame", "length"),
        "height": ResultOutput("height of the loop", "length"),
        "width": ResultOutput("width of the loop", "length"),
        "area": ResultOutput("area of the loop, m2"),
        "in_soil": ResultOutput("whether the crossing lies below the surface"),
    }


class GroundPath:
    """Path of the tip of one machine over ground."""

    def __init__(self, curve: TipCurve) -> None:
        self.curve = curve
        speed, forward = float(curve.speed[0, 0]), float(curve.forward[0, 0])
        self.sense = 1.0 if speed > 0 else -1.0
        self.drive = forward / abs(speed)
        self.samples = np.append(curve.theta, curve.period)
        self.slow = crossings(self.rate_slope, self.samples)

    def place(self, way: Array) -> Array:
        """Places over ground, m, complex, as many as ways; over that at crank angle 0."""
        turned = self.sense * way.reshape(1, -1)
        return self.curve.at(turned).place.reshape(way.shape) + self.drive * way

    def rate(self, way: Array) -> Array:
        """Derivative of `place` by `way`, m, complex, as many as ways."""
        turned = self.sense * way.reshape(1, -1)
        return self.sense * self.curve.at(turned).place_1.reshape(way.shape) + self.drive

    def rate_slope(self, way: Array) -> Array:
        """A signal with the sign of the derivative of the rate's size."""
        tip = self.curve.at(self.sense * way)
        slope: Array = kernels.dot(self.sense * tip.place_1 + self.drive, tip.place_2)
        return slope

    def crank_angle(self, way: float) -> float:
        """Crank angle within one cycle, rad."""
        return float(wrapped(self.curve, np.array(self.sense * way)))

    def cusps(self) -> tuple[float, ...]:
        """Crank angles at which the tip stands still over ground for an instant."""
        if not self.drive or not self.slow.size:
            return ()
        rates = np.abs(self.rate(self.slow[None])[0])
        largest = np.max(np.abs(self.rate(self.samples[None])))
        return tuple(self.crank_angle(way) for way in self.slow[rates < STILL * largest])

    def breaks(self, start: float, stop: float, pieces: int = 24) -> Array:
        """Ways (B,) from start to stop between which the path bends gently: they crowd about
        places where it is slow.

        pieces : of equal width, at least.
        """
        period = self.curve.period
        around = self.slow + period * np.floor((start - self.slow) / period)
        slow = np.concatenate([around + period * k for k in range(3)], axis=None)
        step = period / len(self.curve.theta) * 8
        crowded = _crowded(slow, step)
        inner = np.concatenate([np.linspace(start, stop, pieces + 1), crowded])
        return np.unique(inner[(inner >= start) & (inner <= stop)])

    def loops(self) -> tuple[Loop, ...]:
        """Every self-crossing of the path within one cycle, in the order of time."""
        if not self.drive:
            return ()
        nodes = self._nodes()
        places = self.place(nodes[None])[0]
        cycle = int(np.searchsorted(nodes, self.curve.period))
        crossed = self._polished(_crossing_pairs(nodes, places, cycle))
        ways = self._distinct(crossed)
        areas = self._areas(ways)
        smallest = SMALLEST_LOOP * float(self.curve.highest[0][0] - self.curve.lowest[0][0])
        measured = [
            self._measured(ways[k : k + AT_ONCE], areas[k : k + AT_ONCE])
            for k in range(0, len(ways), AT_ONCE)
        ]
        return tuple(loop for loop in chain(*measured) if loop.height + loop.width > smallest)

    def _nodes(self) -> Array:
        """Ways over two cycles at which the path is sampled: crowded where it is slow."""
        step = max(self.samples[1], 2 * self.curve.period / MOST_NODES)
        once = np.arange(0.0, self.curve.period, step)
        nodes = np.mod(_crowded(self.slow, step), self.curve.period)
        once = np.unique(np.concatenate([once, nodes]))
        return np.concatenate([once, once + self.curve.period])

    def _polished(self, ways: Array) -> Array:
        """Ways (L, 2) of crossings near ways (C, 2), by Newton's method on the two components of
        the way between both passes.

        At a cusp it creeps towards a single instant: then there is no crossing.
        """
        closed = [np.empty((0, 2))]
        for _ in range(MOST_STEPS):
            if not ways.size:
                break
            places, (item, other) = self.place(ways), self.rate(ways).T
            turn, gap = kernels.cross(item, other), places[:, 1] - places[:, 0]
            crossing = np.abs(turn) > 0
            steps = np.stack([kernels.cross(gap, other), kernels.cross(gap, item)], axis=-1)
            steps = steps[crossing] / turn[crossing, None]
            ways = ways[crossing] + steps
            close = np.max(np.abs(steps), axis=1) < CLOSED
            closed.append(ways[close])
            ways = ways[~close]
        return np.concatenate(closed)

    def _distinct(self, crossed: Array) -> Array:
        """Ways (L, 2) of those crossings (C, 2) that begin in the first cycle, each once."""
        period, once = self.curve.period, list[tuple[float, float]]()
        for first, second in sorted(map(tuple, crossed.tolist())):
            inside = -1e-12 <= first < period - 1e-12 and 1e-7 < second - first < period
            if inside and not _among(once, first, second):
                once.append((first, second))
        return np.array(once).reshape(-1, 2)

    def _measured(self, ways: Array, areas: Array) -> list[Loop]:
        """Loops between ways (L, 2), of areas (L,)."""
        crossing = self.place(ways[:, 0])
        extents = [self._extent(ways[:, 0], ways[:, 1], axis).tolist() for axis in ("imag", "real")]
        return [
            Loop(
                first=self.crank_angle(first),
                second=self.crank_angle(second),
                way=second - first,
                y=float(at.imag),
                height=height,
                width=width,
                area=float(area),
                in_soil=bool(at.imag < self.curve.surface[0]),
            )
            for (first, second), at, area, height, width in zip(
                ways.tolist(), crossing, areas, *extents, strict=True
            )
        ]

    def _areas(self, ways: Array) -> Array:
        """Areas (L,), m2, that the path goes around between ways (L, 2).

        Most of what loops go around is common to many, so that each piece of the path is followed
        once; only the ends of a loop, from and to the next break, are its own.
        """
        breaks = self.breaks(0.0, 2 * self.curve.period, len(self.curve.theta) // 4)
        inside = np.searchsorted(breaks, ways[:, 0]), np.searchsorted(breaks, ways[:, 1]) - 1
        starts, own, along = self._swept(breaks[:-1], breaks[1:])
        first, second = ways.T
        begin = np.minimum(breaks[inside[0]], second)
        end = np.maximum(breaks[inside[1]], begin)
        origins = self.place(first)
        total = np.zeros(len(ways))
        for low, high in ((first, begin), (end, second)):
            corners, areas, chords = self._swept(low, high)
            total += areas + kernels.cross(corners - origins, chords)
        for k, (i, j) in enumerate(zip(*inside, strict=True)):
            total[k] += np.sum(own[i:j] + kernels.cross(starts[i:j] - origins[k], along[i:j]))
        return np.abs(total) / 2

    def _swept(self, low: Array, high: Array) -> tuple[Array, Array, Array]:
        """Of pieces from ways `low` to `high` (N,): where they begin (N,), m, twice the areas (N,)
        that lines from there sweep, m2, and how far they lead (N,), m.
        """
        starts, ends = self.place(low), self.place(high)
        areas = [np.empty(0)]
        for k in range(0, len(low), PIECES):
            part = slice(k, k + PIECES)

            def sweeping(way: Array, origins: Array = starts[part, None]) -> Array:
                return np.asarray(kernels.cross(self.place(way) - origins, self.rate(way)))

            areas.append(integral(sweeping, np.stack([low[part], high[part]], axis=-1)))
        return starts, np.concatenate(areas), ends - starts

    def _extent(self, first: Array, second: Array, axis: str) -> Array:
        """Width or height (L,), m, of the path between ways `first` and `second` (L,)."""

        def part(way: Array, sign: int) -> Any:
            return sign * getattr(self.place(way), axis)

        least, most = (
            lowest_within(partial(part, sign=sign), first, second)[0] for sign in (1, -1)
        )
        return np.asarray(-most - least)


def _among(pairs: list[tuple[float, float]], first: float, second: float) -> bool:
    """Whether one of some rising pairs is this one, but for rounding."""
    close = takewhile(lambda pair: first - pair[0] < 1e-9, reversed(pairs))
    return any(first - a + abs(second - b) < 1e-9 for a, b in close)


def _crowded(middles: Array, step: float) -> Array:
    """Ways about each of some ways, at distances halved again and again."""
    distances = step * 0.5 ** np.arange(NEAREST)
    offsets = np.concatenate([-distances, [0.0], distances])
    nodes: Array = (middles[:, None] + offsets).ravel()
    return nodes


def _crossing_pairs(nodes: Array, places: Array, cycle: int) -> Array:
    """Ways (C, 2) at which the lines between nodes cross, with the first in the first cycle."""
    starts, ends = places[:-1], places[1:]
    pairs: list[tuple[int, int]] = []
    for i in range(cycle):
        last = min(i + cycle, len(starts))
        a, b = starts[i], ends[i]
        c, d = starts[i + 2 : last], ends[i + 2 : last]
        apart = (kernels.cross(b - a, c - a) > 0) != (kernels.cross(b - a, d - a) > 0)
        across = (kernels.cross(d - c, a - c) > 0) != (kernels.cross(d - c, b - c) > 0)
        pairs += [(i, int(k)) for k in i + 2 + np.flatnonzero(apart & across)]
    middles = (nodes[1:] + nodes[:-1]) / 2
    return np.asarray(middles[np.array(pairs, int).reshape(-1, 2)])


OF_MACHINE = ("ratio", "transmission")
"""Groups of figures that are of no arm."""
PANELS, SAMPLES_OF_TURN = 24, 720
"""Panels of the stay in which lengths are summed up, and samples of a turn."""


def tip_figures(
    curve: TipCurve,
    entry: Array,
    leave: Array,
    breaks: Array | None = None,
    wanted: Collection[str] | None = None,
) -> StrokeFigures:
    """Every figure of the path, of the instants and of the stay in the soil.

    entry, leave : (P,) crank angles at which the tip enters and leaves the soil, running on in the
        sense of the drive.
    breaks : (P, B) crank angles from entry to leave between which the path is smooth; None for
        equal panels.
    wanted : groups that are needed, such as ``curve``; None for all.

    What is of the whole machine comes with the first of its arms.
    """
    instants: dict[str, Callable[[], Array]] = {
        "lowest": lambda: curve.lowest[1],
        "highest": lambda: curve.highest[1],
        "entry": lambda: entry,
        "exit": lambda: leave,
        "release": lambda: release(curve),
    }
    if curve.planting.tray is not None:
        instants["pick_up"] = lambda: pick_up(curve, entry)
    groups: dict[str, Callable[[str], StrokeFigures]] = {
        "surface": lambda name: {name: curve.surface},
        "curve": lambda name: size_of_curve(curve),
        "curve.smallest_radius": lambda name: sharpest_bend(curve, "curve", 0.0),
        "ground": lambda name: sharpest_bend(
            curve, name, ground_drive(curve), while_driving(curve)
        ),
        **dict.fromkeys(
            ("max_speed", "min_speed", "max_acceleration", "min_acceleration"),
            lambda name: extreme(curve, name),
        ),
        "ratio": lambda name: ratios(curve),
        "transmission": lambda name: transmission(curve),
        "soil": lambda name: in_soil(curve, entry, leave, breaks),
        "limits": lambda name: limits(curve, entry, leave),
        "clearance": lambda name: clearances(curve, entry),
        **dict.fromkeys(instants, lambda name: instant(curve, name, instants[name]())),
    }
    if curve is not curve.arms[0]:
        groups = {name: group for name, group in groups.items() if name not in OF_MACHINE}
    known = [group(name) for name, group in groups.items() if wanted is None or name in wanted]
    return {name: values for result in known for name, values in result.items()}


def size_of_curve(curve: TipCurve) -> StrokeFigures:
    """Extent and length of the curve relative to the machine."""
    left, right = (
        find(
            lambda theta: curve.at(theta).place.real,
            lambda theta: curve.at(theta).place_1.real,
            curve.theta,
            curve.grid.place.real,
        )[0]
        for find in (smallest, largest)
    )
    bottom, top = curve.lowest[0], curve.highest[0]
    return {
        "curve.height": top - bottom,
        "curve.width": right - left,
        "curve.length": np.mean(np.abs(curve.grid.place_1), axis=1) * curve.period,
        "curve.lift": top - curve.surface,
    }


def sharpest_bend(curve: TipCurve, name: str, drive: Any, share: Any = 1.0) -> StrokeFigures:
    """Smallest radius of curvature and its crank angle: one over the largest curvature.

    drive : way of the machine along x by crank angle, m; 0 for the path relative to the machine.
    share : NaN for a machine that has no such path.
    """

    def squared(theta: Array) -> Any:
        tip = curve.at(theta)
        rate = tip.place_1 + drive
        return np.square(cross(rate, tip.place_2) / np.abs(rate) ** 3)

    def slope(theta: Array) -> Any:
        tip = curve.at(theta)
        rate, bend = tip.place_1 + drive, cross(tip.place_1 + drive, tip.place_2)
        turning = cross(rate, curve.place_3(theta)) * np.abs(rate) ** 2
        return bend * (turning - 3 * bend * dot(rate, tip.place_2))

    with np.errstate(divide="ignore", invalid="ignore"):
        samples = np.nan_to_num(squared(curve.grid.theta), nan=np.inf)
        value, at = largest(squared, slope, curve.theta, samples)
        slow = _slow_bend(curve, drive, slope)
        sharp = squared(slow[:, None])[:, 0]
        radius = 1 / np.sqrt(np.fmax(value, sharp))
    return {
        f"{name}.smallest_radius.value": radius * share,
        f"{name}.smallest_radius.crank_angle": wrapped(curve, np.where(sharp <= value, at, slow))
        * share,
    }


def _slow_bend(curve: TipCurve, drive: Any, slope: CurveFunction) -> Array:
    """Crank angle (P,) of the bend at the slowest place, which may lie between samples."""

    def rate2(theta: Array) -> Any:
        return np.abs(curve.at(theta).place_1 + drive) ** 2

    def rising(theta: Array) -> Any:
        tip = curve.at(theta)
        return dot(tip.place_1 + drive, tip.place_2)

    value, slowest = smallest(rate2, rising, curve.theta, rate2(curve.grid.theta))
    at = slowest[:, None]
    half_width = 0.5 * np.sqrt(value)[:, None] / np.abs(curve.at(at).place_2)
    width = np.fmin(half_width, curve.theta[1])  # near is 0 over 0 where the tip dwells
    return np.asarray(roots(slope, at - width, at + width)[:, 0])


def extreme(curve: TipCurve, name: str) -> StrokeFigures:
    """Largest or smallest velocity or acceleration relative to the machine, with its direction.

    name : ``max_speed``, ``min_speed``, ``max_acceleration`` or ``min_acceleration``.
    """
    find = largest if name.startswith("max") else smallest
    order = 1 if name.endswith("speed") else 2

    def squared(theta: Array) -> Any:
        return np.abs(in_time(curve, theta, order)) ** 2

    def rising(theta: Array) -> Any:
        return dot(in_time(curve, theta, order), in_time_slope(curve, theta, order))

    value, at = find(squared, rising, curve.theta, squared(curve.grid.theta))
    return {
        f"{name}.value": np.sqrt(value),
        f"{name}.crank_angle": wrapped(curve, at),
        f"{name}.direction": direction(in_time(curve, at[:, None], order)[:, 0]),
    }


def ratios(curve: TipCurve) -> StrokeFigures:
    """Extremes of the angular velocity of every link but the drive, over that of the drive."""
    result: StrokeFigures = {}
    machine, family = curve.machines[0], curve.family
    for link in machine.links:
        if link == machine.drive.link:
            continue
        rate, slope = (
            lambda theta, link=link, order=order: family.rates(family.solve(theta), link)[order]
            for order in (0, 1)
        )
        samples = family.rates(curve.grid.state, link)[0]
        for which, find in (("min", smallest), ("max", largest)):
            value, at = find(rate, slope, curve.theta, samples)
            result[f"ratio.{link}.{which}"] = value
            result[f"ratio.{link}.{which}_at"] = wrapped(curve, at)
    return result


def transmission(curve: TipCurve) -> StrokeFigures:
    """Smallest transmission angle of any dyad; an obtuse one counts by what it lacks to 180 deg."""
    family = curve.family
    if not any(group.margin for group in family.first.groups):
        return {}

    def margin(theta: Array) -> Any:
        return family.margins(family.solve(theta))

    samples = family.margins(curve.grid.state)
    value, at = smallest(
        margin, lambda x: margin(x + STEP) - margin(x - STEP), curve.theta, samples
    )
    angle = np.arcsin(np.sqrt(np.clip(value, 0.0, 1.0)))
    return {"transmission.min": angle, "transmission.min_at": wrapped(curve, at)}


def in_soil(curve: TipCurve, entry: Array, leave: Array, breaks: Array | None) -> StrokeFigures:
    """What the tip does between entry and exit.  Ground figures are NaN for a machine at rest."""
    travel = np.abs(leave - entry)
    time = travel / np.abs(curve.speed[:, 0])
    if breaks is None:
        breaks = entry[:, None] + (leave - entry)[:, None] * np.linspace(0, 1, PANELS + 1)
    ends = curve.at(np.stack([entry, leave], axis=1)).place.real
    advance = ends[:, 1] - ends[:, 0] + curve.forward[:, 0] * time
    drives = while_driving(curve)
    sharpest, at = lowest_within(lambda theta: -np.abs(in_time(curve, theta, 2)), entry, leave)
    return {
        "soil.depth": curve.surface - curve.lowest[0],
        "soil.crank_travel": travel,
        "soil.time": time,
        "soil.path_length_machine": _length(curve, breaks, 0.0),
        "soil.path_length_ground": _length(curve, breaks, ground_drive(curve)) * drives,
        "soil.ground_advance": advance * drives,
        "soil.ground_distance": np.abs(advance) * drives,
        "soil.hole_length": _hole_length(curve, entry, leave) * drives,
        "soil.max_acceleration.value": -sharpest,
        "soil.max_acceleration.crank_angle": wrapped(curve, at),
    }


def _length(curve: TipCurve, breaks: Array, drive: Any) -> Array:
    """Length (P,) of the path, m; `drive` is the machine's way by crank angle, m."""
    return np.abs(integral(lambda theta: np.abs(curve.at(theta).place_1 + drive), breaks))


def _hole_length(curve: TipCurve, entry: Array, leave: Array) -> Array:
    """Way over ground between the outermost places at which the finger cuts the surface.

    Instants at which the whole finger is below the surface do not count; a finger that enters or
    leaves with its base first opens no hole of a defined size: NaN.
    """
    base = finger_base(curve)
    if base is None:
        return np.full(curve.count, np.nan)
    level, start = curve.surface[:, None], entry[:, None]

    def cut(theta: Array, side: int) -> Any:
        """Place over ground of the cut, times `side`; infinite where the finger is all below."""
        tip = curve.at(theta)
        back = curve.point_of(tip.state, base)[0]
        with np.errstate(divide="ignore", invalid="ignore"):
            share = np.clip((level - tip.place.imag) / (back.imag - tip.place.imag), 0, 1)
        x = tip.place.real + share * (back.real - tip.place.real)
        x = x + (theta - start) * ground_drive(curve)
        return np.where((back.imag >= level) & np.isfinite(share), side * x, np.inf)

    left = lowest_within(lambda theta: cut(theta, 1), entry, leave)[0]
    right = lowest_within(lambda theta: cut(theta, -1), entry, leave)[0]
    ends = np.stack([entry, leave], axis=1)
    upright = np.all(curve.point_of(curve.at(ends).state, base)[0].imag >= level, axis=1)
    return np.where(upright, -right - left, np.nan)


def limits(curve: TipCurve, entry: Array, leave: Array) -> StrokeFigures:
    """Highest speeds of the drive (rad/s, without acceleration) that keep within the limits.

    The forward speed is the one at which hills stay as far apart as they are.
    """
    result: StrokeFigures = {}
    for name, limit, ends in (
        ("acceleration", curve.planting.acceleration_limit, whole_cycle(curve)),
        ("soil_acceleration", curve.planting.soil_acceleration_limit, (entry, leave)),
    ):
        if limit is not None:
            samples = SAMPLES_OF_TURN * curve.turns
            bend = lowest_within(lambda x: -np.abs(curve.at(x).place_2), *ends, samples=samples)[0]
            speed = np.sqrt(limit / -bend)
            result |= {
                f"limits.{name}.limit": np.full(curve.count, limit),
                f"limits.{name}.highest_speed": speed,
                f"limits.{name}.highest_forward_speed": np.abs(ground_drive(curve)[:, 0]) * speed,
            }
    return result


TipSignals = dict[str, Array]


def shaking(curve: TipCurve) -> StrokeFigures:
    """RMS and largest value of shaking force, shaking moment about the drive's pivot, and torque
    of the drive without loads, springs and soil; none where masses are missing.
    """
    if massless(curve.machines[0]):
        return {}
    parts = _Parts(curve)
    sampled = parts.signals(curve.grid.state)
    figures: StrokeFigures = {}
    for name, values in sampled.items():
        figures[f"{name}.rms"] = np.sqrt(np.mean(values**2, axis=1))
        figures[f"{name}.peak"] = _peak(curve, parts.of(name))
    return figures


def _peak(curve: TipCurve, signal: Callable[[Array], Array]) -> Array:
    samples = len(curve.theta) // 4 + 1
    return -lowest_within(lambda theta: -signal(theta), *whole_cycle(curve), samples=samples)[0]


class _Parts:
    """Inertia of every link about its anchor, as columns."""

    def __init__(self, curve: TipCurve) -> None:
        self.curve = curve
        self.links = {link: self._of(link) for link in curve.machines[0].links}
        self.gravity = column(complex(*machine.gravity) for machine in curve.machines)

    def _of(self, link: str) -> tuple[Array, ...]:
        """Mass, first moment and moment of inertia of a link, (P, 1) each."""
        anchor = self.curve.family.first.anchors[link]
        numbers = (inertia_moved(machine, link, anchor) for machine in self.curve.machines)
        return tuple(map(column, zip(*numbers, strict=True)))

    def of(self, name: str) -> Callable[[Array], Array]:
        """One of the signals."""
        return lambda theta: self.signals(self.curve.family.solve(theta))[name]

    def signals(self, state: State) -> TipSignals:
        """Sizes of force, moment and torque at the crank angles of a state, (P, K)."""
        curve, family = self.curve, self.curve.family
        pivot = state[f"p({family.first.pivot})"]
        speed2, acceleration = curve.speed**2, acceleration_of_drive(curve)
        shape = np.shape(state["theta"])
        force, moment, torque = np.zeros(shape, complex), np.zeros(shape), np.zeros(shape)
        for link, (mass, first, inertia) in self.links.items():
            place, p1, p2 = (state[name] for name in p(family.first.anchors[link]))
            rotation, w, a = (state[name] for name in u(link))
            pull: Any
            pull, turning = kernels.inertia_demand(
                p1, p2, rotation, w, a, speed2, acceleration, mass, first, inertia
            )
            carried, weight_moment = kernels.weight_demand(rotation, mass, first, self.gravity)
            force = force + pull
            moment = moment + turning + kernels.cross(place - pivot, pull)
            torque = torque + kernels.drive_torque(p1, w, pull + carried, turning + weight_moment)
        return {
            "shaking_force": np.abs(force),
            "shaking_moment": np.abs(moment),
            "drive_torque": np.abs(torque),
        }


# -- of all arms together --------------------------------------------------------------------------

Value = TypeVar("Value")

OF_DRIVE = ("speed", "forward_speed", "hill_spacing", "planting_frequency")
"""Figures of the machine that follow from its drive."""
SHARED = ("surface", *OF_DRIVE)
"""Figures that are the same of all arms."""
SHAKING = {name.partition(".")[0] for name in SHAKING_FIGURES}
"""First parts of the names of what inertia does."""


def of_arm(tip: str, figures: Mapping[str, Value]) -> Iterator[tuple[str, Value]]:
    """Figures of a further arm as those of its machine: ``arms.Q.curve.height``."""
    return ((f"arms.{tip}.{name}", value) for name, value in figures.items() if name not in SHARED)


def machine_figures(curve: TipCurve, wanted: Collection[str] | None = None) -> StrokeFigures:
    """Every figure of the first arm, of the further ones, of the hills of all, and of what shakes.

    wanted : names of those that are needed; None for all.
    """
    first, *further = curve.arms
    groups = None if wanted is None else {_group(name) for name in wanted}
    result = tip_figures(first, *soil_crossings(first), wanted=groups)
    if groups is None or "hills" in groups:
        result |= hills(curve)
    if groups is None or not SHAKING.isdisjoint(groups):
        result |= shaking(curve)
    for arm in further:
        begin = f"arms.{arm.arm.tip}."
        own = {name.removeprefix(begin) for name in wanted or () if name.startswith(begin)}
        if wanted is None or own:
            groups = {_group(name) for name in own} or None
            figures = tip_figures(arm, *soil_crossings(arm), wanted=groups)
            result |= of_arm(arm.arm.tip, figures)
    return result


def _group(name: str) -> str:
    """The group of a figure: the first part of its name, such as ``curve``."""
    bend = "curve.smallest_radius"
    return bend if name.startswith(bend) else name.partition(".")[0]


def hills(curve: TipCurve) -> StrokeFigures:
    """Distances over ground from hill to hill of a row, where each arm plants one a turn.

    NaN for a machine at rest.
    """
    if len(curve.arms) < 2 or curve.turns > 1 or curve.planting.units_per_turn > 1:
        return {}
    sense, forward = np.sign(curve.speed[:, 0]), curve.forward[:, 0]
    row = np.abs(forward) * curve.period / np.abs(curve.speed[:, 0])
    places = np.stack([_hill(arm, sense) for arm in curve.arms], axis=1)
    with np.errstate(invalid="ignore"):
        along = np.sort(np.mod(places, row[:, None]), axis=1)
        apart = np.diff(along, axis=1, append=along[:, :1] + row[:, None])
    drives = np.where(row > 0, 1.0, np.nan)
    return {
        "hills.smallest_distance": np.min(apart, axis=1) * drives,
        "hills.largest_distance": np.max(apart, axis=1) * drives,
    }


def _hill(curve: TipCurve, sense: Array) -> Array:
    """Place over ground (P,), m, at which an arm lets a seedling go."""
    theta = release(curve)
    way = np.mod(sense * theta, curve.period)
    place = curve.at(theta[:, None]).place[:, 0].real
    result: Array = place + way * curve.forward[:, 0] / np.abs(curve.speed[:, 0])
    return result
