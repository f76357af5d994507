"""How large each order of what was made small is, before and after."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from equipoise.balancing.effects import Effects
from equipoise.balancing.multi_row import Rows
from equipoise.i18n import say
from equipoise.mechanism.objectives import GAUGES, JOINTS, OF_ROWS, output_of
from equipoise.plotting.balancing.looks import LOOKS, WHEN
from equipoise.plotting.bars import Read, bars, last_order
from equipoise.plotting.style import FAINT, LINES, MAIN
from equipoise.plotting.vibration.panels import (
    continued,
    groups,
    legend,
    name_panel,
    name_x,
    stack,
    told_speed,
)
from equipoise.results.naming import objective_named
from equipoise.signals import Periodic

if TYPE_CHECKING:
    from equipoise.balancing.balanced import Balanced
    from equipoise.mechanism.balance import Objective
    from equipoise.mechanism.model import Machine

Array = np.ndarray[Any, Any]

HIGH, ONE, TITLES = 1.35, 2.4, 0.34
"""Inches: height of one of several panels, and of a single one; room for legend and title."""
MOST_PANELS = 4
COLORS = {"before": (FAINT, LINES), "after": (MAIN, MAIN)}
"""Of bars and of their numbers."""


def orders_figures(found: Balanced) -> Iterator[Figure]:
    """Bars of the orders of each objective that is a force, moment or torque."""
    drawn = {one.name: one for one in found.plan.objectives if _is_drawn(found, one)}
    every = list(drawn)
    for names in groups(every, MOST_PANELS):
        what = say("Amplitude of each order") + continued(names, every)
        if len(found.original.rows) > 1:
            what += ", " + (say("all rows") if found.phasing is not None else say("of one row"))
        speed = told_speed(found.original.drive.speed)
        what += ", " + say("before and after, at {speed}", speed=speed)
        high = ONE if len(names) == 1 else HIGH
        figure, panels = stack(len(names), high, found.original.title, what, TITLES)
        read = {name: _read(found, drawn[name]) for name in names}
        last = max(last_order(one) for one in read.values())
        for axes, name in zip(panels, names, strict=True):
            rotation = output_of(drawn[name].output, found.original).dimension == "torque"
            name_panel(axes, _named(found, drawn[name]))
            bars(axes, read[name], COLORS, rotation, last)
        name_x(figure, say("order: events in one turn of the crank"))
        legend(
            figure,
            [Patch(color=COLORS[when][0], linewidth=0, label=say(WHEN[when])) for when in LOOKS],
        )
        yield figure


def _named(found: Balanced, one: Objective) -> str:
    """An objective in words; of a vector the bars are of both components."""
    count = len(found.original.rows) if found.phasing is not None else 1
    told = objective_named(one, count)
    if output_of(one.output, found.original).is_vector:
        return say("{what}: both components together", what=told)
    return told


def _is_drawn(found: Balanced, objective: Objective) -> bool:
    """Whether it is a force, moment or torque; a twist comes from rows together."""
    output = objective.output
    if output in OF_ROWS:
        return found.phasing is not None
    return not output.startswith(GAUGES)


def amplitudes(machine: Machine, objective: Objective, rows: bool = False) -> tuple[Array, Array]:
    """Orders (K + 1,) of an output, and the size (K + 1,) of each; of a vector, of both parts.

    rows : of all rows together, instead of one.
    """
    if rows and not objective.output.startswith(JOINTS):
        read = Rows(machine).signals(objective)
        total = read.total(np.array([row.phase for row in machine.rows]))[0]
        return read.orders, np.linalg.norm(np.abs(total), axis=0)
    signal = Effects(machine, ()).signal(objective.output, objective.about)
    signal = signal.kept(objective.orders)
    values = signal.start
    parts = np.array([values.real, values.imag] if np.iscomplexobj(values) else [values])
    periodic = Periodic.of(parts, signal.turns)
    return periodic.orders, np.linalg.norm(periodic.sizes, axis=0)


def _read(found: Balanced, objective: Objective) -> Read:
    rows = found.phasing is not None
    machines = {"before": found.original, "after": found.machine}
    return {when: amplitudes(one, objective, rows) for when, one in machines.items()}
