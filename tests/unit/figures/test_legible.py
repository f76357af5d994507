"""What makes pictures comparable by sight: scales, peaks, titles; over all bundled linkages."""

from __future__ import annotations

import re
from collections.abc import Iterator
from functools import cache
from itertools import combinations

import numpy as np
import pytest

import equipoise as eq
from equipoise.figures.forces import force, joint_polars, joints, polar, spectrum, torque
from equipoise.figures.layout import HALF, lay_out
from equipoise.figures.linkage import linkage
from equipoise.figures.modes import mode_chart
from equipoise.figures.motion import hodograph, main_kinematics
from equipoise.figures.sheet import Box, Canvas, CanvasStroke, Markers, Words, box_of
from equipoise.figures.tool_charts import mode_charts, weighted
from equipoise.figures.vector import svg_of
from equipoise.figures.vibration import spectra
from equipoise.figures.view import View
from equipoise.handheld.modes import vibrate_tool
from equipoise.i18n import speaking
from equipoise.results.charts import Axis, Chart, Curve, Panel
from equipoise.schema.models import load_tool
from equipoise.vibration.free import modes
from support.chosen import DISTINCT, few
from support.findings import findings_of
from unit.figures.checks import Laid, bars_afloat, texts_covered, texts_cut, views

LINKAGES = tuple(eq.examples("linkage"))
LARGER = re.compile(r"drawn (\S+) times as large")
LONG = "a title that goes on " * 12


@cache
def drawn(name: str) -> tuple[tuple[Chart, tuple[View, ...]], ...]:
    """Charts of the forces and the motion of an example, and where their panels are."""
    analysis = eq.analyze(eq.load(name))
    charts = [*main_kinematics(analysis)]
    if analysis.solved is not None:
        charts += [force(analysis), spectrum(analysis), torque(analysis)]
        charts += [*joints(analysis), *joint_polars(analysis)]
    return tuple((chart, tuple(views(chart))) for chart in charts)


def comparable(result: tuple[View, ...]) -> Iterator[tuple[View, View]]:
    """Panels of the same quantity; what is constant may be anywhere."""
    varying = [
        view
        for view in result
        if view.panel.bars
        or any(np.ptp(c.y) > 1e-9 * np.max(np.abs(c.y)) for c in view.panel.curves)
    ]
    for first, other in combinations(varying, 2):
        if first.panel.x.text == other.panel.x.text and first.y.axis.unit == other.y.axis.unit:
            yield first, other


def scale_of(view: View) -> float:
    """Points of a unit, where the panel were drawn no larger than others."""
    match = LARGER.search(view.panel.remark)
    larger = float(match[1]) if match else 1.0
    assert larger == 1 or larger >= 5
    return view.y.length / (view.y.high - view.y.low) / larger


@pytest.mark.exhaustive(but=["quick-return", "class-three"])
@pytest.mark.parametrize("name", few(LINKAGES, DISTINCT))
def test_one_scale_for_one_quantity(name: str) -> None:
    for chart, actual in drawn(name):
        for first, other in comparable(actual):
            same = scale_of(first) == pytest.approx(scale_of(other), rel=1e-6)
            assert same, (chart.name, first.panel.title, other.panel.title)


@pytest.mark.exhaustive(but=["slider-crank-engine", "quick-return", "hydraulic-loader"])
@pytest.mark.parametrize("name", LINKAGES)
def test_forces_have_one_unit(name: str) -> None:
    for chart, actual in drawn(name):
        if chart.name in {"force", "joints"}:
            axes = {(view.y.axis.label, view.y.axis.unit) for view in actual}
            assert len(axes) == len({label for label, _ in axes})


@pytest.mark.parametrize("name", LINKAGES)
def test_peaks_report_their_crank_angle(name: str) -> None:
    for chart, actual in drawn(name):
        if chart.name in {"force", "joints", "torque"}:
            texts = [mark.text for view in actual for mark in view.panel.marks]
            ends = ("°", " at every crank angle")
            assert all(text.endswith(ends) for text in texts), (chart.name, texts)


@pytest.mark.parametrize("name", ["yamashita-rig", "stephenson-six-bar"])
def test_numbers_at_bars_stay_below_titles_where_pictures_are_narrow(name: str) -> None:
    """And no word beside an axis is broken."""
    laid = Laid.of(spectrum(eq.analyze(eq.load(name))), HALF)
    for view, items in laid.panels:
        numbers = [item for item in items if isinstance(item, Words) and not item.turned]
        assert numbers and all(box_of(number)[1] >= view.box[1] for number in numbers)
    written = " ".join(words.text for words in laid.sheet.words if words.turned)
    assert {*written.replace(",", "").split()} <= {"amplitude", "N", "m"}


