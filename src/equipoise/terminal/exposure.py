"""What `equipoise exposure` prints."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

from equipoise.exposure.daily import ACTION, DAY, LIMIT, LONGEST, WorkingTimes, limit_time
from equipoise.terminal.tables import Row, number, table

if TYPE_CHECKING:
    from equipoise.exposure.daily import Exposure, Verdict
    from equipoise.exposure.weighting import Weighted

Tools = Sequence[tuple[str, float]]
"""Names, and vibration total values in m/s2."""
LONGEST_NAME = 40
WHAT = {
    "signal": "signal",
    "spectrum": "spectrum of lines",
    "bands": "spectrum in one-third-octave bands",
    "orders": "orders",
}
MEANING: dict[Verdict, str] = {
    "below the action value": "acceptable, though less is always better",
    "above the action value": (
        "allowed, but the employer has to act: less vibration, or less time"
    ),
    "above the limit value": "not acceptable: nobody may be exposed to this",
}
"""In plain words, by Directive 2002/44/EC."""


def print_exposure(
    measured: Sequence[tuple[str, Weighted]], tools: Tools, day: Exposure | None
) -> None:
    """What was weighed, the day's exposure, and how long one may work."""
    for count, (name, weighted) in enumerate(measured):
        if count:
            print()
        print(shown(name))
        for line in _weighed(weighted):
            print(line)
    if day is None:
        print(_times(tools).lstrip("\n") if not measured else _times(tools))
        print("\nThere is no daily exposure without a time; give it by --duration.")
        return
    print(_tasks(day).lstrip("\n") if not measured else _tasks(day))
    for line in _verdict(day):
        print(line)


def shown(name: str) -> str:
    """A name that any terminal can print, and that leaves room for numbers."""
    from equipoise.schema.files import printable

    name = printable(name)
    return name if len(name) <= LONGEST_NAME else f"{name[: LONGEST_NAME - 3]}..."


def _weighed(weighted: Weighted) -> Iterator[str]:
    """What was weighed, axis by axis."""
    axes = "1 axis" if len(weighted.axes) == 1 else f"{len(weighted.axes)} axes"
    told = f"{WHAT[weighted.kind]}, {axes}"
    if weighted.duration is not None and weighted.sampling_rate is not None:
        told += f", {number(weighted.duration)} s at {number(weighted.sampling_rate)} Hz"
    yield told + (", weighted already" if weighted.a_h is None else "")
    rows: list[Row] = []
    for at, axis in enumerate(weighted.axes):
        before = "" if weighted.a_h is None else number(weighted.a_h[at])
        rows.append((axis, before, number(weighted.a_hw[at])))
    how = "1.7 times the largest" if weighted.single_axis else "root of the sum of squares"
    rows.append((f"total value a_hv, {how}", "", number(weighted.a_hv)))
    header = ("axis", "RMS m/s^2", "weighted RMS m/s^2")
    yield table("Acceleration, weighted by Wh of ISO 5349-1", header, rows)
    if weighted.dominant_band is not None:
        yield (
            f"\nmost of it: band of {weighted.dominant_band:g} Hz, "
            f"{100 * weighted.dominant_share:.0f} % of the weighted mean square; axis "
            f"{weighted.dominant_axis}"
        )
    for note in weighted.notes:
        yield f"note: {note}"


# -- a day -----------------------------------------------------------------------------------------

LEGEND = ("to action", "to limit", "in Japan")
"""Columns of hours: until action and limit value, and by the Japanese guideline."""
UNITS = "m/s^2; times in hours a day, the last three for each alone"


def _times(tools: Tools) -> str:
    """How long a day one may work with each tool."""
    header = ("", "a_hv", *LEGEND)
    rows = [(shown(name), number(a_hv), *_hours(WorkingTimes(a_hv))) for name, a_hv in tools]
    return table("Total values in m/s^2, and how many hours a day they allow", header, rows)


def _tasks(day: Exposure) -> str:
    """Every task with its part of the day, and how long a day one may do it alone."""
    header = ("task", "a_hv", "time", "A_i(8)", "share %", *LEGEND)
    rows = [
        (
            shown(task.name),
            number(task.acceleration),
            number(task.duration / 3600),
            number(task.partial),
            f"{100 * day.share(task):.0f}",
            *_hours(task.times),
        )
        for task in day.tasks
    ]
    if len(rows) > 1:
        whole = (number(day.a_hv), number(day.duration / 3600), number(day.a8), "100")
        rows.append(("all of them", *whole, *_hours(day.times)))
    return table(f"A day's exposure: accelerations in {UNITS}", header, rows)


def _hours(times: WorkingTimes) -> tuple[str, str, str]:
    return (_hour(times.to_action), _hour(times.to_limit), _hour(times.japanese))


def _hour(time: float) -> str:
    return "over 24" if time > DAY else number(time / 3600)


def _verdict(day: Exposure) -> Iterator[str]:
    """What it means, in plain words."""
    yield (
        f"\nA(8) = {number(day.a8)} m/s^2, {day.verdict} ({ACTION:g} m/s^2 action, {LIMIT:g} m/s^2 "
        f"limit, Directive 2002/44/EC)"
    )
    yield MEANING[day.verdict]
    yield from _helps(day)
    if day.a8 > 0:
        beyond = ", beyond its Table C.1" if day.extrapolated else ""
        yield (
            f"white fingers in 10 % of those so exposed after {_years(day.years)} "
            f"(ISO 5349-1, Annex C{beyond})"
        )
    longest = limit_time(day.a_hv)
    capped = f" (200/a^2 alone: {_clock(longest)})" if longest > LONGEST else ""
    most = _clock(day.times.japanese)
    yield f"Japan, guideline of 2009: such work for at most {most} a day{capped}"


def _helps(day: Exposure) -> Iterator[str]:
    """How long this work may take, and how weak the vibration would have to be."""
    mix = "this work" if len(day.tasks) == 1 else "this mix of work"
    times = day.times
    if times.to_action > DAY:
        return
    yield (
        f"{mix} reaches the action value after {_clock(times.to_action)}, the limit value after "
        f"{_clock(times.to_limit)}"
    )
    if day.verdict != "below the action value":
        enough = number(day.a_hv * ACTION / day.a8)
        yield (
            f"in the same {_clock(day.duration)} a vibration of {enough} m/s^2 instead of "
            f"{number(day.a_hv)} m/s^2 would stay at the action value"
        )


def _clock(time: float) -> str:
    """A time in hours and minutes, rounded down: a limit is not to be passed."""
    if time > DAY:
        return "more than 24 h"
    hours, minutes = divmod(int(time / 60 + 1e-9), 60)
    parts = [f"{hours} h"] * (hours > 0) + [f"{minutes} min"] * (minutes > 0)
    return " ".join(parts) or f"{number(time)} s"


def _years(years: float) -> str:
    return "more than 100 years" if years > 100 else f"{years:.1f} years"
