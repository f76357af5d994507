"""What a search of geometry has to reach, and designs judged by it, many at once."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from contextlib import suppress
from dataclasses import fields
from functools import cached_property, partial
from typing import Self

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.design.evaluator import PooledEvaluator
from equipoise.design.requirements import Requirement
from equipoise.design.solvers import DesignProblem
from equipoise.design.spreads import Range
from equipoise.errors import EquipoiseError, UsageError, at_place
from equipoise.i18n import Note
from equipoise.mechanism.assembly.family import Family
from equipoise.mechanism.assembly.linkage import assemble
from equipoise.mechanism.kinematics.tip import TipCurve
from equipoise.mechanism.parts.machine import Machine, unknown
from equipoise.planting.arms import machine_figures
from equipoise.planting.designs import Designs, Sense
from equipoise.planting.names import dimension_of
from equipoise.signals import Array

GRID = 180
"""Crank angles between which instants of designs are looked for."""
BATCH = 64
"""Designs that are sent to a process together: 15 at a time took 1.4 times as long as 60."""
OPEN = 1e-4
"""Squared sine of the smallest transmission angle (0.6 deg) below which a design counts as open."""
LEAST_LIFT = 0.01
"""Share of the path's height by which the tip of a design has to rise above the soil."""
COST_OF_OPEN, COST_OF_NONE = 1e9, 1e8
"""Cost of a design that cannot turn, and of one that lacks a figure."""
LIMITS = 1e3
"""Weight of limits beside targets in the global search."""


def check_asks(goal: Requirement) -> None:
    """A search can do nothing with a figure that is only to be reported: `UsageError`."""
    if goal.is_fact:
        raise UsageError(
            at_place(goal.figure, Note("give at least one of target, at_least, at_most and make"))
        )


@dataclass(frozen=True, eq=False)
class GoalOutcome:
    """Designs judged, P of them.

    off : (P, T) targets, in steps.  slack : (P, L) limits, in steps, negative outside.
    size : (P,) what is to become small, in steps.  worst : (P,) see `OPEN`.
    """

    off: Array
    slack: Array
    size: Array
    worst: Array

    @classmethod
    def joined(cls, parts: Sequence[GoalOutcome]) -> GoalOutcome:
        """What came of all parts, one after the other."""
        names = [item.name for item in fields(cls)]
        return cls(*(np.concatenate([getattr(part, name) for part in parts]) for name in names))

    @property
    def kept(self) -> Array:
        """Whether a design can turn and keeps every limit (P,)."""
        met: Array = (self.worst > OPEN) & np.all(self.slack >= 0, axis=1)
        return met & np.isfinite(self.cost)

    @cached_property
    def cost(self) -> Array:
        """One number (P,) for the global search."""
        outside = np.maximum(-self.slack, 0.0)
        cost = np.sum(self.off**2, axis=1) + self.size
        cost = cost + LIMITS * np.sum(outside + outside**2, axis=1)
        cost = np.where(np.isfinite(cost), cost, COST_OF_NONE)
        opened: Array = np.where(self.worst > OPEN, cost, COST_OF_OPEN * (1 - self.worst))
        return opened


