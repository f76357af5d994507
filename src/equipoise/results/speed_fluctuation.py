"""How evenly what turns on a crank lets it run under a constant torque of its drive."""

from __future__ import annotations

from math import inf, pi

import numpy as np

from equipoise.mechanism.dynamics.reduced import reduced_inertia
from equipoise.mechanism.kinematics.motion import move
from equipoise.mechanism.parts.support import Row
from equipoise.results.analysis import Analysis

STEADY, COARSE = 0.05, 0.2
"""Share of its mean by which a crank's speed may swing: of engines and pumps, and at most, as of
presses and crushers (Norton, Design of Machinery, table 11-4)."""


def speed_fluctuation(analysis: Analysis) -> float | None:
    """Highest less lowest speed of the crank over its mean, if its drive gave the mean of its
    torque at every crank angle; infinite where the crank would not come round.

    Loads are those at the constant speed of the analysis.  `running.flywheel` has the steady state
    itself; both agree where loads depend on the speed by little.  None of what is no crank that
    turns evenly, over a whole cycle.
    """
    motion, machine = analysis.motion, analysis.machine
    name = analysis.whole("drive_torque")
    if not (machine.has_crank and motion.is_steady_cycle and name in analysis.outputs):
        return None
    theta, torque = motion.crank_angle, analysis.outputs[name].values
    rows = [move(machine, theta + row.phase) for row in machine.rows or (Row(),)]
    inertia = sum((reduced_inertia(row)[0] for row in rows), np.zeros(len(theta)))
    inertia = inertia + machine.drive.shaft_inertia
    # what the drive gives beyond its mean at a constant speed, the turning masses give instead
    gaps = np.diff(theta, append=theta[0] + 2 * pi * motion.turns)
    excess = float(np.sum(gaps * (torque + np.roll(torque, -1)) / 2)) / (2 * pi * motion.turns)
    lacking = excess - torque
    work = np.concatenate([[0.0], np.cumsum(gaps * (lacking + np.roll(lacking, -1)) / 2)[:-1]])
    work -= np.sum(gaps * work / inertia) / np.sum(gaps / inertia)  # since it has the mean speed
    squares = motion.speed**2 + 2 * work / inertia
    if np.min(squares) <= 0:
        return inf
    return float(np.ptp(np.sqrt(squares)) / abs(motion.speed))
