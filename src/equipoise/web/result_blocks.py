"""Blocks and charts of a result as a page is sent them: texts, tables whose cells are texts, and
curves over the values of their x axis.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from equipoise.i18n import capital
from equipoise.present.cells import noted, printed, printed_grid, with_omitted
from equipoise.results.blocks import Block, Facts, Notes, ReportSection, Table, Text
from equipoise.results.charts import Axis, Chart, Curve, Mark, Panel
from equipoise.signals import Array
from equipoise.web.figures import chart
from equipoise.web.messages import JsonObject
from equipoise.web.replies import FloatBlock

MOST_POINTS = 20_000
"""Values of a curve that are sent; no screen has more columns of pixels."""


def block_messages(blocks: Iterable[Block | ReportSection]) -> Iterator[JsonObject]:
    """Texts, lists of sentences and tables.

    Raises
    ------
    TypeError : a block is of another kind, which no page shows.
    """
    for block in blocks:
        if isinstance(block, Text):
            yield _text(block.text, block.emphasis is not None)
        elif isinstance(block, Facts):
            title = with_omitted(printed(block.title), block.omitted)
            yield {"kind": "facts", "title": title, "items": [*map(printed, block.items)]}
        elif isinstance(block, Table):
            yield _table(block)
        elif isinstance(block, Notes):
            for place, note in enumerate(block.notes, 1):
                omitted = block.omitted if place == len(block.notes) else 0
                yield _text(with_omitted(noted(note), omitted), False)
        else:
            raise TypeError(block.kind)


def _text(text: str, emphasized: bool) -> JsonObject:
    return {"kind": "text", "text": printed(text), "emphasized": emphasized}


def _table(table: Table) -> JsonObject:
    """A table; `numbers` says of each column whether it is set to the right."""
    cells = printed_grid(table)
    return {
        "kind": "table",
        "title": cells.title,
        "heads": [head.heading for head in cells.heads],
        "rows": [[cell.text_with_note for cell in row] for row in cells.rows],
        "numbers": [not cells.is_words(place) for place in range(len(cells.heads))],
        "emphasized": [
            (number, place)
            for number, row in enumerate(cells.rows)
            for place, cell in enumerate(row)
            if cell.emphasis
        ],
    }


def panel_name(result: str, chart: Chart, number: int) -> str:
    """Name on the page of a panel of a chart, by the number of the panel, from 0.

    result : what the chart is of, such as ``run``.
    """
    return f"{result}.{chart.name}.{number}"


def panel_charts(result: str, charts: Iterable[Chart], block: FloatBlock) -> Iterator[JsonObject]:
    """A chart for each panel with curves, which share the values of their x axis.

    The place on the x axis is that of what is played.  Of long curves not all values are sent.
    """
    panels = {
        panel_name(result, item, number): panel
        for item in charts
        for number, panel in enumerate(item.panels)
        if panel.curves
    }
    shared: dict[int, tuple[Array, Array | slice]] = {}
    for name, panel in panels.items():
        x = panel.curves[0].x
        if id(x) not in shared:
            curves = [
                curve.y
                for panel_item in panels.values()
                for curve in panel_item.curves
                if curve.x is x
            ]
            chosen = drawn_places(x, curves) if len(x) > MOST_POINTS else slice(None)
            shared[id(x)] = (x if isinstance(chosen, slice) else x[chosen]), chosen
        yield _panel_chart(name, panel, shared[id(x)], block)


def stacked_chart(
    item: Chart, labels: Iterable[str], chooser: str, block: FloatBlock
) -> JsonObject:
    """One chart of all panels of a picture, which stand on one x axis, each a choice of its own.

    Its marker stands where the first line of the panels does.  labels : of the choices.
    """
    first = item.panels[0]
    x, line = f"{item.name}.x", first.lines[0]
    block.add(x, first.curves[0].x)
    choices = [
        _panel_choice(f"{item.name}.{number}", panel, label, block)
        for number, (panel, label) in enumerate(zip(item.panels, labels, strict=True))
    ]
    over = {"array": x, "at": line.at, **_unit(first.x)}
    return chart(item.name, choices, x=over, chooser=chooser)


def marked_chart(item: Chart, label: str, block: FloatBlock) -> JsonObject:
    """One chart of a picture of one panel: curves over values of their own, and marks as points, of
    which those of a label are a curve.

    The marker of the chart stands at the mark that has a text.
    """
    (panel,) = item.panels
    marks: dict[str, list[Mark]] = {}
    for mark in panel.marks:
        marks.setdefault(mark.label, []).append(mark)
    every = [curve.x for curve in panel.curves]
    x: Array = np.sort(np.concatenate([*every, np.array([mark.x for mark in panel.marks])]))
    curves = [
        Curve(x, np.interp(x, curve.x, curve.y, left=np.nan, right=np.nan), curve.label)
        for curve in panel.curves
    ]
    for name, own in marks.items():
        values = np.full(len(x), np.nan)
        for mark in own:
            places = np.flatnonzero((x == mark.x) & np.isnan(values))  # as many as marks at least
            values[places[0]] = mark.y
        curves.append(Curve(x, values, name))
    choice = _panel_choice(f"{item.name}.0", replace(panel, curves=tuple(curves)), label, block)
    for sent in choice["curves"][len(panel.curves) :]:
        sent["points"] = True
    block.add(f"{item.name}.x", x)
    at = next((mark.x for mark in panel.marks if mark.text), 0.0)
    return chart(item.name, [choice], x={"array": f"{item.name}.x", "at": at, **_unit(panel.x)})


def drawn_places(x: Array, curves: Sequence[Array]) -> Array:
    """Places in curves (N,) over rising x (N,) that are drawn, rising and at most `MOST_POINTS`.

    They are the ends, and the highest and the lowest value of each curve in equal steps of x, so
    that a chart shows every extreme.
    """
    steps = max((MOST_POINTS - 2) // (2 * len(curves)), 1)
    starts = np.unique(np.searchsorted(x, np.linspace(x[0], x[-1], steps, endpoint=False)))
    ends = np.append(starts[1:], len(x))
    step = np.repeat(np.arange(len(starts)), ends - starts)
    chosen = [np.array([0, len(x) - 1])]
    for y in curves:
        rising = np.lexsort((y, step))  # in each step, from its lowest value to its highest
        chosen += [rising[starts], rising[ends - 1]]
    return np.unique(np.concatenate(chosen))


def _panel_chart(
    name: str, panel: Panel, shared: tuple[Array, Array | slice], block: FloatBlock
) -> JsonObject:
    """A chart; `shared` are the values of its x axis that are sent, and their places."""
    x, chosen = shared
    block.add(f"{name}.x", x)
    label = panel.title or capital(panel.y.label)
    choice = _panel_choice(name, panel, label, block, chosen)
    return chart(name, [choice], x={"array": f"{name}.x", "at": None, **_unit(panel.x)})


def _panel_choice(
    name: str, panel: Panel, label: str, block: FloatBlock, chosen: Array | slice = slice(None)
) -> JsonObject:
    """Curves of a panel, of which the values at the places `kept` go to the block."""
    curves = panel.curves
    arrays = [f"{name}.{number}" for number in range(len(curves))]
    for array, curve in zip(arrays, curves, strict=True):
        block.add(array, curve.y[chosen])
    return {
        "name": name,
        "label": label,
        "of": None,
        "log": panel.y.scale == "log",
        **_unit(panel.y),
        "curves": [
            {"array": array, "stride": 1, "part": 0, "label": curve.label}
            for array, curve in zip(arrays, curves, strict=True)
        ],
    }


def _unit(axis: Axis) -> dict[str, Any]:
    return {"unit": axis.unit.name, "factor": axis.unit.factor}
