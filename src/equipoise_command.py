"""The command `equipoise` from its first moment on: Ctrl-C ends it, with status 130 and one line.

Outside of the package, and without imports of its own, since importing the package takes long:
an interrupt that falls into imports is dropped by some libraries, made another error by others,
and printed as a traceback otherwise.  Nothing is written yet, so the process just ends.
"""

import _signal  # type: ignore[import-not-found]  # of `signal`, without enumerations
import os

INTERRUPTED = 130


def end_when_interrupted() -> None:
    """Let Ctrl-C end the process at once, until `raise_when_interrupted`."""
    if _signal.getsignal(_signal.SIGINT) is _signal.default_int_handler:
        _signal.signal(_signal.SIGINT, _end)


def raise_when_interrupted() -> None:
    """Let Ctrl-C raise `KeyboardInterrupt` again, as Python does."""
    if _signal.getsignal(_signal.SIGINT) is _end:
        _signal.signal(_signal.SIGINT, _signal.default_int_handler)


def _end(*_: object) -> None:
    try:
        os.write(2, b"equipoise: interrupted\n")
    finally:  # also where the shell has closed it
        os._exit(INTERRUPTED)


def main() -> None:
    """Run the command line."""
    end_when_interrupted()
    from equipoise.__main__ import main as run

    run()
