"""Cams in machines: closed forms, what is refused, and where springs let go of followers."""

from __future__ import annotations

import json
from dataclasses import replace
from math import pi, radians, sqrt
from typing import Any

import numpy as np
import pytest

import equipoise as eq
from equipoise.errors import ModelError
from equipoise.mechanism import assemble
from equipoise.mechanism.assembly.cam_shapes import fits_of
from equipoise.mechanism.dynamics.cam_contacts import let_go
from equipoise.mechanism.parts.cams import Cam
from equipoise.mechanism.parts.laws import AngleLaw, AngleSegment, LengthLaw, LengthSegment
from equipoise.mechanism.parts.machine import FRAME
from equipoise.quantities import PER_RPM
from equipoise.results.cam_blocks import lost_contacts, preloads_to_hold
from equipoise.schema.files import json_text
from support import refusals
from support.printing import words
from support.refusals import values_of
from unit.mechanism.build import ORIGIN, heavy, machine, refused

MASS, HIGH, GRAVITY = 0.5, 0.02, 9.80665
RISE = LengthLaw(
    segments=(
        LengthSegment(radians(60), HIGH, "cycloidal"),
        LengthSegment(radians(120), HIGH),
        LengthSegment(radians(60), 0.0, "cycloidal"),
        LengthSegment(radians(120), 0.0),
    )
)


def cam(rides: str = "flat", **more: Any) -> Cam:
    given: dict[str, Any] = {"closed_by": "ribs", "base_radius": 0.03, **more}
    if rides == "roller":
        given.setdefault("roller_radius", 0.008)
    if "swing" not in given:
        given.setdefault("lift", LengthLaw(between=(0.0, HIGH)))
    return Cam("crank", "tappet", rides=rides, point="R", **given)


def tappet(*cams: Cam, **more: Any) -> eq.Machine:
    """Make a balanced cam on the crank and a tappet above it."""
    return machine(
        {"A": ORIGIN, "S": (0.0, 0.2)},
        {
            "crank": eq.Link({"A": ORIGIN, "B": (0.05, 0.0)}, 1.0, ORIGIN, 1e-3),
            "tappet": eq.Link({"R": ORIGIN, "T": (0.1, 0.0)}, MASS, (0.02, 0.0), 1e-4),
        },
        sliders=(eq.Slider("tappet", "R", FRAME, "A", pi / 2),),
        cams=cams or (cam(),),
        **more,
    )


def lever(**more: Any) -> eq.Machine:
    """Make a cam on the crank and a lever beside it."""
    given: dict[str, Any] = {"swing": AngleLaw(between=(0.0, 0.3)), **more}
    return machine(
        {"A": ORIGIN, "D": (0.1, 0.0)},
        {"crank": heavy(A=ORIGIN), "tappet": heavy(D=ORIGIN, R=(0.09, 0.0))},
        cams=(cam(**{"rides": "roller", **given}),),
    )


# -- closed forms ----------------------------------------------------------------------------------


def test_a_simple_harmonic_cam() -> None:
    """A flat tappet on an eccentric circle: y = h (1 - cos) / 2, force m (g + y''), torque F y'."""
    forces = eq.analyze(tappet()).forces
    theta, speed = forces.motion.crank_angle, forces.motion.speed
    half = HIGH / 2
    np.testing.assert_allclose(
        forces.motion.points["R"].y, 0.03 + half * (1 - np.cos(theta)), atol=1e-16
    )
    push = MASS * (GRAVITY + half * np.cos(theta) * speed**2)
    (pressed,) = forces.cams.values()
    np.testing.assert_allclose(pressed.normal, push, rtol=1e-13)
    np.testing.assert_allclose(pressed.value, 1j * push, rtol=1e-13)
    np.testing.assert_allclose(forces.drive_torque, push * half * np.sin(theta), atol=1e-14)


