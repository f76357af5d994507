"""What helps beyond plates that are screwed on, each where what it is for is large on the machine.

Flywheels, weights on slow cranks, balance shafts and half a piston, cylinders, mounts and lengths:
each has a module of its own, with what it computes and what it says.
"""

from __future__ import annotations

from typing import ClassVar

import numpy as np

from equipoise.balancing.cylinder_sizes import Cylinder, cylinder_for, cylinder_sentences
from equipoise.balancing.first_order import (
    EndWeights,
    FirstOrder,
    FirstOrderShafts,
    PistonBalance,
    balance_shafts_for,
    end_sentences,
    end_weights_for,
    piston_balance_for,
    piston_sentences,
    shafts_sentence,
)
from equipoise.balancing.flywheels import Flywheels, flywheel_sentences, flywheels_for
from equipoise.balancing.policy import (
    AIMED_FROM,
    SLOW_CRANK,
    WORTH_NAMING,
)
from equipoise.balancing.poor_transmission import (
    PoorTransmission,
    mending_sentences,
    poor_transmission_for,
    transmission_sentence,
)
from equipoise.balancing.resonant_mounts import ResonantMounts
from equipoise.balancing.spaced_arms import (
    CenteredArms,
    SpacedArms,
    arms_sentences,
    centered_arms_for,
    centered_arms_sentence,
    spaced_arms_for,
)
from equipoise.balancing.workshop import weight_named
from equipoise.dataclass import dataclass
from equipoise.i18n import say
from equipoise.mechanism.dynamics.loads import outer_loads
from equipoise.mechanism.parts.machine import Machine
from equipoise.quantities import angle, percent
from equipoise.results.analysis import Analysis
from equipoise.results.declaring import Declarations, ResultOutput
from equipoise.results.yardsticks import FigureAssessment, throw_of


@dataclass(frozen=True)
class Counterbalance:
    """A weight on a slow crank that lifts where the machine is heavy, as on a beam pump.

    moment : kg m.  radius : m, of the crank's end.  direction : rad, in the axes of the crank.
    gain : share of the RMS of the torque about its mean that is gone.
    """

    moment: float
    radius: float
    direction: float
    gain: float

    declared: ClassVar[Declarations] = {
        "moment": ResultOutput("of the weight about the crank's pivot", "unbalance"),
        "radius": ResultOutput(
            "of the crank's end, where a mass of moment / radius has it", "length"
        ),
        "direction": ResultOutput("in the axes of the crank", "angle"),
        "gain": ResultOutput("share of the swing of the torque that is gone"),
    }


@dataclass(frozen=True)
class Beyond:
    """What helps against what is large, beyond plates; None where it does not.

    It is for the machine as it is advised, with the change that is offered, if one is; but for
    arms, more of them on a carrier and weights at the ends of a shaft, which take its place.
    """

    flywheels: Flywheels | None
    counterbalance: Counterbalance | None
    shafts: FirstOrderShafts | None
    piston: PistonBalance | None
    cylinder: Cylinder | None
    transmission: PoorTransmission | None
    mounts: ResonantMounts | None
    arms: CenteredArms | None
    spaced: SpacedArms | None
    ends: EndWeights | None

    declared: ClassVar[Declarations] = {
        "flywheels": ResultOutput(
            "there: that keep the speed steady, or null", of=Flywheels.declared
        ),
        "counterbalance": ResultOutput(
            "there: a weight on a slow crank that evens the drive's torque, or null",
            of=Counterbalance.declared,
        ),
        "shafts": ResultOutput(
            "there: two balance shafts as fast as the crank, beside the change that is "
            "offered, or null",
            of=FirstOrderShafts.declared,
        ),
        "piston": ResultOutput(
            "there: how much of a piston is balanced, or null", of=PistonBalance.declared
        ),
        "cylinder": ResultOutput(
            "there: the cylinder whose force is the largest figure, or null", of=Cylinder.declared
        ),
        "transmission": ResultOutput(
            "there: a poor transmission angle, and a length that mends it, or null",
            of=PoorTransmission.declared,
        ),
        "mounts": ResultOutput(
            "there: a resonance beside a speed at which the machine runs, or null",
            of=ResonantMounts.declared,
        ),
        "arms": ResultOutput(
            "there: arms that hang on one side of their pins, where that makes the largest force "
            "in a joint, or null",
            of=CenteredArms.declared,
        ),
        "spaced": ResultOutput(
            "there: more arms, evenly spaced on the carrier, or null", of=SpacedArms.declared
        ),
        "ends": ResultOutput(
            "there: two weights at the ends of the shaft of several rows, or null",
            of=EndWeights.declared,
        ),
    }


def beyond_masses(
    analysis: Analysis,
    entries: tuple[FigureAssessment, ...],
    mounts: ResonantMounts | None = None,
    as_it_is: Beyond | None = None,
) -> Beyond:
    """What helps a machine at constant speed, whose figures are ranked.

    mounts : of the machine, where a resonance lies beside its speed.
    as_it_is : of the machine without the change, where one is offered.
    """
    return Beyond(
        flywheels_for(analysis, entries),
        counterbalance_for(analysis, entries),
        balance_shafts_for(analysis, entries),
        piston_balance_for(analysis, entries),
        cylinder_for(analysis, entries),
        poor_transmission_for(analysis, entries, as_it_is.transmission if as_it_is else None),
        mounts,
        as_it_is.arms if as_it_is else centered_arms_for(analysis, entries),
        as_it_is.spaced if as_it_is else spaced_arms_for(analysis, entries, AIMED_FROM),
        as_it_is.ends if as_it_is else end_weights_for(analysis, entries),
    )


