"""Figures of many designs of one machine: geometry, masses, speed, any number of its file.

Designs are a table, one row a design, that a loop runs over at crank angles of the batch's choice.
Where a group of loops goes from one crank angle to the next, that is a `March` round the cycle.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from itertools import pairwise
from math import pi, prod, radians
from typing import Any

import numpy as np

from equipoise.codegen.backends import processors, run_loop
from equipoise.codegen.emit import emit, own_motion
from equipoise.codegen.extremes import CurveTops, GridTops, PanelTops
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
from equipoise.codegen.loops import MARCH
from equipoise.codegen.source import TermSource
from equipoise.codegen.trace import FAR, Trace
from equipoise.dataclass import dataclass
from equipoise.errors import UsageError
from equipoise.i18n import Note
from equipoise.keys.paths import KeyPath
from equipoise.mechanism.assembly import reach
from equipoise.mechanism.assembly.family import invalid_designs, linkage_of, with_columns
from equipoise.mechanism.assembly.linkage import Linkage, assemble
from equipoise.mechanism.assembly.loops import JUMP, SETTLED, LoopGroup
from equipoise.mechanism.assembly.steps import size_of_bodies
from equipoise.mechanism.kinematics.jumps import (
    bends_of_rows,
    declared_jumps,
    jumps_of_rows,
    may_jump,
    of_rows,
)
from equipoise.mechanism.outputs.declared import declared
from equipoise.mechanism.parts.machine import Machine
from equipoise.signals import Array, JumpSampling

STEPS = (radians(4), radians(0.5), radians(1 / 12))
"""Farthest that crank angles are apart; the next for designs that have not stayed on their branch.
The last decides whether a design turns at all."""
ARRIVALS = 6
"""Rounds of Newton's method from the base's pose, before the crank turns."""


@dataclass(frozen=True)
class March:
    """Once round the cycle, from the crank angle at which the file gives the pose.

    source : whose loop it is.  begin : that crank angle, within the cycle of `period` (rad).
    """

    source: TermSource
    begin: float
    period: float

    @classmethod
    def of(cls, source: TermSource, base: Linkage) -> March | None:
        """The march of a source; None where each crank angle stands alone."""
        position = base.machine.position
        if not source.carried or position is None:
            return None
        period = 2 * pi * base.cycle.turns
        return cls(source, position.crank_angle % period, period)

    def grid(self, theta: Array, step: float = STEPS[0], shares: Array | None = None) -> Array:
        """Rows (G, M) for the loop, to gather at crank angles (N,) and to go no farther at once.

        The first row is the number of the crank angle, -1 where nothing is gathered; the last one
        its share in a mean, where the source asks for shares.
        """
        number, angles, given = self.way(theta, step)
        rows = [number, self.source.grid(angles, given)]
        if self.source.has_shares:
            share = np.zeros(len(number))
            share[number >= 0] = 0.0 if shares is None else shares[number[number >= 0]]
            rows.append(share)
        return np.vstack(rows)

    def way(self, theta: Array, step: float = STEPS[0]) -> tuple[Array, Array, dict[str, Array]]:
        """Crank angles (M,) on the way round, with their numbers and the rows of `MARCH`."""
        angles = np.mod(theta - self.begin, self.period)
        order = np.argsort(angles, kind="stable")
        ways = np.concatenate([np.zeros(ARRIVALS), angles[order], [self.period]])
        widths = np.diff(ways)
        counts = np.maximum(1, np.ceil(widths / step)).astype(int)
        ends = np.cumsum(counts)
        within = np.arange(ends[-1]) - np.repeat(ends - counts, counts) + 1
        ways = np.append(
            0.0, np.repeat(ways[:-1], counts) + within * np.repeat(widths / counts, counts)
        )
        number = np.full(len(ways), -1)
        number[ends[ARRIVALS - 1 : -1]] = order
        angles = np.mod(self.begin + ways, self.period)
        angles[number >= 0] = theta[order]
        place = np.arange(len(ways))
        march = (np.diff(ways, prepend=0.0), place == ARRIVALS - 1, place >= ARRIVALS - 1)
        return number, angles, {k: v.astype(float) for k, v in zip(MARCH, march, strict=True)}

    def unsettled(self, gathered: Array) -> Array:
        """Designs (K,), of those gathered (P, R), that have not stayed on their branch."""
        return np.flatnonzero(~np.all(gathered[:, self.source.ends["loose"]] <= SETTLED, axis=1))

    def reasons(self, reason: Array, gathered: Array) -> None:
        """Fill in why designs (P,) failed of which this much was gathered (P, R).

        Those that did not arrive, or came back elsewhere, may do otherwise from the position in the
        file, or after further turns.
        """
        ends = {key: gathered[:, columns] for key, columns in self.source.ends.items()}
        reason[~np.all(ends["open"] <= JUMP**2, axis=1)] = NOT_COMPUTED
        reason[self.unsettled(gathered)] = NO_FULL_TURN
        reason[~np.all(ends["astray"] <= SETTLED, axis=1)] = NOT_COMPUTED


FIRST = 128
"""Crank angles in a turn from which their number doubles."""
DENSER, MOST_LOOKED_AT = 8, 40_000
"""How much closer a dyad's number is looked at near zero, and with how many angles at most."""
PARTS, ROUNDS = 64, 5
"""Parts of a range of crank angles of which the one with the extreme is looked at again."""
SLOPE = 6.0
"""A dyad's number between two crank angles is no lower than the lower one less (SLOPE h / 2)^2, for
links that turn no faster than the crank."""
SWUNG = 3.0
"""How much farther ratios may swing of designs that differ in the shape of pitch curves."""
AT_ONCE = 500_000
"""Designs times crank angles that one thread does sooner than several."""
SMOOTH = ("mean", "rms")
"""Figures that stand still for good once they do.  Extremes have to do so twice: crank angles may
by chance come as close to the top as before."""
STEP = 4
"""Crank angles, over the tolerance, that laws of couplings take whose acceleration jumps at each
design's own crank angles: means over them come closer as 1 / N, and may by chance stand still
before."""
ROUNDING = 1e-12
"""Of the size of a signal: what moves by less than this stands still."""


