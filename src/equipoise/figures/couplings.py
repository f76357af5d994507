"""Charts of couplings over crank angle: speed ratios that vary, and outputs of kinds that have a
picture, such as the strands of belts.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from equipoise.figures.analysis import ALL, angle_axis, title, with_figures
from equipoise.figures.chart_parts import compared
from equipoise.figures.points import FORBIDDEN, outputs_chart
from equipoise.figures.style import short
from equipoise.i18n import say
from equipoise.mechanism.checks import FRAME
from equipoise.results.charts import Chart

if TYPE_CHECKING:
    from equipoise.mechanism.parts.couplings import Coupling
    from equipoise.results.analysis import Analysis


def ratios(analysis: Analysis) -> Iterator[Chart]:
    """Of each coupling whose ratio varies, such as ``gears-DRIVEN``; none where planting has its
    own, and none where the driver stands still on its carrier at some crank angle.
    """
    if analysis.machine.planting is not None:
        return
    for item in analysis.machine.couplings:
        if not item.varies:
            continue
        driver, driven = (_rate(analysis, item, link) for link in (item.driver, item.driven))
        if np.all(driver != 0):
            names = {"link": short(item.driven, 16), "drive": short(item.driver, 16)}
            label = say("angular velocity ratio, {link} / {drive}", **names)
            signal = {ALL: with_figures(analysis, driven / driver)}
            panel = compared(angle_axis(analysis), label, None, signal)
            what = say("Speed ratio relative to the carrier")
            name = f"{item.list_name}-{item.driven.translate(FORBIDDEN)}"
            yield Chart(name, analysis.machine.title, title(analysis, what), (panel,))


def _rate(analysis: Analysis, coupling: Coupling, link: str) -> np.ndarray:
    """How a link turns on the coupling's carrier, by crank angle (N,)."""
    links = analysis.motion.links
    link_rate, carrier = (
        0.0 if item == FRAME else links[item].angle_1 for item in (link, coupling.carrier)
    )
    return np.asarray(link_rate - carrier + 0.0 * analysis.crank_angle)


def curves(analysis: Analysis) -> Iterator[tuple[Chart, str]]:
    """Outputs of couplings that have a picture, with its caption, such as both strands of a belt:
    ``belt-DRIVEN``.
    """
    for item in analysis.machine.couplings:
        if item.curves is not None:
            outputs, what, caption = item.curves
            names = [f"{item.list_name}.{item.name}.{output}" for output in outputs]
            name = f"{item.noun.replace(' ', '-')}-{item.driven.translate(FORBIDDEN)}"
            yield outputs_chart(analysis, names, name, say(what)), caption
