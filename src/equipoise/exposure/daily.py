"""The vibration exposure of a day: tasks, what they amount to by each standard, time limits.

ISO 5349-1 and ISO 5349-2: the total value of three axes, daily exposure, years to white finger.

Sources: ISO 5349-1:2001, 4.4 (equation 1), 5.3 (equations 2 and 3), Annex C (equation C.1, Table
C.1); ISO 5349-2:2001, clause 8.  docs/exposure.md states what of that was checked, and how.

Guideline on vibrating tools of the Japanese Ministry of Health, Labour and Welfare, 2009.

Source: notifications Kihatsu 0710 No. 1 (chain saws) and No. 2 (other tools) of 10 July 2009: A(8)
shall not exceed 5.0 m/s2; above 2.5 m/s2 one has to work for less; the longest time a day follows
from the total value a as T = 200/a^2 hours, and where that is more than 2 hours, it is 2 hours for
the time being.
"""

from __future__ import annotations

from collections.abc import Iterable
from math import inf, isfinite, sqrt
from typing import Any, ClassVar, Literal, get_args

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.errors import UsageError, at_place
from equipoise.exposure.weighting import not_negative
from equipoise.i18n import Note
from equipoise.results.declaring import Declarations, ResultOutput, values_of
from equipoise.results.result import Result

EIGHT_HOURS = 28_800.0
"""s, to which a day's exposure is referred."""
SINGLE_AXIS = 1.7
"""Total value over that of the largest axis where no other was measured.  ISO 5349-1, 4.4, asks for
a factor from 1.0 to 1.7; this is the cautious end, three axes alike."""
YEARS_OF_TABLE = (1.0, 8.0)
"""Ends of Table C.1, which goes from 26 to 3.7 m/s2; beyond them equation C.1 extrapolates."""


def total_value(a_hw: Any, single_axis: bool = False) -> float:
    """Vibration total value a_hv, m/s2, of weighted RMS accelerations (axes,), m/s2.

    single_axis : estimate it as 1.7 times the largest axis.
    """
    values = np.asarray(a_hw, dtype=float)
    if single_axis:
        return SINGLE_AXIS * float(np.max(values))
    return float(np.sqrt(np.sum(values**2)))


def partial_exposure(a_hv: float, duration: float) -> float:
    """A_i(8), m/s2, of a total value, m/s2, that acts for a time, s."""
    return a_hv * sqrt(duration / EIGHT_HOURS)


def years_to_white_finger(a8: float) -> float:
    """D_y: years of exposure after which 10 % of a group have white fingers; A(8) in m/s2."""
    return 31.8 * a8**-1.06 if a8 > 0 else inf


ACTION, LIMIT = 2.5, 5.0
"""m/s2, of A(8); Article 3, paragraph 1, b and a.  Above the first an employer has to act, Article
5, paragraph 2; above the second nobody may be exposed, paragraph 3."""
POINTS_OF_ACTION = 100.0
"""Points of a day at the action value, by the exposure points system of the Health and Safety
Executive (L140): 2 points for each hour and each (m/s2)^2, so that the limit value has 400."""


def time_to_reach(value: float, a_hv: float) -> float:
    """Time, s, in which a total value, m/s2, makes up a daily exposure, m/s2; infinite for 0."""
    return EIGHT_HOURS * (value / a_hv) ** 2 if a_hv > 0 else inf


def points(a8: float) -> float:
    """Exposure points of a daily or partial exposure, m/s2; those of several tasks add up."""
    return POINTS_OF_ACTION * (a8 / ACTION) ** 2


def equivalent(idling: float, racing: float) -> float:
    """Equivalent total value a_hv,eq, m/s2, of those when idling and when racing, m/s2.

    Both count for equal times.  Source: ISO 22867, brush cutters and grass trimmers; manuals
    state equal times as well, as that of the Stihl FS 40, 20.6.

    Raises
    ------
    UsageError : a value is negative or no finite number.
    """
    idling, racing = not_negative("idling", idling), not_negative("racing", racing)
    return sqrt((idling**2 + racing**2) / 2)


