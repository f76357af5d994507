"""Balancing by a second route: outputs as affine functions, and a search that knows no theory.

Nothing of `equipoise.balancing` is used.  What the outputs of a machine have to do with mass, first
moments and moment of inertia of its links is found from a handful of analyses of machines whose
links have been given other masses; the outputs are affine in these four numbers of each link.  What
may be changed is written in coordinates of its own (mass, place, spread...), every one between two
numbers, among which differential evolution looks for the least cost; the best that it finds is
polished by sequential quadratic programming.  The crank turns evenly, and signals
are read at 720 crank angles in each turn; where loads jump, what is compared with the product's
values is integrated piece by piece.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from math import inf, isfinite, pi
from typing import Any

import numpy as np
from scipy.optimize import differential_evolution, minimize
from scipy.signal import resample

import equipoise as eq
from equipoise.mechanism.parts.gears import Gear
from equipoise.mechanism.parts.machine import Link, Machine
from support.poses import Array, drive_pivot

SAMPLES = 720
DENSER = 64
"""Values for each of these by which peaks between samples are seen: through three of them goes a
parabola, to 1e-12 of order 5."""
FEWER, BEYOND = 4 * DENSER, 1e-8
"""Of these values one in so many is in a convex program at first; then the tops of its solution
that are above all those in it, by this share, until there are none: to 6e-8 of order 5."""
CLOSER = 16
"""Crank angles for each of these, among which peaks are sought where loads jump: to 1e-6 of it."""
BESIDE = 1e-7
"""Way before a jump at which a signal is read, rad: beyond what loads round their angles to."""
NEGLIGIBLE = 1e-9
"""Share of a limit by which it may be passed."""
Output = tuple[str, str | None, tuple[float, ...]]
"""What a signal is of: its name, the point of a moment, and the orders that count."""
Parameters = tuple[float, float, float, float]
"""Mass, first moments and moment of inertia of a link about the origin of its axes."""


# -- outputs of machines ---------------------------------------------------------------------------


def output_of(objective: eq.balancing.Objective) -> Output:
    return objective.output, objective.about, objective.orders


def signal_of(analysis: Any, name: str) -> Array:
    """Return an output by its name as components against crank angle, (1 or 2, N)."""
    name, dot, component = name.rpartition(".") if name.endswith((".x", ".y")) else (name, "", "")
    forces = analysis.forces
    actual = forces.joints[name[7:]] if name.startswith("joints.") else getattr(forces, name)
    if dot:
        return np.array([getattr(actual, component)])
    return np.array([actual.x, actual.y] if hasattr(actual, "x") else [actual])


def only(orders: tuple[float, ...], signal: Array, turns: int) -> Array:
    """Leave some orders of the crank of signals (..., N) over some turns."""
    if not orders:
        return signal
    series = np.fft.rfft(signal)
    kept = np.zeros(series.shape[-1], bool)
    kept[[round(order * turns) for order in orders if round(order * turns) < len(kept)]] = True
    return np.fft.irfft(series * kept, signal.shape[-1])


def signals_of(machine: Machine, outputs: Sequence[Output]) -> list[Array]:
    """Return outputs of a machine, each (1 or 2, N)."""
    analyses = {
        about: eq.analyze(machine, SAMPLES, acceleration=0.0, about=about)
        for _, about, _ in outputs
    }
    return [
        only(orders, signal_of(analyses[about], name), analyses[about].motion.turns)
        for name, about, orders in outputs
    ]


def value_of(measure: str, signal: Array) -> Any:
    """Return a measure of signals (1 or 2, N, ...) over all their crank angles."""
    square = np.sum(signal**2, 0)
    if measure == "rms":
        return np.sqrt(np.mean(square, 0))
    if measure == "peak":
        return np.sqrt(np.max(square, 0))
    (first,) = signal
    if measure == "ripple":
        return np.std(first, 0)
    if measure == "peak_to_peak":
        return np.ptp(first, 0)
    assert measure == "area"
    return 2 * pi * np.mean(np.abs(first), 0)


def measured(machine: Machine, objective: eq.balancing.Objective) -> float:
    """Return what an objective is in a machine, from samples at equally spaced crank angles."""
    return float(value_of(objective.measure, signals_of(machine, [output_of(objective)])[0]))


def measured_exactly(machine: Machine, objective: eq.balancing.Objective) -> float:
    """Return what an objective is in a machine; peaks are those of the trigonometric polynomial
    through the samples; where loads jump, mean squares and orders are taken piece by piece, and
    peaks at both sides of the jumps too.
    """
    if objective.measure.startswith("peak") and not loads_jump(machine):
        signal = signals_of(machine, [output_of(objective)])[0]
        fine = resample(signal, DENSER * signal.shape[1], axis=1)
        if objective.measure == "peak":
            return float(np.sqrt(_top(np.sum(fine**2, 0))))
        return _top(fine[0]) + _top(-fine[0])
    if objective.measure == "area" or not loads_jump(machine):
        return measured(machine, objective)
    return _measured_in_pieces(machine, objective)


def _top(values: Array) -> float:
    """Top of the parabola through the highest of periodic values (N,) and its neighbours."""
    k = int(np.argmax(values))
    before, top, after = values[k - 1], values[k], values[(k + 1) % len(values)]
    bend = before - 2 * top + after
    return float(top - (after - before) ** 2 / (8 * bend)) if bend else float(top)


def loads_jump(machine: Machine) -> bool:
    """Tell whether loads set in or end suddenly: equally spaced samples miss the jumps' places."""
    return any(load.start is not None or load.outside == "zero" for load in machine.loads)


