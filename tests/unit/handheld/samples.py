"""Tools for the tests of the shaft in bending, and the same tools as finite elements see them."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise
from math import inf, pi
from typing import Any

import numpy as np

from equipoise.handheld.model import Absorber, Excitation, Hand, Harness, Station, Tool
from equipoise.handheld.shaft import Section, Segment, Shaft, Theory, Tube
from support.beam_reference import Attached, Piece, Reference

Array = np.ndarray[Any, Any]
THEORIES: tuple[Theory, ...] = ("euler-bernoulli", "timoshenko")
SECTION = Section(1000.0, 2.0, 2e5, 6e-4)
"""Of shafts whose section does not matter; thick enough for shear to be seen."""
HARD = 1e15
"""N/m and N m/rad, of what is to be held still: beside EI beta^3 it gives way by 1e-9 and less."""


def bare(*stations: Station, length: float = 1.5, section: Section = SECTION, **shaft: Any) -> Tool:
    """Make a uniform shaft with stations."""
    return Tool("bare", Shaft(length, section, **shaft), stations)


def shaken(tool: Tool, *excitations: Excitation) -> Tool:
    """The tool with these causes and no other."""
    return replace(tool, excitations=excitations)


FULL = Station(
    "full",
    0.4,
    mass=0.7,
    inertia=(0.01, 0.02),
    stiffness=(300.0, 500.0),
    damping=(4.0, 5.0),
    rotational_stiffness=(60.0, 70.0),
    rotational_damping=(0.8, 0.9),
    absorber=Absorber(0.2, (3e3, 4e3), (1.5, 2.5)),
    hand=Hand(0.3, (900.0, 800.0), (30.0, 20.0), hands=2),
    harness=Harness((110.0, 120.0), (13.0, 14.0)),
)
"""A station with all that may sit on one."""


def both(value: float) -> tuple[float, float]:
    """The same number in both planes."""
    return value, value


def clamp(name: str, position: float) -> Station:
    """Hold a place still."""
    return Station(name, position, stiffness=both(HARD), rotational_stiffness=both(HARD))


def random_tool(seed: int, theory: Theory = "euler-bernoulli") -> Tool:
    """Make a tool with everything that a shaft can carry, different in its planes.

    Four sections, one of them a tube that reaches the right end; a station on the border of two
    of them; two hands, one of which is on the border, ground, harness and an absorber.
    """
    rng = np.random.default_rng([seed, 22867])

    def pair(low: float, high: float) -> tuple[float, float]:
        first, other = rng.uniform(low, high, 2)
        return float(first), float(other)

    def section() -> Section:
        stiffness, mass = rng.uniform(400, 2500), rng.uniform(0.4, 2.5)
        return Section(stiffness, mass, stiffness * rng.uniform(60, 300), mass * 4e-4)

    length = float(rng.uniform(1.2, 1.8))
    border, end, tail = (
        float(part * length) for part in rng.uniform([0.2, 0.5, 0.8], [0.3, 0.6, 0.9])
    )
    tube = Tube(0.028, 0.024, 70e9, 2700.0, 0.33, carried=float(rng.uniform(0, 0.4)))
    shaft = Shaft(
        length,
        section(),
        (Segment(tail, length, tube), Segment(border, end, section())),
        loss_factor=float(rng.uniform(0.005, 0.05)),
        theory=theory,
    )
    stations = (
        Station(
            "engine",
            0.0,
            mass=float(rng.uniform(2, 5)),
            inertia=pair(0.01, 0.04),
            rotational_damping=pair(0.1, 1.0),
        ),
        Station(
            "front",
            border,
            mass=float(rng.uniform(0.1, 0.5)),
            inertia=pair(1e-4, 1e-3),
            hand=Hand(
                float(rng.uniform(0.1, 0.4)), pair(4e3, 2e4), pair(20, 100), hands=1 + seed % 2
            ),
            rotational_stiffness=pair(50, 400),
        ),
        Station(
            "rear",
            float(rng.uniform(0.1, 0.15) * length),
            hand=Hand(0.0, pair(4e3, 2e4), pair(20, 100)),
            harness=Harness(pair(500, 3000), pair(10, 60)),
        ),
        Station(
            "middle",
            float(rng.uniform(0.62, 0.7) * length),
            mass=0.2,
            stiffness=pair(500, 5e3),
            damping=pair(5, 20),
            absorber=Absorber(float(rng.uniform(0.1, 0.4)), pair(2e4, 9e4), pair(2, 9)),
        ),
        Station("head", length, mass=float(rng.uniform(0.5, 2)), inertia=pair(1e-3, 5e-3)),
    )
    excitations = (
        Excitation("engine", "engine", unbalance=2e-4, phase=0.4),
        Excitation("blade", "head", unbalance=3e-4, phase=-1.1, ratio=-0.6),
        Excitation("gust", "middle", force=3.0, direction="lateral", phase=0.3),
        Excitation("turning", "rear", force=2.0, direction="rotating", ratio=1.7),
    )
    return Tool(f"random {seed}", shaft, stations, excitations)


def still(tool: Tool) -> Tool:
    """The tool without dampers and loss, written anew."""
    none = (0.0, 0.0)
    stations = tuple(
        replace(
            station,
            damping=none,
            rotational_damping=none,
            absorber=station.absorber and replace(station.absorber, damping=none),
            hand=station.hand and replace(station.hand, damping=none),
            harness=station.harness and replace(station.harness, damping=none),
        )
        for station in tool.stations
    )
    return replace(tool, shaft=replace(tool.shaft, loss_factor=0.0), stations=stations)


# -- as finite elements ----------------------------------------------------------------------------


def pieces_of(tool: Tool) -> list[Piece]:
    """The shaft from border to border, of the section that is there at its middle."""
    shaft = tool.shaft
    borders = {0.0, shaft.length}
    borders |= {place for part in shaft.segments for place in (part.start, part.stop)}
    pieces = []
    for start, stop in pairwise(sorted(borders)):
        middle = (start + stop) / 2
        inside = [part.profile for part in shaft.segments if part.start < middle < part.stop]
        pieces.append(_piece(stop - start, *inside, shaft.profile, shaft=shaft))
    return pieces


def _piece(length: float, profile: Section | Tube, *_: Any, shaft: Shaft) -> Piece:
    if isinstance(profile, Tube):
        stiffness, mass, shear, rotary = _of_tube(profile)
    else:
        stiffness, mass = profile.bending_stiffness, profile.mass_per_length
        shear, rotary = profile.shear_stiffness, profile.rotary_inertia
    if shaft.theory == "euler-bernoulli":
        shear, rotary = inf, 0.0
    return Piece(length, stiffness, mass, shear, rotary, shaft.loss_factor)


def _of_tube(tube: Tube) -> tuple[float, float, float, float]:
    """Cowper's coefficient of a hollow circle, with m the ratio of inner to outer radius."""
    outer, inner, nu = tube.outer_diameter / 2, tube.inner_diameter / 2, tube.poisson_ratio
    area, second, m = pi * (outer**2 - inner**2), pi / 4 * (outer**4 - inner**4), inner / outer
    coefficient = (
        6 * (1 + nu) * (1 + m**2) ** 2 / ((7 + 6 * nu) * (1 + m**2) ** 2 + (20 + 12 * nu) * m**2)
    )
    shear = coefficient * tube.youngs_modulus / 2 / (1 + nu) * area
    mass = tube.density * area + tube.carried
    return tube.youngs_modulus * second, mass, shear, tube.density * second


def attached_of(tool: Tool, plane: int) -> list[Attached]:
    """Of each station, in the order of the tool, what is on it in one plane."""
    actual = []
    for station in tool.stations:
        mass, stiffness, damping = station.mass, station.stiffness[plane], station.damping[plane]
        if station.hand is not None:
            count = station.hand.hands
            mass += count * station.hand.mass
            stiffness += count * station.hand.stiffness[plane]
            damping += count * station.hand.damping[plane]
        if station.harness is not None:
            stiffness += station.harness.stiffness[plane]
            damping += station.harness.damping[plane]
        absorber = station.absorber and (
            station.absorber.mass,
            station.absorber.stiffness[plane],
            station.absorber.damping[plane],
        )
        actual.append(
            Attached(
                station.position,
                mass,
                station.inertia[plane],
                stiffness,
                damping,
                station.rotational_stiffness[plane],
                station.rotational_damping[plane],
                absorber,
            )
        )
    return actual


def reference(tool: Tool, plane: int, elements: int = 96) -> Reference:
    """Finite elements of a tool in one plane."""
    return Reference(pieces_of(tool), attached_of(tool, plane), elements)
