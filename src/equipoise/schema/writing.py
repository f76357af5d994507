"""From values to the text of their file, and tables of keys for readers."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import suppress
from dataclasses import field
from typing import Any

from equipoise import keys
from equipoise.dataclass import dataclass
from equipoise.errors import ModelError, UsageError
from equipoise.i18n import Worded
from equipoise.keys.paths import KeyPath
from equipoise.mechanism.parts.shown_units import SIGN, worked_out
from equipoise.quantities import KINDS, Dimension, format_exact, parse
from equipoise.quantities.expressions import NamedAmounts
from equipoise.schema.numbers import POLAR, written_point
from equipoise.schema.reading import within


@dataclass(frozen=True)
class WorkedOut:
    """Numbers that expressions give.

    expressions : by the path of the number.  names : what they name.
    """

    expressions: Mapping[str, str] = field(default_factory=dict)
    names: NamedAmounts = field(default_factory=dict)

    def of(self, value: float, dimension: Dimension | None, place: KeyPath) -> str | None:
        """The expression that gives exactly the value at a place; None where none does."""
        expression = self.expressions.get(str(place)) if self.expressions else None
        if expression is None:
            return None
        with suppress(UsageError):  # a name may be gone
            return expression if self.read(expression, dimension) == value else None
        return None

    def read(self, text: str, dimension: Dimension | None) -> float:
        """The number of an expression, or of a quantity."""
        if dimension is not None and not text.startswith(SIGN):
            return parse(text, dimension)
        return worked_out(text, dimension, self.names)


@dataclass(frozen=True)
class Writer:
    """How the parts of an object are written.

    names : name of the file of what lies in one of its own, by the key that names it.
    makers : tables of some classes, otherwise than by `Frozen.to_table`.
    worked_out : numbers that are written as expressions.
    """

    names: Mapping[str, str]
    makers: Mapping[type[keys.Frozen], Callable[[Any], dict[str, Any]]] = field(
        default_factory=dict
    )
    worked_out: WorkedOut = WorkedOut()

    def content(
        self, of: type[keys.Frozen], value: Any, place: KeyPath = KeyPath()
    ) -> dict[str, Any]:
        """Content of the table of an object as plain values."""
        given = _given(self.makers.get(of, of.to_table), value, place)
        table: dict[str, Any] = {}
        for name, key in keys.keys_of(of).items():
            if name not in given:
                continue
            if isinstance(key.kind, keys.KeyTable) and key.kind.flat:
                table |= self.content(key.kind.type, given[name], place)
            else:
                table[name] = self.plain(key.kind, given[name], place / name)
        return table

    def plain(self, kind: keys.Kind, value: Any, place: KeyPath) -> Any:
        """A value as it stands in the file."""
        return WRITERS[type(kind)](kind, value, place, self)


def _given(to_table: Callable[[Any], dict[str, Any]], value: Any, place: KeyPath) -> dict[str, Any]:
    """Table of an object in the file; errors name its place."""
    try:
        return to_table(value)
    except ModelError as error:
        raise within(place, error) from error


def plain_default(key: keys.Key) -> Any:
    """What a key that is left out stands for, as it would be written; None for nothing."""
    if key.written_default is not None or key.required or key.default is None or key.endless:
        return key.written_default
    if isinstance(key.kind, keys.KeyTable | keys.Tables | keys.File):
        return None
    default = Writer({}).plain(key.kind, key.default, KeyPath())
    return None if isinstance(default, list | dict) and not default else default


def file_tables(of: type[keys.Frozen], value: Any) -> Iterator[tuple[str, str, Any, str]]:
    """What lies in files of their own: the key that names each, its sort, itself, and its name."""
    yield from _file_tables(keys.KeyTable(of), value, KeyPath())


def _file_tables(
    kind: keys.Kind, value: Any, place: KeyPath
) -> Iterator[tuple[str, str, Any, str]]:
    if isinstance(kind, keys.File):
        yield place.abbreviated, kind.sort, value, getattr(value, "file", "")
    elif isinstance(kind, keys.Planes):
        for part, item in _in_planes(value, place):
            yield from _file_tables(kind.item, item, part)
    elif isinstance(kind, keys.Tables):
        for number, item in enumerate(value):
            yield from _file_tables(kind.item, item, place / number)
    elif isinstance(kind, keys.Named) and isinstance(value, Mapping):
        for name, item in value.items():
            yield from _file_tables(kind.item, item, place / name)
    elif isinstance(kind, keys.KeyTable):
        for name, item in _given(kind.type.to_table, value, place).items():
            key = keys.keys_of(kind.type)[name]
            inner = place if isinstance(key.kind, keys.KeyTable) and key.kind.flat else place / name
            for where, sort, result, file in _file_tables(key.kind, item, inner):
                named = isinstance(key.kind, keys.File) and key.kind.named
                yield where, sort, result, getattr(value, named) if named else file


def _in_planes(value: tuple[Any, ...], place: KeyPath) -> Iterator[tuple[KeyPath, Any]]:
    """The parts of what is of both planes, each with its place in the file."""
    if len(value) == len(keys.PLANES):
        yield from ((place / plane, item) for plane, item in zip(keys.PLANES, value, strict=True))
    else:
        yield from ((place, item) for item in value)


# -- plain values ----------------------------------------------------------------------------------


def tidy(value: float) -> float:
    """Return a whole number without its decimal point."""
    return int(value) if float(value).is_integer() and abs(value) < 1e6 else value


def _point(kind: keys.Point, value: Any, place: KeyPath, writer: Writer) -> Any:
    if isinstance(value, str):
        return value
    if kind.space and value[2]:
        return [_length(item, place / n, writer) for n, item in enumerate(value)]
    x, y = value[:2]
    expressions = writer.worked_out.expressions
    if any(str(place / axis) in expressions for axis in (0, 1)):
        return [_length(item, place / n, writer) for n, item in enumerate((x, y))]
    given = {name: entry for name in POLAR if (entry := expressions.get(str(place / name)))}
    return written_point((x, y), given, writer.worked_out.read) if given else written_point((x, y))


def _length(value: float, place: KeyPath, writer: Writer) -> str:
    return writer.worked_out.of(value, "length", place) or format_exact(value, "length")


def _direction(kind: keys.DirectionKind, value: Any, place: KeyPath, writer: Writer) -> Any:
    if isinstance(value, tuple):
        return [tidy(component) for component in value]
    return _number(keys.Quantity(dimension="angle"), value, place, writer)


def _number(kind: keys.Number | keys.Whole, value: Any, place: KeyPath, writer: Writer) -> Any:
    """A number with its unit, if it has one, or the expression that gives it."""
    dimension = kind.dimension if isinstance(kind, keys.Quantity) else None
    expression = writer.worked_out.of(value, dimension, place)
    if expression is not None:
        return expression
    if dimension is not None:
        return format_exact(value, dimension)
    return value if isinstance(kind, keys.Whole) else tidy(value)


def _listing(kind: keys.Listing, value: Any, place: KeyPath, writer: Writer) -> Any:
    return [writer.plain(kind.item, item, place) for item in value]


def _named(kind: keys.Named, value: Any, place: KeyPath, writer: Writer) -> Any:
    if isinstance(value, tuple):
        return [*value]
    return {name: writer.plain(kind.item, item, place / name) for name, item in value.items()}


def _one_or(kind: keys.OneOr, value: Any, place: KeyPath, writer: Writer) -> Any:
    items = _listing(keys.Listing(kind.item), value, place, writer)
    alike = kind.repeat and all(item == value[0] for item in value)
    return items[0] if len(items) == 1 or alike else items


def _planes(kind: keys.Planes, value: Any, place: KeyPath, writer: Writer) -> Any:
    if isinstance(kind.item, keys.Quantity):
        texts = [writer.plain(kind.item, item, place) for item in value]
        return texts[0] if value[0] == value[1] else dict(zip(keys.PLANES, texts, strict=True))
    named = [writer.plain(kind.item, item, part) for part, item in _in_planes(value, place)]
    return named[0] if len(named) == 1 else dict(zip(keys.PLANES, named, strict=False))


def _as_it_is(kind: keys.Kind, value: Any, place: KeyPath, writer: Writer) -> Any:
    return value


WRITERS: dict[type[keys.Kind], Callable[[Any, Any, KeyPath, Writer], Any]] = {
    keys.ParameterValue: lambda kind, value, place, writer: (
        value if isinstance(value, str) else tidy(value)
    ),
    keys.Anything: _as_it_is,
    keys.DirectionKind: _direction,
    keys.File: lambda kind, value, place, writer: writer.names[place.abbreviated],
    keys.Flag: _as_it_is,
    keys.Listing: _listing,
    keys.Named: _named,
    keys.Number: _number,
    keys.OneOr: _one_or,
    keys.Planes: _planes,
    keys.Point: _point,
    keys.Quantity: _number,
    keys.KeyTable: lambda kind, value, place, writer: writer.content(kind.type, value, place),
    keys.Tables: lambda kind, value, place, writer: [
        writer.plain(kind.item, item, place / n) for n, item in enumerate(value)
    ],
    keys.TextKind: _as_it_is,
    keys.DependentQuantity: _as_it_is,
    keys.Whole: _number,
    keys.Wording: lambda kind, value, place, writer: (
        dict(value.texts) if isinstance(value, Worded) else value
    ),
}

# -- text ------------------------------------------------------------------------------------------


def toml_text(of: type[keys.Frozen], content: Mapping[str, Any]) -> str:
    """Write the content of a file as TOML, with one line a key and one table a link or mount."""
    known = keys.all_keys(of)
    plain = {
        name: value
        for name, value in content.items()
        if not _is_tables(value) or isinstance(known[name].kind, keys.Wording)
    }
    blocks = ["".join(_lines(plain))]
    for name, value in content.items():
        if name not in plain:
            blocks += _headed(name, known[name].kind, value)
    return "\n".join(blocks)


def _headed(name: str, kind: keys.Kind, value: Any) -> Iterator[str]:
    """Blocks with headers of a table, of a list of them, or of those with names."""
    if isinstance(kind, keys.Tables):
        for item in value:
            yield from _blocks(f"[[{name}]]", name, kind.item.type, item)
    elif isinstance(kind, keys.Named) and not isinstance(kind.item, keys.KeyTable):
        yield "".join([f"[{name}]\n", *_lines(value)])
    elif isinstance(kind, keys.Named):
        for key, item in value.items():
            inner = f"{name}.{key_text(key)}"
            yield from _blocks(f"[{inner}]", inner, kind.item.type, item)  # type: ignore[attr-defined]
    elif isinstance(kind, keys.KeyTable):
        yield from _blocks(f"[{name}]", name, kind.type, value)


def _blocks(
    header: str, name: str, of: type[keys.Frozen], table: Mapping[str, Any]
) -> Iterator[str]:
    known = keys.all_keys(of)
    below = {key: item for key, item in table.items() if _has_header(known[key].kind)}
    own = {key: item for key, item in table.items() if key not in below}
    yield "".join([header, "\n", *_lines(own)])
    for key, item in below.items():
        yield from _headed(f"{name}.{key}", known[key].kind, item)


def _has_header(kind: keys.Kind) -> bool:
    """Whether what is inside of a table is written below a header of its own."""
    item = kind.item if isinstance(kind, keys.Named | keys.Tables) else kind
    return isinstance(item, keys.KeyTable) and (item.headed or kind is not item)


def _is_tables(value: Any) -> bool:
    return isinstance(value, dict) or (
        isinstance(value, list) and bool(value) and all(isinstance(item, dict) for item in value)
    )


def _lines(table: Mapping[str, Any], prefix: str = "") -> Iterable[str]:
    for key, value in table.items():
        if isinstance(value, dict) and not _is_polar(value):
            yield from _lines(value, f"{prefix}{key_text(key)}.")
        else:
            yield f"{prefix}{key_text(key)} = {value_text(value)}\n"


def _is_polar(table: Mapping[str, Any]) -> bool:
    # A table of points may have these names too, but then they stand for points.
    return set(table) == {"distance", "direction"} and isinstance(table["distance"], str)


def value_text(value: Any) -> str:
    """A plain value as it stands in TOML, on one line."""
    import tomli_w

    if isinstance(value, list):  # tomli_w spreads lists over several lines
        return f"[{', '.join(map(value_text, value))}]"
    if isinstance(value, dict):
        items = ", ".join(f"{key_text(name)} = {value_text(item)}" for name, item in value.items())
        return f"{{ {items} }}"
    return tomli_w.dumps({"k": value}).removeprefix("k = ").removesuffix("\n")


def key_text(name: str) -> str:
    """A key as it stands in TOML, in quotes where it needs them."""
    import tomli_w

    return tomli_w.dumps({name: 0}).removesuffix(" = 0\n")


HEADINGS = ("key", "kind", "default", "meaning")
_COUNTS = {2: "two", 3: "three"}
WORDS: dict[type[keys.Kind], str] = {
    keys.Anything: "value",
    keys.DirectionKind: "angle, or vector",
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
    """Whether a key has tables below it, which the documentation lists separately."""
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
