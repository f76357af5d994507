"""Pins in circular slots, against the links without mass that do the same."""

from __future__ import annotations

import shutil
from dataclasses import replace
from math import pi
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import equipoise as eq
from equipoise.codegen.batch import Batch
from equipoise.codegen.figures import Figure
from equipoise.codegen.other_languages import javascript
from equipoise.errors import ModelError, UsageError
from equipoise.mechanism import Belt, Link, Machine
from equipoise.mechanism.assembly.linkage import assemble
from equipoise.mechanism.kinematics.belt_crossings import crossings
from equipoise.mechanism.parts.circular_slots import CircularSlot
from equipoise.mechanism.parts.joint_properties import JointProperties
from equipoise.symbols.pieces import pieces
from equipoise.symbols.scene import Scene
from equipoise.web.gallery import opened_file
from equipoise.web.session import Session
from secondroute.test_javascript import run
from support import free_bodies, newton
from support.analyses import ANGLES
from support.poses import from_motion
from support.refusals import refused
from surface.running import equipoise
from unit.schema.samples import survives
from unit.web.pages import ask, refusal, state

SLOT = CircularSlot("coupler", "C", "frame", "D", 0.08)


def with_bar(base: Machine) -> Machine:
    """The four-bar whose rocker has no mass."""
    bare = replace(base.links["rocker"], mass=0.0, inertia=0.0, center_of_mass=(0.0, 0.0))
    return replace(base, links={**base.links, "rocker": bare})


def in_slot(base: Machine, slot: CircularSlot = SLOT) -> Machine:
    """The same with a slot in the place of the rocker."""
    links = {name: link for name, link in base.links.items() if name != "rocker"}
    sides = {slot.name: base.assembly["C"]}
    return replace(base, links=links, circular_slots=(slot,), assembly=sides)


BASE = replace(eq.load("yamashita-1"), planting=None, support=None, rows=(), balance=None)
BAR, MACHINE = with_bar(BASE), in_slot(BASE)


def on_crank(slot: CircularSlot) -> Machine:
    """A slot on the crank, whose pin is on the rocker: the coupler in a slot's place."""
    links = {name: link for name, link in BASE.links.items() if name != "coupler"}
    return replace(BASE, links=links, circular_slots=(slot,), assembly={slot.name: "left"})


def test_a_file_has_all_that_it_is(tmp_path: Path) -> None:
    slot = replace(SLOT, arc=(0.2, 2.2), own_name="track")
    text = survives(in_slot(BASE, slot))
    assert '[[circular_slots]]\nlink = "coupler"\npoint = "C"\non = "frame"\n' in text
    path = tmp_path / "mine.toml"
    eq.save(in_slot(BASE, slot), path)
    reported = " ".join(equipoise("check", path).out.split())
    assert "circular slot: C of coupler about D of frame, radius 80.00 mm, from" in reported
    assert "coupler: dyad; joints B (pin on crank), track (pin in a slot)" in reported


def test_it_does_what_a_link_without_mass_does() -> None:
    bar, slot = (eq.analyze(item, 90) for item in (BAR, MACHINE))
    for name in ("drive_torque", "frame_moment"):
        np.testing.assert_array_equal(getattr(bar.forces, name), getattr(slot.forces, name))
    held, pushed = bar.forces.joints, slot.forces.joints["C in frame"]
    assert slot.forces.joints.keys() == {"A", "B", "C in frame"}
    assert (pushed.on, pushed.by) == ("coupler", "frame")
    np.testing.assert_array_equal(-held["C"].value, pushed.value)
    away = slot.motion.points["C"].place - slot.motion.points["D"].place
    normal = np.abs(pushed.value) * np.sign((np.conj(away) * pushed.value).real)
    np.testing.assert_allclose(pushed.normal, normal, atol=1e-9 * np.max(pushed.size))
    values = slot.motion.element_values("circular_slots", 0)
    rocker = bar.motion.links["rocker"]
    np.testing.assert_allclose(np.exp(1j * (values["angle"] - rocker.angle)), 1, atol=1e-12)
    np.testing.assert_allclose(values["speed"], 0.08 * rocker.angular_velocity, atol=1e-12)
    assert not {"C in frame", "centre of C in frame"} & {*slot.motion.points, *slot.motion.links}
    assert slot.summary["circular_slots.1.speed"].rms == pytest.approx(
        0.08 * np.sqrt(np.mean(rocker.angular_velocity**2))
    )
    assert slot.summary["joints.C in frame"] == bar.summary["joints.C"]


ON_CRANK = on_crank(CircularSlot("rocker", "C", "crank", "B", 0.0715))


