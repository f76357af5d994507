"""From bodies in space to a machine in the plane: its plane, its pins and its gears."""

from __future__ import annotations

from cmath import phase
from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import field, replace
from itertools import chain, count, permutations
from typing import Any

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.decompositions import lstsq
from equipoise.errors import ModelError, UsageError, at_place, unknown
from equipoise.exchange.reading.imported import Read
from equipoise.exchange.reading.spatial import (
    WORLD,
    Joint3,
    Loop3,
    Solid,
    Space,
    SpatialOptions,
    combined,
)
from equipoise.i18n import Note
from equipoise.mechanism.kinematics.machine_draft import STILL, LinkPlacement, MachineDraft
from equipoise.mechanism.parts.gears import Gear
from equipoise.mechanism.parts.machine import FRAME, Link, Slider, Vector
from equipoise.mechanism.parts.springs import Spring
from equipoise.quantities import clean_place
from equipoise.signals import Array

SAME = 1e-9
"""Distance over the size of the machine below which two places are one: more than the rounding
that a chain of bodies leaves."""


@dataclass(eq=False)
class Pinning:
    """Points of the frame and of links, by number; links that have the same number are pinned.

    poses : of every link.  wishes : names that a point should have, by its number.
    """

    poses: dict[str, LinkPlacement]
    points: dict[str, dict[int, Vector]] = field(init=False)
    wishes: dict[int, list[str]] = field(default_factory=dict)
    size: float = 1e-9

    def __post_init__(self) -> None:
        self.points = {link: {} for link in (FRAME, *self.poses)}

    def pose(self, link: str) -> LinkPlacement:
        return STILL if link == FRAME else self.poses[link]

    def at(self, link: str, place: complex) -> int | None:
        """The point of a link at a place of the frame, m."""
        tolerance, pose = SAME * self.size, self.pose(link)
        result = (item for item, local in self.points[link].items()
                 if abs(pose.out(local) - place) <= tolerance)  # fmt: skip
        return next(result, None)

    def put(self, link: str, place: complex, wish: str) -> int:
        """One more point of a link."""
        number = len(self.wishes)
        local = self.pose(link).into(place)
        self.points[link][number] = (local.real, local.imag)
        self.wishes[number] = [wish]
        self.size = max(self.size, abs(place))
        return number

    def without_rounding(self, local: complex) -> Vector:
        """Coordinates in a link, m, that turning and adding may have left at 1e-33 instead of 0."""
        return clean_place(local, self.size)

    def point_at(self, link: str, place: complex, wish: str) -> int:
        """The point of a link at a place, new where there is none."""
        there = self.at(link, place)
        return self.put(link, place, wish) if there is None else there

    def pin(self, name: str, first: tuple[str, complex], other: tuple[str, complex]) -> None:
        """Make one of a point of each of two links.

        Raises
        ------
        ModelError : the links are pinned elsewhere already.
        """
        remaining, gone = (self.point_at(*end, name) for end in (first, other))
        if remaining == gone:
            return
        if any({remaining, gone} <= points.keys() for points in self.points.values()):
            links = f"{first[0]!r} and {other[0]!r}"
            raise ModelError(
                f"joint {name!r}",
                Note(
                    "{links} are pinned at another place already; a second pin leaves no motion",
                    links=links,
                ),
            )
        self.wishes[remaining] += self.wishes.pop(gone)
        self.wishes[gone] = []
        for points in self.points.values():
            if gone in points:
                points[remaining] = points.pop(gone)

    def named(self) -> dict[int, str]:
        """A name for every point, those of pins first; no two have the same."""
        holders = Counter(chain.from_iterable(self.points.values()))
        taken: dict[str, int] = {}
        for number, _ in sorted(holders.items(), key=lambda item: (-item[1], item[0])):
            taken[next(name for name in self._names(number) if name not in taken)] = number
        return {number: name for name, number in taken.items()}

    def _names(self, number: int) -> Iterator[str]:
        wishes = [item for item, _ in Counter(self.wishes[number]).most_common()]
        yield from wishes
        link = next(link for link, points in self.points.items() if number in points)
        yield f"{link}-{wishes[0]}"
        yield from (f"{wishes[0]} {n}" for n in count(2))


EXACT = 1e-9
"""Share of a factor by which another may differ from it: rounding."""
Chains = Mapping[str, frozenset[str]]


