"""Balancing, beside the ways in which it is done elsewhere, in one process.

Peers: differential evolution over whole evaluations of the machine, which is what the genetic
optimisers of multibody packages do; and CVXPY with the same solver, which writes the same program
down again before it solves it.  Times of the closed form and of the constrained peak are those of
the whole: signals, program and solution, once the geometry is solved (it is kept with the machine).
"""

from __future__ import annotations

import numpy as np
from scipy.optimize import differential_evolution

import equipoise as eq
from equipoise.balancing.objectives import measured
from equipoise.balancing.problem import Problem
from equipoise.balancing.solution import closed_form
from peers import optional
from timing import in_turn, report

cvxpy = optional("cvxpy", "cvxpy")

MACHINE = eq.load("yamashita-1")
EQUAL_MASS = eq.balancing.Balance(
    masses=(eq.balancing.AddedMass("crank", "A", eq.balancing.Weight("point", mass=1.145)),),
    objectives=(eq.balancing.Objective("shaking_force.y"),),
)
SIX_BAR = eq.load("watt-six-bar")
FORCE = eq.balancing.Objective("shaking_force", "peak")


def thirty() -> eq.balancing.Balance:
    """A plan of 30 numbers: a weight of any spread and a ring on each of five links."""
    places = [(link, next(iter(body.points))) for link, body in SIX_BAR.links.items()]
    spread = eq.balancing.Weight("any", radius=0.05, at_most=1.0)
    ring = eq.balancing.Weight(
        "ring", radius=0.05, inner_radius=0.02, thickness=0.01, density=7850.0
    )
    masses = [
        eq.balancing.AddedMass(*place, weight) for place in places for weight in (spread, ring)
    ]
    joint = eq.balancing.Objective("joints.B", "peak")
    return eq.balancing.Balance(
        masses=tuple(masses),
        objectives=(FORCE,),
        limits=(eq.balancing.Limit(joint, ratio=1.1),),
        added_mass=2.0,
    )


THIRTY = thirty()


def closed() -> object:
    """The counterweight of section 5-3 of Yamashita, Ichikawa and Mori."""
    return closed_form(Problem.of(MACHINE, EQUAL_MASS))


def evolved() -> object:
    """The same by differential evolution over moments of the counterweight."""

    def cost(place: np.ndarray) -> float:
        added = eq.balancing.Balance(masses=EQUAL_MASS.masses, objectives=EQUAL_MASS.objectives)
        problem = Problem.of(MACHINE, added)
        x, y = place
        numbers = [np.array([1.0, x, y, x * x, y * y])]
        machine = problem.machine_with(numbers)
        force = eq.forces(eq.move(machine, 720)).shaking_force
        return measured(force.y, "rms")

    return differential_evolution(cost, [(-2, 2), (-2, 2)], seed=1, tol=1e-6, polish=False)


def peak() -> object:
    """The constrained peak of the six-bar, with everything that is told of it but the figures."""
    return eq.balance(SIX_BAR, THIRTY)


def peak_by_cvxpy() -> float:
    """The force's peak over the same spread weights, written down for CVXPY; without the rings."""
    problem = Problem.of(SIX_BAR, THIRTY)
    signal = problem.effects.signal("shaking_force")
    numbers = [cvxpy.Variable(part.count) for part in problem.parts]
    pairs = [*zip(problem.parts, numbers, strict=True)]
    force = signal.columns.T @ cvxpy.hstack(numbers) + signal.start
    rules = [cvxpy.sum([p.mass_unit * x[0] for p, x in pairs]) <= 2.0]
    for part, x in pairs:
        rules.append(x[0] >= 0)
        if part.count == 4:
            spread = cvxpy.quad_over_lin(x[1:3], x[0])
            rules += [spread <= x[3], x[3] <= x[0], part.mass_unit * x[0] <= 1.0]
        else:
            rules += [cvxpy.square(x[0]) <= x[1], x[0] <= 1.0]
    asked = cvxpy.Problem(cvxpy.Minimize(cvxpy.max(cvxpy.abs(force))), rules)
    return float(asked.solve(solver="CLARABEL"))


def main() -> None:
    """Print the comparisons."""
    count = sum(part.count for part in Problem.of(SIX_BAR, THIRTY).parts)
    print("a counterweight of given mass: least RMS, closed form")
    report(in_turn({"differential evolution": evolved, "closed form": closed}, 3),
           "differential evolution", 1e-3, "ms")  # fmt: skip
    print(f"\nleast peak of the shaking force: {count} numbers, 720 angles, limits")
    tasks = {} if cvxpy is None else {"CVXPY, fewer limits": peak_by_cvxpy}
    tasks["balance"] = peak
    report(in_turn(tasks, 10), next(iter(tasks)), 1e-3, "ms")


if __name__ == "__main__":
    main()
