"""The steps of a linkage in other languages, for programs without Python: JavaScript and C.

A script gives signals of one design over crank angles, with numbers that it is handed; ``state`` in
C fills in signals of one linkage at a crank angle.

JavaScript's engines stop optimising functions beyond some size, so that the lines stand in several,
each of which goes over all crank angles; what one hands to another lies in arrays.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from equipoise.codegen.emit import emit
from equipoise.codegen.figures import Gathered
from equipoise.codegen.source import JAVASCRIPT, C, Lines, TermSource, boundary
from equipoise.codegen.terms import (
    ANGLE,
    BOTH,
    DESIGN,
    Graph,
    Term,
    as_value,
    reached,
    substituted,
)
from equipoise.codegen.trace import AngleFunction
from equipoise.dataclass import dataclass
from equipoise.errors import UsageError
from equipoise.i18n import Note
from equipoise.mechanism.assembly.family import linkage_of, with_columns
from equipoise.mechanism.assembly.linkage import Linkage
from equipoise.signals import Array

NO_NUMBERS: Mapping[str, float] = {}
MOST_LINES = 150
"""Of a function: longer ones are interpreted, which takes a hundred times as long."""
PICK = """\
function pick(table, place) {
    return table[Math.min(Math.max(place, 0), table.length - 1) | 0];
}"""


@dataclass(frozen=True)
class Script:
    """Source of ``states(design, grid, angles, out)``, with what has to be handed to it.

    All are typed arrays, by rows: `grid` has a row for each number that depends on the crank angle
    alone, and `out` one for each signal; `angles` is their number of columns.

    names : of the signals, in the order of the rows of `out`.
    paths : of the numbers of the model file that stand in `design`, SI units; where there are none
        it has those that `numbers` finds.
    cyclic : places in `design`, by their names, of what takes the motion over a cycle to find, such
        as the height of the soil's surface; behind the numbers.
    source : terms of the signals.
    """

    text: str
    names: tuple[str, ...]
    paths: tuple[str, ...]
    cyclic: Mapping[str, int]
    source: TermSource

    def numbers(self, linkage: Linkage) -> Array:
        """Numbers (T,) of a linkage of the same build, for a script without paths."""
        row = np.empty(self.source.width)
        for slot in self.source.slots:
            value = complex(slot.read(linkage))
            row[slot.column : slot.column + 1 + slot.vector] = (value.real, value.imag)[
                : 1 + slot.vector
            ]
        return row

    def grid(self, theta: Array) -> Array:
        """Rows (G, N) of the grid at crank angles (N,), rad."""
        return self.source.grid(theta)


def javascript(
    linkage: Linkage, names: Sequence[str], numbers: Mapping[str, float] = NO_NUMBERS
) -> Script:
    """Signals of a linkage, by their names in the output of an analysis.

    numbers : that are handed to the script, in this order, by their paths, such as
        ``links.crank.points.B.x``, with what they are here; the others are those of the machine.

    Raises
    ------
    UsageError : there is no such signal, or the linkage cannot be had in compiled loops; there is
        no such number, or what follows from it cannot be written.
    MassError : a signal needs masses, and the machine lacks some.
    """
    wanted = Gathered(tuple((name, "squares") for name in names))
    source = emit(linkage, wanted, numbers or None, alone=True)
    outputs = [source.values[name] for name in names]
    slots = [slot for slot in source.slots if slot.cyclic]
    cyclic = {slot.name: slot.column for slot in slots}
    if numbers:
        cyclic = {slot.name: place for place, slot in enumerate(slots, len(numbers))}
        outputs = _of_numbers(source, linkage, outputs, numbers, cyclic)
    text = "\n".join(_Writer(source, outputs).lines()) + "\n"
    return Script(text, tuple(names), tuple(numbers), cyclic, source)


def _of_numbers(
    source: TermSource,
    linkage: Linkage,
    outputs: list[Any],
    numbers: Mapping[str, float],
    cyclic: Mapping[str, int],
) -> list[Any]:
    """Outputs with what follows from these numbers in the place of slots, but for those that take a
    cycle to find; cyclic : places of these.
    """
    graph = next((item.graph for item in reached(outputs)), Graph())
    columns: dict[str, Any]
    columns = {path: graph.argument(f"n{k}", DESIGN) for k, path in enumerate(numbers)}
    graph.base |= {f"n{k}": number for k, number in enumerate(numbers.values())}
    try:
        result = linkage_of(with_columns(linkage.machine, columns), linkage)
        values: dict[Term, Any] = {}
        for slot in source.slots:
            if slot.cyclic:
                place = f"n{cyclic[slot.name]}"
                values[graph.argument(f"d{slot.column}", DESIGN)] = graph.argument(place, DESIGN)
                continue
            value = slot.read(result)
            for k, part in enumerate((value.real, value.imag)[: 1 + slot.vector], slot.column):
                values[graph.argument(f"d{k}", DESIGN)] = as_value(part)
    except (TypeError, AttributeError) as error:
        raise UsageError(
            Note("what follows from these numbers cannot be written: {error}", error=str(error))
        ) from None
    return substituted(outputs, values)


class _Writer:
    """Lines of a script.

    own, by_angle : what the design, and the crank angle alone, decide, of which others are made.
    """

    def __init__(self, source: TermSource, outputs: list[Any]) -> None:
        self.outputs = outputs
        self.by_angle = boundary(source.outputs, ANGLE)
        self.own = boundary(self.outputs, DESIGN)
        known = {item: f"r{k}" for k, item in enumerate(self.by_angle)}
        self.script = Lines(self.outputs, JAVASCRIPT, known)

    def lines(self) -> list[str]:
        script = self.script
        given = [
            f"const {term.args[0]} = design[{term.args[0][1:]}];"
            for term in script.terms
            if term.op == "argument" and term.mask == DESIGN
        ]
        setting = [*given, *script.write((DESIGN,), self.own)]
        parts = self._parts()
        makers = {item: k for k, (_, _, terms) in enumerate(parts) for item in terms}
        crossing = {
            fromkey: row
            for row, fromkey in enumerate(
                dict.fromkeys(
                    item for k, (_, used, _) in enumerate(parts) for item in used
                    if makers.get(item, k) < k
                )
            )
        }  # fmt: skip
        functions = [
            line for k, part in enumerate(parts) for line in self._function(k, *part, crossing)
        ]
        own = ", ".join(map(script.text, self.own))
        return [
            *script.tables,
            PICK,
            *functions,
            "function states(design, grid, angles, out) {",
            *(f"    {line}" for line in setting),
            f"    const own = [{own}];",
            f"    const work = new Float64Array({len(crossing)} * angles);",
            *(f"    part{k}(own, grid, work, angles, out);" for k in range(len(parts))),
            "}",
        ]

    def _parts(self) -> list[tuple[list[str], list[Term], list[Term]]]:
        """Lines of each function, with the terms that they use, and those that they name."""
        script = self.script
        parts: list[tuple[list[str], list[Term], list[Term]]] = [([], [], [])]

        def put(line: str, terms: Sequence[Term]) -> None:
            if len(parts[-1][0]) == MOST_LINES:
                parts.append(([], [], []))
            part, used, named = parts[-1]
            part.append(line)
            used += sorted(script.used, key=lambda item: item.order)
            named += terms
            script.used.clear()

        script.used.clear()
        before = len(script.names)
        # where designs differ in few numbers, much depends on the crank angle alone that did not
        for line in script.write((ANGLE, BOTH)):
            put(line, [*script.names][before:])
            before = len(script.names)
        for k, output in enumerate(self.outputs):
            put(f"out[{k} * angles + k] = {script.text(output)};", ())
        return parts

    def _function(
        self,
        number: int,
        lines: list[str],
        used: list[Term],
        terms: list[Term],
        crossing: dict[Term, int],
    ) -> list[str]:
        script, needed = self.script, dict.fromkeys(used)
        own = [k for k, item in enumerate(self.own) if item in needed]
        rows = [k for k, item in enumerate(self.by_angle) if item in needed]
        taken = [item for item in crossing if item in needed and item not in terms]
        return [
            f"function part{number}(own, grid, work, angles, out) {{",
            *(f"    const {script.names[self.own[k]]} = own[{k}];" for k in own),
            "    for (let k = 0; k < angles; k++) {",
            *(f"        const r{row} = grid[{row} * angles + k];" for row in rows),
            *(
                f"        const {script.names[item]} = work[{crossing[item]} * angles + k];"
                for item in taken
            ),
            *(f"        {line}" for line in lines),
            *(
                f"        work[{row} * angles + k] = {script.names[item]};"
                for item, row in crossing.items()
                if item in terms
            ),
            "    }",
            "}",
        ]


# -- C ---------------------------------------------------------------------------------------------

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
