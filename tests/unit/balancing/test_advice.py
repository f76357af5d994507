"""What a designer would do where nobody said what may be changed: aims, room, shapes, prices."""

from __future__ import annotations

import re
from dataclasses import replace
from math import pi

import numpy as np
import pytest

import equipoise as eq
from equipoise.balancing.advice import advise, running_speeds
from equipoise.balancing.balanced import Balanced
from equipoise.balancing.blocks import outcome_blocks
from equipoise.balancing.first_order import end_weights_for
from equipoise.balancing.headlines import Saving, assessed, watched_of, worse_headlines
from equipoise.balancing.outcome import (
    benefit_sentences,
    beside_the_aim,
    deterioration_sentences,
    large_after,
    objectives_text,
    proof_sentences,
    sentences_beyond_masses,
    why_not,
    why_nothing,
)
from equipoise.balancing.policy import (
    HEADLINE_GROWTH,
    LEAST_CLEARANCE,
    LEAST_GAIN,
    LEAST_GAIN_OF_ADDED,
    SMALL_FIGURE,
)
from equipoise.balancing.remedies import Sector as SectorShape
from equipoise.balancing.remedies import (
    coarse_sectors,
    is_worth,
    plate_of,
    sectors,
    with_sectors,
)
from equipoise.balancing.room import pivots_of, room_about, rooms_about
from equipoise.balancing.spaced_arms import spaced_arms_for
from equipoise.balancing.workshop import in_short, sentences
from equipoise.errors import EquipoiseError, MassError, RangeError
from equipoise.mechanism.parts.balance import AddedMass, Balance, Limit, Objective, Phases, Weight
from equipoise.mechanism.parts.bodies import Body
from equipoise.mechanism.parts.joint_properties import JointProperties
from equipoise.mechanism.parts.links import Bearing
from equipoise.mechanism.parts.machine import Drive, Link, Slider
from equipoise.results.blocks import Text as TextBlock
from equipoise.results.yardsticks import assess
from equipoise.signals import Array
from equipoise.vibration.linear import Linear
from support.findings import ADVISED, advice_for
from support.refusals import refused

RIG, RIDING = eq.load("yamashita-rig"), eq.load("riding-transplanter")
RPM = pi / 30


def bare(name: str) -> eq.Machine:
    """A bundled machine as if its file said nothing of balancing."""
    return eq.load(name).with_balance(None)


def swing(machine: eq.Machine, gauge: str, speed: float | None = None) -> float:
    """RMS about the mean of what a gauge reads, from its samples."""
    read = eq.respond(machine, speed).gauges[gauge].displacement.samples(1440)
    return float(np.std(read))


def inline_three() -> eq.Machine:
    """Three cylinders 80 mm apart whose cranks stand 120 degrees apart: no force, but a couple."""
    crank = {"A": (0.0, 0.0)}
    planes = {}
    links: dict[str, Link] = {}
    sliders = []
    for number, z in enumerate((-0.08, 0.0, 0.08), 1):
        turn = 2 * pi / 3 * (number - 1)
        crank[f"B{number}"] = (0.03 * np.cos(turn), 0.03 * np.sin(turn))
        planes[f"B{number}"] = z
        rod = {f"B{number}": (0.0, 0.0), f"C{number}": (0.11, 0.0)}
        links[f"rod-{number}"] = Link(rod, 0.3, (0.03, 0.0), 5e-4, plane=z)
        piston = {f"C{number}": (0.0, 0.0)}
        links[f"piston-{number}"] = Link(piston, 0.35, (0.0, 0.0), 1e-4, plane=z)
        sliders.append(Slider(f"piston-{number}", f"C{number}", "frame", "A", pi / 2))
    links["crank"] = Link(crank, 3.0, (0.0, 0.0), 2e-3, planes=planes)
    bearings = {"front": Bearing("crank", -0.16), "rear": Bearing("crank", 0.16)}
    sides = {f"C{number}": "forward" for number in (1, 2, 3)}
    return eq.Machine("Inline three", Drive("crank", 300.0), {"A": (0.0, 0.0)}, links, sides,
                      tuple(sliders), bearings=bearings)  # fmt: skip


# -- aims ------------------------------------------------------------------------------------------


def test_the_file_s_own_plan_is_carried_out() -> None:
    machine = eq.load("balance-crank")
    actual, asked = advise(machine), eq.balance(machine)
    assert actual.plan is machine.balance and actual.advice is None
    assert actual.objectives == asked.objectives
    assert not {"large", "offered", "flywheels"} & actual.to_dict().keys()


def test_a_couple_is_aimed_at_where_that_is_what_is_large() -> None:
    """Not the shaking force, which is next to nothing; by a couple of counterweights."""
    machine = inline_three()
    advice = advise(machine)
    assert advice.advice is not None and advice.advice.before[0].output == "rocking_moment"
    assert [objective.output for objective in advice.plan.objectives] == ["rocking_moment"]
    assert advice.helps
    first, other = advice.changes
    assert first.values["plane"] == -other.values["plane"] == -0.12
    assert first.values["mass"] == other.values["mass"]
    assert abs(abs(first.values["direction"] - other.values["direction"]) - pi) < 1e-9
    before, after = (eq.analyze(each).forces.across.rocking_moment.value
                     for each in (machine, advice.machine))  # fmt: skip
    gain = 1 - np.sqrt(np.mean(np.abs(after) ** 2) / np.mean(np.abs(before) ** 2))
    assert advice.gain == pytest.approx(gain, rel=1e-6) and gain > 0.3


@pytest.mark.exhaustive(but=["straw-walker", "hydraulic-loader"])
@pytest.mark.parametrize("name", ["hydraulic-loader", "quick-return", "straw-walker"])
def test_where_nothing_large_shakes_the_masses_are_left_as_they_are(name: str) -> None:
    """However large a counterweight would be: a half disc of 360 kg against 2 % of the load."""
    advice = advice_for(name)
    assert not advice.helps and not any(item.helps for item in advice.tried)
    text = " ".join(benefit_sentences(advice))
    assert re.search("Leave the (masses|machine) as (they are|it is)|No counterweight", text)


