"""The regressor, and the combinations of inertial parameters that can be told apart."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import equipoise as eq
from equipoise.errors import MassError, UsageError
from support.refusals import refused
from unit.mechanism.build import ORIGIN, crank_rocker, heavy, machine

OUTPUTS = ("shaking_force", "shaking_moment", "frame_force", "frame_moment", "drive_torque")
NAMES = ["yamashita-1", "slider-crank-engine", "watt-six-bar", "scotch-yoke", "class-three",
         "geared-counterweight", "quick-return"]  # fmt: skip


def lone() -> eq.Machine:
    return machine({"A": ORIGIN}, {"crank": heavy(A=ORIGIN, B=(0.3, 0.0))})


# -- regressor -------------------------------------------------------------------------------------


def test_parameters_are_those_of_each_link_about_its_origin() -> None:
    regressor = eq.mechanism.regressor(eq.move(lone(), 4))
    link = lone().links["crank"]
    assert link.mass is not None
    assert link.center_of_mass is not None
    assert link.inertia is not None
    x, y = link.center_of_mass
    assert regressor.parameters == tuple(
        ("crank", quantity) for quantity in ("mass", "moment_x", "moment_y", "inertia")
    )
    about_origin = link.inertia + link.mass * (x * x + y * y)
    np.testing.assert_allclose(
        regressor.values, [link.mass, link.mass * x, link.mass * y, about_origin]
    )


def test_shapes() -> None:
    machine_ = eq.load("geared-counterweight")
    regressor = eq.mechanism.regressor(eq.move(machine_, 5))
    for output in OUTPUTS:
        assert getattr(regressor, output).shape == (16, 5)
    assert {joint.value.shape for joint in regressor.joints.values()} == {(16, 5)}
    assert {mesh.tangential.shape for mesh in regressor.gears.values()} == {(16, 5)}


def test_regressor_of_one_crank() -> None:
    """What each parameter of a lone crank does, in closed form."""
    theta, speed, acceleration, g = np.array([0.4, 2.0]), 3.0, 5.0, 9.80665
    regressor = eq.mechanism.regressor(eq.move(lone(), theta, speed, acceleration))
    outwards = np.exp(1j * theta)
    inertial = (speed**2 - 1j * acceleration) * outwards
    np.testing.assert_allclose(
        regressor.shaking_force, [0 * inertial, inertial, 1j * inertial, [0, 0]], atol=1e-13
    )
    weights = [0 * theta, g * np.cos(theta), -g * np.sin(theta), 0 * theta + acceleration]
    np.testing.assert_allclose(regressor.drive_torque, weights, atol=1e-13)
    np.testing.assert_allclose(regressor.shaking_moment[3], -acceleration)


def test_about_another_point() -> None:
    motion = eq.move(crank_rocker(), 12)
    about = eq.mechanism.regressor(motion, (0.3, 0.4))
    want = eq.forces(motion, (0.3, 0.4))
    np.testing.assert_allclose(about.values @ about.shaking_moment, want.shaking_moment)
    np.testing.assert_allclose(about.values @ about.frame_moment, want.frame_moment)


def test_unknown_masses() -> None:
    given = crank_rocker().with_link("rocker", mass=None, center_of_mass=None, inertia=None)
    with refused(MassError, links="rocker"):
        eq.mechanism.regressor(eq.move(given, 4))


# -- base parameters -------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("name", "outputs", "count"),
    [
        ("yamashita-1", ["shaking_force"], 4),
        ("yamashita-1", ["frame_force"], 5),
        ("yamashita-1", ["shaking_force", "shaking_moment", "drive_torque"], 8),
        ("slider-crank-engine", ["shaking_force"], 4),
        ("slider-crank-engine", ["drive_torque"], 6),
        ("scotch-yoke", ["shaking_force"], 3),
        ("geared-counterweight", ["shaking_force"], 6),
        ("watt-six-bar", ["shaking_force"], 6),
        ("twin-engine", ["rocking_moment"], 6),
        ("twin-engine", ["shaking_force", "rocking_moment"], 12),
    ],
)
def test_counts(name: str, outputs: list[str], count: int) -> None:
    """Each loop of pins leaves two moments of its last link undetermined, and so on."""
    assert eq.mechanism.base_parameters(eq.load(name), outputs).count == count


def test_a_lone_crank() -> None:
    """Mass shows in weight alone; the shaking moment about the pivot tells inertia."""
    assert eq.mechanism.base_parameters(lone(), ["shaking_force"]).count == 2
    assert eq.mechanism.base_parameters(lone(), ["frame_force"]).count == 3
    assert eq.mechanism.base_parameters(lone(), ["shaking_moment"]).count == 1
    assert eq.mechanism.base_parameters(lone()).count == 3


def with_values(given: eq.Machine, values: Any) -> eq.Machine:
    """Give the links these parameters."""
    for (name, link), (mass, mx, my, about_origin) in zip(
        given.links.items(), np.reshape(values, (-1, 4)), strict=True
    ):
        assert link.mass is not None
        center = (float(mx / mass), float(my / mass))
        inertia = float(about_origin - (mx**2 + my**2) / mass)
        given = given.with_link(name, mass=float(mass), center_of_mass=center, inertia=inertia)
    return given


@pytest.mark.parametrize("name", NAMES)
def test_base_parameters_decide_the_outputs(name: str) -> None:
    """Two mass distributions with the same base parameters cannot be told apart."""
    given = replace(eq.load(name), loads=())
    parameters = eq.mechanism.base_parameters(given)
    assert parameters.values is not None
    before = eq.analyze(given, 24, acceleration=30.0).forces
    values = eq.mechanism.regressor(before.motion).values
    hidden = null_space(parameters.combinations)
    change = hidden @ np.random.default_rng(6).normal(size=hidden.shape[1])
    moved = values + change * lightest(values, change)
    other = with_values(given, moved)
    np.testing.assert_allclose(parameters.combinations @ moved, parameters.values, atol=1e-12)
    after = eq.analyze(other, 24, acceleration=30.0).forces
    for output in ("shaking_force", "shaking_moment", "drive_torque"):
        first, two = (getattr(forces, output) for forces in (before, after))
        first, two = (getattr(signal, "value", signal) for signal in (first, two))
        scale = float(np.max(np.abs(first)))
        np.testing.assert_allclose(two, first, rtol=0, atol=1e-9 * scale, err_msg=output)
    assert max(abs(after.joints[key].size - joint.size).max()
               for key, joint in before.joints.items()) > 1e-6  # fmt: skip


def null_space(matrix: np.ndarray) -> np.ndarray:
    _, _, rows = np.linalg.svd(matrix)
    return rows[np.linalg.matrix_rank(matrix) :].T


def lightest(values: np.ndarray, change: np.ndarray) -> float:
    """Step that leaves every mass and inertia positive."""
    factor = 1.0
    for k in range(0, len(values), 4):
        for _ in range(60):
            mass, mx, my, inertia = (values + factor * change)[k : k + 4]
            if mass > 0.2 * values[k] and inertia * mass > mx**2 + my**2:
                break
            factor /= 2
    return factor


@pytest.mark.parametrize("name", NAMES)
def test_outputs_follow_from_the_base_parameters(name: str) -> None:
    """Columns of the kept parameters times the base parameters give the outputs."""
    given = replace(eq.load(name), loads=())
    parameters = eq.mechanism.base_parameters(given)
    assert parameters.values is not None
    kept = [int(np.flatnonzero(row)[0]) for row in parameters.combinations]
    np.testing.assert_allclose(
        parameters.combinations[:, kept], np.eye(parameters.count), atol=1e-9
    )
    forces = eq.analyze(given, 30, acceleration=-11.0).forces
    rows = eq.mechanism.regressor(forces.motion)
    got = parameters.values @ rows.drive_torque[kept]
    scale = float(np.max(np.abs(forces.drive_torque)))
    np.testing.assert_allclose(got, forces.drive_torque, rtol=0, atol=1e-8 * scale)
    got = parameters.values @ rows.shaking_force[kept]
    scale = float(np.max(forces.shaking_force.size))
    np.testing.assert_allclose(got, forces.shaking_force.value, rtol=0, atol=1e-8 * scale)


def test_base_parameters_need_no_masses() -> None:
    given = crank_rocker()
    bare = replace(given, links={name: eq.Link(link.points) for name, link in given.links.items()})
    parameters = eq.mechanism.base_parameters(bare)
    assert parameters.values is None
    np.testing.assert_allclose(
        parameters.combinations, eq.mechanism.base_parameters(given).combinations
    )


@pytest.mark.parametrize("size", [1e-3, 1e3])
def test_size_does_not_matter(size: float) -> None:
    given = crank_rocker()
    grown = replace(
        given,
        frame={name: (x * size, y * size) for name, (x, y) in given.frame.items()},
        links={
            name: eq.Link({key: (x * size, y * size) for key, (x, y) in link.points.items()})
            for name, link in given.links.items()
        },
    )
    actual, plain = eq.mechanism.base_parameters(grown), eq.mechanism.base_parameters(given)
    assert actual.count == plain.count
    assert np.array_equal(actual.combinations != 0, plain.combinations != 0)


def test_combinations_can_be_read() -> None:
    lines = str(eq.mechanism.base_parameters(eq.load("slider-crank-engine"))).splitlines()
    assert lines[0] == "+1 crank.moment_x +0.025 rod.mass +0.025 piston.mass"
    assert lines[1] == "+1 crank.moment_y"
    assert lines[-1] == "+1 piston.moment_y"
    twin = eq.mechanism.base_parameters(eq.load("twin-engine"), ["rocking_moment"])
    assert str(twin).splitlines()[2] == "+1 rod-1.product_zx +0.09 piston-1.moment_z"
    assert twin.values is not None
    assert twin.values[2] == pytest.approx(-0.04 * (0.13 * 0.028 + 0.09 * 0.14))


def test_unknown_outputs() -> None:
    with refused(UsageError, kind="output", given="torque"):
        eq.mechanism.base_parameters(crank_rocker(), ["torque"])
    with refused(UsageError, name="shaking_force"):
        eq.mechanism.base_parameters(crank_rocker(), ["shaking_forces"])
