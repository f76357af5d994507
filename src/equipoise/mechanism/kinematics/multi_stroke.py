"""Several drives of which one or more push: the angles of all links that they push.

Strokes and the angles of the other drives are commanded over the crank angle; the angles of the
links that are pushed are those at which all lengths are as commanded, by Newton's method, followed
from where they start.  Their derivatives follow from those of the lengths, each of
which the linkage gives at any rates of these links.  See `docs/theory.md`, "Drives that push".
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from math import degrees, pi
from typing import Any

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.errors import ModelError
from equipoise.i18n import Note, all_of
from equipoise.mechanism.assembly.linkage import Linkage, assemble
from equipoise.mechanism.assembly.steps import Array, run, u
from equipoise.mechanism.kinematics.motion import Motion
from equipoise.mechanism.parts.drives import Drive, FurtherDrive
from equipoise.mechanism.parts.machine import Machine
from equipoise.quantities import angle, format_exact

POINTS = 120
"""Crank angles in a turn from one of which to the next the links are followed."""
ITERATIONS, SETTLED = 12, 1e-14
"""Of Newton's method; the last change in an angle, rad."""
FAR = 0.5
"""rad: by which no link moves between two of these crank angles, or from where it starts."""
CLOSED = 1e-9
"""rad: how near a link comes to where it was a cycle before."""
NO_LEVER = 1e-9
"""Smallest lever over the longest, above which strokes are independent."""


FOLLOWED = Note(
    "a stroke beside other drives goes with pins, guides and dyads, and with gears, belts and "
    "racks whose driver and carrier are the frame or links that are driven by their angle; "
    "others, and groups of loops, need one drive to be followed by"
)


@dataclass(frozen=True)
class RestingLinks:
    """Links that stand still at the angles at which they start."""

    at: dict[str, float]

    def moved(self, crank_angle: Any) -> dict[str, tuple[Any, Any, Any]]:
        """Angle of each link and its two derivatives."""
        none = np.zeros(np.shape(crank_angle))
        return {link: (none + at, none, none) for link, at in self.at.items()}


@dataclass(frozen=True, eq=False)
class MultiStrokeInverse:
    """Angles of P links that are pushed.

    linkage : solved where these links are held.  period : of the cycle, rad.
    """

    linkage: Linkage
    pushers: tuple[Drive | FurtherDrive, ...]
    period: float

    def lengths(self, theta: Array, q: Array, rate: Array, bend: Array) -> Array:
        """Lengths and both derivatives by crank angle, (3, P, N).

        q, rate, bend : (P, N), angles of the links and their derivatives by crank angle.
        """
        state = self.linkage.start(theta)
        for item, *rates in zip(self.pushers, q, rate, bend, strict=True):
            turned = np.exp(1j * rates[0]), rates[1], rates[2]
            state.update(zip(u(item.link), turned, strict=True))
            state[f"phi({item.link})"] = rates[0]
        with np.errstate(all="ignore"):
            motion = Motion(self.linkage, theta, 1.0, 0.0, False, run(self.linkage.motion, state))
            values = np.array([motion.lengths(pusher) for pusher in self.pushers])
        return np.swapaxes(values, 0, 1)

    def levers(self, theta: Array, q: Array) -> tuple[Array, Array, Array]:
        """Lengths (P, N), what the other drives add to their rates, and levers (N, P, P): the
        lengths' derivatives by the links' angles.
        """
        many, count = len(self.pushers), len(theta)
        rates = np.zeros((many, many + 1, count))
        rates[range(many), range(1, many + 1)] = 1.0
        again = np.tile(theta, many + 1), np.tile(q, many + 1)
        lengths = self.lengths(*again, rates.reshape(many, -1), np.zeros((many, again[0].size)))
        value, first, _ = lengths.reshape(3, many, many + 1, count)
        levers = np.moveaxis(first[:, 1:] - first[:, :1], -1, 0)
        return value[:, 0], first[:, 0], levers

    def commanded(self, theta: Array) -> Array:
        """What strokes command, with derivatives, (3, P, N)."""
        laws = [pusher.stroke.value(theta) for pusher in self.pushers if pusher.stroke is not None]
        return np.swapaxes(np.array(laws), 0, 1)

    def newton_angles(self, theta: Array, q: Array) -> tuple[Array, Array]:
        """Angles (P, N) of lengths as commanded, near others, and the last change (N,)."""
        wanted = self.commanded(theta)[0]
        for _ in range(ITERATIONS):
            value, _, levers = self.levers(theta, q)
            change = _solved(levers, wanted - value)
            q = q + change
            if not np.max(np.abs(change)) > SETTLED * (1 + np.max(np.abs(q))):
                break
        return q, np.max(np.abs(change), axis=0)

    def rates(self, theta: Array, q: Array) -> tuple[Array, Array]:
        """Both derivatives of these angles by crank angle, (P, N)."""
        _, first, second = self.commanded(theta)
        _, by_others, levers = self.levers(theta, q)
        rate = _solved(levers, first - by_others)
        bent = self.lengths(theta, q, rate, np.zeros(q.shape))[2]
        return rate, _solved(levers, second - bent)