def test_all_that_is_large_is_named_first() -> None:
    first, *_ = benefit_sentences(advice_for("hydraulic-loader"))
    assert first == (
        "Large here: Force of the cylinder A to B, peak: 25.6 kN at 17.0° of the cycle, 6.4 times "
        "the largest load."
    )


# Aims of gauges: `test_where_a_hand_holds_the_machine_its_gauge_alone_is_an_aim`.
@pytest.mark.exhaustive
def test_rows_are_turned_so_that_the_gauges_read_least() -> None:
    """Not the shaking force, whose best phases make yaw 89 % worse."""
    advice = advise(RIDING)
    assert [change.kind for change in advice.changes] == ["phases"]
    assert np.degrees(advice.changes[0].values["phases"]) == pytest.approx([0, 180, 180, 0])
    by_force = eq.balance(
        RIDING, Balance(phases=Phases(), objectives=(Objective("shaking_force"),))
    )
    assert any(
        "reading at yaw, peak to peak" in line and "(+89 %)" in line
        for line in deterioration_sentences(by_force)
    )
    assert not advice.worse


def with_hand(hours: float) -> eq.Machine:
    """The walking transplanter, one of whose three gauges is where a hand holds it."""
    machine = bare("walking-transplanter")
    assert machine.support is not None
    gauges = machine.support.gauges
    held = replace(gauges["handle_along"], exposure=3600 * hours)
    return machine.with_support(gauges={**gauges, "handle_along": held})


def test_where_a_hand_holds_the_machine_its_gauge_alone_is_an_aim() -> None:
    """The others, which nothing judges then, may not grow either."""
    machine = with_hand(8.0)
    remedy = advise(machine)
    assert [aim.name for aim in remedy.plan.objectives] == ["ripple of gauges.handle_along"]
    assert machine.support is not None
    watched = {item.output for limit in watched_of(assessed(machine)) for item in limit.objectives
               if item.output.startswith("gauges.")}  # fmt: skip
    assert watched == {f"gauges.{name}" for name in machine.support.gauges}
    for name in machine.support.gauges:
        assert swing(remedy.machine, name) <= HEADLINE_GROWTH * swing(machine, name)


@pytest.mark.parametrize(("faster", "beyond"), [(1.0, False), (2.2, True)])
def test_what_a_hand_bears_after_a_change_stands_first(faster: float, beyond: bool) -> None:
    """What has come below the limit value, and what is left beyond it, whatever else is large."""
    machine = with_hand(23.0)
    advice = advise(machine.with_drive(speed=faster * machine.drive.speed))
    assert advice.advice is not None
    (was,) = (item for item in advice.advice.before if item.is_exposure)
    (new,) = (item for item in advice.advice.after if item.is_exposure)
    assert was.is_broken and new.is_broken == beyond
    lines = [line for line in beside_the_aim(advice) if f"{new.value:.2f} m/s" in line]
    assert len(lines) == 1
    assert beyond == (large_after(advice.advice)[:1] == [new])


@pytest.mark.parametrize("limit", [1e-6, 10.0])
def test_a_gauge_with_a_limit_and_a_hand_stands_for_the_larger(limit: float) -> None:
    aim = Objective("gauges.handle_along", "ripple")
    plan = Balance(limits=(Limit(aim, at_most=limit),))
    before = assessed(with_hand(8.0).with_balance(plan))
    own = [item.excess for item in before.headline if item.output == aim.output]
    ((_, entry),) = before.aims([aim])
    assert len(own) == 2 and entry.excess == max(own)


# Several speeds: tests/unit/balancing/test_effects.py.
@pytest.mark.exhaustive
def test_all_speeds_at_which_a_machine_runs_are_aims() -> None:
    """Those of a range, and its resonance at 118.7 rpm."""
    machine = RIG.with_drive(speeds=(100 * RPM, 240 * RPM))
    speeds = np.array(running_speeds(machine, Linear.of(machine))) / RPM
    assert speeds[[0, 2, 3, 4]] == pytest.approx([100, 170, 193, 240])
    advice = advise(machine)
    assert [item.speeds[0] / RPM for item in advice.plan.objectives] == pytest.approx(speeds)
    for objective in advice.plan.objectives:
        pair = (
            swing(machine, "gauge", objective.speeds[0]),
            swing(advice.machine, "gauge", objective.speeds[0]),
        )
        assert advice.objectives[objective.name] == pytest.approx(pair, rel=1e-6)
    assert objectives_text(advice).endswith("170, 193, 240 rpm")


def test_what_the_file_wants_and_limits_is_kept() -> None:
    free = (AddedMass("crank", "A", Weight("any", 0.07, at_most=0.5)),)
    advice = advise(RIG.with_balance(Balance(masses=free)))
    assert advice.plan.masses == free and advice.advice is None
    assert [objective.name for objective in advice.plan.objectives] == ["ripple of gauges.gauge"]
    wish = (Objective("shaking_force"),)
    limits = (Limit(Objective("shaking_force", "peak"), ratio=0.75),)
    machine = eq.load("balance-shafts")
    advice = advise(machine.with_balance(Balance(objectives=wish, limits=limits)))
    assert advice.plan.objectives == wish and advice.advice is not None
    peaks = [eq.analyze(each).summary["shaking_force"].peak for each in (machine, advice.machine)]
    assert not advice.helps or peaks[1] <= 0.75 * peaks[0] * (1 + 1e-6)
    light = advise(machine.with_balance(Balance(objectives=wish, added_mass=0.1)))
    assert light.added_mass <= 0.1


