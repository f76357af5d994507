"""What a planting machine does in the field: its tip, travel, depth, tray and soil, as values.

They are part of the model; `equipoise.planting` computes with them.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from math import pi
from typing import Any, ClassVar, Literal

from equipoise.errors import ModelError
from equipoise.i18n import Note, key_names, to_say
from equipoise.keys import (
    ROW,
    File,
    Frozen,
    KeyConditions,
    KeyTable,
    Listing,
    Point,
    Tables,
    TextKind,
    Whole,
    declared,
    inside,
    key,
)
from equipoise.keys.csv_tables import CsvTable
from equipoise.mechanism.checks import FRAME, Bodies, Vector, numbered, unknown

WAYS = ("forward", "backward")
PARTS = ("resistance", "per_depth", "per_speed", "per_depth_and_speed")
"""Of the resistance of soil."""
EITHER = Note(
    "give either {forward_speed} or {hill_spacing}", **key_names("forward_speed", "hill_spacing")
)
RESISTS = Note("soil resists, give 0 or more")


@declared
class SoilTable(CsvTable):
    """Resistance of the soil against depth: linear between its rows, constant beyond them.

    depth : m below the surface, rising from 0 or more.  resistance : N, as long as `depth`.
    file : name of the CSV file that it came from.
    """

    sort = "soil"
    forms = (("depth", "resistance"),)

    depth: tuple[float, ...] = inside(ROW)
    resistance: tuple[float, ...] = inside(ROW)
    file: str = inside(TextKind(), default="", compare=False)


@declared
class Soil(Frozen):
    """What the soil does to the tip below its surface: a force against the motion over ground.

    Its size is the sum of all parts: `per_depth` times the depth of the tip, `per_speed` times its
    speed over ground, `per_depth_and_speed` times both, and the table's value at that depth.
    """

    called = to_say("{what} of the soil")

    resistance: float = key(
        "force", "constant part of the force", default=0.0, at_least=0, why=RESISTS
    )
    per_depth: float = key(
        "stiffness",
        "force for each unit of depth",
        default=0.0,
        at_least=0,
        why=RESISTS,
        word=to_say("resistance per depth"),
    )
    per_speed: float = key(
        "damping",
        "force for each unit of the tip's speed over ground",
        default=0.0,
        at_least=0,
        why=RESISTS,
        word=to_say("resistance per speed"),
    )
    per_depth_and_speed: float = key(
        "damping per length",
        "force for each unit of depth times speed",
        default=0.0,
        at_least=0,
        why=RESISTS,
        word=to_say("resistance per depth and speed"),
    )
    table: SoilTable | None = key(
        File("soil"),
        "CSV file beside this one: `depth [mm],resistance [N]`",
        default=None,
        example="soil.csv",
    )


FINGER_FROM = (
    "root of the finger, from which it points to the tip; the first other point of the tip's "
    "link if left out"
)
RELEASE = "crank angle at which the seedling is let go; the lowest point if left out"


@declared
class PlantingArm(Frozen):
    """A planting arm: a finger with its tip."""

    called = to_say("{what} of planting arm {tip}")

    tip: str = key(
        TextKind(of="point", on="links"),
        "point of a moving link that goes into the soil",
        example="Q",
    )
    finger_from: str | None = key(TextKind(of="point", on="links"), FINGER_FROM, default=None)
    release: float | None = key("angle", RELEASE, default=None)


@declared
class Planting(Frozen):
    """The planting finger and the field that it works in."""

    called = to_say("{what} of planting")
    file_order = ("tip", "forward_speed", "hill_spacing", "depth", "surface", "release",
             "acceleration_limit", "soil_acceleration_limit", "units_per_turn", "travel",
             "finger_from", "tray", "arms", "soil")  # fmt: skip
    conditions: ClassVar[KeyConditions] = {
        "allOf": [
            {"oneOf": [{"required": [item]}, {"required": [other]}]}
            for item, other in (("forward_speed", "hill_spacing"), ("depth", "surface"))
        ]
    }

    tip: str = key(
        TextKind(of="point", on="links"),
        "point of a moving link that goes into the soil",
        example="P",
    )
    forward_speed: float | None = key(
        "speed",
        "of the machine over ground, 0 or more",
        default=None,
        example="0.6 m/s",
        at_least=0,
        why=Note('give its size, and travel = "backward" for a machine that drives against x'),
    )
    depth: float | None = key(
        "length",
        "of the tip's lowest point below the surface",
        default=None,
        example="4 cm",
        above=0,
    )
    hill_spacing: float | None = key(
        "length",
        "of hills along a row, instead of `forward_speed`",
        default=None,
        example="15 cm",
        above=0,
    )
    units_per_turn: int = key(
        Whole(1),
        "hills that each arm plants in a row in one turn of the drive",
        default=1,
        at_least=1,
    )
    travel: Literal["forward", "backward"] = key(
        TextKind(WAYS),
        "`forward`: the machine drives along x, `backward`: against it",
        default="forward",
    )
    surface: float | None = key(
        "length", "height of the soil's surface in the frame, instead of `depth`", default=None
    )
    finger_from: str | None = key(TextKind(of="point", on="links"), FINGER_FROM, default=None)
    release: float | None = key("angle", RELEASE, default=None)
    tray: tuple[Vector, Vector] | None = key(
        Listing(Point(), (2,)),
        "both ends of the edge of the seedling tray, in the frame",
        default=None,
        word=to_say("point {number} of the tray"),
    )
    acceleration_limit: float | None = key(
        "acceleration", "largest acceleration of the tip that is wanted", default=None, above=0
    )
    soil_acceleration_limit: float | None = key(
        "acceleration", "the same while the tip is in the soil", default=None, above=0
    )
    soil: Soil | None = key(
        KeyTable(Soil), "what the soil does to the tip below its surface", default=None
    )

    arms: tuple[PlantingArm, ...] = key(
        Tables(KeyTable(PlantingArm)),
        "further arms of the same drive, such as the second one of a rotary transplanter",
        default=(),
    )

    @property
    def every_arm(self) -> tuple[PlantingArm, ...]:
        """All arms; the first is that of `tip`."""
        return (PlantingArm(self.tip, self.finger_from, self.release), *self.arms)

    @property
    def hills_per_turn(self) -> int:
        """Hills planted in a row in one turn of the drive, by all arms."""
        return self.units_per_turn * (1 + len(self.arms))

    def forward(self, speed: Any) -> Any:
        """Velocity of the machine along x, m/s, at a speed of the drive, rad/s."""
        if self.forward_speed is None:
            assert self.hill_spacing is not None
            size = self.hill_spacing * self.hills_per_turn * abs(speed) / (2 * pi)
        else:
            size = self.forward_speed
        return size if self.travel == "forward" else -size


def wrong_planting(planting: Planting | None, bodies: Bodies) -> Iterator[ModelError]:
    """Everything that is wrong with the planting values of a machine."""
    if planting is None:
        return
    wrong = list(_wrong_arms(planting, bodies))
    yield from wrong
    if wrong:
        return
    if (planting.forward_speed is None) == (planting.hill_spacing is None):
        yield ModelError("planting", EITHER)
    if (planting.depth is None) == (planting.surface is None):
        yield ModelError("planting", Note("give either depth or surface"))
    if planting.tray is not None and planting.tray[0] == planting.tray[1]:
        yield ModelError(
            "planting.tray", Note("its two points are the same; give both ends of the edge")
        )
    if planting.soil is None:
        return
    if not any(getattr(planting.soil, part) for part in (*PARTS, "table")):
        yield ModelError(
            "planting.soil", Note("give at least one of {names} and table", names=", ".join(PARTS))
        )
    if planting.soil.table is not None:
        yield from _wrong_table("planting.soil.table", planting.soil.table)


def _wrong_arms(planting: Planting, bodies: Bodies) -> Iterator[ModelError]:
    places = ["planting", *(where for where, _ in numbered("planting.arms", planting.arms))]
    tips: list[str] = []
    for where, arm in zip(places, planting.every_arm, strict=True):
        links = [name for name, points in bodies.items() if name != FRAME and arm.tip in points]
        if not links:
            moving = (bodies[name] for name in bodies if name != FRAME)
            known = dict.fromkeys(point for points in moving for point in points)
            yield ModelError(f"{where}.tip", unknown(arm.tip, known, "point of a moving link"))
            continue
        if arm.tip in tips:
            yield ModelError(
                f"{where}.tip",
                Note("got {tip!r} again; give each arm a tip of its own", tip=arm.tip),
            )
        tips.append(arm.tip)
        points = [point for point in bodies[links[0]] if point != arm.tip]
        if arm.finger_from is not None and arm.finger_from not in points:
            what = Note("other point of {link}, the tip's link,", link=links[0])
            yield ModelError(f"{where}.finger_from", unknown(arm.finger_from, points, what))


def _wrong_table(where: str, table: SoilTable) -> Iterator[ModelError]:
    if not table.depth:
        yield ModelError(where, Note("the table has no rows"))
    elif len(table.depth) != len(table.resistance):
        yield ModelError(where, Note("the columns differ in length"))
    elif table.depth[0] < 0 or any(b <= a for a, b in pairwise(table.depth)):
        yield ModelError(where, Note("the depths must rise from row to row, from 0 or more"))
    elif min(table.resistance) < 0:
        yield ModelError(
            where, Note("got {least:g} N; {right}", right=RESISTS, least=min(table.resistance))
        )
