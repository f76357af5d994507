"""Physics of a machine that shakes its support: energy, limits, symmetries, and what adds up."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import replace
from functools import cache
from math import pi
from typing import Any

import numpy as np
import pytest

import equipoise as eq
from equipoise.mechanism.parts.bodies import Body
from equipoise.mechanism.parts.motors import Motor
from equipoise.mechanism.parts.support import Gauge, Mount, Row, Support, unit_vector
from equipoise.signals import Periodic
from equipoise.vibration.exact import solve_exact
from equipoise.vibration.forced import respond
from equipoise.vibration.linear import Linear
from equipoise.vibration.response import MODELS, ExcitationModel, Response
from equipoise.vibration.simplified import linear_of
from laws.transforms import mirrored_in_x, shifted
from support.chosen import EXHAUSTIVE, few, few_together
from support.machines import make
from unit.vibration.build import STIFFNESS, Array, cart, close, rig, springs

KINDS = ("crank_rocker", "slider_crank", "stephenson", "watt", "quick_return", "scotch_yoke")
EXAMPLES = ("yamashita-1", "slider-crank-engine", "watt-six-bar", "stephenson-six-bar")
ROWS = (
    (),
    (Row(phase=0.7), Row(phase=2.9, offset=(0.1, -0.2))),
    (Row(), Row(phase=2 * pi / 3), Row(phase=4 * pi / 3, offset=(0.05, 0.0), lateral=0.3)),
)
every_model = pytest.mark.parametrize("model", MODELS)


def load_free(machine: eq.Machine) -> eq.Machine:
    return replace(machine, loads=(), planting=None)


def supported(
    machine: eq.Machine,
    seed: int,
    pivoted: bool = False,
    rows: Iterable[Row] = (),
    heavy: float = 10.0,
) -> eq.Machine:
    """Put a machine on a support some times as heavy, with natural frequencies near its speed.

    Feet push against gravity, whichever way it points; a third mount holds across it.
    """
    rng = np.random.default_rng([seed, 77])
    machine = machine.with_rows(rows)
    centers = eq.move(machine, 90).mass_centers
    places = np.concatenate([center.place for center in centers.values()])
    middle, size = complex(np.mean(places)), float(np.ptp(places.real) + np.ptp(places.imag))
    mass = sum(link.mass or 0.0 for link in machine.links.values())
    mass *= heavy * max(1, len(machine.rows))
    stiffness = mass * (machine.drive.speed * rng.uniform(0.5, 0.9)) ** 2
    damping = 2 * 0.2 * np.sqrt(stiffness * mass)
    up = -complex(*machine.gravity)
    up = up / abs(up) if up else 1j

    def at(along: float, high: float) -> tuple[float, float, float]:
        place = middle + size * (along * up / 1j + high * up)
        return place.real, place.imag, 0.0

    def mount(place: tuple[float, float, float], way: complex, share: float) -> Mount:
        return Mount(place, (way.real, way.imag, 0.0), stiffness * share, damping * share)

    mounts = {
        "left": mount(at(-0.8, -0.6), up, 0.6),
        "right": mount(at(0.9, -0.5), up, 0.4),
        "across": mount(at(0.4, -0.2), up / 1j, 0.8),
    }
    pivot = at(-1.1, -0.1)[:2] if pivoted else None
    if pivoted:
        mounts = {"right": mounts["right"]}
    gauges = {"tip": Gauge(at(0.5, 0.8), (0.6, 0.8, 0.0)), "turn": Gauge(axis="pitch")}
    support = Support(
        mass, at(0.1, -0.3), (mass * size**2 * 0.4,), pivot=pivot, mounts=mounts, gauges=gauges
    )
    return replace(machine, support=support)


@cache
def random_machine(kind: str, seed: int) -> eq.Machine:
    return load_free(make(kind, seed).machine if kind in KINDS else eq.load(kind))


subjects = pytest.mark.parametrize(
    ("kind", "seed"),
    [*((kind, seed) for kind in KINDS for seed in (1, 2)), *((name, 0) for name in EXAMPLES)],
)


# -- energy ----------------------------------------------------------------------------------------


def balanced(result: Response) -> None:
    """Work put in over a period is what mounts and nothing else take.

    1e-8 of it: the mesh is refined to a residual of 1e-11, and work at the crank may be a small
    difference of what goes in and out by turns.
    """
    assert result.energy is not None
    assert result.energy.lost > 0
    assert result.energy.fed_in == pytest.approx(result.energy.lost, rel=1e-8)


@subjects
@pytest.mark.parametrize("pivoted", [False, True], ids=["free", "pivot"])
def test_energy_put_in_is_lost_in_the_mounts(kind: str, seed: int, pivoted: bool) -> None:
    machine = supported(random_machine(kind, seed), seed, pivoted, ROWS[seed % 3])
    balanced(respond(machine, model="exact"))


# The work of a mount that lifts off is integrated in tests/secondroute/test_vibration.py.
@EXHAUSTIVE
@pytest.mark.parametrize("pivoted", few([False, True], {False}), ids=["free", "pivot"])
def test_energy_with_a_mount_that_lifts_off(pivoted: bool) -> None:
    """A light body on stiff one-sided feet, shaken harder than it is heavy."""
    machine = supported(eq.load("yamashita-1"), 0, pivoted, heavy=1.2)
    assert machine.support is not None
    feet = {
        name: replace(
            mount,
            one_sided=name != "across",
            stiffness=8 * mount.stiffness,
            damping=3 * mount.damping,
        )
        for name, mount in machine.support.mounts.items()
    }
    response = respond(machine.with_support(mounts=feet), 25.0, "exact")
    assert response.stable
    assert max(mount.lifts_off for mount in response.mounts.values()) > 0.2
    balanced(response)


@pytest.mark.parametrize("pivoted", [False, True], ids=["free", "pivot"])
@pytest.mark.parametrize("rows", ROWS[:2], ids=["one", "two"])
def test_energy_with_loads(pivoted: bool, rows: tuple[Row, ...]) -> None:
    """What loads take or give, on the moving support, counts as fed in."""
    loads = (
        eq.Load("coupler", "P", (-4.0, 9.0), start=0.4, stop=3.0),
        eq.Load("rocker", torque=-0.3),
    )
    machine = replace(supported(eq.load("yamashita-1"), 3, pivoted, rows), loads=loads)
    balanced(respond(machine, model="exact"))


@pytest.mark.parametrize("seed", [0, 1, 2])
@pytest.mark.parametrize("mean_speed", ["held", "free"])
@pytest.mark.parametrize("sense", [1, -1])
def test_energy_with_a_motor(seed: int, mean_speed: str, sense: int) -> None:
    motor = Motor(60.0, 9.0, ratio=2.5, inertia=1e-3, mean_speed=mean_speed)  # type: ignore[arg-type]
    machine = supported(eq.load("yamashita-1"), seed, seed == 1, ROWS[seed])
    machine = machine.with_drive(motor=motor, flywheel=0.03, speed=sense * 20.0)
    response = respond(machine, drive=True)
    assert response.drive.fluctuation > 1e-3
    assert np.sign(response.speed) == sense
    if mean_speed == "held":
        assert response.speed == pytest.approx(sense * 20, rel=1e-12)
    balanced(response)


def test_mean_torque_of_the_motor_pays_for_the_mounts() -> None:
    """At constant speed the work of a turn is 2 pi times the mean torque of the drive."""
    response = respond(supported(eq.load("yamashita-1"), 1), model="exact")
    assert response.energy is not None
    assert response.drive.torque.mean * 2 * pi == pytest.approx(response.energy.lost, rel=1e-8)


# -- limits ----------------------------------------------------------------------------------------


@pytest.mark.parametrize("pivoted", [False, True], ids=["free", "pivot"])
@pytest.mark.parametrize(
    "name", few(["yamashita-1", "watt-six-bar", "slider-crank-engine"], {"slider-crank-engine"})
)
def test_a_heavy_support_feels_the_whole_moment_of_one_at_rest(name: str, pivoted: bool) -> None:
    """With the natural frequencies kept, what exact and linear differ by falls as mass grows.

    Each ten times as heavy leaves a tenth of the difference, beside the response itself, until
    1e-9 of the response is the solver's own residual.
    """
    away = []
    for heavy in (1e2, 1e3, 1e4, 1e5):
        machine = supported(load_free(eq.load(name)), 4, pivoted, ROWS[1], heavy)
        signals = [
            respond(machine, model=model).gauges["tip"].displacement
            for model in ("exact", "moment")
        ]
        apart = signals[0] - signals[1]
        away.append(float(apart.rms / signals[1].vibration_rms))
    assert away[0] < 0.1
    ratios = np.array(away[:-1]) / np.array(away[1:])
    for ratio, tolerance in zip(ratios, (0.15, 0.015, 0.002), strict=True):
        assert ratio == pytest.approx(10, rel=tolerance)


@pytest.mark.parametrize(("damping_ratio", "speed"), [(0.01, 20.0), (0.05, -33.0), (0.3, 9.0)])
def test_multipliers_of_a_machine_of_next_to_no_mass(damping_ratio: float, speed: float) -> None:
    """The support swings by itself: exp(2 pi w (-D +- i sqrt(1 - D^2)) / speed)."""
    machine = rig()
    for link in machine.links:
        machine = machine.with_link(link, mass=1e-5, inertia=1e-8)
    inertia = 4.9854488 + 25 * 0.75**2
    natural = np.sqrt(STIFFNESS / inertia)
    damping = 2 * damping_ratio * natural * inertia
    spring = Mount(axis="pitch", torsional_stiffness=STIFFNESS, torsional_damping=damping)
    machine = machine.with_support(mounts={"spring": spring})
    root = natural * complex(-damping_ratio, np.sqrt(1 - damping_ratio**2))
    wanted = np.exp(2 * pi * root / abs(speed))
    for model in ("coupled", "exact"):
        multipliers = respond(machine, speed, model).multipliers  # type: ignore[arg-type]
        assert multipliers is not None
        # The links, 3e-6 of the support's inertia, slow it down by half as much over a few rad.
        np.testing.assert_allclose(np.abs(multipliers), abs(wanted), rtol=1e-4)
        assert multipliers[0].real == pytest.approx(wanted.real, abs=1e-4)


def test_multipliers_of_damping_multiply_to_what_damping_takes() -> None:
    """Their product is exp of minus the damping's trace over a turn, on a support that is heavy."""
    machine = supported(load_free(eq.load("yamashita-1")), 5, heavy=1e6)
    linear = Linear.of(machine)
    trace = float(np.trace(np.linalg.solve(linear.mass, linear.damping)))
    multipliers = respond(machine, model="exact").multipliers
    assert multipliers is not None
    wanted = np.exp(-trace * 2 * pi / machine.drive.speed)
    assert np.prod(multipliers).real == pytest.approx(wanted, rel=1e-5)


