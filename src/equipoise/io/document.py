"""The model file as pydantic models: the door only, left at once by `Document.to_machine`.

Their descriptions end up in the JSON Schema that editors read.  pydantic takes a tenth of a second
to import, so nothing imports this module before a file is read.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Annotated, Any, Literal, Protocol, TypeVar

from pydantic import ConfigDict, Field
from pydantic.json_schema import GenerateJsonSchema, JsonSchemaValue
from pydantic_core import core_schema

from equipoise.errors import ModelError
from equipoise.io import SCHEMA_VERSION
from equipoise.io.fields import (
    PAIR,
    Acceleration,
    Angle,
    AngularAcceleration,
    AngularSpeed,
    Damping,
    DampingPerLength,
    Force,
    Inertia,
    Length,
    Mass,
    Point,
    Speed,
    Stiffness,
    Table,
    Torque,
    vector,
    vectors,
)
from equipoise.mechanism import field, model
from equipoise.mechanism.field import SoilTable
from equipoise.mechanism.model import LoadTable, Machine


class Reader(Protocol):
    """Reads the tables that a model file names."""

    def load(self, file: str) -> LoadTable: ...

    def soil(self, file: str) -> SoilTable: ...


# -- tables ----------------------------------------------------------------------------------------


class Drive(Table):
    """The link that is driven."""

    link: str = Field(description="name of the driven link", examples=["crank"])
    speed: AngularSpeed = Field(description="positive is counterclockwise", examples=["193 rpm"])
    acceleration: AngularAcceleration = Field(
        0.0,
        description="of the driven link, at every crank angle",
        json_schema_extra={"default": "0 rad/s^2"},
    )


class Frame(Table):
    """The part that stands still."""

    points: dict[str, Point] = Field(
        description="fixed points by name; a link with a point of that name is pinned there",
        examples=[{"A": ["0 mm", "0 mm"]}],
    )


class Link(Table):
    """A rigid body, in axes of its own."""

    model_config = ConfigDict(
        json_schema_extra={
            "dependentRequired": {
                "mass": ["center_of_mass", "inertia"],
                "center_of_mass": ["mass", "inertia"],
                "inertia": ["mass", "center_of_mass"],
            }
        }
    )

    points: dict[str, Point] = Field(
        description="points by name; links that share a name are pinned together there",
        examples=[{"A": ["0 mm", "0 mm"], "B": ["33.5 mm", "0 mm"]}],
    )
    mass: Mass | None = Field(None, description="needed for forces")
    center_of_mass: Point | None = Field(None, description="needed for forces")
    inertia: Inertia | None = Field(None, description="about the centre of mass")

    def to_link(self) -> model.Link:
        center = self.center_of_mass
        return model.Link(
            points=vectors(self.points),
            mass=self.mass,
            center_of_mass=None if center is None else vector(center),
            inertia=self.inertia,
        )


class Slider(Table):
    """A sliding joint: a point of a link stays on a line of another, without turning in it."""

    link: str = Field(description="name of the sliding link", examples=["piston"])
    point: str = Field(description="point of the sliding link on the line", examples=["C"])
    on: str = Field(description='name of the guiding link, or "frame"', examples=["frame"])
    through: str = Field(description="point of the guide on the line", examples=["A"])
    direction: Angle = Field(
        description="of the line, in the axes of the guide", examples=["0 deg"]
    )
    angle: Angle = Field(
        0.0,
        description="of the sliding link's x axis, from the line",
        json_schema_extra={"default": "0 deg"},
    )


Teeth = Annotated[int, Field(ge=1, le=1_000_000)]


class Gear(Table):
    """Two gears on one carrier; either ratio or teeth."""

    model_config = ConfigDict(
        json_schema_extra={
            "oneOf": [{"required": ["ratio"]}, {"required": ["teeth"]}],
            "dependentRequired": {"mesh": ["teeth"]},
        }
    )

    between: Annotated[tuple[str, str], PAIR] = Field(
        description="names of driver and driven link", examples=[["crank", "wheel"]]
    )
    ratio: float | None = Field(
        None,
        description="speed of driven over driver relative to the carrier, negative for an "
        "external mesh",
        examples=[-2],
    )
    teeth: Annotated[tuple[Teeth, Teeth], PAIR] | None = Field(
        None, description="numbers of teeth of driver and driven", examples=[[20, 40]]
    )
    mesh: Literal["external", "internal"] | None = Field(
        None, description="goes with teeth", json_schema_extra={"default": "external"}
    )
    carrier: str = Field(
        model.FRAME, description='link that both are pinned to, or "frame"', examples=["frame"]
    )
    start: Angle = Field(
        0.0,
        description="of the driven link in the frame, at crank angle 0",
        json_schema_extra={"default": "0 deg"},
    )
    pressure_angle: Angle | None = Field(
        None, description="of the teeth", json_schema_extra={"default": "20 deg"}
    )

    def to_gear(self, where: str) -> model.Gear:
        if self.mesh is not None and self.teeth is None:
            raise ModelError(
                f"{where}.mesh",
                f"got {self.mesh!r} without teeth; leave it out, the sign of ratio tells: "
                "negative for external",
            )
        given = {"mesh": self.mesh, "pressure_angle": self.pressure_angle}
        return model.Gear(
            *self.between,
            ratio=self.ratio,
            teeth=self.teeth,
            carrier=self.carrier,
            start=self.start,
            **{key: value for key, value in given.items() if value is not None},  # type: ignore[arg-type]
        )


class Load(Table):
    """A force at a point or a torque on a link from outside: force, torque or table."""

    model_config = ConfigDict(
        json_schema_extra={
            "oneOf": [{"required": [key]} for key in ("force", "torque", "table")],
            "dependentRequired": {"from": ["to"], "to": ["from"], "force": ["point"]},
        }
    )

    link: str = Field(description="name of the loaded link", examples=["coupler"])
    point: str | None = Field(None, description="where a force acts")
    force: Annotated[tuple[Force, Force], PAIR] | None = Field(
        None, description="along x and y of the frame"
    )
    torque: Torque | None = Field(None, description="positive counterclockwise")
    table: str | None = Field(
        None,
        description="CSV file beside this one: crank_angle [deg],force_x [N],force_y [N] or "
        "crank_angle [deg],torque [N m]",
        examples=["force.csv"],
    )
    start: Angle | None = Field(None, alias="from", description="crank angle at which it begins")
    stop: Angle | None = Field(None, alias="to", description="crank angle at which it ends")

    def to_load(self, where: str, reader: Reader) -> model.Load:
        table = _table(self.table, f"{where}.table", reader.load)
        return model.Load(
            self.link, self.point, self.force, self.torque, self.start, self.stop, table
        )


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

    def to_soil(self, reader: Reader) -> field.Soil:
        table = _table(self.table, "planting.soil.table", reader.soil)
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

    def to_planting(self, reader: Reader) -> field.Planting:
        given = dict(self)
        given["tray"] = None if self.tray is None else tuple(vector(end) for end in self.tray)
        given["soil"] = None if self.soil is None else self.soil.to_soil(reader)
        return field.Planting(**given)


Value = TypeVar("Value")


def _table(file: str | None, where: str, read: Callable[[str], Value]) -> Value | None:
    try:
        return None if file is None else read(file)
    except ModelError as error:
        raise ModelError(where, error.what) from error


class Position(Table):
    """Rough position at one crank angle, where dyads do not suffice."""

    crank_angle: Angle = Field(
        0.0, description="at which it holds", json_schema_extra={"default": "0 deg"}
    )
    points: dict[str, Point] = Field({}, description="points in the frame, by name")
    angles: dict[str, Angle] = Field({}, description="angles of links in the frame, by name")

    def to_position(self) -> model.Position:
        return model.Position(self.crank_angle, vectors(self.points), self.angles)


class Document(Table):
    """A planar linkage with its drive, loads and gravity."""

    version: Literal[1] = Field(
        alias="schema", description="version of this format", examples=[SCHEMA_VERSION]
    )
    title: str = Field(description="shown in reports", examples=["Slider-crank"])
    description: str = Field("", description="further text")
    gravity: Annotated[tuple[Acceleration, Acceleration], PAIR] = Field(
        model.STANDARD_GRAVITY,
        description="along x and y",
        json_schema_extra={"default": ["0 m/s^2", "-9.80665 m/s^2"]},
    )
    drive: Drive
    frame: Frame
    links: dict[str, Link] = Field(description="moving links by name")
    assembly: dict[str, Literal["left", "right", "forward", "backward"]] = Field(
        {}, description="side on which the inner joint of each dyad lies, by name of the joint"
    )
    sliders: list[Slider] = Field([], description="sliding joints")
    gears: list[Gear] = Field([], description="pairs of gears")
    loads: list[Load] = Field([], description="forces and torques from outside")
    position: Position | None = None
    planting: Planting | None = None

    def to_machine(self, reader: Reader) -> Machine:
        """Return the machine; `reader` gets its tables by their files' names."""
        drive = self.drive
        return Machine(
            title=self.title,
            description=self.description,
            gravity=self.gravity,
            drive=model.Drive(drive.link, drive.speed, drive.acceleration),
            frame=vectors(self.frame.points),
            links={name: link.to_link() for name, link in self.links.items()},
            assembly=dict(self.assembly),
            sliders=tuple(model.Slider(**dict(slider)) for slider in self.sliders),
            gears=tuple(gear.to_gear(f"gears[{n}]") for n, gear in enumerate(self.gears, 1)),
            loads=tuple(
                load.to_load(f"loads[{n}]", reader) for n, load in enumerate(self.loads, 1)
            ),
            position=None if self.position is None else self.position.to_position(),
            planting=None if self.planting is None else self.planting.to_planting(reader),
        )


# -- JSON Schema -----------------------------------------------------------------------------------


class _Generator(GenerateJsonSchema):
    """Without what TOML does not know (null) and what helps nobody (titles made from names)."""

    def nullable_schema(self, schema: core_schema.NullableSchema) -> JsonSchemaValue:
        return self.generate_inner(schema["schema"])

    def default_schema(self, schema: core_schema.WithDefaultSchema) -> JsonSchemaValue:
        # Defaults are given as text with units, by json_schema_extra.
        return self.generate_inner(schema["schema"])

    def field_title_should_be_set(self, schema: Any) -> bool:
        return False


def json_schema() -> dict[str, Any]:
    """JSON Schema (draft 2020-12) of the model file."""
    schema = Document.model_json_schema(schema_generator=_Generator)
    schema["$schema"] = GenerateJsonSchema.schema_dialect
    schema["title"] = "Equipoise model file"
    return schema
