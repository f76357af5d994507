"""Cone programs, a linear cost over second-order cones, and their solvers.

    minimise c'x  so that  A x + s = b,  s in a product of cones

Ours is a primal-dual interior-point method on the homogeneous self-dual embedding, with
Nesterov-Todd scaling and Mehrotra's corrector (Andersen, Roos, Terlaky, Math. Program. 95, 2003;
Domahidi, Chu, Boyd, ECOS, ECC 2013), in dense NumPy: for programs of some hundred numbers.

    minimise c'x  so that  factors x + constant  lies in a cone, block by block

with cones zero, nonnegative and second-order (first row >= length of the others).  Their duals z
are the price of every constant: the value falls by z for a unit more of it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import field, replace
from functools import cached_property
from typing import Any, ClassVar, Literal, Protocol

import numpy as np

from equipoise.balancing.rounding import TINY
from equipoise.dataclass import dataclass
from equipoise.errors import EquipoiseError
from equipoise.i18n import Note, to_say
from equipoise.limits import check_room
from equipoise.signals import Array, stencils_above

Kind = Literal["zero", "nonnegative", "second-order"]
Status = Literal["solved", "almost solved", "infeasible", "stalled"]

LOOSE = 1e-5
"""Relative accuracy with which a solution is still called almost solved."""
MOST_STEPS, STEP = 100, 0.99
"""Iterations, and the share of the way to the boundary of the cones that is gone in each."""
WORSE, STANDSTILL = 1e4, 1e-10
"""Times the least error, beyond which rounding has taken over; length of a step that is none."""
APART = 1e-2
"""tau over kappa, below which the homogeneous embedding certifies that there is no solution."""
ENTRY = 120
"""Bytes that Clarabel takes for each entry of the matrix: 75 to 90 were measured."""
ROUNDS, REFINEMENTS = 8, 2
"""Of scaling rows and columns; of each solution of the linear equations."""
REGULAR = 1e-13
"""Added to the diagonal, relative to its largest entry, so that numbers without effect stay put."""


@dataclass(frozen=True)
class ConeSolution:
    """What a solver came to.

    x (N,), z (M,) : solution, and duals of the rows.  reason : the solver's own word for the end.
    value, dual_value : of the cost; between them lies the true minimum.
    """

    status: Status
    reason: str
    x: Array
    z: Array
    value: float
    dual_value: float


class ConeSolver(Protocol):
    """Solves a cone program to a tolerance, relative to cost and constraints."""

    def __call__(
        self,
        cost: Array,
        matrix: Any,
        right: Array,
        cones: Sequence[tuple[Kind, int]],
        tolerance: float,
    ) -> ConeSolution:
        """Minimise cost (N,) with matrix (M, N), SciPy CSC, right (M,) and cones of M rows."""


def clarabel_solver(
    cost: Array, matrix: Any, right: Array, cones: Sequence[tuple[Kind, int]], tolerance: float
) -> ConeSolution:
    """Solve by Clarabel; arguments as of `ConeSolver`.

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


def interior_point_solver(
    cost: Array, matrix: Any, right: Array, cones: Sequence[tuple[Kind, int]], tolerance: float
) -> ConeSolution:
    """Solve by our own method; arguments as of `ConeSolver`."""
    with np.errstate(all="ignore"):  # a step that fails ends in numbers that are not finite
        return _Embedding(cost, matrix.toarray(), right, _Cones(cones), tolerance).solve()


def usual_solver() -> ConeSolver:
    """Return Clarabel's solver where it is installed, else our own."""
    try:
        import clarabel  # noqa: F401
    except ImportError:  # Python in a browser, where it may not have been published
        return interior_point_solver
    return clarabel_solver


