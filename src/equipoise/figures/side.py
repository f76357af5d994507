"""Links beside each other, seen along x or y: planes, shafts, bearings and masses."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

import numpy as np

from equipoise.figures.linkage import crank_angle_text
from equipoise.figures.style import short
from equipoise.i18n import say, to_say
from equipoise.mechanism.checks import FRAME
from equipoise.mechanism.dynamics.out_of_plane import contacts, pushing
from equipoise.mechanism.kinematics.motion import move
from equipoise.mechanism.parts.bodies import outlines
from equipoise.mechanism.parts.links import masses_of
from equipoise.results.charts import Axis, Chart, Mark, Panel
from equipoise.signals import Array
from equipoise.symbols.shapes import PIN, Shape, block, circle, cylinder, line, mass, pivot

if TYPE_CHECKING:
    from equipoise.mechanism.kinematics.motion import Motion
    from equipoise.results.analysis import Analysis

ROOM = 0.06
"""Around what is drawn, over its size: for the signs of bearings and masses."""
BARREL = 0.6
"""Part of a cylinder's length that its barrel covers."""
BEYOND = 10.0
"""Units: how far pins reach beyond the middle of what they carry."""


def side(analysis: Analysis, at: Sequence[float] | None = None) -> Chart:
    """The machine along x or y of the frame, by which it reaches less far: z to the right.

    at : crank angles, rad, of which the first is drawn; where they are not given, one at which
        links reach far.
    """
    motion = analysis.motion
    if at is not None:
        motion = move(analysis.machine, at[:1], motion.speed, motion.acceleration)
    view = _View(motion)
    angle = crank_angle_text(float(motion.links[motion.machine.drive.link].angle[view.k]))
    text = {"link": short(motion.machine.drive.link), "angle": angle}
    what = say("Linkage from the side, to scale; angle of {link} in the frame: {angle}", **text)
    keys = [("solid", say("bodies"))] if view.solids else []
    keys += [("mass", say("centre of mass"))] if view.loose else []
    keys += [("room", say("room for mass to be found"))] if view.rooms else []
    caption = to_say("The planes of links, masses and bearings, from the side and to scale.")
    return Chart(
        "side", analysis.machine.title, what, (view.panel(),), keys=tuple(keys), caption=caption
    )


