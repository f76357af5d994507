"""Figures of all arms of a machine together, for one machine or for many designs of it at once."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from typing import TypeVar

import numpy as np

from equipoise.mechanism.kinematics.tip import TipCurve
from equipoise.planting.figures import shaking, tip_figures
from equipoise.planting.names import SHAKING_FIGURES
from equipoise.planting.stroke import Figures, release, soil_crossings
from equipoise.signals import Array

Value = TypeVar("Value")

OF_DRIVE = ("speed", "forward_speed", "hill_spacing", "planting_frequency")
"""Figures of the machine that follow from its drive."""
SHARED = ("surface", *OF_DRIVE)
"""Figures that are the same of all arms."""
SHAKING = {name.partition(".")[0] for name in SHAKING_FIGURES}
"""First parts of the names of what inertia does."""


def of_arm(tip: str, figures: Mapping[str, Value]) -> Iterator[tuple[str, Value]]:
    """Figures of a further arm as those of its machine: ``arms.Q.curve.height``."""
    return ((f"arms.{tip}.{name}", value) for name, value in figures.items() if name not in SHARED)


def machine_figures(curve: TipCurve, wanted: Collection[str] | None = None) -> Figures:
    """Every figure of the first arm, of the further ones, of the hills of all, and of what shakes.

    wanted : names of those that are needed; None for all.
    """
    first, *further = curve.arms
    groups = None if wanted is None else {_group(name) for name in wanted}
    result = tip_figures(first, *soil_crossings(first), wanted=groups)
    if groups is None or "hills" in groups:
        result |= hills(curve)
    if groups is None or not SHAKING.isdisjoint(groups):
        result |= shaking(curve)
    for arm in further:
        begin = f"arms.{arm.arm.tip}."
        own = {name.removeprefix(begin) for name in wanted or () if name.startswith(begin)}
        if wanted is None or own:
            groups = {_group(name) for name in own} or None
            figures = tip_figures(arm, *soil_crossings(arm), wanted=groups)
            result |= of_arm(arm.arm.tip, figures)
    return result


def _group(name: str) -> str:
    """The group of a figure: the first part of its name, such as ``curve``."""
    bend = "curve.smallest_radius"
    return bend if name.startswith(bend) else name.partition(".")[0]


def hills(curve: TipCurve) -> Figures:
    """Distances over ground from hill to hill of a row, where each arm plants one a turn.

    NaN for a machine at rest.
    """
    if len(curve.arms) < 2 or curve.turns > 1 or curve.planting.units_per_turn > 1:
        return {}
    sense, forward = np.sign(curve.speed[:, 0]), curve.forward[:, 0]
    row = np.abs(forward) * curve.period / np.abs(curve.speed[:, 0])
    places = np.stack([_hill(arm, sense) for arm in curve.arms], axis=1)
    with np.errstate(invalid="ignore"):
        along = np.sort(np.mod(places, row[:, None]), axis=1)
        apart = np.diff(along, axis=1, append=along[:, :1] + row[:, None])
    drives = np.where(row > 0, 1.0, np.nan)
    return {
        "hills.smallest_distance": np.min(apart, axis=1) * drives,
        "hills.largest_distance": np.max(apart, axis=1) * drives,
    }


def _hill(curve: TipCurve, sense: Array) -> Array:
    """Place over ground (P,), m, at which an arm lets a seedling go."""
    theta = release(curve)
    way = np.mod(sense * theta, curve.period)
    place = curve.at(theta[:, None]).place[:, 0].real
    result: Array = place + way * curve.forward[:, 0] / np.abs(curve.speed[:, 0])
    return result
