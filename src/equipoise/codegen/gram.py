"""Designs that differ in masses alone: mean squares without going round the cycle again.

Every output is linear in the inertial parameters (`mechanism.parameters`).  So the mean square of
one is a quadratic form in them, whose Gram matrix is the same for all designs.  It is kept as a
factor, A = U S W', of which U is not needed: a sum of few squares loses no digits where outputs
nearly cancel, as the Gram matrix itself would.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np

from equipoise.codegen.figures import MOST_ANGLES, NO_MACHINE, NOT_STILL, Figure
from equipoise.errors import UsageError
from equipoise.mechanism.dynamics import forces
from equipoise.mechanism.family import massive_link, with_columns, wrong
from equipoise.mechanism.linkage import assemble
from equipoise.mechanism.model import Machine, size_of
from equipoise.mechanism.motion import move
from equipoise.mechanism.outputs import Found, declared
from equipoise.mechanism.parameters import (
    parameter_names,
    parameter_values,
    parameters_of,
    regressor,
)
from equipoise.quantities.units import HUGE, TINY

Array = np.ndarray[Any, Any]

FIRST = 180
"""Crank angles in a turn from which their number doubles."""
RANK = 1e-14
"""Of the largest of the squares that are summed: smaller ones are rounding."""
AT_ONCE = 8192
"""Designs whose numbers stay in the processor's cache."""
NOTHING = 1e-9
"""Of the largest effect of any parameter: a smaller one is rounding."""
EXACT = 1e-10
"""To which Gram matrices stand still where a user allows less; smooth ones do so at once."""


def can_use(machine: Machine, paths: Sequence[str], wanted: Sequence[Figure]) -> bool:
    """Whether designs differ in masses alone and means and mean squares are all that is wanted."""
    masses = all(massive_link(path) is not None for path in paths)
    return masses and all(_can_have(machine, figure) for figure in wanted)


def _can_have(machine: Machine, figure: Figure) -> bool:
    """Lengths have no linear mean; with gears, masses decide which flank of the teeth pushes."""
    one, _ = declared(figure.signal) or (None, "")
    if one is None or one.needs != "masses" or not one.loop or one.group == "gears":
        return False
    if one.group == "joints" and machine.gears:
        return False
    linear = not one.reason or one.group == "joints"
    return linear and (figure.name == "rms" or (figure.name == "mean" and not one.is_vector))


@dataclass(frozen=True, eq=False)
class Square:
    """A figure as the root of a sum of squares, or a mean: factors (R, V) and constants (R, 1)."""

    factors: Array
    constants: Array
    mean: bool

    def of(self, found: Array) -> Array:
        """The figure (P,), from rows (R, P): factors times parameters, and constants."""
        if self.mean:
            mean: Array = found[0]
            return mean
        root: Array = np.sqrt(np.einsum("ij,ij->j", found, found))
        return root


class Room(NamedTuple):
    """Where some designs (N) at a time are computed; to have it anew each time takes as long again.

    columns : (d, N) their numbers.  parameters : (V + 1, N), ones below.  found : (R, N).
    """

    columns: Array
    parameters: Array
    found: Array

    @classmethod
    def of(cls, numbers: int, matrix: Array, count: int) -> Room:
        """Room for so many designs of so many numbers; matrix : (R, V + 1)."""
        rows, parameters = matrix.shape
        return cls(*(np.ones((height, count)) for height in (numbers, parameters, rows)))


