"""Every picture there is: drawn, nothing clipped or overlapping, axes named and numbered."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

import equipoise as eq
from equipoise.cli import run
from equipoise.figures import is_wide
from equipoise.figures.layout import HIGH_OF_HALF
from equipoise.figures.planting import planting_charts
from equipoise.figures.sheet import Canvas, CanvasText, Labels, spread
from equipoise.figures.vector import svg_of
from equipoise.figures.vibration import mounts_over_speed
from equipoise.i18n import speaking
from equipoise.planting.summary import plant
from equipoise.present.findings import Findings, ToolFindings
from equipoise.present.pictures import each
from equipoise.results.charts import Axis, Chart, Curve, Panel
from equipoise.results.result import in_own_words
from equipoise.vibration.forced import sweep_speed
from support.chosen import DISTINCT, few
from support.findings import findings_of
from support.gallery import Kept, keep
from unit.figures import (
    balance_samples,
    link_samples,
    samples,
    tool_samples,
    vibration_samples,
)
from unit.figures.checks import Laid, check

EXAMPLES = (*eq.examples("linkage"), *eq.examples("tool"))
TRANSLATED = ("transplanter", "walking-transplanter", "brush-cutter")
ODD = {
    **{f"planting: {kind}": kind for kind in samples.odd_machines()},
    **{f"vibration: {kind}": kind for kind in vibration_samples.KINDS},
    **{f"balancing: {kind}": kind for kind in balance_samples.EVERY},
    **{f"tools: {kind}": kind for kind in tool_samples.MACHINES},
    **{f"links: {kind}": kind for kind in link_samples.EVERY},
}


def findings_with_ratios(name: str) -> Findings | ToolFindings:
    """What can be told of a bundled model; ratios of gears are set, and not looked for."""
    findings = findings_of(name)
    plan = None if isinstance(findings, ToolFindings) else findings.machine.balance
    if plan is None or not plan.geared:
        return findings
    geared = tuple(replace(item, ratio=(item.ratio[0],) * 2) for item in plan.geared)
    return replace(
        findings, machine=replace(findings.machine, balance=replace(plan, geared=geared))
    )


def of_odd(name: str) -> dict[str, Chart]:
    room, _, kind = name.partition(": ")
    if room == "planting":
        return planting_charts(plant(samples.odd_machines()[kind]))
    rooms = {
        "vibration": vibration_samples.pictures,
        "balancing": balance_samples.pictures,
        "tools": tool_samples.pictures,
        "links": link_samples.pictures,
    }
    return rooms[room](kind)


# One with a cam, a mechanism of six bars, one on mounts with rows, one with a plan, and a tool.
@pytest.mark.exhaustive(
    but=["cam-pusher", "stephenson-six-bar", "walking-transplanter", "balance-spring", "pole-saw"]
)
@pytest.mark.documentation
@pytest.mark.parametrize("name", few(EXAMPLES, {*DISTINCT, *TRANSLATED, *eq.examples("tool")}))
def test_pictures_of_bundled_models(name: str, tmp_path: Path) -> None:
    """All pictures of a model are kept in the gallery, and in some languages drawn anew."""
    reported = findings_with_ratios(name)
    with in_own_words(reported.owner):  # as commands and reports draw them
        charts = [(picture, picture.chart) for picture in each(reported)]
        drawn = [(picture, Laid.of(chart)) for picture, chart in charts]
        small = [(picture, Laid.in_report(chart)) for picture, chart in charts]
        on_telephone = [
            (picture, Laid.on_telephone(chart)) for picture, chart in charts if is_wide(chart)
        ]
        kept = [
            Kept(picture.name, picture.chart.caption, svg_of(laid.sheet)) for picture, laid in drawn
        ]
    if isinstance(reported, Findings):
        moving = tmp_path / "animation.svg"
        assert run(["animate", name, "--out", str(moving)]) == 0
        kept.append(Kept(moving.stem, "The linkage moves.", moving.read_text(encoding="utf-8")))
    keep(name, kept)
    for pictures in (drawn, small, on_telephone):
        assert not [(picture.name, *fault) for picture, laid in pictures for fault in laid.faults]
    for language in ("ja", "ko") if name in TRANSLATED else ():
        with speaking(language), in_own_words(reported.owner):
            for picture in each(reported):
                check(picture.chart)


BUNDLED = {f"vibration: {name}" for name in EXAMPLES}
"""Of which the gallery has the pictures too, where all models are tried."""


ALIKE = {"vibration: clockwise", "vibration: space", "tools: paper", "tools: loose"}
ALIKE |= {"vibration: odd names", "tools: crowded"}
ALIKE |= {f"planting: {kind}" for kind in ("slow", "fast", "deep", "still", "backward")}
"""Laid out like others."""


@pytest.mark.exhaustive(
    but=[
        "vibration: rig",
        "planting: tray",
        "planting: springs",
        "tools: odd names",
        "balancing: rows",
        "planting: block",
    ]
)
@pytest.mark.parametrize("name", few(ODD, {*ODD} - BUNDLED - ALIKE))
def test_charts_of_odd_machines(name: str) -> None:
    """With long and foreign names, many of everything, and nothing of what is usual."""
    for chart in of_odd(name).values():
        check(chart)


# -- texts that keep clear of each other -----------------------------------------------------------


def test_texts_side_by_side() -> None:
    assert list(spread([1, 5, 9], [2, 2, 2], 0, 10)) == [1, 5, 9]
    placed = spread([5.2, 5.0, 5.1], [2, 1, 3], 0, 10)
    assert list(np.argsort(placed)) == [1, 2, 0]
    ordered = sorted(zip(placed, (2, 1, 3), strict=True))
    assert all(b - a >= (u + v) / 2 - 1e-6 for (a, u), (b, v) in pairwise(ordered))


def test_texts_without_room() -> None:
    crowd = spread([0, 0, 0], [5, 5, 5], 0, 10)
    assert np.all((crowd >= 2.5) & (crowd <= 7.5))
    sheet = Canvas(72.0, 72.0)
    labels = Labels(sheet, (0.0, 0.0, 72.0, 72.0))
    labels.reserve(36.0, 36.0, half=100)
    assert not labels.put(36.0, 36.0, CanvasText("no room", "#000000", optional=True))
    assert not sheet.words
    assert labels.put(36.0, 36.0, CanvasText("all the same", "#000000"))
    assert [words.text for words in sheet.words] == ["all the same"]


def test_texts_without_room_in_half_of_a_page_are_left_out() -> None:
    """Rather than written over another; where the page is wide they are written."""
    for sparse in (True, False):
        sheet = Canvas(72.0, 72.0)
        labels = Labels(sheet, (0.0, 0.0, 72.0, 72.0), sparse=sparse)
        labels.reserve(36.0, 36.0, half=100)
        assert labels.put(36.0, 36.0, CanvasText("23.22 at 261.0°", "#000000")) is not sparse
        assert bool(sheet.words) is not sparse
    assert Laid.in_report(Chart("a", "A", "", (Panel(Axis("x"), Axis("y")),))).sheet.width < 300


def test_drawings_side_by_side_run_across_the_page() -> None:
    x, y = (Axis(f"{axis} in the frame") for axis in "xy")
    drawing, plain = Panel(x, y, equal=True), Panel(x, y)
    for panels, columns, wide in (
        ((drawing,) * 2, 2, True),
        ((drawing,) * 2, 1, False),
        ((plain,) * 2, 2, False),
        ((plain,) * 3, 3, True),
        ((plain,) * 5, 2, True),
    ):
        assert is_wide(Chart("a", "A", "", panels, columns=columns)) is wide


def test_flat_curves_side_by_side_have_low_axes() -> None:
    """All in one row are as high as the highest; of hodographs of straight motion half as wide."""
    x, y = (Axis(f"along {axis}") for axis in "xy")
    for sizes, highest in (((0.01, 0.1), 0.45), ((0.01, 1.0), 1.0), ((0.01, 0.7), 0.78)):
        turn = np.exp(1j * np.linspace(0, 6, 40))
        curves = [Curve.of(turn.real + 1j * size * turn.imag) for size in sizes]
        panels = tuple(Panel(x, y, (curve,), equal=True) for curve in curves)
        laid = Laid.in_report(Chart("a", "A", "", panels, columns=2, stacked=False))
        heights = [view.y.length for view, _ in laid.panels]
        assert np.ptp(heights) < 1e-9
        assert heights[0] == pytest.approx(highest * laid.panels[0][0].x.length, rel=0.12)
        for view, _ in laid.panels:  # of one scale still
            rates = [(axis.high - axis.low) / axis.length for axis in (view.x, view.y)]
            assert rates[0] == pytest.approx(rates[1])


def test_crowded_panels_run_across_the_page() -> None:
    """Forces of four mounts over speed, and on a telephone each as high as one."""
    over_speed = sweep_speed(eq.load("sieve"), "200 rpm", "600 rpm", "linear", speeds=9)
    chart = mounts_over_speed(over_speed)
    assert len(over_speed.mounts) == 4 and is_wide(chart)
    heights = [round(view.y.length) for view, _ in Laid.on_telephone(chart).panels]
    assert min(heights) >= HIGH_OF_HALF[1]