class _View:
    """A machine at one of the crank angles of a motion; places are z + i times the height, m.

    nodes : of each link, the place of every point of it.
    """

    def __init__(self, motion: Motion) -> None:
        self.machine, self.motion, self.k = motion.machine, motion, 0
        spreads = [self._spread(part) for part in "xy"]
        self.axis = "xy"[int(np.argmax([np.max(spread) for spread in spreads]))]
        self.k = int(np.argmax(spreads["xy".index(self.axis)]))
        planes = {
            (body, reaction.at): contact.plane
            for contact, (_, reaction) in zip(
                contacts(motion.linkage), motion.linkage.named_reactions, strict=True
            )
            for body in (contact.on, contact.by)
        }
        self.pins = [(*key, plane) for key, plane in planes.items() if key[1] in motion.points]
        self.nodes = {
            name: {
                point: complex(planes.get((name, point), link.plane_of(point)), self.height(point))
                for point in link.points
            }
            for name, link in self.machine.links.items()
        }
        self.solids, self.loose = [*self._solids()], [*self._loose()]
        self.rooms, self.pushing = [*self._rooms()], [*self._cylinders()]

    def _spread(self, part: str) -> Array:
        """How far links reach along an axis of the frame, (N,)."""
        places = [
            np.stack([self._part(self.motion.points[point].place, part) for point in link.points])
            for link in self.machine.links.values()
        ]
        return np.asarray(np.sum([np.ptp(heights, axis=0) for heights in places], axis=0))

    @staticmethod
    def _part(place: Array, part: str) -> Array:
        return np.asarray(place.real if part == "x" else place.imag)

    def height(self, point: str) -> float:
        return float(self._part(self.motion.points[point].place, self.axis)[self.k])

    def _heights(self, link: str, places: Array) -> Array:
        """Heights of places (n,) in a link's axes, complex, m."""
        first, own = next(iter(self.machine.links[link].points.items()))
        base, turned = (
            self.motion.points[first].place[self.k],
            self.motion.links[link].angle[self.k],
        )
        return self._part(base + (places - complex(*own)) * np.exp(1j * turned), self.axis)

    def _solids(self) -> Iterator[Shape]:
        """Bodies as boxes: as thick as they are, in their planes."""
        for name, link in self.machine.links.items():
            for body in link.bodies:
                for corners, radius in outlines(body, link.points)[:1]:
                    heights = self._heights(name, np.array(corners))
                    low, high = float(heights.min()) - radius, float(heights.max()) + radius
                    z = link.plane if body.plane is None else body.plane
                    yield _box("solid", z, body.thickness, low, high)

    def _rooms(self) -> Iterator[Shape]:
        """Where balancing may add masses: boxes, or a ring where there is room without limit."""
        balance = self.machine.balance
        for item in balance.masses if balance is not None else ():
            link, weight = self.machine.links[item.link], item.weight
            z = link.plane if weight.plane is None else weight.plane
            high = self.height(item.at)
            if np.isinf(weight.radius):
                yield circle("room", complex(z, high), grown=BEYOND)
            else:
                ends = high - weight.radius, high + weight.radius
                yield _box("room", z, weight.thickness, *ends)

    def _cylinders(self) -> Iterator[Shape]:
        """Cylinders that drive, in their planes."""
        for item, drive in zip(pushing(self.motion.linkage), self.machine.pushers, strict=True):
            if drive.between is None:
                continue
            a, b = (complex(item.plane, self.height(point)) for point in drive.between)
            if length := abs(b - a):
                way = (b - a) / length
                rod, barrel = cylinder(BARREL * length, BARREL * length)
                for shape, base, turn in ((rod, b, -way), (barrel, a, way)):
                    places, offsets = base + turn * shape.places, turn * shape.offsets
                    yield Shape(shape.role, places, offsets, shape.closed)

    def _loose(self) -> Iterator[complex]:
        """Centres of masses of which no outline is known."""
        for name, link in self.machine.links.items():
            has_outline = [bool(outlines(body, link.points)) for body in link.bodies] or [False]
            for (own, center, z), outlined in zip(masses_of(link), has_outline, strict=False):
                if own and not outlined:
                    yield complex(z, self._heights(name, np.array([center]))[0])

    def _bars(self, name: str, role: str) -> Iterator[Shape]:
        """A link: upright in its plane, and along z through what it holds beside it, and to its
        bearings.
        """
        z, nodes = self.machine.links[name].plane, self.nodes[name]
        heights = [node.imag for node in nodes.values()]
        yield line(role, complex(z, min(heights)), complex(z, max(heights)))
        for point, node in nodes.items():
            planes = [
                bearing.plane for bearing in self.machine.bearings.values() if bearing.link == name
            ]
            ends = [node.real, z, *(planes if point in self.machine.frame else ())]
            if (low := min(ends)) < (high := max(ends)):
                places = np.array([complex(low, node.imag), complex(high, node.imag)])
                beyond = np.array([-BEYOND * (low < z), BEYOND * (high > z)], complex)
                yield Shape(role, places, beyond)

    def signs(self) -> Iterator[Shape]:
        """Bodies behind, then links, then what holds them."""
        yield from self.solids
        yield from self.rooms
        for name in self.machine.links:
            for role in ("edge", "body"):
                yield from self._bars(name, role)
        yield from self.pushing
        yield from self._supports()
        for body, point, plane in self.pins:
            if body != FRAME:
                yield circle("pin", complex(plane, self.height(point)), grown=PIN)
        for center in self.loose:
            yield from mass(center)

    def _supports(self) -> Iterator[Shape]:
        """Blocks in guides, bearings, and pins in the frame where the machine has no bearings."""
        for slider in self.machine.sliders:
            place = self.nodes[slider.link][slider.point]
            for shape in block():
                yield Shape(shape.role, shape.places + place, 1j * shape.offsets, shape.closed)
        for name, nodes in self.nodes.items():
            planes = [
                bearing.plane for bearing in self.machine.bearings.values() if bearing.link == name
            ]
            for point in (point for point in nodes if point in self.machine.frame):
                for plane in planes or [nodes[point].real]:
                    yield from pivot(complex(plane, nodes[point].imag))

    def _names(self) -> Iterator[Mark]:
        for name, nodes in self.nodes.items():
            heights = [node.imag for node in nodes.values()]
            at = complex(self.machine.links[name].plane, (min(heights) + max(heights)) / 2)
            yield Mark.of(at, short(name), "lines", 20.0, sign=False, distance=8.0)
        for name, bearing in self.machine.bearings.items():
            (pin,) = self.nodes[bearing.link].keys() & self.machine.frame.keys()
            at = complex(bearing.plane, self.nodes[bearing.link][pin].imag)
            yield Mark.of(at, short(name), "ink", -60.0, sign=False, distance=8.0)

    def panel(self) -> Panel:
        """The view with its axes and names."""
        places = [node for nodes in self.nodes.values() for node in nodes.values()]
        places += [
            *self.loose,
            *(bearing.plane + 1j * 0 for bearing in self.machine.bearings.values()),
        ]
        every = np.concatenate(
            [places, *(solid.places for solid in (*self.solids, *self.rooms, *self.pushing))]
        )
        low, high = (complex(end(every.real), end(every.imag)) for end in (np.min, np.max))
        room = ROOM * abs(high - low) * (1 + 1j)
        size = [abs(high - low)]
        x = Axis.of(say("{axis} in the frame", axis="z"), "length", size, room=0.0)
        y = Axis.of(say("{axis} in the frame", axis=self.axis), "length", size, room=0.0)
        return Panel(
            x,
            y,
            marks=tuple(self._names()),
            equal=True,
            zero=False,
            signs=tuple(self.signs()),
            always_shown=(low - room, high + room),
        )


def _box(role: str, z: float, thickness: float | None, low: float, high: float) -> Shape:
    """What is so thick and so high, around z."""
    half = (thickness or 0.0) / 2
    ends = ((z - half, low), (z + half, low), (z + half, high), (z - half, high))
    return line(role, *(complex(*end) for end in ends), closed=True)
