"""A machine at crank angle 0: its sketch, and where places of its links are then."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from equipoise.mechanism.motion import Motion, move
from equipoise.plotting.linkage import Sketch, sketch
from equipoise.scene import Scene

if TYPE_CHECKING:
    from equipoise.mechanism.model import Machine


@dataclass(frozen=True, eq=False)
class Placed:
    """A machine at crank angle 0."""

    machine: Machine

    @cached_property
    def motion(self) -> Motion:
        """Every link known."""
        return move(self.machine, [0.0])

    @cached_property
    def drawn(self) -> Sketch:
        """All that is there to be drawn, m."""
        return sketch(Scene.of(self.motion))

    def angle(self, link: str) -> float:
        """The direction of a link's x axis, rad."""
        return float(self.motion.links[link].angle[0])

    def at(self, link: str, place: complex) -> complex:
        """Where a place in a link's axes is in the frame, m."""
        name, own = next(iter(self.machine.links[link].points.items()))
        anchor = complex(self.motion.points[name].place[0])
        return anchor + complex(np.exp(1j * self.angle(link))) * (place - complex(*own))
