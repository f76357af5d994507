"""Numbers of a machine that designers think in and no file has: each is put into a draft of it.

A further kind of these is a function from a machine to its lifts, in `LIFTS`.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial
from math import pi
from typing import Any

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.errors import EquipoiseError
from equipoise.keys import changed, keys_of
from equipoise.keys.paths import KeyPath
from equipoise.mechanism.assembly.linkage import assemble
from equipoise.mechanism.kinematics.tip import tip_link
from equipoise.mechanism.parts.gears import Gear, closed
from equipoise.mechanism.parts.machine import FRAME, Machine, Vector, size_of
from equipoise.quantities import Dimension

SHORTEST, LONGEST = 0.4, 2.5
"""Limits of a length where none are given, over what it is at the start."""
REACH = 1.5
"""Limits of a coordinate where none are given, over the size of the link."""
ECCENTRIC = (0.0, 0.5)
"""Limits of an eccentricity where none are given."""
DIGITS = 12
"""Decimals of a metre to which moved points are rounded."""
USUAL = ("tip.x", "tip.y", "gears.shape.eccentricity")
GEARS = re.compile(r"gears(?:\[(\d+(?:, *\d+)*)\])?\.(start|shape\..+)")
OF_GEARS: dict[str, Dimension] = {
    "start": "angle",
    "shape.phase": "angle",
    "shape.angle": "angle",
    "shape.radius": "length",
}
"""Dimensions of numbers of gears; others are plain."""
POINTS = re.compile(r"(.+)\.([^.]+)\.(x|y|distance|direction)")
BodyPoints = tuple[tuple[str, str], ...]
"""Bodies with a point of each."""


@dataclass
class Draft:
    """A design in the making.

    machine : with all that is changed but these.
    bodies : places of all points in the axes of their bodies, m.  gears : its gears.
    """

    machine: Machine
    bodies: dict[str, dict[str, complex]]
    gears: list[Gear]


@dataclass(frozen=True)
class Lift:
    """A number that designers think in.

    name : as in the target file.  start : what it is.  low, high : limits where none are given; m,
        rad or plain.
    dimension : None of a plain number.  put : writes a value into a draft.
    gears : places in the list of those that it changes.
    """

    name: str
    start: float
    low: float
    high: float
    dimension: Dimension | None
    put: Callable[[Draft, float], None]
    gears: tuple[int, ...] = ()


def usual(name: str) -> bool:
    """Whether a number varies where nothing is said: lengths, the frame's direction, the tips and
    the shape of gears.
    """
    return "." not in name or name in USUAL


def dimension_of_lift(name: str) -> Dimension | None:
    """What the limits of a number are; None of plain ones."""
    gears = GEARS.fullmatch(name)
    if gears is not None:
        return OF_GEARS.get(gears[2].partition("[")[0])
    return "angle" if name == "ground_angle" or name.endswith(".direction") else "length"


def lifts_of(machine: Machine) -> Iterator[Lift]:
    """Every lift of a machine: lengths, the frame's direction, all coordinates, gears."""
    for kind in LIFTS:
        yield from kind(machine)


def lift_named(machine: Machine, name: str) -> Lift | None:
    """The lift of a machine by its name; None where there is none."""
    try:
        known = {lift.name: lift for lift in lifts_of(machine)}
    except EquipoiseError:  # what cannot be put together has no lifts
        return None
    return known.get(name) or joined(machine, name)


def _lengths(machine: Machine) -> Iterator[Lift]:
    pivot = assemble(machine).pivot
    for body in (FRAME, *machine.links):
        yield from _length(machine, body, pivot)
    yield from _ground_angle(machine, pivot)


def _tips(machine: Machine) -> Iterator[Lift]:
    if machine.planting is None:
        return
    tips = [(tip_link(machine, arm.tip), arm.tip) for arm in machine.planting.every_arm]
    first = machine.links[tips[0][0]].points[tips[0][1]]
    alike = [(link, tip) for link, tip in tips if machine.links[link].points[tip] == first]
    yield from _coordinates(machine, alike, "tip", ("x", "y"))


