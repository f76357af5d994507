"""Groups of links that no dyad solves: loop equations, and Newton's method on them.

Each joint says of two bodies that something vanishes: the gap of a pin (2 equations), turn and
offset of a slider (2), the mismatch of a gear (1).  The same expressions in velocities and
accelerations are linear in them, and the force in the joint acts where and as the gap is measured.

The unknowns of a group are position (x, y) and angle of each link.  Because the loop equations'
rates are linear in the unknowns' rates, one set of formulas gives Newton's matrix and both
derivatives.  The branch is followed from the position in the model file: neighbouring crank
angles first, then any crank angle from the nearest one followed.
"""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass
from math import degrees
from typing import Any, ClassVar

import numpy as np

from equipoise.errors import MotionError
from equipoise.mechanism import kernels
from equipoise.mechanism.steps import Array, State, p, u


@dataclass(frozen=True)
class Pose:
    """Position and angle of a body with two derivatives, each of shape (..., N)."""

    place: tuple[Any, Any, Any]
    turn: tuple[Any, Any, Any]

    def point(self, arm: complex) -> tuple[Any, Any, Any]:
        angle, w, a = self.turn
        p, p1, p2 = kernels.point(*self.place, np.exp(1j * angle), w, a, arm)
        return p, p1, p2

    def pick(self, part: slice | Array) -> Pose:
        """The pose at some of the crank angles."""
        place, turn = (tuple(value[part] for value in values) for values in (self.place, self.turn))
        return Pose(place, turn)


@dataclass(frozen=True)
class End:
    """A point of a body: `arm` from the body's anchor."""

    body: str
    point: str
    arm: complex


Poses = dict[str, Pose]
Wrench = tuple[Any, float]


@dataclass(frozen=True)
class PinLoop:
    """Two points stay together; `on` carries the force that `by` exerts."""

    name: str
    on: End
    by: End

    unknowns: ClassVar[int] = 2

    def gaps(self, poses: Poses, level: int) -> list[Any]:
        """What vanishes (level 0), and its first and second derivative."""
        here, there = (poses[end.body].point(end.arm)[level] for end in (self.on, self.by))
        return [(here - there).real, (here - there).imag]

    def place(self, poses: Poses) -> Any:
        """Where its force acts."""
        return poses[self.on.body].point(self.on.arm)[0]

    def wrenches(self, poses: Poses, sense: Any) -> list[Wrench]:
        """Force and couple on `on`, at that place, for a unit of each unknown."""
        return [(1 + 0j, 0.0), (1j, 0.0)]


@dataclass(frozen=True)
class SlideLoop:
    """A link's point stays on a line of the body `by`, and the link does not turn in it."""

    name: str
    on: End
    by: End
    direction: float
    angle: float

    unknowns: ClassVar[int] = 2

    def gaps(self, poses: Poses, level: int) -> list[Any]:
        link, guide = poses[self.on.body], poses[self.by.body]
        turn = link.turn[level] - guide.turn[level]
        if level == 0:
            turn = turn - self.direction - self.angle
        d, d1, d2 = (
            a - b for a, b in zip(link.point(self.on.arm), guide.point(self.by.arm), strict=True)
        )
        angle, w, a = guide.turn
        line = np.exp(1j * (angle + self.direction))
        return [turn, kernels.along_line(d, d1, d2, line, w, a)[level].imag]

    def place(self, poses: Poses) -> Any:
        return poses[self.on.body].point(self.on.arm)[0]

    def wrenches(self, poses: Poses, sense: Any) -> list[Wrench]:
        normal = 1j * np.exp(1j * (poses[self.by.body].turn[0] + self.direction))
        return [(0j, 1.0), (normal, 0.0)]


@dataclass(frozen=True)
class GearLoop:
    """Angles of driven link, driver and carrier in a fixed relation."""

    name: str
    on: End
    by: End
    carrier: str
    ratio: float
    offset: float
    lever: complex
    radial: float

    unknowns: ClassVar[int] = 1

    def gaps(self, poses: Poses, level: int) -> list[Any]:
        driver, carrier = poses[self.by.body].turn, poses[self.carrier].turn
        wanted = kernels.gear(*driver, *carrier, self.ratio, self.offset)
        return [poses[self.on.body].turn[level] - wanted[level]]

    def place(self, poses: Poses) -> Any:
        """The pitch point."""
        turn = np.exp(1j * poses[self.carrier].turn[0])
        return poses[self.on.body].point(self.on.arm)[0] + turn * self.lever

    def wrenches(self, poses: Poses, sense: Any) -> list[Wrench]:
        """The flank in contact, told by `sense`, sets the line of action."""
        turn = np.exp(1j * poses[self.carrier].turn[0])
        return [(kernels.tooth(turn, sense, self.lever, self.radial), 0.0)]


