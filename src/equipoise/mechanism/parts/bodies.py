"""What a link is made of: bars, plates, discs, rings and points, their outlines and checks.

A body is as long, or as large, as its amount: the length of a bar, the area of what is cut from a
plate, 1 of a point.  Its mass is that times a density, or it is given.
"""

from __future__ import annotations

from cmath import phase
from collections.abc import Iterator, Mapping, Sequence
from itertools import combinations
from math import pi
from typing import Any, ClassVar, Literal

from equipoise.errors import ModelError, unknown
from equipoise.i18n import Note, key_names, to_say
from equipoise.keys import (
    NO_INERTIA,
    Flag,
    Frozen,
    Key,
    KeyConditions,
    Keys,
    KeyTable,
    Listing,
    Point,
    Tables,
    TextKind,
    any_of,
    declared,
    key,
    lacks,
    needs,
    not_both,
    quantities_of,
)
from equipoise.mechanism.checks import Vector, numbered, too_many

MATERIALS = {
    to_say("steel"): 7850.0,
    to_say("cast iron"): 7200.0,
    to_say("brass"): 8500.0,
    to_say("lead"): 11340.0,
    to_say("tungsten alloy"): 17500.0,
    to_say("aluminium"): 2700.0,
}
"""Densities, kg/m3."""

Form = Literal["bar", "plate", "disc", "ring", "point"]
PointOrPlace = str | Vector
"""Name of a point of the link, or x and y in the link's axes."""
Points = Mapping[str, Vector]

NEEDS: Mapping[str, tuple[str, ...]] = {
    "bar": ("between",),
    "plate": ("corners",),
    "disc": ("at", "radius"),
    "ring": ("at", "radius", "inner_radius"),
    "point": ("at", "mass"),
}
"""Keys that each shape has to have."""
_ANY = ("plane", "assumed")
_CUT = ("thickness", "material", "density", "mass", "holes", *_ANY)
_SECTION = ("width", "wall", "outer_diameter", "inner_diameter", "mass_per_length")
TAKES: Mapping[str, tuple[str, ...]] = {
    "bar": ("overhang", *_SECTION, *_CUT),
    "plate": _CUT,
    "disc": _CUT,
    "ring": _CUT,
    "point": ("inertia", *_ANY),
}
"""Keys that each may have."""
MASSES = ("material", "density", "mass", "mass_per_length")
"""Keys of which one gives the mass of a body."""


def material_of(density: float) -> str:
    """Name of the material of a density (kg/m3), or nothing where there is none."""
    return next((name for name, value in MATERIALS.items() if value == density), "")


def with_density(given: dict[str, Any], prefix: str = "") -> dict[str, Any]:
    """The values of a table with the density (kg/m3) of what it gives by name or by number."""
    material = given.pop(f"{prefix}material", None)
    if material is None:
        return given
    if f"{prefix}density" in given:
        raise ModelError("", Note("give either {prefix}material or {prefix}density", prefix=prefix))
    if material not in MATERIALS:
        name = material if len(material) <= 60 else f"{material[:57]}..."
        sentence = unknown(name, MATERIALS, "material")
        raise ModelError(
            f"{prefix}material",
            Note("{sentence} ({density} stands for any other)", sentence=sentence,
                 density=f"{prefix}density"),
        )  # fmt: skip
    return {**given, f"{prefix}density": MATERIALS[material]}


def with_material(table: dict[str, Any], prefix: str = "") -> dict[str, Any]:
    """A table with the name of a material instead of its density, where it has one."""
    if name := material_of(table.get(f"{prefix}density", 0.0)):
        del table[f"{prefix}density"]
        table[f"{prefix}material"] = name
    return table


def material_key(prefix: str, text: str) -> dict[str, Key]:
    """The key of a material beside that of a density."""
    kind = TextKind(suggested=(*MATERIALS,))
    name = f"{prefix}material"
    known = ", ".join(f"{material} {density:.0f}" for material, density in MATERIALS.items())
    text = f"{text}; densities in kg/m^3: {known}"
    return {name: Key(name, kind, text, default=None, example="steel")}


