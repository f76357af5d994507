"""Tables of springs and resistances none of whose rows the motion reaches."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from equipoise.i18n import Note
from equipoise.mechanism.kinematics.motion import Motion, PlacedBodies
from equipoise.quantities import format_quantity


def unreached_tables(motion: Motion) -> Iterator[Note]:
    """Which tables a whole cycle never enters, with where it is instead: a sentence each.

    Such a table is counted from another place than is meant, or has another unit. What acts is its
    first or last row alone, or what goes on from there, and no figure shows it.
    """
    if not motion.whole_cycle:
        return
    for table, number, element in motion.machine.force_elements:
        where = f"{table}[{number + 1}]"
        argument = element.table_argument(PlacedBodies(motion, where))
        if argument is None:
            continue
        low, high = float(np.min(argument.values)), float(np.max(argument.values))
        first, last = argument.rows[0], argument.rows[-1]
        if low < last and high > first:
            continue
        ends = (low, high, first, last)
        names = ("low", "high", "first", "last")
        limits = {
            name: format_quantity(end, argument.dimension)
            for name, end in zip(names, ends, strict=True)
        }
        yield Note(
            "{where}: the {label} goes from {low} to {high}, and the rows from {first} to {last}, "
            "so that none is reached; check the rows, and from where they count",
            where=where,
            label=argument.label,
            **limits,
        )
