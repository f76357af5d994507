"""What turns: unbalance of machines of rotors alone, and how evenly a crank runs.

In some machines nothing moves but links that turn about fixed pivots of a support on mounts. What
shakes such a machine is unbalance, and that is either what it is for, as of a vibrating sieve,
or a fault, as of a fan.  Its file does not say which, so that neither is taken for granted.
"""

from __future__ import annotations

from cmath import phase
from math import inf, pi

import numpy as np

from equipoise.i18n import say
from equipoise.mechanism.dynamics.forces import massless
from equipoise.mechanism.dynamics.reduced import reduced_inertia
from equipoise.mechanism.kinematics.motion import move
from equipoise.mechanism.parts.machine import Machine
from equipoise.mechanism.parts.support import Row
from equipoise.quantities import angle, format_quantity
from equipoise.results.analysis import Analysis

BALANCED = 6.3e-3
"""Distance of a centre of mass from its pivot times the speed, m/s, up to which a rotor counts as
balanced: grade G 6.3 of ISO 21940-11, that of machinery in general."""


def unbalances(machine: Machine) -> dict[str, complex]:
    """Unbalance of each rotor about its pivot, kg m, in the axes of the link; those are left out
    that are balanced at the speed of the drive.

    Empty of a machine in which something else moves too, whose support is not on mounts, or whose
    masses are not known.
    """
    support = machine.support
    if support is None or not support.mounts or massless(machine):
        return {}
    swings = any(not coupling.speed_ratio for coupling in machine.couplings)
    if machine.sliders or swings:
        return {}
    speed = max(map(abs, (machine.drive.speed, *(machine.drive.range or ()))))
    rotors: dict[str, complex] = {}
    for name, link in machine.links.items():
        pins = [place for point, place in link.points.items() if point in machine.frame]
        if len(pins) != 1:
            return {}
        arm = complex(*(link.center_of_mass or pins[0])) - complex(*pins[0])
        if abs(arm) * speed > BALANCED:
            rotors[name] = (link.mass or 0.0) * arm
    return rotors


def rotor_sentence(machine: Machine) -> str:
    """What to do about the unbalance where nothing but rotors moves; or ""."""
    each = [
        say(
            "{unbalance} of {link} at {angle} in its axes",
            unbalance=format_quantity(abs(moment), "unbalance", "kg mm", digits=3),
            link=name,
            angle=angle(phase(moment), 0),
        )
        for name, moment in unbalances(machine).items()
    ]
    if not each:
        return ""
    return say(
        "Nothing moves but what turns about fixed pivots: leave the unbalance if it is an "
        "exciter's, which is to shake the machine; of a rotor take off {unbalances}.",
        unbalances=say(", ").join(each),
    )


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
