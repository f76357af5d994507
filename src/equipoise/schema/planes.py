"""What a tool has in both planes of bending: one value, or a table of two, for pydantic."""

from __future__ import annotations

from collections.abc import Callable
from typing import Annotated, Any, TypeVar

from pydantic import BeforeValidator, WithJsonSchema
from pydantic.json_schema import JsonSchemaValue
from typing_extensions import TypeAliasType

from equipoise import quantities
from equipoise.errors import UsageError
from equipoise.handheld.model import PLANES
from equipoise.mechanism.checks import unknown
from equipoise.quantities.problems import described
from equipoise.schema.fields import LIST, problem

Value = TypeVar("Value")
FILE = "hand.csv"


def _in_planes(given: Any, read: Callable[[Any], Value], example: str) -> tuple[Value, ...]:
    """One value, or two by the names of the planes; `read` raises a `UsageError`."""
    if not isinstance(given, dict):
        if isinstance(given, list | tuple):
            table = ", ".join(f'{plane} = "{example}"' for plane in PLANES)
            raise problem(f'got {described(given)}; give "{example}", or {{ {table} }}')
        return (_read(given, read, ""),)
    for key in given:
        if key not in PLANES:
            raise problem(unknown(key, PLANES, "plane"), key)
    for plane in PLANES:
        if plane not in given:
            raise problem(f'missing; add {plane} = "{example}"', plane)
    return tuple(_read(given[plane], read, plane) for plane in PLANES)


def _read(given: Any, read: Callable[[Any], Value], plane: str) -> Value:
    try:
        return read(given)
    except UsageError as error:
        raise problem(str(error), plane) from error


def _schema(text: JsonSchemaValue, description: str) -> WithJsonSchema:
    table: JsonSchemaValue = {
        "type": "object",
        "properties": dict.fromkeys(PLANES, text),
        "required": [*PLANES],
        "additionalProperties": False,
    }
    return WithJsonSchema({"anyOf": [text, table], "description": description})


def _quantity(dimension: quantities.Dimension) -> tuple[BeforeValidator, WithJsonSchema]:
    kind = quantities.KINDS[dimension]

    def read(given: Any) -> tuple[float, ...]:
        found = _in_planes(given, lambda text: quantities.parse(text, dimension), kind.example)
        return found if len(found) == 2 else found * 2

    text = {"type": "string", "pattern": quantities.pattern(dimension), "examples": [kind.example]}
    description = (
        f"{kind.noun}: number, space and one of {', '.join(kind.units)}; or a table with that for "
        "the vertical and the lateral plane"
    )
    return BeforeValidator(read), _schema(text, description)


def _file(given: Any) -> str:
    if not isinstance(given, str):
        raise UsageError(f"got {described(given)}; give text in quotes")
    return given


_INERTIA = _quantity("inertia")
_STIFFNESS = _quantity("stiffness")
_DAMPING = _quantity("damping")
_TORSIONAL_STIFFNESS = _quantity("torsional stiffness")
_TORSIONAL_DAMPING = _quantity("torsional damping")

Inertias = TypeAliasType("Inertias", Annotated[tuple[float, float], LIST, *_INERTIA])
Stiffnesses = TypeAliasType("Stiffnesses", Annotated[tuple[float, float], LIST, *_STIFFNESS])
Dampings = TypeAliasType("Dampings", Annotated[tuple[float, float], LIST, *_DAMPING])
TorsionalStiffnesses = TypeAliasType(
    "TorsionalStiffnesses", Annotated[tuple[float, float], LIST, *_TORSIONAL_STIFFNESS]
)
TorsionalDampings = TypeAliasType(
    "TorsionalDampings", Annotated[tuple[float, float], LIST, *_TORSIONAL_DAMPING]
)
Files = TypeAliasType(
    "Files",
    Annotated[
        tuple[str, ...],
        LIST,
        BeforeValidator(lambda given: _in_planes(given, _file, FILE)),
        _schema(
            {"type": "string", "examples": [FILE]},
            "name of a file; or a table with one for the vertical and one for the lateral plane",
        ),
    ],
)
