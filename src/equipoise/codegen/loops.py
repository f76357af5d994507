"""Lines for a group of loops: Newton's method from the crank angle before, of many designs at once.

The group's own formulas are run on terms, so that they stand nowhere else.  A design begins with
the pose of the base, at the crank angle at which the model file tells it, and goes once round the
cycle from there.  Nothing branches: the number of Newton's steps is fixed, and what they leave is
watched; linear equations are solved by minors, of which most factors are nothing.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, fields, is_dataclass, replace
from functools import reduce
from math import pi, radians
from operator import attrgetter, itemgetter
from typing import Any

import numpy as np

from equipoise.codegen.figures import NO_FULL_TURN, NOT_COMPUTED
from equipoise.codegen.source import MARCH, Read, Sheet, Source
from equipoise.codegen.terms import Lines, Term
from equipoise.mechanism.assembly.linkage import Linkage
from equipoise.mechanism.assembly.loopgroup import FAR
from equipoise.mechanism.assembly.loops import Free, Pose, Poses
from equipoise.mechanism.assembly.newton import JUMP, SETTLED, LoopGroup, poses_in
from equipoise.mechanism.assembly.steps import p, planar, size_of_bodies, u
from equipoise.mechanism.parts.machine import FRAME

Array = np.ndarray[Any, Any]

MOST_UNKNOWNS = 7
"""Beyond which minors are too many."""


def can_write(group: LoopGroup) -> bool:
    """Whether a group can be written out: it is small, and each link hangs on a pin or a guide."""
    hung = not any(isinstance(place, Free) for place in group.tree)
    square = len(group.turning) == sum(one.unknowns for one in group.equations)
    return hung and square and len(group.turning) <= MOST_UNKNOWNS


def write_loops(sheet: Sheet, linkage: Linkage, number: int) -> None:
    """Write a group, the step of this number of the linkage's ``motion``."""
    group = linkage.motion[number]
    assert isinstance(group, LoopGroup)
    values = _Group(sheet, linkage, group, number).values()
    Lines(f"of {number}", sheet.put).write(values)


