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
from equipoise.running.drives_linkage import (
    DriveAngles,
    DrivesPose,
    References,
    drives_at,
    pose_of,
    references_at,
)
from equipoise.signals import Array

ITERATIONS, SQUARED = 12, 1e-8
"""Of Newton's method; a change of the angles, rad, after which only rounding is left, as errors
square."""


@dataclass(frozen=True, eq=False)
class Strokes:
    """The drives that push, by their places (P,) among all drives.

    by_crank : whether the first unknown of the machine is its crank angle.
    start : crank angle at the start, rad.  Coordinates beside the drives, of a support, change no
    length.
    """

    linkage: Linkage
    places: Sequence[int]
    by_crank: bool
    start: float

    @property
    def _pushed(self) -> list[int]:
        """Places of the drives, for arrays."""
        return [*self.places]

    @cached_property
    def _names(self) -> list[str]:
        """Names of the angles of links that are pushed, among the references."""
        return [f"pushed({link})" for link in self.links]

    def references(self, angles: Array) -> References:
        """Angles of links that are pushed (K,), by those of all drives (N, K), rad."""
        return dict(zip(self._names, angles[self._pushed], strict=True))

    def references_at(self, crank_angles: Array) -> References:
        """Angles of links that are pushed (K,), rad, with all drives as the file has them at crank
        angles (K,), rad.
        """
        each = [drives_at(self.linkage.machine, angle)[0] for angle in crank_angles.tolist()]
        return self.references(np.array(each).T)

    @property
    def links(self) -> list[str]:
        """Links that are pushed."""
        return [self.linkage.machine.driven[k].link for k in self.places]

    def margin(self, slopes: Array) -> Array:
        """Squared share (K,) that forces have of the lever at the start: 0 where they move no link.

        slopes : as of `lengths`.
        """
        return np.asarray((self._lever(slopes) / self._usual_lever) ** 2)

    def _lever(self, slopes: Array) -> Array:
        """Determinant (K,) of the derivatives of all lengths by the angles of links that are
        pushed.
        """
        return np.asarray(np.linalg.det(np.moveaxis(slopes[:, self._pushed], -1, 0)))

    @cached_property
    def _usual_lever(self) -> float:
        """Lever at the start, with all drives as the file has them."""
        angles = drives_at(self.linkage.machine, self.start)[0][:, None]
        references = references_at(self.linkage, self.start)
        crank = np.array([self.start])
        _, slopes, _ = self._lengths_at(crank, angles, np.zeros_like(angles), references)
        return float(self._lever(slopes)[0])

    def placed(self, where: DriveAngles, crank_speed: Array, references: References) -> DriveAngles:
        """All drives, of which those that push are about where references have them.

        where : all others.  crank_speed : (K,), rad/s.

        Raises
        ------
        MotionError : a stroke cannot be as long as it is to be.
        """
        pushed, crank = self._pushed, where.crank_angle
        angles = self._angles(crank, where.angles, references)
        speeds, jacobian, bias, virtual = (
            part.copy()
            for part in (
                where.speeds, where.jacobian, where.bias_accelerations, where.virtual_speeds
            )
        )  # fmt: skip
        speeds[pushed] = 0.0
        lengths, slopes, _ = self._lengths_at(crank, angles, speeds, references)
        _, first, second = self._commanded(crank)
        commanded = np.zeros((len(pushed), *jacobian.shape[1:]))
        virtual[pushed] = self._rates(slopes, commanded, virtual)
        if self.by_crank:
            commanded[:, 0] = first
        jacobian[pushed] = self._rates(slopes, commanded, jacobian)
        speeds[pushed] = self._rates(slopes, first * crank_speed, speeds)
        bent = self._lengths_at(crank, angles, speeds, references)[2]
        bias[pushed] = self._rates(slopes, second * crank_speed**2 - bent, bias)
        effort_speeds = speeds.copy()
        effort_speeds[pushed] = first * crank_speed
        return DriveAngles(
            crank, angles, speeds, jacobian, bias, virtual, effort_speeds, lengths, slopes
        )

    def _rates(self, slopes: Array, commanded: Array, rates: Array) -> Array:
        """Rates of links that are pushed (P, ..., K), with which lengths have the rates that are
        commanded (P, ..., K) while all other drives have theirs (N, ..., K).
        """
        others = [k for k in range(len(rates)) if k not in self.places]
        left = commanded - np.einsum("pok,o...k->p...k", slopes[:, others], rates[others])
        right = left.reshape(len(left), -1, left.shape[-1])
        return _solved(slopes[:, self._pushed], right).reshape(left.shape)

    def efforts(self, slopes: Array, torques: Array) -> Array:
        """Torques of drives that turn, N m, and forces of those that push, N, (N, K), which
        together do what torques of all drives (N, K) would.
        """
        levers = slopes[:, self._pushed].transpose(1, 0, 2)
        forces = _solved(levers, torques[self._pushed][:, None])[:, 0]
        efforts = torques - np.einsum("pnk,pk->nk", slopes, forces)
        efforts[self._pushed] = forces
        return np.asarray(efforts)

    def _commanded(self, crank_angle: Array) -> Array:
        """Lengths at crank angles (K,), and both of their derivatives by these, (3, P, K)."""
        laws = (self.linkage.machine.driven[k].stroke for k in self.places)
        values = [law.value(crank_angle) for law in laws if law is not None]
        return np.swapaxes(np.array(values), 0, 1)

    def _angles(self, crank_angle: Array, angles: Array, references: References) -> Array:
        """Angles of all drives (N, K), rad, where all lengths are as commanded.

        angles : (N, K), of which those of links that are pushed do not count.

        Raises
        ------
        MotionError : there is no such place near the references.
        """
        wanted, angles = self._commanded(crank_angle)[0], np.array(angles)
        for k, name in zip(self.places, self._names, strict=True):
            angles[k] = references[name]
        for _ in range(ITERATIONS):
            length, slopes, _ = self._lengths_at(
                crank_angle, angles, np.zeros_like(angles), references
            )
            changes = _solved(slopes[:, self._pushed], (wanted - length)[:, None])[:, 0]
            largest = np.max(np.abs(changes))
            if not np.isfinite(largest):
                break
            angles[self._pushed] += changes
            if largest <= SQUARED:
                return angles
        raise MotionError(Note("a stroke cannot be as long as it is to be"))

    def _lengths_at(
        self, crank: Array, angles: Array, speeds: Array, references: References
    ) -> tuple[Array, Array, Array]:
        """Lengths (P, K), m, at crank angles (K,), rad, with coordinates (C, K) and their rates;
        their derivatives by all coordinates (P, C, K), and what they accelerate (P, K), m/s2, while
        no drive does.
        """
        drives = len(self.linkage.machine.driven)
        pose = pose_of(self.linkage, crank, angles[:drives], speeds[:drives], references)
        lengths, by_drive, accelerations = self.lengths(pose)
        slopes = np.zeros((len(lengths), len(angles), pose.count))
        slopes[:, :drives] = by_drive
        return lengths, slopes, accelerations

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


def _solved(left: Array, right: Array) -> Array:
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
