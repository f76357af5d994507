"""Checks of a machine's values: what contradicts itself, and what no machine can have."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from itertools import pairwise
from math import pi
from typing import TYPE_CHECKING

from equipoise.errors import ModelError
from equipoise.keys import wrong_values

if TYPE_CHECKING:
    from equipoise.mechanism.model import (
        Gear,
        Link,
        Load,
        LoadTable,
        Machine,
        Position,
        Slider,
        Vector,
    )

FRAME = "frame"


MOST = {"links": 100, "points": 2000, "sliders": 200, "gears": 200, "loads": 500}
MOST_SHOWN = 20
"""Names in an error."""
LONGEST_NAME = 200
"""Far beyond any machine; they keep a file of nonsense from running for hours."""

SIDES = ("left", "right", "forward", "backward")


def unknown(given: str, known: Iterable[str], kind: str) -> str:
    """Say that a name is unknown, and what would be right."""
    from difflib import get_close_matches

    names = list(known)
    near = get_close_matches(given, names, 1)
    hint = f"did you mean {near[0]!r}?" if near else f"there are {_listed(names)}"
    return f"no {kind} is called {given!r}; {hint}"


def _listed(names: list[str]) -> str:
    shown = ", ".join(repr(name) for name in names[:MOST_SHOWN]) or "none"
    return shown if len(names) <= MOST_SHOWN else f"{shown} and {len(names) - MOST_SHOWN} more"


def problems(machine: Machine) -> Iterator[ModelError]:
    """Everything that is wrong with the values of a machine, the first things first."""
    yield from _too_much(machine)
    yield from wrong_values("", machine)
    yield from _wrong_points("frame", machine.frame)
    if not machine.links:
        yield ModelError("links", "there is no link; give at least the drive's")
    for name, link in machine.links.items():
        yield from _wrong_link(f"links.{name}", name, link)
    if machine.drive.link not in machine.links:
        yield ModelError("drive.link", unknown(machine.drive.link, machine.links, "link"))
    for number, slider in enumerate(machine.sliders, 1):
        yield from _wrong_slider(f"sliders[{number}]", slider, machine)
    for number, gear in enumerate(machine.gears, 1):
        yield from _wrong_gear(f"gears[{number}]", gear, machine)
    for number, load in enumerate(machine.loads, 1):
        yield from _wrong_load(f"loads[{number}]", load, machine)
    if machine.position is not None:
        yield from _wrong_position(machine.position, machine)


def _too_much(machine: Machine) -> Iterator[ModelError]:
    bodies = {FRAME: machine.frame} | {name: link.points for name, link in machine.links.items()}
    counts = {
        "links": len(machine.links),
        "points": sum(map(len, bodies.values())),
        "sliders": len(machine.sliders),
        "gears": len(machine.gears),
        "loads": len(machine.loads),
    }
    for what, count in counts.items():
        if count > MOST[what]:
            yield ModelError(what, f"got {count}; at most {MOST[what]} are computed with")
    for where, name in [("title", machine.title), *_names(bodies)]:
        yield from wrong_text(where, name)


def wrong_text(where: str, text: str) -> Iterator[ModelError]:
    """Complain of a title or name that cannot be printed."""
    if len(text) > LONGEST_NAME:
        yield ModelError(where, f"{len(text)} characters; give at most {LONGEST_NAME}")
    elif not text.isprintable():
        yield ModelError(where, f"got {text!r}; give printable characters")


def _names(bodies: Mapping[str, Mapping[str, Vector]]) -> Iterator[tuple[str, str]]:
    for body, points in bodies.items():
        yield "links", body
        for point in points:
            yield f"points of {body}", point


def positive(where: str, value: float | None, unit: str) -> Iterator[ModelError]:
    """Complain of a number, where it is given, that is not above 0."""
    if value is not None and value <= 0:
        yield ModelError(where, f"got {value:g} {unit}; give more than 0")


def _wrong_points(where: str, points: Mapping[str, Vector]) -> Iterator[ModelError]:
    if not points:
        yield ModelError(f"{where}.points", "there is no point; give at least one")
    for name in points:
        if not name.strip():
            yield ModelError(f"{where}.points", "a point has an empty name")


def _wrong_link(where: str, name: str, link: Link) -> Iterator[ModelError]:
    if name == FRAME or not name.strip():
        yield ModelError(where, f"a link cannot be called {name!r}; choose another name")
    yield from _wrong_points(where, link.points)
    given = {
        "mass": link.mass,
        "center_of_mass": link.center_of_mass,
        "inertia": link.inertia,
    }
    missing = [key for key, value in given.items() if value is None]
    if 0 < len(missing) < 3:
        yield ModelError(
            where,
            f"{' and '.join(missing)} missing; give mass, center_of_mass and inertia together, "
            "or none of them",
        )
        return
    if link.mass is None or link.inertia is None:
        return
    if link.mass == 0 and link.inertia > 0:
        yield ModelError(
            f"{where}.inertia",
            f"got {link.inertia:g} kg m^2 for a mass of 0; no body can have that, give 0",
        )


def _wrong_body(where: str, name: str, machine: Machine) -> Iterator[ModelError]:
    if name != FRAME and name not in machine.links:
        yield ModelError(where, unknown(name, [FRAME, *machine.links], "link"))


def _wrong_point(where: str, point: str, body: str, machine: Machine) -> Iterator[ModelError]:
    points = machine.points_of(body)
    if point not in points:
        yield ModelError(where, unknown(point, points, f"point of {body}"))


def _wrong_slider(where: str, slider: Slider, machine: Machine) -> Iterator[ModelError]:
    if slider.link not in machine.links:
        yield ModelError(f"{where}.link", unknown(slider.link, machine.links, "link"))
        return
    yield from _wrong_body(f"{where}.on", slider.on, machine)
    if slider.link == slider.on:
        yield ModelError(f"{where}.on", f"{slider.link!r} cannot slide on itself")
    if slider.on == FRAME or slider.on in machine.links:
        yield from _wrong_point(f"{where}.through", slider.through, slider.on, machine)
    yield from _wrong_point(f"{where}.point", slider.point, slider.link, machine)


def _wrong_gear(where: str, gear: Gear, machine: Machine) -> Iterator[ModelError]:
    for key, name in (
        ("between[1]", gear.driver),
        ("between[2]", gear.driven),
        ("carrier", gear.carrier),
    ):
        yield from _wrong_body(f"{where}.{key}", name, machine)
    if len({gear.driver, gear.driven, gear.carrier}) < 3 and not (
        gear.driver != gear.driven and gear.carrier not in (gear.driver, gear.driven)
    ):
        yield ModelError(where, "driver, driven link and carrier must be three different bodies")
    if (gear.ratio is None) == (gear.teeth is None):
        yield ModelError(where, "give either ratio or teeth")
        return
    if gear.teeth is not None and min(gear.teeth) < 1:
        yield ModelError(f"{where}.teeth", f"got {list(gear.teeth)}; give two positive numbers")
    elif gear.speed_ratio in (0.0, 1.0):
        yield ModelError(
            where,
            f"the ratio is {gear.speed_ratio:g}; no pair of gears has that, it would be rigid",
        )


def _wrong_load(where: str, load: Load, machine: Machine) -> Iterator[ModelError]:
    if load.link not in machine.links:
        yield ModelError(f"{where}.link", unknown(load.link, machine.links, "link"))
        return
    if load.point is not None:
        yield from _wrong_point(f"{where}.point", load.point, load.link, machine)
    given = [load.force is not None, load.torque is not None, load.table is not None]
    if sum(given) != 1:
        yield ModelError(where, "give exactly one of force, torque and table")
        return
    forces = load.force is not None or (load.table is not None and len(load.table.values) == 2)
    if forces and load.point is None:
        yield ModelError(f"{where}.point", "missing; a force acts at a point of the link")
    if not forces and load.point is not None:
        yield ModelError(f"{where}.point", "a torque acts on a link, not at a point; leave it out")
    if (load.start is None) != (load.stop is None):
        yield ModelError(where, "give both from and to, or neither")
    elif load.start is not None and load.stop is not None and not _window(load.start, load.stop):
        yield ModelError(
            where, "from and to must differ, by one turn at most; leave both out for always"
        )
    if load.table is not None:
        yield from _wrong_table(f"{where}.table", load.table)


def _window(start: float, stop: float) -> bool:
    return 0 < abs(stop - start) <= 2 * pi * (1 + 1e-12)


def _wrong_table(where: str, table: LoadTable) -> Iterator[ModelError]:
    angles = table.crank_angle
    if not angles:
        yield ModelError(where, "the table has no rows")
        return
    if any(b <= a for a, b in pairwise(angles)):
        yield ModelError(where, "the crank angles must rise from row to row")
    if angles[-1] - angles[0] > 2 * pi * (1 + 1e-12):
        yield ModelError(where, "the crank angles cover more than one turn")
    if any(len(column) != len(angles) for column in table.values):
        yield ModelError(where, "the columns differ in length")


def _wrong_position(position: Position, machine: Machine) -> Iterator[ModelError]:
    known = {point for link in machine.links.values() for point in link.points}
    for point in position.points:
        if point not in known:
            yield ModelError(f"position.points.{point}", unknown(point, known, "point"))
    for link in position.angles:
        if link not in machine.links:
            yield ModelError(f"position.angles.{link}", unknown(link, machine.links, "link"))
