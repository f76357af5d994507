"""Eigenvalues of a tool: counted without damping, so that none is missed; by a contour with it."""

from __future__ import annotations

from collections.abc import Callable
from math import atan
from typing import Any

import numpy as np

from equipoise.errors import ModelError, UsageError
from equipoise.handheld.chain import carry, count, log_determinant
from equipoise.handheld.duals import Dual
from equipoise.handheld.layout import Layout
from equipoise.handheld.model import Tool
from equipoise.i18n import Note
from equipoise.signals import Array

PARTS, ROUNDS = 63, 20
"""Each round cuts the bracket of every frequency into so many parts, one more than these, until
nothing lies between its ends."""
GROWTH, DOUBLINGS = 2.0, 200
"""Growth of the highest frequency until there are enough below it."""
MOST = 200


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
    heavy = [(one.name, one.absorber) for one in tool.stations if one.absorber is not None]
    return [
        [name for name, one in heavy if one.mass and not one.stiffness[plane]] for plane in range(2)
    ]


def _free(tool: Tool, plane: int) -> Array:
    """By how many places springs hold, and whether one holds a rotation: however stiff they are."""
    layout = Layout(tool, 0.0)
    places = set()
    for one in tool.stations:  # springs to what does not move; a measured hand is none
        springs: Any = sum(layout.holding(one, 0.0, "undamped").values())
        if springs[plane, 0]:
            places.add(one.position)
    turning = any(one.rotational_stiffness[plane] for one in tool.stations)
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

    Rigid motions that no spring holds come first, as 0.  A frequency that stands twice is told
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
    found: Array = np.where(wanted <= rigid, 0.0, (bottom + top) / 2)
    return found


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


Curve = Callable[[Array], Array]
"""Complex frequencies, 1/s, at places from 0 to 1."""

ROOT_STEPS, CLOSE, SAME = 60, 1e-13, 1e-7
"""Steps of the iteration at most; the relative step at which it has arrived, and the distance at
which a zero is one that is known."""
NEAR, APART = 0.01, 1e-4
"""Damping ratio at which the iteration begins, and how much further up each that follows."""
POINTS, TURN, REFINED = 256, 0.8, 24
"""Points of a contour at first; turn (rad) from one to the next that is small enough; how often
the distance between them is halved where it is not."""
REAL = 1e-7
"""Share of its size that the imaginary part of an eigenvalue must have for it to swing."""
WEDGE, LOSSES = 0.1, 1.5
"""With hysteresis eigenvalues nearer than this angle (rad), or than so many times that by which
hysteresis turns a stiffness, to the negative real axis are not looked for."""
TRIES, FINER, HALVINGS = 6, 3, 52


def characteristic(layout: Layout, s: Array) -> tuple[Array, Array]:
    """Logarithm of the characteristic function of both planes at s (2, F), and its derivative."""
    variable: Any = Dual(s, np.ones((1, *s.shape)))
    with np.errstate(all="ignore"):  # on a zero it has no logarithm
        logarithm, slope = log_determinant(carry(layout.chain(variable, "free")))
        for below in layout.absorbers(variable, "free"):  # it has a pole there, and this a zero
            logarithm = logarithm + np.log(below.value + 0j)
            slope = slope + below.slopes[0] / below.value
    return logarithm, slope


def eigenvalues(
    layout: Layout, natural: Array, radii: tuple[float, Array]
) -> tuple[list[Array], list[int]]:
    """Eigenvalues of each plane, by size: those that swing, above the real axis, and real ones.

    layout : fine enough for twice the largest radius.
    natural : natural frequencies (2, K) without damping, rad/s, from which the search begins.
    radii : smallest size of an eigenvalue that is looked for, rad/s, and the largest of both
        planes (2,), between two of the eigenvalues' sizes as well as can be.

    Returns
    -------
    lists of both planes : eigenvalues (1/s); how many there are besides that were not found, by the
        turns of the characteristic function around all that were looked for.

    A loss factor is a model for motions that swing; with it those that do not are not looked for.
    """
    low, high = radii
    total = [_number(layout, plane, low, float(high[plane])) for plane in range(2)]
    weight = 1 if layout.tool.shaft.loss_factor else 2  # zeros counted for each that swings
    swinging, real = [np.empty(0, complex)] * 2, [np.empty(0)] * 2
    starts = natural * (1j - NEAR) * (1 + APART * np.arange(natural.shape[1]))
    random = np.random.default_rng(0)
    for attempt in range(TRIES):
        roots = _roots(layout, starts, swinging)
        for plane in range(2):
            kept = _within(layout, _merged(swinging[plane], roots[plane]), low, high[plane])
            swinging[plane] = kept
            real[plane] = overdamped(layout, plane, (low, float(high[plane])), FINER**attempt)
        lacking = [total[p] - len(real[p]) - weight * len(swinging[p]) for p in range(2)]
        if max(lacking) <= 0:
            break
        size = high[:, None] * np.sqrt(random.random((2, 2 * max(lacking))))
        starts = size * np.exp(1j * np.pi * (0.5 + 0.5 * random.random(size.shape)))
    both = (np.concatenate(parts) for parts in zip(swinging, real, strict=True))
    return [one[np.argsort(np.abs(one), kind="stable")] for one in both], lacking


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


