"""The page's calculation in a browser: Python in WebAssembly, in two workers of one thread each.

`Foreground` answers what takes a moment, one reply a step, so that a newer edit of a drag can take
the place of an older one.  What takes longer is a `SlowTask`: `Background` computes it in the other
worker, from the design alone, and its replies come back as they are.  Neither knows what a worker
is: `page/src/site/worker.ts` carries bytes between them and the page.
"""

from __future__ import annotations

import copyreg
import pickle
import time
from collections import deque
from collections.abc import Iterator
from types import MappingProxyType
from typing import Any

from equipoise.dataclass import dataclass
from equipoise.errors import EquipoiseError, UsageError
from equipoise.i18n import Note, to_say
from equipoise.web.deferred import deferred_replies
from equipoise.web.design import PageDraft
from equipoise.web.desk import PageBackend
from equipoise.web.edits import Computed, solved
from equipoise.web.messages import SLOW, Message, makes_way, read
from equipoise.web.replies import (
    CANCELLED,
    Reply,
    StateChanges,
    busy,
    completed,
    packed,
    refused,
    unexpected,
)
from equipoise.web.session import Session

OF_MACHINE = ("balance", "run", "download")
"""Of the questions that take long, those about the machine that is open."""
SELDOM = 0.3
"""s after which all that follows from an edit is computed in a drag that never pauses, and figures,
numbers and spectra are written anew."""
LACKING = to_say("this needs {package}, which this site does not have and could not load")

Buffer = bytes | memoryview


def _read_only(values: dict[Any, Any]) -> MappingProxyType[Any, Any]:
    return MappingProxyType(values)


# Designs hold read-only mappings, which pickle does not know; their class has no importable name.
copyreg.pickle(MappingProxyType, lambda proxy: (_read_only, (dict(proxy),)))


@dataclass(frozen=True)
class SlowTask:
    """What takes long, with all that it needs of the session.

    design : the machine, if the task is about one.
    against : the one that figures are compared with, if any.
    message : the question; None for what follows from a design without being asked for.
    sweep : whether the response over speed is wanted.
    wanted : outputs that the page draws.  language : that its reader speaks.
    number : by which the page knows the design.
    """

    design: PageDraft | None
    against: PageDraft | None
    message: Message | None
    sweep: bool
    wanted: tuple[str, ...]
    language: str
    number: int


