"""Reading the tables that a model file names: CSV files that lie beside it."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TypeVar

from equipoise.errors import ModelError
from equipoise.io.files import printable
from equipoise.mechanism.field import SoilTable
from equipoise.mechanism.model import LoadTable
from equipoise.mechanism.motor import MotorTable

Value = TypeVar("Value")


class Beside:
    """Reads tables by the names of their files, which are relative to the model file's folder.

    folder : None where the model did not come from a file; then every table is refused.
    """

    def __init__(self, folder: Path | None) -> None:
        self.folder = folder

    def load(self, file: str) -> LoadTable:
        from equipoise.io.tables import read_load

        return read_load(file, self._folder(file))

    def soil(self, file: str) -> SoilTable:
        from equipoise.io.tables import read_soil

        return read_soil(file, self._folder(file))

    def motor(self, file: str) -> MotorTable:
        from equipoise.io.tables import read_motor

        return read_motor(file, self._folder(file))

    def _folder(self, file: str) -> Path:
        if self.folder is None:
            raise ModelError("", f"got {printable(file)!r}; a table can only be read beside a file")
        return self.folder


def table_at(where: str, file: str | None, read: Callable[[str], Value]) -> Value | None:
    """Read the table that the key `where` names, if it names one; errors tell the key."""
    try:
        return None if file is None else read(file)
    except ModelError as error:
        raise ModelError(where, error.what) from error
