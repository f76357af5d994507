"""Pictures of vibration at one speed, from rest, and of modes: what they draw is what was found."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from matplotlib.axes import Axes

import equipoise as eq
from equipoise.plotting.vibration import mode_drawings, response_drawings, transient_drawings
from equipoise.plotting.vibration.body import SHOWN_SIZE, Shape
from equipoise.plotting.vibration.modes import told
from equipoise.symbols.scene import Scene
from equipoise.vibration.forced import respond
from equipoise.vibration.mode_shapes import Mode
from unit.plotting.samples import words
from unit.plotting.vibration_samples import (
    RPM,
    falling,
    linkage,
    long_cycle,
    pictures,
    plane,
    rig,
    space,
)


def line_of(axes: Axes, number: int = 0) -> tuple[np.ndarray, np.ndarray]:
    line = axes.get_lines()[number]
    return np.asarray(line.get_xdata(), float), np.asarray(line.get_ydata(), float)


def test_gauges_read_what_was_found() -> None:
    response = respond(plane())
    drawn = response_drawings(response)
    factors = {"seat": (1e3, 1e3, 1.0), "tilt": (1e3, 1e3, 1.0)}
    labels = {
        "seat": ("displacement, mm", "velocity, mm/s", "acceleration, m/s²"),
        "tilt": ("rotation, mrad", "velocity, mrad/s", "acceleration, rad/s²"),
    }
    for name, scales in factors.items():
        gauge = response.gauges[name]
        panels = drawn[f"gauge-{name}"].axes
        assert tuple(axes.get_ylabel() for axes in panels) == labels[name]
        signals = (gauge.displacement, gauge.velocity, gauge.acceleration)
        for axes, signal, factor in zip(panels, signals, scales, strict=True):
            x, y = line_of(axes)
            assert axes.get_xlim() == (0, 360) and x[-1] == 360
            largest = float(signal.extreme(1)[0])
            np.testing.assert_allclose(
                y, factor * signal.values(np.radians(x)), atol=1e-9 * abs(y).max()
            )
            assert f"{factor * largest:.4g} at {np.degrees(signal.extreme(1)[1]):.1f}°" in words(
                drawn[f"gauge-{name}"]
            )


def test_a_period_of_several_turns_is_drawn_whole() -> None:
    response = respond(long_cycle())
    figure = pictures("long cycle")["gauge-seat"]
    assert response.turns == 3 and figure.axes[0].get_xlim() == (0, 1080)
    assert "over 3 turns" in words(figure)
    bars = pictures("long cycle")["spectrum"].axes[0].patches
    orders = [bar.get_x() + bar.get_width() / 2 for bar in bars]
    assert orders == pytest.approx([1 / 3, 1, 4 / 3])


def test_clockwise_is_told() -> None:
    figure = pictures("clockwise")["gauge-seat"]
    assert "right to left" in words(figure) and "clockwise" in words(figure)
    assert "right to left" not in words(pictures("plane")["gauge-seat"])


def test_bars_are_the_orders() -> None:
    response = respond(rig())
    axes = pictures("rig")["spectrum"].axes[0]
    sizes = 1e3 * response.gauges["tip"].displacement.sizes
    assert axes.get_yscale() == "log" and axes.get_ylabel() == "amplitude, mm"
    for bar in axes.patches:
        order = round(bar.get_x() + bar.get_width() / 2)
        assert bar.get_height() == pytest.approx(sizes[order], rel=1e-12)
    assert len(axes.patches) == np.sum(sizes[1:] > 1e-4 * sizes.max())
    assert f"{sizes[1]:.4g}" in words(pictures("rig")["spectrum"])


def test_a_gauge_that_stands_still() -> None:
    machine = plane(freedoms=("heave",))
    response = respond(machine)
    assert "does not move" in words(response_drawings(response)["spectrum"])


def test_mounts_and_what_they_carry_at_rest() -> None:
    response = respond(plane())
    preloads = eq.modes(plane()).preloads
    panels = pictures("plane")["mounts"].axes
    for axes, (name, mount) in zip(panels, response.mounts.items(), strict=True):
        assert axes.get_title(loc="left") == name and axes.get_ylabel() == "force, N"
        x, y = line_of(axes)
        np.testing.assert_allclose(y, mount.force.values(np.radians(x)), rtol=1e-9, atol=1e-9)
        np.testing.assert_allclose(line_of(axes, 1)[1], preloads[name], atol=1e-9)
    assert pictures("rig")["mounts"].axes[1].get_ylabel() == "torque, N m"


def test_lift_off_is_shaded() -> None:
    response = respond(eq.load("walking-transplanter"), model="exact")
    share = response.mounts["float"].lifts_off
    assert share > 0.1
    figure = response_drawings(response)["mounts"]
    axes = figure.axes[0]
    assert sum(span.get_width() for span in axes.patches) / 360 == pytest.approx(share, abs=0.01)
    assert f"off its ground for {100 * share:.0f} %" in words(figure)
    assert np.min(line_of(axes)[1]) == 0
    linear = response_drawings(respond(eq.load("walking-transplanter")))["mounts"]
    assert "would have to pull for" in words(linear)
    assert "off its ground" not in words(pictures("plane")["mounts"])


def test_a_mount_that_does_not_touch() -> None:
    mounts = dict(plane().support.mounts)  # type: ignore[union-attr]
    mounts["float"] = replace(mounts["float"], preload=0.0)
    drawn = response_drawings(respond(plane(mounts=mounts)))
    assert "does not touch" in words(drawn["mounts"])


def test_drive_torque_and_crank_speed() -> None:
    machine = eq.load("walking-transplanter")
    response = respond(machine, drive=True)
    figure = pictures("walking-transplanter")["exact drive"]
    torque, speed = figure.axes
    assert (torque.get_ylabel(), speed.get_ylabel()) == ("drive torque, N m", "crank speed, rpm")
    x, y = line_of(speed)
    assert response.drive.speed is not None
    np.testing.assert_allclose(y, RPM * response.drive.speed.values(np.radians(x)), rtol=1e-9)
    assert f"varies by {100 * response.drive.fluctuation:.4g} %" in words(figure)
    assert "mean 200" in words(figure) and "time, in degrees" in words(figure)
    assert len(pictures("rig")["drive"].axes) == 1


def test_a_drive_on_solid_ground() -> None:
    machine = replace(eq.load("walking-transplanter"), support=None)
    assert list(response_drawings(respond(machine, drive=True))) == ["drive"]
    assert list(transient_drawings(eq.simulate(machine, 0.3, drive=True, samples=40))) == ["speed"]


def test_from_rest_against_time() -> None:
    machine = eq.load("walking-transplanter")
    transient = eq.simulate(machine, 0.5, drive=True, samples=300)
    drawn = pictures("walking-transplanter")
    for axes, (name, read) in zip(drawn["rest gauges"].axes, transient.gauges.items(), strict=True):
        x, y = line_of(axes)
        np.testing.assert_allclose(x, transient.time)
        np.testing.assert_allclose(y, 1e3 * read, rtol=1e-12)
        assert axes.get_title(loc="left").startswith(name)
    turned = drawn["rest gauges"].axes[1]
    assert turned.get_ylabel() == "turned, mrad"
    np.testing.assert_allclose(line_of(drawn["rest speed"].axes[0])[1], RPM * transient.crank_speed)
    assert "rest speed" not in pictures("plane")


def test_modes_are_told() -> None:
    mode = eq.modes(rig()).modes[0]
    shown = words(pictures("rig")["mode-1"])
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
    axes = pictures("rig")["mode-1"].axes[0]
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
    for name, figure in pictures("space").items():
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
    shown = words(pictures("space")["mode-1"])
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
    assert free.coordinates == freedoms and len(mode_drawings(free)) == 6


def test_without_gauges_the_coordinates_are_read() -> None:
    drawn = response_drawings(respond(linkage_on_springs()))
    assert list(drawn)[:3] == ["gauge-surge", "gauge-heave", "gauge-pitch"]
    transient = eq.simulate(linkage_on_springs(), 0.2, samples=30)
    panels = transient_drawings(transient)["gauges"].axes
    assert [axes.get_ylabel().split(",")[0] for axes in panels] == ["moved", "moved", "turned"]


def linkage_on_springs() -> eq.Machine:
    return plane(linkage(), gauges={})


def test_a_support_that_is_a_point_is_as_large_as_its_linkage() -> None:
    machine = eq.load("exudyn-slider-crank")
    low, high = Scene.of(eq.move(machine, 72)).box
    axes = mode_drawings(eq.modes(machine))["mode-1"].axes[0]
    assert 0.1 < np.ptp(axes.get_xlim()) / 1e3 / abs(high - low) < 1
