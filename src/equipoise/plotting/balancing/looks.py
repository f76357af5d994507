"""How before and after look, and what the pictures of balancing say in words."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.lines import Line2D

from equipoise import signals
from equipoise.plotting.crank import Line, crank_axis, draw, mark
from equipoise.plotting.style import LINES, MAIN, short, shown
from equipoise.plotting.vibration.panels import Unit, by_phase, name_x, name_y
from equipoise.words import say, to_say

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from equipoise.mechanism.model import Drive

Array = np.ndarray[Any, Any]

MM = 1000.0
THIN, STRONG = 0.9, 1.9
"""Points: width of the lines before and after."""
LOOKS: dict[str, dict[str, Any]] = {
    "before": {"color": LINES, "linewidth": THIN, "zorder": 3.1},
    "after": {"color": MAIN, "linewidth": STRONG, "zorder": 3.0},
}
"""The thin line lies on the strong one, so that both are seen where they are the same."""
WHEN = {"before": to_say("before"), "after": to_say("after")}
SHORT = 16
"""Signs that a link's name may have beside other words."""
NOTHING = 1e-9
"""Over the largest value before: what is left after is rounding."""


def keys() -> list[Any]:
    """What the two lines are, for a legend."""
    return [Line2D([], [], label=say(WHEN[name]), **look) for name, look in LOOKS.items()]


def settled(before: Array, after: Array) -> Array:
    """The values after, or zeros where they are rounding beside those before."""
    largest = float(np.max(np.abs(before), initial=0.0))
    return after if float(np.max(np.abs(after), initial=0.0)) > NOTHING * largest else 0 * after


def compare(
    axes: Axes,
    angles: Array,
    pair: dict[str, Array],
    kind: str,
    rotation: bool = False,
    told_angles: bool = False,
) -> None:
    """Draw a signal before and after against crank angle, with the extremes of both.

    angles : (N,), rad, equally spaced over a whole cycle.  pair : ``before`` and ``after``, or the
        latter alone, in SI units.  kind : what the label of the axis calls it.
    told_angles : whether the crank angles of the extremes are told, which takes room.
    """
    unit = Unit.of("force", rotation, np.concatenate([*pair.values()]))
    period = float(angles[-1] + angles[1] - angles[0])
    told = [when for when in LOOKS if when in pair]
    lines = [_line(angles, unit.factor * pair[when], when, period) for when in told]
    crank_axis(axes, round(period / (2 * np.pi)))
    name_y(axes, f"{kind}, {unit.name}")
    draw(axes, lines)
    for line, when in zip(axes.get_lines(), told, strict=False):
        line.set(**LOOKS[when])
    mark(axes, lines, [], told_angles)


def _line(angles: Array, values: Array, name: str, period: float) -> Line:
    told = signals.figures(angles, values)
    marked = [(told.max_at, told.max), (told.min_at, told.min)]
    theta, closed = np.append(angles, period), np.append(values, values[0])
    return Line(theta, closed, name, LOOKS[name]["color"], "-", marked)


def name_angles(figure: Figure, drive: Drive) -> None:
    """What the x axes are: the crank's angle."""
    name_x(figure, by_phase(short(drive.link, SHORT), drive.speed, with_motor=False))


def grams(mass: float) -> str:
    """A mass (kg) as a workshop would tell it."""
    return f"{shown(mass)} kg" if mass >= 10 else f"{shown(MM * mass)} g"
