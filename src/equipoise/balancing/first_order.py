"""The shaking force and couple of order 1 of a crank: balance shafts, end weights, pistons.

F = A e^(ia) + B e^(-ia) + the rest, with the crank angle a: A turns with the crank, where a
counterweight on it adds to it, B against it, where only a shaft that turns so does.  Of a piston
alone A and B are equal, half of what reciprocates each.
"""

from __future__ import annotations

from cmath import phase, rect
from collections.abc import Iterator
from functools import cached_property
from math import degrees, pi, radians
from typing import ClassVar

import numpy as np

from equipoise.balancing.policy import (
    ABOUT_HALF,
    PISTON_SHARE,
    WORTH_NAMING,
    WORTH_SHAFTS,
)
from equipoise.balancing.workshop import direction_named, weight_named
from equipoise.dataclass import dataclass
from equipoise.i18n import say, to_say
from equipoise.mechanism.kinematics.motion import Motion
from equipoise.mechanism.parts.machine import Machine
from equipoise.quantities import display, format_quantity, percent
from equipoise.results.analysis import Analysis
from equipoise.results.declaring import Declarations, ResultOutput
from equipoise.results.rotors import unbalances
from equipoise.results.yardsticks import FigureAssessment, throw_of
from equipoise.signals import Array

CRANK_ROD_PISTON = 3
"""Links of a machine of which a counterweight on the crank balances the piston."""


@dataclass(frozen=True)
class FirstOrderShafts:
    """Two shafts as fast as the crank, one each way, against the force of order 1.

    forward, backward : kg m, of what turns with the crank and against it.  gain : share of the RMS
    of the shaking force that is gone.
    """

    forward: float
    backward: float
    gain: float

    declared: ClassVar[Declarations] = {
        "forward": ResultOutput("of the shaft that turns with the crank", "unbalance"),
        "backward": ResultOutput("of the shaft that turns against it", "unbalance"),
        "gain": ResultOutput("share of the shaking force that is gone"),
    }


@dataclass(frozen=True)
class PistonBalance:
    """How much of what reciprocates is balanced on the crank, and what half of it would bring.

    share : that is balanced now; below 0 where what turns with the crank is not balanced either.
    along, across : N, peaks of the shaking force along the stroke and across it, now.
    half_along, half_across : N, with half of what reciprocates balanced.
    moment : kg m, of the counterweight that this takes; direction : rad, in the axes of the crank.
    radius : m, of the crank's end.
    """

    share: float
    along: float
    across: float
    half_along: float
    half_across: float
    moment: float
    direction: float
    radius: float

    declared: ClassVar[Declarations] = {
        "share": ResultOutput("of what reciprocates that is balanced"),
        "along": ResultOutput("largest shaking force along the stroke", "force"),
        "across": ResultOutput("and across it", "force"),
        "half_along": ResultOutput("along the stroke, with half of it balanced", "force"),
        "half_across": ResultOutput("and across it", "force"),
        "moment": ResultOutput("of the counterweight that this takes", "unbalance"),
        "direction": ResultOutput("of it in the axes of the crank", "angle"),
        "radius": ResultOutput(
            "of the crank's end, where a mass of moment / radius has it", "length"
        ),
    }

    @property
    def is_half(self) -> bool:
        """Whether half of what reciprocates is balanced already."""
        return abs(self.share - 0.5) < ABOUT_HALF


@dataclass(frozen=True, eq=False)
class FirstOrder:
    """A complex signal of a machine with a crank, and its parts of order 1.

    whole : (N,), at the angles of the motion.  angle : (N,) rad, with which order 1 turns.
    """

    motion: Motion
    whole: Array
    angle: Array

    @classmethod
    def of_shaking_force(cls, analysis: Analysis) -> FirstOrder:
        """Of the shaking force, x + iy, N, by the angle that the crank has turned."""
        x, y = (analysis.outputs[f"shaking_force.{axis}"].resolved for axis in "xy")
        motion = analysis.resolved.motion
        return cls(motion, np.asarray(x + 1j * y), np.asarray(motion.crank_angle))

    @cached_property
    def turned(self) -> Array:
        """e^(ia), (N,)."""
        return np.asarray(np.exp(1j * self.angle))

    @cached_property
    def ahead(self) -> complex:
        """A of A e^(ia): what turns with the crank."""
        return complex(self.motion.mean(self.whole / self.turned))

    @cached_property
    def against(self) -> complex:
        """B of B e^(-ia): what turns against it."""
        return complex(self.motion.mean(self.whole * self.turned))

    def without(self, ahead: bool = True, against: bool = True) -> Array:
        """The rest (N,) without one of these or both."""
        turned = ahead * self.ahead * self.turned + against * self.against / self.turned
        return np.asarray(self.whole - turned)

    def rms(self, signal: Array) -> float:
        """RMS over a cycle."""
        return float(np.sqrt(self.motion.mean(np.abs(signal) ** 2)))

    def gain(self, rest: Array) -> float:
        """Share of the RMS that is gone where a rest (N,) is left."""
        return 1 - self.rms(rest) / self.rms(self.whole)


