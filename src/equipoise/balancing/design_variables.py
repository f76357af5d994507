"""What is free to change, as numbers of a cone program with what they do to the links.

Every part adds scaled numbers to the program, keeps them within its limits, says what a unit of
each does to its link's inertial parameters, and reads the result back.  Where a number has to be
the square of another over a third (the inertia of a mass that may move), the program can only keep
it above; such squares are marked, and `branch_and_bound` makes equalities of them.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import field, replace
from math import hypot, inf

import numpy as np

from equipoise.balancing.branch_and_bound import Square
from equipoise.balancing.program import Affine, Program, stacked
from equipoise.balancing.workshop import Change
from equipoise.dataclass import dataclass
from equipoise.i18n import Note
from equipoise.mechanism.assembly.steps import size_of_bodies
from equipoise.mechanism.dynamics.parameters import (
    parameter_values,
    parameters_of,
    spring_units,
)
from equipoise.mechanism.kinematics.motion import Motion
from equipoise.mechanism.parts.balance import CenterMove, SpringChoice
from equipoise.mechanism.parts.machine import Link, Machine
from equipoise.mechanism.parts.springs import Spring
from equipoise.signals import Array

ROUNDING = 1e-14
"""Over a moment of inertia: what is left of it about the centre of mass that is rounding."""
SAME = 1e-12
"""Over mass, moments and inertia of a link: a difference that is rounding."""


@dataclass(frozen=True)
class Bound:
    """A limit that a part has of itself: its name in the program, and what of it is used; SI."""

    name: str
    at_most: float
    used: float
    unit: str


@dataclass(frozen=True, eq=False)
class LinkParameters:
    """Mass, first moments and inertia of a link about its origin, as they are."""

    link: str
    count: int = 4
    effect: Array = field(default_factory=lambda: np.eye(4))
    plane: float | None = None


class DesignVariables(ABC):
    """Numbers that are free, of one link.

    count : how many.  mass_place : which of them is an added mass (and its unit, kg), or None.
    plane : z of where their masses are, m; that of the link where it is None.
    """

    link: str
    count: int
    mass_place: int | None = None
    mass_unit: float = 1.0
    plane: float | None = None

    @property
    @abstractmethod
    def effect(self) -> Array:
        """(count, 4) mass, first moments and inertia about the link's origin for a unit of each."""

    @abstractmethod
    def constrain(self, program: Program, places: Array) -> list[Square]:
        """Keep the numbers at their places within their limits."""

    def project_feasible(self, numbers: Array, matters: Array) -> Array:
        """The numbers (count,), with squares made equal, and inertia least where it does nothing.

        matters : (count,) whether each number changes anything that is asked.
        """
        return numbers

    def minimize_added_mass(self, numbers: Array, matters: Array) -> Array:
        """Numbers that do the same with the least mass."""
        return numbers

    def bounds(self, numbers: Array) -> list[Bound]:
        """Limits that have a price."""
        return []

    def stopped(self, numbers: Array) -> Note | None:
        """Note on a number that has reached a limit of its own; None where none has."""
        return None

    @abstractmethod
    def changes(self, numbers: Array) -> list[Change]:
        """What the numbers (count,) mean."""


def with_parameters(machine: Machine, link: str, values: Array) -> Machine:
    """The machine with mass, first moments and inertia of a link about its origin."""
    body = machine.links[link]
    if body.bodies and (new_body := _made_of(body, values)) is not None:
        return machine.with_link(link, bodies=new_body.bodies)
    mass, x, y, inertia = (float(value) for value in values)
    if mass <= 0:
        return machine.with_link(link, mass=0.0, center_of_mass=(0.0, 0.0), inertia=0.0)
    center = (x / mass, y / mass)
    own = inertia - (x * x + y * y) / mass
    own = own if own > ROUNDING * inertia else 0.0
    return machine.with_link(link, mass=mass, center_of_mass=center, inertia=own)


