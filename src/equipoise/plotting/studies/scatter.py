"""How each figure scatters over all machines, with its limits."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from equipoise.i18n import say
from equipoise.plotting.style import FAINT, INK, MAIN, STRESS, short, shown
from equipoise.plotting.vibration.panels import (
    continued,
    grid,
    groups,
    legend,
    name_panel,
    name_y,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from equipoise.schema.study_units import Unit
    from equipoise.studies.tolerances import Tolerances
    from equipoise.studies.variance import Scatter

ROW = 2.15
"""Inches: height of a row of panels."""
MARGIN = 0.05
"""Free at each side, over what is drawn."""
MODEL: Any = {"color": INK, "linewidth": 1.2, "zorder": 4}
LIMIT: Any = {"color": STRESS, "linewidth": 1.6, "linestyle": (0, (4, 1.6)), "zorder": 4}


def scatter_figures(found: Tolerances, units: Mapping[str, Unit]) -> Iterator[Figure]:
    """A histogram of each figure; bars outside of its limits are pale."""
    every = list(found.scatters)
    for names in groups(every):
        what = say("Scatter over {count} machines", count=found.designs) + continued(names, every)
        figure, panels = grid(len(names), ROW, found.study.title, what, keys=True)
        for axes, name in zip(panels, names, strict=True):
            _histogram(axes, found.scatters[name], units[name], found.designs)
            name_panel(axes, _title(name, found.scatters[name]))
        limited = any(_limits(one) for one in found.scatters.values())
        legend(figure, _keys(limited))
        yield figure


def _title(name: str, one: Scatter) -> str:
    if one.within is None:
        return short(name, 40)
    share = shown(100 * one.within.value)
    return say("{name}: {share} % within limits", name=short(name, 24), share=share)


def _histogram(axes: Axes, one: Scatter, unit: Unit, designs: int) -> None:
    edges = np.array([unit.of_si(edge) for edge in one.edges.tolist()])
    shares = 100 * one.counts / designs
    inside = np.ones(len(shares), bool)
    limits = [unit.of_si(limit) for limit in _limits(one)]
    if one.output.at_least is not None:
        inside &= edges[1:] > unit.of_si(one.output.at_least)
    if one.output.at_most is not None:
        inside &= edges[:-1] < unit.of_si(one.output.at_most)
    colors = np.where(inside, MAIN, FAINT)
    axes.bar(edges[:-1], shares, np.diff(edges), align="edge", color=colors, linewidth=0, zorder=3)
    for limit in limits:
        axes.axvline(limit, **LIMIT)
    marks = list(limits)
    if np.isfinite(one.base):
        marks.append(unit.of_si(one.base))
        axes.axvline(marks[-1], **MODEL)
    low, high = min(edges[0], *marks, edges[-1]), max(edges[-1], *marks, edges[0])
    room = MARGIN * (high - low) or 0.05 * abs(high) or 1.0
    axes.set_xlim(low - room, high + room)
    name = unit.name.replace("^2", "²")
    if name:
        axes.set_xlabel(name, labelpad=1.0)
    name_y(axes, say("machines, %"))
    axes.grid(visible=False, axis="x")


def _limits(one: Scatter) -> list[float]:
    ends = (one.output.at_least, one.output.at_most)
    return [end for end in ends if end is not None]


def _keys(limited: bool) -> list[Any]:
    keys: list[Any] = [
        Patch(color=MAIN, label=say("machines")),
        Line2D([], [], label=say("the model itself"), **MODEL),
    ]
    if limited:
        keys.append(Patch(color=FAINT, label=say("outside of limits")))
        keys.append(Line2D([], [], label=say("limit"), **LIMIT))
    return keys
