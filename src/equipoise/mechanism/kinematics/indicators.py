"""Indicator diagrams over the crank angle: where the motion of the piston passes their rows."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from itertools import pairwise
from math import ceil, pi

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.errors import ModelError, MotionError
from equipoise.i18n import Note
from equipoise.mechanism.assembly.linkage import Linkage
from equipoise.mechanism.kinematics.motion import move
from equipoise.mechanism.kinematics.strokes import dead_positions
from equipoise.mechanism.parts.loads import ALIKE, GasTable, IndicatorDiagram, Load
from equipoise.quantities import Dimension
from equipoise.quantities.numbers import format_quantity
from equipoise.signals import Array

STEP, FINER = 2 * pi / 360, 4
"""rad: crank angles between which pressure is linear, beside those of the rows of a diagram; and
parts of it in which the way of the piston is taken for a straight line, to find those."""
BESIDE, SAME = 1e-4, 1e-9
"""rad between rows at one place, where pressure jumps; and between crank angles that are one."""

Travel = Callable[[Array], Array]
"""Way of a piston, m, from its dead centre at the gas (N,), at crank angles in time (N,), rad."""


def loads_of(linkage: Linkage) -> tuple[Load, ...]:
    """Loads of a linkage, each by the crank angle: with gas for an indicator diagram.

    Raises
    ------
    ModelError : a diagram does not fit the strokes of its piston.
    """
    loads = linkage.machine.loads
    if all(load.indicator is None for load in loads):
        return loads
    known: tuple[Load, ...] | None = linkage.memory.get("loads")
    if known is None:
        known = tuple(_by_angle(linkage, f"loads[{k}]", load) for k, load in enumerate(loads, 1))
        linkage.memory["loads"] = known
    return known


def _by_angle(linkage: Linkage, where: str, load: Load) -> Load:
    """A load with the gas of its diagram over the crank angle; itself without one."""
    diagram = load.indicator
    if diagram is None:
        return load
    assert load.area is not None
    try:
        strokes = _Strokes.of(linkage, load)
    except MotionError as error:
        note = Note("an indicator diagram needs a crank that turns fully: {what}", what=error.note)
        raise ModelError(f"{where}.indicator", note) from error
    own = diagram.span / (load.area if diagram.over == "volume" else 1.0)
    if abs(own - strokes.length) > ALIKE * strokes.length:
        raise ModelError(f"{where}.indicator", _other_stroke(diagram, load.area, strokes.length))
    if (row := _row_elsewhere(diagram, strokes)) is not None:
        raise ModelError(f"{where}.indicator", _no_dead_centre(diagram, row, strokes))
    angle, pressure = _pressures(diagram, strokes)
    if strokes.sense < 0:
        angle, pressure = -angle[::-1], pressure[::-1]
    gas = GasTable(tuple(angle.tolist()), tuple(pressure.tolist()), diagram.file)
    return replace(load, indicator=None, gas=gas)


def _row_elsewhere(diagram: IndicatorDiagram, strokes: _Strokes) -> int | None:
    """The first row at which a diagram turns back at no dead centre of its piston; None where it
    fits.  It then turns back as often, or a fraction of that, as its turns are in the cycle.
    """
    ways = np.array(diagram.loop[0])[[*diagram.ends]] * (strokes.length / diagram.span)
    nearest = np.min(np.abs(np.subtract.outer(ways, strokes.travel(strokes.dead))), axis=1)
    wrong = np.flatnonzero(nearest > ALIKE * strokes.length)
    return diagram.ends[wrong[0]] if len(wrong) else None


def _no_dead_centre(diagram: IndicatorDiagram, row: int, strokes: _Strokes) -> Note:
    kind: Dimension = "length" if diagram.over == "position" else "volume"
    ways = np.sort(strokes.travel(strokes.dead)) * (diagram.span / strokes.length)
    dead = min(diagram.places) + ways
    dead_centers = [format_quantity(float(place), kind, scale=diagram.span) for place in dead]
    return Note(
        "row {row}: the diagram turns back at {place}, which is no dead centre of the piston "
        "({dead}); give the rows in the order in which it passes them",
        row=row + 1,
        place=format_quantity(diagram.places[row], kind),
        dead=", ".join(dict.fromkeys(dead_centers)),
    )


def _other_stroke(diagram: IndicatorDiagram, area: float, stroke: float) -> Note:
    if diagram.over == "position":
        return Note(
            "the positions span {given}, and the stroke of the piston is {stroke}",
            given=format_quantity(diagram.span, "length"),
            stroke=format_quantity(stroke, "length"),
        )
    return Note(
        "the volumes span {given}, and the piston sweeps {swept}, its bore times its stroke of "
        "{stroke}",
        given=format_quantity(diagram.span, "volume"),
        swept=format_quantity(stroke * area, "volume"),
        stroke=format_quantity(stroke, "length"),
    )


@dataclass(frozen=True)
class _Strokes:
    """Strokes of a piston over a cycle, by crank angles in the order of time, rad.

    dead : (M,) at which it turns back, rising.  period : of the cycle.  sense : of the crank.
    travel : way from the dead centre at the gas.  length : the longest way, m.
    """

    dead: Array
    period: float
    sense: int
    travel: Travel
    length: float

    @staticmethod
    def of(linkage: Linkage, load: Load) -> _Strokes:
        """Those of the slider along which a load acts."""
        machine = linkage.machine
        (slider,) = load.guides(machine.sliders)
        name = next(item.name for item in machine.sliders if item is slider)
        sense = -1 if machine.drive.speed < 0 else 1
        period = 2 * pi * linkage.cycle.turns
        dead = dead_positions(linkage, name)
        places = [position.place for position in dead]
        toward = -1 if load.side == "ahead" else 1
        nearest = min(toward * place for place in places)

        def travel(phase: Array) -> Array:
            ways = move(machine, np.asarray(sense * phase)).sliders[name].travel
            return np.asarray(np.maximum(toward * ways - nearest, 0.0))

        angles = np.sort(np.mod([sense * position.crank_angle for position in dead], period))
        return _Strokes(angles, period, sense, travel, float(np.ptp(places)))


def _pressures(diagram: IndicatorDiagram, strokes: _Strokes) -> tuple[Array, Array]:
    """Crank angles (N,) in the order of time over a whole cycle, rad, and pressures there, Pa."""
    ways, pressure = (np.array(column) for column in diagram.loop)
    branches = [*_branches(ways * (strokes.length / diagram.span), pressure, diagram.ends)]
    bounds = [*strokes.dead.tolist(), float(strokes.dead[0]) + strokes.period]
    branches_of_strokes = [_Branch.of(strokes.travel, *ends) for ends in pairwise(bounds)]
    first = _first_branch(diagram, branches, branches_of_strokes, strokes.period)
    passed = [
        stroke.pressures(*branches[(first + k) % len(branches)])
        for k, stroke in enumerate(branches_of_strokes)
    ]
    angle, values = (np.concatenate([piece[place] for piece in passed]) for place in (0, 1))
    return np.append(angle, angle[0] + strokes.period), np.append(values, values[0])


def _branches(ways: Array, pressure: Array, ends: tuple[int, ...]) -> Iterator[tuple[Array, Array]]:
    """Ways, m, and pressures of each stroke of a loop, from row to row at which it turns back.  A
    row that noise sets back stands at the way that is reached before it.
    """
    count = len(ways)
    for begin, end in zip(ends, (*ends[1:], ends[0] + count), strict=True):
        rows = np.arange(begin, end + 1) % count
        sense = np.sign(ways[rows[-1]] - ways[begin])
        yield sense * np.maximum.accumulate(sense * ways[rows]), pressure[rows]


def _first_branch(
    diagram: IndicatorDiagram,
    branches: list[tuple[Array, Array]],
    branches_of_strokes: list[_Branch],
    period: float,
) -> int:
    """Number of the branch that the first stroke passes: of those that go the same way the one with
    which the first row of the diagram is passed earliest.
    """
    ends, count = diagram.ends, len(branches)
    holds, row = (0, 0) if ends[0] == 0 else (count - 1, len(diagram.loop[0]) - ends[-1])
    ways, _ = branches[holds]
    rising = ways[-1] > ways[0]
    passing = [k for k in range(count) if branches_of_strokes[k].rising == rising]
    earliest = min(
        passing,
        key=lambda k: float(np.mod(branches_of_strokes[k].angles_of(ways)[row] + BESIDE, period)),
    )
    return (holds - earliest) % count


@dataclass(frozen=True)
class _Branch:
    """A stroke of a piston: crank angles in the order of time (K,), rad, and its ways there, m."""

    angle: Array
    way: Array

    @staticmethod
    def of(travel: Travel, begin: float, end: float) -> _Branch:
        angle = np.linspace(begin, end, FINER * max(2, ceil((end - begin) / STEP)) + 1)
        return _Branch(angle, travel(angle))

    @property
    def rising(self) -> bool:
        """Whether the piston moves away from the gas."""
        return bool(self.way[-1] > self.way[0])

    def angles_of(self, ways: Array) -> Array:
        """Crank angles (R,) of the rows of a branch, rad, side by side where the way is the same;
        between those of the stroke by straight lines, which at the ends is the least of its way.
        """
        sense = 1 if self.rising else -1
        angles = np.interp(sense * ways, sense * self.way, self.angle)
        offsets = BESIDE * np.arange(len(angles))
        return np.asarray(np.maximum.accumulate(angles - offsets) + offsets)

    def pressures(self, ways: Array, pressure: Array) -> tuple[Array, Array]:
        """Crank angles (N,) of the rows and between them, without the end, and pressures, Pa."""
        sense, rows = (1 if self.rising else -1), self.angles_of(ways)
        between = slice(FINER, -1, FINER)
        middle = np.interp(sense * self.way[between], sense * ways, pressure)
        angle = np.concatenate([rows[:-1], self.angle[between]])
        values = np.concatenate([pressure[:-1], middle])
        order = np.argsort(angle, kind="stable")
        angle, values = angle[order], values[order]
        inside = (np.diff(angle, prepend=-np.inf) > SAME) & (angle < self.angle[-1] - SAME)
        return angle[inside], values[inside]