# -- phases ----------------------------------------------------------------------------------------


def same_response(result: Response, wanted: Response, tolerance: float = 1e-9) -> None:
    """Compare gauges, mounts and torque, each beside its own size."""
    theta = np.linspace(0, wanted.turns * 2 * pi, 60)
    assert result.turns == wanted.turns
    for name, gauge in wanted.gauges.items():
        for quantity in ("displacement", "velocity", "acceleration"):
            first, other = (
                getattr(r, quantity).values(theta) for r in (result.gauges[name], gauge)
            )
            close(first, other, tolerance)
    for name, mount in wanted.mounts.items():
        close(result.mounts[name].force.values(theta), mount.force.values(theta), tolerance)
    close(result.drive.torque.values(theta), wanted.drive.torque.values(theta), tolerance)


@pytest.mark.exhaustive(but=["coupled"])
@every_model
def test_a_phase_of_a_full_turn_changes_nothing(model: ExcitationModel) -> None:
    machine = springs().with_rows([Row(), Row(phase=1.0)])
    around = springs().with_rows([Row(phase=2 * pi), Row(phase=1.0 - 4 * pi)])
    same_response(respond(around, model=model), respond(machine, model=model))


@every_model
def test_a_phase_that_all_rows_share_is_only_seen_from_elsewhere(model: ExcitationModel) -> None:
    machine = springs().with_rows([Row(), Row(phase=1.0)])
    ahead = springs().with_rows([Row(phase=0.8), Row(phase=1.8)])
    wanted, actual = (respond(m, model=model).gauges["seat"].displacement for m in (machine, ahead))
    theta = np.linspace(0, 6, 40)
    close(actual.values(theta), wanted.shifted(0.8).values(theta), 1e-9)


