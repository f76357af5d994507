"""What more arms like the first do, evenly spaced on the carrier that turns them."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import product
from typing import ClassVar

import numpy as np

from equipoise.balancing.policy import ALL_BUT_GONE, ARMS, WORTH_NAMING
from equipoise.dataclass import dataclass
from equipoise.i18n import say, to_say
from equipoise.mechanism.kinematics.motion import Motion
from equipoise.mechanism.parts.support import Row
from equipoise.quantities import number, percent
from equipoise.results.analysis import Analysis, analyze
from equipoise.results.declaring import Declarations, ResultOutput
from equipoise.results.yardsticks import LEAST_MEAN, FigureAssessment
from equipoise.signals import Array, Figures


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
