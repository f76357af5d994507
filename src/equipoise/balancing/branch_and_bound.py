"""The best numbers of all, where squares make a cone program not convex: branch and bound.

Over an interval of y / w a square lies below its chord, so that the program with y^2 / w <= lift <=
chord bounds the cost from below; with every ratio held where it was found, the program is exact and
bounds it from above.  Intervals are cut at the square of largest excess, until both meet.  Where
the first solution meets every square, it is the best already.
"""

from __future__ import annotations

import heapq
from collections.abc import Sequence
from dataclasses import replace
from functools import cached_property
from itertools import count
from math import inf, isfinite

import numpy as np

from equipoise.balancing.program import (
    Affine,
    NoSolutionError,
    Program,
    ProgramSolution,
    StalledError,
)
from equipoise.dataclass import dataclass
from equipoise.i18n import Note
from equipoise.results.result import ProgressCallback
from equipoise.signals import Array

EXACT_SQUARE = 1e-8
"""Of a square, scaled numbers, that is taken for rounding."""
CLOSE = 2e-9
"""Between the bounds, over the scale of the cost, at which the search ends."""
SHORTEST = 0.1
"""Share of an interval that each half of it has at least, as cuts at an end would not end it."""
MOST_NODES = 400
"""Programs that are solved at most: a few seconds; what is left open then stands in the gap."""
TANGENT_WIDTHS = (0.3, 0.1, 0.03, 0.01, 1e-3, 1e-4)
"""Over the interval: how far a ratio may go from where the square is replaced by its tangent."""
WIDE = 10.0
"""Half the first interval of a ratio without limits, over lengths of the machine."""


@dataclass(frozen=True)
class Square:
    """lift = y^2 / w, with y / w between `low` and `high`; numbers by place, w None for 1."""

    lift: int
    y: int
    w: int | None
    low: float
    high: float

    def ratio(self, x: Array) -> float:
        """y / w, 0 where there is no w."""
        w = 1.0 if self.w is None else float(x[self.w])
        return min(max(float(x[self.y]) / w, self.low), self.high) if w > 0 else 0.0

    def excess(self, x: Array) -> float:
        """Excess of the lift over y^2 / w; 0 below."""
        w = 1.0 if self.w is None else float(x[self.w])
        return max(0.0, float(x[self.lift]) - (float(x[self.y]) ** 2 / w if w > 0 else 0.0))

    def keep_above(self, program: Program) -> None:
        """lift w >= y^2."""
        program.rotated(*self._rows, self.lift)

    def keep_between(self, program: Program, low: float, high: float) -> None:
        """y / w in the interval, and the lift below the chord over it."""
        lift, w, y = self._rows
        for limit, sign in ((low, 1.0), (high, -1.0)):
            if abs(limit) < inf:
                program.nonnegative(sign * y - sign * limit * w)
        if high - low < inf:
            program.nonnegative((low + high) * y - low * high * w - lift)

    def keep_at(self, program: Program, ratio: float) -> None:
        """y / w at a ratio, and the lift with it."""
        lift, w, y = self._rows
        program.zero(y - ratio * w)
        program.zero(lift - ratio**2 * w)

    def keep_tangent(self, program: Program, ratio: float, width: float) -> None:
        """y / w near a ratio, and the lift on the tangent there."""
        lift, w, y = self._rows
        program.zero(lift - 2 * ratio * y + ratio**2 * w)
        for sign in (1.0, -1.0):
            program.nonnegative(sign * y + (width - sign * ratio) * w)

    @cached_property
    def _rows(self) -> tuple[Affine, Affine, Affine]:
        """lift, w and y."""
        w = Affine.fixed(1.0) if self.w is None else Affine.of(self.w, 1.0)
        return Affine.of(self.lift, 1.0), w, Affine.of(self.y, 1.0)


@dataclass(frozen=True, eq=False)
class ProvedSolution:
    """The best numbers that were found: x, its value, a proved lower bound, prices of limits.

    program : whose solution x is, with every square that matters held exactly.
    nodes : intervals that were looked at.
    """

    x: Array
    value: float
    bound: float
    prices: dict[str, float]
    program: Program
    nodes: int


@dataclass(frozen=True, eq=False)
class _Node:
    """Intervals of the squares' ratios, and the solution of the program over them."""

    intervals: tuple[tuple[float, float], ...]
    solved: ProgramSolution


def minimise(
    program: Program,
    squares: Sequence[Square],
    scale: float = 1.0,
    progress: ProgressCallback | None = None,
    above: float = inf,
    most: int = MOST_NODES,
) -> ProvedSolution:
    """The least cost.

    Parameters
    ----------
    squares : those whose lifts change the cost or a limit; the program keeps them above already.
    scale : of the cost.
    above : a cost that has been reached already; a problem whose bound lies above is not looked
        into, and its bound returned as if it were its cost.
    most : programs that are solved at most once there is a solution.

    Raises
    ------
    NoSolutionError : the constraints cannot be met.
    """
    return _Search(program, squares, scale).run(progress, above, most)


