"""Couplings in terms: angles that follow from those of two links, and curves on which pins run.

Where the angles of driver and carrier are functions of the crank angle alone, so is the driven
link's, up to the angle at which each design starts.

A law gives an angle or a displacement by the angle of the driver, with each design's own numbers;
where the driver's is not a function of the crank angle alone, the law is evaluated at each design's
own angle, and its piece is looked up in tables, without a branch.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import is_dataclass, replace
from functools import partial
from itertools import pairwise
from math import ceil, pi, prod, tau
from typing import Any

import numpy as np

from equipoise.codegen.terms import (
    VectorTerm,
    angle_of,
    floor,
    greatest,
    least,
    pick,
    rotation,
    select,
)
from equipoise.codegen.trace import LinkageReader, Trace
from equipoise.dataclass import dataclass
from equipoise.keys import cached_names, with_fields
from equipoise.keys.paths import KeyPath
from equipoise.mechanism.assembly.contacts import Displacement, RelationCall, RollingCall
from equipoise.mechanism.assembly.linkage import Linkage
from equipoise.mechanism.assembly.steps import u
from equipoise.mechanism.formulas import kernels
from equipoise.mechanism.formulas.curves import MOST_POWERS, ROUNDING, PeriodicCurve, PlaneCurve
from equipoise.mechanism.formulas.kernels import piece_value, plane_piece
from equipoise.mechanism.formulas.rolling import MOST_PRODUCTS
from equipoise.mechanism.parts.couplings import Coupling
from equipoise.mechanism.parts.element_kinds import Element
from equipoise.signals import Array

FEW = 16
"""Pieces of a curve, at most, that are found by comparing, which handles several angles at once."""
ALIKE = 1e-14
"""Of the largest of some values: what differs by less than this does so by rounding."""
DIGITS = 13
"""Of phases, rad, so that those that differ by rounding are the same."""
MOST_BINS = 20_000
"""Parts of a curve's length, of which none has more than one of its knots."""
NOWHERE = 1e300
"""A knot that is never reached."""


def trace_relation(trace: Trace, step: RelationCall, number: int) -> None:
    """How a driven body follows: the step of this number of the ``motion``."""
    coupling, numbers = step.coupling, step.parameters
    if step.law is None:
        inputs = [trace.state[name] for name in step.inputs]
        name, read = f"relation of {coupling.name}", partial(_parameters, number)
        where = trace.paths[coupling.name]
        own = any(path.begin(2) == where and path != where / "start" for path in trace.varied)
        fixed = [] if own else [*numbers[:-1]]
        places = range(len(fixed), len(numbers))
        given = [slotted(trace, numbers[k], name, read, (k,)) for k in places]
        trace.put(step.outputs, step.kernel(*inputs, *fixed, *given))
    elif coupling.driven in trace.loose:
        _trace_law(trace, step, number)
    else:
        angle, *rates = map(trace.base_row, step.outputs)
        start = trace.slot(f"start({coupling.driven})", partial(_start_beyond, number, coupling))
        trace.put(step.outputs, (angle + start, *rates))


def _start_beyond(number: int, base: Coupling, linkage: Linkage) -> Any:
    """By how much a driven body starts beyond the base's, rad."""
    step = linkage.motion[number]
    assert isinstance(step, RelationCall)
    return step.coupling.start - base.start


def trace_rolled(trace: Trace, step: RollingCall, number: int) -> None:
    """Where what rolls with a varying ratio touches: the step of this number of the ``forces``."""
    coupling = step.coupling
    if coupling.driven in trace.loose:
        ratio, bend = (trace.state[f"{what}({coupling.driven})"] for what in ("ratio", "bend"))
    else:
        ratio, bend = (
            trace.row(f"{what}({coupling.name})", partial(_of_law, trace, step, place))
            for place, what in ((1, "ratio"), (2, "bend"))
        )
    centres = trace.slot(f"centres({coupling.name})", partial(_centres, number), vector=True)
    lever, slope = step.outputs
    trace.state[lever] = centres * (1 / (1 - ratio))
    trace.state[slope] = kernels.pitch_slope(ratio, bend)


def _centres(number: int, linkage: Linkage) -> Any:
    step = linkage.forces[number]
    assert isinstance(step, RollingCall)
    return step.parameters[1]


def _of_law(trace: Trace, step: RollingCall, place: int, theta: Array) -> Array:
    return np.asarray(step.parameters[0](trace.base.relative(step.coupling, theta))[place])


def can_trace_followers(linkage: Linkage) -> bool:
    """Whether the pieces of all laws can be looked up."""
    laws = (step.law for step in linkage.motion if isinstance(step, Displacement))
    return all(bins(law.curve.knots) <= MOST_BINS for law in laws)


