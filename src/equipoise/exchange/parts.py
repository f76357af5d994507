"""Outlines of what links are made of and of new counterweights, as they are cut: with holes.

Places are in the link's axes, m.  An edge is straight or an arc, given by its bulge as in DXF:
the tangent of a quarter of the arc's angle, above 0 counterclockwise, 0 of a straight edge.
"""

from __future__ import annotations

from cmath import phase, rect
from collections import Counter
from collections.abc import Iterable, Iterator
from functools import cache, partial
from itertools import chain
from math import atan, ceil, degrees, log10, pi, sin, tan
from typing import Any

import numpy as np

from equipoise.balancing.workshop import FULL_TURN, is_ring
from equipoise.dataclass import dataclass
from equipoise.errors import UsageError
from equipoise.exchange.fastening import (
    COARSE_THREADS,
    COUNTS,
    ScrewThreads,
    needs_threads,
    threads_of,
)
from equipoise.exchange.formats import Job
from equipoise.i18n import Note, coordinates, decimals, say, to_say
from equipoise.mechanism.kinematics.motion import move
from equipoise.mechanism.parts.balance import MATERIALS
from equipoise.mechanism.parts.bodies import Body, Points, outlines, place_of
from equipoise.quantities import display, fixed, format_quantity
from equipoise.results.machine_blocks import SHAPES, stuff_named

BulgedCorner = tuple[complex, float]
"""A corner, m, and the bulge of the edge to the next one."""


@dataclass(frozen=True)
class RoundEdge:
    """A circle or an arc of a part, in metres and radians.

    direction : from the centre to the middle of the arc.  angle : of the arc.
    whole : whether it is a circle.
    """

    center: complex
    radius: float
    direction: float
    angle: float
    whole: bool

    @property
    def text(self) -> str:
        """Diameter of a circle, radius of an arc, mm."""
        return f"Ø {in_mm(2e3 * self.radius)}" if self.whole else f"R {in_mm(1e3 * self.radius)}"


ON_EDGE = 1e-6
"""Over the size of a part, by which a point beside it is at its edge."""
LIGHT_SCREWS = 5e-4
"""Of a part's mass, below which what its screws add is not said."""
COUNTERWEIGHT = "counterweight"
KINDS = {**SHAPES, COUNTERWEIGHT: to_say("counterweight")}
"""What a part is, in words."""


