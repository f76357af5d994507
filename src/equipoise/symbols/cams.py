"""Surfaces of cams, and the rollers and faces that ride on them."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from equipoise.mechanism.assembly.cam_fits import Fit, fits_of, sharpest
from equipoise.mechanism.assembly.cam_shapes import Shape
from equipoise.mechanism.assembly.joints import Structure
from equipoise.mechanism.formulas.kernels import cross
from equipoise.mechanism.parts.machine import Machine
from equipoise.symbols.shapes import Array, Mark, circle, line

CORNERS = 360
"""Of a cam's surface."""
RIB = 0.12
"""Thickness of a rib as it is drawn, over the base radius; sharp cams have thinner ones."""
BEYOND = 0.15
"""How much farther a flat face reaches than the cam touches it, over the base radius."""


def cams_of(machine: Machine, joints: Structure) -> Iterator[Mark]:
    """Every cam, then what rides on each; a knife's edge is a point, and has a sign already."""
    turn = np.linspace(0.0, 2 * np.pi, CORNERS, endpoint=False)
    cut = [(fit, fit.shape(turn)) for fit in fits_of(machine, joints)]
    for fit, shape in cut:
        cam = fit.cam
        flanks = {"cam": shape.surface}
        if cam.closed_by == "groove":
            flanks = {"groove": shape.beside(2 * shape.radius), **flanks}
        for role, flank in flanks.items():
            around = line(role, *flank, closed=True)
            yield Mark(cam.driver, fit.cam_pin, around, (cam.table, cam.name))
        if cam.closed_by == "ribs":
            inside = -min(RIB * cam.base_radius, sharpest(fit)[0] / 2)
            rib = line("rib", *shape.beside(inside), closed=True)
            yield Mark(cam.driver, fit.cam_pin, rib)
    for fit, shape in cut:
        if fit.cam.rides == "roller":
            roller = circle("rider", 0j, fit.cam.roller_radius)
            yield Mark(fit.cam.driven, fit.cam.point, roller)
        elif fit.cam.rides == "flat":
            yield Mark(fit.cam.driven, fit.cam.point, line("face", *_face(fit, shape)))


def _face(fit: Fit, shape: Shape) -> Array:
    """Both ends of a flat face, from its point and in the follower's axes, m."""
    along = cross(shape.ride.normal, shape.contact[0] - shape.ride.place)
    beyond = BEYOND * fit.cam.base_radius
    ends = np.array([np.min(along) - beyond, np.max(along) + beyond])
    return np.asarray(1j * fit.face * ends)
