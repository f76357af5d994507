"""Arrangements of rows in fixed phases: Table 5 of Yamashita, Ichikawa and Mori, and its rule.

Rows that differ by phase only leave of order n the share |sum_k exp(i n phi_k)| of one row's
amplitude: the number of rows that are in phase there.  Their force twists the machine, about the
axes x and y, by the lever |sum_k z_k exp(i n phi_k)| with z_k the lateral place.

The table has for four claws (a) 0, pi, 3 pi/2, pi/2 and (b) 0, pi, pi, 0; for six (a) 0, pi, 0, pi,
pi, 0, (b) 0, pi, pi, 0, 0, pi, (c) 0, pi, 0, pi, 3 pi/2, pi/2 and (d) 0, pi, 3 pi/2, pi/2, pi, 0.
Its properties are computed here: which orders of how many claws are left, and whether the rest
twists.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from math import gcd, lcm, pi
from typing import Any

import numpy as np

from equipoise.balancing.cylinder_phasing import PhasedRows, PhaseObjective
from equipoise.dataclass import dataclass
from equipoise.errors import UsageError
from equipoise.i18n import Note, say
from equipoise.mechanism.checks import unknown
from equipoise.mechanism.parts.balance import OF_ROWS, Objective
from equipoise.mechanism.parts.machine import Machine
from equipoise.mechanism.parts.support import Row
from equipoise.quantities import display, fixed, format_quantity, in_si
from equipoise.results.blocks import Block, Cell, Column, Table, Text, Value
from equipoise.results.outputs import output_named
from equipoise.signals import Array

ROUNDING = 1e-9
"""Rows, and spacings, that are rounding."""
TABLE = "Table 5"


@dataclass(frozen=True)
class Pattern:
    """Phases of rows side by side at equal spacing, as parts of a turn.

    parts : (numerator, denominator) of the turn by which each row's crank is ahead.
    source : where it is printed.
    """

    name: str
    parts: tuple[tuple[int, int], ...]
    source: str = ""

    @property
    def rows(self) -> int:
        return len(self.parts)

    @property
    def phases(self) -> tuple[float, ...]:
        """rad."""
        return tuple(2 * pi * top / bottom for top, bottom in self.parts)

    @property
    def cycle(self) -> int:
        """Orders after which everything repeats: all rows are in phase at its multiples."""
        return lcm(*(bottom // gcd(top, bottom) for top, bottom in self.parts))

    def in_phase(self, order: int) -> float:
        """How many rows' worth of an order is left."""
        return float(abs(np.sum(self._turned(order))))

    def lever(self, order: int) -> float:
        """Lever of an order's twist, in spacings of the rows, per row's force."""
        return float(abs(np.sum(np.array(self.places) * self._turned(order))))

    def _turned(self, order: int) -> Array:
        # Whole numbers first: what is left of a sum that vanishes is then rounding of one turn.
        parts = np.array([(order * top) % bottom / bottom for top, bottom in self.parts])
        return np.exp(2j * pi * parts)

    @property
    def places(self) -> tuple[float, ...]:
        """Lateral places in spacings, about the middle."""
        return tuple(k - (self.rows - 1) / 2 for k in range(self.rows))

    @property
    def remaining(self) -> Mapping[int, float]:
        """Order -> how many rows' worth is left, for the orders up to the cycle that are left."""
        orders = range(1, self.cycle + 1)
        return {n: rows for n in orders if (rows := self.in_phase(n)) > ROUNDING}

    @property
    def left(self) -> str:
        """Remaining orders, in words."""
        return ", ".join(f"{order} of {rows:.4g}" for order, rows in self.remaining.items())

    @property
    def twists(self) -> bool:
        """Whether any order has a roll or yaw moment."""
        return any(self.lever(order) > ROUNDING for order in range(1, self.cycle + 1))

    def to_dict(self) -> dict[str, Any]:
        """The machine-readable output; rad, rows and spacings."""
        return {
            "name": self.name,
            "source": self.source,
            "phases": list(self.phases),
            "cycle": self.cycle,
            "remaining": {str(order): rows for order, rows in self.remaining.items()},
            "levers": {str(n): self.lever(n) for n in range(1, self.cycle + 1)},
            "twists": self.twists,
        }


PATTERNS: dict[str, Pattern] = {
    name: Pattern(name, tuple((int(quarter), 4) for quarter in quarters), source)
    for name, quarters, source in (
        ("2 opposed", "02", "section 5-5"),
        ("4 quarter turns", "0231", f"{TABLE}, 4 claws (a)"),
        ("4 mirrored", "0220", f"{TABLE}, 4 claws (b)"),
        ("6 alternate", "020220", f"{TABLE}, 6 claws (a)"),
        ("6 in pairs", "022002", f"{TABLE}, 6 claws (b)"),
        ("6 quarter turns at the end", "020231", f"{TABLE}, 6 claws (c)"),
        ("6 quarter turns within", "023120", f"{TABLE}, 6 claws (d)"),
    )
}
"""Name -> pattern: what is printed, in quarters of a turn, one digit a row."""


