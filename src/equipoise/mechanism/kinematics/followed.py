"""A linkage followed from crank angle 0 to either side, without a whole cycle.

What needs to be known near a crank angle before it is solved there, running angles of links and
poses of loop groups, is kept along the way.
"""

from __future__ import annotations

from collections.abc import Collection

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.mechanism.assembly.linkage import Linkage
from equipoise.mechanism.assembly.steps import Array, State, Step, needed_references, run


@dataclass(frozen=True, eq=False)
class Followed:
    """What is known along the way; values between are found from those beside.

    grid : (K,) rising crank angles, rad.  tables : name of a reference -> (..., K).
    motion : steps to what is asked, from the drive's rotation on.
    """

    linkage: Linkage
    grid: Array
    tables: dict[str, Array]
    motion: tuple[Step, ...]

    @classmethod
    def over(
        cls,
        linkage: Linkage,
        low: float,
        high: float,
        step: float,
        links: Collection[str] | None = None,
    ) -> Followed:
        """Follow a linkage over a range that holds crank angle 0, if anything has to be.

        links : that are asked of; all if not given.

        Raises
        ------
        MotionError : loops cannot be closed on the way.
        """
        motion = linkage.motion if links is None else _steps_to(linkage, links)
        names = needed_references(motion)
        count = max(2, round((high - low) / step) + 1)
        if not names:
            return cls(linkage, np.linspace(low, high, count), {}, motion)
        ends = [np.linspace(0.0, end, max(2, round(abs(end) / step) + 1)) for end in (low, high)]
        runs = [_run(linkage, motion, way) for way in ends]
        tables = {}
        for name in names:
            down, up = (state[name if name in state else f"phi({name})"] for state in runs)
            tables[name] = np.concatenate([down[..., :0:-1], up], axis=-1)
        return cls(linkage, np.concatenate([ends[0][:0:-1], ends[1]]), tables, motion)

    def solve(self, theta: Array) -> State:
        """State with every link that is asked of at crank angles (N,) of the range, rad."""
        state = self.linkage.start(theta)
        for name, table in self.tables.items():
            rows = [np.interp(theta, self.grid, row) for row in np.atleast_2d(table)]
            state[f"reference({name})"] = rows[0] if table.ndim == 1 else np.array(rows)
        with np.errstate(all="ignore"):
            return run(self.motion, state)


def _steps_to(linkage: Linkage, links: Collection[str]) -> tuple[Step, ...]:
    """The steps after which all these links are known."""
    theirs = [not set(links).isdisjoint(group.links) for group in linkage.groups]
    last = max((number for number, their in enumerate(theirs, 1) if their), default=0)
    return tuple(step for group in linkage.groups[:last] for step in group.motion)


def _run(linkage: Linkage, motion: tuple[Step, ...], way: Array) -> State:
    with np.errstate(all="ignore"):
        return run(motion, linkage.start(way))
