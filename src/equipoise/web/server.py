"""The local server of the live page: requests as they come in, and each page on its WebSocket.

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
import traceback
from collections import deque
from collections.abc import Callable, Iterator
from concurrent.futures import Executor
from contextlib import contextmanager, suppress
from functools import partial
from secrets import compare_digest, token_urlsafe
from typing import TYPE_CHECKING, Any

import h11
from starlette.websockets import WebSocketDisconnect
from uvicorn.protocols.http.h11_impl import H11Protocol

from equipoise.errors import UsageError
from equipoise.folders import reason
from equipoise.i18n import Note
from equipoise.interrupts import answered
from equipoise.web.desk import PageBackend
from equipoise.web.documents import TYPES, assets, document
from equipoise.web.lanes import MOMENT, EndedError, Lanes, PageWork, give_back
from equipoise.web.messages import LARGEST_MESSAGE, SLOW, Message, makes_way, read
from equipoise.web.replies import CANCELLED, Reply, busy, completed, packed, refused, unexpected

if TYPE_CHECKING:
    import uvicorn
    from starlette.requests import Request
    from starlette.types import ASGIApp, Receive, Scope, Send
    from starlette.types import Message as AsgiMessage
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

        async def with_headers(message: AsgiMessage) -> None:
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


# -- a page on its WebSocket -----------------------------------------------------------------------


MOST_WAITING, MOST_QUESTIONS = 100, 3


PAUSE = 0.2
"""s without a message, after which deferred replies are sent."""


NEXT = 0.1
"""s within which a drag that goes on sends its next move; else what follows a state is sent too."""


SELDOM = 0.2
"""s after which that is sent even during a drag that never pauses."""


MANY_QUESTIONS = Note("questions that take long are still being answered; wait for them")


FLOODED = "too many messages at once; load the page again"


POLICY_VIOLATION, TRY_LATER = 1008, 1013


class Page:
    """A page that is open.

    lanes : threads that compute; what takes long has its own, so that dragging goes on.
    question : the work on the last question that takes long, and whether it goes on (`answering`).
    cancelled : questions that take long and were cancelled, and are to be refused.
    whole : when all that follows from a message was sent last, s.
    """

    def __init__(self, socket: WebSocket, desk: PageBackend, lanes: Lanes) -> None:
        self.socket, self.desk, self.lanes, self.work = socket, desk, lanes, PageWork()
        self.answering, self.question = False, PageWork()
        self.cancelled: deque[Message] = deque()
        self.waiting: deque[Message | UsageError] = deque()
        self.come = asyncio.Event()
        self.closed = False
        self.last: Message | None = None
        self.answered = self.completed_seq = 0
        self.whole = 0.0
        self.questions: asyncio.Queue[Message] = asyncio.Queue(MOST_QUESTIONS)
        self.deferred_task: asyncio.Task[None] | None = None

    async def run(self) -> None:
        """Answer until the page is closed."""
        await self.socket.accept()
        # What computes has a task of its own each: a page that is closed waits for none of them.
        tasks = [asyncio.create_task(item) for item in (self._read(), self._work(), self._talk())]
        try:
            await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
        finally:
            self.closed = True
            self.work.end()
            self.question.end()
            tasks += [self.deferred_task] if self.deferred_task is not None else []
            for task in tasks:
                task.cancel()
            await asyncio.gather(*tasks, return_exceptions=True)

    async def _talk(self) -> None:
        await self._send(self.desk.hello())
        while (message := await self._next()) is not None:
            await self._take(message)

    # -- what comes in -----------------------------------------------------------------------------

    async def _read(self) -> None:
        """Take messages in; an edit that is only tried makes way for a newer one."""
        while not self.closed:
            event = await self.socket.receive()
            if event["type"] != "websocket.receive":
                break
            message = _message(event.get("text"))
            if isinstance(message, Message) and message.kind == "cancel":
                await self._cancel()  # before what waits for an answer
                continue
            if self.waiting and makes_way(self.waiting[-1], message):
                self.waiting.pop()
            self.waiting.append(message)
            self.come.set()
            if len(self.waiting) > MOST_WAITING:
                await self.socket.close(POLICY_VIOLATION, FLOODED)
                break
        self.closed = True
        self.come.set()

    async def _next(self) -> Message | UsageError | None:
        while not self.waiting and not self.closed:
            self.come.clear()
            await self.come.wait()
        return None if self.closed else self.waiting.popleft()

    # -- what goes out -----------------------------------------------------------------------------

    async def _take(self, message: Message | UsageError) -> None:
        if isinstance(message, UsageError):
            await self._send(refused(None, message))
        elif message.kind not in SLOW:
            self.last = message
            known = message.kind != "open" and self.work.spent < MOMENT
            lane = self.lanes.quick if known else self.lanes.heavy
            await self._answer(self.desk.receive(message), message, lane, timed=True)
            self._go_on(message)
        elif self.questions.full():
            await self._send(refused(message.seq, UsageError(MANY_QUESTIONS)))
            self._go_on(message)
        else:
            self.questions.put_nowait(message)
            if (begun := busy(message, self.desk.language)) is not None:
                await self._send(begun)  # also while others' questions are answered

    async def _work(self) -> None:
        """Answer what takes long, one after the other, beside what does not."""
        while True:
            message = await self.questions.get()
            self.answering, self.question = True, PageWork()
            self.desk.session.before_change = self.question.commit
            try:
                replies, lane = self.desk.receive(message), self.lanes.long
                await self._answer(replies, message, lane, self.question)
            except (EndedError, asyncio.CancelledError):
                if self.closed:
                    raise
                self.cancelled.appendleft(message)
            else:
                self._go_on(message)
            self.answering = False
            await self._refuse_cancelled()
            await asyncio.get_running_loop().run_in_executor(self.lanes.long, give_back)

    async def _cancel(self) -> None:
        """Give up the question that is answered, if it has not yet changed anything, and those that
        wait for it.
        """
        self.cancelled += [self.questions.get_nowait() for _ in range(self.questions.qsize())]
        for message in [*self.waiting]:
            if isinstance(message, Message) and message.kind in SLOW:
                self.waiting.remove(message)
                self.cancelled.append(message)
        self.question.end()
        if not self.answering:  # else when that has ended: a page takes the last answer for all
            await self._refuse_cancelled()

    async def _refuse_cancelled(self) -> None:
        while self.cancelled:
            message, language = self.cancelled.popleft(), self.desk.session.language
            await self._send(refused(message.seq, UsageError(CANCELLED), language))
            self._go_on(message)

    def _go_on(self, message: Message) -> None:
        self.answered = max(self.answered, message.seq or 0)
        if _done(self.deferred_task):
            self.deferred_task = asyncio.create_task(self._send_deferred())

    async def _send_deferred(self) -> None:
        """Send deferred replies, then the message that all answers have been sent."""
        while not self.closed:
            last = self.last
            if self.desk.has_more:
                await asyncio.sleep(PAUSE)
                if not self.waiting and self.last is last:
                    await self._answer(self.desk.deferred_replies(), None, self.lanes.long)
            elif self.completed_seq < self.answered:
                self.completed_seq = self.answered
                await self._send(completed(self.completed_seq))
            else:
                break

    async def _answer(
        self,
        replies: Iterator[Reply],
        to: Message | None,
        lane: Executor,
        work: PageWork | None = None,
        timed: bool = False,
    ) -> None:
        """Send replies as they are computed; a mistake of the program must not end the page."""
        loop, work = asyncio.get_running_loop(), work or self.work
        try:
            while True:
                step = work.submit(lane, partial(next, replies, None), timed)
                reply = await asyncio.wrap_future(step)
                if reply is None:
                    self.whole = loop.time()
                    break
                await self._send(reply)
                if to is not None and to.preview and await self._overtaken(loop.time()):
                    break
        except Exception as error:  # whatever it is, the last good state is still there
            if not isinstance(error, MemoryError):
                traceback.print_exception(error, file=sys.stderr)
            seq = None if to is None else to.seq
            await self._send(refused(seq, unexpected(error)))

    async def _overtaken(self, now: float) -> bool:
        """Whether a drag goes on, so that further replies on this move are omitted."""
        if now - self.whole > SELDOM:
            return False
        if not self.waiting:
            self.come.clear()
            with suppress(TimeoutError):
                await asyncio.wait_for(self.come.wait(), NEXT)
        return bool(self.waiting)

    async def _send(self, reply: Reply) -> None:
        try:
            if not self.closed:
                await self.socket.send_bytes(packed(reply))
        except (WebSocketDisconnect, RuntimeError):  # the page has gone without a word
            self.closed = True
            self.come.set()


async def turn_away(socket: WebSocket, why: Note) -> None:
    """Refuse to serve a page, with the reason."""
    await socket.accept()
    await socket.send_bytes(packed(refused(None, UsageError(why))))
    await socket.close(TRY_LATER, why)


def _message(text: str | None) -> Message | UsageError:
    if text is None:
        return UsageError(Note("the message is no text; give JSON"))
    try:
        return read(text)
    except UsageError as error:
        return error


def _done(task: asyncio.Task[None] | None) -> bool:
    return task is None or task.done()
