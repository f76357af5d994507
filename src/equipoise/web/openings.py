"""What a page opens: bundled machines, and model files."""

from __future__ import annotations

import os
from collections.abc import Mapping
from types import MappingProxyType
from typing import Any

from equipoise.errors import ModelError, UsageError
from equipoise.i18n import Note
from equipoise.schema.files import printable
from equipoise.schema.models import HeldFiles, load_linkage, loads_linkage, machine_of
from equipoise.schema.opening import content_of, examples, in_file, kind_of_text, opened
from equipoise.web.design import Design
from equipoise.web.messages import Message

NO_FILES: Mapping[str, str] = MappingProxyType({})
NO_TABLES: Mapping[tuple[str, str], Any] = MappingProxyType({})
TOOLS = Note(
    "this is the file of a hand-held tool; give that of a linkage, or `equipoise serve` it"
)


def titles() -> dict[str, str]:
    """Titles of the bundled machines by name."""
    return examples("linkage")


def tool_titles() -> dict[str, str]:
    """Titles of the bundled tools by name."""
    return examples("tool")


def opened_example(name: str) -> Design:
    """A bundled machine."""
    if name not in titles():
        raise UsageError(Note("there is no example of the name {name!r}", name=printable(name)))
    return Design(name, load_linkage(name))


def opened_file(path_or_name: str | os.PathLike[str]) -> Design:
    """A machine from its file, with the tables beside it, or an example."""
    file = opened(path_or_name)
    if kind_of_text(file.text) == "tool":
        raise ModelError("", TOOLS, file.source)
    machine = loads_linkage(file.text, file.source, file.folder)
    return Design(printable(os.path.basename(path_or_name)), machine)


def opened_text(
    name: str,
    text: str,
    files: Mapping[str, str] = NO_FILES,
    tables: Mapping[tuple[str, str], Any] = NO_TABLES,
) -> Design:
    """A machine from the text of a model file.

    files : texts of the CSV files that it names.  tables : others that there are.
    """
    shown = printable(name)
    if kind_of_text(text) == "tool":
        raise ModelError("", TOOLS, shown)
    with in_file(shown):
        content = content_of(text.removeprefix("\ufeff"), "linkage")
        return Design(shown, machine_of(content, HeldFiles(tables, files)))


def wants_tool(message: Message) -> bool:
    """Whether a message of the kind `open` wants a tool, rather than a machine."""
    if "example" in message.values:
        return message.text("example") in tool_titles()
    return not message.flag("new", False) and kind_of_text(message.text("text")) == "tool"
