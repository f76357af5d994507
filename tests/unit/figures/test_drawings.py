"""Drawings of machines: the linkage, both paths of a planting finger, and modes of a support."""

from __future__ import annotations

import subprocess
import sys
from functools import cache

import numpy as np
import pytest

import equipoise as eq
from equipoise.errors import UsageError
from equipoise.figures import pictures_of
from equipoise.figures.animation import laid_out
from equipoise.figures.linkage import linkage
from equipoise.figures.modes import SHOWN_SIZE, ModeShape, described
from equipoise.figures.planting import Paths, path
from equipoise.figures.stage import ForceArrow
from equipoise.planting.summary import plant
from equipoise.results.analysis import Analysis
from equipoise.results.charts import Chart
from equipoise.symbols.scene import Scene
from equipoise.vibration.response import Mode
from support.refusals import refused
from unit.figures.checks import views
from unit.figures.samples import BUNDLED, read_off, words
from unit.figures.vibration_samples import MACHINES, falling, rig, space


@cache
def analysis_of(name: str) -> Analysis:
    return eq.analyze(eq.load(name), 360)


def test_the_linkage_at_chosen_angles() -> None:
    analysis = analysis_of("yamashita-1")
    angles = [0.0, 1.0, 7.5]
    chart = linkage(analysis, angles)
    pins = analysis.motion.linkage.joints.pins
    for panel, angle in zip(chart.panels, angles, strict=True):
        motion = eq.move(analysis.machine, [angle])
        dots = np.array([shape.places[0] for shape in panel.signs if shape.role == "pin"])
        for pin in pins:
            assert np.min(np.abs(dots - motion.points[pin].place[0])) < 1e-12
        assert [mark.text for mark in panel.marks] == [*motion.points]
        assert panel.title == f"{np.degrees(angle):.4g}°"
    single = words(linkage(analysis))
    assert all(link in single for link in analysis.machine.links)
    for wrong in ([], np.zeros(25)):
        with refused(UsageError, most=24):
            linkage(analysis, wrong)


def test_every_path_is_drawn_closed() -> None:
    analysis = analysis_of("watt-six-bar")
    (panel,) = linkage(analysis).panels
    places = [analysis.motion.points[name].place for name in "BCEF"]
    for curve, place in zip(panel.curves, places, strict=True):
        np.testing.assert_array_equal(curve.x + 1j * curve.y, np.append(place, place[0]))


@pytest.mark.parametrize(
    ("name", "named", "beyond"),
    [
        ("sieve", ["stand\nstand_along", "front_up\nfront_along", "back_up\nback_along"], ""),
        (
            "yamashita-rig",
            ["gauge", "spring"],
            "pivot, bearing (−1340, 0) mm; centre of mass (−590",
        ),
        ("walking-transplanter", ["planting_part", "float"], "handle_along (−700, 450) mm"),
    ],
)
def test_what_holds_a_linkage_is_named_or_reported(
    name: str, named: list[str], beyond: str
) -> None:
    chart = linkage(analysis_of(name))
    assert {*named} <= {mark.text for mark in chart.panels[0].marks}
    assert (beyond in chart.words[-1]) if beyond else not chart.words
    assert {"support", "gauge"} < {role for role, _ in chart.keys}
    drawn = [shape.role for panel in chart.panels for shape in (*panel.ground, *panel.signs)]
    assert {role for role, _ in chart.keys} <= {*drawn}
    shown = words(chart)
    assert all(text.split("\n")[0] in shown for text in named)


def test_soil_and_tray_are_in_the_picture_and_its_legend() -> None:
    chart = linkage(analysis_of("transplanter"))
    assert {("soil", "soil"), ("tray", "tray")} <= {*chart.keys}
    (soil,) = (shape for shape in chart.panels[0].ground if shape.role == "soil")
    tip = analysis_of("transplanter").motion.points["P"].place
    assert np.max(soil.places.imag) == pytest.approx(np.min(tip.imag) + 0.04, abs=1e-3)
    assert [shape.role for shape in chart.panels[0].signs].count("tray") == 1


@pytest.mark.parametrize("of_one", [False, True])
def test_a_moving_picture_says_whose_force_it_is(of_one: bool) -> None:
    analysis = eq.analyze(eq.load("four-row-transplanter"), 60)
    arrow = ForceArrow(analysis.forces.about, analysis.forces.shaking_force.value, of_one)
    texts = [label.text for label in laid_out(Scene.of(analysis.motion), arrow=arrow).labels]
    (force,) = (text for text in texts if text.startswith("shaking force"))
    assert ("of one row" in force) == of_one
    assert f"{np.max(np.abs(arrow.force)):.4g} N" in force


# -- paths of a planting finger --------------------------------------------------------------------


def test_soil_reaches_both_sides_of_a_path() -> None:
    for panel in path(plant(eq.load("rotary-transplanter"))).panels:
        assert panel.always_shown is not None
        ends = [corner.real for corner in panel.always_shown]
        (earth,) = (shape for shape in panel.ground if shape.role == "soil")
        sides = np.real(earth.places)
        assert sides.min() < ends[0] and sides.max() > ends[1]


def test_both_paths_are_drawn_to_one_scale() -> None:
    for name in BUNDLED:
        machine, ground = views(path(read_off(name)))
        assert (machine.y.low, machine.y.high) == pytest.approx((ground.y.low, ground.y.high))
        scales = [
            scale.length / (scale.high - scale.low)
            for view in (machine, ground)
            for scale in (view.x, view.y)
        ]
        assert scales == pytest.approx([scales[0]] * 4)


