"""From a tool to its chain: nodes, hands, what sits there at a complex frequency; its answer."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import field
from functools import cached_property
from math import ceil, pi
from typing import Any, Literal, NamedTuple

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.errors import ModelError, UsageError
from equipoise.handheld.chain import (
    Chain,
    Dual,
    NodePair,
    States,
    Transfer,
    longest,
    shear_transfer,
    transfer,
    value_of,
)
from equipoise.handheld.model import Impedance, Station, Tool
from equipoise.handheld.shaft import Section
from equipoise.i18n import Note
from equipoise.signals import Array

TOUCHING = 1e-9
"""Share by which a frequency may pass the end of a table for rounding."""


def impedance(tables: Sequence[Impedance], s: Any) -> Array:
    """Force over velocity (2, F), N s/m, of both planes at s = i omega, 1/s."""
    frequency = np.abs(np.imag(value_of(s))) / (2 * pi)
    rows = np.broadcast_to(frequency, (2, frequency.shape[-1]))
    numbers = []
    for table, row in zip((tables[0], tables[-1]), rows, strict=True):
        values = np.array(table.resistance) + 1j * np.array(table.reactance)
        numbers.append(np.interp(row, table.frequency, values))
    return np.array(numbers)


def check_coverage(tool: Tool, lowest: float, highest: float) -> None:
    """What is known of a tool must reach from the lowest to the highest frequency, rad/s.

    Raises
    ------
    ModelError : says where a hand's table begins or ends; as `check_waves`.
    """
    check_waves(tool, highest)
    low, high = lowest / (2 * pi), highest / (2 * pi)
    for number, station in enumerate(tool.stations, 1):
        for table in station.hand.impedance if station.hand is not None else ():
            first, last = table.frequency[0], table.frequency[-1]
            if first <= low * (1 + TOUCHING) and last >= high * (1 - TOUCHING):
                continue
            raise ModelError(
                f"shaft.stations[{number}].hand.impedance",
                Note(
                    "{table} reaches from {first:.4g} Hz to {last:.4g} Hz, but "
                    "{low:.4g} Hz to {high:.4g} Hz are asked for; measure the rest too, or "
                    "ask for speeds whose orders lie within the table",
                    table=Note("the table {file}", file=table.file)
                    if table.file
                    else Note("the table"),
                    first=first,
                    last=last,
                    low=low,
                    high=high,
                ),
            )


ChainKind = Literal["undamped", "free", "forced"]
"""What counts: masses and springs; all that is known at any complex frequency; tables of hands too,
which are known at real frequencies alone."""
MOST_CELLS, MOST_SHAKEN = 1000, 100
"""Cells of a shaft, some four of each wave, and of one that is shaken: far beyond any tool."""
TUNED, NEARLY_NOTHING = 1e-15, 1e-200
"""Share of its stiffness by which an undamped absorber misses its own frequency, and what one
without mass and spring is divided by."""


class ShaftCell(NamedTuple):
    """A segment between two nodes."""

    start: float
    length: float
    section: Section


class Beam(NamedTuple):
    """Coefficients of the equations of `chain`: 1 / EI, 1 / kGA, rho A s^2 and rho I s^2."""

    flexibility: Any
    shear: Any
    mass: Any
    rotary: Any


def check_waves(tool: Tool, highest: float, most: int = MOST_SHAKEN) -> None:
    """At the highest frequency, rad/s, the shaft must not need more than so many cells.

    Raises
    ------
    ModelError : says how short its waves are.
    """
    pieces = tool.shaft.pieces
    if sum((stop - start) / _longest(item, highest) for start, stop, item in pieces) > most:
        wave = 4 * min(_longest(item, highest) for *_, item in pieces)
        raise ModelError(
            "shaft",
            Note(
                "at {highest:.4g} Hz its waves are some {wave:.2g} m long, too short for "
                "{length:.4g} m; check its length, stiffness and mass, and the speeds",
                highest=highest / (2 * pi),
                wave=wave,
                length=tool.shaft.length,
            ),
        )


def _longest(section: Section, frequency: float) -> float:
    """Length of a cell at most, m."""
    flexibility, shear = 1 / section.bending_stiffness, 1 / section.shear_stiffness
    return longest(frequency, flexibility, shear, section.mass_per_length, section.rotary_inertia)


@dataclass(frozen=True, eq=False)
class Layout:
    """The nodes of a tool, fine enough for all frequencies up to `highest`, rad/s.

    changed : numbers of stations that stand in the place of the tool's, by name and key; all but
        positions with or without derivatives.  A position here has a cell on both sides, if without
        length, by whose length it moves.
    """

    tool: Tool
    highest: float
    changed: Mapping[tuple[str, str], Any] = field(default_factory=dict)

    def of(self, station: Station, key: str) -> Any:
        """A number of a station; of a pair, both planes as (2, 1)."""
        if (station.name, key) in self.changed:
            return self.changed[station.name, key]
        value = station.number(key)
        return np.array(value)[:, None] if isinstance(value, tuple) else value

    @cached_property
    def _laid(self) -> tuple[list[list[Station]], list[ShaftCell]]:
        """Stations of each node, and the cells between the nodes."""
        shaft = self.tool.shaft
        check_waves(self.tool, self.highest, MOST_CELLS)
        points: list[tuple[float, Station | None]] = [(0.0, None)]
        points += [(stop, None) for _, stop, _ in shaft.pieces]
        points += [(self.of(station, "position"), station) for station in self.tool.stations]
        points.sort(key=_order)
        nodes: list[list[Station]] = [[]]
        cells: list[ShaftCell] = []
        before, moved = 0.0, False
        for at, station in points:
            moves = station is not None and (station.name, "position") in self.changed
            if at > before or moves or moved:
                new = self._cells(before, at - before)
                cells += new
                nodes += [[] for _ in new]
            if station is not None:
                nodes[-1].append(station)
            before, moved = at, moves
        return nodes, cells

    def _cells(self, left: float, length: float) -> list[ShaftCell]:
        """Segments of one section, none of which is too long."""
        pieces, middle = self.tool.shaft.pieces, left + length / 2
        section = next((item for _, stop, item in pieces if middle <= stop), pieces[-1][2])
        parts = max(1, ceil(length / _longest(section, self.highest)))
        return [ShaftCell(left + k * length / parts, length / parts, section) for k in range(parts)]

    @property
    def nodes(self) -> list[list[Station]]:
        """Stations of each node (N)."""
        return self._laid[0]

    @property
    def cells(self) -> list[ShaftCell]:
        """Segments (N - 1)."""
        return self._laid[1]

    @cached_property
    def node_of(self) -> dict[str, int]:
        """Number of the node at which each station sits."""
        return {station.name: k for k, stations in enumerate(self.nodes) for station in stations}

    def chain(self, s: Any, kind: ChainKind = "forced") -> Chain:
        """The chain at complex frequencies s (1 or 2, F), 1/s; a row for each plane.

        Without damping s^2 is negative, and all is real.
        """
        square = np.real(s * s) if kind == "undamped" else s * s
        stations = [self.station_impedance(stations, s, square, kind) for stations in self.nodes]
        if isinstance(square, Dual):  # the cells come before the planes
            square = Dual(square.value[None], square.slopes[:, None])
        lengths = _column([cell.length for cell in self.cells])
        whole = self._transfers(self.cells, lengths, square, kind)
        return Chain([whole.part(k) for k in range(len(self.cells))], stations)

    def part(self, which: Array, length: Array, s: Array, kind: ChainKind) -> Transfer:
        """Transfer matrices (X, 1 or 2, F) from the left end of some cells (X) over a length, m."""
        square = np.real(s * s) if kind == "undamped" else s * s
        return self._transfers([self.cells[k] for k in which], length[:, None, None], square, kind)

    def _transfers(
        self, cells: list[ShaftCell], length: Any, square: Any, kind: ChainKind
    ) -> Transfer:
        """Transfer matrices (C, 1 or 2, F) from the left end of cells over lengths (C, 1, 1), m."""
        beam = self.beam(cells, square, kind)
        if self.tool.shaft.theory != "timoshenko":
            return transfer(length, beam.flexibility, beam.mass)
        return shear_transfer(length, *beam)

    def beam(self, cells: list[ShaftCell], square: Any, kind: ChainKind) -> Beam:
        """The coefficients (C, 1 or 2, F) of cells (C)."""
        sections, factor = [cell.section for cell in cells], self.tool.shaft.loss_factor
        loss = 1 + 1j * factor if factor and kind != "undamped" else 1.0
        return Beam(
            _column([1 / section.bending_stiffness for section in sections]) / loss,
            _column([1 / section.shear_stiffness for section in sections]) / loss,
            _column([section.mass_per_length for section in sections]) * square,
            _column([section.rotary_inertia for section in sections]) * square,
        )

    def station_impedance(
        self, stations: Sequence[Station], s: Any, square: Any, kind: ChainKind
    ) -> NodePair:
        """Dynamic stiffness of what sits at a node."""
        across: Any = np.zeros((2, 1))
        turning: Any = np.zeros((2, 1))
        for station in stations:
            across = sum(self.holding(station, s, kind).values(), start=across)
            across = across + self.mass_at(station) * square
            turning = turning + self._spring(station, "rotational_", s, kind)
            turning = turning + self.of(station, "inertia") * square
            if station.absorber is not None:
                across = across + self.absorber(station, s, square, kind)
        return NodePair(across, turning)

    def mass_at(self, station: Station) -> Any:
        """Mass that moves with a station, kg: its own, and that of the hands on it."""
        hand = station.hand
        return self.of(station, "mass") + (0.0 if hand is None else hand.hands * hand.mass)

    def holding(self, station: Station, s: Any, kind: ChainKind = "forced") -> dict[str, Any]:
        """Dynamic stiffness (N/m) of what holds a station: ``ground``, ``harness``, ``hand``."""
        values = {"ground": self._spring(station, "", s, kind)}
        if station.harness is not None:
            values["harness"] = self._spring(station, "harness.", s, kind)
        hand = station.hand
        if hand is not None and not hand.impedance:
            values["hand"] = hand.hands * self._spring(station, "hand.", s, kind)
        elif hand is not None and kind == "forced":
            values["hand"] = hand.hands * impedance(hand.impedance, s) * s
        return values

    def on_body(self, station: Station, s: Any) -> dict[str, Any]:
        """Force over displacement (N/m) on what holds a station; on a hand with its own mass."""
        values = self.holding(station, s)
        if station.hand is not None:
            values["hand"] = values["hand"] + station.hand.hands * station.hand.mass * s * s
        return values

    def _spring(self, station: Station, owner: str, s: Any, kind: ChainKind) -> Any:
        stiffness = self.of(station, f"{owner}stiffness")
        if kind == "undamped":
            return stiffness
        return stiffness + self.of(station, f"{owner}damping") * s

    def absorber(self, station: Station, s: Any, square: Any, kind: ChainKind) -> Any:
        """A mass behind a spring: m s^2 k / (k + m s^2)."""
        spring = self._spring(station, "absorber.", s, kind)
        inertia = self.of(station, "absorber.mass") * square
        below = spring + inertia
        if np.any(value_of(below) == 0):
            below = below + (TUNED * np.abs(value_of(spring)) + NEARLY_NOTHING)
        return spring * inertia / below

    def absorbers(self, s: Any, kind: ChainKind) -> list[Any]:
        """What the dynamic stiffness of each absorber is divided by, k + m s^2, (2, F), N/m."""
        return [
            self._spring(station, "absorber.", s, kind)
            + self.of(station, "absorber.mass") * (s * s)
            for station in self.tool.stations
            if station.absorber is not None
        ]


def _order(point: tuple[float, Station | None]) -> tuple[float, bool]:
    """By place; a station at the right end stands before it, so that it can move inward."""
    place, station = point
    return place, station is None and place > 0


def _column(numbers: list[float]) -> Array:
    return np.array(numbers)[:, None, None]


class ShaftDeflection(NamedTuple):
    """Of some places (X) of the shaft, in both planes: arrays (X, 2, F).

    displacement (m) and slope (rad); moment (N m) and shear (N), just right of a station.
    """

    displacement: Array
    slope: Array
    moment: Array
    shear: Array


@dataclass(frozen=True, eq=False)
class HarmonicField:
    """The answer of a layout at complex frequencies s (1 or 2, F)."""

    layout: Layout
    s: Array
    states: States
    kind: ChainKind = "forced"

    def at(self, places: Array) -> ShaftDeflection:
        """Shape at some places (X), m from the left end.

        Raises
        ------
        UsageError : a place is off the shaft.
        """
        places = np.asarray(places, dtype=float)
        length = self.layout.tool.shaft.length
        if np.any((places < 0) | (places > length)):
            raise UsageError(
                Note("got a place off the shaft; give places from 0 to {length:g} m", length=length)
            )
        starts = np.array([cell.start for cell in self.layout.cells])
        which = np.clip(np.searchsorted(starts, places, "right") - 1, 0, len(starts) - 1)
        over = self.layout.part(which, places - starts[which], self.s, self.kind)
        w, t = (np.array(part)[which] for part in zip(*self.states.motion, strict=True))
        v, m = (np.array(part)[which] for part in zip(*self.states.force, strict=True))
        displacement, slope, shear, moment = over.carried(w, t, v, m)
        return ShaftDeflection(displacement, slope, moment, shear)