def _points(machine: Machine) -> Iterator[Lift]:
    for body in (FRAME, *machine.links):
        for point in machine.points_of(body):
            yield from _coordinates(machine, [(body, point)], f"{body}.{point}")


def _gears(machine: Machine) -> Iterator[Lift]:
    numbers = range(len(machine.gears))
    paths = dict.fromkeys(path for gear in machine.gears for path in _numbers(gear))
    for path in paths:
        lifts = [_of_gears(machine, f"gears[{k + 1}].{path}", [k], path) for k in numbers]
        yield from (item for item in lifts if item is not None)
        if len(machine.gears) > 1 and path != "start":
            every = _of_gears(machine, f"gears.{path}", numbers, path)
            yield from () if every is None else (every,)


LIFTS: list[Callable[[Machine], Iterator[Lift]]] = [_lengths, _tips, _points, _gears]
"""The lifts of a machine, of each kind."""


def with_lifts(machine: Machine, values: Sequence[tuple[Lift, float]], **changes: Any) -> Machine:
    """The machine with other values of lifts; places that have moved are rounded to `DIGITS`, and
    tables of gears scaled so that their curves close.

    changes : further fields of the machine.

    Raises
    ------
    EquipoiseError : there is no such machine.
    """
    names = (FRAME, *machine.links)
    bodies = {name: _places(machine.points_of(name)) for name in names}
    draft = Draft(machine, bodies, list(machine.gears))
    for entry, value in values:
        entry.put(draft, float(value))
    machine = draft.machine
    points = {name: _pairs(bodies[name], machine.points_of(name)) for name in names}
    links = {
        name: link if points[name] == dict(link.points) else link.altered(points=points[name])
        for name, link in machine.links.items()
    }
    touched = {number for item, _ in values for number in item.gears}
    gears = tuple(
        closed(gear, points) if number in touched else gear
        for number, gear in enumerate(draft.gears)
    )
    fields_of_draft = {"frame": points[FRAME], "links": links, "gears": gears}
    return replace(machine, **{**fields_of_draft, **changes})


def joined(machine: Machine, name: str) -> Lift | None:
    """A number that several gears or points of a link have together: ``gears[1,3].shape.phase``,
    ``carrier.B,D.distance``; None where there is no such number.
    """
    if gears := GEARS.fullmatch(name):
        numbers = [int(number) - 1 for number in (gears[1] or "").split(",") if number]
        numbers = numbers or [*range(len(machine.gears))]
        return _of_gears(machine, name, numbers, gears[2])
    points = POINTS.fullmatch(name)
    if points is None or points[1] not in (FRAME, *machine.links):
        return None
    places = [(points[1], point.strip()) for point in points[2].split(",")]
    if any(point not in machine.points_of(body) for body, point in places):
        return None
    prefix = name.rpartition(".")[0]
    return next(_coordinates(machine, places, prefix, (points[3],)))


# -- points ----------------------------------------------------------------------------------------


def _pins(machine: Machine, body: str) -> list[str]:
    """Points of a body that another body also has."""
    others = [b for b in (FRAME, *machine.links) if b != body]
    shared = {point for other in others for point in machine.points_of(other)}
    return [point for point in machine.points_of(body) if point in shared]


def _length(machine: Machine, body: str, pivot: str) -> Iterator[Lift]:
    pins = _pins(machine, body)
    if len(pins) != 2:
        return
    base, moved = sorted(pins, key=lambda point: point != pivot)
    points = machine.points_of(body)
    arm = complex(*points[moved]) - complex(*points[base])
    length = abs(arm)

    def put(draft: Draft, value: float) -> None:
        places = draft.bodies[body]
        now = places[moved] - places[base]
        places[moved] = places[base] + now * (value / abs(now))

    yield Lift(body, length, SHORTEST * length, LONGEST * length, "length", put)


