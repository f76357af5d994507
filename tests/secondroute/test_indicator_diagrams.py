"""Indicator diagrams: work against the area of the loop, pressure against volume in closed form."""

from __future__ import annotations

from dataclasses import replace
from math import pi
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import equipoise as eq
from equipoise.codegen.batch import Batch
from equipoise.codegen.figures import Figure
from equipoise.errors import ModelError, UsageError
from equipoise.mechanism.assembly.linkage import assemble
from equipoise.mechanism.dynamics.loads import load_at, work_in_cycle
from equipoise.mechanism.kinematics.indicators import loads_of
from equipoise.mechanism.parts.loads import IndicatorDiagram
from support.refusals import refused

BORE, CRANK, ROD = 0.068, 0.027, 0.095
AREA, STROKE = pi / 4 * BORE**2, 2 * CRANK
BAR = 1e5
BARE = replace(eq.load("four-stroke-engine"), balance=None, loads=())
# the four strokes of an engine, from its compression on, with combustion at constant volume
FOUR = [(0.5, 2.1), (0.2, 4.3), (0.05, 9.0), (0.0, 14.0), (0.0, 38.0), (0.1, 25.0), (0.4, 8.0),
        (1.0, 3.0), (1.0, 1.2), (0.6, 1.1), (0.0, 1.05), (0.4, 0.9), (1.0, 0.92),
        (0.8, 1.2)]  # fmt: skip
# what a pump lifts and draws in
TWO = [(0.3, 6.0), (0.0, 6.0), (0.02, 1.0), (1.0, 0.9), (0.97, 5.5), (0.6, 6.1)]

BACKWARD = [*TWO[:2], (0.4, 1.0), (0.2, 1.0), *TWO[3:]]
# the four strokes with rows that are set back a little after each of some rows
NOISE = {
    "before the dead centre at the gas": {2: [(0.003, 13.0), (0.004, 13.4), (0.002, 13.7)]},
    "at the dead centre at the gas": {4: [(0.0015, 35.0), (0.001, 34.8), (0.0005, 34.6)]},
    "at the far dead centre": {8: [(0.995, 1.19), (0.997, 1.19), (0.994, 1.19)]},
    "before the far dead centre": {6: [(0.99, 3.1), (0.988, 3.1), (0.999, 3.0), (0.998, 3.0)]},
    "in a stroke": {6: [(0.41, 7.9), (0.405, 7.95), (0.415, 7.85)]},
    "in every stroke": {0: [(0.21, 4.2)], 5: [(0.395, 8.1)], 9: [(0.605, 1.1)],
                        11: [(0.39, 0.9)], 13: [(0.81, 1.2)]},
}  # fmt: skip


def diagram(rows: list[tuple[float, float]], over: str = "volume") -> IndicatorDiagram:
    size = AREA * STROKE if over == "volume" else STROKE
    offset = 2.6e-5 if over == "volume" else 0.002
    places = tuple(offset + share * size for share, _ in rows)
    return IndicatorDiagram(places, tuple(BAR * p for _, p in rows), over)  # type: ignore[arg-type]


def machine_of(item: IndicatorDiagram, side: str = "ahead", speed: float = 300.0) -> eq.Machine:
    load = eq.Load("piston", "C", indicator=item, bore=BORE, back_pressure=BAR, axes="slider",
                   side=side, reaction="frame")  # fmt: skip
    return replace(BARE, loads=(load,)).with_drive(speed=speed)


def area_of(rows: list[tuple[float, float]]) -> float:
    """Work of a loop, J, by the cross products of its corners."""
    x, p = np.array(rows).T
    return float(0.5 * np.sum(p * (np.roll(x, -1) - np.roll(x, 1))) * BAR * AREA * STROKE)


@pytest.mark.parametrize("speed", [300.0, -300.0])
@pytest.mark.parametrize("over", ["volume", "position"])
@pytest.mark.parametrize("side", ["ahead", "behind"])
@pytest.mark.parametrize("rows", [FOUR, TWO])
def test_work_is_the_area_of_the_loop(
    rows: list[tuple[float, float]], side: str, over: str, speed: float
) -> None:
    """Whichever way the crank turns, as rows are in the order of time."""
    machine = machine_of(diagram(rows, over), side, speed)
    (load,) = loads_of(assemble(machine))
    assert assemble(machine).cycle.turns == len(load.gas.pressure) // 360  # type: ignore[union-attr]
    # pressure is linear over 1 deg of the crank, not over the volume
    assert work_in_cycle(machine, load).net == pytest.approx(area_of(rows), rel=2e-4)
    forces = eq.analyze(machine).forces
    given = forces.motion.mean(forces.drive_torque) * 2 * pi * forces.motion.turns
    assert given * np.sign(speed) == pytest.approx(-area_of(rows), rel=2e-4)


