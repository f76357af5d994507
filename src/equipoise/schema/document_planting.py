"""The table [planting] of the model file as pydantic models; see `document`."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import ConfigDict, Field

from equipoise.mechanism import field
from equipoise.schema.fields import (
    PAIR,
    Acceleration,
    Angle,
    Damping,
    DampingPerLength,
    Force,
    Length,
    Point,
    Speed,
    Stiffness,
    Table,
    vector,
)
from equipoise.schema.opening import Beside, table_at


class Soil(Table):
    """What the soil does to the tip below its surface: a force against its motion over ground."""

    resistance: Force = Field(
        0.0, description="constant part of the force", json_schema_extra={"default": "0 N"}
    )
    per_depth: Stiffness = Field(
        0.0, description="force for each unit of depth", json_schema_extra={"default": "0 N/m"}
    )
    per_speed: Damping = Field(
        0.0,
        description="force for each unit of the tip's speed over ground",
        json_schema_extra={"default": "0 N s/m"},
    )
    per_depth_and_speed: DampingPerLength = Field(
        0.0,
        description="force for each unit of depth times speed",
        json_schema_extra={"default": "0 N s/m^2"},
    )
    table: str | None = Field(
        None,
        description="CSV file beside this one: depth [mm],resistance [N]",
        examples=["soil.csv"],
    )

    def to_soil(self, reader: Beside) -> field.Soil:
        table = table_at("planting.soil.table", self.table, reader.soil)
        parts = (self.resistance, self.per_depth, self.per_speed, self.per_depth_and_speed)
        return field.Soil(*parts, table)


class Planting(Table):
    """The planting finger and the field it works in; needed by `equipoise plant`."""

    model_config = ConfigDict(
        json_schema_extra={
            "allOf": [
                {"oneOf": [{"required": [one]}, {"required": [other]}]}
                for one, other in (("forward_speed", "hill_spacing"), ("depth", "surface"))
            ]
        }
    )

    tip: str = Field(description="point of a link that goes into the soil", examples=["P"])
    forward_speed: Speed | None = Field(
        None, description="of the machine over ground", examples=["0.6 m/s"]
    )
    hill_spacing: Length | None = Field(
        None, description="of hills along a row, instead of forward_speed", examples=["15 cm"]
    )
    units_per_turn: Annotated[int, Field(ge=1, le=1_000_000)] = Field(
        1, description="hills planted in a row in one turn of the drive"
    )
    travel: Literal["forward", "backward"] = Field(
        "forward", description="whether the machine drives along x or against it"
    )
    depth: Length | None = Field(
        None, description="of the lowest point below the surface", examples=["4 cm"]
    )
    surface: Length | None = Field(
        None, description="height of the soil's surface in the frame, instead of depth"
    )
    finger_from: str | None = Field(
        None, description="point of the tip's link from which the finger points to the tip"
    )
    release: Angle | None = Field(
        None,
        description="crank angle at which the seedling is let go; the lowest point if left out",
    )
    tray: Annotated[tuple[Point, Point], PAIR] | None = Field(
        None, description="both ends of the edge of the seedling tray, in the frame"
    )
    acceleration_limit: Acceleration | None = Field(
        None, description="largest acceleration of the tip that is wanted"
    )
    soil_acceleration_limit: Acceleration | None = Field(
        None, description="the same while the tip is in the soil"
    )
    soil: Soil | None = None

    def to_planting(self, reader: Beside) -> field.Planting:
        given = dict(self)
        given["tray"] = None if self.tray is None else tuple(vector(end) for end in self.tray)
        given["soil"] = None if self.soil is None else self.soil.to_soil(reader)
        return field.Planting(**given)
