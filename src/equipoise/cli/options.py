"""What options are: how their texts are read, and what may not be given together.

Values are read where an option is declared: ``speed: Speed = None`` is a number in rad/s, or None.
"""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING, Annotated, Any, Literal

from cyclopts import Parameter

from equipoise.errors import (
    EquipoiseError,
    MassError,
    MobilityError,
    ModelError,
    MotionError,
    ResponseError,
    UsageError,
)

if TYPE_CHECKING:
    from pathlib import Path

    from equipoise.handheld.model import Tool
    from equipoise.mechanism.model import Machine

SIGNED = Parameter(negative="", allow_leading_hyphen=True)
"""Of an option whose value may begin with a minus sign."""

File = Annotated[str, Parameter(name="FILE", negative="")]
StudyFile = Annotated[str, Parameter(name="STUDY", negative="")]
StorePath = Annotated[str, Parameter(name="STORE", negative="")]
Out = Annotated[str | None, Parameter(name=["--out", "-o"], negative="")]
Many = Annotated[list[str] | None, Parameter(negative="", consume_multiple=False)]
Text = Annotated[str | None, SIGNED]
Model = Literal["linear", "torque", "moment", "coupled", "exact"]
"""As in `structures.response`, which would bring NumPy into every start of the command line."""


# -- texts as values -------------------------------------------------------------------------------


def read_by(read: Callable[[str, str], Any], name: str | None = None) -> Parameter:
    """An option whose text is read by a function of option and text; or an argument of a name."""

    def convert(_: Any, tokens: Sequence[Any]) -> Any:
        token = tokens[0]
        return read(token.keyword or name or "", token.value)

    return Parameter(
        name=name, negative="", allow_leading_hyphen=True, n_tokens=1, converter=convert
    )


def size(dimension: str, wanted: str = "", name: str | None = None) -> Parameter:
    """A quantity, in SI units; above zero where it is said what is `wanted` then."""

    def read(option: str, text: str) -> float:
        value = quantity(option, text, dimension)
        if wanted and value <= 0:
            raise UsageError(f"{option}: got {text!r}; {wanted}")
        return value

    return read_by(read, name)


def count(least: int, most: int, name: str | None = None) -> Parameter:
    """A whole number between two others."""

    def read(option: str, text: str) -> int:
        if not re.fullmatch("[+-]?[0-9]{1,9}", text) or not least <= int(text) <= most:
            raise UsageError(f"{option}: got {text!r}; give a whole number from {least} to {most}")
        return int(text)

    return read_by(read, name)


Speed = Annotated[float | None, size("angular speed")]
Angle = Annotated[float | None, size("angle")]


def quantity(option: str, text: str, dimension: str) -> float:
    """A size in SI units."""
    from equipoise.quantities.reading import parse

    with blaming(option):
        return parse(text, dimension)  # type: ignore[arg-type]


def ends_of_range(text: str) -> list[str]:
    """Parts of a range such as ``20 : 400 rpm``, whose unit may stand after the second only.

    One part where there is no colon; none where a part is empty or there are more than two.
    """
    parts = [part.strip() for part in text.split(":")]
    if len(parts) > 2 or not all(parts):
        return []
    if len(parts) == 2 and " " not in parts[0] and " " in parts[1]:
        parts[0] = f"{parts[0]} {parts[1].split(' ', 1)[1]}"
    return parts


# -- whose fault it is -----------------------------------------------------------------------------


@contextmanager
def naming(file: str) -> Iterator[None]:
    """Put the file's name in front of what turns out wrong with its machine."""
    try:
        yield
    except (ModelError, MobilityError, MotionError, MassError, ResponseError) as error:
        from equipoise.schema.files import printable

        raise EquipoiseError(f"{printable(file)}: {error}") from error


@contextmanager
def blaming(option: str) -> Iterator[None]:
    """Put an option, or a file that it named, in front of what turns out wrong with it."""
    try:
        yield
    except (ModelError, UsageError) as error:
        raise UsageError(f"{option}: {error}") from error


@contextmanager
def blaming_by_place(options: Mapping[tuple[str, ...], str]) -> Iterator[None]:
    """Name the option instead of the place in a file that does not have it.

    options : place of a table or key, without numbers in lists -> what is said instead; of several
    that fit, the longest, with what is left of the place behind it.
    """
    try:
        yield
    except ModelError as error:
        place = error.keys
        known = next((place[:n] for n in range(len(place), 0, -1) if place[:n] in options), None)
        if known is None:
            raise
        rest = ".".join(place[len(known) :])
        raise UsageError(": ".join(filter(None, [options[known], rest, error.what]))) from error


def check_belonging(owner: str, given: object, **options: object) -> None:
    """An option that would do nothing is told, not passed over."""
    for name, value in options.items():
        if value is not None and not given:
            raise UsageError(f"--{name.replace('_', '-')} belongs to {owner}; give both")


# -- where results may go --------------------------------------------------------------------------


def check_folder(option: str, path: str) -> None:
    """Pictures need a folder, or a place where one can be made."""
    above = os.path.abspath(path)
    while not os.path.lexists(above) and os.path.dirname(above) != above:
        above = os.path.dirname(above)
    if not path or not os.path.isdir(above):
        raise UsageError(f"{option}: got {path!r}; give the name of a folder that can be made")


def check_new(model: Machine | Tool, path: str) -> list[Path]:
    """A new model file, and what is written beside it, must have a place to go and take no other's.

    Returns the files.
    """
    from equipoise.schema.files import printable

    if not path:
        raise UsageError("--out: got an empty name; give the name of a file")
    if os.path.isdir(path):
        raise UsageError(f"--out: {printable(path)} is a directory; give the name of a file")
    if not os.path.isdir(os.path.dirname(path) or "."):
        raise UsageError(f"{printable(path)}: there is no such folder; make it, or choose another")
    files = files_of(model, path)
    for file in files:
        if os.path.lexists(file):
            raise UsageError(f"{printable(file)}: is there already; choose another name by --out")
    return files


def files_of(model: Machine | Tool, path: str) -> list[Path]:
    """The files in which a model is saved: its own, and tables beside it."""
    from equipoise.schema import saving

    return saving.files_of(model, path)


def sources_of(model: Machine | Tool, file: str) -> list[str]:
    """The files from which a model was read."""
    from equipoise.schema.saving import parts_of

    folder = os.path.dirname(file)
    return [file, *(os.path.join(folder, part.file) for part in parts_of(model) if part.file)]


def check_result_file(
    option: str, path: str, sources: Sequence[str], others: Iterable[str | None] = ()
) -> None:
    """Results must not take the place of what they come from, and must have a place to go.

    others : further files that are written.
    """
    if not path:
        raise UsageError(f"{option}: got an empty name; give the name of a file")
    if os.path.isdir(path):
        raise UsageError(f"{option}: {path} is a directory; give the name of a file")
    if not os.path.isdir(os.path.dirname(path) or "."):
        raise UsageError(f"{option}: {path}: there is no such folder; make it, or choose another")
    if os.path.abspath(path) in (os.path.abspath(other) for other in others if other):
        raise UsageError(f"{option}: {path} has another part in this command; give another name")
    if os.path.exists(path) and any(
        os.path.exists(source) and os.path.samefile(source, path) for source in sources
    ):
        raise UsageError(f"{option}: {path} is what is to be analysed; give another name")
