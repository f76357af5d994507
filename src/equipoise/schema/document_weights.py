"""Masses that [balance] may add to a machine, as pydantic models; see `document_balance`."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import (
    BeforeValidator,
    ConfigDict,
    Discriminator,
    Field,
    JsonValue,
    Tag,
    WithJsonSchema,
)

from equipoise.errors import ModelError
from equipoise.mechanism import balance
from equipoise.mechanism.balance import CUT, MATERIALS
from equipoise.mechanism.weights import HOLLOW
from equipoise.quantities.problems import described
from equipoise.schema.fields import (
    LIST,
    LIST_TAG,
    PAIR,
    TEXT_TAG,
    Angle,
    Density,
    Length,
    Mass,
    Point,
    Table,
    problem,
    sized,
    vector,
)

# -- JSON Schema -----------------------------------------------------------------------------------

Condition = dict[str, JsonValue]


def _needs(*keys: str) -> Condition:
    return {"required": list[JsonValue](keys)}


def _lacks(*keys: str) -> Condition:
    return {"properties": dict.fromkeys(keys, False)}


def _any_of(*keys: str) -> Condition:
    return {"anyOf": [_needs(key) for key in keys]}


def _not_both(*keys: str) -> Condition:
    return {"not": _needs(*keys)}


def _of_shapes(*shapes: str) -> Condition:
    return {"properties": {"shape": {"enum": list[JsonValue](shapes)}}, **_needs("shape")}


WEIGHT: list[JsonValue] = [
    _not_both("material", "density"),
    _not_both("mass", "at_most"),
    _any_of("radius", "mass"),
    {
        "if": _of_shapes(*CUT),
        "then": {**_needs("radius", "thickness"), **_any_of("material", "density")},
        "else": _lacks("thickness", "material", "density"),
    },
    {"if": _needs("inner_radius"), "then": _of_shapes(*HOLLOW)},
]
GEARED: list[JsonValue] = [
    {
        "oneOf": [
            {
                **_needs("ratio"),
                **_lacks("teeth", "module"),
                "oneOf": [_needs("pitch_radius"), _needs("axis")],
            },
            {**_needs("teeth", "module"), **_lacks("ratio", "pitch_radius")},
        ]
    },
    _not_both("axis", "direction"),
    _not_both("gear_material", "gear_density"),
    {
        "if": _needs("gear_thickness"),
        "then": _any_of("gear_material", "gear_density"),
        "else": _lacks("gear_material", "gear_density"),
    },
]


def _weight_with(*more: Any) -> ConfigDict:
    return ConfigDict(json_schema_extra={"allOf": [*WEIGHT, *more]})


# -- tables ----------------------------------------------------------------------------------------


def _material(**more: Any) -> Any:
    extra: Any = {"enum": [*MATERIALS]}
    return Field(None, json_schema_extra=extra, examples=["steel"], **more)


class Weighted(Table):
    """What all tables with a weight have."""

    shape: Literal["any", "point", "disc", "ring", "sector"] = Field(
        "any",
        description="any: however it is spread in its room; point: in one point; disc: a round "
        "plate anywhere in the room; ring and sector: about the centre",
        json_schema_extra={"default": "any"},
    )
    radius: Length | None = Field(
        None, description="of the room about the centre", examples=["60 mm"]
    )
    inner_radius: Length = Field(
        0.0, description="of ring and sector", json_schema_extra={"default": "0 mm"}
    )
    thickness: Length | None = Field(
        None, description="of the plate that it is cut from", examples=["8 mm"]
    )
    material: str | None = _material(description="of that plate")
    density: Density | None = Field(None, description="of that plate, instead of material")
    mass: Mass | None = Field(None, description="where it is given", examples=["500 g"])
    at_most: Mass | None = Field(None, description="limit of the mass", examples=["800 g"])

    def to_weight(self, where: str) -> balance.Weight:
        given = {
            "radius": self.radius,
            "density": _density(where, self.material, self.density),
            **{key: getattr(self, key) for key in ("thickness", "mass", "at_most")},
        }
        return balance.Weight(
            shape=self.shape,
            inner_radius=self.inner_radius,
            **{key: value for key, value in given.items() if value is not None},
        )


def _density(
    where: str, material: str | None, density: float | None, prefix: str = ""
) -> float | None:
    """Density (kg/m3) of what is given by name or by number."""
    if material is None:
        return density
    if density is not None:
        raise ModelError(where, f"give either {prefix}material or {prefix}density")
    if material not in MATERIALS:
        shown = material if len(material) <= 60 else f"{material[:57]}..."
        raise ModelError(
            f"{where}.{prefix}material",
            f"no material is called {shown!r}; there are {', '.join(map(repr, MATERIALS))}, or "
            f"give {prefix}density",
        )
    return MATERIALS[material]


class AddedMass(Weighted):
    """Mass that may be added to a link, about one of its points."""

    model_config = _weight_with()

    link: str = Field(description="name of the link", examples=["crank"])
    at: str = Field(description="point of the link, the centre of the room", examples=["A"])

    def to_mass(self, where: str) -> balance.AddedMass:
        return balance.AddedMass(self.link, self.at, self.to_weight(where))


def _one_or_two(given: Any) -> Any:
    """Make two equal numbers of one."""
    if isinstance(given, int | float) and not isinstance(given, bool):
        return (given, given)
    if isinstance(given, list | tuple) and len(given) == 2:
        return given
    raise problem(
        f"got {described(given)}; give a plain number, or the least and the most such as [0.3, 2]"
    )


_NUMBER: JsonValue = {"type": "number", "exclusiveMinimum": 0}
Ratio = Annotated[
    tuple[float, float],
    PAIR,
    BeforeValidator(_one_or_two),
    WithJsonSchema(
        {"anyOf": [_NUMBER, {"type": "array", "items": _NUMBER, "minItems": 2, "maxItems": 2}]}
    ),
]
Direction = Annotated[
    Annotated[Angle, Tag(TEXT_TAG)] | Annotated[tuple[Angle, Angle], PAIR, Tag(LIST_TAG)],
    Discriminator(lambda given: LIST_TAG if isinstance(given, list | tuple) else TEXT_TAG),
]
Teeth = Annotated[int, Field(ge=1, le=1_000_000)]
Names = Annotated[tuple[str, ...], LIST, sized('a list of names such as ["coupler"]')]


class GearedWeight(Weighted):
    """A counterweight on a shaft of its own, geared to a link that turns about a fixed pin."""

    model_config = _weight_with(*GEARED)

    driver: str = Field(
        description="link with the other gear, pinned to the frame", examples=["rocker"]
    )
    ratio: Ratio | None = Field(
        None,
        description="size of the speed of the shaft over that of the driver: a number, or the "
        "least and the most",
        examples=[[0.3, 2]],
    )
    teeth: Annotated[tuple[Teeth, Teeth], PAIR] | None = Field(
        None, description="least and most of either gear, instead of ratio", examples=[[17, 80]]
    )
    module: Length | None = Field(None, description="goes with teeth", examples=["2 mm"])
    pitch_radius: Length | None = Field(
        None, description="of the driver's gear; goes with ratio", examples=["50 mm"]
    )
    direction: Direction | None = Field(
        None,
        description="from the driver's pin to the shaft: an angle, or the least and the most; if "
        "left out as from the drive's pivot to that pin",
        examples=["0 deg"],
    )
    axis: Point | None = Field(None, description="of the shaft in the frame, instead of direction")
    gear_thickness: Length | None = Field(
        None, description="of both gears, solid discs; if left out they have no mass"
    )
    gear_material: str | None = _material(description="of both gears")
    gear_density: Density | None = Field(None, description="of both gears, instead of material")
    clear_of: Names | None = Field(
        None, description="links that the counterweight must not touch", examples=[["coupler"]]
    )
    name: str = Field(
        balance.GearedWeight.name,
        description="of the new link",
        json_schema_extra={"default": balance.GearedWeight.name},
    )

    def to_geared(self, where: str) -> balance.GearedWeight:
        same = ("ratio", "teeth", "module", "pitch_radius", "gear_thickness", "name")
        way = self.direction
        return balance.GearedWeight(
            driver=self.driver,
            weight=self.to_weight(where),
            axis=None if self.axis is None else vector(self.axis),
            gear_density=_density(where, self.gear_material, self.gear_density, "gear_"),
            direction=(way, way) if isinstance(way, float) else way,
            clear_of=self.clear_of or (),
            **{key: getattr(self, key) for key in same},
        )


class BalanceShafts(Weighted):
    """Two shafts that turn against each other, each with a weight of its own."""

    model_config = _weight_with({"properties": {"shape": {"not": {"const": "ring"}}}})

    order: Literal[1, 2] = Field(description="turns in one turn of the crank", examples=[2])
    axes: Annotated[tuple[Point, Point], PAIR] = Field(
        description="of the shaft that is geared to the drive's link, and of the other",
        examples=[[["0 mm", "-60 mm"], ["40 mm", "-60 mm"]]],
    )
    name: str = Field(
        balance.BalanceShafts.name,
        description="of the new links, with -1 and -2 behind it",
        json_schema_extra={"default": balance.BalanceShafts.name},
    )

    def to_shafts(self, where: str) -> balance.BalanceShafts:
        axes = (vector(self.axes[0]), vector(self.axes[1]))
        return balance.BalanceShafts(self.order, axes, self.to_weight(where), self.name)
