"""Yamashita, Ichikawa and Mori: phases between planting mechanisms, and how claws are arranged.

Sections 5-5 and 5-6, equations (70) to (72), figures 16 and 17, Table 5; `support.sources` has the
citation.

Data: type II of its Table 3, the example ``yamashita-2``.  The acceleration of the common centre of
mass is minus the shaking force over the mass of the links.  Its X is the angle by which the second
crank is ahead, `Row.phase`; U is the standard deviation of the sum of both accelerations over a
turn.  Neither depends on where crank angles count from.  The claws of Table 5 are rows side by side
at equal distances; "twist" (nejire) is a moment about the axes along or across the machine.

U is smallest at 180 deg by symmetry, to rounding.
"""

from __future__ import annotations

from functools import partial
from math import pi, radians

import numpy as np
import pytest

import equipoise as eq
from equipoise.balancing.patterns import PATTERNS, arranged, halved, patterns_for
from equipoise.balancing.phase_search import choose_phases
from equipoise.mechanism.parts.balance import Objective
from equipoise.mechanism.parts.support import Row
from equipoise.signals import Periodic
from literature.yamashita import TYPE_2, Finger, by_table_3, vertical_acceleration
from support.conformance import Observation, Printed, equation, published
from support.sources import YAMASHITA

MACHINE = eq.load("yamashita-2")
U = Objective("shaking_force.y", "ripple")


def acceleration(axis: str = "y") -> Periodic:
    """Acceleration of the common centre of mass of one claw, m/s2."""
    analysis = eq.analyze(MACHINE, 720, acceleration=0.0)
    return analysis.by_order[f"mass_center.a{axis}"]


def rows(*phases: float) -> eq.Machine:
    """Claws 300 mm apart, in the middle of the machine."""
    middle = (len(phases) - 1) / 2
    return MACHINE.with_rows(
        Row(phase, 0.3 * (number - middle)) for number, phase in enumerate(phases)
    )


# -- two claws -------------------------------------------------------------------------------------


@published(
    YAMASHITA, Printed("two of yamashita-2", "best phase X", "section 5-5", "180", unit="deg")
)
def test_two_claws_are_best_half_a_turn_apart() -> float:
    phasing = choose_phases(rows(0.0, 0.0), [U])
    assert phasing.phases == (0.0, pi)
    assert phasing.after[U.name] == pytest.approx(np.std(sums(pi)) * links_mass(), rel=1e-9)
    return float(np.degrees(phasing.phases[1]))


def links_mass() -> float:
    return sum(link.mass or 0.0 for link in MACHINE.links.values())


def sums(phase: float, axis: str = "y") -> np.ndarray:
    """Acceleration of two claws together over a turn, m/s2."""
    first = acceleration(axis)
    return (first + first.shifted(phase)).samples(7200)


def test_deviation_against_phase_is_symmetric_with_one_minimum() -> None:
    """Figure 16: U falls from 0 to 180 deg and rises again as it fell."""
    deviations = np.array([np.std(sums(phase)) for phase in np.radians(np.arange(0, 361, 5))])
    assert deviations == pytest.approx(deviations[::-1], rel=1e-9)
    assert np.all(np.diff(deviations[:37]) < 0)


def less_at_180(axis: str, sign: int) -> float:
    """By how much the largest or smallest acceleration is less than in phase, %."""
    high, low = (np.max(sign * sums(phase, axis)) for phase in (0.0, pi))
    return 100 * float(1 - low / high)


