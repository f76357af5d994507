"""Where a counterweight may lie: what of a machine comes near a link's pivot, at any crank angle.

Pins and shafts are taken to reach through every plane.  Links are where they are declared
to be: the outlines of their bodies, or straight lines between their points.  Where no planes are
declared, a link is taken to lie beside those that it is pinned to and those that it passes over,
and in one plane with all others.  There a weight may lie in a plane of its own too, on the side of
its link where no other link is: pins that move freely end before it, shafts and pins of the frame,
and pins that are guided along it, do not.

How far the room reaches, if nothing is in the way, is assumed from the lengths of the links.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import field, replace
from functools import cached_property
from itertools import combinations, pairwise

import numpy as np

from equipoise.balancing.policy import (
    CLEARANCE,
    LARGEST_PLATE,
    LEAST_CLEARANCE,
    OVER_SOIL,
    REACH_OF_CRANK,
    REACH_OF_LARGEST_LINK,
    REACH_OF_LINK,
    ROOM_ABOUT_PIN,
    THICKEST_PLATE,
    THICKNESS_OF_LINK,
    THICKNESS_OF_REACH,
)
from equipoise.balancing.rounding import NEARLY
from equipoise.dataclass import dataclass
from equipoise.mechanism.assembly.steps import size_of_bodies, size_of_links
from equipoise.mechanism.checks import bodies_at
from equipoise.mechanism.kinematics.motion import Motion, move
from equipoise.mechanism.kinematics.tip import surface_of
from equipoise.mechanism.parts.bodies import Body, outlines
from equipoise.mechanism.parts.links import Link
from equipoise.mechanism.parts.machine import Machine
from equipoise.signals import Array
from equipoise.symbols.scene import wheels_of

ANGLES, EDGE_SAMPLES, CIRCLE_SAMPLES = 120, 9, 24
"""Crank angles in a turn at which bodies are looked at; places on an edge, and on a circle."""
DIRECTIONS = 360
"""In which the room is known: whole degrees."""


@dataclass(frozen=True, eq=False)
class Room:
    """Room about the pivot of a link.

    link, at : the link, and its point in the frame.  plane : z of the weight's middle, m; None for
        the link's own.
    reach : (360,) m, how far out a weight may lie, by direction in the link's axes in degrees.
    own_pins : (K,) complex, m, further pins of the link itself, seen from the pivot.
    own_clearances : (K,) m, from the middle of each of these.
    most_thick : m, of a plate.  clearance : m, from the edges of bodies.
    assumed : m, how far it is taken to reach where nothing is in the way.
    beside : of a room in a plane of its own: pins that come into it where they are in its plane,
        and how near they come to the pivot, m.
    beside_links : the same of links.
    """

    link: str
    at: str
    plane: float | None
    reach: Array
    own_pins: Array
    own_clearances: Array
    most_thick: float
    clearance: float
    assumed: float
    neighbors: Mapping[str, float] = field(default_factory=dict)
    beside_links: Mapping[str, float] = field(default_factory=dict)

    @property
    def is_limited_by_assumption(self) -> bool:
        """Whether nothing is in the way in some direction."""
        return self.largest >= self.assumed * (1 - NEARLY)

    @property
    def largest(self) -> float:
        """Largest radius that is free in any direction, m."""
        return float(np.max(self.reach))

    @property
    def hub(self) -> float:
        """Radius about the pivot, m, that own pins fill around it, as eccentrics do; 0 without."""
        around = (
            abs(pin) + clearance
            for pin, clearance in zip(self.own_pins, self.own_clearances, strict=True)
            if abs(pin) < clearance
        )
        return max(around, default=0.0)

    def is_free(self, inner: float, outer: float, direction: Array, width: Array) -> Array:
        """Whether sectors (...) between two radii (m) lie in the room; their middle and width are
        in degrees, in the link's axes.
        """
        reach = self.reach.copy()
        for pin, clearance in zip(self.own_pins, self.own_clearances, strict=True):
            if inner - clearance < abs(pin) < outer + clearance:
                _keep_clear(reach, np.array([pin]), clearance)
        blocked = np.append(0, np.cumsum(np.tile(reach < outer, 3)))
        first = np.floor(direction - width / 2).astype(int) % DIRECTIONS + DIRECTIONS
        last = first + np.minimum(np.ceil(width).astype(int), DIRECTIONS) + 1
        return np.asarray(blocked[last] == blocked[first])


def pivots_of(machine: Machine) -> dict[str, str]:
    """Links that turn about one point of the frame, the driven one first, and that point."""
    by_name = {
        name: pins[0]
        for name, link in machine.links.items()
        if len(pins := [point for point in link.points if point in machine.frame]) == 1
    }
    drive = machine.drive.link
    return {name: by_name[name] for name in sorted(by_name, key=lambda name: name != drive)}


def rooms_about(machine: Machine, link: str, larger: float = 1.0) -> Iterator[Room]:
    """The room about a link's pivot, and that in a plane of its own where that is another.

    larger : times what is assumed, that it reaches.
    """
    yield room_about(machine, link, larger=larger)
    if not machine.has_planes:
        apart = room_in_own_plane(machine, link, larger)
        if apart.neighbors:
            yield apart


def room_about(
    machine: Machine, link: str, plane: float | None = None, larger: float = 1.0
) -> Room:
    """The room about a link's pivot, beside all other links in the weight's plane.

    plane : z of the weight's middle, m; that of the link if None.  larger : times what is assumed,
    that it reaches.
    """
    around = _Surroundings.of(machine, link, larger)
    bodies = [track for _, track in around.bodies(plane)]
    reach = around.reach([*around.pins], bodies)
    # A weight in a plane of its own lies beyond the webs between which the link's pins are.
    own = machine.links[link]
    names = sorted(_joined(machine) & own.points.keys() - {around.at}) if plane is None else []
    center = complex(*own.points[around.at])
    own_pins = np.array([complex(*own.points[pin]) - center for pin in names], complex)
    near_pins = np.minimum(around.clearance, np.abs(own_pins) / 2)
    apart = _from_pins(around.motion)
    own_clear = np.array([apart.get(pin, near_pins[k]) for k, pin in enumerate(names)])
    known = machine.has_planes
    passing = () if known else _nearer(around.slots(), around.pivot, float(np.max(reach)))
    return around.room(
        reach,
        plane=plane,
        own_pins=own_pins,
        own_clearances=own_clear,
        beside_links=dict(passing),
    )


def room_in_own_plane(machine: Machine, link: str, larger: float = 1.0) -> Room:
    """The room about a link's pivot in a plane in which no other link is, which shafts and guided
    pins cross.

    larger : times what is assumed, that it reaches.
    """
    around = _Surroundings.of(machine, link, larger)
    fixed = _through_every_plane(machine)
    reach = around.reach([pin for pin in around.pins if pin in fixed], [])
    most = float(np.max(reach)) + around.clearance
    points = around.motion.points
    pins = [(pin, points[pin].place) for pin in around.pins if pin not in fixed]
    return around.room(
        reach,
        neighbors=_nearer(pins, around.pivot, most),
        beside_links=_nearer(around.bodies(None), around.pivot, most),
    )


@dataclass(frozen=True, eq=False)
class _Surroundings:
    """What is about a link's pivot, whatever plane a weight is in.

    most : m, how far a room is taken to reach.  thick : m, thickest plate.
    """

    motion: Motion
    link: str
    at: str
    most: float
    thick: float

    @classmethod
    def of(cls, machine: Machine, link: str, larger: float) -> _Surroundings:
        motion, at = move(machine, ANGLES), pivots_of(machine)[link]
        most = min(larger * _assumed(motion, link, at), LARGEST_PLATE)
        return cls(motion, link, at, most, _most_thick(machine, link, most))

    @property
    def clearance(self) -> float:
        """From bodies, and pins whose radius is not given, m."""
        return CLEARANCE * size_of_links(self.motion.machine) + LEAST_CLEARANCE

    @property
    def pivot(self) -> complex:
        return complex(*self.motion.machine.frame[self.at])

    @cached_property
    def pins(self) -> tuple[str, ...]:
        """Pins and shafts of others."""
        return tuple(_pins(self.motion, self.link))

    def bodies(self, plane: float | None) -> list[tuple[str, Array]]:
        """Links in the plane of a weight, and where places on them go."""
        return [*_bodies(self.motion, self.link, plane, self.thick)]

    def slots(self) -> list[tuple[str, Array]]:
        """Other links in whose slots something slides, and where these slots go."""
        each = [(name, _slots(self.motion, name)) for name in self.motion.machine.links]
        return [(name, track) for name, tracks in each if name != self.link for track in tracks]

    def reach(self, pins: Sequence[str], bodies: Sequence[Array]) -> Array:
        """How far out (360,) a weight may lie beside pins and places on links, m."""
        motion, machine = self.motion, self.motion.machine
        turn = np.exp(-1j * motion.links[self.link].angle)
        free = np.full(DIRECTIONS, min(self.most, _over_ground(machine, self.pivot)))
        own_wheels, wheels = _wheels(motion, self.link, self.at)
        free = np.minimum(free, min(own_wheels, default=np.inf))
        apart = _from_pins(motion)
        obstacles = [(motion.points[pin].place, apart.get(pin, self.clearance)) for pin in pins]
        obstacles += [(track, self.clearance) for track in (*bodies, *wheels)]
        for places, clear in obstacles:
            relative = (np.broadcast_to(places, turn.shape) - self.pivot) * turn
            _keep_clear(free, relative, clear)
        return np.asarray(np.maximum(free, 0.0))

    def room(
        self,
        reach: Array,
        plane: float | None = None,
        own_pins: Array | None = None,
        own_clearances: Array | None = None,
        neighbors: Mapping[str, float] | None = None,
        beside_links: Mapping[str, float] | None = None,
    ) -> Room:
        """The room of a reach (360,)."""
        return Room(
            self.link,
            self.at,
            plane,
            reach,
            np.array([], complex) if own_pins is None else own_pins,
            np.array([]) if own_clearances is None else own_clearances,
            self.thick,
            self.clearance,
            self.most,
            neighbors or {},
            beside_links or {},
        )


def _nearer(tracks: Iterable[tuple[str, Array]], pivot: complex, most: float) -> dict[str, float]:
    """How near what goes along tracks comes to a pivot, by name, where that is nearer than most."""
    values = dict[str, float]()
    for name, track in tracks:
        way = float(np.min(np.abs(track - pivot)))
        if way < most:
            values[name] = min(way, values.get(name, way))
    return values


def _assumed(motion: Motion, link: str, at: str) -> float:
    """How far a counterweight on a link reaches from its pivot where nothing is in the way, m."""
    machine = motion.machine
    size, reach = size_of_links(machine), _reach(machine.links[link], at)
    turned = motion.links[link].angle
    if abs(turned[-1] - turned[0]) > np.pi and machine.crank_turns:
        return max(
            reach, REACH_OF_LARGEST_LINK * size, min(REACH_OF_CRANK * reach, _swept(motion, at))
        )
    return max(
        reach,
        REACH_OF_LARGEST_LINK * size,
        min(REACH_OF_LINK * reach, REACH_OF_LINK * REACH_OF_LARGEST_LINK * size),
    )


def _swept(motion: Motion, at: str) -> float:
    """Farthest that any point or centre of mass of a link comes from a pivot, m."""
    machine = motion.machine
    pivot = complex(*machine.frame[at])
    tracks = [
        motion.points[point].place for link in machine.links.values() for point in link.points
    ]
    centers = {name: link.center_of_mass for name, link in machine.links.items()}
    tracks += [_track(motion, name, complex(*center)) for name, center in centers.items() if center]
    return max(float(np.max(np.abs(track - pivot))) for track in tracks)


def _through_every_plane(machine: Machine) -> set[str]:
    """Pins and shafts of the frame, and pins that are guided along it."""
    return {*machine.frame, *(slider.point for slider in machine.sliders if slider.on == "frame")}


def rooms_of_planes(machine: Machine) -> Iterator[tuple[Room, Room]]:
    """Both ends of a shaft with pins in several planes: a couple of weights, one at each end.

    Weights lie halfway between the outermost pin and the bearing beyond it, or, where there is
    none, as far outside as half the least distance of two pins.
    """
    for link in pivots_of(machine):
        planes = sorted({*machine.links[link].planes.values(), *_planes_at(machine, link)})
        if len(planes) < 2:
            continue
        bearing_planes = [
            bearing.plane for bearing in machine.bearings.values() if bearing.link == link
        ]
        gap = min(b - a for a, b in pairwise(planes)) / 2
        low = max((z for z in bearing_planes if z < planes[0]), default=planes[0] - 2 * gap)
        high = min((z for z in bearing_planes if z > planes[-1]), default=planes[-1] + 2 * gap)
        ends = ((planes[0] + low) / 2, (planes[-1] + high) / 2)
        most = min(planes[0] - low, high - planes[-1]) / 2
        rooms = [room_about(machine, link, plane) for plane in ends]
        first, second = (replace(room, most_thick=min(room.most_thick, most)) for room in rooms)
        yield first, second


def _planes_at(machine: Machine, link: str) -> Iterator[float]:
    """Planes in which other links are pinned to a link."""
    for name, other in machine.links.items():
        for point in machine.links[link].points.keys() & other.points.keys():
            if name != link and point not in machine.frame:
                yield other.plane_of(point)


def _keep_clear(reach: Array, relative: Array, clearance: float) -> None:
    """Cut the room where something comes, at places seen from the pivot (N,), m.

    Between two crank angles it is no farther from one of them than half of its way.
    """
    step = float(np.max(np.abs(np.diff(np.append(relative, relative[0])))))
    clear = clearance + step / 2
    relative = relative[np.abs(relative) - clear < np.max(reach)]  # others cut nothing
    away = np.abs(relative)
    ahead = np.degrees(np.angle(relative)) % 360
    half = np.degrees(np.arcsin(np.minimum(1.0, clear / np.maximum(away, clear))))
    half = np.where(away > clear, half, 180.0)
    apart = np.abs((np.arange(DIRECTIONS)[:, None] - ahead + 180) % 360 - 180)
    free = np.where(apart <= half + 1, away - clear, np.inf)
    np.minimum(reach, np.min(free, axis=1, initial=np.inf), out=reach)


def _joined(machine: Machine) -> set[str]:
    """Points of pins and shafts; those of guides only say where a line is."""
    return {name for name, bodies in bodies_at(machine.bodies).items() if len(bodies) > 1}


def _from_pins(motion: Motion) -> dict[str, float]:
    """Clearance of a counterweight from the middle of each pin whose radius is given, m."""
    radii = motion.linkage.pin_radii
    return {point: radius + LEAST_CLEARANCE for point, radius in radii.items()}


def _pins(motion: Motion, link: str) -> Iterator[str]:
    """Pins and shafts that are none of the link's own."""
    machine = motion.machine
    own = machine.links[link].points
    here = [machine.frame[name] for name in own if name in machine.frame]
    for name in sorted(_joined(machine) - own.keys()):
        if machine.frame.get(name) not in here:
            yield name