@declared
class Hole(Frozen):
    """A round hole, all through."""

    called = to_say("{what} of hole {number}")

    at: PointOrPlace = key(
        Point(named=True),
        "its centre: a point of the link, or a place",
        example="B",
        word=to_say("centre"),
    )
    radius: float = key("length", "of the hole", example="8 mm", above=0)


def _of_shape(shape: str) -> dict[str, Any]:
    own = {*NEEDS[shape], *TAKES[shape]}
    others = {need for shape in NEEDS for need in (*NEEDS[shape], *TAKES[shape])} - own
    return {
        "if": {"properties": {"shape": {"const": shape}}, **needs("shape")},
        "then": {**needs(*NEEDS[shape]), **lacks(*sorted(others))},
    }


@declared
class Body(Frozen):
    """A body of uniform density that a link has; places are in the link's axes.

    between : both ends of a bar.  corners : of a plate, in order around it.
    """

    called = to_say("{what} of body {number}")
    extra_keys: ClassVar[Keys] = material_key("", "of the body")
    file_order = ("shape", "between", "overhang", "width", "wall", "outer_diameter",
                  "inner_diameter", "corners", "at", "radius", "inner_radius", "thickness",
                  "material", "density", "mass", "mass_per_length", "inertia")  # fmt: skip
    conditions: ClassVar[KeyConditions] = {
        "allOf": [
            *map(_of_shape, NEEDS),
            any_of(*MASSES),
            *(not_both(*pair) for pair in combinations(MASSES, 2)),
        ]
    }

    shape: Form = key(
        TextKind((*NEEDS,)),
        "`bar`: straight, between two places; `plate`: with corners; `disc` and `ring`: round; "
        "`point`: what is small, or known by its mass and inertia",
        example="bar",
    )
    between: tuple[PointOrPlace, ...] = key(
        Listing(Point(named=True), (2,), Note("both ends, points of the link by name or places")),
        "both ends of a bar: points of the link, or places",
        default=(),
        example=["B", "C"],
        word=to_say("end {number}"),
    )
    overhang: float = key(
        "length", "by which a bar reaches beyond both ends", default=0.0, at_least=0
    )
    width: float | None = key(
        "length",
        "of a bar of rectangular section, in the plane of motion",
        default=None,
        example="20 mm",
        above=0,
    )
    wall: float | None = key(
        "length", "of a rectangular bar that is hollow", default=None, example="2 mm", above=0
    )
    outer_diameter: float | None = key(
        "length", "of a round bar, instead of `width`", default=None, example="12 mm", above=0
    )
    inner_diameter: float = key("length", "of a tube; 0 for a rod", default=0.0, at_least=0)
    corners: tuple[PointOrPlace, ...] = key(
        Listing(Point(named=True), (), Note("three corners or more, points of the link or places")),
        "of a plate, in order around it: points of the link, or places",
        default=(),
        example=["B", "C", ["20 mm", "-30 mm"]],
        word=to_say("corner {number}"),
    )
    at: PointOrPlace | None = key(
        Point(named=True),
        "centre of a disc, ring or point: a point of the link, or a place",
        default=None,
        example="A",
        word=to_say("centre"),
    )
    radius: float | None = key(
        "length", "of a disc, and outer one of a ring", default=None, example="60 mm", above=0
    )
    inner_radius: float | None = key("length", "of a ring", default=None, example="20 mm", above=0)
    thickness: float | None = key(
        "length", "across the plane of motion", default=None, example="5 mm", above=0
    )
    density: float | None = key("density", "instead of `material`", default=None, above=0)
    mass: float | None = key(
        "mass", "of the body, instead of `material`", default=None, example="120 g", above=0
    )
    mass_per_length: float | None = key(
        "mass per length", "of a bar, instead of `material`", default=None, above=0
    )
    inertia: float = key(
        "inertia",
        "of what is taken as a point, about its own centre",
        default=0.0,
        at_least=0,
        why=NO_INERTIA,
    )
    holes: tuple[Hole, ...] = key(Tables(KeyTable(Hole)), "round holes, all through", default=())
    plane: float | None = key(
        "length", "z of its middle; that of the link if left out", default=None, example="20 mm"
    )
    assumed: bool = key(
        Flag(),
        "its measures are assumed, as those of a link that is drawn on the live page; the results "
        "say so",
        default=False,
    )

    @classmethod
    def from_table(cls, given: dict[str, Any]) -> Body:
        return cls(**with_density(given))

    @classmethod
    def to_table(cls, value: Body) -> dict[str, Any]:
        return with_material(super().to_table(value))


