"""How before and after look, and what the pictures of balancing say in words."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.lines import Line2D

from equipoise import signals
from equipoise.figures.additions import SHORT
from equipoise.i18n import say, to_say
from equipoise.plotting.analysis.looks import rounding, settled
from equipoise.plotting.crank import Line, crank_axis, draw, mark
from equipoise.plotting.hodograph import nothing_there
from equipoise.plotting.style import LINES, MAIN, short
from equipoise.plotting.vibration.panels import Unit, by_phase, name_x, name_y
from equipoise.results.analysis import analyze

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from equipoise.mechanism.model import Drive, Machine

Array = np.ndarray[Any, Any]
Pair = Mapping[str, Array]
"""``before`` and ``after``, or the latter alone."""

THIN, STRONG = 0.9, 1.9
"""Points: width of the lines before and after."""
LOOKS: dict[str, dict[str, Any]] = {
    "before": {"color": LINES, "linewidth": THIN, "zorder": 3.1},
    "after": {"color": MAIN, "linewidth": STRONG, "zorder": 3.0},
}
"""The thin line lies on the strong one, so that both are seen where they are the same."""
MUTED: dict[str, Any] = {"color": LINES, "linewidth": 1.3, "zorder": 3.0}
"""Of what balancing leaves as it was."""
WHEN = {"before": to_say("before"), "after": to_say("after")}
SAMPLES = 360
"""Crank angles in a turn from which it is told what is rounding."""
NOTHING = 1e-9
"""Over the largest value before: what is left after is rounding."""
ALIKE = 1e-6
"""Over the largest value: what differs by less is unchanged."""


def keys(*pairs: Pair) -> list[Any]:
    """What the lines of some pairs are, for a legend."""
    drawn = {name: look for pair in pairs for name, (_, look) in lines_of(pair).items()}
    told = {**WHEN, "unchanged": to_say("unchanged")}
    return [Line2D([], [], label=say(told[name]), **drawn[name]) for name in told if name in drawn]


def lines_of(pair: Pair) -> dict[str, tuple[Array, dict[str, Any]]]:
    """What is drawn of a pair: name -> values (N,) and look; of what is alike one muted line."""
    if "before" in pair:
        largest = float(np.max(np.abs(pair["before"]), initial=0.0))
        if np.all(np.abs(pair["after"] - pair["before"]) <= ALIKE * largest):
            return {"unchanged": (pair["after"], MUTED)}
    return {when: (pair[when], look) for when, look in LOOKS.items() if when in pair}


def rounding_of(machine: Machine) -> tuple[float, float]:
    """Force (N) and moment (N m) of a machine that are rounding."""
    return rounding(analyze(machine, SAMPLES))


def paired(before: Array, after: Array, least: float) -> Pair:
    """Values (N,) before and after; zeros where they are no more than `least`, which is rounding.

    After they are also zeros where they are rounding beside those before.
    """
    before = settled(before, least)
    largest = float(np.max(np.abs(before), initial=0.0))
    return {"before": before, "after": settled(after, max(least, NOTHING * largest))}


def compare(
    axes: Axes,
    angles: Array,
    pair: Pair,
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
    drawn = lines_of(pair)
    lines = [
        _line(angles, unit.factor * values, name, look["color"], period)
        for name, (values, look) in drawn.items()
    ]
    crank_axis(axes, round(period / (2 * np.pi)))
    name_y(axes, f"{kind}, {unit.name}")
    draw(axes, lines)
    for line, (_, look) in zip(axes.get_lines(), drawn.values(), strict=False):
        line.set(**look)
    mark(axes, lines, [], told_angles)
    if not any(np.any(values) for values in pair.values()):
        nothing_there(axes, say("zero at every crank angle"))


def _line(angles: Array, values: Array, name: str, color: str, period: float) -> Line:
    told = signals.figures(angles, values)
    marked = [(told.max_at, told.max), (told.min_at, told.min)]
    theta, closed = np.append(angles, period), np.append(values, values[0])
    return Line(theta, closed, name, color, "-", marked)


def name_angles(figure: Figure, drive: Drive) -> None:
    """What the x axes are: the crank's angle."""
    name_x(figure, by_phase(short(drive.link, SHORT), drive.speed, with_motor=False))
