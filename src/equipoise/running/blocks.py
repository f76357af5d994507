"""What a run shows: its end, its figures, each drive, where its energy went, and its events."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from math import degrees, inf, pi
from typing import TYPE_CHECKING

import numpy as np

from equipoise.i18n import localized, say, sentence_start, to_say
from equipoise.mechanism.outputs.declared import joint_named
from equipoise.quantities import PER_RPM, format_quantity, number, percent
from equipoise.results.blocks import Block, Column, Facts, Table, Text, Value, broken_if
from equipoise.running.drives_equation import BRAKE
from equipoise.running.friction import FRICTION
from equipoise.running.run_results import DRIVE, FREE, GIVEN, MOTOR
from equipoise.running.support_equation import MOUNTS
from equipoise.vibration.blocks import PARTS, extreme_labels, readings_in_time, support_rows
from equipoise.vibration.coupled import stall_note

if TYPE_CHECKING:
    from equipoise.running.drives_integration import DriveEvent
    from equipoise.running.flywheel import Flywheel
    from equipoise.running.integration import Event
    from equipoise.running.run_contacts import RunContact
    from equipoise.running.run_results import DrivesRun, Electric, Run, RunResult
    from equipoise.signals import Array
    from equipoise.vibration.support_motion import SupportMotion

EVENTS = {
    "off": to_say("motor switched off"),
    "reversal": to_say("turns back"),
    "steady": to_say("steady"),
    "standstill": to_say("stands still"),
    "stall": to_say("motor stalls"),
    "turns": to_say("end of the run"),
    "time": to_say("end of the run"),
}
NO_MOTOR = to_say(
    "The machine has no motor: it moves from its initial speed under weight, springs and loads; "
    "add a table [drive.motor] to drive it."
)
MOST_EVENTS = 20
SETTLED = 1e-3
"""Of the kinetic energy: what a drive gives in a cycle beyond it speeds the machine up."""
SAME_SPEED = 0.02
"""Share of the speed of the drive by which that of a run may differ without a remark."""
ROUNDING = 1e-9
"""Share of the kinetic energy below which the drive gives none in a cycle."""


def run_headline(run: Run, alone: bool = False) -> Iterator[Block]:
    """Whether and how the machine runs; alone also its figures.

    alone : whether nothing follows, as on a terminal.
    """
    yield Text(verdict(run), broken_if(run.end.kind == "stall" or run.driven_back is not None))
    if run.machine.drive.motor is None:
        yield Text(say(NO_MOTOR))
    if remark := _other_speed(run):
        yield Text(remark)
    if run.flywheel is not None:
        yield Text(_flywheel_sentence(run.flywheel))
    if alone and (lines := tuple(_figures(run))):
        yield Facts(say("Last cycle"), lines)


def verdict(run: Run) -> str:
    """What came of the run, in a sentence."""
    end, cycle = run.end, run.last_cycle
    if trouble := _trouble(run):
        return trouble
    values = {"time": number(end.time), "turns": number(abs(run.turned))}
    if end.kind == "standstill":
        angle = number(degrees(end.crank_angle) % 360)
        template = to_say(
            "The machine stands still after {time} s and {turns} turns, at crank angle {angle} deg."
        )
        return " ".join([say(template, **values, angle=angle), *_stopped(run)])
    if end.kind == "reversal":
        turned_back = sum(event.kind == "reversal" for event in run.events)
        template = to_say(
            "The crank swings to and fro: it has turned back {count} times in {time} s, and the "
            "run ends there."
        )
        return say(template, count=turned_back, time=values["time"])
    if end.kind == "steady" and cycle is not None:
        speed = number(cycle.mean_speed / PER_RPM)
        share = f"{100 * cycle.fluctuation:.3g}"
        if run.starting_time is None:
            template = to_say("The machine runs at {speed} rpm, with a fluctuation of {share} %.")
            return say(template, speed=speed, share=share)
        template = to_say(
            "The machine starts in {time} s and runs at {speed} rpm, with a fluctuation of "
            "{share} %."
        )
        return say(template, time=number(run.starting_time), speed=speed, share=share)
    speed = number(end.speed / PER_RPM)
    template = to_say("After {time} s and {turns} turns the crank turns at {speed} rpm.")
    return say(template, **values, speed=speed)


def _trouble(run: Run) -> str:
    """That the motor does not turn the machine; empty where it does."""
    if run.lacking_torque is not None:
        needed, given = run.lacking_torque
        at = degrees(run.end.crank_angle) % 360
        starting = not run.crank_speed[0] and abs(run.turned) < 1
        note = stall_note(at, needed, given, at_rest=not run.turned, starting=starting)
        return sentence_start(localized(note)) + "."
    return "" if run.driven_back is None else _driven_back(run, run.driven_back)


def _other_speed(run: Run) -> str:
    """That the motor turns the crank at another speed than the file gives; empty where not."""
    cycle, given = run.last_cycle, run.machine.drive.speed
    if run.machine.drive.motor is None or run.end.kind != "steady" or cycle is None:
        return ""
    if run.driven_back is not None or abs(cycle.mean_speed - given) <= SAME_SPEED * abs(given):
        return ""
    return say(
        "The file gives the drive a speed of {given} rpm, for which analyses hold; the curve of "
        "its motor leads to {speed} rpm.",
        given=number(given / PER_RPM),
        speed=number(cycle.mean_speed / PER_RPM),
    )


def _driven_back(run: Run, back: Event) -> str:
    """That loads drive a machine against the sense of its drive, and what to give instead."""
    off = next((event for event in run.events if event.kind == "off"), None)
    switched = to_say(
        "Switched off at {off} s, the machine turns back at {back} s and is driven backwards by "
        "the loads, at {speed} rpm in the end; give loads that only resist the motion as "
        "[[resistances]]."
    )
    alone = to_say(
        "The machine turns back at {back} s and is driven backwards by the loads, at {speed} rpm "
        "in the end; give loads that only resist the motion as [[resistances]]."
    )
    return say(
        alone if off is None else switched,
        off="" if off is None else number(off.time),
        back=number(back.time),
        speed=number(run.end.speed / PER_RPM),
    )


def _stopped(run: Run) -> Iterator[str]:
    """How long a machine that stands still has taken since its motor was switched off."""
    if run.stopping is not None:
        time, turns = (number(value) for value in run.stopping)
        yield say("Switched off, it stops in {time} s and {turns} turns.", time=time, turns=turns)


def _flywheel_sentence(flywheel: Flywheel) -> str:
    """What flywheel the wanted fluctuation needs."""
    wanted = f"{100 * flywheel.wanted:.3g}"
    if not flywheel.inertia:
        template = to_say(
            "A fluctuation of {wanted} % needs no flywheel: it is {present} % at {speed} rpm."
        )
        present = f"{100 * flywheel.present:.3g}"
    else:
        template = to_say(
            "A flywheel of {inertia} on the crank brings the fluctuation at {speed} rpm from "
            "{present} % to {wanted} %; the textbook's estimate is {estimate}."
        )
        if flywheel.present == inf:
            template = to_say(
                "With a flywheel of {inertia} on the crank the fluctuation at {speed} rpm is "
                "{wanted} %; without it the crank nearly stands still at its heaviest place. The "
                "textbook's estimate is {estimate}."
            )
        present = f"{100 * flywheel.present:.3g}"
    sentence = say(
        template,
        wanted=wanted,
        present=present,
        speed=number(abs(flywheel.speed) / PER_RPM),
        inertia=format_quantity(flywheel.inertia, "inertia", "kg m^2"),
        estimate=format_quantity(flywheel.estimate, "inertia", "kg m^2"),
    )
    if not flywheel.inertia or not flywheel.existing:
        return sentence
    addition = say(
        "That is in addition to the flywheel of {existing} in the file: {total} in all.",
        existing=format_quantity(flywheel.existing, "inertia", "kg m^2"),
        total=format_quantity(flywheel.total, "inertia", "kg m^2"),
    )
    return f"{sentence} {addition}"


def _figures(run: Run) -> Iterator[str]:
    cycle = run.last_cycle
    if cycle is None:
        return
    each = {"low": cycle.lowest, "mean": cycle.mean_speed, "high": cycle.highest}
    speeds = {name: abs(speed) for name, speed in each.items()}
    yield say(
        "speed from {low} to {high} rpm, {mean} rpm in the mean",
        **{name: number(speed / PER_RPM) for name, speed in speeds.items()},
    )
    share = abs(cycle.energy) / float(np.max(run.kinetic_energy))
    gives = share > ROUNDING
    if share < SETTLED and all(source.conserves for source in run.equation.sources):
        yield say("drive: zero mean power, as the file has neither friction nor loads")
    else:
        yield say(
            "drive: {energy} in a turn, {power} in the mean",
            energy=format_quantity(cycle.energy_per_turn if gives else 0.0, "energy", "J"),
            power=format_quantity(cycle.power if gives else 0.0, "power", "W"),
        )
    yield from _lossiest(run)
    if run.electric is not None:
        yield say(
            "current of the motor: up to {most}, {last} at the end",
            most=format_quantity(float(np.max(np.abs(run.electric.current))), "current", "A"),
            last=format_quantity(float(run.electric.current[-1]), "current", "A"),
        )


def _energies(
    run: RunResult, labels: Mapping[str, str], circuits: Iterable[tuple[Electric, str, str]]
) -> Iterator[Block]:
    """Work of everything that has acted, what became of it, and how far the balance is from closed.

    labels : of what acts beside the sources of the equation, by its key in the works.
    circuits : of direct-current motors, with labels of what the supply gave and of heat.
    """
    labels = {source.key: say(source.label) for source in run.equation.sources} | {**labels}
    energy = run.kinetic_energy
    rows = [(labels[name], Value(float(work[-1]))) for name, work in run.work.items()]
    rows.append((say("kinetic energy"), Value(float(energy[-1] - energy[0]))))
    for circuit, supply, heat in circuits:
        rows.append((supply, Value(float(circuit.supply[-1]))))
        rows.append((heat, Value(float(circuit.heat[-1]))))
    columns = ("", Column(say("work"), "energy"))
    yield Table.of(say("Energy from the start to the end"), columns, rows)
    yield from _losses(run)
    error = f"{run.energy_error:.1e}"
    yield Text(say("Kinetic energy and work agree to {error} of the largest.", error=error))


def _lost(run: RunResult) -> tuple[dict[str, float], float]:
    """Energy that friction has taken in each joint since the start, and in all, J."""
    each = {name: float(lost[-1]) for name, lost in run.losses.items()}
    return each, sum(each.values())


def _lossiest(run: RunResult) -> Iterator[str]:
    """Which joint loses most."""
    each, total = _lost(run)
    if not total > 0:
        return
    name, most = max(each.items(), key=lambda item: item[1])
    yield say(
        "friction in joints: {energy} since the start, of which {share} % in {joint}",
        energy=format_quantity(total, "energy", "J"),
        share=percent(most / total),
        joint=joint_named(name),
    )


def _losses(run: RunResult) -> Iterator[Block]:
    """What each joint has lost since the start."""
    each, total = _lost(run)
    if not total > 0:
        return
    rows = [
        (joint_named(name), Value(lost), f"{percent(lost / total)} %")
        for name, lost in each.items()
    ]
    columns = ("", Column(say("work"), "energy"), say("share"))
    yield Table.of(say("Friction in joints from the start to the end"), columns, rows)


def _contacts(contacts: Sequence[RunContact]) -> Iterator[Table]:
    """The last contacts of a run; nothing where there are none."""
    if not contacts:
        return
    title = say("Contacts of one-sided parts")
    if len(contacts) > MOST_EVENTS:
        title = say("Contacts of one-sided parts, the last {number} of {count}", number=MOST_EVENTS,
                    count=len(contacts))  # fmt: skip
    heads = (
        "",
        Column(say("from"), "time"),
        Column(say("to"), "time"),
        Column(say("speed of approach"), "speed"),
        Column(say("largest force"), "force"),
    )
    rows = [
        (
            _contact_named(contact),
            Value(contact.begin),
            None if contact.end is None else Value(contact.end),
            None if contact.approach is None else Value(contact.approach),
            Value(contact.force),
        )
        for contact in contacts[-MOST_EVENTS:]
    ]
    yield Table.of(title, heads, rows)


def _contact_named(contact: RunContact) -> str:
    """Parts that touch, and in which row."""
    parts = contact.parts.localized()
    return parts if contact.row is None else f"{parts}, {say('row {number}', number=contact.row)}"


def event_named(event: Event) -> str:
    """What happened, in words."""
    return say(EVENTS[event.kind])


def run_blocks(run: Run) -> Iterator[Block]:
    """Figures, energies and events."""
    if lines := tuple(_figures(run)):
        yield Facts(say("Last cycle"), lines)
    labels, circuits = {BRAKE: say("brake"), DRIVE: say("drive")}, []
    if run.electric is not None:
        circuits = [(run.electric, say("from the motor's supply"), say("heat in the motor"))]
    yield from _energies(run, labels, circuits)
    events = [
        (
            event_named(event),
            Value(event.time),
            Value(event.crank_angle / (2 * pi)),
            Value(event.speed),
        )
        for event in run.events[-MOST_EVENTS:]
    ]
    heads = (
        "",
        Column(say("time"), "time"),
        say("turns"),
        Column(say("crank speed"), "angular speed", "rpm"),
    )
    yield Table.of(say("Events"), heads, events)
    yield from _contacts(run.contacts)


DRIVE_EVENTS = {
    **EVENTS,
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


def drives_headline(run: DrivesRun, alone: bool = False) -> Iterator[Block]:
    """How the run ends; alone also each drive in its last cycle, and what gauges read.

    alone : whether nothing follows, as on a terminal.
    """
    broken = run.end.kind in ("stall", "dead", "lever") or run.driven_back is not None
    yield Text(drives_verdict(run), broken_if(broken))
    if run.machine.has_crank and run.machine.drive.motor is None:
        yield Text(say(NO_MOTOR))
    if run.flywheel is not None:
        yield Text(_flywheel_sentence(run.flywheel))
    if alone and run.last_cycle is not None and (lines := (*_speeds(run), *_lossiest(run))):
        yield Facts(say("Last cycle"), lines)
    if alone and run.support is not None:
        yield from readings_in_time(run.support)


def drives_verdict(run: DrivesRun) -> str:
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


def drives_blocks(run: DrivesRun) -> Iterator[Block]:
    """Speeds, drives, energies and events."""
    if lines := tuple(_speeds(run)):
        yield Facts(say("Last cycle"), lines)
    yield _drives(run)
    if run.support is not None:
        yield _of_support(run.support, run.time)
    labels = {BRAKE: say("brake"), FRICTION: say("friction"), MOUNTS: say("mounts")}
    labels |= {f"drives.{link}": say("drive of {link}", link=link) for link in run.drives}
    circuits = [
        (
            course.electric,
            say("from the supply of the motor of {link}", link=link),
            say("heat in the motor of {link}", link=link),
        )
        for link, course in run.drives.items()
        if course.electric is not None
    ]
    yield from _energies(run, labels, circuits)
    rows = [
        (
            drive_event_named(event),
            Value(event.time),
            Value((event.crank_angle - run.crank_angle[0]) / (2 * pi)),
        )
        for event in run.events[-MOST_EVENTS:]
    ]
    heads = ("", Column(say("time"), "time"), say("turns of the crank"))
    yield Table.of(say("Events"), heads, rows)
    yield from _contacts(run.contacts)


def drive_event_named(event: DriveEvent) -> str:
    """What happened, in words."""
    return say(DRIVE_EVENTS[event.kind], of=event.of) if event.of else say(DRIVE_EVENTS[event.kind])


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
