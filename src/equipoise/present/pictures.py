"""Every picture of a report: its name, its place, its caption, and how it is drawn."""

from __future__ import annotations

import os
import sys
import threading
import warnings
from collections.abc import Callable, Collection, Iterable, Iterator, Sequence
from functools import partial
from typing import TYPE_CHECKING, Any, NamedTuple

from equipoise.dataclass import dataclass
from equipoise.figures import standalone_svg
from equipoise.i18n import say, to_say
from equipoise.present import headlines, tool_summary
from equipoise.present import headlines as gauged
from equipoise.present.findings import Findings, ToolFindings
from equipoise.results.blocks import SvgPicture

if TYPE_CHECKING:
    from multiprocessing.connection import Connection

    from equipoise.figures import Picture as Drawing
    from equipoise.results.charts import Chart


class PictureEntry(NamedTuple):
    """Name, caption, what draws it, what is seen in it, and whether a report has it in its
    appendix.
    """

    name: str
    caption: str
    draw: Callable[[], Drawing]
    headline: Callable[[], str] = str
    detail: bool = False


def pages(
    name: str,
    caption: str,
    make: Callable[[], Iterable[Chart]],
    headline: Callable[[], str] = str,
    detail: bool = False,
) -> Iterator[PictureEntry]:
    """Entries of charts that go on over several pictures; their number is known once made."""
    for number, chart in enumerate(make(), 1):
        if number == 1:
            yield PictureEntry(name, caption, partial(unchanged, chart), headline, detail)
        else:
            yield PictureEntry(
                f"{name}-{number}", caption, partial(unchanged, chart), detail=detail
            )


def unchanged(chart: Chart) -> Chart:
    return chart


def of_tool(findings: ToolFindings) -> Iterator[PictureEntry]:
    """The tool itself, modes, transmission, what the hands get, and the design."""
    from equipoise.figures import tool_charts, tool_side

    modes, transmission = findings.modes, findings.transmission
    planes = ("", "-lateral")[: 1 if findings.tool.alike else 2]
    caption = to_say("The tool from the side, at rest and as it is deflected at work.")
    yield PictureEntry("side", caption, partial(tool_side.side, findings.tool))
    if modes is not None:
        caption = to_say("The tool from the side in its lowest natural vibrations.")
        draw = partial(tool_side.side_modes, modes)
        yield PictureEntry("side-modes", caption, draw, detail=True)
        caption = to_say("Shapes of the natural vibrations of the shaft.")
        for plane, name in enumerate(planes):
            shapes_chart = partial(tool_charts.shapes, modes, plane)
            value = partial(tool_summary.lowest, modes, plane)
            yield from pages(f"modes{name}", caption, shapes_chart, value, detail=True)
    if transmission is not None:
        caption = to_say("Share of a shaking force that comes to what holds the tool.")
        for plane, name in enumerate(planes):
            draw = partial(tool_charts.transmission, transmission, plane, modes)
            value = partial(tool_summary.passed, transmission, plane)
            yield PictureEntry(f"transmission{name}", caption, draw, value, plane > 0)
    if findings.sweep is not None and findings.sweep.response is not None:
        caption = to_say("Bending moment and displacement along the shaft.")
        draw = partial(tool_charts.moment, findings.sweep.response, None)
        yield PictureEntry("moment", caption, draw, detail=True)
    if findings.exposure is not None:
        caption = to_say("Acceleration of the hands against speed of the engine.")
        yield PictureEntry(
            "acceleration",
            caption,
            partial(tool_charts.acceleration, findings.exposure),
            partial(tool_summary.worst, findings),
            detail=True,
        )
        caption = to_say("Daily exposure of the hands, with what is allowed.")
        yield PictureEntry(
            "exposure",
            caption,
            partial(tool_charts.weighted, findings.exposure),
            partial(tool_summary.judged, findings),
        )
    if findings.design is not None:
        caption = to_say("The tool from the side before and after what is changed.")
        yield PictureEntry("side-design", caption, partial(tool_side.side_design, findings.design))
        caption = to_say("Vibration of the worst hand over the band of speeds, before and after.")
        yield PictureEntry(
            "design",
            caption,
            partial(tool_charts.design, findings.design),
            partial(tool_summary.improved, findings),
        )