class _Search:
    def __init__(self, program: Program, squares: Sequence[Square], scale: float) -> None:
        self.program, self.squares = program, squares
        self.scale = scale
        self.best: ProvedSolution | None = None
        self.nodes = 0
        self.lost = inf  # the least bound of intervals that could not be looked into

    def run(self, progress: ProgressCallback | None, above: float, most: int) -> ProvedSolution:
        self.nodes += 1
        intervals = tuple((square.low, square.high) for square in self.squares)
        root = _Node(intervals, self._solved(self.program))  # which keeps to the intervals already
        exact = all(square.excess(root.solved.x) < EXACT_SQUARE for square in self.squares)
        if exact or root.solved.bound > above:
            return self._as_best(root.solved, self.program, root.solved.bound)
        if any(not isfinite(s.high - s.low) for s in self.squares):
            root = self._node(tuple(finite(s) for s in self.squares))
        order = count()
        waiting = [(root.solved.bound, next(order), root)]
        bound = root.solved.bound
        while waiting and self.nodes < (MOST_NODES if self.best is None else most):
            bound = waiting[0][0]
            if self._closed(bound):
                break
            _, _, node = heapq.heappop(waiting)
            self._try(node)
            for intervals in self._halves(node):
                try:
                    half = self._node(intervals)
                except StalledError:
                    self.lost = min(self.lost, node.solved.bound)
                    continue
                except NoSolutionError:
                    continue
                if not self._closed(half.solved.bound):
                    heapq.heappush(waiting, (half.solved.bound, next(order), half))
            if progress is not None:
                progress(self.nodes, MOST_NODES)
        if self.best is None:
            raise NoSolutionError(Note("no numbers were found that meet every limit"))
        if not waiting:  # every other interval is worse than the best by less than the resolution
            bound = self.best.value - CLOSE * self.scale
        bound = min(self.best.value, self.lost, max(bound, root.solved.bound))
        prices = self._prices(self.best)
        return replace(self.best, bound=bound, prices=prices, nodes=self.nodes)

    def _closed(self, bound: float) -> bool:
        return self.best is not None and bound > self.best.value - CLOSE * self.scale

    def _node(self, intervals: tuple[tuple[float, float], ...]) -> _Node:
        self.nodes += 1
        program = self.program.copy()
        for square, (low, high) in zip(self.squares, intervals, strict=True):
            square.keep_between(program, low, high)
        return _Node(intervals, self._solved(program))

    def _solved(self, program: Program) -> ProgramSolution:
        """Solve a program made of the common one; both keep what cut off impossible solutions."""
        solved = program.solve()
        program.add_cuts(solved.cuts)
        if program is not self.program:
            self.program.add_cuts(solved.cuts)
        return solved

    def _as_best(self, solved: ProgramSolution, program: Program, bound: float) -> ProvedSolution:
        return ProvedSolution(solved.x, solved.value, bound, solved.prices, program, self.nodes)

    def _try(self, node: _Node) -> None:
        """Look for a better solution from where a node's lies."""
        ratios = self._ratios(node.solved.x)
        self._hold(ratios)
        for width in TANGENT_WIDTHS:
            try:
                moved = self._ratios(self._solved(self._tangent(ratios, width)).x)
            except NoSolutionError:
                return
            if self._hold(moved):
                ratios = moved

    def _ratios(self, x: Array) -> list[float]:
        return [square.ratio(x) for square in self.squares]

    def _hold(self, ratios: list[float]) -> bool:
        """Solve with the ratios held; whether that is better than the best so far."""
        program = self.program.copy()
        for square, ratio in zip(self.squares, ratios, strict=True):
            square.keep_at(program, ratio)
        try:
            solved = self._solved(program)
        except NoSolutionError:
            return False
        if self.best is not None and solved.value >= self.best.value:
            return False
        self.best = self._as_best(solved, program, -inf)
        return True

    def _tangent(self, ratios: list[float], width: float) -> Program:
        """The program with every square replaced by its tangent at a ratio."""
        program = self.program.without_squares({square.lift for square in self.squares})
        for square, ratio in zip(self.squares, ratios, strict=True):
            low, high = finite(square)
            square.keep_tangent(program, ratio, width * (high - low))
        return program

    def _prices(self, best: ProvedSolution) -> dict[str, float]:
        """Prices where ratios are free to follow a limit, as they are not while they are held."""
        try:
            return self._tangent(self._ratios(best.x), TANGENT_WIDTHS[-1]).solve().prices
        except NoSolutionError:
            return best.prices

    def _halves(self, node: _Node) -> list[tuple[tuple[float, float], ...]]:
        """The node's intervals, with that cut in two whose square has the largest excess."""
        excess = [square.excess(node.solved.x) for square in self.squares]
        worst = int(np.argmax(excess))
        low, high = node.intervals[worst]
        middle, here = (low + high) / 2, self.squares[worst].ratio(node.solved.x)
        least = SHORTEST * (high - low)
        cut = min(max((middle + here) / 2, low + least), high - least)
        before, after = node.intervals[:worst], node.intervals[worst + 1 :]
        return [(*before, half, *after) for half in ((low, cut), (cut, high))]


def finite(square: Square) -> tuple[float, float]:
    """Ends of a square's ratio, of which there is one where it has none."""
    low = square.low if isfinite(square.low) else -WIDE
    high = square.high if isfinite(square.high) else WIDE
    return low, high
