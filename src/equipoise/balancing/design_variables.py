"""What is free to change, as numbers of a cone program with what they do to the links.

Every part adds scaled numbers to the program, keeps them within its limits, says what a unit of
each does to its link's inertial parameters, and reads the result back.  Where a number has to be
the square of another over a third (the inertia of a mass that may move), the program can only keep
it above; such squares are marked, and `branch_and_bound` makes equalities of them.

Masses added about a point of a link have a shape, whose dimensions come back.  Mass is scaled by
`unit`, lengths by `reach`.  With m the mass, s the first moment and I the moment of inertia about
the centre of the room of radius R:

    any      |s|^2 <= m I, I <= R^2 m: every distribution in the room, and nothing else
    point    I = |s|^2 / m, |s| <= R m
    disc     I = |s|^2 / m + m^2 / (2 pi rho t), |s| + m^(3/2) / sqrt(pi rho t) <= R m
    ring     s = 0, I = m r^2 + m^2 / (2 pi rho t), with r its inner radius
    sector   I = m (R^2 + r^2) / 2, |s| <= c sin(m / d): parts of a ring from r to R, with
             c = 2/3 rho t (R^3 - r^3) and d = rho t (R^2 - r^2)
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import field, replace
from math import asin, cos, hypot, inf, isfinite, pi, sin, sqrt

import numpy as np

from equipoise.balancing.branch_and_bound import Square
from equipoise.balancing.program import Affine, ConeRows, Program, stacked
from equipoise.balancing.rounding import TINY
from equipoise.balancing.workshop import SPREAD, Change, pieces_of
from equipoise.dataclass import dataclass
from equipoise.i18n import Note, to_say
from equipoise.mechanism.assembly.steps import size_of_bodies
from equipoise.mechanism.dynamics.parameters import (
    parameter_values,
    parameters_of,
    spring_units,
)
from equipoise.mechanism.kinematics.motion import Motion
from equipoise.mechanism.parts.balance import CenterMove, SpringChoice, Weight, largest_mass
from equipoise.mechanism.parts.machine import Link, Machine, Vector, size_of
from equipoise.mechanism.parts.springs import Spring
from equipoise.signals import Array

ROUNDING = 1e-14
"""Over a moment of inertia: what is left of it about the centre of mass that is rounding."""
SAME = 1e-12
"""Over mass, moments and inertia of a link: a difference that is rounding."""
NOTHING = 1e-6
"""Of a scaled number that a program answers with: a mass, a stiffness, or its product with the free
length that is none.  Programs leave 1e-8 of what they make vanish."""


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


# -- added masses ----------------------------------------------------------------------------------


NAMES = {
    "any": ("m", "x", "y", "i"),
    "point": ("m", "x", "y", "qx", "qy"),
    "disc": ("m", "x", "y", "qx", "qy", "own"),
    "ring": ("m", "own"),
    "sector": ("m", "x", "y"),
}
"""Numbers of each shape: mass, first moment, inertia, squares of the place, own inertia."""
TANGENTS, AROUND = 16, 9
"""Of the sine that bounds a sector: before the first solution, and about one that lies above it."""
CAP = 10.0
"""Times the mass of all links: more a weight does not get where no limit is given.  Some objectives
would have an endless mass close to its axis."""
ROUNDING_OF_MOMENT = 3e-9
"""Of a sector's moment, scaled, that is taken for rounding."""

RADII = {
    to_say("mass on {link}"): to_say("radius on {link}"),
    to_say("mass on {link} ({number})"): to_say("radius on {link} ({number})"),
}
"""What the mass of a weight is called -> what its radius is."""


