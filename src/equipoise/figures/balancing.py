"""The charts of balancing: signals and aims before and after, rows and their phases, trade-offs."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from functools import cached_property
from math import lcm
from typing import TYPE_CHECKING, Any

import numpy as np

from equipoise.balancing.cylinder_phasing import PhasedRows
from equipoise.balancing.effects import Effects, Signal
from equipoise.balancing.objectives import LinearizationPoint, measured, signals_of, unit_of
from equipoise.balancing.problem import Problem
from equipoise.dataclass import dataclass
from equipoise.figures.changes import changes, grams
from equipoise.figures.chart_parts import (
    GAUGES,
    about,
    by_name,
    closed,
    compared,
    crank_axis,
    extent,
    groups,
    numbered_angles,
    numbers,
    rounding,
    settled,
    speed_text,
)
from equipoise.figures.forces import OrderSizes, last_order, order_panel
from equipoise.figures.style import short
from equipoise.i18n import say, to_say
from equipoise.mechanism.outputs.declared import Declared
from equipoise.mechanism.parts.balance import Objective, output_of
from equipoise.mechanism.parts.machine import Drive
from equipoise.quantities import Dimension
from equipoise.results.analysis import analyze
from equipoise.results.charts import Arrow, Axis, Chart, Curve, Line, Mark, Panel, four_digits
from equipoise.results.outputs import MEASURES, objective_named, shown_in
from equipoise.signals import Array, Periodic, figures

if TYPE_CHECKING:
    from equipoise.balancing.balanced import Balanced
    from equipoise.balancing.pareto import Front
    from equipoise.balancing.phase_search import Phasing
    from equipoise.mechanism.parts.machine import Drive, Machine


PairedSignals = Mapping[str, Array]
"""``before`` and ``after``, or the latter alone."""

WHEN = {"before": to_say("before"), "after": to_say("after"), "unchanged": to_say("unchanged")}
NOTHING, VISIBLE = 1e-9, 4e-3
"""Over the largest value before: what is left after is rounding; what differs can be seen."""


def paired(before: Array, after: Array, least: float) -> PairedSignals:
    """Values (N,) before and after; zeros where they are no more than `least`, which is rounding.

    After they are also zeros where they are rounding beside those before.
    """
    before = settled(before, least)
    largest = float(np.max(np.abs(before), initial=0.0))
    return {"before": before, "after": settled(after, max(least, NOTHING * largest))}


def changed(pair: PairedSignals) -> bool:
    """Whether both differ by what can be seen."""
    if "before" not in pair:
        return True
    largest = float(np.max(np.abs(pair["before"]), initial=0.0))
    return bool(np.any(np.abs(pair["after"] - pair["before"]) > VISIBLE * largest))


def roles_of(pair: PairedSignals) -> dict[str, Array]:
    """What is drawn of a pair by its role: of what is alike one muted line."""
    return dict(pair) if changed(pair) else {"unchanged": pair["after"]}


def keys(*pairs: PairedSignals) -> tuple[tuple[str, str], ...]:
    """What the lines of some pairs are, for a legend."""
    roles = {role for pair in pairs for role in roles_of(pair)}
    return tuple((role, say(name)) for role, name in WHEN.items() if role in roles)


def compare(
    drive: Drive,
    angles: Array,
    pair: PairedSignals,
    label: str,
    dimension: Dimension | None,
    **rest: Any,
) -> Panel:
    """A signal before and after over crank angles (N,), a whole cycle; extremes of both.

    rest : as of `compared`.
    """
    period = float(angles[-1] + angles[1] - angles[0])
    axis = crank_axis(short(drive.crank, 16), drive.speed, round(period / (2 * np.pi)))
    curves = {
        role: (*closed(angles, values, period), figures(angles, values, period))
        for role, values in roles_of(pair).items()
    }
    return compared(axis, label, dimension, curves, **rest)


AIM_SAMPLES, MOST_AIMS = 360, 4
"""Crank angles in a turn by which rounding is recognized; objectives at most in a chart."""
LABELS = {
    "force": to_say("force"),
    "torque": to_say("torque"),
    "length": to_say("displacement"),
    "angle": to_say("rotation"),
}
"""Dimension of an output -> what its axis is called."""


@dataclass(frozen=True, eq=False)
class Aim:
    """What is asked of one signal at one speed.

    objectives : measures of it, and the most that each may be (SI units), where that is limited.
    before, after : the signal, of the machine that there was and of the balanced one.
    least : size (SI units) up to which it is rounding.
    """

    machine: Machine
    objectives: tuple[tuple[Objective, float | None], ...]
    before: Signal
    after: Signal
    least: float

    @cached_property
    def output(self) -> Declared:
        """What it is a signal of."""
        return output_of(self.objectives[0][0].output, self.machine)

    @cached_property
    def pair(self) -> PairedSignals:
        """Values (N,) over a cycle of both machines; of vectors their sizes."""
        turns = lcm(self.before.turns, self.after.turns)
        values = (np.tile(item.start, turns // item.turns) for item in (self.before, self.after))
        before, after = (np.abs(value) if self.output.is_vector else value for value in values)
        return paired(before, after, self.least)

    @cached_property
    def read(self) -> OrderSizes:
        """Orders, and the size of each, of the mean with its sign; of a vector of both its parts
        together.
        """
        result = {}
        for when, signal in (("before", self.before), ("after", self.after)):
            parts = np.array([np.real(signal.start), np.imag(signal.start)])
            periodic = Periodic.of(parts * np.any(self.pair[when]), signal.turns)
            sizes = np.linalg.norm(periodic.sizes, axis=0)
            if not self.output.is_vector:
                sizes[0] = periodic.amplitudes[0, 0].real
            result[f"bar {when}"] = periodic.orders, sizes
        return result

    def panels(self, last: int, with_speed: bool) -> tuple[Panel, Panel]:
        """Panels over the crank angle and by order up to the last, with or without the speed."""
        dimension, (first, _) = self.output.dimension, self.objectives[0]
        unit = GAUGES["displacement", True][1] if dimension == "angle" else None
        named = first if with_speed else replace(first, speeds=())
        title = objective_named(named, len(self.machine.rows), measured=False)
        label = say("magnitude") if self.output.is_vector else say(LABELS[str(dimension)])
        turn = len(self.after.start) // self.after.turns
        angles = np.arange(len(self.pair["after"])) * (2 * np.pi / turn)
        ends = {"unit": unit, "low": 0.0 if self.output.is_vector else None}
        over = compare(self.machine.drive, angles, self.pair, label, dimension, **ends)
        text = say(", ").join(self._row(item, most) for item, most in self.objectives)
        orders = order_panel(text, dimension, self.read, last, unit=over.y.unit.unit)
        return replace(over, title=title, lines=tuple(self._limits)), orders

    @property
    def _limits(self) -> Iterator[Line]:
        """How large the signal may be at any crank angle."""
        for item, most in self.objectives:
            if most is not None and item.measure == "peak":
                for sign in (1.0,) if self.output.is_vector else (1.0, -1.0):
                    yield Line(sign * most, "limit", say("limit"), axis="y")

    def _row(self, objective: Objective, most: float | None) -> str:
        """A measure before and after, and its limit."""
        pair = [measured(self.pair[when], objective.measure) for when in ("before", "after")]
        axis = Axis("", shown_in(unit_of(objective, self.machine), pair))
        what, both = (
            say(MEASURES[objective.measure]),
            f"{axis.format_value(pair[0])} → {axis.quantity(pair[1])}",
        )
        text = say("{what}: {value}", what=what, value=_whole(both))
        if most is None:
            return text
        return say("{what}, at most {limit}", what=text, limit=_whole(axis.quantity(most)))


def _whole(text: str) -> str:
    """A text that is not broken between its lines."""
    return text.replace(" ", "\N{NO-BREAK SPACE}")


def aims_of(balanced: Balanced) -> Iterator[Aim]:
    """Each signal that a plan asks for, by itself at each speed."""
    by_signal: dict[Objective, list[tuple[Objective, float | None]]] = {}
    wanted: list[tuple[Objective, float | None]] = [
        (objective, None) for objective in balanced.plan.objectives
    ]
    for limit in balanced.plan.limits:
        price = balanced.prices[limit.name]
        wanted.append((limit.objective, price.at_most))
    for item, most in wanted:
        for speed in item.speeds or (balanced.original.drive.speed,):
            own = replace(item, speeds=(speed,), weight=1.0)
            by_signal.setdefault(replace(own, measure="rms"), []).append((own, most))
    force, moment = rounding(analyze(balanced.original, AIM_SAMPLES))
    least = {"force": force, "torque": moment}
    effects = [Effects(machine, ()) for machine in (balanced.original, balanced.machine)]
    for signal, of_it in by_signal.items():
        before, after = (
            signals_of(each, signal, LinearizationPoint(each.machine))[0].on_grid
            for each in effects
        )
        dimension = str(output_of(signal.output, balanced.original).dimension)
        yield Aim(balanced.original, tuple(of_it), before, after, least.get(dimension, 0.0))


def aims(balanced: Balanced) -> Iterator[Chart]:
    """Objectives and limited outputs that changed, before and after."""
    every = [aim for aim in aims_of(balanced) if changed(aim.pair)]
    speeds = {speed for aim in every for speed in aim.objectives[0][0].speeds}
    when = say("before and after")
    if speeds == {balanced.original.drive.speed}:
        when = say("before and after, at {speed}", speed=speed_text(balanced.original.drive.speed))
    heading = f"{say('Objectives and limited outputs')}, {when}"
    for suffix, some, which in groups(every, MOST_AIMS):
        last = max(last_order(aim.read) for aim in some)
        text = f"{heading}{which}"
        if any(aim.output.is_vector for aim in some):
            text += "; " + say("orders of forces: both components together")
        panels = [panel for aim in some for panel in aim.panels(last, len(speeds) > 1)]
        legend = keys(*(aim.pair for aim in some))
        yield Chart(
            f"aims{suffix}",
            balanced.original.title,
            text,
            tuple(panels),
            2,
            keys=legend,
            caption=AIMED,
        )


SIGNALS = {
    "moment": (
        "shaking_moment",
        to_say("Shaking moment about {point}"),
        to_say("shaking moment"),
        to_say("Shaking moment, before and after."),
    ),
    "torque": (
        "drive_torque",
        to_say("Drive torque"),
        to_say("drive torque"),
        to_say("Drive torque, before and after."),
    ),
}
"""Picture -> column, title, label of the axis, and caption."""
PUSHED = {
    "torque": (
        "drive_force",
        to_say("Drive force"),
        to_say("drive force"),
        to_say("Drive force, before and after."),
    )
}
"""What stands in the place of the torque where a force drives."""
AIMED = to_say("Objectives and limited outputs, before and after, by crank angle and order.")
SAMPLES, SAMPLES_OF_ROWS = 360, 720
"""Crank angles in a turn by which rounding is recognized, for one row and for several together."""
LABEL_DISTANCE = 0.015
"""Over the size of a hodograph: numbers after that are nearer to those before are left out."""
DOT_SIZE = 0.04
"""Over the size of a hodograph: a smaller curve is hardly seen, and is a dot with its magnitude."""
IN_LINE = 6
"""Dials side by side."""


def balance_charts(balanced: Balanced) -> dict[str, Chart]:
    """Charts of a balanced machine by name, which also does for a file.

    ``aims``, what was made small or limited, with ``aims-2`` and so on where that is much;
    ``force``, ``polar``, ``moment``, ``torque`` and ``changes`` where the linkage is changed;
    ``phases`` and ``rows`` where phases of rows are chosen.  What did not change is left out.
    """
    of_linkage = any(change.kind != "phases" for change in balanced.changes)
    result = by_name(aims(balanced)) | (signals(balanced) if of_linkage else {})
    if balanced.phasing is not None:
        result |= row_charts(balanced.original, balanced.machine)
    return result | by_name([changes(balanced)] if of_linkage else [])


def phasing_charts(phasing: Phasing) -> dict[str, Chart]:
    """``phases`` and ``rows`` of rows whose phases are chosen."""
    return row_charts(None, phasing.machine)


def front_charts(result: Front) -> dict[str, Chart]:
    """``front``, the chart of a trade-off."""
    return by_name([front(result)])


def row_charts(original: Machine | None, machine: Machine) -> dict[str, Chart]:
    """``phases`` and ``rows``; phases alone do not know the machine before."""
    return by_name([phases(original, machine), combined(original, machine)])


# -- before and after ------------------------------------------------------------------------------


def signals(balanced: Balanced) -> dict[str, Chart]:
    """``force``, ``polar``, ``moment`` and ``torque`` before and after, but for what is alike.

    Moment and torque of a single row that are aims are left to `aims`.
    """
    columns = {name: values for name, _, values in balanced.columns()}
    angles, drive = columns["crank_angle"], balanced.original.drive
    analysis = analyze(balanced.original, SAMPLES)
    (least_force, least_moment), point = rounding(analysis), about(analysis)
    title, when = balanced.original.title, _caption(balanced)

    def pair_of(output: str, least: float) -> PairedSignals:
        return paired(columns[f"{output}.before"], columns[f"{output}.after"], least)

    force = {axis: pair_of(f"shaking_force.{axis}", least_force) for axis in ("x", "y")}
    moved = {axis: pair for axis, pair in force.items() if changed(pair)}
    result: dict[str, Chart] = {}
    if moved:
        panels = _along(drive, angles, moved)
        what = f"{say('Shaking force')}, {when}"
        caption = to_say("Shaking force, before and after.")
        legend = keys(*moved.values())
        result["force"] = Chart("force", title, what, panels, keys=legend, caption=caption)
        result["polar"] = polar(balanced, angles, force)
    aimed = (
        {objective.output for objective in balanced.plan.objectives}
        if len(balanced.original.rows) < 2
        else ()
    )
    signals = SIGNALS | (PUSHED if drive.pushes else {})
    for name, (output, text, label, caption) in signals.items():
        kind = drive.effort_in if output == drive.effort else "torque"
        pair = pair_of(output, least_force if kind == "force" else least_moment)
        if changed(pair) and output not in aimed:
            panel = compare(drive, angles, pair, say(label), kind)
            result[name] = Chart(
                name,
                title,
                f"{say(text, point=point)}, {when}",
                (panel,),
                keys=keys(pair),
                caption=caption,
            )
    return result


def _caption(balanced: Balanced) -> str:
    """What is shown of a signal, in words."""
    of_one = say("of one row") + ", " if len(balanced.original.rows) > 1 else ""
    speed = speed_text(balanced.original.drive.speed)
    return of_one + say("before and after, at {speed}", speed=speed)


def polar(balanced: Balanced, angles: Array, force: Mapping[str, PairedSignals]) -> Chart:
    """The end of the shaking force's arrow over a cycle, on axes of one scale."""
    ends = {when: force["x"][when] + 1j * force["y"][when] for when in ("before", "after")}
    columns, size = roles_of(ends), extent(*ends.values(), np.zeros(1))
    at = numbered_angles(angles)
    marks: list[Mark] = []
    curves = [Curve.of(np.append(item, item[0]), "", role) for role, item in columns.items()]
    every = np.concatenate([*ends.values()])
    x, y = (Axis.of(say("shaking force along {axis}", axis=a), "force", every) for a in ("x", "y"))
    for role, values in reversed(columns.items()):
        if role in WHEN and extent(values) < DOT_SIZE * size:
            marks.append(_dot(role, values, y))
        elif np.any(values):
            marks += numbers(at, values, role, size)
        apart = np.abs(ends["before"] - ends["after"])
        at = {angle: k for angle, k in at.items() if apart[k] > LABEL_DISTANCE * size}
    message = "" if np.any(every) else say("zero at every crank angle")
    panel = Panel(x, y, tuple(curves), tuple(marks), message=message, equal=True)
    what = f"{say('Shaking force')}, {_caption(balanced)}; {say('numbers: crank angle, deg')}"
    caption = to_say("Shaking force as a polar diagram, before and after.")
    title = balanced.original.title
    return Chart("polar", title, what, (panel,), keys=keys(ends), caption=caption)


