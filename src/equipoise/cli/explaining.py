"""The command `explain`: errors with their cures, keys of tables and terms, without a network."""

from __future__ import annotations

import shutil
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Annotated

from cyclopts import Parameter

from equipoise.cli.runner import CommandResult, command
from equipoise.errors import UsageError, unknown

if TYPE_CHECKING:
    from equipoise.keys import Key
    from equipoise.results.blocks import Block
    from equipoise.schema.topics import FileTable

WIDEST = 88
"""Signs in a line of running text."""


@command()
def explain(topic: Annotated[str | None, Parameter(name="TOPIC")] = None, /) -> CommandResult:
    """Explain an error and its cure, list the keys of a table of a file, or define a term.

    Parameters
    ----------
    topic
        As below an error, such as change-point; a table or key, such as springs, drive.speed or
        gravity; or a term, such as shaking-moment. All topics are listed if not given.
    """
    from equipoise.schema import topics

    if topic is None:
        return CommandResult(_lists, title="")
    known = topics.known_topic(topic)
    term = None if known else topics.terms().get(topics.slug_of(topic))
    places = {} if known else topics.keys_by_name().get(topic, {})
    if term or places:
        title, text = term or (topic, "")
        return CommandResult(lambda: _named(topic, text, places), title=title)
    if not known:
        every = [*topics.errors(), *topics.tables(), *topics.terms(), *topics.keys_by_name()]
        raise UsageError(unknown(topic, every, "topic"))
    if known in topics.errors():
        return CommandResult(lines=lambda: _page(*topics.errors()[known]).splitlines())
    table = topics.tables()[known]
    return CommandResult(lambda: _keys(table, known), title=table.heading)


def _lists() -> Iterator[Block]:
    """All that can be explained."""
    from equipoise.results.blocks import Table, Text
    from equipoise.schema import topics

    errors = ((topic, error.title) for topic, error in topics.errors().items())
    yield Table.of("Errors and their cures", ("", ""), errors)
    tables = ((topic, _about(table)) for topic, table in topics.tables().items())
    yield Table.of("Tables of files", ("", ""), tables)
    yield Text(f"Terms: {', '.join(topics.terms())}.")


def _about(table: FileTable) -> str:
    """What a table describes, in a sentence."""
    words = " ".join((table.of.__doc__ or "").split("\n\n")[0].split())
    return words.partition(". ")[0].rstrip(".").replace("`", "")


def _keys(table: FileTable, path: str) -> Iterator[Block]:
    """What a table describes, its keys, and the tables below it."""
    from equipoise.keys import all_keys
    from equipoise.results.blocks import Table, Text
    from equipoise.schema import topics, writing

    yield Text(f"{_about(table)}. In the file of a {table.kind}.")
    marked = writing.rows(all_keys(table.of))
    rows = [tuple(cell.replace("`", "") for cell in row) for row in marked]
    if rows:
        yield Table.of("", writing.HEADINGS, rows)
    below = [name for name in topics.tables() if name.startswith(f"{path}.")]
    if below:
        yield Text(f"Tables in it: {', '.join(below)}.")


def _named(name: str, text: str, places: Mapping[str, Key]) -> Iterator[Block]:
    """What a term means, and the key of that name in each table, or file, that has it."""
    from equipoise.results.blocks import Table, Text
    from equipoise.schema import topics, writing

    yield from map(Text, topics.paragraphs(text))
    rows = [
        (place, *(cell.replace("`", "") for cell in cells[1:]))
        for place, key in places.items()
        for cells in writing.rows({name: key})
    ]
    if rows:
        yield Table.of("", ("in", *writing.HEADINGS[1:]), rows)


def _page(title: str, text: str) -> str:
    """An error and its cure, for a terminal, and the machine that the example changes."""
    from equipoise.schema import topics

    width = min(shutil.get_terminal_size().columns, WIDEST)
    machine = f"The examples of these pages change this machine:\n\n{topics.example_of_errors()}"
    return "\n\n".join([title, *topics.paragraphs(text, width), *topics.paragraphs(machine, width)])