def halved(rows: int) -> Pattern:
    """Rows by the rule (a) of section 5-6, for 2, 4, 8 ... rows.

    Two rows half a turn apart are a pair, which leaves the even orders; two pairs a quarter apart
    are four, which leave every fourth; and so on: orders that are no multiple of the number of rows
    vanish.

    Raises
    ------
    UsageError : the number of rows is no power of two.
    """
    if rows < 2 or rows & (rows - 1):
        raise UsageError(
            Note("got {rows} rows; halving needs 2, 4, 8 or another power of two", rows=rows)
        )
    parts = [0]
    while len(parts) < rows:
        parts += [part + rows // (2 * len(parts)) for part in parts]
    return Pattern(f"{rows} halved", tuple((part, rows) for part in parts), "section 5-6 (a)")


def patterns_for(rows: int) -> tuple[Pattern, ...]:
    """Patterns of a number of rows: those printed, by the rule of halving, and evenly spaced ones.

    Raises
    ------
    UsageError : there are fewer than two rows.
    """
    if rows < 2:
        raise UsageError(Note("got {rows} rows; give two at least", rows=rows))
    patterns = [pattern for pattern in PATTERNS.values() if pattern.rows == rows]
    if rows >= 8 and not rows & (rows - 1):
        patterns.append(halved(rows))
    if rows not in {2, 4}:  # where they are printed already
        patterns.append(Pattern(f"{rows} evenly spread", tuple((k, rows) for k in range(rows))))
    if rows >= 6 and rows % 2 == 0:
        half = [(k, rows // 2) for k in range(rows // 2)]
        patterns.append(Pattern(f"{rows} mirrored", (*half, *half[::-1])))
    return tuple(patterns)


def pattern_named(name: str) -> Pattern:
    """The pattern of a name, which begins with its number of rows.

    Raises
    ------
    UsageError : there is none.
    """
    first = name.partition(" ")[0]
    count = int(first) if first.isdecimal() and len(first) < 4 else 0
    known = {pattern.name: pattern for pattern in patterns_for(count)} if count > 1 else PATTERNS
    if name not in known:
        raise UsageError(unknown(name, known, "pattern"))
    return known[name]


def arranged(machine: Machine, pattern: str | Pattern, spacing: float | str) -> Machine:
    """The machine with rows side by side in a pattern, about the plane of the file.

    spacing : from row to row, m, or a text such as ``"300 mm"``.  An offset of the first row is
        kept.

    Raises
    ------
    UsageError : there is no such pattern, or the spacing is not above 0.
    """
    chosen = pattern_named(pattern) if isinstance(pattern, str) else pattern
    spacing = in_si(spacing, "length", "spacing")
    if not 0 < spacing < float("inf"):
        raise UsageError(Note("got a spacing of {spacing:g} m; give more than 0", spacing=spacing))
    offset = machine.rows[0].offset if machine.rows else (0.0, 0.0)
    return machine.with_rows(
        Row(phase, spacing * place, offset)
        for phase, place in zip(chosen.phases, chosen.places, strict=True)
    )


# -- what is shown ---------------------------------------------------------------------------------


def pattern_blocks(machine: Machine, rows: int, spacing: float) -> Iterator[Block]:
    """Patterns for a number of rows at a spacing (m): what each leaves, and how it twists."""
    apart = format_quantity(spacing, "length")
    yield Text(say("{rows} rows, {apart} from row to row", rows=rows, apart=apart))
    patterns, unit = patterns_for(rows), display("angle")
    phases = [
        (
            pattern.name,
            " ".join(fixed(unit, p, 1).removesuffix(".0") for p in pattern.phases),
            pattern.source,
        )
        for pattern in patterns
    ]
    heads = ("", f"{say('phases of the rows')}, {unit.unit}", say("printed by Yamashita et al. in"))
    yield Table(say("Patterns"), tuple(map(Column, heads)), tuple(phases))
    left = [
        (pattern.name, pattern.left, say("yes") if pattern.twists else say("no"))
        for pattern in patterns
    ]
    heads = ("", say("orders left, of how many rows"), say("twist"))
    title = say("Remaining orders, up to the order from which they repeat")
    yield Table(title, tuple(map(Column, heads)), tuple(left))
    outputs = ("shaking_force", *OF_ROWS)
    columns = (
        Column(output_named(name), "torque" if name in OF_ROWS else "force") for name in outputs
    )
    in_phase = replace(patterns[0], name=say("all in phase"), parts=((0, 1),) * rows)
    figures: tuple[tuple[Cell, ...], ...] = tuple(
        (
            pattern.name,
            *(_of_all(arranged(machine, pattern, spacing), output) for output in outputs),
        )
        for pattern in (in_phase, *patterns)
    )
    yield Table(say("Figures of this machine; RMS"), (Column(""), *columns), figures)


def _of_all(machine: Machine, output: str) -> Value:
    term = PhaseObjective(Objective(output), PhasedRows(machine).signals(Objective(output)))
    phases = np.array([row.phase for row in machine.rows])
    return Value(float(term.values(phases)), 10 * term.single)