@every_model
def test_order_of_the_rows_changes_nothing(model: ExcitationModel) -> None:
    rows = [Row(), Row(phase=1.0, offset=(0.2, 0.0)), Row(phase=-2.0, lateral=1.0)]
    there, back = (springs().with_rows(order) for order in (rows, rows[::-1]))
    same_response(respond(there, model=model), respond(back, model=model))


def odd_and_even(signal: Periodic) -> tuple[float, float]:
    """Return the largest amplitude of odd and of even orders, the mean left out."""
    sizes = signal.sizes
    return float(np.max(sizes[1::2], initial=0.0)), float(np.max(sizes[2::2], initial=0.0))


@pytest.mark.parametrize("model", ["linear", "torque", "moment", "coupled"])
@pytest.mark.parametrize("machine", [rig(), springs()], ids=["pivot", "free"])
def test_a_row_in_opposite_phase_takes_odd_orders_away(
    machine: eq.Machine, model: ExcitationModel
) -> None:
    """The coefficients of (54) then have even orders only, too."""
    two = machine.with_rows([Row(), Row(phase=pi)])
    for gauge in respond(two, model=model).gauges.values():
        odd, even = odd_and_even(gauge.displacement)
        assert odd < 1e-10 * even


def test_a_row_in_opposite_phase_takes_odd_orders_away_exactly() -> None:
    """Half a turn later the machine is the same, with its rows changed round: so is its motion."""
    response = respond(springs().with_rows([Row(), Row(phase=pi)]), model="exact")
    for gauge in response.gauges.values():
        odd, even = odd_and_even(gauge.displacement)
        assert odd < 1e-9 * even


