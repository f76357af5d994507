"""FMUs run by FMPy: their C gives what the analysis gives, but for rounding."""

from __future__ import annotations

import os
import shutil
import zipfile
from pathlib import Path
from typing import Any

import fmpy
import numpy as np
import pytest
from fmpy.validation import validate_fmu

import equipoise as eq
from support.refusals import refused
from surface.running import example_text

START = 0.3
"""Crank angle at which the FMU begins, rad."""
RUNNING = [
    *("kim-chung-b", "quick-return", "scotch-yoke", "sieve", "spring-balanced-crank"),
    *("geared-counterweight", "planetary-planting-arm", "slider-crank-engine"),
    "class-three",
    "baler-pickup",
]
compiled = pytest.mark.skipif(shutil.which("cc") is None, reason="needs a C compiler")


RACK = """
[links.ram]
points.R = ["0 mm", "0 mm"]
mass = "300 g"
center_of_mass = ["20 mm", "5 mm"]
inertia = "90 kg mm^2"

[[sliders]]
link = "ram"
point = "R"
on = "frame"
through = "A"
direction = "20 deg"

[[racks]]
pinion = "rocker"
rack = "ram"
radius = "25 mm"
side = "left"
"""
MADE = {"rack": example_text("yamashita-1") + RACK}


def run(name: str, path: Path, **options: Any) -> tuple[eq.Machine, Any]:
    """The machine, and what its FMU told over time."""
    machine = eq.loads(MADE[name]) if name in MADE else eq.load(name)
    eq.export(machine, path, crank_angle=START)
    assert validate_fmu(str(path)) == []
    return machine, fmpy.simulate_fmu(str(path), **options)


@pytest.mark.exhaustive(but=["quick-return", "rack"])
@compiled
@pytest.mark.parametrize("name", [*RUNNING, *MADE])
def test_every_output_over_a_turn(name: str, tmp_path: Path) -> None:
    machine, actual = run(name, tmp_path / "x.fmu")
    angle = actual["crank_angle"]
    assert angle[0] == START
    assert angle[-1] - START == pytest.approx(np.copysign(2 * np.pi, machine.drive.speed))
    bare = eq.Machine(**{**{key: getattr(machine, key) for key in KEPT}, "loads": ()})
    outputs = eq.analyze(bare, angle).outputs
    names = [entry for entry in actual.dtype.names if entry not in {"time", "crank_angle"}]
    assert {"drive_torque", "shaking_force.x", "shaking_moment"} <= {*names}
    sizes: dict[str, float] = {}
    for item in names:  # what vanishes has the rounding of its like
        unit, size = outputs[item].unit, float(np.max(np.abs(outputs[item].values)))
        sizes[unit] = max(sizes.get(unit, 0.0), size)
    for item in names:
        least = 1e-9 * sizes[outputs[item].unit]
        np.testing.assert_allclose(
            actual[item], outputs[item].values, rtol=0, atol=least, err_msg=item
        )


KEPT = ("title", "drive", "frame", "links", "assembly", "sliders", "gears", "racks", "gravity",
        "springs", "position", "curved_slots")  # fmt: skip


@compiled
def test_speed_and_acceleration_are_inputs(tmp_path: Path) -> None:
    """Each step goes by those that it begins with."""
    kinds = [("time", float), ("speed", float), ("acceleration", float)]
    given = np.array([(0.0, 5.0, 2.0), (0.2, 5.4, 2.0)], dtype=kinds)
    machine, actual = run(
        "yamashita-1", tmp_path / "x.fmu", input=given, stop_time=0.2, output_interval=0.01
    )
    turned = actual["crank_angle"][-1] - START
    assert turned == pytest.approx(5 * 0.2 + 0.5 * 2 * 0.2**2, rel=1e-9)
    last = eq.analyze(machine, [actual["crank_angle"][-1]], speed=5.38, acceleration=2.0)
    assert actual["drive_torque"][-1] == pytest.approx(last.forces.drive_torque[0], rel=1e-9)


@pytest.mark.skipif(os.name != "posix", reason="needs programs that are scripts")
@pytest.mark.parametrize(
    "compiler",
    [None, "#!/bin/sh\nexit 1\n", "#!/bin/sh\n", '#!/bin/sh\n: > "$5"\n', "#!/no/shell\n"],
    ids=["none", "fails", "writes nothing", "writes an empty file", "cannot be run"],
)
def test_without_what_a_compiler_makes_it_has_its_sources(
    compiler: str | None, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    if compiler is not None:
        (tmp_path / "cc").write_text(compiler, encoding="utf-8")
        (tmp_path / "cc").chmod(0o755)
    monkeypatch.setenv("PATH", str(tmp_path))
    (text,) = eq.export(eq.load("yamashita-1"), tmp_path / "x.fmu")
    assert "fmpy compile" in text
    names = zipfile.ZipFile(tmp_path / "x.fmu").namelist()
    assert names == ["modelDescription.xml", "sources/model.c"]


def test_what_no_c_is_written_of(tmp_path: Path) -> None:
    path = tmp_path / "x.fmu"
    with refused(eq.EquipoiseError, title="co-simulation (FMI 2.0)"):
        eq.export(eq.load("hydraulic-loader"), path)
    assert not path.exists()
    exported = eq.export(eq.load("riding-transplanter"), path)
    assert exported == ("the support", "all rows but one")
