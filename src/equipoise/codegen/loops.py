"""A group of loops in terms: Newton's method from the crank angle before, of many designs at once.

The group's own formulas are run on terms, so that they stand nowhere else.  A design begins with
the pose of the base, at the crank angle at which the model file gives it, and goes once round the
cycle from there.  Nothing branches: the number of Newton's steps is fixed, and what they leave is
watched; linear equations are solved by minors, of which most factors are nothing.

Of the joint forces those that close the loops follow by virtual work, from as many equations as
there are unknowns of the motion; what is left on each link its own joint in the tree supplies, the
last links first.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import reduce
from itertools import islice
from math import pi
from operator import attrgetter
from typing import Any

import numpy as np

from equipoise.codegen.coupled import can_look_up, slotted
from equipoise.codegen.terms import ANGLE, Term, floor, greatest, least, pick, rotation
from equipoise.codegen.trace import FAR as LOWEST
from equipoise.codegen.trace import Trace
from equipoise.mechanism.assembly.linkage import Linkage
from equipoise.mechanism.assembly.loopgroup import FAR, LoopForces, exerted
from equipoise.mechanism.assembly.loops import (
    JUMP,
    Free,
    LinkAttachment,
    LoopEquation,
    LoopGroup,
    Pose,
    Poses,
    Riding,
    poses_in,
)
from equipoise.mechanism.assembly.steps import along, p, size_of_bodies, u
from equipoise.mechanism.formulas.kernels import cross, dot
from equipoise.mechanism.parts.machine import FRAME
from equipoise.signals import Array

MOST_UNKNOWNS = 7
"""Beyond which minors are too many."""
FROM_BASE = 5
"""Rounds of Newton's method where each crank angle stands alone."""
THINNED = 4
"""Of the rows that the base has over its cycle, those that a formula takes: one in so many."""
ARRIVED = 1e-8
"""Last of them, in sizes of the machine and radians, up to which 3/2 count as arrived."""
MARCH = ("step", "marked", "steady")
"""What is given of a crank angle in a march: how far it is from the one before; 1 where the file
gives the pose, else 0; 1 from there on, 0 before."""
WATCHED = ("loose", "astray", "open")
"""Values that are carried on, whose last shows of a design whether Newton's method left its branch;
did not arrive from the base, or too far from the file's pose; came back elsewhere."""


def between_rows(trace: Trace, table: Array, period: float) -> Any:
    """Rows (n + 1,) over the crank angle, evenly spaced from 0 to a period, as a term: linear
    between them.  What it gains in a period is left out.
    """
    count = float(len(table) - 1)
    place = trace.theta * (count / period)
    place = place - count * floor(place * (1 / count))
    row = least(count - 1, floor(place))
    steps = pick(trace.graph.table(np.diff(table)), row)
    return pick(trace.graph.table(table[:-1]), row) + (place - row) * steps


def can_trace(group: LoopGroup) -> bool:
    """Whether a group can be traced: it is small, and each link hangs on a pin, guide or track."""
    hung = not any(isinstance(place, Free) for place in group.tree)
    curves = [place.curve for place in group.tree if isinstance(place, Riding)]
    hung = hung and all(map(can_look_up, curves))
    square = len(group.turning) == sum(equation.unknowns for equation in group.equations)
    return hung and square and len(group.turning) <= MOST_UNKNOWNS


def trace_loops(trace: Trace, number: int) -> None:
    """A group, the step of this number of the linkage's ``motion``."""
    group = trace.linkage.motion[number]
    assert isinstance(group, LoopGroup)
    traced = trace.groups[group.reference] = TracedGroup(trace, group, number)
    if trace.alone:
        traced.start_at_base()
    else:
        traced.go_on()


def group_of(trace: Trace, group: LoopGroup) -> TracedGroup:
    """A group that was traced, with its poses."""
    traced_group: TracedGroup = trace.groups[group.reference]
    return traced_group