# -- room ------------------------------------------------------------------------------------------


def test_room_is_not_reported_by_the_throw_of_a_crank() -> None:
    """A sieve whose crank throws 4 mm has plates as thick as one that throws 18 mm."""
    sieve = bare("sieve")
    links = dict(sieve.links)
    links["crank"] = Link(("O", "A"), 2.0, (0.0, 0.0), 1e-3, length=0.004)
    short = replace(sieve, links=links)
    room = room_about(short, "crank")
    assert room.largest > 0.1 and room.most_thick == pytest.approx(0.03)


def test_a_pin_that_comes_near_takes_room_away() -> None:
    """The crank of a four-bar, about which its coupler's far pin goes."""
    machine = bare("yamashita-1")
    room = room_about(machine, "crank")
    motion = eq.move(machine, 720)
    seen = (motion.points["C"].place - motion.points["A"].place) * np.exp(
        -1j * motion.links["crank"].angle
    )
    for away, ahead in zip(np.abs(seen), np.degrees(np.angle(seen)), strict=True):
        assert room.reach[round(ahead) % 360] < away
    shaft = abs(complex(*machine.frame["D"]) - complex(*machine.frame["A"]))
    assert room.largest < shaft
    assert [*pivots_of(machine)] == ["crank", "rocker"]


PAPER = {"yamashita-1": 1.145 * 35.7e-3, "balance-rig": 1.145 * 35.7e-3, "balance-crank": 0.0409}
"""First moment of the counterweight that Yamashita, Ichikawa and Mori put on the crank, kg m."""


@pytest.mark.parametrize("name", PAPER)
def test_the_paper_s_own_counterweight_fits(name: str) -> None:
    """111 deg from the line of the pivots, in a plane beside the pin C that would cross it."""
    machine = bare(name)
    *_, room = rooms_about(machine, "crank")
    assert [*room.neighbors] == ["C"] and room.neighbors["C"] == pytest.approx(38e-3, abs=1e-4)
    outer, inner = 0.07, 0.02
    # Over their crank angle, from the line A to D at -83 deg; from the axes of the crank, 0 deg.
    way = 111.0
    assert room.is_free(inner, outer, np.array([way]), np.array([180.0]))[0]
    most = sectors([SectorShape(outer, inner, plate_of(room.most_thick), 111, 180)])
    assert abs(most.moment[0]) > PAPER[name]
    first, *_ = rooms_about(machine, "crank")
    assert not first.is_free(inner, outer, np.array([way]), np.array([180.0]))[0]


def test_a_plane_of_its_own_is_crossed_by_shafts_and_guided_pins() -> None:
    """A piston comes near its crank in every plane; the shaft of a rocker is in the frame."""
    engine, rig = bare("slider-crank-engine"), bare("yamashita-1")
    assert all(not room.neighbors for room in rooms_about(engine, "crank"))
    *_, room = rooms_about(rig, "crank")
    shaft = abs(complex(*rig.frame["D"]) - complex(*rig.frame["A"]))
    assert 0.85 * shaft < room.largest < shaft - room.clearance * (1 - 1e-9)
    text = " ".join(benefit_sentences(advise(rig)))
    assert "in a plane of its own beside pin C" in text


def test_a_plane_of_its_own_is_said_where_only_a_link_comes_near() -> None:
    """A pin says enough, as it ends the link too; what comes near neither needs no such plane."""
    machine = bare("yamashita-1")
    *_, room = rooms_about(machine, "crank")
    room = replace(room, neighbors={"C": 0.07}, beside_links={"rocker": 0.04})
    for outer, said in ((0.07, " beside pin C"), (0.04, " beside rocker"), (0.03, "")):
        _, (change,) = with_sectors(machine, (room,), (SectorShape(outer, 0.01, 0.01, 0, 90),))
        (text,) = in_short(change)
        assert text.endswith(f", in a plane of its own{said}" if said else "its middle at 0°")


# Room: `test_room_is_not_reported_by_the_throw_of_a_crank`.
@pytest.mark.exhaustive
def test_the_room_of_a_short_crank_is_larger_than_its_throw() -> None:
    """As of a disc with a pin; nobody has said how far it may reach."""
    room = room_about(bare("scotch-yoke"), "crank")
    assert room.largest == room.assumed == pytest.approx(2.5 * 0.03)
    assert room.is_limited_by_assumption and advice_for("scotch-yoke").helps


# Longer arms: `test_a_longer_arm_is_taken_rather_than_more_mass`.
@pytest.mark.exhaustive
def test_what_more_room_would_allow_is_said() -> None:
    """Where it is worth it: a carrier's weight twice as far out is lighter and does more."""
    advice = advice_for("planetary-planting-arm")
    more = advice.with_room
    assert more is not None and more.wanted == pytest.approx(2 * more.assumed)
    (piece,) = more.remedy.changes[0].values["pieces"]
    assert more.assumed < piece["outer_radius"] <= more.wanted
    assert more.remedy.helps and more.remedy.gain > advice.gain + LEAST_GAIN
    assert advice.to_dict()["with_room"]["gain"] == more.remedy.gain
    text = " ".join(benefit_sentences(advice))
    assert f"The space about {more.at} is assumed, from the lengths of the links" in text
    assert advice_for("balance-shafts").with_room is None


def test_more_room_is_named_where_the_assumed_space_is_too_small() -> None:
    """As of a heavy jaw on a short eccentric; beside it nobody is told to leave the masses."""
    crusher = replace(eq.load(ADVISED / "jaw-crusher.toml"), support=None)
    balanced = advise(
        crusher.with_balance(Balance(objectives=(Objective("shaking_force", "peak"),)))
    )
    assert not balanced.helps and balanced.with_room is not None
    assert balanced.with_room.remedy.gain > 3 * balanced.gain
    tried, room = why_nothing(balanced)
    assert "Leave" not in tried
    assert room.startswith(f"The space about {balanced.with_room.at} is assumed")
    assert room not in sentences_beyond_masses(balanced)


