"""The result of balancing: what to change, what that does, and how near to the best it is."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping
from dataclasses import asdict, replace
from functools import cached_property
from itertools import chain
from math import isclose, sqrt
from typing import Any, ClassVar

import numpy as np

from equipoise.balancing import comparison
from equipoise.balancing.beyond_masses import Beyond
from equipoise.balancing.design_variables import Bound
from equipoise.balancing.effects import ANGLES
from equipoise.balancing.geared import geared_range
from equipoise.balancing.headlines import Advice
from equipoise.balancing.objectives import unit_of
from equipoise.balancing.phase_search import Phasing
from equipoise.balancing.problem import ADDED
from equipoise.balancing.rounding import NEARLY
from equipoise.balancing.solution import SAME_FRICTION, Solution
from equipoise.balancing.workshop import Change, covers
from equipoise.dataclass import dataclass
from equipoise.i18n import Note, all_of
from equipoise.mechanism.checks import bodies_at
from equipoise.mechanism.kinematics.motion import move
from equipoise.mechanism.outputs.declared import declared
from equipoise.mechanism.parts.balance import GAUGES, ROWS, Balance, Objective
from equipoise.mechanism.parts.machine import Machine
from equipoise.planting.names import dimension_of as of_planting
from equipoise.quantities import Dimension, format_quantity
from equipoise.results.analysis import Analysis, analyze
from equipoise.results.declaring import (
    NOTES,
    TITLE,
    Declarations,
    ResultOutput,
    dimension_at,
    values_of,
)
from equipoise.results.outputs import AnalysisOutputs, unit_of_measure
from equipoise.results.remarks import slender_links
from equipoise.results.result import Result
from equipoise.signals import Array
from equipoise.vibration.response import GaugeSignals, of_support

PROVED, UNFINISHED = 1e-3, 1e-7
"""Gap over the value before up to which a result is called proved, which no workshop could use;
and the one from which a search ended before its own tolerance."""
NOWHERE = 1e-12
"""SI units: a planting figure that is 0, but for rounding."""
GONE, ROUNDING = 1e-9, 1e-7
"""Share of a figure before below which it is rounding; share of all for a price."""


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


@dataclass(frozen=True)
class MoreRoom:
    """What more room would allow.

    remedy : a machine with a counterweight there, beside the one that it comes from.
    at : the pivot.  assumed, wanted : how far the room about it is taken to reach, and would
        reach, m.
    """

    remedy: Balanced
    at: str
    assumed: float
    wanted: float

    declared: ClassVar[Declarations] = {
        "at": ResultOutput("the pivot"),
        "assumed": ResultOutput("how far the room about it is taken to reach", "length"),
        "wanted": ResultOutput("how far it would reach", "length"),
        "gain": ResultOutput("share of the aims that is gone then", read="remedy.gain"),
        "changes": ResultOutput(
            "list of what to change, see below", read=lambda more_room: _changes(more_room.remedy)
        ),
    }


WHY = "see [Balancing](balancing.md#why-nothing-is-better)"


def _changes(balanced: Balanced) -> list[dict[str, Any]]:
    return [change.to_dict() for change in balanced.changes]


def _dimension_of(model: Any, figure: str) -> Dimension | None:
    """Dimension of a figure that is compared, such as ``shaking_force.x.rms``."""
    if figure == "mass":
        return "mass"
    if figure.startswith("planting."):
        return of_planting(figure.removeprefix("planting."))
    output, _, measure = figure.rpartition(".")
    if output.startswith("gauges."):
        gauges = {"gauges": of_support("gauges", "", GaugeSignals.declared)}
        return dimension_at(gauges, f"{output}.rms", model)
    known = declared(output)
    return None if known is None or measure == "area" else known[0].dimension


@dataclass(frozen=True, eq=False, repr=False)
class Balanced(Result):
    """A balanced machine, beside the one that it comes from.

    machine : with the changes made.  original : without.
    plan : what was asked.
    changes : what to change, in the order of the plan.
    objectives : name -> value before and after, SI units, as the optimisation has them; extremes at
        twice the crank angles of an analysis, where phases are free also between these.
    cost, bound : what was made small (the objectives over their values before, as the plan combines
        them), and a proved lower bound of it for every machine that the plan allows.
    method : ``closed form``, ``cone program`` or ``branch and bound``, with what was scanned.
    prices : of each limit, by name.
    looked_at : number of programs that were solved, or of arrangements of rows.
    phasing : of rows, where their phases were free.
    scope : of what the bound is proved, where that is not all that the plan allows.
    tried : where nobody said what may be changed, every remedy that was tried, this one among them.
    advice : where nobody said so, what it is judged by.
    with_room : where nobody said so, what more room would allow.
    """

    blocks_in = "balancing.blocks.balanced_blocks"
    pictures_in = "figures.balancing.balance_charts"
    headline_in = "balancing.blocks.balanced_headline"

    machine: Machine
    original: Machine
    plan: Balance
    changes: tuple[Change, ...]
    objectives: Mapping[str, tuple[float, float]]
    cost: float
    bound: float
    method: Note
    prices: Mapping[str, Price]
    looked_at: int
    notes: tuple[Note | str, ...] = ()
    phasing: Phasing | None = None
    scope: tuple[Note, ...] = ()
    tried: tuple[Balanced, ...] = ()
    advice: Advice | None = None
    with_room: MoreRoom | None = None

    @property
    def gap(self) -> float:
        """Between what was found and the proved bound, over the value before."""
        # A bound above the cost is rounding, which is as large as it may be below.
        return abs(self.cost - self.bound) / self.whole

    @property
    def proved(self) -> bool:
        """Whether nothing that is allowed is better by a thousandth of the value before."""
        return self.gap < PROVED

    @property
    def whole(self) -> float:
        """Cost of the original."""
        return self.plan.combined([1.0] * len(self.plan.objectives))

    @property
    def bending(self) -> tuple[Note, ...]:
        """Links that bend so much that balancing by rigid links misleads, also where no change is
        offered.
        """
        return tuple(bending_notes(self.original))

    @property
    def added_mass(self) -> float:
        """kg."""
        return self.machine.mass - self.original.mass

    @cached_property
    def before(self) -> dict[str, float]:
        """Figures of the machine as it was, by name; SI units."""
        return self._shaking[0] | comparison.planting_of(self.original)

    @cached_property
    def after(self) -> dict[str, float]:
        """Figures of the balanced machine, by name; SI units."""
        return self._shaking[1] | comparison.planting_of(self.machine)

    @cached_property
    def _shaking(self) -> tuple[dict[str, float], dict[str, float]]:
        """Before and after without planting, which every remedy that is tried would compute."""
        before = analyze(self.original, acceleration=0.0)
        return comparison.figures_of(before), comparison.figures_of(self.analysis)

    @cached_property
    def analysis(self) -> Analysis:
        """The balanced machine at constant speed."""
        return analyze(self.machine, acceleration=0.0)

    @cached_property
    def aims(self) -> dict[Objective, comparison.BeforeAndAfter]:
        """What was made small, before and after; of an output at several speeds the loudest."""
        return comparison.merged(self.plan, self.reported)

    @cached_property
    def reported(self) -> dict[str, comparison.BeforeAndAfter]:
        """Each objective before and after by its name, as `before` and `after` have it.

        Those that are no such figures, such as single orders, are as the optimisation has them.
        """
        old, new = self._shaking
        names = self._figures_of(self.plan.objectives)
        return {**self.objectives, **{item: (old[name], new[name]) for item, name in names.items()}}

    @cached_property
    def limits(self) -> dict[str, Price]:
        """The price of each limit by its name, and what is used of it as `after` has it."""
        names = self._figures_of(limit.objective for limit in self.plan.limits)
        own = {price: self._shaking[1][names[price]] for price in self.prices if price in names}
        return {**self.prices, **{item: replace(self.prices[item], used=own[item]) for item in own}}

    def _figures_of(self, objectives: Iterable[Objective]) -> dict[str, str]:
        """Names of the figures before and after that objectives are, by the objective's name."""
        both = self._shaking[0].keys() & self._shaking[1].keys()
        rows = len(self.original.rows)
        figures = {item.name: comparison.figure_of(item, rows, both) for item in objectives}
        return {item: name for item, name in figures.items() if name is not None}

    @cached_property
    def worse(self) -> tuple[comparison.Worse, ...]:
        """Every figure that got larger by more than 1 %, the important ones first."""
        each = {objective: self.objectives[objective.name] for objective in self.plan.objectives}
        own = (item for item in each if item.speeds or item.about or item.orders)
        return comparison.worse_of(*self._shaking, {item: each[item] for item in own})

    @property
    def gain(self) -> float:
        """Share of what was made small that is gone, every part of it over its value before."""
        pairs = self.objectives.values()
        shares = [new / old if old > 0 else float(new > 0) for old, new in pairs]
        return 1 - self.plan.combined(shares) / self.whole

    @property
    def helps(self) -> bool:
        """Whether it is worth a change; of what nobody asked for, whether it is offered."""
        if self.advice is not None:
            return self.advice.offered
        moved = (abs(b - a) > comparison.WORSE * a for a, b in self.objectives.values())
        return bool(self.plan.limits) or any(moved)

    @property
    def sensitivities(self) -> dict[str, Any]:
        """Effect of each parameter of the original on what was made small; see `sensitivities`.

        For what `known_outputs` has, and for the components of vectors among them.
        """
        from equipoise.balancing.sensitivity import known_outputs, sensitivities

        names = dict.fromkeys(objective.output for objective in self.plan.objectives)
        names |= {f"{name}.{axis}": None for name in names for axis in "xy"}
        known = known_outputs(self.original)
        by_name = {name: sensitivities(self.original, name) for name in names if name in known}
        return {name: item.to_dict(signals=False) for name, item in by_name.items()}

    @property
    def units(self) -> dict[str, str]:
        """SI unit of each objective and limit."""
        names = {
            objective.name: unit_of(objective, self.original) for objective in self.plan.objectives
        }
        return names | {name: price.unit for name, price in self.prices.items()}

    def columns(self) -> list[tuple[str, str, Array]]:
        """Name, unit and values (N,) of crank angle, force, moment and torque before and after.

        Over the longer of their cycles, where an added shaft takes several turns to come back.
        """
        machines = {"before": self.original, "after": self.machine}
        turns = max(move(machine, 1).turns for machine in machines.values())
        angles = np.arange(ANGLES * turns) * (2 * np.pi / ANGLES)
        columns = [("crank_angle", "rad", angles)]
        for name, machine in machines.items():
            motion = move(machine, angles, acceleration=0.0)
            columns += [
                (f"{item.name}.{name}", item.unit, item.values)
                for item in AnalysisOutputs(Analysis.of(motion)).ordered
                if item.declared.compared
            ]
        return columns

    @property
    def planting_kept(self) -> bool | None:
        """Whether the planting figures are what they were; None where there are none."""
        old, new = self.before, self.after
        names = [name for name in old if name.startswith("planting.")]
        pairs = ((old[name], new.get(name, np.nan)) for name in names)
        same = (isclose(*pair, rel_tol=NEARLY, abs_tol=NOWHERE) for pair in pairs)
        return all(same) if names else None

    @property
    def equivalent_speeds(self) -> dict[str, float]:
        """Speeds (rad/s) at which the new machine shakes as the old one did, by figure.

        Shaking forces and moments grow with the square of the speed (Lee and Kim, conclusions).
        What was nothing but rounding before, or is so after, has no such speed.
        """
        old, new = self._shaking
        return {
            name: self.original.drive.speed * sqrt(old[name] / new[name])
            for name, scale in self._scales.items()
            if name.startswith(("shaking_", ROWS))
            and old.get(name, 0.0) > comparison.NOTHING * scale
            and new.get(name, 0.0) > GONE * old[name]
        }

    @property
    def _scales(self) -> dict[str, float]:
        """Of each force and moment by name, the largest of its kind before or after."""
        names = [name for name in self._shaking[0] if "." in name and not name.startswith(GAUGES)]
        units = {name: unit_of_measure(*name.rsplit(".", 1)) for name in names}
        return comparison.scales_of(*self._shaking, units)

    @property
    def _phased(self) -> dict[str, Any]:
        """What phases bring, with the objectives as they are reported."""
        phasing = self.phasing
        assert phasing is not None
        objectives = [
            {"name": name, "before": old, "after": new}
            for name, (old, new) in self.reported.items()
            if name in phasing.before
        ]
        return phasing.to_dict() | {"objectives": objectives}

    def to_dict(self, wanted: Collection[str] | None = None) -> dict[str, Any]:
        """The machine-readable output, SI units and radians.

        wanted : keys that are needed of those that take time; None for all.
        """
        return values_of(self, self.declared, wanted)

    declared: ClassVar[Declarations] = {
        "title": TITLE,
        "speed": ResultOutput("speed of the crank", "angular speed", read="original.drive.speed"),
        "objectives": ResultOutput(
            'objective, such as `"rms of shaking_force.y"`: `before` and `after`, in SI units; a '
            "whole signal's measure as `before` and `after` have it",
            family=True,
            read=lambda result: {
                name: {"before": old, "after": new} for name, (old, new) in result.reported.items()
            },
        ),
        "method": ResultOutput("how it was found", read=lambda result: str(result.method)),
        "cost": ResultOutput(WHY),
        "bound": ResultOutput(WHY),
        "gap": ResultOutput(WHY),
        "scope": ResultOutput(
            "of what the bound is proved, where that is not all that the plan allows",
            read=lambda result: " and ".join(map(str, result.scope)),
        ),
        "changes": ResultOutput("list of what to change, see below", read=_changes),
        "prices": ResultOutput(
            'of each limit, of `"mass on LINK"` where `at_most` is given, and of `"added mass"`: '
            "`at_most`, `used` and `price`, which is the fall of the objective for one SI unit "
            "more of the limit, in the unit of the objective, or over its value before where "
            "there are several",
            family=True,
            read=lambda result: {name: asdict(price) for name, price in result.limits.items()},
        ),
        "added_mass": ResultOutput("mass that is added", "mass"),
        "before": ResultOutput("figures of the whole machine, see below", lookup=_dimension_of),
        "after": ResultOutput("figures of the new machine", lookup=_dimension_of),
        "worse": ResultOutput(
            "list of `figure`, `before`, `after`: every figure that got larger by more than 1 %, "
            "the important ones first",
            read=lambda result: [
                {"figure": worse.objective.name, "before": worse.before, "after": worse.after}
                for worse in result.worse
            ],
        ),
        "equivalent_speeds": ResultOutput(
            "speed of the crank at which the new machine has the old figure; of shaking forces "
            "and moments, and of all rows; absent where nothing is left",
            "angular speed",
            family=True,
        ),
        "planting_kept": ResultOutput(
            "whether the planting figures are what they were; null where there are none"
        ),
        "sensitivities": ResultOutput(
            "the object of `sensitivities`, see below, of each objective that is a component of "
            "the shaking force or of a rocking moment, the shaking moment or the drive torque",
            family=True,
            slow=True,
        ),
        "rows": ResultOutput(
            "where phases were free: `phases` (rad), `remaining_orders`, `lateral` with `before` "
            "and `after`, `combinations`, `step`, `objectives`, `combined`, `bound` (of "
            "`combined`, proved), `looked_at` (boxes of phases), `notes`",
            read="_phased",
            present="phasing",
        ),
        "offered": ResultOutput(
            "where the file does not say what may be changed: whether the change is offered",
            read="advice.offered",
            present="advice",
        ),
        "large": ResultOutput(
            "there: list of `figure`, `value`, `unit`, `yardstick`, `against`, `ratio`, "
            "`crank_angle`: figures [against their yardsticks](balancing.md#without-a-plan), the "
            "largest ratio first, which is null for a safety or life of 0; `figure` is its path in "
            "the summary of `analyze`, in its output for cams, sections and bearings, or in the "
            "output of `respond` for gauges",
            read=lambda result: [item.to_dict() for item in result.advice.before],
            present="advice",
        ),
        "tried": ResultOutput(
            "there: list of `gain`, `worth`, `changes`: what was tried, the share of the aims that "
            "each takes away, and whether it is offered",
            read=lambda result: [
                {"gain": item.gain, "worth": item.helps, "changes": _changes(item)}
                for item in result.tried
            ],
            present="advice",
        ),
        "beyond": ResultOutput(
            "there: what helps beyond masses",
            of=Beyond.declared,
            read="advice.beyond",
            present="advice",
            spliced=True,
        ),
        "with_room": ResultOutput(
            "there: what a counterweight would do with twice the room that is assumed, or null",
            of=MoreRoom.declared,
            present="advice",
        ),
        "notes": NOTES,
    }


