"""The steps of one linkage in C: ``state`` fills in signals at a crank angle."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from equipoise.codegen.emission import C, Lines
from equipoise.codegen.source import TermSource
from equipoise.codegen.terms import ANGLE, BOTH, DESIGN, Term, reached, substituted
from equipoise.codegen.trace import AngleFunction
from equipoise.errors import UsageError
from equipoise.i18n import Note
from equipoise.mechanism.assembly.linkage import Linkage

HEAD = """\
#include <math.h>
#include <stddef.h>

static double pick(const double *table, size_t count, double place)
{
    const double last = (double)(count - 1);
    return table[(size_t)fmin(fmax(place, 0.0), last)];
}
"""
GIVEN = ("speed", "acceleration")
"""Numbers of the drive that are handed to the function."""


def in_c(source: TermSource, linkage: Linkage, names: Sequence[str]) -> str:
    """C of ``state(theta, speed, acceleration, out)``, which fills in the signals of these names.

    Raises
    ------
    UsageError : a load changes over the crank angle.
    """
    values = [source.values[name] for name in names]
    outputs = substituted(values, dict(_known(source, linkage, values)))
    lines = Lines(outputs, C)
    body = [*lines.write((ANGLE, DESIGN, BOTH), outputs)]
    body += [f"out[{k}] = {lines.text(output)};" for k, output in enumerate(outputs)]
    arguments = ["double theta", *(f"double {item}" for item in GIVEN), "double *out"]
    head = f"static void state({', '.join(arguments)})"
    return "\n".join([HEAD, *lines.tables, head, "{", *(f"    {item}" for item in body), "}", ""])


def _known(source: TermSource, linkage: Linkage, values: list[Any]) -> Iterator[tuple[Term, Any]]:
    """Arguments, with the numbers and functions of the crank angle that take their place."""
    arguments = {item.args[0]: item for item in reached(values) if item.op == "argument"}
    for slot in source.slots:
        value = slot.read(linkage)
        for column, part in enumerate((value.real, value.imag)[: 1 + slot.vector], slot.column):
            term = arguments.get(f"d{column}")
            if term is not None and slot.name in GIVEN:
                yield term, term.graph.argument(slot.name, DESIGN)
            elif term is not None:
                yield term, float(part)
    for row in source.rows:
        if row.name in arguments:
            yield arguments[row.name], _of_angle(row)


def _of_angle(row: AngleFunction) -> Any:
    """What depends on the crank angle, or does not but might."""
    if row.formula is not None:
        return row.formula
    first, *others = row.values(np.linspace(0.0, 6.0, 7)).tolist()
    if others != [first] * len(others):
        raise UsageError(
            Note(
                "{what} changes over the crank angle in a way that has no formula in C",
                what=row.what,
            )
        )
    return first
