"""Every picture of what can be told of a file: its name, its place, its caption, how to draw it."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING

from equipoise.i18n import to_say
from equipoise.present.findings import Findings, ToolFindings

if TYPE_CHECKING:
    from equipoise.balancing.balanced import Balanced
    from equipoise.figures import Picture as Drawing
    from equipoise.handheld.exposed import ToolExposure
    from equipoise.handheld.modes import ToolModes
    from equipoise.handheld.sweep import Transmissions
    from equipoise.planting.summary import PlantingFigures
    from equipoise.results.charts import Chart
    from equipoise.vibration.response import Response
    from equipoise.vibration.sweep import Sweep

Entry = tuple[str, str, Callable[[], "Drawing"]]
"""Name, caption, and what draws it inside `plotting.style.styled`."""
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
    from equipoise.figures.linkage import linkage
    from equipoise.figures.outputs import main_kinematics
    from equipoise.figures.points import curves, hodograph

    analysis = found.analysis
    caption = to_say("The linkage to scale, with its joints, links and centres of mass.")
    yield "linkage", caption, partial(linkage, analysis, at)
    caption = to_say("Paths of the points of the moving links, with marks at equal times.")
    yield "curves", caption, partial(curves, analysis)
    caption = to_say("Velocity and acceleration of these points: the ends of their arrows.")
    yield "hodograph", caption, partial(hodograph, analysis)
    caption = to_say("Motion over crank angle: position, velocity and acceleration.")
    for chart in main_kinematics(analysis) if len(analysis.crank_angle) > 1 else ():
        yield chart.name, caption, partial(_made, chart)


def _planting(figures: PlantingFigures) -> Iterator[Entry]:
    from equipoise.figures.path import path
    from equipoise.figures.planting import joints, ratio, tips, torque

    caption = to_say("Path of the planting finger relative to the machine and over the ground.")
    yield "path", caption, partial(path, figures)
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
    from equipoise.figures import forces

    analysis = found.analysis
    caption = to_say("Shaking force as a polar diagram: the end of its arrow over the cycle.")
    yield "polar", caption, partial(forces.polar, analysis)
    caption = to_say("Shaking force over crank angle.")
    yield "force", caption, partial(forces.force, analysis)
    caption = to_say("Shaking moment over crank angle.")
    yield "moment", caption, partial(forces.moment, analysis)
    caption = to_say("Drive torque over crank angle, and what it is for.")
    yield "torque", caption, partial(forces.torque, analysis)
    if forces.has_orders(analysis):
        caption = to_say("Shaking force, shaking moment and drive torque by orders of the crank.")
        yield "spectrum", caption, partial(forces.spectrum, analysis)


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
    from equipoise.figures.modes import mode_chart

    free = found.modes
    assert free is not None
    caption = to_say("Shape of a natural vibration of the machine on its support.")
    for number in range(1, len(free.modes) + 1):
        yield f"mode-{number}", caption, partial(mode_chart, free, number)


def _balance(balanced: Balanced) -> Iterator[Entry]:
    from equipoise.figures.balancing import orders, phases, together
    from equipoise.figures.changes import changes

    if any(change.kind != "phases" for change in balanced.changes):
        yield (
            "changes",
            to_say("What to change, to scale."),
            partial(changes, balanced),
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


def of_tool(found: ToolFindings) -> Iterator[Part]:
    """The one section of a tool."""
    if found.modes is not None:
        yield "tool", _modes_of_tool(found.modes)
    if found.transmission is not None:
        yield "tool", _transmission(found.transmission, found.modes)
    yield "tool", _moment(found)
    if found.exposure is not None:
        yield "tool", _exposure(found.exposure)
    yield "tool", _design(found)


def _modes_of_tool(modes: ToolModes) -> Iterator[Entry]:
    from equipoise.figures.tool_shaft import shapes

    caption = to_say("Shapes of the natural vibrations of the shaft.")
    for plane, name in enumerate(("modes", "modes-lateral")[: 1 if modes.alike else 2]):
        yield from pages(name, caption, partial(shapes, modes, plane))


def _transmission(found: Transmissions, modes: ToolModes | None) -> Iterator[Entry]:
    from equipoise.figures.tool_speeds import transmission

    caption = to_say("Share of a shaking force that comes to what holds the tool.")
    planes = ("transmission", "transmission-lateral")[: 1 if found.tool.alike else 2]
    for plane, name in enumerate(planes):
        yield name, caption, partial(transmission, found, plane, modes)


def _moment(found: ToolFindings) -> Iterator[Entry]:
    if found.sweep is None or found.sweep.response is None:
        return
    from equipoise.figures.tool_shaft import moment

    caption = to_say("Bending moment and displacement along the shaft.")
    yield "moment", caption, partial(moment, found.sweep.response, None)


def _exposure(found: ToolExposure) -> Iterator[Entry]:
    from equipoise.figures.tool_speeds import acceleration, weighted

    caption = to_say("Acceleration of the hands against speed of the engine.")
    yield "acceleration", caption, partial(acceleration, found)
    caption = to_say("Daily exposure of the hands, with what is allowed.")
    yield "exposure", caption, partial(weighted, found)


def _design(found: ToolFindings) -> Iterator[Entry]:
    if found.design is None:
        return
    from equipoise.figures.tool_designs import design

    caption = to_say("What the hand that gets most gets over the band of speeds, before and after.")
    yield "design", caption, partial(design, found.design)


SECTIONS = ("motion", "planting", "forces", "joints", "vibration", "modes", "balance", "tool")
"""In the order in which they are shown."""


@dataclass(frozen=True)
class Picture:
    """A picture that is drawn when it is wanted.

    name : which also does for a file.  section : one of `SECTIONS`.
    caption : an English sentence, to be said when it is shown.
    """

    name: str
    section: str
    caption: str
    draw: Callable[[], Drawing]


def pictures(found: Findings | ToolFindings, at: Sequence[float] | None = None) -> list[Picture]:
    """All of them, in the order of `SECTIONS`.

    at : crank angles at which the linkage is drawn, rad; usual ones if None.
    """
    return list(each(found, at))


def each(
    found: Findings | ToolFindings,
    at: Sequence[float] | None = None,
    sections: Collection[str] = SECTIONS,
) -> Iterator[Picture]:
    """Those of some sections one by one: what only later ones need is not computed before."""
    from equipoise.figures.style import free_name

    parts = of_tool(found) if isinstance(found, ToolFindings) else of_linkage(found, at)
    taken: dict[str, None] = {}
    for section, entries in parts:
        if section not in sections:
            continue
        for name, caption, draw in entries:
            own = free_name(name, taken)
            taken[own] = None
            yield Picture(own, section, caption, draw)
