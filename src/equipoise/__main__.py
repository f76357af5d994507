"""``python -m equipoise`` and the command ``equipoise``."""

from __future__ import annotations

import sys

from equipoise.interrupts import recorded


def main() -> None:
    """Run the command line, which an interrupt ends with one line from its first import on."""
    try:
        with recorded():
            from equipoise.cli import main as run

            run()
    except KeyboardInterrupt:
        print("equipoise: interrupted", file=sys.stderr)
        sys.exit(130)


if __name__ == "__main__":
    main()
