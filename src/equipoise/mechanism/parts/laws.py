"""Motion laws as they stand in a file, and their checks.

That is the crank angle for a drive, and for a cam the angle that it has turned.  `AngleLaw` and
`LengthLaw` are the same with another dimension: a swing by a sine, a sequence of segments, or a
spline through values that are given or in a CSV file.  `curve` is what `mechanism.formulas.curves`
evaluates.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import cached_property
from itertools import pairwise
from math import degrees, pi
from numbers import Real
from typing import TYPE_CHECKING, Any, ClassVar, Literal, Self

from equipoise.errors import ModelError
from equipoise.i18n import Note, key_names, to_say
from equipoise.keys import (
    ROW,
    File,
    Frozen,
    KeyConditions,
    KeyTable,
    Listing,
    Quantity,
    Tables,
    TextKind,
    Whole,
    declared,
    inside,
    key,
    with_fields,
)
from equipoise.keys.csv_tables import CsvTable
from equipoise.keys.paths import KeyPath
from equipoise.quantities import KINDS, Measured

if TYPE_CHECKING:
    from equipoise.mechanism.formulas.curves import PeriodicCurve
    from equipoise.signals import Array

LAWS = ("cycloidal", "modified sine", "modified trapezoid", "3-4-5", "4-5-6-7", "harmonic",
        "s-curve", "trapezoid", "linear")  # fmt: skip
SPLINES = {"cubic": 3, "quintic": 5}
MOST_ROWS, MOST_TURNS = 720, 100
CLOSED = 1e-9
"""Of the largest value, or of the cycle, by which rounding may miss what has to agree."""
CSV_INSTEAD = "CSV file beside this one, instead of `crank_angles` and `values`: "
ANGLES = Note('a list such as ["0 deg", "90 deg", "210 deg"]')
LENGTHS = Note('a list such as ["0 mm", "5 mm", "20 mm"]')


@declared
class LawSegment(Frozen):
    """A part of a motion from the value before it to another, over an angle of crank or cam."""

    called = to_say("{what} of segment {number}")

    over: float = key(
        "angle",
        "crank angle that it takes; of a cam, its own angle",
        above=0,
        word=to_say("angle taken"),
        example="120 deg",
    )
    to: float
    law: str = key(
        TextKind(LAWS),
        "by which it moves; nothing moves where `to` is the value before",
        default="cycloidal",
    )


@declared
class AngleSegment(LawSegment):
    """A part of a motion from the angle before it to another."""

    to: float = key("angle", "at its end", word=to_say("angle at the end"), example="30 deg")


@declared
class LengthSegment(LawSegment):
    """A part of a motion from the length before it to another."""

    to: float = key("length", "at its end", word=to_say("length at the end"), example="20 mm")


@declared
class LawTable(CsvTable):
    """Values over the crank angle, or a cam's own, through which a spline goes.

    crank_angle : rad, rising.  values : rad or m, as long as `crank_angle`.
    file : name of the CSV file that it came from.
    """

    crank_angle: tuple[float, ...] = inside(ROW)
    values: tuple[float, ...] = inside(ROW)
    file: str = inside(TextKind(), default="", compare=False)


class AngleTable(LawTable):
    """Angles."""

    sort = "angles"
    forms = (("crank_angle", "angle"),)


class LengthTable(LawTable):
    """Lengths."""

    sort = "lengths"
    forms = (("crank_angle", "length"),)


@declared
class Law(Frozen):
    """What both kinds of law have and do.

    whole : what the value may have gained when it begins anew is a multiple of this.
    """

    called = to_say("{what} of the motion")
    file_order = ("between", "start", "segments", "crank_angles", "values", "table")

    whole: ClassVar[float]
    dimension: ClassVar[Literal["angle", "length"]]
    conditions: ClassVar[KeyConditions] = {
        "oneOf": [{"required": [name]} for name in ("between", "segments", "values", "table")],
        "dependentRequired": {
            "crank_angles": ["values"],
            "values": ["crank_angles"],
            "start": ["segments"],
        },
        "dependentSchemas": {
            "spline": {"anyOf": [{"required": [name]} for name in ("values", "table")]},
        },
    }

    between: tuple[float, float] | None
    start: float
    segments: tuple[Any, ...]
    values: tuple[float, ...]
    table: LawTable | None
    crank_angles: tuple[float, ...] = key(
        Listing(Quantity(dimension="angle"), right=ANGLES),
        "crank angles of `values`; of a cam, its own angles",
        default=(),
    )
    spline: Literal["cubic", "quintic"] = key(
        TextKind((*SPLINES,)), "through `values`; both come back smoothly", default="cubic"
    )
    turns: int = key(
        Whole(1, MOST_TURNS), "of the crank in which it comes back; 1 of a cam", default=1
    )
    phase: float = key(
        "angle", "crank angle at which it begins; of a cam, its own angle", default=0.0
    )

    @property
    def period(self) -> float:
        """Crank angle after which it begins anew, rad."""
        return 2 * pi * self.turns

    @property
    def rows(self) -> tuple[tuple[float, ...], tuple[float, ...]]:
        """Crank angles, rad, and the values there through which a spline goes."""
        if self.table is None:
            return self.crank_angles, self.values
        return self.table.crank_angle, self.table.values

    @cached_property
    def amounts(self) -> dict[KeyPath, Any]:
        """Values in which the law is linear, by their paths in its table: numbers, or columns of
        designs (P, 1).  Those that have to be equal to another are none of them.
        """
        if self.between is not None:
            return {KeyPath(("between", k)): value for k, value in enumerate(self.between)}
        if self.segments:
            ends = enumerate(self.segments[:-1])
            return {KeyPath(("segments", k, "to")): segment.to for k, segment in ends}
        bound = (0, len(self.values) - 1) if self.values and self.is_closed else ()
        each = enumerate(self.values)
        return {KeyPath(("values", k)): value for k, value in each if k not in bound}

    @cached_property
    def unit_curves(self) -> dict[KeyPath, PeriodicCurve]:
        """By the paths of amounts that are columns of designs, the curve of an amount of 1."""
        columns = (path for path, value in self.amounts.items() if not isinstance(value, Real))
        return {path: self.unit_curve(path) for path in columns}

    def unit_curve(self, path: KeyPath) -> PeriodicCurve:
        """The curve by which the displacement grows with an amount."""
        flat = self
        if self.segments:
            still = with_fields(self.segments[-1], to=0.0)
            flat = with_fields(self, start=0.0, segments=(*self.segments[:-1], still))
        elif self.values:
            flat = with_fields(self, values=(0.0,) * len(self.values))
        return flat.with_amounts({other: float(other == path) for other in self.amounts}).curve

    def with_amounts(self, amounts: Mapping[KeyPath, Any]) -> Self:
        """The law with other values of some amounts; unchecked."""
        values = [amounts.get(path, value) for path, value in self.amounts.items()]
        if self.between is not None:
            return with_fields(self, between=tuple(values))
        if self.segments:
            pairs = zip(self.segments, values, strict=False)
            moved = (with_fields(segment, to=value) for segment, value in pairs)
            return with_fields(self, segments=(*moved, self.segments[-1]))
        if len(values) < len(self.values):
            values = [self.values[0], *values, self.values[-1]]
        return with_fields(self, values=tuple(values))

    def accepts_columns(self, base: Law) -> bool:
        """Whether what is a column of designs is an amount, and no design jumps where the base does
        not, in speed or acceleration.
        """
        bound = [self.start, *(segment.to for segment in self.segments[-1:])]
        if self.values and self.is_closed:
            bound += [self.values[0], self.values[-1]]
        return all(isinstance(value, Real) for value in bound) and all(
            {*curve.jumps(order)} <= {*base.curve.jumps(order)}
            for curve in self.unit_curves.values()
            for order in (1, 2)
        )

    @cached_property
    def curve(self) -> PeriodicCurve:
        """The value over the crank angle from `origin` on; amounts that are columns are 0 in it."""
        if self.unit_curves:
            return self.with_amounts(dict.fromkeys(self.unit_curves, 0.0)).curve
        return self._joined()

    def _joined(self) -> PeriodicCurve:
        import numpy as np

        from equipoise.mechanism.formulas.curves import NORMAL, PeriodicCurve, joined, sine, spline

        if self.between is not None:
            return sine(*self.between, self.period)
        angles, given = self.rows
        if given:
            knots = np.subtract([*angles, angles[0] + self.period], angles[0])
            values = np.array([*given, given[0]])
            if self.is_closed:
                knots, values = np.append(knots[:-2], self.period), values[:-1]
            return spline(knots, values, SPLINES[self.spline])
        before = (self.start, *(segment.to for segment in self.segments))
        parts = zip(pairwise(before), self.segments, strict=True)
        whole = joined([NORMAL[s.law]().stretched(s.over, b - a).lifted(a) for (a, b), s in parts])
        return PeriodicCurve(whole.knots * (self.period / whole.length), whole.powers, whole.waves)

    @property
    def origin(self) -> float:
        """Crank angle at which the curve begins, rad."""
        return self.phase + next(iter(self.rows[0]), 0.0)

    @property
    def is_closed(self) -> bool:
        """Whether the last of the rows is the first one in the next cycle."""
        angles = self.rows[0]
        return abs(angles[-1] - angles[0] - self.period) <= CLOSED * self.period

    def value(
        self, crank_angle: Any, amounts: Mapping[KeyPath, Any] | None = None
    ) -> tuple[Array, Array, Array]:
        """The value and its first and second derivative by crank angle, at crank angles (...).

        amounts : of those that are columns of designs, where other ones are to take their place,
            such as some of the designs.
        """
        at, given = crank_angle - self.origin, self.amounts if amounts is None else amounts
        y, y1, y2 = self.curve.at(at)
        for path, curve in self.unit_curves.items():
            amount, (by, by1, by2) = given[path], curve.at(at)
            y, y1, y2 = y + amount * by, y1 + amount * by1, y2 + amount * by2
        return y, y1, y2

    def jumps(self, order: int) -> Array:
        """Crank angles within a cycle (J,), rad, at which the derivative of this order jumps."""
        angles = (self.curve.jumps(order) + self.origin) % self.period
        angles[angles > self.period * (1 - CLOSED)] = 0.0
        angles.sort()
        return angles

    @property
    def windings(self) -> int:
        """Whole turns, of an angle, that it gains in a cycle."""
        return round(self.curve.rise / self.whole) if self.whole else 0

    @property
    def extremes(self) -> tuple[float, float]:
        """Smallest and largest value in a cycle."""
        return self.curve.extremes


def _between(dimension: Any, example: list[str]) -> Any:
    text = "two values between which it swings by a sine, from the first and back"
    kind = Listing(Quantity(dimension=dimension), (2,))
    return key(kind, text, default=None, word=to_say("extreme value"), example=example)


def _start(dimension: Any, word: str) -> Any:
    return key(dimension, "where the first segment begins", default=0.0, word=word)


def _segments(kind: type[LawSegment]) -> Any:
    return key(Tables(KeyTable(kind)), "parts of the motion, one after the other", default=())


def _values(dimension: Any, right: Note) -> Any:
    kind = Listing(Quantity(dimension=dimension), right=right)
    return key(kind, "through which a spline goes", default=())


@declared
class AngleLaw(Law):
    """An angle over the crank angle, or over a cam's own; it may gain whole turns."""

    whole = 2 * pi
    dimension = "angle"

    between: tuple[float, float] | None = _between("angle", ["-30 deg", "30 deg"])
    start: float = _start("angle", to_say("angle at the start"))
    segments: tuple[AngleSegment, ...] = _segments(AngleSegment)
    values: tuple[float, ...] = _values("angle", ANGLES)
    table: AngleTable | None = key(
        File("angles"),
        CSV_INSTEAD + "`crank_angle [deg],angle [deg]`",
        default=None,
        example="law.csv",
    )


