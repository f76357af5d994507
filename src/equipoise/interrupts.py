"""Ctrl-C: an interrupt is never lost, and never leaves a file half written.

Compiled functions that cannot raise drop a `KeyboardInterrupt` (SciPy's, while it loads the
direction numbers of Sobol's sequence, and then goes on with zeros), and so does a bare ``except``
around an import.  Hence the command line records each interrupt that it raises, and asks by `check`
before results are printed or files take their places.  `held_back` delays an interrupt to the end
of what must not stop in the middle.
"""

from __future__ import annotations

import signal
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType

_received = False
"""Whether an interrupt was raised that nobody has answered yet."""


def _raise(number: int, frame: FrameType | None) -> None:
    global _received  # noqa: PLW0603 - there is one process, and it gets the signal
    _received = True
    raise KeyboardInterrupt


def _report_others(dropped: sys.UnraisableHookArgs) -> None:
    """Say nothing of an interrupt that was dropped, which is recorded."""
    if not issubclass(dropped.exc_type, KeyboardInterrupt):
        sys.__unraisablehook__(dropped)


@contextmanager
def recorded() -> Iterator[None]:
    """Inside, `check` knows of interrupts that libraries have dropped.

    Python raises interrupts in the main thread only; in others, and where a program has a handler
    of its own, nothing changes.
    """
    global _received  # noqa: PLW0603
    here = threading.current_thread() is threading.main_thread()
    if not here or signal.getsignal(signal.SIGINT) is not signal.default_int_handler:
        yield
        return
    _received, report = False, sys.unraisablehook
    signal.signal(signal.SIGINT, _raise)
    sys.unraisablehook = _report_others
    try:
        yield
    finally:
        sys.unraisablehook = report
        if signal.getsignal(signal.SIGINT) is _raise:
            signal.signal(signal.SIGINT, signal.default_int_handler)
        _received = False


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
