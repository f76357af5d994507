"""What `equipoise check` prints of a hand-held tool."""

from __future__ import annotations

from collections.abc import Iterator
from math import degrees
from typing import TYPE_CHECKING

from equipoise.schema.files import printable
from equipoise.terminal.tables import PER_RPM, number

if TYPE_CHECKING:
    from equipoise.handheld.design_plan import DesignPlan
    from equipoise.handheld.model import Both, Excitation, Hand, Operation, Station, Tool
    from equipoise.handheld.shaft import Shaft

RATES = (
    ("inertia", "kg m^2"),
    ("stiffness", "N/m"),
    ("damping", "N s/m"),
    ("rotational_stiffness", "N m/rad"),
    ("rotational_damping", "N m s/rad"),
)


def print_check_of_tool(tool: Tool, file: str) -> None:
    """How the tool is built up."""
    print(tool.title)
    print(f"{number(tool.mass)} kg without hands")
    for row in _shaft(tool.shaft):
        print(row)
    for station in tool.stations:
        parts = ", ".join(_station(station)) or "nothing"
        print(f"  {station.name} at {_length(station.position)}: {parts}")
    for excitation in tool.excitations:
        print(f"shaken by {excitation.name}: {', '.join(_excitation(excitation))}")
    if tool.operation is not None:
        print(f"engine: {', '.join(_operation(tool.operation))}")
    if tool.work:
        print(
            f"day: {', '.join(f'{one.name} {number(one.duration / 3600)} h' for one in tool.work)}"
        )
    if tool.design is not None:
        print(f"design: {_design(tool.design)}")
    print(f"ready: equipoise tool {printable(file)}")


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
    for key, unit in RATES:
        pair: Both = getattr(item, key, (0.0, 0.0))
        if any(pair):
            yield f"{_planes(pair)} {unit}"


def _planes(pair: Both) -> str:
    vertical, lateral = map(number, pair)
    return vertical if pair[0] == pair[1] else f"{vertical} (vertical) and {lateral} (lateral)"


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
    yield f"{number(operation.speed / PER_RPM)} rpm at work"
    if operation.speeds:
        low, high = (number(speed / PER_RPM) for speed in operation.speeds)
        yield f"from {low} to {high} rpm"
    if operation.idling is not None:
        yield f"idling at {number(operation.idling / PER_RPM)} rpm"
    if operation.racing is not None:
        yield f"racing at {number(operation.racing / PER_RPM)} rpm"


def _design(design: DesignPlan) -> str:
    low, high = (number(speed / PER_RPM) for speed in design.speeds)
    changes = ", ".join(variable.name for variable in design.variables)
    kept = ", ".join(f"{limit.station or ''} {limit.output}".strip() for limit in design.limits)
    limits = f"; limits {kept}" if kept else ""
    return f"{low} to {high} rpm, {design.measure}; may change {changes}{limits}"
