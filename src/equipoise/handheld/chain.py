"""The shaft as a chain of segments and stations, and numbers that carry their derivatives.

A kernel of plain arithmetic (`+ - * /`) runs on these as it runs on arrays, and what comes out has
the exact derivative by every variable that went in: forward differentiation, without a step.

A segment's transfer matrix, exact, as entire functions.  The state along the shaft is displacement
w, slope angle theta, bending moment M and shear force V, both as the right part exerts them on the
left part.  With s the complex frequency (i omega)

    w' = theta + V / kGA,  theta' = M / EI,  M' = rho I s^2 theta - V,  V' = rho A s^2 w

for Timoshenko's beam; without shear and rotary inertia it is (1) of Nagamine and Irie, and the
matrix that of their (6).  The matrix of coefficients A of these equations satisfies
A^4 = a A^2 + b, so exp(A l) = c0 + c1 A l + c2 (A l)^2 + c3 (A l)^3 with four functions of a l^2
and b l^4 that are power series: no roots, no hyperbolic functions that cancel at low frequencies or
overflow at high ones.  They converge at once because no segment is longer than `longest` says.

The chain.  At each node stand displacement and slope q = (w, theta), and what the right part exerts
on the left one is f = (V, M) = Z q + g.  The dynamic stiffness Z of everything to the left,
symmetric, and the load g are carried over a segment with transfer matrix T by

    M = T11 + T12 Z,  Z' = (T21 + T22 Z) M^-1,  g' = T22 g - Z' T12 g

and over a station by Z + S and g - F: the transfer matrices of Nagamine and Irie's (24) in the form
of Riccati.  It loses no digits at high orders, where their product is a small difference of large
numbers, nor on short segments, where a stiffness matrix is.

Only arithmetic is used, on arrays of any shape and on `duals.Dual`; numbers of a node come first.
"""

from __future__ import annotations

from collections import namedtuple
from collections.abc import Sequence
from math import factorial, pi, sqrt
from typing import Any, NamedTuple

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.signals import Array


class Dual:
    """A value with its derivatives.

    value : array (...), real or complex.
    slopes : derivatives (P, ...) by P variables, of the value's shape or broadcast against it.
    """

    __array_ufunc__ = None  # an array on the left leaves the operation to this class
    __slots__ = ("slopes", "value")

    def __init__(self, value: Any, slopes: Any) -> None:
        self.value, self.slopes = value, slopes

    def __add__(self, other: Any) -> Dual:
        if isinstance(other, Dual):
            return Dual(self.value + other.value, self.slopes + other.slopes)
        return Dual(self.value + other, self.slopes)

    __radd__ = __add__

    def __neg__(self) -> Dual:
        return Dual(-self.value, -self.slopes)

    def __sub__(self, other: Any) -> Dual:
        return self.__add__(-other)

    def __rsub__(self, other: Any) -> Dual:
        return (-self).__add__(other)

    def __mul__(self, other: Any) -> Dual:
        if isinstance(other, Dual):
            slopes = self.slopes * other.value + other.slopes * self.value
            return Dual(self.value * other.value, slopes)
        return Dual(self.value * other, self.slopes * other)

    __rmul__ = __mul__

    def __truediv__(self, other: Any) -> Dual:
        if not isinstance(other, Dual):
            return Dual(self.value / other, self.slopes / other)
        ratio = self.value / other.value
        return Dual(ratio, (self.slopes - ratio * other.slopes) / other.value)

    def __rtruediv__(self, other: Any) -> Dual:
        ratio = other / self.value
        return Dual(ratio, -ratio * self.slopes / self.value)

    def __getitem__(self, key: Any) -> Dual:
        """A part of the value; the slopes must have its full shape."""
        return Dual(self.value[key], self.slopes[(slice(None), *np.index_exp[key])])

    def conj(self) -> Dual:
        """Complex conjugate."""
        return Dual(np.conj(self.value), np.conj(self.slopes))


def value_of(number: Any) -> Any:
    """The value of a number with or without derivatives."""
    return number.value if isinstance(number, Dual) else number


SHORT = 0.9
"""Share of the lowest natural frequency of a clamped segment up to which it is used, squared."""
TERMS, PAIRS = 8, 16
"""Terms of the series in b l^4, and of those in a l^2 and b l^4."""