# -- mass, centre and inertia ----------------------------------------------------------------------


def place_of(spot: Any, points: Points) -> Any:
    """A spot in the link's axes, complex, m; a column where numbers are."""
    x, y = points[spot] if isinstance(spot, str) else spot
    return x + 1j * y


def inertia_of(body: Body, points: Points) -> tuple[Any, Any, Any]:
    """Mass (kg), centre (complex, m) and moment of inertia about it (kg m2) of a body."""
    amount, center, second = gross(body, points)
    parts = [(amount, center, second)]
    for hole in body.holes:
        area, polar = _round(hole.radius, 0.0, 1 / (1.0 if body.width is None else body.width))
        parts.append((-area, place_of(hole.at, points), -polar))
    amount, center, second = combined(parts)
    mass = amount * _per_amount(body) if body.mass is None else body.mass
    return mass, center, second * (mass / amount) + body.inertia


def combined(parts: Sequence[tuple[Any, Any, Any]]) -> tuple[Any, Any, Any]:
    """Amounts, centres and second moments about these, added up by Steiner's theorem."""
    if len(parts) == 1:
        return parts[0]
    whole = sum(amount for amount, _, _ in parts)
    center = sum(amount * place for amount, place, _ in parts) / whole
    second = sum(j + amount * abs(place - center) ** 2 for amount, place, j in parts)
    return whole, center, second


def weighed(bodies: Sequence[Body], points: Points) -> dict[str, Any]:
    """Mass, centre of mass and inertia of a link that is made of bodies."""
    mass, center, inertia = combined([inertia_of(body, points) for body in bodies])
    return {"mass": mass, "center_of_mass": (center.real, center.imag), "inertia": inertia}


def gross(body: Body, points: Points) -> tuple[Any, Any, Any]:
    """Amount, centre and second moment of a body without its holes."""
    if body.shape == "bar":
        first, last = (place_of(end, points) for end in body.between)
        length = abs(last - first) + 2 * body.overhang
        return length, (first + last) / 2, length * (length**2 / 12 + _section(body)[1])
    if body.shape == "plate":
        return polygon([place_of(corner, points) for corner in body.corners])
    center = place_of(body.at, points)
    if body.shape == "point":
        return 1.0, center, 0.0
    amount, second = _round(body.radius, body.inner_radius or 0.0)
    return amount, center, second


def _round(outer: Any, inner: Any, scale: Any = 1.0) -> tuple[Any, Any]:
    """Area and polar second moment of a ring, times a scale."""
    area = pi * (outer - inner) * (outer + inner) * scale
    return area, area * (outer**2 + inner**2) / 2


def polygon(corners: Sequence[complex]) -> tuple[float, complex, float]:
    """Area (m2), centre (complex, m) and polar second moment about it (m4) of a polygon.

    Sums over its edges after Green's theorem, taken from one of its corners so that no digits are
    lost far from the origin; e.g. Steger, "On the calculation of arbitrary moments of polygons",
    1996.
    """
    edges = [*edges_of(corners)]
    area = sum(cross for _, _, cross in edges) / 2
    center = sum(cross * (item + other) for item, other, cross in edges) / (6 * area)
    second = sum(
        cross * (abs(item) ** 2 + (item.conjugate() * other).real + abs(other) ** 2)
        for item, other, cross in edges
    )
    own = abs(second / 12 - area * abs(center) ** 2)
    return abs(area), corners[0] + center, own


