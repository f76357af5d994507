"""What sits on the shaft of a tool and holds it: frozen values in SI units, and their checks."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Any, ClassVar

from equipoise.errors import ModelError
from equipoise.handheld.shaft import negative
from equipoise.keys import Frozen

Both = tuple[float, float]
"""One number for bending in the vertical plane, one for the lateral one."""


NOTHING: Both = (0.0, 0.0)


@dataclass(frozen=True)
class Absorber(Frozen):
    """A mass (kg) on a spring (N/m) and damper (N s/m) of its own."""

    shapes: ClassVar[dict[str, str]] = {"mass": "number", "stiffness": "pair", "damping": "pair"}

    mass: float
    stiffness: Both
    damping: Both = NOTHING


@dataclass(frozen=True)
class Impedance(Frozen):
    """Driving-point impedance of a hand against frequency, linear between its rows.

    frequency : Hz, rising.
    resistance, reactance : real and imaginary part, N s/m.
    file : name of the CSV file that it came from.
    """

    shapes: ClassVar[dict[str, str]] = {
        **dict.fromkeys(("frequency", "resistance", "reactance"), "row"),
        "file": "text",
    }

    frequency: tuple[float, ...]
    resistance: tuple[float, ...]
    reactance: tuple[float, ...]
    file: str = field(default="", compare=False)


@dataclass(frozen=True)
class Hand(Frozen):
    """What a hand with its arm is to the tool: mass, spring and damper, or a measured impedance.

    mass : that moves with the tool, kg.
    stiffness, damping : to the body, N/m and N s/m.
    impedance : instead of these, for the vertical and the lateral plane.
    hands : how many hold on here; all else is of one.
    """

    shapes: ClassVar[dict[str, str]] = {
        "mass": "number",
        "stiffness": "pair",
        "damping": "pair",
        "impedance": "list",
        "hands": "count",
    }

    mass: float = 0.0
    stiffness: Both = NOTHING
    damping: Both = NOTHING
    impedance: tuple[Impedance, ...] = ()
    hands: int = 1


@dataclass(frozen=True)
class Harness(Frozen):
    """The belt that carries the tool, as a spring (N/m) and damper (N s/m) to the body."""

    shapes: ClassVar[dict[str, str]] = {"stiffness": "pair", "damping": "pair"}

    stiffness: Both
    damping: Both = NOTHING


@dataclass(frozen=True)
class Station(Frozen):
    """A place of the shaft and what sits there.

    position : from the left end, m.
    mass, inertia : kg; kg m2 about the axes across the shaft, through the shaft.
    stiffness, damping : to the ground, N/m and N s/m.
    rotational_stiffness, rotational_damping : to the ground, N m/rad and N m s/rad.
    """

    shapes: ClassVar[dict[str, str]] = {
        "name": "text",
        "position": "number",
        "mass": "number",
        **dict.fromkeys(
            ("inertia", "stiffness", "damping", "rotational_stiffness", "rotational_damping"),
            "pair",
        ),
    }

    name: str
    position: float
    mass: float = 0.0
    inertia: Both = NOTHING
    stiffness: Both = NOTHING
    damping: Both = NOTHING
    rotational_stiffness: Both = NOTHING
    rotational_damping: Both = NOTHING
    absorber: Absorber | None = None
    hand: Hand | None = None
    harness: Harness | None = None

    def number(self, key: str) -> float | Both:
        """A number by its key, such as ``mass`` or ``harness.stiffness``, in SI units."""
        value: Any = self
        for part in key.split("."):
            value = getattr(value, part)
        found: float | Both = value
        return found


def alike(part: Station | Hand | Harness | Absorber | None) -> bool:
    """Whether each pair of numbers of a station, or of what it holds, is of two equal ones."""
    if part is None:
        return True
    if isinstance(part, Hand) and len(part.impedance) == 2:
        return part.impedance[0] == part.impedance[1]
    pairs = (getattr(part, name) for name, shape in part.shapes.items() if shape == "pair")
    within = (part.absorber, part.hand, part.harness) if isinstance(part, Station) else ()
    return all(one == other for one, other in pairs) and all(map(alike, within))


def is_damped(station: Station) -> bool:
    """Whether anything but a hand's table takes power there."""
    parts = (station, station.absorber, station.hand, station.harness)
    dampers = [part.damping for part in parts if part is not None]
    return any(map(any, [*dampers, station.rotational_damping]))


# -- checks ----------------------------------------------------------------------------------------

RATES = ("stiffness", "damping", "rotational_stiffness", "rotational_damping")


def wrong_station(where: str, station: Station, length: float) -> Iterator[ModelError]:
    """Everything that is wrong with a station of a shaft that is so long (m)."""
    if not 0 <= station.position <= length:
        yield ModelError(
            f"{where}.position",
            f"got {station.position:g} m, which is off the shaft; give 0 m to {length:g} m",
        )
    yield from negative(where, station, "mass", "inertia", *RATES)
    if station.absorber is not None:
        yield from negative(f"{where}.absorber", station.absorber, "mass", "stiffness", "damping")
    if station.harness is not None:
        yield from negative(f"{where}.harness", station.harness, "stiffness", "damping")
    if station.hand is not None:
        yield from _wrong_hand(f"{where}.hand", station.hand)


def _wrong_hand(where: str, hand: Hand) -> Iterator[ModelError]:
    yield from negative(where, hand, "mass", "stiffness", "damping")
    if hand.hands not in (1, 2):
        yield ModelError(f"{where}.hands", f"got {hand.hands}; give 1 or 2")
    given = [key for key in ("mass", "stiffness", "damping") if _is_given(getattr(hand, key))]
    if hand.impedance and given:
        yield ModelError(f"{where}.{given[0]}", "has no place beside an impedance; leave it out")
    elif not hand.impedance and not given:
        yield ModelError(
            where, "nothing is said of the hand; give mass, stiffness and damping, or an impedance"
        )
    if len(hand.impedance) > 2:
        yield ModelError(
            f"{where}.impedance",
            f"got {len(hand.impedance)} tables; give one, or one for each plane",
        )
    for table in hand.impedance:
        yield from _wrong_impedance(f"{where}.impedance", table)


def _is_given(value: float | tuple[float, float]) -> bool:
    return any(value) if isinstance(value, tuple) else value != 0


def _wrong_impedance(where: str, table: Impedance) -> Iterator[ModelError]:
    """What is wrong with a table, with the name of its file where it has one."""
    what = _wrong_rows(table)
    if what:
        yield ModelError(where, f"{table.file}: {what}" if table.file else what)


def _wrong_rows(table: Impedance) -> str:
    rows = len(table.frequency)
    if {rows} != {len(table.resistance), len(table.reactance)}:
        return "the columns differ in length"
    if rows < 2:
        return "the table has fewer than two rows; a curve needs two"
    if any(b <= a for a, b in pairwise(table.frequency)):
        return "the frequencies must rise from row to row"
    if table.frequency[0] <= 0:
        return f"the first frequency is {table.frequency[0]:g} Hz; give more than 0"
    least = min(table.resistance)
    if least >= 0:
        return ""
    at = table.frequency[table.resistance.index(least)]
    return (
        f"the resistance at {at:g} Hz is {least:g} N s/m; a hand only takes energy away, give 0 or "
        "more"
    )