class _Cones:
    """Products of nonnegative and second-order cones; rows of the zero cone are kept apart.

    The nonnegative cone is a second-order cone of one row, so all are groups (C, S) of C cones with
    S rows each.
    """

    def __init__(self, cones: Sequence[tuple[Kind, int]]) -> None:
        start = 0
        zero: list[Array] = []
        groups: dict[int, list[Array]] = {}
        for kind, size in cones:
            rows = np.arange(start, start + size)
            start += size
            if kind == "zero":
                zero.append(rows)
            elif kind == "nonnegative":
                groups.setdefault(1, []).extend(rows[:, None])
            else:
                groups.setdefault(size, []).append(rows)
        self.zero = np.concatenate([*zero, np.zeros(0, int)]).astype(int)
        self.groups = [np.stack(rows) for rows in groups.values()]
        self.rest = np.concatenate([*map(np.ravel, self.groups), np.zeros(0, int)]).astype(int)
        place = np.empty(start, int)
        place[self.rest] = np.arange(len(self.rest))
        self.groups = [place[rows] for rows in self.groups]
        self.degree = sum(len(rows) for rows in self.groups)
        self.unit = np.zeros(len(self.rest))
        for rows in self.groups:
            self.unit[rows[:, 0]] = 1.0

    def product(self, u: Array, v: Array) -> Array:
        """The Jordan product of two vectors (M,)."""
        out = np.empty_like(u)
        for rows in self.groups:
            a, b = u[rows], v[rows]
            out[rows] = a[:, :1] * b + b[:, :1] * a
            out[rows[:, 0]] = (a * b).sum(axis=1)
        return out

    def divided(self, u: Array, v: Array) -> Array:
        """The vector x with product(u, x) = v."""
        out = np.empty_like(u)
        for rows in self.groups:
            a, b = u[rows], v[rows]
            first = (a[:, 0] * b[:, 0] - (a[:, 1:] * b[:, 1:]).sum(axis=1)) / _square(a)
            out[rows] = (b - first[:, None] * a) / a[:, :1]
            out[rows[:, 0]] = first
        return out

    def step(self, u: Array, du: Array) -> float:
        """The largest step to the boundary from u, in the cone, along du; at most 1 / STEP."""
        longest = 1.0 / STEP
        for rows in self.groups:
            a, d = u[rows], du[rows]
            if rows.shape[1] == 1:
                a, d = a[:, 0], d[:, 0]
                ends = np.where(d < 0, -a / d, np.inf)
            else:
                # a scaled to the unit: the step ends where the smaller eigenvalue of du becomes -1
                size = np.sqrt(_square(a))
                unit, rate = a / size[:, None], d / size[:, None]
                along = unit[:, 0] * rate[:, 0] - (unit[:, 1:] * rate[:, 1:]).sum(axis=1)
                factor = (along + rate[:, 0]) / (unit[:, 0] + 1.0)
                across = rate[:, 1:] - factor[:, None] * unit[:, 1:]
                least = along - np.sqrt((across**2).sum(axis=1))
                ends = np.where(least < 0, -1.0 / least, np.inf)
            if ends.size:
                longest = min(longest, float(ends.min()))
        return longest


def _square(a: Array) -> Array:
    """Squares of the hyperbolic lengths (C,) of vectors (C, S)."""
    size = np.sqrt((a[:, 1:] ** 2).sum(axis=1))
    return np.asarray((a[:, 0] - size) * (a[:, 0] + size))


def _largest(values: Array) -> float:
    """The largest absolute value."""
    return float(np.abs(values).max(initial=0.0))


class _Scaling:
    """The Nesterov-Todd scaling W of slacks and duals: W z = s / W = scaled."""

    def __init__(self, cones: _Cones, s: Array, z: Array) -> None:
        self.cones = cones
        self.blocks = []
        for rows in cones.groups:
            a, b = s[rows], z[rows]
            sa, sb = _square(a), _square(b)
            a, b = a / np.sqrt(sa)[:, None], b / np.sqrt(sb)[:, None]
            gamma = np.sqrt((1.0 + (a * b).sum(axis=1)) / 2)
            b[:, 1:] *= -1.0
            self.blocks.append(((a + b) / (2 * gamma)[:, None], (sa / sb) ** 0.25))
        self.scaled = self.times(z)

    def times(self, v: Array, inverse: bool = False) -> Array:
        """W v, or v / W; v (M,) or (M, N)."""
        out = np.empty_like(v)
        for rows, (w, eta) in zip(self.cones.groups, self.blocks, strict=True):
            part = v[rows] if v.ndim == 2 else v[rows][..., None]
            w1 = w[:, 1:, None] * (-1.0 if inverse else 1.0)
            along = (w1 * part[:, 1:]).sum(axis=1, keepdims=True)
            first = w[:, :1, None] * part[:, :1] + along
            factor = part[:, :1] + along / (1.0 + w[:, :1, None])
            whole = np.concatenate([first, part[:, 1:] + factor * w1], axis=1)
            whole *= (1.0 / eta if inverse else eta)[:, None, None]
            out[rows] = whole if v.ndim == 2 else whole[..., 0]
        return out


