"""The table [drive.motor] of the model file as a pydantic model; see `document`."""

from __future__ import annotations

from typing import Literal

from pydantic import ConfigDict, Field

from equipoise.mechanism import force_elements
from equipoise.schema.fields import AngularSpeed, Inertia, Table, Torque
from equipoise.schema.opening import Beside, table_at


class Motor(Table):
    """What turns the driven link: a straight line from stall to no load, or a table."""

    model_config = ConfigDict(
        json_schema_extra={
            "oneOf": [
                {"required": ["no_load_speed", "stall_torque"], "properties": {"table": False}},
                {
                    "required": ["table"],
                    "properties": {"no_load_speed": False, "stall_torque": False},
                },
            ]
        }
    )

    no_load_speed: AngularSpeed | None = Field(
        None, description="of the motor, at which its torque is 0", examples=["3000 rpm"]
    )
    stall_torque: Torque | None = Field(
        None, description="of the motor at standstill", examples=["2 N m"]
    )
    table: str | None = Field(
        None,
        description="CSV file beside this one: speed [rpm],torque [N m]",
        examples=["motor.csv"],
    )
    ratio: float = Field(
        1.0,
        description="turns of the motor in one turn of the driven link",
        json_schema_extra={"default": 1, "exclusiveMinimum": 0},
    )
    inertia: Inertia = Field(
        0.0, description="of its rotor", json_schema_extra={"default": "0 kg m^2"}
    )
    mean_speed: Literal["held", "free"] = Field(
        "held",
        description="held: the mean speed is the drive's; free: it follows from the motor",
        json_schema_extra={"default": "held"},
    )

    def to_motor(self, reader: Beside) -> force_elements.Motor:
        table = table_at("drive.motor.table", self.table, reader.motor)
        return force_elements.Motor(**{**dict(self), "table": table})
