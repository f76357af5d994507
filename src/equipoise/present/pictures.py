"""Every picture of what can be told of a file: its name, its place, its caption, how to draw it."""

from __future__ import annotations

import os
import sys
import threading
import warnings
from collections.abc import Callable, Collection, Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any

from equipoise.figures import render
from equipoise.i18n import say, to_say
from equipoise.present.findings import Findings, ToolFindings
from equipoise.results.blocks import Drawn

if TYPE_CHECKING:
    from multiprocessing.connection import Connection

    from equipoise.figures import Picture as Drawing
    from equipoise.results.charts import Chart

Entry = tuple[str, str, Callable[[], "Drawing"]]
"""Name, caption, and what draws it."""
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

    parts: dict[str, Callable[[Any], Iterator[Entry]]] = {"tool": _of_tool}
    if isinstance(found, Findings):
        parts = {"motion": partial(_motion, at=at), **OF_LINKAGE}
    taken: dict[str, None] = {}
    for section in (name for name in parts if name in sections):
        for name, caption, draw in parts[section](found):
            own = free_name(name, taken)
            taken[own] = None
            yield Picture(own, section, caption, draw)


def pages(name: str, caption: str, make: Callable[[], Iterable[Chart]]) -> Iterator[Entry]:
    """What goes on over several pictures; how many, only their charts tell."""
    for number, chart in enumerate(make(), 1):
        yield name if number == 1 else f"{name}-{number}", caption, partial(_made, chart)


def _made(chart: Chart) -> Chart:
    return chart


# -- of a linkage; nothing of what it does not have ------------------------------------------------


def _motion(found: Findings, at: Sequence[float] | None) -> Iterator[Entry]:
    from equipoise.figures.linkage import centrodes, linkage, rolling
    from equipoise.figures.points import curves, hodograph, main_kinematics

    analysis = found.analysis
    caption = to_say("The linkage to scale, with its joints, links and centres of mass.")
    yield "linkage", caption, partial(linkage, analysis, at)
    caption = to_say("Paths of the points of the moving links, with marks at equal times.")
    yield "curves", caption, partial(curves, analysis)
    caption = to_say("Velocity and acceleration of these points: the ends of their arrows.")
    yield "hodograph", caption, partial(hodograph, analysis)
    if rolling(analysis):
        caption = to_say("Centrodes: paths of instant centres in the frame and in the link.")
        yield "centrodes", caption, partial(centrodes, analysis)
    caption = to_say("Motion over crank angle: position, velocity and acceleration.")
    for chart in main_kinematics(analysis) if len(analysis.crank_angle) > 1 else ():
        yield chart.name, caption, partial(_made, chart)


def _planting(found: Findings) -> Iterator[Entry]:
    figures = found.planting
    if figures is None:
        return
    from equipoise.figures.path import path
    from equipoise.figures.planting import joints, ratio, tips, torque

    caption = to_say("Path of the planting finger relative to the machine and over the ground.")
    yield "path", caption, partial(path, figures)
    caption = to_say("Angular velocity of a link over that of the crank.")
    for link in figures.machine.links:
        if link != figures.machine.drive.link:
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
    analysis = found.analysis
    if analysis.solved is None:
        return
    from equipoise.figures import forces

    caption = to_say("Shaking force as a polar diagram: the end of its arrow over the cycle.")
    yield "polar", caption, partial(forces.polar, analysis)
    caption = to_say("Shaking force over crank angle.")
    yield "force", caption, partial(forces.force, analysis)
    caption = to_say("Shaking moment over crank angle.")
    yield "moment", caption, partial(forces.moment, analysis)
    caption = to_say("Drive torque over crank angle, and what it is for.")
    yield "torque", caption, partial(forces.torque, analysis)
    if analysis.has_orders:
        caption = to_say("Shaking force, shaking moment and drive torque by orders of the crank.")
        yield "spectrum", caption, partial(forces.spectrum, analysis)


