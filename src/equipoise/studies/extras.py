"""Libraries that only studies need, each loaded when it is."""

from __future__ import annotations

from importlib import import_module
from typing import Any

from equipoise.errors import UsageError


def needed(module: str, purpose: str) -> Any:
    """A module of a library that not every user has.

    Raises
    ------
    UsageError : it is not installed; the sentence tells the command that installs it.
    """
    try:
        return import_module(module)
    except ModuleNotFoundError as error:
        library = module.split(".", maxsplit=1)[0]
        if error.name is None or error.name.split(".", maxsplit=1)[0] != library:
            raise
        extra = "cluster" if library == "distributed" else "studies"
        raise UsageError(
            f"{purpose} needs {library}, which is not installed; install it with: "
            f'pip install "equipoise[{extra}]"'
        ) from error
