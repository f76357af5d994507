"""Which numbers of a machine a search may change, and the machine that other numbers give."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from math import pi
from typing import Literal

import numpy as np

from equipoise.errors import UsageError
from equipoise.mechanism.linkage import assemble
from equipoise.mechanism.model import FRAME, Machine, Vector, size_of, unknown
from equipoise.mechanism.tip import planting_of, tip_link
from equipoise.signals import Array

Bodies = dict[str, dict[str, complex]]
Sense = Literal["as given", "counterclockwise", "clockwise", "either"]

SHORTEST, LONGEST = 0.4, 2.5
"""Limits of a length where none are given, over what it is at the start."""
DIGITS = 12
"""Decimals of a metre to which moved points are rounded."""
REACH = 1.5
"""Limits of a coordinate where none are given, over the size of the link."""


@dataclass(frozen=True)
class Variable:
    """A number that may change.

    name : as in the target file.  start, low, high : m or rad.
    dimension : "length" or "angle".  put : writes a value into the places of all points.
    """

    name: str
    start: float
    low: float
    high: float
    dimension: Literal["length", "angle"]
    put: Callable[[Bodies, float], None]


class Designs:
    """Machines that differ from one in some numbers.

    vary : names of numbers with their limits, m or rad; None for all lengths between the joints
        of links with two joints, the direction of the frame, and both coordinates of the tip.
    sense : in which the crank turns.  Where it is "either", a last number tells: below 0
        clockwise.
    """

    def __init__(
        self,
        machine: Machine,
        vary: Mapping[str, tuple[float, float]] | None = None,
        sense: Sense = "as given",
    ) -> None:
        self.machine, self.sense = machine, sense
        known = {variable.name: variable for variable in _variables(machine)}
        usual = [name for name in known if "." not in name or name in ("tip.x", "tip.y")]
        names = usual if vary is None else list(vary)
        if not names:
            raise UsageError("vary: names nothing; name at least one number, or leave it out")
        for name in names:
            if name not in known:
                raise UsageError(f"vary.{name}: {unknown(name, known, 'number to vary')}")
        self.variables = [
            known[name] if vary is None else _within(known[name], *vary[name]) for name in names
        ]

    @property
    def bounds(self) -> tuple[Array, Array]:
        """Lowest and highest values, (n,) each."""
        low = [variable.low for variable in self.variables]
        high = [variable.high for variable in self.variables]
        turning = [1.0] if self.sense == "either" else []
        return np.array([*low, *(-t for t in turning)]), np.array([*high, *turning])

    @property
    def start(self) -> Array:
        """Values of the machine itself, inside the limits, (n,)."""
        values = [variable.start for variable in self.variables]
        turning = [np.sign(self.machine.drive.speed)] if self.sense == "either" else []
        start: Array = np.clip([*values, *turning], *self.bounds)
        return start

    def build(self, values: Sequence[float] | Array) -> Machine:
        """The machine that has these values; places that have moved are rounded to `DIGITS`."""
        machine = self.machine
        names = (FRAME, *machine.links)
        bodies = {name: _places(machine.points_of(name)) for name in names}
        for variable, value in zip(self.variables, values, strict=False):
            variable.put(bodies, float(value))
        points = {name: _pairs(bodies[name], machine.points_of(name)) for name in names}
        links = {
            name: link if points[name] == dict(link.points) else link.altered(points=points[name])
            for name, link in machine.links.items()
        }
        size = abs(machine.drive.speed)
        speed = {
            "as given": machine.drive.speed,
            "counterclockwise": size,
            "clockwise": -size,
            "either": size if values[-1] >= 0 else -size,
        }[self.sense]
        drive = replace(machine.drive, speed=speed)
        return replace(machine, frame=points[FRAME], links=links, drive=drive)


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


def _within(variable: Variable, low: float, high: float) -> Variable:
    if not low < high:
        raise UsageError(f"vary.{variable.name}: the first limit must be below the second")
    if variable.dimension == "length" and variable.name.count(".") == 0 and low <= 0:
        raise UsageError(f"vary.{variable.name}: a length must stay above 0")
    return replace(variable, low=low, high=high)


def _variables(machine: Machine) -> Iterator[Variable]:
    """Every number that can be varied: lengths, the frame's direction, all coordinates."""
    pivot = assemble(machine).pivot
    bodies = (FRAME, *machine.links)
    for body in bodies:
        yield from _length(machine, body, pivot)
    yield from _ground_angle(machine, pivot)
    planting = planting_of(machine)
    tip = (tip_link(machine), planting.tip)
    yield from _coordinates(machine, *tip, name="tip")
    for body in bodies:
        for point in machine.points_of(body):
            yield from _coordinates(machine, body, point, name=f"{body}.{point}")


def _pins(machine: Machine, body: str) -> list[str]:
    """Points of a body that another body also has."""
    others = [b for b in (FRAME, *machine.links) if b != body]
    shared = {point for other in others for point in machine.points_of(other)}
    return [point for point in machine.points_of(body) if point in shared]


def _length(machine: Machine, body: str, pivot: str) -> Iterator[Variable]:
    pins = _pins(machine, body)
    if len(pins) != 2:
        return
    base, moved = sorted(pins, key=lambda point: point != pivot)
    points = machine.points_of(body)
    arm = complex(*points[moved]) - complex(*points[base])
    length = abs(arm)

    def put(bodies: Bodies, value: float) -> None:
        now = bodies[body][moved] - bodies[body][base]
        bodies[body][moved] = bodies[body][base] + now * (value / abs(now))

    yield Variable(body, length, SHORTEST * length, LONGEST * length, "length", put)


def _ground_angle(machine: Machine, pivot: str) -> Iterator[Variable]:
    others = [point for point in _pins(machine, FRAME) if point != pivot]
    if not others:
        return
    arm = complex(*machine.frame[others[0]]) - complex(*machine.frame[pivot])

    def put(bodies: Bodies, value: float) -> None:
        frame = bodies[FRAME]
        center, now = frame[pivot], frame[others[0]] - frame[pivot]
        turn = np.exp(1j * value) * abs(now) / now
        for point in frame:
            frame[point] = center + complex((frame[point] - center) * turn)

    yield Variable("ground_angle", float(np.angle(arm)), -pi, pi, "angle", put)


def _coordinates(machine: Machine, body: str, point: str, name: str) -> Iterator[Variable]:
    points = machine.points_of(body)
    place = points[point]
    reach = REACH * max(size_of(points), abs(complex(*place)))
    for axis, value in zip("xy", place, strict=True):

        def put(bodies: Bodies, value: float, axis: str = axis) -> None:
            now = bodies[body][point]
            x, y = (value, now.imag) if axis == "x" else (now.real, value)
            bodies[body][point] = complex(x, y)

        yield Variable(f"{name}.{axis}", value, -reach, reach, "length", put)
