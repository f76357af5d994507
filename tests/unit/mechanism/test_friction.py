"""Friction in joints: closed forms of textbooks, laws of power, keys, and what is said of it."""

from __future__ import annotations

from dataclasses import replace
from math import atan, pi, radians, tan
from typing import Any

import numpy as np
import pytest

import equipoise as eq
from equipoise.balancing.balanced import _of_friction
from equipoise.errors import LockError, ModelError
from equipoise.mechanism.assembly.linkage import assemble
from equipoise.mechanism.dynamics import friction
from equipoise.mechanism.kinematics.jumps import jumps_of
from equipoise.mechanism.parts.balance import AddedMass, Balance, Objective, Weight
from equipoise.mechanism.parts.curved_slots import CurvedSlot
from equipoise.mechanism.parts.joint_properties import JointProperties
from equipoise.mechanism.parts.links import Position
from equipoise.mechanism.parts.loads import Load
from equipoise.mechanism.parts.machine import Row
from laws.subjects import gravity_power, kinetic_power, load_power, spring_power
from support import refusals
from support.sentences import notes_by
from surface.running import equipoise, refused
from unit.schema.samples import survives

ANGLES = 0.0173 + np.linspace(0, 2 * np.pi, 60, endpoint=False)
ENGINE = replace(eq.load("slider-crank-engine"), balance=None)


def weightless(machine: eq.Machine, **changes: Any) -> eq.Machine:
    """The machine with links that weigh nothing."""
    links = {
        name: replace(link, mass=0.0, center_of_mass=(0.0, 0.0), inertia=0.0, bodies=())
        for name, link in machine.links.items()
    }
    return replace(machine, links=links, balance=None, **changes)


def rubbing(machine: eq.Machine, **given: JointProperties | float) -> eq.Machine:
    """A machine with friction in some pins, by coefficient times 20 mm, and in sliders."""
    joints = [
        JointProperties(f"joints.{name}", radius=0.02, friction=value)
        for name, value in given.items()
        if isinstance(value, float)
    ]
    return replace(machine, joints=tuple(joints), balance=None)


WORN = replace(
    ENGINE,
    joints=(
        JointProperties("joints.A", radius=0.02, friction=0.05, torsional_damping=1e-4),
        JointProperties("joints.B", radius=0.02, friction=0.05, drag_torque=0.1),
        JointProperties("joints.C", radius=0.01, friction=0.1, static_friction=0.15,
                        stribeck_speed=0.5),
        JointProperties("joints.piston on frame", friction=0.1, guide_length=0.06, damping=2.0,
                        drag_force=10.0),
    ),
)  # fmt: skip


# -- closed forms ----------------------------------------------------------------------------------


def test_a_rod_pushes_along_the_tangent_of_its_friction_circles() -> None:
    """Without mass its line of action touches a circle of mu r about each of its pins."""
    push, mu, radius = 1000.0, 0.1, 0.02
    machine = weightless(ENGINE, loads=(Load("piston", "C", force=(0.0, -push)),))
    forces = eq.analyze(rubbing(machine, B=mu, C=mu), ANGLES).forces
    plain = eq.analyze(machine, ANGLES).motion
    crank, rod = plain.links["crank"], plain.links["rod"]
    a, b, c = (plain.points[name].place for name in "ABC")
    turns_b = np.sign(rod.angular_velocity - crank.angular_velocity)
    turns_c = np.sign(rod.angular_velocity)  # the piston does not turn
    # The couple of the rod's two forces, S L sin(delta), balances the torques mu r S of both pins.
    lean = np.arcsin(mu * radius * (turns_b + turns_c) / np.abs(c - b))
    along = (c - b) / np.abs(c - b)
    for sign in (1.0, -1.0):
        line = along * np.exp(1j * sign * lean)
        if np.allclose(forces.joints["C"].value.real / np.abs(forces.joints["C"].value),
                       line.real * np.sign(line.imag), rtol=0, atol=1e-10):  # fmt: skip
            break
    else:
        raise AssertionError("the rod's force has another direction")
    thrust = push / line.imag  # of the rod on the piston, whose guide has no friction
    on_crank = -thrust * line
    lever = (np.conj(b - a) * on_crank).imag + mu * radius * np.abs(thrust) * turns_b
    np.testing.assert_allclose(forces.drive_torque, -lever, atol=1e-10 * np.max(np.abs(lever)))