def gears(
    space: Space, link_of: Mapping[str, str], normal: Array, outline: MachineDraft, crank: str
) -> Iterator[Gear]:
    """Pairs of gears that hold the sums of a system.

    link_of : the link of each body.  normal : of the plane, (3,).  crank : the driven link.

    Raises
    ------
    ModelError : there is none on a common carrier that does.
    """
    chains = {body: frozenset(_chain(space, link_of, body)) for body in outline.bodies}
    around = _around(outline)
    moved = {crank, FRAME}
    for name, factors in space.sums:
        wanted = {joint: factor * float(np.sign(space.joints[joint].axis @ normal))
                  for joint, factor in factors.items()}  # fmt: skip
        able = [item for item in _fitting(around, chains, wanted) if item.driven not in moved]
        if not able:
            raise ModelError(
                name,
                Note(
                    "it ties joints together otherwise than a pair of gears on a common "
                    "carrier does; leave it out"
                ),
            )
        gear = min(able, key=lambda gear: (gear.driver not in moved, _joints(outline, gear.driven)))
        moved.add(gear.driven)
        yield gear


def _joints(outline: MachineDraft, link: str) -> int:
    """At how many points a link is pinned; what is driven by gears alone has one."""
    return sum(link in bodies for bodies in outline.joints.pins.values())


def _chain(space: Space, link_of: Mapping[str, str], body: str) -> Iterator[str]:
    """Hinges whose angles add up to that of a link."""
    holding = {link_of[joint.child]: joint for joint in space.joints.values()}
    while body != FRAME and (joint := holding.pop(body, None)) is not None:
        if joint.kind == "hinge":
            yield joint.name
        body = link_of[joint.parent]


def _around(outline: MachineDraft) -> dict[str, list[str]]:
    """Of every body those that share one pin with it, about which they can turn on it."""
    bodies = outline.bodies
    return {body: [other for other in bodies if other != body
                   and len(bodies[body].keys() & bodies[other].keys()) == 1]
            for body in bodies}  # fmt: skip


def _fitting(
    around: Mapping[str, list[str]], chains: Chains, wanted: Mapping[str, float]
) -> Iterator[Gear]:
    """Pairs of gears that hold such a sum."""
    for carrier, bodies in around.items():
        for driven, driver in permutations(bodies, 2):
            three = [chains[body] for body in (driven, driver, carrier)]
            if frozenset().union(*three) - frozenset.intersection(*three) != wanted.keys():
                continue
            ratio = _ratio(wanted, *three)
            if driven != FRAME and ratio not in (None, 0.0, 1.0):
                yield Gear(driver, driven, ratio=ratio, carrier=carrier)


def _ratio(
    wanted: Mapping[str, float],
    driven: frozenset[str],
    driver: frozenset[str],
    carrier: frozenset[str],
) -> float | None:
    """The ratio r of which driven - r driver + (r - 1) carrier is a multiple of a sum, if any."""
    joints = [*(driven | driver | carrier | wanted.keys())]
    values = np.array([[joint in chain for joint in joints] for chain in (driven, driver, carrier)])
    own, geared, carried = values.astype(float)
    sides = np.column_stack([own - carried, carried - geared])
    right = np.array([wanted.get(joint, 0.0) for joint in joints])
    (scale, scaled), _, rank, _ = lstsq(sides, right)
    left = np.abs(sides @ (scale, scaled) - right).max()
    if rank < 2 or left > EXACT * np.abs(right).max() or abs(scale) < EXACT:
        return None
    return float(scaled / scale)


SKEW = 1e-6
"""Of the sine of an angle between axes that are to be parallel: files have six digits at least."""


