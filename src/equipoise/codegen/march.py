"""Once round the cycle, where a group of loops goes from one crank angle to the next."""

from __future__ import annotations

from math import pi, radians

import numpy as np

from equipoise.codegen.figures import NO_FULL_TURN, NOT_COMPUTED
from equipoise.codegen.loops import MARCH
from equipoise.codegen.source import TermSource
from equipoise.codegen.trace import Array
from equipoise.dataclass import dataclass
from equipoise.mechanism.assembly.linkage import Linkage
from equipoise.mechanism.assembly.loops import JUMP, SETTLED

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
