"""Surfaces of cams, and the rollers and faces that ride on them."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from equipoise.mechanism.assembly.cam_shapes import CamFit, CamShape, fitted, sharpest
from equipoise.mechanism.assembly.joints import Structure
from equipoise.mechanism.formulas.kernels import cross
from equipoise.mechanism.parts.cams import Cam
from equipoise.signals import Array
from equipoise.symbols.part_signs import DraggedCircle, Surroundings
from equipoise.symbols.shapes import BodyMark, circle, line

CORNERS = 360
"""Of a cam's surface."""
RIB = 0.12
"""Thickness of a rib as it is drawn, over the base radius; sharp cams have thinner ones."""
BEYOND = 0.15
"""How much farther a flat face reaches than the cam touches it, over the base radius."""


def cam_sign(cam: Cam, around: Surroundings) -> Iterator[BodyMark]:
    """A cam and what rides on it; a knife's edge is a point, and has a sign already."""
    fit = fitted(around.machine(), around.joints, cam)
    shape = fit.shape(np.linspace(0.0, 2 * np.pi, CORNERS, endpoint=False))
    flanks = {"cam": shape.surface}
    if cam.closed_by == "groove":
        flanks = {"groove": shape.offset_curve(2 * shape.radius), **flanks}
    for role, flank in flanks.items():
        yield BodyMark(
            cam.driver, fit.cam_pin, line(role, *flank, closed=True), (cam.list_name, cam.name)
        )
    if cam.closed_by == "ribs":
        inside = -min(RIB * cam.base_radius, sharpest(fit)[0] / 2)
        yield BodyMark(
            cam.driver, fit.cam_pin, line("rib", *shape.offset_curve(inside), closed=True)
        )
    if cam.rides == "roller":
        yield BodyMark(cam.driven, cam.point, circle("rider", 0j, cam.roller_radius))
    elif cam.rides == "flat":
        yield BodyMark(cam.driven, cam.point, line("face", *_face(fit, shape)))


def base_circle(cam: Cam, joints: Structure) -> DraggedCircle:
    """The circle by which the base radius is dragged."""
    axis = joints.pins_between(cam.driver, cam.carrier)[0]
    return DraggedCircle(cam.name, "base_radius", axis, cam.point)


def _face(fit: CamFit, shape: CamShape) -> Array:
    """Both ends of a flat face, from its point and in the follower's axes, m."""
    along = cross(shape.ride.normal, shape.contact[0] - shape.ride.place)
    beyond = BEYOND * fit.cam.base_radius
    ends = np.array([np.min(along) - beyond, np.max(along) + beyond])
    return np.asarray(1j * fit.face * ends)