class Transfer(namedtuple("Transfer", "ww wt wv wm tw tt tv tm vw vt vv vm mw mt mv mm")):
    """The state at the right end of a segment by that at its left end; named (to)(from)."""

    __slots__ = ()

    def carried(self, w: Any, t: Any, v: Any, m: Any) -> tuple[Any, Any, Any, Any]:
        """Displacement, slope, shear force and moment at the right end, by those at the left."""
        return (
            self.ww * w + self.wt * t + self.wv * v + self.wm * m,
            self.tw * w + self.tt * t + self.tv * v + self.tm * m,
            self.vw * w + self.vt * t + self.vv * v + self.vm * m,
            self.mw * w + self.mt * t + self.mv * v + self.mm * m,
        )

    def part(self, key: Any) -> Transfer:
        """Transfer matrices of some of many segments."""
        return Transfer(*(entry[key] for entry in self))


def longest(
    frequency: float, flexibility: float, shear: float, mass: float, rotary: float
) -> float:
    """Length (m) of a segment without a natural frequency below this one, clamped at both ends.

    frequency : rad/s.
    flexibility, shear : 1 / EI (1/(N m2)) and 1 / kGA (1/N).
    mass, rotary : rho A (kg/m) and rho I (kg m).

    By Friedrichs' and Cauchy's inequalities 1 / omega_1^2 is at most
    rho A (l / pi)^4 / EI + rho A (l / pi)^2 / kGA + rho I (l / pi)^2 / EI.
    """
    linear = mass * shear + rotary * flexibility
    square = mass * flexibility
    room = SHORT / frequency**2
    return pi * sqrt(2 * room / (linear + sqrt(linear**2 + 4 * square * room)))


def transfer(length: Any, flexibility: Any, mass: Any) -> Transfer:
    """Transfer matrix of a segment without shear and rotary inertia.

    length : m.
    flexibility : 1 / EI, 1/(N m2).
    mass : rho A s^2, kg/(m s2).
    """
    square = length * length
    quartic = -mass * flexibility * square * square
    c0, c1, c2, c3 = (_series(quartic, k) for k in range(4))
    along, cubic = c1 * length, c3 * square * length
    bent, fallen = c2 * square * flexibility, cubic * flexibility
    pushed = c2 * square * mass
    to_w = (c0, along, -fallen, bent)
    to_t = (-fallen * mass, c0, -bent, along * flexibility)
    to_v = (along * mass, pushed, c0, fallen * mass)
    to_m = (-pushed, -cubic * mass, -along, c0)
    return Transfer(*to_w, *to_t, *to_v, *to_m)


def _series(quartic: Any, first: int) -> Any:
    """Sum of b^k / (4 k + first)!, by Horner."""
    total: Any = 1 / factorial(4 * TERMS - 4 + first)
    for k in range(TERMS - 2, -1, -1):
        total = quartic * total + 1 / factorial(4 * k + first)
    return total


def shear_transfer(length: Any, flexibility: Any, shear: Any, mass: Any, rotary: Any) -> Transfer:
    """Transfer matrix of a segment of Timoshenko's beam.

    length, flexibility, mass : as in `transfer`.
    shear : 1 / kGA, 1/N.
    rotary : rho I s^2, kg m/s2.
    """
    e, s, m, r = flexibility, shear, mass, rotary
    square = length * length
    yielding, turning = m * s, r * e
    both = yielding + turning
    quadratic = both * square
    quartic = -(m * e + yielding * turning) * square * square
    c0, c1, c2, c3 = _paired_series(quadratic, quartic)
    c1, c2, c3 = c1 * length, c2 * square, c3 * square * length
    to_w = (c0 + c2 * yielding, c1 + c3 * both, c1 * s + c3 * (s * yielding - e), c2 * e)
    to_t = (-c3 * e * m, c0 + c2 * turning, -c2 * e, c1 * e + c3 * e * turning)
    to_v = (c1 * m + c3 * m * yielding, c2 * m, c0 + c2 * yielding, c3 * m * e)
    to_m = (-c2 * m, c1 * r + c3 * (r * turning - m), -c1 - c3 * both, c0 + c2 * turning)
    return Transfer(*to_w, *to_t, *to_v, *to_m)


def _paired_series(quadratic: Any, quartic: Any) -> tuple[Any, Any, Any, Any]:
    """c0 to c3, from A^(2 n) = p A^2 + q with p, q by recurrence."""
    p, q = 0.0 * quartic, 0.0 * quartic + 1.0
    c0 = c1 = c2 = c3 = 0.0 * quartic
    for n in range(PAIRS):
        even, odd = 1 / factorial(2 * n), 1 / factorial(2 * n + 1)
        c0, c1, c2, c3 = c0 + q * even, c1 + q * odd, c2 + p * even, c3 + p * odd
        p, q = quadratic * p + q, quartic * p
    return c0, c1, c2, c3


