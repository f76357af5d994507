"""Cross-sections of a tool's shaft as pydantic models; see `document_tool`."""

from __future__ import annotations

from typing import Any

from pydantic import ConfigDict, Field, JsonValue

from equipoise.errors import ModelError
from equipoise.handheld import shaft
from equipoise.mechanism.checks import unknown
from equipoise.schema.fields import BendingStiffness, Density, Length, MassPerLength, Modulus, Table
from equipoise.schema.tube_materials import MATERIALS, Material

OF_MATERIAL = ("youngs_modulus", "density", "poisson_ratio")
OF_TUBE = ("outer_diameter", "inner_diameter", "material", *OF_MATERIAL, "carried")
OF_SECTION = ("bending_stiffness", "mass_per_length", "mass")
EITHER = "give either bending_stiffness and mass_per_length, or outer_diameter and material"


def section_keys(*masses: str) -> ConfigDict:
    """JSON Schema of a table with the keys of a section; `masses` are those that tell its mass."""
    by_stiffness: dict[str, JsonValue] = {
        "required": ["bending_stiffness"],
        "properties": dict.fromkeys(OF_TUBE, False),
        "oneOf": [{"required": [mass]} for mass in masses],
    }
    by_measures: dict[str, JsonValue] = {
        "required": ["outer_diameter"],
        "properties": dict.fromkeys(("bending_stiffness", *masses), False),
        "oneOf": [
            {"required": ["material"], "properties": dict.fromkeys(OF_MATERIAL, False)},
            {"required": ["youngs_modulus", "density"], "properties": {"material": False}},
        ],
    }
    return ConfigDict(json_schema_extra={"oneOf": [by_stiffness, by_measures]})


class Profile(Table):
    """A cross-section: by its stiffness and mass, or by the measures of a tube."""

    bending_stiffness: BendingStiffness | None = Field(
        None, description="modulus of elasticity times second moment of area"
    )
    mass_per_length: MassPerLength | None = Field(None, description="goes with bending_stiffness")
    outer_diameter: Length | None = Field(
        None, description="of a tube, instead of bending_stiffness", examples=["26 mm"]
    )
    inner_diameter: Length = Field(
        0.0, description="of a tube", json_schema_extra={"default": "0 mm"}
    )
    material: str | None = Field(
        None,
        description="of a tube",
        examples=["aluminium"],
        json_schema_extra={"enum": list[Any](MATERIALS)},
    )
    youngs_modulus: Modulus | None = Field(
        None, description="modulus of elasticity of a tube, instead of material"
    )
    density: Density | None = Field(None, description="goes with youngs_modulus")
    poisson_ratio: float | None = Field(
        None,
        description="goes with youngs_modulus",
        json_schema_extra={"default": shaft.Tube.poisson_ratio},
    )
    carried: MassPerLength = Field(
        0.0,
        description="of what runs in a tube and does not stiffen it",
        json_schema_extra={"default": "0 kg/m"},
    )

    def to_profile(self, where: str, linear: float | None = None) -> shaft.Section | shaft.Tube:
        """Return the section; `linear` is its mass per length (kg/m) where that follows from more.

        Raises
        ------
        ModelError : keys are missing, or do not go together.
        """
        given = self.model_fields_set
        if self.bending_stiffness is None:
            return self._to_tube(where)
        for key in OF_TUBE:
            if key in given:
                raise ModelError(
                    f"{where}.{key}", "has no place beside bending_stiffness; leave it out"
                )
        mass_per_length = self.mass_per_length if linear is None else linear
        if mass_per_length is None:
            raise ModelError(
                f"{where}.mass_per_length", "missing; give it together with bending_stiffness"
            )
        return shaft.Section(self.bending_stiffness, mass_per_length)

    def _to_tube(self, where: str) -> shaft.Tube:
        if self.outer_diameter is None:
            raise ModelError(where, EITHER)
        for key in OF_SECTION:
            if key in self.model_fields_set:
                raise ModelError(
                    f"{where}.{key}", "has no place beside outer_diameter; carried adds to a tube"
                )
        material = self._material(where)
        return shaft.Tube(self.outer_diameter, self.inner_diameter, *material, carried=self.carried)

    def _material(self, where: str) -> Material:
        given = [key for key in OF_MATERIAL if key in self.model_fields_set]
        if self.material is None:
            if self.youngs_modulus is None and self.density is None:
                raise ModelError(
                    f"{where}.material",
                    'missing; give one such as "aluminium", or youngs_modulus and density',
                )
            if self.youngs_modulus is None or self.density is None:
                missing = "density" if self.density is None else "youngs_modulus"
                raise ModelError(f"{where}.{missing}", f"missing; give it together with {given[0]}")
            ratio = self.poisson_ratio
            return Material(
                self.youngs_modulus,
                self.density,
                shaft.Tube.poisson_ratio if ratio is None else ratio,
            )
        if given:
            raise ModelError(
                f"{where}.{given[0]}", "has no place beside material; give one of both"
            )
        if self.material not in MATERIALS:
            sentence = unknown(self.material, MATERIALS, "material")
            others = "youngs_modulus and density stand for any other"
            raise ModelError(f"{where}.material", f"{sentence} ({others})")
        return MATERIALS[self.material]
