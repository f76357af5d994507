"""A report from findings: what stands in it, in which order; and on disk."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator
from dataclasses import replace
from typing import Any

import equipoise
from equipoise.balancing.blocks import outcome_blocks
from equipoise.balancing.told import nothing_told, said
from equipoise.errors import UsageError
from equipoise.handheld import blocks as of_tools
from equipoise.handheld.hand_blocks import design_blocks, exposure_of_tool
from equipoise.i18n import LANGUAGES, say, speaking, to_say
from equipoise.mechanism.shown_units import units_of
from equipoise.planting.blocks import planting_blocks
from equipoise.present.findings import Findings, ToolFindings, find
from equipoise.present.pages import Document, check_pdf, page, pdf
from equipoise.present.pictures import drawings
from equipoise.present.summary import answers, check_whole_cycle, tiles
from equipoise.present.tool_summary import tool_answers, tool_tiles
from equipoise.quantities import PER_RPM, chosen_units, number, showing_by_default
from equipoise.results.analysis import Analysis
from equipoise.results.analysis_blocks import force_blocks, joint_table, motion_blocks
from equipoise.results.blocks import Block, Facts, Listing, Notes, Section, Text, beside
from equipoise.results.machine_blocks import angles_told, driven, model_blocks
from equipoise.vibration.blocks import model_told, response_blocks
from equipoise.vibration.sweep_blocks import resonances_table

TITLES = {
    "model": to_say("Model"),
    "motion": to_say("Motion"),
    "planting": to_say("Planting"),
    "forces": to_say("Forces on frame and drive"),
    "joints": to_say("Forces in the joints"),
    "vibration": to_say("Vibration on the support"),
    "balance": to_say("Balancing: before and after"),
    "tool": to_say("Vibration of the tool"),
    "sources": to_say("Sources"),
    "settings": to_say("Version and settings"),
    "file": to_say("The model file"),
}

Parts = dict[str, list[Block | Section]]
"""What stands in each section, by its name."""

MOST_TRACED = 3
"""Points whose paths are drawn beside the moving linkage, where no finger plants."""


def build(
    found: Findings | ToolFindings,
    language: str = "en",
    command: str = "",
    together: bool = False,
) -> Document:
    """Everything that a report tells, in a language.

    command : that makes it again.
    together : whether a second process may help; see `drawing.drawings`.

    Raises
    ------
    UsageError : the analysis does not cover whole turns; errors of it otherwise.
    """
    with speaking(language), showing_by_default(units_of(found.owner)):
        if isinstance(found, ToolFindings):
            made = _of_tool(found, language, command)
        else:
            check_whole_cycle(found)
            made = _of_linkage(found, language, command, together)
        return replace(made, units=chosen_units())


def _of_linkage(found: Findings, language: str, command: str, together: bool) -> Document:
    machine, analysis = found.machine, found.analysis
    drawn = drawings(found, together)
    blocks: Parts = {"model": [*model_blocks(machine)]}
    blocks["motion"] = [*drawn.get("motion", []), *motion_blocks(analysis)]
    if found.planting is not None:
        blocks["planting"] = [*drawn.get("planting", []), *planting_blocks(found.planting)]
    later = found.after
    if analysis.solved is not None:
        again = None if later is None else later.analysis
        blocks["forces"] = [*drawn.get("forces", []), *_with_after(force_blocks, analysis, again)]
        blocks["joints"] = [*drawn.get("joints", []), *_with_after(_joints, analysis, again)]
    if found.response is not None:
        shaken = None if later is None else later.response
        blocks["vibration"] = [*drawn.get("vibration", []), *drawn.get("modes", [])]
        blocks["vibration"] += _with_after(response_blocks, found.response, shaken)
        if found.sweep is not None and found.sweep.resonances:
            blocks["vibration"].append(resonances_table(found.sweep))
    if found.balanced is not None:
        blocks["balance"] = [*balance_blocks(found), *drawn.get("balance", [])]
    return Document(
        language,
        machine.title,
        driven(machine, analysis.motion.speed),
        machine.description,
        tuple(tiles(found)),
        tuple(answers(found)),
        _animation(found),
        _sections(found, blocks, _settings_of_linkage(found), command),
    )


def _joints(analysis: Analysis) -> Iterator[Block]:
    yield joint_table(analysis)


def _with_after(
    blocks: Callable[[Any], Iterable[Block]], before: Any, after: Any
) -> Iterator[Block]:
    """What a result shows, beside the same after the change that helps most, where there is one."""
    told = tuple(blocks(before))
    if after is None:
        yield from told
        return
    both = tuple(beside(told, blocks(after)))
    if both != told:
        yield Text(say("Lines that end in “after” are those after the change that helps most."))
    yield from both


def balance_blocks(found: Findings) -> Iterator[Block]:
    """What may be changed, what is to be changed, and every figure before and after."""
    balanced = found.balanced
    assert balanced is not None
    if found.helped or balanced.tried:
        yield from outcome_blocks(balanced)
    else:
        yield from map(Text, nothing_told(balanced))


def _of_tool(found: ToolFindings, language: str, command: str) -> Document:
    blocks: list[Block | Section] = [*drawings(found).get("tool", [])]
    if found.design is not None:
        blocks.extend(design_blocks(found.design))
    if found.exposure is not None:
        blocks.extend(exposure_of_tool(found.exposure))
    if found.modes is not None:
        blocks.extend(of_tools.modes_blocks(found.modes))
    subtitle = ""
    if found.tool.operation is not None:
        rpm = number(found.tool.operation.speed / PER_RPM)
        subtitle = say("hand-held tool, engine at {speed} rpm", speed=rpm)
    named: Parts = {"model": [*of_tools.model_blocks(found.tool)], "tool": blocks}
    return Document(
        language,
        found.tool.title,
        subtitle,
        found.tool.description,
        tuple(tool_tiles(found)),
        tuple(tool_answers(found)),
        "",
        _sections(found, named, (), command),
    )


def _sections(
    found: Findings | ToolFindings, blocks: Parts, settings: Iterable[str], command: str
) -> tuple[Section, ...]:
    """Sections of the blocks, then what every report ends with."""
    template = to_say("Made by Equipoise {version} from {file}")
    made = say(template, version=equipoise.__version__, file=found.file)
    notes = [Notes(found.notes)] if found.notes else []
    again = [Listing(say("Command"), command)] if command else []  # as it is, to be copied
    last: Parts = {
        "sources": [Facts("", tuple(sources(found)))],
        "settings": [Facts("", (*settings, made)), *notes, *again],
        "file": [Listing(found.file, found.text)],
    }
    return tuple(
        Section(name, say(TITLES[name]), tuple(parts))
        for name, parts in (blocks | last).items()
        if parts
    )


def _animation(found: Findings) -> str:
    from equipoise.figures.animation import animated_svg
    from equipoise.figures.stage import Arrow
    from equipoise.symbols.scene import Scene

    analysis = found.analysis
    scene = Scene.of(analysis.motion)
    ends = [name for name in scene.places if name not in (*scene.pins, *scene.frame)]
    tip = () if found.machine.planting is None else (found.machine.planting.tip,)
    if found.response is not None:
        from equipoise.figures.swing import swinging

        scene = swinging(scene, found.response)
    return animated_svg(
        scene,
        title=found.machine.title,
        traced=tip or ends[:MOST_TRACED],
        arrow=None if analysis.solved is None else Arrow.of(analysis),
        width=440,  # as wide as it stands on the page, so that its texts have their size
    )


def _settings_of_linkage(found: Findings) -> Iterator[str]:
    motion = found.analysis.motion
    yield angles_told(found.analysis)
    if motion.acceleration:
        yield say("Crank acceleration {value} rad/s²", value=number(motion.acceleration))
    gravity = ", ".join(number(part) for part in found.machine.gravity)
    yield say("Gravity ({value}) m/s²", value=gravity)
    if found.response is not None:
        yield model_told(found.response.model)
    if found.balanced is not None:
        yield say("Balanced by: {method}", method=said(found.balanced.method))


KINDS = {".html": "html", ".htm": "html", ".pdf": "pdf"}


def kind_of(out: str | os.PathLike[str]) -> str:
    """What a report becomes, by the end of its name: ``html`` or ``pdf``."""
    _, end = os.path.splitext(out)
    if end.lower() not in KINDS:
        raise UsageError(f"got {os.fspath(out)!r}; give a name that ends in .html or .pdf")
    return KINDS[end.lower()]


def report(
    path_or_name: str | os.PathLike[str],
    *outs: str | os.PathLike[str],
    language: str = "en",
    speed: float | None = None,
    command: str = "",
) -> None:
    """Write a report of a model file, or of a bundled example by its name.

    Parameters
    ----------
    outs : files to write, pages as ``.html`` or PDF as ``.pdf`` by the ends of their names.
    language : ``en``, ``ja`` or ``ko``.
    speed : of the crank, or of the tool's engine, rad/s; the file's where not given.
    command : that makes the report again, told at its end.

    Raises
    ------
    ModelError, MobilityError, MotionError : the file is wrong, or its linkage cannot turn.
    UsageError : a file cannot be written, there is no such language, or no font for it.
    EquipoiseError : a PDF is wanted, and Typst is not installed.
    """
    check(outs, language)
    found = find(path_or_name, speed=speed)
    write_document(build(found, language, command, together=True), outs)


def report_page(found: Findings | ToolFindings, language: str = "en", command: str = "") -> str:
    """A report of findings as HTML, the same text on every run.

    Parameters
    ----------
    found : from `find`.
    language : ``en``, ``ja`` or ``ko``.
    command : that makes it again, told at its end.

    Raises
    ------
    MobilityError, MotionError, UsageError : the linkage cannot be moved.
    """
    return page(build(found, language, command))


def check(outs: Iterable[str | os.PathLike[str]], language: str) -> None:
    """Tell what is wrong with these names, or missing, before anything is computed."""
    if language not in LANGUAGES:
        raise UsageError(f"language: got {language!r}; give one of {', '.join(LANGUAGES)}")
    if "pdf" in {kind_of(out) for out in outs}:
        check_pdf(language)


def write_document(document: Document, outs: Iterable[str | os.PathLike[str]]) -> None:
    """Write a document as each of these files."""
    from equipoise.schema.files import write_all

    for out in outs:
        data = pdf(document) if kind_of(out) == "pdf" else page(document).encode()
        write_all(os.path.dirname(out) or ".", {os.path.basename(out): data})


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


def sources(found: Findings | ToolFindings) -> Iterator[str]:
    """What was used, a line each."""
    if isinstance(found, ToolFindings):
        yield say(USED["shaft"], source=NAGAMINE_IRIE)
        if found.exposure is not None:
            yield say(USED["hands"], source=f"{ISO_5349}; {DIRECTIVE}; {ISO_22867}")
        return
    if found.analysis.solved is not None:
        yield say(USED["force"], source=YAMASHITA)
        yield say(USED["moment"], source=LEE_KIM)
    if found.planting is not None:
        yield say(USED["planting"], source=KIM_CHUNG)