class Foreground:
    """One page: messages in, one reply a step out."""

    def __init__(self) -> None:
        self.desk = PageBackend()
        self.waiting: deque[Message | UsageError] = deque()
        self.tasks: deque[bytes] = deque()
        self.missing: str | None = None
        """A package that has to be loaded before the next step."""
        self._running: deque[tuple[SlowTask, Computed | None]] = deque()
        self._cancelled: deque[Message] = deque()
        self._message: Message | None = None
        self._replies: Iterator[Reply] | None = None
        self._refused_packages: set[str] = set()
        self._answered = self._reported = 0
        self._whole = self._written = 0.0
        self._seq: int | None = None
        self._changes = StateChanges()

    def take(self, text: str) -> None:
        """Take a message in; an edit that was only tried makes way for a newer one."""
        try:
            message: Message | UsageError = read(text)
        except UsageError as error:
            message = error
        if self.waiting and makes_way(self.waiting[-1], message):
            self.waiting.pop()
        self.waiting.append(message)

    def step(self) -> bytes | None:
        """Compute the next reply; None where there is none at present.

        Where a package is missing, `missing` names it, and the message is begun again.
        """
        self.missing = None
        try:
            reply = self._next()
        except ModuleNotFoundError as error:
            reply = self._without(error.name or str(error))
        except EquipoiseError as error:
            reply = self._refuse(error)
        except Exception as error:  # whatever it is, the last good state is still there
            reply = self._refuse(unexpected(error))
        return None if reply is None else packed(self._changes.of(reply))

    def lacks(self, package: str) -> None:
        """Note that a package cannot be loaded."""
        self._refused_packages.add(package)

    def rest(self) -> bool:
        """Begin what follows from the design that is shown; to be called when a hand rests.

        Returns whether a step is due at once: numbers of the last move have not been sent.
        """
        session = self.desk.session
        if self.waiting or self._replies is not None:
            return False
        if session.brief:
            session.brief = False
            self._replies = session.state_replies(self._seq)
            return True
        if not self.desk.has_more or any(task.message is None for task, _ in self._running):
            return False
        wanted = session.deferred_request()
        if wanted is not None:
            result, against, sweep = wanted
            self._begin(None, result, against, sweep)
        return False

    def wants_reply(self) -> bool:
        """Whether a reply of the task that runs is about the design that is shown."""
        task, result = self._running[0]
        return task.message is not None or self.desk.session.view is result

    def result_of_task(self, data: Buffer) -> None:
        """Take the end of a task: of a balance, the design that came of it."""
        task, result = self._running.popleft()
        balancing = pickle.loads(data) if memoryview(data) else None
        if balancing is not None:
            assert task.message is not None and result is not None
            message, self.desk.session.brief = task.message, False
            self._replies = self.desk.session.adopted(result, balancing, message)
            self._message = message
        elif task.message is not None:
            self._answer(task.message)

    def cancel(self) -> None:
        """Give up what is computed in the background, which has been ended from outside."""
        running, self._running = self._running, deque()
        self.tasks.clear()
        if any(task.message is None for task, _ in running):  # which is wanted as before
            self.desk.session.deferred_sent = None, None
        self._cancelled += [task.message for task, _ in running if task.message is not None]

    # -- one step ----------------------------------------------------------------------------------

    def _next(self) -> Reply | None:
        while True:
            if self._cancelled:
                message = self._cancelled.popleft()
                self._answer(message)
                return refused(message.seq, UsageError(CANCELLED), self.desk.session.language)
            if self._replies is not None:
                if self._overtaken():
                    self._end()
                    continue
                reply = next(self._replies, None)
                if reply is not None:
                    return reply
                self._whole = time.monotonic()
                self._end()
            elif self.waiting:
                self._start(self.waiting.popleft())
            elif self._running or self.desk.has_more or self._reported >= self._answered:
                return None
            else:
                self._reported = self._answered
                return completed(self._reported)

    def _start(self, message: Message | UsageError) -> None:
        if isinstance(message, UsageError):
            self._replies = iter([refused(None, message)])
        elif message.kind in SLOW and self._is_for_background(message):
            session = self.desk.session
            if (begun := busy(message, session.language)) is not None:
                self._replies = iter([begun])
            current = session.current() if message.kind in OF_MACHINE else None
            self._begin(message, current, None, sweep=False)
        else:
            self._message, self._replies = message, self.desk.receive(message)
            self._seq = message.seq
            now = time.monotonic()
            self.desk.session.brief = self._is_tried(message) and now - self._written < SELDOM
            if not self.desk.session.brief:
                self._written = now

    def _is_tried(self, message: Message) -> bool:
        """Whether a message is a move of a drag, or of a key that is held, of a machine."""
        return message.preview and self.desk.tool is None and not self.desk.studied

    def _is_for_background(self, message: Message) -> bool:
        """Whether a question is about a finished machine, or about nothing that is open."""
        desk = self.desk
        current = desk.session.current_state
        of_machine = desk.tool is None and current is not None and current.finished
        return of_machine or message.kind not in OF_MACHINE

    def _begin(
        self,
        message: Message | None,
        computed: Computed | None,
        against: Computed | None,
        sweep: bool,
    ) -> None:
        session = self.desk.session
        design, other = (None if item is None else item.design for item in (computed, against))
        number = 0 if computed is None else session.number_of(computed)
        task = SlowTask(design, other, message, sweep, session.wanted, session.language, number)
        self._running.append((task, computed))
        self.tasks.append(pickle.dumps(task))

    def _overtaken(self) -> bool:
        """Whether a drag goes on, so that what else follows from this move is left out."""
        message = self._message
        late = time.monotonic() - self._whole > SELDOM
        return message is not None and message.preview and bool(self.waiting) and not late

    def _end(self) -> None:
        message, self._message, self._replies = self._message, None, None
        if message is not None:
            self._answer(message)

    def _answer(self, message: Message) -> None:
        self._answered = max(self._answered, message.seq or 0)

    def _without(self, package: str) -> Reply | None:
        """Ask for a package, and begin the message again; refuse where it cannot be had."""
        package = package.partition(".")[0]
        message, self._message, self._replies = self._message, None, None
        if package in self._refused_packages:
            self._message = message
            return self._refuse(UsageError(Note(LACKING, package=package)))
        if message is not None:
            self.waiting.appendleft(message)
        self.missing = package
        return None

    def _refuse(self, error: EquipoiseError) -> Reply:
        seq = None if self._message is None else self._message.seq
        self._end()
        return refused(seq, error, self.desk.session.language)


