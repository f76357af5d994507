"""Linkages whose crank cannot turn fully, or not in a definite way."""

from __future__ import annotations

import pickle
import re
from dataclasses import replace
from math import acos, asin, degrees, pi

import numpy as np
import pytest

import equipoise as eq
from equipoise.errors import (
    ChangePointError,
    EquipoiseError,
    ModelError,
    MotionError,
    RangeError,
    UsageError,
)
from equipoise.mechanism.assembly import reach
from equipoise.mechanism.kinematics.swinging import swing
from equipoise.mechanism.parts.machine import FRAME
from support.refusals import refused
from unit.mechanism.build import ORIGIN, crank_rocker, four_bar, heavy, machine, slider_crank


def limits_of(given: eq.Machine) -> tuple[tuple[float, float], ...]:
    with pytest.raises(RangeError) as caught:
        eq.move(given)
    return caught.value.ranges


def opposite(item: float, other: float, side: float) -> float:
    """Angle of a triangle between two sides."""
    return acos((item**2 + other**2 - side**2) / (2 * item * other))


def leaning(given: eq.Machine, lean: float) -> eq.Machine:
    """A four-bar whose frame is turned about the drive's pivot, rad."""
    (length, _) = given.frame["D"]
    place = (length * np.cos(lean), length * np.sin(lean))
    return replace(given, frame={**given.frame, "D": place})


def same_angles(got: object, want: object) -> None:
    np.testing.assert_allclose(np.degrees(got), np.degrees(want), rtol=0, atol=1e-6)


# -- limits ----------------------------------------------------------------------------------------


def test_a_triple_rocker_stops_where_its_dyad_is_stretched() -> None:
    """Crank and frame close a triangle with the stretched dyad."""
    limit = opposite(1.0, 0.9, 0.5 + 0.55)
    same_angles(limits_of(four_bar(1.0, 0.9, 0.5, 0.55)), [(-limit, limit)])


def test_a_double_rocker_has_two_ranges() -> None:
    """Between folded and stretched dyad, on either side of the frame's line."""
    near, far = opposite(1.0, 0.8, 0.9 - 0.3), opposite(1.0, 0.8, 0.9 + 0.3)
    limits = limits_of(four_bar(1.0, 0.8, 0.3, 0.9))
    same_angles(sorted(limits), [(near, far), (2 * pi - far, 2 * pi - near)])


def test_of_hundreds_of_ranges_the_first_are_listed() -> None:
    """Crank and wheel turn 60 and 61 times, and the bars between their pins are too short."""
    parted = machine(
        {"A": ORIGIN, "E": (0.5, 0.0)},
        {
            "crank": heavy(A=ORIGIN, B=(0.3, 0.0)),
            "wheel": heavy(E=ORIGIN, F=(0.3, 0.0)),
            "bar": heavy(B=ORIGIN, C=(0.3, 0.0)),
            "rod": heavy(F=ORIGIN, C=(0.2, 0.0)),
        },
        gears=(eq.Gear("crank", "wheel", teeth=(61, 60)),),
        assembly={"C": "left"},
    )
    with pytest.raises(RangeError) as caught:
        eq.move(parted)
    count = len(caught.value.ranges)
    assert count > 50
    assert f"reach each other only in {count} ranges of crank angle, the first from" in str(
        caught.value
    )
    assert len(str(caught.value)) < 400


def test_the_frame_turned_turns_the_range() -> None:
    limit, lean = opposite(1.0, 0.9, 0.5 + 0.55), 2.5
    same_angles(
        limits_of(leaning(four_bar(1.0, 0.9, 0.5, 0.55), lean)), [(lean - limit, lean + limit)]
    )


@pytest.mark.parametrize("end", [-1, 1])
@pytest.mark.parametrize("beside", [-0.25, -0.1, 0.1])
def test_a_range_that_ends_beside_crank_angle_0(end: int, beside: float) -> None:
    """The end lies between the last point of the grid and its first."""
    limit = opposite(1.0, 0.9, 0.5 + 0.55)
    lean = float(np.radians(beside)) - end * limit
    (actual,) = limits_of(leaning(four_bar(1.0, 0.9, 0.5, 0.55), lean))
    turns = round((actual[0] - lean + limit) / (2 * pi))
    same_angles(np.array(actual) - 2 * pi * turns, (lean - limit, lean + limit))