def _joints(found: Findings) -> Iterator[Entry]:
    if found.analysis.solved is None:
        return
    from equipoise.figures.analysis import joint_polars, joints

    caption = to_say("Forces in the joints over crank angle.")
    yield from pages("joints", caption, partial(joints, found.analysis))
    caption = to_say("Forces in the joints as polar diagrams: the ends of their arrows.")
    yield from pages("joint-polars", caption, partial(joint_polars, found.analysis))


def _vibration(found: Findings) -> Iterator[Entry]:
    from equipoise.figures import sweep, vibration

    if (response := found.response) is not None:
        caption = to_say("Vibration at a gauge of the support over a cycle.")
        for name in response.gauges:
            yield f"gauge-{name}", caption, partial(vibration.gauge, response, name)
        caption = to_say("Vibration at the gauges by orders of the crank.")
        yield from pages("gauge-spectrum", caption, partial(vibration.spectra, response))
        caption = to_say("Forces in the mounts over a cycle.")
        yield from pages("mounts", caption, partial(vibration.mounts, response))
        caption = to_say("Torque and speed of the drive on the moving support.")
        yield "drive", caption, partial(vibration.drive, response)
    if (over_speed := found.sweep) is not None:
        caption = to_say("Vibration at the gauges against speed.")
        for quantity in ("displacement", "velocity", "acceleration"):
            yield f"response-{quantity}", caption, partial(sweep.gauges, over_speed, quantity)
        caption = to_say("Where orders of the crank meet natural frequencies.")
        yield "resonance-map", caption, partial(sweep.resonance_map, over_speed)
        if over_speed.mounts:
            caption = to_say("Forces in the mounts against speed.")
            yield "mounts-speed", caption, partial(sweep.mounts, over_speed)


def _modes(found: Findings) -> Iterator[Entry]:
    from equipoise.figures.modes import mode_chart

    if found.modes is not None:
        caption = to_say("Shape of a natural vibration of the machine on its support.")
        for number in range(1, len(found.modes.modes) + 1):
            yield f"mode-{number}", caption, partial(mode_chart, found.modes, number)


def _balance(found: Findings) -> Iterator[Entry]:
    balanced = found.balanced
    if balanced is None or not found.helped:
        return
    from equipoise.figures.aims import aims
    from equipoise.figures.balancing import phases, signals, together
    from equipoise.figures.changes import changes

    of_linkage = any(change.kind != "phases" for change in balanced.changes)
    if of_linkage:
        yield "changes", to_say("What to change, to scale."), partial(changes, balanced)
    caption = to_say("What was made small or limited, before and after, by crank angle and order.")
    yield from pages("aims", caption, partial(aims, balanced))
    if of_linkage:
        captions = {
            "force": to_say("Shaking force, before and after."),
            "polar": to_say("Shaking force as a polar diagram, before and after."),
            "moment": to_say("Shaking moment, before and after."),
            "torque": to_say("Drive torque, before and after."),
        }
        for name, chart in signals(balanced).items():
            yield f"balanced-{name}", captions[name], partial(_made, chart)
    if balanced.phasing is not None:
        both = balanced.original, balanced.machine
        yield "phases", to_say("Phases of the rows."), partial(phases, *both)
        caption = to_say("Shaking force of all rows together, before and after.")
        yield "rows", caption, partial(together, *both)


OF_LINKAGE: dict[str, Callable[[Findings], Iterator[Entry]]] = {
    "planting": _planting,
    "forces": _forces,
    "joints": _joints,
    "vibration": _vibration,
    "modes": _modes,
    "balance": _balance,
}


