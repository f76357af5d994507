"""Eigenvalues of a tool: without damping by elements and counting, with damping by Newton's method.

Beam elements with the displacement w and slope theta of both ends as coordinates, whose shapes are
exact for loads at the ends, with shear by Timoshenko's theory (Przemieniecki, Theory of Matrix
Structural Analysis, 1968).  The error of an eigenvalue falls with the fourth power of their number,
with the square where the shaft yields to shear, which is alike all along an element here.

Elements alone do not replace the counting.  60 of them, by `scipy.linalg.eigh`, miss the first four
frequencies of the bundled tools by up to 5e-7, but the seven of a usual list by 6e-6 (brush cutter,
which yields to shear; 2e-6 Nagamine and Irie's) and the highest of 31 by 4 %, where counting has
all digits; 240 still miss the latter by 2e-3, and in their lowest frequencies rounding grows with
the fourth power of the number.  For seven frequencies 60 elements take as long as counting, 120
take two to four times as long.  So frequencies are counted, and elements say where Newton's method
begins for those with damping.
"""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise
from math import atan, ceil
from typing import Any

import numpy as np
from numpy.polynomial.legendre import leggauss

from equipoise.errors import ModelError, UsageError
from equipoise.handheld.chain import Dual, carry, count, log_determinant
from equipoise.handheld.layout import Layout
from equipoise.handheld.model import Tool
from equipoise.handheld.shaft import Section
from equipoise.i18n import Note
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
        still = layout.station_impedance(bare, 0.0, 0.0, "free")  # affine in s and in its square
        for matrix, s, square in ((restraint, 0.0, 0.0), (damping, 1.0, 0.0), (mass, 0.0, 1.0)):
            sits = layout.station_impedance(bare, s, square, "free")
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


PARTS, ROUNDS = 63, 20
"""Each round cuts the bracket of every frequency into so many parts, one more than these, until
nothing lies between its ends."""
GROWTH, DOUBLINGS = 2.0, 200
"""Growth of the highest frequency until there are enough below it."""
MOST = 200
"""Natural frequencies that can be asked for: far above what shakes a hand."""


def scale_of(tool: Tool) -> float:
    """Frequency (rad/s) of the shaft at which lambda is 1: sqrt(EI / (m L^3)) with its own mass."""
    shaft = tool.shaft
    stiffness = shaft.profile.section(shaft.theory).bending_stiffness
    return float(np.sqrt(stiffness / (shaft.mass * shaft.length**3)))


def rigid_modes(tool: Tool) -> list[Array]:
    """Motions (D, 2) of the shaft that no spring holds, in the vertical and in the lateral plane.

    Displacement of the left end (m) and slope (rad) of each rigid motion that is free.
    """
    return [_free(tool, plane) for plane in range(2)]


def floating(tool: Tool) -> list[list[str]]:
    """Stations of each plane whose absorber has a mass, but no spring."""
    heavy = [
        (station.name, station.absorber)
        for station in tool.stations
        if station.absorber is not None
    ]
    return [
        [name for name, item in heavy if item.mass and not item.stiffness[plane]]
        for plane in range(2)
    ]


def _free(tool: Tool, plane: int) -> Array:
    """By how many places springs hold, and whether one holds a rotation: however stiff they are."""
    layout = Layout(tool, 0.0)
    places = set()
    for item in tool.stations:  # springs to what does not move; a measured hand is none
        springs: Any = sum(layout.holding(item, 0.0, "undamped").values())
        if springs[plane, 0]:
            places.add(item.position)
    turning = any(station.rotational_stiffness[plane] for station in tool.stations)
    if len(places) > 1 or (places and turning):
        return np.empty((0, 2))
    if places:
        return np.array([[0.0 - places.pop(), 1.0]])
    return np.eye(2)[: 1 if turning else 2]


TOO_FAR_APART = Note(
    "sizes are too far apart for natural frequencies and modes to be computed; check its length, "
    "stiffness and mass, and the masses and springs on it"
)


def natural_frequencies(tool: Tool, number: int) -> Array:
    """The first so many natural frequencies (2, number) of both planes, rad/s, without damping.

    Rigid motions that no spring holds come first, as 0.  A double frequency is listed
    twice.  Hands known by a table of impedance are left out.

    Raises
    ------
    UsageError : too many are asked for.
    """
    if not 1 <= number <= MOST:
        raise UsageError(
            Note("got {number} natural frequencies; ask for 1 to {most}", number=number, most=MOST)
        )
    layout, below = _enough(tool, number)
    wanted = np.arange(1, number + 1)
    free = zip(rigid_modes(tool), floating(tool), strict=True)
    rigid = np.array([[len(motions) + len(names)] for motions, names in free])
    bottom, top = np.zeros((2, number)), np.full((2, number), below)
    shares = np.arange(1, PARTS + 1) / (PARTS + 1)
    for _ in range(ROUNDS):
        inner = bottom[..., None] + (top - bottom)[..., None] * shares
        reached = _count(layout, inner.reshape(2, -1)).reshape(inner.shape) >= wanted[:, None]
        before = np.sum(~reached, axis=-1)  # the count grows with the frequency
        edges = np.concatenate([bottom[..., None], inner, top[..., None]], axis=-1)
        bottom = np.take_along_axis(edges, before[..., None], -1)[..., 0]
        top = np.take_along_axis(edges, before[..., None] + 1, -1)[..., 0]
        if np.all((top - bottom <= 2 * np.spacing(top)) | (wanted <= rigid)):
            break
    values: Array = np.where(wanted <= rigid, 0.0, (bottom + top) / 2)
    return values


