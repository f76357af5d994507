"""Signs of machines, held to the motion: where they are, what they move with, how they look."""

from __future__ import annotations

import numpy as np
import pytest

import equipoise as eq
from equipoise.figures.animation import laid_out
from equipoise.mechanism import Body, Hole
from equipoise.mechanism.formulas import kernels
from equipoise.symbols.looks import DARK, LIGHT, LOOKS
from equipoise.symbols.pieces import Piece, pieces
from equipoise.symbols.scene import Scene, clear_angle
from equipoise.symbols.shapes import Shape, hull

NAMES = sorted(eq.examples("linkage"))
COUNT = 48


def moved(name: str) -> tuple[eq.Machine, eq.mechanism.Motion, Scene]:
    machine = eq.load(name)
    motion = eq.move(machine, COUNT)
    return machine, motion, Scene.of(motion)


def scene_of(machine: eq.Machine | str) -> Scene:
    machine = eq.load(machine) if isinstance(machine, str) else machine
    return Scene.of(eq.move(machine, COUNT))


# -- what there is to draw -------------------------------------------------------------------------


@pytest.mark.parametrize("name", NAMES)
def test_links_keep_their_lengths_and_everything_is_in_the_box(name):
    machine, _, scene = moved(name)
    low, high = scene.box
    for body in scene.bodies:
        own = machine.links[body.name].points
        for point in body.points:
            for other in body.points:
                apart = abs(complex(*own[point]) - complex(*own[other]))
                size = abs(scene.places[point] - scene.places[other])
                np.testing.assert_allclose(size, apart, rtol=0, atol=1e-12)
    for place in (*scene.places.values(), *scene.mass_centers.values()):
        assert np.all((low.real <= place.real) & (place.real <= high.real))
        assert np.all((low.imag <= place.imag) & (place.imag <= high.imag))


@pytest.mark.parametrize("name", NAMES)
def test_outlines_hold_all_points_of_a_link(name):
    machine, _, scene = moved(name)
    for body in scene.bodies:
        around = [complex(*machine.links[body.name].points[point]) for point in body.outline]
        for place in machine.links[body.name].points.values():
            for item, other in zip(around, [*around[1:], around[0]], strict=True):
                if len(around) > 2:
                    assert kernels.cross(other - item, complex(*place) - item) >= -1e-12


@pytest.mark.parametrize("name", ["geared-counterweight", "planetary-planting-arm"])
def test_pitch_circles_touch_and_roll(name):
    machine, motion, scene = moved(name)
    pairs = zip(scene.wheels[::2], scene.wheels[1::2], strict=True)
    for gear, (driver, driven) in zip(machine.gears, pairs, strict=True):
        first, other = scene.places[driver.center], scene.places[driven.center]
        if gear.speed_ratio < 0:
            np.testing.assert_allclose(abs(first - other), driver.radius + driven.radius)
            touch = first + (other - first) * driver.radius / (driver.radius + driven.radius)
        else:
            np.testing.assert_allclose(abs(first - other), abs(driver.radius - driven.radius))
            touch = first + (other - first) * driver.radius / (driver.radius - driven.radius)
        for axis in (np.real, np.imag):
            speeds = [
                axis(
                    motion.points[wheel.center].velocity
                    + 1j * spin(motion, wheel.link) * (touch - scene.places[wheel.center])
                )
                for wheel in (driver, driven)
            ]
            np.testing.assert_allclose(speeds[0], speeds[1], atol=1e-12)


def test_pitch_curves_roll_without_gap_or_overlap():
    """Each corner of one curve is outside of the other, and one is next to it."""
    _, motion, scene = moved("elliptic-quick-return")
    driver, driven = scene.wheels
    for k in range(0, len(scene.crank_angle), 7):
        first, other = (
            scene.places[wheel.center][k]
            + wheel.curve * np.exp(1j * motion.links[wheel.link].angle[k])
            for wheel in (driver, driven)
        )
        around = other - scene.places[driven.center][k]
        arms = first - scene.places[driven.center][k]
        order = np.argsort(np.angle(around))
        edge = np.interp(
            np.angle(arms), np.angle(around)[order], np.abs(around)[order], period=2 * np.pi
        )
        apart = (np.abs(arms) - edge) / driven.radius
        assert -1e-3 < apart.min() < 1e-3


def spin(motion, link):
    return 0.0 if link == "frame" else motion.links[link].angular_velocity


def test_springs_and_frame_are_named():
    machine, _, scene = moved("spring-balanced-crank")
    assert scene.springs == tuple((s.point, s.to) for s in machine.springs) != ()
    assert scene.frame == tuple(machine.frame)
    assert all(np.ptp(abs(scene.places[name])) == 0 for name in scene.frame)


