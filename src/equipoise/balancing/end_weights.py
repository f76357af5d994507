"""What two weights opposite each other at the ends of a shaft do against a couple."""

from __future__ import annotations

from collections.abc import Iterator
from typing import ClassVar

import numpy as np

from equipoise.balancing.first_order import FirstOrder
from equipoise.balancing.policy import WORTH_NAMING
from equipoise.dataclass import dataclass
from equipoise.i18n import say
from equipoise.quantities import percent, told
from equipoise.results.analysis import Analysis
from equipoise.results.declaring import Declarations, ResultOutput
from equipoise.results.yardsticks import FigureAssessment


@dataclass(frozen=True)
class EndWeights:
    """Two weights opposite each other at both ends of a shaft, against a couple between planes.

    moment : kg m, of each.  apart : m.  gain : share of the RMS of the couple that is gone.
    """

    moment: float
    apart: float
    gain: float

    declared: ClassVar[Declarations] = {
        "moment": ResultOutput("of each weight about the shaft", "unbalance"),
        "apart": ResultOutput("from end to end", "length"),
        "gain": ResultOutput("share of the couple of the rows that is gone"),
    }


def end_weights_for(analysis: Analysis, entries: tuple[FigureAssessment, ...]) -> EndWeights | None:
    """Weights at both ends of a shaft against a large couple between rows; None where little of it
    turns with the crank.

    A force F (complex) in the plane z has the moment M_x + i M_y = i z F, so that a couple A e^(ia)
    and the rest asks for |A| / (w^2 L) at the distance L.
    """
    machine, motion, outputs = analysis.machine, analysis.motion, analysis.outputs
    large = any(entry.is_large and entry.yardstick_kind == "bearings" for entry in entries)
    if len(machine.rows) < 2 or not large or not machine.has_crank:
        return None
    x, y = (outputs[name].values for name in ("rows.roll_moment", "rows.yaw_moment"))
    planes = [row.lateral for row in machine.rows]
    apart = max(planes) - min(planes)
    couple = FirstOrder(motion, np.asarray(x + 1j * y), np.asarray(motion.crank_angle))
    if not apart or not couple.rms(couple.whole):
        return None
    gain = couple.gain(couple.without(against=False))
    moment = abs(couple.ahead) / (motion.speed**2 * apart)
    return EndWeights(moment, apart, gain) if gain >= WORTH_NAMING else None


def end_sentences(ends: EndWeights, crank: str) -> Iterator[str]:
    """What two weights at the ends of a shaft would do."""
    yield say(
        "Two weights of {moment} on {crank} instead, opposite each other and {apart} apart, would "
        "take {gain} % off the couple of the rows.",
        moment=told(ends.moment, "unbalance", digits=2),
        crank=crank,
        apart=told(ends.apart, "length", digits=3),
        gain=percent(ends.gain, 0),
    )
