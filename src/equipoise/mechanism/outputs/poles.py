"""Instant centres of every pair of bodies, and mechanical advantage, at each crank angle.

Where there is none, for it lies at infinity, or has no bound, values are NaN.
"""

from __future__ import annotations

from itertools import combinations
from typing import TYPE_CHECKING, Any

from equipoise.mechanism.checks import FRAME, bodies_at

if TYPE_CHECKING:
    from equipoise.signals import Array

PARALLEL = 1e-12
"""Difference of two rates of turning, over the larger of them and the crank's, below which bodies
only slide along each other; rate over the largest of the cycle below which something stands."""


def pairs(machine: Any) -> dict[str, tuple[str, str]]:
    """Pairs of bodies by name, such as ``coupler/frame``; not those that a guide keeps parallel."""
    parallel = {frozenset((slider.link, slider.on)) for slider in machine.sliders}
    both = combinations((*machine.links, FRAME), 2)
    return {"/".join(pair): pair for pair in both if frozenset(pair) not in parallel}


def pinned(machine: Any) -> list[str]:
    """Links other than the drive that turn about a pin in the frame."""
    met = [bodies for bodies in bodies_at(machine.bodies).values() if FRAME in bodies]
    on_frame = {body for bodies in met for body in bodies} - {machine.drive.link}
    return [link for link in machine.links if link in on_frame]


def guided(machine: Any) -> list[str]:
    """Names of sliders on the frame."""
    return [slider.name for slider in machine.sliders if FRAME in (slider.link, slider.on)]


def instant_center(motion: Any, pair: str) -> Array:
    """Place in the frame, m, complex (N,), at which both bodies of a pair have one velocity.

    That of two bodies that share a pin is there, even while they turn alike.
    """
    import numpy as np  # here, so that a file is read without it

    item, other = pairs(motion.machine)[pair]
    bodies = motion.machine.bodies
    if shared := [point for point in bodies[item] if point in bodies[other]]:
        place: Array = motion.points[shared[0]].place
        return place
    (v, w), (o, r) = _carried(motion, item), _carried(motion, other)
    apart = w - r
    least = PARALLEL * np.maximum(np.maximum(np.abs(w), np.abs(r)), 1.0)
    turning = np.abs(apart) > least
    center = -1j * (o - v) / np.where(turning, apart, 1.0)
    return np.where(turning, center, complex(np.nan, np.nan))


def _carried(motion: Any, body: str) -> tuple[Array, Array]:
    """Velocity by crank angle of a body's point at the frame's origin, and how the body turns."""
    import numpy as np

    if body == FRAME:
        return np.zeros(len(motion.crank_angle), complex), np.zeros(len(motion.crank_angle))
    anchor = motion.points[motion.linkage.anchors[body]]
    w = motion.links[body].angle_1
    return anchor.place_1 - 1j * w * anchor.place, w


def advantage(rate: Array) -> Array:
    """Force or torque of an output over the torque of the crank (N,), by virtual power.

    rate : derivative of its place by crank angle, m or 1.
    """
    import numpy as np

    moves = np.abs(rate) > PARALLEL * np.max(np.abs(rate), initial=0.0)
    return np.where(moves, 1 / np.where(moves, rate, 1.0), np.nan)
