"""A report with all its pictures as a whole process, as a ratio to `import numpy, matplotlib`."""

from __future__ import annotations

import subprocess
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path
from statistics import median

from timing import in_turn, report

LIMIT = 3.0
"""s, of a whole process."""
NAMES = ("yamashita-1", "yamashita-rig", "transplanter", "four-row-transplanter", "nagamine-irie")
PEER = "import numpy, matplotlib"


def process(arguments: list[str]) -> Callable[[], object]:
    command = [sys.executable, *arguments]
    return lambda: subprocess.run(command, check=True, stderr=subprocess.DEVNULL)


def reported(folder: str, name: str, ending: str = "html") -> list[str]:
    return ["-m", "equipoise", "report", name, "-o", str(Path(folder) / f"{name}.{ending}")]


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as folder:
        tasks = {PEER: process(["-c", "import numpy, matplotlib.figure"])}
        tasks |= {f"report {name}": process(reported(folder, name)) for name in NAMES}
        tasks["report transplanter as PDF"] = process(reported(folder, "transplanter", "pdf"))
        times = in_turn(tasks, rounds=5)
        report(times, PEER, 1.0, "s")
        for page in sorted(Path(folder).glob("*.html")):
            pictures = page.read_text(encoding="utf-8").count("<figure>")
            print(f"{page.name}: {page.stat().st_size / 1e3:.0f} kB, {pictures} pictures")
        slow = [name for name, values in times.items() if median(values) > LIMIT]
        print(f"above {LIMIT:g} s: {', '.join(slow) or 'none'}")
