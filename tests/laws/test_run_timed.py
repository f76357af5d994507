"""Runs under loads over time: closed forms, inverse dynamics, and what sets a machine in motion."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import equipoise as eq
from equipoise.errors import ModelError
from equipoise.mechanism import JointProperties, Load, Motor, Row, TimedLoad
from support.refusals import refused
from unit.schema.samples import survives

INERTIA, TORQUE = 2.0, 3.0
"""Of a wheel, kg m2, and of the load on it, N m."""
TIMES, FACTORS = (1.0, 2.0, 4.0), (0.0, 1.0, 1.0)
ENGINE = replace(eq.load("slider-crank-engine"), balance=None, loads=(), support=None)


def wheel(times: Any = TIMES, factors: Any = FACTORS, drag: float = 0.0) -> eq.Machine:
    """A wheel that a torque over time turns."""
    link = eq.Link({"A": (0.0, 0.0)}, 1.0, (0.0, 0.0), INERTIA)
    joints = (JointProperties("joints.A", drag_torque=drag),) if drag else ()
    load = TimedLoad("wheel", times, factors, torque=TORQUE)
    return eq.Machine("wheel", eq.Drive("wheel", 1.0), {"A": (0.0, 0.0)}, {"wheel": link},
                      timed_loads=(load,), joints=joints)  # fmt: skip


def test_a_wheel_follows_the_integral_of_its_load() -> None:
    """A ramp of a second, two seconds of full torque, then none: it waits at rest for the first."""
    run = eq.run(wheel(), "5 s", speed=0.0)
    rate = TORQUE / INERTIA

    def speed(time: float) -> float:
        ramp, full = np.clip(time - 1, 0, 1), np.clip(time - 2, 0, 2)
        return float(rate * (ramp**2 / 2 + full))

    wanted = [speed(time) for time in run.time]
    np.testing.assert_allclose(run.crank_speed, wanted, atol=1e-12 * max(wanted))
    assert run.crank_angle[-1] == pytest.approx(
        rate * (1 / 6 + 0.5 * 3 + (2**2 / 2 + 2 * 1)), rel=1e-12
    )
    assert run.energy_error < 1e-12
    assert run.work["timed_loads"][-1] == pytest.approx(INERTIA * wanted[-1] ** 2 / 2)


def test_friction_holds_it_until_the_load_is_large_enough() -> None:
    run = eq.run(wheel(drag=0.6), "5 s", speed=0.0)
    first = run.time[np.argmax(run.crank_angle > 0) - 1]
    assert first == pytest.approx(1 + 0.6 / TORQUE, abs=1e-8)  # rounding of the torque at rest
    end = (TORQUE * 0.8**2 / 2 + 2 * (TORQUE - 0.6) - 0.6) / INERTIA
    assert run.crank_speed[-1] == pytest.approx(end, rel=1e-9)


def test_what_begins_suddenly_begins_at_its_time() -> None:
    run = eq.run(wheel((0.5, 1.5), (1.0, 1.0)), "2 s", speed=0.0)
    assert run.crank_speed[-1] == pytest.approx(TORQUE / INERTIA, rel=1e-12)
    assert run.crank_angle[-1] == pytest.approx(TORQUE / INERTIA * (0.5 + 0.5), rel=1e-12)


def test_a_load_too_small_to_move_it_leaves_it_at_rest() -> None:
    assert eq.run(wheel(drag=4.0), speed=0.0).end.kind == "standstill"


def test_a_load_still_growing_at_the_end_sets_it_in_motion() -> None:
    """The last row comes after the end of the run."""
    run = eq.run(wheel((1.0, 11.0), (0.0, 10.0), drag=0.6), "3 s", speed=0.0)
    free = 1 + 0.6 / TORQUE
    assert run.end.kind == "time" and run.end.time == 3.0
    assert run.crank_speed[-1] == pytest.approx(TORQUE * (3 - free) ** 2 / 2 / INERTIA, rel=1e-9)


def test_a_load_that_begins_at_the_end_moves_nothing() -> None:
    run = eq.run(wheel((2.0, 3.0), (1.0, 1.0)), "2 s", speed=0.0)
    assert run.end.kind == "standstill" and not run.turned


def test_a_motor_held_until_it_is_switched_off_does_not_start_later() -> None:
    """A load holds it for 2 s; it is off after 1 s."""
    machine = wheel((0.0, 2.0), (-3.0, -3.0)).with_drive(motor=Motor(10.0, 4.0, mean_speed="free"))
    assert eq.run(machine, "6 s", speed=0.0, off="3 s").crank_speed[-1] > 0
    run = eq.run(machine, "6 s", speed=0.0, off="1 s")
    assert run.end.kind == "stall" and not run.turned


def test_a_run_goes_on_as_long_as_a_load_is_to_come() -> None:
    """A motor is steady long before a load comes, which the run ends after."""
    machine = wheel((3.0, 3.5, 4.0), (0.0, -1.0, 0.0))
    machine = machine.with_drive(motor=Motor(10.0, 40.0, mean_speed="free"))
    run = eq.run(machine)
    assert run.end.kind == "steady" and run.time[-1] > 4.0
    slowest = np.min(run.crank_speed[run.time > 3.0])
    assert slowest < 0.99 * run.crank_speed[-1]


BETWEEN = (
    TimedLoad("rod", (0.0, 0.02, 0.05), (0.0, 1.0, 0.4), point="C", on="crank", axes="link",
              force=(80.0, -150.0)),
    TimedLoad("rod", (0.01, 0.03), (0.5, 1.0), on="crank", torque=4.0),
)  # fmt: skip
RUBBING = (JointProperties("joints.B", radius=0.02, friction=0.08),
           JointProperties("joints.piston on frame", friction=0.1))  # fmt: skip


@pytest.mark.parametrize("joints", [(), RUBBING], ids=["free", "rubbing"])
@pytest.mark.parametrize("rows", [(), (Row(), Row(phase=2.0))], ids=["one row", "two rows"])
def test_between_links_it_is_a_load_on_each(rows: Any, joints: Any) -> None:
    """At any instant the acceleration is that at which inverse dynamics, with both ends as loads
    of then on their links, needs no torque.
    """
    machine = replace(ENGINE, timed_loads=BETWEEN, rows=rows, joints=joints)
    run = eq.run(machine, speed=100.0, turns=1)
    assert run.energy_error < 1e-9
    assert abs(run.work["timed_loads"][-1]) > 0.1
    equation, compared = run.equation, 0
    alone = replace(machine, rows=(), timed_loads=())
    for k in np.linspace(1, len(run.time) - 2, 15).astype(int):
        angle, speed, time = (float(values[k]) for values in
                              (run.crank_angle, run.crank_speed, run.time))  # fmt: skip
        if np.min(np.abs(equation.edges - angle)) < 1e-6:
            continue
        factors = [np.interp(time, load.times, load.factors, left=0, right=0) for load in BETWEEN]
        inertia, slope, torques = equation.at(angle, speed, 0.0, 1.0, factors)
        rate = (float(np.sum(torques)) - slope * speed**2 / 2) / inertia
        asked, size = 0.0, inertia * abs(rate) + float(np.max(np.abs(torques)))
        for phase in [row.phase for row in rows] or [0.0]:
            motion = eq.move(machine, [angle + phase])
            turn = np.exp(1j * float(motion.links["rod"].angle[0]))
            force = complex(*BETWEEN[0].force or ()) * turn * factors[0]
            place = complex(motion.points["C"].place[0])
            crank = motion.links["crank"]
            own = complex(motion.points["B"].place[0])
            arm = np.exp(1j * float(crank.angle[0]))
            local = (place - own) / arm + complex(*machine.links["crank"].points["B"])
            points = {**alone.links["crank"].points, "end": (local.real, local.imag)}
            links = {**alone.links, "crank": alone.links["crank"].altered(points=points)}
            loads = (
                Load("rod", point="C", force=(force.real, force.imag)),
                Load("crank", point="end", force=(-force.real, -force.imag)),
                Load("rod", torque=4.0 * factors[1]),
                Load("crank", torque=-4.0 * factors[1]),
            )
            loaded = replace(alone, links=links, loads=loads)
            forces = eq.analyze(loaded, [angle + phase], speed, rate).forces
            asked += float(forces.drive_torque[0])
        assert abs(asked) < 1e-9 * size
        compared += 1
    assert compared > 8


def test_analyses_leave_it_out_and_files_keep_it() -> None:
    machine = replace(ENGINE, timed_loads=BETWEEN)
    survives(machine)
    bare, loaded = (eq.analyze(item, 12).forces.drive_torque for item in (ENGINE, machine))
    np.testing.assert_array_equal(bare, loaded)


@pytest.mark.parametrize(
    ("given", "expected"),
    [
        ({}, {"place": "timed_loads[1]"}),
        ({"torque": 1.0, "force": (1.0, 0.0)}, {"place": "timed_loads[1]"}),
        ({"force": (1.0, 0.0)}, {"place": "timed_loads[1].point"}),
        ({"torque": 1.0, "on": "rod"}, {"place": "timed_loads[1].on", "link": "rod"}),
        ({"torque": 1.0, "point": "C"}, {"place": "timed_loads[1].point"}),
        ({"torque": 1.0, "axes": "link"}, {"place": "timed_loads[1].axes"}),
        (
            {"torque": 1.0, "times": (1.0,)},
            {
                "place": "timed_loads[1].times",
                "others": 2,
                "count": 1,
            },
        ),
        ({"torque": 1.0, "times": (1.0, 1.0)}, {"place": "timed_loads[1].times", "what": "times"}),
        ({"torque": 1.0, "times": (-1.0, 1.0)}, {"place": "timed_loads[1].times"}),
    ],
)
def test_what_is_wrong_is_said(given: dict[str, Any], expected: dict[str, Any]) -> None:
    load = TimedLoad("rod", **{"times": (0.0, 1.0), "factors": (0.0, 1.0)} | given)
    with refused(ModelError, **expected):
        replace(ENGINE, timed_loads=(load,))
