"""JSON Schemas of files, from what classes declare."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from equipoise import keys
from equipoise.i18n import LANGUAGES
from equipoise.quantities import KINDS, Dimension, pattern
from equipoise.schema.numbers import Polar
from equipoise.schema.open_files import FileKind, document_of
from equipoise.schema.writing import plain_default

Schema = dict[str, Any]
Definitions = dict[str, Schema]
DIALECT = "https://json-schema.org/draft/2020-12/schema"


EXPRESSION = "^="
"""How an expression begins that a number is worked out from, as a pattern."""


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
    required = [name for name, item in known.items() if item.required]
    return {
        "description": " ".join((of.__doc__ or "").split("\n\n")[0].split()),
        "type": "object",
        "properties": {name: _property(item, definitions) for name, item in known.items()},
        **({"required": required} if required else {}),
        "additionalProperties": False,
        **of.conditions,
    }


def _property(key: keys.Key, definitions: Definitions) -> Schema:
    schema = dict(_schema(key.kind, definitions))
    if key.text:
        schema["description"] = key.text.replace("`", "")
    if key.example is not None:
        schema["examples"] = [key.example]
    default = plain_default(key)
    if default not in (None, [], {}):
        schema["default"] = default
    if type(keys.innermost(key.kind)) is keys.Number:
        limits = {"minimum": key.at_least, "exclusiveMinimum": key.above,
                  "exclusiveMaximum": key.below}  # fmt: skip
        at = schema if type(key.kind) is keys.Number else schema.get("items", {})
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
    name = f"{_capitals(kind.dimension)}Quantity"  # a part may be called like one: a resistance
    return _defined(name, lambda: {**_described(kind.dimension), **_text_of(kind)}, definitions)


def _capitals(dimension: Dimension) -> str:
    """The name of a dimension as one word: ``AngularSpeed``."""
    return "".join(word.capitalize() for word in dimension.split())


def _text_of(kind: keys.Quantity) -> Schema:
    example = KINDS[kind.dimension].example
    either = f"{pattern(kind.dimension)}|{EXPRESSION}"
    return {"type": "string", "pattern": either, "examples": [example]}


def _described(dimension: Dimension, addition: str = "") -> Schema:
    kind = KINDS[dimension]
    units = ", ".join(kind.units)
    return {"description": f"{kind.noun}: number, space and one of {units}{addition}"}


def _text(kind: keys.TextKind, definitions: Definitions) -> Schema:
    names = kind.names or kind.suggested
    return {"type": "string", **({"enum": [*names]} if names else {})}


def _wording(kind: keys.Wording, definitions: Definitions) -> Schema:
    text = {"type": "string", "minLength": 1}
    table = {
        "type": "object",
        "properties": dict.fromkeys(LANGUAGES, text),
        "minProperties": 1,
        "additionalProperties": False,
    }
    label = "text for all readers, or one for each of some languages"
    return _defined(
        "Wording",
        lambda: {"anyOf": [{"type": "string"}, table], "description": label},
        definitions,
    )


def _whole(kind: keys.Whole, definitions: Definitions) -> Schema:
    if len(kind.names) == 1:
        return {"type": "integer", "const": kind.names[0]}
    if kind.names:
        return {"type": "integer", "enum": [*kind.names]}
    least = {} if kind.least is None else {"minimum": kind.least, "maximum": kind.most}
    return {"type": ["integer", "string"], "pattern": EXPRESSION, **least}


def _listing(kind: keys.Listing, definitions: Definitions) -> Schema:
    least, most = (min(kind.sizes), max(kind.sizes)) if kind.sizes else (1, None)
    most_items = {} if most is None else {"maxItems": most}
    unique = (
        {"uniqueItems": True} if isinstance(kind.item, keys.TextKind) and kind.item.names else {}
    )
    items = _schema(kind.item, definitions)
    return {"type": "array", "items": items, "minItems": least, **most_items, **unique}


_LENGTH = keys.Quantity(dimension="length")


def _point(kind: keys.Point, definitions: Definitions) -> Schema:
    sizes = (2, 3) if kind.space else (2,)
    polar = _defined("PolarPoint", lambda: _object(Polar, definitions), definitions)
    text = (
        "x, y and z; in the plane of the drawing if z is left out"
        if kind.space
        else "x and y, or distance and direction"
    )
    either = [_listing(keys.Listing(_LENGTH, sizes), definitions), polar]
    if kind.named:
        return {"anyOf": [{"type": "string"}, _point(keys.Point(kind.space), definitions)]}
    name = "Place" if kind.space else "Point"
    return _defined(name, lambda: {"anyOf": either, "description": text}, definitions)


def _named(kind: keys.Named, definitions: Definitions) -> Schema:
    table = {"type": "object", "additionalProperties": _schema(kind.item, definitions)}
    names = {"type": "array", "items": {"type": "string"}, "minItems": 1}
    return {"anyOf": [table, names]} if kind.listed else table


def _direction(kind: keys.DirectionKind, definitions: Definitions) -> Schema:
    vector = _listing(keys.Listing(keys.Number(), (3,)), definitions)
    either = [_schema(keys.Quantity(dimension="angle"), definitions), vector]
    text = "angle in the plane of the drawing, or a vector of three plain numbers"
    return _defined("Direction", lambda: {"anyOf": either, "description": text}, definitions)


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
    text = _described(item.dimension, "; or a table")["description"]
    name = f"{_capitals(item.dimension)}InPlanes"
    return _defined(name, lambda: _in_planes(_text_of(item), text), definitions)


def _in_planes(text: Schema, description: str) -> Schema:
    table: Schema = {
        "type": "object",
        "properties": dict.fromkeys(keys.PLANES, text),
        "required": [*keys.PLANES],
        "additionalProperties": False,
    }
    description = f"{description} with one for the vertical and one for the lateral plane"
    return {"anyOf": [text, table], "description": description}


def _table(kind: keys.KeyTable, definitions: Definitions) -> Schema:
    of = kind.type
    return _defined(of.__name__, lambda: _object(of, definitions), definitions)


SCHEMAS: Mapping[type[keys.Kind], Callable[[Any, Definitions], Schema]] = {
    keys.ParameterValue: lambda kind, _: {"type": ["string", "number"]},
    keys.Anything: lambda kind, _: dict(kind.schema or {}),
    keys.DirectionKind: _direction,
    keys.File: lambda kind, _: {"type": "string"},
    keys.Flag: lambda kind, _: {"type": "boolean"},
    keys.Listing: _listing,
    keys.Named: _named,
    keys.Number: lambda kind, _: {"type": ["number", "string"], "pattern": EXPRESSION},
    keys.OneOr: _one_or,
    keys.Planes: _planes,
    keys.Point: _point,
    keys.Quantity: _quantity,
    keys.KeyTable: _table,
    keys.Tables: lambda kind, definitions: {
        "type": "array",
        "items": _table(kind.item, definitions),
    },
    keys.TextKind: _text,
    keys.DependentQuantity: lambda kind, _: {"type": "string", **(kind.schema or {})},
    keys.Whole: _whole,
    keys.Wording: _wording,
}