def _of_tool(found: ToolFindings) -> Iterator[Entry]:
    from equipoise.figures import tool_designs, tool_shaft, tool_side, tool_speeds

    modes, transmission = found.modes, found.transmission
    planes = ("", "-lateral")[: 1 if found.tool.alike else 2]
    caption = to_say("The tool from the side, at rest and as it is deflected at work.")
    yield "side", caption, partial(tool_side.side, found.tool)
    if modes is not None:
        caption = to_say("The tool from the side in its lowest natural vibrations.")
        yield "side-modes", caption, partial(tool_side.side_modes, modes)
        caption = to_say("Shapes of the natural vibrations of the shaft.")
        for plane, name in enumerate(planes):
            drawn = partial(tool_shaft.shapes, modes, plane)
            yield from pages(f"modes{name}", caption, drawn)
    if transmission is not None:
        caption = to_say("Share of a shaking force that comes to what holds the tool.")
        for plane, name in enumerate(planes):
            draw = partial(tool_speeds.transmission, transmission, plane, modes)
            yield f"transmission{name}", caption, draw
    if found.sweep is not None and found.sweep.response is not None:
        caption = to_say("Bending moment and displacement along the shaft.")
        yield "moment", caption, partial(tool_shaft.moment, found.sweep.response, None)
    if found.exposure is not None:
        caption = to_say("Acceleration of the hands against speed of the engine.")
        yield "acceleration", caption, partial(tool_speeds.acceleration, found.exposure)
        caption = to_say("Daily exposure of the hands, with what is allowed.")
        yield "exposure", caption, partial(tool_speeds.weighted, found.exposure)
    if found.design is not None:
        caption = to_say("The tool from the side before and after what is changed.")
        yield "side-design", caption, partial(tool_side.side_design, found.design)
        caption = to_say(
            "What the hand that gets most gets over the band of speeds, before and after."
        )
        yield "design", caption, partial(tool_designs.design, found.design)


# -- drawn by two processes where that is safe: it takes half the time -----------------------------

Drawings = dict[str, list[Drawn]]
"""Pictures by section."""


def drawings(found: Findings | ToolFindings, together: bool = False) -> Drawings:
    """All pictures.

    together : whether a copy of this process may draw half of them, where there are two processors,
        Linux, and no other thread, which the copy would lack.
    """
    processors = len(os.sched_getaffinity(0)) if sys.platform == "linux" else 1
    may_fork = together and processors > 1 and threading.active_count() == 1
    other = _others(found) if may_fork else ()
    if not other:
        return _draw(found, SECTIONS)
    _ = found.notes  # everything that both need is computed once
    import multiprocessing

    context = multiprocessing.get_context("fork")
    here, there = context.Pipe(duplex=False)
    helper = context.Process(target=_send, args=(there, found, other), daemon=True)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", DeprecationWarning)  # threads of BLAS can be forked
        helper.start()
    there.close()
    try:
        drawn = _draw(found, [section for section in SECTIONS if section not in other])
        of_helper: Drawings = here.recv()
        return drawn | of_helper
    except EOFError:  # the helper failed, and what it failed of is to be told
        return drawn | _draw(found, other)
    finally:
        helper.kill()
        helper.join()


def _others(found: Findings | ToolFindings) -> Collection[str]:
    """Sections that hold about half of the pictures."""
    if isinstance(found, ToolFindings):
        return ()
    if found.response is not None:
        return ("vibration",) if found.planting is None else ("vibration", "modes", "balance")
    return ("motion", "forces") if found.planting is None else ("motion", "planting")


def _send(pipe: Connection, found: Findings | ToolFindings, sections: Collection[str]) -> None:
    try:
        pipe.send(_draw(found, sections))
    except BaseException:  # what goes wrong here goes wrong again where it can be told
        pipe.close()


def _draw(found: Findings | ToolFindings, sections: Collection[str]) -> Drawings:
    drawn: Drawings = {}
    for picture in each(found, sections=sections):
        svg = render(picture.draw()).decode()
        block = Drawn(picture.name, say(picture.caption), svg)
        drawn.setdefault(picture.section, []).append(block)
    return drawn
