"""The chain against one stiffness matrix of all nodes at once, made here in 40 digits."""

from __future__ import annotations

from functools import lru_cache
from typing import Any

import mpmath
import numpy as np
import pytest

from equipoise.handheld.chain import (
    Chain,
    CondensedStiffness,
    Dual,
    NodePair,
    carry,
    count,
    log_determinant,
    longest,
    shear_transfer,
    solve,
    transfer,
)
from unit.handheld.samples import THEORIES

Array = np.ndarray[Any, Any]
NODES = 4


class Subject:
    """Segments and stations by numbers, of both theories.

    Stations are dynamic stiffnesses a + b s + c s^2, N/m and N m/rad.
    """

    def __init__(self, seed: int, theory: str) -> None:
        rng = np.random.default_rng([seed, 8])
        thick = theory == "timoshenko"
        self.frequency = 10 ** rng.uniform(1.5, 3.5)
        self.sections = []
        for _ in range(NODES - 1):
            e, m = 1 / rng.uniform(200, 4000), rng.uniform(0.3, 3)
            s, r = thick * e * rng.uniform(1e-3, 2e-2), thick * m * rng.uniform(1e-5, 1e-3)
            length = rng.uniform(0.05, 1) * longest(self.frequency, e, s, m, r)
            self.sections.append((length, e, s, m, r))
        self.polynomials = rng.uniform(0, 1, (NODES, 2, 3)) * [[1e4, 20, 2], [200, 0.5, 0.02]]
        self.thick = thick

    def chain(self, s: Any) -> Chain:
        segments = [
            shear_transfer(length, e, g, m * (s * s), r * (s * s))
            if self.thick
            else transfer(length, e, m * (s * s))
            for length, e, g, m, r in self.sections
        ]
        stations = [
            NodePair(*(a + b * s + c * (s * s) for a, b, c in node)) for node in self.polynomials
        ]
        return Chain(segments, stations)

    def matrices(self, s: complex) -> list[Any]:
        """The transfer matrix of each segment, by exponentials."""
        return [exponential(*section, s) for section in self.sections]

    def held(self, s: complex) -> list[Any]:
        """The stiffness of each station, diagonal."""
        return [
            mpmath.diag([mpmath.mpf(a) + b * s + c * s**2 for a, b, c in node])
            for node in self.polynomials
        ]

    def dense(self, s: complex, last: int = NODES) -> Any:
        """The dynamic stiffness of the first nodes all at once, from the left end.

        A segment pushes its left end by -f(0) and its right end by f(l), with f(0) =
        T12^-1 (q(l) - T11 q(0)).
        """
        whole = mpmath.zeros(2 * last)
        for k, t in enumerate(self.matrices(s)[: last - 1]):
            t11, t12, t21, t22 = t[:2, :2], t[:2, 2:], t[2:, :2], t[2:, 2:]
            inverse = t12**-1
            parts = ((inverse * t11, -inverse), (t21 - t22 * inverse * t11, t22 * inverse))
            for i in range(2):
                for j in range(2):
                    _add(whole, 2 * (k + i), 2 * (k + j), parts[i][j])
        for k, station in enumerate(self.held(s)[:last]):
            _add(whole, 2 * k, 2 * k, station)
        return whole


@lru_cache(maxsize=64)
def exponential(length: float, e: float, g: float, m: float, r: float, s: complex) -> Any:
    rows = [[0, 1, g, 0], [0, 0, 0, e], [m * s**2, 0, 0, 0], [0, r * s**2, -1, 0]]
    return mpmath.expm(mpmath.matrix(rows) * length, method="taylor")


def _add(whole: Any, row: int, column: int, part: Any) -> None:
    for i in range(2):
        for j in range(2):
            whole[row + i, column + j] += part[i, j]


def complex_of(matrix: Any) -> Array:
    return np.array(matrix.tolist()).astype(complex)


subjects = pytest.mark.parametrize(
    "subject",
    [Subject(seed, theory) for theory in THEORIES for seed in range(2)],
    ids=[f"{theory}-{seed}" for theory in THEORIES for seed in range(2)],
)
places = pytest.mark.parametrize("place", [0.9j, 0.03j, -0.2 + 0.7j], ids=str)


def loads_of(seed: int) -> Array:
    rng = np.random.default_rng([seed, 9])
    return rng.normal(size=(NODES, 2)) + 1j * rng.normal(size=(NODES, 2))


@subjects
@places
def test_solution(subject: Subject, place: complex) -> None:
    """Motion of all nodes, and the force just right of each, under loads on all nodes but one.

    1e-12 of the largest: some thousand roundings, with none that grows from node to node.
    """
    s = place * subject.frequency
    loads = loads_of(1)
    loads[2] = 0
    pairs = [None if k == 2 else NodePair(*row) for k, row in enumerate(loads)]
    solution = solve(carry(subject.chain(np.array(s))), pairs)
    with mpmath.workdps(40):
        q = mpmath.lu_solve(subject.dense(s), mpmath.matrix(loads.ravel().tolist()))
        forces = []
        for k, t in enumerate(subject.matrices(s)):
            left, right = q[2 * k : 2 * k + 2, :], q[2 * k + 2 : 2 * k + 4, :]
            forces.append(complex_of(t[:2, 2:] ** -1 * (right - t[:2, :2] * left)).ravel())
        wanted = complex_of(q).reshape(NODES, 2)
    motion = np.array([[complex(pair.across), complex(pair.turning)] for pair in solution.motion])
    force = np.array([[complex(pair.across), complex(pair.turning)] for pair in solution.force])
    np.testing.assert_allclose(motion, wanted, rtol=0, atol=1e-12 * np.max(np.abs(wanted)))
    for column in range(2):
        exact = np.array(forces)[:, column]
        away = np.abs(force[:-1, column] - exact)
        assert np.max(away) < 1e-12 * np.max(np.abs(exact))


