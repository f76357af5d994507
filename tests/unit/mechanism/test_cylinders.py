"""A boom on a pivot and a cylinder: the law of cosines, and strokes that cannot be had."""

from __future__ import annotations

from dataclasses import replace
from math import hypot, pi
from typing import Any

import numpy as np
import pytest

import equipoise as eq
from equipoise.errors import ModelError, UsageError
from equipoise.exchange.export import export_content
from equipoise.exchange.formats import FORMATS
from equipoise.figures import render
from equipoise.mechanism.dynamics.parameters import parameter_values, regressor
from equipoise.mechanism.parts.drives import Drive, FurtherDrive
from equipoise.mechanism.parts.laws import AngleLaw, LengthLaw
from equipoise.mechanism.parts.loads import Load, LoadTable
from equipoise.present.findings import Findings
from equipoise.present.pictures import each
from equipoise.present.summary import tiles
from equipoise.results.machine_blocks import driven
from equipoise.web.design import Design
from equipoise.web.messages import message_of
from equipoise.web.session import Session
from support import refusals
from unit.mechanism.build import ORIGIN, four_bar, heavy, machine, refused

A, B = (0.3, -0.4), (0.5, 0.1)


def boom(**changes: Any) -> eq.Machine:
    """A boom that turns about P, with the cylinder below it."""
    given: dict[str, Any] = {
        "between": ("A", "B"), "stroke": LengthLaw(between=(0.55, 0.8)), "start": 0.5
    }  # fmt: skip
    links = {"boom": heavy(P=ORIGIN, B=B, C=(2.0, 0.0))}
    drive = Drive("boom", 2.0, **given | changes)
    return machine({"P": ORIGIN, "A": A}, links, drive=drive)


def test_the_law_of_cosines() -> None:
    motion = eq.move(boom(), 90)
    length = motion.machine.drive.stroke.value(motion.crank_angle)[0]  # type: ignore[union-attr]
    a, b = hypot(*A), hypot(*B)
    opened = np.arccos((a * a + b * b - length**2) / (2 * a * b))
    angle = opened + np.angle(complex(*A)) - np.angle(complex(*B))
    np.testing.assert_allclose(motion.links["boom"].angle, angle, rtol=0, atol=1e-12)


def test_the_force_at_rest_holds_the_weight_by_its_lever() -> None:
    analysis = eq.analyze(boom(), 30, speed=0.0)
    motion = analysis.motion
    a, b = complex(*A), motion.points["B"].place
    lever = (b.conj() * (b - a)).imag / np.abs(b - a)
    weight = 0.5 * 9.80665 * motion.mass_centers["boom"].x
    np.testing.assert_allclose(analysis.forces.drive_force * lever, weight, rtol=1e-12)
    pin, push = analysis.forces.joints["P"], analysis.forces.drive_force * (b - a) / np.abs(b - a)
    np.testing.assert_allclose(pin.value + push, 0.5j * 9.80665, rtol=1e-12)
    assert "drive_torque" not in analysis.outputs
    assert "drive_force" in analysis.outputs


def test_the_regressor_and_the_parts_add_up_to_the_force() -> None:
    analysis = eq.analyze(boom(), 24)
    whole = analysis.forces.drive_force
    columns = regressor(analysis.motion).drive_force
    np.testing.assert_allclose(parameter_values(boom()) @ columns, whole, rtol=1e-12)
    np.testing.assert_allclose(sum(analysis.forces.split.by_cause("drive_force").values()), whole)


def arm(
    start: float = -1.2, between: tuple[float, float] = (0.9, 1.0), **changes: Any
) -> eq.Machine:
    """The boom with a stick that hangs on it, pushed by a cylinder from the boom."""
    stick = heavy(C=ORIGIN, F=(-0.3, 0.2), T=(1.0, 0.0))
    given: dict[str, Any] = {"between": ("E", "F"), "stroke": LengthLaw(between=between, phase=1.0)}
    own = boom()
    body = own.links["boom"]
    links = {"boom": body.altered(points={**body.points, "E": (1.0, 0.3)}), "stick": stick}
    further = FurtherDrive("stick", start=start, **given | changes)
    return replace(own, links=links, drives=(further,))


