"""What a planting machine does in the field: its tip, travel, depth, tray and soil, as values.

They are part of the model; `equipoise.planting` computes with them.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from itertools import pairwise
from math import pi
from typing import TYPE_CHECKING, ClassVar, Literal

from equipoise.errors import ModelError
from equipoise.mechanism.checks import unknown
from equipoise.mechanism.frozen import Frozen

if TYPE_CHECKING:
    from equipoise.mechanism.model import Machine, Vector

WAYS = ("forward", "backward")


@dataclass(frozen=True)
class SoilTable(Frozen):
    """Resistance of the soil against depth: linear between its rows, constant beyond them.

    depth : m below the surface, rising from 0 or more.  resistance : N, as long as `depth`.
    file : name of the CSV file that it came from.
    """

    shapes: ClassVar[dict[str, str]] = {"depth": "row", "resistance": "row", "file": "text"}

    depth: tuple[float, ...]
    resistance: tuple[float, ...]
    file: str = field(default="", compare=False)


@dataclass(frozen=True)
class Soil(Frozen):
    """What the soil does to the tip below its surface: a force against the motion over ground.

    Its size is the sum of `resistance` (N), `per_depth` (N/m) times the depth of the tip,
    `per_speed` (N s/m) times its speed over ground, `per_depth_and_speed` (N s/m2) times both, and
    the table's value at that depth.
    """

    shapes: ClassVar[dict[str, str]] = dict.fromkeys(
        ("resistance", "per_depth", "per_speed", "per_depth_and_speed"), "number"
    )

    resistance: float = 0.0
    per_depth: float = 0.0
    per_speed: float = 0.0
    per_depth_and_speed: float = 0.0
    table: SoilTable | None = None


@dataclass(frozen=True)
class Planting(Frozen):
    """The planting finger and the field that it works in.

    tip : point of a link that goes into the soil.
    forward_speed : of the machine over ground, m/s; or instead of it
    hill_spacing : distance of hills along a row, m, with units_per_turn hills in a turn of the
        drive.
    travel : whether the machine drives along x (forward) or against it (backward).
    depth : of the tip's lowest point below the soil's surface, m; or instead of it
    surface : height of the soil's surface in the frame, m.
    finger_from : point of the tip's link from which the finger points to the tip; None for the
        first other point of that link.
    release : crank angle (rad) at which the seedling is let go; None for the lowest point.
    tray : two points (m, in the frame): the edge of the seedling tray, where the finger picks up.
    acceleration_limit : largest acceleration of the tip that is wanted, m/s2.
    soil_acceleration_limit : the same while it is in the soil.
    """

    shapes: ClassVar[dict[str, str]] = {
        "tip": "text",
        "forward_speed": "number?",
        "hill_spacing": "number?",
        "units_per_turn": "count",
        "travel": "text",
        "depth": "number?",
        "surface": "number?",
        "finger_from": "text?",
        "release": "number?",
        "tray": "segment?",
        "acceleration_limit": "number?",
        "soil_acceleration_limit": "number?",
    }

    tip: str
    forward_speed: float | None = None
    depth: float | None = None
    hill_spacing: float | None = None
    units_per_turn: int = 1
    travel: Literal["forward", "backward"] = "forward"
    surface: float | None = None
    finger_from: str | None = None
    release: float | None = None
    tray: tuple[Vector, Vector] | None = None
    acceleration_limit: float | None = None
    soil_acceleration_limit: float | None = None
    soil: Soil | None = None

    def forward(self, speed: float) -> float:
        """Velocity of the machine along x, m/s, at a speed of the drive, rad/s."""
        if self.forward_speed is None:
            assert self.hill_spacing is not None
            size = self.hill_spacing * self.units_per_turn * abs(speed) / (2 * pi)
        else:
            size = self.forward_speed
        return size if self.travel == "forward" else -size


def wrong_planting(machine: Machine) -> Iterator[ModelError]:
    """Everything that is wrong with the planting values of a machine."""
    planting = machine.planting
    if planting is None:
        return
    links = [name for name, link in machine.links.items() if planting.tip in link.points]
    if not links:
        known = dict.fromkeys(point for link in machine.links.values() for point in link.points)
        yield ModelError("planting.tip", unknown(planting.tip, known, "point of a moving link"))
        return
    yield from _wrong_finger(planting, machine, links[0])
    yield from _wrong_travel(planting)
    if (planting.depth is None) == (planting.surface is None):
        yield ModelError("planting", "give either depth or surface")
    for key in ("depth", "acceleration_limit", "soil_acceleration_limit"):
        value = getattr(planting, key)
        if value is not None and value <= 0:
            yield ModelError(f"planting.{key}", f"got {value:g} in SI units; give more than 0")
    if planting.tray is not None and planting.tray[0] == planting.tray[1]:
        yield ModelError("planting.tray", "its two points are the same; give both ends of the edge")
    if planting.soil is not None:
        yield from _wrong_soil(planting.soil)


def _wrong_finger(planting: Planting, machine: Machine, link: str) -> Iterator[ModelError]:
    points = [point for point in machine.links[link].points if point != planting.tip]
    if planting.finger_from is not None and planting.finger_from not in points:
        yield ModelError(
            "planting.finger_from",
            unknown(planting.finger_from, points, f"other point of {link}, the tip's link,"),
        )


def _wrong_travel(planting: Planting) -> Iterator[ModelError]:
    if (planting.forward_speed is None) == (planting.hill_spacing is None):
        yield ModelError("planting", "give either forward_speed or hill_spacing")
        return
    if planting.travel not in WAYS:
        yield ModelError(
            "planting.travel", f"got {planting.travel!r}; give 'forward' (along x) or 'backward'"
        )
    if planting.forward_speed is not None and planting.forward_speed < 0:
        yield ModelError(
            "planting.forward_speed",
            f'got {planting.forward_speed:g} m/s; give its size, and travel = "backward" for a '
            "machine that drives against x",
        )
    if planting.hill_spacing is not None and planting.hill_spacing <= 0:
        yield ModelError(
            "planting.hill_spacing", f"got {planting.hill_spacing:g} m; give more than 0"
        )
    if planting.units_per_turn < 1:
        yield ModelError(
            "planting.units_per_turn", f"got {planting.units_per_turn}; give 1 or more"
        )


def _wrong_soil(soil: Soil) -> Iterator[ModelError]:
    values = {key: getattr(soil, key) for key in soil.shapes}
    for key, value in values.items():
        if value < 0:
            yield ModelError(
                f"planting.soil.{key}", f"got {value:g} in SI units; soil resists, give 0 or more"
            )
    if not any(values.values()) and soil.table is None:
        yield ModelError("planting.soil", f"give at least one of {', '.join(values)} and table")
    if soil.table is not None:
        yield from _wrong_table(soil.table)


def _wrong_table(table: SoilTable) -> Iterator[ModelError]:
    where = "planting.soil.table"
    if not table.depth:
        yield ModelError(where, "the table has no rows")
    elif len(table.depth) != len(table.resistance):
        yield ModelError(where, "the columns differ in length")
    elif table.depth[0] < 0 or any(b <= a for a, b in pairwise(table.depth)):
        yield ModelError(where, "the depths must rise from row to row, from 0 or more")
    elif min(table.resistance) < 0:
        yield ModelError(where, f"got {min(table.resistance):g} N; soil resists, give 0 or more")
