"""Natural frequencies against a number of the tool, and the determinant whose zeros they are."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import FixedLocator, FuncFormatter, NullLocator

from equipoise.figures.labels import Labels
from equipoise.handheld.design_plan import KEYS
from equipoise.handheld.frequencies import scale_of
from equipoise.handheld.studies import number_of
from equipoise.plotting.style import INK, LINES, MAIN, STRESS, blank, fit, heading, short, shown
from equipoise.plotting.tool.speeds import WORK, turns
from equipoise.plotting.vibration.curves import LINE, legend_at, rows_of
from equipoise.plotting.vibration.panels import (
    FOOT,
    LEFT,
    RPM,
    WIDTH,
    name_panel,
    name_x,
    name_y,
    place,
    stack,
    zero_line,
)

if TYPE_CHECKING:
    from equipoise.handheld.model import Tool
    from equipoise.handheld.modes import PlaneModes, ToolModes
    from equipoise.handheld.studies import DeterminantChart, Variation

Array = np.ndarray[Any, Any]

UNITS = {
    "length": ("mm", 1e3),
    "mass": ("kg", 1.0),
    "stiffness": ("kN/m", 1e-3),
    "damping": ("N s/m", 1.0),
    "torsional stiffness": ("N m/rad", 1.0),
    "torsional damping": ("N m s/rad", 1.0),
}
"""Dimension of a number of a station -> unit, and factor from SI."""
PARTS = {"harness": "of the harness at", "absorber": "of the absorber at"}
TALL, TITLE = 2.6, 0.2
"""Inches: a panel of the determinant, and its title."""
HEIGHT, HEAD, BESIDE = 3.1, 0.58, 0.72
"""Inches: the panel of a variation, its heading, and its margin with the right axis."""
STEP = 0.3
"""Inches between numbers of the right axis, at least."""
ROUNDEST = ((1.0,), (5.0, 2.0), (3.0, 4.0, 7.0, 6.0, 8.0, 9.0), (1.5, 2.5))
"""First digits of these numbers, the roundest first."""
LOOKS: tuple[dict[str, Any], ...] = (
    {"color": MAIN, "linestyle": "-", "zorder": 3.2},
    {"color": STRESS, "linestyle": (0, (4, 2)), "zorder": 2.2},
)
"""Of the vertical and the lateral plane."""
NOW: Any = (0, (1.5, 1.5))
"""Dashes of the number as it is."""


def determinant_figure(chart: DeterminantChart, modes: ToolModes) -> Figure:
    """The characteristic function against lambda, and its zeros: Fig. 2 of Nagamine and Irie."""
    planes = (0,) if modes.alike else (0, 1)
    told = "both planes" if modes.alike else "by planes"
    what = f"Characteristic function D without damping, {told}; its zeros are the modes"
    titles = 0.0 if modes.alike else TITLE
    height = TALL if modes.alike else 0.7 * TALL
    figure, panels = stack(len(planes), height, modes.tool.title, what, titles)
    for plane, axes in zip(planes, panels, strict=True):
        if not modes.alike:
            name_panel(axes, ("vertical plane", "lateral plane")[plane])
        name_y(axes, "± lg(1 + |D| / least peak)")
        _determinant(axes, chart.parameter, chart.value[plane], modes.planes[plane])
    name_x(figure, "λ")
    return figure


def _determinant(axes: Axes, parameter: Array, value: Array, found: PlaneModes) -> None:
    top = float(np.max(np.abs(value))) or 1.0
    axes.set_xlim(0, float(parameter[-1]))
    axes.set_ylim(-1.1 * top, 1.1 * top)
    zero_line(axes)
    axes.plot(parameter, value, color=MAIN, linewidth=1.4, zorder=3)
    labels = Labels(axes)
    labels.avoid(parameter, value)
    labels.avoid([0, parameter[-1]], [0, 0])
    zeros = zeros_of(parameter, value, found.parameter)
    for zero in zeros:
        look: Any = {"color": STRESS, "markerfacecolor": "white", "markersize": 5}
        axes.plot(zero, 0.0, "o", zorder=4, clip_on=False, **look)
        labels.reserve(zero, 0.0, half=4)
    for zero in zeros:
        labels.put(f"{zero:.3f}", zero, 0.0, wish=60.0, color=STRESS, optional=True)


def zeros_of(parameter: Array, value: Array, known: Array) -> list[float]:
    """Zeros in a chart: those that are known exactly, and beyond them where its sign changes."""
    inside = known[(known > 0) & (known <= parameter[-1])]
    before = np.flatnonzero(np.signbit(value[1:]) != np.signbit(value[:-1]))
    x, y = parameter, value
    crossed = x[before] - y[before] * (x[before + 1] - x[before]) / (y[before + 1] - y[before])
    beyond = crossed[parameter[before] > np.max(known, initial=0.0)]
    return [*map(float, inside), *map(float, beyond)]


def variation_figure(variation: Variation) -> Figure:
    """Lambda and frequency against a number of a station: Figs. 3 and 4 of Nagamine and Irie."""
    tool = variation.tool
    unit, factor = UNITS[KEYS[variation.key]]
    x = factor * variation.values
    planes = 2 if _apart(variation) else 1
    top = 1.06 * float(np.max(variation.parameter)) or 1.0
    marks = [*_now(x, factor * number_of(tool, variation.station, variation.key), unit)]
    marks += _work(tool, top)
    keys = [*_plane_keys(planes), *(mark.key for mark in marks)]
    head = HEAD + LINE * rows_of(keys)
    figure = blank(WIDTH, head + HEIGHT + FOOT)
    what = f"Natural frequencies without damping against the {named(variation)}"
    heading(figure, tool.title, what, LEFT)
    legend_at(figure, keys, HEAD - 0.06)
    width = WIDTH - LEFT - BESIDE
    axes = place(figure, LEFT, FOOT, width, HEIGHT)
    _limits(axes, x, top)
    for look, rows in zip(LOOKS[:planes], variation.parameter, strict=False):
        for row in rows.T:
            axes.plot(x, row, linewidth=1.5, **look)
    for mark in marks:
        mark.draw(axes)
    name_y(axes, "λ")
    fit(axes.set_xlabel(f"{named(variation)}, {unit}"), width)
    _right_axis(axes, scale_of(tool))
    _numbers(axes, x, variation.parameter[:planes])
    return figure


def named(variation: Variation) -> str:
    """The number that varies, in words."""
    owner, dot, last = variation.key.rpartition(".")
    station = short(variation.station)
    words = last.replace("_", " ")
    if dot:
        return f"{words} {PARTS[owner]} {station}"
    to = " to the ground" if KEYS[variation.key] not in ("length", "mass") else ""
    return f"{words} of {station}{to}"


def _apart(variation: Variation) -> bool:
    """Whether the planes differ."""
    vertical, lateral = variation.parameter
    return not np.allclose(vertical, lateral, rtol=1e-6, atol=1e-9)


def _plane_keys(planes: int) -> list[Line2D]:
    names = ("both planes",) if planes == 1 else ("vertical plane", "lateral plane")
    return [Line2D([], [], label=name, **LOOKS[k]) for k, name in enumerate(names)]


def _limits(axes: Axes, x: Array, top: float) -> None:
    """Log where the values were chosen so."""
    if len(x) > 2 and np.all(x > 0) and _uneven(np.log(x)) < _uneven(x):
        axes.set_xscale("log")
        axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: shown(value)))
        axes.xaxis.set_minor_formatter(FuncFormatter(lambda value, _: ""))
    low, high = float(np.min(x)), float(np.max(x))
    if low < high:
        axes.set_xlim(low, high)
    axes.set_ylim(0, top)


def _uneven(values: Array) -> float:
    steps = np.abs(np.diff(np.sort(values)))
    return float(np.ptp(steps) / np.mean(steps)) if np.any(steps) else 0.0


def _right_axis(axes: Axes, scale: float) -> None:
    """The same axis in turns a minute, which grow with the square of lambda."""
    beside = axes.twinx()
    top = axes.get_ylim()[1]
    figure: Any = axes.get_figure(root=True)
    apart = STEP * figure.dpi / axes.get_window_extent().height * top
    beside.set_ylim(axes.get_ylim())
    highest = scale * top**2 * RPM
    chosen = _round_numbers(highest, lambda minute: float(np.sqrt(minute / RPM / scale)), apart)
    places = [float(np.sqrt(minute / RPM / scale)) for minute in chosen]
    names = dict(zip(places, chosen, strict=True))
    beside.yaxis.set_major_locator(FixedLocator(places))
    beside.yaxis.set_major_formatter(FuncFormatter(lambda y, _: turns(names.get(y, 0.0) / RPM)))
    beside.yaxis.set_minor_locator(NullLocator())
    beside.grid(False)
    beside.set_ylabel("natural frequency, 1/min")


def _round_numbers(highest: float, place_of: Callable[[float], float], apart: float) -> list[float]:
    """Numbers from 0 to the highest whose places are apart, the roundest first."""
    chosen = [0.0]
    powers = 10.0 ** np.arange(np.floor(np.log10(highest)), np.floor(np.log10(highest)) - 4, -1)
    for digits in ROUNDEST:
        for number in np.multiply.outer(powers, digits).ravel().tolist():
            far = all(abs(place_of(number) - place_of(one)) >= apart for one in chosen)
            if number <= highest and far:
                chosen.append(number)
    return sorted(chosen)


@dataclass(frozen=True)
class Mark:
    """A line across the picture with its name."""

    at: float
    upright: bool
    name: str
    look: dict[str, Any]

    @property
    def key(self) -> Line2D:
        """For the legend."""
        return Line2D([], [], label=self.name, **self.look)

    def draw(self, axes: Axes) -> None:
        """From end to end."""
        (axes.axvline if self.upright else axes.axhline)(self.at, zorder=2, **self.look)


def _now(x: Array, now: float, unit: str) -> Iterator[Mark]:
    """The number as it is."""
    if np.min(x) <= now <= np.max(x):
        look = {"color": INK, "linewidth": 1.0, "linestyle": NOW}
        yield Mark(now, True, f"now {shown(now)} {unit}", look)


def _work(tool: Tool, top: float) -> Iterator[Mark]:
    """The speed of the engine at work."""
    if tool.operation is not None:
        at = float(np.sqrt(tool.operation.speed / scale_of(tool)))
        look = {"color": LINES, "linewidth": 0.9, "linestyle": WORK}
        if at <= top:
            yield Mark(at, False, f"work, {turns(tool.operation.speed)} rpm", look)


def _numbers(axes: Axes, x: Array, parameter: Array) -> None:
    """Numbers of the modes on their lines."""
    labels = Labels(axes)
    for plane in parameter:
        for row in plane.T:
            labels.avoid(x, row, weight=0.3)
    at = 0.06
    log = axes.get_xscale() == "log"
    low, high = axes.get_xlim()
    place_x = low * (high / low) ** at if log else low + at * (high - low)
    order = np.argsort(x)
    for number, row in enumerate(parameter[0].T, 1):
        y = float(np.interp(place_x, x[order], row[order]))
        labels.put(str(number), place_x, y, near=3.0, optional=True, color=MAIN)
