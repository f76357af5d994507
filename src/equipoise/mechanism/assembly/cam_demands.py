"""Whether a cam can be made, or its follower jams or it would be undercut."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from copy import copy
from dataclasses import dataclass, replace
from functools import partial
from math import degrees, floor, log10, pi, radians
from typing import Any

import numpy as np

from equipoise.errors import ModelError
from equipoise.i18n import Note
from equipoise.mechanism.assembly.cam_fits import STEEPEST, Fit, fitted
from equipoise.mechanism.assembly.cam_shapes import BESIDE, Array, Shape, design, lowest
from equipoise.mechanism.assembly.joints import Structure, place_in_file
from equipoise.mechanism.parts.cams import Cam
from equipoise.mechanism.parts.machine import Machine

NEAR, FEWEST, WIDEST = 0.1, 8, radians(3)
"""Of a value's size: what is lower may be below 0 between angles of a cam that are this far apart,
and so many in each piece of its law."""
AT_ONCE = 128
"""Designs that are looked at together, so that their values stay in the processor's cache."""
LARGEST, RADII, DIGITS = 100.0, 65, 4
"""Times a cam's base radius up to which larger ones are tried, so many at once; digits of it."""


@dataclass(frozen=True)
class Demand:
    """Something (N,) that has to be above 0 all over a cam.

    told : what is said where it is not, of its least value and the cam angle of that, deg.
    size : that it has far from 0.  mended : whether another base radius can do something about it.
    """

    value: Callable[[Shape], Array]
    told: Callable[[float, float], Note]
    size: Any = 1.0
    mended: bool = True


def check_shape(machine: Machine, joints: Structure, fit: Fit) -> None:
    """Raise an error where the follower jams or the cam is undercut."""
    for demand in _demands(fit.cam):
        least, angle = lowest(fit.shape(fit.knots), demand.value, fit.knots)
        if least <= 0:
            told = demand.told(least, degrees(angle))
            if demand.mended:
                told = _with_radius(told, machine, joints, fit.cam)
            raise ModelError(place_in_file(joints, fit.cam), told)


def _with_radius(told: Note, machine: Machine, joints: Structure, cam: Cam) -> Note:
    """What is wrong with a cam, and with which base radius it can be made."""
    least = larger_base(machine, joints, cam)
    if least is None:
        most = LARGEST * cam.base_radius * 1e3
        return Note("{told}; no base_radius up to {most:.4g} mm does", told=told, most=most)
    return Note(
        "{told}; {least:.4g} mm is the least base_radius that does", told=told, least=least * 1e3
    )


def larger_base(machine: Machine, joints: Structure, cam: Cam) -> float | None:
    """The least base radius, m, above that of a cam with which it can be made.

    It is found among ever closer ones, the last of which have `DIGITS` digits; None where none up
    to `LARGEST` times as large is right.
    """
    low, high = cam.base_radius, LARGEST * cam.base_radius
    for _ in range(2):
        radii = np.geomspace(low, high, RADII)
        right = np.flatnonzero(_made(machine, joints, cam, radii))
        if not len(right):
            return None
        low, high = radii[max(right[0] - 1, 0)], radii[right[0]]
    step = 10.0 ** (floor(log10(high)) + 1 - DIGITS)
    radii = np.arange(np.ceil(low / step), np.ceil(high / step) + 1) * step
    right = np.flatnonzero(_made(machine, joints, cam, radii))
    return float(radii[right[0]]) if len(right) else None


def _made(machine: Machine, joints: Structure, cam: Cam, radii: Array) -> Array:
    """With which base radii (R,), m, a cam can be made."""
    several = copy(cam)
    several.__dict__["base_radius"] = radii[:, None]  # unchecked: a column of designs
    alone = replace(joints, couplings=(several,))
    with np.errstate(all="ignore"):  # of some the follower does not reach the cam
        return can_be_made(fitted(machine, alone, several))[:, 0]


def can_be_made(fit: Fit) -> Array:
    """Of which designs (P, 1), whose numbers are columns, the cam can be made."""
    cam = fit.cam
    made: Array = np.isfinite(fit.rest) & (np.asarray(cam.base_radius) > 0)
    if cam.rides == "roller":
        made = made & (np.asarray(cam.roller_radius) > 0)
    count, knots = np.size(fit.rest), fit.knots
    shape = fit.shape(_spread(knots))
    with np.errstate(all="ignore"):
        for begin in range(0, count, AT_ONCE):
            some = slice(begin, begin + AT_ONCE)
            for demand in _demands(cam):
                least = np.min(demand.value(shape.of(some)), axis=-1, keepdims=True)
                made[some] &= least > 0
                near = made[some] & (least < NEAR * design(demand.size, some))
                for k in begin + np.flatnonzero(near):
                    made[k] = lowest(shape.of(k), demand.value, knots)[0] > 0
    return made


def _spread(knots: Array) -> Array:
    """Cam angles, rad, between which no value is lower by as much as `NEAR`."""
    ends = np.append(knots, knots[0] + 2 * pi)
    counts = np.maximum(FEWEST, np.ceil(np.diff(ends) / WIDEST)).astype(int)
    pairs = zip(ends + BESIDE, ends[1:] - BESIDE, counts, strict=False)
    return np.concatenate([np.linspace(*one) for one in pairs])


def _demands(cam: Cam) -> Iterator[Demand]:
    if cam.rides == "flat":
        yield Demand(
            lambda one: 1 - STEEPEST - one.ride.turn_1,
            lambda _, angle: Note(
                "at cam angle {angle:.4g} deg the follower turns as fast as the cam, which no flat "
                "face can do; give it less swing there, or more time",
                angle=angle,
            ),
            mended=False,
        )
    yield Demand(
        lambda one: np.cos(one.pressure_angle) - STEEPEST,
        lambda _, angle: Note(
            "the follower jams at cam angle {angle:.4g} deg, where the pressure angle is 90 "
            "deg; give a larger base_radius, or another place of the follower",
            angle=angle,
        ),
    )
    if cam.rides == "flat":
        yield Demand(lambda one: one.radius_of_curvature, _undercut_flat, cam.base_radius)
        return
    # the curve of a roller's centre bends less than the roller, outward and in a groove inward
    for sign in (1.0, -1.0) if cam.closed_by == "groove" else (1.0,):
        yield Demand(
            partial(_blunt, sign),
            partial(_undercut_round, cam.roller_radius),
        )


def _blunt(sign: float, shape: Shape) -> Array:
    return 1 - sign * shape.curvature * shape.radius


def _undercut_flat(least: float, angle: float) -> Note:
    return Note(
        "the cam is undercut at cam angle {angle:.4g} deg, where its radius of curvature "
        "would be {radius:.4g} mm; a flat face needs more than 0: give a larger "
        "base_radius, or more time there",
        angle=angle,
        radius=least * 1e3,
    )


def _undercut_round(roller: float, least: float, angle: float) -> Note:
    return Note(
        "the cam is undercut at cam angle {angle:.4g} deg, where the curve of the "
        "roller's centre has a radius of {radius:.4g} mm, and the roller one of "
        "{roller:.4g} mm; give a larger base_radius, a smaller roller, or more time "
        "there",
        angle=angle,
        radius=1e3 * roller / (1 - least),
        roller=roller * 1e3,
    )
