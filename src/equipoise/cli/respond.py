"""The command `respond`."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Annotated

from equipoise.cli.app import FILE, SIGNED, app
from equipoise.cli.options import Model, ends_of_range, naming, quantity, whole
from equipoise.cli.results import Kind, Wanted, vibration
from equipoise.errors import UsageError

if TYPE_CHECKING:
    from equipoise.mechanism.model import Machine
    from equipoise.terminal.units import Units
    from equipoise.vibration.response import Response


@app.command
def respond(
    file: Annotated[str, FILE],
    /,
    *,
    model: Model | None = None,
    speed: Annotated[str | None, SIGNED] = None,
    speeds: Annotated[str | None, SIGNED] = None,
    drive: bool = False,
    transient: Annotated[str | None, SIGNED] = None,
    units: str = "",
    json: bool = False,
    csv: str | None = None,
    plot: str | None = None,
    format: Kind | None = None,
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
    transient
        Follow the machine from rest for so long, such as "5 s", by the model exact.
    units
        Units of the printed tables where they are not to be mm, mm/s, m/s^2 and rpm: "um, rad/s".
    json
        Print one JSON object in SI units, and nothing else.
    csv
        Write every signal against time, or every figure against speed, to this file.
    plot
        Draw the response into this folder.
    format
        With --plot: kind of the pictures, svg if not given.
    """
    from equipoise.schema.models import load_linkage
    from equipoise.terminal.units import OF_VIBRATION, Units

    machine = load_linkage(file)
    wanted = Wanted(json, csv, plot, format)
    wanted.check(file, machine)
    shown_in = Units.read(units, OF_VIBRATION)
    ends = [] if speed is None else _speeds(speed)
    if speeds is not None and len(ends) != 2:
        raise UsageError('--speeds belongs to a range, --speed "20 rpm : 400 rpm"; give both')
    if transient is not None:
        duration = _duration(transient, ends, model)
        with naming(file):
            _follow(machine, duration, ends[0] if ends else None, drive, shown_in, wanted)
    elif len(ends) == 2:
        count = None if speeds is None else whole("--speeds", speeds, 2, 20_000)
        with naming(file):
            _sweep(machine, (ends[0], ends[1]), model, drive, count, shown_in, wanted)
    else:
        with naming(file):
            _answer(machine, ends[0] if ends else None, model, drive, shown_in, wanted)


def _speeds(text: str) -> list[float]:
    """One speed, or the two ends of a range; a unit may stand after the second only."""
    parts = ends_of_range(text)
    if not parts:
        raise UsageError(
            f'--speed: got {text!r}; give a speed, "193 rpm", or a range: "20 rpm : 400 rpm"'
        )
    ends = [quantity("--speed", part, "angular speed") for part in parts[::-1]][::-1]
    if ends == [0.0]:
        raise UsageError(
            f"--speed: got {text!r}; a crank that stands still shakes nothing; give another speed"
        )
    if len(ends) == 2 and (ends[0] * ends[1] <= 0 or abs(ends[0]) >= abs(ends[1])):
        raise UsageError(
            f"--speed: got {text!r}; give a range of speeds of the same sign that are not 0, the "
            "slower one first"
        )
    return ends


def _duration(text: str, ends: Sequence[float], model: Model | None) -> float:
    """How long to follow a machine from rest, s."""
    if len(ends) == 2:
        raise UsageError("--transient follows the machine at one speed; give one, no range")
    if model not in {None, "exact"}:
        raise UsageError(f"--transient is by the model exact; leave out --model {model}")
    duration = quantity("--transient", text, "time")
    if duration <= 0:
        raise UsageError(f"--transient: got {text!r}; give a time of more than 0")
    return duration


def _answer(
    machine: Machine,
    speed: float | None,
    model: Model | None,
    drive: bool,
    units: Units,
    wanted: Wanted,
) -> None:
    """The response at one speed."""
    from equipoise.vibration.forced import respond as solve

    found = solve(machine, speed, model, drive)

    def show() -> None:
        from equipoise.terminal.vibration import print_response

        print_response(found, {} if drive else _others(machine, found), units)

    wanted.give(found.columns, lambda: vibration().response_drawings(found), found.to_dict, show)


QUICK = 40
"""Free swings of the support in a turn, up to which the exact model answers in a moment."""


def _others(machine: Machine, found: Response) -> dict[str, Response | None]:
    """The response by every model that costs little, for comparison; None where there is none."""
    from equipoise.errors import EquipoiseError
    from equipoise.vibration.forced import models_of
    from equipoise.vibration.forced import respond as solve
    from equipoise.vibration.modes import swings_in_a_turn

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
    wanted: Wanted,
) -> None:
    """The response over a range of speeds."""
    from equipoise.cli.progress import counted
    from equipoise.vibration.sweep import SPEEDS, sweep_speed

    count = SPEEDS if speeds is None else speeds
    with counted("speed") as progress:
        found = sweep_speed(machine, *ends, model, drive, count, progress)

    def show() -> None:
        from equipoise.terminal.sweep import print_sweep

        print_sweep(found, units)

    wanted.give(found.columns, lambda: vibration().sweep_drawings(found), found.to_dict, show)


def _follow(
    machine: Machine,
    duration: float,
    speed: float | None,
    drive: bool,
    units: Units,
    wanted: Wanted,
) -> None:
    """The machine from rest."""
    from equipoise.vibration.transient import from_rest

    found = from_rest(machine, duration, speed, drive)

    def show() -> None:
        from equipoise.terminal.transient import print_transient

        print_transient(found, units)

    wanted.give(found.columns, lambda: vibration().transient_drawings(found), found.to_dict, show)
