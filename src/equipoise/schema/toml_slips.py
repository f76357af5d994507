"""What is wrong with a text that is no TOML, in words of who writes a model file by hand."""

from __future__ import annotations

import re

from equipoise.errors import at_place
from equipoise.i18n import Note
from equipoise.keys.paths import quoted, written_key
from equipoise.quantities.reading import NUMBER, readings

LONGEST_LINE = 1000
"""Of those in which slips are looked for."""
_PART = r"""(?:"[^"]*"|'[^']*'|[^"'.,=\[\]{}#]+)"""
_DOTTED = rf"{_PART}(?:\.{_PART})*"
_KEYS = re.compile(rf"(?:^\s*|[{{,])(?:({_DOTTED})=|(\[\[?)({_DOTTED})\])")
"""Keys before an equals sign, and those of a table in brackets, whatever their signs."""
_VALUE = re.compile(r"=\s*([^\s\"'\[\]{},#=][^\"'\[\]{}#=]*?)\s*(?:#.*)?$")
"""A text without quotes up to the end of the line."""
_PLAIN = re.compile(r"[+-]?[0-9][0-9_.,eE+-]*|true|false|nan|inf", re.IGNORECASE)
"""What may have been meant for a number, or for true or false."""
_TEXT = re.compile(r""""(?:[^"\\]|\\.)*"|'[^']*'|#.*""")
"""Texts in quotes, and a comment."""
_COMMA = re.compile(
    r"(?P<equals>=\s*)?(?<![\w.,])(?P<number>[+-]?[0-9][0-9.]*,[0-9]+)(?!\d)"
    r"(?P<unit>[ \t]*[^\W\d_][^\s,\]}]*(?: [^\W\d_][^\s,\]}]*)*)?"
)
"""A number with a comma, after an equals sign or before a unit, so that it is none of a list."""
_QUANTITY = re.compile(rf"[\[{{,=]\s*(?P<text>{NUMBER}[ \t]*[^\W\d_][^,\]}}]*?)\s*(?=[,\]}}]|$)")
"""A number and a unit, whose quotes were left out."""
_ASSIGNED = re.compile(r"(?P<key>[A-Za-z0-9_.-]+)(?P<sign>\s*:\s*|\s+)(?P<value>[^\s=:].*)")
"""A key and a value without an equals sign between them."""
_HEADER = re.compile(r"(?P<open>\[\[?)?(?P<name>[A-Za-z0-9_.-]+)(?P<close>\]\]?)?")
"""The name of a table, some of whose brackets may be missing."""
_COLUMN = re.compile(r'\s*"?\w[\w. ]*(?:\[[^\]]*\]"?\s*(?:[,;\t]|$)|"?\s*[,;\t])')
"""The first column in the header of a CSV file, with its unit or with another column behind it."""


def syntax_error(message: str, text: str) -> Note:
    """The sentence for a text of which `tomllib` complains: its place and what would be right."""
    if other := _other_file(text):
        return other
    match = re.fullmatch(r"(.*) \(at (.*)\)", message, re.DOTALL)
    what, where = match.groups() if match else (message, "")
    if place := re.fullmatch(r"line ([0-9]+), column ([0-9]+)", where):
        line = text.replace("\r\n", "\n").split("\n")[int(place[1]) - 1]
        if len(line) <= LONGEST_LINE and (hint := _slip(line, int(place[2]) - 1, what)):
            return at_place(where, hint)
    what = "".join(sign if sign.isprintable() else ascii(sign)[1:-1] for sign in what)
    what = what if len(what) <= 200 else f"{what[:197]}..."
    what = f"{what[:1].lower()}{what[1:]}"
    if what.startswith("cannot declare"):
        note = Note("a table of this name is there already; put all its keys below one [name]")
    elif what.startswith(("cannot overwrite", "cannot mutate")):
        note = Note(
            "{complaint}, a key or table is given twice; leave one of both out", complaint=what
        )
    elif what == "unclosed array":
        note = Note("a comma is missing before this, or ] at the end of the list")
    else:
        note = Note("{complaint}; give valid TOML", complaint=what)
    return at_place(where, note) if where else note