def test_it_is_a_scotch_yoke() -> None:
    """The same motion by a block in a yoke asks for the same torque."""
    yoke = machine(
        {"A": ORIGIN},
        {
            "crank": eq.Link({"A": ORIGIN, "B": (HIGH / 2, 0.0)}, 0.0, ORIGIN, 0.0),
            "block": eq.Link({"B": ORIGIN}, 0.0, ORIGIN, 0.0),
            "tappet": eq.Link({"Y": ORIGIN}, MASS, ORIGIN, 1e-4),
        },
        sliders=(
            eq.Slider("tappet", "Y", FRAME, "A", pi / 2),
            eq.Slider("block", "B", "tappet", "Y", pi / 2),
        ),
    )
    # the tappet rises with the sine here, with minus the cosine there
    late = cam(lift=LengthLaw(between=(0.0, HIGH), phase=-pi / 2))
    torques = [eq.analyze(item).forces.drive_torque for item in (yoke, tappet(late))]
    np.testing.assert_allclose(torques[1], torques[0], atol=1e-14)


def test_from_which_speed_the_tappet_lifts_off() -> None:
    """At the top, where m h speed^2 / 2 is its weight."""
    light = tappet(cam(closed_by="spring"))
    limit = sqrt(GRAVITY / (HIGH / 2))
    (actual,) = let_go(eq.analyze(light, speed=0.9 * limit).forces)
    assert actual.ranges == ()
    assert (actual.speed, actual.at) == (pytest.approx(limit), pytest.approx(pi))
    (actual,) = let_go(eq.analyze(light, 3600, speed=-2 * limit).forces)
    ((begin, end),) = actual.ranges
    beyond = np.arccos(-1 / 4)  # where the acceleration is that of gravity
    assert (begin, end) == (pytest.approx(beyond, abs=1e-6), pytest.approx(2 * pi - beyond))
    assert actual.least == (pytest.approx(MASS * GRAVITY * -3), pytest.approx(pi))
    assert let_go(eq.analyze(tappet()).forces) == ()
    fast = replace(light, drive=replace(light.drive, speed=2 * limit))
    (text,) = lost_contacts(eq.analyze(fast).forces)
    assert str(text).endswith(f"without [[springs]] it stays there up to {limit / PER_RPM:.4g} rpm")


def test_a_tappet_that_nothing_presses_on_lifts_off_at_once() -> None:
    """Where it dwells it is just there, and its force is 0; that is no place where it is lost."""
    loose = tappet(cam("roller", lift=RISE, closed_by="spring"), gravity=(0.0, 0.0))
    (actual,) = let_go(eq.analyze(loose, acceleration=0.0).forces)
    middle = [(radians(30), radians(60)), (radians(180), radians(210))]
    assert actual.ranges == tuple(pytest.approx(pair, abs=radians(1)) for pair in middle)
    assert actual.speed == 0


def test_a_spring_presses_the_tappet_on() -> None:
    """Its force at the top adds to the weight; without gravity and it nothing holds."""
    spring = eq.Spring("tappet", "R", "S", 1000.0, 0.3)
    sprung = tappet(cam(closed_by="spring"), springs=(spring,))
    (actual,) = let_go(eq.analyze(sprung).forces)
    top = MASS * GRAVITY + 1000.0 * (0.3 - (0.2 - 0.03 - HIGH))
    assert actual.speed == pytest.approx(sqrt(top / (MASS * HIGH / 2)))
    loose_tappet = eq.analyze(tappet(cam(closed_by="spring"), gravity=(0.0, 5.0)))
    (loose,) = let_go(loose_tappet.forces)
    assert loose.speed == 0
    assert loose.ranges == ((pytest.approx(0), pytest.approx(2 * pi)),)
    (text,) = lost_contacts(loose_tappet.forces)
    assert str(text).endswith("; no [[springs]] press on it")