def test_rows_apart_exchange_heave_for_roll() -> None:
    """Two rows in opposite phase, on either side: even orders heave, odd orders roll and yaw."""
    mounts = {
        f"{x:+g} {z:+g}": Mount((x, -0.2, z), stiffness=8e3, damping=50.0)
        for x in (-0.5, 0.5)
        for z in (-0.4, 0.4)
    }
    mounts["along"] = Mount((0.0, 0.0, 0.0), direction=0.0, stiffness=3e4, damping=90.0)
    mounts["across"] = Mount((0.0, 0.0, 0.0), (0.0, 0.0, 1.0), stiffness=3e4, damping=90.0)
    mounts["yaw"] = Mount(axis="yaw", torsional_stiffness=4e3, torsional_damping=30.0)
    rows = [Row(lateral=-0.25), Row(phase=pi, lateral=0.25)]
    level = cart(mounts=mounts, gauges={}, products=(), center_of_mass=(0.0, 0.1, 0.0))
    gauges = respond(level.with_rows(rows), 18.0).gauges
    for name in ("surge", "heave", "pitch"):
        odd, even = odd_and_even(gauges[name].displacement)
        assert odd < 1e-10 * even
    for name in ("sway", "roll", "yaw"):
        odd, even = odd_and_even(gauges[name].displacement)
        assert even < 1e-10 * odd
        assert odd > 1e-5
    # In phase they neither roll nor yaw at all.
    gauges = respond(level.with_rows([Row(lateral=-0.25), Row(lateral=0.25)]), 18.0).gauges
    assert gauges["roll"].displacement.peak_to_peak < 1e-12
    assert gauges["heave"].displacement.peak_to_peak > 1e-4


@pytest.mark.parametrize("aside", [0.0, 0.1])
def test_masses_in_two_planes_are_two_rows_there(aside: float) -> None:
    """Half of the mass of each link on either side, or two linkages of half the mass there."""
    z, level = 0.23, cart()
    first, half = {}, {}
    for name, link in level.links.items():
        part = {"mass": link.mass / 2, "inertia": link.inertia / 2}
        places = (z - aside, z + aside)
        parts = [Body("point", at=link.center_of_mass, plane=at, **part) for at in places]
        first[name] = link.altered(bodies=tuple(parts), plane=z)
        half[name] = link.altered(**part)
    rows = [Row(lateral=z - aside), Row(lateral=z + aside)]
    gauges = respond(replace(level, links=first), 18.0, "moment").gauges
    wanted = respond(replace(level, links=half).with_rows(rows), 18.0, "moment").gauges
    for name, want in wanted.items():
        difference = gauges[name].displacement.amplitudes - want.displacement.amplitudes
        assert np.max(np.abs(difference)) < 1e-10 * want.displacement.peak_to_peak