def result_of(machine: Machine, plan: Balance, solution: Solution) -> Balanced:
    """The result, with what was asked read off the new machine."""
    problem, old, new, best = (
        solution.problem,
        solution.problem.before,
        solution.machine,
        solution.best,
    )
    each = (part.changes(own) for part, own in problem.with_numbers(solution.numbers))
    return Balanced(
        machine=new,
        original=machine,
        plan=plan,
        changes=(*solution.meshes, *chain.from_iterable(each)),
        objectives={
            objective.name: (old[objective.name], problem.value_of(new, objective))
            for objective in plan.objectives
        },
        cost=problem.cost_of(new),
        bound=best.bound,
        method=solution.method,
        prices=_prices(solution),
        looked_at=best.nodes,
        notes=(*bending_notes(machine), *_notes(solution)),
        scope=tuple(proved_of(solution)),
    )


def proved_of(solution: Solution) -> Iterator[Note]:
    """Of what the bound is proved, where that is not all that the plan allows."""
    problem = solution.problem
    if problem.reads_gauges and problem.supports_more:
        yield Note("for small changes about it")
    if any(part.stopped(own) for part, own in problem.with_numbers(solution.numbers)):
        yield Note("within where it was stopped")
    if problem.flips:
        yield Note("for the flanks of teeth and strands of chains that bear here")
    if problem.rubs:
        yield Note("for friction in joints as it is here")
    if solution.gears_left or any(geared_range(geared) for geared in problem.plan.geared):
        yield Note("for each of the gears tried")