def test_a_slider_crank_with_a_short_rod() -> None:
    given = slider_crank()
    short = given.with_link("rod", points={"B": ORIGIN, "C": (0.2, 0.0)})
    limit = asin(0.2 / 0.3)
    same_angles(sorted(limits_of(short)), [(-limit, limit), (pi - limit, pi + limit)])


@pytest.mark.parametrize("seed", range(20))
def test_the_swing_that_is_suggested_keeps_away_from_dead_positions(seed: int) -> None:
    """At its ends too transmission angles are 40 deg and more, or a tenth of the range is left."""
    rng, count = np.random.default_rng(seed), 0
    for lengths in rng.uniform(0.3, 1.0, (12, 4)):
        given = four_bar(*lengths)
        try:
            swung = swing(given)
        except MotionError:
            continue
        if swung is None:
            continue
        low, high = swung.machine.drive.motion.between
        away = min(low - swung.reach.low, swung.reach.high - high)
        angles = eq.analyze(swung.machine, 90).summary["transmission.C"]
        with pytest.raises(MotionError) as caught:
            eq.move(given)
        sentence = str(caught.value)
        if "keeps transmission angles of 40 deg" in sentence:
            assert np.degrees([angles.min, pi - angles.max]).min() > 39.5  # ends are rounded
        else:
            assert "a tenth of the range" in sentence
            assert away == pytest.approx(0.1 * (swung.reach.high - swung.reach.low), rel=0.02)
        count += 1
    assert count > 2


def test_the_message_reports_links_and_angles() -> None:
    limit = degrees(opposite(1.0, 0.9, 0.5 + 0.55))
    message = (
        f"the crank cannot turn fully: it stops at {-limit:.2f} deg and at {limit:.2f} deg, where "
        "'coupler' and 'rocker' lie in line; B and D are 100.0 mm to 1900 mm apart; with 500.0 mm "
        "from B to C in links.coupler.points and 550.0 mm from D to C in links.rocker.points they "
        "have to be 50.00 mm to 1050 mm apart; change a length or direction, or let it swing by a "
        "motion in [drive]; the motion below stays a tenth of the range away from both ends, near "
        'which forces grow without bound\n\nmotion = { between = ["-53.5 deg", "53.5 deg"] }'
    )
    with pytest.raises(RangeError) as caught:
        eq.move(four_bar(1.0, 0.9, 0.5, 0.55))
    assert str(caught.value) == message


def test_a_crank_that_stops_turns_fully_within_the_lengths_that_are_said() -> None:
    """A crank of 330 mm on a frame of 300 mm: its pin is 30 to 630 mm from the rocker's."""
    with pytest.raises(RangeError) as caught:
        eq.move(four_bar(0.33, 0.3, 0.33, 0.09))
    apart, wanted = re.findall(r"(\d\S*) mm to (\d\S*) mm apart", str(caught.value))
    assert (apart, wanted) == (("30.00", "630.0"), ("240.0", "420.0"))
    assert eq.move(four_bar(0.08, 0.33, 0.33, 0.09)).turns == 1  # 250 to 410 mm
    for crank, frame in ((0.1, 0.33), (0.1, 0.33 + 0.02)):  # 230 to 430, and 250 to 450 mm
        with refused(RangeError, low="240.0 mm", high="420.0 mm", first="B"):
            eq.move(four_bar(crank, frame, 0.33, 0.09))


def test_of_two_ranges_it_reports_that_there_is_another() -> None:
    with refused(RangeError, first="B", second="D"):
        eq.move(four_bar(1.0, 0.8, 0.3, 0.9))


def test_a_linkage_that_never_closes() -> None:
    with refused(RangeError, first="B", second="D") as caught:
        eq.move(four_bar(5.0, 0.9, 0.5, 0.7))
    assert caught.value.ranges == ()
    said = str(caught.value)  # what is given, and where
    assert "links.coupler.points" in said
    assert "links.rocker.points" in said


