"""What there is to draw, held to what it stands for: rigid links, meshing gears, guides."""

from __future__ import annotations

import numpy as np
import pytest

import equipoise as eq
from equipoise.mechanism import kernels
from equipoise.symbols.scene import Scene, hull

NAMES = sorted(eq.examples("linkage"))


def scene_of(name: str, angles: int = 24) -> tuple[eq.Machine, eq.mechanism.Motion, Scene]:
    machine = eq.load(name)
    motion = eq.move(machine, angles)
    return machine, motion, Scene.of(motion)


@pytest.mark.parametrize("name", NAMES)
def test_links_keep_their_lengths_and_everything_is_in_the_box(name):
    machine, _, scene = scene_of(name)
    low, high = scene.box
    for body in scene.bodies:
        own = machine.links[body.name].points
        for one in body.points:
            for other in body.points:
                apart = abs(complex(*own[one]) - complex(*own[other]))
                found = abs(scene.places[one] - scene.places[other])
                np.testing.assert_allclose(found, apart, rtol=0, atol=1e-12)
    for place in (*scene.places.values(), *scene.mass_centers.values()):
        assert np.all((low.real <= place.real) & (place.real <= high.real))
        assert np.all((low.imag <= place.imag) & (place.imag <= high.imag))


@pytest.mark.parametrize("name", NAMES)
def test_outlines_hold_all_points_of_a_link(name):
    machine, _, scene = scene_of(name)
    for body in scene.bodies:
        around = [complex(*machine.links[body.name].points[point]) for point in body.outline]
        for place in machine.links[body.name].points.values():
            for one, other in zip(around, [*around[1:], around[0]], strict=True):
                if len(around) > 2:
                    assert kernels.cross(other - one, complex(*place) - one) >= -1e-12


@pytest.mark.parametrize("name", ["geared-counterweight", "planetary-planting-arm"])
def test_pitch_circles_touch_and_roll(name):
    machine, motion, scene = scene_of(name)
    pairs = zip(scene.wheels[::2], scene.wheels[1::2], strict=True)
    for gear, (driver, driven) in zip(machine.gears, pairs, strict=True):
        one, other = scene.places[driver.center], scene.places[driven.center]
        if gear.speed_ratio < 0:
            np.testing.assert_allclose(abs(one - other), driver.radius + driven.radius)
            touch = one + (other - one) * driver.radius / (driver.radius + driven.radius)
        else:
            np.testing.assert_allclose(abs(one - other), abs(driver.radius - driven.radius))
            touch = one + (other - one) * driver.radius / (driver.radius - driven.radius)
        for axis in (np.real, np.imag):
            speeds = [
                axis(
                    motion.points[wheel.center].velocity
                    + 1j * spin(motion, wheel.link) * (touch - scene.places[wheel.center])
                )
                for wheel in (driver, driven)
            ]
            np.testing.assert_allclose(speeds[0], speeds[1], atol=1e-12)


def spin(motion, link):
    return 0.0 if link == "frame" else motion.links[link].angular_velocity


@pytest.mark.parametrize("name", ["quick-return", "scotch-yoke", "slider-crank-engine"])
def test_blocks_stay_on_their_guides(name):
    machine, _, scene = scene_of(name)
    for slider, guide in zip(machine.sliders, scene.guides, strict=True):
        assert (guide.name, guide.point) == (slider.name, slider.point)
        away = scene.places[slider.point] - scene.places[slider.through]
        np.testing.assert_allclose(kernels.cross(guide.way, away), 0, atol=1e-12)


def test_springs_and_frame_are_named():
    machine, _, scene = scene_of("spring-balanced-crank")
    assert scene.springs == tuple((s.point, s.to) for s in machine.springs) != ()
    assert scene.frame == tuple(machine.frame)
    assert all(np.ptp(abs(scene.places[name])) == 0 for name in scene.frame)


def test_hull_leaves_out_what_lies_inside():
    square = np.array([0, 1, 1 + 1j, 1j, 0.5 + 0.5j, 0.5])
    assert list(hull(square)) == [0, 1, 1 + 1j, 1j]
    assert list(hull(np.array([1j, 0, 0.5j]))) == [0, 1j]
    assert list(hull(np.array([2.0, 2.0]))) == [2]
