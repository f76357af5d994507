"""Followers of cams in terms: what their laws say, and how pinned ones turn.

Where the crank angle alone tells how far a cam has turned, it tells the displacement too.  Else the
law is evaluated at each design's own angle: its piece is looked up in tables, without a branch.
"""

from __future__ import annotations

from functools import partial
from itertools import pairwise
from math import ceil, pi
from typing import Any

import numpy as np

from equipoise.codegen.coupled import Turning, known_by_crank
from equipoise.codegen.terms import floor, least, pick, rotation, select
from equipoise.codegen.trace import Array, Trace
from equipoise.mechanism.assembly.cam_groups import Displacement
from equipoise.mechanism.assembly.linkage import Linkage
from equipoise.mechanism.assembly.steps import Call, u
from equipoise.mechanism.formulas import cam_kernels
from equipoise.mechanism.formulas.curve_kernels import piece_value
from equipoise.mechanism.formulas.curves import ROUNDING, Curve

FEW = 16
"""Pieces of a curve that are told apart by comparing, which handles several angles at once."""
ALIKE = 1e-14
"""Of the largest of some values: what differs by less than this does so by rounding."""
DIGITS = 13
"""Of phases, rad, so that those that differ by rounding are the same."""
MOST_BINS = 20_000
"""Parts of a curve's length, of which none has more than one of its knots."""
NOWHERE = 1e300
"""A knot that is never reached."""


def can_trace_followers(linkage: Linkage) -> bool:
    """Whether the pieces of all laws can be looked up."""
    return all(bins(cam.law.curve.knots) <= MOST_BINS for cam in linkage.machine.cams)


def trace_displacement(trace: Trace, step: Displacement) -> None:
    """What a law says at the angle that a cam has turned against its carrier."""
    turnings = known_by_crank(trace)
    if {step.driver, step.carrier} <= turnings.keys() - trace.shifted:
        driver, carrier = turnings[step.driver], turnings[step.carrier]
        for place, output in enumerate(step.outputs):
            of = partial(_displaced, step, driver, carrier, place)
            trace.state[output] = trace.row(output, of)
        return
    driver_angle, carrier_angle = (
        trace.state[f"phi({body})"] for body in (step.driver, step.carrier)
    )
    angle = driver_angle - carrier_angle - float(step.law.origin)
    trace.put(step.outputs, curve_value(trace, step.law.curve, angle))


def _displaced(
    step: Displacement, driver: Turning, carrier: Turning, place: int, theta: Array
) -> Array:
    return np.asarray(step.law.value(driver(theta)[0] - carrier(theta)[0])[place])


def curve_value(trace: Trace, curve: Curve, angle: Any) -> tuple[Any, Any, Any]:
    """A curve, and its two derivatives, at an angle that is each design's own."""
    curve, counted = _from_the_start(_rested(curve))
    near, length = ROUNDING * curve.length, curve.length
    rounds = floor((angle + near) * (1 / length))
    since = angle - rounds * length
    pieces = Pieces(trace, curve, since + near)
    way = since if counted else since - pieces.beginning()
    powers = [pieces.value(values) for values in curve.powers.T]
    amplitude, rate, phase = (pieces.value(values) for values in _waves(curve).T)
    wave = rotation(0.0 if isinstance(amplitude, float) and not amplitude else rate * way + phase)
    value, first, second = piece_value(way, *powers, amplitude, rate, wave.real, wave.imag)  # type: ignore[call-arg,no-untyped-call]
    return value + curve.rise * rounds, first, second


def _rested(curve: Curve) -> Curve:
    """A curve with one piece for each rest, whatever law the rest is given by."""
    still = ~np.any(curve.powers[:, 1:], axis=1) & (curve.waves[:, 0] == 0)
    same = np.abs(np.diff(curve.powers[:, 0])) <= ALIKE * np.max(np.abs(curve.powers[:, 0]))
    kept = np.append(True, ~(still[1:] & still[:-1] & same))
    knots = np.append(curve.knots[:-1][kept], curve.knots[-1])
    return Curve(knots, curve.powers[kept], curve.waves[kept])


def _from_the_start(curve: Curve) -> tuple[Curve, bool]:
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
    return Curve(curve.knots, powers, waves), True


def _waves(curve: Curve) -> Array:
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
    found: list[float] = []
    for value in values:
        near = (one for one in found if abs(one - value) <= least)
        found.append(next(near, value))
    return found


class Pieces:
    """Finds the piece of a curve, and its numbers: chosen by comparing where there are few, else
    picked from tables.
    """

    def __init__(self, trace: Trace, curve: Curve, since: Any, few: int = FEW) -> None:
        """since : way from the curve's beginning, rounding ahead.

        few : pieces up to which they are told apart by comparing.
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


def _in_bins(curve: Curve, count: int) -> tuple[Array, Array]:
    """Of each part the piece at its beginning, and the knot within it; one more at the end."""
    inner = curve.knots[1:-1]
    edges = np.arange(count + 1) * (curve.length / count)
    first = np.searchsorted(inner, edges, side="right")
    ahead = np.append(inner, NOWHERE)[first]
    knot = np.where(ahead < edges + curve.length / count, ahead, NOWHERE)
    return first.astype(float), knot


def trace_swung(trace: Trace, step: Call, number: int) -> None:
    """How a pinned follower turns whose carrier turns in proportion to the crank."""
    y, y1, y2, w_r, a_r, _, w, a = (trace.state.get(name) for name in step.inputs)
    link, carrier = (name[len("phi(") : -1] for name in (step.outputs[0], step.inputs[5]))
    rest = trace.slot(f"rest({link})", partial(_turned, number), vector=True)
    sense = float(step.parameters[1])
    lean, *rates = cam_kernels.swung(y, y1, y2, w_r, a_r, 0.0, w, a, 0.0, sense)
    trace.put(u(link), (trace.state[f"u({carrier})"] * rest * rotation(lean), *rates))


def _turned(number: int, found: Linkage) -> Any:
    step = found.motion[number]
    assert isinstance(step, Call)
    return np.exp(1j * np.asarray(step.parameters[0]))