def balance_shafts_for(
    analysis: Analysis, entries: tuple[FigureAssessment, ...]
) -> FirstOrderShafts | None:
    """Balance shafts against the shaking force; None where it is not large enough for them, or
    little of it is of order 1.

    The unbalances are |A| / w^2 and |B| / w^2.
    """
    force = next((entry for entry in entries if entry.output == "shaking_force"), None)
    if force is None or not analysis.machine.has_crank or force.ratio < WORTH_SHAFTS:
        return None
    if unbalances(analysis.machine):
        return None  # a rotor is balanced by itself, an exciter not at all
    first = FirstOrder.of_shaking_force(analysis)
    gain = first.gain(first.without())
    if gain < WORTH_NAMING:
        return None
    square = analysis.resolved.motion.speed**2
    return FirstOrderShafts(abs(first.ahead) / square, abs(first.against) / square, gain)


def piston_balance_for(
    analysis: Analysis, entries: tuple[FigureAssessment, ...]
) -> PistonBalance | None:
    """How much of a piston's mass is balanced; None where the shaking force is not large, or is
    not that of one piston that a crank drives.

    With the stroke in the direction s, what reciprocates has A = B' where B' = e^(2is) conj(B), of
    which a counterweight for the share b leaves 1 - 2 b.
    """
    machine = analysis.machine
    force = next((entry for entry in entries if entry.output == "shaking_force"), None)
    direction = _stroke_of(machine)
    large = force is not None and force.is_large
    if not large or direction is None or not machine.has_crank or len(machine.rows) > 1:
        return None
    first = FirstOrder.of_shaking_force(analysis)
    if np.sqrt(2) * abs(first.against) < PISTON_SHARE * first.rms(first.whole):
        return None
    way = np.exp(1j * direction)
    mirrored = way**2 * np.conj(first.against)
    share = (1 - (first.ahead / mirrored).real) / 2
    half = first.without(against=False)
    along, across = _peaks(first.whole / way)
    half_along, half_across = _peaks(half / way)
    crank = analysis.resolved.motion.links[machine.drive.link].angle[0]
    start = np.exp(1j * analysis.resolved.motion.crank_angle[0])
    # A counterweight u (complex, in the axes of the crank) shakes the frame with u w^2 e^(ia).
    weight = -first.ahead * start / np.exp(1j * crank) / analysis.resolved.motion.speed**2
    sizes = along, across, half_along, half_across, float(abs(weight)), float(np.angle(weight))
    return PistonBalance(float(share), *sizes, throw_of(analysis))


def _peaks(force: Array) -> tuple[float, float]:
    """Largest of both components of a force (N,)."""
    return float(np.max(np.abs(force.real))), float(np.max(np.abs(force.imag)))


def _stroke_of(machine: Machine) -> float | None:
    """Direction (rad) of the one link that slides on the frame, driven by a crank with a rod or a
    slot between them; None of other machines.
    """
    guided = {slider.link: slider.direction for slider in machine.sliders if slider.on == "frame"}
    is_plain = len(guided) == 1 and len(machine.links) <= CRANK_ROD_PISTON
    return next(iter(guided.values())) if is_plain else None


# -- sentences -------------------------------------------------------------------------------------


def shafts_sentence(
    shafts: FirstOrderShafts, crank: str, changed: bool, piston: PistonBalance | None = None
) -> str:
    """What balance shafts bring.

    changed : whether the machine is that with a remedy that is offered, beside which they are.
    piston : the choice of half of what reciprocates, where that has been said: it is what the
        first of the shafts would be for.
    """
    if piston is not None:
        return say(
            "With a shaft of {backward} as fast as {crank} against it besides, {gain} % of the "
            "shaking force would go.",
            crank=crank,
            backward=format_quantity(shafts.backward, "unbalance", digits=2),
            gain=percent(shafts.gain, 0),
        )
    as_it_is = to_say(
        "{forward} on {crank}, or on a shaft that turns with it, and a shaft of {backward} against "
        "it would take {gain} % off the shaking force of the machine as it is."
    )
    as_changed = to_say(
        "With that change {forward} more on {crank}, or on a shaft that turns with it, and a shaft "
        "of {backward} against it would take {gain} % off the shaking force that is left."
    )
    return say(
        as_changed if changed else as_it_is,
        crank=crank,
        forward=format_quantity(shafts.forward, "unbalance", digits=2),
        backward=format_quantity(shafts.backward, "unbalance", digits=2),
        gain=percent(shafts.gain, 0),
    )


