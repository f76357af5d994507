"""The charts of studies: scatter and what causes it, maps, and designs: all of them, those chosen,
and lines from axis to axis.

Numbers and figures are drawn in the units that are given by name, as `schema.study_units` has them.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import cached_property
from itertools import combinations
from typing import TYPE_CHECKING, Any, cast

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.figures.chart_parts import by_name, groups, speed_text
from equipoise.figures.sheet import lines_of
from equipoise.figures.style import SMALL, short
from equipoise.i18n import Note, all_of, localized, say
from equipoise.quantities import Dimension, Display, display, typeset
from equipoise.results.charts import (
    Axis,
    Bars,
    Cells,
    Chart,
    Curve,
    Line,
    Mark,
    Panel,
    PlaceLabel,
    Rule,
    Surface,
    four_digits,
)
from equipoise.results.outputs import objective_named
from equipoise.signals import Array
from equipoise.studies.blocks import UnitsByName, named_together, unit_in
from equipoise.studies.selection import SOME, Cloud, DesignBlocks, NamePair, cloud_of

if TYPE_CHECKING:
    from equipoise.keys.requirement_kinds import Make
    from equipoise.studies.blocks import Unit
    from equipoise.studies.objective_map import Landscape
    from equipoise.studies.searching import Searched
    from equipoise.studies.selection import Best
    from equipoise.studies.store import Store
    from equipoise.studies.study import Output
    from equipoise.studies.tolerances import Cause, IntervalEstimate, Scatter, Tolerances


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


def tolerance_charts(tolerances: Tolerances, units: UnitsByName) -> dict[str, Chart]:
    """``scatter``: each figure over all machines; ``tighten``: what half of each tolerance does;
    ``shares``: what causes the scatter of each figure.

    More than ten figures go on in ``scatter-2`` and so on.
    """
    return by_name(
        [*scatter(tolerances, units), tighten(tolerances, units), *shares(tolerances, units)]
    )


def scatter(tolerances: Tolerances, units: UnitsByName) -> Iterator[Chart]:
    """A histogram of each figure; bars outside of its limits are pale."""
    every = list(tolerances.scatters)
    keys = [("machines", say("machines")), ("model", say("the model itself"))]
    if any(_limits(item) for item in tolerances.scatters.values()):
        keys += [("outside", say("outside of limits")), ("bound", say("limit"))]
    for suffix, names, which in groups(every):
        what = say("Scatter over {count} machines", count=tolerances.designs) + which
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


def tighten(tolerances: Tolerances, units: UnitsByName) -> Chart:
    """By how much the scatter falls where one tolerance is halved."""
    gains = np.array([max(cause.gain, 0.0) for cause in tolerances.causes])
    bars = Bars(np.arange(len(gains)), gains, TALL, across="y", labelled=True)
    most = 1.12 * float(np.max(gains)) or 1.0
    x = Axis(say("variance less"), PERCENT, low=0.0, high=most)
    panel = _bars_of(tolerances.causes, units, (bars,), x)
    what = say("Effect of halving each tolerance: mean reduction of the variance of the figures")
    return Chart("tighten", tolerances.study.title, what, (panel,))


def shares(tolerances: Tolerances, units: UnitsByName) -> Iterator[Chart]:
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
    for suffix, names, which in groups(every, MOST_SHARES):
        panels = []
        for name in names:
            effects = [cause.effects[name] for cause in causes]
            bars = tuple(
                _shares([getattr(effect, kind) for effect in effects], rows + offset, role)
                for kind, role, offset in kinds
            )
            panels.append(_bars_of(causes, units, bars, x, title=unit_in(units, name).called))
        what = say("What causes the scatter of each figure") + which
        yield Chart(f"shares{suffix}", tolerances.study.title, what, tuple(panels), keys=keys)


def _shares(estimates: Sequence[IntervalEstimate], rows: Array, role: str) -> Bars:
    """Estimates that may come out below 0 within their interval, as bars from 0."""
    intervals = [(estimate.value, estimate.low, estimate.high) for estimate in estimates]
    size, low, high = np.maximum(np.array(intervals).T, 0.0)
    return Bars(rows, size, THIN, role, across="y", interval=(low, high))


def _bars_of(
    causes: Sequence[Cause], units: UnitsByName, bars: tuple[Bars, ...], x: Axis, **rest: Any
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


def landscape_charts(result: Landscape) -> dict[str, Chart]:
    """``landscape``, the map of a measure over two numbers."""
    return by_name([landscape(result)])


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


# -- designs ---------------------------------------------------------------------------------------

ModelDesign = tuple[Array, Array]
"""Values (d,) and figures (m,) of the model itself."""

MARGIN = 0.05
"""Free at each side, over what all designs reach."""


@dataclass(frozen=True, eq=False)
class CloudDesigns:
    """Designs (K) that were chosen, among all.

    by : what they were chosen by, and which way.  numbers : names of what varies.
    outputs : with their limits.  units : display units of all of these.
    table : (K, d + m) numbers and figures of the chosen ones, SI units; labels : what they are
        called.
    blocks, size : give all designs, of which there are so many at most.
    own : the model itself, where it is known.
    line : (F, M) what the whole front has of `by`.
    aimed : whether one way of `by` is good.
    """

    title: str
    by: Mapping[str, Make]
    numbers: Sequence[str]
    outputs: Sequence[Output]
    units: UnitsByName
    table: Array
    labels: Sequence[str]
    blocks: DesignBlocks
    size: int
    own: ModelDesign | None = None
    line: Array | None = None
    aimed: bool = True

    @property
    def aim(self) -> str:
        """What they were chosen by first."""
        return next(iter(self.by))

    @property
    def names(self) -> list[str]:
        """Of all columns."""
        return [*self.numbers, *(output.name for output in self.outputs)]

    @property
    def columns(self) -> dict[str, Array]:
        """Of the chosen designs, (K,) by name."""
        return dict(zip(self.names, self.table.T, strict=True))

    @property
    def model(self) -> dict[str, float]:
        """Numbers and figures of the model itself by name; none where they are not known."""
        return {} if self.own is None else dict(zip(self.names, np.hstack(self.own), strict=True))

    @property
    def pairs(self) -> list[NamePair]:
        """What is drawn against what: the first aim over each number, and aims over each other."""
        over = [(name, self.aim) for name in self.numbers if name != self.aim]
        return [*over, *combinations(self.by, 2)]

    @cached_property
    def cloud(self) -> Cloud:
        """All designs."""
        return cloud_of(self.blocks, self.numbers, self.outputs, self.pairs, self.size)

    def limits(self, name: str) -> list[float]:
        """Of an output, SI units, as far as designs reach them."""
        ends = ((output.at_least, output.at_most) for output in self.outputs if output.name == name)
        spread = self.cloud.spreads[name]
        given = (end for pair in ends for end in pair if end is not None)
        return [end for end in given if spread.low <= end <= spread.high]

    def axis(self, name: str, way: bool = True) -> Axis:
        """Axis of a number or figure; way : whether its label has an arrow to better values."""
        unit = unit_in(self.units, name)
        label = unit.called
        if way and self.aimed and name in self.by:
            good = say("large is good") if self.by[name] == "largest" else say("small is good")
            label = f"{label} ({good})"
        scale = "log" if self.cloud.spreads[name].log else "linear"
        return Axis(label, unit_of(unit), scale, room=MARGIN)  # type: ignore[arg-type]


def counted(designs: CloudDesigns) -> str:
    """How many designs there are, and of which kinds."""
    cloud = designs.cloud
    counts = {"count": cloud.kept + cloud.beyond + cloud.failed}
    texts = [say("{count} designs", **counts)]
    if any(output.limited for output in designs.outputs):
        texts.append(say("{count} keep every limit", count=cloud.kept))
    if cloud.failed:
        texts.append(say("{count} cannot be computed", count=cloud.failed))
    if not cloud.each:
        texts.append(say("the darker, the more"))
    return say(", ").join(texts)


def in_words(designs: CloudDesigns, names: Iterable[str]) -> list[str]:
    """What numbers and figures are called."""
    return [unit_in(designs.units, name).called for name in names]


def keys_for(designs: CloudDesigns, pairs: Iterable[NamePair] = ()) -> tuple[tuple[str, str], ...]:
    """Entries of the legend: of points over these pairs, or without pairs of lines across axes."""
    cloud, pairs = designs.cloud, [*pairs]
    sign = "" if pairs else " line"
    chosen = say("chosen designs") if cloud.kept else say("designs nearest to the limits")
    keys = [(f"design{sign}", chosen)] if len(designs.table) else []
    if not cloud.kept:
        keys.append((f"beyond{sign}", say("all designs, none of which keeps every limit")))
    elif cloud.beyond:
        feasible, others = say("designs that keep every limit"), say("others")
        keys += [(f"kept{sign}", feasible), (f"beyond{sign}", others)]
    else:
        keys.append((f"kept{sign}", say("all designs")))
    if any(len(cloud.lost.get(first, ())) for first, _ in pairs):
        keys.append(("failed", say("cannot be computed")))
    if designs.model:
        keys.append((f"own{sign}", say("the model itself")))
    if any(designs.limits(name) for pair in pairs for name in pair):
        keys.append(("bound", say("limit")))
    return tuple(keys)


RULES, TALL, WIDE = 8, 190.0, 470.0
"""Axes side by side in one panel, and its height and width, points."""
BEST = 10
"""Chosen designs that are drawn as lines."""


def parallel(designs: CloudDesigns) -> Iterator[Chart]:
    """Numbers and figures as axes side by side, a line for each design."""
    others = [name for name in designs.names if name != designs.aim]
    some, chosen = len(designs.cloud.good), len(designs.table)
    counteds = [counted(designs)]
    if some > SOME or not designs.cloud.each:
        counteds.append(say("lines of {count} designs", count=min(some, SOME)))
    if chosen > BEST:
        counteds.append(say("{count} of {all} chosen designs", count=BEST, all=chosen))
    for suffix, names, which in groups(others, RULES - 1):
        what = say("Designs from axis to axis") + which
        keys = keys_for(designs)
        panel = _rules(designs, [*names, designs.aim])
        words = (say("; ").join(counteds),)
        yield Chart(f"parallel{suffix}", designs.title, what, (panel,), keys=keys, words=words)


def _rules(designs: CloudDesigns, names: Sequence[str]) -> Panel:
    columns, cloud, model = designs.columns, designs.cloud, designs.model
    axes = {}
    for name in names:
        axis, spread = designs.axis(name), cloud.spreads[name]
        own = [model[name]] if name in model and not (spread.log and model[name] <= 0) else []
        low, high = min([spread.low, *own]), max([spread.high, *own])
        axes[name] = replace(axis, low=low, high=high if high > low else low + (abs(low) or 1.0))
    flags = tuple(_flag(k, axis, len(names)) for k, axis in enumerate(axes.values()))
    rules = tuple(Rule(float(k), replace(axis, label="")) for k, axis in enumerate(axes.values()))

    def lines(table: Mapping[str, Array], role: str) -> Curve:
        shares = np.array([_share(axes[name], table[name]) for name in names])
        gap = np.full((1, shares.shape[1]), np.nan)
        heights = np.vstack([shares, gap]).T.ravel()
        return Curve(np.tile([*range(len(names)), np.nan], shares.shape[1]), heights, "", role)

    some = picked(len(cloud.good), SOME)
    kinds = (("beyond line", ~cloud.good[some]), ("kept line", cloud.good[some]))
    curves = [
        lines({name: cloud.some[name][some][mask] for name in names}, role)
        for role, mask in kinds
        if np.any(mask)
    ]
    best = picked(len(designs.table), BEST)
    if len(best):
        curves.append(lines({name: columns[name][best] for name in names}, "design line"))
    if model:
        curves.append(lines({name: np.array([model[name]]) for name in names}, "own line"))
    x, y = Axis(low=-0.5, high=len(names) - 0.5), Axis(low=0.0, high=1.0)
    return Panel(
        x, y, tuple(curves), flags=flags, rules=rules, bare=True,
        grid=False, height=TALL, zero=False,
    )  # fmt: skip


def picked(count: int, most: int) -> Array:
    """Which of some designs are drawn as lines: at most so many, evenly spread over them."""
    return np.linspace(0, count - 1, min(count, most)).round().astype(int)


def _share(axis: Axis, values: Array | float) -> Array:
    """How far along an axis values lie."""
    assert axis.low is not None and axis.high is not None
    of: Callable[[Array], Array] = np.log if axis.scale == "log" else np.asarray
    low, high, at = (of(np.asarray(item, float)) for item in (axis.low, axis.high, values))
    return np.asarray((at - low) / (high - low))


def _flag(at: int, axis: Axis, count: int) -> PlaceLabel:
    """Words above an axis, in lines as wide as there is room."""
    lines = lines_of(axis.label, WIDE / count - 8, SMALL)
    texts = [*lines, axis.unit_name] if axis.unit_name else lines
    return PlaceLabel(float(at), tuple(texts))


NAMED = 3
"""Designs nearest to limits that are named."""
BELOW = -0.06
"""How far below all designs those stand that fail, over what they reach."""


def best_charts(
    best: Best,
    title: str,
    units: UnitsByName,
    store: Store,
    own: ModelDesign | None = None,
    aimed: bool = True,
) -> dict[str, Chart]:
    """``front`` where there are several aims; ``designs``: the first aim over every number;
    ``parallel``: designs as lines from axis to axis.

    More than ten numbers go on in ``designs-2`` and so on, more than eight axes in ``parallel-2``.

    store : with all designs.  own : the model itself.  aimed : whether the study or the reader
    says which way is good; else no design is better than another, and none is chosen.
    """
    labels = [str(number) for number in best.designs.tolist()]
    table = np.hstack([best.values, best.figures])[: None if aimed else 0]
    given = (title, best.by, best.numbers, store.wishes, units, table, labels)
    designs = CloudDesigns(*given, store.in_blocks, store.size, own, best.trade_off, aimed)
    return charts_of(designs)


def searched_charts(
    searched: Searched, units: UnitsByName, own: ModelDesign | None = None
) -> dict[str, Chart]:
    """Charts of a search, and ``search``: how it got better from generation to generation."""
    study = searched.study
    labels = [str(number) for number in range(len(searched.values))]
    table = np.hstack([searched.values, searched.figures])
    given = (study.title, searched.objectives, study.paths, study.outputs, units, table, labels)
    front = searched.figures[:, [study.names.index(name) for name in searched.objectives]]
    designs = CloudDesigns(
        *given, lambda: [(0, searched.tried)], len(searched.tried.values), own, front
    )
    return {**charts_of(designs), "search": grown(searched, units)}


def charts_of(designs: CloudDesigns) -> dict[str, Chart]:
    """Every chart of them by its name."""
    fronts = [front(designs)] if len(designs.by) > 1 else []
    return by_name([*fronts, *over_numbers(designs), *parallel(designs)])


def front(designs: CloudDesigns) -> Chart:
    """Every two aims against each other."""
    pairs = list(combinations(designs.by, 2))
    alone = len(pairs) == 1
    panels = tuple(_against(designs, pair, alone) for pair in pairs)
    what = say("Trade-off of {aims}", aims=say(", ").join(in_words(designs, designs.by)))
    parts = (counted(designs),)
    return Chart(
        "front",
        designs.title,
        what,
        panels,
        1 if alone else 2,
        False,
        keys_for(designs, pairs),
        words=parts,
    )


def over_numbers(designs: CloudDesigns) -> Iterator[Chart]:
    """The first aim over each number that varies."""
    aim = designs.aim
    every = [name for name in designs.numbers if name != aim]
    for suffix, names, which in groups(every):
        panels = tuple(_against(designs, (name, aim)) for name in names)
        what = say("{aim} over each number that varies", aim=designs.axis(aim).text)
        what += which
        own, columns = f"designs{suffix}", min(2, len(panels))
        keys = keys_for(designs, [(name, aim) for name in names])
        parts = (counted(designs),)
        yield Chart(own, designs.title, what, panels, columns, False, keys, words=parts)


def _against(designs: CloudDesigns, pair: NamePair, alone: bool = False) -> Panel:
    """All designs, the chosen ones and the model itself over two columns."""
    first, second = pair
    x, y = (designs.axis(name, way=alone or name not in designs.numbers) for name in pair)
    if first in designs.numbers:
        y = replace(y, label=unit_in(designs.units, second).called)
    columns, cloud = designs.columns, designs.cloud
    curves = [Curve(columns[first], columns[second], "", "design")]
    marks = []
    if len(designs.by) == 2 and designs.line is not None and {*pair} == {*designs.by}:
        line = designs.line[np.argsort(designs.line[:, 0], kind="stable")]
        curves.append(Curve(line[:, 0], line[:, 1], "", "front"))
    if designs.model:
        at = (designs.model[first], designs.model[second])
        marks.append(Mark(*at, say("model"), "own", optional=not alone))
    for k in _labelled(designs, columns[first], alone):
        text = say("design {name}", name=designs.labels[k])
        at = (float(columns[first][k]), float(columns[second][k]))
        marks.append(Mark(*at, text, "stress", 60.0, sign=False, optional=not alone))
    cells, points = _all(cloud, pair)
    lines = [Line(limit, "bound", "", "y") for limit in designs.limits(second)]
    lines += [Line(limit, "bound") for limit in designs.limits(first)]
    if first in cloud.lost and len(cloud.lost[first]):
        below = np.full(len(cloud.lost[first]), cloud.spreads[second].at(BELOW))
        points.append(Curve(cloud.lost[first], below, "", "failed"))
    content = (*points, *curves)
    height = 250.0 if alone else 118.0
    return Panel(
        x, y, content, tuple(marks), (), tuple(lines), cells=cells, height=height, zero=False
    )


def _labelled(designs: CloudDesigns, column: Array, alone: bool) -> Sequence[int]:
    """Which of the chosen designs are named: the ends of a front, the nearest to broken limits."""
    if not len(column):
        return ()
    if not designs.cloud.kept:
        return range(min(NAMED, len(column)))
    return sorted({int(np.argmin(column)), int(np.argmax(column))}) if alone else ()


def _all(cloud: Cloud, pair: NamePair) -> tuple[tuple[Cells, ...], list[Curve]]:
    """All designs over two columns: shades and dots of many, points of few."""
    first, second = pair
    if cloud.each:
        x, y = cloud.some[first], cloud.some[second]
        kinds = (("beyond", ~cloud.good), ("kept", cloud.good))
        return (), [Curve(x[mask], y[mask], "", role) for role, mask in kinds if np.any(mask)]
    inside, outside = cloud.counts[pair]
    edges = (cloud.spreads[first].edges, cloud.spreads[second].edges)
    beyond = Cells(*edges, np.where(inside, 0, outside), "beyond", dots=True)
    return (beyond, Cells(*edges, inside, "kept")), []


# -- a search --------------------------------------------------------------------------------------


def grown(searched: Searched, units: UnitsByName) -> Chart:
    """How good the best designs were after each generation."""
    counts = {"count": searched.computed, "generations": searched.generations}
    what = say("{count} designs in {generations} generations", **counts)
    last = len(searched.volumes)
    x = Axis(say("generation"), low=1.0, high=float(max(2, last)))
    y = Axis(say("share that the front dominates"), PERCENT)
    if len(searched.objectives) == 1:
        best = unit_in(units, *searched.objectives)
        y = Axis(say("best {name}", name=short(best.called, 24)), unit_of(best))
    curve = Curve(np.arange(1.0, last + 1), np.asarray(searched.volumes, float), steps=True)
    return Chart("search", searched.study.title, what, (Panel(x, y, (curve,)),))
