"""JSON Schemas of files, and tables of keys for the documentation, from what classes declare."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from typing import Any

from equipoise import keys
from equipoise.quantities import KINDS, Dimension, pattern
from equipoise.schema.numbers import Polar
from equipoise.schema.opening import FileKind, document_of
from equipoise.schema.writing import plain_default, value_text

Schema = dict[str, Any]
Definitions = dict[str, Schema]
DIALECT = "https://json-schema.org/draft/2020-12/schema"


def json_schema(kind: FileKind = "linkage") -> Schema:
    """JSON Schema (draft 2020-12) of the file of a linkage, tool or study, for editors."""
    definitions: Definitions = {}
    of = document_of(kind)
    whole = _object(of, definitions)
    names = {"linkage": "model", "tool": "tool", "study": "study"}
    return {
        "$schema": DIALECT,
        "title": f"Equipoise {names[kind]} file",
        **whole,
        "$defs": dict(sorted(definitions.items())),
    }


def _object(of: type[keys.Frozen], definitions: Definitions) -> Schema:
    known = keys.all_keys(of)
    required = [name for name, one in known.items() if one.required]
    return {
        "description": " ".join((of.__doc__ or "").split("\n\n")[0].split()),
        "type": "object",
        "properties": {name: _property(one, definitions) for name, one in known.items()},
        **({"required": required} if required else {}),
        "additionalProperties": False,
        **of.conditions,
    }


def _property(one: keys.Key, definitions: Definitions) -> Schema:
    schema = dict(_schema(one.kind, definitions))
    if one.text:
        schema["description"] = one.text.replace("`", "")
    if one.example is not None:
        schema["examples"] = [one.example]
    default = plain_default(one)
    if default not in (None, [], {}):
        schema["default"] = default
    if type(keys.innermost(one.kind)) is keys.Number:
        limits = {"minimum": one.at_least, "exclusiveMinimum": one.above,
                  "exclusiveMaximum": one.below}  # fmt: skip
        at = schema if type(one.kind) is keys.Number else schema.get("items", {})
        at |= {name: limit for name, limit in limits.items() if limit is not None}
    return schema


def _schema(kind: keys.Kind, definitions: Definitions) -> Schema:
    return SCHEMAS[type(kind)](kind, definitions)


def _defined(name: str, schema: Callable[[], Schema], definitions: Definitions) -> Schema:
    """A reference to what is defined once."""
    if name not in definitions:
        definitions[name] = {}  # a table may have one of its own sort inside
        definitions[name] = schema()
    return {"$ref": f"#/$defs/{name}"}


def _quantity(kind: keys.Quantity, definitions: Definitions) -> Schema:
    name = "".join(word.capitalize() for word in kind.dimension.split())
    return _defined(name, lambda: {**_described(kind.dimension), **_text_of(kind)}, definitions)


def _text_of(kind: keys.Quantity) -> Schema:
    example = KINDS[kind.dimension].example
    return {"type": "string", "pattern": pattern(kind.dimension), "examples": [example]}


def _described(dimension: Dimension, more: str = "") -> Schema:
    kind = KINDS[dimension]
    units = ", ".join(kind.units)
    return {"description": f"{kind.noun}: number, space and one of {units}{more}"}


def _text(kind: keys.Text, definitions: Definitions) -> Schema:
    names = kind.names or kind.suggested
    return {"type": "string", **({"enum": [*names]} if names else {})}


def _whole(kind: keys.Whole, definitions: Definitions) -> Schema:
    if len(kind.names) == 1:
        return {"type": "integer", "const": kind.names[0]}
    if kind.names:
        return {"type": "integer", "enum": [*kind.names]}
    least = {} if kind.least is None else {"minimum": kind.least, "maximum": kind.most}
    return {"type": "integer", **least}


def _listing(kind: keys.Listing, definitions: Definitions) -> Schema:
    least, most = (min(kind.sizes), max(kind.sizes)) if kind.sizes else (1, None)
    most_items = {} if most is None else {"maxItems": most}
    unique = {"uniqueItems": True} if isinstance(kind.item, keys.Text) and kind.item.names else {}
    items = _schema(kind.item, definitions)
    return {"type": "array", "items": items, "minItems": least, **most_items, **unique}


_LENGTH = keys.Quantity(dimension="length")


def _point(kind: keys.Point, definitions: Definitions) -> Schema:
    sizes = (2, 3) if kind.space else (2,)
    polar = _defined("PolarPoint", lambda: _object(Polar, definitions), definitions)
    told = (
        "x, y and z; in the plane of the drawing if z is left out"
        if kind.space
        else "x and y, or distance and direction"
    )
    either = [_listing(keys.Listing(_LENGTH, sizes), definitions), polar]
    name = "Place" if kind.space else "Point"
    return _defined(name, lambda: {"anyOf": either, "description": told}, definitions)


def _direction(kind: keys.Direction, definitions: Definitions) -> Schema:
    vector = _listing(keys.Listing(keys.Number(), (3,)), definitions)
    either = [_schema(keys.Quantity(dimension="angle"), definitions), vector]
    told = "angle in the plane of the drawing, or a vector of three plain numbers"
    return _defined("Direction", lambda: {"anyOf": either, "description": told}, definitions)


def _one_or(kind: keys.OneOr, definitions: Definitions) -> Schema:
    item = _schema(kind.item, definitions)
    item = {**item, "exclusiveMinimum": 0} if type(kind.item) is keys.Number else item
    several = {"type": "array", "items": item, "minItems": kind.size, "maxItems": kind.size}
    return {"anyOf": [item, several]}


def _planes(kind: keys.Planes, definitions: Definitions) -> Schema:
    if not isinstance(kind.item, keys.Quantity):
        return _in_planes(
            {"type": "string", "examples": ["hand.csv"]}, "name of a file; or a table"
        )
    item = kind.item
    told = _described(item.dimension, "; or a table")["description"]
    name = "".join(word.capitalize() for word in item.dimension.split())
    return _defined(f"{name}InPlanes", lambda: _in_planes(_text_of(item), told), definitions)


def _in_planes(text: Schema, told: str) -> Schema:
    table: Schema = {
        "type": "object",
        "properties": dict.fromkeys(keys.PLANES, text),
        "required": [*keys.PLANES],
        "additionalProperties": False,
    }
    told = f"{told} with one for the vertical and one for the lateral plane"
    return {"anyOf": [text, table], "description": told}


def _table(kind: keys.Table, definitions: Definitions) -> Schema:
    of = kind.type
    return _defined(of.__name__, lambda: _object(of, definitions), definitions)


SCHEMAS: Mapping[type[keys.Kind], Callable[[Any, Definitions], Schema]] = {
    keys.Anything: lambda kind, _: dict(kind.schema or {}),
    keys.Direction: _direction,
    keys.File: lambda kind, _: {"type": "string"},
    keys.Flag: lambda kind, _: {"type": "boolean"},
    keys.Listing: _listing,
    keys.Named: lambda kind, definitions: {
        "type": "object",
        "additionalProperties": _schema(kind.item, definitions),
    },
    keys.Number: lambda kind, _: {"type": "number"},
    keys.OneOr: _one_or,
    keys.Planes: _planes,
    keys.Point: _point,
    keys.Quantity: _quantity,
    keys.Table: _table,
    keys.Tables: lambda kind, definitions: {
        "type": "array",
        "items": _table(kind.item, definitions),
    },
    keys.Text: _text,
    keys.Told: lambda kind, _: {"type": "string", **(kind.schema or {})},
    keys.Whole: _whole,
}

# -- the documentation -----------------------------------------------------------------------------

_COUNTS = {2: "two", 3: "three"}
WORDS: dict[type[keys.Kind], str] = {
    keys.Anything: "value",
    keys.Direction: "angle, or vector",
    keys.File: "file",
    keys.Flag: "true or false",
    keys.Number: "number",
    keys.Whole: "whole number",
}
"""What values of kinds without a choice are called; all others are text."""


def key_table(of: type[keys.Frozen]) -> str:
    """Rows of the documentation, one for each key of a class that holds no table."""
    plain = (one for one in keys.keys_of(of).values() if not holds_tables(one.kind))
    rows = (
        f"| `{one.name}` | {words_of(one.kind)} | {_default(one)} | {one.text} |" for one in plain
    )
    table = "\n".join(["| key | kind | default | meaning |", "|---|---|---|---|", *rows])
    return table.replace("|  |", "| |")


def holds_tables(kind: keys.Kind) -> bool:
    """Whether a key has tables below it, which the documentation tells for themselves."""
    return isinstance(keys.innermost(kind), keys.Table | keys.Tables)


def _default(one: keys.Key) -> str:
    if one.required:
        return "required"
    default = plain_default(one)
    if default in (None, [], {}):
        return ""
    return f"`{value_text(default)}`"


def words_of(kind: keys.Kind) -> str:
    """What a value is, as the documentation calls it."""
    if isinstance(kind, keys.Listing | keys.Named | keys.OneOr | keys.Planes):
        return _words_of_several(kind)
    if isinstance(kind, keys.Quantity):
        return re.sub(r"^an? ", "", KINDS[kind.dimension].noun)
    if isinstance(kind, keys.Whole) and kind.names:
        return " or ".join(map(str, kind.names))
    if isinstance(kind, keys.Text) and (names := kind.names or kind.suggested):
        *most, last = (f'`"{name}"`' for name in names)
        return f"{', '.join(most)} or {last}"
    if isinstance(kind, keys.Point):
        return "place" if kind.space else "point"
    return WORDS.get(type(kind), "text")


def _words_of_several(kind: keys.Listing | keys.Named | keys.OneOr | keys.Planes) -> str:
    item = words_of(kind.item)
    if isinstance(kind, keys.Listing):
        if isinstance(kind.item, keys.Text) and kind.item.names:
            return f"list of {item}"
        count = _COUNTS.get(kind.sizes[0], "") if kind.sizes else "list of"
        return f"{count} {_plural(item)}"
    if isinstance(kind, keys.Named):
        return f"{item if item[0] == '`' else _plural(item)} by name"
    if isinstance(kind, keys.OneOr):
        return f"{item}, or {_COUNTS[kind.size]}"
    return f"{item}, in planes"


def _plural(words: str) -> str:
    first, dot, rest = words.partition(" of ")
    ending = {"s": "es", "y": "ies"}.get(first[-1], "s")
    stem = first[:-1] if ending == "ies" and first[-2:] != "ey" else first
    return f"{stem}{ending}{dot}{rest}"
