"""What a page is answered where nothing is computed beside: in a notebook, in its own process."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Protocol

from equipoise.errors import EquipoiseError
from equipoise.web.messages import Message, message_of
from equipoise.web.replies import Reply, busy, completed, refused


class Counterpart(Protocol):
    """What a page talks to."""

    @property
    def language(self) -> str:
        """That the reader speaks."""

    def receive(self, message: Message) -> Iterator[Reply]:
        """Answer a message."""

    @property
    def has_more(self) -> bool:
        """Whether deferred replies are due."""

    def deferred_replies(self) -> Iterator[Reply]:
        """Replies that take too long for every move of a drag."""


def answers(to: Counterpart, content: object) -> Iterator[Reply]:
    """All replies to a message, as it was read from JSON; what takes longer comes last.

    This is all that a transport needs that is no server: it hands `Reply.content` over as an object
    and `Reply.buffer` as bytes, or both as `replies.packed` writes them.
    """
    try:
        message = message_of(content)
    except EquipoiseError as error:
        yield refused(None, error)
        return
    if (begun := busy(message, to.language)) is not None:
        yield begun
    yield from to.receive(message)
    if message.preview:
        return
    if to.has_more:
        yield from to.deferred_replies()
    yield completed(message.seq)