def trace_displacement(trace: Trace, step: Displacement, number: int) -> None:
    """Displacement of a follower, with its two derivatives by the angle of what it rides on.

    The law is linear in its amounts; those that designs change multiply unit curves.

    number : place of the step in the linkage's ``motion``.
    """
    coupling, law = step.coupling, step.law
    where = (*trace.paths[coupling.name], step.law_key)
    varied = [path for path in law.amounts if KeyPath((*where, *path)) in trace.varied]
    curve_at = _evaluation(trace, step, number)
    y, y1, y2 = curve_at(law.with_amounts(dict.fromkeys(varied, 0.0)).curve, "constant part")
    for path in varied:
        amount = trace.slot(f"{path} of {coupling.driven}", partial(_amount, number, path))
        by, by1, by2 = curve_at(law.unit_curve(path), str(path))
        y, y1, y2 = y + amount * by, y1 + amount * by1, y2 + amount * by2
    trace.put(step.outputs, (y, y1, y2))


def _evaluation(
    trace: Trace, step: Displacement, number: int
) -> Callable[[PeriodicCurve, str], Sequence[Any]]:
    """Function that returns a curve, which is given with a name for its rows, and its two
    derivatives at the angle of the law.
    """
    coupling = step.coupling
    late = coupling.driven in trace.late
    known = {coupling.driver, coupling.carrier} <= trace.by_crank - trace.shifted
    if known and not late:
        return lambda curve, name: [
            trace.row(f"{output}, {name}", partial(_displaced, trace, step, curve, place))
            for place, output in enumerate(step.outputs)
        ]
    driver, carrier = (trace.state[f"phi({body})"] for body in coupling.bodies[::2])
    origin: Any = float(step.law.origin)
    if late:
        origin = trace.slot(f"origin of {coupling.driven}", partial(_origin, number))
    angle = driver - carrier - origin
    return lambda curve, _: curve_value(trace, curve, angle)


def _displaced(
    trace: Trace, step: Displacement, curve: PeriodicCurve, place: int, theta: Array
) -> Array:
    angle = trace.base.relative(step.coupling, theta) - step.law.origin
    return np.asarray(curve.at(angle)[place])


def _law(number: int, linkage: Linkage) -> Any:
    step = linkage.motion[number]
    assert isinstance(step, Displacement)
    return step.law


def _amount(number: int, path: KeyPath, linkage: Linkage) -> Any:
    return _law(number, linkage).amounts[path]


def _origin(number: int, linkage: Linkage) -> Any:
    return _law(number, linkage).origin


def curve_value(trace: Trace, curve: PeriodicCurve, angle: Any) -> tuple[Any, Any, Any]:
    """A curve, and its two derivatives, at an angle that is each design's own."""
    tolerance, length, rise = ROUNDING * curve.length, curve.length, curve.rise
    curve, counted = _from_the_start(_rested(curve))
    rounds = floor((angle + tolerance) * (1 / length))
    since = angle - rounds * length
    pieces = Pieces(trace, curve, since + tolerance)
    way = since if counted else since - pieces.beginning()
    powers = [pieces.value(values) for values in curve.powers.T]
    amplitude, rate, phase = (pieces.value(values) for values in _waves(curve).T)
    wave = rotation(0.0 if isinstance(amplitude, float) and not amplitude else rate * way + phase)
    value, first, second = piece_value(way, *powers, amplitude, rate, wave.real, wave.imag)  # type: ignore[call-arg]
    return value + rise * rounds, first, second


def _rested(curve: PeriodicCurve) -> PeriodicCurve:
    """A curve with one piece for each rest, whatever law the rest is given by."""
    still = ~np.any(curve.powers[:, 1:], axis=1) & (curve.waves[:, 0] == 0)
    same = np.abs(np.diff(curve.powers[:, 0])) <= ALIKE * np.max(np.abs(curve.powers[:, 0]))
    pieces = np.append(True, ~(still[1:] & still[:-1] & same))
    knots = np.append(curve.knots[:-1][pieces], curve.knots[-1])
    return PeriodicCurve(knots, curve.powers[pieces], curve.waves[pieces])


