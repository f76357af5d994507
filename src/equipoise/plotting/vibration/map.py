"""The resonance map: where orders of the crank's speed meet natural frequencies (Campbell)."""

from __future__ import annotations

from math import pi
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from equipoise.figures.labels import spread
from equipoise.i18n import say
from equipoise.plotting.style import FAINT, INK, LINES, MAIN, SMALL, STRESS, blank, heading, shown
from equipoise.plotting.vibration.curves import (
    LOUD_BAND,
    bands,
    fraction,
    legend_at,
    speed_axis,
    speed_label,
)
from equipoise.plotting.vibration.panels import LEFT, RPM, WIDTH, name_x, name_y, place

if TYPE_CHECKING:
    from equipoise.vibration.sweep import Sweep

Array = np.ndarray[Any, Any]

HEIGHT, HEAD, FOOT, RIGHT = 4.6, 0.98, 0.5, 1.25
"""Inches: the picture and its margins."""
MOST_ORDERS = 20
USUAL_ORDERS = (1.0, 2.0, 3.0)
"""Drawn where no order meets a mode."""


def map_figure(sweep: Sweep) -> Figure:
    """Natural frequencies, orders, and their meetings, each as large as it is loud."""
    figure = blank(WIDTH, HEIGHT)
    what = say("Orders of the crank's speed, natural frequencies, and how loud they meet (size)")
    heading(figure, sweep.machine.title, what, LEFT)
    legend_at(figure, _keys(sweep), 0.52)
    axes = place(figure, LEFT, FOOT, WIDTH - LEFT - RIGHT, HEIGHT - HEAD - FOOT)
    speed_axis(axes, sweep)
    axes.set_ylim(0, _highest(sweep))
    name_y(axes, say("frequency, Hz"))
    name_x(figure, speed_label(sweep))
    bands(axes, sweep)
    at_right = _draw_modes(axes, sweep)
    at_right += _draw_orders(axes, sweep)
    _names_at_right(axes, at_right)
    for resonance in sweep.resonances:
        axes.plot(
            abs(resonance.speed) * RPM,
            resonance.frequency / (2 * pi),
            "o",
            color=STRESS,
            markerfacecolor="white",
            markersize=marker_size(resonance.share),
            markeredgewidth=1.3,
            zorder=4,
            clip_on=False,
        )
    return figure


def marker_size(share: float) -> float:
    """Points: area grows with the share, from what can just be seen."""
    return float(3 + 11 * np.sqrt(share))


def _keys(sweep: Sweep) -> list[Any]:
    keys: list[Any] = []
    if sweep.resonances:
        look: Any = {"color": STRESS, "markerfacecolor": "white", "linewidth": 0}
        text = say("order meets mode")
        keys.append(Line2D([], [], marker="o", markersize=7, label=text, **look))
    if any(resonance.avoid is not None for resonance in sweep.resonances):
        keys.append(Patch(facecolor=LOUD_BAND, linewidth=0, label=say("keep away (pale: quiet)")))
    return keys


def _highest(sweep: Sweep) -> float:
    """Upper end of the y axis, Hz."""
    swinging = [mode.cycles_per_second for mode in sweep.modes if mode.swings]
    fastest = float(np.max(np.abs(sweep.speed))) / (2 * pi)
    if not swinging:
        return USUAL_ORDERS[-1] * fastest
    top = 1.2 * max(swinging)
    return top if sweep.resonances else max(top, fastest)


def _draw_modes(axes: Axes, sweep: Sweep) -> list[tuple[float, str, str]]:
    """Lines at natural frequencies; place, name and colour for the right of the axes."""
    named = []
    for number, mode in enumerate(sweep.modes, 1):
        if mode.swings:
            frequency = mode.cycles_per_second
            axes.axhline(frequency, color=MAIN, linewidth=1.4, zorder=3)
            named.append(
                (
                    frequency,
                    say("mode {number}: {frequency} Hz", number=number, frequency=shown(frequency)),
                    MAIN,
                )
            )
    return named


def _draw_orders(axes: Axes, sweep: Sweep) -> list[tuple[float, str, str]]:
    """Lines of the orders; their names go above the axes, or come back for the right of them."""
    (low, high), top = axes.get_xlim(), axes.get_ylim()[1]
    above, right = [], []
    for order in _orders(sweep):
        slope = order / 60
        axes.plot([low, high], [slope * low, slope * high], color=LINES, linewidth=0.8, zorder=2)
        if slope * high <= top:
            right.append((slope * high, say("order {order}", order=fraction(order)), INK))
        elif slope * low < top:
            above.append((top / slope, fraction(order)))
    names_above(axes, above, say("order"))
    return right


def _orders(sweep: Sweep) -> list[float]:
    """Orders that meet a mode, the loudest if they are many; or else the usual ones."""
    usual = USUAL_ORDERS[:1] if sweep.resonances else USUAL_ORDERS
    loudness: dict[float, float] = dict.fromkeys(usual, 0.0)
    for resonance in sweep.resonances:
        loudness[resonance.order] = max(resonance.share, loudness.get(resonance.order, 0.0))
    return sorted(sorted(loudness, key=lambda order: (-loudness[order], order))[:MOST_ORDERS])


def names_above(axes: Axes, named: list[tuple[float, str]], word: str) -> None:
    """What lines are where they leave through the top, behind a word for all of them."""
    if not named:
        return
    figure: Any = axes.get_figure(root=True)
    box = axes.get_window_extent()
    low, high = axes.get_xlim()
    dot = box.width / (high - low)
    foot = 1 + 0.1 * figure.dpi / box.height
    look: Any = {"fontsize": SMALL, "ha": "center", "transform": axes.get_xaxis_transform()}
    texts = [axes.text(0, foot, name, **look) for _, name in named]
    widths = [(text.get_window_extent().width + 0.05 * figure.dpi) / dot for text in texts]
    places = [x for x, _ in named]
    for text, x, moved in zip(texts, places, spread(places, widths, low, high), strict=True):
        text.set_x(moved)
        ends = ([x, moved], [1, 1 + 0.08 * figure.dpi / box.height])
        axes.plot(
            *ends,
            color=FAINT,
            linewidth=0.6,
            clip_on=False,
            transform=axes.get_xaxis_transform(),
        )
    look |= {"ha": "right", "color": LINES}
    axes.text(low - 0.06 * figure.dpi / dot, foot, word, **look)


def _names_at_right(axes: Axes, named: list[tuple[float, str, str]]) -> None:
    """Names of lines at the right of the axes, each with a line to its place."""
    if not named:
        return
    figure: Any = axes.get_figure(root=True)
    box = axes.get_window_extent()
    low, high = axes.get_ylim()
    each = 0.135 * figure.dpi / box.height * (high - low)
    moved = spread([y for y, _, _ in named], [each] * len(named), low, high)
    transform = axes.get_yaxis_transform()
    inch = figure.dpi / box.width
    for (y, name, color), shifted in zip(named, moved, strict=True):
        ends = ([1, 1 + 0.1 * inch], [y, shifted])
        axes.plot(*ends, color=FAINT, linewidth=0.6, clip_on=False, transform=transform)
        axes.text(
            1 + 0.13 * inch,
            shifted,
            name,
            color=color,
            fontsize=SMALL,
            va="center_baseline",
            transform=transform,
        )
