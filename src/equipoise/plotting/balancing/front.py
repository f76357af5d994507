"""The picture of a trade-off between two objectives."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.figure import Figure

from equipoise.balancing.problem import Problem
from equipoise.figures.additions import MM, grams
from equipoise.figures.labels import Labels
from equipoise.i18n import say
from equipoise.plotting.style import INK, LINES, MAIN, blank, fit, heading, short, shown
from equipoise.plotting.vibration.panels import BETWEEN, LEFT, RIGHT, WIDTH, place, told_speed
from equipoise.results.naming import objective_named

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from equipoise.balancing.pareto import Front
    from equipoise.mechanism.balance import Objective

Array = np.ndarray[Any, Any]

HIGH, TOP, BOTTOM = 3.6, 0.7, 0.52
"""Inches: height of the axes, and what is above and below them."""
SENSIBLE = 3.0
"""Times the size of the curve: how far off the machine as it is may be to be in the picture."""
MARGIN = 0.12
"""Free at each side, over what is drawn."""
UNITS = {"m": (MM, "mm"), "rad": (MM, "mrad")}
"""SI unit -> factor and unit of the picture, where they differ."""


def front_figure(found: Front) -> Figure:
    """The second objective against the first, each point as good as any can be."""
    figure = blank(WIDTH, HIGH + TOP + BOTTOM)
    speed = told_speed(found.original.drive.speed)
    title = say("Trade-off: the least of one for every value of the other")
    heading(figure, found.original.title, f"{title}, at {speed}", LEFT)
    axes = place(figure, LEFT, BOTTOM, WIDTH - LEFT - RIGHT, HIGH)
    scales, units = _units(found)
    values = found.values * scales
    before = np.array(_before(found)) * scales
    seen = _is_near(values, before)
    _settle(axes, np.vstack([values, before]) if seen else values)
    first, second = (_named(found, one) for one in (found.first, found.second))
    axes.set_xlabel(f"{short(first, 60)}, {units[0]}")
    axes.set_ylabel(f"{short(second, 46)}, {units[1]}")
    labels = Labels(axes)
    look: Any = {"color": MAIN, "markersize": 4.5, "zorder": 3}
    axes.plot(values[:, 0], values[:, 1], "o-", label=say("best machines"), **look)
    labels.avoid(values[:, 0], values[:, 1])
    told = tuple(f"{shown(value)} {unit}" for value, unit in zip(before, units, strict=True))
    if seen:
        _as_it_is(axes, labels, before, f"as it is: {', '.join(told)}")
    else:
        _far_off(axes, labels, say("as it is, far off: {places}", places=", ".join(told)))
    _ends(labels, found, values, units)
    return figure


def _named(found: Front, one: Objective) -> str:
    return objective_named(one, len(found.original.rows))


def _units(found: Front) -> tuple[Array, tuple[str, str]]:
    """Factors from SI (2,), and units, of both objectives."""
    columns = found.columns()[:2]
    first, second = (UNITS.get(unit, (1.0, unit)) for _, unit, _ in columns)
    return np.array([first[0], second[0]]), (first[1], second[1])


def _before(found: Front) -> tuple[float, float]:
    """Both objectives of the machine as it is, SI units."""
    one, other = (Problem.value_of(found.original, which) for which in (found.first, found.second))
    return one, other


def _is_near(values: Array, before: Array) -> bool:
    """Whether the machine as it is can be shown without making the curve small."""
    low, high = np.min(values, axis=0), np.max(values, axis=0)
    room = SENSIBLE * (high - low)
    return bool(np.all(before <= high + room) and np.all(before >= low - room))


def _settle(axes: Axes, values: Array) -> None:
    """Limits with room around all that is drawn."""
    low, high = np.min(values, axis=0), np.max(values, axis=0)
    room = MARGIN * np.where(high > low, high - low, np.maximum(np.abs(high), 1e-12))
    (left, bottom), (right, top) = (low - room).tolist(), (high + room).tolist()
    axes.set_xlim(left, right)
    axes.set_ylim(bottom, top)


def _as_it_is(axes: Axes, labels: Labels, before: Array, text: str) -> None:
    x, y = map(float, before)
    look: Any = {"color": INK, "markerfacecolor": "white", "markersize": 6.5, "zorder": 4}
    axes.plot(x, y, "D", label="as it is", **look)
    labels.reserve(x, y, half=4)
    labels.put(text, x, y, wish=90.0, color=INK)


def _far_off(axes: Axes, labels: Labels, text: str) -> None:
    """Say where the machine as it is would be, in a corner that the curve leaves free."""
    drawn = axes.text(0.98, 0.96, text, transform=axes.transAxes, ha="right", va="top", color=LINES)
    fit(drawn, WIDTH - LEFT - RIGHT - BETWEEN)
    labels.occupy(drawn)


def _ends(labels: Labels, found: Front, values: Array, units: tuple[str, str]) -> None:
    """Values and added mass at both ends of the curve."""
    for k, wish in ((0, 20.0), (len(values) - 1, 110.0)):
        x, y = map(float, values[k])
        text = f"{shown(x)} {units[0]}, {shown(y)} {units[1]}"
        added = found.points[k].added_mass
        if added > 1e-9:
            text += "\n" + say("with {mass} more", mass=grams(added))
        labels.put(text, x, y, wish=wish, color=MAIN)
