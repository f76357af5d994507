"""The commands `decay` and `exposure`: what was measured of a machine, and at its handles."""

from __future__ import annotations

import os
import re
from dataclasses import replace
from typing import TYPE_CHECKING, Annotated, Any

from cyclopts import Parameter

from equipoise.cli.options import (
    EXAMPLES,
    SIGNED,
    NameList,
    TextList,
    check_belonging,
    error_in_option,
    quantity,
    read_by,
    size,
    time_a_day,
    wants,
)
from equipoise.cli.outputs import PlottedOutput
from equipoise.cli.runner import CommandResult, command
from equipoise.dataclass import dataclass
from equipoise.errors import UsageError, at_place
from equipoise.i18n import Note

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from equipoise.exposure.daily import Exposure
    from equipoise.exposure.weighting import Weighted
    from equipoise.schema.records import Accelerations

# -- decay -----------------------------------------------------------------------------------------

Arm = Annotated[float | None, size("length", "give more than 0")]


def _stiffness(option: str, text: str) -> tuple[float, bool, str]:
    """A stiffness, N/m or N m/rad, whether it is torsional, and how it was given."""
    from equipoise.quantities import KINDS, plain_unit

    unit = plain_unit(text.partition(" ")[2].strip())
    torsional = unit in KINDS["torsional stiffness"].units
    value = quantity(option, text, "torsional stiffness" if torsional else "stiffness")
    if value <= 0:
        raise UsageError(at_place(option, Note("got {text!r}; give more than 0", text=text)))
    return value, torsional, text


@command(PlottedOutput)
def decay(
    csv: Annotated[str, Parameter(name="CSV")],
    /,
    *,
    stiffness: Annotated[Any, read_by(_stiffness, '"12 N/mm"')] = None,
    arm: Arm = None,
    spring_arm: Arm = None,
    confidence: Annotated[float, SIGNED] = 0.95,
) -> CommandResult:
    """Frequency, inertia, viscous damping and Coulomb friction from a recorded free decay.

    Parameters
    ----------
    csv
        Path of a record: columns "time [s]" and "displacement [mm]" or "angle [deg]".
    stiffness
        Of the spring, or of a pivot, "500 N m/rad"; adds inertia and forces.
    arm
        Distance from the pivot at which the displacement was measured; converts it to an angle.
    spring_arm
        Distance from the pivot at which the spring acts; its stiffness is then in N/m.
    confidence
        Of the intervals.
    """
    from equipoise.figures import measured as pictures
    from equipoise.measured.decay import identify_decay
    from equipoise.schema.files import printable
    from equipoise.schema.records import read_record

    check_belonging("--stiffness", stiffness is not None, spring_arm=spring_arm)
    if not 0 < confidence < 1:
        raise UsageError(
            at_place(
                "--confidence",
                Note(
                    "got {confidence:g}; give 0.95, or another between 0 and 1",
                    confidence=confidence,
                ),
            )
        )
    record = read_record(csv)
    if arm is not None and record.kind == "angle":
        raise UsageError(
            Note("--arm makes an angle of a length, but the record has angles; leave it out")
        )
    value = None
    if stiffness is not None:
        value, torsional, text = stiffness
        _check_stiffness(text, torsional, record.kind == "angle" or arm is not None, spring_arm)
    with error_in_option(printable(csv)):
        result = identify_decay(
            record, value, arm=arm, spring_arm=spring_arm, confidence=confidence
        )
    title = printable(os.path.basename(csv))
    return CommandResult(
        result.blocks,
        result.to_dict,
        title=title,
        pictures=lambda: pictures.decay_charts(result, title),
    )


def _check_stiffness(text: str, torsional: bool, angles: bool, spring_arm: float | None) -> None:
    """The stiffness has to suit the record."""
    if torsional and spring_arm is not None:
        raise UsageError(
            Note(
                "--spring-arm belongs to a stiffness in N/m, but --stiffness is "
                "{text!r}; leave one of them out, or change it",
                text=text,
            )
        )
    if torsional and not angles:
        raise UsageError(
            at_place(
                "--stiffness",
                Note(
                    "got {text!r}, but the record has lengths; give a stiffness in N/m, or "
                    "by --arm how far from the pivot they were read",
                    text=text,
                ),
            )
        )
    if not torsional and angles and spring_arm is None:
        raise UsageError(
            at_place(
                "--stiffness",
                Note(
                    "got {text!r}, but the record has angles; give a stiffness in N m/rad, "
                    "or by --spring-arm how far from the pivot the spring acts",
                    text=text,
                ),
            )
        )
    if spring_arm is not None and not angles:
        raise UsageError(
            Note(
                "--spring-arm belongs to a record of angles; give by --arm how far from "
                "the pivot the lengths were read, or leave it out"
            )
        )


