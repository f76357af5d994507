"""Vibration of a hand that holds the support: its total value, and the daily exposure A(8)."""

from __future__ import annotations

from math import pi
from typing import ClassVar

from equipoise.dataclass import dataclass
from equipoise.exposure.blocks import VERDICTS
from equipoise.exposure.daily import LIMIT, partial_exposure, total_value, verdict_of
from equipoise.exposure.weighting import factor
from equipoise.i18n import Note, to_say
from equipoise.results.declaring import Declarations, ResultOutput
from equipoise.signals import Periodic


@dataclass(frozen=True)
class HandVibration:
    """What a hand gets where it holds the support.

    a_hv : vibration total value, m/s2: weighted by Wh of ISO 5349-1, in all directions.
    duration : time a day, s.
    """

    a_hv: float
    duration: float

    @property
    def a8(self) -> float:
        """Daily exposure A(8), m/s2."""
        return partial_exposure(self.a_hv, self.duration)

    @property
    def limit(self) -> float:
        """The limit value of Directive 2002/44/EC, m/s2."""
        return LIMIT

    @property
    def verdict(self) -> Note:
        """What Directive 2002/44/EC makes of it."""
        return Note(VERDICTS[verdict_of(self.a8)])

    declared: ClassVar[Declarations] = {
        "a_hv": ResultOutput(
            "vibration total value: RMS weighted by ISO 5349-1, of all directions",
            "acceleration",
            heading=to_say("total value a_hv"),
            unit="m/s^2",
        ),
        "duration": ResultOutput(
            "`exposure`, time a day", "time", heading=to_say("daily exposure time"), unit="h"
        ),
        "a8": ResultOutput(
            "daily exposure A(8)",
            "acceleration",
            heading=to_say("daily exposure A(8)"),
            unit="m/s^2",
        ),
    }


def hand_vibration(
    acceleration: tuple[Periodic, ...], speed: float, duration: float | None
) -> HandVibration | None:
    """What a hand gets of accelerations along perpendicular axes, m/s2; None where none holds.

    speed : of the crank, rad/s.  duration : time a day, s; None where no hand holds the support.
    """
    if duration is None:
        return None
    weighted = (_weighted_rms(signal, abs(speed) / (2 * pi)) for signal in acceleration)
    return HandVibration(total_value([*weighted]), duration)


def _weighted_rms(signal: Periodic, turns_a_second: float) -> float:
    """RMS of a signal about its mean, weighted by Wh, order by order."""
    weighted = signal.amplitudes * factor(signal.orders * turns_a_second)
    return float(Periodic(weighted, signal.turns).vibration_rms)
