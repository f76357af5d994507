"""Free vibration of a machine on its support."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property
from typing import ClassVar

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.errors import MassError, ModelError
from equipoise.i18n import Note
from equipoise.mechanism.dynamics.forces import massless
from equipoise.mechanism.parts.machine import Machine
from equipoise.mechanism.parts.support import Place
from equipoise.results.declaring import NOTES, TITLE, Declarations, ResultOutput
from equipoise.results.result import Result
from equipoise.signals import Array
from equipoise.vibration.body import MISSING
from equipoise.vibration.forced import excitation_model_of
from equipoise.vibration.linear import Linear, gauges_of
from equipoise.vibration.response import Mode, members_of


@dataclass(frozen=True, eq=False)
class GaugedMode:
    """A mode, and what each gauge reads of its shape: real and imaginary part."""

    mode: Mode
    gauges: Mapping[str, list[float]]

    declared: ClassVar[Declarations] = {
        "mode": ResultOutput("of the support", of=Mode.declared, spliced=True),
        "gauges": ResultOutput(
            "reading of the shape at each gauge: real and imaginary part", family=True
        ),
    }


@dataclass(frozen=True, eq=False, repr=False)
class FreeVibration(Result):
    """Modes of a machine on its support, standing in the mean of a turn.

    linear : the machine as a linear system.  modes : by frequency.
    preloads : force (N) or torque (N m) of each mount at rest.
    notes : what a reader has to know.
    """

    blocks_in = "vibration.sweep_blocks.free_blocks"
    pictures_in = "figures.pictures.mode_pictures"
    records: ClassVar[str] = "modes"

    linear: Linear
    modes: tuple[Mode, ...]
    preloads: Mapping[str, float]
    notes: tuple[Note, ...] = ()

    @property
    def machine(self) -> Machine:
        return self.linear.body.machine

    @property
    def coordinates(self) -> tuple[str, ...]:
        """What the parts of a shape belong to: displacements and rotations of the support."""
        return self.linear.body.support.coordinates

    @property
    def reference(self) -> Place:
        """The point (x, y, z), m, in the frame about which matrices and shapes are: the support's
        pivot, or its centre of mass.
        """
        return self.linear.body.support.reference

    @cached_property
    def gauges(self) -> Mapping[str, Array]:
        """What each gauge reads of each mode's shape, complex (modes,)."""
        body = self.linear.body
        shapes = np.array([mode.shape for mode in self.modes]).reshape(-1, len(body.free))
        return {n: shapes @ body.row(gauge)[body.free] for n, gauge in gauges_of(body).items()}

    @property
    def gauged_modes(self) -> tuple[GaugedMode, ...]:
        """Each mode with what the gauges read of its shape."""
        read = {name: values.tolist() for name, values in self.gauges.items()}
        return tuple(
            GaugedMode(
                mode, {name: [values[k].real, values[k].imag] for name, values in read.items()}
            )
            for k, mode in enumerate(self.modes)
        )

    declared: ClassVar[Declarations] = {
        "title": TITLE,
        "model": ResultOutput("which equations", read="linear.excitation.model"),
        "coordinates": ResultOutput(
            "displacements and rotations to which parts of shapes and matrices belong",
            read=lambda free: list(free.coordinates),
        ),
        "reference": ResultOutput(
            "point (x, y, z) that is displaced and about which the support turns: its pivot, or "
            "its centre of mass",
            "length",
            read=lambda free: list(free.reference),
        ),
        "modes": ResultOutput(
            "natural modes, the slowest first",
            of=GaugedMode.declared,
            many=True,
            read="gauged_modes",
        ),
        "mass": ResultOutput("matrix for the coordinates", read="linear.mass"),
        "damping": ResultOutput("matrix for the coordinates", read="linear.damping"),
        "stiffness": ResultOutput("matrix for the coordinates", read="linear.stiffness"),
        "preloads": ResultOutput(
            "force or torque of each mount at rest",
            "force",
            "torque",
            family=True,
            members=members_of("mounts"),
        ),
        "notes": NOTES,
    }


def modes(machine: Machine, model: str | None = None) -> FreeVibration:
    """Natural frequencies, damping and shapes of a machine on its support.

    Parameters
    ----------
    model : ``moment``, the default, for the linkages' mass spread as in the mean of a turn;
        ``linear`` or ``torque``, for it at the drive's pivot.

    Raises
    ------
    ModelError : there is no support, or its mounts do not hold it.
    MassError, MotionError, UsageError.
    """
    if machine.support is None:
        raise ModelError("support", MISSING)
    if missing := massless(machine):
        raise MassError(missing)
    linear = Linear.of(machine, excitation_model_of(model))
    return FreeVibration(linear, linear.modes, linear.rest.preload, tuple(linear.unsettled))
