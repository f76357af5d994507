"""Pins in slots, as Newton's method on all constraints and free bodies have them.

Curved slots are SciPy's splines here, of which only the points and the chords between them are what
the package has.
"""

from __future__ import annotations

from functools import lru_cache
from typing import Any

import numpy as np
from scipy.interpolate import make_interp_spline
from scipy.optimize import minimize_scalar

from equipoise.mechanism.parts.circular_slots import CircularSlot
from equipoise.mechanism.parts.curved_slots import CurvedSlot
from equipoise.mechanism.parts.machine import FRAME, Machine
from support.poses import Array, Poses, quarter, turned


def on_circle(slot: CircularSlot, pin: Any, center: Any, rate: Array) -> tuple[Any, Any, Any]:
    """Residual, Jacobian and bend of: the pin stays at the radius from the centre.

    pin, center : place, Jacobian and centripetal acceleration of each.
    """
    apart, jacobian = pin.residual - center.residual, pin.jacobian - center.jacobian
    drift = jacobian @ rate
    bend = drift @ drift + apart @ (pin.bend - center.bend)
    off = apart @ apart - slot.radius**2
    return off / (2 * slot.radius), apart @ jacobian / slot.radius, -bend / slot.radius


@lru_cache(16)
def spline_of(points: tuple[tuple[float, float], ...], closed: bool) -> Any:
    """The quintic spline of a curved slot over the length of its chords."""
    places = np.array([*points, points[0]] if closed else points)
    chords = np.append(0.0, np.cumsum(np.hypot(*np.diff(places, axis=0).T)))
    degree = min(5, len(places) - 1)
    kind = {"bc_type": "periodic"} if closed else {}
    return make_interp_spline(chords, places, degree, **kind)


def foot(slot: CurvedSlot, place: Array) -> tuple[Array, Array, float]:
    """Nearest place on the slot's curve to a place in its axes, unit normal to the left of the way
    there, and the curvature.
    """
    curve = spline_of(slot.places, slot.closed)
    low, high = curve.t[0], curve.t[-1]
    s = np.linspace(low, high, 4001)
    away = np.hypot(*(curve(s) - place).T)
    at, wide = s[int(np.argmin(away))], s[1] - s[0]
    result = minimize_scalar(lambda x: float(np.sum((curve(x) - place) ** 2)),
                            bounds=(at - wide, at + wide), method="bounded",
                            options={"xatol": 1e-9})  # fmt: skip
    at = float(result.x)
    for _ in range(4):  # to rounding
        way, first, second = curve(at) - place, curve(at, 1), curve(at, 2)
        at -= float(way @ first / (first @ first + way @ second))
    first, second = curve(at, 1), curve(at, 2)
    size = float(np.hypot(*first))
    bend = (first[0] * second[1] - first[1] * second[0]) / size**3
    return curve(at), quarter(first / size), float(bend)


def on_curve(
    slot: CurvedSlot, pin: Any, origin: Any, rate: Array, turning: tuple[float, float, int | None]
) -> tuple[Any, Any, Any]:
    """Residual, Jacobian and bend of: the pin is no distance to the left of the curve.

    turning : angle of the body that has the slot, its angular velocity, and the column of that.
    """
    angle, spin, column = turning
    lean = angle + slot.direction
    apart, jacobian = pin.residual - origin.residual, pin.jacobian - origin.jacobian
    there, normal, curvature = foot(slot, turned(-lean, apart))
    across, along = turned(lean, normal), turned(lean, -quarter(normal))
    line = across @ jacobian
    if column is not None:
        line[column] -= across @ quarter(apart)
    drift = jacobian @ rate
    slip = along @ (drift - spin * quarter(apart))
    bend = across @ (pin.bend - origin.bend) - 2 * spin * (across @ quarter(drift))
    bend -= spin**2 * (across @ apart) + curvature * slip**2
    return across @ (apart - turned(lean, there)), line, -bend


def normal_of(slot: CircularSlot | CurvedSlot, machine: Machine, poses: Poses) -> Array:
    """Unit vectors (N, 2) across the slot at the pin, away from a centre or to the left."""
    pin, center = (poses.place(body, machine.points_of(body)[point])
                   for body, point in slot.points)  # fmt: skip
    way = pin - center
    if isinstance(slot, CurvedSlot):
        on = np.zeros(len(way)) if slot.on == FRAME else poses.angle[slot.on]
        lean = on + slot.direction
        return np.array([turned(a, foot(slot, turned(-a, item))[1])
                         for a, item in zip(lean, way, strict=True)])  # fmt: skip
    return np.asarray(way / np.linalg.norm(way, axis=-1, keepdims=True))
