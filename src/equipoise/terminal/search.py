"""What `equipoise search` prints: the designs that no other beats, beside the model itself."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from equipoise.studies.selection import far_apart
from equipoise.terminal.designs import columns_of, designs_table, limits, wanted

if TYPE_CHECKING:
    from equipoise.schema.study_units import Unit
    from equipoise.studies.search import Searched

Array = np.ndarray[Any, Any]

MOST = 20
"""Designs that are printed."""
MODEL = "model"
"""Label of the model itself."""


def print_searched(
    found: Searched, units: Mapping[str, Unit], own: tuple[Array, Array] | None
) -> None:
    """How the search went, and the front.

    own : values (d,) and figures (m,) of the model itself, if it can be computed.
    """
    study = found.study
    print(study.title)
    failed = sum(found.failures.values())
    end = "the front stands still" if found.stood_still else "the front may still grow"
    print(f"{found.computed} designs in {found.generations} generations, seed {found.seed}", end="")
    print(f"; {failed} failed; {end}" if failed else f"; {end}")
    if told := limits(study.outputs, units):
        print(f"limits: {', '.join(told)}")
    print(_front(found, units, own))
    if not found.stood_still:
        print("\nnote: it may get better yet; give more --generations")


def _front(found: Searched, units: Mapping[str, Unit], own: tuple[Array, Array] | None) -> str:
    columns = [study_column(found, name) for name in found.objectives]
    shown = far_apart(np.column_stack(columns), MOST)
    labels = [str(number) for number in shown]
    values, figures = found.values[shown], found.figures[shown]
    if own is not None:
        labels = [MODEL, *labels]
        values, figures = np.vstack([own[0], values]), np.vstack([own[1], figures])
    told = columns_of(found.study.paths, values, found.study.names, figures)
    order = dict.fromkeys((*found.objectives, *found.study.names, *found.study.paths))
    title = _title(found, len(shown))
    return designs_table(title, labels, {name: told[name] for name in order}, units)


def study_column(found: Searched, name: str) -> Array:
    """Figures (K,) of one objective, such that small ones are good."""
    sign = 1.0 if found.objectives[name] == "smallest" else -1.0
    column: Array = sign * found.figures[:, found.study.names.index(name)]
    return column


def _title(found: Searched, shown: int) -> str:
    aims = wanted(found.objectives)
    if len(found.objectives) == 1:
        return f"The best design; {aims}"
    count = f"{shown} of {found.front}" if shown < found.front else f"{found.front}"
    return f"{count} designs that no other beats; {aims}"


__all__: Sequence[str] = ["MODEL", "MOST", "print_searched"]
