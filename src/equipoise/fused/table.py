"""Designs as a table: the numbers that a loop needs, one row a design."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from equipoise.fused.sizes import sizes_of
from equipoise.fused.source import Source
from equipoise.mechanism.columns import linkage_of, with_columns, wrong
from equipoise.mechanism.linkage import Linkage
from equipoise.mechanism.model import Machine

Array = np.ndarray[Any, Any]


@dataclass(frozen=True, eq=False)
class Designs:
    """Some designs (P) of a machine.

    table : (P, T) numbers, as the source wants them.
    refused : (P,) whether no machine can have them; those have the numbers of the base.
    machine : the machine with their numbers as columns.
    """

    source: Source
    table: Array
    refused: Array
    machine: Machine

    def sizes(self, some: Array) -> Mapping[str, Any]:
        """Size of each signal of some of the designs, (K,) or one for all."""
        found = sizes_of(self.machine, self.source.gathered.signals)
        return {name: size[some, 0] if np.ndim(size) else size for name, size in found.items()}


def table_of(source: Source, base: Linkage, paths: Sequence[str], values: Array) -> Designs:
    """Designs of a base by the numbers (P, d) that vary, SI units, and their paths."""
    columns = {path: values[:, k, None] for k, path in enumerate(paths)}
    machine = with_columns(base.machine, columns)
    refused = np.zeros(len(values), dtype=bool) | wrong(machine, base, columns)
    found = linkage_of(machine, base)
    table = np.empty((len(values), sum(1 + slot.vector for slot in source.slots)))
    place = 0
    for slot in source.slots:
        width = 1 + slot.vector
        value, own = slot.read(found), slot.read(base)
        parts = ("real", "imag")[:width]
        for column, part in zip(table[:, place : place + width].T, parts, strict=True):
            column[:] = np.ravel(np.real(getattr(value, part)))
            column[refused] = getattr(own, part)
        place += width
    return Designs(source, table, refused, machine)