def _measured_in_pieces(machine: Machine, objective: eq.balancing.Objective) -> float:
    """Integrate by Gauss's rule between the crank angles at which loads jump or bend."""
    output, about, orders = output_of(objective)
    turns = eq.move(machine, SAMPLES).turns
    edges = []
    for load in machine.loads:
        of_table = () if load.table is None else load.table.crank_angle
        steps = (item for item in (load.start, load.stop) if item is not None)
        edges += np.mod([*steps, *of_table], 2 * pi).tolist()
    sides = np.add.outer(2 * pi * np.arange(turns), edges)
    grid = np.add.outer(2 * pi * np.arange(turns), np.linspace(0, 2 * pi, 181))
    ends = np.unique(np.concatenate([grid.ravel(), sides.ravel()]))
    nodes, weights = np.polynomial.legendre.leggauss(9)
    theta = (ends[:-1, None] + np.diff(ends)[:, None] * (1 + nodes) / 2).ravel()
    shares = (np.diff(ends)[:, None] * weights).ravel() / (4 * pi * turns)

    def signal_at(angles: Array) -> Array:
        return signal_of(eq.analyze(machine, angles, acceleration=0.0, about=about), output)

    signal, shown = signal_at(theta), theta
    if objective.measure.startswith("peak"):
        count = SAMPLES * CLOSER
        even = 2 * pi * np.arange(count * turns) / count
        shown = np.concatenate(
            [even, sides.ravel(), np.mod(sides.ravel() - BESIDE, 2 * pi * turns)]
        )
    if orders:
        rates = np.array(orders)
        amplitudes = (signal * shares) @ np.exp(-1j * np.outer(theta, rates))
        signal = 2 * (amplitudes @ np.exp(1j * np.outer(rates, shown))).real
    elif shown is not theta:
        signal = signal_at(shown)
    if shown is not theta:
        return float(value_of(objective.measure, signal))
    if objective.measure == "ripple":
        signal = signal - np.sum(signal * shares)
    return float(np.sqrt(np.sum(signal**2 * shares)))


def parameters_of(link: Link) -> Parameters:
    """Return mass, first moments and moment of inertia of a link about its axes' origin."""
    mass, (x, y) = link.mass or 0.0, link.center_of_mass or (0.0, 0.0)
    return mass, mass * x, mass * y, (link.inertia or 0.0) + mass * (x * x + y * y)


def with_parameters(machine: Machine, name: str, given: Array | Parameters) -> Machine:
    """Give a link mass, first moments and moment of inertia about its axes' origin."""
    mass, sx, sy, inertia = map(float, given)
    if mass == 0:
        return machine.with_link(name, mass=0.0, center_of_mass=(0.0, 0.0), inertia=0.0)
    center = (sx / mass, sy / mass)
    about = inertia - (sx * sx + sy * sy) / mass
    about = about if about > 1e-14 * inertia else 0.0  # all of it in one point, but for rounding
    return machine.with_link(name, mass=mass, center_of_mass=center, inertia=about)


def spot(mass: float, x: float, y: float, inertia: float = 0.0) -> Array:
    """Return the parameters of a mass at a place, with a moment of inertia of its own."""
    return np.array([mass, mass * x, mass * y, inertia + mass * (x * x + y * y)])


# -- what may be changed ---------------------------------------------------------------------------


@dataclass(frozen=True)
class Part:
    """Something that may be changed, by coordinates between `low` and `high`.

    effect : of coordinates (d, S) on the link's parameters, (4, S).
    """

    link: str
    low: tuple[float, ...]
    high: tuple[float, ...]
    effect: Callable[[Array], Array]
    added: bool = True


def moved(move: eq.balancing.CenterMove, machine: Machine) -> Part:
    """Move a centre of mass in its rectangle or circle."""
    mass, sx, sy, _ = parameters_of(machine.links[move.link])
    old = (sx / mass) ** 2 + (sy / mass) ** 2

    def by(x: Array, y: Array) -> Array:
        square = mass * (x * x + y * y - old)
        return np.array([0 * x, mass * x - sx, mass * y - sy, square])

    if move.center is not None:
        (cx, cy), radius = move.center, move.radius or 0.0

        def turned(at: Array) -> Array:
            return by(cx + radius * at[0] * np.cos(at[1]), cy + radius * at[0] * np.sin(at[1]))

        return Part(move.link, (0.0, -4.0), (1.0, 4.0), turned, added=False)
    assert move.x is not None and move.y is not None
    low, high = zip(move.x, move.y, strict=True)
    return Part(move.link, low, high, lambda at: by(*at), added=False)


def plate(weight: eq.balancing.Weight) -> float:
    """Mass of a plate in kg/m2."""
    return (weight.thickness or 0.0) * (weight.density or 0.0)


def mass_range(weight: eq.balancing.Weight) -> tuple[float, float]:
    """Return least and largest mass of a weight that fits into its room, kg."""
    if weight.mass is not None:
        return weight.mass, weight.mass
    room = pi * (weight.radius**2 - weight.inner_radius**2) * plate(weight) or inf
    return 0.0, min(room, inf if weight.at_most is None else weight.at_most)


