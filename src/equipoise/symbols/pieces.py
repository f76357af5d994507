"""A machine as signs that move as rigid bodies do: whatever draws them only places them."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np

from equipoise.mechanism.model import FRAME
from equipoise.mechanism.support import Mount, unit_vector
from equipoise.symbols.carrier import Carrier
from equipoise.symbols.scene import WIDE, Body, Guide, Scene
from equipoise.symbols.shapes import (
    PIN,
    Array,
    Shape,
    block,
    circle,
    coils,
    driver,
    gauge,
    hull,
    line,
    mass,
    mount,
    off_outline,
    pivot,
    plate,
    rails,
    slot,
    soil,
    turning,
    wheel,
    zigzag,
)

BESIDE = 0.6
"""How much farther than the machine the soil reaches, over its size: out of every picture."""
AHEAD = np.radians(np.linspace(24, 84, 26))
"""Angles from the crank over which the arrow of its sense goes."""
SENSE = 0.55, 30.0
"""Radius of that arrow: over the crank's length, and in units at least."""


@dataclass(frozen=True, eq=False)
class Track:
    """How a piece moves over N crank angles.

    place : of its origin, (N,) complex, m.  angle : (N,) rad, counterclockwise, counted on.
    stretch : (N,) factor of its places along its x axis.
    """

    place: Array
    angle: Array
    stretch: Array


class Moving(Protocol):
    """A scene: what pieces may move with, complex (N,) m and (N,) rad by name."""

    @property
    def places(self) -> Mapping[str, Array]: ...
    @property
    def angles(self) -> Mapping[str, Array]: ...


@dataclass(frozen=True)
class Hold:
    """What a piece moves with.

    point : its origin.  Its x axis is that of a link, the way of a guide, or points to another
    point, between which and the origin it is stretched; one of the three is given.
    """

    point: str
    link: str = ""
    guide: str = ""
    to: str = ""


@dataclass(frozen=True, eq=False)
class Piece:
    """Shapes that move together, in axes of their own; those without a hold stand still.

    layer : ``field``, ``support``, ``wheels``, ``guides``, ``stands``, ``links``, ``springs``,
        ``pivots``, ``blocks``, ``joints``, ``tray`` or ``drive``.
    link : whose plate or bar it is, if any.
    """

    layer: str
    shapes: tuple[Shape, ...]
    hold: Hold | None = None
    link: str = ""

    def track(self, scene: Moving) -> Track | None:
        """How it moves."""
        if self.hold is None:
            return None
        place = scene.places[self.hold.point]
        if self.hold.link:
            return Track(place, scene.angles[self.hold.link], np.ones(len(place)))
        if self.hold.guide:
            assert isinstance(scene, Scene)
            (way,) = (guide.way for guide in scene.guides if guide.name == self.hold.guide)
            return Track(place, np.unwrap(np.angle(way)), np.ones(len(place)))
        way = scene.places[self.hold.to] - place
        length = abs(way)
        usual = float(length.mean()) or 1.0
        return Track(place, np.unwrap(np.angle(way)), length / usual)


def pieces(scene: Scene, traced: Collection[str] = (), field: bool = True) -> list[Piece]:
    """Everything of a machine that is drawn, from the back to the front.

    Large plates lie below small ones; signs of pins and masses are covered by nothing.

    traced : points that have a sign of their own because their path is drawn.
    field : whether soil and tray are among it.
    """
    found = [*_soil(scene)] if field else []
    found += [*_carrier(scene), *_wheels(scene), *_stands(scene)]
    found += _links(scene)
    found += [*_springs(scene), Piece("pivots", tuple(_pivots(scene)))]
    found += [
        Piece("blocks", tuple(block()), Hold(guide.point, guide=guide.name))
        for guide in scene.guides
    ]
    found += [
        Piece("joints", tuple(_marks(scene, body, traced)), _with(body)) for body in scene.bodies
    ]
    if field and scene.field is not None and scene.field.tray:
        found.append(Piece("tray", (line("tray", *scene.field.tray),)))
    found += _sense(scene)
    return [piece for piece in found if piece.shapes]


