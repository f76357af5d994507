"""Requests as they come in: one that is not whole in time is dropped with its connection."""

from __future__ import annotations

import asyncio
from typing import Any

import h11
from uvicorn.protocols.http.h11_impl import H11Protocol

LONGEST = 10.0
"""s in which a request has to come, from the opening of its connection or its first byte on.

A browser sends one at once; a connection that is held open with half of it would stay for ever,
and each takes one of the files that the server may open."""


class Incoming(H11Protocol):
    """A connection, with a limit to how long a request may take to come in."""

    def __init__(self, *args: Any, **options: Any) -> None:
        super().__init__(*args, **options)
        self.limit: asyncio.TimerHandle | None = None

    def connection_made(self, transport: asyncio.Transport) -> None:  # type: ignore[override]
        """Begin to wait for the first request."""
        super().connection_made(transport)
        self._wait(True)

    def connection_lost(self, exc: Exception | None) -> None:
        """Wait no more."""
        self._wait(False)
        super().connection_lost(exc)

    def handle_events(self) -> None:
        """Take what has come, or was kept back while an answer was on its way."""
        super().handle_events()
        state = self.conn.their_state
        begun = state is h11.SEND_BODY or (state is h11.IDLE and bool(self.conn.trailing_data[0]))
        # A request for a WebSocket has handed its connection over, and is never taken to its end.
        self._wait(begun and self.transport.get_protocol() is self)

    def _wait(self, begun: bool) -> None:
        if self.limit is not None and not begun:
            self.limit.cancel()
            self.limit = None
        elif self.limit is None and begun:  # what trickles in does not put it off
            self.limit = self.loop.call_later(LONGEST, self.transport.close)
