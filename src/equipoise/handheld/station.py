"""What sits on the shaft of a tool and holds it: frozen values in SI units, and their checks."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import pairwise
from typing import Any, ClassVar

import numpy as np

from equipoise.errors import ModelError, UsageError, at_place
from equipoise.i18n import Note, to_say
from equipoise.keys import (
    PLANES,
    ROW,
    Conditions,
    File,
    Frozen,
    KeyTable,
    Planes,
    Quantity,
    TextKind,
    Whole,
    declared,
    inside,
    key,
    keys_of,
)
from equipoise.keys.csv_tables import CsvTable
from equipoise.mechanism.checks import unknown
from equipoise.quantities import Dimension, Measured

Both = tuple[float, float]
"""One number for bending in the vertical plane, one for the lateral one."""
NOTHING: Both = (0.0, 0.0)
"""A stiffness or damping that is not there, in both planes."""


KEYS: dict[str, Dimension] = {
    "position": "length",
    "mass": "mass",
    "stiffness": "stiffness",
    "damping": "damping",
    "rotational_stiffness": "torsional stiffness",
    "rotational_damping": "torsional damping",
    "harness.stiffness": "stiffness",
    "harness.damping": "damping",
    "absorber.mass": "mass",
    "absorber.stiffness": "stiffness",
    "absorber.damping": "damping",
}
"""Numbers of a station that a design may change, each with its dimension."""


OF_HAND = ("mass", "stiffness", "damping")
"""What is said of a hand that has no measured impedance."""
STIFFNESS = Planes(Quantity(dimension="stiffness"))
DAMPING = Planes(Quantity(dimension="damping"))
INERTIA = Planes(Quantity(dimension="inertia"))
TURNING_STIFFNESS = Planes(Quantity(dimension="torsional stiffness"))
TURNING_DAMPING = Planes(Quantity(dimension="torsional damping"))


@declared
class Absorber(Frozen):
    """A mass on a spring and damper of its own."""

    called = to_say("{what} of the absorber")

    mass: float = key("mass", "of it", example="150 g", at_least=0)
    stiffness: Both = key(STIFFNESS, "between it and the shaft", example="50 kN/m", at_least=0)
    damping: Both = key(DAMPING, "between it and the shaft", default=NOTHING, at_least=0)


@declared
class Impedance(CsvTable):
    """Driving-point impedance of a hand against frequency, linear between its rows.

    frequency : Hz, rising.
    resistance, reactance : real and imaginary part, N s/m.
    file : name of the CSV file that it came from.
    """

    sort = "impedance"
    forms = (("frequency", "resistance", "reactance"), ("frequency", "magnitude", "phase"))
    columns: ClassVar[Mapping[str, tuple[Dimension, str]]] = {"resistance": ("damping", "N s/m")}

    frequency: tuple[float, ...] = inside(ROW)
    resistance: tuple[float, ...] = inside(ROW)
    reactance: tuple[float, ...] = inside(ROW)
    file: str = inside(TextKind(), default="", compare=False)


@declared
class Hand(Frozen):
    """What a hand with its arm is to the tool: mass, spring and damper, or a measured impedance.

    hands : how many hold on here; all else is of one.
    """

    called = to_say("{what} of the hand")
    conditions: ClassVar[Conditions] = {
        "if": {"required": ["impedance"]},
        "then": {"properties": dict.fromkeys(OF_HAND, False)},
        "else": {"anyOf": [{"required": [item]} for item in OF_HAND]},
    }

    mass: float = key("mass", "that moves with the tool", default=0.0, at_least=0)
    stiffness: Both = key(STIFFNESS, "to the body", default=NOTHING, at_least=0)
    damping: Both = key(DAMPING, "to the body", default=NOTHING, at_least=0)
    impedance: tuple[Impedance, ...] = key(
        Planes(File("impedance")),
        "CSV file beside this one, instead of these: `frequency [Hz],resistance [N s/m],"
        "reactance [N s/m]` or `frequency [Hz],magnitude [N s/m],phase [deg]`; a table for unlike "
        "planes",
        default=(),
        example="hand.csv",
    )
    hands: int = key(
        Whole(names=(1, 2)),
        "that hold on here; all else is of one",
        default=1,
        word=to_say("number of hands"),
    )


@declared
class Harness(Frozen):
    """The belt that carries the tool, as a spring and damper to the body."""

    called = to_say("{what} of the harness")

    stiffness: Both = key(STIFFNESS, "to the body", example="2 kN/m", at_least=0)
    damping: Both = key(DAMPING, "to the body", default=NOTHING, at_least=0)


@declared
class Station(Frozen):
    """A place of the shaft and what sits there."""

    called = to_say("{what} of the {name}")

    name: str = key(TextKind(), "by which the other tables call it", example="engine")
    position: float = key("length", "from the left end of the shaft", example="0 mm")
    mass: float = key("mass", "of a rigid body", default=0.0, at_least=0)
    inertia: Both = key(
        INERTIA,
        "of it, about the axes across the shaft, through the shaft",
        default=NOTHING,
        at_least=0,
    )
    stiffness: Both = key(STIFFNESS, "to the ground", default=NOTHING, at_least=0)
    damping: Both = key(DAMPING, "to the ground", default=NOTHING, at_least=0)
    rotational_stiffness: Both = key(
        TURNING_STIFFNESS, "to the ground, against bending", default=NOTHING, at_least=0
    )
    rotational_damping: Both = key(
        TURNING_DAMPING, "to the ground, against bending", default=NOTHING, at_least=0
    )
    absorber: Absorber | None = key(
        KeyTable(Absorber), "a mass on a spring and damper of its own", default=None
    )
    hand: Hand | None = key(KeyTable(Hand), "what a hand with its arm is to the tool", default=None)
    harness: Harness | None = key(KeyTable(Harness), "the belt that carries the tool", default=None)

    @property
    def grounded(self) -> bool:
        """Whether a spring or damper to the ground holds it."""
        return any(self.stiffness) or any(self.damping)

    def number(self, key: str) -> float | Both:
        """A number by its key, such as ``mass`` or ``harness.stiffness``, in SI units."""
        value: Any = self
        for part in key.split("."):
            value = getattr(value, part)
        result: float | Both = value
        return result


def has(station: Station, key: str) -> bool:
    """Whether a station has what a key's number belongs to."""
    owner, dot, _ = key.partition(".")
    return not dot or getattr(station, owner) is not None


