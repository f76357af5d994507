"""A machine that is set in motion by its motors, its weight, springs and loads."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from math import ceil, inf, pi

import numpy as np

from equipoise.errors import UsageError, at_place
from equipoise.i18n import Note
from equipoise.mechanism.parts.machine import Machine
from equipoise.mechanism.parts.run_plans import MOST_TURNS, RunPlan
from equipoise.quantities import Dimension, in_si
from equipoise.results.result import ProgressCallback
from equipoise.running.collocation import ELECTRIC
from equipoise.running.drivers import Driver
from equipoise.running.drives_equation import BRAKE, DrivesEquation
from equipoise.running.drives_integration import DrivesIntegration, DrivesTrack, joined
from equipoise.running.drives_linkage import DriveAngles, drives_at
from equipoise.running.equation import CrankEquation
from equipoise.running.flywheel import Flywheel, share_of_mean, size_flywheel
from equipoise.running.integration import Integration, Limits
from equipoise.running.run_contacts import Passage
from equipoise.running.run_results import (
    DRIVE,
    FREE,
    GIVEN,
    MOTOR,
    DriveCourse,
    DrivesRun,
    Electric,
    Run,
    losses_apart,
)
from equipoise.running.support_equation import SupportedEquation

TURNS = 300
"""Turns after which a run ends where nothing else ends it."""
TURNS_OF_DRIVES = 30
"""The same of several drives, each turn of which takes longer to follow; two motors of their own
speeds never come to a steady state."""


def _check_turns(turns: float | None) -> None:
    if turns is not None and turns > MOST_TURNS:
        raise UsageError(
            Note(
                "got {turns!r} for turns; give at most {most_turns}",
                turns=turns,
                most_turns=MOST_TURNS,
            )
        )


def _positive(name: str, value: float | str | None) -> float:
    """The size of a limit of a run, in SI units; endless where none is given."""
    dimensions: dict[str, Dimension] = {"duration": "time", "off": "time"}
    number = in_si(value, dimensions[name], name) if name in dimensions else value
    if number is not None and not 0 < float(number) < inf:
        raise UsageError(
            Note(
                "got {value!r} for {name}; give a finite number of more than 0",
                value=value,
                name=name,
            )
        )
    return inf if number is None else float(number)


def run(
    machine: Machine,
    duration: float | str | None = None,
    *,
    turns: float | None = None,
    speed: float | str | None = None,
    angle: float | str | None = None,
    off: float | str | None = None,
    off_turns: float | None = None,
    fluctuation: float | str | None = None,
    support: bool | None = None,
    progress: ProgressCallback | None = None,
) -> Run | DrivesRun:
    """Let a machine run: its crank follows from motor, weight, springs and loads.

    Of a machine with several drives, those with a motor, and those that are free, follow from
    torques, and the others have the motion that is given; the result is a `DrivesRun`, and so it is
    of a machine on its support.

    The motor's curve holds as it is, whatever its `mean_speed`.  What is not given is that of the
    machine's `run`, where it has one; `duration` and `turns` replace its end, `off` and `off_turns`
    its switching off, each pair together.

    Parameters
    ----------
    duration : s, or a text such as ``"2 s"``; where neither it nor `turns` is given the run ends in
        a steady state, in a standstill, or after 300 turns; of several drives after 30 turns, or
        the time that these take at the drive's speed.
    turns : of the crank, after which the run ends.
    speed : of the crank at the start, rad/s, or a text such as ``"300 rpm"``; 0 with a motor, that
        of the drive without one, where not given.
    angle : crank angle at the start, rad, or a text; 0 where not given.
    off : time at which the motor is switched off, s, or a text.
    off_turns : turns of the crank from the start after which it is.
    fluctuation : highest less lowest speed over the mean for which a flywheel is sized; a share of
        1, or a text such as ``"2 %"``.
    support : whether the support moves too, from rest in the drawn position; else the frame is
        fixed.
    progress : called with the turns of the crank that were followed, and the most there can be; not
        where only a time, or less than a turn, ends the run.

    Raises
    ------
    MassError : a link has no mass given.
    MotionError : the crank cannot turn fully.
    ModelError : with `support`, there is none, or its mounts do not hold the machine.
    UsageError : a value cannot be used, or `fluctuation` is given of a machine that is not driven
        by one crank, or whose support leaves the plane.
    ResponseError : the motion cannot be followed.
    """
    plan = machine.run or RunPlan()
    if duration is None and turns is None:
        duration, turns = plan.duration, plan.turns
    if off is None and off_turns is None:
        off, off_turns = plan.off, plan.off_turns
    speed = plan.speed if speed is None else speed
    angle = plan.angle if angle is None else angle
    limits = _limits(machine, {"duration": duration, "turns": turns, "off": off,
                               "off_turns": off_turns})  # fmt: skip
    on_support = plan.support if support is None else support
    if on_support or not machine.has_crank:
        wheel = None
        if fluctuation is not None:
            wheel = size_flywheel(machine, share_of_mean(fluctuation), progress, support=True)
        limits = _limits_of_drives(machine, limits)
        start = _start(machine.drive.speed, speed, angle)
        equation = (SupportedEquation if on_support else DrivesEquation)(machine, start[1])
        starts = _start_of_drives(machine, start, speed is None)
        return _run_drives(equation, limits, starts, _turns_counted(limits, progress), wheel)
    whole_turns = _turns_counted(limits, progress)
    first = 0.0 if machine.drive.motor is not None else machine.drive.speed
    start = _start(first, speed, angle)
    wanted = None if fluctuation is None else share_of_mean(fluctuation)
    crank, driver = CrankEquation(machine), Driver.of(machine)
    integration = Integration(crank, driver, limits)
    integration.on_turns = whole_turns
    integration.follow(start[1], start[0])
    flywheel = None if wanted is None else size_flywheel(machine, wanted, progress)
    return _result(crank, integration, flywheel)


def _limits(machine: Machine, given: Mapping[str, float | str | None]) -> Limits:
    """Where a run ends, by what is given of it."""
    sizes = {name: _positive(name, value) for name, value in given.items()}
    _check_turns(given["turns"])  # type: ignore[arg-type]
    switched_off = given["off"] is not None or given["off_turns"] is not None
    if switched_off and not any(drive.motor for drive in machine.driven):
        raise UsageError(
            at_place("drive.motor", Note("missing; without a motor there is nothing to switch off"))
        )
    free = min(sizes["duration"], sizes["turns"]) == inf
    return Limits(
        sizes["duration"],
        TURNS if free else sizes["turns"],
        sizes["off"],
        sizes["off_turns"],
        steady=free,
    )


def _start(usual: float, speed: float | str | None, angle: float | str | None) -> list[float]:
    """Speed of the crank at the start, rad/s, and its angle, rad."""
    given = usual if speed is None else in_si(speed, "angular speed", "speed")
    start = [float(value or 0.0) for value in (given, in_si(angle, "angle", "angle"))]
    if not np.all(np.isfinite(start)):
        raise UsageError(
            Note(
                "got {speed!r} and {angle!r} for speed and angle; give finite numbers",
                speed=speed,
                angle=angle,
            )
        )
    return start


def _turns_counted(limits: Limits, progress: ProgressCallback | None) -> Callable[[float], None]:
    """What is called with the turns of the crank so far."""
    if progress is None or not 1 <= limits.turns < inf:
        return lambda turns: None
    most = ceil(limits.turns)
    return lambda done: progress(int(done), most)


def _limits_of_drives(machine: Machine, limits: Limits) -> Limits:
    """Where a run of several drives ends, which may never be steady: after `TURNS_OF_DRIVES` turns
    of the crank, or the time of these, where nothing is given.
    """
    crank_speed = abs(machine.drive.speed)
    if limits.steady:
        time = 2 * pi * TURNS_OF_DRIVES / (crank_speed or 1.0)
        return replace(limits, time=time, turns=TURNS_OF_DRIVES)
    counted = limits.turns < inf or limits.off_turns < inf
    if counted and not (crank_speed or machine.drive.moves_freely or machine.has_crank):
        raise UsageError(
            Note("turns are those of the crank, which has the speed 0; give times instead")
        )
    return limits


def _start_of_drives(
    machine: Machine, start: Sequence[float], usual: bool
) -> tuple[list[float], list[float]]:
    """Angles, rad, and speeds, rad/s, of all drives at a speed of the crank, rad/s, and its angle,
    rad; where the speed is the `usual` one, those with a motor are at rest.
    """
    crank_speed, crank_angle = start
    angles, rates = (part.tolist() for part in drives_at(machine, crank_angle))
    speeds = [
        0.0 if usual and drive.motor is not None else rate * crank_speed
        for drive, rate in zip(machine.driven, rates, strict=True)
    ]
    return angles, speeds


def _result(equation: CrankEquation, integration: Integration, flywheel: Flywheel | None) -> Run:
    """The run that an integration has followed."""
    machine = equation.machine
    time, crank_angle, crank_speed, *work = np.vstack(integration.track).T
    electric, work = np.array(work[:ELECTRIC]), work[ELECTRIC:]
    switched = next((event.time for event in integration.events if event.kind == "off"), inf)
    driver = Driver.of(machine)
    driver.begins(float(crank_angle[0]), float(crank_speed[0]))
    driving = driver.torque_at(crank_speed, crank_angle, time)
    driving = driver.torque_of(electric[0]) if driver.lags else driving
    torque = np.where(time <= switched, driving, 0.0)
    brake = [BRAKE] if driver.brake else []
    works = dict(zip([*equation.works, *brake, DRIVE], work, strict=True))
    works, losses = losses_apart(works, equation.rubbing)
    keys = [*(source.key for source in equation.sources), *brake, DRIVE]
    works = {key: works[key] for key in keys}
    return Run(
        machine=machine,
        time=time,
        crank_angle=crank_angle,
        work=works,
        losses=losses,
        events=tuple(integration.events),
        flywheel=flywheel,
        equation=equation,
        crank_speed=crank_speed,
        drive_torque=torque,
        begins=tuple(integration.begins),
        electric=None if driver.circuit is None else Electric(*electric),
    )


def _run_drives(
    equation: DrivesEquation,
    limits: Limits,
    start: tuple[Sequence[float], Sequence[float]],
    on_turns: Callable[[float], None],
    flywheel: Flywheel | None,
) -> DrivesRun:
    """Run until something ends it; a support begins at rest in the drawn position.

    start : angles, rad, and speeds, rad/s, of all drives.  on_turns : as of `DrivesIntegration`.
    """
    unknowns = equation.unknowns
    integration = DrivesIntegration(equation, limits)
    integration.on_turns = on_turns
    at_rest = [0.0] * (equation.coordinates - len(equation.drives))
    angles, speeds = ([*each, *at_rest] for each in start)
    integration.follow([angles[k] for k in unknowns], [speeds[k] for k in unknowns])
    track, rates = joined(integration.tracks), integration.rates
    where = rates.where(track.time, track.states)
    passed = DriveAngles(*(values.copy() for values in where))
    of_rows = equation.in_rows(track.time, where, track.references)
    pushed = () if equation.strokes is None else equation.strokes.places
    lengths = dict(zip(pushed, equation.rows.first(of_rows.lengths), strict=True))
    for k in pushed:
        where.angles[k], where.speeds[k] = (
            equation.rows.first(part[k]) for part in (of_rows.angles, of_rows.speeds)
        )
    courses = {
        drive.link: DriveCourse(
            drive.link,
            MOTOR if drive.motor else FREE if k in unknowns else GIVEN,
            where.angles[k],
            where.speeds[k],
            track.torques[k],
            _electric(integration, k, track, where),
            lengths.get(k),
        )
        for k, drive in enumerate(equation.drives)
    }
    works = dict(zip(rates.works, track.quadratures[2 * len(rates.circuits) :], strict=True))
    works, losses = losses_apart(works, rates.rubbing)
    return DrivesRun(
        machine=equation.machine,
        time=track.time,
        crank_angle=where.crank_angle,
        work=works,
        losses=losses,
        events=tuple(integration.events),
        flywheel=flywheel,
        equation=equation,
        drives=courses,
        cycle_begins=tuple(integration.marks),
        where=of_rows,
        passage=Passage(equation, track.time, passed, track.references, track.accelerations),
        references=track.references,
        support=equation.support_motion(where.angles, where.speeds),
    )


def _electric(
    integration: DrivesIntegration, drive: int, track: DrivesTrack, where: DriveAngles
) -> Electric | None:
    """The circuit of a drive's motor; None of one without."""
    rates = integration.rates
    if drive not in rates.circuits:
        return None
    place = 2 * rates.circuits.index(drive)
    if drive in rates.lagging:
        current = rates.current(drive, track.states, where)
    else:
        off = next((event.time for event in integration.events if event.kind == "off"), inf)
        motor = integration.equation.drivers()[drive]
        current = np.where(track.time <= off, motor.current(where.speeds[drive]), 0.0)
    return Electric(current, *track.quadratures[place : place + 2])
