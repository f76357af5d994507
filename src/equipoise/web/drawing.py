"""The drawing of a machine as a page is sent it: signs, and what moves them.

A page that is sent states gets arrays over the crank angle (`moves_of`).  One that computes
positions by itself draws the same signs with other lengths, without knowing what they stand for:
it gets what of each is tied to which points (`ties_of`).
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import Any

import numpy as np

from equipoise.keys.paths import KeyPath
from equipoise.mechanism.assembly.joints import Structure, coupling_pins
from equipoise.mechanism.formulas.rolling import LEFT, RIGHT
from equipoise.mechanism.kinematics.motion import Motion
from equipoise.mechanism.kinematics.tip import surface_of
from equipoise.mechanism.parts.couplings import coupling_kinds
from equipoise.mechanism.parts.machine import FRAME, Machine
from equipoise.signals import Array
from equipoise.symbols.carrier import MOUNT
from equipoise.symbols.looks import LOOKS
from equipoise.symbols.part_signs import dragged_circles
from equipoise.symbols.pieces import Piece, pieces
from equipoise.symbols.scene import WIDE, GuideSign, Scene
from equipoise.symbols.shapes import Shape
from equipoise.symbols.slots import SLOTS
from equipoise.web.edits import Computed
from equipoise.web.messages import JsonObject
from equipoise.web.replies import FloatBlock

UNIT = 1.25
"""Pixels: size of a unit of signs on a page."""


def stage_of(
    scene: Scene, handles: Sequence[str], circles: Sequence[JsonObject] = ()
) -> JsonObject:
    """Names and the drawing of a scene.

    signs : from the back to the front, each with what its layer is (``ground``, ``compared``), the
        ``link`` that it is, the ``part`` (``slider`` or ``gears``, and its name) that it shows,
        what it moves with (`symbols.pieces.Hold`, with the ``length`` of which it is stretched),
        and its shapes: role, whether it is closed, radius (m), and that in pixels, then x and y (m)
        and offsets from there (pixels) of each corner.
    looks : role -> style.
    circles : see `circles_of`.
    """
    low, high = scene.box
    symbols = pieces(scene)
    shapes = iter(shapes_of([shape for piece in symbols for shape in piece.shapes]))
    roles = sorted({shape.role for piece in symbols for shape in piece.shapes})
    return {
        "frame": list(scene.frame),
        "standing": list(scene.standing),
        "bodies": [{"name": body.name, "points": list(body.points)} for body in scene.bodies],
        "guides": [{"name": guide.name, "point": guide.point} for guide in scene.guides],
        "mass_centers": list(scene.mass_centers),
        "box": [low.real, low.imag, high.real, high.imag],
        "movable": list(handles),
        "circles": list(circles),
        "signs": [
            {**_sign(scene, piece), "shapes": [next(shapes) for _ in piece.shapes]}
            for piece in symbols
        ],
        "looks": {role: LOOKS[role].css(UNIT) for role in roles},
        "reference": _reference(scene),
    }


def _sign(scene: Scene, piece: Piece) -> JsonObject:
    hold = None if piece.hold is None else {k: v for k, v in vars(piece.hold).items() if v}
    if hold is not None and "to" in hold:
        hold["length"] = float(np.max(piece.shapes[0].places.real))
    if hold is not None and "mount" in hold:
        hold |= _strut(scene, hold["mount"])
    return {
        "ground": piece.lies.ground,
        "compared": piece.lies.compared,
        "link": piece.link,
        "hold": hold,
        "part": piece.part,
        "still": piece.still,
    }


def circles_of(machine: Machine, joints: Structure) -> list[JsonObject]:
    """What a page needs to change circles by hand: of each the list of its part, the path and the
    value of its radius, its centre, and the point across from which it is dragged.
    """
    return [
        {
            "name": circle.name,
            "table": table,
            "path": str(KeyPath((table, number, circle.key))),
            "radius": getattr(part, circle.key),
            "axis": circle.axis,
            "point": circle.point,
        }
        for table, number, part, circle in dragged_circles(machine, joints)
    ]


def _strut(scene: Scene, name: str) -> JsonObject:
    """Place of a mount on the support at rest (m), and from there to its ground (pixels)."""
    assert scene.carrier is not None
    mount = scene.carrier.support.mounts[name]
    assert mount.point is not None
    way = UNIT * MOUNT[0] * scene.carrier.way(mount)
    return {"at": list(mount.point[:2]), "ground": [way.real, way.imag]}


def _reference(scene: Scene) -> list[float] | None:
    """What a support turns about, m; None where there is none."""
    if scene.carrier is None:
        return None
    return [scene.carrier.reference.real, scene.carrier.reference.imag]


def shapes_of(shapes: Sequence[Shape]) -> list[list[Any]]:
    """Shapes as values of a message, see `stage_of`."""
    if not shapes:
        return []
    places = np.concatenate([shape.places for shape in shapes])
    offsets = UNIT * np.concatenate([shape.offsets for shape in shapes])
    corners = np.column_stack([
        places.real.round(7), places.imag.round(7), offsets.real.round(2), offsets.imag.round(2)
    ]).ravel().tolist()  # fmt: skip
    ends = 4 * np.cumsum([0, *(len(shape.places) for shape in shapes)])
    return [
        [shape.role, shape.closed, shape.radius, round(UNIT * shape.grown, 2), corners[low:high]]
        for shape, (low, high) in zip(shapes, pairwise(ends), strict=True)
    ]


def moves_of(scene: Scene, block: FloatBlock) -> None:
    """Where everything of a drawing is over the crank angle, for the block."""
    block.add("crank_angle", scene.crank_angle)
    for name, place in scene.places.items():
        block.add(f"place.{name}", place)
    for name, place in scene.mass_centers.items():
        block.add(f"mass_center.{name}", place)
    for name, angle in scene.angles.items():
        block.add(f"angle.{name}", angle)
    for guide in scene.guides:
        block.add(f"guide.{guide.name}", guide.way)


def ground_of(computed: Computed, block: FloatBlock) -> JsonObject:
    """Paths of planting tips over ground, for the block, and the soil that they go into."""
    planting, speed = computed.analysis.machine.planting, computed.motion.speed
    if planting is None or speed == 0:
        return {}
    scene = computed.scene
    way = planting.forward(speed) / speed * scene.crank_angle
    tips = [arm.tip for arm in planting.every_arm]
    for tip in tips:
        block.add(f"ground.{tip}", scene.places[tip] + way)
    return {"planting": {"tips": tips, "surface": surface_of(computed.analysis.machine)}}


SAME = 1e-9
"""Over the size of the machine: how near a corner is to the point that it is."""
PLATES = ("edge", "body", "rod-edge", "rod")
"""Roles of shapes around all points of a link."""


def ties_of(scene: Scene, motion: Motion) -> list[list[JsonObject | None]]:
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


def _tie(scene: Scene, motion: Motion, piece: Piece, shape: Shape) -> JsonObject | None:
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


def _of_coupling(motion: Motion, piece: Piece, shape: Shape) -> JsonObject | None:
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


def _of_points(scene: Scene, piece: Piece, shape: Shape, body: str) -> JsonObject | None:
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


def _strand(motion: Motion, shape: Shape, belt: Any) -> JsonObject | None:
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


def _of_arrow(scene: Scene, link: str) -> JsonObject | None:
    """The arrow of a crank's sense, which follows the crank's longest arm."""
    (drive,) = (drive for drive in scene.drives if drive.link == link)
    (body,) = (body for body in scene.bodies if body.name == link)
    arms = scene.corners(body) - scene.local(body, scene.places[drive.pivot])
    far = body.outline[int(np.argmax(abs(arms)))]
    if far == drive.pivot:
        return None
    return {"turned": {"about": drive.pivot, "between": [drive.pivot, far], "of": link}}
