"""The server as other programs and pages meet it: who is let in, and what is refused."""

from __future__ import annotations

import asyncio
import json
import logging
import socket
import struct
import threading
import time
import weakref
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from typing import Any
from unittest import mock

import pytest
import uvicorn
from uvicorn.server import ServerState
from websockets.exceptions import ConnectionClosed, InvalidStatus
from websockets.sync.client import ClientConnection, connect

from equipoise.balancing.balanced import Balanced
from equipoise.errors import UsageError
from equipoise.web import balanced as balanced_module
from equipoise.web import server as served_module
from equipoise.web import session as session_module
from equipoise.web.balanced import balanced
from equipoise.web.design import Design
from equipoise.web.desk import PageBackend
from equipoise.web.edits import Computed
from equipoise.web.gallery import opened_example
from equipoise.web.lanes import MOMENT, EndedError, Lanes, PageWork, print_no_endings
from equipoise.web.replies import CANCELLED
from equipoise.web.server import (
    FULL,
    HOST,
    LONGEST,
    MOST_PAGES,
    MOST_WAITING,
    ORIGIN,
    POLICY,
    TOKEN,
    Incoming,
    served,
)
from equipoise.web.session import Session
from support.refusals import refused
from unit.web.pages import Content, unpacked

FOREIGN = "http://other.example"


@dataclass
class Here:
    """A server that runs in a thread of its own."""

    address: str

    @property
    def host(self) -> str:
        return self.address.split("/")[2]

    @property
    def query(self) -> str:
        return self.address.rpartition("?")[2]

    def get(self, path: str, **headers: str) -> tuple[int, str, str]:
        """Status, headers and body of a request that is sent as it stands."""
        lines = {"Host": self.host, "Connection": "close", **headers}
        port = int(self.host.rpartition(":")[2])
        with socket.create_connection(("127.0.0.1", port), timeout=300) as connection:
            head = "".join(f"{key}: {value}\r\n" for key, value in lines.items() if value)
            connection.sendall(f"GET {path} HTTP/1.1\r\n{head}\r\n".encode("latin-1"))
            answer = b""
            while part := connection.recv(65536):
                answer += part
        first, _, body = answer.decode().partition("\r\n\r\n")
        return int(first.split()[1]), first.lower(), body

    @contextmanager
    def page(self, query: str = "", **options: Any) -> Iterator[ClientConnection]:
        address = f"ws://{self.host}/live?{query or self.query}"
        usual = {"origin": f"http://{self.host}", "max_size": None, "compression": None}
        with connect(address, **(usual | options)) as page:
            yield page


def hear(page: ClientConnection) -> Content:
    return unpacked(page.recv(timeout=300))[0]  # type: ignore[arg-type]


def ask(page: ClientConnection, message: object) -> Content:
    page.send(message if isinstance(message, str | bytes) else json.dumps(message))
    return hear(page)


@pytest.fixture(scope="module")
def here() -> Iterator[Here]:
    def begin() -> PageBackend:
        session = Session()
        session.open(opened_example("balance-crank"))
        return PageBackend(session)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(
            served_module, "assets", lambda: {"equipoise.js": b"//", "equipoise.css": b""}
        )
        with served(begin) as (server, listener, address):
            thread = threading.Thread(target=server.run, kwargs={"sockets": [listener]})
            thread.start()
            yield Here(address)
            server.should_exit = True
            thread.join()


def test_the_page_is_served_with_a_strict_policy(here: Here) -> None:
    status, head, body = here.get(f"/?{here.query}")
    assert status == 200
    assert f"content-security-policy: {POLICY}" in head
    assert "referrer-policy: no-referrer" in head
    assert "access-control" not in head
    assert "http" not in body.replace('http-equiv="', "")
    for asset in ("equipoise.js", "equipoise.css"):
        assert f"/{asset}?{here.query}" in body
        assert here.get(f"/{asset}?{here.query}")[0] == 200