def test_a_preload_that_holds_the_tappet_at_its_speed() -> None:
    """At the top it asks for m h speed^2 / 2, less weight and spring; two digits, rounded up."""
    spring = eq.Spring("tappet", "R", "S", 1000.0, 0.3)
    slow = tappet(cam(closed_by="spring"), springs=(spring,))
    top = MASS * GRAVITY + 1000.0 * (0.3 - (0.2 - 0.03 - HIGH))
    speed = 1.2 * sqrt(top / (MASS * HIGH / 2))
    assert not [*preloads_to_hold(slow)]
    fast = replace(slow, drive=replace(slow.drive, speed=-speed))
    missing = MASS * HIGH / 2 * speed**2 - top
    (note,) = preloads_to_hold(fast)
    preload = note.values["preload"]
    size = -float(str(preload).removesuffix(" N"))
    assert missing <= size <= 1.1 * missing
    held = fast.with_springs([replace(spring, preload=-size)])
    assert lost_contacts(eq.analyze(fast).forces) and not lost_contacts(eq.analyze(held).forces)
    lightly = fast.with_springs([replace(spring, preload=-missing * 0.98)])
    assert lost_contacts(eq.analyze(lightly).forces)
    assert not [*preloads_to_hold(fast.with_springs([]))]


@pytest.mark.parametrize(("share", "held"), [(1.2, True), (2.5, False)])
def test_no_preload_is_named_that_lifts_another_follower_off(share: float, held: bool) -> None:
    """A spring between two tappets presses one down by what it lifts the other with.

    share : of gravity, that the acceleration of the first has at the top; the second has a quarter
        of it, and lifts off once it is lifted by three quarters of its weight, or less.
    """
    cams = [
        Cam("crank", name, rides="flat", point=point, closed_by="spring", base_radius=0.03,
            lift=LengthLaw(between=(0.0, high)))
        for name, point, high in (("lower", "R", HIGH), ("upper", "Q", HIGH / 4))
    ]  # fmt: skip
    both = machine(
        {"A": ORIGIN},
        {
            "crank": heavy(A=ORIGIN),
            "lower": eq.Link({"R": ORIGIN, "T": (0.1, 0.0)}, MASS, ORIGIN, 1e-4),
            "upper": eq.Link({"Q": ORIGIN, "U": (0.1, 0.15)}, MASS, ORIGIN, 1e-4),
        },
        sliders=tuple(
            eq.Slider(name, point, FRAME, "A", pi / 2)
            for name, point in (("lower", "R"), ("upper", "Q"))
        ),
        cams=cams,
        springs=(eq.Spring("lower", "T", "U", 1e-3, 0.15, on="upper"),),
    )
    speed = sqrt(share * GRAVITY / (HIGH / 2))
    both = replace(both, drive=replace(both.drive, speed=speed))
    notes = [*preloads_to_hold(both)]
    assert [note.values["follower"] for note in notes] == ["lower"] * held


SPRUNG = {
    "tappet": lambda: tappet(
        cam("roller", lift=RISE, closed_by="spring"),
        springs=(eq.Spring("tappet", "R", "S", 2000.0, 0.3),),
    ),
    "arm": lambda: eq.load("cam-pusher"),
}


@pytest.mark.parametrize("name", SPRUNG)
def test_at_the_lift_off_speed_the_contact_force_touches_zero(name: str) -> None:
    """Analysed at that speed there and all around, and a thousandth beside it."""
    given = SPRUNG[name]()
    (cam,) = given.cams
    (text,) = eq.analyze(given).part_figures["cams"].values()
    assert text.lost == () and text.lift_off_speed > abs(given.drive.speed)

    def normal(speed: float, angles: Any) -> Any:
        return eq.forces(eq.move(given, angles, speed)).cams[cam.name].normal

    limit, around = text.lift_off_speed, text.lift_off_at + np.linspace(-0.02, 0.02, 4001)
    size = np.max(normal(limit, 720))
    assert abs(normal(limit, [text.lift_off_at])[0]) < 1e-7 * size
    assert np.min(normal(limit, around)) > -1e-6 * size
    assert np.min(normal(limit, 20_000)) > -1e-6 * size
    assert np.min(normal(0.999 * limit, 20_000)) > 0
    assert np.min(normal(1.001 * limit, around)) < 0
    beyond = eq.analyze(given, speed=1.01 * limit).part_figures["cams"][cam.name].lost
    assert any(begin < text.lift_off_at < end for begin, end in beyond)