# -- the same described otherwise ------------------------------------------------------------------


Map = Callable[[tuple[float, ...]], tuple[float, ...]]


def mapped(support: Support, place: Map, along: Map = tuple) -> Support:
    """The support with all of its places and directions told otherwise."""

    def item(entry: Any) -> Any:
        if entry.point is None:
            return entry
        return replace(
            entry, point=place(entry.point), direction=along(unit_vector(entry.direction))
        )

    return replace(
        support,
        center_of_mass=place(support.center_of_mass),
        pivot=None if support.pivot is None else place(support.pivot),
        mounts={name: item(mount) for name, mount in support.mounts.items()},
        gauges={name: item(gauge) for name, gauge in support.gauges.items()},
    )


def mirrored(machine: eq.Machine) -> eq.Machine:
    """The image in the x axis, support, rows and all."""

    def flipped(vector: tuple[float, ...]) -> tuple[float, ...]:
        return (vector[0], -vector[1], *vector[2:])

    assert machine.support is not None
    return replace(
        mirrored_in_x(replace(machine, support=None, rows=())),
        rows=tuple(Row(-row.phase, row.lateral, flipped(row.offset)) for row in machine.rows),
        support=mapped(machine.support, flipped, flipped),
    )


def image(signal: Periodic, rotation: bool) -> Array:
    """Amplitudes of what the mirrored machine reads: crank angle and rotations change sign."""
    turned = np.conj(signal.amplitudes)
    return -turned if rotation else turned


@pytest.mark.exhaustive(but=["watt-5-free-coupled", "watt-5-pivot-linear", "watt-5-free-moment"])
@every_model
@pytest.mark.parametrize("pivoted", [False, True], ids=["free", "pivot"])
@pytest.mark.parametrize(
    ("kind", "seed"),
    few_together([("crank_rocker", 3), ("watt", 5), ("yamashita-1", 0)], {("watt", 5)}),
)
def test_mirror_image(kind: str, seed: int, pivoted: bool, model: ExcitationModel) -> None:
    machine = supported(random_machine(kind, seed), seed, pivoted, ROWS[1])
    actual, wanted = respond(mirrored(machine), model=model), respond(machine, model=model)
    assert actual.speed == -wanted.speed
    theta = np.linspace(0, 6, 40)
    for name, gauge in wanted.gauges.items():
        for quantity, sign in (("displacement", 1), ("velocity", 1), ("acceleration", 1)):
            first = getattr(actual.gauges[name], quantity).values(theta)
            other = getattr(gauge, quantity)
            other = Periodic(sign * image(other, gauge.rotation), wanted.turns).values(theta)
            close(first, other, 1e-8)
    for name, mount in wanted.mounts.items():
        other = Periodic(image(mount.force, mount.torsional), wanted.turns).values(theta)
        close(actual.mounts[name].force.values(theta), other, 1e-8)
    torque = Periodic(image(wanted.drive.torque, True), wanted.turns).values(theta)
    close(actual.drive.torque.values(theta), torque, 1e-7)


def test_mirror_image_with_a_motor() -> None:
    motor = Motor(60.0, 9.0, ratio=2.5, inertia=1e-3)
    machine = supported(load_free(eq.load("yamashita-1")), 2, rows=ROWS[1])
    machine = machine.with_drive(motor=motor, flywheel=0.03)
    actual, wanted = respond(mirrored(machine), drive=True), respond(machine, drive=True)
    theta = np.linspace(0, 6, 40)
    assert actual.drive.shift == pytest.approx(wanted.drive.shift, rel=1e-8)
    assert actual.drive.speed is not None and wanted.drive.speed is not None
    speed = Periodic(image(wanted.drive.speed, True), 1).values(theta)
    close(actual.drive.speed.values(theta), speed, 1e-8)
    for name, gauge in wanted.gauges.items():
        other = Periodic(image(gauge.displacement, gauge.rotation), 1).values(theta)
        close(actual.gauges[name].displacement.values(theta), other, 1e-8)


