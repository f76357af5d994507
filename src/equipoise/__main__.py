"""``python -m equipoise``, and what the command ``equipoise`` goes on with."""

from __future__ import annotations

import signal
import sys

from equipoise.interrupts import recorded
from equipoise_command import INTERRUPTED, end_when_interrupted, raise_when_interrupted


def main() -> None:
    """Run the command line, which an interrupt ends with one line from its first import on."""
    end_when_interrupted()
    from equipoise.cli import main as run

    try:
        raise_when_interrupted()
        with recorded():
            run()
    except KeyboardInterrupt:
        signal.signal(signal.SIGINT, signal.SIG_IGN)
        print("equipoise: interrupted", file=sys.stderr)
        sys.exit(INTERRUPTED)
    finally:
        # Python ends itself by the signal where code that was read from a text, such as methods of
        # dataclasses, was interrupted; the next such code makes it forget that.
        exec("")


if __name__ == "__main__":
    main()