def test_a_small_signal_is_drawn_larger_and_reports_it() -> None:
    x = np.linspace(0.0, 1.0, 50)
    y = Axis.of("force", "force", [30.0], low=0.0, room=0.0)
    panels = tuple(Panel(Axis("x"), y, (Curve(x, size * x),)) for size in (30.0, 10.0, 2.9, 0.05))
    result = views(Chart("forces", "Machine", "Forces", panels, columns=2))
    assert [view.y.high for view in result] == pytest.approx([30, 30, 3, 0.06])
    texts = ["", "", "drawn 10 times as large", "drawn 500 times as large"]
    assert [view.panel.remark for view in result] == texts


def test_titles_and_names_of_axes_are_never_cut() -> None:
    x = np.linspace(0.0, 1.0, 5)
    panel = Panel(Axis(LONG), Axis(LONG[:60]), (Curve(x, x),), title=LONG, remark=LONG)
    for columns in (1, 2, 3):
        chart = Chart("long", LONG, LONG, (panel,) * 3, columns, False, words=(LONG,), foot=LONG)
        written = " ".join(words.text for words in lay_out(chart).words)
        assert "…" not in written
        assert written.count("goes") == 12 * 4 + 3 * (12 * 3 + 3)


def test_units_of_names_that_wrap_stay_whole() -> None:
    x = np.linspace(0.0, 1.0, 5)
    y = Axis.of("amplitude", "torque", x)
    panel = Panel(Axis("x"), y, (Curve(x, x),), height=46.0)
    words = [text.text for text in lay_out(Chart("one", "M", "what", (panel,))).words]
    assert "N" not in words and "m" not in words
    assert any(text.endswith("N m") for text in words)


def test_numbers_of_remarks_that_wrap_keep_their_units() -> None:
    x = np.linspace(0.0, 1.0, 5)
    y = Axis.of("drive torque", "torque", x)
    panel = Panel(Axis("x"), y, (Curve(x, x),), remark="mean 1.234 N m; RMS 5.678 N m " * 4)
    written = [text.text for text in lay_out(Chart("a", "M", "what", (panel,)), HALF).words]
    lines = [text for text in written if "RMS" in text or "mean" in text]
    assert len(lines) > 1 and sum(text.count(" N m") for text in lines) == 8


def test_sizes_on_a_logarithmic_axis_are_dots_and_no_bars() -> None:
    """A bar shows its size from 0, which such an axis does not have."""
    (chart, *_) = spectra(eq.respond(eq.load("yamashita-rig")))
    (panel,) = chart.panels
    assert panel.y.scale == "log" and panel.bars
    laid = Laid.of(chart)
    assert not [*bars_afloat(laid)]
    (dots,) = (item for _, items in laid.panels for item in items if isinstance(item, Markers))
    assert len(dots.places) == len(panel.bars[0].at)


def test_the_mean_of_a_spectrum_has_its_sign() -> None:
    """A mean below 0 is a bar that goes down, with its number below it; orders go up."""
    analysis = eq.analyze(eq.load("brush-cutter-engine")).resolved  # which its gas drives
    laid = Laid.of(spectrum(analysis))
    view = laid.panels[3][0]
    (bars,) = view.panel.bars
    mean = float(analysis.motion.mean(analysis.forces.drive_torque))
    assert mean < -1 and bars.size[0] == pytest.approx(mean, rel=1e-9)
    assert np.all(bars.size[1:] >= 0)
    assert view.y.low < mean
    (number,) = (word for word in laid.sheet.words if word.text == f"−{-mean:.2f}")
    assert box_of(number)[1] >= float(view.y.at(mean)) and box_of(number)[3] <= view.box[3]


def test_a_mean_of_rounding_takes_no_room_in_a_spectrum() -> None:
    """Whatever its sign: frame forces of a cycle without loads have none."""
    laid = Laid.of(spectrum(eq.analyze(eq.load("yamashita-1"))))
    for view, _ in laid.panels[:2]:
        (bars,) = view.panel.bars
        assert 0 <= bars.size[0] < 1e-9 * bars.size[1] and view.y.low == 0


def test_numbers_of_crank_angles_at_one_place_stand_together() -> None:
    """A force that does not turn is the same at all of them; one to and fro at two."""
    (chart,) = joint_polars(eq.analyze(eq.load("knife-drive")))
    shaft = next(panel for panel in chart.panels if panel.title == "S: frame on shaft")
    assert [mark.text for mark in shaft.marks] == ["0, 90, 180, 270"]
    assert "0, 90, 180, 270" in [word.text for word in lay_out(chart).words]
    (up, _) = hodograph(eq.analyze(eq.load("balance-shafts"))).panels
    assert [mark.text for mark in up.marks] == ["", "0", "90, 270", "180"]