@declared
class LengthLaw(Law):
    """A length over the crank angle, or over a cam's own."""

    whole = 0.0
    dimension = "length"

    between: tuple[float, float] | None = _between("length", ["0 mm", "20 mm"])
    start: float = _start("length", to_say("length at the start"))
    segments: tuple[LengthSegment, ...] = _segments(LengthSegment)
    values: tuple[float, ...] = _values("length", LENGTHS)
    table: LengthTable | None = key(
        File("lengths"),
        CSV_INSTEAD + "`crank_angle [deg],length [mm]`",
        default=None,
        example="law.csv",
    )


CRANK, CAM = to_say("crank angle"), to_say("cam angle")
"""Over which angle a law goes, of a drive and of a cam."""


def wrong_law(where: str, law: Law, over: str = CRANK) -> Iterator[ModelError]:
    """Everything that is wrong with a motion law over `CRANK` or `CAM`."""
    given = [law.between is not None, bool(law.segments), bool(law.values), law.table is not None]
    if sum(given) != 1 or bool(law.crank_angles) != bool(law.values):
        note = Note(
            "give exactly one of between, segments, table, and {crank_angles} with values",
            **key_names("crank_angles"),
        )
        yield ModelError(where, note)
        return
    turned, wrong = Note(over), _wrong_segments if law.segments else _wrong_rows
    problem = next(wrong(where, law, turned), None)
    if problem is not None:
        yield problem
    elif len(jumps := law.jumps(1)):
        yield ModelError(
            where,
            Note(
                "the speed jumps at {turned} {angle:.6g} deg, which takes an infinite force; "
                "give laws there that begin and end at the same speed, such as cycloidal",
                turned=turned,
                angle=degrees(jumps[0]),
            ),
        )