def _other_file(text: str) -> Note | None:
    """Say that a text is of another kind of file altogether; empty where it may be TOML."""
    lines = (line.strip() for line in text[:100_000].splitlines())
    first = next((line for line in lines if line and not line.startswith("#")), "")
    if _COLUMN.match(first) and "=" not in first:
        return Note(
            "this is a table of values (CSV), not a model file; `equipoise exposure` "
            "and `equipoise decay` read recorded ones"
        )
    if first.startswith("<"):
        return Note("this is XML, not a model file; `equipoise import` reads drawings and models")
    if first.startswith("{"):
        return Note("this is JSON, not a model file; those are TOML: run `equipoise new` for one")
    return None


def _slip(line: str, column: int, what: str) -> Note | None:
    """Say what is wrong about a column of a line; empty where nothing usual is."""
    masked = _TEXT.sub(lambda quote: " " * len(quote[0]), line)
    return (
        _decimal_comma(masked)
        or _unquoted(line, column)
        or _bare_quantity(masked)
        or _open_quotes(line)
        or (_unassigned(line) if what.startswith(("Expected '='", "Expected ']'")) else None)
    )


def _decimal_comma(masked: str) -> Note | None:
    for match in _COMMA.finditer(masked):
        number, unit = match["number"], (match["unit"] or "").strip()
        decimal, whole = readings(number)
        pointed = decimal or whole
        if unit:
            return Note(
                "the decimal sign is a point, and what has a unit stands in quotes: {quoted}",
                quoted=quoted(f"{pointed} {unit}"),
            )
        if match["equals"]:
            return Note("the decimal sign is a point, not a comma: {pointed}", pointed=pointed)
    return None


def _unquoted(line: str, column: int) -> Note | None:
    """Say what lacks quotes about a column of a line; empty where nothing does."""
    for match in _KEYS.finditer(line):
        key, opening, table = match.groups()
        parts = [part.strip() for part in re.findall(_PART, key or table)]
        mended = ".".join(part if part[:1] in "\"'" else written_key(part) for part in parts)
        if match.start() <= column <= match.end() and mended.count('"') > (key or table).count('"'):
            shown = f"{opening}{mended}{']' * len(opening)}" if opening else f"{mended} ="
            return Note(
                "put the name in quotes: {shown}; without them it has letters A to Z, "
                "digits, - and _ only",
                shown=shown,
            )
    value = _VALUE.search(line)
    if value is None or _PLAIN.fullmatch(value[1].replace(" ", "")) or column < value.start():
        return None
    bare = value[1].strip("“”„‟«»‘’‚＂")
    return Note(
        "put text in quotes: {line} = {quoted}",
        line=line[: value.start()].strip(),
        quoted=quoted(bare),
    )


def _bare_quantity(masked: str) -> Note | None:
    match = _QUANTITY.search(masked)
    return (
        Note("put number and unit in quotes: {quoted}", quoted=quoted(match["text"]))
        if match
        else None
    )


def _open_quotes(line: str) -> Note | None:
    rest = _TEXT.sub("", line)
    if not rest.count('"') % 2 or '"""' in line:
        return None
    return Note("the quotes are opened, but not closed: {line}", line=line.strip())


def _unassigned(line: str) -> Note | None:
    """Say how a key goes with its value, or the name of a table with its brackets."""
    bare = line.partition("#")[0].strip()
    if match := _HEADER.fullmatch(bare):
        count = max(len(match["open"] or ""), len(match["close"] or ""))
        if count:
            return Note(
                "put the name of a table in brackets: {shown}",
                shown=f"{'[' * count}{match['name']}{']' * count}",
            )
    elif (match := _ASSIGNED.fullmatch(bare)) and not bare.startswith("["):
        value = match["value"]
        plain = value[:1] in "\"'[{" or _PLAIN.fullmatch(value)
        return Note(
            "write {key} = {value}", key=match["key"], value=value if plain else quoted(value)
        )
    return None
