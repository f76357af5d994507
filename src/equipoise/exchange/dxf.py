"""DXF: the linkage at a crank angle, paths of its points, and parts to be cut, in mm.

Each link, path and part has a layer, so that a drawing program can show and cut what is wanted.
Parts lie beside the linkage, below one another, in the axes of their links.
"""

from __future__ import annotations

import io
import re
from collections.abc import Iterable
from itertools import cycle
from math import degrees
from typing import Any

import numpy as np

from equipoise.errors import UsageError, needed
from equipoise.exchange.formats import Job
from equipoise.exchange.parts import COUNTERWEIGHT, Part, parts
from equipoise.i18n import Note, decimal_sign, spoken
from equipoise.i18n.decimals import POINT
from equipoise.i18n.languages import KNOWN
from equipoise.mechanism.assembly.cam_shapes import fits_of
from equipoise.mechanism.kinematics.motion import Motion, move
from equipoise.mechanism.parts.machine import FRAME
from equipoise.symbols.scene import Scene

MM = 1e3
"""mm in a metre."""
ANGLES = 360
"""Points of a path in each turn."""
FORBIDDEN = re.compile(r'[<>/\\":;?*|=`,]')
"""Signs that names of layers must not have."""


def export_bytes(job: Job) -> str:
    """The file's text."""
    drawing = needed("ezdxf", "DXF").new("R2010", units=4)
    space = drawing.modelspace()
    angles = move(job.machine, ANGLES).crank_angle
    motion = move(job.machine, [job.crank_angle, *angles])
    scene = Scene.of(motion)
    if job.machine.rows:
        job.leave_out(Note("rows: one linkage is drawn"))
    _linkage(space, scene)
    for write in job.writers("dxf"):
        write(space, scene, motion)
    _paths(space, scene)
    try:
        _parts(space, parts(job), scene, job.sizes)
    except UsageError:  # nothing to cut is nothing wrong here
        job.left_out.append(Note("parts to be cut: the model has no outlines"))
    for name in sorted({entity.dxf.layer for entity in space} - {"0"}):
        drawing.layers.add(name)
    text = io.StringIO()
    drawing.write(text)
    return text.getvalue()


def _layer(*words: str) -> dict[str, str]:
    return {"layer": FORBIDDEN.sub("_", " ".join(words))[:250]}


def _points(places: Iterable[complex]) -> list[tuple[float, float]]:
    return [(MM * place.real, MM * place.imag) for place in places]


def _linkage(space: Any, scene: Scene) -> None:
    """Links as lines between their points, guides, gears and springs as they stand, and names."""
    at = {name: complex(place[0]) for name, place in scene.places.items()}
    low, high = scene.linkage_box
    letter = MM * abs(high - low) / 60
    for body in scene.bodies:
        corners = _points(at[name] for name in body.outline)
        layer = _layer("link", body.name)
        if len(corners) > 1:
            space.add_lwpolyline(corners, close=len(corners) > 2, dxfattribs=layer)
    for guide in scene.guides:
        way, place = guide.way[0], at[guide.point]
        ends = _points([place - guide.behind[0] * way, place + guide.ahead[0] * way])
        space.add_line(*ends, dxfattribs=_layer("guide", guide.name))
    for item, other in scene.springs:
        space.add_line(*_points([at[item], at[other]]), dxfattribs=_layer("springs"))
    for wheel in scene.wheels:
        (center,) = _points([at[wheel.center]])
        layer = _layer("gears", wheel.link)
        if wheel.curve is None:
            space.add_circle(center, MM * abs(wheel.radius), dxfattribs=layer)
        else:
            turned = wheel.curve * np.exp(
                1j * (scene.angles[wheel.link][0] if wheel.link in scene.angles else 0.0)
            )
            space.add_lwpolyline(_points(at[wheel.center] + turned), close=True, dxfattribs=layer)
    for mark in scene.marks:
        if table := mark.part and mark.part[0]:
            corners = _points(corner[0] for corner in scene.spots(mark))
            layer = _layer(table, mark.body)
            space.add_lwpolyline(corners, close=mark.shape.closed, dxfattribs=layer)
    for name, spot in zip(at, _points(at.values()), strict=True):
        layer_name = FRAME if name in scene.frame else "points"
        space.add_point(spot, dxfattribs=_layer(layer_name))
        space.add_text(name, height=letter, dxfattribs=_layer("names")).set_placement(spot)


