"""The frame of a slider-crank on its mounts, from rest and at a constant speed, against Exudyn.

Exudyn's steps are wrong as their square: that is taken out by means of steps twice as long, and
leaves 2e-7 of the largest displacement from rest and 5e-8 at a constant speed.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import equipoise as eq
from support.conformance import compared
from support.sources import EXUDYN

DURATION, STEP = 1.0, 5e-4
"""Of the simulations, and of a step of the finer one, s."""


def difference(at_speed: bool) -> float:
    """Largest difference of the frame's displacement, over the largest displacement."""
    pytest.importorskip("exudyn")
    from support.exudyn_model import MACHINE, SAMPLING, TORQUE, shake

    speed = MACHINE.drive.speed if at_speed else None
    centers = tuple(MACHINE.links[name].center_of_mass[0] for name in ("crank", "rod"))
    fine, coarse = (shake(centers, speed, DURATION, step) for step in (STEP, 2 * STEP))
    constant = eq.mechanism.MotorTable((0.0, 1.0), (TORQUE, TORQUE))
    motor = eq.mechanism.Motor(table=constant, mean_speed="free")
    machine = replace(MACHINE, drive=replace(MACHINE.drive, motor=motor))
    samples = round(DURATION / SAMPLING) + 1
    simulation = eq.simulate(machine, DURATION, speed, drive=not at_speed, samples=samples)
    apart = []
    for axis, exact in simulation.gauges.items():
        first, other = getattr(fine, axis), getattr(coarse, axis)
        apart.append(np.max(np.abs(first + (first - other) / 3 - exact)) / np.max(np.abs(exact)))
    return float(max(apart))


@compared(
    EXUDYN, "displacement of the frame in a second", 1e-6, "from rest under a constant torque"
)
def test_from_rest() -> float:
    return difference(at_speed=False)


# From rest, by the same model: the other test.
@pytest.mark.exhaustive
@compared(EXUDYN, "displacement of the frame in a second", 1e-7, "at the drive's speed")
def test_at_the_speed_of_the_drive() -> float:
    return difference(at_speed=True)
