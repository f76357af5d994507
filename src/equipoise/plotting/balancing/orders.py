"""How large each order of what was made small is, before and after."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from equipoise.balancing.effects import SCALARS, VECTORS, Effects
from equipoise.balancing.row_outputs import Rows
from equipoise.mechanism.balance_outputs import JOINTS, OF_ROWS, output_of
from equipoise.plotting.balancing.looks import LOOKS
from equipoise.plotting.style import FAINT, LINES, MAIN, SMALL, short
from equipoise.plotting.vibration.panels import (
    Unit,
    continued,
    groups,
    legend,
    name_panel,
    name_x,
    name_y,
    stack,
    told_speed,
)
from equipoise.signals import Periodic

if TYPE_CHECKING:
    from equipoise.balancing.balanced import Balanced
    from equipoise.mechanism.balance import Objective
    from equipoise.mechanism.model import Machine

Array = np.ndarray[Any, Any]
Read = dict[str, tuple[Array, Array]]
"""``before`` and ``after`` -> orders, and the size of each in SI units."""

HIGH, ONE, TITLES = 1.35, 2.4, 0.34
"""Inches: height of one of several panels, and of a single one; room for legend and title."""
MOST_PANELS = 4
MATTERS = 0.01
"""Over the largest amplitude: above this an order is drawn."""
LEAST, MOST = 4, 12
"""Orders that are drawn at least, and at most."""
TOLD = 8
"""Places on the axis up to which every bar has its number."""
VISIBLE = 0.004
"""Over the largest amplitude: below this a bar cannot be seen, and gets no number."""
WIDE = 0.36
"""Width of a bar, over the distance of orders."""
FILLS = {"before": FAINT, "after": MAIN}
INKS = {"before": LINES, "after": MAIN}


def orders_figures(found: Balanced) -> Iterator[Figure]:
    """Bars of the orders of each objective that is a force, moment or torque."""
    drawn = {one.name: one for one in found.plan.objectives if _is_drawn(found, one)}
    every = list(drawn)
    for names in groups(every, MOST_PANELS):
        what = "Amplitude of each order" + continued(names, every)
        what += " of all rows" if found.phasing is not None else ""
        what += f", before and after, at {told_speed(found.original.drive.speed)}"
        high = ONE if len(names) == 1 else HIGH
        figure, panels = stack(len(names), high, found.original.title, what, TITLES)
        read = {name: _read(found, drawn[name]) for name in names}
        last = max(_last_order(one) for one in read.values())
        for axes, name in zip(panels, names, strict=True):
            rotation = output_of(drawn[name].output, found.original).quantity == "torque"
            name_panel(axes, short(name, 80))
            _bars(axes, read[name], rotation, last)
        name_x(figure, "order: events in one turn of the crank")
        legend(figure, [Patch(color=FILLS[when], linewidth=0, label=when) for when in LOOKS])
        yield figure


def _is_drawn(found: Balanced, objective: Objective) -> bool:
    """Whether it is a force, moment or torque; a twist comes from rows together."""
    output = objective.output
    if output in OF_ROWS:
        return found.phasing is not None
    name = output.removesuffix(".x").removesuffix(".y")
    return name in (*VECTORS, *SCALARS) or name.startswith(JOINTS)


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


def _bars(axes: Axes, read: Read, rotation: bool, last: int) -> None:
    """Two bars side by side for each order."""
    unit = Unit.of("force", rotation, np.concatenate([sizes for _, sizes in read.values()]))
    largest = unit.factor * max(float(np.max(sizes)) for _, sizes in read.values())
    finest = _finest(read, VISIBLE * largest / unit.factor)
    for side, (when, (orders, sizes)) in zip((-0.5, 0.5), read.items(), strict=True):
        seen = (orders <= last) & np.isclose(np.mod(orders / finest + 0.5, 1), 0.5)
        at = orders[seen] + side * WIDE * finest
        heights = unit.factor * sizes[seen]
        axes.bar(at, heights, WIDE * finest, color=FILLS[when], linewidth=0, zorder=3, label=when)
        if last / finest <= TOLD:
            _numbers(axes, at, heights, largest, INKS[when])
    axes.set_xlim(-0.7 * finest, last + 0.7 * finest)
    axes.set_ylim(0, 1.18 * largest or 1.0)
    ticks = np.arange(last + 1)
    axes.set_xticks(ticks, ["mean", *(f"{order:g}" for order in ticks[1:])])
    axes.grid(visible=False, axis="x")
    name_y(axes, f"amplitude, {unit.name}")


def _finest(read: Read, least: float) -> float:
    """Distance of orders: less than 1 where a period of several turns leaves any between."""
    for orders, sizes in read.values():
        if np.any(sizes[np.mod(orders, 1) > 0] > least):
            return float(orders[1])
    return 1.0


def _last_order(read: Read) -> int:
    """Up to where orders matter, a whole number."""
    largest = max(float(np.max(sizes)) for _, sizes in read.values())
    last = max(
        float(np.max(orders[sizes > MATTERS * largest], initial=0.0))
        for orders, sizes in read.values()
    )
    return int(min(max(np.ceil(last), LEAST), MOST))


def _numbers(axes: Axes, at: Array, heights: Array, largest: float, color: str) -> None:
    """Heights of bars that can be seen, above them, with three digits of the largest."""
    decimals = max(0, 2 - int(np.floor(np.log10(largest)))) if largest else 0
    for x, height in zip(at, heights, strict=True):
        if height > VISIBLE * largest:
            text, place = f"{height:.{decimals}f}", (float(x), float(height))
            look: Any = {"fontsize": SMALL, "color": color, "ha": "center"}
            axes.annotate(text, place, xytext=(0, 2), textcoords="offset points", **look)
