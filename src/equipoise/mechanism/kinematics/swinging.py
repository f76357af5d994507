"""Cranks that swing: a linkage whose crank cannot turn fully, at crank angles that it can reach.

Without a whole cycle nothing tells the running angles of links that drive gears, except the way
from crank angle 0, where the start angles of gears hold.
"""

from __future__ import annotations

from math import ceil, degrees, pi

import numpy as np

from equipoise.errors import ChangePointError, RangeError
from equipoise.i18n import Note, to_say
from equipoise.mechanism.assembly.cycle import POINTS_PER_TURN
from equipoise.mechanism.assembly.full_turn import CHANGE_POINT
from equipoise.mechanism.assembly.linkage import Linkage
from equipoise.mechanism.assembly.steps import Array, State, plain_angle, run

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
