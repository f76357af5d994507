"""Tables of keys for readers, written from what classes declare."""

from __future__ import annotations

import re
from collections.abc import Mapping

from equipoise import keys
from equipoise.quantities import KINDS
from equipoise.schema.writing import plain_default, value_text

HEADINGS = ("key", "kind", "default", "meaning")
_COUNTS = {2: "two", 3: "three"}
WORDS: dict[type[keys.Kind], str] = {
    keys.Anything: "value",
    keys.Direction: "angle, or vector",
    keys.File: "file",
    keys.Flag: "true or false",
    keys.Number: "number",
    keys.Whole: "whole number",
    keys.Wording: "text, or by language",
}
"""What values of kinds without a choice are called; all others are text."""


def key_table(of: type[keys.Frozen]) -> str:
    """A table in Markdown, with a row for each key of a class that holds no table."""
    head = f"| {' | '.join(HEADINGS)} |"
    lines = (f"| {' | '.join(row)} |" for row in rows(keys.keys_of(of)))
    return "\n".join([head, "|---|---|---|---|", *lines]).replace("|  |", "| |")


def rows(of: Mapping[str, keys.Key]) -> list[tuple[str, str, str, str]]:
    """Key, kind, default and meaning of each key that holds no table, in Markdown."""
    plain = (item for item in of.values() if not _holds_tables(item.kind))
    return [(f"`{item.name}`", _words_of(item.kind), _default(item), item.text) for item in plain]


def _holds_tables(kind: keys.Kind) -> bool:
    """Whether a key has tables below it, which the documentation tells for themselves."""
    return isinstance(keys.innermost(kind), keys.KeyTable | keys.Tables)


def _default(key: keys.Key) -> str:
    if key.required:
        return "required"
    default = plain_default(key)
    if default in (None, [], {}):
        return ""
    return f"`{value_text(default)}`"


def _words_of(kind: keys.Kind) -> str:
    """What a value is, as the documentation calls it."""
    if isinstance(kind, keys.Listing | keys.Named | keys.OneOr | keys.Planes):
        return _words_of_several(kind)
    if isinstance(kind, keys.Quantity):
        return re.sub(r"^an? ", "", KINDS[kind.dimension].noun)
    if isinstance(kind, keys.Whole) and kind.names:
        return " or ".join(map(str, kind.names))
    if isinstance(kind, keys.TextKind) and (names := kind.names or kind.suggested):
        *most, last = (f'`"{name}"`' for name in names)
        return f"{', '.join(most)} or {last}" if most else last
    if isinstance(kind, keys.Point):
        return "point or name" if kind.named else "place" if kind.space else "point"
    return WORDS.get(type(kind), "text")


def _words_of_several(kind: keys.Listing | keys.Named | keys.OneOr | keys.Planes) -> str:
    item = _words_of(kind.item)
    if isinstance(kind, keys.Listing):
        if isinstance(kind.item, keys.TextKind) and kind.item.names:
            return f"list of {item}"
        count = _COUNTS.get(kind.sizes[0], "") if kind.sizes else "list of"
        return f"{count} {_plural(item)}"
    if isinstance(kind, keys.Named):
        return f"{item if item[0] == '`' else _plural(item)} by name"
    if isinstance(kind, keys.OneOr):
        return f"{item}, or {_COUNTS[kind.size]}"
    return f"{item}, in planes"


def _plural(words: str) -> str:
    if " or " in words and words[0] != "`":
        return " or ".join(map(_plural, words.split(" or ")))
    first, dot, rest = words.partition(" of ")
    ending = {"s": "es", "y": "ies"}.get(first[-1], "s")
    stem = first[:-1] if ending == "ies" and first[-2:] != "ey" else first
    return f"{stem}{ending}{dot}{rest}"
