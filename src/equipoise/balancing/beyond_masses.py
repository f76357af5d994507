"""What helps beyond plates that are screwed on, each where what it is for is large on the machine.

Flywheels, weights on slow cranks, balance shafts and half a piston, cylinders, mounts and lengths:
each has a module of its own, with what it computes and what it says.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from equipoise.balancing.cylinder_sizes import Cylinder, cylinder_for, cylinder_sentences
from equipoise.balancing.first_order import (
    WORTHWHILE,
    BalanceShafts,
    PistonBalance,
    balance_shafts_for,
    piston_balance_for,
    piston_sentences,
    shafts_sentence,
)
from equipoise.balancing.flywheels import Flywheels, flywheel_sentences, flywheels_for
from equipoise.balancing.poor_transmission import (
    PoorTransmission,
    poor_transmission_for,
    transmission_sentences,
)
from equipoise.balancing.resonant_mounts import ResonantMounts
from equipoise.i18n import say
from equipoise.mechanism.parts.machine import Machine
from equipoise.quantities import angle, percent, told
from equipoise.results.analysis import Analysis
from equipoise.results.yardsticks import FigureAssessment


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
class Beyond:
    """What helps against what is large, beyond plates; None where it does not.

    All of it is for the machine as it is advised: with the change that is offered, if one is.
    """

    flywheels: Flywheels | None
    counterbalance: Counterbalance | None
    shafts: BalanceShafts | None
    piston: PistonBalance | None
    cylinder: Cylinder | None
    transmission: PoorTransmission | None
    mounts: ResonantMounts | None


def beyond_masses(
    analysis: Analysis,
    entries: tuple[FigureAssessment, ...],
    mounts: ResonantMounts | None = None,
) -> Beyond:
    """What helps a machine at constant speed, whose figures are ranked.

    mounts : of the machine, where a resonance lies beside its speed.
    """
    return Beyond(
        flywheels_for(analysis, entries),
        counterbalance_for(analysis, entries),
        balance_shafts_for(analysis, entries),
        piston_balance_for(analysis, entries),
        cylinder_for(analysis, entries),
        poor_transmission_for(analysis, entries),
        mounts,
    )


SLOW = 0.5
"""Acceleration of the crank's end over gravity up to which a weight on it acts by being heavy."""


def counterbalance_for(
    analysis: Analysis, entries: tuple[FigureAssessment, ...]
) -> Counterbalance | None:
    """The weight on the crank that takes order 1 out of a large drive torque; None where there is
    no such torque, the crank is fast, or little of the torque is of order 1.

    A first moment u (complex, in the crank's axes) at the crank angle a adds g Re(u e^(ia)) to the
    torque that lifts it.
    """
    machine, motion = analysis.machine, analysis.resolved.motion
    torque = next((one for one in entries if one.is_torque and one.is_large), None)
    gravity = -machine.gravity[1]
    points = machine.links[machine.drive.link].points
    throw = max(abs(complex(*point)) for point in points.values())
    if torque is None or not machine.has_crank or motion.speed**2 * throw > SLOW * gravity:
        return None
    values = analysis.outputs[torque.output].resolved
    angle = motion.links[machine.drive.link].angle
    swing = values - motion.mean(values)
    first = 2 * motion.mean(swing * np.exp(-1j * angle))
    rest = swing - (first * np.exp(1j * angle)).real
    gain = 1 - float(np.sqrt(motion.mean(rest**2) / motion.mean(swing**2)))
    moment = -complex(first) / gravity
    if gain < WORTHWHILE or abs(moment) > machine.mass * throw:
        return None
    return Counterbalance(abs(moment), float(np.angle(moment)), gain)


# -- sentences -------------------------------------------------------------------------------------


def sentences_beyond(beyond: Beyond, machine: Machine, changed: bool) -> Iterator[str]:
    """What helps beyond masses and mounts, the most urgent first.

    machine : that the answers are for.
    changed : whether that is the machine with a change of masses that is offered.
    """
    crank = machine.drive.link
    if beyond.cylinder is not None:
        yield from cylinder_sentences(beyond.cylinder)
    if beyond.flywheels is not None:
        yield from flywheel_sentences(beyond.flywheels, crank, machine.mass)
    piston = None if changed else beyond.piston
    if piston is not None:
        yield from piston_sentences(piston, crank)
    if beyond.shafts is not None:
        yield shafts_sentence(beyond.shafts, crank, changed, piston)
    if beyond.counterbalance is not None and not changed:
        yield _weight_sentence(beyond.counterbalance, crank)
    if beyond.transmission is not None:
        yield from transmission_sentences(beyond.transmission, machine.crank_turns)


def _weight_sentence(weight: Counterbalance, crank: str) -> str:
    return say(
        "A weight of {moment} on {crank}, at {direction} in its axes, would take {gain} % off "
        "the swing of the drive torque.",
        moment=told(weight.moment, "unbalance", "kg m", digits=2),
        crank=crank,
        direction=angle(weight.direction, 0),
        gain=percent(weight.gain, 0),
    )