def _wrong_segments(where: str, law: Law, turned: Note) -> Iterator[ModelError]:
    total = sum(segment.over for segment in law.segments)
    if abs(total - law.period) > CLOSED * law.period:
        yield ModelError(
            f"{where}.segments",
            Note(
                "they take {total:.6g} deg of {turned} together, and a cycle has {period:.6g} "
                "deg; let them sum up to that (a dwell is a segment to the value before it)",
                total=degrees(total),
                turned=turned,
                period=degrees(law.period),
            ),
        )
    yield from _wrong_return(f"{where}.segments", law, law.start, law.segments[-1].to)


def _wrong_return(where: str, law: Law, first: float, last: float) -> Iterator[ModelError]:
    """Complain of a value that is not back at the end of the cycle."""
    gained = last - first
    missing = gained - law.whole * round(gained / law.whole) if law.whole else gained
    if abs(missing) > CLOSED * (abs(last) + abs(first) + law.whole):
        values = {
            name: Measured(value, law.dimension, KINDS[law.dimension].printed[0])
            for name, value in (("first", first), ("last", last))
        }
        note = (
            Note("begins at {first} and ends at {last}; let it come back, or gain whole turns",
                 **values)
            if law.whole
            else Note("begins at {first} and ends at {last}; let it come back", **values)
        )  # fmt: skip
        yield ModelError(where, note)


