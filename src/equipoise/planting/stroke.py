"""Instants of a stroke: visits to the soil, release, pick-up, clearance, and arms that are alike.

Gears are given by their angles at crank angle 0, at which the arms are in different places.  Where
the shape of gears changes these angles have to follow, or the arms would no longer be alike.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import partial
from itertools import combinations
from math import degrees
from typing import Any, ClassVar

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.errors import ModelError
from equipoise.i18n import Note
from equipoise.mechanism.assembly.family import Family, column
from equipoise.mechanism.assembly.linkage import assemble
from equipoise.mechanism.formulas import kernels
from equipoise.mechanism.kinematics.tip import (
    CurveFunction,
    TipCurve,
    crossings,
    lowest_within,
    planting_of,
    roots,
    tip_link,
)
from equipoise.mechanism.parts.machine import Machine
from equipoise.results.declaring import Declarations, ResultOutput
from equipoise.signals import EQUAL, Array, highest_at, within_period

ALIKE = 1e-5
"""Gears of arms that are this far, rad, from doing the same do it to the digits of a file."""
CLOSE, LATER = 1e-3, (0.7, 1.9, 3.1, 4.3, 5.5)
"""Gears that come closer to each other than this, rad, at these crank angles go the same way."""


@dataclass(frozen=True)
class Twin:
    """A gear of a further arm, and that of the first arm whose part it takes.

    gear, mate : places in the list, of its pair and of the first arm's.
    ahead : angle of the further arm on the carrier, from the first one, rad.
    offset : of the angle of the gear from that of the mate this much later, rad.
    """

    gear: int
    mate: int
    ahead: float
    offset: float


def twins_of(machine: Machine) -> tuple[Twin, ...]:
    """Gears of further arms on the drive that are like those of the first one."""
    planting = planting_of(machine)
    if not planting.arms or not machine.gears:
        return ()
    links = [tip_link(machine, arm.tip) for arm in planting.every_arm]
    first, *further = ([*_chain(machine, link)] for link in links)
    values = [pair for chain in further for pair in _paired(machine, first, chain)]
    starts = np.array([machine.gears[gear].start for gear, _, _ in values])
    offsets = starts - _angles(machine, [(mate, ahead) for _, mate, ahead in values])
    return tuple(Twin(*pair, offset) for pair, offset in zip(values, offsets.tolist(), strict=True))


def kept_alike(machine: Machine, twins: Sequence[Twin]) -> Machine:
    """The machine with gears of further arms at the angles that belong to those of the first."""
    if not twins:
        return machine
    angles = _angles(machine, [(twin.mate, twin.ahead) for twin in twins])
    gears = list(machine.gears)
    for twin, angle in zip(twins, angles.tolist(), strict=True):
        start = float(np.angle(np.exp(1j * (angle + twin.offset))))
        gears[twin.gear] = replace(gears[twin.gear], start=start)
    return replace(machine, gears=tuple(gears))


def nearly_alike(machine: Machine) -> Iterator[Note]:
    """Gears of further arms that would do what those of the first do at another start."""
    twins = twins_of(machine)
    met = kept_alike(machine, [replace(twin, offset=0.0) for twin in twins])
    if not all(_goes_with(met, twin) for twin in twins):
        return
    for twin in twins:
        off = float(np.angle(np.exp(1j * twin.offset)))
        if abs(off) > ALIKE:
            gear, mate = machine.gears[twin.gear], machine.gears[twin.mate]
            yield Note(
                "{link} does not do what {mate} does: for that gears[{number}] would start at "
                "{start:.7g} deg",
                link=gear.driven,
                mate=mate.driven,
                number=twin.gear + 1,
                start=degrees(gear.start - off),
            )


def _goes_with(machine: Machine, twin: Twin) -> bool:
    """Whether a gear does what its mate does at some more crank angles than that of the start."""
    own = _angles(machine, [(twin.gear, item) for item in LATER])
    mates = _angles(machine, [(twin.mate, item + twin.ahead) for item in LATER])
    return bool(np.max(np.abs(np.exp(1j * own) - np.exp(1j * mates))) < CLOSE)


def _chain(machine: Machine, link: str) -> Iterator[int]:
    """Gears from that of an arm back to one that stands still."""
    for _ in machine.gears:
        number = next((k for k, gear in enumerate(machine.gears) if gear.driven == link), None)
        if number is None:
            return
        yield number
        link = machine.gears[number].driver


def _paired(
    machine: Machine, first: Sequence[int], other: Sequence[int]
) -> Iterator[tuple[int, int, float]]:
    """Gear of another arm and of the first, and the angle between both on the carrier; none of
    arms that are not alike.
    """
    carrier = machine.links[machine.drive.link].points
    if len(first) != len(other) or machine.pushers:
        return
    pivot = complex(*carrier[assemble(machine).pivot])
    for mate, number in zip(first, other, strict=True):
        gears = [machine.gears[mate], machine.gears[number]]
        if any(gear.carrier != machine.drive.link for gear in gears):
            return
        points = [machine.links[gear.driven].points for gear in gears]
        pins = [next(place for name, place in carrier.items() if name in own) for own in points]
        arms = [complex(*pin) - pivot for pin in pins]
        yield number, mate, float(np.angle(arms[1] / arms[0]))


def _angles(machine: Machine, places: Sequence[tuple[int, float]]) -> Array:
    """Angles (n,), rad, of driven gears at crank angles."""
    theta = np.array([[crank_angle for _, crank_angle in places]])
    state = Family([assemble(machine)]).solve(theta)
    driven = [machine.gears[gear].driven for gear, _ in places]
    turned = [state[f"u({link})"][0, k] for k, link in enumerate(driven)]
    angles: Array = np.angle(np.array(turned, complex))
    return angles


StrokeFigures = dict[str, Array]
"""Figures by dotted name; (P,), one value for each machine."""


def in_time(curve: TipCurve, theta: Array, order: int) -> Any:
    """Velocity (order 1) or acceleration (2) of the tip relative to the machine, complex."""
    tip = curve.at(theta)
    if order == 1:
        return tip.place_1 * curve.speed
    return tip.place_2 * curve.speed**2 + tip.place_1 * acceleration_of_drive(curve)


def in_time_slope(curve: TipCurve, theta: Array, order: int) -> Any:
    """Derivative of `in_time` by crank angle."""
    bend = curve.at(theta).place_2
    if order == 1:
        return bend * curve.speed
    return curve.place_3(theta) * curve.speed**2 + bend * acceleration_of_drive(curve)


def acceleration_of_drive(curve: TipCurve) -> Array:
    """Acceleration of the crank, rad/s2, (P, 1)."""
    return column(machine.drive.acceleration for machine in curve.machines)


def ground_drive(curve: TipCurve) -> Array:
    """Way of the machine along x by crank angle, m, (P, 1)."""
    return curve.forward / curve.speed


def while_driving(curve: TipCurve) -> Array:
    """1 for a machine that drives, NaN for one at rest, which has no figures over ground; (P,)."""
    return np.where(curve.forward[:, 0] != 0, 1.0, np.nan)


def direction(vector: Array) -> Array:
    """Direction of vectors from x, rad, above -pi; of one along x, no rounding turns it round."""
    level = np.abs(vector.imag) <= 1e-12 * np.abs(vector.real)
    return np.angle(np.where(level, vector.real + 0j, vector))


def wrapped(curve: TipCurve, theta: Array) -> Array:
    """Crank angles within one cycle, from 0."""
    return within_period(theta, curve.period)


def whole_cycle(curve: TipCurve) -> tuple[Array, Array]:
    """Crank angles (P,) of begin and end of the cycle."""
    return np.zeros(curve.count), np.full(curve.count, curve.period)


TOUCH = 1e-12
"""Share of the path's height within which the tip touches the surface and does not pass it."""


