"""A machine as one turning mass: reduced inertia of the crank, and generalized forces on it.

With q the crank angle, a prime for the derivative by it, and p and alpha the place of a link's
centre of mass and its angle, the equation of motion (Eksergian's) is

    J q.. + J' q.^2 / 2 = Q,    J = sum m |p'|^2 + I alpha'^2

and Q is the power of everything that acts, at a crank speed of 1 rad/s.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from equipoise.mechanism.assembly.steps import Array, p, u
from equipoise.mechanism.dynamics.reactions import Demand
from equipoise.mechanism.formulas.kernels import dot
from equipoise.mechanism.kinematics.motion import Motion


def reduced_inertia(motion: Motion) -> tuple[Array, Array]:
    """J and J' (N,) of the links, kg m2, at the crank angles of a motion."""
    inertia, slope = np.zeros((2, len(motion.crank_angle)))
    for name, link in motion.machine.links.items():
        center = motion.mass_centers[name]
        _, w, a = (motion.state[key] for key in u(name))
        mass, own = link.mass, link.inertia
        inertia = inertia + mass * dot(center.place_1, center.place_1) + own * w**2
        slope = slope + 2 * (mass * dot(center.place_1, center.place_2) + own * w * a)
    return inertia, slope


def generalized_force(motion: Motion, demands: Mapping[str, Demand]) -> Array:
    """Generalized force (N,), N m, of what acts on links.

    demands : what would hold it, by link.
    """
    total: Array = np.zeros(len(motion.crank_angle))
    for link, (force, moment) in demands.items():
        anchor_1 = motion.state[p(motion.linkage.anchors[link])[1]]
        total = total - dot(anchor_1, force) - motion.state[u(link)[1]] * moment
    return total


def generalized_size(motion: Motion, demands: Mapping[str, Demand]) -> float:
    """The generalized force, N m, if nothing in it cancelled: its measure of rounding.

    Horizontal strokes against weight, for example, leave nothing of it but rounding.
    """
    total: Array = np.zeros(len(motion.crank_angle))
    for link, (force, moment) in demands.items():
        anchor_1 = motion.state[p(motion.linkage.anchors[link])[1]]
        total = total + np.abs(anchor_1) * np.abs(force)
        total = total + np.abs(motion.state[u(link)[1]] * moment)
    return float(np.max(total, initial=0.0))
