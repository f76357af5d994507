"""Blocks on a terminal, at its width and in colours where it has them."""

from __future__ import annotations

import os
import shutil
import sys
from collections.abc import Iterable
from dataclasses import replace
from typing import TextIO, get_args

from equipoise.i18n import said, say
from equipoise.present.cells import grid
from equipoise.present.layout import Looks, plain, table_lines, wrapped
from equipoise.results.blocks import (
    Block,
    Emphasis,
    Facts,
    FileText,
    Notes,
    Picture,
    ReportSection,
    Table,
)
from equipoise.results.blocks import Text as Running

LEAST, PROSE = 40, 100
"""Signs in a line below which nothing is laid out; most in a line of running text."""
SIGN = "! "
"""Before running text that stands out where there is no colour."""


def print_blocks(
    title: str | None,
    blocks: Iterable[Block | ReportSection],
    width: int | None = None,
    most: int | None = None,
) -> None:
    """Print a title and what stands below it; all of it, or nothing where a block has an error.

    Arguments as of `block_text`.
    """
    text = block_text(title, blocks, width, most)
    if sys.stdout is not None:  # where the shell has closed it
        sys.stdout.write(text)


def block_text(
    title: str | None,
    blocks: Iterable[Block | ReportSection],
    width: int | None = None,
    most: int | None = None,
) -> str:
    """What a terminal shows of a title and what stands below it, in colours where it has them.

    title : none if empty; None where it goes on below something else.
    width : signs in a line; those of the terminal if None.
    most : lines for which lists lose their last items, the last lists first; any if None.
    """
    columns = shutil.get_terminal_size().columns if width is None else width

    def printed(shown: Iterable[Block | ReportSection]) -> list[str]:
        printer = _Printer(max(columns, LEAST), Looks(coloured(sys.stdout)), begun=title is None)
        if title:
            printer.words(title, "title")
        printer.blocks(shown)
        return printer.lines

    shown = [*blocks] if most is not None else blocks
    lines = printed(shown)
    while most is not None and len(lines) > most and (shorter := _shortened([*shown])):
        shown = shorter
        lines = printed(shown)
    return "".join(f"{line}\n" for line in lines)


def _shortened(blocks: list[Block | ReportSection]) -> list[Block | ReportSection]:
    """Blocks without the last item of the last list that has several, then without notes, then
    without the last sentence of detail, then without a whole list; empty where nothing is left to
    leave out.
    """
    for least in (1, 0):
        for k in reversed(range(len(blocks))):
            block = blocks[k]
            rest: Block
            if isinstance(block, Facts) and len(block.items) > 1 and not block.is_whole:
                rest = replace(block, items=block.items[:-1], more=block.more + 1)
            elif isinstance(block, Notes) and len(block.notes) > least:
                rest = replace(block, notes=block.notes[:-1], more=block.more + 1)
            else:
                continue
            return [*blocks[:k], rest, *blocks[k + 1 :]]
    details = [
        k for k, block in enumerate(blocks) if isinstance(block, Running) and block.is_detail
    ]
    if details:
        return [*blocks[: details[-1]], *blocks[details[-1] + 1 :]]
    kinds = (block for block in enumerate(blocks) if isinstance(block[1], Notes | Facts))
    lists = [k for k, item in kinds if not getattr(item, "is_whole", False)]
    return [*blocks[: lists[-1]], *blocks[lists[-1] + 1 :]] if lists else []


def coloured(stream: TextIO | None) -> bool:
    """Whether a stream shows colours, by what users may set (no-color.org, force-color.org)."""
    if os.environ.get("NO_COLOR"):
        return False
    if os.environ.get("FORCE_COLOR"):
        return True
    known = os.name != "nt" or "WT_SESSION" in os.environ  # what else Windows has, prints codes
    if stream is None or not stream.isatty():
        return False
    return known and os.environ.get("TERM") not in ("dumb", "unknown")


def _with_omitted(text: str, omitted: int) -> str:
    """What stands above a list or ends it, with how many items are left out."""
    return say("{what} (and {count} more)", what=text, count=omitted) if omitted else text


class _Printer:
    """Lines of blocks, one below the other.  begun : whether something stands above them."""

    def __init__(self, width: int, looks: Looks, begun: bool) -> None:
        self.width, self.looks, self.begun = width, looks, begun
        self.lines: list[str] = []
        self.apart = False  # whether running text begins after a space, as after a table

    def blocks(self, blocks: Iterable[Block | ReportSection]) -> None:
        for block in blocks:
            if self.apart and isinstance(block, Running):
                self.space()
            self.apart = isinstance(block, Table | Facts)
            if isinstance(block, ReportSection):
                self.space()
                self.words(block.title, "section")
                self.blocks(block.blocks)
            elif isinstance(block, Table):
                self.table(block)
            else:
                self.other(block)

    def other(self, block: Block) -> None:
        """What is not a table."""
        if isinstance(block, Running):
            self.words(block.text, block.emphasis)
        elif isinstance(block, Facts):
            if block.title:
                self.space()
                self.words(_with_omitted(block.title, block.more), "title")
            for item in block.items:
                self.words(f"  {item}")
        elif isinstance(block, Notes):
            self.space()
            for place, note in enumerate(block.notes, 1):
                omitted = block.more if place == len(block.notes) else 0
                self.words(_with_omitted(f"note: {said(note)}", omitted))
            if not block.notes and block.more:
                self.words(say("notes left out here: {count}", count=block.more))
        elif isinstance(block, FileText):
            self.space()
            if block.title:
                self.words(block.title, "title")
            self.lines += map(plain, block.text.splitlines())
        else:
            assert isinstance(block, Picture)  # a terminal draws none

    def space(self) -> None:
        """An empty line, but not at the very beginning."""
        if self.begun:
            self.lines.append("")
        self.begun = True

    def words(self, text: str, role: str | None = None) -> None:
        """Running text; further lines of what stands apart do so a little more."""
        self.begun = True
        text = plain(text)
        start = " " * (len(text) - len(text.lstrip(" ")))
        sign = SIGN if role in get_args(Emphasis) and not self.looks.coloured else ""
        further = start + " " * len(SIGN) if start or sign else ""
        room = min(self.width, PROSE) - len(start)
        lines = wrapped(sign + text.strip(), room, len(further) - len(start))
        for place, line in enumerate(lines):
            self.lines.append((further if place else start) + self.looks.paint(line, role))

    def table(self, block: Table) -> None:
        """A table, in as many parts as the width asks for."""
        for place, lines in enumerate(table_lines(grid(block), self.width, self.looks)):
            title = block.title if not place else say("{title} (continued)", title=block.title)
            self.space()
            if title:
                self.words(title, "title")
                self.space()
            self.lines += lines
