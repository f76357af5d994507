"""Random machines whose driven link does not turn with the crank angle."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from equipoise.mechanism.parts.laws import AngleLaw, AngleSegment
from equipoise.mechanism.parts.machine import FurtherDrive
from support.driving import FORMULAS

if TYPE_CHECKING:
    from support.machines import Case

Maker = Callable[[np.random.Generator], "Case"]
Law = Callable[[np.random.Generator], AngleLaw]
TURN = 2 * np.pi


def moved(maker: Maker, law: Law | None = None) -> Maker:
    """Return a maker of such machines whose crank follows a motion law, by default a sine."""

    def made(rng: np.random.Generator) -> Case:
        case = maker(rng)
        drive = replace(case.machine.drive, motion=(law or swing)(rng))
        return replace(case, machine=replace(case.machine, drive=drive))

    made.__name__ = f"moved_{maker.__name__}"
    return made


def two_driven(maker: Maker) -> Maker:
    """Return a maker of such machines whose gears are replaced by drives of the driven gears."""

    def five_bar(rng: np.random.Generator) -> Case:
        case = maker(rng)
        drives = []
        for gear in case.machine.gears:
            turning = FurtherDrive(gear.driven, round(gear.speed_ratio * 12) / 12, gear.start)
            swinging = FurtherDrive(gear.driven, motion=swing(rng))
            drives.append(swinging if rng.random() < 0.5 else turning)
        machine = replace(case.machine, gears=(), drives=tuple(drives))
        return replace(case, machine=machine)

    return five_bar


def swing(rng: np.random.Generator) -> AngleLaw:
    """Draw a swing by a sine."""
    low, high = map(float, rng.uniform(-4, 4, 2))
    return AngleLaw(between=(low, high), phase=float(rng.uniform(-3, 3)))


def steps(rng: np.random.Generator) -> AngleLaw:
    """Draw segments with a dwell that come back or gain a turn, in one turn or two."""
    turns, phase = int(rng.integers(1, 3)), float(rng.uniform(-3, 3))
    low, high = map(float, rng.uniform(-4, 4, 2))
    shares = rng.uniform(0.5, 1.0, 4)
    overs = [float(item) for item in TURN * turns * shares / shares.sum()]
    overs[-1] = TURN * turns - sum(overs[:-1])
    middle = float(rng.uniform(-4, 4))
    last = low + float(rng.choice([-TURN, 0.0, TURN]))
    laws = rng.choice(sorted(FORMULAS), 4)
    segments = tuple(
        AngleSegment(over, to, str(law))
        for over, to, law in zip(overs, (middle, high, high, last), laws, strict=True)
    )
    return AngleLaw(start=low, segments=segments, turns=turns, phase=phase)