def _bodies(
    motion: Motion, link: str, plane: float | None, thick: float
) -> Iterator[tuple[str, Array]]:
    """Other links that lie in the plane of a weight on a link, and where places on them go."""
    machine = motion.machine
    known, own = machine.has_planes, machine.links[link]
    z = own.plane if plane is None else plane
    for name, other in machine.links.items():
        if name == link or (not known and own.points.keys() & other.points.keys()):
            continue
        tracks = []
        solids: list[Body | None] = [body for body in other.bodies if body.shape != "point"]
        for body in solids or [None]:
            there = other.plane if body is None or body.plane is None else body.plane
            across = 0.0 if body is None else body.thickness or body.outer_diameter or 0.0
            if not known or abs(there - z) < (thick + across) / 2:
                tracks += [_track(motion, name, place) for place in outline_of(other, body)]
        if not known or abs(other.plane - z) < thick / 2:
            tracks += _slots(motion, name)
        if known or not _pass_over(motion, link, tracks):
            yield from ((name, track) for track in tracks)


def _slots(motion: Motion, link: str) -> list[Array]:
    """Where slots of a link go, as long as what slides in them needs."""
    tracks = []
    for slider in motion.machine.sliders:
        if slider.on != link:
            continue
        turned = np.exp(1j * (motion.links[link].angle + slider.direction))
        offset = motion.points[slider.point].place - motion.points[slider.through].place
        along = np.real(offset / turned)
        way = np.exp(1j * slider.direction)
        start = complex(*motion.machine.links[link].points[slider.through])
        ends = (complex(start + way * end) for end in (np.min(along), np.max(along)))
        tracks += [_track(motion, link, place) for place in _between(*ends)]
    return tracks


