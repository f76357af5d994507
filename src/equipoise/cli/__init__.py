"""The command line.  Results go to standard output, everything else to standard error.

Exit status: 0 done, 2 something the user can mend (one sentence says what), 130 interrupted.
"""

from __future__ import annotations

import gc
import io
import os
import sys
from collections.abc import Sequence

from cyclopts import CycloptsError

from equipoise.cli.app import app, import_commands
from equipoise.errors import EquipoiseError

__all__ = ["main", "run"]


def run(arguments: Sequence[str] | None = None) -> int:
    """Run a command; returns the exit status."""
    given = sys.argv[1:] if arguments is None else arguments
    if not given or given[0].startswith("-"):
        import_commands()
    try:
        app(
            arguments,
            exit_on_error=False,
            print_error=False,
            result_action="return_value",
        )
        if sys.stdout is not None:  # None where the shell has closed it
            sys.stdout.flush()
    except (EquipoiseError, CycloptsError) as error:
        print(f"equipoise: {_one_line(str(error))}", file=sys.stderr)
        return 2
    except KeyboardInterrupt as interrupt:  # whoever has more to say raises it again with words
        words = _one_line("; ".join(["interrupted", *map(str, interrupt.args)]))
        print(f"equipoise: {words}", file=sys.stderr)
        return 130
    except BrokenPipeError:  # the reader, such as `head`, has seen enough
        _drop_output()
    except OSError as error:  # everything else that can fail says so itself
        _drop_output()
        print(f"equipoise: the output cannot be written ({error.strerror})", file=sys.stderr)
        return 2
    return 0


def _drop_output() -> None:
    """Leave nothing that the interpreter would try to write at its end."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def _one_line(text: str) -> str:
    from equipoise.schema.files import printable

    text = " ".join(text.splitlines())
    text = text if len(text) <= 2000 else f"{text[:1000]} ... {text[-900:]}"
    return "".join(map(printable, text))


def main() -> None:
    """Entry point of the command `equipoise`."""
    gc.disable()  # collecting garbage between imports takes a twentieth of a short command's time
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):  # a title may have letters the terminal lacks
            stream.reconfigure(errors="backslashreplace")
    sys.exit(run())
