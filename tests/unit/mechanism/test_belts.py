"""Belts, chains and racks: what is refused, closed forms, strands, and solved as loops."""

from __future__ import annotations

from dataclasses import replace
from math import pi
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import equipoise as eq
from equipoise.errors import ModelError, MotionError, UsageError
from equipoise.mechanism import Belt, Position, Rack
from equipoise.mechanism.assembly.linkage import assemble
from equipoise.mechanism.kinematics.belt_crossings import crossings
from equipoise.mechanism.parts.machine import FRAME
from equipoise.results.analysis_blocks import analysis_blocks
from equipoise.results.belt_blocks import slack
from equipoise.results.blocks import Notes
from equipoise.results.remarks import linkage_remarks
from equipoise.symbols.pieces import pieces
from equipoise.symbols.scene import Scene
from support import refusals
from support.machines import make
from unit.mechanism.build import ORIGIN, crank_rocker, heavy, machine, refused
from unit.mechanism.test_newton import only_loops


def belted(*belts: Belt, **more: Any) -> eq.Machine:
    links = {"crank": heavy(A=ORIGIN), "wheel": heavy(E=ORIGIN)}
    return machine({"A": ORIGIN, "E": (0.5, 0.0)}, links, belts=belts, **more)


def belt(**more: Any) -> Belt:
    return Belt("crank", "wheel", **({"radii": (0.1, 0.2)} | more))


def racked(rack: Rack, **more: Any) -> eq.Machine:
    """A crank-rocker, of which the rocker moves a rack."""
    four = crank_rocker()
    return replace(
        four,
        frame={**four.frame, "H": (0.3, 0.4)},
        links={**four.links, "ram": heavy(S=ORIGIN)},
        sliders=(eq.Slider("ram", "S", FRAME, "H", direction=0.3, angle=0.1),),
        racks=(rack,),
        **more,
    )


# -- motion ----------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("belt", "turns", "winding"),
    [
        (belt(radii=None, teeth=(20, 30), pitch=0.01), 3, 2),
        (belt(radii=None, teeth=(30, 30), pitch=0.01), 1, 1),
        (belt(radii=None, teeth=(30, 30), pitch=0.01, crossed=True), 1, -1),
        (belt(), 2, 1),
    ],
)
def test_ratio_and_cycle(belt: Belt, turns: int, winding: int) -> None:
    """An open belt turns both alike, also at a ratio of 1, a crossed one against each other."""
    motion = eq.move(belted(replace(belt, start=0.4)), 24)
    assert (motion.turns, motion.linkage.cycle.windings["wheel"]) == (turns, winding)
    angle = motion.links["wheel"].angle
    np.testing.assert_allclose(angle, 0.4 + motion.crank_angle * winding / turns, atol=1e-13)


def test_a_planet_on_a_belt_keeps_its_direction() -> None:
    """Equal pulleys, the first standing still: the arm carries the other round without turning it.

    With 2 to 1 it turns back once a turn: 1 - 2 of the arm.
    """
    for teeth, speed in (((20, 20), 0.0), ((40, 20), -1.0)):
        first = Belt(FRAME, "planet", teeth=teeth, pitch=0.01, carrier="arm")
        links = {"arm": heavy(A=ORIGIN, C=(0.5, 0.0)), "planet": heavy(C=ORIGIN)}
        given = machine({"A": ORIGIN}, links, drive=eq.Drive("arm", 2.0), belts=(first,))
        np.testing.assert_allclose(eq.move(given, 12).links["planet"].angle_1, speed, atol=1e-15)


@pytest.mark.parametrize(("side", "sense"), [("left", 1), ("right", -1)])
def test_a_rack_travels_as_its_pinion_rolls(side: Any, sense: int) -> None:
    given = racked(Rack("rocker", "ram", 0.07, side, travel=0.2))
    motion = eq.move(given, 36)
    turned = motion.links["rocker"].angle - motion.links["rocker"].angle[0]
    np.testing.assert_allclose(
        motion.sliders["ram on frame"].travel, 0.2 + sense * 0.07 * turned, atol=1e-15
    )


# -- strands ---------------------------------------------------------------------------------------