def edges_of(corners: Sequence[complex]) -> Iterator[tuple[complex, complex, float]]:
    """Both ends of each edge of a polygon, from its first corner, and twice the area it adds."""
    arms = [corner - corners[0] for corner in corners]
    for arm, other in zip(arms, [*arms[1:], arms[0]], strict=True):
        yield arm, other, (arm.conjugate() * other).imag


def _section(body: Body) -> tuple[Any, Any]:
    """Area of a bar's section (m2), and its mean square distance (m2) from the bar's axis in the
    plane of motion; 0 of what is not given.
    """
    if body.outer_diameter is not None:
        outer, inner = body.outer_diameter, body.inner_diameter
        return pi / 4 * (outer - inner) * (outer + inner), (outer**2 + inner**2) / 16
    width: Any = 0.0 if body.width is None else body.width
    thickness: Any = 0.0 if body.thickness is None else body.thickness
    if body.wall is None:
        return width * thickness, width**2 / 12
    inside = width - 2 * body.wall  # thin walls lose no digits so
    squares = thickness * (width**2 + width * inside + inside**2) + inside**3
    return 2 * body.wall * (thickness + inside), squares / (12 * (thickness + inside))


def _per_amount(body: Body) -> Any:
    """Mass of a unit of a body's amount."""
    if body.mass_per_length is not None:
        return body.mass_per_length
    measure: Any = _section(body)[0] if body.shape == "bar" else body.thickness
    return body.density * measure


NO_SECTION = Note(
    "missing; with a material give width and thickness, or {outer_diameter}",
    **key_names("outer_diameter"),
)
GOES_WITH_DIAMETER = Note("goes with {outer_diameter}", **key_names("outer_diameter"))
LESS_THAN_DIAMETER = Note("give less than {outer_diameter}", **key_names("outer_diameter"))
MOST = {"bodies": 100, "corners": 200, "holes": 200}
"""Far beyond any link."""
ROUNDING = 1e-9
"""Over a radius: a hole may come so far over an edge, and a square below zero."""


# -- from the side ---------------------------------------------------------------------------------

BodyOutline = tuple[list[complex], float]
"""Corners, complex, m, and no radius; or a centre, and the radius of a circle, which is below 0
where the body lies outside of it."""


def outlines(body: Body, points: Points) -> list[BodyOutline]:
    """Edges of a body as it is seen from the side, without its holes; none of a point and of a bar
    of which no section is given.
    """
    if body.shape == "plate":
        return [([place_of(corner, points) for corner in body.corners], 0.0)]
    if body.shape == "bar":
        half = (body.width or body.outer_diameter or 0.0) / 2
        first, last = (place_of(end, points) for end in body.between)
        way = (last - first) / abs(last - first)
        aside, beyond = 1j * half * way, body.overhang * way
        value, other = first - beyond, last + beyond
        sides = [value - aside, other - aside, other + aside, value + aside]
        return [(sides, 0.0)] if half else []
    if body.radius is None:
        return []
    center = [place_of(body.at, points)]
    return [(center, body.radius)] + [(center, -r) for r in (body.inner_radius,) if r]


MOST_AT_ONCE = 12
"""Corners of a plate, at most, that are checked for crossing in many designs at once."""


def is_column(number: Any) -> bool:
    """Whether it stands for the numbers of many designs."""
    return bool(getattr(number, "ndim", 0))


def outlined_by_columns(body: Body, points: Points) -> bool:
    """Whether its holes, or the shape of a plate with many corners, depend on columns, for which
    the fit is not checked.
    """
    many = len(body.corners) > MOST_AT_ONCE
    numbers = [place_of(c, points) for c in body.corners if body.holes or many]
    if body.holes:
        own = (*body.between, body.at, *(hole.at for hole in body.holes))
        numbers += [place_of(spot, points) for spot in own if spot is not None]
        numbers += [body.overhang, body.width, body.radius, body.inner_radius]
    return any(map(is_column, numbers))


# -- checks ----------------------------------------------------------------------------------------


