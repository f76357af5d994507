"""Figures of many designs of one machine: geometry, masses, speed, whatever its file tells."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from itertools import pairwise
from math import pi
from typing import Any

import numpy as np

from equipoise.codegen.backends import run_loop
from equipoise.codegen.designs import (
    Designs,
    all_angles,
    angles_between,
    designs_of,
    grid_of,
    has_steps,
)
from equipoise.codegen.emit import emit
from equipoise.codegen.figures import (
    CHANGE_POINT,
    COMPUTED,
    MOST_ANGLES,
    NO_ASSEMBLY,
    NO_FULL_TURN,
    NO_MACHINE,
    NOT_COMPUTED,
    NOT_STILL,
    PLACES,
    Figure,
    Gathered,
)
from equipoise.errors import UsageError
from equipoise.mechanism import cycle
from equipoise.mechanism.linkage import assemble
from equipoise.mechanism.model import Machine

Array = np.ndarray[Any, Any]

FIRST = 128
"""Crank angles in a turn from which their number doubles."""
DENSER, MOST_LOOKED_AT = 8, 40_000
"""How much closer a dyad's number is looked at near zero, and with how many angles at most."""
PARTS, ROUNDS = 64, 5
"""Parts of a range of crank angles of which the one with the extreme is looked at again."""
SLOPE = 6.0
"""A dyad's number between two crank angles is no lower than the lower one less (SLOPE h / 2)^2, for
links that turn no faster than the crank."""
AT_ONCE = 500_000
"""Designs times crank angles that one thread does sooner than several."""
SMOOTH = ("mean", "rms")
"""Figures that stand still for good once they do.  Extremes have to do so twice: crank angles may
by chance come as close to the top as before."""
STEP = 4
"""Crank angles, over the tolerance, that loads take which begin or end at once: means over them
come closer as 1 / N, and may by chance stand still before."""
FAR = -0.5
"""Cosine of the angle between a link and the base's, beyond which it may go the other way round."""
ROUNDING = 1e-12
"""Of the size of a signal: what moves by less than this stands still."""


