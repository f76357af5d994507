"""The pictures of modes."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

import equipoise as eq
from equipoise.figures.modes import SHOWN_SIZE, ModeShape, described
from equipoise.figures.pictures import pictures_of
from equipoise.results.charts import Chart
from equipoise.symbols.scene import Scene
from equipoise.vibration.response import Mode
from unit.figures.samples import words
from unit.figures.test_pictures import views
from unit.figures.vibration_samples import (
    MACHINES,
    falling,
    linkage,
    plane,
    rig,
    space,
)


@cache
def modes_of(kind: str) -> dict[str, Chart]:
    return pictures_of(eq.modes(MACHINES[kind]()))


def test_modes_are_told() -> None:
    mode = eq.modes(rig()).modes[0]
    shown = words(modes_of("rig")["mode-1"])
    assert f"{mode.cycles_per_second:.4g} Hz, {mode.natural_frequency:.4g} rad/s" in shown
    assert f"damping ratio {mode.damping_ratio:.4g}" in shown and "pitch 1 rad" in shown
    kinds = [described(mode) for mode in eq.modes(falling()).modes]
    assert kinds[0] == "free, without a spring"
    assert "falls over" in kinds[2] and "overdamped" in kinds[3]
    assert described(Mode(complex(1e-15, 20.0), np.array([1 + 0j]))).endswith("damping ratio 0")


def test_the_pivot_stands_still_and_the_largest_displacement_shows() -> None:
    free = eq.modes(rig())
    shape = ModeShape(free, free.modes[0])
    pivot = np.array([[-1.34, 0.0, 0.0]])
    np.testing.assert_array_equal(shape.displaced(pivot, 1), pivot)
    ends = shape.displaced(shape.corners, 1) - shape.corners
    assert np.max(np.linalg.norm(ends, axis=1)) == pytest.approx(SHOWN_SIZE * shape.size)
    (panel,) = modes_of("rig")["mode-1"].panels
    (way,) = (curve for curve in panel.curves if curve.role == "gauge way")
    assert np.ptp(way.y) == pytest.approx(
        2 * np.linalg.norm(shape.displaced(np.array([[0.16, 0, 0]]), 1) - [[0.16, 0, 0]])
    )


def test_gauges_swing_as_the_shape_says() -> None:
    free = eq.modes(space())
    for number, mode in enumerate(free.modes):
        shape = ModeShape(free, mode)
        scale = abs(shape.motion[1] / mode.shape[0])
        for name in ("left", "right", "middle"):
            point = np.array(free.linear.body.support.gauges[name].point)
            way = shape.path(point, "side").imag
            read = scale * abs(free.gauges[name][number])
            assert np.ptp(way) / 2 == pytest.approx(read, rel=2e-3)


def test_three_views_to_one_scale() -> None:
    for chart in modes_of("space").values():
        titles = [panel.title for panel in chart.panels]
        assert titles == ["from the side", "from the rear", "from above"]
        scales = [
            scale.length / (scale.high - scale.low)
            for view in views(chart)
            for scale in (view.x, view.y)
        ]
        assert scales == pytest.approx([scales[0]] * 6)
        side, rear, top = views(chart)
        assert (side.y.low, side.y.high) == pytest.approx((rear.y.low, rear.y.high))
        assert (side.x.low, side.x.high) == pytest.approx((top.x.low, top.x.high))
    shown = words(modes_of("space")["mode-1"])
    assert shown.count("left") == 1 and shown.count("rolling") == 1
    assert all(text in shown for text in ("heave ", "roll ", "pitch "))


def test_what_lies_to_the_right_is_below_from_above() -> None:
    free = eq.modes(space())
    shape = ModeShape(free, free.modes[0])
    rest = shape.outline("top")
    assert np.min(rest.imag) < -0.3 < 0.3 < np.max(rest.imag)
    right = np.array(free.linear.body.support.gauges["right"].point)
    assert np.mean(shape.path(right, "top").imag) == pytest.approx(-0.3, abs=1e-3)


def test_each_of_six_ways() -> None:
    freedoms = ("surge", "heave", "sway", "roll", "yaw", "pitch")
    free = eq.modes(eq.load("riding-transplanter"))
    assert free.coordinates == freedoms and len(pictures_of(free)) == 6


def linkage_on_springs() -> eq.Machine:
    return plane(linkage(), gauges={})


def test_a_support_that_is_a_point_is_as_large_as_its_linkage() -> None:
    machine = eq.load("exudyn-slider-crank")
    low, high = Scene.of(eq.move(machine, 72)).linkage_box
    (view,) = views(pictures_of(eq.modes(machine))["mode-1"])
    assert 0.1 < (view.x.high - view.x.low) / 1e3 / abs(high - low) < 1


def test_what_is_at_one_place_shares_a_name() -> None:
    (panel,) = pictures_of(eq.modes(eq.load("exudyn-slider-crank")))["mode-1"].panels
    assert [mark.text for mark in panel.marks] == ["x\ny\nalong\nacross"]