def wedge(slope: float, friction: float) -> eq.Machine:
    """A Scotch yoke whose yoke is a wedge: a shoe on it lifts a load of 100 N."""
    yoke = eq.load("scotch-yoke")
    links = dict(yoke.links) | {
        "shoe": eq.Link({"D": (0.0, 0.0)}, 0.0, (0.0, 0.0), 0.0),
        "lift": eq.Link({"D": (0.0, 0.0)}, 0.0, (0.0, 0.0), 0.0),
    }
    frame = {**yoke.frame, "E": (0.2, 0.0)}
    slider = type(yoke.sliders[0])
    sliders = (
        *yoke.sliders,
        slider("shoe", "D", "yoke", "Y", pi - slope),
        slider("lift", "D", "frame", "E", pi / 2),
    )
    machine = replace(yoke, links=links, frame=frame, sliders=sliders, balance=None,
                      loads=(Load("lift", "D", force=(0.0, -100.0)),))  # fmt: skip
    joint = JointProperties("joints.shoe on yoke", friction=friction)
    return replace(weightless(machine), joints=(joint,))


@pytest.mark.parametrize("friction", [0.1, 0.3, 1.0])
@pytest.mark.parametrize("slope", [10.0, 30.0])
def test_a_wedge_lifts_with_the_tangent_of_both_angles(slope: float, friction: float) -> None:
    """F = W tan(slope + phi) forwards, and W tan(slope - phi) back: below 0 it has to be pulled."""
    analysis = eq.analyze(wedge(radians(slope), friction), ANGLES)
    way = analysis.motion.points["Y"].place_1.real
    phi, rising = atan(friction), analysis.motion.points["D"].velocity.imag > 0
    force = 100.0 * np.where(rising, tan(radians(slope) + phi), tan(radians(slope) - phi))
    # the wedge rises to the left, so that going right lifts
    np.testing.assert_allclose(analysis.forces.drive_torque, force * way, atol=1e-10)


def test_a_wedge_that_locks_is_refused_with_its_place() -> None:
    """From mu = cot(slope) on no force drives it; below, the force grows without bound."""
    limit = 1 / tan(radians(50.0))
    near = eq.analyze(wedge(radians(50.0), 0.999 * limit), ANGLES)
    assert np.max(np.abs(near.forces.drive_torque)) > 100 * 100.0 * 0.03
    with refusals.refused(LockError, joints="joints.shoe on yoke", share=0.8) as caught:
        eq.analyze(wedge(radians(50.0), 1.25 * limit), ANGLES)
    assert "angle" in caught.value.note.values


def test_a_locked_machine_is_reported_in_a_sentence(tmp_path: Any) -> None:
    file = tmp_path / "wedge.toml"
    eq.save(wedge(radians(50.0), 2.0), file)
    for command in ("analyze", "report"):
        done = equipoise(
            command, str(file), *(["-o", str(tmp_path / "r.html")] * (command == "report"))
        )
        assert "locks the machine" in refused(done)


# -- laws ------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("speed", "acceleration"), [(None, None), (-7.0, 0.0), (5.0, 60.0)])
def test_power_fed_in_is_the_rate_of_energy_and_what_friction_takes(
    speed: float | None, acceleration: float | None
) -> None:
    forces = eq.analyze(WORN, ANGLES, speed, acceleration).forces
    rows = [*kinetic_power(forces), *-gravity_power(forces), *-load_power(forces)]
    rows = [*rows, *-spring_power(forces), forces.friction_loss]
    size = np.max(np.sum(np.abs(rows), axis=0))
    np.testing.assert_allclose(forces.power, np.sum(rows, axis=0), atol=1e-12 * size)
    assert all(np.all(value.loss >= 0) for value in forces.frictions.values())
    assert np.all(forces.friction_loss > 0)


def test_friction_changes_neither_shaking_nor_the_load_on_the_frame() -> None:
    worn, plain = (eq.analyze(item, ANGLES).forces for item in (WORN, ENGINE))
    for name in ("shaking_force", "frame_force"):
        got, want = getattr(worn, name).value, getattr(plain, name).value
        np.testing.assert_allclose(got, want, atol=1e-11 * np.max(np.abs(want)))
    for name in ("shaking_moment", "frame_moment"):
        got, want = getattr(worn, name), getattr(plain, name)
        np.testing.assert_allclose(got, want, atol=1e-11 * max(np.max(np.abs(want)), 1.0))