def _wheels(motion: Motion, link: str, at: str) -> tuple[list[float], list[Array]]:
    """Radii of gears and pulleys about a link's pivot, beyond which belts and other gears are; and
    places on other gears and pulleys.
    """
    machine, own, others = motion.machine, list[float](), list[Array]()
    angles = {name: float(link.angle[0]) for name, link in motion.links.items()}
    for wheel in wheels_of(motion.linkage.joints, machine.bodies, angles):
        if (wheel.link, wheel.center) == (link, at):
            curve = wheel.curve
            own.append(wheel.radius if curve is None else float(np.min(np.abs(curve))))
        elif wheel.link != link:
            turned = 2 * np.pi * np.arange(CIRCLE_SAMPLES) / CIRCLE_SAMPLES
            edge = wheel.radius * np.exp(1j * turned)
            tracks = [motion.points[wheel.center].place + place for place in edge.tolist()]
            others += [] if _pass_over(motion, link, tracks) else tracks
    return own, others


def pins_on(motion: Motion, link: str) -> list[tuple[complex, float]]:
    """Place in the axes of a link and radius, m, of each pin on it; assumed where not given."""
    machine, radii = motion.machine, motion.linkage.pin_radii
    assumed, joined = CLEARANCE * size_of_links(machine), _joined(machine)
    points = machine.links[link].points.items()
    return [(complex(*at), radii.get(name, assumed)) for name, at in points if name in joined]


