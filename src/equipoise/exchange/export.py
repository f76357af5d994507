"""Machines, balanced ones and stores as files of other programs."""

from __future__ import annotations

import os
from collections.abc import Iterator
from importlib import import_module
from math import isfinite

from equipoise.balancing.balanced import Balanced
from equipoise.balancing.whole_sizes import in_whole_sizes
from equipoise.errors import ChangePointError, RangeError, UsageError, at_place, needed, unknown
from equipoise.exchange.formats import FORMATS, Angles, Format, Job
from equipoise.i18n import LANGUAGES, Note, speaking, to_say
from equipoise.mechanism.assembly.linkage import assemble
from equipoise.mechanism.checks import numbered
from equipoise.mechanism.parts.element_kinds import ForceElement, part_kinds
from equipoise.mechanism.parts.machine import Machine
from equipoise.schema.files import printable, write
from equipoise.studies.selection import write_designs
from equipoise.studies.store import Store

FRICTION = to_say("friction in joints: forces are those without it")
PRESSED = to_say("friction in joints by what presses there: damping and drag alone are left")


def export(
    what: Machine | Balanced | Store,
    path: str | os.PathLike[str],
    format: str | None = None,
    *,
    crank_angle: float | None = None,
    kept: bool = False,
    link: str | None = None,
    angles: Angles = None,
    language: str = "en",
) -> tuple[str, ...]:
    """Write a machine, or all designs of a store, as a file of another program.

    Parameters
    ----------
    what : of a balanced machine the new counterweights are written too, if the format has a place.
    path : of the file, which is replaced where it is there.
    format : a name in ``equipoise.exchange.formats.FORMATS`` such as ``mjcf``; as the file's ending
        says if None.
    crank_angle : at which a machine is drawn, rad; 0 if None.  Loads along a link are those at it;
        if None at that of the largest stress, or, as a table, at all.
    kept : of a store only those designs that keep every limit.
    link : whose loads are written, in a format of them; the only link with a section if None.
    angles : instead of ``crank_angle``, crank angles of these loads: a number of them in each turn,
        or the angles, rad.
    language : code of one of `equipoise.i18n.LANGUAGES`, such as ``ja``, of drawings and pages.

    Returns
    -------
    What the format does not hold and the file therefore lacks, a sentence each.

    Raises
    ------
    UsageError : there is no such format, it cannot hold this, its library is not installed, or the
        file cannot be written.
    MassError, MotionError, ModelError : the machine cannot be computed as far as the format needs.
    """
    job = write_file(what, path, format, crank_angle=crank_angle, kept=kept, link=link,
                     angles=angles, language=language)  # fmt: skip
    return tuple(job.left_out) if job is not None else ()


def write_file(
    what: Machine | Balanced | Store,
    path: str | os.PathLike[str],
    format: str | None,
    *,
    crank_angle: float | None,
    kept: bool,
    link: str | None,
    angles: Angles,
    language: str,
) -> Job | None:
    """Write as `export` does; what was written of a machine, None of a store."""
    item = format_of(path, format, of_store=isinstance(what, Store))
    check_kind(item, of_store=isinstance(what, Store))
    if crank_angle is not None and not isfinite(crank_angle):
        raise UsageError(
            at_place(
                "crank_angle",
                Note("got {crank_angle}; give an angle in rad", crank_angle=crank_angle),
            )
        )
    if language not in LANGUAGES:
        names = ", ".join(LANGUAGES)
        wrong = Note("got {language!r}; give one of {names}", language=language, names=names)
        raise UsageError(at_place("language", wrong))
    if isinstance(what, Store):
        write_designs(what, path, kept=kept)
        return None
    check_link_loads(item, link=link, angles=angles)
    if angles is not None and crank_angle is not None:
        raise UsageError(Note("crank_angle and angles were given; give one of them"))
    with speaking(language):
        job, data = export_content(what, item, crank_angle, link, angles)
    write(path, data)
    return job


def check_kind(file_format: Format, *, of_store: bool) -> None:
    """Refuse designs of a store in a format for machines, and the other way round."""
    if file_format.of_store != of_store:
        holds = Note("designs of a store") if file_format.of_store else Note("machines")
        wanted = ", ".join(other.name for other in FORMATS.values() if other.of_store == of_store)
        raise UsageError(
            Note(
                "{title} is for {holds}; give one of {wanted}",
                title=file_format.title,
                holds=holds,
                wanted=wanted,
            )
        )


