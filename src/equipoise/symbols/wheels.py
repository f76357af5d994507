"""Pitch curves of gears, as what is drawn of them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import partial
from itertools import repeat
from math import dist

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.i18n import say
from equipoise.mechanism.assembly.joints import Structure, coupling_pins
from equipoise.mechanism.checks import Bodies
from equipoise.mechanism.parts.couplings import Coupling, Law
from equipoise.mechanism.parts.gears import Gear
from equipoise.mechanism.parts.machine import FRAME
from equipoise.symbols.shapes import Array

CORNERS = 180
"""Of a pitch curve that is no circle."""
Curves = Iterator[Array]


@dataclass(frozen=True, eq=False)
class Wheel:
    """The pitch curve of a gear.

    link : what turns with it, maybe the frame.  center : the point on its axis.
    radius : of a circle, or the largest, m.  part : list and name of the coupling that has it.
    curve : (n,) of what is no circle: from the center, in the link's axes, complex, m.
    """

    link: str
    center: str
    radius: float
    part: tuple[str, str]
    curve: Array | None = None


def called(wheels: Sequence[Wheel]) -> str:
    """What these are called together."""
    if any(wheel.curve is not None for wheel in wheels):
        return say("pitch curves of gears")
    if any(wheel.part[0] == Gear.table for wheel in wheels):
        return say("pitch circles of gears")
    return say("pitch circles of pulleys and pinions")


def wheels_of(joints: Structure, bodies: Bodies, angles: Mapping[str, float]) -> Iterator[Wheel]:
    """Gears, pulleys and pinions, of which each has its pin on the carrier.

    angles : of the links in one pose, rad, which tell how curves lie that are no circles.
    """
    for coupling in joints.couplings:
        wheels = [*coupling.circles(partial(_distance, joints, bodies, coupling))]
        shared = [joints.pins_between(body, coupling.carrier) for body, _ in wheels]
        if not all(shared):
            continue  # a sketch may lack a pin
        pins = [points[0] for points in shared]
        curves: Iterable[Array | None] = repeat(None)
        if isinstance(coupling, Gear) and coupling.law is not None:
            driver, driven = (complex(*bodies[coupling.carrier][pin]) for pin in pins)
            curves = _curves(coupling, coupling.law, driver - driven, angles)
        for (body, radius), pin, curve in zip(wheels, pins, curves, strict=False):
            size = radius if curve is None else float(np.max(np.abs(curve)))
            yield Wheel(body, pin, size, (coupling.table, coupling.name), curve)


def _distance(joints: Structure, bodies: Bodies, coupling: Coupling) -> float:
    """Of the pins of driver and driven body, m."""
    points = bodies[coupling.carrier]
    return dist(*(points[pin] for pin in coupling_pins(joints, coupling)))


def _curves(gear: Gear, law: Law, centres: complex, angles: Mapping[str, float]) -> Curves:
    """Corners of driver's and driven gear's curve, in their axes: where the pitch point comes."""
    turned = {FRAME: 0.0, **angles}
    driver, driven = (turned[item] - turned[gear.carrier] for item in (gear.driver, gear.driven))
    offset = driven - law(driver)[0]
    for turns, of_driver in ((1.0, True), (1 / abs(gear.speed_ratio), False)):
        x = np.linspace(0.0, 2 * np.pi * turns, CORNERS, endpoint=False)
        y, ratio, _ = law(x)
        angle, share = (x, ratio) if of_driver else (y + offset, 1.0)
        yield centres * share / (1 - ratio) * np.exp(-1j * angle)
