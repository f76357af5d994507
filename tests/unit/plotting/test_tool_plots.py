"""Pictures of hand-held tools: what they draw is what was found, and texts keep clear."""

from __future__ import annotations

import os
import subprocess
import sys
from dataclasses import replace
from functools import cache
from itertools import product
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
from matplotlib.axes import Axes

from equipoise.exposure.daily import partial_exposure
from equipoise.exposure.weighting import factor
from equipoise.handheld.design import Before, ToolDesign
from equipoise.handheld.design_plan import KEYS
from equipoise.handheld.exposed import expose_tool, grips
from equipoise.handheld.frequencies import scale_of
from equipoise.handheld.modes import vibrate_tool
from equipoise.handheld.response import respond_tool
from equipoise.handheld.studies import changed, determinant_chart, vary_tool
from equipoise.handheld.transmission import transmit
from equipoise.plotting.style import FAINT, INK, MAIN, STRESS, render
from equipoise.plotting.tool import (
    design_drawings,
    determinant_drawings,
    exposure_drawings,
    mode_drawings,
    response_drawings,
    transmission_drawings,
    variation_drawings,
)
from equipoise.plotting.tool.exposure import duration_of, levels
from equipoise.plotting.tool.response import speed_shown
from equipoise.plotting.tool.shaft import MOST
from equipoise.plotting.tool.speeds import turns
from equipoise.plotting.tool.studies import UNITS, zeros_of
from equipoise.schema.tools import load_tool
from unit.figures.samples import words
from unit.figures.tool_samples import MACHINES, SPEEDS, drawn_anew, hashed, machine, pictures
from unit.figures.vibration_samples import check_texts

RPM = 30 / np.pi


def lines_of(axes: Axes, color: str, at_least: int = 3) -> list[np.ndarray]:
    """Points (N, 2) of the lines of a colour that are no marks."""
    return [
        np.asarray(line.get_xydata())
        for line in axes.get_lines()
        if line.get_color() == color
        and line.get_linestyle() != "None"
        and len(line.get_xdata()) >= at_least
    ]


def marks_of(axes: Axes, marker: str, color: str | None = None) -> list[tuple[float, float]]:
    return [
        (float(x), float(y))
        for line in axes.get_lines()
        if line.get_marker() == marker and color in (None, line.get_color())
        for x, y in np.asarray(line.get_xydata())
    ]


@cache
def designed() -> ToolDesign:
    """As if a search had put the belt elsewhere."""
    tool = load_tool("brush-cutter")
    assert tool.design is not None
    better = changed(replace(tool, design=None), "belt", "position", 0.4)
    speed = np.linspace(*tool.design.speeds, 41)
    felt = [grips(respond_tool(one, speed)) for one in (tool, better)]
    a_hv = np.array([np.max([grip.a_hv for grip in one.values()], axis=0) for one in felt])
    means, tops = np.sqrt(np.mean(a_hv**2, axis=1)), np.max(a_hv, axis=1)
    figures = (
        Before("a_hv of the worst hand, RMS over the band", "acceleration", *means.tolist()),
        Before("a_hv of the worst hand, largest", "acceleration", *tops.tolist()),
    )
    variables = (Before("belt position", "length", 0.32, 0.4),)
    return ToolDesign(tool, better, variables, figures, ("",), 8, 7, speed, a_hv)


# -- layout ----------------------------------------------------------------------------------------


@pytest.mark.parametrize("kind", MACHINES)
def test_texts_keep_clear_of_each_other(kind: str) -> None:
    for name, figure in pictures(kind).items():
        check_texts(f"{kind}: {name}", figure)
        for legend, axes in product(figure.legends, figure.axes):
            assert not legend.get_window_extent().overlaps(axes.get_window_extent()), name


def test_odd_names_are_no_formulas() -> None:
    for name, figure in pictures("odd names").items():
        svg = "".join(ElementTree.fromstring(render(figure, "svg")).itertext())
        assert "costs $5 and " in svg, name


def test_names_in_order() -> None:
    speeds = ["acceleration", "exposure", "moment"]
    alike = ["modes", "determinant", "variation", "transmission", *speeds]
    assert list(pictures("paper")) == alike
    modes = ["modes", "modes-2", "modes-lateral", "modes-lateral-2", "determinant", "variation"]
    apart = [*modes, "transmission", "transmission-lateral", *speeds]
    assert list(pictures("cutter")) == apart