class MassBatch:
    """Designs of one machine that differ in masses; parameters as those of `Batch`."""

    def __init__(
        self,
        machine: Machine,
        paths: Sequence[str],
        wanted: Sequence[Figure],
        angles: int | None = None,
        tolerance: float = 1e-4,
    ) -> None:
        if not can_use(machine, paths, wanted):
            raise UsageError("these designs or figures need the way round the cycle")
        self.base, self.paths, self.wanted = assemble(machine), tuple(paths), tuple(wanted)
        links = {massive_link(path) for path in paths}
        self.links = [link for link in machine.links if link in links]
        self.scale = np.append(_scales(machine, len(self.links)), 1.0)
        self.still = True
        self.squares = self._squares(angles, tolerance)
        rows = [np.column_stack([one.factors, one.constants]) for one in self.squares]
        self.rows = np.concatenate(rows)
        self.ends = np.cumsum([0, *map(len, rows)])
        self.polar = any(path.endswith((".distance", ".direction")) for path in paths)
        self.not_negative = [k for k, p in enumerate(paths) if p.endswith((".mass", ".inertia"))]

    def __call__(self, values: Array) -> tuple[Array, Array]:
        """Figures (P, m) and reasons (P,) of designs (P, d), SI units; NaN where one failed."""
        figures = np.empty((len(values), len(self.wanted)))
        reason = np.zeros(len(values), dtype=np.uint8)
        if not self.still:
            reason[:] = NOT_STILL
        room = Room.of(len(self.paths), self.rows, min(AT_ONCE, len(values)))
        named = dict(zip(self.paths, room.columns[:, :, None], strict=True))
        for begin in range(0, len(values), AT_ONCE):
            some = slice(begin, begin + AT_ONCE)
            room.columns[:, : len(values[some])] = values[some].T
            if begin == 0 or self.polar:
                machine = with_columns(self.base.machine, named)
            self._fill(figures[some], reason[some], machine, room)
        figures[reason != 0] = np.nan
        return figures, reason

    def _fill(self, figures: Array, reason: Array, machine: Machine, room: Room) -> None:
        count = len(reason)
        columns, parameters, found = room
        rows = (value for link in self.links for value in parameters_of(machine.links[link]))
        with np.errstate(all="ignore"):
            for row, value in zip(parameters[:-1], rows, strict=True):
                row[:] = np.ravel(value)
            np.matmul(self.rows, parameters, out=found)
            for k, (square, ends) in enumerate(zip(self.squares, pairwise(self.ends), strict=True)):
                figures[:, k] = square.of(found[slice(*ends), :count])
        if not self._all_usual(columns[:, :count]):
            named = dict(zip(self.paths, columns[:, :, None], strict=True))
            reason[wrong(machine, self.base, named)[:count]] = NO_MACHINE

    def _all_usual(self, columns: Array) -> bool:
        """Whether a glance at numbers (d, P) tells that all of these designs are machines."""
        low, high = columns.min(axis=1), columns.max(axis=1)
        usual = (low >= -HUGE) & (high <= HUGE)
        usual &= (low >= TINY) | (high <= -TINY)
        return bool(usual.all() and np.all(low[self.not_negative] > 0))

    # -- made once ---------------------------------------------------------------------------------

    def _squares(self, angles: int | None, tolerance: float) -> list[Square]:
        """Every figure, with as many crank angles as its Gram matrix asks for."""
        count = angles or FIRST
        found = self._signals(count)
        if angles is None:
            enough = max(EXACT, tolerance**2)
            while True:
                before, count = found, 2 * count
                if count > MOST_ANGLES:
                    self.still = False
                    break
                found = self._signals(count)
                if all(
                    _alike(old * self.scale, new * self.scale, enough)
                    for old, new in zip(before, found, strict=True)
                ):
                    break
        return [self._square(a, f) for a, f in zip(found, self.wanted, strict=True)]

    def _signals(self, count: int) -> list[Array]:
        """For each figure the samples (N', V + 1) of a unit of each parameter, and of the rest."""
        motion = move(self.base.machine, count)
        unit, whole = regressor(motion), forces(motion)
        both = Found(motion, unit), Found(motion, whole)
        return [np.column_stack([*self._parts(f.signal, *both)]) for f in self.wanted]

    def _parts(self, signal: str, unit: Found, whole: Found) -> Iterator[Array]:
        """Columns of a signal over the cycle, one below the other where it has two components."""
        rows = np.stack([*_components(signal, unit)])
        own = np.stack([*_components(signal, whole)])
        machine = self.base.machine
        varied = [k for k, (link, _) in enumerate(parameter_names(machine)) if link in self.links]
        for k in varied:
            yield rows[:, k].ravel()
        yield (
            own - np.tensordot(rows[:, varied], parameter_values(machine)[varied], (1, 0))
        ).ravel()

    def _square(self, samples: Array, figure: Figure) -> Square:
        count = len(samples)
        if figure.name == "mean":
            row = np.mean(samples, axis=0)[None]
            return Square(row[:, :-1], row[:, -1:], True)
        if _is_vector(figure.signal):
            count //= 2
        _, singular, rows = np.linalg.svd(samples * self.scale, full_matrices=False)
        kept = singular > RANK * singular[0]
        factor = (singular[:, None] * rows)[kept] / (self.scale * np.sqrt(count))
        return Square(factor[:, :-1], factor[:, -1:], False)


def _scales(machine: Machine, links: int) -> Array:
    """What parameters of so many links are like in a machine of this mass and size."""
    mass = machine.mass or 1.0
    size = max(size_of(link.points) for link in machine.links.values()) or 1.0
    return np.tile([mass, mass * size, mass * size, mass * size**2], links)


def _is_vector(signal: str) -> bool:
    """Whether a signal is the length of a vector."""
    found = declared(signal)
    return found is not None and found[0].is_vector


def _components(signal: str, found: Found) -> Iterator[Array]:
    """One or two components of a signal, (..., N)."""
    one, item = declared(signal) or (None, "")
    if one is None or item not in one.items_of(found):
        raise UsageError(f"got {signal!r}; the machine has no such signal")
    whole = one.component(one.vector(found, item))
    yield whole.real
    if one.is_vector:
        yield whole.imag


def _alike(one: Array, other: Array, tolerance: float) -> bool:
    """Whether the Gram matrices of samples at two numbers of crank angles agree."""
    first, second = (samples.T @ samples / len(samples) for samples in (one, other))
    sizes = np.sqrt(np.diag(second))
    sizes = np.maximum(sizes, NOTHING * np.max(sizes))
    close = np.abs(first - second) <= tolerance * np.outer(sizes, sizes)
    return bool(np.all(close))