def counterbalance_for(
    analysis: Analysis, entries: tuple[FigureAssessment, ...]
) -> Counterbalance | None:
    """The weight on the crank that takes order 1 out of a large drive torque; None where there is
    no such torque, the crank is fast, or little of the torque is of order 1.

    A first moment u (complex, in the crank's axes) at the crank angle a adds g Re(u e^(ia)) to the
    torque that lifts it.  It may be as heavy at the crank's end as all that the crank lifts:
    links and load.
    """
    machine, motion = analysis.machine, analysis.resolved.motion
    torque = next((entry for entry in entries if entry.is_torque and entry.is_large), None)
    gravity = -machine.gravity[1]
    throw = throw_of(analysis)
    if torque is None or not machine.has_crank or motion.speed**2 * throw > SLOW_CRANK * gravity:
        return None
    values = analysis.outputs[torque.output].resolved
    angle = motion.links[machine.drive.link].angle
    first = FirstOrder(motion, values - motion.mean(values), angle)
    gain = first.gain(first.without())
    moment = -2 * first.ahead / gravity  # of a real signal both parts are conjugate
    lifted = machine.mass + _hanging(analysis) / gravity
    if gain < WORTH_NAMING or abs(moment) > lifted * throw:
        return None
    return Counterbalance(abs(moment), throw, float(np.angle(moment)), gain)


def _hanging(analysis: Analysis) -> float:
    """Largest force of a load from outside against or along gravity, N."""
    down = analysis.machine.gravity[1] * 1j / abs(analysis.machine.gravity[1])
    forces = (force for _, _, force, _ in outer_loads(analysis.motion))
    return max((float(np.max(np.abs(np.real(force * np.conj(down))))) for force in forces),
               default=0.0)  # fmt: skip


# -- sentences -------------------------------------------------------------------------------------


FIRST = {
    "bearings": ("ends",),
    "weight": ("piston", "shafts"),
    "vibration": ("piston", "shafts"),
    "effort": ("counterbalance",),
}
"""By the yardstick of what is large: answers that are weights too, which no plate of the assumed
room does, and which stand first where no such plate is offered."""


def first_answers(
    beyond: Beyond, entries: tuple[FigureAssessment, ...], gain: float | None
) -> frozenset[str]:
    """Answers of `Beyond` that stand before what is said of masses.

    entries : ranked, of the machine as it is.
    gain : share of the aim that a change which is offered takes away; None where none is.
    """
    if gain is not None:
        more_arms = beyond.spaced is not None and beyond.spaced.gain >= gain
        return frozenset({"spaced"} if more_arms else ())
    if beyond.transmission is not None and any(entry.is_nearly_dead for entry in entries):
        return frozenset({"transmission"})
    aim = next(
        (entry for entry in entries if entry.is_large and (entry.is_shaking or entry.is_torque)),
        None,
    )
    names = FIRST.get(aim.yardstick_kind, ()) if aim is not None else ()
    given = {name for name in names if getattr(beyond, name) is not None}
    is_half = beyond.piston is not None and beyond.piston.is_half
    return frozenset() if given == {"piston"} and is_half else frozenset(given)


def sentences_beyond(beyond: Beyond, machine: Machine, changed: bool) -> dict[str, list[str]]:
    """What helps beyond masses and mounts, the most urgent first: sentences by answer.

    machine : that the answers are for.
    changed : whether that is the machine with a change of masses that is offered.
    """
    crank = machine.drive.link
    sentences: dict[str, list[str]] = {}
    if beyond.spaced is not None:
        sentences["spaced"] = [*arms_sentences(beyond.spaced, crank)]
    if beyond.ends is not None:
        sentences["ends"] = [*end_sentences(beyond.ends, crank)]
    if beyond.arms is not None:
        sentences["arms"] = [centered_arms_sentence(beyond.arms)]
    if beyond.cylinder is not None:
        sentences["cylinder"] = [*cylinder_sentences(beyond.cylinder)]
    if beyond.flywheels is not None:
        sentences["flywheels"] = [*flywheel_sentences(beyond.flywheels, crank, machine.mass)]
    piston = None if changed else beyond.piston
    if piston is not None:
        sentences["piston"] = [*piston_sentences(piston, crank)]
    if beyond.shafts is not None:
        sentences["shafts"] = [shafts_sentence(beyond.shafts, crank, changed, piston)]
    if beyond.counterbalance is not None and not changed:
        sentences["counterbalance"] = [_weight_sentence(beyond.counterbalance, crank)]
    if beyond.transmission is not None:
        mending = [*mending_sentences(beyond.transmission)]
        poor = transmission_sentence(beyond.transmission, machine.crank_turns)
        # With a change the first of these stands with what is large after it.
        sentences["transmission"] = mending if changed else [poor, *mending]
    return sentences


def _weight_sentence(weight: Counterbalance, crank: str) -> str:
    return say(
        "A weight of {moment} on {crank}, at {direction} in its axes, would take {gain} % off "
        "the swing of the drive torque.",
        moment=weight_named(weight.moment, weight.radius),
        crank=crank,
        direction=angle(weight.direction, 0),
        gain=percent(weight.gain, 0),
    )
