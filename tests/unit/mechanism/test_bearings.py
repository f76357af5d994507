"""Bearings in joints: life of rolling ones, pressure of plain ones, and where both are reported."""

from __future__ import annotations

import json
from dataclasses import replace
from math import pi
from typing import Any

import numpy as np
import pytest

import equipoise as eq
from equipoise.errors import ModelError
from equipoise.mechanism.parts.joint_properties import JointProperties, RollingBearing
from equipoise.mechanism.parts.run_plans import DutyState
from equipoise.results.blocks import Table
from equipoise.schema.files import json_text, to_csv
from equipoise.studies.commands import dimension_of
from support.refusals import refused
from surface.running import equipoise
from unit.schema.samples import survives

CATALOGUE = RollingBearing("25.5 kN", "15 kN", life="2000 h", reliability=0.95)
RADIUS, WIDTH = 0.012, 0.02


def engine(kind: Any = "ball") -> eq.Machine:
    """A slider-crank whose crank pin is plain, and whose piston pin, which swings, rolls."""
    bearing = replace(CATALOGUE, kind=kind)
    joints = (
        JointProperties("joints.B", radius=RADIUS, width=WIDTH, bearing=bearing),
        JointProperties("joints.C", bearing=bearing),
    )
    return replace(eq.load("slider-crank-engine"), joints=joints, balance=None)


@pytest.mark.parametrize("kind", ["ball", "roller"])
def test_life_uses_up_step_by_step(kind: str) -> None:
    """Second route: Miner's rule in small steps of time, each at the life that its load has."""
    machine = replace(engine(kind), loads=())  # without the gas, whose force jumps
    fine = eq.analyze(machine, 1440)
    bearings = fine.rolling_bearings
    period = 2 * pi / abs(machine.drive.speed)
    rod = fine.motion.links["rod"].angular_velocity
    crank = fine.motion.links["crank"].angular_velocity
    for name, turning in {"B": rod - crank, "C": rod}.items():
        force = fine.forces.joints[name].size
        life = 1e6 * (25.5e3 / force) ** (3 if kind == "ball" else 10 / 3)
        turned = np.abs(turning) * period / len(force) / (2 * pi)
        assert bearings[name].basic_life == pytest.approx(period / np.sum(turned / life), rel=1e-9)
        assert bearings[name].basic_turns == pytest.approx(
            bearings[name].basic_life / period * np.sum(turned), rel=1e-9
        )
        assert bearings[name].static_safety == pytest.approx(15e3 / np.max(force), rel=1e-9)


DUTY = (
    DutyState(0.5),
    DutyState(1.5, "1200 rpm", 0.4),
    DutyState(2.0, "600 rpm", 0.0),
)


def test_life_over_duty_states_by_hand() -> None:
    """Second route: life of each state alone, from a machine that always works so, and Miner's rule
    over the shares of the time; the table of the analysis says over how many states it is.
    """
    machine = engine()
    assert machine.loads
    shares = np.array([item.share for item in DUTY]) / 4.0
    alone = []
    for state in DUTY:
        loads = tuple(
            replace(load, table=replace(load.table, values=tuple(
                tuple(state.load_factor * value for value in column)
                for column in load.table.values
            ))) if load.table else replace(load, force=tuple(
                state.load_factor * value for value in load.force or ()
            ))
            for load in machine.loads
        )  # fmt: skip
        speed = machine.drive.speed if state.speed is None else state.speed
        slower = replace(machine, loads=loads).with_drive(speed=speed)
        alone.append(eq.analyze(slower).rolling_bearings)
    together = eq.analyze(replace(machine, duty=DUTY))
    for name, actual in together.rolling_bearings.items():
        lives = np.array([item[name].basic_life for item in alone])
        speeds = np.array([item[name].speed for item in alone])
        loads_3 = np.array([item[name].equivalent_load for item in alone]) ** 3
        assert actual.basic_life == pytest.approx(1 / np.sum(shares / lives), rel=1e-9)
        assert actual.speed == pytest.approx(np.sum(shares * speeds), rel=1e-12)
        equivalent = (np.sum(shares * speeds * loads_3) / np.sum(shares * speeds)) ** (1 / 3)
        assert actual.equivalent_load == pytest.approx(equivalent, rel=1e-9)
        assert actual.static_safety == pytest.approx(
            min(item[name].static_safety for item in alone)
        )
    assert set(together.rolling_bearings) == {"B", "C"}
    assert "over 3 duty states" in " ".join(map(str, together.blocks()))
    survives(replace(machine, duty=DUTY))