def test_causes_and_links_add_up_with_friction_among_them() -> None:
    forces = eq.analyze(WORN, ANGLES).forces
    for name, whole in {
        "drive_torque": forces.drive_torque,
        "joints.piston on frame": forces.joints["piston on frame"].value,
        "joints.A": forces.joints["A"].value,
        "frame_moment": forces.frame_moment,
    }.items():
        causes, links = forces.split.by_cause(name), forces.split.by_link(name)
        size = np.max(np.abs(whole))
        assert [*causes][-1] == "friction"
        np.testing.assert_allclose(sum(causes.values()), whole, atol=1e-11 * size)
        np.testing.assert_allclose(sum(links.values()), whole, atol=1e-11 * size)
    plain = eq.analyze(ENGINE, ANGLES).forces.split.by_cause("drive_torque")
    assert "friction" not in plain
    np.testing.assert_allclose(forces.split.by_cause("drive_torque")["load"], plain["load"])


def test_means_are_taken_piece_by_piece_between_reversals() -> None:
    """Constant drag: the work of a turn is drag times twice the stroke, at any number of angles."""
    drag = JointProperties("joints.piston on frame", drag_force=10.0)
    machine = replace(weightless(ENGINE, loads=()), joints=(drag,))
    assert len(jumps_of(assemble(machine))) == 2
    stroke = eq.analyze(machine).strokes["piston on frame"].stroke
    for angles in (24, 360):
        analysis = eq.analyze(machine, angles)
        loss = analysis.summary["friction_loss"].mean
        assert loss * 2 * pi / machine.drive.speed == pytest.approx(2 * stroke * 10.0, rel=1e-9)
        assert analysis.summary["drive_torque"].mean == pytest.approx(stroke * 10.0 / pi, rel=1e-9)


def test_losses_efficiency_and_wear_of_a_cycle() -> None:
    slope, mu = radians(30.0), 0.1
    machine = wedge(slope, mu)
    losses = eq.analyze(machine).losses
    assert losses is not None and losses.efficiency is None  # a weight comes back
    assert losses.drive == pytest.approx(losses.loss, rel=1e-9)
    phi, stroke = atan(mu), 0.06
    up, down = (100.0 * tan(slope + sign * phi) * stroke for sign in (1, -1))
    turns = machine.drive.speed / (2 * pi)
    assert losses.loss == pytest.approx((up - down) * turns, rel=1e-9)
    # what wears: normal force times way along the slope, up and down
    press = 100.0 / np.cos(slope) / np.array([1 - mu * tan(slope), 1 + mu * tan(slope)])
    way = stroke / np.cos(slope)
    assert losses.joints["shoe on yoke"].wear_work == pytest.approx(np.sum(press) * way, rel=1e-6)
    gas = eq.analyze(WORN).losses
    assert gas is not None and gas.efficiency == pytest.approx(-gas.drive / gas.loads)
    assert gas.drive + gas.loads == pytest.approx(gas.loss, rel=1e-9)


def test_at_rest_nothing_rubs() -> None:
    forces = eq.analyze(WORN, ANGLES, 0.0, 0.0).forces
    assert not np.any(forces.friction_loss)
    plain = eq.analyze(ENGINE, ANGLES, 0.0, 0.0).forces
    np.testing.assert_allclose(forces.drive_torque, plain.drive_torque)


def test_flanks_bear_as_friction_loads_them() -> None:
    """A geared counterweight driven against a strong drag on its gear: its teeth never change."""
    machine = replace(eq.load("geared-counterweight"), balance=None)
    names = [name for name, first in assemble(machine).named_reactions if first.kind == "pin"]
    last = names[-1]
    size = np.max(np.abs(eq.analyze(machine).forces.drive_torque))
    drag = JointProperties(f"joints.{last}", drag_torque=100 * size)
    forces = eq.analyze(replace(machine, joints=(drag,)), ANGLES).forces
    rows = [
        *kinetic_power(forces),
        *-gravity_power(forces),
        *-load_power(forces),
        forces.friction_loss,
    ]
    np.testing.assert_allclose(forces.power, np.sum(rows, axis=0),
                               atol=1e-11 * np.max(np.abs(forces.power)))  # fmt: skip


