"""Shafts that are added to a machine, and the search of their gears around the cone program.

Ratios, directions and numbers of teeth are no numbers of a cone program.  They are chosen outside
of it, for all shafts together, and the program answers with the best weights for each choice.
Of one shaft numbers of teeth are tried one and all, and of ratios and directions a grid.  Where
several shafts have more choices together than can be tried, some of each are, and from the best of
these one shaft after the other tries all of its own.  Ratios and directions are then followed, all
at once, as far down as they go.
"""

from __future__ import annotations

from cmath import phase, rect
from collections.abc import Iterator
from dataclasses import replace
from fractions import Fraction
from itertools import combinations, product, starmap
from math import inf, pi, prod
from typing import Any

import numpy as np

from equipoise.balancing.design_variables import AddedWeight, with_parameters
from equipoise.balancing.problem import Problem
from equipoise.balancing.rounding import NEARLY, TINY
from equipoise.balancing.solution import Solution, solve_problem
from equipoise.balancing.workshop import Change
from equipoise.dataclass import dataclass
from equipoise.design.solvers import DesignProblem, DesignSolution, solve
from equipoise.design.variables import Choices, Range
from equipoise.errors import UsageError
from equipoise.i18n import Note
from equipoise.mechanism.dynamics.parameters import parameter_values
from equipoise.mechanism.formulas.kernels import about
from equipoise.mechanism.kinematics.motion import Motion, move
from equipoise.mechanism.parts.balance import Balance, BalanceShafts, GearedWeight
from equipoise.mechanism.parts.gears import Gear
from equipoise.mechanism.parts.machine import Link, Machine, Vector
from equipoise.results.result import ProgressCallback
from equipoise.signals import Array

GRID, COARSE, WAYS = 33, 13, 24
"""Ratios at which a range is looked at, before the best are followed to their tops; the same where
directions are looked for too; directions."""
LARGEST_DENOMINATOR = 3
"""Of the ratios that are tried where the driver turns fully: turns until the shaft is back."""
SWINGING = 1e-6
"""Mean speed of a link over that of the crank up to which it swings: that of one that turns is a
ratio of whole numbers, and so is far larger."""
TURNS = 720
"""Crank angles at which the way of links past a shaft is looked at: between two of them a point of
the crank goes 0.9 % of its radius."""
SAME = 2e-5
"""Share of the distance of two shafts to which gears have to fill it."""


@dataclass(frozen=True)
class Mesh:
    """One choice of gears.

    driver, shaft : radii of their pitch circles, m.  direction : from the driver's pin to the
        shaft, rad.  teeth : numbers of them, where they are counted.
    """

    driver: float
    shaft: float
    direction: float
    teeth: tuple[int, int] | None = None

    @property
    def ratio(self) -> float:
        """Speed of the shaft over that of the driver, its size."""
        return float(self.driver / self.shaft)


def geared_range(geared: GearedWeight) -> bool:
    """Whether ratio or direction may be any number between two, of which some are tried."""
    ranges = (geared.ratio, geared.direction)
    return any(item is not None and item[0] < item[1] for item in ranges)


