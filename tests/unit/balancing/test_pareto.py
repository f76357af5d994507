"""Trade-off curves: convex, falling, ending in the single optima, and proved at each point.

Values are read off machines, which solvers bring to 1e-8 of the value before.
"""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pytest

import equipoise as eq
from equipoise.balancing.pareto import trade_off
from equipoise.errors import UsageError
from equipoise.mechanism.balance import AddedMass, Balance, Limit, Objective, Phases, Weight

MACHINE = eq.load("yamashita-1")
FORCE, TORQUE = Objective("shaking_force", "peak"), Objective("drive_torque", "rms")
PLAN = Balance(
    masses=(
        AddedMass("crank", "A", Weight("any", 0.06, at_most=0.8)),
        AddedMass("rocker", "D", Weight("any", 0.06, at_most=0.5)),
    )
)
FRONT = trade_off(MACHINE, FORCE, TORQUE, PLAN, points=9)


def best(one: Objective) -> float:
    found = eq.balance(MACHINE, replace(PLAN, objectives=(one,)))
    return found.objectives[one.name][1]


def test_falls_and_bends_inwards() -> None:
    first, second = FRONT.values.T
    assert np.all(np.diff(first) > 0)
    assert np.all(np.diff(second) < 1e-8 * second[0])
    slopes = np.diff(second) / np.diff(first)
    assert np.all(np.diff(slopes) > -1e-6 * abs(slopes[0]))
    assert slopes[0] < 2 * slopes[-1] < 0


def test_ends_are_the_single_optima() -> None:
    """The first is let go by 1e-4 of the range, so that the second has room to move."""
    least, most = FRONT.values[[0, -1], 0]
    assert least == pytest.approx(best(FORCE), abs=1.01e-4 * (most - least))
    assert FRONT.values[-1, 1] == pytest.approx(best(TORQUE), rel=1e-6)


def test_each_point_is_proved_and_kept_to_its_limit() -> None:
    assert FRONT.gap < 1e-8
    assert FRONT.gap == max(point.gap or 0.0 for point in FRONT.points)
    for point, (first, second) in zip(FRONT.points[:-1], FRONT.values, strict=False):
        price = point.prices[FORCE.name]
        assert first == pytest.approx(price.used)
        assert price.used <= price.at_most * (1 + 1e-7)
        assert point.objectives[TORQUE.name][1] == pytest.approx(second)


def test_prices_are_slopes_of_the_curve() -> None:
    """Of a convex curve: between the slopes to either side."""
    first, second = FRONT.values.T
    slopes = -np.diff(second) / np.diff(first)
    for k in range(1, 7):
        price = FRONT.points[k].prices[FORCE.name].price
        assert slopes[k] * (1 - 1e-3) <= price <= slopes[k - 1] * (1 + 1e-3)


def test_nothing_lies_below_the_curve() -> None:
    """Weighted sums of both, whose optima touch it from below."""
    before = [eq.balance(MACHINE, replace(PLAN, objectives=(one,))).objectives[one.name][0]
              for one in (FORCE, TORQUE)]  # fmt: skip
    for weight in (0.3, 1.0, 3.0):
        both = (FORCE, replace(TORQUE, weight=weight))
        found = eq.balance(MACHINE, replace(PLAN, objectives=both))
        sums = FRONT.values[:, 0] / before[0] + weight * FRONT.values[:, 1] / before[1]
        assert found.cost <= np.min(sums) + 1e-8
        assert found.cost == pytest.approx(np.min(sums), rel=0.01)


def test_columns_and_dictionary() -> None:
    (first, unit, values), (second, other, _), (mass, kilogram, masses) = FRONT.columns()
    assert (first, second, mass) == (FORCE.name, TORQUE.name, "added mass")
    assert (unit, other, kilogram) == ("N", "N m", "kg")
    assert np.array_equal(values, FRONT.values[:, 0])
    assert masses[3] == FRONT.points[3].added_mass
    told = json.loads(json.dumps(FRONT.to_dict()))
    assert set(told["before"]) == {FORCE.name, TORQUE.name}
    assert told["before"][FORCE.name] > told["points"][0]["first"]
    assert [point["second"] for point in told["points"]] == FRONT.values[:, 1].tolist()
    assert told["points"][2]["changes"][0]["link"] == "crank"


def test_limits_of_the_plan_are_kept() -> None:
    limit = Limit(Objective("drive_torque", "peak"), ratio=1.0)
    front = trade_off(MACHINE, FORCE, TORQUE, replace(PLAN, limits=(limit,)), points=3)
    before = eq.balance(MACHINE, replace(PLAN, objectives=(limit.objective,))).before
    for point in front.points:
        peak = point.after["drive_torque.peak"]
        assert peak <= before["drive_torque.peak"] * (1 + 1e-6)
    assert np.min(front.values[:, 0]) >= FRONT.values[0, 0] * (1 - 1e-7)


def test_progress_is_told() -> None:
    told: list[tuple[int, int]] = []
    trade_off(MACHINE, FORCE, TORQUE, PLAN, 3, lambda *pair: told.append(pair))
    assert told == [(1, 3), (2, 3), (3, 3)]


def test_what_cannot_be_traded() -> None:
    with pytest.raises(UsageError, match="against itself"):
        trade_off(MACHINE, FORCE, replace(FORCE, weight=2.0), PLAN)
    with pytest.raises(UsageError, match="not drawn over phases"):
        trade_off(MACHINE, FORCE, TORQUE, replace(PLAN, phases=Phases()))
    everything = tuple(float(order) for order in range(100))
    with pytest.raises(UsageError, match="smallest together"):
        trade_off(MACHINE, FORCE, replace(FORCE, orders=everything), PLAN, 2)


def test_nothing_free() -> None:
    with pytest.raises(UsageError, match="nothing is free"):
        trade_off(MACHINE, FORCE, TORQUE)
