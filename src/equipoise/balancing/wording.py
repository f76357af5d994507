"""Linear conditions on inertial parameters as an engineer reads them: moments over lengths."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations
from typing import Any

import numpy as np

from equipoise.mechanism.model import Machine, size_of
from equipoise.mechanism.parameters import QUANTITIES, parameter_names

Array = np.ndarray[Any, Any]

UNITS = dict(zip(QUANTITIES, ("kg", "kg m", "kg m", "kg m2"), strict=True))


@dataclass(frozen=True)
class Reading:
    """A combination of inertial parameters in words.

    text : such as ``coupler.moment_x / 71.5 mm + rocker.moment_x / 80 mm``.
    factor : by which the combination was multiplied for it.  unit : of the text.
    """

    text: str
    factor: float
    unit: str


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


def reading(machine: Machine, row: Array, signed: bool = False) -> Reading:
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
        text = f"{link}.{quantity}"
        return Reading(f"-{text}" if sign * value < 0 else text, sign / abs(value), UNITS[quantity])
    factor = sign / _divisor(machine, terms)
    parts = [_term(link, quantity, factor * value) for link, quantity, value in terms]
    return Reading(_joined(parts), factor, "kg")


def _divisor(machine: Machine, terms: list[tuple[str, str, float]]) -> float:
    """Positive, in SI units of a combination over kg."""
    for wanted, power in (("mass", 0), ("moment", 1), ("inertia", 2)):
        for link, quantity, value in terms:
            if quantity.startswith(wanted):
                return abs(value) * joint_length(machine, link) ** power
    return 1.0


def _term(link: str, quantity: str, value: float) -> tuple[str, str]:
    """Sign and size of a term in kg."""
    sign, size, name = "-" if value < 0 else "+", abs(value), f"{link}.{quantity}"
    if quantity == "mass":
        return sign, name if f"{size:.5g}" == "1" else f"{size:.5g} {name}"
    if quantity == "inertia":
        return sign, f"{name} / ({1e3 / size**0.5:.5g} mm)^2"
    return sign, f"{name} / {1e3 / size:.5g} mm"


def _joined(terms: list[tuple[str, str]]) -> str:
    first = "-" if terms[0][0] == "-" else ""
    return " ".join([first + terms[0][1], *(f"{sign} {text}" for sign, text in terms[1:])])
