"""Small planting machines whose motion is known in closed form, and brute force on any."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

import equipoise as eq
from equipoise.mechanism.kinematics.motion import PointMotion
from equipoise.mechanism.parts.field import Planting, PlantingArm
from equipoise.planting.summary import PlantingFigures

Array = NDArray[Any]
TURN = 2 * np.pi
EXAMPLES = ("kim-chung-a", "kim-chung-b", "kim-chung-c")
"""A crank that turns counterclockwise, and two that turn clockwise."""


def apart(a: Any, b: Any) -> Any:
    """Smallest angle between directions."""
    return np.abs((np.asarray(a) - b + np.pi) % TURN - np.pi)


def spinner(speed: float = 10.0, *, at: float = 0.0, **planting: Any) -> eq.Machine:
    """A tip 0.1 m from the crank pivot, at the direction `at` in the crank's axes."""
    given = {"tip": "P", "forward_speed": 0.6, "depth": 0.04, **planting}
    points = {"A": (0.0, 0.0), "P": (0.1 * np.cos(at), 0.1 * np.sin(at))}
    return eq.Machine(
        "spinner",
        eq.Drive("crank", speed),
        {"A": (0.0, 0.0)},
        {"crank": eq.Link(points, 0.2, (0.02, 0.0), 1e-4)},
        planting=Planting(**given),
    )


ARM, FINGER, START = 0.06 + 0.045j, 0.05, np.radians(143)


def planetary(speed: float = 20.0, teeth: int = 30, **planting: Any) -> eq.Machine:
    """The bundled planetary arm with another planet: of 30 teeth it is back after three turns.

    Its tip runs along ARM exp(i theta) + FINGER exp(i (START + (1 - 40 / teeth) theta)).
    """
    given = {"tip": "P", "forward_speed": 0.5, "depth": 0.03, **planting}
    machine = eq.load("planetary-planting-arm")
    sun, planet = machine.gears
    return replace(
        machine,
        gears=(sun, replace(planet, teeth=(40, teeth))),
        drive=eq.Drive("carrier", speed),
        planting=Planting(**given),
    )


def planetary_tip(theta: Array, teeth: int = 30) -> Array:
    return np.asarray(
        ARM * np.exp(1j * theta) + FINGER * np.exp(1j * (START + (1 - 40 / teeth) * theta))
    )


def two_arms(apart: float = np.pi, speed: float = 20.0, **planting: Any) -> eq.Machine:
    """The bundled planetary arm, and a second one like it, ahead on the carrier by an angle.

    At theta the second tip is where the first one is at theta + apart.
    """
    given = {"tip": "P", "forward_speed": 0.5, "depth": 0.03, "arms": (PlantingArm("Q"),)}
    machine = eq.load("planetary-planting-arm")
    carrier, idler, planet = machine.links.values()
    ahead = {new: complex(*carrier.points[old]) * np.exp(1j * apart)
             for old, new in (("B", "D"), ("C", "E"))}  # fmt: skip
    points = {**carrier.points, **{name: (z.real, z.imag) for name, z in ahead.items()}}
    first, second = machine.gears
    return replace(
        machine,
        links={
            "carrier": carrier.altered(points=points),
            "idler": idler,
            "planet": planet,
            "idler 2": idler.altered(points={"D": (0.0, 0.0)}),
            "planet 2": planet.altered(points={"E": (0.0, 0.0), "Q": planet.points["P"]}),
        },
        gears=(
            first,
            second,
            replace(first, driven="idler 2"),
            replace(second, driver="idler 2", driven="planet 2", start=START - apart),
        ),
        drive=eq.Drive("carrier", speed),
        planting=Planting(**given | planting),
    )


def twice(speed: float = 12.0, **planting: Any) -> eq.Machine:
    """A crank-rocker whose tip goes into the soil twice a turn."""
    given = {"tip": "P", "forward_speed": 0.4, "depth": 0.048, **planting}
    return eq.Machine(
        "twice",
        eq.Drive("crank", speed),
        {"A": (0.0, 0.0), "D": (0.09, 0.0)},
        {
            "crank": eq.Link({"A": (0.0, 0.0), "B": (0.04, 0.0)}),
            "coupler": eq.Link({"B": (0.0, 0.0), "C": (0.08, 0.0), "P": (-0.06, -0.13)}),
            "rocker": eq.Link({"D": (0.0, 0.0), "C": (0.07, 0.0)}),
        },
        assembly={"C": "left"},
        planting=Planting(**given),
    )


def block() -> eq.Machine:
    """A block in a vertical guide, whose one point is the tip."""
    return eq.Machine(
        "block", eq.Drive("crank", 10.0), {"A": (0.0, 0.0)},
        {
            "block": eq.Link({"C": (0.0, 0.0)}),
            "crank": eq.Link({"A": (0.0, 0.0), "B": (0.03, 0.0)}),
            "rod": eq.Link({"B": (0.0, 0.0), "C": (0.1, 0.0)}),
        },
        assembly={"C": "forward"},
        sliders=(eq.Slider("block", "C", "frame", "A", -np.pi / 2),),
        planting=Planting(tip="C", forward_speed=0.6, depth=0.02),
    )  # fmt: skip


def cycle(machine: eq.Machine, count: int = 20_000) -> Array:
    """Many crank angles over one cycle in the sense of time, (N + 1,)."""
    turns = eq.mechanism.assemble(machine).cycle.turns
    way = np.linspace(0.0, TURN * turns, count * turns + 1)
    return np.asarray(np.sign(machine.drive.speed) * way)


def tip_at(machine: eq.Machine, theta: Any) -> PointMotion:
    assert machine.planting is not None
    return eq.move(machine, np.atleast_1d(theta)).points[machine.planting.tip]


def over_ground(figures: PlantingFigures, theta: Array) -> Array:
    """Place over ground, from where the machine is at crank angle 0."""
    machine = figures.machine
    way = figures["forward_speed"] / figures["speed"] * theta
    return np.asarray(tip_at(machine, theta).place + way)
