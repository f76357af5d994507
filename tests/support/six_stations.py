"""A brush cutter with six stations, and where they lie on a mesh of its shaft.

The tool has length, mass, bending stiffness, masses and springs of Nagamine and Irie (1970), 3.3.
Its rear grip, its added mass, all dampers and moments of inertia are assumed.  The shaft is a tube
of 24 mm whose density stands for the drive shaft inside too, because ROSS knows no other way.
"""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise
from math import pi

from equipoise.handheld.model import Excitation, Hand, Harness, Station, Tool
from equipoise.handheld.shaft import Shaft, Tube

LENGTH, MASS, STIFFNESS = 1.544, 3.56, 980.665
"""Of the shaft: m, kg, N m2."""
OUTER, STEEL = 0.024, 206e9
INNER = (OUTER**4 - 64 * STIFFNESS / (pi * STEEL)) ** 0.25
DENSITY = MASS / (LENGTH * pi / 4 * (OUTER**2 - INNER**2))
UNBALANCE = 1e-4
"""Of the engine, kg m."""
STATIONS = (
    Station("engine", 0.0, mass=2.2 * MASS, inertia=(0.02, 0.02)),
    Station("rear grip", 0.1, hand=Hand(0.5, (3e4, 2e4), (60.0, 50.0))),
    Station("belt", 0.166 * LENGTH, harness=Harness((46484.0, 30e3), (80.0, 60.0))),
    Station("handle", 0.266 * LENGTH, mass=0.481, hand=Hand(0.5, (50e3, 35e3), (110.0, 90.0))),
    Station("weight", 0.9, mass=0.2),
    Station("cutter", LENGTH, mass=0.291 * MASS, inertia=(0.002, 0.002)),
)
ENGINE, HANDLE = "engine", "handle"
ELEMENTS = 48
"""Made of 12 by halves."""
POWERS = {"euler-bernoulli": 4, "timoshenko": 2}
"""Of an element's length, with which ROSS's error goes to zero; the next is higher by two."""


def build(theory: str) -> Tool:
    """The tool with two hands on its handle."""
    tube = Tube(OUTER, INNER, STEEL, DENSITY)
    tool = Tool(
        "brush cutter",
        Shaft(LENGTH, tube, theory=theory),
        STATIONS,
        (Excitation("engine", ENGINE, unbalance=UNBALANCE, ratio=-1.0, phase=pi / 2),),
    )
    return tool.with_station(HANDLE, hand=replace(tool.station(HANDLE).hand, hands=2))


TOOLS = {theory: build(theory) for theory in POWERS}


def mesh(count: int) -> tuple[list[float], dict[str, int]]:
    """Lengths (m) of so many elements, alike between two stations, and the stations' nodes."""
    places = [station.position for station in STATIONS]
    coarsest = ELEMENTS // 4
    ends = [count // coarsest * round(place / LENGTH * coarsest) for place in places]
    lengths = []
    for (start, stop), (first, last) in zip(pairwise(places), pairwise(ends), strict=True):
        lengths += [(stop - start) / (last - first)] * (last - first)
    return lengths, {station.name: end for station, end in zip(STATIONS, ends, strict=True)}
