"""Shaking force, shaking moment and drive torque of a machine before and after."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.figure import Figure

from equipoise.plotting.balancing.looks import LOOKS, compare, keys, name_angles, settled
from equipoise.plotting.crank import angle_step
from equipoise.plotting.labels import Labels
from equipoise.plotting.panels import Panel
from equipoise.plotting.style import FAINT, SMALL, blank, heading
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
Pair = dict[str, Array]

HIGH, ONE = 1.75, 2.5
"""Inches: height of one of two panels, and of a single one."""
KEYS = 0.16
"""Inches above the panels for the legend."""
SQUARE, TOP, BOTTOM = 4.6, 0.78, 0.5
"""Inches: side of the hodograph, and what is above and below it."""
MARGIN = 0.14
"""Free at each side of the hodograph, over its width."""
ALIKE = 0.015
"""Over the width of the hodograph: dots nearer to each other share their number."""
QUARTERS, FEW_TURNS = 90, 3
"""Degrees between crank angles on the hodograph; turns from which they are further apart."""
SIGNALS = {
    "moment": ("shaking_moment", "Shaking moment about the drive's pivot", "shaking moment"),
    "torque": ("drive_torque", "Drive torque", "drive torque"),
}
"""Picture -> column, title, and label of the axis."""


def signal_figures(found: Balanced) -> dict[str, Figure]:
    """``force``, ``polar``, ``moment`` and ``torque``, before and after."""
    columns = {name: values for name, _, values in found.columns()}
    angles = columns["crank_angle"]
    force = {axis: _pair(columns, f"shaking_force.{axis}") for axis in ("x", "y")}
    drawn = {
        "force": force_figure(found, angles, force),
        "polar": polar_figure(found, angles, force),
    }
    for name, (output, title, label) in SIGNALS.items():
        what = f"{title}, {_told(found)}"
        figure, panels = stack(1, ONE, found.original.title, what, KEYS)
        compare(panels[0], angles, _pair(columns, output), label, True, True)
        drawn[name] = finish(figure, found)
    return drawn


def _told(found: Balanced) -> str:
    """What is shown of a signal, in words."""
    of_one = "of one row, " if len(found.original.rows) > 1 else ""
    return f"{of_one}before and after, at {told_speed(found.original.drive.speed)}"


def _pair(columns: Pair, output: str) -> Pair:
    before, after = (columns[f"{output}.{when}"] for when in LOOKS)
    return {"before": before, "after": settled(before, after)}


def force_figure(found: Balanced, angles: Array, force: dict[str, Pair]) -> Figure:
    """Components of the shaking force over crank angle."""
    what = f"Shaking force, {_told(found)}"
    figure, panels = stack(2, HIGH, found.original.title, what, KEYS)
    for axes, (axis, pair) in zip(panels, force.items(), strict=True):
        compare(axes, angles, pair, f"along {axis}")
    return finish(figure, found)


def finish(figure: Figure, found: Balanced) -> Figure:
    """Name the x axis, and say which line is which."""
    name_angles(figure, found.original.drive)
    legend(figure, keys())
    return figure


# -- hodograph -------------------------------------------------------------------------------------


def polar_figure(found: Balanced, angles: Array, force: dict[str, Pair]) -> Figure:
    """The end of the shaking force's arrow over a cycle, on axes of one scale."""
    unit = Unit.of("force", False, np.concatenate([*force["x"].values(), *force["y"].values()]))
    ends = {when: unit.factor * (force["x"][when] + 1j * force["y"][when]) for when in LOOKS}
    figure = blank(SQUARE + LEFT + RIGHT, SQUARE + TOP + BOTTOM)
    of_one = "; one row" if len(found.original.rows) > 1 else ""
    what = f"End of the shaking force's arrow; numbers: crank angle, deg{of_one}"
    heading(figure, found.original.title, what, LEFT)
    axes = place(figure, LEFT, BOTTOM, SQUARE, SQUARE)
    square(np.concatenate([*ends.values()])).settle(axes)
    axes.set_aspect("equal")
    axes.set_xlabel(f"shaking force along x, {unit.name}")
    axes.set_ylabel(f"shaking force along y, {unit.name}")
    for line in (axes.axhline, axes.axvline):
        line(0, color=FAINT, linewidth=0.8, zorder=1)
    _hodographs(axes, angles, ends)
    legend(figure, keys())
    return figure


def square(places: Array) -> Panel:
    """A square around places and the origin."""
    held = np.append(places, 0)
    low = complex(np.min(held.real), np.min(held.imag))
    high = complex(np.max(held.real), np.max(held.imag))
    side = max((high - low).real, (high - low).imag) * (1 + 2 * MARGIN) or 1.0
    middle, half = (low + high) / 2, side / 2
    return Panel(
        middle.real - half,
        middle.real + half,
        middle.imag - half,
        middle.imag + half,
        side / SQUARE,
    )


def _hodographs(axes: Axes, angles: Array, ends: Pair) -> None:
    labels = Labels(axes)
    for when, values in ends.items():
        closed = np.append(values, values[0])
        axes.plot(closed.real, closed.imag, label=when, **LOOKS[when])
        labels.avoid(closed.real, closed.imag)
    at = _told_angles(angles)
    for when in ("after", "before"):
        if np.any(ends[when]):
            _numbers(axes, labels, at, ends[when], LOOKS[when]["color"])
        apart = np.abs(ends["before"] - ends["after"])
        at = {angle: k for angle, k in at.items() if apart[k] > ALIKE * np.ptp(axes.get_xlim())}


def _told_angles(angles: Array) -> dict[int, int]:
    """A few crank angles (deg), and which of `angles` (rad) each is."""
    turns = round(float(angles[-1] + angles[1] - angles[0]) / (2 * np.pi))
    step = QUARTERS if turns < FEW_TURNS else angle_step(turns)
    each = len(angles) / (360 * turns)
    return {angle: round(angle * each) for angle in range(0, 360 * turns, step)}


def _numbers(axes: Axes, labels: Labels, told: dict[int, int], values: Array, color: str) -> None:
    """Dots at crank angles, with their numbers; of several at one place the first."""
    near = ALIKE * float(np.ptp(axes.get_xlim()))
    apart: dict[int, int] = {}
    for angle, k in told.items():
        if all(abs(values[k] - values[other]) > near for other in apart.values()):
            apart[angle] = k
    at = [*apart.values()]
    axes.plot(values[at].real, values[at].imag, "o", color=color, markersize=3.5, zorder=4)
    for k in at:
        labels.reserve(values[k].real, values[k].imag, half=2.0)
    middle = complex(np.mean(values))
    for angle, k in apart.items():
        away = float(np.degrees(np.angle(values[k] - middle)))
        look: Any = {"color": color, "fontsize": SMALL, "near": 5.0, "optional": True}
        labels.put(f"{angle}", values[k].real, values[k].imag, wish=away, **look)