# -- exposure --------------------------------------------------------------------------------------

VALUE = re.compile(r"(?:(?P<name>[^:]*[^:\s])\s*:\s+)?(?P<a_hv>.*\S)\s+for\s+(?P<duration>.*)")
LOOKS_LIKE_A_VALUE = re.compile(r"(?:[^:]+:\s)?\s*[+-]?[0-9.]+(?: .*)?")
OWNERS = {
    "weighted": Note("a signal or a spectrum"),
    "single_axis": Note("a signal or a spectrum of one or two axes"),
    "bands": Note("a spectrum"),
    "periodic": Note("a signal"),
}
"""What options are of use for."""


@dataclass(frozen=True)
class TaskInput:
    """One task: its vibration total value, m/s2, and its time a day, s, if that is given."""

    name: str
    a_hv: float
    duration: float | None = None
    weighted: Weighted | None = None


ACCELERATION = f'"{EXAMPLES["acceleration"]}"'


def _acceleration(option: str, text: str) -> float:
    value = quantity(option, text, "acceleration")
    if value < 0:
        raise UsageError(
            at_place(option, Note("got {text!r}; give an acceleration of 0 or more", text=text))
        )
    return value


Acceleration = Annotated[float | None, read_by(_acceleration, ACCELERATION)]


@command(PlottedOutput)
def exposure(
    *inputs: Annotated[str, Parameter(name="INPUT")],
    duration: Annotated[TextList, SIGNED, wants('"2.5 h"')] = None,
    idle: Acceleration = None,
    racing: Acceleration = None,
    bands: bool = False,
    weighted: bool = False,
    single_axis: bool = False,
    periodic: bool = False,
    gauge: NameList = None,
) -> CommandResult:
    """Hand-arm vibration: weighted acceleration, daily exposure and permitted working time.

    Parameters
    ----------
    inputs
        Values such as "7.4 m/s^2 for 2.5 h" or "mowing: 4.6 m/s^2 for 2 h", and paths of CSV files:
        signals (columns "time [s]" and "x [m/s^2]", y, z), spectra ("frequency [Hz]" and the
        same), tasks ("task", "acceleration [m/s^2]", "duration [h]"), responses of gauges.
    duration
        Daily exposure time of signals, spectra, or --idle and --racing: one for all, or repeated
        for each.
    idle
        Total value when idling; combined with --racing as in ISO 22867.
    racing
        Total value when racing.
    bands
        The spectra are in one-third-octave bands.
    weighted
        The values of signals and spectra are weighted already.
    single_axis
        Estimate the total value of one or two axes as 1.7 times the largest.
    periodic
        The signals are whole periods of a steady vibration without content above half the sampling
        rate, such as simulated ones; any rate and duration is accepted.
    gauge
        Of what "equipoise respond --csv" writes: the gauge of the hand, if there are several.
        Repeated for up to three of one place, along x, y and z.
    """
    from equipoise.exposure.daily import equivalent

    check_belonging("--racing", racing is not None, idle=idle)
    check_belonging("--idle", idle is not None, racing=racing)
    options = {
        "weighted": weighted,
        "single_axis": single_axis,
        "bands": bands,
        "periodic": periodic,
    }
    values = [each for text in inputs for each in _parse_tasks(text, options, gauge or ())]
    if idle is not None and racing is not None:
        values.append(TaskInput("idling and racing", equivalent(idle, racing)))
    if not values:
        raise UsageError(Note('give a value, "7.4 m/s^2 for 2.5 h", or the path of a CSV file'))
    _check_options(values, options)
    if gauge and not any(each.weighted for each in values):
        raise UsageError(Note("--gauge belongs to a response of gauges; give one, or leave it out"))
    return _answer(_timed(values, duration or []))


def _answer(tasks: list[TaskInput]) -> CommandResult:
    from equipoise.exposure.blocks import weighting_blocks
    from equipoise.figures import measured as pictures

    day = _day(tasks)
    measured = [(each.name, each.weighted) for each in tasks if each.weighted is not None]
    tools = [(each.name, each.a_hv) for each in tasks]
    return CommandResult(
        lambda: weighting_blocks(measured, tools, day),
        lambda: _values(measured, tools, day),
        title="",
        pictures=lambda: pictures.exposure_charts(measured, tools, day),
    )


