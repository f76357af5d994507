"""The local server of the live page, and requests as they come in.

Only the page whose address was printed may talk to it, from this machine.  A page of another site
can send requests to 127.0.0.1, and a name of another site can be made to point there.  So every
request has to carry the token, a Host that is this server, and, where the browser sends it, an
Origin that is this server too.
"""

from __future__ import annotations

import asyncio
import os
import socket
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from secrets import compare_digest, token_urlsafe
from typing import TYPE_CHECKING, Any

import h11
from uvicorn.protocols.http.h11_impl import H11Protocol

from equipoise.errors import UsageError
from equipoise.i18n import Note
from equipoise.interrupts import answered
from equipoise.schema.files import reason
from equipoise.web.desk import PageBackend
from equipoise.web.documents import TYPES, assets, document
from equipoise.web.lanes import Lanes
from equipoise.web.messages import LARGEST_MESSAGE
from equipoise.web.page import Page, turn_away

if TYPE_CHECKING:
    import uvicorn
    from starlette.requests import Request
    from starlette.types import ASGIApp, Message, Receive, Scope, Send
    from starlette.websockets import WebSocket

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


HOSTS = ("127.0.0.1", "localhost")
TOKEN = "this address has no valid token; open the one that `equipoise serve` has printed"
ORIGIN = "requests from pages of other sites are refused; open the address that was printed"
HOST = "this server answers by the names 127.0.0.1 and localhost only"
POLICY = (
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data: blob:; "
    "connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
)
HEADERS = {
    "content-security-policy": POLICY,
    "x-content-type-options": "nosniff",
    "referrer-policy": "no-referrer",
    "cross-origin-opener-policy": "same-origin",
    "cross-origin-resource-policy": "same-origin",
    "cache-control": "no-store",
}
"""Of every response.  Nothing is loaded from elsewhere, and the token is sent to nobody."""
_ENCODED = [(name.encode(), value.encode()) for name, value in HEADERS.items()]


