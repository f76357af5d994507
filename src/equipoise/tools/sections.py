"""The shaft of a tool and its cross-sections: frozen values in SI units."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from math import inf, pi
from typing import Any, ClassVar, Literal

from equipoise.keys import Frozen

Theory = Literal["euler-bernoulli", "timoshenko"]


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
