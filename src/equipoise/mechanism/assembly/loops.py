"""Loop equations of groups of links that no dyad solves, and Newton's method on them.

Each joint says of two bodies that something vanishes: the gap of a pin (2 equations), turn and
offset of a slider (2), or of a rider on its track, the mismatch of a coupling (1).  The same
expressions in velocities and accelerations are linear in them, and the force in the joint acts
where and as the gap is measured.

All of it is arithmetic on poses, so that it runs on arrays, and can be written out for loops.

One joint of each link only positions it: of a link on a pin the angle is unknown, of a link on a
guide its displacement.  These joints make a tree, from the bodies that are known to every
link; what they leave open, the others close.  The start alone, from a rough position, takes every
joint for an equation, with place and angle of each link unknown.

Because the loop equations' rates are linear in the unknowns' rates, one set of formulas gives
Newton's matrix and both derivatives.  The branch is followed from the position in the model file:
neighbouring crank angles first, then any crank angle from the nearest one followed.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import suppress
from functools import cached_property
from math import ceil, degrees, radians
from typing import Any, ClassVar, Protocol

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.decompositions import singular_values
from equipoise.errors import MotionError
from equipoise.i18n import Note
from equipoise.mechanism.assembly.steps import Reaction, State, Step, along, p, pin_reaction, u
from equipoise.mechanism.formulas import kernels
from equipoise.mechanism.formulas.curves import HERMITE
from equipoise.mechanism.formulas.kernels import on_track
from equipoise.mechanism.formulas.rolling import Levels
from equipoise.mechanism.parts.machine import Machine, Position
from equipoise.signals import Array, first_below


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
            `kernels.flank`.
        """


@dataclass(frozen=True)
class BodyLoop(ABC):
    """Something vanishes between two bodies; `on` carries the force that `by` exerts.

    unknowns : of its force, as many as equations.
    turns : whether its first gap is an angle, and its first unknown a couple.
    starts : whether the file says at which angle the driven link starts.
    switches : whether its line of action depends on the sense of the push.
    """

    name: str
    on: End
    by: End

    unknowns: ClassVar[int] = 2
    turns: ClassVar[bool] = True
    starts: ClassVar[bool] = False
    switches: ClassVar[bool] = False

    @abstractmethod
    def gaps(self, poses: Poses, level: int) -> list[Any]:
        """What vanishes (level 0), and its first and second derivative."""

    @abstractmethod
    def wrenches(self, poses: Poses, sense: Any) -> list[Wrench]:
        """Force and couple on `on`, at that place, for a unit of each unknown."""

    def place(self, poses: Poses) -> Any:
        """Where its force acts."""
        return poses[self.on.body].place_of(self.on.arm)

    def reaction(self) -> Reaction:
        """The force on `on`, with a couple."""
        on, by = self.on.body, self.by.body
        key = f"({self.name}/{on})"
        return Reaction(self.name, "slider", on, by, self.on.point, f"R{key}", f"C{key}")

    def placement(self, link: str) -> LinkAttachment:
        """Where one of the bodies is by this joint alone."""
        return Hinge(link, self.other(link))

    def other(self, link: str) -> End:
        """The end on the other body."""
        return self.by if link == self.on.body else self.on


@dataclass(frozen=True)
class PinLoop(BodyLoop):
    """Two points stay together."""

    turns: ClassVar[bool] = False

    def gaps(self, poses: Poses, level: int) -> list[Any]:
        ends = ((poses[end.body], end.arm) for end in (self.on, self.by))
        here, there = (
            pose.point(arm)[level] if level else pose.place_of(arm) for pose, arm in ends
        )
        gap = here - there
        return [gap.real, gap.imag]

    def wrenches(self, poses: Poses, sense: Any) -> list[Wrench]:
        return [(1 + 0j, 0.0), (1j, 0.0)]

    def reaction(self) -> Reaction:
        return pin_reaction(self.name, self.on.body, self.by.body)


