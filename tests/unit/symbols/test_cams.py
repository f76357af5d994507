"""Drawn cams: at every crank angle they touch what rides on them, and nothing overlaps."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import equipoise as eq
from equipoise.figures.linkage import keys_of
from equipoise.mechanism import Motion
from equipoise.mechanism.formulas.kernels import cross
from equipoise.symbols.pieces import pieces, placed
from equipoise.symbols.scene import Scene
from equipoise.symbols.shapes import Shape
from support.machines_cams import KINDS, make

COUNT = 24


def drawn(kind: str, rides: str) -> tuple[Motion, Scene, list[list[Shape]]]:
    """A random machine of a kind, and the shapes of its cam at every crank angle."""
    cases = (make(kind, seed).machine for seed in range(40))
    machine = next(case for case in cases if case.cams[0].rides == rides)
    motion = eq.move(machine, COUNT)
    scene = Scene.of(motion)
    every = [
        [item for item in placed(scene, pieces(scene), k) if item.role in ("cam", "rider", "face")]
        for k in range(COUNT)
    ]
    return motion, scene, every


def distance(place: complex, corners: np.ndarray) -> float:
    """From a place to a closed line."""
    edges = np.roll(corners, -1) - corners
    along = ((place - corners) / np.where(edges == 0, 1.0, edges)).real
    return float(np.min(np.abs(corners + np.clip(along, 0, 1) * edges - place)))


@pytest.mark.exhaustive(but=["pusher_tappet", "fixed_cam_lever"])
@pytest.mark.parametrize("kind", KINDS)
def test_rollers_touch_the_cam(kind: str) -> None:
    motion, scene, every = drawn(kind, "roller")
    (cam,) = motion.machine.cams
    for k, (surface, roller) in enumerate(every):
        (centre,) = roller.places
        assert abs(centre - scene.places[cam.point][k]) < 1e-9 * cam.base_radius
        assert roller.radius == cam.roller_radius
        apart = distance(centre, surface.places) - roller.radius
        assert abs(apart) < 1e-3 * cam.base_radius


@pytest.mark.exhaustive(but=["pusher_lever", "camshaft_tappet", "fixed_cam_lever"])
@pytest.mark.parametrize("kind", KINDS)
def test_flat_faces_lie_on_the_cam(kind: str) -> None:
    motion, _, every = drawn(kind, "flat")
    (cam,) = motion.machine.cams
    for surface, face in every:
        start, end = face.places
        arms = (surface.places - start) / (end - start) * abs(end - start)
        apart = min(arms.imag.max(), -arms.imag.min(), key=abs)  # the cam is on one side
        assert abs(apart) < 1e-3 * cam.base_radius
        touching = arms.real[np.argmin(np.abs(arms.imag))]
        assert 0 < touching < abs(end - start)


def test_both_flanks_of_a_groove_touch_its_roller() -> None:
    motion, _, _ = drawn("camshaft_tappet", "roller")
    (cam,) = motion.machine.cams
    grooved = replace(motion.machine, cams=(replace(cam, closed_by="groove"),))
    scene = Scene.of(eq.move(grooved, COUNT))
    for k in range(COUNT):
        roles = ("groove", "cam", "rider")
        shapes = [item for item in placed(scene, pieces(scene), k) if item.role in roles]
        *flanks, roller = shapes
        apart = [distance(roller.places[0], flank.places) - roller.radius for flank in flanks]
        np.testing.assert_allclose(apart, [0, 0], atol=1e-3 * cam.base_radius)
        outer, inner = (np.sum(cross(flank.places, np.roll(flank.places, -1))) for flank in flanks)
        assert abs(outer) > abs(inner)


def test_links_hide_neither_the_surface_nor_the_roller() -> None:
    _, scene, _ = drawn("camshaft_tappet", "roller")
    roles = [shape.role for piece in pieces(scene) for shape in piece.shapes]
    last = max(k for k, role in enumerate(roles) if role == "body")
    assert roles.index("cam") < last < roles.index("cam-edge") < roles.index("rider")
    assert max(k for k, role in enumerate(roles) if role == "block") < roles.index("rider")


def test_the_cam_is_in_sight_and_has_a_key() -> None:
    _, scene, every = drawn("fixed_cam_tappet", "roller")
    low, high = scene.box
    for shape in (item for shapes in every for item in shapes):
        places, radius = shape.places, shape.radius
        assert low.real <= np.min(places.real) - radius <= np.max(places.real) + radius <= high.real
        assert low.imag <= np.min(places.imag) - radius <= np.max(places.imag) + radius <= high.imag
    assert ("cam", "cams") in [*keys_of(scene)]


def test_ribs_are_drawn_inside_of_the_surface() -> None:
    """A rib lies within the cam, and no other closure has one."""
    motion, _, _ = drawn("camshaft_tappet", "roller")
    (cam,) = motion.machine.cams
    for closed_by in ("ribs", "groove", "spring"):
        closed = replace(motion.machine, cams=(replace(cam, closed_by=closed_by),))
        scene = Scene.of(eq.move(closed, COUNT))
        by_role = {item.role: item for item in placed(scene, pieces(scene), 0)}
        assert ("rib" in by_role) == (closed_by == "ribs")
        if closed_by == "ribs":
            apart = [distance(place, by_role["cam"].places) for place in by_role["rib"].places]
            np.testing.assert_allclose(apart, apart[0], rtol=0.05)
            reach = [np.max(np.abs(by_role[role].places)) for role in ("rib", "cam")]
            assert reach[0] < reach[1]
