"""A report from findings: what stands in it, in which order."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from math import pi

import equipoise
from equipoise.i18n import say, speaking, to_say
from equipoise.report.document import Block, Document, Listing, Paragraph, Points, Section
from equipoise.report.drawing import drawings
from equipoise.report.effects import balance_blocks, planting_blocks, vibration_blocks
from equipoise.report.findings import Findings, ToolFindings
from equipoise.report.notes import method_told, noted
from equipoise.report.numbers import number
from equipoise.report.sources import sources
from equipoise.report.summary import answers, check_whole_cycle, tiles
from equipoise.report.tables import (
    force_blocks,
    joint_table,
    model_blocks,
    motion_blocks,
    speed_told,
)
from equipoise.report.tool import tool_answers, tool_tiles
from equipoise.report.tool_tables import design_table, exposure_blocks, mode_blocks, tool_model

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

MODELS = {
    "linear": to_say("the shaking force at the drive's pivot; equation (59) of Yamashita et al."),
    "torque": to_say(
        "the shaking force at the drive's pivot, and the drive torque; equation (57) of "
        "Yamashita et al."
    ),
    "moment": to_say("the whole force and moment of the joints on the frame"),
    "coupled": to_say(
        "as torque, with the torque that the motion of the support takes; equation (54) of "
        "Yamashita et al."
    ),
    "exact": to_say("all bodies, large motion; equations (37) to (45) of Yamashita et al."),
}
"""What each model of the support stands for; as `vibration.response.EQUATIONS`."""

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
    with speaking(language):
        if isinstance(found, ToolFindings):
            return _of_tool(found, language, command)
        check_whole_cycle(found)
        return _of_linkage(found, language, command, together)


def _of_linkage(found: Findings, language: str, command: str, together: bool) -> Document:
    machine, analysis = found.machine, found.analysis
    drawn = drawings(found, together)
    blocks: dict[str, list[Block]] = {"model": list(model_blocks(machine))}
    blocks["motion"] = [*drawn.pop("motion", []), *motion_blocks(analysis)]
    if found.planting is not None:
        blocks["planting"] = [*drawn.pop("planting", []), *planting_blocks(found.planting)]
    if analysis.solved is not None:
        blocks["forces"] = [*drawn.pop("forces", []), *force_blocks(analysis)]
        blocks["joints"] = [*drawn.pop("joints", []), joint_table(analysis)]
    if found.response is not None:
        tables = vibration_blocks(found.response, found.sweep)
        shown = [*drawn.pop("vibration", []), *drawn.pop("modes", [])]
        blocks["vibration"] = [*shown, *tables]
    if found.balanced is not None:
        blocks["balance"] = [*balance_blocks(found, found.balanced), *drawn.pop("balance", [])]
    settings = [*_settings_of_linkage(found), _made(found)]
    return Document(
        language,
        machine.title,
        speed_told(machine, analysis.motion.speed),
        machine.description,
        tuple(tiles(found)),
        tuple(answers(found)),
        _animation(found),
        _sections(found, blocks, settings, command),
    )


def _of_tool(found: ToolFindings, language: str, command: str) -> Document:
    blocks: list[Block] = list(drawings(found).get("tool", []))
    if found.design is not None:
        blocks.append(design_table(found.design))
    if found.exposure is not None:
        blocks.extend(exposure_blocks(found.exposure))
    if found.modes is not None:
        blocks.extend(mode_blocks(found.modes))
    operation = found.tool.operation
    subtitle = ""
    if operation is not None:
        speed = number(operation.speed * 30 / pi)
        subtitle = say("hand-held tool, engine at {speed} rpm", speed=speed)
    named = {"model": list(tool_model(found.tool)), "tool": blocks}
    return Document(
        language,
        found.tool.title,
        subtitle,
        found.tool.description,
        tuple(tool_tiles(found)),
        tuple(tool_answers(found)),
        "",
        _sections(found, named, [_made(found)], command),
    )


def _sections(
    found: Findings | ToolFindings,
    blocks: dict[str, list[Block]],
    settings: Iterable[str],
    command: str,
) -> tuple[Section, ...]:
    """Sections of the blocks, then what every report ends with."""
    notes = map(noted, found.notes)
    again = [Listing(say("Command"), command)] if command else []  # as it is, to be copied
    last: dict[str, list[Block]] = {
        "sources": [Points("", tuple(sources(found)))],
        "settings": [Points("", tuple(settings)), *map(Paragraph, notes), *again],
        "file": [Listing(found.file, found.text)],
    }
    return tuple(
        Section(name, say(TITLES[name]), tuple(parts))
        for name, parts in (blocks | last).items()
        if parts
    )


def _animation(found: Findings) -> str:
    from equipoise.figures.stage import Arrow
    from equipoise.figures.svg import animated_svg
    from equipoise.symbols.scene import Scene

    analysis = found.analysis
    scene = Scene.of(analysis.motion)
    ends = [name for name in scene.places if name not in (*scene.pins, *scene.frame)]
    tip = () if found.machine.planting is None else (found.machine.planting.tip,)
    arrow = None
    if analysis.solved is not None:
        forces = analysis.solved
        arrow = Arrow(forces.about, forces.shaking_force.value, of_one=len(found.machine.rows) > 1)
    return animated_svg(
        scene,
        title=found.machine.title,
        traced=tip or ends[:MOST_TRACED],
        arrow=arrow,
        width=440,  # as wide as it stands on the page, so that its texts have their size
    )


def _settings_of_linkage(found: Findings) -> Iterator[str]:
    motion = found.analysis.motion
    if motion.turns == 1:
        angles = found.angles
        yield say("{angles} crank angles in a turn, after which everything repeats", angles=angles)
    else:
        yield say(
            "{angles} crank angles in a turn, {turns} turns until everything repeats",
            angles=found.angles,
            turns=motion.turns,
        )
    if motion.acceleration:
        yield say("Crank acceleration {value} rad/s²", value=number(motion.acceleration))
    gravity = ", ".join(number(part) for part in found.machine.gravity)
    yield say("Gravity ({value}) m/s²", value=gravity)
    if found.response is not None:
        model = found.response.model
        yield say("Vibration by the model {model}: {what}", model=model, what=say(MODELS[model]))
    if found.balanced is not None:
        yield say("Balanced by: {method}", method=method_told(found.balanced.method))


def _made(found: Findings | ToolFindings) -> str:
    return say(
        "Made by Equipoise {version} from {file}", version=equipoise.__version__, file=found.file
    )