class _Group:
    """A group whose numbers are terms."""

    def __init__(self, sheet: Sheet, linkage: Linkage, group: LoopGroup, number: int) -> None:
        self.sheet, self.linkage, self.base, self.number = sheet, linkage, group, number
        self.machine = linkage.machine

        def parts(key: str) -> Any:
            read = attrgetter(key)
            name = f"{key} {number}"
            return self.slotted(getattr(group, key), name, lambda found: read(found.motion[number]))

        self.group = replace(group, tree=parts("tree"), equations=parts("equations"))
        self.size = self.slot("size", lambda found: size_of_bodies(found.machine))
        self.known = {body: self.pose_of(body) for body, _ in group.known}
        self.step, self.marked, self.steady = map(Term, MARCH)

    # -- what is given -----------------------------------------------------------------------------

    def slot(self, name: str, read: Read, vector: bool = False) -> Term:
        return Term(lambda: self.sheet.slot(name, read, vector))

    def slotted(self, value: Any, name: str, read: Read) -> Any:
        """The same with terms for its numbers."""

        def part(key: Any, get: Callable[[Any], Any]) -> Any:
            return self.slotted(get(value), f"{name} {key}", lambda found: get(read(found)))

        if isinstance(value, str) or callable(value):
            return value
        if isinstance(value, tuple):
            return tuple(part(k, itemgetter(k)) for k in range(len(value)))
        if is_dataclass(value) and not isinstance(value, type):
            keys = [field.name for field in fields(value)]
            return replace(value, **{key: part(key, attrgetter(key)) for key in keys})
        return self.slot(name, read, isinstance(value, complex | np.complexfloating))

    def pose_of(self, body: str) -> Pose:
        """Pose of a body that is known; the frame and the crank have rates that are numbers."""
        names = (*p(self.linkage.anchors[body]), *u(body))
        x, x1, x2, t, t1, t2 = (Term(self.sheet.name(name)) for name in names)
        if body == FRAME:
            return Pose((x, 0.0, 0.0), (1.0, 0.0, 0.0))
        if body == self.machine.drive.link and self.machine.has_crank:
            return Pose((x, 0.0, 0.0), (t, 1.0, 0.0))
        return Pose((x, x1, x2), (t, t1, t2))

    def carried(self, key: str, starts: Sequence[float | complex]) -> list[Term]:
        """Values that each crank angle has from the one before, the first of all these."""
        carry = self.sheet.carry
        return [Term(carry(f"{key} {k} of {self.number}", one)) for k, one in enumerate(starts)]

    def on(self, key: str, *values: Any) -> dict[str, Any]:
        """What the next crank angle has of these."""
        return {f"next {key} {k} of {self.number}": value for k, value in enumerate(values)}

    def told(self) -> tuple[list[float | complex], float]:
        """The base's unknowns, and the determinant of its slopes, where the file tells its pose."""
        assert self.machine.position is not None
        state = self.linkage.solve(np.array([self.machine.position.crank_angle]))
        q = state[self.base.reference]
        _, slopes = self.base.slopes(poses_in(state, self.base.known), q)
        pairs = zip(q[:, 0].tolist(), self.base.turning, strict=True)
        start = [complex(np.exp(1j * one)) if turns else one for one, turns in pairs]
        return start, float(np.linalg.det(slopes)[0])

    # -- from one crank angle to the next ----------------------------------------------------------

    def values(self) -> dict[str, Any]:
        """Poses by their names in a state, and what is carried on."""
        start, determinant = self.told()
        nothing = [0.0] * len(start)
        q, first = self.carried("unknown", start), self.carried("first", start)
        w, a = self.carried("rate", nothing), self.carried("curvature", nothing)
        h = self.step
        q = self.moved(q, [h * one + h * h * 0.5 * two for one, two in zip(w, a, strict=True)])
        minors = _Minors(self.slopes(q))
        ahead = minors.solve(self.gaps(q))
        q = self.moved(q, [-one for one in ahead])
        q = self.moved(q, [-one for one in minors.solve(self.gaps(q))])
        minors = _Minors(self.slopes(q))
        left = minors.solve(self.gaps(q))
        w = [-one for one in minors.solve(self.group.gaps(self.poses(self.known, q), 1))]
        a = [-one for one in minors.solve(self.group.gaps(self.poses(self.known, q, w), 2))]
        first = [one + self.marked * (now - one) for one, now in zip(first, q, strict=True)]
        poses = self.poses(self.known, q, w, a)
        found: dict[str, Any] = {}
        for link, anchor in zip(self.group.links, self.group.anchors, strict=True):
            found |= zip(p(anchor), poses[link].place, strict=True)
            found |= zip(u(link), poses[link].turn, strict=True)
        found |= self.on("unknown", *q) | self.on("first", *first)
        found |= self.on("rate", *w) | self.on("curvature", *a)
        self.carried("open", [0.0])
        found |= self.on("open", self.apart(q, first))
        last, jump = (reduce(_greatest, map(abs, self.scaled(steps))) for steps in (left, ahead))
        (astray,) = self.carried("astray", [0.0])
        off = reduce(_greatest, self.misplaced(poses), last)
        found |= self.on("astray", _greatest(astray, self.marked * off))
        return found | self.settled(determinant, last, jump, minors.whole)

    def settled(self, start: float, last: Any, jump: Any, whole: Any) -> dict[str, Any]:
        """Whether Newton's method arrives, without a jump, where the determinant has its sign."""
        (before,), (loose,) = self.carried("determinant", [start]), self.carried("loose", [0.0])
        turned = -(whole * before) / (whole * whole + before * before + 1e-300)
        unsound = _greatest(_greatest(last, jump - 10 * JUMP), turned)
        return self.on("determinant", before + self.steady * (whole - before)) | self.on(
            "loose", _greatest(loose, self.steady * unsound)
        )

    def misplaced(self, poses: Poses) -> Iterator[Any]:
        """Of each point: above 0 where it is too far from where the file tells it to be."""
        machine = self.machine
        assert machine.position is not None
        for link, anchor in zip(self.group.links, self.group.anchors, strict=True):
            for name in machine.links[link].points:
                if name not in machine.position.points:
                    continue

                def arm(
                    found: Linkage, link: str = link, name: str = name, to: str = anchor
                ) -> Any:
                    points = found.machine.links[link].points
                    return planar(points[name]) - planar(points[to])

                vector = self.slot(f"arm({link}/{name})", arm, vector=True)
                at = poses[link].place[0] if name == anchor else poses[link].point(vector)[0]
                way = at - complex(*machine.position.points[name])
                far = way.real * way.real + way.imag * way.imag
                yield far / (self.size * self.size) - FAR**2

    def apart(self, q: list[Any], others: list[Any]) -> Any:
        """How far two sets of unknowns are from each other, squared."""
        ways = self.scaled([one - other for one, other in zip(q, others, strict=True)])
        return sum((way * way.conjugate()).real for way in ways)

    def scaled(self, values: list[Any]) -> list[Any]:
        """Ways over the size of the machine, and angles."""
        pairs = zip(values, self.group.turning, strict=True)
        return [one if turns else one / self.size for one, turns in pairs]

    def moved(self, q: list[Any], steps: list[Any]) -> list[Any]:
        """Unknowns after steps, of which none is beyond all measure."""
        return [
            _turned(one, step) if turns else one + _bounded(step / self.size) * self.size
            for one, step, turns in zip(q, steps, self.group.turning, strict=True)
        ]

    def poses(self, known: Poses, q: list[Any], *rates: list[Any]) -> Poses:
        pairs = zip(q, self.group.turning, strict=True)
        values = [(one, 0.0) if turns else one for one, turns in pairs]
        return self.group.poses(known, values, *rates)

    def gaps(self, q: list[Any]) -> list[Any]:
        return self.group.gaps(self.poses(self.known, q), 0)

    def slopes(self, q: list[Any]) -> list[list[Any]]:
        """Derivative of each loop equation by each unknown."""
        known = {body: pose.still for body, pose in self.known.items()}
        units = np.eye(len(q)).tolist()
        columns = [self.group.gaps(self.poses(known, q, unit), 1) for unit in units]
        return [list(row) for row in zip(*columns, strict=True)]


