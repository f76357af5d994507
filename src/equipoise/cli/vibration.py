"""The commands `modes`, `respond` and `simulate`: a machine on its support."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any

from equipoise.cli.options import (
    File,
    Model,
    Speed,
    count,
    ends_of_range,
    naming,
    quantity,
    read_by,
    size,
    sources_of,
)
from equipoise.cli.outputs import UNITS, Drawn, Outputs
from equipoise.cli.progress import counted
from equipoise.errors import EquipoiseError, UsageError

if TYPE_CHECKING:
    from equipoise.mechanism.model import Machine
    from equipoise.present.cells import Units
    from equipoise.vibration.response import Response


def modes(file: File, /, *, model: Model | None = None, outputs: Drawn = Drawn()) -> None:
    """Natural frequencies, damping and shapes of a machine on its support.

    Parameters
    ----------
    file
        Path of a model file with a table [support], or the name of a bundled example.
    model
        linear or torque: the linkages' mass at the drive's pivot; moment: spread as in the mean.
    """
    from equipoise.schema.models import load_linkage
    from equipoise.vibration import free

    machine = load_linkage(file)
    with naming(file):
        found = free.modes(machine, model)
    outputs.give_result(found)


def _speeds(option: str, text: str) -> list[float]:
    """One speed, or the two ends of a range; a unit may stand after the second only."""
    parts = ends_of_range(text)
    if not parts:
        raise UsageError(
            f'{option}: got {text!r}; give a speed, "193 rpm", or a range: "20 rpm : 400 rpm"'
        )
    ends = [quantity(option, part, "angular speed") for part in parts[::-1]][::-1]
    if ends == [0.0]:
        raise UsageError(
            f"{option}: got {text!r}; a crank that stands still shakes nothing; give another speed"
        )
    if len(ends) == 2 and (ends[0] * ends[1] <= 0 or abs(ends[0]) >= abs(ends[1])):
        raise UsageError(
            f"{option}: got {text!r}; give a range of speeds of the same sign that are not 0, the "
            "slower one first"
        )
    return ends


def respond(
    file: File,
    /,
    *,
    model: Model | None = None,
    speed: Annotated[Any, read_by(_speeds)] = None,
    speeds: Annotated[int | None, count(2, 20_000)] = None,
    drive: bool = False,
    units: Annotated[str, UNITS] = "",
    outputs: Outputs = Outputs(),
) -> None:
    """How the support of a machine vibrates under its linkages, at one speed or over a range.

    Parameters
    ----------
    file
        Path of a model file with a table [support], or the name of a bundled example.
    model
        linear (shaking force at the drive's pivot), torque (with the drive torque), moment (whole
        force and moment), coupled (with the torque that the motion takes), exact (all bodies).
    speed
        Speed of the crank instead of the file's: "193 rpm", or a range: "20 rpm : 400 rpm".
    speeds
        With a range: number of speeds, 200 if not given; more are added about resonances.
    drive
        Let the speed follow from the motor in [drive.motor], by the model exact.
    """
    ends: list[float] = speed or []
    if speeds is not None and len(ends) != 2:
        raise UsageError('--speeds belongs to a range, --speed "20 rpm : 400 rpm"; give both')
    machine, shown_in = _machine(file, units, outputs)
    at = ends[0] if ends else None
    with naming(file):
        if len(ends) == 2:
            _sweep(machine, (ends[0], ends[1]), model, drive, speeds, shown_in, outputs)
        else:
            _answer(machine, at, model, drive, shown_in, outputs)


def simulate(
    file: File,
    duration: Annotated[float, size("time", "give a time of more than 0", "DURATION")],
    /,
    *,
    speed: Speed = None,
    drive: bool = False,
    units: Annotated[str, UNITS] = "",
    outputs: Outputs = Outputs(),
) -> None:
    """How the support vibrates when the machine starts from rest, by the model exact.

    Parameters
    ----------
    file
        Path of a model file with a table [support], or the name of a bundled example.
    duration
        How long the machine is followed, such as "5 s".
    speed
        Speed of the crank instead of the file's, such as "193 rpm".
    drive
        Let the speed follow from the motor in [drive.motor].
    """
    from equipoise.vibration import transient

    machine, shown_in = _machine(file, units, outputs)
    with naming(file):
        found = transient.simulate(machine, duration, speed, drive)
    outputs.write(found.columns)
    outputs.give_result(found, shown_in)


def _machine(file: str, units: str, outputs: Outputs) -> tuple[Machine, Units]:
    """The machine of a file, and the units in which its vibration is printed."""
    from equipoise.present.cells import read_units
    from equipoise.schema.models import load_linkage

    machine = load_linkage(file)
    outputs.check(sources_of(machine, file))
    return machine, read_units(units)


def _answer(
    machine: Machine,
    speed: float | None,
    model: Model | None,
    drive: bool,
    units: Units,
    outputs: Outputs,
) -> None:
    """The response at one speed."""
    from equipoise.vibration.forced import respond as solve

    found = solve(machine, speed, model, drive)
    outputs.write(found.columns)
    others = None if drive or outputs.json else _others(machine, found)
    outputs.give_result(found, units, others=others)


QUICK = 40
"""Free swings of the support in a turn, up to which the exact model answers in a moment."""


def _others(machine: Machine, found: Response) -> dict[str, Response | None]:
    """The response by every model that costs little, for comparison; None where there is none."""
    from equipoise.vibration.forced import models_of
    from equipoise.vibration.forced import respond as solve
    from equipoise.vibration.response import swings_in_a_turn

    swings = swings_in_a_turn(found.modes, found.speed)
    others: dict[str, Response | None] = {}
    for model in models_of(machine):
        if model == found.model:
            others[model] = found
        elif model != "exact" or swings < QUICK:
            try:
                others[model] = solve(machine, found.speed, model)
            except EquipoiseError:
                others[model] = None
    return others


def _sweep(
    machine: Machine,
    ends: tuple[float, float],
    model: Model | None,
    drive: bool,
    speeds: int | None,
    units: Units,
    outputs: Outputs,
) -> None:
    """The response over a range of speeds."""
    from equipoise.vibration.sweep import SPEEDS, sweep_speed

    with counted("speed") as progress:
        found = sweep_speed(machine, *ends, model, drive, speeds or SPEEDS, progress)
    outputs.write(found.columns)
    outputs.give_result(found, units)
