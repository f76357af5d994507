"""Blocks on a terminal, at its width: tables that are too wide are folded, never cut."""

from __future__ import annotations

import io
import re
import shutil
import sys
from collections.abc import Iterable, Iterator, Sequence

from rich.console import Console
from rich.table import Table as RichTable
from rich.text import Text as RichText

from equipoise.i18n import Note, say
from equipoise.present.cells import Grid, Head, Text, grid, plain
from equipoise.results.blocks import Block, Facts, Listing, Notes, Picture, Section, Table
from equipoise.results.blocks import Text as Running

LEAST = 40
"""Signs in a line below which nothing is laid out."""
GAP, NARROW = 2, 20
"""Signs between columns; a column of words is not made narrower to keep a table in one part."""
HEAD = 14
"""Signs in a line of a heading, where its words are so short."""
STRONG = "bold red"
SIGN = " !"
"""Beside what is emphasised where there is no colour."""


def print_blocks(
    title: str | None,
    blocks: Iterable[Block | Section],
    width: int | None = None,
) -> None:
    """Print a title and what stands below it; all of it, or nothing where a block has an error.

    title : none if empty; None where it goes on below something else.
    width : signs in a line; those of the terminal if None.
    """
    if width is None:
        width = shutil.get_terminal_size().columns
    if sys.stdout is None:  # where the shell has closed it
        return
    printed = io.StringIO()
    console = Console(
        file=printed,
        force_terminal=sys.stdout.isatty() or None,
        width=max(width, LEAST),
        highlight=False,
        markup=False,
        emoji=False,
        soft_wrap=False,
    )
    printer = _Printer(console, begun=title is None)
    if title:
        printer.words(title, "bold")
    printer.blocks(blocks)
    sys.stdout.write(printed.getvalue())


