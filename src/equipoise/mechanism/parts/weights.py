"""Mass that may be added or moved: its shape and room; weights geared to links or in pairs."""

from __future__ import annotations

from collections.abc import Iterator
from math import hypot, inf, isfinite, pi, sqrt
from typing import Any, ClassVar, Literal

from equipoise.errors import ModelError
from equipoise.i18n import Note, key_names, to_say
from equipoise.keys import (
    Frozen,
    KeyConditions,
    Keys,
    KeyTable,
    Listing,
    Number,
    OneOr,
    Point,
    Quantity,
    TextKind,
    Whole,
    any_of,
    declared,
    key,
    lacks,
    needs,
    not_both,
)
from equipoise.mechanism.checks import numbered, unknown, wrong_range
from equipoise.mechanism.parts.bodies import (
    material_key,
    material_of,
    with_density,
    with_material,
)
from equipoise.mechanism.parts.links import Mechanism
from equipoise.quantities import Measured

NumberPair = tuple[float, float]
WeightShape = Literal["any", "point", "disc", "ring", "sector"]
SHAPES: tuple[WeightShape, ...] = ("any", "point", "disc", "ring", "sector")
CUT = ("disc", "ring", "sector")
"""Shapes cut from a plate, which need a thickness and a density."""
HOLLOW = ("ring", "sector")
"""Shapes with an inner radius."""
RANGE = Listing(Quantity("length"), (2,))
LARGEST_ROOM = 1000.0
"""m; far beyond any machine."""
ROUNDING = 1 + 1e-9
"""A mass that fills its room to this may have been computed from it."""

LEAST_TEETH = 5
"""Of a gear that can be cut; involutes are undercut below about 17."""

LARGEST_RATIO = 1000.0
"""Of a pair of gears; far beyond any."""


def _of_shapes(*shapes: str) -> dict[str, Any]:
    return {"properties": {"shape": {"enum": [*shapes]}}, **needs("shape")}


WEIGHT = (
    not_both("material", "density"),
    not_both("mass", "at_most"),
    any_of("radius", "mass"),
    {
        "if": _of_shapes(*CUT),
        "then": {**needs("radius", "thickness"), **any_of("material", "density")},
        "else": lacks("thickness", "material", "density"),
    },
    {"if": needs("inner_radius"), "then": _of_shapes(*HOLLOW)},
)
"""What the JSON Schema says of keys that go together."""


@declared
class Weight(Frozen):
    """Mass that may be added about a centre, and the room that it has there.

    shape : ``any`` distribution in the room (which comes back as one or two points); one ``point``;
        a round ``disc`` anywhere in the room; a ``ring`` about the centre; a ``sector`` about the
        centre, from the inner radius to the room's edge.
    """

    extra_keys: ClassVar[Keys] = material_key("", "of that plate")
    file_order = ("shape", "radius", "inner_radius", "thickness", "material", "density")

    shape: WeightShape = key(
        TextKind(SHAPES),
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
        "mass", "the most that it may be, instead of `mass`", default=None, example="800 g", above=0
    )
    plane: float | None = key(
        "length", "z of its middle; that of its link if left out", default=None, example="40 mm"
    )

    @classmethod
    def from_table(cls, given: dict[str, Any]) -> Weight:
        return cls(**with_density(given))

    @classmethod
    def to_table(cls, value: Weight) -> dict[str, Any]:
        return with_material(super().to_table(value))


@declared
class AddedMass(Frozen):
    """Mass may be added to a link, about one of its points."""

    called = to_say("{what} of added mass {number}")
    conditions: ClassVar[KeyConditions] = {"allOf": [*WEIGHT]}

    link: str = key(TextKind(of="link"), "name of the link", example="crank")
    at: str = key(
        TextKind(of="point", on="link"),
        "point of the link, the centre of the room",
        example="A",
        word=to_say("centre"),
    )
    weight: Weight = key(KeyTable(Weight, flat=True))