def test_the_refusal_of_a_linkage_that_never_closes_lets_it_be_mended() -> None:
    """The distance of the pins that is said to be right is that from which on it can be joined."""
    with pytest.raises(RangeError) as caught:
        eq.move(four_bar(0.1, 2.0, 0.5, 0.7))
    wrong, right = re.findall(r"(\d\S* m?m) to (\d\S* m?m) apart", str(caught.value))
    assert wrong == ("1900 mm", "2100 mm")
    assert right == ("200.0 mm", "1200 mm")
    for frame in (1.2 + 0.099, 0.2 - 0.099):  # of some crank angle alone
        with refused(RangeError, first="B", second="D") as caught:
            eq.move(four_bar(0.1, frame, 0.5, 0.7))
        assert caught.value.ranges
    with refused(RangeError, first="B", second="D"):
        eq.move(four_bar(0.1, 1.2 + 0.101, 0.5, 0.7))


@pytest.mark.parametrize(
    ("gap", "lean"),
    [(1e-3, 0.0), (1e-3, 0.25), (1e-6, 0.0), (1e-6, 0.1), (1e-6, 0.25), (1e-9, 0.25)],
)
def test_a_narrow_gap(gap: float, lean: float) -> None:
    """Stretched, the dyad falls short only within a small angle, wherever the frame points."""
    a, b, c = 1.0, 0.3, 0.7
    d = a + b - c - gap
    limits = limits_of(leaning(four_bar(a, b, c, d), float(np.radians(lean))))
    limit = opposite(a, b, c + d)
    same_angles(np.diff(limits[0]), 2 * limit)
    assert len(limits) == 1


@pytest.mark.parametrize("lean", [0.0, 0.4, 2.09])
def test_a_gap_between_the_points_of_the_grid(lean: float) -> None:
    """A block on a crank of 1 m passes the pivot of its guide 0.3 mm off, and the guide lies 1 mm
    off the pivot: within about 0.001 rad, a small part of the grid's step, it cannot be reached.
    """
    offset, frame = 0.001, 0.9997
    far = frame * np.exp(1j * lean)
    given = machine(
        {"A": ORIGIN, "D": (far.real, far.imag)},
        {
            "crank": heavy(A=ORIGIN, B=(1.0, 0.0)),
            "block": heavy(B=ORIGIN),
            "rocker": heavy(D=ORIGIN, H=(0.5, offset)),
        },
        assembly={"B": "forward"},
        sliders=(eq.Slider("block", "B", "rocker", "H", 0.0, 0.0),),
    )
    half = acos((1.0 + frame**2 - offset**2) / (2.0 * frame))
    ((begin, end),) = limits_of(given)
    assert (begin - lean) % (2 * pi) == pytest.approx(half, abs=1e-6)
    assert (lean - end) % (2 * pi) == pytest.approx(half, abs=1e-6)


def test_the_second_dyad_may_be_the_one_that_stops() -> None:
    given = eq.load("watt-six-bar")
    points = {"G": ORIGIN, "F": (0.03, 0.0)}
    with refused(RangeError, link="link", other="output", one="link") as caught:
        eq.move(given.with_link("output", points=points))
    assert "in links.link.points" in str(caught.value)
    assert "links.output.points" in str(caught.value) and "30.00 mm" in str(caught.value)


# -- within the range ------------------------------------------------------------------------------

ROCKING = four_bar(1.0, 0.9, 0.5, 0.55)
LIMIT = opposite(1.0, 0.9, 0.5 + 0.55)


def test_angles_inside_the_range() -> None:
    theta = np.linspace(-0.99, 0.99, 15) * LIMIT
    forces = eq.analyze(ROCKING, theta).forces
    b, c, d = (forces.motion.points[name].place for name in "BCD")
    np.testing.assert_allclose(abs(c - b), 0.5)
    np.testing.assert_allclose(abs(c - d), 0.55)
    assert np.all(np.isfinite(forces.drive_torque))
    assert not forces.motion.whole_cycle


