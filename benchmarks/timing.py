"""Times things in turn, so that a busy machine slows all of them alike, and prints ratios."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from statistics import median


def in_turn(tasks: Mapping[str, Callable[[], object]], rounds: int) -> dict[str, list[float]]:
    """Seconds of each task in each round; a first round is not counted."""
    times: dict[str, list[float]] = {name: [] for name in tasks}
    for number in range(rounds + 1):
        for name, task in tasks.items():
            begin = time.perf_counter()
            task()
            if number:
                times[name].append(time.perf_counter() - begin)
    return times


def report(times: Mapping[str, list[float]], peer: str, unit: float, name_of_unit: str) -> None:
    """Print the median of each task, and of its ratio to the peer round by round."""
    width = max(map(len, times))
    for name, values in times.items():
        ratios = [value / other for value, other in zip(values, times[peer], strict=True)]
        print(
            f"{name:<{width}}  {median(values) / unit:8.3f} {name_of_unit}"
            f"   x {median(ratios):6.2f}  (from {min(ratios):.2f} to {max(ratios):.2f})"
        )
    print(f"x: ratio to {peer!r} in the same round, median")
