"""The model file that a server was started with: the only one that its pages may write."""

from __future__ import annotations

import os
import re
from dataclasses import dataclass, field
from hashlib import sha256
from threading import Lock
from typing import Any

from equipoise.errors import UsageError
from equipoise.i18n import Note
from equipoise.schema.documents import dumps
from equipoise.schema.files import FileError, printable, read_text, write
from equipoise.web.design import Design
from equipoise.web.edits import Solved, solved

COMMENT = re.compile(r"^\s*#|\s#\s", re.MULTILINE)


@dataclass
class Disk:
    """A model file as it was last read or written.

    path : of the file.  text : what it holds.  found : the design in it, computed.
    lock : held while it is written, since pages share it.
    """

    path: str
    text: str
    found: Solved
    lock: Lock = field(default_factory=Lock)

    @property
    def name(self) -> str:
        """As readers are told of it."""
        return printable(os.path.basename(self.path))

    @property
    def base(self) -> str:
        """A short sign of what the file holds, by which a page knows what its steps began with."""
        return sha256(self.text.encode()).hexdigest()[:16]

    @property
    def has_comments(self) -> bool:
        """Whether saving would lose comments, which a model does not hold."""
        return COMMENT.search(self.text) is not None

    def kept(self, found: object) -> dict[str, Any]:
        """Name of the file, and whether it tells just this design, which may be unfinished."""
        machine = found.design.machine if isinstance(found, Solved) else None
        saved = machine is not None and self.found.design.machine == machine
        return {"name": self.name, "saved": saved, "comments": self.has_comments}

    def save(self, found: Solved) -> None:
        """Put a design in the place of what the file holds.

        Raises
        ------
        UsageError : somebody else has changed the file meanwhile, or it cannot be written.
        ModelError : the machine has what no file can tell.
        """
        text = dumps(found.design.machine)
        with self.lock:
            if self._on_disk() != self.text:
                raise UsageError(
                    Note(
                        "{name}: the file was changed on disk since it was opened; download the "
                        "model to keep this one, or start `equipoise serve` again to see that one",
                        name=self.name,
                    )
                )
            write(self.path, text)
            design = Design(found.design.name, found.design.machine)
            self.text, self.found = text, solved(design)

    def _on_disk(self) -> str | None:
        """What the file holds now; None where it cannot be read."""
        try:
            return read_text(self.path)
        except FileError:
            return None


def on_disk(path_or_name: str, found: Solved) -> Disk | None:
    """The file that a design was read from; None of a bundled example."""
    if not os.path.isfile(path_or_name):
        return None
    return Disk(os.path.abspath(path_or_name), read_text(path_or_name), found)
