"""Gears of varying ratio against the linkage that a pair of ellipses is, and against pitch curves.

Two equal ellipses that roll on each other turn about a focus each; the other foci stay as far apart
as the axes, so that a bar between them may take the place of the teeth: a crossed four-bar with
equal cranks, the antiparallelogram.
"""

from __future__ import annotations

import numpy as np
import pytest

import equipoise as eq
from equipoise.mechanism.parts.gear_shapes import GearShape
from equipoise.mechanism.parts.machine import FRAME
from equipoise.mechanism.parts.pitch_curves import law_of
from support.analyses import agree
from support.rolling_reference import Rolling
from unit.mechanism.build import ORIGIN, machine

TOLERANCE = 1e-10
HALF = np.linspace(0.1, np.pi - 0.1, 40)
"""The bars lie in line at 0 and 180 deg, where a linkage may go on as a parallelogram."""
HALVES = [pytest.param(HALF, "right", id="first half"), pytest.param(-HALF, "left", id="second")]
MASSLESS = {"mass": 0.0, "center_of_mass": ORIGIN, "inertia": 0.0}
FOCI = 0.42
"""Distance of the foci of an ellipse over that of the axes, which is its eccentricity."""


def swung(**points: tuple[float, float]) -> eq.Link:
    return eq.Link(points, 0.7, (0.1, -0.05), 0.02)


def ellipses(driver: str, driven: str, carrier: str, phase: float, start: float) -> eq.Gear:
    shape = GearShape("elliptic", eccentricity=FOCI, phase=phase)
    return eq.Gear(driver, driven, teeth=(31, 31), carrier=carrier, start=start, shape=shape)


def same(linkage: eq.Machine, geared: eq.Machine, pairs: dict[str, str], theta: np.ndarray) -> None:
    """Compare motion of links and all that drive and frame bear."""
    drive = {"speed": 7.0, "acceleration": 13.0}
    want, got = (eq.analyze(item, theta, **drive) for item in (linkage, geared))
    for key, other in pairs.items():
        a, b = want.motion.links[key], got.motion.links[other]
        agree(key, np.exp(1j * (b.angle - a.angle)), np.ones(len(theta)), TOLERANCE)
        agree(key, b.angular_velocity, a.angular_velocity, TOLERANCE)
        agree(key, b.angular_acceleration, a.angular_acceleration, TOLERANCE)
    for name in ("drive_torque", "frame_moment"):
        agree(name, getattr(got.forces, name), getattr(want.forces, name), TOLERANCE)
    agree("frame", got.forces.frame_force.value, want.forces.frame_force.value, TOLERANCE)


@pytest.mark.parametrize(("theta", "side"), HALVES)
def test_ellipses_on_the_frame_are_an_antiparallelogram(theta: np.ndarray, side: str) -> None:
    frame, cranks = {"A": ORIGIN, "D": (1.0, 0.0)}, (FOCI, 0.0)
    crank, wheel = swung(A=ORIGIN, B=cranks), swung(D=ORIGIN, C=cranks)
    coupler = eq.Link({"B": ORIGIN, "C": (1.0, 0.0)}, **MASSLESS)
    linkage = machine(
        frame, {"crank": crank, "coupler": coupler, "wheel": wheel}, assembly={"C": side}
    )
    gear = ellipses("crank", "wheel", FRAME, np.pi, 0.0)
    geared = machine(frame, {"crank": crank, "wheel": wheel}, gears=(gear,))
    same(linkage, geared, {"crank": "crank", "wheel": "wheel"}, theta)


@pytest.mark.parametrize(("theta", "side"), HALVES)
def test_a_planet_on_a_standing_ellipse_is_an_antiparallelogram(
    theta: np.ndarray, side: str
) -> None:
    """The carrier is the drive, the standing ellipse's foci are points of the frame."""
    crank, planet = swung(A=ORIGIN, D=(1.0, 0.0)), swung(D=ORIGIN, C=(FOCI, 0.0))
    bar = eq.Link({"B": ORIGIN, "C": (1.0, 0.0)}, **MASSLESS)
    linkage = machine(
        {"A": ORIGIN, "B": (FOCI, 0.0)}, {"crank": crank, "planet": planet, "bar": bar},
        assembly={"C": side},
    )  # fmt: skip
    gear = ellipses(FRAME, "planet", "crank", np.pi, 0.0)
    geared = machine({"A": ORIGIN}, {"crank": crank, "planet": planet}, gears=(gear,))
    same(linkage, geared, {"crank": "crank", "planet": "planet"}, theta)


