"""The local server of the live page: its HTML, script and style, and a WebSocket a page."""

from __future__ import annotations

import os
import socket
from collections.abc import Callable, Iterator
from concurrent.futures import Executor
from concurrent.futures import ThreadPoolExecutor as Threads
from contextlib import contextmanager, suppress
from secrets import token_urlsafe
from typing import TYPE_CHECKING

from equipoise.errors import UsageError
from equipoise.schema.files import reason
from equipoise.web.assets import TYPES, assets
from equipoise.web.guard import Guard
from equipoise.web.messages import LARGEST_MESSAGE
from equipoise.web.page import Page, turn_away
from equipoise.web.session import Session

if TYPE_CHECKING:
    import uvicorn
    from starlette.requests import Request
    from starlette.types import ASGIApp
    from starlette.websockets import WebSocket

ADDRESS = "127.0.0.1"
MOST_PAGES = 20
FULL = f"{MOST_PAGES} pages are open already; close one of them"
NOTHING = "equipoise: there is nothing here; open the address that was printed\n"
HTML = """<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light dark">
<title>Equipoise</title>
<link rel="icon" href="data:,">
<link rel="stylesheet" href="/equipoise.css?token={token}">
</head>
<body>
<main id="equipoise-live" data-live="/live?token={token}"></main>
<noscript>This page needs JavaScript.</noscript>
<script type="module" src="/equipoise.js?token={token}"></script>
</body>
</html>
"""


def application(
    port: int, token: str, begin: Callable[[], Session], quick: Executor, slow: Executor
) -> ASGIApp:
    """The server as an ASGI application.

    port : on which it is served.  token : that every request has to carry.
    begin : makes the session of a page that is opened.
    quick, slow : threads that compute.
    """
    from starlette.applications import Starlette
    from starlette.responses import PlainTextResponse, Response
    from starlette.routing import Route, WebSocketRoute

    html, built = HTML.format(token=token), assets()
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
        page = Page(socket, begin(), quick, slow)
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
    begin: Callable[[], Session], port: int = 0
) -> Iterator[tuple[uvicorn.Server, socket.socket, str]]:
    """A server that is ready to run on a socket that listens, and the address of its page.

    port : 0 for any that is free.

    Raises
    ------
    UsageError : the port is taken, or the page has not been built.
    """
    import uvicorn

    token = token_urlsafe(24)
    with (
        _listening(port) as listener,
        Threads(4) as quick,
        Threads(2) as slow,
    ):
        port = listener.getsockname()[1]
        config = uvicorn.Config(
            application(port, token, begin, quick, slow),
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


def serve(begin: Callable[[], Session], port: int, tell: Callable[[str], None]) -> None:
    """Serve pages on this machine until interrupted; errors as `served`.

    tell : is given the address of the page, which is served from then on.
    """
    with served(begin, port) as (server, listener, address), suppress(KeyboardInterrupt):
        tell(address)
        server.run(sockets=[listener])


def _listening(port: int) -> socket.socket:
    """A socket that listens on the loopback only."""
    listener = socket.socket(socket.AF_INET, socket.SOCK_STREAM)
    try:
        if os.name == "posix":  # elsewhere it would let another program take the port over
            listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        listener.bind((ADDRESS, port))
        listener.listen()
    except OSError as error:
        listener.close()
        raise UsageError(
            f"the port {port} cannot be used ({reason(error)}); give another by --port, or none"
        ) from error
    return listener
