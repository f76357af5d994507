"""Pictures of motion and forces: which there are, and that they draw what was computed."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.figure import Figure

import equipoise as eq
from equipoise.balancing.multi_row import Rows
from equipoise.errors import UsageError
from equipoise.figures.drawing import traced
from equipoise.figures.moving import laid_out
from equipoise.figures.stage import Arrow
from equipoise.mechanism.balance import Objective
from equipoise.mechanism.model import Machine
from equipoise.mechanism.support import Row
from equipoise.plotting.analysis import (
    curves_figure,
    drawings,
    hodograph_figure,
    joints_figures,
    linkage_figure,
    moment_figure,
    polar_figure,
    spectrum_figure,
)
from equipoise.plotting.analysis.looks import outputs, together
from equipoise.plotting.style import render
from equipoise.results.analysis import Analysis
from equipoise.signals import Periodic
from equipoise.symbols.scene import Scene
from unit.plotting.samples import long_cycle, one_link, words
from unit.plotting.test_layout import check_texts

MOTION = ["linkage", "curves", "hodograph"]
FORCES = ["polar", "force", "moment", "torque"]
JOINTS = ["joints", "joint-polars"]


@cache
def analysis_of(name: str) -> Analysis:
    return eq.analyze(eq.load(name), 360)


@cache
def drawn(name: str) -> dict[str, Figure]:
    return drawings(analysis_of(name))


def rotor() -> Machine:
    """A disc out of balance: none of its points moves."""
    return replace(
        one_link(), links={"crank": eq.Link({"A": (0, 0)}, 1.0, (0.03, 0.0), 1e-3)}, planting=None
    )


def staggered() -> Machine:
    rows = (Row(0.0, -0.3), Row(1.0, 0.0, (0.05, -0.02)), Row(2.5, 0.3, (-0.1, 0.03)))
    return replace(eq.load("four-row-transplanter"), rows=rows, balance=None)


def curves(axes: Axes, least: int = 100) -> list[np.ndarray]:
    """Long lines as complex numbers, without their last place, which is the first again."""
    lines = [np.array(line.get_data(), float) for line in axes.get_lines()]
    return [(x + 1j * y)[:-1] for x, y in lines if len(x) > least]


def has(found: list[np.ndarray], wanted: np.ndarray) -> bool:
    size = np.max(np.abs(wanted))
    return any(z.shape == wanted.shape and np.max(np.abs(z - wanted)) < 1e-9 * size for z in found)


def test_names() -> None:
    assert list(drawn("yamashita-1")) == [*MOTION, *FORCES, "spectrum", *JOINTS]
    machine = eq.load("yamashita-1")
    few = drawings(eq.analyze(machine, 60))
    assert list(few) == [*MOTION, *FORCES, *JOINTS]
    assert list(drawings(eq.analyze(machine, [0.3]))) == ["linkage"]
    assert list(drawings(eq.analyze(rotor(), 360)))[:2] == ["linkage", "polar"]
    free = eq.Link(machine.links["crank"].points)
    massless = replace(machine, links={**machine.links, "crank": free})
    assert list(drawings(eq.analyze(massless, 90))) == MOTION


def test_lines_are_the_forces() -> None:
    found, figures = analysis_of("yamashita-1").forces, drawn("yamashita-1")
    force = found.shaking_force
    for axes, values in zip(figures["force"].axes, (force.x, force.y, force.size), strict=True):
        assert has([z.imag for z in curves(axes)], values)
    assert has(curves(figures["polar"].axes[0]), force.value)
    assert has([z.imag for z in curves(figures["moment"].axes[0])], found.shaking_moment)
    whole, causes = figures["torque"].axes
    assert has([z.imag for z in curves(whole)], found.drive_torque)
    total = sum(z.imag for z in curves(causes))
    np.testing.assert_allclose(total, found.drive_torque, atol=1e-12)
    joints = list(found.joints.values())
    for axes, polar, joint in zip(
        figures["joints"].axes, figures["joint-polars"].axes, joints, strict=True
    ):
        assert has([z.imag for z in curves(axes)], joint.size)
        assert has(curves(polar), joint.value)


def test_peak_and_mean_size_are_the_summary() -> None:
    told = words(drawn("yamashita-1")["polar"])
    size = analysis_of("yamashita-1").summary["shaking_force"]
    assert f"peak {size.peak:.4g} N at {np.degrees(size.peak_at):.1f}°" in told
    assert f"mean size {size.mean:.4g} N" in told


def test_bars_are_the_orders() -> None:
    """Against sums over the samples, without any transform."""
    analysis = analysis_of("quick-return")
    theta, torque = analysis.crank_angle, analysis.forces.drive_torque
    bars = drawn("quick-return")["spectrum"].axes[3].patches
    for order, bar in enumerate(bars):
        mean = abs(np.mean(torque * np.exp(1j * order * theta)))
        assert bar.get_height() == pytest.approx(mean * (1 if order == 0 else 2), rel=1e-9)
        assert bar.get_x() + bar.get_width() / 2 == pytest.approx(order)


def test_rows_together() -> None:
    """Against the sum that balancing takes by orders, with offsets and phases."""
    machine = staggered()
    analysis = eq.analyze(machine, 360)
    mine, phases = together(analysis), np.array([row.phase for row in machine.rows])
    force, moment = mine["shaking_force"], mine["shaking_moment"]
    for output, values in (
        ("shaking_force.x", force.real),
        ("shaking_force.y", force.imag),
        ("shaking_moment", moment),
        ("drive_torque", mine["drive_torque"]),
    ):
        read = Rows(machine).signals(Objective(output))
        expected = Periodic(read.total(phases)[0, 0], read.turns).samples(360)
        np.testing.assert_allclose(values, expected, atol=1e-9 * np.max(np.abs(expected)))
    lines = curves(polar_figure(analysis).axes[0])
    assert has(lines, force) and has(lines, outputs(analysis)["shaking_force"])
    assert "all 3 rows" in words(spectrum_figure(analysis))


def test_what_is_rounding_is_told_to_be_zero() -> None:
    told = words(drawn("planetary-planting-arm")["moment"])
    assert "zero at every crank angle" in told
    assert "zero at every order" in words(drawn("planetary-planting-arm")["spectrum"])
    opposed = replace(staggered(), rows=(Row(0.0), Row(np.pi)), planting=None)
    force = together(eq.analyze(opposed, 360))["shaking_force"]
    orders = np.abs(np.fft.fft(force))
    assert np.max(orders[1::2]) < 1e-9 * np.max(orders) > 0


@pytest.mark.parametrize("name", ["yamashita-1", "quick-return", "planetary-planting-arm"])
def test_paths_and_hodographs_are_the_motion(name: str) -> None:
    motion = analysis_of(name).motion
    (point,) = traced(motion)
    place = motion.points[point].place
    assert has(curves(drawn(name)["curves"].axes[0]), 1000 * place)
    velocity, acceleration = (curves(axes)[0] for axes in drawn(name)["hodograph"].axes)
    step = 2 * np.pi / 360 / motion.speed
    by_hand = (np.roll(place, -1) - np.roll(place, 1)) / (2 * step)
    np.testing.assert_allclose(velocity, by_hand, atol=2e-3 * np.max(np.abs(by_hand)))
    twice = (np.roll(velocity, -1) - np.roll(velocity, 1)) / (2 * step)
    np.testing.assert_allclose(acceleration, twice, atol=5e-3 * np.max(np.abs(twice)))


def test_points_can_be_chosen() -> None:
    analysis = analysis_of("watt-six-bar")
    assert traced(analysis.motion) == ["C", "E", "F"]  # all on circles, but not on the crank's
    place = 1000 * analysis.motion.points["B"].place
    assert has(curves(curves_figure(analysis, ["B"]).axes[0]), place)
    assert len(curves(hodograph_figure(analysis, ["B", "F"]).axes[0])) == 2
    for figure in (curves_figure, hodograph_figure):
        assert "no point moves" in words(figure(eq.analyze(rotor(), 90)))


def pins_of(axes: Axes) -> np.ndarray:
    """Middles of the signs of pins, (n, 2)."""
    outlines = [patch.get_path() for patch in axes.patches if patch.get_gid() == "pin"]
    rings = [ring[:-1] for path in outlines for ring in path.to_polygons()]
    return np.array([(ring.min(axis=0) + ring.max(axis=0)) / 2 for ring in rings])


def test_the_linkage_at_chosen_angles() -> None:
    analysis = analysis_of("yamashita-1")
    angles = [0.0, 1.0, 7.5]
    figure = linkage_figure(analysis, angles)
    pins = analysis.motion.linkage.joints.pins
    for axes, angle in zip(figure.axes, angles, strict=True):
        motion = eq.move(analysis.machine, [angle])
        dots = pins_of(axes)
        for pin in pins:
            z = 1000 * complex(motion.points[pin].place[0])
            assert np.min(np.hypot(*(dots - [z.real, z.imag]).T)) < 1e-6
        told = {text.get_text() for text in axes.texts}
        assert {"A", "B", "C", "D", "P"} <= told
        assert axes.get_title(loc="left") == f"{np.degrees(angle):.4g}°"
    single = words(linkage_figure(analysis))
    assert all(link in single for link in analysis.machine.links)
    for wrong in ([], np.zeros(25)):
        with pytest.raises(UsageError, match="a picture shows 1 to 24"):
            linkage_figure(analysis, wrong)


def test_crank_angles_that_are_no_cycle() -> None:
    analysis = eq.analyze(eq.load("yamashita-1"), np.radians(np.arange(10, 201, 1.0)))
    figure = moment_figure(analysis)
    assert figure.axes[0].get_xlim() == pytest.approx((10, 200))
    (line,) = (z for z in figure.axes[0].get_lines() if len(z.get_xdata()) > 100)
    np.testing.assert_array_equal(line.get_ydata(), analysis.forces.shaking_moment)
    with pytest.raises(UsageError, match="orders need"):
        spectrum_figure(analysis)


@pytest.mark.parametrize(
    "machine",
    ["watt-six-bar", "quick-return", "scotch-yoke", "class-three", staggered(), long_cycle()],
    ids=lambda one: one if isinstance(one, str) else one.title,
)
def test_texts_keep_clear_of_each_other(machine: str | Machine) -> None:
    analysis = analysis_of(machine) if isinstance(machine, str) else eq.analyze(machine, 180)
    figures = drawn(machine) if isinstance(machine, str) else drawings(analysis)
    for name, figure in figures.items():
        check_texts(name, figure)


def test_the_same_bytes_on_every_run() -> None:
    again = drawings(eq.analyze(eq.load("yamashita-1"), 360))
    for name, figure in drawn("yamashita-1").items():
        assert render(figure, "svg") == render(again[name], "svg"), name


def test_a_couple_of_rounding_is_zero() -> None:
    figure = joints_figures(eq.analyze(eq.load("slider-crank-engine"), 90))[0]
    assert "zero at every crank angle" in words(figure)
    panel = next(axes for axes in figure.axes if "couple" in axes.get_ylabel())
    assert not np.any(np.asarray(panel.get_lines()[0].get_ydata()))


@pytest.mark.parametrize("of_one", [False, True])
def test_a_moving_picture_says_whose_force_it_is(of_one: bool) -> None:
    found = eq.analyze(eq.load("four-row-transplanter"), 60)
    arrow = Arrow(found.forces.about, found.forces.shaking_force.value, of_one)
    told = [label.text for label in laid_out(Scene.of(found.motion), arrow=arrow).labels]
    (force,) = (text for text in told if text.startswith("shaking force"))
    assert ("of one row" in force) == of_one
    assert f"{np.max(np.abs(arrow.force)):.4g} N" in force