def planar(space: Space, options: SpatialOptions) -> Read:
    """The machine in its plane of motion.

    Raises
    ------
    ModelError : it does not move in one plane; the sentence names the joint.
    """
    for body in options.still:
        if body not in space.solids:
            raise UsageError(at_place("--frame", unknown(body, space.solids, "body")))
        space.hold(body)
    for pair in options.pins:
        space.loops.append(_closed(space, pair))
    space.tie_shafts()
    flat = _Flat(space)
    sliders = [*flat.joined()]
    names = flat.pins.named()
    points = {link: {names[item]: flat.pins.without_rounding(complex(*place))
                     for item, place in own.items()}
              for link, own in flat.pins.points.items()}  # fmt: skip
    slides = tuple(Slider(link, names[point], on, names[through], *angles)
                   for link, point, on, through, *angles in sliders)  # fmt: skip
    x, y = flat.plane @ np.array(space.gravity)
    rest = {"title": space.title, "gravity": (float(x), float(y)),
            "springs": tuple(flat.springs(names))}  # fmt: skip
    links = {link: Link(points=points[link], **flat.mass(link)) for link in flat.pins.poses}
    outline = MachineDraft(points[FRAME], links, flat.pins.poses, None, slides, rest)
    crank, speed = flat.drive()
    meshing = gears(space, flat.link_of, flat.normal, outline, crank)
    outline = replace(outline, rest={**rest, "gears": tuple(meshing)})
    hints = [
        Note("{body!r} moves freely in the plane; --frame {body!r} holds it still", body=body)
        for body in space.loose
        if body not in options.still
    ]
    if not space.loops:
        hints.append(
            Note('no loop is closed; --pin "A = B" pins two of its bodies or sites together')
        )
    return Read(outline, crank, speed, tuple(space.notes), tuple(hints))


def _closed(space: Space, pair: str) -> Loop3:
    """The pin between two bodies, or points of them, that is given as ``A = B``."""
    known = {point: (name, place) for name, solid in space.solids.items()
             for point, place in {name: solid.axes.origin, **solid.points}.items()}  # fmt: skip
    ends = [part.strip() for part in pair.split("=")]
    if len(ends) != 2:
        raise UsageError(
            at_place(
                "--pin",
                Note(
                    "got {pair!r}; give two bodies or sites such as 'rod = rocker_end'", pair=pair
                ),
            )
        )
    for end in ends:
        if end not in known:
            raise UsageError(at_place("--pin", unknown(end, known, "body or site")))
    (item, place), (other, there) = (known[end] for end in ends)
    return Loop3(pair, (item, other), (place, there))


def _plane(space: Space) -> Array:
    """Directions x and y of the plane (2, 3), in space."""
    hinges = [joint for joint in space.joints.values() if joint.kind == "hinge"]
    if not hinges:
        raise ModelError("", Note("no body turns about a joint; give a linkage with hinges"))
    normal, first = hinges[0].axis, hinges[0].name
    for joint in space.joints.values():
        skew = float(np.linalg.norm(np.cross(joint.axis, normal)))
        if joint.kind == "hinge" and skew > SKEW:
            raise ModelError(
                f"joint {joint.name!r}",
                Note(
                    "its axis is not parallel to that of {first!r}, so the machine does not "
                    "move in one plane; give a planar one",
                    first=first,
                ),
            )
        if joint.kind == "slide" and abs(float(joint.axis @ normal)) > SKEW:
            raise ModelError(
                f"joint {joint.name!r}",
                Note(
                    "it slides out of the plane that is across the axis of {first!r}; give a "
                    "planar machine",
                    first=first,
                ),
            )
    return _axes(normal)


def _axes(normal: Array) -> Array:
    """The first of the axes x and y that is not the normal becomes x, and what is up stays up."""
    first = np.eye(3)[0] if abs(normal[0]) < 0.9 else np.eye(3)[1]
    x = first - (first @ normal) * normal
    x /= np.linalg.norm(x)
    y = np.cross(normal, x)
    up = y[2] if abs(y[2]) > 1e-9 else y[1]
    return np.array([x, y if up > 0 else -y])


def _merged(space: Space) -> dict[str, str]:
    """The link, or the frame, that each body is a part of."""
    root = {name: name for name in space.solids}
    order = {name: number for number, name in enumerate(space.solids)}

    def top(name: str) -> str:
        while root[name] != name:
            name = root[name]
        return name

    for item, other in space.rigid:
        first, second = sorted((top(item), top(other)), key=order.__getitem__)
        root[second] = first
    texts = {name: FRAME if top(name) == WORLD else top(name) for name in root}
    if FRAME in texts and top(FRAME) != WORLD:
        raise ModelError(f"body {FRAME!r}", Note("it moves; give it another name"))
    return texts


