"""Rows on one shaft: the directions of their cranks, and what they do together."""

from __future__ import annotations

from math import ceil
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Circle

from equipoise.balancing.multi_row import Rows
from equipoise.figures.additions import MM
from equipoise.figures.drawing import arrow
from equipoise.i18n import say
from equipoise.mechanism.balance import Objective
from equipoise.plotting.analysis.looks import settled
from equipoise.plotting.balancing.looks import (
    LOOKS,
    WHEN,
    Pair,
    compare,
    keys,
    name_angles,
    paired,
    rounding_of,
)
from equipoise.plotting.style import FAINT, NORMAL, SMALL, blank, heading, short, shown
from equipoise.plotting.vibration.panels import (
    LEFT,
    RIGHT,
    WIDTH,
    legend,
    name_x,
    place,
    stack,
    told_speed,
)
from equipoise.signals import Periodic

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from equipoise.mechanism.model import Machine

Array = np.ndarray[Any, Any]

IN_LINE = 6
"""Dials side by side."""
DIAL, FACE = 1.0, 0.41
"""Inches from dial to dial, and radius of a dial."""
ABOVE, BELOW, HEAD, FOOT = 0.22, 0.56, 0.72, 0.3
"""Inches: above and below a line of dials; heading and foot of the picture."""
LINE = 0.16
"""Inches: height of a line of words."""
SAMPLES = 720
"""In a turn."""
HIGH, KEYS = 1.75, 0.16
"""Inches: height of a panel, and of the legend above."""
HEADS = {"before": 7.0, "after": 11.0}
"""Size of the heads of hands."""


def phases_figure(original: Machine | None, machine: Machine) -> Figure:
    """A dial for each row in the order of their places, with a hand for its crank."""
    count = len(machine.rows)
    lines = ceil(count / IN_LINE)
    row = 2 * FACE + ABOVE + BELOW
    figure = blank(WIDTH, HEAD + lines * row + FOOT)
    what = say("Direction of {link} in each row at one instant", link=short(machine.drive.link))
    heading(figure, machine.title, what, LEFT)
    order = sorted(range(count), key=lambda k: machine.rows[k].lateral)
    for number, k in enumerate(order):
        down, across = divmod(number, IN_LINE)
        in_line = min(IN_LINE, count - down * IN_LINE)
        middle = LEFT + (WIDTH - LEFT - RIGHT) / 2 + (across - (in_line - 1) / 2) * DIAL
        bottom = figure.get_figheight() - HEAD - (down + 1) * row + BELOW
        axes = place(figure, middle - DIAL / 2, bottom, DIAL, 2 * FACE + ABOVE)
        _dial(axes, original, machine, k)
    hands = LOOKS if original is not None else ("after",)
    legend(figure, [Line2D([], [], label=say(WHEN[name]), **LOOKS[name]) for name in hands])
    name_x(figure, say("from left to right of who looks forward, with their lateral places"))
    return figure


def _dial(axes: Axes, original: Machine | None, machine: Machine, k: int) -> None:
    """The crank of one row, in a circle of radius 1."""
    half = DIAL / 2 / FACE
    axes.set_xlim(-half, half)
    axes.set_ylim(-1.05, -1.05 + (2 * FACE + ABOVE) / FACE)
    axes.set_axis_off()
    axes.add_patch(Circle((0, 0), 1.0, fill=False, ec=FAINT, lw=0.8))
    for way in (1, 1j, -1, -1j):
        tick = np.array([0.9 * way, way])
        axes.plot(tick.real, tick.imag, color=FAINT, linewidth=0.8)
    told = [(f"{shown(MM * machine.rows[k].lateral)} mm", "black")]
    for when, one in (("before", original), ("after", machine)):
        if one is None:
            continue
        phase = one.rows[k].phase
        look = LOOKS[when]
        tip = complex(np.exp(1j * phase))
        style = {"color": look["color"], "lw": look["linewidth"], "zorder": look["zorder"]}
        arrow(axes, 0j, tip, mutation_scale=HEADS[when], **style)
        text = f"{say(WHEN[when])} {shown(round(float(np.degrees(phase)), 2) % 360)}°"
        told.append((text, look["color"]))
    axes.plot(0, 0, "o", color=LOOKS["after"]["color"], markersize=4, zorder=5)
    axes.text(
        0, 1.12, say("row {number}", number=k + 1), fontsize=NORMAL, fontweight="bold", ha="center"
    )
    _below(axes, told)


def _below(axes: Axes, told: list[tuple[str, str]]) -> None:
    """Lines of words below a dial, with their colours: where the row is, and its phases."""
    for number, (text, color) in enumerate(told):
        y = -1.05 - (number + 0.85) * LINE / FACE
        axes.text(0, y, text, fontsize=SMALL, color=color, ha="center", clip_on=False)


def together_figure(original: Machine | None, machine: Machine) -> Figure:
    """Components of the shaking force of all rows together over crank angle."""
    told = {"count": len(machine.rows), "speed": told_speed(machine.drive.speed)}
    if original is None:
        what = say("Shaking force of {count} rows together, at {speed}", **told)
    else:
        what = say("Shaking force of {count} rows together, before and after, at {speed}", **told)
    figure, panels = stack(2, HIGH, machine.title, what, KEYS)
    least, _ = rounding_of(machine)
    pairs: list[Pair] = []
    for axes, axis in zip(panels, ("x", "y"), strict=True):
        angles, after = summed(machine, axis)
        pairs.append({"after": settled(after, least)})
        if original is not None:
            pairs[-1] = paired(summed(original, axis)[1], after, least)
        compare(axes, angles, pairs[-1], say("along {axis}", axis=axis))
    name_angles(figure, machine.drive)
    legend(figure, keys(*pairs))
    return figure


def summed(machine: Machine, axis: str) -> tuple[Array, Array]:
    """Crank angles (N,), rad, of a whole cycle, and a part of the force of all rows (N,), N."""
    read = Rows(machine).signals(Objective(f"shaking_force.{axis}"))
    total = read.total(np.array([row.phase for row in machine.rows]))[0, 0]
    count = SAMPLES * read.turns
    found = Periodic(total, read.turns)
    return np.arange(count) * (found.period / count), found.samples(count)
