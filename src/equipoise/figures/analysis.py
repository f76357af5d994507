"""Every chart of an analysis."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from equipoise.figures.chart_parts import by_name
from equipoise.figures.forces import (
    force,
    joint_polars,
    joints,
    moment,
    polar,
    spectrum,
    torques,
)
from equipoise.figures.link_strength import link_charts
from equipoise.figures.linkage import centrodes, linkage, rolling
from equipoise.figures.motion import (
    coupling_curves,
    coupling_ratios,
    curves,
    hodograph,
    moving,
)
from equipoise.figures.side import side
from equipoise.results.charts import Chart

if TYPE_CHECKING:
    from equipoise.results.analysis import Analysis


def analysis_charts(analysis: Analysis, at: Sequence[float] | None = None) -> dict[str, Chart]:
    """Every chart of an analysis by name, which also does for a file.

    ``linkage``; ``side`` where links lie beside each other; ``curves`` and ``hodograph`` where
    points move; ``centrodes`` where links roll; ``gears-LINK`` where a ratio varies, ``belt-LINK``
    where belts pull; where masses are known ``polar``, ``force``,
    ``moment``, ``torque`` (``torque-2`` and so on of further drives), ``joints`` and
    ``joint-polars``, with ``joints-2`` and so on where there are many; ``stress-LINK`` of links
    with a section and ``haigh-LINK`` of those with a fatigue limit; ``spectrum`` where the crank
    angles are those of a whole cycle, at least 90 in a turn.

    Of a single crank angle there is the linkage alone.

    at : crank angles (rad) at which the linkage is drawn; where they are not given, a clear one.
    """
    charts = [linkage(analysis, at)]
    if analysis.machine.has_planes:
        charts.append(side(analysis, at))
    if len(analysis.crank_angle) < 2:
        return by_name(charts)
    if moving(analysis.motion):
        charts += [curves(analysis), hodograph(analysis)]
    if links := rolling(analysis):
        charts.append(centrodes(analysis, links))
    charts += coupling_ratios(analysis)
    if not analysis.has_forces:
        return by_name(charts)
    charts += coupling_curves(analysis)
    charts += [polar(analysis), force(analysis), moment(analysis), *torques(analysis)]
    if analysis.has_orders:
        charts.append(spectrum(analysis))
    return by_name([*charts, *joints(analysis), *joint_polars(analysis), *link_charts(analysis)])
