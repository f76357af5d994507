"""The motion of a crank in a part of a piece of the table, as the integration has followed it."""

from __future__ import annotations

from dataclasses import field
from functools import cached_property

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.running.drivers import Driver
from equipoise.running.tabulated import NODES, POINTS, integral_to, polynomials
from equipoise.signals import Array

INTEGRALS = {sense: integral_to(POINTS, -sense) for sense in (1.0, -1.0)}
"""By the sense of the way, (NODES, NODES): integrals from the begin of a part up to each node, of
values (NODES,) there, in a part from -1 to 1."""
ROW_PLACES = {sense: np.append(POINTS[:: int(sense)], sense) for sense in (1.0, -1.0)}
"""By the sense of the way, places (NODES + 1,) from -1 to 1 at which the track has its rows: the
nodes in passing, and the end."""
PASSED = {sense: integral_to(places, -sense) for sense, places in ROW_PLACES.items()}
"""By the sense of the way, (NODES + 1, NODES): integrals from the begin of a part up to each of
`ROW_PLACES`, of values (NODES,) at the nodes."""
AT_ENDS = {end: polynomials(end)[:NODES] for end in (1.0, -1.0)}
"""By the end of a part, 1 or -1, the polynomials (NODES,) there, which the coefficients of its
reduced inertia multiply."""
ELECTRIC = 3
"""Values of a motor's circuit in a row of the track: its current, and two works."""


@dataclass(frozen=True)
class Instant:
    """State of a run: s, rad, rad/s, and the work so far of each source, of the brake where there
    is one, and of the drive, J.

    electric : (3,) current of a direct-current motor, A, and work of its supply and heat so far, J.
    """

    time: float
    angle: float
    speed: float
    work: Array
    electric: Array = field(default_factory=lambda: np.zeros(ELECTRIC))


@dataclass(frozen=True, eq=False)
class TableRange:
    """A piece of the table, or a part of it.

    place : what is the same in every cycle.  ends : crank angles, rad.
    values : (C, NODES) at its nodes.  coefficients : (NODES,) of the reduced inertia.
    """

    place: tuple[float, ...]
    ends: tuple[float, float]
    values: Array
    coefficients: Array

    @property
    def half(self) -> float:
        """Half its width, rad."""
        return (self.ends[1] - self.ends[0]) / 2

    def inertia_at(self, x: Array) -> Array:
        """Reduced inertia (...), kg m2, at places (...) from -1 to 1 in it."""
        return np.asarray(polynomials(x)[..., :NODES] @ self.coefficients)

    def inertia_passed(self, sense: float) -> Array:
        """Reduced inertia (NODES + 1,), kg m2, at the `ROW_PLACES` of a sense."""
        return np.append(self.values[0][:: int(sense)], self.coefficients @ AT_ENDS[sense])


@dataclass(frozen=True, eq=False)
class PieceMotion:
    """The motion in a part of a piece, from its begin in a sense to its end.

    energy : kinetic, at the begin, J.
    rates : (R, NODES) by crank angle at the nodes, of time, of the motor's circuit and of works.
    driver : whose current follows the speed, unless it lags.
    """

    begin: Instant
    part: TableRange
    sense: float
    energy: float
    rates: Array
    driver: Driver

    @cached_property
    def passed(self) -> Array:
        """Rows (NODES + 1, ...) of the track at the `ROW_PLACES` of the sense."""
        sense, part = self.sense, self.part
        rows = self._rows(ROW_PLACES[sense], PASSED[sense], part.inertia_passed(sense))
        rows[-1, 1] = part.ends[sense > 0]
        return rows

    def rows(self, x: Array) -> Array:
        """Rows (N, ...) of the track at places (N,) from -1 to 1."""
        return self._rows(x, integral_to(x, -self.sense), self.part.inertia_at(x))

    def at(self, x: float) -> Instant:
        """The instant at a place from -1 to 1."""
        rows = self.passed[-1:] if x == self.sense else self.rows(np.array([x]))
        return instant_of(rows[0])

    def _rows(self, x: Array, integrals: Array, inertia: Array) -> Array:
        part, begin = self.part, self.begin
        gained = part.half * (integrals @ self.rates.T)
        rows = np.empty((len(x), 2 + gained.shape[1]))
        rows[:, 0] = begin.time + gained[:, 0]
        rows[:, 1] = part.ends[0] + part.half * (x + 1)
        energy = self.energy + gained[:, 1 + ELECTRIC :].sum(axis=1)
        rows[:, 2] = self.sense * np.sqrt(2 * energy / inertia)
        rows[:, 3 : 3 + ELECTRIC] = begin.electric + gained[:, 1 : 1 + ELECTRIC]
        if not self.driver.lags:
            rows[:, 3] = self.driver.current(rows[:, 2])
        rows[:, 3 + ELECTRIC :] = begin.work + gained[:, 1 + ELECTRIC :]
        return rows


def instant_of(row: Array) -> Instant:
    """The instant of a row of the track."""
    time, angle, speed = row[:3].tolist()
    return Instant(time, angle, speed, row[3 + ELECTRIC :], row[3 : 3 + ELECTRIC])
