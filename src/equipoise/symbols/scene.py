"""What there is to draw of a machine, at a clear crank angle."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import cached_property, partial
from itertools import combinations, pairwise, repeat
from math import copysign, dist
from typing import TYPE_CHECKING, Any

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.errors import EquipoiseError
from equipoise.i18n import say
from equipoise.mechanism.assembly.joints import Structure, coupling_pins
from equipoise.mechanism.checks import Bodies
from equipoise.mechanism.formulas.kernels import cross
from equipoise.mechanism.kinematics.motion import Motion, move
from equipoise.mechanism.kinematics.tip import surface_of
from equipoise.mechanism.parts.bodies import BodyOutline, outlines, place_of
from equipoise.mechanism.parts.couplings import Coupling, DerivedLaw
from equipoise.mechanism.parts.element_kinds import Element
from equipoise.mechanism.parts.machine import FRAME, Drive, FurtherDrive, Link
from equipoise.signals import Array
from equipoise.symbols.carrier import MOUNT, Carrier, SupportSwing
from equipoise.symbols.constraints import constraint_marks
from equipoise.symbols.part_signs import Surroundings, in_order, load_line_marks, signs_of
from equipoise.symbols.shapes import BodyMark, hull, off_outline

if TYPE_CHECKING:
    from equipoise.mechanism.kinematics.motion import Motion

CORNERS = 180
"""Of a pitch curve that is no circle."""


@dataclass(frozen=True, eq=False)
class Wheel:
    """The pitch curve of a gear.

    link : what turns with it, maybe the frame.  center : the point on its axis.
    radius : of a circle, or the largest, m.  part : list and name of the coupling that has it.
    legend : what circles of its kind are called.
    curve : (n,) of what is no circle: from the center, in the link's axes, complex, m.
    """

    link: str
    center: str
    radius: float
    part: tuple[str, str]
    legend: str
    curve: Array | None = None


def called(wheels: Sequence[Wheel]) -> str:
    """What these are called together."""
    if any(wheel.curve is not None for wheel in wheels):
        return say("pitch curves of gears")
    others = (wheel.legend for wheel in wheels if wheel.legend != Coupling.wheels)
    return say(next(others, Coupling.wheels))


def wheels_of(joints: Structure, bodies: Bodies, angles: Mapping[str, float]) -> Iterator[Wheel]:
    """Gears, pulleys and pinions, of which each has its pin on the carrier.

    angles : of the links in one pose, rad, which orient curves that are no circles.
    """
    for coupling in joints.couplings:
        wheels = [*coupling.circles(partial(_distance, joints, bodies, coupling))]
        shared = [joints.pins_between(body, coupling.carrier) for body, _ in wheels]
        if not all(shared):
            continue  # a sketch may lack a pin
        pins = [points[0] for points in shared]
        curves: Iterable[Array | None] = repeat(None)
        if (law := coupling.rolling_law) is not None:
            driver, driven = (complex(*bodies[coupling.carrier][pin]) for pin in pins)
            curves = _curves(coupling, law, driver - driven, angles)
        for (body, radius), pin, curve in zip(wheels, pins, curves, strict=False):
            size = radius if curve is None else float(np.max(np.abs(curve)))
            part = (coupling.list_name, coupling.name)
            yield Wheel(body, pin, size, part, coupling.wheels, curve)


def _distance(joints: Structure, bodies: Bodies, coupling: Coupling) -> float:
    """Of the pins of driver and driven body, m."""
    points = bodies[coupling.carrier]
    return dist(*(points[pin] for pin in coupling_pins(joints, coupling)))


def _curves(
    gear: Coupling, law: DerivedLaw, centres: complex, angles: Mapping[str, float]
) -> Iterator[Array]:
    """Corners of driver's and driven gear's curve, in their axes: where the pitch point comes."""
    turned = {FRAME: 0.0, **angles}
    driver, driven = (turned[item] - turned[gear.carrier] for item in (gear.driver, gear.driven))
    offset = driven - law(driver)[0]
    for turns, of_driver in ((1.0, True), (1 / abs(gear.speed_ratio), False)):
        x = np.linspace(0.0, 2 * np.pi * turns, CORNERS, endpoint=False)
        y, ratio, _ = law(x)
        angle, share = (x, ratio) if of_driver else (y + offset, 1.0)
        yield centres * share / (1 - ratio) * np.exp(-1j * angle)


CLOSE = 1e-9
"""rad and m within which rows cover each other."""
FAR = 1.0
"""Over the size of the linkage: rows that stand further beside it are not drawn."""


@dataclass(frozen=True, eq=False)
class Ghost:
    """Rows that move alike, but not as the linkage of the file.

    numbers : of these rows, from 1.  phase : by which their crank is ahead, rad.
    places : of points by name, (N,) complex, m; none where they stand too far beside the linkage.
    angles : of each link, (N,) rad.
    """

    numbers: tuple[int, ...]
    phase: float
    places: Mapping[str, Array]
    angles: Mapping[str, Array]


@dataclass(frozen=True, eq=False)
class Rows:
    """Rows of a machine.  drawn : numbers of those that move as the linkage of the file."""

    drawn: tuple[int, ...] = ()
    others: tuple[Ghost, ...] = ()

    @property
    def visible(self) -> tuple[Ghost, ...]:
        """Those of the others that are drawn."""
        return tuple(part for part in self.others if part.places)


SINGLE_ROW = Rows()
"""Of a machine that has no rows, or whose rows are not to be seen."""


def rows_of(motion: Motion, size: float) -> Rows:
    """All rows of a machine in motion, whose linkage has a size, m."""
    rows = motion.machine.rows
    if len(rows) < 2:
        return SINGLE_ROW
    alike: dict[tuple[int, ...], list[int]] = {}
    for number, row in enumerate(rows, 1):
        turned = round(float(np.angle(np.exp(1j * row.phase)) / CLOSE))
        place = (round(part / CLOSE) for part in row.offset)
        alike.setdefault((turned, *place), []).append(number)
    in_place = tuple(alike.pop((0, 0, 0), ()))
    others = []
    for numbers in alike.values():
        row = rows[numbers[0] - 1]
        offset, phase = complex(*row.offset), float(np.angle(np.exp(1j * row.phase)))
        if abs(offset) > FAR * size:
            others.append(Ghost(tuple(numbers), phase, {}, {}))
            continue
        there = move(motion.machine, motion.crank_angle + phase, motion.speed, motion.acceleration)
        places = {name: point.place + offset for name, point in there.points.items()}
        angles = {name: link.angle for name, link in there.links.items()}
        others.append(Ghost(tuple(numbers), phase, places, angles))
    return Rows(in_place, tuple(others))


@dataclass(frozen=True)
class DriveSign:
    """The link that is driven, the point that it turns about, and its sense: 1, -1, or 0.

    swings : angles of the link between which it goes to and fro, rad, where it does not turn.
    between : points that a cylinder pushes apart, where one drives.
    """

    link: str
    pivot: str
    sense: int
    swings: tuple[float, float] | None = None
    between: tuple[str, str] | None = None

    @classmethod
    def each(cls, motion: Motion) -> tuple[DriveSign, ...]:
        """Those of a machine in motion."""
        return tuple(cls._of(drive, motion) for drive in motion.machine.driven)

    @classmethod
    def _of(cls, drive: Drive | FurtherDrive, motion: Motion) -> DriveSign:
        angle, pivot = motion.links[drive.link].angle, motion.linkage.anchors[drive.link]
        law = drive.stroke or drive.motion
        if law is None or law.windings:
            ahead = getattr(drive, "ratio", 1.0) if law is None else law.windings
            return cls(drive.link, pivot, int(np.sign(motion.speed * ahead)))
        swings = None if drive.pushes else (float(angle.min()), float(angle.max()))
        return cls(drive.link, pivot, 0, swings, drive.between)


@dataclass(frozen=True)
class LinkOutline:
    """A link: its points, and those of them that lie around it.

    outline : one name for a point, two for a bar, more for a plate, counterclockwise.
    solids : edges of what it is made of, to scale, from the back to the front: corners, complex, m,
        from its first point and in its axes, or the centre and the radius of a circle, which is
        below 0 of an opening.
    """

    name: str
    points: tuple[str, ...]
    outline: tuple[str, ...]
    solids: tuple[BodyOutline, ...] = ()

    @property
    def extent(self) -> Array:
        """Corners of what it is made of, and of boxes around circles, as of `solids`, (n,)."""
        box = np.array([1 + 1j, 1 - 1j, -1 + 1j, -1 - 1j])
        around = [corners[0] + size * box if size else corners for corners, size in self.solids]
        return np.concatenate([np.zeros(0, complex), *map(np.asarray, around)])


@dataclass(frozen=True, eq=False)
class GuideSign:
    """A sliding joint.

    point : of the block.  way : direction of its line, (N,) complex of size 1.
    on : the body that has the line.
    behind, ahead : how far the line reaches from the block against and along its way, so that it
        holds the block at all N crank angles, (N,), m.
    meshing : 1 where a pinion lies on the left of the line, -1 on its right, 0 where none does.
    """

    name: str
    point: str
    way: Array
    on: str
    behind: Array
    ahead: Array
    meshing: int = 0


@dataclass(frozen=True)
class FieldSign:
    """What a machine plants into and picks up from.

    surface : height of the soil, m.  depth : below it, m, that the tip reaches.
    tray : both ends of the edge of the seedling tray, complex, m; empty where there is none.
    """

    surface: float
    depth: float
    tray: tuple[complex, ...]


GROWN = 2.0
"""How much larger than the linkage a picture may get that shows what its support is held by."""
WAYS = np.exp(2j * np.pi * np.arange(64) / 64)
"""In which it is looked for what lies farthest out: a circle's box comes out 0.1 % too small."""
HANGING = 0.7
"""How far down a link hangs in the mean, over its length, that is held from above."""
WIDE = 560
"""Units in the size of a machine, about."""


