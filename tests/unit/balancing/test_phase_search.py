"""Phases of rows: patterns that are printed, and the search with what it refuses and shows."""

from __future__ import annotations

import json
from dataclasses import replace
from itertools import groupby
from math import pi, radians
from typing import Any

import numpy as np
import pytest

import equipoise as eq
from equipoise.balancing import phase_search
from equipoise.balancing.box_bounds import CLOSE
from equipoise.balancing.cylinder_phasing import PhasedRows
from equipoise.balancing.patterns import (
    PATTERNS,
    Pattern,
    arranged,
    halved,
    pattern_blocks,
    pattern_named,
    patterns_for,
)
from equipoise.balancing.phase_grid import PhaseGrid, alike, coarsened, distinct, sorted_choices
from equipoise.balancing.phase_polish import most_steps
from equipoise.balancing.phase_search import MOST_KINKED, PhaseSearch, choose_phases
from equipoise.errors import EquipoiseError, UsageError
from equipoise.mechanism.dynamics.forces import forces
from equipoise.mechanism.parts.balance import Objective, Phases, Statistic
from equipoise.mechanism.parts.machine import Machine
from equipoise.mechanism.parts.support import Row
from equipoise.signals import Periodic, present
from support.printing import printed, words
from support.refusals import refused
from support.sentences import notes_by

MACHINE = eq.load("yamashita-2")


@pytest.mark.parametrize("count", range(2, 17))
def test_names_report_the_number_of_rows_and_lead_back(count: int) -> None:
    patterns = patterns_for(count)
    assert patterns
    assert len({pattern.name for pattern in patterns}) == len(patterns)
    for pattern in patterns:
        assert pattern.rows == count
        assert pattern.name.startswith(f"{count} ")
        assert pattern_named(pattern.name) == pattern
        assert pattern.phases[0] == 0.0


@pytest.mark.parametrize("name", PATTERNS)
def test_figures_against_sums_of_phasors(name: str) -> None:
    pattern = PATTERNS[name]
    middle = (pattern.rows - 1) / 2
    for order in range(1, 13):
        phasors = [np.exp(1j * order * phase) for phase in pattern.phases]
        lever = sum((k - middle) * phasor for k, phasor in enumerate(phasors))
        assert pattern.in_phase(order) == pytest.approx(abs(sum(phasors)), abs=1e-12)
        assert pattern.lever(order) == pytest.approx(abs(lever), abs=1e-12)
        assert pattern.in_phase(order) == pytest.approx(pattern.in_phase(order + pattern.cycle))


@pytest.mark.parametrize("count", [2, 4, 8, 16, 32])
def test_halving_leaves_multiples_of_the_number_of_rows(count: int) -> None:
    phases = np.array(halved(count).phases)
    left = [abs(np.sum(np.exp(1j * order * phases))) for order in range(1, 2 * count + 1)]
    expected = [count if order % count == 0 else 0.0 for order in range(1, 2 * count + 1)]
    assert left == pytest.approx(expected, abs=1e-10)
    for first, second in zip(phases[::2], phases[1::2], strict=True):
        assert second - first == pytest.approx(pi)