@dataclass(frozen=True)
class Part:
    """One thing to be cut from a plate.

    link : that has it.  kind, number : what it is, and which of those of its link.
    thickness : m, None where not known.
    edges : of its outline and of each opening, closed.
    density : kg/m3, None where not known.
    points : of its link, by which it is joined to others; name and place.
    screwed : whether it has to be fastened.  threads : by which it is; None where none hold it.
    """

    link: str
    kind: str
    number: int
    thickness: float | None
    edges: tuple[tuple[BulgedCorner, ...], ...]
    density: float | None = None
    screwed: bool = False
    threads: ScrewThreads | None = None
    points: tuple[tuple[str, complex], ...] = ()

    @property
    def name(self) -> str:
        """By which files know it, in any language."""
        return f"{self.link}, {self.kind} {self.number}"

    @property
    def label(self) -> str:
        """In words."""
        what = say(KINDS[self.kind])
        return say("{link}, {what} {number}", link=self.link, what=what, number=self.number)

    @property
    def area(self) -> float:
        """Of the outline without the openings, m2."""
        outline, *openings = map(area_of, self.edges)
        return outline - sum(openings)

    @property
    def mass(self) -> float | None:
        """In kg; None where thickness or density is not known."""
        if self.thickness is None or self.density is None:
            return None
        return self.area * self.thickness * self.density

    @property
    def curves(self) -> tuple[RoundEdge, ...]:
        """Circles and arcs, each once."""
        every = (curve for edges in self.edges for curve in _curves(edges))
        alike = {(*_rounded(c.center, c.radius), c.whole): c for c in every}
        return tuple(alike.values())

    @property
    def arcs(self) -> tuple[RoundEdge, ...]:
        """Those of a sector about its axis, the outer one first; none of other parts."""
        arcs = (curve for curve in self.curves if not curve.whole)
        return tuple(sorted(arcs, key=lambda item: -item.radius))

    @property
    def is_round(self) -> bool:
        """Whether diameters and radii give all of its outline, so that it needs no width."""
        return bool(self.arcs) or any(curve.whole for curve in _curves(self.edges[0]))

    @property
    def lines(self) -> tuple[str, ...]:
        """What a workshop has to know beside the drawing, a line each."""
        lines = [self.label]
        if self.thickness is not None:
            lines.append(say("thickness {size} mm", size=in_mm(1e3 * self.thickness)))
        if self.density is not None:
            lines.append(say("material: {stuff}", stuff=stuff_named(self.density)))
        if self.mass is not None:
            lines.append(say("mass {mass}", mass=workshop_mass(self.mass)))
        lines.extend(self._round_lines())
        holes = [curve.text for edges in self.edges[1:] for curve in _curves(edges) if curve.whole]
        if holes:
            lines.append(say("holes: {list}", list=", ".join(dict.fromkeys(holes))))
        if self.joints:
            places = ", ".join(f"{name} {place_in_mm(at)}" for name, at in self.joints)
            lines.append(say("joints at {places} mm in the axes of the link", places=places))
        if self.threads is not None:
            lines.extend(self._thread_lines(self.threads))
        elif self.screwed:
            lines.append(
                say(
                    "no screws fit in it and hold it: weld it on or make it in one piece with "
                    "{link}",
                    link=self.link,
                )
            )
        return tuple(lines)

    def _thread_lines(self, threads: ScrewThreads) -> Iterator[str]:
        """Which threads, where, and what screws without heads weigh beyond what was drilled out."""
        words = {"count": len(threads.places), "size": threads.size}
        if threads.about_axis:
            polar = ((in_mm(1e3 * r), in_mm(degrees(way))) for r, way in threads.about_axis)
            yield say(
                "{count} threads M{size} about the axis, at {places} from the x axis of the link",
                places="; ".join(f"R {radius}, {way}°" for radius, way in polar),
                **words,
            )
        else:
            yield say(
                "{count} threads M{size} at {places} mm in the axes of the link",
                places=", ".join(map(place_in_mm, threads.places)),
                **words,
            )
        if threads.is_blind:
            yield say(
                "threads {depth} mm deep in holes of Ø {drill}, {hole} mm deep, from the side of "
                "the link",
                depth=in_mm(1e3 * threads.depth),
                drill=in_mm(threads.thread.drill),
                hole=in_mm(1e3 * threads.hole),
            )
        else:
            yield say("threads all through")
        if self.density is not None:
            yield self._screws_line(threads, self.density)

    def _screws_line(self, threads: ScrewThreads, density: float) -> str:
        """What screws without heads weigh beyond what was drilled out."""
        beyond = MATERIALS["steel"] * threads.filled - density * threads.drilled
        if abs(beyond) < LIGHT_SCREWS * (self.mass or 0.0):
            return say("the threads are filled by steel screws, whose heads are not counted")
        template = to_say(
            "the threads are filled by steel screws, which add {mass} without their heads"
        )
        if beyond < 0:
            template = to_say(
                "the threads are filled by steel screws, which without their heads are {mass} "
                "lighter than what was drilled out"
            )
        return say(template, mass=workshop_mass(abs(beyond)))

    def _round_lines(self) -> Iterator[str]:
        """Where a sector points, or a disc lies, in the axes of its link."""
        if self.arcs:
            outer = self.arcs[0]
            yield say(
                "{radii} about the axis, over {angle}°, its middle at {direction}° from the x axis "
                "of the link",
                radii=", ".join(arc.text for arc in self.arcs),
                angle=in_mm(degrees(outer.angle)),
                direction=in_mm(180 - (180 - round(degrees(outer.direction), 2)) % 360),
            )
        elif self.is_round:
            (circle_of, *_) = (curve for curve in _curves(self.edges[0]) if curve.whole)
            place = place_in_mm(circle_of.center)
            yield say("its centre at {place} mm in the axes of the link", place=place)

    @property
    def thread_circles(self) -> tuple[tuple[complex, float], ...]:
        """Centre and radius of each thread, m."""
        if self.threads is None:
            return ()
        return tuple((place, self.threads.size / 2e3) for place in self.threads.places)

    @property
    def joints(self) -> tuple[tuple[str, complex], ...]:
        """Points of the link that lie within the outline of the part or at its edge."""
        low, high = self.box
        slack = ON_EDGE * abs(high - low)
        outline = np.concatenate([*places_along(self.edges[0])])
        return tuple((name, at) for name, at in self.points if _within(outline, at, slack))

    @property
    def title(self) -> str:
        """With how thick it is."""
        if self.thickness is None:
            return self.label
        size = format_quantity(self.thickness, "length")
        return say("{name}, {size} thick", name=self.label, size=size)

    @property
    def box(self) -> tuple[complex, complex]:
        """Lower left and upper right corner, m."""
        every = np.concatenate([*chain(*map(places_along, self.edges))])
        low = complex(every.real.min(), every.imag.min())
        return low, complex(every.real.max(), every.imag.max())


