"""The charts of a machine on its support at one speed: gauges, mounts, drive, orders."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from equipoise.figures.chart_parts import (
    ROOM,
    VARIES,
    continued,
    crank_axis,
    extremes,
    groups,
    read_axis,
    speed_text,
    varies,
)
from equipoise.figures.style import free_name, short
from equipoise.i18n import say, to_say
from equipoise.results.charts import (
    Array,
    Axis,
    Band,
    Bars,
    Chart,
    Curve,
    Line,
    Mark,
    Panel,
    four_digits,
)
from equipoise.vibration.simplified import linear_of

if TYPE_CHECKING:
    from equipoise.signals import Figures, Periodic
    from equipoise.vibration.response import GaugeSignals, MountForce, Response


QUANTITIES = {
    "displacement": to_say("displacement"),
    "velocity": to_say("velocity"),
    "acceleration": to_say("acceleration"),
}
SAMPLES, LEAST_ORDER, MOST_BARS = 720, 10, 60
"""In a turn; orders that are drawn at least, and bars at most."""
BELOW = 0.4
"""Of the least amplitude that matters: where its axis begins, so that its dot is whole."""
MATTERS, TOUCHES = 1e-4, 1e-3
"""Shares: of the largest amplitude at which the log axis ends, and above which orders are drawn; of
the largest force below which a one-sided mount counts as off its ground."""
SMALL = 78.0
"""Points: height of one of many panels."""


def response_charts(response: Response) -> dict[str, Chart]:
    """Every picture of the vibration at one speed by name, which also does for a file.

    ``gauge-NAME`` for each gauge and ``spectrum``; ``mounts`` where there are any; ``drive``.
    Many gauges or mounts go on in ``spectrum-2``, ``mounts-2`` and so on.
    """
    charts: dict[str, Chart] = {}
    for name in response.gauges:
        own = free_name(f"gauge-{name}", charts)
        charts[own] = gauge(response, name).named(own)
    charts |= {chart.name: chart for chart in (*spectra(response), *mounts(response))}
    return charts | {"drive": drive(response)}


# -- signals over a period -------------------------------------------------------------------------


def sampled(signal: Periodic) -> tuple[Array, Array]:
    """Crank angles (rad) and values of a whole period, with its first value again at its end."""
    count = SAMPLES * signal.turns
    values = signal.samples(count)
    return np.linspace(0.0, signal.period, count + 1), np.append(values, values[0])


def plotted(signal: Periodic) -> tuple[Array, Array, list[tuple[float, float]]]:
    """Angles, values (constant if they vary by no more than rounding) and extremes."""
    theta, values = sampled(signal)
    if float(np.ptp(values)) <= VARIES * float(np.max(np.abs(values))):
        return theta, np.full_like(values, float(signal.mean)), []
    both = (signal.extreme(sign) for sign in (1, -1))
    return theta, values, [(float(at), float(value)) for value, at in both]


def phase_axis(response: Response) -> Axis:
    """The x axis: the crank's angle, or time where a motor drives."""
    link, with_motor = response.machine.drive.crank, response.drive.speed is not None
    return crank_axis(link, response.speed, response.turns, with_motor)


def period_text(response: Response) -> str:
    """Length of a period in turns, crank speed and excitation model, as text."""
    values = {"speed": speed_text(response.speed), "model": response.model}
    if response.turns == 1:
        return say("over one turn at {speed}; {model} model", **values)
    return say("over {turns} turns at {speed}; {model} model", turns=response.turns, **values)


def gauge(response: Response, name: str) -> Chart:
    """Displacement, velocity and acceleration at a gauge."""
    read = response.gauges[name]
    panels = []
    for quantity, name_of in QUANTITIES.items():
        theta, values, places = plotted(getattr(read, quantity))
        label = say("rotation") if read.rotation and quantity == "displacement" else say(name_of)
        y = read_axis(label, quantity, read.rotation, values, room=ROOM)
        marks = extremes(y, values, places, "main")
        panels.append(Panel(phase_axis(response), y, (Curve(theta, values),), marks))
    what = say("Rotation at {gauge}") if read.rotation else say("Motion at {gauge}")
    what = f"{what.format(gauge=short(name))}, {period_text(response)}"
    caption = to_say("Vibration at a gauge of the support over a cycle.")
    return Chart(f"gauge-{name}", response.machine.title, what, tuple(panels), caption=caption)


