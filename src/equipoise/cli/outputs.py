"""Where a command's results go: options that say so, and what writes tables, pictures, models."""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from dataclasses import replace
from typing import TYPE_CHECKING, Annotated, Any

from cyclopts import Parameter

from equipoise.cli.options import (
    NewFile,
    NewFolder,
    Out,
    ShownIn,
    check_belonging,
    count,
)
from equipoise.dataclass import dataclass
from equipoise.displays import PictureFormat
from equipoise.errors import UsageError, at_place
from equipoise.fence import hold_place, may_be_replaced
from equipoise.i18n import Note, in_each, localized, say, to_say

if TYPE_CHECKING:
    import numpy as np

    from equipoise.figures import Picture
    from equipoise.handheld.model import Tool
    from equipoise.mechanism.parts.machine import Machine
    from equipoise.results.blocks import Block, ReportSection

CsvColumns = Sequence[tuple[str, str, "np.ndarray[Any, Any]"]]
ValueSource = Callable[[], Mapping[str, Any]]
BlockSource = Callable[[], "Iterable[Block | ReportSection]"]
PictureSource = Callable[[], "Mapping[str, Picture]"]
"""Results are made when they are asked for: what is not wanted is not computed."""


FULL_HINT = to_say("--full prints all tables, --json every number.")
"""Below what stands first of a result."""
BRIEF = 15
"""Lines of what stands first, on a terminal that is 80 signs wide."""


@Parameter(name="*")
@dataclass(frozen=True)
class Shown:
    """Units in which a command shows its results."""

    units: ShownIn = None

    @contextmanager
    def showing(self, of: Any = None) -> Iterator[None]:
        """Inside, values are shown in the units that are chosen, else in those of a file."""
        from equipoise.quantities import showing
        from equipoise.results.result import in_own_words

        with showing(self.units or {}), in_own_words(of):
            yield


@Parameter(name="*")
@dataclass(frozen=True)
class Printed(Shown):
    """What a command prints."""

    json: bool = False
    """Print one JSON object in SI units, and nothing else."""


@Parameter(name="*")
@dataclass(frozen=True)
class Length:
    """How much a command prints of what it has found."""

    full: bool = False
    """Print all tables instead of the summary."""


@Parameter(name="*")
@dataclass(frozen=True)
class PlottedOutput(Printed):
    """What a command prints and draws."""

    plot: NewFolder = None
    """Save plots to this folder."""
    format: PictureFormat | None = None
    """With --plot: file format of the plots. Default: svg."""

    def __post_init__(self) -> None:
        check_belonging("--plot", self.plot is not None, format=self.format)
        if self.plot is not None:
            check_folder("--plot", self.plot)


@Parameter(name="*")
@dataclass(frozen=True)
class Pictures(Shown):
    """Where pictures go, and as what."""

    out: Out = None
    """Folder for the plots. Default: FILE-pictures in the current folder."""
    format: PictureFormat = "svg"
    """Kind of the pictures."""

    def of(self, file: str) -> str:
        """Name of the folder."""
        folder = default_name(file, "-pictures") if self.out is None else self.out
        check_folder("--out", folder)
        return folder


@Parameter(name="*")
@dataclass(frozen=True)
class Outputs(PlottedOutput):
    """What a command prints, draws and writes as columns."""

    csv: NewFile = None
    """Write the results as columns to this CSV file."""


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
                at_place(
                    "--design",
                    Note(
                        "got {design}; give a whole number from {least} to {most}",
                        design=self.design,
                        least=least,
                        most=most,
                    ),
                )
            )


# -- writing ---------------------------------------------------------------------------------------
# What these return is said on standard error once everything is in its place.


def write_text(path: str, text: str) -> list[str]:
    """Write a file."""
    from equipoise.schema.files import write

    write(path, text)
    return [wrote(path)]


def wrote(what: str) -> str:
    """What was written."""
    return say("wrote {what}", what=what)


def wrote_pictures(number: int, folder: str) -> str:
    """How many pictures were written."""
    return say("wrote {count} pictures to {folder}", count=number, folder=folder)


def boxes(signs: str, otherwise: Note) -> list[str]:
    """Which signs no font of this computer has, if there are any, and what to do."""
    letters = "".join(dict.fromkeys(signs))[:20]
    if not signs:
        return []
    missing = say(
        "note: no font has {signs}, so boxes are drawn; install one such as Noto Sans CJK, "
        "or {cure}",
        signs=letters,
        cure=localized(otherwise),
    )
    return [missing]


def write_pictures(figures: Mapping[str, Picture], folder: str, kind: PictureFormat) -> list[str]:
    """Write pictures into a folder."""
    from equipoise.figures import render, unwritten
    from equipoise.schema.files import write_all

    write_all(folder, {f"{name}.{kind}": render(figure, kind) for name, figure in figures.items()})
    signs = "" if kind == "svg" else "".join(map(unwritten, figures.values()))
    return [*boxes(signs, Note("give --format svg")), wrote_pictures(len(figures), folder)]


