"""Cases so simple that the answer can be written down."""

from __future__ import annotations

from dataclasses import replace
from math import asin, pi, sqrt

import numpy as np
import pytest

import equipoise as eq
from equipoise.mechanism.parts.machine import FRAME
from support.conformance import compared
from support.refusals import refused
from support.sources import CLOSED_FORMS

G = 9.80665
THETA = 2 * pi * np.arange(48) / 48
SPEED, ACCELERATION = -11.0, 37.0
ORIGIN = (0.0, 0.0)


def link(mass: float = 0.0, center: tuple[float, float] = ORIGIN, inertia: float = 0.0,
         **points: tuple[float, float]) -> eq.Link:  # fmt: skip
    return eq.Link(points, mass, center, inertia)


def near(got: object, want: object, scale: float = 1.0, tolerance: float = 1e-12) -> None:
    np.testing.assert_allclose(got, want, rtol=0, atol=tolerance * scale)


def forces(machine: eq.Machine, angles: object = 48) -> eq.mechanism.Forces:
    return eq.analyze(machine, angles, SPEED, ACCELERATION).forces  # type: ignore[arg-type]


# -- one link --------------------------------------------------------------------------------------


def lone_crank(mass: float, radius: float, inertia: float = 2e-3) -> eq.Machine:
    crank = link(mass, (radius, 0.0), inertia, A=ORIGIN)
    return eq.Machine("crank", eq.Drive("crank", 1.0), {"A": (0.2, 0.1)}, {"crank": crank})


def test_balanced_crank_does_not_shake() -> None:
    result = forces(lone_crank(3.0, 0.0))
    assert not np.any(result.shaking_force.size)
    near(result.shaking_moment, -2e-3 * ACCELERATION)
    near(result.drive_torque, 2e-3 * ACCELERATION)
    near(result.joints["A"].value, 3j * G)


@compared(CLOSED_FORMS, "forces, moment and torque: m r w^2, m r E", 1e-12, "unbalanced crank")
def test_unbalanced_crank() -> None:
    """Centrifugal force m r w^2 outwards, m r E against the acceleration."""
    result = forces(lone_crank(3.0, 0.05))
    outwards = np.exp(1j * THETA)
    shaking = 3 * 0.05 * (SPEED**2 - 1j * ACCELERATION) * outwards
    near(result.shaking_force.value, shaking)
    near(result.joints["A"].value, 3j * G - shaking)
    near(result.frame_force.value, shaking - 3j * G)
    inertia = 2e-3 + 3 * 0.05**2
    near(result.drive_torque, inertia * ACCELERATION + 3 * G * 0.05 * np.cos(THETA))
    near(result.shaking_moment, -inertia * ACCELERATION)


def test_torque_against_a_hanging_load() -> None:
    machine = replace(lone_crank(0.0, 0.0, 0.0), loads=(eq.Load("crank", torque=-4.0),))
    near(forces(machine).drive_torque, 4.0)


# -- slider-cranks ---------------------------------------------------------------------------------


def slider_crank(rod: float, piston: float = 2.0, radius: float = 0.03) -> eq.Machine:
    """Only the piston has mass."""
    return eq.Machine(
        "slider-crank",
        eq.Drive("crank", 1.0),
        {"A": ORIGIN},
        {
            "crank": link(A=ORIGIN, B=(radius, 0.0)),
            "rod": link(B=ORIGIN, C=(rod, 0.0)),
            "piston": link(piston, C=ORIGIN),
        },
        {"C": "forward"},
        (eq.Slider("piston", "C", FRAME, "A", 0.0),),
    )


@compared(CLOSED_FORMS, "shaking force: a cosine", 2e-06, "slider-crank, endless rod")
def test_endless_rod_gives_a_cosine() -> None:
    values = forces(slider_crank(3e4)).at(acceleration=0.0)
    first = 2.0 * 0.03 * SPEED**2
    near(values.shaking_force.x, first * np.cos(THETA), first, 2e-6)
    near(values.shaking_force.y, 0.0)