def _solved(levers: Array, right: Array) -> Array:
    """Solve for (P, N), NaN where no lever is."""
    size = np.max(np.abs(levers), axis=(1, 2))
    flat = ~(np.abs(np.linalg.det(levers)) > NO_LEVER * size ** len(right))
    levers = np.where(flat[:, None, None], np.eye(len(right)), levers)
    result = np.linalg.solve(levers, right.T[..., None])[..., 0].T
    return np.where(flat, np.nan, result)


@dataclass(frozen=True, eq=False)
class FollowedLinks:
    """The links followed over a cycle.

    theta : (K,) crank angles, rad.  q, rate : (P, K).
    """

    of: MultiStrokeInverse
    theta: Array
    q: Array
    rate: Array

    def moved(self, crank_angle: Any) -> dict[str, tuple[Array, Array, Array]]:
        """Angle of each link, and its two derivatives by crank angle, at crank angles (...)."""
        theta = np.asarray(crank_angle, dtype=float)
        at = np.ravel(theta) % self.of.period
        q, _ = self.of.newton_angles(at, self._between(at))
        rows = zip(q, *self.of.rates(at, q), strict=True)
        return {
            pusher.link: tuple(part.reshape(theta.shape) for part in row)
            for pusher, row in zip(self.of.pushers, rows, strict=True)
        }

    def _between(self, at: Array) -> Array:
        """Angles near those at crank angles (N,): cubics through what is known."""
        h = self.theta[1] - self.theta[0]
        left = np.minimum((at / h).astype(int), len(self.theta) - 2)
        t = at / h - left
        a, b = self.q[:, left], self.q[:, left + 1]
        v, w = h * self.rate[:, left], h * self.rate[:, left + 1]
        cubic: Array = a + t * (v + t * (3 * (b - a) - 2 * v - w + t * (2 * (a - b) + v + w)))
        return cubic


def commanded(machine: Machine) -> FollowedLinks:
    """The angles of all links that are pushed.

    Raises
    ------
    ModelError : strokes cannot be had, from where their links start or further on.
    MobilityError : the linkage cannot be moved at all.
    """
    pushers = machine.pushers
    start = {pusher.link: pusher.start or 0.0 for pusher in pushers}
    bare = replace(machine, loads=(), planting=None, balance=None, support=None, rows=())
    bare = bare.with_turning(RestingLinks(start))
    linkage = assemble(bare)
    moved = {end for coupling in machine.couplings for end in (coupling.driver, coupling.carrier)}
    if linkage.needed_references or moved & start.keys():
        raise ModelError("drives", FOLLOWED)
    turns = np.lcm.reduce([drive.turns for drive in machine.driven])
    of = MultiStrokeInverse(linkage, pushers, float(2 * pi * turns))
    return _followed(of, np.array([*start.values()])[:, None], POINTS * int(turns))


def _followed(of: MultiStrokeInverse, start: Array, count: int) -> FollowedLinks:
    theta = np.linspace(0.0, of.period, count + 1)
    step = theta[1]
    q, change = of.newton_angles(theta[:1], start)
    if not np.all(change < SETTLED * 1e3) or np.max(np.abs(q - start)) > FAR:
        raise _not_had(of, start)
    items, rates, sense = [q], [], 0.0
    for k, at in enumerate(theta):
        here = np.array([at])
        rate, bend = of.rates(here, items[-1])
        lever = float(np.linalg.det(of.levers(here, items[-1])[2])[0])
        sense = sense or float(np.sign(lever))
        guess = items[-1] + step * rate + 0.5 * step**2 * bend
        rates.append(rate)
        if k == count:
            break
        new, change = of.newton_angles(theta[k + 1 : k + 2], guess)
        if not (lever * sense > 0 and change < SETTLED * 1e3 and np.max(np.abs(new - q)) < FAR):
            raise _lost(of, float(at))
        items.append(new)
        q = new
    if np.max(np.abs(items[-1] - items[0])) > CLOSED:
        raise _lost(of, of.period)
    return FollowedLinks(of, theta, np.hstack(items), np.hstack(rates))


def _not_had(of: MultiStrokeInverse, start: Array) -> ModelError:
    wanted = of.commanded(np.zeros(1))[0, :, 0]
    there = of.levers(np.zeros(1), start)[0][:, 0]
    each = zip(of.pushers, start[:, 0], wanted, there, strict=True)
    notes = [
        Note(
            "with {link!r} at {angle} it is {there}, and the stroke begins at {wanted}",
            link=item.link,
            angle=angle(float(at)),
            there=_shown(length),
            wanted=_shown(asked),
        )
        for item, at, asked, length in each
    ]
    return ModelError(
        "drives",
        Note(
            "no angles were found at which strokes can begin: {reasons}; give each link its "
            "approximate angle there by start",
            reasons=all_of(notes),
        ),
    )


def _lost(of: MultiStrokeInverse, at: float) -> ModelError:
    links: Sequence[str] = [repr(pusher.link) for pusher in of.pushers]
    return ModelError(
        "drives",
        Note(
            "the strokes lead {links} to where links are stretched out, or a force has no lever, "
            "near crank angle {angle:.4g} deg; let them move less",
            links=all_of(links),
            angle=degrees(at),
        ),
    )


def _shown(length: float) -> str:
    return format_exact(float(f"{length:.5g}"), "length") if np.isfinite(length) else "none"
