"""What JSON Schemas say of keys that go together."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from equipoise.quantities import Dimension, pattern


def needs(*keys: str) -> dict[str, Any]:
    """JSON Schema of a table that has all of these keys."""
    return {"required": [*keys]}


def lacks(*keys: str) -> dict[str, Any]:
    """JSON Schema of a table that has none of these keys."""
    return {"properties": dict.fromkeys(keys, False)}


def any_of(*keys: str) -> dict[str, Any]:
    """JSON Schema of a table that has one of these keys."""
    return {"anyOf": [needs(key) for key in keys]}


def not_both(*keys: str) -> dict[str, Any]:
    """JSON Schema of a table that lacks one of these keys."""
    return {"not": needs(*keys)}


def schema_by_dimension(
    name: str, sizes: Sequence[str], dimensions: Mapping[str, Dimension]
) -> dict[str, Any]:
    """JSON Schema of a table in which the key `name` decides the dimension of `sizes`."""
    cases = []
    for dimension in dict.fromkeys(dimensions.values()):
        names = [item for item, own in dimensions.items() if own == dimension]
        cases.append(
            {
                "if": {"properties": {name: {"enum": names}}, "required": [name]},
                "then": {"properties": {size: {"pattern": pattern(dimension)} for size in sizes}},
            }
        )
    return {"allOf": cases}
