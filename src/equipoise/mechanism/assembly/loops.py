"""Loop equations: what vanishes where a joint holds two bodies together, and where it may be.

Each joint says of two bodies that something vanishes: the gap of a pin (2 equations), turn and
offset of a slider (2), or of a rider on its track, the mismatch of a coupling (1).  The same
expressions in velocities and accelerations are linear in them, and the force in the joint acts
where and as the gap is measured.

All of it is arithmetic on poses, so that it runs on arrays, and can be written out for loops.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, ClassVar, Protocol

from equipoise.dataclass import dataclass
from equipoise.mechanism.assembly.steps import Step
from equipoise.mechanism.formulas import kernels
from equipoise.mechanism.formulas.curve_kernels import on_track


@dataclass(frozen=True)
class Pose:
    """Place of a body's anchor, and its rotation, with two derivatives each, of shape (..., N).

    angle : running angle, which only couplings ask for.
    along : of a rider, the parameter of its track, and its speed along that by the crank angle.
    """

    place: tuple[Any, Any, Any]
    turn: tuple[Any, Any, Any]
    angle: Any = 0.0
    along: tuple[Any, ...] = ()

    def point(self, arm: Any) -> tuple[Any, Any, Any]:
        p, p1, p2 = kernels.point(*self.place, *self.turn, arm)
        return p, p1, p2

    def place_of(self, arm: Any) -> Any:
        """Place of a point of the body, without its derivatives."""
        return self.place[0] + self.turn[0] * arm

    def pick(self, part: Any) -> Pose:
        """The pose at one or some of the crank angles."""
        place, turn = (tuple(value[part] for value in values) for values in (self.place, self.turn))
        return Pose(place, turn, self.angle[part])

    @property
    def still(self) -> Pose:
        """Pose without its rates."""
        return Pose((self.place[0], 0.0, 0.0), (self.turn[0], 0.0, 0.0), self.angle)


@dataclass(frozen=True)
class End:
    """A point of a body: `arm` from the body's anchor."""

    body: str
    point: str
    arm: Any


Poses = dict[str, Pose]
Wrench = tuple[Any, Any]


class Contact(Protocol):
    """How the driver's push reaches the driven body, and how this is solved."""

    @property
    def couples(self) -> bool:
        """Whether it pushes with a couple, too."""

    def group(self, builder: Any, joints: Any) -> Any:
        """The driven link, where driver and carrier are known."""

    def loop(self, end: Callable[[str, str], End]) -> CouplingLoop:
        """Contact as a loop equation; `end` finds points of bodies from their anchors."""


class PushingContact(Contact, Protocol):
    """A contact whose place and line of action its loop asks for."""

    def place(self, poses: Poses) -> Any:
        """Where the push acts, complex, m."""

    def wrenches(self, poses: Poses, sense: Any) -> list[Wrench]:
        """Force and couple on the driven body, at that place, for a push of 1.

        sense : sign of the push that is asked for without any slant of its line; see
            `joint_kernels.flank`.
        """


@dataclass(frozen=True)
class PinLoop:
    """Two points stay together; `on` carries the force that `by` exerts."""

    name: str
    on: End
    by: End

    unknowns: ClassVar[int] = 2
    turns: ClassVar[bool] = False
    """Whether its first gap is an angle, and its first unknown a couple."""

    def gaps(self, poses: Poses, level: int) -> list[Any]:
        """What vanishes (level 0), and its first and second derivative."""
        ends = ((poses[end.body], end.arm) for end in (self.on, self.by))
        here, there = (
            pose.point(arm)[level] if level else pose.place_of(arm) for pose, arm in ends
        )
        gap = here - there
        return [gap.real, gap.imag]

    def place(self, poses: Poses) -> Any:
        """Where its force acts."""
        return poses[self.on.body].place_of(self.on.arm)

    def wrenches(self, poses: Poses, sense: Any) -> list[Wrench]:
        """Force and couple on `on`, at that place, for a unit of each unknown."""
        return [(1 + 0j, 0.0), (1j, 0.0)]