Shape = Callable[[eq.balancing.Weight, Array], tuple[Array, Array, Array]]
"""Of mass and further coordinates: mass, distance times mass, inertia about the room's centre."""


def _any(weight: eq.balancing.Weight, at: Array) -> tuple[Array, Array, Array]:
    mass, _, out, spread = at
    radius = weight.radius
    return mass, mass * radius * out, mass * radius**2 * (out**2 + spread * (1 - out**2))


def _point(weight: eq.balancing.Weight, at: Array) -> tuple[Array, Array, Array]:
    mass, _, out = at
    return mass, mass * weight.radius * out, mass * (weight.radius * out) ** 2


def _disc(weight: eq.balancing.Weight, at: Array) -> tuple[Array, Array, Array]:
    mass, _, out = at
    size = np.sqrt(np.maximum(mass, 0) / (pi * plate(weight)))
    distance = out * (weight.radius - size)
    return mass, mass * distance, mass * (distance**2 + size**2 / 2)


def _ring(weight: eq.balancing.Weight, at: Array) -> tuple[Array, Array, Array]:
    mass, inner = at[0], weight.inner_radius
    outer = np.sqrt(np.maximum(mass, 0) / (pi * plate(weight)) + inner**2)
    return mass, 0 * mass, mass * (inner**2 + outer**2) / 2


def _sector(weight: eq.balancing.Weight, at: Array) -> tuple[Array, Array, Array]:
    mass, outer, inner = at[0], weight.radius, weight.inner_radius
    half = mass / (plate(weight) * (outer**2 - inner**2))
    moment = 2 / 3 * plate(weight) * (outer**3 - inner**3) * np.sin(half)
    return mass, moment, mass * (inner**2 + outer**2) / 2


TURNABLE = (-4.0, 4.0)
"""A little more than a turn, so that no direction lies at the edge."""
SHAPES: dict[str, tuple[Shape, tuple[tuple[float, float], ...]]] = {
    "any": (_any, (TURNABLE, (0.0, 1.0), (0.0, 1.0))),
    "point": (_point, (TURNABLE, (0.0, 1.0))),
    "disc": (_disc, (TURNABLE, (0.0, 1.0))),
    "ring": (_ring, ()),
    "sector": (_sector, (TURNABLE,)),
}


def weighed(link: str, center: tuple[float, float], weight: eq.balancing.Weight) -> Part:
    """Add a mass to a link about one of its points."""
    shape, further = SHAPES[weight.shape]
    low, high = zip(mass_range(weight), *further, strict=True)
    assert isfinite(weight.radius)
    cx, cy = center

    def effect(at: Array) -> Array:
        mass, moment, inertia = shape(weight, at)
        direction = at[1] if len(at) > 1 else 0.0
        sx, sy = moment * np.cos(direction), moment * np.sin(direction)
        about = inertia + 2 * (cx * sx + cy * sy) + mass * (cx**2 + cy**2)
        return np.array([mass, mass * cx + sx, mass * cy + sy, about])

    return Part(link, low, high, effect)


def with_shaft(machine: Machine, geared: eq.balancing.GearedWeight, ratio: float) -> Machine:
    """Add the shaft of a geared counterweight, without mass, turning `ratio` times as fast."""
    name = geared.name
    pivot = next(p for p in machine.links[geared.driver].points if p in machine.frame)
    axis = geared.axis or axis_of(machine, geared, ratio)
    frame = {**machine.frame, f"{name} shaft": axis}
    shaft = Link({f"{name} shaft": (0.0, 0.0)}, 0.0, (0.0, 0.0), 0.0)
    assert pivot != f"{name} shaft"
    return replace(
        machine,
        frame=frame,
        links={**machine.links, name: shaft},
        gears=(*machine.gears, Gear(geared.driver, name, -ratio)),
        balance=None,
    )


def axis_of(
    machine: Machine, geared: eq.balancing.GearedWeight, ratio: float
) -> tuple[float, float]:
    """Return where a shaft lies whose gear meshes with one of the driver's pitch radius."""
    pin = next(at for p, at in machine.frame.items() if p in machine.links[geared.driver].points)
    assert geared.pitch_radius is not None
    direction = geared.direction
    if direction is None:
        x, y = np.subtract(pin, machine.frame[drive_pivot(machine)])
        direction = np.arctan2(y, x)
    apart = geared.pitch_radius * (1 + 1 / ratio)
    return (
        float(pin[0] + apart * np.cos(direction)),
        float(pin[1] + apart * np.sin(direction)),
    )


# -- cost and limits as functions of the coordinates -----------------------------------------------


@dataclass(frozen=True)
class Measured:
    """A measure of an output whose signal is affine in the parameters.

    base : signal of the machine without changes, (1 or 2, N).  columns : by each parameter,
        (1 or 2, N, P).  before : value that the changes are measured against.
    """

    measure: str
    base: Array
    columns: Array
    before: float

    @cached_property
    def factor(self) -> Array:
        """R with |R (1, p)| the root of the mean square."""
        stack = np.concatenate([self.base[..., None], self.columns], -1)
        if self.measure == "ripple":
            stack = stack - stack.mean(1, keepdims=True)
        rows = stack.reshape(-1, stack.shape[-1]) / np.sqrt(self.base.shape[1])
        return np.linalg.qr(rows, mode="r")

    @property
    def smooth(self) -> bool:
        return self.measure in ("rms", "ripple")

    def signal(self, changes: Array) -> Array:
        """(1 or 2, N, S) for changes (P, S)."""
        return self.base[..., None] + self.columns @ changes

    def values(self, changes: Array) -> Array:
        """(S,) for changes (P, S) of the parameters."""
        if self.smooth:
            first = np.ones((1, changes.shape[1]))
            return np.linalg.norm(self.factor @ np.concatenate([first, changes]), axis=0)
        return value_of(self.measure, self.signal(changes))


