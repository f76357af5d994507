"""A linkage followed from crank angle 0 to either side, without a whole cycle.

What needs to be known near a crank angle before it is solved there, running angles of links and
poses of loop groups, is kept along the way.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from equipoise.mechanism.linkage import Linkage
from equipoise.mechanism.steps import Array, State, run


@dataclass(frozen=True, eq=False)
class Followed:
    """What is known along the way; values between are found from those beside.

    grid : (K,) rising crank angles, rad.  tables : name of a reference -> (..., K).
    """

    linkage: Linkage
    grid: Array
    tables: dict[str, Array]

    @classmethod
    def over(cls, linkage: Linkage, low: float, high: float, step: float) -> Followed:
        """Follow a linkage over a range that holds crank angle 0, if anything has to be.

        Raises
        ------
        MotionError : loops cannot be closed on the way.
        """
        names = linkage.needed_references
        count = max(2, round((high - low) / step) + 1)
        if not names:
            return cls(linkage, np.linspace(low, high, count), {})
        ends = [np.linspace(0.0, end, max(2, round(abs(end) / step) + 1)) for end in (low, high)]
        runs = [_run(linkage, way) for way in ends]
        tables = {}
        for name in names:
            down, up = (state[name if name in state else f"phi({name})"] for state in runs)
            tables[name] = np.concatenate([down[..., :0:-1], up], axis=-1)
        return cls(linkage, np.concatenate([ends[0][:0:-1], ends[1]]), tables)

    def solve(self, theta: Array) -> State:
        """State with every link known at crank angles (N,) of the range, rad."""
        state = self.linkage.start(theta)
        for name, table in self.tables.items():
            rows = [np.interp(theta, self.grid, row) for row in np.atleast_2d(table)]
            state[f"reference({name})"] = rows[0] if table.ndim == 1 else np.array(rows)
        with np.errstate(all="ignore"):
            return run(self.linkage.motion, state)


def _run(linkage: Linkage, way: Array) -> State:
    with np.errstate(all="ignore"):
        return run(linkage.motion, linkage.start(way))