def all_angles(count: int, turns: int) -> Array:
    """`count` crank angles (rad) in each turn, equally spaced from 0."""
    return np.arange(count * turns) * (2 * pi / count)


def jumps_alike(linkage: Linkage, paths: Collection[str]) -> bool:
    """Whether forces of all designs in which these numbers vary jump at the same crank angles."""
    trace = Trace(linkage, paths)
    known = trace.by_crank - trace.shifted
    jerking = (coupling for coupling in linkage.machine.couplings if len(coupling.jumps))
    return all(
        {item.driver, item.carrier} <= known and item.driven not in trace.late for item in jerking
    )


def grid_of(source: TermSource, theta: Array, shares: Array | None = None) -> Array:
    """Rows (G, N) of what the source wants to know of crank angles (N,), rad.

    shares : (N,) of each in a mean, where the source asks for them; none if None.
    """
    grid = source.grid(theta)
    if not source.has_shares:
        return grid
    return np.vstack([grid, np.zeros(len(theta)) if shares is None else shares])


def sizes_of(machine: Machine, signals: Iterable[str]) -> dict[str, Any]:
    """Size of each signal, in its own unit; a column (P, 1) where numbers of the machine are."""
    size, speed = size_of_bodies(machine), np.abs(machine.drive.speed)
    mass = sum(0.0 if link.mass is None else link.mass for link in machine.links.values())
    force = mass * (size * speed**2 + np.hypot(*machine.gravity))
    sizes = {
        "angle": 1.0,
        "length": size,
        "speed": size * speed,
        "acceleration": size * speed**2,
        "angular speed": speed,
        "angular acceleration": speed**2,
        "force": force,
        "torque": force * size,
    }
    known = {signal: declared(signal) for signal in signals}
    return {signal: sizes[str(item[0].dimension)] for signal, item in known.items() if item}