@pytest.mark.parametrize("beyond", [1e-4, 0.5, pi - LIMIT])
def test_angles_outside_the_range(beyond: float) -> None:
    angle = LIMIT + beyond
    with refused(RangeError, angle=degrees(angle)) as caught:
        eq.move(ROCKING, [0.0, 0.5, angle])
    same_angles(caught.value.ranges, [(-LIMIT, LIMIT)])


def test_angles_of_links_outside_a_cycle_are_continuous() -> None:
    theta = np.linspace(-0.99, 0.99, 200) * LIMIT
    for link in eq.move(ROCKING, theta).links.values():
        assert np.max(np.abs(np.diff(link.angle))) < 0.5


def geared(lean: float) -> eq.Machine:
    """Turn the frame of the rocking four-bar and gear a weight to its rocker."""
    return replace(
        ROCKING,
        frame={**leaning(ROCKING, lean).frame, "E": (3.0, 1.0)},
        links={**ROCKING.links, "weight": heavy(E=ORIGIN)},
        gears=(eq.Gear("rocker", "weight", ratio=-0.5, start=0.2),),
    )


def test_a_gear_on_a_linkage_that_only_swings() -> None:
    theta = np.linspace(-0.9, 0.9, 31) * LIMIT
    motion = eq.move(geared(0.0), theta)
    rocker, weight = motion.links["rocker"].angle, motion.links["weight"].angle
    at_zero = int(np.argmin(np.abs(theta)))
    np.testing.assert_allclose(weight - 0.2, -0.5 * (rocker - rocker[at_zero]), atol=1e-12)


def test_a_gear_whose_start_is_out_of_reach() -> None:
    """`start` holds at crank angle 0, which this linkage cannot reach: that has to be said."""
    lean = 2.5
    with refused(EquipoiseError, last="'rocker'", first="'coupler'"):
        eq.analyze(geared(lean), lean + np.linspace(-0.9, 0.9, 5) * LIMIT)


# -- change points ---------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("lengths", "angle"),
    [
        ((1.0, 0.3, 1.0, 0.3), 0.0),
        ((1.0, 0.4, 0.8, 0.6), pi),
        ((1.0, 0.5, 0.8, 0.7), pi),
        ((0.5, 1.0, 0.5, 1.0), 0.0),
    ],
)
@pytest.mark.parametrize("lean", [0.0, 0.7, -2.1])
def test_change_points(lengths: tuple[float, ...], angle: float, lean: float) -> None:
    with pytest.raises(ChangePointError) as caught:
        eq.move(leaning(four_bar(*lengths), lean))
    apart = (caught.value.crank_angle - angle - lean + pi) % (2 * pi) - pi
    wanted = [0.0, pi] if lengths[0] == lengths[2] else [0.0]
    assert min(abs(abs(apart) - w) for w in wanted) < 1e-4
    text = f"change point at crank angle {degrees(caught.value.crank_angle):.2f} deg"
    assert text in str(caught.value)
    assert "'coupler' and 'rocker' lie in line there" in str(caught.value)


def test_angles_clear_of_the_change_points() -> None:
    """A parallelogram moves in a definite way between its change points."""
    theta = np.array([0.5, 1.0, 2.5])
    motion = eq.move(four_bar(1.0, 0.3, 1.0, 0.3), theta)
    np.testing.assert_allclose(motion.links["rocker"].angle, theta, atol=1e-13)
    np.testing.assert_allclose(motion.links["rocker"].angle_2, 0, atol=1e-12)
    with refused(MotionError, other="rocker", link="coupler"):
        eq.move(four_bar(1.0, 0.3, 1.0, 0.3), [0.5, pi])


def test_a_quick_return_whose_slot_reaches_the_crank_pin() -> None:
    """The lever's pivot lies on the crank pin's circle."""
    given = machine(
        {"A": ORIGIN, "D": (0.0, -0.4)},
        {
            "crank": heavy(A=ORIGIN, B=(0.4, 0.0)),
            "block": heavy(B=ORIGIN),
            "lever": heavy(D=ORIGIN),
        },
        sliders=(eq.Slider("block", "B", "lever", "D", 0.0),),
        assembly={"B": "forward"},
    )
    with pytest.raises((ChangePointError, RangeError)):
        eq.move(given)


