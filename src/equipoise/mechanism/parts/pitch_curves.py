"""Pitch curves that follow from the shape of gears, and what is wrong with them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from functools import lru_cache
from math import degrees, pi
from typing import Any

import numpy as np

from equipoise.i18n import Note
from equipoise.keys import with_fields
from equipoise.mechanism.formulas import kernels
from equipoise.mechanism.formulas.rolling import (
    EccentricCircle,
    HalfAngle,
    PitchCurve,
    RatioTable,
    RatioWaves,
    RollingLaw,
    Tabled,
    Waves,
)
from equipoise.mechanism.parts.gear_shapes import TABLED, GearShape, KeyProblem, MeshingGears
from equipoise.signals import Array

MISFIT = 1e-4
"""Share by which a table may miss that its curves close; it is spread over all of it."""
CUT = 1e-3
"""Of the distance of the axes: more than what a drawing of curves by corners may miss."""
COARSE, FINE_REACH = 32, 0.1
"""Angles of a lobe, for each of its waves, at which many designs are looked at, and how near to
what is wrong (rad, or of a ratio) they are looked at closely."""
FORMULAS = ("elliptic", "limacon", "ratio")
"""Kinds of shape whose laws are formulas of their numbers; of `ratio`, of a series."""
PIECES = 128
"""Pieces of a lobe over which a ratio is summed up, for each of its waves."""


def law_of(shape: GearShape, mean: float) -> RollingLaw:
    """The driven gear's angle by the driver's, both seen from the carrier; mean : ratio."""
    if shape.varies or np.ndim(shape.phase):
        return _counted_from(_law.__wrapped__(shape, mean), shape.phase)
    return _rolling(shape, mean)


def _counted_from(law: Any, zero: Any) -> RollingLaw:
    """The same law, a dataclass, which counts the driver's angle from another one."""
    moved: RollingLaw = replace(law, zero=zero)
    return moved


@lru_cache(maxsize=256)
def _rolling(shape: GearShape, mean: float) -> RollingLaw:
    return _counted_from(_law(_even(shape), mean), shape.phase)


@lru_cache(maxsize=256)
def _even(shape: GearShape) -> GearShape:
    """Shape with the phase 0, as the gears of a train mostly have it in common."""
    return replace(shape, phase=0.0)


@lru_cache(maxsize=64)
def _law(shape: GearShape, mean: float) -> RollingLaw:
    """The law of a shape whose phase is 0."""
    if shape.kind == "elliptic":
        return HalfAngle.ellipses(shape.eccentricity, mean, shape.lobes)
    if shape.kind == "limacon":
        return HalfAngle.limacon(shape.eccentricity, mean, shape.lobes)
    curve = curve_of(shape)
    if shape.kind != "ratio":
        return PitchCurve.closing(curve, mean, _knots(shape))
    if isinstance(curve, Tabled):
        return RatioTable.closing(curve, mean)
    assert isinstance(curve, Waves)
    return RatioWaves(mean, curve)


