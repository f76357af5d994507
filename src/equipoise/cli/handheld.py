"""The command `tool`, and what else can be asked of a hand-held tool."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Annotated, Any

from cyclopts import App, Parameter

from equipoise.cli.options import (
    File,
    Out,
    blaming,
    check_new,
    count,
    ends_of_range,
    naming,
    quantity,
    read_by,
    sources_of,
)
from equipoise.cli.outputs import UNITS, Drawn, Outputs, Printed, write_model
from equipoise.cli.progress import counted
from equipoise.cli.tool_answers import RANGE, Asked, give, pictures_of, print_tool, tool_of
from equipoise.errors import UsageError

app = App(name="tool")
VARY = re.compile(r"(?P<station>\S.*?)\s+(?P<key>\S+)\s*=\s*(?P<low>[^:]*\S)\s*:\s*(?P<high>.*\S)")
MOST_MODES, MOST_SPEEDS = 100, 5_000
VALUES, BAND = 81, 201
"""Values of a number that is varied; speeds over which sensitivities are told."""
DAY = 86_400.0


def _range(option: str, text: str) -> tuple[float, float]:
    """Two speeds; a unit may stand after the second only."""
    wrong = f"{option}: got {text!r}; give a range of speeds, the slower one first: {RANGE}"
    parts = ends_of_range(text)
    if len(parts) != 2:
        raise UsageError(wrong)
    low, high = (quantity(option, part, "angular speed") for part in parts)
    if not 0 < low < high:
        raise UsageError(wrong)
    return low, high


def _places(option: str, text: str) -> tuple[float, ...]:
    return tuple(quantity(option, part.strip(), "length") for part in text.split(","))


def _duration(option: str, text: str) -> float:
    duration = quantity(option, text, "time")
    if not 0 < duration <= DAY:
        raise UsageError(f"{option}: got {text!r}; give more than 0 and at most 24 h a day")
    return duration


Speeds = Annotated[Any, read_by(_range)]
Number = Annotated[int | None, count(1, MOST_MODES)]


@app.default
def tool(
    file: File,
    /,
    *,
    modes: bool = False,
    number: Number = None,
    respond: Speeds = None,
    speeds: Annotated[int | None, count(2, MOST_SPEEDS)] = None,
    at: Annotated[Any, read_by(_places)] = None,
    exposure: bool = False,
    duration: Annotated[Any, read_by(_duration)] = None,
    units: Annotated[str, UNITS] = "",
    outputs: Outputs = Outputs(),
) -> None:
    """A hand-held tool: how its shaft vibrates, and what the hands get.

    Without any of --modes, --respond and --exposure it tells all three.

    Parameters
    ----------
    file
        Path of a tool's file, with a table [shaft], or the name of a bundled example.
    modes
        Natural frequencies, eigenvalues with damping, shapes and their nodes.
    number
        With --modes: how many natural frequencies, 6 if not given.
    respond
        Transmission, forces and motion over a range of speeds of the engine: "2000 rpm : 9000 rpm".
    speeds
        Number of speeds in the range, 400 if not given; more are added about resonances.
    at
        With --respond: further places of the shaft to be told of, "300 mm, 1200 mm".
    exposure
        Weighted acceleration of the hands, and what a day of work amounts to.
    duration
        Time a day at the working speed, "2 h", in the place of the file's [[work]].
    """
    from equipoise.handheld.sweep import ToolSweep, default_answers

    loaded, shown_in = tool_of(file, units)
    swept = any(one is not None for one in (respond, speeds, at, outputs.csv))
    exposed = exposure or duration is not None
    chosen = {"modes": modes, "respond": swept, "exposure": exposed}
    names = [name for name, is_chosen in chosen.items() if is_chosen]
    if number is not None and names and not modes:
        raise UsageError("--number belongs to --modes; give both")
    outputs.check(sources_of(loaded, file))
    asked = Asked(loaded, file, shown_in, number, respond, speeds, tuple(at or ()), duration)
    with naming(file):
        answers = {"modes": "modes", "respond": "sweep", "exposure": "exposure"}
        parts = [getattr(asked, answers[name]) for name in names or default_answers(loaded)]
    for found in parts:
        if isinstance(found, ToolSweep):
            outputs.write(found.columns)
    drawings = (lambda found=found: asked.pictures(found) for found in parts)
    give(loaded, parts, drawings, shown_in, outputs)


# -- other questions -------------------------------------------------------------------------------


@app.command
def vary(
    file: File,
    change: Annotated[str, Parameter(name="CHANGE")],
    /,
    *,
    number: Number = None,
    units: Annotated[str, UNITS] = "",
    outputs: Drawn = Drawn(),
) -> None:
    """Natural frequencies against a number of a station.

    Parameters
    ----------
    file
        Path of a tool's file, with a table [shaft], or the name of a bundled example.
    change
        A station, one of its numbers and a range: "harness position = 0 mm : 400 mm".
    number
        How many natural frequencies, 6 if not given.
    """
    import numpy as np

    from equipoise.handheld.design_plan import KEYS
    from equipoise.handheld.studies import check_key, vary_tool
    from equipoise.handheld.sweep import MODES

    loaded, shown_in = tool_of(file, units)
    match = VARY.fullmatch(change.strip())
    if match is None:
        raise UsageError(
            f"CHANGE: got {change!r}; give a station, one of its numbers and a range, such as "
            '"harness position = 0 mm : 400 mm"'
        )
    station, key = match["station"], match["key"]
    with blaming("CHANGE"):
        check_key(loaded.station(station), key)
    if key.endswith("damping"):
        raise UsageError(
            f"CHANGE: got {key!r}, which natural frequencies without damping do not feel; vary "
            "another number"
        )
    low, high = (quantity("CHANGE", match[end], KEYS[key]) for end in ("low", "high"))
    if not low < high:
        raise UsageError(f"CHANGE: got {change!r}; give a range, the smaller value first")
    with naming(file), blaming("CHANGE"):
        values = np.linspace(low, high, VALUES)
        found = vary_tool(loaded, station, key, values, number or MODES)
    give(loaded, [found], [lambda: pictures_of(found)], shown_in, outputs, "variation")


@app.command
def sensitivities(
    file: File,
    /,
    *,
    speeds: Speeds = None,
    units: Annotated[str, UNITS] = "",
    outputs: Printed = Printed(),
) -> None:
    """What each number of a tool does to the hands.

    Parameters
    ----------
    file
        Path of a tool's file, with a table [shaft], or the name of a bundled example.
    speeds
        Speeds of the engine, "5000 rpm : 6000 rpm"; the band of [design] or of [operation] if not
        given.
    """
    import numpy as np

    from equipoise.handheld.exposed import tool_sensitivities

    loaded, shown_in = tool_of(file, units)
    band = loaded.design.speeds if speeds is None and loaded.design is not None else speeds
    asked = Asked(loaded, file, shown_in, respond=band)
    with naming(file):
        found = tool_sensitivities(loaded, np.linspace(*asked.ends, BAND))

    def show() -> None:
        from equipoise.handheld.hand_blocks import sensitivity_blocks

        print_tool(loaded, shown_in, sensitivity_blocks(loaded, found, asked.ends))

    def values() -> Mapping[str, Any]:
        told: dict[str, dict[str, float]] = {}
        for (station, key), slope in found.items():
            told.setdefault(station, {})[key] = slope
        return {"title": loaded.title, "sensitivities": told}

    outputs.print(values, show)


@app.command
def design(
    file: File,
    /,
    *,
    out: Out = None,
    units: Annotated[str, UNITS] = "",
    outputs: Drawn = Drawn(),
) -> None:
    """Change what [design] allows so that the hands feel least.

    Parameters
    ----------
    file
        Path of a tool's file, with a table [design], or the name of a bundled example.
    out
        Write the better tool to this new file.
    """
    from equipoise.handheld.design import design_tool

    loaded, shown_in = tool_of(file, units)
    if out is not None:
        check_new(loaded, out)
    with naming(file), counted("search") as progress:
        found = design_tool(loaded, progress)
    if out is not None:
        write_model(found.better, out, what_next=f"; next: equipoise tool {out}")
    give(loaded, [found], [lambda: pictures_of(found)], shown_in, outputs, "design")
