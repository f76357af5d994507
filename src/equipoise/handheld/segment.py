"""Transfer matrix of a uniform segment of the shaft, exact, as entire functions.

The state along the shaft is displacement w, slope angle theta, bending moment M and shear force V,
both as the right part exerts them on the left part.  With s the complex frequency (i omega)

    w' = theta + V / kGA,  theta' = M / EI,  M' = rho I s^2 theta - V,  V' = rho A s^2 w

for Timoshenko's beam; without shear and rotary inertia it is (1) of Nagamine and Irie, and the
matrix that of their (6).  The matrix of coefficients A of these equations satisfies
A^4 = a A^2 + b, so exp(A l) = c0 + c1 A l + c2 (A l)^2 + c3 (A l)^3 with four functions of a l^2
and b l^4 that are power series: no roots, no hyperbolic functions that cancel at low frequencies or
overflow at high ones.  They converge at once because no segment is longer than `longest` says.

Only arithmetic is used, so that the same lines run on arrays and on `duals.Dual`.
"""

from __future__ import annotations

from math import factorial, pi, sqrt
from typing import Any, NamedTuple

SHORT = 0.9
"""Share of the lowest natural frequency of a clamped segment up to which it is used, squared."""
TERMS, PAIRS = 8, 16
"""Terms of the series in b l^4, and of those in a l^2 and b l^4."""


class Transfer(NamedTuple):
    """The state at the right end of a segment by that at its left end; named (to)(from)."""

    ww: Any
    wt: Any
    wv: Any
    wm: Any
    tw: Any
    tt: Any
    tv: Any
    tm: Any
    vw: Any
    vt: Any
    vv: Any
    vm: Any
    mw: Any
    mt: Any
    mv: Any
    mm: Any

    def carried(self, w: Any, t: Any, v: Any, m: Any) -> tuple[Any, Any, Any, Any]:
        """Displacement, slope, shear force and moment at the right end, by those at the left."""
        return (
            self.ww * w + self.wt * t + self.wv * v + self.wm * m,
            self.tw * w + self.tt * t + self.tv * v + self.tm * m,
            self.vw * w + self.vt * t + self.vv * v + self.vm * m,
            self.mw * w + self.mt * t + self.mv * v + self.mm * m,
        )

    def part(self, key: Any) -> Transfer:
        """The same of some of many segments."""
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
    quartic = -1.0 * mass * flexibility * square * square
    c0, c1, c2, c3 = (_series(quartic, k) for k in range(4))
    along, cubic = c1 * length, c3 * square * length
    bent, fallen = c2 * square * flexibility, cubic * flexibility
    pushed = c2 * square * mass
    return Transfer(
        c0,
        along,
        -1.0 * fallen,
        bent,
        -1.0 * fallen * mass,
        c0,
        -1.0 * bent,
        along * flexibility,
        along * mass,
        pushed,
        c0,
        fallen * mass,
        -1.0 * pushed,
        -1.0 * cubic * mass,
        -1.0 * along,
        c0,
    )


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
    quadratic = (yielding + turning) * square
    quartic = -1.0 * (m * e + yielding * turning) * square * square
    c0, c1, c2, c3 = _paired_series(quadratic, quartic)
    c1, c2, c3 = c1 * length, c2 * square, c3 * square * length
    return Transfer(
        c0 + c2 * yielding,
        c1 + c3 * (yielding + turning),
        c1 * s + c3 * (s * yielding - e),
        c2 * e,
        -1.0 * c3 * e * m,
        c0 + c2 * turning,
        -1.0 * c2 * e,
        c1 * e + c3 * e * turning,
        c1 * m + c3 * m * yielding,
        c2 * m,
        c0 + c2 * yielding,
        c3 * m * e,
        -1.0 * c2 * m,
        c1 * r + c3 * (r * turning - m),
        -1.0 * c1 - c3 * (yielding + turning),
        c0 + c2 * turning,
    )


def _paired_series(quadratic: Any, quartic: Any) -> tuple[Any, Any, Any, Any]:
    """c0 to c3, from A^(2 n) = p A^2 + q with p, q by recurrence."""
    p, q = 0.0 * quartic, 0.0 * quartic + 1.0
    c0 = c1 = c2 = c3 = 0.0 * quartic
    for n in range(PAIRS):
        even, odd = 1 / factorial(2 * n), 1 / factorial(2 * n + 1)
        c0, c1, c2, c3 = c0 + q * even, c1 + q * odd, c2 + p * even, c3 + p * odd
        p, q = quadratic * p + q, quartic * p
    return c0, c1, c2, c3
