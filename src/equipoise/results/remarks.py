"""What to look at again about a machine: every kind of remark, with where readers come upon it."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from typing import Literal, NamedTuple, Protocol

from equipoise.i18n import Note
from equipoise.mechanism.assembly.linkage import Linkage
from equipoise.mechanism.dynamics.assessment import joint_remarks, mass_remarks, questions
from equipoise.mechanism.dynamics.forces import Forces
from equipoise.mechanism.dynamics.reactions import idle_teeth_notes
from equipoise.mechanism.kinematics.motion import Motion
from equipoise.mechanism.parts.element_kinds import named_function, part_kinds
from equipoise.mechanism.parts.machine import Machine
from equipoise.mechanism.parts.support import idle_parts
from equipoise.results.braking import braking_motor
from equipoise.results.outputs import AnalysisOutputs
from equipoise.results.slender_links import slender_links
from equipoise.results.unreached_tables import unreached_tables

Place = Literal["parts", "joints", "sections", "end"]


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

    place: Place
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


def remarks_of(analysis: AnalyzedMachine, place: Place | None = None) -> Iterator[Note | str]:
    """What may not be meant, and where the machine fails; of one place alone if that is given."""
    for kind in KINDS:
        if place in (None, kind.place) and (analysis.has_forces or not kind.of_forces):
            yield from kind.of_linkage(analysis.motion.linkage)
            yield from kind.of(analysis)


def linkage_remarks(linkage: Linkage) -> Iterator[Note | str]:
    """What may not be meant, as far as a linkage shows it without its motion."""
    for kind in KINDS:
        yield from kind.of_linkage(linkage)
