"""Memory that a command takes at most, as the system counts it."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from surface.running import Result, command

pytestmark = pytest.mark.skipif(not sys.platform.startswith("linux"), reason="reads /proc")

PEAK = """
import atexit, re, sys
from pathlib import Path
from equipoise.__main__ import main

def tell():
    peak = re.search(r"VmHWM:\\s+(\\d+) kB", Path("/proc/self/status").read_text())[1]
    print(f"peak {int(peak) // 1000} MB", file=sys.stderr)

atexit.register(tell)
main()
"""


def peak_of(*arguments: str | Path) -> tuple[Result, int]:
    """What a command left behind, and the memory that its process held at most, MB."""
    words = [sys.executable, "-c", PEAK, *command(*arguments)[3:]]
    done = subprocess.run(words, capture_output=True, text=True, check=False, env={**os.environ})
    found = re.search(r"peak (\d+) MB\n$", done.stderr)
    assert found, done.stderr
    return Result(done.returncode, done.stdout, done.stderr), int(found[1])


STUDY = """
schema = 1
title = "Masses of type I"
model = "yamashita-1"

[[vary]]
path = "links.crank.mass"
range = ["199 g", "400 g"]

[sampling]
method = "sobol"
designs = 2000

[accuracy]
angles = 180

[[outputs]]
name = "first order"
value = "by_order.shaking_force.x.harmonics[2]"
make = "smallest"
"""


def test_a_search_gives_back_the_memory_of_its_designs() -> None:
    Path("study.toml").write_text(STUDY, encoding="utf-8")
    generations = ("--population", "100", "--generations", "20")
    result, peak = peak_of("search", "study.toml", *generations, "--json")
    assert result.status == 0, result.err
    assert json.loads(result.out)["computed"] > 1900
    assert peak < 600