@pytest.mark.parametrize("name", SPRUNG)
def test_the_lift_off_speed_is_not_that_of_the_samples(name: str) -> None:
    """Few crank angles tell the same speed, and all of many samples lie above it."""
    given = SPRUNG[name]()
    (few,), (more,), (odd,) = (
        eq.analyze(given, count).part_figures["cams"].values() for count in (24, 720, 77)
    )
    assert few.lift_off_speed == pytest.approx(more.lift_off_speed, rel=1e-7)
    assert odd.lift_off_speed == pytest.approx(more.lift_off_speed, rel=1e-7)
    still, fast = (
        eq.forces(eq.move(given, 50_000, speed, 0.0)).cams[given.cams[0].name].normal
        for speed in (0.0, 1.0)
    )
    squares = [-a / (b - a) for a, b in zip(still, fast, strict=True) if b < a]
    assert few.lift_off_speed == pytest.approx(np.sqrt(min(squares)), rel=1e-5)
    assert few.lift_off_speed <= np.sqrt(min(squares)) * (1 + 1e-7)


@pytest.mark.parametrize("base", [0.02, 0.021, 0.0371])
def test_of_equal_extremes_the_first_is_reported(base: float) -> None:
    """An eccentric circle bends alike all round; a cam of two lobes lets go at both tops alike."""
    (actual,) = eq.analyze(tappet(cam(base_radius=base))).part_figures["cams"].values()
    assert (actual.least_radius, actual.least_radius_at) == (pytest.approx(base + HIGH / 2), 0)
    half = [LengthSegment(pi / 2, high, "harmonic") for high in (HIGH, 0.0)]
    twice = cam(
        base_radius=0.06 + base, lift=LengthLaw(segments=(*half, *half)), closed_by="spring"
    )
    (lobes,) = eq.analyze(tappet(twice)).part_figures["cams"].values()
    assert lobes.lift_off_at == pytest.approx(pi / 2)


def test_figures_of_a_cam_stand_in_plain_data() -> None:
    """Those of lifting off are null where ribs close it, or where masses are missing."""
    given = eq.load("cam-pusher")
    analysis = eq.analyze(given, speed=65.0)
    content = json.loads(json_text(analysis.to_dict()))["cams"]["crank to pusher"]
    ((begin, end),) = analysis.part_figures["cams"]["crank to pusher"].lost
    assert content["lost"] == [{"from": begin, "to": end}]
    radius = analysis.summary["cams.crank to pusher.curvature"]
    assert content["least_radius"] == pytest.approx(1 / radius.max, rel=1e-3)
    assert content["lift_off_speed"] == pytest.approx(
        analysis.part_figures["cams"]["crank to pusher"].lift_off_speed
    )
    ribbed = replace(given, cams=(replace(given.cams[0], closed_by="ribs"),))
    for other in (ribbed, given.with_link("arm", mass=None, center_of_mass=None, inertia=None)):
        (content,) = eq.analyze(other).part_figures["cams"].values()
        assert (content.lift_off_speed, content.lift_off_at, content.lost) == (None, None, ())


@pytest.mark.parametrize("rides", ["flat", "roller", "knife"])
@pytest.mark.parametrize("kind", ["tappet", "lever"])
def test_curvature_is_that_of_the_profile(kind: str, rides: str) -> None:
    """By differences of its points, in machines whose cam and carrier turn."""
    if kind == "tappet":
        given = tappet(cam(rides))
    else:
        given = lever(rides=rides, **({"normal": pi / 2} if rides == "flat" else {}))
    motion = eq.move(given, 24)
    reported = motion.element_values("cams", 0)["curvature"]
    (fit,) = fits_of(given, motion.linkage.joints)
    step = 1e-3
    before, here, after = (fit.shape(motion.crank_angle + k * step).surface for k in (-1, 0, 1))
    first, second = (after - before) / (2 * step), (after - 2 * here + before) / step**2
    bend = np.abs((np.conj(first) * second).imag) / np.abs(first) ** 3
    np.testing.assert_allclose(np.abs(reported), bend, rtol=1e-4)


