"""Designs of one machine side by side: some of its numbers are columns, one row a design.

Everything that puts a linkage together from numbers (`mechanism.linkage`) works on columns as well
as on numbers.  So the steps of all designs are made in one go.  What a single machine is refused
for is here a design of which `wrong` is true.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from typing import Any, TypeVar

import numpy as np

from equipoise.errors import UsageError
from equipoise.mechanism.builder import planar
from equipoise.mechanism.checks import HUGE
from equipoise.mechanism.linkage import Linkage, ordered
from equipoise.mechanism.model import FRAME, Machine, Vector

Array = np.ndarray[Any, Any]
Columns = Mapping[str, Array]
"""Path of a number -> its values (P, 1), SI units."""
Value = TypeVar("Value")

PAIR = r"\.(?P<part>x|y|distance|direction)"
NUMBERS = {
    "drive": re.compile(r"drive\.(?P<key>speed|acceleration)"),
    "gravity": re.compile(rf"gravity{PAIR}"),
    "frame": re.compile(rf"frame\.points\.(?P<point>.+){PAIR}"),
    "point": re.compile(rf"links\.(?P<link>.+?)\.points\.(?P<point>.+){PAIR}"),
    "center": re.compile(rf"links\.(?P<link>.+)\.center_of_mass{PAIR}"),
    "mass": re.compile(r"links\.(?P<link>.+)\.(?P<key>mass|inertia)"),
    "slider": re.compile(r"sliders\[(?P<number>\d+)\]\.(?P<key>direction|angle)"),
    "gear": re.compile(r"gears\[(?P<number>\d+)\]\.(?P<key>start|pressure_angle)"),
    "spring": re.compile(r"springs\[(?P<number>\d+)\]\.(?P<key>stiffness|free_length)"),
}
"""Numbers that may be columns, by their path in the model file."""


def can_vary(machine: Machine, path: str) -> bool:
    """Whether a number of a machine, by its path in the model file, may be a column."""
    try:
        with_columns(machine, {path: np.ones((1, 1))})
    except UsageError:
        return False
    return True


def with_columns(machine: Machine, columns: Columns) -> Machine:
    """A machine some of whose numbers are columns.

    It passes no checks and serves `linkage_of` alone.  Polar parts of one point are put in before
    x and y, so that each stands where it was given.

    Raises
    ------
    UsageError : there is no such number, or it cannot be a column.
    """
    result = machine
    for path in sorted(columns, key=lambda path: path.endswith((".x", ".y"))):
        result = _put(result, path, columns[path])
    return result


def linkage_of(machine: Machine, base: Linkage) -> Linkage:
    """The linkage of a machine with columns, in the order in which its base is solved."""
    joints = replace(base.joints, sliders=machine.sliders, gears=machine.gears)
    with np.errstate(all="ignore"):
        return ordered(machine, joints)


def wrong(machine: Machine, base: Linkage, count: int) -> Array:
    """Which of the designs (P,) no machine can have: the checks of `Machine`, on columns."""
    found = np.zeros((count, 1), dtype=bool)
    for right in _demands(machine, base):
        found |= np.logical_not(right)
    return found[:, 0]


def _demands(machine: Machine, base: Linkage) -> Iterator[Any]:
    """What has to be true of the numbers of a machine: flags, or columns of them."""
    for body in (FRAME, *machine.links):
        points = machine.points_of(body)
        places = [planar(points[point]) for point in points if point in base.joints.pins]
        for k, place in enumerate(places):
            yield abs(place) < HUGE
            yield from (place != other for other in places[:k])
    for link in machine.links.values():
        if link.mass is not None and link.center_of_mass is not None and link.inertia is not None:
            yield (link.mass >= 0) & (link.mass < HUGE)
            yield (link.inertia >= 0) & (link.inertia < HUGE)
            yield (link.mass > 0) | (np.asarray(link.inertia) == 0)
            yield abs(planar(link.center_of_mass)) < HUGE
    for spring in machine.springs:
        yield (spring.stiffness > 0) & (spring.stiffness < HUGE)
        yield (spring.free_length >= 0) & (np.asarray(spring.free_length) < HUGE)
    numbers = [machine.drive.speed, machine.drive.acceleration, *machine.gravity]
    numbers += [number for slider in machine.sliders for number in (slider.direction, slider.angle)]
    numbers += [number for gear in machine.gears for number in (gear.start, gear.pressure_angle)]
    yield from (np.abs(number) < HUGE for number in numbers)


# -- putting a column in ---------------------------------------------------------------------------


def _put(machine: Machine, path: str, column: Array) -> Machine:
    for kind, pattern in NUMBERS.items():
        found = pattern.fullmatch(path)
        if found is not None:
            try:
                return _PUT[kind](machine, found, column)
            except (KeyError, IndexError, TypeError):
                break
    raise UsageError(f"got {path!r}; the machine has no such number that can be a column")


def _drive(machine: Machine, found: re.Match[str], column: Array) -> Machine:
    return _with(machine, drive=_with(machine.drive, **{found["key"]: column}))


def _gravity(machine: Machine, found: re.Match[str], column: Array) -> Machine:
    return _with(machine, gravity=_pair(machine.gravity, found["part"], column))


def _frame(machine: Machine, found: re.Match[str], column: Array) -> Machine:
    place = _pair(machine.frame[found["point"]], found["part"], column)
    return _with(machine, frame={**machine.frame, found["point"]: place})


def _point(machine: Machine, found: re.Match[str], column: Array) -> Machine:
    points = machine.links[found["link"]].points
    place = _pair(points[found["point"]], found["part"], column)
    return _with_link(machine, found["link"], points={**points, found["point"]: place})


def _center(machine: Machine, found: re.Match[str], column: Array) -> Machine:
    center = machine.links[found["link"]].center_of_mass
    if center is None:
        raise KeyError(found["link"])
    return _with_link(machine, found["link"], center_of_mass=_pair(center, found["part"], column))


def _mass(machine: Machine, found: re.Match[str], column: Array) -> Machine:
    if machine.links[found["link"]].mass is None:
        raise KeyError(found["link"])
    return _with_link(machine, found["link"], **{found["key"]: column})


def _listed(name: str) -> Callable[[Machine, re.Match[str], Array], Machine]:
    def put(machine: Machine, found: re.Match[str], column: Array) -> Machine:
        values, place = list(getattr(machine, name)), int(found["number"]) - 1
        if place < 0:
            raise IndexError
        values[place] = _with(values[place], **{found["key"]: column})
        return _with(machine, **{name: tuple(values)})

    return put


_PUT: dict[str, Callable[[Machine, re.Match[str], Array], Machine]] = {
    "drive": _drive,
    "gravity": _gravity,
    "frame": _frame,
    "point": _point,
    "center": _center,
    "mass": _mass,
    "slider": _listed("sliders"),
    "gear": _listed("gears"),
    "spring": _listed("springs"),
}


def _pair(place: Vector, part: str, column: Array) -> tuple[Any, Any]:
    """A pair with one of its two coordinates, or polar coordinates, replaced."""
    x, y = place
    if part in "xy":
        return (column, y) if part == "x" else (x, column)
    distance, direction = np.hypot(x, y), np.arctan2(y, x)
    if part == "distance":
        distance = column
    else:
        direction = column
    return distance * np.cos(direction), distance * np.sin(direction)


def _with(value: Value, **changes: Any) -> Value:
    """A frozen value with fields changed, unchecked; what was kept with it is left behind."""
    result = object.__new__(type(value))
    kept = {key: item for key, item in vars(value).items() if not key.startswith("_")}
    result.__dict__.update(kept, **changes)
    return result


def _with_link(machine: Machine, name: str, **changes: Any) -> Machine:
    return _with(machine, links={**machine.links, name: _with(machine.links[name], **changes)})
