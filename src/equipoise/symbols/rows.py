"""Rows side by side, as one sees them from the side: one behind the other, each at its phase."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.mechanism.kinematics.motion import move
from equipoise.symbols.shapes import Array

if TYPE_CHECKING:
    from equipoise.mechanism.kinematics.motion import Motion

CLOSE = 1e-9
"""rad and m within which rows cover each other."""
FAR = 1.0
"""Over the size of the linkage: rows that stand further beside it are not drawn."""


@dataclass(frozen=True, eq=False)
class Ghost:
    """Rows that move alike, but not as the linkage of the file.

    numbers : of these rows, from 1.  phase : by which their crank is ahead, rad.
    places : of points by name, (N,) complex, m; none where they stand too far beside the linkage.
    angles : of each link, (N,) rad.
    """

    numbers: tuple[int, ...]
    phase: float
    places: Mapping[str, Array]
    angles: Mapping[str, Array]


@dataclass(frozen=True, eq=False)
class Rows:
    """Rows of a machine.  drawn : numbers of those that move as the linkage of the file."""

    drawn: tuple[int, ...] = ()
    others: tuple[Ghost, ...] = ()

    @property
    def shown(self) -> tuple[Ghost, ...]:
        """Those of the others that are drawn."""
        return tuple(part for part in self.others if part.places)


SINGLE_ROW = Rows()
"""Of a machine that has no rows, or whose rows are not to be seen."""


def rows_of(motion: Motion, size: float) -> Rows:
    """All rows of a machine in motion, whose linkage has a size, m."""
    rows = motion.machine.rows
    if len(rows) < 2:
        return SINGLE_ROW
    alike: dict[tuple[int, ...], list[int]] = {}
    for number, row in enumerate(rows, 1):
        turned = round(float(np.angle(np.exp(1j * row.phase)) / CLOSE))
        place = (round(part / CLOSE) for part in row.offset)
        alike.setdefault((turned, *place), []).append(number)
    in_place = tuple(alike.pop((0, 0, 0), ()))
    others = []
    for numbers in alike.values():
        row = rows[numbers[0] - 1]
        offset, phase = complex(*row.offset), float(np.angle(np.exp(1j * row.phase)))
        if abs(offset) > FAR * size:
            others.append(Ghost(tuple(numbers), phase, {}, {}))
            continue
        there = move(motion.machine, motion.crank_angle + phase, motion.speed, motion.acceleration)
        places = {name: point.place + offset for name, point in there.points.items()}
        angles = {name: link.angle for name, link in there.links.items()}
        others.append(Ghost(tuple(numbers), phase, places, angles))
    return Rows(in_place, tuple(others))
