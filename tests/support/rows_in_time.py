"""Rows of linkages added in time: each is analysed at crank angles ahead by its phase."""

from __future__ import annotations

from collections.abc import Sequence
from math import pi

import numpy as np

import equipoise as eq
from equipoise.balancing.cylinder_phasing import PhasedRows, PhaseObjective
from equipoise.mechanism.parts.balance import Objective
from equipoise.mechanism.parts.support import Row
from unit.vibration.build import Array


def side_by_side(machine: eq.Machine, phases: Sequence[float], spacing: float = 0.3) -> eq.Machine:
    middle = (len(phases) - 1) / 2
    return machine.with_rows(Row(p, spacing * (k - middle)) for k, p in enumerate(phases))


def anyhow(machine: eq.Machine, seed: int, count: int = 3) -> eq.Machine:
    """Rows in random phases, at random places."""
    rng = np.random.default_rng([seed, 5])
    return machine.with_rows(
        Row(rng.uniform(-4, 9), rng.uniform(-1, 1), tuple(rng.uniform(-0.3, 0.3, 2)))
        for _ in range(count)
    )


def in_time(machine: eq.Machine, output: str, about: str | None = None, count: int = 720) -> Array:
    """An output (N,) of all rows together over the cycle, complex where it is a vector."""
    turns = eq.move(machine, 90).turns
    theta = np.arange(count * turns) * (2 * pi / count)
    total: Array = np.zeros(len(theta))
    for row in machine.rows:
        forces = eq.analyze(machine, theta + row.phase, acceleration=0.0, about=about).forces
        x, y = row.offset
        force = forces.shaking_force.value
        whole = forces.frame_force.value
        signal = {
            "shaking_force": force,
            "shaking_force.x": force.real,
            "shaking_force.y": force.imag,
            "shaking_moment": forces.shaking_moment + x * force.imag - y * force.real,
            "drive_torque": forces.drive_torque,
            "roll_moment": -row.lateral * force.imag,
            "yaw_moment": row.lateral * force.real,
            "frame_force": whole,
            "frame_force.y": whole.imag,
            "frame_moment": forces.frame_moment + x * whole.imag - y * whole.real,
        }[output]
        total = total + signal
    return total


def measured(values: Array, measure: str) -> float:
    if measure == "rms":
        return float(np.sqrt(np.mean(np.abs(values) ** 2)))
    if measure == "ripple":
        return float(np.std(values))
    if measure == "peak":
        return float(np.max(np.abs(values)))
    if measure == "peak_to_peak":
        return float(np.max(values) - np.min(values))
    return float(2 * pi * np.mean(np.abs(values)))


def value_of(machine: eq.Machine, objective: Objective) -> float:
    """What the package says of the machine as it is."""
    phases = np.array([row.phase for row in machine.rows])
    return float(PhaseObjective(objective, PhasedRows(machine).signals(objective)).values(phases))
