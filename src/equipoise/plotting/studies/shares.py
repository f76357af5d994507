"""Which tolerances cause the scatter, and what tightening each of them does."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from equipoise.i18n import say
from equipoise.plotting.style import MAIN, PALE, SMALL, blank, heading, short, shown
from equipoise.plotting.vibration.panels import LEFT as HEAD
from equipoise.plotting.vibration.panels import (
    RIGHT,
    WIDTH,
    continued,
    groups,
    legend,
    name_panel,
    place,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from equipoise.studies.tolerances import Cause, Tolerances

LEFT, TOP, BOTTOM = 2.6, 0.62, 0.5
"""Inches: margins; at the left stand the paths."""
LINE, TITLE, KEYS = 0.3, 0.42, 0.14
"""Inches: height of a bar with its room, of a panel's title, and room for the legend."""
TALL, THIN = 0.68, 0.34
"""Heights of bars, over their distance."""
MOST = 4
"""Panels in a picture."""


def tighten_figure(found: Tolerances) -> Figure:
    """By how much the scatter falls where one tolerance is halved."""
    causes = found.causes
    height = LINE * len(causes)
    figure = blank(WIDTH, TOP + height + BOTTOM)
    what = say("What half of a tolerance does: variance less, in the mean of the figures")
    heading(figure, found.study.title, what, HEAD)
    axes = _axes(figure, BOTTOM, height, causes)
    gains = np.array([100 * max(cause.gain, 0.0) for cause in causes])
    axes.barh(range(len(causes)), gains, TALL, color=MAIN, linewidth=0, zorder=3)
    _settle(axes, float(np.max(gains)))
    for row, gain in enumerate(gains.tolist()):
        axes.annotate(
            _percent(gain),
            (gain, row),
            xytext=(4, 0),
            textcoords="offset points",
            va="center",
            fontsize=SMALL,
        )
    axes.set_xlabel(say("variance less, %"))
    return figure


def shares_figures(found: Tolerances) -> Iterator[Figure]:
    """Share of each tolerance in the variance of each figure."""
    every = [name for name in found.scatters if name in found.causes[0].effects]
    causes = found.causes
    room = TITLE + LINE * len(causes)
    for names in groups(every, MOST):
        whole = TOP + KEYS + room * len(names) + BOTTOM
        figure = blank(WIDTH, whole)
        what = say("What causes the scatter of each figure") + continued(names, every)
        heading(figure, found.study.title, what, HEAD)
        for row, name in enumerate(names):
            bottom = whole - TOP - KEYS - (row + 1) * room
            axes = _axes(figure, bottom, LINE * len(causes), causes)
            _shares(axes, name, causes)
            name_panel(axes, short(name, 50))
            if row < len(names) - 1:
                axes.tick_params(labelbottom=False)
            else:
                axes.set_xlabel(say("share of the variance, %"))
        look: Any = {"linewidth": 0}
        keys = [
            Patch(color=MAIN, label=say("by itself"), **look),
            Patch(color=PALE, label=say("with all that it does together with others"), **look),
        ]
        legend(figure, keys)
        yield figure


def _shares(axes: Axes, name: str, causes: Sequence[Cause]) -> None:
    rows = range(len(causes))
    effects = [cause.effects[name] for cause in causes]
    total = [100 * max(effect.total.value, 0.0) for effect in effects]
    first = [100 * max(effect.first.value, 0.0) for effect in effects]
    axes.barh(rows, total, TALL, color=PALE, linewidth=0, zorder=2)
    axes.barh(rows, first, THIN, color=MAIN, linewidth=0, zorder=3)
    _settle(axes, 100.0 / 1.12)


def _axes(figure: Figure, bottom: float, height: float, causes: Sequence[Cause]) -> Axes:
    """Axes with a line for each cause, the first at the top."""
    axes = place(figure, LEFT, bottom, WIDTH - LEFT - RIGHT, height)
    names = [short(_joined(cause.numbers), 38) for cause in causes]
    axes.set_yticks(range(len(causes)), names)
    axes.set_ylim(len(causes) - 0.5, -0.5)
    axes.tick_params(axis="y", length=0)
    axes.grid(visible=False, axis="y")
    return axes


def _settle(axes: Axes, largest: float) -> None:
    axes.set_xlim(0, 1.12 * largest or 1.0)


def _percent(value: float) -> str:
    return f"{value:.1f} %" if value >= 0.1 else f"{shown(round(value, 2))} %"


def _joined(names: Sequence[str]) -> str:
    """Paths that vary together: what they have in common is said once."""
    first, *others = names
    if not others:
        return first
    parts = [name.split(".") for name in names]
    same = 0
    while all(part[: same + 1] == parts[0][: same + 1] for part in parts):
        same += 1
    ends = [".".join(part[same:]) for part in parts]
    return ".".join([*parts[0][:same], " + ".join(ends)])