class _Flat:
    """What there is in space, in the plane.

    plane : its directions x and y (2, 3).  normal : (3,).  link_of : the link of each body.
    """

    def __init__(self, space: Space) -> None:
        self.space, self.plane, self.link_of = space, _plane(space), _merged(space)
        self.normal = np.cross(*self.plane)
        tops = {link: space.solids[link] for link in self.link_of.values() if link != FRAME}
        self.pins = Pinning({link: self._pose(solid) for link, solid in tops.items()})
        self.points: dict[tuple[str, str], tuple[str, complex]] = {}
        for name, solid in space.solids.items():
            for point, place in solid.points.items():
                link, spot = self.link_of[name], self.flat(place)
                self.points[name, point] = link, spot
                self.pins.point_at(link, spot, _short(point, name, link))

    def flat(self, place: Array) -> complex:
        """A place in space, projected."""
        x, y = self.plane @ place
        return complex(x, y)

    def _pose(self, solid: Solid) -> LinkPlacement:
        """Its axes, along the first of its own that lies in the plane."""
        lying = (item for item in solid.axes.turn.T if abs(item @ self.normal) < SKEW)
        way = self.flat(next(lying, self.plane[0]))
        return LinkPlacement(self.flat(solid.axes.origin), phase(way))

    def joined(self) -> Iterator[tuple[Any, ...]]:
        """Pin what is pinned; of each slider link and number of the point, body and number of the
        guide's, and both angles.
        """
        joints, pins = self.space.joints.values(), self.pins
        for joint in joints:
            pins.size = max(pins.size, abs(self.flat(joint.place)))
        for joint in joints:
            place = self.flat(joint.place)
            on, link = self._apart(f"joint {joint.name!r}", joint.parent, joint.child)
            if joint.kind == "hinge":
                pins.pin(joint.name, (on, place), (link, place))
        for loop in self.space.loops:
            links = self._apart(f"loop {loop.name!r}", *loop.bodies)
            item, other = zip(links, map(self.flat, loop.places), strict=True)
            pins.pin(loop.name, item, other)
        for joint in joints:
            if joint.kind == "slide":
                yield self._slider(joint)

    def _slider(self, joint: Joint3) -> tuple[Any, ...]:
        on, link = self.link_of[joint.parent], self.link_of[joint.child]
        place, way, pins = self.flat(joint.place), phase(self.flat(joint.axis)), self.pins
        point = pins.point_at(link, place, joint.name)
        through = pins.at(on, place)
        if through is None or through == point:
            through = pins.put(on, place, f"{joint.name} guide")
        return link, point, on, through, way - pins.pose(on).angle, pins.pose(link).angle - way

    def _apart(self, where: str, *bodies: str) -> tuple[str, str]:
        """The links of two bodies that are joined."""
        item, other = (self.link_of[body] for body in bodies)
        if item == other:
            raise ModelError(where, Note("both of its bodies are one link; leave it out"))
        return item, other

    def mass(self, link: str) -> dict[str, Any]:
        """Masses of a link, where all parts of it have theirs."""
        parts = [solid for name, solid in self.space.solids.items() if self.link_of[name] == link]
        lumps = [part.lump for part in parts if part.lump is not None]
        if len(lumps) < len(parts):
            return {}
        whole = combined(lumps)
        local = self.pins.pose(link).into(self.flat(whole.center))
        inertia = float(self.normal @ whole.inertia @ self.normal) if whole.mass else 0.0
        if whole.mass < 0 or inertia < 0:
            raise ModelError(
                f"body {link!r}", Note("its mass or its inertia is below 0; give 0 or more")
            )
        center = self.pins.without_rounding(local)
        return {"mass": whole.mass, "center_of_mass": center, "inertia": inertia}

    def springs(self, names: Mapping[int, str]) -> Iterator[Spring]:
        for pull in self.space.pulls:
            ends = sorted((self.points[end] for end in pull.ends), key=lambda end: end[0] == FRAME)
            (link, _), (other, _) = ends
            if other != FRAME or link == FRAME:
                self.space.note(
                    Note("springs that are not between a link and the frame are left out")
                )
                continue
            point, to = (names[self.pins.point_at(*end, "")] for end in ends)
            yield Spring(link, point, to, pull.stiffness, pull.free_length)

    def drive(self) -> tuple[str, float | None]:
        """The driven link and its speed, where it is a joint with the frame that is driven."""
        joint = self.space.joints.get(self.space.driven)
        if joint is None or joint.kind != "hinge" or self.link_of[joint.parent] != FRAME:
            return "", None
        speed = self.space.speed
        sign = float(np.sign(joint.axis @ self.normal))
        return self.link_of[joint.child], None if speed is None else sign * speed


def _short(point: str, *bodies: str) -> str:
    """A point's name without that of its body in front."""
    for body in bodies:
        short = point.removeprefix(body).strip(" _-./")
        if short and point.startswith(body):
            return short
    return point
