"""Materials by their names, and the keys of tables that give either a material or a density."""

from __future__ import annotations

from typing import Any

from equipoise.errors import ModelError
from equipoise.i18n import to_say
from equipoise.keys import Key, Text

MATERIALS = {
    to_say("steel"): 7850.0,
    to_say("cast iron"): 7200.0,
    to_say("brass"): 8500.0,
    to_say("lead"): 11340.0,
    to_say("tungsten alloy"): 17500.0,
    to_say("aluminium"): 2700.0,
}
"""Densities, kg/m3."""


def material_of(density: float) -> str:
    """Name of the material of a density (kg/m3), or nothing where there is none."""
    return next((name for name, value in MATERIALS.items() if value == density), "")


def with_density(given: dict[str, Any], prefix: str = "") -> dict[str, Any]:
    """The values of a table with the density (kg/m3) of what it gives by name or by number."""
    material = given.pop(f"{prefix}material", None)
    if material is None:
        return given
    if f"{prefix}density" in given:
        raise ModelError("", f"give either {prefix}material or {prefix}density")
    if material not in MATERIALS:
        shown = material if len(material) <= 60 else f"{material[:57]}..."
        raise ModelError(
            f"{prefix}material",
            f"no material is called {shown!r}; there are {', '.join(map(repr, MATERIALS))}, or "
            f"give {prefix}density",
        )
    return {**given, f"{prefix}density": MATERIALS[material]}


def with_material(table: dict[str, Any], prefix: str = "") -> dict[str, Any]:
    """A table with the name of a material instead of its density, where it has one."""
    if name := material_of(table.get(f"{prefix}density", 0.0)):
        del table[f"{prefix}density"]
        table[f"{prefix}material"] = name
    return table


def material_key(prefix: str, text: str) -> dict[str, Key]:
    """The key of a material beside that of a density."""
    kind = Text(suggested=(*MATERIALS,))
    name = f"{prefix}material"
    return {name: Key(name, kind, text, default=None, example="steel")}
