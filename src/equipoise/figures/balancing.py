"""The charts of balancing: before and after, orders, rows and their phases, trade-offs."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING

import numpy as np

from equipoise.balancing.effects import Effects
from equipoise.balancing.multi_row import Rows
from equipoise.balancing.problem import Problem
from equipoise.figures.analysis import rounding, settled
from equipoise.figures.changes import grams
from equipoise.figures.forces import Read, last_order, order_panel
from equipoise.figures.shared import (
    by_name,
    closed,
    compared,
    continued,
    crank_axis,
    extent,
    groups,
    numbers,
    told_angles,
    told_speed,
)
from equipoise.figures.style import short
from equipoise.i18n import say, to_say
from equipoise.mechanism.balance import Objective
from equipoise.mechanism.objectives import GAUGES, JOINTS, OF_ROWS, output_of
from equipoise.quantities import Dimension
from equipoise.results.analysis import analyze
from equipoise.results.charts import Array, Arrow, Axis, Chart, Curve, Mark, Panel, shown
from equipoise.results.outputs import objective_named, shown_in
from equipoise.signals import Periodic

if TYPE_CHECKING:
    from equipoise.balancing.balanced import Balanced
    from equipoise.balancing.pareto import Front
    from equipoise.mechanism.model import Drive, Machine

Pair = Mapping[str, Array]
"""``before`` and ``after``, or the latter alone."""

WHEN = {"before": to_say("before"), "after": to_say("after"), "unchanged": to_say("unchanged")}
SIGNALS = {
    "moment": (
        "shaking_moment",
        to_say("Shaking moment about the drive's pivot"),
        to_say("shaking moment"),
    ),
    "torque": ("drive_torque", to_say("Drive torque"), to_say("drive torque")),
}
"""Picture -> column, title, and label of the axis."""
SAMPLES, SAMPLES_OF_ROWS = 360, 720
"""Crank angles in a turn from which it is told what is rounding, and of rows together."""
NOTHING, ALIKE = 1e-9, 1e-6
"""Over the largest value before: what is left after is rounding; what differs is unchanged."""
NEAR = 0.015
"""Over the size of a hodograph: numbers after that are nearer to those before are left out."""
MOST_PANELS, IN_LINE = 4, 6
"""Panels of orders in a picture; dials side by side."""


def charts(found: Balanced) -> dict[str, Chart]:
    """Charts of a balanced machine by name, which also does for a file.

    ``force``, ``polar``, ``moment``, ``torque`` where the linkage is changed; ``orders`` where a
    force, moment or torque was made small, with ``orders-2`` and so on where there are many;
    ``phases`` and ``rows`` where phases of rows are chosen.
    """
    of_linkage = any(change.kind != "phases" for change in found.changes)
    drawn = (signals(found) if of_linkage else {}) | by_name(orders(found))
    if found.phasing is not None:
        drawn |= row_charts(found.original, found.machine)
    return drawn


def row_charts(original: Machine | None, machine: Machine) -> dict[str, Chart]:
    """``phases`` and ``rows``; phases alone do not know the machine before."""
    return by_name([phases(original, machine), together(original, machine)])


# -- before and after ------------------------------------------------------------------------------


def paired(before: Array, after: Array, least: float) -> Pair:
    """Values (N,) before and after; zeros where they are no more than `least`, which is rounding.

    After they are also zeros where they are rounding beside those before.
    """
    before = settled(before, least)
    largest = float(np.max(np.abs(before), initial=0.0))
    return {"before": before, "after": settled(after, max(least, NOTHING * largest))}


def roles_of(pair: Pair) -> dict[str, Array]:
    """What is drawn of a pair by its role: of what is alike one muted line."""
    if "before" in pair:
        largest = float(np.max(np.abs(pair["before"]), initial=0.0))
        if np.all(np.abs(pair["after"] - pair["before"]) <= ALIKE * largest):
            return {"unchanged": pair["after"]}
    return dict(pair)


def keys(*pairs: Pair) -> tuple[tuple[str, str], ...]:
    """What the lines of some pairs are, for a legend."""
    drawn = {role for pair in pairs for role in roles_of(pair)}
    return tuple((role, say(name)) for role, name in WHEN.items() if role in drawn)


def compare(drive: Drive, angles: Array, pair: Pair, label: str, dimension: Dimension) -> Panel:
    """A signal before and after over crank angles (N,), a whole cycle; extremes of both."""
    period = float(angles[-1] + angles[1] - angles[0])
    axis = crank_axis(short(drive.link, 16), drive.speed, round(period / (2 * np.pi)))
    drawn = {role: closed(angles, values, period) for role, values in roles_of(pair).items()}
    return compared(axis, label, dimension, drawn)


def signals(found: Balanced) -> dict[str, Chart]:
    """``force``, ``polar``, ``moment`` and ``torque``, before and after."""
    columns = {name: values for name, _, values in found.columns()}
    angles, drive = columns["crank_angle"], found.original.drive
    least_force, least_moment = rounding(analyze(found.original, SAMPLES))
    title, when = found.original.title, _told(found)

    def pair_of(output: str, least: float) -> Pair:
        return paired(columns[f"{output}.before"], columns[f"{output}.after"], least)

    force = {axis: pair_of(f"shaking_force.{axis}", least_force) for axis in ("x", "y")}
    panels = tuple(
        compare(drive, angles, pair, say("along {axis}", axis=axis), "force")
        for axis, pair in force.items()
    )
    what = f"{say('Shaking force')}, {when}"
    drawn = {
        "force": Chart("force", title, what, panels, keys=keys(*force.values())),
        "polar": polar(found, angles, force),
    }
    for name, (output, told, label) in SIGNALS.items():
        pair = pair_of(output, least_moment)
        panel = compare(drive, angles, pair, say(label), "torque")
        drawn[name] = Chart(name, title, f"{say(told)}, {when}", (panel,), keys=keys(pair))
    return drawn


def _told(found: Balanced) -> str:
    """What is shown of a signal, in words."""
    of_one = say("of one row") + ", " if len(found.original.rows) > 1 else ""
    speed = told_speed(found.original.drive.speed)
    return of_one + say("before and after, at {speed}", speed=speed)


def polar(found: Balanced, angles: Array, force: Mapping[str, Pair]) -> Chart:
    """The end of the shaking force's arrow over a cycle, on axes of one scale."""
    ends = {when: force["x"][when] + 1j * force["y"][when] for when in ("before", "after")}
    drawn, size = roles_of(ends), extent(*ends.values(), np.zeros(1))
    at = told_angles(angles)
    marks: list[Mark] = []
    curves = [Curve.of(np.append(one, one[0]), "", role) for role, one in drawn.items()]
    for role, values in reversed(drawn.items()):
        if np.any(values):
            marks += numbers(at, values, role, size)
        apart = np.abs(ends["before"] - ends["after"])
        at = {angle: k for angle, k in at.items() if apart[k] > NEAR * size}
    every = np.concatenate([*ends.values()])
    x, y = (Axis.of(say("shaking force along {axis}", axis=a), "force", every) for a in ("x", "y"))
    message = "" if np.any(every) else say("zero at every crank angle")
    panel = Panel(x, y, tuple(curves), tuple(marks), message=message, equal=True)
    what = f"{say('Shaking force')}, {_told(found)}; {say('numbers: crank angle, deg')}"
    return Chart("polar", found.original.title, what, (panel,), keys=keys(ends))


