"""Arms that turn about a pin on another link: centred on it, or several of them evenly spaced.

A counterweight about a pivot of the frame does not reach the joint by which a planet, or an arm
that it carries, hangs on its carrier; mass of the arm itself, laid about its own pin, does.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import product
from typing import ClassVar

import numpy as np

from equipoise.balancing.policy import (
    ALL_BUT_GONE,
    ARMS,
    WORTH_NAMING,
)
from equipoise.balancing.workshop import weight_named
from equipoise.dataclass import dataclass
from equipoise.errors import EquipoiseError
from equipoise.i18n import say, to_say
from equipoise.mechanism.assembly.steps import size_of_links
from equipoise.mechanism.checks import bodies_at
from equipoise.mechanism.kinematics.motion import Motion
from equipoise.mechanism.parts.links import Link
from equipoise.mechanism.parts.machine import Machine
from equipoise.mechanism.parts.support import Row
from equipoise.quantities import display, format_quantity, number, percent
from equipoise.results.analysis import Analysis, analyze
from equipoise.results.declaring import Declarations, ResultOutput
from equipoise.results.outputs import LEAST_MEAN
from equipoise.results.yardsticks import FigureAssessment, assess
from equipoise.signals import Array, Figures

NOTHING, MINOR = 1e-3, 0.1
"""Over the size of the largest link: a centre of mass so near its pin lies on it; over the largest
first moment of an arm, one that is not worth a word."""


@dataclass(frozen=True)
class CenteredArms:
    """Arms whose centres of mass would take much off a force in joints, if they lay on their pins.

    links, pins : of each arm.  distance : m, the largest of a centre of mass from its pin.
    moment : kg m, the largest first moment of an arm about its pin.
    label : of the force.  before, after : N.  gain : share of it that is gone.
    """

    links: tuple[str, ...]
    pins: tuple[str, ...]
    distance: float
    moment: float
    label: str
    before: float
    after: float
    gain: float

    declared: ClassVar[Declarations] = {
        "links": ResultOutput("arms that hang on one side of their pins"),
        "pins": ResultOutput("of each arm"),
        "distance": ResultOutput("largest, of a centre of mass from its pin", "length"),
        "moment": ResultOutput("largest first moment of an arm about its pin", "unbalance"),
        "label": ResultOutput("the largest force in a joint"),
        "before": ResultOutput("that force", "force"),
        "after": ResultOutput("with the centres of mass on the pins", "force"),
        "gain": ResultOutput("share of it that is gone"),
    }


def centered_arms_for(
    analysis: Analysis, entries: tuple[FigureAssessment, ...]
) -> CenteredArms | None:
    """Arms against a force in a joint that is the largest figure; None where it is none, or where
    they are not what makes it large.
    """
    machine, largest = analysis.machine, next(iter(entries), None)
    if largest is None or largest.yardstick_kind != "acting" or not largest.is_large:
        return None
    arms = _arms_of(machine)
    changed, distances = (
        machine,
        [_distance(machine.links[name], pin) for name, pin in arms.items()],
    )
    for name, pin in arms.items():
        changed = changed.with_link(name, center_of_mass=machine.links[name].points[pin])
    try:
        after = assess(analyze(changed, acceleration=0.0), None) if arms else ()
    except EquipoiseError:  # a joint that the weight of an arm held
        return None
    values = [abs(item.value) for item in after if item.family == largest.family]
    if not values or (gain := 1 - values[0] / abs(largest.value)) < WORTH_NAMING:
        return None
    label = largest.label.localized()
    links, pins, distance = tuple(arms), tuple(arms.values()), max(distances, default=0.0)
    before = abs(largest.value)
    moment = max(machine.links[name].mass * away  # type: ignore[operator]  # weighed by now
                 for name, away in zip(links, distances, strict=True))  # fmt: skip
    return CenteredArms(links, pins, distance, moment, label, before, values[0], float(gain))


def _arms_of(machine: Machine) -> dict[str, str]:
    """Links that are joined to others at one pin alone, which moves, and that pin."""
    joined = {name for name, bodies in bodies_at(machine.bodies).items() if len(bodies) > 1}
    least = NOTHING * size_of_links(machine)
    result, moments = dict[str, str](), dict[str, float]()
    for name, link in machine.links.items():
        pins = [point for point in link.points if point in joined]
        guided = any(name in (slider.link, slider.on) for slider in machine.sliders)
        if len(pins) != 1 or pins[0] in machine.frame or guided or link.bodies:
            continue
        away = _distance(link, pins[0])
        if away > least:
            result[name], moments[name] = pins[0], (link.mass or 0.0) * away
    most = max(moments.values(), default=0.0)
    return {name: pin for name, pin in result.items() if moments[name] >= MINOR * most}


def _distance(link: Link, pin: str) -> float:
    """Of a link's centre of mass from a pin, m; 0 where none is given."""
    center = link.center_of_mass
    return 0.0 if center is None else abs(complex(*center) - complex(*link.points[pin]))


def centered_arms_sentence(arms: CenteredArms) -> str:
    """What the arms would leave of the force."""
    unit_display = display("force", [arms.before, arms.after])
    return say(
        "With the centre of mass of {links} on {pins} (now {distance} away), {what}, would "
        "decrease from {before} to {after}, by {gain} %: remove mass beyond the pin, or add mass "
        "behind it, up to {weight} on each.",
        weight=weight_named(arms.moment, arms.distance),
        links=say(", ").join(arms.links),
        pins=say(", ").join(arms.pins),
        distance=format_quantity(arms.distance, "length", digits=3),
        what=arms.label,
        before=unit_display.with_unit(unit_display.text(arms.before, digits=3)),
        after=unit_display.with_unit(unit_display.text(arms.after, digits=3)),
        gain=percent(arms.gain, 0),
    )