def test_a_weight_on_an_eccentric_begins_outside_of_it() -> None:
    """A pin of a large radius about a small throw fills the hub, in all directions."""
    crusher = eq.load(ADVISED / "jaw-crusher.toml")
    pins = tuple(JointProperties(f"joints.{pin}", radius=0.11) for pin in "AB")
    room = room_about(replace(crusher, joints=pins, support=None), "shaft")
    assert room.hub == pytest.approx(0.012 + 0.11 + LEAST_CLEARANCE)
    inner = {shape.inner for shape in coarse_sectors([room])}
    assert inner and min(inner) >= room.hub


@pytest.mark.parametrize(("name", "mass", "gain"), [("kim-chung-b", 0.298, 0.209)])
def test_a_longer_arm_is_taken_rather_than_more_mass(name: str, mass: float, gain: float) -> None:
    """298 g within 40 mm took 20.9 % off; as much mass does twice that as far out as 50 mm over the
    soil allow.
    """
    advice = advice_for(name)
    assert advice.helps and advice.added_mass / advice.gain < 0.55 * mass / gain


def test_gears_and_belts_take_room_away() -> None:
    """A weight beside a pulley stays inside of it, where the belt runs."""
    assert room_about(bare("knife-drive"), "shaft").largest == pytest.approx(34 * 0.014 / 2 / pi)


# -- shapes ----------------------------------------------------------------------------------------


def test_a_sector_is_what_its_outline_weighs() -> None:
    """Mass, first moment and inertia by its outline, as a polygon."""
    shape = SectorShape(0.08, 0.02, 0.012, 35, 140)
    first = sectors([shape])
    turned = np.radians(35 + 140 * np.linspace(-0.5, 0.5, 8001))
    outline = np.concatenate([0.08 * np.exp(1j * turned), 0.02 * np.exp(1j * turned[::-1])])
    following = np.roll(outline, -1)
    crossed = np.imag(np.conj(outline) * following)
    plate = 7850 * 0.012
    assert first.mass[0] == pytest.approx(plate * np.sum(crossed) / 2, rel=1e-6)
    assert first.moment[0] == pytest.approx(plate * np.sum(crossed * (outline + following)) / 6,
                                          rel=1e-6)  # fmt: skip
    squares = np.abs(outline) ** 2 + np.real(outline * np.conj(following)) + np.abs(following) ** 2
    assert first.inertia[0] == pytest.approx(plate * np.sum(crossed * squares) / 12, rel=1e-6)


@pytest.mark.parametrize(
    ("most", "thickness"),
    [(12e-3, 12e-3), (11.9e-3, 10e-3), (0.99e-6, 0.8e-6), (1e-3, 1e-3)],
)
def test_plates_that_are_to_be_had(most: float, thickness: float) -> None:
    assert plate_of(most) == pytest.approx(thickness, rel=1e-12)


def test_the_reported_machine_has_the_reported_shape() -> None:
    """Not the best one between two degrees: figures are those of the rounded shape."""
    machine, actual = bare("balance-shafts"), advice_for("balance-shafts")
    (change,) = actual.changes
    (piece,) = change.values["pieces"]
    (degrees,) = {round(np.degrees(piece["angle"]))}
    shape = SectorShape(piece["outer_radius"], piece["inner_radius"], piece["thickness"],
                        round(np.degrees(piece["direction"])), degrees)  # fmt: skip
    first = sectors([shape])
    moment = complex(first.moment[0])
    inertia = float(first.inertia[0]) - abs(moment) ** 2 / first.mass[0]
    place = moment / first.mass[0]
    link = machine.links["crank"].with_added(
        float(first.mass[0]), (place.real, place.imag), inertia
    )
    rebuilt = replace(machine, links={**machine.links, "crank": link})
    force, same = (np.abs(eq.analyze(each, 720).forces.shaking_force.value)
                   for each in (rebuilt, actual.machine))  # fmt: skip
    np.testing.assert_allclose(force, same, rtol=1e-9)
    before, after = actual.objectives["rms of shaking_force"]
    assert after == pytest.approx(np.sqrt(np.mean(force**2)), rel=1e-6)
    assert before > after


def test_the_proof_is_of_every_sector_of_that_plate() -> None:
    """It holds for the shape that is told, and names the room."""
    advice = advice_for("balance-shafts")
    assert advice.bound <= advice.cost and advice.gap < 0.1
    (text,) = proof_sentences(advice)
    assert text.startswith("Proof, by cone program: with a sector of ")
    assert "where no headline figure gets worse" in text


# -- prices ----------------------------------------------------------------------------------------


def test_what_gains_too_little_for_its_mass_is_not_offered() -> None:
    """On a crank that turns among pins of the frame, about which nothing fits."""
    advice = advice_for("drag-link")
    assert not advice.helps
    assert all(item.gain < LEAST_GAIN for item in advice.tried)
    assert "that is too little" in " ".join(benefit_sentences(advice))


# Of a single joint or direction: the test below.
@pytest.mark.exhaustive
def test_what_leaves_a_headline_figure_worse_is_not_offered() -> None:
    """A lever would take a quarter off the shaking force, and makes the torque swing more."""
    advice = advice_for("class-three")
    assert not advice.helps and advice.gain > 0.25
    assert advice.advice is not None
    ((was, new), *_) = advice.advice.worse
    swings = [float(np.ptp(eq.analyze(item).forces.drive_torque))
              for item in (advice.original, advice.machine)]  # fmt: skip
    assert was.output == "drive_torque" and new.value == pytest.approx(swings[1], rel=1e-3)
    text = " ".join(benefit_sentences(advice))
    assert swings[1] > 1.1 * swings[0]
    grown = f"drive torque, peak to peak, from {swings[0]:.2f} to {swings[1]:.2f} N m"
    assert grown in text and "would grow" in text