SECTIONS = (
    *("model", "motion", "planting", "forces", "joints", "run", "vibration", "modes", "balance"),
    "tool",
)
"""In the order in which they are shown."""


@dataclass(frozen=True)
class LazyPicture:
    """A picture that is drawn when it is wanted.

    name : which also does for a file.  section : one of `SECTIONS`.
    caption : an English sentence on what it is, to be said when it is shown.
    headline : states the result that it shows, in a line as of `headlines`; may be empty.
    detail : whether a report has it in its appendix.
    """

    name: str
    section: str
    caption: str
    draw: Callable[[], Drawing]
    headline: Callable[[], str] = str
    detail: bool = False


def pictures(
    findings: Findings | ToolFindings, at: Sequence[float] | None = None
) -> list[LazyPicture]:
    """All of them, in the order of `SECTIONS`.

    at : crank angles at which the linkage is drawn, rad; usual ones if None.
    """
    return list(each(findings, at))


def each(
    findings: Findings | ToolFindings,
    at: Sequence[float] | None = None,
    sections: Collection[str] = SECTIONS,
) -> Iterator[LazyPicture]:
    """Pictures of some sections one by one: what only later ones need is not computed before."""
    from equipoise.figures.style import free_name

    parts: dict[str, Callable[[Any], Iterator[PictureEntry]]] = {"tool": of_tool}
    if isinstance(findings, Findings):
        parts = {"model": partial(_model, at=at), **OF_LINKAGE}
    taken: dict[str, None] = {}
    for section in (name for name in parts if name in sections):
        for entry in parts[section](findings):
            own = free_name(entry.name, taken)
            taken[own] = None
            yield LazyPicture(own, section, *entry[1:])


# -- of a linkage; nothing of what it does not have ------------------------------------------------


def _model(findings: Findings, at: Sequence[float] | None) -> Iterator[PictureEntry]:
    from equipoise.figures.linkage import linkage
    from equipoise.figures.side import side

    caption = to_say("The linkage to scale, with its joints, links and centres of mass.")
    draw = partial(linkage, findings.analysis, at)
    value = partial(headlines.heaviest, findings.analysis)
    yield PictureEntry("linkage", caption, draw, value, True)
    if findings.analysis.machine.has_planes:
        caption = to_say("The planes of links, masses and bearings, from the side and to scale.")
        yield PictureEntry("side", caption, partial(side, findings.analysis, at))


def _motion(findings: Findings) -> Iterator[PictureEntry]:
    from equipoise.figures.linkage import centrodes, rolling
    from equipoise.figures.motion import coupling_ratios, curves, hodograph, main_kinematics

    analysis = findings.analysis
    caption = to_say("Paths of the points of the moving links, with marks at equal times.")
    yield PictureEntry(
        "curves", caption, partial(curves, analysis), partial(headlines.longest, analysis)
    )
    caption = to_say("Velocity and acceleration of these points: the ends of their arrows.")
    yield PictureEntry(
        "hodograph",
        caption,
        partial(hodograph, analysis),
        partial(headlines.fastest, analysis),
        True,
    )
    if links := rolling(analysis):
        caption = to_say("Centrodes: paths of instant centres in the frame and in the link.")
        yield PictureEntry("centrodes", caption, partial(centrodes, analysis, links), detail=True)
    caption = to_say("Motion over crank angle: position, velocity and acceleration.")
    charts = main_kinematics(analysis) if len(analysis.crank_angle) > 1 else ()
    for number, chart in enumerate(charts):
        value = partial(headlines.kinematic, analysis, chart.name)
        yield PictureEntry(chart.name, caption, partial(unchanged, chart), value, number > 0)
    caption = to_say("Speed ratio over crank angle.")
    for chart in coupling_ratios(analysis) if len(analysis.crank_angle) > 1 else ():
        yield PictureEntry(chart.name, caption, partial(unchanged, chart), detail=True)


