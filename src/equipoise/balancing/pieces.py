"""From the mass, first moment and inertia of a weight to pieces that can be cut and screwed on."""

from __future__ import annotations

from cmath import exp, phase, rect
from math import acos, pi, sin, sqrt
from typing import Any

from equipoise.mechanism.balance import Weight

Piece = dict[str, Any]

NOTHING = 1e-9
"""kg: less than this is no piece."""
SPREAD = 1e-7
"""Over the squared distance: inertia beyond that of one point that is taken for rounding."""


def pieces_of(
    weight: Weight, mass: float, moment: complex, inertia: float, center: complex
) -> list[Piece]:
    """Pieces whose masses, places and inertia add up to what was found; SI units and radians.

    Parameters
    ----------
    mass, moment, inertia : kg, kg m and kg m2, the last two about the centre of the room.
    center : of the room in the link's axes, m.  Places are in the link's axes too.
    """
    if mass < NOTHING:
        return []
    if weight.shape == "ring":
        return [_ring(weight, mass, center)]
    if weight.shape == "sector":
        return _sectors(weight, mass, moment, center)
    if weight.shape == "disc":
        return [_disc(weight, mass, moment / mass, center)]
    return _points(mass, moment / mass, inertia, center)


def _points(mass: float, place: complex, inertia: float, center: complex) -> list[Piece]:
    """One point, or two of equal mass on a line across the direction of their middle.

    Two points at place +- d, with d across place, have the inertia m (|place|^2 + d^2).
    """
    beyond = inertia / mass - abs(place) ** 2
    if beyond <= SPREAD * max(inertia / mass, abs(place) ** 2):
        return [_piece("point", mass, place, center)]
    across = 1j * exp(1j * phase(place)) * sqrt(beyond)
    return [_piece("point", mass / 2, place + sign * across, center) for sign in (1, -1)]


def _disc(weight: Weight, mass: float, place: complex, center: complex) -> Piece:
    assert weight.thickness is not None and weight.density is not None
    radius = sqrt(mass / (pi * weight.thickness * weight.density))
    return _piece("disc", mass, place, center) | {"radius": radius, "thickness": weight.thickness}


def _ring(weight: Weight, mass: float, center: complex) -> Piece:
    assert weight.thickness is not None and weight.density is not None
    outer = sqrt(weight.inner_radius**2 + mass / (pi * weight.thickness * weight.density))
    sizes = {"outer_radius": outer, "inner_radius": weight.inner_radius}
    return _piece("ring", mass, 0j, center) | sizes | {"thickness": weight.thickness}


def _sectors(weight: Weight, mass: float, moment: complex, center: complex) -> list[Piece]:
    """One sector; or two equal ones apart, where one would throw farther than is wanted.

    A sector of half angle b has the moment c sin b; two of half angle b / 2 at +- g from their
    middle have 2 c sin(b / 2) cos g.
    """
    assert weight.thickness is not None and weight.density is not None
    plate = weight.thickness * weight.density
    outer, inner = weight.radius, weight.inner_radius
    half = min(mass / (plate * (outer**2 - inner**2)), pi)
    most = 2 / 3 * plate * (outer**3 - inner**3)
    direction = phase(moment) if moment else 0.0
    if abs(moment) >= most * sin(half) * (1 - SPREAD) - 1e-15:
        return [_sector(weight, mass, half, direction, center)]
    aside = acos(min(1.0, abs(moment) / (2 * most * sin(half / 2))))
    return [_sector(weight, mass / 2, half / 2, direction + s * aside, center) for s in (1, -1)]


def _sector(weight: Weight, mass: float, half: float, direction: float, center: complex) -> Piece:
    outer, inner = weight.radius, weight.inner_radius
    distance = 2 / 3 * sin(half) / half * (outer**3 - inner**3) / (outer**2 - inner**2)
    sizes = {
        "outer_radius": outer,
        "inner_radius": inner,
        "angle": 2 * half,
        "direction": phase(rect(1.0, direction)),
        "thickness": weight.thickness,
    }
    return _piece("sector", mass, rect(distance, direction), center) | sizes


def _piece(shape: str, mass: float, place: complex, center: complex) -> Piece:
    """A piece whose centre of mass is at a place from the centre of its room."""
    there = center + place
    return {"shape": shape, "mass": mass, "place": (there.real, there.imag)}
