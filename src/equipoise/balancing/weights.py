"""Masses added about a point of a link, shape by shape, and the dimensions that come back.

Numbers are scaled: mass by `unit`, lengths by `reach`.  With m the mass, s the first moment and I
the moment of inertia about the centre of the room of radius R:

    any      |s|^2 <= m I, I <= R^2 m: every distribution in the room, and nothing else
    point    I = |s|^2 / m, |s| <= R m
    disc     I = |s|^2 / m + m^2 / (2 pi rho t), |s| + m^(3/2) / sqrt(pi rho t) <= R m
    ring     s = 0, I = m r^2 + m^2 / (2 pi rho t), with r its inner radius
    sector   I = m (R^2 + r^2) / 2, |s| <= c sin(m / d): parts of a ring from r to R, with
             c = 2/3 rho t (R^3 - r^3) and d = rho t (R^2 - r^2)
"""

from __future__ import annotations

from dataclasses import replace
from math import asin, cos, hypot, isfinite, pi, sin, sqrt

import numpy as np

from equipoise.balancing.branch_and_bound import Square
from equipoise.balancing.design_variables import REACHED, Bound, DesignVariables
from equipoise.balancing.program import Affine, ConeRows, Program, stacked
from equipoise.balancing.rounding import TINY
from equipoise.balancing.workshop import SPREAD, Change, pieces_of
from equipoise.i18n import Note, to_say
from equipoise.mechanism.assembly.steps import size_of_bodies
from equipoise.mechanism.parts.balance import Weight, largest_mass
from equipoise.mechanism.parts.machine import Machine, Vector, size_of
from equipoise.signals import Array

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
NOTHING = 1e-6
"""Of a mass, scaled, that is none."""
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
