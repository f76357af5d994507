"""A report from findings: what stands in it, in which order, with its sources; and on disk."""

from __future__ import annotations

import os
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any

import equipoise
from equipoise.balancing.blocks import outcome_blocks
from equipoise.balancing.outcome import benefit_sentences, no_benefit_sentences
from equipoise.errors import UsageError, at_place
from equipoise.handheld import blocks as of_tools
from equipoise.handheld.blocks import design_blocks, exposure_of_tool
from equipoise.handheld.model import Tool
from equipoise.i18n import LANGUAGES, Note, coordinates, localized, say, speaking, to_say
from equipoise.mechanism.parts.machine import Machine
from equipoise.planting.blocks import planting_blocks
from equipoise.present.findings import Findings, ToolFindings, find
from equipoise.present.headlines import outstanding, seen_in
from equipoise.present.pages import ReportDocument, check_pdf, page, pdf
from equipoise.present.pictures import PicturesBySection, drawings
from equipoise.present.summary import answers, check_whole_cycle, tiles, tool_answers, tool_tiles
from equipoise.quantities import PER_RPM, chosen_units, number
from equipoise.results.analysis import Analysis
from equipoise.results.analysis_blocks import (
    force_blocks,
    motion_blocks,
    question_blocks,
    verdict_blocks,
)
from equipoise.results.blocks import (
    Block,
    Facts,
    FileText,
    Notes,
    ReportSection,
    SvgPicture,
    Table,
    Text,
    interleave_changes,
)
from equipoise.results.joint_blocks import elements_tables, joint_blocks, kind_tables
from equipoise.results.machine_blocks import crank_angles_text, driven, model_blocks
from equipoise.results.result import in_own_words
from equipoise.results.yardsticks import GaugeReading, assess, verdict
from equipoise.vibration.blocks import model_text, resonances_table, response_blocks

KIM_CHUNG = (
    "Kim, K. U., Chung, C. J.: An analytical method for kinematic analysis of the planting "
    "mechanism of a rice transplanter, c. 1977"
)
YAMASHITA = (
    "山下光司, 市川真祐, 森邦男: 田植機における植付爪の振動消去に関する研究 "
    "(Yamashita, Ichikawa, Mori: Studies on control of vibrations originating in rice "
    "transplanting mechanism), c. 1982"
)
LEE_KIM = (
    "李政基, 金景旭: 크랭크식 移秧機 植付機構의 動的 均衡에 관한 研究 "
    "(Lee, Kim: Dynamic balancing of crank-type transplanting mechanism of rice "
    "transplanter), c. 1990"
)
NAGAMINE_IRIE = (
    "長嶺正紀, 入江敏博: 刈払機の振動特性について "
    "(Nagamine, Irie: On the vibration characteristics of a brush cutter), 1970"
)
ISO_5349 = "ISO 5349-1:2001, ISO 5349-2:2001"
DIRECTIVE = "Directive 2002/44/EC"
ISO_22867 = "ISO 22867"

USED = {
    "force": to_say("Shaking force, drive torque, balancing, vibration on a support: {source}"),
    "moment": to_say("Shaking moment, shaking energy, geared counterweights: {source}"),
    "planting": to_say("Figures of planting: {source}"),
    "shaft": to_say("Vibration of the shaft and transmission to the hands: {source}"),
    "hands": to_say("Weighting and daily exposure of the hands: {source}"),
}


def sources(findings: Findings | ToolFindings) -> Iterator[str]:
    """What was used, a line each."""
    if isinstance(findings, ToolFindings):
        yield say(USED["shaft"], source=NAGAMINE_IRIE)
        if findings.exposure is not None:
            yield say(USED["hands"], source=f"{ISO_5349}; {DIRECTIVE}; {ISO_22867}")
        return
    if findings.analysis.has_forces:
        yield say(USED["force"], source=YAMASHITA)
        yield say(USED["moment"], source=LEE_KIM)
    if findings.planting is not None:
        yield say(USED["planting"], source=KIM_CHUNG)


TITLES = {
    "model": to_say("Model"),
    "motion": to_say("Motion"),
    "planting": to_say("Planting"),
    "forces": to_say("Forces on frame and drive"),
    "joints": to_say("Forces in the joints"),
    "run": to_say("Run"),
    "vibration": to_say("Vibration on the support"),
    "balance": to_say("Balancing: before and after"),
    "tool": to_say("Vibration of the tool"),
    "sources": to_say("Sources"),
    "settings": to_say("Version and settings"),
    "file": to_say("The model file"),
}

AFTER = to_say("Lines that end in “after” are those after the change that helps most.")

Parts = dict[str, list[Block | ReportSection]]
"""What stands in each section, by its name."""