@dataclass(frozen=True, eq=False)
class DesignBatch:
    """Some designs (P) of a machine.

    table : (P, T) numbers, as the source wants them.
    refused : (P,) whether no machine can have them; those have the numbers of the base.
    machine : the machine with their numbers as columns.
    """

    table: Array
    refused: Array
    machine: Machine

    def sizes(self, signals: Iterable[str], some: Array) -> Mapping[str, Any]:
        """Size of each signal of some of the designs, (K,) or one for all."""
        values = sizes_of(self.machine, signals)
        return {name: size[some, 0] if np.ndim(size) else size for name, size in values.items()}


def designs_of(
    source: TermSource, base: Linkage, paths: Sequence[str], values: Array
) -> DesignBatch:
    """Designs of a base by the numbers (P, d) that vary, SI units, and their paths."""
    columns = {path: values[:, k, None] for k, path in enumerate(paths)}
    machine = with_columns(base.machine, columns)
    refused = np.zeros(len(values), dtype=bool) | invalid_designs(machine, base, columns)
    linkage = linkage_of(machine, base)
    table = np.empty((len(values), source.width))
    for slot in source.slots:
        own = slot.read(base)
        value = own if slot.cyclic else slot.read(linkage)  # no design changes that motion
        for column, part in enumerate(("real", "imag")[: 1 + slot.vector], slot.column):
            table[:, column] = np.ravel(np.real(getattr(value, part)))
            table[refused, column] = getattr(own, part)
    return DesignBatch(table, refused, machine)


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
            raise UsageError(Note("got {angles} crank angles; give at least 1", angles=angles))
        self.base = assemble(machine)
        if (why := own_motion(self.base, paths)) is not None:
            raise UsageError(why)
        self.paths, self.wanted = tuple(paths), tuple(wanted)
        self.angles, self.tolerance = angles, tolerance
        self.threads = threads or processors()
        self.needed = 2 if any(figure.name not in SMOOTH for figure in self.wanted) else 1
        rounds = machine.couplings or any(isinstance(s, LoopGroup) for s in self.base.motion)
        self.turns = self.base.cycle.turns if rounds else machine.turns_given
        self.jumps, self.least = self._known_jumps()
        resolves = len(self.jumps) > 0
        self.source = emit(self.base, Gathered.of(self.wanted), self.paths, resolves)
        self.gathered = self.source.gathered
        self.march = March.of(self.source, self.base)
        windings = self.base.cycle.windings if rounds else {}
        fastest = max((abs(turns) for turns in windings.values()), default=1) / self.turns
        fastest = max([fastest, *self._rates_of_pushed()])
        fastest *= prod(coupling.unevenness for coupling in machine.couplings)
        shaped = any("shape" in KeyPath.parse(path) for path in self.paths)
        self.slope = SLOPE * max(1.0, fastest) * (SWUNG if shaped else 1.0)

    def __call__(self, values: Array) -> tuple[Array, Array]:
        """Figures (P, m) and reasons (P,) of designs (P, d), SI units; NaN where one failed."""
        values = np.ascontiguousarray(values, dtype=float)
        with np.errstate(all="ignore"):  # a design that fails has a reason
            designs = designs_of(self.source, self.base, self.paths, values)
            figures, reason = self._settled(designs)
        reason[designs.refused] = NO_MACHINE
        figures[reason != COMPUTED] = np.nan
        return figures, reason

    def _rates_of_pushed(self) -> Iterator[float]:
        """How fast each link turns that is pushed, over the crank, at most."""
        machine = self.base.machine
        moved = machine.moved(all_angles(FIRST, self.turns)) if machine.pushers else {}
        return (float(np.max(np.abs(moved[item.link][1]))) for item in machine.pushers)

    def _known_jumps(self) -> tuple[Array, float]:
        """Crank angles (J,), rad, at which forces of all designs jump, and how many crank angles
        in a turn are the fewest; many where each design has jumps of its own.

        Raises
        ------
        UsageError : designs have jumps of their own, and the number of crank angles is given.
        """
        if not may_jump(self.base):
            return np.empty(0), FIRST
        if not jumps_alike(self.base, self.paths):
            if self.angles is not None:
                raise UsageError(
                    Note("got couplings whose laws jump at each design's own crank angles")
                )
            return np.empty(0), STEP / self.tolerance
        machine = self.base.machine
        if machine.in_soil or any(len(item.jumps) for item in machine.couplings):
            return jumps_of_rows(self.base), FIRST
        every = np.concatenate([np.empty(0), *declared_jumps(self.base, self.turns)])
        return of_rows(machine, every, self.turns), FIRST

    # -- crank angles ------------------------------------------------------------------------------

    def _settled(self, designs: DesignBatch) -> tuple[Array, Array]:
        """Figures and reasons, with as many crank angles as it takes."""
        count = self.angles or FIRST
        joined = self._at(designs.table, count)
        figures = self._figures(joined, count)
        reason = self._reasons(designs.table, joined, count)
        if self.angles is not None:
            return figures, reason
        signals = {figure.signal for figure in self.wanted}
        left = np.flatnonzero(reason == COMPUTED)
        joined, calm = joined[left], np.zeros(left.size, dtype=int)
        while left.size and 2 * count <= MOST_ANGLES:
            if self.source.has_shares:
                joined = self._at(designs.table[left], 2 * count)
            else:
                between = self._at(designs.table[left], count, pi / count)
                joined = self.gathered.joined(joined, between)
            count *= 2
            now = self._figures(joined, count)
            still = self._still(now, figures[left], joined, count, designs.sizes(signals, left))
            calm = np.where(still, calm + 1, 0)
            figures[left] = now
            reason[left] = self._reasons(designs.table[left], joined, count)
            enough = (calm >= self.needed) & (count >= self.least)
            moving = ~enough & (reason[left] == COMPUTED)
            left, joined, calm = left[moving], joined[moving], calm[moving]
        reason[left] = NOT_STILL
        return figures, reason

    def _at(self, table: Array, count: int, first: float = 0.0) -> Array:
        """What is gathered (P, R) at so many crank angles in a turn, from the first on, rad, and at
        those that resolve jumps.
        """
        theta = all_angles(count, self.turns) + first
        if self.source.has_shares:
            bends = bends_of_rows(self.base, self.turns)
            sampling = JumpSampling.of(theta, self.turns, self.jumps, bends)
            tops = PanelTops(sampling)
            theta, shares = sampling.crank_angle[tops.order], sampling.shares[tops.order]
            return self._gathered(table, theta, tops, shares)
        return self._gathered(table, theta, GridTops(2 * pi * self.turns, first))

    def _gathered(
        self, table: Array, theta: Array, tops: CurveTops, shares: Array | None = None
    ) -> Array:
        """What is gathered (P, R) at crank angles (N,), rad; shares : (N,) of each in a mean."""
        values = self._run(table, self._grid(theta, shares), tops)
        if self.march:
            for step in STEPS[1:]:
                loose = self.march.unsettled(values)
                if loose.size:
                    grid = self.march.grid(theta, step, shares)
                    values[loose] = self._run(table[loose], grid, tops)
        return values

    def _grid(self, theta: Array, shares: Array | None = None) -> Array:
        if self.march:
            return self.march.grid(theta, shares=shares)
        return grid_of(self.source, theta, shares)

    def _total(self, count: int) -> int:
        """What sums are divided by for means: shares add up to 1."""
        return 1 if self.source.has_shares else count * self.turns

    def _run(self, table: Array, grid: Array, tops: CurveTops | None = None) -> Array:
        """Run the loop, on several threads where that is worth it; it lets them run beside."""
        parts = min(self.threads, 1 + len(table) * grid.shape[1] // AT_ONCE)
        if parts == 1:
            return run_loop(self.source, table, grid, tops)
        with ThreadPoolExecutor(parts) as pool:
            done = pool.map(
                lambda part: run_loop(self.source, part, grid, tops), np.array_split(table, parts)
            )
        return np.concatenate(list(done))

    def _figures(self, columns_read: Array, count: int) -> Array:
        columns = [self.gathered.figure(columns_read, f, self._total(count)) for f in self.wanted]
        return np.column_stack(columns) if columns else np.empty((len(columns_read), 0))

    def _still(
        self, now: Array, before: Array, columns_read: Array, count: int, sizes: Mapping[str, Any]
    ) -> Array:
        """Designs (P,) none of whose figures has moved."""
        still = np.ones(len(now), dtype=bool)
        for k, figure in enumerate(self.wanted):
            step = np.abs(now[:, k] - before[:, k])
            if figure.name in PLACES:
                period = 2 * pi * self.turns
                still &= np.minimum(step, period - step) <= self.tolerance * 2 * pi
            else:
                rms = self.gathered.rms(columns_read, figure.signal, self._total(count))
                share = self.tolerance if figure.name in SMOOTH else self.tolerance / 2
                still &= step <= share * rms + ROUNDING * sizes[figure.signal]
        return still

    # -- designs that fail -------------------------------------------------------------------------

    def _reasons(self, table: Array, columns_read: Array, count: int) -> Array:
        """Why designs (P,) cannot be moved through the cycle; `COMPUTED` where they can.

        Of several dyads that fail the first gives the reason, as those after it have no position.
        """
        reason = np.zeros(len(columns_read), dtype=np.uint8)
        reason[np.any(columns_read[:, self.source.nearest] < FAR, axis=1)] = NOT_COMPUTED
        weakest = columns_read[:, self.source.weakest].copy()
        strongest = columns_read[:, self.source.strongest].copy()
        self._look_closer(table, weakest, strongest, count)
        dyads = [*zip(weakest.T, strongest.T, strict=True)][: len(set(self.source.watched))]
        groups = [group.margin for group in self.base.groups if not group.through]
        for margin in reversed(groups):
            if margin is None:
                if self.march:
                    self.march.reasons(reason, columns_read)
                continue
            low, high = dyads.pop()
            reason[low < reach.CHANGE_POINT] = CHANGE_POINT
            reason[low < -reach.CHANGE_POINT] = NO_FULL_TURN
            reason[high <= 0] = NO_ASSEMBLY
        return reason

    def _look_closer(self, table: Array, weakest: Array, strongest: Array, count: int) -> None:
        """Find how low and high dyads' numbers come between the crank angles, near zero."""
        while True:
            drop = (self.slope * pi / count) ** 2
            doubtful = (weakest >= -reach.CHANGE_POINT) & (weakest < drop)
            doubtful |= (strongest <= 0) & (strongest > -drop)
            some = np.flatnonzero(doubtful.any(axis=1))
            count *= DENSER
            if not some.size or count > MOST_LOOKED_AT:
                break
            result = self._run(table[some], self._grid(all_angles(count, self.turns)))
            weakest[some] = result[:, self.source.weakest]
            strongest[some] = result[:, self.source.strongest]
        for k in some:
            for dyad in {self.source.watched[column] for column in np.flatnonzero(doubtful[k])}:
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
                sign * self._run(row, self._grid(np.linspace(*ends, PARTS + 1)))[0, column]
                for ends in pairwise(edges)
            ]
            k = int(np.argmin(values))
            best = min(best, float(values[k]))
            low, high = edges[max(k - 1, 0)], edges[min(k + 2, PARTS)]
        return best
