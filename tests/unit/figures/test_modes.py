"""The pictures of modes."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

import equipoise as eq
from equipoise.figures import Picture
from equipoise.figures.pictures import pictures_of
from equipoise.plotting.vibration.body import SHOWN_SIZE, Shape
from equipoise.plotting.vibration.modes import told
from equipoise.symbols.scene import Scene
from equipoise.vibration.mode_shapes import Mode
from unit.figures.samples import words
from unit.figures.vibration_samples import (
    MACHINES,
    falling,
    linkage,
    plane,
    rig,
    space,
)


@cache
def modes_of(kind: str) -> dict[str, Picture]:
    return pictures_of(eq.modes(MACHINES[kind]()))


def test_modes_are_told() -> None:
    mode = eq.modes(rig()).modes[0]
    shown = words(modes_of("rig")["mode-1"])
    assert f"{mode.cycles_per_second:.4g} Hz, {mode.natural_frequency:.4g} rad/s" in shown
    assert f"damping ratio {mode.damping_ratio:.4g}" in shown and "pitch 1 rad" in shown
    kinds = [told(mode) for mode in eq.modes(falling()).modes]
    assert kinds[0] == "free, without a spring"
    assert "falls over" in kinds[2] and "overdamped" in kinds[3]
    assert told(Mode(complex(1e-15, 20.0), np.array([1 + 0j]))).endswith("damping ratio 0")


def test_the_pivot_stands_still_and_the_largest_displacement_shows() -> None:
    free = eq.modes(rig())
    shape = Shape(free, free.modes[0])
    pivot = np.array([[-1.34, 0.0, 0.0]])
    np.testing.assert_array_equal(shape.displaced(pivot, 1), pivot)
    ends = shape.displaced(shape.corners, 1) - shape.corners
    assert np.max(np.linalg.norm(ends, axis=1)) == pytest.approx(SHOWN_SIZE * shape.size)
    axes = modes_of("rig")["mode-1"].axes[0]
    ways = [line for line in axes.get_lines() if len(line.get_xdata()) == 73]
    assert np.ptp(ways[0].get_ydata()) == pytest.approx(
        2e3 * np.linalg.norm(shape.displaced(np.array([[0.16, 0, 0]]), 1) - [[0.16, 0, 0]])
    )


def test_gauges_swing_as_the_shape_says() -> None:
    free = eq.modes(space())
    for number, mode in enumerate(free.modes):
        shape = Shape(free, mode)
        scale = abs(shape.motion[1] / mode.shape[0])
        for name in ("left", "right", "middle"):
            point = np.array(free.linear.body.support.gauges[name].point)
            way = shape.path(point, "side").imag / 1e3
            read = scale * abs(free.gauges[name][number])
            assert np.ptp(way) / 2 == pytest.approx(read, rel=2e-3)


def test_three_views_to_one_scale() -> None:
    for name, figure in modes_of("space").items():
        if not name.startswith("mode"):
            continue
        assert [axes.get_title(loc="left") for axes in figure.axes] == [
            *("from the side", "from the rear", "from above")
        ]
        for axes in figure.axes:
            (x0, y0), (x1, y1) = axes.transData.transform([(0, 0), (1, 1)])
            assert x1 - x0 == pytest.approx(y1 - y0, rel=1e-9)
        side, rear, top = figure.axes
        assert side.get_ylim() == pytest.approx(rear.get_ylim())
        assert side.get_xlim() == pytest.approx(top.get_xlim())
    shown = words(modes_of("space")["mode-1"])
    assert shown.count("left") == 1 and shown.count("rolling") == 1
    assert all(text in shown for text in ("heave ", "roll ", "pitch "))


def test_what_lies_to_the_right_is_below_from_above() -> None:
    free = eq.modes(space())
    shape = Shape(free, free.modes[0])
    rest = shape.outline("top")
    assert np.min(rest.imag) < -300 < 300 < np.max(rest.imag)
    right = np.array(free.linear.body.support.gauges["right"].point)
    assert np.mean(shape.path(right, "top").imag) == pytest.approx(-300, abs=1)


def test_each_of_six_ways() -> None:
    freedoms = ("surge", "heave", "sway", "roll", "yaw", "pitch")
    free = eq.modes(eq.load("riding-transplanter"))
    assert free.coordinates == freedoms and len(pictures_of(free)) == 6


def linkage_on_springs() -> eq.Machine:
    return plane(linkage(), gauges={})


def test_a_support_that_is_a_point_is_as_large_as_its_linkage() -> None:
    machine = eq.load("exudyn-slider-crank")
    low, high = Scene.of(eq.move(machine, 72)).box
    axes = pictures_of(eq.modes(machine))["mode-1"].axes[0]
    assert 0.1 < np.ptp(axes.get_xlim()) / 1e3 / abs(high - low) < 1
