"""Where a command's results go: standard output, a table, pictures, a new model file."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Annotated, Any, Literal

from cyclopts import Parameter

from equipoise.cli.options import (
    Out,
    check_belonging,
    check_folder,
    check_result_file,
    count,
    files_of,
)
from equipoise.errors import UsageError

if TYPE_CHECKING:
    import numpy as np

    from equipoise.figures import Picture
    from equipoise.handheld.model import Tool
    from equipoise.mechanism.model import Machine
    from equipoise.present.cells import Units
    from equipoise.results.result import Result

Kind = Literal["svg", "png", "pdf"]
Columns = Sequence[tuple[str, str, "np.ndarray[Any, Any]"]]

UNITS = Parameter(
    negative="",
    help='Units of the printed tables where they are not to be the usual ones: "um, rad/s".',
)


@Parameter(name="*")
@dataclass(frozen=True)
class Printed:
    """What a command prints."""

    json: bool = False
    """Print one JSON object in SI units, and nothing else."""

    def print(self, values: Callable[[], Mapping[str, Any]], show: Callable[[], None]) -> None:
        """Print values or tables."""
        if self.json:
            from equipoise.schema.output import json_text

            print(json_text(dict(values())))
        else:
            show()

    def show(self, found: Result, units: Units | None = None, **options: Any) -> None:
        """Print a result, further arguments as of `present.show`."""
        from equipoise.present import show

        self.print(found.to_dict, lambda: show(found, units=units, **options))


@Parameter(name="*")
@dataclass(frozen=True)
class Drawn(Printed):
    """What a command prints and draws."""

    plot: str | None = None
    """Draw what is told into this folder."""
    format: Kind | None = None
    """With --plot: kind of the pictures, svg if not given."""

    def __post_init__(self) -> None:
        check_belonging("--plot", self.plot is not None, format=self.format)
        if self.plot is not None:
            check_folder("--plot", self.plot)

    def draw(self, drawings: Callable[[], Mapping[str, Picture]]) -> None:
        """Write pictures into the folder if there is to be one, and say so."""
        if self.plot is not None:
            write_pictures(drawings(), self.plot, self.format or "svg")

    def give_result(self, found: Result, units: Units | None = None, **options: Any) -> None:
        """Write the pictures that are wanted, then print; further arguments as of `show`."""
        from equipoise.figures.pictures import pictures_of

        self.draw(lambda: pictures_of(found))
        self.show(found, units, **options)

    def give(
        self,
        drawings: Callable[[], Mapping[str, Picture]],
        values: Callable[[], Mapping[str, Any]],
        show: Callable[[], None],
    ) -> None:
        """Write the files that are wanted, then print; what is not wanted is not made."""
        self.draw(drawings)
        self.print(values, show)


@Parameter(name="*")
@dataclass(frozen=True)
class Outputs(Drawn):
    """What a command prints, draws and writes as columns."""

    csv: str | None = None
    """Write what is told, column by column, to this file."""

    def check(self, sources: Sequence[str], others: Iterable[str | None] = ()) -> None:
        """Columns must have a place to go: none of those that are read or written besides."""
        if self.csv is not None:
            check_result_file("--csv", self.csv, sources, others)

    def write(self, columns: Callable[[], Columns]) -> None:
        """Write columns, as name, unit and values, if they are wanted."""
        if self.csv is not None:
            from equipoise.schema.output import csv_text

            write_text(self.csv, csv_text(columns()))


@Parameter(name="*")
@dataclass(frozen=True)
class Chosen:
    """A design that is to be written."""

    out: Out = None
    """Write the first of the designs as a new model file."""
    design: Annotated[int | None, count(0, 10_000_000)] = None
    """With --out: number of another design to write."""

    def __post_init__(self) -> None:
        check_belonging("--out", self.out is not None, design=self.design)

    def check(self, least: int, most: int) -> None:
        """The number has to be that of a design."""
        if self.design is not None and not least <= self.design <= most:
            raise UsageError(
                f"--design: got {self.design}; give a whole number from {least} to {most}"
            )


def write_text(path: str, text: str) -> None:
    """Write a file, and say so."""
    from equipoise.schema.files import printable
    from equipoise.schema.output import write

    write(path, text)
    print(f"wrote {printable(path)}", file=sys.stderr)


def write_pictures(figures: Mapping[str, Picture], folder: str, kind: Kind) -> None:
    """Write pictures into a folder, and say so."""
    from equipoise.figures import render
    from equipoise.schema.output import write_all

    write_all(folder, {f"{name}.{kind}": render(figure, kind) for name, figure in figures.items()})
    tell_pictures(len(figures), folder)


def tell_pictures(number: int, folder: str) -> None:
    """Say how many pictures were written."""
    pictures = "1 picture" if number == 1 else f"{number} pictures"
    print(f"wrote {pictures} to {folder}", file=sys.stderr)


def write_model(
    model: Machine | Tool, path: str, title: str = "", origin: str = "", what_next: str = ""
) -> None:
    """Save a model and say so.

    title : added to its own; origin : sentences in front of its description.
    """
    from equipoise.schema.documents import save
    from equipoise.schema.files import printable

    start = f"{origin} Started from: " if origin else ""
    description = f"{start}{model.description}".removesuffix(" Started from: ").strip()
    titled = f"{model.title.removesuffix(title)}{title}"
    made: Any = replace(model, title=titled, description=description)
    save(made, path)
    written = " and ".join(map(printable, files_of(made, path)))
    print(f"wrote {written}{what_next}", file=sys.stderr)