@dataclass(frozen=True)
class SlideLoop(BodyLoop):
    """A link's point stays on a line of the body `by`, and the link does not turn in it.

    along : unit vector of the line in that body's axes; turn : of the link's x axis in axes along
    the line.
    """

    along: Any
    turn: Any

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

    def wrenches(self, poses: Poses, sense: Any) -> list[Wrench]:
        return [(0j, 1.0), (1j * poses[self.by.body].turn[0] * self.along, 0.0)]

    def placement(self, link: str) -> Rail:
        along, turn = self.along, self.turn
        if link != self.on.body:
            along, turn = turn.conjugate(), along.conjugate()
        return Rail(link, self.other(link), along, turn, np.angle(along * turn))


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
class TrackLoop(BodyLoop):
    """The rider `on` stays on a curve of the body `by`, its x axis along the curve.

    curve : a `PlaneCurve`.  turn : of its axes in those of the body.
    """

    curve: Any
    turn: Any

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

    def wrenches(self, poses: Poses, sense: Any) -> list[Wrench]:
        return [(0j, 1.0), (1j * poses[self.on.body].turn[0], 0.0)]

    def placement(self, link: str) -> Riding:
        return Riding(link, self.other(link), self.curve, self.turn)


@dataclass(frozen=True)
class CouplingLoop(BodyLoop):
    """Angles of driven link, driver and carrier in a fixed relation.

    kind : of its `Reaction`.  kernel, numbers : as of `couplings.Relation`.
    rides : of the body that slides on the carrier, if one does.
    """

    kind: str
    carrier: str
    kernel: Callable[..., tuple[Any, ...]]
    numbers: tuple[Any, ...]
    offset: Any
    contact: PushingContact
    rides: Rides | None

    unknowns: ClassVar[int] = 1
    turns: ClassVar[bool] = False
    starts: ClassVar[bool] = True
    switches: ClassVar[bool] = True

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

    def reaction(self) -> Reaction:
        on, by = self.on.body, self.by.body
        couple = f"C({self.name}/{on})" if self.contact.couples else None
        return Reaction(self.name, self.kind, on, by, self.at, f"R({self.name}/{on})", couple)

    @property
    def slides(self) -> bool:
        """Whether the relation gives a length, and not an angle."""
        return self.rides is not None and self.rides.own.body == self.on.body


LoopEquation = PinLoop | SlideLoop | TrackLoop | CouplingLoop


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
        x, x1, x2, u, u1, u2, speed = on_track(*levels)
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


LinkAttachment = Hinge | Rail | Riding | Free


ITERATIONS = 25
SETTLED = 1e-11
"""Last step of Newton's method, in sizes of the machine and radians, that counts as arrived."""
STRIDES = (radians(30), radians(6))
"""Between crank angles at which a branch is followed first; the next where it cannot be so."""
SAME = 1e-8
"""Difference of unknowns, in sizes of the machine and radians, at which solutions are the same."""
LOOSE = 1e-6
"""Smallest singular value of slopes with columns of length 1, up to which a link is free."""
JUMP = 0.02
"""Step, in sizes of the linkage and radians, that the branch's slope does not explain."""


class BranchError(MotionError):
    """Newton's method finds no solution near the one before, at `crank_angle` (rad).

    rider : what runs off the end of its track there; empty if none does.
    """

    crank_angle: float = float("nan")
    rider: str = ""


