"""What a search of geometry shows: goals, what was changed, and the figures before and after."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from equipoise.i18n import Note, say, to_say
from equipoise.mechanism.assessment import remarks
from equipoise.mechanism.linkage import assemble
from equipoise.planting.blocks import UNITS, cell
from equipoise.planting.names import FIGURES, INSTANTS, LINKAGE, OF_AN_INSTANT
from equipoise.results.blocks import Block, Cell, Column, Notes, Table, Text, Value

if TYPE_CHECKING:
    from equipoise.planting.search import Fit
    from equipoise.planting.summary import PlantingFigures

OF_INSTANTS = ("crank_angle", "velocity.size", "acceleration.size", "attitude")
OTHERS = (
    *(f"{name}.{key}" for name in ("pick_up", "entry", "lowest", "exit") for key in OF_INSTANTS),
    *LINKAGE,
)


def figure_named(name: str) -> str:
    """A figure, such as ``pick_up.velocity.size``, in words, where there are any."""
    known = FIGURES | LINKAGE
    if name in known:
        return say(known[name].words)
    instant, _, key = name.partition(".")
    if instant not in INSTANTS or key not in OF_AN_INSTANT:
        return name
    what = say(OF_AN_INSTANT[key].words)
    return say("{what} at {instant}", what=what, instant=say(INSTANTS[instant]))


def fit_blocks(fit: Fit) -> Iterator[Block]:
    """Goals, what was changed for them, and the figures before and after."""
    yield Text(say("{count} designs judged, seed {seed}", count=fit.judged, seed=fit.seed))
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
    if notes:
        yield Notes(tuple(notes))


def _told(figures: PlantingFigures | None, name: str) -> Cell:
    value = None if figures is None else figures.figures.get(name)
    return say("none") if value is None else _figure(value, name)


def _figure(value: float, name: str) -> Value:
    found = cell(value, name)
    assert found is not None
    return Value(value, after=4) if found.dimension is None else found


def _goals(fit: Fit) -> Table:
    words = {True: say("yes"), False: say("no"), None: ""}
    rows: list[tuple[Cell, ...]] = []
    for goal in fit.goals:
        name, met = goal.figure, fit.met.get(goal.figure)
        limits = (goal.target, goal.at_least, goal.at_most)
        wanted = (None if value is None else _figure(value, name) for value in limits)
        before, after = _told(fit.before, name), _told(fit.after, name)
        if met is False and isinstance(after, Value):  # stands out
            after = replace(after, broken=True)
        rows.append((figure_named(name), goal.make or "", *wanted, before, after, words[met]))
    labels = (
        *("", say("make"), say("wanted"), say("at least"), say("at most")),
        *(say("before"), say("after"), say("met")),
    )
    filled = [any(row[k] not in (None, "") for row in rows) for k in range(len(labels))]
    kept = [k for k, full in enumerate(filled) if full or k in (0, 5, 6, 7)]
    columns = tuple(Column(labels[k]) for k in kept)
    return Table(say("Goals"), columns, tuple(tuple(row[k] for k in kept) for row in rows))


def _changes(fit: Fit) -> Table:
    rows: list[tuple[Cell, ...]] = []
    for variable in fit.designs.variables:
        values = (variable.start, fit.values[variable.name], variable.low, variable.high)
        kind = variable.dimension
        after = 2 if kind == "angle" else None
        cells = (Value(v, after=after, dimension=kind, unit=UNITS.get(kind)) for v in values)
        rows.append((variable.name, *cells))
    old, new = fit.designs.machine.drive.speed, fit.machine.drive.speed
    if old != new:
        pair = (Value(speed, dimension="angular speed", unit="rpm") for speed in (old, new))
        rows.append((say("crank speed"), *pair, None, None))
    labels = ("", say("before"), say("after"), say("lowest allowed"), say("highest allowed"))
    return Table(say("Changes"), tuple(map(Column, labels)), tuple(rows))


def _figures(fit: Fit) -> Table:
    asked = {goal.figure for goal in fit.goals}
    rows: list[tuple[Cell, ...]] = []
    for name in (*FIGURES, *OTHERS):
        known = [f for f in (fit.before, fit.after) if f is not None and name in f.figures]
        if name not in asked and known:
            rows.append((figure_named(name), _told(fit.before, name), _told(fit.after, name)))
    columns = (Column(""), Column(say("before")), Column(say("after")))
    return Table(say("Other figures"), columns, tuple(rows))


SHOWS: dict[str, Any] = {"Fit": fit_blocks}