def _prices(solution: Solution) -> dict[str, Price]:
    """Prices of all limits, in SI units: those asked for, and those that parts have of themselves.

    What is nothing but the solver's rounding is 0.
    """
    problem, plan = solution.problem, solution.problem.plan
    only = plan.objectives[0] if len(plan.objectives) == 1 else None
    unit = 1.0 if only is None else problem.scale(only) / plan.factors[0]
    prices = {}

    def add(bound: Bound, scale: float, rounding: float) -> None:
        paid = solution.best.prices.get(bound.name, 0.0) * unit / scale
        paid = paid if paid > ROUNDING * unit / rounding else 0.0
        prices[bound.name] = Price(bound.at_most, bound.used, paid, bound.unit)

    for limit in plan.limits:
        scale, at_most = problem.scale(limit.objective), limit.most(problem.before[limit.name])
        used = problem.value_of(solution.machine, limit.objective)
        si_unit = unit_of(limit.objective, problem.machine)
        add(Bound(limit.name, at_most, used, si_unit), scale, scale)
    weights = 0.0
    for part, own in problem.with_numbers(solution.numbers):
        weights += 0.0 if part.mass_place is None else float(own @ part.effect[:, 0])
        for bound in part.bounds(own):
            add(bound, 1.0, bound.at_most)
    if plan.added_mass is not None:
        add(Bound(ADDED, plan.added_mass, weights, "kg"), 1.0, plan.added_mass)
    return prices


