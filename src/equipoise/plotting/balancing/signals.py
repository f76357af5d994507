"""Shaking force, shaking moment and drive torque of a machine before and after."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.figure import Figure

from equipoise.figures.labels import Labels
from equipoise.i18n import say, to_say
from equipoise.plotting.balancing.looks import (
    LOOKS,
    Pair,
    compare,
    keys,
    lines_of,
    name_angles,
    paired,
    rounding_of,
)
from equipoise.plotting.hodograph import (
    ALIKE,
    nothing_there,
    numbers,
    origin,
    square,
    told_angles,
)
from equipoise.plotting.style import blank, heading
from equipoise.plotting.vibration.panels import (
    LEFT,
    RIGHT,
    Unit,
    legend,
    place,
    stack,
    told_speed,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from equipoise.balancing.balanced import Balanced

Array = np.ndarray[Any, Any]

HIGH, ONE = 1.75, 2.5
"""Inches: height of one of two panels, and of a single one."""
KEYS = 0.16
"""Inches above the panels for the legend."""
SQUARE, TOP, BOTTOM = 4.6, 0.78, 0.5
"""Inches: side of the hodograph, and what is above and below it."""
SIGNALS = {
    "moment": (
        "shaking_moment",
        to_say("Shaking moment about the drive's pivot"),
        to_say("shaking moment"),
    ),
    "torque": ("drive_torque", to_say("Drive torque"), to_say("drive torque")),
}
"""Picture -> column, title, and label of the axis."""


def signal_figures(found: Balanced) -> dict[str, Figure]:
    """``force``, ``polar``, ``moment`` and ``torque``, before and after."""
    columns = {name: values for name, _, values in found.columns()}
    angles = columns["crank_angle"]
    least_force, least_moment = rounding_of(found.original)
    force = {axis: _pair(columns, f"shaking_force.{axis}", least_force) for axis in ("x", "y")}
    drawn = {
        "force": force_figure(found, angles, force),
        "polar": polar_figure(found, angles, force),
    }
    for name, (output, title, label) in SIGNALS.items():
        what = f"{say(title)}, {_told(found)}"
        figure, panels = stack(1, ONE, found.original.title, what, KEYS)
        pair = _pair(columns, output, least_moment)
        compare(panels[0], angles, pair, say(label), True, True)
        drawn[name] = finish(figure, found, pair)
    return drawn


def _told(found: Balanced) -> str:
    """What is shown of a signal, in words."""
    of_one = say("of one row") + ", " if len(found.original.rows) > 1 else ""
    speed = told_speed(found.original.drive.speed)
    return of_one + say("before and after, at {speed}", speed=speed)


def _pair(columns: dict[str, Array], output: str, least: float) -> Pair:
    return paired(columns[f"{output}.before"], columns[f"{output}.after"], least)


def force_figure(found: Balanced, angles: Array, force: dict[str, Pair]) -> Figure:
    """Components of the shaking force over crank angle."""
    what = f"{say('Shaking force')}, {_told(found)}"
    figure, panels = stack(2, HIGH, found.original.title, what, KEYS)
    for axes, (axis, pair) in zip(panels, force.items(), strict=True):
        compare(axes, angles, pair, say("along {axis}", axis=axis))
    return finish(figure, found, *force.values())


def finish(figure: Figure, found: Balanced, *pairs: Pair) -> Figure:
    """Name the x axis, and say which line of some pairs is which."""
    name_angles(figure, found.original.drive)
    legend(figure, keys(*pairs))
    return figure


# -- hodograph -------------------------------------------------------------------------------------


def polar_figure(found: Balanced, angles: Array, force: dict[str, Pair]) -> Figure:
    """The end of the shaking force's arrow over a cycle, on axes of one scale."""
    unit = Unit.of("force", False, np.concatenate([*force["x"].values(), *force["y"].values()]))
    ends = {when: unit.factor * (force["x"][when] + 1j * force["y"][when]) for when in LOOKS}
    figure = blank(SQUARE + LEFT + RIGHT, SQUARE + TOP + BOTTOM)
    what = f"{say('Shaking force')}, {_told(found)}; {say('numbers: crank angle, deg')}"
    heading(figure, found.original.title, what, LEFT)
    axes = place(figure, LEFT, BOTTOM, SQUARE, SQUARE)
    square(np.concatenate([*ends.values()]), SQUARE).settle(axes)
    axes.set_aspect("equal")
    axes.set_xlabel(say("shaking force along x, {unit}", unit=unit.name))
    axes.set_ylabel(say("shaking force along y, {unit}", unit=unit.name))
    origin(axes)
    _hodographs(axes, angles, ends)
    if not any(np.any(values) for values in ends.values()):
        nothing_there(axes, say("zero at every crank angle"))
    legend(figure, keys(ends))
    return figure


def _hodographs(axes: Axes, angles: Array, ends: Pair) -> None:
    labels = Labels(axes)
    drawn = lines_of(ends)
    for name, (values, look) in drawn.items():
        closed = np.append(values, values[0])
        axes.plot(closed.real, closed.imag, label=name, **look)
        labels.avoid(closed.real, closed.imag)
    at = told_angles(angles)
    for values, look in reversed(drawn.values()):
        if np.any(values):
            numbers(axes, labels, at, values, look["color"])
        apart = np.abs(ends["before"] - ends["after"])
        at = {angle: k for angle, k in at.items() if apart[k] > ALIKE * np.ptp(axes.get_xlim())}
