"""Designs as lines from axis to axis: numbers and figures side by side."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace

import numpy as np

from equipoise.figures.clouds import CloudDesigns, counted, keys_for
from equipoise.figures.shared import continued, groups
from equipoise.figures.sheet import lines_of
from equipoise.figures.style import SMALL
from equipoise.i18n import say
from equipoise.results.charts import Array, Axis, Chart, Curve, Panel, PlaceLabel, Rule
from equipoise.studies.cloud import SOME

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
    for suffix, names in groups(others, RULES - 1):
        what = say("Designs from axis to axis") + continued(names, others)
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
