"""Loop equations: what a pin, a sliding joint or a pair of gears demands of two bodies.

Each joint says that something vanishes: the gap of a pin (2 equations), turn and offset of a
slider (2), the mismatch of a gear (1).  The same expressions in velocities and accelerations are
linear in them, and the force in the joint acts where and as the gap is measured.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from equipoise.mechanism import kernels

Array = np.ndarray[Any, Any]


@dataclass(frozen=True)
class Pose:
    """Position and angle of a body with two derivatives, each of shape (..., N)."""

    place: tuple[Any, Any, Any]
    turn: tuple[Any, Any, Any]

    def point(self, arm: complex) -> tuple[Any, Any, Any]:
        angle, w, a = self.turn
        p, p1, p2 = kernels.point(*self.place, np.exp(1j * angle), w, a, arm)
        return p, p1, p2

    def pick(self, part: slice | Array) -> Pose:
        """The pose at some of the crank angles."""
        place, turn = (tuple(value[part] for value in values) for values in (self.place, self.turn))
        return Pose(place, turn)


@dataclass(frozen=True)
class End:
    """A point of a body: `arm` from the body's anchor."""

    body: str
    point: str
    arm: complex


Poses = dict[str, Pose]
Wrench = tuple[Any, float]


@dataclass(frozen=True)
class PinLoop:
    """Two points stay together; `on` carries the force that `by` exerts."""

    name: str
    on: End
    by: End

    unknowns: ClassVar[int] = 2

    def gaps(self, poses: Poses, level: int) -> list[Any]:
        """What vanishes (level 0), and its first and second derivative."""
        gap = (
            poses[self.on.body].point(self.on.arm)[level]
            - poses[self.by.body].point(self.by.arm)[level]
        )
        return [gap.real, gap.imag]

    def place(self, poses: Poses) -> Any:
        """Where its force acts."""
        return poses[self.on.body].point(self.on.arm)[0]

    def wrenches(self, poses: Poses, sense: Any) -> list[Wrench]:
        """Force and couple on `on`, at that place, for a unit of each unknown."""
        return [(1 + 0j, 0.0), (1j, 0.0)]


@dataclass(frozen=True)
class SlideLoop:
    """A link's point stays on a line of the body `by`, and the link does not turn in it."""

    name: str
    on: End
    by: End
    direction: float
    angle: float

    unknowns: ClassVar[int] = 2

    def gaps(self, poses: Poses, level: int) -> list[Any]:
        link, guide = poses[self.on.body], poses[self.by.body]
        turn = link.turn[level] - guide.turn[level]
        if level == 0:
            turn = turn - self.direction - self.angle
        d, d1, d2 = (
            a - b for a, b in zip(link.point(self.on.arm), guide.point(self.by.arm), strict=True)
        )
        angle, w, a = guide.turn
        line = np.exp(1j * (angle + self.direction))
        return [turn, kernels.along_line(d, d1, d2, line, w, a)[level].imag]

    def place(self, poses: Poses) -> Any:
        return poses[self.on.body].point(self.on.arm)[0]

    def wrenches(self, poses: Poses, sense: Any) -> list[Wrench]:
        normal = 1j * np.exp(1j * (poses[self.by.body].turn[0] + self.direction))
        return [(0j, 1.0), (normal, 0.0)]


@dataclass(frozen=True)
class GearLoop:
    """Angles of driven link, driver and carrier in a fixed relation."""

    name: str
    on: End
    by: End
    carrier: str
    ratio: float
    offset: float
    lever: complex
    radial: float

    unknowns: ClassVar[int] = 1

    def gaps(self, poses: Poses, level: int) -> list[Any]:
        driver, carrier = poses[self.by.body].turn, poses[self.carrier].turn
        wanted = kernels.gear(*driver, *carrier, self.ratio, self.offset)
        return [poses[self.on.body].turn[level] - wanted[level]]

    def place(self, poses: Poses) -> Any:
        """The pitch point."""
        turn = np.exp(1j * poses[self.carrier].turn[0])
        return poses[self.on.body].point(self.on.arm)[0] + turn * self.lever

    def wrenches(self, poses: Poses, sense: Any) -> list[Wrench]:
        """The flank in contact, told by `sense`, sets the line of action."""
        turn = np.exp(1j * poses[self.carrier].turn[0])
        return [(kernels.tooth(turn, sense, self.lever, self.radial), 0.0)]


@dataclass(frozen=True)
class StartAngle:
    """Stands in for a gear while the start is sought: its driven link has a given angle."""

    gear: GearLoop
    angle: float
    unknowns: ClassVar[int] = 1

    def gaps(self, poses: Poses, level: int) -> list[Any]:
        turn = poses[self.gear.on.body].turn[level]
        return [turn - self.angle if level == 0 else turn]


Loop = PinLoop | SlideLoop | GearLoop
Equation = Loop | StartAngle