@declared
class CenterMove(Frozen):
    """The centre of mass of a link may be moved, in a rectangle or in a circle; its mass, and its
    inertia about it, are kept.
    """

    called = to_say("{what} of move {number}")
    conditions: ClassVar[KeyConditions] = {
        "dependentRequired": {"center": ["radius"], "radius": ["center"]},
        "dependentSchemas": {"center": {"properties": {"x": False, "y": False}}},
    }

    link: str = key(TextKind(of="link"), "a link with a mass", example="coupler")
    x: NumberPair | None = key(
        RANGE,
        "lowest and highest, in the link's axes; without limit if left out",
        default=None,
        example=["-60 mm", "20 mm"],
    )
    y: NumberPair | None = key(RANGE, "as `x`", default=None, example=["-30 mm", "30 mm"])
    center: NumberPair | None = key(
        Point(axes="link"),
        "of a circle that the centre of mass does not leave, instead of `x` and `y`",
        default=None,
        word=to_say("centre"),
    )
    radius: float | None = key("length", "of that circle", default=None, example="40 mm", above=0)


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


# -- checks ----------------------------------------------------------------------------------------


def wrong_weight(where: str, weight: Weight) -> Iterator[ModelError]:
    """Everything that is wrong with the mass that may be added at a place."""
    if isfinite(weight.radius) and weight.radius > LARGEST_ROOM:
        yield ModelError(
            f"{where}.radius",
            Note(
                "got {radius}; give at most {most}, or none for no limit",
                radius=Measured(weight.radius, "length"),
                most=Measured(LARGEST_ROOM, "length", limit=True),
            ),
        )
    yield from _wrong_plate(where, weight)
    inner, key = weight.inner_radius, f"{where}.inner_radius"
    if inner and weight.shape not in HOLLOW:
        yield ModelError(
            key, Note("goes with a ring or sector, got shape {shape!r}", shape=weight.shape)
        )
    elif inner < 0:
        given = Measured(inner, "length")
        yield ModelError(key, Note("got {text}; give 0 or more", text=given))
    elif inner >= weight.radius:
        yield ModelError(
            key,
            Note(
                "got {inner} in a room of {radius}; give less than that",
                inner=_length(inner),
                radius=_length(weight.radius),
            ),
        )
    if weight.mass is not None and weight.at_most is not None:
        yield ModelError(where, Note("give either mass or {at_most}", **key_names("at_most")))
    if weight.mass is None and not isfinite(weight.radius):
        yield ModelError(where, Note("nothing limits it; give the radius of its room, or its mass"))
    cut = weight.shape in CUT and None not in (weight.thickness, weight.density)
    if cut and weight.mass is not None and weight.mass > largest_mass(weight) * ROUNDING:
        yield ModelError(f"{where}.mass", _too_large(weight, weight.mass))


def _wrong_plate(where: str, weight: Weight) -> Iterator[ModelError]:
    """Thickness and density, which what is cut from a plate has."""
    shape = f"a {weight.shape}"
    if weight.shape not in CUT:
        for key in ("thickness", "density"):
            if getattr(weight, key) is not None:
                yield ModelError(
                    f"{where}.{key}", Note("goes with a disc, ring or sector; leave it out")
                )
        return
    if not isfinite(weight.radius):
        yield ModelError(
            f"{where}.radius", Note("missing; {shape} needs a room, give its radius", shape=shape)
        )
    if weight.thickness is None:
        yield ModelError(
            f"{where}.thickness",
            Note("missing; {shape} is cut from a plate, give its thickness", shape=shape),
        )
    if weight.density is None:
        yield ModelError(
            f"{where}.material",
            Note(
                'missing; {shape} is cut from a plate, give a material such as "steel", '
                "or a density",
                shape=shape,
            ),
        )


TOO_LARGE = {
    "disc": to_say(
        "a disc of {mass} and {thickness} {stuff} has a radius of {radius} and does not fit into "
        "its room of {room}; make it thicker, or the room larger"
    ),
    "ring": to_say(
        "a ring of {mass} and {thickness} {stuff} has an outer radius of {radius} and does not fit "
        "into its room of {room}; make it thicker, or the room larger"
    ),
    "sector": to_say(
        "a sector of {mass} and {thickness} {stuff} needs, even as a full ring, a radius of "
        "{radius} and does not fit into its room of {room}; make it thicker, or the room larger"
    ),
}
"""What is said of a weight that its room does not hold, by its shape."""


