"""Scripts run by Node, against the same signals of an analysis, and of the same terms by NumPy."""

from __future__ import annotations

import json
import shutil
import subprocess
from collections.abc import Sequence
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import equipoise as eq
from equipoise.codegen.emit import can_emit, pose_signals
from equipoise.codegen.other_languages import MOST_LINES, Script, javascript
from equipoise.codegen.trace import FAR
from equipoise.mechanism.assembly.linkage import assemble
from support.batches import signals_of
from support.chosen import DISTINCT, few, model_of
from support.designs import design, drawn, numbers_of
from support.machines import make

NODE = shutil.which("node")
ANGLES = 24
node = pytest.mark.skipif(NODE is None, reason="needs Node to run JavaScript: install nodejs")

RUN = """
const {{ design, grid, angles, count }} = {given};
const out = new Float64Array(count * angles);
states(Float64Array.from(design), Float64Array.from(grid), angles, out);
process.stdout.write(Buffer.from(out.buffer));
"""


@cache
def written() -> tuple[str, ...]:
    """Examples that a script can be written of."""
    names = eq.examples("linkage")
    return tuple(name for name in names if can_emit(assemble(model_of(name))))


def has_forces(name: str) -> bool:
    """Whether it has all masses, and lengths of which each can be changed alone."""
    machine = model_of(name)
    has_masses = all(link.has_mass for link in machine.links.values())
    return has_masses and assemble(machine).shared is None


def run(script: Script, numbers: Any, theta: Any, folder: Path) -> Any:
    """Signals (S, N) at crank angles (N,), by Node."""
    given: dict[str, Any] = {"angles": len(theta), "count": len(script.names)}
    given["design"] = numbers.tolist()
    given["grid"] = script.grid(theta).ravel().tolist()
    path = folder / "states.js"
    path.write_text(script.text + RUN.format(given=json.dumps(given)), encoding="utf-8")
    assert NODE is not None
    process = subprocess.run([NODE, str(path)], check=True, capture_output=True, timeout=300)
    return np.frombuffer(process.stdout).reshape(len(script.names), len(theta))


def size(values: Any, names: Sequence[str]) -> Any:
    """Largest value of each signal, and of the signals of rounding alone a thousandth of others, or
    a hundredth of those of their kind.
    """
    largest = np.max(np.abs(values), axis=1, keepdims=True)
    kinds = np.array([name.rpartition(".")[2] for name in names])
    alike = np.array([np.max(largest[kinds == kind]) for kind in kinds])[:, None]
    return np.maximum(largest, np.maximum(1e-3 * np.median(largest), 1e-2 * alike))


@node
@pytest.mark.parametrize("name", few(written(), DISTINCT))
def test_example(name: str, tmp_path: Path) -> None:
    """1e-13 of the same terms by NumPy; further from an analysis only where dyads are weak."""
    machine = eq.load(name).without_friction()
    linkage = assemble(machine)
    names = [item for item in signals_of(machine) if "." in item or item != "shaking_force"]
    script = javascript(linkage, names)
    analysis = eq.analyze(machine, ANGLES)
    theta = analysis.crank_angle
    got = run(script, script.numbers(linkage), theta, tmp_path)
    columns = script.numbers(linkage)[:, None, None]
    by_name = dict(zip(
        script.source.signals, script.source.states(*columns, *script.grid(theta)), strict=True
    ))  # fmt: skip
    same = np.array([np.broadcast_to(by_name[item], (1, len(theta)))[0] for item in names])
    assert np.all(np.abs(got - same) <= 1e-13 * size(same, names))
    arrays = {output.name: output.values for output in analysis.outputs}
    known = np.array([arrays[item] for item in names])
    assert np.all(np.abs(got - known) <= 1e-9 * size(known, names))


@pytest.mark.exhaustive(but=["stephenson-six-bar", "balance-geared-a"])
@node
@pytest.mark.parametrize("name", few(filter(has_forces, written()), DISTINCT))
def test_numbers_that_are_changed(name: str, tmp_path: Path) -> None:
    """Lengths, masses and speed that are handed over, against a machine with these numbers.

    Not in the soil, whose surface the numbers move: pages find it by the motion.
    """
    base = replace(eq.load(name).without_friction(), planting=None, resistances=())
    numbers = numbers_of(base, 1e-3)
    effort = "drive_torque" if "drive_torque" in signals_of(base) else "drive_force"
    signals = ["shaking_force.x", "shaking_force.y", "shaking_moment", effort]
    script = javascript(assemble(base), signals, {number.path: number.value for number in numbers})
    row = drawn(numbers, 1, 3)[0]
    changed = design(base, numbers, row)
    analysis = eq.analyze(changed, ANGLES)
    got = run(script, row, analysis.crank_angle, tmp_path)
    arrays = {output.name: output.values for output in analysis.outputs}
    known = np.array([arrays[signal] for signal in signals])
    assert np.all(np.abs(got - known) <= 1e-9 * size(known, signals))
    own = {output.name: output.values for output in eq.analyze(base, ANGLES).outputs}
    assert not np.allclose(known, [own[signal] for signal in signals])


