"""Pressure on a piston over the crank angle: its force, its work, and where it may stand."""

from __future__ import annotations

import shutil
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import equipoise as eq
from equipoise.codegen.batch import Batch
from equipoise.codegen.figures import Figure
from equipoise.errors import ModelError
from equipoise.mechanism import DutyState, GasTable, Load, LoadTable, Machine, Slider
from equipoise.mechanism.dynamics.loads import work_in_cycle
from equipoise.results.machine_blocks import model_blocks
from support.own_kinds import scripted
from support.refusals import refused

BORE, CRANK = 0.068, 0.03
AREA = np.pi / 4 * BORE**2
ANGLES = 2 * np.pi * np.arange(37) / 36
PRESSURES = tuple(1e5 * (1 + 8 * np.exp(-4 * (1 - np.cos(ANGLES)))))
INDICATED = GasTable(tuple(ANGLES), PRESSURES)
GAS = Load("piston", "C", gas=INDICATED, bore=BORE, axes="slider", reaction="frame")


def engine(*loads: Load, direction: float = 0.3) -> Machine:
    """A slider-crank whose cylinder points anywhere."""
    crank = eq.Link({"A": (0.0, 0.0), "B": (CRANK, 0.0)}, 4.0, (0.0, 0.0), 0.9)
    rod = eq.Link({"B": (0.0, 0.0), "C": (0.11, 0.0)}, 0.5, (0.03, 0.0), 0.001)
    piston = eq.Link({"C": (0.0, 0.0)}, 0.4, (0.0, 0.0), 0.001)
    slider = Slider("piston", "C", "frame", "A", direction)
    return eq.Machine(
        "engine", eq.Drive("crank", 100.0), {"A": (0.0, 0.0)},
        {"crank": crank, "rod": rod, "piston": piston}, assembly={"C": "forward"},
        sliders=(slider,), gravity=(0.0, 0.0), loads=loads,
    )  # fmt: skip


@pytest.mark.parametrize(("side", "sign"), [("ahead", -1.0), ("behind", 1.0)])
@pytest.mark.parametrize("back", [0.0, 1.2e5])
def test_it_is_a_force_of_pressure_times_area(side: Any, sign: float, back: float) -> None:
    """Beyond what pushes on the other side, along the cylinder wherever that points."""
    forces = sign * AREA * (np.array(PRESSURES) - back)
    turn = np.exp(0.3j)
    columns = tuple(forces * turn.real), tuple(forces * turn.imag)
    plain = Load("piston", "C", table=LoadTable(tuple(ANGLES), columns), reaction="frame")
    gas = replace(GAS, side=side, back_pressure=back)
    actual, wanted = (eq.analyze(engine(load), 90).forces for load in (gas, plain))
    size = np.max(np.abs(wanted.drive_torque))
    np.testing.assert_allclose(actual.drive_torque, wanted.drive_torque, atol=1e-13 * size)
    for name, joint in wanted.joints.items():
        ours = actual.joints[name].value
        np.testing.assert_allclose(ours, joint.value, atol=1e-13 * np.max(joint.size))


def test_its_work_is_that_of_the_indicator_diagram() -> None:
    """Of 3 bar for the half turn in which the piston goes back: pressure times displacement."""
    half = GasTable((0.0, np.pi), (3e5, 3e5))
    load = replace(GAS, gas=half, outside="zero")
    machine = engine(load, direction=0.0)
    displacement = AREA * 2 * CRANK
    assert work_in_cycle(machine, load).net == pytest.approx(3e5 * displacement, rel=1e-12)
    assert work_in_cycle(machine, load).largest == pytest.approx(3e5 * AREA, rel=1e-14)
    actual, bare = (eq.analyze(item, 720) for item in (machine, engine(direction=0.0)))
    means = [item.summary["drive_torque"].mean for item in (bare, actual)]
    assert 2 * np.pi * (means[0] - means[1]) == pytest.approx(3e5 * displacement, rel=1e-9)
    frame, wanted = (item.forces.frame_force.value for item in (actual, bare))
    size = np.max(actual.forces.joints["C"].size)
    np.testing.assert_allclose(frame, wanted, atol=1e-12 * size)


def test_a_run_gets_its_work() -> None:
    """From pressure over the cylinder's volume, as an integral over the crank's way."""
    machine = engine(GAS)
    run = eq.run(machine, "0.1 s", speed=40.0)
    theta = np.linspace(run.crank_angle[0], run.crank_angle[-1], 200_001)
    motion = eq.move(machine, theta)
    way = motion.point("C").place * np.exp(-0.3j)
    pressure = np.interp(np.mod(theta, 2 * np.pi), ANGLES, PRESSURES)
    middle = (pressure[1:] + pressure[:-1]) / 2
    work = -AREA * float(np.sum(middle * np.diff(way.real)))
    assert abs(work) > 1.0
    assert run.work["loads"][-1] == pytest.approx(work, rel=1e-6)  # of trapezoids
    assert run.energy_error < 1e-9


