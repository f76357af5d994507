"""The picture of an objective over two numbers: contours, the best place, where nothing turns."""

from __future__ import annotations

from dataclasses import dataclass
from math import pi
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.colors import LinearSegmentedColormap
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, Rectangle
from matplotlib.ticker import MaxNLocator

from equipoise.figures.labels import Labels
from equipoise.i18n import say
from equipoise.plotting.style import (
    FAINT,
    INK,
    SMALL,
    STRESS,
    blank,
    heading,
    short,
    shown,
    styled,
)
from equipoise.plotting.vibration.panels import LEFT, RIGHT, legend, place, told_speed
from equipoise.results.naming import objective_named

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from equipoise.studies.objective_map import Landscape

Array = np.ndarray[Any, Any]

WIDTH, HIGH, TOP, BOTTOM = 6.6, 4.7, 0.82, 0.52
"""Inches: width of the picture, height of the axes, and what is above and below them."""
LEVELS = 12
"""Lines at most."""
STEEP = 90
"""Percentile of the values up to which there are lines: beside dead points they rise endlessly."""
SHADES = LinearSegmentedColormap.from_list("low to high", ["#cfe0ef", "#ffffff"])
"""Low is dark, in grey too; never so dark that a line or a label would be lost."""
TURNS_NOT: Any = {"facecolor": "#f2f2f2", "edgecolor": FAINT, "hatch": "///", "linewidth": 0.0}
HANDY = {
    "length": (1e3, "mm"),
    "mass": (1e3, "g"),
    "inertia": (1e6, "kg mm²"),
    "angle": (180 / pi, "deg"),
    "angular speed": (30 / pi, "rpm"),
    "angular acceleration": (1.0, "rad/s²"),
    "force": (1.0, "N"),
    "torque": (1.0, "N m"),
    "stiffness": (1e-3, "N/mm"),
    "damping": (1.0, "N s/m"),
    "torsional stiffness": (1.0, "N m/rad"),
    "torsional damping": (1.0, "N m s/rad"),
}
"""What a number is -> factor from SI, and unit."""


@dataclass(frozen=True)
class Scale:
    """In which unit a number is drawn.

    factor : from SI.
    """

    factor: float
    unit: str

    @classmethod
    def of(cls, dimension: str | None) -> Scale:
        return cls(*HANDY.get(dimension or "", (1.0, "")))

    def told(self, value: float) -> str:
        """A value in SI units, with its unit."""
        return f"{shown(value * self.factor)} {self.unit}".strip()

    def label(self, path: str) -> str:
        return f"{short(path, 60)}, {self.unit}" if self.unit else short(path, 60)


def drawings(found: Landscape) -> dict[str, Figure]:
    """``landscape``: the objective over its two numbers."""
    with styled():
        return {"landscape": landscape_figure(found)}


def told(found: Landscape) -> str:
    """The best place in a sentence."""
    places = (
        f"{path} = {Scale.of(found.dimensions[path]).told(value)}"
        for path, value in zip(found.paths, found.best, strict=True)
    )
    value = f"{shown(found.least)} {found.unit}".replace("^2", "²")
    return f"least {found.objective.name}: {value}, at {' and '.join(places)}"


def landscape_figure(found: Landscape) -> Figure:
    """Lines of equal value with their values, the least of all, and the model as it is."""
    scales = [Scale.of(found.dimensions[path]) for path in found.paths]
    figure = blank(WIDTH, HIGH + TOP + BOTTOM)
    heading(figure, found.machine.title, _what(found), LEFT)
    axes = place(figure, LEFT, BOTTOM, WIDTH - LEFT - RIGHT, HIGH)
    x, y = scales[0].factor * found.x, scales[1].factor * found.y
    axes.grid(visible=False)
    axes.set_xlim(x[0], x[-1])
    axes.set_ylim(y[0], y[-1])
    axes.set_xlabel(scales[0].label(found.paths[0]))
    axes.set_ylabel(scales[1].label(found.paths[1]))
    lacking = bool(np.any(np.isnan(found.values)))
    if lacking:
        corner = (x[0], y[0])
        axes.add_patch(Rectangle(corner, np.ptp(x), np.ptp(y), zorder=0.5, **TURNS_NOT))
    marked = _marks(found, scales)
    labels = Labels(axes)
    _contours(axes, labels, x, y, found.values)
    for at, _, look in marked:
        axes.plot(at.real, at.imag, linestyle="none", clip_on=False, zorder=6, **LOOKS[look])
        labels.reserve(at.real, at.imag, half=5)
    for at, text, look in marked:
        weight: Any = {"color": LOOKS[look]["color"], "fontweight": "bold"}
        labels.put(text, at.real, at.imag, wish=90.0, **weight)
    legend(figure, _keys(marked, lacking))
    return figure


