"""Analyses of a machine that was analysed before, with and without the positions that are kept.

An analysis is motion, shaking force and moment, torque, all joint forces, and what the frame gets,
at 360 crank angles.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from itertools import count

import equipoise as eq
import one_thread  # noqa: F401
from equipoise.mechanism.kinematics import motion
from timing import in_turn, report

NAMES = ("yamashita-1", "watt-six-bar", "quick-return", "lee-kim-a", "class-three")
ROUNDS = 100


def analysis(machine: eq.Machine, speed: float | None = None) -> list[object]:
    """Everything that is computed of motion and forces."""
    forces = eq.analyze(machine, 360, speed=speed).forces
    return [
        forces.shaking_force,
        forces.shaking_moment,
        forces.drive_torque,
        forces.joints,
        forces.frame_force,
        forces.frame_moment,
    ]


def tasks_of(machine: eq.Machine) -> dict[str, Callable[[], object]]:
    speeds = count(1)

    def positions_anew() -> object:
        motion._kept_poses.cache_clear()
        return analysis(machine)

    return {
        "positions anew": positions_anew,
        "the same again": lambda: analysis(machine),
        "another speed": lambda: analysis(machine, float(next(speeds))),
        "a machine seen for the first time": lambda: analysis(replace(machine)),
    }


if __name__ == "__main__":
    for name in NAMES:
        print(f"-- {name}")
        report(in_turn(tasks_of(eq.load(name)), ROUNDS), "positions anew", 1e-6, "us")
