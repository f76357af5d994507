"""A chain of segments and stations: what its ends and nodes answer, carried from left to right.

At each node stand displacement and slope q = (w, theta), and what the right part exerts on the left
one is f = (V, M) = Z q + g.  The dynamic stiffness Z of everything to the left, symmetric, and the
load g are carried over a segment with transfer matrix T by

    M = T11 + T12 Z,  Z' = (T21 + T22 Z) M^-1,  g' = T22 g - Z' T12 g

and over a station by Z + S and g - F: the transfer matrices of Nagamine and Irie's (24) in the form
of Riccati.  It loses no digits at high orders, where their product is a small difference of large
numbers, nor on short segments, where a stiffness matrix is.

Only arithmetic is used, on arrays of any shape and on `duals.Dual`; numbers of a node come first.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from equipoise.handheld.duals import value_of
from equipoise.handheld.segment import Transfer

Array = np.ndarray[Any, Any]


class Pair(NamedTuple):
    """Two numbers of a node: for displacement and slope, or for force and couple."""

    across: Any
    turning: Any


class Symmetric(NamedTuple):
    """A symmetric matrix of a node."""

    aa: Any
    at: Any
    tt: Any


class Step(NamedTuple):
    """A segment that was crossed: its transfer matrix, M and its determinant, Z at its left end."""

    over: Transfer
    aa: Any
    at: Any
    ta: Any
    tt: Any
    determinant: Any


@dataclass(frozen=True, eq=False)
class Chain:
    """Segments (N - 1) between nodes (N), and what sits on the nodes.

    segments : transfer matrices, from the left end.
    stations : dynamic stiffness of what sits on each node, diagonal, N/m and N m/rad.
    """

    segments: Sequence[Transfer]
    stations: Sequence[Pair]


@dataclass(frozen=True, eq=False)
class Carried:
    """The dynamic stiffness carried through a chain.

    stiffness : Z after the station of each node (N).
    steps : the segments crossed (N - 1).
    """

    chain: Chain
    stiffness: Sequence[Symmetric]
    steps: Sequence[Step]


@dataclass(frozen=True, eq=False)
class States:
    """Answer of every node: displacement and slope, and force and moment just right of it."""

    motion: Sequence[Pair]
    force: Sequence[Pair]


def carry(chain: Chain) -> Carried:
    """Carry the dynamic stiffness from the left end, which is free, to the right one."""
    first = chain.stations[0]
    z = Symmetric(first.across, 0.0, first.turning)
    stiffness, steps = [z], []
    with np.errstate(all="ignore"):  # whoever asks looks whether the answer is finite
        for over, station in zip(chain.segments, chain.stations[1:], strict=True):
            step, z = _cross(over, z)
            z = Symmetric(z.aa + station.across, z.at, z.tt + station.turning)
            steps.append(step)
            stiffness.append(z)
    return Carried(chain, stiffness, steps)


def _cross(over: Transfer, z: Symmetric) -> tuple[Step, Symmetric]:
    """Over one segment."""
    m_aa = over.ww + over.wv * z.aa + over.wm * z.at
    m_at = over.wt + over.wv * z.at + over.wm * z.tt
    m_ta = over.tw + over.tv * z.aa + over.tm * z.at
    m_tt = over.tt + over.tv * z.at + over.tm * z.tt
    n_aa = over.vw + over.vv * z.aa + over.vm * z.at
    n_at = over.vt + over.vv * z.at + over.vm * z.tt
    n_ta = over.mw + over.mv * z.aa + over.mm * z.at
    n_tt = over.mt + over.mv * z.at + over.mm * z.tt
    determinant = m_aa * m_tt - m_at * m_ta
    after = Symmetric(
        (n_aa * m_tt - n_at * m_ta) / determinant,
        (n_at * m_aa - n_aa * m_at) / determinant,
        (n_tt * m_aa - n_ta * m_at) / determinant,
    )
    return Step(over, m_aa, m_at, m_ta, m_tt, determinant), after


def solve(carried: Carried, loads: Sequence[Pair | None]) -> States:
    """The motion under harmonic forces and couples on the nodes; None for no load there.

    At a resonance without damping it is not finite.
    """
    with np.errstate(all="ignore"):
        return _solve(carried, loads)


def _solve(carried: Carried, loads: Sequence[Pair | None]) -> States:
    z, chain = carried.stiffness, carried.chain
    g = _less(Pair(0.0, 0.0), loads[0])
    held = [g]
    for over, load, after, station in zip(
        chain.segments, loads[1:], z[1:], chain.stations[1:], strict=True
    ):
        g = _less(_carry_load(over, after, station, g), load)
        held.append(g)
    last = z[-1]
    determinant = last.aa * last.tt - last.at * last.at
    motion = [
        Pair(
            (last.at * g.turning - last.tt * g.across) / determinant,
            (last.at * g.across - last.aa * g.turning) / determinant,
        )
    ]
    force = [Pair(0.0 * g.across, 0.0 * g.turning)]
    for step, before, g in zip(carried.steps[::-1], z[-2::-1], held[-2::-1], strict=True):
        q = _back(step, motion[-1], g)
        motion.append(q)
        force.append(
            Pair(
                before.aa * q.across + before.at * q.turning + g.across,
                before.at * q.across + before.tt * q.turning + g.turning,
            )
        )
    return States(motion[::-1], force[::-1])


def _carry_load(over: Transfer, z: Symmetric, station: Pair, g: Pair) -> Pair:
    """The load g' after a segment; z is that after the station behind it."""
    w = over.wv * g.across + over.wm * g.turning
    t = over.tv * g.across + over.tm * g.turning
    return Pair(
        over.vv * g.across + over.vm * g.turning - (z.aa - station.across) * w - z.at * t,
        over.mv * g.across + over.mm * g.turning - z.at * w - (z.tt - station.turning) * t,
    )


