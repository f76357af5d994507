"""The command `tool`, and what else can be asked of a hand-held tool."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from functools import cached_property
from itertools import chain
from typing import TYPE_CHECKING, Annotated, Any

from cyclopts import App, Parameter

from equipoise.cli.models import DesignFile, ToolFile
from equipoise.cli.options import (
    Out,
    check_belonging,
    count,
    ends_of_range,
    error_in_option,
    quantity,
    read_by,
    sizes,
    time_a_day,
)
from equipoise.cli.outputs import (
    Length,
    Outputs,
    PictureSource,
    PlottedOutput,
    Printed,
    check_new,
    write_model,
)
from equipoise.cli.progress import counted
from equipoise.cli.runner import CommandResult, command
from equipoise.dataclass import dataclass
from equipoise.errors import ModelError, UsageError, at_place
from equipoise.i18n import Note, say

if TYPE_CHECKING:
    import numpy as np

    from equipoise.figures import Picture
    from equipoise.handheld.hand_exposure import ToolExposure
    from equipoise.handheld.model import Tool
    from equipoise.handheld.modes import ToolModes
    from equipoise.handheld.sweep import ToolSweep
    from equipoise.results.blocks import Block, ReportSection

app = App(name="tool")
RANGE = '"2000 rpm : 9000 rpm"'
VARY = re.compile(r"(?P<station>\S.*?)\s+(?P<key>\S+)\s*=\s*(?P<low>[^:]*\S)\s*:\s*(?P<high>.*\S)")
MOST_MODES, MOST_SPEEDS = 100, 5_000
VALUES, BAND = 81, 201
"""Values of a number that is varied; speeds at which sensitivities are computed."""


def _range(option: str, text: str) -> tuple[float, float]:
    """Two speeds; a unit may stand after the second only."""
    parts = ends_of_range(text)
    ends = [quantity(option, part, "angular speed") for part in parts if len(parts) == 2]
    if not ends or not 0 < ends[0] < ends[1]:
        raise UsageError(
            at_place(
                option,
                Note(
                    "got {text!r}; give a range of speeds, the slower one first: {range}",
                    text=text,
                    range=RANGE,
                ),
            )
        )
    return ends[0], ends[1]


Speeds = Annotated[Any, read_by(_range, '"2000 : 9000 rpm"')]
ModeCount = Annotated[int | None, count(1, MOST_MODES)]


@app.default
@command(Length, Outputs)
def tool(
    tool: ToolFile,
    /,
    *,
    modes: bool = False,
    number: ModeCount = None,
    respond: Speeds = None,
    speeds: Annotated[int | None, count(2, MOST_SPEEDS)] = None,
    at: Annotated[Any, sizes("length", "300 mm, 1200 mm")] = None,
    exposure: bool = False,
    duration: Annotated[Any, read_by(time_a_day, '"2 h"')] = None,
    outputs: Outputs,
) -> CommandResult:
    """Vibration of a hand-held tool, and the exposure of the hands.

    Without --modes, --respond and --exposure, a summary of all three is printed.

    Parameters
    ----------
    modes
        Natural frequencies, eigenvalues with damping, shapes and their nodes.
    number
        With --modes: how many natural frequencies, 6 if not given.
    respond
        Transmission, forces and motion over a range of speeds of the engine.
    speeds
        Number of speeds in the range (default: 400); more are added near resonances.
    at
        With --respond: additional positions on the shaft to report.
    exposure
        Weighted acceleration of the hands, and daily exposure.
    duration
        Daily time at the working speed, instead of [[work]] of the file.
    """
    from equipoise.handheld.sweep import default_answers

    swept = any(item is not None for item in (respond, speeds, at, outputs.csv))
    chosen = {"modes": modes, "respond": swept, "exposure": exposure or duration is not None}
    names = [name for name, is_chosen in chosen.items() if is_chosen]
    check_belonging("--modes", modes or not names, number=number)
    answers = Asked(tool, number, respond, speeds, tuple(at or ()), duration)
    brief = not names
    names = names or default_answers(tool)
    parts = [getattr(answers, name) for name in names]
    return replace(
        _result(tool, parts, lambda: answers.pictures(names), brief=brief),
        columns=lambda: answers.respond.columns(),  # noqa: PLW0108 - which is computed for it
    )


@dataclass(frozen=True)
class Asked:
    """A tool and what the options say of it."""

    tool: Tool
    number: int | None = None
    range: tuple[float, float] | None = None
    count: int | None = None
    places: tuple[float, ...] = ()
    duration: float | None = None

    @property
    def ends(self) -> tuple[float, float]:
        """Lowest and highest speed of the engine, rad/s."""
        from equipoise.handheld.sweep import default_speeds

        pair = self.range or default_speeds(self.tool)
        if pair is None:
            raise ModelError(
                "operation",
                Note(
                    "missing, so that no speeds are known; add the table [operation], or "
                    "give --respond {range}",
                    range=RANGE,
                ),
            )
        return pair

    @cached_property
    def speeds(self) -> np.ndarray[Any, Any]:
        """Speeds of the engine, rad/s."""
        from equipoise.handheld.sweep import SPEEDS, speeds_between

        return speeds_between(self.tool, *self.ends, self.count or SPEEDS)

    @cached_property
    def modes(self) -> ToolModes:
        """Free vibration, which several pictures show too."""
        from equipoise.handheld.modes import vibrate_tool
        from equipoise.handheld.sweep import MODES

        return vibrate_tool(self.tool, self.number or MODES)

    @cached_property
    def respond(self) -> ToolSweep:
        """Transmission and response over speeds."""
        from equipoise.handheld.sweep import sweep_tool

        length = self.tool.shaft.length
        off = [place for place in self.places if not 0 <= place <= length]
        if off:
            raise UsageError(
                at_place(
                    "--at",
                    Note(
                        "got {position:g} m, off the shaft; give places from 0 to {length:g} m",
                        position=off[0],
                        length=length,
                    ),
                )
            )
        return sweep_tool(self.tool, self.speeds, self.places)

    @cached_property
    def exposure(self) -> ToolExposure:
        """What the hands get."""
        from equipoise.handheld.hand_exposure import expose_tool

        return expose_tool(self.tool, self.speeds, self.duration)

    def pictures(self, names: Sequence[str]) -> Mapping[str, Picture]:
        """Pictures of answers; free vibration stands in those of others, too."""
        from equipoise.figures import tool_charts, tool_side
        from equipoise.handheld.modes import determinant_chart

        pictures_by_name: dict[str, Picture] = {}
        if "modes" in names:
            highest = float(self.modes.planes[0].parameter[-1])
            pictures_by_name |= tool_side.side_mode_charts(self.modes)
            chart = determinant_chart(self.tool, 1.1 * highest)
            pictures_by_name |= tool_charts.determinant_charts(chart, self.modes)
        if "respond" in names and self.respond.transmissions is not None:
            pictures_by_name |= tool_charts.transmission_charts(
                self.respond.transmissions, self.modes
            )
        if "respond" in names and self.respond.response is not None:
            pictures_by_name |= tool_charts.response_charts(self.respond.response)
        if "exposure" in names:
            pictures_by_name |= tool_charts.exposure_charts(self.exposure)
        return pictures_by_name


def _result(
    tool: Tool, parts: Sequence[Any], drawings: PictureSource, key: str = "", brief: bool = False
) -> CommandResult:
    """What was computed, below what the tool is.

    key : of the JSON object below which it stands, if not beside the title.
    brief : whether the headline of each part is printed first.
    """
    from equipoise.handheld.blocks import summary_blocks
    from equipoise.results.blocks import look_at_next

    def values() -> Mapping[str, Any]:
        by_name = {name: item for part in parts for name, item in part.to_dict().items()}
        return {"title": tool.title, **({key: by_name} if key else by_name)}

    def headline(alone: bool) -> Iterator[Block | ReportSection]:
        for part in reversed(parts):  # the hands before the shaft
            yield from part.headline(alone)
        if alone:
            further = ("tool --exposure", "tool --modes", "tool --respond", "tool sensitivities")
            yield look_at_next(*further)

    return CommandResult(
        lambda: chain(summary_blocks(tool), *(part.blocks() for part in parts)),
        values,
        headline=headline if brief else None,
        pictures=drawings,
    )


# -- other questions -------------------------------------------------------------------------------


@app.command
@command(PlottedOutput)
def vary(
    tool: ToolFile,
    change: Annotated[str, Parameter(name="CHANGE")],
    /,
    *,
    number: ModeCount = None,
) -> CommandResult:
    """Natural frequencies against a number of a station.

    Parameters
    ----------
    change
        A station, one of its numbers and a range: "harness position = 0 mm : 400 mm".
    number
        How many natural frequencies, 6 if not given.
    """
    import numpy as np

    from equipoise.handheld.modes import vary_tool
    from equipoise.handheld.shaft import KEYS, check_key
    from equipoise.handheld.sweep import MODES

    match = VARY.fullmatch(change.strip())
    if match is None:
        raise UsageError(
            at_place(
                "CHANGE",
                Note(
                    "got {change!r}; give a station, one of its numbers and a range, such as "
                    '"harness position = 0 mm : 400 mm"',
                    change=change,
                ),
            )
        )
    station, key = match["station"], match["key"]
    with error_in_option("CHANGE"):
        check_key(tool.station(station), key)
    if key.endswith("damping"):
        raise UsageError(
            at_place(
                "CHANGE",
                Note(
                    "got {key!r}, which natural frequencies without damping do not feel; "
                    "vary another number",
                    key=key,
                ),
            )
        )
    low, high = (quantity("CHANGE", match[end], KEYS[key]) for end in ("low", "high"))
    if not low < high:
        raise UsageError(
            at_place(
                "CHANGE",
                Note("got {change!r}; give a range, the smaller value first", change=change),
            )
        )
    with error_in_option("CHANGE"):
        values = np.linspace(low, high, VALUES)
        variation = vary_tool(tool, station, key, values, number or MODES)
    return _result(tool, [variation], variation.charts, "variation")


@app.command
@command(Printed)
def sensitivities(
    tool: ToolFile,
    /,
    *,
    speeds: Speeds = None,
) -> CommandResult:
    """Sensitivity of the hand vibration to each number of a tool.

    Parameters
    ----------
    speeds
        Speeds of the engine; the band of [design] or of [operation] if not given.
    """
    import numpy as np

    from equipoise.handheld.blocks import sensitivity_blocks, summary_blocks
    from equipoise.handheld.hand_exposure import tool_sensitivities

    band = tool.design.speeds if speeds is None and tool.design is not None else speeds
    ends = Asked(tool, range=band).ends
    by_name = tool_sensitivities(tool, np.linspace(*ends, BAND))

    def values() -> Mapping[str, Any]:
        numbers: dict[str, dict[str, float]] = {}
        for (station, key), slope in by_name.items():
            numbers.setdefault(station, {})[key] = slope
        return {"title": tool.title, "sensitivities": numbers}

    return CommandResult(
        lambda: chain(summary_blocks(tool), sensitivity_blocks(tool, by_name, ends)), values
    )


@app.command
@command(PlottedOutput, long=True)
def design(
    tool: DesignFile,
    /,
    *,
    out: Out = None,
) -> CommandResult:
    """Minimize the hand vibration within the limits of [design].

    Parameters
    ----------
    out
        Write the optimized tool to this new file.
    """
    from equipoise.handheld.design import design_tool

    if out is not None:
        check_new(tool, out)
    with counted("search") as progress:
        tool_design = design_tool(tool, progress)

    def save() -> list[str]:
        following = say("; next: {command}", command=f"equipoise tool {out}")
        return [] if out is None else write_model(tool_design.better, out, what_next=following)

    return replace(_result(tool, [tool_design], tool_design.charts, "design"), save=save)