def check_key(station: Station, key: str) -> None:
    """A station must have the number that a key names."""
    known = [name for name in KEYS if has(station, name)]
    if key not in KEYS:
        raise UsageError(unknown(key, known, Note("number of {name!r}", name=station.name)))
    if key not in known:
        raise UsageError(
            Note(
                "{name!r} has no {key}; give it one first",
                name=station.name,
                key=key.partition(".")[0],
            )
        )


def alike(part: Station | Hand | Harness | Absorber | None) -> bool:
    """Whether each pair of numbers of a station, or of what it holds, is of two equal ones."""
    if part is None:
        return True
    if isinstance(part, Hand) and len(part.impedance) == 2:
        return part.impedance[0] == part.impedance[1]
    of_planes = (item for item in keys_of(type(part)).values() if isinstance(item.kind, Planes))
    pairs = (
        value
        for of_plane in of_planes
        if len(value := getattr(part, of_plane.field)) == len(PLANES)
    )
    within = (part.absorber, part.hand, part.harness) if isinstance(part, Station) else ()
    return all(item == other for item, other in pairs) and all(map(alike, within))


def is_damped(station: Station) -> bool:
    """Whether anything but a hand's table takes power there."""
    parts = (station, station.absorber, station.hand, station.harness)
    dampers = [part.damping for part in parts if part is not None]
    return any(map(any, [*dampers, station.rotational_damping]))


# -- checks ----------------------------------------------------------------------------------------


def wrong_station(where: str, station: Station, length: float) -> Iterator[ModelError]:
    """Everything that is wrong with a station of a shaft that is so long (m)."""
    if not 0 <= station.position <= length:
        yield ModelError(
            f"{where}.position",
            Note(
                "got {position}, which is off the shaft; give {start} to {length}",
                position=Measured(station.position, "length"),
                start=Measured(0.0, "length", limit=True),
                length=Measured(length, "length"),
            ),
        )
    if station.hand is not None:
        yield from _wrong_hand(f"{where}.hand", station.hand)


def _wrong_hand(where: str, hand: Hand) -> Iterator[ModelError]:
    given = [name for name in OF_HAND if np.any(getattr(hand, name))]
    if hand.impedance and given:
        yield ModelError(
            f"{where}.{given[0]}", Note("has no place beside an impedance; leave it out")
        )
    elif not hand.impedance and not given:
        yield ModelError(
            where,
            Note("the hand has no properties; give mass, stiffness and damping, or an impedance"),
        )
    if len(hand.impedance) > 2:
        yield ModelError(
            f"{where}.impedance",
            Note(
                "got {impedance} tables; give one, or one for each plane",
                impedance=len(hand.impedance),
            ),
        )
    for table in hand.impedance:
        what = _wrong_rows(table)
        if what:
            what = at_place(table.file, what) if table.file else what
            yield ModelError(f"{where}.impedance", what)


def _wrong_rows(table: Impedance) -> Note | None:
    rows = len(table.frequency)
    if {rows} != {len(table.resistance), len(table.reactance)}:
        return Note("the columns differ in length")
    if rows < 2:
        return Note("the table has fewer than two rows; a curve needs two")
    if any(b <= a for a, b in pairwise(table.frequency)):
        return Note("the frequencies must rise from row to row")
    if table.frequency[0] <= 0:
        return Note(
            "the first frequency is {frequency:g} Hz; give more than 0",
            frequency=table.frequency[0],
        )
    least = min(table.resistance)
    if least >= 0:
        return None
    at = table.frequency[table.resistance.index(least)]
    return Note(
        "the resistance at {at:g} Hz is {least:g} N s/m; a hand only takes "
        "energy away, give 0 or more",
        at=at,
        least=least,
    )