def finger_less_at_180(sign: int, finger: Finger) -> float:
    """The same by the paper's equations."""
    first = sign * vertical_acceleration(finger)
    return 100 * float(1 - np.max(first + np.roll(first, len(first) // 2)) / np.max(2 * first))


def short_of_both(sign: int, most: float) -> Observation:
    """What two causes that were thought of leave."""

    def is_short() -> bool:
        low, high = by_table_3(TYPE_2, partial(finger_less_at_180, sign)).gives()
        within = low < less_at_180("y", sign) < high
        return within and round(high, 1) == most and not any(map(sampled_as_printed, STEPS))

    words = f"half a digit of Table 3 gives {most} at most; samples never give both"
    return Observation(words, is_short)


STEPS = [step for step in range(3, 31) if 360 % step == 0]


def sampled_as_printed(step: int) -> bool:
    """Whether samples every so many degrees, wherever they begin, give 77 and 60 %, to half a
    digit, together.
    """
    first, both = (np.append(sums(phase), sums(phase)) for phase in (0.0, pi))
    at = np.arange(20 * step)[:, None] + np.arange(0, 7200, 20 * step)
    largest = 100 * (1 - np.max(both[at], axis=1) / np.max(first[at], axis=1))
    smallest = 100 * (1 - np.min(both[at], axis=1) / np.min(first[at], axis=1))
    return bool(np.any((np.abs(largest - 77) <= 0.5) & (np.abs(smallest - 60) <= 0.5)))


@published(
    YAMASHITA,
    Printed("two of yamashita-2", "largest Y_G'' less by", "section 5-5", "77", "74.0", "%",
            why=short_of_both(1, 74.9), of=1),
    Printed("two of yamashita-2", "smallest Y_G'' less by", "section 5-5", "60", "52.5", "%",
            why=short_of_both(-1, 55.1), of=-1),
)  # fmt: skip
def test_reduction_of_the_largest_and_smallest_acceleration(row: Printed) -> float:
    return less_at_180("y", row.of)


def test_horizontally_about_the_same() -> None:
    """Section 5-5, without figures."""
    assert [less_at_180("x", sign) for sign in (1, -1)] == pytest.approx([64.8, 65.4], abs=0.05)


@equation(
    YAMASHITA, "(70) to (72)", "even orders are left at twice their size", 1e-12,
    "(72) lacks the factor of 2 of its sum, which its mean has",
)  # fmt: skip
def test_even_orders_are_left_at_twice_their_size() -> None:
    """(71), (72), and figure 17: the sum repeats after half a turn."""
    first = acceleration()
    both = first + first.shifted(pi)
    assert np.max(both.sizes[1::2]) < 1e-14 * first.sizes[1]
    assert both.amplitudes[2::2] == pytest.approx(2 * first.amplitudes[2::2], rel=1e-12)
    phasing = choose_phases(rows(0.0, 0.0), [U])
    assert phasing.remaining
    assert all(order % 2 == 0 for order in phasing.remaining)


@pytest.mark.parametrize("order", [1, 2, 3, 4, 5])
def test_an_order_vanishes_at_pi_over_itself(order: int) -> None:
    """Section 5-6: R_n goes where the second claw is ahead by pi / n.

    A single order is best removed at any odd multiple of that; the grid's first one is as good.
    """
    first = acceleration()
    gone = (first + first.shifted(pi / order)).sizes
    assert gone[order] < 1e-14 * first.sizes[1]
    phasing = choose_phases(rows(0.0, 0.3), [Objective("shaking_force.y", orders=(order,))])
    assert phasing.after.popitem()[1] == pytest.approx(0.0, abs=1e-9)
    assert (phasing.phases[1] * order / pi) % 2 == pytest.approx(1.0, abs=1e-9)


# -- four and six claws ----------------------------------------------------------------------------

TABLE_5 = {
    "4 quarter turns": ("0 180 270 90", {4: 4}, True),
    "4 mirrored": ("0 180 180 0", {2: 4}, False),
    "6 alternate": ("0 180 0 180 180 0", {2: 6}, True),
    "6 in pairs": ("0 180 180 0 0 180", {2: 6}, True),
    "6 quarter turns at the end": ("0 180 0 180 270 90", {4: 6, 2: 2}, True),
    "6 quarter turns within": ("0 180 270 90 180 0", {4: 6, 2: 2}, True),
}
"""Phases, deg; what is left as the table has it, up to the order from which all repeats; twist.
"4m of four claws and 2m of two": at the orders 4m all six are in phase, four as a set and two."""


@pytest.mark.parametrize("name", TABLE_5)
def test_table_5(name: str) -> None:
    degrees, left, twists = TABLE_5[name]
    pattern = PATTERNS[name]
    assert pattern.phases == pytest.approx([radians(float(part)) for part in degrees.split()])
    assert dict(pattern.remaining) == pytest.approx(left)
    assert pattern.twists is twists


@equation(YAMASHITA, "Table 5", "orders and twist that each arrangement leaves", 1e-11)
@pytest.mark.parametrize("name", TABLE_5)
def test_table_5_on_type_ii(name: str) -> None:
    """The same found on the sum of six or four accelerations, and on its twist."""
    pattern, first = PATTERNS[name], acceleration()
    total, turned = first * 0.0, first * 0.0
    for phase, place in zip(pattern.phases, pattern.places, strict=True):
        total = total + first.shifted(phase)
        turned = turned + first.shifted(phase) * place
    for order in range(1, 9):
        left = pattern.remaining.get(order % pattern.cycle or pattern.cycle, 0.0)
        assert total.sizes[order] == pytest.approx(left * first.sizes[order], abs=1e-11)
    assert (float(turned.rms) > 1e-9) is pattern.twists


def test_pairs_half_a_turn_apart_and_sets_a_quarter() -> None:
    """Section 5-6 (a), conclusion 6): pairs of pi, and pi / 2 from pair to pair."""
    assert np.degrees(halved(4).phases).tolist() == [0.0, 180.0, 90.0, 270.0]
    assert sorted(halved(4).phases) == sorted(PATTERNS["4 quarter turns"].phases)


# Pairs find the paper's phases in the other tests of this file.
@pytest.mark.exhaustive
def test_all_phases_at_once_find_the_same_as_pairs() -> None:
    """Section 5-6 (1), which was too long to compute: four rows of type II end up in the pattern
    that the rule has, with the least twist that its phases can have.
    """
    phasing = choose_phases(rows(0.0, 0.0, 0.0, 0.0), [U])
    assert sorted(phasing.phases) == pytest.approx(sorted(halved(4).phases), abs=1e-9)
    assert all(order % 4 == 0 for order in phasing.remaining)
    printed = arranged(MACHINE, "4 quarter turns", 0.3)
    as_printed = choose_phases(printed, [U])
    assert as_printed.after == pytest.approx(phasing.after, rel=1e-9)
    for name, (_, after) in phasing.lateral.items():
        assert after == pytest.approx(as_printed.lateral[name][0], rel=1e-9)


def test_left_and_right_in_balance_cost_force() -> None:
    """Table 5: what leaves no twist, 4 (b), leaves the even orders."""
    force, roll = (Objective(name) for name in ("shaking_force", "roll_moment"))
    phasing = choose_phases(rows(0.0, 0.5, 1.0, 1.5), [force, roll])
    assert phasing.phases == pytest.approx(PATTERNS["4 mirrored"].phases, abs=1e-9)
    assert phasing.after[roll.name] == 0.0
    quarter = choose_phases(arranged(MACHINE, "4 quarter turns", 0.3), [force])
    assert phasing.after[force.name] > 2 * quarter.after[force.name]


def test_bundled_example() -> None:
    """Four rows in phase; in the phases found, 16 % of the shaking force is left (recomputed)."""
    machine = eq.load("four-row-transplanter")
    assert machine.balance is not None
    phasing = choose_phases(machine, machine.balance.objectives, machine.balance.phases)
    assert np.degrees(phasing.phases) == pytest.approx([0.0, 180.0, 270.0, 90.0], abs=1e-9)
    assert phasing.combined == pytest.approx((1.0, 0.15912), abs=5e-6)


def test_patterns_of_the_paper_come_first() -> None:
    assert [p.name for p in patterns_for(4)] == ["4 quarter turns", "4 mirrored"]
    assert [p.source[:7] for p in patterns_for(6)][:4] == ["Table 5"] * 4
