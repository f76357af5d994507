"""Designs shared out among two processes, beside one: what both cost in processor time.

What two free processors would take follows from that: the time of the busier of this process and of
the other, starting it included, which end at about the same time.  So the ratio does not depend on
what else the computer does, as long as both get the same share of it.
"""

from __future__ import annotations

import one_thread  # noqa: F401  has to come before NumPy

# isort: split
import sys
import time
from collections.abc import Callable
from resource import RUSAGE_CHILDREN, RUSAGE_SELF, getrusage

import numpy as np

import equipoise as eq
from asked import Limit, Table
from equipoise.planting.search import Designs, PlantingProblem
from equipoise.schema.template import Template
from equipoise.studies.evaluate import evaluator, pooled
from equipoise.studies.objective_map import landscape
from equipoise.studies.study import samples

SECONDS = 25.0
"""Of one processor that each task takes."""
ASKED = Limit(1.7, at_most=False)
STUDIES = {
    "respond": ("yamashita-rig", "links.crank.mass", "gauges.gauge.rms"),
    "balance": ("balance-crank", "links.coupler.mass", "bound"),
    "tool": ("brush-cutter", "shaft.stations[3].position", "a8"),
}
Task = Callable[[int], object]


def study(command: str, designs: int) -> eq.studies.Study:
    """Some designs about a bundled model, with one number of a command's result."""
    name, path, value = STUDIES[command]
    model = Template.load(name)
    own = model.number(path)[0]
    return eq.studies.Study(
        title="",
        model=model,
        vary=(eq.design.Variable(path, eq.design.Range(0.9 * own, 1.1 * own)),),
        outputs=(eq.studies.Output(value, of=command),),  # type: ignore[arg-type]
        sampling=eq.studies.Sampling("sobol", designs),
    )


def studied(command: str) -> Task:
    """As searches and tolerances compute designs of a study."""
    alone = study(command, 8)
    evaluate = evaluator(alone)
    evaluate(samples(alone, 0, 8))  # what is read and kept on the first call
    begin = time.process_time()
    evaluate(samples(alone, 0, 8))
    count = max(16, round(8 * SECONDS / (time.process_time() - begin)))
    some = study(command, count)

    def task(workers: int) -> object:
        with pooled(some, workers) as evaluate:
            return evaluate(samples(some, 0, count)).figures

    return task


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


def spent(task: Task, workers: int) -> tuple[object, float, float]:
    """What comes of a task; processor time of this process and of those that it started, s."""
    before = [getrusage(who) for who in (RUSAGE_SELF, RUSAGE_CHILDREN)]
    result = task(workers)
    after = [getrusage(who) for who in (RUSAGE_SELF, RUSAGE_CHILDREN)]
    here, there = (
        new.ru_utime + new.ru_stime - old.ru_utime - old.ru_stime
        for new, old in zip(after, before, strict=True)
    )
    return result, here, there


def main() -> None:
    """Print what was measured; names of tasks may be given."""
    tasks: dict[str, Callable[[], Task]] = {
        **{f"of {name}": (lambda name=name: studied(name)) for name in STUDIES},
        "map of lengths": mapped,
        "planting fingers": fitted,
    }
    table = Table()
    for name in sys.argv[1:] or tasks:
        task = tasks[name]()
        one, alone, _ = spent(task, 1)
        two, here, there = spent(task, 2)
        if not np.array_equal(np.asarray(one), np.asarray(two), equal_nan=True):
            raise SystemExit(f"{name}: two processes give other figures than one")
        print(f"{name}: {alone:.1f} s in one; {here:.1f} s here and {there:.1f} s in another")
        table.value(f"{name}: how many times as fast", [alone / max(here, there)], "", ASKED)
    table.print()


if __name__ == "__main__":
    import sharing  # so that other processes find what they run

    sharing.main()