@dataclass(frozen=True)
class LoopGroup:
    """A group of links with as many loop equations as unknowns, or more that go together.

    links, anchors : the unknown links and their anchor points.
    visible_links : those of the links that are not inside of joints.
    known : other bodies that the loops touch -> their anchors.
    tree : where each link is, in an order in which the bodies that this asks for come first.
    equations : the joints that the tree leaves.
    start : (n,) unknowns at crank angle 0, on the branch.
    size : a typical length, m, against which gaps and steps are measured.
    """

    links: tuple[str, ...]
    anchors: tuple[str, ...]
    known: tuple[tuple[str, str], ...]
    tree: tuple[LinkAttachment, ...]
    equations: tuple[LoopEquation, ...]
    start: Any
    size: Any
    visible_links: tuple[str, ...] = ()

    @property
    def reference(self) -> str:
        return f"q({' and '.join(self.links)})"

    @cached_property
    def turning(self) -> Array:
        """Which of the unknowns (n,) are angles."""
        return np.array([item for place in self.tree for item in place.turning])

    def run(self, state: State) -> None:
        """Solve at every crank angle; follow the branch where no solution is known nearby."""
        theta = np.atleast_1d(state["theta"])
        known = poses_in(state, self.known)
        guess = state.get(f"reference({self.reference})")
        with np.errstate(all="ignore"):
            if guess is None:
                guess_levels = state.get(f"near({self.reference})")
                levels = self.follow(self.start, known, theta, guess_levels)
            else:
                q = self.solve(guess, known, theta)
                levels = (q, *self.derivatives(q, known))
        self.write(state, known, *levels)

    def poses(self, known: Poses, q: Any, q1: Any = None, q2: Any = None) -> Poses:
        """Poses of all bodies from unknowns and their derivatives, of each a row (n, ...).

        An unknown angle may be a rotation and an angle already.
        """
        nothing = (0.0,) * len(self.turning)
        rows = [q, nothing if q1 is None else q1, nothing if q2 is None else q2]
        result = dict(known)
        begin = 0
        for place in self.tree:
            own = slice(begin, begin := begin + len(place.turning))
            values, *rates = (row[own] for row in rows)
            values = [
                (np.exp(1j * value), value) if turns and not isinstance(value, tuple) else value
                for value, turns in zip(values, place.turning, strict=True)
            ]
            if len(values) == 1:
                result[place.link] = place.pose(result, values[0], *(rate[0] for rate in rates))
            else:
                result[place.link] = place.pose(result, values, *rates)
        return result

    def gaps(self, poses: Poses, level: int) -> list[Any]:
        """All loop equations, or their first or second derivatives."""
        return [gap for equation in self.equations for gap in equation.gaps(poses, level)]

    def slopes(self, known: Poses, q: Array) -> tuple[Array, Array]:
        """Loop equations (n, ...) and their derivative by the unknowns (..., n, n).

        The first derivative of the gaps is linear in that of the unknowns, and the known bodies'
        part drops out where these stand still.
        """
        count, shape = len(q), q.shape[1:]
        unit = np.eye(count).reshape(count, count, *(1 for _ in shape))
        poses = self.poses({body: pose.still for body, pose in known.items()}, q, unit)
        rates = gap_rows(self.gaps(poses, 1), (count, *shape))
        return gap_rows(self.gaps(poses, 0), shape), np.moveaxis(rates, (0, 1), (-2, -1))

    def solve(self, guess: Array, known: Poses, theta: Any) -> Array:
        """Newton's method at all crank angles (N,), or one, together; guess, result (n, ...)."""
        shape = np.broadcast_shapes(*(np.shape(pose.place[0]) for pose in known.values()))
        q = np.array(np.broadcast_to(guess, np.broadcast_shapes(np.shape(guess), shape)))
        for _ in range(ITERATIONS):
            gap, matrix = self.slopes(known, q)
            step = divide(matrix, gap)
            q -= step
            sizes = np.max(self.sizes(step), axis=0)
            if not np.any(sizes >= SETTLED):  # the next step would be rounding
                break
        self.check(sizes < SETTLED, theta)
        return q

    def rigid(self, state: State) -> bool:
        """Whether the equations leave no unknown free at the start, with the known bodies still."""
        known = {body: pose.pick((..., 0)) for body, pose in poses_in(state, self.known).items()}
        _, matrix = self.slopes(known, np.asarray(self.start))
        matrix = matrix * np.where(self.turning, 1.0, self.size)
        sizes = singular_values(matrix / np.linalg.norm(matrix, axis=0))
        return bool(sizes[-1] > LOOSE)

    def singular(self, state: State) -> float | None:
        """The first crank angle, rad, that a branch passes and at which it meets another: there
        the determinant of the equations changes its sign.  None where it passes none.
        """
        known = poses_in(state, self.known)
        _, matrix = self.slopes(known, state[self.reference])
        if matrix.shape[-2] > matrix.shape[-1]:  # more equations than unknowns hold it fast
            return None
        sizes = np.linalg.det(matrix / np.max(np.abs(matrix), axis=-1, keepdims=True))
        changes = np.flatnonzero(np.diff(np.sign(sizes)))
        if not len(changes):
            return None
        k, theta = int(changes[0]), np.atleast_1d(state["theta"])
        return float(np.interp(0.0, *_rising(sizes[k : k + 2], theta[k : k + 2])))

    def check(self, good: Any, theta: Any) -> None:
        """Raise an error that names the first crank angle at which something failed."""
        if not np.all(good):
            angle = float(np.ravel(theta)[int(np.argmin(good))])
            error = BranchError(self.failure(angle))
            error.crank_angle = angle
            raise error

    def sizes(self, steps: Array) -> Array:
        """Steps of the unknowns (n, ...) without dimension."""
        return np.asarray(np.abs(self.scaled(steps)))

    def scaled(self, steps: Iterable[Any]) -> list[Any]:
        """Steps of the unknowns, arrays or terms: lengths over the size of the machine."""
        pairs = zip(steps, self.turning, strict=True)
        return [step if turns else step / self.size for step, turns in pairs]

    def derivatives(self, q: Array, known: Poses) -> tuple[Array, Array]:
        """First and second derivative of the unknowns by crank angle."""
        _, matrix = self.slopes(known, q)

        def balanced(gaps: Sequence[Any]) -> Array:
            return -divide(matrix, gap_rows(gaps, q.shape[1:]))

        return self.derivatives_by(balanced, q, known)

    def derivatives_by(
        self, balanced: Callable[[list[Any]], Any], q: Any, known: Poses
    ) -> tuple[Any, Any]:
        """First and second derivative of the unknowns by crank angle, as arrays or terms.

        balanced : from a derivative of the gaps in which that of the unknowns is left out, to that
            by which it is 0.
        """
        q1 = balanced(self.gaps(self.poses(known, q), 1))
        return q1, balanced(self.gaps(self.poses(known, q, q1), 2))

    def ways_from(
        self,
        position: Position,
        machine: Machine,
        poses: Poses,
        arm: Callable[[str, str, str], Any],
    ) -> Iterator[tuple[str, Any]]:
        """Points of the links that the file places, each with the way, m, complex, to where it is
        by poses of arrays or terms.

        arm : from a link, its anchor and another point to the vector between them.
        """
        for link, anchor in zip(self.links, self.anchors, strict=True):
            for name in machine.assembled_points(link):
                if name in position.points:
                    vector = 0j if name == anchor else arm(link, anchor, name)
                    yield name, poses[link].place_of(vector) - complex(*position.points[name])

    def follow(self, start: Array, known: Poses, theta: Array, guess: Any = None) -> Levels:
        """Follow the branch along crank angles, from the solution `start` at the first.

        From unknowns `near` it (n, N) all together, if there are such.  Else wide steps first, with
        all angles between them together; where those do not fit, every angle from the one before.
        """
        if guess is not None and guess.shape == (len(start), len(theta)):
            with suppress(MotionError):
                levels = self.joined(guess, known, theta)
                if np.all(self.sizes(levels[0][:, 0] - start) <= SAME):
                    return levels
        for stride in STRIDES if len(theta) > 1 else ():
            each = int(stride / abs(theta[1] - theta[0] or 1.0))
            if 1 < each < len(theta):
                with suppress(MotionError):
                    return self.follow_wide(start, known, theta, each)
        return self.follow_each(start, known, theta)

    def follow_wide(self, start: Array, known: Poses, theta: Array, each: int) -> Levels:
        count = ceil((len(theta) - 1) / each)
        posts = np.linspace(0, len(theta) - 1, count + 1).astype(int)
        some = {body: pose.pick((..., posts)) for body, pose in known.items()}
        levels = self.follow_each(start, some, theta[posts])
        return self.joined(between(theta, posts, *levels), known, theta)

    def joined(self, guess: Array, known: Poses, theta: Array) -> Levels:
        """All crank angles (N,) solved together, where that gives one branch."""
        q = self.solve(guess, known, theta)
        q1, q2 = self.derivatives(q, known)
        bent = np.diff(q) - 0.5 * (q1[:, 1:] + q1[:, :-1]) * np.diff(theta)
        self.check(np.all(self.sizes(bent) <= JUMP), theta)
        return q, q1, q2

    def follow_each(self, start: Array, known: Poses, theta: Array) -> Levels:
        here = start
        levels: list[Levels] = []
        for k, angle in enumerate(theta):
            now = {body: pose.pick((..., k)) for body, pose in known.items()}
            guess = here
            try:
                here = self.solve(guess, now, angle)
                if k:
                    self.check(np.all(self.sizes(here - guess) <= 10 * JUMP), angle)
            except BranchError as error:
                self.off_track(error, theta[:k], [q for q, *_ in levels])
                raise
            q1, q2 = self.derivatives(here, now)
            levels.append((here, q1, q2))
            if k + 1 < len(theta):
                step = theta[k + 1] - angle
                here = here + q1 * step + q2 * (0.5 * step * step)
        q, q1, q2 = (np.stack(level, axis=-1) for level in zip(*levels, strict=True))
        return q, q1, q2

    def off_track(self, error: BranchError, theta: Array, followed: Sequence[Array]) -> None:
        """Let an error name the rider that has passed an end of its track before it, and where.

        theta : (k,) crank angles before, rad.  followed : the unknowns (n,) at each.
        """
        begin = 0
        for place in self.tree:
            at, begin = begin, begin + len(place.turning)
            if not isinstance(place, Riding) or (ends := place.curve.ends) is None or not followed:
                continue
            s = np.array([q[at] for q in followed])
            left = first_below(theta, np.minimum(s - ends[0], ends[1] - s), 0.0)
            if left is not None and not left > error.crank_angle:
                error.crank_angle, error.rider = left, place.link

    def failure(self, angle: float) -> Note:
        return Note(
            "the links {links} cannot be moved past crank angle {angle:.4g} deg: the loop "
            "equations have no solution nearby; change the geometry, or start from another "
            "position in [position]",
            links=", ".join(self.visible_links),
            angle=degrees(angle),
        )

    def write(self, state: State, known: Poses, q: Array, q1: Array, q2: Array) -> None:
        poses = self.poses(known, q, q1, q2)
        for link, anchor in zip(self.links, self.anchors, strict=True):
            pose = poses[link]
            state.update(zip(p(anchor), pose.place, strict=True))
            state.update(zip(u(link), pose.turn, strict=True))
            state.update(zip(along(link), pose.along, strict=False))
        for place in self.tree:
            if place.counted:
                state[f"phi({place.link})"] = poses[place.link].angle
        state[self.reference] = q


