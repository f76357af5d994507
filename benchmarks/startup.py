"""Whole processes: how long a user waits for a command, as a ratio to `import numpy`.

All run from compiled bytecode, as what pip has installed does, even where the environment forbids
Python to write any beside the sources; a first round, which is not counted, compiles it.
"""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable
from tempfile import TemporaryDirectory

from timing import in_turn, report

COMMANDS = {
    "import numpy": ["-c", "import numpy"],
    "equipoise --help": ["-m", "equipoise", "--help"],
    "equipoise analyze yamashita-1": ["-m", "equipoise", "analyze", "yamashita-1"],
    "equipoise analyze yamashita-1 --json": ["-m", "equipoise", "analyze", "yamashita-1", "--json"],
}


def process(arguments: list[str], compiled: str) -> Callable[[], object]:
    """Run a command whose bytecode is kept in a folder."""
    command = [sys.executable, *arguments]
    environment = {**os.environ, "PYTHONPYCACHEPREFIX": compiled, "PYTHONDONTWRITEBYTECODE": ""}
    return lambda: subprocess.run(command, check=True, stdout=subprocess.DEVNULL, env=environment)


if __name__ == "__main__":
    with TemporaryDirectory() as folder:
        tasks = {name: process(arguments, folder) for name, arguments in COMMANDS.items()}
        report(in_turn(tasks, rounds=15), "import numpy", 1e-3, "ms")
