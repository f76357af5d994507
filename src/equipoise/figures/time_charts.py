"""Charts against time: of a run, with its support, and of a machine from rest."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from math import pi
from typing import TYPE_CHECKING, Any, Final, Literal

import numpy as np

from equipoise.figures.chart_parts import groups, read_axis, varies
from equipoise.figures.style import short
from equipoise.i18n import say, to_say
from equipoise.results.charts import Axis, Chart, Curve, Panel, four_digits
from equipoise.running.blocks import drives_verdict, verdict
from equipoise.vibration.response import members_of

if TYPE_CHECKING:
    from equipoise.quantities import Dimension
    from equipoise.running.run_results import DrivesRun, Run
    from equipoise.signals import Array
    from equipoise.vibration.free import Transient
    from equipoise.vibration.support_motion import SupportMotion


ROOM = 0.08
"""Share of what is drawn that stays free above and below."""
MOST_PANELS = 6
"""Of gauges or mounts in one picture."""
EFFORTS: Final[Mapping[Literal["torque", "force"], str]] = {
    "torque": to_say("torque of the drives"),
    "force": to_say("force of the drives"),
}
LABELS = {
    ("displacement", False): to_say("moved"),
    ("displacement", True): to_say("turned"),
    ("force", False): to_say("force"),
    ("force", True): to_say("torque"),
}
SUPPORT = {
    "gauges": (
        to_say("Displacement at the gauges"),
        "displacement",
        to_say("Displacement at the gauges over the time of the run."),
    ),
    "mounts": (
        to_say("Force in the mounts on the support"),
        "force",
        to_say("Forces in the mounts over the time of the run."),
    ),
}
"""What is read of a support -> title, quantity, and caption of its charts."""


# -- a run -----------------------------------------------------------------------------------------


def run_charts(run: Run) -> dict[str, Chart]:
    """``speed``, with the drive's torque below it where there is any."""
    if not run.time[-1] > 0:
        return {}
    time, speed, torque = run.time, run.crank_speed, run.drive_torque
    panels = [_panel(time, say("crank speed"), "angular speed", _thin(time, speed), "rpm")]
    if varies(torque):
        panels.append(_panel(time, say("drive torque"), "torque", _thin(time, torque)))
    return {"speed": _chart(run, verdict(run), panels)}


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
        panels.append(_panel(time, say("speed of the drives"), "angular speed", speeds, "rpm"))
    for effort, label in EFFORTS.items():
        curves = [
            Curve(time, item.effort, link, f"several {number}")
            for number, (link, item) in each
            if item.effort_in == effort and varies(item.effort)
        ]
        if curves:
            panels.append(_panel(time, say(label), effort, curves))
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
    time: Array, label: str, dimension: Dimension, curves: Sequence[Curve], unit: str | None = None
) -> Panel:
    """Signals of one quantity; `unit` as of `Axis.of`, which else suits them."""
    values = np.concatenate([curve.y for curve in curves])
    y = Axis.of(label, dimension, () if unit else values, unit, room=ROOM)
    return _over_time(time, y, curves)


def _over_time(time: Array, y: Axis, curves: Sequence[Curve], **rest: Any) -> Panel:
    x = Axis.of(say("time"), "time", low=float(time[0]), high=float(time[-1]))
    return Panel(x, y, tuple(curves), **rest)


def _thin(time: Array, values: Array) -> list[Curve]:
    """The only curve of a panel."""
    return [Curve(time, values, "", "thin")]


# -- a support -------------------------------------------------------------------------------------


def transient_charts(transient: Transient) -> dict[str, Chart]:
    """``gauges`` and ``mounts`` where there are any, ``speed`` where the crank's speed varies."""
    charts: dict[str, Chart] = {}
    turns = abs(float(transient.crank_angle[-1] - transient.crank_angle[0])) / (2 * pi)
    below = say("from rest, {turns} turns of the crank; exact model", turns=four_digits(turns))
    if transient.support is not None:
        charts |= support_charts(transient.support, transient.time, below)
    time, speed = transient.time, transient.crank_speed
    if varies(speed):
        what = f"{say('Speed of {link}', link=short(transient.machine.drive.link))}, {below}"
        panel = _panel(time, say("crank speed"), "angular speed", _thin(time, speed), "rpm")
        charts["speed"] = Chart("speed", transient.machine.title, what, (panel,))
    return charts


def support_charts(motion: SupportMotion, time: Array, below: str) -> dict[str, Chart]:
    """``gauges`` and ``mounts`` against time (M,), s, where there are any.

    below : what stands below them, after what they show.
    """
    charts: dict[str, Chart] = {}
    machine = motion.body.machine
    for key, (what, quantity, caption) in SUPPORT.items():
        read, turning = getattr(motion, key), members_of(key)(machine)
        for suffix, names, which in groups([*read], MOST_PANELS):
            panels = tuple(
                _reading(time, name, read[name] + 0.0, (quantity, turning[name])) for name in names
            )
            text = f"{say(what)}{which}, {below}"
            own = key + suffix
            charts[own] = Chart(own, machine.title, text, panels, caption=caption)
    return charts


def _reading(time: Array, name: str, values: Array, which: tuple[str, bool]) -> Panel:
    """What a gauge or a mount reads; which : quantity, and whether it is of a rotation."""
    y = read_axis(say(LABELS[which]), *which, values, room=ROOM)
    low, high = float(np.min(values)), float(np.max(values))
    ends = say("{low} to {high}", low=y.format_value(low), high=y.quantity(high))
    return _over_time(time, y, _thin(time, values), title=f"{short(name, 40)}: {ends}")
