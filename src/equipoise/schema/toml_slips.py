"""What is wrong with a text that is no TOML, in words of who writes a model file by hand."""

from __future__ import annotations

import re

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


def syntax_error(message: str, text: str) -> str:
    """The sentence for a text of which `tomllib` complains: its place and what would be right."""
    if other := _other_file(text):
        return other
    match = re.fullmatch(r"(.*) \(at (.*)\)", message, re.DOTALL)
    what, where = match.groups() if match else (message, "")
    if place := re.fullmatch(r"line ([0-9]+), column ([0-9]+)", where):
        line = text.replace("\r\n", "\n").split("\n")[int(place[1]) - 1]
        if len(line) <= LONGEST_LINE and (hint := _slip(line, int(place[2]) - 1, what)):
            return f"{where}: {hint}"
    what = "".join(sign if sign.isprintable() else ascii(sign)[1:-1] for sign in what)
    what = what if len(what) <= 200 else f"{what[:197]}..."
    what = f"{what[:1].lower()}{what[1:]}"
    if what.startswith("cannot declare"):
        what = "a table of this name is there already; put all its keys below one [name]"
    elif what.startswith(("cannot overwrite", "cannot mutate")):
        what = f"{what}, a key or table is given twice; leave one of both out"
    elif what == "unclosed array":
        what = "a comma is missing before this, or ] at the end of the list"
    else:
        what = f"{what}; give valid TOML"
    return f"{where}: {what}".removeprefix(": ")


def _other_file(text: str) -> str:
    """Say that a text is of another kind of file altogether; empty where it may be TOML."""
    lines = (line.strip() for line in text[:100_000].splitlines())
    first = next((line for line in lines if line and not line.startswith("#")), "")
    if _COLUMN.match(first) and "=" not in first:
        return (
            "this is a table of values (CSV), not a model file; `equipoise exposure` and "
            "`equipoise decay` read recorded ones"
        )
    if first.startswith("<"):
        return "this is XML, not a model file; `equipoise import` reads drawings and models"
    if first.startswith("{"):
        return "this is JSON, not a model file; those are TOML: run `equipoise new` for one"
    return ""


def _slip(line: str, column: int, what: str) -> str:
    """Say what is wrong about a column of a line; empty where nothing usual is."""
    masked = _TEXT.sub(lambda quote: " " * len(quote[0]), line)
    return (
        _decimal_comma(masked)
        or _unquoted(line, column)
        or _bare_quantity(masked)
        or _open_quotes(line)
        or (_unassigned(line) if what.startswith(("Expected '='", "Expected ']'")) else "")
    )


def _decimal_comma(masked: str) -> str:
    for match in _COMMA.finditer(masked):
        number, unit = match["number"], (match["unit"] or "").strip()
        decimal, whole = readings(number)
        pointed = decimal or whole
        if unit:
            return (
                "the decimal sign is a point, and what has a unit stands in quotes: "
                f"{quoted(f'{pointed} {unit}')}"
            )
        if match["equals"]:
            return f"the decimal sign is a point, not a comma: {pointed}"
    return ""


def _unquoted(line: str, column: int) -> str:
    """Say what lacks quotes about a column of a line; empty where nothing does."""
    for match in _KEYS.finditer(line):
        key, opening, table = match.groups()
        parts = [one.strip() for one in re.findall(_PART, key or table)]
        mended = ".".join(one if one[:1] in "\"'" else written_key(one) for one in parts)
        if match.start() <= column <= match.end() and mended.count('"') > (key or table).count('"'):
            shown = f"{opening}{mended}{']' * len(opening)}" if opening else f"{mended} ="
            return (
                f"put the name in quotes: {shown}; without them it has letters A to Z, digits, "
                "- and _ only"
            )
    value = _VALUE.search(line)
    if value is None or _PLAIN.fullmatch(value[1].replace(" ", "")) or column < value.start():
        return ""
    bare = value[1].strip("“”„‟«»‘’‚＂")
    return f"put text in quotes: {line[: value.start()].strip()} = {quoted(bare)}"


def _bare_quantity(masked: str) -> str:
    match = _QUANTITY.search(masked)
    return f"put number and unit in quotes: {quoted(match['text'])}" if match else ""


def _open_quotes(line: str) -> str:
    rest = _TEXT.sub("", line)
    if not rest.count('"') % 2 or '"""' in line:
        return ""
    return f"the quotes are opened, but not closed: {line.strip()}"


def _unassigned(line: str) -> str:
    """Say how a key goes with its value, or the name of a table with its brackets."""
    bare = line.partition("#")[0].strip()
    if match := _HEADER.fullmatch(bare):
        count = max(len(match["open"] or ""), len(match["close"] or ""))
        if count:
            return f"put the name of a table in brackets: {'[' * count}{match['name']}{']' * count}"
    elif (match := _ASSIGNED.fullmatch(bare)) and not bare.startswith("["):
        value = match["value"]
        plain = value[:1] in "\"'[{" or _PLAIN.fullmatch(value)
        return f"write {match['key']} = {value if plain else quoted(value)}"
    return ""