class _Printer:
    """Prints blocks one below the other."""

    def __init__(self, console: Console, begun: bool) -> None:
        self.console, self.begun = console, begun
        self.coloured = console.is_terminal and console.color_system is not None
        self.apart = False  # whether running text begins after a space, as after a table

    def blocks(self, blocks: Iterable[Block | Section]) -> None:
        for block in blocks:
            if self.apart and isinstance(block, Running):
                self.space()
            self.apart = isinstance(block, Table | Facts)
            if isinstance(block, Section):
                self.space()
                self.words(block.title, "bold underline")
                self.blocks(block.blocks)
            elif isinstance(block, Table):
                self.table(grid(block))
            else:
                self.other(block)

    def other(self, block: Block) -> None:
        """What is not a table."""
        if isinstance(block, Running):
            self.words(block.text, STRONG if block.strong else "")
        elif isinstance(block, Facts):
            if block.title:
                self.space()
                self.words(block.title, "bold")
            for item in block.items:
                self.words(item, indent=2)
        elif isinstance(block, Notes):
            self.space()
            for note in block.notes:
                self.words(f"note: {note.said() if isinstance(note, Note) else note}")
        elif isinstance(block, Listing):
            self.space()
            if block.title:
                self.words(block.title, "bold")
            for line in block.text.splitlines():
                self.console.print(plain(line), soft_wrap=True)
        else:
            assert isinstance(block, Picture)  # a terminal draws none

    def space(self) -> None:
        """An empty line, but not at the very beginning."""
        if self.begun:
            self.console.print()
        self.begun = True

    def words(self, text: str, style: str = "", indent: int = 0) -> None:
        """Running text; further lines of an item stand a little to the right."""
        self.begun = True
        sign = SIGN if style == STRONG and not self.coloured else ""
        start = len(text) - len(text.lstrip(" ")) + indent
        deeper = 2 if indent else 0
        lines = wrapped(plain(text.strip()) + sign, self.console.width - start, deeper)
        for place, line in enumerate(lines):
            blank = " " * (start + (deeper if place else 0))
            self.console.print(RichText(blank + line, style=style), soft_wrap=True)

    def table(self, told: Grid) -> None:
        """A table, in as many parts as the width asks for."""
        for place, columns in enumerate(self._parts(told)):
            title = told.title if not place else say("{title} (continued)", title=told.title)
            self.space()
            if title:
                self.words(title, "bold")
                self.space()
            self._part(told, columns)

    def _parts(self, told: Grid) -> Iterator[list[int]]:
        """Columns that stand side by side; the words that tell the rows begin every part."""
        is_words = [told.is_words(place) for place in range(len(told.heads))]
        leading = next((k for k, words in enumerate(is_words) if not words), 1)
        first = list(range(min(max(leading, 1), 2)))
        widths = [GAP + self._least(told, place, words) for place, words in enumerate(is_words)]
        part = list(first)
        for place in range(len(first), len(widths)):
            if part != first and sum(widths[k] for k in (*part, place)) > self.console.width + GAP:
                yield part
                part = list(first)
            part.append(place)
        yield part

    def _least(self, told: Grid, column: int, words: bool) -> int:
        """Width below which a column must not come: numbers are never cut."""
        cells = [self._told(row[column]) for row in told.rows]
        if words:
            longest = max((len(word) for cell in cells for word in cell.split()), default=0)
            return max(min(max(map(len, cells), default=0), NARROW), longest)
        return max(map(len, (*cells, *head_lines(told.heads[column], words))), default=0)

    def _part(self, told: Grid, columns: Sequence[int]) -> None:
        table = RichTable(
            box=None, padding=(0, GAP, 0, 0), pad_edge=False, header_style="", show_edge=False
        )
        heads = {k: head_lines(told.heads[k], told.is_words(k)) for k in columns}
        tall = max(map(len, heads.values()))
        for column in columns:
            words = told.is_words(column)
            lines = "\n".join([""] * (tall - len(heads[column])) + heads[column])
            table.add_column(
                RichText(lines, style="dim" if self.coloured else ""),
                justify="left" if words else "right",
                no_wrap=not words,
                overflow="fold",
            )
        for row in told.rows:
            table.add_row(*(self._cell(row[column]) for column in columns))
        with self.console.capture() as caught:
            self.console.print(table)
        printed = (line.rstrip() for line in caught.get().splitlines())
        self.console.file.write("\n".join(printed) + "\n")

    def _cell(self, cell: Text) -> RichText:
        style = STRONG if cell.strong and self.coloured else ""
        return RichText(self._told(cell), style=style)

    def _told(self, cell: Text) -> str:
        sign = SIGN if cell.strong and not self.coloured else ""
        at = f" at {cell.at}" if cell.at else ""
        return plain(f"{cell.text}{at}{sign}")


def wrapped(text: str, width: int, indent: int = 0) -> list[str]:
    """Lines of a text that are no longer than a width, further ones less an indent; only longer
    words are.
    """
    lines = [""]
    for word in text.split(" "):
        room = width - (indent if len(lines) > 1 else 0)
        if lines[-1] and len(lines[-1]) + 1 + len(word) > room:
            lines.append(word)
        else:
            lines[-1] += f" {word}" if lines[-1] else word
    return lines


def head_lines(head: Head, words: bool) -> list[str]:
    """A heading in short lines, its units in the last one."""
    label = plain(head.label)
    unit = f"{head.unit} at {head.at}" if head.at and head.unit else head.unit
    unit = unit or (f"at {head.at}" if head.at else "")
    if words:
        return [f"{label}, {unit}" if label and unit else label or unit]
    lines = [""]
    for token in re.findall(r" ?\.?[^ .]+", label):  # also between the parts of a dotted name
        if lines[-1] and len(lines[-1]) + len(token) > HEAD:
            lines.append("")
        lines[-1] += token if lines[-1] else token.strip()
    return [*(line for line in lines if line), *([plain(unit)] if unit else [])]
