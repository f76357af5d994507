"""The pictures of a hand-held tool's report."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial

from equipoise.i18n import to_say
from equipoise.present import tool_headlines
from equipoise.present.entries import PictureEntry, pages
from equipoise.present.findings import ToolFindings


def of_tool(findings: ToolFindings) -> Iterator[PictureEntry]:
    """The tool itself, modes, transmission, what the hands get, and the design."""
    from equipoise.figures import tool_designs, tool_shaft, tool_side, tool_speeds

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
            shapes_chart = partial(tool_shaft.shapes, modes, plane)
            value = partial(tool_headlines.lowest, modes, plane)
            yield from pages(f"modes{name}", caption, shapes_chart, value, detail=True)
    if transmission is not None:
        caption = to_say("Share of a shaking force that comes to what holds the tool.")
        for plane, name in enumerate(planes):
            draw = partial(tool_speeds.transmission, transmission, plane, modes)
            value = partial(tool_headlines.passed, transmission, plane)
            yield PictureEntry(f"transmission{name}", caption, draw, value, plane > 0)
    if findings.sweep is not None and findings.sweep.response is not None:
        caption = to_say("Bending moment and displacement along the shaft.")
        draw = partial(tool_shaft.moment, findings.sweep.response, None)
        yield PictureEntry("moment", caption, draw, detail=True)
    if findings.exposure is not None:
        caption = to_say("Acceleration of the hands against speed of the engine.")
        yield PictureEntry(
            "acceleration",
            caption,
            partial(tool_speeds.acceleration, findings.exposure),
            partial(tool_headlines.worst, findings),
            detail=True,
        )
        caption = to_say("Daily exposure of the hands, with what is allowed.")
        yield PictureEntry(
            "exposure",
            caption,
            partial(tool_speeds.weighted, findings.exposure),
            partial(tool_headlines.judged, findings),
        )
    if findings.design is not None:
        caption = to_say("The tool from the side before and after what is changed.")
        yield PictureEntry("side-design", caption, partial(tool_side.side_design, findings.design))
        caption = to_say("Vibration of the worst hand over the band of speeds, before and after.")
        yield PictureEntry(
            "design",
            caption,
            partial(tool_designs.design, findings.design),
            partial(tool_headlines.improved, findings),
        )