def wrong_bodies(bodies: Sequence[Body], points: Points) -> Iterator[ModelError]:
    """Everything that is wrong with the bodies of a link, the first things first."""
    yield from too_many("bodies", bodies, MOST["bodies"])
    for where, body in numbered("bodies", bodies):
        for wrong in (_wrong_keys, _wrong_spots, _wrong_mass, _wrong_numbers, _wrong_outline):
            for name, what in wrong(body, points):
                yield ModelError(f"{where}.{name}", what)


Wrong = Iterator[tuple[str, Note]]
"""Keys, and what is wrong with each."""


def _wrong_keys(body: Body, _: Points) -> Wrong:
    known = (*NEEDS[body.shape], *TAKES[body.shape])
    given = body.to_table(body)
    for name in NEEDS[body.shape]:
        if name not in given:
            yield name, Note("missing; a {shape} needs it", shape=body.shape)
    for name in given:
        if name not in ("shape", *known):
            yield (
                name,
                Note(
                    "a {shape} has none; it can have {names}",
                    shape=body.shape,
                    names=", ".join(known),
                ),
            )
    if body.shape == "plate" and len(body.corners) < 3:
        yield "corners", Note("got {count}; give three or more", count=len(body.corners))


def _wrong_spots(body: Body, points: Points) -> Wrong:
    spots = [("at", body.at)] if body.at is not None else []
    spots += [*numbered("between", body.between), *numbered("corners", body.corners)]
    spots += [(f"{where}.at", hole.at) for where, hole in numbered("holes", body.holes)]
    for where, spot in spots:
        if isinstance(spot, str) and spot not in points:
            yield where, unknown(spot, points, "point of the link")


def _wrong_mass(body: Body, _: Points) -> Wrong:
    """Errors unless the mass is given exactly once; a density needs the body's measures."""
    given = [name for name in MASSES if getattr(body, name, None) is not None]
    if len(given) > 1:
        yield given[1], Note("given beside {given}; give one of both", given=given[0])
    if not given:
        yield "material", Note('missing; give a material such as "steel", a density, or the mass')
    bar = body.shape == "bar"
    if body.density is None or (bar and body.outer_diameter is not None):
        return
    if bar and body.width is None:
        yield "width", NO_SECTION
    elif body.thickness is None:
        yield "thickness", Note("missing; with a material give it, or give the mass instead")


def _wrong_numbers(body: Body, points: Points) -> Wrong:
    flat = body.shape != "bar" or (body.width is not None and body.wall is None)
    if body.holes and not flat:
        yield "holes", Note("of a bar need its width, and no wall; leave them out")
    if body.width is not None and body.outer_diameter is not None:
        yield "outer_diameter", Note("given beside width; give one of both")
    if body.wall is not None and None in (body.width, body.thickness):
        yield "wall", Note("goes with width and thickness of a bar")
    elif body.inner_diameter and body.outer_diameter is None:
        yield "inner_diameter", GOES_WITH_DIAMETER
    else:
        for name, right, what in _rules(body, points):
            if not right:
                yield name, what


def _rules(body: Body, points: Points) -> Iterator[tuple[str, Any, Note]]:
    """What has to be true of numbers, each with its key and what is said where it is not; of
    columns, columns of it.
    """
    if body.shape == "bar":
        first, last = (place_of(end, points) for end in body.between)
        yield (
            "between",
            abs(last - first) > 0,
            Note("both ends lie at the same place; set them apart"),
        )
    if body.inner_radius is not None and body.radius is not None:
        yield "inner_radius", body.inner_radius < body.radius, Note("give less than the radius")
    if body.outer_diameter is not None:
        right = body.inner_diameter < body.outer_diameter
        yield "inner_diameter", right, LESS_THAN_DIAMETER
    if body.wall is not None and body.width is not None and body.thickness is not None:
        right = (2 * body.wall < body.width) & (2 * body.wall < body.thickness)
        yield "wall", right, Note("give less than half of width and thickness")


def demands(body: Body, points: Points) -> Iterator[Any]:
    """What has to be true of the numbers of a body: flags, or columns of them."""
    corners = [place_of(corner, points) for corner in body.corners]
    if any(is_column(corner) for corner in corners):
        edges = [*edges_of(corners)]
        yield _has_area(edges)
        yield from (crosses == 0 for _, crosses in _crossings(edges))
    for name, quantity in quantities_of(body).items():
        value = getattr(body, name)
        if value is not None:
            yield quantity.allows(value)
    for _, right, _ in _rules(body, points):
        yield right