Loop = PinLoop | SlideLoop | GearLoop

ITERATIONS = 25
SETTLED = 1e-11
"""Last step of Newton's method, in sizes of the machine and radians, that counts as arrived."""
STRIDE = 12
"""Crank angles between those at which a branch is followed first."""
JUMP = 0.02
"""Step, in sizes of the linkage and radians, that the branch's slope does not explain."""


@dataclass(frozen=True)
class LoopGroup:
    """A group of links with as many loop equations as unknowns.

    links, anchors : the unknown links and their anchor points.
    known : other bodies that the loops touch -> their anchors.
    start : (3 n,) x, y, angle of each link at crank angle 0, on the branch.
    size : a typical length, m, against which gaps and steps are measured.
    """

    links: tuple[str, ...]
    anchors: tuple[str, ...]
    known: tuple[tuple[str, str], ...]
    equations: tuple[Loop, ...]
    start: tuple[float, ...]
    size: float

    @property
    def reference(self) -> str:
        return " and ".join(self.links)

    def run(self, state: State) -> None:
        """Solve at every crank angle; follow the branch where no solution is known nearby."""
        theta = np.atleast_1d(state["theta"])
        known = self.known_poses(state)
        guess = state.get(f"reference({self.reference})")
        if guess is None:
            q = self.follow(np.array(self.start), known, theta)
        else:
            q = self.solve(guess, known, theta)
        self.write(state, q, known)

    def known_poses(self, state: State) -> Poses:
        poses = {}
        shape = np.atleast_1d(state["theta"]).shape
        for body, anchor in self.known:
            rotation, w, a = (state[name] for name in u(body))
            angle = state.get(f"phi({body})", np.angle(rotation))
            values = [state[name] for name in p(anchor)] + [angle, w, a]
            x, x1, x2, t, t1, t2 = (np.broadcast_to(value, shape) for value in values)
            poses[body] = Pose((x, x1, x2), (t, t1, t2))
        return poses

    def poses(self, known: Poses, *levels: Array) -> Poses:
        """Poses of all bodies from unknowns and their derivatives, each (..., 3 n, N)."""
        values = [*levels, *[np.zeros_like(levels[0])] * (3 - len(levels))]
        result = dict(known)
        for k, link in enumerate(self.links):
            x, y, angle = (3 * k + i for i in range(3))
            places = (q[..., x, :] + 1j * q[..., y, :] for q in values)
            turns = (q[..., angle, :] for q in values)
            result[link] = Pose((*places,), (*turns,))  # type: ignore[arg-type]
        return result

    def gaps(self, poses: Poses, level: int) -> Array:
        """All loop equations, or their first or second derivatives, of shape (..., 3 n, N)."""
        parts = [gap for equation in self.equations for gap in equation.gaps(poses, level)]
        return np.stack(np.broadcast_arrays(*parts), axis=-2)

    def matrix(self, q: Array, known: Poses) -> Array:
        """Derivative of the loop equations by the unknowns, (N, 3 n, 3 n).

        The first derivative of the gaps is linear in that of the unknowns, and the known bodies'
        part drops out of the difference.
        """
        still = {
            body: Pose((pose.place[0], 0, 0), (pose.turn[0], 0, 0)) for body, pose in known.items()
        }
        unit = np.eye(len(q))[:, :, None] * np.ones(q.shape[1])
        gaps = self.gaps(self.poses(still, np.broadcast_to(q, unit.shape), unit), 1)
        return np.moveaxis(gaps, (0, 1, 2), (2, 1, 0))

    def solve(self, guess: Array, known: Poses, theta: Array) -> Array:
        """Newton's method at all crank angles together; guess and result (3 n, N)."""
        q = np.array(guess, dtype=float)
        with np.errstate(all="ignore"):
            for _ in range(ITERATIONS):
                gap = self.gaps(self.poses(known, q), 0)
                step = self.divide(self.matrix(q, known), gap)
                q = q - step
                if not np.all(np.isfinite(q)) or np.max(self.sizes(step)) < 1e-14:  # rounding error
                    break
            bad = ~(np.max(self.sizes(step), axis=0) < SETTLED)
        if np.any(bad):
            raise MotionError(self.failure(theta[int(np.argmax(bad))]))
        return q

    def sizes(self, steps: Array) -> Array:
        """Steps of the unknowns (3 n, N) without dimension."""
        scale = np.tile([self.size, self.size, 1.0], len(self.links))
        sizes: Array = np.abs(steps) / scale[:, None]
        return sizes

    def divide(self, matrix: Array, right: Array) -> Array:
        """Solve the loops' matrix (N, 3 n, 3 n) for a right-hand side (3 n, N)."""
        try:
            solution = np.linalg.solve(matrix, right.T[:, :, None])
        except np.linalg.LinAlgError:
            return np.full_like(right, np.nan)
        return solution[:, :, 0].T

    def derivatives(self, q: Array, known: Poses) -> tuple[Array, Array]:
        """First and second derivative of the unknowns by crank angle."""
        matrix = self.matrix(q, known)
        q1 = -self.divide(matrix, self.gaps(self.poses(known, q, np.zeros_like(q)), 1))
        q2 = -self.divide(matrix, self.gaps(self.poses(known, q, q1), 2))
        return q1, q2

    def follow(self, start: Array, known: Poses, theta: Array) -> Array:
        """Follow the branch along crank angles, from the solution `start` at the first.

        Wide steps first, with all angles between them solved together; where those do not fit
        together, every angle from the one before.
        """
        if len(theta) > 2 * STRIDE:
            with suppress(MotionError):
                return self.follow_wide(start, known, theta)
        return self.follow_each(start, known, theta)

    def follow_wide(self, start: Array, known: Poses, theta: Array) -> Array:
        posts = np.unique([*range(0, len(theta), STRIDE), len(theta) - 1])
        at_posts = self.follow_each(
            start, {b: p.pick(posts) for b, p in known.items()}, theta[posts]
        )
        way = np.abs(theta - theta[0])
        guess = np.array([np.interp(way, way[posts], row) for row in at_posts])
        q = self.solve(guess, known, theta)
        q1, _ = self.derivatives(q, known)
        bent = np.diff(q) - 0.5 * (q1[:, 1:] + q1[:, :-1]) * np.diff(theta)
        if np.max(self.sizes(bent)) > JUMP:
            raise MotionError(self.failure(theta[0]))
        return q

    def follow_each(self, start: Array, known: Poses, theta: Array) -> Array:
        columns = np.empty((len(start), len(theta)))
        here = start[:, None]
        for k in range(len(theta)):
            now = {body: pose.pick(slice(k, k + 1)) for body, pose in known.items()}
            guess = here
            here = self.solve(guess, now, theta[k : k + 1])
            columns[:, k] = here[:, 0]
            if k and np.max(self.sizes(here - guess)) > 10 * JUMP:
                raise MotionError(self.failure(theta[k]))
            if k + 1 < len(theta):
                q1, q2 = self.derivatives(here, now)
                step = theta[k + 1] - theta[k]
                here = here + q1 * step + q2 * (0.5 * step * step)
        return columns

    def failure(self, angle: float) -> str:
        links = ", ".join(self.links)
        return (
            f"the links {links} cannot be moved past crank angle {degrees(angle):.4g} deg: "
            "the loop equations have no solution nearby; change the geometry, or start from "
            "another position in [position]"
        )

    def write(self, state: State, q: Array, known: Poses) -> None:
        q1, q2 = self.derivatives(q, known)
        for k, (link, anchor) in enumerate(zip(self.links, self.anchors, strict=True)):
            x, y, angle = 3 * k, 3 * k + 1, 3 * k + 2
            place = [level[x] + 1j * level[y] for level in (q, q1, q2)]
            state.update(zip(p(anchor), place, strict=True))
            rotation = (np.exp(1j * q[angle]), q1[angle], q2[angle])
            state.update(zip(u(link), rotation, strict=True))
            state[f"phi({link})"] = q[angle]
        state[f"q({self.reference})"] = q
