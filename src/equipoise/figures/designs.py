"""The charts of designs: those that were chosen or found, against each other.

Numbers and figures are drawn in the units that are given by name, as `schema.study_units` has them.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import TYPE_CHECKING

import numpy as np

from equipoise.figures.shared import by_name, continued, groups
from equipoise.figures.studies import PERCENT, Units, unit_of
from equipoise.figures.style import short
from equipoise.i18n import say
from equipoise.results.charts import Array, Axis, Chart, Curve, Mark, Panel
from equipoise.studies.blocks import unit_in

if TYPE_CHECKING:
    from equipoise.studies.design_space import Make
    from equipoise.studies.search import Searched
    from equipoise.studies.selection import Best

Own = tuple[Array, Array]
"""Values (d,) and figures (m,) of the model itself."""

MARGIN = 0.08
"""Free at each side, over what is drawn."""


def best_charts(found: Best, title: str, units: Units) -> dict[str, Chart]:
    """``front`` where there are several aims; ``designs``: the first aim over every number.

    More than ten numbers go on in ``designs-2`` and so on.
    """
    columns = dict(zip(found.numbers, found.values.T, strict=True))
    columns |= dict(zip(found.outputs, found.figures.T, strict=True))
    labels = [str(number) for number in found.designs.tolist()]
    return _of(Designs(title, found.by, found.numbers, columns, labels, units))


def searched_charts(found: Searched, units: Units, own: Own | None = None) -> dict[str, Chart]:
    """The same of a search, and ``search``: how it got better from generation to generation.

    own : the model itself, for comparison.
    """
    study = found.study
    names = (*study.paths, *study.names)
    columns = dict(zip(names, (*found.values.T, *found.figures.T), strict=True))
    labels = [str(number) for number in range(len(found.values))]
    before = None if own is None else dict(zip(names, (*own[0], *own[1]), strict=True))
    by = dict(found.objectives)
    designs = Designs(study.title, by, study.paths, columns, labels, units, before)
    return {**_of(designs), "search": grown(found, units)}


@dataclass(frozen=True, eq=False)
class Designs:
    """Designs (K) as columns (K,) by name, SI units.

    by : what they were chosen by, and which way.  numbers : names of what varies.
    labels : of the designs.  units : in which they are drawn.
    own : the model itself by the same names, where it is known.
    """

    title: str
    by: Mapping[str, Make]
    numbers: Sequence[str]
    columns: Mapping[str, Array]
    labels: Sequence[str]
    units: Units
    own: Mapping[str, float] | None = None

    def axis(self, name: str, most: int = 40, way: bool = True) -> Axis:
        """Of a number or figure; way : whether it is told which way is good."""
        told = unit_in(self.units, name)
        label, unit = short(told.called, most), unit_of(told)
        if way and name in self.by:
            good = say("large is good") if self.by[name] == "largest" else say("small is good")
            label = f"{label} ({good})"
        return Axis(label, unit, room=MARGIN)


def _of(designs: Designs) -> dict[str, Chart]:
    fronts = [front(designs)] if len(designs.by) > 1 else []
    return by_name([*fronts, *over_numbers(designs)])


def front(designs: Designs) -> Chart:
    """Every two aims against each other."""
    pairs = list(combinations(designs.by, 2))
    alone = len(pairs) == 1
    most, columns = (40, 1) if alone else (26, 2)
    panels = tuple(_against(designs, *pair, most, told=alone) for pair in pairs)
    what = say("{count} designs that no other beats in everything", count=len(designs.labels))
    return Chart("front", designs.title, what, panels, columns, False, _keys(designs))


def over_numbers(designs: Designs) -> Iterator[Chart]:
    """The first aim over each number that varies."""
    aim = next(iter(designs.by))
    every = list(designs.numbers)
    for suffix, names in groups(every):
        panels = tuple(_against(designs, name, aim, 34) for name in names)
        what = say("{aim} over each number that varies", aim=designs.axis(aim).text)
        what += continued(names, every)
        own, columns = f"designs{suffix}", min(2, len(panels))
        yield Chart(own, designs.title, what, panels, columns, False, _keys(designs))


def _against(designs: Designs, first: str, second: str, most: int, told: bool = False) -> Panel:
    x, y = designs.columns[first], designs.columns[second]
    marks = []
    if designs.own is not None:
        marks.append(Mark(designs.own[first], designs.own[second], "", "own"))
    if told:
        for k in sorted({int(np.argmin(x)), int(np.argmax(x))}):
            text = say("design {name}", name=designs.labels[k])
            marks.append(Mark(float(x[k]), float(y[k]), text, "designs", 60.0, sign=False))
    return Panel(
        designs.axis(first, most),
        designs.axis(second, most, way=told or (second not in designs.numbers and most < 30)),
        (Curve(x, y, "", "designs"),),
        tuple(marks),
        height=250.0 if told else 118.0,
        zero=False,
    )


def _keys(designs: Designs) -> tuple[tuple[str, str], ...]:
    own = (("own", say("the model itself")),) if designs.own is not None else ()
    return (("designs", say("designs")), *own)


def grown(found: Searched, units: Units) -> Chart:
    """How good the best designs were after each generation."""
    counts = {"count": found.computed, "generations": found.generations}
    what = say("{count} designs in {generations} generations", **counts)
    last = len(found.volumes)
    x = Axis(say("generation"), low=1.0, high=float(max(2, last)))
    y = Axis(say("share that the front dominates"), PERCENT)
    if len(found.objectives) == 1:
        best = unit_in(units, *found.objectives)
        y = Axis(say("best {name}", name=short(best.called, 24)), unit_of(best))
    curve = Curve(np.arange(1.0, last + 1), np.asarray(found.volumes, float), steps=True)
    return Chart("search", found.study.title, what, (Panel(x, y, (curve,)),))