def _knots(shape: GearShape) -> Array:
    """Angles of the driver over a lobe (K + 1,), between which its radius is smooth, rad."""
    if not shape.angle:
        return np.linspace(0.0, shape.period, PIECES * shape.waves + 1)
    rows = np.append(-shape.angle[0] - shape.period, -np.array(shape.angle[::-1]))
    parts = max(8, -(-PIECES // len(rows)))
    at = np.arange(parts * (len(rows) - 1) + 1) / parts
    return np.asarray(np.interp(at, np.arange(len(rows)), rows))


def curve_of(shape: GearShape) -> EccentricCircle | Tabled | Waves:
    """The ratio or the driver's radius over an angle, up to what the mean ratio determines."""
    if shape.kind == "eccentric":
        assert shape.eccentricity is not None
        return EccentricCircle(shape.eccentricity)
    if shape.angle:
        return Tabled.through(shape.angle, shape.ratio or shape.radius, shape.period)
    return Waves(shape.cosines, shape.sines, shape.lobes)


def ratios_of(shape: GearShape, mean: float) -> tuple[float, float]:
    """The smallest and the largest size of the ratio, with its sign."""
    low, high, _ = _extent(_even(shape), mean)
    return (low, high) if mean > 0 else (high, low)


@lru_cache(maxsize=64)
def _lowest(shape: GearShape) -> float:
    """Of the table or the series of a shape."""
    return float(np.min(curve_of(shape)(_fine(shape))[0]))


@lru_cache(maxsize=64)
def _extent(shape: GearShape, mean: float) -> tuple[float, float, float]:
    """Lowest and highest ratio of a shape whose phase is 0, and the tangent by which the pitch
    curves lean at most.
    """
    _, first, second = _law(shape, mean)(_fine(shape))
    with np.errstate(all="ignore"):  # a ratio of 1 is refused by the caller
        leaning = np.abs(kernels.pitch_slope(first, second))
    return float(np.min(first)), float(np.max(first)), float(np.max(leaning))


def _fine(shape: GearShape) -> Array:
    """Angles over a lobe (n,), between which ratio and radius hardly change, rad."""
    return np.linspace(0.0, shape.period, 2 * PIECES * shape.waves + 1)


def closed_table(shape: GearShape, mean: float, distance: float | None) -> GearShape:
    """The shape with its table scaled so that the curves close; distance : as of `wrong_curve`."""
    law = law_of(shape, mean)
    if not shape.angle or not isinstance(law, RatioTable | PitchCurve):
        return shape
    factor = abs(law.factor) * (1.0 if shape.kind == "ratio" else distance or 0.0)
    values: dict[str, Any] = {
        shape.kind: tuple(factor * item for item in shape.ratio or shape.radius)
    }
    return replace(shape, **values) if factor else shape


def wrong_curve(
    shape: GearShape, gears: MeshingGears, distance: float | None
) -> Iterator[KeyProblem]:
    """What is wrong with the pitch curves that follow; distance : of the axes, if known, m."""
    even = _even(shape)
    if shape.kind in TABLED and (lowest := _lowest(even)) <= 0:
        note = Note(
            "goes down to {lowest:.4g}; a pitch curve needs it above 0 all the way round",
            lowest=lowest,
        )
        yield shape.kind if shape.angle else "cosines", note
        return
    ratio = gears.speed_ratio
    law = law_of(shape, ratio)
    yield from _misfits(shape, law, ratio, distance)
    low, high, steepest = _extent(even, ratio)
    if low <= 1 <= high:
        note = Note(
            "the ratio would go from {low:.4g} to {high:.4g}; of a ring and the gear in it it "
            "stays on one side of 1: give a smaller eccentricity, or a flatter curve",
            low=low,
            high=high,
        )
        yield "", note
        return
    most = degrees(np.arctan(steepest) + gears.pressure_angle)
    if not most < 90:
        note = Note(
            "the teeth would push at {most:.4g} deg from where the gear turns to, and jam; give a "
            "smaller eccentricity, a flatter curve or a smaller pressure angle",
            most=most,
        )
        yield "", note
    if ratio > 0 and (deepest := _overlap(even, ratio)) > CUT:
        note = Note(
            "the gear would cut its ring where they do not mesh, by {deepest:.2g} of the distance "
            "of the axes; give a smaller eccentricity, a flatter curve or a larger ring",
            deepest=deepest,
        )
        yield "", note


def can_vary(shape: GearShape) -> bool:
    """Whether the law of a shape whose numbers are columns has a formula, but for its phase."""
    return not shape.varies or shape.kind in FORMULAS


def can_roll(shape: GearShape, gears: MeshingGears) -> Array:
    """Of which designs (P, 1), whose numbers are columns, the pitch curves roll on each other.

    They are looked at closely where they are near to what is wrong, and rings always.
    """
    mean, e = gears.speed_ratio, shape.eccentricity
    x = np.linspace(0.0, shape.period, COARSE * shape.waves + 1)
    _, first, second = _law.__wrapped__(shape, mean)(x)
    leaning = np.arctan(np.abs(kernels.pitch_slope(first, second))) + gears.pressure_angle
    least = np.min(first / mean, axis=1, keepdims=True)
    from_one = np.min((1 - first) * np.sign(1 - mean), axis=1, keepdims=True)
    most = np.max(leaning, axis=1, keepdims=True)
    good: Array = (least > 0) & (from_one > 0) & (most < pi / 2)
    if e is not None:
        good &= (np.asarray(e) >= 0) & (np.asarray(e) < 1)
    far = (least > FINE_REACH) & (from_one > FINE_REACH) & (most < pi / 2 - FINE_REACH) & (mean < 0)
    for k in np.flatnonzero(good & ~far):
        item, pair = (_design(columns, int(k)) for columns in (shape, gears))
        good[k] = not [*wrong_curve(item, pair, None)]
    return good


def _design(columns: Any, k: int) -> Any:
    """Numbers of one of the designs, instead of columns."""
    of_one = {}
    for name, value in vars(columns).items():
        several = value if isinstance(value, tuple) else (value,)
        if any(isinstance(item, np.ndarray) for item in several):
            numbers = tuple(float(item[k, 0]) if np.ndim(item) else item for item in several)
            of_one[name] = numbers if isinstance(value, tuple) else numbers[0]
    return with_fields(columns, **of_one)


@lru_cache(maxsize=64)
def _overlap(shape: GearShape, mean: float) -> float:
    """How far a gear reaches out of the ring in which it turns, over the distance of the axes.

    Where they mesh it does so nowhere: of curves that roll, the difference of their curvatures
    vanishes nowhere.
    """
    law = law_of(shape, mean)
    sides = []
    for share, turns in ((1.0, 1.0), (0.0, 1 / mean)):  # driver at 1, driven gear at 0
        x = np.linspace(0.0, 2 * pi * turns, 721)
        y, ratio, _ = law(x)
        radius = (ratio if share else 1.0) / (1 - ratio)
        sides.append((share, radius * np.exp(-1j * (x if share else y))))
    (inner_at, inner), (outer_at, outer) = sides if mean < 1 else sides[::-1]
    at = np.linspace(0.0, shape.period, 90)
    turned = np.exp(1j * np.array([at, law(at)[0]])[..., None])
    of_inner, of_outer = turned if mean < 1 else turned[::-1]
    relative = (inner_at + inner * of_inner - outer_at) / of_outer
    room = np.interp(np.angle(relative), np.angle(outer), np.abs(outer), period=2 * pi)
    return float(np.max(np.abs(relative) - room))


def _misfits(
    shape: GearShape, law: RollingLaw, ratio: float, distance: float | None
) -> Iterator[KeyProblem]:
    """Tables whose curves do not close to a share of `MISFIT`."""
    if not shape.angle or not isinstance(law, RatioTable | PitchCurve):
        return
    factor = abs(law.factor)
    if shape.kind == "ratio" and abs(factor - 1) > MISFIT:
        note = Note(
            "the pitch curves do not close: the mean of the table is {mean:.7g}, and that of the "
            "gears {ratio:.7g}; multiply the table by {factor:.7g}",
            mean=abs(ratio) / factor,
            ratio=abs(ratio),
            factor=factor,
        )
        yield "ratio", note
    if shape.kind == "radius" and distance and abs(factor * distance - 1) > MISFIT:
        note = Note(
            "the pitch curves do not close: the driven gear's does at {closing:.7g} mm between "
            "the axes, and the carrier has {distance:.7g} mm; move a pin, or multiply the table "
            "by {factor:.7g}",
            closing=1e3 / factor,
            distance=1e3 * distance,
            factor=factor * distance,
        )
        yield "radius", note
