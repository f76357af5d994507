"""Acceleration of the hands against speed, with what is allowed: Fig. 7 of Nagamine and Irie."""

from __future__ import annotations

from collections.abc import Mapping
from math import pi
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from equipoise.exposure.daily import ACTION, EIGHT_HOURS, LIMIT
from equipoise.exposure.weighting import factor
from equipoise.figures.labels import Labels
from equipoise.i18n import say, to_say
from equipoise.plotting.style import INK, PALE, blank, heading, short, shown
from equipoise.plotting.tool.speeds import (
    SPEED,
    Speeds,
    avoid_curves,
    curve_limits,
    engine_axis,
    name_work,
    tell_peaks,
    work_line,
)
from equipoise.plotting.vibration.curves import (
    KINDS,
    LINE,
    draw_curves,
    legend_at,
    ordered,
    rows_of,
)
from equipoise.plotting.vibration.panels import (
    FOOT,
    LEFT,
    RIGHT,
    RPM,
    WIDTH,
    name_x,
    name_y,
    place,
)

if TYPE_CHECKING:
    from equipoise.handheld.exposed import ToolExposure

Array = np.ndarray[Any, Any]

TOP, TALL = 0.58, 3.4
"""Inches: heading, and height of the panel."""
LEVELS = (
    (ACTION, to_say("action: A(8) of"), (0, (1, 2.4)), 1.2),
    (LIMIT, to_say("limit: A(8) of"), (0, (1, 1)), 1.6),
)
"""m/s2 of A(8), name, dots and width of each level."""


def acceleration_figure(exposure: ToolExposure) -> Figure:
    """RMS acceleration of each hand, both planes together, with what is allowed of it."""
    read = {
        name: np.sqrt(np.sum(grip.acceleration**2, axis=0)) for name, grip in exposure.grips.items()
    }
    weight = factor(exposure.speed / (2 * pi))
    allowed = {name: level / weight for name, level in levels(exposure).items()}
    what = say(
        "Acceleration, not weighted; dotted: action and limit value if all of it is of order 1"
    )
    return _figure(
        exposure, read, allowed, f"{what}, {_hours(exposure)}", say("RMS, {unit}", unit="m/s²")
    )


def exposure_figure(exposure: ToolExposure) -> Figure:
    """Weighted total value of each hand, with action and limit value for the time of work."""
    read = {name: grip.a_hv for name, grip in exposure.grips.items()}
    allowed = {name: np.full(len(exposure.speed), one) for name, one in levels(exposure).items()}
    what = f"{say('Weighted acceleration; dotted: action and limit value')}, {_hours(exposure)}"
    if exposure.worst is not None and exposure.a8 is not None:
        told = {"a8": shown(exposure.a8), "hand": short(exposure.worst)}
        what += "; " + say("A(8) = {a8} m/s² at {hand}", **told)
    return _figure(exposure, read, allowed, what, "a_hv, m/s²")


def duration_of(exposure: ToolExposure) -> float:
    """Time of work a day, s; eight hours where it is not told."""
    return next((day.duration for day in exposure.days.values()), EIGHT_HOURS)


def levels(exposure: ToolExposure) -> dict[str, float]:
    """Steady total value, m/s2, at which A(8) is the action or the limit value."""
    share = float(np.sqrt(EIGHT_HOURS / duration_of(exposure)))
    return {name: level * share for level, name, _, _ in LEVELS}


def _hours(exposure: ToolExposure) -> str:
    return say("{hours} h a day", hours=shown(duration_of(exposure) / 3600))


def _figure(
    exposure: ToolExposure,
    read: Mapping[str, Array],
    allowed: Mapping[str, Array],
    what: str,
    label: str,
) -> Figure:
    tool, speed = exposure.response.tool, exposure.speed
    curves = ordered(read)
    keys = _keys()
    above = TOP + LINE * (rows_of(curves[: len(KINDS) + 1]) + rows_of(keys)) + 0.06
    figure = blank(WIDTH, above + TALL + FOOT)
    heading(figure, tool.title, what, LEFT)
    axes = place(figure, LEFT, FOOT, WIDTH - LEFT - RIGHT, TALL)
    engine_axis(axes, speed)
    name_y(axes, label)
    name_x(figure, say(SPEED))
    curve_limits(axes, curves, (1.8, 2.2), [float(np.min(row)) for row in allowed.values()])
    _levels(axes, speed, allowed)
    work = work_line(axes, tool)
    handles = draw_curves(axes, Speeds(speed), curves)
    legend_at(figure, handles, TOP - 0.06)
    legend_at(figure, keys, TOP - 0.06 + LINE * rows_of(handles))
    labels = Labels(axes)
    avoid_curves(labels, speed, curves)
    for row in allowed.values():
        labels.avoid(speed * RPM, row)
    named = zip(curves, (color for color, _ in KINDS), strict=False)
    tell_peaks(labels, tool, speed, list(named))
    name_work(axes, labels, work, above=False)
    return figure


def _keys() -> list[Line2D]:
    """What the dotted lines are."""
    return [
        Line2D([], [], label=f"{say(name)} {level:g} m/s²", **_dotted(dots, width))
        for level, name, dots, width in LEVELS
    ]


def _dotted(dots: Any, width: float) -> dict[str, Any]:
    return {"color": INK, "linestyle": dots, "linewidth": width}


def _levels(axes: Axes, speed: Array, allowed: Mapping[str, Array]) -> None:
    """Dotted lines, and a shade above what must not be."""
    x, top = speed * RPM, axes.get_ylim()[1]
    axes.fill_between(
        x, allowed["limit: A(8) of"], top, color=PALE, alpha=0.55, linewidth=0, zorder=0
    )
    for _, name, dots, width in LEVELS:
        axes.plot(x, allowed[name], zorder=2.2, **_dotted(dots, width))
