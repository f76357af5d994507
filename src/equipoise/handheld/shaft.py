"""The shaft of a tool and its cross-sections: frozen values in SI units, and their checks."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise
from math import inf, pi
from typing import Any, ClassVar, Literal

from equipoise.errors import ModelError
from equipoise.keys import Frozen
from equipoise.mechanism.checks import positive, unknown

Theory = Literal["euler-bernoulli", "timoshenko"]
THEORIES = ("euler-bernoulli", "timoshenko")


UNITS = {
    "mass": "kg",
    "inertia": "kg m^2",
    "stiffness": "N/m",
    "damping": "N s/m",
    "rotational_stiffness": "N m/rad",
    "rotational_damping": "N m s/rad",
    "loss_factor": "",
    "inner_diameter": "m",
    "carried": "kg/m",
    "shear_stiffness": "N",
    "rotary_inertia": "kg m",
    "unbalance": "kg m",
    "force": "N",
}


@dataclass(frozen=True)
class Section(Frozen):
    """Cross-section by its stiffness and mass.

    bending_stiffness : EI, N m2.
    mass_per_length : rho A, kg/m.
    shear_stiffness : kGA, N; infinite where shear does not count.
    rotary_inertia : rho I, kg m; 0 where it does not count.
    """

    shapes: ClassVar[dict[str, str]] = dict.fromkeys(
        ("bending_stiffness", "mass_per_length", "shear_stiffness", "rotary_inertia"), "number"
    )
    endless: ClassVar[tuple[str, ...]] = ("shear_stiffness",)

    bending_stiffness: float
    mass_per_length: float
    shear_stiffness: float = inf
    rotary_inertia: float = 0.0

    def section(self, theory: Theory) -> Section:
        """The section as a theory sees it."""
        return self if theory == "timoshenko" else replace(self, **_WITHOUT_SHEAR)


_WITHOUT_SHEAR: dict[str, Any] = {"shear_stiffness": inf, "rotary_inertia": 0.0}


@dataclass(frozen=True)
class Tube(Frozen):
    """Cross-section by its measures and material.

    outer_diameter, inner_diameter : m; 0 inside for a rod.
    youngs_modulus : Pa.
    density : kg/m3.
    poisson_ratio : for shear.
    carried : mass per length of what runs in it and does not stiffen it, kg/m.
    """

    shapes: ClassVar[dict[str, str]] = dict.fromkeys(
        (
            "outer_diameter",
            "inner_diameter",
            "youngs_modulus",
            "density",
            "poisson_ratio",
            "carried",
        ),
        "number",
    )

    outer_diameter: float
    inner_diameter: float
    youngs_modulus: float
    density: float
    poisson_ratio: float = 0.3
    carried: float = 0.0

    def section(self, theory: Theory) -> Section:
        """The section as a theory sees it; shear by the coefficient of Cowper (1966)."""
        area = pi / 4 * (self.outer_diameter**2 - self.inner_diameter**2)
        second = pi / 64 * (self.outer_diameter**4 - self.inner_diameter**4)
        plain = Section(self.youngs_modulus * second, self.density * area + self.carried)
        if theory != "timoshenko":
            return plain
        shear_modulus = self.youngs_modulus / (2 * (1 + self.poisson_ratio))
        return replace(
            plain,
            shear_stiffness=self._coefficient() * shear_modulus * area,
            rotary_inertia=self.density * second,
        )

    def _coefficient(self) -> float:
        """Shear coefficient of a hollow circle."""
        nu, ratio = self.poisson_ratio, self.inner_diameter / self.outer_diameter
        square = (1 + ratio**2) ** 2
        return 6 * (1 + nu) * square / ((7 + 6 * nu) * square + (20 + 12 * nu) * ratio**2)


@dataclass(frozen=True)
class Segment(Frozen):
    """A part of the shaft with another section, from one place to another, m."""

    shapes: ClassVar[dict[str, str]] = {"start": "number", "stop": "number"}
    flat: ClassVar[tuple[str, ...]] = ("profile",)

    start: float
    stop: float
    profile: Section | Tube


@dataclass(frozen=True)
class Shaft(Frozen):
    """The shaft, free at both ends; what holds it are its stations.

    length : m.
    profile : its section, but where `segments` say otherwise.
    loss_factor : of the material; bending stiffness times 1 + i loss_factor.
    theory : Timoshenko's beam has shear and rotary inertia besides.
    """

    shapes: ClassVar[dict[str, str]] = {
        "length": "number",
        "segments": "list",
        "loss_factor": "number",
        "theory": "text",
    }
    flat: ClassVar[tuple[str, ...]] = ("profile",)

    length: float
    profile: Section | Tube
    segments: tuple[Segment, ...] = ()
    loss_factor: float = 0.0
    theory: Theory = "euler-bernoulli"

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


def places(key: str, items: Sequence[Any]) -> Iterator[tuple[str, Any]]:
    """Each of a list of tables with its place, numbered from 1."""
    return ((f"{key}[{number}]", item) for number, item in enumerate(items, 1))


def negative(where: str, item: Any, *keys: str) -> Iterator[ModelError]:
    """Complain of numbers, and of pairs of them, that are below 0."""
    for key in keys:
        value = getattr(item, key)
        least = min(value) if isinstance(value, tuple) else value
        if least is not None and least < 0:
            given = f"{least:g} {UNITS[key]}".rstrip()
            yield ModelError(f"{where}.{key}", f"got {given}; give 0 or more")


def wrong_shaft(shaft: Shaft) -> Iterator[ModelError]:
    """Everything that is wrong with the values of a shaft."""
    yield from positive("shaft.length", shaft.length, "m")
    yield from negative("shaft", shaft, "loss_factor")
    if shaft.loss_factor >= 1:
        yield ModelError("shaft.loss_factor", f"got {shaft.loss_factor:g}; give less than 1")
    if shaft.theory not in THEORIES:
        yield ModelError("shaft.theory", unknown(shaft.theory, THEORIES, "theory"))
    yield from _wrong_profile("shaft", shaft.profile, shaft)
    for where, segment in places("shaft.segments", shaft.segments):
        if not 0 <= segment.start < segment.stop <= shaft.length:
            yield ModelError(
                where,
                f"goes from {segment.start:g} m to {segment.stop:g} m; give a part of the shaft, "
                f"which goes from 0 m to {shaft.length:g} m",
            )
        yield from _wrong_profile(where, segment.profile, shaft)
    ordered = sorted(places("shaft.segments", shaft.segments), key=lambda place: place[1].start)
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
    yield from positive(f"{where}.bending_stiffness", profile.bending_stiffness, "N m^2")
    yield from positive(f"{where}.mass_per_length", profile.mass_per_length, "kg/m")
    yield from positive(f"{where}.shear_stiffness", profile.shear_stiffness, "N")
    yield from negative(where, profile, "rotary_inertia")
    if shaft.theory == "timoshenko" and profile == profile.section("euler-bernoulli"):
        yield ModelError(
            f"{where}.bending_stiffness",
            "does not tell what shear does; with theory timoshenko give the measures of a tube, "
            "outer_diameter and material",
        )


def _wrong_tube(where: str, tube: Tube) -> Iterator[ModelError]:
    yield from positive(f"{where}.outer_diameter", tube.outer_diameter, "m")
    yield from negative(where, tube, "inner_diameter", "carried")
    if tube.inner_diameter >= tube.outer_diameter:
        yield ModelError(
            f"{where}.inner_diameter",
            f"got {1e3 * tube.inner_diameter:g} mm inside of {1e3 * tube.outer_diameter:g} mm; "
            "give less than that",
        )
    yield from positive(f"{where}.youngs_modulus", tube.youngs_modulus, "Pa")
    yield from positive(f"{where}.density", tube.density, "kg/m^3")
    if not 0 <= tube.poisson_ratio <= 0.5:
        yield ModelError(
            f"{where}.poisson_ratio", f"got {tube.poisson_ratio:g}; give a number from 0 to 0.5"
        )
