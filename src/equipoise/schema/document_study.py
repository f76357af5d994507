"""The study file as pydantic models: the door only, left at once by `studies`.

What a value is measured in is told by the number of the model that varies, or by the figure that is
limited, so values come through here as they are.
"""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import ConfigDict, Field, WithJsonSchema
from typing_extensions import TypeAliasType

from equipoise.quantities.units import NUMBER
from equipoise.schema import SCHEMA_VERSION
from equipoise.schema.fields import LIST, PAIR, Table, sized
from equipoise.studies.checks import COMMANDS, METHODS

Value = TypeAliasType(
    "Value",
    Annotated[
        Any,
        WithJsonSchema(
            {
                "anyOf": [
                    {"type": "number"},
                    {"type": "string", "pattern": rf"^{NUMBER} +\S"},
                ],
                "description": "number, space and unit in quotes, or a plain number",
                "examples": ["60 mm"],
            }
        ),
    ],
)
"""Number and unit in quotes, or a plain number: which, is told by what it is a value of."""
Values = Annotated[tuple[Value, ...], LIST, sized('a list such as ["100 g", "200 g"]')]
Limits = Annotated[tuple[Value, Value], PAIR, sized('two limits, such as ["60 mm", "80 mm"]', 2)]
Names = Annotated[tuple[str, str], PAIR, sized("a list of two paths", 2)]


class Normal(Table):
    """A normal spread."""

    deviation: Value = Field(description="standard deviation", examples=["2 g"])
    mean: Value = Field(None, description="that of the model if left out")
    cut: float | None = Field(None, description="deviations beyond which nothing lies")


class Uniform(Table):
    """A uniform spread."""

    half_width: Value = Field(description="to either side of the centre", examples=["0.1 mm"])
    centre: Value = Field(None, description="that of the model if left out")


class Vary(Table):
    """A number of the model that varies: over a range or a list, or by a tolerance."""

    model_config = ConfigDict(
        json_schema_extra={
            "oneOf": [{"required": [key]} for key in ("range", "list", "normal", "uniform")],
            "dependentRequired": {"steps": ["range"]},
        }
    )

    path: str = Field(description="of it in the model file", examples=["links.crank.mass"])
    range: Limits | None = Field(None, description="lowest and highest")
    steps: int | None = Field(None, description="of a range on a grid")
    list: Values | None = Field(None, description="all that it can be")
    normal: Normal | None = None
    uniform: Uniform | None = None


class Correlation(Table):
    """Two numbers that go together."""

    between: Names = Field(description="paths of both", examples=[["links.a.mass", "links.b.mass"]])
    coefficient: float = Field(description="between -1 and 1", examples=[0.9])


class Sampling(Table):
    """Which designs are computed."""

    method: str = Field(
        description="how designs are spread",
        examples=["sobol"],
        json_schema_extra={"enum": list[Any](METHODS)},
    )
    designs: int | None = Field(None, description="their number; not of a grid")
    seed: int = Field(1, description="of random numbers; not of a grid")


class Output(Table):
    """A figure that is computed of every design."""

    value: str = Field(
        description="place in the JSON object of the command", examples=["shaking_force.y.rms"]
    )
    name: str | None = Field(None, description="of its column; its place if left out")
    of: str | None = Field(
        None,
        description="the command that has it",
        json_schema_extra={"enum": list[Any](COMMANDS)},
    )
    at_least: Value = Field(None, description="designs below are not kept")
    at_most: Value = Field(None, description="designs above are not kept")
    make: Literal["smallest", "largest"] | None = None


class Accuracy(Table):
    """How exactly figures of an analysis are computed."""

    model_config = ConfigDict(json_schema_extra={"maxProperties": 1})

    angles: int | None = Field(None, description="crank angles in a turn")
    tolerance: float | None = Field(None, description="to which figures stand still")


class StudyDocument(Table):
    """Many designs of one model."""

    version: Literal[1] = Field(alias="schema", examples=[SCHEMA_VERSION])
    title: str | None = Field(None, description="that of the model if left out")
    model: str = Field(
        description="model file beside this one, or name of a bundled example",
        examples=["yamashita-1"],
    )
    vary: list[Vary] = Field(description="what varies")
    correlations: list[Correlation] = Field([], description="what goes together")
    sampling: Sampling = Field(examples=[{"method": "sobol"}])
    outputs: list[Output] = Field(description="what is computed")
    accuracy: Accuracy | None = None
