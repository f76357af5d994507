"""Charts of hand-held tools: along the shaft, over the engine's speed, of studies and a design."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from equipoise.exposure.daily import partial_exposure
from equipoise.exposure.weighting import factor
from equipoise.figures import tool_charts, tool_side
from equipoise.handheld.design import Before, ToolDesign
from equipoise.handheld.frequencies import scale_of
from equipoise.handheld.hand_exposure import expose_tool, grips
from equipoise.handheld.model import changed
from equipoise.handheld.modes import determinant_chart, vary_tool, vibrate_tool
from equipoise.handheld.response import respond_tool
from equipoise.handheld.shaft import KEYS
from equipoise.handheld.sweep import transmit
from equipoise.i18n import Note
from equipoise.results.charts import Curve, Panel
from equipoise.schema.models import load_tool
from equipoise.symbols.shapes import Shape
from unit.figures.checks import check, views
from unit.figures.samples import words
from unit.figures.tool_samples import SPEEDS, machine, pictures

RPM = 30 / np.pi


def curves(panel: Panel, role: str) -> list[Curve]:
    return [curve for curve in panel.curves if curve.role == role]


def marks(panel: Panel, role: str) -> list[tuple[float, float]]:
    return [(mark.x, mark.y) for mark in panel.marks if mark.role == role and mark.sign]


def test_names_in_order() -> None:
    names = [
        "side",
        "side-modes",
        "modes",
        "determinant",
        "variation",
        "transmission",
        "acceleration",
        "exposure",
    ]
    assert list(pictures("paper")) == [*names, "moment"]
    assert {"modes-2", "modes-lateral", "transmission-lateral"} <= pictures("cutter").keys()


def test_a_speed_that_stands_alone() -> None:
    tool, speed = machine("paper"), np.array([700.0])
    drawn = tool_charts.transmission_charts(transmit(tool, speed))
    drawn |= tool_charts.exposure_charts(expose_tool(tool, speed))
    for chart in drawn.values():
        check(chart)
        x = chart.panels[0].x
        assert x.low is not None and x.high is not None and x.low < 700 < x.high


# -- along the shaft -------------------------------------------------------------------------------


def test_shapes_with_stations_and_nodes() -> None:
    tool = machine("paper")
    modes = vibrate_tool(tool, 5)
    plane, panels = modes.planes[0], pictures("paper")["modes"].panels
    for panel, shape, nodes in zip(panels, plane.shapes, plane.nodes, strict=True):
        (curve,) = curves(panel, "shape")
        np.testing.assert_allclose(curve.x, modes.places)
        np.testing.assert_allclose(curve.y, shape)
        assert [x for x, _ in marks(panel, "node")] == pytest.approx(list(nodes))
        for role, names in (
            ("hand", ["handle"]),
            ("harness or ground", ["harness"]),
            ("station", ["engine", "cutter"]),
        ):
            at = [tool.station(name).position for name in names]
            expected = [(x, np.interp(x, modes.places, shape)) for x in at]
            np.testing.assert_allclose(marks(panel, role), expected)
        assert [line.at for line in panel.lines] == [station.position for station in tool.stations]


def test_frequencies_of_the_paper_are_reported() -> None:
    reported = words(pictures("paper")["modes"])
    for number, frequency in enumerate(("1.238", "2.413", "4.418", "6.290", "9.400"), 1):
        assert f"λ = {frequency}" in reported and f"mode {number}" in reported
    assert "54.47 Hz\n3268 1/min" in reported
    assert all(
        name in reported for name in ("engine", "harness", "handle", "cutter", "both planes")
    )
    assert "place on the shaft from its left end, mm" in reported
    free = words(pictures("loose")["modes"])
    assert "free:\nmoves to and fro" in free and "free:\nturns about its\nleft end" in free
    assert "lateral plane" in words(pictures("loose")["modes-lateral"])


def test_many_modes_and_many_names() -> None:
    assert [len(pictures("cutter")[name].panels) for name in ("modes", "modes-2")] == [4, 4]
    assert "(5 to 8 of 8)" in words(pictures("cutter")["modes-2"])
    flags = [flag.texts[0] for flag in pictures("crowded")["modes"].panels[0].flags]
    assert len(flags) == tool_charts.MOST_NAMES
    assert {"engine", "cutter", "handle", "station number 7"} <= {*flags}
    bare = replace(machine("loose"), stations=(), excitations=())
    chart = tool_charts.mode_charts(vibrate_tool(bare, 3))["modes"]
    check(chart)
    assert "station" not in words(chart) and "mode 3" in words(chart)


def test_the_moment_along_the_shaft() -> None:
    tool = machine("cutter")
    assert tool.operation is not None
    first = respond_tool(tool, tool.operation.speed)
    moment, shape = pictures("cutter")["moment"].panels
    assert (moment.y.text, shape.y.text) == ("moment, N m", "displacement, mm")
    (total,) = curves(moment, "strong")
    line = first.line(total.x)
    squares = np.sum(np.abs(line.moment[..., 0]) ** 2, axis=1) / 2
    np.testing.assert_allclose(total.y, np.sqrt(np.sum(squares, axis=1)), rtol=1e-6)
    reported = words(pictures("cutter")["moment"])
    assert f"{np.max(total.y):.4g} N m at " in reported and "7500 rpm" in reported
    assert "order 1" in reported and "lateral plane" in reported
    k = int(np.flatnonzero(first.orders == 1)[0])
    for plane, curve in enumerate(curves(shape, "kind 0")):
        amplitude = np.abs(line.displacement[:, plane, k, 0])
        assert np.all(np.abs(curve.y) <= amplitude * (1 + 1e-6) + 1e-12)
        at = np.argmax(amplitude)
        assert curve.y[at] == pytest.approx(amplitude[at], rel=0.01)
    for kind in ("paper", "loose"):  # planes do the same; shaken up and down only
        assert len(curves(pictures(kind)["moment"].panels[1], "kind 0")) == 1
    assert "lateral plane" not in words(pictures("paper")["moment"])


def test_at_which_speed() -> None:
    tool = machine("paper")
    assert tool.operation is not None
    response = respond_tool(tool, SPEEDS)
    assert tool_charts.speed_shown(response) == tool.operation.speed
    away = respond_tool(tool, np.linspace(100, 300, 30))
    loudest = away.speed[np.argmax(grips(away)["handle"].a_hv)]
    assert tool_charts.speed_shown(away) == pytest.approx(loudest)
    assert tool_charts.speed_shown(respond_tool(tool, 200.0)) == 200.0
    assert (
        SPEEDS[0] <= tool_charts.speed_shown(respond_tool(machine("loose"), SPEEDS)) <= SPEEDS[-1]
    )
    assert "2865 rpm" in words(tool_charts.response_charts(response, 300.0)["moment"])
    assert tool_charts.rpm_text(1200.0) == "11459" and tool_charts.rpm_text(3.0) == "28.65"


# -- studies ---------------------------------------------------------------------------------------


def test_the_determinant_has_its_zeros_marked() -> None:
    tool = machine("paper")
    modes = vibrate_tool(tool, 3)
    chart = determinant_chart(tool, 8.0, 400)
    drawn = tool_charts.determinant_charts(chart, modes)["determinant"]
    (panel,) = drawn.panels
    np.testing.assert_array_equal(panel.curves[0].y, chart.value[0])
    actual = [x for x, _ in marks(panel, "zeros")]
    assert actual[:3] == pytest.approx(modes.planes[0].parameter.tolist())
    assert actual[3:] == pytest.approx([6.290], abs=0.01)  # of the chart: no mode is known there
    assert "4.418" in words(drawn)
    titles = [item.title for item in pictures("cutter")["determinant"].panels]
    assert titles == ["vertical plane", "lateral plane"]
    x, y = np.array([1.0, 2.0, 3.0, 4.0]), np.array([1.0, -1.0, -1.0, 3.0])
    assert tool_charts.zeros_of(x, y, np.array([0.0, 1.4, 9.0])) == [1.4]
    assert tool_charts.zeros_of(x, y, np.array([0.0, 1.4])) == [1.4, 3.25]


def test_frequencies_against_a_number() -> None:
    tool = machine("paper")
    variation = vary_tool(tool, "harness", "harness.stiffness", np.geomspace(1e3, 1e6, 7), 3)
    chart = tool_charts.variation_charts(variation)["variation"]
    (panel,) = chart.panels
    assert panel.x.scale == "log" and panel.y.text == "natural frequency, 1/min"
    assert panel.x.text == "stiffness of the harness at harness, kN/m"
    for curve, row in zip(panel.curves, variation.parameter[0].T, strict=True):
        np.testing.assert_allclose(curve.y, row)
    harness = tool.station("harness").harness
    assert harness is not None and panel.lines[0].at == pytest.approx(harness.stiffness[0])
    assert "now 46.48 kN/m" in words(chart) and "both planes" in words(chart)
    position = vary_tool(tool, "handle", "position", np.linspace(0.1, 1.4, 5))
    (panel,) = tool_charts.variation_charts(position)["variation"].panels
    assert panel.x.scale == "linear" and panel.x.text == "position of handle, mm"
    assert panel.right_axis is not None and panel.right_axis.text == "λ"
    top = float(np.max(position.parameter))
    beside = panel.right_axis.ticks or ()
    assert 4 <= len(beside) <= 10 and all(at == float(text) <= 1.06 * top for at, text in beside)
    ticks = panel.y.ticks
    assert ticks is not None and len(ticks) >= 5
    for place, minute in ticks:
        assert scale_of(tool) * place**2 * RPM == pytest.approx(float(minute))
    assert tool.operation is not None
    level = next(line.at for line in panel.lines if line.axis == "y")
    assert scale_of(tool) * level**2 == pytest.approx(tool.operation.speed)
    ground = vary_tool(tool, "engine", "rotational_stiffness", np.array([1.0, 2.0]), 2)
    reported = words(tool_charts.variation_charts(ground)["variation"])
    assert (
        "rotational stiffness of engine to the ground, N m/rad" in reported
        and "now" not in reported
    )


def test_planes_that_differ_in_a_variation() -> None:
    chart = pictures("cutter")["variation"]
    assert [len(curves(chart.panels[0], f"several {k}")) for k in (1, 2)] == [6, 6]
    reported = words(chart)
    assert "stiffness of the absorber at front-handle, kN/m" in reported
    assert (
        "lateral plane" in reported and "now 61.7 kN/m" in reported and "work, 7500 rpm" in reported
    )
    assert all(tool_charts.number_unit(dimension).name for dimension in KEYS.values())


# -- over speed ------------------------------------------------------------------------------------


def test_transmission_of_each_station() -> None:
    transmission = transmit(machine("paper"), SPEEDS)
    chart = pictures("paper")["transmission"]
    size, phase = chart.panels
    assert (size.y.scale, size.y.text, phase.y.text) == ("log", "force ratio", "phase, deg")
    for number, station in enumerate(transmission.stations.values()):
        (curve,) = curves(size, f"kind {number}")
        np.testing.assert_allclose(curve.y, station.size[0])
        (curve,) = curves(phase, f"kind {number}")
        there = np.isfinite(curve.y)
        np.testing.assert_allclose(curve.y[there], station.phase[0])
        assert np.sum(~there) == np.sum(np.abs(np.diff(station.phase[0])) > np.pi)
        quiet = marks(size, f"quiet speed {number}")
        assert [x for x, _ in quiet] == pytest.approx(station.quiet[0].tolist())
        for x, y in quiet:  # on the curve
            near = station.size[0][np.argsort(np.abs(SPEEDS - x))[:2]]
            assert min(near) <= y <= max(near)
    reported = words(chart)
    assert (
        "6134" in reported
        and "quiet speed, rpm" in reported
        and "speed of the engine, rpm" in reported
    )
    assert "work, 7000 rpm" in reported and "unit force at engine" in reported
    modes = vibrate_tool(machine("paper"), 5).planes[0].frequency
    inside = [mode for mode in modes if SPEEDS[0] <= mode <= SPEEDS[-1]]
    for panel in chart.panels:
        assert [line.at for line in panel.lines if line.role == "natural"] == pytest.approx(inside)
    assert "natural frequency" not in words(
        tool_charts.transmission_charts(transmission)["transmission"]
    )


def test_acceleration_and_what_is_allowed() -> None:
    exposure = expose_tool(machine("paper"), SPEEDS)
    chart = pictures("paper")["acceleration"]
    (panel,) = chart.panels
    assert panel.y.text == "RMS, m/s²" and panel.y.scale == "log"
    (curve,) = curves(panel, "kind 0")
    np.testing.assert_allclose(curve.y, np.hypot(*exposure.grips["handle"].acceleration))
    assert tool_charts.duration_of(exposure) == 2.5 * 3600
    for role, a8 in (("action", 2.5), ("limit", 5.0)):
        (line,) = curves(panel, role)
        for each in (line.y * factor(line.x / (2 * np.pi))).tolist():
            assert partial_exposure(each, 2.5 * 3600) == pytest.approx(a8)
    assert "2.5 h a day" in words(chart) and " m/s² at 7" in words(chart)
    undamped = expose_tool(load_tool("nagamine-irie"), SPEEDS)
    assert " m/s² at " not in words(tool_charts.exposure_charts(undamped)["acceleration"])


def test_exposure_and_levels() -> None:
    exposure = expose_tool(machine("cutter"), SPEEDS)
    chart = pictures("cutter")["exposure"]
    for number, grip in enumerate(exposure.grips.values()):
        (curve,) = curves(chart.panels[0], f"kind {number}")
        np.testing.assert_allclose(curve.y, grip.a_hv)
    hours = tool_charts.duration_of(exposure) / 3600
    flat = [curves(chart.panels[0], role)[0].y[0] for role in ("action", "limit")]
    assert flat == pytest.approx([2.5 * np.sqrt(8 / hours), 5 * np.sqrt(8 / hours)])
    limit = flat[1]
    for stretch, grip in zip(
        curves(chart.panels[0], "broken stretch"), exposure.grips.values(), strict=False
    ):
        np.testing.assert_allclose(stretch.y, np.where(grip.a_hv > limit, grip.a_hv, np.nan))
    reported = words(chart)
    assert "above the limit value of 5 m/s²" in reported
    assert f"A(8) = {exposure.a8:.4g} m/s² at {exposure.worst}" in reported
    assert "limit: A(8) of 5 m/s²" in reported and "action: A(8) of 2.5 m/s²" in reported
    assert all(text in reported for text in ("rear-grip", "front-handle", "work, 7500 rpm"))
    idle = expose_tool(replace(machine("paper"), work=(), operation=None), SPEEDS)
    assert tool_charts.levels(idle) == {"action": 2.5, "limit": 5.0}
    reported = words(tool_charts.exposure_charts(idle)["exposure"])
    assert "8 h a day" in reported and "A(8) =" not in reported and "work," not in reported
    for name in ("exposure", "transmission"):
        assert "quieter ones" in words(pictures("crowded")[name])


# -- a design --------------------------------------------------------------------------------------


@cache
def designed() -> ToolDesign:
    """As if a search had put the belt elsewhere."""
    tool = load_tool("brush-cutter")
    assert tool.design is not None
    better = changed(replace(tool, design=None), "belt", "position", 0.4)
    speed = np.linspace(*tool.design.speeds, 41)
    felt = [grips(respond_tool(item, speed)) for item in (tool, better)]
    a_hv = np.array([np.max([grip.a_hv for grip in item.values()], axis=0) for item in felt])
    sizes = (np.sqrt(np.mean(a_hv**2, axis=1)), np.max(a_hv, axis=1))
    texts = [
        Note(f"total value a_hv of the worst hand, {which}")
        for which in ("RMS over the band", "largest")
    ]
    figures = tuple(
        Before(str(note), "acceleration", *size.tolist(), note)
        for note, size in zip(texts, sizes, strict=True)
    )
    variables = (
        Before("belt position", "length", 0.32, 0.4),
        Before("belt harness.stiffness", "stiffness", 1500.0, 5000.0),
    )
    return ToolDesign(tool, better, variables, figures, ("", "highest"), 8, 7, speed, a_hv)


def test_each_hand_before_and_after() -> None:
    design = designed()
    chart = tool_charts.design(design)
    check(chart)
    hands = [
        curves(chart.panels[0], f"kind {k}")
        for k in range(len(grips(respond_tool(design.better, 700.0))))
    ]
    for number, tool in enumerate((design.tool, design.better)):
        felt = grips(respond_tool(tool, design.speed))
        for pair, grip in zip(hands, felt.values(), strict=True):
            np.testing.assert_allclose(pair[number].y, grip.a_hv)
            assert pair[number].dashed == (number == 0)
        worst = np.max([pair[number].y for pair in hands], axis=0)
        np.testing.assert_allclose(worst, design.a_hv[number])
    text, figure = words(chart), design.figures[0]
    assert f"RMS over the band: {figure.before:.4g} → {figure.after:.4g} m/s²" in text
    assert "before" in text and "after" in text and "aₕᵥ (ISO 5349-1), m/s²" in text


def test_measures_and_many_changes() -> None:
    design = designed()
    assert design.tool.design is not None
    plan = replace(design.tool.design, measure="peak", hands=("rear-grip",))
    reported = words(tool_charts.design(replace(design, tool=replace(design.tool, design=plan))))
    assert "aₕᵥ of the worst hand, largest: " in reported
    assert "rear-grip" in reported and "front-handle:" not in reported
    count = 11
    edges = ("", "highest") * count
    many = tool_side.side_design(replace(design, variables=design.variables * 11, edges=edges))
    check(many)
    assert f"and {count - 7} more" in words(many) and "(highest allowed)" in words(many)


# -- from the side ---------------------------------------------------------------------------------


def test_a_tool_from_the_side_has_what_the_file_reports() -> None:
    """Tubes to scale, a body for each mass, four fingers for each hand, a belt, an absorber."""
    still, moving = pictures("cutter")["side"].panels
    tube = next(shape for shape in still.signs if shape.role == "rim")
    assert np.ptp(tube.places.real) == pytest.approx(1.5)
    assert np.ptp(tube.places.imag) == pytest.approx(0.026)
    roles = [shape.role for shape in still.signs]
    assert roles.count("stand") == 2 * 5 and roles.count("tie") == 1 and roles.count("spring") == 1
    edges = [np.ptp(shape.places.real) for shape in still.signs if shape.role == "rest"]
    tool = machine("cutter")
    for mass in (tool.station("engine").mass, tool.station("head").mass, 0.1):
        assert any(edge == pytest.approx((mass / 1000) ** (1 / 3)) for edge in edges)
    assert [flag.texts for flag in still.flags][1] == ("rear-grip", "180 mm")
    assert not moving.flags


def test_the_shaft_is_deflected_as_much_as_is_reported() -> None:
    """At work, of the loudest order, so many times; a mode to the size that is told."""
    tool, chart = machine("paper"), pictures("paper")["side"]
    panel = chart.panels[1]
    assert tool.operation is not None
    places = np.linspace(0, tool.shaft.length, 401)
    moved = respond_tool(tool, tool.operation.speed).line(places).displacement[:, 0, :, 0]
    order = int(np.argmax(np.max(np.abs(moved), axis=0)))
    assert panel.remark.startswith(f"order {(0.737, 1)[order]:g}, ")
    times = float(panel.remark.split("drawn ")[1].split(" times")[0])
    shaft = next(shape for shape in panel.signs if shape.role == "rim")
    largest = np.max(np.abs(shape_middle(shaft)))
    assert largest == pytest.approx(times * np.max(np.abs(moved[:, order])), rel=0.02)
    modes = pictures("paper")["side-modes"]
    assert "drawn as 77.2 mm" in modes.what
    for panel in modes.panels:
        shaft = next(shape for shape in panel.signs if shape.role == "rim")
        assert np.max(np.abs(shape_middle(shaft))) == pytest.approx(0.0772)


def shape_middle(shape: Shape) -> np.ndarray[tuple[int, ...], np.dtype[np.float64]]:
    """Heights of the middle line of a closed strip, m."""
    upper, lower = np.split(shape.places.imag, 2)
    return np.asarray((upper + lower[::-1]) / 2)


def test_what_a_design_moves_is_an_arrow() -> None:
    design = designed()
    chart = tool_side.side_design(design)
    check(chart)
    before, after = chart.panels
    assert [panel.title for panel in chart.panels] == ["before", "after"]
    assert not before.arrows
    # to one scale, with hands, belt and absorber whole
    shown = views(chart)
    first, second = (view.x.length / (view.x.high - view.x.low) for view in shown)
    assert first == pytest.approx(second)
    for view in shown:
        left, top, right, bottom = view.box
        for shape in view.panel.signs:
            x, y = view.places(shape.places.real, shape.places.imag).T
            assert left - 1 <= x.min() and x.max() <= right + 1, shape.role
            assert top - 1 <= y.min() and y.max() <= bottom + 1, shape.role
    (arrow,) = after.arrows
    assert (arrow.tail.real, arrow.head.real) == pytest.approx((0.32, 0.4))
    assert "320 → 400 mm" in words(chart)
    assert chart.words == ("stiffness of the harness at belt: 1.5 → 5 kN/m (highest allowed)",)
