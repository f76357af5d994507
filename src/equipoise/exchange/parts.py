"""Outlines of what links are made of and of new counterweights, as they are cut: with holes.

Places are in the link's axes, m.  An edge is straight or an arc, told by its bulge as DXF has it:
the tangent of a quarter of the arc's angle, above 0 counterclockwise, 0 of a straight edge.
"""

from __future__ import annotations

from cmath import rect
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from math import pi, tan
from typing import Any

import numpy as np

from equipoise.errors import UsageError
from equipoise.exchange.formats import Job
from equipoise.mechanism.parts.bodies import Body, Points, place_of
from equipoise.mechanism.parts.body_checks import outlines
from equipoise.quantities import told

Edge = tuple[complex, float]
"""A corner, m, and the bulge of the edge to the next one."""


@dataclass(frozen=True)
class Part:
    """One thing to be cut from a plate.

    name : with what tells it from others of its link.  thickness : m, None where not known.
    edges : of its outline and of each opening, closed.
    """

    name: str
    link: str
    thickness: float | None
    edges: tuple[tuple[Edge, ...], ...]

    @property
    def title(self) -> str:
        """With how thick it is."""
        thick = "" if self.thickness is None else f", {told(self.thickness, 'length')} thick"
        return f"{self.name}{thick}"

    @property
    def box(self) -> tuple[complex, complex]:
        """Lower left and upper right corner, m."""
        every = np.concatenate([*self._reach()])
        low = complex(every.real.min(), every.imag.min())
        return low, complex(every.real.max(), every.imag.max())

    def _reach(self) -> Iterator[Any]:
        for edges in self.edges:
            for (one, bulge), (other, _) in zip(edges, (*edges[1:], edges[0]), strict=True):
                yield along(one, other, bulge, 181 if bulge else 2)


def parts(job: Job) -> list[Part]:
    """Every part that a machine tells an outline of; others are told to be left out.

    Raises
    ------
    UsageError : there is none.
    """
    found = [*_of_links(job), *_of_changes(job)]
    if not found:
        raise UsageError(
            "the model tells no outline of anything; give a link bodies such as plates, or export "
            "it balanced, with counterweights that are discs, rings or sectors"
        )
    return found


def along(one: complex, other: complex, bulge: float, count: int) -> Any:
    """Places (count,) on an edge, from its first end to its second."""
    share = np.linspace(0.0, 1.0, count)
    if not bulge:
        return one + (other - one) * share
    half = 2 * np.arctan(bulge)  # of the arc's angle
    center = (one + other) / 2 + 1j * (other - one) / 2 / np.tan(half)
    return center + (one - center) * np.exp(2j * half * share)


def _of_links(job: Job) -> Iterator[Part]:
    for name, link in job.machine.links.items():
        for number, body in enumerate(link.bodies, 1):
            edges = tuple(_edges(body, link.points))
            if section := _drawn_section(body):
                job.leave_out(f"body {number} of {name!r}, {section}, which no plate gives")
            elif edges:
                label = f"{name}, {body.shape} {number}"
                yield Part(label, name, body.thickness, edges)
            elif body.shape != "point" or not job.changes:  # those are told with what was changed
                job.leave_out(f"body {number} of {name!r}, a {body.shape} without an outline")


def _drawn_section(body: Body) -> str:
    """The section of a bar that is cut to length from a tube or rod; empty of what is a plate."""
    if body.outer_diameter is not None:
        outer = told(body.outer_diameter, "length")
        if not body.inner_diameter:
            return f"a rod of {outer}"
        return f"a tube of {outer} with a bore of {told(body.inner_diameter, 'length')}"
    if body.wall is None or body.width is None:
        return ""
    sides = [told(side, "length") for side in (body.width, body.thickness) if side is not None]
    return f"a tube of {' x '.join(sides)} with walls of {told(body.wall, 'length')}"


def _edges(body: Body, points: Points) -> Iterator[tuple[Edge, ...]]:
    """Outline and openings of a body."""
    for corners, radius in outlines(body, points):
        yield circle(corners[0], abs(radius)) if radius else tuple((one, 0.0) for one in corners)
    for hole in body.holes:
        yield circle(complex(place_of(hole.at, points)), hole.radius)


def circle(center: complex, radius: float) -> tuple[Edge, ...]:
    """Two half circles."""
    return (center - radius, 1.0), (center + radius, 1.0)


def _of_changes(job: Job) -> Iterator[Part]:
    """Counterweights that balancing adds."""
    for change in job.changes:
        pieces: Iterable[dict[str, Any]] = change.values.get("pieces", ())
        for number, piece in enumerate(pieces, 1):
            center = complex(*change.values["center"])
            edges = tuple(_edges_of_piece(piece, center))
            label = f"{change.link}, counterweight {number}"
            if edges:
                yield Part(label, change.link, piece["thickness"], edges)
            else:
                job.leave_out(f"{label}, a point mass without an outline")


def _edges_of_piece(piece: dict[str, Any], center: complex) -> Iterator[tuple[Edge, ...]]:
    """Outline and opening of a piece; rings and sectors lie about the centre of their room."""
    if piece["shape"] == "disc":
        yield circle(complex(*piece["place"]), piece["radius"])
    elif piece["shape"] == "ring" or piece.get("angle", 0.0) >= 2 * pi * (1 - 1e-12):
        yield circle(center, piece["outer_radius"])
        if piece["inner_radius"]:
            yield circle(center, piece["inner_radius"])
    elif piece["shape"] == "sector":
        yield _sector(piece, center)


def _sector(piece: dict[str, Any], center: complex) -> tuple[Edge, ...]:
    """A sector of a ring: two arcs, each in halves, so that none is longer than half a circle."""
    outer, inner, half = piece["outer_radius"], piece["inner_radius"], piece["angle"] / 2
    bulge = tan(half / 4)
    ends = [rect(1.0, piece["direction"] + turn) for turn in (-half, 0.0, half)]
    there = [(center + outer * end, bulge) for end in ends]
    back = [(center + inner * end, -bulge) for end in reversed(ends)] if inner else [(center, 0.0)]
    return (*there[:-1], (there[-1][0], 0.0), *back[:-1], (back[-1][0], 0.0))