class Gearing:
    """A geared counterweight that is to be added to a machine."""

    def __init__(self, machine: Machine, geared: GearedWeight) -> None:
        self.machine, self.geared = machine, geared
        driver = machine.links[geared.driver]
        self.pin = next(name for name in driver.points if name in machine.frame)
        self.at_pin = complex(*machine.frame[self.pin])
        self.motion = move(machine, TURNS, acceleration=0.0)

    @property
    def name(self) -> str:
        return f"{self.geared.name}-axis"

    @property
    def apart(self) -> float:
        """Distance of the shafts, m, where their places are given."""
        assert self.geared.axis is not None
        return abs(complex(*self.geared.axis) - self.at_pin)

    @property
    def turns_fully(self) -> bool:
        """Whether the driver goes round, so that only few ratios bring the shaft back."""
        speed = self.motion.links[self.geared.driver].angular_velocity
        return bool(abs(np.mean(speed)) > SWINGING * abs(self.motion.speed))

    @property
    def direction(self) -> float:
        """From the driver's pin to the shaft, rad, where it is not to be chosen."""
        if self.geared.axis is not None:
            return phase(complex(*self.geared.axis) - self.at_pin)
        away = self.at_pin - complex(*self.machine.frame[self.motion.linkage.pivot])
        return phase(away) if away else 0.0

    @property
    def ranges(self) -> dict[str, tuple[float, float]]:
        """What may be any number between two: ratio, direction."""
        ratio, direction = self.geared.ratio, self.geared.direction
        pairs = {}
        if ratio is not None and ratio[0] < ratio[1] and not self.turns_fully:
            pairs["ratio"] = ratio
        if direction is not None and direction[0] < direction[1]:
            pairs["direction"] = direction
        return pairs

    def meshes(self) -> list[Mesh]:
        """Choices to try: pairs of teeth, or ratios over the range."""
        async_iterator = list(self._choices())
        if not async_iterator:
            raise UsageError(self._why_none())
        clear = [mesh for mesh in async_iterator if self.is_clear(mesh)]
        if not clear and (hit := self._hit(async_iterator[0])):
            raise UsageError(hit)
        return clear

    def _why_none(self) -> Note:
        if self.geared.teeth is not None:
            assert self.geared.module is not None
            return Note(
                "the gears of the {name} do not mesh: shafts {apart:.5g} mm apart need "
                "{teeth:.5g} teeth of module {module:.4g} mm together; move the axis, "
                "or leave it out",
                name=self.geared.name,
                apart=self.apart * 1e3,
                teeth=2 * self.apart / self.geared.module,
                module=self.geared.module * 1e3,
            )
        low, high = self.geared.ratio or (0.0, 0.0)
        return Note(
            "the {name} has no ratio from {low:g} to {high:g} that brings it back "
            "within {largest_denominator} turns; give another range, or teeth",
            name=self.geared.name,
            low=low,
            high=high,
            largest_denominator=LARGEST_DENOMINATOR,
        )

    def _choices(self) -> Iterator[Mesh]:
        if self.geared.teeth is None:
            yield from starmap(self.mesh, product(self._ratios(), self._directions()))
            return
        assert self.geared.module is not None
        low, high = self.geared.teeth
        half, counts = self.geared.module / 2, range(low, high + 1)
        for a, b, way in product(counts, counts, self._directions()):
            mesh = Mesh(half * a, half * b, way, (a, b))
            meets = self.geared.axis is None or self._fills(mesh)
            if meets:
                yield mesh

    def _fills(self, mesh: Mesh) -> bool:
        """Whether the pitch circles touch."""
        return abs(mesh.driver + mesh.shaft - self.apart) < SAME * self.apart

    def _directions(self) -> list[float]:
        if self.geared.direction is None:
            return [self.direction]
        low, high = self.geared.direction
        if low == high:
            return [low]
        whole = high - low >= 2 * pi - NEARLY
        return [float(d) for d in np.linspace(low, high, WAYS, endpoint=not whole)]

    def _ratios(self) -> list[float]:
        assert self.geared.ratio is not None
        low, high = self.geared.ratio
        if low == high:
            return [low]
        if not self.turns_fully:
            count = COARSE if "direction" in self.ranges else GRID
            return [float(ratio) for ratio in np.geomspace(low, high, count)]
        bottoms = range(1, LARGEST_DENOMINATOR + 1)
        fractions = {Fraction(p, q) for q in bottoms for p in range(1, int(high * q) + 1)}
        return sorted(float(f) for f in fractions if low <= f <= high)

    def with_numbers(self, start: Mesh, numbers: dict[str, float]) -> Mesh:
        """A choice of gears with another ratio or direction; teeth stay as they are."""
        if start.teeth is not None:
            return replace(start, direction=numbers["direction"])
        return self.mesh(**({"ratio": start.ratio, "direction": start.direction} | numbers))

    def mesh(self, ratio: float, direction: float) -> Mesh:
        """Gears of a ratio, with the shaft in a direction from the driver's pin."""
        if self.geared.axis is not None:
            driver = self.apart * ratio / (1 + ratio)
            return Mesh(driver, self.apart - driver, direction)
        assert self.geared.pitch_radius is not None
        return Mesh(self.geared.pitch_radius, self.geared.pitch_radius / ratio, direction)

    def axis(self, mesh: Mesh) -> complex:
        """Place of the shaft in the frame, m."""
        if self.geared.axis is not None:
            return complex(*self.geared.axis)
        return self.at_pin + rect(mesh.driver + mesh.shaft, mesh.direction)

    def is_clear(self, mesh: Mesh) -> bool:
        """Whether the counterweight runs into no link that it must stay clear of."""
        return not self._hit(mesh)

    def _hit(self, mesh: Mesh) -> Note | None:
        """What is wrong with where the shaft is, if anything is."""
        axis, room = self.axis(mesh), max(self.geared.weight.radius, mesh.shaft)
        for link in self.geared.clear_of:
            distance = nearest(self.motion, link, axis)
            if distance < room:
                return Note(
                    "the {name} would run into {link}, which comes within {distance:.4g} mm of "
                    "its shaft, while it needs {room:.4g} mm; give it less room, another "
                    "place, or another plane (leave the link out of clear_of)",
                    name=self.geared.name,
                    link=link,
                    distance=distance * 1e3,
                    room=room * 1e3,
                )
        return None

    def added(self, mesh: Mesh, to: Machine | None = None) -> tuple[Machine, AddedWeight]:
        """A machine with shaft and gears, and the weight that is free on the shaft.

        to : the machine with what else is added to it, that of the gearing where not given.
        """
        machine, geared = self.machine if to is None else to, self.geared
        place: Vector = (self.axis(mesh).real, self.axis(mesh).imag)
        mass, inertia = self._gear(mesh.shaft)
        plane = geared.weight.plane
        if plane is None:
            plane = machine.links[geared.driver].plane
        shaft = Link({self.name: (0.0, 0.0)}, mass, (0.0, 0.0), inertia, plane=plane)
        turning = {"ratio": -mesh.ratio} if mesh.teeth is None else {"teeth": mesh.teeth}
        machine = _with_gear(machine, geared.driver, self.pin, *self._gear(mesh.driver))
        machine = replace(
            machine,
            frame={**machine.frame, self.name: place},
            links={**machine.links, geared.name: shaft},
            gears=(*machine.gears, Gear(geared.driver, geared.name, **turning)),
        )
        return machine, AddedWeight(machine, geared.name, self.name, geared.weight)

    def _gear(self, radius: float) -> tuple[float, float]:
        """Mass and inertia of a gear, a solid disc."""
        thickness, density = self.geared.gear_thickness, self.geared.gear_density
        if thickness is None or density is None:
            return 0.0, 0.0
        mass = pi * radius**2 * thickness * density
        return mass, mass * radius**2 / 2

    def change(self, mesh: Mesh) -> Change:
        """The gears, as a workshop needs them."""
        axis = self.axis(mesh)
        values: dict[str, Any] = {
            "driver": self.geared.driver,
            "ratio": mesh.ratio,
            "pitch_radii": (mesh.driver, mesh.shaft),
            "axis": (axis.real, axis.imag),
        }
        masses = self._gear(mesh.driver)[0], self._gear(mesh.shaft)[0]
        if any(masses):
            values["masses"] = masses
        if mesh.teeth is not None:
            values["teeth"] = mesh.teeth
            values["module"] = self.geared.module
        return Change("gears", self.geared.name, values)


