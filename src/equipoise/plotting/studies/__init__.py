"""The pictures of studies; names of pictures also do for files.

Numbers and figures are drawn in the units that are given by name, as `io.study_units` has them.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from equipoise.plotting.studies.designs import Designs, designs_figures, front_figure, grown_figure
from equipoise.plotting.studies.scatter import scatter_figures
from equipoise.plotting.studies.shares import shares_figures, tighten_figure
from equipoise.plotting.style import styled
from equipoise.plotting.vibration import numbered

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from equipoise.schema.study_units import Unit
    from equipoise.studies.search import Searched
    from equipoise.studies.selection import Best
    from equipoise.studies.tolerances import Tolerances

Units = Mapping[str, "Unit"]
Own = tuple["np.ndarray[Any, Any]", "np.ndarray[Any, Any]"]
"""Values (d,) and figures (m,) of the model itself."""


def best_drawings(found: Best, title: str, units: Units) -> dict[str, Figure]:
    """``front`` where there are several aims; ``designs``: the first aim over every number.

    More than ten numbers go on in ``designs-2`` and so on.
    """
    columns = {name: found.values[:, k] for k, name in enumerate(found.numbers)}
    columns |= {name: found.figures[:, k] for k, name in enumerate(found.outputs)}
    labels = tuple(str(number) for number in found.designs.tolist())
    designs = Designs(title, found.by, found.numbers, columns, labels, units)
    with styled():
        return _of(designs)


def searched_drawings(found: Searched, units: Units, own: Own | None = None) -> dict[str, Figure]:
    """The same of a search, and ``search``: how it got better from generation to generation.

    own : the model itself, for comparison.
    """
    study = found.study
    columns = {name: found.values[:, k] for k, name in enumerate(study.paths)}
    columns |= {name: found.figures[:, k] for k, name in enumerate(study.names)}
    labels = tuple(str(number) for number in range(len(found.values)))
    before = None
    if own is not None:
        before = dict(zip((*study.paths, *study.names), (*own[0], *own[1]), strict=True))
    by = dict(found.objectives)
    designs = Designs(study.title, by, study.paths, columns, labels, units, before)
    with styled():
        return {**_of(designs), "search": grown_figure(found, units)}


def tolerance_drawings(found: Tolerances, units: Units) -> dict[str, Figure]:
    """``scatter``: each figure over all machines; ``tighten``: what half of each tolerance does;
    ``shares``: what causes the scatter of each figure.

    More than ten figures go on in ``scatter-2`` and so on.
    """
    with styled():
        drawn = numbered("scatter", scatter_figures(found, units))
        drawn["tighten"] = tighten_figure(found)
        return drawn | numbered("shares", shares_figures(found))


def _of(designs: Designs) -> dict[str, Figure]:
    drawn = {"front": front_figure(designs)} if len(designs.by) > 1 else {}
    return drawn | numbered("designs", designs_figures(designs))
