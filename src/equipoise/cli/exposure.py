"""The command `exposure`."""

from __future__ import annotations

import os
import re
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Annotated, Any

from cyclopts import Parameter

from equipoise.cli.options import blaming, check_belonging, quantity, read_by
from equipoise.cli.outputs import Drawn
from equipoise.errors import UsageError

if TYPE_CHECKING:
    from collections.abc import Mapping

    from equipoise.exposure.daily import Exposure, Task
    from equipoise.exposure.weighting import Weighted
    from equipoise.figures import Picture
    from equipoise.schema.records import Accelerations

DURATION = Parameter(negative="", consume_multiple=False, allow_leading_hyphen=True)
VALUE = re.compile(r"(?:(?P<name>[^:]*[^:\s])\s*:\s+)?(?P<a_hv>.*\S)\s+for\s+(?P<duration>.*)")
LOOKS_LIKE_A_VALUE = re.compile(r"(?:[^:]+:\s)?\s*[+-]?[0-9.]+(?: .*)?")


@dataclass(frozen=True)
class Told:
    """What is known of one task: its total value, m/s2, and how long a day, s, if that is told."""

    name: str
    a_hv: float
    duration: float | None = None
    weighted: Weighted | None = None


@dataclass(frozen=True)
class Options:
    """What the values of files are, and what is to be made of them."""

    weighted: bool
    single_axis: bool
    bands: bool
    periodic: bool


def _acceleration(option: str, text: str) -> float:
    value = quantity(option, text, "acceleration")
    if value < 0:
        raise UsageError(f"{option}: got {text!r}; give an acceleration of 0 or more")
    return value


Acceleration = Annotated[float | None, read_by(_acceleration)]


def exposure(
    *inputs: Annotated[str, Parameter(name="INPUT", negative="")],
    duration: Annotated[list[str] | None, DURATION] = None,
    idle: Acceleration = None,
    racing: Acceleration = None,
    bands: bool = False,
    weighted: bool = False,
    single_axis: bool = False,
    periodic: bool = False,
    outputs: Drawn = Drawn(),
) -> None:
    """Hand-arm vibration: weighted acceleration, a day's exposure, and how long one may work.

    Parameters
    ----------
    inputs
        Values such as "7.4 m/s^2 for 2.5 h" or "mowing: 4.6 m/s^2 for 2 h", and paths of CSV files:
        signals (columns "time [s]" and "x [m/s^2]", y, z), spectra ("frequency [Hz]" and the
        same), tasks ("task", "acceleration [m/s^2]", "duration [h]").
    duration
        Time of exposure a day of a signal, a spectrum, or --idle and --racing, such as "2.5 h".
        One for all of them, or repeated for each.
    idle
        Total value when idling, such as "3.1 m/s^2"; put together with --racing as in ISO 22867.
    racing
        Total value when racing.
    bands
        The spectra are in one-third-octave bands.
    weighted
        The values of signals and spectra are weighted already.
    single_axis
        Estimate the total value of one or two axes as 1.7 times the largest.
    periodic
        The signals are whole periods of a steady vibration, with nothing above half the sampling
        rate, as simulated ones; any rate and duration will do then.
    """
    from equipoise.exposure.daily import equivalent

    check_belonging("--racing", racing is not None, idle=idle)
    check_belonging("--idle", idle is not None, racing=racing)
    options = Options(weighted, single_axis, bands, periodic)
    told = [each for text in inputs for each in _told(text, options)]
    if idle is not None and racing is not None:
        told.append(Told("idling and racing", equivalent(idle, racing)))
    if not told:
        raise UsageError('give a value, "7.4 m/s^2 for 2.5 h", or the path of a CSV file')
    _check_options(told, options)
    _give(_timed(told, duration or []), outputs)


def _give(told: list[Told], outputs: Drawn) -> None:
    """Draw, then print."""
    day = _day(told)
    measured = [(each.name, each.weighted) for each in told if each.weighted is not None]
    tools = [(each.name, each.a_hv) for each in told]

    def drawings() -> Mapping[str, Picture]:
        from equipoise.figures import measured as pictures

        return pictures.exposure_charts(measured, tools, day)

    def show() -> None:
        from equipoise.exposure.blocks import told_blocks
        from equipoise.present import show_blocks

        show_blocks("", told_blocks(measured, tools, day))

    outputs.give(drawings, lambda: _values(measured, tools, day), show)


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


