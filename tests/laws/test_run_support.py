"""Runs on a support: known motions, outputs, the table of the file, and what is refused."""

from __future__ import annotations

from dataclasses import replace
from math import pi
from typing import Any

import numpy as np
import pytest

import equipoise as eq
from equipoise.errors import EquipoiseError, ModelError
from equipoise.figures.time_charts import drives_charts
from equipoise.mechanism.parts.machine import FurtherDrive
from equipoise.mechanism.parts.motors import Motor
from equipoise.mechanism.parts.run_plans import RunPlan, TimedLoad
from equipoise.mechanism.parts.support import FREEDOMS, Mount, Support
from equipoise.running.blocks import drives_blocks, drives_headline
from equipoise.running.run_results import DrivesRun
from equipoise.running.support_equation import SupportedEquation
from support.refusals import refused

PITCH = FREEDOMS.index("pitch")
ROTOR, OWN, STIFF = 0.02, 0.5, 30.0
SPRING = {"spring": Mount(axis="pitch", torsional_stiffness=STIFF, preload=0.0)}


def wheels(motor: Motor | None = None, **support: Any) -> eq.Machine:
    """Two balanced wheels on a support that swings about their first pivot."""
    links = {
        "left": eq.Link({"A": (0.0, 0.0), "C": (0.2, 0.0)}, 1.0, (0.0, 0.0), 0.05),
        "right": eq.Link({"B": (0.0, 0.0), "D": (0.2, 0.0)}, 1e-9, (0.0, 0.0), 1e-9),
    }
    given = {"mounts": SPRING, "pivot": (0.0, 0.0), "pivot_inertia": OWN, **support}
    return eq.Machine(
        "wheels", eq.Drive("left", 30.0, motor=motor, free=motor is None),
        {"A": (0.0, 0.0), "B": (0.4, 0.0)}, links,
        drives=(FurtherDrive("right", free=True),), gravity=(0.0, 0.0),
        support=Support(4.0, (0.0, 0.0, 0.0), **given),
    )  # fmt: skip


def on_support(machine: eq.Machine, *args: Any, **kwargs: Any) -> DrivesRun:
    run = eq.run(machine, *args, support=True, **kwargs)
    assert isinstance(run, DrivesRun)
    return run


def test_the_reaction_of_a_motor_swings_the_support() -> None:
    """A constant torque T on a balanced wheel: k beta = -T (1 - cos(w t)) with w^2 = k / J, and
    J without the rotor and the wheel, which turn by the torque alone against space.
    """
    torque = 2.0
    motor = Motor(1e9, torque)  # flat where the wheel turns
    run = on_support(wheels(motor), 1.0)
    assert run.support is not None
    rate = np.sqrt(STIFF / OWN)
    wanted = -torque / STIFF * (1 - np.cos(rate * run.time))
    np.testing.assert_allclose(run.support.place[PITCH], wanted, atol=1e-8)
    in_space = run.drives["left"].speed + run.support.rate[PITCH]
    np.testing.assert_allclose(in_space, torque / 0.05 * run.time, atol=1e-6)
    assert run.energy_error < 1e-9


def test_a_rotor_turns_its_support_back() -> None:
    """Without mounts the moment of momentum of support, wheel and rotor stays 0."""
    film = {"film": Mount(axis="pitch", torsional_damping=1e-15)}
    ratio = 5.0
    motor = Motor(100.0, 1.0, ratio=ratio, inertia=ROTOR, mean_speed="free")
    run = on_support(wheels(motor, mounts=film), 0.5)
    assert run.support is not None
    turning, speed = run.support.rate[PITCH], run.drives["left"].speed
    momentum = OWN * turning + 0.05 * (speed + turning) + ratio * ROTOR * speed
    # the small wheel weighs 1e-9 kg, 0.4 m away
    np.testing.assert_allclose(momentum, 0, atol=1e-8 * np.max(np.abs(speed)))
    assert np.min(turning) < -1


def test_a_support_falls_onto_its_feet_and_bounces() -> None:
    """Free fall through a gap, springs without damping, and up again to the same height."""
    gap, stiffness, gravity, mass = 0.02, 4000.0, 9.81, 5.0 + 1e-9
    feet = {
        name: Mount((x, 0.0, 0.0), stiffness=stiffness / 2, preload=-gap * stiffness / 2,
                    one_sided=True)
        for name, x in (("left", -0.3), ("right", 0.3))
    }  # fmt: skip
    support = {"mounts": feet, "pivot": None, "pivot_inertia": None, "inertia": (0.2,),
               "freedoms": ("heave",)}  # fmt: skip
    machine = replace(wheels(**support), gravity=(0.0, -gravity))
    run = on_support(machine, 0.8, speed=0.0)
    assert run.support is not None
    fall, speed, rate = np.sqrt(2 * gap / gravity), np.sqrt(2 * gap * gravity), stiffness / mass
    rate = np.sqrt(rate)
    contact = 2 * (pi - np.arctan(speed * rate / gravity)) / rate
    time = run.time % (2 * fall + contact)
    time = np.minimum(time, 2 * fall + contact - time)  # up as down
    pressed = rate * (time - fall)
    below = -gravity / rate**2 * (1 - np.cos(pressed)) - speed / rate * np.sin(pressed)
    wanted = np.where(time < fall, -gravity * time**2 / 2, -gap + below)
    np.testing.assert_allclose(run.support.place[1], wanted, atol=1e-9)
    assert run.time[-1] > 2 * (2 * fall + contact)
    assert np.min(run.support.mounts["left"]) == 0 < np.max(run.support.mounts["left"])
    left = [item for item in run.contacts if item.part == "mounts.left"]
    assert [left[0].begin, left[0].end] == pytest.approx([fall, fall + contact], rel=1e-7)
    assert max(item.force for item in left) == np.max(run.support.mounts["left"])


