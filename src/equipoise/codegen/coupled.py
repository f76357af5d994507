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
from equipoise.codegen.trace import Array, Read, Trace, links_of, numbered
from equipoise.dataclass import dataclass
from equipoise.keys import cached_names, with_fields
from equipoise.keys.paths import KeyPath
from equipoise.mechanism.assembly.contacts import Displacement
from equipoise.mechanism.assembly.linkage import Linkage
from equipoise.mechanism.assembly.steps import KernelCall, u
from equipoise.mechanism.formulas import kernels
from equipoise.mechanism.formulas.curves import MOST_POWERS, ROUNDING, PeriodicCurve, PlaneCurve
from equipoise.mechanism.formulas.kernels import piece_value, plane_piece
from equipoise.mechanism.formulas.rolling import MOST_PRODUCTS
from equipoise.mechanism.parts.cams import Cam
from equipoise.mechanism.parts.couplings import Coupling
from equipoise.mechanism.parts.element_kinds import Element
from equipoise.mechanism.parts.machine import FRAME

Turning = Callable[[Array], tuple[Any, Any, Any]]
"""Angle of a link at crank angles (N,), rad, and its two derivatives by them."""
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


def known_by_crank(trace: Trace) -> dict[str, Turning]:
    """Links whose angle is a function of the crank angle alone: driven ones, and by couplings."""
    turnings: dict[str, Turning] = {FRAME: lambda theta: (0.0 * theta, 0.0, 0.0)}
    turnings |= {drive.link: drive.turned for drive in trace.machine.driven}
    for step in trace.linkage.motion:
        if isinstance(step, KernelCall) and step.outputs[0].startswith("phi("):
            driver, carrier, driven = links_of(step)
            if {driver, carrier} <= turnings.keys() and driven not in trace.loose:
                turnings[driven] = partial(_followed, step, turnings[driver], turnings[carrier])
    return turnings


def _followed(step: KernelCall, driver: Turning, carrier: Turning, theta: Array) -> tuple[Any, ...]:
    return step.kernel(*driver(theta), *carrier(theta), *step.parameters)


def trace_coupling(trace: Trace, step: KernelCall) -> None:
    """A coupling that need not be counted on, or one with a law."""
    driver, carrier, link = links_of(step)
    even = step.kernel is kernels.in_ratio and {driver, carrier} <= trace.orders.keys()
    if even and not trace.counted:
        _trace_uniform(trace, step)
        return
    turning = known_by_crank(trace)[link]
    angle, first, second = (
        trace.row(f"{name}({link})", partial(_part, turning, place))
        for place, name in enumerate(("angle", "first", "second"))
    )
    start = _coupling(trace.linkage, link).start
    if trace.counted:
        put_off = trace.slot(
            f"start({link})", lambda linkage: _coupling(linkage, link).start - start
        )
        trace.state[f"phi({link})"] = angle + put_off
    else:
        turn = trace.slot(
            f"start({link})",
            lambda linkage: np.exp(1j * (_coupling(linkage, link).start - start)),
            vector=True,
        )
        trace.state[f"u({link})"] = rotation(angle) * turn
    trace.put(u(link)[1:], (first, second))


def trace_rolled(trace: Trace, step: KernelCall, number: int) -> None:
    """Where what rolls with a varying ratio touches: the step of this number of the ``forces``."""
    name = step.outputs[0].removeprefix("lever(")[:-1]
    link = next(coupling.driven for coupling in trace.machine.couplings if coupling.name == name)
    if link in trace.loose:
        ratio, bend = (trace.state[f"{what}({link})"] for what in ("ratio", "bend"))
    else:
        law, turnings = step.parameters[0], known_by_crank(trace)
        driver, carrier = (turnings[angle.removeprefix("phi(")[:-1]] for angle in step.inputs)
        ratio, bend = (
            trace.row(f"{what}({name})", partial(_of_law, law, place, driver, carrier))
            for place, what in ((1, "ratio"), (2, "bend"))
        )
    centres = trace.slot(f"centres({name})", partial(_centres, number), vector=True)
    lever, slope = step.outputs
    trace.state[lever] = centres * (1 / (1 - ratio))
    trace.state[slope] = kernels.pitch_slope(ratio, bend)


def _centres(number: int, linkage: Linkage) -> Any:
    step = linkage.forces[number]
    assert isinstance(step, KernelCall)
    return step.parameters[1]


def _part(turning: Turning, place: int, theta: Array) -> Array:
    return np.asarray(turning(theta)[place] + 0.0 * theta)


def _of_law(law: Any, place: int, driver: Turning, carrier: Turning, theta: Array) -> Array:
    return np.asarray(law(driver(theta)[0] - carrier(theta)[0])[place])


def _coupling(linkage: Linkage, link: str) -> Coupling:
    return next(coupling for coupling in linkage.machine.couplings if coupling.driven == link)


def _trace_uniform(trace: Trace, step: KernelCall) -> None:
    """What is driven by a driver and a carrier that turn in proportion to the crank does so too.

    Its rotation is a cosine and sine of a multiple of the crank angle, known for all designs.
    """
    driver, carrier, link = links_of(step)
    order = _follows(step, trace.orders[driver], trace.orders[carrier], 0.0)
    trace.orders[link] = order
    start = trace.slot(f"start({link})", lambda linkage: np.exp(1j * _start(linkage, link)), True)
    trace.put(u(link), (trace.turned(order) * start, order, 0.0))


