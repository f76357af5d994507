"""Files of any kind, linkages, tools and studies: each goes to the module of its kind."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING, Any

from equipoise.keys import Frozen
from equipoise.mechanism.parts.machine import Machine
from equipoise.schema.files import write
from equipoise.schema.models import dumped, loads_linkage, loads_tool, save_model
from equipoise.schema.open_files import FolderPath, Opened, kind_of_text, opened

if TYPE_CHECKING:
    from equipoise.handheld.model import Tool
    from equipoise.studies.study import Study


def load(path_or_name: str | os.PathLike[str]) -> Any:
    """Read a file of any kind, or a bundled example by its name.

    Parameters
    ----------
    path_or_name : path of a TOML file; if there is none of that name, a name from `examples`.

    Returns
    -------
    Machine, Tool or Study
        In SI units and radians.  A file of no recognizable kind is read as that of a linkage.

    Raises
    ------
    ModelError
        One sentence: file, table and key, what was given and what would be right.
    """
    return _loaded(opened(path_or_name))


def loads(text: str, source: str = "<text>", folder: FolderPath = None) -> Any:
    """Read the text of a file of any kind, as `load`.

    Parameters
    ----------
    text : TOML.
    source : name for it in errors.
    folder : where what it names is; without it tables are refused, and only bundled models found.
    """
    return _loaded(Opened(text, source, None if folder is None else Path(folder)))


def _loaded(file: Opened) -> Machine | Tool | Study:
    kind = kind_of_text(file.text)
    if kind == "study":
        from equipoise.schema.studies import study_in

        return study_in(file)
    read = loads_tool if kind == "tool" else loads_linkage
    return read(*file)


def dumps(model: Machine | Tool | Study) -> str:
    """Write a machine, tool or study as the text of its file; reading it gives an equal one.

    Tables and linkages in files of their own are named, not written: `save` writes them too.

    Raises
    ------
    ModelError
        Something has no file name, or a section has what no file can represent.
    """
    if isinstance(model, Frozen):
        return dumped(model)
    from equipoise.schema.studies import study_text

    return study_text(model)


def save(model: Machine | Tool | Study, path: str | os.PathLike[str]) -> None:
    """Write a machine, tool or study as its file, and what lies in files of its own beside it.

    Those are called ``<stem>.load-<n>.csv``, ``<stem>.soil.csv``, ``<stem>.motor.csv``,
    ``<stem>.linkage-<n>.toml`` and ``<stem>.impedance-<n>.csv``; a linkage that is a bundled
    example keeps its name.  Each file is afterwards either the old or the new one, never half of
    it; the model file comes last, so that it never names a file that is not there.

    Raises
    ------
    UsageError
        The file cannot be written; says why.
    ModelError
        A section has what no file can represent.
    """
    if isinstance(model, Frozen):
        save_model(model, Path(path))
    else:
        write(Path(path), dumps(model))
