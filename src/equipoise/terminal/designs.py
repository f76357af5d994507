"""Designs of a study as tables: one row a design, as many tables as their columns need."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from equipoise.terminal.tables import number, table

if TYPE_CHECKING:
    from equipoise.schema.study_units import Unit
    from equipoise.studies.design_space import Make, Output

Array = np.ndarray[Any, Any]

WIDTH, PART = 96, 16
"""Most signs in a line of a table, and about as many in a line of a column's head."""
GAP = 2


def columns_of(
    numbers: Sequence[str], values: Array, outputs: Sequence[str], figures: Array
) -> dict[str, Array]:
    """Columns (K,) of designs by name: values (K, d) of numbers, figures (K, m) of outputs."""
    columns = {name: values[:, k] for k, name in enumerate(numbers)}
    return columns | {name: figures[:, k] for k, name in enumerate(outputs)}


def designs_table(
    title: str,
    labels: Sequence[str],
    columns: Mapping[str, Array],
    units: Mapping[str, Unit],
    head: str = "design",
) -> str:
    """Designs (K), one row each, with columns (K,) in SI units by name."""
    heads = [header(name, units[name].name) for name in columns]
    cells = [
        [number(units[name].of_si(float(value))) for value in column]
        for name, column in columns.items()
    ]
    first = max(len(head), *map(len, labels))
    parts: list[str] = []
    for part in _fitting(heads, cells, first):
        rows = zip(labels, *(cells[k] for k in part), strict=True)
        header_row = (head, *(heads[k] for k in part))
        parts.append(table(title if not parts else f"{title}, further", header_row, rows, words=0))
    return "\n".join(parts)


def _fitting(
    heads: Sequence[str], cells: Sequence[Sequence[str]], first: int
) -> Iterator[list[int]]:
    """Columns that stand side by side, beside one that is so wide."""
    part: list[int] = []
    wide = first
    for k, (head, column) in enumerate(zip(heads, cells, strict=True)):
        own = GAP + max(map(len, (*head.splitlines(), *column)))
        if part and wide + own > WIDTH:
            yield part
            part, wide = [], first
        part.append(k)
        wide += own
    yield part


def header(name: str, unit: str) -> str:
    """Name of a column in lines of about equal length, with its unit in the last one."""
    lines = [""]
    for part in _parts(name):
        if lines[-1] and len(lines[-1]) + len(part) > PART:
            lines.append("")
        lines[-1] += part
    return "\n".join([*lines, unit] if unit else lines)


def _parts(name: str) -> Iterator[str]:
    """Parts of a dotted name, each with the point in front of it."""
    first, *others = name.split(".")
    yield first
    for other in others:
        yield f".{other}"


def labelled(name: str, unit: str) -> str:
    """A name with its unit in one line."""
    return f"{name} {unit}".strip()


def wanted(by: Mapping[str, Make]) -> str:
    """Such as ``vertical smallest, swing largest``."""
    return ", ".join(f"{name} {way}" for name, way in by.items())


def limits(outputs: Iterable[Output], units: Mapping[str, Unit]) -> list[str]:
    """Every limit as one says it, such as ``vertical at most 12.00 N``."""
    told = []
    for output in outputs:
        unit = units[output.name]
        for words, limit in (("at least", output.at_least), ("at most", output.at_most)):
            if limit is not None:
                told.append(
                    f"{output.name} {words} {number(unit.of_si(limit))} {unit.name}".strip()
                )
    return told