def _pass_over(motion: Motion, link: str, tracks: Sequence[Array]) -> bool:
    """Whether places on another link pass over a link, so that they lie in another plane."""
    line = np.array(
        [_track(motion, link, at) for at in outline_of(motion.machine.links[link], None)]
    )
    clear = CLEARANCE * size_of_links(motion.machine)
    return any(bool(np.any(np.abs(line - track) < clear)) for track in tracks)


def _track(motion: Motion, link: str, place: complex) -> Array:
    """Where a place in a link's axes goes, (N,)."""
    name, point = next(iter(motion.machine.links[link].points.items()))
    arm = (place - complex(*point)) * np.exp(1j * motion.links[link].angle)
    return np.asarray(motion.points[name].place + arm)


def outline_of(link: Link, body: Body | None) -> Iterator[complex]:
    """Places on the outline of a body in the link's axes, m; on straight lines between the points
    of the link where no body is given.
    """
    if body is None:
        points = [complex(*point) for point in link.points.values()]
        for corner, other in combinations(points, 2):
            yield from _between(corner, other)
        if len(points) == 1:
            yield points[0]
        return
    for corners, radius in outlines(body, link.points):
        if radius:
            turned = 2 * np.pi * np.arange(CIRCLE_SAMPLES) / CIRCLE_SAMPLES
            yield from (corners[0] + abs(radius) * np.exp(1j * turned)).tolist()
            continue
        for corner, other in zip(corners, [*corners[1:], corners[0]], strict=True):
            yield from _between(corner, other)


