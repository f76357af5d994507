"""Figures of the tip's motion, for one machine or for many designs of it at once.

Every figure has a dotted name, as in the output, and an array (P,) of values in SI units; NaN
where a design does not have it.
"""

from __future__ import annotations

from collections.abc import Callable, Collection

from equipoise.mechanism.tip import TipCurve
from equipoise.planting.clearance import clearances
from equipoise.planting.curve import (
    extreme,
    ground_bend,
    ratios,
    sharpest_bend,
    size_of_curve,
    transmission,
)
from equipoise.planting.moments import instant, release
from equipoise.planting.stay import in_soil, limits
from equipoise.planting.tray import pick_up
from equipoise.planting.vectors import Array, Figures


def figures(
    curve: TipCurve,
    entry: Array,
    leave: Array,
    breaks: Array | None = None,
    wanted: Collection[str] | None = None,
) -> Figures:
    """Every figure of the path, of the instants and of the stay in the soil.

    Parameters
    ----------
    entry, leave : (P,) crank angles at which the tip enters and leaves the soil, running on in the
        sense of the drive.
    breaks : (P, B) crank angles from entry to leave between which the path is smooth; None for
        equal panels.
    wanted : first parts of the names that are needed, such as ``curve``; None for all.
    """
    instants = {
        "lowest": lambda: curve.lowest[1],
        "highest": lambda: curve.highest[1],
        "entry": lambda: entry,
        "exit": lambda: leave,
        "release": lambda: release(curve),
        "pick_up": lambda: pick_up(curve, entry),
    }
    if curve.planting.tray is None:
        del instants["pick_up"]
    groups: dict[str, Callable[[], Figures]] = {
        "surface": lambda: {"surface": curve.surface},
        "curve": lambda: size_of_curve(curve) | sharpest_bend(curve, "curve", 0.0),
        "ground": lambda: ground_bend(curve),
        "max_speed": lambda: extreme(curve, "max_speed"),
        "min_speed": lambda: extreme(curve, "min_speed"),
        "max_acceleration": lambda: extreme(curve, "max_acceleration"),
        "min_acceleration": lambda: extreme(curve, "min_acceleration"),
        "ratio": lambda: ratios(curve),
        "transmission": lambda: transmission(curve),
        "soil": lambda: in_soil(curve, entry, leave, breaks),
        "limits": lambda: limits(curve, entry, leave),
        "clearance": lambda: clearances(curve, entry),
    }
    for name, when in instants.items():
        groups[name] = lambda name=name, when=when: instant(curve, name, when())  # type: ignore[misc]
    result: Figures = {}
    for name, group in groups.items():
        if wanted is None or name in wanted:
            result |= group()
    return result
