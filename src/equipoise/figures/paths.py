"""The path of the tip relative to the machine, and beside it, to the same scale, over ground."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from math import floor, pi
from typing import TYPE_CHECKING, Any

import numpy as np

from equipoise.mechanism.motion import move
from equipoise.mechanism.tip import TipCurve
from equipoise.planting.ground import GroundPath
from equipoise.symbols.scene import Scene

if TYPE_CHECKING:
    from equipoise.planting.summary import PlantingFigures

Array = np.ndarray[Any, Any]

IN_TURN = 720
"""Places of the path in a turn that are drawn."""
SKETCHED = 180
"""Crank angles in a turn by which the ways of blocks are found."""
AHEAD = 2.5
"""Largest width of what is shown over ground, over its height."""


@dataclass(frozen=True)
class Instant:
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

    @cached_property
    def tray(self) -> Array:
        """Both ends of the tray's edge, complex, m; empty where there is none."""
        return np.array([complex(*point) for point in self.figures.planting.tray or ()], complex)

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

    def on_machine(self, ways: Array) -> Array:
        """Places relative to the machine."""
        places: Array = self.curve.at(self.sense * ways[None]).place[0]
        return places

    def over_ground(self, ways: Array) -> Array:
        """Places over ground, counted from the first hill."""
        hill = self.way_of("release", self.way_of("entry", self.start))
        origin = float(self.ground.place(np.array([[hill]])).real[0, 0])
        places: Array = self.ground.place(ways[None])[0] - origin
        return places

    def in_soil(self, places: Array) -> Array:
        """The places below the surface, others as NaN."""
        return np.where(places.imag <= self.level, places, complex(np.nan, np.nan))

    def instants(self, names: tuple[str, ...], over_ground: bool) -> Iterator[Instant]:
        """Instants on either path."""
        for name in names:
            key = name.replace("-", "_")
            if f"{key}.crank_angle" not in self.figures.figures:
                continue
            if key == "release" and self.figures.planting.release is None:
                continue
            yield Instant(name, *self.place_and_away(self._way_of_hill(key), over_ground))

    def _way_of_hill(self, name: str) -> float:
        """When an instant of the first hill that is drawn comes."""
        lowest = self.way_of("lowest", self.start)
        before = name in ("entry", "pick_up")
        return self.way_of(name, lowest - self.curve.period if before else lowest)

    def place_and_away(self, way: float, over_ground: bool) -> tuple[complex, float]:
        """Where the tip is, and the direction (deg) that points out of its path."""
        near = np.array([way, way + 1e-3])
        here, then = (self.over_ground if over_ground else self.on_machine)(near)
        away = (then - here) * 1j * (self._turning if not over_ground else 1)
        return complex(here), float(np.degrees(np.angle(away)))

    @cached_property
    def _turning(self) -> float:
        """1 where the left of the path relative to the machine is outside, else -1."""
        places = self.on_machine(self.cycle)
        area = float(np.sum(np.imag(np.conj(places[:-1]) * places[1:])))
        return -1.0 if area > 0 else 1.0

    def crossings(self) -> Iterator[complex]:
        """Places over ground at which loops cross themselves, as far as they are drawn."""
        for loop in self.figures.loops:
            first = self.sense * loop.first
            period = self.curve.period
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
