"""Scripts for Exudyn run there and agree: its constraints are exact, its steps are not."""

from __future__ import annotations

import runpy
from dataclasses import replace
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import equipoise as eq
from equipoise.mechanism.parts.support import unit_vector
from support.conformance import compared
from support.loads import with_loads_in_lines
from support.machines import make
from support.rated import HELD, LAWS, LINEAR, ON_LINKS, machine_with
from support.refusals import refused
from support.sources import EXUDYN

pytestmark = pytest.mark.skipif(find_spec("exudyn") is None, reason="not for this computer")
START = 0.3
"""Crank angle at which scripts are drawn, rad."""
STEPS = 2000
RUNNING = [
    *("lee-kim-a", "kim-chung-b", "class-three", "quick-return", "scotch-yoke", "watt-six-bar"),
    *("spring-balanced-crank", "geared-counterweight", "planetary-planting-arm"),
    "four-row-transplanter",
]
SHAKEN = ["yamashita-rig", "exudyn-slider-crank", "sieve", "walking-transplanter"]


def run(machine: eq.Machine, path: Path, turns: float, start: float = START) -> Any:
    """What the script finds over some turns."""
    eq.export(machine, path, crank_angle=start)
    return runpy.run_path(str(path))["simulate"](turns, STEPS)


@compared(EXUDYN, "drive torque of the exported script over half a turn", 2e-4)
@pytest.mark.parametrize("name", RUNNING)
def test_drive_torque(name: str, tmp_path: Path) -> None:
    """Its steps are of second order, 3e-3 rad long; what they begin with dies out in some."""
    machine = replace(eq.load(name), loads=(), balance=None)
    result = run(machine, tmp_path / "model.py", 0.5)
    phases = [row.phase for row in machine.rows] or [0.0]
    moved = (eq.move(machine, result["crank_angle"] + phase) for phase in phases)
    wanted = sum(eq.forces(item).drive_torque for item in moved)
    apart = np.abs(result["drive_torque"] - wanted)[STEPS // 10 :]
    assert len(apart) == 4 * STEPS // 10 + 1
    assert np.max(apart) < 2e-4 * np.max(np.abs(wanted))


def test_the_script_prints_a_table_of_numbers(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "model.py"
    eq.export(replace(eq.load("lee-kim-a"), loads=(), balance=None), path)
    runpy.run_path(str(path), run_name="__main__")
    header, *rows = capsys.readouterr().out.splitlines()
    assert header == "crank_angle [rad],drive_torque [N m]"
    assert len(rows) > 100
    assert all(len([*map(float, row.split(","))]) == 2 for row in rows)


@compared(EXUDYN, "gauges of the exported script from rest", 1e-5)
@pytest.mark.parametrize("name", SHAKEN)
def test_a_support_from_rest(name: str, tmp_path: Path) -> None:
    """Each gauge, as the exact equations have it, to 1e-5 of its largest displacement."""
    machine = replace(eq.load(name).with_drive(motor=None), balance=None)
    machine = machine.with_support(
        gauges={**machine.support.gauges, "tilt": eq.Gauge(axis="pitch")}
    )
    result = run(machine, tmp_path / "model.py", 0.5, start=0.0)["bodies"]["support"]
    times = 0.5 * 2 * np.pi / abs(machine.drive.speed)
    exact = eq.simulate(machine, times, machine.drive.speed, samples=len(result))
    center = complex(*machine.support.center_of_mass[:2])
    for gauge, reading in machine.support.gauges.items():
        moved = result[:, 2]
        if reading.point is not None:
            arm = complex(*reading.point[:2]) - center
            shift = result[:, 0] + 1j * result[:, 1] + arm * (np.exp(1j * result[:, 2]) - 1)
            x, y, _ = unit_vector(reading.direction)
            moved = shift.real * x + shift.imag * y
        wanted = exact.gauges[gauge]
        assert np.max(np.abs(moved - wanted)) <= 1e-5 * np.max(np.abs(wanted)) + 1e-15, gauge


@pytest.mark.parametrize("elements", [LINEAR, LAWS, HELD], ids=["linear", "laws", "bushings"])
def test_dampers_stops_and_resistances(
    elements: dict[str, tuple[object, ...]], tmp_path: Path
) -> None:
    machine = machine_with(elements)
    assert eq.export(machine, tmp_path / "model.py") == ()
    result = run(machine, tmp_path / "model.py", 0.5)
    motion = eq.move(machine, result["crank_angle"])
    wanted = eq.forces(motion).drive_torque
    apart = np.abs(result["drive_torque"] - wanted)[STEPS // 10 :]
    assert np.max(apart) < 2e-4 * np.max(np.abs(wanted))


def test_forces_in_the_line_between_two_points(tmp_path: Path) -> None:
    """To the frame and to the crank, by the drive torque."""
    _, machine = with_loads_in_lines()
    assert eq.export(machine, tmp_path / "model.py") == ()
    result = run(machine, tmp_path / "model.py", 0.5)
    wanted = eq.forces(eq.move(machine, result["crank_angle"])).drive_torque
    apart = np.abs(result["drive_torque"] - wanted)[STEPS // 10 :]
    assert np.max(apart) < 2e-4 * np.max(np.abs(wanted))


def test_what_a_script_leaves_out_of_force_elements(tmp_path: Path) -> None:
    assert eq.export(machine_with(ON_LINKS), tmp_path / "model.py") == (
        "torsion dampers with a table",
        "bushings on a body that moves",
        "stops on a body that moves",
        "resistances on a body that moves",
    )


def test_a_constant_load(tmp_path: Path) -> None:
    turns = eq.Load("coupler", point="C", force=(-2.0, 5.0), axes="link")
    loads = eq.Load("crank", point="B", force=(3.0, 4.0)), eq.Load("rocker", torque=0.5), turns
    machine = replace(eq.load("yamashita-1"), loads=loads)
    result = run(machine, tmp_path / "model.py", 0.25)
    wanted = eq.forces(eq.move(machine, result["crank_angle"])).drive_torque
    apart = np.abs(result["drive_torque"] - wanted)[STEPS // 10 :]
    assert np.max(apart) < 2e-4 * np.max(np.abs(wanted))


def test_what_a_planar_model_cannot_hold(tmp_path: Path) -> None:
    path = tmp_path / "x.py"
    with refused(eq.EquipoiseError, by="_support"):
        eq.export(eq.load("riding-transplanter"), path)
    with refused(eq.EquipoiseError, by="_model"):
        eq.export(eq.load("yamashita-1").with_drive(speed=0.0), path)
    belted = make("belted_coupler", 1).machine
    with refused(eq.EquipoiseError, noun="belt", name="crank to wheel"):
        eq.export(belted, path)
    assert not path.exists()
