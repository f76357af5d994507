"""Remedies that can be drawn and built: sectors of steel plate, and holes, one after the other.

Outputs are linear in a link's mass, first moment and inertia, so that thousands of shapes are
compared at once.  Every shape is one that a drawing would have: radii on a grid of 10 mm, whole
degrees, plate that is in stock.  Headline figures may not grow, and kilograms have a price.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from functools import cached_property
from itertools import product
from math import ceil, floor, log10, pi
from typing import Any

import numpy as np

from equipoise.balancing.design_variables import AddedWeight
from equipoise.balancing.effects import Signal
from equipoise.balancing.headlines import HeadlineLimit
from equipoise.balancing.objectives import measured_each
from equipoise.balancing.policy import (
    HOLE_RADII,
    HUB,
    LEAST_GAIN,
    LEAST_GAIN_OF_ADDED,
    LEAST_NET_GAIN,
    MASS_PRICE,
    MOST_TAKEN,
    PEAK_PRICE,
    PLATES,
)
from equipoise.balancing.problem import Problem
from equipoise.balancing.room import Room, outline_of
from equipoise.balancing.rounding import NEARLY
from equipoise.balancing.workshop import Change
from equipoise.dataclass import dataclass
from equipoise.mechanism.parts.balance import (
    MATERIALS,
    AddedMass,
    Balance,
    Objective,
    Weight,
)
from equipoise.mechanism.parts.bodies import Body, Hole, fits, outlines, place_of
from equipoise.mechanism.parts.links import Link
from equipoise.mechanism.parts.machine import Machine
from equipoise.results.yardsticks import FigureAssessment
from equipoise.signals import Array

STEEL = MATERIALS["steel"]
GRID, FINE_GRID, SMALL = 10e-3, 1e-3, 20e-3
"""m: steps of radii, and those of rooms that are smaller than this."""
SAMPLES, CHUNK = 120, 128
"""Crank angles in a turn at which shapes are compared; how many at once."""
DIRECTIONS, WIDTHS = range(-180, 180, 10), (30, 60, 90, 120, 150, 180)
"""Degrees that are tried first: all round, and sectors of steps that fine ones bridge."""
FINE_DIRECTIONS, FINE_WIDTHS = range(-9, 10), range(-25, 30, 5)
"""Degrees about the best of these."""
PLATE_SHARES, OUTER_SHARES = (1.0, 0.5, 0.25, 0.125), (1.0, 0.85, 0.7, 0.5)
"""Of the thickest plate and of the largest radius: what is tried."""
WIDTH_RANGE = (10, 180)
"""Degrees of sectors: narrower ones are slivers, wider ones balance themselves in part."""
FEW = 4
"""Of the best shapes, how many are looked at in full."""


@dataclass(frozen=True)
class Sector:
    """A sector of plate about a pivot: SI units, whole degrees in the axes of its link."""

    outer: float
    inner: float
    thickness: float
    direction: int
    width: int


@dataclass(frozen=True, eq=False)
class Shapes:
    """Shapes that are compared, as numbers about the pivot (M,): kg, kg m, kg m2."""

    items: Sequence[object]
    mass: Array
    moment: Array
    inertia: Array

    def subset(self, chosen: Array) -> Shapes:
        """The chosen shapes, by flags or places (M,)."""
        places = np.arange(len(self.items))[chosen]
        return Shapes([self.items[k] for k in places], self.mass[places],
                      self.moment[places], self.inertia[places])  # fmt: skip


def sectors(shapes: Sequence[Sector]) -> Shapes:
    """Masses, first moments and inertias of sectors of steel plate."""
    outer, inner, thick, way, width = (
        np.array([getattr(shape, name) for shape in shapes], float)
        for name in ("outer", "inner", "thickness", "direction", "width")
    )
    half, plate = np.radians(width) / 2, STEEL * thick
    mass = plate * half * (outer**2 - inner**2)
    moment = 2 / 3 * plate * (outer**3 - inner**3) * np.sin(half)
    inertia = mass * (outer**2 + inner**2) / 2
    return Shapes(shapes, mass, moment * np.exp(1j * np.radians(way)), inertia)


def added_sector(room: Room, shape: Sector) -> AddedMass:
    """The room of a sector as a plan has it: any sector between its radii, of its plate."""
    weight = Weight("sector", shape.outer, shape.inner, shape.thickness, STEEL, plane=room.plane)
    return AddedMass(room.link, room.at, weight)


# -- what a shape does -----------------------------------------------------------------------------


@dataclass(frozen=True, eq=False)
class Comparison:
    """What shapes about the pivots of some links do to aims and headline figures.

    plan : whose objectives are the aims.
    aim : the headline figure that the aims stand for; None where there is none.
    before : value of each aim, by its name.
    asked : whether somebody asked for the aims, so that it need not fall.
    """

    machine: Machine
    plan: Balance
    rooms: tuple[Room, ...]
    watched: tuple[HeadlineLimit, ...]
    aim: FigureAssessment | None
    before: Mapping[str, float]
    asked: bool = False

    @cached_property
    def problem(self) -> Problem:
        """Any mass about each pivot."""
        free = tuple(
            AddedMass(room.link, room.at, Weight("any", radius=1.0, plane=room.plane))
            for room in self.rooms
        )
        limits = tuple(limit for item in self.watched for limit in item.limits())
        asked = Problem.of(self.machine, replace(self.plan, masses=free, limits=limits))
        return replace(asked, counts=self.before)

    @cached_property
    def _signals(self) -> dict[str, list[Signal]]:
        """Of each objective and headline figure, in SI units, at fewer crank angles."""
        by_name = {}
        for name, every in self.problem.unscaled.items():
            signals = [item.on_grid for item in every]
            steps = [max(1, len(signal.start) // (SAMPLES * signal.turns)) for signal in signals]
            by_name[name] = [
                Signal(signal.start[::step], signal.columns[:, ::step], signal.turns)
                for signal, step in zip(signals, steps, strict=True)
            ]
        return by_name

    @cached_property
    def influences(self) -> bool:
        """Whether a mass about the pivots changes any aim."""
        return any(self.problem.moves(objective) for objective in self.plan.objectives)

    def numbers_of(self, each: Sequence[Shapes]) -> Array:
        """Numbers (M, K) of the problem, from one shape for each room."""
        columns = []
        for part, shapes in zip(self.problem.parts, each, strict=True):
            assert isinstance(part, AddedWeight)
            mass, length = part.mass_unit, part.reach
            moment = shapes.moment / (mass * length)
            columns += [shapes.mass / mass, moment.real, moment.imag]
            columns.append(shapes.inertia / (mass * length**2))
        return np.stack(columns, axis=1)

    def gains(self, numbers: Array) -> Array:
        """Share (M,) of the aims that is gone."""
        goals = self.plan.objectives
        costs = [self._values(goal, numbers) / self.problem.scale(goal) for goal in goals]
        whole = np.array(self.plan.factors)[:, None] * np.array(costs)
        squares = self.plan.combine == "squares"
        combined = np.hypot.reduce(whole) if squares else np.sum(whole, axis=0)
        return np.asarray(1 - combined / self.problem.whole)

    @cached_property
    def _of_aim(self) -> HeadlineLimit | None:
        """The headline figure of the aims; None of gauges, whose velocity is no signal here, and of
        aims that are no headline figure.
        """
        entries = (item for item in self.watched if item.entry is not None)
        return next((entry for entry in entries if entry.entry == self.aim), None)

    def figure_gains(self, numbers: Array) -> Array:
        """Share (M,) of the headline figure of the aims that is gone, in its measure."""
        figure = self._of_aim
        if figure is None or self.asked:
            return np.ones(len(numbers))
        both = np.vstack([np.zeros((1, numbers.shape[1])), numbers])
        values = np.max([self._values(objective, both) for objective in figure.objectives], axis=0)
        return np.asarray(1 - values[1:] / values[0])

    def harmless(self, numbers: Array, gain: Array) -> Array:
        """Whether (M,) no headline figure grows by more than it may beside a gain (M,)."""
        fine = np.ones(len(numbers), bool)
        excess = 0.0 if self.aim is None else self.aim.excess
        steadies = self.aim is not None and not self.aim.is_shaking
        for figure in self.watched:
            left = np.flatnonzero(fine)
            most = [self._values(objective, numbers[left]) for objective in figure.objectives]
            fine[left] = np.max(most, axis=0) <= figure.most(gain[left], excess, steadies)
        return fine

    def _values(self, objective: Objective, numbers: Array) -> Array:
        """A figure (M,), SI units; of several speeds the largest."""
        each = []
        for signal in self._signals[objective.name]:
            values = [
                measured_each(
                    signal.start + some @ signal.columns, objective.measure, signal.sampling
                )
                for some in np.array_split(numbers, 1 + len(numbers) // CHUNK)
            ]
            each.append(np.concatenate(values))
        return np.asarray(np.max(each, axis=0))

    def ranked(self, shapes: Sequence[Shapes], most_mass: float) -> list[tuple[float, int]]:
        """Score and place of shapes, the best first: the gain, less the price of mass.

        Shapes that are worth it and do no harm, to first order; where none is, the shape with the
        largest gain alone.
        """
        mass = np.sum([np.maximum(shape.mass, 0.0) for shape in shapes], axis=0)
        light = np.flatnonzero(mass <= most_mass)
        if not light.size:
            return []
        numbers = self.numbers_of([shape.subset(light) for shape in shapes])
        gain, share = self.gains(numbers), mass[light] / (self.machine.mass or 1.0)
        score = gain - MASS_PRICE * share
        order = np.argsort(-score, kind="stable")
        figure = np.ones(len(gain))
        least = LEAST_GAIN  # less than is offered: shapes beside one that is nearly good may be
        fair = is_worth(gain, share, least=least)
        figure[fair] = self.figure_gains(numbers[fair])
        worth = order[is_worth(gain, share, figure, least)[order]]
        counts: list[int] = []
        for some in np.array_split(worth, 1 + len(worth) // CHUNK):
            counts += some[self.harmless(numbers[some], gain[some])].tolist()
            if len(counts) >= FEW:
                break
        best = counts[:FEW] or [int(np.argmax(gain))]
        return [(float(score[k]), int(light[k])) for k in best]


def least_gain(mass_share: Any) -> Any:
    """Share of the aim that has to go, by the mass that is added over that of the moving links."""
    return np.where(np.asarray(mass_share) > 0, LEAST_GAIN_OF_ADDED, LEAST_GAIN)


def is_worth(gain: Any, mass_share: Any, figure_gain: Any = 1.0, least: Any = None) -> Any:
    """Whether what is gone is worth a mass over that of the moving links.

    gain : share of the aim.  figure_gain : of the figure that is large, in its own measure.
    least : of both; what `least_gain` says if None.
    """
    price = MASS_PRICE * np.maximum(mass_share, 0.0)
    least = least_gain(mass_share) if least is None else least
    enough = gain >= np.maximum(least, np.where(price > 0, price + LEAST_NET_GAIN, 0.0))
    return enough & (figure_gain >= np.maximum(least, PEAK_PRICE * price))


# -- counterweights --------------------------------------------------------------------------------


def best_sectors(
    comparison: Comparison, most_mass: float, opposite: bool = False
) -> Iterator[tuple[Sector, ...]]:
    """Sectors in the room of each link, the best first; none that does harm.

    opposite : of two planes of one link, whether the second sector points the other way: a couple.
    """
    coarse = [*coarse_sectors(comparison.rooms)]
    for _, shapes in _finer(comparison, coarse, most_mass, opposite):
        yield shapes


def _finer(
    comparison: Comparison, coarse: list[Sector], most_mass: float, opposite: bool
) -> list[tuple[float, tuple[Sector, ...]]]:
    first = _ranked(comparison, coarse, most_mass, opposite)
    if not first:
        return []
    best = first[0][1][0]
    about = [
        replace(best, direction=_turned(best.direction + d), width=best.width + w)
        for d, w in product(FINE_DIRECTIONS, FINE_WIDTHS)
        if WIDTH_RANGE[0] <= best.width + w <= WIDTH_RANGE[1]
    ]
    return _ranked(comparison, about, most_mass, opposite) or first


def _ranked(
    comparison: Comparison, shapes: list[Sector], most_mass: float, opposite: bool
) -> list[tuple[float, tuple[Sector, ...]]]:
    """Score and sectors, one for each room, of those that are free."""
    turns = [180 * k * opposite for k in range(len(comparison.rooms))]
    each = [
        [replace(shape, direction=_turned(shape.direction + turn)) for shape in shapes]
        if turn
        else shapes
        for turn in turns
    ]
    free = np.ones(len(shapes), bool)
    for room, own in zip(comparison.rooms, each, strict=True):
        free &= _free(room, own)
    free_remedies = [[item for item, fits in zip(own, free, strict=True) if fits] for own in each]
    if not free_remedies[0]:
        return []
    ranked = comparison.ranked([sectors(own) for own in free_remedies], most_mass)
    return [(score, tuple(own[k] for own in free_remedies)) for score, k in ranked]


def _free(room: Room, shapes: list[Sector]) -> Array:
    values = np.zeros(len(shapes), bool)
    groups: dict[tuple[float, float], list[int]] = {}
    for k, shape in enumerate(shapes):
        groups.setdefault((shape.inner, shape.outer), []).append(k)
    for (inner, outer), places in groups.items():
        way = np.array([float(shapes[k].direction) for k in places])
        width = np.array([float(shapes[k].width) for k in places])
        values[places] = room.is_free(inner, outer, way, width)
    return values


def _turned(degrees: int) -> int:
    """Equivalent direction from -179 to 180 degrees."""
    return 180 - (180 - degrees) % 360


def coarse_sectors(rooms: Sequence[Room]) -> Iterator[Sector]:
    """Sectors that are tried first, in the smallest of some rooms."""
    largest = min(room.largest for room in rooms)
    thickest = min(room.most_thick for room in rooms)
    grid = GRID if largest >= SMALL else FINE_GRID
    steps = floor(largest / grid * (1 + NEARLY))
    if steps < 2:
        return
    hub = ceil(max(room.hub for room in rooms) / grid * (1 - NEARLY))
    thick = sorted({plate_of(thickest * share) for share in PLATE_SHARES}, reverse=True)
    for outer in dict.fromkeys(max(2, floor(steps * share)) for share in OUTER_SHARES):
        inner = max(1, round(outer * HUB), hub)
        if inner >= outer:
            continue
        for plate, way, width in product(thick, DIRECTIONS, WIDTHS):
            yield Sector(outer * grid, inner * grid, plate, _turned(way), width)


def plate_of(most: float) -> float:
    """The thickest plate in stock (m) that is at most so thick."""
    most *= 1 + NEARLY
    unit = 10.0 ** floor(log10(most))
    return float(max(size * unit for size in PLATES if size * unit <= most))


def with_sectors(
    machine: Machine, rooms: Sequence[Room], shapes: Sequence[Sector]
) -> tuple[Machine, tuple[Change, ...]]:
    """The machine with a sector in each room, and what that changes."""
    changes = []
    for room, shape in zip(rooms, shapes, strict=True):
        item = sectors([shape])
        mass, moment, inertia = float(item.mass[0]), complex(item.moment[0]), float(item.inertia[0])
        center = complex(*machine.links[room.link].points[room.at])
        place = center + moment / mass
        own = inertia - abs(moment) ** 2 / mass
        link = machine.links[room.link]
        link = link.with_added(mass, (place.real, place.imag), own, room.plane)
        machine = _with_masses_of(machine, room.link, link)
        values = {
            "at": room.at,
            "center": (center.real, center.imag),
            "shape": "sector",
            "mass": mass,
            "moment": abs(moment),
            "direction": float(np.angle(moment)),
            "radius": abs(moment) / mass,
            "inertia": inertia,
            "pieces": [
                {
                    "shape": "sector",
                    "mass": mass,
                    "place": (place.real, place.imag),
                    "outer_radius": shape.outer,
                    "inner_radius": shape.inner,
                    "angle": float(np.radians(shape.width)),
                    "direction": float(np.angle(moment)),
                    "thickness": shape.thickness,
                    "density": STEEL,
                }
            ],
        }
        plane: dict[str, object] = {} if room.plane is None else {"plane": room.plane}
        plane |= _passing(room, shape)
        changes.append(Change("added mass", room.link, values | plane))
    return machine, tuple(changes)


def _passing(room: Room, shape: Sector) -> dict[str, object]:
    """Pins, or links where no pin is, for which a sector needs the plane of its own."""
    for kind, ways in (("beside", room.neighbors), ("beside_links", room.beside_links)):
        matching_ways = [name for name, way in ways.items() if way < shape.outer + room.clearance]
        if matching_ways:
            return {kind: matching_ways}
    return {}


def _with_masses_of(machine: Machine, name: str, link: Link) -> Machine:
    """The machine with the masses of another link of the same points, which moves as before."""
    fields = ("bodies",) if link.bodies else ("mass", "center_of_mass", "inertia")
    return machine.with_link(name, **{item: getattr(link, item) for item in fields})


# -- holes -----------------------------------------------------------------------------------------


@dataclass(frozen=True)
class DrilledHole:
    """A hole through a body of a link: number of the body, centre from the pivot, radius; m."""

    body: int
    place: complex
    radius: float


HOLE_GRID, HOLE_PLACES = 5e-3, 12
"""Grid of centres, m, so that a drawing has round numbers; places across a body that are tried."""


def best_holes(comparison: Comparison) -> Iterator[DrilledHole]:
    """Holes in the bodies of a link that take off what is too much, the best first."""
    room = comparison.rooms[0]
    link = comparison.machine.links[room.link]
    holes = [*_holes(link, room)]
    if holes:
        taken = _taken(link, holes)
        for _, k in comparison.ranked([taken], np.inf):
            yield holes[k]


def _taken(link: Link, holes: Sequence[DrilledHole]) -> Shapes:
    """What holes take off, below 0."""
    plates = [link.bodies[hole.body] for hole in holes]
    thick = np.array([(body.thickness or 0.0) * (body.density or 0.0) for body in plates])
    radius = np.array([hole.radius for hole in holes])
    place = np.array([hole.place for hole in holes])
    mass = -thick * pi * radius**2
    return Shapes(holes, mass, mass * place, mass * (np.abs(place) ** 2 + radius**2 / 2))


def _holes(link: Link, room: Room) -> Iterator[DrilledHole]:
    """Holes that lie in a body, and keep away from its edge, from lines between the link's points
    and from other holes.
    """
    pivot = complex(*link.points[room.at])
    points = np.array([*outline_of(link, None)])
    for number, body in enumerate(link.bodies):
        if body.shape == "bar" or body.density is None or body.thickness is None:
            continue  # a bar needs all of its section
        edges = outlines(body, link.points)
        places = np.array([*_grid(edges)])
        for radius in HOLE_RADII:
            clear = radius + room.clearance
            for place in places:
                if np.min(np.abs(points - place)) > clear and _drillable(body, link, place, clear):
                    yield DrilledHole(number, complex(place) - pivot, radius)


def _grid(edges: Sequence[tuple[list[complex], float]]) -> Iterator[complex]:
    """Places on a grid across a body, on whole grid steps."""
    corners, size = edges[0] if edges else ([], 0.0)
    if not corners:
        return
    reach = abs(size)
    xs = [c.real + s for c in corners for s in (-reach, reach)]
    ys = [c.imag + s for c in corners for s in (-reach, reach)]
    for x, y in product(*(_steps(min(item), max(item)) for item in (xs, ys))):
        yield complex(x, y)


def _steps(low: float, high: float) -> list[float]:
    step = HOLE_GRID * max(1, ceil((high - low) / HOLE_PLACES / HOLE_GRID))
    return [step * k for k in range(ceil(low / step), floor(high / step) + 1)]


def _drillable(body: Body, link: Link, place: complex, clear: float) -> bool:
    """Whether a circle lies within a body, and away from its holes."""
    apart = all(
        abs(complex(place_of(hole.at, link.points)) - place) > clear + hole.radius
        for hole in body.holes
    )
    return apart and all(fits(place, clear, edge) for edge in outlines(body, link.points))


def with_hole(
    machine: Machine, room: Room, hole: DrilledHole
) -> tuple[Machine, tuple[Change, ...]]:
    """The machine with a hole in a body of a link, and what that changes."""
    link = machine.links[room.link]
    at = complex(*link.points[room.at]) + hole.place
    bodies = list(link.bodies)
    body = bodies[hole.body]
    drilled = Hole((at.real, at.imag), hole.radius)
    bodies[hole.body] = replace(body, holes=(*body.holes, drilled))
    new = machine.with_link(room.link, bodies=tuple(bodies))
    hole_values = {"body": hole.body + 1, "shape": body.shape, "hole_radius": hole.radius}
    return new, (
        _taken_off(room, at, hole.place, -float(_taken(link, [hole]).mass[0]), hole_values),
    )


def _taken_off(
    room: Room, at: complex, place: complex, mass: float, hole_values: Mapping[str, object]
) -> Change:
    values = {
        "at": room.at,
        "mass": mass,
        "place": (at.real, at.imag),
        "radius": abs(place),
        "moment": mass * abs(place),
        "direction": float(np.angle(place)),
    }
    return Change("removed mass", room.link, values | dict(hole_values))


# -- mass that a link has too much of --------------------------------------------------------------

TURNED = range(-60, 65, 5)
"""Degrees from the way to the centre of mass, to either side, where holes are tried: further off
they move it more across than back."""
SHARES = (0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0)
"""Of the first moment that a link has towards a direction: what is taken off."""


def best_cuts(comparison: Comparison) -> Iterator[tuple[complex, float]]:
    """Where to take mass off a link of which no bodies are known, and how much, the best first.

    Mass is taken from where the link has too much of it, towards its centre of mass and away from
    its pins, which need it, at its radius of gyration about the pivot; the place is seen from the
    pivot, m, the mass in kg.
    """
    room = comparison.rooms[0]
    link = comparison.machine.links[room.link]
    if link.bodies or not link.mass or link.center_of_mass is None or link.inertia is None:
        return
    center = complex(*link.center_of_mass) - complex(*link.points[room.at])
    about = link.inertia + link.mass * abs(center) ** 2
    radius = round(np.sqrt(about / link.mass) / FINE_GRID) * FINE_GRID
    if not center or not radius:
        return
    middle = round(np.degrees(np.angle(center)))
    arms = [complex(*point) - complex(*link.points[room.at]) for point in link.points.values()]
    items: list[tuple[complex, float]] = []
    for turn, share in product(TURNED, SHARES):
        way = np.exp(1j * np.radians(middle + turn))
        most = min(link.mass * (center * np.conj(way)).real / radius, MOST_TAKEN * link.mass)
        mass = float(f"{share * most:.2g}")
        rest, left = link.mass * center - mass * radius * way, about - mass * radius**2
        beyond = all((arm * np.conj(way)).real <= 0 for arm in arms)
        if beyond and 0 < mass < link.mass and abs(rest) ** 2 < left * (link.mass - mass):
            items.append((complex(radius * way), mass))
    if not items:
        return
    places, masses = (np.array(item) for item in zip(*items, strict=True))
    taken = Shapes(items, -masses, -masses * places, -masses * np.abs(places) ** 2)
    yield from (items[k] for _, k in comparison.ranked([taken], np.inf))


def with_cut(
    machine: Machine, room: Room, cut: tuple[complex, float]
) -> tuple[Machine, tuple[Change, ...]]:
    """The machine with mass taken off a link, and what that changes."""
    link, (place, mass) = machine.links[room.link], cut
    assert link.mass is not None and link.center_of_mass is not None and link.inertia is not None
    at = complex(*link.points[room.at]) + place
    old = complex(*link.center_of_mass)
    rest = link.mass - mass
    center = (link.mass * old - mass * at) / rest
    inertia = link.inertia + link.mass * abs(old - center) ** 2 - mass * abs(at - center) ** 2
    new = machine.with_link(
        room.link, mass=rest, center_of_mass=(center.real, center.imag), inertia=inertia
    )
    return new, (_taken_off(room, at, place, mass, {}),)
