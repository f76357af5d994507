"""What the options of `tool` ask for, and where its results are to go."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

from equipoise.cli.options import (
    check_folder,
    check_new_files,
    check_result_file,
    ends_of_range,
    quantity,
    whole,
)
from equipoise.errors import UsageError
from equipoise.handheld.model import Tool
from equipoise.handheld.sweep import MODES, default_answers, default_speeds
from equipoise.schema.files import printable
from equipoise.terminal.units import Units

if TYPE_CHECKING:
    import numpy as np

    from equipoise.handheld.design import ToolDesign
    from equipoise.handheld.modes import ToolModes

RANGE = '"2000 rpm : 9000 rpm"'
MOST_MODES, MOST_SPEEDS = 100, 5_000


@dataclass(frozen=True)
class Asked:
    """A tool and what the options say of it, as they were given."""

    tool: Tool
    file: str
    number: str | None
    respond: str | None
    speeds: str | None
    duration: str | None
    vary: str | None
    at: str | None
    units: Units

    def names(self, chosen: Sequence[str]) -> Sequence[str]:
        """Answers that are asked for; where none is, those that the file has what is needed for."""
        if self.number is not None and chosen and not {"modes", "vary"} & {*chosen}:
            raise UsageError("--number belongs to --modes or --vary; give one of them too")
        return chosen or default_answers(self.tool)

    def check_places(self, csv: str | None, plot: str | None, out: str | None) -> None:
        """Results must have a place to go, before time is spent on them."""
        from equipoise.schema.models import files_of, parts_of

        if plot is not None:
            check_folder("--plot", plot)
        if csv is not None:
            folder = os.path.dirname(self.file)
            beside = [os.path.join(folder, part.file) for part in parts_of(self.tool) if part.file]
            check_result_file("--csv", csv, [self.file, *beside])
        if out is not None:
            check_new_files(out, lambda name: files_of(self.tool, name))

    @property
    def count(self) -> int:
        """Natural frequencies."""
        return MODES if self.number is None else whole("--number", self.number, 1, MOST_MODES)

    @property
    def ends(self) -> tuple[float, float]:
        """Lowest and highest speed of the engine, rad/s."""
        if self.respond is not None:
            return _range("--respond", self.respond)
        told = default_speeds(self.tool)
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

        many = SPEEDS if self.speeds is None else whole("--speeds", self.speeds, 2, MOST_SPEEDS)
        return speeds_between(self.tool, *self.ends, many)

    @property
    def places(self) -> tuple[float, ...]:
        """Further places of the shaft, m."""
        if self.at is None:
            return ()
        return tuple(quantity("--at", part.strip(), "length") for part in self.at.split(","))

    @cached_property
    def modes(self) -> ToolModes:
        """Free vibration, which several pictures show too."""
        from equipoise.handheld.modes import vibrate_tool

        return vibrate_tool(self.tool, self.count)

    @cached_property
    def better(self) -> ToolDesign:
        """The design."""
        from equipoise.cli.progress import counted
        from equipoise.handheld.design import design_tool

        with counted("search") as told:
            return design_tool(self.tool, told)


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