@pytest.mark.parametrize("torque", [6.0, -6.0])
@pytest.mark.parametrize("crossed", [False, True])
def test_strands_of_a_chain_and_of_a_belt(crossed: bool, torque: float) -> None:
    """The strand that runs onto the driving side is tight; the pin bears both strands."""
    loads = (eq.Load("wheel", torque=torque),)
    given = belted(belt(crossed=crossed), gravity=(0.0, 0.0), loads=loads)
    chain = eq.analyze(given, 12, speed=0.0).forces
    pull = -torque / 0.2
    name = "crank to wheel"
    np.testing.assert_allclose(chain.belts[name].pull, pull)
    left = -pull if crossed else pull
    np.testing.assert_allclose(chain.belts[name].left, max(left, 0.0))
    np.testing.assert_allclose(chain.belts[name].right, max(-left, 0.0))
    np.testing.assert_allclose(chain.joints["E"].size, abs(pull))
    tight = replace(given, belts=(belt(crossed=crossed, tension=40.0),))
    forces = eq.analyze(tight, 12, speed=0.0).forces
    np.testing.assert_allclose(forces.belts[name].left, 40 + left / 2)
    np.testing.assert_allclose(forces.belts[name].right, 40 - left / 2)
    np.testing.assert_allclose(forces.drive_torque, chain.drive_torque)
    lean = np.arcsin((0.1 + (0.2 if crossed else -0.2)) / 0.5)
    along = 80 * np.cos(lean), pull * np.sin(lean) * (-1 if crossed else 1)
    np.testing.assert_allclose(abs(forces.joints["E"].x), along[0])
    np.testing.assert_allclose(abs(forces.joints["E"].y), abs(along[1]))
    assert not [*slack(forces)]


def test_a_slack_strand_is_reported() -> None:
    """With the crank angle and the tension that it takes."""
    load = eq.Load("wheel", torque=-6.0, start=1.0, stop=2.0)
    given = belted(belt(tension=10.0), gravity=(0.0, 0.0), loads=(load,))
    analysis = eq.analyze(given, np.radians([0.0, 90.0, 200.0]), speed=0.0)
    (text,) = slack(analysis.forces)
    assert str(text) == (
        "the belt crank to wheel hangs loose: at crank angle 90.0° its slack strand would have "
        "to push with 5.000 N; give it a tension of more than 15.00 N"
    )
    assert any(isinstance(block, Notes) for block in analysis_blocks(analysis))
    causes = next(
        item
        for item in analysis_blocks(analysis)
        if str(getattr(item, "title", "")) == "Drive torque by cause"
    )
    assert "springs" not in [str(row[0]) for row in causes.rows]
    chain = eq.analyze(replace(given, belts=(belt(),)), 12)
    assert not any(isinstance(block, Notes) for block in analysis_blocks(chain))


def test_shares_of_strands_add_up() -> None:
    for tension in (None, 25.0):
        given = belted(belt(tension=tension), loads=(eq.Load("wheel", torque=2.0),))
        forces = eq.analyze(given, 12).forces
        for strand in ("left", "right"):
            output = f"belts.crank to wheel.{strand}"
            whole = getattr(forces.belts["crank to wheel"], strand)
            for parts in (forces.split.by_cause(output), forces.split.by_link(output)):
                np.testing.assert_allclose(sum(parts.values()), whole, atol=1e-12)
        assert forces.split.by_cause(output)["spring"] == pytest.approx(tension or 0.0)


# -- as loops --------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", ["belted_coupler", "rack_on_coupler", "pinion_on_frame"])
def test_the_same_by_newtons_method(name: str) -> None:
    """A linkage put together as one group of loops moves and bears alike."""
    given = make(name, 1).machine
    angles = np.linspace(0.0, 6.0, 12)
    want, first = eq.analyze(given, angles), eq.analyze(given, np.zeros(1)).motion
    places = {
        point: (float(value.x[0]), float(value.y[0]))
        for point, value in first.points.items()
        if point not in given.frame
    }
    turned = {link: float(value.angle[0]) for link, value in first.links.items()}
    rough = replace(given, assembly={}, position=Position(0.0, places, turned))
    with only_loops():
        analysis = eq.analyze(rough, angles)
    size = max(np.max(joint.size) for joint in want.forces.joints.values())
    for array in want.outputs.arrays:
        if array.name.startswith(("belts.", "racks.", "drive_torque")):
            got = next(other for other in analysis.outputs.arrays if other.name == array.name)
            np.testing.assert_allclose(got.values, array.values, rtol=1e-11, atol=1e-11 * size)
    for link in given.links:
        got, was = (a.motion.links[link].angle_2 for a in (analysis, want))
        np.testing.assert_allclose(got, was, atol=1e-11 * max(1.0, np.max(abs(was))))


