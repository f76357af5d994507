"""How far a crank swings that cannot turn fully."""

from __future__ import annotations

from dataclasses import replace
from math import acos, pi

import pytest

import equipoise as eq
from equipoise.errors import RangeError
from equipoise.figures.linkage import linkage
from equipoise.mechanism.assembly.linkage import assemble
from equipoise.mechanism.assembly.reach import Reach, reach
from equipoise.mechanism.kinematics.swinging import swing
from equipoise.mechanism.parts.laws import AngleLaw
from support.refusals import refused
from unit.mechanism.build import crank_rocker, four_bar, heavy


def reach_of(machine: eq.Machine) -> Reach:
    first = reach(assemble(machine))
    assert first is not None
    return first


def test_ends_where_the_dyad_is_stretched() -> None:
    first = reach_of(four_bar(1.0, 0.9, 0.5, 0.55))
    limit = acos((1.0 + 0.81 - 1.05**2) / 1.8)
    assert (first.low, first.high) == pytest.approx((-limit, limit), abs=1e-7)
    assert first.others == 0
    assert str(first.note) == (
        "the crank cannot turn fully: it stops at -66.86 deg and at 66.86 deg, where 'coupler' and "
        "'rocker' lie in line"
    )


def test_of_two_ranges_the_one_that_is_nearer_to_0() -> None:
    first = reach_of(four_bar(1.0, 0.8, 0.3, 0.9))
    near, far = (acos((1.0 + 0.64 - side**2) / 1.6) for side in (0.6, 1.2))
    assert (first.low, first.high) == pytest.approx((near, far), abs=1e-7)
    assert first.others == 1


def test_a_later_dyad_may_end_it_sooner() -> None:
    machine = eq.load("watt-six-bar")
    points = {"G": (0.0, 0.0), "F": (0.03, 0.0)}
    stopped = machine.with_link("output", points=points)
    with pytest.raises(RangeError) as caught:
        eq.move(stopped)
    first = reach_of(stopped)
    ends = [round(end % (2 * pi), 6) for end in (first.low, first.high)]
    assert ends in [[round(x % (2 * pi), 6) for x in pair] for pair in caught.value.ranges]
    assert "'output'" in first.stops[0]


@pytest.mark.parametrize("machine", [crank_rocker(), eq.load("class-three")])
def test_a_crank_that_turns_has_no_range(machine: eq.Machine) -> None:
    assert reach(assemble(machine)) is None


def test_it_swings_by_a_sine_a_little_short_of_its_ends() -> None:
    machine = four_bar(1.0, 0.9, 0.5, 0.55)
    first, limit = swing(machine), reach_of(machine).high
    assert first is not None
    analysis = eq.analyze(first.machine, 90)
    angle = analysis.motion.links["crank"].angle
    assert (angle.min(), angle.max()) == pytest.approx((-0.8 * limit, 0.8 * limit), rel=1e-3)
    assert analysis.solved is not None and analysis.motion.whole_cycle
    assert str(first.note).startswith("the crank cannot turn fully: it stops at -66.86 deg")
    assert 'motion = { between = ["-53.5 deg", "53.5 deg"] }' in str(first.note)
    assert swing(crank_rocker()) is None and swing(first.machine) is None


def test_gears_stay_in_mesh_while_it_swings() -> None:
    """The geared link is as where the crank passes the same angle in the file's machine."""
    machine = four_bar(1.0, 0.9, 0.5, 0.55)
    frame = {**machine.frame, "W": (0.0, 0.4)}
    links = {**machine.links, "wheel": heavy(W=(0.0, 0.0), X=(0.1, 0.0))}
    gears = (eq.Gear("crank", "wheel", -2.0, start=0.3),)
    geared = replace(machine, frame=frame, links=links, gears=gears)
    first = swing(geared)
    assert first is not None
    moved = eq.move(first.machine, 12)
    own = eq.move(geared, moved.links["crank"].angle)
    assert moved.links["wheel"].angle == pytest.approx(own.links["wheel"].angle)


def test_a_motion_beyond_the_range_is_reported() -> None:
    machine = four_bar(1.0, 0.9, 0.5, 0.55)
    far = replace(machine.drive, motion=AngleLaw(between=(0.0, 1.3)))
    with refused(RangeError, link="crank"):
        eq.move(replace(machine, drive=far))


def test_pictures_show_both_ends() -> None:
    first = swing(four_bar(1.0, 0.9, 0.5, 0.55))
    assert first is not None
    chart = linkage(eq.analyze(first.machine, 60))
    assert "pale: crank at both ends, −53.5° and 53.5°" in chart.words
    (panel,) = chart.panels
    assert [shape.role for shape in panel.ground].count("row") == 6
