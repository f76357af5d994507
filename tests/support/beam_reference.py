"""A vibrating shaft with stations by finite elements: reference figures by an independent route.

Nothing of Equipoise is used.  One plane, SI units, motion Re(W exp(i w t)); x runs from the left
end, w is the deflection, psi the rotation of the section (w' without shear), M = EI psi'.  Elements
are cubic Hermite, or with shear the exact-static Timoshenko element (phi = 12 EI/(kGA h^2)), their
masses consistent.  Nodes lie at piece ends, stations, supports, forces and asked positions.

Rounding: the stiffness matrix is never formed; elements and springs are taken by their deformations
and forces, which no rigid motion can spoil.  Discretisation: results of `levels` meshes, each
halving the elements of the one before, are extrapolated to zero element length (powers h^2, h^4,
...); `elements` counts those of the finest, roughly; `levels=1` is plain finite elements.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Sequence
from dataclasses import astuple, dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy import linalg, sparse
from scipy.sparse.linalg import LinearOperator, eigs, eigsh, splu


@dataclass(frozen=True)
class Piece:
    """A uniform piece of shaft."""

    length: float  # m
    bending_stiffness: float  # EI, N m^2
    mass_per_length: float  # kg/m
    shear_stiffness: float = math.inf  # kappa G A, N
    rotary_inertia: float = 0.0  # rho I, kg m
    loss_factor: float = 0.0  # eta: EI and kappa G A times 1 + i eta


@dataclass(frozen=True)
class Attached:
    """A station of the shaft; springs and dampers go to ground."""

    position: float  # m from the left end
    mass: float = 0.0  # kg
    inertia: float = 0.0  # kg m^2
    stiffness: float = 0.0  # N/m
    damping: float = 0.0  # N s/m
    rotational_stiffness: float = 0.0  # N m/rad
    rotational_damping: float = 0.0  # N m s/rad
    absorber: tuple[float, float, float] | None = None  # kg, N/m, N s/m: on the shaft


class Reference:
    """A shaft of pieces from left to right; held: (position in m, "displacement" or "slope")."""

    def __init__(
        self,
        pieces: Sequence[Piece],
        attached: Sequence[Attached] = (),
        elements: int = 200,
        *,
        held: Collection[tuple[float, str]] = (),
        levels: int = 3,
    ) -> None:
        self.pieces = np.array([astuple(piece) for piece in pieces], float)
        self.ends = np.cumsum([0.0, *self.pieces[:, 0]])
        rows = [(*astuple(a)[:7], *(a.absorber or (0.0, 0.0, 0.0))) for a in attached]
        table, self.held = np.array(rows, float).reshape(-1, 10), tuple(held)
        table[table[:, 7] == 0, 8:] = 0.0  # a spring to no mass carries no force
        self.places, self.elements, self.levels = table[:, 0], elements, levels
        self.stops = [*self.ends, *self.places, *(place for place, _ in held)]
        self.masses, self.k, self.c = table[:, [1, 2, 7]], table[:, [3, 5, 8]], table[:, [4, 6, 9]]
        self._plain = self.meshes()

    def meshes(self, positions: Collection[float] = ()) -> list[_Mesh]:
        """From coarse to fine, with nodes at the positions (m) too."""
        return [_Mesh(self, positions, halvings) for halvings in range(self.levels)]

    @property
    def rigid_modes(self) -> int:
        """The number of natural frequencies that are 0."""
        rows = [(1, x / self.ends[-1]) for x in self.places[self.k[:, 0] > 0]]
        rows += [(0, 1)] * int((self.k[:, 1] > 0).sum())
        rows += [(0, 1) if what == "slope" else (1, x / self.ends[-1]) for x, what in self.held]
        loose = ((self.masses[:, 2] > 0) & (self.k[:, 2] == 0)).sum()
        return 2 - int(np.linalg.matrix_rank(np.array([(0, 0), *rows], float))) + int(loose)

    def natural_frequencies(self, count: int) -> NDArray:
        """The lowest undamped ones in rad/s, (count,); those of rigid modes are exactly 0."""
        squares = _extrapolated([mesh.squares(count) for mesh in self._plain])
        squares[: self.rigid_modes] = 0.0
        return np.sqrt(squares)

    def eigenvalues(self, count: int) -> NDArray:
        """Complex s (1/s) with Im s > 0, sorted by |s|, (count,); stiffness EI (1 + i eta)."""
        scale = self.natural_frequencies(self.rigid_modes + 1)[-1]
        *coarse, fine = (mesh.eigenvalues(count, scale) for mesh in self._plain)
        rows = [np.array([row[np.argmin(abs(row - s))] for s in fine]) for row in coarse]
        return _extrapolated([*rows, fine])

    def response(self, frequency: ArrayLike, forces: Sequence[tuple]) -> Response:
        """To forces (position m, force N, couple N m; complex) at frequencies in rad/s, (F,)."""
        return Response(self, np.atleast_1d(np.asarray(frequency, float)), tuple(forces))


class Response:
    """Complex amplitudes (F, ...) at F frequencies; A stations in the order given."""

    def __init__(self, reference: Reference, frequency: NDArray, forces: tuple) -> None:
        self._reference, self._frequency, self._forces = reference, frequency, forces
        self._positions = {float(place) for place, _, _ in forces}
        self._meshes: list[_Mesh] = []  # solved; solved anew when other positions are asked for

    def displacement(self, x: ArrayLike) -> NDArray:
        """W at x (m), in m, (F, len(x))."""
        return self._of(lambda mesh: mesh.q[:, 2 * mesh.node(x)], x)

    def slope(self, x: ArrayLike) -> NDArray:
        """Rotation psi of the section at x (m), in rad, (F, len(x)); w' without shear."""
        return self._of(lambda mesh: mesh.q[:, 2 * mesh.node(x) + 1], x)

    def bending_moment(self, x: ArrayLike, side: str = "mean") -> NDArray:
        """M = EI psi' at x (m), in N m, (F, len(x)); side of a jump: "left", "right", "mean"."""
        return self._of(lambda mesh: mesh.moments()[side][:, mesh.node(x)], x)

    def ground_force(self) -> NDArray:
        """(k + i w c) W of every station's spring and damper on the ground, in N, (F, A)."""
        ref, iw = self._reference, 1j * self._frequency[:, None]
        return self._of(lambda mesh: (ref.k[:, 0] + iw * ref.c[:, 0]) * mesh.stretch[..., 0])

    def power(self) -> dict[str, NDArray]:
        """Time averages in W: "fed_in", spent in "shaft", (F,), and in dampers by kind, (F, A)."""
        w, rate = self._frequency, self._frequency[:, None, None] ** 2 / 2 * self._reference.c
        fed_in = self._of(lambda mesh: w / 2 * (mesh.q.conj() @ mesh.f).imag)
        shaft = self._of(lambda mesh: w / 2 * (abs(mesh.q @ mesh.b.T) ** 2 @ mesh.d.imag))
        lost = np.moveaxis(self._of(lambda mesh: rate * abs(mesh.stretch) ** 2), 2, 0)
        dampers = dict(zip(("damper", "rotational_damper", "absorber"), lost, strict=True))
        return {"fed_in": fed_in, "shaft": shaft, **dampers}

    def _of(self, result: Callable[[_Mesh], NDArray], x: ArrayLike = ()) -> NDArray:
        asked = set(map(float, np.ravel(x)))
        if not self._meshes or not asked <= self._positions:
            self._positions |= asked
            self._meshes = self._reference.meshes(self._positions)
            for mesh in self._meshes:
                mesh.solve(self._frequency, self._forces)
        return _extrapolated([result(mesh) for mesh in self._meshes])


