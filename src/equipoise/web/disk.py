"""The model file that a server was started with: the only one that its pages may write."""

from __future__ import annotations

import os
import re
from dataclasses import field, replace
from hashlib import sha256
from threading import Lock
from typing import TYPE_CHECKING, Any

from equipoise.dataclass import dataclass
from equipoise.errors import EquipoiseError, UsageError
from equipoise.i18n import Note, to_say
from equipoise.mechanism.parts.machine import Machine
from equipoise.schema.documents import dumps, load
from equipoise.schema.files import FileError, printable, read_text, write
from equipoise.schema.models import AdjacentFiles, parts_of
from equipoise.web.design import Design
from equipoise.web.edits import solved
from equipoise.web.replies import Reply

if TYPE_CHECKING:
    from equipoise.handheld.model import Tool

NOT_OF_FILE = to_say("{name} was not opened from a file; download the model instead")
COMMENT = re.compile(r"^\s*#|\s#\s", re.MULTILINE)


@dataclass
class Disk:
    """A model file as it was last read or written.

    Each page has one of its own, so that none writes over what another one has saved.

    path : of the file.  place : where that was when it was opened, without links.
    text : what it holds.  model : that is in it.
    lock : held while it is written, since pages share the file.
    """

    path: str
    place: str
    text: str
    model: Machine | Tool
    lock: Lock = field(default_factory=Lock)

    @property
    def name(self) -> str:
        """Base name of the file, printable."""
        return printable(os.path.basename(self.path))

    @property
    def base(self) -> str:
        """A short sign of what the file holds, by which a page knows what its steps began with."""
        return sha256(self.text.encode()).hexdigest()[:16]

    @property
    def has_comments(self) -> bool:
        """Whether saving would lose comments, which a model does not hold."""
        return COMMENT.search(self.text) is not None

    def status(self, model: Machine | Tool | None) -> dict[str, Any]:
        """Name of the file, and whether it has exactly this model; None is an unfinished model."""
        return {"name": self.name, "saved": self.model == model, "comments": self.has_comments}

    def reply(self, seq: int | None, text: str) -> Reply:
        """The reply that a file is saved; `text` is the model that the page's steps began with."""
        saved = {"name": self.name, "base": self.base, "text": text}
        return Reply({"type": "saved", "seq": seq, **saved})

    def now(self) -> Disk:
        """File for another page, with what it holds by now, where that is of its kind."""
        text = self._on_disk()
        if text is None or text == self.text:
            return replace(self)
        try:
            model = load(self.path)
            if isinstance(model, Machine):
                solved(Design(self.name, model))
            else:
                from equipoise.web.tool_state import ToolFigures

                _ = ToolFigures(model).whole
        except EquipoiseError:
            return replace(self)
        return (
            replace(self, text=text, model=model)
            if type(model) is type(self.model)
            else replace(self)
        )

    def save(self, model: Machine | Tool) -> None:
        """Put a model in the place of what the file holds.

        Raises
        ------
        UsageError : somebody else has changed the file meanwhile, or it cannot be written, or
            lacks a table beside it.
        ModelError : it has what no file can represent.
        """
        text = dumps(model)
        with self.lock:
            if self._on_disk() != self.text:
                raise UsageError(
                    Note(
                        "{name}: the file was changed since it was opened here, by another page or "
                        "program; download the model to keep this one, or load the page again to "
                        "see that one",
                        name=self.name,
                    )
                )
            self._check_tables(model)
            write(self.place, text, links=False)
            self.text, self.model = text, model

    def _check_tables(self, model: Machine | Tool) -> None:
        """Nothing but the model file is written: its tables have to lie beside it."""
        for part in parts_of(model):
            try:
                on_disk = AdjacentFiles(os.path.dirname(self.path)).read(part.sort, part.file)
            except EquipoiseError:
                on_disk = None
            if on_disk != part.value:
                raise UsageError(
                    Note(
                        "{name}: the table {table!r} does not lie beside it as it is here; put it "
                        "there, or download the model with its tables",
                        name=self.name,
                        table=printable(part.file),
                    )
                )

    def _on_disk(self) -> str | None:
        """What the file holds now; None where it cannot be read."""
        try:
            return read_text(self.place, within=os.path.dirname(self.place))
        except FileError:
            return None


def on_disk(path_or_name: str, model: Machine | Tool) -> Disk | None:
    """The file that a model was read from; None of a bundled example."""
    if not os.path.isfile(path_or_name):
        return None
    path, place = os.path.abspath(path_or_name), os.path.realpath(path_or_name)
    return Disk(path, place, read_text(place), model)
