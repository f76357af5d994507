"""Checks of the mass that may be added: its shape, its room, and what fits into it."""

from __future__ import annotations

from collections.abc import Iterator
from math import isfinite, pi, sqrt

from equipoise.errors import ModelError
from equipoise.mechanism.balance import CUT, HOLLOW, Weight, largest_mass, material_of

LARGEST_ROOM = 1000.0
"""m; far beyond any machine."""
ROUNDING = 1 + 1e-9
"""A mass that fills its room to this may have been computed from it."""


def wrong_weight(where: str, weight: Weight) -> Iterator[ModelError]:
    """Everything that is wrong with the mass that may be added at a place."""
    if isfinite(weight.radius) and weight.radius > LARGEST_ROOM:
        yield ModelError(
            f"{where}.radius",
            f"got {weight.radius:g} m; give at most {LARGEST_ROOM:g} m, or none for no limit",
        )
    yield from _wrong_plate(where, weight)
    yield from _wrong_inner_radius(where, weight)
    yield from _wrong_mass(where, weight)


def _wrong_plate(where: str, weight: Weight) -> Iterator[ModelError]:
    """Thickness and density, which what is cut from a plate has."""
    shape = f"a {weight.shape}"
    if weight.shape not in CUT:
        for key in ("thickness", "density"):
            if getattr(weight, key) is not None:
                yield ModelError(f"{where}.{key}", "goes with a disc, ring or sector; leave it out")
        return
    if not isfinite(weight.radius):
        yield ModelError(f"{where}.radius", f"missing; {shape} needs a room, give its radius")
    if weight.thickness is None:
        yield ModelError(
            f"{where}.thickness", f"missing; {shape} is cut from a plate, give its thickness"
        )
    if weight.density is None:
        yield ModelError(
            f"{where}.material",
            f'missing; {shape} is cut from a plate, give a material such as "steel", or a density',
        )


def _wrong_inner_radius(where: str, weight: Weight) -> Iterator[ModelError]:
    inner, key = weight.inner_radius, f"{where}.inner_radius"
    if inner and weight.shape not in HOLLOW:
        yield ModelError(key, f"goes with a ring or sector, got shape {weight.shape!r}")
    elif inner < 0:
        yield ModelError(key, f"got {inner:g} m; give 0 or more")
    elif inner >= weight.radius:
        yield ModelError(
            key,
            f"got {_length(inner)} in a room of {_length(weight.radius)}; give less than that",
        )


def _wrong_mass(where: str, weight: Weight) -> Iterator[ModelError]:
    if weight.mass is not None and weight.at_most is not None:
        yield ModelError(where, "give either mass or at_most")
    if weight.mass is None and not isfinite(weight.radius):
        yield ModelError(
            where,
            "nothing limits it; give the radius of its room, or its mass",
        )
    cut = weight.shape in CUT and None not in (weight.thickness, weight.density)
    if cut and weight.mass is not None and weight.mass > largest_mass(weight) * ROUNDING:
        yield ModelError(f"{where}.mass", _too_large(weight, weight.mass))


def _too_large(weight: Weight, mass: float) -> str:
    """Say how much room a mass (kg) cut from a plate would need."""
    assert weight.thickness is not None and weight.density is not None
    inner = weight.inner_radius if weight.shape in HOLLOW else 0.0
    radius = sqrt(mass / (weight.thickness * weight.density * pi) + inner**2)
    stuff = material_of(weight.density) or f"of {weight.density:.5g} kg/m^3"
    goes = {
        "disc": "has a radius of",
        "ring": "has an outer radius of",
        "sector": "needs, even as a full ring, a radius of",
    }
    return (
        f"a {weight.shape} of {1e3 * mass:.5g} g and {_length(weight.thickness)} {stuff} "
        f"{goes[weight.shape]} {_length(radius)} and does not fit into its room of "
        f"{_length(weight.radius)}; make it thicker, or the room larger"
    )


def _length(value: float) -> str:
    return f"{1e3 * value:.5g} mm"
