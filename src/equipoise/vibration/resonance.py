"""Crank speeds at which an order meets a mode, and which of them are to be kept away from."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from math import copysign, pi, sqrt
from typing import ClassVar

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.i18n import Note, to_say
from equipoise.mechanism.parts.machine import Drive
from equipoise.quantities import PER_RPM, brief, number
from equipoise.results.declaring import Declarations, ResultOutput
from equipoise.vibration.linear import Linear, gauges_of
from equipoise.vibration.response import Mode

QUIET = 1e-3
"""Share of the loudest resonance at every gauge below which one is not told."""
LOUD = 0.1
"""Share of the loudest resonance from which one matters to whoever chooses a speed."""
LEAST_DAMPING = 1e-4
"""Damping ratio below which modes are compared as if they had it."""
AMPLIFIED = 3.0
"""A speed is to be kept away from where the mode amplifies the order more often than this."""


@dataclass(frozen=True)
class Resonance:
    """One order that meets one mode.

    speed : of the crank, rad/s.  order : events in a turn.  mode : its number, from 1.
    frequency : of the mode, rad/s.
    share : amplitude at the gauge that this resonance shakes most, over the largest there.
    avoid : speeds between which the mode amplifies this order more than three times, the slower one
        first; None where its damping never lets it.
    """

    speed: float
    order: float
    mode: int
    frequency: float
    share: float
    avoid: tuple[float, float] | None

    @property
    def is_loud(self) -> bool:
        """Whether it matters to whoever chooses a speed."""
        return self.share >= LOUD

    declared: ClassVar[Declarations] = {
        "speed": ResultOutput("speed of the crank", "angular speed"),
        "order": ResultOutput("events in a turn"),
        "mode": ResultOutput("number of the mode, from 1"),
        "frequency": ResultOutput("natural frequency of the mode", "angular speed"),
        "share": ResultOutput("amplitude over that of the loudest resonance at a gauge"),
        "avoid": ResultOutput(
            "speeds between which the order is amplified more than three times, or null",
            "angular speed",
            read=lambda item: None if item.avoid is None else list(item.avoid),
        ),
    }


AROUND = (0.2, 2.0)
"""Ends of the range of speeds about one of the crank, over that."""


def around(drive: Drive, speed: float) -> tuple[float, float]:
    """Speeds (rad/s) about one of the crank, among them all at which the machine runs."""
    slow, fast = (share * speed for share in AROUND)
    for end in drive.speeds:
        slow, fast = (
            min(slow, copysign(end, speed), key=abs),
            max(fast, copysign(end, speed), key=abs),
        )
    return slow, fast


def nearest_loud(resonances: Iterable[Resonance], speed: float) -> Resonance:
    """Of the loud ones of some resonances the one whose speed is nearest to a speed, rad/s.

    One that shakes a few per cent of what the loudest does is no reason to change a speed, however
    near it is.
    """
    every = tuple(resonances)
    loud = [item for item in every if item.is_loud] or every
    return min(loud, key=lambda resonance: abs(abs(resonance.speed / speed) - 1))


def resonance_note(resonances: Iterable[Resonance], speed: float) -> Note:
    """The nearest loud resonance (speed in rad/s), and between which speeds it is to be avoided."""
    resonance = nearest_loud(resonances, speed)
    of_one = to_say(
        "the nearest loud resonance is at {speed} rpm, where order {order} meets mode {mode} "
        "({frequency} Hz); no speed about it has to be avoided"
    )
    avoided = to_say(
        "the nearest loud resonance is at {speed} rpm, where order {order} meets mode {mode} "
        "({frequency} Hz); keep away from {low} to {high} rpm"
    )
    low, high = sorted(map(abs, resonance.avoid or (0.0, 0.0)))
    return Note(
        of_one if resonance.avoid is None else avoided,
        speed=brief(abs(resonance.speed) / PER_RPM),
        order=f"{resonance.order:.4g}",
        mode=resonance.mode,
        frequency=brief(resonance.frequency / (2 * pi)),
        low=number(low / PER_RPM),
        high=number(high / PER_RPM),
    )


def within(resonances: Iterable[Resonance], speed: float) -> Iterator[Note]:
    """Which resonances amplify at a speed (rad/s) so much that it is to be kept away from."""
    for item in resonances:
        low, high = sorted(map(abs, item.avoid or (0.0, 0.0)))
        if low <= abs(speed) <= high and item.avoid is not None:
            said = to_say(
                "the crank turns at a speed that is to be avoided: between {low} and {high} rpm "
                "order {order} meets mode {mode} ({frequency} Hz), which amplifies it more than "
                "three times"
            )
            yield Note(
                said,
                low=brief(low / PER_RPM),
                high=brief(high / PER_RPM),
                order=f"{item.order:.4g}",
                mode=item.mode,
                frequency=brief(item.frequency / (2 * pi)),
            )


def warned(linear: Linear, speed: float) -> tuple[Note, ...]:
    """Warning of a resonance of a machine whose crank turns at a speed, rad/s."""
    turns = linear.excitation.motion.turns
    meets = False
    for mode in linear.modes:  # told apart first by modes alone, which takes no time
        order = max(1, round(mode.natural_frequency / abs(speed) * turns)) / turns
        low, high = _avoid(mode.natural_frequency / order, mode) or (0.0, 0.0)
        meets = meets or low <= abs(speed) <= high
    if not meets:
        return ()
    drive = linear.body.machine.drive
    return tuple(within(resonances(linear, *around(drive, speed)), speed))


def resonances(linear: Linear, slowest: float, fastest: float) -> list[Resonance]:
    """Resonances between two speeds of the crank of the same sign, rad/s; the fastest first.

    Those whose order the linkages do not excite in that mode are left out.
    """
    parts: list[tuple[float, float, int, Mode]] = []
    low, high = sorted((abs(slowest), abs(fastest)))
    orders = linear.wrench(high).orders[1:]
    for place, mode in enumerate(linear.modes, 1):
        rate = mode.natural_frequency
        # The ends belong to the range, whatever rounding says.
        inside = (rate >= orders * low * (1 - 1e-12)) & (rate <= orders * high * (1 + 1e-12))
        parts += [
            (copysign(rate / order, fastest), order, place, mode)
            for order in map(float, orders[inside & mode.swings])
        ]
    loud = _loudness(linear, parts)
    return sorted(
        (
            Resonance(speed, order, place, mode.natural_frequency, share, _avoid(speed, mode))
            for (speed, order, place, mode), share in zip(parts, loud, strict=True)
            if share >= QUIET
        ),
        key=lambda resonance: -abs(resonance.speed),
    )


def _loudness(linear: Linear, resonances: list[tuple[float, float, int, Mode]]) -> list[float]:
    """Amplitude of each resonance at the gauge where it is loudest beside the others there."""
    rows = np.array([linear.body.row(g)[linear.body.free] for g in gauges_of(linear.body).values()])
    amplitudes = np.zeros((len(resonances), len(rows)))
    speeds, orders = (
        np.array([(speed, order) for speed, order, _, _ in resonances]).reshape(-1, 2).T
    )
    places = np.rint(orders * linear.excitation.motion.turns).astype(int)
    wrenches = linear.excitation.at_orders(speeds, places)[linear.body.free].T
    for k, (wrench, (_, _, _, mode)) in enumerate(zip(wrenches, resonances, strict=True)):
        force = abs(mode.shape @ wrench)
        inertia = abs(mode.shape @ linear.mass @ mode.shape)
        damping = max(abs(mode.damping_ratio), LEAST_DAMPING)
        size = force / (2 * damping * mode.natural_frequency**2 * inertia)
        amplitudes[k] = np.abs(rows @ mode.shape) * size
    largest = np.max(amplitudes, axis=0, initial=0.0)
    shares = np.divide(amplitudes, largest, out=np.zeros_like(amplitudes), where=largest > 0)
    return [float(share) for share in np.max(shares, axis=1, initial=0.0)]


def _avoid(speed: float, mode: Mode) -> tuple[float, float] | None:
    """Where (1 - r^2)^2 + (2 D r)^2 < 1 / amplified^2, with r the frequency over the mode's."""
    damping = mode.damping_ratio
    half = 1 - 2 * damping**2
    inner = half**2 - 1 + 1 / AMPLIFIED**2
    if inner <= 0 or half <= 0:
        return None
    low, high = half - sqrt(inner), half + sqrt(inner)
    return (speed * sqrt(max(low, 0.0)), speed * sqrt(high))
