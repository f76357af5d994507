"""What to look at again about a machine: every kind of remark, with where readers come upon it."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from math import inf, pi
from typing import Literal, NamedTuple, Protocol

import numpy as np

from equipoise.i18n import Note, to_say
from equipoise.mechanism.assembly.linkage import Linkage
from equipoise.mechanism.dynamics.assessment import joint_remarks, mass_remarks, questions
from equipoise.mechanism.dynamics.forces import Forces
from equipoise.mechanism.dynamics.reactions import idle_teeth_notes
from equipoise.mechanism.dynamics.section_loads import ADDED, added_share, bending_frequency
from equipoise.mechanism.kinematics.motion import Motion, PlacedBodies
from equipoise.mechanism.parts.element_kinds import named_function, part_kinds
from equipoise.mechanism.parts.links import Link
from equipoise.mechanism.parts.machine import Machine
from equipoise.mechanism.parts.support import idle_parts
from equipoise.quantities import format_quantity, number, percent
from equipoise.results.outputs import LEAST_MEAN, AnalysisOutputs, motor_torque

RemarkPlace = Literal["parts", "joints", "sections", "end"]


class AnalyzedMachine(Protocol):
    """What remarks are taken from, as `Analysis` has it."""

    @property
    def machine(self) -> Machine: ...
    @property
    def motion(self) -> Motion: ...
    @property
    def has_forces(self) -> bool: ...
    @property
    def forces(self) -> Forces: ...
    @property
    def outputs(self) -> AnalysisOutputs: ...


class RemarkKind(NamedTuple):
    """A kind of remark.

    place : beside which tables of an analysis it stands, or at their end.
    of : remarks of a machine that has been analysed, a sentence each.
    of_forces : whether there are none without masses.
    of_linkage : remarks of a linkage, where they need no motion; in the place of `of`.
    """

    place: RemarkPlace
    of: Callable[[AnalyzedMachine], Iterable[Note | str]] = lambda _: ()
    of_forces: bool = False
    of_linkage: Callable[[Linkage], Iterable[Note | str]] = lambda _: ()


def part_remarks(forces: Forces) -> Iterator[Note]:
    """What kinds of parts say of their own, which stands beside their tables."""
    machine = forces.motion.machine
    for table, kind in part_kinds(type(machine)).items():
        if kind.remarks and getattr(machine, table):
            yield from named_function(kind.remarks)(forces)


KINDS = (
    RemarkKind("end", of_linkage=lambda linkage: mass_remarks(linkage.machine)),
    RemarkKind("joints", of_linkage=joint_remarks),
    RemarkKind(
        "joints",
        lambda analysis: idle_teeth_notes(analysis.motion.linkage, analysis.forces.solved.state),
        of_forces=True,
    ),
    RemarkKind("end", of_linkage=questions),
    RemarkKind("end", lambda analysis: unreached_tables(analysis.motion)),
    RemarkKind("parts", lambda analysis: part_remarks(analysis.forces), of_forces=True),
    RemarkKind(
        "end", lambda analysis: braking_motor(analysis.motion, analysis.outputs), of_forces=True
    ),
    RemarkKind(
        "sections", lambda analysis: slender_links(analysis.machine.links, analysis.motion.speed)
    ),
    RemarkKind("end", lambda analysis: idle_parts(analysis.machine.support)),
)


def remarks_of(analysis: AnalyzedMachine, place: RemarkPlace | None = None) -> Iterator[Note | str]:
    """What may not be meant, and where the machine fails; of one place alone if that is given."""
    for kind in KINDS:
        if place in (None, kind.place) and (analysis.has_forces or not kind.of_forces):
            yield from kind.of_linkage(analysis.motion.linkage)
            yield from kind.of(analysis)


def linkage_remarks(linkage: Linkage) -> Iterator[Note | str]:
    """What may not be meant, as far as a linkage shows it without its motion."""
    for kind in KINDS:
        yield from kind.of_linkage(linkage)


def unreached_tables(motion: Motion) -> Iterator[Note]:
    """Which tables a whole cycle never enters, with where it is instead: a sentence each.

    Such a table is counted from another place than is meant, or has another unit. What acts is its
    first or last row alone, or what goes on from there, and no figure shows it.
    """
    if not motion.whole_cycle:
        return
    for table, index, element in motion.machine.force_elements:
        where = f"{table}[{index + 1}]"
        argument = element.table_argument(PlacedBodies(motion, where))
        if argument is None:
            continue
        low, high = float(np.min(argument.values)), float(np.max(argument.values))
        first, last = argument.rows[0], argument.rows[-1]
        if low < last and high > first:
            continue
        ends = (low, high, first, last)
        names = ("low", "high", "first", "last")
        limits = {
            name: format_quantity(end, argument.dimension)
            for name, end in zip(names, ends, strict=True)
        }
        yield Note(
            "{where}: the {label} goes from {low} to {high}, and the rows from {first} to {last}, "
            "so that none is reached; check the rows, and from where they count",
            where=where,
            label=argument.label,
            **limits,
        )


def slender_links(links: Mapping[str, Link], speed: float) -> Iterator[Note]:
    """Links, by name, that at a speed of the crank, rad/s, bend so much that what is computed of
    rigid ones misleads.
    """
    for name, link in links.items():
        frequency = bending_frequency(link)
        if frequency is None or not speed:
            continue
        share = added_share(frequency, speed)
        if share <= ADDED:
            continue
        ratio = number(2 * pi * frequency / abs(speed), digits=3)
        if share == inf:
            yield Note(
                to_say(
                    "the {link} bends at {ratio} times the crank's speed, within its first two "
                    "orders: balancing by rigid links misleads; make it stiffer or lighter"
                ),
                link=name,
                ratio=ratio,
            )
        else:
            yield Note(
                to_say(
                    "the {link} has its first natural frequency at {ratio} times the crank's "
                    "speed: bending adds {share} % to forces of twice that speed, which balancing "
                    "by rigid links does not see"
                ),
                link=name,
                ratio=ratio,
                share=percent(share),
            )


def braking_motor(motion: Motion, outputs: AnalysisOutputs) -> Iterator[Note]:
    """That the motor brakes, which seldom is meant: a load with the wrong sign looks like that."""
    driven = motor_torque(motion.machine, outputs)
    if driven is None or not motion.whole_cycle:
        return
    torque, mean = driven
    if mean < -LEAST_MEAN * torque.figures.rms:
        yield Note(
            "what acts on the links drives the machine: in the mean its motor has to brake, with "
            "{torque} at the crank; if loads should resist, change their signs or that of the "
            "speed",
            torque=format_quantity(-mean, "torque"),
        )
