"""The tip of a planting finger at every crank angle; and where a signal vanishes or turns.

A signal is a function of crank angles (P, K), rad, that gives values (P, K): K crank angles for
each of P machines, all solved in one call.  Samples only bracket the crank angles in question.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from copy import copy
from functools import cached_property
from math import pi
from typing import Any

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.errors import ModelError
from equipoise.i18n import Note
from equipoise.mechanism.assembly.family import Family, Triple, column
from equipoise.mechanism.assembly.linkage import assemble
from equipoise.mechanism.assembly.steps import State
from equipoise.mechanism.parts.field import Planting, PlantingArm
from equipoise.mechanism.parts.machine import Machine
from equipoise.signals import EQUAL, Array, highest_at

CurveFunction = Callable[[Array], Any]

CLOSE = 1e-14
"""rad: a crank angle that moves by less has been found."""
FINE = 1e-9
"""rad: the closest samples of a signal that may have kinks."""
MOST_ROUNDS = 80
GAUSS = np.polynomial.legendre.leggauss(12)
"""Nodes and weights of the rule for integrals, in each panel."""
RIVALS = 3
"""Highest samples that are followed to their tops: the highest sample need not lie by the
highest top."""


def roots(
    signal: CurveFunction, low: Array, high: Array, known: tuple[Array, Array, Array] | None = None
) -> Array:
    """Crank angles (P, K) between `low` and `high`, at which a signal passes zero.

    known : values (P, K) there, and crank angles (P, K) at which it is looked first; else in the
        middle.

    Chandrupatla's method, on all brackets at once: inverse quadratic interpolation where it can be
    trusted, else bisection, so that no peak is too sharp.  Where the signal has the same sign at
    both ends, the end at which it is smaller comes back.
    """
    with np.errstate(all="ignore"):
        return _roots(signal, low, high, known or (signal(low), signal(high), (low + high) / 2))


def _roots(
    signal: CurveFunction, low: Array, high: Array, known: tuple[Array, Array, Array]
) -> Array:
    x1, x2 = high, low
    f2, f1, first = known
    bracketed = np.signbit(f1) != np.signbit(f2)
    nearer = np.where(np.abs(f1) < np.abs(f2), x1, x2)
    share: Array = (high - first) / (high - low)
    for _ in range(MOST_ROUNDS):
        narrow = np.abs(x2 - x1) <= 2 * CLOSE
        over = narrow | ~bracketed | np.equal(f1, 0) | np.equal(f2, 0)
        if np.all(over):
            break
        # What is over stays, so that no root depends on those that are looked for beside it.
        x = np.where(over, x1, x1 + share * (x2 - x1))
        f = signal(x)
        same = np.signbit(f) == np.signbit(f1)
        x3, f3 = np.where(same, x1, x2), np.where(same, f1, f2)
        x2, f2 = np.where(same, x2, x1), np.where(same, f2, f1)
        x1, f1 = x, f
        share = _share(x1, f1, x2, f2, x3, f3)
    return np.where(bracketed, np.where(np.abs(f1) < np.abs(f2), x1, x2), nearer)


def _share(x1: Array, f1: Any, x2: Array, f2: Any, x3: Array, f3: Any) -> Array:
    """Where to look next, from x1 towards x2: by interpolation, or in the middle."""
    xi, phi = (x1 - x2) / (x3 - x2), (f1 - f2) / (f3 - f2)
    trusted = (phi**2 < xi) & ((1 - phi) ** 2 < 1 - xi)
    quadratic = f1 / (f2 - f1) * f3 / (f2 - f3)
    quadratic = quadratic + (x3 - x1) / (x2 - x1) * f1 / (f3 - f1) * f2 / (f3 - f2)
    least = np.minimum(CLOSE / np.abs(x2 - x1), 0.5)
    clipped: Array = np.clip(np.where(trusted, quadratic, 0.5), least, 1 - least)
    return clipped


def crossings(signal: CurveFunction, nodes: Array) -> Array:
    """Every crank angle at which a signal of one machine passes zero in one cycle, rising.

    nodes : (M,) rising crank angles, from the begin to the end of the cycle, so close together that
        the signal passes zero at most once between two of them.
    """
    negative = signal(nodes[None])[0] < 0
    negative[-1] = negative[0]  # the same instant, whatever rounding says
    k = np.flatnonzero(negative[:-1] != negative[1:])
    if not k.size:
        return np.empty(0)
    values: Array = roots(signal, nodes[None, k], nodes[None, k + 1])[0]
    return values


def largest(
    signal: CurveFunction, slope: CurveFunction, theta: Array, samples: Array
) -> tuple[Array, Array]:
    """Largest value (P,) of a periodic signal, and its crank angle (P,).

    Parameters
    ----------
    slope : any signal with the sign of the derivative.
    theta : (N,) crank angles, equally spaced over the period.
    samples : (P, N), the signal there.
    """
    tops = (samples >= np.roll(samples, 1, axis=1)) & (samples >= np.roll(samples, -1, axis=1))
    high, low = (f(samples, axis=1, keepdims=True) for f in (np.max, np.min))
    equal = np.where(samples >= high - EQUAL * (high - low), high, samples)
    ranked = np.argsort(np.where(tops, -equal, np.inf), axis=1, kind="stable")[:, :RIVALS]
    ranked = np.sort(ranked, axis=1)  # in the order of the cycle: of equal maxima the first counts
    step = theta[1] - theta[0]
    at = theta[ranked]
    refined = roots(slope, at - step, at + step)
    values = signal(refined)
    sampled = np.take_along_axis(samples, ranked, axis=1)
    lower = ~(values >= sampled)  # two turning points within one step, or rounding
    values, refined = np.where(lower, sampled, values), np.where(lower, at, refined)
    rows, best = np.arange(len(samples)), highest_at(values, smooth=False)
    return np.max(values, axis=1), refined[rows, best]


def smallest(
    signal: CurveFunction, slope: CurveFunction, theta: Array, samples: Array
) -> tuple[Array, Array]:
    """Smallest value (P,) of a periodic signal, and its crank angle (P,); see `largest`."""
    value, at = largest(lambda x: -signal(x), lambda x: -slope(x), theta, -samples)
    return -value, at


def lowest_within(
    signal: CurveFunction, low: Array, high: Array, samples: int = 181
) -> tuple[Array, Array]:
    """Smallest value (P,) of a signal that may have kinks, from `low` (P,) to `high`, and where.

    Sampled, then sampled again ever closer about the smallest sample.
    """
    low, high = low[:, None], high[:, None]
    grid = low + (high - low) * np.linspace(0.0, 1.0, samples)
    values = signal(grid)
    k = highest_at(-values)[:, None]
    offsets = np.linspace(-1.0, 1.0, 21)
    width = (high - low) / (samples - 1)
    while True:
        at = np.take_along_axis(grid, k, axis=1)
        if not np.any(np.abs(width) > FINE):
            return np.take_along_axis(values, k, axis=1)[:, 0], at[:, 0]
        between = at + width * offsets
        grid = np.clip(between, np.minimum(low, high), np.maximum(low, high))
        values = signal(grid)
        k = np.argmin(values, axis=1)[:, None]
        width = np.where(np.abs(width) > 8 * FINE, width / 8, 0.0)  # as alone, see `roots`


def integral(signal: CurveFunction, breaks: Array) -> Array:
    """Integral (P,) of a signal over crank angle, by Gauss's rule between breaks (P, B), rad.

    The signal should be smooth between them; falling breaks give the opposite sign.
    """
    nodes, weights = GAUSS
    middle, half = (breaks[:, 1:] + breaks[:, :-1]) / 2, np.diff(breaks, axis=1) / 2
    theta = middle[..., None] + half[..., None] * nodes
    values = signal(theta.reshape(len(breaks), -1)).reshape(theta.shape)
    # A product of matrices would round a row by how many there are.
    total: Array = np.sum(np.sum(values * weights, axis=-1) * half, axis=1)
    return total


GRID = 720
"""Crank angles in a turn between which instants are looked for."""

STEP = 2e-3
"""rad: step of the sixth-order difference that gives third derivatives; its error is about 1e-11
of the largest value, as much from the step as from rounding."""


@dataclass(frozen=True, eq=False)
class Tip:
    """Tip at crank angles (P, K); complex, m; `place_1`, `place_2` are derivatives by them."""

    theta: Array
    place: Array
    place_1: Array
    place_2: Array
    state: State


class TipCurve:
    """The path of an arm's tip relative to the machine, of P machines of the same build.

    arm : the first.  arms : the curves of all arms, this one among them.
    grid_size : crank angles in a turn that are sampled.
    turns : of the crank in a cycle, if they are known; then nothing is checked.

    Raises
    ------
    ModelError : a machine has no `[planting]`.
    MotionError : the crank of the first machine cannot turn fully.
    """

    def __init__(
        self, machines: Sequence[Machine], grid_size: int = GRID, turns: int | None = None
    ) -> None:
        self.machines = tuple(machines)
        self.planting = planting_of(self.machines[0])
        self.arm = self.planting.every_arm[0]
        self.link = tip_link(self.machines[0])
        self.family = Family([assemble(machine) for machine in self.machines])
        self.turns = self.family.first.cycle.turns if turns is None else turns
        self.theta = np.arange(grid_size * self.turns) * (2 * pi / grid_size)
        self.arms: tuple[TipCurve, ...] = (self,)
        self.arms += tuple(map(self._of_arm, self.planting.arms))
        for curve in self.arms:
            curve.arms = self.arms

    def _of_arm(self, arm: PlantingArm) -> TipCurve:
        """The curve of a further arm of the same machines."""
        other = copy(self)
        other.arm, other.link = arm, tip_link(self.machines[0], arm.tip)
        return other

    @property
    def count(self) -> int:
        """P."""
        return len(self.machines)

    @property
    def period(self) -> float:
        """Crank angle of one cycle, rad."""
        return 2 * pi * self.turns

    @cached_property
    def speed(self) -> Array:
        """Speed of the crank, rad/s, (P, 1)."""
        return column(machine.drive.speed for machine in self.machines)

    @cached_property
    def forward(self) -> Array:
        """Velocity of the machine along x, m/s, (P, 1)."""
        return column(planting_of(m).forward(m.drive.speed) for m in self.machines)

    @cached_property
    def grid(self) -> Tip:
        """The tip at the sampled crank angles, (P, N)."""
        return self.at(np.broadcast_to(self.theta, (self.count, len(self.theta))))

    def at(self, theta: Array) -> Tip:
        """The tip at crank angles (P, K)."""
        state = self.family.solve(theta)
        return Tip(theta, *self.point_of(state, self.arm.tip), state)

    def point_of(self, state: State, point: str, link: str | None = None) -> Triple:
        """A point of the tip's link, or of another, and its derivatives, (P, K)."""
        return self.family.point(state, self.link if link is None else link, point)

    def place_3(self, theta: Array) -> Array:
        """Third derivative of the tip's place by crank angle, (P, K)."""
        offsets = STEP * np.array([-3, -2, -1, 1, 2, 3])
        weights = np.array([-1, 9, -45, 45, -9, 1]) / (60 * STEP)
        samples = theta[..., None] + offsets
        second = self.at(samples.reshape(len(theta), -1)).place_2
        third: Array = np.sum(second.reshape(samples.shape) * weights, axis=-1)
        return third

    @cached_property
    def lowest(self) -> tuple[Array, Array]:
        """Height (P,) of the lowest point and its crank angle (P,)."""
        return smallest(self.height, self.rise, self.theta, self.grid.place.imag)

    @cached_property
    def highest(self) -> tuple[Array, Array]:
        """Height (P,) of the highest point and its crank angle (P,)."""
        return largest(self.height, self.rise, self.theta, self.grid.place.imag)

    @cached_property
    def surface(self) -> Array:
        """Height (P,) of the soil's surface in the frame, m."""
        if self.planting.surface is not None:
            return np.full(self.count, self.planting.surface)
        depths = [planting_of(machine).depth for machine in self.machines]
        lowest = np.min([arm.lowest[0] for arm in self.arms], axis=0)
        level: Array = lowest + np.array(depths)
        return level

    def height(self, theta: Array) -> Any:
        """Height of the tip, m, (P, K)."""
        return self.at(theta).place.imag

    def rise(self, theta: Array) -> Any:
        """Derivative of the height by crank angle, m, (P, K)."""
        return self.at(theta).place_1.imag

    def level_nodes(self) -> Array:
        """Crank angles of one machine, over one cycle, between which its height rises or falls."""
        ends = np.append(self.theta, self.period)
        return np.unique(np.concatenate([ends, crossings(self.rise, ends)]))


def planting_of(machine: Machine) -> Planting:
    """The `[planting]` of a machine; raises a `ModelError` where it has none."""
    if machine.planting is None:
        raise ModelError(
            "planting",
            Note(
                'missing; add a table [planting] with at least tip = "P", forward_speed '
                '= "0.6 m/s" and depth = "40 mm"'
            ),
        )
    return machine.planting


def tip_link(machine: Machine, tip: str | None = None) -> str:
    """The first moving link that has a tip; that of the first arm where not given."""
    tip = tip or planting_of(machine).tip
    return next(name for name, link in machine.links.items() if tip in link.points)


def surface_of(machine: Machine) -> float:
    """Height of the soil's surface in the frame, m.  It is kept with the machine."""
    planting = planting_of(machine)
    if planting.surface is not None:
        return planting.surface
    if "surface" not in machine.memory:
        machine.memory["surface"] = float(TipCurve([machine]).surface[0])
    surface: float = machine.memory["surface"]
    return surface
