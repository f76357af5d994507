"""Progress on standard error: a bar in a terminal, a line now and then in a log.

In a log there are the fewer lines the longer it takes.  Where EQUIPOISE_PROGRESS is ``off`` there
is neither.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager, suppress
from dataclasses import field
from time import monotonic
from typing import TYPE_CHECKING, Any, Self

from equipoise.dataclass import dataclass
from equipoise.i18n import say, to_say
from equipoise.interrupts import check
from equipoise.quantities.numbers import duration_text, rate_text

if TYPE_CHECKING:
    from rich.console import RenderableType

    from equipoise.cli.options import Computers
    from equipoise.studies.blocks import Unit
    from equipoise.studies.outcomes import Outcome, Progress
    from equipoise.studies.study import Study

SECONDS, GROWTH, LONGEST = 5.0, 0.5, 60.0
"""The first line in a log comes after so many seconds, the next after this share of the time so
far, and at the latest after so many s.
"""
SURE, LATEST = 0.02, 60.0
"""Share of the designs, or time in s, after which a rate is one: loops are compiled at first."""


_shown_now: _Log | _Bar | None = None
"""The log or bar of progress that is shown at the moment."""


def last_line() -> float:
    """Moment of the last line on how far work is, s, or 0; of a bar now."""
    running = _shown_now
    if running is None:
        return 0.0
    return monotonic() if isinstance(running, _Bar) else running.last


def so_far() -> str:
    """How far work is, in words that may be empty; they stand for the next line of a log."""
    running = _shown_now
    if not isinstance(running, _Log) or running.step is None:
        return ""
    running.wait()
    return running.step().share


@dataclass(frozen=True)
class ProgressStep:
    """How far work is.

    done, total : parts of it.
    share : how far it is in words; at : of the moment, such as a rate.
    details : further lines, by their subject.
    """

    done: int
    total: int
    share: str
    at: str = ""
    details: Mapping[str, str] = field(default_factory=dict)


Show = Callable[[Callable[[], ProgressStep], bool], None]


@contextmanager
def _shown(first: float = SECONDS) -> Iterator[Show]:
    """Yield what shows a step; it is asked for when it is shown, and always where it is the last.

    first : time to the first line in a log, s.

    An interrupt that a library has dropped ends the work here.
    """
    if sys.stderr is None or os.environ.get("EQUIPOISE_PROGRESS") == "off":
        yield lambda step, last: check()
        return
    global _shown_now  # noqa: PLW0603 - there is one standard error
    try:
        if not sys.stderr.isatty():
            _shown_now = log = _Log(first)
            yield _checking(log.add)
            return
        from rich.console import Console
        from rich.live import Live

        _shown_now = bar = _Bar()
        with Live(bar, console=Console(stderr=True), transient=True, refresh_per_second=4):
            yield _checking(bar.add)
    finally:
        _shown_now = None


def _checking(show: Show) -> Show:
    def checked(step: Callable[[], ProgressStep], last: bool) -> None:
        check()
        show(step, last)

    return checked


class _Log:
    """A line now and then.  last : moment of the last one, 0 before the first."""

    def __init__(self, first: float) -> None:
        self.start, self.last = monotonic(), 0.0
        self.next = first
        self.step: Callable[[], ProgressStep] | None = None

    def add(self, step: Callable[[], ProgressStep], last: bool) -> None:
        self.step = step
        if monotonic() - self.start < self.next and not last:
            return
        self.wait()
        statement = step()
        statements = (f"{name}: {text}" for name, text in statement.details.items() if text)
        line = "; ".join([", ".join(filter(None, [statement.share, statement.at])), *statements])
        with suppress(OSError):  # who does not want to read it gets the result all the same
            print(line, file=sys.stderr)

    def wait(self) -> None:
        """Note that a line is printed now, so that the next comes after a while."""
        self.last = monotonic()
        after = self.last - self.start
        self.next = after + min(max(SECONDS, GROWTH * after), LONGEST)


class _Bar:
    """A bar, and further lines below it."""

    def __init__(self) -> None:
        from rich.progress import BarColumn, Progress, TextColumn

        self.step: Callable[[], ProgressStep] | None = None
        columns = (TextColumn("{task.fields[share]}"), BarColumn(), TextColumn("{task.fields[at]}"))
        self.bar = Progress(*columns)
        self.task = self.bar.add_task("", total=None, share="begins", at="")

    def add(self, step: Callable[[], ProgressStep], last: bool) -> None:
        self.step = step

    def __rich__(self) -> RenderableType:
        from rich.console import Group
        from rich.text import Text

        if self.step is None:
            return self.bar
        step = self.step()
        total = step.total if step.done else None
        self.bar.update(self.task, completed=step.done, total=total, share=step.share, at=step.at)
        lines = (Text(f"{name}: {text}") for name, text in step.details.items() if text)
        return Group(self.bar, *lines)


# -- of one computation ----------------------------------------------------------------------------


@contextmanager
def counted(what: str) -> Iterator[Callable[[int, int], None]]:
    """Yield what long work calls with how many of its parts are done, and how many there are."""
    with _shown() as show:
        yield lambda done, total: show(
            lambda: ProgressStep(
                done, total, say("{what} {done} of {total}", what=what, done=done, total=total)
            ),
            False,
        )


@contextmanager
def generations() -> Iterator[Callable[[int, int, float], None]]:
    """Yield what a search calls with its generation, the most there can be, and the best cost."""
    start = monotonic()

    def step(done: int, most: int, cost: float) -> ProgressStep:
        left = (most - done) * (monotonic() - start) / done
        share = say("generation {done} of at most {most}", done=done, most=most)
        template = to_say("cost {cost}, at most {time} left")
        at = say(template, cost=f"{cost:.4g}", time=duration_text(left))
        return ProgressStep(done, max(done, most), share, at)

    with _shown(0.0) as show:
        yield lambda done, most, cost: show(lambda: step(done, most, cost), False)


# -- of many designs -------------------------------------------------------------------------------


@contextmanager
def swept(units: Mapping[str, Unit]) -> Iterator[Callable[[Progress], None]]:
    """Yield a function that shows progress of many designs; `units` are those of the objectives."""
    progresses: list[Progress] = []
    with _shown() as show:

        def show_progress(progress: Progress) -> None:
            progresses[:] = [progress]
            at = monotonic()
            if progress.done < progress.total:
                show(lambda: _on_the_way(progress, units, monotonic() - at), False)

        yield show_progress
        if progresses:
            show(lambda: _in_the_end(progresses[0], units), True)


class Watched:
    """Computes designs of a study, and reports progress each time; a context manager.

    computers : who computes.  total : number of designs in all, or the most there can be.
    """

    def __init__(
        self, study: Study, report: Callable[[Progress], None], computers: Computers, total: int
    ) -> None:
        from equipoise.studies.evaluate import pooled
        from equipoise.studies.outcomes import Tally

        self.report, self.tally = report, Tally(study.outputs, total)
        self.compute = pooled(study, **vars(computers), expected=total)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *error: object) -> None:
        self.compute.close()

    def __call__(self, values: Any) -> Outcome:
        """Compute designs (P, d)."""
        from equipoise.studies.outcomes import DesignBlock

        outcome = self.compute(values)
        self.tally.add(DesignBlock(values, outcome), computed=True)
        return outcome

    def show_progress(self, *_: object) -> None:
        """Report progress."""
        self.report(self.tally.progress())


def _on_the_way(progress: Progress, units: Mapping[str, Unit], ago: float) -> ProgressStep:
    share = 100 * progress.done / progress.total if progress.total else 100.0
    return ProgressStep(
        progress.done,
        progress.total,
        say(
            "{share} %, {done} of {count} designs",
            share=f"{share:.0f}",
            done=progress.done,
            count=progress.total,
        ),
        ", ".join(filter(None, [rate_text(progress.rate), remaining_time_text(progress, ago)])),
        _best_and_failures(say("best so far"), progress, units),
    )


def _in_the_end(last: Progress, units: Mapping[str, Unit]) -> ProgressStep:
    template = to_say("{count} designs computed in {time}")
    computed = say(template, count=last.computed, time=duration_text(last.seconds))
    rate = rate_text(last.computed / max(last.seconds, 1e-9))
    return ProgressStep(
        last.done, last.total, computed, rate, _best_and_failures(say("best"), last, units)
    )


def _best_and_failures(name: str, progress: Progress, units: Mapping[str, Unit]) -> dict[str, str]:
    from equipoise.quantities import number
    from equipoise.studies.blocks import unit_in

    text = ((unit_in(units, output), value) for output, value in progress.best.items())
    best = (
        f"{unit.called} {number(unit.of_si(value))} {unit.name}".strip() for unit, value in text
    )
    failures = (f"{what} {count}" for what, count in progress.failures.items())
    return {name: ", ".join(best), say("failed"): ", ".join(failures)}


def remaining_time_text(progress: Progress, ago: float = 0.0) -> str:
    """Remaining time as text, of progress `ago` seconds old; empty before it can be estimated."""
    early = progress.done < SURE * progress.total and progress.seconds < LATEST
    if progress.left is None or early:
        return ""
    return say("{time} left", time=duration_text(max(0.0, progress.left - ago)))