def _planting(findings: Findings) -> Iterator[PictureEntry]:
    figures = findings.planting
    if figures is None:
        return
    from equipoise.figures.planting import joints, path, ratio, tips, torque

    caption = to_say("Path of the planting finger relative to the machine and over the ground.")
    yield PictureEntry("path", caption, partial(path, figures), partial(headlines.planted, figures))
    caption = to_say("Angular velocity of a link over that of the crank.")
    for link in figures.machine.links:
        if link != figures.machine.drive.link:
            yield PictureEntry(
                f"ratio-{link}",
                caption,
                partial(ratio, figures, link),
                partial(headlines.geared, findings.analysis, link),
                detail=True,
            )
    caption = to_say("Velocity and acceleration of the finger's tip relative to the machine.")
    for chart in tips(figures):
        yield PictureEntry(f"tip-{chart.name}", caption, partial(unchanged, chart), detail=True)
    if figures.forces is not None:
        caption = to_say("Drive torque with and without the forces of the soil.")
        yield PictureEntry(
            "soil-torque", caption, partial(torque, figures), partial(headlines.resisted, figures)
        )
        caption = to_say("Forces in the joints with and without the forces of the soil.")
        yield PictureEntry("soil-joints", caption, partial(joints, figures), detail=True)


def _forces(findings: Findings) -> Iterator[PictureEntry]:
    analysis = findings.analysis
    if not analysis.has_forces:
        return
    from equipoise.figures import forces

    caption = to_say("Shaking force as a polar diagram: the end of its arrow over the cycle.")
    yield PictureEntry(
        "polar", caption, partial(forces.polar, analysis), partial(headlines.pushed, findings), True
    )
    caption = to_say("Shaking force over crank angle.")
    yield PictureEntry(
        "force",
        caption,
        partial(forces.force, analysis),
        partial(headlines.peaked, analysis, "shaking_force", "force"),
    )
    caption = to_say("Shaking moment over crank angle.")
    yield PictureEntry(
        "moment",
        caption,
        partial(forces.moment, analysis),
        partial(headlines.peaked, analysis, "shaking_moment", "torque"),
    )
    drives, pushes = analysis.machine.driven, analysis.machine.drive.pushes
    of_torque = to_say("Drive torque over crank angle, and what it is for.")
    of_force = to_say("Drive force over crank angle, and what it is for.")
    for number, drive in enumerate(drives, 1):
        yield PictureEntry(
            "torque" if number == 1 else f"torque-{number}",
            of_force if drive.pushes else of_torque,
            partial(forces.torque, analysis, number),
            partial(headlines.caused, analysis, number),
        )
    if analysis.has_orders:
        of_torque = to_say(
            "Shaking force, shaking moment and drive torque by orders of the crank angle."
        )
        of_force = to_say(
            "Shaking force, shaking moment and drive force by orders of the crank angle."
        )
        caption = of_force if pushes else of_torque
        yield PictureEntry(
            "spectrum",
            caption,
            partial(forces.spectrum, analysis),
            partial(headlines.ordered, findings),
            detail=True,
        )


def _joints(findings: Findings) -> Iterator[PictureEntry]:
    if not findings.analysis.has_forces or not findings.analysis.forces.joints:
        return
    from equipoise.figures.forces import joint_polars, joints
    from equipoise.figures.link_strength import link_charts
    from equipoise.figures.motion import coupling_curves

    for chart, caption in coupling_curves(findings.analysis):
        yield PictureEntry(chart.name, caption, partial(unchanged, chart), detail=True)
    caption = to_say("Forces in the joints over crank angle.")
    yield from pages(
        "joints",
        caption,
        partial(joints, findings.analysis),
        partial(headlines.joint_peaked, findings.analysis),
        detail=True,
    )
    caption = to_say("Forces in the joints as polar diagrams: the ends of their arrows.")
    yield from pages(
        "joint-polars",
        caption,
        partial(joint_polars, findings.analysis),
        partial(headlines.joint_acting, findings.analysis),
        detail=True,
    )
    for chart, caption in link_charts(findings.analysis):
        yield PictureEntry(chart.name, caption, partial(unchanged, chart), detail=True)


