"""How a belt pulls on its pulleys, and whether it can lie about them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from equipoise.errors import ModelError
from equipoise.i18n import Note
from equipoise.mechanism.assembly.builder import Builder
from equipoise.mechanism.assembly.joints import Structure, coupling_pins, place_in_file
from equipoise.mechanism.assembly.loops import End, Poses
from equipoise.mechanism.assembly.steps import Reaction, Step, flanked, planar
from equipoise.mechanism.assembly.turned import Turned
from equipoise.mechanism.formulas import joint_kernels
from equipoise.mechanism.formulas.strands import LEFT, RIGHT, Strands
from equipoise.mechanism.parts.belts import Belt
from equipoise.mechanism.parts.couplings import Coupling

TOUCHING = 1e-9
"""Over the distance of the pins: a strand that comes so near to a pin runs through it."""


@dataclass(frozen=True)
class Pull(Turned):
    """What both strands do to the driven pulley, in the carrier's axes.

    radius : of the driven pulley.
    across : force for a unit of effective pull, as the strands differ by it.
    along : what comes to it where the tight strand alone pulls; 0 of a belt with tension, whose
        strands have a constant sum, which `pretensions` tells.
    """

    driver_pin: str
    driven_pin: str
    radius: Any
    across: Any
    along: Any

    couples: ClassVar[bool] = True

    def steps(self, coupling: Coupling, ground: Reaction) -> tuple[Reaction, tuple[Step, ...]]:
        link, name = coupling.driven, coupling.name
        force, couple = f"R({name}/{link})", f"C({name}/{link})"
        push = Reaction(name, coupling.table, link, coupling.driver, self.driven_pin, force, couple)
        numbers = (self.radius, self.across, self.along)
        return push, flanked(push, ground, coupling.carrier, joint_kernels.belt_forces, numbers)

    def place(self, poses: Poses, on: End, carrier: str) -> Any:
        """The driven pulley's pin."""
        return poses[on.body].place_of(on.arm)

    def wrenches(self, poses: Poses, on: End, carrier: str, sense: Any) -> list[tuple[Any, Any]]:
        turn = poses[carrier].turn[0]
        return [(turn * (self.across + sense * self.along), self.radius)]


def pull_of(builder: Builder, joints: Structure, belt: Belt) -> Pull:
    """Where a belt pulls.

    Raises
    ------
    ModelError : its pulleys overlap, or a strand runs through a pin of the carrier.
    """
    driver_pin, driven_pin = coupling_pins(joints, belt)
    points = builder.machine.points_of(belt.carrier)
    start = planar(points[driver_pin])
    strands = belt.strands(planar(points[driven_pin]) - start)
    for problem in _overlapping(belt, strands):
        raise ModelError(place_in_file(joints, belt), problem)
    for pin, bodies in joints.pins.items():
        if belt.carrier not in bodies or pin in (driver_pin, driven_pin):
            continue
        if _runs_through(strands, planar(points[pin]) - start):
            others = [body for body in bodies if body != belt.carrier]
            raise ModelError(
                place_in_file(joints, belt),
                Note(
                    "a strand crosses {link!r}, which turns about {pin} on {carrier!r}; move "
                    "{pin}, or change the radii",
                    link=others[0],
                    pin=pin,
                    carrier=belt.carrier,
                ),
            )
    across = 0.5 * (strands.way(RIGHT) - strands.way(LEFT)) * np.sign(strands.other)
    along = -0.5 * strands.toward if belt.tension is None else 0.0
    return Pull(driver_pin, driven_pin, abs(strands.other), across, along)


def _overlapping(belt: Belt, strands: Strands) -> Iterator[Note]:
    reach = belt.pitch_radii[0] + belt.pitch_radii[1]
    if np.all(strands.distance <= reach):
        yield Note(
            "its pulleys overlap: their pitch radii add up to {reach:.6g} mm, and their pins are "
            "{distance:.6g} mm apart; give smaller ones, or set the pins farther apart",
            reach=1e3 * float(np.max(reach)),
            distance=1e3 * float(np.min(strands.distance)),
        )


def _runs_through(strands: Strands, place: complex) -> bool:
    """Whether a strand runs through a place, from the driver's pin."""
    for side in (LEFT, RIGHT):
        start, _ = strands.ends(side)
        way = (place - start) * np.conj(strands.way(side))
        inside = (way.real >= 0) & (way.real <= strands.length)
        if np.all(inside & (abs(way.imag) <= TOUCHING * strands.distance)):
            return True
    return False
