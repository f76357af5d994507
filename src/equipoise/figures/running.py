"""Charts of a run: speed and torque of the crank against time, and where its energy went."""

from __future__ import annotations

from typing import TYPE_CHECKING

from equipoise.figures.chart_parts import varies
from equipoise.i18n import say
from equipoise.results.charts import Axis, Chart, Curve, Panel
from equipoise.running.blocks import verdict

if TYPE_CHECKING:
    from equipoise.quantities import Dimension
    from equipoise.running.run import Run
    from equipoise.signals import Array


def run_charts(run: Run) -> dict[str, Chart]:
    """``speed``, with the drive's torque below it where there is any."""
    if not run.time[-1] > 0:
        return {}
    panels = [_panel(run, say("crank speed"), "angular speed", run.crank_speed, "rpm")]
    if varies(run.drive_torque):
        panels.append(_panel(run, say("drive torque"), "torque", run.drive_torque))
    return {"speed": Chart("speed", run.machine.title, verdict(run), tuple(panels))}


def _panel(
    run: Run, label: str, dimension: Dimension, values: Array, unit: str | None = None
) -> Panel:
    x = Axis.of(say("time"), "time", low=0.0, high=float(run.time[-1]))
    y = Axis.of(label, dimension, () if unit else values, unit, room=0.08)
    return Panel(x, y, (Curve(run.time, values, "", "thin"),))