# -- orders ----------------------------------------------------------------------------------------


def orders(found: Balanced) -> Iterator[Chart]:
    """Bars of the orders of each objective that is a force, moment or torque."""
    with_rows = found.phasing is not None
    drawn = {
        one.name: one
        for one in found.plan.objectives
        if (with_rows if one.output in OF_ROWS else not one.output.startswith(GAUGES))
    }
    every, speed = list(drawn), told_speed(found.original.drive.speed)
    both = {"bar before": found.original, "bar after": found.machine}
    for suffix, names in groups(every, MOST_PANELS):
        what = say("Amplitude of each order") + continued(names, every)
        if len(found.original.rows) > 1:
            what += ", " + (say("all rows") if with_rows else say("of one row"))
        what += ", " + say("before and after, at {speed}", speed=speed)
        read = {
            name: {role: amplitudes(one, drawn[name], with_rows) for role, one in both.items()}
            for name in names
        }
        last = max(last_order(one) for one in read.values())
        panels = tuple(_orders_panel(found, drawn[name], read[name], last) for name in names)
        keyed = tuple((f"bar {when}", say(WHEN[when])) for when in ("before", "after"))
        yield Chart(f"orders{suffix}", found.original.title, what, panels, keys=keyed)


def _orders_panel(found: Balanced, one: Objective, read: Read, last: int) -> Panel:
    """Bars of an objective; of a vector they are of both components."""
    output = output_of(one.output, found.original)
    told = objective_named(one, len(found.original.rows) if found.phasing is not None else 1)
    if output.is_vector:
        told = say("{what}: both components together", what=told)
    return order_panel(told, output.dimension, read, last)


