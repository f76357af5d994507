"""What is told of drives: how they run, and their work."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from equipoise.i18n import Note, said, say
from equipoise.mechanism.assembly.cycle import turns_given
from equipoise.mechanism.outputs.spoken import joint_named
from equipoise.mechanism.parts.drives import Drive, FurtherDrive
from equipoise.mechanism.parts.laws import Law
from equipoise.quantities import PER_RPM, angle, display, number
from equipoise.results.blocks import Column, Table, Value

if TYPE_CHECKING:
    from equipoise.mechanism.parts.machine import Machine
    from equipoise.results.analysis import Analysis


def driven(machine: Machine, speed: float) -> str:
    """How the drive runs."""
    drive = machine.drive
    law = drive.stroke or drive.motion
    if machine.drives and all(item.pushes for item in machine.driven):
        return say(
            "{drives}, {rate} cycles a minute",
            drives=say(", ").join(map(drive_told, machine.driven)),
            rate=number(abs(speed) / PER_RPM / turns_given(machine)),
        )
    if machine.drives or (law is not None and law.windings):
        return say(
            "crank angle at {speed} rpm ({rate} rad/s): {drives}",
            speed=number(speed / PER_RPM),
            rate=number(speed),
            drives=say(", ").join(map(drive_told, machine.driven)),
        )
    if law is not None:
        return say(
            "{what} from {low} to {high} and back, {rate} cycles a minute",
            what=pushed_named(drive) if drive.pushes else drive.link,
            **told_between(law),
            rate=number(abs(speed) * 60 / law.period),
        )
    return say(
        "{link} driven at {speed} rpm ({rate} rad/s)",
        link=machine.drive.link,
        speed=number(speed / PER_RPM),
        rate=number(speed),
    )


def drives_table(analysis: Analysis) -> Iterator[Table]:
    """What each drive does in a cycle, where there is more to it than one crank."""
    if not analysis.machine.has_crank and analysis.motion.whole_cycle:
        columns = (say("drive"), Column(say("work"), "energy"))
        forces = analysis.resolved.forces
        both = forces.work_both_ways
        work = ((link, Value(value, both[link])) for link, value in forces.work.items())
        yield Table.of(say("Work of the drives in a cycle"), columns, work)


def drive_told(drive: Drive | FurtherDrive) -> str:
    """How a driven link goes with the crank angle."""
    if drive.stroke is not None:
        ends = told_between(drive.stroke)
        return say("{what} goes from {low} to {high} and back", what=pushed_named(drive), **ends)
    if drive.motion is None:
        ratio = number(getattr(drive, "ratio", 1.0))
        return say("{link} turns {ratio} times as fast", link=drive.link, ratio=ratio)
    low, high = map(angle, drive.motion.extremes)
    if turns := drive.motion.windings:
        return say("{link} makes {turns} turns in a cycle by a law", link=drive.link, turns=turns)
    return say("{link} moves from {low} to {high} by a law", link=drive.link, low=low, high=high)


def told_between(law: Law) -> dict[str, str]:
    """The ends of a law's range, the unit behind the second."""
    low, high = law.extremes
    unit = display(law.dimension, [low, high])
    return {"low": unit.text(low), "high": unit.with_unit(unit.text(high))}


def pushed_named(drive: Drive | FurtherDrive) -> str:
    """What pushes, in words."""
    return said(pushing(drive))


def pushing(drive: Drive | FurtherDrive) -> Note | str:
    """What pushes: a cylinder by its ends, or a sliding joint."""
    if drive.between is None:
        return joint_named(drive.slider)
    return Note("cylinder {a} to {b}", a=drive.between[0], b=drive.between[1])
