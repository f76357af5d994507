"""What a search for the steady state begins with: equations, conditions, a first guess."""

from __future__ import annotations

from collections.abc import Iterable
from math import pi
from typing import Any

import numpy as np

from equipoise.mechanism.dynamics import forces
from equipoise.mechanism.linkage import assemble
from equipoise.mechanism.model import Machine
from equipoise.mechanism.motion import move
from equipoise.structures.collocation import Conditions
from equipoise.structures.coupled import Coupled
from equipoise.structures.linear import Linear
from equipoise.structures.linkages import rows_of
from equipoise.structures.motor import speed_at, torque_on_crank
from equipoise.structures.steady import SAMPLES

Array = np.ndarray[Any, Any]

ROUGH = 12
"""Orders of the linear response that do to start from."""


def equations(machine: Machine, speed: float, drive: bool) -> tuple[Coupled, Linear | None]:
    """The exact equations, and the linear ones about the same rest; None on solid ground.

    drive : whether the crank's speed follows from the motor.
    """
    torque = torque_on_crank(machine.drive, speed) if drive else None
    if machine.support is None:
        assert torque is not None
        return Coupled.on_ground(machine, speed, torque), None
    linear = Linear.of(machine, "moment")
    return Coupled.on_support(linear.body, linear.rest, speed, torque), linear


def turns_of(machine: Machine) -> int:
    """Turns of the crank in a period."""
    return assemble(machine).cycle.turns


def conditions_of(system: Coupled) -> Conditions:
    """What closes a period: everything comes back, and the mean speed is held where it is."""
    conditions = Conditions.periodic(system.count)
    if system.torque is None:
        return conditions
    begin, end, value = conditions.begin.copy(), conditions.end.copy(), conditions.value.copy()
    time, shift = system.count - 2, system.count - 1
    begin[time], end[time] = 0.0, 0.0
    begin[time, time] = 1.0  # the time begins at 0
    begin[shift], end[shift] = 0.0, 0.0
    motor = system.machine.drive.motor
    assert motor is not None
    if motor.mean_speed == "held":
        end[shift, time] = 1.0
        value[shift] = 2 * pi * turns_of(system.machine) / abs(system.speed)
    else:
        begin[shift, shift] = 1.0
    return Conditions(begin, end, value)


def from_linear(
    system: Coupled, linear: Linear | None, setting: tuple[float, float] | None, s: Array
) -> Array:
    """States of the linear response, with the crank's speed constant.

    setting : with a motor, mean speed and shift of its curve.
    """
    states = []
    if linear is not None:
        moved, theta = linear.motion(system.speed).upto(ROUGH), system.sense * s
        states = [*moved.values(theta), *(moved.derivative() * system.speed).values(theta)]
    return np.stack(states) if setting is None else with_motor(states, setting, s)


def with_motor(states: Iterable[Array], setting: tuple[float, float], s: Array) -> Array:
    """States of the support with those of a motor that runs evenly."""
    speed, shift = setting
    return np.stack([*states, np.full_like(s, speed), s / abs(speed), np.full_like(s, shift)])


def motor_setting(machine: Machine, speed: float) -> tuple[float, float]:
    """Mean speed of the crank and shift of the motor's curve, rad/s, if the speed were constant."""
    motor = machine.drive.motor
    assert motor is not None
    sense = float(np.sign(speed))
    own = speed_at(motor, sense * _mean_torque(machine, speed) / motor.ratio)
    if motor.mean_speed == "free":
        return sense * own / motor.ratio, 0.0
    return speed, motor.ratio * abs(speed) - own


def _mean_torque(machine: Machine, speed: float) -> float:
    found = forces(move(machine, SAMPLES, speed, 0.0))
    return float(np.mean(found.drive_torque)) * len(rows_of(machine))
