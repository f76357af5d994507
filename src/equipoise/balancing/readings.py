"""Combinations of inertial parameters as sums to be read, over lengths of the machine."""

from __future__ import annotations

from collections.abc import Callable
from itertools import combinations

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.i18n import say, to_say
from equipoise.mechanism.dynamics.parameters import QUANTITIES, parameter_names
from equipoise.mechanism.parts.machine import Machine, size_of
from equipoise.quantities import display
from equipoise.signals import Array

UNITS = dict(zip(QUANTITIES, ("kg", "kg m", "kg m", "kg m2"), strict=True))


WORDS = {
    "mass": to_say("mass of {name}"),
    "moment_x": to_say("mass*x of {name}"),
    "moment_y": to_say("mass*y of {name}"),
    "inertia": to_say("inertia of {name}"),
}
"""What a parameter of a link is called in a sum."""


@dataclass(frozen=True)
class ParameterTerm:
    """A parameter of a link in a sum.

    sign : ``+`` or ``-``.  size : by which it is multiplied, so that the sum is in kg; None where
    it stands alone.
    """

    sign: str
    link: str
    quantity: str
    size: float | None = None

    @property
    def around(self) -> tuple[str, str]:
        """What stands before and behind its name, such as the length over which it stands."""
        if self.size is None:
            return "", ""
        if self.quantity == "mass":
            return "" if f"{self.size:.5g}" == "1" else f"{self.size:.5g} ", ""
        length = 1 / (self.size**0.5 if self.quantity == "inertia" else self.size)
        unit = display("length", [length])
        text = f"{unit.factor * length:.5g} {unit.unit}"
        return "", f" / ({text})^2" if self.quantity == "inertia" else f" / {text}"


@dataclass(frozen=True)
class ParameterSum:
    """A combination of inertial parameters as a sum.

    factor : by which the combination was multiplied for it.  unit : of the sum.
    """

    terms: tuple[ParameterTerm, ...]
    factor: float
    unit: str

    @property
    def text(self) -> str:
        """Such as ``coupler.moment_x / 71.5 mm + rocker.moment_x / 80 mm``."""
        return self._sum(lambda term: f"{term.link}.{term.quantity}")

    @property
    def words(self) -> str:
        """Text for readers, ``mass*x of coupler / 71.5 mm + mass*x of rocker / 80 mm``."""
        return self._sum(lambda term: say(WORDS[term.quantity], name=term.link))

    def _sum(self, named: Callable[[ParameterTerm], str]) -> str:
        parts = [
            f"{term.sign} {term.around[0]}{named(term)}{term.around[1]}" for term in self.terms
        ]
        first = parts[0].removeprefix("+ ")
        return " ".join([f"-{first[2:]}" if first.startswith("- ") else first, *parts[1:]])


def machine_size(machine: Machine) -> float:
    """Diagonal of the largest link, or of the frame where all links are points, m."""
    sizes = [size_of(link.points) for link in machine.links.values()]
    return max(sizes) or size_of(machine.frame) or 1.0


def joint_length(machine: Machine, link: str) -> float:
    """Distance of a link's two joints that are farthest apart; its size where there are none, m."""
    own = machine.links[link].points
    others = [other.points for name, other in machine.links.items() if name != link]
    slides = {name for slider in machine.sliders for name in (slider.point, slider.through)}
    places = [
        complex(*place)
        for name, place in own.items()
        if name in slides or any(name in body for body in (machine.frame, *others))
    ]
    apart = max((abs(a - b) for a, b in combinations(places, 2)), default=0.0)
    return apart or size_of(own) or machine_size(machine)


def reading(machine: Machine, row: Array, signed: bool = False) -> ParameterSum:
    """A combination (P,) of a machine's inertial parameters in words.

    It is divided so that a mass stands alone, else so that the first moment that comes first stands
    over the length of its link: as (80) and (83) of Yamashita, Ichikawa and Mori, divided by their
    lengths.  Unless `signed`, it is turned so that the first term is positive.
    """
    names = parameter_names(machine)
    terms = [(*names[k], float(row[k])) for k in np.flatnonzero(row)]
    sign = -1.0 if terms[0][2] < 0 and not signed else 1.0
    if len(terms) == 1:
        link, quantity, value = terms[0]
        term = ParameterTerm("-" if sign * value < 0 else "+", link, quantity)
        return ParameterSum((term,), sign / abs(value), UNITS[quantity])
    factor = sign / _divisor(machine, terms)
    parts = tuple(
        ParameterTerm("-" if factor * value < 0 else "+", link, quantity, abs(factor * value))
        for link, quantity, value in terms
    )
    return ParameterSum(parts, factor, "kg")


def _divisor(machine: Machine, terms: list[tuple[str, str, float]]) -> float:
    """Positive, in SI units of a combination over kg."""
    for wanted, power in (("mass", 0), ("moment", 1), ("inertia", 2)):
        for link, quantity, value in terms:
            if quantity.startswith(wanted):
                return abs(value) * joint_length(machine, link) ** power
    return 1.0