def poses_in(state: State, bodies: Iterable[tuple[str, str]]) -> Poses:
    """Poses of bodies, each with its anchor, at the crank angles (N,) of a state."""
    poses = {}
    shape = np.atleast_1d(state["theta"]).shape
    for body, anchor in bodies:
        turn = tuple(state[name] for name in u(body))
        angle = state[f"phi({body})"] if f"phi({body})" in state else np.angle(turn[0])
        values = [*(state[name] for name in p(anchor)), *turn, angle]
        full = (v if np.shape(v)[-1:] == shape else np.broadcast_to(v, (*np.shape(v)[:-1], *shape))
                for v in values)  # fmt: skip
        x, x1, x2, t, t1, t2, angle = full
        poses[body] = Pose((x, x1, x2), (t, t1, t2), angle)
    return poses


def _rising(values: Array, places: Array) -> tuple[Array, Array]:
    order = np.argsort(values)
    return values[order], places[order]


def divide(matrix: Array, right: Array) -> Array:
    """Solve matrices (..., m, n) for right-hand sides (m, ...), by least squares where they have
    more rows than columns; NaN where one is singular.
    """
    column = np.moveaxis(right, 0, -1)[..., None]
    try:
        if matrix.shape[-2] > matrix.shape[-1]:
            square, matrix = np.linalg.qr(matrix)
            column = np.swapaxes(square, -1, -2) @ column
        solution = np.linalg.solve(matrix, column)
    except np.linalg.LinAlgError:
        return np.full((matrix.shape[-1], *right.shape[1:]), np.nan)
    return np.moveaxis(solution[..., 0], -1, 0)


def gap_rows(gaps: Sequence[Any], shape: tuple[int, ...]) -> Array:
    """Gaps, or their derivatives, as an array (n, *shape)."""
    result = np.empty((len(gaps), *shape))
    for row, gap in enumerate(gaps):
        result[row] = gap
    return result


def between(theta: Array, posts: Array, q: Array, q1: Array, q2: Array) -> Array:
    """Values (n, N) at crank angles between posts, whose value and derivatives are known."""
    left = np.minimum(np.searchsorted(posts, np.arange(len(theta)), "right"), len(posts) - 1) - 1
    width = np.diff(theta[posts])[left]
    share = (theta - theta[posts[left]]) / width
    weights = HERMITE @ share ** np.arange(6)[:, None]
    ends = [(q, 1.0), (q1, width), (q2, width * width)]
    parts = [value[:, left + at] * scale for at in (0, 1) for value, scale in ends]
    return np.asarray(sum(part * weight for part, weight in zip(parts, weights, strict=True)))