def _with(body: Body) -> Hold:
    return Hold(body.points[0], link=body.name)


# -- the field and the support ---------------------------------------------------------------------


def _soil(scene: Scene) -> Iterator[Piece]:
    if scene.field is None:
        return
    low, high = scene.linkage_box
    over = BESIDE * WIDE * scene.unit
    surface, depth = scene.field.surface, scene.field.depth
    ends = low.real - over, high.real + over
    yield Piece("field", tuple(soil(*ends, surface, surface - depth - over, scene.unit)))


def _carrier(scene: Scene) -> Iterator[Piece]:
    carrier = scene.carrier
    if carrier is None:
        return
    body = plate(np.array(carrier.corners), ("support-edge", "support"))
    yield Piece("support", tuple(body))
    held = tuple(_held(carrier))
    if carrier.support.pivot is not None:
        held += (*pivot(carrier.reference), circle("pin", carrier.reference, grown=PIN))
    yield Piece("support", (*held, *mass(carrier.center)))


def _held(carrier: Carrier) -> Iterator[Shape]:
    """Mounts and gauges as the side shows them; what would lie on its like is drawn once."""
    seen, ring = set(), 0
    for item in carrier.items.values():
        kind = Mount if isinstance(item, Mount) else None
        if item.point is None:
            if item.axis == "pitch":
                yield from turning(carrier.reference, ring, kind is None)
                ring += 1
            continue
        place, way = (complex(*z[:2]) for z in (item.point, unit_vector(item.direction)))
        if (key := (kind, round(abs(place), 9), place, way)) in seen:
            continue
        seen.add(key)
        if isinstance(item, Mount):
            yield from mount(place, way, carrier.center, bool(item.stiffness), item.one_sided)
        else:
            yield from gauge(place, way)


# -- the linkage -----------------------------------------------------------------------------------


def _wheels(scene: Scene) -> Iterator[Piece]:
    bodies = {body.name: body for body in scene.bodies}
    seen = set()
    for gear in sorted(scene.wheels, key=lambda gear: -gear.radius):
        if (key := (gear.link, gear.center, round(gear.radius / scene.unit))) in seen:
            continue
        seen.add(key)
        if gear.link == FRAME:
            still = complex(scene.places[gear.center][0])
            yield Piece("wheels", (circle("wheel", still, gear.radius),))
            continue
        body = bodies[gear.link]
        center = scene.local(body, scene.places[gear.center])
        yield Piece("wheels", tuple(wheel(center, gear.radius)), _with(body))


def _stands(scene: Scene) -> Iterator[Piece]:
    """What the frame holds links with; on a support it is that, and no ground."""
    grounded = scene.carrier is None
    stands = (
        pivot(complex(scene.places[name][0]), grounded, scene.ground(name))
        for name in scene.standing
    )
    yield Piece("stands", tuple(shape for stand in stands for shape in stand))
    for guide in scene.guides:
        if guide.on == FRAME:
            low, high = (complex(end[0]) for end in _ends(scene, guide))
            yield Piece("guides", tuple(rails(low, high, scene.unit, grounded)))


def _ends(scene: Scene, guide: Guide) -> tuple[Array, Array]:
    """First and last place of a block on its line, (N,) complex, m."""
    place = scene.places[guide.point]
    return place - guide.behind * guide.way, place + guide.ahead * guide.way


def _links(scene: Scene) -> Iterator[Piece]:
    slotted = {guide.on for guide in scene.guides}

    def order(body: Body) -> tuple[bool, int, int]:
        corners = hull(np.array([*scene.corners(body), *body.extent]))
        area = float(np.sum((np.conj(corners) * np.roll(corners, -1)).imag)) / 2
        length = float(np.max(abs(corners - corners[0])))
        finest = scene.unit / 100  # what is less is rounding
        return body.name not in slotted, -round(area / finest**2), -round(length / finest)

    for body in sorted(scene.bodies, key=order):
        shapes = (*_solids(body), *_body(scene, body))
        yield Piece("links", shapes, _with(body), body.name)