def _made_of(body: Link, values: Array) -> Link | None:
    """A link of bodies with one more of them that makes up for a difference in its parameters, if a
    body can.
    """
    own = np.array(parameters_of(body))
    mass, x, y, inertia = (float(value) for value in values - own)
    if np.all(abs(values - own) <= SAME * abs(own)):
        return body
    if mass <= SAME * own[0]:
        return None
    central_inertia = inertia - (x * x + y * y) / mass
    if central_inertia < -SAME * values[3]:
        return None
    return body.with_added(
        mass, (x / mass, y / mass), central_inertia if central_inertia > SAME * values[3] else 0.0
    )


class MovedCenter(DesignVariables):
    """The centre of mass of a link, moved: its coordinates over a length, and their squares.

    The machine that it starts from has the centre in the link's origin.
    """

    count = 4

    def __init__(self, machine: Machine, move: CenterMove) -> None:
        body = machine.links[move.link]
        assert body.mass is not None and body.center_of_mass is not None
        self.link, self.move = move.link, move
        self.mass, self.before = body.mass, body.center_of_mass
        limits = [*(move.x or ()), *(move.y or ()), *(move.center or ()), move.radius or 0.0]
        sizes = [hypot(*point) for point in body.points.values()] + [abs(x) for x in limits]
        self.length = max(sizes) or float(size_of_bodies(machine))

    @property
    def effect(self) -> Array:
        first, second = self.mass * self.length, self.mass * self.length**2
        return np.array([[0, first, 0, 0], [0, 0, first, 0], [0, 0, 0, second], [0, 0, 0, second]])

    def constrain(self, program: Program, places: Array) -> list[Square]:
        squares = []
        for k in (0, 1):
            low, high = self._box(k)
            square = Square(int(places[2 + k]), int(places[k]), None, low, high)
            square.keep_above(program)
            square.keep_between(program, low, high)
            squares.append(square)
        if self.move.center is not None and self.move.radius is not None:
            center = Affine.of(places[:2], np.eye(2), -np.array(self.move.center) / self.length)
            circle = stacked(Affine.fixed(self.move.radius / self.length), center)
            slope = Affine.fixed([1 / self.length, 0.0, 0.0])
            program.cones(circle, 3, self._room, slope)
        return squares

    def _box(self, axis: int) -> tuple[float, float]:
        """Limits of a coordinate, over the length."""
        given = (self.move.x, self.move.y)[axis]
        if given is not None:
            return given[0] / self.length, given[1] / self.length
        if self.move.center is not None and self.move.radius is not None:
            middle, reach = self.move.center[axis], self.move.radius
            return (middle - reach) / self.length, (middle + reach) / self.length
        return -inf, inf

    def project_feasible(self, numbers: Array, matters: Array) -> Array:
        before = np.array(self.before) / self.length
        place = np.where(matters[:2] | matters[2:], numbers[:2], before)  # else it may stay
        return np.concatenate([place, place**2])

    @property
    def _room(self) -> str:
        return Note("room of {link}'s centre of mass", link=self.link)

    def bounds(self, numbers: Array) -> list[Bound]:
        if self.move.center is None or self.move.radius is None:
            return []
        away = hypot(*(numbers[:2] * self.length - np.array(self.move.center)))
        return [Bound(self._room, self.move.radius, float(away), "m")]

    def changes(self, numbers: Array) -> list[Change]:
        x, y = (numbers[:2] * self.length).tolist()
        values = {"from": self.before, "to": (x, y), "mass": self.mass}
        return [Change("center of mass", self.link, values)]


NOTHING = 1e-6
"""Over the most: stiffness, and its product with the free length, that are none."""
REACHED = 1 - 1e-3
"""Share of a default limit from which a result has come up to it, as programs stop a little short
of what they minimise."""
LONGEST = 2.0
"""Free length over the largest distance of points, where none is given: longer and softer springs
would pull ever more evenly, and have no end."""


