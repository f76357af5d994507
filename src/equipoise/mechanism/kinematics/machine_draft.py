"""A machine as it is drawn: where each of its links lies; it may lack anything.

What is drawn is held by the pose of each link, so that whatever is still missing follows from the
drawing: the sides of dyads, the start of couplings, the rough position of loops.
"""

from __future__ import annotations

from cmath import exp, phase
from collections.abc import Mapping
from dataclasses import field, replace
from math import cos, hypot, pi, remainder, sin
from typing import Any

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.mechanism.assembly.joints import Structure, joined
from equipoise.mechanism.assembly.linkage import assemble, sides_at_position
from equipoise.mechanism.kinematics.motion import Motion, move
from equipoise.mechanism.parts.couplings import Coupling, Turning, coupling_kinds
from equipoise.mechanism.parts.element_kinds import Element, element_kinds
from equipoise.mechanism.parts.joint_kinds import JointKind
from equipoise.mechanism.parts.machine import (
    FRAME,
    Drive,
    Link,
    Machine,
    Position,
    Slider,
    Vector,
)
from equipoise.quantities import clean, clean_place

TITLE = "Untitled machine"
USUAL_SIZE = 0.1
"""m, of a machine that has no points yet."""
MESHING = 1e-9
"""rad by which the start of a coupling may differ from what is drawn: rounding."""


@dataclass(frozen=True)
class LinkPlacement:
    """Where a link is drawn.

    origin : of its axes, in the frame, m.  angle : of its x axis in the frame, rad.
    """

    origin: complex = 0j
    angle: float = 0.0

    @property
    def turn(self) -> complex:
        return complex(cos(self.angle), sin(self.angle))

    def out(self, place: Vector) -> complex:
        """Where a place in the link's axes is in the frame, m."""
        return self.origin + self.turn * complex(*place)

    def into(self, place: complex) -> complex:
        """Where a place in the frame is in the link's axes, m."""
        return (place - self.origin) * self.turn.conjugate()


STILL = LinkPlacement()
"""Of the frame."""


@dataclass(frozen=True)
class Standing:
    """Links that are pushed, as they are drawn, at whatever crank angle."""

    angles: Mapping[str, float]

    def moved(self, crank_angle: Any) -> dict[str, tuple[Any, Any, Any]]:
        """Angle of each, and its two derivatives, of which nothing is known."""
        values, none = np.ones(np.shape(crank_angle)), np.zeros(np.shape(crank_angle))
        return {link: (angle * values, values, none) for link, angle in self.angles.items()}


