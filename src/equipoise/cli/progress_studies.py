"""Progress of sweeps, searches and tolerances on standard error: a bar in a terminal, a log else.

In a log there are the fewer lines the longer it takes, and one that closes it.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager, suppress
from time import monotonic
from typing import TYPE_CHECKING, Any

from equipoise.cli.progress import SECONDS

if TYPE_CHECKING:
    from rich.console import RenderableType

    from equipoise.schema.study_units import Unit
    from equipoise.studies.outcomes import Outcome, Progress
    from equipoise.studies.study import Study

GROWTH, LONGEST = 0.5, 600.0
"""The next line in a log comes after this share of the time so far; at the latest after so many s.
"""
SURE, LATEST = 0.02, 60.0
"""Share of the designs, or time in s, after which a rate is one: loops are compiled at first."""

Told = Callable[["Progress"], None]


@contextmanager
def swept(units: Mapping[str, Unit]) -> Iterator[Told]:
    """Yield what many designs tell how far they are; `units` are those of the objectives."""
    if sys.stderr is None or not sys.stderr.isatty():
        log = _Log(units)
        yield log.add
        log.close()
        return
    from rich.console import Console
    from rich.live import Live

    bar = _Bar(units)
    console = Console(stderr=True)
    with Live(bar, console=console, transient=True, refresh_per_second=4):
        yield bar.add


class Watched:
    """Computes designs of a study, and tells how far it is each time.

    total : designs in all, or the most there can be.
    """

    def __init__(self, study: Study, told: Told) -> None:
        from equipoise.studies.outcomes import Tally

        self.study, self.told = study, told
        self.tally = Tally(study.outputs, 0)
        self.compute: Callable[[Any], Outcome] | None = None

    def __call__(self, values: Any) -> Outcome:
        """Compute designs (P, d)."""
        from equipoise.studies.evaluate import evaluator
        from equipoise.studies.outcomes import Block

        if self.compute is None:
            self.compute = evaluator(self.study)
        outcome = self.compute(values)
        self.tally.add(Block(values, outcome), computed=True)
        return outcome

    def tell(self, total: int) -> None:
        """Tell how far it is, of so many designs in all."""
        self.tally.total = total
        self.told(self.tally.progress())


# -- as text ---------------------------------------------------------------------------------------


def share_told(progress: Progress) -> str:
    """Such as ``12 % of 1000000 designs``."""
    share = 100 * progress.done / progress.total if progress.total else 100.0
    return f"{share:.0f} %, {progress.done} of {progress.total} designs"


def left_told(progress: Progress, ago: float = 0.0) -> str:
    """Time that is left, of what was told some seconds ago; not before it can be known."""
    early = progress.done < SURE * progress.total and progress.seconds < LATEST
    if progress.left is None or early:
        return ""
    return f"{time_told(max(0.0, progress.left - ago))} left"


def rate_told(rate: float | None) -> str:
    """Designs a second."""
    if not rate:
        return ""
    return f"{float(f'{rate:.3g}'):.0f} designs/s" if rate >= 100 else f"{rate:.3g} designs/s"


def time_told(seconds: float) -> str:
    """A time as one says it."""
    if seconds < 60:
        return f"{seconds:.1f} s"
    minutes, rest = divmod(round(seconds), 60)
    if minutes < 60:
        return f"{minutes} min {rest} s"
    hours, minutes = divmod(minutes, 60)
    return f"{hours} h {minutes} min"


def best_told(progress: Progress, units: Mapping[str, Unit]) -> str:
    """Best value so far of each objective."""
    from equipoise.terminal.tables import number

    told = []
    for name, value in progress.best.items():
        unit = units[name]
        told.append(f"{name} {number(unit.of_si(value))} {unit.name}".strip())
    return ", ".join(told)


def failures_told(progress: Progress) -> str:
    """How many designs failed, by why."""
    return ", ".join(f"{what} {count}" for what, count in progress.failures.items())


# -- in a log --------------------------------------------------------------------------------------


class _Log:
    """A line now and then, and one in the end."""

    def __init__(self, units: Mapping[str, Unit]) -> None:
        self.units = units
        self.start = monotonic()
        self.next = SECONDS
        self.last: Progress | None = None

    def add(self, progress: Progress) -> None:
        self.last = progress
        after = monotonic() - self.start
        if after < self.next or progress.done >= progress.total:
            return
        self.next = after + min(max(SECONDS, GROWTH * after), LONGEST)
        parts = [share_told(progress), rate_told(progress.rate), left_told(progress)]
        self._print(parts, progress)

    def close(self) -> None:
        last = self.last
        if last is None:
            return
        rate = rate_told(last.computed / max(last.seconds, 1e-9))
        self._print([f"{last.computed} designs computed in {time_told(last.seconds)}", rate], last)

    def _print(self, parts: list[str], progress: Progress) -> None:
        best = best_told(progress, self.units)
        more = [f"best {best}" if best else "", failures_told(progress)]
        line = "; ".join(filter(None, [", ".join(filter(None, parts)), *more]))
        with suppress(OSError):  # who does not want to read it gets the result all the same
            print(line, file=sys.stderr)


# -- in a terminal ---------------------------------------------------------------------------------


class _Bar:
    """A bar, and below it the best so far and the failures."""

    def __init__(self, units: Mapping[str, Unit]) -> None:
        from rich.progress import BarColumn, TextColumn
        from rich.progress import Progress as Bar

        self.units = units
        self.last: Progress | None = None
        self.at = monotonic()
        columns = (TextColumn("{task.fields[share]}"), BarColumn(), TextColumn("{task.fields[at]}"))
        self.bar = Bar(*columns)
        self.task = self.bar.add_task("", total=None, share="begins", at="")

    def add(self, progress: Progress) -> None:
        self.last, self.at = progress, monotonic()

    def __rich__(self) -> RenderableType:
        from rich.console import Group
        from rich.text import Text

        if self.last is None:
            return self.bar
        progress = self.last
        parts = [rate_told(progress.rate), left_told(progress, monotonic() - self.at)]
        total = progress.total if progress.done else None
        share, at = share_told(progress), ", ".join(filter(None, parts))
        self.bar.update(self.task, completed=progress.done, total=total, share=share, at=at)
        best, failures = best_told(progress, self.units), failures_told(progress)
        lines = [f"best so far: {best}" if best else "", f"failed: {failures}" if failures else ""]
        return Group(self.bar, *(Text(line) for line in lines if line))
