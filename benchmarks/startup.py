"""Whole processes: how long a user waits for a command, as a ratio to `import numpy`."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable

from timing import in_turn, report

COMMANDS = {
    "import numpy": ["-c", "import numpy"],
    "equipoise --help": ["-m", "equipoise", "--help"],
    "equipoise analyze yamashita-1": ["-m", "equipoise", "analyze", "yamashita-1"],
    "equipoise analyze yamashita-1 --json": ["-m", "equipoise", "analyze", "yamashita-1", "--json"],
}


def process(arguments: list[str]) -> Callable[[], object]:
    command = [sys.executable, *arguments]
    return lambda: subprocess.run(command, check=True, stdout=subprocess.DEVNULL)


if __name__ == "__main__":
    tasks = {name: process(arguments) for name, arguments in COMMANDS.items()}
    report(in_turn(tasks, rounds=15), "import numpy", 1e-3, "ms")