class FreeSpring(DesignVariables):
    """Two numbers: stiffness over the most, and stiffness times free length over the most times a
    length.
    """

    count = 2

    def __init__(self, machine: Machine, choice: SpringChoice, where: str) -> None:
        """where : place of the choice in the file."""
        self.link, self.choice, self.where = choice.link, choice, where
        place = complex(*machine.frame[choice.to])
        sizes = [abs(complex(*p) - place) for p in machine.frame.values()]
        sizes += [abs(complex(*p)) for p in machine.links[choice.link].points.values()]
        self.length = max(choice.free_length or sizes) or 1.0

    @property
    def effect(self) -> Array:
        return np.zeros((2, 4))

    @property
    def _units(self) -> Array:
        """Stiffness, N/m, and constant pull, N, of a unit of each number."""
        return np.array([self.choice.stiffness, self.choice.stiffness * self.length])

    def constrain(self, program: Program, places: Array) -> list[Square]:
        k, pull = map(int, places)
        slope = Affine.fixed(1 / self.choice.stiffness)
        program.nonnegative(Affine.of(k, 1.0))
        program.nonnegative(Affine.of(k, -1.0, 1.0), self._name, slope)
        low, high = self.choice.free_length or (0.0, LONGEST * self.length)
        program.nonnegative(Affine.of([k, pull], [-low / self.length, 1.0]))
        program.nonnegative(Affine.of([k, pull], [high / self.length, -1.0]))
        return []

    @property
    def _name(self) -> str:
        return Note("stiffness on {link}", link=self.link)

    def bounds(self, numbers: Array) -> list[Bound]:
        most = self.choice.stiffness
        return [Bound(self._name, most, float(numbers[0]) * most, "N/m")]

    def stopped(self, numbers: Array) -> Note | None:
        longest = LONGEST * float(numbers[0])
        if self.choice.free_length is not None or not 0 < REACHED * longest < float(numbers[1]):
            return None
        return Note(
            "the free length of the spring on {link} has reached the default limit of twice the "
            "largest distance between points; give free_length",
            link=self.link,
        )

    def pulls(self, motion: Motion) -> Array:
        """Force (2, N) on the link's point, of a unit of each number."""
        choice = self.choice
        units = self._units * np.array([1.0, -1.0])
        values = spring_units(motion, choice.link, choice.point, choice.to, self.where)
        return np.asarray(values * units[:, None])

    def spring(self, numbers: Array) -> Spring | None:
        """The spring, or None where there is to be none."""
        stiffness, pull = numbers * self._units
        if np.max(numbers) < NOTHING:
            return None
        choice = self.choice
        free = float(pull / stiffness)
        free = free if free > NOTHING * self.length else 0.0
        return Spring(choice.link, choice.point, choice.to, float(stiffness), free)

    def changes(self, numbers: Array) -> list[Change]:
        spring = self.spring(numbers)
        sizes = (0.0, 0.0) if spring is None else (spring.stiffness, spring.free_length)
        values = {"point": self.choice.point, "to": self.choice.to}
        sized = {"stiffness": sizes[0], "free_length": sizes[1]}
        return [Change("spring", self.link, values | sized)]


# -- the machine that numbers make -----------------------------------------------------------------


def with_numbers(machine: Machine, each: Sequence[tuple[DesignVariables, Array]]) -> Machine:
    """The machine with what the numbers of each part make of its link, and with its springs."""
    springs, other_springs = list(machine.springs), []
    values = dict(zip(machine.links, parameter_values(machine).reshape(-1, 4), strict=True))
    changed: dict[str, Array] = {}
    for part, own in each:
        if isinstance(part, FreeSpring):
            springs += filter(None, [part.spring(own)])
        elif part.plane in (None, machine.links[part.link].plane):
            before = changed.get(part.link, values[part.link])
            changed[part.link] = before + own @ part.effect
        else:
            other_springs.append((part, own))
    added = len(springs) > len(machine.springs)
    for link, parameters in changed.items():
        machine = with_parameters(machine, link, parameters)
    for part, own in other_springs:
        machine = _with_mass_beside(machine, part, own)
    return replace(machine, springs=tuple(springs)) if added else machine


def _with_mass_beside(machine: Machine, part: DesignVariables, numbers: Array) -> Machine:
    """The machine with the mass of a part that lies beside the plane of its link."""
    mass, x, y, inertia = (float(value) for value in numbers @ part.effect)
    if mass <= 0:
        return machine
    own = inertia - (x * x + y * y) / mass
    own = own if own > ROUNDING * inertia else 0.0
    link = machine.links[part.link].with_added(mass, (x / mass, y / mass), own, part.plane)
    return machine.with_link(part.link, bodies=link.bodies)
