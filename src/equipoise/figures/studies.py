"""The charts of studies: scatter and what causes it, maps.

Numbers and figures are drawn in the units that are given by name, as `schema.study_units` has them.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any, cast

import numpy as np

from equipoise.figures.chart_parts import by_name, continued, groups, speed_text
from equipoise.figures.style import short
from equipoise.i18n import Note, all_of, localized, say
from equipoise.quantities import Dimension, Display, display, typeset
from equipoise.results.charts import (
    Array,
    Axis,
    Bars,
    Chart,
    Line,
    Mark,
    Panel,
    Surface,
    four_digits,
)
from equipoise.results.outputs import objective_named
from equipoise.studies.blocks import named_together, unit_in

if TYPE_CHECKING:
    from equipoise.studies.blocks import Unit
    from equipoise.studies.objective_map import Landscape
    from equipoise.studies.tolerances import Cause, IntervalEstimate, Scatter, Tolerances

Units = Mapping[str, "Unit"]
NARROW = 0.05
"""Free at each side, over what is drawn."""
PERCENT = Display("%", 100.0)
BAR, TALL, THIN = 21.0, 0.68, 0.36
"""Points from bar to bar of causes; heights of bars, one of a cause and two, over that."""
MOST_SHARES = 4
"""Panels of shares in a picture."""


def unit_of(unit: Unit) -> Display:
    """The unit of a study as an axis has it."""
    return Display(unit.name, 1 / unit.factor)


# -- tolerances ------------------------------------------------------------------------------------


def tolerance_charts(tolerances: Tolerances, units: Units) -> dict[str, Chart]:
    """``scatter``: each figure over all machines; ``tighten``: what half of each tolerance does;
    ``shares``: what causes the scatter of each figure.

    More than ten figures go on in ``scatter-2`` and so on.
    """
    return by_name(
        [*scatter(tolerances, units), tighten(tolerances, units), *shares(tolerances, units)]
    )


def scatter(tolerances: Tolerances, units: Units) -> Iterator[Chart]:
    """A histogram of each figure; bars outside of its limits are pale."""
    every = list(tolerances.scatters)
    keys = [("machines", say("machines")), ("model", say("the model itself"))]
    if any(_limits(item) for item in tolerances.scatters.values()):
        keys += [("outside", say("outside of limits")), ("bound", say("limit"))]
    for suffix, names in groups(every):
        what = say("Scatter over {count} machines", count=tolerances.designs) + continued(
            names, every
        )
        panels = tuple(
            _histogram(tolerances.scatters[name], unit_in(units, name), tolerances.designs)
            for name in names
        )
        own, columns = f"scatter{suffix}", min(2, len(panels))
        yield Chart(own, tolerances.study.title, what, panels, columns, False, tuple(keys))


def _histogram(scatter: Scatter, unit: Unit, designs: int) -> Panel:
    edges, shares = np.asarray(scatter.edges, float), scatter.counts / designs
    limits = [end for end in _limits(scatter) if edges[0] < end < edges[-1]]
    cut = np.union1d(edges, limits)  # a bar that a limit goes through is two, just as high
    edges, shares = cut, shares[np.searchsorted(edges, cut[:-1], "right") - 1]
    output = scatter.output
    least = -np.inf if output.at_least is None else output.at_least
    most = np.inf if output.at_most is None else output.at_most
    inside = (edges[:-1] >= least) & (edges[1:] <= most)
    roles = tuple("machines" if good else "outside" for good in inside)
    lines = [Line(limit, "bound") for limit in _limits(scatter)]
    if np.isfinite(scatter.base):
        lines.append(Line(scatter.base, "model"))
    places = [*(line.at for line in lines), float(edges[0]), float(edges[-1])]
    room = NARROW * (max(places) - min(places)) or 0.05 * abs(places[0]) or 1.0
    x = Axis(unit.called, unit_of(unit), low=min(places) - room, high=max(places) + room)
    bars = Bars((edges[:-1] + edges[1:]) / 2, shares, np.diff(edges), roles=roles)
    title = ""
    if scatter.within is not None:
        title = say("{share} % within limits", share=four_digits(100 * scatter.within.value))
    y = Axis(say("machines"), PERCENT, low=0.0)
    return Panel(x, y, lines=tuple(lines), bars=(bars,), title=title, height=98.0)


def _limits(scatter: Scatter) -> list[float]:
    ends = (scatter.output.at_least, scatter.output.at_most)
    return [end for end in ends if end is not None]


def tighten(tolerances: Tolerances, units: Units) -> Chart:
    """By how much the scatter falls where one tolerance is halved."""
    gains = np.array([max(cause.gain, 0.0) for cause in tolerances.causes])
    bars = Bars(np.arange(len(gains)), gains, TALL, across="y", labelled=True)
    most = 1.12 * float(np.max(gains)) or 1.0
    x = Axis(say("variance less"), PERCENT, low=0.0, high=most)
    panel = _bars_of(tolerances.causes, units, (bars,), x)
    what = say("Effect of halving each tolerance: mean reduction of the variance of the figures")
    return Chart("tighten", tolerances.study.title, what, (panel,))


def shares(tolerances: Tolerances, units: Units) -> Iterator[Chart]:
    """Share of each tolerance in the variance of each figure, each with its 95 % interval."""
    causes = tolerances.causes
    every = [name for name in tolerances.scatters if name in causes[0].effects]
    with_interactions = say("including interactions with others")
    keys = (
        ("part", say("by itself")),
        ("whole", with_interactions),
        ("interval", say("95 % interval")),
    )
    rows = np.arange(len(causes))
    kinds = (("first", "part", -THIN / 2), ("total", "whole", THIN / 2))
    estimates = (getattr(cause.effects[n], kind) for n in every for cause in causes
                 for kind, *_ in kinds)  # fmt: skip
    most = max((estimate.high for estimate in estimates), default=1.0)
    x = Axis(say("share of the variance"), PERCENT, low=0.0, high=max(most, 1.0))
    for suffix, names in groups(every, MOST_SHARES):
        panels = []
        for name in names:
            effects = [cause.effects[name] for cause in causes]
            bars = tuple(
                _shares([getattr(effect, kind) for effect in effects], rows + offset, role)
                for kind, role, offset in kinds
            )
            panels.append(_bars_of(causes, units, bars, x, title=unit_in(units, name).called))
        what = say("What causes the scatter of each figure") + continued(names, every)
        yield Chart(f"shares{suffix}", tolerances.study.title, what, tuple(panels), keys=keys)


def _shares(estimates: Sequence[IntervalEstimate], rows: Array, role: str) -> Bars:
    """Estimates that may come out below 0 within their interval, as bars from 0."""
    intervals = [(estimate.value, estimate.low, estimate.high) for estimate in estimates]
    size, low, high = np.maximum(np.array(intervals).T, 0.0)
    return Bars(rows, size, THIN, role, across="y", interval=(low, high))


def _bars_of(
    causes: Sequence[Cause], units: Units, bars: tuple[Bars, ...], x: Axis, **rest: Any
) -> Panel:
    """Lying bars, one for each cause, the first at the top."""
    names = (short(named_together(cause.numbers, units), 38) for cause in causes)
    ticks = tuple((float(row), name) for row, name in enumerate(names))
    y = Axis(low=len(causes) - 0.5, high=-0.5, ticks=ticks)
    return Panel(x, y, bars=bars, height=BAR * len(causes), **rest)


# -- an objective over two numbers of a model ------------------------------------------------------

HANDY = {"mass": "g", "inertia": "kg mm^2", "angular speed": "rpm", "stiffness": "N/mm"}
"""Units of numbers of a model beside the usual ones."""


def number_unit(dimension: str | None, values: Sequence[float] | Array) -> Display:
    """Display unit of numbers of the model: the customary unit, or one that suits their size."""
    if dimension is None:
        return Display("", 1.0)
    return display(cast(Dimension, dimension), np.asarray(values), HANDY.get(dimension))


def _units(landscape: Landscape) -> dict[str, Display]:
    """Of the numbers that vary, by the ranges over which they do."""
    ranges = zip(landscape.paths, (landscape.x, landscape.y), strict=True)
    return {path: number_unit(landscape.dimensions[path], values) for path, values in ranges}


def optimum_text(landscape: Landscape) -> str:
    """Sentence on the optimum of a landscape: its value, its place, and any ends of ranges met."""
    units = _units(landscape)
    places = [
        f"{named(landscape, path)} = {Axis(path, units[path]).quantity(value)}"
        for path, value in zip(landscape.paths, landscape.best, strict=True)
    ]
    best = say(
        "least {aim}: {value}, at {places}",
        aim=objective_named(landscape.objective),
        value=f"{four_digits(landscape.least)} {typeset(landscape.unit)}",
        places=localized(all_of(places)),
    )
    edge = [
        say("{name} is at an end of its range", name=named(landscape, path))
        for path in landscape.at_edge
    ]
    return "; ".join([best, *edge])


def _in_units(landscape: Landscape, path: str, value: float) -> str:
    """A value of one of the numbers that are given, with its unit."""
    return Axis("", number_unit(landscape.dimensions[path], [value])).quantity(value)


def named(landscape: Landscape, path: str) -> str:
    """One of the numbers in words."""
    words = landscape.words[path]
    return words.localized() if isinstance(words, Note) else words


def landscape(result: Landscape) -> Chart:
    """Lines of equal value with their values, the least of all, and the model as it is."""
    units = _units(result)
    x, y = (
        Axis(
            named(result, path),
            units[path],
            low=float(values[0]),
            high=float(values[-1]),
        )
        for path, values in zip(result.paths, (result.x, result.y), strict=True)
    )
    unit = typeset(result.unit)
    place = f"{x.quantity(result.best[0])}, {y.quantity(result.best[1])}"
    places = {"least": (result.best, f"{four_digits(result.least)} {unit}\n{place}", say("least"))}
    if result.start is not None and not np.isnan(result.before):
        inside = (
            values[0] <= coordinate <= values[-1]
            for values, coordinate in zip((result.x, result.y), result.start, strict=True)
        )
        if all(inside):
            places["own"] = (result.start, f"{four_digits(result.before)} {unit}", say("as it is"))
    marks = [
        Mark(*at, text, role, bold=True, label=name) for role, (at, text, name) in places.items()
    ]
    lacking = say("cannot turn") if np.any(np.isnan(result.values)) else ""
    surface = Surface(
        result.x, result.y, result.values, Axis("", Display(result.unit, 1.0)), lacking
    )
    panel = Panel(x, y, marks=tuple(marks), surface=surface, height=330.0, zero=False, grid=False)
    values = {
        "objective": objective_named(result.objective, len(result.machine.rows)),
        "unit": unit,
        "speed": speed_text(result.machine.drive.speed),
    }
    others = [
        f"{named(result, path)} = {_in_units(result, path, value)}"
        for path, value in result.given.items()
    ]
    what = "; ".join([say("{objective}, {unit}, at {speed}", **values), *others])
    return Chart("landscape", result.machine.title, what, (panel,))
