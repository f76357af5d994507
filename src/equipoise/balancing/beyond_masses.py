"""What helps beyond plates that are screwed on: a flywheel against a torque that swings, a weight
on a slow crank, a longer lever of a cylinder, balance shafts.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import floor, log10

import numpy as np

from equipoise.mechanism.assembly.steps import size_of_links
from equipoise.results.analysis import Analysis
from equipoise.results.yardsticks import FigureAssessment, pusher_of

STEADY = 0.05
"""Share of its mean by which a crank's speed may swing where a flywheel is advised: between 0.02 of
engines and 0.2 of presses and crushers (Norton, Design of Machinery, table 11-4)."""
DIGITS, LITTLE = 2, 0.1
"""Of a flywheel that is advised; share of it that nobody misses."""
RATIOS = (1, 2, 3, 4, 5, 6, 8, 10)
"""Turns of a flywheel's shaft in one of the crank: of a crank that turns slowly, as of a press, it
sits on the shaft of the motor or of a belt, where the square of the ratio less will do."""


@dataclass(frozen=True)
class Flywheel:
    """A flywheel that is missing.

    inertia : kg m2, on a shaft that turns `ratio` times as fast as the crank.
    """

    inertia: float
    ratio: int


@dataclass(frozen=True)
class Counterbalance:
    """A weight on a slow crank that lifts where the machine is heavy, as on a beam pump.

    moment : kg m.  direction : rad, in the axes of the crank.  gain : share of the RMS of the
    torque about its mean that is gone.
    """

    moment: float
    direction: float
    gain: float


@dataclass(frozen=True)
class BalanceShafts:
    """Two shafts as fast as the crank, one each way, against the force of order 1.

    forward, backward : kg m, of what turns with the crank and against it.  gain : share of the RMS
    of the shaking force that is gone.
    """

    forward: float
    backward: float
    gain: float


@dataclass(frozen=True)
class Lever:
    """How far beside a pin a cylinder pushes, where its force is largest.

    arm : m.  pivot : the pin.  crank_angle : rad.
    """

    arm: float
    pivot: str
    crank_angle: float


@dataclass(frozen=True)
class Beyond:
    """What helps against what is large, beyond plates; None where it does not."""

    flywheel: Flywheel | None
    counterbalance: Counterbalance | None
    shafts: BalanceShafts | None
    lever: Lever | None


def beyond_masses(analysis: Analysis, entries: tuple[FigureAssessment, ...]) -> Beyond:
    """What helps a machine at constant speed, whose figures are ranked."""
    return Beyond(
        flywheel_for(analysis, entries),
        counterbalance_for(analysis, entries),
        balance_shafts_for(analysis, entries),
        lever_for(analysis, entries),
    )


def flywheel_for(analysis: Analysis, entries: tuple[FigureAssessment, ...]) -> Flywheel | None:
    """A flywheel that keeps the crank's speed within `STEADY` of the mean, beside what turns with
    it already; None where the drive's torque is not the largest figure, or nothing is missing.

    The torque of the drive at constant speed, less its mean, does the work that speeds the crank
    up: I = (largest less smallest work) / (`STEADY` w^2).  It sits on the slowest shaft on which a
    disc as large as the largest link is no heavier than all links; on none, None.
    """
    machine = analysis.machine
    largest = next(iter(entries), None)
    if largest is None or not machine.has_crank or not largest.is_swing_about_mean:
        return None
    torque = analysis.outputs[largest.output].values
    step = abs(2 * np.pi * analysis.motion.turns) / len(torque)
    work = np.cumsum(torque - np.mean(torque)) * step
    needed = float(np.ptp(work)) / (STEADY * analysis.motion.speed**2)
    motor = machine.drive.motor
    there = machine.drive.flywheel + (motor.inertia * motor.ratio**2 if motor else 0.0)
    missing = needed - there
    if missing < LITTLE * needed:
        return None
    most = machine.mass * size_of_links(machine) ** 2 / 2
    ratio = next((one for one in RATIOS if missing / one**2 <= most), None)
    return None if ratio is None else Flywheel(_rounded_up(missing / ratio**2), ratio)


SLOW, WORTHWHILE = 0.5, 0.3
"""Acceleration of the crank's end over gravity up to which a weight on it acts by being heavy;
share of its aim from which what is not drawn here is named."""


def counterbalance_for(
    analysis: Analysis, entries: tuple[FigureAssessment, ...]
) -> Counterbalance | None:
    """The weight on the crank that takes order 1 out of a large drive torque; None where there is
    no such torque, the crank is fast, or little of the torque is of order 1.

    A first moment u (complex, in the crank's axes) at the crank angle a adds g Re(u e^(ia)) to the
    torque that lifts it.
    """
    machine, motion = analysis.machine, analysis.motion
    torque = next((one for one in entries if one.is_torque and one.is_large), None)
    gravity = -machine.gravity[1]
    points = machine.links[machine.drive.link].points
    throw = max(abs(complex(*point)) for point in points.values())
    if torque is None or not machine.has_crank or motion.speed**2 * throw > SLOW * gravity:
        return None
    values = analysis.outputs[torque.output].values
    angle = motion.links[machine.drive.link].angle
    swing = values - motion.mean(values)
    first = 2 * motion.mean(swing * np.exp(-1j * angle))
    rest = swing - (first * np.exp(1j * angle)).real
    gain = 1 - float(np.sqrt(motion.mean(rest**2) / motion.mean(swing**2)))
    moment = -complex(first) / gravity
    if gain < WORTHWHILE or abs(moment) > machine.mass * throw:
        return None
    return Counterbalance(abs(moment), float(np.angle(moment)), gain)


SHAKES_SELF = 8.0
"""Times its yardstick from which a force is worth two more shafts."""


def balance_shafts_for(
    analysis: Analysis, entries: tuple[FigureAssessment, ...]
) -> BalanceShafts | None:
    """Balance shafts against the shaking force; None where it is not large enough for them, or
    little of it is of order 1.

    With F = A e^(ia) + B e^(-ia) + the rest, the unbalances are |A| / w^2 and |B| / w^2.
    """
    machine, motion = analysis.machine, analysis.motion
    force = next((one for one in entries if one.output == "shaking_force"), None)
    if force is None or not machine.has_crank or force.ratio < SHAKES_SELF:
        return None
    x, y = (analysis.outputs[f"shaking_force.{axis}"].values for axis in "xy")
    whole = x + 1j * y
    turned = np.exp(1j * motion.crank_angle)
    ahead, against = motion.mean(whole / turned), motion.mean(whole * turned)
    rest = whole - ahead * turned - against / turned
    gain = 1 - float(np.sqrt(motion.mean(abs(rest) ** 2) / motion.mean(abs(whole) ** 2)))
    if gain < WORTHWHILE:
        return None
    forward, backward = (float(abs(one)) / motion.speed**2 for one in (ahead, against))
    return BalanceShafts(forward, backward, gain)


def _rounded_up(value: float) -> float:
    unit = 10.0 ** (floor(log10(value)) - DIGITS + 1)
    return float(np.ceil(value / unit * (1 - 1e-9)) * unit)


def lever_for(analysis: Analysis, entries: tuple[FigureAssessment, ...]) -> Lever | None:
    """The lever about the pin of both its bodies with which a cylinder pushes where its force is
    largest; None where that is not the largest figure, or the bodies share no single pin.
    """
    machine, motion = analysis.machine, analysis.motion
    largest = next(iter(entries), None)
    drive = None if largest is None else pusher_of(machine, largest.output)
    if largest is None or drive is None or drive.between is None or largest.crank_angle is None:
        return None
    bodies = machine.bodies
    near, far = (set(bodies[body]) for body in drive.ends(bodies))
    if len(shared := near & far) != 1 or not largest.is_large:
        return None
    (pivot,) = shared
    k = int(np.argmin(np.abs(np.exp(1j * (motion.crank_angle - largest.crank_angle)) - 1)))
    first, second, center = (complex(motion.points[at].place[k]) for at in (*drive.between, pivot))
    along = second - first
    arm = abs((np.conj(along) * (center - first)).imag) / abs(along)
    return Lever(float(arm), pivot, largest.crank_angle)