REFUSED = {
    # path, headers, what is said
    "no token": ("/", {}, TOKEN),
    "wrong token": ("/?token=abc", {}, TOKEN),
    "no token for the script": ("/equipoise.js", {}, TOKEN),
    "odd bytes for a token": ("/?token=%ff%fe\xff", {}, TOKEN),
    "foreign origin": ("/?QUERY", {"Origin": FOREIGN}, ORIGIN),
    "no origin that could be named": ("/?QUERY", {"Origin": "null"}, ORIGIN),
    "another port": ("/?QUERY", {"Origin": "http://127.0.0.1:1"}, ORIGIN),
    "another scheme": ("/?QUERY", {"Origin": "https://HOST"}, ORIGIN),
    "another name for this address": ("/?QUERY", {"Host": "other.example"}, HOST),
    "another name with the port": ("/?QUERY", {"Host": "other.example:PORT"}, HOST),
    "a forwarded name": ("/?QUERY", {"Host": "a.example", "X-Forwarded-Host": "HOST"}, HOST),
}


@pytest.mark.parametrize(("path", "headers", "words"), REFUSED.values(), ids=REFUSED)
def test_strangers_are_refused(here: Here, path: str, headers: dict[str, str], words: str) -> None:
    def filled(text: str) -> str:
        port = here.host.rpartition(":")[2]
        for word, value in (("QUERY", here.query), ("HOST", here.host), ("PORT", port)):
            text = text.replace(word, value)
        return text

    given = {key: filled(value) for key, value in headers.items()}
    status, _, body = here.get(filled(path), **given)
    assert status in {400, 403}
    assert body == f"equipoise: {words}\n" or status == 400


@pytest.mark.parametrize(
    "path",
    ["/../../etc/passwd", "/%2e%2e/session.py", "/equipoise.js/../session.py", "//equipoise.js",
     "/static/equipoise.js", "/live", "/%00", "/docs"],
)  # fmt: skip
def test_there_is_nothing_else(here: Here, path: str) -> None:
    assert here.get(f"{path}?{here.query}")[0] == 404


@pytest.mark.parametrize(
    ("query", "options"), [("token=wrong", {}), ("", {"origin": FOREIGN}), ("", {"origin": None})]
)
def test_strange_pages_get_no_socket(here: Here, query: str, options: Any) -> None:
    with pytest.raises(InvalidStatus) as caught, here.page(query, **options):
        pass
    assert caught.value.response.status_code == 403
    assert caught.value.response.body.startswith(b"equipoise: ")


# The error that ends the work of a page that is closed can meet a callback of the interpreter,
# which reports it and goes on; the next step of the work meets it no more, and ends by itself.
@pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning")
def test_nonsense_is_answered_with_a_sentence(here: Here) -> None:
    with here.page() as page:
        assert hear(page)["type"] == "hello"
        for nonsense in ("", "[" * 100_000, "[]", '{"type":"close"}', '{"type":"undo","seq":NaN}',
                         "1" * 5000, b"\x00", '{"type":"edit","edits":[{}]}'):  # fmt: skip
            reply = ask(page, nonsense)
            assert reply["type"] == "refused"
            assert reply["message"].isprintable()
        big = {"type": "open", "seq": 3, "name": "big.toml", "text": "x" * 2_000_001}
        assert "longer than 2 MB" in ask(page, big)["message"]
        assert ask(page, {"type": "ready"})["machine"] is True
    with here.page() as page:
        hear(page)
        with pytest.raises(ConnectionClosed):  # in sending or in hearing
            ask(page, "x" * 7_000_000)


