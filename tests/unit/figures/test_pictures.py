"""Every chart there is: drawn, nothing clipped or overlapping, axes named and numbered."""

from __future__ import annotations

from functools import cache
from itertools import combinations, pairwise
from xml.etree import ElementTree

import numpy as np
import pytest

from equipoise.figures import layout, render
from equipoise.figures.layout import lay_out
from equipoise.figures.planting import charts as planting_charts
from equipoise.figures.sheet import Labels, Sheet, Text, box_of, spread
from equipoise.figures.view import View
from equipoise.i18n import speaking
from equipoise.planting.summary import plant
from equipoise.present.findings import find
from equipoise.present.pictures import each
from equipoise.results.charts import Chart
from unit.figures import balance_samples, samples, tool_samples, vibration_samples

EXAMPLES = (
    *("yamashita-1", "quick-return", "slider-crank-engine", "class-three", "watt-six-bar"),
    *("planetary-planting-arm", "transplanter", "yamashita-rig", "four-row-transplanter"),
    *("riding-transplanter", "walking-transplanter", "brush-cutter", "nagamine-irie"),
)
ODD = {
    **{f"planting: {kind}": kind for kind in samples.odd_machines()},
    **{f"vibration: {kind}": kind for kind in vibration_samples.KINDS},
    **{f"balancing: {kind}": kind for kind in balance_samples.EVERY},
    **{f"tools: {kind}": kind for kind in tool_samples.MACHINES},
}


@cache
def of_example(name: str) -> dict[str, Chart]:
    """Every chart of what can be told of a bundled example."""
    drawn = {picture.name: picture.draw() for picture in each(find(name))}
    return {name: chart for name, chart in drawn.items() if isinstance(chart, Chart)}


def of_odd(name: str) -> dict[str, Chart]:
    room, _, kind = name.partition(": ")
    if room == "planting":
        return planting_charts(plant(samples.odd_machines()[kind]))
    rooms = {
        "vibration": vibration_samples.pictures,
        "balancing": balance_samples.pictures,
        "tools": tool_samples.pictures,
    }
    return rooms[room](kind)


@pytest.mark.parametrize("name", EXAMPLES)
def test_charts_of_examples(name: str) -> None:
    for chart in of_example(name).values():
        check(chart)


@pytest.mark.parametrize("name", ODD)
def test_charts_of_odd_machines(name: str) -> None:
    """With long and foreign names, many of everything, and nothing of what is usual."""
    for chart in of_odd(name).values():
        check(chart)


@pytest.mark.parametrize("language", ["ja", "ko"])
def test_charts_in_other_languages(language: str) -> None:
    with speaking(language):
        for name in ("transplanter", "walking-transplanter", "brush-cutter"):
            for picture in each(find(name)):
                chart = picture.draw()
                if isinstance(chart, Chart):
                    check(chart)


def check(chart: Chart) -> None:
    """A chart draws to well-formed SVG in which every text has its place."""
    sheet = lay_out(chart)
    ElementTree.fromstring(render(chart))
    check_texts(chart.name, sheet)
    check_axes(chart)


def check_texts(name: str, sheet: Sheet) -> None:
    """No text leaves the picture, and none covers another."""
    boxes = [(words.text, box_of(words)) for words in sheet.words if words.text]
    for text, (left, top, right, bottom) in boxes:
        inside = left >= 0 and top >= 0 and right <= sheet.width and bottom <= sheet.height
        assert inside, (name, text, (left, top, right, bottom), (sheet.width, sheet.height))
    for (one, a), (other, b) in combinations(boxes, 2):
        across = min(a[2], b[2]) - max(a[0], b[0])
        up = min(a[3], b[3]) - max(a[1], b[1])
        assert across <= 1 or up <= 2, (name, one, other)


def check_axes(chart: Chart) -> None:
    """Axes are named, with their units; on each there are three numbers at least."""
    for view in views(chart):
        panel = view.panel
        if panel.bare:
            continue
        assert panel.x.label or chart.name.startswith(("scatter", "joint-polars")), chart.name
        named = panel.y.label or panel.title or panel.y.ticks is not None or panel.rings
        assert named, chart.name
        for axis, ticks in zip((panel.x, panel.y), view.ticks, strict=True):
            if axis.ticks is None:
                assert len(ticks) >= 3, (chart.name, axis.label, [text for _, text in ticks])


def views(chart: Chart) -> list[View]:
    """Panels with the scales that they were drawn on."""
    found: list[View] = []
    draw = layout.draw

    def seen(view: View) -> None:
        found.append(view)
        draw(view)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(layout, "draw", seen)
        lay_out(chart)
    return found


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
    sheet = Sheet(72.0, 72.0)
    labels = Labels(sheet, (0.0, 0.0, 72.0, 72.0))
    labels.reserve(36.0, 36.0, half=100)
    assert not labels.put(36.0, 36.0, Text("no room", "#000000", optional=True))
    assert not sheet.words
    assert labels.put(36.0, 36.0, Text("all the same", "#000000"))
    assert [words.text for words in sheet.words] == ["all the same"]