def _too_large(weight: Weight, mass: float) -> Note:
    """Say how much room a mass (kg) cut from a plate would need."""
    assert weight.thickness is not None and weight.density is not None
    inner = weight.inner_radius if weight.shape in HOLLOW else 0.0
    radius = sqrt(mass / (weight.thickness * weight.density * pi) + inner**2)
    density = Note("of {density} kg/m^3", density=f"{weight.density:.5g}")
    material = material_of(weight.density)
    return Note(
        TOO_LARGE[weight.shape],
        stuff=Note(material) if material else density,
        mass=Measured(mass, "mass", "g"),
        thickness=_length(weight.thickness),
        radius=_length(radius),
        room=_length(weight.radius),
    )


def _length(value: float) -> Measured:
    return Measured(value, "length", "mm")


def wrong_move(where: str, move: CenterMove, machine: Mechanism) -> Iterator[ModelError]:
    """Everything that is wrong with a centre of mass that may be moved."""
    links = machine.links
    if move.link not in links:
        yield ModelError(f"{where}.link", unknown(move.link, links, "link"))
    elif not links[move.link].mass:
        yield ModelError(
            f"{where}.link",
            Note(
                "{link!r} has no mass whose centre could be moved; give it one, or another link",
                link=move.link,
            ),
        )
    elif any(body.plane is not None for body in links[move.link].bodies):
        yield ModelError(
            f"{where}.link",
            Note(
                "{link!r} has bodies in planes of their own, which have no one centre to "
                "move; give another link",
                link=move.link,
            ),
        )
    yield from wrong_range(f"{where}.x", move.x, "length", "mm")
    yield from wrong_range(f"{where}.y", move.y, "length", "mm")
    if (move.center is None) != (move.radius is None):
        yield ModelError(where, Note("give both center and radius of a circle, or neither"))
    elif move.center is not None and (move.x is not None or move.y is not None):
        yield ModelError(where, Note("give either x and y, or center and radius"))


def wrong_added(where: str, added: AddedMass, machine: Mechanism) -> Iterator[ModelError]:
    """Everything that is wrong with mass that may be added to a link."""
    links = machine.links
    if added.link not in links:
        yield ModelError(f"{where}.link", unknown(added.link, links, "link"))
    elif added.at not in (points := links[added.link].points):
        yield ModelError(
            f"{where}.at", unknown(added.at, points, Note("point of {body}", body=added.link))
        )
    yield from wrong_weight(where, added.weight)


GEARED = (
    {
        "oneOf": [
            {
                **needs("ratio"),
                **lacks("teeth", "module"),
                "oneOf": [needs("pitch_radius"), needs("axis")],
            },
            {**needs("teeth", "module"), **lacks("ratio", "pitch_radius")},
        ]
    },
    not_both("axis", "direction"),
    not_both("gear_material", "gear_density"),
    {
        "if": needs("gear_thickness"),
        "then": any_of("gear_material", "gear_density"),
        "else": lacks("gear_material", "gear_density"),
    },
)
"""What the JSON Schema says of keys that go together."""


