"""Pins in slots along curves, against circles, lines, second routes and differences."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.interpolate import make_interp_spline

import equipoise as eq
from equipoise.codegen.batch import Batch
from equipoise.codegen.figures import Figure
from equipoise.errors import EquipoiseError, ModelError, MotionError, UsageError
from equipoise.mechanism import Machine
from equipoise.mechanism.assembly.linkage import assemble
from equipoise.mechanism.formulas.curves import curve_through
from equipoise.mechanism.parts.circular_slots import CircularSlot
from equipoise.mechanism.parts.curved_slots import CurvedSlot, CurveTable
from equipoise.mechanism.parts.joint_properties import JointProperties
from equipoise.mechanism.parts.machine import Link, Position
from equipoise.symbols.pieces import pieces
from equipoise.symbols.scene import Scene
from equipoise.web.design import Design
from equipoise.web.edits import solved
from equipoise.web.gallery import opened_file
from equipoise.web.session import Session
from equipoise.web.structure_edits import straight
from support import free_bodies, newton
from support.analyses import ANGLES
from support.chosen import few_together
from support.poses import from_motion
from support.refusals import refused, values_of
from surface.running import equipoise
from unit.mechanism.test_circular_slots import BASE, in_slot
from unit.schema.samples import survives
from unit.web.pages import ask, refusal, state

Points = tuple[tuple[float, float], ...]
CIRCULAR = in_slot(BASE)
RADIUS = CIRCULAR.circular_slots[0].radius


def circle(count: int, first: float = 0.0, last: float = 2 * np.pi) -> Points:
    """Points of a circle of the radius of the circular slot; the last is left out all round."""
    closed = last - first > 6
    places = RADIUS * np.exp(1j * np.linspace(first, last, count + closed)[:count])
    return tuple((float(place.real), float(place.imag)) for place in places)


def in_curve(points: Points, closed: bool = True, **more: Any) -> Machine:
    """The four-bar with a curved slot in the place of the circular one."""
    slot = CurvedSlot("coupler", "C", "frame", "D", points, closed=closed, **more)
    near = eq.move(CIRCULAR, [0.0]).points["C"].place[0]
    position = Position(0.0, {"C": (near.real + 0.003, near.imag)}, {})
    return replace(CIRCULAR, circular_slots=(), curved_slots=(slot,), assembly={},
                   position=position)  # fmt: skip


PLATE = Link({"D": (0.0, 0.0), "T": (0.1, 0.05)}, mass=0.8, center_of_mass=(0.05, 0.01),
             inertia=2e-3)  # fmt: skip
GROOVE = ((0.03, 0.012), (0.05, 0.02), (0.07, 0.018), (0.09, 0.0), (0.11, -0.012), (0.13, -0.008))


def on_plate() -> Machine:
    """A crank whose pin is in a curved slot of a plate that turns about a pin of the frame."""
    frame = {"A": (0.0, 0.0), "D": (0.08, -0.01)}
    crank = replace(BASE.links["crank"], points={"A": (0.0, 0.0), "B": (0.03, 0.0)})
    slot = CurvedSlot("crank", "B", "plate", "D", GROOVE, direction=0.2)
    return replace(BASE, frame=frame, links={"crank": crank, "plate": PLATE}, assembly={},
                   loads=(), curved_slots=(slot,),
                   position=Position(0.0, {}, {"plate": 2.8}))  # fmt: skip


@cache
def machine_named(name: str) -> Machine:
    """Machines whose slots are on the frame, on a link that is found, and all the way round."""
    match name:
        case "plate":
            return on_plate()
        case "egg":
            egg = tuple((x * 1.1 + 0.3 * x * x, y * 0.95) for x, y in circle(14))
            return in_curve(egg, direction=0.3)
        case "open":
            return in_curve(circle(9, 0.3, 2.6), closed=False)
        case _:
            return replace(eq.load(name), support=None, rows=(), balance=None)


EVERY = pytest.mark.parametrize("name", ["plate", "egg", "open", "baler-pickup"])


# -- the curve -------------------------------------------------------------------------------------


@pytest.mark.parametrize(("count", "closed"), [(7, False), (30, False), (5, True), (24, True)])
def test_the_curve_is_the_quintic_spline_over_its_chords(count: int, closed: bool) -> None:
    at = np.linspace(0, 2 * np.pi, count + closed)[:count]
    places = np.stack([np.cos(at) + 0.1 * at * (1 - closed), 0.6 * np.sin(at)], 1)
    curve = curve_through(tuple(map(tuple, places.tolist())), closed)
    rows = np.append(places, places[:1], 0) if closed else places
    kind = {"bc_type": "periodic"} if closed else {}
    spline = make_interp_spline(curve.knots, rows, 5, **kind)
    s = np.linspace(0, curve.knots[-1], 501)
    for order, got in enumerate(curve.at(s)):
        want = spline(s, order) @ [1, 1j]
        np.testing.assert_allclose(got, want, atol=1e-9 * np.max(np.abs(want)))
    chords = np.hypot(*np.diff(rows, axis=0).T)
    np.testing.assert_allclose(np.diff(curve.knots) / chords, curve.knots[-1] / np.sum(chords))
    np.testing.assert_allclose(curve.nearest(curve.at(s[5:-5])[0]), s[5:-5], atol=1e-9)


def test_its_length_and_its_sharpest_place_are_those_of_an_ellipse() -> None:
    at = np.linspace(0, 2 * np.pi, 65)[:-1]
    curve = curve_through(tuple(zip(0.2 * np.cos(at), 0.1 * np.sin(at), strict=True)), True)
    assert curve.length == pytest.approx(0.9688448220547676, rel=1e-7)  # 4 a E(1 - b^2 / a^2)
    radius, where = curve.sharpest
    assert radius == pytest.approx(0.05, rel=1e-3)  # b^2 / a
    assert min(where % (curve.length / 2), curve.length / 2 - where % (curve.length / 2)) < 1e-3
    s = np.linspace(0, 2 * np.pi, 20001)
    steps = np.abs(np.diff(curve.at(s)[0]))
    np.testing.assert_allclose(curve.distance(s[1:-1]), np.cumsum(steps)[:-1], atol=2e-7)


# -- other ways to have the same -------------------------------------------------------------------


def test_a_circle_of_points_converges_to_the_circular_slot() -> None:
    want = eq.analyze(CIRCULAR, 60)
    errors = []
    for count in (16, 32, 64):
        analysis = eq.analyze(in_curve(circle(count)), 60)
        torque = np.abs(analysis.forces.drive_torque - want.forces.drive_torque)
        errors.append(np.max(torque) / np.max(np.abs(want.forces.drive_torque)))
        push, pull = (item.forces.joints["C in frame"] for item in (analysis, want))
        assert (push.on, push.by) == ("coupler", "frame")
        # left of the way round is towards the centre
        np.testing.assert_allclose(push.normal, -pull.normal, atol=1e-3 * np.max(pull.size))
    assert errors[-1] < 1e-7
    orders = np.log2(np.divide(errors[:-1], errors[1:]))
    assert np.all(orders > 3.5)  # curvature of a quintic spline is good to the fourth


def test_points_on_a_line_are_a_slider() -> None:
    base = eq.load("slider-crank-engine")
    bare = replace(base, loads=(), rows=(), support=None, balance=None)
    rod = replace(bare.links["rod"], points={"B": (0.0, 0.0), "C": bare.links["rod"].points["C"]})
    block = Link({"C": (0.0, 0.0)}, mass=0.0, center_of_mass=(0.0, 0.0), inertia=0.0)
    (slider,) = bare.sliders
    links = {"crank": bare.links["crank"], "rod": rod}
    guide = replace(slider, link="block", point="C", direction=slider.direction)
    with_block = replace(bare, links={**links, "block": block}, sliders=(guide,))
    along = np.exp(1j * slider.direction)
    points = tuple((float(z.real), float(z.imag)) for z in along * np.linspace(-0.3, 0.3, 9))
    slot = CurvedSlot("rod", "C", "frame", guide.through, points)
    near = eq.move(with_block, [0.0]).points["C"].place[0]
    curved = replace(bare, links=links, sliders=(), assembly={}, curved_slots=(slot,),
                     position=Position(0.0, {"C": (near.real, near.imag)}, {}))  # fmt: skip
    want, actual = (eq.analyze(item, 60) for item in (with_block, curved))
    torque = want.forces.drive_torque
    np.testing.assert_allclose(actual.forces.drive_torque, torque, atol=1e-10 * np.ptp(torque))
    pushed, guided = actual.forces.joints[slot.name], want.forces.joints[guide.name]
    np.testing.assert_allclose(pushed.normal, guided.normal, atol=1e-10 * np.max(guided.size))
    travel = want.motion.sliders[guide.name]
    values = actual.motion.element_values("curved_slots", 0)
    np.testing.assert_allclose(np.ptp(values["distance"]), np.ptp(travel.travel), rtol=1e-10)
    np.testing.assert_allclose(values["speed"], travel.velocity, atol=1e-10)


@pytest.mark.exhaustive(but=["egg", "open"])
@EVERY
def test_motion_and_forces_by_a_second_route(name: str) -> None:
    """Newton's method on the distance from SciPy's spline, and all free bodies at once."""
    machine = machine_named(name)
    analysis = eq.analyze(machine, angles=ANGLES)
    poses = from_motion(machine, analysis.motion)
    traced = newton.trace(machine, ANGLES, newton.coordinates(poses, 0))
    for link_name, link in analysis.motion.links.items():
        off = np.exp(1j * (link.angle - traced.angle[link_name]))
        np.testing.assert_allclose(off, 1, atol=1e-8)
        rates = link.angular_velocity, link.angular_acceleration
        wanted = traced.omega[link_name], traced.alpha[link_name]
        for got, want in zip(rates, wanted, strict=True):
            size = np.max(np.abs(want)) + abs(machine.drive.speed)
            np.testing.assert_allclose(got, want, atol=1e-7 * size)
    free = free_bodies.solve(machine, poses)
    assert analysis.forces.joints.keys() == free.joints.keys()
    largest = max(np.max(joint.size) for joint in analysis.forces.joints.values())
    for joint_name, joint in analysis.forces.joints.items():
        reaction = free.joints[joint_name]
        force = reaction.force[:, 0] + 1j * reaction.force[:, 1]
        assert (joint.on, joint.by) == (reaction.on, reaction.by)
        np.testing.assert_allclose(joint.value, force, atol=1e-8 * largest)
    torque = free.drives[machine.drive.link]
    np.testing.assert_allclose(analysis.forces.drive_torque, torque, atol=1e-8 * np.ptp(torque))


@EVERY
def test_rates_are_those_of_positions(name: str) -> None:
    """Central differences of places, and of the arc length along the curve."""
    machine = machine_named(name)
    h, at = 1e-4, np.linspace(0.1, 6.2, 24)
    low, here, high = (eq.move(machine, at + step) for step in (-h, 0.0, h))
    for point, motion in here.points.items():
        before, now, after = (item.points[point].place for item in (low, here, high))
        first, second = (after - before) / (2 * h), (after - 2 * now + before) / h**2
        size = np.max(np.abs(motion.place_2)) + 0.01
        np.testing.assert_allclose(motion.place_1, first, atol=1e-5 * size)
        np.testing.assert_allclose(motion.place_2, second, atol=1e-4 * size)
    values = [item.element_values("curved_slots", 0) for item in (low, here, high)]
    way = values[2]["distance"] - values[0]["distance"]
    length = machine.curved_slots[0].curve.length
    way -= length * np.round(way / length)  # once round
    speed = way / (2 * h) * machine.drive.speed
    np.testing.assert_allclose(values[1]["speed"], speed, atol=1e-4 * np.max(np.abs(speed)))


@EVERY
def test_the_slot_does_no_work(name: str) -> None:
    """Power fed in, and of loads, is what kinetic energy and height take."""
    machine = replace(machine_named(name), loads=())
    analysis = eq.analyze(machine, angles=ANGLES)
    taken: Any = 0.0
    for link_name, link in machine.links.items():
        center, turning = analysis.motion.mass_centers[link_name], analysis.motion.links[link_name]
        pull = center.acceleration_vector - complex(*machine.gravity)
        taken = taken + link.mass * (np.conj(center.velocity) * pull).real
        taken = taken + link.inertia * turning.angular_velocity * turning.angular_acceleration
    np.testing.assert_allclose(analysis.forces.power, taken, atol=1e-9 * np.max(np.abs(taken)))
    slot = machine.curved_slots[0]
    push = analysis.forces.joints[slot.name]
    np.testing.assert_allclose(np.abs(push.normal), push.size, atol=1e-9 * np.max(push.size))


def test_forces_have_no_jumps_at_the_points() -> None:
    """Nor have their first two derivatives: steps of fourth differences shrink as h^3 or faster."""
    machine = replace(machine_named("baler-pickup"), loads=())
    largest = []
    for count in (1440, 2880):
        torque = eq.analyze(machine, count).forces.drive_torque
        largest.append(np.max(np.abs(np.diff(torque, 4))))
    assert largest[0] / largest[1] > 2**2.7  # a jump of the second derivative would give 2**2


def test_the_pin_goes_round_a_closed_slot() -> None:
    motion = eq.move(machine_named("baler-pickup"), 360)
    slot = motion.machine.curved_slots[0]
    assert motion.turns == 1
    speed = motion.element_values("curved_slots", 0)["speed"]
    way = np.sum(speed) * (2 * np.pi / 360) / motion.machine.drive.speed
    assert way == pytest.approx(slot.curve.length, rel=1e-9)


# -- groups ----------------------------------------------------------------------------------------


def test_circular_slots_in_groups_of_loops_are_links_without_mass() -> None:
    base = eq.load("class-three")
    light = replace(base.links["front-link"], mass=0.0, inertia=0.0, center_of_mass=(0.0, 0.0))
    bars = replace(base, links={**base.links, "front-link": light})
    links = {name: link for name, link in base.links.items() if name != "front-link"}
    slot = CircularSlot("plate", "P", "frame", "D", light.points["P"][0])
    slotted = replace(base, links=links, circular_slots=(slot,))
    want, actual = (eq.analyze(item, 60) for item in (bars, slotted))
    torque = want.forces.drive_torque
    np.testing.assert_allclose(actual.forces.drive_torque, torque, atol=1e-10 * np.ptp(torque))
    pushed, held = actual.forces.joints["P in frame"], want.forces.joints["P"]
    np.testing.assert_allclose(np.abs(pushed.value), held.size, atol=1e-9 * np.max(held.size))
    points = {name: place for name, place in base.position.points.items() if name in "BC"}
    lost = replace(slotted, position=replace(base.position, points=points))
    with refused(ModelError, "position", link="plate") as error:
        eq.move(lost)
    assert "P in frame" not in str(error.value)


def test_slots_have_planes() -> None:
    """A pin in a slot lies in the plane of its link, and bears couples as pins do."""
    machine = machine_named("egg")
    coupler = replace(machine.links["coupler"], plane=0.012)
    machine = replace(machine, links={**machine.links, "coupler": coupler})
    circular = replace(CIRCULAR, links=machine.links)
    assert machine.has_planes
    same = replace(in_curve(circle(64)), links=machine.links)
    want, actual = (eq.analyze(item, 36) for item in (circular, same))
    names = [output.name for output in want.outputs if output.declared.needs == "planes"]
    assert names
    for name in names:
        values = want.outputs[name].values
        size = np.max(np.abs(values)) + 1e-9
        np.testing.assert_allclose(actual.outputs[name].values, values, atol=1e-5 * size)


# -- limits ----------------------------------------------------------------------------------------


def test_the_ends_of_an_open_curve_are_a_limit(tmp_path: Path) -> None:
    machine = in_curve(circle(9, 1.4, 2.0), closed=False)
    with refused(ModelError, "curved_slots[1]", crank_angle=0.0):
        eq.analyze(machine)
    path = tmp_path / "mine.toml"
    eq.save(machine, path)
    for command in ("check", "analyze"):
        result = equipoise(command, path)
        assert result.status == 2
        assert "curved_slots[1]: the pin reaches the end of its slot at crank angle" in result.err


def test_a_pin_that_runs_out_of_an_open_curve_says_where() -> None:
    """The polynomial of the last piece goes on beyond it, up to where nothing is near."""
    machine = machine_named("baler-pickup")
    slot = replace(machine.curved_slots[0], closed=False)
    with refused(MotionError, crank_angle=337.472) as error:
        eq.analyze(replace(machine, curved_slots=(slot,)))
    (angle,) = (text for name, text in values_of(error.value.note) if name == "crank_angle")
    last = eq.move(machine, [np.radians(float(angle))]).points["R"].place[0]
    place, before = (complex(*place) for place in slot.places[:-3:-1])
    assert abs(last - place) < 0.02 * abs(place - before)


@pytest.mark.parametrize(("change", "expected"), [
    ({"link": "copler"}, {"place": "curved_slots[1].link", "name": "coupler", "given": "copler"}),
    ({"point": "Q"}, {"place": "curved_slots[1].point", "body": "coupler", "given": "Q"}),
    ({"on": "coupler", "origin": "B"}, {"place": "curved_slots[1].on", "link": "coupler"}),
    ({"origin": "Q"}, {"place": "curved_slots[1].origin", "body": "frame", "given": "Q"}),
    ({"points_given": ()}, {"place": "curved_slots[1]"}),
    ({"table": CurveTable((0.0,), (0.0,))}, {"place": "curved_slots[1]"}),
    ({"points_given": circle(3)}, {"place": "curved_slots[1].points", "count": 3, "fewest": 4}),
    ({"points_given": ((0.0, 0.0),), "closed": False}, {"count": 1, "fewest": 2}),
    ({"points_given": (*circle(8), circle(8)[-1])}, {"number": 8, "after": 9}),
    ({"points_given": (*circle(8), circle(8)[0])}, {"place": "curved_slots[1].points"}),
    ({"own_name": "B"}, {"place": "curved_slots[1].label", "name": "B"}),
])  # fmt: skip
def test_wrong_values_are_one_sentence(change: dict[str, Any], expected: dict[str, Any]) -> None:
    machine = in_curve(circle(12))
    with refused(ModelError, **expected):
        replace(machine, curved_slots=(replace(machine.curved_slots[0], **change),))


def test_a_pin_has_to_fit_into_the_sharpest_bend() -> None:
    egg = machine_named("egg")
    radius, _ = egg.curved_slots[0].curve.sharpest
    joint = JointProperties("joints.C in frame", radius=0.99 * radius)
    assert assemble(replace(egg, joints=(joint,))).pin_radii == {"C": 0.99 * radius}
    thick = replace(egg, joints=(replace(joint, radius=1.01 * radius),))
    with refused(ModelError, "joints[1].radius", at="0 mm", least="62.51 mm"):
        assemble(thick)


def test_the_position_is_asked_for_by_links_alone() -> None:
    with refused(ModelError, "position", names="coupler"):
        assemble(replace(in_curve(circle(12)), position=None))
    far = replace(in_curve(circle(12)), position=Position(0.0, {"C": (0.5, 0.5)}, {}))
    with pytest.raises(EquipoiseError) as error:
        eq.move(far)
    assert "C in frame" not in str(error.value)


# -- everywhere ------------------------------------------------------------------------------------


def test_a_file_has_all_that_it_is(tmp_path: Path) -> None:
    machine = in_curve(circle(6), own_name="track", direction=0.1)
    text = survives(machine)
    assert '[[curved_slots]]\nlink = "coupler"\npoint = "C"\non = "frame"\n' in text
    assert "closed = true" in text
    path = tmp_path / "mine.toml"
    eq.save(machine, path)
    reported = " ".join(equipoise("check", path).out.split())
    assert "curved slot: C of coupler in frame, closed curve through 6 points" in reported
    assert "coupler: by Newton's method on the loop equations; joints" in reported
    assert "track (pin in a slot)" in reported


def test_points_may_stand_in_a_table(tmp_path: Path) -> None:
    points = tuple((round(x, 4), round(y, 4)) for x, y in circle(12))
    machine = in_curve(points)
    x, y = zip(*points, strict=True)
    slot = replace(machine.curved_slots[0], points_given=(), table=CurveTable(x, y, "curve.csv"))
    path = tmp_path / "mine.toml"
    eq.save(replace(machine, curved_slots=(slot,)), path)
    (table,) = tmp_path.glob("*.csv")
    rows = table.read_text().splitlines()
    assert rows[0] == "x [mm],y [mm]"
    assert len(rows) == 13
    torque = eq.analyze(eq.load(path), 30).forces.drive_torque
    np.testing.assert_array_equal(torque, eq.analyze(machine, 30).forces.drive_torque)
    table.write_text("x [mm],y [mm]\n1,2\n3\n")
    with refused(EquipoiseError, "curved_slots[1].table", count="1", line="3"):
        eq.load(path)


@pytest.mark.usefixtures("compiled_loops")
@pytest.mark.parametrize(
    ("name", "paths"),
    few_together(
        [
            ("open", ["curved_slots[1].direction", "frame.points.D.x"]),
            ("baler-pickup", ["links.reel.points.B.x", "links.tine.points.R.y"]),
        ],
        [("open", ["curved_slots[1].direction", "frame.points.D.x"])],
    ),
)
def test_designs_vary_its_place_and_what_it_holds(name: str, paths: list[str]) -> None:
    machine = machine_named(name)
    slot = machine.curved_slots[0]
    names = ("drive_torque", f"joints.{slot.name}", "joints.B", "curved_slots.1.speed")
    batch = Batch(machine, paths, [Figure(item, "rms") for item in names], angles=60)
    if name == "open":
        sizes = [(0.0, machine.frame["D"][0]), (0.01, machine.frame["D"][0] + 1e-3), (1.5, 0.0)]
    else:
        sizes = [(0.105, -0.055), (0.104, -0.0545), (0.3, -0.055)]
    figures, reason = batch(np.array(sizes))
    assert reason.astype(bool).tolist() == [False, False, True]
    for row, (figure, other) in zip(figures, sizes[:2], strict=False):
        if name == "open":
            alone = machine.with_point("frame", "D", (other, machine.frame["D"][1]))
            alone = replace(alone, curved_slots=(replace(slot, direction=figure),))
        else:
            alone = machine.with_point("reel", "B", (figure, 0.0))
            alone = alone.with_point("tine", "R", (0.0, other))
        summary = eq.analyze(alone, 60).summary
        np.testing.assert_allclose(row, [summary[key].rms for key in names], rtol=1e-8)


def test_drawings_have_slots_with_their_ends() -> None:
    machine = in_curve(circle(9, -1.0, 2.9), closed=False, direction=0.2)
    (path,) = (shape for piece in pieces(Scene.of(eq.move(machine, 12))) for shape in piece.shapes
               if shape.role == "path")  # fmt: skip
    middle = path.places - complex(*BASE.frame["D"])
    np.testing.assert_allclose(np.abs(middle), RADIUS, rtol=1e-3)
    np.testing.assert_allclose([np.min(np.angle(middle)), np.max(np.angle(middle))], [-0.8, 3.1])
    motion = eq.move(machine_named("baler-pickup"), 12)
    rings = [shape for piece in pieces(Scene.of(motion)) for shape in piece.shapes
             if shape.role == "path-edge"]  # fmt: skip
    assert len(rings) == 2


def test_a_slot_is_as_wide_as_its_pin() -> None:
    """The roller of 14 mm lies between both edges, whatever the scale."""
    motion = eq.move(machine_named("baler-pickup"), 12)
    scene = Scene.of(motion)
    edges = [
        shape for piece in pieces(scene) for shape in piece.shapes if shape.role == "path-edge"
    ]
    (slot,) = motion.machine.curved_slots
    for edge, side in zip(edges, (1, -1), strict=True):
        middle, ahead, *_ = slot.curve.at(slot.curve.nearest(edge.places))
        aside = (edge.places - middle) / (1j * ahead / np.abs(ahead))
        np.testing.assert_allclose(aside, 0.014 * side, atol=1e-9)
        assert np.all(np.abs(edge.offsets) > 0)


def test_formats_without_it_say_so(tmp_path: Path) -> None:
    for ending in ("xml", "urdf", "mo", "py"):
        with refused(UsageError, special="curved slots"):
            eq.export(in_curve(circle(12)), tmp_path / f"mine.{ending}")
    assert not [*tmp_path.iterdir()]


def test_the_page_has_its_form_and_moves_it(tmp_path: Path) -> None:
    session = Session()
    eq.save(in_curve(circle(12)), tmp_path / "mine.toml")
    session.open(opened_file(tmp_path / "mine.toml"))
    content = state(ask(session, "ready")[1])
    assert content.field("curved_slots[1].direction")["value"] == 0
    before = content.place("C")
    points = [[f"{1.01e3 * x} mm", f"{1e3 * y} mm"] for x, y in circle(12)]
    values = {"link": "coupler", "point": "C", "on": "frame", "origin": "D", "points": points,
              "closed": True}  # fmt: skip
    reply = ask(session, "entry", place="curved_slots[1]", values=values, seq=1)
    assert np.max(np.abs(state(reply[0]).place("C") - before)) > 1e-4
    wrong = {**values, "points": points[:2]}
    reply = ask(session, "entry", place="curved_slots[1]", values=wrong, seq=2)
    assert "give 4 to 400" in refusal(reply)
    state(ask(session, "make", do="rename", what="point", name="D", to="M", at=0)[0])
    assert session.shown.design.machine.curved_slots[0].origin == "M"


def test_a_body_with_a_slot_keeps_its_axes() -> None:
    """The slot's direction counts from them, so that its points are not laid along a new x axis."""
    bare = replace(PLATE, mass=None, center_of_mass=None, inertia=None)
    machine = on_plate()
    machine = replace(machine, links={**machine.links, "plate": bare})
    sketch = solved(Design("mine", machine)).sketch(0)
    assert straight(sketch, ["plate"]).links["plate"].points == bare.points
    straightened = straight(replace(sketch, rest={**sketch.rest, "curved_slots": ()}), ["plate"])
    assert straightened.links["plate"].points["T"][1] == 0.0