def _with_gear(machine: Machine, link: str, pin: str, mass: float, inertia: float) -> Machine:
    """The machine with a disc about a pin of a link."""
    if not mass:
        return machine
    values = parameter_values(machine).reshape(-1, 4)[list(machine.links).index(link)]
    m, moment, own = about(mass, 0j, inertia, -complex(*machine.links[link].points[pin]))
    return with_parameters(machine, link, values + np.array([m, moment.real, moment.imag, own]))


def nearest(motion: Motion, link: str, place: complex) -> float:
    """How near a link's points, and the lines between them, come to a place over a turn, m."""
    points = [motion.points[name].place for name in motion.machine.links[link].points]
    least = min(float(np.min(np.abs(p - place))) for p in points)
    for point, other in combinations(points, 2):
        along = other - point
        share = np.real((place - point) * np.conj(along)) / np.maximum(np.abs(along) ** 2, TINY)
        foot = point + np.clip(share, 0.0, 1.0) * along
        least = min(least, float(np.min(np.abs(foot - place))))
    return least


def with_shafts(machine: Machine, shafts: BalanceShafts) -> tuple[Machine, list[AddedWeight]]:
    """The machine with two balance shafts, and the weight that is free on each.

    The first is geared to the drive's link and turns against it; the second is geared to the
    first, and turns with the drive's link: a pair of gears from outside each time.
    """
    names = [f"{shafts.name}-{k}" for k in (1, 2)]
    points = dict(zip(names, (f"{name}-axis" for name in names), strict=True))
    drive, plane = machine.drive.link, shafts.weight.plane
    plane = machine.links[drive].plane if plane is None else plane
    empty = {
        name: Link({at: (0.0, 0.0)}, 0.0, (0.0, 0.0), 0.0, plane=plane)
        for name, at in points.items()
    }
    gears = (
        Gear(drive, names[0], ratio=-float(shafts.order)),
        Gear(names[0], names[1], ratio=-1.0),
    )
    machine = replace(
        machine,
        frame={**machine.frame, **dict(zip(points.values(), shafts.axes, strict=True))},
        links={**machine.links, **empty},
        gears=(*machine.gears, *gears),
    )
    weights = [AddedWeight(machine, name, at, shafts.weight) for name, at in points.items()]
    return machine, weights