@pytest.mark.exhaustive(but=["four-stroke-engine-shaking force y"])
@pytest.mark.parametrize(
    ("name", "what"),
    [("knife-drive", "force in joint A"), ("four-stroke-engine", "shaking force y")],
)
def test_what_leaves_a_single_joint_or_direction_worse_is_not_offered(name: str, what: str) -> None:
    """The pin of a crank would carry an eighth more; the force along y would double."""
    advice = advice_for(name)
    assert not advice.helps
    rejected = [item for item in advice.tried if item.gain > LEAST_GAIN]
    grown = {str(was.label) for item in rejected if item.advice for was, _ in item.advice.worse}
    assert f"{what}, peak" in grown


# Limits of growth: `test_what_is_large_may_grow_by_a_tenth_of_what_is_saved`.
@pytest.mark.exhaustive
def test_a_trifle_may_grow() -> None:
    """What stays below a tenth of its yardstick is no headline figure."""
    advice = advice_for("balance-shafts")
    assert advice.advice is not None
    (first, *_) = advice.advice.before
    tiny = replace(first, value=1e-3 * first.value, ratio=1e-3 * first.ratio)
    assert not worse_headlines((tiny,), (replace(tiny, value=2 * tiny.value),), Saving())
    assert worse_headlines((first,), (replace(first, value=1.02 * first.value),), Saving())
    assert not worse_headlines((first,), (replace(first, value=1.005 * first.value),), Saving())


def test_what_is_small_and_stays_small_may_grow_by_half_of_what_is_saved() -> None:
    """Each over what is large of its kind: 0.8 of 1.6 here."""
    advice = advice_for("balance-shafts")
    assert advice.advice is not None
    (first, *_) = advice.advice.before
    saving = Saving(gain=0.5, excess=1.6)
    for before, after, is_worse in ((0.3, 0.69, False), (0.3, 0.71, True), (0.6, 0.74, False),
                                    (0.6, 0.76, True)):  # fmt: skip
        was, new = (replace(first, value=x, ratio=x) for x in (before, after))
        assert bool(worse_headlines((was,), (new,), saving)) is is_worse


def test_what_is_large_may_grow_by_a_tenth_of_what_is_saved() -> None:
    """Of a figure five times its yardstick at most a tenth of the share that the aim loses, and at
    most a tenth of what is saved.
    """
    advice = advice_for("balance-shafts")
    assert advice.advice is not None
    first = replace(advice.advice.before[0], value=5.0, ratio=5.0)
    for excess, most in ((6.0, 5.2), (1.0, 5.05)):
        saving = Saving(gain=0.4, excess=excess)
        assert not worse_headlines((first,), (replace(first, value=most - 1e-6),), saving)
        assert worse_headlines((first,), (replace(first, value=most + 1e-3),), saving)


# Limits of growth: `test_what_is_large_may_grow_by_a_tenth_of_what_is_saved`.
@pytest.mark.exhaustive
def test_what_was_nothing_may_not_become_large() -> None:
    """Other phases of rows may bring a couple where there was none."""
    advice = advice_for("balance-shafts")
    assert advice.advice is not None
    (first, *_) = advice.advice.before
    saving = Saving(gain=1.0, excess=3.0)
    ((was, new),) = worse_headlines((), (replace(first, ratio=1.1),), saving)
    assert was.value == 0 and new.value == first.value
    assert not worse_headlines((), (replace(first, ratio=0.7),), saving)
    assert worse_headlines((), (replace(first, ratio=0.7),), Saving(gain=0.2, excess=3.0))


# Couples: `test_a_couple_is_aimed_at_where_that_is_what_is_large`.
@pytest.mark.exhaustive
def test_a_couple_larger_than_what_is_saved_is_not_made() -> None:
    """Phases of 0, 180, 270 and 90 deg save 4.2 N m of shaking moment, RMS, and twist the machine
    by 9.6 N m; those that do not twist it are offered.
    """
    advice = advice_for("four-row-transplanter")
    first, second = advice.tried
    assert np.degrees(first.changes[0].values["phases"]) == pytest.approx([0, 180, 270, 90])
    assert first.advice is not None and not first.helps
    roll, yaw = (eq.analyze(first.machine).summary[f"rows.{name}"].rms
                 for name in ("roll_moment", "yaw_moment"))  # fmt: skip
    ((before, after),) = first.objectives.values()
    assert roll > yaw > before - after > 4
    assert {was.output for was, _ in first.advice.worse} == {"rows.roll_moment", "rows.yaw_moment"}
    assert advice.helps and advice.changes == second.changes
    assert np.degrees(advice.changes[0].values["phases"]) == pytest.approx([0, 180, 180, 0])
    level = eq.analyze(advice.machine).summary
    assert level["rows.roll_moment"].rms < 1e-9 > level["rows.yaw_moment"].rms
    assert "without couples between the rows" in " ".join(proof_sentences(advice))


# Gains: `test_what_gains_too_little_for_its_mass_is_not_offered`.
@pytest.mark.exhaustive
def test_a_weight_that_takes_off_less_than_a_quarter_is_not_offered() -> None:
    """A seventh of the links' mass, for 22 % of an RMS and 15 % of the peak that is large."""
    advice = advice_for("watt-six-bar")
    assert not advice.helps
    aims = (Objective("shaking_force"),)
    about_crank = [item for item in advice.tried if item.plan.objectives == aims
                   and item.changes[0].link == "crank" and not item.advice.worse]  # fmt: skip
    assert about_crank
    for entry in about_crank:
        assert entry.added_mass > 0 and LEAST_GAIN < entry.gain < LEAST_GAIN_OF_ADDED
        before, after = (eq.analyze(of).summary["shaking_force"].peak
                         for of in (entry.original, entry.machine))  # fmt: skip
        assert 1 - after / before < LEAST_GAIN_OF_ADDED
        assert why_not(entry) == "that is too little"