@pytest.mark.parametrize("name", BUNDLED)
def test_paths_are_the_motion(name: str) -> None:
    machine = eq.load(name)
    paths, figures = Paths(read_off(name)), read_off(name)
    place = eq.move(machine, paths.sense * paths.ways).points["P"].place
    time = paths.ways / abs(machine.drive.speed)
    ground = place + 0.6 * time
    drawn_there = paths.over_ground(paths.ways)
    np.testing.assert_allclose(drawn_there.imag, ground.imag, atol=1e-12)
    np.testing.assert_allclose(np.diff(drawn_there), np.diff(ground), atol=1e-12)
    lowest = drawn_there[np.argsort(drawn_there.imag)]
    near_hill = np.minimum(abs(lowest[:2].real), abs(lowest[:2].real - figures["hill_spacing"]))
    assert np.all(near_hill < 2e-3)
    for cross in paths.crossings():
        assert np.sum(np.abs(drawn_there - cross) < 2e-3) >= 2


def test_without_travel_there_is_no_ground_panel() -> None:
    still = plant(eq.load("kim-chung-a").with_planting(forward_speed=0.0))
    chart = path(still)
    assert len(chart.panels) == 1
    assert "over ground" not in words(chart)
    assert len(path(read_off("kim-chung-a")).panels) == 2


def test_the_machine_is_drawn_at_the_lowest_point() -> None:
    figures = read_off("kim-chung-a")
    motion = eq.move(figures.machine, [figures["lowest.crank_angle"]])
    pins = [sign.places[0] for sign in path(figures).panels[0].signs if sign.role in ("pin", "dot")]
    for point in motion.points.values():
        assert np.min(np.abs(np.array(pins) - point.place[0])) < 1e-12


def test_matplotlib_waits_until_it_is_needed() -> None:
    program = (
        "import sys, equipoise as eq, equipoise.cli\n"
        "from equipoise.planting.summary import plant\n"
        "plant(eq.load('kim-chung-a'))\n"
        "assert not any(name.startswith('matplotlib') for name in sys.modules)\n"
        "import equipoise.figures.animation, equipoise.figures.planting\n"
        "from equipoise.figures import render\n"
        "analysis = eq.analyze(eq.load('kim-chung-a'))\n"
        "from equipoise.figures.motion import curves\n"
        "from equipoise.figures.linkage import linkage\n"
        "assert all(render(draw(analysis)).startswith(b'<svg') for draw in (curves, linkage))\n"
        "assert not any(name.startswith('matplotlib') for name in sys.modules)\n"
    )
    subprocess.run([sys.executable, "-c", program], check=True)


# -- modes -----------------------------------------------------------------------------------------


@cache
def modes_of(kind: str) -> dict[str, Chart]:
    return pictures_of(eq.modes(MACHINES[kind]()))


def test_modes_are_reported() -> None:
    mode = eq.modes(rig()).modes[0]
    shown = words(modes_of("rig")["mode-1"])
    assert f"{mode.cycles_per_second:.4g} Hz, {mode.natural_frequency:.4g} rad/s" in shown
    assert f"damping ratio {mode.damping_ratio:.4g}" in shown and "pitch 1 rad" in shown
    kinds = [described(mode) for mode in eq.modes(falling()).modes]
    assert kinds[0] == "free, without a spring"
    assert "unstable" in kinds[2] and "overdamped" in kinds[3]
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


def test_a_support_that_is_a_point_is_as_large_as_its_linkage() -> None:
    machine = eq.load("exudyn-slider-crank")
    low, high = Scene.of(eq.move(machine, 72)).linkage_box
    (view,) = views(pictures_of(eq.modes(machine))["mode-1"])
    assert 0.1 < (view.x.high - view.x.low) / 1e3 / abs(high - low) < 1


def test_what_is_at_one_place_is_named_at_its_own_sign() -> None:
    (panel,) = pictures_of(eq.modes(eq.load("exudyn-slider-crank")))["mode-1"].panels
    assert [mark.text for mark in panel.marks] == ["x", "y", "along", "across"]


def test_signs_that_some_font_has_are_written(monkeypatch: pytest.MonkeyPatch) -> None:
    """Whatever the font is called; where none has them, they are told."""
    from equipoise.figures import paint

    signs = frozenset("クランク")
    paint.fonts_for.cache_clear()
    actual, lost = paint.fonts_for(signs)
    assert set(lost) <= set(signs)
    assert not any("Last Resort" in name for name in actual)
    own = [font for font in paint.font_manager.fontManager.ttflist if font.name == "DejaVu Sans"]
    monkeypatch.setattr(paint.font_manager.fontManager, "ttflist", own)
    monkeypatch.setattr(paint.font_manager, "findSystemFonts", list)
    monkeypatch.setattr(paint, "_families", lambda: ["DejaVu Sans", "sans-serif"])
    paint.fonts_for.cache_clear()
    assert paint.fonts_for(signs) == ((), "".join(sorted(signs)))
    assert paint.fonts_for(frozenset("crank, é")) == ((), "")
    monkeypatch.setattr(paint, "_signs_of", lambda path: frozenset(map(ord, "クランク")))
    paint.fonts_for.cache_clear()
    assert paint.fonts_for(signs)[1] == ""
    paint.fonts_for.cache_clear()
