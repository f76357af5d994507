"""Planting figures, beside the ways in which they are found elsewhere, in one process.

The peer of the figures is a scan: the same tip at 36 000 crank angles (a hundredth of a degree),
from which the largest and smallest values are picked; it gives neither loops nor clearances, and
its angles are right to a hundredth of a degree only.  The peer of designs solved together is the
same figures of one design after the other.
"""

from __future__ import annotations

import numpy as np

import equipoise as eq
from equipoise.mechanism.tip import TipCurve
from equipoise.planting.figures import tip_figures
from equipoise.planting.stroke import soil_crossings
from timing import in_turn, report

MACHINE = eq.load("kim-chung-a")
DESIGNS = 100


def scan() -> list[int]:
    """Extremes of height, speed and acceleration, and the crossings of the surface, by samples."""
    tip = eq.move(MACHINE, 36_000).points["P"]
    signals = (tip.x, tip.y, np.abs(tip.velocity), np.abs(tip.acceleration_vector))
    level = np.min(tip.y) + 0.04
    below = np.flatnonzero(np.diff(np.signbit(tip.y - level)))
    return [*(int(np.argmax(signal)) for signal in signals), *below.tolist()]


def designs() -> list[eq.Machine]:
    """New machines on each call, so that none is assembled yet."""
    points = MACHINE.links["coupler"].points
    shifts = np.linspace(0, 0.01, DESIGNS)
    return [
        MACHINE.with_link("coupler", points={**points, "P": (points["P"][0] + s, points["P"][1])})
        for s in shifts
    ]


def together() -> object:
    """All figures of a family of designs, as a search has them."""
    curve = TipCurve(designs(), 180, turns=1)
    return tip_figures(curve, *soil_crossings(curve))


def one_by_one() -> object:
    """The same, of one design after the other."""
    curves = [TipCurve([machine], 180, turns=1) for machine in designs()]
    return [tip_figures(curve, *soil_crossings(curve)) for curve in curves]


def main() -> None:
    """Print both comparisons."""
    print("one machine")
    tasks = {"scan at 36 000 crank angles": scan, "plant: everything": lambda: eq.plant(MACHINE)}
    report(in_turn(tasks, 20), "scan at 36 000 crank angles", 1e-3, "ms")
    print(f"\nall figures of {DESIGNS} designs, in ms a design")
    family = {"one by one": one_by_one, "together": together}
    report(in_turn(family, 5), "one by one", 1e-3 * DESIGNS, "ms")


if __name__ == "__main__":
    main()
