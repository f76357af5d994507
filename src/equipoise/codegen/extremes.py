"""Extremes of the values that a loop keeps, in a form that Numba compiles.

They are those of `signals.smooth_tops` and of `JumpSampling.tops`, which NumPy finds for many
signals at once: here each signal of each design by itself, which is many times as fast for the few
hundred values that a loop keeps.  `kernel_text` writes the functions out with their constants, so
that the name of the compiled file depends on both.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable, Sequence
from math import pi
from typing import Any, Final, Protocol, final

import numpy as np

from equipoise.codegen.figures import TOPS, Gathered
from equipoise.dataclass import dataclass
from equipoise.signals import (
    BESIDE_TOP,
    EQUAL,
    GAUSS_POINTS,
    LIFT,
    NEWTON_STEPS,
    ROUGH,
    ROUNDING,
    STEPS,
    TAIL,
    TO_POWERS,
    Array,
    JumpSampling,
    Tops,
    panel_series,
    smooth_tops,
    within_period,
)

ExtremesKernel = Callable[..., Any]

WIDTH: Final = len(STEPS)
SLOPES: Final = np.arange(WIDTH) * TO_POWERS[BESIDE_TOP:]
"""Factors of values from the middle of a stencil on in the powers of its polynomial's slope."""
INVERSE: Final = np.append(0.0, 1 / np.arange(1.0, WIDTH))
CLENSHAW: Final = np.array(
    [[(2 * k + 1) / (k + 1), (k + 1) / (k + 2)] for k in range(GAUSS_POINTS)]
).T
"""Factors of Clenshaw's recurrence of Legendre polynomials."""
_, NODES, TO_SERIES, PLACES, TO_PLACES = panel_series()
SIGNATURES: Final = {
    "grid_extremes": "void(float64[:, :, ::1], float64[:, ::1], int64[:, ::1], float64, float64)",
    "panel_extremes": "void(float64[:, :, ::1], float64[:, ::1], int64[:, ::1], float64[::1], "
    "float64[::1], float64)",
}
"""Types of the arguments of the functions that are called from outside."""


class CurveTops(Protocol):
    """Finds extremes of curves through values at the crank angles of one grid."""

    def __call__(self, values: Array) -> Tops:
        """Highest values of signals (M, N) and their crank angles, by NumPy."""

    def in_order(self, values: Array) -> Array:
        """Values (M, N) by rising crank angle in the order in which they are asked for."""

    def kernel(self, count: int) -> str:
        """Name of the compiled function for so many crank angles; empty where NumPy has to do."""

    def arguments(self) -> tuple[Any, ...]:
        """What that function is given after values, what it fills, and the columns of that."""


@final
@dataclass(frozen=True)
class GridTops:
    """Of crank angles that are equally spaced over a period from the first on, rad."""

    period: float
    first: float = 0.0

    def __call__(self, values: Array) -> Tops:
        top, at = smooth_tops(self.period, values)
        return top, within_period(at + self.first, self.period)

    def in_order(self, values: Array) -> Array:
        return values

    def kernel(self, count: int) -> str:
        """None for fewer values than a polynomial goes through."""
        return "grid_extremes" if count >= WIDTH else ""

    def arguments(self) -> tuple[float, float]:
        return self.period, self.first


@final
@dataclass(frozen=True, eq=False)
class PanelTops:
    """Of the crank angles of a sampling that resolves jumps: those shown, then those inside."""

    sampling: JumpSampling

    @property
    def order(self) -> Array:
        """Places (N,) in the sampling of values as they are kept."""
        return np.concatenate([self.sampling.curve_places, self.sampling.inside])

    def __call__(self, values: Array) -> Tops:
        ordered = np.empty_like(values)
        ordered[:, self.order] = values
        return self.sampling.tops(ordered)

    def in_order(self, values: Array) -> Array:
        return np.asarray(values[:, self.order])

    def kernel(self, count: int) -> str:
        return "panel_extremes"

    def arguments(self) -> tuple[Any, ...]:
        of = self.sampling
        return of.at[of.curve_places], of.edges, 2 * pi * of.turns


