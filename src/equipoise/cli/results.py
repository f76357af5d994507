"""Where a command's results go: standard output, a table, pictures."""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from types import ModuleType
from typing import TYPE_CHECKING, Any, Literal

from equipoise.cli.options import check_belonging, check_folder, check_target

if TYPE_CHECKING:
    import numpy as np
    from matplotlib.figure import Figure

    from equipoise.mechanism.model import Machine

Kind = Literal["svg", "png", "pdf"]
Columns = Sequence[tuple[str, str, "np.ndarray[Any, Any]"]]


@dataclass(frozen=True)
class Wanted:
    """What a command was asked to give: JSON instead of tables, a CSV file, pictures."""

    json: bool
    csv: str | None
    plot: str | None
    format: Kind | None

    def check(self, file: str, machine: Machine, others: Sequence[str] = ()) -> None:
        """Results must have a place to go; `others` are further files with a part in it."""
        check_belonging("--plot", self.plot, format=self.format)
        if self.csv is not None:
            check_target("--csv", self.csv, file, machine, others)
        if self.plot is not None:
            check_folder("--plot", self.plot)

    def give(
        self,
        columns: Callable[[], Columns] | None,
        drawings: Callable[[], Mapping[str, Figure]],
        values: Callable[[], dict[str, Any]],
        show: Callable[[], None],
    ) -> None:
        """Write the files that are wanted, then print; what is not wanted is not made."""
        if self.csv is not None and columns is not None:
            write_csv(columns(), self.csv)
        if self.plot is not None:
            draw(drawings(), self.plot, self.format or "svg")
        if self.json:
            from equipoise.schema.output import json_text

            print(json_text(values()))
        else:
            show()


def write_csv(columns: Columns, path: str) -> None:
    """Write columns, as name, unit and values, and say so."""
    from equipoise.schema.output import csv_text, write

    write(path, csv_text(columns))
    print(f"wrote {path}", file=sys.stderr)


def draw(figures: Mapping[str, Figure], folder: str, kind: Kind) -> None:
    """Write pictures into a folder, and say so."""
    from equipoise.plotting.style import render
    from equipoise.schema.output import write_all

    pictures = {f"{name}.{kind}": render(figure, kind) for name, figure in figures.items()}
    write_all(folder, pictures)
    count = "1 picture" if len(pictures) == 1 else f"{len(pictures)} pictures"
    print(f"wrote {count} to {folder}", file=sys.stderr)


def vibration() -> ModuleType:
    """The pictures of vibration; Matplotlib is imported when the first is drawn, not before."""
    from equipoise.plotting import vibration

    return vibration