# `test_beside_a_torque_nothing_that_shakes_may_grow`.
@pytest.mark.exhaustive
def test_what_evens_a_torque_may_not_shake_the_machine_more() -> None:
    """A weight of 29 % of the links of a flap folder would even its torque, and raise its shaking
    force from 5.0 to 6.3 N: small beside its weight, but a spring or a flywheel costs none of it.
    """
    advice = advice_for("flap-folder")
    assert not advice.helps
    rejected = [item for item in advice.tried if item.gain > LEAST_GAIN and item.advice is not None]
    assert rejected
    for entry in rejected:
        assert entry.advice is not None
        assert any(was.is_shaking for was, _ in entry.advice.worse)


def test_beside_a_torque_nothing_that_shakes_may_grow() -> None:
    advice = advice_for("balance-shafts")
    assert advice.advice is not None
    first = replace(advice.advice.before[0], value=0.4, ratio=0.4)
    grown, saving = (replace(first, value=0.5),), Saving(gain=0.5, excess=1.6)
    assert first.is_shaking and not worse_headlines((first,), grown, saving)
    assert worse_headlines((first,), grown, replace(saving, steadies=True))


def test_the_figure_that_is_large_falls_in_its_own_measure() -> None:
    """A sector of a quarter of the links would take 27 % off the RMS of the force of a planting
    arm, and 18 % off its peak.
    """
    assert is_worth(0.41, 0.30, 0.29) and not is_worth(0.41, 0.30, 0.19)
    assert is_worth(0.2, 0.0, 0.16) and not is_worth(0.2, 0.0, 0.14)
    assert is_worth(0.26, 0.1, 0.26) and not is_worth(0.26, 0.1, 0.24)
    assert not is_worth(0.27, 0.24)  # about as much as it costs
    advice = advice_for("cam-pusher")
    assert not advice.helps
    assert is_worth(np.array([0.41, 0.27]), np.array([0.30, 0.24])).tolist() == [True, False]


# Measures: `test_the_figure_that_is_large_falls_in_its_own_measure`.
@pytest.mark.exhaustive
def test_the_peak_of_what_is_offered_falls_with_its_rms() -> None:
    for name in ("yamashita-1", "scotch-yoke", "kim-chung-a"):
        advice = advice_for(name)
        assert advice.helps and advice.advice is not None
        old, new = (eq.analyze(item).summary for item in (advice.original, advice.machine))
        share = advice.added_mass / advice.original.mass
        (aim,) = advice.plan.objectives
        gone = 1 - new[aim.output].peak / old[aim.output].peak
        assert gone >= max(0.25, 2 / 3 * share)


def test_little_is_added_against_what_is_not_large() -> None:
    """The reel of a baler shakes with 64 % of the weight of its links: 1.4 kg are too much."""
    advice = advice_for("baler-pickup")
    little = [
        item for item in advice.tried if item.plan.objectives == (Objective("shaking_force"),)
    ]
    assert little and all(0 < item.added_mass <= 0.05 * item.original.mass for item in little)


# What is large: `test_all_that_is_large_is_named_first`.
@pytest.mark.exhaustive
def test_what_stays_large_is_said_first_and_by_the_yardstick_before() -> None:
    """Added mass makes the yardstick longer, and no moment smaller."""
    advice = advice_for("yamashita-1")
    text = " ".join(
        item.text for item in advice.headline(alone=True) if isinstance(item, TextBlock)
    )
    assert "Large after that, as before: shaking moment, peak: 2.22 N m" in text


# Sentences of what falls: tests/unit/present/test_summary.py.
@pytest.mark.exhaustive
def test_what_falls_besides_is_said() -> None:
    """A weight against the torque of a six-bar takes a third off its shaking force."""
    advice = advice_for("stephenson-six-bar")
    old, new = (eq.analyze(item).summary for item in (advice.original, advice.machine))
    before, after = (item["shaking_force"].peak for item in (old, new))
    assert after < 0.9 * before
    text = " ".join(benefit_sentences(advice))
    assert f"This also reduces shaking force, peak, from {before:.1f} to {after:.1f} N" in text


# -- mass taken off --------------------------------------------------------------------------------


def test_a_counterweight_that_is_too_heavy_is_taken_off() -> None:
    machine = bare("four-stroke-engine").with_link("crank", center_of_mass=(-6e-3, 0.0))
    advice = advise(machine)
    (change,) = advice.changes
    assert change.kind == "removed mass" and advice.added_mass < 0 and advice.helps
    taken, place = change.values["mass"], complex(*change.values["place"])
    old, new = machine.links["crank"], advice.machine.links["crank"]
    assert new.mass == pytest.approx(old.mass - taken)
    moments = [link.mass * complex(*link.center_of_mass) for link in (old, new)]
    assert moments[0] - moments[1] == pytest.approx(taken * place)
    about = [link.inertia + link.mass * abs(complex(*link.center_of_mass)) ** 2
             for link in (old, new)]  # fmt: skip
    assert about[0] - about[1] == pytest.approx(taken * abs(place) ** 2)
    (text,) = sentences(change)
    assert text.startswith("crank: take 280.0 g off, 34.00 mm from A at 180°")


def with_heavy_side() -> eq.Machine:
    """A slider-crank whose crank is a plate with far too much of it opposite the pin."""
    machine = bare("balance-shafts")
    corners = ((-0.09, -0.04), (0.03, -0.04), (0.03, 0.04), (-0.09, 0.04))
    plate = Body("plate", corners=corners, thickness=0.02, density=7850.0)
    crank = Link(machine.links["crank"].points, bodies=(plate,))
    return replace(machine, links={**machine.links, "crank": crank})