@dataclass(frozen=True)
class SpacedArms:
    """Arms like the first, evenly spaced on the same carrier.

    count : with the first.  gain : share of the RMS of the shaking force that is gone.
    swing_before, swing_after : peak to peak of the drive torque over its mean, with one arm and
        with all; None where the torque is not large, or has no mean.
    """

    count: int
    gain: float
    swing_before: float | None
    swing_after: float | None

    declared: ClassVar[Declarations] = {
        "count": ResultOutput("how many, with the first"),
        "gain": ResultOutput("share of the shaking force that is gone"),
        "swing_before": ResultOutput(
            "drive torque, peak to peak, over its mean; null where it is not large or has no mean"
        ),
        "swing_after": ResultOutput("with all arms, or null"),
    }


def spaced_arms_for(
    analysis: Analysis, entries: tuple[FigureAssessment, ...], least_excess: float
) -> SpacedArms | None:
    """The fewest arms that take all but a little off the shaking force, else those that take off
    most; None where that is little.

    A machine of which more than the driven link is held by pins or guides of the frame has no place
    for more of them in its plane; a track that stands in the frame serves all arms.

    Parameters
    ----------
    least_excess : of the shaking force, from which arms are looked at.
    """
    machine = analysis.machine
    force = next((entry for entry in entries if entry.output == "shaking_force"), None)
    others = [link for name, link in machine.links.items() if name != machine.drive.link]
    is_so = any(point in machine.frame for link in others for point in link.points)
    is_so |= any(slider.on == "frame" for slider in machine.sliders)
    if force is None or force.excess < least_excess or is_so or machine.rows or not others:
        return None
    if not machine.has_crank or not machine.crank_turns:
        return None
    best: SpacedArms | None = None
    for count in ARMS:
        if _pass_each_other(analysis.motion, count):
            arms = _arms(analysis, entries, count)
            if best is None or arms.gain > best.gain:
                best = arms
            if arms.gain >= ALL_BUT_GONE:
                break
    return best if best is not None and best.gain >= WORTH_NAMING else None


def _arms(analysis: Analysis, entries: tuple[FigureAssessment, ...], count: int) -> SpacedArms:
    """So many arms, by the sum of their forces."""
    phases = 2 * np.pi * np.arange(count) / count
    rows = tuple(Row(phase=float(phase)) for phase in phases)
    every = analyze(analysis.machine.with_rows(rows), acceleration=0.0).summary
    gain = 1 - every["rows.shaking_force"].rms / analysis.summary["shaking_force"].rms
    swings: list[float | None] = [None, None]
    torque = next((entry.output for entry in entries if entry.is_torque and entry.is_large), None)
    if torque is not None:
        swings = [_swing(item) for item in (analysis.summary[torque], every[f"rows.{torque}"])]
    before, after = swings if None not in swings else (None, None)
    return SpacedArms(count, float(gain), before, after)


def _swing(torque: Figures) -> float | None:
    """Peak to peak over the mean; None without a mean."""
    mean = abs(torque.mean)
    return float(torque.peak_to_peak / mean) if mean >= LEAST_MEAN * torque.rms > 0 else None


def _pass_each_other(motion: Motion, count: int) -> bool:
    """Whether no lines between points of one arm ever cross those of another.

    The arm before is where this one was an even part of a turn ago.
    """
    lines = [*_lines(motion)]
    turn = len(motion.crank_angle) // motion.turns
    shifts = {round(turn * k / count) for k in range(1, count)}
    return not any(
        np.any(_cross(first, tuple(np.roll(end, shift) for end in second)))
        for first, second in product(lines, lines)
        for shift in shifts
    )


def _lines(motion: Motion) -> Iterator[tuple[Array, Array]]:
    """Both ends (N,) of lines from the first point of each link of an arm to its others."""
    for name, link in motion.machine.links.items():
        if name != motion.machine.drive.link:
            first, *others = (motion.points[point].place for point in link.points)
            yield from ((first, other) for other in others)


def _cross(first: tuple[Array, ...], second: tuple[Array, ...]) -> Array:
    """Where (N,) two lines cross: the ends of each lie on both sides of the other."""

    def sides(line: tuple[Array, ...], ends: tuple[Array, ...]) -> Array:
        along = line[1] - line[0]
        a, b = (np.imag(np.conj(along) * (end - line[0])) for end in ends)
        return np.asarray(a * b < 0)

    return np.asarray(sides(first, second) & sides(second, first))


def arms_sentences(arms: SpacedArms, crank: str) -> Iterator[str]:
    """What more arms would do."""
    second = to_say(
        "A second arm like this one, opposite on {crank}, would take {gain} % off the shaking "
        "force, and work twice in a turn."
    )
    several = to_say(
        "{count} arms like this one, evenly spaced on {crank}, would take {gain} % off the shaking "
        "force, and work {count} times in a turn."
    )
    template = second if arms.count == 2 else several
    yield say(template, count=arms.count, crank=crank, gain=percent(arms.gain, 0))
    if arms.swing_before is not None and arms.swing_after is not None:
        yield say(
            "The drive torque would then swing by {after} times its mean instead of {before}.",
            after=number(arms.swing_after, digits=2),
            before=number(arms.swing_before, digits=2),
        )
