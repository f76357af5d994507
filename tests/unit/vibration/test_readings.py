"""What gauges read and mounts do on a support that turns far, against differences and vectors."""

from __future__ import annotations

import numpy as np
import pytest

from equipoise.mechanism.support import unit_vector
from equipoise.vibration.body import Contact, Reading, contacts_of
from equipoise.vibration.linear import Linear
from unit.vibration.build import Array, Gauge, Mount, body_of, springs

GAUGES = {
    "up": Gauge((0.5, 0.3, 0.0)),
    "aslant": Gauge((-0.2, 0.4, 0.7), direction=2.0),
    "partly across": Gauge((0.1, -0.6, 0.2), direction=(1.0, -2.0, 2.0)),
    "tilt": Gauge(axis="pitch"),
}
BODY = body_of(center_of_mass=(0.15, -0.1, 0.0))
readings = pytest.mark.parametrize("name", GAUGES)


def path(t: Array) -> Array:
    """A motion of the support with large turns, (3, N), against time."""
    return np.stack([0.1 * np.sin(3 * t), 0.2 * np.cos(2 * t), 0.9 * np.sin(t + 1)])


def rates(t: Array) -> Array:
    return np.stack([0.3 * np.cos(3 * t), -0.4 * np.sin(2 * t), 0.9 * np.cos(t + 1)])


def changes(t: Array) -> Array:
    return np.stack([-0.9 * np.sin(3 * t), -0.8 * np.cos(2 * t), -0.9 * np.sin(t + 1)])


T = np.linspace(0, 6, 25)
H = 1e-4


@readings
def test_displacement_is_that_of_the_point(name: str) -> None:
    """The rotation matrix, on the arm from the reference point."""
    gauge, reading = GAUGES[name], Reading.of(BODY, GAUGES[name])
    place = path(T)
    if gauge.point is None:
        np.testing.assert_allclose(reading.displacement(place), place[2])
        return
    arm = np.array(gauge.point[:2]) - BODY.reference[:2]
    c, s = np.cos(place[2]), np.sin(place[2])
    turned = np.moveaxis(np.array([[c, -s], [s, c]]), 2, 0) @ arm
    wanted = (place[:2].T + turned - arm) @ np.array(unit_vector(gauge.direction)[:2])
    np.testing.assert_allclose(reading.displacement(place), wanted, atol=1e-15)
    assert reading.displacement(np.zeros(3)) == 0


@readings
def test_velocity_against_differences(name: str) -> None:
    """Central differences over h miss by h^2 / 6 of the third derivative, up to some 10."""
    reading = Reading.of(BODY, GAUGES[name])
    before, after = (reading.displacement(path(T + d)) for d in (-H, H))
    found = reading.velocity(path(T), rates(T))
    np.testing.assert_allclose(found, (after - before) / (2 * H), rtol=0, atol=1e-7)


@readings
def test_acceleration_against_differences(name: str) -> None:
    reading = Reading.of(BODY, GAUGES[name])
    before, after = (reading.velocity(path(T + d), rates(T + d)) for d in (-H, H))
    found = reading.acceleration(path(T), rates(T), changes(T))
    np.testing.assert_allclose(found, (after - before) / (2 * H), rtol=0, atol=1e-7)


@readings
def test_a_force_does_work_along_its_reading(name: str) -> None:
    """Power of force and moment about the reference point is force times reading's velocity."""
    reading = Reading.of(BODY, GAUGES[name])
    force = 3 + np.sin(5 * T)
    parts = reading.wrench(force, path(T))
    power = sum(part * rate for part, rate in zip(parts, rates(T), strict=True))
    np.testing.assert_allclose(power, force * reading.velocity(path(T), rates(T)), atol=1e-14)


@pytest.mark.parametrize("axis", ["roll", "yaw"])
def test_a_planar_support_does_not_turn_about_other_axes(axis: str) -> None:
    reading = Reading.of(BODY, Gauge(axis=axis))
    assert not np.any(reading.displacement(path(T)))
    assert not np.any(reading.velocity(path(T), rates(T)))
    assert not np.any(reading.acceleration(path(T), rates(T), changes(T)))
    *_, moment = reading.wrench(np.ones(len(T)), path(T))
    assert not np.any(moment)


@readings
def test_small_motion_is_the_row_of_the_body(name: str) -> None:
    """Second order in the displacement is left over."""
    gauge = GAUGES[name]
    for place in 1e-6 * np.eye(3):
        row = BODY.row(gauge)[[0, 1, 5]]
        assert Reading.of(BODY, gauge).displacement(place) == pytest.approx(row @ place, abs=1e-11)


# -- mounts ----------------------------------------------------------------------------------------


def test_mount_pushes_against_displacement_and_velocity() -> None:
    at = Reading.of(BODY, GAUGES["aslant"])
    contact = Contact("a", at, 40.0, 500.0, 30.0, False)
    wanted = 40 - 500 * at.displacement(path(T)) - 30 * at.velocity(path(T), rates(T))
    np.testing.assert_allclose(contact.force(path(T), rates(T)), wanted)


def test_one_sided_mount_never_pulls() -> None:
    at = Reading.of(BODY, GAUGES["aslant"])
    both = Contact("a", at, 40.0, 500.0, 30.0, False).force(path(T), rates(T))
    found = Contact("a", at, 40.0, 500.0, 30.0, True).force(path(T), rates(T))
    assert np.min(both) < 0 < np.max(both)
    np.testing.assert_array_equal(found, np.maximum(both, 0))


def test_derivatives_of_a_one_sided_force_by_complex_steps() -> None:
    """Where it is off its force is 0 with all its derivatives."""
    at = Reading.of(BODY, GAUGES["up"])
    contact = Contact("a", at, 40.0, 500.0, 30.0, True)
    for heave, slope in ((0.0, -500.0), (0.2, 0.0)):
        place = np.array([0, heave + 1e-30j, 0])
        assert contact.force(place, np.zeros(3)).imag / 1e-30 == pytest.approx(slope)


def test_contacts_of_a_support() -> None:
    """By name, with the preloads that hold the weight; springs of lines and of axes alike."""
    turn = Mount(axis="pitch", torsional_stiffness=70.0, torsional_damping=3.0)
    machine = springs()
    assert machine.support is not None
    machine = machine.with_support(mounts={**machine.support.mounts, "turn": turn})
    linear = Linear.of(machine, "moment")
    contacts = contacts_of(linear.body, linear.rest)
    assert [c.name for c in contacts] == ["front", "back", "along", "slant", "turn"]
    assert [c.preload for c in contacts] == list(linear.rest.preload.values())
    assert [c.stiffness for c in contacts] == [1.1e4, 9e3, 2e4, 6e3, 70]
    assert [c.damping for c in contacts] == [60, 50, 80, 30, 3]
    assert contacts[-1].at.along is None
