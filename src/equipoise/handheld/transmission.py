"""Force on hands and harness under a unit force: (26) of Nagamine and Irie, with its phase."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from equipoise.errors import ModelError
from equipoise.handheld.model import PLANES, Excitation, Station, Tool
from equipoise.handheld.response import ToolResponse, checked_speeds, respond_tool
from equipoise.results.result import Result

Array = np.ndarray[Any, Any]

QUIET = 0.8
"""A dip is quiet where it lies below so much of the tops beside it, or of the ends of the range."""
ZOOMS, ACROSS = 6, 33
"""How often a lowest place is looked at more closely, and at how many speeds each time."""


@dataclass(frozen=True, eq=False)
class Transmission:
    """Force on the body at a station over the force that shakes, against speed.

    ratio : complex (2, S): vertical by a vertical force, lateral by a lateral one.
    quiet : speeds (rad/s) of each plane at which it is lowest between two resonances.
    lowest : amplitude of the ratio at these.
    """

    ratio: Array
    quiet: tuple[Array, Array]
    lowest: tuple[Array, Array]

    @property
    def size(self) -> Array:
        """Amplitude of the force over that of the force that shakes, (2, S)."""
        return np.abs(self.ratio)

    @property
    def phase(self) -> Array:
        """By which the force is ahead of that which shakes, rad, (2, S)."""
        return np.angle(self.ratio)


@dataclass(frozen=True, eq=False, repr=False)
class Transmissions(Result):
    """Of all stations where hands, a harness or the ground hold the tool.

    source : station at which a unit force shakes, once in a turn.
    speed : (S,), rad/s.
    stations : by name; hand, harness and ground there together.
    """

    tool: Tool
    source: str
    speed: Array
    stations: Mapping[str, Transmission]

    def to_dict(self) -> dict[str, Any]:
        """As plain values in SI units; speeds in rad/s."""
        return {
            "source": self.source,
            "speed": self.speed,
            "transmission": {
                name: {
                    "ratio": one.size[0],
                    "phase": one.phase[0],
                    "ratio_lateral": one.size[1],
                    "phase_lateral": one.phase[1],
                    "quiet_speeds": one.quiet[0],
                    "quiet_speeds_lateral": one.quiet[1],
                }
                for name, one in self.stations.items()
            },
        }


def source_of(tool: Tool) -> str:
    """The station at which the first excitation acts; the left end's where there is none."""
    if tool.excitations:
        return tool.excitations[0].station
    if not tool.stations:
        raise ModelError("shaft.stations", "there is none; add what sits on the shaft and holds it")
    return min(tool.stations, key=lambda one: one.position).name


def held(tool: Tool) -> list[Station]:
    """Stations at which the body or the ground holds the tool."""
    return [
        one
        for one in tool.stations
        if one.hand or one.harness or any(one.stiffness) or any(one.damping)
    ]


def transmit(tool: Tool, speed: Array, source: str | None = None) -> Transmissions:
    """Transmission of a unit force to hands, harness and ground, at speeds (S,), rad/s.

    source : station of the force; that of the first excitation if None.
    """
    speed = checked_speeds(speed)
    source = source_of(tool) if source is None else tool.station(source).name
    names = [one.name for one in held(tool)]
    if not names:
        raise ModelError("shaft.stations", "nothing holds the tool; give a hand or a harness")

    found = _unit(tool, speed, source)

    def one(name: str) -> Transmission:
        def again(speeds: Array) -> Array:
            return _unit(tool, speeds, source).whole_force(name)[:, 0]

        ratio = found.whole_force(name)[:, 0]
        (up, least_up), (across, least_across) = (
            lowest_places(speed, np.abs(row), plane, again) for plane, row in enumerate(ratio)
        )
        return Transmission(ratio, (up, across), (least_up, least_across))

    return Transmissions(tool, source, speed, {name: one(name) for name in names})


def _unit(tool: Tool, speed: Array, source: str) -> ToolResponse:
    """Under a force of 1 N in each plane; the planes know nothing of each other."""
    forces = tuple(
        Excitation(f"unit {plane}", source, force=1.0, direction=plane)  # type: ignore[arg-type]
        for plane in PLANES
    )
    return respond_tool(replace(tool, excitations=forces, design=None), speed)


def lowest_places(
    speed: Array, size: Array, plane: int, again: Callable[[Array], Array]
) -> tuple[Array, Array]:
    """Speeds at which a curve (S,) is lowest between higher ones, and how low it is there.

    again : computes the curve (2, S') at other speeds.
    """
    inner = _dips(size)
    low, high = speed[inner - 1], speed[inner + 1]
    lowest = size[inner]
    for _ in range(ZOOMS if inner.size else 0):
        across = low[:, None] + (high - low)[:, None] * np.linspace(0, 1, ACROSS)
        sizes = np.abs(again(across.ravel())[plane]).reshape(across.shape)
        best = np.clip(np.argmin(sizes, axis=1), 1, ACROSS - 2)[:, None]
        lowest = np.take_along_axis(sizes, best, 1)[:, 0]
        low = np.take_along_axis(across, best - 1, 1)[:, 0]
        high = np.take_along_axis(across, best + 1, 1)[:, 0]
    return (low + high) / 2, lowest


def _dips(size: Array) -> Array:
    """Where a curve (S,) is lowest between places that are clearly higher."""
    inner = np.flatnonzero((size[1:-1] < size[:-2]) & (size[1:-1] <= size[2:])) + 1
    ends = np.concatenate([[0], inner, [len(size) - 1]])
    kept = [
        k
        for before, k, after in zip(ends[:-2], inner, ends[2:], strict=True)
        if size[k] < QUIET * min(np.max(size[before : k + 1]), np.max(size[k : after + 1]))
    ]
    return np.array(kept, dtype=int)
