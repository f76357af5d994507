"""Modelica text, of which no compiler is asked: its equations, read line by line, hold for the
motion of the package and give its drive torque.
"""

from __future__ import annotations

import math
import re
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import equipoise as eq
from support.rated import HELD, LAWS, LINEAR, ON_LINKS, machine_with

START = 0.3
TIMES = (0.02, 0.12, 0.22)
"""s, within a turn of 0.31 s."""
LINE = re.compile(r"  (.+) = (.+);")
SOLVED = [
    *("yamashita-1", "quick-return", "scotch-yoke", "class-three", "geared-counterweight"),
    *("planetary-planting-arm", "spring-balanced-crank", "stephenson-six-bar"),
]

LOADS = {
    "quick-return": (
        eq.Load("block", "B", (30.0, -4.0), axes="slider"),
        eq.Load("connecting-link", "F", (-8.0, 20.0), axes="link"),
    )
}


def text_of(machine: eq.Machine, path: Path) -> str:
    eq.export(machine, path, crank_angle=START)
    return path.read_text("utf-8")


def in_motion(machine: eq.Machine, time: float) -> dict[str, Any]:
    """Every variable of position, speed and acceleration, by its name in the text."""
    motion = eq.move(machine, [START + machine.drive.speed * time], acceleration=0.0)
    known: dict[str, Any] = {"time": time, "cos": math.cos, "sin": math.sin, "sqrt": math.sqrt,
                             "abs": abs}  # fmt: skip
    for number, link in enumerate(machine.links, 1):
        name = f"{re.sub('[^A-Za-z0-9_]', '_', link)}_{number}"
        center, turning = motion.mass_centers[link], motion.links[link]
        content = {
            "x": (center.x, center.vx, center.ax),
            "y": (center.y, center.vy, center.ay),
            "phi": (turning.angle, turning.angular_velocity, turning.angular_acceleration),
        }
        for key, (place, speed, change) in content.items():
            known |= {f"{key}_{name}": place[0], f"v{key}_{name}": speed[0]}
            known |= {f"d_{key}_{name}": speed[0], f"d_v{key}_{name}": change[0]}
    return known


@pytest.mark.parametrize("name", SOLVED)
def test_equations_hold_and_give_the_drive_torque(name: str, tmp_path: Path) -> None:
    machine = replace(eq.load(name), loads=LOADS.get(name, ()), balance=None)
    check_equations(machine, tmp_path)


@pytest.mark.exhaustive(but=["on links", "laws", "bushings"])
@pytest.mark.parametrize(
    "elements", [LINEAR, LAWS, HELD, ON_LINKS], ids=["linear", "laws", "bushings", "on links"]
)
def test_dampers_stops_and_resistances(
    elements: dict[str, tuple[object, ...]], tmp_path: Path
) -> None:
    """Each matters at some time: without it the drive torque is another."""
    machine = machine_with(elements)
    wanted = [check_equations(machine, tmp_path, time) for time in TIMES]
    for table, items in elements.items():
        for k in range(len(items)):
            less = replace(machine, **{table: (*items[:k], *items[k + 1 :])})
            others = [check_equations(less, tmp_path, time) for time in TIMES]
            assert np.max(np.abs(np.subtract(others, wanted))) > 1e-3, (table, k)


def check_equations(machine: eq.Machine, tmp_path: Path, time: float = 0.02) -> float:
    """The drive torque, N m, at a time, s.

    What is left of each line vanishes for some reactions, of which the lines are linear.
    """
    text = text_of(machine, tmp_path / "x.mo")
    declared = re.findall(r"Real (\w+)", text)
    head, body = text.split("equation\n")
    assert head.startswith("model Linkage_")
    lines = [LINE.fullmatch(line) for line in body.splitlines()[:-1]]
    assert all(lines)
    assert len(lines) == len(declared) == len(set(declared))
    known = in_motion(machine, time)
    unknown = [item for item in declared if item not in known]
    for line in lines:  # lengths, speeds and what follows from them
        if (
            line
            and line[1] in unknown
            and not any(re.search(rf"\b{item}\b", line[2]) for item in unknown)
        ):
            known[line[1]] = left(line[2], known)
            unknown.remove(line[1])

    def rest(values: np.ndarray) -> np.ndarray:
        given = known | dict(zip(unknown, values, strict=True))
        return np.array([left(f"({item[1]}) - ({item[2]})", given) for item in lines if item])

    nothing = rest(np.zeros(len(unknown)))
    columns = np.array([rest(row) - nothing for row in np.eye(len(unknown))]).T
    actual, *_ = np.linalg.lstsq(columns, -nothing, rcond=None)
    size = max(1.0, float(np.max(np.abs(nothing))))
    np.testing.assert_allclose(columns @ actual + nothing, 0.0, atol=1e-9 * size)
    angle = [START + machine.drive.speed * time]
    wanted = eq.forces(eq.move(machine, angle, acceleration=0.0)).drive_torque[0]
    torques = eq.forces(eq.move(machine, acceleration=0.0)).drive_torque
    torque = float(actual[unknown.index("tau")])
    assert torque == pytest.approx(wanted, abs=1e-8 * np.ptp(torques))
    return torque


def left(expression: str, known: dict[str, Any]) -> float:
    """The value of an expression."""
    plain = re.sub(r"der\((\w+)\)", r"d_\1", expression).replace("^", "**")
    return float(eval(plain, {"__builtins__": {}}, known))


def test_what_is_left_out(tmp_path: Path) -> None:
    exported = eq.export(eq.load("riding-transplanter"), tmp_path / "x.mo")
    assert exported == ("the support", "all rows but one")
