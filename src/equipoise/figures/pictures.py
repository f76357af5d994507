"""Every picture of a result by name: its charts, and the drawings of the machine among them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from equipoise.errors import UsageError
from equipoise.i18n import Note
from equipoise.results.charts import Chart
from equipoise.results.result import Result

if TYPE_CHECKING:
    from equipoise.balancing.balanced import Balanced
    from equipoise.balancing.pareto import Front
    from equipoise.balancing.phase_search import Phasing
    from equipoise.planting.summary import PlantingFigures
    from equipoise.results.analysis import Analysis
    from equipoise.studies.objective_map import Landscape
    from equipoise.vibration.free import FreeVibration


Pictures = dict[str, Chart]


def pictures_of(result: Any) -> Mapping[str, Chart]:
    """Every picture of a result by name, which also does for a file.

    Raises
    ------
    UsageError : there are none of such a result.
    """
    if not isinstance(result, Result):
        raise UsageError(
            Note("there are no pictures of {kind}; give a result", kind=type(result).__name__)
        )
    return result.charts()


def analysis_pictures(analysis: Analysis, at: Sequence[float] | None = None) -> Pictures:
    """Every picture of an analysis by name, which also does for a file.

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
    from equipoise.figures import forces
    from equipoise.figures import motion as of_motion
    from equipoise.figures.forces import joint_polars, joints
    from equipoise.figures.link_strength import link_charts
    from equipoise.figures.linkage import centrodes, linkage, rolling
    from equipoise.figures.side import side

    pictures: Pictures = {"linkage": linkage(analysis, at)}
    if analysis.machine.has_planes:
        pictures["side"] = side(analysis, at)
    if len(analysis.crank_angle) < 2:
        return pictures
    if of_motion.moving(analysis.motion):
        pictures |= {
            "curves": of_motion.curves(analysis),
            "hodograph": of_motion.hodograph(analysis),
        }
    if links := rolling(analysis):
        pictures["centrodes"] = centrodes(analysis, links)
    pictures |= {chart.name: chart for chart in of_motion.coupling_ratios(analysis)}
    if not analysis.has_forces:
        return pictures
    pictures |= {chart.name: chart for chart, _ in of_motion.coupling_curves(analysis)}
    for chart in (forces.polar, forces.force, forces.moment):
        pictures[chart.__name__] = chart(analysis)
    pictures |= {chart.name: chart for chart in forces.torques(analysis)}
    if analysis.has_orders:
        pictures["spectrum"] = forces.spectrum(analysis)
    of_joints = (*joints(analysis), *joint_polars(analysis))
    pictures |= {chart.name: chart for chart in of_joints}
    return pictures | {chart.name: chart for chart, _ in link_charts(analysis)}


def planting_pictures(figures: PlantingFigures) -> Pictures:
    """``path``, and the charts of a planting machine."""
    from equipoise.figures.planting import charts, path

    return {"path": path(figures), **charts(figures)}


def mode_pictures(free: FreeVibration) -> Pictures:
    """Every mode by name: ``mode-1``, ``mode-2`` and so on."""
    from equipoise.figures.modes import mode_chart

    return {f"mode-{k}": mode_chart(free, k) for k in range(1, len(free.modes) + 1)}


def balance_pictures(balanced: Balanced) -> Pictures:
    """Charts of a balanced machine and, where its linkage is changed, ``changes``."""
    from equipoise.figures.balancing import charts
    from equipoise.figures.changes import changes

    pictures: Pictures = {**charts(balanced)}
    if any(change.kind != "phases" for change in balanced.changes):
        pictures["changes"] = changes(balanced)
    return pictures


def phasing_pictures(phasing: Phasing) -> Pictures:
    """Charts of rows whose phases are chosen."""
    from equipoise.figures.balancing import row_charts

    return {**row_charts(None, phasing.machine)}


def front_pictures(result: Front) -> Pictures:
    """``front``, the chart of a trade-off."""
    from equipoise.figures.balancing import front

    return {"front": front(result)}


def landscape_pictures(result: Landscape) -> Pictures:
    """The map of a measure over two numbers."""
    from equipoise.figures.studies import landscape

    chart = landscape(result)
    return {chart.name: chart}
