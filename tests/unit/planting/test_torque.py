"""Forces with the soil and without it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import equipoise as eq
from equipoise.mechanism.field import Soil
from equipoise.planting.summary import plant, soil_forces
from unit.planting.build import EXAMPLES, planetary, twice

SOIL = Soil(resistance=5.0, per_depth=400.0)


@pytest.mark.parametrize("name", [*EXAMPLES, "three turns"])
def test_both_are_what_an_analysis_finds(name: str) -> None:
    machine = planetary(depth=0.05) if name == "three turns" else eq.load(name)
    found = soil_forces(machine.with_planting(soil=SOIL))
    assert found is not None
    wet = eq.analyze(machine.with_planting(soil=SOIL), 720).forces
    dry = eq.analyze(machine, 720).forces
    for got, want in ((found.in_soil, wet), (found.in_air, dry)):
        np.testing.assert_allclose(got.drive_torque, want.drive_torque, rtol=1e-12, atol=1e-12)
        for joint in want.joints:
            np.testing.assert_allclose(got.joints[joint].value, want.joints[joint].value,
                                       rtol=1e-12, atol=1e-10)  # fmt: skip
    assert np.max(np.abs(wet.drive_torque - dry.drive_torque)) > 0.1
    np.testing.assert_array_equal(found.motion.crank_angle, wet.motion.crank_angle)


def test_figures_of_torque_and_joints() -> None:
    machine = eq.load("kim-chung-b").with_planting(soil=SOIL)
    found = soil_forces(machine)
    assert found is not None
    compared = found.compared()
    assert list(compared) == ["drive_torque", "joints.A", "joints.B", "joints.D", "joints.C"]
    for name, (air, soil) in compared.items():
        for figures, forces in ((air, found.in_air), (soil, found.in_soil)):
            values = forces.drive_torque if name == "drive_torque" else (
                forces.joints[name.removeprefix("joints.")].size
            )  # fmt: skip
            k = int(np.argmax(np.abs(values)))
            assert figures.peak == abs(values[k])
            assert figures.peak_at == found.motion.crank_angle[k]
            assert figures.mean == pytest.approx(np.mean(values), rel=1e-12)


def test_loads_of_the_machine_act_in_air_and_in_soil() -> None:
    machine = eq.load("kim-chung-a").with_planting(soil=SOIL)
    loaded = replace(machine, loads=(eq.Load("crank", torque=-1.0),))
    found = soil_forces(loaded)
    bare = soil_forces(machine)
    assert found is not None
    assert bare is not None
    np.testing.assert_allclose(found.in_air.drive_torque, bare.in_air.drive_torque + 1)
    np.testing.assert_allclose(found.in_soil.drive_torque, bare.in_soil.drive_torque + 1)


def test_no_soil_or_masses_no_forces() -> None:
    assert soil_forces(eq.load("kim-chung-a")) is None
    assert soil_forces(eq.load("yamashita-1")) is None
    assert soil_forces(twice(soil=SOIL)) is None
    assert plant(twice(soil=SOIL)).forces is None
    assert "forces" not in plant(twice(soil=SOIL)).to_dict()


def test_they_stand_in_the_output() -> None:
    figures = plant(eq.load("kim-chung-a").with_planting(soil=SOIL))
    given = figures.to_dict()["forces"]
    assert figures.forces is figures.forces
    assert figures.forces is not None
    air, soil = figures.forces.compared()["joints.C"]
    assert given["joints.C"]["in_air"]["peak"] == air.peak
    assert given["joints.C"]["in_soil"]["max_at"] == soil.max_at
    assert set(given["drive_torque"]["in_soil"]) == {
        "mean", "rms", "peak", "peak_at", "max", "max_at", "min", "min_at", "peak_to_peak"
    }  # fmt: skip
