"""Cone programs, a linear cost over second-order cones, and their solution by Clarabel.

    minimise c'x  so that  factors x + constant  lies in a cone, block by block

with cones zero, nonnegative and second-order (first row >= length of the others).  Their duals z
are the price of every constant: the value falls by z for a unit more of it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import field, replace
from functools import cached_property
from typing import Any, ClassVar, Literal

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.errors import EquipoiseError
from equipoise.i18n import Note, to_say
from equipoise.limits import check_room
from equipoise.signals import Array, stencils_above

Cone = Literal["zero", "nonnegative", "second-order"]
Status = Literal["solved", "almost solved", "infeasible", "stalled"]

TOLERANCES = (1e-9, 1e-8)
"""Relative to cost and constraints."""
STRIDE, BROKEN, MOST_ROUNDS = 12, 3e-9, 30
"""Of the rows of a cycle with which a program starts; by how much a row may be broken; how often
rows are added."""
ENTRY = 120
"""Bytes that Clarabel takes for each entry of the matrix: 75 to 90 were measured."""


@dataclass(frozen=True)
class ConeSolution:
    """What Clarabel came to.

    x (N,), z (M,) : solution, and duals of the rows.  reason : Clarabel's own word for the end.
    value, dual_value : of the cost; between them lies the true minimum.
    """

    status: Status
    reason: str
    x: Array
    z: Array
    value: float
    dual_value: float


def solve_cones(
    cost: Array, matrix: Any, right: Array, cones: Sequence[tuple[Cone, int]], tolerance: float
) -> ConeSolution:
    """Minimise cost (N,) with matrix (M, N), SciPy CSC, right (M,) and cones of M rows, so that
    matrix x + s = right with s in the cones.

    tolerance : relative to cost and constraints.

    Raises
    ------
    UsageError : memory is not enough, without which Clarabel aborts the process.
    """
    import clarabel
    from scipy import sparse

    kinds = {
        "zero": clarabel.ZeroConeT,
        "nonnegative": clarabel.NonnegativeConeT,
        "second-order": clarabel.SecondOrderConeT,
    }
    settings = clarabel.DefaultSettings()
    settings.verbose, settings.max_threads = False, 1
    settings.tol_gap_abs = settings.tol_gap_rel = settings.tol_feas = tolerance
    program = to_say("a cone program of {rows} rows and {columns} numbers")
    needed = ENTRY * matrix.nnz + 8 * len(cost) ** 2
    check_room(needed, Note(program, rows=len(right), columns=len(cost)))
    nothing = sparse.csc_matrix((len(cost), len(cost)))
    cone_types = [kinds[kind](size) for kind, size in cones]
    end = clarabel.DefaultSolver(nothing, cost, matrix, right, cone_types, settings).solve()
    reason = str(end.status)
    status: Status = "stalled"
    if "Infeasible" in reason:
        status = "infeasible"
    elif reason in ("Solved", "AlmostSolved"):
        status = "solved" if reason == "Solved" else "almost solved"
    x, z = np.array(end.x), np.array(end.z)
    return ConeSolution(status, reason, x, z, end.obj_val, end.obj_val_dual)


Cutter = Callable[[Array], "list[ConeRows]"]


class NoSolutionError(EquipoiseError):
    """No numbers meet the constraints."""


class StalledError(NoSolutionError):
    """The solver came to no result."""


@dataclass(frozen=True, eq=False)
class Affine:
    """Rows factors @ x[columns] + constant; factors (R, C), columns (C,), constant (R,).

    The factors of many rows may be a sparse matrix.
    """

    factors: Any
    columns: Array
    constant: Array

    def at(self, x: Array) -> Array:
        """Values (R,) of the rows for numbers x."""
        return np.asarray(self.factors @ x[self.columns] + self.constant)

    @cached_property
    def entries(self) -> tuple[Array, Array, Array]:
        """Rows, numbers and values of the factors that are not 0."""
        if isinstance(self.factors, np.ndarray):
            row, column = np.nonzero(self.factors)
            return row, self.columns[column], self.factors[row, column]
        tocoo = self.factors.tocoo()
        return tocoo.row, self.columns[tocoo.col], tocoo.data

    def of_rows(self, places: Array) -> Affine:
        """Some of the rows."""
        return Affine(self.factors[places], self.columns, self.constant[places])

    def weighted(self, places: Array, weights: Array) -> Affine:
        """Sums (K S,) of rows at places (K, n, S), with weights (K, n)."""
        factors = np.einsum("knsc,kn->ksc", self.factors[places], weights)
        constant = np.einsum("kns,kn->ks", self.constant[places], weights)
        count = constant.size
        return Affine(factors.reshape(count, self.factors.shape[1]), self.columns, constant.ravel())

    __array_ufunc__: ClassVar[None] = None  # NumPy's numbers leave arithmetic to this class

    def __add__(self, other: Affine) -> Affine:
        """Row by row; one of both may be a single row."""
        both = [self.factors, other.factors]
        if len(self.constant) != len(other.constant):
            count = max(len(self.constant), len(other.constant))
            both = [np.broadcast_to(item, (count, item.shape[1])) for item in both]
        columns = np.concatenate([self.columns, other.columns])
        return Affine(np.concatenate(both, axis=1), columns, self.constant + other.constant)

    def __mul__(self, factor: float) -> Affine:
        return Affine(factor * self.factors, self.columns, factor * self.constant)

    __rmul__ = __mul__

    def __sub__(self, other: Affine) -> Affine:
        return self + (-1.0) * other

    @classmethod
    def fixed(cls, values: Any) -> Affine:
        """Rows (R,) without numbers; a single one of a number."""
        constant = np.atleast_1d(np.asarray(values, dtype=float))
        return cls(np.zeros((len(constant), 0)), np.zeros(0, int), constant)

    @classmethod
    def of(cls, columns: Any, factors: Any, constant: Any = 0.0) -> Affine:
        """From one row or many; a constant is spread over the rows."""
        factors = np.atleast_2d(np.asarray(factors, dtype=float))
        spread = np.broadcast_to(np.asarray(constant, dtype=float), (len(factors),))
        return cls(factors, np.atleast_1d(np.asarray(columns, dtype=int)), spread)


@dataclass(frozen=True, eq=False)
class ConeRows:
    """Rows that lie in a cone; second-order cones stand one after the other, `size` rows each.

    name : of the limit that it stands for.
    slope : its derivative by that limit, rows for rows.
    lift : place of the number that it keeps above a square, where it does that.
    local : name of what it cuts off near the last solution only; blocks of that name come and go.
    peaks : of how far each cone is broken (G,), round a cycle, and a value: tops of it above that,
        as places of cones and weights (K, n) of these.
    """

    cone: Cone
    rows: Affine
    size: int = 1
    name: str = ""
    slope: Affine | None = None
    lift: int | None = None
    local: str = ""
    peaks: Callable[[Array, float], tuple[Array, Array]] = stencils_above

    @property
    def groups(self) -> int:
        """How many cones, or single rows, there are."""
        return len(self.rows.constant) // self.size

    def of(self, groups: Array) -> ConeRows:
        """Some of the cones or rows."""
        places = (groups[:, None] * self.size + np.arange(self.size)).ravel()
        slope = None if self.slope is None else self.slope.of_rows(places)
        return replace(self, rows=self.rows.of_rows(places), slope=slope)

    def between(self, groups: Array, weights: Array) -> ConeRows:
        """Cones or rows that are weighted sums of others (K, n), as those between samples are."""
        places = groups[..., None] * self.size + np.arange(self.size)
        slope = None if self.slope is None else self.slope.weighted(places, weights)
        return replace(self, rows=self.rows.weighted(places, weights), slope=slope)

    def slack(self, x: Array) -> Array:
        """By how much each cone or row (G,) is kept; below 0 where it is broken."""
        values = self.rows.at(x).reshape(-1, self.size)
        return np.asarray(values[:, 0] - np.linalg.norm(values[:, 1:], axis=1))


@dataclass(frozen=True, eq=False)
class ProgramSolution:
    """Solution: x (n,), its value, a lower bound of it, and the price of each named limit.

    cuts : blocks that cut off earlier solutions which were not possible, a tuple a round; they hold
        for all programs whose cutters and waiting blocks are the same.
    """

    x: Array
    value: float
    bound: float
    prices: dict[str, float]
    cuts: tuple[tuple[ConeRows, ...], ...] = ()


@dataclass
class Program:
    """A program in the making: numbers, blocks of constraints on them, and the cost.

    waiting : blocks whose rows are taken in only where a solution breaks them.
    cutters : each returns blocks that cut off a solution which is not possible.
    tolerances : asked of the solver in turn, until it comes so near.
    """

    count: int = 0
    blocks: list[ConeRows] = field(default_factory=list)
    cost: dict[int, float] = field(default_factory=dict)
    waiting: list[ConeRows] = field(default_factory=list)
    cutters: list[Cutter] = field(default_factory=list)
    tolerances: tuple[float, ...] = TOLERANCES

    def numbers(self, count: int) -> Array:
        """Add free numbers; returns their places in x."""
        self.count += count
        return np.arange(self.count - count, self.count)

    def zero(self, rows: Affine) -> None:
        """Rows that must be 0."""
        self.blocks.append(ConeRows("zero", rows))

    def nonnegative(self, rows: Affine, name: str = "", slope: Affine | None = None) -> None:
        """Rows that must not be negative."""
        self.blocks.append(ConeRows("nonnegative", rows, 1, name, slope))

    def cones(self, rows: Affine, size: int, name: str = "", slope: Affine | None = None) -> None:
        """Groups of `size` rows, the first of which is at least the length of the others."""
        self.blocks.append(ConeRows("second-order", rows, size, name, slope))

    def add_lazy_rows(self, block: ConeRows) -> None:
        """A block of many rows round a cycle, few of which will matter, and those between them."""
        self.waiting.append(block)
        self.blocks.append(block.of(np.arange(0, block.groups, STRIDE)))

    def rotated(self, x: Affine, y: Affine, z: Affine, lift: int | None = None) -> None:
        """x y >= |z|^2 with x, y >= 0: one row each of x and y, any number of z."""
        rows = stacked(x + y, x - y, 2.0 * z)
        self.blocks.append(ConeRows("second-order", rows, len(rows.constant), lift=lift))

    def copy(self) -> Program:
        """To which more can be added without changing what this one asks."""
        return replace(
            self,
            blocks=list(self.blocks),
            cost=dict(self.cost),
            waiting=list(self.waiting),
            cutters=list(self.cutters),
        )

    def without(self, names: set[str]) -> Program:
        """The program without some of its named limits."""
        blocks_left, waiting = (
            [block for block in blocks if block.name not in names]
            for blocks in (self.blocks, self.waiting)
        )
        return replace(self, blocks=blocks_left, waiting=waiting, cost=dict(self.cost))

    def without_squares(self, lifts: set[int]) -> Program:
        """A copy in which some lifts are not kept above their squares."""
        copy = self.copy()
        copy.blocks = [block for block in copy.blocks if block.lift not in lifts]
        return copy

    @property
    def names(self) -> list[str]:
        """Named limits, each once."""
        return list(dict.fromkeys(block.name for block in self.blocks if block.name))

    def solve(self) -> ProgramSolution:
        """Solve; raises `NoSolutionError` where there is none.  The program stays as it is."""
        program, rounds = self.copy(), []
        solution = program._solve()
        for _ in range(MOST_ROUNDS):
            cuts = [*self._broken(solution.x)]
            cuts += [block for cutter in self.cutters for block in cutter(solution.x)]
            if not cuts:
                break
            rounds.append(tuple(cuts))
            program.add_cuts(rounds[-1:])
            try:
                again = program._solve()  # of less freedom, so that the bound before still holds
            except StalledError:  # constraints that hardly differ; what is broken is little
                break
            solution = replace(again, bound=max(solution.bound, again.bound))
        return replace(solution, cuts=tuple(rounds))

    def add_cuts(self, rounds: Iterable[tuple[ConeRows, ...]]) -> None:
        """Add cuts of a solution, so that the next one need not find them again; those that belong
        to a place take the place of the last of the same name.
        """
        for cuts in rounds:
            local = {block.local for block in cuts if block.local}
            self.blocks = [block for block in self.blocks if block.local not in local]
            self.blocks += cuts

    def _broken(self, x: Array) -> Iterator[ConeRows]:
        """Rows of the waiting blocks, and between them, that a solution breaks most, each among its
        neighbours.
        """
        for block in self.waiting:
            groups, weights = block.peaks(-block.slack(x), BROKEN)
            if len(groups):
                yield block.between(groups, weights)

    def _solve(self) -> ProgramSolution:
        matrix, right, cones = self._assembled()
        cost = np.zeros(self.count)
        for place, factor in self.cost.items():
            cost[place] += factor
        for tolerance in self.tolerances:
            solution = solve_cones(cost, matrix, right, cones, tolerance)
            if solution.status == "solved":
                break
            if solution.status == "infeasible":
                raise NoSolutionError(Note("the cone program is {reason}", reason=solution.reason))
        if solution.status == "stalled":
            raise StalledError(Note("the solver ended with {reason}", reason=solution.reason))
        bound = min(solution.value, solution.dual_value)
        prices = self._prices(solution.x, solution.z)
        return ProgramSolution(solution.x, solution.value, bound, prices)

    def feasible(self, stalled: bool = True) -> bool:
        """Whether any numbers meet the constraints.

        stalled : the answer where the solver comes to none.
        """
        try:
            replace(self.copy(), cost={}).solve()
        except StalledError:
            return stalled
        except NoSolutionError:
            return False
        return True

    def _assembled(self) -> tuple[Any, Array, list[tuple[Cone, int]]]:
        """Matrix, right-hand side and cones in the solver's form A x + s = b."""
        from scipy import sparse

        values, rows, columns, right = [], [], [], []
        cones: list[tuple[Cone, int]] = []
        start = 0
        for block in self.blocks:
            row, column, value = block.rows.entries
            count = len(block.rows.constant)
            values.append(-value)
            rows.append(row + start)
            columns.append(column)
            right.append(block.rows.constant)
            start += count
            if block.cone == "second-order":
                cones += [(block.cone, block.size)] * (count // block.size)
            else:
                cones.append((block.cone, count))
        places = (np.concatenate(rows), np.concatenate(columns))
        shape = (start, self.count)
        matrix = sparse.csc_matrix((np.concatenate(values), places), shape=shape)
        return matrix, np.concatenate(right), cones

    def _prices(self, x: Array, dual: Array) -> dict[str, float]:
        """How much the value falls for a unit more of each named limit."""
        prices = dict.fromkeys(self.names, 0.0)
        start = 0
        for block in self.blocks:
            count = len(block.rows.constant)
            if block.name and block.slope is not None:
                prices[block.name] += float(dual[start : start + count] @ block.slope.at(x))
            start += count
        return prices


def stacked(*rows: Affine) -> Affine:
    """Rows one under the other."""
    columns = np.concatenate([part.columns for part in rows])
    constant = np.concatenate([part.constant for part in rows])
    factors, row, column = np.zeros((len(constant), len(columns))), 0, 0
    for part in rows:
        height, width = part.factors.shape
        factors[row : row + height, column : column + width] = part.factors
        row, column = row + height, column + width
    return Affine(factors, columns, constant)
