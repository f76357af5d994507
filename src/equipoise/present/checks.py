"""What `equipoise check` tells of the file of a linkage and of a hand-held tool."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from math import degrees
from typing import TYPE_CHECKING

from equipoise.errors import ModelError
from equipoise.mechanism.assessment import remarks
from equipoise.mechanism.cycle import turns_of_loads
from equipoise.mechanism.dynamics import massless
from equipoise.mechanism.linkage import assemble
from equipoise.mechanism.loads import work_in_cycle
from equipoise.mechanism.support import idle_parts
from equipoise.quantities import PER_RPM, Dimension, number
from equipoise.results.blocks import Block, Cell, Column, Listing, Notes, Table, Text, Value
from equipoise.results.machine_blocks import bodies_tables
from equipoise.vibration.body import Body, at_rest
from equipoise.vibration.linear import Excitation as Shaking

if TYPE_CHECKING:
    from equipoise.handheld.design_plan import DesignPlan
    from equipoise.handheld.model import Both, Excitation, Hand, Operation, Station, Tool
    from equipoise.handheld.shaft import Shaft
    from equipoise.mechanism.force_elements import Motor
    from equipoise.mechanism.linkage import Linkage
    from equipoise.mechanism.model import Machine
    from equipoise.mechanism.support import Gauge, Mount


# -- linkages --------------------------------------------------------------------------------------


def machine_blocks(machine: Machine) -> Iterator[Block]:
    """How the linkage is built up, and what to look at again."""
    linkage = assemble(machine)
    cycle, drive = linkage.cycle, machine.drive
    yield Text(
        f"{len(machine.links)} moving links, one free motion; driven: {drive.link} at "
        f"{number(drive.speed / PER_RPM)} rpm about {linkage.pivot}"
    )
    yield from map(Text, _build_up(linkage))
    turns = "one turn" if cycle.turns == 1 else f"{cycle.turns} turns"
    repeats = "motion repeats" if turns_of_loads(machine) == 1 else "motion and loads repeat"
    yield Text(f"the crank turns fully; the {repeats} after {turns}")
    yield from bodies_tables(machine)
    yield from map(Text, (*_springs(machine), *_drive_train(machine), *_support(machine)))
    if machine.loads:
        ends = (Column(end, "angle", "deg") for end in ("from", "to"))
        heads = ("on", "what", *ends, "beyond", "largest", Column("work", "energy"))
        yield Table.of("Loads, and their work in a cycle", heads, _loads(machine))
    if notes := (*remarks(linkage), *idle_parts(machine.support), *_uncarried(machine)):
        yield Notes(notes)
    yield Text("ready to be analysed")


def _uncarried(machine: Machine) -> Iterator[str]:
    """Why the mounts do not hold the machine, if they do not."""
    if machine.support is None or massless(machine):
        return
    try:
        at_rest(Body(machine), Shaking(Body(machine), "moment").weights)
    except ModelError as error:
        yield f"{error}; respond and modes need that"


HOW = {"loops": "by Newton's method on the loop equations"}
"""How a group of links is solved, where that is not its kind."""


def _build_up(linkage: Linkage) -> Iterable[str]:
    for group in linkage.groups:
        links = " and ".join(group.links)
        joints = ", ".join(
            f"{r.name} (slider)" if r.kind == "slider" else f"{r.name} ({r.kind} on {r.by})"
            for r in group.reactions
        )
        yield f"  {links}: {HOW.get(group.kind, group.kind)}; joints {joints}"


MOST_SHOWN = 12
"""Phases of rows in a line."""


def _loads(machine: Machine) -> Iterator[tuple[Cell, ...]]:
    """Every load: where it acts, from which crank angle to which, its size and its work."""
    for load in machine.loads:
        work = work_in_cycle(machine, load)
        kind: Dimension = "torque" if load.point is None else "force"
        place = load.link if load.point is None else f"{load.point} of {load.link}"
        what: str = kind
        ends, beyond = (load.start, load.stop), "0"
        if (table := load.table) is not None:
            what = f"{kind}, {table.file}" if table.file else f"{kind}, table"
            beyond = "0" if load.start is not None or table.covers else load.outside or ""
            if load.start is None:
                ends = (table.crank_angle[0], table.crank_angle[-1])
        shown = [Value(end, after=1) for end in ends if end is not None]
        where: tuple[Cell, ...] = (*shown, beyond) if shown else ("always", None, None)
        yield place, what, *where, Value(work.largest, dimension=kind), Value(work.net, work.both)


def _springs(machine: Machine) -> Iterator[str]:
    for spring in machine.springs:
        free = f", free at {number(spring.free_length * 1e3)} mm" if spring.free_length else ""
        yield (
            f"spring: from {spring.point} of {spring.link} to {spring.to}, "
            f"{number(spring.stiffness)} N/m{free}"
        )


def _drive_train(machine: Machine) -> Iterator[str]:
    drive = machine.drive
    if drive.flywheel:
        yield f"flywheel: {number(drive.flywheel)} kg m^2"
    if (motor := drive.motor) is not None:
        rotor = f", rotor {number(motor.inertia)} kg m^2" if motor.inertia else ""
        speed = "is the drive's" if motor.mean_speed == "held" else "follows from it"
        yield f"motor: {_curve(motor)}, ratio {number(motor.ratio)}{rotor}; mean speed {speed}"
    if machine.rows:
        shown = [number(degrees(row.phase)) for row in machine.rows[:MOST_SHOWN]]
        more = len(machine.rows) - len(shown)
        phases = f"{', '.join(shown)} and {more} more" if more else _listed(shown)
        yield f"rows: {len(machine.rows)} on one shaft, ahead by {phases} deg"


def _curve(motor: Motor) -> str:
    if motor.table is not None:
        speeds = motor.table.speed
        return f"{len(speeds)} rows from {_rpm(speeds[0])} to {_rpm(speeds[-1])} rpm"
    assert motor.no_load_speed is not None
    assert motor.stall_torque is not None
    torque = number(motor.stall_torque)
    return f"{_rpm(motor.no_load_speed)} rpm without load, {torque} N m at standstill"


def _rpm(speed: float) -> str:
    return number(speed / PER_RPM)


def _support(machine: Machine) -> Iterator[str]:
    support = machine.support
    if support is None:
        return
    about = f" about the pivot at {_place(support.pivot)}" if support.pivot is not None else ""
    ways = _listed(support.coordinates)
    yield f"support: {number(support.mass)} kg; it can {ways}{about}"
    for name, mount in support.mounts.items():
        yield f"  mount {name}: {', '.join(_mount(mount))}"
    for name, gauge in support.gauges.items():
        yield f"  {name}: a gauge that reads {_reading(gauge)}"
    if not support.mounts:
        yield "  no mounts"


MOUNT_RATES = {
    "stiffness": "N/m",
    "damping": "N s/m",
    "torsional_stiffness": "N m/rad",
    "torsional_damping": "N m s/rad",
}


def _mount(mount: Mount) -> Iterator[str]:
    yield _reading(mount) if mount.point is None else f"pushes {_reading(mount)}"
    for key, unit in MOUNT_RATES.items():
        if value := getattr(mount, key):
            yield f"{number(value)} {unit}"
    if mount.preload is not None:
        yield f"{number(mount.preload)} {'N' if mount.axis is None else 'N m'} as drawn"
    if mount.one_sided:
        yield "one-sided"


def _reading(item: Mount | Gauge) -> str:
    if item.point is None:
        return f"about the {item.axis} axis"
    if isinstance(item.direction, tuple):
        way = f"along ({', '.join(map(number, item.direction))})"
    else:
        way = f"along {number(degrees(item.direction))} deg"
    return f"{way} at {_place(item.point)}"


def _place(place: Sequence[float]) -> str:
    return f"({', '.join(number(coordinate * 1e3) for coordinate in place)}) mm"


def _listed(words: Sequence[str]) -> str:
    *others, last = words
    return f"{', '.join(others)} and {last}" if others else last


# -- tools ----------------------------------------------------------------------------------------

RATES = {
    "inertia": "kg m^2",
    "stiffness": "N/m",
    "damping": "N s/m",
    "rotational_stiffness": "N m/rad",
    "rotational_damping": "N m s/rad",
}


def tool_blocks(tool: Tool, file: str) -> Iterator[Block]:
    """How the tool is built up."""
    yield Text(f"{number(tool.mass)} kg without hands")
    yield from map(Text, _shaft(tool.shaft))
    for station in tool.stations:
        parts = ", ".join(_station(station)) or "nothing"
        yield Text(f"  {station.name} at {_length(station.position)}: {parts}")
    for excitation in tool.excitations:
        yield Text(f"shaken by {excitation.name}: {', '.join(_excitation(excitation))}")
    if tool.operation is not None:
        yield Text(f"engine: {', '.join(_operation(tool.operation))}")
    if tool.work:
        times = (f"{one.name} {number(one.duration / 3600)} h" for one in tool.work)
        yield Text(f"day: {', '.join(times)}")
    if tool.design is not None:
        yield Text(f"design: {_design(tool.design)}")
    yield Listing("", f"ready: equipoise tool {file}")


def _length(value: float) -> str:
    return f"{number(1e3 * value)} mm"


def _shaft(shaft: Shaft) -> Iterator[str]:
    pieces = shaft.pieces
    stiffness = f"EI {number(pieces[0][2].bending_stiffness)} N m^2" if len(pieces) == 1 else ""
    parts = [_length(shaft.length), f"{number(shaft.mass)} kg", stiffness, shaft.theory]
    if shaft.loss_factor:
        parts.append(f"loss factor {number(shaft.loss_factor)}")
    yield f"shaft: {', '.join(filter(None, parts))}"
    for start, stop, section in pieces if len(pieces) > 1 else ():
        yield (
            f"  from {_length(start)} to {_length(stop)}: EI {number(section.bending_stiffness)} "
            f"N m^2, {number(section.mass_per_length)} kg/m"
        )


def _station(station: Station) -> Iterator[str]:
    if station.mass:
        yield f"{number(station.mass)} kg"
    yield from _rates(station)
    if station.absorber is not None:
        parts = ", ".join([f"{number(station.absorber.mass)} kg", *_rates(station.absorber)])
        yield f"absorber ({parts})"
    if station.hand is not None:
        yield f"{station.hand.hands} hand{'s' * (station.hand.hands - 1)} ({_hand(station.hand)})"
    if station.harness is not None:
        yield f"harness ({', '.join(_rates(station.harness))})"


def _rates(item: object) -> Iterator[str]:
    for key, unit in RATES.items():
        pair: Both = getattr(item, key, (0.0, 0.0))
        vertical, lateral = map(number, pair)
        both = f"{vertical} (vertical) and {lateral} (lateral)"
        if any(pair):
            yield f"{vertical if pair[0] == pair[1] else both} {unit}"


def _hand(hand: Hand) -> str:
    mass = [f"{number(hand.mass)} kg"] if hand.mass else []
    spans = [
        f"impedance from {number(table.frequency[0])} to {number(table.frequency[-1])} Hz"
        for table in hand.impedance
    ]
    return ", ".join([*mass, *_rates(hand), *spans])


def _excitation(excitation: Excitation) -> Iterator[str]:
    if excitation.force is not None:
        yield f"{number(excitation.force)} N, {excitation.direction}"
    elif excitation.unbalance is not None:
        yield f"unbalance {number(1e6 * excitation.unbalance)} g mm"
    elif excitation.linkage is not None:
        yield f"linkage {excitation.linkage.title}"
    yield f"at {excitation.station}"
    if excitation.ratio != 1:
        yield f"{number(excitation.ratio)} times the engine's speed"
    if excitation.phase:
        yield f"ahead by {number(degrees(excitation.phase))} deg"


def _operation(operation: Operation) -> Iterator[str]:
    yield f"{_rpm(operation.speed)} rpm at work"
    if operation.speeds:
        low, high = map(_rpm, operation.speeds)
        yield f"from {low} to {high} rpm"
    if operation.idling is not None:
        yield f"idling at {_rpm(operation.idling)} rpm"
    if operation.racing is not None:
        yield f"racing at {_rpm(operation.racing)} rpm"


def _design(design: DesignPlan) -> str:
    low, high = map(_rpm, design.speeds)
    changes = ", ".join(variable.name for variable in design.variables)
    kept = ", ".join(f"{limit.station or ''} {limit.output}".strip() for limit in design.limits)
    limits = f"; limits {kept}" if kept else ""
    return f"{low} to {high} rpm, {design.measure}; may change {changes}{limits}"
