"""Signs of a drawing that follow the numbers of a machine: what of each is tied to which points.

A page that computes positions by itself draws the same signs with other lengths, without knowing
what they stand for.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from equipoise.keys.paths import KeyPath
from equipoise.mechanism.assembly.joints import coupling_pins
from equipoise.mechanism.formulas.rolling import LEFT, RIGHT
from equipoise.mechanism.kinematics.motion import Motion
from equipoise.mechanism.parts.couplings import coupling_kinds
from equipoise.mechanism.parts.machine import FRAME
from equipoise.symbols.pieces import Piece, pieces
from equipoise.symbols.scene import WIDE, GuideSign, Scene
from equipoise.symbols.shapes import Array, Shape
from equipoise.symbols.slots import SLOTS
from equipoise.web.block import Values

SAME = 1e-9
"""Over the size of the machine: how near a corner is to the point that it is."""
PLATES = ("edge", "body", "rod-edge", "rod")
"""Roles of shapes around all points of a link."""


def ties_of(scene: Scene, motion: Motion) -> list[list[Values | None]]:
    """What each shape of each sign is tied to, in the order of `stage_of`; None of one that stays.

    corners : of each corner a point, ``@`` and a link for its centre of mass, a guide and the share
        of the way from one end of the block's path to the other, or None where it stays.
    hull : true where corners are those around all points of the link.
    turned : moves with a point that it is ``about``; larger and turned as the vector ``between``
        two points is, in the axes of the body ``of``, where these are given.
    strand : its side, its pins ``between`` and the pulleys' radii.
    made_of : beginnings of paths of numbers; where one of these is another, the shape is left out.
    """
    return [
        [_tie(scene, motion, piece, shape) for shape in piece.shapes] for piece in pieces(scene)
    ]


def _tie(scene: Scene, motion: Motion, piece: Piece, shape: Shape) -> Values | None:
    body = FRAME if piece.hold is None else piece.hold.link
    if not body:
        return None  # it moves with a guide, or is stretched between points
    if numbers := [*_shaping(piece, body, shape.role)]:
        return {"made_of": numbers}
    if piece.layer == "drive" and piece.hold is not None:
        return _of_arrow(scene, body)
    if piece.part is not None and piece.part[0] != "slider":
        return _of_coupling(motion, piece, shape)
    tie = _of_points(scene, piece, shape, body)
    if piece.table in coupling_kinds(type(motion.machine)):
        return {**(tie or {}), "made_of": [piece.table, *_of_shape(motion, shape.role)]}
    return tie


def _shaping(piece: Piece, body: str, role: str) -> Iterator[str]:
    """Numbers from which solids of a link, and slots in a body, are computed."""
    if role in ("solid", "opening"):
        keys = ("bodies", "points", "length", "sides")
        yield from (str(KeyPath(("links", body, key))) for key in keys)
    elif role in SLOTS:
        yield piece.table
        yield str(_points_of(body))


def _of_shape(motion: Motion, role: str) -> Iterator[str]:
    """Numbers besides those of its list from which ribs and faces are computed; none of rollers."""
    if role != "rider":
        yield "sliders"
        yield from (str(_points_of(body)) for body in (FRAME, *motion.machine.links))


def _points_of(body: str) -> KeyPath:
    """Path of the points of a body in its file."""
    return KeyPath((FRAME, "points") if body == FRAME else ("links", body, "points"))


def _of_coupling(motion: Motion, piece: Piece, shape: Shape) -> Values | None:
    """What is drawn of couplings."""
    table, name = piece.part or ("", "")
    joints = motion.linkage.joints
    coupling = next(
        coupling
        for coupling in joints.couplings
        if (coupling.list_name, coupling.name) == (table, name)
    )
    link = FRAME if piece.hold is None else piece.hold.link
    if shape.role == "strand":
        return _strand(motion, shape, coupling)
    if link not in dict(coupling.circles(lambda: 1.0)):
        return {"made_of": [*_made_of(motion, table, name)]}
    about = joints.pins_between(link, coupling.carrier)[0]
    if not coupling.grows:
        return {"turned": {"about": about}}
    pins = [*coupling_pins(joints, coupling)]
    return {"turned": {"about": about, "between": pins, "of": coupling.carrier}}


def _of_points(scene: Scene, piece: Piece, shape: Shape, body: str) -> Values | None:
    """Corners that are points, centres of mass, or on the path of a block."""
    own = {} if piece.layer == "guides" else dict(_places(scene, body))
    guides = [guide for guide in scene.guides if guide.on == body]
    corners = [_corner(scene, own, guides, complex(place)) for place in shape.places]
    if all(corner is None for corner in corners):
        return None
    plate = shape.role in PLATES and len(corners) > 1
    hull = plate and all(isinstance(corner, str) and corner[0] != "@" for corner in corners)
    return {"corners": corners, **({"hull": True} if hull else {})}


def _places(scene: Scene, body: str) -> Iterator[tuple[str, complex]]:
    """Points of a body and its centre of mass, from its first point and in its axes, m."""
    if body == FRAME:
        yield from ((name, complex(scene.places[name][0])) for name in scene.frame)
        return
    (link,) = (link for link in scene.bodies if link.name == body)
    yield from ((name, scene.local(link, scene.places[name])) for name in link.points)
    if body in scene.mass_centers:
        yield f"@{body}", scene.local(link, scene.mass_centers[body])


def _corner(
    scene: Scene, own: dict[str, complex], guides: list[GuideSign], place: complex
) -> str | list[str | float] | None:
    tolerance = SAME * WIDE * scene.unit
    for name, at in own.items():
        if abs(at - place) <= tolerance:
            return name
    for guide in guides:
        low, high = _ends(scene, guide)
        way = high - low
        if not abs(way) > tolerance:
            continue
        share = (place - low) / way
        if abs(share.imag) * abs(way) <= tolerance and -1e-6 <= share.real <= 1 + 1e-6:
            return [guide.name, share.real]
    return None


def _ends(scene: Scene, guide: GuideSign) -> tuple[complex, complex]:
    """Both ends of a block's path, in the axes of the body that has its line, m."""
    place = scene.places[guide.point]
    ends = place - guide.behind * guide.way, place + guide.ahead * guide.way
    if guide.on == FRAME:
        return complex(ends[0][0]), complex(ends[1][0])
    (body,) = (body for body in scene.bodies if body.name == guide.on)
    return scene.local(body, ends[0]), scene.local(body, ends[1])