@dataclass(frozen=True, eq=False)
class Scene:
    """A machine at N crank angles.

    crank_angle : (N,) rad.
    places : every point by name, those of the frame first; (N,) complex, m.
    pins : points that bodies share.
    pin_radii : of pins that are drawn to scale, m.
    mass_centers : of links whose mass is known; (N,) complex, m.
    springs : ends of each, on its link and on the frame, as names of points.
    angles : of each link, counted on through the turns; (N,) rad.
    planned : springs that balancing may set, likewise.
    room : places besides that are to be in sight, complex, m.
    rows : those of its machine, where all of them are to be seen.
    marks : signs of parts, those that no other covers last.
    swing : how the support moves, where it is to be seen; places are in the frame's axes all along.
    """

    crank_angle: Array
    frame: tuple[str, ...]
    bodies: tuple[LinkOutline, ...]
    places: Mapping[str, Array]
    pins: frozenset[str]
    pin_radii: Mapping[str, float]
    mass_centers: Mapping[str, Array]
    wheels: tuple[Wheel, ...]
    guides: tuple[GuideSign, ...]
    springs: tuple[tuple[str, str], ...]
    angles: Mapping[str, Array]
    drives: tuple[DriveSign, ...]
    planned: tuple[tuple[str, str], ...] = ()
    field: FieldSign | None = None
    carrier: Carrier | None = None
    swing: SupportSwing | None = None
    room: tuple[complex, ...] = ()
    rows: Rows = SINGLE_ROW
    marks: tuple[BodyMark, ...] = ()

    @classmethod
    def of(cls, motion: Motion) -> Scene:
        """Everything of a motion that can be seen."""
        machine, joints = motion.machine, motion.linkage.joints
        places = {name: point.place for name, point in motion.points.items()}
        angles = {name: float(link.angle[0]) for name, link in motion.links.items()}
        around = Surroundings(lambda: machine, joints, machine.bodies, motion.linkage.pin_radii,
                              lambda slider: motion.sliders[slider.name].travel)  # fmt: skip
        planned = machine.balance.springs if machine.balance is not None else ()
        return cls(
            motion.crank_angle,
            tuple(machine.frame),
            tuple(bodies_of(machine.links)),
            places,
            joints.pinned_points,
            motion.linkage.pin_radii,
            {name: center.place for name, center in motion.mass_centers.items()},
            tuple(wheels_of(joints, machine.bodies, angles)),
            tuple(_guides(motion)),
            springs := stretched(element for _, _, element in machine.elements),
            {name: link.angle for name, link in motion.links.items()},
            DriveSign.each(motion),
            tuple(
                (item.point, item.to) for item in planned if (item.point, item.to) not in springs
            ),
            _field(motion),
            Carrier.of(machine),
            marks=in_order(
                (
                    *(
                        mark
                        for table, _, part in machine.parts
                        for mark in signs_of(table, part, around)
                    ),
                    *load_line_marks((*machine.loads, *machine.timed_loads)),
                    *constraint_marks(machine.constraints, machine.bodies),
                )
            ),
        )

    def with_rows(self, motion: Motion) -> Scene:
        """The scene of a motion with all rows of its machine; the same where it has one."""
        low, high = self.linkage_box
        rows = rows_of(motion, abs(high - low))
        return self if rows is SINGLE_ROW else replace(self, rows=rows)

    @property
    def drive(self) -> DriveSign:
        """The first of them."""
        return self.drives[0]

    @property
    def stretched(self) -> tuple[tuple[str, str], ...]:
        """Ends of springs and of what else is stretched between two points."""
        marks = {(mark.point, mark.to): None for mark in self.marks if mark.to}
        return (*self.springs, *self.planned, *marks)

    def usual_length(self, point: str, to: str) -> float:
        """Mean distance of two points, m, at which what is stretched between them is drawn."""
        return float(abs(self.places[to] - self.places[point]).mean()) or 1.0

    @property
    def standing(self) -> tuple[str, ...]:
        """Points of the frame at which something is held."""
        fixed_points = {point for ends in self.stretched for point in ends} | self.pins
        fixed_points |= {point for drive in self.drives for point in drive.between or ()}
        return tuple(name for name in self.frame if name in fixed_points)

    def ground(self, point: str) -> complex:
        """Way to what holds a point of the frame: down, or up where all that it holds hangs."""
        others = [(name, body.outline) for body in self.bodies for name in body.outline]
        others += [(to, (item, to)) for item, to in self.stretched]
        ways = [
            self.places[other] - self.places[point]
            for name, outline in others
            for other in outline
            if name == point != other
        ]
        hung = [float(np.mean(way.imag / np.maximum(np.abs(way), 1e-150))) for way in ways]
        return 1j if hung and max(hung) < -HANGING else -1j

    def swung(self, place: Any) -> Any:
        """Where places of the frame's axes, (N,) m, are as the support swings."""
        if self.swing is None or self.carrier is None:
            return place
        arm = (place - self.carrier.reference) * np.exp(1j * self.swing.angle)
        return self.carrier.reference + self.swing.place + arm

    @cached_property
    def linkage_box(self) -> tuple[complex, complex]:
        """Lower left and upper right corner of all places, wheels and ways of blocks, m."""
        every = [*self.places.values(), *self.mass_centers.values(), np.array(self.room, complex)]
        every += [place for row in self.rows.visible for place in row.places.values()]
        for guide in self.guides:
            place = self.places[guide.point]
            every += [place - guide.behind * guide.way, place + guide.ahead * guide.way]
        for wheel in self.wheels:
            reach = wheel.radius * (1 + 1j)
            every += [self.places[wheel.center] + way for way in (reach, -reach)]
        for point, radius in self.pin_radii.items():
            every += [self.places[point] + way * radius for way in (1 + 1j, -1 - 1j)]
        every += [corner for mark in self.marks for corner in self.spots(mark, outermost=True)]
        for body in self.bodies:
            turned = np.exp(1j * self.angles[body.name])
            every += [self.places[body.points[0]] + arm * turned for arm in body.extent]
        return _box(np.concatenate(every))

    @property
    def unit(self) -> float:
        """Of signs, m, about."""
        low, high = self.linkage_box
        return max((high - low).real, (high - low).imag) / WIDE or 1e-6

    @cached_property
    def box(self) -> tuple[complex, complex]:
        """Lower left and upper right corner of all that a picture should hold, m.

        Of what the support is held by, only what is near enough that the linkage stays in sight.
        """
        low, high = self.linkage_box
        if self.field is not None:
            bottom = complex(low.real, self.field.surface - self.field.depth)
            low, high = _box(np.array([low, high, bottom, *self.field.tray]))
        if self.carrier is None:
            return low, high
        most = GROWN * max((high - low).real, (high - low).imag)
        room = (MOUNT[0] + 5) * self.unit * (1 + 1j)
        points = [item.point for item in self.carrier.items.values() if item.point is not None]
        places = {self.carrier.reference, *(complex(*point[:2]) for point in points)}
        middle = (low + high) / 2
        for place in sorted(places, key=lambda z: (abs(z - middle), z.real, z.imag)):
            grown = _box(np.array([low, high, place - room, place + room]))
            span = grown[1] - grown[0]
            if max(span.real, span.imag) <= most:
                low, high = grown
        return low, high

    def shows(self, place: complex) -> bool:
        """Whether a place, m, is in the box."""
        low, high = self.box
        return low.real <= place.real <= high.real and low.imag <= place.imag <= high.imag

    @property
    def swept_box(self) -> tuple[complex, complex]:
        """Box of the scene with all that it holds as the support swings."""
        low, high = self.box
        corners = (low, high, complex(low.real, high.imag), complex(high.real, low.imag))
        return _box(np.concatenate([np.atleast_1d(self.swung(corner)) for corner in corners]))

    def corners_at(self, k: int) -> Array:
        """Places and wheels at the k-th crank angle, complex, m."""
        wheels = [
            self.places[wheel.center][k] + wheel.radius * way
            for wheel in self.wheels
            for way in (1, -1, 1j, -1j)
        ]
        solids = [
            self.places[body.points[0]][k] + arm * np.exp(1j * self.angles[body.name][k])
            for body in self.bodies
            for arm in body.extent
        ]
        marks = [corner[k] for mark in self.marks for corner in self.spots(mark)]
        return np.array([*(place[k] for place in self.places.values()), *wheels, *solids, *marks])

    def spots(self, mark: BodyMark, outermost: bool = False) -> Array:
        """Where corners of a mark are, or of the box around a circle, (n, N) complex, m.

        outermost : whether those farthest out are enough, as many as a picture resolves.
        """
        if mark.to:
            return np.array([self.places[mark.point], self.places[mark.to]])
        reach = mark.shape.radius * np.array([1 + 1j, -1 + 1j, -1 - 1j, 1 - 1j])
        corners = mark.shape.places + (reach if mark.shape.radius else 0.0)
        if outermost:
            corners = corners[np.unique(np.argmax((corners * WAYS[:, None]).real, axis=1))]
        turned = np.exp(1j * self.angles.get(mark.body, 0 * self.crank_angle))
        return np.asarray(self.places[mark.point] + corners[:, None] * turned)

    def local(self, body: LinkOutline, place: Array) -> complex:
        """Where a place (N,) of a link is from its first point, in the link's own axes, m."""
        if body.name not in self._axes:  # each link has several places
            turned = complex(np.exp(-1j * self.angles[body.name][0]))
            self._axes[body.name] = complex(self.places[body.points[0]][0]), turned
        origin, turned = self._axes[body.name]
        return (complex(place[0]) - origin) * turned

    def corners(self, body: LinkOutline) -> Array:
        """Corners of what lies around a link, (n,)."""
        if body.name not in self._corners:  # which several signs of a link go by
            places = [self.local(body, self.places[name]) for name in body.outline]
            self._corners[body.name] = np.array(places)
        return self._corners[body.name]

    @cached_property
    def _axes(self) -> dict[str, tuple[complex, complex]]:
        """First point of a link (m), and its direction turned back, at the first crank angle."""
        return {}

    @cached_property
    def _corners(self) -> dict[str, Array]:
        return {}


