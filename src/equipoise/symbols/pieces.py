"""A machine as signs that move as rigid bodies do: whatever draws them only places them."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator
from dataclasses import replace

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.mechanism.parts.machine import FRAME
from equipoise.mechanism.parts.support import Mount, unit_vector
from equipoise.signals import Array
from equipoise.symbols.carrier import MOUNT, foot, gauge, ground, strut, turning
from equipoise.symbols.looks import LAYERS_OF_MARKS
from equipoise.symbols.scene import WIDE, DriveSign, GuideSign, LinkOutline, Scene
from equipoise.symbols.shapes import (
    PIN,
    Shape,
    block,
    circle,
    coils,
    cylinder,
    driver,
    hull,
    line,
    mass,
    off_outline,
    pivot,
    plate,
    rails,
    rim,
    slot,
    soil,
    wheel,
    zigzag,
)

SIDE_GAP = 0.6
"""How much farther than the machine the soil reaches, over its size: out of every picture."""
AHEAD = np.radians(np.linspace(24, 84, 26))
"""Angles from the crank over which the arrow of its sense goes."""
SENSE = 0.55, 30.0
"""Radius of that arrow: over the crank's length, and in units at least."""

BARREL, ROD, INSIDE = 0.55, 0.95, 0.8
"""Length of a cylinder's barrel over the largest stroke, of both over the smallest, and how much of
the barrel the rod leaves free when it is out.
"""


# -- what signs move with --------------------------------------------------------------------------


@dataclass(frozen=True, eq=False)
class PieceTrack:
    """How a piece moves over N crank angles.

    place : of its origin, (N,) complex, m.  angle : (N,) rad, counterclockwise, counted on.
    stretch : (N,) factor of its places along its x axis.
    """

    place: Array
    angle: Array
    stretch: Array

    def moved(self, shape: Shape, k: int) -> Shape:
        """A shape where it is at the k-th instant."""
        turn = np.exp(1j * self.angle[k])
        stretched = shape.places.real * self.stretch[k] + 1j * shape.places.imag
        places = self.place[k] + stretched * turn
        return replace(shape, places=places, offsets=shape.offsets * turn)


@dataclass(frozen=True)
class Hold:
    """What a piece moves with.

    point : its origin.  Its x axis is that of a link, the way of a guide, or points to another
    point, between which and the origin it is stretched; one of the three is given.
    rigid : whether it keeps its length between two points.
    mount : between whose place on the support and its ground it is stretched, instead.
    row : which of the other rows that the scene shows it belongs to, from 1; 0 where to none.
    """

    point: str = ""
    link: str = ""
    guide: str = ""
    to: str = ""
    mount: str = ""
    row: int = 0
    rigid: bool = False


def track_of(scene: Scene, hold: Hold | None, still: bool, unit: float) -> PieceTrack | None:
    """How signs with a hold, or without one, move; None where they stand still.

    still : whether they stand on the ground.  unit : of signs, m.
    """
    if hold is not None and hold.mount:
        return _strutted(scene, hold.mount, unit)
    piece_track = None if hold is None else _in_frame(scene, hold)
    if scene.swing is None or still:
        return piece_track
    if piece_track is None:
        zero = 0 * scene.crank_angle
        piece_track = PieceTrack(zero + 0j, zero, zero + 1)
    return PieceTrack(
        scene.swung(piece_track.place), piece_track.angle + scene.swing.angle, piece_track.stretch
    )


def _in_frame(scene: Scene, hold: Hold) -> PieceTrack:
    """Motion with a link, on a guide or between two points, in the axes of the frame."""
    if hold.row:
        row = scene.rows.visible[hold.row - 1]
        return PieceTrack(
            row.places[hold.point], row.angles[hold.link], np.ones(len(scene.crank_angle))
        )
    place = scene.places[hold.point]
    if hold.link:
        return PieceTrack(place, scene.angles[hold.link], np.ones(len(place)))
    if hold.guide:
        (way,) = (guide.way for guide in scene.guides if guide.name == hold.guide)
        return PieceTrack(place, np.unwrap(np.angle(way)), np.ones(len(place)))
    way = scene.places[hold.to] - place
    length = abs(way)
    usual = length if hold.rigid else float(length.mean()) or 1.0
    return PieceTrack(place, np.unwrap(np.angle(way)), length / usual)