@dataclass
class Problem:
    """A plan in coordinates: cost, and limits as shares by which they are passed."""

    machine: Machine
    plan: eq.balancing.Balance
    ratio: float = 1.0
    parts: list[Part] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.original = self.machine
        for geared in self.plan.geared:
            ratio = geared.ratio[0] if geared.ratio else self.ratio
            self.machine = with_shaft(self.machine, geared, ratio)
        points = {name: link.points for name, link in self.machine.links.items()}
        self.parts = [
            *(moved(move, self.machine) for move in self.plan.moves),
            *(weighed(a.link, points[a.link][a.at], a.weight) for a in self.plan.masses),
            *(weighed(g.name, (0.0, 0.0), g.weight) for g in self.plan.geared),
        ]
        self.links = list(dict.fromkeys(part.link for part in self.parts))
        wishes = [*self.plan.objectives, *(limit.objective for limit in self.plan.limits)]
        self.affine = self._affine(wishes)
        count = len(self.plan.objectives)
        self.goals, self.kept = self.affine[:count], self.affine[count:]
        # a weight multiplies the value, or in a sum of squares the square of it
        root = 0.5 if self.plan.combine == "squares" else 1.0
        self.weights = [objective.weight**root for objective in self.plan.objectives]
        self.limits = [
            limit.at_most if limit.at_most is not None else (limit.ratio or 0.0) * goal.before
            for limit, goal in zip(self.plan.limits, self.kept, strict=True)
        ]

    def _affine(self, wishes: Sequence[eq.balancing.Objective]) -> list[Measured]:
        """Learn from a few machines what the outputs have to do with the parameters."""
        outputs = [output_of(wish) for wish in wishes]
        before = signals_of(self.original, outputs)
        base = signals_of(self.machine, outputs)
        columns: list[list[Array]] = [[] for _ in outputs]
        for link in self.links:
            old = np.array(parameters_of(self.machine.links[link]))
            size = max(np.hypot(*at) for at in self.machine.links[link].points.values()) or 0.1
            mass = old[0] or 1.0
            given = np.array(
                [
                    spot(mass, 0, 0, mass * size**2),
                    spot(mass, size, 0),
                    spot(mass, 0, size),
                    spot(mass, -size, -size),
                ]
            )
            actual = [
                signals_of(with_parameters(self.machine, link, old + item), outputs)
                for item in given
            ]
            for number, gathered in enumerate(columns):
                risen = np.stack([item[number] - base[number] for item in actual], -1)
                gathered.append(risen @ np.linalg.inv(given).T)
        return [
            Measured(w.measure, b, np.concatenate(c, -1), float(value_of(w.measure, old)))
            for w, b, c, old in zip(wishes, base, columns, before, strict=True)
        ]

    @cached_property
    def bounds(self) -> list[tuple[float, float]]:
        return [pair for part in self.parts for pair in zip(part.low, part.high, strict=True)]

    def changes(self, at: Array) -> tuple[Array, Array]:
        """Changes of all parameters (P, S), and mass added in all (S,), at coordinates (d, S)."""
        actual = {link: np.zeros((4, at.shape[1])) for link in self.links}
        added, first = np.zeros(at.shape[1]), 0
        for part in self.parts:
            last = first + len(part.low)
            effect = part.effect(at[first:last])
            actual[part.link] += effect
            added += effect[0] if part.added else 0.0
            first = last
        return np.concatenate([actual[link] for link in self.links]), added

    def combined(self, values: Array | list[Array]) -> Any:
        """Cost of values of the objectives over those before."""
        shares = np.array([w * v for w, v in zip(self.weights, values, strict=True)])
        return np.sum(shares, 0) if self.plan.combine == "sum" else np.sqrt(np.sum(shares**2, 0))

    def judged(self, at: Array) -> tuple[Array, Array]:
        """Cost (S,), and by what share the worst limit is passed (S,), at coordinates (d, S)."""
        changes, added = self.changes(at)
        cost = self.combined([goal.values(changes) / goal.before for goal in self.goals])
        passed = np.full(at.shape[1], -1.0)
        for limit, kept in zip(self.limits, self.kept, strict=True):
            passed = np.maximum(passed, kept.values(changes) / limit - 1)
        if self.plan.added_mass is not None:
            passed = np.maximum(passed, added / self.plan.added_mass - 1)
        return cost, passed

    def rank(self, at: Array) -> Array:
        """Cost where all limits are kept, else more than any cost."""
        at = at if at.ndim == 2 else at[:, None]
        cost, passed = self.judged(at)
        return np.where(passed <= NEGLIGIBLE, cost, 1e6 * (1 + passed))

    def rebuilt(self, at: Array) -> Machine:
        """Return the machine at coordinates (d,)."""
        changes, _ = self.changes(at[:, None])
        machine = self.machine
        for number, link in enumerate(self.links):
            old = np.array(parameters_of(machine.links[link]))
            new = old + changes[4 * number : 4 * number + 4, 0]
            machine = with_parameters(machine, link, new)
        return machine


