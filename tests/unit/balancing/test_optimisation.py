"""Plans at the edge, what is balanced where nothing is asked, and trade-off curves.

Values are read off machines, which solvers bring to 1e-8 of the value before.
"""

from __future__ import annotations

import json
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

import equipoise as eq
from equipoise.balancing.design_variables import AddedWeight
from equipoise.balancing.pareto import Front, trade_off
from equipoise.errors import UsageError
from equipoise.mechanism.parts.balance import (
    AddedMass,
    Balance,
    CenterMove,
    GearedWeight,
    Limit,
    Objective,
    Phases,
    SpringChoice,
    Weight,
)
from equipoise.mechanism.parts.links import Bearing
from support.chosen import EXHAUSTIVE, few
from support.refusals import refused
from support.sentences import notes_by

MACHINE = eq.load("yamashita-1")
PLATE = {"thickness": 0.02, "density": 7850.0}


def pump() -> eq.Machine:
    """A slider-crank without shaking moment about its pivot: a rod of two mass points."""
    machine = eq.load("balance-shafts").with_balance(None)
    rod = machine.links["rod"]
    center = rod.center_of_mass
    assert rod.mass is not None and center is not None
    inertia = rod.mass * center[0] * (0.1 - center[0])
    return replace(machine.with_link("rod", inertia=inertia), gravity=(0.0, 0.0))


@pytest.mark.parametrize("at_most", [0.5, 5.0, 50.0])
def test_a_limit_on_what_is_0_before(at_most: float) -> None:
    moment = Objective("shaking_moment", "peak")
    plan = Balance(
        moves=(CenterMove("rod", x=(0.0, 0.1), y=(-0.02, 0.02)),),
        objectives=(Objective("shaking_force"),),
        limits=(Limit(moment, at_most=at_most),),
    )
    balanced = eq.balance(pump(), plan)
    assert balanced.cost < 1
    assert balanced.after["shaking_moment.peak"] <= at_most * (1 + 1e-7)
    assert balanced.gap < 1e-8


def test_a_share_of_what_is_0_before() -> None:
    limit = Limit(Objective("shaking_moment", "peak"), ratio=1.1)
    plan = Balance(
        moves=(CenterMove("rod"),), objectives=(Objective("shaking_force"),), limits=(limit,)
    )
    with refused(UsageError, name="peak of shaking_moment"):
        eq.balance(pump(), plan)


def test_what_makes_no_difference_stays() -> None:
    """The crank's centre of mass does nothing to the moment about its pivot."""
    moves = tuple(CenterMove(link) for link in ("crank", "coupler", "rocker"))
    plan = Balance(moves=moves, objectives=(Objective("shaking_moment", "peak"),))
    balanced = eq.balance(MACHINE, plan)
    assert balanced.changes[0].values["to"] == pytest.approx((0.012, 0.0), abs=1e-12)
    assert balanced.changes[1].values["to"] != pytest.approx((-0.05, -0.02), abs=1e-3)


@pytest.mark.parametrize("shape", ["any", "point", "disc", "sector"])
def test_no_mass_without_use(shape: str) -> None:
    """A force in the coupler's pin knows nothing of the crank."""
    cut = PLATE if shape in {"disc", "sector"} else {}
    masses = tuple(
        AddedMass(link, at, Weight(shape, 0.05, **cut))  # type: ignore[arg-type]
        for link, at in (("rocker", "D"), ("crank", "A"))
    )
    balanced = eq.balance(
        MACHINE, Balance(masses=masses, objectives=(Objective("joints.B", "peak"),))
    )
    assert balanced.changes[1].values["mass"] == pytest.approx(0.0, abs=1e-6)