def _box(places: Array) -> tuple[complex, complex]:
    x, y = places.real, places.imag
    return complex(x.min(), y.min()), complex(x.max(), y.max())


def _field(motion: Motion) -> FieldSign | None:
    planting = motion.machine.planting
    if planting is None:
        return None
    try:
        surface = surface_of(motion.machine)
    except EquipoiseError:  # it cannot turn all the way round
        return None
    places = [motion.points[arm.tip].place.imag for arm in planting.every_arm]
    lowest = float(np.min(places))
    depth = surface - lowest if planting.depth is None else planting.depth
    return FieldSign(surface, max(depth, 0.0), tuple(complex(*end) for end in planting.tray or ()))


def stretched(elements: Iterable[Element]) -> tuple[tuple[str, str], ...]:
    """Ends of the elements that are drawn as springs."""
    return tuple(element.route for element in elements if element.drawn_as_spring)


def bodies_of(links: Mapping[str, Link]) -> Iterator[LinkOutline]:
    """The links, with what lies around each."""
    for name, link in links.items():
        named = {complex(*place): point for point, place in reversed(list(link.points.items()))}
        around = tuple(named[complex(place)] for place in hull(np.array(list(named))))
        yield LinkOutline(name, tuple(link.points), around, tuple(_solids(link)))


