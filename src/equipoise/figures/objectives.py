"""Charts of objectives: over two numbers of a model, and one against another."""

from __future__ import annotations

from typing import TYPE_CHECKING, cast

import numpy as np

from equipoise.balancing.problem import Problem
from equipoise.figures.changes import grams
from equipoise.figures.shared import told_speed
from equipoise.figures.style import short
from equipoise.i18n import say
from equipoise.quantities import Dimension, Display, display, in_unit, typeset
from equipoise.results.charts import Array, Axis, Chart, Curve, Mark, Panel, Surface, shown
from equipoise.results.outputs import objective_named

if TYPE_CHECKING:
    from equipoise.balancing.pareto import Front
    from equipoise.studies.objective_map import Landscape

HANDY = {"mass": "g", "inertia": "kg mm^2", "angular speed": "rpm", "stiffness": "N/mm"}
"""Units of numbers of a model beside the usual ones."""


def number_unit(dimension: str | None) -> Display:
    """The unit in which a number of the model is told."""
    if dimension is None:
        return Display("", 1.0)
    if dimension in HANDY:
        return in_unit(HANDY[dimension])
    return display(cast(Dimension, dimension))


def told_best(found: Landscape) -> str:
    """The best place in a sentence."""
    places = (
        f"{path} = {Axis(path, number_unit(found.dimensions[path])).quantity(value)}"
        for path, value in zip(found.paths, found.best, strict=True)
    )
    value = f"{shown(found.least)} {typeset(found.unit)}"
    return f"least {found.objective.name}: {value}, at {' and '.join(places)}"


def landscape(found: Landscape) -> Chart:
    """Lines of equal value with their values, the least of all, and the model as it is."""
    x, y = (
        Axis(
            short(path, 60),
            number_unit(found.dimensions[path]),
            low=float(values[0]),
            high=float(values[-1]),
        )
        for path, values in zip(found.paths, (found.x, found.y), strict=True)
    )
    unit = typeset(found.unit)
    told = f"{x.quantity(found.best[0])}, {y.quantity(found.best[1])}"
    places = {"least": (found.best, f"{shown(found.least)} {unit}\n{told}", say("least"))}
    if found.start is not None and not np.isnan(found.before):
        inside = (
            values[0] <= one <= values[-1]
            for values, one in zip((found.x, found.y), found.start, strict=True)
        )
        if all(inside):
            places["own"] = (found.start, f"{shown(found.before)} {unit}", say("as it is"))
    marks = [
        Mark(*at, text, role, bold=True, label=name) for role, (at, text, name) in places.items()
    ]
    lacking = say("cannot turn") if np.any(np.isnan(found.values)) else ""
    surface = Surface(found.x, found.y, found.values, Axis("", Display(found.unit, 1.0)), lacking)
    panel = Panel(x, y, marks=tuple(marks), surface=surface, height=330.0, zero=False, grid=False)
    values = {
        "objective": objective_named(found.objective, len(found.machine.rows)),
        "unit": unit,
        "speed": told_speed(found.machine.drive.speed),
    }
    others = [
        f"{path} = {Axis(path, number_unit(found.dimensions[path])).quantity(value)}"
        for path, value in found.given.items()
    ]
    what = "; ".join([say("{objective}, {unit}, at {speed}", **values), *others])
    return Chart("landscape", found.machine.title, what, (panel,))


SENSIBLE, MARGIN = 3.0, 0.12
"""Times the size of a trade-off: how far off the machine as it is may be to be in the picture;
free at each side, over what is drawn."""


def front(found: Front) -> Chart:
    """The second objective against the first, each point as good as any can be."""
    values = found.values
    both = (found.first, found.second)
    before = np.array([Problem.value_of(found.original, which) for which in both])
    names = [objective_named(one, len(found.original.rows)) for one in both]
    seen = _is_near(values, before)
    held = np.vstack([values, before]) if seen else values
    x, y = (
        _objective_axis(short(name, most), unit, column)
        for name, most, (_, unit, _), column in zip(
            names, (60, 46), found.columns()[:2], held.T, strict=True
        )
    )
    told = f"{x.quantity(before[0])}, {y.quantity(before[1])}"
    marks, remark = [], ""
    if seen:
        text = say("as it is: {places}", places=told)
        marks.append(Mark(float(before[0]), float(before[1]), text, "own", 90.0))
    else:
        remark = say("as it is, far off: {places}", places=told)
    for k, wish in ((0, 20.0), (len(values) - 1, 110.0)):
        first, second = map(float, values[k])
        text = f"{x.quantity(first)}, {y.quantity(second)}"
        added = found.points[k].added_mass
        if added > 1e-9:
            text += "\n" + say("with {mass} more", mass=grams(added))
        marks.append(Mark(first, second, text, "best", wish, sign=False))
    curve = Curve(values[:, 0], values[:, 1], "", "best")
    panel = Panel(x, y, (curve,), tuple(marks), remark=remark, height=250.0)
    speed = told_speed(found.original.drive.speed)
    title = say("Trade-off: the least of one for every value of the other")
    return Chart("front", found.original.title, f"{title}, at {speed}", (panel,))


def _objective_axis(label: str, unit: str, values: Array) -> Axis:
    """An axis with room on which a displacement is told in mm or mrad, anything else as it is."""
    shown_in = {"m": "mm", "rad": "mrad"}.get(unit, unit)
    low, high = float(np.min(values)), float(np.max(values))
    room = MARGIN * (high - low if high > low else max(abs(high), 1e-12))
    return Axis(label, in_unit(shown_in), low=low - room, high=high + room)


def _is_near(values: Array, before: Array) -> bool:
    """Whether the machine as it is can be shown without making the curve small."""
    low, high = np.min(values, axis=0), np.max(values, axis=0)
    room = SENSIBLE * (high - low)
    return bool(np.all(before <= high + room) and np.all(before >= low - room))
