"""Planting figures, beside the ways in which they are found elsewhere, in one process.

The peer of the figures is a scan: the same tip at 36 000 crank angles (a hundredth of a degree),
from which the largest and smallest values are picked; it gives neither loops nor clearances, and
its angles are right to a hundredth of a degree only.  The peer of designs solved together is the
same figures of one design after the other.  That of designs whose gears vary in shape is the same
search with round gears.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

import equipoise as eq
from equipoise.design.requirements import Requirement
from equipoise.mechanism.kinematics.tip import TipCurve
from equipoise.mechanism.parts.gear_shapes import GearShape
from equipoise.planting.figures import tip_figures
from equipoise.planting.search import Designs, PlantingProblem
from equipoise.planting.stroke import soil_crossings
from timing import in_turn, report

MACHINE, ROTARY = eq.load("kim-chung-a"), eq.load("rotary-transplanter")
DESIGNS, JUDGED = 100, 40
ROWS = tuple(np.arange(12) * np.pi / 6)
SHAPES = {
    "ellipses": ("gears.shape.eccentricity", 0.2, {"kind": "elliptic", "eccentricity": 0.2}),
    "limaçons": ("gears.shape.eccentricity", 0.2, {"kind": "limacon", "eccentricity": 0.2}),
    "eccentric circles": (
        "gears.shape.eccentricity", 0.2, {"kind": "eccentric", "eccentricity": 0.2}
    ),
    "series of the ratio": (
        "gears.shape.cosines[1]", -0.3, {"kind": "ratio", "cosines": (-0.3, 0.05)}
    ),
    "series of the radius": (
        "gears.shape.cosines[1]", -0.2, {"kind": "radius", "cosines": (-0.2, 0.02)}
    ),
    "table of the ratio": (
        "gears.shape.ratio[3]", 0.85,
        {"kind": "ratio", "angle": ROWS, "ratio": tuple(1 - 0.3 * np.cos(ROWS))},
    ),
}  # fmt: skip
"""What the gears of the rotary transplanter become, and the number that a search varies."""
GOALS = [
    Requirement("shaking_moment.rms", make="smallest"),
    Requirement("curve.height", at_least=0.26),
]


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


def searched(machine: eq.Machine, **vary: tuple[float, float]) -> Callable[[], object]:
    """What judges a generation of designs, as a search does."""
    problem = PlantingProblem(Designs(machine, {"tip.x": (0.12, 0.14), **vary}), GOALS)
    low, high = problem.designs.bounds
    rng = np.random.default_rng(1)
    return lambda: problem.judge(low + (high - low) * rng.random((JUDGED, len(low))))


def shaped(**given: object) -> eq.Machine:
    """The rotary transplanter with gears of another shape."""
    gears = (
        replace(gear, shape=GearShape(phase=gear.shape.phase, **given)) for gear in ROTARY.gears
    )
    return replace(ROTARY, gears=tuple(gears))


def searches() -> dict[str, Callable[[], object]]:
    """A generation of designs of a rotary transplanter, by the shape of its gears."""
    even = replace(ROTARY, gears=tuple(replace(gear, shape=None) for gear in ROTARY.gears))
    tasks = {"round": searched(even, **{"gears[2,4].start": (-0.4, 0.0)})}
    for name, (number, middle, given) in SHAPES.items():
        width = 0.1 * abs(middle)
        tasks[name] = searched(shaped(**given), **{number: (middle - width, middle + width)})
    return tasks


def main() -> None:
    """Print all comparisons."""
    print("one machine")
    tasks = {"scan at 36 000 crank angles": scan, "plant: everything": lambda: eq.plant(MACHINE)}
    report(in_turn(tasks, 20), "scan at 36 000 crank angles", 1e-3, "ms")
    print(f"\nall figures of {DESIGNS} designs, in ms a design")
    family = {"one by one": one_by_one, "together": together}
    report(in_turn(family, 5), "one by one", 1e-3 * DESIGNS, "ms")
    print(f"\n{JUDGED} designs of two arms on gears judged by a search, in ms a design")
    report(in_turn(searches(), 5), "round", 1e-3 * JUDGED, "ms")


if __name__ == "__main__":
    main()