def amplitudes(machine: Machine, objective: Objective, rows: bool = False) -> tuple[Array, Array]:
    """Orders (K + 1,) of an output, and the size (K + 1,) of each; of a vector, of both parts.

    rows : of all rows together, instead of one.
    """
    if rows and not objective.output.startswith(JOINTS):
        read = Rows(machine).signals(objective)
        total = read.total(np.array([row.phase for row in machine.rows]))[0]
        return read.orders, np.linalg.norm(np.abs(total), axis=0)
    signal = Effects(machine, ()).signal(objective.output, objective.about).kept(objective.orders)
    values = signal.start
    parts = np.array([values.real, values.imag] if np.iscomplexobj(values) else [values])
    periodic = Periodic.of(parts, signal.turns)
    return periodic.orders, np.linalg.norm(periodic.sizes, axis=0)


# -- rows ------------------------------------------------------------------------------------------


def phases(original: Machine | None, machine: Machine) -> Chart:
    """A dial for each row in the order of their places, with a hand for its crank."""
    order = sorted(range(len(machine.rows)), key=lambda k: machine.rows[k].lateral)
    hands = {"after": machine} if original is None else {"before": original, "after": machine}
    panels = tuple(_dial(hands, machine, k) for k in order)
    what = say("Direction of {link} in each row at one instant", link=short(machine.drive.link))
    foot = say("from left to right of who looks forward, with their lateral places")
    keyed = tuple((role, say(WHEN[role])) for role in hands)
    return Chart("phases", machine.title, what, panels, columns=IN_LINE, keys=keyed, foot=foot)


def _dial(hands: Mapping[str, Machine], machine: Machine, k: int) -> Panel:
    """The crank of one row, in a circle of radius 1."""
    turn = np.exp(1j * np.radians(np.arange(0, 361, 4)))
    ticks = [np.array([0.9 * way, way]) for way in (1, 1j, -1, -1j)]
    curves = [Curve.of(line, "", "dial") for line in (turn, *ticks)]
    told = [Axis.of("", "length", [0.3]).quantity(machine.rows[k].lateral)]
    arrows = []
    for role, one in hands.items():
        phase = one.rows[k].phase
        arrows.append(Arrow(0j, complex(np.exp(1j * phase)), role))
        told.append(f"{say(WHEN[role])} {shown(round(float(np.degrees(phase)), 2) % 360)}°")
    return Panel(
        Axis("\n".join(told), low=-1.1, high=1.1),
        Axis(low=-1.1, high=1.1),
        tuple(curves),
        (Mark(0.0, 0.0, "", "pivot"),),
        arrows=tuple(arrows),
        title=say("row {number}", number=k + 1),
        equal=True,
        bare=True,
        height=64.0,
    )


