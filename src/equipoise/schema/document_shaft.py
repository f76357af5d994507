"""The table [shaft] of a tool's file, with its segments and stations, as pydantic models."""

from __future__ import annotations

from typing import Literal

from pydantic import ConfigDict, Field

from equipoise.errors import ModelError
from equipoise.handheld import model, shaft
from equipoise.handheld.model import NOTHING
from equipoise.schema.document_section import Profile, section_keys
from equipoise.schema.fields import Length, Mass, Table
from equipoise.schema.opening import Beside, impedance_keys, table_at
from equipoise.schema.planes import (
    Dampings,
    Files,
    Inertias,
    Stiffnesses,
    TorsionalDampings,
    TorsionalStiffnesses,
)

_PLANES = "; a table for unlike planes"


class Absorber(Table):
    """A mass on a spring and damper of its own."""

    mass: Mass = Field(description="of it", examples=["150 g"])
    stiffness: Stiffnesses = Field(
        description=f"between it and the shaft{_PLANES}", examples=["50 kN/m"]
    )
    damping: Dampings = Field(
        NOTHING,
        description=f"between it and the shaft{_PLANES}",
        json_schema_extra={"default": "0 N s/m"},
    )

    def to_absorber(self) -> model.Absorber:
        return model.Absorber(**dict(self))


class Hand(Table):
    """What one hand with its arm is to the tool: mass, spring and damper, or an impedance."""

    model_config = ConfigDict(
        json_schema_extra={
            "if": {"required": ["impedance"]},
            "then": {"properties": dict.fromkeys(("mass", "stiffness", "damping"), False)},
            "else": {"anyOf": [{"required": [key]} for key in ("mass", "stiffness", "damping")]},
        }
    )

    mass: Mass = Field(
        0.0, description="that moves with the tool", json_schema_extra={"default": "0 kg"}
    )
    stiffness: Stiffnesses = Field(
        NOTHING, description=f"to the body{_PLANES}", json_schema_extra={"default": "0 N/m"}
    )
    damping: Dampings = Field(
        NOTHING, description=f"to the body{_PLANES}", json_schema_extra={"default": "0 N s/m"}
    )
    impedance: Files | None = Field(
        None,
        description="CSV file beside this one, instead of these: frequency [Hz],resistance [N s/m],"
        "reactance [N s/m] or frequency [Hz],magnitude [N s/m],phase [deg]; a table for unlike "
        "planes",
        examples=["hand.csv"],
    )
    hands: Literal[1, 2] = Field(
        1, description="that hold on here", json_schema_extra={"default": 1}
    )

    def to_hand(self, where: str, reader: Beside) -> model.Hand:
        given = dict(self)
        files = self.impedance or ()
        read = (
            table_at(place, file, reader.impedance)
            for place, file in zip(impedance_keys(where, len(files)), files, strict=True)
        )
        given["impedance"] = tuple(table for table in read if table is not None)
        return model.Hand(**given)


class Harness(Table):
    """The belt that carries the tool."""

    stiffness: Stiffnesses = Field(description=f"to the body{_PLANES}", examples=["2 kN/m"])
    damping: Dampings = Field(
        NOTHING, description=f"to the body{_PLANES}", json_schema_extra={"default": "0 N s/m"}
    )

    def to_harness(self) -> model.Harness:
        return model.Harness(**dict(self))


class Station(Table):
    """A place of the shaft and what sits there."""

    name: str = Field(description="by which the other tables call it", examples=["engine"])
    position: Length = Field(description="from the left end of the shaft", examples=["0 mm"])
    mass: Mass = Field(0.0, description="of a rigid body", json_schema_extra={"default": "0 kg"})
    inertia: Inertias = Field(
        NOTHING,
        description=f"of it, about the axes across the shaft, through the shaft{_PLANES}",
        json_schema_extra={"default": "0 kg m^2"},
    )
    stiffness: Stiffnesses = Field(
        NOTHING, description=f"to the ground{_PLANES}", json_schema_extra={"default": "0 N/m"}
    )
    damping: Dampings = Field(
        NOTHING, description=f"to the ground{_PLANES}", json_schema_extra={"default": "0 N s/m"}
    )
    rotational_stiffness: TorsionalStiffnesses = Field(
        NOTHING,
        description=f"to the ground, against bending{_PLANES}",
        json_schema_extra={"default": "0 N m/rad"},
    )
    rotational_damping: TorsionalDampings = Field(
        NOTHING,
        description=f"to the ground, against bending{_PLANES}",
        json_schema_extra={"default": "0 N m s/rad"},
    )
    absorber: Absorber | None = None
    hand: Hand | None = None
    harness: Harness | None = None

    def to_station(self, where: str, reader: Beside) -> model.Station:
        given = dict(self)
        if self.absorber is not None:
            given["absorber"] = self.absorber.to_absorber()
        if self.hand is not None:
            given["hand"] = self.hand.to_hand(f"{where}.hand", reader)
        if self.harness is not None:
            given["harness"] = self.harness.to_harness()
        return model.Station(**given)


class Segment(Profile):
    """A part of the shaft with another section."""

    model_config = section_keys("mass_per_length")

    start: Length = Field(alias="from", description="where it begins", examples=["1.2 m"])
    stop: Length = Field(alias="to", description="where it ends", examples=["1.35 m"])

    def to_segment(self, where: str) -> shaft.Segment:
        return shaft.Segment(self.start, self.stop, self.to_profile(where))


class Shaft(Profile):
    """The shaft, free at both ends, with what sits on it and holds it."""

    model_config = section_keys("mass_per_length", "mass")

    length: Length = Field(description="from end to end", examples=["1.5 m"])
    mass: Mass | None = Field(
        None, description="of the whole shaft, instead of mass_per_length; without segments"
    )
    loss_factor: float = Field(
        0.0,
        description="of its material: the bending stiffness times 1 + i loss_factor counts",
        json_schema_extra={"default": 0, "minimum": 0, "exclusiveMaximum": 1},
    )
    theory: Literal["euler-bernoulli", "timoshenko"] = Field(
        "euler-bernoulli",
        description="timoshenko: with shear and rotary inertia; needs the measures of tubes",
        json_schema_extra={"default": "euler-bernoulli"},
    )
    segments: list[Segment] = Field([], description="parts with another section")
    stations: list[Station] = Field([], description="what sits on it and holds it")

    def to_shaft(self) -> shaft.Shaft:
        return shaft.Shaft(
            length=self.length,
            profile=self.to_profile("shaft", self._linear()),
            segments=tuple(
                segment.to_segment(f"shaft.segments[{number}]")
                for number, segment in enumerate(self.segments, 1)
            ),
            loss_factor=self.loss_factor,
            theory=self.theory,
        )

    def _linear(self) -> float | None:
        """Mass per length, kg/m, where the mass of the whole shaft is given."""
        if self.mass is None:
            return None
        if self.mass_per_length is not None:
            raise ModelError("shaft.mass", "has no place beside mass_per_length; give one of both")
        if self.segments:
            raise ModelError("shaft.mass", "does not tell that of each part; give mass_per_length")
        if self.length <= 0:
            return 0.0  # told by the checks of the tool
        return self.mass / self.length

    def to_stations(self, reader: Beside) -> tuple[model.Station, ...]:
        return tuple(
            station.to_station(f"shaft.stations[{number}]", reader)
            for number, station in enumerate(self.stations, 1)
        )
