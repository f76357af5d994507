"""The support of a machine as it is seen from the side: what holds it, and how it swings."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.mechanism.formulas.kernels import dot
from equipoise.mechanism.parts.machine import Machine
from equipoise.mechanism.parts.support import Gauge, Mount, Support, unit_vector
from equipoise.signals import Array
from equipoise.symbols.shapes import PIN, PISTON, Shape, circle, hatching, hull, sign

MOUNT = 40.0, 7.0
"""Length of a spring or damper between support and ground, and half its width."""
NEEDLE = 32.0
"""Length of a gauge's arrow."""
VISIBLE = 0.3
"""Length of the view of a unit vector below which it is seen end on."""
RING = 22.0, 10.0
"""Radius of the first arc about an axis that is seen end on, and how much larger others are."""
HALF = 1j * MOUNT[1] / MOUNT[0]
ALONG = np.concatenate([[0, 0.2], 0.2 + 0.6 * (np.arange(6) + 0.5) / 6, [0.8, 1]])
SPRING = (ALONG + HALF * np.array([0, 0, *([1, -1] * 3), 0, 0]),)
DAMPER = tuple(part.real + HALF * part.imag for part in PISTON)
"""Lines from 0 to 1, sides over the length: a zigzag; a piston in a cylinder open to the ground."""
ASIDE = 1.3 * HALF
"""How far a spring and a damper of one mount are from its line."""


@dataclass(frozen=True, eq=False)
class SupportSwing:
    """How a support moves in the plane of the drawing at N crank angles, larger than true.

    place : displacement of its reference, (N,) complex, m.  angle : (N,) rad.
    captions : what is to be said of it.
    """

    place: Array
    angle: Array
    captions: tuple[str, ...]


@dataclass(frozen=True)
class Carrier:
    """The support as it is seen from the side; places complex, m.

    corners : all places by which it is drawn.  center : its centre of mass.
    reference : the pivot or, where there is none, the centre of mass.
    """

    support: Support
    corners: tuple[complex, ...]
    center: complex
    reference: complex

    @property
    def items(self) -> dict[str, Mount | Gauge]:
        """Mounts, then gauges."""
        return {**self.support.mounts, **self.support.gauges}

    def named(self, items: Mapping[str, Mount] | Mapping[str, Gauge]) -> dict[complex, list[str]]:
        """Names of mounts or gauges by their places, of those that are seen from the side."""
        names: dict[complex, list[str]] = {}
        for name, item in items.items():
            if item.point is None and item.axis != "pitch":
                continue
            place = self.reference if item.point is None else complex(*item.point[:2])
            names.setdefault(place, []).append(name)
        return names

    @classmethod
    def of(cls, machine: Machine) -> Carrier | None:
        """That of a machine; None where it stands on solid ground."""
        support = machine.support
        if support is None:
            return None
        offsets = {complex(*row.offset) for row in machine.rows} or {0j}
        corners = [complex(*place) + by for place in machine.frame.values() for by in offsets]
        items: list[Mount | Gauge] = [*support.mounts.values(), *support.gauges.values()]
        corners += [complex(*item.point[:2]) for item in items if item.point is not None]
        center, reference = (complex(*z[:2]) for z in (support.center_of_mass, support.reference))
        around = hull(np.array([*corners, center, reference]))
        return cls(support, tuple(map(complex, around)), center, reference)

    def way(self, item: Mount | Gauge) -> complex:
        """Direction, 1 long, from a mount to its ground, or in which a gauge reads.

        0 of one that turns or is seen end on.
        """
        if item.point is None:
            return 0j
        place, along = (complex(*z[:2]) for z in (item.point, unit_vector(item.direction)))
        if isinstance(item, Gauge):
            return along / abs(along) if abs(along) >= VISIBLE else 0j
        return to_ground(along, place - self.center, item.one_sided)


# -- signs -----------------------------------------------------------------------------------------


def to_ground(along: complex, arm: complex, one_sided: bool) -> complex:
    """Direction, 1 long, in which a mount stands on the ground; 0 where it is seen end on.

    along : the view of the direction in which it pushes the support.  arm : from the middle of the
    support, from which one that goes along points away.
    """
    if abs(along) < VISIBLE:
        return 0j
    way = -along / abs(along)
    sideways = not one_sided and abs(way.imag) < 0.5
    return -way if sideways and dot(arm, way) < 0 else way


def strut(item: Mount, place: complex, way: complex) -> list[Shape]:
    """A spring, a damper or both beside each other, from a place of the support to the ground."""
    damped = bool(item.damping) or not item.stiffness
    lines = [*SPRING] * bool(item.stiffness) + [*DAMPER] * damped
    if item.stiffness and damped:
        lines = [line - ASIDE for line in SPRING] + [line + ASIDE for line in DAMPER]
        lines.append(np.array([-ASIDE, ASIDE]))
    return [sign("mount", place, MOUNT[0] * way * line) for line in lines]


def ground(place: complex, way: complex) -> list[Shape]:
    """What a strut from a place stands on."""
    start, end = (MOUNT[0] * way + 16j * way * side for side in (-1, 1))
    return [*hatching(place, start, end, way), sign("rail", place, [start, end])]


def foot(place: complex, way: complex, one_sided: bool) -> list[Shape]:
    """Where a mount holds the support; way : to its ground."""
    if not way:
        return [circle("float", place, grown=5.0), circle("dot", place, grown=1.5)]
    return [circle("float" if one_sided else "foot", place, grown=PIN)]


def mount(item: Mount, place: complex, way: complex) -> list[Shape]:
    """A mount at rest; way : to its ground, 0 where it is seen end on."""
    shapes = foot(place, way, item.one_sided)
    if not way:
        return shapes
    return [*strut(item, place, way), *ground(place, way), *shapes]


def gauge(place: complex, way: complex) -> list[Shape]:
    """A gauge: a diamond with an arrow in its direction, the view of which is at most 1 long."""
    diamond = sign("gauge", place, 5.5 * np.array([1, 1j, -1, -1j]), closed=True)
    if abs(way) < VISIBLE:
        return [diamond]
    way /= abs(way)
    head = sign("needle-head", place, way * (NEEDLE + np.array([0, -8 + 3j, -8 - 3j])), closed=True)
    return [sign("needle", place, [0, way * (NEEDLE - 6)]), head, diamond]


def turning(place: complex, ring: int, of_gauge: bool) -> list[Shape]:
    """An arc with a head about an axis that is seen end on, the first or one outside of it."""
    radius = RING[0] + RING[1] * ring
    arc = radius * np.exp(1j * np.radians(np.linspace(-60, 195, 40)))
    way = 1j * arc[-1] / abs(arc[-1])
    role = "needle" if of_gauge else "mount"
    head = arc[-1] + way * 8 * np.array([1, 0.38j, -0.38j])
    tip = "needle-head" if of_gauge else "foot"
    return [sign(role, place, arc), sign(tip, place, head, closed=True)]
