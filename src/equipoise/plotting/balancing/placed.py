"""A machine at one crank angle: its sketch, and where places of its links are then."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from equipoise.mechanism.motion import Motion, move
from equipoise.plotting.analysis.plane import clear_angle
from equipoise.plotting.linkage import Sketch, sketch
from equipoise.scene import Scene

if TYPE_CHECKING:
    from equipoise.mechanism.model import Machine

ANGLES = 720
"""In each turn."""


def placed_well(original: Machine, machine: Machine) -> Placed:
    """A machine at the crank angle at which joints and links of the original keep apart."""
    return Placed(machine, clear_angle(Scene.of(move(original, ANGLES))))


@dataclass(frozen=True, eq=False)
class Placed:
    """A machine at one of so many crank angles of its cycle, counted from 0.

    angles : in each turn.
    """

    machine: Machine
    number: int = 0
    angles: int = ANGLES

    @cached_property
    def motion(self) -> Motion:
        """Every link known."""
        return move(self.machine, self.angles)

    @property
    def crank_angle(self) -> float:
        """rad."""
        return float(self.motion.crank_angle[self.number])

    @cached_property
    def drawn(self) -> Sketch:
        """All that is there to be drawn, m."""
        return sketch(Scene.of(self.motion), self.number)

    def angle(self, link: str) -> float:
        """The direction of a link's x axis, rad."""
        return float(self.motion.links[link].angle[self.number])

    def at(self, link: str, place: complex) -> complex:
        """Where a place in a link's axes is in the frame, m."""
        name, own = next(iter(self.machine.links[link].points.items()))
        anchor = complex(self.motion.points[name].place[self.number])
        return anchor + complex(np.exp(1j * self.angle(link))) * (place - complex(*own))