def moved(machine: eq.Machine, shift: complex) -> eq.Machine:
    """The machine with its support, told from another origin."""

    def away(place: tuple[float, ...]) -> tuple[float, ...]:
        return (place[0] + shift.real, place[1] + shift.imag, *place[2:])

    assert machine.support is not None
    return replace(shifted(machine, shift), support=mapped(machine.support, away))


@pytest.mark.exhaustive(but=["free-coupled", "pivot-exact", "free-moment", "pivot-linear"])
@every_model
@pytest.mark.parametrize("machine", [rig(), springs()], ids=["pivot", "free"])
def test_moving_the_origin_of_the_frame(machine: eq.Machine, model: ExcitationModel) -> None:
    machine = machine.with_rows(ROWS[1])
    there = moved(machine, 3.0 - 2.0j)
    same_response(respond(there, model=model), respond(machine, model=model))


def test_moving_the_origin_in_space() -> None:
    machine = cart().with_rows(ROWS[2])
    same_response(respond(moved(machine, -1.0 + 4.0j)), respond(machine))


@every_model
def test_a_support_in_space_that_moves_in_the_plane_only(model: ExcitationModel) -> None:
    """Three moments of inertia, and mounts out of the plane, change nothing then."""
    flat = springs().with_rows(ROWS[2])
    assert flat.support is not None
    deep = flat.with_support(
        inertia=(1.1, 1.6, 1.8), products=(0.1, 0.2, -0.1), freedoms=("pitch", "surge", "heave"),
        mounts={n: replace(m, point=(*(m.point or ())[:2], 0.4))
                for n, m in flat.support.mounts.items()},
    )  # fmt: skip
    same_response(respond(deep, model=model), respond(flat, model=model))


# Scales of everything: tests/laws/test_scaling.py.
@pytest.mark.exhaustive
@every_model
@pytest.mark.parametrize("machine", [rig(), springs()], ids=["pivot", "free"])
def test_everything_faster(machine: eq.Machine, model: ExcitationModel) -> None:
    """Twice the speed, 4 times stiffness and gravity, twice the damping: the same motion."""
    assert machine.support is not None
    mounts = {
        name: replace(
            mount,
            stiffness=4 * mount.stiffness,
            damping=2 * mount.damping,
            torsional_stiffness=4 * mount.torsional_stiffness,
            torsional_damping=2 * mount.torsional_damping,
        )
        for name, mount in machine.support.mounts.items()
    }
    gx, gy = machine.gravity
    fast = replace(machine.with_support(mounts=mounts), gravity=(4 * gx, 4 * gy))
    actual, wanted = (respond(m, speed, model) for m, speed in ((fast, 34.0), (machine, 17.0)))
    theta = np.linspace(0, 6, 40)
    for name, gauge in wanted.gauges.items():
        other = actual.gauges[name]
        close(other.displacement.values(theta), gauge.displacement.values(theta), 1e-9)
        close(other.acceleration.values(theta), 4 * gauge.acceleration.values(theta), 1e-8)
    for name, mount in wanted.mounts.items():
        close(actual.mounts[name].force.values(theta), 4 * mount.force.values(theta), 1e-9)
    close(actual.drive.torque.values(theta), 4 * wanted.drive.torque.values(theta), 1e-8)


# -- what adds up ----------------------------------------------------------------------------------


@pytest.mark.parametrize("model", ["linear", "torque", "moment"])
def test_mounts_carry_what_momentum_asks_for(model: ExcitationModel) -> None:
    """In space: force of the mounts, of the linkages and of all weights is mass times acceleration.

    Rotation moves the common centre of mass, wherever it is.
    """
    machine = cart().with_rows(ROWS[2])
    linear = linear_of(machine, model)
    actual, speed = respond(machine, 17.0, model), 17.0
    theta = np.linspace(0, 6, 40)
    support = machine.support
    assert support is not None
    force = linear.excitation.at(speed).values(theta)[:3]
    force = force + sum(weight for weight, _ in linear.excitation.weights)[:, None]
    for name, mount in support.mounts.items():
        if mount.point is not None:
            along = np.array(unit_vector(mount.direction))
            force = force + along[:, None] * actual.mounts[name].force.values(theta)
    change = (linear.motion(speed).derivative(2) * speed**2).values(theta)
    close(force, (linear.mass @ change)[:3], 1e-10)