def columns_of(gathered: Gathered) -> Array:
    """Columns (S, 6) of the samples' extremes, of each signal: highest and lowest sample, top and
    its place, dip and its place; -1 for what is not wanted.
    """
    places = {column: k for k, column in enumerate(gathered.columns)}
    kinds = ("highest", "lowest", *TOPS)
    rows = [[places.get((signal, kind), -1) for kind in kinds] for signal in gathered.sampled]
    return np.array(rows, dtype=np.int64).reshape(-1, len(kinds))


# -- compiled functions: scalars, loops and NumPy's simplest alone ---------------------------------


def larger(a: float, b: float) -> float:
    """The larger of two numbers; compiled, an instruction that takes several at once."""
    return a if a > b else b


def smaller(a: float, b: float) -> float:
    """The smaller of two numbers, compiled likewise."""
    return a if a < b else b


def top_of_stencil(values: Array, slopes: Array) -> tuple[float, float, float]:
    """Top of the polynomial through nine values, steps to it from the middle, and roughness, as
    `signals._tops_of_stencils`; it takes values on both sides together, as powers are even or odd.

    slopes : (9,) to work with.
    """
    middle = values[BESIDE_TOP]
    second, sixth = 0.0, 0.0
    for k in range(WIDTH - 2):
        second = max(second, abs(values[k] - 2 * values[k + 1] + values[k + 2]))
    for k in range(WIDTH - 6):
        ends = values[k] + values[k + 6] - 6 * (values[k + 1] + values[k + 5])
        inner = 15 * (values[k + 2] + values[k + 4]) - 20 * values[k + 3]
        sixth = max(sixth, abs(ends + inner))
    rough = sixth / (ROUGH * second)
    if not rough <= 1:
        return middle, 0.0, rough
    slopes[:] = 0.0
    for j in range(1, BESIDE_TOP + 1):
        later, earlier = values[BESIDE_TOP + j] - middle, values[BESIDE_TOP - j] - middle
        even, odd = later + earlier, later - earlier
        for power in range(1, WIDTH, 2):
            slopes[power] += SLOPES[j, power] * odd
            slopes[power + 1] += SLOPES[j, power + 1] * even
    move = 0.0
    for _ in range(NEWTON_STEPS + 1):
        slope, bend = slopes[WIDTH - 1], 0.0
        for power in range(WIDTH - 2, 0, -1):
            bend = bend * move + slope
            slope = slope * move + slopes[power]
        move = min(max(move - slope / bend, -1.0), 1.0)
    gain = 0.0
    for power in range(WIDTH - 1, 0, -1):
        gain = gain * move + slopes[power] * INVERSE[power]
    gain *= move
    if gain > 0:
        return middle + gain, move, rough
    return middle, 0.0, rough


def smoothest_top(values: Array, squares: Array, slopes: Array) -> tuple[float, float]:
    """Top of a curve through nine values, and steps to it; of values below zero through their
    squares where these are smoother.
    """
    top, move, rough = top_of_stencil(values, slopes)
    for k in range(WIDTH):
        if values[k] > 0:
            return top, move
        squares[k] = -values[k] * values[k]
    squared, other, roughness = top_of_stencil(squares, slopes)
    if roughness < 1 and not roughness >= rough:
        return -np.sqrt(max(-squared, 0.0)), other
    return top, move