@pytest.mark.parametrize(
    ("error", "message"),
    [(MemoryError(), "not enough memory: needs more"), (KeyError("x"), "inside the program")],
)
def test_what_nobody_refuses_is_reported_and_the_page_goes_on(
    error: Exception, message: str, here: Here, monkeypatch: pytest.MonkeyPatch,
    capfd: pytest.CaptureFixture[str],
) -> None:  # fmt: skip
    """Of memory that is used up nothing is to be reported, so no traceback is printed."""
    change = {"type": "edit", "seq": 1, "edits": [{"set": "drive.speed", "text": "200 rpm"}]}
    with here.page() as page:
        hear(page)
        with monkeypatch.context() as patch:
            patch.setattr(Session, "_edit", mock.Mock(side_effect=error))
            reply = ask(page, change)
        assert reply["type"] == "refused" and message in reply["message"]
        assert ("Traceback" in capfd.readouterr().err) == isinstance(error, KeyError)
        assert ask(page, change)["type"] == "state"


def test_pages_do_not_disturb_each_other(here: Here) -> None:
    with here.page() as item, here.page() as other:
        assert hear(item)["type"] == hear(other)["type"] == "hello"
        change = {"set": "links.crank.mass", "text": "300 g"}
        edited = ask(item, {"type": "edit", "seq": 1, "label": "mass", "edits": [change]})
        assert edited["undo"] == "mass"
        ask(other, {"type": "ready", "seq": 2})
        untouched = hear(other)
        assert untouched["undo"] is None
        assert untouched["fields"][1]["text"] == "199 g"


def test_dragging_goes_on_while_something_takes_long(
    here: Here, monkeypatch: pytest.MonkeyPatch
) -> None:
    """And afterwards the memory that it needed is given back."""
    dragged, given_back = threading.Event(), threading.Event()

    def slowly(design: Design, hold: bool) -> Balanced:
        assert dragged.wait(300)
        return balanced(design, hold)

    monkeypatch.setattr(balanced_module, "balanced", slowly)
    monkeypatch.setattr(served_module, "give_back", given_back.set)
    with here.page() as page:
        hear(page)
        assert ask(page, {"type": "balance", "seq": 1})["type"] == "busy"
        change = {"set": "drive.speed", "text": "200 rpm"}
        assert ask(page, {"type": "edit", "seq": 2, "edits": [change]})["seq"] == 2
        dragged.set()
        late = hear(page)
        assert (late["type"], late["seq"]) == ("refused", 1)
        assert "was changed while" in late["message"]
        rest = iter(lambda: hear(page), {"type": "answered", "seq": 2})  # both are answered by now
        assert "answered" not in {item["type"] for item in rest}
        assert given_back.wait(300)