class Guard:
    """Refuses what does not come from the server's own page, and adds the headers.

    port : of the server.  token : that its page carries.
    """

    def __init__(self, app: ASGIApp, port: int, token: str) -> None:
        self.app, self.query = app, b"token=" + token.encode()
        self.hosts = {f"{name}:{port}" for name in HOSTS} | (set(HOSTS) if port == 80 else set())

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Let a request through, or refuse it with a sentence."""
        if scope["type"] == "lifespan":
            await self.app(scope, receive, send)
            return

        async def with_headers(message: Message) -> None:
            if message["type"].endswith("response.start"):
                message["headers"] = [*message.get("headers", []), *_ENCODED]
            await send(message)

        problem = self.problem(scope)
        if problem:
            await refuse(problem, scope, with_headers)
        else:
            await self.app(scope, receive, with_headers)

    def problem(self, scope: Scope) -> str:
        """Why a request is refused; empty where it is not."""
        headers: dict[bytes, list[str]] = {}
        for name, value in scope["headers"]:
            headers.setdefault(name.lower(), []).append(value.decode("latin-1").lower())
        hosts, origins = headers.get(b"host", []), headers.get(b"origin", [])
        if len(hosts) != 1 or hosts[0] not in self.hosts:
            return HOST
        own = {f"http://{host}" for host in self.hosts}
        # A WebSocket is opened by pages only, which state their origin.
        if not set(origins) <= own or (scope["type"] == "websocket" and len(origins) != 1):
            return ORIGIN
        return "" if compare_digest(scope["query_string"], self.query) else TOKEN


async def refuse(problem: str, scope: Scope, send: Send) -> None:
    """Answer with one sentence, also where a WebSocket was asked for."""
    body, begin, headers = f"equipoise: {problem}\n".encode(), "websocket.http.response", []
    if scope["type"] == "http":  # else the server itself sends these two
        begin = "http.response"
        headers = [
            (b"content-type", b"text/plain; charset=utf-8"),
            (b"content-length", str(len(body)).encode()),
        ]
    await send({"type": f"{begin}.start", "status": 403, "headers": headers})
    await send({"type": f"{begin}.body", "body": body})


ADDRESS = "127.0.0.1"
USUAL = 8471
"""Port that is tried first, so that a browser finds again what it keeps for an address."""
SWITCH = 1e-3
"""s after which a thread that computes makes way for another; five times as often as usual, so
that a short answer does not wait for long ones.
"""
MOST_PAGES = 20
FULL = Note("{most_pages} pages are open already; close one of them", most_pages=MOST_PAGES)
NOTHING = "equipoise: there is nothing here; open the address that was printed\n"
HEAD = '<link rel="stylesheet" href="/equipoise.css?token={token}">'
BODY = """<main id="equipoise-live" data-live="/live?token={token}"></main>
<noscript>This page needs JavaScript.</noscript>
<script type="module" src="/equipoise.js?token={token}"></script>"""


def application(port: int, token: str, begin: Callable[[], PageBackend], lanes: Lanes) -> ASGIApp:
    """The server as an ASGI application.

    port : on which it is served.  token : that every request has to carry.
    begin : makes the session of a page that is opened.
    lanes : threads that compute.
    """
    from starlette.applications import Starlette
    from starlette.responses import PlainTextResponse, Response
    from starlette.routing import Route, WebSocketRoute

    html = document(HEAD.format(token=token), BODY.format(token=token))
    built = assets()
    pages: set[Page] = set()

    async def index(request: Request) -> Response:
        return Response(html, media_type="text/html")

    async def asset(request: Request) -> Response:
        name = request.url.path.removeprefix("/")
        return Response(built[name], media_type=TYPES[name])

    async def nothing(request: Request, error: Exception) -> Response:
        return PlainTextResponse(NOTHING, 404)

    async def live(socket: WebSocket) -> None:
        if len(pages) >= MOST_PAGES:
            await turn_away(socket, FULL)
            return
        page = Page(socket, begin(), lanes)
        pages.add(page)
        try:
            await page.run()
        finally:
            pages.discard(page)

    routes = [
        Route("/", index),
        *(Route(f"/{name}", asset) for name in TYPES),
        WebSocketRoute("/live", live),
    ]
    app = Starlette(routes=routes, exception_handlers={404: nothing, 405: nothing})
    return Guard(app, port, token)


@contextmanager
def served(
    begin: Callable[[], PageBackend], port: int | None = 0
) -> Iterator[tuple[uvicorn.Server, socket.socket, str]]:
    """A server that is ready to run on a socket that listens, and the address of its page.

    port : 0 for any that is free, None for the usual one if that is.

    Raises
    ------
    UsageError : the port is taken, or the page has not been built.
    """
    import uvicorn

    token = token_urlsafe(24)
    with (
        _listening(port) as listener,
        Lanes() as lanes,
    ):
        port = listener.getsockname()[1]
        config = uvicorn.Config(
            application(port, token, begin, lanes),
            http=Incoming,
            ws="websockets-sansio",
            ws_max_size=LARGEST_MESSAGE,
            ws_per_message_deflate=False,
            lifespan="off",
            log_config=None,
            log_level="critical",
            access_log=False,
            server_header=False,
            proxy_headers=False,
            timeout_graceful_shutdown=1,
        )
        yield uvicorn.Server(config), listener, f"http://{ADDRESS}:{port}/?token={token}"


def serve(
    begin: Callable[[], PageBackend], port: int | None, announce: Callable[[str], None]
) -> None:
    """Serve pages on this machine until interrupted; errors as `served`.

    announce : called with the address of the page, which is served from then on.
    """
    sys.setswitchinterval(SWITCH)
    with served(begin, port) as (server, listener, address):
        try:
            announce(address)
            server.run(sockets=[listener])
        except KeyboardInterrupt:
            answered()


def _listening(port: int | None) -> socket.socket:
    """A socket that listens on the loopback only."""
    if port is None:
        try:
            return _listening(USUAL)
        except UsageError:
            return _listening(0)
    listener = socket.socket(socket.AF_INET, socket.SOCK_STREAM)
    try:
        if os.name == "posix":  # elsewhere it would let another program take the port over
            listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        listener.bind((ADDRESS, port))
        listener.listen()
    except OSError as error:
        listener.close()
        raise UsageError(
            Note(
                "the port {port} cannot be used ({reason}); give another by --port, or none",
                port=port,
                reason=reason(error),
            )
        ) from error
    return listener
