"""Random machines with gears whose ratio varies; registered in `support.machines`."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

import numpy as np

from equipoise.mechanism.parts.gear_shapes import GearShape
from equipoise.mechanism.parts.gears import Gear
from equipoise.mechanism.parts.machine import FRAME
from equipoise.mechanism.parts.pitch_curves import law_of
from support.machines import Case, _four_bar, _scaled, _spot, arm_with_planet


def _shape(rng: np.random.Generator, lobes: int, ratio: float) -> GearShape:
    """Draw pitch curves."""
    phase, share = float(rng.uniform(-3, 3)), float(rng.uniform(0.05, 0.3)) / lobes
    waves = [tuple(rng.normal(size=2) * 0.05 / lobes**2) for _ in range(2)]
    angles = tuple((np.arange(6) + rng.uniform(-0.2, 0.2, 6)) * np.pi / 3 / lobes)
    kind = str(rng.choice(["elliptic", "eccentric", "limacon", "ratio", "radius", "table"]))
    if kind in ("elliptic", "limacon") or (kind == "eccentric" and lobes == 1):
        return GearShape(kind, eccentricity=share, lobes=lobes, phase=phase)
    if kind == "table":
        values = 1 + rng.uniform(-0.1, 0.1, 6) / lobes
        shape = GearShape("ratio", lobes=lobes, phase=phase, angle=angles, ratio=tuple(values))
        factor = abs(law_of(shape, ratio).factor)
        return replace(shape, ratio=tuple(values * factor))
    kind = "ratio" if kind == "ratio" else "radius"
    return GearShape(kind, cosines=waves[0], sines=waves[1], lobes=lobes, phase=phase)


def _rolling(rng: np.random.Generator, driver: str, driven: str, carrier: str = FRAME) -> Gear:
    """Draw a pair of few lobes, of which either may be a ring about the other."""
    lobes, others = int(rng.integers(1, 3)), int(rng.integers(1, 4))
    ratio = Fraction(lobes, others) * (1 if lobes != others and rng.random() < 0.5 else -1)
    gear = Gear(
        driver, driven, ratio=float(ratio), carrier=carrier, start=float(rng.uniform(-3, 3)),
        pressure_angle=float(rng.choice([0.0, np.radians(20)])),
    )  # fmt: skip
    return replace(gear, shape=_shape(rng, lobes, float(ratio)))


def rolling_counterweight(rng: np.random.Generator) -> Case:
    """Four-bar whose rocker, or crank, drives a counterweight by gears of varying ratio."""
    draft = _four_bar(rng).draft
    draft.ground("W", rng.uniform(-4, 4, 2) * draft.size)
    draft.add("weight", W=(0, 0), T=_scaled(rng, draft))
    draft.gears.append(_rolling(rng, str(rng.choice(["rocker", "crank"])), "weight"))
    return draft.case()


def rolling_coupler(rng: np.random.Generator) -> Case:
    """Four-bar whose crank drives a gear on the coupler, with a varying ratio."""
    draft = _four_bar(rng, _spot(rng)).draft
    draft.add("wheel", P=(0, 0), T=_scaled(rng, draft))
    draft.gears.append(_rolling(rng, "crank", "wheel", "coupler"))
    return draft.case()


def rolling_planet(rng: np.random.Generator) -> Case:
    """A driven arm carries an idler and a planet round a standing sun, none of them round."""
    draft = arm_with_planet(rng)
    draft.gears.append(_rolling(rng, FRAME, "idler", "arm"))
    draft.gears.append(_rolling(rng, "idler", "planet", "arm"))
    return draft.case("arm")