def _ground_angle(machine: Machine, pivot: str) -> Iterator[Lift]:
    others = [point for point in _pins(machine, FRAME) if point != pivot]
    if not others:
        return
    arm = complex(*machine.frame[others[0]]) - complex(*machine.frame[pivot])

    def put(draft: Draft, value: float) -> None:
        frame = draft.bodies[FRAME]
        center, now = frame[pivot], frame[others[0]] - frame[pivot]
        turn = np.exp(1j * value) * abs(now) / now
        for point in frame:
            frame[point] = center + complex((frame[point] - center) * turn)

    yield Lift("ground_angle", float(np.angle(arm)), -pi, pi, "angle", put)


def _coordinates(
    machine: Machine,
    places: Sequence[tuple[str, str]],
    name: str,
    parts: Sequence[str] = ("x", "y", "distance", "direction"),
) -> Iterator[Lift]:
    """Numbers of a point, or of several together: directions turn, the rest becomes equal."""
    body, point = places[0]
    points = machine.points_of(body)
    place = complex(*points[point])
    reach = REACH * max(size_of(points), abs(place))
    limits = {"distance": (0.0, reach), "direction": (-pi, pi)}
    for part in parts:
        low, high = limits.get(part, (-reach, reach))
        put = partial(_put_part, tuple(places), part)
        value = float(_part(place, part))
        yield Lift(
            f"{name}.{part}", value, low, high, "angle" if part == "direction" else "length", put
        )


def _part(place: complex, part: str) -> float:
    parts = {"x": place.real, "y": place.imag, "distance": abs(place)}
    return float(np.angle(place)) if part == "direction" else parts[part]


def _put_part(places: BodyPoints, part: str, draft: Draft, value: float) -> None:
    body, point = places[0]
    turn = np.exp(1j * (value - float(np.angle(draft.bodies[body][point]))))
    for body, point in places:
        now = draft.bodies[body][point]
        new = {
            "x": complex(value, now.imag),
            "y": complex(now.real, value),
            "distance": value * np.exp(1j * np.angle(now)),
            "direction": now * turn,
        }
        draft.bodies[body][point] = complex(new[part])


# -- gears -----------------------------------------------------------------------------------------


def _numbers(gear: Gear) -> dict[str, float]:
    """Numbers of a pair of gears that can vary, by path."""
    return dict(_numbered(gear))


def _numbered(gear: Gear) -> Iterator[tuple[str, float]]:
    yield "start", gear.start
    shape = getattr(gear, "shape", None)
    if shape is None:
        return
    for name, key in keys_of(type(shape)).items():
        value = getattr(shape, key.field)
        if isinstance(value, tuple):
            yield from ((f"shape.{name}[{k}]", item) for k, item in enumerate(value, 1))
        elif isinstance(value, float):
            yield f"shape.{name}", value


def _instead(new: float, _: Any) -> float:
    return new


def _of_gears(machine: Machine, name: str, numbers: Sequence[int], path: str) -> Lift | None:
    """A number of some of the gears: angles turn by as much, the rest becomes equal."""
    if any(not 0 <= k < len(machine.gears) for k in numbers):
        return None
    items = [_numbers(machine.gears[k]) for k in numbers]
    if any(path not in item for item in items):
        return None
    values = [item[path] for item in items]
    dimension = dimension_of_lift(name)
    low, high = (-pi, pi) if dimension == "angle" else (-1.0, 1.0)
    low, high = ECCENTRIC if path == "shape.eccentricity" else (low, high)

    def put(draft: Draft, value: float) -> None:
        for k, before in zip(numbers, values, strict=True):
            new = before + value - values[0] if dimension == "angle" else value
            draft.gears[k] = changed(draft.gears[k], KeyPath.parse(path), partial(_instead, new))

    return Lift(name, values[0], low, high, dimension, put, tuple(numbers))


def _places(points: Mapping[str, Vector]) -> dict[str, complex]:
    return {name: complex(*place) for name, place in points.items()}


def _pairs(points: Mapping[str, complex], before: Mapping[str, Vector]) -> dict[str, Vector]:
    """Places of points; those that have moved with so many digits that a file stays readable."""
    return {
        name: old
        if place == complex(*old)
        else (round(place.real, DIGITS), round(place.imag, DIGITS))
        for (name, place), old in zip(points.items(), before.values(), strict=True)
    }