def _over_pins(solution: Solution) -> Iterator[Note]:
    """That plates lie where pins of their own link are, which a plan's room does not know."""
    bodies = bodies_at(solution.machine.bodies)
    for part, own in solution.problem.with_numbers(solution.numbers):
        for change in part.changes(own):
            pieces = change.values.get("pieces", ())
            if not pieces or not (moment := change.values["moment"]):
                continue
            center = complex(*change.values["center"])
            link = solution.machine.links[change.link]
            plane = change.values.get("plane", link.plane)
            pins = [name for name, at in link.points.items() if len(bodies.get(name, ())) > 1
                    and any(covers(piece, center, complex(*at))
                            and _reaches_plane(piece, plane, link.plane_of(name))
                            for piece in pieces)]  # fmt: skip
            if pins:
                yield Note(
                    "the plate on {link} lies over pin {pins}: put it in a plane of its own, or "
                    "take {moment} off {link} on the other side of {at}, if that much is there",
                    link=change.link,
                    pins=all_of(pins),
                    moment=format_quantity(moment, "unbalance", digits=3),
                    at=change.values["at"],
                )


def _reaches_plane(piece: Mapping[str, Any], plane: float, other: float) -> bool:
    """Whether a plate whose middle lies in one plane takes up another too; z of both, m."""
    return plane == other or abs(plane - other) < (piece.get("thickness") or 0.0) / 2


