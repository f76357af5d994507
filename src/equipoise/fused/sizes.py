"""How large signals of a machine are: beside that, what rounding leaves counts as nothing."""

from __future__ import annotations

from collections.abc import Sequence
from functools import reduce
from typing import Any

import numpy as np

from equipoise.mechanism.builder import size_of_bodies
from equipoise.mechanism.model import Machine


def sizes_of(machine: Machine, signals: Sequence[str]) -> dict[str, Any]:
    """Size of each signal, in its own unit; a column (P, 1) where numbers of the machine are."""
    size, speed = size_of_bodies(machine), np.abs(machine.drive.speed)
    masses = (0.0 if link.mass is None else link.mass for link in machine.links.values())
    mass = reduce(np.add, masses)
    force = mass * (size * speed**2 + np.hypot(*machine.gravity))
    rates = {"v": speed, "a": speed**2}
    found = {}
    for signal in signals:
        last = signal.rpartition(".")[2]
        if signal.startswith("points."):
            found[signal] = size * rates.get(last[0], 1.0)
        elif signal.startswith("links."):
            found[signal] = speed if last == "angular_velocity" else speed**2
        elif last in ("shaking_moment", "frame_moment", "drive_torque", "moment"):
            found[signal] = force * size
        else:
            found[signal] = force
    return found


def has_steps(machine: Machine) -> bool:
    """Whether loads begin or end at once, so that means come closer as 1 / N only."""
    return any(load.start is not None for load in machine.loads)
