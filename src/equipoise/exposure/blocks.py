"""What hand-arm vibration shows: what was weighted, a day's exposure, how long one may work."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

from equipoise.exposure.daily import (
    ACTION,
    DAY,
    LIMIT,
    LONGEST,
    WorkingTimes,
    limit_time,
    verdict_of,
)
from equipoise.i18n import say, to_say, without_middle
from equipoise.quantities import number
from equipoise.results.blocks import (
    Block,
    Cell,
    Column,
    Emphasis,
    Notes,
    ReportSection,
    Table,
    Text,
    Value,
    broken_if,
)

if TYPE_CHECKING:
    from equipoise.exposure.daily import Exposure
    from equipoise.exposure.weighting import Weighted

LONGEST_NAME = 40
WHAT = {
    "signal": to_say("signal"),
    "spectrum": to_say("spectrum of lines"),
    "bands": to_say("spectrum in one-third-octave bands"),
    "orders": to_say("orders"),
}
VERDICTS = {
    "below the action value": to_say("below the action value of 2.5 m/s² (2002/44/EC)"),
    "above the action value": to_say("above the action value of 2.5 m/s² (2002/44/EC)"),
    "above the limit value": to_say("above the limit value of 5 m/s² (2002/44/EC)"),
}
MEANING = {
    "below the action value": to_say("acceptable, though less is always better"),
    "above the action value": to_say(
        "allowed, but the employer has to act: less vibration, or less time"
    ),
    "above the limit value": to_say("not acceptable: nobody may be exposed to this"),
}
"""In plain words, by Directive 2002/44/EC."""


def limit_broken(a8: float) -> Emphasis | None:
    """The emphasis of a daily exposure, m/s2, or of a task's part of it."""
    return broken_if(verdict_of(a8) == "above the limit value")


def shortened(name: str) -> str:
    """A name that any terminal can print, and that leaves room for numbers."""
    name = "".join(sign if sign.isprintable() else ascii(sign)[1:-1] for sign in name)
    return without_middle(name, LONGEST_NAME)


def weighted_blocks(weighted: Weighted) -> Iterator[Block]:
    """What was weighted, axis by axis."""
    parts = [say(WHAT[weighted.kind])]
    parts.append(say("{count} axes", count=len(weighted.axes)))
    if weighted.duration is not None and weighted.sampling_rate is not None:
        parts.append(
            say(
                "{time} s at {rate} Hz",
                time=number(weighted.duration),
                rate=number(weighted.sampling_rate),
            )
        )
    if weighted.a_h is None:
        parts.append(say("weighted already"))
    yield Text(say(", ").join(parts))
    rows: list[tuple[Cell, ...]] = []
    for at, axis in enumerate(weighted.axes):
        before = None if weighted.a_h is None else Value(float(weighted.a_h[at]))
        rows.append((axis, before, Value(float(weighted.a_hw[at]))))
    total = say("total value a_hv, root of the sum of squares")
    if weighted.single_axis:
        total = say("total value a_hv, 1.7 times the largest")
    rows.append((total, None, Value(weighted.a_hv)))
    columns = (Column(say("axis")), _acceleration(say("RMS")), _acceleration(say("weighted RMS")))
    yield Table(say("Acceleration, weighted by Wh of ISO 5349-1"), columns, tuple(rows))
    if weighted.dominant_band is not None:
        yield Text(
            say(
                "Most of it: band of {band} Hz, {share} % of the weighted mean square; axis {axis}",
                band=f"{weighted.dominant_band:g}",
                share=f"{100 * weighted.dominant_share:.0f}",
                axis=weighted.dominant_axis,
            )
        )
    if weighted.notes:
        yield Notes(weighted.notes)


def times_blocks(tools: Sequence[tuple[str, float]]) -> Iterator[Block]:
    """How long a day one may work with each tool: names, and vibration total values in m/s2."""
    columns = (Column(""), _acceleration(say("total value a_hv")), *_allowed())
    rows = tuple(
        (shortened(name), Value(a_hv), *_hours(WorkingTimes(a_hv))) for name, a_hv in tools
    )
    yield Table(say("Total values, and how many hours a day they allow"), columns, rows)
    yield Text(say("There is no daily exposure without a time."))


def weighting_blocks(
    measured: Sequence[tuple[str, Weighted]],
    tools: Sequence[tuple[str, float]],
    day: Exposure | None,
) -> Iterator[Block | ReportSection]:
    """Weighted accelerations by name; then the day's exposure, or without times permitted times."""
    for name, weighted in measured:
        yield ReportSection("weighted", shortened(name), tuple(weighted_blocks(weighted)))
    yield from times_blocks(tools) if day is None else exposure_blocks(day)