@pytest.mark.parametrize("machine", [MACHINE, ON_CRANK, eq.load("flap-folder")])
def test_motion_and_forces_by_a_second_route(machine: Machine) -> None:
    """Newton's method on |PC| = R, and all free bodies with one push along PC."""
    analysis = eq.analyze(machine, angles=ANGLES)
    poses = from_motion(machine, analysis.motion)
    traced = newton.trace(machine, ANGLES, newton.coordinates(poses, 0))
    for name, link in analysis.motion.links.items():
        np.testing.assert_allclose(np.exp(1j * (link.angle - traced.angle[name])), 1, atol=1e-10)
        rates = link.angular_velocity, link.angular_acceleration
        for got, want in zip(rates, (traced.omega[name], traced.alpha[name]), strict=True):
            np.testing.assert_allclose(got, want, atol=1e-9 * np.max(np.abs(want)))
    free = free_bodies.solve(machine, poses)
    for name, joint in analysis.forces.joints.items():
        reaction = free.joints[name]
        force = reaction.force[:, 0] + 1j * reaction.force[:, 1]
        assert (joint.on, joint.by) == (reaction.on, reaction.by)
        np.testing.assert_allclose(joint.value, force, atol=1e-10 * np.max(joint.size))
    torque = free.drives[machine.drive.link]
    np.testing.assert_allclose(analysis.forces.drive_torque, torque, atol=1e-12)


def test_the_slot_does_no_work() -> None:
    """Power fed in is what kinetic energy and height take."""
    machine = ON_CRANK
    analysis = eq.analyze(machine, angles=ANGLES)
    taken = 0.0
    for name, link in machine.links.items():
        center, turning = analysis.motion.mass_centers[name], analysis.motion.links[name]
        pull = center.acceleration_vector - complex(*machine.gravity)
        taken = taken + link.mass * (np.conj(center.velocity) * pull).real
        taken = taken + link.inertia * turning.angular_velocity * turning.angular_acceleration
    np.testing.assert_allclose(analysis.forces.power, taken, atol=1e-10 * np.max(np.abs(taken)))


def test_a_pin_stays_between_the_ends_of_its_slot() -> None:
    angle = eq.move(MACHINE).element_values("circular_slots", 0)["angle"]
    low, high = float(np.min(angle)), float(np.max(angle))
    wide = replace(SLOT, arc=(low - 1e-3, high + 1e-3))
    assert np.ptp(eq.move(in_slot(BASE, wide)).element_values("circular_slots", 0)["angle"]) > 0.5
    for arc in ((low + 1e-3, high + 1e-3), (low - 1e-3, high - 1e-3)):
        with refused(ModelError, "circular_slots[1]"):
            eq.analyze(in_slot(BASE, replace(SLOT, arc=arc)))


def test_a_pin_that_never_moves_is_held_in_its_slot_too() -> None:
    """A bar between the frame and a slot of the frame, which nothing moves."""
    place = complex(*BASE.frame["D"]) + 0.08 * np.exp(1j)
    bar = replace(BASE.links["rocker"], points={"A": (0.0, 0.0), "R": (abs(place), 0.0)})

    def standing(side: str, arc: tuple[float, float]) -> Machine:
        slot = CircularSlot("bar", "R", "frame", "D", 0.08, arc=arc)
        sides = {**BASE.assembly, slot.name: side}
        links = {**BASE.links, "bar": bar}
        return replace(BASE, links=links, circular_slots=(slot,), assembly=sides)

    actual = {
        side: eq.move(standing(side, (-pi, 3.0))).element_values("circular_slots", 0)["angle"]
        for side in ("left", "right")
    }
    side = next(side for side, angle in actual.items() if abs(angle[0] - 1) < 1e-9)
    assert actual[side] == pytest.approx(np.full(360, 1.0))
    with refused(ModelError, "circular_slots[1]", crank_angle=0.0):
        eq.move(standing(side, (2.0, 3.0)))


# Designs of curved slots vary alike: test_curved_slots.py.
@pytest.mark.exhaustive
def test_designs_vary_its_radius_and_its_ends() -> None:
    angle = eq.move(MACHINE).element_values("circular_slots", 0)["angle"]
    arc = float(np.min(angle)) - 0.05, float(np.max(angle)) + 0.05
    machine = in_slot(BASE, replace(SLOT, arc=arc))
    names = ("drive_torque", "joints.C in frame", "circular_slots.1.speed")
    paths = ["circular_slots[1].radius", "circular_slots[1].arc[2]"]
    batch = Batch(machine, paths, [Figure(name, "rms") for name in names], angles=90)
    sizes = [(0.08, arc[1]), (0.0802, arc[1]), (0.08, arc[1] - 0.1), (-0.08, arc[1])]
    figures, reason = batch(np.array(sizes))
    assert reason.astype(bool).tolist() == [False, False, True, True]
    for row, (radius, last) in zip(figures, sizes[:2], strict=False):
        alone = replace(SLOT, radius=radius, arc=(arc[0], last))
        summary = eq.analyze(in_slot(BASE, alone), 90).summary
        np.testing.assert_allclose(row, [summary[name].rms for name in names], rtol=1e-9)


@pytest.mark.skipif(shutil.which("node") is None, reason="needs Node to run JavaScript")
def test_scripts_have_it(tmp_path: Path) -> None:
    linkage, names = assemble(MACHINE), ["drive_torque", "joints.C in frame.force_x",
                                         "circular_slots.1.angle"]  # fmt: skip
    script, actual = javascript(linkage, names), eq.analyze(MACHINE, 24)
    got = run(script, script.numbers(linkage), actual.motion.crank_angle, tmp_path)
    for name, values in zip(names, got, strict=True):
        wanted = actual.outputs[name].values
        np.testing.assert_allclose(values, wanted, atol=1e-12 * np.max(np.abs(wanted)))