def piston_sentences(balance: PistonBalance, crank: str) -> Iterator[str]:
    """How much of a piston is balanced, and the choice of half of it, with both forces."""
    forces = (balance.along, balance.across, balance.half_along, balance.half_across)
    unit_display = display("force", forces)
    names = ("along", "across", "half_along", "half_across")
    values = {
        name: unit_display.with_unit(unit_display.text(force, max(forces), 3))
        for name, force in zip(names, forces, strict=True)
    }
    if balance.is_half:
        yield say(
            "Half of what reciprocates is balanced on {crank} already: the shaking force is "
            "{along} along the stroke and {across} across it, and more on {crank} only trades one "
            "for the other.",
            crank=crank,
            **values,
        )
        return
    now = to_say(
        "{share} % of what reciprocates is balanced on {crank}: the shaking force is {along} along "
        "the stroke and {across} across it."
    )
    turning = to_say(
        "Nothing of what reciprocates is balanced on {crank}: the shaking force is {along} along "
        "the stroke and {across} across it."
    )
    template = turning if balance.share < 0 else now
    present = say(template, share=percent(balance.share), crank=crank, **values)
    added = to_say(
        "With half of it balanced, by {moment} added on {crank} at {direction} in its axes, or "
        "taken off opposite, it is {half_along} along and {half_across} across: choose by what the "
        "mounts bear."
    )
    taken = to_say(
        "With half of it balanced, by {moment} taken off the counterweight of {crank}, at "
        "{direction} in its axes, it is {half_along} along and {half_across} across: choose by "
        "what the mounts bear."
    )
    too_much = balance.share > 0.5  # a part of a counterweight that is there
    way = balance.direction + pi * too_much
    choice = say(
        taken if too_much else added,
        moment=weight_named(balance.moment, balance.radius),
        crank=crank,
        direction=direction_named(phase(rect(1.0, radians(round(degrees(way)))))),
        **values,
    )
    yield f"{present} {choice}"


@dataclass(frozen=True)
class EndWeights:
    """Two weights opposite each other at both ends of a shaft, against a couple between planes.

    moment : kg m, of each.  apart : m.  gain : share of the RMS of the couple that is gone.
    """

    moment: float
    apart: float
    gain: float

    declared: ClassVar[Declarations] = {
        "moment": ResultOutput("of each weight about the shaft", "unbalance"),
        "apart": ResultOutput("from end to end", "length"),
        "gain": ResultOutput("share of the couple of the rows that is gone"),
    }


def end_weights_for(analysis: Analysis, entries: tuple[FigureAssessment, ...]) -> EndWeights | None:
    """Weights at both ends of a shaft against a large couple between rows; None where little of it
    turns with the crank.

    A force F (complex) in the plane z has the moment M_x + i M_y = i z F, so that a couple A e^(ia)
    and the rest asks for |A| / (w^2 L) at the distance L.
    """
    machine, motion, outputs = analysis.machine, analysis.motion, analysis.outputs
    large = any(entry.is_large and entry.yardstick_kind == "bearings" for entry in entries)
    if len(machine.rows) < 2 or not large or not machine.has_crank:
        return None
    x, y = (outputs[name].values for name in ("rows.roll_moment", "rows.yaw_moment"))
    planes = [row.lateral for row in machine.rows]
    apart = max(planes) - min(planes)
    couple = FirstOrder(motion, np.asarray(x + 1j * y), np.asarray(motion.crank_angle))
    if not apart or not couple.rms(couple.whole):
        return None
    gain = couple.gain(couple.without(against=False))
    moment = abs(couple.ahead) / (motion.speed**2 * apart)
    return EndWeights(moment, apart, gain) if gain >= WORTH_NAMING else None


def end_sentences(ends: EndWeights, crank: str) -> Iterator[str]:
    """What two weights at the ends of a shaft would do."""
    yield say(
        "Two weights of {moment} on {crank} instead, opposite each other and {apart} apart, would "
        "take {gain} % off the couple of the rows.",
        moment=format_quantity(ends.moment, "unbalance", digits=2),
        crank=crank,
        apart=format_quantity(ends.apart, "length", digits=3),
        gain=percent(ends.gain, 0),
    )