SHORT, SHORT_OF_MODEL = 6, 9
"""Rows of a table that stands among the pictures, and of one of the model, which has room below the
summary; longer ones stand in the appendix."""
BEHIND = ("sources", "settings")
"""Sections that stand in the appendix as a whole."""


def build(
    findings: Findings | ToolFindings,
    language: str = "en",
    command: str = "",
    parallel: bool = False,
    by_rows: bool = False,
) -> ReportDocument:
    """The contents of a report, in a language.

    command : that makes it again.
    parallel : whether a second process may help; see `pictures.drawings`.
    by_rows : whether high pictures are drawn by rows of panels too, by which a PDF parts them.

    Raises
    ------
    UsageError : the analysis does not cover whole turns; errors of it otherwise.
    """
    with speaking(language), in_own_words(findings.owner):
        if isinstance(findings, Findings):
            check_whole_cycle(findings)
        pictures = drawings(findings, parallel, by_rows)
        if isinstance(findings, Findings):
            document = _of_linkage(findings, pictures, language, command)
        else:
            document = _of_tool(findings, pictures, language, command)
        return replace(document, units=chosen_units())


def _of_linkage(
    findings: Findings, pictures: PicturesBySection, language: str, command: str
) -> ReportDocument:
    machine, analysis = findings.machine, findings.analysis
    blocks: Parts = {"model": [*model_blocks(machine), *pictures.get("model", [])]}
    blocks["motion"] = [*pictures.get("motion", []), *_details(motion_blocks(analysis))]
    blocks["motion"] += [*kind_tables(analysis, "motion"), *elements_tables(analysis)]
    if findings.planting is not None:
        blocks["planting"] = [*pictures.get("planting", []), *planting_blocks(findings.planting)]
    later = findings.after
    if analysis.has_forces:
        again = None if later is None else later.analysis
        blocks["forces"] = [
            *pictures.get("forces", []),
            *_details(_with_after(force_blocks, analysis, again)),
        ]
        blocks["joints"] = [*pictures.get("joints", []), *_with_after(_joints, analysis, again)]
    if findings.run is not None:
        blocks["run"] = [*findings.run.headline(), *pictures.get("run", []), *findings.run.blocks()]
    if findings.response is not None:
        response = None if later is None else later.response
        blocks["vibration"] = [*pictures.get("vibration", []), *pictures.get("modes", [])]
        blocks["vibration"] += _with_after(response_blocks, findings.response, response)
        if findings.sweep is not None and findings.sweep.resonances:
            blocks["vibration"].append(resonances_table(findings.sweep))
    if findings.balanced is not None:
        blocks["balance"] = [*balance_blocks(findings), *pictures.get("balance", [])]
    seens = {name: seen_in(name, findings) for name in blocks}
    summary = tuple(answers(findings, _stated(findings)))
    if findings.balanced is not None:
        said_above = {sentence for answer in summary for sentence in answer.sentences}
        said_above |= {*benefit_sentences(findings.balanced)}  # with what the verdict states
        blocks["balance"] = [*_not_said(blocks["balance"], said_above)]
    return ReportDocument(
        language,
        localized(machine.title),
        driven(machine, analysis.motion.speed),
        localized(machine.description),
        tuple(tiles(findings)),
        summary,
        _animation(findings),
        *_sections(findings, blocks, seens, _settings_of_linkage(findings), command),
        lead="" if later is None else say(AFTER),
        verdict=next(_verdict(findings), None),
        drawing=_first_picture(blocks["model"]),
    )


def _not_said(
    blocks: Iterable[Block | ReportSection], said_above: Collection[str]
) -> Iterator[Block | ReportSection]:
    """Blocks but for texts that the summary has already."""
    for block in blocks:
        if not (isinstance(block, Text) and block.text in said_above):
            yield block


def _verdict(findings: Findings) -> Iterator[Text]:
    """By what a machine is judged first: on its support by what the gauges read, too."""
    return verdict_blocks(findings.analysis, _readings(findings))


def _stated(findings: Findings) -> str:
    """Output of the figure that the verdict states; "" where there is none."""
    figure = verdict(assess(findings.analysis, _readings(findings)))
    return "" if figure is None else figure.output


def _readings(findings: Findings) -> Mapping[str, GaugeReading] | None:
    return None if findings.response is None else findings.response.gauges


def _joints(analysis: Analysis) -> Iterator[Block]:
    yield from joint_blocks(analysis)
    yield from kind_tables(analysis, "joints")


def _with_after(
    blocks: Callable[[Any], Iterable[Block]], before: Any, after: Any
) -> Iterable[Block]:
    """What a result shows, beside the same after the change that helps most, where there is one."""
    text = blocks(before)
    return text if after is None else interleave_changes(text, blocks(after))