def _strutted(scene: Scene, name: str, unit: float) -> PieceTrack:
    """Motion of what is stretched between a mount's place on the support and its ground."""
    assert scene.carrier is not None
    mount = scene.carrier.support.mounts[name]
    assert mount.point is not None
    at_rest, length = complex(*mount.point[:2]), MOUNT[0] * unit
    place = scene.swung(np.full(len(scene.crank_angle), at_rest))
    way = at_rest + length * scene.carrier.way(mount) - place
    return PieceTrack(place, np.unwrap(np.angle(way)), abs(way) / length)


# -- signs -----------------------------------------------------------------------------------------


@dataclass(frozen=True)
class PieceLayer:
    """What lies in a layer of a drawing, and so what else may cover it.

    ground : what is around the linkage; paths of points are drawn on it.
    behind : what links move in front of, so that a film need not draw it with them.
    compared : what differs between designs; a pale design beside another is drawn by it.
    """

    ground: bool = False
    behind: bool = False
    compared: bool = False


LAYERS = {
    "field": PieceLayer(ground=True, behind=True),
    "support": PieceLayer(ground=True, behind=True),
    "rows": PieceLayer(ground=True, behind=True),
    "wheels": PieceLayer(behind=True, compared=True),
    "guides": PieceLayer(behind=True),
    "stands": PieceLayer(behind=True),
    "links": PieceLayer(compared=True),
    "springs": PieceLayer(compared=True),
    "pivots": PieceLayer(compared=True),
    "blocks": PieceLayer(compared=True),
    "riders": PieceLayer(compared=True),
    "joints": PieceLayer(compared=True),
    "tray": PieceLayer(),
    "drive": PieceLayer(),
}
"""From the back to the front."""


@dataclass(frozen=True, eq=False)
class Piece:
    """Shapes that move together, in axes of their own; those without a hold stand still.

    layer : one of `LAYERS`.
    link : whose plate or bar it is, if any.
    part : ``slider``, or the list of a coupling, and the name of what it shows.
    still : whether it stands on the ground, and not on the support.
    table : key of the list that has the numbers which shape it, of signs of parts.
    """

    layer: str
    shapes: tuple[Shape, ...]
    hold: Hold | None = None
    link: str = ""
    still: bool = False
    part: tuple[str, str] | None = None
    table: str = ""

    @property
    def lies(self) -> PieceLayer:
        """Its layer."""
        return LAYERS[self.layer]

    def track(self, scene: Scene, unit: float = 0.0) -> PieceTrack | None:
        """How it moves; None where it stands still.  unit : of signs, m; the scene's if 0."""
        return track_of(scene, self.hold, self.still, unit or scene.unit)


def pieces(scene: Scene, traced: Collection[str] = (), field: bool = True) -> list[Piece]:
    """Everything of a machine that is drawn, from the back to the front.

    Large plates lie below small ones; signs of pins and masses are covered by nothing.

    traced : points that have a sign of their own because their path is drawn.
    field : whether soil and tray are among it.
    """
    items = [*_soil(scene)] if field else []
    items += [*_carrier(scene), *_rows(scene), *_wheels(scene), *_stands(scene)]
    items += [*_links(scene), *_pieces(scene, "springs")]
    items += [*_springs(scene), *_cylinder(scene), Piece("pivots", tuple(_pivots(scene)))]
    items += [
        Piece("blocks", block(), Hold(guide.point, guide=guide.name), part=_part(guide))
        for guide in scene.guides
    ]
    items += _pieces(scene, "riders")
    items += _joints(scene, traced)
    if field and scene.field is not None and scene.field.tray:
        items.append(Piece("tray", (line("tray", *scene.field.tray),)))
    items += _sense(scene)
    return [piece for piece in items if piece.shapes]


def _part(guide: GuideSign) -> tuple[str, str]:
    return "slider", guide.name


def _with(body: LinkOutline) -> Hold:
    return Hold(body.points[0], link=body.name)


# -- the field and the support ---------------------------------------------------------------------


def _soil(scene: Scene) -> Iterator[Piece]:
    if scene.field is None:
        return
    low, high = scene.linkage_box
    over = SIDE_GAP * WIDE * scene.unit
    surface, depth = scene.field.surface, scene.field.depth
    ends = low.real - over, high.real + over
    earth = soil(*ends, surface, surface - depth - over, scene.unit)
    yield Piece("field", tuple(earth), still=True)