def test_holes_take_off_what_is_too_heavy() -> None:
    machine = with_heavy_side()
    advice = advise(machine)
    (change,) = advice.changes
    assert change.kind == "removed mass" and advice.helps
    (hole,) = advice.machine.links["crank"].bodies[0].holes
    radius = change.values["hole_radius"]
    assert hole.radius == radius
    assert change.values["mass"] == pytest.approx(7850 * 0.02 * pi * radius**2)
    assert advice.added_mass == pytest.approx(-change.values["mass"])
    x, y = hole.at
    assert x < 0 and abs(y) + radius < 0.04 and x - radius > -0.09
    assert "drill a hole of" in " ".join(benefit_sentences(advice))


# -- the rest --------------------------------------------------------------------------------------


def figures_of_advice(result: Balanced) -> dict[str, object]:
    return {key: result.to_dict()[key] for key in ("offered", "large", "tried", "flywheels")}


# `test_every_answer_is_in_the_machine_readable_output` of test_beyond_masses.py.
@pytest.mark.exhaustive
def test_advice_is_machine_readable() -> None:
    values = figures_of_advice(advice_for("class-three"))
    assert values["offered"] is False
    large = values["large"]
    assert isinstance(large, list) and large[0]["figure"] == "shaking_force.peak"
    assert large[0]["ratio"] == pytest.approx(large[0]["value"] / large[0]["yardstick"])
    assert isinstance(values["tried"], list) and not any(
        value["worth"] for value in values["tried"]
    )


def test_where_nothing_is_offered_no_change_is_listed() -> None:
    text = " ".join(str(block) for block in outcome_blocks(advice_for("drag-link")))
    assert "Leave the masses as they are" in text and "add a counterweight" not in text


def test_a_machine_without_masses_has_nothing_to_balance() -> None:
    with refused(MassError, links="crank"):
        advise(bare("yamashita-1").with_link("crank", mass=None, center_of_mass=None, inertia=None))


def test_mounts_without_a_steady_state_leave_what_shakes() -> None:
    loose = RIG.with_support(mounts={})
    with pytest.raises(EquipoiseError):
        eq.respond(loose)
    assert not any(
        objective.output.startswith("gauges") for objective in advise(loose).plan.objectives
    )


# -- machines of other trades ----------------------------------------------------------------------


def advised(name: str) -> eq.Machine:
    return eq.load(ADVISED / f"{name}.toml")


# Aims of a torque: `test_beside_a_torque_nothing_that_shakes_may_grow`.
@pytest.mark.exhaustive
def test_a_torque_that_weights_can_steady_is_an_aim() -> None:
    advice = advice_for("walking-beam")
    assert advice.helps and advice.plan.objectives == (Objective("drive_torque", "ripple"),)
    swings = [
        float(np.std(eq.analyze(item).forces.drive_torque))
        for item in (advice.original, advice.machine)
    ]
    assert swings[1] < 0.5 * swings[0]


def test_no_counterweight_of_plate_is_larger_than_a_person_can_cut() -> None:
    assert room_about(advised("pump-jack"), "beam").largest <= 0.6


def test_a_joint_that_bears_its_load_is_not_large() -> None:
    """The pin of a press, 99 % of the load, and a sieve's, 1.1 times the force of inertia."""
    for machine in (advised("press"), advised("sieve-short"), bare("sieve")):
        analysis = eq.analyze(machine)
        assert not any(
            item.is_large for item in assess(analysis) if item.output.startswith("joints")
        )


def test_an_inertia_that_follows_from_bodies_has_no_wrong_unit() -> None:
    """Nor a pulley on a shaft of a short throw."""
    for name in ("sieve-short", "sieve-eccentric"):
        assert not any("gyration" in str(note) for note in eq.analyze(advised(name)).notes)


def test_a_crank_that_jams_on_its_way_is_refused_by_all() -> None:
    """A walking beam whose second lever is too short."""
    machine = advised("walking-beam").with_point("second", "F", (0.2, 0.0))
    for compute in (eq.analyze, eq.move, advise):
        with refused(RangeError, low="-103.09 deg") as caught:
            compute(machine)
        assert "motion = { between = " in str(caught.value)


