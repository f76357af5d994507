"""What balancing was asked for, before and after: aims and limits by crank angle and order."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from functools import cached_property
from math import lcm
from typing import TYPE_CHECKING

import numpy as np

from equipoise.balancing.effects import Effects, Signal
from equipoise.balancing.objectives import LinearizationPoint, measured, signals_of, unit_of
from equipoise.dataclass import dataclass
from equipoise.figures.analysis import rounding
from equipoise.figures.forces import Read, last_order, order_panel
from equipoise.figures.pairs import Pair, changed, compare, keys, paired
from equipoise.figures.shared import GAUGES, continued, groups, told_speed
from equipoise.i18n import say, to_say
from equipoise.mechanism.outputs.declared import Declared
from equipoise.mechanism.parts.balance import Objective
from equipoise.mechanism.parts.objectives import output_of
from equipoise.results.analysis import analyze
from equipoise.results.charts import Axis, Chart, Line, Panel
from equipoise.results.outputs import MEASURES, objective_named, shown_in
from equipoise.signals import Periodic

if TYPE_CHECKING:
    from equipoise.balancing.balanced import Balanced
    from equipoise.mechanism.parts.machine import Machine

SAMPLES, MOST_AIMS = 360, 4
"""Crank angles in a turn from which it is told what is rounding; aims below each other."""
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

    asked : measures of it, and the most that each may be (SI units), where that is limited.
    before, after : the signal, of the machine that there was and of the balanced one.
    least : size (SI units) up to which it is rounding.
    """

    machine: Machine
    asked: tuple[tuple[Objective, float | None], ...]
    before: Signal
    after: Signal
    least: float

    @cached_property
    def output(self) -> Declared:
        """What it is a signal of."""
        return output_of(self.asked[0][0].output, self.machine)

    @cached_property
    def pair(self) -> Pair:
        """Values (N,) over a cycle of both machines; of vectors their sizes."""
        turns = lcm(self.before.turns, self.after.turns)
        values = (np.tile(item.start, turns // item.turns) for item in (self.before, self.after))
        before, after = (np.abs(value) if self.output.is_vector else value for value in values)
        return paired(before, after, self.least)

    @cached_property
    def read(self) -> Read:
        """Orders, and the size of each; of a vector of both its parts together."""
        result = {}
        for when, signal in (("before", self.before), ("after", self.after)):
            parts = np.array([np.real(signal.start), np.imag(signal.start)])
            periodic = Periodic.of(parts * np.any(self.pair[when]), signal.turns)
            result[f"bar {when}"] = periodic.orders, np.linalg.norm(periodic.sizes, axis=0)
        return result

    def panels(self, last: int, with_speed: bool) -> tuple[Panel, Panel]:
        """Over crank angle, and by order up to the last; with_speed : whether that is told."""
        dimension, (first, _) = self.output.dimension, self.asked[0]
        unit = GAUGES["displacement", True][1] if dimension == "angle" else None
        named = first if with_speed else replace(first, speeds=())
        title = objective_named(named, len(self.machine.rows), measured=False)
        label = say("size") if self.output.is_vector else say(LABELS[str(dimension)])
        turn = len(self.after.start) // self.after.turns
        angles = np.arange(len(self.pair["after"])) * (2 * np.pi / turn)
        ends = {"unit": unit, "low": 0.0 if self.output.is_vector else None}
        over = compare(self.machine.drive, angles, self.pair, label, dimension, **ends)
        text = say(", ").join(self._told(item, most) for item, most in self.asked)
        orders = order_panel(text, dimension, self.read, last, unit=unit)
        return replace(over, title=title, lines=tuple(self._limits)), orders

    @property
    def _limits(self) -> Iterator[Line]:
        """How large the signal may be at any crank angle."""
        for item, most in self.asked:
            if most is not None and item.measure == "peak":
                for sign in (1.0,) if self.output.is_vector else (1.0, -1.0):
                    yield Line(sign * most, "limit", say("limit"), axis="y")

    def _told(self, objective: Objective, most: float | None) -> str:
        """A measure before and after, and its limit."""
        pair = [measured(self.pair[when], objective.measure) for when in ("before", "after")]
        axis = Axis("", shown_in(unit_of(objective, self.machine), pair))
        what, both = (
            say(MEASURES[objective.measure]),
            f"{axis.told(pair[0])} → {axis.quantity(pair[1])}",
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
    asked: dict[Objective, list[tuple[Objective, float | None]]] = {}
    wanted: list[tuple[Objective, float | None]] = [
        (objective, None) for objective in balanced.plan.objectives
    ]
    for limit in balanced.plan.limits:
        price = balanced.prices[limit.name]
        wanted.append((limit.objective, price.at_most))
    for item, most in wanted:
        for speed in item.speeds or (balanced.original.drive.speed,):
            own = replace(item, speeds=(speed,), weight=1.0)
            asked.setdefault(replace(own, measure="rms"), []).append((own, most))
    force, moment = rounding(analyze(balanced.original, SAMPLES))
    least = {"force": force, "torque": moment}
    effects = [Effects(machine, ()) for machine in (balanced.original, balanced.machine)]
    for signal, of_it in asked.items():
        before, after = (
            signals_of(each, signal, LinearizationPoint(each.machine))[0].on_grid
            for each in effects
        )
        dimension = str(output_of(signal.output, balanced.original).dimension)
        yield Aim(balanced.original, tuple(of_it), before, after, least.get(dimension, 0.0))


def aims(balanced: Balanced) -> Iterator[Chart]:
    """Objectives and limited outputs that changed, before and after."""
    every = [aim for aim in aims_of(balanced) if changed(aim.pair)]
    speeds = {speed for aim in every for speed in aim.asked[0][0].speeds}
    when = say("before and after")
    if speeds == {balanced.original.drive.speed}:
        when = say("before and after, at {speed}", speed=told_speed(balanced.original.drive.speed))
    heading = f"{say('Objectives and limited outputs')}, {when}"
    for suffix, some in groups(every, MOST_AIMS):
        last = max(last_order(aim.read) for aim in some)
        text = f"{heading}{continued(some, every)}"
        if any(aim.output.is_vector for aim in some):
            text += "; " + say("orders of forces: both components together")
        panels = [panel for aim in some for panel in aim.panels(last, len(speeds) > 1)]
        legend = keys(*(aim.pair for aim in some))
        yield Chart(f"aims{suffix}", balanced.original.title, text, tuple(panels), 2, keys=legend)
