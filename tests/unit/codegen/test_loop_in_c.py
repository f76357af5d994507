"""The loop in C of `benchmarks/c_loop.py` does what ours does, and writes nowhere else."""

from __future__ import annotations

import shutil
import subprocess
import sys
from pathlib import Path

import pytest

BENCHMARKS = Path(__file__).parents[3] / "benchmarks"
COMPARING = """
import sys
from pathlib import Path

import numpy as np

import c_loop
import equipoise as eq
from equipoise.codegen.backends import run_loop
from equipoise.codegen.batch import Batch, all_angles, designs_of, grid_of
from equipoise.codegen.figures import Figure

wanted = [Figure("shaking_force.x", "rms"), Figure("drive_torque", "peak")]
batch = Batch(eq.load("yamashita-1"), ("links.crank.mass",), wanted, angles=36, threads=1)
values = np.linspace(0.1, 0.3, 500)[:, None]
table = designs_of(batch.source, batch.base, batch.paths, values).table
grid = grid_of(batch.source, all_angles(36, batch.turns))
assert batch.source.width != len(batch.source.gathered.columns)
computed = c_loop.compiled(batch.source, [], Path(sys.argv[1]))(table, grid)
np.testing.assert_allclose(computed, run_loop(batch.source, table, grid), rtol=1e-12)
print("alike")
"""


# The loop in C is a benchmark's, no part of the product.
@pytest.mark.exhaustive
@pytest.mark.skipif(shutil.which("gcc") is None, reason="needs gcc")
def test_the_loop_in_c_gives_the_figures_of_many_designs(tmp_path: Path) -> None:
    """In a process of its own: a library compiled with -ffast-math takes its process the small
    numbers below 2.2e-308, which other tests need.
    """
    words = [sys.executable, "-c", f"import sys; sys.path.append({str(BENCHMARKS)!r})\n{COMPARING}"]
    done = subprocess.run([*words, str(tmp_path)], capture_output=True, text=True, check=False)
    assert (done.stdout, done.stderr) == ("alike\n", "")


CRASHING = """
import ctypes

import numpy as np

import c_loop

there = np.ones((2, 2))
print(c_loop.crashes(lambda table, grid: ctypes.string_at(0), there, there))
print(c_loop.crashes(lambda table, grid: table + grid, there, there))
"""


@pytest.mark.skipif(sys.platform == "win32", reason="needs fork")
def test_a_loop_that_crashes_is_left_out_of_the_benchmark() -> None:
    """It ended the whole of `make bench` on a processor that gcc did not know."""
    words = [sys.executable, "-c", f"import sys; sys.path.append({str(BENCHMARKS)!r})\n{CRASHING}"]
    done = subprocess.run(words, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert done.stdout == "SIGSEGV\n\n"