# -- the search ------------------------------------------------------------------------------------


def evolved(
    problem: Problem, seed: int = 0, turns: int = 120, size: int = 10, polished: int = 4
) -> tuple[float, Array]:
    """Return least cost and its coordinates by differential evolution, then polishing."""
    low, high = np.array(problem.bounds).T
    bounds = list(zip(low, np.maximum(high, low + 1e-300), strict=True))
    optimum = differential_evolution(
        problem.rank,
        bounds,
        seed=seed,
        maxiter=turns,
        popsize=size,
        tol=0,
        atol=0,
        vectorized=True,
        updating="deferred",
        polish=False,
        x0=None,
    )
    order = np.argsort(optimum.population_energies)
    starts = optimum.population[order[np.linspace(0, len(order) // 2, polished, dtype=int)]]
    best, at = float(optimum.fun), optimum.x
    for start in starts:
        end = polish(problem, polish(problem, start))
        cost = float(problem.rank(end)[0])
        if cost < best:
            best, at = cost, end
    return best, at


def polish(problem: Problem, start: Array, most: int = 40) -> Array:
    """Walk downhill by sequential quadratic programming.

    Each peak is a variable of its own that the signal stays below at the crank angles at which it
    comes near; where the walk leads past a limit, the walker is pulled back towards the start.
    """
    walk = _Walk(problem, start, most)
    end = np.clip(walk.end(), *np.array(problem.bounds).T)
    cost = problem.rank(start)[0]
    for share in (1.0, 1 - 1e-9, 1 - 1e-7, 1 - 1e-5, 0.999, 0.9, 0.5):
        at = start + share * (end - start)
        if problem.rank(at)[0] < cost:
            return at
    return start


PAIRED = 20
"""Crank angles of high and of low values that are compared with each other."""


def few(rows: Array, most: int) -> Array:
    """Thin out some numbers, or repeat them, to as many as asked for."""
    return rows[np.linspace(0, len(rows) - 1, most).astype(int)]


class _Walk:
    """Coordinates, then one height for each measure: all are walked in together."""

    def __init__(self, problem: Problem, start: Array, most: int) -> None:
        self.problem, self.most = problem, most
        self.low, self.high = np.array(problem.bounds).T
        self.scale = np.where(self.high > self.low, self.high - self.low, 1.0)
        self.count = len(start)
        changes, _ = problem.changes(start[:, None])
        self.measures = problem.affine
        self.over = [
            *(goal.before for goal in problem.goals),
            *problem.limits,
        ]
        self.rows = [self._near(measure, changes) for measure in self.measures]
        heights = [float(m.values(changes)[0]) / o for m, o in self._sized()]
        self.start = np.concatenate([(start - self.low) / self.scale, heights])

    def _sized(self) -> list[tuple[Measured, float]]:
        return list(zip(self.measures, self.over, strict=True))

    @staticmethod
    def _near(measured: Measured, changes: Array) -> Array:
        """Crank angles at which the signal is near to its peak, thinned out."""
        if measured.measure not in ("peak", "peak_to_peak"):
            return np.zeros(0, int)
        signal = measured.signal(changes)[..., 0]
        if measured.measure == "peak":
            size = np.linalg.norm(signal, axis=0)
            return few(np.flatnonzero(size > 0.8 * size.max()), 100)
        edge = 0.1 * np.ptp(signal)
        highs = np.flatnonzero(signal[0] > signal.max() - edge)
        lows = np.flatnonzero(signal[0] < signal.min() + edge)
        return np.concatenate([few(highs, PAIRED), few(lows, PAIRED)])

    def _coordinates(self, z: Array) -> Array:
        return self.low + self.scale * z[: self.count]

    def _slope(self, z: Array) -> tuple[Array, Array, Array, Array]:
        """Changes and added mass, and their slopes, by central differences."""
        step = 1e-6 * np.eye(self.count)
        at = self._coordinates(z)[:, None]
        sides = np.hstack([at, at + self.scale[:, None] * step, at - self.scale[:, None] * step])
        changes, added = self.problem.changes(sides)
        n = self.count
        half = 2e-6
        return (
            changes[:, 0],
            (changes[:, 1 : n + 1] - changes[:, n + 1 :]) / half,
            added[:1],
            (added[1 : n + 1] - added[n + 1 :]) / half,
        )

    def kept(self, z: Array) -> tuple[Array, Array]:
        """What must not be below 0, and its slope."""
        changes, slope, added, added_slope = self._slope(z)
        values, slopes = [], []
        for number, (item, over) in enumerate(self._sized()):
            value, by_changes = self._below(item, self.rows[number], changes, z, number, over)
            values.append(value)
            own = np.zeros((len(value), len(z)))
            own[:, : self.count] = by_changes @ slope
            own[:, self.count + number] = self._by_height(item, z, number)
            slopes.append(own)
        first = len(self.problem.goals)
        for number in range(first, len(self.measures)):
            row = np.zeros((1, len(z)))
            row[0, self.count + number] = -1
            values.append(np.array([1 - z[self.count + number]]))
            slopes.append(row)
        if self.problem.plan.added_mass is not None:
            row = np.zeros((1, len(z)))
            row[0, : self.count] = -added_slope / self.problem.plan.added_mass
            values.append(1 - added / self.problem.plan.added_mass)
            slopes.append(row)
        return np.concatenate(values), np.vstack(slopes)

    def _by_height(self, item: Measured, z: Array, number: int) -> float:
        vector = item.measure == "peak" and len(item.base) > 1
        return 2 * z[self.count + number] if vector else 1.0

    def _below(
        self, item: Measured, rows: Array, changes: Array, z: Array, number: int, over: float
    ) -> tuple[Array, Array]:
        height = z[self.count + number]
        if item.smooth:
            free = item.factor[:, 1:]
            residual = item.factor[:, 0] + free @ changes
            size = np.linalg.norm(residual) or 1e-300
            return np.array([height - size / over]), -(residual @ free / size / over)[None]
        signal = item.base + item.columns @ changes
        if item.measure == "area":
            value = 2 * pi * np.mean(np.abs(signal))
            slope = 2 * pi * np.mean(np.sign(signal[0])[:, None] * item.columns[0], 0)
            return np.array([height - value / over]), -slope[None] / over
        near, columns = signal[:, rows] / over, item.columns[:, rows] / over
        if item.measure == "peak_to_peak":
            highs, lows = slice(None, PAIRED), slice(PAIRED, None)
            value = height - (near[0][highs][:, None] - near[0][lows][None]).ravel()
            slope = columns[0][highs][:, None] - columns[0][lows][None]
            return value, -slope.reshape(-1, slope.shape[-1])
        if len(near) == 1:
            value = np.concatenate([height - near[0], height + near[0]])
            return value, np.concatenate([-columns[0], columns[0]])
        value = height**2 - np.sum(near**2, 0)
        return value, -2 * np.einsum("cn,cnp->np", near, columns)

    def cost(self, z: Array) -> tuple[float, Array]:
        first = self.count
        last = first + len(self.problem.goals)
        weights = np.array(self.problem.weights)
        slope = np.zeros(len(z))
        shares = weights * z[first:last]
        if self.problem.plan.combine == "sum":
            slope[first:last] = weights
            return float(shares.sum()), slope
        total = float(np.linalg.norm(shares)) or 1e-300
        slope[first:last] = weights * shares / total
        return total, slope

    def end(self) -> Array:
        top = np.where(self.high > self.low, 1.0, 0.0)
        bounds = [*((0.0, t) for t in top), *((0.0, None) for _ in self.measures)]
        fixed = len(self.kept(self.start)[0])

        def values(z: Array) -> Array:
            return self.kept(z)[0][:fixed]

        def slopes(z: Array) -> Array:
            return self.kept(z)[1][:fixed]

        result = minimize(
            self.cost,
            self.start,
            jac=True,
            method="SLSQP",
            bounds=bounds,
            constraints={"type": "ineq", "fun": values, "jac": slopes},
            options={"maxiter": self.most, "ftol": 1e-12},
        )
        at = result.x[: self.count]
        return self._coordinates(at if np.all(np.isfinite(at)) else self.start)


# -- convex plans, given to a solver in matrices of one's own --------------------------------------


class _Lifted:
    """Mass, first moments and inertia about a centre as unknowns of a convex program.

    The moment of inertia of a point, a disc or a moved link is left out: it must not matter.
    """

    def __init__(self, center: tuple[float, float], weight: eq.balancing.Weight | None) -> None:
        import cvxpy as cp

        self.weight = weight
        size = 0.05 if weight is None else weight.radius
        self.mass, self.moments = cp.Variable(), size * cp.Variable(2)
        self.inertia = size**2 * cp.Variable()
        x, y = center
        about = self.inertia + 2 * (x * self.moments[0] + y * self.moments[1])
        self.effect = cp.hstack(
            [
                self.mass,
                self.mass * x + self.moments[0],
                self.mass * y + self.moments[1],
                about + self.mass * (x * x + y * y),
            ]
        )
        self.cuts = list(np.linspace(0, pi, 9))

    def of_weight(self) -> list[Any]:
        """What a weight keeps to."""
        import cvxpy as cp

        weight = self.weight
        assert weight is not None
        outer, inner = weight.radius, weight.inner_radius
        size = outer * cp.Variable()
        least, most = mass_range(weight)
        kept = [self.mass >= least, self.mass <= most, cp.norm(self.moments) <= size]
        if weight.shape == "any":
            across = cp.hstack([2 * self.moments / outer, self.mass - self.inertia / outer**2])
            return [
                *kept,
                cp.norm(across) <= self.mass + self.inertia / outer**2,
                self.inertia <= outer**2 * self.mass,
            ]
        if weight.shape == "point":
            return [*kept, size <= outer * self.mass, self.inertia == 0]
        if weight.shape == "disc":
            shrunk = cp.power(self.mass, 1.5) / np.sqrt(pi * plate(weight))
            return [*kept, size + shrunk <= outer * self.mass, self.inertia == 0]
        assert weight.shape == "sector"
        wide = plate(weight) * (outer**2 - inner**2)
        deep = 2 / 3 * plate(weight) * (outer**3 - inner**3)
        tangents = [
            size / deep <= np.sin(half) + np.cos(half) * (self.mass / wide - half)
            for half in self.cuts
        ]
        about = (inner**2 + outer**2) / 2
        return [*kept, *tangents, self.inertia == about * self.mass]

    def overhang(self) -> float:
        """By how much a sector's moment passes the sine of its half angle, then cut off."""
        weight = self.weight
        if weight is None or weight.shape != "sector":
            return 0.0
        outer, inner = weight.radius, weight.inner_radius
        half = float(self.mass.value) / (plate(weight) * (outer**2 - inner**2))
        deep = 2 / 3 * plate(weight) * (outer**3 - inner**3)
        self.cuts.append(half)
        return float(np.linalg.norm(self.moments.value) / deep - np.sin(half))


def _moved(move: eq.balancing.CenterMove, link: Link, unknown: _Lifted) -> list[Any]:
    import cvxpy as cp

    mass, sx, sy, _ = parameters_of(link)
    kept = [unknown.mass == 0, unknown.inertia == 0]
    place = (unknown.moments + np.array([sx, sy])) / mass
    if move.center is not None:
        return [*kept, cp.norm(place - np.array(move.center)) <= move.radius]
    assert move.x is not None and move.y is not None
    low, high = np.transpose([move.x, move.y])
    return [*kept, place >= low, place <= high]


def convex_measure(item: Measured, changes: Any, over: float) -> Any:
    """Return a measure over a value as a convex expression."""
    import cvxpy as cp

    if item.smooth:
        return cp.norm(item.factor[:, 0] / over + (item.factor[:, 1:] / over) @ changes)
    parts = [
        base / over + (columns / over) @ changes
        for base, columns in zip(item.base, item.columns, strict=True)
    ]
    if len(parts) == 2:
        return cp.max(cp.norm(cp.vstack(parts), axis=0))
    (signal,) = parts
    if item.measure == "peak":
        return cp.max(cp.abs(signal))
    if item.measure == "peak_to_peak":
        return cp.max(signal) - cp.min(signal)
    return 2 * pi / item.base.shape[1] * cp.norm1(signal)


class _Goal:
    """A measure in a convex program, with the value that it is taken over; peaks are those between
    samples, too, where no load jumps.
    """

    def __init__(
        self, item: Measured, objective: eq.balancing.Objective, original: Machine
    ) -> None:
        self.measured, self.before = item, item.before
        self.places: Any = slice(None)
        self.grows = item.measure.startswith("peak") and not loads_jump(original)
        if self.grows:
            base, columns = (
                resample(each, DENSER * item.base.shape[1], axis=1)
                for each in (item.base, item.columns)
            )
            self.measured, self.before = (
                replace(item, base=base, columns=columns),
                measured_exactly(original, objective),
            )
            self.places = np.arange(0, base.shape[1], FEWER)

    def over(self, value: float, changes: Any) -> Any:
        """The measure over a value as a convex expression."""
        first = self.measured
        if self.grows:
            first = replace(
                first, base=first.base[:, self.places], columns=first.columns[:, self.places]
            )
        return convex_measure(first, changes, value)

    def takes_more(self, changes: Array) -> bool:
        """Whether a solution has tops above all values that are in the program, which are taken."""
        if not self.grows:
            return False
        signal = self.measured.signal(changes[:, None])[..., 0]
        size = np.sqrt(np.sum(signal**2, 0))
        new: list[int] = []
        for values in (size,) if self.measured.measure == "peak" else (signal[0], -signal[0]):
            top = (values >= np.roll(values, 1)) & (values >= np.roll(values, -1))
            most = np.max(values[self.places]) + BEYOND * np.max(size)
            new += np.flatnonzero(top & (values > most)).tolist()
        self.places = np.union1d(self.places, np.array(new, dtype=int))
        return bool(new)


def convex_optimum(problem: Problem, solver: str = "CLARABEL", least: int | None = None) -> float:
    """Return the least cost of a convex plan, or of one of its limits over what it may be.

    least : number of the limit that is made small while the others are kept.
    """
    import cvxpy as cp

    plan, machine = problem.plan, problem.machine
    unknowns: list[tuple[str, _Lifted]] = []
    kept: list[Any] = []
    for move in plan.moves:
        unknowns.append((move.link, _Lifted((0.0, 0.0), None)))
        kept += _moved(move, machine.links[move.link], unknowns[-1][1])
    for added in plan.masses:
        center = machine.links[added.link].points[added.at]
        unknowns.append((added.link, _Lifted(center, added.weight)))
    unknowns += [(geared.name, _Lifted((0.0, 0.0), geared.weight)) for geared in plan.geared]
    changes = cp.hstack(
        [sum(item.effect for name, item in unknowns if name == link) for link in problem.links]
    )
    weights = [item for _, item in unknowns if item.weight is not None]
    if plan.added_mass is not None:
        kept.append(sum(item.mass for item in weights) <= plan.added_mass)
    goals, bounded = (
        [_Goal(entry, wish, problem.original) for entry, wish in zip(each, wishes, strict=True)]
        for each, wishes in (
            (problem.goals, plan.objectives),
            (problem.kept, [limit.objective for limit in plan.limits]),
        )
    )
    while True:
        limits = [
            item.over(limit.at_most or (limit.ratio or 0.0) * item.before, changes)
            for item, limit in zip(bounded, plan.limits, strict=True)
        ]
        rows = [limit <= 1 for number, limit in enumerate(limits) if number != least]
        shares = [
            weight * goal.over(goal.before, changes)
            for weight, goal in zip(problem.weights, goals, strict=True)
        ]
        cost = sum(shares)
        if plan.combine == "squares":
            most = cp.Variable(len(shares), nonneg=True)
            rows += [share <= entry for share, entry in zip(shares, most, strict=True)]
            cost = cp.norm(most)
        if least is not None:
            cost = limits[least]
        program = cp.Problem(
            cp.Minimize(cost),
            kept + rows + [entry for item in weights for entry in item.of_weight()],
        )
        program.solve(solver=solver, **PRECISION[solver])
        assert program.status == "optimal", program.status
        more = [item.takes_more(changes.value) for item in (*goals, *bounded)]
        if max((item.overhang() for item in weights), default=0.0) < 1e-7 and not any(more):
            return float(program.value)


PRECISION: dict[str, dict[str, Any]] = {
    "CLARABEL": dict.fromkeys(("tol_gap_abs", "tol_gap_rel", "tol_feas"), 1e-8),
    "SCS": {"eps_abs": 1e-9, "eps_rel": 1e-9, "max_iters": 100_000},
}


# -- machines from the changes alone ---------------------------------------------------------------


def centroid(outer: float, inner: float, angle: float) -> float:
    """Distance of a sector's centre of mass from its centre."""
    return 4 / 3 * np.sin(angle / 2) / angle * (outer**3 - inner**3) / (outer**2 - inner**2)


def piece_inertia(piece: dict[str, Any]) -> float:
    """Moment of inertia of a piece about its own centre of mass."""
    mass = piece["mass"]
    if piece["shape"] == "point":
        return 0.0
    if piece["shape"] == "disc":
        return mass * piece["radius"] ** 2 / 2
    outer, inner = piece["outer_radius"], piece["inner_radius"]
    about = mass * (outer**2 + inner**2) / 2
    if piece["shape"] == "sector":
        about -= mass * centroid(outer, inner, piece["angle"]) ** 2
    return about


def made(machine: Machine, plan: eq.balancing.Balance, changes: Sequence[Any]) -> Machine:
    """Make the changes of a machine from what they say of pieces, places and gears."""
    for geared in plan.geared:
        gears = next(c for c in changes if c.kind == "gears" and c.link == geared.name)
        machine = with_shaft(machine, geared, gears.values["ratio"])
        np.testing.assert_allclose(machine.frame[f"{geared.name} shaft"], gears.values["axis"])
    for change in changes:
        if change.kind == "center of mass":
            machine = machine.with_link(change.link, center_of_mass=change.values["to"])
    for change in changes:
        if change.kind == "added mass":
            result = np.array(parameters_of(machine.links[change.link]))
            for piece in change.values["pieces"]:
                result = result + spot(piece["mass"], *piece["place"], piece_inertia(piece))
            machine = with_parameters(machine, change.link, result)
    return machine


# -- the speed of a geared shaft as one more coordinate --------------------------------------------


@dataclass
class FreeShaft:
    """A weight of any shape on a geared shaft whose speed is free; goals are shaking outputs.

    The driver turns by phi; the shaft stands still at `axis`, so that its weight pulls with
    - s d2/dt2 exp(-i n phi) and turns with J n phi''.
    """

    machine: Machine
    plan: eq.balancing.Balance

    def __post_init__(self) -> None:
        (self.geared,) = self.plan.geared
        (self.objective,) = self.plan.objectives
        assert self.objective.output == "shaking_moment" and not self.plan.limits
        self.base = signals_of(self.machine, [output_of(self.objective)])[0][0]
        self.before = float(value_of(self.objective.measure, self.base[None]))
        motion = eq.move(self.machine, SAMPLES, acceleration=0.0)
        driver = motion.links[self.geared.driver]
        self.swing = driver.angle - driver.angle[0]
        self.rate, self.change = driver.angular_velocity, driver.angular_acceleration
        self.pivot = self.machine.frame[drive_pivot(self.machine)]
        self.part = weighed(self.geared.name, (0.0, 0.0), self.geared.weight)
        assert self.geared.ratio is not None
        self.bounds = [self.geared.ratio, *zip(self.part.low, self.part.high, strict=True)]

    def moment(self, at: Array) -> Array:
        """(1, N, S) at coordinates (d, S)."""
        ratio = at[0]
        axis = np.array([axis_of(self.machine, self.geared, n) for n in ratio])
        x, y = (axis - np.array(self.pivot)).T
        _, sx, sy, inertia = self.part.effect(at[1:])
        turned = np.exp(-1j * np.outer(self.swing, ratio)) * (sx + 1j * sy)
        rate, change = -np.outer(self.rate, ratio), -np.outer(self.change, ratio)
        force = -(1j * change - rate**2) * turned
        moment = x * force.imag - y * force.real - inertia * change
        return (self.base[:, None] + moment)[None]

    def cost(self, at: Array) -> Array:
        at = at if at.ndim == 2 else at[:, None]
        return value_of(self.objective.measure, self.moment(at)) / self.before

    def evolved(self, seed: int = 0, turns: int = 150) -> tuple[float, Array]:
        """Return least cost and its coordinates."""
        optimum = differential_evolution(
            self.cost,
            self.bounds,
            seed=seed,
            maxiter=turns,
            popsize=12,
            tol=0,
            atol=0,
            vectorized=True,
            updating="deferred",
            polish=False,
        )
        low, high = np.array(self.bounds).T
        ending = minimize(
            lambda at: float(self.cost(np.clip(at, low, high))[0]),
            optimum.x,
            method="Nelder-Mead",
            options={"maxiter": 800, "xatol": 1e-10, "fatol": 1e-12},
        )
        return float(ending.fun), np.clip(ending.x, low, high)