def test_a_question_too_many_has_all_its_answers_too(
    here: Here, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Else the page would wait for the rest of them for ever."""
    rested = threading.Event()

    def slowly(design: Design, hold: bool) -> Balanced:
        assert rested.wait(300)
        return balanced(design, hold)

    monkeypatch.setattr(balanced_module, "balanced", slowly)
    most = served_module.MOST_QUESTIONS + 2  # the first is being answered
    with here.page() as page:
        hear(page)
        assert ask(page, {"type": "balance", "seq": 1})["type"] == "busy"
        for seq in range(2, most + 1):
            page.send(json.dumps({"type": "balance", "seq": seq}))
        *waiting, refused = [hear(page) for _ in range(2, most + 1)]
        assert {item["type"] for item in waiting} == {"busy"}
        assert (refused["type"], refused["seq"]) == ("refused", most)
        rested.set()
        assert any(hear(page) == {"type": "answered", "seq": most} for _ in range(100))


class Dragged:
    """The socket of a page that moves something on as soon as it knows the last move's state."""

    def __init__(self, moves: int) -> None:
        self.coming: asyncio.Queue[Content] = asyncio.Queue()
        self.moves, self.sent = moves, list[tuple[str, int]]()
        self.go(1)

    def go(self, seq: int) -> None:
        last = seq == self.moves
        change = {"set": "drive.speed", "value": 20.0 + seq}
        edit = {"type": "edit", "seq": seq, "commit": last, "label": "", "edits": [change]}
        self.coming.put_nowait({"type": "websocket.receive", "text": json.dumps(edit)})

    async def accept(self) -> None: ...

    async def receive(self) -> Content:
        return await self.coming.get()

    async def send_bytes(self, data: bytes) -> None:
        reported = unpacked(data)[0]
        if reported["type"] in {"state", "response"}:
            self.sent.append((reported["type"], reported["seq"]))
        if reported["type"] == "state" and reported["seq"] < self.moves:
            self.go(reported["seq"] + 1)
        elif reported == {"type": "answered", "seq": self.moves}:
            self.coming.put_nowait({"type": "websocket.disconnect"})


@pytest.mark.parametrize("seldom", [1e9, -1.0])
def test_a_move_that_is_overtaken_is_reported_by_its_state_alone(
    seldom: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    """But now and then all of it is told, or a drag without a pause would show too little."""
    monkeypatch.setattr(served_module, "NEXT", 20.0)
    monkeypatch.setattr(served_module, "SELDOM", seldom)
    monkeypatch.setattr(served_module, "PAUSE", 0.0)
    session = Session()
    session.open(opened_example("yamashita-rig"))

    async def drag() -> list[tuple[str, int]]:
        socket = Dragged(4)
        with Lanes() as lanes:
            await served_module.Page(socket, session, lanes).run()  # type: ignore[arg-type]
        return socket.sent

    sent = asyncio.run(drag())
    assert [seq for kind, seq in sent if kind == "state"] == [1, 2, 3, 4]
    shaken = [seq for kind, seq in sent if kind == "response" and seq is not None]
    assert shaken == ([4] if seldom > 0 else [1, 2, 3, 4])


def test_a_page_does_not_wait_for_what_others_open(
    here: Here, monkeypatch: pytest.MonkeyPatch
) -> None:
    answered = threading.Event()

    def slowly(name: str) -> Design:
        assert answered.wait(300)
        return opened_example(name)

    monkeypatch.setattr(session_module, "opened_example", slowly)
    change = {"set": "drive.speed", "text": "200 rpm"}
    with ExitStack() as stack:
        idle, *others = (stack.enter_context(here.page()) for _ in range(7))
        for page in others:
            assert hear(page)["type"] == "hello"
            page.send(json.dumps({"type": "open", "seq": 1, "example": "yamashita-2"}))
        assert hear(idle)["type"] == "hello"
        assert ask(idle, {"type": "edit", "seq": 2, "edits": [change]})["seq"] == 2
        answered.set()
        for page in others:
            assert hear(page)["type"] == "state"


def test_a_page_whose_answers_take_long_is_heavy() -> None:
    work = PageWork()
    assert work.timed(lambda: 3) == 3
    assert work.spent < MOMENT
    end = time.thread_time() + 1.5 * MOMENT

    def computed() -> None:
        while time.thread_time() < end:
            pass

    work.timed(computed)
    assert work.spent > MOMENT


def test_work_ends_though_an_error_is_lost(capfd: pytest.CaptureFixture[str]) -> None:
    """Python prints and drops what is raised inside the callback of a weak reference."""
    begun, lost = threading.Event(), threading.Event()
    print_no_endings()
    work = PageWork()

    class Item:
        pass

    def in_callback(_: object) -> None:
        begun.set()
        while True:
            pass

    def without_end() -> None:
        item = Item()
        reference = weakref.ref(item, in_callback)
        del item
        lost.set()
        while reference() is None:
            pass

    with ThreadPoolExecutor(1) as threads:
        computed = threads.submit(work.do, without_end)
        assert begun.wait(300)
        work.end()
        with pytest.raises(EndedError):
            computed.result(20)
        assert threads.submit(lambda: 3).result(20) == 3  # and nothing is raised afterwards
    assert lost.is_set()
    assert capfd.readouterr().err == ""


def test_what_is_committed_goes_to_its_end() -> None:
    """What has been ended before cannot be committed."""
    work, late = PageWork(), PageWork()

    def ended_after() -> int:
        work.commit()
        work.end()
        return 3

    def ended_before() -> None:
        late.end()
        late.commit()

    with ThreadPoolExecutor(1) as threads:
        assert threads.submit(work.do, ended_after).result(300) == 3
        assert threads.submit(work.do, lambda: 4).result(300) == 4
        with pytest.raises(EndedError):
            threads.submit(late.do, ended_before).result(300)
        assert threads.submit(lambda: 5).result(300) == 5  # and nothing is raised afterwards


def test_what_takes_long_is_cancelled_and_asked_again(
    here: Here, monkeypatch: pytest.MonkeyPatch
) -> None:
    """With what waits for it; each question has an answer, and the page goes on."""
    begun, ended = threading.Event(), threading.Event()

    def without_end(design: Design, hold: bool) -> Balanced:
        begun.set()
        try:
            while True:
                pass
        finally:
            ended.set()

    with here.page() as page:
        hear(page)
        with monkeypatch.context() as patch:
            patch.setattr(balanced_module, "balanced", without_end)
            assert ask(page, {"type": "balance", "seq": 1})["type"] == "busy"
            assert begun.wait(300)
            page.send('{"type": "run", "seq": 2}')
            page.send('{"type": "cancel"}')
            answers = [*iter(lambda: hear(page), {"type": "answered", "seq": 2})]
        assert ended.is_set()
        refusals = {
            answer["seq"]: answer["message"] for answer in answers if answer["type"] == "refused"
        }
        assert refusals == dict.fromkeys((1, 2), "cancelled; nothing was changed")
        page.send('{"type": "cancel"}')  # when nothing is computed
        assert ask(page, {"type": "balance", "seq": 3})["type"] == "busy"
        again = hear(page)
        assert (again["type"], again["seq"]) == ("balanced", 3)


def test_what_waits_for_another_page_says_so_and_is_cancelled(
    here: Here, monkeypatch: pytest.MonkeyPatch
) -> None:
    """At once, while the other page's question is still computed, which then has its answer."""
    begun, go_on = threading.Event(), threading.Event()

    def slowly(design: Design, hold: bool) -> Balanced:
        begun.set()
        assert go_on.wait(300)
        return balanced(design, hold)

    monkeypatch.setattr(balanced_module, "balanced", slowly)
    with here.page() as first, here.page() as second:
        for page in (first, second):
            hear(page)
        assert ask(first, {"type": "balance", "seq": 1})["type"] == "busy"
        assert begun.wait(300)
        assert ask(second, {"type": "run", "seq": 1})["what"] == "running the machine"
        assert ask(second, {"type": "cancel"})["message"] == CANCELLED
        go_on.set()
        assert hear(first)["type"] == "balanced"


def test_a_balance_that_changes_the_machine_is_not_cancelled(
    here: Here, monkeypatch: pytest.MonkeyPatch
) -> None:
    cancelled, changing = threading.Event(), threading.Event()
    go_to = Session.go_to

    def slowly(self: Session, computed: Computed, label: str) -> None:
        changing.set()
        assert cancelled.wait(300)
        go_to(self, computed, label)

    monkeypatch.setattr(Session, "go_to", slowly)
    with here.page() as page:
        hear(page)
        assert ask(page, {"type": "balance", "seq": 1})["type"] == "busy"
        assert changing.wait(300)
        page.send('{"type": "cancel"}')
        assert ask(page, {"type": "stores", "seq": 2})["type"] == "stores"  # so that it was heard
        cancelled.set()
        assert hear(page)["type"] == "balanced"
        assert hear(page)["undo"] == "balance"


@pytest.mark.parametrize("how", ["closed", "gone"])
def test_work_ends_with_its_page_and_leaves_no_word(
    here: Here, how: str, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    begun, ended = threading.Event(), threading.Event()

    def without_end(design: Design, hold: bool) -> Balanced:
        begun.set()
        try:
            while True:
                pass
        finally:
            ended.set()

    monkeypatch.setattr(balanced_module, "balanced", without_end)
    # whose own client may write that it lost its socket
    with here.page(logger=logging.Logger("client", logging.CRITICAL)) as page:
        hear(page)
        assert ask(page, {"type": "balance", "seq": 1})["type"] == "busy"
        assert begun.wait(300)
        if how == "gone":  # as a program that is killed leaves
            reset = struct.pack("ii", 1, 0)
            page.socket.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, reset)
            for _ in range(30):
                page.send('{"type":"ready"}')
            page.socket.close()
    assert ended.wait(300)
    monkeypatch.undo()
    with here.page() as next_one:
        assert hear(next_one)["type"] == "hello"
        assert ask(next_one, {"type": "balance", "seq": 1})["type"] == "busy"
        assert hear(next_one)["type"] == "balanced"
    assert capfd.readouterr().err == ""


def test_there_is_an_end_to_pages_and_messages(here: Here) -> None:
    with ExitStack() as stack:
        for _ in range(MOST_PAGES):
            assert hear(stack.enter_context(here.page()))["type"] == "hello"
        with here.page() as last:
            assert hear(last)["message"] == FULL
    with here.page() as page, pytest.raises(ConnectionClosed):  # noqa: PT012
        for _ in range(20 * MOST_WAITING):
            page.send('{"type":"ready"}')
        while True:
            hear(page)


def test_requests_that_do_not_come_to_their_end_are_dropped(
    here: Here, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Whatever of them has come, and however much trickles in; the connection of a page stays."""
    monkeypatch.setattr(served_module, "LONGEST", 0.5)
    whole = f"GET /equipoise.css?{here.query} HTTP/1.1\r\nHost: {here.host}\r\n".encode()
    posted = b"POST" + whole.removeprefix(b"GET") + b"Content-Length: 99\r\n\r\nhalf"
    port = int(here.host.rpartition(":")[2])
    with ExitStack() as stack:
        page = stack.enter_context(here.page())
        opened = [
            stack.enter_context(socket.create_connection(("127.0.0.1", port), timeout=300))
            for _ in range(6)
        ]
        for connection, sent in zip(
            opened, (b"", b"GE", whole, posted, whole + b"\r\n" + whole, whole), strict=True
        ):
            connection.sendall(sent)
        with pytest.raises(OSError, match=r"reset|pipe|abort"):
            trickle(opened[-1])
        for connection in opened[:-1]:
            while connection.recv(65536):  # a wait too long is an error
                pass
        assert ask(page, {"kind": "ready"})
    assert here.get(f"/?{here.query}")[0] == 200


def trickle(connection: socket.socket) -> None:
    for _ in range(400):
        connection.sendall(b"x: y\r\n")
        time.sleep(0.05)


def test_time_to_send_is_counted_of_each_request() -> None:
    """From the opening or the first byte on, once however many parts, and not while answered."""
    loop = mock.Mock()
    loop.create_task = lambda answer, **_: answer.close() or mock.Mock()
    config = uvicorn.Config(lambda *_: None, http=Incoming, log_config=None)
    connection, transport = Incoming(config, ServerState(), {}, loop), mock.Mock()
    transport.get_protocol.return_value = connection
    transport.get_extra_info.return_value = None
    connection.connection_made(transport)
    loop.call_later.assert_called_once_with(LONGEST, transport.close)
    timer = connection.limit
    for part in (b"GET / HT", b"TP/1.1\r\n", b"Host: x\r\n"):
        connection.data_received(part)
        assert connection.limit is timer
    connection.data_received(b"\r\n")
    assert connection.limit is None
    loop.call_later.return_value.cancel.assert_called_once()


def test_a_port_that_is_taken_is_reported() -> None:
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
        with refused(UsageError, port=port), served(Session, port):
            pass