def bending_notes(original: Machine) -> Iterator[Note]:
    """Links that bend so much that balancing by rigid links misleads.

    Of the machine without what is added: a counterweight beyond a pin bends a link more, but would
    count as less of the rod that lies along its line.
    """
    return slender_links(original.links, original.drive.speed)


def _of_friction(solution: Solution) -> Note:
    """That friction changes with what is free, and how far the bound holds for that."""
    outputs = all_of([*solution.problem.rubs], commas=True)
    if solution.settled:
        return Note(
            "friction in joints makes {outputs} nonlinear in the masses; it was recomputed from "
            "each result until the objectives and limits changed by less than {tolerance:.0e} of "
            "their values before; the bound assumes that friction is constant",
            outputs=outputs,
            tolerance=SAME_FRICTION,
        )
    return Note(
        "friction in joints makes {outputs} nonlinear in the masses; it was recomputed from each "
        "result but did not settle: objectives and limits with the friction of this result differ "
        "by up to {change:.2g} of their values before from those with the friction that was "
        "assumed; the bound assumes the latter",
        outputs=outputs,
        change=solution.friction_change,
    )


def _notes(solution: Solution) -> Iterator[Note]:
    """What a reader has to know."""
    problem, rows = solution.problem, len(solution.problem.machine.rows)
    if problem.machine.drive.acceleration:
        yield Note("the acceleration of the drive is ignored: the crank speed is taken as constant")
    if problem.rubs:
        yield _of_friction(solution)
    if problem.reads_gauges and problem.supports_more:
        yield Note(
            "added mass increases the mass of the support, which makes the problem nonlinear: "
            "the bound holds for small changes about this result"
        )
    yield from filter(None, (part.stopped(x) for part, x in problem.with_numbers(solution.numbers)))
    yield from _over_pins(solution)
    if rows > 1 and any(part.mass_place is not None for part in problem.parts):
        yield Note("masses are those of one row; the machine has {rows}", rows=rows)
    if solution.ties > solution.weighed:
        yield Note(
            "{count} of the ratios tried are as good, and the lightest of {weighed} of them was "
            "taken; drive and joints may tell them apart: give them a limit",
            count=solution.ties,
            weighed=solution.weighed,
        )
    elif solution.ties > 1:
        yield Note(
            "{count} of the ratios tried are as good, and the lightest was taken;"
            " drive and joints may tell them apart: give them a limit",
            count=solution.ties,
        )
    if solution.best.nodes >= 1 and solution.best.value - solution.best.bound > UNFINISHED:
        yield Note(
            "the search ended before the optimum was proved; the gap bounds the possible "
            "improvement"
        )
