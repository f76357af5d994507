"""Forces between bodies against crank angle, as values."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from equipoise.mechanism.steps import Array


@dataclass(frozen=True, eq=False)
class VectorSignal:
    """A planar vector against crank angle; `value` is complex, x + i y, (..., N)."""

    value: Array

    @property
    def x(self) -> Array:
        return self.value.real

    @property
    def y(self) -> Array:
        return self.value.imag

    @property
    def size(self) -> Array:
        """Length of the vector."""
        return np.abs(self.value)

    @property
    def direction(self) -> Array:
        """Angle of the vector from the x axis, rad."""
        return np.angle(self.value)


@dataclass(frozen=True, eq=False)
class JointForce(VectorSignal):
    """Force in a pin, N: exerted on body `on` by body `by`."""

    on: str
    by: str


@dataclass(frozen=True, eq=False)
class SliderForce(JointForce):
    """Force in a sliding joint, N.

    normal : its part across the line, positive to the left of the line's direction.
    moment : couple about the slider's point, N m.
    """

    normal: Array
    moment: Array


@dataclass(frozen=True, eq=False)
class MeshForce(JointForce):
    """Force between teeth, N, along the line of action at the pitch point.

    tangential : part that transmits torque, positive where it turns the gear `on`
        counterclockwise.  radial : part along the line of centres, positive towards the pin of
        the gear `on`.
    """

    tangential: Array
    radial: Array


@dataclass(frozen=True, eq=False)
class CamForce(JointForce):
    """Force of a cam on its follower, N, along their common normal.

    normal : it along the normal away from the cam; below 0 where the follower is held back.
    """

    normal: Array