GearChoice = tuple[Mesh, ...]
"""The gears of all shafts, in the order of the plan."""

LARGE = 1e300
"""A cost that every solution is below, while none is known."""
CLOSER, NEARER = 1e-10, 1e-6
"""Of the cost, and of a ratio or direction, to which the best ones of a range are followed."""
TIE, MOST_TIES, LIGHT_TIES = 5e-9, 24, 8
"""Difference in cost that is none; choices, all over the range, among which the lightest is looked
for; and those beside them that looked lightest at first.
"""
BEST_CHOICES, STEPS, MOST_STEPS = 3, 40, 80
"""Choices that are followed; first steps over a range; programs that are solved for each and for
each shaft with a range.
"""
MOST_CHOICES, MOST_ROUNDS = 640, 4
"""Choices of several shafts together that are all tried: some 20 s, and 25 of each of two; rounds
over the shafts where there are more, of which the second seldom finds anything.
"""


@dataclass(frozen=True, eq=False)
class WithShafts:
    """A machine with shafts that its plan adds: the weights on them, and their gears."""

    machine: Machine
    plan: Balance
    base: Machine
    weights: tuple[AddedWeight, ...] = ()
    gears: tuple[Change, ...] = ()

    def with_gears(self, gearing: Gearing, mesh: Mesh) -> WithShafts:
        """With one more geared shaft."""
        base, weight = gearing.added(mesh, self.base)
        gears = (*self.gears, gearing.change(mesh))
        return replace(self, base=base, weights=(*self.weights, weight), gears=gears)

    def solved(self, progress: ProgressCallback | None = None, above: float = inf) -> Solution:
        """The best numbers with these gears; less closely where they cost more than `above`."""
        problem = Problem.of(self.machine, self.plan, self.base, self.weights)
        return replace(solve_problem(problem, progress, above), meshes=self.gears)


@dataclass(frozen=True)
class GearTrial:
    """What stays of a choice of gears that was solved: thousands of whole solutions need gigabytes.

    mass : added in all by the best weights, kg.  nodes : cone programs solved.
    """

    mass: float
    nodes: int