RUN_CAPTIONS = {
    "speed": to_say("Speed and torque over the time of the run."),
    "gauges": to_say("Displacement at the gauges over the time of the run."),
    "mounts": to_say("Forces in the mounts over the time of the run."),
}
"""By the kinds of charts that a run has."""


def _run(findings: Findings) -> Iterator[PictureEntry]:
    if findings.run is None:
        return
    for chart in findings.run.charts().values():
        kind = chart.name.partition("-")[0]
        name = "run" if kind == "speed" else f"run-{chart.name}"
        yield PictureEntry(name, RUN_CAPTIONS[kind], partial(unchanged, chart))


def _vibration(findings: Findings) -> Iterator[PictureEntry]:
    from equipoise.figures import sweep, vibration

    if (response := findings.response) is not None:
        caption = to_say("Vibration at a gauge of the support over a cycle.")
        for number, name in enumerate(response.gauges):
            yield PictureEntry(
                f"gauge-{name}",
                caption,
                partial(vibration.gauge, response, name),
                partial(gauged.moved, response, name),
                number > 0,
            )
        caption = to_say("Vibration at the gauges by orders of the crank angle.")
        yield from pages(
            "gauge-spectrum",
            caption,
            partial(vibration.spectra, response),
            partial(gauged.loudest_gauge, response),
            detail=True,
        )
        caption = to_say("Forces in the mounts over a cycle.")
        yield from pages(
            "mounts",
            caption,
            partial(vibration.mounts, response),
            partial(gauged.mounted, response),
            detail=True,
        )
        caption = to_say("Torque and speed of the drive on the moving support.")
        yield PictureEntry(
            "drive",
            caption,
            partial(vibration.drive, response),
            partial(gauged.driven, response),
            detail=True,
        )
    if (over_speed := findings.sweep) is not None:
        caption = to_say("Vibration at the gauges against speed.")
        for quantity in ("displacement", "velocity", "acceleration"):
            yield PictureEntry(
                f"response-{quantity}",
                caption,
                partial(sweep.gauges, over_speed, quantity),
                partial(gauged.resonant, over_speed, quantity),
                detail=quantity != "velocity",
            )
        caption = to_say("Where orders of the crank meet natural frequencies.")
        yield PictureEntry(
            "resonance-map",
            caption,
            partial(sweep.resonance_map, over_speed),
            partial(gauged.met, over_speed, findings.machine.drive.speed),
            detail=True,
        )
        if over_speed.mounts:
            caption = to_say("Forces in the mounts against speed.")
            draw = partial(sweep.mounts, over_speed)
            yield PictureEntry("mounts-speed", caption, draw, detail=True)


def _modes(findings: Findings) -> Iterator[PictureEntry]:
    from equipoise.figures.modes import mode_chart

    if findings.modes is not None:
        caption = to_say("Shape of a natural vibration of the machine on its support.")
        for number in range(1, len(findings.modes.modes) + 1):
            yield PictureEntry(
                f"mode-{number}",
                caption,
                partial(mode_chart, findings.modes, number),
                partial(gauged.swung, findings.modes, number),
                detail=True,
            )