@pytest.mark.parametrize("count", [6, 8, 10, 12])
def test_mirrored_rows_do_not_twist(count: int) -> None:
    pattern = pattern_named(f"{count} mirrored")
    assert not pattern.twists
    assert dict(pattern.remaining) == pytest.approx({count // 2: count})


def test_arranged_about_the_middle() -> None:
    machine = arranged(MACHINE, "4 mirrored", 0.3)
    assert [row.lateral for row in machine.rows] == pytest.approx([-0.45, -0.15, 0.15, 0.45])
    assert [row.phase for row in machine.rows] == pytest.approx([0.0, pi, pi, 0.0])
    assert machine.links == MACHINE.links


def test_arranged_keeps_an_offset_and_takes_a_pattern() -> None:
    machine = MACHINE.with_rows([Row(offset=(0.1, -0.2)), Row(phase=1.0)])
    pattern = Pattern("mine", ((0, 1), (1, 3), (2, 3)))
    result = arranged(machine, pattern, 0.25)
    assert {row.offset for row in result.rows} == {(0.1, -0.2)}
    assert [row.lateral for row in result.rows] == [-0.25, 0.0, 0.25]
    assert dict(pattern.remaining) == pytest.approx({3: 3.0})


@pytest.mark.parametrize("name", ["4 mirrored", "6 quarter turns within"])
def test_lever_times_force_is_the_roll_moment(name: str) -> None:
    """Order by order, on a machine."""
    pattern, spacing = PATTERNS[name], 0.3
    rows = PhasedRows(arranged(MACHINE, name, spacing))
    phases = np.array(pattern.phases)
    roll = np.abs(rows.signals(Objective("roll_moment")).total(phases)[0, 0])
    force = np.abs(rows.signals(Objective("shaking_force.y")).amplitudes[0, 0, 0])
    for order in range(1, 9):
        expected = pattern.lever(order) * spacing * force[order]
        assert roll[order] == pytest.approx(expected, abs=1e-12 * force[1])


@pytest.mark.parametrize(
    ("call", "expected"),
    [
        (lambda: halved(6).phases, {"rows": 6}),
        (lambda: halved(1).phases, {"rows": 1}),
        (lambda: patterns_for(1), {"rows": 1}),
        (lambda: pattern_named("4 mirror"), {"given": "4 mirror", "name": "4 mirrored"}),
        (lambda: pattern_named("mirrored"), {"given": "mirrored"}),
        (lambda: pattern_named(""), {"by": "pattern_named"}),
        (lambda: arranged(MACHINE, "2 opposed", 0.0), {"spacing": 0.0}),
        (lambda: arranged(MACHINE, "2 opposed", float("nan")), {"spacing": "nan"}),
    ],
)
def test_patterns_refused(call, expected: dict[str, Any]) -> None:  # type: ignore[no-untyped-def]
    with refused(UsageError, **expected):
        call()


def test_values_of_patterns() -> None:
    values = PATTERNS["6 quarter turns at the end"].to_dict()
    assert values["remaining"] == pytest.approx({"2": 2.0, "4": 6.0})
    assert values["cycle"] == 4
    assert values["twists"] is True
    assert len(values["levers"]) == 4


@pytest.mark.parametrize("count", [2, 3, 4, 6, 8])
def test_patterns_printed(count: int) -> None:
    reported = words(pattern_blocks(MACHINE, count, 0.3))
    assert all(pattern.name in reported for pattern in patterns_for(count))
    assert "all in phase" in reported


TYPE_II = eq.load("yamashita-2")
FORCE = Objective("shaking_force")
ROLL = Objective("roll_moment")


def rows(count: int, phase: float = 0.0, spacing: float = 0.3) -> Machine:
    """Rows side by side, each ahead of the one before by a phase."""
    middle = (count - 1) / 2
    return TYPE_II.with_rows(Row(k * phase, spacing * (k - middle)) for k in range(count))


@pytest.mark.parametrize(
    ("machine", "objectives", "step", "expected"),
    [
        (TYPE_II, [FORCE], 5, {"place": "rows", "count": 0}),
        (rows(1), [FORCE], 5, {"place": "rows", "count": 1}),
        (rows(2), [], 5, {"by": "PhaseSearch.__post_init__"}),
        (rows(2), [FORCE], 0, {"step": 0.0}),
        (rows(2), [FORCE], 91, {"step": 91.0}),
        (
            rows(2),
            [Objective("joints.B")],
            5,
            {"output": "joints.B"},
        ),
        (rows(2), [FORCE, Objective("nothing")], 5, {"place": "objectives[2].output"}),
        (rows(2), [Objective("gauges.seat")], 5, {"place": "objectives[1].output"}),
        (
            rows(2),
            [Objective("drive_torque", orders=(0.0,))],
            5,
            {"name": "rms of drive_torque (order 0)"},
        ),
        (rows(2), [Objective("shaking_force.x", orders=(0.5,))], 5, {"by": "PhaseSearch._term"}),
        (rows(3, spacing=0.0), [ROLL], 5, {"name": "rms of roll_moment"}),
        (
            TYPE_II.with_rows([Row(), Row(lateral=1.0)]),
            [Objective("yaw_moment", "peak")],
            5,
            {"name": "peak of yaw_moment"},
        ),
        (TYPE_II.with_link("crank", mass=None, center_of_mass=None, inertia=None).with_rows(
            [Row(), Row()]), [FORCE], 5, {"by": "forces"}),
    ],
)  # fmt: skip
def test_refused(
    machine: Machine, objectives: list[Objective], step: float, expected: dict[str, Any]
) -> None:
    with refused(EquipoiseError, **expected) as caught:
        choose_phases(machine, objectives, Phases(radians(step)))
    assert "\n" not in str(caught.value)


# Peaks of rows at any phases: tests/laws/test_jumping_rows.py.
@pytest.mark.exhaustive
def test_rows_that_share_no_order_have_peaks_all_the_same() -> None:
    """A single row in each order: phases do not change the mean square, but they do the peak."""
    machine = TYPE_II.with_rows([Row(), Row(lateral=1.0), Row(lateral=0.5)])
    assert choose_phases(machine, [Objective("yaw_moment", "peak")]).combined[1] < 1.0


@pytest.mark.parametrize(("levels", "count"), [(3, 1), (4, 2), (5, 3), (2, 6)])
def test_sorted_choices(levels: int, count: int) -> None:
    from itertools import combinations_with_replacement

    expected = list(combinations_with_replacement(range(levels), count))
    assert [tuple(row) for row in sorted_choices(levels, count).tolist()] == expected


def search(machine: Machine, *objectives: Objective, step: float = 5.0) -> PhaseSearch:
    return PhaseSearch(machine, objectives, Phases(radians(step)), "sum")


def test_rows_that_are_alike() -> None:
    assert alike(search(rows(4), FORCE).cost) == [[0, 1, 2, 3]]
    assert alike(search(rows(4), FORCE, ROLL).cost) == [[0], [1], [2], [3]]
    paired = rows(4).with_rows(Row(lateral=z) for z in (-0.3, 0.3, -0.3, 0.3))
    assert alike(search(paired, ROLL).cost) == [[0, 2], [1, 3]]
    offset = rows(3).with_rows([Row(), Row(offset=(0.1, 0.0)), Row()])
    assert alike(search(offset, Objective("shaking_moment")).cost) == [[0, 2], [1]]


def test_arrangements_are_counted_by_groups() -> None:
    paired = rows(4).with_rows(Row(lateral=z) for z in (-0.3, 0.3, -0.3, 0.3))
    assert PhaseGrid(search(rows(4), FORCE).cost, 12).count == 14 * 13 * 12 // 6
    assert PhaseGrid(search(rows(4), ROLL).cost, 12).count == 12**3
    assert PhaseGrid(search(paired, ROLL).cost, 12).count == 12 * (12 * 13 // 2)


def test_first_grid_is_as_fine_as_can_be_afforded() -> None:
    for count, levels in ((4, 72), (6, 36), (8, 24)):
        grid = coarsened(search(rows(count), FORCE).cost, 72)
        assert grid is not None
        assert grid.levels == levels
    assert coarsened(search(rows(14), ROLL).cost, 72) is None


def test_distinct_arrangements() -> None:
    cells = np.array([[0.0, 1.0], [0.0, 1.1], [0.0, 6.2], [0.0, 0.05], [0.0, 3.0]])
    far = distinct(cells, 2 * np.pi, [0.5], 10)
    assert far[:, 1].tolist() == [1.0, 6.2, 3.0]
    near = distinct(cells, 2 * np.pi, [0.5, 0.08], 10)
    assert near[:, 1].tolist() == [1.0, 6.2, 3.0, 1.1, 0.05]


def test_step_that_does_not_divide_a_turn_is_made_smaller() -> None:
    phasing = choose_phases(rows(2), [FORCE], Phases(radians(7)))
    assert np.degrees(phasing.step) == pytest.approx(360 / 52)
    assert np.degrees(phasing.phases[1]) == pytest.approx(180.0, abs=1e-6)


def test_row_1_keeps_its_phase_and_rows_their_places() -> None:
    machine = rows(3, 0.3).with_rows(replace(row, phase=row.phase + 8.0) for row in rows(3).rows)
    phasing = choose_phases(machine, [FORCE])
    assert phasing.phases[0] == 8.0
    assert [row.phase for row in phasing.machine.rows] == list(phasing.phases)
    assert [row.lateral for row in phasing.machine.rows] == [row.lateral for row in machine.rows]


@pytest.mark.exhaustive(but=["squares"])
@pytest.mark.parametrize("combine", ["sum", "squares"])
def test_combined_value(combine: str) -> None:
    wishes = [replace(FORCE, weight=2.0), Objective("drive_torque", "ripple")]
    phasing = choose_phases(rows(3, 0.5), wishes, combine=combine)  # type: ignore[arg-type]
    shares = np.array([phasing.after[w.name] / phasing.before[w.name] for w in wishes])
    weights = np.array([2.0, 1.0])
    expected = weights @ shares if combine == "sum" else np.sqrt(weights @ shares**2)
    assert phasing.combined[1] == pytest.approx(expected, rel=1e-12)
    assert phasing.combined[0] == pytest.approx(3.0 if combine == "sum" else np.sqrt(3.0))


def test_objective_that_is_0_before_counts_over_all_rows_alone() -> None:
    phasing = choose_phases(rows(2), [FORCE, ROLL])
    assert phasing.before[ROLL.name] == 0.0
    assert notes_by(phase_search._notes, phasing.notes, name="rms of roll_moment")
    first = choose_phases(rows(2, 0.7), [ROLL]).before[ROLL.name]
    assert phasing.after[ROLL.name] >= 0.0
    assert first > 0


# Rows are counted in the tests above.
@pytest.mark.exhaustive
def test_many_rows_are_noted() -> None:
    phasing = choose_phases(rows(6), [FORCE])
    assert np.degrees(phasing.step) == pytest.approx(10.0)
    assert "a grid of 5 deg has too many arrangements: one of 10 deg" in str(phasing.notes[0])
    more = choose_phases(rows(13), [FORCE, ROLL], combine="squares")
    assert more.combinations == 0
    assert 0 <= more.bound < more.combined[1]
    assert "before the optimum was proved" in str(more.notes[-1])
    assert "too many rows for a grid" in str(more.notes[0])
    assert more.combined[1] < 0.2


# Fewer equal rows: tests/laws/test_phases.py.
@pytest.mark.exhaustive
def test_many_equal_rows_are_laid_out_too() -> None:
    """More orders than can be tried: no swap of two rows twists less."""
    machine = rows(10)
    phasing = choose_phases(machine, [FORCE], Phases(radians(30)))
    assert phasing.remaining[0] == 10.0
    twist = np.hypot(*(after for _, after in phasing.lateral.values()))
    sorted_rows = machine.with_rows(
        replace(row, phase=phase)
        for row, phase in zip(machine.rows, sorted(phasing.phases), strict=True)
    )
    again = choose_phases(sorted_rows, [FORCE], Phases(radians(30)))
    assert twist < 0.5 * np.hypot(*(before for before, _ in again.lateral.values()))


def progress_by_parts(objective: Objective) -> list[list[tuple[int, int]]]:
    """What a search of 3 rows tells, by the parts of the work: each has a total of its own."""
    texts: list[tuple[int, int]] = []
    choose_phases(rows(3), [objective], progress=lambda done, total: texts.append((done, total)))
    return [[*part] for _, part in groupby(texts, key=lambda step: step[1])]


@pytest.mark.exhaustive(but=["rms"])
@pytest.mark.parametrize("measure", ["rms", "peak"])
def test_progress_is_reported(measure: Statistic) -> None:
    """Of the grid, of the refining and of the proof; each goes on and never back."""
    grid, refining, proof = progress_by_parts(replace(FORCE, measure=measure))
    for part in (grid, refining, proof):
        done = [step for step, _ in part]
        assert done == sorted(done)
        assert done[-1] <= part[0][1]
    assert grid[-1][0] == grid[-1][1]
    assert refining[0][0] == 0
    assert refining[-1][0] == refining[-1][1]


# Progress: the test above.
@pytest.mark.exhaustive
def test_each_arrangement_reports_of_its_steps() -> None:
    """Which takes a minute where a cycle has many turns and peaks count."""
    _, refining, _ = progress_by_parts(replace(FORCE, measure="peak"))
    cost = PhaseSearch(rows(3), (replace(FORCE, measure="peak"),), Phases(), "sum").cost
    cells = refining[-1][1] // most_steps(cost)
    assert 1 <= cells <= MOST_KINKED
    assert len(refining) >= 3 * cells


# Interrupts of searches: tests/unit/studies/test_run.py.
@pytest.mark.exhaustive
def test_refining_is_interrupted_between_two_steps() -> None:
    heard = []

    def interrupt(done: int, total: int) -> None:
        heard.append(total)
        if heard.count(total) == 3 and total == heard[-2]:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        choose_phases(rows(3), [replace(FORCE, measure="peak")], progress=interrupt)


def test_a_long_cycle_of_few_orders_is_computed_from_these() -> None:
    """The other orders of 60 turns are rounding, thousands of them."""
    machine = replace(rows(2), frame={**rows(2).frame, "L": (0.8, 0.0)})
    wheel = replace(machine.links["crank"], points={"L": (0.0, 0.0)}, center_of_mass=(0.01, 0.0))
    turned = eq.Gear("crank", "wheel", teeth=(61, 60))
    long = replace(machine, links={**machine.links, "wheel": wheel}, gears=(turned,))
    signals = PhasedRows(long).signals(FORCE)
    assert signals.turns == 60
    whole = signals.amplitudes.shape[-1]
    assert whole > 1000
    assert len(present(signals.amplitudes)) < whole / 30
    theta = np.linspace(0, signals.turns * 2 * pi, 50, endpoint=False)
    there = forces(eq.move(long, theta, acceleration=0.0)).shaking_force.value
    got = Periodic(signals.alone(0).amplitudes[0, 0], signals.turns).values(theta)
    assert got == pytest.approx(np.array([there.real, there.imag]), abs=1e-9 * np.max(abs(there)))


def test_values() -> None:
    phasing = choose_phases(rows(2), [FORCE])
    values = json.loads(json.dumps(phasing.to_dict()))
    assert values["phases"] == pytest.approx([0.0, np.pi])
    assert values["objectives"][0]["name"] == "rms of shaking_force"
    assert values["remaining_orders"][:3] == [2.0, 4.0, 6.0]
    assert values["lateral"]["roll_moment"]["before"] == 0.0
    assert values["combinations"] == 72
    assert 0 <= values["combined"]["after"] - values["bound"] <= CLOSE
    assert values["looked_at"] > 1
    assert values["notes"] == []


def test_printed() -> None:
    reported = printed(choose_phases(rows(4), [FORCE, ROLL]).blocks())
    assert "Remaining orders of the shaking force: 2, 4, 6, 8" in reported
    assert [line.split() for line in reported.splitlines() if line.startswith("4 ")] == [
        ["4", "450.0", "0", "0", "0.0"]
    ]
    assert "roll moment" in reported