class Background:
    """Computes tasks, each from nothing but itself and what was computed of the same design."""

    def __init__(self) -> None:
        self.missing: str | None = None
        """A package that has to be loaded before the task is begun again."""
        self._refused_packages: set[str] = set()
        self._task: SlowTask | None = None
        self._steps: Iterator[tuple[str, bytes]] | None = None
        self._last: tuple[int, Computed | None] = 0, None
        """The last design that the page shows, by its number, with what was computed of it."""

    def begin(self, data: Buffer) -> None:
        """Begin a task."""
        self._task = pickle.loads(data)
        self._steps = self._run(self._task)

    def lacks(self, package: str) -> None:
        """Note that a package cannot be loaded."""
        self._refused_packages.add(package)

    def step(self) -> tuple[str, bytes] | None:
        """("reply", bytes), and last ("result", bytes); None where a package is missing."""
        assert self._steps is not None
        self.missing = None
        try:
            return next(self._steps)
        except ModuleNotFoundError as error:
            name = (error.name or str(error)).partition(".")[0]
            if name not in self._refused_packages:
                self.missing = name
                return None
            return self._fail(UsageError(Note(LACKING, package=name)))
        except Exception as error:  # the next task is another one
            return self._fail(unexpected(error))

    def _fail(self, error: UsageError) -> tuple[str, bytes]:
        """Refuse what the task was asked for; it ends after that."""
        assert self._task is not None
        message = self._task.message
        seq = None if message is None else message.seq
        self._steps = iter([("result", b"")])
        return "reply", packed(refused(seq, error, self._task.language))

    def _solved(self, task: SlowTask) -> Computed | None:
        """The design of a task; as it was computed for the last task, where it is the same."""
        if task.design is None:
            return None
        if task.number == 0 or task.number != self._last[0]:
            self._last = task.number, solved(task.design)
        return self._last[1]

    def _run(self, task: SlowTask) -> Iterator[tuple[str, bytes]]:
        session = Session(language=task.language)
        result = b""
        try:
            outcome = self._solved(task)
            if outcome is not None:
                session.open(outcome.design, outcome)
                session.wanted, session.numbered = task.wanted, (outcome, task.number)
            if task.message is None:
                assert outcome is not None
                against = None if task.against is None else solved(task.against)
                with session.localized():
                    for content, data in deferred_replies(
                        outcome, against, task.sweep, lambda: False
                    ):
                        yield "reply", packed(Reply({"seq": None, **content}, data))
            elif task.message.kind == "balance":
                assert outcome is not None
                result = pickle.dumps(session.balancing(outcome, task.message))
            elif task.message.kind == "run":
                assert outcome is not None
                yield "reply", packed(session.run_reply(outcome, task.message))
            else:
                for reply in session.receive(task.message):
                    yield "reply", packed(reply)
        except EquipoiseError as error:
            seq = None if task.message is None else task.message.seq
            yield "reply", packed(refused(seq, error, task.language))
        yield "result", result