# -- refusals --------------------------------------------------------------------------------------


def assembled(given: eq.Machine) -> object:
    return eq.mechanism.assemble(given)


def test_pulleys_that_overlap() -> None:
    for crossed in (False, True):
        given = belted(belt(radii=(0.3, 0.3), crossed=crossed))
        refused(
            "belts[1]", {"reach": 600.0, "distance": 500.0}, lambda given=given: assembled(given)
        )


def test_a_belt_across_a_link_of_its_carrier() -> None:
    """A crossed belt between equal pulleys, and a link that turns where its strands cross."""
    first = Belt(FRAME, "planet", radii=(0.1, 0.1), crossed=True, carrier="arm")
    links = {
        "arm": heavy(A=ORIGIN, B=(0.25, 0.0), C=(0.5, 0.0)),
        "idler": heavy(B=ORIGIN),
        "planet": heavy(C=ORIGIN),
    }
    gears = (eq.Gear(FRAME, "idler", ratio=-1.0, carrier="arm"),)
    given = machine({"A": ORIGIN}, links, drive=eq.Drive("arm", 2.0), gears=gears, belts=(first,))
    refused("belts[1]", {"link": "idler", "pin": "B", "carrier": "arm"},
            lambda: assembled(given))  # fmt: skip


@pytest.mark.parametrize(("length", "angle"), [(0.25, 235.0), (0.45, 220.0), (0.19, None)])
def test_a_strand_across_a_link_that_turns_beside_it(length: float, angle: float | None) -> None:
    """The strands lie 0.1 m beside the line of the pins, the link's pin 0.3 m: on the arm it dips
    below them where its sine, of the crank angle, is below -0.2 / length; a long one at the ends of
    the strand first, where its slope is 0.2 / 0.25.  Every 5 deg are looked at.
    """
    links = {
        "arm": heavy(A=ORIGIN, B=(0.25, 0.3), C=(0.5, 0.0)),
        "rod": heavy(B=ORIGIN, D=(length, 0.0)),
        "planet": heavy(C=ORIGIN),
    }
    first = Belt(FRAME, "planet", radii=(0.1, 0.1), carrier="arm")
    gears = (eq.Gear(FRAME, "rod", ratio=-1.0, carrier="arm"),)
    given = machine({"A": ORIGIN}, links, drive=eq.Drive("arm", 2.0), gears=gears, belts=(first,))
    actual = [str(remark) for remark in linkage_remarks(assemble(given)) if "strand" in str(remark)]
    sentence = (
        "belts[1]: a strand lies across 'rod' at crank angle {} deg; move B, change the radii, or "
        "give 'rod' a plane of its own"
    )
    assert actual == ([sentence.format(f"{angle:.4g}")] if angle else [])
    beside = {**links, "rod": replace(links["rod"], plane=0.01)}
    assert not [*crossings(assemble(replace(given, links=beside)))]


def test_a_belt_needs_both_pulleys_on_its_carrier() -> None:
    four = crank_rocker()
    given = replace(four, links={**four.links, "wheel": heavy(C=ORIGIN)}, belts=(belt(),))
    refused("belts[1]", {"body": "wheel", "shared": 0, "carrier": "frame"},
            lambda: assembled(given))  # fmt: skip


@pytest.mark.parametrize(
    ("where", "expected", "more"),
    [
        ("belts[1]", {}, {"radii": None}),
        ("belts[1]", {}, {"teeth": (9, 9), "pitch": 0.01}),
        ("belts[1].pitch", {}, {"radii": None, "teeth": (20, 20)}),
        ("belts[1].teeth", {}, {"pitch": 0.01}),
        ("belts[1].tension", {"text": "0 N"}, {"tension": 0.0}),
        ("belts[1].radii[2]", {"text": "-0.2 m"}, {"radii": (0.1, -0.2)}),
    ],
)  # fmt: skip
def test_keys_of_a_belt(where: str, expected: dict[str, Any], more: dict[str, Any]) -> None:
    refused(where, expected, lambda: belted(belt(**more)))


def test_a_belt_that_never_closes() -> None:
    with refusals.refused(MotionError, name="crank to wheel"):
        eq.move(belted(belt(radii=(0.1, 0.1 * pi))), 12)


def test_gears_of_ratio_1_are_to_be_a_belt() -> None:
    with refusals.refused(ModelError, "gears[1]"):
        belted(gears=(eq.Gear("crank", "wheel", teeth=(20, 20), mesh="internal"),))


