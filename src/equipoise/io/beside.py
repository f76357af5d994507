"""Reading what a model file names: tables and linkages in files that lie beside it."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, TypeVar

from equipoise.errors import EquipoiseError, ModelError
from equipoise.handheld.model import PLANES
from equipoise.schema.files import printable
from equipoise.schema.opening import Opened, bundled, opened, opened_example
from equipoise.mechanism.field import SoilTable
from equipoise.mechanism.model import LoadTable, Machine
from equipoise.mechanism.motor import MotorTable

if TYPE_CHECKING:
    from equipoise.handheld.model import Impedance

Value = TypeVar("Value")


class Beside:
    """Reads tables by the names of their files, which are relative to the model file's folder.

    folder : None where the model did not come from a file; then every table is refused.
    """

    def __init__(self, folder: Path | None) -> None:
        self.folder = folder

    def load(self, file: str) -> LoadTable:
        from equipoise.schema.tables import read_load

        return read_load(file, self._folder(file))

    def soil(self, file: str) -> SoilTable:
        from equipoise.schema.tables import read_soil

        return read_soil(file, self._folder(file))

    def motor(self, file: str) -> MotorTable:
        from equipoise.schema.tables import read_motor

        return read_motor(file, self._folder(file))

    def impedance(self, file: str) -> Impedance:
        from equipoise.schema.tables import read_impedance

        return read_impedance(file, self._folder(file))

    def linkage(self, file: str) -> Machine:
        """The linkage of another model file, or a bundled one; it has masses and turns fully."""
        from equipoise.schema.models import loads
        from equipoise.mechanism.dynamics import massless
        from equipoise.mechanism.linkage import assemble

        found = self._opened(file)
        try:
            machine = loads(found.text, folder=found.folder)
            _ = assemble(machine).cycle
        except EquipoiseError as error:
            where = f"{error.where}: " if isinstance(error, ModelError) and error.where else ""
            what = error.what if isinstance(error, ModelError) else str(error)
            raise ModelError("", f"{printable(file)}: {where}{what}") from error
        if lacking := massless(machine):
            raise ModelError("", f"{printable(file)}: {lacking}")
        return machine

    def _opened(self, file: str) -> Opened:
        """The model file of a linkage, of which one beside goes before a bundled one."""
        beside = self.folder is not None and os.path.isfile(self.folder / file)
        if not beside and file in bundled():
            return opened_example(file)
        if self.folder is None:
            raise ModelError(
                "",
                f"got {printable(file)!r}; without a file beside which to look, give the name of "
                "an example",
            )
        try:
            return opened(self.folder / file)
        except ModelError as error:
            raise ModelError("", f"{printable(file)}: {error.what}") from error

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


def impedance_keys(where: str, count: int) -> list[str]:
    """Keys that name the tables of impedance of a hand: one for both planes, or one for each."""
    key = f"{where}.impedance"
    return [f"{key}.{plane}" for plane in PLANES] if count == len(PLANES) else [key] * count