# -- keys ------------------------------------------------------------------------------------------


def test_a_file_reports_friction_and_check_says_it(tmp_path: Any) -> None:
    text = survives(WORN)
    assert 'friction = 0.1\nguide_length = "60 mm"\ndamping = "2 N s/m"\n' in text
    file = tmp_path / "worn.toml"
    file.write_text(text.replace("friction = 0.1\nguide", "friction = 0.7\nguide"))
    out = equipoise("check", str(file)).out
    assert "joints.piston on frame, friction 0.7000 (is it meant?" in out.replace("\n  ", " ")
    assert "drag 10.00 N" in out


WRONG: list[tuple[dict[str, Any], dict[str, Any]]] = [
    ({"joint": "joints.C", "friction": 0.1}, {"place": "joints[1].radius"}),
    ({"joint": "joints.C", "friction": -0.1}, {"place": "joints[1].friction", "text": -0.1}),
    (
        {"joint": "joints.C", "radius": 0.01, "guide_length": 0.1},
        {"place": "joints[1].guide_length"},
    ),
    (
        {"joint": "joints.C", "radius": 0.01, "friction": 0.1, "guide_length": 0.1},
        {"place": "joints[1].guide_length", "joint": "joints.C"},
    ),
    ({"joint": "joints.C", "damping": 1.0}, {"place": "joints[1].damping", "joint": "joints.C"}),
    (
        {"joint": "joints.piston on frame", "drag_torque": 1.0},
        {"place": "joints[1].drag_torque", "joint": "joints.piston on frame"},
    ),
    (
        {"joint": "joints.piston on frame", "friction": 0.1, "static_friction": 0.2},
        {"place": "joints[1].stribeck_speed"},
    ),
    (
        {
            "joint": "joints.piston on frame",
            "friction": 0.3,
            "static_friction": 0.2,
            "stribeck_speed": 0.1,
        },
        {"place": "joints[1].static_friction", "static": 0.2, "friction": 0.3},
    ),
]


@pytest.mark.parametrize(("given", "expected"), WRONG)
def test_what_is_no_friction_of_this_joint_is_refused(
    given: dict[str, Any], expected: dict[str, Any]
) -> None:
    with refusals.refused(ModelError, **expected):
        assemble(replace(ENGINE, joints=(JointProperties(**given),)))


def straight_slot() -> eq.Machine:
    """A slider-crank whose rod ends in a straight slot of the frame."""
    crank = eq.Link({"A": (0.0, 0.0), "B": (0.06, 0.0)}, 1.0, (0.01, 0.0), 0.004)
    rod = eq.Link({"B": (0.0, 0.0), "C": (0.2, 0.0)}, 0.6, (0.09, 0.01), 0.003)
    return eq.Machine(
        "slot", eq.Drive("crank", 20.0), {"A": (0.0, 0.0), "S": (0.2, -0.01)},
        {"crank": crank, "rod": rod}, position=Position(0.0, {"C": (0.2599, -0.01)}),
        curved_slots=(CurvedSlot("rod", "C", "frame", "S", ((-0.2, 0.0), (0.2, 0.0))),),
        gravity=(0.0, -9.81), loads=(Load("rod", "C", (-30.0, 12.0)),),
    )  # fmt: skip


def on_a_block(machine: eq.Machine) -> eq.Machine:
    """The machine with a block without mass that slides instead of the pin in its slot."""
    block = eq.Link({"C": (0.0, 0.0)}, 0.0, (0.0, 0.0), 0.0)
    guide = eq.mechanism.Slider("block", "C", "frame", "S", 0.0)
    return replace(machine, links={**machine.links, "block": block}, curved_slots=(),
                   sliders=(guide,), assembly={"C": "forward"}, position=None)  # fmt: skip


SLIDING = {"friction": 0.15, "damping": 3.0, "drag_force": 2.0}