class PlantingProblem(DesignProblem):
    """Designs of a machine and the goals that they have to meet; a context manager, which ends the
    processes that judge them.

    workers : processes, where judging takes more than some seconds; as many as this machine has
        processors if not given.
    judged : number of designs so far.

    Raises
    ------
    UsageError : a goal cannot be used, or there are fewer than one worker.
    """

    def __init__(
        self, designs: Designs, goals: Sequence[Requirement], workers: int | None = 1
    ) -> None:
        self.designs, self.goals = designs, tuple(goals)
        self.judged = 0
        if not self.goals:
            raise UsageError(at_place("goals", Note("there is none; give at least one")))
        known, self.turns = _figures([designs.machine]), assemble(designs.machine).cycle.turns
        for goal in goals:
            if goal.figure not in known:
                raise UsageError(at_place("goals", unknown(goal.figure, known, "figure")))
            check_asks(goal)
        self.scales = [
            goal.scale(float(known[goal.figure][0]), dimension_of(goal.figure)) for goal in goals
        ]
        make = partial(_judging, *designs.given, self.goals)
        self.pooled = PooledEvaluator(
            self.judge_here, make, GoalOutcome.joined, workers, together=BATCH
        )

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *error: object) -> None:
        self.pooled.close()

    @property
    def spreads(self) -> list[Range]:
        return [Range(*ends) for ends in zip(*self.designs.bounds, strict=True)]

    def evaluate(self, places: Array) -> tuple[Array, Array]:
        """Costs (P, 1), in squared steps, and whether a limit is not kept (P, 1)."""
        outcome = self.judge(self.values_of(places))
        return outcome.cost[:, None], np.where(outcome.kept, 0.0, 1.0)[:, None]

    @property
    def makes(self) -> bool:
        """Whether a figure is to become small or large."""
        return any(goal.make for goal in self.goals)

    def judge(self, values: Array) -> GoalOutcome:
        """Judge designs (P, n), together with processes of this machine where that takes long."""
        self.judged += len(values)
        return self.pooled(values)

    def judge_here(self, values: Array) -> GoalOutcome:
        """Judge designs (P, n) in this process; of none does the result depend on the others."""
        machines, worst = self._built(values)
        good = worst > OPEN
        fulls = {goal.figure: np.full(len(values), np.nan) for goal in self.goals}
        if np.any(good):
            some = [m for m, g in zip(machines, good, strict=True) if g and m is not None]
            computed = _figures(some, [*fulls], self.turns)
            for name, column in fulls.items():
                column[good] = computed[name]
        off, slack, size = [], [], np.zeros(len(values))
        for goal, scale in zip(self.goals, self.scales, strict=True):
            column = fulls[goal.figure]
            if goal.target is not None:
                off.append(goal.off(column) / scale)
            slack += [part / scale for part in goal.slack(column)]
            size = size + goal.size(column) / scale
        return GoalOutcome(_columns(off, len(values)), _columns(slack, len(values)), size, worst)

    def _built(self, values: Array) -> tuple[list[Machine | None], Array]:
        """Machines, and the smallest number (P,) of any of their dyads round the turn."""
        machines: list[Machine | None] = [None] * len(values)
        worst, families = np.full(len(values), -1.0), {}
        for k, row in enumerate(values):
            with suppress(EquipoiseError):  # lengths of nothing, pins that coincide
                machine = self.designs.build(row)
                families[k], machines[k] = assemble(machine), machine
        if families:
            family, count = Family([*families.values()]), len(families)
            ahead = np.linspace(0, 2 * np.pi * self.turns, GRID * self.turns + 1)
            theta = np.broadcast_to(ahead, (count, len(ahead)))
            with np.errstate(all="ignore"):
                numbers = family.margins(family.solve(theta))
            worst[[*families]] = np.min(np.nan_to_num(numbers, nan=-1.0), axis=1)
        return machines, worst


def _judging(
    machine: Machine,
    vary: Mapping[str, tuple[float, float]] | None,
    sense: Sense,
    goals: Sequence[Requirement],
) -> Callable[[Array], GoalOutcome]:
    """In another process: what judges designs."""
    return PlantingProblem(Designs(machine, vary, sense), goals).judge_here


def _figures(
    machines: list[Machine], wanted: Collection[str] | None = None, turns: int | None = None
) -> dict[str, Array]:
    """Figures of designs by name, (P,); NaN where a design does not have one."""
    with np.errstate(all="ignore"):
        curve = TipCurve(machines, GRID, turns)
        figures = machine_figures(curve, wanted)
        plants = np.all([_plants(arm) for arm in curve.arms], axis=0)
        return {name: np.where(plants, values, np.nan) for name, values in figures.items()}


def _plants(curve: TipCurve) -> Array:
    """Whether the tip reaches the soil, and rises well above it, (P,)."""
    lift, height = curve.highest[0] - curve.surface, curve.highest[0] - curve.lowest[0]
    plants: Array = (lift > LEAST_LIFT * height) & (curve.surface > curve.lowest[0])
    return plants


def figure_names(machine: Machine) -> list[str]:
    """Names of the figures of which a search can make goals."""
    return list(_figures([machine]))


def _columns(columns: list[Array], count: int) -> Array:
    return np.stack(columns, axis=1) if columns else np.zeros((count, 0))
