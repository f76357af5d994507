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


def center(result: eq.Analysis, pair: str) -> np.ndarray:
    return (
        result.outputs[f"centers.{pair}.x"].values + 1j * result.outputs[f"centers.{pair}.y"].values
    )


def crossing(a: np.ndarray, b: np.ndarray, c: np.ndarray, d: np.ndarray) -> np.ndarray:
    """Where the line through a and b meets that through c and d."""
    first, other = b - a, d - c
    cross = (first.conj() * other).imag
    return a + first * ((c - a).conj() * other).imag / cross


def test_a_coupler_turns_about_the_crossing_of_crank_and_rocker() -> None:
    analysis = eq.analyze(eq.load("yamashita-1"), 50)
    a, b, c, d = (analysis.motion.points[name].place for name in "ABCD")
    np.testing.assert_allclose(center(analysis, "coupler/frame"), crossing(a, b, d, c), rtol=1e-9)
    np.testing.assert_allclose(center(analysis, "crank/rocker"), crossing(a, d, b, c), rtol=1e-9)
    np.testing.assert_array_equal(center(analysis, "coupler/rocker"), c)


@pytest.mark.parametrize("name", MACHINES)
def test_three_centers_of_three_bodies_lie_in_a_line(name: str) -> None:
    """Aronhold and Kennedy; those of bodies that a guide keeps parallel lie at infinity."""
    analysis = eq.analyze(eq.load(name), 36)
    known = {
        frozenset(pair): center(analysis, key) for key, pair in pairs(analysis.machine).items()
    }
    size = max(np.max(np.abs(point.place)) for point in analysis.motion.points.values())
    checked = 0
    for three in combinations((*analysis.machine.links, "frame"), 3):
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
    analysis = eq.analyze(eq.load("quick-return"), 12)
    assert "centers.ram/frame.x" not in analysis.outputs
    assert "centers.block/lever.x" not in analysis.outputs


def test_at_infinity_there_is_none() -> None:
    """While crank pin and piston move in parallel, the rod does not turn."""
    analysis = eq.analyze(eq.load("slider-crank-engine"), 4)
    there = np.isfinite(center(analysis, "rod/frame"))
    assert there.tolist() == [False, True, False, True]
    content = analysis.to_dict(outputs=["centers.rod/frame"])["outputs"]
    assert list(content) == ["centers.rod/frame.x", "centers.rod/frame.y"]
    assert [value is None for value in content["centers.rod/frame.x"].tolist()] == (~there).tolist()


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
        output = next(item for item in known.names if item.endswith(".advantage"))
        link = output.split(".")[1]
    loaded = replace(bare, loads=(*bare.loads, eq.Load(link=link, torque=-1.0)))
    without, with_load = (eq.analyze(item, 24) for item in (bare, loaded))
    torque = with_load.forces.drive_torque - without.forces.drive_torque
    values = with_load.outputs[output].values
    there = np.isfinite(values)
    np.testing.assert_allclose(values[there] * torque[there], 1.0, rtol=1e-7)


def test_the_advantage_of_a_slider_is_what_a_unit_force_asks_of_the_crank() -> None:
    bare = eq.load("slider-crank-engine")
    bare = replace(bare, loads=())
    loaded = replace(bare, loads=(eq.Load(link="piston", point="C", force=(0.0, -1.0)),))
    without, with_load = (eq.analyze(item, 24) for item in (bare, loaded))
    torque = with_load.forces.drive_torque - without.forces.drive_torque
    first = with_load.outputs["sliders.piston on frame.advantage"]
    there = np.isfinite(first.values) & (np.abs(first.values) < 1e6)
    np.testing.assert_allclose(first.values[there] * torque[there], 1.0, rtol=1e-6)
    assert first.unit == "1/m"


def test_towards_dead_positions_it_has_no_bound() -> None:
    analysis = eq.analyze(eq.load("slider-crank-engine"), 360)
    first = analysis.outputs["sliders.piston on frame.advantage"]
    dead = [dead.crank_angle for dead in analysis.strokes["piston on frame"].dead_positions]
    at = np.round(np.degrees(dead)).astype(int) % 360
    assert np.all(~np.isfinite(first.values[at]) | (np.abs(first.values[at]) > 1e9))
    content = analysis.to_dict(outputs=[first.name])["outputs"][first.name]
    assert all(value is None or np.isfinite(value) for value in content.tolist())
    least = analysis.strokes["piston on frame"].least_advantage
    assert np.nanmin(np.abs(first.values)) == pytest.approx(least, rel=1e-4)
    assert np.nanmax(np.abs(first.values_to_draw)) < 20 * least
