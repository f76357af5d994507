"""What bodies and drives exert, as outputs are read of it: of a machine, and of its parameters."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping
from functools import cached_property
from typing import Any, ClassVar

from equipoise.mechanism.dynamics.reactions import CouplingForces, JointForce, JointReactions
from equipoise.mechanism.parts.couplings import coupling_kinds
from equipoise.mechanism.parts.machine import Machine
from equipoise.signals import Array


class HasCouplings:
    """What has `couplings`: forces by list of the file, each of which is an attribute too."""

    couplings: Any

    def __getattr__(self, name: str) -> Any:
        if name in coupling_kinds(Machine):
            return self.couplings[name]
        raise AttributeError(f"{type(self).__name__} has no {name!r}")


class ForceReadings(HasCouplings, ABC):
    """What is read of a run over the joints, `solved`.

    preloads : whether it has the preloads of couplings.
    """

    preloads: ClassVar[bool] = True

    @property
    @abstractmethod
    def solved(self) -> JointReactions: ...

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
    def couplings(self) -> CouplingForces:
        """Force of each coupling on its driven body, by list of the file and name."""
        return self.solved.couplings(lambda item: item.preload if self.preloads else 0.0)