def both_sides(curve: TipCurve) -> Array:
    """Whether the tip both reaches and leaves the soil, (P,)."""
    lowest, highest = curve.lowest[0], curve.highest[0]
    touch = TOUCH * (highest - lowest)
    both: Array = (curve.surface > lowest + touch) & (curve.surface < highest - touch)
    return both


@dataclass(frozen=True)
class Visit:
    """A stay of the tip in the soil.

    entry, exit : crank angles, rad, running on in the sense of the drive from within one cycle.
    deepest : crank angle of the lowest point in between, rad.  depth : of that, m.
    """

    entry: float
    exit: float
    deepest: float
    depth: float

    declared: ClassVar[Declarations] = {
        "entry": ResultOutput("crank angle at which the tip goes into the soil", "angle"),
        "exit": ResultOutput("crank angle at which it comes out", "angle"),
        "deepest": ResultOutput("crank angle of the lowest point in between", "angle"),
        "depth": ResultOutput("depth of that point", "length"),
    }


def visits(curve: TipCurve) -> tuple[Visit, ...]:
    """Every stay in the soil in one cycle, the deepest first.

    Raises
    ------
    ModelError : the tip never reaches the soil, or never leaves it.
    """
    level = float(curve.surface[0])
    _check_reach(curve, level)
    sense = float(np.sign(curve.speed[0, 0]))
    nodes = curve.level_nodes()
    angles = crossings(lambda theta: curve.height(theta) - level, nodes)
    falls = curve.rise(angles[None])[0] * sense < 0
    entries, exits = (
        np.sort(np.mod(sense * angles[side], curve.period)) for side in (falls, ~falls)
    )
    result = []
    for entry in entries:
        leave = _next(exits, entry, curve.period)
        theta, depth = _deepest(curve, nodes, sense * entry, sense * leave, level)
        result.append(Visit(sense * entry, sense * leave, theta, depth))
    deepest = max((visit.depth for visit in result), default=0.0)
    return tuple(sorted(result, key=lambda visit: -min(visit.depth, deepest * (1 - EQUAL))))


