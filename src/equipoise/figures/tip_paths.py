"""Where a planting tip is along its paths: relative to the machine, and over ground."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cached_property
from math import floor, pi
from typing import TYPE_CHECKING

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.figures.style import short
from equipoise.i18n import say, to_say
from equipoise.mechanism.kinematics.motion import move
from equipoise.mechanism.kinematics.tip import TipCurve
from equipoise.planting.ground import GroundPath
from equipoise.results.charts import Array, Curve
from equipoise.symbols.scene import Scene

if TYPE_CHECKING:
    from equipoise.planting.summary import PlantingFigures

IN_TURN, SKETCHED = 720, 180
"""In a turn: places of the path that are drawn; crank angles by which ways of blocks are found."""
AHEAD = 2.5
"""Largest width of what is shown over ground, over its height."""
INSTANTS = {
    "pick-up": to_say("pick-up"),
    "entry": to_say("entry"),
    "lowest": to_say("lowest"),
    "release": to_say("release"),
    "exit": to_say("exit"),
}
"""Instant of a planting stroke -> in words."""


@dataclass(frozen=True)
class PathInstant:
    """An instant on a path: its name, place (m, complex) and direction away from the path, deg."""

    name: str
    place: complex
    away: float


class Paths:
    """Both paths of a machine in the sense of time, as places in m.

    ``way`` is the crank angle that the drive has turned, rad.
    """

    def __init__(self, figures: PlantingFigures) -> None:
        self.figures = figures
        self.curve: TipCurve = figures.curve
        self.ground = GroundPath(self.curve)
        self.sense = self.ground.sense
        self.level = figures["surface"]
        self.tray = np.array([complex(*end) for end in figures.planting.tray or ()], complex)

    @property
    def drives(self) -> bool:
        """Whether there is a path over ground."""
        return self.figures["forward_speed"] != 0

    @cached_property
    def scene(self) -> Scene:
        """The machine over its cycle and, last of all, at the lowest point of the tip."""
        cycle = np.linspace(0, self.curve.period, SKETCHED * self.curve.turns, endpoint=False)
        return Scene.of(move(self.figures.machine, [*cycle, self.figures["lowest.crank_angle"]]))

    def way_of(self, name: str, after: float = 0.0) -> float:
        """When an instant comes for the first time at or after another way."""
        way = self.sense * self.figures[f"{name}.crank_angle"]
        return after + float(np.mod(way - after, self.curve.period))

    @cached_property
    def start(self) -> float:
        """When the drawing of the path over ground begins: high up before a hill."""
        lowest = self.way_of("lowest")
        if self.curve.turns > 1:
            return lowest - pi
        return lowest - float(np.mod(lowest - self.way_of("highest"), self.curve.period))

    @cached_property
    def travel(self) -> float:
        """Crank angle over which the path over ground is drawn: two hills, or one long cycle."""
        return 2 * pi * max(2, min(self.curve.turns, 4))

    @cached_property
    def ways(self) -> Array:
        """Over which the path over ground is drawn."""
        return self.start + np.linspace(0, self.travel, round(IN_TURN * self.travel / (2 * pi)) + 1)

    @cached_property
    def cycle(self) -> Array:
        """Over which the path relative to the machine is drawn: closed."""
        return np.linspace(0, self.curve.period, IN_TURN * self.curve.turns + 1)

    def on_machine(self, ways: Array, arm: int = 0) -> Array:
        """Places relative to the machine."""
        places: Array = self.curve.arms[arm].at(self.sense * ways[None]).place[0]
        return places

    @cached_property
    def first_hill(self) -> float:
        """Place over ground at which the first arm lets a seedling go, m."""
        hill = self.way_of("release", self.way_of("entry", self.start))
        return float(self.ground.place(np.array([[hill]])).real[0, 0])

    def over_ground(self, ways: Array, arm: int = 0) -> Array:
        """Places over ground, counted from the first hill."""
        places: Array = self.on_machine(ways, arm) + self.ground.drive * ways - self.first_hill
        return places

    def of_further_arms(self, over_ground: bool) -> Iterator[Curve]:
        """Paths of the further arms, each with the name of its tip."""
        place, ways = (
            (self.over_ground, self.ways) if over_ground else (self.on_machine, self.cycle)
        )
        for number, arm in enumerate(self.figures.further, 1):
            label = say("path of {point}", point=short(arm.tip, 12))
            yield Curve.of(place(ways, number), label, f"several {number + 1}")

    def instants(self, over_ground: bool) -> Iterator[PathInstant]:
        """Instants of the first hill that is drawn, on either path; over ground no pick-up."""
        lowest = self.way_of("lowest", self.start)
        for name in [*INSTANTS][1:] if over_ground else INSTANTS:
            key = name.replace("-", "_")
            released = key != "release" or self.curve.arm.release is not None
            if f"{key}.crank_angle" in self.figures.figures and released:
                before = key in ("entry", "pick_up")
                way = self.way_of(key, lowest - self.curve.period if before else lowest)
                yield PathInstant(name, *self.place_and_away(way, over_ground))

    def place_and_away(self, way: float, over_ground: bool) -> tuple[complex, float]:
        """Where the tip is, and the direction (deg) that points out of its path."""
        interval = np.array([way, way + 1e-3])
        here, then = (self.over_ground if over_ground else self.on_machine)(interval)
        away = (then - here) * 1j * (1 if over_ground else self._turning)
        return complex(here), float(np.degrees(np.angle(away)))

    @cached_property
    def _turning(self) -> float:
        """1 where the left of the path relative to the machine is outside, else -1."""
        places = self.on_machine(self.cycle)
        area = float(np.sum(np.imag(np.conj(places[:-1]) * places[1:])))
        return -1.0 if area > 0 else 1.0

    def crossings(self) -> Iterator[complex]:
        """Places over ground at which loops cross themselves, as far as they are drawn."""
        period = self.curve.period
        for loop in self.figures.loops:
            first = self.sense * loop.first
            first += period * -floor((first - self.start) / period)
            while first + loop.way < self.start + self.travel:
                yield complex(self.over_ground(np.array([first]))[0])
                first += period

    def span_over_ground(self, high: float) -> tuple[float, float]:
        """From where to where that path is shown, m: less than two hills of a long way.

        high : of the panel, m.
        """
        x, most = self.over_ground(self.ways).real, AHEAD * high
        start, stop = float(np.min(x)), float(np.max(x))
        if stop - start <= most:
            return start, stop
        shares = (0.3, 0.7) if self.figures["forward_speed"] > 0 else (0.7, 0.3)
        return -most * shares[0], most * shares[1]
