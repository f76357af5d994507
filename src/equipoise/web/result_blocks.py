"""Blocks and charts of a result as a page is sent them: texts, tables whose cells are texts, and
curves over the values of their x axis.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Any

from equipoise.i18n import say
from equipoise.present.cells import grid
from equipoise.quantities import typeset
from equipoise.results.blocks import Block, Facts, ReportSection, Table, Text
from equipoise.results.charts import Axis, Chart, Panel
from equipoise.web.block import FloatBlock, Values
from equipoise.web.figures import capital, chart


def block_messages(blocks: Iterable[Block | ReportSection]) -> Iterator[Values]:
    """Texts, lists of sentences and tables; what is of another kind is left out."""
    for block in blocks:
        if isinstance(block, Text):
            yield {"kind": "text", "text": block.text, "broken": block.emphasis is not None}
        elif isinstance(block, Facts):
            yield {"kind": "facts", "title": block.title, "items": list(block.items)}
        elif isinstance(block, Table):
            yield _table(block)


def _table(table: Table) -> Values:
    """A table; `numbers` says of each column whether it is set to the right."""
    cells = grid(table)
    rows = [
        [typeset(cell.text) if cell.number else cell.text_with_note for cell in row]
        for row in cells.rows
    ]
    heads = [_heading(head.label, head.unit) for head in cells.heads]
    numbers = [not cells.is_words(place) for place in range(len(heads))]
    return {"kind": "table", "title": table.title, "heads": heads, "rows": rows, "numbers": numbers}


def _heading(label: str, unit: str) -> str:
    """A heading, with its unit as print has it."""
    return say("{quantity}, {unit}", quantity=label, unit=typeset(unit)) if unit else label


def panel_charts(charts: Iterable[Chart], block: FloatBlock) -> Iterator[Values]:
    """A chart for each panel with curves, which share the values of their x axis.

    The place on the x axis is that of what is played.
    """
    for item in charts:
        for number, panel in enumerate(item.panels):
            if panel.curves:
                yield _panel_chart(f"{item.name}.{number}", panel, block)


def stacked_chart(item: Chart, labels: Iterable[str], chooser: str, block: FloatBlock) -> Values:
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


def _panel_chart(name: str, panel: Panel, block: FloatBlock) -> Values:
    block.add(f"{name}.x", panel.curves[0].x)
    choice = _panel_choice(name, panel, capital(panel.y.label), block)
    return chart(name, [choice], x={"array": f"{name}.x", "at": None, **_unit(panel.x)})


def _panel_choice(name: str, panel: Panel, label: str, block: FloatBlock) -> Values:
    """Curves of a panel, whose values go to the block."""
    curves = panel.curves
    arrays = [f"{name}.{number}" for number in range(len(curves))]
    for array, curve in zip(arrays, curves, strict=True):
        block.add(array, curve.y)
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