def tops_on_grid(
    values: Array, sign: float, high: float, limits: Array, tops: Array, work: Array
) -> tuple[float, int]:
    """Highest value of a curve through `sign` times values (N,), and how many local tops are filled
    in: in the rows of `tops` (2, N) what is there, and at how many steps.

    limits : of samples that may be below the top; of rounding; and of the difference of equal tops.
    work : (3, 9) to work with.
    """
    count = len(values)
    stencil, squares, slopes = work[0], work[1], work[2]
    best, tops_filled = high, 0
    for k in range(count):
        value = sign * values[k]
        if value < limits[0]:
            continue
        before = sign * values[k - 1 if k else count - 1]
        after = sign * values[k + 1 if k + 1 < count else 0]
        if value < before or value < after:
            continue
        drop = value - min(before, after)
        if value + drop < best - limits[2]:  # more than a curve that is smooth rises above it
            continue
        tops[0, tops_filled], tops[1, tops_filled] = value, k
        if drop > limits[1]:
            for j in range(WIDTH):
                place = k + j - BESIDE_TOP
                if place < 0:
                    place += count
                elif place >= count:
                    place -= count
                stencil[j] = sign * values[place]
            top, move = smoothest_top(stencil, squares, slopes)
            if top > value + limits[1]:
                tops[0, tops_filled], tops[1, tops_filled] = top, k + move
                best = max(best, top)
        tops_filled += 1
    return best, tops_filled


def grid_extremes(samples: Array, out: Array, columns: Array, period: float, first: float) -> None:
    """Fill columns of what is gathered (P, R) from samples (P, S, N), equally spaced over a period
    from the first crank angle on, as `signals.smooth_tops`.
    """
    count = samples.shape[2]
    tops, work, limits = np.empty((2, count)), np.empty((3, WIDTH)), np.empty(3)
    for i in range(out.shape[0]):
        for s in range(columns.shape[0]):
            highest, lowest = out[i, columns[s, 0]], out[i, columns[s, 1]]
            span = highest - lowest
            rounding = ROUNDING * max(abs(highest), abs(lowest))
            slack = max(EQUAL * span, rounding)
            for side in range(2):
                value_column, place_column = columns[s, 2 + 2 * side], columns[s, 3 + 2 * side]
                if value_column < 0:
                    continue
                sign, high = (-1.0, -lowest) if side else (1.0, highest)
                best, tops_filled, step = high, 0, 0.0
                if span > rounding:
                    limits[0], limits[1], limits[2] = (
                        high - max(slack, LIFT * span),
                        rounding,
                        slack,
                    )
                    best, tops_filled = tops_on_grid(samples[i, s], sign, high, limits, tops, work)
                for k in range(tops_filled):
                    if tops[0, k] >= best - slack:
                        step = tops[1, k]
                        break
                out[i, value_column] = sign * best
                if place_column >= 0:
                    angle = inside_period(step * (period / count), period)
                    out[i, place_column] = inside_period(angle + first, period)


def inside_period(angle: float, period: float) -> float:
    """An angle from 0 to less than the period, as `signals.within_period`."""
    inside = angle % period
    return 0.0 if inside > period * (1 - ROUNDING) else inside


def legendre_value(series: Array, x: float) -> float:
    """Value of a series of Legendre polynomials at x, by Clenshaw's recurrence."""
    last, value = 0.0, 0.0
    for k in range(len(series) - 1, 0, -1):
        next_value = series[k] + CLENSHAW[0, k] * x * value - CLENSHAW[1, k] * last
        value, last = next_value, value
    result: float = series[0] + x * value - last / 2
    return result


def legendre_slope(series: Array, slope: Array) -> None:
    """Fill the series (n,) of the derivative of another (n,)."""
    count = len(series)
    slope[count - 1] = 0.0
    above, other = 0.0, 0.0
    for k in range(count - 2, -1, -1):
        above, other = other + series[k + 1], above
        slope[k] = (2 * k + 1) * above


def roughness_of_panel(values: Array, series: Array) -> tuple[float, float]:
    """Roughness of the curve through values at the Gauss points of a panel, and what is rounding of
    it; fills its series of Legendre polynomials.
    """
    series[:] = 0.0
    for j in range(GAUSS_POINTS):
        for k in range(GAUSS_POINTS):
            series[k] += values[j] * TO_SERIES[j, k]
    tail, whole = 0.0, 0.0
    for k in range(1, GAUSS_POINTS):
        whole = max(whole, abs(series[k]))
        if k >= GAUSS_POINTS - 3:
            tail = max(tail, abs(series[k]))
    rounding = ROUNDING * max(whole, abs(series[0]))
    return 0.0 if tail <= rounding else tail / (TAIL * whole), rounding