@pytest.mark.parametrize("model", ["linear", "torque", "moment"])
def test_forces_of_the_rows_add_up(model: ExcitationModel) -> None:
    """What two rows do to the support is the sum of what each does alone."""
    machine = springs()
    rows = [Row(), Row(phase=1.3, offset=(0.2, 0.1))]
    both = linear_of(machine.with_rows(rows), model)
    alone = [linear_of(machine.with_rows([row]), model).excitation.at(17.0) for row in rows]
    theta = np.linspace(0, 6, 40)
    wanted = alone[0] + alone[1]
    close(both.excitation.at(17.0).values(theta), wanted.values(theta), 1e-12)


@pytest.mark.parametrize("model", ["linear", "torque", "moment", "coupled", "exact"])
def test_twice_the_mass_of_everything(model: ExcitationModel) -> None:
    """Masses, stiffness and damping all twice: the same motion with forces twice as large."""
    machine = springs()
    support = machine.support
    assert support is not None
    double = machine.with_support(
        mass=2 * support.mass,
        inertia=(2 * support.inertia[0],),
        mounts={
            name: replace(mount, stiffness=2 * mount.stiffness, damping=2 * mount.damping)
            for name, mount in support.mounts.items()
        },
    )
    for name, link in machine.links.items():
        double = double.with_link(name, mass=2 * (link.mass or 0), inertia=2 * (link.inertia or 0))
    actual, wanted = respond(double, model=model), respond(machine, model=model)
    theta = np.linspace(0, 6, 40)
    for name, gauge in wanted.gauges.items():
        close(
            actual.gauges[name].displacement.values(theta), gauge.displacement.values(theta), 1e-9
        )
    for name, mount in wanted.mounts.items():
        close(actual.mounts[name].force.values(theta), 2 * mount.force.values(theta), 1e-9)


def test_without_gravity_a_level_rig_shakes_alike() -> None:
    """(59): weight only loads the springs, on a body level with its pivot."""
    weightless = replace(rig(), gravity=(0.0, 0.0))
    actual, wanted = (
        respond(m, model="linear").gauges["gauge"].displacement for m in (weightless, rig())
    )
    close(actual.amplitudes, wanted.amplitudes, 1e-12)
    still = respond(weightless, model="linear").mounts["spring"].force.mean
    assert abs(still) < 1e-9 < float(respond(rig(), model="linear").mounts["spring"].force.mean)


def test_in_free_fall_the_common_centre_of_mass_stays() -> None:
    """Without mounts or gravity: support and links swing about a point that does not move.

    Followed from rest at a constant crank speed, momentum stays what it was in the beginning.
    """
    nothing = {"nothing": Mount((0.0, 0.0, 0.0), damping=1e-12, preload=0.0)}
    machine = replace(springs(mounts=nothing), gravity=(0.0, 0.0)).with_rows(ROWS[1])
    simulation = eq.simulate(machine, 0.6, samples=61)
    place, rate = simulation.system.place_and_rate(simulation.states)
    s = simulation.system.sums(simulation.crank_angle)
    turn = np.exp(1j * place[2])
    first = turn * (s.first + simulation.system.first)
    momentum = (simulation.system.mass + s.mass) * (rate[0] + 1j * rate[1])
    momentum = momentum + 1j * rate[2] * first + simulation.crank_speed * turn * s.first_1
    size = float(np.max(np.abs(simulation.crank_speed * s.first_1)))
    # 1e-9 by the integration, 1e-9 by splines through the linkages' sums.
    np.testing.assert_allclose(momentum, momentum[0], rtol=0, atol=1e-8 * size)


def test_solution_does_not_depend_on_where_it_starts() -> None:
    """From rest, from the linear response or from another speed: the same to the residual."""
    machine = springs()
    wanted = solve_exact(machine, 17.0, False)
    other = solve_exact(machine, 21.0, False)
    solution = solve_exact(machine, 17.0, False, other.steady.orbit.at)
    close(solution.states, wanted.states, 1e-9)