def _carrier(scene: Scene) -> Iterator[Piece]:
    """The support, mounts and gauges; what would lie on its like from the side is drawn once."""
    carrier = scene.carrier
    if carrier is None:
        return
    body = plate(np.array(carrier.corners), ("support-edge", "support"))
    yield Piece("support", tuple(body))
    below, above = [], []  # what stands on the ground, and what the support carries
    placed, ring = set(), 0
    for name, item in carrier.items.items():
        kind = Mount if isinstance(item, Mount) else None
        if item.point is None:
            if item.axis == "pitch":
                above += turning(carrier.reference, ring, kind is None)
                ring += 1
            continue
        place, along = (complex(*z[:2]) for z in (item.point, unit_vector(item.direction)))
        if (key := (kind, round(abs(place), 9), place, along)) in placed:
            continue
        placed.add(key)
        if not isinstance(item, Mount):
            above += gauge(place, along)
            continue
        way = carrier.way(item)
        above += foot(place, way, item.one_sided)
        if way:
            below += ground(place, way)
            yield Piece("support", tuple(strut(item, 0j, 1 + 0j)), Hold(mount=name))
    if carrier.support.pivot is not None:
        below += pivot(carrier.reference)
        above.append(circle("pin", carrier.reference, grown=PIN))
    yield Piece("support", tuple(below), still=True)
    yield Piece("support", (*above, *mass(carrier.center)))


# -- the linkage -----------------------------------------------------------------------------------


def _wheels(scene: Scene) -> Iterator[Piece]:
    bodies = {body.name: body for body in scene.bodies}
    placed = set()
    for item in sorted(scene.wheels, key=lambda wheel: -wheel.radius):
        key = (item.link, item.center, round(item.radius / scene.unit))
        if item.curve is None and key in placed:
            continue
        placed.add(key)
        if item.link == FRAME:
            still = complex(scene.places[item.center][0])
            yield Piece("wheels", (rim(still, item.radius, item.curve),), part=item.part)
            continue
        body = bodies[item.link]
        center = scene.local(body, scene.places[item.center])
        shapes = tuple(wheel(center, item.radius, item.curve))
        yield Piece("wheels", shapes, _with(body), part=item.part)
    yield from _pieces(scene, "wheels")


def _pieces(scene: Scene, layer: str) -> Iterator[Piece]:
    """What moves with bodies and lies in a layer, of marks that lie in one or two."""
    bodies = {body.name: body for body in scene.bodies}
    for mark in scene.marks:
        if not (
            role := LAYERS_OF_MARKS.get(mark.shape.role, {"wheels": mark.shape.role}).get(layer)
        ):
            continue
        if mark.to:
            usual = scene.usual_length(mark.point, mark.to)
            shape = replace(mark.shape, role=role, places=mark.shape.places * usual)
            yield Piece(layer, (shape,), Hold(mark.point, to=mark.to), table=mark.table)
            continue
        start, hold = complex(scene.places[mark.point][0]), None
        if mark.body != FRAME:
            start = scene.local(bodies[mark.body], scene.places[mark.point])
            hold = _with(bodies[mark.body])
        moved = replace(mark.shape, role=role, places=mark.shape.places + start)
        yield Piece(layer, (moved,), hold, part=mark.part, table=mark.table)


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
            shapes = tuple(rails(low, high, scene.unit, grounded, guide.meshing))
            yield Piece("guides", shapes, part=_part(guide))


def _ends(scene: Scene, guide: GuideSign) -> tuple[Array, Array]:
    """First and last place of a block on its line, (N,) complex, m."""
    place = scene.places[guide.point]
    return place - guide.behind * guide.way, place + guide.ahead * guide.way


def _links(scene: Scene) -> Iterator[Piece]:
    slotted = {guide.on for guide in scene.guides}

    def order(body: LinkOutline) -> tuple[bool, int, int]:
        corners = hull(np.array([*scene.corners(body), *body.extent]))
        area = float(np.sum((np.conj(corners) * np.roll(corners, -1)).imag)) / 2
        length = float(np.max(abs(corners - corners[0])))
        finest = scene.unit / 100  # what is less is rounding
        return body.name not in slotted, -round(area / finest**2), -round(length / finest)

    for body in sorted(scene.bodies, key=order):
        shapes = (*_solids(body), *_body(scene, body))
        yield Piece("links", shapes, _with(body), body.name)


def _rows(scene: Scene) -> Iterator[Piece]:
    """Links of other rows, pale, as lines through their points."""
    for number, _ in enumerate(scene.rows.visible, 1):
        for body in scene.bodies:
            corners = [*map(complex, scene.corners(body))]
            if len(corners) > 1:
                shape = line("row", *corners, closed=len(corners) > 2)
                hold = Hold(body.points[0], link=body.name, row=number)
                yield Piece("rows", (shape,), hold)


