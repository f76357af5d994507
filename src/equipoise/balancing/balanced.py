"""The result of balancing: what to change, what that does, and how near to the best it is."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import asdict, dataclass
from functools import cached_property
from typing import Any

import numpy as np

from equipoise.balancing.figures import (
    equivalent_speeds,
    figures_of,
    planting_kept,
    signal_columns,
)
from equipoise.balancing.measures import unit_of
from equipoise.balancing.design_variables import Change
from equipoise.balancing.phase_search import Phasing
from equipoise.mechanism.balance import Balance
from equipoise.mechanism.model import Machine

Array = np.ndarray[Any, Any]


@dataclass(frozen=True)
class Price:
    """What a limit costs.

    at_most : the limit.  used : what of it is used.  unit : SI unit of both.
    price : by how much the objective falls for one SI unit more of the limit; in the objective's
        unit where there is one objective, else over its value before.
    """

    at_most: float
    used: float
    price: float
    unit: str = ""

    @property
    def active(self) -> bool:
        """Whether the limit stands in the way."""
        return self.price > 0


@dataclass(frozen=True, eq=False)
class Balanced:
    """A balanced machine, beside the one that it comes from.

    machine : with the changes made.  original : without.
    plan : what was asked.
    changes : what to change, in the order of the plan.
    objectives : name -> value before and after, SI units.
    cost, bound : what was made small (the objectives over their values before, as the plan combines
        them), and a proved lower bound of it for every machine that the plan allows; None where
        nothing is proved, as of phases.
    method : ``closed form``, ``cone program`` or ``branch and bound``, with what was scanned.
    prices : of each limit, by name.
    looked_at : number of programs that were solved, or of arrangements of rows.
    phasing : of rows, where their phases were free.
    scope : of what the bound is proved, where that is not all that the plan allows.
    """

    machine: Machine
    original: Machine
    plan: Balance
    changes: tuple[Change, ...]
    objectives: Mapping[str, tuple[float, float]]
    cost: float
    bound: float | None
    method: str
    prices: Mapping[str, Price]
    looked_at: int
    notes: tuple[str, ...] = ()
    phasing: Phasing | None = None
    scope: str = ""

    @property
    def gap(self) -> float | None:
        """Between what was found and the proved bound, over the value before; None without one."""
        if self.bound is None:
            return None
        before = self.plan.combined([1.0] * len(self.plan.objectives))
        # A bound above the cost is rounding, which is as large as it may be below.
        return abs(self.cost - self.bound) / before

    @property
    def added_mass(self) -> float:
        """kg."""
        return self.after["mass"] - self.before["mass"]

    @cached_property
    def before(self) -> dict[str, float]:
        """Figures of the machine as it was, by name; SI units."""
        return figures_of(self.original)

    @cached_property
    def after(self) -> dict[str, float]:
        """The same of the balanced machine."""
        return figures_of(self.machine)

    @property
    def sensitivities(self) -> dict[str, Any]:
        """Effect of each parameter of the original on what was made small; see `sensitivities`.

        For components of the shaking force, shaking moment and drive torque.
        """
        from equipoise.balancing.sensitivity import OUTPUTS, sensitivities

        asked = dict.fromkeys(one.output for one in self.plan.objectives)
        if "shaking_force" in asked:
            asked |= {"shaking_force.x": None, "shaking_force.y": None}
        found = {name: sensitivities(self.original, name) for name in asked if name in OUTPUTS}
        return {name: one.to_dict(signals=False) for name, one in found.items()}

    @property
    def units(self) -> dict[str, str]:
        """SI unit of each objective and limit."""
        names = {one.name: unit_of(one, self.original) for one in self.plan.objectives}
        return names | {name: price.unit for name, price in self.prices.items()}

    def columns(self) -> list[tuple[str, str, Array]]:
        """Name, unit and values (N,) of crank angle, force, moment and torque before and after."""
        return signal_columns(self.original, self.machine)

    @property
    def planting_kept(self) -> bool | None:
        """Whether the planting figures are what they were; None where there are none."""
        return planting_kept(self.before, self.after)

    @property
    def equivalent_speeds(self) -> dict[str, float]:
        """Speeds (rad/s) at which the new machine shakes as the old one did, by figure."""
        return equivalent_speeds(self.before, self.after, self.original.drive.speed)

    def to_dict(self, wanted: Collection[str] | None = None) -> dict[str, Any]:
        """The machine-readable output, SI units and radians.

        wanted : keys that are needed of those that take time; None for all.
        """
        asked = wanted is None or "sensitivities" in wanted
        return {
            "title": self.original.title,
            "speed": self.original.drive.speed,
            "objectives": {
                name: {"before": before, "after": after}
                for name, (before, after) in self.objectives.items()
            },
            "method": self.method,
            "cost": self.cost,
            "bound": self.bound,
            "gap": self.gap,
            "scope": self.scope,
            "changes": [change.to_dict() for change in self.changes],
            "prices": {name: asdict(price) for name, price in self.prices.items()},
            "added_mass": self.added_mass,
            "before": self.before,
            "after": self.after,
            "equivalent_speeds": self.equivalent_speeds,
            "planting_kept": self.planting_kept,
            **({"sensitivities": self.sensitivities} if asked else {}),
            **({} if self.phasing is None else {"rows": self.phasing.to_dict()}),
            "notes": list(self.notes),
        }
