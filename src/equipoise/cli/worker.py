"""Calls of a program, computed in a process of their own: ``python -m equipoise.cli.worker``.

Each line that it reads is a `ToolCall` as JSON, and each that it writes the `ToolReply`.  It ends
with its standard input, so that nothing computes on for a server that is gone, and SIGINT
interrupts it as Ctrl-C does: files are all written or none is.
"""

from __future__ import annotations

import json
import os
import sys
import threading
from dataclasses import asdict
from pathlib import Path
from queue import Queue
from typing import Any

from equipoise.dataclass import dataclass


@dataclass(frozen=True)
class ToolCall:
    """A tool's name, its arguments, and the folder in which it runs."""

    name: str
    given: dict[str, Any]
    folder: str


@dataclass(frozen=True)
class ToolReply:
    """What a tool answers: its text, values and files; or, with `wrong`, a sentence alone."""

    text: str
    values: dict[str, Any]
    files: tuple[str, ...]
    wrong: bool = False


def reply_to(call: ToolCall) -> ToolReply:
    """Run a command; errors are reported in the product's sentences."""
    from cyclopts import CycloptsError

    from equipoise.cli.tools import tools
    from equipoise.errors import EquipoiseError, UsageError, unknown
    from equipoise.limits import out_of_memory

    known = tools()
    try:
        if call.name not in known:
            raise UsageError(unknown(call.name, known, "command"))
        answer = known[call.name].answer(call.given, Path(call.folder))
    except (EquipoiseError, CycloptsError) as error:
        return ToolReply(str(error), {}, (), wrong=True)
    except MemoryError as error:
        return ToolReply(str(out_of_memory(error)), {}, (), wrong=True)
    return ToolReply(answer.text, answer.values, tuple(map(str, answer.written)))


def _read(lines: Queue[bytes]) -> None:
    """Hand lines on, and end with the input, whatever is computed at that moment."""
    for line in sys.stdin.buffer:
        lines.put(line)
    os._exit(1)


def main() -> None:
    """Answer the calls on standard input."""
    from equipoise.cli.tools import tools
    from equipoise.interrupts import recorded
    from equipoise.limits import limit_process

    limit_process()
    answers = os.fdopen(os.dup(1), "w", encoding="utf-8")
    os.dup2(2, 1)  # what compiled libraries print is no part of an answer
    lines: Queue[bytes] = Queue()
    threading.Thread(target=_read, args=(lines,), daemon=True).start()
    try:
        tools()  # imports the commands while there is nothing to do
        while True:
            call = ToolCall(**json.loads(lines.get()))
            with recorded():
                reply = reply_to(call)
            answers.write(f"{json.dumps(asdict(reply))}\n")
            answers.flush()
    except KeyboardInterrupt:
        os._exit(130)  # nothing is left to do, and to unload libraries takes time


if __name__ == "__main__":
    main()