class _Mesh:
    """One mesh: w, psi of every node, then w of absorbers; K = B' diag(d) B, C = P' diag(c) P, M.
    Rows of B: two deformations of every element, then P: w, psi, w less absorber of every station.
    """

    def __init__(self, ref: Reference, positions: Collection[float], halvings: int) -> None:
        self.ref, self.c, own = ref, ref.c.ravel(), len(ref.places)
        self.x = self._nodes(positions, max(1, ref.elements >> (ref.levels - 1)), 2**halvings)
        self.h, at, self.size = np.diff(self.x), self.node(ref.places), 2 * len(self.x) + own
        self.place = 2 * np.arange(len(self.h))[:, None] + np.arange(4)
        self.columns = np.stack([2 * at, 2 * at + 1, self.size - own + np.arange(own)], axis=1)
        fixed = [2 * int(self.node(place)[0]) + (what == "slope") for place, what in ref.held]
        fixed = [*fixed, *self.columns[ref.masses[:, 2] == 0, 2]]  # no absorber: none of its own
        self.free = np.setdiff1d(np.arange(self.size), np.array(fixed, int))
        part = np.searchsorted(ref.ends, (self.x[1:] + self.x[:-1]) / 2) - 1
        _, ei, mu, shear, rho, eta = ref.pieces[part].T
        phi = 12 * ei / (shear * self.h**2)
        elastic = np.stack([ei / self.h, 12 * ei / (self.h * (1 + phi))], axis=1)
        self.d = np.append(elastic * (1 + 1j * eta[:, None]), ref.k)
        self.b, (self.own, self.m) = self._deformations(), self._mass(mu, rho, phi)
        self.p = self.b[2 * len(self.h) :]

    def _nodes(self, positions: Collection[float], coarse: int, times: int) -> NDArray:
        length, places = self.ref.ends[-1], np.sort([*self.ref.stops, *positions])
        tiny = 1e-9 * length  # positions nearer than this are one
        if places[0] < 0 or places[-1] > length + tiny:
            raise ValueError(f"a position is off the shaft: {places[0]} to {places[-1]} m")
        stops = places[np.diff(places, prepend=-math.inf) > tiny]
        parts = [max(1, math.ceil(coarse * (b - a) / length - 1e-6)) for a, b in pairwise(stops)]
        spans = zip(stops[:-1], stops[1:], parts, strict=True)
        inner = [np.linspace(a, b, n * times, endpoint=False) for a, b, n in spans]
        return np.append(np.concatenate(inner), stops[-1])

    def node(self, x: ArrayLike) -> NDArray:
        return np.argmin(abs(self.x[:, None] - np.ravel(x)), axis=0)

    def _deformations(self) -> sparse.csr_array:
        """B: psi2 - psi1 and (psi1 + psi2)/2 - (w2 - w1)/h of elements, then stations."""
        rows = np.tile([[[0.0, -1.0, 0.0, 1.0], [0.0, 0.5, 0.0, 0.5]]], (len(self.h), 1, 1))
        rows[:, 1, 0], rows[:, 1, 2] = 1 / self.h, -1 / self.h
        stations = np.tile([[1.0, 0, 0, 0], [0, 1, 0, 0], [1, 0, -1, 0]], (len(self.columns), 1))
        values = np.concatenate([rows.reshape(-1, 4), stations])
        own = np.repeat(self.columns[:, [0, 1, 2, 2]], 3, axis=0)
        columns = np.append(np.repeat(self.place, 2, axis=0), own)
        index = np.repeat(np.arange(len(values)), 4), columns
        return sparse.coo_array((values.ravel(), index), (len(values), self.size)).tocsr()

    def _mass(self, mu: NDArray, rho: NDArray, phi: NDArray) -> tuple[NDArray, sparse.csr_array]:
        """The elements' own, from shapes of w and psi at parts z of them, and the sum of all."""
        points, weights = np.polynomial.legendre.leggauss(4)
        z, area = (points[:, None] + 1) / 2, weights[:, None] / 2 * self.h / (1 + phi) ** 2
        bubble = z * (1 - z)
        w1, w2 = 1 - 3 * z**2 + 2 * z**3 + phi * (1 - z), self.h * bubble * (1 - z + phi / 2)
        w3, w4 = 3 * z**2 - 2 * z**3 + phi * z, -self.h * bubble * (z + phi / 2)
        psi1, psi2 = -6 * bubble / self.h, 1 - 4 * z + 3 * z**2 + phi * (1 - z)
        psi4 = 3 * z**2 - 2 * z + phi * z
        shape, turn = np.array([w1, w2, w3, w4]), np.array([psi1, psi2, -psi1, psi4])
        own = np.einsum("ge,ige,jge->eij", area * mu, shape, shape)
        own += np.einsum("ge,ige,jge->eij", area * rho, turn, turn)
        rows = np.append(np.repeat(self.place, 4, axis=1), self.columns)
        columns = np.append(np.tile(self.place, (1, 4)), self.columns)
        values = np.append(own, self.ref.masses)
        return own, sparse.coo_array((values, (rows, columns)), (self.size,) * 2).tocsr()

    def matrices(self) -> tuple[sparse.csc_array, sparse.csc_array]:
        """C and M of the free degrees of freedom."""
        c = self.p.T @ sparse.diags_array(self.c) @ self.p
        return c.tocsc()[:, self.free][self.free], self.m.tocsc()[:, self.free][self.free]

    def solver(self, d: NDArray, rest: sparse.csc_array) -> Callable[[NDArray], NDArray]:
        """Of (B' diag(d) B + rest) q = f: all forces diag(d) B q (of d not 0), then q."""
        b, inverse = self.b[d != 0][:, self.free], sparse.diags_array(1 / d[d != 0])
        factors = splu(sparse.block_array([[-inverse, b], [b.T, rest]]).tocsc())
        return lambda f: factors.solve(np.append(np.zeros(b.shape[0]), f))

    def squares(self, count: int) -> NDArray:
        """Lowest undamped eigenvalues (1/s^2): Rayleigh-Ritz, then quotients of deformations."""
        (_, m), d, size = self.matrices(), self.d.real, len(self.free)
        mass = self.own[:, ::2, ::2].sum() + self.ref.masses[:, 0].sum()
        small = 10 * self.ref.pieces[:, 1].min() / (mass * self.ref.ends[-1] ** 3)
        start = np.random.default_rng(1).standard_normal(size)
        q = np.zeros((self.size, min(count + 6, size - 1)))
        solve = self.solver(d, small * m)
        inverse = LinearOperator((size, size), lambda f: solve(f)[-size:], dtype=float)
        q[self.free] = eigsh(m, q.shape[1], m, -small, v0=start, OPinv=inverse)[1]
        q = q @ linalg.eigh((self.b @ q).T * d @ (self.b @ q), q.T @ (self.m @ q))[1]
        quotients = d @ (self.b @ q) ** 2 / (q * (self.m @ q)).sum(axis=0)
        return np.sort(quotients)[:count]

    def eigenvalues(self, count: int, scale: float) -> NDArray:
        """Lowest s (1/s), Im s > 0, by Arnoldi about a small real shift until none is missed."""
        (c, m), size, shift = self.matrices(), len(self.free), 0.3 * scale
        solve, rest = self.solver(self.d, shift * c + shift**2 * m), c + shift * m

        def inverse(z: NDArray) -> NDArray:  # of the first-order form in (u, s u / scale)
            u = -solve(scale * (m @ z[size:]) + rest @ z[:size])[-size:]
            return np.append(u, (z[:size] + shift * u) / scale)

        operator = LinearOperator((2 * size, 2 * size), inverse, dtype=complex)
        start = np.random.default_rng(1).standard_normal(2 * size) + 0j
        wanted = 2 * (count + self.ref.rigid_modes) + 8
        while wanted < 2 * size - 1:
            theta, z = eigs(operator, wanted, v0=start)
            result = zip(shift + 1 / theta, z[:size].T, strict=True)
            s = np.array([self._root(*pair) for pair in result])
            s = np.array(sorted(s[(s.imag > 1e-6 * abs(s)) & (abs(s) > 1e-5 * scale)], key=abs))
            if len(s) >= count and abs(s[count - 1]) <= abs(1 / theta).max() - shift:
                return s[:count]
            wanted *= 2
        raise ValueError(f"these elements do not yield {count} eigenvalues")

    def _root(self, s: complex, free: NDArray) -> complex:
        """Root next to s of q'(K + s C + s^2 M) q = 0: K symmetric, errors of q enter squared."""
        q = np.zeros(self.size, complex)
        q[self.free] = free
        k, c = self.d @ (self.b @ q) ** 2, self.c @ (self.p @ q) ** 2
        roots = np.roots([q @ (self.m @ q), c, k])
        return roots[np.argmin(abs(roots - s))]

    def solve(self, frequency: NDArray, forces: tuple) -> None:
        """Amplitudes q (F, size), forces of elements and stretch of stations at rad/s."""
        (c, m), size, elements = self.matrices(), len(self.free), 2 * len(self.h)
        self.w, self.f = frequency, np.zeros(self.size, complex)
        for place, force, couple in forces:
            self.f[2 * self.node(place)[0] + np.arange(2)] += force, couple
        load, self.q = self.f[self.free], np.zeros((len(frequency), self.size), complex)
        both = np.array([self.solver(self.d, 1j * w * c - w**2 * m)(load) for w in frequency])
        self.force, self.q[:, self.free] = both[:, :elements], both[:, -size:]
        self.stretch = (self.q @ self.p.T).reshape(len(frequency), -1, 3)  # w, psi, w less absorber

    def moments(self) -> dict[str, NDArray]:
        """M = EI psi' (N m) on the sides of every node from the end couples of elements."""
        inertia = np.einsum("f,eij,fej->fei", self.w**2, self.own, self.q[:, self.place])
        even, odd = self.force[:, ::2], self.force[:, 1::2] / 2
        first, last = even - odd + inertia[..., 1], even + odd - inertia[..., 3]
        left, right = np.hstack([first[:, :1], last]), np.hstack([first, last[:, -1:]])
        return {"left": left, "right": right, "mean": (left + right) / 2}


def _extrapolated(results: list[NDArray]) -> NDArray:
    """Of meshes with elements halved each time, to length 0 in powers h^2, h^4..."""
    table, power = list(results), 1
    while len(table) > 1:
        power *= 4
        table = [b + (b - a) / (power - 1) for a, b in pairwise(table)]
    return np.array(table[0])
