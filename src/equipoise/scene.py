"""What there is to draw of a machine: for pictures, animations and the live page."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from equipoise.mechanism import kernels
from equipoise.mechanism.joints import gear_pins
from equipoise.mechanism.model import FRAME, Machine
from equipoise.mechanism.motion import Motion

Array = np.ndarray[Any, Any]


@dataclass(frozen=True)
class Body:
    """A link: its points, and those of them that lie around it.

    outline : one name for a point, two for a bar, more for a plate, counterclockwise.
    """

    name: str
    points: tuple[str, ...]
    outline: tuple[str, ...]


@dataclass(frozen=True)
class Wheel:
    """The pitch circle of a gear.

    link : what turns with it, maybe the frame.  center : the point in its middle.  radius : m.
    """

    link: str
    center: str
    radius: float


@dataclass(frozen=True, eq=False)
class Guide:
    """A sliding joint.

    point : of the block.  way : direction of its line, (N,) complex of size 1.
    """

    name: str
    point: str
    way: Array


@dataclass(frozen=True, eq=False)
class Scene:
    """A machine at N crank angles.

    crank_angle : (N,) rad.
    places : every point by name, those of the frame first; (N,) complex, m.
    pins : points that bodies share.
    mass_centers : of links whose mass is known; (N,) complex, m.
    springs : ends of each, on its link and on the frame, as names of points.
    """

    crank_angle: Array
    frame: tuple[str, ...]
    bodies: tuple[Body, ...]
    places: Mapping[str, Array]
    pins: frozenset[str]
    mass_centers: Mapping[str, Array]
    wheels: tuple[Wheel, ...]
    guides: tuple[Guide, ...]
    springs: tuple[tuple[str, str], ...]

    @classmethod
    def of(cls, motion: Motion) -> Scene:
        """Everything of a motion that can be seen."""
        machine, joints = motion.machine, motion.linkage.joints
        places = {name: point.place for name, point in motion.points.items()}
        return cls(
            motion.crank_angle,
            tuple(machine.frame),
            tuple(_bodies(machine)),
            places,
            frozenset(joints.pins),
            {name: center.place for name, center in motion.mass_centers.items()},
            tuple(_wheels(motion)),
            tuple(_guides(motion)),
            tuple((spring.point, spring.to) for spring in machine.springs),
        )

    @property
    def box(self) -> tuple[complex, complex]:
        """Lower left and upper right corner of all places and wheels, m."""
        low, high = [], []
        for place in (*self.places.values(), *self.mass_centers.values()):
            low.append(complex(place.real.min(), place.imag.min()))
            high.append(complex(place.real.max(), place.imag.max()))
        for wheel in self.wheels:
            center, reach = self.places[wheel.center], wheel.radius * (1 + 1j)
            low.append(complex(center.real.min(), center.imag.min()) - reach)
            high.append(complex(center.real.max(), center.imag.max()) + reach)
        return (
            complex(min(z.real for z in low), min(z.imag for z in low)),
            complex(max(z.real for z in high), max(z.imag for z in high)),
        )


def _bodies(machine: Machine) -> Iterator[Body]:
    for name, link in machine.links.items():
        named = {complex(*place): point for point, place in reversed(list(link.points.items()))}
        around = tuple(named[complex(place)] for place in hull(np.array(list(named))))
        yield Body(name, tuple(link.points), around)


def _wheels(motion: Motion) -> Iterator[Wheel]:
    joints = motion.linkage.joints
    for gear in joints.gears:
        driver, driven = gear_pins(joints, gear)
        carrier = motion.machine.points_of(gear.carrier)
        apart = abs(complex(*carrier[driver]) - complex(*carrier[driven]))
        radius = apart / abs(1 - gear.speed_ratio)
        yield Wheel(gear.driver, driver, radius * abs(gear.speed_ratio))
        yield Wheel(gear.driven, driven, radius)


def _guides(motion: Motion) -> Iterator[Guide]:
    for slider in motion.machine.sliders:
        angle = motion.links[slider.on].angle if slider.on != FRAME else 0 * motion.crank_angle
        yield Guide(slider.name, slider.point, np.exp(1j * (angle + slider.direction)))


def hull(places: Array) -> Array:
    """Corners of the smallest convex outline around places, counterclockwise."""
    ordered = sorted({complex(place) for place in places}, key=lambda z: (z.real, z.imag))
    if len(ordered) < 3:
        return np.array(ordered)
    size = abs(ordered[-1] - ordered[0])
    chains = []
    for row in (ordered, ordered[::-1]):
        chain: list[complex] = []
        for place in row:
            while len(chain) > 1 and (
                kernels.cross(chain[-1] - chain[-2], place - chain[-2]) <= 1e-9 * size**2
            ):
                chain.pop()
            chain.append(place)
        chains += chain[:-1]
    return np.array(chains)
