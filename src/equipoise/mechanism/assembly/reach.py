"""How far a crank can be turned that cannot turn fully: the crank angles from end to end.

The linkage is followed from a crank angle at which it can be put together, to either side, until a
dyad is stretched out or folded, or the loop equations of a group have no solution.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise
from math import degrees, pi
from typing import Any, Protocol

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.errors import ChangePointError, MotionError, RangeError
from equipoise.i18n import Note, all_of
from equipoise.mechanism.assembly.builder import Group
from equipoise.mechanism.assembly.full_turn import CHANGE_POINT
from equipoise.mechanism.assembly.newton import BranchError
from equipoise.mechanism.assembly.steps import Array, State, Step, run
from equipoise.mechanism.parts.machine import Machine

POINTS = 360
"""Crank angles in a turn at which the linkage is looked at."""
LEAST = 1e-4
"""rad: range below which ends of a swing are hardly told apart in a file."""
FINER, ROUNDS = 16, 6
"""Into how many parts the step is parted in which an end lies, and how often."""
LOOP_ROUNDS = 3
"""The same where Newton's method takes each step: to 1/4000 of a degree."""
STEPS_BEFORE_END, THINNER = 10, 4
"""Steps before an end, all of which are taken again, and one of so many before them."""


class Assembled(Protocol):
    """A machine in the order in which it is computed, as far as it is asked here."""

    @property
    def machine(self) -> Machine: ...
    @property
    def groups(self) -> Sequence[Group]: ...
    @property
    def motion(self) -> Sequence[Step]: ...
    @property
    def needed_references(self) -> list[str]: ...
    def close(self) -> Any: ...
    def start(self, theta: Array) -> State: ...


@dataclass(frozen=True)
class Reach:
    """The crank angles between which a crank can swing.

    low, high : rad, from less than a turn below 0 to more than 0.
    stops : what the links do at either end that keeps the crank from going on.
    others : how many more such ranges there are; in these other poses begin.
    """

    low: float
    high: float
    stops: tuple[Note | str, Note | str]
    others: int = 0

    @property
    def is_point(self) -> bool:
        """Whether it is too small for a motion."""
        return self.high - self.low < LEAST

    @property
    def note(self) -> Note:
        """The range and what ends it."""
        low, high, (first, second) = _in_degrees(self.low), _in_degrees(self.high), self.stops
        if str(first) == str(second):
            text = Note(
                "the crank cannot turn fully: it stops at {low} and at {high}, where {first}",
                low=low,
                high=high,
                first=first,
            )
        else:
            text = Note(
                "the crank cannot turn fully: it stops at {low} ({first}) and at {high} ({second})",
                low=low,
                high=high,
                first=first,
                second=second,
            )
        return Note("{reason}; there are other such ranges", reason=text) if self.others else text


def reach(linkage: Assembled) -> Reach | None:
    """The range of a crank that cannot turn fully; None where it can.

    It is that in which crank angle 0 lies, or else the nearest to that.

    Raises
    ------
    RangeError : the linkage cannot be put together at any crank angle, or has couplings and cannot
        at crank angle 0, where these start.
    MotionError : its motion does not repeat.
    """
    try:
        linkage.close()
    except (RangeError, ChangePointError, BranchError) as error:
        return range_of(linkage, error)
    return None


def range_of(linkage: Assembled, stuck: MotionError) -> Reach:
    """The range of a crank whose turn ends with an error.

    Raises
    ------
    MotionError : `stuck`, where there is no such range.
    """
    start, others = _start(linkage, stuck)
    gaps = np.array([*_gaps(stuck)])
    low, first = _end(linkage, start, -1, gaps)
    high, second = _end(linkage, start, 1, gaps)
    if max(start - low, high - start) >= 2 * pi:  # on other branches, which a turn leads to
        raise stuck
    return Reach(low, high, (first, second), others)


def _gaps(stuck: MotionError) -> Iterator[float]:
    """Crank angles that cannot be passed, which may lie between two that are looked at."""
    if isinstance(stuck, ChangePointError):
        yield stuck.crank_angle
    for (_, end), (begin, _) in pairwise(_in_turn(stuck)):
        yield 0.5 * (end + begin)


def _in_turn(stuck: MotionError) -> list[tuple[float, float]]:
    """Ranges in which a crank can be, in order, and the first one a turn later."""
    ranges = sorted(stuck.ranges) if isinstance(stuck, RangeError) else []
    return [*ranges, *((low + 2 * pi, high + 2 * pi) for low, high in ranges[:1])]