def _next(ways: Array, way: float, period: float) -> float:
    """The first of some ways after another, in this cycle or the next."""
    return float(np.min(np.where(ways > way, ways, ways + period)))


def _deepest(
    curve: TipCurve, nodes: Array, entry: float, leave: float, level: float
) -> tuple[float, float]:
    """Crank angle of the lowest point between entry and exit, and its depth."""
    low, high = min(entry, leave), max(entry, leave)
    inside = nodes + curve.period * np.ceil((low - nodes) / curve.period)
    inside = inside[inside < high]
    heights = curve.height(inside[None])[0]
    k = highest_at(-heights)
    return float(wrapped(curve, inside[k])), float(level - heights[k])


def _check_reach(curve: TipCurve, level: float) -> None:
    lowest, highest = float(curve.lowest[0][0]), float(curve.highest[0][0])
    touch = TOUCH * (highest - lowest)
    tip, given = curve.arm.tip, curve.planting.depth
    if level <= lowest + touch and given is not None:
        note = Note(
            "got {place}; the tip {tip} never reaches the soil, its lowest point is {higher} "
            "above that of the deepest; {right}",
            place=_mm(given),
            tip=tip,
            higher=_mm(lowest - level + given),
            right=next(nearly_alike(curve.machines[0]), Note("give more than that")),
        )
        raise ModelError("planting.depth", note)
    if level <= lowest + touch:
        raise ModelError(
            "planting.surface",
            Note(
                "got {place}; the tip {tip} never reaches the soil, its lowest point is at "
                "{lowest}; give a surface above that",
                place=_mm(level),
                tip=tip,
                lowest=_mm(lowest),
            ),
        )
    if level >= highest - touch:
        key, value = ("surface", level) if given is None else ("depth", given)
        right = (
            Note("it is at {place} at most; give a surface below that", place=_mm(highest))
            if given is None
            else Note(
                "its path is {height} high; give a depth below that", height=_mm(highest - lowest)
            )
        )
        raise ModelError(
            f"planting.{key}",
            Note(
                "got {place}; the tip {tip} never leaves the soil, {right}",
                place=_mm(value),
                tip=tip,
                right=right,
            ),
        )


def _mm(metres: float) -> str:
    return f"{1e3 * metres:.4g} mm"


