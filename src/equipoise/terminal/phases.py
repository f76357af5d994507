"""What `equipoise balance` prints of the phases of rows, and of patterns to choose from."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from equipoise.balancing.multi_row import Rows
from equipoise.balancing.patterns import Pattern, arranged, patterns_for
from equipoise.balancing.phase_cost import Term
from equipoise.mechanism.balance import Objective
from equipoise.terminal.tables import angle, number, table

if TYPE_CHECKING:
    from collections.abc import Iterable

    from equipoise.balancing.phase_search import Phasing
    from equipoise.mechanism.model import Machine

MOST_ORDERS = 8
"""That are named one by one."""
LATERAL = {"roll_moment": "roll moment", "yaw_moment": "yaw moment"}


def phasing_told(found: Phasing) -> str:
    """Rows with their phases, what is left of the shaking force and how it twists."""
    return f"{_rows(found)}\n\n{_left(found.remaining)}\n{_lateral(found)}"


def _rows(found: Phasing) -> str:
    rows = []
    for count, row in enumerate(found.machine.rows, 1):
        offset = tuple(number(1e3 * value) for value in row.offset)
        rows.append((str(count), number(1e3 * row.lateral), *offset, _degrees(row.phase)))
    header = ("row", "lateral mm", "offset x mm", "offset y mm", "phase deg")
    return table("Rows; the phase is the angle by which the crank is ahead", header, rows)


def _degrees(phase: float) -> str:
    return angle(phase).removesuffix(".0")


def _left(orders: Iterable[float]) -> str:
    told = [f"{order:.4g}" for order in orders]
    if not told:
        return "no order of the shaking force is left"
    more = " and higher ones" if len(told) > MOST_ORDERS else ""
    return f"orders of the shaking force that are left: {', '.join(told[:MOST_ORDERS])}{more}"


def _lateral(found: Phasing) -> str:
    whole = max(max(values) for values in found.lateral.values())
    rows = [
        (LATERAL[name], *(number(value, 1e3 * whole) for value in values))
        for name, values in found.lateral.items()
    ]
    return table("Twist by the shaking force, RMS, N m", ("", "before", "after"), rows)


# -- patterns --------------------------------------------------------------------------------------


def print_patterns(machine: Machine, rows: int, spacing: float) -> None:
    """Patterns for a number of rows at a spacing (m): what each leaves, and how it twists."""
    print(machine.title)
    print(f"{rows} rows, {number(1e3 * spacing)} mm from row to row")
    patterns = patterns_for(rows)
    phases = [(p.name, " ".join(map(_degrees, p.phases)), p.source) for p in patterns]
    print(table("Patterns", ("", "phases of the rows, deg", "printed in"), phases, words=3))
    told = [(p.name, _orders(p), "yes" if p.twists else "no") for p in patterns]
    title = "What is left, up to the order from which it repeats"
    print(table(title, ("", "orders left, of how many rows", "twist"), told, words=3))
    figures = [
        (name, *_figures(laid))
        for name, laid in [
            ("all in phase", arranged(machine, _in_phase(rows), spacing)),
            *((p.name, arranged(machine, p, spacing)) for p in patterns),
        ]
    ]
    header = ("", "shaking force N", "roll moment N m", "yaw moment N m")
    print(table("Figures of this machine; RMS", header, figures))


def _in_phase(rows: int) -> Pattern:
    return Pattern("", ((0, 1),) * rows)


def _orders(pattern: Pattern) -> str:
    return ", ".join(f"{order} of {rows:.4g}" for order, rows in pattern.remaining.items())


def _figures(machine: Machine) -> tuple[str, ...]:
    rows = Rows(machine)
    phases = np.array([row.phase for row in machine.rows])
    found = []
    for output in ("shaking_force", *LATERAL):
        term = Term(Objective(output), rows.signals(Objective(output)))
        found.append(number(float(term.values(phases)), 10 * term.single))
    return tuple(found)