def summed(values: Array, count: int) -> Array:
    """A signal of a turn, and the same an even part of a turn later, sample by sample."""
    return np.sum([np.roll(values, k * len(values) // count) for k in range(count)], axis=0)


@pytest.mark.exhaustive(but=["planetary-planting-arm-2"])
@pytest.mark.parametrize(("name", "count"), [("planetary-planting-arm", 2), ("baler-pickup", 4)])
def test_evenly_spaced_arms_leave_what_their_sum_leaves(name: str, count: int) -> None:
    """The fewest that take nine tenths; the swing of the torque over its mean, likewise."""
    machine, actual = bare(name), advice_for(name)
    assert actual.advice is not None
    arms = spaced_arms_for(eq.analyze(machine, acceleration=0.0), actual.advice.before, 0.5)
    assert arms is not None and arms.count == count
    forces = eq.analyze(machine, 720, acceleration=0.0).forces
    force, torque = forces.shaking_force.value, forces.drive_torque
    for few in range(2, count + 1):
        both = summed(force, few)
        gone = 1 - np.sqrt(np.mean(np.abs(both) ** 2) / np.mean(np.abs(force) ** 2))
        assert (gone > 0.9) == (few == count)
    assert arms.gain == pytest.approx(gone, abs=1e-3)
    if arms.swing_after is not None:
        swings = [np.ptp(item) / abs(np.mean(item)) for item in (torque, summed(torque, count))]
        assert (arms.swing_before, arms.swing_after) == pytest.approx(swings, rel=0.01)
    text = " ".join(benefit_sentences(actual))
    first = "A second arm like this one, opposite on carrier"
    assert (first if count == 2 else "4 arms like this one, evenly spaced on reel") in text


def test_arms_that_would_strike_each_other_are_not_named() -> None:
    """A tine that reaches across the shaft meets the one on the other side."""
    machine = bare("baler-pickup")
    long = machine.with_point("tine", "T", (-0.3, 0.0))
    analysis = eq.analyze(long, acceleration=0.0)
    assert spaced_arms_for(analysis, assess(analysis), 0.0) is None


# Little against what is not large: `test_little_is_added_against_what_is_not_large`.
@pytest.mark.exhaustive
def test_no_weight_against_what_is_not_large_where_more_arms_do_more() -> None:
    advice = advice_for("baler-pickup")
    assert not advice.helps and advice.advice is not None
    force = next(item for item in advice.advice.before if item.output == "shaking_force")
    assert not force.is_large


# Couples: `test_a_couple_is_aimed_at_where_that_is_what_is_large`.
@pytest.mark.exhaustive
def test_two_weights_at_the_ends_take_the_couple_that_turns_with_the_crank() -> None:
    """The best two by least squares on the samples of the couple of three rows."""
    machine = eq.load(ADVISED / "inline-3-rows.toml")
    actual, analysis = advise(machine), eq.analyze(machine, acceleration=0.0)
    assert actual.advice is not None
    ends = end_weights_for(analysis, actual.advice.before)
    assert ends is not None
    roll, yaw = (analysis.outputs[f"rows.{name}_moment"].values for name in ("roll", "yaw"))
    couple = roll + 1j * yaw
    turned = np.exp(1j * analysis.motion.crank_angle) * machine.drive.speed**2 * ends.apart
    best = np.linalg.lstsq(turned[:, None], couple)[0]
    left = np.linalg.norm(couple - turned * best[0]) / np.linalg.norm(couple)
    assert ends.gain == pytest.approx(1 - left, abs=1e-9)
    assert abs(best[0]) == pytest.approx(ends.moment)
    assert "opposite each other and 176 mm apart" in " ".join(benefit_sentences(actual))


def test_the_rule_of_what_is_offered_says_how_far_small_figures_may_grow() -> None:
    """As `allowed_ratio` has it: by half of what is saved, up to the share that the rule names."""
    (rule,) = (
        block.text
        for block in outcome_blocks(advice_for("yamashita-1"))
        if isinstance(block, TextBlock) and block.text.startswith("A change is offered if")
    )
    assert f"stay below {100 * SMALL_FIGURE:.0f} % of what counts as large for them" in rule


TWIN = """
schema = 1
title = "Two cylinders at 180 deg"
[drive]
link = "crank"
speed = "960 rpm"
[frame.points]
A = ["0 mm", "0 mm"]
[links.crank]
points = { A = ["0 mm", "0 mm"], B = ["30 mm", "0 mm"], F = ["-30 mm", "0 mm"] }
planes = { B = "60 mm", F = "-60 mm" }
mass = "5.5 kg"
center_of_mass = ["0 mm", "0 mm"]
inertia = "0.012 kg m^2"
{cylinders}
[assembly]
C = "forward"
G = "forward"
[support]
mass = "78 kg"
center_of_mass = ["0 mm", "-60 mm", "0 mm"]
inertia = ["3.1 kg m^2", "3.6 kg m^2", "2.4 kg m^2"]
freedoms = ["surge", "heave", "sway", "roll", "yaw", "pitch"]
{mounts}
"""
CYLINDER = """
[links.rod-{pin}]
points = {{ {pin} = ["0 mm", "0 mm"], {end} = ["130 mm", "0 mm"] }}
plane = "{plane} mm"
mass = "0.55 kg"
center_of_mass = ["40 mm", "0 mm"]
inertia = "0.0016 kg m^2"
[links.piston-{end}]
points = {{ {end} = ["0 mm", "0 mm"] }}
plane = "{plane} mm"
mass = "0.48 kg"
center_of_mass = ["0 mm", "0 mm"]
inertia = "0.0004 kg m^2"
[[sliders]]
link = "piston-{end}"
point = "{end}"
on = "frame"
through = "A"
direction = "90 deg"
"""
MOUNT = """
[support.mounts.{name}]
point = ["{x} mm", "-220 mm", "{z} mm"]
direction = {direction}
stiffness = "{stiffness} kN/m"
damping = "120 N s/m"
"""


def twin() -> eq.Machine:
    """Two cylinders with cranks at 180 deg on soft isolators: a couple shakes it, and no force of
    the first order.
    """
    cylinders = [CYLINDER.format(pin=pin, end=end, plane=plane)
                 for pin, end, plane in (("B", "C", 60), ("F", "G", -60))]  # fmt: skip
    mounts = [
        MOUNT.format(name=f"m{k}{axis}", x=x, z=z, direction=direction, stiffness=stiffness)
        for k, (x, z) in enumerate(((-200, -250), (200, -250), (-200, 250), (200, 250)))
        for axis, direction, stiffness in (
            ("x", [1, 0, 0], 12), ("y", [0, 1, 0], 18), ("z", [0, 0, 1], 12))
    ]  # fmt: skip
    text = TWIN.replace("{cylinders}", "".join(cylinders)).replace("{mounts}", "".join(mounts))
    return eq.loads(text)


def test_readings_that_are_rounding_do_not_forbid_a_change() -> None:
    """Surge and sway are read to 1e-21 m; half of the couple of what turns lowers roll and yaw."""
    machine = twin()
    remedy = advise(machine)
    before, after = eq.respond(machine).gauges, eq.respond(remedy.machine).gauges
    size = {name: gauge.velocity.figures.rms for name, gauge in before.items()}
    assert size["surge"] < 1e-9 * size["heave"]
    assert remedy.helps
    for name in ("roll", "yaw"):
        assert after[name].velocity.figures.rms < size[name]
    assert after["roll"].velocity.figures.rms < 0.5 * size["roll"]