HOURS, LONGEST = 200.0, 7200.0
"""T a^2 in h (m/s2)^2, and the longest time a day, s."""


def limit_time(a_hv: float) -> float:
    """T = 200/a^2 hours a day, here in s, of a total value, m/s2; infinite for 0."""
    return 3600 * HOURS / a_hv**2 if a_hv > 0 else inf


def allowed_time(a_hv: float) -> float:
    """Time a day, s, that a tool may be used for: T, but at most two hours."""
    return min(limit_time(a_hv), LONGEST)


DAY = 86_400.0
"""s."""
ROUNDING = 1e-9
"""By which a daily exposure may miss a value that it equals."""
Verdict = Literal["below the action value", "above the action value", "above the limit value"]


def verdict_of(a8: float) -> Verdict:
    """What Directive 2002/44/EC makes of a daily exposure, m/s2."""
    if a8 > LIMIT * (1 + ROUNDING):
        return "above the limit value"
    if a8 > ACTION * (1 + ROUNDING):
        return "above the action value"
    return "below the action value"


def _time(meaning: str, name: str) -> ResultOutput:
    """A time, s, that may have no end."""
    return ResultOutput(
        f"{meaning}; null where there is no vibration",
        "time",
        read=lambda times: _finite(getattr(times, name)),
    )


@dataclass(frozen=True)
class WorkingTimes:
    """How long a day, s, one may work with a tool.

    a_hv : its vibration total value, m/s2.
    """

    a_hv: float

    @property
    def to_action(self) -> float:
        """Until A(8) is 2.5 m/s2."""
        return time_to_reach(ACTION, self.a_hv)

    @property
    def to_limit(self) -> float:
        """Until A(8) is 5 m/s2."""
        return time_to_reach(LIMIT, self.a_hv)

    @property
    def japanese_limit(self) -> float:
        """By the Japanese guideline: 200/a^2 hours."""
        return limit_time(self.a_hv)

    @property
    def japanese(self) -> float:
        """By the Japanese guideline: 200/a^2 hours, but at most two."""
        return allowed_time(self.a_hv)

    declared: ClassVar[Declarations] = {
        "time_to_action": _time("until A(8) is the action value", "to_action"),
        "time_to_limit": _time("until A(8) is the limit value", "to_limit"),
        "japanese_limit_time": _time("200/a² hours", "japanese_limit"),
        "japanese_time": _time("200/a² hours, but at most two", "japanese"),
    }

    def to_dict(self) -> dict[str, Any]:
        """Plain data; None where there is no end to it."""
        return values_of(self, self.declared)


@dataclass(frozen=True)
class Task:
    """Part of a day's work.

    Parameters
    ----------
    name : of the task, or of the tool.
    acceleration : vibration total value a_hv, m/s2.
    duration : s a day, during which the hand is exposed.

    Raises
    ------
    UsageError : a value is negative or no finite number, or the time is 0 or beyond a day.
    """

    name: str
    acceleration: float
    duration: float

    def __post_init__(self) -> None:
        for key, unit in (("acceleration", "m/s^2"), ("duration", "s")):
            object.__setattr__(self, key, not_negative(key, getattr(self, key), unit))
        if not 0 < self.duration <= DAY:
            raise UsageError(
                at_place(
                    "duration",
                    Note(
                        "got {duration:g} h; give more than 0 and at most 24 h a day",
                        duration=self.duration / 3600,
                    ),
                )
            )

    @property
    def partial(self) -> float:
        """Partial exposure A_i(8), m/s2."""
        return partial_exposure(self.acceleration, self.duration)

    @property
    def times(self) -> WorkingTimes:
        """How long one may do this and nothing else."""
        return WorkingTimes(self.acceleration)


@dataclass(frozen=True)
class TaskShare:
    """A task, and its share in the square of A(8)."""

    task: Task
    share: float

    declared: ClassVar[Declarations] = {
        "name": ResultOutput("of the task", read="task.name"),
        "a_hv": ResultOutput("vibration total value", "acceleration", read="task.acceleration"),
        "duration": ResultOutput("time a day", "time", read="task.duration"),
        "partial": ResultOutput("partial exposure A_i(8)", "acceleration", read="task.partial"),
        "share": ResultOutput("share in the square of A(8)"),
        "points": ResultOutput("exposure points", read=lambda item: points(item.task.partial)),
        "times": ResultOutput(
            "of this task alone", of=WorkingTimes.declared, read="task.times", spliced=True
        ),
    }


