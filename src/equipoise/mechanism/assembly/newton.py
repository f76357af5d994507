"""Newton's method on the loop equations of groups of links that no dyad solves.

One joint of each link only tells where the link is: of a link on a pin the angle is unknown, of one
on a guide how far along it lies.  These joints make a tree, from the bodies that are known to every
link; what they leave open, the others close.  The start alone, from a rough position, takes every
joint for an equation, with place and angle of each link unknown.

Because the loop equations' rates are linear in the unknowns' rates, one set of formulas gives
Newton's matrix and both derivatives.  The branch is followed from the position in the model file:
neighbouring crank angles first, then any crank angle from the nearest one followed.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from contextlib import suppress
from functools import cached_property
from math import ceil, degrees, radians
from typing import Any

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.decompositions import singular_values
from equipoise.errors import MotionError
from equipoise.i18n import Note
from equipoise.mechanism.assembly.loops import Loop, Place, Pose, Poses, Riding
from equipoise.mechanism.assembly.steps import Array, State, along, p, u
from equipoise.mechanism.formulas.plane_curves import HERMITE
from equipoise.signals import first_below

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


Levels = tuple[Array, Array, Array]  # the unknowns, and their two derivatives


@dataclass(frozen=True)
class LoopGroup:
    """A group of links with as many loop equations as unknowns, or more that go together.

    links, anchors : the unknown links and their anchor points.
    shown : those of the links that are not inside of joints.
    known : other bodies that the loops touch -> their anchors.
    tree : where each link is, in an order in which the bodies that this asks for come first.
    equations : the joints that the tree leaves.
    start : (n,) unknowns at crank angle 0, on the branch.
    size : a typical length, m, against which gaps and steps are measured.
    """

    links: tuple[str, ...]
    anchors: tuple[str, ...]
    known: tuple[tuple[str, str], ...]
    tree: tuple[Place, ...]
    equations: tuple[Loop, ...]
    start: Any
    size: Any
    shown: tuple[str, ...] = ()

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
        rates = self.stacked(poses, 1, (count, *shape))
        return self.stacked(poses, 0, shape), np.moveaxis(rates, (0, 1), (-2, -1))

    def stacked(self, poses: Poses, level: int, shape: tuple[int, ...]) -> Array:
        """The gaps, or their derivatives, (n, *shape)."""
        gaps = self.gaps(poses, level)
        result = np.empty((len(gaps), *shape))
        for row, gap in enumerate(gaps):
            result[row] = gap
        return result

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
        sizes = np.abs(steps)
        sizes[~self.turning] /= self.size
        return sizes

    def derivatives(self, q: Array, known: Poses) -> tuple[Array, Array]:
        """First and second derivative of the unknowns by crank angle."""
        _, matrix = self.slopes(known, q)
        q1 = -divide(matrix, self.stacked(self.poses(known, q), 1, q.shape[1:]))
        q2 = -divide(matrix, self.stacked(self.poses(known, q, q1), 2, q.shape[1:]))
        return q1, q2

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
            links=", ".join(self.shown),
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


def between(theta: Array, posts: Array, q: Array, q1: Array, q2: Array) -> Array:
    """Values (n, N) at crank angles between posts, whose value and derivatives are known."""
    left = np.minimum(np.searchsorted(posts, np.arange(len(theta)), "right"), len(posts) - 1) - 1
    width = np.diff(theta[posts])[left]
    share = (theta - theta[posts[left]]) / width
    weights = HERMITE @ share ** np.arange(6)[:, None]
    ends = [(q, 1.0), (q1, width), (q2, width * width)]
    parts = [value[:, left + at] * scale for at in (0, 1) for value, scale in ends]
    return np.asarray(sum(part * weight for part, weight in zip(parts, weights, strict=True)))