def test_weakest_position_of_a_dyad() -> None:
    """Squared sine of the smallest transmission angle, and where it is."""
    number, angle = eq.mechanism.assemble(crank_rocker()).weakest["C"]
    names = eq.mechanism.four_bar(crank_rocker())
    assert names is not None
    assert names.transmission_min is not None
    assert number == pytest.approx(np.sin(names.transmission_min) ** 2, rel=1e-9)
    assert angle % (2 * pi) == pytest.approx(0.0, abs=1e-4)


def geared_dyad(length: float) -> eq.Machine:
    """Gear a lever to the rocker, and hang a dyad on the lever."""
    four = crank_rocker()
    return replace(
        four,
        frame={**four.frame, "E": (2.0, 0.0), "K": (3.5, 0.2)},
        links={
            **four.links,
            "lever": heavy(E=ORIGIN, H=(0.6, 0.0)),
            "rod": heavy(H=ORIGIN, J=(length, 0.0)),
            "output": heavy(K=ORIGIN, J=(1.0, 0.0)),
        },
        gears=(eq.Gear("rocker", "lever", ratio=-1.7, start=1.2),),
        assembly={"C": "left", "J": "left"},
    )


def test_a_dyad_behind_gears_is_watched_too() -> None:
    given = geared_dyad(1.4)
    number, angle = eq.mechanism.assemble(given).weakest["J"]
    points = eq.move(given, 7200).points
    h, j, k = (points[name].place for name in "HJK")
    sine = np.sin(np.angle((h - j) / (k - j))) ** 2
    assert number == pytest.approx(sine.min(), rel=1e-4)
    first = int(np.argmax(sine <= sine.min() + 1e-9))  # the dyad comes as near in every turn
    assert angle == pytest.approx(2 * pi * first / 7200, abs=2e-3)


def test_a_dyad_behind_gears_may_be_the_one_that_stops() -> None:
    with refused(RangeError, names="'rod' and 'output'", first="'rod'", last="'output'") as caught:
        eq.move(geared_dyad(0.2))
    for begin, end in caught.value.ranges:
        middle = eq.move(geared_dyad(1.4), [begin, end]).points["H"].place
        reach = abs(middle - (3.5 + 0.2j))
        np.testing.assert_allclose(reach, 1.2, atol=1e-7)


# -- what may be asked for -------------------------------------------------------------------------


@pytest.mark.parametrize("angles", [0, -5])
def test_counts_of_angles(angles: int) -> None:
    with refused(UsageError, count=angles):
        eq.move(crank_rocker(), angles)


def test_too_many_angles() -> None:
    with refused(UsageError, most_angles="400000"):
        eq.move(crank_rocker(), 400_001)


@pytest.mark.parametrize("angles", [[], [[0.0, 1.0]], [0.0, float("nan")], None])
def test_angles_in_a_row(angles: object) -> None:
    with refused(UsageError, by="_given_angles"):
        eq.move(crank_rocker(), angles)  # type: ignore[arg-type]


@pytest.mark.parametrize("angles", ["many", ["a", "b"], [0.0, [1.0]]])
def test_angles_that_are_no_numbers(angles: object) -> None:
    with refused(UsageError, angles=angles):
        eq.move(crank_rocker(), angles)  # type: ignore[arg-type]


@pytest.mark.parametrize("rate", [float("nan"), float("inf"), 1e200])
@pytest.mark.parametrize("key", ["speed", "acceleration"])
def test_speeds_must_be_those_of_machines(key: str, rate: float) -> None:
    with np.errstate(all="ignore"), pytest.raises(UsageError):
        eq.analyze(crank_rocker(), 4, **{key: rate})


def test_speeds_of_a_range_have_the_sign_of_the_speed() -> None:
    """Negative ones were refused without a word of that, where the crank turns clockwise."""
    with refused(ModelError, "drive.speeds[1]", text="-20 rad/s"):
        crank_rocker().with_drive(speed=-30.0, speeds=(-20.0, -40.0))
    assert crank_rocker().with_drive(speed=-30.0, speeds=(20.0, 40.0)).drive.range == (-20, -40)


