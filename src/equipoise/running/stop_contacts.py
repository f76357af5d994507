"""Contacts of stops in a run: when each is met and left, how fast, and how hard it is pressed."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.i18n import Note
from equipoise.mechanism.dynamics.rated_elements import rated_ways
from equipoise.signals import Array

if TYPE_CHECKING:
    from equipoise.mechanism.kinematics.motion import Motion
    from equipoise.mechanism.parts.stops import Stop

HALVINGS = 50
"""Of the time between two instants, in which a gap of 0 is looked for."""


@dataclass(frozen=True)
class StopContact:
    """A contact of a stop.

    stop : its name in outputs.  row : number of its row, from 1; None of a machine without rows.
    points : those that meet.
    begin : s, at which it is met, or the start of the run.
    end : s, at which it is left; None where the run ends first.
    approach : speed with which the gap closes at the begin, m/s.  force : the largest, N.
    """

    stop: str
    row: int | None
    points: Note
    begin: float
    end: float | None
    approach: float
    force: float

    def to_dict(self) -> dict[str, object]:
        """The machine-readable output, in SI units."""
        return {name: value for name, value in vars(self).items() if name != "points"}


def stop_contacts(
    motions: Sequence[Motion], time: Array, rate: Array | float
) -> tuple[StopContact, ...]:
    """Contacts of all stops of a machine, in the order in which they begin.

    motions : of each row, at M instants of time (M,), s, rising.
    rate : by which derivatives of the motion become those by time, such as the speed of the crank
        (M,), rad/s.
    """
    machine, result = motions[0].machine, list[StopContact]()
    for row, motion in enumerate(motions, 1):
        for number, stop in enumerate(machine.stops):
            gap, slope = rated_ways(motion, [("stops", number, stop)])
            own = f"stops.{number + 1}", row if machine.rows else None, stop.label
            for begin, end, approach, force in _contacts(gap, slope * rate, stop, time):
                result.append(StopContact(*own, begin, end, approach, force))
    return tuple(sorted(result, key=lambda contact: contact.begin))


def _contacts(
    gap: Array, opening: Array, stop: Stop, time: Array
) -> Iterator[tuple[float, float | None, float, float]]:
    """Begin, end, approach and force of each contact of a stop, as of `StopContact`.

    gap, opening : (M,) m and m/s.
    """
    force = np.asarray(stop.force(gap, opening))
    pressed = np.concatenate([[False], gap < 0, [False]])
    edges = np.flatnonzero(pressed[1:] != pressed[:-1])
    for first, behind in zip(edges[::2], edges[1::2], strict=True):
        begin = _zero(time, gap, opening, int(first))
        end = _zero(time, gap, opening, int(behind)) if behind < len(time) else None
        approach = -float(np.interp(begin, time, opening))
        yield begin, end, approach, float(np.max(force[first:behind]))


def _zero(time: Array, gap: Array, opening: Array, k: int) -> float:
    """When a gap changes its sign between the instants before `k` and at it: a cubic by the values
    and speeds of both; the start of the run where `k` is 0.
    """
    if k == 0:
        return float(time[0])
    span = time[k] - time[k - 1]
    (a, b), (p, q) = gap[k - 1 : k + 1], opening[k - 1 : k + 1] * span

    def cubic(s: float) -> float:
        t = 1.0 - s
        return float(a * t * t * (1 + 2 * s) + b * s * s * (3 - 2 * s) + s * t * (p * t - q * s))

    low, high = 0.0, 1.0
    for _ in range(HALVINGS):
        middle = (low + high) / 2
        low, high = (middle, high) if (cubic(middle) < 0) == (a < 0) else (low, middle)
    return float(time[k - 1] + high * span)
