"""What several commands do with their options."""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING, Literal

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

    from equipoise.mechanism.model import Machine

Model = Literal["linear", "torque", "moment", "coupled", "exact"]
"""As in `vibration.response`, which would bring NumPy into every start of the command line."""


@contextmanager
def naming(file: str) -> Iterator[None]:
    """Put the file's name in front of what turns out wrong with its machine."""
    try:
        yield
    except (ModelError, MobilityError, MotionError, MassError, ResponseError) as error:
        from equipoise.schema.files import printable

        raise EquipoiseError(f"{printable(file)}: {error}") from error


def check_belonging(owner: str, given: object, **options: object) -> None:
    """An option that would do nothing is told, not passed over."""
    for name, value in options.items():
        if value is not None and given is None:
            raise UsageError(f"--{name.replace('_', '-')} belongs to {owner}; give both")


def quantity(option: str, text: str, dimension: str) -> float:
    from equipoise.quantities import parse

    try:
        return parse(text, dimension)  # type: ignore[arg-type]
    except UsageError as error:
        raise UsageError(f"{option}: {error}") from error


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


def whole(option: str, text: str, least: int, most: int) -> int:
    """A whole number between two others."""
    if not re.fullmatch("[+-]?[0-9]{1,9}", text) or not least <= int(text) <= most:
        raise UsageError(f"{option}: got {text!r}; give a whole number from {least} to {most}")
    return int(text)


def check_folder(option: str, path: str) -> None:
    """Pictures need a folder, or a place where one can be made."""
    above = os.path.abspath(path)
    while not os.path.lexists(above) and os.path.dirname(above) != above:
        above = os.path.dirname(above)
    if not path or not os.path.isdir(above):
        raise UsageError(f"{option}: got {path!r}; give the name of a folder that can be made")


def check_new(machine: Machine, path: str) -> None:
    """A new model file must have a place to go, and take no other's."""
    from equipoise.schema.models import files_of

    check_new_files(path, lambda name: files_of(machine, name))


def check_new_files(path: str, files: Callable[[str], Iterable[Path]]) -> None:
    """New files, told by the name of the first, must have a place to go and take no other's."""
    from equipoise.schema.files import printable

    if not path:
        raise UsageError("--out: got an empty name; give the name of a file")
    if os.path.isdir(path):
        raise UsageError(f"--out: {printable(path)} is a directory; give the name of a file")
    if not os.path.isdir(os.path.dirname(path) or "."):
        raise UsageError(f"{printable(path)}: there is no such folder; make it, or choose another")
    for file in files(path):
        if os.path.lexists(file):
            raise UsageError(f"{printable(file)}: is there already; choose another name by --out")


def check_target(
    option: str, path: str, file: str, machine: Machine, others: Sequence[str] = ()
) -> None:
    """Results must not take the place of what they come from, and must have a place to go.

    others : further files that are read or written.
    """
    from equipoise.schema.models import parts_of

    folder = os.path.dirname(file)
    sources = [file, *(os.path.join(folder, part.file) for part in parts_of(machine))]
    check_result_file(option, path, sources, others)


def check_result_file(
    option: str, path: str, sources: Sequence[str], others: Sequence[str] = ()
) -> None:
    """The same, told what it comes from."""
    if not path:
        raise UsageError(f"{option}: got an empty name; give the name of a file")
    if os.path.isdir(path):
        raise UsageError(f"{option}: {path} is a directory; give the name of a file")
    if not os.path.isdir(os.path.dirname(path) or "."):
        raise UsageError(f"{option}: {path}: there is no such folder; make it, or choose another")
    if os.path.abspath(path) in map(os.path.abspath, others):
        raise UsageError(f"{option}: {path} has another part in this command; give another name")
    if os.path.exists(path) and any(
        os.path.exists(source) and os.path.samefile(source, path) for source in sources
    ):
        raise UsageError(f"{option}: {path} is what is to be analysed; give another name")
