"""The model file as pydantic models: the door only, left at once by `Document.to_machine`.

Their descriptions end up in the JSON Schema that editors read (`schema`).  pydantic takes a tenth
of a second to import, so nothing imports this module before a file is read.
"""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import ConfigDict, Field

from equipoise.errors import ModelError
from equipoise.mechanism import model
from equipoise.mechanism.model import Machine
from equipoise.schema import SCHEMA_VERSION
from equipoise.schema.document_motor import Motor
from equipoise.schema.document_planting import Planting
from equipoise.schema.document_spring import Spring
from equipoise.schema.document_support import Row, Support
from equipoise.schema.fields import (
    PAIR,
    Acceleration,
    Angle,
    AngularAcceleration,
    AngularSpeed,
    Force,
    Inertia,
    Mass,
    Point,
    Table,
    Torque,
    vector,
    vectors,
)
from equipoise.schema.opening import Beside, table_at

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
    flywheel: Inertia = Field(
        0.0,
        description="moment of inertia of what turns with the driven link beside it",
        json_schema_extra={"default": "0 kg m^2"},
    )
    motor: Motor | None = None

    def to_drive(self, reader: Beside) -> model.Drive:
        given = dict(self)
        given["motor"] = None if self.motor is None else self.motor.to_motor(reader)
        return model.Drive(**given)


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

    def to_load(self, where: str, reader: Beside) -> model.Load:
        table = table_at(f"{where}.table", self.table, reader.load)
        return model.Load(
            self.link, self.point, self.force, self.torque, self.start, self.stop, table
        )


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
    """A planar linkage with its drive, loads, springs and gravity."""

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
    springs: list[Spring] = Field([], description="linear springs between links and frame")
    position: Position | None = None
    planting: Planting | None = None
    support: Support | None = None
    rows: list[Row] = Field(
        [], description="equal linkages on one shaft; the one of this file if left out"
    )
    balance: dict[str, Any] | None = None
    """Read when the machine is there; few files have it, and its models take time to build."""

    def to_machine(self, reader: Beside) -> Machine:
        """Return the machine; `reader` gets its tables by their files' names."""
        machine = self._without_balance(reader)
        if self.balance is None:
            return machine
        from equipoise.schema.document_balance import read_balance

        return machine.with_balance(read_balance(self.balance, machine))

    def _without_balance(self, reader: Beside) -> Machine:
        return Machine(
            title=self.title,
            description=self.description,
            gravity=self.gravity,
            drive=self.drive.to_drive(reader),
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
            support=None if self.support is None else self.support.to_support(),
            rows=tuple(row.to_row() for row in self.rows),
            springs=tuple(spring.to_spring() for spring in self.springs),
        )
