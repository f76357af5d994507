"""One view of a mode: the support at rest and displaced, with what is on it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, Polygon
from matplotlib.ticker import FuncFormatter

from equipoise.figures.labels import Labels
from equipoise.i18n import say, to_say
from equipoise.mechanism.support import Gauge, Mount, unit_vector
from equipoise.plotting.style import INK, LINES, MAIN, PALE, STRESS, short, shown
from equipoise.plotting.vibration.body import AXIS_SEEN, Shape, View, seen
from equipoise.plotting.vibration.symbols import (
    draw_gauge,
    draw_mount,
    draw_pivot,
    draw_turning,
)

Array = np.ndarray[Any, Any]

AXIS_NAMES: dict[View, tuple[str, str]] = {
    "side": (to_say("x (forward), mm"), to_say("y (up), mm")),
    "rear": (to_say("z (to the right), mm"), to_say("y (up), mm")),
    "top": (to_say("x (forward), mm"), to_say("z (to the right), mm")),
}
TICKS = 0.6
"""Inches between numbers on the axes, about."""
MOST_NAMES = 16
"""Mounts and gauges that are named in a view."""
DASHED: Any = (0, (4, 2))


@dataclass(frozen=True)
class Sign:
    """What stands for a mount or gauge: its place, mm, and where (deg) its name stands best."""

    name: str
    item: Mount | Gauge
    at: complex
    wish: float


def view_of(item: Mount | Gauge) -> View:
    """The view in which a mount or gauge is best told from others."""
    if item.axis is not None:
        return next(view for view, axis in AXIS_SEEN.items() if axis == item.axis)
    parts = np.abs(unit_vector(item.direction))
    views: tuple[View, ...] = ("side", "rear", "top")
    return views[int(np.argmax(parts))]


def settle(axes: Axes, middle: complex, scale: float, view: View) -> None:
    """Limits about a middle (mm) at a scale (mm in an inch), the same numbers on both axes."""
    figure: Any = axes.get_figure(root=True)
    box = axes.get_window_extent()
    half = complex(box.width, box.height) / figure.dpi * scale / 2
    exact = TICKS * scale
    power = 10.0 ** np.floor(np.log10(exact))
    step = next(k * power for k in (1, 2, 5, 10) if k * power >= exact * (1 - 1e-9))
    ends = (
        (middle.real, half.real, axes.set_xlim, axes.set_xticks),
        (middle.imag, half.imag, axes.set_ylim, axes.set_yticks),
    )
    for center, reach, limit, put in ends:
        limit(center - reach, center + reach)
        put(step * np.arange(np.ceil((center - reach) / step), (center + reach) / step))
    across, up = map(say, AXIS_NAMES[view])
    axes.set_xlabel(across)
    axes.set_ylabel(up)
    if view == "top":
        axes.yaxis.set_major_formatter(FuncFormatter(lambda value, _: shown(-value + 0.0)))


def draw_view(axes: Axes, shape: Shape, view: View, alone: bool) -> None:
    """Everything in one view.

    alone : whether it is the only one, and names all; else each thing is named where it acts.
    """
    figure: Any = axes.get_figure(root=True)
    low, high = axes.get_xlim()
    inch = (high - low) / axes.get_window_extent().width * figure.dpi
    labels = Labels(axes)
    _outlines(axes, shape, view, labels)
    _marks(axes, shape, view)
    named = [*_gauges(axes, shape, view, inch), *_mounts(axes, shape, view, inch)]
    for sign in named:
        labels.reserve(sign.at.real, sign.at.imag, half=4)
    told = [sign for sign in named if alone or view_of(sign.item) == view]
    for sign in told[:MOST_NAMES]:
        at = sign.at.real, sign.at.imag
        labels.put(short(sign.name, 20), *at, wish=sign.wish, optional=True)


def _outlines(axes: Axes, shape: Shape, view: View, labels: Labels) -> None:
    """At rest, filled; at both ends of the swing, one whole and one dashed; and the way between."""
    rest = shape.outline(view)
    corners = np.column_stack([rest.real, rest.imag])
    axes.add_patch(Polygon(corners, fc=PALE, ec=LINES, lw=0.8, alpha=0.75, zorder=1.5))
    labels.avoid(rest.real, rest.imag)
    for phase, color, dashes in ((1, MAIN, "-"), (-1, STRESS, DASHED)):
        line = shape.outline(view, phase)
        axes.plot(line.real, line.imag, color=color, linestyle=dashes, linewidth=1.5, zorder=3)
        labels.avoid(line.real, line.imag)
    for gauge in shape.support.gauges.values():
        if gauge.point is not None:
            path = shape.path(np.array(gauge.point), view)
            axes.plot(path.real, path.imag, color=INK, linewidth=0.9, zorder=3.2)
            labels.avoid(path.real, path.imag)


def _marks(axes: Axes, shape: Shape, view: View) -> None:
    """Points of the linkages on the support, and its centre of mass, at rest."""
    points = np.unique(np.round(seen(shape.linkages, view), 6))
    look: Any = {"color": LINES, "markerfacecolor": "white", "linewidth": 0}
    axes.plot(points.real, points.imag, "s", markersize=3.2, zorder=4, **look)
    center = complex(seen(np.array(shape.support.center_of_mass), view))
    axes.plot(center.real, center.imag, "o", markersize=6.5, zorder=4.1, **look)
    axes.plot(center.real, center.imag, "+", color=LINES, markersize=6.5, zorder=4.2)


def _gauges(axes: Axes, shape: Shape, view: View, inch: float) -> Iterator[Sign]:
    """Draw the gauges that this view shows."""
    ring = 0
    for name, gauge in shape.support.gauges.items():
        if gauge.point is not None:
            draw_gauge(axes, gauge.point, gauge.direction, view, inch)
            yield Sign(name, gauge, complex(seen(np.array(gauge.point), view)), 20.0)
        elif gauge.axis == AXIS_SEEN[view]:
            reference = complex(seen(shape.reference, view))
            yield Sign(name, gauge, draw_turning(axes, reference, ring, INK, inch), 60.0)
            ring += 1


def _mounts(axes: Axes, shape: Shape, view: View, inch: float) -> Iterator[Sign]:
    """Draw the pivot, and the mounts that this view shows."""
    support = shape.support
    rest = shape.outline(view)
    center = complex(np.mean(rest))
    reference = complex(seen(shape.reference, view))
    if support.pivot is not None and view == "side":
        draw_pivot(axes, reference, inch)
    ring = sum(gauge.axis == AXIS_SEEN[view] for gauge in support.gauges.values())
    for name, mount in support.mounts.items():
        if mount.point is not None:
            draw_mount(axes, mount, view, center, inch)
            yield Sign(name, mount, complex(seen(np.array(mount.point), view)), -20.0)
        elif mount.axis == AXIS_SEEN[view]:
            yield Sign(name, mount, draw_turning(axes, reference, ring, LINES, inch), 30.0)
            ring += 1


def keys_of(shape: Shape) -> dict[str, Any]:
    """Name -> sign, those that the picture has."""
    support = shape.support
    keys: dict[str, Any] = {
        say("support at rest"): Patch(fc=PALE, ec=LINES, lw=0.8),
        say("one end of the swing"): Line2D([], [], color=MAIN),
        say("the other"): Line2D([], [], color=STRESS, linestyle=DASHED),
        say("joint of the linkages"): _sign("s", 3.2),
        say("centre of mass"): (_sign("o", 6.5), _sign("+", 6.5)),
    }
    if any(gauge.point is not None for gauge in support.gauges.values()):
        keys[say("gauge and its way")] = _sign("D", 5, INK)
    pushing = {mount.one_sided for mount in support.mounts.values() if mount.point is not None}
    if False in pushing:
        keys[say("mount")] = _sign("o", 4.5, face=LINES)
    if True in pushing:
        keys[say("pushing mount")] = _sign("o", 4.5)
    return keys


def _sign(marker: str, size: float, color: str = LINES, face: str = "white") -> Line2D:
    look: Any = {"color": color, "markerfacecolor": face, "markersize": size, "linewidth": 0}
    return Line2D([], [], marker=marker, **look)


def write_keys(figure: Figure, shape: Shape, left: float, edge: float, columns: int) -> None:
    """The legend at some inches: rows that stand on an edge, or one column that hangs from it."""
    width, height = figure.get_size_inches()
    keys = keys_of(shape)
    figure.legend(
        list(keys.values()),
        list(keys),
        loc="upper left" if columns == 1 else "lower left",
        bbox_to_anchor=(left / width, edge / height),
        ncols=columns,
        borderaxespad=0,
        borderpad=0,
        columnspacing=1.2,
        handletextpad=0.5,
        labelspacing=0.3,
    )