def top_of_panel(
    values: Array, least: float, work: Array, dense: Array
) -> tuple[float, float, float]:
    """Highest value, and where it is from -1 to 1, of the curve through values at the Gauss points
    of a panel, and roughness, as `signals._tops_of_panels`; less exactly where it is below `least`.

    work, dense : (3, 16) and (33,) to work with.
    """
    series, slope, bend = work[0], work[1], work[2]
    rough, rounding = roughness_of_panel(values, series)
    if not rough <= 1:
        place = int(np.argmax(values))
        return values[place], NODES[place], rough
    dense[:] = 0.0
    for j in range(GAUSS_POINTS):
        for k in range(len(PLACES)):
            dense[k] += series[j] * TO_PLACES[j, k]
    place = int(np.argmax(dense))
    before, after = max(place - 1, 0), min(place + 1, len(PLACES) - 1)
    if 2 * dense[place] - min(dense[before], dense[after]) < least:
        return dense[place], PLACES[place], rough
    low, high = PLACES[before], PLACES[after]
    legendre_slope(series, slope)
    legendre_slope(slope, bend)
    x = PLACES[place]
    for _ in range(NEWTON_STEPS):
        curve = legendre_value(bend, x)
        if curve < 0:
            x -= legendre_value(slope, x) / curve
        x = min(max(x, low), high)
    value = legendre_value(series, x)
    if value > dense[place] + rounding:
        return value, x, rough
    return dense[place], PLACES[place], rough


def tops_of_sampling(
    values: Array, sign: float, limits: Array, highest: Array, tops: Array, work: Array,
    dense: Array,
) -> tuple[float, int]:  # fmt: skip
    """Highest value of the curves of panels, and how many of these come up to what is enough; fills
    rows of `tops` (3, P) with their tops, places of these from -1 to 1, and numbers of panels.

    limits : highest sample; what is enough; by how much equal tops differ.
    highest : (2, P), the highest value of each panel, and the highest of the opposite ones.
    """
    stencil, squares, best, tops_filled = work[3], work[4], limits[0], 0
    for k in range(highest.shape[1]):
        high, low = highest[0, k], -highest[1, k]
        if sign < 0:
            high, low = -low, -high
        if high < limits[1] or 0 < high < best - limits[2] - LIFT * (high - low):
            continue
        for j in range(GAUSS_POINTS):
            stencil[j] = sign * values[GAUSS_POINTS * k + j]
        if high <= 0:
            top, x, rough = top_of_panel(stencil, -np.inf, work, dense)
            for j in range(GAUSS_POINTS):
                squares[j] = -stencil[j] * stencil[j]
            squared, other, roughness = top_of_panel(squares, -np.inf, work, dense)
            if roughness < 1 and not roughness >= rough:
                top, x = -np.sqrt(max(-squared, 0.0)), other
        else:
            top, x, _ = top_of_panel(stencil, best - limits[2], work, dense)
        best = max(best, top)
        tops[0, tops_filled], tops[1, tops_filled], tops[2, tops_filled] = top, x, k
        tops_filled += 1
    return best, tops_filled


def range_of(values: Array) -> tuple[float, float]:
    """Highest and lowest of values."""
    high, low = -np.inf, np.inf
    for value in values:
        high, low = larger(high, value), smaller(low, value)
    return high, low