@pytest.mark.parametrize(("change", "expected"), [
    ({"link": "copler"}, {"place": "circular_slots[1].link", "name": "coupler", "given": "copler"}),
    ({"point": "Q"}, {"place": "circular_slots[1].point", "body": "coupler", "given": "Q"}),
    ({"on": "fram"}, {"place": "circular_slots[1].on", "given": "fram", "name": "frame"}),
    ({"on": "coupler", "center": "B"}, {"place": "circular_slots[1].on", "link": "coupler"}),
    ({"center": "Q"}, {"place": "circular_slots[1].center", "body": "frame", "given": "Q"}),
    ({"radius": 0.0}, {"place": "circular_slots[1].radius", "limit": 0, "text": "0 m"}),
    ({"arc": (1.0, 0.5)}, {"place": "circular_slots[1].arc", "first": "57.2958 deg"}),
    ({"own_name": "B"}, {"place": "circular_slots[1].label", "name": "B"}),
])  # fmt: skip
def test_wrong_values_are_one_sentence(change: dict[str, object], expected: dict[str, Any]) -> None:
    with refused(ModelError, **expected):
        replace(MACHINE, circular_slots=(replace(SLOT, **change),))  # type: ignore[arg-type]


def test_its_side_is_asked_for_by_its_name() -> None:
    with refused(ModelError, "assembly.C in frame", first="left"):
        assemble(replace(MACHINE, assembly={}))


def test_pins_in_slots_have_radii_and_formats_without_slots_refuse(tmp_path: Path) -> None:
    joint = JointProperties("joints.C in frame", radius=0.004)
    machine = replace(MACHINE, joints=(joint,))
    assert assemble(machine).pin_radii == {"C": 0.004}
    with refused(ModelError, "joints[1].joint", given="joints.centre of C in frame"):
        assemble(replace(MACHINE, joints=(replace(joint, joint="joints.centre of C in frame"),)))
    for ending in ("xml", "urdf", "mo", "py"):
        with refused(UsageError, special="circular slots"):
            eq.export(MACHINE, tmp_path / f"mine.{ending}")
    assert not [*tmp_path.iterdir()]


def test_drawings_have_slots_with_their_ends() -> None:
    machine = in_slot(BASE, replace(SLOT, arc=(-1.0, 2.9)))
    (path,) = (shape for piece in pieces(Scene.of(eq.move(machine, 12))) for shape in piece.shapes
               if shape.role == "path")  # fmt: skip
    middle = path.places - complex(*BASE.frame["D"])
    np.testing.assert_allclose(np.abs(middle), 0.08)
    np.testing.assert_allclose([np.min(np.angle(middle)), np.max(np.angle(middle))], [-1.0, 2.9])
    rings = [shape for piece in pieces(Scene.of(eq.move(MACHINE, 12))) for shape in piece.shapes
             if shape.role == "path-edge"]  # fmt: skip
    assert len(rings) == 2


def test_the_page_has_its_form_and_moves_it(tmp_path: Path) -> None:
    session = Session()
    eq.save(MACHINE, tmp_path / "mine.toml")
    session.open(opened_file(tmp_path / "mine.toml"))
    content = state(ask(session, "ready")[1])
    assert content.field("circular_slots[1].radius")["value"] == 0.08
    before = content.place("C")
    values = {"link": "coupler", "point": "C", "on": "frame", "center": "D", "radius": "80.5 mm"}
    reply = ask(session, "entry", place="circular_slots[1]", values=values, seq=1)
    assert np.max(np.abs(state(reply[0]).place("C") - before)) > 1e-4
    wrong = {**values, "point": "Q"}
    reply = ask(session, "entry", place="circular_slots[1]", values=wrong, seq=2)
    assert "point of coupler" in refusal(reply)
    state(ask(session, "make", do="rename", what="point", name="D", to="M", at=0)[0])
    assert session.shown.design.machine.circular_slots[0].center == "M"
    state(ask(session, "make", do="delete", what="point", name="M", at=0)[0])


def test_the_centre_of_a_slot_is_no_axle_that_a_belt_has_to_pass() -> None:
    """Of a belt on the frame, whose strands run on both sides of it."""
    wheel = Link({"W": (0.0, 0.0)}, 1.0, (0.0, 0.0), 1e-3)
    frame = {**MACHINE.frame, "W": (4 * MACHINE.frame["D"][0], 4 * MACHINE.frame["D"][1])}
    belted = replace(
        MACHINE,
        frame=frame,
        links={**MACHINE.links, "wheel": wheel},
        belts=(Belt("crank", "wheel", radii=(0.02, 0.02)),),
    )
    analysis = eq.analyze(belted, 90)
    assert analysis.forces.joints["C in frame"] is not None
    assert [*crossings(analysis.motion.linkage)] == []