def test_hull_leaves_out_what_lies_inside():
    square = np.array([0, 1, 1 + 1j, 1j, 0.5 + 0.5j, 0.5, 1j])
    assert list(hull(square)) == [0, 1, 1 + 1j, 1j]
    assert list(hull(np.array([1j, 0, 0.5j]))) == [0, 1j]
    assert list(hull(np.array([0, 0.5 + 0.5j, 1 + 1j]))) == [0, 1 + 1j]
    assert list(hull(np.array([2.0, 2.0]))) == [2]


# -- signs -----------------------------------------------------------------------------------------


def placed(scene: Scene, piece: Piece, shape: Shape, offsets: float = 0.0) -> np.ndarray:
    """Corners of a shape at every crank angle, (corners, N), m; units are so long."""
    corners = shape.at(1.0, offsets)[:, None]
    track = piece.track(scene)
    if track is None:
        return np.repeat(corners, len(scene.crank_angle), axis=1)
    stretched = corners.real * track.stretch + 1j * corners.imag
    return track.place + stretched * np.exp(1j * track.angle)


def of_role(scene: Scene, *roles: str) -> list[tuple[Piece, Shape, np.ndarray]]:
    return [
        (piece, shape, placed(scene, piece, shape))
        for piece in pieces(scene)
        for shape in piece.shapes
        if shape.role in roles
    ]


def near(result: list[np.ndarray], wanted: np.ndarray) -> float:
    return min(float(np.max(np.abs(item - wanted))) for item in result)


@pytest.mark.parametrize("name", NAMES)
def test_links_and_pins_are_where_the_motion_has_them(name: str) -> None:
    scene = scene_of(name)
    size = abs(scene.linkage_box[1] - scene.linkage_box[0])
    corners = [corner for *_, line in of_role(scene, "body") for corner in line]
    for body in scene.bodies:
        for point in body.outline if len(body.outline) > 1 else ():
            assert near(corners, scene.places[point]) < 1e-9 * size
    signs = [line[0] for *_, line in of_role(scene, "pin", "dot")]
    for point, place in scene.places.items():
        assert near(signs, place) < 1e-9 * size, point
    stands = of_role(scene, "stand")
    still = [line[0, 0] for piece, _, line in stands if piece.layer == "stands"]
    assert still == pytest.approx([complex(scene.places[name][0]) for name in scene.standing])


@pytest.mark.parametrize("name", NAMES)
def test_every_role_has_a_look_in_colors_that_there_are(name: str) -> None:
    for piece in pieces(scene_of(name)):
        for shape in piece.shapes:
            look = LOOKS[shape.role]
            assert {look.fill, look.line} - {None} <= LIGHT.keys() == DARK.keys()
            assert len(shape.places) == len(shape.offsets)
            assert np.all(np.isfinite(shape.at(1.0, 1.0)))


@pytest.mark.parametrize("name", NAMES)
def test_small_links_lie_on_large_ones(name: str) -> None:
    scene = scene_of(name)
    areas = []
    slotted = {guide.on for guide in scene.guides}
    for piece, _, line in of_role(scene, "body"):
        if piece.link not in slotted:
            corners = line[:, 0]
            area = abs(np.sum((np.conj(corners) * np.roll(corners, -1)).imag))
            areas.append(round(float(area), 9))
    assert areas == sorted(areas, reverse=True)


BODIES = (
    Body("plate", corners=("B", "C", (0.02, 0.05)), mass=0.1, holes=[Hole((0.03, 0.02), 0.005)]),
    Body("ring", at="C", radius=0.03, inner_radius=0.01, mass=0.1),
    Body("bar", between=("B", "C"), outer_diameter=0.012, overhang=0.01, mass=0.1),
    Body("bar", between=("B", "C"), mass=0.1),
)