@compared(
    CLOSED_FORMS,
    "orders 1 to 6 of the shaking force by their series",
    0.2**7,
    "slider-crank, crank over rod 1/5",
)
def test_finite_rod_gives_even_harmonics() -> None:
    """Series of the crank mechanism in powers of crank over rod."""
    s = 0.2
    values = forces(slider_crank(0.03 / s), 64).at(acceleration=0.0)
    amplitudes = eq.signals.harmonics(values.shaking_force.x) / (2.0 * 0.03 * SPEED**2)
    series = {1: 1.0, 2: s + s**3 / 4 + 15 * s**5 / 128, 4: -(s**3) / 4 - 3 * s**5 / 16,
              6: 9 * s**5 / 128}  # fmt: skip
    for order in range(7):
        near(amplitudes[order], series.get(order, 0.0), tolerance=s**7)


@compared(
    CLOSED_FORMS, "place and acceleration at the dead centres: r (1 + r / l)", 1e-12, "slider-crank"
)
def test_piston_at_its_dead_centres() -> None:
    r, rod = 0.03, 0.11
    motion = eq.move(slider_crank(rod), [0.0, pi], 1.0)
    near(motion.points["C"].place, [r + rod, rod - r])
    near(motion.points["C"].vx, 0.0)
    near(motion.points["C"].ax, [-r * (1 + r / rod), r * (1 - r / rod)])


@compared(CLOSED_FORMS, "torque and side force of a gas force", 1e-12, "slider-crank")
def test_gas_force_on_the_crank() -> None:
    """Torque from the piston force by the triangle of crank and rod."""
    r, rod, gas = 0.03, 0.11, -500.0
    load = eq.Load("piston", "C", force=(gas, 0.0))
    result = forces(replace(slider_crank(rod, 0.0), loads=(load,)))
    sine = r * np.sin(THETA) / rod
    cosine = np.sqrt(1 - sine**2)
    slope = -r * np.sin(THETA) * (1 + r * np.cos(THETA) / (rod * cosine))
    near(result.drive_torque, -gas * slope, 15.0)
    near(result.joints["piston on frame"].normal, -gas * sine / cosine, 500.0)
    near(result.frame_force.value, gas, 500.0)
    near(result.split.frame_force.sum(axis=(0, 1)), gas, 500.0)
    inner = forces(replace(slider_crank(rod, 0.0), loads=(replace(load, reaction="frame"),)))
    near(inner.drive_torque, result.drive_torque, 15.0)
    near(inner.joints["piston on frame"].value, result.joints["piston on frame"].value, 500.0)
    near(inner.frame_force.value, 0.0, 500.0)
    near(inner.split.frame_force.sum(axis=(0, 1)), 0.0, 500.0)
    near(inner.frame_moment, 0.0, 15.0)


# -- sines and straight lines ----------------------------------------------------------------------


@compared(CLOSED_FORMS, "shaking force: a sine", 1e-14, "scotch-yoke")
def test_scotch_yoke_is_an_exact_sine() -> None:
    machine = eq.load("scotch-yoke")
    values = forces(machine).at(acceleration=0.0)
    near(values.motion.points["Y"].place, 0.03 * np.cos(THETA), tolerance=1e-16)
    near(values.motion.points["Y"].place_2, -0.03 * np.cos(THETA), tolerance=1e-16)
    amplitudes = np.abs(eq.signals.harmonics(values.shaking_force.value.real))
    assert np.argmax(amplitudes) == 1
    near(np.delete(amplitudes, 1), 0.0, amplitudes[1], 1e-14)


def carrier_with(planet: eq.Link, *gears: eq.Gear, idler: bool = True) -> eq.Machine:
    """Planet at C, 0.1 m from the carrier's axis, idler half-way."""
    links = {"carrier": link(0.5, ORIGIN, 1e-3, A=ORIGIN, B=(0.05, 0.0), C=(0.1, 0.0))}
    if idler:
        links["idler"] = link(B=ORIGIN)
    links["planet"] = planet
    drive = eq.Drive("carrier", 1.0)
    return eq.Machine("planetary", drive, {"A": ORIGIN}, links, gears=gears)


