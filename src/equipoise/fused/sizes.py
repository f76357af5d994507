"""How large signals of a machine are: beside that, what rounding leaves counts as nothing."""

from __future__ import annotations

from collections.abc import Sequence
from math import hypot

from equipoise.mechanism.model import Machine, size_of


def sizes_of(machine: Machine, signals: Sequence[str]) -> dict[str, float]:
    """Size of each signal, in its own unit."""
    bodies = [machine.frame, *(link.points for link in machine.links.values())]
    size = max(map(size_of, bodies)) or 1.0
    speed = abs(machine.drive.speed) or 1.0
    force = machine.mass * (size * speed**2 + hypot(*machine.gravity)) or 1.0
    rates = {"v": speed, "a": speed**2}
    found = {}
    for signal in signals:
        last = signal.rpartition(".")[2]
        if signal.startswith("points."):
            found[signal] = size * rates.get(last[0], 1.0)
        elif signal.startswith("links."):
            found[signal] = speed if last == "angular_velocity" else speed**2
        else:
            found[signal] = force * (
                size
                if last in ("shaking_moment", "frame_moment", "drive_torque", "moment")
                else 1.0
            )
    return found
