"""A machine that is being made: its parts, and where each of them is drawn.

Other than a `Machine` it may lack anything: the drive, links, joints.  What is drawn is held by the
pose of each link, so that whatever is still missing follows from the drawing: the sides of dyads,
the start of gears, the rough position of loops.
"""

from __future__ import annotations

from cmath import phase
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from math import cos, hypot, pi, remainder, sin
from typing import Any

from equipoise.mechanism.joints import Structure, joined
from equipoise.mechanism.linkage import assemble, sides_at_position
from equipoise.mechanism.model import FRAME, Drive, Gear, Link, Machine, Position, Slider, Vector
from equipoise.mechanism.shown_units import ShownUnits
from equipoise.web.design import Counterweight, Design, clean, clean_place
from equipoise.web.edits import Solved, solved

UNTITLED, TITLE = "untitled", "Untitled machine"
USUAL_SIZE = 0.1
"""m, of a machine that has no points yet."""
REST = ("title", "description", "gravity", "loads", "springs", "planting", "support", "rows",
        "balance", "units")  # fmt: skip
"""Fields of a machine that a sketch hands on as they are."""
MESHING = 1e-9
"""rad by which the start of a gear may differ from what is drawn: rounding."""


@dataclass(frozen=True)
class Pose:
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


STILL = Pose()
"""Of the frame."""


