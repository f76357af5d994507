"""What is wrong with drives."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from fractions import Fraction

from equipoise.errors import ModelError
from equipoise.i18n import Note
from equipoise.mechanism.checks import Bodies, bodies_at, unknown, unknown_link, wrong_speeds
from equipoise.mechanism.parts.couplings import as_fraction
from equipoise.mechanism.parts.drives import Drive, FurtherDrive
from equipoise.mechanism.parts.force_elements import wrong_motor
from equipoise.mechanism.parts.laws import MOST_TURNS, wrong_law

OF_CRANKS = Note("turns with the crank, and here the driven link has a motion; leave it out")


def wrong_together(first: Drive, others: Sequence[FurtherDrive]) -> Iterator[ModelError]:
    """Everything that is wrong with drives beside each other."""
    links = [first.link, *(item.link for item in others)]
    for number, link in enumerate(links[1:], 1):
        if link in links[:number]:
            note = Note("{link!r} has a drive already; leave one of them out", link=link)
            yield ModelError(f"drives[{number}].link", note)


def wrong_further(
    where: str, drive: FurtherDrive, bodies: Bodies, sliders: list[str]
) -> Iterator[ModelError]:
    """Everything that is wrong with a further drive."""
    yield from unknown_link(f"{where}.link", drive.link, bodies)
    yield from _wrong_push(where, drive, bodies, sliders)
    yield from _wrong_mover(where, drive)
    if drive.motor is not None and (drive.motion is not None or drive.pushes):
        yield ModelError(f"{where}.motor", OF_CRANKS)
    if drive.pushes:
        if drive.ratio != 1:
            yield ModelError(where, Note("give either stroke, or ratio"))
        return
    if drive.motion is not None:
        yield from wrong_law(f"{where}.motion", drive.motion)
        if drive.ratio != 1 or drive.start:
            yield ModelError(where, Note("give either motion, or ratio and start"))
    elif as_fraction(drive.ratio) is None or drive.turns > MOST_TURNS:
        limit_denominator = Fraction(drive.ratio).limit_denominator(MOST_TURNS)
        yield ModelError(
            f"{where}.ratio",
            Note(
                "got {ratio!r}, with which the motion does not repeat within {most} turns of the "
                "crank; give a fraction of small whole numbers to all digits, such as {near!r} for "
                "{fraction}",
                ratio=drive.ratio,
                most=MOST_TURNS,
                near=float(limit_denominator),
                fraction=str(limit_denominator),
            ),
        )


def wrong_drive(drive: Drive, bodies: Bodies, sliders: list[str]) -> Iterator[ModelError]:
    """Everything that is wrong with the drive, but for its link."""
    if drive.speeds:
        yield from wrong_speeds("drive.speeds", drive.speeds)
    yield from _wrong_push("drive", drive, bodies, sliders)
    yield from _wrong_mover("drive", drive)
    if drive.motion is not None:
        yield from wrong_law("drive.motion", drive.motion)
    if drive.motion is None and drive.stroke is None:
        return
    for name in ("motor", "flywheel", "brake"):
        if getattr(drive, name):
            yield ModelError(f"drive.{name}", OF_CRANKS)


def _wrong_mover(where: str, drive: Drive | FurtherDrive) -> Iterator[ModelError]:
    """What is wrong with a drive that moves freely."""
    if drive.motor is not None:
        yield from wrong_motor(f"{where}.motor", drive.motor)
    if drive.free and drive.motor is not None:
        yield ModelError(f"{where}.free", Note("a motor drives it; leave one of them out"))
    if drive.free and drive.pushes:
        note = Note("a stroke moves the link, and no run lets it go; leave one of them out")
        yield ModelError(f"{where}.free", note)


def _wrong_push(
    where: str, drive: Drive | FurtherDrive, bodies: Bodies, sliders: list[str]
) -> Iterator[ModelError]:
    """Everything that is wrong with a stroke and what has it."""
    law = drive.stroke
    if law is None:
        for name in ("between", "slider", "start") if where == "drive" else ("between", "slider"):
            if getattr(drive, name) not in (None, ""):
                note = Note(
                    "is given, but no stroke; say how long it is in [{place}]",
                    place=f"{where.partition('[')[0]}.stroke",
                )
                yield ModelError(f"{where}.{name}", note)
        return
    if (drive.between is None) == (not drive.slider):
        yield ModelError(f"{where}.stroke", Note("give either between or slider with it"))
    elif drive.motion is not None:
        yield ModelError(f"{where}.motion", Note("a stroke moves the link already; leave it out"))
    else:
        yield from _wrong_ends(where, drive, bodies, sliders)
        yield from wrong_law(f"{where}.stroke", law)


def _wrong_ends(
    where: str, drive: Drive | FurtherDrive, bodies: Bodies, sliders: list[str]
) -> Iterator[ModelError]:
    if drive.between is None:
        if drive.slider not in sliders:
            yield ModelError(f"{where}.slider", unknown(drive.slider, sliders, "slider"))
        return
    known = bodies_at(bodies)
    for number, point in enumerate(drive.between, 1):
        if point not in known:
            yield ModelError(f"{where}.between[{number}]", unknown(point, known, "point"))
            return
    first, second = drive.ends(bodies)
    if first == second:
        note = Note("both points are of {body!r}; give points of two bodies", body=first)
        yield ModelError(f"{where}.between", note)