class _Minors:
    """Linear equations, solved by minors of their rows.

    whole : the determinant.
    """

    def __init__(self, rows: list[list[Any]]) -> None:
        self.rows = rows
        self.found: dict[tuple[int, ...], Any] = {(): 1.0}
        self.whole = _minor(rows, tuple(range(len(rows))), self.found)
        self.inverse = 1.0 / self.whole

    def solve(self, right: list[Any]) -> list[Any]:
        """What the rows make the right-hand side of."""
        count = len(right)
        rows = [[*row, one] for row, one in zip(self.rows, right, strict=True)]
        found = dict(self.found)
        result = []
        for k in range(count):
            others = (*range(k), *range(k + 1, count), count)
            sign = -1.0 if (count - 1 - k) % 2 else 1.0
            result.append(sign * _minor(rows, others, found) * self.inverse)
        return result


def _minor(rows: list[list[Any]], columns: tuple[int, ...], found: dict[Any, Any]) -> Any:
    """Determinant of these columns of as many rows; those that were found are kept."""
    if columns not in found:
        row = len(columns) - 1
        total: Any = 0.0
        for k, column in enumerate(columns):
            entry = rows[row][column]
            if isinstance(entry, Term) or entry != 0:
                value = entry * _minor(rows, (*columns[:k], *columns[k + 1 :]), found)
                total = total - value if (row + k) % 2 else total + value
        found[columns] = total
    return found[columns]


