"""Charts of a run: speed and torque of the crank against time, and where its energy went."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Final, Literal

import numpy as np

from equipoise.figures.chart_parts import varies
from equipoise.figures.vibration import support_charts
from equipoise.i18n import say, to_say
from equipoise.results.charts import Axis, Chart, Curve, Panel, four_digits
from equipoise.running.blocks import drives_verdict, verdict

if TYPE_CHECKING:
    from equipoise.quantities import Dimension
    from equipoise.running.run_results import DrivesRun, Run
    from equipoise.signals import Array


def run_charts(run: Run) -> dict[str, Chart]:
    """``speed``, with the drive's torque below it where there is any."""
    if not run.time[-1] > 0:
        return {}
    panels = [_panel(run, say("crank speed"), "angular speed", run.crank_speed, "rpm")]
    if varies(run.drive_torque):
        panels.append(_panel(run, say("drive torque"), "torque", run.drive_torque))
    return {"speed": _chart(run, verdict(run), panels)}


EFFORTS: Final[Mapping[Literal["torque", "force"], str]] = {
    "torque": to_say("torque of the drives"),
    "force": to_say("force of the drives"),
}


def drives_charts(run: DrivesRun) -> dict[str, Chart]:
    """``speed`` of drives that turn, with torques and forces below it where there are any; on a
    support ``gauges`` and ``mounts``, too.
    """
    if not run.time[-1] > 0:
        return {}
    time, each = run.time, [*enumerate(run.drives.items(), 1)]  # a drive looks alike in both panels
    turning = [(number, link, item) for number, (link, item) in each if item.length is None]
    speeds = [Curve(time, item.speed, link, f"several {n}") for n, link, item in turning]
    panels = []
    if speeds:
        panels.append(_curves(time, say("speed of the drives"), "angular speed", speeds, "rpm"))
    for effort, label in EFFORTS.items():
        curves = [
            Curve(time, item.effort, link, f"several {number}")
            for number, (link, item) in each
            if item.effort_in == effort and varies(item.effort)
        ]
        if curves:
            panels.append(_curves(time, say(label), effort, curves))
    charts = {}
    if panels:
        charts["speed"] = _chart(run, drives_verdict(run), panels)
    if run.support is None:
        return charts
    lasting = say("run of {time} s", time=four_digits(float(time[-1])))
    return charts | support_charts(run.support, time, lasting)


def _chart(run: Run | DrivesRun, what: str, panels: Iterable[Panel]) -> Chart:
    caption = to_say("Speed and torque over the time of the run.")
    return Chart("speed", run.machine.title, what, tuple(panels), caption=caption)


def _panel(
    run: Run, label: str, dimension: Dimension, values: Array, unit: str | None = None
) -> Panel:
    return _curves(run.time, label, dimension, [Curve(run.time, values, "", "thin")], unit)


def _curves(
    time: Array, label: str, dimension: Dimension, curves: list[Curve], unit: str | None = None
) -> Panel:
    values = np.concatenate([curve.y for curve in curves])
    x = Axis.of(say("time"), "time", low=0.0, high=float(time[-1]))
    y = Axis.of(label, dimension, () if unit else values, unit, room=0.08)
    return Panel(x, y, tuple(curves))
