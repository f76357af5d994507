"""Rotary planting with elliptic gears against closed forms of an antiparallelogram."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import equipoise as eq
from equipoise.mechanism.parts.field import PlantingArm
from equipoise.mechanism.parts.gear_shapes import GearShape
from support.rotary_reference import CYCLE, TURN, Arm, Body, Rotary, rolled

WITHIN = 1e-12
"""Of the largest value; what is a second derivative of a Fourier series has 1e-10."""


def bundled() -> Rotary:
    """The bundled machine: its numbers as they stand in the file, in SI units."""
    idler, planet = -7.3066e-3 + 51.9891e-3j, 20.5142e-3 + 96.5116e-3j
    bends, tip = np.radians([-40, 140]), 0.13 + 0j
    return Rotary(
        0.2,
        (
            Arm((idler, planet), 0.0, bends[0], (0.0, np.radians(-15)), tip),
            Arm((-idler, -planet), np.pi, bends[1], (0.0, np.radians(-44.98706)), tip),
        ),
        Body(1.2, 0j, 5.2e-3),
        Body(0.2, 0.7307e-3 - 5.1989e-3j, 68e-6),
        Body(0.65, 0.038 + 0.004j, 1.5e-3),
    )


def drawn(seed: int) -> Rotary:
    """One with any numbers, and arms that are not alike."""
    rng = np.random.default_rng(seed)

    def spot(size: float) -> complex:
        return complex(rng.normal(0, size), rng.normal(0, size))

    arms = [
        Arm(
            (spot(0.05), spot(0.1)),
            *map(float, rng.uniform(-3, 3, 2)),
            (float(rng.uniform(-3, 3)), float(rng.uniform(-3, 3))),
            spot(0.1),
        )
        for _ in range(2)
    ]
    bodies = (Body(float(rng.uniform(0.2, 2)), spot(0.02), float(rng.uniform(1e-4, 1e-3)))
              for _ in range(3))  # fmt: skip
    return Rotary(float(rng.uniform(0.05, 0.3)), arms, *bodies)


def machine_of(case: Rotary, speed: float) -> eq.Machine:
    """The same as a model."""

    def link(body: Body, **points: complex) -> eq.Link:
        places = {name: (z.real, z.imag) for name, z in points.items()}
        return eq.Link(places, body.mass, (body.center.real, body.center.imag), body.inertia)

    links, gears, axes = {}, [], {}
    for number, (arm, (b, c, tip)) in enumerate(zip(case.arms, ("BCP", "DEQ"), strict=True), 1):
        links[f"idler {number}"] = link(case.wheel, **{b: 0j})
        links[f"arm {number}"] = link(case.finger, **{c: 0j, tip: arm.tip})
        axes |= {b: arm.axes[0], c: arm.axes[1]}
        pairs = (("frame", f"idler {number}"), (f"idler {number}", f"arm {number}"))
        for pair, start, phase in zip(pairs, arm.starts, (arm.sun, arm.idler), strict=True):
            shape = GearShape("elliptic", eccentricity=case.eccentricity, phase=phase)
            gear = eq.Gear(*pair, ratio=-1.0, carrier="carrier", start=start, shape=shape)
            gears.append(replace(gear, pressure_angle=0.0))
    links["carrier"] = link(case.carrier, A=0j, **axes)
    drive = eq.Drive("carrier", speed)
    return eq.Machine("rotary", drive, {"A": (0.0, 0.0)}, links, gears=tuple(gears))


CASES = {"bundled": bundled(), **{f"random-{seed}": drawn(seed) for seed in range(4)}}
MACHINES = {
    name: machine_of(case, -18.0 if name == "bundled" else 12.0) for name, case in CASES.items()
}
MACHINES["bundled"] = eq.load("rotary-transplanter")


@pytest.mark.parametrize("name", CASES)
def test_paths_of_both_tips(name: str) -> None:
    case, motion = CASES[name], eq.move(MACHINES[name], CYCLE)
    for arm, tip in zip(case.arms, "PQ", strict=True):
        np.testing.assert_allclose(motion.points[tip].place, case.tip(arm, CYCLE), atol=WITHIN)


@pytest.mark.parametrize("name", CASES)
def test_force_and_moment_are_changes_of_momentum(name: str) -> None:
    case, machine = CASES[name], MACHINES[name]
    force, moment = case.shaking(machine.drive.speed)
    forces = eq.mechanism.forces(eq.move(machine, CYCLE))
    for got, want in ((forces.shaking_force.value, force), (forces.shaking_moment, moment)):
        np.testing.assert_allclose(got, want, atol=1e-10 * np.max(np.abs(want)))


def test_ratio_of_an_antiparallelogram() -> None:
    """As printed: i = -(1 - k^2) / (1 + k^2 + 2 k cos x), x from the driver's shortest radius."""
    k, x, step = 0.3, np.linspace(-7, 7, 41), 1e-5
    slope = (rolled(x + step, k) - rolled(x - step, k)) / (2 * step)
    np.testing.assert_allclose(slope, -(1 - k**2) / (1 + k**2 + 2 * k * np.cos(x)), atol=1e-8)


# The paths themselves are compared in the tests of this file, figures of others in
# test_planting.py.
@pytest.mark.exhaustive
def test_figures_of_planting_stand_on_these_paths() -> None:
    """Lowest point, height and hills of the bundled machine."""
    case, figures = CASES["bundled"], eq.plant(MACHINES["bundled"])
    theta = np.arange(200_000) * (TURN / 200_000)
    for arm, actual in zip(case.arms, figures.arms, strict=True):
        path = case.tip(arm, theta)
        assert actual["curve.height"] == pytest.approx(np.ptp(path.imag), abs=1e-9)
        assert actual["curve.width"] == pytest.approx(np.ptp(path.real), abs=1e-9)
        lowest = theta[np.argmin(path.imag)]
        assert actual["lowest.crank_angle"] == pytest.approx(lowest, abs=1e-4)
    assert figures["hills.smallest_distance"] == pytest.approx(0.16, abs=1e-6)
    assert figures["hills.largest_distance"] == pytest.approx(0.16, abs=1e-6)


def test_both_arms_take_the_same_path_and_shake_alike() -> None:
    """So that everything comes twice a turn, to the digits of the file."""
    half = len(CYCLE) // 2
    analysis = eq.analyze(MACHINES["bundled"].with_planting(soil=None), CYCLE)
    first, second = (analysis.motion.points[tip].place for tip in "PQ")
    np.testing.assert_allclose(second, np.roll(first, half), atol=1e-7)
    for values in (analysis.forces.shaking_force.value, analysis.forces.shaking_moment):
        np.testing.assert_allclose(values, np.roll(values, half), atol=1e-6)


def test_named_arms_are_those_of_the_file() -> None:
    planting = MACHINES["bundled"].planting
    assert planting is not None
    assert planting.arms == (PlantingArm("Q", finger_from="E"),)
    assert planting.hills_per_turn == 2