def test_the_same_bytes_on_every_run() -> None:
    again = drawn_anew("paper")
    for name, figure in pictures("paper").items():
        assert render(figure, "svg") == render(again[name], "svg"), name
    for kind in ("png", "pdf"):
        both = (drawn["determinant"] for drawn in (pictures("paper"), again))
        assert len({render(figure, kind) for figure in both}) == 1


def test_the_same_bytes_in_another_process() -> None:
    program = "from unit.figures.tool_samples import hashed\nprint(hashed())\n"
    run = subprocess.run(
        [sys.executable, "-c", program],
        capture_output=True,
        check=True,
        text=True,
        env={
            **os.environ,
            "PYTHONHASHSEED": "7",
            "PYTHONPATH": str(Path(__file__).parents[2]),
        },
    )
    assert run.stdout.strip() == hashed()


def test_a_speed_that_stands_alone() -> None:
    tool = machine("paper")
    speed = np.array([700.0])
    drawn = transmission_drawings(transmit(tool, speed)) | exposure_drawings(
        expose_tool(tool, speed)
    )
    for name, figure in drawn.items():
        check_texts(name, figure)
        low, high = figure.axes[0].get_xlim()
        assert low < 700 * RPM < high


# -- modes -----------------------------------------------------------------------------------------


def test_shapes_with_stations_and_nodes() -> None:
    tool = machine("paper")
    modes = vibrate_tool(tool, 5)
    (plane, _), panels = modes.planes, pictures("paper")["modes"].axes
    for axes, shape, nodes in zip(panels, plane.shapes, plane.nodes, strict=True):
        (drawn,) = lines_of(axes, MAIN)
        np.testing.assert_allclose(drawn, np.column_stack([1e3 * modes.places, shape]))
        assert [x for x, _ in marks_of(axes, "x")] == pytest.approx([1e3 * one for one in nodes])
        for marker, names in (("s", ["handle"]), ("^", ["harness"]), ("o", ["engine", "cutter"])):
            at = [tool.station(name).position for name in names]
            expected = [(1e3 * x, np.interp(x, modes.places, shape)) for x in at]
            np.testing.assert_allclose(marks_of(axes, marker), expected)
        upright = [line.get_xdata()[0] for line in axes.get_lines() if axes_high(line)]
        assert upright == pytest.approx([1e3 * one.position for one in tool.stations])


def axes_high(line: object) -> bool:
    return list(line.get_ydata()) == [0, 1]  # type: ignore[attr-defined]


def test_frequencies_of_the_paper_are_told() -> None:
    told = words(pictures("paper")["modes"])
    for number, frequency in enumerate(("1.238", "2.413", "4.418", "6.290", "9.400"), 1):
        assert f"λ = {frequency}" in told and f"mode {number}" in told
    assert "54.47 Hz\n3268 1/min" in told
    assert "engine" in told and "harness" in told and "handle" in told and "cutter" in told
    assert "both planes" in told and "place on the shaft from its left end, mm" in told


def test_free_motions_are_named() -> None:
    told = words(pictures("loose")["modes"])
    assert "free:\nmoves to and fro" in told and "free:\nturns about its\nleft end" in told
    assert "vertical plane" in told and "lateral plane" in words(pictures("loose")["modes-lateral"])


def test_many_modes_and_many_names() -> None:
    assert len(pictures("cutter")["modes"].axes) == 6
    assert len(pictures("cutter")["modes-2"].axes) == 2
    assert "(7 to 8 of 8)" in words(pictures("cutter")["modes-2"])
    texts = [text for text in pictures("crowded")["modes"].texts if text.get_rotation() == 90]
    assert len(texts) == MOST
    told = {text.get_text() for text in texts}
    assert {"engine", "cutter", "handle", "station number 7"} <= told
    level = [text for text in pictures("paper")["modes"].texts if text.get_text() == "handle"]
    assert level[0].get_rotation() == 0


# -- studies ---------------------------------------------------------------------------------------


def test_the_determinant_has_its_zeros_marked() -> None:
    tool = machine("paper")
    modes = vibrate_tool(tool, 3)
    chart = determinant_chart(tool, 8.0, 400)
    figure = determinant_drawings(chart, modes)["determinant"]
    (axes,) = figure.axes
    (drawn,) = lines_of(axes, MAIN)
    np.testing.assert_array_equal(drawn, np.column_stack([chart.parameter, chart.value[0]]))
    found = [x for x, _ in marks_of(axes, "o")]
    assert found[:3] == pytest.approx(modes.planes[0].parameter.tolist())
    assert found[3:] == pytest.approx([6.290], abs=0.01)  # of the chart: no mode is known there
    assert "4.418" in words(figure)
    assert [axes.get_title(loc="left") for axes in pictures("cutter")["determinant"].axes] == [
        "vertical plane",
        "lateral plane",
    ]


