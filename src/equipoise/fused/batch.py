"""Figures of many designs of one machine: geometry, masses, speed, whatever its file tells."""

from __future__ import annotations

import os
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from math import pi
from typing import Any

import numpy as np

from equipoise.errors import UsageError
from equipoise.fused.compiled import run
from equipoise.fused.emit import emit
from equipoise.fused.figures import PLACES, Figure, Gathered
from equipoise.fused.grid import all_angles, between, grid_of
from equipoise.fused.reasons import (
    CHANGE_POINT,
    MOST_ANGLES,
    NO_ASSEMBLY,
    NO_FULL_TURN,
    NO_MACHINE,
    NOT_COMPUTED,
    NOT_STILL,
)
from equipoise.fused.sizes import sizes_of
from equipoise.fused.table import table_of
from equipoise.mechanism import cycle
from equipoise.mechanism.linkage import assemble
from equipoise.mechanism.model import Machine

Array = np.ndarray[Any, Any]

FIRST = 128
"""Crank angles in a turn from which their number doubles."""
DENSER, MOST_LOOKED_AT = 8, 300_000
"""How much closer a dyad's number is looked at near zero, and with how many angles at most."""
SLOPE = 6.0
"""A dyad's number between two crank angles is no lower than the lower one less (SLOPE h / 2)^2."""
AT_ONCE = 500_000
"""Designs times crank angles that one thread does sooner than several."""
ROUNDING = 1e-9
"""Of the size of a signal: what is smaller counts as zero that stands still."""


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
        self.source = emit(self.base, self.gathered)
        self.sizes = sizes_of(machine, self.gathered.signals)

    def __call__(self, values: Array) -> tuple[Array, Array]:
        """Figures (P, m) and reasons (P,) of designs (P, d), SI units; NaN where one failed."""
        values = np.ascontiguousarray(values, dtype=float)
        table, refused = table_of(self.source, self.base, self.paths, values)
        figures, reason = self._settled(table)
        reason[refused] = NO_MACHINE
        figures[reason != 0] = np.nan
        return figures, reason

    # -- crank angles ------------------------------------------------------------------------------

    def _settled(self, table: Array) -> tuple[Array, Array]:
        """Figures and reasons, with as many crank angles as it takes."""
        count = self.angles or FIRST
        found = self._at(table, all_angles(count, self.turns))
        figures, reason = self._figures(found, count), self._reasons(table, found, count)
        if self.angles is not None:
            return figures, reason
        left = np.flatnonzero(reason == 0)
        found = found[left]
        while left.size and 2 * count <= MOST_ANGLES:
            found = self._doubled(table[left], found, count)
            count *= 2
            now = self._figures(found, count)
            moving = ~self._still(now, figures[left], found, count)
            figures[left] = now
            reason[left] = self._reasons(table[left], found, count)
            moving &= reason[left] == 0
            left, found = left[moving], found[moving]
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
            return run(self.source, table, grid)
        with ThreadPoolExecutor(parts) as pool:
            done = pool.map(lambda part: run(self.source, part, grid), np.array_split(table, parts))
        return np.concatenate(list(done))

    def _doubled(self, table: Array, found: Array, count: int) -> Array:
        """What is gathered at twice as many angles, of which only the new ones are computed."""
        if self.source.running:  # their angles are counted on from crank angle 0
            return self._at(table, all_angles(2 * count, self.turns))
        more = self._at(table, between(count, self.turns))
        weakest = len(self.gathered.columns)
        both = self.gathered.joined(found, more)
        both[:, weakest] = np.minimum(found[:, weakest], more[:, weakest])
        both[:, weakest + 1] = np.maximum(found[:, weakest + 1], more[:, weakest + 1])
        return both

    def _figures(self, found: Array, count: int) -> Array:
        columns = [self.gathered.figure(found, f, count * self.turns) for f in self.wanted]
        return np.column_stack(columns) if columns else np.empty((len(found), 0))

    def _still(self, now: Array, before: Array, found: Array, count: int) -> Array:
        """Designs (P,) none of whose figures has moved."""
        still = np.ones(len(now), dtype=bool)
        for k, figure in enumerate(self.wanted):
            step = np.abs(now[:, k] - before[:, k])
            if figure.name in PLACES:
                period = 2 * pi * self.turns
                size: Any = 2 * pi
                step = np.minimum(step, period - step)
            else:
                rms = self.gathered.rms(found, figure.signal, count * self.turns)
                size = np.maximum(rms, ROUNDING * self.sizes[figure.signal])
            still &= step <= self.tolerance * size
        return still

    # -- designs that fail -------------------------------------------------------------------------

    def _reasons(self, table: Array, found: Array, count: int) -> Array:
        """Why designs (P,) cannot be moved through the cycle; 0 where they can."""
        reason = np.zeros(len(found), dtype=np.uint8)
        at = len(self.gathered.columns)
        weakest, strongest = found[:, at].copy(), found[:, at + 1]
        for k, name in enumerate(self.source.running, at + 2):
            reason[np.rint(found[:, k]) != self._windings[name]] = NOT_COMPUTED
        self._look_closer(table, weakest, count)
        reason[weakest < cycle.CHANGE_POINT] = CHANGE_POINT
        reason[weakest < -cycle.CHANGE_POINT] = NO_FULL_TURN
        reason[strongest < 0] = NO_ASSEMBLY
        return reason

    @property
    def _windings(self) -> dict[str, int]:
        """Whole turns in a cycle of the base's links whose angle is counted on."""
        names = {f"phi_{link}": link for link in self.base.cycle.windings}
        return {name: self.base.cycle.windings[names[name]] for name in self.source.running}

    def _look_closer(self, table: Array, weakest: Array, count: int) -> None:
        """Find how low dyads' numbers come between the crank angles, where they come near zero."""
        while True:
            half = SLOPE * pi / count
            near = np.flatnonzero((weakest >= -cycle.CHANGE_POINT) & (weakest < half * half))
            if not near.size or count * DENSER > MOST_LOOKED_AT:
                return
            count *= DENSER
            found = self._run(table[near], grid_of(self.source, all_angles(count, self.turns)))
            weakest[near] = found[:, len(self.gathered.columns)]


def _processors() -> int:
    try:
        return len(os.sched_getaffinity(0))
    except AttributeError:  # not on every system
        return os.cpu_count() or 1