@pytest.mark.parametrize("shape", ["any", "point", "disc", "sector"])
def test_the_least_mass_of_a_moment(shape: str) -> None:
    """One that is only pushed to the edge of its room where that is what the moment needs."""
    cut = PLATE if shape in {"disc", "sector"} else {}
    weight = Weight(shape, 0.1, **cut)  # type: ignore[arg-type]
    plan = Balance(
        masses=(AddedMass("crank", "A", weight),), objectives=(Objective("shaking_force.y"),)
    )
    balanced = eq.balance(MACHINE, plan)
    change = balanced.changes[0].values
    assert change["moment"] == pytest.approx(0.0408822, rel=1e-4)
    mass, moment = change["mass"], change["moment"]
    if shape in {"any", "point"}:
        assert mass == pytest.approx(moment / 0.1, rel=1e-6)
    elif shape == "disc":
        radius = np.sqrt(mass / (np.pi * 0.02 * 7850))
        assert moment / mass + radius == pytest.approx(0.1, rel=1e-6)
    else:
        (piece,) = change["pieces"]
        assert 2 / 3 * 0.02 * 7850 * 0.1**3 * np.sin(piece["angle"] / 2) == pytest.approx(moment)


@EXHAUSTIVE
def test_teeth_with_a_range_of_directions() -> None:
    weight = Weight("any", 0.05, at_most=0.4)
    geared = GearedWeight("rocker", weight, teeth=(39, 40), module=0.0025, direction=(0.0, 1.0))
    force = Objective("joints.O4")
    balanced = eq.balance(eq.load("lee-kim-b"), Balance(geared=(geared,), objectives=(force,)))
    assert balanced.changes[0].values["teeth"][0] in range(39, 41)
    assert str(balanced.scope[-1]) == "for each of the gears tried"
    assert balanced.cost < 1


def test_gears_report_their_mass() -> None:
    weight = Weight("any", 0.05, at_most=0.4)
    geared = GearedWeight("rocker", weight, (0.6, 0.6), pitch_radius=0.05, gear_thickness=0.006,
                          gear_density=7850.0)  # fmt: skip
    moment = Objective("shaking_moment")
    balanced = eq.balance(eq.load("lee-kim-a"), Balance(geared=(geared,), objectives=(moment,)))
    on_driver, on_shaft = balanced.changes[0].values["masses"]
    assert on_driver == pytest.approx(np.pi * 0.05**2 * 0.006 * 7850)
    assert on_shaft == pytest.approx(on_driver / 0.36)
    weights = balanced.changes[1].values["mass"]
    assert balanced.added_mass == pytest.approx(on_driver + on_shaft + weights)


def test_what_was_stopped_is_reported() -> None:
    """An endless mass close to its axis would do better still."""
    geared = GearedWeight("rocker", Weight("any", 0.065), (0.6, 0.6), pitch_radius=0.05)
    plan = Balance(geared=(geared,), objectives=(Objective("shaking_moment"),))
    balanced = eq.balance(eq.load("lee-kim-a"), plan)
    assert [*map(str, balanced.scope)] == ["within where it was stopped"]
    assert notes_by(AddedWeight.stopped, balanced.notes, "link")


def test_a_spring_without_free_length() -> None:
    machine = eq.load("balance-spring").with_balance(None)
    plan = Balance(
        springs=(SpringChoice("rocker", "F", "S", 1e4),),
        objectives=(Objective("drive_torque", "peak"),),
    )
    balanced = eq.balance(machine, plan)
    assert 0 <= balanced.machine.springs[0].free_length < 0.5
    assert balanced.objectives["peak of drive_torque"][1] < 0.6


@pytest.mark.parametrize("order", [999.0, 1.5])
def test_orders_that_there_are_not(order: float) -> None:
    plan = Balance(
        moves=(CenterMove("coupler"),),
        objectives=(Objective("shaking_force.y", orders=(order,)),),
    )
    with refused(UsageError, order=order):
        eq.balance(MACHINE, plan)


# Limits on gauges: `test_a_limit_is_kept_and_has_its_price` of test_effects.py.
@pytest.mark.exhaustive
@pytest.mark.parametrize("ratio", few((0.45, 0.5), (0.45,)))
def test_a_limit_on_a_gauge_is_kept_where_it_is_read(ratio: float) -> None:
    """Added mass makes the support heavier: what counts is the machine that comes out."""
    machine = eq.load("balance-rig")
    assert machine.balance is not None
    gauge, joint = machine.balance.objectives[0], Objective("joints.A", "peak")
    plan = Balance(
        masses=machine.balance.masses, objectives=(joint,), limits=(Limit(gauge, ratio=ratio),)
    )
    balanced = eq.balance(machine, plan)
    price = balanced.prices[gauge.name]
    assert price.used == pytest.approx(price.at_most, rel=1e-7)
    assert price.active
    assert balanced.gap < 1e-8