def _dot(role: str, values: Array, axis: Axis) -> Mark:
    """Dot of a hodograph (N,), complex, that is too small to be seen, with its magnitude."""
    largest = float(np.max(np.abs(values)))
    text = say("{when}: at most {value}", when=say(WHEN[role]), value=axis.quantity(largest))
    if not largest:
        text = say("{when}: {value}", when=say(WHEN[role]), value=axis.quantity(0.0))
    return Mark.of(complex(np.mean(values)), text, role, 45.0)


# -- rows ------------------------------------------------------------------------------------------


def phases(original: Machine | None, machine: Machine) -> Chart:
    """A dial for each row in the order of their places, with a hand for its crank."""
    order = sorted(range(len(machine.rows)), key=lambda k: machine.rows[k].lateral)
    hands = {"after": machine} if original is None else {"before": original, "after": machine}
    panels = tuple(_dial(hands, machine, k) for k in order)
    what = say("Direction of {link} in each row at one instant", link=short(machine.drive.link))
    foot = say("from left to right, looking forward, with lateral positions")
    keyed = tuple((role, say(WHEN[role])) for role in hands)
    return Chart(
        "phases",
        machine.title,
        what,
        panels,
        columns=IN_LINE,
        keys=keyed,
        foot=foot,
        caption=to_say("Phases of the rows."),
    )