def balance_blocks(findings: Findings) -> Iterator[Block]:
    """What may be changed, what is to be changed, and every figure before and after."""
    balanced = findings.balanced
    assert balanced is not None
    if findings.helped or balanced.advice is not None:
        yield from outcome_blocks(balanced)
    else:
        yield from map(Text, no_benefit_sentences(balanced))


def _of_tool(
    findings: ToolFindings, drawings: PicturesBySection, language: str, command: str
) -> ReportDocument:
    pictures = drawings.get("tool", [])
    blocks: list[Block | ReportSection] = []
    if findings.design is not None:
        blocks.extend(design_blocks(findings.design, judged=False))  # which the summary says
    if findings.exposure is not None:
        blocks.extend(exposure_of_tool(findings.exposure, judged=False))
    # Without a design the first page has room for the figures, but not for the pictures.
    blocks = [*blocks, *pictures] if findings.design is None else [*pictures, *blocks]
    if findings.modes is not None:
        blocks.extend(_details(of_tools.modes_blocks(findings.modes)))
    subtitle = ""
    if findings.tool.operation is not None:
        rpm = number(findings.tool.operation.speed / PER_RPM)
        subtitle = say("hand-held tool, engine at {speed} rpm", speed=rpm)
    model: list[Block | ReportSection] = [*of_tools.model_blocks(findings.tool)]
    if findings.design is not None:  # which fills the first page
        model = [*_details(model)]
    named: Parts = {"model": model, "tool": blocks}
    return ReportDocument(
        language,
        localized(findings.tool.title),
        subtitle,
        localized(findings.tool.description),
        tuple(tool_tiles(findings)),
        tuple(tool_answers(findings)),
        "",
        *_sections(findings, named, {"tool": outstanding(findings)}, (), command),
        verdict=None if findings.exposure is None else _first_text(findings.exposure.headline()),
        drawing=_first_picture(blocks),
    )


def _details(blocks: Iterable[Block | ReportSection]) -> Iterator[Block | ReportSection]:
    """Blocks whose tables stand in the appendix, however short they are."""
    for block in blocks:
        yield replace(block, detail=True) if isinstance(block, Table) else block


def _first_picture(blocks: Iterable[Block | ReportSection]) -> SvgPicture | None:
    return next((block for block in blocks if isinstance(block, SvgPicture)), None)


def _first_text(blocks: Iterable[Block | ReportSection]) -> Text | None:
    return next((block for block in blocks if isinstance(block, Text)), None)


def _sections(
    findings: Findings | ToolFindings,
    blocks: Parts,
    headlines: Mapping[str, str],
    settings: Iterable[str],
    command: str,
) -> tuple[tuple[ReportSection, ...], tuple[ReportSection, ...]]:
    """Sections of the blocks, then what every report ends with; and the appendix.

    headlines : what is seen in a section, by its name.
    """
    template = to_say("Made by Equipoise {version} from {file}")
    origin = say(template, version=equipoise.__version__, file=findings.file)
    notes_and_questions = (*findings.notes, *questions_of(findings))
    notes = [Notes(notes_and_questions)] if notes_and_questions else []
    again = [FileText(say("Command"), command)] if command else []  # as it is, to be copied
    last: Parts = {
        "sources": [Facts("", tuple(sources(findings)))],
        "settings": [Facts("", (*settings, origin)), *notes, *again],
    }
    sections, appendix = [], []
    for name, parts in (blocks | last).items():
        rows = SHORT_OF_MODEL if name == "model" else SHORT
        short, long = ([], parts) if name in BEHIND else parted(parts, rows)
        title = say(TITLES[name])
        if short or headlines.get(name):
            sections.append(ReportSection(name, title, tuple(short), headlines.get(name, "")))
        if long:
            appendix.append(ReportSection(name, title, tuple(long)))
    if findings.text:
        listing = FileText(findings.file, findings.text)
        appendix.append(ReportSection("file", say(TITLES["file"]), (listing,)))
    return tuple(sections), tuple(appendix)


def parted(
    blocks: Iterable[Block | ReportSection], rows: int = SHORT
) -> tuple[list[Block | ReportSection], list[Block | ReportSection]]:
    """What stands in a section; and long tables, pictures and tables of details."""
    short: list[Block | ReportSection] = []
    long: list[Block | ReportSection] = []
    for block in blocks:
        of_detail = isinstance(block, Table | SvgPicture) and block.detail
        if of_detail or (isinstance(block, Table) and len(block.rows) > rows):
            long.append(block)
        else:
            short.append(block)
    return short, long


