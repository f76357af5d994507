"""The tables [support] and [[rows]] of the model file as pydantic models; see `document`."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import ConfigDict, Discriminator, Field, JsonValue, Tag
from typing_extensions import TypeAliasType

from equipoise.errors import ModelError
from equipoise.mechanism import support
from equipoise.schema.fields import (
    LIST,
    LIST_TAG,
    PAIR,
    TABLE_TAG,
    TEXT_TAG,
    Angle,
    Damping,
    Force,
    Inertia,
    Length,
    Mass,
    Point,
    PolarPoint,
    Stiffness,
    Table,
    Torque,
    TorsionalDamping,
    TorsionalStiffness,
    sized,
    vector,
)

Freedom = Literal["surge", "heave", "sway", "roll", "yaw", "pitch"]
Axis = Literal["roll", "yaw", "pitch"]

# -- lists of other lengths than two ---------------------------------------------------------------


def _table_or_list(given: Any) -> str:
    return TABLE_TAG if isinstance(given, dict) else LIST_TAG


def _text_or_list(given: Any) -> str:
    return LIST_TAG if isinstance(given, list | tuple) else TEXT_TAG


Place = TypeAliasType(
    "Place",
    Annotated[
        Annotated[
            tuple[Length, ...], Field(strict=False, min_length=2, max_length=3), Tag(LIST_TAG)
        ]
        | Annotated[PolarPoint, Tag(TABLE_TAG)],
        Discriminator(_table_or_list),
        sized('["0 mm", "300 mm"], or with z ["0 mm", "300 mm", "0 mm"]', 2, 3, other=dict),
        Field(description="x, y and z; in the plane of the drawing if z is left out"),
    ],
)
Direction = TypeAliasType(
    "Direction",
    Annotated[
        Annotated[Angle, Tag(TEXT_TAG)]
        | Annotated[tuple[float, float, float], LIST, Tag(LIST_TAG)],
        Discriminator(_text_or_list),
        sized('an angle such as "90 deg", or three plain numbers such as [0, 1, 0]', 3, other=str),
        Field(description="angle in the plane of the drawing, or a vector of three plain numbers"),
    ],
)
Inertias = Annotated[
    Annotated[Inertia, Tag(TEXT_TAG)]
    | Annotated[tuple[Inertia, Inertia, Inertia], LIST, Tag(LIST_TAG)],
    Discriminator(_text_or_list),
    sized("one moment of inertia, or a list of three, about x, y and z", 3, other=object),
]
Products = Annotated[
    tuple[Inertia, Inertia, Inertia],
    LIST,
    sized("a list of three, of x y, y z and z x", 3),
]
Freedoms = Annotated[
    tuple[Freedom, ...],
    Field(strict=False, min_length=1),
    sized('a list such as ["heave", "pitch"]; leave it out for the usual ones'),
]


def _place(given: tuple[float, ...] | PolarPoint) -> support.Place:
    """x, y and z of a place, whichever form it was given in."""
    x, y, *z = vector(given) if isinstance(given, PolarPoint) else given
    return (x, y, z[0] if z else 0.0)


# -- support ---------------------------------------------------------------------------------------

OF_POINT = ("direction", "stiffness", "damping", "preload", "one_sided")
OF_AXIS = ("torsional_stiffness", "torsional_damping", "torsional_preload")


def _point_or_axis(**conditions: Any) -> ConfigDict:
    """JSON Schema of a table that has a point or an axis, with the keys that go with it."""
    branches: list[JsonValue] = [
        {
            "required": [key],
            "properties": dict.fromkeys((*others, other), False),
            **({"anyOf": [{"required": [one]} for one in conditions[key]]} if conditions else {}),
        }
        for key, other, others in (("point", "axis", OF_AXIS), ("axis", "point", OF_POINT))
    ]
    return ConfigDict(json_schema_extra={"oneOf": branches})


def _check_company(table: Mount | Gauge, where: str) -> None:
    """Refuse keys of a point beside an axis, and the other way round."""
    if (table.point is None) == (table.axis is None):
        return  # told by the checks of the machine
    others, has = (OF_AXIS, "a point") if table.axis is None else (OF_POINT, "an axis")
    for key in others:
        if key in table.model_fields_set:
            raise ModelError(f"{where}.{key}", f"has no place beside {has}; leave it out")


class Mount(Table):
    """A spring and damper between support and ground, at a point or about an axis."""

    model_config = _point_or_axis(point=("stiffness", "damping"), axis=OF_AXIS[:2])

    point: Place | None = Field(
        None, description="of the support, where it acts", examples=[["0 mm", "300 mm"]]
    )
    direction: Direction = Field(
        support.UP,
        description="in which it pushes the support; fixed in space",
        json_schema_extra={"default": "90 deg"},
    )
    stiffness: Stiffness = Field(
        0.0, description="along the direction", json_schema_extra={"default": "0 N/m"}
    )
    damping: Damping = Field(
        0.0, description="along the direction", json_schema_extra={"default": "0 N s/m"}
    )
    preload: Force | None = Field(
        None,
        description="force with which it pushes in the drawn position; if left out, the weight "
        "rests on the mounts there",
    )
    one_sided: bool = Field(
        False, description="it can push only", json_schema_extra={"default": False}
    )
    axis: Axis | None = Field(None, description="about which it turns back, instead of point")
    torsional_stiffness: TorsionalStiffness = Field(
        0.0, description="about the axis", json_schema_extra={"default": "0 N m/rad"}
    )
    torsional_damping: TorsionalDamping = Field(
        0.0, description="about the axis", json_schema_extra={"default": "0 N m s/rad"}
    )
    torsional_preload: Torque | None = Field(
        None, description="torque with which it turns the support in the drawn position; as preload"
    )

    def to_mount(self, where: str) -> support.Mount:
        _check_company(self, where)
        given = dict(self)
        about = given.pop("torsional_preload")
        given["preload"] = self.preload if self.axis is None else about
        given["point"] = None if self.point is None else _place(self.point)
        return support.Mount(**given)


class Gauge(Table):
    """Where the motion of the support is read: displacement of a point, or a rotation."""

    model_config = _point_or_axis()

    point: Place | None = Field(
        None, description="of the support, whose displacement is read", examples=[["0 mm", "1 m"]]
    )
    direction: Direction = Field(
        support.UP,
        description="along which it is read",
        json_schema_extra={"default": "90 deg"},
    )
    axis: Axis | None = Field(None, description="about which the rotation is read")

    def to_gauge(self, where: str) -> support.Gauge:
        _check_company(self, where)
        place = None if self.point is None else _place(self.point)
        return support.Gauge(place, self.direction, self.axis)


class Support(Table):
    """The rigid body that carries the linkages, on mounts; without their moving links."""

    model_config = ConfigDict(
        json_schema_extra={
            "oneOf": [
                {"required": ["inertia"], "properties": {"pivot_inertia": False}},
                {
                    "required": ["pivot_inertia", "pivot"],
                    "properties": {"inertia": False, "products": False},
                },
            ],
            "if": {"required": ["products"]},
            "then": {"properties": {"inertia": {"type": "array"}}},
        }
    )

    mass: Mass = Field(
        description="with all that is fixed to it, motor and flywheel too", examples=["60 kg"]
    )
    center_of_mass: Place = Field(description="in the frame's axes", examples=[["0 mm", "300 mm"]])
    inertia: Inertias | None = Field(
        None,
        description="about the centre of mass: about z, or a list of three about x, y and z "
        "(roll, yaw, pitch)",
        examples=["4 kg m^2"],
    )
    products: Products | None = Field(
        None, description="integrals of x y, y z and z x over the mass, about its centre"
    )
    pivot_inertia: Inertia | None = Field(None, description="about the pivot, instead of inertia")
    pivot: Point | None = Field(None, description="pin that carries it, in the frame's axes")
    freedoms: Freedoms | None = Field(
        None,
        description="how it can move; if left out pitch with a pivot, and surge, heave and pitch "
        "without",
        examples=[["heave", "pitch"]],
        json_schema_extra={"uniqueItems": True},
    )
    mounts: dict[str, Mount] = Field({}, description="springs and dampers by name")
    gauges: dict[str, Gauge] = Field({}, description="readings of its motion by name")

    def to_support(self) -> support.Support:
        inertia = () if self.inertia is None else self.inertia
        return support.Support(
            mass=self.mass,
            center_of_mass=_place(self.center_of_mass),
            inertia=inertia if isinstance(inertia, tuple) else (inertia,),
            products=self.products or (),
            pivot_inertia=self.pivot_inertia,
            pivot=None if self.pivot is None else vector(self.pivot),
            freedoms=self.freedoms or (),
            mounts={
                name: mount.to_mount(f"support.mounts.{name}")
                for name, mount in self.mounts.items()
            },
            gauges={
                name: gauge.to_gauge(f"support.gauges.{name}")
                for name, gauge in self.gauges.items()
            },
        )


class Row(Table):
    """One of several equal linkages, all driven by one shaft."""

    phase: Angle = Field(
        0.0,
        description="by which its crank angle is larger than that of the drive",
        json_schema_extra={"default": "0 deg"},
    )
    lateral: Length = Field(
        0.0, description="z of its plane", json_schema_extra={"default": "0 mm"}
    )
    offset: Annotated[tuple[Length, Length], PAIR] = Field(
        (0.0, 0.0),
        description="x and y by which it stands beside the linkage of this file",
        json_schema_extra={"default": ["0 mm", "0 mm"]},
    )

    def to_row(self) -> support.Row:
        return support.Row(**dict(self))