def _solids(link: Link) -> Iterator[BodyOutline]:
    origin = complex(*next(iter(link.points.values())))
    for body in link.bodies:
        holes = [([place_of(hole.at, link.points)], -hole.radius) for hole in body.holes]
        for corners, radius in (*outlines(body, link.points), *holes):
            yield [corner - origin for corner in corners], radius


def _guides(motion: Motion) -> Iterator[GuideSign]:
    couplings = (item for item in motion.machine.couplings if item.slides)
    teeth = {(item.slides, item.carrier): int(copysign(1, -item.foot.imag)) for item in couplings}
    for slider in motion.machine.sliders:
        place = motion.points[slider.point].place
        angle = 0 * motion.crank_angle
        if slider.on != FRAME:
            angle = motion.links[slider.on].angle
            place = place - motion.points[next(iter(motion.machine.points_of(slider.on)))].place
        way = np.exp(1j * (angle + slider.direction))
        along = (place * way.conj()).real
        ends = along - along.min(), along.max() - along
        side = teeth.get((slider.link, slider.on), 0)
        yield GuideSign(slider.name, slider.point, way, slider.on, *ends, side)


CANDIDATES = 24
"""Crank angles in a turn among which the clearest is chosen."""
ROOM, OPEN = 80.0, np.radians(60.0)
"""Units from a sign to a link, and angle between links that meet, of which more is no clearer."""