def drive(response: Response) -> Chart:
    """Torque of the drive and, where it varies, speed of the crank."""
    result = response.drive
    y = read_axis(say("drive torque"), "force", True, sampled(result.torque)[1], room=ROOM)
    panels = [_with_mean(response, result.torque, result.torque_figures, y)]
    if result.speed is not None:
        title = say("varies by {share} % of its mean", share=four_digits(100 * result.fluctuation))
        y = Axis.of(say("crank speed"), "angular speed", (), "rpm", room=ROOM)
        panels.append(_with_mean(response, result.speed, result.speed.figures, y, title=title))
    what = say("Drive of {link}", link=short(response.machine.drive.link))
    rows = len(response.machine.rows)
    what += ", " + say("{rows} rows together", rows=rows) if rows > 1 else ""
    what += f", {period_text(response)}"
    caption = to_say("Torque and speed of the drive on the moving support.")
    return Chart("drive", response.machine.title, what, tuple(panels), caption=caption)


def _with_mean(
    response: Response, signal: Periodic, figures: Figures, y: Axis, **rest: Any
) -> Panel:
    """A signal over a period, marked at its extremes, with a dashed line at its mean."""
    theta, values, places = plotted(signal)
    lines: tuple[Line, ...] = ()
    if varies(values):
        mean = 0.0 if abs(figures.mean) <= VARIES * float(np.ptp(values)) else figures.mean
        places = [(figures.max_at, figures.max), (figures.min_at, figures.min)]
        lines = (Line(mean, "mean", axis="y"),)
        rest["remark"] = say("dashed: mean {value}", value=y.quantity(mean))
    marks = extremes(y, values, places, "main")
    return Panel(phase_axis(response), y, (Curve(theta, values),), marks, lines=lines, **rest)


# -- orders at the gauges --------------------------------------------------------------------------


def spectra(response: Response) -> Iterator[Chart]:
    """Amplitude of each order at the gauges."""
    every = list(response.gauges)
    for suffix, names in groups(every):
        what = say("Amplitude at the gauges by order") + continued(names, every)
        values = {"speed": speed_text(response.speed), "model": response.model}
        what += ", " + say("at {speed}; {model} model", **values)
        last = max(_last_order(response.gauges[name]) for name in names)
        panels = tuple(_bars(response.gauges[name], name, last) for name in names)
        own, columns = f"spectrum{suffix}", min(2, len(panels))
        caption = to_say("Vibration at the gauges by orders of the crank angle.")
        yield Chart(own, response.machine.title, what, panels, columns, caption=caption)


def _last_order(signals: GaugeSignals) -> float:
    """Up to where orders matter."""
    signal = signals.displacement
    sizes = signal.sizes[1:]
    above = np.flatnonzero(sizes > MATTERS * np.max(sizes, initial=0.0))
    count = max(int(above[-1]) + 1 if above.size else 0, LEAST_ORDER * signal.turns)
    return min(count, max(MOST_BARS, LEAST_ORDER * signal.turns)) / signal.turns


def _bars(signals: GaugeSignals, name: str, last: float) -> Panel:
    signal = signals.displacement
    orders, sizes = signal.orders[1:], signal.sizes[1:]
    orders, sizes = orders[orders <= last], sizes[orders <= last]
    largest = float(np.max(sizes, initial=0.0))
    ends: dict[str, Any] = {}
    if largest:
        ends = {"low": largest * MATTERS * BELOW, "high": largest * 6, "scale": "log"}
    x = Axis(say("order: events in one turn of the crank"), low=0.0, high=last + 1)
    y = read_axis(say("amplitude"), "displacement", signals.rotation, sizes, **ends)
    title = short(name, 44)
    if not largest:
        return Panel(x, y, title=title, message=say("does not move"), height=SMALL)
    significant, loudest = sizes > largest * MATTERS, int(np.argmax(sizes))
    mark = Mark(float(orders[loudest]), largest, y.format_value(largest), sign=False, distance=5.0)
    bars = Bars(orders[significant], sizes[significant], 0.62 / signal.turns)
    return Panel(x, y, marks=(mark,), bars=(bars,), title=title, height=SMALL)