def parts(job: Job) -> list[Part]:
    """Every part of a machine with an outline; notes name the others, which are left out.

    Raises
    ------
    UsageError : there is none.
    """
    items = [*_of_links(job), *_of_changes(job)]
    if not items:
        raise UsageError(_refusal(job))
    return items


def _refusal(job: Job) -> Note:
    """Why there is nothing to cut, and what would give something."""
    if job.changes is None:
        return Note(
            "the model has no outlines; give a link bodies such as "
            "plates, or export it balanced, with counterweights that are discs, "
            "rings or sectors"
        )
    if not job.changes:
        return Note(
            "the model has no outlines, and balancing changes no "
            "masses; give a link bodies such as plates"
        )
    cure = Note("give a link bodies such as plates")
    if any(change.values.get("pieces") for change in job.changes):
        cure = Note(
            '{sentence}, or a mass of the plan the shape "disc", "ring" or "sector"', sentence=cure
        )

    changed = ", ".join(dict.fromkeys(change.link for change in job.changes))
    return Note(
        "the model has no outlines, and balancing gives none to what it changes: {changed}; {cure}",
        changed=changed,
        cure=cure,
    )


def in_mm(length: float) -> str:
    """A length in mm with two decimals at most, and none where it is whole, as drawings have it."""
    return decimals(f"{length:.2f}".rstrip("0").rstrip("."))


def place_in_mm(place: complex) -> str:
    """Both coordinates of a place, m, in mm and in brackets."""
    return f"({coordinates([in_mm(1e3 * place.real), in_mm(1e3 * place.imag)])})"


GRAM, LIGHT = 1e-3, 1e-2
"""kg; below the second a workshop weighs to a tenth of the first."""


def workshop_mass(mass: float) -> str:
    """A mass as a workshop weighs it, with its unit: to a gram, a small one to a tenth of it."""
    unit = display("mass", [mass])
    step = GRAM if mass >= LIGHT else GRAM / 10
    digits = max(0, ceil(-log10(step * unit.factor) - 1e-9))
    return unit.with_unit(decimals(fixed(unit, mass, digits)))


def sides(edges: tuple[BulgedCorner, ...]) -> Iterator[tuple[complex, float, complex]]:
    """Both ends, m, of each edge of a closed outline, and its bulge between them."""
    for (item, bulge), (other, _) in zip(edges, (*edges[1:], edges[0]), strict=True):
        yield item, bulge, other