@pytest.mark.parametrize("noise", NOISE)
@pytest.mark.parametrize("speed", [300.0, -300.0])
def test_noise_is_no_stroke(noise: str, speed: float) -> None:
    """Rows that go back by less than 2 % of the stroke: two turns, with the work of the loop."""
    rows = [*FOUR]
    for after, noisy in sorted(NOISE[noise].items(), reverse=True):
        rows[after + 1 : after + 1] = noisy
    for first in range(len(rows)):
        item = diagram(rows[first:] + rows[:first])
        assert len(item.ends) == 4
        assert item.turns == 2
    for first in (0, 4, 6):
        machine = machine_of(diagram(rows[first:] + rows[:first]), speed=speed)
        (load,) = loads_of(assemble(machine))
        angles = np.array(load.gas.crank_angle)  # type: ignore[union-attr]
        assert assemble(machine).cycle.turns == 2
        assert np.all(np.diff(angles) > 0)
        assert work_in_cycle(machine, load).net == pytest.approx(area_of(rows), rel=1e-3)


def way_of(crank_angle: np.ndarray) -> np.ndarray:
    """Way of the piston from its top dead centre, m; the cylinder points up."""
    x, y = CRANK * np.cos(crank_angle), CRANK * np.sin(crank_angle)
    return CRANK + ROD - y - np.sqrt(ROD**2 - x**2)


@pytest.mark.parametrize(("first", "fires"), [(0, 90), (5, 90), (9, 90), (11, 450)])
def test_pressure_by_the_volume(first: int, fires: int) -> None:
    """The first row is the one that is passed first after a crank angle of 0: one in the intake, at
    163 or at 523 deg, makes the engine fire one turn later.
    """
    (load,) = loads_of(assemble(machine_of(diagram(FOUR[first:] + FOUR[:first]))))
    theta = np.radians(np.arange(0.25, 720.0, 1.7))
    force, _ = load_at(load, theta)
    actual = -force.real / AREA + BAR
    stroke = (np.mod(theta - np.radians(fires), 4 * pi) / pi).astype(int)
    share = way_of(theta) / STROKE
    wanted = np.empty_like(share)
    for number, branch in enumerate((FOUR[4:8], FOUR[8:11], FOUR[10:13], [*FOUR[12:], *FOUR[:4]])):
        x, p = np.array(branch if branch[0][0] < branch[-1][0] else branch[::-1]).T
        wanted[stroke == number] = np.interp(share[stroke == number], x, BAR * p)
    # a degree of the crank is straight, within which volume and pressure bend
    assert np.max(np.abs(actual - wanted)) < 0.02 * BAR


def test_a_compiled_study_has_the_same_torque() -> None:
    """Of masses; numbers that move the piston are computed design by design."""
    machine = machine_of(diagram(FOUR))
    figure = Figure("drive_torque", "rms")
    batch = Batch(machine, ["links.piston.mass"], [figure], angles=720)
    (actual,), _ = batch(np.array([[0.4]]))
    heavier = machine.with_link("piston", mass=0.4)
    torque = eq.analyze(heavier, angles=720).summary["drive_torque"]
    assert actual[0] == pytest.approx(torque.rms, rel=1e-9)
    with refused(UsageError, by="Batch.__init__"):
        Batch(machine, ["links.rod.points.C.x"], [figure])
    with refused(UsageError, paths="loads[1].back_pressure"):
        Batch(machine, ["loads[1].back_pressure"], [figure])(np.array([[BAR]]))


def test_a_duty_state_scales_what_is_beyond_the_back_pressure() -> None:
    machine = machine_of(diagram(FOUR))
    (half,) = eq.mechanism.DutyState(1.0, load_factor=0.5).scaled(machine.loads)
    loads = [loads_of(assemble(replace(machine, loads=(load,))))[0]
             for load in (machine.loads[0], half)]  # fmt: skip
    works = [work_in_cycle(machine, load).net for load in loads]
    assert works[1] == pytest.approx(0.5 * works[0])


def test_a_file_is_written_and_read(tmp_path: Path) -> None:
    for over in ("volume", "position"):
        path = tmp_path / f"{over}.toml"
        machine = machine_of(diagram(FOUR, over))
        eq.save(machine, path)
        assert eq.load(path) == machine


@pytest.mark.parametrize(
    ("change", "at", "expected"),
    [
        ({"bore": 0.07}, "loads[1].indicator", {"given": "196.1 cm³"}),
        ({"bore": None}, "loads[1].bore", {}),
        ({"axes": None}, "loads[1].axes", {}),
        ({"torque": 1.0}, "loads[1]", {}),
        ({"indicator": diagram(FOUR[:2])}, "loads[1].indicator", {"rows": 2}),
        ({"indicator": IndicatorDiagram((1.0, 1.0, 1.0), (1.0, 2.0, 3.0))}, "loads[1].indicator",
         {}),
        ({"indicator": diagram(BACKWARD)}, "loads[1].indicator",
         {"row": 3, "by": "_by_angle"}),
        ({"indicator": diagram(BACKWARD, "position")}, "loads[1].indicator",
         {"row": 3, "by": "_by_angle"}),
        ({"indicator": diagram([*FOUR[:5], (0.05, 30.0), (0.02, 30.0), *FOUR[5:]])},
         "loads[1].indicator", {"row": 6}),
    ],
)  # fmt: skip
def test_what_is_refused(change: dict[str, object], at: str, expected: dict[str, Any]) -> None:
    machine = machine_of(diagram(FOUR))
    with refused(ModelError, at, **expected):
        eq.analyze(replace(machine, loads=(replace(machine.loads[0], **change),)))
