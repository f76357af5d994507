"""Outlines of bodies, and what is wrong with their keys, numbers, corners and holes."""

from __future__ import annotations

from cmath import phase
from collections.abc import Iterator, Sequence
from itertools import combinations
from math import pi
from typing import Any

from equipoise.errors import ModelError
from equipoise.i18n import Note, key_names
from equipoise.keys import quantities_of
from equipoise.mechanism.checks import numbered, too_many, unknown
from equipoise.mechanism.parts.bodies import (
    MASSES,
    NEEDS,
    TAKES,
    Body,
    Points,
    edges_of,
    gross,
    place_of,
)

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

Outline = tuple[list[complex], float]
"""Corners, complex, m, and no radius; or a centre, and the radius of a circle, which is below 0
where the body lies outside of it."""


def outlines(body: Body, points: Points) -> list[Outline]:
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
"""Corners of a plate that are told of many designs at once not to lie crosswise."""


def is_column(number: Any) -> bool:
    """Whether it stands for the numbers of many designs."""
    return bool(getattr(number, "ndim", 0))


def outlined_by_columns(body: Body, points: Points) -> bool:
    """Whether its holes, or the shape of a plate with many corners, depend on columns, of which
    nobody tells whether they fit.
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
    """What tells the mass has to be given once, and a density needs the body's measures."""
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


Edge = tuple[Any, Any, Any]
"""As of `edges_of`; numbers, or columns of them."""


def _has_area(edges: Sequence[Edge]) -> Any:
    area = abs(sum(cross for _, _, cross in edges))
    return area > ROUNDING * sum(abs(item) ** 2 for item, _, _ in edges)


def _crossings(edges: Sequence[Edge]) -> Iterator[tuple[tuple[int, int], Any]]:
    """Whether edges of a polygon cross, by their numbers from 0.

    Edges that only touch are let be: so a cut-out can be reached by a cut from the edge.
    """
    for (i, edge), (j, other) in combinations(enumerate(edges), 2):
        if 1 < j - i < len(edges) - 1:
            yield (i, j), _parted(edge, other) & _parted(other, edge)


def _parted(edge: Edge, other: Edge) -> Any:
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


def fits(center: complex, radius: float, outline: Outline) -> bool:
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
