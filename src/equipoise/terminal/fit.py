"""What `equipoise plant fit` prints: goals and figures before and after."""

from __future__ import annotations

from typing import TYPE_CHECKING, cast

from equipoise.mechanism.assessment import remarks
from equipoise.mechanism.linkage import assemble
from equipoise.planting.goals import dimension_of
from equipoise.terminal.planting import EXTREMES, PATH, SOIL
from equipoise.terminal.tables import Row, table
from equipoise.terminal.units import Units

if TYPE_CHECKING:
    from equipoise.planting.goals import Goal
    from equipoise.planting.search import Fit
    from equipoise.planting.summary import PlantingFigures
    from equipoise.quantities.units import Dimension

OF_INSTANTS = ("crank_angle", "velocity.size", "acceleration.size", "attitude")
OTHERS = (
    *(f"{name}.{key}" for name in ("pick_up", "entry", "lowest", "exit") for key in OF_INSTANTS),
    "transmission.min",
)


def print_fit(fit: Fit, units: Units) -> None:
    """Goals, what was changed for them, and the figures before and after."""
    print(fit.after.machine.title)
    print(f"{fit.judged} designs judged, seed {fit.seed}")
    print(_goals(fit, units))
    print(_changes(fit, units))
    print(_figures(fit, units))
    for note in (*fit.after.notes, *remarks(assemble(fit.machine))):
        print(f"\nnote: {note}")
    missed = [name for name, met in fit.met.items() if not met]
    if missed:
        print(
            f"\nnote: not met: {', '.join(missed)}; widen the limits of [vary], loosen the goals, "
            "or try another seed"
        )


def _shown(value: float | None, name: str, units: Units) -> str:
    dimension = cast("Dimension | None", dimension_of(name))
    if value is None:
        return "none"
    return f"{value:.4f}" if dimension is None else units.shown(value, dimension)


def _label(name: str, units: Units) -> str:
    dimension = cast("Dimension | None", dimension_of(name))
    return name if dimension is None else f"{name} {units.name(dimension)}"


def _goals(fit: Fit, units: Units) -> str:
    rows = []
    for goal in fit.goals:
        before = None if fit.before is None else fit.before.figures.get(goal.figure)
        rows.append(
            (
                _label(goal.figure, units),
                _wanted(goal, units),
                _shown(before, goal.figure, units),
                _shown(fit.after[goal.figure], goal.figure, units),
                {True: "yes", False: "no", None: ""}[fit.met.get(goal.figure)],
            )
        )
    return table("Goals", ("", "wanted", "before", "after", "met"), rows, words=2)


def _wanted(goal: Goal, units: Units) -> str:
    parts: list[str] = [] if goal.make is None else [goal.make]
    for word, value in (("", goal.target), (">= ", goal.at_least), ("<= ", goal.at_most)):
        if value is not None:
            parts.append(word + _shown(value, goal.figure, units))
    return ", ".join(parts)


def _changes(fit: Fit, units: Units) -> str:
    rows = []
    for variable in fit.designs.variables:
        values = (variable.start, fit.values[variable.name], variable.low, variable.high)
        label = f"{variable.name} {units.name(variable.dimension)}"
        rows.append((label, *(units.shown(value, variable.dimension) for value in values)))
    old, new = fit.designs.machine.drive.speed, fit.machine.drive.speed
    if old != new:
        shown = (units.shown(speed, "angular speed") for speed in (old, new))
        rows.append((f"speed of the crank {units.name('angular speed')}", *shown, "", ""))
    header = ("", "before", "after", "lowest", "highest")
    return table("Changes", header, rows)


def _figures(fit: Fit, units: Units) -> str:
    names = [name for _, name in (*PATH, *SOIL)]
    names += [f"{name}.value" for _, name in EXTREMES]
    asked = {goal.figure for goal in fit.goals}
    rows: list[Row] = []
    for name in (*names, *OTHERS):
        known = (f for f in (fit.before, fit.after) if f is not None and name in f.figures)
        if name not in asked and any(known):
            row = (_label(name, units), _of(fit.before, name, units), _of(fit.after, name, units))
            rows.append(row)
    return table("Other figures", ("", "before", "after"), rows)


def _of(figures: PlantingFigures | None, name: str, units: Units) -> str:
    return "none" if figures is None else _shown(figures.figures.get(name), name, units)
