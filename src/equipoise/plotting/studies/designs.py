"""The best designs: what they trade for what, the numbers that make them, how they were found."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from equipoise.figures.labels import Labels
from equipoise.i18n import say
from equipoise.plotting.style import INK, MAIN, blank, heading, short
from equipoise.plotting.vibration.panels import (
    LEFT,
    RIGHT,
    WIDTH,
    continued,
    grid,
    groups,
    legend,
    name_x,
    name_y,
    place,
)
from equipoise.studies.design_space import Make

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from equipoise.schema.study_units import Unit
    from equipoise.studies.search import Searched

Array = np.ndarray[Any, Any]

HIGH, TOP, BOTTOM = 3.7, 0.82, 0.52
"""Inches: height of single axes, and what is above and below them."""
ROW = 2.1
"""Inches: height of a row of small axes."""
MARGIN = 0.08
"""Free at each side, over what is drawn."""
DOTS: Any = {"marker": "o", "markersize": 4.5, "linestyle": "none", "color": MAIN, "zorder": 3}
OWN: Any = {
    "marker": "D",
    "markersize": 6.5,
    "linestyle": "none",
    "color": INK,
    "markerfacecolor": "white",
    "zorder": 4,
}


@dataclass(frozen=True, eq=False)
class Designs:
    """Designs (K) as columns (K,) by name, SI units.

    by : what they were chosen by, and which way.  numbers : names of what varies.
    labels : of the designs.  units : in which they are drawn.
    own : the model itself by the same names, where it is known.
    """

    title: str
    by: Mapping[str, Make]
    numbers: Sequence[str]
    columns: Mapping[str, Array]
    labels: Sequence[str]
    units: Mapping[str, Unit]
    own: Mapping[str, float] | None = None

    def column(self, name: str) -> Array:
        """In the unit in which it is drawn."""
        unit = self.units[name]
        return np.array([unit.of_si(value) for value in self.columns[name].tolist()])

    def label(self, name: str, most: int = 40) -> str:
        """Name and unit, and which way is good."""
        unit = self.units[name].name.replace("^2", "²")
        label = f"{short(name, most)}, {unit}" if unit else short(name, most)
        if name not in self.by:
            return label
        if self.by[name] == "largest":
            return say("{label} (large is good)", label=label)
        return say("{label} (small is good)", label=label)


def front_figure(designs: Designs) -> Figure:
    """Every two aims against each other."""
    pairs = list(combinations(designs.by, 2))
    what = say("{count} designs that no other beats in everything", count=len(designs.labels))
    if len(pairs) == 1:
        figure = blank(WIDTH, HIGH + TOP + BOTTOM)
        heading(figure, designs.title, what, LEFT)
        panels = [place(figure, LEFT, BOTTOM, WIDTH - LEFT - RIGHT, HIGH)]
    else:
        figure, panels = grid(len(pairs), ROW + 0.5, designs.title, what, keys=True)
    for axes, pair in zip(panels, pairs, strict=True):
        _against(axes, designs, *pair)
        axes.set_xlabel(designs.label(pair[0], 26))
        name_y(axes, designs.label(pair[1], 26))
    if len(pairs) == 1:
        _ends(panels[0], designs, *pairs[0])
    _keys(figure, designs)
    return figure


def designs_figures(designs: Designs) -> Iterator[Figure]:
    """The first aim over each number that varies."""
    aim = next(iter(designs.by))
    every = list(designs.numbers)
    for names in groups(every):
        what = say("{aim} over each number that varies", aim=designs.label(aim))
        figure, panels = grid(
            len(names), ROW, designs.title, what + continued(names, every), keys=True
        )
        for axes, name in zip(panels, names, strict=True):
            _against(axes, designs, name, aim)
            axes.set_xlabel(designs.label(name, 34), labelpad=2.5)
            name_y(axes, designs.label(aim, 12).split(" (")[0])
        _keys(figure, designs)
        yield figure


def _against(axes: Axes, designs: Designs, first: str, second: str) -> None:
    x, y = designs.column(first), designs.column(second)
    axes.plot(x, y, **DOTS)
    held = [x, y]
    if designs.own is not None:
        own = [designs.units[name].of_si(designs.own[name]) for name in (first, second)]
        axes.plot(*own, **OWN)
        held = [np.append(one, value) for one, value in zip(held, own, strict=True)]
    axes.set_xlim(*_ends_of(held[0]))
    axes.set_ylim(*_ends_of(held[1]))


def _ends_of(values: Array) -> tuple[float, float]:
    """Limits with room around values."""
    low, high = float(np.min(values)), float(np.max(values))
    room = MARGIN * (high - low) or 0.05 * abs(high) or 1.0
    return low - room, high + room


def _ends(axes: Axes, designs: Designs, first: str, second: str) -> None:
    """Numbers of the designs at both ends."""
    x, y = designs.column(first), designs.column(second)
    labels = Labels(axes)
    for at in zip(x, y, strict=True):
        labels.reserve(*at)
    for k in {int(np.argmin(x)), int(np.argmax(x))}:
        labels.put(say("design {name}", name=designs.labels[k]), x[k], y[k], wish=60.0, color=MAIN)


def _keys(figure: Figure, designs: Designs) -> None:
    keys = [Line2D([], [], label=say("designs"), **DOTS)]
    if designs.own is not None:
        keys.append(Line2D([], [], label=say("the model itself"), **OWN))
    legend(figure, keys)


def grown_figure(found: Searched, units: Mapping[str, Unit]) -> Figure:
    """How good the best designs were after each generation."""
    figure = blank(WIDTH, 2.6 + TOP + BOTTOM)
    what = say(
        "{count} designs in {generations} generations",
        count=found.computed,
        generations=found.generations,
    )
    heading(figure, found.study.title, what, LEFT)
    axes = place(figure, LEFT, BOTTOM, WIDTH - LEFT - RIGHT, 2.6)
    generations = np.arange(1, len(found.volumes) + 1)
    if len(found.objectives) == 1:
        (name,) = found.objectives
        unit = units[name]
        values = [unit.of_si(value) for value in found.volumes.tolist()]
        name_y(axes, say("best {name}, {unit}", name=short(name, 24), unit=unit.name))
    else:
        values = (100 * found.volumes).tolist()
        name_y(axes, say("share that the front dominates, %"))
    axes.plot(generations, values, color=MAIN, drawstyle="steps-post")
    axes.set_xlim(1, max(2, len(values)))
    name_x(figure, say("generation"))
    return figure
