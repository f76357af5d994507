"""A dyad that comes near its dead position: where, what its joint bears, what mends it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from itertools import combinations
from math import pi
from typing import ClassVar

from equipoise.balancing.policy import (
    LEAST_MENDED,
    LENGTH_CHANGES,
    POOR_TRANSMISSION,
)
from equipoise.dataclass import dataclass
from equipoise.errors import EquipoiseError
from equipoise.i18n import say, to_say
from equipoise.mechanism.checks import bodies_at
from equipoise.mechanism.kinematics.motion import Motion, move
from equipoise.mechanism.outputs.declared import joint_named
from equipoise.mechanism.parts.machine import Machine
from equipoise.quantities import angle, format_quantity, percent
from equipoise.results.analysis import Analysis
from equipoise.results.declaring import Declarations, ResultOutput
from equipoise.results.yardsticks import TRANSMISSION, FigureAssessment

ROUNDING = 1e-6
"""Rad, by which another transmission angle may be smaller after a change."""
ANGLES = 120
"""Crank angles in a turn at which another length is looked at."""


@dataclass(frozen=True)
class PoorTransmission:
    """The joint whose transmission angle is the worst, and a length that mends it.

    joint : of the dyad.  transmission, crank_angle : rad.  limit : rad, the usual one.
    force : N, largest in that joint; None where its forces are not known.
    link, between : of which the length between two points is to change; empty where no single
        length helps.
    share : by which it grows.  length : m, that it has then.  mended : rad, the worst angle then.
    """

    joint: str
    transmission: float
    crank_angle: float
    limit: float
    force: float | None
    link: str
    between: tuple[str, str] | None
    share: float
    length: float
    mended: float

    declared: ClassVar[Declarations] = {
        "joint": ResultOutput("of which the transmission angle is the worst"),
        "transmission": ResultOutput("that angle", "angle"),
        "crank_angle": ResultOutput("at which it is so", "angle"),
        "limit": ResultOutput("the usual one", "angle"),
        "force": ResultOutput("largest in that joint; null where it is not known", "force"),
        "link": ResultOutput("of which a length mends it; empty where no single length does"),
        "between": ResultOutput("points of that length, or null"),
        "share": ResultOutput("by which it grows"),
        "length": ResultOutput("that it has then", "length"),
        "mended": ResultOutput("the worst angle then", "angle"),
    }


def poor_transmission_for(
    analysis: Analysis,
    entries: tuple[FigureAssessment, ...],
    as_it_is: PoorTransmission | None = None,
) -> PoorTransmission | None:
    """The worst transmission angle, where it is poor; None where none is.

    as_it_is : of the machine with other masses, whose lengths are the same.
    """
    poor = (
        entry
        for entry in entries
        if entry.yardstick_kind == "transmission" and entry.ratio >= POOR_TRANSMISSION
    )
    worst = next(poor, None)
    if worst is None or worst.crank_angle is None:
        return None
    force = analysis.outputs[f"joints.{worst.item}"] if _has_force(analysis, worst.item) else None
    peak = None if force is None else float(force.figures.peak)
    if as_it_is is not None and as_it_is.joint == worst.item:
        return replace(as_it_is, force=peak)
    best = _mended(analysis.motion, worst.item)
    link, between, share, length, mended = best or ("", None, 0.0, 0.0, worst.value)
    return PoorTransmission(
        worst.item, worst.value, worst.crank_angle, worst.yardstick, peak,
        link, between, share, length, mended,
    )  # fmt: skip


def _has_force(analysis: Analysis, joint: str) -> bool:
    return f"joints.{joint}" in analysis.outputs


Mending = tuple[str, tuple[str, str], float, float, float]
"""Link, its points, share, length (m), and the worst angle then (rad)."""


def _mended(motion: Motion, joint: str) -> Mending | None:
    """The smallest change of a length that brings all transmission angles within the usual limit;
    else that which helps most.  None where none helps, or the machine no longer goes round.
    """
    machine = motion.machine
    before = _worst_angles(motion)
    pairs: list[tuple[float, Mending]] = []
    for link, between in _lengths(machine, joint):
        for share in LENGTH_CHANGES:
            changed, length = _with_length(machine, link, between, share)
            try:
                after = _worst_angles(move(changed, ANGLES))
            except EquipoiseError:  # it no longer goes round
                continue
            others = all(after[name] >= min(before[name], TRANSMISSION) - ROUNDING
                         for name in before if name != joint)  # fmt: skip
            gain = after[joint] - before[joint]
            if others and gain >= LEAST_MENDED:
                enough = after[joint] >= TRANSMISSION
                score = 1 - abs(share) if enough else after[joint] - TRANSMISSION
                pairs.append((score, (link, between, share, length, after[joint])))
    return max(pairs, key=lambda item: item[0], default=(0.0, None))[1]


def _worst_angles(motion: Motion) -> dict[str, float]:
    """Smallest transmission angle of each joint, from stretched or folded, rad; of motion alone, as
    no forces are needed for many lengths.
    """
    each = ((joint, motion.figures(angles)) for joint, angles in motion.transmission.items())
    return {joint: min(figures.min, pi - figures.max) for joint, figures in each}


def _lengths(machine: Machine, joint: str) -> Iterator[tuple[str, tuple[str, str]]]:
    """Links of the dyad, its input and its output, and pairs of their pins."""
    joined = {name for name, bodies in bodies_at(machine.bodies).items() if len(bodies) > 1}
    for name, link in machine.links.items():
        pins = [point for point in link.points if point in joined]
        pairs = combinations(pins, 2)
        yield from ((name, pair) for pair in pairs if joint in pair or len(pins) == 2)


def _with_length(
    machine: Machine, link: str, between: tuple[str, str], share: float
) -> tuple[Machine, float]:
    """The machine with the second pin of a link farther from the first, and that distance, m."""
    points = machine.links[link].points
    first, second = (complex(*points[point]) for point in between)
    place = first + (1 + share) * (second - first)
    return machine.with_point(link, between[1], (place.real, place.imag)), abs(place - first)


# -- sentences -------------------------------------------------------------------------------------


def transmission_sentence(transmission: PoorTransmission, crank_turns: bool) -> str:
    """Where the angle is poor."""
    of_crank = to_say(
        "Transmission angle at {joint}: {value} at crank angle {angle} (usual: {limit})."
    )
    of_cycle = to_say(
        "Transmission angle at {joint}: {value} at {angle} of the cycle (usual: {limit})."
    )
    return say(
        of_crank if crank_turns else of_cycle,
        joint=joint_named(transmission.joint),
        value=format_quantity(transmission.transmission, "angle", digits=3),
        angle=angle(transmission.crank_angle),
        limit=angle(transmission.limit, 0),
    )


def mending_sentences(transmission: PoorTransmission) -> Iterator[str]:
    """Which length mends the angle, and what the joint bears."""
    yield _length_sentence(transmission)
    if transmission.force is not None:
        force = format_quantity(transmission.force, "force", digits=3)
        yield say(
            "Joint {joint} bears up to {force}.", joint=joint_named(transmission.joint), force=force
        )


def _length_sentence(transmission: PoorTransmission) -> str:
    """Which length mends it."""
    if transmission.between is None:
        return say(
            "No mass mends that transmission angle, nor any single length by a fifth: change "
            "several."
        )
    first, second = transmission.between
    longer = to_say(
        "No mass mends that transmission angle: {link} {share} % longer from {first} to "
        "{second} ({length}) brings it to {mended}, with other strokes."
    )
    shorter = to_say(
        "No mass mends that transmission angle: {link} {share} % shorter from {first} to "
        "{second} ({length}) brings it to {mended}, with other strokes."
    )
    return say(
        longer if transmission.share > 0 else shorter,
        link=transmission.link,
        share=percent(abs(transmission.share)),
        first=first,
        second=second,
        length=format_quantity(transmission.length, "length", digits=3),
        mended=angle(transmission.mended),
    )
