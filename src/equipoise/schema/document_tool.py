"""The file of a hand-held tool as pydantic models: the door only, as `document` for linkages."""

from __future__ import annotations

from typing import Literal

from pydantic import ConfigDict, Field

from equipoise.errors import ModelError
from equipoise.handheld import model
from equipoise.handheld.model import CAUSES
from equipoise.schema import SCHEMA_VERSION
from equipoise.schema.document_design import Design, Speeds
from equipoise.schema.document_shaft import Shaft
from equipoise.schema.fields import Angle, AngularSpeed, Force, Table, Time, Unbalance
from equipoise.schema.opening import Beside, table_at
from equipoise.schema.plain import usual_name


class Excitation(Table):
    """What shakes the tool at a station: a force, an unbalance or a linkage."""

    model_config = ConfigDict(
        json_schema_extra={
            "oneOf": [{"required": [key]} for key in CAUSES],
            "dependentRequired": {"direction": ["force"]},
        }
    )

    name: str | None = Field(None, description="if left out, that of the station and what it is")
    station: str = Field(description="where it acts", examples=["engine"])
    force: Force | None = Field(None, description="amplitude, the same at all speeds")
    unbalance: Unbalance | None = Field(None, description="mass times radius of what turns")
    linkage: str | None = Field(
        None,
        description="model file beside this one, or name of a bundled linkage, whose shaking force "
        "acts: its x lateral, its y vertical",
        examples=["engine.toml"],
    )
    direction: Literal["vertical", "lateral", "rotating"] | None = Field(
        None, description="of a force", json_schema_extra={"default": "vertical"}
    )
    phase: Angle = Field(
        0.0,
        description="by which it is ahead; of an unbalance or linkage, the angle of its shaft",
        json_schema_extra={"default": "0 deg"},
    )
    ratio: float = Field(
        1.0,
        description="its speed over that of the engine; negative turns the other way",
        json_schema_extra={"default": 1, "not": {"const": 0}},
    )

    def to_excitation(self, where: str, reader: Beside) -> model.Excitation:
        if self.direction is not None and self.force is None:
            raise ModelError(f"{where}.direction", "goes with a force; leave it out")
        cause = next((key for key in CAUSES if getattr(self, key) is not None), "")
        return model.Excitation(
            name=usual_name(self.station, cause) if self.name is None else self.name,
            station=self.station,
            force=self.force,
            unbalance=self.unbalance,
            linkage=table_at(f"{where}.linkage", self.linkage, reader.linkage),
            direction=self.direction or "vertical",
            phase=self.phase,
            ratio=self.ratio,
            file=self.linkage or "",
        )


class Operation(Table):
    """Speeds of the engine."""

    speed: AngularSpeed = Field(description="at work", examples=["7000 rpm"])
    speeds: Speeds | None = Field(
        None, description="lowest and highest at work", examples=[["2000 rpm", "9000 rpm"]]
    )
    idling: AngularSpeed | None = Field(None, description="while it idles", examples=["2700 rpm"])
    racing: AngularSpeed | None = Field(
        None, description="at full throttle without load", examples=["9500 rpm"]
    )

    def to_operation(self) -> model.Operation:
        return model.Operation(**{**dict(self), "speeds": self.speeds or ()})


class Work(Table):
    """A part of the day."""

    name: str = Field(description="of the work", examples=["mowing"])
    speed: AngularSpeed = Field(description="of the engine", examples=["7000 rpm"])
    duration: Time = Field(description="of it in a day", examples=["2 h"])

    def to_work(self) -> model.Work:
        return model.Work(**dict(self))


class ToolDocument(Table):
    """A hand-held tool: a shaft in bending, what sits on it and what shakes it."""

    version: Literal[1] = Field(
        alias="schema", description="version of this format", examples=[SCHEMA_VERSION]
    )
    title: str = Field(description="shown in reports", examples=["Brush cutter"])
    description: str = Field("", description="further text")
    shaft: Shaft
    excitations: list[Excitation] = Field([], description="what shakes the tool")
    operation: Operation | None = None
    work: list[Work] = Field([], description="the parts of a day")
    design: Design | None = None

    def to_tool(self, reader: Beside) -> model.Tool:
        """Return the tool; `reader` gets its tables and linkages by their files' names."""
        return model.Tool(
            title=self.title,
            description=self.description,
            shaft=self.shaft.to_shaft(),
            stations=self.shaft.to_stations(reader),
            excitations=tuple(
                excitation.to_excitation(f"excitations[{number}]", reader)
                for number, excitation in enumerate(self.excitations, 1)
            ),
            operation=None if self.operation is None else self.operation.to_operation(),
            work=tuple(work.to_work() for work in self.work),
            design=None if self.design is None else self.design.to_design(),
        )
