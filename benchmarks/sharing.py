"""Designs shared out among two processes, beside one: the time that passes, and processor time.

On a computer that does nothing else, the time that passes says it: two processes and one take
turns, and the shortest of each count.  On one that does, the processor time of the busier of this
process and of the other, starting it included, is what two free processors would take if neither
waited for the other; how much they wait is left out of it.

    python sharing.py [TASK ...]     such as "search of tool"; all tasks without
"""

from __future__ import annotations

import one_thread  # noqa: F401  has to come before NumPy

# isort: split
import os
import sys
import time
from collections.abc import Callable
from functools import partial
from resource import RUSAGE_CHILDREN, RUSAGE_SELF, getrusage
from typing import Any

import numpy as np

import equipoise as eq
from asked import Limit, Table
from equipoise.planting.search import Designs, PlantingProblem
from equipoise.schema.template import Template
from equipoise.studies.evaluate import evaluator
from equipoise.studies.objective_map import landscape
from equipoise.studies.searching import search
from equipoise.studies.study import samples
from equipoise.studies.tolerances import machines_of, tolerance

SECONDS = float(os.environ.get("SECONDS_ALONE", "25"))
"""Of one processor that each task takes; a search may end earlier, where it stands still."""
ROUNDS = int(os.environ.get("ROUNDS", "2"))
LEAST_DESIGNS = 160
"""Of a tolerance, below which nothing can be said of its causes."""
ASKED = Limit(1.7, at_most=False)
STUDIES = {
    "respond": ("yamashita-rig", "links.crank.mass", "gauges.gauge.rms"),
    "balance": ("balance-crank", "links.coupler.mass", "bound"),
    "tool": ("brush-cutter", "shaft.stations[3].position", "a8"),
}
Task = Callable[[int], object]


def study(command: str, spread: str, designs: int) -> eq.studies.Study:
    """Some designs about a bundled model, with one number of a command's result."""
    name, path, value = STUDIES[command]
    model = Template.load(name)
    own = model.number(path)[0]
    is_search = spread == "search"
    of: Any = (
        eq.design.Range(0.9 * own, 1.1 * own) if is_search else eq.design.Uniform(own, 0.01 * own)
    )
    make: Any = "smallest" if is_search else None
    return eq.studies.Study(
        title="",
        model=model,
        vary=(eq.design.Variable(path, of),),
        outputs=(eq.studies.Output(value, of=command, make=make),),  # type: ignore[arg-type]
        sampling=eq.studies.Sampling("sobol", designs),
    )


def searched(command: str) -> Task:
    some = study(command, "search", count_of(command, "search"))
    return lambda workers: search(some, workers=workers).to_dict()


def tolerated(command: str) -> Task:
    count = count_of(command, "tolerance")
    share = machines_of(study(command, "tolerance", count)) / count
    some = study(command, "tolerance", max(LEAST_DESIGNS, round(count / share)))
    return lambda workers: tolerance(some, workers=workers).to_dict()


def count_of(command: str, spread: str) -> int:
    """Designs that take so long; what the first of them imports and keeps is there afterwards."""
    few = study(command, spread, 8)
    evaluate = evaluator(few)
    evaluate(samples(few, 0, 8))
    begin = time.process_time()
    evaluate(samples(few, 0, 8))
    return max(200, round(8 * SECONDS / (time.process_time() - begin)))


def mapped() -> Task:
    model, of = Template.load("yamashita-1"), eq.balancing.Objective("shaking_force")
    names = ("links.crank.points.B.x", "links.coupler.points.C.x")
    side = round((SECONDS / 1.5e-3) ** 0.5)

    def task(workers: int) -> object:
        own = [model.number(name)[0] for name in names]
        over = {
            name: np.linspace(0.97 * one, 1.03 * one, side)
            for name, one in zip(names, own, strict=True)
        }
        return landscape(model, over, of, workers=workers).values

    return task


def fitted() -> Task:
    """Generations of 120 designs of a planting finger, as its search judges them."""
    designs = Designs(eq.load("kim-chung-a"))
    goal = eq.design.Requirement("curve.height", target=0.25)
    low, high = designs.bounds
    shares = np.random.default_rng(1).random((120, len(low))) - 0.5
    values = np.clip(designs.start + 0.1 * shares * (high - low), low, high)

    alone = PlantingProblem(designs, [goal])
    alone.judge(values)
    begin = time.process_time()
    alone.judge(values)
    count = round(SECONDS / (time.process_time() - begin))

    def task(workers: int) -> object:
        with PlantingProblem(designs, [goal], workers) as problem:
            return [problem.judge(values).off for _ in range(count)]

    return task


def spent(task: Task, workers: int) -> tuple[object, list[float]]:
    """What comes of a task; time that passes, processor time of this process and of those that it
    started, s.
    """
    before = _clocks()
    result = task(workers)
    return result, [new - old for new, old in zip(_clocks(), before, strict=True)]


def _clocks() -> list[float]:
    used = (getrusage(who) for who in (RUSAGE_SELF, RUSAGE_CHILDREN))
    return [time.monotonic(), *(item.ru_utime + item.ru_stime for item in used)]


def main() -> None:
    """Print what was measured; names of tasks may be given."""
    tasks: dict[str, Callable[[], Task]] = {
        **{f"search of {name}": partial(searched, name) for name in STUDIES},
        **{f"tolerance of {name}": partial(tolerated, name) for name in STUDIES},
        "map of lengths": mapped,
        "planting fingers": fitted,
    }
    table = Table()
    for name in sys.argv[1:] or tasks:
        task = tasks[name]()
        rounds = []
        for _ in range(ROUNDS):
            (one, alone), (two, shared) = spent(task, 1), spent(task, 2)
            if repr(one) != repr(two):
                raise SystemExit(f"{name}: two processes give other figures than one")
            rounds.append((alone, shared))
            print(name, *(" ".join(f"{t:.2f}" for t in item) for item in (alone, shared)), sep="; ")
        walls = [min(item[k][0] for item in rounds) for k in (0, 1)]
        table.value(f"{name}: times as fast", [walls[0] / walls[1]], "", ASKED)
        busier = [alone[1] / max(shared[1:]) for alone, shared in rounds]
        table.value(f"{name}: times less processor time of the busier", busier, "")
    table.print()


if __name__ == "__main__":
    import sharing  # so that other processes find what they run

    sharing.main()
