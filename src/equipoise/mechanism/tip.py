"""The tip of a planting finger, at every crank angle: what `equipoise.planting` reads off."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from math import pi
from typing import Any

import numpy as np

from equipoise.errors import ModelError
from equipoise.mechanism.family import Family, Triple, column
from equipoise.mechanism.field import Planting
from equipoise.mechanism.instants import crossings, largest, smallest
from equipoise.mechanism.linkage import assemble
from equipoise.mechanism.model import Machine
from equipoise.mechanism.steps import State

Array = np.ndarray[Any, Any]

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
    """The tip's path relative to the machine, of P machines of the same build.

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
        self.link = tip_link(self.machines[0])
        self.family = Family([assemble(machine) for machine in self.machines])
        self.turns = self.family.first.cycle.turns if turns is None else turns
        self.theta = np.arange(grid_size * self.turns) * (2 * pi / grid_size)

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
        return Tip(theta, *self.point_of(state, self.planting.tip), state)

    def point_of(self, state: State, point: str, link: str | None = None) -> Triple:
        """A point of the tip's link, or of another, and its derivatives, (P, K)."""
        return self.family.point(state, self.link if link is None else link, point)

    def place_3(self, theta: Array) -> Array:
        """Third derivative of the tip's place by crank angle, (P, K)."""
        offsets = STEP * np.array([-3, -2, -1, 1, 2, 3])
        weights = np.array([-1, 9, -45, 45, -9, 1]) / (60 * STEP)
        near = theta[..., None] + offsets
        second = self.at(near.reshape(len(theta), -1)).place_2
        third: Array = second.reshape(near.shape) @ weights
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
        level: Array = self.lowest[0] + np.array(depths)
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
            'missing; add a table [planting] with at least tip = "P", forward_speed = "0.6 m/s" '
            'and depth = "40 mm"',
        )
    return machine.planting


def tip_link(machine: Machine) -> str:
    """The first moving link that has the tip."""
    tip = planting_of(machine).tip
    return next(name for name, link in machine.links.items() if tip in link.points)


def surface_of(machine: Machine) -> float:
    """Height of the soil's surface in the frame, m.  It is kept with the machine."""
    planting = planting_of(machine)
    if planting.surface is not None:
        return planting.surface
    kept = machine.__dict__.get("_surface")
    if kept is None:
        kept = machine.__dict__["_surface"] = float(TipCurve([machine]).surface[0])
    return kept
