"""A crank that cannot turn fully, let swing over its range, so that what it does can be told."""

from __future__ import annotations

from dataclasses import replace

from equipoise.dataclass import dataclass
from equipoise.i18n import Note
from equipoise.mechanism.assembly.linkage import assemble
from equipoise.mechanism.assembly.reach import Reach, reach
from equipoise.mechanism.assembly.stuck import motion_line, swing_within
from equipoise.mechanism.parts.machine import Machine

SWUNG = ("drive", "planting")
"""What of a machine is another where its crank swings."""


@dataclass(frozen=True)
class Swing:
    """A machine whose crank swings by a sine, once in a turn of the crank angle.

    machine : with that motion.  reach : how far its crank could go.
    """

    machine: Machine
    reach: Reach

    @property
    def note(self) -> Note:
        """What is shown, and the keys that have it in the file."""
        motion = self.machine.drive.motion
        assert motion is not None
        return Note(
            "{reason}; it is shown with an assumed sinusoidal motion just within that range, "
            "which is not in the file: {motion}",
            reason=self.reach.note,
            motion=motion_line(motion),
        )


def swing(machine: Machine) -> Swing | None:
    """The machine swinging over its range; None where its crank turns, or has a motion already.

    Raises
    ------
    MobilityError, MotionError, ModelError : the linkage cannot be moved at all.
    """
    if not machine.has_crank:
        return None
    linkage = assemble(machine)
    result = reach(linkage)
    if result is None:
        return None
    if result.is_point:
        _ = linkage.cycle  # which says so
    motion = swing_within(linkage, result).law
    drive = replace(machine.drive, motion=motion, motor=None, flywheel=0.0)
    return Swing(replace(machine, drive=drive, planting=None), result)
