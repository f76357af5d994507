"""Processes that compute designs: those of the package beside joblib's loky.

Start-up is the time to the first answer of two processes that have imported NumPy; throughput is
that of tasks of a tenth of a second; and what is left is how many processes there are when the work
is over.
"""

from __future__ import annotations

import one_thread  # noqa: F401  has to come before NumPy

# isort: split
import os
import time
from collections.abc import Callable
from contextlib import closing
from statistics import median

import psutil
from joblib.externals.loky import get_reusable_executor

from equipoise.design.evaluator import ChunkTask, Processes, computed

TASKS, LENGTH = 40, 0.1


def busy(_: bytes, seconds: float) -> float:
    """Use the processor for so long."""
    import numpy as np

    end = time.process_time() + seconds
    total = 0.0
    while time.process_time() < end:
        total += float(np.sum(np.ones(1000)))
    return total


def own(lengths: list[float]) -> None:
    with closing(Processes(ChunkTask(busy, b""), 2)) as pool:
        list(computed(pool, lengths))


def loky(lengths: list[float]) -> None:
    executor = get_reusable_executor(max_workers=2, timeout=300)
    list(executor.map(busy, [b""] * len(lengths), lengths))


def main() -> None:
    """Print what was measured."""
    print(f"load before: {os.getloadavg()}")
    ways: dict[str, Callable[[list[float]], None]] = {"own": own, "loky": loky}
    starts: dict[str, list[float]] = {name: [] for name in ways}
    works: dict[str, list[float]] = {name: [] for name in ways}
    for _ in range(3):
        for name, way in ways.items():
            for lengths, times in (([0.0], starts), ([LENGTH] * TASKS, works)):
                begin = time.perf_counter()
                way(lengths)
                times[name].append(time.perf_counter() - begin)
                if name == "loky" and lengths != [0.0]:
                    left = psutil.Process().children(recursive=True)
                    memory = sum(one.memory_info().rss for one in left) / 2**20
                    print(f"after {name}: {len(left)} processes left, {memory:.0f} MiB")
                    get_reusable_executor().shutdown(kill_workers=True)
    for name in ways:
        print(
            f"{name}: start least {min(starts[name]):.2f} s, median {median(starts[name]):.2f} s; "
            f"{TASKS} tasks of {LENGTH * 1e3:g} ms least {min(works[name]):.2f} s, median "
            f"{median(works[name]):.2f} s"
        )


if __name__ == "__main__":
    import pools  # so that other processes find what they run

    pools.main()
