"""`make bench` goes on where a package that is compared with is not installed, and says so."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PEERS = "sympy", "pinocchio", "cvxpy", "ross", "exudyn", "playwright"
LOADING = """
import runpy, sys

folder, peers, names = (word.split(",") for word in sys.argv[1:])
sys.path[:0] = folder
sys.modules.update(dict.fromkeys(peers))  # as where none of them is installed
for name in names:
    print(f"- {name}", flush=True)
    try:
        runpy.run_path(f"{folder[0]}/{name}.py", run_name="loaded")
    except SystemExit as end:
        print(f"ends with {end.code}")
"""
SENTENCES = {
    "analysis": ["sympy is not installed and is left out", "pinocchio is not installed"],
    "balancing": ["cvxpy is not installed and is left out"],
    "studies": ["sympy is not installed", "pinocchio is not installed"],
    "tools": ["ross is not installed"],
    "live_page": ["playwright is not installed, and nothing is measured", "ends with 0"],
    "exudyn_slider_crank": ["exudyn is not installed, and nothing is measured", "ends with 0"],
    "exudyn_run": ["exudyn is not installed, and nothing is measured", "ends with 0"],
}


# Benchmarks are for developers; their imports are checked by ruff.
@pytest.mark.exhaustive
def test_benchmarks_without_the_packages_that_they_compare_with() -> None:
    recipe = (ROOT / "Makefile").read_text(encoding="utf-8").partition("\nbench:")[2]
    names = re.findall(r"benchmarks/(\w+)\.py", recipe)
    assert {*SENTENCES} < {*names}
    words = [str(ROOT / "benchmarks"), ",".join(PEERS), ",".join(names)]
    done = subprocess.run(
        [sys.executable, "-c", LOADING, *words], capture_output=True, text=True, check=False
    )
    assert (done.returncode, done.stderr) == (0, "")
    _, *parts = re.split(r"^- ", done.stdout, flags=re.M)
    for name, part in zip(names, parts, strict=True):
        first, *lines = part.splitlines()
        expected = SENTENCES.get(name, [])
        assert first == name and len(lines) == len(expected), part
        assert all(line.startswith(start) for line, start in zip(lines, expected, strict=True))