def test_pull_of_a_return_spring() -> None:
    spring = eq.Spring("tappet", "R", "S", 1000.0, 0.3)
    analysis = eq.analyze(tappet(cam(closed_by="spring"), springs=(spring,)))
    length = 0.2 - analysis.motion.points["R"].y
    texts = analysis.outputs["springs.1.length"], analysis.outputs["springs.1.pull"]
    np.testing.assert_allclose(texts[0].values, length, rtol=1e-14)
    np.testing.assert_allclose(texts[1].values, 1000.0 * (length - 0.3), rtol=1e-13)
    assert "Springs" in words(analysis.blocks())


def test_pressure_angle_of_a_machine() -> None:
    analysis = eq.analyze(tappet(cam("roller", lift=RISE)))
    theta = analysis.crank_angle
    slope = analysis.motion.sliders["tappet on frame"].travel_1
    want = np.arctan(slope / (analysis.motion.points["R"].y))
    (text,) = [o for o in analysis.outputs.arrays if o.name.endswith("pressure_angle")]
    np.testing.assert_allclose(text.values, want, atol=1e-14)
    assert len(text.values) == len(theta)


def test_a_camshaft_at_half_the_speed_takes_two_turns() -> None:
    shaft = eq.Link({"C": ORIGIN}, 0.2, ORIGIN, 1e-4)
    given = tappet()
    given = replace(
        given,
        cams=(replace(cam("roller", lift=RISE), driver="shaft"),),
        frame={**given.frame, "C": (0.0, -0.1)},
        links={**given.links, "shaft": shaft},
        gears=(eq.Gear("crank", "shaft", teeth=(20, 40)),),
        sliders=(eq.Slider("tappet", "R", FRAME, "C", pi / 2),),
    )
    motion = eq.move(given, 36)
    assert motion.turns == 2
    rises = motion.points["R"].y + 0.1 - 0.038
    angle = -motion.crank_angle / 2
    np.testing.assert_allclose(rises, RISE.value(angle)[0], atol=1e-15)


def test_a_cam_without_a_law_is_round() -> None:
    """What it lifts stands still, and it bears the weight, on a guide and on a pin."""
    forces = eq.analyze(tappet(cam(lift=None))).forces
    np.testing.assert_allclose(forces.motion.points["R"].y, 0.03, atol=1e-16)
    np.testing.assert_allclose(forces.cams["crank to tappet"].normal, MASS * GRAVITY, rtol=1e-13)
    assert np.ptp(eq.move(lever(swing=None)).links["tappet"].angle) == 0


def test_a_spring_between_two_links() -> None:
    """It bears on both, nothing of it on the frame, and its energy comes back by the drive."""
    spring = eq.Spring("tappet", "T", "B", 800.0, 0.01, "crank")
    with_it, without = (
        eq.analyze(tappet(gravity=(0.0, 0.0), springs=springs), acceleration=0.0).forces
        for springs in ((spring,), ())
    )
    np.testing.assert_allclose(with_it.frame_force.value, without.frame_force.value, atol=1e-12)
    np.testing.assert_allclose(with_it.frame_moment, without.frame_moment, atol=1e-12)
    theta, points = with_it.motion.crank_angle, with_it.motion.points
    energy = 400.0 * (abs(points["T"].place - points["B"].place) - 0.01) ** 2
    orders = np.fft.rfftfreq(len(theta), 1 / len(theta))
    slope = np.fft.irfft(1j * orders * np.fft.rfft(energy), len(theta))
    np.testing.assert_allclose(with_it.drive_torque - without.drive_torque, slope, atol=1e-9)


# -- refusals --------------------------------------------------------------------------------------

BOTH = {"swing": AngleLaw(between=(0.0, 0.3)), "lift": LengthLaw(between=(0.0, 0.01))}