def roller_paths(space: Any, scene: Scene, motion: Motion) -> None:
    """The way of each roller's centre round its cam, as a cutter of its radius goes."""
    turn = np.linspace(0.0, 2 * np.pi, ANGLES, endpoint=False)
    for fit in fits_of(motion.machine, motion.linkage.joints):
        if fit.cam.rides == "roller":
            turned = scene.angles[fit.cam.driver][0] if fit.cam.driver != FRAME else 0.0
            curve = scene.places[fit.cam_pin][0] + fit.shape(turn).pitch * np.exp(1j * turned)
            layer = _layer("pitch curve", fit.cam.name)
            space.add_lwpolyline(_points(curve), close=True, dxfattribs=layer)


def _paths(space: Any, scene: Scene) -> None:
    """Ways of all points that move, over the whole cycle."""
    for name, places in scene.places.items():
        if name not in scene.frame:
            corners = _points(places[1:])
            space.add_lwpolyline(corners, close=True, dxfattribs=_layer("path", name))


def _parts(space: Any, parts: list[Part], scene: Scene, sizes: str) -> None:
    """Parts one below the other, right of the linkage.

    sizes : on what rounding of counterweights changes.
    """
    low, high = (MM * corner for corner in scene.linkage_box)
    gap = abs(high - low) / 10
    corner = high + gap
    for part in parts:
        lowest, highest = (MM * item for item in part.box)
        shift = corner - complex(lowest.real, highest.imag)
        layer = _layer("part", part.name)
        for edges in part.edges:
            moved = [(MM * place + shift, bulge) for place, bulge in edges]
            rows = [(item.real, item.imag, bulge) for item, bulge in moved]
            space.add_lwpolyline(rows, format="xyb", close=True, dxfattribs=layer)
        for place, radius in part.thread_circles:
            hole = MM * place + shift
            looks = _layer("threads", part.name)
            space.add_circle((hole.real, hole.imag), MM * radius, dxfattribs=looks)
        _measures(space, part, shift, gap)
        corner -= 1j * ((highest - lowest).imag + gap)
        rounded = [sizes] if part.kind == COUNTERWEIGHT and sizes else []
        for line in (*part.lines, *rounded):
            looks = {**_layer("dimensions", part.name), "style": _style(space.doc)}
            text = space.add_text(line, height=gap / 6, dxfattribs=looks)
            text.set_placement((corner.real, corner.imag))
            corner -= 1j * gap / 3
        corner -= 1j * gap


def _style(drawing: Any) -> str:
    """The style of texts in the language that is spoken; other systems than Windows take fonts of
    their own for it.
    """
    font = KNOWN[spoken()].drawing_font
    if not font:
        return "Standard"
    if font not in drawing.styles:
        drawing.styles.new(font, dxfattribs={"font": font})
    return font


def _decimal_sign() -> dict[str, int]:
    """The decimal sign of dimensions, where it is not the point that drawings have."""
    sign = decimal_sign()
    return {} if sign == POINT else {"dimdsep": ord(sign)}


def _measures(space: Any, part: Part, shift: complex, gap: float) -> None:
    """Angle of a sector, width and height of what is not round; diameters of circles and radii of
    arcs.
    """
    low, high = (MM * place + shift for place in part.box)
    looks = {
        "override": {
            "dimtxt": gap / 8,
            "dimasz": gap / 10,
            "dimdec": 2,
            "dimzin": 8,
            **_decimal_sign(),
        },
        "dxfattribs": _layer("dimensions", part.name),
    }
    if part.arcs:
        outer = part.arcs[0]
        center, radius = MM * outer.center + shift, MM * outer.radius
        first, last = (degrees(outer.direction + side * outer.angle / 2) for side in (-1, 1))
        space.add_angular_dim_cra(
            (center.real, center.imag), radius, first, last, gap / 2, **looks
        ).render()
    elif not part.is_round:
        _widths(space, low, high, gap, looks)
    sides = cycle((0.25, -0.25))  # of an arc, beside its middle, where the angle stands
    for curve in sorted(part.curves, key=lambda item: -item.radius):
        center = MM * curve.center + shift
        place, radius = (center.real, center.imag), MM * curve.radius
        add = space.add_diameter_dim if curve.whole else space.add_radius_dim
        angle = 45.0 if curve.whole else degrees(curve.direction + next(sides) * curve.angle)
        add(place, radius=radius, angle=angle, **looks).render()


def _widths(space: Any, low: complex, high: complex, gap: float, looks: dict[str, Any]) -> None:
    """Width and height of a part that is not round."""
    below, left = (low.real, low.imag - gap / 2), (low.real - gap / 2, low.imag)
    space.add_linear_dim(below, (low.real, low.imag), (high.real, low.imag), **looks).render()
    ends = (low.real, low.imag), (low.real, high.imag)
    space.add_linear_dim(left, *ends, angle=90, **looks).render()
