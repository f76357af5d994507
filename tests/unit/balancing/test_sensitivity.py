"""Sensitivities: closed forms, ranking and refusals."""

from __future__ import annotations

import numpy as np
import pytest

import equipoise as eq
from equipoise.balancing.sensitivity import sensitivities
from equipoise.errors import MassError, UsageError
from unit.mechanism.build import ORIGIN, crank_rocker, heavy, machine

LINK = heavy(A=ORIGIN, B=(0.3, 0.0))


def lone() -> eq.Machine:
    return machine({"A": ORIGIN}, {"crank": LINK})


def test_a_lone_crank() -> None:
    """At 10 rad/s the force is 100 m r, and its height that times a sine."""
    found = sensitivities(lone(), angles=36)
    theta = found.crank_angle
    np.testing.assert_allclose(found["crank.center_x"].values, 50 * np.sin(theta), atol=1e-12)
    np.testing.assert_allclose(found["crank.center_y"].values, 50 * np.cos(theta), atol=1e-12)
    assert found["crank.center_x"].rms == pytest.approx(50 / 2**0.5)
    assert found["crank.center_x"].percent == pytest.approx(0.003 * 50 / 2**0.5)
    np.testing.assert_allclose(found["crank.center_x"].no_effect_at, [0, np.pi], atol=1e-12)
    half = [np.pi / 2, 3 * np.pi / 2]
    np.testing.assert_allclose(found["crank.center_y"].no_effect_at, half, atol=1e-12)
    assert not found["crank.inertia"].has_effect
    assert found["crank.inertia"].no_effect_at.size == 0
    assert [one.name for one in found.ranked][-1] == "crank.mass"


def test_torque_of_a_lone_crank_is_weight() -> None:
    found = sensitivities(lone(), "drive_torque", 36)
    wanted = 0.5 * 9.80665 * np.cos(found.crank_angle)
    np.testing.assert_allclose(found["crank.center_x"].values, wanted, atol=1e-12)
    assert not found["crank.inertia"].has_effect


def test_acceleration_of_the_drive_does_not_count() -> None:
    given = crank_rocker()
    starting = given.with_drive(acceleration=50.0)
    for output in ("shaking_moment", "drive_torque"):
        one, two = (sensitivities(m, output, 24) for m in (given, starting))
        for name in one.by_name:
            np.testing.assert_array_equal(one[name].values, two[name].values)


def test_number_of_crank_angles_does_not_move_the_zeros() -> None:
    few, many = (sensitivities(crank_rocker(), angles=n) for n in (180, 1440))
    for name, one in few.by_name.items():
        np.testing.assert_allclose(one.no_effect_at, many[name].no_effect_at, atol=1e-9)


def test_a_machine_at_rest_has_none() -> None:
    found = sensitivities(crank_rocker(drive=eq.Drive("crank", 0.0)), angles=24)
    assert found.ranked == ()


def test_a_cycle_of_many_turns() -> None:
    found = sensitivities(eq.load("planetary-planting-arm"), angles=72)
    assert len(found.crank_angle) == 72 * found.turns
    for one in found.ranked:
        assert np.all(np.diff(one.no_effect_at) > 0)
        assert np.all(one.no_effect_at < 2 * np.pi * found.turns)


def test_plain_data() -> None:
    found = sensitivities(lone(), angles=36).to_dict()
    assert found["output"] == "shaking_force.y"
    assert found["crank_angle"].shape == (36,)
    one = found["sensitivities"]["crank.center_x"]
    assert list(one) == ["values", "rms", "percent", "has_effect", "no_effect_at"]


def test_refusals() -> None:
    with pytest.raises(UsageError, match="did you mean 'shaking_force"):
        sensitivities(lone(), "shaking_force")
    for angles in (3, True, 36.0, "36"):
        with pytest.raises(UsageError, match="at least 8"):
            sensitivities(lone(), angles=angles)  # type: ignore[arg-type]
    with pytest.raises(UsageError, match=r"did you mean 'crank\.center_x'"):
        sensitivities(lone(), angles=36)["crank.centre_x"]
    bare = lone().with_link("crank", mass=None, center_of_mass=None, inertia=None)
    with pytest.raises(MassError):
        sensitivities(bare)