@pytest.mark.parametrize(
    ("changes", "where", "expected"),
    [
        (BOTH, "cams[1]", {}),
        (
            {"driver": "tappet"},
            "cams[1]",
            {"driver": "tappet", "driven": "tappet", "carrier": "frame"},
        ),
        ({"driver": "drum"}, "cams[1].cam", {"given": "drum"}),
        ({"driven": "drum"}, "cams[1].follower", {"given": "drum"}),
        ({"point": "Q"}, "cams[1].point", {"given": "Q", "body": "tappet"}),
        ({"rides": "roller"}, "cams[1].roller_radius", {}),
        ({"roller_radius": 0.01}, "cams[1].roller_radius", {}),
        ({"rides": "knife", "normal": 0.1}, "cams[1].normal", {}),
        ({"closed_by": "groove"}, "cams[1].closed_by", {}),
        ({"lift": LengthLaw(between=(0.0, HIGH), turns=2)}, "cams[1].lift", {}),
        (
            {"lift": LengthLaw(segments=(LengthSegment(pi, 0.0),))},
            "cams[1].lift.segments",
            {"total": 180.0},
        ),
    ],
)
def test_values_of_a_cam(changes: dict[str, Any], where: str, expected: dict[str, Any]) -> None:
    refused(where, expected, lambda: tappet(replace(cam(), **changes)))


def test_a_face_of_a_lever_needs_its_normal() -> None:
    refused("cams[1].normal", {}, lambda: lever(rides="flat"))


@pytest.mark.parametrize(
    ("given", "where", "expected"),
    [
        (tappet(cam(lift=RISE)), "cams[1]", {"radius": -66.4539, "angle": 44.7271}),
        (tappet(cam("roller", lift=RISE, base_radius=0.005, roller_radius=0.03)), "cams[1]",
         {"radius": 18.5563, "roller": 30.0}),
        (lever(swing=AngleLaw(between=(0.0, 3.0))), "cams[1]", {"angle": 186.998}),
        (lever(rides="flat", normal=pi / 2, swing=AngleLaw(segments=(
            AngleSegment(0.3, 0.6), AngleSegment(0.3, 0.0), AngleSegment(2 * pi - 0.6, 0.0)))),
         "cams[1]", {"angle": 25.7831}),
        (lever(base_radius=0.2), "cams[1].base_radius", {"point": "R", "arm": 90.0}),
        (replace(lever(), cams=(cam(),)), "cams[1]", {"follower": "tappet", "guides": 0}),
        (replace(tappet(), frame={**tappet().frame, "A": (0.0, 0.0), "G": (0.05, 0.0)},
                 sliders=(eq.Slider("tappet", "R", FRAME, "G", pi / 2),), cams=(cam("knife"),)),
         "cams[1].base_radius", {"point": "R", "offset": 50.0}),
        (tappet(cam(normal=pi)), "cams[1].normal", {}),
        (tappet(replace(cam(), carrier="tappet", driven="crank", driver=FRAME, point="B")),
         "cams[1]", {"body": "frame", "carrier": "tappet"}),
    ],
)  # fmt: skip
def test_cams_that_cannot_be_made(given: eq.Machine, where: str, expected: dict[str, Any]) -> None:
    with refusals.refused(ModelError, where, **expected):
        assemble(given)


def test_least_radius_of_an_undercut_cam() -> None:
    """That of the closed form r + y + y'', whose least is told with its angle."""
    x = np.linspace(0, 1, 100001)
    turn = radians(60)
    y = HIGH * (x - np.sin(2 * pi * x) / (2 * pi))
    radius = 0.03 + y + HIGH * 2 * pi * np.sin(2 * pi * x) / turn**2
    assert float(np.min(radius)) * 1e3 == pytest.approx(-66.45, abs=5e-3)


NOD = AngleLaw(
    segments=(
        AngleSegment(1.0, 0.1, "cycloidal"),
        AngleSegment(1.0, 0.0, "cycloidal"),
        AngleSegment(2 * pi - 2.0, 0.0),
    )
)


