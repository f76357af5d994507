"""Designs that differ in masses alone: mean squares without going round the cycle again.

Every output is linear in the inertial parameters (`mechanism.dynamics.parameters`).  So the mean
square of one is a quadratic form in them, whose Gram matrix is the same for all designs.  It is
kept as a factor, A = U S W', of which U is not needed: a sum of few squares loses no digits where
outputs nearly cancel, as the Gram matrix itself would.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import chain, pairwise

import numpy as np

from equipoise.codegen.figures import COMPUTED, MOST_ANGLES, NO_MACHINE, NOT_STILL, Figure
from equipoise.decompositions import svd
from equipoise.errors import UsageError
from equipoise.i18n import Note
from equipoise.keys.paths import KeyPath
from equipoise.mechanism.assembly.family import (
    can_vary,
    invalid_designs,
    massive_link,
    with_columns,
)
from equipoise.mechanism.assembly.linkage import assemble
from equipoise.mechanism.dynamics.forces import forces
from equipoise.mechanism.dynamics.parameters import (
    parameter_names,
    parameter_values,
    parameters_of,
    regressor,
)
from equipoise.mechanism.kinematics.jumps import resolved
from equipoise.mechanism.kinematics.motion import move
from equipoise.mechanism.outputs.declared import Declared, OutputSource, declared
from equipoise.mechanism.parts.machine import Machine, size_of
from equipoise.quantities.units import HUGE, TINY
from equipoise.signals import Array

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
    masses = all(massive_link(path) is not None and can_vary(machine, path) for path in paths)
    return masses and all(_can_have(machine, figure) for figure in wanted)


def _can_have(machine: Machine, figure: Figure) -> bool:
    """Lengths have no linear mean; where a contact changes sides, it is masses that decide it."""
    item, _ = declared(figure.signal) or (None, "")
    if item is None or item.needs != "masses" or not item.loop:
        return False
    return item.linear_in(machine) and (
        figure.name == "rms" or (figure.name == "mean" and not item.is_vector)
    )


class MassBatch:
    """Designs of one machine that differ in masses; parameters as those of `Batch`.

    rows : (R, V + 1) of all figures: what a unit of each parameter gives, and what the rest does.
    ends : where those of each figure begin and end.
    """

    def __init__(
        self,
        machine: Machine,
        paths: Sequence[str],
        wanted: Sequence[Figure],
        angles: int | None = None,
        tolerance: float = 1e-4,
    ) -> None:
        if not can_use(machine, paths, wanted):
            raise UsageError(Note("these designs or figures need the motion over the whole cycle"))
        self.base, self.paths, self.wanted = assemble(machine), tuple(paths), tuple(wanted)
        links = {massive_link(path) for path in paths}
        self.links = [link for link in machine.links if link in links]
        self.outputs = [result for figure in wanted if (result := declared(figure.signal))]
        self.scale = np.append(_scales(machine, len(self.links)), 1.0)
        self.still = True
        rows = [*map(self._factor, self._settled(angles, tolerance), self.wanted, self.outputs)]
        self.rows = np.concatenate(rows)
        self.ends = np.cumsum([0, *map(len, rows)])
        # What follows from a number in more than one step is computed anew.
        steps = [KeyPath.parse(path) for path in paths]
        self.anew = any(p[-1] in ("distance", "direction") or p[2] == "bodies" for p in steps)
        self.not_negative = [k for k, p in enumerate(steps) if p[-1] in ("mass", "inertia")]

    def __call__(self, values: Array) -> tuple[Array, Array]:
        """Figures (P, m) and reasons (P,) of designs (P, d), SI units; NaN where one failed."""
        figures = np.empty((len(values), len(self.wanted)))
        reason = np.full(len(values), COMPUTED if self.still else NOT_STILL, np.uint8)
        # Room for some designs at a time; to have it anew each time takes as long again.
        heights = len(self.paths), *reversed(self.rows.shape)
        room = [np.ones((height, min(AT_ONCE, len(values)))) for height in heights]
        columns, parameters, result = room
        named = dict(zip(self.paths, columns[:, :, None], strict=True))
        for begin in range(0, len(values), AT_ONCE):
            some = slice(begin, begin + AT_ONCE)
            count = len(values[some])
            columns[:, :count] = values[some].T
            with np.errstate(all="ignore"):
                if begin == 0 or self.anew:
                    machine = with_columns(self.base.machine, named)
                inertial = chain(*(parameters_of(machine.links[link]) for link in self.links))
                for row, value in zip(parameters[:-1], inertial, strict=True):
                    row[:] = np.ravel(value)
                np.matmul(self.rows, parameters, out=result)
                for k, ends in enumerate(pairwise(self.ends)):
                    part = result[slice(*ends), :count]
                    if self.wanted[k].name == "mean":
                        figures[some, k] = part[0]
                    else:
                        figures[some, k] = np.sqrt(np.einsum("ij,ij->j", part, part))
            if self.anew or not self._all_usual(columns[:, :count]):
                reason[some][invalid_designs(machine, self.base, named)[:count]] = NO_MACHINE
        figures[reason != COMPUTED] = np.nan
        return figures, reason

    def _all_usual(self, columns: Array) -> bool:
        """Whether numbers (d, P) are all of usual size and sign: all designs are machines then."""
        low, high = columns.min(axis=1), columns.max(axis=1)
        usual = (low >= -HUGE) & (high <= HUGE)
        usual &= (low >= TINY) | (high <= -TINY)
        return bool(usual.all() and np.all(low[self.not_negative] > 0))

    # -- made once ---------------------------------------------------------------------------------

    def _settled(self, angles: int | None, tolerance: float) -> list[Array]:
        """Samples for every figure, at as many crank angles as its Gram matrix asks for."""
        if angles is not None:
            return self._samples(angles)
        enough, count = max(EXACT, tolerance**2), FIRST
        arrays = self._samples(count)
        while 2 * count <= MOST_ANGLES:
            count *= 2
            before, arrays = arrays, self._samples(count)
            both = zip(before, arrays, strict=True)
            if all(_alike(old * self.scale, new * self.scale, enough) for old, new in both):
                return arrays
        self.still = False
        return arrays

    def _samples(self, count: int) -> list[Array]:
        """For each figure the samples (N', V + 1) of a unit of each parameter, and of the rest.

        Those of two components stand one below the other.  Where forces jump, samples come times
        `roots`, so that the mean of their squares is that over time.
        """
        machine = self.base.machine
        motion = resolved(move(machine, count))
        unit, whole = OutputSource(motion, regressor(motion)), OutputSource(motion, forces(motion))
        varied = [k for k, (link, _) in enumerate(parameter_names(machine)) if link in self.links]
        own = parameter_values(machine)[varied]
        arrays = []
        self.roots: Array | float = 1.0
        if motion.shares is not None:
            self.roots = np.sqrt(motion.shares * len(motion.shares))
        for output in self.outputs:
            rows = _components(*output, unit)[:, varied]
            rest = _components(*output, whole) - np.tensordot(rows, own, (1, 0))
            columns = [*np.moveaxis(rows, 1, 0), rest]
            if motion.shares is not None:
                columns = [column * self.roots for column in columns]
            arrays.append(np.column_stack([column.ravel() for column in columns]))
        return arrays

    def _factor(self, samples: Array, figure: Figure, output: tuple[Declared, str]) -> Array:
        """Rows (R, V + 1) whose products with parameters and 1 are a mean, or have its squares."""
        if figure.name == "mean":
            roots = np.reshape(self.roots, (-1, 1))
            mean: Array = np.mean(samples * roots, axis=0, keepdims=True)
            return mean
        count = len(samples) // (2 if output[0].is_vector else 1)
        _, singular, rows = svd(samples * self.scale, full_matrices=False)
        significant = singular > RANK * singular[0]
        factor: Array = (singular[:, None] * rows)[significant] / (self.scale * np.sqrt(count))
        return factor


def _scales(machine: Machine, links: int) -> Array:
    """What parameters of so many links are like in a machine of this mass and size."""
    mass = machine.mass or 1.0
    size = max(size_of(link.points) for link in machine.links.values()) or 1.0
    return np.tile([mass, mass * size, mass * size, mass * size**2], links)


def _components(declared: Declared, item: str, source: OutputSource) -> Array:
    """The one or two components of an output, (1 or 2, ..., N)."""
    if item not in declared.items_of(source):
        raise UsageError(
            Note("got {named!r}; the machine has no such signal", named=declared.named(item))
        )
    whole = declared.component(declared.vector(source, item))
    return np.stack([whole.real, whole.imag] if declared.is_vector else [whole.real])


def _alike(first_samples: Array, other: Array, tolerance: float) -> bool:
    """Whether the Gram matrices of samples at two numbers of crank angles agree."""
    first, second = (samples.T @ samples / len(samples) for samples in (first_samples, other))
    sizes = np.sqrt(np.diag(second))
    sizes = np.maximum(sizes, NOTHING * np.max(sizes))
    close = np.abs(first - second) <= tolerance * np.outer(sizes, sizes)
    return bool(np.all(close))
