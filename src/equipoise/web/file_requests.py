"""What a page asks about files: saving its own, others to take along, bundled ones to open."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager
from typing import Protocol

from equipoise.errors import UsageError
from equipoise.i18n import Note
from equipoise.schema.documents import dumps
from equipoise.web.design import Design
from equipoise.web.disk import NOT_OF_FILE, Disk
from equipoise.web.downloads import downloaded
from equipoise.web.edits import Computed
from equipoise.web.gallery import pictured
from equipoise.web.history import History
from equipoise.web.messages import Message
from equipoise.web.replies import Reply


class DesignsSession(Protocol):
    """What answers need of a session."""

    disk: Disk | None
    history: History | None
    wanted: tuple[str, ...]

    def current(self) -> Computed:
        """The design that is."""

    def localized(self) -> AbstractContextManager[None]:
        """Inside, the reader's language is spoken."""

    def state_replies(self, seq: int | None, *notes: str) -> Iterator[Reply]:
        """The design that is shown."""

    def open(self, design: Design, computed: Computed | None = None) -> None:
        """Begin with a design."""

    def receive(self, message: Message) -> Iterator[Reply]:
        """Answer a message."""

    def deferred_replies(self) -> Iterator[Reply]:
        """What takes longer."""


def _save(session: DesignsSession, message: Message) -> Iterator[Reply]:
    current, disk, history = session.current(), session.disk, session.history
    if disk is None or history is None:
        raise UsageError(Note(NOT_OF_FILE, name=current.design.name))
    first = history.first
    text = dumps(first.machine) if isinstance(first, Design) else disk.text
    disk.save(current.design.machine)
    yield from session.state_replies(message.seq)
    yield disk.reply(message.seq, text)


def _download(session: DesignsSession, message: Message) -> Iterator[Reply]:
    current = session.current()

    def everything(language: str) -> Iterator[Reply]:
        """Every reply that a page could get on the design, in a language."""
        other = type(session)()
        other.open(current.design, current)
        other.wanted = tuple(output.name for output in current.analysis.outputs)
        yield from other.receive(Message("speak", None, {"languages": [language]}))
        yield from other.receive(Message("ready", None, {}))
        yield from other.deferred_replies()

    with session.localized():
        content, data = downloaded(current, message, everything)
    yield Reply({"type": "file", "seq": message.seq, **content}, data)


def _gallery(session: DesignsSession, message: Message) -> Iterator[Reply]:
    pictures = pictured()
    while True:
        with session.localized():  # left where this waits: whoever goes on may be another thread
            picture = next(pictures, None)
        if picture is None:
            break
        content, data = picture
        yield Reply({"type": "pictured", "seq": message.seq, **content}, data)
    yield Reply({"type": "gallery", "seq": message.seq})


ASKED: dict[str, Callable[[DesignsSession, Message], Iterator[Reply]]] = {
    "save": _save,
    "download": _download,
    "gallery": _gallery,
}
"""Answers to messages, by their kind."""
