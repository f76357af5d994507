"""Every picture of a report: its chart, its place, and what is seen in it."""

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
from equipoise.i18n import say
from equipoise.present import headlines
from equipoise.present.findings import Findings, ToolFindings
from equipoise.results.blocks import SvgPicture

if TYPE_CHECKING:
    from multiprocessing.connection import Connection

    from equipoise.results.charts import Chart


class _Picture(NamedTuple):
    """A chart, what is seen in it, and whether a report has it in its appendix."""

    chart: Chart
    headline: Callable[[], str] = str
    detail: bool = False


SECTIONS = (
    *("model", "motion", "planting", "forces", "joints", "run", "vibration", "modes", "balance"),
    "tool",
)
"""In the order in which they are shown."""


@dataclass(frozen=True, eq=False)
class ReportPicture:
    """A chart in a report.

    chart : its name, which also does for a file, is that of no other.  section : one of `SECTIONS`.
    headline : states the result that it shows, in a line as of `headlines`; may be empty.
    detail : whether a report has it in its appendix.
    """

    chart: Chart
    section: str
    headline: Callable[[], str] = str
    detail: bool = False

    @property
    def name(self) -> str:
        """Name of the chart."""
        return self.chart.name


def pictures(
    findings: Findings | ToolFindings, at: Sequence[float] | None = None
) -> list[ReportPicture]:
    """All of them, in the order of `SECTIONS`.

    at : crank angles at which the linkage is drawn, rad; usual ones if None.
    """
    return list(each(findings, at))


def each(
    findings: Findings | ToolFindings,
    at: Sequence[float] | None = None,
    sections: Collection[str] = SECTIONS,
) -> Iterator[ReportPicture]:
    """Pictures of some sections one by one: what only later ones need is not computed before."""
    from equipoise.figures.style import free_name

    parts: dict[str, Callable[[Any], Iterator[_Picture]]] = {"tool": _tool}
    if isinstance(findings, Findings):
        parts = {"model": partial(_model, at=at), **OF_LINKAGE}
    taken: dict[str, None] = {}
    for section in (name for name in parts if name in sections):
        for chart, headline, detail in parts[section](findings):
            own = free_name(chart.name, taken)
            taken[own] = None
            yield ReportPicture(chart.named(own), section, headline, detail)


def _pages(
    charts: Iterable[Chart], headline: Callable[[], str] = str, detail: bool = True
) -> Iterator[_Picture]:
    """Charts that go on over several pictures, of which the first has the headline."""
    for number, chart in enumerate(charts):
        yield _Picture(chart, str if number else headline, detail)


def _prefixed(prefix: str, charts: Iterable[Chart]) -> Iterator[Chart]:
    """Charts by the names that they have in a report, where those of other results go before."""
    for chart in charts:
        yield chart.named(f"{prefix}-{chart.name}")


# -- of a hand-held tool ---------------------------------------------------------------------------


def _tool(findings: ToolFindings) -> Iterator[_Picture]:
    """The tool itself, modes, transmission, what the hands get, and the design."""
    from equipoise.figures import tool_charts, tool_side

    modes, transmission = findings.modes, findings.transmission
    planes = range(1 if findings.tool.alike else 2)
    yield _Picture(tool_side.side(findings.tool))
    if modes is not None:
        yield _Picture(tool_side.side_modes(modes), detail=True)
        for plane in planes:
            lowest = partial(headlines.lowest, modes, plane)
            yield from _pages(tool_charts.shapes(modes, plane), lowest)
    if transmission is not None:
        for plane in planes:
            chart = tool_charts.transmission(transmission, plane, modes)
            passed = partial(headlines.passed, transmission, plane)
            yield _Picture(chart, passed, plane > 0)
    if findings.sweep is not None and findings.sweep.response is not None:
        yield _Picture(tool_charts.moment(findings.sweep.response, None), detail=True)
    if findings.exposure is not None:
        worst, judged = (partial(line, findings) for line in (headlines.worst, headlines.judged))
        yield _Picture(tool_charts.acceleration(findings.exposure), worst, detail=True)
        yield _Picture(tool_charts.weighted(findings.exposure), judged)
    if findings.design is not None:
        yield _Picture(tool_side.side_design(findings.design))
        improved = partial(headlines.improved, findings)
        yield _Picture(tool_charts.design(findings.design), improved)


# -- of a linkage; nothing of what it does not have ------------------------------------------------


def _model(findings: Findings, at: Sequence[float] | None) -> Iterator[_Picture]:
    from equipoise.figures.linkage import linkage
    from equipoise.figures.side import side

    analysis = findings.analysis
    yield _Picture(linkage(analysis, at), partial(headlines.heaviest, analysis), detail=True)
    if analysis.machine.has_planes:
        yield _Picture(side(analysis, at))


def _motion(findings: Findings) -> Iterator[_Picture]:
    from equipoise.figures import motion
    from equipoise.figures.linkage import centrodes, rolling

    analysis = findings.analysis
    yield _Picture(motion.curves(analysis), partial(headlines.longest, analysis))
    yield _Picture(motion.hodograph(analysis), partial(headlines.fastest, analysis), detail=True)
    if links := rolling(analysis):
        yield _Picture(centrodes(analysis, links), detail=True)
    if len(analysis.crank_angle) < 2:
        return
    for number, chart in enumerate(motion.main_kinematics(analysis)):
        yield _Picture(chart, partial(headlines.kinematic, analysis, chart.name), number > 0)
    yield from _pages(motion.coupling_ratios(analysis))


