"""What is to be drawn of a drive: where it turns, swings or pushes."""

from __future__ import annotations

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.mechanism.kinematics.motion import Motion
from equipoise.mechanism.parts.machine import Drive, FurtherDrive


@dataclass(frozen=True)
class DriveSign:
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
    def each(cls, motion: Motion) -> tuple[DriveSign, ...]:
        """Those of a machine in motion."""
        return tuple(cls._of(drive, motion) for drive in motion.machine.driven)

    @classmethod
    def _of(cls, drive: Drive | FurtherDrive, motion: Motion) -> DriveSign:
        angle, pivot = motion.links[drive.link].angle, motion.linkage.anchors[drive.link]
        law = drive.stroke or drive.motion
        if law is None or law.windings:
            ahead = getattr(drive, "ratio", 1.0) if law is None else law.windings
            return cls(drive.link, pivot, int(np.sign(motion.speed * ahead)))
        swings = None if drive.pushes else (float(angle.min()), float(angle.max()))
        return cls(drive.link, pivot, 0, swings, drive.between)