class Batch:
    """Designs of one machine, by the numbers that vary and the figures that are wanted.

    Parameters
    ----------
    machine : the base, which must turn fully itself.
    paths : of the numbers that vary, as in its file: ``links.crank.points.B.x``.
    wanted : figures of an analysis.
    angles : crank angles in a turn; None for as many as it takes until all figures stand still.
    tolerance : to which they do, over the RMS of their signal.
    threads : at most; None for one a processor.

    Raises
    ------
    UsageError : a path or figure cannot be had in a loop.
    MassError, MotionError : the base cannot be computed.
    """

    def __init__(
        self,
        machine: Machine,
        paths: Sequence[str],
        wanted: Sequence[Figure],
        angles: int | None = None,
        tolerance: float = 1e-4,
        threads: int | None = None,
    ) -> None:
        if angles is not None and angles < 1:
            raise UsageError(f"got {angles} crank angles; give at least 1")
        self.base = assemble(machine)
        self.turns = self.base.cycle.turns if machine.gears else 1
        self.paths, self.wanted = tuple(paths), tuple(wanted)
        self.angles, self.tolerance = angles, tolerance
        self.threads = threads or _processors()
        self.gathered = Gathered.of(self.wanted)
        self.needed = 2 if any(figure.name not in SMOOTH for figure in self.wanted) else 1
        self.least = STEP / tolerance if has_steps(machine) else FIRST
        self.source = emit(self.base, self.gathered)
        windings = self.base.cycle.windings if machine.gears else {}
        fastest = max((abs(turns) for turns in windings.values()), default=1) / self.turns
        self.slope = SLOPE * max(1.0, fastest)

    def __call__(self, values: Array) -> tuple[Array, Array]:
        """Figures (P, m) and reasons (P,) of designs (P, d), SI units; NaN where one failed."""
        values = np.ascontiguousarray(values, dtype=float)
        with np.errstate(all="ignore"):  # a design that fails is told by its reason
            designs = designs_of(self.source, self.base, self.paths, values)
            figures, reason = self._settled(designs)
        reason[designs.refused] = NO_MACHINE
        figures[reason != COMPUTED] = np.nan
        return figures, reason

    # -- crank angles ------------------------------------------------------------------------------

    def _settled(self, designs: Designs) -> tuple[Array, Array]:
        """Figures and reasons, with as many crank angles as it takes."""
        count = self.angles or FIRST
        found = self._at(designs.table, all_angles(count, self.turns))
        figures = self._figures(found, count)
        reason = self._reasons(designs.table, found, count)
        if self.angles is not None:
            return figures, reason
        left = np.flatnonzero(reason == COMPUTED)
        found, calm = found[left], np.zeros(left.size, dtype=int)
        while left.size and 2 * count <= MOST_ANGLES:
            found = self._doubled(designs.table[left], found, count)
            count *= 2
            now = self._figures(found, count)
            still = self._still(now, figures[left], found, count, designs.sizes(left))
            calm = np.where(still, calm + 1, 0)
            figures[left] = now
            reason[left] = self._reasons(designs.table[left], found, count)
            enough = (calm >= self.needed) & (count >= self.least)
            moving = ~enough & (reason[left] == COMPUTED)
            left, found, calm = left[moving], found[moving], calm[moving]
        reason[left] = NOT_STILL
        return figures, reason

    def _at(self, table: Array, theta: Array) -> Array:
        """What is gathered (P, R) at crank angles (N,); places are angles, not numbers."""
        found = self._run(table, grid_of(self.source, theta))
        for k, (_, kind) in enumerate(self.gathered.columns):
            if kind.endswith("_at"):
                found[:, k] = theta[found[:, k].astype(int)]
        return found

    def _run(self, table: Array, grid: Array) -> Array:
        """Run the loop, on several threads where that is worth it; it lets them run beside."""
        parts = min(self.threads, 1 + len(table) * grid.shape[1] // AT_ONCE)
        if parts == 1:
            return run_loop(self.source, table, grid)
        with ThreadPoolExecutor(parts) as pool:
            done = pool.map(
                lambda part: run_loop(self.source, part, grid), np.array_split(table, parts)
            )
        return np.concatenate(list(done))

    def _doubled(self, table: Array, found: Array, count: int) -> Array:
        """What is gathered at twice as many angles, of which only the new ones are computed."""
        more = self._at(table, angles_between(count, self.turns))
        both = self.gathered.joined(found, more)
        for place, ways in (
            (self.source.weakest, np.minimum),
            (self.source.strongest, np.maximum),
            (self.source.nearest, np.minimum),
        ):
            both[:, place] = ways(found[:, place], more[:, place])
        return both

    def _figures(self, found: Array, count: int) -> Array:
        columns = [self.gathered.figure(found, f, count * self.turns) for f in self.wanted]
        return np.column_stack(columns) if columns else np.empty((len(found), 0))

    def _still(
        self, now: Array, before: Array, found: Array, count: int, sizes: Mapping[str, Any]
    ) -> Array:
        """Designs (P,) none of whose figures has moved."""
        still = np.ones(len(now), dtype=bool)
        for k, figure in enumerate(self.wanted):
            step = np.abs(now[:, k] - before[:, k])
            if figure.name in PLACES:
                period = 2 * pi * self.turns
                still &= np.minimum(step, period - step) <= self.tolerance * 2 * pi
            else:
                rms = self.gathered.rms(found, figure.signal, count * self.turns)
                share = self.tolerance if figure.name in SMOOTH else self.tolerance / 2
                still &= step <= share * rms + ROUNDING * sizes[figure.signal]
        return still

    # -- designs that fail -------------------------------------------------------------------------

    def _reasons(self, table: Array, found: Array, count: int) -> Array:
        """Why designs (P,) cannot be moved through the cycle; `COMPUTED` where they can.

        Of several dyads that fail it is the first that tells, as those behind it have no place.
        """
        reason = np.zeros(len(found), dtype=np.uint8)
        reason[np.any(found[:, self.source.nearest] < FAR, axis=1)] = NOT_COMPUTED
        weakest = found[:, self.source.weakest].copy()
        strongest = found[:, self.source.strongest].copy()
        self._look_closer(table, weakest, strongest, count)
        own = slice(None, len(set(self.source.watched)))
        for low, high in zip(weakest.T[own][::-1], strongest.T[own][::-1], strict=True):
            reason[low < cycle.CHANGE_POINT] = CHANGE_POINT
            reason[low < -cycle.CHANGE_POINT] = NO_FULL_TURN
            reason[high <= 0] = NO_ASSEMBLY
        return reason

    def _look_closer(self, table: Array, weakest: Array, strongest: Array, count: int) -> None:
        """Find how low and high dyads' numbers come between the crank angles, near zero."""
        while True:
            reach = (self.slope * pi / count) ** 2
            near = (weakest >= -cycle.CHANGE_POINT) & (weakest < reach)
            near |= (strongest <= 0) & (strongest > -reach)
            some = np.flatnonzero(near.any(axis=1))
            count *= DENSER
            if not some.size or count > MOST_LOOKED_AT:
                break
            found = self._run(table[some], grid_of(self.source, all_angles(count, self.turns)))
            weakest[some] = found[:, self.source.weakest]
            strongest[some] = found[:, self.source.strongest]
        for k in some:
            for dyad in {self.source.watched[column] for column in np.flatnonzero(near[k])}:
                low, high = (self._extreme(table[k : k + 1], dyad, sign) for sign in (1, -1))
                weakest[k, dyad] = min(weakest[k, dyad], low)
                strongest[k, dyad] = max(strongest[k, dyad], -high)

    def _extreme(self, row: Array, dyad: int, sign: int) -> float:
        """Smallest value, times `sign`, of one dyad's number in one design, closed in on."""
        column = (self.source.weakest if sign > 0 else self.source.strongest).start + dyad
        low, high = 0.0, 2 * pi * self.turns
        best = np.inf
        for _ in range(ROUNDS):
            edges = np.linspace(low, high, PARTS + 1)
            values = [
                sign
                * self._run(row, grid_of(self.source, np.linspace(*ends, PARTS + 1)))[0, column]
                for ends in pairwise(edges)
            ]
            k = int(np.argmin(values))
            best = min(best, float(values[k]))
            low, high = edges[max(k - 1, 0)], edges[min(k + 2, PARTS)]
        return best


def _processors() -> int:
    try:
        return len(os.sched_getaffinity(0))
    except AttributeError:  # not on every system
        return os.cpu_count() or 1
