"""The table [design] of a tool's file as pydantic models; see `document_tool`."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, ConfigDict, Field, JsonValue, WithJsonSchema

from equipoise.errors import ModelError, UsageError
from equipoise.handheld import design_plan
from equipoise.handheld.design_plan import KEYS, OUTPUTS
from equipoise.mechanism.checks import unknown
from equipoise.quantities import parse, pattern
from equipoise.quantities.problems import described
from equipoise.schema.fields import LIST, PAIR, AngularSpeed, Table, problem, sized

Speeds = Annotated[
    tuple[AngularSpeed, AngularSpeed], PAIR, sized('two such as ["6000 rpm", "8000 rpm"]', 2)
]
Names = Annotated[tuple[str, ...], LIST, sized('a list of names such as ["handle"]')]


def _text(given: Any) -> Any:
    if isinstance(given, str):
        return given
    raise problem(f"got {described(given)}; give number and unit in quotes")


Size = Annotated[str, BeforeValidator(_text), WithJsonSchema({"type": "string"})]
"""A quantity whose dimension another key tells."""


def _of_dimension(key: str, sizes: tuple[str, ...], dimensions: dict[str, Any]) -> ConfigDict:
    """JSON Schema of a table in which `key` tells the dimension of `sizes`."""
    cases: list[JsonValue] = []
    for dimension in dict.fromkeys(dimensions.values()):
        names: list[JsonValue] = [name for name, own in dimensions.items() if own == dimension]
        right: JsonValue = {"pattern": pattern(dimension)}
        cases.append(
            {
                "if": {"properties": {key: {"enum": names}}, "required": [key]},
                "then": {"properties": dict.fromkeys(sizes, right)},
            }
        )
    return ConfigDict(json_schema_extra={"allOf": cases})


def _size(where: str, text: str, dimension: Any) -> float:
    try:
        return parse(text, dimension)
    except UsageError as error:
        raise ModelError(where, str(error)) from error


class Variable(Table):
    """A number of a station that may be changed within a range."""

    model_config = _of_dimension("key", ("from", "to"), KEYS)

    station: str = Field(description="name of the station", examples=["belt"])
    key: str = Field(
        description="of the station; those of a part of it with a dot",
        examples=["position"],
        json_schema_extra={"enum": list[Any](KEYS)},
    )
    low: Size = Field(alias="from", description="the least", examples=["0.1 m"])
    high: Size = Field(alias="to", description="the most", examples=["0.5 m"])

    def to_variable(self, where: str) -> design_plan.DesignVariable:
        if self.key not in KEYS:
            raise ModelError(f"{where}.key", unknown(self.key, KEYS, "key of a station"))
        low = _size(f"{where}.from", self.low, KEYS[self.key])
        high = _size(f"{where}.to", self.high, KEYS[self.key])
        return design_plan.DesignVariable(self.station, self.key, low, high)


class Limit(Table):
    """What must not become larger."""

    model_config = _of_dimension("output", ("at_most",), OUTPUTS)

    output: str = Field(
        description="acceleration: weighted, of a station that is held; force: on the body, at a "
        "station; added_mass: all that is added",
        examples=["acceleration"],
        json_schema_extra={"enum": list[Any](OUTPUTS)},
    )
    station: str | None = Field(None, description="of an acceleration or force")
    at_most: Size = Field(description="in a unit of the output", examples=["5 m/s^2"])

    def to_ceiling(self, where: str) -> design_plan.DesignLimit:
        if self.output not in OUTPUTS:
            raise ModelError(f"{where}.output", unknown(self.output, OUTPUTS, "output"))
        at_most = _size(f"{where}.at_most", self.at_most, OUTPUTS[self.output])
        return design_plan.DesignLimit(self.output, at_most, self.station)


class Design(Table):
    """What may be changed so that the hands feel less, and what must be kept."""

    speeds: Speeds = Field(
        description="lowest and highest speed of the engine", examples=[["6000 rpm", "8000 rpm"]]
    )
    variables: list[Variable] = Field([], description="what may be changed")
    limits: list[Limit] = Field([], description="what must not become larger")
    measure: Literal["rms", "peak"] = Field(
        "rms",
        description="over the speeds: root of the mean square, or the largest",
        json_schema_extra={"default": "rms"},
    )
    hands: Names | None = Field(
        None, description="stations that count; all that are held if left out"
    )

    def to_design(self) -> design_plan.DesignPlan:
        return design_plan.DesignPlan(
            speeds=self.speeds,
            variables=tuple(
                variable.to_variable(f"design.variables[{number}]")
                for number, variable in enumerate(self.variables, 1)
            ),
            limits=tuple(
                limit.to_ceiling(f"design.limits[{number}]")
                for number, limit in enumerate(self.limits, 1)
            ),
            measure=self.measure,
            hands=self.hands or (),
        )
