"""Pictures of the way from rest against time."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from equipoise.mechanism.support import AXES
from equipoise.plotting.style import MAIN, short, shown
from equipoise.plotting.vibration.panels import (
    RPM,
    Unit,
    continued,
    groups,
    name_panel,
    name_x,
    name_y,
    stack,
    zero_line,
)

if TYPE_CHECKING:
    from equipoise.vibration.transient import Transient

Array = np.ndarray[Any, Any]

ROW, TITLE, MOST = 1.15, 0.2, 6
"""Inches: height of a panel and of its title; panels in a picture."""
LABELS = {
    ("displacement", False): "moved",
    ("displacement", True): "turned",
    ("force", False): "force",
    ("force", True): "torque",
}
VARIES = 1e-9
"""Share of the crank's speed below which its change is rounding."""


def transient_figures(transient: Transient) -> dict[str, Iterator[Figure]]:
    """``gauges``, ``mounts`` and ``speed``, those that there are."""
    found: dict[str, Iterator[Figure]] = {}
    support = transient.machine.support
    if support is not None:
        gauges = transient.gauges
        # Without gauges in the model, the free coordinates are read.
        own = {name: support.gauges[name].axis if support.gauges else name for name in gauges}
        turning = {name: axis in AXES for name, axis in own.items()}
        what = "Displacement at the gauges"
        found["gauges"] = _figures(transient, what, "displacement", gauges, turning)
        turning = {name: mount.axis is not None for name, mount in support.mounts.items()}
        what = "Force in the mounts on the support"
        found["mounts"] = _figures(transient, what, "force", transient.mounts, turning)
    speed = transient.crank_speed
    if float(np.ptp(speed)) > VARIES * float(np.max(np.abs(speed))):
        found["speed"] = iter([_speed_figure(transient)])
    return found


def _figures(
    transient: Transient,
    what: str,
    quantity: str,
    read: Mapping[str, Array],
    turning: Mapping[str, bool],
) -> Iterator[Figure]:
    """Signals below each other against time."""
    every = list(read)
    for names in groups(every, MOST):
        whole = f"{what}{continued(names, every)}, {_told(transient)}"
        figure, panels = stack(len(names), ROW, transient.machine.title, whole, TITLE)
        for axes, name in zip(panels, names, strict=True):
            unit = Unit.of(quantity, turning[name], read[name])
            values = unit.factor * read[name] + 0.0
            label = LABELS[quantity, turning[name]]
            name_y(axes, f"{label}, {unit.name}")
            ends = f"{shown(float(np.min(values)))} to {shown(float(np.max(values)))} {unit.name}"
            name_panel(axes, f"{short(name, 40)}: {ends}", room=0.6)
            _draw(axes, transient, values)
        name_x(figure, "time, s")
        yield figure


def _speed_figure(transient: Transient) -> Figure:
    drive = short(transient.machine.drive.link)
    what = f"Speed of {drive}, {_told(transient)}"
    figure, (axes,) = stack(1, 2.4, transient.machine.title, what)
    name_y(axes, "crank speed, rpm")
    _draw(axes, transient, RPM * transient.crank_speed)
    name_x(figure, "time, s")
    return figure


def _told(transient: Transient) -> str:
    turns = abs(float(transient.crank_angle[-1] - transient.crank_angle[0])) / (2 * np.pi)
    return f"from rest, {shown(turns)} turns of the crank; model exact"


def _draw(axes: Axes, transient: Transient, values: Array) -> None:
    axes.set_xlim(float(transient.time[0]), float(transient.time[-1]))
    axes.plot(transient.time, values, color=MAIN, linewidth=1.0, zorder=3)
    low, high = float(np.min(values)), float(np.max(values))
    if high - low <= VARIES * max(abs(low), abs(high)):
        half = max(abs(low), abs(high)) / 2 or 1.0
        low, high = low - half, high + half
    margin = 0.08 * (high - low)
    axes.set_ylim(low - margin, high + margin)
    zero_line(axes)
