"""The vibration exposure of a day: tasks, what they amount to, and how long one may work."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from math import isfinite, sqrt
from typing import Any, Literal

from equipoise.errors import UsageError
from equipoise.exposure.checks import not_negative
from equipoise.exposure.directive import ACTION, LIMIT, points, time_to_reach
from equipoise.exposure.iso_5349 import (
    YEARS_OF_TABLE,
    partial_exposure,
    together,
    years_to_white_finger,
)
from equipoise.exposure.japan import allowed_time, limit_time
from equipoise.results.result import Result

DAY = 86_400.0
"""s."""
ROUNDING = 1e-9
"""By which a daily exposure may miss a value that it equals."""
Verdict = Literal["below the action value", "above the action value", "above the limit value"]


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
    def japanese(self) -> float:
        """By the Japanese guideline: 200/a^2 hours, but at most two."""
        return allowed_time(self.a_hv)

    def to_dict(self) -> dict[str, float | None]:
        """Plain data; None where there is no end to it."""
        return {
            "time_to_action": _finite(self.to_action),
            "time_to_limit": _finite(self.to_limit),
            "japanese_limit_time": _finite(limit_time(self.a_hv)),
            "japanese_time": self.japanese,
        }


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
                f"duration: got {self.duration / 3600:g} h; give more than 0 and at most 24 h a day"
            )

    @property
    def partial(self) -> float:
        """Partial exposure A_i(8), m/s2."""
        return partial_exposure(self.acceleration, self.duration)

    @property
    def times(self) -> WorkingTimes:
        """How long one may do this and nothing else."""
        return WorkingTimes(self.acceleration)


@dataclass(frozen=True, repr=False)
class Exposure(Result):
    """A day's exposure; see docs/exposure.md."""

    tasks: tuple[Task, ...]

    @property
    def duration(self) -> float:
        """Of all tasks together, s."""
        return sum(task.duration for task in self.tasks)

    @property
    def a8(self) -> float:
        """A(8), m/s2."""
        return together(task.partial for task in self.tasks)

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
        if self.a8 > LIMIT * (1 + ROUNDING):
            return "above the limit value"
        if self.a8 > ACTION * (1 + ROUNDING):
            return "above the action value"
        return "below the action value"

    def share(self, task: Task) -> float:
        """Share of a task in the square of A(8), which is what adds up."""
        return (task.partial / self.a8) ** 2 if self.a8 > 0 else 0.0

    def to_dict(self) -> dict[str, Any]:
        """Everything as plain data, in SI units; None where there is no end to a time."""
        return {
            "tasks": [self._task(task) for task in self.tasks],
            "duration": self.duration,
            "a_hv": self.a_hv,
            "a8": self.a8,
            "points": points(self.a8),
            "action": ACTION,
            "limit": LIMIT,
            "share_of_limit": self.a8 / LIMIT,
            "verdict": self.verdict,
            **self.times.to_dict(),
            "years_to_white_finger": _finite(self.years),
            "years_extrapolated": self.extrapolated,
        }

    def _task(self, task: Task) -> dict[str, Any]:
        return {
            "name": task.name,
            "a_hv": task.acceleration,
            "duration": task.duration,
            "partial": task.partial,
            "share": self.share(task),
            "points": points(task.partial),
            **task.times.to_dict(),
        }


def daily_exposure(tasks: Iterable[Task]) -> Exposure:
    """The exposure of a day that consists of tasks.

    Raises
    ------
    UsageError : there is no task, or they take more than 24 hours together.
    """
    given = tuple(tasks)
    if not given:
        raise UsageError("tasks: there is none; give at least one")
    exposure = Exposure(given)
    if exposure.duration > DAY * (1 + ROUNDING):
        raise UsageError(
            f"the tasks take {exposure.duration / 3600:g} h together; give at most 24 h a day"
        )
    return exposure


def _finite(value: float) -> float | None:
    return value if isfinite(value) else None
