"""Pictures that a page can keep: its drawing, its charts, its motion."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from threading import Lock

from equipoise.errors import UsageError
from equipoise.i18n import Note
from equipoise.mechanism.checks import unknown
from equipoise.results.charts import Chart
from equipoise.web.edits import Computed
from equipoise.web.shaken import responded

SAME = {
    "polar": "polar",
    "path": "curves",
    "shaking_force": "force",
    "shaking_moment": "moment",
    "rocking_moment": "moment",
    "drive_torque": "torque",
    "drive_force": "torque",
    "spectrum": "spectrum",
    "joint": "joints",
}
"""Chart of the page -> picture of an analysis that shows the same."""
drawing = Lock()
"""Matplotlib draws one picture after the other."""
SECONDS = 2.0
"""That a turn of the crank takes in a film."""


def chart_of(computed: Computed, name: str, choice: str) -> Chart:
    """The picture of a chart of the page.

    choice : what is chosen in it.

    Raises
    ------
    UsageError : there is no such chart.
    EquipoiseError : it cannot be drawn of this machine.
    """
    machine, analysis = computed.analysis.machine, computed.analysis
    if name == "response":
        from equipoise.figures.vibration import response_charts

        return _named(response_charts(responded(computed)), f"gauge-{choice}")
    if name == "sweep":
        from equipoise.figures.sweep import sweep_charts
        from equipoise.vibration.resonance import around
        from equipoise.vibration.sweep import sweep_speed

        speeds = around(machine.drive, machine.drive.speed)
        return _named(sweep_charts(sweep_speed(machine, *speeds)), "response")
    if name in SAME:
        from equipoise.figures.pictures import analysis_pictures

        return _named(analysis_pictures(analysis), SAME[name])
    return _over_crank(computed, choice)


def _named(pictures: Mapping[str, Chart], name: str) -> Chart:
    if name not in pictures:
        raise UsageError(unknown(name, pictures, "picture"))
    return pictures[name]


def _over_crank(computed: Computed, output: str) -> Chart:
    """An output over the crank angle; of all rows together where it is only there."""
    from equipoise.figures.analysis import ALL
    from equipoise.figures.forces import over_crank
    from equipoise.mechanism.parts.objectives import ROWS
    from equipoise.web.figures import capital

    outputs = computed.analysis.outputs
    item = outputs[f"{ROWS}{output}" if f"{ROWS}{output}" in outputs else output]
    label = item.label()
    what = [(label, item.dimension, {ALL: item.drawn})]
    return replace(over_crank(computed.analysis, "output", capital(label), what), keys=())


def linkage_at(computed: Computed, sample: int) -> Chart:
    """The drawing at a sample of the crank angle.

    Raises
    ------
    UsageError : there is no such sample.
    """
    from equipoise.figures.linkage import linkage

    angles = computed.motion.crank_angle
    if not 0 <= sample < len(angles):
        raise UsageError(
            Note(
                "got {sample} as sample of the crank angle; give 0 to {last}",
                sample=sample,
                last=len(angles) - 1,
            )
        )
    return linkage(computed.analysis, [float(angles[sample])])


def film_of(computed: Computed) -> bytes:
    """The whole cycle as a GIF, the support too where it moves."""
    from equipoise.figures.film import gif
    from equipoise.figures.points import followed
    from equipoise.figures.stage import in_a_turn, smooth
    from equipoise.figures.swing import moving
    from equipoise.results.analysis import analyze

    analysis = analyze(computed.analysis.machine, smooth(in_a_turn("gif", SECONDS)))
    with drawing:
        scene, _ = moving(analysis)
        return gif(scene, traced=followed(analysis.motion), seconds=SECONDS)
