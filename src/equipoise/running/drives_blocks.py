"""What a run of several drives shows: its end, each drive, where energy went, and events."""

from __future__ import annotations

from collections.abc import Iterator
from math import pi
from typing import TYPE_CHECKING

import numpy as np

from equipoise.i18n import say, to_say
from equipoise.quantities import PER_RPM, number
from equipoise.results.blocks import Block, Column, Facts, Table, Text, Value, broken_if
from equipoise.running.blocks import EVENTS as OF_A_RUN
from equipoise.running.blocks import (
    MOST_EVENTS,
    NO_MOTOR,
    contacts_table,
    flywheel_sentence,
    losses_table,
    lossiest,
)
from equipoise.running.drives_run import FREE, GIVEN, MOTOR
from equipoise.running.friction import FRICTION
from equipoise.running.support_equation import MOUNTS
from equipoise.vibration.blocks import PARTS, extreme_labels, support_rows
from equipoise.vibration.headline import readings_in_time

if TYPE_CHECKING:
    from equipoise.running.drives_integration import DriveEvent
    from equipoise.running.drives_run import DrivesRun
    from equipoise.signals import Array
    from equipoise.vibration.support_motion import SupportMotion

EVENTS = {
    **OF_A_RUN,
    "off": to_say("motors switched off"),
    "stall": to_say("motors stall"),
    "reversal": to_say("{of} turns back"),
    "dead": to_say("dead position of dyad {of}"),
    "lever": to_say("no lever to move {of}"),
    "swings": to_say("{of} swings to and fro"),
}
MOVED_BY = {MOTOR: to_say("motor"), FREE: to_say("no motor"), GIVEN: to_say("given motion")}
ENDS = {
    "standstill": to_say("The machine stands still after {time} s."),
    "stall": to_say("The motors stall after {time} s: all drives stand still."),
    "swings": to_say("After {time} s {of} swings to and fro; the run ends there."),
    "steady": to_say("The machine runs steadily after {time} s and {turns} turns of the crank."),
    "dead": to_say(
        "After {time} s dyad {of} comes to its dead position, beyond which its motion is "
        "undetermined; the run ends there."
    ),
    "lever": to_say(
        "After {time} s there is no lever to move {of}, beyond which the motion is undetermined; "
        "the run ends there."
    ),
}
OTHER_END = to_say("The run ends after {time} s.")


def run_headline(run: DrivesRun, alone: bool = False) -> Iterator[Block]:
    """How the run ends; alone also each drive in its last cycle, and what gauges read.

    alone : whether nothing follows, as on a terminal.
    """
    broken = run.end.kind in ("stall", "dead", "lever") or run.driven_back is not None
    yield Text(verdict(run), broken_if(broken))
    if run.machine.has_crank and run.machine.drive.motor is None:
        yield Text(say(NO_MOTOR))
    if run.flywheel is not None:
        yield Text(flywheel_sentence(run.flywheel))
    if alone and run.last_cycle is not None and (lines := (*_speeds(run), *lossiest(run))):
        yield Facts(say("Last cycle"), lines)
    if alone and run.support is not None:
        yield from readings_in_time(run.support)


def verdict(run: DrivesRun) -> str:
    """What came of the run, in a sentence."""
    if (link := run.driven_back) is not None:
        return say(
            "In {time} s {link} turns back {count} times and completes no further turn: its motor "
            "gives too little torque; give a stronger motor, a higher ratio or a larger flywheel.",
            time=number(run.end.time),
            link=link,
            count=len(run.reversals(link)),
        )
    values = {"time": number(run.end.time), "turns": number(abs(run.turned)), "of": run.end.of}
    return say(ENDS.get(run.end.kind, OTHER_END), **values)


def _speeds(run: DrivesRun) -> Iterator[str]:
    """Speeds of each drive in the last cycle of the crank."""
    inside = run.last_cycle
    if inside is None:
        return
    time = run.time[inside]
    for link, course in run.drives.items():
        if course.length is not None:
            continue
        speed = course.speed[inside]
        mean = (course.angle[inside][-1] - course.angle[inside][0]) / (time[-1] - time[0])
        values = {"low": np.min(speed), "high": np.max(speed), "mean": mean}
        yield say(
            "{link}: from {low} to {high} rpm, {mean} rpm in the mean",
            link=link,
            **{name: number(float(value) / PER_RPM) for name, value in values.items()},
        )


