"""Small multiples at one speed: orders at each gauge, force in each mount."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.ticker import MaxNLocator

from equipoise.i18n import say
from equipoise.plotting.crank import Line, crank_axis, draw, mark
from equipoise.plotting.style import LINES, MAIN, PALE, SMALL, short, shown
from equipoise.plotting.vibration.panels import (
    Unit,
    continued,
    grid,
    groups,
    legend,
    log_scale,
    name_panel,
    name_x,
    name_y,
    told_speed,
)
from equipoise.plotting.vibration.signals import (
    MEAN,
    line_of,
    period_told,
    phase_label,
    sampled,
)
from equipoise.vibration.forced import usual_step
from equipoise.vibration.linear import Linear

if TYPE_CHECKING:
    from equipoise.vibration.response import GaugeSignals, MountForce, Response

Array = np.ndarray[Any, Any]

BARS, MOUNTS = 1.75, 1.6
"""Inches: height of a row of panels."""
LEAST_ORDER, MOST_BARS = 10, 60
MATTERS = 1e-4
"""Share of the largest amplitude at which the log axis ends, and above which orders are drawn."""
TOUCHES = 1e-3
"""Share of the largest force below which a one-sided mount counts as off its ground."""


def spectrum_figures(response: Response) -> Iterator[Figure]:
    """Amplitude of each order at the gauges."""
    every = list(response.gauges)
    for names in groups(every):
        what = say("Amplitude at the gauges by order") + continued(names, every)
        speed, model = told_speed(response.speed), response.model
        what += ", " + say("at {speed}; model {model}", speed=speed, model=model)
        figure, panels = grid(len(names), BARS, response.machine.title, what)
        last = max(_last_order(response.gauges[name]) for name in names)
        for axes, name in zip(panels, names, strict=True):
            name_panel(axes, short(name, 44))
            _bars(axes, response.gauges[name], last)
        name_x(figure, say("order: events in one turn of the crank"))
        yield figure


def _last_order(gauge: GaugeSignals) -> float:
    """Up to where orders matter."""
    signal = gauge.displacement
    sizes = signal.sizes[1:]
    above = np.flatnonzero(sizes > MATTERS * np.max(sizes, initial=0.0))
    count = max(int(above[-1]) + 1 if above.size else 0, LEAST_ORDER * signal.turns)
    return min(count, max(MOST_BARS, LEAST_ORDER * signal.turns)) / signal.turns


def _bars(axes: Axes, gauge: GaugeSignals, last: float) -> None:
    signal = gauge.displacement
    orders, sizes = signal.orders[1:], signal.sizes[1:]
    unit = Unit.of("displacement", gauge.rotation, sizes)
    sizes = unit.factor * sizes[orders <= last]
    largest = float(np.max(sizes, initial=0.0))
    axes.set_xlim(0, last + 1)
    axes.xaxis.set_major_locator(MaxNLocator(integer=True))
    axes.grid(visible=False, axis="x")
    name_y(axes, say("amplitude, {unit}", unit=unit.name))
    if not largest:
        axes.set_yticks([])
        axes.text(
            0.5, 0.5, say("does not move"), transform=axes.transAxes, ha="center", va="center"
        )
        return
    log_scale(axes, largest * MATTERS, largest * 6)
    heard = sizes > largest * MATTERS
    at = orders[: len(sizes)]
    axes.bar(at[heard], sizes[heard], 0.62 / signal.turns, color=MAIN, linewidth=0, zorder=3)
    loudest = int(np.argmax(sizes))
    axes.annotate(
        shown(largest),
        (float(at[loudest]), largest),
        xytext=(0, 2),
        textcoords="offset points",
        ha="left" if at[loudest] < 0.06 * (last + 1) else "center",
        fontsize=SMALL,
        color=MAIN,
    )


def mounts_figures(response: Response) -> Iterator[Figure]:
    """Force in each mount over a period, beside what it carries at rest."""
    every = list(response.mounts)
    at_rest = _at_rest(response) if every else {}
    for names in groups(every):
        what = say("Force in the mounts on the support") + continued(names, every)
        title = response.machine.title
        figure, panels = grid(len(names), MOUNTS, title, f"{what}, {period_told(response)}", True)
        lifted = False
        for axes, name in zip(panels, names, strict=True):
            crank_axis(axes, response.turns, most=8)
            lifted |= _mount(axes, response, name, at_rest[name])
        handles: list[Any] = [
            Line2D([], [], color=MAIN, label=say("force")),
            Line2D([], [], color=LINES, linewidth=0.9, linestyle=MEAN, label=say("at rest")),
        ]
        if lifted:
            handles.append(Patch(color=PALE, linewidth=0, label=say("off its ground")))
        legend(figure, handles)
        name_x(figure, phase_label(response))
        yield figure


def _at_rest(response: Response) -> dict[str, float]:
    """What each mount carries at rest, N or N m; 0 where it does not touch."""
    machine = response.machine
    rest = Linear.of(machine, usual_step(machine, response.model)).rest
    assert machine.support is not None
    return {
        name: rest.preload[name] if rest.carries(name, mount) else 0.0
        for name, mount in machine.support.mounts.items()
    }


def _mount(axes: Axes, response: Response, name: str, rest: float) -> bool:
    """One mount; whether it lifts off."""
    mount = response.mounts[name]
    assert response.machine.support is not None
    model = response.machine.support.mounts[name]
    rotation = model.axis is not None
    unit = Unit.of("force", rotation, [*(mount.force.extreme(s)[0] for s in (1, -1)), rest])
    line = line_of(mount.force, unit.factor)
    lifted = model.one_sided and bool(off := _off(mount))
    if lifted and response.model == "exact":  # the sum of its orders swings about 0
        line = replace(line, values=np.maximum(line.values, 0.0), marked=line.marked[:1])
    draw(axes, [line, Line(line.theta[[0, -1]], np.full(2, unit.factor * rest), "", LINES, MEAN)])
    axes.get_lines()[1].set_linewidth(0.9)
    name_y(axes, f"{say('torque') if rotation else say('force')}, {unit.name}")
    title = short(name, 44)
    if lifted:
        for low, high in off:
            axes.axvspan(np.degrees(low), np.degrees(high), color=PALE, linewidth=0, zorder=0)
        title = f"{short(name, 20)}: {_told_off(response, mount, off)}"
    name_panel(axes, title)
    mark(axes, [line], [], angles=False)
    return lifted


def _off(mount: MountForce) -> list[tuple[float, float]]:
    """Crank angles (rad) between which a one-sided mount does not push."""
    theta, values = sampled(mount.force)
    off = values <= TOUCHES * max(float(np.max(values)), 0.0)
    edges = np.flatnonzero(np.diff(np.concatenate([[False], off, [False]]).astype(int)))
    return [
        (float(theta[start]), float(theta[min(stop, len(theta)) - 1]))
        for start, stop in edges.reshape(-1, 2)
    ]


def _told_off(response: Response, mount: MountForce, off: list[tuple[float, float]]) -> str:
    """For how long it is off its ground, in words."""
    share = sum(high - low for low, high in off) / mount.force.period
    if not np.any(mount.force.sizes):
        return say("does not touch")
    if response.model == "exact":
        return say("off its ground for {share} %", share=f"{100 * mount.lifts_off:.0f}")
    return say("would have to pull for {share} %", share=f"{100 * share:.0f}")
