"""The loop in C of `benchmarks/c_loop.py` does what ours does, and writes nowhere else."""

from __future__ import annotations

import shutil
import sys
from importlib import import_module
from pathlib import Path

import numpy as np
import pytest

import equipoise as eq
from equipoise.codegen.backends import run_loop
from equipoise.codegen.batch import Batch, all_angles, designs_of, grid_of
from equipoise.codegen.figures import Figure

BENCHMARKS = Path(__file__).parents[3] / "benchmarks"


@pytest.mark.skipif(shutil.which("gcc") is None, reason="needs gcc")
def test_the_loop_in_c_gives_the_figures_of_many_designs(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(sys, "path", [str(BENCHMARKS), *sys.path])
    c_loop = import_module("c_loop")
    path = "links.crank.mass"
    wanted = [Figure("shaking_force.x", "rms"), Figure("drive_torque", "peak")]
    batch = Batch(eq.load("yamashita-1"), (path,), wanted, angles=36, threads=1)
    values = np.linspace(0.1, 0.3, 500)[:, None]
    table = designs_of(batch.source, batch.base, batch.paths, values).table
    grid = grid_of(batch.source, all_angles(36, batch.turns))
    assert batch.source.width != len(batch.source.gathered.columns)
    found = c_loop.compiled(batch.source, [], tmp_path)(table, grid)
    np.testing.assert_allclose(found, run_loop(batch.source, table, grid), rtol=1e-12)