def write_model(
    model: Machine | Tool,
    path: str,
    title: Note | str = "",
    origin: Callable[[], str] = str,
    what_next: str = "",
) -> list[str]:
    """Save a model.

    title : added to its own; origin : says sentences to stand in front of its description.
    """
    from equipoise.schema.documents import save
    from equipoise.schema.models import files_of

    def described(before: str) -> str:
        start, rest = origin(), before
        if start and before:
            rest = say("Started from: {before}", before=before)
        return f"{start} {rest}".strip()

    new_model: Any = replace(
        model,
        title=in_each(
            model.title,
            lambda own_title: f"{own_title.removesuffix(localized(title))}{localized(title)}",
        ),
        description=in_each(model.description, described),
    )
    save(new_model, path)
    return [wrote(" and ".join(map(os.fspath, files_of(new_model, path))) + what_next)]


# -- where results may go --------------------------------------------------------------------------


def default_name(file: str, ending: str) -> str:
    """Name of what is written beside the user where no other is given."""
    return f"{os.path.basename(file).removesuffix('.toml')}{ending}"


PICTURE_ENDINGS = (".svg", ".png", ".pdf", ".jpg", ".jpeg", ".gif", ".webp", ".mp4")
FILE_ENDINGS = frozenset((*PICTURE_ENDINGS, ".csv", ".json", ".toml", ".html"))
"""Of names that nobody means for a folder that is to be made."""


def refuse_file_name(option: str, path: str, what: Note) -> None:
    """Refuse the name of a file for a folder that is not there.

    what : goes into the folder.
    """
    ending = os.path.splitext(path.rstrip(os.sep))[1].lower()
    if ending in FILE_ENDINGS and not os.path.lexists(path):
        raise UsageError(
            at_place(
                option,
                Note(
                    "got {path!r}, the name of a file; give a folder, {content}",
                    path=path,
                    content=what,
                ),
            )
        )


def check_folder(option: str, path: str) -> None:
    """Pictures need a folder, or a place where one can be made."""
    content = Note("into which all pictures go, and their kind by --format")
    refuse_file_name(option, path, content)
    above = os.path.abspath(path)
    while not os.path.lexists(above) and os.path.dirname(above) != above:
        above = os.path.dirname(above)
    if not path or not os.path.isdir(above):
        raise UsageError(
            at_place(
                option, Note("got {path!r}; give the name of a folder that can be made", path=path)
            )
        )


def _check_place(option: str, path: str) -> None:
    """A file needs a name, and a folder that is there."""
    from equipoise.schema.files import printable

    if not path:
        raise UsageError(at_place(option, Note("got an empty name; give the name of a file")))
    place = f"{option}: {printable(path)}"
    if os.path.isdir(path):
        raise UsageError(Note("{place} is a directory; give the name of a file", place=place))
    if not os.path.isdir(os.path.dirname(path) or "."):
        raise UsageError(
            at_place(place, Note("there is no such folder; make it, or choose another"))
        )
    with suppress(OSError):  # reported when the file is written
        hold_place(path)


def check_model_name(path: str, option: str = "--out") -> None:
    """The name of a new model file has no ending that says it is something else."""
    from equipoise.schema.files import printable

    if re.search(r"\.[A-Za-z][A-Za-z0-9]{1,4}$", path) and not path.endswith(".toml"):
        raise UsageError(
            at_place(
                option, Note("got {given!r}; give a name that ends in .toml", given=printable(path))
            )
        )


def check_new(model: Machine | Tool, path: str) -> None:
    """A new model file, and what lies beside it, must have a place to go and take no other's."""
    from equipoise.schema.files import printable
    from equipoise.schema.models import files_of

    _check_place("--out", path)
    check_model_name(path)
    for file in files_of(model, path):
        if os.path.lexists(file) and not may_be_replaced():
            raise UsageError(
                at_place(printable(file), Note("is there already; choose another name by --out"))
            )


def sources_of(model: Machine | Tool, file: str) -> list[str]:
    """The files from which a model was read."""
    from equipoise.schema.models import parts_of

    folder = os.path.dirname(file)
    return [file, *(os.path.join(folder, part.file) for part in parts_of(model) if part.file)]


def check_result_file(
    option: str, path: str, sources: Sequence[str], others: Iterable[str | None] = ()
) -> None:
    """Results must not take the place of what they come from, and must have a place to go.

    others : further files that are written.
    """
    _check_place(option, path)
    if os.path.abspath(path) in (os.path.abspath(other) for other in others if other):
        raise UsageError(
            at_place(
                option,
                Note("{path} has another part in this command; give another name", path=path),
            )
        )
    if os.path.exists(path) and any(
        os.path.exists(source) and os.path.samefile(source, path) for source in sources
    ):
        raise UsageError(
            at_place(option, Note("{path} is what is to be analysed; give another name", path=path))
        )
    if path.endswith(".toml") and os.path.lexists(path):
        raise UsageError(
            at_place(
                option,
                Note("{path} is there already, and may be a model; give another name", path=path),
            )
        )