def _strand(motion: Motion, shape: Shape, belt: Any) -> Values | None:
    pins = coupling_pins(motion.linkage.joints, belt)
    points = motion.machine.bodies[belt.carrier]
    start, end = (complex(*points[pin]) for pin in pins)
    strands = belt.strands(end - start)
    sides: dict[int, Array] = {side: strands.ends(side)[0] for side in (LEFT, RIGHT)}
    first = complex(shape.places[0])
    base = complex(*points[next(iter(points))]) if belt.carrier != FRAME else 0j
    side = min(sides, key=lambda side: abs(complex(sides[side]) + start - base - first))
    return {"strand": {"side": side, "between": [*pins], "radii": [strands.radius, strands.other]}}


def _made_of(motion: Motion, table: str, name: str) -> Iterator[str]:
    """Numbers from which the shape of a coupling, as it is drawn, is computed."""
    joints = motion.linkage.joints
    couplings = [coupling for coupling in joints.couplings if coupling.list_name == table]
    number, coupling = next(
        (k, coupling) for k, coupling in enumerate(couplings) if coupling.name == name
    )
    yield str(KeyPath((table, number)))
    for slider, guide in enumerate(joints.sliders):
        if (guide.link, guide.on) == (coupling.driven, coupling.carrier):
            yield str(KeyPath(("sliders", slider)))
    ends = {
        point
        for link in (coupling.driver, coupling.driven)
        for point in joints.pins_between(link, coupling.carrier)
    }
    ends |= {point for point in (getattr(coupling, "point", None),) if point}
    for body in (coupling.driver, coupling.driven, coupling.carrier):
        yield from (f"{_points_of(body) / point}." for point in sorted(ends))


def _of_arrow(scene: Scene, link: str) -> Values | None:
    """The arrow of a crank's sense, which follows the crank's longest arm."""
    (drive,) = (drive for drive in scene.drives if drive.link == link)
    (body,) = (body for body in scene.bodies if body.name == link)
    arms = scene.corners(body) - scene.local(body, scene.places[drive.pivot])
    far = body.outline[int(np.argmax(abs(arms)))]
    if far == drive.pivot:
        return None
    return {"turned": {"about": drive.pivot, "between": [drive.pivot, far], "of": link}}
