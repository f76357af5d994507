"""Figures of a planting mechanism by a second route, without a line of Equipoise.

The tip P of a planting finger sits on the coupler of a four-bar whose crank turns evenly while the
machine drives forward.  Here the loop is closed by the law of cosines at many crank angles, and
everything that moves becomes a Fourier series in the crank angle: derivatives are exact term by
term.  Instants are roots (brentq) after a dense scan, integrals are Gauss sums over panels graded
towards the slowest instants, self-crossings are polyline intersections polished in two unknowns.

Accuracy, checked against 40 digits for machines A, B and C: figures 1e-14 of the largest value of
their kind, crank angles 1e-14 rad.  Without long doubles: accelerations, and the instants at which
they are extreme, 1e-10; all else 1e-12.  A loop within some 1e-3 rad of a cusp loses relative, not
absolute, accuracy.  SI units, angles in rad.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache, cached_property
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq, minimize_scalar, root

TURN = 2 * np.pi
SCAN = 24_000
"""Steps in which a turn of the crank is scanned."""
CUSP = 1e-9
"""Part of the largest |G'| below which the tip stands still over ground."""
SHORT = 1e-3
"""Crank travel below which a loop about a cusp is rounding error."""

Real = NDArray[np.float64]
Of = Callable[[Any], Any]


@dataclass(frozen=True)
class Trochoid:
    """A tip r exp(i theta) fixed on the crank, with the foot of the finger at the crank pivot."""

    r: float
    omega: float
    v: float
    depth: float

    def places(self, theta: Any) -> tuple[Any, Any]:
        """Tip P and foot Q relative to the machine."""
        return self.r * np.exp(1j * theta), 0 * theta


@dataclass(frozen=True)
class Case:
    """A four-bar planter: frame a, crank b, coupler c, rocker d (m), and how it works.

    ground : direction from the crank pivot A to the rocker pivot D.  tip, base : of the finger in
    coupler axes (origin B, x towards C).  side : +1 with C on the left of the line from B to D.
    omega : crank speed, signed.  v : forward speed.  depth : of the lowest point below the soil.
    """

    a: float
    b: float
    c: float
    d: float
    ground: float
    tip: complex
    omega: float
    v: float = 0.6
    depth: float = 0.04
    base: complex = 0
    side: int = 1

    def links(self, theta: Any) -> tuple[Any, Any]:
        """Unit vectors along the coupler (B to C) and along the rocker (D to C)."""
        line = self.a * np.exp(1j * self.ground) - self.b * np.exp(1j * theta)
        gap, towards = np.abs(line), np.arctan2(line.imag, line.real)
        at_b = np.arccos((self.c**2 + gap**2 - self.d**2) / (2 * self.c * gap))
        at_d = np.arccos((self.d**2 + gap**2 - self.c**2) / (2 * self.d * gap))
        coupler = np.exp(1j * (towards + self.side * at_b))
        return coupler, -np.exp(1j * (towards - self.side * at_d))

    def places(self, theta: Any) -> tuple[Any, Any]:
        """Tip P and foot Q relative to the machine."""
        pin, coupler = self.b * np.exp(1j * theta), self.links(theta)[0]
        return pin + self.tip * coupler, pin + self.base * coupler


def _machine(lengths: Sequence[float], ground: float, tip: complex, omega: float) -> Case:
    """A case from lengths in mm and a direction in degrees."""
    a, b, c, d = (length / 1000 for length in lengths)
    return Case(a, b, c, d, float(np.radians(ground)), tip / 1000, omega * np.pi)


A = _machine((75, 35, 75, 80), -90, -162.8 - 101.7j, +8)
B = _machine((125, 40, 100, 85), 142, -173.8 + 63.3j, -8)
C = _machine((120, 38, 103, 75), 102, (-345.1 + 103) - 100.3j, -8)
MACHINES = {"A": A, "B": B, "C": C}


