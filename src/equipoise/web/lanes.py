"""Threads that compute for all pages: an idle page never waits for busy ones, and the work of a
page ends with it.

Every page has at most one job of a kind in a queue, so that pages take turns.
"""

from __future__ import annotations

import ctypes
import sys
import time
from collections.abc import Callable
from concurrent.futures import Executor, Future
from concurrent.futures import ThreadPoolExecutor as Threads
from contextlib import AbstractContextManager, ExitStack
from threading import Lock, Timer, get_ident
from typing import Any, TypeVar

AnswerT = TypeVar("AnswerT")

MOMENT = 0.1
"""s of computing, below which an answer is quick."""
HEAPS, LARGE, TRIMMED = (-8, 2), (-3, 4 << 20), (-1, 16 << 20)
"""Of glibc's `mallopt`: how many heaps threads share; bytes from where on memory is given back to
the system as soon as it is free, and how many may be free at a heap's end.  The arrays of one
answer stay below: to get their pages anew each time takes a tenth of the time of the answer."""
AGAIN = 0.25
"""s after which a computation that was to end is ended again: an error that Python raises inside
the callback of a weak reference, or in `__del__`, is printed and lost.  Much longer than a
computation takes to unwind, so that the second error does not meet the first one's clean-up."""


def share_heaps() -> None:
    """Let threads share heaps, where the C library has an option for it.

    Else each has its own, where what it has freed is kept for itself in pieces, and a server that
    lives long grows though it holds no more than before.
    """
    if mallopt := _of_heaps("mallopt"):
        for option in HEAPS, LARGE, TRIMMED:
            mallopt(*option)


def give_back() -> None:
    """Give free memory back to the system, where the C library has a call for it.

    What took long may have needed hundreds of MB, of which pieces that are in use keep the rest.
    """
    if trim := _of_heaps("malloc_trim"):
        trim(0)


def _of_heaps(name: str) -> Callable[..., int] | None:
    """A function of glibc; other C libraries have none of the name."""
    library = ctypes.CDLL(None) if sys.platform == "linux" else None
    return getattr(library, name, None)


class EndedError(BaseException):
    """The page for which something is computed has been closed, or its reader has cancelled it;
    nothing may take it for an error of the computation.
    """


class Lanes(AbstractContextManager["Lanes"]):
    """The threads of a server.

    quick : for pages whose answers take a moment.  heavy : for those whose answers take longer,
    and for machines that are opened, which nobody knows yet.  long : for what may take minutes.
    """

    def __init__(self) -> None:
        share_heaps()
        print_no_endings()
        self._stack = ExitStack()
        self.quick: Executor = self._stack.enter_context(Threads(2, "quick"))
        self.heavy: Executor = self._stack.enter_context(Threads(1, "heavy"))
        self.long: Executor = self._stack.enter_context(Threads(1, "long"))

    def __exit__(self, *_: object) -> None:
        self._stack.close()


class PageWork:
    """What is computed for one page.

    spent : s of computing that the last answer took.
    """

    def __init__(self) -> None:
        self.spent = 0.0
        self._lock, self._threads = Lock(), set[int]()
        self._step: Future[Any] | None = None
        self._ended = self._committed = False

    def submit(
        self, lane: Executor, compute: Callable[[], AnswerT], timed: bool = False
    ) -> Future[AnswerT]:
        """Compute as soon as a thread of a lane is free; `end` cancels what still waits for one.

        Raises
        ------
        EndedError : it has been ended before.
        """
        if self._ended:
            raise EndedError
        self._step = step = lane.submit(self.timed if timed else self.do, compute)
        return step

    def do(self, compute: Callable[[], AnswerT]) -> AnswerT:
        """Compute in this thread; `EndedError` as soon as `end` is called."""
        thread = get_ident()
        try:
            self._enter(thread)
            try:
                return compute()
            finally:
                self._leave(thread)
        except EndedError:  # perhaps before this thread was left
            self._leave(thread)
            raise

    def timed(self, compute: Callable[[], AnswerT]) -> AnswerT:
        """Compute and remember how long it took."""
        begun = time.thread_time()
        try:
            return self.do(compute)
        finally:
            self.spent = time.thread_time() - begun

    def commit(self) -> None:
        """Let what this thread computes go on to its end: it is about to change what is open, which
        must not stop half way.

        Raises
        ------
        EndedError : it has been ended before.
        """
        self._leave(get_ident())
        with self._lock:
            if self._ended:
                raise EndedError
            self._committed = True

    def end(self) -> None:
        """Stop what is computed, wherever it is, and begin nothing more; no effect on what has been
        committed.
        """
        with self._lock:
            if self._committed:
                return
            self._ended = True
            for thread in self._threads:
                _raise_in(thread, EndedError)
            if self._threads:
                again = Timer(AGAIN, self.end)
                again.daemon = True
                again.start()
        if self._step is not None:
            self._step.cancel()

    def _enter(self, thread: int) -> None:
        with self._lock:
            if self._ended:
                raise EndedError
            self._threads.add(thread)

    def _leave(self, thread: int) -> None:
        """Let nobody raise anything in this thread any more."""
        with self._lock:
            self._threads.discard(thread)
            _raise_in(thread, None)


def _raise_in(thread: int, error: type[BaseException] | None) -> None:
    """Have an error raised in another thread at its next step in Python; None takes that back."""
    raised = None if error is None else ctypes.py_object(error)
    ctypes.pythonapi.PyThreadState_SetAsyncExc(ctypes.c_ulong(thread), raised)


def print_no_endings() -> None:
    """Keep Python from printing an `EndedError` that it cannot raise: the computation is ended
    again, and there is nothing to mend.
    """
    if isinstance(sys.unraisablehook, _PrintNoEndings):
        return
    sys.unraisablehook = _PrintNoEndings(sys.unraisablehook)


class _PrintNoEndings:
    def __init__(self, otherwise: Callable[[sys.UnraisableHookArgs], object]) -> None:
        self._otherwise = otherwise

    def __call__(self, lost: sys.UnraisableHookArgs) -> None:
        if not isinstance(lost.exc_value, EndedError):
            self._otherwise(lost)
