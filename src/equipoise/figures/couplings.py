"""Charts of couplings over crank angle: speed ratios that vary, and strands of belts."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from equipoise.figures.analysis import ALL, angle_axis, over, title
from equipoise.figures.points import FORBIDDEN, outputs_chart
from equipoise.figures.shared import compared
from equipoise.figures.style import short
from equipoise.i18n import say
from equipoise.mechanism.checks import FRAME
from equipoise.results.charts import Chart

if TYPE_CHECKING:
    from equipoise.mechanism.parts.machine import Gear
    from equipoise.results.analysis import Analysis


def ratios(analysis: Analysis) -> Iterator[Chart]:
    """Of each pair of gears whose ratio varies: ``gears-DRIVEN``; none where planting has its own,
    and none where the driver stands still on its carrier at some crank angle.
    """
    if analysis.machine.planting is not None:
        return
    for gear in analysis.machine.gears:
        low, high = gear.ratios
        driver, driven = (_rate(analysis, gear, link) for link in (gear.driver, gear.driven))
        if low != high and np.all(driver != 0):
            names = {"link": short(gear.driven, 16), "drive": short(gear.driver, 16)}
            label = say("angular velocity ratio, {link} / {drive}", **names)
            signal = {ALL: over(analysis, driven / driver)}
            panel = compared(angle_axis(analysis), label, None, signal)
            what = say("Speed ratio of gears on their carrier")
            name = f"gears-{gear.driven.translate(FORBIDDEN)}"
            yield Chart(name, analysis.machine.title, title(analysis, what), (panel,))


def _rate(analysis: Analysis, gear: Gear, link: str) -> np.ndarray:
    """How a link turns on the gear's carrier, by crank angle (N,)."""
    links = analysis.motion.links
    link_rate, carrier = (
        0.0 if item == FRAME else links[item].angle_1 for item in (link, gear.carrier)
    )
    return np.asarray(link_rate - carrier + 0.0 * analysis.crank_angle)


def strands(analysis: Analysis) -> Iterator[Chart]:
    """Tension of both strands of each belt: ``belt-DRIVEN``."""
    for belt in analysis.machine.belts:
        names = [f"belts.{belt.name}.{side}" for side in ("left", "right")]
        what = say("Tension of the strands of belts")
        name = f"belt-{belt.driven.translate(FORBIDDEN)}"
        yield outputs_chart(analysis, names, name, what)
