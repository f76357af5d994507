"""On 50 random problems a global search finds nothing better than what is called proved.

Of 40 machines with random plans, and of 10 with rows on one shaft.  Differential evolution in the
matrices of `support.balancing_reference`, or over signals in time, looks at ten times as many
machines as the solver had programs, and at 2,000 or more.
"""

from __future__ import annotations

from math import pi

import numpy as np
import pytest
from scipy.optimize import differential_evolution

import equipoise as eq
from equipoise.balancing.phase_search import choose_phases
from equipoise.mechanism.parts.balance import Objective
from equipoise.mechanism.parts.machine import Machine
from laws.test_phases import Dumb
from secondroute.test_balancing import random_case
from support.balancing_reference import Problem, evolved, loads_jump, measured_exactly
from support.chosen import few
from support.machines import make
from support.rows_in_time import side_by_side

BEATEN, SAMPLED = 1e-6, 1e-5
"""Share of the value before by which nothing may be better: what is promised; and of an area where
loads jump, of which the samples of the second route miss up to some 3e-6."""
TIMES, LEAST, SIZE = 10, 2_000, 10
"""Machines looked at for each program that was solved, and at least; those of a generation for
each number that is free."""
EMPTY = {108, 113, 129}
"""Seeds of plans in which nothing that is free changes what is wanted."""
PLANS = [seed for seed in range(100, 143) if seed not in EMPTY]
ROWS = [*range(10)]


def test_there_are_fifty() -> None:
    assert len(PLANS) + len(ROWS) == 50


@pytest.mark.parametrize("case", few(PLANS, PLANS[::10]))
def test_no_change_of_masses_is_better_than_what_is_proved(case: int) -> None:
    machine, plan = random_case(case)
    actual, problem = eq.balance(machine, plan), Problem(machine, plan)
    assert actual.proved
    generation = SIZE * len(problem.bounds)
    turns = -(-max(TIMES * actual.looked_at, LEAST) // generation)
    _, at = evolved(problem, seed=case, turns=turns, size=SIZE, polished=2)
    rebuilt = problem.rebuilt(at)
    shares = [
        np.array(measured_exactly(rebuilt, objective) / measured_exactly(machine, objective))
        for objective in plan.objectives
    ]
    areas = any(objective.measure == "area" for objective in plan.objectives)
    room = (SAMPLED if areas and loads_jump(machine) else BEATEN) * sum(problem.weights)
    assert float(problem.combined(shares)) >= actual.bound - room
    assert float(problem.combined(shares)) >= actual.cost - room


def rows_of(seed: int) -> tuple[Machine, list[Objective]]:
    """A machine with two to four rows in random phases, and what is to become small of it."""
    random = np.random.default_rng(seed)
    machine = make(("crank_rocker", "slider_crank")[seed % 2], seed).machine
    phases = random.uniform(0, 2 * pi, int(random.integers(2, 5))).tolist()
    outputs = ["shaking_force", "shaking_force.y", "shaking_moment", "roll_moment"]
    wishes = {
        str(output): Objective(str(output), str(random.choice(["rms", "peak"])))  # type: ignore[arg-type]
        for output in random.choice(outputs, int(random.integers(1, 3)), replace=False)
    }
    return side_by_side(machine, phases), list(wishes.values())


# On grids: tests/laws/test_phases.py and tests/unit/balancing/test_phase_bound.py.
@pytest.mark.exhaustive
@pytest.mark.parametrize("case", few(ROWS, [5]))
def test_no_phases_are_better_than_what_is_proved(case: int) -> None:
    machine, wishes = rows_of(case)
    actual, dumb = choose_phases(machine, wishes), Dumb(machine, wishes, "sum")
    whole = float(len(wishes))
    other = differential_evolution(
        dumb,
        [(0, 2 * pi)] * (len(machine.rows) - 1),
        popsize=SIZE,
        maxiter=-(-LEAST // (SIZE * (len(machine.rows) - 1))),
        tol=0,
        seed=case,
    )
    assert actual.bound <= actual.combined[1] * (1 + BEATEN)
    assert other.fun >= actual.bound - 3 * BEATEN * whole
    assert other.fun >= actual.combined[1] - 3 * BEATEN * whole
