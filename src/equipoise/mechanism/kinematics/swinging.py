"""Cranks that swing: a linkage followed from crank angle 0 to either side, without a whole cycle.

Without a whole cycle the running angles of links that drive gears follow only from the path since
crank angle 0, where the start angles of gears hold.

What needs to be known near a crank angle before it is solved there, running angles of links and
poses of loop groups, is kept along the way.
"""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import replace
from math import ceil, degrees, pi

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.errors import ChangePointError, RangeError
from equipoise.i18n import Note, to_say
from equipoise.mechanism.assembly.cycle import POINTS_PER_TURN
from equipoise.mechanism.assembly.linkage import Linkage, assemble
from equipoise.mechanism.assembly.reach import CHANGE_POINT, Reach, motion_line, reach, swing_within
from equipoise.mechanism.assembly.steps import State, Step, needed_references, plain_angle, run
from equipoise.mechanism.parts.machine import Machine
from equipoise.signals import Array

SWUNG = ("drive", "planting")
"""What of a machine is another where its crank swings."""


@dataclass(frozen=True)
class Swing:
    """A machine whose crank swings by a sine, once in a turn of the crank angle.

    machine : with that motion.  reach : how far its crank could go.
    """

    machine: Machine
    reach: Reach

    @property
    def note(self) -> Note:
        """What is shown, and the keys that have it in the file."""
        motion = self.machine.drive.motion
        assert motion is not None
        return Note(
            "{reason}; it is shown with an assumed sinusoidal motion just within that range, "
            "which is not in the file: {motion}",
            reason=self.reach.note,
            motion=motion_line(motion),
        )


def swing(machine: Machine) -> Swing | None:
    """The machine swinging over its range; None where its crank turns, or has a motion already.

    Raises
    ------
    MobilityError, MotionError, ModelError : the linkage cannot be moved at all.
    """
    if not machine.has_crank:
        return None
    linkage = assemble(machine)
    result = reach(linkage)
    if result is None:
        return None
    if result.is_point:
        _ = linkage.cycle  # which says so
    motion = swing_within(linkage, result).law
    drive = replace(machine.drive, motion=motion, motor=None, flywheel=0.0)
    return Swing(replace(machine, drive=drive, planting=None), result)


Stuck = RangeError | ChangePointError
"""Why a crank cannot turn fully."""


def solve_swinging(linkage: Linkage, theta: Array, error: Stuck) -> State:
    """State at crank angles (N,) of a linkage whose cycle ended with `error`.

    Raises
    ------
    MotionError : one of the crank angles is out of reach.
    """
    if any(group.kind == "loops" for group in linkage.groups):
        raise error
    start = linkage.start(theta)
    if linkage.needed_references:
        for side in (1, -1):
            _add_references(linkage, start, theta * side >= 0, side, error)
    with np.errstate(all="ignore"):
        state = run(linkage.motion, start)
    _check(linkage, state, theta, error, to_say("{error} (asked for {angle:.4g} deg)"))
    return state


def middle_angle(linkage: Linkage, link: str, theta: Array, error: Stuck) -> Array:
    """Angle of a link (N,) in the middle of the range that each crank angle lies in.

    Within a range a link swings less than half a turn to either side of that.
    """
    middles = np.zeros_like(theta)
    for low, high in getattr(error, "ranges", ()):
        middle = 0.5 * (low + high)
        inside = np.abs(np.mod(theta - middle + pi, 2 * pi) - pi) <= 0.5 * (high - low)
        middles[inside] = middle
    with np.errstate(all="ignore"):
        state = run(linkage.motion, linkage.start(middles))
    return plain_angle(state, link)


def _add_references(linkage: Linkage, state: State, chosen: Array, side: int, error: Stuck) -> None:
    """Follow the running angles from crank angle 0 to the farthest on one side."""
    theta = state["theta"]
    far = float(np.max(np.abs(theta[chosen]), initial=0.0))
    way = np.linspace(0.0, far, 2 + ceil(far / (2 * pi) * POINTS_PER_TURN))
    with np.errstate(all="ignore"):
        followed = run(linkage.motion, linkage.start(side * way))
    doing = to_say("{error} (on the way from 0 deg, where gears start, at {angle:.4g} deg)")
    _check(linkage, followed, side * way, error, doing)
    for name in linkage.needed_references:
        reference = state.setdefault(f"reference({name})", np.zeros_like(theta))
        reference[chosen] = np.interp(np.abs(theta[chosen]), way, followed[f"phi({name})"])


def _check(linkage: Linkage, state: State, theta: Array, error: Stuck, doing: str) -> None:
    """Raise the error again, with the crank angle, where a dyad cannot be closed."""
    for group in linkage.groups:
        if group.margin is None or group.through:
            continue
        margin = np.broadcast_to(state[group.margin], theta.shape)
        bad = ~(margin > CHANGE_POINT)
        if np.any(bad):
            angle = degrees(theta[int(np.argmax(bad))])
            note = Note(doing, error=error.reason, angle=angle)
            if isinstance(error, RangeError):
                raise RangeError(note, error.ranges) from None
            raise ChangePointError(note, error.crank_angle) from None


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
