"""Materials of tubes by name, with the usual values of their alloys."""

from __future__ import annotations

from typing import NamedTuple

from equipoise.mechanism.balance import MATERIALS as DENSITIES


class Material(NamedTuple):
    """youngs_modulus : Pa.  density : kg/m3.  poisson_ratio : of it."""

    youngs_modulus: float
    density: float
    poisson_ratio: float


MATERIALS = {
    "aluminium": Material(70e9, DENSITIES["aluminium"], 0.33),
    "steel": Material(210e9, DENSITIES["steel"], 0.3),
    "titanium": Material(110e9, 4500.0, 0.34),
    "magnesium": Material(45e9, 1780.0, 0.35),
}


def material_of(given: Material) -> str:
    """Name of the material with these values, or nothing where there is none."""
    return next((name for name, values in MATERIALS.items() if values == given), "")