@declared
class GearedWeight(Frozen):
    """A counterweight on a shaft of its own, geared to a link that is pinned to the frame.

    The gears mesh from outside, so that the shaft turns against the driver.  Ratio, teeth and
    direction are the least and the largest that they may be; gears without a thickness
    have no mass.
    """

    called = to_say("{what} of geared counterweight {number}")
    extra_keys: ClassVar[Keys] = material_key("gear_", "of both gears; goes with `gear_thickness`")
    file_order = ("driver", "ratio", "teeth", "module", "pitch_radius", "axis", "direction",
                  "gear_thickness", "gear_material", "gear_density", "clear_of", "weight",
                  "name")  # fmt: skip
    conditions: ClassVar[KeyConditions] = {"allOf": [*WEIGHT, *GEARED]}

    driver: str = key(
        TextKind(of="link"),
        "link that carries the other gear, pinned to the frame",
        example="rocker",
    )
    weight: Weight = key(KeyTable(Weight, flat=True))
    ratio: NumberPair | None = key(
        OneOr(
            Number(),
            2,
            repeat=True,
            right=Note("a plain number, or the least and the most such as [0.3, 2]"),
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
        word=to_say("number of teeth"),
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
    axis: NumberPair | None = key(
        Point(), "of the shaft in the frame, instead of `direction`", default=None
    )
    direction: NumberPair | None = key(
        OneOr(Quantity("angle"), 2, repeat=True),
        "from the driver's pin to the shaft: an angle, or the least and the most; if left out as "
        "from the drive's pivot to that pin",
        default=None,
        example="0 deg",
    )
    gear_thickness: float | None = key(
        "length", "of both gears, solid discs; if left out they have no mass", default=None, above=0
    )
    gear_density: float | None = key(
        "density", "of both gears, instead of `gear_material`", default=None, above=0
    )
    clear_of: tuple[str, ...] = key(
        Listing(TextKind(of="link"), right=Note('a list of names such as ["coupler"]')),
        "links that the counterweight must not touch",
        default=(),
        example=["coupler"],
    )
    name: str = key(TextKind(), "of the new link", default="counterweight")

    @classmethod
    def from_table(cls, given: dict[str, Any]) -> GearedWeight:
        return cls(**with_density(given, "gear_"))

    @classmethod
    def to_table(cls, value: GearedWeight) -> dict[str, Any]:
        return with_material(super().to_table(value), "gear_")


@declared
class BalanceShafts(Frozen):
    """Two shafts that turn against each other at one or two times the crank's speed.

    axes : of the first, which is geared to the drive's link and turns against it, and of the
        second, which is geared to the first.
    """

    called = to_say("{what} of balance shafts {number}")
    conditions: ClassVar[KeyConditions] = {
        "allOf": [*WEIGHT, {"properties": {"shape": {"not": {"const": "ring"}}}}]
    }

    order: int = key(Whole(names=(1, 2)), "turns in one turn of the crank", example=2)
    axes: tuple[NumberPair, NumberPair] = key(
        Listing(Point(), (2,)),
        "of the shaft that is geared to the drive's link and turns against it, and of the other",
        example=[["0 mm", "-60 mm"], ["40 mm", "-60 mm"]],
    )
    weight: Weight = key(KeyTable(Weight, flat=True))
    name: str = key(
        TextKind(), "of the new links, which get `-1` and `-2` behind it", default="balance-shaft"
    )


# -- checks ----------------------------------------------------------------------------------------


def wrong_geared(where: str, geared: GearedWeight, machine: Mechanism) -> Iterator[ModelError]:
    """Everything that is wrong with a geared counterweight."""
    sliding = {slider.link for slider in machine.sliders}
    pins = {
        name: [point for point in link.points if point in machine.frame]
        for name, link in machine.links.items()
    }
    turning = [name for name in pins if len(pins[name]) == 1 and name not in sliding]
    driver = geared.driver
    if driver not in pins:
        yield ModelError(f"{where}.driver", unknown(driver, pins, "link"))
        return
    if driver not in turning:
        known = ", ".join(map(repr, turning)) or "none"
        sentence = Note(
            "{driver!r} does not turn about a pin in the frame; those that do are {known}",
            driver=driver,
            known=known,
        )
        yield ModelError(f"{where}.driver", sentence)
        return
    yield from _wrong_sizes(where, geared)
    yield from _wrong_axis(where, geared, pins[driver][0], machine)
    if (geared.gear_thickness is None) != (geared.gear_density is None):
        note = Note(
            "give both {gear_thickness} and {gear_material} (or {gear_density}), or neither",
            **key_names("gear_thickness", "gear_material", "gear_density"),
        )
        yield ModelError(where, note)
    for place, link in numbered(f"{where}.clear_of", geared.clear_of):
        if link not in machine.links:
            yield ModelError(place, unknown(link, machine.links, "link"))
    yield from wrong_weight(where, geared.weight)


def _wrong_sizes(where: str, geared: GearedWeight) -> Iterator[ModelError]:
    """Ratio or teeth, and what goes with each."""
    if (geared.ratio is None) == (geared.teeth is None):
        yield ModelError(where, Note("give either ratio or teeth"))
    elif geared.teeth is not None:
        yield from _wrong_teeth(where, geared, geared.teeth)
    elif geared.ratio is not None and min(geared.ratio) <= 0:
        yield ModelError(
            f"{where}.ratio",
            Note(
                "got {ratio:g}; give a size above 0, the shaft turns against its driver "
                "in any case",
                ratio=min(geared.ratio),
            ),
        )
    elif geared.ratio is not None and max(geared.ratio) > LARGEST_RATIO:
        yield ModelError(
            f"{where}.ratio",
            Note(
                "got {ratio:g}; a pair of gears has at most {largest_ratio:g}",
                ratio=max(geared.ratio),
                largest_ratio=LARGEST_RATIO,
            ),
        )
    elif geared.module is not None:
        yield ModelError(f"{where}.module", Note("goes with teeth; leave it out"))
    elif geared.pitch_radius is None and geared.axis is None:
        yield ModelError(
            f"{where}.pitch_radius",
            Note("missing; give that of the driver's gear, or the shaft's axis"),
        )
    elif geared.pitch_radius is not None and geared.axis is not None:
        yield ModelError(
            f"{where}.pitch_radius", Note("axis and ratio determine it already; leave it out")
        )
    yield from wrong_range(f"{where}.ratio", geared.ratio)


def _wrong_teeth(where: str, geared: GearedWeight, teeth: tuple[int, int]) -> Iterator[ModelError]:
    if min(teeth) < LEAST_TEETH:
        sentence = Note(
            "got {teeth}; no gear has less than {least_teeth} teeth",
            teeth=min(teeth),
            least_teeth=LEAST_TEETH,
        )
        yield ModelError(f"{where}.teeth", sentence)
    yield from wrong_range(f"{where}.teeth", teeth)
    if geared.module is None:
        yield ModelError(f"{where}.module", Note('missing; with teeth give it, such as "2 mm"'))
    if geared.pitch_radius is not None:
        yield ModelError(
            f"{where}.pitch_radius", Note("module and teeth determine it already; leave it out")
        )


def _wrong_axis(
    where: str, geared: GearedWeight, pin: str, machine: Mechanism
) -> Iterator[ModelError]:
    """Where the shaft is, seen from the pin of its driver."""
    drive = machine.drive.link
    if geared.axis is None:
        if geared.direction is None and pin in machine.links[drive].points:
            yield ModelError(
                f"{where}.direction",
                Note(
                    "missing; {driver!r} turns about the drive's own pivot; give where the "
                    'shaft is, as direction = "90 deg" or axis in [[balance.geared]]',
                    driver=geared.driver,
                ),
            )
        yield from wrong_range(f"{where}.direction", geared.direction, "angle")
        return
    if geared.direction is not None:
        yield ModelError(f"{where}.direction", Note("the axis determines it already; leave it out"))
    x, y = (a - b for a, b in zip(geared.axis, machine.frame[pin], strict=True))
    distance = hypot(x, y)
    if distance == 0:
        yield ModelError(
            f"{where}.axis", Note("lies on the driver's pin {pin!r}; set it apart", pin=pin)
        )
    elif geared.teeth is not None and geared.module is not None:
        nearest, farthest = (geared.module * number for number in geared.teeth)
        if not nearest * (1 - 1e-9) <= distance <= farthest * (1 + 1e-9):
            yield ModelError(
                f"{where}.axis",
                Note(
                    "lies {distance:.5g} mm from the driver's pin {pin!r}; two gears with "
                    "these teeth are {nearest:.5g} mm to {farthest:.5g} mm apart",
                    distance=1e3 * distance,
                    pin=pin,
                    nearest=1e3 * nearest,
                    farthest=1e3 * farthest,
                ),
            )


def wrong_shafts(where: str, shafts: BalanceShafts, _: Mechanism) -> Iterator[ModelError]:
    """Everything that is wrong with a pair of balance shafts."""
    if shafts.axes[0] == shafts.axes[1]:
        yield ModelError(f"{where}.axes", Note("both lie at the same place; set them apart"))
    if shafts.weight.shape == "ring":
        yield ModelError(
            f"{where}.shape",
            Note("a ring has no unbalance; give one of any, point, disc and sector"),
        )
    yield from wrong_weight(where, shafts.weight)