def test_several_cylinders_have_a_force_each() -> None:
    """Whose parts add up, and whose powers are all that is fed in."""
    analysis = eq.analyze(arm(), 24)
    forces, outputs = analysis.forces, analysis.outputs
    columns, values = regressor(analysis.motion), parameter_values(analysis.machine)
    for link in ("boom", "stick"):
        name = f"drives.{link}.force"
        assert outputs[name].values is forces.drives[link]
        np.testing.assert_allclose(values @ columns.drives[link], forces.drives[link], rtol=1e-9)
        np.testing.assert_allclose(sum(forces.split.by_cause(name).values()), forces.drives[link])
    power = sum(outputs[f"drives.{link}.power"].values for link in ("boom", "stick"))
    np.testing.assert_allclose(power, forces.power, rtol=1e-12)
    assert eq.loads(eq.dumps(analysis.machine)) == analysis.machine


@pytest.mark.parametrize(
    ("expected", "changes"),
    [
        ({"place": "drives", "link": "stick", "angle": "143.2°"}, {"start": 2.5}),
        ({"place": "drives", "first": "'boom'", "last": "'stick'"}, {"between": (0.9, 1.5)}),
        ({"place": "drives[1]"}, {"ratio": 2.0}),
        ({"place": "drives[1].between"}, {"stroke": None}),
        ({"place": "drives[1].motion"}, {"motion": AngleLaw(between=(0.0, 1.0))}),
    ],
)  # fmt: skip
def test_strokes_beside_each_other_that_cannot_be_had(
    expected: dict[str, Any], changes: dict[str, Any]
) -> None:
    with refusals.refused(ModelError, **expected):
        eq.move(arm(**changes), 4)


def test_the_other_side_of_the_dead_point() -> None:
    """Above the line from P to A the same lengths are had, too."""
    below, above = (eq.move(boom(start=angle), 24) for angle in (0.5, -2.5))
    turned = np.exp(1j * (below.links["boom"].angle + np.angle(complex(*B))))
    line = complex(*A) / hypot(*A)
    mirrored = np.exp(1j * (above.links["boom"].angle + np.angle(complex(*B))))
    np.testing.assert_allclose(turned / line, (mirrored / line).conj(), atol=1e-12)


def test_a_stroke_that_cannot_be_had() -> None:
    refused(
        "drive.stroke",
        {"low": "550 mm", "high": "1.2 m", "least": "9.902 mm", "most": "1009.9 mm"},
        lambda: eq.move(boom(stroke=LengthLaw(between=(0.55, 1.2)))),
    )


def test_points_that_stay_as_far_apart() -> None:
    """A cylinder from the pivot of its boom."""
    given = replace(boom(), frame={"P": ORIGIN, "A": ORIGIN})
    refused("drive.between", {"link": "boom", "a": "A", "b": "B", "length": "509.9 mm"},
            lambda: eq.move(given))  # fmt: skip


def test_links_that_come_to_a_dead_point_beyond_the_stroke() -> None:
    """Bars that are not quite parallel cannot stretch: rates are infinite where that ends."""
    whole = eq.load("hydraulic-loader")
    lifted = replace(whole.links["boom"], points={**whole.links["boom"].points, "P": (0.0, 0.001)})
    motion = eq.move(replace(whole, links={**whole.links, "boom": lifted}), 12)
    length = np.abs(motion.points["B"].place - motion.points["A"].place)
    law = whole.drive.stroke
    np.testing.assert_allclose(length, law.value(motion.crank_angle)[0], rtol=1e-12)  # type: ignore[union-attr]


def test_a_stroke_that_can_be_had_in_two_ways() -> None:
    with refusals.refused(ModelError, "drive.start", link="boom"):
        eq.move(boom(start=None))


@pytest.mark.parametrize(
    ("where", "expected", "changes"),
    [
        ("drive.stroke", {}, {"slider": "rod on barrel"}),
        ("drive.between", {}, {"stroke": None}),
        ("drive.between[2]", {"given": "X"}, {"between": ("A", "X")}),
        ("drive.between", {"body": "boom"}, {"between": ("B", "C")}),
        ("drive.flywheel", {}, {"flywheel": 1.0}),
    ],
)
def test_what_is_refused(where: str, expected: dict[str, Any], changes: dict[str, Any]) -> None:
    refused(where, expected, lambda: boom(**changes))


def test_a_file_of_it_is_read_as_it_was_written() -> None:
    own = replace(boom(), title="boom")
    assert eq.loads(eq.dumps(own)) == own