def clear_angle(scene: Scene) -> int:
    """At which of a scene's crank angles (of the first turn) links hide each other least.

    Signs keep away from links that they are no part of, links do not cross, and those that meet at
    a point do not lie in one line.  Each adds the cube of what it lacks, so that many that are
    near weigh less than one that is hidden, and what never changes does not count.
    """
    count = int(np.searchsorted(scene.crank_angle, 2 * np.pi - 1e-9))
    at = np.unique(np.linspace(0, max(count, 1), CANDIDATES, endpoint=False).astype(int))
    shares = [*_off_links(scene, at), *_uncrossed(scene, at), *_opened(scene, at)]
    lacking = sum((np.clip(1 - share, 0, 1) ** 3 for share in shares), np.zeros(len(at)))
    return int(at[np.argmin(np.round(lacking, 3))])


def _off_links(scene: Scene, at: Array) -> Iterator[Array]:
    """How far signs are from links and springs, over the room that they should have, (M,) each."""
    outlines = [(body.name, set(body.points), body.outline) for body in scene.bodies]
    outlines += [("", set(ends), ends) for ends in _springs(scene)]
    signs = [("", name, place[at]) for name, place in scene.places.items()]
    middles = ((scene.places[item] + scene.places[other]) / 2 for item, other in _springs(scene))
    signs += [("", "", middle[at]) for middle in middles]
    signs += [(link, "", center[at]) for link, center in scene.mass_centers.items()]
    if scene.carrier is not None:
        below = -0.5j * MOUNT[0] * scene.unit
        mount_points = (
            item.point for item in scene.carrier.items.values() if item.point is not None
        )
        signs += [("", "", np.full(len(at), complex(*point[:2]) + below)) for point in mount_points]
    for link, points, outline in outlines:
        corners = np.array([scene.places[name][at] for name in outline])
        for own, point, place in signs:
            if point not in points and own != link:
                yield off_outline(place, corners) / (ROOM * scene.unit)