@pytest.mark.parametrize(("speed", "acceleration"), [(20.0, 0.0), (-7.0, 90.0)])
def test_a_pin_in_a_straight_slot_rubs_as_a_block_on_a_guide(
    speed: float, acceleration: float
) -> None:
    machine = straight_slot()
    slotted = replace(machine, joints=(JointProperties("joints.C in frame", **SLIDING),))
    guided = replace(
        on_a_block(machine), joints=(JointProperties("joints.block on frame", **SLIDING),)
    )
    first, other = (eq.analyze(item, ANGLES, speed, acceleration).forces
                  for item in (slotted, guided))  # fmt: skip
    plain = eq.analyze(machine, ANGLES, speed, acceleration).forces
    np.testing.assert_allclose(first.drive_torque, other.drive_torque, rtol=1e-9, atol=1e-10)
    np.testing.assert_allclose(first.friction_loss, other.friction_loss, rtol=1e-9, atol=1e-10)
    assert np.max(np.abs(first.drive_torque - plain.drive_torque)) > 0.1


@pytest.mark.parametrize("name", ["flap-folder", "baler-pickup"])
def test_power_of_pins_in_circular_and_curved_slots(name: str) -> None:
    """Power balance, with the friction and the sliding speed that the outputs say."""
    bare = replace(eq.load(name), balance=None)
    joints = [JointProperties(f"joints.{slot}", **SLIDING) for slot in bare.pins_in_slots]
    analysis = eq.analyze(replace(bare, joints=tuple(joints)), ANGLES)
    forces = analysis.forces
    rows = [*kinetic_power(forces), *-gravity_power(forces), *-load_power(forces)]
    rows = [*rows, *-spring_power(forces), forces.friction_loss]
    size = np.max(np.sum(np.abs(rows), axis=0))
    np.testing.assert_allclose(forces.power, np.sum(rows, axis=0), atol=1e-11 * size)
    for slot in bare.pins_in_slots:
        table = "circular_slots" if bare.circular_slots else "curved_slots"
        speed = analysis.motion.element_values(table, 0)["speed"]
        pressing = np.abs(forces.joints[slot].normal)
        lost = (0.15 * pressing + 2.0 + 3.0 * np.abs(speed)) * np.abs(speed)
        np.testing.assert_allclose(forces.frictions[slot].loss, lost, atol=1e-9 * np.max(lost))


def test_a_run_slows_down_as_pins_in_slots_rub() -> None:
    """Inverse dynamics at an instant of the run asks for no torque."""
    joints = (JointProperties("joints.C in frame", **SLIDING),)
    machine = replace(straight_slot(), joints=joints, loads=())
    run = eq.run(machine, speed=20.0, turns=2)
    assert run.energy_error < 1e-9
    for angle, speed in zip(run.crank_angle[5:200:40], run.crank_speed[5:200:40], strict=True):
        inertia, slope, torques = run.equation.at(float(angle), float(speed), 0.0, 1.0)
        rate = (float(np.sum(torques)) - slope * speed**2 / 2) / inertia
        forces = eq.analyze(machine, [angle], float(speed), rate).forces
        assert abs(forces.drive_torque[0]) < 1e-9 * inertia * abs(rate)


@pytest.mark.parametrize(
    ("given", "expected"),
    [
        (
            {"torsional_damping": 0.1},
            {"place": "joints[1].torsional_damping", "joint": "joints.C in frame"},
        ),
        ({"drag_torque": 0.1}, {"place": "joints[1].drag_torque", "joint": "joints.C in frame"}),
        (
            {"friction": 0.1, "guide_length": 0.1},
            {"place": "joints[1].guide_length", "joint": "joints.C in frame"},
        ),
    ],
)
def test_keys_that_a_pin_in_a_slot_lacks(given: dict[str, float], expected: dict[str, Any]) -> None:
    joint = JointProperties("joints.C in frame", **given)
    with refusals.refused(ModelError, **expected):
        assemble(replace(straight_slot(), joints=(joint,)))


# -- what is not linear any more -------------------------------------------------------------------


def test_balancing_says_what_friction_makes_nonlinear() -> None:
    weight = AddedMass("crank", "A", Weight("any", 0.05, at_most=0.2))
    plan = Balance(masses=(weight,), objectives=(Objective("joints.A"),))
    worn, plain = (eq.balance(item, plan) for item in (WORN, ENGINE))
    # friction differs less with the masses than by itself
    assert worn.machine.links["crank"].mass == pytest.approx(
        plain.machine.links["crank"].mass, rel=1e-2
    )
    assert notes_by(_of_friction, worn.notes, "tolerance", outputs="joints.A")
    assert not notes_by(_of_friction, plain.notes, "tolerance", "outputs")
    assert not notes_by(_of_friction, plain.notes, "change", "outputs")
    before, after = worn.objectives["rms of joints.A"]
    assert before == pytest.approx(eq.analyze(WORN).summary["joints.A"].rms, rel=1e-5)
    assert after == pytest.approx(eq.analyze(worn.machine).summary["joints.A"].rms, rel=1e-5)