def _wrong_rows(where: str, law: Law, turned: Note) -> Iterator[ModelError]:
    """Complain of rows through which no spline goes."""
    if law.start:
        yield ModelError(f"{where}.start", Note("goes with segments; leave it out"))
    if law.between is not None:
        return
    (angles, values), count = law.rows, len(law.rows[1])
    listed = ("values", "crank_angles") if law.table is None else ("table",) * 2
    text, at = (f"{where}.{item}" for item in listed)
    if len(angles) != count or not 3 <= count <= MOST_ROWS:
        yield ModelError(
            text,
            Note(
                "got {values} values at {angles} angles; give 3 to {most} of each",
                values=count,
                angles=len(angles),
                most=MOST_ROWS,
            ),
        )
    elif any(b - a <= CLOSED for a, b in pairwise(angles)):
        yield ModelError(at, Note("the {turned} must rise from row to row", turned=turned))
    elif angles[-1] - angles[0] > law.period * (1 + CLOSED):
        yield ModelError(
            at,
            Note(
                "the rows go over {span:.6g} deg of {turned}, more than the {period:.6g} deg of a "
                "cycle",
                turned=turned,
                span=degrees(angles[-1] - angles[0]),
                period=degrees(law.period),
            ),
        )
    elif law.is_closed:
        yield from _wrong_return(text, law, values[0], values[-1])