def _wrong_outline(body: Body, points: Points) -> Wrong:
    for name in ("corners", "holes"):
        for error in too_many(name, getattr(body, name), MOST[name]):
            yield name, error.what
    if body.shape == "plate":
        corners = [place_of(corner, points) for corner in body.corners]
        edges = [*edges_of(corners)]
        if crossing := next((pair for pair, crosses in _crossings(edges) if crosses), None):
            ends = (end for edge in crossing for end in (edge + 1, (edge + 1) % len(edges) + 1))
            names = ("start", "end", "other_start", "other_end")
            crossed = Note(
                "the edge from corner {start} to {end} crosses that from {other_start} to "
                "{other_end}; give the corners in order around the plate",
                **dict(zip(names, ends, strict=True)),
            )
            yield "corners", crossed
        elif not _has_area(edges):
            yield "corners", Note("they lie in one line; a plate has an area")
    yield from _wrong_holes(body, points)


EdgeColumns = tuple[Any, Any, Any]
"""As of `edges_of`; numbers, or columns of them."""


def _has_area(edges: Sequence[EdgeColumns]) -> Any:
    area = abs(sum(cross for _, _, cross in edges))
    return area > ROUNDING * sum(abs(item) ** 2 for item, _, _ in edges)


def _crossings(edges: Sequence[EdgeColumns]) -> Iterator[tuple[tuple[int, int], Any]]:
    """Whether edges of a polygon cross, by their numbers from 0.

    Edges that only touch are let be: so a cut-out can be reached by a cut from the edge.
    """
    for (i, edge), (j, other) in combinations(enumerate(edges), 2):
        if 1 < j - i < len(edges) - 1:
            yield (i, j), _parted(edge, other) & _parted(other, edge)


def _parted(edge: EdgeColumns, other: EdgeColumns) -> Any:
    """Whether both ends of another edge lie on different sides of the line of an edge."""
    along = (edge[1] - edge[0]).conjugate()
    item, two = ((along * (end - edge[0])).imag for end in other[:2])
    return item * two < 0


def _wrong_holes(body: Body, points: Points) -> Wrong:
    """A hole lies in its body, and no two have a part in common."""
    if not body.holes:
        return
    outline = outlines(body, points)
    holes = [(place_of(hole.at, points), hole.radius) for hole in body.holes]
    for number, (center, radius) in enumerate(holes, 1):
        if any(not fits(center, radius * (1 - ROUNDING), item) for item in outline):
            yield (
                f"holes[{number}]",
                Note(
                    "does not lie within the {shape}; move it, or make it smaller", shape=body.shape
                ),
            )
    for (i, entry), (j, other) in combinations(enumerate(holes, 1), 2):
        if abs(entry[0] - other[0]) < (entry[1] + other[1]) * (1 - ROUNDING):
            yield f"holes[{j}]", Note("cuts into holes[{i}]; set them apart", i=i)
    area = gross(body, points)[0] * (1.0 if body.width is None else body.width)
    if sum(pi * radius**2 for _, radius in holes) >= area * (1 - ROUNDING):
        yield "holes", Note("leave nothing of the {shape}; make them smaller", shape=body.shape)


def fits(center: complex, radius: float, outline: BodyOutline) -> bool:
    """Whether a circle lies on the body's side of an outline."""
    corners, size = outline
    if size:
        away = abs(center - corners[0])
        return away + radius <= size if size > 0 else away - radius >= -size
    turned = 0.0
    for corner, ahead in zip(corners, [*corners[1:], corners[0]], strict=True):
        along, arm = ahead - corner, center - corner
        share = (arm * along.conjugate()).real / (abs(along) ** 2 or 1.0)
        if abs(arm - min(max(share, 0.0), 1.0) * along) < radius:
            return False
        turned += phase((ahead - center) / (corner - center))
    return abs(turned) > pi
