"""What several rows do together, by orders and added in time; slopes by their phases."""

from __future__ import annotations

from dataclasses import replace
from itertools import product
from math import pi

import numpy as np
import pytest

import equipoise as eq
from equipoise.balancing.cylinder_phasing import PhasedRows, PhaseObjective
from equipoise.balancing.phase_grid import PhaseGrid
from equipoise.balancing.phase_polish import ActivePeaks, square_with_slopes
from equipoise.balancing.phase_search import PhaseSearch, choose_phases
from equipoise.mechanism.parts.balance import MEASURES, Objective, Phases
from equipoise.vibration.forced import respond
from support.chosen import few_together
from support.machines import make
from support.rows_in_time import anyhow, in_time, measured, side_by_side, value_of
from unit.vibration.build import cart, rig

TYPE_II = eq.load("yamashita-2")
SCALARS = (
    "shaking_force.x",
    "shaking_force.y",
    "shaking_moment",
    "drive_torque",
    "roll_moment",
    "yaw_moment",
    "frame_force.y",
    "frame_moment",
)
KINDS = ("crank_rocker", "slider_crank", "stephenson", "quick_return")

# Peaks lie between samples, and an area has kinks between them: 2880 angles miss both by
# (2 pi / 2880)^2 / 8 = 6e-7 times the square of the order that matters, which is 10 at most.
TOLERANCES = {"rms": 1e-11, "ripple": 1e-11, "peak": 6e-5, "peak_to_peak": 6e-5, "area": 6e-5}


@pytest.mark.parametrize("seed", [1, 2])
@pytest.mark.parametrize("kind", KINDS)
def test_rows_together_as_in_time(kind: str, seed: int) -> None:
    machine = anyhow(replace(make(kind, seed).machine, loads=()), seed)
    for output in (*SCALARS, "shaking_force", "frame_force"):
        values = in_time(machine, output, count=2880)
        for measure in MEASURES if output in SCALARS else ("rms", "peak"):
            value = value_of(machine, Objective(output, measure))
            assert value == pytest.approx(measured(values, measure), rel=TOLERANCES[measure])


@pytest.mark.parametrize(("seed", "turns"), few_together([(4, 2), (3, 3)], {(4, 2)}))
def test_cycle_of_several_turns(seed: int, turns: int) -> None:
    """Gears that are back after several turns of the crank: phases a turn apart differ."""
    machine = make("geared_five_bar", seed).machine
    assert eq.move(machine, 90).turns == turns
    wish = Objective("shaking_moment")
    values = []
    for phase in (0.7, 0.7 + 2 * pi):
        rows = side_by_side(machine, (0.2, phase))
        values.append(value_of(rows, wish))
        assert values[-1] == pytest.approx(measured(in_time(rows, wish.output), "rms"), rel=1e-9)
    assert values[0] != pytest.approx(values[1], rel=1e-3)
    phasing = choose_phases(side_by_side(machine, (0.0, 0.0)), [wish])
    scan = [
        value_of(side_by_side(machine, (0.0, phase)), wish)
        for phase in np.linspace(0, 2 * pi * turns, 400)
    ]
    assert min(scan) * (1 - 1e-3) <= phasing.after[wish.name] <= min(scan)


def test_moment_about_a_point_of_the_frame() -> None:
    machine = anyhow(TYPE_II, 3)
    value = value_of(machine, Objective("shaking_moment", about="D"))
    expected = measured(in_time(machine, "shaking_moment", "D"), "rms")
    assert value == pytest.approx(expected, rel=1e-11)


@pytest.mark.parametrize(
    ("machine", "gauge"),
    [
        (eq.load("riding-transplanter"), "left_end"),
        (eq.load("riding-transplanter"), "yaw"),
        (eq.load("walking-transplanter"), "handle_along"),
        (rig("yamashita-2"), "gauge"),
        (cart(), "corner"),
        (cart(), "roll"),
    ],
    ids=lambda value: value if isinstance(value, str) else value.title[:12],
)
def test_gauges_as_respond_has_them(machine: eq.Machine, gauge: str) -> None:
    """Impedances do not depend on phases, so that each row's share only turns with its phase."""
    machine = anyhow(machine, 1, 4)
    for speed in (None, 17.0):
        response = respond(machine, speed)
        expected = float(response.gauges[gauge].displacement.vibration_rms)
        speeds = () if speed is None else (speed,)
        result = value_of(machine, Objective(f"gauges.{gauge}", speeds=speeds))
        assert result == pytest.approx(expected, rel=1e-10)