def soil_crossings(curve: TipCurve) -> tuple[Array, Array]:
    """Crank angles (P,) at which the tip enters the soil before its lowest point, and leaves after.

    They run on in the sense of the drive; NaN where it does not reach the surface or never leaves.
    """
    sense = np.sign(curve.speed)
    count = len(curve.theta)
    ahead = np.linspace(0.0, curve.period, count + 1)
    lowest = curve.lowest[1][:, None]
    nodes = lowest + sense * ahead
    level = curve.surface[:, None]
    above = curve.height(nodes) >= level
    k_leave = np.argmax(above, axis=1)[:, None]
    k_entry = count - np.argmax(above[:, ::-1], axis=1)[:, None]
    value = np.any(above, axis=1) & ~above[:, 0]
    k_leave, k_entry = np.clip(k_leave, 1, count), np.clip(k_entry, 0, count - 1)

    def over(theta: Array) -> Any:
        return curve.height(theta) - level

    def between(k: Array) -> Array:
        low, high = (np.take_along_axis(nodes, k + step, axis=1) for step in (0, 1))
        return np.where(value, roots(over, low, high)[:, 0], np.nan)

    return between(k_entry) - sense[:, 0] * curve.period, between(k_leave - 1)


def release(curve: TipCurve) -> Array:
    """Crank angle (P,) at which the seedling is let go."""
    given = curve.arm.release
    return curve.lowest[1] if given is None else np.full(curve.count, given)


def instant(curve: TipCurve, instant: str, theta: Array) -> StrokeFigures:
    """Place, velocity, acceleration and attitude at crank angles (P,)."""
    tip = curve.at(theta[:, None])
    velocity = in_time(curve, theta[:, None], 1)[:, 0]
    result = {
        "crank_angle": wrapped(curve, theta),
        "x": tip.place[:, 0].real,
        "y": tip.place[:, 0].imag,
    }
    for name, vector in (
        ("velocity", velocity),
        ("acceleration", in_time(curve, theta[:, None], 2)[:, 0]),
        ("ground_velocity", velocity + curve.forward[:, 0]),
    ):
        result |= {
            f"{name}.x": vector.real,
            f"{name}.y": vector.imag,
            f"{name}.size": np.abs(vector),
            f"{name}.direction": direction(vector),
        }
    base = finger_base(curve)
    if base is not None:
        finger = tip.place - curve.point_of(tip.state, base)[0]
        result["attitude"] = direction(finger[:, 0])
    return {f"{instant}.{key}": value for key, value in result.items()}


def finger_base(curve: TipCurve) -> str | None:
    """The point from which the finger points to the tip, if the tip's link has one."""
    if curve.arm.finger_from is not None:
        return curve.arm.finger_from
    points = curve.machines[0].links[curve.link].points
    return next((point for point in points if point != curve.arm.tip), None)


class Edge:
    """The tip beside the tray's edge, of machines that have a tray."""

    def __init__(self, curve: TipCurve) -> None:
        assert curve.planting.tray is not None
        self.curve = curve
        self.start, stop = (complex(*point) for point in curve.planting.tray)
        self.along = stop - self.start

    def side(self, theta: Array) -> Any:
        """A signal with the sign of the side on which the tip is, (P, K)."""
        return kernels.cross(self.along, self.curve.at(theta).place - self.start)

    def slope(self, theta: Array) -> Any:
        """Derivative of `side` by the crank angle, (P, K)."""
        return kernels.cross(self.along, self.curve.at(theta).place_1)

    def reached(self, theta: Array) -> Array:
        """Whether the tip is between both ends, not only on the line through them, (P, K)."""
        share = kernels.dot(self.along, self.curve.at(theta).place - self.start)
        inside: Array = np.abs(share / abs(self.along) ** 2 - 0.5) <= 0.5
        return inside


def distance(a: Array, b: Array, c: complex, d: complex) -> Array:
    """Distance between lines from a to b (..., K) and a line from c to d, m."""
    gaps = [to_line(a, c, d), to_line(b, c, d), to_line(c, a, b), to_line(d, a, b)]
    apart = kernels.cross(b - a, c - a) * kernels.cross(b - a, d - a) < 0
    across = kernels.cross(d - c, a - c) * kernels.cross(d - c, b - c) < 0
    return np.where(apart & across, 0.0, np.min(np.broadcast_arrays(*gaps), axis=0))


def to_line(point: Any, start: Any, stop: Any) -> Array:
    """Distance of points from a line between two others, m."""
    along = stop - start
    length2 = np.maximum(np.abs(along) ** 2, 1e-300)
    share = np.clip(kernels.dot(along, point - start) / length2, 0.0, 1.0)
    return np.asarray(np.abs(point - start - share * along))


