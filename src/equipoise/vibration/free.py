"""Free vibration of a machine on its support, and the start from rest."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property
from math import pi
from typing import ClassVar

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.errors import MassError, ModelError, ResponseError, UsageError
from equipoise.i18n import Note
from equipoise.mechanism.dynamics.forces import massless
from equipoise.mechanism.parts.machine import Machine
from equipoise.mechanism.parts.support import SpaceVector
from equipoise.quantities import in_si
from equipoise.results.declaring import NOTES, TITLE, Declarations, ResultOutput
from equipoise.results.result import Result
from equipoise.signals import Array
from equipoise.vibration.body import MISSING, SupportBody, gauges_of
from equipoise.vibration.coupled import Coupled, follow
from equipoise.vibration.exact import solve_exact
from equipoise.vibration.forced import chosen_model, steady_speed
from equipoise.vibration.linear import Linear
from equipoise.vibration.response import Mode, members_of
from equipoise.vibration.simplified import linear_of
from equipoise.vibration.steady import equations, motor_setting
from equipoise.vibration.support_motion import SpatialMounts, SupportMotion, in_plane


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

    blocks_in = "vibration.blocks.free_blocks"
    pictures_in = "figures.modes.mode_charts"
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
    def reference(self) -> SpaceVector:
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
    linear = linear_of(machine, model)
    return FreeVibration(linear, linear.modes, linear.rest.preload, tuple(linear.unsettled))


MOST_TURNS = 2000
"""Turns that are integrated at most, some minutes of computing."""
LEAST_SAMPLES, SAMPLES_PER_TURN, MOST_SAMPLES = 2001, 72, 1_000_000
"""Instants where none are asked for, at least and in a turn (every 5 deg); at most."""


@dataclass(frozen=True, eq=False, repr=False)
class Transient(Result):
    """A machine on its support from rest, at M instants.

    time : (M,) s.  states : (n, M), displacements and velocities of the free coordinates.
    crank_angle, crank_speed : (M,), rad and rad/s.
    """

    machine: Machine
    system: Coupled
    time: Array
    states: Array
    crank_angle: Array
    crank_speed: Array

    @cached_property
    def support(self) -> SupportMotion | None:
        """How the support moves; None on solid ground."""
        if self.machine.support is None:
            return None
        body = SupportBody(self.machine)
        at = in_plane(*self.system.place_and_rate(self.states))
        return SupportMotion(body, at, SpatialMounts.of(body, self.system.contacts))

    @property
    def gauges(self) -> Mapping[str, Array]:
        """Displacement (M,) at each gauge, m or rad."""
        return {} if self.support is None else self.support.gauges

    @property
    def mounts(self) -> Mapping[str, Array]:
        """Force (M,) of each mount, N or N m."""
        return {} if self.support is None else self.support.mounts

    blocks_in = "vibration.blocks.transient_blocks"
    pictures_in = "figures.time_charts.transient_charts"
    declared: ClassVar[Declarations] = {
        "title": TITLE,
        "time": ResultOutput("instants", "time", column="time"),
        "crank_angle": ResultOutput("crank angle since the start", "angle", column="crank_angle"),
        "crank_speed": ResultOutput("speed of the crank", "angular speed", column="crank_speed"),
        **SupportMotion.declared,
    }


def simulate(
    machine: Machine,
    duration: float | str,
    speed: float | str | None = None,
    drive: bool = False,
    samples: int | None = None,
) -> Transient:
    """Follow a machine from rest in the drawn position.

    Parameters
    ----------
    duration : s, or a text such as ``"2 s"``.
    speed : of the crank, rad/s, or a text such as ``"300 rpm"``, which it has at once; with
        `drive` it stands still at first, and the motor brings it up.
    samples : number of instants of the result; 72 in each turn, and 2000 at least, if None.

    Raises
    ------
    ModelError, UsageError, ResponseError.
    """
    duration = in_si(duration, "time", "duration")
    if machine.support is not None and machine.pushers:
        raise UsageError(
            Note(
                "`simulate` follows one crank that turns, not strokes; compute their vibration "
                "with `equipoise respond`"
            )
        )
    if machine.support is not None and not machine.has_crank:
        raise UsageError(
            Note(
                "`simulate` follows one crank that turns; follow several drives, or one that goes "
                "by a law, with `equipoise run --support`"
            )
        )
    chosen_model(machine, "exact", drive)
    if missing := massless(machine):
        raise MassError(missing)
    speed = steady_speed(machine, speed, drive)
    if samples is not None and not 2 <= samples <= MOST_SAMPLES:
        raise UsageError(
            Note(
                "got {samples!r} for samples; give 2 to {most_samples}",
                samples=samples,
                most_samples=MOST_SAMPLES,
            )
        )
    turns = abs(speed) * duration / (2 * pi)
    if not 0 < turns <= MOST_TURNS:
        raise UsageError(
            Note(
                "got {duration:g} s, in which the crank makes {turns:.4g} turns; give a "
                "time of more than 0 and at most {most_turns} turns, {longest:.4g} s",
                duration=duration,
                turns=turns,
                most_turns=MOST_TURNS,
                longest=MOST_TURNS * 2 * pi / abs(speed),
            )
        )
    system, _ = equations(machine, speed, drive)
    shift = _shift(machine, speed) if drive else 0.0
    states_of = 2 * len(system.free)
    begin = np.zeros(states_of + 2)
    begin[states_of] = 0.0 if drive else speed
    count = max(LEAST_SAMPLES, round(SAMPLES_PER_TURN * turns)) if samples is None else samples
    time = np.linspace(0.0, duration, count)
    states = follow(system, time, begin, shift)
    moved, crank_speed, crank_angle = np.split(states, [states_of, states_of + 1])
    return Transient(machine, system, time, moved, crank_angle[0], crank_speed[0])


def _shift(machine: Machine, speed: float) -> float:
    """Shift of the motor's curve that holds the mean speed in the steady state."""
    motor = machine.drive.motor
    assert motor is not None
    if motor.mean_speed == "free":
        return 0.0
    try:
        return float(solve_exact(machine, speed, True).steady.orbit.starts[-1, 0])
    except ResponseError:  # then as if the speed were constant
        return motor_setting(machine, speed)[1]