def test_states_of_duty_scale_what_acts() -> None:
    gas = replace(GAS, back_pressure=1e5)
    (scaled,) = DutyState(1.0, load_factor=0.5).scaled((gas,))
    assert gas.rows is not None and scaled.rows is not None
    for ours, whole in zip(scaled.rows.values, gas.rows.values, strict=True):
        np.testing.assert_allclose(ours, 0.5 * np.array(whole), atol=1e-9)


def test_loops_and_scripts_have_it(tmp_path: Path) -> None:
    """Of designs whose pistons differ."""
    machine = engine(GAS)
    batch = Batch(machine, ["links.piston.mass"], [Figure("drive_torque", "peak")], angles=90)
    figures, _ = batch(np.array([[0.4], [0.9]]))
    for row, mass in zip(figures, (0.4, 0.9), strict=True):
        made = machine.with_link("piston", mass=mass)
        wanted = eq.analyze(made, 90).summary["drive_torque"].peak
        assert row[0] == pytest.approx(wanted, rel=1e-9)
    if shutil.which("node") is not None:
        scripted(machine, ["drive_torque"], tmp_path)


ROWS = "crank_angle [deg],pressure [kPa]\n0,900\n180,100\n360,900\n"
TEXT = """\
schema = 1
title = "Engine"
[drive]
link = "crank"
speed = "600 rpm"
[frame]
points.A = ["0 mm", "0 mm"]
[links.crank]
points.A = ["0 mm", "0 mm"]
points.B = ["30 mm", "0 mm"]
[links.rod]
points.B = ["0 mm", "0 mm"]
points.C = ["110 mm", "0 mm"]
[links.piston]
points.C = ["0 mm", "0 mm"]
[[sliders]]
link = "piston"
point = "C"
on = "frame"
through = "A"
direction = "0 deg"
[[loads]]
link = "piston"
point = "C"
axes = "slider"
gas = "indicator.csv"
bore = "68 mm"
back_pressure = "1 bar"
reaction = "frame"
[assembly]
C = "forward"
"""


def test_a_file_is_read_written_and_shown(tmp_path: Path) -> None:
    (tmp_path / "indicator.csv").write_text(ROWS, encoding="utf-8")
    (tmp_path / "engine.toml").write_text(TEXT, encoding="utf-8")
    machine = eq.load(tmp_path / "engine.toml")
    (load,) = machine.loads
    assert load.gas is not None and load.gas.pressure == (9e5, 1e5, 9e5)
    assert load.back_pressure == 1e5 and load.gas.file == "indicator.csv"
    eq.save(machine, tmp_path / "again.toml")
    assert eq.load(tmp_path / "again.toml").loads == machine.loads
    assert "gas on C of piston, bore 68.00 mm" in "".join(map(str, model_blocks(machine)))


@pytest.mark.parametrize(
    ("slip", "sentence"),
    [
        (("pressure [kPa]", "pressure [N]"), "N is the unit of a force"),
        (("crank_angle [deg]", "time [s]"), "time"),
        (("180,100", "180,"), "line 3"),
    ],
)
def test_a_wrong_file_is_named(tmp_path: Path, slip: tuple[str, str], sentence: str) -> None:
    (tmp_path / "indicator.csv").write_text(ROWS.replace(*slip), encoding="utf-8")
    (tmp_path / "engine.toml").write_text(TEXT, encoding="utf-8")
    with refused(ModelError, "loads[1].gas", place="indicator.csv") as caught:
        eq.load(tmp_path / "engine.toml")
    assert sentence in str(caught.value)


SHORT = GasTable((0.0, 1.0, 2.0), (1e5, 4e5, 2e5))
UNEQUAL = GasTable((0.0, 2 * np.pi), (1e5, 4e5))
WRONG: list[tuple[dict[str, Any], dict[str, Any]]] = [
    ({"bore": None}, {"place": "loads[1].bore"}),
    ({"bore": -0.1}, {"place": "loads[1].bore", "text": "-0.1 m"}),
    ({"axes": "link"}, {"place": "loads[1].axes"}),
    ({"force": (1.0, 0.0)}, {"place": "loads[1]"}),
    ({"gas": SHORT}, {"place": "loads[1].outside"}),
    ({"gas": UNEQUAL},
     {"place": "loads[1].gas", "column": 1.0, "crank_angle": 0.0, "crank_angle_2": 360.0}),
    ({"gas": GasTable((0.0, 1.0), (1e5,))}, {"place": "loads[1].gas"}),
    ({"gas": GasTable((), ())}, {"place": "loads[1].gas"}),
    ({"gas": None, "force": (1.0, 0.0)}, {"place": "loads[1].bore"}),
    ({"gas": None, "force": (1.0, 0.0), "bore": None, "back_pressure": 1e5},
     {"place": "loads[1].back_pressure"}),
    ({"gas": None, "force": (1.0, 0.0), "bore": None, "side": "behind"},
     {"place": "loads[1].side"}),
]  # fmt: skip


@pytest.mark.parametrize(("changes", "expected"), WRONG)
def test_what_is_wrong_is_said(changes: dict[str, Any], expected: dict[str, Any]) -> None:
    with refused(ModelError, **expected):
        engine(replace(GAS, **changes))
