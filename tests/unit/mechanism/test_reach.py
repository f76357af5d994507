"""How far a crank swings that cannot turn fully."""

from __future__ import annotations

from math import acos, pi

import pytest

import equipoise as eq
from equipoise.errors import RangeError
from equipoise.mechanism.linkage import assemble
from equipoise.mechanism.reach import Reach, reach
from unit.mechanism.build import crank_rocker, four_bar


def found(machine: eq.Machine) -> Reach:
    one = reach(assemble(machine))
    assert one is not None
    return one


def test_ends_where_the_dyad_is_stretched() -> None:
    one = found(four_bar(1.0, 0.9, 0.5, 0.55))
    limit = acos((1.0 + 0.81 - 1.05**2) / 1.8)
    assert (one.low, one.high) == pytest.approx((-limit, limit), abs=1e-7)
    assert one.others == 0
    assert str(one.note) == (
        "the crank swings between -66.86 deg ('coupler' and 'rocker' lie in line) and 66.86 deg "
        "('coupler' and 'rocker' lie in line)"
    )


def test_of_two_ranges_the_one_that_is_nearer_to_0() -> None:
    one = found(four_bar(1.0, 0.8, 0.3, 0.9))
    near, far = (acos((1.0 + 0.64 - side**2) / 1.6) for side in (0.6, 1.2))
    assert (one.low, one.high) == pytest.approx((near, far), abs=1e-7)
    assert one.others == 1


def test_a_later_dyad_may_end_it_sooner() -> None:
    machine = eq.load("watt-six-bar")
    points = {"G": (0.0, 0.0), "F": (0.03, 0.0)}
    stopped = machine.with_link("output", points=points)
    with pytest.raises(RangeError) as caught:
        eq.move(stopped)
    one = found(stopped)
    ends = [round(end % (2 * pi), 6) for end in (one.low, one.high)]
    assert ends in [[round(x % (2 * pi), 6) for x in pair] for pair in caught.value.ranges]
    assert "'output'" in one.stops[0]


@pytest.mark.parametrize("machine", [crank_rocker(), eq.load("class-three")])
def test_a_crank_that_turns_has_no_range(machine: eq.Machine) -> None:
    assert reach(assemble(machine)) is None
