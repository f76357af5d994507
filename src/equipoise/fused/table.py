"""Designs as a table: the numbers that a loop needs, one row a design."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from equipoise.fused.source import Source
from equipoise.mechanism.columns import linkage_of, with_columns, wrong
from equipoise.mechanism.linkage import Linkage

Array = np.ndarray[Any, Any]


def table_of(
    source: Source, base: Linkage, paths: Sequence[str], values: Array
) -> tuple[Array, Array]:
    """Table (P, T) of designs (P, d), and which of them (P,) no machine can have.

    Those have the numbers of the base.  paths : of the numbers that vary.
    """
    columns = {path: values[:, k, None] for k, path in enumerate(paths)}
    machine = with_columns(base.machine, columns)
    refused = wrong(machine, base, len(values))
    found = linkage_of(machine, base)
    table = np.empty((len(values), sum(1 + slot.vector for slot in source.slots)))
    place = 0
    with np.errstate(all="ignore"):
        for slot in source.slots:
            value = np.asarray(slot.read(found))
            table[:, place] = _flat(value.real)
            if slot.vector:
                table[:, place + 1] = _flat(value.imag)
            place += 1 + slot.vector
    if refused.any():
        own = np.array(
            [[part for slot in source.slots for part in _parts(slot.read(base), slot.vector)]]
        )
        table[refused] = own
    return table, refused


def _flat(value: Array) -> Any:
    return value[:, 0] if value.ndim == 2 else value


def _parts(value: Any, vector: bool) -> list[float]:
    number = complex(value)
    return [number.real, number.imag] if vector else [number.real]
