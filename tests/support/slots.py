"""Pins in slots, as Newton's method on all constraints and free bodies have them."""

from __future__ import annotations

from typing import Any

import numpy as np

from equipoise.mechanism.parts.circular_slots import CircularSlot
from equipoise.mechanism.parts.machine import Machine
from support.poses import Array, Poses


def on_circle(slot: CircularSlot, pin: Any, center: Any, rate: Array) -> tuple[Any, Any, Any]:
    """Residual, Jacobian and bend of: the pin stays at the radius from the centre.

    pin, center : place, Jacobian and centripetal acceleration of each.
    """
    apart, jacobian = pin.residual - center.residual, pin.jacobian - center.jacobian
    drift = jacobian @ rate
    bend = drift @ drift + apart @ (pin.bend - center.bend)
    off = apart @ apart - slot.radius**2
    return off / (2 * slot.radius), apart @ jacobian / slot.radius, -bend / slot.radius


def normal_of(slot: CircularSlot, machine: Machine, poses: Poses) -> Array:
    """Unit vectors (N, 2) across the slot at the pin, away from its centre."""
    pin, center = (poses.place(body, machine.points_of(body)[point])
                   for body, point in slot.points)  # fmt: skip
    way = pin - center
    return np.asarray(way / np.linalg.norm(way, axis=-1, keepdims=True))
