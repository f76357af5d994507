"""The whole flow, one stage a line: Machine -> Motion -> Forces -> figures."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from equipoise.mechanism.dynamics import forces, massless, place_of
from equipoise.mechanism.model import Machine, Vector
from equipoise.mechanism.motion import move
from equipoise.results.analysis import Analysis


def analyze(
    machine: Machine,
    angles: int | Sequence[float] | np.ndarray[Any, Any] = 360,
    speed: float | None = None,
    acceleration: float | None = None,
    about: str | Vector | complex | None = None,
) -> Analysis:
    """Motion and forces of a machine.

    Parameters
    ----------
    angles : number of crank angles in each turn, equally spaced from 0 over the whole cycle (which
        takes several turns where gears or loops need them), or the crank angles themselves, rad.
    speed, acceleration : of the crank, rad/s and rad/s2; those of the machine where not given.
    about : point about which moments are taken, a name or (x, y) in m; the drive pivot if None.

    Returns
    -------
    Analysis whose forces are None where the machine lacks masses.

    Raises
    ------
    MobilityError, MotionError, ModelError : the linkage cannot be moved so.
    UsageError : an argument cannot be used.
    """
    motion = move(machine, angles, speed, acceleration)
    if about is not None:
        place_of(machine, about)  # a wrong point is told of a model without masses too
    if massless(machine):
        return Analysis(motion, None)
    return Analysis(motion, forces(motion, about))
