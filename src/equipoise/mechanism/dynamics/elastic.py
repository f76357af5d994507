"""Links that bend and stretch a little about their rigid motion: beams on both ends of a line.

The loads along a link, inertia among them, bend it as they would at rest: E I w'' = M with w = 0 at
both ends of the line, and stretch it by N / E A.  That holds while the link's first natural
frequency, of a beam that both ends hold as pins do, lies well above what excites it.
"""

from __future__ import annotations

from collections.abc import Iterator
from math import pi

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.mechanism.assembly.steps import Array, planar
from equipoise.mechanism.dynamics.section_loads import Cut, MassAlongLine, SectionLoads
from equipoise.mechanism.parts.links import Link
from equipoise.mechanism.parts.sections import LinkSection

PARTS = 160
"""Parts of a line over which moments are summed by the trapezoidal rule: to 1e-4."""
ORDER, ADDED = 2, 0.1
"""Rigid links mislead where bending adds this share to what has this order of the crank: inertia of
linkages is of the first and second order above all."""


@dataclass(frozen=True, eq=False)
class ElasticLink:
    """A link as a beam, over crank angles (N,).

    natural_frequency : first one of bending in the plane, Hz; None without mass along the line.
    places : (P,) along the line, m.  deflection : (P, N) to the left of the line between the ends,
    m.  slope : (P, N) of it, rad.  stretch : (P, N) by which the line is longer up to there, m.
    """

    natural_frequency: float | None
    places: Array
    deflection: Array
    slope: Array
    stretch: Array

    def moved(self, place: complex) -> Array:
        """Displacement (N,) of a place of the link against the line between the ends, in the axes
        of that, complex, m.

        place : from the first point along the line and to the left of it, m.
        """
        inside = float(np.clip(place.real, 0.0, self.places[-1]))
        bent, turned, longer = (
            np.array([np.interp(inside, self.places, item) for item in values.T])
            for values in (self.deflection, self.slope, self.stretch)
        )
        return np.asarray(longer + 1j * bent + 1j * turned * (place - inside))


def natural_frequency(modulus: float, second_moment: float, mass: float, length: float) -> float:
    """First natural frequency, Hz, of a uniform beam on two pins: pi / 2 (E I / m L^3)^(1/2)."""
    return float(pi / 2 * (modulus * second_moment / (mass * length**3)) ** 0.5)


def _frequency(section: LinkSection, rod: float, length: float) -> float | None:
    """First natural frequency, Hz, of a section along which a mass (kg) is spread; None without a
    modulus, or where no mass is left to bend.
    """
    if section.elastic_modulus is None or rod <= 0:
        return None
    return natural_frequency(section.elastic_modulus, section.second_moment, rod, length)


def bending_frequency(link: Link) -> float | None:
    """First natural frequency, Hz, of a link on pins at both ends of its line; None without a
    section, a modulus or a mass along it.
    """
    if link.section is None or link.center_of_mass is None:
        return None
    first, second = (planar(link.points[name]) for name in link.section.ends(link.points))
    return _frequency(link.section, MassAlongLine.of_link(link).rod, abs(second - first))


def elastic_link(loads: SectionLoads) -> ElasticLink | None:
    """A link as a beam under its loads; None without a modulus."""
    section, length = loads.section, loads.length
    modulus, count = section.elastic_modulus, len(loads.cuts[0].at)
    if modulus is None:
        return None
    places = np.linspace(0.0, length, PARTS + 1)
    cuts = [loads.in_cut(Cut(np.broadcast_to(place, count), False)) for place in places[1:]]
    first = loads.in_cut(Cut(np.zeros(count), True))
    every = [first, *cuts]
    bent = _summed(np.array([item.bending for item in every]), length)
    slope = bent / (modulus * section.second_moment)
    deflection = _summed(slope, length)
    chord = deflection[-1] / length
    stretch = _summed(np.array([item.axial for item in every]), length) / (modulus * section.area)
    frequency = _frequency(section, loads.mass.rod, length)
    return ElasticLink(
        frequency, places, deflection - chord * places[:, None], slope - chord, stretch
    )


def _summed(values: Array, length: float) -> Array:
    """Integral (P, N) from the first place on."""
    steps = (values[:-1] + values[1:]) * (length / PARTS / 2)
    return np.concatenate([np.zeros((1, values.shape[1])), np.cumsum(steps, axis=0)])


def other_places(link: Link) -> Iterator[tuple[str, complex]]:
    """Points of a link but the ends of its line, from the first of these along the line."""
    assert link.section is not None
    ends = link.section.ends(link.points)
    first, second = (planar(link.points[name]) for name in ends)
    along = (second - first) / abs(second - first)
    for name, at in link.points.items():
        if name not in ends:
            yield name, (planar(at) - first) / along


def added_share(frequency: float, speed: float) -> float:
    """Share by which bending enlarges what excites a link at the second order of a speed, rad/s;
    infinite from its natural frequency on.
    """
    ratio = (ORDER * abs(speed) / (2 * pi * frequency)) ** 2
    return ratio / (1 - ratio) if ratio < 1 else float("inf")
