"""A plan of balancing as a cone program: numbers, limits, and what is to become small."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import cached_property

import numpy as np

from equipoise.balancing.branch_and_bound import Square
from equipoise.balancing.design_variables import (
    AddedWeight,
    DesignVariables,
    FreeSpring,
    MovedCenter,
    with_numbers,
)
from equipoise.balancing.effects import Effects, Signal
from equipoise.balancing.objectives import (
    LinearizationPoint,
    bound_measure,
    measured,
    signals_of,
    supports_more,
)
from equipoise.balancing.program import Affine, Program
from equipoise.balancing.rounding import NEARLY
from equipoise.dataclass import dataclass
from equipoise.errors import UsageError
from equipoise.i18n import Note
from equipoise.mechanism.checks import numbered
from equipoise.mechanism.outputs.declared import declared
from equipoise.mechanism.parts.balance import WITHIN, Balance, Objective
from equipoise.mechanism.parts.machine import Machine
from equipoise.signals import Array

WITHOUT_EFFECT = 1e-9
"""Over the RMS of an output: change by a unit of every number that is taken for none."""
ROUNDING = 1e-11
"""Over the effect of a unit of a number: an objective that is nothing but rounding."""
KEPT = 1e-8
"""Over the value before: by how much a limit may be passed, as solvers do."""
HIGHEST = 100
"""Highest order that is reported: 720 angles in a turn resolve it well."""
ADDED = Note("added mass")


@dataclass(frozen=True, eq=False)
class Problem:
    """What is asked of a machine.

    machine : as it is.  start : the machine from which the parts' numbers count: with its geared
        shafts, and moved centres of mass in the origin.
    parts : what is free.  close : a machine near the solution, whose mass gauges are read with.
    counts : value of each objective and limit that counts as before; computed where None.
    known : effects of the parts' numbers; computed where None.
    """

    machine: Machine
    plan: Balance
    start: Machine
    parts: tuple[DesignVariables, ...]
    close: LinearizationPoint
    counts: Mapping[str, float] | None = None
    known: Effects | None = None

    @classmethod
    def of(
        cls,
        machine: Machine,
        plan: Balance,
        with_shafts: Machine | None = None,
        shaft_variables: Sequence[DesignVariables] = (),
    ) -> Problem:
        """From a plan; `with_shafts` is the machine with geared shafts, whose parts are `more`."""
        base = machine if with_shafts is None else with_shafts
        parts: list[DesignVariables] = [MovedCenter(base, move) for move in plan.moves]
        parts += [AddedWeight(base, m.link, m.at, m.weight) for m in plan.masses]
        springs = numbered("balance.springs", plan.springs)
        parts += [*shaft_variables, *(FreeSpring(base, spring, where) for where, spring in springs)]
        _name_apart(parts)
        start = base
        for move in plan.moves:
            start = start.with_link(move.link, center_of_mass=(0.0, 0.0))
        return cls(machine, plan, start, tuple(parts), LinearizationPoint(machine))

    def with_numbers(self, numbers: list[Array]) -> Iterator[tuple[DesignVariables, Array]]:
        """Each part, and its numbers."""
        return zip(self.parts, numbers, strict=True)

    def linearized_at(self, numbers: list[Array]) -> Problem:
        """Problem with gauges linearized at the machine of some numbers, and with its friction."""
        close = LinearizationPoint(self.machine_with(numbers), np.concatenate(numbers))
        effects = self.effects
        if self.flips or self.rubs:
            like = close.machine if self.flips else None
            rubbing = close.machine if self.rubs else None
            effects = Effects(self.start, self.parts, effects.motion, like, rubbing)
        return replace(self, close=close, counts=self.before, known=effects)

    @property
    def flips(self) -> bool:
        """Whether forces count in which it matters on which flank gears are in contact, or which
        strand of a chain pulls.
        """
        return self.start.switches and any(item.output.startswith(WITHIN) for item in self.asked)

    @property
    def rubs(self) -> tuple[str, ...]:
        """Outputs asked of that friction in joints changes, so that they are not linear."""
        if not self.machine.rubs:
            return ()
        asked = dict.fromkeys(item.output for item in self.asked)
        known = ((name, declared(name)) for name in asked)
        return tuple(
            name
            for name, declaration in known
            if declaration is not None and declaration[0].by_friction
        )

    @cached_property
    def supports_more(self) -> bool:
        """Whether the support's mass depends on the numbers."""
        return supports_more(self.effects, self.start)

    @property
    def asked(self) -> tuple[Objective, ...]:
        return self.plan.asked

    @property
    def reads_gauges(self) -> bool:
        """Whether the support's vibration counts."""
        return any(item.output.startswith("gauges.") for item in self.asked)

    @cached_property
    def before(self) -> Mapping[str, float]:
        """Value of each objective and limit of the machine as it is."""
        if self.counts is not None:
            return self.counts
        values = self.values_of(self.machine, self.asked)
        return {objective.name: value for objective, value in zip(self.asked, values, strict=True)}

    @staticmethod
    def value_of(machine: Machine, objective: Objective) -> float:
        """Value of an objective for a machine, read off the machine itself."""
        return Problem.values_of(machine, [objective])[0]

    @staticmethod
    def values_of(machine: Machine, objectives: Sequence[Objective]) -> list[float]:
        """Values of several objectives, in their order."""
        effects, point = Effects(machine, ()), LinearizationPoint(machine)
        return [
            max(
                measured(signal.start, objective.measure, signal.sampling)
                for signal in signals_of(effects, objective, point)
            )
            for objective in objectives
        ]

    def cost_of(self, machine: Machine) -> float:
        """What is to become small, for a machine; 1 for each unit of weight before."""
        values = self.values_of(machine, self.plan.objectives)
        pairs = zip(values, self.plan.objectives, strict=True)
        return self.plan.combined([value / self.scale(objective) for value, objective in pairs])

    @property
    def whole(self) -> float:
        """What is to become small, for the machine as it is."""
        return self.plan.combined([1.0] * len(self.plan.objectives))

    def cost_at(self, numbers: list[Array]) -> float:
        """Cost by the numbers of the parts, as the program has it."""
        return self.plan.combined(self._scaled_values_at(numbers, self.plan.objectives))

    def _scaled_values_at(
        self, numbers: list[Array], objectives: Sequence[Objective]
    ) -> list[float]:
        """Values of objectives by the numbers of the parts, over their scales, as the program has
        them.
        """
        x = np.concatenate(numbers)
        each = ((objective.measure, self.signals[objective.name]) for objective in objectives)
        return [max(measured(s.at(x), how, s.sampling) for s in signals) for how, signals in each]

    def friction_change(self, numbers: list[Array], machine: Machine) -> float:
        """By how much objectives and limits of a machine change at most, over their scales, from
        the friction that is taken as known to its own.

        numbers : of the parts, which make the machine.
        """
        asked = [objective for objective in self.asked if objective.output in self.rubs]
        own, known = self.values_of(machine, asked), self._scaled_values_at(numbers, asked)
        changes = [
            abs(value / self.scale(item) - assumed)
            for item, value, assumed in zip(asked, own, known, strict=True)
        ]
        return max(changes, default=0.0)

    def limits_passed_with_friction(self, machine: Machine) -> list[str]:
        """Names of the limits that a machine does not keep, of those that its friction changes."""
        limits = [limit for limit in self.plan.limits if limit.objective.output in self.rubs]
        values = self.values_of(machine, [limit.objective for limit in limits])
        return [
            limit.name
            for limit, value in zip(limits, values, strict=True)
            if value - limit.most(self.before[limit.name]) > KEPT * self.scale(limit.objective)
        ]

    def scale(self, objective: Objective) -> float:
        """Reference value of an objective or limit: its value before, or where that is nothing but
        rounding, the effect of a unit of the numbers.
        """
        before, effect = self.before[objective.name], self._effect(objective)
        return before if before > ROUNDING * effect else effect or 1.0

    @cached_property
    def effects(self) -> Effects:
        rubbing = self.machine if self.rubs else None
        return self.known or Effects(self.start, self.parts, rubbing=rubbing)

    @cached_property
    def signals(self) -> dict[str, list[Signal]]:
        """Signals of each objective and limit, over its scale."""
        return {
            item.name: [signal.divided(self.scale(item)) for signal in self.unscaled[item.name]]
            for item in self.asked
        }

    @cached_property
    def unscaled(self) -> dict[str, list[Signal]]:
        """Signals of each objective and limit, in SI units."""
        unique = {item.name: item for item in self.asked}
        return {
            name: signals_of(self.effects, objective, self.close)
            for name, objective in unique.items()
        }

    def moves(self, objective: Objective) -> bool:
        """Whether an objective is something, and something that is free has an effect on it."""
        return not self._is_nothing(objective) and self._effect(
            objective
        ) >= WITHOUT_EFFECT * self.scale(objective)

    def check_influence(self) -> None:
        """Refuse an objective that is 0 already, or that nothing free can change."""
        turns = self.effects.motion.turns
        for objective in self.asked:
            for order in objective.orders:
                whole = abs(order * turns - round(order * turns)) < NEARLY
                if order > HIGHEST or not whole:
                    raise UsageError(
                        Note(
                            "the {name}: there is no order {order:g}; orders are whole "
                            "numbers{parts} up to {highest}",
                            name=objective.name,
                            order=order,
                            parts=Note(" over {turns}", turns=turns) if turns > 1 else "",
                            highest=HIGHEST,
                        )
                    )
        for objective in self.plan.objectives:
            if self._is_nothing(objective):
                raise UsageError(
                    Note("the {name} is 0 already; choose another objective", name=objective.name)
                )
            if self._effect(objective) < WITHOUT_EFFECT * self.scale(objective):
                raise UsageError(
                    Note(
                        "none of the permitted changes affects the {name}; permit another "
                        "change, or choose another objective",
                        name=objective.name,
                    )
                )
        for limit in self.plan.limits:
            if limit.ratio is not None and self._is_nothing(limit.objective):
                raise UsageError(
                    Note(
                        "the {name} is 0 before, of which there is no share; give the limit in "
                        "a unit",
                        name=limit.name,
                    )
                )

    def _is_nothing(self, objective: Objective) -> bool:
        """Whether a value before is but rounding beside what a unit of any number does."""
        return self.before[objective.name] < ROUNDING * self._effect(objective)

    def _effect(self, objective: Objective) -> float:
        """The largest effect of a unit of any number, SI."""
        signals = self.unscaled[objective.name]
        return max(float(np.max(np.abs(signal.columns), initial=0.0)) for signal in signals)

    @cached_property
    def built(self) -> AssembledProgram:
        """The program of everything that is asked."""
        program, plan = Program(), self.plan
        places = [program.numbers(part.count) for part in self.parts]
        squares = [
            item for part, at in self.with_numbers(places) for item in part.constrain(program, at)
        ]
        self.keep_added_mass(program, places)
        numbers = np.concatenate(places)
        terms = [self._term(program, numbers, objective) for objective in plan.objectives]
        for limit in plan.limits:
            scale, most = self.scale(limit.objective), limit.at_most
            bound = Affine.fixed(limit.ratio if most is None else most / scale)
            for signal in self.signals[limit.name]:
                measure = limit.objective.measure
                bound_measure(program, numbers, signal, measure, bound, limit.name)
        self._cost(program, terms)
        matter = dict(zip(numbers.tolist(), self._matters, strict=True))
        return AssembledProgram(
            program, places, [square for square in squares if matter[square.lift]]
        )

    def keep_added_mass(self, program: Program, places: list[Array]) -> None:
        """Keep the most that may be added in all."""
        masses, units = self.added_masses(places)
        if self.plan.added_mass is not None and len(masses):
            rows = Affine.of(masses, -units, self.plan.added_mass)
            program.nonnegative(rows, ADDED, Affine.fixed(1.0))

    def added_masses(self, places: list[Array]) -> tuple[Array, Array]:
        """Places of the numbers that are added masses, and a unit of each, kg."""
        mass_units = [
            (at[part.mass_place], part.mass_unit)
            for part, at in self.with_numbers(places)
            if part.mass_place is not None
        ]
        masses, units = zip(*mass_units, strict=True) if mass_units else ((), ())
        return np.array(masses, dtype=int), np.array(units)

    def _term(self, program: Program, numbers: Array, objective: Objective) -> int:
        """Place of a number that is at least the objective, over its value before."""
        term = program.numbers(1)
        for signal in self.signals[objective.name]:
            bound_measure(program, numbers, signal, objective.measure, Affine.of(term, 1.0))
        return int(term[0])

    def _cost(self, program: Program, terms: list[int]) -> None:
        own = self.plan.factors
        if self.plan.combine == "sum" or len(terms) == 1:
            program.cost = dict(zip(terms, own, strict=True))
            return
        whole = program.numbers(1)
        factors = np.diag([1.0, *own])
        program.cones(Affine.of([int(whole[0]), *terms], factors), len(factors))
        program.cost = {int(whole[0]): 1.0}

    @cached_property
    def _matters(self) -> Array:
        """Whether each number (K,) changes an objective or a limited output."""
        return self._change(self.asked)

    def _change(self, outputs: Iterable[Objective]) -> Array:
        """Whether each number (K,) changes any of some outputs."""
        signals = [signal for output in outputs for signal in self.signals[output.name]]
        sizes = [np.max(np.abs(signal.columns), axis=1, initial=0.0) for signal in signals]
        return np.asarray(np.max(sizes, axis=0) > WITHOUT_EFFECT)

    @property
    def leaves_masses_open(self) -> bool:
        """Whether there is an added mass that no objective depends on."""
        changed = self._change(self.plan.objectives)
        masses, _ = self.added_masses(self._by_part(np.arange(len(changed))))
        return not np.all(changed[masses])

    def mass_added(self, numbers: list[Array]) -> float:
        """Mass of weights and gears, kg."""
        weights = sum(float(own @ part.effect[:, 0]) for part, own in self.with_numbers(numbers))
        return self.start.mass - self.machine.mass + weights

    def project_feasible(self, numbers: list[Array]) -> list[Array]:
        """Squares made equal; of numbers that do not matter, the least that are possible."""
        each = zip(self.parts, numbers, self._by_part(self._matters), strict=True)
        return [part.project_feasible(own, matters) for part, own, matters in each]

    def minimize_added_mass(self, numbers: list[Array]) -> list[Array]:
        """Numbers that do the same with the least mass of each weight."""
        each = zip(self.parts, numbers, self._by_part(self._matters), strict=True)
        return [part.minimize_added_mass(own, matters) for part, own, matters in each]

    def _by_part(self, whole: Array) -> list[Array]:
        """What stands beside all numbers (K,), split into that of each part."""
        return np.split(whole, np.cumsum([part.count for part in self.parts])[:-1])

    def machine_with(self, numbers: list[Array]) -> Machine:
        """The machine that the parts' numbers make."""
        return with_numbers(self.start, [*self.with_numbers(numbers)])


@dataclass(frozen=True, eq=False)
class AssembledProgram:
    """A program, the places of each part's numbers in it, and the squares that matter."""

    program: Program
    places: list[Array]
    squares: list[Square]


def _name_apart(parts: list[DesignVariables]) -> None:
    """Give weights of one link names of their own."""
    weights = [part for part in parts if isinstance(part, AddedWeight)]
    for part in weights:
        same = [other for other in weights if other.link == part.link]
        if len(same) > 1:
            number = same.index(part) + 1
            part.name = Note("mass on {link} ({number})", link=part.link, number=number)
