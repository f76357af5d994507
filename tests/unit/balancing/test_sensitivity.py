"""Sensitivities of machines with many links and crank angles take little memory."""

from __future__ import annotations

import tracemalloc

import numpy as np
import pytest

from equipoise.balancing import sensitivity
from equipoise.balancing.sensitivity import sensitivities
from support.analyses import subject_of

LARGE = 10_000
"""Crank angles at which the regressor of eight links takes 220 MiB."""


@pytest.mark.exhaustive(but=["shaking_force.y"])
@pytest.mark.parametrize("output", ["shaking_force.y", "drive_torque"])
def test_parts_give_what_all_crank_angles_at_once_do(
    output: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    machine = subject_of("squeezing-mechanism").machine
    whole = sensitivities(machine, output, 90)
    monkeypatch.setattr(sensitivity, "AT_ONCE", 7 * sensitivity.FOR_EACH * len(machine.links) ** 2)
    parts = sensitivities(machine, output, 90)  # of seven crank angles
    for name, value in whole.by_name.items():
        other = parts.by_name[name]
        assert other.values == pytest.approx(value.values, rel=1e-9, abs=1e-9 * value.rms)
        assert np.allclose(other.no_effect_at, value.no_effect_at)


def test_many_crank_angles_take_little_memory() -> None:
    machine = subject_of("squeezing-mechanism").machine
    tracemalloc.start()
    try:
        sensitivities(machine, angles=LARGE)
        peak = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    assert peak < 150 * 2**20
