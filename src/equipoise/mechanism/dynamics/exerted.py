"""What bodies and drives exert, as outputs are read of it: of a machine, and of its parameters."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping
from functools import cached_property

from equipoise.mechanism.dynamics.reactions import BeltForce, CamForce, JointForce, MeshForce, Pass
from equipoise.mechanism.parts.belts import Belt
from equipoise.signals import Array


class Exerted(ABC):
    """What is read of a run over the joints, `solved`."""

    @property
    @abstractmethod
    def solved(self) -> Pass: ...

    @abstractmethod
    def tension(self, belt: Belt) -> float:
        """What both strands of a belt have anyway, N."""

    @property
    def drive_torque(self) -> Array:
        """Torque of the first drive on its link, N m; times that link's speed it is its power."""
        return self.solved.drive_torque

    @property
    def drives(self) -> Mapping[str, Array]:
        """Torque of each drive on its link, N m, or its force, N, by the name of the link."""
        return self.solved.drives

    @property
    def drive_force(self) -> Array:
        """Force with which a drive pushes its ends apart, N; of one that does."""
        return self.solved.drive_force

    @cached_property
    def joints(self) -> Mapping[str, JointForce]:
        """Force in each pin and slider, by name, on the later body by the earlier one."""
        return self.solved.joints

    @cached_property
    def gears(self) -> Mapping[str, MeshForce]:
        """Force between the teeth of each pair of gears, on the driven gear by the driver."""
        return self.solved.gears

    @cached_property
    def racks(self) -> Mapping[str, MeshForce]:
        """Force between the teeth of each rack and its pinion, on the driven of them."""
        return self.solved.racks

    @cached_property
    def belts(self) -> Mapping[str, BeltForce]:
        """Pull and tensions of each belt on its driven link."""
        return self.solved.belts(self.tension)

    @cached_property
    def cams(self) -> Mapping[str, CamForce]:
        """Force of each cam on its follower."""
        return self.solved.cams