def test_zeros_of_a_chart() -> None:
    x, y = np.array([1.0, 2.0, 3.0, 4.0]), np.array([1.0, -1.0, -1.0, 3.0])
    assert zeros_of(x, y, np.array([0.0, 1.4, 9.0])) == [1.4]
    assert zeros_of(x, y, np.array([0.0, 1.4])) == [1.4, 3.25]


def test_frequencies_against_a_number() -> None:
    tool = machine("paper")
    variation = vary_tool(tool, "harness", "harness.stiffness", np.geomspace(1e3, 1e6, 7), 3)
    figure = variation_drawings(variation)["variation"]
    axes, beside = figure.axes
    assert axes.get_xscale() == "log" and axes.get_ylabel() == "λ"
    assert axes.get_xlabel() == "stiffness of the harness at harness, kN/m"
    for line, row in zip(lines_of(axes, MAIN), variation.parameter[0].T, strict=True):
        np.testing.assert_allclose(line, np.column_stack([variation.values / 1e3, row]))
    now = [line.get_xdata()[0] for line in axes.get_lines() if line.get_color() == INK]
    assert now == pytest.approx([tool.station("harness").harness.stiffness[0] / 1e3])
    told = words(figure)
    assert "now 46.48 kN/m" in told and "both planes" in told
    assert beside.get_ylabel() == "natural frequency, 1/min"
    assert beside.get_ylim() == axes.get_ylim()


def test_the_right_axis_is_in_turns_a_minute() -> None:
    tool = machine("paper")
    variation = vary_tool(tool, "handle", "position", np.linspace(0.1, 1.4, 5))
    figure = variation_drawings(variation)["variation"]
    axes, beside = figure.axes
    assert axes.get_xscale() == "linear" and axes.get_xlabel() == "position of handle, mm"
    figure.draw_without_rendering()
    told = [(label.get_position()[1], label.get_text()) for label in beside.get_yticklabels()]
    assert len(told) >= 5
    for place, minute in told:
        assert scale_of(tool) * place**2 * RPM == pytest.approx(float(minute))
    level = [line.get_ydata()[0] for line in axes.get_lines() if list(line.get_xdata()) == [0, 1]]
    assert scale_of(tool) * level[0] ** 2 == pytest.approx(tool.operation.speed)


def test_planes_that_differ_in_a_variation() -> None:
    figure = pictures("cutter")["variation"]
    assert len(lines_of(figure.axes[0], STRESS)) == len(lines_of(figure.axes[0], MAIN)) == 6
    assert "stiffness of the absorber at front-handle, kN/m" in words(figure)
    assert "lateral plane" in words(figure) and "now 61.7 kN/m" in words(figure)
    assert "work, 7500 rpm" in words(figure)


def test_a_number_of_the_ground() -> None:
    tool = machine("paper")
    one = vary_tool(tool, "engine", "rotational_stiffness", np.array([1.0, 2.0]), 2)
    told = words(variation_drawings(one)["variation"])
    assert "rotational stiffness of engine to the ground, N m/rad" in told and "now" not in told


def test_every_number_has_a_unit() -> None:
    assert set(KEYS.values()) == set(UNITS)


# -- speeds ----------------------------------------------------------------------------------------


def test_transmission_of_each_station() -> None:
    tool = machine("paper")
    found = transmit(tool, SPEEDS)
    size, phase = pictures("paper")["transmission"].axes
    assert size.get_yscale() == "log" and size.get_ylabel() == "force ratio"
    assert phase.get_ylabel() == "phase, deg"
    for color, one in zip((MAIN, STRESS), found.stations.values(), strict=True):
        (drawn,) = lines_of(size, color)
        np.testing.assert_allclose(drawn, np.column_stack([SPEEDS * RPM, one.size[0]]))
        (drawn,) = lines_of(phase, color)
        there = np.isfinite(drawn[:, 1])
        np.testing.assert_allclose(drawn[there, 1], np.degrees(one.phase[0]))
        assert np.sum(~there) == np.sum(np.abs(np.diff(np.degrees(one.phase[0]))) > 180)
        quiet = marks_of(size, "v", color)
        assert [x for x, _ in quiet] == pytest.approx((one.quiet[0] * RPM).tolist())
        for x, y in quiet:  # on the curve
            near = one.size[0][np.argsort(np.abs(SPEEDS * RPM - x))[:2]]
            assert min(near) <= y <= max(near)
    told = words(pictures("paper")["transmission"])
    assert "6134" in told and "quiet speed, rpm" in told and "speed of the engine, rpm" in told
    assert "work, 7000 rpm" in told and "unit force at engine" in told