def _between(point: complex, other: complex) -> Iterator[complex]:
    yield from (point + (other - point) * np.linspace(0, 1, EDGE_SAMPLES)).tolist()


def _over_ground(machine: Machine, pivot: complex) -> float:
    """Height of a pivot over what stands on the soil, m."""
    if machine.planting is None:
        return np.inf
    return max(0.0, pivot.imag - surface_of(machine) - OVER_SOIL)


def _reach(link: Link, at: str) -> float:
    """From a link's pivot to its farthest point or the farthest edge of its bodies, m."""
    center = complex(*link.points[at])
    places = [(complex(*point), 0.0) for point in link.points.values()]
    for body in link.bodies:
        for corners, radius in outlines(body, link.points):
            places += [(corner, max(radius, 0.0)) for corner in corners]
    return max(abs(place - center) + radius for place, radius in places)


def pin_of(machine: Machine, link: str) -> str:
    """The link's point in the frame; its first point where it has none."""
    points = machine.links[link].points
    return next((name for name in points if name in machine.frame), next(iter(points)))


def reach_of(machine: Machine, link: str) -> float:
    """Distance of what of a link is farthest from its pin, m: a point, or an edge of a body."""
    own = _reach(machine.links[link], pin_of(machine, link))
    return own or min(ROOM_ABOUT_PIN, float(size_of_bodies(machine)))


def _most_thick(machine: Machine, link: str, reach: float) -> float:
    """Thickest plate that a link can carry, m."""
    bodies = machine.links[link].bodies
    own = max((body.thickness or body.outer_diameter or 0.0 for body in bodies), default=0.0)
    return float(
        min(THICKNESS_OF_REACH * reach, THICKNESS_OF_LINK * own or THICKEST_PLATE, THICKEST_PLATE)
    )