def test_the_ratio_of_ellipses() -> None:
    """i = -(1 - k^2) / (1 + k^2 + 2 k cos x), where the shortest radius begins at x = 0."""
    x = np.linspace(-8, 8, 100)
    _, ratio, bend = ellipses("crank", "wheel", FRAME, 0.7, 0.0).rolling_law(x)  # type: ignore[misc]
    under = 1 + FOCI**2 + 2 * FOCI * np.cos(x - 0.7)
    np.testing.assert_allclose(ratio, -(1 - FOCI**2) / under, rtol=1e-14)
    slope = -(1 - FOCI**2) * 2 * FOCI * np.sin(x - 0.7) / under**2
    np.testing.assert_allclose(bend, slope, rtol=1e-13, atol=1e-14)


ANGLES = (0.1, 1.3, 2.0, 4.1, 5.5)
SHAPES = {
    "ellipse": (GearShape("elliptic", eccentricity=0.3, phase=0.3), -1.0),
    "ellipses of 2 and 3 lobes": (GearShape("elliptic", eccentricity=0.1, lobes=2), -2 / 3),
    "eccentric circle": (GearShape("eccentric", eccentricity=0.3), -1.0),
    "eccentric circle and 2 lobes": (GearShape("eccentric", eccentricity=0.2), -0.5),
    "limacon": (GearShape("limacon", eccentricity=0.3, lobes=2), -2.0),
    "series of the ratio": (GearShape("ratio", cosines=(0.2, 0.1), sines=(0.05,)), -1.0),
    "series of the radius": (GearShape("radius", cosines=(0.1,), sines=(0.1,)), -0.5),
    "table of the ratio": (
        GearShape("ratio", angle=ANGLES, ratio=(0.7, 1.2, 1.3, 0.9, 0.8)), -1.0,
    ),
    "table of the radius": (
        GearShape("radius", angle=ANGLES, radius=(0.03, 0.05, 0.04, 0.04, 0.05)), -1.0,
    ),
    "ellipse in a ring": (GearShape("elliptic", eccentricity=0.3, phase=0.3), 0.5),
    "ring about two ellipses": (GearShape("elliptic", eccentricity=0.1, lobes=3), 1.5),
    "limacon in a ring": (GearShape("limacon", eccentricity=0.3), 1 / 3),
    "ring as a limacon": (GearShape("limacon", eccentricity=0.1, lobes=3), 3.0),
    "eccentric circle in a ring": (GearShape("eccentric", eccentricity=0.3), 0.5),
    "series of a ring's radius": (GearShape("radius", cosines=(0.1,), lobes=2), 2.0),
    "series of the ratio in a ring": (GearShape("ratio", cosines=(0.2, 0.1)), 0.5),
}  # fmt: skip


@pytest.mark.parametrize("name", SHAPES)
def test_the_law_of_a_shape(name: str) -> None:
    """Angle, ratio and its derivative against quadratures over the pitch curves."""
    shape, mean = SHAPES[name]
    gear = eq.Gear("crank", "wheel", ratio=mean, shape=shape)
    x = np.linspace(-7, 9, 15)
    want = Rolling(gear)
    angle, ratio, bend = law_of(shape, mean)(x)
    turned = np.array([want.angle(float(item)) for item in x])
    np.testing.assert_allclose(angle - angle[0], turned - turned[0], atol=1e-11)
    np.testing.assert_allclose(ratio, want.ratio(x), rtol=1e-12)
    np.testing.assert_allclose(bend, want.bend(x), atol=1e-12)
    round_about = law_of(shape, mean)(x + 2 * np.pi)[0] - angle
    np.testing.assert_allclose(round_about, mean * 2 * np.pi, atol=1e-13)
