"""No phases are below the bound: closed forms, whole grids in time, and readings by themselves."""

from __future__ import annotations

from itertools import product
from math import pi

import numpy as np
import pytest

import equipoise as eq
from equipoise.balancing.box_bounds import CLOSE, Improve, largest_reading, prove
from equipoise.balancing.cylinder_phasing import (
    Combine,
    Cost,
    PhasedRows,
    PhaseObjective,
    RowSignals,
)
from equipoise.balancing.phase_search import PhaseSearch, choose_phases
from equipoise.mechanism.parts.balance import MEASURES, Objective, Phases
from support.chosen import EXHAUSTIVE
from support.rows_in_time import side_by_side

TYPE_II = eq.load("yamashita-2")
FORCE = Objective("shaking_force")


def of_amplitudes(*rows: tuple[float, ...]) -> Cost:
    """RMS of a signal of which each row has these amplitudes of the orders 1, 2 ..."""
    amplitudes = np.array([[[[0.0, *row]] for row in rows]], complex)
    return Cost((PhaseObjective(FORCE, RowSignals(amplitudes)),))


def improved(cost: Cost) -> Improve:
    """Nothing but the middles of boxes themselves."""
    return lambda phases, _: (phases, float(cost.values(phases)))


@pytest.mark.parametrize(
    ("rows", "best"),
    [
        (((1.0,), (1.0,)), 0.0),  # opposed
        (((2.0,), (1.0,)), 1.0),
        (((4.0,), (1.0,), (2.0,)), 1.0),  # two cannot make up for one that is larger than both
        (((3.0,), (4.0,), (5.0,)), 0.0),  # a triangle closes
        (((1.0, 0.5), (1.0, 0.5)), 1.0),  # opposed; twice half of the second order is left
        (((1.0, 1.0), (1.0, 1.0), (1.0, 1.0)), 0.0),  # thirds of a turn
        (((1.0,),) * 4, 0.0),
    ],
)
def test_closed_forms(rows: tuple[tuple[float, ...], ...], best: float) -> None:
    """Polygons of phasors, order by order; begun at phases that are not the best."""
    cost = of_amplitudes(*rows)
    proof = prove(cost, 0.3 * np.arange(len(rows)), improved(cost))
    least = best / np.sqrt(2)
    assert proof.bound <= least + 1e-12
    assert proof.bound >= least - CLOSE * cost.whole
    assert float(cost.values(proof.phases)) - proof.bound <= CLOSE * (1 + 1e-9)


def test_two_rows_of_one_order_are_opposed() -> None:
    phasing = choose_phases(
        side_by_side(TYPE_II, (0.0, 0.3)), [Objective("shaking_force.y", orders=(1,))]
    )
    assert phasing.phases[1] == pytest.approx(pi)
    assert (phasing.combined[1], phasing.bound) == pytest.approx((0.0, 0.0), abs=1e-12)


WISHES: dict[str, tuple[list[Objective], Combine]] = {
    "force": ([FORCE], "sum"),
    "peak": ([Objective("shaking_force.y", "peak")], "sum"),
    "size": ([Objective("shaking_force", "peak")], "sum"),
    "range and roll": (
        [Objective("shaking_moment", "peak_to_peak"), Objective("roll_moment", weight=0.4)],
        "sum",
    ),
    "area": ([Objective("drive_torque", "area")], "sum"),
    "squares": ([FORCE, Objective("yaw_moment", "peak")], "squares"),
}


CASES = tuple((case, step) for step in (4.0, 10.0) for case in WISHES)
CHOSEN = {(case, 4.0) for case in WISHES} - {("squares", 4.0)} | {("force", 10.0)}


@pytest.mark.exhaustive(but=["size-4.0", "area-4.0", "force-10.0"])
@pytest.mark.parametrize(
    ("case", "step"),
    [pytest.param(*item, marks=() if item in CHOSEN else EXHAUSTIVE) for item in CASES],
)
def test_no_grid_is_below_the_bound(case: str, step: float) -> None:
    """Every arrangement of two rows at 4 deg, of three at 10 deg."""
    wishes, combine = WISHES[case]
    count = 2 if step < 5 else 3
    machine = side_by_side(TYPE_II, [0.4 * k * k for k in range(count)])
    phasing = choose_phases(machine, wishes, combine=combine)
    grid = np.radians(np.arange(0, 360, step))
    phases = np.array([(0.0, *others) for others in product(grid, repeat=count - 1)])
    values = PhaseSearch(machine, tuple(wishes), Phases(), combine).cost.values(phases)
    assert np.min(values) >= phasing.combined[1] * (1 - 1e-12)
    assert phasing.bound <= phasing.combined[1] <= phasing.bound + CLOSE * phasing.combined[0]


@pytest.mark.parametrize(
    ("output", "measure"),
    [*(("shaking_force.y", m) for m in MEASURES), *(("shaking_force", m) for m in ("rms", "peak"))],
)
def test_a_reading_is_the_measure_and_nowhere_more(output: str, measure: str) -> None:
    """Rounding, and for peaks what lies between samples: (n pi / 720)^2 / 2 of each order n."""
    wish = Objective(output, measure)  # type: ignore[arg-type]
    term = PhaseObjective(wish, PhasedRows(side_by_side(TYPE_II, [0.0] * 3)).signals(wish))
    phases = np.random.default_rng(4).uniform(0, 2 * pi, (40, 3))
    values, read, _ = largest_reading(term, term.signals.total(phases))
    readings = np.einsum("bcn,kcn->bkn", read, term.signals.amplitudes[0])
    assert values == pytest.approx(term.values(phases), rel=3e-4)
    turning = np.exp(1j * phases[..., None] * term.signals.orders)
    each = np.einsum("bkn,pkn->bp", readings, turning).real
    assert np.diagonal(each) == pytest.approx(values, rel=1e-12)
    assert np.all(each <= term.values(phases) * (1 + 1e-12))


def test_a_start_that_is_not_the_best_is_mended() -> None:
    """Bounding finds better phases where the search has missed them."""
    search = PhaseSearch(side_by_side(TYPE_II, [0.0] * 4), (FORCE,), Phases(), "sum")
    best = choose_phases(search.machine, [FORCE])
    proof = prove(search.cost, np.array([0.0, 0.1, 0.2, 0.3]), search.improved)
    assert float(search.cost.values(proof.phases)) == pytest.approx(best.combined[1], rel=1e-9)
    assert proof.bound == pytest.approx(best.bound, abs=CLOSE)