def area_of(edges: tuple[BulgedCorner, ...]) -> float:
    """Area of a closed outline, m2: that of its corners, and the segments below its arcs."""
    total = 0.0
    for item, bulge, other in sides(edges):
        total += (item.conjugate() * other).imag / 2
        if bulge:
            angle = 4 * atan(bulge)
            radius = abs(other - item) / 2 / sin(angle / 2)
            total += radius**2 * (angle - sin(angle)) / 2
    return abs(total)


def _rounded(center: complex, radius: float) -> tuple[float, ...]:
    """Centre and radius to a nanometre, by which arcs of the same circle are known."""
    return tuple(round(1e9 * size) for size in (center.real, center.imag, radius))


def _curves(edges: tuple[BulgedCorner, ...]) -> Iterator[RoundEdge]:
    """Circles and arcs of a closed outline; the halves of an arc are one."""
    by_name: dict[tuple[float, ...], list[tuple[complex, float, complex, float]]] = {}
    for item, bulge, other in sides(edges):
        if bulge:
            center = (item + other) / 2 + 1j * (other - item) / 2 / tan(2 * atan(bulge))
            radius = abs(item - center)
            middle = complex(along(item, other, bulge, 3)[1])
            key = _rounded(center, radius)
            by_name.setdefault(key, []).append((center, radius, middle, 4 * abs(atan(bulge))))
    for arcs in by_name.values():
        center, radius, *_ = arcs[0]
        angle = sum(arc[3] for arc in arcs)
        whole = angle >= FULL_TURN
        toward = sum(arc[2] - center for arc in arcs)
        yield RoundEdge(center, radius, phase(toward) if not whole else 0.0, angle, whole)


def along(point: complex, other: complex, bulge: float, count: int) -> Any:
    """Places (count,) on an edge, from its first end to its second."""
    share = np.linspace(0.0, 1.0, count)
    if not bulge:
        return point + (other - point) * share
    half = 2 * np.arctan(bulge)  # of the arc's angle
    center = (point + other) / 2 + 1j * (other - point) / 2 / np.tan(half)
    return center + (point - center) * np.exp(2j * half * share)


def places_along(edges: tuple[BulgedCorner, ...]) -> Iterator[Any]:
    """Places (n,) along each edge in turn, m; of an arc a degree apart at most."""
    for item, bulge, other in sides(edges):
        yield along(item, other, bulge, 181 if bulge else 2)


def _within(outline: Any, at: complex, slack: float) -> bool:
    """Whether a point lies within a closed outline (n,), or not farther than a slack from it, m."""
    start = outline - at
    step = np.roll(start, -1) - start
    start, step = start[step != 0], step[step != 0]
    share = np.clip(-(start * step.conj()).real / np.abs(step) ** 2, 0.0, 1.0)
    if np.min(np.abs(start + share * step)) <= slack:
        return True
    return bool(abs(np.sum(np.angle(1 + step / start))) > pi)  # once round, or not at all


def _of_links(job: Job) -> Iterator[Part]:
    for name, link in job.machine.links.items():
        for number, body in enumerate(link.bodies, 1):
            edges = tuple(_edges(body, link.points))
            if section := _drawn_section(body):
                job.leave_out(
                    Note(
                        "body {number} of {link!r}, {section}, which no plate gives",
                        number=number,
                        link=name,
                        section=section,
                    )
                )
            elif edges:
                points = tuple((p, complex(*at)) for p, at in link.points.items())
                yield Part(
                    name, body.shape, number, body.thickness, edges, body.density, points=points
                )
            elif body.shape != "point" or not job.changes:  # those are reported with the changes
                job.leave_out(
                    Note(
                        "body {number} of {link!r} ({shape}) without an outline",
                        number=number,
                        link=name,
                        shape=body.shape,
                    )
                )