class TracedGroup:
    """A group whose numbers are terms.

    reached : its unknowns once they are solved.  final : poses with their rates.
    still : known bodies without their rates.
    """

    def __init__(self, trace: Trace, group: LoopGroup, number: int) -> None:
        self.trace, self.linkage, self.base, self.number = trace, trace.linkage, group, number
        self.machine = trace.machine

        def parts(key: str) -> Any:
            def read(linkage: Linkage) -> Any:
                return getattr(linkage.motion[number], key)

            return slotted(trace, getattr(group, key), f"{key} {number}", read)

        self.size = trace.slot("size", lambda linkage: size_of_bodies(linkage.machine))
        self.group = replace(
            group, tree=parts("tree"), equations=parts("equations"), size=self.size
        )
        self.known = {body: self.pose_of(body) for body, _ in group.known}
        self.step, self.marked, self.steady = (trace.graph.argument(item, ANGLE) for item in MARCH)

    # -- what is given -----------------------------------------------------------------------------

    def pose_of(self, body: str) -> Pose:
        """Pose of a body that is known; the frame and the crank have rates that are numbers."""
        names = (*p(self.linkage.anchors[body]), *u(body))
        x, x1, x2, t, t1, t2 = (self.trace.state[name] for name in names)
        if body == FRAME:
            return Pose((x, 0.0, 0.0), (1.0, 0.0, 0.0))
        if body == self.machine.drive.link and self.machine.has_crank:
            return Pose((x, 0.0, 0.0), (t, 1.0, 0.0))
        return Pose((x, x1, x2), (t, t1, t2))

    def carried(self, starts: Sequence[float | complex], watch: str = "") -> list[Any]:
        """Values that each crank angle has from the one before, the first of all these."""
        return [self.trace.carry(start, watch) for start in starts]

    def carry_on(self, before: Sequence[Any], values: Sequence[Any]) -> None:
        """What the next crank angle has of these."""
        for item, value in zip(before, values, strict=True):
            self.trace.carry_on(item, value)

    def known_pose(self) -> tuple[list[float | complex], float]:
        """The base's unknowns, and the determinant of its slopes, where the file gives its pose."""
        assert self.machine.position is not None
        state = self.linkage.solve(np.array([self.machine.position.crank_angle]))
        q = state[self.base.reference]
        _, slopes = self.base.slopes(poses_in(state, self.base.known), q)
        pairs = zip(q[:, 0].tolist(), self.base.turning, strict=True)
        start = [complex(np.exp(1j * item)) if turns else item for item, turns in pairs]
        return start, float(np.linalg.det(slopes)[0])

    # -- from one crank angle to the next ----------------------------------------------------------

    def go_on(self) -> None:
        """Add poses to the state, and what is carried on."""
        start, determinant = self.known_pose()
        nothing = [0.0] * len(start)
        before, first = self.carried(start), self.carried(start)
        rates, bends = self.carried(nothing), self.carried(nothing)
        h = self.step
        ahead = [h * rate + h * h * 0.5 * two for rate, two in zip(rates, bends, strict=True)]
        q = self.moved(before, ahead)
        minors = Minors(self.slopes(q))
        jump = minors.balanced(self.gaps(q))
        q = self.moved(q, jump)
        q = self.moved(q, minors.balanced(self.gaps(q)))
        minors = Minors(self.slopes(q))
        left = minors.solve(self.gaps(q))
        w, a = self.put(q, minors)
        poses = self.final
        self.carry_on(before, q)
        marked = [item + self.marked * (now - item) for item, now in zip(first, q, strict=True)]
        self.carry_on(first, marked)
        self.carry_on(rates, w)
        self.carry_on(bends, a)
        self.carry_on(self.carried([0.0], "open"), [self.apart(q, marked)])
        farthest, longest = (
            reduce(greatest, map(abs, self.group.scaled(steps))) for steps in (left, jump)
        )
        (astray,) = self.carried([0.0], "astray")
        off = reduce(greatest, self.misplaced(poses), farthest)
        self.carry_on([astray], [greatest(astray, self.marked * off)])
        self.settle(determinant, farthest, longest, minors.whole)

    def start_at_base(self) -> None:
        """Add poses to the state that Newton's method finds from those of the base at the same
        crank angle, so that each crank angle stands alone.
        """
        q = [self.of_base(k, turns) for k, turns in enumerate(self.group.turning.tolist())]
        for _ in range(FROM_BASE):
            q = self.moved(q, Minors(self.slopes(q)).balanced(self.gaps(q)))
        minors = Minors(self.slopes(q))
        left = reduce(greatest, map(abs, self.group.scaled(minors.solve(self.gaps(q)))))
        self.put(q, minors)
        _, start = self.known_pose()
        whole = minors.whole
        same = 2 * start * whole / (whole * whole + start * start)
        names = " and ".join(self.group.visible_links)
        self.trace.running[f"{names} arrive"] = 1.0 - left * (1 / ARRIVED)
        self.trace.running[f"{names} stay"] = (
            same + LOWEST
        )  # which is too low where the determinant has the other sign

    def of_base(self, number: int, turns: bool) -> Any:
        """What the base has for an unknown, of an angle the rotation."""
        name, cycle = self.base.reference, self.linkage.cycle
        table = cycle.tables[name][number]
        value = self.trace.row(
            f"{name}, {number + 1}",
            lambda theta: np.asarray(cycle.reference(name, theta)[number]),
            between_rows(self.trace, table[::THINNED], 2 * pi * cycle.turns),
        )
        return rotation(value) if turns else value

    def put(self, q: list[Any], minors: Minors) -> tuple[list[Any], list[Any]]:
        """Add poses to the state, with their rates; those of the unknowns."""
        w, a = self.group.derivatives_by(minors.balanced, self.unknowns(q), self.known)
        poses = self.final = self.poses(self.known, q, w, a)
        self.reached, self.still = q, {body: pose.still for body, pose in self.known.items()}
        for link, anchor in zip(self.group.links, self.group.anchors, strict=True):
            self.trace.put(p(anchor), poses[link].place)
            self.trace.put(u(link), poses[link].turn)
            self.trace.state.update(zip(along(link), poses[link].along, strict=False))
        return w, a

    def settle(self, start: float, last: Any, jump: Any, whole: Any) -> None:
        """Whether Newton's method arrives, without a jump, where the determinant has its sign."""
        (before,), (loose,) = self.carried([start]), self.carried([0.0], "loose")
        turned = -(whole * before) / (whole * whole + before * before + 1e-300)
        unsound = greatest(greatest(last, jump - 10 * JUMP), turned)
        self.carry_on([before], [before + self.steady * (whole - before)])
        self.carry_on([loose], [greatest(loose, self.steady * unsound)])

    def misplaced(self, poses: Poses) -> Iterator[Any]:
        """Of each point: above 0 where it is too far from its position in the file."""
        machine = self.machine
        assert machine.position is not None
        for _, way in self.group.ways_from(machine.position, machine, poses, self.trace.arm):
            far = way.real * way.real + way.imag * way.imag
            yield far / (self.size * self.size) - FAR**2

    def apart(self, q: list[Any], others: list[Any]) -> Any:
        """How far two sets of unknowns are from each other, squared."""
        ways = self.group.scaled(item - other for item, other in zip(q, others, strict=True))
        return sum((way * way.conjugate()).real for way in ways)

    def moved(self, q: list[Any], steps: list[Any]) -> list[Any]:
        """Unknowns after steps, of which none is beyond all measure."""
        return [
            _turned(item, step) if turns else item + _bounded(step / self.size) * self.size
            for item, step, turns in zip(q, steps, self.group.turning, strict=True)
        ]

    def poses(self, known: Poses, q: list[Any], *rates: list[Any]) -> Poses:
        return self.group.poses(known, self.unknowns(q), *rates)

    def unknowns(self, q: list[Any]) -> list[Any]:
        """Unknowns as poses take them: of an angle the rotation, and no angle."""
        pairs = zip(q, self.group.turning, strict=True)
        return [(item, 0.0) if turns else item for item, turns in pairs]

    def gaps(self, q: list[Any]) -> list[Any]:
        return self.group.gaps(self.poses(self.known, q), 0)

    def slopes(self, q: list[Any]) -> list[list[Any]]:
        """Derivative of each loop equation by each unknown: as of `LoopGroup.slopes`, by one
        evaluation of each unknown, as terms have no axis for all of them.
        """
        known = {body: pose.still for body, pose in self.known.items()}
        units = np.eye(len(q)).tolist()
        columns = [self.group.gaps(self.poses(known, q, unit), 1) for unit in units]
        return [list(row) for row in zip(*columns, strict=True)]


