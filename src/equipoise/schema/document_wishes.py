"""What [balance] is to make small, and what it must keep, as pydantic models."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field, WithJsonSchema

from equipoise.errors import ModelError, UsageError
from equipoise.mechanism import balance
from equipoise.mechanism.model import Machine
from equipoise.mechanism.objectives import quantity_of, wrong_limit
from equipoise.quantities import Dimension, parse, pattern
from equipoise.quantities.problems import described
from equipoise.schema.fields import LIST, AngularSpeed, Table, problem, sized
from equipoise.schema.numbers import SHARE, parse_share

MEASURED_IN: tuple[Dimension, ...] = ("force", "torque", "energy", "length", "angle")
"""What measures of outputs can be."""


def _text(given: Any) -> Any:
    if isinstance(given, str):
        return given
    raise problem(
        f"got {described(given)}; give number and unit in quotes, such as "
        '"120 N", or a share of the value before, such as "80 %"'
    )


Orders = Annotated[
    tuple[Annotated[float, Field(ge=0)], ...], LIST, sized("a list of numbers such as [1, 2]")
]
Speeds = Annotated[tuple[AngularSpeed, ...], LIST, sized('a list such as ["150 rpm", "240 rpm"]')]
Size = Annotated[
    str,
    BeforeValidator(_text),
    WithJsonSchema(
        {
            "type": "string",
            "pattern": "|".join([f"^{SHARE}$", *map(pattern, MEASURED_IN)]),
            "examples": ["120 N", "80 %"],
        }
    ),
]


class Measured(Table):
    """An output and its measure."""

    output: str = Field(
        description="such as shaking_force.y, shaking_force, shaking_moment, drive_torque, "
        "frame_force, frame_moment, joints.NAME, gauges.NAME, roll_moment, yaw_moment",
        examples=["shaking_moment"],
    )
    measure: Literal["rms", "ripple", "peak", "peak_to_peak", "area"] = Field(
        "rms",
        description="root of the mean square; the same about the mean; largest size; largest "
        "minus smallest value; area under the size over one turn",
        json_schema_extra={"default": "rms"},
    )
    orders: Orders | None = Field(
        None,
        description="those that count, events in one turn of the crank; all if left out",
        examples=[[1, 2]],
    )
    about: str | None = Field(
        None,
        description="point of the frame for shaking_moment and frame_moment; the drive's pivot if "
        "left out",
    )
    speeds: Speeds | None = Field(
        None,
        description="of the crank, at which a gauge is read; the loudest counts; the drive's if "
        "left out",
        examples=[["150 rpm", "240 rpm"]],
    )

    def to_objective(self) -> balance.Objective:
        return balance.Objective(**{k: v for k, v in self._measured().items() if v is not None})

    def _measured(self) -> dict[str, Any]:
        return {key: getattr(self, key) for key in Measured.model_fields}


class Objective(Measured):
    """What is to become small."""

    weight: float = Field(
        1.0,
        description="by which it counts where there are several, each over its value before",
        json_schema_extra={"default": 1, "exclusiveMinimum": 0},
    )

    def _measured(self) -> dict[str, Any]:
        return {**super()._measured(), "weight": self.weight}


class Limit(Measured):
    """What must not become larger."""

    at_most: Size = Field(
        description="in a unit of the output, or a share of the value before",
        examples=["120 N", "80 %"],
    )

    def to_limit(self, where: str, machine: Machine) -> balance.Limit:
        objective = self.to_objective()
        try:
            share = parse_share(self.at_most)
            if share is not None:
                return balance.Limit(objective, ratio=share)
            # Only an output that there is tells what unit is wanted.
            for wrong in wrong_limit(where, balance.Limit(objective, at_most=1.0), machine):
                raise wrong
            quantity = quantity_of(objective, machine)
            assert quantity is not None
            return balance.Limit(objective, at_most=parse(self.at_most, quantity))
        except UsageError as error:
            raise ModelError(f"{where}.at_most", str(error)) from error