def test_bodies_are_seen_to_scale_and_move_with_their_link() -> None:
    machine = eq.load("yamashita-1").with_link("coupler", bodies=BODIES)
    scene = scene_of(machine)
    turn = np.exp(1j * scene.angles["coupler"])
    start, end = scene.places["B"], scene.places["C"]
    drawn = of_role(scene, "solid", "opening")
    assert {piece.link for piece, *_ in drawn} == {"coupler"}
    plate, hole, ring, bore, bar = (line for *_, line in drawn)
    for corner, place in zip(plate, (start, end, start + (0.02 + 0.05j) * turn), strict=True):
        assert np.max(abs(corner - place)) < 1e-12
    assert np.max(abs(hole[0] - start - (0.03 + 0.02j) * turn)) < 1e-12
    assert np.max(abs(ring[0] - end)) < 1e-12 and np.max(abs(bore[0] - end)) < 1e-12
    way = (end - start) / abs(end - start)
    wanted = [start - 0.01 * way, end + 0.01 * way]
    middles = [(bar[0] + bar[3]) / 2, (bar[1] + bar[2]) / 2]
    assert all(np.max(abs(z - at)) < 1e-12 for z, at in zip(middles, wanted, strict=True))
    assert np.max(abs(abs(bar[0] - bar[3]) - 0.012)) < 1e-12
    assert [shape.radius for _, shape, _ in drawn] == [0, 0.005, 0.03, 0.01, 0]
    low, high = scene.box
    for place in (*plate, *bar, ring[0] + 0.03, ring[0] - 0.03, ring[0] + 0.03j, ring[0] - 0.03j):
        assert np.all((low.real <= place.real + 1e-12) & (place.real <= high.real + 1e-12))
        assert np.all((low.imag <= place.imag + 1e-12) & (place.imag <= high.imag + 1e-12))
    assert not of_role(scene, "tie")
    for piece in pieces(scene):
        assert all(shape.role in LOOKS for shape in piece.shapes)


def test_mass_centers_have_their_sign_in_their_links() -> None:
    scene = scene_of("watt-six-bar")
    signs = [line[0] for *_, line in of_role(scene, "mass")]
    for place in scene.mass_centers.values():
        assert near(signs, place) < 1e-12


def test_gears_touch_and_turn_with_their_links() -> None:
    scene = scene_of("planetary-planting-arm")
    wheels = of_role(scene, "wheel")
    assert len({(p.hold, s.radius) for p, s, _ in wheels}) == len(wheels) == 3
    for wheel in scene.wheels:
        assert any(
            np.allclose(line[0], scene.places[wheel.center]) and shape.radius == wheel.radius
            for _, shape, line in wheels
        )


@pytest.mark.parametrize("role", ["spring", "planned"])
def test_springs_are_zigzags_between_their_ends(role: str) -> None:
    scene = scene_of("spring-balanced-crank" if role == "spring" else "balance-spring")
    ((_, shape, line),) = of_role(scene, role)
    ((first, other),) = scene.springs if role == "spring" else scene.planned
    np.testing.assert_allclose(line[0], scene.places[first], atol=1e-12)
    np.testing.assert_allclose(line[-1], scene.places[other], atol=1e-12)
    assert np.ptp(shape.offsets.imag) > 10 and len(shape.places) >= 14


@pytest.mark.parametrize("name", ["quick-return", "scotch-yoke", "slider-crank-engine"])
def test_blocks_keep_to_their_lines(name: str) -> None:
    """A line stands still in the axes of its body, as long as the block's way on it."""
    machine, _, scene = moved(name)
    for slider, guide in zip(machine.sliders, scene.guides, strict=True):
        assert (guide.name, guide.point) == (slider.name, slider.point)
        away = scene.places[slider.point] - scene.places[slider.through]
        np.testing.assert_allclose(kernels.cross(guide.way, away), 0, atol=1e-12)
        place = scene.places[guide.point]
        ends = place - guide.way * guide.behind, place + guide.way * guide.ahead
        if guide.on != "frame":
            origin = scene.places[next(iter(machine.links[guide.on].points))]
            turned = np.exp(-1j * scene.angles[guide.on])
            ends = tuple((end - origin) * turned for end in ends)
        for end in ends:
            assert np.ptp(end.real) < 1e-12 > np.ptp(end.imag)
        for reach in (guide.behind, guide.ahead):
            assert np.min(reach) == pytest.approx(0, abs=1e-15)
    assert len(of_role(scene, "block")) == len(scene.guides)


@pytest.mark.parametrize("speed", [12.0, -12.0, 0.0])
def test_the_driver_shows_its_sense(speed: float) -> None:
    scene = scene_of(eq.load("yamashita-1").with_drive(speed=speed))
    result = of_role(scene, "driver")
    assert len(result) == bool(speed)
    for _, _, line in result:
        arms = line - scene.places[scene.drive.pivot]
        assert np.all(np.sign(np.diff(np.unwrap(np.angle(arms), axis=0), axis=0)) == np.sign(speed))


def test_the_field_is_drawn_with_its_surface_its_depth_and_the_tray() -> None:
    machine = eq.load("transplanter")
    scene = scene_of(machine)
    ((_, _, ground),) = of_role(scene, "soil")
    lowest = scene.places["P"].imag.min()
    assert ground[:, 0].imag.max() == pytest.approx(lowest + 0.04, abs=1e-3)
    assert ground[:, 0].imag.min() < lowest
    ((_, _, tray),) = of_role(scene, "tray")
    assert list(tray[:, 0]) == [complex(*end) for end in machine.planting.tray]
    assert not of_role(scene_of("yamashita-1"), "soil", "tray")


