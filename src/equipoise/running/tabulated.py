"""Smooth functions of the crank angle, interpolated to rounding by polynomials piece by piece.

The motion asks for them again in every turn, while solving a linkage costs the same at one crank
angle and at hundreds.  So it is solved once, at the nodes of all pieces at once, and pieces are
halved until the last coefficients are rounding.
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

NODES = 16
"""Of a piece: with Chebyshev's nodes, which lie inside of it, so that a jump at its end is none."""
FINE = 1e-12
"""Share of a function's largest value below which a coefficient is rounding."""
HALVINGS = 10
"""After which a piece is left as it is; 12 pieces in a turn are a fortieth of a degree wide then,
and what is left is a corner, whose share of an integral is nothing.
"""
MOST_NODES = 200_000
ROUNDING = 1e-12
"""Of a period, within which a crank angle is the end of a piece."""

POINTS = chebyshev.chebpts1(NODES)
TO_CHEBYSHEV = np.linalg.inv(chebyshev.chebvander(POINTS, NODES - 1))
INTEGRAL = chebyshev.chebint(TO_CHEBYSHEV)
"""(NODES + 1, NODES), Chebyshev coefficients of the antiderivative of values at the nodes."""
DERIVATIVE = chebyshev.chebder(np.eye(NODES))
ORDERS = np.arange(NODES + 1)


def polynomials(x: Array | float) -> Array:
    """Chebyshev's polynomials (..., NODES + 1) at places (...) within -1 and 1."""
    return np.cos(np.multiply.outer(np.arccos(np.minimum(np.maximum(x, -1.0), 1.0)), ORDERS))


def integral_to(x: Array | float, begin: float) -> Array:
    """Weights (..., NODES) of the values at the nodes in their integral from `begin` to x, within
    -1 and 1.
    """
    return np.asarray((polynomials(x) - polynomials(begin)) @ INTEGRAL)


def roughness(values: Array) -> Array:
    """Size (...) of the last two Chebyshev coefficients of values (..., NODES) at the nodes."""
    return np.asarray(np.max(np.abs(values @ TO_CHEBYSHEV[-2:].T), axis=-1))


class Tabulated:
    """Functions (C,) of the crank angle that repeat after a period, rad.

    lows, highs : (P,) ends of the pieces, rad.  values : (C, P, NODES) at their nodes.
    coefficients : (P, C, NODES) of Chebyshev's polynomials.

    functions : values (C, N) at crank angles (N,).
    edges : rising from 0 to the period, between which the functions are smooth.
    groups : (C,) of each function, the number of the group whose largest value is its measure of
        rounding; each is measured by itself if None.
    sizes : (C,) of the terms in each function, which may cancel to rounding; 0 if None.
    """

    def __init__(
        self,
        functions: Callable[[Array], Array],
        edges: Array,
        groups: Array | None = None,
        sizes: Array | None = None,
    ) -> None:
        self.period = float(edges[-1])
        lows, highs = edges[:-1], edges[1:]
        pieces: list[tuple[Array, Array, Array]] = []
        scale = np.zeros(1) if sizes is None else sizes
        for left in range(HALVINGS, -1, -1):
            middle, half = (highs + lows) / 2, (highs - lows) / 2
            theta = middle[:, None] + half[:, None] * POINTS
            if theta.size > MOST_NODES:
                raise ResponseError(
                    Note("the load on the crank varies too rapidly within a cycle to be integrated")
                )
            values = functions(theta.ravel()).reshape(-1, *theta.shape)
            scale = np.maximum(scale, np.max(np.abs(values), axis=(1, 2)))
            size = scale
            if groups is not None:
                size = np.array([np.max(scale[groups == number]) for number in groups])
            rough = np.any(roughness(values) > FINE * size[:, None], axis=0) & (left > 0)
            pieces.append((lows[~rough], highs[~rough], values[:, ~rough]))
            if not np.any(rough):
                break
            lows = np.concatenate([lows[rough], middle[rough]])
            highs = np.concatenate([middle[rough], highs[rough]])
        low, high = (np.concatenate([piece[end] for piece in pieces]) for end in (0, 1))
        values = np.concatenate([piece[2] for piece in pieces], axis=1)
        order = np.argsort(low)
        self.lows, self.highs, self.values = low[order], high[order], values[:, order]
        self._starts: list[float] = self.lows.tolist()
        self.coefficients = np.moveaxis(self.values @ TO_CHEBYSHEV.T, 1, 0)

    def piece(self, theta: float, direction: float) -> tuple[int, float]:
        """Number of the piece in which the way goes on from a crank angle, and how many periods
        that angle is ahead of it, as an angle, rad; direction is 1 or -1.
        """
        inside = theta + direction * ROUNDING * self.period
        ahead = self.period * floor(inside / self.period)
        return bisect_right(self._starts, inside - ahead) - 1, ahead

    def within(self, k: int, low: float, high: float) -> tuple[Array, Array]:
        """Values (C, NODES) at the nodes of a part of a piece, between places from -1 to 1 in it,
        and coefficients (NODES,) of the first of them.
        """
        places = (low + high) / 2 + (high - low) / 2 * POINTS
        values = self.coefficients[k] @ polynomials(places)[:, :NODES].T
        return values, TO_CHEBYSHEV @ values[0]

    def at(self, theta: float) -> tuple[Array, Array]:
        """Values and derivatives (C,) at a crank angle."""
        k, ahead = self.piece(theta, 1.0)
        half = (self.highs[k] - self.lows[k]) / 2
        x = (theta - ahead - self.lows[k]) / half - 1
        basis, coefficients = polynomials(x)[:NODES], self.coefficients[k]
        return coefficients @ basis, coefficients @ (DERIVATIVE.T @ basis[:-1]) / half
