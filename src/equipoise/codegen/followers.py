"""Lines for followers of cams: what their laws say, and how pinned ones turn.

Where the crank angle alone tells how far a cam has turned, it tells the displacement too.  Else the
law is evaluated at each design's own angle: its piece is looked up in tables, without a branch.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from itertools import pairwise
from math import ceil, pi
from typing import Any

import numpy as np

from equipoise.codegen.coupled import Turning, told_by_crank
from equipoise.codegen.writer import Writer
from equipoise.mechanism.assembly.cam_groups import Displacement
from equipoise.mechanism.assembly.linkage import Linkage
from equipoise.mechanism.assembly.steps import Array, Call, u
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


def can_write_followers(linkage: Linkage) -> bool:
    """Whether the pieces of all laws can be looked up."""
    return all(_bins(cam.law.curve) <= MOST_BINS for cam in linkage.machine.cams)


def write_displacement(writer: Writer, step: Displacement) -> None:
    """Write what a law says at the angle that a cam has turned against its carrier."""
    told = told_by_crank(writer)
    if {step.driver, step.carrier} <= told.keys() - writer.shifted:
        driver, carrier = told[step.driver], told[step.carrier]
        for place, output in enumerate(step.outputs):
            of = partial(_displaced, step, driver, carrier, place)
            row = writer.sheet.row(f"row {output}", of)
            writer.sheet.put(output, row)
        return
    angles = (writer.name(f"phi({body})") for body in (step.driver, step.carrier))
    angle = f"{' - '.join(angles)} - {step.law.origin!r}"
    write_curve(writer, step.law.curve, angle, step.outputs)


def _displaced(
    step: Displacement, driver: Turning, carrier: Turning, place: int, theta: Array
) -> Array:
    return np.asarray(step.law.value(driver(theta)[0] - carrier(theta)[0])[place])


def write_curve(writer: Writer, curve: Curve, angle: str, outputs: Sequence[str]) -> None:
    """Write a curve, and its two derivatives, at an angle that is each design's own."""
    curve, counted = _from_the_start(_rested(curve))
    sheet, near, length = writer.sheet, ROUNDING * curve.length, curve.length
    name = outputs[0]

    def put(what: str, expression: str) -> str:
        return sheet.put(f"{what} {name}", expression)

    x = put("angle", angle)
    rounds = put("rounds", f"floored(({x} + {near!r}) * {1 / length!r})")
    since = put("since", f"{x} - {rounds} * {length!r}")
    pieces = _Pieces(writer, curve, name, put("ahead", f"{since} + {near!r}"))
    way = since if counted else put("way", f"{since} - {pieces.beginning()}")
    powers = [pieces.value(f"c{k}", values) for k, values in enumerate(curve.powers.T)]
    amplitude, rate, phase = (
        pieces.value(what, values)
        for what, values in zip(("amplitude", "rate", "phase"), _waves(curve).T, strict=True)
    )
    cosine, sine = "1.0", "0.0"
    if amplitude != "0.0":
        turned = put("wave", f"rotation({rate} * {way} + {phase})")
        cosine, sine = f"{turned}.real", f"{turned}.imag"
    found = (f"within {name}", *outputs[1:]) if curve.rise else outputs
    sheet.call("piece_value", [way, *powers, amplitude, rate, cosine, sine], found)
    if curve.rise:
        sheet.put(name, f"{sheet.name(found[0])} + {curve.rise!r} * {rounds}")


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


class _Pieces:
    """What differs from piece to piece of a curve: chosen by comparing where there are few, else
    picked from tables.
    """

    def __init__(self, writer: Writer, curve: Curve, name: str, since: str) -> None:
        """since : identifier of the way from the curve's beginning, rounding ahead."""
        self.sheet, self.name, self.curve = writer.sheet, name, curve
        self.few, self.even = len(curve.powers) <= FEW, False
        if self.few:
            self.behind = [
                self.put(f"behind {k}", f"{since} >= {knot!r}")
                for k, knot in enumerate(curve.knots[1:-1].tolist(), 1)
            ]
            return
        if np.allclose(np.diff(curve.knots), curve.length / len(curve.powers), rtol=1e-12, atol=0):
            self.even = True
            last = float(len(curve.powers) - 1)
            whole = f"floored({since} * {len(curve.powers) / curve.length!r})"
            self.piece = self.put("piece", f"smallest({last!r}, {whole})")
            return
        count = _bins(curve)
        part = self.put("part", f"{since} * {count / curve.length!r}")
        first, knot = (self.picked(*one, part) for one in _in_bins(curve, count).items())
        self.piece = self.put("piece", f"{first} + ({since} >= {knot}) * 1.0")

    def put(self, what: str, expression: str) -> str:
        return self.sheet.put(f"{what} {self.name}", expression)

    def picked(self, what: str, values: Array, place: str) -> str:
        table = self.sheet.constant(f"each {what} {self.name}", values)
        return self.put(what, f"picked({table}, {place})")

    def beginning(self) -> str:
        """Where the piece begins."""
        if self.even:
            return self.put("beginning", f"{self.piece} * {float(self.curve.knots[1])!r}")
        return self.value("beginning", self.curve.knots[:-1])

    def value(self, what: str, values: Array) -> str:
        """What the piece has of values (K,)."""
        numbers = [repr(one) for one in _alike(values.tolist())]
        if len({*numbers}) == 1:
            return numbers[0]
        if not self.few:
            return self.picked(what, values, self.piece)
        chosen = numbers[0]
        for k, (before, after) in enumerate(pairwise(numbers)):
            if before != after:
                chosen = f"chosen({self.behind[k]}, {after}, {chosen})"
        return self.put(what, chosen)


def _bins(curve: Curve) -> int:
    """Equal parts of a curve's length that are shorter than its pieces."""
    return ceil(1.01 * curve.length / float(np.min(np.diff(curve.knots))))


def _in_bins(curve: Curve, count: int) -> dict[str, Array]:
    """Of each part the piece at its beginning, and the knot within it; one more at the end."""
    inner = curve.knots[1:-1]
    edges = np.arange(count + 1) * (curve.length / count)
    first = np.searchsorted(inner, edges, side="right")
    ahead = np.append(inner, NOWHERE)[first]
    knot = np.where(ahead < edges + curve.length / count, ahead, NOWHERE)
    return {"first": first.astype(float), "knot": knot}


def write_swung(writer: Writer, step: Call, number: int) -> None:
    """Write how a pinned follower turns whose carrier turns in proportion to the crank."""
    sheet, (y, y1, y2, w_r, a_r, _, w, a) = writer.sheet, map(writer.name, step.inputs)
    link, carrier = (name[len("phi(") : -1] for name in (step.outputs[0], step.inputs[5]))
    sense = step.parameters[1]
    turned = partial(_turned, number)
    rest = sheet.slot(f"rest({link})", turned, vector=True)
    arguments = [y, y1, y2, w_r, a_r, "0.0", w, a, "0.0", repr(float(sense))]
    sheet.call("swung", arguments, (f"lean({link})", *step.outputs[1:]))
    lean = writer.name(f"lean({link})")
    base, *_ = map(writer.name, u(carrier))
    sheet.put(f"u({link})", f"{base} * {rest} * rotation({lean})")


def _turned(number: int, found: Linkage) -> Any:
    step = found.motion[number]
    assert isinstance(step, Call)
    return np.exp(1j * np.asarray(step.parameters[0]))
