"""Arrangements of rows by name: their phases, what they leave, and machines laid out in them."""

from __future__ import annotations

from math import pi

import numpy as np
import pytest

import equipoise as eq
from equipoise.balancing.multi_row import Rows
from equipoise.balancing.patterns import (
    PATTERNS,
    Pattern,
    arranged,
    halved,
    pattern_blocks,
    pattern_named,
    patterns_for,
)
from equipoise.errors import UsageError
from equipoise.mechanism.balance import Objective
from equipoise.mechanism.support import Row
from support.printing import words

MACHINE = eq.load("yamashita-2")


@pytest.mark.parametrize("count", range(2, 17))
def test_names_tell_the_number_of_rows_and_lead_back(count: int) -> None:
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
    found = arranged(machine, pattern, 0.25)
    assert {row.offset for row in found.rows} == {(0.1, -0.2)}
    assert [row.lateral for row in found.rows] == [-0.25, 0.0, 0.25]
    assert dict(pattern.remaining) == pytest.approx({3: 3.0})


@pytest.mark.parametrize("name", ["4 mirrored", "6 quarter turns within"])
def test_lever_times_force_is_the_roll_moment(name: str) -> None:
    """Order by order, on a machine."""
    pattern, spacing = PATTERNS[name], 0.3
    rows = Rows(arranged(MACHINE, name, spacing))
    phases = np.array(pattern.phases)
    roll = np.abs(rows.signals(Objective("roll_moment")).total(phases)[0, 0])
    force = np.abs(rows.signals(Objective("shaking_force.y")).amplitudes[0, 0, 0])
    for order in range(1, 9):
        expected = pattern.lever(order) * spacing * force[order]
        assert roll[order] == pytest.approx(expected, abs=1e-12 * force[1])


@pytest.mark.parametrize(
    ("call", "sentence"),
    [
        (lambda: halved(6).phases, "got 6 rows; halving needs 2, 4, 8 or another power of two"),
        (lambda: halved(1).phases, "got 1 rows; halving needs"),
        (lambda: patterns_for(1), "got 1 rows; give two at least"),
        (lambda: pattern_named("4 mirror"), "did you mean '4 mirrored'"),
        (lambda: pattern_named("mirrored"), "no pattern is called 'mirrored'"),
        (lambda: pattern_named(""), "no pattern is called ''"),
        (lambda: arranged(MACHINE, "2 opposed", 0.0), "got a spacing of 0 m; give more than 0"),
        (lambda: arranged(MACHINE, "2 opposed", float("nan")), "got a spacing of nan m"),
    ],
)
def test_refused(call, sentence: str) -> None:  # type: ignore[no-untyped-def]
    with pytest.raises(UsageError) as caught:
        call()
    assert sentence in str(caught.value)


def test_values() -> None:
    values = PATTERNS["6 quarter turns at the end"].to_dict()
    assert values["remaining"] == pytest.approx({"2": 2.0, "4": 6.0})
    assert values["cycle"] == 4
    assert values["twists"] is True
    assert len(values["levers"]) == 4


@pytest.mark.parametrize("count", [2, 3, 4, 6, 8])
def test_printed(count: int) -> None:
    told = words(pattern_blocks(MACHINE, count, 0.3))
    assert all(pattern.name in told for pattern in patterns_for(count))
    assert "all in phase" in told