@dataclass(frozen=True)
class SlideLoop:
    """A link's point stays on a line of the body `by`, and the link does not turn in it.

    along : unit vector of the line in that body's axes; turn : of the link's x axis in axes along
    the line.
    """

    name: str
    on: End
    by: End
    along: Any
    turn: Any

    unknowns: ClassVar[int] = 2
    turns: ClassVar[bool] = True

    def gaps(self, poses: Poses, level: int) -> list[Any]:
        link, guide = poses[self.on.body], poses[self.by.body]
        (u, w, a), (n, w_n, a_n) = link.turn, guide.turn
        n = n * self.along
        off = (n * self.turn).conjugate() * u
        twice_tangent = 2 * off.imag / (1 + off.real)  # of half the angle, which is to vanish
        turned = (twice_tangent, w - w_n, a - a_n)[level]
        ends = zip(link.point(self.on.arm), guide.point(self.by.arm), strict=True)
        d, d1, d2 = (a - b for a, b in ends)
        return [turned, kernels.along_line(d, d1, d2, n, w_n, a_n)[level].imag]

    def place(self, poses: Poses) -> Any:
        return poses[self.on.body].place_of(self.on.arm)

    def wrenches(self, poses: Poses, sense: Any) -> list[Wrench]:
        return [(0j, 1.0), (1j * poses[self.by.body].turn[0] * self.along, 0.0)]


@dataclass(frozen=True)
class Rides:
    """How far a body is along its guide, by which a relation knows it instead of by its angle.

    own : its point.  base : that of the guide.  along : unit vector of this in its body's axes.
    """

    own: End
    base: End
    along: Any

    def travel(self, poses: Poses) -> tuple[Any, Any, Any]:
        """The way, m, with both derivatives."""
        guide = poses[self.base.body]
        ends = (*poses[self.own.body].point(self.own.arm), *guide.point(self.base.arm))
        t, t1, t2 = kernels.travelled(*ends, *guide.turn, self.along)
        return t, t1, t2


@dataclass(frozen=True)
class TrackLoop:
    """The rider `on` stays on a curve of the body `by`, its x axis along the curve.

    curve : a `PlaneCurve`.  turn : of its axes in those of the body.
    """

    name: str
    on: End
    by: End
    curve: Any
    turn: Any

    unknowns: ClassVar[int] = 2
    turns: ClassVar[bool] = True

    def gaps(self, poses: Poses, level: int) -> list[Any]:
        """What vanishes; its rates always do, as a rider is placed by its track."""
        if level:
            return [0.0, 0.0]
        rider, body = poses[self.on.body], poses[self.by.body]
        back = (body.turn[0] * self.turn).conjugate()
        place = back * (rider.place_of(self.on.arm) - body.place_of(self.by.arm))
        c, c1, *_ = self.curve.at(self.curve.nearest(place))
        tangent = c1 / abs(c1)
        off = tangent.conjugate() * back * rider.turn[0]
        return [2 * off.imag / (1 + off.real), kernels.cross(tangent, place - c)]

    def place(self, poses: Poses) -> Any:
        return poses[self.on.body].place_of(self.on.arm)

    def wrenches(self, poses: Poses, sense: Any) -> list[Wrench]:
        return [(0j, 1.0), (1j * poses[self.on.body].turn[0], 0.0)]


@dataclass(frozen=True)
class CouplingLoop:
    """Angles of driven link, driver and carrier in a fixed relation.

    kind : of its `Reaction`.  kernel, numbers : as of `couplings.Relation`.
    rides : of the body that slides on the carrier, if one does.
    """

    name: str
    kind: str
    on: End
    by: End
    carrier: str
    kernel: Callable[..., tuple[Any, ...]]
    numbers: tuple[Any, ...]
    offset: Any
    contact: PushingContact
    rides: Rides | None

    unknowns: ClassVar[int] = 1
    turns: ClassVar[bool] = False
    starts: ClassVar[bool] = True
    """Whether the file says at which angle the driven link starts."""
    switches: ClassVar[bool] = True
    """Whether the line of action depends on the sense of the push."""

    @property
    def at(self) -> str:
        """The point at which the push acts."""
        return f"pitch({self.name})"

    def after(self, builder: Any) -> list[Step]:
        """Steps that outputs ask for, once the bodies are known."""
        return []

    def gaps(self, poses: Poses, level: int) -> list[Any]:
        bodies = (self.on.body, self.by.body, self.carrier)
        driven, driver, carrier = (self.coordinate(poses, body) for body in bodies)
        wanted = self.kernel(*driver, *carrier, *self.numbers, self.offset)
        return [driven[level] - wanted[level]]

    def coordinate(self, poses: Poses, body: str) -> tuple[Any, Any, Any]:
        """By which the relation knows a body: its angle, or its way along its guide, with both
        derivatives.
        """
        if self.rides is not None and body == self.rides.own.body:
            return self.rides.travel(poses)
        pose = poses[body]
        return pose.angle, pose.turn[1], pose.turn[2]

    def place(self, poses: Poses) -> Any:
        return self.contact.place(poses)

    def wrenches(self, poses: Poses, sense: Any) -> list[Wrench]:
        return self.contact.wrenches(poses, sense)

    @property
    def slides(self) -> bool:
        """Whether what the relation tells is a length."""
        return self.rides is not None and self.rides.own.body == self.on.body