def _drawn_section(body: Body) -> Note | None:
    """The section of a bar that is cut to length from a tube or rod; None of what is a plate."""
    if body.outer_diameter is not None:
        outer = format_quantity(body.outer_diameter, "length")
        if not body.inner_diameter:
            return Note("a rod of {outer}", outer=outer)
        bore = format_quantity(body.inner_diameter, "length")
        return Note("a tube of {outer} with a bore of {bore}", outer=outer, bore=bore)
    if body.wall is None or body.width is None:
        return None
    sides = [
        format_quantity(side, "length") for side in (body.width, body.thickness) if side is not None
    ]
    wall = format_quantity(body.wall, "length")
    return Note("a tube of {sides} with walls of {wall}", sides=" x ".join(sides), wall=wall)


def _edges(body: Body, points: Points) -> Iterator[tuple[BulgedCorner, ...]]:
    """Outline and openings of a body."""
    for corners, radius in outlines(body, points):
        yield (
            circle(corners[0], abs(radius))
            if radius
            else tuple((corner, 0.0) for corner in corners)
        )
    for hole in body.holes:
        yield circle(complex(place_of(hole.at, points)), hole.radius)


def circle(center: complex, radius: float) -> tuple[BulgedCorner, ...]:
    """Two half circles."""
    return (center - radius, 1.0), (center + radius, 1.0)


def _of_changes(job: Job) -> Iterator[Part]:
    """Counterweights that balancing adds; those of a link may come from several changes."""
    counts: Counter[str] = Counter()
    motion = cache(partial(move, job.machine, 360))
    for change in job.changes or ():
        pieces: Iterable[dict[str, Any]] = change.values.get("pieces", ())
        for piece in pieces:
            counts[change.link] += 1
            center = complex(*change.values["center"])
            edges = tuple(_edges_of_piece(piece, center))
            screwed = needs_threads(piece, center)
            threads = threads_of(piece, center, motion(), change.link) if screwed else None
            part = Part(change.link, COUNTERWEIGHT, counts[change.link], piece.get("thickness"),
                        edges, piece.get("density"), screwed, threads)  # fmt: skip
            if not edges:
                job.leave_out(Note("{part}, a point mass without an outline", part=part.name))
                continue
            if screwed and threads is None:
                note = Note(
                    "threads of {part}: no {least} to {most} screws up to M{size} fit in it "
                    "and hold it",
                    part=part.name,
                    least=COUNTS[0],
                    most=COUNTS[-1],
                    size=COARSE_THREADS[-1].size,
                )
                job.leave_out(note)
            yield part


def _edges_of_piece(piece: dict[str, Any], center: complex) -> Iterator[tuple[BulgedCorner, ...]]:
    """Outline and opening of a piece; rings and sectors lie about the centre of their room."""
    if piece["shape"] == "disc":
        yield circle(complex(*piece["place"]), piece["radius"])
    elif is_ring(piece):
        yield circle(center, piece["outer_radius"])
        if piece["inner_radius"]:
            yield circle(center, piece["inner_radius"])
    elif piece["shape"] == "sector":
        yield _sector(piece, center)


def _sector(piece: dict[str, Any], center: complex) -> tuple[BulgedCorner, ...]:
    """A sector of a ring: two arcs, each in halves, so that none is longer than half a circle."""
    outer, inner, half = piece["outer_radius"], piece["inner_radius"], piece["angle"] / 2
    bulge = tan(half / 4)
    ends = [rect(1.0, piece["direction"] + turn) for turn in (-half, 0.0, half)]
    there = [(center + outer * end, bulge) for end in ends]
    back = [(center + inner * end, -bulge) for end in reversed(ends)] if inner else [(center, 0.0)]
    return (*there[:-1], (there[-1][0], 0.0), *back[:-1], (back[-1][0], 0.0))