def test_a_rack_that_never_comes_back() -> None:
    with refusals.refused(MotionError, rack="ram", pinion="crank"):
        eq.move(racked(Rack("crank", "ram", 0.05, "left")), 12)


def test_a_rack_needs_a_guide_and_its_pinion_a_pin() -> None:
    given = racked(Rack("coupler", "ram", 0.05, "left"))
    expected = {"pinion": "coupler", "rack": "ram", "carrier": "frame"}
    refused("racks[1]", expected, lambda: assembled(given))


def test_what_drives_reports_its_own_place() -> None:
    rack = Rack("rocker", "ram", 0.05, "left", angle=1.0)
    refused("racks[1].angle", {}, lambda: racked(rack))


@pytest.mark.parametrize("drives", ["pinion", "rack"])
def test_ends_of_a_rack_that_are_no_links(drives: Any) -> None:
    for key, ends in (("rack", ("rocker", "rom")), ("pinion", ("roker", "ram"))):
        rack = Rack(*ends, 0.05, "left", drives=drives)
        given, name = ("rom", "ram") if key == "rack" else ("roker", "rocker")
        refused(f"racks[1].{key}", {"given": given, "name": name}, lambda rack=rack: racked(rack))


# -- pictures and files ----------------------------------------------------------------------------


def test_strands_and_racks_are_drawn() -> None:
    """Strands end on both pulleys; the pinion rolls on the pitch line of the bar, which slides."""
    rack = Rack("rocker", "ram", 0.07, "left")
    four = racked(rack)
    wheel = replace(four, frame={**four.frame, "E": (2.0, 0.5)},
                    links={**four.links, "wheel": heavy(E=ORIGIN)},
                    belts=(Belt("rocker", "wheel", radii=(0.1, 0.05), crossed=True),))  # fmt: skip
    motion = eq.move(wheel, 36)
    scene = Scene.of(motion)
    *strands, line = scene.marks
    assert sorted(item.radius for item in scene.wheels) == [0.05, 0.07, 0.1]
    pin, other = (complex(*wheel.frame[name]) for name in ("D", "E"))
    for taut in strands:
        assert (taut.body, taut.point) == (FRAME, "D")
        assert abs(taut.shape.places[0]) == pytest.approx(0.1)
        assert abs(pin + taut.shape.places[1] - other) == pytest.approx(0.05)
    place = motion.points["S"].place
    turn = np.exp(1j * motion.links["ram"].angle)
    bar = (place[:, None] + turn[:, None] * line.shape.places - pin) / np.exp(0.3j)
    tips, back = bar.imag.max(), bar.imag.min()
    module = (tips - back) / 4.5  # a tooth reaches one of them above the pitch line
    np.testing.assert_allclose(bar.imag.max(axis=1), module - 0.07, atol=1e-12)
    assert bar.real.min(axis=1).max() == pytest.approx(-0.07)
    assert bar.real.max(axis=1).min() == pytest.approx(0.07)


@pytest.mark.parametrize(("side", "sense"), [("left", 1), ("right", -1)])
def test_the_guide_of_a_rack_is_hatched_away_from_its_teeth(side: Any, sense: int) -> None:
    scene = Scene.of(eq.move(racked(Rack("rocker", "ram", 0.07, side)), 12))
    (guide,) = (piece for piece in pieces(scene) if piece.layer == "guides")
    begin, end = (item.offsets / np.exp(0.3j) for item in (guide.shapes[0], guide.shapes[-1]))
    assert guide.shapes[0].role == "hatch" and guide.shapes[-1].role == "rail"
    assert np.all(begin.imag * sense < 0) and np.all(end.imag * sense > 0)


def test_a_file_without_racks_refuses_them(tmp_path: Path) -> None:
    given = racked(Rack("rocker", "ram", 0.07, "left"))
    with refusals.refused(UsageError, place="racks[1]", special="racks"):
        eq.export(given, tmp_path / "a.xml", format="mjcf")
    left = eq.export(belted(belt(tension=9.0)), tmp_path / "b.xml", format="mjcf")
    assert left == ("the tension of the belt crank to wheel, which its pins bear",)
    pytest.importorskip("ezdxf")
    eq.export(belted(belt()), tmp_path / "b.dxf")
    assert (tmp_path / "b.dxf").read_text(encoding="utf-8").count("LWPOLYLINE\n") == 2
    assert "crank to wheel" in (tmp_path / "b.xml").read_text(encoding="utf-8")