def _springs(scene: Scene) -> list[tuple[str, str]]:
    return [*scene.stretched]


def _uncrossed(scene: Scene, at: Array) -> Iterator[Array]:
    """Whether edges of links, and springs, cross each other, (M,) each."""
    edges = [{*ends} for ends in _springs(scene)]
    for body in scene.bodies:
        edges += [{*ends} for ends in pairwise((*body.outline, body.outline[0]))]
    for edge, other in combinations([ends for ends in edges if len(ends) == 2], 2):
        if not edge & other:
            a, b, c, d = (scene.places[name][at] for name in (*sorted(edge), *sorted(other)))
            yield 1.0 * (_overlap(scene, a, b, c, d) | _overlap(scene, c, d, a, b))


def _overlap(scene: Scene, a: Array, b: Array, c: Array, d: Array) -> Array:
    """Whether c and d lie on one side of the line from a to b, or one of them on it, (M,)."""
    ends = cross(b - a, c - a) * cross(b - a, d - a)
    return np.asarray(ends > -((scene.unit * np.abs(b - a)) ** 2))


def _opened(scene: Scene, at: Array) -> Iterator[Array]:
    """Angles between what meets at a point, over what they should be, (M,) each."""
    arms: dict[str, list[Array]] = {}
    bars = [body.outline for body in scene.bodies if len(body.outline) == 2]
    for start, end in (*bars, *_springs(scene)):
        along = scene.places[end][at] - scene.places[start][at]
        arms.setdefault(start, []).append(along)
        arms.setdefault(end, []).append(-along)
    for guide in scene.guides:
        arms.setdefault(guide.point, []).append(guide.way[at])
    for point, ways in arms.items():
        for number, way in enumerate(ways):
            if point in scene.standing:
                yield np.abs(np.angle(way / scene.ground(point))) / OPEN
            for other in ways[:number]:
                angle = np.abs(np.angle(way * other.conj()))
                yield np.minimum(angle, np.pi - angle) / OPEN