def test_modes_are_light_lines() -> None:
    found, modes = transmit(machine("paper"), SPEEDS), vibrate_tool(machine("paper"), 5)
    inside = [f for f in modes.planes[0].frequency if SPEEDS[0] <= f <= SPEEDS[-1]]
    for axes in pictures("paper")["transmission"].axes:
        light = [line for line in axes.get_lines() if axes_high(line)]
        at = [line.get_xdata()[0] for line in light if line.get_color() == FAINT]
        assert at == pytest.approx([f * RPM for f in inside])
    assert "natural frequency" not in words(transmission_drawings(found)["transmission"])


def test_acceleration_and_what_is_allowed() -> None:
    exposure = expose_tool(machine("paper"), SPEEDS)
    (axes,) = pictures("paper")["acceleration"].axes
    assert axes.get_ylabel() == "RMS, m/s²" and axes.get_yscale() == "log"
    (drawn,) = lines_of(axes, MAIN)
    grip = exposure.grips["handle"]
    np.testing.assert_allclose(drawn[:, 1], np.hypot(*grip.acceleration))
    assert duration_of(exposure) == 2.5 * 3600
    for line, a8 in zip(lines_of(axes, INK), (2.5, 5.0), strict=True):
        weighted = line[:, 1] * factor(line[:, 0] / 60)
        for each in weighted.tolist():
            assert partial_exposure(each, 2.5 * 3600) == pytest.approx(a8)
    assert "2.5 h a day" in words(pictures("paper")["acceleration"])


def test_exposure_and_levels() -> None:
    exposure = expose_tool(machine("cutter"), SPEEDS)
    figure = pictures("cutter")["exposure"]
    (axes,) = figure.axes
    for color, grip in zip((MAIN, STRESS), exposure.grips.values(), strict=True):
        (drawn,) = lines_of(axes, color)
        np.testing.assert_allclose(drawn, np.column_stack([SPEEDS * RPM, grip.a_hv]))
    hours = duration_of(exposure) / 3600
    flat = [line[0, 1] for line in lines_of(axes, INK)]
    assert flat == pytest.approx([2.5 * np.sqrt(8 / hours), 5 * np.sqrt(8 / hours)])
    told = words(figure)
    assert f"A(8) = {exposure.a8:.4g} m/s² at {exposure.worst}" in told
    assert (
        "rear-grip" in told
        and "front-handle" in told
        and "limit: A(8) of 5 m/s²" in told
        and "action: A(8) of 2.5 m/s²" in told
    )
    assert "work, 7500 rpm" in told


def test_eight_hours_where_no_work_is_told() -> None:
    tool = replace(machine("paper"), work=(), operation=None)
    exposure = expose_tool(tool, SPEEDS)
    assert levels(exposure) == {"action: A(8) of": 2.5, "limit: A(8) of": 5.0}
    drawn = exposure_drawings(exposure)["exposure"]
    assert "8 h a day" in words(drawn) and "A(8) =" not in words(drawn)
    assert "work," not in words(drawn)


def test_peaks_are_told_where_there_is_damping() -> None:
    assert " m/s² at 7" in words(pictures("paper")["acceleration"])
    undamped = expose_tool(load_tool("nagamine-irie"), SPEEDS)
    assert " m/s² at " not in words(exposure_drawings(undamped)["acceleration"])


def test_many_hands_and_thin_lines() -> None:
    assert "quieter ones" in words(pictures("crowded")["exposure"])
    assert "quieter ones" in words(pictures("crowded")["transmission"])


# -- moment ----------------------------------------------------------------------------------------


