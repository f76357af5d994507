"""A machine in its own units and words: one that a cylinder drives has cycles, not cranks."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from typing import Any

from equipoise.i18n import to_say, wording
from equipoise.mechanism.assembly.cycle import turns_given
from equipoise.mechanism.parts.machine import Machine
from equipoise.mechanism.parts.shown_units import units_of
from equipoise.quantities import showing_by_default

OF_CYCLES: Mapping[str, str] = {
    "{value} at crank angle {angle}": to_say("{value} at {angle} of the cycle"),
    "at crank angle {angle}": to_say("at {angle} of the cycle"),
    "{what}: up to {peak}, at crank angle {angle}": to_say(
        "{what}: up to {peak}, at {angle} of the cycle"
    ),
    "Joint {name} carries most at crank angle {angle}": to_say(
        "Joint {name} carries most at {angle} of the cycle"
    ),
    "{point} goes farthest: {length} in a turn of the crank": to_say(
        "{point} goes farthest: {length} in a cycle"
    ),
    "crank angle: phase of the cycle": to_say("angle of the cycle"),
    "crank angle": to_say("angle of the cycle"),
    "numbers: crank angle, deg": to_say("numbers: angle of the cycle, deg"),
    "in {unit}; numbers: crank angle, deg": to_say("in {unit}; numbers: angle of the cycle, deg"),
    "zero at every crank angle": to_say("zero all over the cycle"),
    "order: events in one turn of the crank": to_say("order: events in one cycle"),
    "{angles} crank angles in a cycle of {cycle}": to_say("{angles} angles of a cycle"),
    "Outputs over crank angle": to_say("Outputs over the cycle"),
    "Longest crank angle over which each moves by no more, from crank angle": to_say(
        "Longest part of the cycle over which each moves by no more, and where it begins"
    ),
    "On frame and drive; extremes with their crank angle, moments about {place}": to_say(
        "On frame and drive; extremes with where they are in the cycle, moments about {place}"
    ),
    "Force in each joint; largest with its crank angle": to_say(
        "Force in each joint; largest with where it is in the cycle"
    ),
    "Moving points: places, largest velocity and acceleration (at crank angle)": to_say(
        "Moving points: places, largest velocity and acceleration (where in the cycle)"
    ),
    "Sliders and rockers: stroke between dead positions (at crank angle), and time of the slower "
    "stroke over that of the faster": to_say(
        "Sliders and rockers: stroke between dead positions (where in the cycle), and time of the "
        "slower stroke over that of the faster"
    ),
    "Crank angle over which they rise; longest dwell within {share} % of the stroke; least "
    "mechanical advantage, which has no bound towards dead positions": to_say(
        "Part of the cycle over which they rise; longest dwell within {share} % of the stroke; "
        "least mechanical advantage, which has no bound towards dead positions"
    ),
    "Springs, each with its crank angle; below 0 they push their ends apart": to_say(
        "Springs, each with where in the cycle; below 0 they push their ends apart"
    ),
    "at every crank angle": to_say("all over the cycle"),
    "Zero at every crank angle: {names}": to_say("Zero all over the cycle: {names}"),
    "lowest at crank angle": to_say("lowest at angle of the cycle"),
    "highest at crank angle": to_say("highest at angle of the cycle"),
    "crank turns while it rises": to_say("part of the cycle while it rises"),
    "crank turns while it falls": to_say("part of the cycle while it falls"),
    "crank turns while it rests at the lowest place": to_say(
        "part of the cycle while it rests at the lowest place"
    ),
    "crank turns while it rests at the highest place": to_say(
        "part of the cycle while it rests at the highest place"
    ),
    "dwell begins at crank angle": to_say("dwell begins at angle of the cycle"),
    "lifts off at crank angle": to_say("lifts off at angle of the cycle"),
    "Any output over crank angle": to_say("Any output over the cycle"),
    "the crank stands still; playing swings the support": to_say(
        "the machine stands still; playing swings the support"
    ),
    "The shaking force on the frame as an arrow that goes around with the crank; numbers are crank "
    "angles. A long, narrow curve shakes in one direction, which a counterweight on the crank "
    "hardly helps; a round one is what such a counterweight takes away.": to_say(
        "The shaking force on the frame as an arrow over the cycle; numbers are angles of the "
        "cycle. A long, narrow curve shakes in one direction."
    ),
    "The path of a point, with marks at equal steps of the crank. Where marks are close the point "
    "is slow; a corner is a stop, and a straight stretch is guided motion.": to_say(
        "The path of a point, with marks at equal steps of the cycle. Where marks are close the "
        "point is slow; a corner is a stop, and a straight stretch is guided motion."
    ),
    "The torque that keeps the crank at its speed. Below zero the linkage drives the motor; the "
    "larger the swing, the more a flywheel or a larger motor is needed.": to_say(
        "The torque with which the drive keeps to its motion. Below zero the linkage drives the "
        "motor; the larger the peaks, the larger the motor."
    ),
    "How much of the signal comes once, twice and more often in 360° of crank angle. A "
    "counterweight on the crank acts on order 1 alone; an order that meets a natural frequency of "
    "the support shakes it most.": to_say(
        "How much of the signal comes once, twice and more often in a cycle. An order that meets a "
        "natural frequency of the support shakes it most."
    ),
    "The force in a joint over the crank angle. Its peak sizes the bearing; where it comes near "
    "zero and turns round, a joint with play knocks.": to_say(
        "The force in a joint over the cycle. Its peak sizes the bearing; where it comes near zero "
        "and turns round, a joint with play knocks."
    ),
    "Any figure that the machine has over the crank angle, such as velocities, transmission angles "
    "and forces: type some of its name.": to_say(
        "Any figure that the machine has over the cycle, such as velocities, transmission angles "
        "and forces: type some of its name."
    ),
    "at crank angles from {low} to {high}": to_say("from {low} to {high} of the cycle"),
}
"""What is said of a machine whose drive does not turn, for what is said of a crank."""
PUSHED: Mapping[str, str] = {
    "At {speed} rpm the linkage shakes its frame with a force of up to {peak} ({rms} RMS), largest "
    "at a crank angle of {angle}.": to_say(
        "At {speed} cycles a minute the linkage shakes its frame with a force of up to {peak} "
        "({rms} RMS), largest at {angle} of the cycle."
    ),
    "At {speed} rpm the linkage does not shake its frame by any force.": to_say(
        "At {speed} cycles a minute the linkage does not shake its frame by any force."
    ),
    "The shaking moment about the drive pivot reaches {peak} ({rms} RMS).": to_say(
        "The shaking moment about the pivot of the driven link reaches {peak} ({rms} RMS)."
    ),
    "There is no shaking moment about the drive pivot.": to_say(
        "There is no shaking moment about the pivot of the driven link."
    ),
    "{rpm} rpm ({rate} rad/s)": to_say("{rpm} cycles a minute"),
    "{rpm} rpm ({rate} rad/s, clockwise)": to_say("{rpm} cycles a minute"),
    "{aims} at {speed} rpm": to_say("{aims} at {speed} cycles a minute"),
    "at {speeds} rpm": to_say("at {speeds} cycles a minute"),
}
"""The same of speeds, where a cycle is a turn of the phase and nothing turns with it."""


@contextmanager
def in_own_words(model: Any) -> Iterator[None]:
    """Inside, values are shown in the units of a model, where no others are chosen, and sentences
    speak of what it has.
    """
    with showing_by_default(units_of(model)), wording(words_of(model)):
        yield


def words_of(model: Any) -> Mapping[str, str]:
    """What is said of a model by what is said of a machine with a crank; empty of one with it."""
    if not isinstance(model, Machine) or model.crank_turns:
        return {}
    is_pushed = all(item.pushes for item in model.driven) and turns_given(model) == 1
    return {**OF_CYCLES, **PUSHED} if is_pushed else OF_CYCLES
