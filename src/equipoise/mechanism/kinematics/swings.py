"""A crank that cannot turn fully, let swing over its range, so that what it does can be told."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import degrees

import numpy as np

from equipoise.i18n import Note
from equipoise.mechanism.assembly.linkage import Linkage, assemble
from equipoise.mechanism.kinematics.followed import Followed
from equipoise.mechanism.kinematics.motion import Motion
from equipoise.mechanism.kinematics.reach import Reach, reach
from equipoise.mechanism.parts.laws import AngleLaw
from equipoise.mechanism.parts.machine import Machine, Position

SHORT = 0.02
"""Of the range, that a crank stays away from both ends, where forces grow without bound."""
SWUNG = ("drive", "gears", "position", "planting")
"""What of a machine is another where its crank swings."""
STEP = 0.02
"""rad: between crank angles at which the linkage is followed."""


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
        assert motion is not None and motion.between is not None
        low, high = (f'"{degrees(end):.4g} deg"' for end in motion.between)
        return Note(
            "{range}; without a motion in [drive] it swings a little short of that by a sine: "
            "motion = {{ between = [{low}, {high}] }}",
            range=self.reach.note,
            low=low,
            high=high,
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
    found = reach(linkage)
    if found is None:
        return None
    short = SHORT * (found.high - found.low)
    low, high = found.low + short, found.high - short
    drive = replace(machine.drive, motion=AngleLaw(between=(low, high)), motor=None, flywheel=0.0)
    changes: dict[str, object] = {"drive": drive, "planting": None}
    if machine.couplings or machine.position is not None:
        changes |= _begun(machine, linkage, low, high)
    return Swing(replace(machine, **changes), found)  # type: ignore[arg-type]


def _begun(machine: Machine, linkage: Linkage, low: float, high: float) -> dict[str, object]:
    """Start angles of gears and rough places as they are at one end of the swing."""
    theta = np.array([low])
    followed = Followed.over(linkage, min(low, 0.0), max(high, 0.0), STEP)
    motion = Motion(linkage, theta, 1.0, 0.0, False, followed.solve(theta))
    state, found = motion.state, dict[str, object]()
    if machine.gears:
        starts = (float(np.ravel(state[f"phi({gear.driven})"])[0]) for gear in machine.gears)
        pairs = zip(machine.gears, starts, strict=True)
        found["gears"] = tuple(replace(gear, start=start) for gear, start in pairs)
    if machine.position is not None:
        places = {name: complex(point.place[0]) for name, point in motion.points.items()}
        moving = {name: (z.real, z.imag) for name, z in places.items() if name not in machine.frame}
        turns = {link: np.angle(np.ravel(state[f"u({link})"])[0]) for link in machine.links}
        angles = {link: float(turn) for link, turn in turns.items()}
        found["position"] = Position(0.0, moving, angles)
    return found
