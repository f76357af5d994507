"""Commands of a linkage: `analyze`; `modes`, `respond`, `simulate` on its support; `plant`."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from cyclopts import App, Parameter

from equipoise.cli.models import LinkageFile, PlantingFile, SupportFile, at_speed
from equipoise.cli.options import (
    SIGNED,
    Angle,
    BelongsTo,
    CrankZero,
    ModelOption,
    NameList,
    NewFile,
    OtherFile,
    Out,
    Speed,
    WorkerCount,
    blaming_by_place,
    count,
    crank_angles,
    ends_of_range,
    error_in_option,
    place_in,
    quantity,
    read_by,
    size,
    some_of,
    tolerance,
    wants,
)
from equipoise.cli.outputs import (
    Length,
    Outputs,
    PlottedOutput,
    Printed,
    check_new,
    write_model,
    write_text,
)
from equipoise.cli.progress import counted, generations
from equipoise.cli.runner import CommandResult, command
from equipoise.errors import EquipoiseError, UsageError, at_place
from equipoise.i18n import Note

if TYPE_CHECKING:
    from equipoise.mechanism.parts.machine import Machine
    from equipoise.mechanism.parts.motors import Motor
    from equipoise.results.result import Result
    from equipoise.vibration.response import Response

planting = App(name="plant")
MOTOR = "no_load_speed = 300 rpm, stall_torque = 2 N m"
NUMBER = r"[+-]?([0-9]+\.?[0-9]*|\.[0-9]+)(e[+-]?[0-9]+)?"
"""What stands for a plain number where keys have values without a unit."""
MOST_ORDERS, MOST = 100, 999_999_999
QUICK = 40
"""Free swings of the support in a turn, up to which the exact model answers in a moment."""


@command(Length, Printed)
def analyze(
    machine: LinkageFile,
    /,
    *,
    angles: Annotated[Any, read_by(crank_angles), Parameter(show_default=True)] = 360,
    speed: Speed = None,
    acceleration: Annotated[float | None, size("angular acceleration")] = None,
    about: Annotated[str | None, SIGNED, wants("POINT")] = None,
    split: Annotated[bool, BelongsTo("--json")] = False,
    csv: NewFile = None,
    orders: Annotated[int | None, count(1, MOST_ORDERS)] = None,
    crank_zero: Annotated[Angle, BelongsTo("--orders")] = None,
    output: NameList = None,
    dwell: Annotated[Any, read_by(tolerance, '"0.5 mm"')] = None,
) -> CommandResult:
    """Motion, shaking force and moment, drive torque and every joint force over a cycle.

    Parameters
    ----------
    angles
        Number of crank angles per turn, or a list of angles: "0 deg, 45 deg, 90 deg".
    acceleration
        Acceleration of the crank instead of the file's.
    about
        Reference point of moments: a point of the frame, or "10 mm, 20 mm".
    split
        With --json: add the contributions to every force by cause and by link.
    csv
        Write every signal against crank angle to this file.
    orders
        Print the harmonics of forces, moment and torque up to this order instead.
    crank_zero
        With --orders: direction from which crank angles count; else the x axis.
    output
        Print this output over crank angle instead, by its name in --json, such as "points.P.vx" or
        "joints.A".  May be repeated.
    dwell
        Print the dwells in which sliders and points move by at most "0.5 mm", or links by "0.5
        deg".
    """
    from equipoise.results.analysis import analyze as analyzed
    from equipoise.results.analysis import order_values
    from equipoise.schema.files import to_csv

    zero = crank_zero or 0.0
    place = None if about is None else place_in(machine, about)
    analysis = analyzed(machine, angles, speed, acceleration, place)
    further = {} if orders is None else {"by_order": order_values(analysis, orders, zero)}
    dwells = None if dwell is None else analysis.dwells(*dwell)
    further |= (
        {} if dwells is None else {"dwells": {name: vars(item) for name, item in dwells.items()}}
    )
    with error_in_option("--output"):
        chosen = [item.name for item in analysis.outputs.chosen(output or ())]
    answer = CommandResult.of(analysis, orders=orders, zero=zero, outputs=chosen, dwells=dwells)
    return replace(
        answer,
        values=lambda: analysis.to_dict(split, chosen) | further,
        headline=None if orders is not None or chosen or dwells is not None else answer.headline,
        save=lambda: () if csv is None else write_text(csv, to_csv(analysis, chosen)),
    )


# -- on the support --------------------------------------------------------------------------------


@command(PlottedOutput)
def modes(machine: SupportFile, /, *, model: ModelOption | None = None) -> Result:
    """Natural frequencies, damping and shapes of a machine on its support.

    Parameters
    ----------
    model
        moment, the default: mass of the linkages distributed, mean over one turn; linear or torque:
        at the drive's pivot.
    """
    from equipoise.vibration import free

    return free.modes(machine, model)


def _speeds(option: str, text: str) -> list[float]:
    """One speed, or the two ends of a range; a unit may stand after the second only."""

    def wrong(right: Note) -> UsageError:
        return UsageError(at_place(option, Note("got {text!r}; {right}", text=text, right=right)))

    parts = ends_of_range(text)
    if not parts:
        raise wrong(Note('give a speed, "193 rpm", or a range: "20 rpm : 400 rpm"'))
    ends = [quantity(option, part, "angular speed") for part in parts[::-1]][::-1]
    if ends == [0.0]:
        raise wrong(Note("a crank that stands still shakes nothing; give another speed"))
    if len(ends) == 2 and (ends[0] * ends[1] <= 0 or abs(ends[0]) >= abs(ends[1])):
        raise wrong(
            Note("give a range of speeds of the same sign that are not 0, the slower one first")
        )
    return ends


@command(Length, Outputs, long=True)
def respond(
    machine: SupportFile,
    /,
    *,
    model: ModelOption | None = None,
    speed: Annotated[Any, read_by(_speeds, '"193 rpm"')] = None,
    speeds: Annotated[int | None, count(2, 20_000)] = None,
    drive: bool = False,
) -> CommandResult:
    """Vibration of a machine on its support, at one speed or over a range of speeds.

    Parameters
    ----------
    model
        moment, the default (whole force and moment on the frame), exact (all bodies, large motion);
        simplified: linear (shaking force at the drive's pivot), torque (with the drive torque),
        coupled (with the torque that the motion takes).
    speed
        Speed of the crank instead of the file's, or a range: "20 rpm : 400 rpm".
    speeds
        With a range: number of speeds (default: 200); more are added near resonances, where curves
        bend, and at the speed of the file.  Without --speed the range is speeds in [drive].
    drive
        Compute the crank speed from the motor in [drive.motor], with the exact model.
    """
    from equipoise.vibration import forced

    ends: list[float] = speed or []
    if speeds is not None and speed is None:
        ends = [*(machine.drive.range or ())]
    if speeds is not None and len(ends) != 2:
        raise UsageError(
            Note(
                '--speeds belongs to a range, --speed "20 rpm : 400 rpm"; give both, or '
                "speeds in [drive] of the file"
            )
        )
    if len(ends) == 2:
        with counted("speed") as progress:
            count = speeds or forced.SPEEDS
            over_speed = forced.sweep_speed(
                machine, ends[0], ends[1], model, drive, count, progress
            )
        return CommandResult.of(over_speed)
    result = forced.respond(machine, ends[0] if ends else None, model, drive)
    return replace(
        CommandResult.of(result),
        blocks=lambda: result.blocks(others=None if drive else _others(machine, result)),
    )


def _others(machine: Machine, response: Response) -> dict[str, Response | None]:
    """The response by every model that costs little, for comparison; None where there is none."""
    from equipoise.vibration.forced import models_of
    from equipoise.vibration.forced import respond as solve
    from equipoise.vibration.response import swings_in_a_turn

    swings = swings_in_a_turn(response.modes, response.speed)
    others: dict[str, Response | None] = {}
    for model in models_of(machine):
        if model == response.model:
            others[model] = response
        elif model != "exact" or swings < QUICK:
            try:
                others[model] = solve(machine, response.speed, model)
            except EquipoiseError:
                others[model] = None
    return others


@command(Outputs, long=True)
def simulate(
    machine: SupportFile,
    duration: Annotated[float, size("time", "give a time of more than 0", "DURATION")],
    /,
    *,
    speed: Speed = None,
    drive: bool = False,
) -> Result:
    """Simulate the vibration of the support from rest, with the exact model.

    Parameters
    ----------
    duration
        Simulated time, such as "5 s".
    drive
        Compute the crank speed from the motor in [drive.motor].
    """
    from equipoise.vibration import free

    return free.simulate(machine, duration, speed, drive)


def _share(_: str, text: str) -> float:
    from equipoise.running.flywheel import share_of_mean

    return share_of_mean(text)


def _motor(option: str, text: str) -> Motor:
    """A motor by its keys in a file, such as ``no_load_speed = 300 rpm, stall_torque = 2 N m``;
    a key of a table in its table has a dot: ``dc.voltage = 24 V``.
    """
    from equipoise.mechanism.parts.motors import Motor
    from equipoise.schema.models import AdjacentFiles
    from equipoise.schema.reading import Context, read_table

    content: dict[str, Any] = {}
    for part in text.split(","):
        path, sign, value = (item.strip() for item in part.partition("="))
        *tables, name = path.split(".")
        if len(tables) > 1 or not all((sign, name, value)):
            wrong = Note("got {text!r}; give such as {example}", text=text, example=MOTOR)
            raise UsageError(at_place(option, wrong))
        table: Any = content
        for above in tables:
            table = table.setdefault(above, {})
        if not isinstance(table, dict) or name in table:
            wrong = Note("got {text!r}, with {word} twice; give it once", text=text, word=path)
            raise UsageError(at_place(option, wrong))
        table[name] = _toml_value(value)
    with error_in_option(option):
        motor: Motor = read_table(Motor, content, Context(AdjacentFiles(".").read))
        return motor


def _toml_value(text: str) -> str | int | float:
    """What a text is in a file, where only numbers stand without quotes."""
    if re.fullmatch(r"[+-]?[0-9]{1,300}", text):
        return int(text)
    return float(text) if re.fullmatch(NUMBER, text) else text


@command(Length, Outputs)
def run(
    machine: LinkageFile,
    duration: Annotated[
        float | None, size("time", "give a time of more than 0", "DURATION")
    ] = None,
    /,
    *,
    turns: Annotated[float | None, some_of(10_000)] = None,
    speed: Annotated[float | None, size("angular speed")] = None,
    angle: Angle = None,
    off: Annotated[float | None, size("time", "give a time of more than 0")] = None,
    off_turns: Annotated[float | None, some_of(10_000)] = None,
    fluctuation: Annotated[float | None, read_by(_share, '"2 %"')] = None,
    support: Annotated[bool | None, Parameter(negative="--no-support")] = None,
    motor: Annotated[Any, read_by(_motor, f'"{MOTOR}"')] = None,
) -> Result:
    """Simulate a machine under its motors, weight, springs and loads.

    Of several drives, those with a motor and those that are free follow from torques.  Defaults
    are those of the table [run] of the file.

    Parameters
    ----------
    duration
        Time after which the run ends, such as "2 s"; without it and --turns, it ends when steady or
        at a standstill.
    turns
        Turns of the crank after which the run ends, such as 0.25 for an angle of 90 deg from the
        start.
    speed
        Speed of the crank at the start: 0 with a motor, else the file's, if not given.
    angle
        Crank angle at the start, 0 if not given.
    off
        Time at which the motor is switched off.
    off_turns
        Turns of the crank after which the motor is switched off.
    fluctuation
        Also size a flywheel for this speed fluctuation (highest minus lowest, over the mean), such
        as "2 %".
    support
        Also follow the support, from rest in the drawn position, or keep the frame fixed.
    motor
        Motor on the crank instead of that of the file, by the keys of [drive.motor], a comma
        between them.
    """
    from equipoise.running.run import run as follow

    if motor is not None:
        with blaming_by_place({("drive", "motor"): "--motor"}):
            machine = machine.with_drive(motor=motor)
    with counted("turn") as progress:
        return follow(
            machine,
            duration,
            turns=turns,
            speed=speed,
            angle=angle,
            off=off,
            off_turns=off_turns,
            fluctuation=fluctuation,
            support=support,
            progress=progress,
        )


# -- planting --------------------------------------------------------------------------------------


@planting.default
@command(Outputs)
def plant(
    machine: PlantingFile,
    /,
    *,
    speed: Speed = None,
    crank_zero: CrankZero = None,
    angles: Annotated[int | None, count(0, MOST), BelongsTo("--csv")] = None,
) -> CommandResult:
    """Path of a planting finger relative to machine and ground, and its figures.

    Parameters
    ----------
    angles
        With --csv: number of crank angles per turn.  Default: 360.
    """
    from equipoise.planting.summary import plant as read_off
    from equipoise.planting.summary import table

    figures = read_off(at_speed(machine, speed))
    return replace(
        CommandResult.of(figures, zero=crank_zero or 0.0),
        columns=lambda: table(figures, 360 if angles is None else angles),
    )


@planting.command
@command(Outputs, long=True)
def fit(
    machine: PlantingFile,
    targets: Annotated[str, Parameter(name="TARGETS"), OtherFile()],
    /,
    *,
    out: Annotated[Out, OtherFile("-fit.toml")] = None,
    seed: int | None = None,
    speed: Speed = None,
    workers: WorkerCount = None,
) -> CommandResult:
    """Search for a geometry that meets targets and limits, and write it as a new model file.

    Parameters
    ----------
    targets
        TOML file with the goals and the permitted changes.
    out
        New model file.  Default: FILE-fit.toml in the current folder.
    seed
        Seed of the random numbers, instead of that of the target file.
    workers
        Number of processes that evaluate designs.  Default: the number of processors.
    """
    from equipoise.planting.search import figure_names, fit_planting
    from equipoise.planting.summary import table
    from equipoise.schema.files import printable
    from equipoise.schema.targets import read_targets

    if seed is not None and seed < 0:
        raise UsageError(at_place("--seed", Note("got {seed}; give 0 or more", seed=seed)))
    machine = at_speed(machine, speed)
    new = out or ""  # FILE-fit.toml where none is given
    check_new(machine, new)
    given = read_targets(targets, figure_names(machine))
    with generations() as progress, error_in_option(printable(targets)):
        fitted = fit_planting(
            machine,
            given.goals,
            given.vary,
            given.search.crank,
            seed=given.search.seed if seed is None else seed,
            generations=given.search.generations,
            population=given.search.population,
            progress=progress,
            workers=workers,
        )
    origin = Note(
        "Geometry found by equipoise plant fit {file}, seed {seed}.",
        file=Path(targets).name,
        seed=fitted.seed,
    )
    return replace(
        CommandResult.of(fitted),
        columns=lambda: table(fitted.after),
        pictures=fitted.after.charts,
        save=lambda: write_model(fitted.machine, new, Note(", fitted"), origin.localized),
    )
