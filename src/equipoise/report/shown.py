"""What pictures there are of a linkage, and what is written below each."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import partial
from typing import TYPE_CHECKING

from equipoise.figures.pictures import drawn
from equipoise.i18n import to_say
from equipoise.report.findings import Findings

if TYPE_CHECKING:
    from equipoise.balancing.balanced import Balanced
    from equipoise.figures import Picture
    from equipoise.planting.summary import PlantingFigures
    from equipoise.results.charts import Chart
    from equipoise.vibration.response import Response
    from equipoise.vibration.sweep import Sweep

Entry = tuple[str, str, Callable[[], "Picture"]]
"""Name, caption, and what makes it."""
Part = tuple[str, Iterable[Entry]]
"""A section and its pictures."""


def of_linkage(found: Findings, at: Sequence[float] | None) -> Iterator[Part]:
    """Sections of a linkage; those that it has nothing for are empty."""
    yield "motion", _motion(found, at)
    if found.planting is not None:
        yield "planting", _planting(found.planting)
    if found.analysis.solved is not None:
        yield "forces", _forces(found)
        yield "joints", _joints(found)
    if found.response is not None:
        yield "vibration", _vibration(found.response)
    if found.sweep is not None:
        yield "vibration", _speeds(found.sweep)
    if found.modes is not None:
        yield "modes", _modes(found)
    if found.balanced is not None and found.helped:
        yield "balance", _balance(found.balanced)


def pages(name: str, caption: str, make: Callable[[], Iterable[Chart]]) -> Iterator[Entry]:
    """What goes on over several pictures; how many, only their charts tell."""
    for number, chart in enumerate(make(), 1):
        yield name if number == 1 else f"{name}-{number}", caption, partial(_made, chart)


def _made(chart: Chart) -> Chart:
    return chart


def _motion(found: Findings, at: Sequence[float] | None) -> Iterator[Entry]:
    from equipoise.figures.analysis import curves, hodograph
    from equipoise.plotting.analysis.linkage import linkage_figure

    analysis = found.analysis
    caption = to_say("The linkage to scale, with its joints, links and centres of mass.")
    yield "linkage", caption, partial(drawn, linkage_figure, analysis, at)
    caption = to_say("Paths of the points of the moving links, with marks at equal times.")
    yield "curves", caption, partial(curves, analysis)
    caption = to_say("Velocity and acceleration of these points: the ends of their arrows.")
    yield "hodograph", caption, partial(hodograph, analysis)


def _planting(figures: PlantingFigures) -> Iterator[Entry]:
    from equipoise.figures.planting import joints, ratio, tips, torque
    from equipoise.plotting.pathview import path_figure

    caption = to_say("Path of the planting finger relative to the machine and over the ground.")
    yield "path", caption, partial(drawn, path_figure, figures)
    machine = figures.machine
    caption = to_say("Angular velocity of a link over that of the crank.")
    for link in machine.links:
        if link != machine.drive.link:
            yield f"ratio-{link}", caption, partial(ratio, figures, link)
    caption = to_say("Velocity and acceleration of the finger's tip relative to the machine.")
    for chart in tips(figures):
        yield f"tip-{chart.name}", caption, partial(_made, chart)
    if figures.forces is not None:
        caption = to_say("Drive torque with and without the forces of the soil.")
        yield "soil-torque", caption, partial(torque, figures)
        caption = to_say("Forces in the joints with and without the forces of the soil.")
        yield "soil-joints", caption, partial(joints, figures)


def _forces(found: Findings) -> Iterator[Entry]:
    from equipoise.figures import analysis as view

    analysis = found.analysis
    caption = to_say("Shaking force as a polar diagram: the end of its arrow over the cycle.")
    yield "polar", caption, partial(view.polar, analysis)
    caption = to_say("Shaking force over crank angle.")
    yield "force", caption, partial(view.force, analysis)
    caption = to_say("Shaking moment over crank angle.")
    yield "moment", caption, partial(view.moment, analysis)
    caption = to_say("Drive torque over crank angle, and what it is for.")
    yield "torque", caption, partial(view.torque, analysis)
    if view.has_orders(analysis):
        caption = to_say("Shaking force, shaking moment and drive torque by orders of the crank.")
        yield "spectrum", caption, partial(view.spectrum, analysis)


def _joints(found: Findings) -> Iterator[Entry]:
    from equipoise.figures.joints import joint_polars, joints

    caption = to_say("Forces in the joints over crank angle.")
    yield from pages("joints", caption, partial(joints, found.analysis))
    caption = to_say("Forces in the joints as polar diagrams: the ends of their arrows.")
    yield from pages("joint-polars", caption, partial(joint_polars, found.analysis))


def _vibration(response: Response) -> Iterator[Entry]:
    from equipoise.figures.vibration import drive, gauge, mounts, spectra

    caption = to_say("Vibration at a gauge of the support over a cycle.")
    for name in response.gauges:
        yield f"gauge-{name}", caption, partial(gauge, response, name)
    caption = to_say("Vibration at the gauges by orders of the crank.")
    yield from pages("gauge-spectrum", caption, partial(spectra, response))
    caption = to_say("Forces in the mounts over a cycle.")
    yield from pages("mounts", caption, partial(mounts, response))
    caption = to_say("Torque and speed of the drive on the moving support.")
    yield "drive", caption, partial(drive, response)


def _speeds(sweep: Sweep) -> Iterator[Entry]:
    from equipoise.figures.sweep import gauges, mounts, resonance_map

    caption = to_say("Vibration at the gauges against speed.")
    for quantity in ("displacement", "velocity", "acceleration"):
        yield f"response-{quantity}", caption, partial(gauges, sweep, quantity)
    caption = to_say("Where orders of the crank meet natural frequencies.")
    yield "resonance-map", caption, partial(resonance_map, sweep)
    if sweep.mounts:
        caption = to_say("Forces in the mounts against speed.")
        yield "mounts-speed", caption, partial(mounts, sweep)


def _modes(found: Findings) -> Iterator[Entry]:
    from equipoise.plotting.vibration.modes import mode_figure

    free = found.modes
    assert free is not None
    caption = to_say("Shape of a natural vibration of the machine on its support.")
    for number in range(1, len(free.modes) + 1):
        yield f"mode-{number}", caption, partial(drawn, mode_figure, free, number)


def _balance(balanced: Balanced) -> Iterator[Entry]:
    from equipoise.figures.balancing import orders, phases, together
    from equipoise.plotting.balancing.changes import changes_figure

    if any(change.kind != "phases" for change in balanced.changes):
        yield (
            "changes",
            to_say("What to change, to scale."),
            partial(drawn, changes_figure, balanced),
        )
        yield from _before_and_after(balanced)
    caption = to_say("Orders of what was made small, before and after.")
    yield from pages("balanced-orders", caption, partial(orders, balanced))
    if balanced.phasing is not None:
        both = balanced.original, balanced.machine
        yield "phases", to_say("Phases of the rows."), partial(phases, *both)
        caption = to_say("Shaking force of all rows together, before and after.")
        yield "rows", caption, partial(together, *both)


def _before_and_after(balanced: Balanced) -> Iterator[Entry]:
    from equipoise.figures.balancing import signals

    captions = {
        "force": to_say("Shaking force, before and after."),
        "polar": to_say("Shaking force as a polar diagram, before and after."),
        "moment": to_say("Shaking moment, before and after."),
        "torque": to_say("Drive torque, before and after."),
    }
    for name, chart in signals(balanced).items():
        yield f"balanced-{name}", captions[name], partial(_made, chart)
