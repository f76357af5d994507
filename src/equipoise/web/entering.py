"""What a page asks about the tables of the file: which there are, and to change them."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager
from threading import Lock
from typing import Protocol

from equipoise.web.drawn import Drawn, plain_of, with_entry
from equipoise.web.edits import Solved
from equipoise.web.messages import Message
from equipoise.web.replies import Reply
from equipoise.web.tables import tables_of


class Session(Protocol):
    """What answers need of a session."""

    lock: Lock

    def base(self) -> Solved | Drawn:
        """What is, finished or not."""

    def go_to(self, found: Solved | Drawn, label: str) -> None:
        """Make another design the one that is."""

    def telling(self) -> AbstractContextManager[None]:
        """Inside, the reader's language is spoken, in the units of the file that is open."""

    def told(self, seq: int | None, *notes: str) -> Iterator[Reply]:
        """Tell of what is shown."""


def _tables(session: Session, message: Message) -> Iterator[Reply]:
    with session.telling():
        told = tables_of(plain_of(session.base()))
    yield Reply({"type": "tables", "seq": message.seq, **told})


def _entry(session: Session, message: Message) -> Iterator[Reply]:
    with session.lock, session.telling():
        session.go_to(with_entry(session.base(), message.entry()), message.label)
    yield from session.told(message.seq)


ASKED: dict[str, Callable[[Session, Message], Iterator[Reply]]] = {
    "tables": _tables,
    "entry": _entry,
}