class NodePair(NamedTuple):
    """Two numbers of a node: for displacement and slope, or for force and couple."""

    across: Any
    turning: Any


class Symmetric(NamedTuple):
    """A symmetric matrix of a node."""

    aa: Any
    at: Any
    tt: Any


class SegmentTransfer(NamedTuple):
    """A segment that was crossed: its transfer matrix, M and its determinant."""

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
    stations: Sequence[NodePair]


@dataclass(frozen=True, eq=False)
class CondensedStiffness:
    """The dynamic stiffness carried through a chain.

    stiffness : Z after the station of each node (N).
    steps : the segments crossed (N - 1).
    """

    chain: Chain
    stiffness: Sequence[Symmetric]
    steps: Sequence[SegmentTransfer]


@dataclass(frozen=True, eq=False)
class States:
    """Answer of every node: displacement and slope, and force and moment just right of it."""

    motion: Sequence[NodePair]
    force: Sequence[NodePair]


@np.errstate(all="ignore")  # whoever asks looks whether the answer is finite
def carry(chain: Chain) -> CondensedStiffness:
    """Carry the dynamic stiffness from the left end, which is free, to the right one."""
    first = chain.stations[0]
    z = Symmetric(first.across, 0.0, first.turning)
    stiffness, steps = [z], []
    for over, station in zip(chain.segments, chain.stations[1:], strict=True):
        step, z = _cross(over, z)
        z = Symmetric(z.aa + station.across, z.at, z.tt + station.turning)
        steps.append(step)
        stiffness.append(z)
    return CondensedStiffness(chain, stiffness, steps)


def _cross(over: Transfer, z: Symmetric) -> tuple[SegmentTransfer, Symmetric]:
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
    return SegmentTransfer(over, m_aa, m_at, m_ta, m_tt, determinant), after


@np.errstate(all="ignore")
def solve(carried: CondensedStiffness, loads: Sequence[NodePair | None]) -> States:
    """The motion under harmonic forces and couples on the nodes; None for no load there.

    At a resonance without damping it is not finite.
    """
    z, chain = carried.stiffness, carried.chain
    g = _less(NodePair(0.0, 0.0), loads[0])
    condensed = [g]
    for over, load, after, station in zip(
        chain.segments, loads[1:], z[1:], chain.stations[1:], strict=True
    ):
        g = _less(_carry_load(over, after, station, g), load)
        condensed.append(g)
    last = z[-1]
    determinant = last.aa * last.tt - last.at * last.at
    across = (last.at * g.turning - last.tt * g.across) / determinant
    motion = [NodePair(across, (last.at * g.across - last.aa * g.turning) / determinant)]
    force = [NodePair(0.0 * g.across, 0.0 * g.turning)]
    for step, before, g in zip(carried.steps[::-1], z[-2::-1], condensed[-2::-1], strict=True):
        q = _back(step, motion[-1], g)
        motion.append(q)
        across = before.aa * q.across + before.at * q.turning + g.across
        force.append(NodePair(across, before.at * q.across + before.tt * q.turning + g.turning))
    return States(motion[::-1], force[::-1])


def _carry_load(over: Transfer, z: Symmetric, station: NodePair, g: NodePair) -> NodePair:
    """The load g' after a segment; z is that after the station behind it."""
    w = over.wv * g.across + over.wm * g.turning
    t = over.tv * g.across + over.tm * g.turning
    return NodePair(
        over.vv * g.across + over.vm * g.turning - (z.aa - station.across) * w - z.at * t,
        over.mv * g.across + over.mm * g.turning - z.at * w - (z.tt - station.turning) * t,
    )


def _less(g: NodePair, load: NodePair | None) -> NodePair:
    return g if load is None else NodePair(g.across - load.across, g.turning - load.turning)


def _back(step: SegmentTransfer, q: NodePair, g: NodePair) -> NodePair:
    """Motion at the left end of a segment, from that at its right end."""
    over = step.over
    w = q.across - (over.wv * g.across + over.wm * g.turning)
    t = q.turning - (over.tv * g.across + over.tm * g.turning)
    return NodePair(
        (step.tt * w - step.at * t) / step.determinant,
        (step.aa * t - step.ta * w) / step.determinant,
    )


@np.errstate(all="ignore")
def count(carried: CondensedStiffness) -> Array:
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


def log_determinant(carried: CondensedStiffness) -> tuple[Any, Any]:
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
