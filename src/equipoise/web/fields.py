"""The numbers of a design that a page shows and changes, each with the way to change it."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from functools import lru_cache, partial
from math import pi
from typing import Any

from equipoise.mechanism.model import Link, Machine, Vector, size_of
from equipoise.mechanism.support import Mount
from equipoise.quantities import format_exact, rounded
from equipoise.quantities.units import KINDS, Dimension
from equipoise.web.design import Design, pin_of

Put = Callable[[Design, float], Design]
FINE = 1000
"""Steps of a slider over its range."""
FREE = 0.5
"""How far from where it was a coordinate's slider reaches, over the size of the machine."""
DIGITS, HANDY = 7, 8
"""Digits that are shown, and signs of a number that nobody would write in another unit."""
CENTER: Vector = (0.0, 0.0)


@dataclass(frozen=True)
class Field:
    """A number: its path, such as ``links.crank.mass``, the heading that it belongs under, its
    label, its value in SI units and radians, and the design with another value.
    """

    path: str
    group: str
    label: str
    dimension: Dimension
    value: float
    put: Put


@dataclass(frozen=True)
class Scale:
    """What the sliders of a design reach: from its values when it was opened, which stay.

    values : by path.  length : size of the machine, m.  mass : of its links, kg.
    """

    values: Mapping[str, float]
    length: float
    mass: float

    @classmethod
    def of(cls, design: Design) -> Scale:
        """The scale of a design that is opened."""
        own = design.own
        bodies = (own.frame, *(link.points for link in own.links.values()))
        values = {path: field.value for path, field in fields_of(design).items()}
        return cls(values, max(map(size_of, bodies)) or 1.0, own.mass or 1.0)

    def ends(self, field: Field) -> tuple[float, float]:
        """Least and largest value on the slider of a number, and its own value in any case."""
        start = self.values.get(field.path, field.value)
        last = field.path.rpartition(".")[2]
        if field.dimension == "angle":
            low, high = -2 * pi, 2 * pi
        elif last in {"x", "y"}:
            low, high = start - FREE * self.length, start + FREE * self.length
        else:
            usual = {"mass": self.mass, "length": self.length}.get(field.dimension, 1.0)
            low, high = sorted((0.0, 2 * start or usual))
        return min(low, field.value), max(high, field.value)

    def told(self, field: Field) -> dict[str, Any]:
        """A number as the page is sent it."""
        low, high = self.ends(field)
        unit = _unit(self.values.get(field.path, field.value), field.dimension)
        return {
            "path": field.path,
            "group": field.group,
            "label": field.label,
            "value": field.value,
            "text": _text(field.value, unit),
            "unit": unit,
            "min": low,
            "max": high,
            "step": (high - low) / FINE,
            "kind": "number",
        }


@lru_cache(4096)
def _unit(start: float, dimension: Dimension) -> str:
    """The unit in which a number is shown, whatever becomes of it: that of the file, if handy."""
    number, _, unit = format_exact(start, dimension).partition(" ")
    return unit if start and len(number) <= HANDY else KINDS[dimension].printed[0]


@lru_cache(8192)
def _text(value: float, unit: str) -> str:
    """Digits are looked for in decimal arithmetic, and most numbers are those of a moment ago."""
    return rounded(value, unit, DIGITS)


def fields_of(design: Design) -> dict[str, Field]:
    """Every number by its path, in the order in which a page shows them."""
    parts = (_drive, _links, _frame, _gears, _springs, _rows, _planting, _mounts)
    found = [field for part in parts for field in part(design.own)]
    return {field.path: field for field in (*found, *_weights(design))}


def _on_machine(put: Callable[[Machine, float], Machine]) -> Put:
    return lambda design, value: design.with_machine(put(design.own, value))


def _drive(machine: Machine) -> Iterator[Field]:
    put = _on_machine(lambda one, value: one.with_drive(speed=value))
    yield Field("drive.speed", "drive", "speed", "angular speed", machine.drive.speed, put)


def _links(machine: Machine) -> Iterator[Field]:
    for name, link in machine.links.items():
        where, group = f"links.{name}", name
        if link.mass is not None and link.inertia is not None:
            quantity: tuple[tuple[str, Dimension, float], ...] = (
                ("mass", "mass", link.mass),
                ("inertia", "inertia", link.inertia),
            )
            for key, dimension, value in quantity:
                put = _on_machine(partial(_with_quantity, name, key))
                yield Field(f"{where}.{key}", group, key, dimension, value, put)
            for axis, value in zip("xy", link.center_of_mass or CENTER, strict=True):
                put = _on_machine(partial(_with_center, name, axis))
                path, label = f"{where}.center_of_mass.{axis}", f"centre of mass, {axis}"
                yield Field(path, group, label, "length", value, put)
        for point, place in link.points.items():
            for axis, value in zip("xy", place, strict=True):
                put = _on_machine(partial(_with_point, name, point, axis))
                path = f"{where}.points.{point}.{axis}"
                yield Field(path, group, f"{point}, {axis}", "length", value, put)


def _with_quantity(name: str, key: str, machine: Machine, value: float) -> Machine:
    return machine.with_link(name, **{key: value})