def _from_the_start(curve: PeriodicCurve) -> tuple[PeriodicCurve, bool]:
    """A curve of parabolas and waves with the ways counted from its start, so that there is less to
    choose; of higher powers that would lose digits, and the curve stays as it is.
    """
    c0, c1, c2 = curve.powers.T[:3]
    if len(curve.powers) > FEW or np.any(curve.powers[:, 3:]):
        return curve, False
    begins, powers, waves = curve.knots[:-1], np.zeros_like(curve.powers), curve.waves.copy()
    powers[:, :3] = np.transpose([c0 - (c1 - c2 * begins) * begins, c1 - 2 * c2 * begins, c2])
    phases = waves[:, 2] - waves[:, 1] * begins
    halves = np.floor(phases / pi + ROUNDING)
    waves[:, 0] *= np.where(halves % 2, -1.0, 1.0)
    waves[:, 2] = np.round(phases - halves * pi, DIGITS)
    return PeriodicCurve(curve.knots, powers, waves), True


def _waves(curve: PeriodicCurve) -> Array:
    """Waves of the pieces (K, 3); those of pieces without one are like that before, so that there
    is less to choose.
    """
    waves = curve.waves.copy()
    for k in range(-len(waves) + 1, len(waves)):
        if waves[k, 0] == 0:
            waves[k, 1:] = waves[k - 1, 1:]
    return waves


def _alike(values: list[float]) -> list[float]:
    """Values of which those that differ by rounding are the same."""
    least = ALIKE * max(map(abs, values))
    numbers: list[float] = []
    for value in values:
        close = (item for item in numbers if abs(item - value) <= least)
        numbers.append(next(close, value))
    return numbers


class Pieces:
    """Finds the piece of a curve, and its numbers: chosen by comparing where there are few, else
    picked from tables.
    """

    def __init__(self, trace: Trace, curve: PeriodicCurve, since: Any, few: int = FEW) -> None:
        """since : way from the curve's beginning, rounding ahead.

        few : pieces up to which they are found by comparing.
        """
        self.graph, self.curve, self.since = trace.graph, curve, since
        self.few, self.even = len(curve.powers) <= few, False
        if self.few:
            return
        if np.allclose(np.diff(curve.knots), curve.length / len(curve.powers), rtol=1e-12, atol=0):
            self.even = True
            whole = floor(since * (len(curve.powers) / curve.length))
            self.piece = least(float(len(curve.powers) - 1), whole)
            return
        count = bins(curve.knots)
        part = since * (count / curve.length)
        first, knot = (pick(self.graph.table(values), part) for values in _in_bins(curve, count))
        self.piece = first + select(since, knot, 1.0, 0.0)

    def beginning(self) -> Any:
        """Where the piece begins."""
        if self.even:
            return self.piece * float(self.curve.knots[1])
        return self.value(self.curve.knots[:-1])

    def value(self, values: Array) -> Any:
        """What the piece has of values (K,)."""
        numbers = _alike(values.tolist())
        if len({*numbers}) == 1:
            return numbers[0]
        if not self.few:
            return pick(self.graph.table(numbers), self.piece)
        chosen: Any = numbers[0]
        knots = self.curve.knots[1:-1].tolist()
        for knot, (before, after) in zip(knots, pairwise(numbers), strict=True):
            if before != after:
                chosen = select(self.since, knot, after, chosen)
        return chosen


def bins(knots: Array) -> int:
    """Equal parts of a curve's length that are shorter than its pieces."""
    return ceil(1.01 * float(knots[-1] / np.min(np.diff(knots))))


def _in_bins(curve: PeriodicCurve, count: int) -> tuple[Array, Array]:
    """Of each part the piece at its beginning, and the knot within it; one more at the end."""
    inner = curve.knots[1:-1]
    edges = np.arange(count + 1) * (curve.length / count)
    first = np.searchsorted(inner, edges, side="right")
    ahead = np.append(inner, NOWHERE)[first]
    knot = np.where(ahead < edges + curve.length / count, ahead, NOWHERE)
    return first.astype(float), knot


def _trace_law(trace: Trace, step: RelationCall, number: int) -> None:
    """How a body turns by a law at each design's own angle, or with each design's own numbers."""
    driver, link, carrier = step.coupling.bodies
    state, base = trace.state, step.parameters[0]

    def slot(value: Any, what: str, *path: int | str) -> Any:
        return slotted(trace, value, f"{what} of {link}", partial(_parameters, number), path)

    law = replace(base, **{key: slot(getattr(base, key), key, 0, key) for key in base.varied})
    offset = slot(step.parameters[1], "offset", 1)
    turns = state[f"u({driver})"] * state[f"u({carrier})"].conjugate() * rotation(-law.zero)
    at = TracedAngle(trace, state[f"phi({driver})"] - state[f"phi({carrier})"] - law.zero, turns)
    y, ratio, bend = law.values(at)
    state[f"phi({link})"] = state[f"phi({carrier})"] + y + offset
    state[f"ratio({link})"], state[f"bend({link})"] = ratio, bend
    rates = [state[name] for item in (driver, carrier) for name in u(item)[1:]]
    trace.put(u(link)[1:], kernels.followed(ratio, bend, *rates))
    if (turn := law.turn(at)) is not None:
        state[f"u({link})"] = rotation(offset) * state[f"u({carrier})"] * turn
        trace.rotated.add(link)


