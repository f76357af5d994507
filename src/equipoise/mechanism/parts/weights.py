"""Mass that may be added or moved: its shape, its room, and what fits into it."""

from __future__ import annotations

from collections.abc import Iterator
from math import inf, isfinite, pi, sqrt
from typing import Any, ClassVar, Literal

from equipoise.errors import ModelError
from equipoise.i18n import Note, key_names, to_say
from equipoise.keys import (
    Conditions,
    Frozen,
    Keys,
    KeyTable,
    Listing,
    Point,
    Quantity,
    TextKind,
    any_of,
    declared,
    key,
    lacks,
    needs,
    not_both,
)
from equipoise.mechanism.checks import unknown, wrong_range
from equipoise.mechanism.parts.bodies import (
    material_key,
    material_of,
    with_density,
    with_material,
)
from equipoise.mechanism.parts.links import Mechanism
from equipoise.quantities import Measured

Pair = tuple[float, float]
Shape = Literal["any", "point", "disc", "ring", "sector"]
SHAPES: tuple[Shape, ...] = ("any", "point", "disc", "ring", "sector")
CUT = ("disc", "ring", "sector")
"""Shapes cut from a plate, which need a thickness and a density."""
HOLLOW = ("ring", "sector")
"""Shapes with an inner radius."""
RANGE = Listing(Quantity("length"), (2,))
LARGEST_ROOM = 1000.0
"""m; far beyond any machine."""
ROUNDING = 1 + 1e-9
"""A mass that fills its room to this may have been computed from it."""


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

    shape: Shape = key(
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
    conditions: ClassVar[Conditions] = {"allOf": [*WEIGHT]}

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
    conditions: ClassVar[Conditions] = {
        "dependentRequired": {"center": ["radius"], "radius": ["center"]},
        "dependentSchemas": {"center": {"properties": {"x": False, "y": False}}},
    }

    link: str = key(TextKind(of="link"), "a link with a mass", example="coupler")
    x: Pair | None = key(
        RANGE,
        "lowest and highest, in the link's axes; without limit if left out",
        default=None,
        example=["-60 mm", "20 mm"],
    )
    y: Pair | None = key(RANGE, "as `x`", default=None, example=["-30 mm", "30 mm"])
    center: Pair | None = key(
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