def _follows(step: KernelCall, driver: Any, carrier: Any, offset: Any) -> Any:
    """What the step makes of driver's and carrier's angle (or order, without an offset)."""
    ratio = step.parameters[0]
    angle, *_ = step.kernel(driver, 0.0, 0.0, carrier, 0.0, 0.0, ratio, offset)
    return angle


def _start(linkage: Linkage, link: str) -> Any:
    """Angle of a link at crank angle 0, of links that turn in proportion to the crank."""
    for step in linkage.motion:
        if isinstance(step, KernelCall) and step.kernel is kernels.in_ratio:
            driver, carrier, driven = links_of(step)
            if driven == link:
                offset = step.parameters[1]
                return _follows(step, _start(linkage, driver), _start(linkage, carrier), offset)
    return 0.0


def can_trace_followers(linkage: Linkage) -> bool:
    """Whether the pieces of all laws can be looked up."""
    cams = (step.cam for step in linkage.motion if isinstance(step, Displacement))
    return all(bins(cam.law.curve.knots) <= MOST_BINS for cam in cams)


def trace_displacement(trace: Trace, step: Displacement, number: int) -> None:
    """Displacement of a cam's follower, with its two derivatives by the cam angle.

    The law is linear in its amounts; those that designs change multiply unit curves.

    number : place of the step in the linkage's ``motion``.
    """
    cam = step.cam
    where = next(path for path, item in numbered(trace.machine) if item.driven == cam.driven)
    varied = [p for p in cam.law.amounts if KeyPath((*where, cam.law_key, *p)) in trace.varied]
    curve_at = _evaluation(trace, step, number)
    rest = cam.law.with_amounts(dict.fromkeys(varied, 0.0)).curve
    y, y1, y2 = curve_at(rest, "constant part")
    for path in varied:
        amount = trace.slot(f"{path} of {cam.driven}", partial(_amount, number, path))
        by, by1, by2 = curve_at(cam.law.unit_curve(path), str(path))
        y, y1, y2 = y + amount * by, y1 + amount * by1, y2 + amount * by2
    trace.put(step.outputs, (y, y1, y2))


def _evaluation(
    trace: Trace, step: Displacement, number: int
) -> Callable[[PeriodicCurve, str], Sequence[Any]]:
    """Function that returns a curve, which is given with a name for its rows, and its two
    derivatives at the cam's angle.
    """
    cam, turnings = step.cam, known_by_crank(trace)
    known = {cam.driver, cam.carrier} <= turnings.keys() - trace.shifted
    if known and cam.driven not in trace.late:
        turned = turnings[cam.driver], turnings[cam.carrier]
        return lambda curve, name: [
            trace.row(f"{output}, {name}", partial(_displaced, curve, cam, turned, place))
            for place, output in enumerate(step.outputs)
        ]
    driver, carrier = (trace.state[f"phi({body})"] for body in (cam.driver, cam.carrier))
    origin: Any = float(cam.law.origin)
    if cam.driven in trace.late:
        origin = trace.slot(f"origin of {cam.driven}", partial(_origin, number))
    angle = driver - carrier - origin
    return lambda curve, _: curve_value(trace, curve, angle)


def _displaced(
    curve: PeriodicCurve, cam: Cam, turned: tuple[Turning, Turning], place: int, theta: Array
) -> Array:
    driver, carrier = (turning(theta)[0] for turning in turned)
    return np.asarray(curve.at(driver - carrier - cam.law.origin)[place])


def _cam(number: int, linkage: Linkage) -> Cam:
    step = linkage.motion[number]
    assert isinstance(step, Displacement)
    return step.cam


def _amount(number: int, path: KeyPath, linkage: Linkage) -> Any:
    return _cam(number, linkage).law.amounts[path]


def _origin(number: int, linkage: Linkage) -> Any:
    return _cam(number, linkage).law.origin


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


def trace_swung(trace: Trace, step: KernelCall, number: int) -> None:
    """How a pinned follower turns whose carrier turns in proportion to the crank."""
    y, y1, y2, w_r, a_r, _, w, a = (trace.state.get(name) for name in step.inputs)
    link, carrier = (name[len("phi(") : -1] for name in (step.outputs[0], step.inputs[5]))
    rest = trace.slot(f"rest({link})", partial(_turned, number), vector=True)
    sense = float(step.parameters[1])
    lean, *rates = kernels.swung(y, y1, y2, w_r, a_r, 0.0, w, a, 0.0, sense)
    trace.put(u(link), (trace.state[f"u({carrier})"] * rest * rotation(lean), *rates))


def _turned(number: int, linkage: Linkage) -> Any:
    step = linkage.motion[number]
    assert isinstance(step, KernelCall)
    return np.exp(1j * np.asarray(step.parameters[0]))


def trace_law(trace: Trace, step: KernelCall, number: int) -> None:
    """How something turns whose ratio varies: the step of this number of the ``motion``."""
    driver, carrier, link = links_of(step)
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
    """Law and offset."""
    step = linkage.motion[number]
    assert isinstance(step, KernelCall)
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
        self.trace, self.curve, self.closed = trace, curve, curve.closed

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
    trace: Trace, value: Any, name: str, read: Read, path: tuple[int | str, ...] = ()
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


def _at(read: Read, path: tuple[int | str, ...], linkage: Linkage) -> Any:
    value = read(linkage)
    for key in path:
        value = value[key] if isinstance(key, int) else getattr(value, key)
    return value