def frequencies_below(tool: Tool, highest: float) -> list[Array]:
    """All natural frequencies of each plane below one, rad/s, without rigid motions."""
    reached = _count(Layout(tool, highest), np.full((2, 1), highest))[:, 0]
    most = int(min(np.max(reached), MOST))
    if most == 0:
        return [np.empty(0), np.empty(0)]
    return [row[(row > 0) & (row < highest)] for row in natural_frequencies(tool, most)]


def _enough(tool: Tool, number: int) -> tuple[Layout, float]:
    """A layout, and a frequency below which both planes have so many natural ones, rad/s."""
    highest = scale_of(tool) * (np.pi * (number + 1)) ** 2
    for _ in range(DOUBLINGS):
        layout = Layout(tool, highest)
        if np.all(_count(layout, np.full((2, 1), highest)) >= number):
            return layout, highest
        highest *= GROWTH
    raise ModelError(
        "shaft", Note("has no such high natural frequencies; check its length and section")
    )


def _count(layout: Layout, frequency: Array) -> Array:
    """Natural frequencies below each of these (2, F), rad/s."""
    s = 1j * frequency
    carried = carry(layout.chain(s, "undamped"))
    last = carried.stiffness[-1]
    if not np.any(np.isfinite(last.aa * last.tt)):
        raise ModelError("shaft", TOO_FAR_APART)
    total = count(carried)
    for below in layout.absorbers(s, "undamped"):  # with its base held, it swings at k = m w^2
        total = total + (np.real(below) < 0)
    return np.broadcast_to(total, frequency.shape)


ROOT_STEPS, CLOSE, SAME = 60, 1e-13, 1e-7
"""Steps of the iteration at most; the relative step at which it has arrived, and the distance at
which a zero is one that is known."""
SLOWEST = 1e-4
"""Smallest eigenvalue looked for, over the lowest natural frequency and that of the bare shaft."""
AROUND = 1.1
"""How far beyond the sizes that are looked for the iteration begins."""
REAL, BARELY = 1e-7, 0.1
"""Share of its size that the imaginary part of an eigenvalue must have for it to swing, and that up
to which finite elements may have taken a pair for two that do not swing, or the other way round."""
WEDGE, LOSSES = 0.1, 1.5
"""With hysteresis eigenvalues nearer than this angle (rad), or than so many times that by which
hysteresis turns a stiffness, to the negative real axis are not looked for."""
HALVINGS = 52
"""Of an interval between two counts, after which it is as wide as its last digit."""


def characteristic(layout: Layout, s: Array) -> tuple[Array, Array]:
    """Logarithm of the characteristic function of both planes at s (2, F), and its derivative."""
    variable: Any = Dual(s, np.ones((1, *s.shape)))
    with np.errstate(all="ignore"):  # on a zero it has no logarithm
        logarithm, slope = log_determinant(carry(layout.chain(variable, "free")))
        for below in layout.absorbers(variable, "free"):  # it has a pole there, and this a zero
            logarithm = logarithm + np.log(below.value + 0j)
            slope = slope + below.slopes[0] / below.value
    return logarithm, slope


def eigenvalues(layout: Layout, natural: Array, high: Array) -> list[Array]:
    """Eigenvalues (1/s) of each plane, by size: those that swing, above the real axis, and others.

    Finite elements say roughly where they are, and how many; there the characteristic function is
    zero.  A loss factor is a model for motions that swing; with it those that do not are not looked
    for.

    layout : fine enough for twice the largest size.
    natural : natural frequencies (2, K) without damping, up to the largest size, rad/s.
    high : largest size of an eigenvalue of both planes (2,), rad/s, between two of the eigenvalues'
        sizes as well as can be.
    """
    lowest = float(np.min(natural[natural > 0], initial=scale_of(layout.tool)))
    low, number = SLOWEST * lowest, natural.shape[1]
    still = zip(rigid_modes(layout.tool), floating(layout.tool), strict=True)
    rough = [
        rough_eigenvalues(layout, plane, number, lowest=lowest, rigid=len(motions) + len(names))
        for plane, (motions, names) in enumerate(still)
    ]
    swinging = [_swinging(rough[plane], low, float(high[plane])) for plane in range(2)]
    starts = np.full((2, max(map(len, swinging))), np.nan, complex)
    for plane in range(2):
        starts[plane, : len(swinging[plane])] = swinging[plane]
    arrays = []
    for plane, roots in enumerate(_roots(layout, starts)):
        own = _within(layout, _distinct(roots), low, high[plane])
        real = _overdamped(layout, plane, rough[plane], (low, float(high[plane])))
        both = np.concatenate([own, real])
        arrays.append(both[np.argsort(np.abs(both), kind="stable")])
    return arrays