def _less(g: Pair, load: Pair | None) -> Pair:
    return g if load is None else Pair(g.across - load.across, g.turning - load.turning)


def _back(step: Step, q: Pair, g: Pair) -> Pair:
    """Motion at the left end of a segment, from that at its right end."""
    over = step.over
    w = q.across - (over.wv * g.across + over.wm * g.turning)
    t = q.turning - (over.tv * g.across + over.tm * g.turning)
    return Pair(
        (step.tt * w - step.at * t) / step.determinant,
        (step.aa * t - step.ta * w) / step.determinant,
    )


def count(carried: Carried) -> Array:
    """How many natural frequencies lie below that of a chain without damping (Wittrick-Williams).

    With each segment shorter than `segment.longest`, none has a frequency of its own with its ends
    held.  So the number of the part left of a node that is held there grows over a segment by the
    negative eigenvalues of Z + T12^-1 T11 = T12^-1 M at its left end, and the number of the whole
    is that at its right end, with the negative eigenvalues of Z there (Wittrick and Williams 1971).
    """
    last = carried.stiffness[-1]
    total = _negative(last.aa, last.aa * last.tt - last.at * last.at)
    for step in carried.steps:
        over = step.over
        flexible = over.wv * over.tm - over.wm * over.tv
        first = over.tm * step.aa - over.wm * step.ta
        here = _negative(first, step.determinant * flexible)
        total = total + np.where(flexible > 0, here, 0)  # of no length, it is rigid
    return total


def _negative(first: Array, determinant: Array) -> Array:
    """Negative eigenvalues of a symmetric (2, 2) matrix by an element and its determinant."""
    return np.where(determinant < 0, 1, np.where(first < 0, 2, 0))


def log_determinant(carried: Carried) -> tuple[Any, Any]:
    """Logarithm of the characteristic function, and its derivative by the first variable.

    The function is the determinant of the matrix from the motion of the left end to the force that
    the right end needs: entire in the complex frequency, and zero at the eigenvalues alone.  It is
    the determinant of (11) to (22) but for a factor without zeros.
    """
    last = carried.stiffness[-1]
    factors = [step.determinant for step in carried.steps]
    factors.append(last.aa * last.tt - last.at * last.at)
    logarithm = sum(np.log(value_of(factor) + 0j) for factor in factors)
    slope = sum(
        factor.slopes[0] / factor.value for factor in factors if not isinstance(factor, np.ndarray)
    )
    return logarithm, slope
