"""Drives of a machine of several that push: where their links stand, and with what force they push.

With L the lengths of the strokes, s what they are to be, q the angles of the driven links, and J
the derivatives of L by them,

    L(q) = s,    J q. = s.,    J q.. + (J). q. = s..

which Newton's method solves for the angles of the links that are pushed, near where they are known
to be about, and which tells their speeds and accelerations by those of all other drives.  A force F
that pushes acts along each drive with J^T F, and so does nothing along ways on which no length
changes.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.errors import MotionError
from equipoise.i18n import Note
from equipoise.mechanism.assembly.linkage import Linkage
from equipoise.running.drives_linkage import DrivesPose, References, pose_of
from equipoise.signals import Array

ITERATIONS, SQUARED = 12, 1e-8
"""Of Newton's method; a change of the angles, rad, after which only rounding is left, as errors
square."""


@dataclass(frozen=True, eq=False)
class Strokes:
    """The drives that push, by their places (P,) among all drives."""

    linkage: Linkage
    places: Sequence[int]

    @cached_property
    def references(self) -> list[str]:
        """Names of the angles of links that are pushed, among those that tell where a machine is
        about.
        """
        return [f"pushed({self.linkage.machine.driven[k].link})" for k in self.places]

    def references_at(self, crank_angle: float) -> References:
        """These angles (1,), rad, with all drives as the file has them at a crank angle, rad."""
        moved = self.linkage.machine.moved(np.array([crank_angle]))
        links = (self.linkage.machine.driven[k].link for k in self.places)
        return {
            name: np.ravel(moved[link][0])
            for name, link in zip(self.references, links, strict=True)
        }

    def margin(self, slopes: Array, usual: float) -> Array:
        """Squared share (K,) that forces have of a usual lever: 0 where they move no link.

        slopes : as of `lengths`.  usual : as of `lever`.
        """
        return np.asarray((self.lever(slopes) / usual) ** 2)

    def lever(self, slopes: Array) -> Array:
        """Determinant (K,) of the derivatives of all lengths by the angles of links that are
        pushed.
        """
        return np.asarray(np.linalg.det(np.moveaxis(slopes[:, [*self.places]], -1, 0)))

    def commanded(self, crank_angle: Array) -> Array:
        """Lengths at crank angles (K,), and both of their derivatives by these, (3, P, K)."""
        laws = (self.linkage.machine.driven[k].stroke for k in self.places)
        values = [law.value(crank_angle) for law in laws if law is not None]
        return np.swapaxes(np.array(values), 0, 1)

    def angles(self, crank_angle: Array, angles: Array, near: References) -> Array:
        """Angles of all drives (N, K), rad, where all lengths are as commanded.

        angles : (N, K), of which those of links that are pushed do not count.

        Raises
        ------
        MotionError : there is no such place near the references.
        """
        wanted, angles = self.commanded(crank_angle)[0], np.array(angles)
        for k, name in zip(self.places, self.references, strict=True):
            angles[k] = near[name]
        for _ in range(ITERATIONS):
            pose = pose_of(self.linkage, crank_angle, angles, np.zeros_like(angles), near)
            length, slopes, _ = self.lengths(pose)
            changes = solved(slopes[:, [*self.places]], (wanted - length)[:, None])[:, 0]
            largest = np.max(np.abs(changes))
            if not np.isfinite(largest):
                break
            angles[[*self.places]] += changes
            if largest <= SQUARED:
                return angles
        raise MotionError(Note("a stroke cannot be as long as it is to be"))

    def lengths(self, pose: DrivesPose) -> tuple[Array, Array, Array]:
        """Lengths (P, K), m, their derivatives by the angles of all drives (P, N, K), and what they
        accelerate (P, K), m/s2, while no drive does.
        """
        each = [pose.along.lengths(self.linkage.machine.driven[k]) for k in self.places]
        shape = len(each), -1, pose.count
        length, first, second = (
            np.reshape(
                [np.broadcast_to(part, pose.along.crank_angle.shape) for part in parts], shape
            )
            for parts in zip(*each, strict=True)
        )
        return length[:, -1], first[:, :-1], second[:, -1]


def solved(left: Array, right: Array) -> Array:
    """Solutions (P, R, K) of few equations (P, P, K) for R right-hand sides (P, R, K); NaN where
    there are none.
    """
    if len(left) == 1:
        return np.asarray(right / left)
    equations = np.moveaxis(left, -1, 0)
    flat = np.linalg.det(equations) == 0
    values = np.linalg.solve(
        np.where(flat[:, None, None], np.eye(len(left)), equations), np.moveaxis(right, -1, 0)
    )
    values[flat] = np.nan
    return np.moveaxis(values, 0, -1)