class GearSearch(DesignProblem):
    """The gears of every geared shaft of a plan, around the cone program.

    Of each shaft with several choices of gears the variables are which of them, and what of it may
    be any number between two: ratio, direction.

    start : the machine with all that is added to it but these shafts.

    Raises
    ------
    UsageError : no gears of a shaft mesh, or leave room for its counterweight.
    """

    def __init__(self, start: WithShafts, progress: ProgressCallback | None = None) -> None:
        self.start, self.progress, self.solvers = start, progress, (GearGrid(),)
        self.gearings = [Gearing(start.base, geared) for geared in start.plan.geared]
        self.options = [gearing.meshes() for gearing in self.gearings]
        self.ranges = [
            (k, name, *limits)
            for k, gearing in enumerate(self.gearings)
            for name, limits in gearing.ranges.items()
        ]
        self.tried: list[tuple[GearChoice, GearTrial]] = []
        self.costs: dict[GearChoice, float] = {}
        self.first_error: UsageError | None = None
        self.most = 0

    @property
    def spreads(self) -> list[Range | Choices]:
        options = (Choices(tuple(map(float, range(len(own))))) for own in self.options)
        return [*options, *(Range(low, high) for _, _, low, high in self.ranges)]

    def evaluate(self, places: Array) -> tuple[Array, Array]:
        """Costs (n, 1), and 1 where gears do not mesh or limits clash, else 0, (n, 1)."""
        costs = []
        for values in self.values_of(places):
            options, numbers = np.split(values, [len(self.options)])
            start = (own[int(k)] for own, k in zip(self.options, options, strict=True))
            choice = self.with_numbers(tuple(start), numbers)
            costs.append(inf if choice is None else self.cost(choice))
        impossible = ~np.isfinite(np.array(costs)[:, None])
        return np.where(impossible, LARGE, np.array(costs)[:, None]), impossible.astype(float)

    def run(self) -> Solution:
        """The best choice of gears, the lightest of those that are as good, with its weights.

        Raises
        ------
        UsageError : limits clash, whatever the gears.
        """
        everything = prod(map(len, self.options))
        if everything == 1:
            (choice,) = product(*self.options)
            return self._with(choice).solved(self.progress)
        solve(self)
        if not self.tried:
            assert self.first_error is not None  # of each choice there is a solution or an error
            raise self.first_error
        options = [set(own) for own in self.options]
        tried = sum(all(map(set.__contains__, options, choice)) for choice in self.costs)
        return replace(self._lightest(), gears_left=tried < everything)

    def _with(self, choice: GearChoice) -> WithShafts:
        with_shafts = self.start
        for gearing, mesh in zip(self.gearings, choice, strict=True):
            with_shafts = with_shafts.with_gears(gearing, mesh)
        return with_shafts

    def with_numbers(self, start: GearChoice, numbers: Array) -> GearChoice | None:
        """Gears with other numbers of `ranges`; None where a counterweight hits a link."""
        here: list[dict[str, float]] = [{} for _ in start]
        for (k, name, *_), number in zip(self.ranges, numbers, strict=True):
            here[k][name] = float(number)
        each = list(zip(self.gearings, start, here, strict=True))
        choice = tuple(
            gearing.with_numbers(mesh, own) if own else mesh for gearing, mesh, own in each
        )
        clear = all(
            gearing.is_clear(mesh)
            for gearing, mesh, own in zip(self.gearings, choice, here, strict=True)
            if own
        )
        return choice if clear else None

    def cost(self, choice: GearChoice) -> float:
        """Cost with these gears, not closely where others cost less; infinite where none do."""
        above = min([LARGE, *self.costs.values()])
        try:
            solution = self._with(choice).solved(None, above)
        except UsageError as error:
            if self.first_error is None:  # not all: the frames of each hold a whole problem
                self.first_error = error.with_traceback(None)
            self.costs.setdefault(choice, inf)
            return inf
        cost, mass = solution.best.value, solution.problem.mass_added(solution.numbers)
        self.tried.append((choice, GearTrial(mass, solution.best.nodes)))
        if self.progress is not None:
            self.most = max(self.most, len(self.tried))
            self.progress(len(self.tried), self.most)
        # The second time, and above the best of all, it may be solved less closely.
        self.costs[choice] = min(cost, self.costs.get(choice, inf))
        return cost

    def _lightest(self) -> Solution:
        """The lightest of those that cost least."""
        least = min(self.costs.values())
        ties = {
            choice: item.mass for choice, item in self.tried if self.costs[choice] <= least + TIE
        }
        equal = sorted(ties, key=lambda choice: [(item.ratio, item.direction) for item in choice])
        light = sorted(equal, key=ties.__getitem__)[:LIGHT_TIES]
        tried = dict.fromkeys([*equal[:: max(1, len(equal) // MOST_TIES)], *light])
        lightest = min(
            (self._with(choice).solved() for choice in tried),
            key=lambda solution: solution.problem.mass_added(solution.numbers),
        )
        method = Note(
            "{method}, for each of {count} choices of gears",
            method=lightest.method,
            count=len(self.tried),
        )
        return replace(
            lightest,
            method=method,
            best=replace(lightest.best, nodes=sum(item.nodes for _, item in self.tried)),
            ties=len(equal),
            weighed=len(tried),
        )


class GearGrid:
    """Choices over the whole range, of which the best are followed downhill."""

    name = "grid of gears, followed downhill"

    def suits(self, problem: GearSearch) -> bool:
        return True

    def solve(self, problem: GearSearch) -> DesignSolution:
        choices = _first_choices(problem.options)
        ranged = len({k for k, *_ in problem.ranges})
        problem.most = len(choices) + BEST_CHOICES * MOST_STEPS * ranged
        for choice in choices:
            problem.cost(choice)
        if problem.tried and len(choices) < prod(map(len, problem.options)):
            problem.most += BEST_CHOICES * sum(map(len, problem.options))
            for choice in _best_choices(problem):
                _try_by_turns(problem, choice)
        if problem.tried and problem.ranges:
            for choice in _best_choices(problem):
                _follow(problem, choice)
        return DesignSolution(np.empty((0, len(problem.spreads))))


def _first_choices(options: list[list[Mesh]]) -> list[GearChoice]:
    """All choices; of several shafts with too many together, some of each."""
    choices = options
    several = sum(len(own) > 1 for own in choices) > 1
    while several and prod(map(len, choices)) > MOST_CHOICES:
        longest = max(map(len, choices))
        choices = [_some(own, min(len(own), longest - 1)) for own in options]
    return list(product(*choices))


def _best_choices(problem: GearSearch) -> list[GearChoice]:
    """The first among equals, so that the same search ends at the same gears everywhere."""
    there = [choice for choice, cost in problem.costs.items() if np.isfinite(cost)]
    return sorted(there, key=problem.costs.__getitem__)[:BEST_CHOICES]


def _try_by_turns(problem: GearSearch, best: GearChoice) -> None:
    """Try all gears of one shaft after the other, until none is better."""
    for _ in range(MOST_ROUNDS):
        before = best
        for k, own in enumerate(problem.options):
            ways = [(*best[:k], mesh, *best[k + 1 :]) for mesh in own]
            for way in ways:
                if way not in problem.costs:
                    problem.cost(way)
            best = min((best, *ways), key=problem.costs.__getitem__)
        if best == before:
            return


def _follow(problem: GearSearch, start: GearChoice) -> None:
    """Go down from a choice of gears, along all that may be any number between two."""
    from scipy.optimize import minimize

    def at(numbers: Array) -> float:
        choice = problem.with_numbers(start, numbers)
        return inf if choice is None else problem.cost(choice)

    begin = np.array([getattr(start[k], name) for k, name, *_ in problem.ranges])
    limits = np.array([ends for _, _, *ends in problem.ranges])
    steps = (limits[:, 1] - limits[:, 0]) / STEPS
    simplex = np.vstack([begin, *(begin + step for step in np.diag(steps))])
    over = simplex > limits[:, 1]
    simplex[over] = (2 * begin - simplex)[over]
    most = MOST_STEPS * len({k for k, *_ in problem.ranges})
    options = {"initial_simplex": simplex, "xatol": NEARER, "fatol": CLOSER, "maxfev": most}
    minimize(at, begin, method="Nelder-Mead", bounds=limits, options=options)


def _some(own: list[Mesh], count: int) -> list[Mesh]:
    """So many of the gears of a shaft, all over their range, both ends among them."""
    return [own[k] for k in np.rint(np.linspace(0, len(own) - 1, count)).astype(int)]
