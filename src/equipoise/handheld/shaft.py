"""The shaft of a tool and its cross-sections: frozen values in SI units, and their checks."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cached_property
from itertools import pairwise
from typing import Any, ClassVar

from equipoise.errors import ModelError
from equipoise.handheld.section import (
    PROFILE,
    Section,
    Theory,
    Tube,
    profile_conditions,
    profile_of,
    profile_table,
    without_profile,
)
from equipoise.keys import (
    Conditions,
    Frozen,
    Key,
    Keys,
    Number,
    Quantity,
    Table,
    Tables,
    Text,
    declared,
    inside,
    key,
)
from equipoise.mechanism.checks import numbered

THEORIES = ("euler-bernoulli", "timoshenko")


@declared
class Segment(Frozen):
    """A part of the shaft with another section, from one place to another."""

    beside: ClassVar[Keys] = PROFILE
    conditions: ClassVar[Conditions] = profile_conditions("mass_per_length")

    start: float = key("length", "where it begins", name="from", example="1.2 m")
    stop: float = key("length", "where it ends", name="to", example="1.35 m")
    profile: Section | Tube = inside(Table(Frozen, flat=True))

    @classmethod
    def from_table(cls, given: dict[str, Any]) -> Segment:
        return cls(**without_profile(given), profile=profile_of(given))

    @classmethod
    def to_table(cls, value: Segment) -> dict[str, Any]:
        return {**super().to_table(value), **profile_table(value.profile)}


@declared
class Shaft(Frozen):
    """The shaft, free at both ends; what holds it are its stations.

    profile : its section, but where `segments` say otherwise.
    """

    beside: ClassVar[Keys] = {
        **PROFILE,
        "mass": Key(
            "mass",
            Quantity(dimension="mass"),
            "of the whole shaft, instead of `mass_per_length`; only without segments",
            default=None,
        ),
    }
    file_order = ("length", *PROFILE, "mass", "loss_factor", "theory", "segments")
    conditions: ClassVar[Conditions] = profile_conditions("mass_per_length", "mass")

    length: float = key("length", "from end to end", example="1.5 m", above=0)
    profile: Section | Tube = inside(Table(Frozen, flat=True))
    segments: tuple[Segment, ...] = key(
        Tables(Table(Segment)), "parts with another section", default=()
    )
    loss_factor: float = key(
        Number(),
        "of its material: the bending stiffness times 1 + i `loss_factor` counts",
        default=0.0,
        at_least=0,
        below=1,
    )
    theory: Theory = key(
        Text(THEORIES),
        "`timoshenko`: with shear and rotary inertia; needs the measures of tubes",
        default="euler-bernoulli",
    )

    @classmethod
    def from_table(cls, given: dict[str, Any]) -> Shaft:
        return cls(**without_profile(given), profile=profile_of(given, _linear(given)))

    @classmethod
    def to_table(cls, value: Shaft) -> dict[str, Any]:
        return {**super().to_table(value), **profile_table(value.profile)}

    @property
    def pieces(self) -> tuple[tuple[float, float, Section], ...]:
        """Start, stop and section of each part, from end to end."""
        return self._pieces

    @cached_property
    def _pieces(self) -> tuple[tuple[float, float, Section], ...]:
        found, at = [], 0.0
        for segment in sorted(self.segments, key=lambda one: one.start):
            if segment.start > at:
                found.append((at, segment.start, self.profile.section(self.theory)))
            found.append((segment.start, segment.stop, segment.profile.section(self.theory)))
            at = segment.stop
        if at < self.length:
            found.append((at, self.length, self.profile.section(self.theory)))
        return tuple(found)

    @property
    def mass(self) -> float:
        """kg."""
        return sum((stop - start) * one.mass_per_length for start, stop, one in self.pieces)


# -- checks ----------------------------------------------------------------------------------------


def _linear(given: dict[str, Any]) -> float | None:
    """Mass per length, kg/m, where the mass of the whole shaft is given."""
    if "mass" not in given:
        return None
    if "mass_per_length" in given:
        raise ModelError("mass", "has no place beside mass_per_length; give one of both")
    if given.get("segments"):
        raise ModelError("mass", "does not tell that of each part; give mass_per_length")
    length, mass = given["length"], given["mass"]
    return mass / length if length > 0 else 0.0  # told by the checks of the tool


def wrong_shaft(shaft: Shaft) -> Iterator[ModelError]:
    """Everything that is wrong with the values of a shaft."""
    yield from _wrong_profile("shaft", shaft.profile, shaft)
    for where, segment in numbered("shaft.segments", shaft.segments):
        if not 0 <= segment.start < segment.stop <= shaft.length:
            yield ModelError(
                where,
                f"goes from {segment.start:g} m to {segment.stop:g} m; give a part of the shaft, "
                f"which goes from 0 m to {shaft.length:g} m",
            )
        yield from _wrong_profile(where, segment.profile, shaft)
    ordered = sorted(numbered("shaft.segments", shaft.segments), key=lambda place: place[1].start)
    for (before, first), (where, second) in pairwise(ordered):
        if second.start < first.stop:
            yield ModelError(
                where,
                f"begins at {second.start:g} m, where {before} still goes on to {first.stop:g} m; "
                "parts must not overlap",
            )


def _wrong_profile(where: str, profile: Section | Tube, shaft: Shaft) -> Iterator[ModelError]:
    if isinstance(profile, Tube):
        yield from _wrong_tube(where, profile)
        return
    if shaft.theory == "timoshenko" and profile == profile.section("euler-bernoulli"):
        yield ModelError(
            f"{where}.bending_stiffness",
            "does not tell what shear does; with theory timoshenko give the measures of a tube, "
            "outer_diameter and material",
        )


def _wrong_tube(where: str, tube: Tube) -> Iterator[ModelError]:
    if tube.inner_diameter >= tube.outer_diameter:
        yield ModelError(
            f"{where}.inner_diameter",
            f"got {1e3 * tube.inner_diameter:g} mm inside of {1e3 * tube.outer_diameter:g} mm; "
            "give less than that",
        )
    if not 0 <= tube.poisson_ratio <= 0.5:
        yield ModelError(
            f"{where}.poisson_ratio", f"got {tube.poisson_ratio:g}; give a number from 0 to 0.5"
        )