def _with_center(name: str, axis: str, machine: Machine, value: float) -> Machine:
    old = machine.links[name].center_of_mass or CENTER
    return machine.with_link(name, center_of_mass=_turned_to(old, axis, value))


def _with_point(name: str, point: str, axis: str, machine: Machine, value: float) -> Machine:
    link: Link = machine.links[name]
    place = _turned_to(link.points[point], axis, value)
    return machine.with_link(name, points={**link.points, point: place})


def _turned_to(place: Vector, axis: str, value: float) -> Vector:
    return (value, place[1]) if axis == "x" else (place[0], value)


def _frame(machine: Machine) -> Iterator[Field]:
    for point, place in machine.frame.items():
        for axis, value in zip("xy", place, strict=True):
            put = _on_machine(partial(_with_frame_point, point, axis))
            path = f"frame.points.{point}.{axis}"
            yield Field(path, "frame", f"{point}, {axis}", "length", value, put)


def _with_frame_point(point: str, axis: str, machine: Machine, value: float) -> Machine:
    place = _turned_to(machine.frame[point], axis, value)
    return replace(machine, frame={**machine.frame, point: place})


def _gears(machine: Machine) -> Iterator[Field]:
    for number, gear in enumerate(machine.gears, 1):
        put = _on_machine(partial(_with_item, "gears", number, "start"))
        label = f"{gear.name}, angle of {gear.driven} at the start"
        yield Field(f"gears.{number}.start", "gears", label, "angle", gear.start, put)


def _springs(machine: Machine) -> Iterator[Field]:
    for number, spring in enumerate(machine.springs, 1):
        quantities: tuple[tuple[str, Dimension], ...] = (
            ("stiffness", "stiffness"),
            ("free_length", "length"),
        )
        for key, dimension in quantities:
            put = _on_machine(partial(_with_item, "springs", number, key))
            label = f"{spring.point} to {spring.to}, {key.replace('_', ' ')}"
            path = f"springs.{number}.{key}"
            yield Field(path, "springs", label, dimension, getattr(spring, key), put)


def _rows(machine: Machine) -> Iterator[Field]:
    for number, row in enumerate(machine.rows, 1):
        put = _on_machine(partial(_with_item, "rows", number, "phase"))
        label = f"row {number}, phase"
        yield Field(f"rows.{number}.phase", "rows", label, "angle", row.phase, put)


def _with_item(kind: str, number: int, key: str, machine: Machine, value: float) -> Machine:
    items = list(getattr(machine, kind))
    items[number - 1] = replace(items[number - 1], **{key: value})
    if kind == "gears":
        return replace(machine, gears=tuple(items))
    return machine.with_rows(items) if kind == "rows" else machine.with_springs(items)


PLANTING: dict[str, Dimension] = {
    "forward_speed": "speed",
    "hill_spacing": "length",
    "depth": "length",
    "surface": "length",
}


def _planting(machine: Machine) -> Iterator[Field]:
    for key, dimension in PLANTING.items():
        value = getattr(machine.planting, key, None)
        if value is not None:
            put = _on_machine(partial(_with_planting, key))
            label = key.replace("_", " ")
            yield Field(f"planting.{key}", "planting", label, dimension, value, put)


def _with_planting(key: str, machine: Machine, value: float) -> Machine:
    return machine.with_planting(**{key: value})


MOUNTS: dict[str, Dimension] = {
    "stiffness": "stiffness",
    "damping": "damping",
    "torsional_stiffness": "torsional stiffness",
    "torsional_damping": "torsional damping",
}


def _mounts(machine: Machine) -> Iterator[Field]:
    if machine.support is None:
        return
    for name, mount in machine.support.mounts.items():
        for key, dimension in MOUNTS.items():
            if (mount.axis is None) != key.startswith("torsional"):
                put = _on_machine(partial(_with_mount, name, key))
                path, label = f"support.mounts.{name}.{key}", f"{name}, {key.replace('_', ' ')}"
                yield Field(path, "support", label, dimension, getattr(mount, key), put)


def _with_mount(name: str, key: str, machine: Machine, value: float) -> Machine:
    assert machine.support is not None
    mounts = machine.support.mounts
    changed: Mount = replace(mounts[name], **{key: value})  # type: ignore[arg-type]
    return machine.with_support(mounts={**mounts, name: changed})


def _weights(design: Design) -> Iterator[Field]:
    """Counterweights of links that are pinned to the frame and have their masses given."""
    quantities: tuple[tuple[str, Dimension], ...] = (
        ("mass", "mass"),
        ("radius", "length"),
        ("direction", "angle"),
    )
    for name, link in design.own.links.items():
        pin = pin_of(design.own, name)
        if pin is None or link.mass is None:
            continue
        weight = design.weight_on(name)
        for key, dimension in quantities:
            put = partial(_with_weight, name, key)
            path = f"counterweights.{name}.{key}"
            group = f"counterweight on {name}"
            yield Field(path, group, f"{key}, from {pin}" if key == "radius" else key, dimension,
                        getattr(weight, key), put)  # fmt: skip


def _with_weight(link: str, key: str, design: Design, value: float) -> Design:
    old = design.weight_on(link)
    return design.with_weight(link, replace(old, **{key: value}))