class _Embedding:
    """The embedding of one program, rows and columns scaled to entries of about 1."""

    def __init__(
        self, cost: Array, matrix: Array, right: Array, cones: _Cones, tolerance: float
    ) -> None:
        self.cones, self.tolerance = cones, tolerance
        self.whole = cost, matrix, right
        rows, columns = self._scales(matrix)
        self.rows, self.columns = rows, columns
        scaled = matrix * rows[:, None] * columns
        self.factor = 1.0 / max(np.abs(cost * columns).max(initial=0.0), TINY)
        self.c = cost * columns * self.factor
        b = right * rows
        self.size = 1.0 / max(np.abs(b).max(initial=0.0), TINY)
        b = b * self.size
        self.a, self.b = scaled[cones.zero], b[cones.zero]
        self.g, self.h = scaled[cones.rest], b[cones.rest]

    def _scales(self, matrix: Array) -> tuple[Array, Array]:
        """Factors of rows (M,), the same in all rows of a cone, and of columns (N,); Ruiz."""
        size = np.abs(matrix)
        rows, columns = np.ones(size.shape[0]), np.ones(size.shape[1])
        rest = self.cones.rest
        for _ in range(ROUNDS):
            now = size * rows[:, None] * columns
            largest = now.max(axis=1, initial=0.0)
            for group in self.cones.groups:
                largest[rest[group]] = largest[rest[group]].max(axis=1, keepdims=True)
            rows /= np.sqrt(np.where(largest > 0, largest, 1.0))
            largest = now.max(axis=0, initial=0.0)
            columns /= np.sqrt(np.where(largest > 0, largest, 1.0))
        return rows, columns

    def solve(self) -> ConeSolution:
        """Iterate until the accuracy is reached, or no further step helps."""
        n, unit = len(self.c), self.cones.unit
        self.x, self.y = np.zeros(n), np.zeros(len(self.b))
        self.s, self.z, self.tau, self.kappa = unit.copy(), unit.copy(), 1.0, 1.0
        best: tuple[float, ConeSolution] | None = None
        for _ in range(MOST_STEPS):
            error, solution = self._measured()
            if solution.status in ("solved", "infeasible"):
                return solution
            if not np.isfinite(error):
                break
            if best is None or error < best[0]:
                best = error, solution
            elif error > WORSE * best[0] and best[0] < LOOSE:  # rounding has taken over
                break
            if not self._advance():
                break
        if best is None:
            return ConeSolution("stalled", "NumericalError", self.x, self._duals(), np.inf, -np.inf)
        return best[1]

    def _duals(self) -> Array:
        z = np.empty(len(self.y) + len(self.z))
        z[self.cones.zero], z[self.cones.rest] = self.y, self.z
        return z

    def _measured(self) -> tuple[float, ConeSolution]:
        """Relative error of the present point as a solution of the program itself."""
        cost, matrix, right = self.whole
        x = self.columns * self.x / self.tau / self.size
        z = self.rows * self._duals() / self.tau / self.factor
        s = np.zeros(len(right))
        s[self.cones.rest] = self.s / self.tau / self.size
        s /= self.rows
        value, dual = float(cost @ x), float(-right @ z)
        primal = _largest(matrix @ x + s - right) / max(1.0, *map(_largest, (right, x, s)))
        slope = _largest(matrix.T @ z + cost) / max(1.0, *map(_largest, (cost, x, z)))
        gap = abs(value - dual) / max(1.0, min(abs(value), abs(dual)))
        error = max(primal, slope, gap)
        status: Status = "stalled"
        if error < self.tolerance:
            status = "solved"
        elif self._certified():
            status = "infeasible"
        elif error < LOOSE:
            status = "almost solved"
        words = {"solved": "Solved", "infeasible": "Infeasible", "almost solved": "AlmostSolved"}
        return error, ConeSolution(status, words.get(status, "MaxIterations"), x, z, value, dual)

    def _certified(self) -> bool:
        """Whether the point proves that no numbers meet the constraints."""
        against = -(self.b @ self.y + self.h @ self.z)
        if against <= 0:
            return False
        left = np.abs(self.a.T @ self.y + self.g.T @ self.z).max(initial=0.0)
        return bool(left < self.tolerance * against and self.tau < APART * self.kappa)

    def _advance(self) -> bool:
        """Make one predictor and corrector step; return whether it could be made."""
        cones, tau, kappa = self.cones, self.tau, self.kappa
        w = _Scaling(cones, self.s, self.z)
        lam = w.scaled
        solve = self._factored(w)
        first = solve(-self.c, self.b, self.h)
        rx = -(self.a.T @ self.y + self.g.T @ self.z + self.c * tau)
        ry = self.a @ self.x - self.b * tau
        rz = self.g @ self.x + self.s - self.h * tau
        rt = kappa + self.c @ self.x + self.b @ self.y + self.h @ self.z
        mu = (lam @ lam + tau * kappa) / (cones.degree + 1)

        def towards(center: float, ds: Array, dk: float) -> tuple[Any, ...]:
            share = 1.0 - center
            turned = w.times(cones.divided(lam, ds))
            x2, y2, z2 = solve(share * rx, -share * ry, -share * rz + turned)
            x1, y1, z1 = first
            along = self.c @ x2 + self.b @ y2 + self.h @ z2
            below = self.c @ x1 + self.b @ y1 + self.h @ z1 - kappa / tau
            dt = (-share * rt + dk / tau - along) / below
            dx, dy, dz = x2 + dt * x1, y2 + dt * y1, z2 + dt * z1
            d_s = -turned - w.times(w.times(dz))
            return dx, dy, dz, d_s, dt, -(dk + kappa * dt) / tau

        square = cones.product(lam, lam)
        _, _, dz, ds, dt, dk = towards(0.0, square, tau * kappa)
        length = min(1.0, self._longest(ds, dz, dt, dk))
        center = (1.0 - length) ** 3
        bent = cones.product(w.times(ds, inverse=True), w.times(dz))
        turned = square + bent - center * mu * cones.unit
        step = towards(center, turned, tau * kappa + dt * dk - center * mu)
        length = min(1.0, STEP * self._longest(step[3], step[2], step[4], step[5]))
        if not all(np.all(np.isfinite(part)) for part in step) or length < STANDSTILL:
            return False
        dx, dy, dz, ds, dt, dk = (length * part for part in step)
        self.x, self.y, self.z = self.x + dx, self.y + dy, self.z + dz
        self.s, self.tau, self.kappa = self.s + ds, tau + dt, kappa + dk
        return True

    def _longest(self, ds: Array, dz: Array, dt: float, dk: float) -> float:
        """The longest step along which everything stays in its cone."""
        ends = [self.cones.step(self.s, ds), self.cones.step(self.z, dz)]
        ends += [-now / d for now, d in ((self.tau, dt), (self.kappa, dk)) if d < 0]
        return min(ends)

    def _factored(self, w: _Scaling) -> Any:
        """A solver of [0 A' G'; A 0 0; G 0 -W^2] (x, y, z) = right-hand sides."""
        n, m = len(self.c), len(self.b)
        scaled = w.times(self.g, inverse=True)
        kkt = np.zeros((n + m, n + m))
        kkt[:n, :n] = scaled.T @ scaled
        kkt[:n, n:], kkt[n:, :n] = self.a.T, self.a
        small = REGULAR * max(np.abs(np.diag(kkt)[:n]).max(initial=0.0), TINY)
        regular = kkt + np.diag([*[small] * n, *[-small] * m])
        inverse = np.linalg.inv(regular)

        def once(px: Array, py: Array, pz: Array) -> tuple[Array, Array, Array]:
            right = np.concatenate([px + scaled.T @ w.times(pz, inverse=True), py])
            both = inverse @ right
            dz = w.times(scaled @ both[:n] - w.times(pz, inverse=True), inverse=True)
            return both[:n], both[n:], dz

        def solve(px: Array, py: Array, pz: Array) -> tuple[Array, Array, Array]:
            x, y, z = once(px, py, pz)
            for _ in range(REFINEMENTS):
                ex = px - self.a.T @ y - self.g.T @ z
                ey = py - self.a @ x
                ez = pz - self.g @ x + w.times(w.times(z))
                dx, dy, dz = once(ex, ey, ez)
                x, y, z = x + dx, y + dy, z + dz
            return x, y, z

        return solve


Cone = Literal["zero", "nonnegative", "second-order"]

TOLERANCES = (1e-9, 1e-8)
"""Relative to cost and constraints."""
STRIDE, BROKEN, MOST_ROUNDS = 12, 3e-9, 30
"""Of the rows of a cycle with which a program starts; by how much a row may be broken; how often
rows are added."""


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
        solver = usual_solver()
        for tolerance in self.tolerances:
            solution = solver(cost, matrix, right, cones, tolerance)
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