@dataclass(frozen=True, repr=False)
class Exposure(Result):
    """A day's exposure; see docs/exposure.md."""

    blocks_in = "exposure.blocks.exposure_blocks"
    records: ClassVar[str] = "tasks"

    tasks: tuple[Task, ...]

    @property
    def duration(self) -> float:
        """Of all tasks together, s."""
        return sum(task.duration for task in self.tasks)

    @property
    def a8(self) -> float:
        """A(8), m/s2."""
        return sqrt(sum(task.partial**2 for task in self.tasks))

    @property
    def a_hv(self) -> float:
        """The steady vibration, m/s2, that amounts to as much in the time of all tasks."""
        squares = sum(task.acceleration**2 * task.duration for task in self.tasks)
        return sqrt(squares / self.duration)

    @property
    def times(self) -> WorkingTimes:
        """How long one may work at this mix of tasks."""
        return WorkingTimes(self.a_hv)

    @property
    def years(self) -> float:
        """Until 10 % of those so exposed have white fingers."""
        return years_to_white_finger(self.a8)

    @property
    def extrapolated(self) -> bool:
        """Whether these years lie outside Table C.1 of ISO 5349-1, to its digits."""
        return not YEARS_OF_TABLE[0] <= round(self.years, 1) <= YEARS_OF_TABLE[1]

    @property
    def verdict(self) -> Verdict:
        """What Directive 2002/44/EC makes of it."""
        return verdict_of(self.a8)

    def share(self, task: Task) -> float:
        """Share of a task in the square of A(8), which is what adds up."""
        return (task.partial / self.a8) ** 2 if self.a8 > 0 else 0.0

    @property
    def parts(self) -> tuple[TaskShare, ...]:
        """Each task with its share."""
        return tuple(TaskShare(task, self.share(task)) for task in self.tasks)

    declared: ClassVar[Declarations] = {
        "tasks": ResultOutput("tasks of the day", of=TaskShare.declared, many=True, read="parts"),
        "duration": ResultOutput("of all tasks", "time"),
        "a_hv": ResultOutput(
            "steady vibration that amounts to the same in all of the time", "acceleration"
        ),
        "a8": ResultOutput("A(8)", "acceleration"),
        "points": ResultOutput("exposure points of the day", read=lambda day: points(day.a8)),
        "action": ResultOutput("action value", "acceleration", read=lambda _: ACTION),
        "limit": ResultOutput("limit value", "acceleration", read=lambda _: LIMIT),
        "share_of_limit": ResultOutput(
            "A(8) over the limit value", read=lambda day: day.a8 / LIMIT
        ),
        "verdict": ResultOutput(" or ".join(f'`"{get_arg}"`' for get_arg in get_args(Verdict))),
        "times": ResultOutput("of this mix of tasks", of=WorkingTimes.declared, spliced=True),
        "years_to_white_finger": ResultOutput(
            "D_y, in years; null where there is no vibration", read=lambda day: _finite(day.years)
        ),
        "years_extrapolated": ResultOutput(
            "whether it lies outside Table C.1", read="extrapolated"
        ),
    }


def daily_exposure(tasks: Iterable[Task]) -> Exposure:
    """The exposure of a day that consists of tasks.

    Raises
    ------
    UsageError : there is no task, or they take more than 24 hours together.
    """
    given = tuple(tasks)
    if not given:
        raise UsageError(at_place("tasks", Note("there is none; give at least one")))
    exposure = Exposure(given)
    if exposure.duration > DAY * (1 + ROUNDING):
        raise UsageError(
            Note(
                "the tasks take {duration:g} h together; give at most 24 h a day",
                duration=exposure.duration / 3600,
            )
        )
    return exposure


def _finite(value: float) -> float | None:
    return value if isfinite(value) else None
