"""The support as a rigid body: its matrices, its rest, and what its points do when it turns."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import equipoise as eq
from equipoise.errors import ModelError
from equipoise.mechanism.parts.support import unit_vector
from equipoise.vibration.body import (
    MountContact,
    Reading,
    SupportBody,
    at_rest,
    contacts_of,
    moved,
    rigid_mass,
    turning_stiffness,
)
from equipoise.vibration.linear import Linear
from support.refusals import refused
from unit.vibration.build import Array, Gauge, Mount, block, body_of, cart, close, springs

G = 9.80665
SEEDS = pytest.mark.parametrize("seed", range(4))


def cloud(rng: np.random.Generator) -> tuple[Array, Array]:
    """Draw some mass points: masses (5,) and places (5, 3)."""
    return rng.uniform(0.5, 3, 5), rng.normal(size=(5, 3))


def kinetic_energy(masses: Array, places: Array, pole: Array, rate: Array) -> float:
    """Of points that move with a rigid body: v + w x (p - pole)."""
    velocity = rate[:3] + np.cross(rate[3:], places - pole)
    return float(np.sum(masses * np.sum(velocity**2, axis=1)) / 2)


def tensor(masses: Array, places: Array) -> tuple[float, Array, Array]:
    """Return mass, centre of mass, and inertia tensor there."""
    mass = float(np.sum(masses))
    center = masses @ places / mass
    arms = places - center
    squares = np.sum(masses * np.sum(arms**2, axis=1))
    return mass, center, squares * np.eye(3) - (arms.T * masses) @ arms


# -- mass ------------------------------------------------------------------------------------------


@SEEDS
def test_mass_matrix_is_that_of_kinetic_energy(seed: int) -> None:
    """A body of mass points, as moments and products of inertia, about a reference off its centre.

    Products are the integrals of x y, y z and z x themselves, without a minus sign.
    """
    rng = np.random.default_rng(seed)
    masses, places = cloud(rng)
    mass, center, inertia = tensor(masses, places)
    body = body_of(
        mass=mass,
        center_of_mass=tuple(center),
        inertia=tuple(np.diag(inertia)),
        products=(-inertia[0, 1], -inertia[1, 2], -inertia[2, 0]),
        freedoms=("roll", "yaw", "pitch"),
        pivot=tuple(rng.normal(size=2)),
    )
    assert body.reference[2] == 0
    for rate in rng.normal(size=(5, 6)):
        wanted = kinetic_energy(masses, places, body.reference, rate)
        assert rate @ body.mass @ rate / 2 == pytest.approx(wanted)


@SEEDS
def test_moved_mass_matrix(seed: int) -> None:
    """About a point from which the old one lies at an arm: as if made there from the start."""
    rng = np.random.default_rng(seed)
    _, center, inertia = tensor(*cloud(rng))
    arm = rng.normal(size=3)
    here = rigid_mass(2.5, center, inertia)
    np.testing.assert_allclose(moved(here, arm), rigid_mass(2.5, center + arm, inertia), atol=1e-13)
    np.testing.assert_allclose(moved(moved(here, arm), -arm), here, atol=1e-12)


def test_pivot_inertia_is_about_the_pivot() -> None:
    about_center = body_of(pivot=(0.3, 0.4), inertia=(0.4,))
    about_pivot = body_of(pivot=(0.3, 0.4), inertia=(), pivot_inertia=0.4 + 10 * 0.25)
    np.testing.assert_allclose(about_pivot.mass, about_center.mass)
    assert about_pivot.mass[5, 5] == pytest.approx(2.9)


# -- forces ----------------------------------------------------------------------------------------


def test_wrench_does_the_work_of_its_force() -> None:
    """(f, r x f) times a velocity of the body is f times the velocity of its point."""
    body = body_of(center_of_mass=(0.2, -0.1, 0.3))
    rng = np.random.default_rng(0)
    force, point, rate = rng.normal(size=3), rng.normal(size=3), rng.normal(size=6)
    velocity = rate[:3] + np.cross(rate[3:], point - body.reference)
    assert body.wrench(force, point) @ rate == pytest.approx(float(force @ velocity))


@pytest.mark.parametrize("axis", ["roll", "yaw", "pitch"])
def test_rows_read_displacements_and_rotations(axis: str) -> None:
    body = body_of()
    rate = np.arange(1.0, 7.0)
    turning = body.row(Gauge(axis=axis)) @ rate
    assert turning == {"roll": 4, "yaw": 5, "pitch": 6}[axis]
    gauge = Gauge((0.5, 0.3, -0.2), direction=(1.0, 2.0, -2.0))
    velocity = rate[:3] + np.cross(rate[3:], [0.5, 0.3, -0.2])
    assert body.row(gauge) @ rate == pytest.approx(float(velocity @ [1, 2, -2]) / 3)


def second_differences(potential: Callable[[Array], float], count: int, h: float = 1e-3) -> Array:
    """Return the matrix (count, count) of second derivatives at 0.

    Central differences of 2nd order miss by h^2 / 12 of the fourth derivatives, 1e-7 of them.
    """
    steps = h * np.eye(count)
    result = np.empty((count, count))
    for j, step in enumerate(steps):
        for k, other in enumerate(steps):
            corners = [a * b * potential(a * step + b * other) for a in (1, -1) for b in (1, -1)]
            result[j, k] = sum(corners) / (4 * h * h)
    return result


@SEEDS
def test_turning_stiffness_against_finite_rotations(seed: int) -> None:
    """Second derivatives of -f . R b by the rotation vector of R."""
    force, arm = np.random.default_rng(seed).normal(size=(2, 3))

    def potential(turn: Array) -> float:
        return float(-force @ (Rotation.from_rotvec(turn).apply(arm) - arm))

    result = turning_stiffness(force, arm)
    np.testing.assert_allclose(result[3:, 3:], second_differences(potential, 3), atol=3e-6)
    assert not np.any(result[:3]) and not np.any(result[:, :3])


def potential_of(machine: eq.Machine) -> Callable[[Array], float]:
    """Energy of mounts and weights of a support that has moved far, linkages where they are on
    average."""
    linear = Linear.of(machine)
    body, rest = linear.body, linear.rest

    def potential(place: Array) -> float:
        turn = Rotation.from_rotvec(place[3:])

        def displaced(point: Array) -> Array:
            arm = np.asarray(point) - body.reference
            return np.asarray(place[:3] + turn.apply(arm) - arm)

        total = -sum(float(force @ displaced(point)) for force, point in linear.excitation.weights)
        for name, mount in body.support.mounts.items():
            if mount.point is None:
                row = body.row(mount)
                total += mount.torsional_stiffness * float(row @ place) ** 2 / 2
                total -= rest.preload[name] * float(row @ place)
                continue
            along = float(np.array(unit_vector(mount.direction)) @ displaced(np.array(mount.point)))
            total += mount.stiffness * along**2 / 2 - rest.preload[name] * along
        return total

    return potential


@pytest.mark.parametrize("machine", [springs(), cart()], ids=["planar", "spatial"])
def test_stiffness_is_that_of_the_potential(machine: eq.Machine) -> None:
    """Mounts keep their direction, so do weights; preloads and weights stiffen by how they turn."""
    linear = Linear.of(machine)
    potential, free = potential_of(machine), linear.body.free

    def along_free(part: Array) -> float:
        place = np.zeros(6)
        place[free] = part
        return potential(place)

    close(linear.stiffness, second_differences(along_free, len(free)), 1e-6)
    slopes = [(along_free(step) - along_free(-step)) / 2e-4 for step in 1e-4 * np.eye(len(free))]
    # At rest the potential has no slope; differences of it leave its size times 1e-16 / 1e-4.
    assert np.max(np.abs(slopes)) < 1e-5
    np.testing.assert_allclose(linear.rest.unbalance, 0, atol=1e-10)


# -- weight on its mounts --------------------------------------------------------------------------


def preloads(
    places: dict[str, float], one_sided: tuple[str, ...] = (), center: float = 0.0, **more: float
) -> dict[str, float]:
    """Return what equal springs under a beam of 10 kg at places along x bear, in units of its
    weight."""
    mounts = {
        name: Mount(
            (x, -0.3, 0.0),
            stiffness=more.get(name, 5e3),
            one_sided=name in one_sided,
        )
        for name, x in places.items()
    }
    linear = Linear.of(block(center_of_mass=(center, 0.0, 0.0), mounts=mounts))
    np.testing.assert_allclose(linear.rest.unbalance, 0, atol=1e-9)
    return {name: force / (10 * G) for name, force in linear.rest.preload.items()}


PLACES = {"a": -0.6, "b": -0.2, "c": 0.2, "d": 0.6}


@pytest.mark.parametrize(
    ("places", "center", "stiffness", "wanted"),
    [
        ({"a": 0.0, "b": 1.0}, 0.3, {"a": 1e3, "b": 7e4}, {"a": 0.7, "b": 0.3}),
        ({"a": -0.5, "b": 0.0, "c": 0.5}, 0.1, {}, {"a": 7 / 30, "b": 1 / 3, "c": 13 / 30}),
        (PLACES, -0.3, {}, {name: 0.25 - 0.3 * x / 0.8 for name, x in PLACES.items()}),
        (
            {"a": -1.0, "b": 0.0, "c": 1.0},
            0.0,
            {"a": 1e3, "b": 4e3, "c": 1e3},
            {"a": 1 / 6, "b": 4 / 6, "c": 1 / 6},
        ),
    ],
    ids=["two, by the lever", "three equal", "four equal", "a stiff one between two"],
)
def test_springs_share_the_weight(
    places: dict[str, float],
    center: float,
    stiffness: dict[str, float],
    wanted: dict[str, float],
) -> None:
    """Two by the lever; equal ones W (1 / n + e x / sum x^2); springs that sink alike by rates."""
    assert preloads(places, center=center, **stiffness) == pytest.approx(wanted)


def test_a_one_sided_mount_that_would_pull_lets_go() -> None:
    """Of three springs under a weight far out the farthest is pulled; without it the lever holds.

    The beam then tilts and leaves it by a gap, told as stiffness times gap.
    """
    places, center = {"a": -0.5, "b": 0.0, "c": 0.5}, 0.4
    pulled = preloads(places, center=center)
    assert pulled["a"] == pytest.approx(1 / 3 - 0.4)
    result = preloads(places, ("a",), center=center)
    # b sinks by 0.2, c by 0.8: the beam at a stands up by 0.4.
    assert result == pytest.approx({"a": -0.4, "b": 0.2, "c": 0.8})
    held = preloads(places, ("b", "c"), center=center)
    assert held == pytest.approx(pulled)


def test_letting_go_counts_for_the_stiffness_of_small_motion() -> None:
    mounts = {
        name: Mount((x, 0.0, 0.0), stiffness=5e3, damping=10.0, one_sided=True)
        for name, x in (("a", -0.5), ("b", 0.0), ("c", 0.5))
    }
    machine = block(center_of_mass=(0.4, 0.0, 0.0), mounts=mounts, freedoms=("heave",))
    assert Linear.of(machine).stiffness == pytest.approx(3 * 5e3)
    machine = machine.with_support(freedoms=("heave", "pitch"))
    linear = Linear.of(machine)
    assert linear.stiffness[0, 0] == pytest.approx(2 * 5e3)
    assert linear.damping[0, 0] == pytest.approx(2 * 10)
    assert not linear.rest.carries("a", mounts["a"])
    assert linear.rest.carries("b", mounts["b"])


def test_given_preloads_are_kept_and_the_others_bear_the_rest() -> None:
    mounts = {
        "lift": Mount((0.0, 0.0, 0.0), stiffness=1e3, preload=40.0),
        "a": Mount((-0.5, 0.0, 0.0), stiffness=5e3),
        "b": Mount((0.5, 0.0, 0.0), stiffness=5e3),
    }
    rest = Linear.of(block(mounts=mounts)).rest
    each = (10 * G - 40) / 2
    assert rest.preload == pytest.approx({"lift": 40, "a": each, "b": each})
    np.testing.assert_allclose(rest.unbalance, 0, atol=1e-10)


def test_given_preloads_may_leave_a_load_over() -> None:
    """Then the machine settles where the linear response has its mean: 1.93 N over 1 kN/m."""
    mounts = {
        "a": Mount((-0.5, 0.0, 0.0), stiffness=500.0, preload=50.0),
        "b": Mount((0.5, 0.0, 0.0), stiffness=500.0, preload=50.0),
    }
    linear = Linear.of(block(mounts=mounts))
    assert linear.rest.unbalance[1] == pytest.approx(100 - 10 * G)
    assert linear.motion(10.0).mean[1] == pytest.approx((100 - 10 * G) / 1000)


def test_given_preloads_may_leave_a_load_over_beside_mounts_without_any() -> None:
    across = Mount((0.0, 0.0, 0.0), direction=0.0, stiffness=300.0)
    mounts = {
        "a": Mount((-0.5, 0.0, 0.0), stiffness=500.0, preload=50.0),
        "b": Mount((0.5, 0.0, 0.0), stiffness=500.0, preload=50.0),
        "across": across,
    }
    linear = Linear.of(block(mounts=mounts))
    assert linear.rest.preload == pytest.approx({"a": 50, "b": 50, "across": 0})
    assert linear.rest.unbalance[1] == pytest.approx(100 - 10 * G)
    assert "do not balance the weight" in " ".join(map(str, linear.unsettled))
    sideways = {"across": across, "preloaded": replace(across, preload=3.0)}
    with refused(ModelError, "support.mounts", loose="heave"):
        _ = Linear.of(block(mounts=sideways)).rest


@pytest.mark.parametrize(
    ("mount", "wanted"),
    [
        (Mount((1.0, 0.0, 0.0), stiffness=1e3), 5 * G),
        (Mount(axis="pitch", torsional_stiffness=1e3), 10 * G),
    ],
    ids=["by a force", "by a moment"],
)
def test_a_pivot_bears_the_weight(mount: Mount, wanted: float) -> None:
    """Only the moment about the pivot, 1 m aside, is borne by the mount."""
    linear = Linear.of(block(pivot=(-1.0, 0.0), mounts={"a": mount}))
    assert linear.rest.preload["a"] == pytest.approx(wanted)


def test_weight_in_space() -> None:
    """Equal feet under a plane: W (1 / 4 + e x / sum x^2 + f z / sum z^2) about their middle."""
    places = {f"{x:+g} {z:+g}": (x, 0.0, z) for x in (-0.5, 0.5) for z in (-0.5, 0.5)}
    mounts = {name: Mount(place, stiffness=8e3) for name, place in places.items()}
    values = {"inertia": (1.0, 1.0, 1.0), "freedoms": ("heave", "roll", "pitch")}
    body = block(center_of_mass=(-0.2, 0.2, 0.1), mounts=mounts, **values)
    wanted = {n: 10 * G * (0.25 - 0.2 * x + 0.1 * z) for n, (x, _, z) in places.items()}
    assert Linear.of(body).rest.preload == pytest.approx(wanted)


# -- what does not hold ----------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("mounts", "coordinates"),
    [
        ({}, "heave"),
        ({"a": Mount((0.0, 0.0, 0.0), damping=9.0)}, "heave"),
        ({"a": Mount((0.0, 0.0, 0.0), direction=0.0, stiffness=9.0)}, "heave"),
        ({"a": Mount((0.5, 0.0, 0.0), stiffness=9.0, one_sided=True)}, "heave and pitch"),
        ({"a": Mount((0.5, 0.0, 0.0), stiffness=9e3)}, "heave and pitch"),
        ({"a": Mount(axis="pitch", torsional_stiffness=9.0)}, "heave"),
    ],
)
def test_mounts_that_do_not_carry_the_weight(mounts: dict[str, Mount], coordinates: str) -> None:
    with pytest.raises(ModelError) as caught:
        _ = Linear.of(block(mounts=mounts)).rest
    assert str(caught.value) == (
        f"support.mounts: they do not carry the weight in {coordinates}; add a mount there, or "
        "give the mounts a preload"
    )


def test_without_gravity_nothing_needs_to_be_carried() -> None:
    rest = Linear.of(replace(block(), gravity=(0.0, 0.0))).rest
    assert not any(rest.preload.values())


def test_no_support() -> None:
    with refused(ModelError, "support"):
        _ = SupportBody(eq.load("yamashita-1")).support


def test_at_rest_with_weights_of_any_direction() -> None:
    """A force aside is borne by the mount along it."""
    body = body_of(mounts={
        "up": Mount((0.0, 0.0, 0.0), stiffness=1e3),
        "along": Mount((0.0, 0.0, 0.0), direction=0.0, stiffness=1e3),
    })  # fmt: skip
    rest = at_rest(body, [(np.array([7.0, -5.0, 0.0]), np.zeros(3))])
    assert rest.preload == pytest.approx({"up": 5, "along": -7})


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
def test_rates_against_differences(name: str) -> None:
    """Central differences over h miss by h^2 / 6 of the third derivative, up to some 10."""
    reading = Reading.of(BODY, GAUGES[name])

    def moving(t: Array) -> Array:
        return reading.velocity(path(t), rates(t))

    slope = (reading.displacement(path(T + H)) - reading.displacement(path(T - H))) / (2 * H)
    np.testing.assert_allclose(moving(T), slope, rtol=0, atol=1e-7)
    acceleration = reading.acceleration(path(T), rates(T), changes(T))
    np.testing.assert_allclose(
        acceleration, (moving(T + H) - moving(T - H)) / (2 * H), rtol=0, atol=1e-7
    )


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
    """A one-sided one never pulls."""
    at = Reading.of(BODY, GAUGES["aslant"])
    wanted = 40 - 500 * at.displacement(path(T)) - 30 * at.velocity(path(T), rates(T))
    assert np.min(wanted) < 0 < np.max(wanted)
    both, pushing = (
        MountContact("a", at, 40.0, 500.0, 30.0, one_sided).force(path(T), rates(T))
        for one_sided in (False, True)
    )
    np.testing.assert_allclose(both, wanted)
    np.testing.assert_array_equal(pushing, np.maximum(both, 0))


def test_derivatives_of_a_one_sided_force_by_complex_steps() -> None:
    """Where it is off its force is 0 with all its derivatives."""
    at = Reading.of(BODY, GAUGES["up"])
    contact = MountContact("a", at, 40.0, 500.0, 30.0, True)
    for heave, slope in ((0.0, -500.0), (0.2, 0.0)):
        place = np.array([0, heave + 1e-30j, 0])
        assert contact.force(place, np.zeros(3)).imag / 1e-30 == pytest.approx(slope)


def test_contacts_of_a_support() -> None:
    """By name, with the preloads that hold the weight; springs of lines and of axes alike."""
    turn = Mount(axis="pitch", torsional_stiffness=70.0, torsional_damping=3.0)
    machine = springs()
    assert machine.support is not None
    machine = machine.with_support(mounts={**machine.support.mounts, "turn": turn})
    linear = Linear.of(machine)
    contacts = contacts_of(linear.body, linear.rest)
    assert [c.name for c in contacts] == ["front", "back", "along", "slant", "turn"]
    assert [c.preload for c in contacts] == list(linear.rest.preload.values())
    assert [c.stiffness for c in contacts] == [1.1e4, 9e3, 2e4, 6e3, 70]
    assert [c.damping for c in contacts] == [60, 50, 80, 30, 3]
    assert contacts[-1].at.along is None
