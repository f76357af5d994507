"""The equal linkages of a machine, `[[rows]]`, in the states of its drives.

The states of all rows stand side by side in the last axis of arrays (..., R K), one row after the
other, so that the linkage is computed once for all of them.  What the rows share, such as rotors, a
support, and torques on the shafts that turn them all, is divided among them.
"""

from __future__ import annotations

from functools import cached_property

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.mechanism.parts.machine import Machine
from equipoise.mechanism.parts.support import Row
from equipoise.signals import Array
from equipoise.vibration.linkages import rows_of


@dataclass(frozen=True, eq=False)
class LinkageRows:
    """The R rows of a machine; the linkage of the file where it has none."""

    machine: Machine

    @cached_property
    def all(self) -> tuple[Row, ...]:
        """Phase and place of each row."""
        return rows_of(self.machine)

    @property
    def count(self) -> int:
        """How many rows."""
        return len(self.all)

    @cached_property
    def phases(self) -> Array:
        """(R,), rad, by which crank angles are larger than that of the drive."""
        return np.array([row.phase for row in self.all])

    @property
    def as_in_file(self) -> bool:
        """Whether there is one linkage, whose crank angle is that of the drive."""
        return self.count == 1 and not self.all[0].phase

    @cached_property
    def offsets(self) -> Array:
        """(R,), m, complex, of the planes of the rows beside the linkage of the file."""
        return np.array([complex(*row.offset) for row in self.all])

    @cached_property
    def laterals(self) -> Array:
        """(R,), m, z of the planes of the rows."""
        return np.array([row.lateral for row in self.all])

    def repeated(self, values: Array) -> Array:
        """(..., R K) of what is the same in all rows (..., K)."""
        return np.tile(values, self.count) if self.count > 1 else values

    def of_each(self, values: Array, count: int) -> Array:
        """(..., R K) of what differs by the row alone (..., R), in so many states K."""
        return np.repeat(values, count, axis=-1)

    def apart(self, values: Array) -> Array:
        """(..., R, K) of values (..., R K)."""
        return values.reshape(*values.shape[:-1], self.count, values.shape[-1] // self.count)

    def joined(self, values: Array) -> Array:
        """(..., R K) of values (..., R, K)."""
        return values.reshape(*values.shape[:-2], -1)

    def total(self, values: Array) -> Array:
        """Sums (..., K) over the rows of values (..., R K)."""
        return np.asarray(self.apart(values).sum(axis=-2)) if self.count > 1 else values

    def first(self, values: Array) -> Array:
        """(..., K) of the first row, of values (..., R K)."""
        return values[..., : values.shape[-1] // self.count]