def _values(
    measured: list[tuple[str, Weighted]], tools: list[tuple[str, float]], day: Exposure | None
) -> dict[str, Any]:
    """Everything as plain data; without times of exposure there is no daily exposure."""
    from equipoise.exposure.daily import WorkingTimes

    files = [{"name": name, **weighted.to_dict()} for name, weighted in measured]
    if day is not None:
        return {"measured": files, **day.to_dict()}
    tasks = [
        {"name": name, "a_hv": a_hv, "duration": None, **WorkingTimes(a_hv).to_dict()}
        for name, a_hv in tools
    ]
    a_hv = tasks[0]["a_hv"] if len(tasks) == 1 else None
    return {"measured": files, "tasks": tasks, "a_hv": a_hv, "a8": None}


def _parse_tasks(text: str, options: Mapping[str, bool], gauges: Sequence[str]) -> list[TaskInput]:
    """Tasks that an argument stands for: one value, one file of accelerations, or one of tasks."""
    from equipoise.schema.records import Accelerations, read_accelerations

    if not os.path.lexists(text):
        if match := VALUE.fullmatch(text):
            a_hv = quantity(repr(text), match["a_hv"], "acceleration")
            duration = quantity(repr(text), match["duration"], "time")
            if a_hv < 0:
                raise UsageError(Note("got {text!r}; give an acceleration of 0 or more", text=text))
            return [TaskInput(match["name"] or match["a_hv"], a_hv, duration)]
        if LOOKS_LIKE_A_VALUE.fullmatch(text):
            raise UsageError(
                Note('got {text!r}; say for how long a day, as in "7.4 m/s^2 for 2.5 h"', text=text)
            )
    accelerations = read_accelerations(text, gauges)
    if isinstance(accelerations, Accelerations):
        weighted = _weighted(text, accelerations, options)
        return [TaskInput(os.path.basename(text), weighted.a_hv, None, weighted)]
    return [TaskInput(task.name, task.acceleration, task.duration) for task in accelerations]


def _weighted(path: str, record: Accelerations, options: Mapping[str, bool]) -> Weighted:
    from equipoise.exposure.spectra import weigh_signal, weigh_spectrum
    from equipoise.schema.files import printable

    single = options["single_axis"] and len(record.axes) < 3
    shared: Any = {"axes": record.axes, "single_axis": single, "weighted": options["weighted"]}
    with error_in_option(printable(path)):
        if record.kind == "time":
            periodic = record.periodic or options["periodic"]
            return weigh_signal(record.at, record.values, periodic=periodic, **shared)
        return weigh_spectrum(record.at, record.values, bands=options["bands"], **shared)


def _check_options(tasks: list[TaskInput], options: Mapping[str, bool]) -> None:
    """Raise if an option is given that would have no effect."""
    files = [each.weighted for each in tasks if each.weighted is not None]
    of_use = {
        "weighted": bool(files),
        "single_axis": any(file.single_axis for file in files),
        "bands": any(file.kind == "bands" for file in files),
        "periodic": any(file.kind == "signal" for file in files),
    }
    for name, owner in OWNERS.items():
        if options[name] and not of_use[name]:
            option = name.replace("_", "-")
            raise UsageError(
                Note(
                    "--{option} belongs to {owner}; give one, or leave it out",
                    option=option,
                    owner=owner,
                )
            )


def _timed(tasks: list[TaskInput], durations: list[str]) -> list[TaskInput]:
    """With the times of exposure that are given by an option."""
    times = [time_a_day("--duration", text) for text in durations]
    open_ended = [each for each in tasks if each.duration is None]
    if times and not open_ended:
        raise UsageError(
            Note("--duration belongs to a signal, a spectrum, or --idle and --racing; leave it out")
        )
    if len(times) == 1:
        times *= len(open_ended)
    if times and len(times) != len(open_ended):
        raise UsageError(
            at_place(
                "--duration",
                Note(
                    "given {count} times, but inputs without a time of their own are "
                    "{count_2}; give one for all, or one for each",
                    count=len(times),
                    count_2=len(open_ended),
                ),
            )
        )
    rest = iter(times)
    return [
        each if each.duration is not None else replace(each, duration=next(rest, None))
        for each in tasks
    ]


def _day(inputs: list[TaskInput]) -> Exposure | None:
    """The exposure of a day; None if no time is given."""
    from equipoise.exposure.daily import Task, daily_exposure

    known = [each for each in inputs if each.duration is not None]
    if not known:
        return None
    for each in inputs:
        if each.duration is None:
            raise UsageError(
                at_place(
                    each.name,
                    Note(
                        "the time of exposure is missing; give it by --duration, as for the "
                        "other tasks"
                    ),
                )
            )
    tasks = []
    for each in known:
        with error_in_option(each.name):
            tasks.append(Task(each.name, each.a_hv, each.duration or 0.0))
    return daily_exposure(tasks)