def run_blocks(run: DrivesRun) -> Iterator[Block]:
    """Speeds, drives, energies and events."""
    if lines := tuple(_speeds(run)):
        yield Facts(say("Last cycle"), lines)
    yield _drives(run)
    if run.support is not None:
        yield _of_support(run.support, run.time)
    yield _energies(run)
    yield from losses_table(run)
    error = f"{run.energy_error:.1e}"
    yield Text(say("Kinetic energy and work agree to {error} of the largest.", error=error))
    rows = [
        (
            event_named(event),
            Value(event.time),
            Value((event.crank_angle - run.crank_angle[0]) / (2 * pi)),
        )
        for event in run.events[-MOST_EVENTS:]
    ]
    heads = ("", Column(say("time"), "time"), say("turns of the crank"))
    yield Table.of(say("Events"), heads, rows)
    yield from contacts_table(run.contacts)


def event_named(event: DriveEvent) -> str:
    """What happened, in words."""
    return say(EVENTS[event.kind], of=event.of) if event.of else say(EVENTS[event.kind])


def _drives(run: DrivesRun) -> Table:
    """How each drive moves: turns, speed at the end, and its largest efforts and current."""
    courses = run.drives.values()
    electric = any(course.electric is not None for course in courses)
    pushes = any(course.length is not None for course in courses)
    heads = [
        say("drive"),
        say("moved by"),
        say("turns"),
        Column(say("speed at the end"), "angular speed", "rpm"),
        Column(say("largest torque"), "torque"),
        *([Column(say("largest force"), "force")] if pushes else []),
        *([Column(say("largest current"), "current")] if electric else []),
    ]
    rows = []
    for link, course in run.drives.items():
        largest = None if course.moved_by == FREE else _largest(course.effort)
        turns = course.length is None
        circuit = course.electric
        row = [
            link,
            say(MOVED_BY[course.moved_by]),
            Value(course.turns) if turns else None,
            Value(course.speed[-1]) if turns else None,
            largest if turns else None,
            *([None if turns else largest] if pushes else []),
            *([None if circuit is None else _largest(circuit.current)] if electric else []),
        ]
        rows.append(tuple(row))
    return Table.of(say("Drives"), tuple(heads), rows)


def _largest(values: Array) -> Value:
    return Value(float(np.max(np.abs(values))))


def _of_support(motion: SupportMotion, time: Array) -> Table:
    """Extremes at gauges and of mounts, in all and in the first and the last fifth of the time."""
    bounds = np.linspace(time[0], time[-1], PARTS + 1)
    first = int(np.searchsorted(time, bounds[1], "right"))
    last = int(np.searchsorted(time, bounds[-2]))
    rows = [*support_rows(motion, (slice(first), slice(last, None)))]
    return Table.of(say("Gauges and mounts"), extreme_labels(), rows)


def _energies(run: DrivesRun) -> Table:
    """Work of everything that has acted, and what became of it."""
    labels = {source.key: say(source.label) for source in run.equation.sources}
    labels |= {"brake": say("brake"), FRICTION: say("friction"), MOUNTS: say("mounts")}
    labels |= {f"drives.{link}": say("drive of {link}", link=link) for link in run.drives}
    rows = [(labels[name], Value(float(work[-1]))) for name, work in run.work.items()]
    energy = run.kinetic_energy
    rows.append((say("kinetic energy"), Value(float(energy[-1] - energy[0]))))
    for link, course in run.drives.items():
        if (circuit := course.electric) is not None:
            supply = say("from the supply of the motor of {link}", link=link)
            heat = say("heat in the motor of {link}", link=link)
            rows.append((supply, Value(float(circuit.supply[-1]))))
            rows.append((heat, Value(float(circuit.heat[-1]))))
    columns = ("", Column(say("work"), "energy"))
    return Table.of(say("Energy from the start to the end"), columns, rows)