def place_of_sample(values: Array, sign: float, high: float, low: float) -> int:
    """Place of the highest of `sign` times values, as of `signals.highest_at`."""
    rounding = ROUNDING * max(abs(high), abs(low))
    enough = high - max(EQUAL * (high - low), rounding)
    count = len(values)
    for k in range(count):
        value = sign * values[k]
        if value >= enough:
            before = sign * values[k - 1] if k else -np.inf
            after = sign * values[k + 1] if k + 1 < count else -np.inf
            if value >= max(before, after) - rounding or high - low <= rounding:
                return k
    return 0


def panel_extremes(
    samples: Array, out: Array, columns: Array, at: Array, edges: Array, period: float
) -> None:
    """Fill columns of what is gathered (P, R) from samples (P, S, M + 16 K) of a sampling that
    resolves jumps, as `JumpSampling.tops`: first those shown, at crank angles (M,), rad, then those
    of the panels between edges (K + 1,), rad.
    """
    panels, count = len(edges) - 1, len(at)
    highest, tops, work = np.empty((2, panels)), np.empty((3, panels)), np.empty((5, GAUSS_POINTS))
    dense, limits = np.empty(len(PLACES)), np.empty(3)
    for i in range(out.shape[0]):
        for s in range(columns.shape[0]):
            values, inside = samples[i, s, :count], samples[i, s, count:]
            span = out[i, columns[s, 0]] - out[i, columns[s, 1]]
            most, least = range_of(values)
            for k in range(panels):
                high, low = range_of(inside[GAUSS_POINTS * k : GAUSS_POINTS * (k + 1)])
                highest[0, k], highest[1, k] = high, -low
            for side in range(2):
                value_column, place_column = columns[s, 2 + 2 * side], columns[s, 3 + 2 * side]
                if value_column < 0:
                    continue
                sign, high, low = (-1.0, -least, -most) if side else (1.0, most, least)
                slack = max(EQUAL * span, ROUNDING * abs(high))
                limits[0], limits[1], limits[2] = high, high - LIFT * span, slack
                best, tops_filled = tops_of_sampling(
                    inside, sign, limits, highest, tops, work, dense
                )
                out[i, value_column] = sign * best
                if place_column >= 0:
                    place, slack = np.inf, max(EQUAL * span, ROUNDING * abs(best))
                    if high >= best - slack:
                        place = at[place_of_sample(values, sign, high, low)]
                    for k in range(tops_filled):
                        if tops[0, k] >= best - slack:
                            begin, end = edges[int(tops[2, k])], edges[int(tops[2, k]) + 1]
                            angle = (begin + end) / 2 + (end - begin) / 2 * tops[1, k]
                            place = min(place, inside_period(angle, period))
                    out[i, place_column] = place


# -- their text ------------------------------------------------------------------------------------

HELPERS: Final[Sequence[ExtremesKernel]] = (
    top_of_stencil,
    smoothest_top,
    tops_on_grid,
    inside_period,
    legendre_value,
    legendre_slope,
    roughness_of_panel,
    top_of_panel,
    tops_of_sampling,
    range_of,
    place_of_sample,
)
KERNELS: Final[Sequence[ExtremesKernel]] = (grid_extremes, panel_extremes)
NUMBERS: Final = (
    "BESIDE_TOP", "EQUAL", "GAUSS_POINTS", "LIFT", "NEWTON_STEPS", "ROUGH", "ROUNDING", "TAIL",
    "WIDTH", "SLOPES", "INVERSE", "CLENSHAW",
    "NODES", "TO_SERIES", "PLACES", "TO_PLACES",
)  # fmt: skip
"""Names of the constants of these functions."""


def kernel_text() -> str:
    """Source of a module of the functions above, with their constants."""
    known = globals()
    lines = ["from __future__ import annotations", "", "import numpy as np", ""]
    for name in NUMBERS:
        value = known[name]
        text = f"np.array({value.tolist()!r})" if isinstance(value, np.ndarray) else repr(value)
        lines.append(f"{name} = {text}")
    functions = (inspect.getsource(item) for item in (*HELPERS, *KERNELS))
    return "\n".join([*lines, "", "Array = np.ndarray", "", *functions])