def test_the_ends_of_a_front() -> None:
    """At the far end the second is least, and of all those the first."""
    rocker = AddedMass("rocker", "D", Weight("any", 0.05, at_most=0.5))
    crank = AddedMass("crank", "A", Weight("any", 0.05, at_most=0.5))
    first, second = Objective("shaking_force", "peak"), Objective("joints.D")
    plan = Balance(masses=(rocker, crank))
    front = eq.balancing.trade_off(MACHINE, first, second, plan, points=4)
    alone = eq.balance(MACHINE, replace(plan, objectives=(second,)))
    least = alone.objectives[second.name][1]
    assert front.values[-1, 1] == pytest.approx(least, rel=1e-7)
    assert np.all(np.diff(front.values[:, 0]) > 0)
    assert np.all(np.diff(front.values[:, 1]) < 1e-9)
    assert front.gap < 1e-8


def test_flanks_of_gears_are_those_of_the_result() -> None:
    """A weight that turns the tooth force round changes the flank, and the bearing's force."""
    machine = eq.load("geared-counterweight")
    weight = Weight("any", 0.08, at_most=0.5)
    masses = (AddedMass("counterweight", "E", weight), AddedMass("rocker", "O4", weight))
    bearing = Objective("joints.E")
    balanced = eq.balance(machine, Balance(masses=masses, objectives=(bearing,)))
    force = eq.forces(eq.move(balanced.machine, 720)).joints["E"].size
    after = balanced.objectives[bearing.name][1]
    assert after == pytest.approx(np.sqrt(np.mean(force**2)))
    assert after < 8.44135
    assert balanced.gap < 1e-8
    assert [*map(str, balanced.scope)] == [
        "for the flanks of teeth and strands of chains that bear here"
    ]


def test_flanks_of_gears_count_in_bearings_too() -> None:
    """What a bearing bears changes with the flank as the force in its joint does."""
    machine = eq.load("geared-counterweight").with_link("counterweight", plane=0.02)
    bearings = {"left": Bearing("counterweight", -0.05), "right": Bearing("counterweight", 0.08)}
    weight = Weight("any", 0.08, at_most=0.5)
    masses = (AddedMass("counterweight", "E", weight), AddedMass("rocker", "O4", weight))
    plan = Balance(masses=masses, objectives=(Objective("bearings.left"),))
    balanced = eq.balance(replace(machine, bearings=bearings), plan)
    assert balanced.gap < 1e-8
    assert [*map(str, balanced.scope)] == [
        "for the flanks of teeth and strands of chains that bear here"
    ]


FORCE, TORQUE = Objective("shaking_force", "peak"), Objective("drive_torque", "rms")
PLAN = Balance(
    masses=(
        AddedMass("crank", "A", Weight("any", 0.06, at_most=0.8)),
        AddedMass("rocker", "D", Weight("any", 0.06, at_most=0.5)),
    )
)


@cache
def traded() -> Front:
    return trade_off(MACHINE, FORCE, TORQUE, PLAN, points=9)


def best(item: Objective) -> float:
    balanced = eq.balance(MACHINE, replace(PLAN, objectives=(item,)))
    return balanced.objectives[item.name][1]


def test_falls_and_bends_inwards() -> None:
    first, second = traded().values.T
    assert np.all(np.diff(first) > 0)
    assert np.all(np.diff(second) < 1e-8 * second[0])
    slopes = np.diff(second) / np.diff(first)
    assert np.all(np.diff(slopes) > -1e-6 * abs(slopes[0]))
    assert slopes[0] < 2 * slopes[-1] < 0


def test_ends_are_the_single_optima() -> None:
    """The first is let go by 1e-4 of the range, so that the second has room to move."""
    least, most = traded().values[[0, -1], 0]
    assert least == pytest.approx(best(FORCE), abs=1.01e-4 * (most - least))
    assert traded().values[-1, 1] == pytest.approx(best(TORQUE), rel=1e-6)


