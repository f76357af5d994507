"""Quantities, points and the base of all tables of the model file, for pydantic."""

from __future__ import annotations

from json import dumps as quoted
from typing import Annotated, Any

from pydantic import (
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Discriminator,
    Field,
    Tag,
    WithJsonSchema,
    model_validator,
)
from pydantic.fields import FieldInfo
from pydantic_core import PydanticCustomError
from typing_extensions import TypeAliasType

from equipoise import quantities
from equipoise.errors import UsageError
from equipoise.mechanism import model
from equipoise.mechanism.model import Vector
from equipoise.quantities.problems import described
from equipoise.schema.points import from_polar


def problem(sentence: str, key: str = "") -> PydanticCustomError:
    """Return an error whose whole text is ours; `key` continues the path to the place."""
    context = {"sentence": sentence, "key": key}
    return PydanticCustomError("equipoise", "{sentence}", context)


def _reader(dimension: quantities.Dimension) -> BeforeValidator:
    def read(text: object) -> float:
        try:
            return quantities.parse(text, dimension)
        except UsageError as error:
            raise problem(str(error)) from error

    return BeforeValidator(read)


def _json(dimension: quantities.Dimension) -> WithJsonSchema:
    kind = quantities.KINDS[dimension]
    return WithJsonSchema(
        {
            "type": "string",
            "description": f"{kind.noun}: number, space and one of {', '.join(kind.units)}",
            "pattern": quantities.pattern(dimension),
            "examples": [kind.example],
        }
    )


Length = TypeAliasType("Length", Annotated[float, _reader("length"), _json("length")])
Angle = TypeAliasType("Angle", Annotated[float, _reader("angle"), _json("angle")])
Mass = TypeAliasType("Mass", Annotated[float, _reader("mass"), _json("mass")])
Inertia = TypeAliasType("Inertia", Annotated[float, _reader("inertia"), _json("inertia")])
AngularSpeed = TypeAliasType(
    "AngularSpeed", Annotated[float, _reader("angular speed"), _json("angular speed")]
)
AngularAcceleration = TypeAliasType(
    "AngularAcceleration",
    Annotated[float, _reader("angular acceleration"), _json("angular acceleration")],
)
Acceleration = TypeAliasType(
    "Acceleration", Annotated[float, _reader("acceleration"), _json("acceleration")]
)
Force = TypeAliasType("Force", Annotated[float, _reader("force"), _json("force")])
Torque = TypeAliasType("Torque", Annotated[float, _reader("torque"), _json("torque")])
Speed = TypeAliasType("Speed", Annotated[float, _reader("speed"), _json("speed")])
Stiffness = TypeAliasType("Stiffness", Annotated[float, _reader("stiffness"), _json("stiffness")])
Damping = TypeAliasType("Damping", Annotated[float, _reader("damping"), _json("damping")])
DampingPerLength = TypeAliasType(
    "DampingPerLength",
    Annotated[float, _reader("damping per length"), _json("damping per length")],
)

Density = TypeAliasType("Density", Annotated[float, _reader("density"), _json("density")])
TorsionalStiffness = TypeAliasType(
    "TorsionalStiffness",
    Annotated[float, _reader("torsional stiffness"), _json("torsional stiffness")],
)
TorsionalDamping = TypeAliasType(
    "TorsionalDamping",
    Annotated[float, _reader("torsional damping"), _json("torsional damping")],
)
BendingStiffness = TypeAliasType(
    "BendingStiffness",
    Annotated[float, _reader("bending stiffness"), _json("bending stiffness")],
)
MassPerLength = TypeAliasType(
    "MassPerLength", Annotated[float, _reader("mass per length"), _json("mass per length")]
)
Modulus = TypeAliasType("Modulus", Annotated[float, _reader("modulus"), _json("modulus")])
Unbalance = TypeAliasType("Unbalance", Annotated[float, _reader("unbalance"), _json("unbalance")])
Time = TypeAliasType("Time", Annotated[float, _reader("time"), _json("time")])

# TOML knows lists only, which a strict tuple would refuse; what is in them stays strict.
PAIR = LIST = Field(strict=False)


def sized(right: str, *sizes: int, other: type = list) -> BeforeValidator:
    """Check the size of a list (any but 0 if there are none), and that it is one, or an `other`."""

    def check(given: Any) -> Any:
        if isinstance(given, list | tuple):
            if len(given) not in (sizes or range(1, len(given) + 1)):
                raise problem(f"got {described(given)}; give {right}")
        elif not isinstance(given, other):
            raise problem(f"got {described(given)}; give {right}")
        return given

    return BeforeValidator(check)


class Table(BaseModel):
    """A table of the model file."""

    model_config = ConfigDict(extra="forbid", strict=True, frozen=True, allow_inf_nan=False)

    @model_validator(mode="before")
    @classmethod
    def _keys(cls, given: Any) -> Any:
        """Say what is misspelt before saying what is missing for that reason."""
        if not isinstance(given, dict):
            return given
        fields = {field.alias or name: field for name, field in cls.model_fields.items()}
        for key in given:
            if key not in fields:
                raise problem(model.unknown(key, fields, "key"), key)
        for key, field in fields.items():
            if field.is_required() and key not in given:
                raise problem(f"missing; add {_example(key, field)}", key)
        return given


class PolarPoint(Table):
    """A point by its distance and direction from the origin."""

    distance: Length = Field(description="from the origin", examples=["88 mm"])
    direction: Angle = Field(
        description="from the x axis, positive counterclockwise", examples=["-83 deg"]
    )


def _example(key: str, field: FieldInfo) -> str:
    """Return a key and its value as they would stand in the file."""
    if not field.examples:
        return f"the table [{key}]"
    example = field.examples[0]
    if isinstance(example, dict):
        name, example = next(iter(example.items()))
        key = f"{key}.{name}"
    return f"{key} = {quoted(example)}"


LIST_TAG, TABLE_TAG, TEXT_TAG = TAGS = ("<list>", "<table>", "<text>")
"""Forms in which one thing can be given."""


def _form(point: Any) -> str | None:
    if isinstance(point, dict):
        return TABLE_TAG
    return LIST_TAG if isinstance(point, list | tuple) else None


Point = TypeAliasType(
    "Point",
    Annotated[
        Annotated[tuple[Length, Length], PAIR, Tag(LIST_TAG)]
        | Annotated[PolarPoint, Tag(TABLE_TAG)],
        Discriminator(_form, custom_error_type="point", custom_error_message="no point"),
        Field(description="x and y, or distance and direction"),
    ],
)


def vector(point: Vector | PolarPoint) -> Vector:
    """Return x and y, whichever form a point was given in."""
    if isinstance(point, PolarPoint):
        return from_polar(point.distance, point.direction)
    return point


def vectors(points: dict[str, Vector | PolarPoint]) -> dict[str, Vector]:
    """Return x and y of named points."""
    return {name: vector(point) for name, point in points.items()}