def _balance(findings: Findings) -> Iterator[PictureEntry]:
    balanced = findings.balanced
    if balanced is None or not findings.helped:
        return
    from equipoise.figures.balancing import aims, combined, phases, signals
    from equipoise.figures.changes import changes

    of_linkage = any(change.kind != "phases" for change in balanced.changes)
    if of_linkage:
        caption, draw = to_say("What to change, to scale."), partial(changes, balanced)
        yield PictureEntry("changes", caption, draw, partial(headlines.added, findings))
    caption = to_say("Objectives and limited outputs, before and after, by crank angle and order.")
    yield from pages("aims", caption, partial(aims, balanced), partial(headlines.reached, balanced))
    if of_linkage:
        captions = {
            "force": to_say("Shaking force, before and after."),
            "polar": to_say("Shaking force as a polar diagram, before and after."),
            "moment": to_say("Shaking moment, before and after."),
            "torque": to_say("Drive force, before and after.")
            if balanced.machine.drive.pushes
            else to_say("Drive torque, before and after."),
        }
        for name, chart in signals(balanced).items():
            yield PictureEntry(
                f"balanced-{name}",
                captions[name],
                partial(unchanged, chart),
                partial(headlines.compared, findings, name),
                detail=True,
            )
    if balanced.phasing is not None:
        both = balanced.original, balanced.machine
        yield PictureEntry("phases", to_say("Phases of the rows."), partial(phases, *both))
        caption = to_say("Shaking force of all rows together, before and after.")
        yield PictureEntry(
            "rows",
            caption,
            partial(combined, *both),
            partial(headlines.compared, findings, "rows"),
            True,
        )


OF_LINKAGE: dict[str, Callable[[Findings], Iterator[PictureEntry]]] = {
    "motion": _motion,
    "planting": _planting,
    "forces": _forces,
    "joints": _joints,
    "run": _run,
    "vibration": _vibration,
    "modes": _modes,
    "balance": _balance,
}


Drawings = dict[str, list[SvgPicture]]
"""Pictures by section."""


def drawings(
    findings: Findings | ToolFindings, parallel: bool = False, by_rows: bool = False
) -> Drawings:
    """All pictures.

    parallel : whether a copy of this process may draw half of them, where there are two processors,
        Linux, and no other thread, which the copy would lack.
    by_rows : whether high ones are drawn by rows of their panels too; see `SvgPicture`.
    """
    processors = len(os.sched_getaffinity(0)) if sys.platform == "linux" else 1
    may_fork = parallel and processors > 1 and threading.active_count() == 1
    other = _others(findings) if may_fork else ()
    if not other:
        return _draw(findings, SECTIONS, by_rows)
    _ = findings.notes  # everything that both need is computed once
    import multiprocessing

    context = multiprocessing.get_context("fork")
    here, there = context.Pipe(duplex=False)
    args = there, findings, other, by_rows
    helper = context.Process(target=_send, args=args, daemon=True)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", DeprecationWarning)  # threads of BLAS can be forked
        helper.start()
    there.close()
    try:
        rest = [section for section in SECTIONS if section not in other]
        pictures = _draw(findings, rest, by_rows)
        of_helper: Drawings = here.recv()
        return pictures | of_helper
    except EOFError:  # the helper failed: drawing here raises its error again
        return pictures | _draw(findings, other, by_rows)
    finally:
        helper.kill()
        helper.join()


def _others(findings: Findings | ToolFindings) -> Collection[str]:
    """Sections that hold about half of the pictures."""
    if isinstance(findings, ToolFindings):
        return ()
    if findings.response is not None:
        return ("vibration",) if findings.planting is None else ("vibration", "modes", "balance")
    return ("motion", "forces") if findings.planting is None else ("motion", "planting")


def _send(
    pipe: Connection,
    findings: Findings | ToolFindings,
    sections: Collection[str],
    by_rows: bool,
) -> None:
    try:
        pipe.send(_draw(findings, sections, by_rows))
    except BaseException:  # the main process draws again, and raises the error there
        pipe.close()


def _draw(findings: Findings | ToolFindings, sections: Collection[str], by_rows: bool) -> Drawings:
    pictures: Drawings = {}
    for picture in each(findings, sections=sections):
        chart = picture.draw()
        text = say("; ").join((chart.what, *chart.words))
        svg, wide, rows, narrow = standalone_svg(chart, by_rows)
        headline, caption = picture.headline(), say(picture.caption)
        block = SvgPicture(
            picture.name, text, svg, headline, caption, wide, picture.detail, rows, narrow
        )
        pictures.setdefault(picture.section, []).append(block)
    return pictures
