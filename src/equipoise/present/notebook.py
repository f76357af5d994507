"""What a notebook shows: of a result its verdict and tables; of a machine, its motion and its
forces the linkage as it is drawn, and tables.
"""

from __future__ import annotations

from typing import Any

from equipoise.displays import Displayed
from equipoise.errors import EquipoiseError
from equipoise.figures import standalone_svg
from equipoise.figures.linkage import linkage
from equipoise.handheld.blocks import model_blocks as tool_blocks
from equipoise.handheld.model import Tool
from equipoise.i18n import localized
from equipoise.mechanism.dynamics.forces import Forces
from equipoise.mechanism.kinematics.motion import Motion, move
from equipoise.mechanism.kinematics.swinging import swing
from equipoise.mechanism.parts.machine import Machine
from equipoise.present.pages import part_of_page
from equipoise.results.analysis import ANGLES, Analysis
from equipoise.results.analysis_blocks import force_blocks, motion_blocks
from equipoise.results.blocks import Block, Text
from equipoise.results.joint_blocks import joint_blocks
from equipoise.results.machine_blocks import model_blocks
from equipoise.results.result import Result, in_own_words


def html_of(value: Displayed) -> str:
    """A value as a part of a page, in the units of its file."""
    owner = _owner(value)
    with in_own_words(owner):
        if isinstance(value, Result):
            return part_of_page(localized(value.title), (*value.headline(), *value.blocks()))
        title = localized(owner.title)
        if isinstance(value, Machine):
            picture, trouble = _pose(value)
            return part_of_page(title, (*trouble, *model_blocks(value)), picture)
        if isinstance(value, Motion):
            analysis = Analysis(value, None)
            return part_of_page(title, motion_blocks(analysis), _picture(analysis))
        if isinstance(value, Forces):
            analysis = Analysis(value.motion, value.about)
            return part_of_page(title, (*force_blocks(analysis), *joint_blocks(analysis)))
        assert isinstance(value, Tool)
        return part_of_page(title, tool_blocks(value))


def _owner(value: Any) -> Any:
    """The machine, tool or study whose title and units a value has."""
    if isinstance(value, Result):
        return value.owner
    motion = value.motion if isinstance(value, Forces) else value
    return motion.machine if isinstance(motion, Motion) else motion


def _pose(machine: Machine) -> tuple[str, tuple[Block, ...]]:
    """The linkage as it moves, and why there is no picture where it cannot."""
    try:
        swinging = swing(machine)
        return _picture(
            Analysis(move(machine if swinging is None else swinging.machine, ANGLES), None)
        ), ()
    except EquipoiseError as error:
        return "", (Text(error.message(lines=True)), *map(Text, error.lines))


def _picture(analysis: Analysis) -> str:
    return standalone_svg(linkage(analysis, None)).svg