# -- what is told of tasks -------------------------------------------------------------------------


def _told(text: str, options: Options) -> list[Told]:
    """Tasks that an argument stands for: one value, one file of accelerations, or one of tasks."""
    from equipoise.schema.records import Accelerations, read_accelerations

    match = None if os.path.lexists(text) else VALUE.fullmatch(text)
    if match is not None:
        return [_value(text, match)]
    if LOOKS_LIKE_A_VALUE.fullmatch(text) and not os.path.lexists(text):
        raise UsageError(f'got {text!r}; say for how long a day, as in "7.4 m/s^2 for 2.5 h"')
    found = read_accelerations(text)
    if isinstance(found, Accelerations):
        weighted = _weighted(text, found, options)
        return [Told(os.path.basename(text), weighted.a_hv, None, weighted)]
    return [Told(task.name, task.acceleration, task.duration) for task in found]


def _value(text: str, match: re.Match[str]) -> Told:
    a_hv = quantity(repr(text), match["a_hv"], "acceleration")
    duration = quantity(repr(text), match["duration"], "time")
    if a_hv < 0:
        raise UsageError(f"got {text!r}; give an acceleration of 0 or more")
    return Told(match["name"] or match["a_hv"], a_hv, duration)


def _weighted(path: str, found: Accelerations, options: Options) -> Weighted:
    from equipoise.exposure.spectra import weigh_signal, weigh_spectrum
    from equipoise.schema.files import printable

    single = options.single_axis and len(found.axes) < 3
    shared: Any = {"axes": found.axes, "single_axis": single, "weighted": options.weighted}
    with blaming(printable(path)):
        if found.kind == "time":
            return weigh_signal(found.at, found.values, periodic=options.periodic, **shared)
        return weigh_spectrum(found.at, found.values, bands=options.bands, **shared)


def _check_options(told: list[Told], options: Options) -> None:
    """An option that would do nothing is told, not passed over."""
    files = [each.weighted for each in told if each.weighted is not None]
    of_use = {
        "weighted": bool(files),
        "single_axis": any(file.single_axis for file in files),
        "bands": any(file.kind == "bands" for file in files),
        "periodic": any(file.kind == "signal" for file in files),
    }
    owners = {
        "weighted": "a signal or a spectrum",
        "single_axis": "a signal or a spectrum of one or two axes",
        "bands": "a spectrum",
        "periodic": "a signal",
    }
    for name, owner in owners.items():
        if getattr(options, name) and not of_use[name]:
            option = name.replace("_", "-")
            raise UsageError(f"--{option} belongs to {owner}; give one, or leave it out")


def _timed(told: list[Told], durations: list[str]) -> list[Told]:
    """With the times of exposure that are given by an option."""
    times = [_positive(text) for text in durations]
    open_ended = [each for each in told if each.duration is None]
    if times and not open_ended:
        raise UsageError(
            "--duration belongs to a signal, a spectrum, or --idle and --racing; leave it out"
        )
    if len(times) == 1:
        times *= len(open_ended)
    if times and len(times) != len(open_ended):
        raise UsageError(
            f"--duration: given {len(times)} times, but inputs without a time of their own are "
            f"{len(open_ended)}; give one for all, or one for each"
        )
    rest = iter(times)
    return [
        each if each.duration is not None else replace(each, duration=next(rest, None))
        for each in told
    ]


def _positive(text: str) -> float:
    value = quantity("--duration", text, "time")
    if value <= 0:
        raise UsageError(f"--duration: got {text!r}; give more than 0 and at most 24 h a day")
    return value


def _day(told: list[Told]) -> Exposure | None:
    """The exposure of a day; None if no time is told."""
    from equipoise.exposure.daily import daily_exposure

    known = [each for each in told if each.duration is not None]
    if not known:
        return None
    for each in told:
        if each.duration is None:
            raise UsageError(
                f"{each.name}: the time of exposure is missing; give it by --duration, as for the "
                "other tasks"
            )
    return daily_exposure(_task(each) for each in known)


def _task(each: Told) -> Task:
    from equipoise.exposure.daily import Task

    with blaming(each.name):
        return Task(each.name, each.a_hv, each.duration or 0.0)
