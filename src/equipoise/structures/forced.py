"""Steady response at one speed, by any of the models."""

from __future__ import annotations

from dataclasses import replace
from typing import cast, get_args

from equipoise.errors import MassError
from equipoise.mechanism.dynamics import massless
from equipoise.mechanism.model import Machine
from equipoise.structures.branches import respond_exact
from equipoise.structures.choice import chosen_model, left_out, steady_speed
from equipoise.structures.excitation import Step
from equipoise.structures.linear import Linear
from equipoise.structures.reduced import respond_coupled
from equipoise.structures.response import Model, Response
from equipoise.structures.small_motion import respond_linear


def respond(
    machine: Machine, speed: float | None = None, model: Model | None = None, drive: bool = False
) -> Response:
    """Steady vibration of a machine on its support, at one speed.

    Parameters
    ----------
    speed : of the crank, rad/s; that of the machine where not given.
    model : one of `MODELS`; where not given, ``linear`` for a support on a pivot, ``moment`` for
        any other, ``exact`` with `drive`.
    drive : whether the crank's speed follows from the motor instead of being constant.

    Raises
    ------
    ModelError : there is no support, or no motor, or the mounts do not hold the machine.
    MassError, MotionError, UsageError, ResponseError.
    """
    model = chosen_model(machine, model, drive)
    if missing := massless(machine):
        raise MassError(missing)
    speed = steady_speed(machine, speed, drive)
    if model in get_args(Step):
        found = respond_linear(Linear.of(machine, cast(Step, model)), speed)
    elif model == "coupled":
        found = respond_coupled(Linear.of(machine, "torque"), speed)
    else:
        found = respond_exact(machine, speed, drive)
    return replace(found, notes=(*left_out(machine), *found.notes))
