"""What a search of geometry shows: goals, what was changed for them, figures before and after."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import TYPE_CHECKING

from equipoise.design.solvers import UNPROVED
from equipoise.i18n import Note, say, to_say
from equipoise.mechanism.assembly.linkage import assemble
from equipoise.mechanism.dynamics.assessment import remarks
from equipoise.planting.blocks import quantity
from equipoise.planting.names import FIGURES, OTHERS, dimension_of, figure_named
from equipoise.results.blocks import Block, Cell, Column, Notes, Table, Text, Value

if TYPE_CHECKING:
    from equipoise.planting.search import Fit
    from equipoise.planting.summary import PlantingFigures


def fit_blocks(fit: Fit) -> Iterator[Block]:
    """Goals, what was changed for them, and the figures before and after."""
    yield Text(say("{count} designs evaluated, seed {seed}", count=fit.judged, seed=fit.seed))
    yield _goals(fit)
    yield _changes(fit)
    yield _figures(fit)
    missed = [figure_named(name) for name, met in fit.met.items() if not met]
    notes: list[Note | str] = [*fit.after.notes, *remarks(assemble(fit.machine))]
    if missed:
        template = to_say(
            "not met: {names}; widen the limits of [vary], loosen the goals, or try another seed"
        )
        notes.append(Note(template, names=", ".join(missed)))
    elif any(goal.make for goal in fit.goals):
        notes.append(Note(UNPROVED))
    if notes:
        yield Notes(tuple(notes))


def _figure_cell(figures: PlantingFigures | None, name: str) -> Cell:
    value = None if figures is None else figures.get(name)
    return say("none") if value is None else _figure(value, name)


def _figure(value: float, name: str) -> Value:
    kind = dimension_of(name)
    return Value(value, after=4) if kind is None else quantity(value, kind)


def _goals(fit: Fit) -> Table:
    words = {True: say("yes"), False: say("no"), None: ""}
    rows: list[tuple[Cell, ...]] = []
    for goal in fit.goals:
        name, met = goal.figure, fit.met.get(goal.figure)
        limits = (goal.target, goal.at_least, goal.at_most)
        wanted = (None if value is None else _figure(value, name) for value in limits)
        before, after = _figure_cell(fit.before, name), _figure_cell(fit.after, name)
        if met is False and isinstance(after, Value):  # stands out
            after = replace(after, emphasis="broken")
        rows.append((figure_named(name), goal.make or "", *wanted, before, after, words[met]))
    labels = (
        *("", say("make"), say("wanted"), say("at least"), say("at most")),
        *(say("before"), say("after"), say("met")),
    )
    return Table(say("Goals"), tuple(map(Column, labels)), tuple(rows))


def _changes(fit: Fit) -> Table:
    rows: list[tuple[Cell, ...]] = []
    for lift, limits in zip(fit.designs.lifts, fit.designs.ranges, strict=True):
        values = (lift.start, fit.values[lift.name], limits.low, limits.high)
        rows.append((lift.name, *(quantity(value, lift.dimension) for value in values)))
    old, new = fit.designs.machine.drive.speed, fit.machine.drive.speed
    if old != new:
        pair = (quantity(speed, "angular speed") for speed in (old, new))
        rows.append((say("crank speed"), *pair, None, None))
    labels = ("", say("before"), say("after"), say("lowest allowed"), say("highest allowed"))
    return Table(say("Changes"), tuple(map(Column, labels)), tuple(rows))


def _figures(fit: Fit) -> Table:
    asked = {goal.figure for goal in fit.goals}
    rows: list[tuple[Cell, ...]] = []
    for name in (*FIGURES, *OTHERS):
        known = any(f.get(name) is not None for f in (fit.before, fit.after) if f is not None)
        if name not in asked and known:
            rows.append(
                (figure_named(name), _figure_cell(fit.before, name), _figure_cell(fit.after, name))
            )
    columns = (Column(""), Column(say("before")), Column(say("after")))
    return Table(say("Other figures"), columns, tuple(rows))
