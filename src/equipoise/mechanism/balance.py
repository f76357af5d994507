"""What may be changed to quieten a machine, what is to become small, and what must be kept.

They are part of the model; `equipoise.balancing` computes with them.  Places are in the axes of
the link that they belong to.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import hypot, inf, pi, radians
from typing import Any, ClassVar, Literal

from equipoise.errors import ModelError
from equipoise.keys import (
    Anything,
    Conditions,
    Frozen,
    Key,
    Keys,
    Listing,
    Number,
    OneOr,
    Point,
    Quantity,
    Table,
    Tables,
    Text,
    Whole,
    declared,
    inside,
    key,
)

Pair = tuple[float, float]
Shape = Literal["any", "point", "disc", "ring", "sector"]
SHAPES: tuple[Shape, ...] = ("any", "point", "disc", "ring", "sector")
CUT = ("disc", "ring", "sector")
"""Shapes cut from a plate, which need a thickness and a density."""
HOLLOW = ("ring", "sector")
"""Shapes with an inner radius."""
RANGE = Listing(Quantity("length"), (2,))
Measure = Literal["rms", "ripple", "peak", "peak_to_peak", "area"]
MEASURES: tuple[Measure, ...] = ("rms", "ripple", "peak", "peak_to_peak", "area")
"""Root of the mean square, the same about the mean, largest size, largest minus smallest value, and
area under the absolute value over one turn of the crank."""

MATERIALS = {
    "steel": 7850.0,
    "cast iron": 7200.0,
    "brass": 8500.0,
    "lead": 11340.0,
    "tungsten alloy": 17500.0,
    "aluminium": 2700.0,
}
"""Densities, kg/m3."""


def material_of(density: float) -> str:
    """Name of the material of a density (kg/m3), or nothing where there is none."""
    return next((name for name, value in MATERIALS.items() if value == density), "")


def _with_density(given: dict[str, Any], prefix: str = "") -> dict[str, Any]:
    """The values of a table with the density (kg/m3) of what it gives by name or by number."""
    material = given.pop(f"{prefix}material", None)
    if material is None:
        return given
    if f"{prefix}density" in given:
        raise ModelError("", f"give either {prefix}material or {prefix}density")
    if material not in MATERIALS:
        shown = material if len(material) <= 60 else f"{material[:57]}..."
        raise ModelError(
            f"{prefix}material",
            f"no material is called {shown!r}; there are {', '.join(map(repr, MATERIALS))}, or "
            f"give {prefix}density",
        )
    return {**given, f"{prefix}density": MATERIALS[material]}


def _with_material(table: dict[str, Any], prefix: str = "") -> dict[str, Any]:
    """A table with the name of a material instead of its density, where it has one."""
    if name := material_of(table.get(f"{prefix}density", 0.0)):
        del table[f"{prefix}density"]
        table[f"{prefix}material"] = name
    return table


def _material(prefix: str, text: str) -> dict[str, Key]:
    kind = Text(suggested=(*MATERIALS,))
    name = f"{prefix}material"
    return {name: Key(name, kind, text, default=None, example="steel")}


def _needs(*keys: str) -> dict[str, Any]:
    return {"required": [*keys]}


def _lacks(*keys: str) -> dict[str, Any]:
    return {"properties": dict.fromkeys(keys, False)}


def _any_of(*keys: str) -> dict[str, Any]:
    return {"anyOf": [_needs(one) for one in keys]}


def _not_both(*keys: str) -> dict[str, Any]:
    return {"not": _needs(*keys)}


def _of_shapes(*shapes: str) -> dict[str, Any]:
    return {"properties": {"shape": {"enum": [*shapes]}}, **_needs("shape")}


WEIGHT = (
    _not_both("material", "density"),
    _not_both("mass", "at_most"),
    _any_of("radius", "mass"),
    {
        "if": _of_shapes(*CUT),
        "then": {**_needs("radius", "thickness"), **_any_of("material", "density")},
        "else": _lacks("thickness", "material", "density"),
    },
    {"if": _needs("inner_radius"), "then": _of_shapes(*HOLLOW)},
)
GEARED = (
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
)
"""What the JSON Schema says of keys that go together."""


@declared
class Weight(Frozen):
    """Mass that may be added about a centre, and the room that it has there.

    shape : ``any`` distribution in the room (which comes back as one or two points); one ``point``;
        a round ``disc`` anywhere in the room; a ``ring`` about the centre; a ``sector`` about the
        centre, from the inner radius to the room's edge.
    """

    beside: ClassVar[Keys] = _material("", "of that plate")
    file_order = ("shape", "radius", "inner_radius", "thickness", "material", "density")

    shape: Shape = key(
        Text(SHAPES),
        "`any`: however it is spread in its room; `point`: in one point; `disc`: a round plate "
        "anywhere in the room; `ring` and `sector`: about the centre",
        default="any",
    )
    radius: float = key(
        "length",
        "of the room about the centre; without limit if left out",
        default=inf,
        example="60 mm",
        above=0,
        endless=True,
    )
    inner_radius: float = key("length", "of ring and sector", default=0.0)
    thickness: float | None = key(
        "length",
        "of the plate that disc, ring and sector are cut from",
        default=None,
        example="8 mm",
        above=0,
    )
    density: float | None = key(
        "density", "of that plate, instead of `material`", default=None, above=0
    )
    mass: float | None = key("mass", "where it is given", default=None, example="500 g", above=0)
    at_most: float | None = key(
        "mass",
        "the most that it may be, instead of `mass`",
        default=None,
        example="800 g",
        above=0,
    )

    @classmethod
    def from_table(cls, given: dict[str, Any]) -> Weight:
        return cls(**_with_density(given))

    @classmethod
    def to_table(cls, value: Weight) -> dict[str, Any]:
        return _with_material(super().to_table(value))


@declared
class CenterMove(Frozen):
    """The centre of mass of a link may be moved, in a rectangle or in a circle; its mass, and its
    inertia about it, are kept.
    """

    conditions: ClassVar[Conditions] = {
        "dependentRequired": {"center": ["radius"], "radius": ["center"]},
        "dependentSchemas": {"center": {"properties": {"x": False, "y": False}}},
    }

    link: str = key(Text(), "a link with a mass", example="coupler")
    x: Pair | None = key(
        RANGE,
        "lowest and highest, in the link's axes; without limit if left out",
        default=None,
        example=["-60 mm", "20 mm"],
    )
    y: Pair | None = key(RANGE, "as `x`", default=None, example=["-30 mm", "30 mm"])
    center: Pair | None = key(
        Point(),
        "of a circle that the centre of mass does not leave, instead of `x` and `y`",
        default=None,
    )
    radius: float | None = key("length", "of that circle", default=None, example="40 mm", above=0)


@declared
class AddedMass(Frozen):
    """Mass may be added to a link, about one of its points."""

    conditions: ClassVar[Conditions] = {"allOf": [*WEIGHT]}

    link: str = key(Text(), "name of the link", example="crank")
    at: str = key(Text(), "point of the link, the centre of the room", example="A")
    weight: Weight = key(Table(Weight, flat=True))


@declared
class GearedWeight(Frozen):
    """A counterweight on a shaft of its own, geared to a link that is pinned to the frame.

    The gears mesh from outside, so that the shaft turns against the driver.  Ratio, teeth and
    direction are the least and the largest that they may be; gears without a thickness
    have no mass.
    """

    beside: ClassVar[Keys] = _material("gear_", "of both gears; goes with `gear_thickness`")
    file_order = ("driver", "ratio", "teeth", "module", "pitch_radius", "axis", "direction",
                  "gear_thickness", "gear_material", "gear_density", "clear_of", "weight",
                  "name")  # fmt: skip
    conditions: ClassVar[Conditions] = {"allOf": [*WEIGHT, *GEARED]}

    driver: str = key(
        Text(), "link that carries the other gear, pinned to the frame", example="rocker"
    )
    weight: Weight = key(Table(Weight, flat=True))
    ratio: Pair | None = key(
        OneOr(
            Number(),
            2,
            repeat=True,
            right="a plain number, or the least and the most such as [0.3, 2]",
        ),
        "size of the speed of the shaft over that of the driver: a number, or the least and the "
        "most",
        default=None,
        example=[0.3, 2],
    )
    teeth: tuple[int, int] | None = key(
        Listing(Whole(1), (2,)),
        "least and most of either gear, instead of `ratio`",
        default=None,
        example=[17, 80],
    )
    module: float | None = key(
        "length",
        "goes with `teeth`; each gear has the radius module times teeth over 2",
        default=None,
        example="2 mm",
        above=0,
    )
    pitch_radius: float | None = key(
        "length",
        "of the driver's gear; goes with `ratio`, where there is no `axis`",
        default=None,
        example="50 mm",
        above=0,
    )
    axis: Pair | None = key(
        Point(), "of the shaft in the frame, instead of `direction`", default=None
    )
    direction: Pair | None = key(
        OneOr(Quantity("angle"), 2, repeat=True),
        "from the driver's pin to the shaft: an angle, or the least and the most; if left out as "
        "from the drive's pivot to that pin",
        default=None,
        example="0 deg",
    )
    gear_thickness: float | None = key(
        "length",
        "of both gears, solid discs; if left out they have no mass",
        default=None,
        above=0,
    )
    gear_density: float | None = key(
        "density", "of both gears, instead of `gear_material`", default=None, above=0
    )
    clear_of: tuple[str, ...] = key(
        Listing(Text(), right='a list of names such as ["coupler"]'),
        "links that the counterweight must not touch",
        default=(),
        example=["coupler"],
    )
    name: str = key(Text(), "of the new link", default="counterweight")

    @classmethod
    def from_table(cls, given: dict[str, Any]) -> GearedWeight:
        return cls(**_with_density(given, "gear_"))

    @classmethod
    def to_table(cls, value: GearedWeight) -> dict[str, Any]:
        return _with_material(super().to_table(value), "gear_")


@declared
class BalanceShafts(Frozen):
    """Two shafts that turn against each other at one or two times the crank's speed.

    axes : of the first, which is geared to the drive's link and turns against it, and of the
        second, which is geared to the first.
    """

    conditions: ClassVar[Conditions] = {
        "allOf": [*WEIGHT, {"properties": {"shape": {"not": {"const": "ring"}}}}]
    }

    order: int = key(Whole(names=(1, 2)), "turns in one turn of the crank", example=2)
    axes: tuple[Pair, Pair] = key(
        Listing(Point(), (2,)),
        "of the shaft that is geared to the drive's link and turns against it, and of the other",
        example=[["0 mm", "-60 mm"], ["40 mm", "-60 mm"]],
    )
    weight: Weight = key(Table(Weight, flat=True))
    name: str = key(
        Text(), "of the new links, which get `-1` and `-2` behind it", default="balance-shaft"
    )


@declared
class SpringChoice(Frozen):
    """A spring may be set between a point of a link and a point of the frame."""

    link: str = key(Text(), "name of the link", example="rocker")
    point: str = key(Text(), "its point, not one that is pinned to the frame", example="C")
    to: str = key(Text(), "point of the frame", example="D2")
    stiffness: float = key("stiffness", "the most that it may have", example="5 kN/m", above=0)
    free_length: Pair | None = key(
        RANGE,
        "least and largest; any if left out",
        default=None,
        example=["20 mm", "120 mm"],
        at_least=0,
    )


@declared
class Phases(Frozen):
    """The phases of all rows but the first may be changed."""

    step: float = key(
        "angle",
        "of the grid on which they are looked for before they are polished; 90 deg at most",
        default=radians(5),
    )


@declared
class Objective(Frozen):
    """What is to become small: a measure of an output."""

    output: str = key(
        Text(),
        "such as `shaking_force.y`, `shaking_force`, `shaking_moment`, `drive_torque`, "
        "`frame_force`, `frame_moment`, `joints.NAME`, `gauges.NAME`, `roll_moment`, `yaw_moment`",
        example="shaking_moment",
    )
    measure: Measure = key(
        Text(MEASURES),
        "`rms`: root of the mean square; `ripple`: the same about the mean; `peak`: largest size; "
        "`peak_to_peak`: largest minus smallest value; `area`: under the size, over one turn of "
        "the crank",
        default="rms",
    )
    orders: tuple[float, ...] = key(
        Listing(Number(), right="a list of numbers such as [1, 2]"),
        "those that count: events in one turn of the crank, 0 for the mean; all if left out",
        default=(),
        example=[1, 2],
    )
    about: str | None = key(
        Text(),
        "point of the frame about which `shaking_moment` or `frame_moment` is taken; the drive's "
        "pivot if left out",
        default=None,
    )
    weight: float = key(
        Number(),
        "where there are several objectives, each of which counts over its value before",
        default=1.0,
        above=0,
    )
    speeds: tuple[float, ...] = key(
        Listing(Quantity("angular speed"), right='a list such as ["150 rpm", "240 rpm"]'),
        "of the crank, at which a gauge is read; the loudest counts; the drive's if left out",
        default=(),
        example=["150 rpm", "240 rpm"],
    )

    @property
    def name(self) -> str:
        """How it is called in results, such as ``rms of shaking_force.y``."""
        words = "area under" if self.measure == "area" else f"{self.measure} of"
        orders = f" (order {', '.join(f'{order:g}' for order in self.orders)})"
        about = f" about {self.about}" if self.about else ""
        if self.speeds:
            about += f" at {', '.join(f'{speed * 30 / pi:.6g}' for speed in self.speeds)} rpm"
        name = f"{words} {self.output}{about}{orders if self.orders else ''}"
        return name.replace("_to_", " to ")


@declared
class Limit(Frozen):
    """What must not become larger: a measure of an output, whose weight does not count.

    at_most : in SI units.  ratio : over the value before, instead.
    """

    beside: ClassVar[Keys] = {
        "at_most": Key(
            "at_most",
            Anything(
                text='give number and unit in quotes, such as "120 N", or a share of the value '
                'before, such as "80 %"',
            ),
            '`"120 N"`, in a unit of the output; or a share of the value before, such as `"80 %"`',
            example="120 N",
        )
    }

    objective: Objective = key(Table(Objective, flat=True))
    at_most: float | None = inside(Number(), default=None)
    ratio: float | None = inside(Number(), default=None)

    @property
    def name(self) -> str:
        return self.objective.name


@declared
class Balance(Frozen):
    """What may be changed, what is to become small, and what must be kept."""

    file_order = ("added_mass", "combine", "phases")

    moves: tuple[CenterMove, ...] = key(
        Tables(Table(CenterMove)), "links whose centre of mass may be moved", default=()
    )
    masses: tuple[AddedMass, ...] = key(
        Tables(Table(AddedMass)), "masses that may be added to links", default=()
    )
    geared: tuple[GearedWeight, ...] = key(
        Tables(Table(GearedWeight)), "counterweights geared to links", default=()
    )
    shafts: tuple[BalanceShafts, ...] = key(
        Tables(Table(BalanceShafts)), "pairs of balance shafts", default=()
    )
    springs: tuple[SpringChoice, ...] = key(
        Tables(Table(SpringChoice)), "springs that may be set", default=()
    )
    phases: Phases | None = key(
        Table(Phases, headed=True), "the phases of rows may be changed", default=None
    )
    objectives: tuple[Objective, ...] = key(
        Tables(Table(Objective)), "what is to become small", default=()
    )
    limits: tuple[Limit, ...] = key(Tables(Table(Limit)), "what must not become larger", default=())
    combine: Literal["sum", "squares"] = key(
        Text(("sum", "squares")),
        "several objectives: their weighted sum, or with `squares` the root of the weighted sum of "
        "their squares",
        default="sum",
    )
    added_mass: float | None = key(
        "mass", "the most that may be added in all", default=None, example="500 g", above=0
    )

    def combined(self, values: Sequence[float]) -> float:
        """Objectives, each over its value before, as one number."""
        found = [one.weight * value for one, value in zip(self.objectives, values, strict=True)]
        return hypot(*found) if self.combine == "squares" else sum(found)

    @property
    def changes_nothing(self) -> bool:
        """Whether nothing is free to change."""
        parts = (self.moves, self.masses, self.geared, self.shafts, self.springs)
        return not any(parts) and self.phases is None


def plate_mass(weight: Weight, area: float) -> float:
    """Mass (kg) of an area (m2) of the plate that a weight is cut from."""
    assert weight.thickness is not None and weight.density is not None
    return weight.thickness * weight.density * area


def largest_mass(weight: Weight) -> float:
    """The most mass (kg) that fits into the room of a weight."""
    if weight.shape not in CUT:
        return inf
    inner = weight.inner_radius if weight.shape != "disc" else 0.0
    return plate_mass(weight, pi * (weight.radius**2 - inner**2))
