"""A tool as finite elements: roughly where its eigenvalues lie, so that none is missed.

Beam elements with the displacement w and slope theta of both ends as coordinates, whose shapes are
exact for loads at the ends, with shear by Timoshenko's theory (Przemieniecki, Theory of Matrix
Structural Analysis, 1968).  The error of an eigenvalue falls with the fourth power of their number,
with the square where the shaft yields to shear, which is alike all along an element here.
"""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise
from math import ceil

import numpy as np
from numpy.polynomial.legendre import leggauss

from equipoise.handheld.layout import Layout
from equipoise.handheld.shaft import Section
from equipoise.signals import Array

LEAST, OF_MODE = 24, 3
"""Elements of a shaft at least, and for each mode that is wanted."""
PLACES, WEIGHTS = (0.5 * part for part in leggauss(4))
"""Of Gauss's rule on (-1/2, 1/2), exact for the products of these cubics."""
POWERS = (PLACES + 0.5)[:, None] ** np.arange(4)


def element(length: float, section: Section) -> tuple[Array, Array]:
    """Mass and stiffness (4, 4) of an element, for w (m) and theta (rad) of its ends.

    length : m.
    section : as the theory of the shaft sees it.
    """
    bending, shear = section.bending_stiffness, section.shear_stiffness
    yields = 12 * bending / (shear * length**2)
    half = yields / 2
    across = np.array(  # of each coordinate: coefficients of the powers of x / length
        [
            [1 + yields, -yields, -3, 2],
            [0, length * (1 + half), -length * (2 + half), length],
            [0, yields, 3, -2],
            [0, -length * half, length * (half - 1), length],
        ]
    )
    slope = np.array(
        [
            [0, -6 / length, 6 / length, 0],
            [1 + yields, -4 - yields, 3, 0],
            [0, 6 / length, -6 / length, 0],
            [0, yields - 2, 3, 0],
        ]
    )
    w, theta = (POWERS @ part.T / (1 + yields) for part in (across, slope))
    bent = POWERS[:, :2] @ (slope[:, 1:3] * [1, 2]).T / (length * (1 + yields))
    sheared = np.array([-1 / length, -0.5, 1 / length, -0.5]) / (1 + yields)
    weights = length * WEIGHTS[:, None]
    mass = section.mass_per_length * w.T @ (weights * w)
    mass += section.rotary_inertia * theta.T @ (weights * theta)
    stiffness = bending * bent.T @ (weights * bent)
    # kGA gamma^2 with gamma = yields * sheared; finite also where nothing yields to shear
    stiffness += 12 * bending / length * yields * np.outer(sheared, sheared)
    return mass, stiffness


def matrices(layout: Layout, plane: int, number: int) -> tuple[Array, Array, Array, Array]:
    """Mass, damping, stiffness of what sits on the shaft and stiffness of the shaft, (N, N) each.

    Coordinates: w and theta from the left node to the right one, then absorbers with a mass.

    plane : 0 vertical, 1 lateral.
    number : how many modes are wanted.
    """
    tool = layout.tool
    stops = {0.0, *(stop for _, stop, _ in tool.shaft.pieces)}
    stops |= {float(station.position) for station in tool.stations}
    finest = tool.shaft.length / max(LEAST, OF_MODE * number)
    nodes = [0.0]
    for start, stop in pairwise(sorted(stops)):
        nodes += np.linspace(start, stop, ceil((stop - start) / finest) + 1)[1:].tolist()
    own = [
        station
        for station in tool.stations
        if station.absorber is not None and station.absorber.mass
    ]
    size = 2 * len(nodes) + len(own)
    mass, damping, restraint, shaft = (np.zeros((size, size)) for _ in range(4))
    for k, (left, right) in enumerate(pairwise(nodes)):
        middle = (left + right) / 2
        section = next(item for _, stop, item in tool.shaft.pieces if middle <= stop)
        part = slice(2 * k, 2 * k + 4)
        for matrix, of_element in zip((mass, shaft), element(right - left, section), strict=True):
            matrix[part, part] += of_element
    for station in tool.stations:
        at = int(np.argmin(np.abs(np.array(nodes) - station.position)))
        bare = [replace(station, absorber=None)]
        still = layout.sitting(bare, 0.0, 0.0, "free")  # affine in s and in its square
        for matrix, s, square in ((restraint, 0.0, 0.0), (damping, 1.0, 0.0), (mass, 0.0, 1.0)):
            sits = layout.sitting(bare, s, square, "free")
            for row, value, stiff in zip((2 * at, 2 * at + 1), sits, still, strict=True):
                change = value - stiff if s or square else value
                matrix[row, row] += np.broadcast_to(change, (2, 1))[plane, 0]
        if station in own:
            last, absorber = size - len(own) + own.index(station), station.absorber
            assert absorber is not None
            mass[last, last] = absorber.mass
            between = np.zeros(size)
            between[[2 * at, last]] = 1.0, -1.0
            restraint += absorber.stiffness[plane] * np.outer(between, between)
            damping += absorber.damping[plane] * np.outer(between, between)
    return mass, damping, restraint, shaft


def rough_eigenvalues(
    layout: Layout, plane: int, number: int, *, lowest: float, rigid: int
) -> Array:
    """All eigenvalues (2 N,) of the elements, 1/s, by size.

    Coordinates are the modes without damping, each scaled by its frequency, since mass and
    stiffness run over many powers of ten; modes of K + lowest^2 M against M, whose slow ones keep
    the digits that those of M against K lose to the fastest.

    plane, number : as in `matrices`.
    lowest : natural frequency without damping, rad/s, but for motions that no spring holds.
    rigid : how many of these there are; their stiffness is rounding here.
    """
    from scipy.linalg import eigh, eigvals

    mass, damping, restraint, shaft = matrices(layout, plane, number)
    inverse, modes = eigh(mass, restraint + shaft + lowest**2 * mass)
    inverse, modes = inverse[::-1], modes[:, ::-1] / np.sqrt(inverse[::-1])
    squares = np.maximum(1 / inverse - lowest**2, 0.0)
    squares[:rigid] = 0.0
    speeds = np.sqrt(np.maximum(squares, lowest**2))
    stiffness = np.diag(squares)
    if factor := layout.tool.shaft.loss_factor:
        stiffness = stiffness + 1j * factor * (modes.T @ shaft @ modes)
        stiffness[:rigid] = stiffness[:, :rigid] = 0.0
    companion = np.block(
        [
            [np.zeros_like(mass), np.diag(speeds)],
            [-stiffness / speeds, -modes.T @ damping @ modes],
        ]
    )
    values = eigvals(companion)
    return np.asarray(values[np.argsort(np.abs(values), kind="stable")])