def pick_up(curve: TipCurve, entry: Array) -> Array:
    """Crank angle (P,) at which the tip last passes the tray's edge before it enters the soil.

    NaN where it never does.
    """
    edge = Edge(curve)
    back = np.linspace(0.0, curve.period, len(curve.theta) + 1)
    nodes = entry[:, None] - np.sign(curve.speed) * back
    sides = np.signbit(edge.side(nodes))
    passed = sides[:, 1:] != sides[:, :-1]
    most = max(1, int(np.max(np.sum(passed, axis=1))))
    first = np.argsort(~passed, axis=1, kind="stable")[:, :most]
    low, high = (np.take_along_axis(nodes, first + step, axis=1) for step in (0, 1))
    crossing = roots(edge.side, low, high)
    meant = np.take_along_axis(passed, first, axis=1) & edge.reached(crossing)
    last = np.take_along_axis(crossing, np.argmax(meant, axis=1)[:, None], axis=1)[:, 0]
    return np.where(np.any(meant, axis=1), last, np.nan)


def tray_crossings(curve: TipCurve) -> tuple[float, ...]:
    """Crank angles within one cycle at which the tip of one machine passes the edge, rising."""
    if curve.planting.tray is None:
        return ()
    edge = Edge(curve)
    ends = np.append(curve.theta, curve.period)
    nodes = np.unique(np.concatenate([ends, crossings(edge.slope, ends)]))
    angles = crossings(edge.side, nodes)
    if not angles.size:
        return ()
    return tuple(float(angle) for angle in angles[edge.reached(angles[None])[0]])


def clearances(curve: TipCurve, entry: Array) -> StrokeFigures:
    """Smallest distance of each link from the soil and from the tray's edge.

    A link is the lines between its points, the tip left out, which is meant to go into the soil
    and to pass the edge.  The tip's own distance from the edge is 0 where it passes it.

    entry : (P,) crank angles at which the tip enters the soil.
    """
    result: StrokeFigures = {}
    tip, tray = curve.arm.tip, curve.planting.tray
    outlines = _outlines(curve)

    def places(theta: Array, link: str) -> Array:
        state = curve.family.solve(theta)
        return np.array([curve.point_of(state, point, link)[0] for point in outlines[link]])

    def height(theta: Array, link: str) -> Any:
        return np.min(places(theta, link).imag, axis=0) - curve.surface[:, None]

    for link in outlines:
        result |= _smallest(curve, f"clearance.soil.{link}", partial(height, link=link))
    if tray is None:
        return result
    start, stop = (complex(*point) for point in tray)

    def apart(theta: Array, link: str) -> Any:
        result = places(theta, link)
        lines = combinations(result, 2) if len(result) > 1 else [(result[0], result[0])]
        return np.min([distance(a, b, start, stop) for a, b in lines], axis=0)

    for link in outlines:
        result |= _smallest(curve, f"clearance.tray.{link}", partial(apart, link=link))
    name, passes = f"clearance.tray.tip {tip}", pick_up(curve, entry)
    figures = _smallest(curve, name, lambda theta: to_line(curve.at(theta).place, start, stop))
    met = np.isfinite(passes)
    figures[f"{name}.value"][met] = 0.0
    figures[f"{name}.crank_angle"][met] = wrapped(curve, passes)[met]
    return result | figures


def _outlines(curve: TipCurve) -> dict[str, list[str]]:
    """Points of each link that has some beside tips; none where the arm is not the first."""
    if curve is not curve.arms[0]:
        return {}
    tips = {arm.arm.tip for arm in curve.arms}
    links = curve.machines[0].links.items()
    outlines = {name: [point for point in link.points if point not in tips] for name, link in links}
    return {name: points for name, points in outlines.items() if points}


def _smallest(curve: TipCurve, name: str, signal: CurveFunction) -> StrokeFigures:
    value, at = lowest_within(signal, *whole_cycle(curve), samples=len(curve.theta) + 1)
    return {f"{name}.value": value, f"{name}.crank_angle": wrapped(curve, at)}