def test_the_support_is_drawn_with_what_holds_it() -> None:
    scene = scene_of("riding-transplanter")
    support = eq.load("riding-transplanter").support
    (outline,) = (line[:, 0] for *_, line in of_role(scene, "support"))
    assert len(outline) >= 3
    at = {complex(line[0, 0]) for *_, line in of_role(scene, "float", "foot")}
    assert {complex(*m.point[:2]) for m in support.mounts.values() if m.point} == at
    assert len(of_role(scene, "gauge")) == 1  # both ends lie on one line of sight
    assert not of_role(scene, "hatch") or scene.carrier is not None
    walking = scene_of("walking-transplanter")
    pivot = complex(*eq.load("walking-transplanter").support.pivot)
    assert near([line[0] for *_, line in of_role(walking, "stand")], np.full(COUNT, pivot)) < 1e-12


def test_a_picture_holds_what_is_near_and_keeps_the_linkage_large() -> None:
    near_by, far = scene_of("walking-transplanter"), scene_of("yamashita-rig")
    assert near_by.box[0].imag < -0.25  # its float
    assert far.box[0].real > -0.5  # its pivot is more than a meter away
    for scene in (near_by, far):
        spans = [
            max((e[1] - e[0]).real, (e[1] - e[0]).imag) for e in (scene.linkage_box, scene.box)
        ]
        assert spans[1] <= 2 * spans[0] * (1 + 1e-9)


def bars(scene: Scene) -> dict[tuple[str, str], np.ndarray]:
    """From each end of a bar to the other, at all crank angles."""
    ends = [body.outline for body in scene.bodies if len(body.outline) == 2]
    ways = {(a, b): scene.places[b] - scene.places[a] for a, b in ends}
    return ways | {(b, a): -way for (a, b), way in ways.items()}


@pytest.mark.parametrize("name", NAMES)
def test_the_angle_is_clear(name: str) -> None:
    """Bars that meet lie in no line, and none on its own stand, where that can be avoided."""
    scene = Scene.of(eq.move(eq.load(name), 360))
    k = clear_angle(scene)
    ways = bars(scene)
    for ends, way in ways.items():
        if ends[0] in scene.standing:
            leaning = abs(np.degrees(np.angle(way / scene.ground(ends[0]))))
            assert leaning[k] > min(28, 0.7 * leaning.max())
        for others, other in ways.items():
            if others[0] == ends[0] and others != ends:
                apart = abs(np.degrees(np.angle(way / other)))
                apart = np.minimum(apart, 180 - apart)
                assert apart[k] > min(20, 0.5 * apart.max())
    for guide in scene.guides:
        for ends, way in ways.items():
            apart = abs(np.degrees(np.angle(way / guide.way)))
            apart = np.minimum(apart, 180 - apart)
            assert ends[0] != guide.point or apart[k] > min(15, 0.3 * apart.max())


def test_what_hangs_is_held_from_above() -> None:
    sieve, spring = scene_of("sieve"), scene_of("balance-spring")
    assert [sieve.ground(name) for name in ("O", "L", "R")] == [-1j, 1j, 1j]
    assert [spring.ground(name) for name in ("A", "D", "S")] == [-1j, -1j, 1j]
    for name, place in (("O", 0), ("L", 0.42 + 0.33j), ("R", 1.02 + 0.33j)):
        (stand,) = (
            shape.offsets
            for _, shape, line in of_role(sieve, "stand")
            if abs(line[0, 0] - place) < 1e-9
        )
        assert np.sign(stand[1].imag) == sieve.ground(name).imag


def test_an_animation_begins_at_the_clear_angle() -> None:
    scene = Scene.of(eq.move(eq.load("exudyn-slider-crank"), 240))
    drawn = laid_out(scene, frames=40)
    k = clear_angle(scene)
    assert k == drawn.stage.chosen[0] and drawn.stage.times[0] == 0 and drawn.stage.times[-1] == 1
    crank = next(part for part in drawn.before if part.moves is not None)
    assert crank.moves.place[0] == pytest.approx(crank.moves.place[-1])


def test_a_spring_does_not_lie_on_its_link() -> None:
    scene = Scene.of(eq.move(eq.load("balance-spring"), 360))
    k = clear_angle(scene)
    arm = scene.places["E"][k] - scene.places["F"][k]
    spring = scene.places["S"][k] - scene.places["F"][k]
    assert abs(np.degrees(np.angle(spring / arm))) > 8