class AddedWeight(DesignVariables):
    """A weight about a point of a link."""

    mass_place = 0

    def __init__(self, machine: Machine, link: str, at: str, weight: Weight) -> None:
        body = machine.links[link]
        self.link, self.at, self.weight = link, at, weight
        self.plane = weight.plane
        self.center = complex(*body.points[at])
        self.names = NAMES[weight.shape]
        self.count = len(self.names)
        self.cap = (machine.mass or 1.0) * CAP
        self.most = min(weight.mass or weight.at_most or self.cap, largest_mass(weight))
        self.mass_unit = min(self.most, machine.mass or 1.0)
        self.reach = weight.radius if isfinite(weight.radius) else size_of(body.points)
        self.reach = self.reach or float(size_of_bodies(machine))
        self.name = Note("mass on {link}", link=link)

    def minimize_added_mass(self, numbers: Array, matters: Array) -> Array:
        if self.weight.mass is not None or matters[0] or not isfinite(self.weight.radius):
            return numbers
        values = np.array(numbers)
        values[0] = min(self._least_mass(numbers, matters), float(numbers[0]))
        return self.project_feasible(values, matters)

    def _least_mass(self, numbers: Array, matters: Array) -> float:
        """The least mass, scaled, of the same moment, and of the same inertia where it matters."""
        now, shape, room = float(numbers[0]), self.weight.shape, self._room
        if shape == "ring":
            return now if np.any(matters) else 0.0
        moment = float(np.hypot(numbers[1], numbers[2]))
        if shape == "any" and matters[3]:
            inertia = float(numbers[3])
            return max(moment**2 / inertia, inertia / room**2) if inertia else 0.0
        if np.any(matters[3:]):
            return now
        if shape == "sector":
            most, _ = self._bound(pi / 2 * self._per_angle)
            return float(self._per_angle * asin(min(1.0, moment / most)))
        return self._least_disc(moment, now) if shape == "disc" else moment / room

    def _least_disc(self, moment: float, now: float) -> float:
        """The smaller solution m of moment + c m^(3/2) = R m."""
        from scipy.optimize import brentq

        c = self._disc_radius
        top = min(now, (2 * self._room / (3 * c)) ** 2)  # beyond which a disc only loses moment

        def spare(m: float) -> float:
            return float(self._room * m - c * m**1.5 - moment)

        if moment == 0:
            return 0.0
        if spare(top) <= 0:
            return now
        return float(brentq(spare, 0.0, top))

    @property
    def _per_angle(self) -> float:
        """Mass, scaled, of a radian of half a sector's angle."""
        outer, inner = self.weight.radius, self.weight.inner_radius
        return self._plate * (outer**2 - inner**2) / self.mass_unit

    @property
    def _disc_radius(self) -> float:
        """Radius of a disc of mass 1; both scaled."""
        return sqrt(self.mass_unit / (pi * self._plate)) / self.reach

    @property
    def _radius_name(self) -> str:
        return Note(RADII[self.name.template], **self.name.values)

    def bounds(self, numbers: Array) -> list[Bound]:
        result, mass = [], float(numbers[0]) * self.mass_unit
        if self.weight.at_most is not None:
            result.append(Bound(self.name, self.weight.at_most, mass, "kg"))
        if self.weight.shape in {"any", "point"} and isfinite(self.weight.radius) and mass:
            _, sx, sy, inertia = self._about_center(numbers)
            spread = sqrt(max(inertia / mass, 0.0))
            used = spread if self.weight.shape == "any" else hypot(sx, sy) / mass
            result.append(Bound(self._radius_name, self.weight.radius, used, "m"))
        return result

    def stopped(self, numbers: Array) -> Note | None:
        given = self.weight.mass is not None or self.weight.at_most is not None
        if given or float(numbers[0]) * self.mass_unit <= REACHED * self.cap:
            return None
        return Note(
            "the weight on {link} has reached the default limit of ten times the mass of the "
            "links; a larger mass would be better: give at_most",
            link=self.link,
        )

    @property
    def _plate(self) -> float:
        """Mass of a unit of area, kg/m2."""
        assert self.weight.thickness is not None and self.weight.density is not None
        return self.weight.thickness * self.weight.density

    @property
    def effect(self) -> Array:
        unit, reach, r = self.mass_unit, self.reach, self.center
        inner = self.weight.inner_radius
        turning = {
            "ring": inner**2,
            "sector": (reach**2 + inner**2) / 2,
        }  # inertia of a unit of mass
        about = {
            "m": (unit, 0.0, 0.0, unit * turning.get(self.weight.shape, 0.0)),
            "x": (0.0, unit * reach, 0.0, 0.0),
            "y": (0.0, 0.0, unit * reach, 0.0),
            **dict.fromkeys(("i", "qx", "qy"), (0.0, 0.0, 0.0, unit * reach**2)),
        }
        if "own" in self.names:
            about["own"] = (0.0, 0.0, 0.0, unit**2 / (2 * pi * self._plate))
        rows = []
        for name in self.names:
            mass, x, y, inertia = about[name]
            far = inertia + 2 * (r.real * x + r.imag * y) + mass * abs(r) ** 2
            rows.append((mass, x + mass * r.real, y + mass * r.imag, far))
        return np.array(rows)

    def constrain(self, program: Program, places: Array) -> list[Square]:
        at = dict(zip(self.names, map(int, places), strict=True))
        self._limit_mass(program, at["m"])
        squares = [
            Square(at[lift], at[y], at["m"], -self._room, self._room)
            for lift, y in (("qx", "x"), ("qy", "y"))
            if lift in at
        ]
        if "own" in at:
            most = largest_mass(self.weight)  # not at_most, which has its own price
            squares.append(Square(at["own"], at["m"], None, 0.0, most / self.mass_unit))
        for square in squares:
            square.keep_above(program)
            square.keep_between(program, square.low, square.high)
        if "x" in at:
            self._limit_place(program, at)
        return squares

    @property
    def _room(self) -> float:
        """Radius of the room, scaled."""
        return self.weight.radius / self.reach

    def _limit_mass(self, program: Program, m: int) -> None:
        if self.weight.mass is not None:
            program.zero(Affine.of(m, 1.0, -self.weight.mass / self.mass_unit))
            return
        program.nonnegative(Affine.of(m, 1.0))
        if self.weight.at_most is None:
            program.nonnegative(Affine.of(m, -1.0, self.cap / self.mass_unit))
        else:
            limit = Affine.of(m, -1.0, self.weight.at_most / self.mass_unit)
            slope = Affine.fixed(1 / self.mass_unit)
            program.nonnegative(limit, self.name, slope)
        if isfinite(most := largest_mass(self.weight)):
            program.nonnegative(Affine.of(m, -1.0, most / self.mass_unit))

    def _limit_place(self, program: Program, at: dict[str, int]) -> None:
        """Keep the mass inside its room."""
        moment = Affine(np.eye(2), np.array([at["x"], at["y"]]), np.zeros(2))
        mass = Affine.of(at["m"], 1.0)
        if self.weight.shape == "any":
            program.rotated(Affine.of(at["i"], 1.0), mass, moment)
            if isfinite(self._room):  # nothing is farther out than the room's edge
                rows = Affine.of([at["m"], at["i"]], [self._room**2, -1.0])
                slope = Affine.of(at["m"], 2 * self._room / self.reach)
                program.nonnegative(rows, self._radius_name, slope)
        elif self.weight.shape == "sector":
            for k in range(TANGENTS):
                self._add_tangent(program, at["m"], moment, (k + 0.5) / TANGENTS * self._full)
            places = np.array([at[name] for name in self.names])
            program.cutters.append(lambda x: self._cuts(places, x))
        elif self.weight.shape == "disc":
            self._fit_disc(program, at, moment)
        elif isfinite(self._room):
            slope = stacked(1 / self.reach * mass, Affine.fixed([0.0, 0.0]))
            program.cones(stacked(self._room * mass, moment), 3, self._radius_name, slope)

    def _fit_disc(self, program: Program, at: dict[str, int], moment: Affine) -> None:
        """|s| + m^(3/2) / sqrt(pi rho t) <= R m, the power by two cones: m^2 <= w u, u^2 <= m."""
        w, u = (Affine.of(int(place), 1.0) for place in program.numbers(2))
        mass = Affine.of(at["m"], 1.0)
        program.rotated(w, u, mass)
        program.rotated(mass, Affine.fixed(1.0), u)
        rest = self._room * mass - self._disc_radius * w
        program.cones(stacked(rest, moment), 3)

    @property
    def _full(self) -> float:
        """Mass of the whole ring that sectors are parts of, scaled; or the most that is allowed."""
        return min(largest_mass(self.weight), self.most) / self.mass_unit

    def _bound(self, m: float) -> tuple[float, float]:
        """The largest moment of sectors of a mass, and its slope; scaled."""
        outer, inner = self.weight.radius, self.weight.inner_radius
        c = 2 / 3 * self._plate * (outer**3 - inner**3) / (self.mass_unit * self.reach)
        d = self._per_angle
        return c * sin(m / d), c / d * cos(m / d)

    def _add_tangent(self, program: Program, place: int, moment: Affine, m: float) -> None:
        value, slope = self._bound(m)
        program.cones(stacked(Affine.of(place, slope, value - slope * m), moment), 3)

    def _cuts(self, places: Array, x: Array) -> list[ConeRows]:
        """Tangents that cut off a moment which no sector of its mass has."""
        m, sx, sy = (float(value) for value in x[places])
        m = min(max(m, 0.0), self._full)
        excess = float(np.hypot(sx, sy)) - self._bound(m)[0]
        if excess <= ROUNDING_OF_MOMENT:
            return []
        cuts, moment = Program(), Affine(np.eye(2), places[1:], np.zeros(2))
        # Tangents a width apart miss by the bend times its square over 8.
        width = sqrt(8 * excess / max(self._bend(m), self._bend(self._full / 2)))
        for mass in np.clip(m + width * np.linspace(-1, 1, AROUND), 0.0, self._full):
            self._add_tangent(cuts, int(places[0]), moment, float(mass))
        return [replace(block, local=f"sector {places[0]}") for block in cuts.blocks]

    def _bend(self, m: float) -> float:
        """Second derivative of the bound, its size; scaled."""
        return abs(self._bound(m)[0]) / self._per_angle**2

    def project_feasible(self, numbers: Array, matters: Array) -> Array:
        values = np.array(numbers) if numbers[0] > NOTHING else np.zeros(self.count)
        at = {name: k for k, name in enumerate(self.names)}
        m = float(values[0])
        if self.weight.shape == "sector" and m > 0:
            most = self._bound(min(m, self._full))[0]
            values[1:] *= min(1.0, most / max(float(np.hypot(*values[1:])), TINY))
        for lift, y in (("qx", "x"), ("qy", "y")):
            if lift in at:
                values[at[lift]] = values[at[y]] ** 2 / m if m > 0 else 0.0
        if "own" in at:
            values[at["own"]] = m**2
        if "i" in at:
            least = (values[1] ** 2 + values[2] ** 2) / m if m > 0 else 0.0
            spread = float(values[at["i"]]) - least > SPREAD * m  # else it counts as a point mass
            values[at["i"]] = values[at["i"]] if spread and matters[at["i"]] else least
        return values

    def changes(self, numbers: Array) -> list[Change]:
        mass, sx, sy, inertia = self._about_center(numbers)
        pieces = pieces_of(self.weight, mass, complex(sx, sy), inertia, self.center)
        place: Vector = (self.center.real, self.center.imag)
        moment = abs(complex(sx, sy))
        values = {
            "at": self.at,
            "center": place,
            "shape": self.weight.shape,
            "mass": mass,
            "moment": moment,
            "direction": float(np.arctan2(sy, sx)) if moment else 0.0,
            "radius": moment / mass if mass > 0 else 0.0,
            "inertia": inertia,
            "pieces": pieces,
        }
        if self.plane is not None:
            values["plane"] = self.plane
        return [Change("added mass", self.link, values)]

    def _about_center(self, numbers: Array) -> tuple[float, float, float, float]:
        """Mass, first moments and inertia about the centre of the room."""
        mass, x, y, inertia = (float(value) for value in numbers @ self.effect)
        r = self.center
        sx, sy = x - mass * r.real, y - mass * r.imag
        return mass, sx, sy, inertia - 2 * (r.real * sx + r.imag * sy) - mass * abs(r) ** 2


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
