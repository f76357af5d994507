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
    on : the body that has the line.
    behind, ahead : how far the line reaches from the block against and along its way, so that it
        holds the block at all N crank angles, (N,), m.
    """

    name: str
    point: str
    way: Array
    on: str
    behind: Array
    ahead: Array


@dataclass(frozen=True, eq=False)
class Scene:
    """A machine at N crank angles.

    crank_angle : (N,) rad.
    places : every point by name, those of the frame first; (N,) complex, m.
    pins : points that bodies share.
    mass_centers : of links whose mass is known; (N,) complex, m.
    springs : ends of each, on its link and on the frame, as names of points.
    angles : of each link, counted on through the turns; (N,) rad.
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
    angles: Mapping[str, Array]

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
            {name: link.angle for name, link in motion.links.items()},
        )

    @property
    def ends(self) -> tuple[str, ...]:
        """Points that join nothing, such as the tip of a coupler."""
        joining = {*self.frame, *self.pins, *(guide.point for guide in self.guides)}
        joining.update(point for spring in self.springs for point in spring)
        return tuple(name for name in self.places if name not in joining)

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
        place = motion.points[slider.point].place
        angle = 0 * motion.crank_angle
        if slider.on != FRAME:
            angle = motion.links[slider.on].angle
            place = place - motion.points[next(iter(motion.machine.points_of(slider.on)))].place
        way = np.exp(1j * (angle + slider.direction))
        along = (place * way.conj()).real
        ends = along - along.min(), along.max() - along
        yield Guide(slider.name, slider.point, way, slider.on, *ends)


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