def test_studies_compute_what_friction_changes_machine_by_machine() -> None:
    from equipoise.codegen.emit import can_compute
    from equipoise.codegen.figures import Figure
    from equipoise.codegen.gram import can_use

    paths = ["links.crank.mass"]
    for machine, fast in ((ENGINE, True), (WORN, False)):
        torque = Figure("drive_torque", "rms")
        assert can_compute(machine, paths, torque) == fast
        assert can_use(machine, paths, [torque]) == fast
        assert can_compute(machine, paths, Figure("shaking_force", "rms"))


@pytest.mark.exhaustive(but=["py", "xml", "mo", "html"])
@pytest.mark.parametrize("ending", ["fmu", "html", "mo", "xml", "py"])
def test_formats_say_that_they_leave_friction_out(ending: str, tmp_path: Any) -> None:
    left_out = eq.export(WORN, tmp_path / f"worn.{ending}")
    assert any(sentence.startswith("friction in joints") for sentence in left_out)
    assert not any("friction" in item for item in eq.export(ENGINE, tmp_path / f"p.{ending}"))


def test_the_pump_of_the_examples_loses_what_is_reckoned_by_hand() -> None:
    """Of its packing, 45 N over 26 mm to and fro 15 times a second, and of what it delivers."""
    machine = eq.load("plunger-pump")
    losses = eq.analyze(machine).losses
    assert losses is not None
    assert losses.loads == pytest.approx(-1470 * 0.026 * 15, rel=1e-9)
    assert losses.drive == pytest.approx(losses.loss - losses.loads, rel=1e-9)
    packing = replace(machine, joints=(
        JointProperties("joints.plunger on frame", drag_force=45.0),
    ))  # fmt: skip
    alone = eq.analyze(packing).losses
    assert alone is not None and alone.loss == pytest.approx(45 * 2 * 0.026 * 15, rel=1e-9)
    # its guide rubs by the force across: what remains is less than that of the rod's full slope
    guide = losses.joints["plunger on frame"].loss - alone.loss
    assert 0 < guide < 0.06 * 1500 * (0.013 / 0.065) * 2 * 0.026 * 15
    assert losses.efficiency == pytest.approx(573.3 / 666.7, abs=2e-4)


# -- ways of computing it --------------------------------------------------------------------------


def summary(machine: eq.Machine) -> np.ndarray[Any, Any]:
    """Mean, RMS and extremes of all outputs, each by the largest of them."""
    rows = [
        (value.mean, value.rms, value.max, value.min)
        for value in eq.analyze(machine).summary.values()
    ]
    values = np.array(rows)
    return values / np.maximum(np.max(np.abs(values), axis=1, keepdims=True), 1e-30)


def test_newtons_method_finds_what_the_law_put_into_itself_does(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Each misses the law by 1e-13 of the largest friction at most."""
    usual, inserted, good = summary(WORN), friction._inserted, []

    def never(*given: Any) -> Any:
        efforts, held = inserted(*given)
        good.append(np.all(held))
        return 0 * efforts, np.zeros_like(held)

    monkeypatch.setattr(friction, "_inserted", never)
    np.testing.assert_allclose(summary(WORN), usual, rtol=0, atol=1e-11)
    assert good == [True]  # so that the figures before were not of Newton's method


def test_what_is_kept_with_a_pose_serves_other_masses_speeds_and_rows() -> None:
    twin = replace(WORN, rows=(Row(), Row(phase=1.0)))
    summary(WORN), summary(twin)
    for machine in (WORN, twin):
        for path, number in (("links.rod.mass", 3.0), ("drive.speed", -20.0)):
            other = machine.with_number(path, number)
            fresh = replace(other)  # without what is kept with the linkage
            assert np.array_equal(summary(other), summary(fresh))
    assert np.array_equal(summary(WORN.with_rows(twin.rows)), summary(twin))