@subjects
def test_loads_balance_at_the_right_end(subject: Subject) -> None:
    """Nothing is right of it, so no force is there."""
    solution = solve(
        carry(subject.chain(np.array(0.7j * subject.frequency))),
        [NodePair(*row) for row in loads_of(2)],
    )
    assert solution.force[-1] == NodePair(0, 0)


@subjects
@places
def test_stiffness_is_that_of_all_to_the_left(subject: Subject, place: complex) -> None:
    """Z is what is left of the whole matrix when the nodes left of it are free of force."""
    s = place * subject.frequency
    carried = carry(subject.chain(np.array(s)))
    for last in range(1, NODES + 1):
        with mpmath.workdps(40):
            k = subject.dense(s, last)
            n = 2 * last - 2
            rest = k[n:, n:]
            if n:
                rest = rest - k[n:, :n] * k[:n, :n] ** -1 * k[:n, n:]
            wanted = complex_of(rest)
        z = carried.stiffness[last - 1]
        values = np.array([[z.aa, z.at], [z.at, z.tt]])
        assert np.abs(wanted[0, 1] - wanted[1, 0]) <= 1e-20 * np.max(np.abs(wanted))
        units = np.sqrt(np.abs(np.diag(wanted)))  # N/m and N m/rad side by side
        assert np.max(np.abs(values - wanted) / np.outer(units, units)) < 1e-11


@pytest.mark.exhaustive(but=["timoshenko-1"])
@subjects
def test_count_is_that_of_negative_eigenvalues(subject: Subject) -> None:
    """No segment has a frequency of its own with its ends held, so the whole matrix tells all.

    Sylvester: as many negative eigenvalues as natural frequencies below.  Without dampers.
    """
    subject.polynomials[:, :, 1] = 0
    frequency = np.linspace(0.02, 1, 12) * subject.frequency
    carried = carry(_real(subject.chain(1j * frequency)))
    result = count(carried)
    wanted = []
    for w in frequency:
        with mpmath.workdps(40):
            k = subject.dense(1j * w).apply(mpmath.re)
            wanted.append(sum(1 for value in mpmath.eigsy(k, eigvals_only=True) if value < 0))
    assert result.tolist() == wanted
    assert len(set(wanted)) > 2
    assert np.all(np.diff(result) >= 0)


def _real(chain: Chain) -> Chain:
    """As `count` wants it."""
    segments = [type(segment)(*(np.real(part) for part in segment)) for segment in chain.segments]
    return Chain(
        segments, [NodePair(*(np.real(part) for part in station)) for station in chain.stations]
    )


@pytest.mark.exhaustive(
    but=[
        "0.9j-euler-bernoulli-0",
        "(-0.2+0.7j)-timoshenko-1",
        "0.03j-timoshenko-0",
        "0.03j-euler-bernoulli-1",
    ]
)
@subjects
@places
def test_characteristic_function(subject: Subject, place: complex) -> None:
    """Force at the right end by motion at the left one, by the product of all transfer matrices."""
    s = place * subject.frequency

    def determinant(at: Any) -> Any:
        state = mpmath.eye(4)[:, :2]
        for k, station in enumerate(subject.held(at)):
            if k:
                state = subject.matrices(at)[k - 1] * state
            state[2:, :] = state[2:, :] + station * state[:2, :]
        return mpmath.det(state[2:, :])

    with mpmath.workdps(40):
        value = determinant(mpmath.mpmathify(s))
        slope = complex(mpmath.diff(determinant, s) / value)
        value = mpmath.log(value)
    logarithm, actual = log_determinant(
        carry(subject.chain(Dual(np.array(s, complex), np.ones(1, complex))))
    )
    away = complex(logarithm) - complex(value)
    assert abs(np.exp(away) - 1) < 1e-11  # whole turns of its phase do not count
    assert complex(actual) == pytest.approx(slope, rel=1e-11)


def test_a_segment_of_no_length_changes_nothing() -> None:
    subject = Subject(0, "timoshenko")
    s = np.array(0.8j * subject.frequency)
    chain = subject.chain(s)
    nothing = shear_transfer(0.0, 1e-3, 1e-5, s * s, 1e-3 * s * s)
    free = NodePair(np.array(0.0), np.array(0.0))
    longer = Chain([chain.segments[0], nothing, *chain.segments[1:]], _with(chain.stations, free))
    loads: list[Any] = [NodePair(*row) for row in loads_of(4)]
    wanted, actual = solve(carry(chain), loads), solve(carry(longer), _with(loads, None))
    for k in range(NODES):
        first, other = actual.motion[k + (k > 1)], wanted.motion[k]
        np.testing.assert_allclose(first, other, rtol=1e-12)
    assert _count(longer) == _count(chain)


def _with(items: Any, new: Any) -> list[Any]:
    return [*items[:2], new, *items[2:]]


def _count(chain: Chain) -> int:
    carried: CondensedStiffness = carry(_real(chain))
    return int(count(carried))


def test_arrays_are_each_number_by_itself() -> None:
    subject = Subject(1, "timoshenko")
    s = subject.frequency * np.array([[0.2j, 0.5j - 0.1, 0.9j], [0.3j, -0.4, 0.8j]])
    loads = [NodePair(*row) for row in loads_of(5)]
    whole = solve(carry(subject.chain(s)), loads)
    for at in np.ndindex(2, 3):
        first = solve(carry(subject.chain(s[at])), loads)
        for pair, wanted in zip(whole.motion, first.motion, strict=True):
            np.testing.assert_allclose([pair.across[at], pair.turning[at]], wanted, rtol=1e-12)