def test_a_run_on_its_support_reports_gauges_and_mounts() -> None:
    machine = eq.load("balance-rig")
    run = on_support(machine, "0.3 s")
    names = [name for name, _, _ in run.columns()]
    assert {"gauges.gauge.displacement", "mounts.spring.force", "work.mounts"} <= {*names}
    units = {name: unit for name, unit, _ in run.columns()}
    assert (units["gauges.gauge.displacement"], units["mounts.bearing.force"]) == ("m", "N m")
    values = run.to_dict()
    assert run.support is not None
    np.testing.assert_allclose(
        values["gauges"]["gauge"]["displacement"], run.support.gauges["gauge"], rtol=1e-12
    )
    assert set(values["mounts"]) == {"spring", "bearing"}
    assert {*drives_charts(run)} == {"speed", "gauges", "mounts"}
    tables = {getattr(block, "title", ""): block for block in drives_blocks(run)}
    rows = [row[0] for row in tables["Gauges and mounts"].rows]
    assert rows == ["gauge", "spring", "bearing"]
    assert "mounts" in [row[0] for row in tables["Energy from the start to the end"].rows]


def test_its_summary_has_what_gauges_read() -> None:
    run = on_support(eq.load("sieve"), "0.1 s")
    assert run.support is not None
    (facts,) = (block for block in drives_headline(run, alone=True) if hasattr(block, "items"))
    texts = [block.text for block in drives_headline(run) if hasattr(block, "text")]
    assert any("no motor" in text for text in texts)
    assert [line.partition(":")[0] for line in facts.items] == [*run.support.gauges]
    size = 1e3 * float(np.ptp(run.support.gauges["stand"]))
    assert facts.items[0] == f"stand: {size:.3g} mm"


def test_the_file_says_whether_the_support_moves() -> None:
    machine = eq.load("balance-rig")
    planned = replace(machine, run=RunPlan(duration=0.1, support=True))
    run = eq.run(planned)
    assert isinstance(run, DrivesRun) and run.support is not None
    assert isinstance(eq.run(planned, support=False), eq.running.Run)


def test_rest_is_that_of_the_exact_model() -> None:
    machine = eq.load("balance-rig")
    run = on_support(machine, "0.05 s")
    assert isinstance(run.equation, SupportedEquation)
    preloads = eq.modes(machine).preloads
    contacts = run.equation.mounted.contacts
    assert {item.name: item.preload for item in contacts} == dict(preloads)


def test_a_crank_without_motor_coasts_on_its_support() -> None:
    machine = eq.load("balance-rig")
    machine = replace(machine, drive=replace(machine.drive, motor=None))
    run = on_support(machine, "0.5 s")
    speed = run.drives["crank"].speed
    assert speed[0] == pytest.approx(machine.drive.speed)
    assert np.ptp(speed) > 0.01 * speed[0]
    assert run.drives["crank"].moved_by == "free"


def test_turns_of_a_crank_that_starts_beside_the_speed_0_of_the_file() -> None:
    machine = eq.load("balance-rig")
    machine = replace(machine, drive=replace(machine.drive, motor=None, speed=0.0))
    run = on_support(machine, turns=0.1, speed="30 rpm")
    assert run.end.kind == "turns"
    assert abs(run.turned) == pytest.approx(0.1, abs=1e-9)


def test_loads_between_links_and_frame_do_not_push_the_support() -> None:
    """Loads over time have their opposite on the frame."""
    push = TimedLoad("left", times=(0.0, 10.0), factors=(1.0, 1.0), point="C", force=(0.0, 50.0))
    film = {"film": Mount(axis="pitch", torsional_damping=1e-15)}
    machine = replace(wheels(mounts=film), timed_loads=(push,))
    run = on_support(machine, 0.2, speed=0.0)
    assert run.support is not None and np.ptp(run.drives["left"].angle) > 0.1
    momentum = OWN * run.support.rate[PITCH]
    momentum = momentum + 0.05 * (run.drives["left"].speed + run.support.rate[PITCH])
    np.testing.assert_allclose(momentum, 0, atol=1e-7)


def test_a_run_with_a_support_that_is_not_there_is_refused() -> None:
    with refused(ModelError, "support"):
        on_support(replace(eq.load("balance-rig"), support=None, balance=None), "1 s")


def test_other_commands_name_the_run_on_a_support() -> None:
    with refused(EquipoiseError, by="simulate"):
        eq.simulate(wheels(), "1 s")
    pushed = replace(eq.load("hydraulic-loader"), support=wheels().support)
    with refused(EquipoiseError, by="simulate"):
        eq.simulate(pushed, "1 s")
    motors = eq.load("two-motor-mixer")
    for command in (eq.respond, lambda machine, **given: eq.simulate(machine, 1.0, **given)):
        with refused(EquipoiseError, by="chosen_model"):
            command(motors, drive=True)
    with refused(EquipoiseError, by="SupportedCycles.__post_init__"):
        on_support(eq.load("riding-transplanter"), "1 s", fluctuation="2 %")