# -- forces in the mounts --------------------------------------------------------------------------


def mounts(response: Response) -> Iterator[Chart]:
    """Force in each mount over a period, beside what it carries at rest."""
    every = list(response.mounts)
    at_rest = _at_rest(response) if every else {}
    largest = _largest(response, at_rest)
    for suffix, names in groups(every):
        what = say("Force in the mounts on the support") + continued(names, every)
        what = f"{what}, {period_text(response)}"
        panels = tuple(_mount(response, name, at_rest[name], largest) for name in names)
        keys, columns = (("main", say("force")), ("mean", say("at rest"))), min(2, len(panels))
        own, caption = f"mounts{suffix}", to_say("Forces in the mounts over a cycle.")
        yield Chart(own, response.machine.title, what, panels, columns, keys=keys, caption=caption)


def _at_rest(response: Response) -> dict[str, float]:
    """What each mount carries at rest, N or N m; 0 where it does not touch."""
    machine = response.machine
    rest = linear_of(machine, response.model).rest
    assert machine.support is not None
    return {
        name: rest.preload[name] if rest.carries(name, mount) else 0.0
        for name, mount in machine.support.mounts.items()
    }


def _largest(response: Response, at_rest: Mapping[str, float]) -> dict[bool, float]:
    """Of all torques (True), and of all forces, so that each of these has one unit; SI units."""
    values: dict[bool, float] = {}
    for name, mount in response.mounts.items():
        sizes = np.abs([*sampled(mount.force)[1], at_rest[name]])
        values[mount.torsional] = max(values.get(mount.torsional, 0.0), float(np.max(sizes)))
    return values


def _mount(response: Response, name: str, rest: float, largest: Mapping[bool, float]) -> Panel:
    """One mount; rest : what it carries there.  largest : by which the unit is chosen."""
    assert response.machine.support is not None
    mount, model = response.mounts[name], response.machine.support.mounts[name]
    rotation = model.axis is not None
    theta, values, places = plotted(mount.force)
    lifted = off_ground(mount) if model.one_sided else []
    if lifted and response.model == "exact":  # the sum of its orders swings about 0
        values, places = np.maximum(values, 0.0), places[:1]
    label = say("torque") if rotation else say("force")
    y = read_axis(label, "force", rotation, largest[rotation], room=ROOM)
    lift_off = f"{short(name, 20)}: {_lift_off_text(response, mount, lifted)}" if lifted else ""
    return Panel(
        phase_axis(response),
        y,
        (Curve(theta, values), Curve(theta[[0, -1]], np.full(2, rest), "", "mean")),
        extremes(y, values, places, "main"),
        tuple(Band(low, high, "off", say("off its ground")) for low, high in lifted),
        title=lift_off or short(name, 44),
        height=SMALL,
    )


def off_ground(mount: MountForce) -> list[tuple[float, float]]:
    """Crank angles (rad) between which a one-sided mount does not push."""
    theta, values = sampled(mount.force)
    off = values <= TOUCHES * max(float(np.max(values)), 0.0)
    edges = np.flatnonzero(np.diff(np.concatenate([[False], off, [False]]).astype(int)))
    return [
        (float(theta[start]), float(theta[min(stop, len(theta)) - 1]))
        for start, stop in edges.reshape(-1, 2)
    ]


def _lift_off_text(response: Response, mount: MountForce, off: list[tuple[float, float]]) -> str:
    """Share of the period for which a one-sided mount is off its ground, as text."""
    share = sum(high - low for low, high in off) / mount.force.period
    if not np.any(mount.force.sizes):
        return say("does not touch")
    if response.model == "exact":
        return say("off its ground for {share} %", share=f"{100 * mount.lifts_off:.0f}")
    return say("would have to pull for {share} %", share=f"{100 * share:.0f}")