@node
@pytest.mark.parametrize(
    "path",
    few(
        ["drive.speed", "links.crank.mass", "links.rocker.points.C.x"], {"links.rocker.points.C.x"}
    ),
)
def test_one_number_of_many(path: str, tmp_path: Path) -> None:
    """What it does not change is written once, as of a script of all numbers."""
    base = eq.load("watt-six-bar")
    every = {item.path: item.value for item in numbers_of(base, 1e-3)}
    linkage, names = assemble(base), signals_of(base)
    script = javascript(linkage, names, {path: every[path]})
    assert len(script.text) < 1.5 * len(javascript(linkage, names, every).text)
    theta = np.linspace(0.0, 6.0, ANGLES)
    got = run(script, np.array([every[path]]), theta, tmp_path)
    plain = javascript(linkage, names)
    same = run(plain, plain.numbers(linkage), theta, tmp_path)
    assert np.all(np.abs(got - same) <= 1e-12 * size(same, names))


@pytest.mark.exhaustive(but=["class-three-links.rod.points.C.x"])
@node
@pytest.mark.parametrize(("name", "path"), [
    ("class-three", "links.rod.points.C.x"), ("baler-pickup", "links.tine.points.R.y"),
])  # fmt: skip
def test_loops_start_from_the_base_and_report_where_they_do_not_arrive(
    name: str, path: str, tmp_path: Path
) -> None:
    base = eq.load(name).without_friction()
    (first,) = (item for item in numbers_of(base, 1e-3) if item.path == path)
    linkage = assemble(base)
    signals = ["drive_torque", "joints.B.force_x", "joints.B.force_y"]
    watched = [signal for signal in pose_signals(linkage) if signal.startswith("cosine")]
    assert len(watched) == 2
    script = javascript(linkage, [*signals, *watched], {path: first.value})
    for factor, arrives in ((1.0, True), (1.02, True), (3.0, False)):
        changed = design(base, [first], np.array([factor * first.value]))
        theta = np.arange(ANGLES) * (2 * np.pi / ANGLES)
        got = run(script, np.array([factor * first.value]), theta, tmp_path)
        assert bool(np.all(got[len(signals) :] >= FAR)) == arrives
        if arrives:
            arrays = {output.name: output.values for output in eq.analyze(changed, ANGLES).outputs}
            known = np.array([arrays[signal] for signal in signals])
            assert np.all(np.abs(got[: len(signals)] - known) <= 1e-9 * size(known, signals))


def test_long_functions_are_split() -> None:
    """Engines do not optimise long ones; what runs is compared in `test_example`."""
    machine = eq.load("knife-drive")
    script = javascript(assemble(machine), signals_of(machine))
    parts = [part for part in script.text.split("function ") if part.startswith("part")]
    assert len(parts) > 1
    for part in parts:
        given = sum(" = own[" in line or " = grid[" in line or "work[" in line
                    for line in part.splitlines())  # fmt: skip
        assert len(part.splitlines()) - given <= MOST_LINES + 6


@node
def test_forces_that_joints_share_with_teeth(tmp_path: Path) -> None:
    """Of a machine whose teeth all bear on one flank, which is watched."""
    machine = make("rocking_screen", 1).machine
    linkage = assemble(machine)
    assert linkage.shared is not None and machine.switches
    names = signals_of(machine)
    watched = [signal for signal in pose_signals(linkage) if signal.startswith("cosine")]
    assert len(watched) == sum(coupling.switches for coupling in machine.couplings)
    script = javascript(linkage, [*names, *watched])
    analysis = eq.analyze(machine, ANGLES)
    got = run(script, script.numbers(linkage), analysis.crank_angle, tmp_path)
    assert np.all(got[len(names) :] >= FAR)
    summed = {output.name: output.values for output in analysis.outputs}
    known = np.array([summed[name] for name in names])
    got = got[: len(names)]
    assert np.all(np.abs(got - known) <= 1e-9 * size(known, names))