def _roots(layout: Layout, starts: Array, known: list[Array]) -> Array:
    """Zeros by Newton's method, kept apart from each other and from those known (Aberth)."""
    s = starts.astype(complex)
    with np.errstate(all="ignore"):  # on a zero the function has no logarithm
        for _ in range(ROOT_STEPS):
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
    return np.where(arrived, s, np.nan)


def _push(s: Array, known: Array) -> Array:
    """Logarithmic derivative of the product of the distances to all other zeros."""
    others = np.concatenate([s, np.conj(s), known, np.conj(known)])
    apart = s[:, None] - others
    apart[np.arange(len(s)), np.arange(len(s))] = np.inf
    return np.asarray(np.sum(1 / apart, axis=1))


def _merged(found: Array, roots: Array) -> Array:
    """Those known and new ones, by size; zeros of one search lie together where one is manifold."""
    known = np.any(np.abs(roots[:, None] - found) <= SAME * np.abs(roots[:, None]), axis=1)
    new = roots[np.isfinite(roots) & ~known]
    return np.array(sorted([*found, *new], key=abs), complex)


def _number(layout: Layout, plane: int, low: float, high: float) -> int:
    """Zeros with a size between two, rad/s, by the turns of the characteristic function.

    Without hysteresis it has conjugate values below the real axis, so that half a turn over each
    arc is a zero in its whole circle.  With it the contour goes around the sector that is looked
    at.
    """
    if not layout.tool.shaft.loss_factor:
        whole, inner = (_turned(layout, plane, _arc(size, np.pi)) for size in (high, low))
        return round((whole - inner) / np.pi)
    end = np.pi - _wedge(layout)
    back = np.exp(1j * end)
    outward, around = _ray(low, high), _arc(high, end)
    inward, along = _ray(high * back, low * back), _arc(low, end)
    turns = [_turned(layout, plane, curve) for curve in (outward, around, inward, along)]
    return round((sum(turns[:3]) - turns[3]) / (2 * np.pi))


def _arc(size: float, angle: float) -> Curve:
    return lambda place: size * np.exp(1j * angle * place)


def _ray(start: complex, stop: complex) -> Curve:
    return lambda place: start * (stop / start) ** place


def _turned(layout: Layout, plane: int, curve: Curve) -> float:
    """Angle (rad) by which the characteristic function turns along a curve."""

    def phase(place: Array) -> Array:
        s = curve(place)
        logarithm, _ = characteristic(layout, np.array([s, s]))
        return np.asarray(np.broadcast_to(logarithm, (2, len(s)))[plane].imag)

    place = np.linspace(0.0, 1.0, POINTS + 1)
    found = phase(place)
    for _ in range(REFINED):
        wide = np.flatnonzero(np.abs(_principal(np.diff(found))) > TURN)
        if not wide.size:
            break
        middle = (place[wide] + place[wide + 1]) / 2
        found = np.insert(found, wide + 1, phase(middle))
        place = np.insert(place, wide + 1, middle)
    return float(np.sum(_principal(np.diff(found))))


def _principal(angle: Array) -> Array:
    return (angle + np.pi) % (2 * np.pi) - np.pi


def overdamped(layout: Layout, plane: int, radii: tuple[float, float], finer: int = 1) -> Array:
    """Eigenvalues of a plane that do not swing, 1/s, of a size between two, rad/s.

    Without hysteresis the characteristic function is real there; they are where its sign changes.

    finer : how many times as many places as usual are looked at, as two may lie close together.
    """
    if layout.tool.shaft.loss_factor:
        return np.empty(0)
    sizes = np.geomspace(*radii, 4 * POINTS * finer)
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