def test_check_counts_duty_states(tmp_path: Any) -> None:
    eq.save(replace(engine(), duty=DUTY, loads=()), tmp_path / "duty.toml")
    out = equipoise("check", str(tmp_path / "duty.toml")).out
    assert "duty states for the lives of bearings and links: 3" in out


def test_one_duty_state_as_the_machine_runs_changes_nothing() -> None:
    machine = engine()
    bearings = eq.analyze(replace(machine, duty=(DutyState(7.0),))).rolling_bearings
    assert bearings == eq.analyze(machine).rolling_bearings


@pytest.mark.parametrize(
    ("given", "where", "text"),
    [({"share": 0.0}, "share", "0"), ({"share": 1.0, "speed": -2.0}, "speed", "-2 rad/s"),
     ({"share": 1.0, "load_factor": -1.0}, "load_factor", "-1")],
)  # fmt: skip
def test_what_is_wrong_with_a_duty_state_is_refused_at_its_key(
    given: dict[str, float], where: str, text: str
) -> None:
    with refused(ModelError, f"duty[1].{where}", text=text):
        replace(engine(), duty=(DutyState(**given),))


def test_a_bearing_of_the_rating_that_is_needed_reaches_the_life_that_is_wanted() -> None:
    machine = engine()
    needed = eq.analyze(machine).rolling_bearings["C"].needed_rating
    enough = machine.with_number("joints[2].bearing.dynamic_rating", needed)
    bearings = eq.analyze(enough).rolling_bearings["C"]
    assert bearings.rated_life == pytest.approx(2000 * 3600.0)
    assert bearings.reached == pytest.approx(0.95)


def test_a_bearing_without_load_or_turning_has_no_life() -> None:
    slow = eq.analyze(engine(), speed=0.0)
    assert slow.rolling_bearings == {}
    assert eq.analyze(engine(), [0.0, 0.1]).rolling_bearings == {}
    free = engine()
    for link in free.links:
        free = free.with_link(link, mass=0.0, inertia=0.0)
    free = replace(free, gravity=(0.0, 0.0), loads=())
    bearings = eq.analyze(free).rolling_bearings["B"]
    assert (bearings.basic_life, bearings.reached, bearings.needed_rating) == (None, 1.0, 0.0)


def test_pressure_of_a_plain_bearing() -> None:
    analysis = eq.analyze(engine(), 60)
    pressure = analysis.outputs["joints.B.pressure"].values
    np.testing.assert_allclose(pressure, analysis.forces.joints["B"].size / (WIDTH * 2 * RADIUS))
    links = analysis.motion.links
    turning = links["rod"].angular_velocity - links["crank"].angular_velocity
    np.testing.assert_allclose(
        analysis.outputs["joints.B.pressure_speed"].values, pressure * np.abs(turning) * RADIUS
    )
    assert "joints.B.pressure [Pa]" in to_csv(analysis).partition("\n")[0]