def test_a_force_that_does_not_vary_has_its_value() -> None:
    (chart, *_) = joints(eq.analyze(eq.load("knife-drive")))
    panel = next(panel for panel in chart.panels if panel.title == "S: frame on shaft")
    value = panel.y.format_value(float(panel.curves[0].y[0]))
    assert [mark.text for mark in panel.marks] == [f"{value} at every crank angle"]


@pytest.mark.parametrize("name", ["hydraulic-loader", "yamashita-1"])
def test_the_unit_of_a_shaking_force_is_its_own(name: str) -> None:
    """However hard a cylinder pushes."""
    analysis = eq.analyze(eq.load(name))
    for chart in (force(analysis), polar(analysis), spectrum(analysis)):
        assert {view.y.axis.unit.name for view in views(chart)[:2]} == {"N"}, chart.name
    if name == "hydraulic-loader":
        assert torque(analysis).panels[0].y.unit.name == "kN"


@pytest.mark.parametrize("language", ["en", "de", "ja", "ko"])
def test_the_vibration_of_hands_is_named_on_its_axis(language: str) -> None:
    """What it is, its symbol in the standard and its unit."""
    exposure = findings_of("brush-cutter").exposure
    with speaking(language):
        axis = weighted(exposure).panels[0].y.text
    assert "aₕᵥ" in axis and "ISO 5349-1" in axis and "m/s²" in axis


# Names in modes: tests/unit/figures/test_vibration_charts.py.
@pytest.mark.exhaustive
@pytest.mark.parametrize("language", few(["en", "ja", "ko"], {"ja"}))
def test_no_label_of_a_mode_covers_another(language: str) -> None:
    """Of a support in space with nine mounts and gauges, and of a tool with numbered nodes."""
    with speaking(language):
        result = modes(eq.load("riding-transplanter"))
        charts = [mode_chart(result, number + 1) for number in range(len(result.modes))]
        charts += mode_charts(vibrate_tool(load_tool("brush-cutter"), 6)).values()
        for chart in charts:
            laid = Laid.of(chart)
            assert not [*texts_covered(laid), *texts_cut(laid)], chart.name
            names = [word.text for word in laid.sheet.words if word.text]
            assert len(names) > 10


@pytest.mark.parametrize("name", few(LINKAGES, {*DISTINCT, "straw-walker"}))
def test_names_of_joints_stand_at_them(name: str) -> None:
    """No more than about a letter's height and a half away, in a picture over all of a page; where
    a crank has five joints side by side, up to two and a half with a line that leads there.
    """
    for view, items in Laid.of(linkage(eq.analyze(eq.load(name), 72))).panels:
        boxes: dict[str, list[Box]] = {}
        leads = [item.lines[0][0] for item in items if isinstance(item, CanvasStroke)]
        for item in items:
            if isinstance(item, Words) and item.bold:
                boxes.setdefault(item.text, []).append(box_of(item))
        names = [mark for mark in view.panel.marks if mark.bold and mark.text]
        assert names
        for mark in names:
            ((x, y),) = view.places(mark.x, mark.y)
            away = [np.hypot(max(left - x, 0, x - right), max(top - y, 0, y - bottom))
                    for left, top, right, bottom in boxes[mark.text]]  # fmt: skip
            has_lead = any(np.hypot(*(lead - (x, y))) < 2.5 for lead in leads)
            assert min(away) < (20 if has_lead else 12), mark.text


def test_links_that_cover_each_other_are_shown_in_turn() -> None:
    """Four walkers lie within 100 mm of each other, over 2300 mm."""
    panels = linkage(eq.analyze(eq.load("straw-walker"), 72)).panels
    assert [panel.title for panel in panels] == [f"walker-{number}" for number in (1, 2, 3, 4)]
    for number, panel in enumerate(panels, 1):
        texts = {mark.text for mark in panel.marks}
        assert {text for text in texts if text.startswith("walker")} == {f"walker-{number}"}
        own = {"A", "D", f"F{number}", f"R{number}", f"T{number}"}
        assert {"front", "rear", *own} <= texts
        assert not {text for text in texts if text[0] in "FRT"} - own  # of walkers elsewhere
    assert len({panel.always_shown for panel in panels}) == 1  # at one scale
    for name in ("stephenson-six-bar", "cam-pusher", "twin-engine"):
        assert len(linkage(eq.analyze(eq.load(name), 72)).panels) == 1


def test_rings_are_round() -> None:
    """Each of two half circles, whose radius is half of their width as it is written."""
    for size in (2.6, 3.0, 4.5, 7.5, 8.25):
        sheet = Canvas(20.0, 20.0)
        sheet.add(Markers(np.array([(10.0, 10.0)]), "o", size, "#000000", "#000000"))
        (ring,) = re.findall(r"a([\d.]+),[\d.]+ 0 1,0 ([\d.]+),0a", svg_of(sheet))
        assert 2 * float(ring[0]) == pytest.approx(float(ring[1]), rel=1e-9)
