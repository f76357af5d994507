"""Tasks of a day and what they amount to."""

from __future__ import annotations

import json
from math import inf, nan
from typing import Any

import pytest

from equipoise.errors import UsageError
from equipoise.exposure.daily import Task, WorkingTimes, daily_exposure, equivalent
from support.refusals import refused

HOUR = 3600.0
DAY = (Task("mowing", 4.0, 2 * HOUR), Task("trimming", 8.0, HOUR))


def test_figures_of_a_day() -> None:
    day = daily_exposure(DAY)
    assert day.a8 == pytest.approx(((16 * 2 + 64) / 8) ** 0.5)
    assert day.duration == 3 * HOUR
    assert day.a_hv == pytest.approx((96 / 3) ** 0.5)
    assert [day.share(task) for task in day.tasks] == pytest.approx([1 / 3, 2 / 3])
    assert day.verdict == "above the action value"


def test_after_the_reported_times_the_values_are_reached() -> None:
    day = daily_exposure(DAY)
    for whole, times in ((day.a_hv, day.times), *((t.acceleration, t.times) for t in DAY)):
        assert Task("", whole, times.to_action).partial == pytest.approx(2.5)
        assert Task("", whole, min(times.to_limit, 24 * HOUR)).partial <= 5.0 * (1 + 1e-12)
    longer = [
        Task(t.name, t.acceleration, t.duration * day.times.to_limit / day.duration) for t in DAY
    ]
    assert daily_exposure(longer).a8 == pytest.approx(5.0)


def test_plain_data() -> None:
    content = daily_exposure(DAY).to_dict()
    assert json.loads(json.dumps(content, allow_nan=False)) == content
    assert content["a8"] == daily_exposure(DAY).a8
    assert sum(task["share"] for task in content["tasks"]) == pytest.approx(1)
    assert sum(task["points"] for task in content["tasks"]) == pytest.approx(content["points"])
    assert [task["name"] for task in content["tasks"]] == ["mowing", "trimming"]
    assert set(WorkingTimes(3.0).to_dict()) < set(content)


def test_a_day_without_vibration() -> None:
    day = daily_exposure([Task("rest", 0.0, HOUR)])
    content = day.to_dict()
    assert (day.a8, day.share(day.tasks[0]), day.years) == (0.0, 0.0, inf)
    assert content["time_to_action"] is content["time_to_limit"] is None
    assert content["years_to_white_finger"] is None
    assert content["japanese_time"] == 2 * HOUR


def test_the_whole_day_may_be_worked() -> None:
    thirds = [Task("", 1.0, 8 * HOUR)] * 3
    assert daily_exposure(thirds).a8 == pytest.approx(3**0.5)


@pytest.mark.parametrize(
    ("acceleration", "duration", "expected"),
    [
        (-1.0, HOUR, {"place": "acceleration", "unit": "m/s^2", "value": -1.0}),
        (nan, HOUR, {"place": "acceleration", "unit": "m/s^2", "by": "not_negative"}),
        (inf, HOUR, {"place": "acceleration", "unit": "m/s^2", "by": "not_negative"}),
        (1e-200, HOUR, {"place": "acceleration", "value": 1e-200, "unit": "m/s^2"}),
        ("loud", HOUR, {"place": "acceleration", "value": "loud"}),
        (True, HOUR, {"place": "acceleration", "value": "True"}),
        (1.0, 0.0, {"place": "duration", "duration": 0.0}),
        (1.0, 25 * HOUR, {"place": "duration", "duration": 25.0}),
        (1.0, -HOUR, {"place": "duration", "unit": "s", "value": -3600.0}),
    ],
)
def test_tasks_that_are_refused(acceleration: Any, duration: Any, expected: dict[str, Any]) -> None:
    with refused(UsageError, **expected):
        Task("mowing", acceleration, duration)


def test_days_that_are_refused() -> None:
    with refused(UsageError, place="tasks"):
        daily_exposure([])
    with refused(UsageError, duration=26.0):
        daily_exposure([Task("", 1.0, 13 * HOUR)] * 2)


def test_modes_that_are_refused() -> None:
    with refused(UsageError, unit="m/s^2"):
        equivalent(1.0, -2.0)
