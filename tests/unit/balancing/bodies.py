"""Moments of real bodies by numerical integration, and random weights of every shape."""

from __future__ import annotations

from math import pi, sqrt
from typing import Any

import numpy as np

from equipoise.balancing.design_variables import AddedWeight
from equipoise.mechanism.parts.balance import Weight, WeightShape
from equipoise.mechanism.parts.machine import Machine
from unit.mechanism.build import crank_rocker

Array = np.ndarray[Any, Any]

PLATE = {"thickness": 0.008, "density": 7850.0}
ROOMS: dict[WeightShape, Weight] = {
    "any": Weight("any", 0.06, at_most=0.7),
    "point": Weight("point", 0.06, at_most=0.7),
    "disc": Weight("disc", 0.06, **PLATE),
    "ring": Weight("ring", 0.06, 0.015, **PLATE),
    "sector": Weight("sector", 0.06, 0.015, **PLATE),
}
RADII, TURNS = np.polynomial.legendre.leggauss(6), np.polynomial.legendre.leggauss(40)
"""Nodes and weights in radius, which are exact, and in angle, which are so to rounding."""


def machine_with_a_room() -> Machine:
    """A crank-rocker whose crank has a point R off its axes' origin."""
    machine = crank_rocker()
    return machine.with_link("crank", points={**machine.links["crank"].points, "R": (0.11, -0.07)})


def part_of(weight: Weight, at: str = "R") -> AddedWeight:
    return AddedWeight(machine_with_a_room(), "crank", at, weight)


def area(center: complex, low: float, high: float, start: float, end: float) -> Array:
    """Mass 1 per area, first moments and inertia about the origin of a part of a ring."""
    r = low + (RADII[0] + 1) / 2 * (high - low)
    turn = start + (TURNS[0] + 1) / 2 * (end - start)
    each = np.outer(RADII[1] / 2 * (high - low) * r, TURNS[1] / 2 * (end - start))
    place = center + np.outer(r, np.exp(1j * turn))
    first = np.sum(each * place)
    return np.array([np.sum(each), first.real, first.imag, np.sum(each * np.abs(place) ** 2)])


def moments_of(piece: dict[str, Any], center: complex) -> Array:
    """Mass, first moments and inertia about the link's origin; center is that of the room."""
    place = complex(*piece["place"])
    if piece["shape"] == "point":
        mass = piece["mass"]
        return mass * np.array([1.0, place.real, place.imag, abs(place) ** 2])
    plate = piece["thickness"] * PLATE["density"]
    if piece["shape"] == "disc":
        return plate * area(place, 0.0, piece["radius"], 0.0, 2 * pi)
    low, high = piece["inner_radius"], piece["outer_radius"]
    if piece["shape"] == "ring":
        return plate * area(place, low, high, 0.0, 2 * pi)
    start = piece["direction"] - piece["angle"] / 2
    actual = plate * area(center, low, high, start, start + piece["angle"])
    assert abs(complex(*actual[1:3]) / actual[0] - place) < 1e-9 * high
    return actual


def farthest(piece: dict[str, Any], center: complex) -> float:
    """Distance of the piece's outermost point from the centre of its room."""
    away = abs(complex(*piece["place"]) - center)
    if piece["shape"] == "point":
        return away
    if piece["shape"] == "disc":
        return away + float(piece["radius"])
    return float(piece["outer_radius"])


def random_numbers(part: AddedWeight, rng: np.random.Generator) -> tuple[Array, Array]:
    """Numbers of a body in the room, and its moments by integration or by sums."""
    weight, center = part.weight, part.center
    unit, reach = part.mass_unit, part.reach
    way = np.exp(1j * rng.uniform(-pi, pi))
    plate = PLATE["thickness"] * PLATE["density"]
    if weight.shape == "any":
        masses = rng.dirichlet(np.ones(5)) * rng.uniform(0.1, 0.7)
        there = weight.radius * np.sqrt(rng.random(5)) * np.exp(2j * pi * rng.random(5))
        m, s, i = np.sum(masses), np.sum(masses * there), np.sum(masses * np.abs(there) ** 2)
        numbers = [m / unit, s.real / unit / reach, s.imag / unit / reach, i / unit / reach**2]
        pieces = [{"shape": "point", "mass": x, "place": _pair(center + z)}
                  for x, z in zip(masses, there, strict=True)]  # fmt: skip
        return np.array(numbers), np.asarray(sum(moments_of(piece, center) for piece in pieces))
    if weight.shape == "ring":
        outer = rng.uniform(0.02, weight.radius)
        m = plate * pi * (outer**2 - weight.inner_radius**2)
        whole = plate * area(center, weight.inner_radius, outer, 0.0, 2 * pi)
        return np.array([m / unit, (m / unit) ** 2]), whole
    if weight.shape == "sector":
        half = rng.uniform(0.1, 3.0)
        start = np.angle(way) - half
        whole = plate * area(center, weight.inner_radius, weight.radius, start, start + 2 * half)
        s = complex(*whole[1:3]) - whole[0] * center
        return np.array([whole[0] / unit, s.real / unit / reach, s.imag / unit / reach]), whole
    radius = rng.uniform(0.005, 0.04) if weight.shape == "disc" else 0.0
    m = plate * pi * radius**2 if radius else rng.uniform(0.05, 0.7)
    place = (weight.radius - radius) * sqrt(rng.random()) * way
    y = m / unit * np.array([place.real, place.imag]) / reach
    numbers = [m / unit, *y, *(y**2 / (m / unit))]
    if radius:
        return np.array([*numbers, (m / unit) ** 2]), plate * area(
            center + place, 0.0, radius, 0.0, 2 * pi
        )
    piece = {"shape": "point", "mass": m, "place": _pair(center + place)}
    return np.array(numbers), moments_of(piece, center)


def _pair(place: complex) -> tuple[float, float]:
    return (place.real, place.imag)
