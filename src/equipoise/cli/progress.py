"""Progress of a search on standard error: a bar in a terminal, a few lines in a log."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from time import monotonic

Told = Callable[[int, int, float], None]
LINES = 10
"""Lines in a log."""
SECONDS = 5.0
"""Between lines in a log about work that is quick as a rule."""


@contextmanager
def told() -> Iterator[Told]:
    """Yield what a search calls with its generation, the most there can be, and the best cost."""
    if sys.stderr is None or not sys.stderr.isatty():
        yield _line
        return
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TextColumn, TimeRemainingColumn

    columns = (
        TextColumn("generation {task.completed:.0f} of at most {task.total:.0f}"),
        BarColumn(),
        TextColumn("cost {task.fields[cost]:.4g}"),
        TimeRemainingColumn(),
    )
    with Progress(*columns, console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task("", total=None, cost=float("nan"))

        def show(generation: int, most: int, cost: float) -> None:
            bar.update(task, completed=generation, total=max(most, generation), cost=cost)

        yield show


@contextmanager
def counted(what: str) -> Iterator[Callable[[int, int], None]]:
    """Yield what long work calls with how many of its parts are done, and how many there are."""
    if sys.stderr is None or not sys.stderr.isatty():
        yield _counter(what)
        return
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn

    columns = (TextColumn(what), BarColumn(), MofNCompleteColumn())
    with Progress(*columns, console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task("", total=None)
        yield lambda done, total: bar.update(task, completed=done, total=total)


def _counter(what: str) -> Callable[[int, int], None]:
    """Lines in a log, but only where there is time to read them."""
    last = monotonic()

    def count(done: int, total: int) -> None:
        nonlocal last
        if monotonic() - last > SECONDS:
            last = monotonic()
            with suppress(OSError):
                print(f"{what} {done} of {total}", file=sys.stderr)

    return count


def _line(generation: int, most: int, cost: float) -> None:
    if generation == 1 or generation % max(1, most // LINES) == 0:
        with suppress(OSError):  # who does not want to read it gets the result all the same
            print(f"generation {generation} of at most {most}, cost {cost:.4g}", file=sys.stderr)