@pytest.mark.exhaustive(but=["roller tappet", "flat lever"])
@pytest.mark.parametrize(
    "given",
    [
        tappet(cam(lift=RISE)),
        tappet(cam("roller", lift=RISE, base_radius=0.005, roller_radius=0.03)),
        lever(rides="flat", normal=pi / 2, swing=NOD, base_radius=0.02),
        lever(swing=NOD, base_radius=0.002, roller_radius=0.015),
    ],
    ids=("flat tappet", "roller tappet", "flat lever", "roller lever"),
)
def test_the_least_base_radius_that_does(given: eq.Machine) -> None:
    """With it the cam is made; of 0.1 % less it is said again that it cannot be."""
    with pytest.raises(ModelError) as caught:
        assemble(given)
    text = str(caught.value)
    least = float(dict(values_of(caught.value.note))["least"]) / 1e3
    assert "undercut" in text
    right, small = (
        replace(given, cams=(replace(given.cams[0], base_radius=radius),))
        for radius in (least, 0.999 * least)
    )
    assemble(right)
    with refusals.refused(ModelError, "cams[1]", base_radius="base_radius"):
        assemble(small)


def test_no_base_radius_that_does() -> None:
    """The follower swings by so much that it jams on a cam of any size that it reaches."""
    with refusals.refused(ModelError, "cams[1]", base_radius="base_radius", most=3000.0):
        assemble(lever(swing=AngleLaw(between=(0.0, 3.0))))


def test_a_cam_moved_by_its_own_follower() -> None:
    """The drive moves the lever, and nothing the cam."""
    given = replace(lever(), drive=eq.Drive("tappet", 3.0))
    with refusals.refused(eq.EquipoiseError, "cams[1]", follower="tappet"):
        assemble(given)


SWINGING_CAM = """
schema = 1
title = "Swinging cam"
[drive]
link = "crank"
speed = "60 rpm"
[drive.motor]
no_load_speed = "100 rpm"
stall_torque = "50 N m"
inertia = "0.01 kg m^2"
[frame.points]
A = ["0 mm", "0 mm"]
D = ["300 mm", "0 mm"]
E = ["80 mm", "-100 mm"]
[links]
crank = { points = ["A", "B"], length = "60 mm" }
coupler = { points = ["B", "C"], length = "280 mm" }
rocker = { points = ["D", "C"], length = "150 mm" }
lever = { points = ["E", "R"], length = "90 mm" }
[[cams]]
cam = "rocker"
follower = "lever"
rides = "roller"
point = "R"
roller_radius = "10 mm"
base_radius = "200 mm"
closed_by = "groove"
swing = { between = ["0 deg", "5 deg"] }
"""


def test_sides_are_asked_for_where_a_cam_swings_and_a_motor_drives() -> None:
    """Which sides turn fully was asked of the cam, and of the cam which sides they are."""
    with refusals.refused(eq.EquipoiseError, "assembly.C") as caught:
        assemble(eq.loads(SWINGING_CAM))
    assert 'C = "left"' in str(caught.value) and 'C = "right"' in str(caught.value)


def test_cams_are_counted_as_such() -> None:
    given = tappet()
    loose = {**given.links, "arm": heavy(A=ORIGIN)}
    with refusals.refused(eq.EquipoiseError, count="1", last="1 cam"):
        assemble(replace(given, links=loose))


def test_a_groove_has_a_second_flank() -> None:
    """In a narrow dip the far flank of a groove is undercut, where ribs need none."""
    law = LengthLaw(
        crank_angles=tuple(k * pi / 6 for k in range(12)),
        values=tuple(0.0 if k == 5 else 0.012 for k in range(12)),
    )
    ribs = cam("roller", lift=law, roller_radius=0.02)
    assemble(tappet(ribs))
    with refusals.refused(ModelError, "cams[1]", angle=150.0, radius=17.574):
        assemble(tappet(replace(ribs, closed_by="groove")))