def test_loudest_of_several_speeds_counts() -> None:
    machine = anyhow(eq.load("riding-transplanter"), 2, 3)
    each = [value_of(machine, Objective("gauges.roll", speeds=(s,))) for s in (15.0, 20.0, 30.0)]
    both = value_of(machine, Objective("gauges.roll", speeds=(15.0, 20.0, 30.0)))
    assert both == pytest.approx(max(each), rel=1e-12)


def test_orders_that_count() -> None:
    machine = anyhow(TYPE_II, 4)
    whole = value_of(machine, Objective("shaking_force", "rms"))
    parts = [value_of(machine, Objective("shaking_force", orders=(n,))) for n in range(60)]
    assert np.linalg.norm(parts) == pytest.approx(whole, rel=1e-12)


# -- slopes, and tables of pairs -------------------------------------------------------------------


@pytest.mark.parametrize("wishes", [[Objective("shaking_force")], [Objective("shaking_moment")]])
def test_grid_by_pairs_of_rows(wishes: list[Objective]) -> None:
    """Tables of pairs give what the orders' sums give, on every arrangement of three rows."""
    machine = side_by_side(TYPE_II, (0.0, 0.4, 0.9))
    cost = PhaseSearch(machine, tuple(wishes), Phases(), "sum").cost
    grid = PhaseGrid(cost, 12)
    assert grid.count == 12 * 13 // 2
    texts: list[int] = []
    cells = grid.best(texts.append)
    assert texts[-1] == grid.count == len(cells)
    values = cost.values(cells)
    assert np.all(np.diff(values) > -1e-9 * values[-1])
    everything = np.array(list(product([0.0], *[np.arange(12) * pi / 6] * 2)))
    assert np.min(cost.values(everything)) == pytest.approx(values[0], rel=1e-12)


@pytest.mark.parametrize("measure", MEASURES)
@pytest.mark.parametrize("seed", [1, 2, 3])
def test_slopes_by_phase(measure: str, seed: int) -> None:
    """The largest piece is the value, and its slope is that of differences."""
    machine = anyhow(TYPE_II, seed)
    wish = Objective("shaking_moment", measure)  # type: ignore[arg-type]
    term = PhaseObjective(wish, PhasedRows(machine).signals(wish))
    phases = np.array([row.phase for row in machine.rows])
    values, slopes = ActivePeaks.of(term, phases).pieces(phases)
    best = int(np.argmax(values))
    assert values[best] == pytest.approx(float(term.values(phases)), rel=1e-12)
    step = 1e-5
    for k, slope in enumerate(slopes[best]):
        ahead, behind = (term.values(phases + s * step * np.eye(3)[k]) for s in (1, -1))
        # The samples of an area jump where they change sign.
        tolerance = 1e-2 if measure == "area" else 1e-6
        expected = float(ahead - behind) / (2 * step)
        assert slope == pytest.approx(expected, abs=tolerance * float(term.single))


def test_second_derivatives_by_phase() -> None:
    machine = anyhow(TYPE_II, 1, 4)
    wish = Objective("shaking_force")
    term = PhaseObjective(wish, PhasedRows(machine).signals(wish))
    phases = np.array([row.phase for row in machine.rows])
    _, gradient, second = square_with_slopes(term, phases)
    for k, direction in enumerate(np.eye(4) * 1e-5):
        ahead, behind = (square_with_slopes(term, phases + s * direction) for s in (1, -1))
        scale = term.single**2
        assert (ahead[0] - behind[0]) / 2e-5 == pytest.approx(gradient[k], abs=1e-7 * scale)
        assert (ahead[1] - behind[1]) / 2e-5 == pytest.approx(second[k], abs=1e-7 * scale)