@dataclass(frozen=True, eq=False)
class MachineDraft:
    """A machine that may be unfinished.

    poses : of every link.  drive : None where none has been chosen.
    phase : crank angle at which it is drawn (rad), where it is not the angle of a link.
    rest : what a machine has besides, by its field.
    """

    frame: Mapping[str, Vector] = field(default_factory=dict)
    links: Mapping[str, Link] = field(default_factory=dict)
    poses: Mapping[str, LinkPlacement] = field(default_factory=dict)
    drive: Drive | None = None
    sliders: tuple[Slider, ...] = ()
    rest: Mapping[str, Any] = field(default_factory=lambda: {"title": TITLE})
    phase: float = 0.0

    @property
    def crank_angle(self) -> float:
        """At which it is drawn, rad; 0 without a drive."""
        if self.drive is None:
            return 0.0
        return self.poses[self.drive.crank].angle if self.drive.crank else self.phase

    @property
    def bodies(self) -> dict[str, Mapping[str, Vector]]:
        """Points of the frame and of every link, in their own axes."""
        return {FRAME: self.frame} | {name: link.points for name, link in self.links.items()}

    def pose(self, body: str) -> LinkPlacement:
        """Where a link, or the frame, is drawn."""
        return STILL if body == FRAME else self.poses[body]

    @property
    def places(self) -> dict[str, complex]:
        """Every point in the frame, m; those of the frame first."""
        values: dict[str, complex] = {}
        for body, points in self.bodies.items():
            for name, place in points.items():
                values.setdefault(name, self.pose(body).out(place))
        return values

    def holders(self, point: str) -> list[str]:
        """The bodies that have a point."""
        return [body for body, points in self.bodies.items() if point in points]

    @property
    def joints(self) -> Structure:
        couplings = (item for key in coupling_kinds(Machine) for item in self.rest.get(key, ()))
        riders = {
            element.name: element.rider()
            for element in self.elements
            if isinstance(element, JointKind)
        }
        return joined(self.bodies, self.sliders, tuple(couplings), riders)

    @property
    def elements(self) -> list[Element]:
        """What declares itself, as far as the bodies and points that it names are there."""
        there = self.bodies
        ones = (item for table in element_kinds(Machine) for item in self.rest.get(table, ()))
        return [item for item in ones if {*item.bodies} <= there.keys()
                and all(point in there[body] for body, point in item.points)]  # fmt: skip

    @property
    def driven(self) -> list[str]:
        """Links with a drive, as far as they are there."""
        drives = (*([self.drive] if self.drive else ()), *self.rest.get("drives", ()))
        return [drive.link for drive in drives]

    @property
    def mobility(self) -> int:
        """Count of free motions; each drive commands one of them."""
        return self.joints.mobility

    @property
    def size(self) -> float:
        """Largest distance of a place from the origin, m."""
        return max(map(abs, self.places.values()), default=0.0) or USUAL_SIZE

    @property
    def extent(self) -> float:
        """Size of what is drawn, m."""
        places = [*self.places.values()]
        if not places:
            return USUAL_SIZE
        parts = [z.real for z in places], [z.imag for z in places]
        return max(max(part) - min(part) for part in parts) or USUAL_SIZE

    def to_machine(self) -> Machine:
        """What is drawn as a machine, with the place where it is drawn.

        Raises
        ------
        ModelError : what it has contradicts itself, or it has no drive.
        """
        drive = self.drive or self._usual_drive()
        return Machine(
            drive=drive,
            frame=self.frame,
            links=self.links,
            sliders=self.sliders,
            position=self._position(),
            **{**self.rest, **self._meshed(drive)},
        )

    def settled(self) -> Machine:
        """What is drawn as a machine that has the sides of its dyads as they are drawn.

        Raises
        ------
        EquipoiseError : it does not make a linkage; the sentence says why.
        """
        machine = self.to_machine()
        pushed = {pusher.link: self.pose(pusher.link).angle for pusher in machine.pushers}
        turning = Standing(pushed) if pushed else None
        machine = replace(machine, assembly=sides_at_position(machine, turning))
        if any(coupling.slides for coupling in machine.couplings):
            machine = self._engaged(machine)
        loops = any(group.kind == "loops" for group in assemble(machine).groups)
        return machine if loops else replace(machine, position=None)

    def _position(self) -> Position:
        points = {name: clean_place(place, self.size) for name, place in self.places.items()
                  if any(name in link.points for link in self.links.values())}  # fmt: skip
        angles = {name: clean(pose.angle) for name, pose in self.poses.items()}
        return Position(clean(self.crank_angle), points, angles)

    def travel(self, slider: Slider) -> float:
        """How far a slider is along its guide, m."""
        way = self.places[slider.point] - self.places[slider.through]
        return (way / exp(1j * (slider.direction + self.pose(slider.on).angle))).real

    def _meshed(self, drive: Drive) -> dict[str, tuple[Turning, ...]]:
        """Couplings of pinned links, by their lists, that start so that what they drive comes to
        where it is drawn, as far as that is known.
        """
        angles = {FRAME: (0.0, 0.0)}  # at crank angle 0, and as drawn
        for given in (drive, *self.rest.get("drives", ())):
            if given.link in self.links and not given.pushes:
                angles[given.link] = float(given.turned(0.0)[0]), self.pose(given.link).angle
        kinds = coupling_kinds(Machine).items()
        lists = [table for table, kind in kinds if issubclass(kind, Turning)]
        turnings: list[Turning] = [item for table in lists for item in self.rest.get(table, ())]
        left = [*range(len(turnings))]
        while ready := [k for k in left if _known(turnings[k], angles)]:
            k = ready[0]
            left.remove(k)
            entry, start = turnings[k], turnings[k].start
            way = _way(entry, angles[entry.driver], angles[entry.carrier])
            start_drawn = self.pose(entry.driven).angle - way
            if abs(remainder(start_drawn - start, 2 * pi)) > MESHING:
                start = clean(remainder(start_drawn, 2 * pi), "angle")
                turnings[k] = entry.started(start)
            angles[entry.driven] = start, start + way
        return {key: tuple(item for item in turnings if item.list_name == key) for key in lists}

    def _engaged(self, machine: Machine) -> Machine:
        """With couplings of what slides that start so that what they drive comes to where it is
        drawn.
        """
        motion = move(machine, np.array([self.crank_angle]))
        engaged: dict[str, Any] = {}
        for table in coupling_kinds(type(machine)):
            items = getattr(machine, table)
            if any(item.slides for item in items):
                engaged[table] = tuple(
                    self._put(item, motion) if item.slides else item for item in items
                )
        return replace(machine, **engaged)

    def _put(self, coupling: Coupling, motion: Motion) -> Coupling:
        driven = coupling.driven
        if driven == coupling.slides:
            ends = (driven, coupling.carrier)
            slider = next(slider for slider in self.sliders if (slider.link, slider.on) == ends)
            off = self.travel(slider) - float(motion.sliders[slider.name].travel[0])
            in_mesh = abs(off) <= MESHING * abs(coupling.foot)
            start = clean(coupling.start + off, "length")
        else:
            turned = self.pose(driven).angle - float(motion.links[driven].angle[0])
            off = remainder(turned, 2 * pi)
            in_mesh, start = abs(off) <= MESHING, clean(coupling.start + off)
        return coupling if in_mesh else coupling.started(start)

    def _usual_drive(self) -> Drive:
        """In the place of one that has not been chosen."""
        return Drive(next(iter(self.links), ""), 0.0)


def _known(turning: Turning, angles: Mapping[str, tuple[float, float]]) -> bool:
    """Whether its driver and its carrier stand where it is known, and what it drives does not."""
    return {turning.driver, turning.carrier} <= angles.keys() and turning.driven not in angles


def _way(turning: Turning, driver: tuple[float, float], carrier: tuple[float, float]) -> float:
    """How far a driven link turns while driver and carrier turn from one angle to another."""
    kernel, numbers = turning.relation
    before, after = (
        float(kernel(angle, 0.0, 0.0, other, 0.0, 0.0, *numbers, 0.0)[0])
        for angle, other in zip(driver, carrier, strict=True)
    )
    return after - before


def pose_between(start: complex, end: complex) -> LinkPlacement:
    """Of a link whose x axis points from one place of the frame (m) to another."""
    return LinkPlacement(start, phase(end - start))


def length_between(start: complex, end: complex) -> float:
    """Distance of two places, m, rounded to the digits of a file."""
    way = end - start
    return clean(hypot(way.real, way.imag), "length")
