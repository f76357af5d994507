"""What pictures over the engine's speed share: the axis, its working speed, modes, log axes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.axes import Axes

from equipoise.figures.labels import Labels
from equipoise.i18n import say, to_say
from equipoise.plotting.style import FAINT, LINES, shown
from equipoise.plotting.vibration.curves import (
    DECADES,
    Curve,
    bounded,
    fine_log,
    speed_axis,
)
from equipoise.plotting.vibration.map import names_above
from equipoise.plotting.vibration.panels import RPM

if TYPE_CHECKING:
    from equipoise.handheld.model import Tool

Array = np.ndarray[Any, Any]

SPEED = to_say("speed of the engine, rpm")
ALONE = 0.1
"""Share by which the axis goes beyond a speed that stands alone."""
MOST_MODES = 24
WORK: Any = (0, (5, 2, 1, 2))
"""Dashes of the working speed."""


@dataclass(frozen=True, eq=False)
class Speeds:
    """Speeds (S,) of the engine, rad/s; a tool's vibration is stable at every one."""

    speed: Array

    @property
    def stable(self) -> Array:
        """(S,)."""
        return np.ones(len(self.speed), bool)


def engine_axis(axes: Axes, speed: Array) -> None:
    """The x axis: speeds (S,), rad/s, shown in rpm."""
    if len(speed) > 1:
        speed_axis(axes, Speeds(speed))
    else:
        alone = float(speed[0]) * RPM
        axes.set_xlim((1 - ALONE) * alone, (1 + ALONE) * alone)


def turns(speed: float) -> str:
    """A speed or frequency, rad/s, in turns a minute: four digits, and all before the point."""
    minute = speed * RPM
    return shown(minute) if minute < 1e4 else f"{minute:.0f}"


def curve_limits(
    axes: Axes, curves: Sequence[Curve], room: tuple[float, float], further: Sequence[float] = ()
) -> None:
    """A log y axis for curves and some more values, with room below and above as factors."""
    every = np.concatenate([*(bounded(curve.values) for curve in curves), further])
    heard = every[np.isfinite(every) & (every > 0)]
    high = float(np.max(heard, initial=0.0)) or 1.0
    low = max(float(np.min(heard, initial=high)), high * 10**-DECADES)
    fine_log(axes, low / room[0], high * room[1])


def work_line(axes: Axes, tool: Tool) -> float | None:
    """A line at the speed of work, rpm; None where it is not in sight."""
    if tool.operation is None:
        return None
    at, (low, high) = tool.operation.speed * RPM, axes.get_xlim()
    if not low <= at <= high:
        return None
    axes.axvline(at, color=LINES, linewidth=0.9, linestyle=WORK, zorder=1.7)
    return at


def name_work(axes: Axes, labels: Labels, at: float | None, above: bool = True) -> None:
    """The name of that line inside, near the upper or the lower end."""
    if at is None:
        return
    low, high = axes.get_ylim()
    end = 0.95 if above else 0.05
    log = axes.get_yscale() == "log"
    y = low * (high / low) ** end if log else low + (high - low) * end
    labels.put(
        say("work, {speed} rpm", speed=turns(at / RPM)), at, y, wish=0.0, near=3.0, color=LINES
    )


def mode_lines(axes: Axes, frequency: Sequence[float] | Array, named: bool) -> None:
    """Light lines where an engine's turns meet natural frequencies, rad/s; numbers above."""
    low, high = axes.get_xlim()
    inside = [
        (number, float(one) * RPM)
        for number, one in enumerate(frequency, 1)
        if low <= float(one) * RPM <= high
    ][:MOST_MODES]
    for _, at in inside:
        axes.axvline(at, color=FAINT, linewidth=0.7, linestyle=(0, (1.5, 2)), zorder=1.5)
    if named:
        names_above(axes, [(at, str(number)) for number, at in inside], say("mode"))


def avoid_curves(labels: Labels, speed: Array, curves: Sequence[Curve]) -> None:
    """Keep texts away from curves against speeds, rad/s."""
    low = labels.axes.get_ylim()[0]
    for curve in curves:
        heard = np.isfinite(curve.values) & (curve.values > low)
        if np.any(heard):
            labels.avoid(speed[heard] * RPM, curve.values[heard])


def tell_peaks(
    labels: Labels, tool: Tool, speed: Array, curves: Sequence[tuple[Curve, str]]
) -> None:
    """Acceleration and speed at the highest place of curves, each with its colour.

    Where nothing takes power there is no highest place.
    """
    if not tool.damped and not any(one.hand and one.hand.impedance for one in tool.stations):
        return
    for curve, color in curves:
        k = int(np.nanargmax(curve.values))
        size = float(curve.values[k])
        if 0 < k < len(speed) - 1 and 0 < size <= labels.axes.get_ylim()[1]:
            told = {"value": f"{shown(size)} m/s²", "speed": turns(float(speed[k]))}
            text = say("{value} at {speed} rpm", **told)
            at = float(speed[k]) * RPM
            labels.put(text, at, size, wish=20.0, color=color, optional=True)
