"""Pictures of one speed against crank angle: a gauge, and the drive."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from equipoise.i18n import say, to_say
from equipoise.plotting.crank import Line, crank_axis, draw, mark
from equipoise.plotting.style import LINES, SMALL, short, shown
from equipoise.plotting.vibration.panels import (
    RPM,
    Unit,
    by_phase,
    name_x,
    name_y,
    stack,
    told_speed,
)

if TYPE_CHECKING:
    from equipoise.signals import Periodic
    from equipoise.vibration.response import Response

Array = np.ndarray[Any, Any]

QUANTITIES = {
    "displacement": to_say("displacement"),
    "velocity": to_say("velocity"),
    "acceleration": to_say("acceleration"),
}
SAMPLES = 720
"""In a turn."""
ROW = 1.6
"""Inches: height of a panel."""
MEAN = (0, (5, 2))
"""Dashes of the mean."""
VARIES = 1e-9
"""Share of a signal below which what varies is rounding."""


def sampled(signal: Periodic, factor: float = 1.0) -> tuple[Array, Array]:
    """Crank angles (rad) and values of a whole period, with its first value again at its end."""
    count = SAMPLES * signal.turns
    values = factor * signal.samples(count)
    return np.linspace(0.0, signal.period, count + 1), np.append(values, values[0])


def line_of(signal: Periodic, factor: float) -> Line:
    """A signal over a period, with its largest and smallest value marked."""
    theta, values = sampled(signal, factor)
    marked = []
    for sign in (1, -1):
        value, at = signal.extreme(sign)
        marked.append((float(at), factor * float(value)))
    if float(np.ptp(values)) <= VARIES * float(np.max(np.abs(values))):
        return Line(theta, np.full_like(values, factor * float(signal.mean)))
    return Line(theta, values, marked=marked)


def phase_label(response: Response) -> str:
    """What that axis is."""
    drive = response.machine.drive.link
    return by_phase(drive, response.speed, response.drive.speed is not None)


def period_told(response: Response) -> str:
    """Length of a period, speed and model in words."""
    told = {"speed": told_speed(response.speed), "model": response.model}
    if response.turns == 1:
        return say("over one turn at {speed}; model {model}", **told)
    return say("over {turns} turns at {speed}; model {model}", turns=response.turns, **told)


def gauge_figure(response: Response, name: str) -> Figure:
    """Displacement, velocity and acceleration at a gauge."""
    gauge = response.gauges[name]
    signals = {
        "displacement": gauge.displacement,
        "velocity": gauge.velocity,
        "acceleration": gauge.acceleration,
    }
    at = short(name)
    what = (
        say("Rotation at {gauge}", gauge=at)
        if gauge.rotation
        else say("Motion at {gauge}", gauge=at)
    )
    what += f", {period_told(response)}"
    figure, panels = stack(len(signals), ROW, response.machine.title, what)
    for axes, (quantity, signal) in zip(panels, signals.items(), strict=True):
        unit = Unit.of(quantity, gauge.rotation, [signal.extreme(sign)[0] for sign in (1, -1)])
        turned = gauge.rotation and quantity == "displacement"
        label = say("rotation") if turned else say(QUANTITIES[quantity])
        crank_axis(axes, response.turns)
        signal_panel(axes, signal, unit.factor, f"{label}, {unit.name}")
    name_x(figure, phase_label(response))
    return figure


def drive_figure(response: Response) -> Figure:
    """Torque of the drive and, where it varies, speed of the crank."""
    drive = response.drive
    what = say("Drive of {link}", link=short(response.machine.drive.link))
    rows = len(response.machine.rows)
    what += ", " + say("{rows} rows together", rows=rows) if rows > 1 else ""
    what += f", {period_told(response)}"
    count = 1 if drive.speed is None else 2
    figure, panels = stack(count, ROW + 0.6, response.machine.title, what)
    unit = Unit.of("force", True, [drive.torque.extreme(sign)[0] for sign in (1, -1)])
    crank_axis(panels[0], response.turns)
    signal_panel(
        panels[0],
        drive.torque,
        unit.factor,
        say("drive torque, {unit}", unit=unit.name),
        mean=unit.name,
    )
    if drive.speed is not None:
        crank_axis(panels[1], response.turns)
        signal_panel(panels[1], drive.speed, RPM, say("crank speed, rpm"), mean="rpm")
        panels[1].set_title(
            say("varies by {share} % of its mean", share=shown(100 * drive.fluctuation)),
            fontsize=SMALL,
            loc="left",
            pad=3,
            color=LINES,
        )
    name_x(figure, phase_label(response))
    return figure


def signal_panel(axes: Axes, signal: Periodic, factor: float, label: str, mean: str = "") -> None:
    """One signal over a period; `mean`, the unit, draws its mean value too."""
    line = line_of(signal, factor)
    name_y(axes, label)
    draw(axes, [line])
    if mean and line.varies:
        average = factor * float(signal.mean)
        if abs(average) <= VARIES * float(np.ptp(line.values)):
            average = 0.0
        axes.axhline(average, color=LINES, linewidth=0.9, linestyle=MEAN, zorder=2)
        text = say("dashed: mean {value} {unit}", value=shown(average), unit=mean)
        axes.set_title(text, fontsize=SMALL, loc="right", pad=3, color=LINES)
    mark(axes, [line], [])