def check_link_loads(file_format: Format, *, prefix: str = "", **options: object) -> None:
    """Refuse options of loads along a link in a format without them."""
    for name, given in options.items():
        if given is not None and not file_format.of_link:
            formats = ", ".join(other.name for other in FORMATS.values() if other.of_link)
            raise UsageError(
                at_place(
                    f"{prefix}{name}",
                    Note(
                        "it goes with loads along a link, in the formats {formats}; leave it out",
                        formats=formats,
                    ),
                )
            )


def export_content(
    what: Machine | Balanced,
    file_format: Format,
    crank_angle: float | None = None,
    link: str | None = None,
    angles: Angles = None,
) -> tuple[Job, str | bytes]:
    """A file's content, and what was left out of it."""
    if file_format.needs:
        needed(file_format.needs, Note("a file of {title}", title=file_format.title))
    sizes = ""
    if isinstance(what, Balanced) and file_format.cuts:
        what, sizes = in_whole_sizes(what)
    machine, changes = (what.machine, what.changes) if isinstance(what, Balanced) else (what, None)
    if file_format.turns:
        check_turning(machine, file_format.title)
    forces_left_out = [*_left_out(machine, file_format)]
    frictionless = not file_format.rubs and any(
        joint.rubs_by_load if file_format.drags else joint.rubs for joint in machine.joints
    )
    if angles is None and crank_angle is not None:
        angles = [crank_angle]
    without_friction = machine.without_friction(file_format.drags) if frictionless else machine
    job = Job(without_friction, crank_angle or 0.0, changes, link, angles, sizes, forces_left_out)
    if frictionless:
        left_out = PRESSED if file_format.drags else FRICTION
        job.leave_out(Note(left_out))
    if not file_format.tightens:
        for coupling in machine.couplings:
            if coupling.preload:
                job.leave_out(
                    Note(
                        "the tension of the {noun} {name}, which its pins bear",
                        noun=Note(coupling.noun),
                        name=coupling.name,
                    )
                )
    if machine.pushers and not file_format.pushes:
        job.leave_out(Note("what pushes the machine, and its stroke"))
    data: str | bytes = import_module(file_format.maker).export_bytes(job)
    return job, data


def _left_out(machine: Machine, file_format: Format) -> Iterator[Note]:
    """Force elements that a format lacks, a kind each; joints and couplings that it lacks are
    refused, since nothing moves as it should without them.
    """
    for table, kind in part_kinds(type(machine)).items():
        for where, part in numbered(table, getattr(machine, table)):
            if file_format.has(part):
                continue
            if issubclass(kind, ForceElement):
                yield Note(kind.group)
                break
            refusal = Note(
                "a file of {title} has no {special}; give another format",
                title=file_format.title,
                special=Note(part.special),
            )
            raise UsageError(at_place(where, refusal))


def check_turning(machine: Machine, title: str) -> None:
    """Refuse a machine whose driven link does not turn evenly, all the way round.

    Raises
    ------
    UsageError : it does not; the sentence states why.
    """
    refusal = to_say("a file of {title} turns the driven link evenly all the way round: {why}")
    if not machine.has_crank:
        why = Note("this drive has a motion of its own")
        if machine.drives:
            why = Note("this machine has several drives")
        elif machine.pushers:
            why = Note("this drive pushes")
        raise UsageError(Note(refusal, title=title, why=why))
    try:
        _ = assemble(machine).cycle
    except (RangeError, ChangePointError) as error:
        refused = UsageError(Note(refusal, title=title, why=error.note))
        raise refused.like(error) from error


def format_of(
    path: str | os.PathLike[str], name: str | None = None, *, of_store: bool = False
) -> Format:
    """The format of a name, or of a file's ending.

    of_store : whether designs of a store are written, where an ending has a format of both.

    Raises
    ------
    UsageError : there is none.
    """
    if name is not None:
        if name not in FORMATS:
            raise UsageError(unknown(name, FORMATS, "format"))
        return FORMATS[name]
    ending = os.path.splitext(path)[1].lower()
    fitting = [item for item in FORMATS.values() if item.ending == ending]
    if not fitting:
        endings = ", ".join(dict.fromkeys(item.ending for item in FORMATS.values()))
        raise UsageError(
            Note(
                "got {given!r}; give the name of a file that ends in one of {endings}, or a format",
                given=printable(path),
                endings=endings,
            )
        )
    return next((item for item in fitting if item.of_store == of_store), fitting[0])
