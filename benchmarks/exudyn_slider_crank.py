"""Balancing a slider-crank on a sprung frame, beside a genetic algorithm that simulates it.

The peer is the example geneticOptimizationSliderCrank.py of Exudyn (J. Gerstmayr), on the same
machine built anew in `tests/support/exudyn_model.py`.  A torque of 0.1 N m runs the crank up from
rest for 3 s; its residual is the frame's largest displacement along x plus that along y.  It shall
become small by the centres of mass of crank and rod, in `RANGES`.  Exudyn's `GeneticOptimization`
looks for them with the example's settings: 30 generations of 50, each of which is a simulation.

Equipoise does not simulate the run-up.  In the same ranges it makes the frame's steady vibration at
the drive's speed smallest, or the shaking force.  Those are other functions, but all three have one
minimum: they are zero where the common centre of mass of all links stands still, and only there.
Then no motion of the crank shakes the frame; and the steady vibration is zero only if every order
of the force is, because each of them moves a frame on springs.  The ranges hold this point.  In
ranges that do not, the minima differ: with a crank whose centre of mass may go to -50 mm only, the
least residual is 8.97 mm; the steady vibration leads to 9.00 mm, the shaking force to 9.93 mm.

All results are judged by the same simulation, which `tests/crosscheck/test_exudyn.py` compares with
the exact equations of Equipoise.
"""

from __future__ import annotations

import os
import sys
import time
from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import partial
from pathlib import Path
from statistics import median

import numpy as np

import equipoise as eq
from equipoise.mechanism.parts.balance import Balance, Objective
from peers import required
from timing import in_turn

sys.path.insert(0, str(Path(__file__).parents[1] / "tests"))

with required("exudyn"):
    from exudyn.processing import GeneticOptimization

    from support.exudyn_model import MACHINE, Centers, shake

PLANS = {
    "equipoise, steady vibration": MACHINE.balance,
    "equipoise, shaking force": replace(
        MACHINE.balance, objectives=(Objective("shaking_force", "rms"),)
    ),
}
RANGES = {move.link: move.x for move in MACHINE.balance.moves}
"""Of the centres of mass, along each link from its pin on the side of the crank's shaft, m."""
GENETIC = {
    "numberOfGenerations": 30,
    "populationSize": 50,
    "elitistRatio": 0.1,
    "crossoverProbability": 0.1,
    "rangeReductionFactor": 0.5,
    "randomizerInitialization": 0,
}
"""The example's settings; all others are Exudyn's own."""
TINY = 1e-9
"""Of lengths, m: nothing."""
REPEATS = 10
"""Of the balancing, before the genetic algorithm and once more after it."""


def centers_of(machine: eq.Machine) -> Centers:
    """Centres of mass of crank and rod along the links, m; nothing else may have changed."""
    found = {link: machine.links[link].center_of_mass for link in RANGES}
    for link, (x, y) in found.items():
        low, high = RANGES[link]
        now, before = machine.links[link], MACHINE.links[link]
        same = np.allclose((now.mass, now.inertia), (before.mass, before.inertia), 1e-9, 0)
        if abs(y) > TINY or not low - TINY <= x <= high + TINY or not same:
            raise SystemExit(f"{link} has left its range: {now}")
    return found["crank"][0], found["rod"][0]


def balanced(plan: Balance) -> eq.Machine:
    """The optimum by Equipoise, from a machine of which nothing is known yet."""
    return eq.balance(replace(MACHINE, balance=plan)).machine


def residual(parameters: Mapping[str, float]) -> float:
    """What the genetic algorithm makes small, m."""
    return shake((parameters["crank"], parameters["rod"])).residual


def usable_cores() -> int:
    """Cores that this process may use, where the system tells."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def evolved(cores: int) -> Centers:
    """The optimum by Exudyn's genetic algorithm, with one process a core."""
    best, *_ = GeneticOptimization(
        objectiveFunction=residual,
        parameters=RANGES,
        useMultiProcessing=True,
        numberOfThreads=cores,
        showProgress=False,
        **GENETIC,
    )
    return best["crank"], best["rod"]


def seconds(task: Callable[[], object]) -> tuple[float, object]:
    """How long a task takes, and what it returns."""
    begin = time.perf_counter()
    found = task()
    return time.perf_counter() - begin, found


def print_line(name: str, centers: Centers, elapsed: str = "") -> None:
    """Print a result and what the simulation says of it."""
    places = f"{1e3 * centers[0]:10.4f}  {1e3 * centers[1]:10.4f}"
    print(f"{name:<28} {places}  {1e3 * shake(centers).residual:11.4g}  {elapsed}")


def print_searches() -> None:
    """Run all searches and print what they have found, in which time."""
    tasks = {name: partial(balanced, plan) for name, plan in PLANS.items()}
    first = {name: seconds(task) for name, task in tasks.items()}
    before = in_turn(tasks, REPEATS)
    cores = usable_cores()
    theirs, centers = seconds(lambda: evolved(cores))
    after = in_turn(tasks, REPEATS)
    print(f"{'':<28} {'crank mm':>10}  {'rod mm':>10}  {'residual mm':>11}")
    print_line("as it is", centers_of(MACHINE))
    print_line("Exudyn, genetic algorithm", centers, f"{theirs:.1f} s, {cores} processes")
    for name, (begin, machine) in first.items():
        ours = median(before[name] + after[name])
        told = (
            f"{1e3 * ours:.1f} ms (at first {1e3 * begin:.0f}), {theirs / ours:,.0f} times as fast"
        )
        print_line(name, centers_of(machine), told)


if __name__ == "__main__":
    print_searches()
