"""A machine at crank angle 0: its sketch, and where places of its links are then."""

from __future__ import annotations

from cmath import phase
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, cast

import numpy as np

from equipoise.mechanism.family import Family
from equipoise.mechanism.linkage import assemble
from equipoise.mechanism.steps import u
from equipoise.plotting.linkage import Sketch, sketch

if TYPE_CHECKING:
    from equipoise.mechanism.family import Triple
    from equipoise.mechanism.model import Machine
    from equipoise.mechanism.steps import State
    from equipoise.mechanism.tip import TipCurve

Array = np.ndarray[Any, Any]


@dataclass(frozen=True, eq=False)
class Placed:
    """A machine at crank angle 0."""

    machine: Machine

    @property
    def machines(self) -> tuple[Machine, ...]:
        """What `sketch` asks of a tip's curve, without a tip."""
        return (self.machine,)

    @cached_property
    def family(self) -> Family:
        """The machine as the only one of its kind."""
        return Family([assemble(self.machine)])

    @cached_property
    def state(self) -> State:
        """Every link known."""
        return self.family.solve(np.zeros((1, 1)))

    def point_of(self, state: State, point: str, link: str) -> Triple:
        """A point of a link."""
        return self.family.point(state, link, point)

    @cached_property
    def drawn(self) -> Sketch:
        """All that is there to be drawn, m."""
        return sketch(cast("TipCurve", self), 0.0)

    def turned(self, link: str) -> complex:
        """The direction of a link's x axis."""
        return complex(np.ravel(self.state[u(link)[0]])[0])

    def angle(self, link: str) -> float:
        """The same as an angle, rad."""
        return phase(self.turned(link))

    def at(self, link: str, place: complex) -> complex:
        """Where a place in a link's axes is in the frame, m."""
        name, own = next(iter(self.machine.links[link].points.items()))
        anchor = complex(self.point_of(self.state, name, link)[0][0, 0])
        return anchor + self.turned(link) * (place - complex(*own))