@compared(CLOSED_FORMS, "path, shaking force: circles", 1e-12, "planet that keeps its direction")
def test_planet_that_keeps_its_direction_moves_in_a_circle() -> None:
    gears = (
        eq.Gear(FRAME, "idler", teeth=(40, 20), carrier="carrier"),
        eq.Gear("idler", "planet", teeth=(20, 40), carrier="carrier", start=0.3),
    )
    planet = link(2.0, (0.03, 0.04), 5e-3, C=ORIGIN, P=(0.2, -0.1))
    result = forces(carrier_with(planet, *gears))
    motion = result.motion
    near(motion.links["planet"].angle, 0.3)
    near(motion.links["planet"].angular_velocity, 0.0)
    circle = motion.points["P"].place - (0.2 - 0.1j) * np.exp(0.3j)
    near(circle, 0.1 * np.exp(1j * THETA))
    outwards = 2.0 * 0.1 * (SPEED**2 - 1j * ACCELERATION) * np.exp(1j * THETA)
    near(result.shaking_force.value, outwards, 20.0)


@compared(CLOSED_FORMS, "path: a straight line, an ellipse", 1e-12, "Cardan circles")
@pytest.mark.parametrize("start", [0.0, 1.1])
def test_cardan_circles_draw_a_straight_line(start: float) -> None:
    """A point on the pitch circle of a planet half as large as its ring runs through the centre."""
    gear = eq.Gear(FRAME, "planet", teeth=(40, 20), mesh="internal", carrier="carrier", start=start)
    planet = link(C=ORIGIN, P=(0.1, 0.0), Q=(0.04, 0.0))
    motion = eq.move(carrier_with(planet, gear, idler=False), 48)
    near(motion.links["planet"].angle_1, -1.0)
    line = motion.points["P"].place * np.exp(-0.5j * start)
    near(line, 0.2 * np.cos(THETA - start / 2))
    ellipse = motion.points["Q"].place * np.exp(-0.5j * start)
    near(ellipse, 0.14 * np.cos(THETA - start / 2) + 0.06j * np.sin(THETA - start / 2))


@compared(CLOSED_FORMS, "shaking force along one axis: none", 1e-12, "contra-rotating weights")
@pytest.mark.parametrize(("start", "axis"), [(0.0, "y"), (pi, "x")])
def test_contra_rotating_weights_cancel_along_one_axis(start: float, axis: str) -> None:
    crank = link(2.0, (0.05, 0.0), 1e-3, A=ORIGIN)
    weight = link(1.0, (0.1, 0.0), 1e-3, E=ORIGIN)
    machine = eq.Machine(
        "balancer", eq.Drive("crank", 1.0), {"A": ORIGIN, "E": (0.3, 0.0)},
        {"crank": crank, "weight": weight},
        gears=(eq.Gear("crank", "weight", ratio=-1.0, start=start),),
    )  # fmt: skip
    shaking = forces(machine).shaking_force
    size = 2.0 * 0.05 * sqrt(SPEED**4 + ACCELERATION**2)
    near(getattr(shaking, axis), 0.0, size)
    assert np.max(np.abs(shaking.x + shaking.y)) == pytest.approx(2 * size, rel=0.01)


# -- four-bars -------------------------------------------------------------------------------------


def four_bar(a: float, b: float, c: float, d: float, side: str = "left") -> eq.Machine:
    """Lengths of frame, crank, coupler and rocker."""
    return eq.Machine(
        "four-bar",
        eq.Drive("crank", 1.0),
        {"A": ORIGIN, "D": (a, 0.0)},
        {
            "crank": link(0.3, (0.2, 0.01), 1e-3, A=ORIGIN, B=(b, 0.0)),
            "coupler": link(0.5, (0.3, -0.2), 2e-3, B=ORIGIN, C=(c, 0.0)),
            "rocker": link(0.4, (0.1, 0.1), 3e-3, D=ORIGIN, C=(d, 0.0)),
        },
        {"C": side},
    )


@compared(CLOSED_FORMS, "angles of coupler and rocker", 1e-05, "almost a parallelogram")
def test_near_a_parallelogram_the_rocker_follows_the_crank() -> None:
    motion = eq.move(four_bar(1.0, 0.3, 1.0, 0.3 + 1e-7), np.linspace(0.2, pi - 0.2, 30))
    near(motion.links["coupler"].angle, 0.0, tolerance=1e-5)
    near(motion.links["rocker"].angle, motion.crank_angle, tolerance=1e-5)
    near(motion.links["rocker"].angle_1, 1.0, tolerance=1e-4)


