"""The result of balancing: what to change, what that does, and how near to the best it is."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from dataclasses import asdict, dataclass
from functools import cached_property
from typing import Any

from equipoise.balancing.design_variables import Bound
from equipoise.balancing.figures import equivalent_speeds, figures_of, planting_kept, signal_columns
from equipoise.balancing.geared import geared_range
from equipoise.balancing.objectives import unit_of
from equipoise.balancing.phase_search import Phasing
from equipoise.balancing.problem import ADDED
from equipoise.balancing.solution import Solution
from equipoise.balancing.workshop import Change
from equipoise.i18n import Note
from equipoise.mechanism.balance import Balance
from equipoise.mechanism.model import Machine
from equipoise.results.result import Result
from equipoise.signals import Array


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


@dataclass(frozen=True, eq=False, repr=False)
class Balanced(Result):
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
    method: Note
    prices: Mapping[str, Price]
    looked_at: int
    notes: tuple[Note | str, ...] = ()
    phasing: Phasing | None = None
    scope: tuple[Note, ...] = ()

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

        For what `known_outputs` has, and for the components of vectors among them.
        """
        from equipoise.balancing.sensitivity import known_outputs, sensitivities

        asked = dict.fromkeys(one.output for one in self.plan.objectives)
        asked |= {f"{name}.{axis}": None for name in asked for axis in "xy"}
        known = known_outputs()
        found = {name: sensitivities(self.original, name) for name in asked if name in known}
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
            "method": str(self.method),
            "cost": self.cost,
            "bound": self.bound,
            "gap": self.gap,
            "scope": " and ".join(map(str, self.scope)),
            "changes": [change.to_dict() for change in self.changes],
            "prices": {name: asdict(price) for name, price in self.prices.items()},
            "added_mass": self.added_mass,
            "before": self.before,
            "after": self.after,
            "equivalent_speeds": self.equivalent_speeds,
            "planting_kept": self.planting_kept,
            **({"sensitivities": self.sensitivities} if asked else {}),
            **({} if self.phasing is None else {"rows": self.phasing.to_dict()}),
            "notes": list(map(str, self.notes)),
        }


def result_of(machine: Machine, plan: Balance, found: Solution) -> Balanced:
    """The result, with what was asked read off the new machine."""
    problem = found.problem
    objectives = {
        one.name: (problem.before[one.name], problem.value_of(found.machine, one))
        for one in plan.objectives
    }
    pairs = zip(problem.parts, found.numbers, strict=True)
    changes = [*found.meshes, *(change for part, own in pairs for change in part.changes(own))]
    return Balanced(
        found.machine,
        machine,
        plan,
        tuple(changes),
        objectives,
        problem.cost_of(found.machine),
        found.best.bound,
        found.method,
        _prices(found),
        found.best.nodes,
        tuple(_notes(found)),
        scope=_scope(found),
    )


def _scope(found: Solution) -> tuple[Note, ...]:
    """Of what the bound is proved, where that is not all that the plan allows."""
    problem, told = found.problem, []
    pairs = zip(problem.parts, found.numbers, strict=True)
    if problem.reads_gauges and problem.supports_more:
        told.append(Note("for small changes about it"))
    if any(part.stopped(own) for part, own in pairs):
        told.append(Note("within where it was stopped"))
    if problem.flips:
        told.append(Note("for the flanks of gears in contact here"))
    if any(geared_range(geared) for geared in problem.plan.geared):
        told.append(Note("for each of the gears tried"))
    return tuple(told)


def _prices(found: Solution) -> dict[str, Price]:
    """Prices of the limits, in SI units."""
    problem, plan = found.problem, found.problem.plan
    only = plan.objectives[0] if len(plan.objectives) == 1 else None
    unit = 1.0 if only is None else problem.scale(only) / only.weight
    prices = {}
    for limit in plan.limits:
        scale = problem.scale(limit.objective)
        at_most = (
            limit.at_most
            if limit.at_most is not None
            else (limit.ratio or 0.0) * problem.before[limit.name]
        )
        used = problem.value_of(found.machine, limit.objective)
        paid = found.best.prices.get(limit.name, 0.0) * unit / scale
        paid = _rounded(paid, unit / scale)
        prices[limit.name] = Price(at_most, used, paid, unit_of(limit.objective, problem.machine))
    return prices | _prices_of_parts(found, unit)


def _prices_of_parts(found: Solution, unit: float) -> dict[str, Price]:
    """Prices of added mass in all, and of the limits that each part has of itself."""
    problem, most = found.problem, found.problem.plan.added_mass
    pairs = [*zip(problem.parts, found.numbers, strict=True)]
    bounds = [bound for part, own in pairs for bound in part.bounds(own)]
    if most is not None:
        weights = sum(float(own @ part.effect[:, 0]) for part, own in pairs if part.mass_place == 0)
        bounds.append(Bound(ADDED, most, weights, "kg"))
    prices = {}
    for one in bounds:
        paid = _rounded(found.best.prices.get(one.name, 0.0) * unit, unit / one.at_most)
        prices[one.name] = Price(one.at_most, one.used, paid, one.unit)
    return prices


def _rounded(price: float, scale: float) -> float:
    """A price that is nothing but the solver's rounding is 0."""
    return price if price > 1e-7 * scale else 0.0


def _notes(found: Solution) -> Iterator[Note]:
    """What a reader has to know."""
    problem, rows = found.problem, len(found.problem.machine.rows)
    if problem.machine.drive.acceleration:
        yield Note("the drive's acceleration is left out: the crank is taken as turning steadily")
    if problem.reads_gauges and problem.supports_more:
        yield Note(
            "added mass makes the support heavier, which bends what is linear "
            "otherwise: the bound is that of small changes about this result"
        )
    pairs = zip(problem.parts, found.numbers, strict=True)
    yield from filter(None, (part.stopped(own) for part, own in pairs))
    if rows > 1 and any(part.mass_place is not None for part in problem.parts):
        yield Note("masses are those of one row; the machine has {rows}", rows=rows)
    if found.ties > 1:
        yield Note(
            "{count} of the ratios tried are as good, and the lightest was taken;"
            " drive and joints may tell them apart: give them a limit",
            count=found.ties,
        )
    if found.best.nodes >= 1 and found.best.value - found.best.bound > 1e-7:
        yield Note(
            "the search ended before it had proved that nothing better exists; "
            "the gap tells how far it came"
        )
