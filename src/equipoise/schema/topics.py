"""What `equipoise explain` knows: errors with their cures, tables of files with their keys, terms.

An error names its topic itself.  A topic is a heading of `errors.md`, as links have it, or a table
of a file by its path, such as ``links.NAME.section``.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from functools import cache
from importlib import resources
from textwrap import fill, indent
from typing import NamedTuple

from equipoise import keys
from equipoise.i18n.terms import MEANINGS, TERMS
from equipoise.schema.open_files import FileKind, document_of

FILES: tuple[FileKind, ...] = ("linkage", "tool", "study")
CODE = re.compile(r"^```\w*\n(.*?)^```$", re.MULTILINE | re.DOTALL)
PARAGRAPH = re.compile(r"\n\n|\n(?=- )")
LINK = re.compile(r"\[((?:[^\[\]]|\[+[^\[\]]*\]+)*)\]\([^)]*\)")
UNWRAPPED = 100_000
"""Signs of a line, where whoever shows it wraps it."""
NAME = "NAME"
"""Stands in a path for a name of the user's."""


class Explained(NamedTuple):
    """An error and its cure.  text : Markdown below the heading."""

    title: str
    text: str


class FileTable(NamedTuple):
    """A table of a file: how it is headed there, what it is read to, and in which files it is."""

    heading: str
    of: type[keys.Frozen]
    kind: FileKind


OF_MEMBER = re.compile(r"( of| at)? \{name\}$")
"""What the label of an output says of which member of a family it is."""


def slug_of(title: str) -> str:
    """What a heading is called in links, as on GitHub."""
    return re.sub(r"[^\w\- ]", "", title.lower()).replace(" ", "-")


@cache
def errors() -> Mapping[str, Explained]:
    """Every error that has a page, by its topic, in the order of the page."""
    page = resources.files("equipoise").joinpath("errors.md").read_text(encoding="utf-8")
    parts = (part.partition("\n") for part in page.split("\n## ")[1:])
    return {slug_of(title): Explained(title, text.strip()) for title, _, text in parts}


def example_of_errors() -> str:
    """The file that the page of errors changes, as a block of Markdown."""
    page = resources.files("equipoise").joinpath("errors.md").read_text(encoding="utf-8")
    return page[page.index("```toml") : page.index("\n## ")].strip()


def paragraphs(text: str, width: int = UNWRAPPED) -> Iterator[str]:
    """Markdown as plain paragraphs of lines of a width, and lines of a file as they stand there."""
    for at, part in enumerate(CODE.split(text)):
        if at % 2:
            yield indent(part.rstrip(), "    ")
            continue
        for paragraph in filter(None, map(str.strip, PARAGRAPH.split(part))):
            words = LINK.sub(r"\1", " ".join(paragraph.split())).replace("`", "")
            further = "  " * words.startswith("- ")
            yield fill(words, width, subsequent_indent=further, break_long_words=False)


@cache
def plain_page(topic: str) -> tuple[str, str]:
    """Title and plain text of the page of an error; one line a paragraph.

    Raises
    ------
    KeyError : no error has that topic.
    """
    page = errors()[topic]
    return page.title, "\n\n".join(paragraphs(page.text))


@cache
def tables() -> Mapping[str, FileTable]:
    """Every table of every file, by its path; of one that several files have, the first."""
    file_tables: dict[str, FileTable] = {}
    for kind in FILES:
        for path, of, is_list in _below(document_of(kind), ()):
            bare = ".".join(path)
            heading = f"[[{bare}]]" if is_list else f"[{bare}]"
            file_tables.setdefault(bare, FileTable(heading, of, kind))
    return file_tables


def _below(
    of: type[keys.Frozen], path: tuple[str, ...], above: tuple[type[keys.Frozen], ...] = ()
) -> Iterator[tuple[tuple[str, ...], type[keys.Frozen], bool]]:
    """Path, class, and whether it is a list, of all tables below one; each class once on a way."""
    for name, all_key in keys.all_keys(of).items():
        inner = keys.innermost(all_key.kind)
        if not isinstance(inner, keys.KeyTable | keys.Tables):
            continue
        item = inner.item.type if isinstance(inner, keys.Tables) else inner.type
        here = (*path, name, *([NAME] if isinstance(all_key.kind, keys.Named) else []))
        if item not in (of, *above):
            yield here, item, isinstance(inner, keys.Tables)
            yield from _below(item, here, (of, *above))


@cache
def keys_by_name() -> Mapping[str, Mapping[str, keys.Key]]:
    """Every key that holds no table, by its name and then by the table, or file, that has it."""
    files = [("", document_of(kind), kind) for kind in FILES]
    places = [*files, *((path, table.of, table.kind) for path, table in tables().items())]
    named: dict[str, dict[str, keys.Key]] = {}
    for path, of, kind in places:
        for name, key in keys.all_keys(of).items():
            if not isinstance(keys.innermost(key.kind), keys.KeyTable | keys.Tables):
                named.setdefault(name, {})[path or kind] = key
    return named


def table_at(place: Sequence[str]) -> str:
    """The path of the table that a place of a file is in; empty where it is in none.

    place : steps without numbers in lists, such as ``links``, ``crank``, ``mass``.
    """
    known = [tuple(path.split(".")) for path in tables()]
    fitting = [
        path
        for path in known
        if len(path) <= len(place)
        and all(step in (NAME, given) for step, given in zip(path, place, strict=False))
    ]
    longest: tuple[str, ...] = max(fitting, key=len, default=())
    return ".".join(longest)


@cache
def terms() -> Mapping[str, Explained]:
    """Every term of the glossary that is no topic otherwise, with its meaning, by its topic."""
    topics: dict[str, Explained] = {}
    for label, text in (TERMS | MEANINGS).items():
        term = OF_MEMBER.sub("", label)
        topics.setdefault(slug_of(term), Explained(term, text))
    return {topic: item for topic, item in topics.items() if topic not in {*errors(), *tables()}}


def known_topic(topic: str) -> str:
    """The topic that a command can explain: the same, or the table that a place is in.

    Tables with names of the user's, such as ``links.NAME``, go by the word before the name too, and
    a table in another, such as ``support.mounts.NAME``, by its own word, if it is alone with it.
    """
    if topic in errors():
        return topic
    steps = topic.split(".")
    for path in (f"{topic}.{NAME}", topic):
        if path in tables():
            return path
    if topic not in {*terms(), *keys_by_name()}:
        within = [path for path in tables() if path.removesuffix(f".{NAME}").endswith(f".{topic}")]
        if len(within) == 1:
            return within[0]
    return table_at(steps)
