"""What pictures there are of a hand-held tool, and what is written below each."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from typing import TYPE_CHECKING

from equipoise.i18n import to_say
from equipoise.report.findings import ToolFindings
from equipoise.report.shown import Entry, Part, pages

if TYPE_CHECKING:
    from equipoise.handheld.exposed import ToolExposure
    from equipoise.handheld.modes import ToolModes
    from equipoise.handheld.transmission import Transmissions


def of_tool(found: ToolFindings) -> Iterator[Part]:
    """The one section of a tool."""
    if found.modes is not None:
        yield "tool", _modes(found.modes)
    if found.transmission is not None:
        yield "tool", _transmission(found.transmission, found.modes)
    yield "tool", _moment(found)
    if found.exposure is not None:
        yield "tool", _exposure(found.exposure)
    yield "tool", _design(found)


def _modes(modes: ToolModes) -> Iterator[Entry]:
    from equipoise.figures.handheld import shapes

    caption = to_say("Shapes of the natural vibrations of the shaft.")
    for plane, name in enumerate(("modes", "modes-lateral")[: 1 if modes.alike else 2]):
        yield from pages(name, caption, partial(shapes, modes, plane))


def _transmission(found: Transmissions, modes: ToolModes | None) -> Iterator[Entry]:
    from equipoise.figures.handheld import transmission

    caption = to_say("Share of a shaking force that comes to what holds the tool.")
    planes = ("transmission", "transmission-lateral")[: 1 if found.tool.alike else 2]
    for plane, name in enumerate(planes):
        yield name, caption, partial(transmission, found, plane, modes)


def _moment(found: ToolFindings) -> Iterator[Entry]:
    if found.sweep is None or found.sweep.response is None:
        return
    from equipoise.figures.handheld import moment

    caption = to_say("Bending moment and displacement along the shaft.")
    yield "moment", caption, partial(moment, found.sweep.response, None)


def _exposure(found: ToolExposure) -> Iterator[Entry]:
    from equipoise.figures.handheld import acceleration, weighted

    caption = to_say("Acceleration of the hands against speed of the engine.")
    yield "acceleration", caption, partial(acceleration, found)
    caption = to_say("Daily exposure of the hands, with what is allowed.")
    yield "exposure", caption, partial(weighted, found)


def _design(found: ToolFindings) -> Iterator[Entry]:
    if found.design is None:
        return
    from equipoise.figures.handheld import design

    caption = to_say("What the hand that gets most gets over the band of speeds, before and after.")
    yield "design", caption, partial(design, found.design)