def _animation(findings: Findings) -> str:
    from equipoise.figures.animation import animated_svg
    from equipoise.figures.motion import followed
    from equipoise.figures.stage import ForceArrow
    from equipoise.symbols.looks import in_turn
    from equipoise.symbols.scene import Scene, clear_angle

    analysis = findings.analysis
    scene = Scene.of(analysis.motion).with_rows(analysis.motion)
    alone = len(in_turn(scene, clear_angle(scene))) == 1
    if findings.response is not None:
        from equipoise.figures.swing import swinging

        scene = swinging(scene, findings.response)
    return animated_svg(
        scene,
        title=findings.machine.title,
        traced=followed(analysis.motion),
        arrow=ForceArrow.of(analysis) if analysis.has_forces and alone else None,
        width=440,  # as wide as it stands on the page, so that its texts have their size
    )


def _settings_of_linkage(findings: Findings) -> Iterator[str]:
    motion = findings.analysis.motion
    yield crank_angles_text(findings.analysis)
    if motion.acceleration:
        yield say("Crank acceleration {value} rad/s²", value=number(motion.acceleration))
    gravity = coordinates(number(part) for part in findings.machine.gravity)
    yield say("Gravity ({value}) m/s²", value=gravity)
    if findings.response is not None:
        yield model_text(findings.response.model)
    if findings.balanced is not None:
        yield say("Balanced by: {method}", method=localized(findings.balanced.method))


def questions_of(findings: Findings | ToolFindings) -> tuple[Note | str, ...]:
    """What may not be meant as the file of a linkage gives it."""
    if isinstance(findings, ToolFindings):
        return ()
    blocks = question_blocks(findings.analysis)
    return tuple(note for block in blocks if isinstance(block, Notes) for note in block.notes)


KINDS = {".html": "html", ".htm": "html", ".pdf": "pdf"}


def kind_of(out: str | os.PathLike[str]) -> str:
    """What a report becomes, by the end of its name: ``html`` or ``pdf``."""
    _, end = os.path.splitext(out)
    if end.lower() not in KINDS:
        raise UsageError(
            Note("got {fspath!r}; give a name that ends in .html or .pdf", fspath=os.fspath(out))
        )
    return KINDS[end.lower()]


def report(
    model: str | os.PathLike[str] | Machine | Tool,
    *outs: str | os.PathLike[str],
    language: str = "en",
    speed: float | str | None = None,
    command: str = "",
) -> None:
    """Write a report of a machine or a tool.

    Parameters
    ----------
    model : the machine or tool, the path of its file, or the name of a bundled example.
    outs : files to write, pages as ``.html`` or PDF as ``.pdf`` by the ends of their names.
    language : code of one of `equipoise.i18n.LANGUAGES`, such as ``ja``.
    speed : of the crank, or of the tool's engine, rad/s, or a text such as ``"300 rpm"``; the
        model's where not given.
    command : that makes the report again, printed at its end.

    Raises
    ------
    ModelError, MobilityError, MotionError : the file is wrong, or its linkage cannot turn.
    UsageError : a file cannot be written, there is no such language, or no font for it.
    EquipoiseError : a PDF is wanted, and Typst is not installed.
    """
    check(outs, language)
    if not outs:
        raise UsageError(
            at_place("report", Note("no file is named; give one such as 'report.html'"))
        )
    write_document(find(model, speed=speed), outs, language, command)


def report_page(findings: Findings | ToolFindings, language: str = "en", command: str = "") -> str:
    """A report of findings as HTML, the same text on every run.

    Parameters
    ----------
    findings : from `find`.
    language : code of one of `equipoise.i18n.LANGUAGES`, such as ``ja``.
    command : that makes the report again, printed at its end.

    Raises
    ------
    MobilityError, MotionError, UsageError : the linkage cannot be moved.
    """
    return page(build(findings, language, command))


def check(outs: Iterable[str | os.PathLike[str]], language: str) -> None:
    """Raise if names of files are wrong or fonts missing, before anything is computed."""
    if language not in LANGUAGES:
        raise UsageError(
            at_place(
                "language",
                Note(
                    "got {language!r}; give one of {names}",
                    language=language,
                    names=", ".join(LANGUAGES),
                ),
            )
        )
    if _has_pdf(outs):
        check_pdf(language)


def _has_pdf(outs: Iterable[str | os.PathLike[str]]) -> bool:
    return "pdf" in map(kind_of, outs)


def write_document(
    findings: Findings | ToolFindings,
    outs: Sequence[str | os.PathLike[str]],
    language: str,
    command: str,
) -> ReportDocument:
    """Write a report of findings as each of these files; what stands in it."""
    from equipoise.schema.files import write, write_all

    document = build(findings, language, command, parallel=True, by_rows=_has_pdf(outs))
    for out in outs:
        data = pdf(document) if kind_of(out) == "pdf" else page(document).encode()
        folder, name = os.path.split(out)
        if os.path.isdir(folder or "."):  # one that is named may be a link
            write(out, data)
        else:
            write_all(folder, {name: data})
    return document
