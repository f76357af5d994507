"""What `equipoise check` prints."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from math import degrees
from typing import TYPE_CHECKING

from equipoise.errors import ModelError
from equipoise.mechanism.assessment import remarks
from equipoise.mechanism.dynamics import massless
from equipoise.mechanism.linkage import assemble
from equipoise.mechanism.support import idle_parts
from equipoise.terminal.tables import PER_RPM, number
from equipoise.vibration.body import Body, at_rest
from equipoise.vibration.linear import Excitation

if TYPE_CHECKING:
    from equipoise.mechanism.linkage import Linkage
    from equipoise.mechanism.model import Machine
    from equipoise.mechanism.motor import Motor
    from equipoise.mechanism.support import Gauge, Mount


def print_check(machine: Machine) -> None:
    """How the linkage is built up, and what to look at again."""
    linkage = assemble(machine)
    cycle = linkage.cycle
    print(machine.title)
    drive = machine.drive
    print(
        f"{len(machine.links)} moving links, one free motion; driven: {drive.link} at "
        f"{number(drive.speed / PER_RPM)} rpm about {linkage.pivot}"
    )
    for row in _build_up(linkage):
        print(f"  {row}")
    turns = "one turn" if cycle.turns == 1 else f"{cycle.turns} turns"
    print(f"the crank turns fully; the motion repeats after {turns}")
    for row in [*_springs(machine), *_drive_train(machine), *_support(machine)]:
        print(row)
    for remark in [*remarks(linkage), *idle_parts(machine), *_uncarried(machine)]:
        print(f"note: {remark}")
    print("ready to be analysed")


def _uncarried(machine: Machine) -> Iterator[str]:
    """Why the mounts do not hold the machine, if they do not."""
    if machine.support is None or massless(machine):
        return
    try:
        at_rest(Body(machine), Excitation(Body(machine), "moment").weights)
    except ModelError as error:
        yield f"{error}; respond and modes need that"


HOW = {
    "dyad": "dyad",
    "geared": "geared",
    "loops": "by Newton's method on the loop equations",
}


def _build_up(linkage: Linkage) -> Iterable[str]:
    for group in linkage.groups:
        links = " and ".join(group.links)
        joints = ", ".join(
            f"{r.name} ({r.kind} on {r.by})" if r.kind != "slider" else f"{r.name} (slider)"
            for r in group.reactions
        )
        yield f"{links}: {HOW[group.kind]}; joints {joints}"


# -- support, rows, motor --------------------------------------------------------------------------

MOST_SHOWN = 12
"""Phases of rows in a line."""


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
    if drive.motor is not None:
        motor = drive.motor
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
        first, *_, last = motor.table.speed
        span = f"{number(first / PER_RPM)} to {number(last / PER_RPM)} rpm"
        return f"{len(motor.table.speed)} rows from {span}"
    assert motor.no_load_speed is not None
    assert motor.stall_torque is not None
    return (
        f"{number(motor.no_load_speed / PER_RPM)} rpm without load, {number(motor.stall_torque)} "
        "N m at standstill"
    )


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
        yield f"  gauge {name}: reads {_reading(gauge)}"
    if not support.mounts:
        yield "  no mounts"


def _mount(mount: Mount) -> Iterator[str]:
    yield _reading(mount) if mount.point is None else f"pushes {_reading(mount)}"
    for value, unit in (
        (mount.stiffness, "N/m"),
        (mount.damping, "N s/m"),
        (mount.torsional_stiffness, "N m/rad"),
        (mount.torsional_damping, "N m s/rad"),
    ):
        if value:
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
