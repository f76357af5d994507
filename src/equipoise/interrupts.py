"""Ctrl-C: an interrupt is never lost, and never leaves a file half written.

Compiled functions that cannot raise drop a `KeyboardInterrupt` (SciPy's, while it loads the
direction numbers of Sobol's sequence, and then goes on with zeros), and so does a bare ``except``
around an import; compiled modules that are interrupted while they import others say that these are
missing, or print what no reader has asked for.  Hence the command line raises no interrupt before
an import has ended, records each that it raises, and asks by `check` before results are printed,
errors are printed or files take their places.  `held_back` delays an interrupt to the end of what
must not stop in the middle.
"""

from __future__ import annotations

import _thread
import signal
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from time import monotonic
from types import FrameType

_received = False
"""Whether an interrupt was raised that nobody has answered yet."""


_came = False
"""Whether an interrupt has come since recording began."""
_begun: FrameType | None = None
"""The frame in which recording begins; imports further out are of other programs."""
_again: threading.Timer | None = None
"""What interrupts again, should nothing have been raised when an import had ended."""
SOON = 0.1
"""s until then."""
PATIENCE = 1.0
"""s in which an import may end; one that takes longer is interrupted."""
_first: float | None = None
"""When the interrupt came that waits for an import, s."""


def _raise(number: int, frame: FrameType | None) -> None:
    global _received, _came, _again, _first  # noqa: PLW0603 - there is one process with signals
    _received = _came = True
    _first = _first or monotonic()
    importing = _importing(frame)
    if importing is None or monotonic() - _first > PATIENCE:
        raise KeyboardInterrupt
    importing.f_trace, importing.f_trace_opcodes = _raise_there, True
    sys.settrace(lambda *_: None)  # else no frame is traced
    _again = threading.Timer(SOON, _thread.interrupt_main)
    _again.daemon = True
    _again.start()


def _importing(frame: FrameType | None) -> FrameType | None:
    """The code that imports something at this moment, if any does: the outermost of it."""
    importing = None
    while frame is not None and frame is not _begun:
        if frame.f_code.co_filename == "<frozen importlib._bootstrap>":
            importing = frame.f_back
        frame = frame.f_back
    return importing


def _raise_there(frame: FrameType, event: str, value: object) -> None:
    """Raise the interrupt as soon as the code that imported something goes on."""
    frame.f_trace = None
    sys.settrace(None)
    if _again is not None:
        _again.cancel()
    raise KeyboardInterrupt


def _report_others(dropped: sys.UnraisableHookArgs) -> None:
    """Say nothing of an interrupt that was dropped, which is recorded, nor of what follows from it
    where objects are given up that were half made.
    """
    if not _came and not issubclass(dropped.exc_type, KeyboardInterrupt):
        sys.__unraisablehook__(dropped)


@contextmanager
def recorded() -> Iterator[None]:
    """Inside, `check` knows of interrupts that libraries have dropped.

    Python raises interrupts in the main thread only; in others, and where a program has a handler
    of its own, nothing changes.
    """
    global _received, _came, _begun, _first  # noqa: PLW0603
    here = threading.current_thread() is threading.main_thread()
    if not here or signal.getsignal(signal.SIGINT) is not signal.default_int_handler:
        with _taken_back():
            yield
        return
    _received, _came, _first, report = False, False, None, sys.unraisablehook
    _begun = sys._getframe(2)  # of whoever says `with`
    signal.signal(signal.SIGINT, _raise)
    sys.unraisablehook = _report_others
    try:
        with _taken_back():
            yield
    finally:
        if _again is not None:
            _again.cancel()
        if _came:
            sys.settrace(None)
        sys.unraisablehook = report
        if signal.getsignal(signal.SIGINT) is _raise:
            signal.signal(signal.SIGINT, signal.default_int_handler)
        _received, _begun, _first = False, None, None


@contextmanager
def _taken_back() -> Iterator[None]:
    """Raise the interrupt again where a library has made another error of it."""
    try:
        yield
    except KeyboardInterrupt:
        raise
    except BaseException:
        check()
        raise


def check() -> None:
    """Raise the interrupt again that a library has dropped, if there was one."""
    if _received and threading.current_thread() is threading.main_thread():
        raise KeyboardInterrupt


def answered() -> None:
    """Forget an interrupt, for whoever waits for one and ends as asked."""
    global _received  # noqa: PLW0603
    _received = False


@contextmanager
def held_back() -> Iterator[None]:
    """Inside, no interrupt is raised; one that comes meanwhile is raised at the end."""
    here = threading.current_thread() is threading.main_thread()
    before = signal.getsignal(signal.SIGINT) if here else None
    if before is None or before == signal.SIG_IGN:
        yield
        return
    came: list[int] = []
    signal.signal(signal.SIGINT, lambda number, _: came.append(number))
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)
        if came:
            signal.raise_signal(signal.SIGINT)
