"""Outputs split by cause and link, or by the parameters in which they are linear."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field, fields

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.displays import Brief
from equipoise.errors import UsageError
from equipoise.mechanism.assembly.steps import Array
from equipoise.mechanism.checks import unknown
from equipoise.mechanism.dynamics.force_readings import HasCouplings
from equipoise.mechanism.dynamics.out_of_plane import OF_FRAME, OutOfPlaneMoments
from equipoise.mechanism.dynamics.reactions import (
    CouplingForces,
    JointForce,
    SliderForce,
)
from equipoise.mechanism.parts.force_kinds import force_kinds
from equipoise.mechanism.parts.machine import Machine

ELEMENTS: Mapping[str, str] = {
    kind.cause: kind.cause_label for kind in force_kinds(Machine).values()
}
"""Causes of force elements, which act between bodies, the frame too, with their labels; the first
are springs, with which preloads of couplings are listed."""
INERTIA = ("translation", "rotation")
"""Inertia of the centres of mass, inertia of rotation about them."""
EVERYWHERE = (*INERTIA, "weight", "load", "spring")
"""Causes that every machine has, be they 0; loads are those from outside."""
CAUSES = tuple(dict.fromkeys((*EVERYWHERE, *ELEMENTS, "friction")))
"""All of them, friction in joints as the last."""


@dataclass(frozen=True, eq=False, repr=False)
class Shares(HasCouplings, Brief):
    """Shares of outputs: arrays (..., N), whose first axes are the causes, links or parameters.

    drives : link -> torque of its drive, N m, of which `drive_torque` is the first.
    shaking_force, frame_force : complex, N.  shaking_moment, frame_moment, drive_torque : N m.
    drive_force : N, of a drive that pushes.
    joints : name -> force whose arrays have those axes; couplings : such names by list of the file.
    across : what links beside each other do; None where they all lie in one plane.
    """

    shaking_force: Array
    shaking_moment: Array
    frame_force: Array
    frame_moment: Array
    drive_torque: Array
    drives: Mapping[str, Array]
    joints: Mapping[str, JointForce]
    couplings: CouplingForces
    across: OutOfPlaneMoments | None
    drive_force: Array | None = field(default=None, kw_only=True)

    @property
    def of_machine(self) -> dict[str, Array]:
        """All but the forces in joints and couplings, by name."""
        known = {item.name: getattr(self, item.name) for item in fields(Shares)}
        if self.across is not None:
            known |= {name: getattr(self.across, name).value for name in OF_FRAME}
        return {name: value for name, value in known.items() if isinstance(value, np.ndarray)}


@dataclass(frozen=True, eq=False, repr=False)
class Split(Shares):
    """Outputs by cause and link: arrays (C, L, N), links in file order.

    causes : those of `CAUSES` that every machine has, and of the others those of this machine.

    Teeth are taken with the flank in contact that the whole load gives, and chains with the strand
    that pulls.
    """

    causes: tuple[str, ...]
    links: tuple[str, ...]

    def by_cause(self, output: str) -> dict[str, Array]:
        """An output, such as ``drive_torque`` or ``joints.B``, summed over links."""
        return dict(zip(self.causes, self._array(output).sum(axis=1), strict=True))

    def by_link(self, output: str) -> dict[str, Array]:
        """An output, such as ``drive_torque`` or ``joints.B``, summed over causes."""
        return dict(zip(self.links, self._array(output).sum(axis=0), strict=True))

    def _array(self, output: str) -> Array:
        of_machine = self.of_machine
        for name, joint in self.joints.items():
            of_machine[f"joints.{name}"] = joint.value
            if isinstance(joint, SliderForce):
                of_machine[f"joints.{name}.moment"] = joint.moment
        for name, effort in self.drives.items():
            of_machine |= {f"drives.{name}.{what}": effort for what in ("torque", "force")}
        for table, forces in self.couplings.items():
            for name, force in forces.items():
                of_machine[f"{table}.{name}"] = force.value
                of_machine |= {f"{table}.{name}.{part}": item for part, item in force.parts.items()}
        if self.across is not None:
            of_machine |= {
                f"bearings.{name}": bearing.value for name, bearing in self.across.bearings.items()
            }
        if output not in of_machine:
            raise UsageError(unknown(output, of_machine, "output"))
        return of_machine[output]
