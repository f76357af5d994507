"""Answers about a hand-held tool, and how they are given."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

from equipoise.cli.outputs import Drawn
from equipoise.errors import UsageError

if TYPE_CHECKING:
    import numpy as np

    from equipoise.figures import Picture
    from equipoise.handheld.exposed import ToolExposure
    from equipoise.handheld.model import Tool
    from equipoise.handheld.modes import ToolModes
    from equipoise.handheld.sweep import ToolSweep
    from equipoise.present.cells import Units

RANGE = '"2000 rpm : 9000 rpm"'


def give(
    tool: Tool,
    parts: Sequence[Any],
    drawings: Iterable[Callable[[], Mapping[str, Picture]]],
    units: Units,
    outputs: Drawn,
    key: str = "",
) -> None:
    """Draw what was found, then print it below what the tool is.

    key : of the JSON object below which it stands, if not beside the title.
    """

    def drawn() -> Mapping[str, Picture]:
        return {name: one for draw in drawings for name, one in draw().items()}

    def values() -> Mapping[str, Any]:
        told = {name: one for part in parts for name, one in part.to_dict().items()}
        return {"title": tool.title, **({key: told} if key else told)}

    def show() -> None:
        print_tool(tool, units, *(part.blocks() for part in parts))

    outputs.give(drawn, values, show)


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

    @property
    def sweep(self) -> ToolSweep:
        """Transmission and response over speeds."""
        from equipoise.handheld.sweep import sweep_tool

        length = self.tool.shaft.length
        for place in self.places:
            if not 0 <= place <= length:
                raise UsageError(
                    f"--at: got {place:g} m, off the shaft; give places from 0 to {length:g} m"
                )
        return sweep_tool(self.tool, self.range, self.places)

    @property
    def exposure(self) -> ToolExposure:
        """What the hands get."""
        from equipoise.handheld.exposed import expose_tool

        return expose_tool(self.tool, self.range, self.duration)

    def pictures(self, found: ToolModes | ToolSweep | ToolExposure) -> Mapping[str, Picture]:
        """Pictures of an answer; free vibration stands in those of others, too."""
        from equipoise.figures import tool_designs, tool_shaft, tool_speeds
        from equipoise.handheld.modes import ToolModes
        from equipoise.handheld.studies import determinant_chart
        from equipoise.handheld.sweep import ToolSweep

        drawn: dict[str, Picture] = {}
        if isinstance(found, ToolModes):
            chart = determinant_chart(self.tool, 1.1 * float(found.planes[0].parameter[-1]))
            drawn |= tool_shaft.mode_charts(found)
            drawn |= tool_designs.determinant_charts(chart, found)
        elif isinstance(found, ToolSweep):
            if found.transmissions is not None:
                drawn |= tool_speeds.transmission_charts(found.transmissions, self.modes)
            if found.response is not None:
                drawn |= tool_shaft.response_charts(found.response)
        else:
            drawn |= tool_speeds.exposure_charts(found)
        return drawn


def tool_of(file: str, units: str) -> tuple[Tool, Units]:
    """The tool of a file, and the units in which its vibration is printed."""
    from equipoise.present.cells import read_units
    from equipoise.schema.models import load_tool

    return load_tool(file), read_units(units)


def print_tool(tool: Tool, units: Units, *answers: Iterable[Any]) -> None:
    """Print what a tool is, and blocks below it."""
    from equipoise.handheld.blocks import summary_blocks
    from equipoise.present import show_blocks

    show_blocks(tool.title, summary_blocks(tool), units=units)
    for blocks in answers:
        show_blocks(None, blocks, units=units)


def pictures_of(found: Any) -> Mapping[str, Picture]:
    from equipoise.figures import pictures

    return pictures.pictures_of(found)