def _dial(hands: Mapping[str, Machine], machine: Machine, k: int) -> Panel:
    """The crank of one row, in a circle of radius 1."""
    turn = np.exp(1j * np.radians(np.arange(0, 361, 4)))
    ticks = [np.array([0.9 * way, way]) for way in (1, 1j, -1, -1j)]
    curves = [Curve.of(line, "", "dial") for line in (turn, *ticks)]
    quantities = [Axis.of("", "length", [0.3]).quantity(machine.rows[k].lateral)]
    arrows = []
    for role, hand in hands.items():
        phase = hand.rows[k].phase
        arrows.append(Arrow(0j, complex(np.exp(1j * phase)), role))
        quantities.append(
            f"{say(WHEN[role])} {four_digits(round(float(np.degrees(phase)), 2) % 360)}°"
        )
    return Panel(
        Axis("\n".join(quantities), low=-1.1, high=1.1),
        Axis(low=-1.1, high=1.1),
        tuple(curves),
        (Mark(0.0, 0.0, "", "pivot"),),
        arrows=tuple(arrows),
        title=say("row {number}", number=k + 1),
        equal=True,
        bare=True,
        height=64.0,
    )


def combined(original: Machine | None, machine: Machine) -> Chart:
    """Components of the shaking force of all rows together over crank angle."""
    text = {"count": len(machine.rows), "speed": speed_text(machine.drive.speed)}
    what = say("Shaking force of {count} rows together, at {speed}", **text)
    if original is not None:
        what = say("Shaking force of {count} rows together, before and after, at {speed}", **text)
    least, _ = rounding(analyze(machine, SAMPLES))
    pairs: dict[str, PairedSignals] = {}
    for axis in ("x", "y"):
        angles, after = summed(machine, axis)
        pairs[axis] = {"after": settled(after, least)}
        if original is not None:
            pairs[axis] = paired(summed(original, axis)[1], after, least)
    panels = _along(machine.drive, angles, pairs)
    caption = to_say("Shaking force of all rows together, before and after.")
    legend = keys(*pairs.values())
    return Chart("rows", machine.title, what, panels, keys=legend, caption=caption)


