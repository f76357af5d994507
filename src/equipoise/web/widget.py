"""The live page in a notebook: Jupyter, marimo and whatever else shows an anywidget."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING

from equipoise.errors import UsageError
from equipoise.i18n import Note
from equipoise.mechanism.parts.machine import Machine
from equipoise.web.design import Design
from equipoise.web.gallery import opened_file
from equipoise.web.session import Session

if TYPE_CHECKING:
    from equipoise.web.notebook import NotebookView

MISSING = Note('a widget needs anywidget; install it by: pip install "equipoise[notebook]"')


def view(machine: Machine | str | os.PathLike[str]) -> NotebookView:
    """Show a machine in a notebook, where it moves and can be dragged and changed.

    Parameters
    ----------
    machine : a machine, the path of its file, or the name of an example.

    Returns
    -------
    View
        The widget; its `machine` is the machine as it has been changed by now.

    Raises
    ------
    UsageError : anywidget is not installed, or the page has not been built.
    EquipoiseError : the machine cannot be computed.
    """
    try:
        from equipoise.web.notebook import NotebookView
    except ModuleNotFoundError as error:
        if error.name not in {"anywidget", "ipywidgets", "traitlets"}:
            raise
        raise UsageError(MISSING) from error
    design = (
        Design(machine.title, machine) if isinstance(machine, Machine) else opened_file(machine)
    )
    session = Session()
    session.open(design)
    return NotebookView(session)
