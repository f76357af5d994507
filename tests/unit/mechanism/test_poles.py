"""Instant centres by lines and by Kennedy's rule; mechanical advantage by the forces."""

from __future__ import annotations

from dataclasses import replace
from itertools import combinations

import numpy as np
import pytest

import equipoise as eq
from equipoise.mechanism.outputs.declared import pairs

MACHINES = ["yamashita-1", "quick-return", "watt-six-bar", "stephenson-six-bar", "drag-link",
            "class-three", "geared-counterweight"]  # fmt: skip


def center(found: eq.Analysis, pair: str) -> np.ndarray:
    return (
        found.outputs[f"centers.{pair}.x"].values + 1j * found.outputs[f"centers.{pair}.y"].values
    )


def crossing(a: np.ndarray, b: np.ndarray, c: np.ndarray, d: np.ndarray) -> np.ndarray:
    """Where the line through a and b meets that through c and d."""
    one, other = b - a, d - c
    cross = (one.conj() * other).imag
    return a + one * ((c - a).conj() * other).imag / cross


def test_a_coupler_turns_about_the_crossing_of_crank_and_rocker() -> None:
    found = eq.analyze(eq.load("yamashita-1"), 50)
    a, b, c, d = (found.motion.points[name].place for name in "ABCD")
    np.testing.assert_allclose(center(found, "coupler/frame"), crossing(a, b, d, c), rtol=1e-9)
    np.testing.assert_allclose(center(found, "crank/rocker"), crossing(a, d, b, c), rtol=1e-9)
    np.testing.assert_array_equal(center(found, "coupler/rocker"), c)


@pytest.mark.parametrize("name", MACHINES)
def test_three_centers_of_three_bodies_lie_in_a_line(name: str) -> None:
    """Aronhold and Kennedy; those of bodies that a guide keeps parallel lie at infinity."""
    found = eq.analyze(eq.load(name), 36)
    known = {frozenset(pair): center(found, key) for key, pair in pairs(found.machine).items()}
    size = max(np.max(np.abs(point.place)) for point in found.motion.points.values())
    checked = 0
    for three in combinations((*found.machine.links, "frame"), 3):
        sides = [frozenset(pair) for pair in combinations(three, 2)]
        if not all(side in known for side in sides):
            continue
        a, b, c = (known[side] for side in sides)
        near = np.max(np.abs([a, b, c]), axis=0) < 100 * size
        area = np.abs(((b - a).conj() * (c - a)).imag)[near]
        longest = np.max(np.abs([b - a, c - a, c - b]), axis=0)[near]
        assert np.all(area <= 1e-9 * (size + longest) ** 2 * 100)
        checked += int(np.count_nonzero(near))
    assert checked > 10


def test_bodies_that_slide_along_each_other_have_none() -> None:
    found = eq.analyze(eq.load("quick-return"), 12)
    assert "centers.ram/frame.x" not in found.outputs
    assert "centers.block/lever.x" not in found.outputs


def test_at_infinity_there_is_none() -> None:
    """While crank pin and piston move in parallel, the rod does not turn."""
    found = eq.analyze(eq.load("slider-crank-engine"), 4)
    there = np.isfinite(center(found, "rod/frame"))
    assert there.tolist() == [False, True, False, True]
    told = found.to_dict(outputs=["centers.rod/frame"])["outputs"]
    assert list(told) == ["centers.rod/frame.x", "centers.rod/frame.y"]
    assert [value is None for value in told["centers.rod/frame.x"].tolist()] == (~there).tolist()


@pytest.mark.parametrize(
    ("name", "output", "link"),
    [
        ("yamashita-1", "links.rocker.advantage", "rocker"),
        ("watt-six-bar", "links.output.advantage", "output"),
        ("drag-link", "links.follower.advantage", "follower"),
        ("class-three", "links.rear-link.advantage", "rear-link"),
    ],
)
def test_the_advantage_is_what_a_unit_torque_asks_of_the_crank(
    name: str, output: str, link: str
) -> None:
    bare = eq.load(name)
    if output not in (known := eq.analyze(bare, 4).outputs):
        output = next(one for one in known.names if one.endswith(".advantage"))
        link = output.split(".")[1]
    loaded = replace(bare, loads=(*bare.loads, eq.Load(link=link, torque=-1.0)))
    without, with_load = (eq.analyze(one, 24) for one in (bare, loaded))
    torque = with_load.forces.drive_torque - without.forces.drive_torque
    values = with_load.outputs[output].values
    there = np.isfinite(values)
    np.testing.assert_allclose(values[there] * torque[there], 1.0, rtol=1e-7)


def test_the_advantage_of_a_slider_is_what_a_unit_force_asks_of_the_crank() -> None:
    bare = eq.load("slider-crank-engine")
    bare = replace(bare, loads=())
    loaded = replace(bare, loads=(eq.Load(link="piston", point="C", force=(0.0, -1.0)),))
    without, with_load = (eq.analyze(one, 24) for one in (bare, loaded))
    torque = with_load.forces.drive_torque - without.forces.drive_torque
    one = with_load.outputs["sliders.piston on frame.advantage"]
    there = np.isfinite(one.values) & (np.abs(one.values) < 1e6)
    np.testing.assert_allclose(one.values[there] * torque[there], 1.0, rtol=1e-6)
    assert one.unit == "1/m"


def test_towards_dead_positions_it_has_no_bound() -> None:
    found = eq.analyze(eq.load("slider-crank-engine"), 360)
    one = found.outputs["sliders.piston on frame.advantage"]
    dead = [dead.crank_angle for dead in found.strokes["piston on frame"].dead_positions]
    at = np.round(np.degrees(dead)).astype(int) % 360
    assert np.all(~np.isfinite(one.values[at]) | (np.abs(one.values[at]) > 1e9))
    told = found.to_dict(outputs=[one.name])["outputs"][one.name]
    assert all(value is None or np.isfinite(value) for value in told.tolist())
    least = found.strokes["piston on frame"].least_advantage
    assert np.nanmin(np.abs(one.values)) == pytest.approx(least, rel=1e-4)
    assert np.nanmax(np.abs(one.values_to_draw)) < 20 * least
