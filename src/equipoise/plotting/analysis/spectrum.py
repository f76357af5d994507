"""Shaking force and moment and the drive's torque by orders."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from equipoise.i18n import say
from equipoise.plotting.analysis.looks import ALL, ONE, about, each, has_rows, row_names, title
from equipoise.plotting.bars import Read, bars, last_order
from equipoise.plotting.style import FAINT, LINES, MAIN, styled
from equipoise.plotting.vibration.panels import legend, name_panel, name_x, stack
from equipoise.signals import Periodic

if TYPE_CHECKING:
    from equipoise.results.analysis import Analysis

Array = np.ndarray[Any, Any]

ROW, NAMES, KEYS = 1.15, 0.22, 0.16
"""Inches: height of a panel, of the name above, and of the legend."""
FEWEST = 6
"""Orders that are drawn at least."""
TOLD = {False: 12, True: 7}
"""Whether there are two bars an order -> orders up to which they are numbered."""
COLORS = {ONE: (FAINT, LINES), ALL: (MAIN, MAIN)}
"""Of bars and of their numbers."""


@styled()
def spectrum_figure(analysis: Analysis) -> Figure:
    """Amplitudes of the orders of shaking force, shaking moment and drive torque.

    Raises
    ------
    UsageError : the crank angles are too few, or not equally spaced over the whole cycle.
    """
    read = _read(analysis)
    what = title(analysis, say("Amplitude of each order"))
    keys = KEYS if has_rows(analysis) else 0.0
    figure, panels = stack(len(read), ROW, analysis.machine.title, what, NAMES + keys)
    last = max(FEWEST, *(last_order(one) for one in read.values()))
    told = {
        "shaking_force.x": say("shaking force along x"),
        "shaking_force.y": say("shaking force along y"),
        "shaking_moment": say("shaking moment about {point}", point=about(analysis)),
        "drive_torque": say("drive torque"),
    }
    for axes, (output, one) in zip(panels, read.items(), strict=True):
        name_panel(axes, told[output])
        most = TOLD[has_rows(analysis)]
        bars(axes, one, COLORS, not output.startswith("shaking_force"), last, most)
    name_x(figure, say("order: events in one turn of the crank"))
    if has_rows(analysis):
        looks = [(COLORS[name][0], told) for name, told in row_names(analysis).items()]
        legend(figure, [Patch(color=color, linewidth=0, label=name) for color, name in looks])
    return figure


def _read(analysis: Analysis) -> dict[str, Read]:
    """Output -> orders and sizes, of one row and of all together."""
    _ = analysis.by_order  # raises where there are none
    force = each(analysis, "shaking_force")
    signals = {
        "shaking_force.x": {name: values.real for name, values in force.items()},
        "shaking_force.y": {name: values.imag for name, values in force.items()},
        "shaking_moment": each(analysis, "shaking_moment"),
        "drive_torque": each(analysis, "drive_torque"),
    }
    return {
        output: {name: _orders(analysis, values) for name, values in both.items()}
        for output, both in signals.items()
    }


def _orders(analysis: Analysis, values: Array) -> tuple[Array, Array]:
    signal = Periodic.of(values, analysis.motion.turns)
    return signal.orders, signal.sizes
