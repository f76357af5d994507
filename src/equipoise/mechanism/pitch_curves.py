"""Pitch curves that follow from the shape of gears, and what is wrong with them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from functools import lru_cache
from math import degrees

import numpy as np

from equipoise.i18n import Note
from equipoise.mechanism import kernels
from equipoise.mechanism.curves import Array
from equipoise.mechanism.gear_shapes import TABLED, GearShape, Pair, Told
from equipoise.mechanism.rolling import (
    EccentricCircle,
    HalfAngle,
    PitchCurve,
    RatioCurve,
    Rolling,
    Summed,
    Tabled,
    Waves,
)

MISFIT = 1e-4
"""Share by which a table may miss that its curves close; it is spread over all of it."""
PIECES = 32
"""Pieces of a lobe over which a ratio is summed, for each of its waves."""


def law_of(shape: GearShape, mean: float) -> Rolling:
    """The driven gear's angle by the driver's, both seen from the carrier; mean : ratio."""
    if shape.kind in ("elliptic", "limacon"):
        make = HalfAngle.ellipses if shape.kind == "elliptic" else HalfAngle.limacon
        return replace(make(shape.eccentricity, mean, shape.lobes), zero=shape.phase)
    return replace(_summed(replace(shape, phase=0.0), mean), zero=shape.phase)


@lru_cache(maxsize=32)
def _summed(shape: GearShape, mean: float) -> Summed:
    """The law of a shape whose phase is 0."""
    curve = curve_of(shape)
    knots = np.linspace(0.0, shape.period, PIECES * shape.waves + 1)
    if isinstance(curve, Tabled):
        rows = curve.knots if shape.kind == "ratio" else -curve.knots[::-1]
        knots = np.interp(np.arange(8 * len(rows) - 7) / 8, np.arange(len(rows)), rows)
    make = RatioCurve if shape.kind == "ratio" else PitchCurve
    return Summed.of(mean, make.closing(curve, mean, knots), knots)


def curve_of(shape: GearShape) -> EccentricCircle | Tabled | Waves:
    """Over an angle: the ratio or the driver's radius, as far as the shape tells it."""
    if shape.kind == "eccentric":
        assert shape.eccentricity is not None
        return EccentricCircle(shape.eccentricity)
    if shape.angle:
        return Tabled.through(shape.angle, shape.ratio or shape.radius, shape.period)
    return Waves(shape.cosines, shape.sines, shape.lobes)


def fine(shape: GearShape) -> Array:
    """Angles of the driver over a lobe (n,), between which its ratio hardly changes, rad."""
    return shape.phase + np.linspace(0.0, shape.period, 8 * PIECES * shape.waves + 1)


def ratios_of(shape: GearShape, mean: float) -> tuple[float, float]:
    """The smallest and the largest size of the ratio, with its sign."""
    _, ratio, _ = law_of(shape, mean)(fine(shape))
    return float(np.max(ratio)), float(np.min(ratio))


def wrong_curve(shape: GearShape, gears: Pair, distance: float | None) -> Iterator[Told]:
    """What is wrong with the pitch curves that follow; distance : of the axes, if known, m."""
    if shape.kind in TABLED and (lowest := float(np.min(curve_of(shape)(fine(shape))[0]))) <= 0:
        told = Note(
            "goes down to {lowest:.4g}; a pitch curve needs it above 0 all the way round",
            lowest=lowest,
        )
        yield shape.kind if shape.angle else "cosines", told
        return
    ratio = gears.speed_ratio
    law = law_of(shape, ratio)
    yield from _misfits(shape, law, ratio, distance)
    _, first, second = law(fine(shape))
    steepest = float(np.max(np.abs(kernels.pitch_slope(first, second))))
    most = degrees(np.arctan(steepest) + gears.pressure_angle)
    if not most < 90:
        told = Note(
            "the teeth would push at {most:.4g} deg from where the gear turns to, and jam; give a "
            "smaller eccentricity, a flatter curve or a smaller pressure angle",
            most=most,
        )
        yield "", told


def _misfits(
    shape: GearShape, law: Rolling, ratio: float, distance: float | None
) -> Iterator[Told]:
    """Tables whose curves do not close to a share of `MISFIT`."""
    if not shape.angle or not isinstance(law, Summed):
        return
    factor = abs(law.rate.factor)
    if shape.kind == "ratio" and abs(factor - 1) > MISFIT:
        told = Note(
            "the pitch curves do not close: the mean of the table is {mean:.7g}, and that of the "
            "gears {ratio:.7g}; multiply the table by {factor:.7g}",
            mean=abs(ratio) / factor,
            ratio=abs(ratio),
            factor=factor,
        )
        yield "ratio", told
    if shape.kind == "radius" and distance and abs(factor * distance - 1) > MISFIT:
        told = Note(
            "the pitch curves do not close: the driven gear's does at {closing:.7g} mm between "
            "the axes, and the carrier has {distance:.7g} mm; move a pin, or multiply the table "
            "by {factor:.7g}",
            closing=1e3 / factor,
            distance=1e3 * distance,
            factor=factor * distance,
        )
        yield "radius", told
