"""Smooth functions of the crank angle, interpolated to rounding by polynomials piece by piece.

An integration asks for them ten thousand times, one crank angle at a time, while solving a linkage
costs the same at one crank angle and at hundreds.  So it is solved at the nodes of all pieces at
once, and pieces are halved until the last coefficients are rounding.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Callable
from math import floor

import numpy as np
from numpy.polynomial import chebyshev

from equipoise.errors import ResponseError
from equipoise.i18n import Note
from equipoise.signals import Array

NODES = 12
"""Of a piece: with Chebyshev's nodes, which lie inside of it, so that a jump at its end is none."""
FINE = 1e-12
"""Share of a function's largest value below which a coefficient is rounding."""
HALVINGS = 9
"""After which a piece is left as it is; 24 pieces in a turn are a fortieth of a degree wide then,
and what is left is a corner, whose share of an integral is nothing.
"""
MOST_NODES = 200_000

POINTS = chebyshev.chebpts1(NODES)
TO_CHEBYSHEV = np.linalg.inv(chebyshev.chebvander(POINTS, NODES - 1))
TO_POWERS = np.zeros((NODES, NODES))
for _k in range(NODES):
    TO_POWERS[: _k + 1, _k] = chebyshev.cheb2poly(np.eye(NODES)[_k])
EXPONENTS = np.arange(NODES)


class Tabulated:
    """Functions (C,) of the crank angle that repeat after a period, rad.

    functions : values (C, N) at crank angles (N,).
    edges : rising from 0 to the period, between which the functions are smooth.
    slopes : how many of the functions, from the first on, have their derivative told as well, in
        front of all others.
    """

    def __init__(self, functions: Callable[[Array], Array], edges: Array, slopes: int = 0) -> None:
        self.period = float(edges[-1])
        lows, highs = edges[:-1], edges[1:]
        pieces: list[tuple[Array, Array, Array]] = []  # lows, highs, coefficients of Chebyshev
        scale: Array | None = None
        for left in range(HALVINGS, -1, -1):
            middle, half = (highs + lows) / 2, (highs - lows) / 2
            theta = middle[:, None] + half[:, None] * POINTS
            if theta.size > MOST_NODES:
                raise ResponseError(
                    Note("what acts on the crank changes too often in a cycle to be followed")
                )
            values = functions(theta.ravel()).reshape(-1, *theta.shape)
            size = np.max(np.abs(values), axis=(1, 2))
            scale = size if scale is None else np.maximum(scale, size)
            found = values @ TO_CHEBYSHEV.T
            rest = np.max(np.abs(found[..., -2:]), axis=2)
            rough = (
                np.any(rest > FINE * scale[:, None], axis=0) if left else np.zeros(len(lows), bool)
            )
            pieces.append((lows[~rough], highs[~rough], found[:, ~rough]))
            if not np.any(rough):
                break
            lows = np.concatenate([lows[rough], middle[rough]])
            highs = np.concatenate([middle[rough], highs[rough]])
        begin = np.concatenate([one for one, _, _ in pieces])
        end = np.concatenate([one for _, one, _ in pieces])
        order = np.argsort(begin)
        powers = np.concatenate([one for _, _, one in pieces], axis=1)[:, order] @ TO_POWERS.T
        begin, end = begin[order], end[order]
        derivatives = np.zeros((slopes, *powers.shape[1:]))
        derivatives[..., :-1] = powers[:slopes, :, 1:] * EXPONENTS[1:]
        derivatives *= (2 / (end - begin))[:, None]
        self._starts: list[float] = begin.tolist()
        self._middles: list[float] = ((begin + end) / 2).tolist()
        self._per_half: list[float] = (2 / (end - begin)).tolist()
        self._coefficients = [*np.moveaxis(np.concatenate([derivatives, powers]), 1, 0)]

    def at(self, theta: float) -> list[float]:
        """Derivatives, then values, at a crank angle."""
        theta -= self.period * floor(theta / self.period)
        k = bisect_right(self._starts, theta) - 1
        x = (theta - self._middles[k]) * self._per_half[k]
        found: list[float] = (self._coefficients[k] @ x**EXPONENTS).tolist()
        return found
