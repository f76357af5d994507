"""How results are shown: blocks on a terminal, on a page, in print, in a notebook; the report.

Content stands beside the results, in the modules ``blocks`` of their rooms; here it is rendered.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from equipoise.displays import Displayed
    from equipoise.quantities import Dimension
    from equipoise.results.blocks import Block, ReportSection
    from equipoise.results.result import Result


def show(
    result: Result,
    width: int | None = None,
    units: Mapping[Dimension, str] | None = None,
    **options: Any,
) -> None:
    """Print what a result shows.

    width : signs in a line; those of the terminal if None.
    units : that are chosen, by dimension, such as ``{"length": "cm"}``; before those of its file.
    options : of the result's `blocks`.
    """
    from equipoise.quantities import showing

    with showing(units or {}), result.in_own_units():
        show_blocks(result.title, result.blocks(**options), width)


def show_blocks(
    title: str | None,
    blocks: Iterable[Block | ReportSection],
    width: int | None = None,
    most: int | None = None,
) -> None:
    """Print blocks below a title, or where that is None below what was printed before.

    width : as of `show`.  most : lines, for which lists lose their last items; any if None.
    """
    from equipoise.present.terminal import print_blocks

    print_blocks(title, blocks, width, most)


def html_of(value: Displayed) -> str:
    """What a notebook shows of a result, a machine, its motion or its forces: a part of a page."""
    from equipoise.present import notebook

    return notebook.html_of(value)