@pytest.mark.parametrize("name", ["mjcf", "exudyn", "fmu", "modelica"])
def test_programs_that_turn_a_crank_refuse_it(name: str) -> None:
    with refusals.refused(UsageError, by="check_turning"):
        export_content(boom(), FORMATS[name], 0.0)
    with refusals.refused(UsageError, by="check_turning"):
        export_content(eq.load("pick-and-place"), FORMATS[name], 0.0)
    stuck = four_bar(1.0, 0.9, 0.5, 0.55)
    with refusals.refused(UsageError, first="B", second="D"):
        export_content(stuck, FORMATS[name], 0.0)


def test_everything_is_shown_of_it() -> None:
    """Pictures and page have the force in the place of the torque, and the cylinder."""
    findings = Findings(boom(), "", "boom.toml", 120)
    drawn = {item.name: item for item in each(findings)}
    assert "Force of the drive on boom" in render(drawn["torque"].chart).decode()
    blocks = [getattr(block, "title", "") for block in findings.analysis.blocks()]
    assert "Drive force by cause" in blocks
    text = " ".join(str(block) for block in findings.analysis.blocks())
    assert "cylinder A to B from 550.0 to 800.0 mm and back, 19.10 cycles a minute" in text


def test_a_load_over_two_turns_halves_the_cycles_a_minute_everywhere() -> None:
    """2 rad/s are 19.10 turns of the phase a minute, and all is back after two of them."""
    table = LoadTable((0.0, 4 * pi), ((5.0, 5.0),))
    loaded = replace(boom(), loads=(Load("boom", table=table),))
    for given, rate, turns in ((boom(), "19.10", 1), (loaded, "9.549", 2)):
        assert f"{rate} cycles a minute" in repr(given)
        assert f"{rate} cycles a minute" in repr(eq.move(given, 90))
        assert f"{rate} cycles a minute" in driven(given, -2.0)
        assert given.turns_given == eq.move(given, 90).turns == turns
        assert given.cycles_per_minute(-2.0) == pytest.approx(60 * 2 / (2 * pi * turns))
        pace = next(iter(tiles(Findings(given, "", "boom.toml", 120))))
        assert float(pace.value) == pytest.approx(float(rate), rel=1e-2)


def test_the_page_draws_barrel_and_rod_which_keep_their_lengths() -> None:
    session = Session()
    session.open(Design("boom.toml", boom()))
    replies = [item.content for item in session.receive(message_of({"type": "ready"}))]
    (state,) = [reply for reply in replies if reply["type"] == "state"]
    pushed = [sign for sign in state["scene"]["signs"] if (sign["hold"] or {}).get("rigid")]
    assert [sign["shapes"][0][0] for sign in pushed] == ["piston", "barrel"]
    assert [item["name"] for item in state["charts"] if item["name"].startswith("drive")] == [
        "drive_force"
    ]


def test_a_stroke_beside_other_drives_hangs_on_geared_links() -> None:
    """Lengths are as commanded, and without loads both drives together do no work in a cycle; a
    gear whose driver is pushed itself is refused.
    """
    law = LengthLaw(between=(0.55, 0.65))
    links = {
        "crank": heavy(A=ORIGIN, B=(0.1, 0.0)),
        "wheel": heavy(D=ORIGIN, W=(0.05, 0.0), V=(-0.05, 0.0)),
        "arm": heavy(W=ORIGIN, T=(0.4, 0.0)),
        "pinion": heavy(V=ORIGIN, S=(0.1, 0.0)),
    }
    frame = {"A": ORIGIN, "D": (0.5, 0.0), "Q": (0.9, -0.6)}
    lifted = FurtherDrive("arm", between=("Q", "T"), stroke=law)
    gears, drive = (eq.Gear("crank", "wheel", -1.0),), Drive("crank", 5.0)
    more = eq.Gear("arm", "pinion", 2.0, carrier="wheel")
    with refusals.refused(ModelError, "drives"):
        eq.analyze(machine(frame, links, drive=drive, gears=(*gears, more), drives=(lifted,)))
    del links["pinion"]
    analysis = eq.analyze(machine(frame, links, drive=drive, gears=gears, drives=(lifted,)), 360)
    ends = (analysis.motion.points[name].place for name in "QT")
    lengths = np.abs(next(ends) - next(ends))
    np.testing.assert_allclose(lengths, law.value(analysis.crank_angle)[0], atol=1e-14)
    work = analysis.forces.work
    assert abs(work["crank"]) > 1e-3
    assert sum(work.values()) == pytest.approx(0.0, abs=1e-12)
