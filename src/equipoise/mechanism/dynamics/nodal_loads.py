"""Loads of a link as forces and couples at nodes along its line, as finite elements take them.

Whatever acts between two nodes, and weight and inertia of the mass spread along the line, goes to
both by linear shape functions: with the same sum, and the same moment about any point.  So the
bending moment at a node is that of the link cut there, and the forces in an element are the mean of
those along it.
"""

from __future__ import annotations

from itertools import pairwise
from typing import NamedTuple

import numpy as np

from equipoise.mechanism.assembly.steps import Array
from equipoise.mechanism.dynamics.section_loads import SectionLoads

ELEMENTS = 40
"""Along a link, about, beside places of joints and loads, which are nodes too."""
STUBBY = 0.5
"""Least length of these elements over the height of the section: where programs make solids of
them, a force on a short one would dent it."""
SAME_NODE = 1e-6
"""Share of the length of a link within which two places are one node."""


class NodalLoads(NamedTuple):
    """Loads at nodes (P,) of a link at one crank angle, in the axes of its line.

    force : complex, N, along the line and to the left of it.  couple : N m, counterclockwise.
    """

    force: Array
    couple: Array


def nodes_along(loads: SectionLoads, angle: int | None = None) -> Array:
    """Places (P,) of nodes from the first point of a link, rising, m.

    angle : number of the crank angle; None for nodes where something acts at all crank angles.
    """
    length = loads.length
    marks = [0.0]
    places = [at[angle or 0] for at, _, _ in loads.ends if angle is not None or np.ptp(at) == 0]
    for place in sorted([*map(float, places), length]):
        if place - marks[-1] > SAME_NODE * length:
            marks.append(place)
    marks[-1] = length
    size = max(length / ELEMENTS, STUBBY * 2 * loads.section.outermost)
    parts = [np.linspace(a, b, max(round((b - a) / size), 1) + 1)[:-1] for a, b in pairwise(marks)]
    return np.concatenate([*parts, [length]])


def nodal_loads(loads: SectionLoads, nodes: Array, angle: int) -> NodalLoads:
    """Loads at nodes (P,) along a link, at the crank angle of a number."""
    force, couple = np.zeros(len(nodes), complex), np.zeros(len(nodes))
    for places, forces, torques in loads.ends:
        after = int(np.clip(np.searchsorted(nodes, places[angle]), 1, len(nodes) - 1))
        share = (places[angle] - nodes[after - 1]) / (nodes[after] - nodes[after - 1])
        for node, weight in ((after - 1, 1 - share), (after, share)):
            force[node] += weight * forces[angle]
            couple[node] += weight * torques[angle]
    q, k = (part[angle] for part in loads.field)
    spread = loads.mass.rod / loads.length * (q + k * nodes)
    cells = np.diff(nodes)
    first = cells * (2 * spread[:-1] + spread[1:]) / 6
    last = cells * (spread[:-1] + 2 * spread[1:]) / 6
    for own, where in ((first, slice(None, -1)), (last, slice(1, None))):
        force[where] += own
        couple[where] -= loads.mass.aside * own.real  # it acts beside the line
    return NodalLoads(force, couple)
