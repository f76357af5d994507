"""The command `tool`, and what else can be asked of a hand-held tool."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Annotated, Any

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
from equipoise.errors import UsageError

if TYPE_CHECKING:
    import numpy as np

    from equipoise.figures import Picture
    from equipoise.handheld.model import Tool
    from equipoise.handheld.modes import ToolModes
    from equipoise.present.cells import Units

app = App(name="tool")
RANGE = '"2000 rpm : 9000 rpm"'
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
    from equipoise.handheld.sweep import default_answers

    loaded, shown_in = _tool(file, units)
    swept = any(one is not None for one in (respond, speeds, at, outputs.csv))
    exposed = exposure or duration is not None
    chosen = {"modes": modes, "respond": swept, "exposure": exposed}
    names = [name for name, is_chosen in chosen.items() if is_chosen]
    if number is not None and names and not modes:
        raise UsageError("--number belongs to --modes; give both")
    outputs.check(sources_of(loaded, file))
    asked = Asked(loaded, file, shown_in, number, respond, speeds, tuple(at or ()), duration)
    with naming(file):
        parts = [getattr(asked, f"of_{name}")() for name in names or default_answers(loaded)]
    for part in parts:
        if part.columns is not None:
            outputs.write(part.columns)

    def drawings() -> Mapping[str, Picture]:
        drawn: dict[str, Picture] = {}
        for part in parts:
            drawn |= part.drawings()
        return drawn

    def values() -> Mapping[str, Any]:
        told: dict[str, Any] = {"title": loaded.title}
        for part in parts:
            told |= part.values()
        return told

    def show() -> None:
        _print_head(loaded, shown_in)
        for part in parts:
            part.show()

    outputs.give(drawings, values, show)


@dataclass(frozen=True)
class Part:
    """One answer: as plain values, as tables, as pictures and as columns, made when asked for."""

    values: Callable[[], Mapping[str, Any]]
    show: Callable[[], None]
    drawings: Callable[[], Mapping[str, Picture]]
    columns: Any = None


@dataclass(frozen=True)
class Asked:
    """A tool and what the options say of it."""

    tool: Tool
    file: str
    units: Units
    number: int | None = None
    respond: tuple[float, float] | None = None
    speeds: int | None = None
    places: tuple[float, ...] = ()
    duration: float | None = None

    @property
    def ends(self) -> tuple[float, float]:
        """Lowest and highest speed of the engine, rad/s."""
        from equipoise.handheld.sweep import default_speeds
        from equipoise.schema.files import printable

        told = self.respond or default_speeds(self.tool)
        if told is None:
            raise UsageError(
                f"{printable(self.file)}: operation: missing, so that no speeds are told; add the "
                f"table [operation], or give --respond {RANGE}"
            )
        return told

    @cached_property
    def range(self) -> np.ndarray[Any, Any]:
        """Speeds of the engine, rad/s."""
        from equipoise.handheld.sweep import SPEEDS, speeds_between

        return speeds_between(self.tool, *self.ends, self.speeds or SPEEDS)

    @cached_property
    def modes(self) -> ToolModes:
        """Free vibration, which several pictures show too."""
        from equipoise.handheld.modes import vibrate_tool
        from equipoise.handheld.sweep import MODES

        return vibrate_tool(self.tool, self.number or MODES)

    def of_modes(self) -> Part:
        """Free vibration."""
        found = self.modes

        def show() -> None:
            from equipoise.present import show_blocks

            show_blocks(None, found.blocks(), units=self.units)

        def drawings() -> Mapping[str, Picture]:
            from equipoise.figures import handheld as pictures
            from equipoise.handheld.studies import determinant_chart

            chart = determinant_chart(self.tool, 1.1 * float(found.planes[0].parameter[-1]))
            return {
                **pictures.mode_charts(found),
                **pictures.determinant_charts(chart, found),
            }

        return Part(found.to_dict, show, drawings)

    def of_respond(self) -> Part:
        """Transmission and response over speeds."""
        from equipoise.handheld.sweep import sweep_tool

        length = self.tool.shaft.length
        for place in self.places:
            if not 0 <= place <= length:
                raise UsageError(
                    f"--at: got {place:g} m, off the shaft; give places from 0 to {length:g} m"
                )
        found = sweep_tool(self.tool, self.range, self.places)

        def show() -> None:
            from equipoise.present import show_blocks

            show_blocks(None, found.blocks(), units=self.units)

        def drawings() -> Mapping[str, Picture]:
            from equipoise.figures import handheld as pictures

            drawn: dict[str, Picture] = {}
            if found.transmissions is not None:
                drawn |= pictures.transmission_charts(found.transmissions, self.modes)
            if found.response is not None:
                drawn |= pictures.response_charts(found.response)
            return drawn

        return Part(found.to_dict, show, drawings, found.columns)

    def of_exposure(self) -> Part:
        """What the hands get."""
        from equipoise.handheld.exposed import expose_tool

        found = expose_tool(self.tool, self.range, self.duration)

        def show() -> None:
            from equipoise.present import show_blocks

            show_blocks(None, found.blocks(), units=self.units)

        def drawings() -> Mapping[str, Picture]:
            from equipoise.figures import handheld as pictures

            return pictures.exposure_charts(found)

        return Part(found.to_dict, show, drawings)


def _tool(file: str, units: str) -> tuple[Tool, Units]:
    """The tool of a file, and the units in which its vibration is printed."""
    from equipoise.present.units import read_units
    from equipoise.schema.models import load_tool

    return load_tool(file), read_units(units)


def _print_head(tool: Tool, units: Units) -> None:
    from equipoise.handheld.blocks import summary_blocks
    from equipoise.present import show_blocks

    show_blocks(tool.title, summary_blocks(tool), units=units)


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

    loaded, shown_in = _tool(file, units)
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

    def show() -> None:
        from equipoise.present import show_blocks

        _print_head(loaded, shown_in)
        show_blocks(None, found.blocks(), units=shown_in)

    def drawings() -> Mapping[str, Picture]:
        from equipoise.figures import handheld as pictures

        return pictures.variation_charts(found)

    told = {"title": loaded.title, "variation": found.to_dict()}
    outputs.give(drawings, lambda: told, show)


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

    loaded, shown_in = _tool(file, units)
    band = loaded.design.speeds if speeds is None and loaded.design is not None else speeds
    asked = Asked(loaded, file, shown_in, respond=band)
    with naming(file):
        found = tool_sensitivities(loaded, np.linspace(*asked.ends, BAND))

    def show() -> None:
        from equipoise.handheld.blocks import sensitivity_blocks
        from equipoise.present import show_blocks

        _print_head(loaded, shown_in)
        show_blocks(None, sensitivity_blocks(loaded, found, asked.ends), units=shown_in)

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

    loaded, shown_in = _tool(file, units)
    if out is not None:
        check_new(loaded, out)
    with naming(file), counted("search") as progress:
        found = design_tool(loaded, progress)
    if out is not None:
        write_model(found.better, out, what_next=f"; next: equipoise tool {out}")

    def show() -> None:
        from equipoise.present import show_blocks

        _print_head(loaded, shown_in)
        show_blocks(None, found.blocks(), units=shown_in)

    def drawings() -> Mapping[str, Picture]:
        from equipoise.figures import handheld as pictures

        return pictures.design_charts(found)

    told = {"title": loaded.title, "design": found.to_dict()}
    outputs.give(drawings, lambda: told, show)