def _planting(findings: Findings) -> Iterator[_Picture]:
    figures = findings.planting
    if figures is None:
        return
    from equipoise.figures import planting

    yield _Picture(planting.path(figures), partial(headlines.planted, figures))
    for link in figures.machine.links:
        if link != figures.machine.drive.link:
            geared = partial(headlines.geared, findings.analysis, link)
            yield _Picture(planting.ratio(figures, link), geared, detail=True)
    yield from _pages(_prefixed("tip", planting.tips(figures)))
    if figures.forces is not None:
        torque, joints = _prefixed("soil", (planting.torque(figures), planting.joints(figures)))
        yield _Picture(torque, partial(headlines.resisted, figures))
        yield _Picture(joints, detail=True)


def _forces(findings: Findings) -> Iterator[_Picture]:
    analysis = findings.analysis
    if not analysis.has_forces:
        return
    from equipoise.figures import forces

    yield _Picture(forces.polar(analysis), partial(headlines.pushed, findings), detail=True)
    peaked = partial(headlines.peaked, analysis)
    yield _Picture(forces.force(analysis), partial(peaked, "shaking_force", "force"))
    yield _Picture(forces.moment(analysis), partial(peaked, "shaking_moment", "torque"))
    for number, chart in enumerate(forces.torques(analysis), 1):
        yield _Picture(chart, partial(headlines.caused, analysis, number))
    if analysis.has_orders:
        ordered = partial(headlines.ordered, findings)
        yield _Picture(forces.spectrum(analysis), ordered, detail=True)


def _joints(findings: Findings) -> Iterator[_Picture]:
    analysis = findings.analysis
    if not analysis.has_forces or not analysis.forces.joints:
        return
    from equipoise.figures import forces
    from equipoise.figures.link_strength import link_charts
    from equipoise.figures.motion import coupling_curves

    yield from _pages(coupling_curves(analysis))
    yield from _pages(forces.joints(analysis), partial(headlines.joint_peaked, analysis))
    yield from _pages(forces.joint_polars(analysis), partial(headlines.joint_acting, analysis))
    yield from _pages(link_charts(analysis))


def _run(findings: Findings) -> Iterator[_Picture]:
    for chart in () if findings.run is None else findings.run.charts().values():
        name = "run" if chart.name == "speed" else f"run-{chart.name}"
        yield _Picture(chart.named(name))


def _vibration(findings: Findings) -> Iterator[_Picture]:
    from equipoise.figures import vibration

    if (response := findings.response) is not None:
        for number, name in enumerate(response.gauges):
            chart = vibration.gauge(response, name)
            yield _Picture(chart, partial(headlines.moved, response, name), number > 0)
        loudest = partial(headlines.loudest_gauge, response)
        yield from _pages(_prefixed("gauge", vibration.spectra(response)), loudest)
        yield from _pages(vibration.mounts(response), partial(headlines.mounted, response))
        yield _Picture(vibration.drive(response), partial(headlines.driven, response), detail=True)
    if (over_speed := findings.sweep) is not None:
        for quantity in vibration.OVER_SPEED:
            chart = vibration.gauges_over_speed(over_speed, quantity).named(f"response-{quantity}")
            resonant = partial(headlines.resonant, over_speed, quantity)
            yield _Picture(chart, resonant, detail=quantity != "velocity")
        met = partial(headlines.met, over_speed, findings.machine.drive.speed)
        yield _Picture(vibration.resonance_map(over_speed), met, detail=True)
        if over_speed.mounts:
            yield _Picture(
                vibration.mounts_over_speed(over_speed).named("mounts-speed"), detail=True
            )


def _modes(findings: Findings) -> Iterator[_Picture]:
    if (free := findings.modes) is not None:
        for number, chart in enumerate(free.charts().values(), 1):
            yield _Picture(chart, partial(headlines.swung, free, number), detail=True)


def _balance(findings: Findings) -> Iterator[_Picture]:
    balanced = findings.balanced
    if balanced is None or not findings.helped:
        return
    from equipoise.figures.balancing import aims, combined, phases, signals
    from equipoise.figures.changes import changes

    of_linkage = any(change.kind != "phases" for change in balanced.changes)
    if of_linkage:
        yield _Picture(changes(balanced), partial(headlines.added, findings))
    yield from _pages(aims(balanced), partial(headlines.reached, balanced), detail=False)
    for name, chart in signals(balanced).items() if of_linkage else ():
        compared = partial(headlines.compared, findings, name)
        yield _Picture(chart.named(f"balanced-{name}"), compared, detail=True)
    if balanced.phasing is not None:
        both = balanced.original, balanced.machine
        yield _Picture(phases(*both))
        yield _Picture(combined(*both), partial(headlines.compared, findings, "rows"), detail=True)


OF_LINKAGE: dict[str, Callable[[Findings], Iterator[_Picture]]] = {
    "motion": _motion,
    "planting": _planting,
    "forces": _forces,
    "joints": _joints,
    "run": _run,
    "vibration": _vibration,
    "modes": _modes,
    "balance": _balance,
}


PicturesBySection = dict[str, list[SvgPicture]]
"""Pictures by section."""


def drawings(
    findings: Findings | ToolFindings, parallel: bool = False, by_rows: bool = False
) -> PicturesBySection:
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
        of_helper: PicturesBySection = here.recv()
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


def _draw(
    findings: Findings | ToolFindings, sections: Collection[str], by_rows: bool
) -> PicturesBySection:
    pictures: PicturesBySection = {}
    for picture in each(findings, sections=sections):
        chart = picture.chart
        text = say("; ").join((chart.what, *chart.words))
        svg, wide, rows, narrow = standalone_svg(chart, by_rows)
        headline, caption = picture.headline(), say(chart.caption)
        block = SvgPicture(
            chart.name, text, svg, headline, caption, wide, picture.detail, rows, narrow
        )
        pictures.setdefault(picture.section, []).append(block)
    return pictures
