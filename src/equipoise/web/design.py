"""What a page edits: a machine, and the counterweights that are tried on it."""

from __future__ import annotations

from cmath import phase
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from math import cos, pi, sin
from types import MappingProxyType

from equipoise.balancing.usual import reach_of
from equipoise.errors import UsageError
from equipoise.mechanism import kernels
from equipoise.mechanism.model import Link, Machine


@dataclass(frozen=True)
class Counterweight:
    """A point mass on a link that is pinned to the frame.

    mass : kg.  radius : from the pin, m.  direction : in the link's axes, rad.
    """

    mass: float = 0.0
    radius: float = 0.0
    direction: float = 0.0

    @property
    def arm(self) -> complex:
        """From the pin to the mass, m."""
        return self.radius * complex(cos(self.direction), sin(self.direction))


@dataclass(frozen=True)
class Design:
    """One state of a page.

    name : of the file or example.  own : the machine without the counterweights.
    counterweights : by link; those of mass 0 do nothing, and keep their place.
    """

    name: str
    own: Machine
    counterweights: Mapping[str, Counterweight] = field(default_factory=dict)

    @cached_property
    def machine(self) -> Machine:
        """The machine with its counterweights in mass, centre of mass and inertia of the links."""
        machine = self.own
        for name, weight in self.counterweights.items():
            if weight.mass:
                link = machine.links[name]
                place = _pin(machine, name) + weight.arm
                mass, center, inertia = _joined(link, weight.mass, place)
                machine = machine.with_link(
                    name, mass=mass, center_of_mass=(center.real, center.imag), inertia=inertia
                )
        return machine

    def weight_on(self, link: str) -> Counterweight:
        """The counterweight on a link; at first without mass, but where it would do some good."""
        return self.counterweights.get(link) or _opposite(self.own, link)

    def with_machine(self, own: Machine) -> Design:
        """The same counterweights on another machine of the same build."""
        return replace(self, own=own)

    def with_weight(self, link: str, weight: Counterweight) -> Design:
        """Another counterweight on a link.

        Raises
        ------
        UsageError : its mass or radius is below 0.
        """
        for value, what, unit in ((weight.mass, "mass", "g"), (weight.radius, "radius", "mm")):
            if value < 0:
                raise UsageError(f"got a {what} of {1e3 * value:.6g} {unit}; give 0 or more")
        weights = {**self.counterweights, link: weight}
        return replace(self, counterweights=MappingProxyType(weights))

    def own_center(self, link: str, center: complex) -> complex:
        """Centre of mass that a link needs so that it lies there with its counterweight, m.

        Raises
        ------
        UsageError : the link has no mass of its own to be moved.
        """
        weight = self.counterweights.get(link)
        if weight is None or not weight.mass:
            return center
        mass = self.own.links[link].mass or 0.0
        if not mass:
            raise UsageError(
                f"{link} has no mass but its counterweight; change that, or give the link a mass"
            )
        return center + (center - _pin(self.own, link) - weight.arm) * (weight.mass / mass)


def pin_of(machine: Machine, link: str) -> str | None:
    """The link's point in the frame; None where it has none."""
    return next((name for name in machine.links[link].points if name in machine.frame), None)


def _pin(machine: Machine, link: str) -> complex:
    """Place of that point in the link's axes, m."""
    name = pin_of(machine, link)
    assert name is not None
    return complex(*machine.links[link].points[name])


def _opposite(machine: Machine, link: str) -> Counterweight:
    """No mass yet, as far from the pin as the link reaches, opposite to its centre of mass."""
    body, pin = machine.links[link], _pin(machine, link)
    away = pin - complex(*(body.center_of_mass or (pin.real, pin.imag)))
    return Counterweight(0.0, reach_of(machine, link), phase(away) if away else pi)


def _joined(link: Link, mass: float, place: complex) -> tuple[float, complex, float]:
    """Mass, centre of mass and inertia about it of a link and a point mass."""
    assert link.mass is not None and link.center_of_mass is not None and link.inertia is not None
    center = complex(*link.center_of_mass)
    whole = link.mass + mass
    common = (link.mass * center + mass * place) / whole
    _, _, own = kernels.about(link.mass, 0.0, link.inertia, common - center)
    _, _, added = kernels.about(mass, 0.0, 0.0, common - place)
    return whole, common, float(own + added)