def test_the_parallelogram_itself_has_change_points() -> None:
    with refused(eq.EquipoiseError, other="rocker", link="coupler", angle="0.00 deg"):
        eq.move(four_bar(1.0, 0.3, 1.0, 0.3), 36)


def force_balanced(machine: eq.Machine, b: float, c: float, d: float) -> eq.Machine:
    """Choose centres of mass by (84) and (85) of Yamashita, Ichikawa and Mori."""
    crank, coupler, rocker = (machine.links[name] for name in ("crank", "coupler", "rocker"))
    assert crank.mass and coupler.mass and rocker.mass and coupler.center_of_mass
    g1, g2 = coupler.center_of_mass
    on_rocker = (-coupler.mass * g1 * d / c / rocker.mass, -coupler.mass * g2 * d / c / rocker.mass)
    on_crank = (
        -coupler.mass * b / c * (c - g1) / crank.mass,
        coupler.mass * b / c * g2 / crank.mass,
    )
    machine = machine.with_link("rocker", center_of_mass=on_rocker)
    return machine.with_link("crank", center_of_mass=on_crank)


LENGTHS = (1.0, 0.35, 0.9, 0.8)


@compared(CLOSED_FORMS, "shaking force: none", 1e-14, "four-bar under (80) and (83)")
def test_complete_force_balance() -> None:
    """Conditions (80) and (83): no shaking force at any speed or acceleration."""
    plain = four_bar(*LENGTHS)
    balanced = force_balanced(plain, *LENGTHS[1:])
    size = np.max(forces(plain).shaking_force.size)
    near(forces(balanced).shaking_force.size, 0.0, size, 1e-14)
    assert np.max(np.abs(forces(balanced).shaking_moment)) > 0.01 * size


@compared(CLOSED_FORMS, "shaking force: a circle", 1e-13, "four-bar under (80)")
def test_condition_80_alone_leaves_a_rotating_force() -> None:
    """The common centre of mass runs round a circle, so that a counterweight on the crank helps."""
    machine = force_balanced(four_bar(*LENGTHS), *LENGTHS[1:])
    machine = machine.with_link("crank", center_of_mass=(0.2, 0.1))
    shaking = forces(machine).at(acceleration=0.0).shaking_force
    near(shaking.value * np.exp(-1j * THETA), shaking.value[0], shaking.size[0], 1e-13)


@compared(CLOSED_FORMS, "drive torque over load torque", 1e-12, "four-bar without masses")
def test_light_links_transmit_torque_by_power() -> None:
    """Without masses, drive torque over load torque is the rocker's speed over the crank's."""
    machine = four_bar(*LENGTHS)
    for name in machine.links:
        machine = machine.with_link(name, mass=0.0, inertia=0.0)
    result = forces(replace(machine, loads=(eq.Load("rocker", torque=-5.0),)))
    near(result.drive_torque, 5.0 * result.motion.links["rocker"].angle_1, 5.0)


@compared(CLOSED_FORMS, "swing of the lever: 2 asin(80 / 200)", 1e-05, "quick-return")
def test_swing_of_a_quick_return_lever() -> None:
    motion = eq.move(eq.load("quick-return"), 3600)
    angle = motion.links["lever"].angle
    assert np.ptp(angle) == pytest.approx(2 * asin(80 / 200), abs=1e-5)


@compared(CLOSED_FORMS, "force on the frame and torque of weight", 1e-12, "four-bar at rest")
def test_slow_machine_bears_only_weight() -> None:
    machine = four_bar(*LENGTHS)
    still = eq.analyze(machine, 48, speed=0.0, acceleration=0.0).forces
    near(still.frame_force.value, -1j * G * 1.2, 12.0)
    height = sum((body.mass or 0) * still.motion.mass_centers[name].place_1.imag
                 for name, body in machine.links.items())  # fmt: skip
    near(still.drive_torque, G * height, 12.0)
