"""Who may talk to the local server: only the page whose address was printed, from this machine.

A page of another site can send requests to 127.0.0.1, and a name of another site can be made to
point there.  So every request has to carry the token, a Host that is this server, and, where the
browser tells it, an Origin that is this server too.
"""

from __future__ import annotations

from secrets import compare_digest
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from starlette.types import ASGIApp, Message, Receive, Scope, Send

NAMES = ("127.0.0.1", "localhost")
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
"""Of every response.  Nothing is loaded from elsewhere, and the token is told to nobody."""
_ENCODED = [(name.encode(), value.encode()) for name, value in HEADERS.items()]


class Guard:
    """Refuses what does not come from the server's own page, and adds the headers.

    port : of the server.  token : that its page carries.
    """

    def __init__(self, app: ASGIApp, port: int, token: str) -> None:
        self.app, self.query = app, b"token=" + token.encode()
        self.hosts = {f"{name}:{port}" for name in NAMES} | (set(NAMES) if port == 80 else set())

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
        # A WebSocket is opened by pages only, which tell where they are from.
        if not set(origins) <= own or (scope["type"] == "websocket" and len(origins) != 1):
            return ORIGIN
        return "" if compare_digest(scope["query_string"], self.query) else TOKEN


async def refuse(problem: str, scope: Scope, send: Send) -> None:
    """Answer with one sentence, also where a WebSocket was asked for."""
    body, begin, headers = f"equipoise: {problem}\n".encode(), "websocket.http.response", []
    if scope["type"] == "http":  # else the server itself tells these two
        begin = "http.response"
        headers = [
            (b"content-type", b"text/plain; charset=utf-8"),
            (b"content-length", str(len(body)).encode()),
        ]
    await send({"type": f"{begin}.start", "status": 403, "headers": headers})
    await send({"type": f"{begin}.body", "body": body})