def _solids(body: LinkOutline) -> Iterator[Shape]:
    """What a link is made of, to scale, below its sign."""
    for corners, radius in body.solids:
        role = "opening" if radius < 0 else "solid"
        yield circle(role, corners[0], abs(radius)) if radius else line(role, *corners, closed=True)


def _body(scene: Scene, body: LinkOutline) -> Iterator[Shape]:
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
        for item, other in every:
            usual = scene.usual_length(item, other)
            shape = zigzag(0, usual, coils(usual, scene.unit), role)
            yield Piece("springs", (shape,), Hold(item, to=other))


def _pivots(scene: Scene) -> Iterator[Shape]:
    for name in scene.frame:
        place = complex(scene.places[name][0])
        yield _pin(scene, name, place) if name in scene.standing else circle("dot", place, grown=2)


def _pin(scene: Scene, point: str, place: complex) -> Shape:
    """A pin, to scale where its radius is given."""
    radius = scene.pin_radii.get(point, 0.0)
    return circle("pin", place, radius, 0.0 if radius else PIN)


def _joints(scene: Scene, traced: Collection[str]) -> Iterator[Piece]:
    """Pins, traced points and centres of mass, a point with the first link that has it."""
    hung = {point for ends in scene.stretched for point in ends}
    hung |= {point for drive in scene.drives for point in drive.between or ()}
    signed, apart = {*scene.frame}, 2 * scene.unit
    for body in scene.bodies:
        own = [point for point in body.points if point not in signed]
        signed.update(own)
        shapes = [_point(scene, point, scene.local(body, scene.places[point]), traced, hung)
                  for point in own]  # fmt: skip
        center = scene.mass_centers.get(body.name)
        pins = [scene.places[point][0] for point in body.points if point in scene.pins]
        if center is not None and all(abs(center[0] - pin) > apart for pin in pins):
            shapes += mass(scene.local(body, center))
        yield Piece("joints", tuple(shapes), _with(body))


def _point(
    scene: Scene, point: str, place: complex, traced: Collection[str], hung: Collection[str]
) -> Shape:
    """A point of a link at its place in it.  hung : points at which something is stretched."""
    if point in traced:
        return circle("tip", place, grown=4.6)
    if point in scene.pins or point in hung:
        return _pin(scene, point, place)
    return circle("dot", place, grown=2.0)


def _sense(scene: Scene) -> Iterator[Piece]:
    """An arrow about the drive's pivot in the sense in which it turns, ahead of the crank; or one
    with two heads over all angles that it goes to and fro.
    """
    for drive in scene.drives:
        if drive.sense or drive.swings is not None:
            yield _arrow(scene, drive)


def _arrow(scene: Scene, drive: DriveSign) -> Piece:
    (body,) = (body for body in scene.bodies if body.name == drive.link)
    center = scene.local(body, scene.places[drive.pivot])
    arms = scene.corners(body) - center
    arm = complex(arms[np.argmax(abs(arms))])
    radius = max(SENSE[0] * abs(arm), SENSE[1] * scene.unit)
    if drive.swings is not None:
        over = np.linspace(*drive.swings, len(AHEAD)) + np.angle(arm)
        still = complex(scene.places[drive.pivot][0])
        return Piece("drive", tuple(driver(still, radius, over, both=True)))
    angles = np.angle(arm) + drive.sense * AHEAD
    return Piece("drive", tuple(driver(center, radius, angles)), _with(body))


def _cylinder(scene: Scene) -> Iterator[Piece]:
    """A barrel at one point and a rod at the other, which keep their lengths."""
    for first, second in (drive.between for drive in scene.drives if drive.between is not None):
        lengths = abs(scene.places[second] - scene.places[first])
        short, long = float(lengths.min()), float(lengths.max())
        barrel = min(max(BARREL * long, long - ROD * short), ROD * short)
        shapes = cylinder(barrel, long - INSIDE * barrel)
        for point, to, shape in ((second, first, shapes[0]), (first, second, shapes[1])):
            yield Piece("drive", (shape,), Hold(point, to=to, rigid=True))


# -- at one crank angle ----------------------------------------------------------------------------


def placed(scene: Scene, every: Iterable[Piece], k: int) -> list[Shape]:
    """The shapes of pieces where they are at the k-th crank angle, in the axes of the frame."""
    shapes: list[Shape] = []
    for piece in every:
        track = piece.track(scene)
        if track is None:
            shapes += piece.shapes
            continue
        shapes += [track.moved(shape, k) for shape in piece.shapes]
    return shapes