def _along(drive: Drive, angles: Array, pairs: Mapping[str, PairedSignals]) -> tuple[Panel, ...]:
    """Components of a force by their axes, over crank angles (N,), in one unit."""
    every = np.concatenate(
        [values for pair in pairs.values() for values in roles_of(pair).values()]
    )
    return tuple(
        compare(drive, angles, pair, say("along {axis}", axis=axis), "force", extent=every)
        for axis, pair in pairs.items()
    )


def summed(machine: Machine, axis: str) -> tuple[Array, Array]:
    """Crank angles (N,), rad, of a whole cycle, and a part of the force of all rows (N,), N."""
    read = PhasedRows(machine).signals(Objective(f"shaking_force.{axis}"))
    total = read.total(np.array([row.phase for row in machine.rows]))[0, 0]
    count = SAMPLES_OF_ROWS * read.turns
    periodic = Periodic(total, read.turns)
    return np.arange(count) * (periodic.period / count), periodic.samples(count)


# -- trade-offs ------------------------------------------------------------------------------------

SENSIBLE, MARGIN = 3.0, 0.12
"""Times the size of a trade-off: how far off the machine as it is may be for it to be drawn, so
that the curve does not get small; free at each side, over what is drawn."""


def front(result: Front) -> Chart:
    """The second objective against the first, each point as good as any can be."""
    values = result.values
    both = (result.first, result.second)
    before = np.array([Problem.value_of(result.original, which) for which in both])
    names = [objective_named(item, len(result.original.rows)) for item in both]
    low, high = np.min(values, axis=0), np.max(values, axis=0)
    room = SENSIBLE * (high - low)
    shows_before = bool(np.all((before <= high + room) & (before >= low - room)))
    shown_values = np.vstack([values, before]) if shows_before else values
    x, y = (
        _objective_axis(short(name, most), unit, column)
        for name, most, (_, unit, _), column in zip(
            names, (60, 46), result.columns()[:2], shown_values.T, strict=True
        )
    )
    label = f"{x.quantity(before[0])}, {y.quantity(before[1])}"
    marks, remark = [], say("as it is, far off: {places}", places=label)
    if shows_before:
        text, remark = say("as it is: {places}", places=label), ""
        marks.append(Mark.of(complex(*before), text, "own", 90.0))
    for k, wish in ((0, 20.0), (len(values) - 1, 110.0)):
        text = f"{x.quantity(values[k, 0])}, {y.quantity(values[k, 1])}"
        if (added := result.points[k].added_mass) > NOTHING * result.original.mass:
            text += "\n" + say("with {mass} more", mass=grams(added))
        marks.append(Mark.of(complex(*values[k]), text, "best", wish, sign=False))
    curve = Curve(values[:, 0], values[:, 1], "", "best")
    panel = Panel(x, y, (curve,), tuple(marks), remark=remark, height=250.0)
    speed = speed_text(result.original.drive.speed)
    title = say("Trade-off: the least of one for every value of the other")
    return Chart("front", result.original.title, f"{title}, at {speed}", (panel,))


def _objective_axis(label: str, unit: str, values: Array) -> Axis:
    """An axis with room at its ends, in the display unit of an SI unit."""
    low, high = float(np.min(values)), float(np.max(values))
    room = MARGIN * (high - low if high > low else abs(high) or 1.0)
    return Axis(label, shown_in(unit, values), low=low - room, high=high + room)
