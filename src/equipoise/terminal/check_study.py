"""What `equipoise check` prints of a study: what varies, what is computed, and how."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from equipoise.codegen.figures import COMPUTED, REASONS
from equipoise.studies.design_space import Choices, Normal, Range
from equipoise.studies.evaluate import evaluator
from equipoise.studies.outcomes import Outcome
from equipoise.terminal.tables import Row, number, table

if TYPE_CHECKING:
    from equipoise.schema.study_units import Unit
    from equipoise.studies.design_space import Spread
    from equipoise.studies.study import Study

Units = Mapping[str, "Unit"]
FAST, SLOW = "many at once, in compiled loops", "one after the other"
MOST_CHOICES = 5
"""Values of a list that are told."""


def print_check_of_study(study: Study, units: Units, file: str) -> None:
    """Everything about a study that can be told before it is computed."""
    compute = evaluator(study)
    own = np.array([study.model.number(path)[0] for path in study.paths], dtype=float)
    outcome = compute(own[None])
    sampling = study.sampling
    seed = "" if sampling.method == "grid" else f", seed {sampling.seed}"
    print(study.title)
    print(f"model: {study.model.base().title}")
    print(f"{study.size} designs, {sampling.method}{seed}")
    header: Row = ("", "", "model", "in the study")
    print(table("What varies", header, _varied(study, units, own), words=2))
    for one in study.correlations:
        print(f"{one.first} goes with {one.second}, coefficient {one.coefficient:g}")
    header = ("", "", "of", "model", "at least", "at most", "make")
    print(table("What is computed", header, _computed(study, units, outcome), words=3))
    print(f"\ncomputed {FAST if getattr(compute, 'compiled', False) else SLOW}")
    if outcome.reason[0] != COMPUTED:
        print(f"note: the model itself has no figures ({REASONS[int(outcome.reason[0])]})")
    for line in _ready(study, file):
        print(line)


def _varied(study: Study, units: Units, own: np.ndarray[Any, Any]) -> Iterator[Row]:
    for one, value in zip(study.vary, own, strict=True):
        unit = units[one.path]
        yield one.path, unit.name, number(unit.of_si(value)), spread_told(one.spread, unit)


def spread_told(spread: Spread, unit: Unit) -> str:
    """How a number varies, such as ``60.00 to 80.00`` or ``71.50 +- 0.2000``, without its unit."""

    def told(value: float) -> str:
        return number(unit.of_si(value))

    if isinstance(spread, Range):
        steps = "" if spread.steps is None else f", {spread.steps} steps"
        return f"{told(spread.low)} to {told(spread.high)}{steps}"
    if isinstance(spread, Choices):
        some = ", ".join(map(told, spread.values[:MOST_CHOICES]))
        more = len(spread.values) - MOST_CHOICES
        return f"{some} and {more} more" if more > 0 else some
    if isinstance(spread, Normal):
        cut = "" if spread.cut is None else f", cut at {spread.cut:g}"
        return f"{told(spread.mean)}, deviation {told(spread.deviation)}{cut}"
    return f"{told(spread.centre)} +- {told(spread.half_width)}"


def _computed(study: Study, units: Units, outcome: Outcome) -> Iterator[Row]:
    for output, figure in zip(study.outputs, outcome.figures[0].tolist(), strict=True):
        unit = units[output.name]
        ends = (output.at_least, output.at_most)
        cells = ["" if end is None else number(unit.of_si(end)) for end in ends]
        own = "none" if np.isnan(figure) else number(unit.of_si(figure))
        yield output.name, unit.name, output.of, own, *cells, output.make or ""


def _ready(study: Study, file: str) -> Iterator[str]:
    """Commands that take it."""
    yield f"ready for: equipoise sweep {file} -o designs.zarr"
    tolerances = [one.spread.tolerance for one in study.vary]
    if all(tolerances):
        yield f"ready for: equipoise tolerance {file}"
    if not any(tolerances) and study.objectives:
        yield f"ready for: equipoise search {file}"
