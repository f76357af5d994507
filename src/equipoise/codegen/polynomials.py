"""Angles and rotations by polynomials, for loops that are to handle several crank angles at once.

A call of a library would keep them from that.  The polynomials are Chebyshev interpolations, exact
to 1e-17.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import reduce
from typing import Any

from equipoise.codegen.terms import BOTH, Term, VectorTerm, nearest, replaced, root

ARC = (
    -0.005280870051487617,
    0.018095230564342743,
    -0.032661656028653945,
    0.043802683513332864,
    -0.051663638584717154,
    0.05864670804294048,
    -0.0666435417001706,
    0.07692094669579978,
    -0.09090895671012374,
    0.11111110560344459,
    -0.14285714272114403,
    0.19999999999824117,
    -0.3333333333333243,
    1.0,
)
"""Arctangent over its argument, by powers of the argument's square, up to tan(2.09 / 4)."""
COSINE = (
    -1.1353379638297575e-11,
    2.0875582380663952e-09,
    -2.7557313097790086e-07,
    2.4801587283881152e-05,
    -0.0013888888888861095,
    0.04166666666666645,
    -0.5,
    1.0,
)
SINE = (
    1.5894736651849094e-10,
    -2.5050716974102745e-08,
    2.755731337640013e-06,
    -0.000198412698286503,
    0.008333333333320363,
    -0.16666666666666616,
    1.0,
)
"""Sine over its argument; both by powers of the argument's square, up to half a turn over 4."""


def _polynomial(coefficients: Iterable[float], z: Any) -> Any:
    return reduce(lambda value, item: value * z + item, coefficients)


def arc(x: Any, y: Any) -> Any:
    """Angle of the unit vector (x, y), of at most 2.09 rad to either side: from the tangent of its
    fourth.
    """
    half = root(0.5 + 0.5 * x)
    quarter = 0.5 * y * (1.0 / (half * (1.0 + half)))
    return 4.0 * quarter * _polynomial(ARC, quarter * quarter)


def turn(angle: Any) -> Any:
    """exp(i angle), as the fourth power of that of a fourth of the angle."""
    turns = angle * 0.15915494309189535
    quarter = (turns - nearest(turns)) * 1.5707963267948966
    z = quarter * quarter
    u = VectorTerm(_polynomial(COSINE, z), quarter * _polynomial(SINE, z))
    u = u * u
    return u * u


def without_calls(outputs: Iterable[Any]) -> list[Any]:
    """Outputs with polynomials in place of functions of the crank angle and the design."""

    def change(term: Term, args: Sequence[Any]) -> Any:
        if term.mask != BOTH or term.op not in ("cos", "sin", "angle"):
            return None
        if term.op == "angle":
            return arc(*args)
        u = turn(*args)
        return u.real if term.op == "cos" else u.imag

    return replaced(outputs, change)
