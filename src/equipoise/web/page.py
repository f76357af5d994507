"""One page on its WebSocket: messages in, replies out, computing beside the event loop."""

from __future__ import annotations

import asyncio
import sys
import traceback
from collections import deque
from collections.abc import Iterator
from concurrent.futures import Executor
from contextlib import suppress
from functools import partial
from typing import TYPE_CHECKING

from starlette.websockets import WebSocketDisconnect

from equipoise.errors import UsageError
from equipoise.i18n import Note
from equipoise.web.desk import PageBackend
from equipoise.web.lanes import MOMENT, EndedError, Lanes, PageWork, give_back
from equipoise.web.messages import SLOW, Message, makes_way, read
from equipoise.web.replies import CANCELLED, Reply, busy, completed, packed, refused, unexpected

if TYPE_CHECKING:
    from starlette.websockets import WebSocket

MOST_WAITING, MOST_QUESTIONS = 100, 3
PAUSE = 0.2
"""s without a message, after which deferred replies are sent."""
NEXT = 0.1
"""s within which a drag that goes on sends its next move; else what follows a state is sent too."""
SELDOM = 0.2
"""s after which that is sent even during a drag that never pauses."""
FULL = Note("questions that take long are still being answered; wait for them")
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
            await self._send(refused(message.seq, UsageError(FULL)))
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