def _parameters(number: int, linkage: Linkage) -> tuple[Any, ...]:
    """Numbers of a relation and its offset."""
    step = linkage.motion[number]
    assert isinstance(step, RelationCall)
    return step.parameters


@dataclass(frozen=True)
class TracedAngle:
    """A `LawAngle` of terms.

    rotation : exp(i angle).
    """

    trace: Trace
    angle: Any
    rotation: Any

    def turned(self, lobes: int) -> Any:
        if lobes > MOST_PRODUCTS:
            return rotation(float(lobes) * self.angle)
        return prod([self.rotation] * (lobes - 1), start=self.rotation)

    def direction(self, vector: Any) -> Any:
        (along,) = kernels.unit(vector)
        return angle_of(along)

    def curve(self, curve: PeriodicCurve, x: Any, factor: float) -> tuple[Any, Any, Any]:
        larger = PeriodicCurve(curve.knots, factor * curve.powers, curve.waves)
        return curve_value(self.trace, larger, x)


FEW_PIECES = 2
"""Pieces, at most, that are found by comparing: of a dozen numbers each, more compile slowly."""


class TracedCurve:
    """A `PlaneCurve`, which no design changes, at parameters that are terms."""

    def __init__(self, trace: Trace, curve: PlaneCurve) -> None:
        self.trace, self.curve = trace, curve
        self.closed, self.length = curve.closed, curve.length

    def at(self, s: Any) -> tuple[Any, ...]:
        """Place and its first three derivatives by the parameter."""
        way, pieces = self._place(s, self.curve.knots)
        powers = [
            VectorTerm(pieces.value(item.real), pieces.value(item.imag))
            for item in self.curve.powers.T
        ]
        return tuple(plane_piece(way, *powers))

    def distance(self, s: Any) -> Any:
        """Arc length from the beginning, m."""
        knots, powers = self.curve.arcs
        way, pieces = self._place(s, knots)
        return plane_piece(way, *map(pieces.value, powers.T))[0]

    def turned(self, rotation: Any) -> Any:
        """The parameter of a closed curve, of which exp(i s) is known: by halves of a turn, as the
        angles that loops compute are.
        """
        ahead = select(rotation.real, 0.0, 1.0, -1.0)
        return angle_of(rotation * ahead) + select(rotation.real, 0.0, 0.0, pi)

    def _place(self, s: Any, knots: Array) -> tuple[Any, Pieces]:
        """The way into the piece between knots, and what finds the numbers of this."""
        if self.closed:
            s = s - tau * floor(s * (1 / tau))
        count = len(knots) - 1
        curve = PeriodicCurve(knots, np.zeros((count, MOST_POWERS)), np.zeros((count, 3)))
        pieces = Pieces(self.trace, curve, greatest(0.0, s), FEW_PIECES)
        return s - pieces.beginning(), pieces


def can_look_up(curve: PlaneCurve) -> bool:
    """Whether the piece of a curve can be looked up."""
    return bins(curve.arcs[0]) <= MOST_BINS


def slotted(
    trace: Trace, value: Any, name: str, read: LinkageReader, path: tuple[int | str, ...] = ()
) -> Any:
    """Copy of a value with slots for its real and complex numbers.

    read : finds in the linkage of a design what the value is reached from by a path of attributes
        and places.
    """

    def part(key: int | str, item: Any) -> Any:
        return slotted(trace, item, name, read, (*path, key))

    if isinstance(value, PlaneCurve):
        return TracedCurve(trace, value)
    if isinstance(value, tuple):
        return tuple(part(k, item) for k, item in enumerate(value))
    if is_dataclass(value) and not isinstance(value, type):
        left = {*(value.still if isinstance(value, Element) else ()), *cached_names(type(value))}
        given = {key: item for key, item in vars(value).items() if key not in left}
        return with_fields(value, **{key: part(key, item) for key, item in given.items()})
    if isinstance(value, float | complex):
        return trace.slot(f"{name} {path}", partial(_at, read, path), isinstance(value, complex))
    return value


def _at(read: LinkageReader, path: tuple[int | str, ...], linkage: Linkage) -> Any:
    value = read(linkage)
    for key in path:
        value = value[key] if isinstance(key, int) else getattr(value, key)
    return value