@dataclass(frozen=True, eq=False)
class Sketch:
    """A machine that may be unfinished.

    name : of the file.  poses : of every link.  drive : None where none has been chosen.
    rest : what a machine has besides, by its field.  counterweights : as of a `Design`.
    """

    name: str = UNTITLED
    frame: Mapping[str, Vector] = field(default_factory=dict)
    links: Mapping[str, Link] = field(default_factory=dict)
    poses: Mapping[str, Pose] = field(default_factory=dict)
    drive: Drive | None = None
    sliders: tuple[Slider, ...] = ()
    gears: tuple[Gear, ...] = ()
    rest: Mapping[str, Any] = field(default_factory=lambda: {"title": TITLE})
    counterweights: Mapping[str, Counterweight] = field(default_factory=dict)

    @classmethod
    def of(cls, found: Solved, at: int = 0) -> Sketch:
        """A finished machine as it stands at a sample of its crank angle."""
        own, motion = found.design.own, found.motion
        poses = {}
        for name, link in motion.links.items():
            anchor, angle = motion.linkage.anchors[name], float(link.angle[at])
            arm = Pose(0j, angle).out(own.links[name].points[anchor])
            poses[name] = Pose(complex(motion.points[anchor].place[at]) - arm, angle)
        rest = {key: getattr(own, key) for key in REST}
        weights = {name: one for name, one in found.design.counterweights.items() if one.mass}
        return cls(found.design.name, own.frame, own.links, poses, own.drive, own.sliders,
                   own.gears, rest, weights)  # fmt: skip

    @property
    def units(self) -> ShownUnits | None:
        """In which its file has values shown."""
        units: ShownUnits | None = self.rest.get("units")
        return units

    @property
    def crank_angle(self) -> float:
        """At which it is drawn, rad; 0 without a drive."""
        return self.poses[self.drive.link].angle if self.drive else 0.0

    @property
    def bodies(self) -> dict[str, Mapping[str, Vector]]:
        """Points of the frame and of every link, in their own axes."""
        return {FRAME: self.frame} | {name: link.points for name, link in self.links.items()}

    def pose(self, body: str) -> Pose:
        """Where a link, or the frame, is drawn."""
        return STILL if body == FRAME else self.poses[body]

    @property
    def places(self) -> dict[str, complex]:
        """Every point in the frame, m; those of the frame first."""
        found: dict[str, complex] = {}
        for body, points in self.bodies.items():
            for name, place in points.items():
                found.setdefault(name, self.pose(body).out(place))
        return found

    def holders(self, point: str) -> list[str]:
        """The bodies that have a point."""
        return [body for body, points in self.bodies.items() if point in points]

    @property
    def joints(self) -> Structure:
        return joined(self.bodies, self.sliders, self.gears)

    @property
    def mobility(self) -> int:
        """Count of free motions; the drive commands one of them."""
        return self.joints.freedom(self.links, [FRAME])

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

    # -- with other parts --------------------------------------------------------------------------

    def with_points(self, body: str, points: Mapping[str, Vector]) -> Sketch:
        """Other points of a body, in its own axes."""
        if body == FRAME:
            return replace(self, frame=dict(points))
        link = self.links[body].altered(points=dict(points))
        return replace(self, links={**self.links, body: link})

    def with_place(self, body: str, point: str, place: complex, digits: int = 12) -> Sketch:
        """A point of a body at a place of the frame (m), whose coordinates get so many digits."""
        local = clean_place(self.pose(body).into(place), self.size, digits)
        return self.with_points(body, {**self.bodies[body], point: local})

    def with_link(self, name: str, link: Link, pose: Pose) -> Sketch:
        """One more link."""
        links, poses = {**self.links, name: link}, {**self.poses, name: pose}
        return replace(self, links=links, poses=poses)

    def entries(self) -> Iterator[tuple[str, Any]]:
        """What has names of links and points in it, with the field that it stands in."""
        for key in ("sliders", "gears"):
            yield from ((key, one) for one in getattr(self, key))
        for key in ("loads", "springs"):
            yield from ((key, one) for one in self.rest.get(key, ()))

    def with_entries(self, entries: list[tuple[str, Any]]) -> Sketch:
        """The same with other ones."""
        of = {key: tuple(one for name, one in entries if name == key) for key in
              ("sliders", "gears", "loads", "springs")}  # fmt: skip
        rest = {**self.rest, "loads": of["loads"], "springs": of["springs"]}
        return replace(self, sliders=of["sliders"], gears=of["gears"], rest=rest)

    def taking(self, machine: Machine) -> Sketch:
        """The same drawing of a machine whose tables are other ones; a link that is new lies in
        the axes of the frame.
        """
        old = self.drive or self._usual_drive()
        drive = None if self.drive is None and machine.drive == old else machine.drive
        poses = {name: self.poses.get(name, STILL) for name in machine.links}
        rest = {key: getattr(machine, key) for key in REST}
        return replace(self, frame=machine.frame, links=machine.links, poses=poses, drive=drive,
                       sliders=machine.sliders, gears=machine.gears, rest=rest)  # fmt: skip

    def _usual_drive(self) -> Drive:
        """In the place of one that has not been chosen."""
        return Drive(next(iter(self.links), ""), 0.0)

    # -- as a machine ------------------------------------------------------------------------------

    def machine(self) -> Machine:
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
            gears=tuple(self._meshed(drive.link)),
            position=self._position(drive.link),
            **self.rest,
        )

    def finished(self) -> Solved:
        """The machine that is drawn, computed.

        Raises
        ------
        EquipoiseError : it cannot be computed; the sentence says why.
        """
        machine = self.machine()
        machine = replace(machine, assembly=sides_at_position(machine))
        if all(group.kind != "loops" for group in assemble(machine).groups):
            machine = replace(machine, position=None)
        weights = {one: w for one, w in self.counterweights.items() if one in self.links}
        return solved(Design(self.name, machine, weights))

    def _position(self, drive: str) -> Position:
        points = {name: clean_place(place, self.size) for name, place in self.places.items()
                  if any(name in link.points for link in self.links.values())}  # fmt: skip
        angles = {name: clean(pose.angle) for name, pose in self.poses.items()}
        return Position(angles.get(drive, 0.0), points, angles)

    def _meshed(self, drive: str) -> Iterator[Gear]:
        """Gears that start so that they come to where they are drawn, as far as that is known."""
        turned = {FRAME: 0.0}  # since crank angle 0
        if drive in self.links:
            turned[drive] = self.pose(drive).angle
        for gear in self.gears:
            start = gear.start
            if {gear.driver, gear.carrier} <= turned.keys() and gear.driven not in turned:
                carrier = turned[gear.carrier]
                way = carrier + gear.speed_ratio * (turned[gear.driver] - carrier)
                turned[gear.driven] = way
                drawn = self.pose(gear.driven).angle - way
                if abs(remainder(drawn - start, 2 * pi)) > MESHING:
                    start = clean(remainder(drawn, 2 * pi), "angle")
            yield gear if start == gear.start else replace(gear, start=start)


def pose_between(start: complex, end: complex) -> Pose:
    """Of a link whose x axis points from one place of the frame (m) to another."""
    return Pose(start, phase(end - start))


def length_between(start: complex, end: complex) -> float:
    """Distance of two places, m, as a file would tell it."""
    way = end - start
    return clean(hypot(way.real, way.imag), "length")