def test_each_point_is_proved_and_kept_to_its_limit() -> None:
    assert traded().gap < 1e-8
    assert traded().gap == max(point.gap for point in traded().points)
    for point, (first, second) in zip(traded().points[:-1], traded().values, strict=False):
        price = point.prices[FORCE.name]
        assert first == pytest.approx(price.used)
        assert price.used <= price.at_most * (1 + 1e-7)
        assert point.objectives[TORQUE.name][1] == pytest.approx(second)


def test_prices_are_slopes_of_the_curve() -> None:
    """Of a convex curve: between the slopes to either side."""
    first, second = traded().values.T
    slopes = -np.diff(second) / np.diff(first)
    for k in range(1, 7):
        price = traded().points[k].prices[FORCE.name].price
        assert slopes[k] * (1 - 1e-3) <= price <= slopes[k - 1] * (1 + 1e-3)


def test_nothing_lies_below_the_curve() -> None:
    """Weighted sums of both, whose optima touch it from below."""
    before = [eq.balance(MACHINE, replace(PLAN, objectives=(item,))).objectives[item.name][0]
              for item in (FORCE, TORQUE)]  # fmt: skip
    for weight in (0.3, 1.0, 3.0):
        both = (FORCE, replace(TORQUE, weight=weight))
        balanced = eq.balance(MACHINE, replace(PLAN, objectives=both))
        sums = traded().values[:, 0] / before[0] + weight * traded().values[:, 1] / before[1]
        assert balanced.cost <= np.min(sums) + 1e-8
        assert balanced.cost == pytest.approx(np.min(sums), rel=0.01)


def test_columns_and_dictionary() -> None:
    (first, unit, values), (second, other, _), (mass, kilogram, masses) = traded().columns()
    assert (first, second, mass) == (FORCE.name, TORQUE.name, "added mass")
    assert (unit, other, kilogram) == ("N", "N m", "kg")
    assert np.array_equal(values, traded().values[:, 0])
    assert masses[3] == traded().points[3].added_mass
    content = json.loads(json.dumps(traded().to_dict()))
    assert set(content["before"]) == {FORCE.name, TORQUE.name}
    assert content["before"][FORCE.name] > content["points"][0]["first"]
    assert [point["second"] for point in content["points"]] == traded().values[:, 1].tolist()
    assert content["points"][2]["changes"][0]["link"] == "crank"


def test_limits_of_the_plan_are_kept() -> None:
    limit = Limit(Objective("drive_torque", "peak"), ratio=1.0)
    front = trade_off(MACHINE, FORCE, TORQUE, replace(PLAN, limits=(limit,)), points=3)
    before = eq.balance(MACHINE, replace(PLAN, objectives=(limit.objective,))).before
    for point in front.points:
        peak = point.after["drive_torque.peak"]
        assert peak <= before["drive_torque.peak"] * (1 + 1e-6)
    assert np.min(front.values[:, 0]) >= traded().values[0, 0] * (1 - 1e-7)


def test_progress_is_reported() -> None:
    texts: list[tuple[int, int]] = []
    trade_off(MACHINE, FORCE, TORQUE, PLAN, 3, lambda *pair: texts.append(pair))
    assert texts == [(1, 3), (2, 3), (3, 3)]


def test_what_cannot_be_traded() -> None:
    with refused(UsageError, name="peak of shaking_force"):
        trade_off(MACHINE, FORCE, replace(FORCE, weight=2.0), PLAN)
    with refused(UsageError, by="trade_off"):
        trade_off(MACHINE, FORCE, TORQUE, replace(PLAN, phases=Phases()))
    everything = tuple(float(order) for order in range(100))
    with refused(UsageError, name="peak of shaking_force"):
        trade_off(MACHINE, FORCE, replace(FORCE, orders=everything), PLAN, 2)


def test_nothing_free() -> None:
    with refused(UsageError, by="_checked"):
        trade_off(MACHINE, FORCE, TORQUE)