def _solids(body: Body) -> Iterator[Shape]:
    """What a link is made of, to scale, below its sign."""
    for corners, radius in body.solids:
        role = "opening" if radius < 0 else "solid"
        yield circle(role, corners[0], abs(radius)) if radius else line(role, *corners, closed=True)


def _body(scene: Scene, body: Body) -> Iterator[Shape]:
    corners = list(map(complex, scene.corners(body)))
    if body.name in scene.mass_centers:
        center = scene.local(body, scene.mass_centers[body.name])
        nearest = min(corners, key=lambda corner: abs(corner - center))
        if len(corners) == 1:  # it reaches to where its mass is
            corners += [center] * (abs(center - nearest) > 6 * scene.unit)
        elif not body.solids and off_outline(center, corners) > 8 * scene.unit:
            yield line("tie", nearest, center)
    if len(corners) > 1:
        frame = body.solids and len(corners) > 2  # so that what it is made of is seen
        yield from plate(np.array(corners), ("rod-edge", "rod") if frame else ("edge", "body"))
    for guide in scene.guides:
        if guide.on == body.name:
            yield from slot(*(scene.local(body, end) for end in _ends(scene, guide)))


def _springs(scene: Scene) -> Iterator[Piece]:
    for role, every in (("spring", scene.springs), ("planned", scene.planned)):
        for one, other in every:
            usual = float(abs(scene.places[other] - scene.places[one]).mean()) or 1.0
            shape = zigzag(0, usual, coils(usual, scene.unit), role)
            yield Piece("springs", (shape,), Hold(one, to=other))


def _pivots(scene: Scene) -> Iterator[Shape]:
    for name in scene.frame:
        role, grown = ("pin", PIN) if name in scene.standing else ("dot", 2.0)
        yield circle(role, complex(scene.places[name][0]), grown=grown)


def _marks(scene: Scene, body: Body, traced: Collection[str]) -> Iterator[Shape]:
    """Pins, traced points and centre of mass of a link."""
    others = scene.bodies[: scene.bodies.index(body)]
    hung = {point for point, _ in (*scene.springs, *scene.planned)}
    drawn = {*scene.frame, *(point for other in others for point in other.points)}
    for point in body.points:
        if point in drawn:
            continue
        role, grown = ("pin", PIN) if point in scene.pins or point in hung else ("dot", 2.0)
        if point in traced:
            role, grown = "tip", 4.6
        yield circle(role, scene.local(body, scene.places[point]), grown=grown)
    center = scene.mass_centers.get(body.name)
    if center is not None:
        place = scene.local(body, center)
        pins = (scene.places[point] for point in body.points if point in scene.pins)
        if all(abs(place - scene.local(body, pin)) > 2 * scene.unit for pin in pins):
            yield from mass(place)


def _sense(scene: Scene) -> Iterator[Piece]:
    """An arrow about the drive's pivot in the sense in which it turns, ahead of the crank."""
    drive = scene.drive
    if not drive.sense:
        return
    (body,) = (body for body in scene.bodies if body.name == drive.link)
    center = scene.local(body, scene.places[drive.pivot])
    arms = scene.corners(body) - center
    arm = complex(arms[np.argmax(abs(arms))])
    radius = max(SENSE[0] * abs(arm), SENSE[1] * scene.unit)
    angles = np.angle(arm) + drive.sense * AHEAD
    yield Piece("drive", tuple(driver(center, radius, angles)), _with(body))


# -- at one crank angle ----------------------------------------------------------------------------

GROUND = ("field", "support")
"""Layers of pieces that paths are drawn on."""


def placed(scene: Moving, every: list[Piece], k: int) -> list[Shape]:
    """The shapes of pieces where they are at the k-th crank angle, in the axes of the frame."""
    found: list[Shape] = []
    for piece in every:
        track = piece.track(scene)
        if track is None:
            found += piece.shapes
            continue
        turn = np.exp(1j * track.angle[k])
        for shape in piece.shapes:
            stretched = shape.places.real * track.stretch[k] + 1j * shape.places.imag
            places = track.place[k] + stretched * turn
            found.append(replace(shape, places=places, offsets=shape.offsets * turn))
    return found
