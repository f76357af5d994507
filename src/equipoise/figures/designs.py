"""The charts of designs: all of a study, those that were chosen or found, and the model itself.

Numbers and figures are drawn in the units that are given by name, as `schema.study_units` has them.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import combinations
from typing import TYPE_CHECKING

import numpy as np

from equipoise.figures.clouds import CloudDesigns, Own, Pair, counted, in_words, keys_for
from equipoise.figures.parallel import parallel
from equipoise.figures.shared import by_name, continued, groups
from equipoise.figures.studies import PERCENT, Units, unit_of
from equipoise.figures.style import short
from equipoise.i18n import say
from equipoise.results.charts import (
    Array,
    Axis,
    Cells,
    Chart,
    Curve,
    Line,
    Mark,
    Panel,
)
from equipoise.studies.blocks import unit_in
from equipoise.studies.cloud import Cloud

if TYPE_CHECKING:
    from equipoise.studies.searching import Searched
    from equipoise.studies.selection import Best
    from equipoise.studies.store import Store

NAMED = 3
"""Designs nearest to limits that are named."""
BELOW = -0.06
"""How far below all designs those stand that fail, over what they reach."""


def best_charts(
    best: Best,
    title: str,
    units: Units,
    store: Store,
    own: Own | None = None,
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


def searched_charts(searched: Searched, units: Units, own: Own | None = None) -> dict[str, Chart]:
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
    for suffix, names in groups(every):
        panels = tuple(_against(designs, (name, aim)) for name in names)
        what = say("{aim} over each number that varies", aim=designs.axis(aim).text)
        what += continued(names, every)
        own, columns = f"designs{suffix}", min(2, len(panels))
        keys = keys_for(designs, [(name, aim) for name in names])
        parts = (counted(designs),)
        yield Chart(own, designs.title, what, panels, columns, False, keys, words=parts)


def _against(designs: CloudDesigns, pair: Pair, alone: bool = False) -> Panel:
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


def _all(cloud: Cloud, pair: Pair) -> tuple[tuple[Cells, ...], list[Curve]]:
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


def grown(searched: Searched, units: Units) -> Chart:
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