def test_one_angle_and_one_number() -> None:
    assert eq.move(crank_rocker(), 1).crank_angle.tolist() == [0.0]
    assert eq.move(crank_rocker(), np.int64(3)).crank_angle.size == 3
    assert eq.move(crank_rocker(), 1.5).crank_angle.tolist() == [1.5]  # type: ignore[arg-type]
    assert not eq.move(crank_rocker(), 1.5).whole_cycle  # type: ignore[arg-type]


def test_frame_is_no_link() -> None:
    motion = eq.move(crank_rocker(), 4)
    assert FRAME not in motion.links
    assert set(motion.points) == {"A", "B", "C", "D"}


# -- angles of links that only swing ---------------------------------------------------------------


def test_a_guided_link_of_a_linkage_that_only_swings() -> None:
    given = slider_crank().with_link("rod", points={"B": ORIGIN, "C": (0.28, 0.0)})
    motion = eq.move(given, [0.1, 0.2])
    assert motion.links["piston"].angle.tolist() == [0.0, 0.0]
    assert motion.links["rod"].angle.shape == (2,)


def test_angles_do_not_depend_on_which_others_are_asked_for() -> None:
    given = four_bar(0.05218, 0.06048, 0.09396, 0.07247)
    with pytest.raises(RangeError) as caught:
        eq.move(given)
    low, high = caught.value.ranges[0]
    ends = np.array([low, high]) + np.array([1e-3, -1e-3])
    many = eq.move(given, np.linspace(*ends, 400))
    for name, link in eq.move(given, ends).links.items():
        np.testing.assert_allclose(link.angle, many.links[name].angle[[0, -1]], atol=1e-9)


def test_a_change_point_asked_for_is_reported_in_radians() -> None:
    given = four_bar(1.0, 0.3, 1.0, 0.3)
    with pytest.raises(ChangePointError) as whole:
        eq.move(given)
    with refused(ChangePointError, other="rocker", link="coupler") as caught:
        eq.move(given, [whole.value.crank_angle])
    assert caught.value.crank_angle == whole.value.crank_angle


def test_guides_that_become_parallel_jam_and_are_no_bifurcation() -> None:
    """A block in a slot of the crank and a guide of the frame: where both point the same way."""
    given = machine(
        {"A": ORIGIN, "H": (0.0, 0.5)},
        {"crank": heavy(A=ORIGIN, B=(0.3, 0.0)), "shoe": heavy(J=ORIGIN), "block": heavy(J=ORIGIN)},
        sliders=(
            eq.Slider("shoe", "J", "crank", "A", 0.0),
            eq.Slider("block", "J", FRAME, "H", 0.25),
        ),
    )
    with refused(ChangePointError, angle="14.32 deg"):
        eq.move(given)


def test_a_narrow_gap_ends_the_range_on_both_sides() -> None:
    """It lies between the crank angles at which the linkage is followed."""
    a, b, c = 1.0, 0.3, 0.7
    d = a + b - c - 1e-6
    with pytest.raises(RangeError) as caught:
        eq.move(leaning(four_bar(a, b, c, d), float(np.radians(0.25))))
    words = str(caught.value)
    low, high = (float(part) for part in re.findall(r"at (-?[0-9.]+) deg", words))
    assert 359 < high - low < 360
    assert "other such ranges" not in words


def test_where_a_crank_stops_is_computed_for_who_reads_the_sentence(monkeypatch):
    """Studies count thousands of such errors, and read none."""
    calls = []

    def counted(*given):
        calls.append(given)
        return range_of(*given)

    range_of = reach.range_of
    monkeypatch.setattr(reach, "range_of", counted)
    with pytest.raises(RangeError) as caught:
        eq.move(four_bar(1.0, 0.8, 0.5, 0.6))
    error = caught.value
    assert error.ranges
    assert not calls
    sentence = str(error)
    again = pickle.loads(pickle.dumps(error))
    assert "motion = { between = [" in sentence
    assert sentence == str(error) == str(again)
    assert error.message("en") == again.note
    assert (again.ranges, str(again.reason)) == (error.ranges, str(error.reason))
    assert len(calls) == 1
