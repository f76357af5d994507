"""Phases of rows and masses of links at once.

For given phases the best masses are those of a cone program, and for given masses the best phases
are searched: one after the other from several beginnings, until neither gains any more.  Branch and
bound over boxes of phases and of those numbers of the masses that matter (`box_bounds`) then gives
a bound on any improvement, and begins anew where it meets a better solution.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property
from math import inf, pi

import numpy as np

from equipoise.balancing.balanced import proved_of
from equipoise.balancing.box_bounds import Numbers, PhaseProof, prove
from equipoise.balancing.branch_and_bound import finite
from equipoise.balancing.cylinder_phasing import (
    Cost,
    PhaseObjective,
    RowSignals,
    jumping_designs,
    of_each_row,
)
from equipoise.balancing.effects import Effects
from equipoise.balancing.jumping_rows import JumpingDesigns
from equipoise.balancing.objectives import LinearizationPoint
from equipoise.balancing.phase_grid import distinct
from equipoise.balancing.phase_polish import AfterStep, most_steps, polished
from equipoise.balancing.phase_search import PhaseSearch, Phasing, phasing_of, stepped, with_phases
from equipoise.balancing.problem import WITHOUT_EFFECT, Problem
from equipoise.balancing.program import NoSolutionError, Program
from equipoise.balancing.solution import ROUNDS as FRICTION_ROUNDS
from equipoise.balancing.solution import SAME_FRICTION, Solution, solve_problem
from equipoise.dataclass import dataclass
from equipoise.errors import UsageError
from equipoise.i18n import Note
from equipoise.mechanism.parts.balance import WITHIN, Objective
from equipoise.mechanism.parts.machine import Machine
from equipoise.results.result import ProgressCallback
from equipoise.signals import Array

BESIDE = 0.1
"""rad: phases so close lead to the same masses, so that one of them is a beginning."""
CLOSE = 1e-3
"""Between cost and bound, over the cost before, at which the search ends."""
BEGINNINGS, FEW, GUESSES, FIRST_ROUNDS, ROUNDS, TRIES = 6, 3, 24, 3, 12, 12
"""Phases from which masses and phases are balanced in turn; where that takes long; at random, where
limits can be kept from none of these; turns of each, and of the best; how often they are again,
where a box looks better."""
GAIN, NO_GAIN, ROUNDING, WITHIN_LIMIT = 1e-4, 1e-8, 1e-9, 1e-6
"""Share of the cost before by which a turn must gain, and one of the best; of what a program's
bound may miss; of a limit, by which it counts as kept."""


@dataclass(frozen=True, eq=False)
class PhaseMassSolution:
    """cost, with phases (m,) relative to row 1, rad, and with the masses of a solution."""

    cost: float
    phases: Array
    solution: Solution


@dataclass(frozen=True, eq=False)
class EachRow:
    """What objectives and limits read of each row, with the friction that a problem takes as known.

    problem : of masses.  measured : objectives, and limits of what phases change.
    """

    problem: Problem
    measured: list[Objective]

    @cached_property
    def jumping(self) -> list[JumpingDesigns | None]:
        """Of each: the rows as functions of the crank angle, where forces jump."""
        return [jumping_designs(self.problem.effects, item) for item in self.measured]

    @cached_property
    def amplitudes(self) -> list[Array]:
        """Signals of each row where the support carries the same with any mass."""
        problem = self.problem
        return [of_each_row(problem.effects, item, problem.close) for item in self.measured]


class JointPhaseMassOptimizer:
    """Masses and phases of one problem.

    problem : of masses, with the rows as they are.  search : of phases, for the same machine.
    """

    def __init__(self, problem: Problem, search: PhaseSearch) -> None:
        self.problem, self.search = _counting_alike(problem, search), search
        self.each_row = EachRow(self.problem, self._measured)
        self.best: PhaseMassSolution | None = None
        self.tries, self.turns = TRIES, problem.effects.motion.turns
        self.after: AfterStep = lambda: None
        self.period = 2 * pi * self.turns

    def run(
        self, first: Solution | None, progress: ProgressCallback
    ) -> tuple[Solution | None, Phasing]:
        """The best masses, in a machine with the best phases, and these with what is proved.

        No masses where phases alone are as good.

        first : the best masses with the rows as they are; None where there are none.

        Raises
        ------
        UsageError : with none of the phases that are tried the masses can keep the limits.
        """
        alone = pool = self.search.pool(progress)
        if first is not None:
            after = replace(self.search, machine=first.machine)
            new_pool = after.pool(progress)
            best = new_pool[np.argmin(after.cost.values(new_pool))]
            self._offer(best, replace(first, problem=self.problem))
            pool = np.vstack([best, new_pool[:1], pool, new_pool])
        order = np.argsort(self.search.cost.values(pool[2:]), kind="stable") + 2
        pool = np.vstack([pool[:2], pool[order]])
        count = FEW if self._bent else BEGINNINGS
        most = (count * FIRST_ROUNDS + ROUNDS) * most_steps(self.search.cost)
        self.after = stepped(progress, 0, most, most)
        error = self._from_any(distinct(pool, self.period, [BESIDE], count), first)
        if self.best is None:  # limits that few phases keep
            shape = (GUESSES, len(pool[0]))
            self._from_any(np.random.default_rng(1).uniform(0.0, self.period, shape), first)
        if self.best is None:
            raise error or UsageError(
                Note("no phases were found with which masses keep the limits")
            )
        self._in_turn(self.best.phases, self.best.solution, ROUNDS, NO_GAIN)
        self._settle_friction()
        proof, cost = self._proof(progress), self.search.cost
        needed = len(self._measured) < len(self.problem.asked)  # for limits in joints
        if needed or np.min(cost.values(alone)) > self.best.cost + NO_GAIN * cost.whole:
            return self._laid_out(proof)
        return None, phasing_of(self.search, self.search.best(alone), proof)

    @property
    def scope(self) -> tuple[Note, ...]:
        """Of what the proof holds, where that is not all that is allowed."""
        assert self.best is not None
        gears = (Note("for the gears taken"),) if self.problem.plan.geared else ()
        return (*proved_of(self.best.solution), *gears)

    def _from_any(self, beginnings: Array, solution: Solution | None) -> UsageError | None:
        """Masses and phases in turn, from each beginning; the last error, if there was one."""
        error: UsageError | None = None
        for phases in beginnings:
            try:
                self._in_turn(phases - phases[0], solution)
            except UsageError as refused:
                error = refused
        return error

    def _proof(self, progress: ProgressCallback) -> PhaseProof:
        assert self.best is not None
        known = self.best
        try:
            numbers = self._numbers
        except NoSolutionError:
            return PhaseProof(known.phases, 0.0, 0, False)
        start = self._cost(known.solution, 0.0)
        paid, scales = known.solution.best.prices, map(self.problem.scale, self._measured)
        most = zip(self._measured, scales, self._scales, strict=True)
        prices = tuple(max(paid.get(item.name, 0.0), 0.0) * at / scale for item, scale, at in most)
        count = len(start.terms)
        prices = prices[count:]
        phase_proof = prove(
            start, known.phases, self._improved, numbers, known.cost, CLOSE, prices, progress
        )
        if phase_proof.complete or not start.limits:
            return phase_proof
        # Without limits more rows may be alike, which leaves fewer boxes.
        free, numbers = replace(start, limits=()), numbers.of_terms(count)
        best = self.best.cost
        other = prove(free, phase_proof.phases, _no_better, numbers, best, CLOSE, progress=progress)
        return other if other.bound > phase_proof.bound else phase_proof

    def _laid_out(self, proof: PhaseProof) -> tuple[Solution, Phasing]:
        """The best, with equal rows swapped against twist."""
        assert self.best is not None
        solution = self.best.solution
        rows = self.problem.machine.rows
        machine = solution.machine.with_rows(rows)
        # what counts is as before all changes
        after = replace(self.search, machine=machine, known_cost=self._cost(solution))
        best = after.best(np.vstack([after.present, self.best.phases]))
        phasing = phasing_of(after, best, proof)
        # with the friction that the proof takes as known
        return replace(solution, problem=self._turned(best), machine=phasing.machine), phasing

    def _settle_friction(self) -> None:
        """Take the friction of the best as known, and look for better masses and phases with it,
        until it is that of the best.
        """
        assert self.best is not None
        for _ in range(FRICTION_ROUNDS if self.problem.rubs else 0):
            numbers = self.best.solution.numbers
            machine = self.problem.machine_with(numbers)
            if self.problem.friction_change(numbers, machine) <= SAME_FRICTION:
                break
            self.problem = self.problem.linearized_at(numbers)
            self.each_row = EachRow(self.problem, self._measured)
            known, cost = self.best, replace(self._cost(self.best.solution), limits=())
            self.best = replace(known, cost=float(cost.values(known.phases)))
            self._in_turn(known.phases, known.solution, ROUNDS, NO_GAIN)

    def _improved(self, phases: Array, cost: float) -> tuple[Array, float]:
        """Masses and phases in turn, begun where a box looks better."""
        assert self.best is not None
        if self.tries and cost < self.best.cost - CLOSE / 2 * self.problem.whole:
            self.tries -= 1
            before = self.best
            self._from_any(phases[None], self.best.solution)
            if self.best is not before:
                return self.best.phases, self.best.cost
        return phases, inf

    def _in_turn(
        self,
        phases: Array,
        solution: Solution | None,
        rounds: int = FIRST_ROUNDS,
        gain: float = GAIN,
    ) -> None:
        """Masses for phases, phases for masses, and so on.

        solution : the masses where phases are such that no masses have an effect.
        """
        last = inf
        for _ in range(rounds):
            try:
                solution = solve_problem(self._turned(phases))
            except UsageError:
                if solution is None:
                    raise
            cost = self._offer(phases, solution)
            if not cost < last - gain * self.problem.whole:
                break
            last = cost
            phases = polished(self._cost(solution), phases, self.search.step, self.after)
            phases = phases - phases[0]

    def _turned(self, phases: Array) -> Problem:
        """The problem with rows in phases (m,) relative to row 1; what was before stays, and
        friction that is taken as known.
        """
        problem, rubbing = self.problem, self.problem.effects.rubbing
        start, like = (
            with_phases(item, phases, self.period) for item in (problem.start, problem.machine)
        )
        return replace(
            problem,
            start=start,
            close=LinearizationPoint(like),
            counts=problem.before,
            known=None if rubbing is None else Effects(start, problem.parts, rubbing=rubbing),
        )

    def _offer(self, phases: Array, solution: Solution) -> float:
        """Cost of masses with phases, infinite where a limit is passed; kept if it is the best."""
        cost = self._cost(solution)
        value = float(cost.values(phases))
        if self.best is None or value < self.best.cost:
            if any(term.value_at(phases) > term.scale * (1 + WITHIN_LIMIT) for term in cost.limits):
                return inf
            # by how little a limit may be passed counts for the search, not for the proof
            value = float(replace(cost, limits=()).values(phases))
        if self.best is None or value < self.best.cost:
            self.best = PhaseMassSolution(value, phases % self.period, solution)
        return value

    # -- as functions of phases and numbers --------------------------------------------------------

    @cached_property
    def _measured(self) -> list[Objective]:
        """Objectives, and limits of what phases change."""
        limits = [limit.objective for limit in self.problem.plan.limits]
        return [
            *self.problem.plan.objectives,
            *(o for o in limits if not o.output.startswith(WITHIN)),
        ]

    def _amplitudes(self, machine: Machine) -> list[Array]:
        """Of each: of rows in phase 0 as they are, and by each number, (1 + K, V, m, C, N).

        near : whose mass the support has to carry.
        """
        if not self._bent:
            return self.each_row.amplitudes
        return [
            of_each_row(self.problem.effects, item, LinearizationPoint(machine))
            for item in self._measured
        ]

    @property
    def _bent(self) -> bool:
        """Whether the support has to carry more with other masses."""
        return self.problem.reads_gauges and self.problem.supports_more

    @cached_property
    def _scales(self) -> list[float]:
        """Value of each objective that counts as one, and each limit."""
        problem = self.problem
        most = [
            limit.most(problem.before[limit.name])
            for limit in problem.plan.limits
            if limit.objective in self._measured[len(problem.plan.objectives) :]
        ]
        return [*map(problem.scale, problem.plan.objectives), *most]

    def _cost(self, solution: Solution, share: float = 1.0) -> Cost:
        """The cost as a function of phases, for a share of the numbers of a solution."""
        terms, numbers = [], share * np.concatenate(solution.numbers)
        columns = self._amplitudes(solution.machine)
        each_term = zip(self._measured, self._scales, columns, self.each_row.jumping, strict=True)
        for item, scale, each, designs in each_term:
            whole = each[0] + np.tensordot(numbers, each[1:], 1)
            jumping = None if designs is None else designs.at(numbers)
            terms.append(PhaseObjective(item, RowSignals(whole, self.turns, jumping), scale))
        count = len(self.problem.plan.objectives)
        return Cost(tuple(terms[:count]), self.problem.plan.combine, tuple(terms[count:]))

    @property
    def _numbers(self) -> Numbers:
        """The numbers that matter, and how far they can go.

        Raises
        ------
        NoSolutionError : there is no end to one of them, or none that is allowed.
        """
        assert self.best is not None
        amplitudes = self._amplitudes(self.best.solution.machine)
        sizes = [
            np.max(np.abs(each[1:]), axis=(1, 2, 3, 4), initial=0.0) / scale
            for each, scale in zip(amplitudes, self._scales, strict=True)
        ]
        used = np.flatnonzero(np.max(sizes, axis=0) > WITHOUT_EFFECT)
        program = Program()
        places = [program.numbers(part.count) for part in self.problem.parts]
        for part, at in self.problem.with_numbers(places):
            for square in part.constrain(program, at):
                square.keep_between(program, *finite(square))
        self.problem.keep_added_mass(program, places)
        wanted = np.concatenate(places)[used].tolist()

        def least(direction: Array) -> float:
            asked = program.copy()
            asked.cost = dict(zip(wanted, direction.tolist(), strict=True))
            result = asked.solve()
            program.add_cuts(result.cuts)
            return result.bound - ROUNDING * (1 + abs(result.bound))

        ends = np.eye(len(used))
        low, high = np.array([least(e) for e in ends]), -np.array([least(-e) for e in ends])
        start = np.clip(np.concatenate(self.best.solution.numbers)[used], low, high)
        columns = tuple(each[1:][used] for each in amplitudes)
        jumping = tuple(each and each.of_numbers(used.tolist()) for each in self.each_row.jumping)
        return Numbers(columns, low, high, start, least, jumping)


def _no_better(phases: Array, _: float) -> tuple[Array, float]:
    """That nothing better is looked for."""
    return phases, inf


def _counting_alike(problem: Problem, search: PhaseSearch) -> Problem:
    """The problem, with every value before as it counts where phases are searched."""
    terms = {term.objective.name: term.scale for term in search.cost.terms}
    limits = {limit.objective.name: limit.value_at(search.present) for limit in search.cost.limits}
    return replace(problem, counts={**problem.before, **limits, **terms})