def _turned(rotation: Any, angle: Any) -> Any:
    """A rotation turned on by about this angle, without a sine: twice the angle of 1 + i t."""
    t = _bounded(angle * 0.5)
    scale = 1.0 / (t * t + 1.0)
    return rotation * ((1.0 - t * t) * scale + 1j * (2.0 * t * scale))


def _bounded(value: Any) -> Any:
    return Term("greatest(-1.0, smallest(1.0, {}))", value)


def _greatest(one: Any, other: Any) -> Any:
    return Term("greatest({}, {})", one, other)


# -- once round the cycle --------------------------------------------------------------------------

STEPS = (radians(4), radians(0.5), radians(1 / 12))
"""Farthest that crank angles are apart; the next for designs that have not stayed on their branch.
The last tells whether a design turns at all."""
ARRIVALS = 6
"""Rounds of Newton's method from the base's pose, before the crank turns."""


@dataclass(frozen=True)
class March:
    """Once round the cycle, from the crank angle at which the file tells the pose.

    source : whose loop it is.  begin : that crank angle, within the cycle of `period` (rad).
    """

    source: Source
    begin: float
    period: float

    @classmethod
    def of(cls, source: Source, base: Linkage) -> March | None:
        """The march of a source; None where each crank angle stands alone."""
        position = base.machine.position
        if not source.carried or position is None:
            return None
        period = 2 * pi * base.cycle.turns
        return cls(source, position.crank_angle % period, period)

    def grid(self, theta: Array, step: float = STEPS[0], shares: Array | None = None) -> Array:
        """Rows (G, M) for the loop, to gather at crank angles (N,) and to go no farther at once.

        The first row is the number of the crank angle, -1 where nothing is gathered; the last one
        its share in a mean, where the source asks for shares.
        """
        asked = np.mod(theta - self.begin, self.period)
        order = np.argsort(asked, kind="stable")
        ways = np.concatenate([np.zeros(ARRIVALS), asked[order], [self.period]])
        widths = np.diff(ways)
        counts = np.maximum(1, np.ceil(widths / step)).astype(int)
        ends = np.cumsum(counts)
        within = np.arange(ends[-1]) - np.repeat(ends - counts, counts) + 1
        ways = np.append(
            0.0, np.repeat(ways[:-1], counts) + within * np.repeat(widths / counts, counts)
        )
        number = np.full(len(ways), -1)
        number[ends[ARRIVALS - 1 : -1]] = order
        angles = np.mod(self.begin + ways, self.period)
        angles[number >= 0] = theta[order]
        place = np.arange(len(ways))
        rows = [number, np.diff(ways, prepend=0.0), place == ARRIVALS - 1, place >= ARRIVALS - 1]
        rows += [row.values(angles) for row in self.source.rows]
        if self.source.has_shares:
            share = np.zeros(len(ways))
            share[number >= 0] = 0.0 if shares is None else shares[order]
            rows.append(share)
        return np.ascontiguousarray(rows, dtype=float)

    def unsettled(self, found: Array) -> Array:
        """Designs (K,), of those gathered (P, R), that have not stayed on their branch."""
        return np.flatnonzero(~np.all(found[:, self.source.ends["loose"]] <= SETTLED, axis=1))

    def reasons(self, reason: Array, found: Array) -> None:
        """Fill in why designs (P,) failed of which this much was gathered (P, R).

        Those that did not arrive, or came back elsewhere, may do otherwise from the position in the
        file, or after further turns.
        """
        ends = {key: found[:, columns] for key, columns in self.source.ends.items()}
        reason[~np.all(ends["open"] <= JUMP**2, axis=1)] = NOT_COMPUTED
        reason[self.unsettled(found)] = NO_FULL_TURN
        reason[~np.all(ends["astray"] <= SETTLED, axis=1)] = NOT_COMPUTED
