"""Inputs on which the kernels are tried: smooth functions of the crank angle with derivatives.

Every function takes the crank angle as a number of any library: Python, NumPy or mpmath.  The
library's exponential goes by the name `exp`.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import mpmath

from equipoise.mechanism.formulas import kernels

Exp = Callable[[Any], Any]
Inputs = Callable[[Any, Exp], tuple[Any, ...]]


@dataclass(frozen=True)
class Path:
    """A point that moves: a sum of circles, (order, radius)."""

    start: complex
    circles: tuple[tuple[int, complex], ...]

    def __call__(self, t: Any, exp: Exp) -> tuple[Any, Any, Any]:
        terms = [(1j * n, r * exp(1j * n * t)) for n, r in self.circles]
        return (
            self.start + sum(value for _, value in terms),
            sum(rate * value for rate, value in terms),
            sum(rate * rate * value for rate, value in terms),
        )


@dataclass(frozen=True)
class Turning:
    """A body that turns unevenly: angle = start + rate t + swing sin(order t)."""

    start: float
    rate: float
    swing: float
    order: int = 2

    def angle(self, t: Any, exp: Exp) -> tuple[Any, Any, Any]:
        wave = exp(1j * self.order * t)
        return (
            self.start + self.rate * t + self.swing * wave.imag,
            self.rate + self.order * self.swing * wave.real,
            -self.order * self.order * self.swing * wave.imag,
        )

    def __call__(self, t: Any, exp: Exp) -> tuple[Any, Any, Any]:
        angle, first, second = self.angle(t, exp)
        return exp(1j * angle), first, second


P = Path(0.1 - 0.2j, ((1, 0.5 + 0.1j), (-2, 0.05j)))
Q = Path(2.9 + 0.4j, ((1, -0.2 + 0.1j), (3, 0.03)))
G = Path(0.6 + 0.9j, ((-1, 0.2), (2, 0.04 - 0.05j)))
U = Turning(0.4, 1.0, 0.3)
V = Turning(1.9, 0.0, 0.25, 3)


@dataclass(frozen=True)
class Unit:
    """A unit vector, as exact as the library that makes it."""

    angle: float

    def __call__(self, exp: Exp) -> Any:
        return exp(1j * self.angle)


ALONG, ACROSS, INNER = Unit(0.6), Unit(2.1), Unit(-0.9)


@dataclass(frozen=True)
class Formula:
    """A motion kernel, its moving inputs, its constant parameters, and what it returns.

    results : "point", "link" or "angle" for three values each.
    numbered : whether the dyad's own number follows.
    """

    kernel: str
    moving: Inputs
    parameters: tuple[Any, ...]
    results: tuple[str, ...]
    numbered: bool = True


def _gear(t: Any, exp: Exp) -> tuple[Any, ...]:
    return (*U.angle(t, exp), *V.angle(t, exp))


def _rail(t: Any, exp: Exp) -> tuple[Any, ...]:
    return (*U.angle(t, exp), *G(t, exp), *V(t, exp))


def _two_pins(t: Any, exp: Exp) -> tuple[Any, ...]:
    return (*P(t, exp), *Q(t, exp))


def _pin_and_guide(t: Any, exp: Exp) -> tuple[Any, ...]:
    return (*P(t, exp), *G(t, exp), *V(t, exp))


def _between(t: Any, exp: Exp) -> tuple[Any, ...]:
    return tuple(b - a for a, b in zip(P(t, exp), Q(t, exp), strict=True))


def _two_guides(t: Any, exp: Exp) -> tuple[Any, ...]:
    return (*G(t, exp), *V(t, exp), *Q(t, exp), *Turning(0.2, 0.0, 0.1)(t, exp))


def _point(t: Any, exp: Exp) -> tuple[Any, ...]:
    return (*P(t, exp), *U(t, exp))


def _four_bar(t: Any, exp: Exp) -> tuple[Any, ...]:
    pin = G(t, exp)
    ends = ((U, 0.6), (V, 2.3))
    outer = (item for turn, arm in ends for item in kernels.point(*pin, *turn(t, exp), arm))
    return (*outer, *pin, *U(t, exp)[1:], *V(t, exp)[1:])


def _two_ends(t: Any, exp: Exp) -> tuple[Any, ...]:
    pin = G(t, exp)
    return (*pin, *kernels.point(*pin, *U(t, exp), 0.6))


FOUR = (2.3j, -0.6 + 0j)
RRR = ((2 + 0.5j), (-0.7 + 1.9j))
RRP = (2.7 - 1.9j, ALONG, 0.1 - 0.3j, ACROSS)
RPR = (0.35, ALONG, ACROSS, 0.01)
PRP = (ALONG, 0.2 - 0.1j, ACROSS, ACROSS, -0.3 + 0.15j, ALONG)
RPP = (ALONG, ACROSS, INNER, Unit(1.3), 0.21 + 0.13j)

FORMULAS = {
    "point": Formula("point", _point, (0.7 - 0.4j,), ("point",), False),
    "gear": Formula("in_ratio", _gear, (-1.5, 0.3), ("angle",), False),
    "rolled": Formula("rolled", _gear, (0.3, -0.2), ("angle",), False),
    "wound": Formula("wound", _gear, (2.5, 0.4), ("angle",), False),
    "travelled": Formula("travelled", _pin_and_guide, (ALONG,), ("angle",), False),
    "apart": Formula("apart", _between, (), ("angle",), False),
    "railed": Formula("railed", _rail, (ALONG, ACROSS), ("point", "link"), False),
    "rrr left": Formula("rrr", _two_pins, (*RRR, 1.0), ("link", "link", "point")),
    "rrr right": Formula("rrr", _two_pins, (*RRR, -1.0), ("link", "link", "point")),
    "parallel": Formula("parallelogram", _four_bar, (*FOUR, 1.0), ("link", "link", "point")),
    "antiparallel": Formula("parallelogram", _four_bar, (*FOUR, -1.0), ("link", "link", "point")),
    "pointed": Formula("pointed", _two_ends, (0.6j,), ("link",), False),
    "rrp forward": Formula("rrp", _pin_and_guide, (*RRP, 1.0), ("link", "link", "point")),
    "rrp backward": Formula("rrp", _pin_and_guide, (*RRP, -1.0), ("link", "link", "point")),
    "rpr forward": Formula("rpr", _two_pins, (*RPR, 1.0), ("link", "link")),
    "rpr backward": Formula("rpr", _two_pins, (*RPR, -1.0), ("link", "link")),
    "prp": Formula("prp", _two_guides, PRP, ("link", "link", "point")),
    "rpp": Formula("rpp", _pin_and_guide, RPP, ("link", "link", "point")),
}


def evaluate(formula: Formula, kernels: Any, t: Any, exp: Exp) -> tuple[Any, ...]:
    """Run a kernel at a crank angle."""
    kernel = getattr(kernels, formula.kernel)
    return kernel(*formula.moving(t, exp), *constants(formula, exp))  # type: ignore[no-any-return]


def constants(formula: Formula, exp: Exp) -> tuple[Any, ...]:
    """Return the constant parameters of a formula, in fifty digits where the rest is."""
    exact = mpmath.mpmathify if exp is mpmath.exp else lambda value: value
    return tuple(
        value(exp) if isinstance(value, Unit) else exact(value) for value in formula.parameters
    )