Loop = PinLoop | SlideLoop | TrackLoop | CouplingLoop


@dataclass(frozen=True)
class Hinge:
    """A link whose anchor is on a pin of another body, so that its angle alone is unknown."""

    link: str
    to: End

    turning: ClassVar[tuple[bool, ...]] = (True,)
    counted: ClassVar[bool] = True
    """Whether its running angle is an unknown."""

    def pose(self, poses: Poses, value: Any, w: Any, a: Any) -> Pose:
        """value : rotation and angle, w, a : derivatives of the angle."""
        turn, angle = value
        return Pose(poses[self.to.body].point(self.to.arm), (turn, w, a), angle)

    def values(self, poses: Poses) -> list[Any]:
        """The unknowns, of a link whose pose is known."""
        return [poses[self.link].angle]


@dataclass(frozen=True)
class Rail:
    """A link whose anchor is on a guide of another body, so that its way along it is unknown.

    along, turn : as in `SlideLoop`.  angle : of the link's x axis in the other body's axes.
    """

    link: str
    to: End
    along: Any
    turn: Any
    angle: Any

    turning: ClassVar[tuple[bool, ...]] = (False,)
    counted: ClassVar[bool] = False

    def pose(self, poses: Poses, value: Any, s1: Any, s2: Any) -> Pose:
        """value : the way, s1, s2 : its derivatives."""
        guide = poses[self.to.body]
        turn, w, a = guide.turn
        n = turn * self.along
        place = kernels.slid(*guide.point(self.to.arm), n, w, a, value, s1, s2)
        return Pose(place, (n * self.turn, w, a), guide.angle + self.angle)

    def values(self, poses: Poses) -> list[Any]:
        guide = poses[self.to.body]
        way = poses[self.link].place[0] - guide.place_of(self.to.arm)
        return [kernels.dot(guide.turn[0] * self.along, way)]


@dataclass(frozen=True)
class Riding:
    """A rider on the track of another body, so that the parameter of the curve is unknown.

    curve, turn : as in `TrackLoop`.
    """

    link: str
    to: End
    curve: Any
    turn: Any

    counted: ClassVar[bool] = False

    @property
    def turning(self) -> tuple[bool, ...]:
        return (self.curve.closed,)

    def pose(self, poses: Poses, value: Any, s1: Any, s2: Any) -> Pose:
        """value : the parameter, of a closed curve as `Hinge` has an angle; s1, s2 : of that."""
        s = self.curve.turned(value[0]) if self.curve.closed else value
        body = poses[self.to.body]
        turn, w, a = body.turn
        levels = (*body.point(self.to.arm), turn * self.turn, w, a, *self.curve.at(s), s1, s2)
        x, x1, x2, u, u1, u2, speed = on_track(*levels)  # type: ignore[no-untyped-call]
        return Pose((x, x1, x2), (u, u1, u2), along=(s, speed))

    def values(self, poses: Poses) -> list[Any]:
        return [poses[self.link].along[0]]

    def nearest(self, poses: Poses, place: Any) -> float:
        """Parameter of the curve nearest to a place."""
        body = poses[self.to.body]
        way = place - body.place_of(self.to.arm)
        return float(self.curve.nearest((body.turn[0] * self.turn).conjugate() * way))


@dataclass(frozen=True)
class Free:
    """A link of which place and angle are unknown."""

    link: str

    turning: ClassVar[tuple[bool, ...]] = (False, False, True)
    counted: ClassVar[bool] = True

    def pose(self, poses: Poses, value: Any, q1: Any, q2: Any) -> Pose:
        x, y, (turn, angle) = value
        place = (x + 1j * y, q1[0] + 1j * q1[1], q2[0] + 1j * q2[1])
        return Pose(place, (turn, q1[2], q2[2]), angle)

    def values(self, poses: Poses) -> list[Any]:
        pose = poses[self.link]
        return [pose.place[0].real, pose.place[0].imag, pose.angle]


Place = Hinge | Rail | Riding | Free
