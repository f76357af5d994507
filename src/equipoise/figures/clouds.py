"""What charts of designs are made of: the chosen ones among all of a study, and the model itself.

Numbers and figures are drawn in the units that are given by name, as `schema.study_units` has them.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from functools import cached_property
from itertools import combinations
from typing import TYPE_CHECKING

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.figures.studies import Units, unit_of
from equipoise.i18n import say
from equipoise.results.charts import Array, Axis
from equipoise.studies.blocks import unit_in
from equipoise.studies.cloud import Blocks, Cloud, cloud_of

if TYPE_CHECKING:
    from equipoise.keys.requirement_kinds import Make
    from equipoise.studies.design_space import Output

Own = tuple[Array, Array]
"""Values (d,) and figures (m,) of the model itself."""
Pair = tuple[str, str]

MARGIN = 0.05
"""Free at each side, over what all designs reach."""


@dataclass(frozen=True, eq=False)
class CloudDesigns:
    """Designs (K) that were chosen, among all.

    by : what they were chosen by, and which way.  numbers : names of what varies.
    outputs : with their limits.  units : how all of them are told.
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
    units: Units
    table: Array
    labels: Sequence[str]
    blocks: Blocks
    size: int
    own: Own | None = None
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
    def pairs(self) -> list[Pair]:
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
        """Of a number or figure; way : whether it is told which way is good."""
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


def keys_for(designs: CloudDesigns, pairs: Iterable[Pair] = ()) -> tuple[tuple[str, str], ...]:
    """What a legend tells of points over these pairs; of lines from axis to axis where none."""
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