def has_loops(linkage: Assembled) -> bool:
    """Whether a group is solved by its loop equations, from one crank angle to the next."""
    return any(group.kind == "loops" for group in linkage.groups)


def _start(linkage: Assembled, stuck: MotionError) -> tuple[float, int]:
    """A crank angle of the range, and how many other ranges there are."""
    if has_loops(linkage):
        return 0.0, 0
    theta = np.linspace(0.0, 2 * pi, POINTS, endpoint=False)
    good = _closed(linkage, theta)
    begins = int(np.sum(good & ~np.roll(good, 1)))
    if good[0]:
        return 0.0, max(begins - 1, 0)  # none begins where only narrow gaps are between
    if not begins or linkage.needed_references:
        raise stuck
    apart = np.round(np.minimum(theta, 2 * pi - theta)[good], 9)
    nearest = float(theta[good][np.argmin(apart)])
    return (nearest if nearest <= pi else nearest - 2 * pi), begins - 1


def _closed(linkage: Assembled, theta: Array) -> Array:
    """At which crank angles (N,) all dyads can be closed."""
    dyads = [item for item in linkage.groups if item.margin is not None]
    pairs = zip(margins_at(linkage, theta, through=True), dyads, strict=True)
    good = [margin > _least(group) for margin, group in pairs]
    return np.all(good, axis=0) if good else np.ones(theta.shape, bool)


def margins_at(linkage: Assembled, theta: Array, through: bool = False) -> list[Array]:
    """Squared sines (N,) of the transmission angle of each dyad at crank angles (N,), rad.

    through : with those that are carried through their dead positions by other joints.
    """
    with np.errstate(all="ignore"):
        state = run(linkage.motion, linkage.start(theta))
    return [
        np.broadcast_to(state[item.margin], theta.shape)
        for item in linkage.groups
        if item.margin is not None and (through or not item.through)
    ]


def _least(group: Group) -> float:
    """Margin that a dyad has to stay above; one that goes on through change points comes to 0."""
    return -CHANGE_POINT if group.through else CHANGE_POINT


def _end(linkage: Assembled, start: float, side: int, gaps: Array) -> tuple[float, Note | str]:
    """The crank angle up to which the linkage follows from a start, and what it does there."""
    steps = np.append(np.linspace(0.0, 2 * pi, POINTS + 1), side * (gaps - start) % (2 * pi))
    way = start + side * np.unique(steps)
    good = _followed(linkage, way)
    if good == len(way):
        return float(way[-1]), ""
    thinned = np.append(way[:good][:-STEPS_BEFORE_END:THINNER], way[:good][-STEPS_BEFORE_END:])
    way, good = np.append(thinned, way[good]), len(thinned)
    for _ in range(LOOP_ROUNDS if has_loops(linkage) else ROUNDS):
        last = way[good - 1]
        way = np.append(way[: good - 1], np.linspace(last, way[good], FINER + 1))
        good = _followed(linkage, way)
        if good == len(way):  # it is reached by smaller steps
            break
    return float(way[good - 1]), _stop(linkage, way[: good + 1])


def _followed(linkage: Assembled, way: Array) -> int:
    """How many of the crank angles (N,) can be reached, one after the other."""
    count = _solvable(linkage, way) if has_loops(linkage) else len(way)
    bad = np.flatnonzero(~_closed(linkage, way[:count]))
    return max(int(bad[0]), 1) if len(bad) else count


def _solvable(linkage: Assembled, way: Array) -> int:
    """How many of the crank angles (N,) groups of loops can reach."""
    count = len(way)
    while count > 1:
        try:
            _closed(linkage, way[:count])
            break
        except BranchError as error:
            failed = int(np.argmin(np.abs(way[:count] - error.crank_angle)))
            count = max(min(failed, count - 1), 1)
    return count


def _stop(linkage: Assembled, way: Array) -> Note | str:
    """What keeps the crank from the last of some crank angles (N,)."""
    group = _stopping(linkage, way)
    if group.margin is not None:
        return group.dead
    links = [repr(link) for link in group.links]
    return Note("{links} can be moved no further", links=all_of(links))


def _stopping(linkage: Assembled, way: Array) -> Group:
    """The first group that cannot be had there; the last where rounding lets all be."""
    state = linkage.start(way)
    for group in linkage.groups:
        try:
            with np.errstate(all="ignore"):
                run(group.motion, state)
        except MotionError:
            return group
        if group.margin is not None and not np.ravel(state[group.margin])[-1] > _least(group):
            return group
    return linkage.groups[-1]


def _in_degrees(angle: float) -> str:
    return f"{degrees(angle):.2f} deg"
