"""The pictures of an analysis: the linkage, how it moves, and the forces of its motion."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from equipoise.figures.drawing import moving
from equipoise.figures.linkage import linkage_figure
from equipoise.plotting.analysis.curves import curves_figure, hodograph_figure
from equipoise.plotting.analysis.force import force_figure, moment_figure, torque_figure
from equipoise.plotting.analysis.joints import joint_polars_figures, joints_figures
from equipoise.plotting.analysis.polar import polar_figure
from equipoise.plotting.analysis.spectrum import spectrum_figure
from equipoise.plotting.vibration import numbered
from equipoise.results.analysis import LEAST_ANGLES

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from equipoise.results.analysis import Analysis

__all__ = [
    "curves_figure",
    "drawings",
    "force_figure",
    "has_orders",
    "hodograph_figure",
    "joint_polars_figures",
    "joints_figures",
    "linkage_figure",
    "moment_figure",
    "polar_figure",
    "spectrum_figure",
    "torque_figure",
]


def drawings(analysis: Analysis, at: Sequence[float] | None = None) -> dict[str, Figure]:
    """Every picture of an analysis by name, which also does for a file.

    ``linkage``; ``curves`` and ``hodograph`` where points move; where masses are known ``polar``,
    ``force``, ``moment``, ``torque``, ``joints`` and ``joint-polars``, with ``joints-2`` and so on
    where there are many; ``spectrum`` where the crank angles are those of a whole cycle, at least
    90 in a turn.

    Of a single crank angle there is the linkage alone.

    at : crank angles (rad) at which the linkage is drawn; where they are not given, a clear one.
    """
    drawn = {"linkage": linkage_figure(analysis, at)}
    if len(analysis.crank_angle) < 2:
        return drawn
    if moving(analysis.motion):
        drawn["curves"] = curves_figure(analysis)
        drawn["hodograph"] = hodograph_figure(analysis)
    if analysis.solved is None:
        return drawn
    drawn["polar"] = polar_figure(analysis)
    drawn["force"] = force_figure(analysis)
    drawn["moment"] = moment_figure(analysis)
    drawn["torque"] = torque_figure(analysis)
    if has_orders(analysis):
        drawn["spectrum"] = spectrum_figure(analysis)
    drawn |= numbered("joints", joints_figures(analysis))
    drawn |= numbered("joint-polars", joint_polars_figures(analysis))
    return drawn


def has_orders(analysis: Analysis) -> bool:
    """Whether `spectrum_figure` can be drawn."""
    motion = analysis.motion
    enough = len(motion.crank_angle) >= LEAST_ANGLES * motion.turns
    return analysis.solved is not None and motion.whole_cycle and enough