def exposure_blocks(day: Exposure, judged: bool = True) -> Iterator[Block]:
    """A day's exposure, and what it means in plain words.

    judged : whether to say what the day amounts to and when values are reached, which a report says
        in its verdict and summary.
    """
    yield _tasks(day)
    if judged:
        yield from _judgement(day)
        yield from map(Text, _reached(day))
    yield from map(Text, _helps(day))
    if day.a8 > 0:
        yield Text(_white_fingers(day))
    longest = limit_time(day.a_hv)
    most = clock(day.times.japanese)
    text = say("Japan, guideline of 2009: such work for at most {most} a day", most=most)
    if longest > LONGEST:
        text += say(" (200/a^2 alone: {longest})", longest=clock(longest))
    yield Text(text)


def _judgement(day: Exposure) -> Iterator[Text]:
    """A(8) beside its values, and what that means."""
    above = broken_if(day.verdict != "below the action value")
    yield Text(
        say(
            "A(8) = {a8} m/s², {verdict}; action value {action} m/s², limit value {limit} m/s²",
            a8=number(day.a8),
            verdict=say(VERDICTS[day.verdict]),
            action=f"{ACTION:g}",
            limit=f"{LIMIT:g}",
        ),
        emphasis=above,
    )
    yield Text(say(MEANING[day.verdict]), above)


def _acceleration(label: str) -> Column:
    return Column(label, "acceleration", "m/s^2")


def _allowed() -> tuple[Column, ...]:
    """Columns of hours: until action and limit value, and by the Japanese guideline."""
    labels = (say("to action"), say("to limit"), say("in Japan"))
    return tuple(Column(label, unit="h") for label in labels)


def _hours(times: WorkingTimes) -> tuple[Cell, ...]:
    allowed = (times.to_action, times.to_limit, times.japanese)
    return tuple(say("over 24") if time > DAY else Value(time / 3600) for time in allowed)


def _judged(a8: float) -> Value:
    """An exposure, beside the limit value where that is broken."""
    above = limit_broken(a8)
    return Value(a8, emphasis=above, limit=LIMIT if above else None)


def _tasks(day: Exposure) -> Table:
    """Every task with its part of the day, and how long a day one may do it alone."""
    rows: list[tuple[Cell, ...]] = [
        (
            shortened(task.name),
            Value(task.acceleration),
            Value(task.duration / 3600),
            _judged(task.partial),
            Value(100 * day.share(task), after=0),
            *_hours(task.times),
        )
        for task in day.tasks
    ]
    if len(rows) > 1:
        cells = (Value(day.a_hv), Value(day.duration / 3600), _judged(day.a8))
        whole = Value(100.0, after=0)
        rows.append((say("all of them"), *cells, whole, *_hours(day.times)))
    columns = (
        Column(say("task")),
        _acceleration(say("total value a_hv")),
        Column(say("time"), unit="h"),
        _acceleration(say("partial exposure A_i(8)")),
        Column(say("share"), unit="%"),
        *_allowed(),
    )
    title = say("A day's exposure; hours a day that are allowed, of each task alone")
    return Table(title, columns, tuple(rows))


def _reached(day: Exposure) -> Iterator[str]:
    """How long this work may take."""
    times = day.times
    if times.to_action > DAY:
        return
    template = to_say(
        "This work reaches the action value after {action}, the limit value after {limit}."
    )
    if len(day.tasks) > 1:
        template = to_say(
            "This mix of work reaches the action value after {action}, the limit value after "
            "{limit}."
        )
    yield say(template, action=clock(times.to_action), limit=clock(times.to_limit))


def _helps(day: Exposure) -> Iterator[str]:
    """How weak the vibration would have to be."""
    if day.times.to_action <= DAY and day.verdict != "below the action value":
        yield say(
            "In the same {time} a vibration of {enough} m/s² instead of {now} m/s² would stay at "
            "the action value.",
            time=clock(day.duration),
            enough=number(day.a_hv * ACTION / day.a8),
            now=number(day.a_hv),
        )


def _white_fingers(day: Exposure) -> str:
    years = f"{day.years:.1f}" if day.years <= 100 else say("more than {years}", years=100)
    template = to_say(
        "White fingers in 10 % of those so exposed after {years} years (ISO 5349-1, Annex C)"
    )
    if day.extrapolated:
        template = to_say(
            "White fingers in 10 % of those so exposed after {years} years (ISO 5349-1, Annex C, "
            "beyond its Table C.1)"
        )
    return say(template, years=years)


def clock(time: float) -> str:
    """A time in hours and minutes, rounded down: a limit is not to be passed."""
    if time > DAY:
        return say("more than 24 h")
    hours, minutes = divmod(int(time / 60 + 1e-9), 60)
    parts = [say("{hours} h", hours=hours)] * (hours > 0)
    parts += [say("{minutes} min", minutes=minutes)] * (minutes > 0)
    return " ".join(parts) or f"{number(time)} s"
