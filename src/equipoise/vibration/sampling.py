"""At which crank speeds a response is computed: about resonances, and where its curves bend."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping

import numpy as np

from equipoise.errors import ResponseError
from equipoise.i18n import Note, to_say
from equipoise.limits import check_memory
from equipoise.signals import Array
from equipoise.vibration.linear import Linear
from equipoise.vibration.resonance import Resonance
from equipoise.vibration.response import Response

Answers = dict[float, Response | None]
"""Speed of the crank, rad/s -> the response; None where there is none."""

OFFSETS = (-8.0, -4.0, -2.0, -1.0, -0.5, -0.2, 0.0, 0.2, 0.5, 1.0, 2.0, 4.0, 8.0)
"""Speeds about a resonance, in damping ratios of its mode: a peak is as wide as two."""
ACROSS, UP = 480.0, 160.0
"""Points: size of a picture with a curve in it, whose values have a log axis."""
OFF, SHORT = 0.7, 2.5
"""Points: how far a place of a curve lies off the line between its neighbours where it bends, a
quarter of which is left when both sides are halved; length of a piece that nobody sees."""
COARSE = 30
"""Equally spaced speeds from which curves that bend little are smooth already."""
SAME = 1e-12
"""Over the fastest speed: less is rounding."""
ROUNDS = 6
"""In each of which pieces are halved."""


def about(
    slowest: float, fastest: float, count: int, met: Iterable[Resonance], linear: Linear
) -> Array:
    """Speeds, rad/s: equally spaced, the machine's own, and about resonances; rising in size."""
    own = np.copysign(linear.body.machine.drive.speed, fastest)
    grid = [np.linspace(slowest, fastest, count), np.array([own])]
    for resonance in met:
        damping = np.clip(linear.modes[resonance.mode - 1].damping_ratio, 1e-5, 0.05)
        grid.append(resonance.speed * (1 + np.array(OFFSETS) * damping))
    low, high = sorted((slowest, fastest))
    speeds = np.concatenate(grid)
    inside = np.unique(speeds[(speeds >= low) & (speeds <= high)])
    inside = inside[np.diff(inside, prepend=-np.inf) > SAME * max(-low, high)]
    return inside if fastest > 0 else inside[::-1]


def answered(
    respond: Callable[[float], Response], speeds: Array, progress: Callable[[int, int], None]
) -> Answers:
    """Responses at some speeds, and at those between where curves would be drawn with corners.

    respond : of a speed, whatever the others are.  progress : called with how many are done of how
    many that are known to be wanted.

    Raises
    ------
    UsageError : all of them would take more memory than may be used.
    """
    answers: Answers = {}
    wanted = speeds.tolist()
    for _ in range(ROUNDS):
        total = len(answers) + len(wanted)
        for speed in wanted:
            try:
                answer = respond(speed)
            except ResponseError:
                answer = None
            answers[speed] = answer
            if answer is not None:
                speeds_of = to_say("{count} speeds of a cycle of {turns} turns")
                what = Note(speeds_of, count=total, turns=answer.turns)
                check_memory(answer.nbytes * total, what)
            progress(len(answers), total)
        answers = dict(sorted(answers.items(), key=lambda pair: abs(pair[0])))
        wanted = between(answers)
    return answers


def between(answers: Mapping[float, Response | None]) -> list[float]:
    """Middles of the pieces that meet where any curve bends."""
    speeds = np.array([*answers])
    there = np.array([answer is not None for answer in answers.values()])
    if len(speeds) < 3 or not np.any(there):
        return []
    levels = [_levels(answer) for answer in answers.values() if answer is not None]
    curves = np.full((len(levels[0]), len(speeds)), np.nan)
    curves[:, there] = np.array(levels).T
    x = np.broadcast_to(ACROSS * speeds / np.ptp(speeds), curves.shape)
    ways = np.diff(x) + 1j * np.diff(curves)
    both = ways[:, 1:] + ways[:, :-1]
    off = np.abs((ways[:, :-1].conj() * both).imag) / np.abs(both)
    bent = np.pad(off > OFF, ((0, 0), (1, 1)))
    split = np.any((bent[:, 1:] | bent[:, :-1]) & (np.abs(ways) > SHORT), axis=0)
    return [float(speed) for speed in (speeds[1:] + speeds[:-1])[split] / 2]


def _levels(answer: Response) -> Array:
    """RMS of whatever is drawn against speed, (C,), as points of a log axis; NaN where it is 0."""
    read = [
        (gauge.displacement, gauge.velocity, gauge.acceleration) for gauge in answer.gauges.values()
    ]
    signals = [*(signal for three in read for signal in three)]
    signals += [mount.force for mount in answer.mounts.values()]
    sizes = np.array([float(signal.vibration_rms) for signal in signals])
    return UP / 3 * np.log10(np.where(sizes > 0, sizes, np.nan))
