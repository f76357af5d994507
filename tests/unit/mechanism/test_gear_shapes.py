"""Gears of varying ratio: what is refused, how they close, and what their teeth bear."""

from __future__ import annotations

from math import pi, radians
from typing import Any

import numpy as np
import pytest

import equipoise as eq
from equipoise.mechanism.parts.gear_shapes import GearShape
from unit.mechanism.build import refused, two_gears


def shaped(teeth: tuple[int, int] = (30, 30), mesh: Any = "external", **shape: Any) -> eq.Gear:
    return eq.Gear("crank", "wheel", teeth=teeth, mesh=mesh, shape=GearShape(**shape))


ELLIPSE = {"kind": "elliptic", "eccentricity": 0.4}
THREE = {"angle": (0.0, 2.0, 4.0)}


REFUSED = [
    ("eccentricity", {}, {"kind": "elliptic"}),
    ("eccentricity", {"text": 1.2}, {"kind": "limacon", "eccentricity": 1.2}),
    ("lobes", {}, {"kind": "eccentric", "eccentricity": 0.1, "lobes": 2}),
    (
        "lobes",
        {"lobes": 1, "ratio": -0.666667, "count": 1.5}, {**ELLIPSE, "teeth": (20, 30)},
    ),
    (
        "", {"low": 0.333333, "high": 1.0},
        {"kind": "ratio", "cosines": (0.5,), "lobes": 2, "teeth": (20, 30), "mesh": "internal"},
    ),
    (
        "", {"deepest": 0.370481},
        {"kind": "elliptic", "eccentricity": 0.7, "teeth": (20, 40), "mesh": "internal"},
    ),
    ("", {"most": 91.8049}, {"kind": "elliptic", "eccentricity": 0.95}),
    (
        "ratio",
        {"mean": 1.06031, "ratio": 1.0, "factor": 0.943124},
        {"kind": "ratio", **THREE, "ratio": (0.7, 1.2, 1.3)},
    ),
    (
        "radius",
        {"closing": 512.444, "distance": 500.0},
        {"kind": "radius", **THREE, "radius": (0.1875, 0.3125, 0.25)},
    ),
    ("cosines", {"lowest": -0.2}, {"kind": "ratio", "cosines": (1.2,)}),
    ("", {"kind": "ratio"}, {"kind": "ratio"}),
    ("", {"kind": "ratio"}, {"kind": "ratio", **THREE}),
    ("angle", {"rows": 3, "values": 2}, {"kind": "ratio", **THREE, "ratio": (1.0, 1.0)}),
    ("angle", {"rows": 2}, {"kind": "ratio", "angle": (0.0, 1.0), "ratio": (1.0, 1.0)}),
    (
        "angle", {},
        {"kind": "ratio", "angle": (0.0, 2.0, 1.0), "ratio": (1.0, 1.0, 1.0)},
    ),
    (
        "angle", {"span": 360.0, "period": 360.0},
        {"kind": "ratio", "angle": (0.0, 2.0, 2 * pi), "ratio": (1.0, 1.2, 1.0)},
    ),
    ("cosines", {"waves": 51, "most": 50}, {"kind": "ratio", "cosines": (0.01,) * 51}),
    (
        "eccentricity", {},
        {"kind": "ratio", "cosines": (0.1,), "eccentricity": 0.1},
    ),
]  # fmt: skip


@pytest.mark.parametrize(("where", "expected", "given"), REFUSED)
def test_what_is_refused(where: str, expected: dict[str, Any], given: dict[str, Any]) -> None:
    place = f"gears[1].shape.{where}".rstrip(".")
    refused(place, expected, lambda: two_gears(shaped(**given)))


def test_a_table_that_nearly_closes_is_closed() -> None:
    angles = tuple(np.arange(36) * radians(10))
    exact = 1 + 0.2 * np.cos(angles)
    gear = shaped(kind="ratio", angle=angles, ratio=tuple(np.round(exact * 1.00004, 4)))
    assert gear.rolling_law is not None
    assert gear.rolling_law(2 * pi)[0] - gear.rolling_law(0.0)[0] == pytest.approx(
        -2 * pi, abs=1e-13
    )
    np.testing.assert_allclose(gear.rolling_law(np.array(angles))[1], -exact, atol=1e-4)


@pytest.mark.parametrize(
    ("teeth", "lobes", "turns"), [((30, 30), 1, 1), ((20, 40), 1, 2), ((40, 20), 2, 1)]
)
def test_it_closes_as_its_mean_ratio_does(teeth: tuple[int, int], lobes: int, turns: int) -> None:
    motion = eq.move(
        two_gears(shaped(teeth, **ELLIPSE | {"lobes": lobes, "eccentricity": 0.2})), 36
    )
    assert motion.turns == turns
    assert motion.linkage.cycle.windings["wheel"] == -round(turns * teeth[0] / teeth[1])


@pytest.mark.parametrize("torque", [6.0, -6.0])
@pytest.mark.parametrize("lean", [-1, 1])
def test_force_between_teeth_where_curves_lean(torque: float, lean: int) -> None:
    """Where an ellipse leans most its distances from both foci are equal: the tangent there makes
    an angle with the line of centres whose sine is that of the foci's over the long axis.
    """
    at = lean * (pi / 2 + np.arcsin(0.4))  # from the shortest radius, half of the long axis long
    gear = shaped(**ELLIPSE)
    given = two_gears(gear, gravity=(0.0, 0.0), loads=(eq.Load("wheel", torque=torque),))
    mesh = eq.analyze(given, [at], speed=0.0).forces.gears["crank to wheel"]
    radius = 0.5 / 2
    assert mesh.tangential[0] == pytest.approx(-torque / radius)
    tilt = lean * np.arcsin(0.4)
    leaning = np.tan(radians(20) - tilt * np.sign(torque))
    assert mesh.radial[0] == pytest.approx(abs(torque) / radius * leaning)


def test_a_series_and_a_table_of_the_same_curve() -> None:
    waves = shaped(kind="radius", cosines=(-0.2,))
    assert waves.rolling_law is not None
    limacon = shaped(kind="limacon", eccentricity=0.2)
    assert limacon.rolling_law is not None
    x = np.linspace(-9, 9, 50)
    for item, other in zip(waves.rolling_law(x), limacon.rolling_law(x), strict=True):
        np.testing.assert_allclose(item - item[0], other - other[0], atol=1e-12)
    assert waves.ratios == pytest.approx(limacon.ratios, rel=1e-6)
