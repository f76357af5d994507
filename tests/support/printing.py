"""What a terminal shows of blocks, to be asserted on by words and values rather than by layout."""

from __future__ import annotations

import io
from collections.abc import Iterable
from contextlib import redirect_stdout

from equipoise.present import show_blocks
from equipoise.results.blocks import Block, ReportSection


def printed(blocks: Iterable[Block | ReportSection], title: str = "", width: int = 80) -> str:
    """The lines of blocks, without colour."""
    out = io.StringIO()
    with redirect_stdout(out):
        show_blocks(title, blocks, width)
    return out.getvalue()


def words(blocks: Iterable[Block | ReportSection] | str) -> str:
    """The same as words with single spaces between them, however the lines are broken."""
    return " ".join((blocks if isinstance(blocks, str) else printed(blocks)).split())