def test_the_moment_along_the_shaft() -> None:
    tool = machine("cutter")
    one = respond_tool(tool, tool.operation.speed)
    moment, shape = pictures("cutter")["moment"].axes
    assert moment.get_ylabel() == "moment, N m" and shape.get_ylabel() == "displacement, mm"
    (total,) = lines_of(moment, INK)
    line = one.line(total[:, 0] / 1e3)
    squares = np.sum(np.abs(line.moment[..., 0]) ** 2, axis=1) / 2
    np.testing.assert_allclose(total[:, 1], np.sqrt(np.sum(squares, axis=1)), rtol=1e-6)
    told = words(pictures("cutter")["moment"])
    assert f"{np.max(total[:, 1]):.4g} N m at " in told and "7500 rpm" in told
    assert "order 1" in told and "lateral plane" in told
    vertical, lateral = lines_of(shape, MAIN)
    k = int(np.flatnonzero(one.orders == 1)[0])
    for plane, drawn in enumerate((vertical, lateral)):
        amplitude = 1e3 * line.displacement[:, plane, k, 0]
        assert np.all(np.abs(drawn[:, 1]) <= np.abs(amplitude) * (1 + 1e-6) + 1e-9)
        at = np.argmax(np.abs(amplitude))
        assert drawn[at, 1] == pytest.approx(np.abs(amplitude[at]), rel=0.01)


def test_the_shape_is_drawn_once_where_planes_do_the_same() -> None:
    _, shape = pictures("paper")["moment"].axes
    assert len(lines_of(shape, MAIN)) == 1
    assert "lateral plane" not in words(pictures("paper")["moment"])
    _, shape = pictures("loose")["moment"].axes  # shaken up and down only
    assert len(lines_of(shape, MAIN)) == 1


def test_at_which_speed() -> None:
    tool = machine("paper")
    response = respond_tool(tool, SPEEDS)
    assert speed_shown(response) == tool.operation.speed
    away = respond_tool(tool, np.linspace(100, 300, 30))
    loudest = away.speed[np.argmax(grips(away)["handle"].a_hv)]
    assert speed_shown(away) == pytest.approx(loudest)
    assert speed_shown(respond_tool(tool, 200.0)) == 200.0
    assert SPEEDS[0] <= speed_shown(respond_tool(machine("loose"), SPEEDS)) <= SPEEDS[-1]
    assert "2865 rpm" in words(response_drawings(response, 300.0)["moment"])
    assert turns(1200.0) == "11459" and turns(3.0) == "28.65"


# -- design ----------------------------------------------------------------------------------------


def test_each_hand_before_and_after() -> None:
    found = designed()
    drawn_design = design_drawings(found)["design"]
    (axes,) = drawn_design.axes
    check_texts("design", drawn_design)
    both = [lines_of(axes, color) for color in (MAIN, STRESS)]
    for number, tool in enumerate((found.tool, found.better)):
        felt = grips(respond_tool(tool, found.speed))
        for before_after, grip in zip(both, felt.values(), strict=True):
            drawn = before_after[number]
            np.testing.assert_allclose(drawn, np.column_stack([found.speed * RPM, grip.a_hv]))
        worst = np.max([hand[number][:, 1] for hand in both], axis=0)
        np.testing.assert_allclose(worst, found.a_hv[number])
    told, change = words(drawn_design), found.variables[0]
    assert f"belt position: {1e3 * change.before:.4g} → {1e3 * change.after:.4g} mm" in told
    figure = found.figures[0]
    assert f"RMS over the band: {figure.before:.4g} → {figure.after:.4g} m/s²" in told
    assert "before" in told and "after" in told and "a_hv, m/s²" in told


def test_the_measure_that_was_asked_for_is_told() -> None:
    found = designed()
    assert found.tool.design is not None
    tool = replace(
        found.tool, design=replace(found.tool.design, measure="peak", hands=("rear-grip",))
    )
    told = words(design_drawings(replace(found, tool=tool))["design"])
    assert "a_hv of the worst hand, largest: " in told
    assert "rear-grip" in told and "front-handle" not in told


def test_many_changes() -> None:
    found = designed()
    many = replace(found, variables=found.variables * 11, edges=("", "highest") * 5 + ("",))
    figure = design_drawings(many)["design"]
    check_texts("design", figure)
    assert "and 4 more" in words(figure) and "(highest allowed)" in words(figure)


def test_a_bare_shaft() -> None:
    tool = replace(machine("loose"), stations=(), excitations=())
    figure = mode_drawings(vibrate_tool(tool, 3))["modes"]
    check_texts("bare", figure)
    assert "station" not in words(figure) and "mode 3" in words(figure)