@pytest.mark.parametrize("gas", [True, False])
def test_pressure_over_duty_states_by_hand(gas: bool) -> None:
    """Second route: each state alone, from a machine that always works so, and its mean by hand."""
    machine = engine() if gas else replace(engine(), loads=())
    shares = np.array([state.share for state in DUTY]) / 4.0
    alone, means = [], []
    for state in DUTY:
        speed = machine.drive.speed if state.speed is None else state.speed
        slower = replace(machine, loads=state.scaled(machine.loads)).with_drive(speed=speed)
        analysis = eq.analyze(slower)
        alone.append(analysis.plain_bearings["B"])
        turning = analysis.motion.links["rod"].angular_velocity
        turning = turning - analysis.motion.links["crank"].angular_velocity
        force = analysis.forces.joints["B"].size
        means.append(float(np.mean(force * np.abs(turning))) / (2 * WIDTH))
    result = eq.analyze(replace(machine, duty=DUTY))
    (bearing,) = result.plain_bearings.values()
    worst = max(alone, key=lambda item: item.pressure)
    assert (bearing.pressure, bearing.pressure_at) == (worst.pressure, worst.pressure_at)
    warmest = max(alone, key=lambda item: item.pressure_speed)
    assert bearing.pressure_speed == warmest.pressure_speed
    assert bearing.pressure_speed_at == warmest.pressure_speed_at
    # the force of the gas jumps between two of the 360 crank angles of a mean by hand
    near = pytest.approx(shares @ means, rel=1 / 360 if gas else 1e-12)
    assert bearing.mean_pressure_speed == near
    assert "Plain bearings in joints, over 3 duty states" in " ".join(map(str, result.blocks()))
    same = eq.analyze(replace(machine, duty=(DutyState(7.0),))).plain_bearings
    assert same == eq.analyze(machine).plain_bearings
    assert [*eq.analyze(machine, [0.0, 0.1]).plain_bearings] == ["B"]
    assert dimension_of(machine, "analyze", "plain_bearings.B.pressure_at") == "angle"


def test_they_change_neither_motion_nor_forces_and_survive() -> None:
    machine, bare = engine(), replace(engine(), joints=())
    text = survives(machine)
    assert 'bearing.dynamic_rating = "25500 N"' in text
    given, free = (eq.analyze(item, 36) for item in (machine, bare))
    np.testing.assert_array_equal(given.forces.joints["B"].value, free.forces.joints["B"].value)
    assert machine.without_friction() == machine


def test_they_are_reported_everywhere() -> None:
    machine = engine()
    analysis = eq.analyze(machine, 90)
    content = json.loads(json_text(analysis.to_dict()))["rolling_bearings"]["C"]
    assert content["basic_life"] == analysis.rolling_bearings["C"].basic_life
    assert dimension_of(machine, "analyze", "rolling_bearings.C.basic_life") == "time"
    assert dimension_of(machine, "analyze", "joints.B.pressure.max") == "modulus"
    titles = [block.title for block in analysis.blocks() if isinstance(block, Table)]
    assert "Rolling bearings in joints" in titles
    assert "Plain bearings in joints; largest with its crank angle" in titles


def test_check_prints_them(tmp_path: Any) -> None:
    eq.save(engine(), tmp_path / "engine.toml")
    out = equipoise("check", str(tmp_path / "engine.toml")).out
    assert "joints.C, ball bearing of 25.50 kN, for 2000 h" in out
    assert "joints.B, radius 12.00 mm, width 20.00 mm" in out


WRONG: list[tuple[dict[str, Any], dict[str, Any]]] = [
    ({"joint": "joints.B", "width": 0.02}, {"place": "joints[1].radius"}),
    (
        {"joint": "joints.piston on frame", "bearing": CATALOGUE},
        {"place": "joints[1].bearing", "joint": "joints.piston on frame"},
    ),
    (
        {"joint": "joints.B", "bearing": RollingBearing(0.0)},
        {"place": "joints[1].bearing.dynamic_rating", "text": "0 N"},
    ),
    (
        {"joint": "joints.B", "bearing": RollingBearing(1.0, reliability=1.0)},
        {"place": "joints[1].bearing.reliability", "text": 1},
    ),
    (
        {"joint": "joints.B", "bearing": RollingBearing(1.0, kind="needle")},  # type: ignore[arg-type]
        {"place": "joints[1].bearing.kind", "leaf": "needle"},
    ),
]


@pytest.mark.parametrize(("given", "expected"), WRONG)
def test_what_is_no_such_bearing_is_refused(
    given: dict[str, Any], expected: dict[str, Any]
) -> None:
    with refused(ModelError, **expected):
        eq.mechanism.assemble(replace(engine(), joints=(JointProperties(**given),)))


def test_a_pin_in_a_slot_has_none() -> None:
    machine = eq.load("baler-pickup")
    slot = next(iter(machine.riders))
    given = JointProperties(f"joints.{slot}", bearing=CATALOGUE)
    with refused(ModelError, "joints[1].bearing"):
        eq.mechanism.assemble(replace(machine, joints=(given,)))