def _swinging(rough: Array, low: float, high: float) -> Array:
    """Where the search for eigenvalues that swing begins: also between two that just do not."""
    size = np.abs(rough)
    rough = rough[(size > low / AROUND) & (size < high * AROUND)]
    real = np.sort(np.abs(rough[np.abs(rough.imag) <= REAL * np.abs(rough)]))
    pairs = [(a, b) for a, b in pairwise(real) if b - a < BARELY * b]
    between = [(1j * BARELY - 1) * (a + b) / 2 for a, b in pairs]
    return np.concatenate([rough[rough.imag > REAL * np.abs(rough)], np.array(between, complex)])


def _within(layout: Layout, roots: Array, low: float, high: float) -> Array:
    """Those that are looked for."""
    size = np.abs(roots)
    inside = (size > low) & (size < high) & (roots.imag > REAL * size)
    if layout.tool.shaft.loss_factor:
        inside &= np.angle(roots) < np.pi - _wedge(layout)
    return np.asarray(roots[inside])


def _wedge(layout: Layout) -> float:
    """Angle to the negative real axis within which nothing is looked for, rad."""
    return max(WEDGE, LOSSES * atan(layout.tool.shaft.loss_factor))


def _roots(layout: Layout, starts: Array) -> Array:
    """Zeros (2, K) by Newton's method, kept apart from each other (Aberth).

    Where it does not arrive, the start, which is an eigenvalue of the finite elements; NaN where
    there is no start, or one that may stand for two that do not swing.
    """
    if not starts.size:
        return starts
    unused = np.isnan(starts)
    s = np.where(unused, 1j, starts)
    with np.errstate(all="ignore"):  # on a zero the function has no logarithm
        for _ in range(ROOT_STEPS):
            _, slope = characteristic(layout, s)
            push = np.array([_push(own, used) for own, used in zip(s, ~unused, strict=True)])
            step = np.nan_to_num(1 / (slope - push), nan=0.0, posinf=0.0, neginf=0.0)
            step *= np.minimum(1.0, 0.5 * np.abs(s) / np.maximum(np.abs(step), 1e-300))
            s = np.where(unused, s, s - step)
            s = np.where(s.imag < 0, np.conj(s), s)
            if np.all(unused | (np.abs(step) < CLOSE * np.abs(s))):
                break
        _, slope = characteristic(layout, s)
        arrived = np.nan_to_num(np.abs(1 / slope), nan=0.0) < np.sqrt(CLOSE) * np.abs(s)
    return np.where(arrived, s, np.where(starts.imag > BARELY * np.abs(starts), starts, np.nan))


def _push(s: Array, used: Array) -> Array:
    """Logarithmic derivative of the product of the distances to all other zeros."""
    others = np.concatenate([s, np.conj(s)])
    apart = s[:, None] - others
    apart[np.arange(len(s)), np.arange(len(s))] = np.inf
    apart[:, ~np.tile(used, 2)] = np.inf
    return np.asarray(np.sum(1 / apart, axis=1))


def _distinct(roots: Array) -> Array:
    """Each zero once, by size."""
    values: list[complex] = []
    for root in sorted(roots[np.isfinite(roots)], key=abs):
        if all(abs(root - item) > SAME * abs(root) for item in values):
            values.append(root)
    return np.array(values, complex)


def _overdamped(layout: Layout, plane: int, rough: Array, radii: tuple[float, float]) -> Array:
    """Eigenvalues of a plane that do not swing, 1/s, of a size between two, rad/s.

    Without hysteresis the characteristic function is real there; they are where its sign changes.
    It is looked at between those that finite elements have, and between pairs that just swing.
    """
    if layout.tool.shaft.loss_factor:
        return np.empty(0)
    low, high = radii
    size = np.abs(rough)
    real_rates = np.sort(-rough.real[(np.abs(rough.imag) <= BARELY * size) & (rough.real < 0)])
    swings = np.abs(rough.imag) > REAL * size
    just = -rough.real[swings & (np.abs(rough.imag) <= BARELY * size)]
    sizes = np.unique(np.concatenate([np.sqrt(real_rates[1:] * real_rates[:-1]), just, real_rates]))
    sizes = np.concatenate([[low], sizes[(sizes > low) & (sizes < high)], [high]])
    up = _positive(layout, plane, sizes)
    where = np.flatnonzero(up[1:] != up[:-1])
    left, right = sizes[where], sizes[where + 1]
    for _ in range(HALVINGS if where.size else 0):
        middle = (left + right) / 2
        same = _positive(layout, plane, middle) == up[where]
        left, right = np.where(same, middle, left), np.where(same, right, middle)
    return np.asarray(-(left + right) / 2)


def _positive(layout: Layout, plane: int, sizes: Array) -> Array:
    s = np.array([-sizes, -sizes]) + 0j
    logarithm, _ = characteristic(layout, s)
    return np.asarray(np.cos(np.broadcast_to(logarithm, s.shape)[plane].imag) > 0)