class Series:
    """A complex function of the crank angle with period one turn, as its Fourier series."""

    def __init__(self, function: Of) -> None:
        for count in (256, 512, 1024, 2048, 4096, 8192, 16384):
            # Long doubles, where the platform has them, keep noise out of the high harmonics.
            theta = 2 * np.arccos(np.longdouble(-1)) * np.arange(count) / count
            modes = np.fft.fft(function(theta)) / count
            size, least = np.abs(modes), max(1e-17, np.finfo(modes.dtype).eps)
            if size[count // 4 : -count // 4].max() <= least * size.max():
                break
        else:
            raise ArithmeticError("the Fourier series does not converge")
        self.top = count // 4
        self.orders = np.arange(-self.top, self.top + 1)
        self.modes = modes[self.orders].astype(complex)

    def __call__(self, theta: Any, order: int = 0) -> Any:
        """The function or a derivative of it."""
        modes, turn = self.modes * (1j * self.orders) ** order, np.exp(1j * np.asarray(theta))
        forward = np.polyval(modes[: self.top - 1 : -1], turn)
        return forward + np.polyval(np.append(modes[: self.top], 0), np.conj(turn))

    def mean_rate(self, middle: float, half: float) -> complex:
        """Mean derivative from middle - half to middle + half, without cancellation."""
        damped = self.modes * np.sinc(self.orders * half / np.pi)
        return complex(np.sum(damped * 1j * self.orders * np.exp(1j * self.orders * middle)))


def dot(p: Any, q: Any) -> Any:
    return (np.conj(p) * q).real


def cross(p: Any, q: Any) -> Any:
    return (np.conj(p) * q).imag


def wrap(angle: float) -> float:
    """An angle in [0, 2 pi)."""
    return float(angle % TURN) % TURN


def direction(vector: complex) -> float:
    """Direction of a vector in (-pi, pi], with pi also for what is -pi but for rounding."""
    angle = float(np.angle(vector))
    return angle + TURN if angle < 1e-12 - np.pi else angle


def about(centres: Sequence[float], smallest: float, largest: float) -> Real:
    """Points that crowd geometrically on both sides of each centre."""
    steps = np.geomspace(smallest, largest, int(12 * np.log10(largest / smallest)) + 2)
    return np.concatenate([[], *([c, *(c - steps), *(c + steps)] for c in centres)])


def between(low: float, high: float, *more: Any) -> Real:
    """A dense grid from low to high that contains all further points in that range."""
    count = max(int(np.ceil(SCAN * (high - low) / TURN)), 400)
    points = np.concatenate([np.linspace(low, high, count + 1), *map(np.ravel, more)])
    return np.unique(points[(points >= low) & (points <= high)])


def modulo(points: Sequence[float], low: float, high: float) -> list[float]:
    """The given crank angles, and those any number of turns away, in a range."""
    turns = TURN * np.arange(np.floor(low / TURN) - 1, np.ceil(high / TURN) + 1)
    return sorted(float(p + t) for p in points for t in turns if low < p + t < high)


def roots(function: Of, grid: Real) -> list[float]:
    """Roots of a continuous function, one for every change of sign on the grid."""
    below, actual = function(grid) < 0, []
    for i in np.flatnonzero(below[1:] != below[:-1]):
        low, high = float(grid[i]), float(grid[i + 1])
        if function(low) * function(high) > 0:  # a root on the grid, to rounding
            actual.append(min(low, high, key=lambda s: abs(function(s))))
        else:
            actual.append(brentq(function, low, high, xtol=1e-15, rtol=1e-15))
    return actual


def flats(function: Of, slope: Of, grid: Real) -> list[float]:
    """Where a function is flat, least value first, from the roots of a multiple of its slope."""
    values = function(grid)
    if np.ptp(values) <= 1e-11 * np.abs(values).max():
        return [float(grid[0])]  # constant: any crank angle
    return sorted(roots(slope, grid), key=function)


def integral(function: Of, low: float, high: float, slow: Sequence[float] = ()) -> float:
    """Gauss sum over panels graded towards the instants at which the integrand may be sharp."""
    near = about(modulo(slow, low - 0.1, high + 0.1), 1e-12, 0.1)
    edges = np.unique(np.clip(np.concatenate([np.linspace(low, high, 301), near]), low, high))
    nodes, weights = np.polynomial.legendre.leggauss(16)
    half, middle = np.diff(edges)[:, None] / 2, (edges[1:] + edges[:-1])[:, None] / 2
    return float(np.sum(half * weights * function(middle + half * nodes)))


@dataclass(frozen=True)
class Path:
    """A path z + drift theta of the tip: over ground, or relative to the machine (drift 0)."""

    tip: Series
    drift: float = 0.0

    def at(self, theta: Any) -> Any:
        return self.tip(theta) + self.drift * np.asarray(theta)

    def rate(self, theta: Any) -> Any:
        return self.tip(theta, 1) + self.drift

    def speed(self, theta: Any) -> Any:
        return np.abs(self.rate(theta))

    @cached_property
    def fastest(self) -> float:
        return float(self.speed(between(0, TURN)).max())

    @cached_property
    def slow(self) -> list[float]:
        """Local minima of the rate of travel."""
        result = flats(self.speed, lambda s: dot(self.rate(s), self.tip(s, 2)), between(0, TURN))
        return [s for s in result if self.speed(s) < self.speed(s + np.array([-1e-4, 1e-4])).min()]

    @cached_property
    def cusps(self) -> list[float]:
        return [wrap(s) for s in self.slow if self.speed(s) < CUSP * self.fastest]

    def length(self, low: float, high: float) -> float:
        return integral(self.speed, low, high, self.slow)

    def extent(self, part: Of, low: float, high: float) -> float:
        """Greatest less least value of np.real or np.imag along a stretch of the path."""
        crowd = about(modulo(self.slow, low, high), 1e-8, 1e-2)
        flat = roots(lambda s: part(self.rate(s)), between(low, high, crowd))
        return float(np.ptp(part(self.at(np.array([low, high, *flat])))))

    def smallest_radius(self) -> dict[str, float]:
        """Least radius of curvature, zero at a cusp."""
        if self.cusps:
            return {"value": 0.0, "crank_angle": self.cusps[0]}

        def bend(s: Any) -> Any:
            return np.abs(cross(self.rate(s), self.tip(s, 2))) / self.speed(s) ** 3

        def change(s: Any) -> Any:
            first, second, third = self.rate(s), self.tip(s, 2), self.tip(s, 3)
            twist = cross(first, third) * np.abs(first) ** 2
            return twist - 3 * cross(first, second) * dot(first, second)

        crowd = about(modulo(self.slow, -0.1, TURN + 0.1), 1e-10, 1e-2)
        best = flats(bend, change, between(0, TURN, crowd))[-1]
        return {"value": float(1 / bend(best)), "crank_angle": wrap(best)}

    def crossings(self) -> list[tuple[float, float]]:
        """Crank angles (low, high) less than a turn apart at which the path crosses itself.

        Between two extrema of y a path meets each height once, so two such pieces intersect, as
        polylines, where their difference in x at equal height changes sign.
        """
        tops = roots(lambda s: self.tip(s, 1).imag, between(0, TURN) + 1e-3)
        ends = [t + turns for turns in (0, TURN, 2 * TURN) for t in tops][: 2 * len(tops) + 1]
        crowd = about(modulo(tops + self.slow, -TURN, 3 * TURN), 1e-5, 1e-2)
        pieces = []
        for low, high in pairwise(ends):
            grid = between(low, high, crowd)
            way = 1 if self.tip(low).imag < self.tip(high).imag else -1
            pieces.append((grid[::way], self.at(grid[::way])))
        actual = []
        for i, (s, p) in enumerate(pieces[: len(tops)]):
            for t, q in pieces[i + 1 : i + len(tops)]:
                y = np.unique(np.concatenate([p.imag, q.imag]))
                y = y[(y >= max(p[0].imag, q[0].imag)) & (y <= min(p[-1].imag, q[-1].imag))]
                gap = np.interp(y, p.imag, p.real) - np.interp(y, q.imag, q.real)
                for k in np.flatnonzero(gap[1:] * gap[:-1] < 0):
                    level = y[k] + (y[k + 1] - y[k]) * gap[k] / (gap[k] - gap[k + 1])
                    seed = np.interp(level, p.imag, s), np.interp(level, q.imag, t)
                    actual += self._polished(float(seed[0]), float(seed[1]))
        return actual

    def _polished(self, low: float, high: float) -> list[tuple[float, float]]:
        """The crossing near a seed, at which the mean rate in between vanishes; none if false."""
        middle, half = (low + high) / 2, (high - low) / 2

        def open_by(x: Real) -> list[float]:
            mean = self.tip.mean_rate(middle + half * x[0], half * x[1]) + self.drift
            return [mean.real, mean.imag]

        x = root(open_by, [0.0, 1.0], tol=1e-14).x
        centre, reach = float(middle + half * x[0]), float(abs(half * x[1]))
        near = modulo(self.cusps, centre - SHORT, centre + SHORT)
        rounding = reach < SHORT and (bool(near) or reach < 1e-6)
        if np.linalg.norm(open_by(x)) > 1e-12 * self.fastest or rounding or reach > np.pi - 1e-6:
            return []
        return [(centre - reach, centre + reach)]


class Planter:
    """A case with its series, its two paths and its stay in the soil."""

    def __init__(self, case: Case | Trochoid) -> None:
        self.case = case
        self.tip = Series(lambda s: case.places(s)[0])
        self.foot = Series(lambda s: case.places(s)[1])
        self.curve, self.ground = Path(self.tip), Path(self.tip, case.v / case.omega)
        levels = flats(lambda s: self.tip(s).imag, lambda s: self.tip(s, 1).imag, between(0, TURN))
        self.lowest, self.highest = levels[0], levels[-1]
        self.surface = float(self.tip(self.lowest).imag) + case.depth
        if not 0 < case.depth < self.tip(self.highest).imag - self.tip(self.lowest).imag:
            raise ValueError("the tip does not both enter and leave the soil")
        top, end = self.highest, self.highest + TURN
        grid = between(top, end, modulo(levels, top, end))
        sides = roots(lambda s: self.tip(s).imag - self.surface, grid)
        visits = list(zip(sides[::2], sides[1::2], strict=True))[:: 1 if case.omega > 0 else -1]
        main = [bool(modulo([self.lowest], *pair)) for pair in visits].index(True)
        self.visits = visits[main:] + visits[:main]
        """All (low, high) below the surface in a turn: the deepest, then the others in time."""

    def in_time(self, low: float, high: float) -> tuple[float, float]:
        """Two crank angles, the earlier first."""
        return (low, high) if self.case.omega > 0 else (high, low)

    def station(self, s: float) -> dict[str, Any]:
        """Place, velocities, acceleration and attitude at a crank angle."""
        place, omega = complex(self.tip(s)), self.case.omega
        return {
            "crank_angle": wrap(s),
            "x": place.real,
            "y": place.imag,
            "velocity": vector(self.tip(s, 1) * omega),
            "acceleration": vector(self.tip(s, 2) * omega**2),
            "ground_velocity": vector(self.ground.rate(s) * omega),
            "attitude": direction(place - self.foot(s)),
        }

    def soil(self) -> dict[str, float]:
        """What happens from the entry to the exit."""
        low, high = self.visits[0]
        start, stop = self.in_time(low, high)
        advance = float((self.ground.at(stop) - self.ground.at(start)).real)
        return {
            "crank_travel": high - low,
            "time": (high - low) / abs(self.case.omega),
            "path_length_ground": self.ground.length(low, high),
            "path_length_machine": self.curve.length(low, high),
            "ground_advance": advance,
            "ground_distance": abs(advance),
            "hole_length": self.hole(low, high),
        }

    def hole(self, low: float, high: float) -> float:
        """Extent of the places at which the finger pierces the surface while its foot is above."""

        def above(s: Any) -> Any:
            return self.foot(s).imag - self.surface

        def pierced(s: Any) -> Any:
            foot, tip = self.foot(s), self.tip(s)
            part = (self.surface - tip.imag) / (foot.imag - tip.imag)
            return self.ground.at(s).real + part * (foot - tip).real

        result = list(self.ground.at(np.array([low, high])).real)
        for start, stop in pairwise([low, *roots(above, between(low, high)), high]):
            if above((start + stop) / 2) <= 0:
                continue
            grid = between(start, stop)
            for sign in (1, -1):
                k = int(np.argmin(sign * pierced(grid)))
                span = grid[max(k - 1, 0)], grid[min(k + 1, len(grid) - 1)]
                best = minimize_scalar(
                    lambda s, sign=sign: sign * pierced(s), bounds=span, options={"xatol": 1e-12}
                )
                result += [float(pierced(grid[k])), sign * float(best.fun)]
        return float(np.ptp(result))

    def sharpest(self, low: float, high: float) -> float:
        """Largest |z''| in a range of crank angles."""

        def size(s: Any) -> Any:
            return np.abs(self.tip(s, 2))

        flat = flats(size, lambda s: dot(self.tip(s, 2), self.tip(s, 3)), between(low, high))
        return float(size(np.array([low, high, *flat])).max())

    def extremes(self, order: int) -> list[dict[str, float]]:
        """Smallest and largest speed (order 1) or acceleration (2) relative to the machine."""

        def size(s: Any) -> Any:
            return np.abs(self.tip(s, order))

        def slope(s: Any) -> Any:
            return dot(self.tip(s, order), self.tip(s, order + 1))

        flat, actual = flats(size, slope, between(0, TURN)), []
        for s in (flat[0], flat[-1]):
            there = vector(self.tip(s, order) * self.case.omega**order)
            keep = {"value": there["size"], "crank_angle": wrap(s)}
            actual.append(keep | {"direction": there["direction"]})
        return actual

    def ratio(self, which: int) -> dict[str, float]:
        """Extremes of the angular speed of the coupler (0) or rocker (1), by that of the crank."""
        if isinstance(self.case, Trochoid):
            return {}
        links = self.case.links
        arm = Series(lambda s: links(s)[which])

        def ratio(s: Any) -> Any:
            return cross(arm(s), arm(s, 1))

        flat = flats(ratio, lambda s: cross(arm(s), arm(s, 2)), between(0, TURN))
        actual = {"min": float(ratio(flat[0])), "max": float(ratio(flat[-1]))}
        return actual | {"min_at": wrap(flat[0]), "max_at": wrap(flat[-1])}

    def loop(self, low: float, high: float) -> dict[str, float]:
        """A loop of the ground path, from one pass through its crossing to the next."""
        node, (first, second) = self.ground.at(low), self.in_time(low, high)
        swept = integral(lambda s: cross(self.ground.at(s) - node, self.ground.rate(s)), low, high)
        return {
            "first": wrap(first),
            "second": wrap(second),
            "y": float(node.imag),
            "area": abs(swept) / 2,
            "height": self.ground.extent(np.imag, low, high),
            "width": self.ground.extent(np.real, low, high),
            "duration": high - low,
        }


def vector(value: Any) -> dict[str, float]:
    """Components, size and direction of a vector."""
    parts = {"x": float(value.real), "y": float(value.imag), "size": float(abs(value))}
    return parts | {"direction": direction(value)}


def flatten(nested: dict[str, Any], prefix: str = "") -> dict[str, Any]:
    """One dictionary with dotted names."""
    flat: dict[str, Any] = {}
    for name, value in nested.items():
        inner = flatten(value, f"{prefix}{name}.") if isinstance(value, dict) else None
        flat |= {prefix + name: value} if inner is None else inner
    return flat


@cache
def planter(case: Case | Trochoid) -> Planter:
    return Planter(case)


@cache
def figures(case: Case | Trochoid) -> dict[str, Any]:
    """All figures under dotted names, SI units, crank angles in [0, 2 pi)."""
    p = planter(case)
    entry, exit_ = p.in_time(*p.visits[0])
    return flatten(
        {
            "curve": {
                "height": p.curve.extent(np.imag, 0, TURN),
                "width": p.curve.extent(np.real, 0, TURN),
                "length": p.curve.length(0, TURN),
                "smallest_radius": p.curve.smallest_radius(),
            },
            "lowest": p.station(p.lowest),
            "highest": p.station(p.highest),
            "entry": p.station(entry),
            "exit": p.station(exit_),
            "visits": [tuple(map(wrap, p.in_time(*visit))) for visit in p.visits],
            "soil": p.soil(),
            **dict(zip(("min_speed", "max_speed"), p.extremes(1), strict=True)),
            **dict(zip(("min_acceleration", "max_acceleration"), p.extremes(2), strict=True)),
            "ratio": {"coupler": p.ratio(0), "rocker": p.ratio(1)},
            "ground": {"smallest_radius": p.ground.smallest_radius()},
            "loops": sorted(
                (p.loop(*crossing) for crossing in p.ground.crossings()),
                key=lambda loop: loop["first"],
            ),
            "cusps": p.ground.cusps,
        }
    )
