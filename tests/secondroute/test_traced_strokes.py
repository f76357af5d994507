"""Drives that push, in scripts and compiled loops, against analyses of each machine by itself."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import equipoise as eq
from equipoise.codegen.batch import Batch
from equipoise.codegen.emit import can_emit
from equipoise.codegen.figures import Figure
from equipoise.codegen.other_languages import javascript
from equipoise.mechanism import Machine
from equipoise.mechanism.assembly.linkage import assemble
from secondroute.test_javascript import ANGLES, node, run, size
from support.batches import signals_of
from support.designs import design, drawn, numbers_of
from support.machines_strokes import named

CASES = [
    "pushed stephenson:0", "pushed quick_return:0", "driven slider_crank:0",
    "driven crossed_guides:0", "pushed arm:0", "pushed arm:1", "pushed five-bar:0",
]  # fmt: skip
LOADER = "hydraulic-loader"


def machine_of(name: str) -> Machine:
    return eq.load(name) if name == LOADER else named(name).machine


def signals(machine: Machine) -> list[str]:
    return [item for item in signals_of(machine) if not item.startswith("transmission")]


@node
@pytest.mark.parametrize("name", [LOADER, *CASES])
def test_scripts(name: str, tmp_path: Path) -> None:
    machine = machine_of(name)
    linkage = assemble(machine)
    assert can_emit(linkage)
    names = signals(machine)
    assert any("drive" in item for item in names)
    script = javascript(linkage, names)
    analysis = eq.analyze(machine, ANGLES)
    got = run(script, script.numbers(linkage), analysis.crank_angle, tmp_path)
    known = arrays(analysis, names)
    assert np.all(np.abs(got - known) <= 1e-9 * size(known, names))


def arrays(analysis: eq.Analysis, names: list[str]) -> Any:
    by_name = {output.name: output.values for output in analysis.outputs}
    return np.array([by_name[name] for name in names])


@node
@pytest.mark.parametrize("name", [LOADER, "driven slider_crank:0", "pushed arm:0"])
def test_scripts_with_other_numbers(name: str, tmp_path: Path) -> None:
    """The links that are pushed stand elsewhere, so that lengths are as commanded."""
    base = machine_of(name)
    numbers = numbers_of(base, 1e-3)
    names = [
        signal
        for signal in signals(base)
        if "drive" in signal or signal.startswith(("shaking", "links"))
    ]
    script = javascript(assemble(base), names, {number.path: number.value for number in numbers})
    row = drawn(numbers, 1, 3)[0]
    analysis = eq.analyze(design(base, numbers, row), ANGLES)
    got = run(script, row, analysis.crank_angle, tmp_path)
    known = arrays(analysis, names)
    assert np.all(np.abs(got - known) <= 1e-9 * size(known, names))
    assert not np.allclose(known, arrays(eq.analyze(base, ANGLES), names))


# The steps of others, from which their loops are written: `test_scripts`.
@pytest.mark.exhaustive(but=[LOADER])
@pytest.mark.parametrize("name", [LOADER, "driven slider_crank:0", "pushed five-bar:0"])
def test_compiled_loops(name: str) -> None:
    base = machine_of(name)
    numbers = numbers_of(base, 1e-3)
    names = [
        item for item in eq.analyze(base, 8).summary if "drive" in item or item == "frame_force"
    ]
    batch = Batch(
        base, [number.path for number in numbers], [Figure(item, "rms") for item in names], 90
    )
    rows = drawn(numbers, 2, 5)
    figures, reason = batch(rows)
    assert not np.any(reason)
    for row, own in zip(figures, rows, strict=True):
        summary = eq.analyze(design(base, numbers, own), 90).summary
        np.testing.assert_allclose(row, [summary[item].rms for item in names], rtol=1e-8)
