"""Lee and Kim: Tables 2 and 4, the machines of them, and what makes printed numbers other ones.

Frame and symbols as in `test_lee_kim`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from math import pi, radians
from typing import Any

import numpy as np

import equipoise as eq
from support.conformance import Cause
from support.rounding import half_digits, reach

Array = np.ndarray[Any, Any]

STEEL = 7850.0
"""kg/m3."""


@dataclass(frozen=True)
class Body:
    """A row of Table 2: length, distance and direction of the centre of mass, mass, inertia."""

    length: float
    arm: float
    beta: float
    mass: float
    inertia: float


TABLE_2 = {
    "a": (
        0.066,
        Body(0.032, 0.019, 0, 0.139, 3.12e-5),
        Body(0.060, 0.043, 163, 0.673, 4.82e-3),
        Body(0.065, 0.045, 0, 0.437, 6.89e-4),
    ),
    "b": (
        0.074,
        Body(0.035, 0.015, 0, 0.184, 6.24e-5),
        Body(0.075, 0.022, 160, 0.788, 5.05e-3),
        Body(0.077, 0.053, 0, 0.165, 1.60e-4),
    ),
    "c": (
        0.130,
        Body(0.042, 0.014, 0, 0.806, 9.32e-4),
        Body(0.092, 0.022, 152, 0.850, 8.50e-3),
        Body(0.095, 0.048, 0, 0.085, 7.80e-5),
    ),
}
"""R_1, then links 2, 3 and 4; m, deg, kg, kg m2."""

RPM = {"a": 300, "b": 270, "c": 310}
LINKS = ("crank", "coupler", "rocker")


@dataclass(frozen=True)
class Weight:
    """A row of Table 4 with what is not printed: r_g4 = 50 mm and I_e = 0.133 m_e R_e^2."""

    ratio: float
    mass: float
    arm: float
    start: float
    pitch: float = 0.050

    @property
    def inertia(self) -> float:
        return 0.133 * self.mass * (self.arm / 0.606) ** 2

    @property
    def axes(self) -> float:
        """From O4 to E: r_g4 + r_g5, m."""
        return self.pitch * (1 + 1 / self.ratio)


TABLE_4 = {
    "a": Weight(0.57, 0.625, 0.055, 360),
    "b": Weight(0.47, 0.416, 0.045, 350),
    "c": Weight(0.57, 0.625, 0.055, 280),
}


def mechanism(name: str, phi: float = 0.0) -> eq.Machine:
    """An example with its line of pivots turned by phi, deg, and without weight."""
    machine = eq.load(f"lee-kim-{name}")
    place = TABLE_2[name][0] * np.exp(1j * radians(phi))
    frame = {**machine.frame, "O4": (float(place.real), float(place.imag))}
    return replace(machine, frame=frame, gravity=(0.0, 0.0))


def geared(
    name: str, phi: float = 0.0, start: float | None = None, weight: Weight | None = None
) -> eq.Machine:
    """A mechanism with its counterweight of Table 4; start is theta_e0, deg from the line."""
    machine, weight = mechanism(name, phi), weight or TABLE_4[name]
    axis = (TABLE_2[name][0] + weight.axes) * np.exp(1j * radians(phi))
    start = weight.start if start is None else start
    counterweight = eq.Link({"E": (0.0, 0.0)}, weight.mass, (weight.arm, 0.0), weight.inertia)
    gear = eq.Gear("rocker", "counterweight", ratio=-weight.ratio, start=radians(start + phi))
    return replace(
        machine,
        frame={**machine.frame, "E": (float(axis.real), float(axis.imag))},
        links={**machine.links, "counterweight": counterweight},
        gears=(gear,),
    )


def shaking_energy(machine: eq.Machine, count: int = 7200) -> float:
    """Area under the absolute shaking moment over one turn, J."""
    moment = eq.forces(eq.move(machine, count)).shaking_moment
    return float(2 * pi * np.mean(np.abs(moment)))


def peak(machine: eq.Machine) -> float:
    return float(np.max(np.abs(eq.forces(eq.move(machine, 7200)).shaking_moment)))


def with_gears(machine: eq.Machine, name: str, gear_inertia: float) -> eq.Machine:
    """Gears of the same width and material: I_g5 = I_g4 / n^4; their masses turn in place."""
    n = TABLE_4[name].ratio
    for link, extra in (("rocker", gear_inertia), ("counterweight", gear_inertia / n**4)):
        machine = machine.with_link(link, inertia=(machine.links[link].inertia or 0) + extra)
    return machine


# -- what makes printed numbers other ones ---------------------------------------------------------


def numbers_of_table_2(name: str) -> Iterator[tuple[float, float]]:
    """Each number and half of its last digit: mm, whole degrees, g, three digits of inertias."""
    r1, *bodies = TABLE_2[name]
    yield r1, 5e-4
    for body in bodies:
        yield from ((body.length, 5e-4), (body.arm, 5e-4), (body.beta, 0.5), (body.mass, 5e-4))
        yield body.inertia, *half_digits([body.inertia], 3)


def with_table_2(machine: eq.Machine, numbers: Array) -> eq.Machine:
    """A mechanism, with its counterweight or without, of other numbers than those of Table 2."""
    links, (r1, *rest) = dict(machine.links), numbers.tolist()
    for link, (length, arm, beta, mass, inertia) in zip(
        LINKS, np.reshape(rest, (3, 5)).tolist(), strict=True
    ):
        center = arm * np.exp(1j * radians(beta))
        first, second = links[link].points
        links[link] = eq.Link(
            {first: (0.0, 0.0), second: (length, 0.0)}, mass, (center.real, center.imag), inertia
        )
    frame = {point: (x, y) for point, (x, y) in machine.frame.items()}
    shift = r1 - frame["O4"][0]
    frame |= {point: (frame[point][0] + shift, 0.0) for point in ("O4", "E") if point in frame}
    return replace(machine, frame=frame, links=links)


def by_table_2(name: str, value: Callable[[Callable[[eq.Machine], eq.Machine]], float]) -> Cause:
    """What half a digit of Table 2 leaves of a value, of which the value is given the machines."""

    def gives() -> list[float]:
        data, halves = zip(*numbers_of_table_2(name), strict=True)
        return reach(lambda x: value(lambda machine: with_table_2(machine, x)), data, halves)

    return Cause("half a digit of their Table 2", gives)


def steel_gears(name: str, pitch: float, width: float) -> eq.Machine:
    """With the counterweight and gears of steel: r_g4 and width, mm; neither is printed."""
    radius = pitch / 1e3
    inertia = pi / 2 * radius**4 * (width / 1e3) * STEEL
    return with_gears(geared(name, weight=replace(TABLE_4[name], pitch=radius)), name, inertia)


def by_gears(
    name: str, pitch: float, width: float, value: Callable[[eq.Machine], float], also: str = ""
) -> Cause:
    """What gears of steel make of a value."""
    text = f"gears of steel, r_g4 = {pitch:g} mm and {width:g} mm wide{also}"
    return Cause(text, lambda: value(steel_gears(name, pitch, width)))
