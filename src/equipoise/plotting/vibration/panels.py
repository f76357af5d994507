"""What the pictures of vibration share: panels, units, and words about speed and model."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from math import ceil, pi
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, NullFormatter

from equipoise.i18n import say
from equipoise.plotting.crank import crank_label, runs_left
from equipoise.plotting.style import FAINT, NORMAL, blank, fit, heading, shown

Array = np.ndarray[Any, Any]

WIDTH, LEFT, RIGHT = 7.2, 0.86, 0.2
"""Inches: width of a picture, and its margins."""
HEAD, FOOT, BETWEEN = 0.62, 0.5, 0.92
"""Inches: height of the heading and of the label below; between columns, labels included."""
LABELS = 0.64
"""Inches from the axes to the label of the y axis."""
MOST_PANELS = 10
"""In one picture of small axes."""
RPM = 30 / pi

Prefixed = tuple[tuple[float, str], ...]
UNITS: dict[tuple[str, bool], Prefixed] = {
    ("displacement", False): ((1e3, "mm"), (1e6, "µm"), (1.0, "m")),
    ("velocity", False): ((1e3, "mm/s"), (1e6, "µm/s"), (1.0, "m/s")),
    ("acceleration", False): ((1.0, "m/s²"), (1e3, "mm/s²"), (1.0, "m/s²")),
    ("displacement", True): ((1e3, "mrad"), (1e6, "µrad"), (1.0, "rad")),
    ("velocity", True): ((1e3, "mrad/s"), (1e6, "µrad/s"), (1.0, "rad/s")),
    ("acceleration", True): ((1.0, "rad/s²"), (1e3, "mrad/s²"), (1.0, "rad/s²")),
    ("force", False): ((1.0, "N"), (1e3, "mN"), (1e-3, "kN")),
    ("force", True): ((1.0, "N m"), (1e3, "mN m"), (1e-3, "kN m")),
}
"""(Quantity, of rotation) -> factor from SI and name of the usual unit, a smaller, a larger."""
SMALLEST, LARGEST = 1e-3, 1e4
"""Numbers between which the usual unit stays."""


@dataclass(frozen=True)
class Unit:
    """How many of a unit are one SI unit, and its name."""

    factor: float
    name: str

    @classmethod
    def of(cls, quantity: str, rotation: bool, values: Any) -> Unit:
        """The unit in which values (SI) are best read."""
        finite = np.abs(np.asarray(values, float)[np.isfinite(values)])
        usual, smaller, larger = UNITS[quantity, rotation]
        largest = float(np.max(finite, initial=0.0)) * usual[0]
        if 0 < largest < SMALLEST:
            return cls(*smaller)
        return cls(*(larger if largest > LARGEST else usual))


def stack(
    count: int, height: float, title: str, what: str, titles: float = 0.0
) -> tuple[Figure, list[Axes]]:
    """Panels of some inches below each other, over one x axis, with room for titles above each."""
    gap = 0.2 + titles / 2
    head = HEAD + titles
    whole = head + count * height + (count - 1) * gap + FOOT
    figure = blank(WIDTH, whole)
    heading(figure, title, what, LEFT)
    panels = []
    for row in range(count):
        bottom = whole - head - (row + 1) * height - row * gap
        axes = place(figure, LEFT, bottom, WIDTH - LEFT - RIGHT, height)
        if row < count - 1:
            axes.tick_params(labelbottom=False)
        panels.append(axes)
    return figure, panels


def grid(
    count: int, row: float, title: str, what: str, keys: bool = False
) -> tuple[Figure, list[Axes]]:
    """Small axes in two columns, or one that is larger; `keys` leaves room for a legend above."""
    columns = min(2, count)
    rows = ceil(count / columns)
    row = row if count > 1 else 1.4 * row
    head, above, below = HEAD + (0.1 if keys else -0.1), 0.26, 0.27
    whole = head + rows * row + FOOT - below
    figure = blank(WIDTH, whole)
    heading(figure, title, what, LEFT)
    width = (WIDTH - LEFT - RIGHT - BETWEEN * (columns - 1)) / columns
    panels = []
    for number in range(count):
        down, across = divmod(number, columns)
        bottom = whole - head - (down + 1) * row + below
        left = LEFT + across * (width + BETWEEN)
        panels.append(place(figure, left, bottom, width, row - above - below))
    return figure, panels


def place(figure: Figure, left: float, bottom: float, width: float, height: float) -> Axes:
    """Axes at a place of the picture, all in inches."""
    across, up = figure.get_size_inches()
    axes = figure.add_axes((left / across, bottom / up, width / across, height / up))
    # At the left stand the titles.
    axes.yaxis.set_offset_position("right")
    return axes


def name_y(axes: Axes, label: str) -> None:
    """The label of the y axis, at the same distance in every panel."""
    box = axes.get_window_extent()
    axes.set_ylabel(label)
    dpi = axes.get_figure(root=True).dpi  # type: ignore[union-attr]
    axes.yaxis.set_label_coords(-LABELS * dpi / box.width, 0.5)


def name_panel(axes: Axes, title: str, room: float = 0.0) -> None:
    """A title above the left end of small axes, shortened; some inches stay free at its right."""
    text = axes.set_title(title, fontsize=NORMAL, loc="left", pad=4)
    width = axes.get_window_extent().width / axes.get_figure(root=True).dpi  # type: ignore[union-attr]
    fit(text, width - room)


def name_x(figure: Figure, label: str) -> None:
    """One label for the x axes of all panels."""
    width, height = figure.get_size_inches()
    middle = (LEFT + width - RIGHT) / 2 / width
    fit(figure.text(middle, 0.12 / height, label, ha="center", fontsize=NORMAL), width - 0.3)


def legend(figure: Figure, handles: Sequence[Any]) -> None:
    """What the lines are, below the heading at the left."""
    if not handles:
        return
    width, height = figure.get_size_inches()
    figure.legend(
        handles=handles,
        loc="upper left",
        bbox_to_anchor=(LEFT / width, 1 - 0.49 / height),
        ncols=len(handles),
        borderaxespad=0,
        borderpad=0,
    )


def log_scale(axes: Axes, low: float, high: float) -> None:
    """A log y axis with plain numbers."""
    axes.set_yscale("log")
    axes.set_ylim(low, high)
    axes.yaxis.set_major_formatter(FuncFormatter(lambda value, _: shown(value)))
    axes.yaxis.set_minor_formatter(NullFormatter())


def zero_line(axes: Axes) -> None:
    """A thin line at zero, where it is in sight."""
    low, high = axes.get_ylim()
    if low < 0 < high:
        axes.axhline(0, color=FAINT, linewidth=0.8, zorder=1)


def groups(names: Sequence[str], most: int = MOST_PANELS) -> Iterator[Sequence[str]]:
    """Names by so many for each picture."""
    for start in range(0, len(names), most):
        yield names[start : start + most]


def told_speed(speed: float) -> str:
    """A crank speed in words."""
    values = {"rpm": shown(abs(speed) * RPM), "rate": shown(abs(speed))}
    if speed < 0:
        return say("{rpm} rpm ({rate} rad/s, clockwise)", **values)
    return say("{rpm} rpm ({rate} rad/s)", **values)


def continued(names: Sequence[str], every: Sequence[str]) -> str:
    """Which of several pictures it is, in words."""
    if len(names) == len(every):
        return ""
    first = every.index(names[0]) + 1
    last = first + len(names) - 1
    return " " + say("({first} to {last} of {count})", first=first, last=last, count=len(every))


def by_phase(drive: str, speed: float, with_motor: bool) -> str:
    """What the x axis over a period is."""
    if not with_motor:
        return crank_label(drive, speed)
    text = say("time, in degrees: 360° last as long as a turn of the crank in the mean")
    return text + runs_left(speed)
