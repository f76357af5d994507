"""Eigenvalues of a tool with damping, all of those within a circle."""

from __future__ import annotations

from typing import Any

import numpy as np

from equipoise.tools.chain import carry, log_determinant
from equipoise.tools.duals import Dual, value_of
from equipoise.tools.layout import Layout

Array = np.ndarray[Any, Any]

ROUNDS, CLOSE, SAME = 60, 1e-13, 1e-7
"""Steps of the iteration at most; the relative step at which it has arrived, and the distance at
which a zero is one that is known."""
NEAR, APART = 0.01, 1e-4
"""Damping ratio at which the iteration begins, and how much further up each that follows."""
POINTS, TURN, REFINED = 256, 0.8, 14
"""Points of the contour at first; turn (rad) from one to the next that is small enough; how often
the distance between them is halved where it is not."""
ABOVE = 1e-6
"""Height of the contour's straight part over the real axis, over its radius."""
TRIES, HALVINGS = 6, 52


def characteristic(layout: Layout, s: Array) -> tuple[Array, Array]:
    """Logarithm of the characteristic function of both planes at s (2, F), and its derivative."""
    variable: Any = Dual(s, np.ones((1, *s.shape)))
    logarithm, slope = log_determinant(carry(layout.chain(variable, "free")))
    for below in layout.absorbers(variable, "free"):  # it has a pole there, and this a zero
        logarithm = logarithm + np.log(below.value + 0j)
        slope = slope + below.slopes[0] / below.value
    return logarithm, slope


def eigenvalues(layout: Layout, natural: Array, radius: Array) -> tuple[list[Array], list[int]]:
    """Eigenvalues of each plane above the real axis, |s| less than its radius, by |s|.

    layout : fine enough for twice the radius.
    natural : natural frequencies (2, K) without damping, rad/s, from which the search begins.
    radius : of both planes (2,), rad/s, between two of the eigenvalues' sizes as well as can be.

    Returns
    -------
    lists of both planes : eigenvalues (1/s); how many there are besides that were not found, by the
        turns of the characteristic function around the half circle.
    """
    found = [np.empty(0, complex), np.empty(0, complex)]
    lacking = [1, 1]
    starts = natural * (1j - NEAR) * (1 + APART * np.arange(natural.shape[1]))
    random = np.random.default_rng(0)
    for _ in range(TRIES):
        roots = _roots(layout, starts, found)
        for plane in range(2):
            found[plane] = _within(_merged(found[plane], roots[plane]), radius[plane])
            lacking[plane] = _turns(layout, plane, float(radius[plane])) - len(found[plane])
        if max(lacking) <= 0:
            break
        size = radius[:, None] * np.sqrt(random.random((2, 2 * max(lacking))))
        starts = size * np.exp(1j * np.pi * (0.5 + 0.5 * random.random(size.shape)))
    return found, lacking


def _within(roots: Array, radius: float) -> Array:
    """Those inside the contour."""
    inside: Array = roots[(np.abs(roots) < radius) & (roots.imag > ABOVE * radius)]
    return inside


def _roots(layout: Layout, starts: Array, known: list[Array]) -> Array:
    """Zeros by Newton's method, kept apart from each other and from those known (Aberth)."""
    s = starts.astype(complex)
    with np.errstate(all="ignore"):  # on a zero the function has no logarithm
        for _ in range(ROUNDS):
            _, slope = characteristic(layout, s)
            push = np.array([_push(s[plane], known[plane]) for plane in range(2)])
            step = np.nan_to_num(1 / (slope - push), nan=0.0, posinf=0.0, neginf=0.0)
            step *= np.minimum(1.0, 0.5 * np.abs(s) / np.maximum(np.abs(step), 1e-300))
            s = s - step
            s = np.where(s.imag < 0, np.conj(s), s)
            if np.all(np.abs(step) < CLOSE * np.abs(s)):
                break
        _, slope = characteristic(layout, s)
        arrived = np.nan_to_num(np.abs(1 / slope), nan=0.0) < np.sqrt(CLOSE) * np.abs(s)
    return np.where(arrived & (s.imag > ABOVE * np.abs(s)), s, np.nan)


def _push(s: Array, known: Array) -> Array:
    """Logarithmic derivative of the product of the distances to all other zeros."""
    others = np.concatenate([s, np.conj(s), known, np.conj(known)])
    apart = s[:, None] - others
    apart[np.arange(len(s)), np.arange(len(s))] = np.inf
    return np.asarray(np.sum(1 / apart, axis=1))


def _merged(found: Array, roots: Array) -> Array:
    """Those known and new ones, by size; zeros of one search lie together where one is manifold."""
    new = [
        root
        for root in roots[np.isfinite(roots)]
        if all(abs(root - other) > SAME * abs(root) for other in found)
    ]
    return np.array(sorted([*found, *new], key=abs), complex)


def _turns(layout: Layout, plane: int, radius: float) -> int:
    """Zeros in the half circle above the real axis: how often the function turns around it."""
    place = np.linspace(0.0, 1.0, POINTS + 1)
    phase = _phase(layout, plane, radius, place)
    for _ in range(REFINED):
        wide = np.flatnonzero(np.abs(_principal(np.diff(phase))) > TURN)
        if not wide.size:
            break
        middle = (place[wide] + place[wide + 1]) / 2
        phase = np.insert(phase, wide + 1, _phase(layout, plane, radius, middle))
        place = np.insert(place, wide + 1, middle)
    return round(float(np.sum(_principal(np.diff(phase)))) / (2 * np.pi))


def _phase(layout: Layout, plane: int, radius: float, place: Array) -> Array:
    """Phase of the characteristic function at places of the contour, 0 to 1: line, then arc."""
    line = place < 0.5
    along = radius * (4 * place - 1)
    arc = radius * np.exp(2j * np.pi * (place - 0.5))
    s = np.where(line, along, arc) + 1j * ABOVE * radius
    logarithm, _ = characteristic(layout, np.array([s, s]))
    return np.asarray(np.broadcast_to(value_of(logarithm), (2, len(s)))[plane].imag)


def _principal(angle: Array) -> Array:
    return (angle + np.pi) % (2 * np.pi) - np.pi


def overdamped(layout: Layout, lowest: float, radius: Array) -> list[Array]:
    """Eigenvalues of each plane that do not swing, from -radius (2,) to -lowest, 1/s, by size.

    Without hysteresis the characteristic function is real there; they are where its sign changes.
    """
    if layout.tool.shaft.loss_factor:
        return [np.empty(0), np.empty(0)]
    return [_sign_changes(layout, plane, lowest, float(radius[plane])) for plane in range(2)]


def _sign_changes(layout: Layout, plane: int, lowest: float, radius: float) -> Array:
    sizes = np.geomspace(lowest, radius, 4 * POINTS)
    up = _positive(layout, plane, sizes)
    where = np.flatnonzero(up[1:] != up[:-1])
    low, high = sizes[where], sizes[where + 1]
    for _ in range(HALVINGS if where.size else 0):
        middle = (low + high) / 2
        same = _positive(layout, plane, middle) == up[where]
        low, high = np.where(same, middle, low), np.where(same, high, middle)
    return np.asarray(-(low + high) / 2)


def _positive(layout: Layout, plane: int, sizes: Array) -> Array:
    s = np.array([-sizes, -sizes]) + 0j
    logarithm, _ = characteristic(layout, s)
    return np.asarray(np.cos(np.broadcast_to(logarithm, s.shape)[plane].imag) > 0)