class Minors:
    """Linear equations, solved by minors of their rows.

    whole : the determinant.
    """

    def __init__(self, rows: list[list[Any]]) -> None:
        self.rows = rows
        self.minors: dict[tuple[int, ...], Any] = {(): 1.0}
        self.whole = _minor(rows, tuple(range(len(rows))), self.minors)
        self.inverse = 1.0 / self.whole

    def solve(self, right: list[Any]) -> list[Any]:
        """What the rows make the right-hand side of."""
        count = len(right)
        rows = [[*row, item] for row, item in zip(self.rows, right, strict=True)]
        by_name = dict(self.minors)
        result = []
        for k in range(count):
            others = (*range(k), *range(k + 1, count), count)
            sign = -1.0 if (count - 1 - k) % 2 else 1.0
            result.append(sign * _minor(rows, others, by_name) * self.inverse)
        return result

    def balanced(self, gaps: list[Any]) -> list[Any]:
        """What makes up for gaps: minus the solution for them."""
        return [-item for item in self.solve(gaps)]


def _minor(rows: list[list[Any]], columns: tuple[int, ...], minors: dict[Any, Any]) -> Any:
    """Determinant of these columns of as many rows; those that were found are kept."""
    if columns not in minors:
        row = len(columns) - 1
        total: Any = 0.0
        for k, column in enumerate(columns):
            entry = rows[row][column]
            if isinstance(entry, Term) or entry != 0:
                value = entry * _minor(rows, (*columns[:k], *columns[k + 1 :]), minors)
                total = total - value if (row + k) % 2 else total + value
        minors[columns] = total
    return minors[columns]


