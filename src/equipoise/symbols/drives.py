"""What is to be drawn of a drive: where it turns, swings or pushes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from equipoise.mechanism.motion import Motion


@dataclass(frozen=True)
class Drive:
    """The link that is driven, the point that it turns about, and its sense: 1, -1, or 0.

    swings : angles of the link between which it goes to and fro, rad, where it does not turn.
    between : points that a cylinder pushes apart, where one drives.
    """

    link: str
    pivot: str
    sense: int
    swings: tuple[float, float] | None = None
    between: tuple[str, str] | None = None

    @classmethod
    def of(cls, motion: Motion) -> Drive:
        """That of a machine in motion."""
        drive, angle = motion.machine.drive, motion.links[motion.machine.drive.link].angle
        law = drive.stroke or drive.motion
        if law is None or law.windings:
            return cls(drive.link, motion.linkage.pivot, int(np.sign(motion.speed)))
        swings = None if drive.pushes else (float(angle.min()), float(angle.max()))
        return cls(drive.link, motion.linkage.pivot, 0, swings, drive.between)