def together(original: Machine | None, machine: Machine) -> Chart:
    """Components of the shaking force of all rows together over crank angle."""
    told = {"count": len(machine.rows), "speed": told_speed(machine.drive.speed)}
    what = say("Shaking force of {count} rows together, at {speed}", **told)
    if original is not None:
        what = say("Shaking force of {count} rows together, before and after, at {speed}", **told)
    least, _ = rounding(analyze(machine, SAMPLES))
    pairs: list[Pair] = []
    panels = []
    for axis in ("x", "y"):
        angles, after = summed(machine, axis)
        pair: Pair = {"after": settled(after, least)}
        if original is not None:
            pair = paired(summed(original, axis)[1], after, least)
        panels.append(compare(machine.drive, angles, pair, say("along {axis}", axis=axis), "force"))
        pairs.append(pair)
    return Chart("rows", machine.title, what, tuple(panels), keys=keys(*pairs))


def summed(machine: Machine, axis: str) -> tuple[Array, Array]:
    """Crank angles (N,), rad, of a whole cycle, and a part of the force of all rows (N,), N."""
    read = Rows(machine).signals(Objective(f"shaking_force.{axis}"))
    total = read.total(np.array([row.phase for row in machine.rows]))[0, 0]
    count = SAMPLES_OF_ROWS * read.turns
    found = Periodic(total, read.turns)
    return np.arange(count) * (found.period / count), found.samples(count)


# -- trade-offs ------------------------------------------------------------------------------------

SENSIBLE, MARGIN = 3.0, 0.12
"""Times the size of a trade-off: how far off the machine as it is may be for it to be drawn, so
that the curve does not get small; free at each side, over what is drawn."""


def front(found: Front) -> Chart:
    """The second objective against the first, each point as good as any can be."""
    values = found.values
    both = (found.first, found.second)
    before = np.array([Problem.value_of(found.original, which) for which in both])
    names = [objective_named(one, len(found.original.rows)) for one in both]
    low, high = np.min(values, axis=0), np.max(values, axis=0)
    room = SENSIBLE * (high - low)
    seen = bool(np.all((before <= high + room) & (before >= low - room)))
    held = np.vstack([values, before]) if seen else values
    x, y = (
        _objective_axis(short(name, most), unit, column)
        for name, most, (_, unit, _), column in zip(
            names, (60, 46), found.columns()[:2], held.T, strict=True
        )
    )
    told = f"{x.quantity(before[0])}, {y.quantity(before[1])}"
    marks, remark = [], say("as it is, far off: {places}", places=told)
    if seen:
        text, remark = say("as it is: {places}", places=told), ""
        marks.append(Mark.of(complex(*before), text, "own", 90.0))
    for k, wish in ((0, 20.0), (len(values) - 1, 110.0)):
        text = f"{x.quantity(values[k, 0])}, {y.quantity(values[k, 1])}"
        if (added := found.points[k].added_mass) > NOTHING * found.original.mass:
            text += "\n" + say("with {mass} more", mass=grams(added))
        marks.append(Mark.of(complex(*values[k]), text, "best", wish, sign=False))
    curve = Curve(values[:, 0], values[:, 1], "", "best")
    panel = Panel(x, y, (curve,), tuple(marks), remark=remark, height=250.0)
    speed = told_speed(found.original.drive.speed)
    title = say("Trade-off: the least of one for every value of the other")
    return Chart("front", found.original.title, f"{title}, at {speed}", (panel,))


def _objective_axis(label: str, unit: str, values: Array) -> Axis:
    """An axis with room, in the unit in which figures of an SI unit are told."""
    low, high = float(np.min(values)), float(np.max(values))
    room = MARGIN * (high - low if high > low else abs(high) or 1.0)
    return Axis(label, shown_in(unit, values), low=low - room, high=high + room)