def _turned(rotation: Any, angle: Any) -> Any:
    """A rotation turned on by about this angle, without a sine: twice the angle of 1 + i t."""
    t = _bounded(angle * 0.5)
    scale = 1.0 / (t * t + 1.0)
    return rotation * ((1.0 - t * t) * scale + 1j * (2.0 * t * scale))


def _bounded(value: Any) -> Any:
    return greatest(-1.0, least(1.0, value))


# -- forces ----------------------------------------------------------------------------------------

WrenchTerms = tuple[Any, Any]


def trace_loop_forces(trace: Trace, number: int) -> None:
    """Forces of a group's joints, the step of this number of the linkage's ``forces``."""
    step = trace.linkage.forces[number]
    assert isinstance(step, LoopForces)
    _Forces(trace, step, number).put()


class _Forces:
    """Joints of a group whose numbers are terms.

    demands : what the joints of each link have to supply yet, about its anchor.
    """

    def __init__(self, trace: Trace, step: LoopForces, number: int) -> None:
        self.trace, self.step, self.solved = trace, step, group_of(trace, step.group)

        def read(linkage: Linkage) -> Any:
            return attrgetter("loops")(linkage.forces[number])

        self.loops: tuple[LoopEquation, ...] = slotted(trace, step.loops, f"loops {number}", read)
        self.poses = self.solved.final
        self.demands: dict[str, WrenchTerms] = {
            link: (trace.state[f"F({link})"], trace.state[f"M({link})"])
            for link in step.group.links
        }
        closing = {_key(equation) for equation in step.group.equations}
        self.closing = [k for k, loop in enumerate(step.loops) if _key(loop) in closing]

    def put(self) -> None:
        """Add the forces to the state."""
        closing = [self.loops[k] for k in self.closing]
        strengths = iter(self.by_work(closing))
        for k, loop in zip(self.closing, closing, strict=True):
            parts = [*islice(strengths, loop.unknowns)]
            self.exert(k, *exerted(loop.wrenches(self.poses, 0.0), parts))
        for place in reversed(self.step.group.tree):
            self.supply(place)

    def by_work(self, closing: list[LoopEquation]) -> list[Any]:
        """Strengths of the joints that close the loops: on every motion that the tree leaves, they
        do the work that the links demand.
        """
        rows, right = [], []
        for unit in np.eye(len(self.solved.group.turning)).tolist():
            moved = self.solved.poses(self.solved.still, self.solved.reached, unit)
            rows.append([work for loop in closing for work in self.works(loop, moved)])
            right.append(sum(
                dot(force, moved[link].place[1]) + moment * moved[link].turn[1]
                for link, (force, moment) in self.demands.items()
            ))  # fmt: skip
        return Minors(rows).solve(right)

    def works(self, loop: LoopEquation, moved: Poses) -> Iterator[Any]:
        """Work of a unit of each of a joint's unknowns, on both of its bodies."""
        at = loop.place(self.poses)
        ends = [(sign, moved[end.body]) for sign, end in ((1.0, loop.on), (-1.0, loop.by))
                if end.body in self.demands]  # fmt: skip
        for force, couple in loop.wrenches(self.poses, 0.0):
            yield sum(sign * _work(pose, at, force, couple) for sign, pose in ends)

    def supply(self, place: LinkAttachment) -> None:
        """What the joint supplies by which the tree places a link: all that is left on it."""
        ends = {place.link, place.to.body}  # type: ignore[union-attr]
        k = next(k for k, loop in enumerate(self.step.loops)
                 if k not in self.closing and {loop.on.body, loop.by.body} == ends)  # fmt: skip
        loop, (force, moment) = self.loops[k], self.demands[place.link]
        sign = 1.0 if loop.on.body == place.link else -1.0
        couple = moment - cross(loop.place(self.poses) - self.poses[place.link].place[0], force)
        if loop.turns:
            (_, _), (across, _) = loop.wrenches(self.poses, 0.0)
            self.exert(k, dot(across, force) * sign * across, sign * couple)
        else:
            self.exert(k, sign * force, 0.0)

    def exert(self, k: int, force: Any, couple: Any) -> None:
        """Take what a joint exerts off what its links demand, and add it to the state."""
        loop, reaction = self.loops[k], self.step.reactions[k]
        self.trace.state.update(zip(reaction.outputs, (force, couple), strict=False))
        at = loop.place(self.poses)
        for sign, end in ((1.0, loop.on), (-1.0, loop.by)):
            if end.body in self.demands:
                left, moment = self.demands[end.body]
                turning = cross(at - self.poses[end.body].place[0], force) + couple
                self.demands[end.body] = left - sign * force, moment - sign * turning


def _key(loop: LoopEquation) -> tuple[str, str, str]:
    return loop.name, loop.on.body, loop.by.body


def _work(pose: Any, at: Any, *wrench: Any) -> Any:
    """Work of a force at a place, and of a couple, on a body by the rates of a pose."""
    force, couple = wrench
    speed = pose.place[1] + 1j * pose.turn[1] * (at - pose.place[0])
    return dot(force, speed) + couple * pose.turn[1]