def _what(found: Landscape) -> str:
    """What is drawn, and what else was set."""
    speed = told_speed(found.machine.drive.speed)
    unit = found.unit.replace("^2", "²")
    objective = objective_named(found.objective, len(found.machine.rows))
    what = say("{objective}, {unit}, at {speed}", objective=objective, unit=unit, speed=speed)
    others = [
        f"{path} = {Scale.of(found.dimensions[path]).told(value)}"
        for path, value in found.given.items()
    ]
    return "; ".join([what, *others])


def _contours(axes: Axes, labels: Labels, x: Array, y: Array, values: Array) -> None:
    """Lines, their values, and shades between them."""
    low, high = float(np.nanmin(values)), float(np.nanpercentile(values, STEEP))
    high = high if high > low else float(np.nanmax(values))
    if not high > low:
        return  # the same everywhere: there is no line to draw
    levels = np.array(MaxNLocator(LEVELS, steps=[1, 2, 2.5, 5, 10]).tick_values(low, high))
    inner = levels[(levels > low) & (levels <= max(high, levels[-2]))]
    shaded = np.ma.masked_invalid(values)
    ends = np.concatenate([[min(low, inner[0])], inner])
    if len(ends) > 2:
        axes.contourf(x, y, shaded, levels=ends, cmap=SHADES, extend="max", zorder=1)
    lines = axes.contour(x, y, shaded, levels=inner, colors=INK, linewidths=0.8, zorder=2)
    for level in lines.allsegs:
        for line in level:
            labels.avoid(line[:, 0], line[:, 1])
    told = {level: shown(level) for level in inner.tolist()}
    whole = axes.get_window_extent()
    for text in axes.clabel(lines, fmt=told, fontsize=SMALL, inline_spacing=3):
        box = text.get_window_extent()
        inside = whole.x0 < box.x0 and box.x1 < whole.x1 and whole.y0 < box.y0 and box.y1 < whole.y1
        text.set_visible(inside)  # else it would be cut off
        labels.occupy(text)


def _marks(found: Landscape, scales: list[Scale]) -> list[tuple[complex, str, str]]:
    """Places that are marked, with what is written there: the least, and the model as it is."""
    unit = found.unit.replace("^2", "²")
    told = [scale.told(value) for scale, value in zip(scales, found.best, strict=True)]
    marked = [(_at(found.best, scales), f"{shown(found.least)} {unit}\n{', '.join(told)}", "least")]
    if found.start is not None and not np.isnan(found.before) and _is_inside(found, found.start):
        text = f"{shown(found.before)} {unit}"
        marked.append((_at(found.start, scales), text, "as it is"))
    return marked


def _is_inside(found: Landscape, pair: tuple[float, float]) -> bool:
    return all(v[0] <= one <= v[-1] for v, one in zip((found.x, found.y), pair, strict=True))


def _at(pair: tuple[float, float], scales: list[Scale]) -> complex:
    return complex(pair[0] * scales[0].factor, pair[1] * scales[1].factor)


LOOKS: dict[str, Any] = {
    "least": {"marker": "P", "color": STRESS, "markersize": 9, "markeredgecolor": "white"},
    "as it is": {"marker": "D", "color": INK, "markersize": 6.5, "markerfacecolor": "white"},
}


def _keys(marked: list[tuple[complex, str, str]], lacking: bool) -> list[Any]:
    names = {"least": say("least"), "as it is": say("as it is")}
    keys: list[Any] = [
        Line2D([], [], linestyle="none", label=names[look], **LOOKS[look]) for _, _, look in marked
    ]
    if lacking:
        keys.append(Patch(label=say("cannot turn"), **TURNS_NOT))
    return keys
