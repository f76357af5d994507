"""Motion laws as they stand in a file: a value, an angle or a length, over the crank angle.

`AngleLaw` and `LengthLaw` are the same with another dimension: a swing by a sine, a sequence of
segments, or a spline through values that are given or in a CSV file.  `curve` is what
`mechanism.formulas.curves` evaluates.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import cached_property
from itertools import pairwise
from math import degrees, pi
from typing import TYPE_CHECKING, Any, ClassVar, Literal

from equipoise.errors import ModelError
from equipoise.i18n import Note, to_say
from equipoise.keys import (
    ROW,
    Conditions,
    File,
    Frozen,
    Listing,
    Quantity,
    Table,
    Tables,
    Text,
    Whole,
    declared,
    inside,
    key,
)
from equipoise.quantities import format_exact

if TYPE_CHECKING:
    from equipoise.mechanism.formulas.curves import Array, Curve

LAWS = ("cycloidal", "modified sine", "modified trapezoid", "3-4-5", "4-5-6-7", "harmonic",
        "s-curve", "trapezoid", "linear")  # fmt: skip
SPLINES = {"cubic": 3, "quintic": 5}
MOST_ROWS, MOST_TURNS = 720, 100
CLOSED = 1e-9
"""Of the largest value, or of the cycle, by which rounding may miss what has to agree."""
OVER = "crank angle that it takes"
LAW = "by which it moves; nothing moves where `to` is the value before"
BESIDE = "CSV file beside this one, instead of `crank_angles` and `values`: "
AT = 'a list such as ["0 deg", "90 deg", "210 deg"]'


@declared
class AngleSegment(Frozen):
    """A part of a motion from the angle before it to another."""

    called = to_say("{what} of segment {number}")

    over: float = key("angle", OVER, above=0, word=to_say("crank angle taken"), example="120 deg")
    to: float = key("angle", "at its end", word=to_say("angle at the end"), example="30 deg")
    law: str = key(Text(LAWS), LAW, default="cycloidal")


@declared
class LengthSegment(Frozen):
    """A part of a motion from the length before it to another."""

    called = to_say("{what} of segment {number}")

    over: float = key("angle", OVER, above=0, word=to_say("crank angle taken"), example="120 deg")
    to: float = key("length", "at its end", word=to_say("length at the end"), example="20 mm")
    law: str = key(Text(LAWS), LAW, default="cycloidal")


@declared
class AngleTable(Frozen):
    """Angles over the crank angle, through which a spline goes.

    crank_angle : rad, rising.  angle : rad, as long as `crank_angle`.
    file : name of the CSV file that it came from.
    """

    crank_angle: tuple[float, ...] = inside(ROW)
    angle: tuple[float, ...] = inside(ROW)
    file: str = inside(Text(), default="", compare=False)


@declared
class LengthTable(Frozen):
    """Lengths over the crank angle, through which a spline goes.

    crank_angle : rad, rising.  length : m, as long as `crank_angle`.
    file : name of the CSV file that it came from.
    """

    crank_angle: tuple[float, ...] = inside(ROW)
    length: tuple[float, ...] = inside(ROW)
    file: str = inside(Text(), default="", compare=False)


class Law(Frozen):
    """What both kinds of law do.

    whole : what the value may have gained when it begins anew is a multiple of this.
    """

    whole: ClassVar[float]
    dimension: ClassVar[Literal["angle", "length"]]
    conditions: ClassVar[Conditions] = {
        "oneOf": [{"required": [one]} for one in ("between", "segments", "values", "table")],
        "dependentRequired": {
            "crank_angles": ["values"],
            "values": ["crank_angles"],
            "start": ["segments"],
        },
        "dependentSchemas": {
            "spline": {"anyOf": [{"required": [one]} for one in ("values", "table")]},
        },
    }

    between: tuple[float, float] | None
    start: float
    segments: tuple[Any, ...]
    crank_angles: tuple[float, ...]
    values: tuple[float, ...]
    table: AngleTable | LengthTable | None
    spline: Literal["cubic", "quintic"]
    turns: int
    phase: float

    @property
    def period(self) -> float:
        """Crank angle after which it begins anew, rad."""
        return 2 * pi * self.turns

    @property
    def rows(self) -> tuple[tuple[float, ...], tuple[float, ...]]:
        """Crank angles, rad, and the values there through which a spline goes."""
        if self.table is None:
            return self.crank_angles, self.values
        return self.table.crank_angle, getattr(self.table, self.dimension)

    @cached_property
    def curve(self) -> Curve:
        """The value over the crank angle from `origin` on."""
        import numpy as np

        from equipoise.mechanism.formulas.curves import NORMAL, Curve, joined, sine, spline

        if self.between is not None:
            return sine(*self.between, self.period)
        angles, given = self.rows
        if given:
            knots = np.subtract([*angles, angles[0] + self.period], angles[0])
            values = np.array([*given, given[0]])
            if self._is_closed:
                knots, values = np.append(knots[:-2], self.period), values[:-1]
            return spline(knots, values, SPLINES[self.spline])
        before = (self.start, *(one.to for one in self.segments))
        parts = zip(pairwise(before), self.segments, strict=True)
        whole = joined([NORMAL[s.law]().stretched(s.over, b - a).lifted(a) for (a, b), s in parts])
        return Curve(whole.knots * (self.period / whole.length), whole.powers, whole.waves)

    @property
    def origin(self) -> float:
        """Crank angle at which the curve begins, rad."""
        return self.phase + next(iter(self.rows[0]), 0.0)

    @property
    def _is_closed(self) -> bool:
        """Whether the last of the rows is the first one in the next cycle."""
        angles = self.rows[0]
        return abs(angles[-1] - angles[0] - self.period) <= CLOSED * self.period

    def value(self, crank_angle: Any) -> tuple[Array, Array, Array]:
        """The value and its first and second derivative by crank angle, at crank angles (...)."""
        return self.curve.at(crank_angle - self.origin)

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
    return key(kind, text, default=None, example=example)


@declared
class AngleLaw(Law):
    """An angle over the crank angle; it may gain whole turns."""

    called = to_say("{what} of the motion")
    whole = 2 * pi
    dimension = "angle"

    between: tuple[float, float] | None = _between("angle", ["-30 deg", "30 deg"])
    start: float = key(
        "angle", "where the first segment begins", default=0.0, word=to_say("angle at the start")
    )
    segments: tuple[AngleSegment, ...] = key(
        Tables(Table(AngleSegment)), "parts of the motion, one after the other", default=()
    )
    crank_angles: tuple[float, ...] = key(
        Listing(Quantity(dimension="angle"), right=AT), "crank angles of `values`", default=()
    )
    values: tuple[float, ...] = key(
        Listing(Quantity(dimension="angle"), right=AT), "through which a spline goes", default=()
    )
    table: AngleTable | None = key(
        File("angles"), BESIDE + "`crank_angle [deg],angle [deg]`", default=None, example="law.csv"
    )
    spline: Literal["cubic", "quintic"] = key(
        Text((*SPLINES,)), "through `values`; both come back smoothly", default="cubic"
    )
    turns: int = key(Whole(1, MOST_TURNS), "of the crank in which it comes back", default=1)
    phase: float = key("angle", "crank angle at which it begins", default=0.0)


@declared
class LengthLaw(Law):
    """A length over the crank angle."""

    called = to_say("{what} of the motion")
    whole = 0.0
    dimension = "length"

    between: tuple[float, float] | None = _between("length", ["0 mm", "20 mm"])
    start: float = key(
        "length", "where the first segment begins", default=0.0, word=to_say("length at the start")
    )
    segments: tuple[LengthSegment, ...] = key(
        Tables(Table(LengthSegment)), "parts of the motion, one after the other", default=()
    )
    crank_angles: tuple[float, ...] = key(
        Listing(Quantity(dimension="angle"), right=AT), "crank angles of `values`", default=()
    )
    values: tuple[float, ...] = key(
        Listing(Quantity(dimension="length"), right='a list such as ["0 mm", "5 mm", "20 mm"]'),
        "through which a spline goes",
        default=(),
    )
    table: LengthTable | None = key(
        File("lengths"), BESIDE + "`crank_angle [deg],length [mm]`", default=None, example="law.csv"
    )
    spline: Literal["cubic", "quintic"] = key(
        Text((*SPLINES,)), "through `values`; both come back smoothly", default="cubic"
    )
    turns: int = key(Whole(1, MOST_TURNS), "of the crank in which it comes back", default=1)
    phase: float = key("angle", "crank angle at which it begins", default=0.0)


# -- checks ----------------------------------------------------------------------------------------


def wrong_law(where: str, law: Law) -> Iterator[ModelError]:
    """Everything that is wrong with a motion law."""
    given = [law.between is not None, bool(law.segments), bool(law.values), law.table is not None]
    if sum(given) != 1 or bool(law.crank_angles) != bool(law.values):
        told = Note("give exactly one of between, segments, table, and crank_angles with values")
        yield ModelError(where, told)
        return
    problem = next(_wrong_segments(where, law) if law.segments else _wrong_rows(where, law), None)
    if problem is not None:
        yield problem
    elif len(jumps := law.jumps(1)):
        yield ModelError(
            where,
            Note(
                "the speed jumps at crank angle {angle:.6g} deg, which takes an infinite force; "
                "give laws there that begin and end at the same speed, such as cycloidal",
                angle=degrees(jumps[0]),
            ),
        )


def _wrong_segments(where: str, law: Law) -> Iterator[ModelError]:
    total = sum(one.over for one in law.segments)
    if abs(total - law.period) > CLOSED * law.period:
        yield ModelError(
            f"{where}.segments",
            Note(
                "they take {total:.6g} deg of crank angle together, and a cycle has {period:.6g} "
                "deg; let them sum up to that (a dwell is a segment to the value before it)",
                total=degrees(total),
                period=degrees(law.period),
            ),
        )
    yield from _wrong_return(f"{where}.segments", law, law.start, law.segments[-1].to)


def _wrong_return(where: str, law: Law, first: float, last: float) -> Iterator[ModelError]:
    """Complain of a value that is not back at the end of the cycle."""
    gained = last - first
    missing = gained - law.whole * round(gained / law.whole) if law.whole else gained
    if abs(missing) > CLOSED * (abs(last) + abs(first) + law.whole):
        values = {"first": format_exact(first, law.dimension)}
        values["last"] = format_exact(last, law.dimension)
        told = (
            Note("begins at {first} and ends at {last}; let it come back, or gain whole turns",
                 **values)
            if law.whole
            else Note("begins at {first} and ends at {last}; let it come back", **values)
        )  # fmt: skip
        yield ModelError(where, told)


def _wrong_rows(where: str, law: Law) -> Iterator[ModelError]:
    """Complain of rows through which no spline goes."""
    if law.start:
        yield ModelError(f"{where}.start", Note("goes with segments; leave it out"))
    if law.between is not None:
        return
    (angles, values), count = law.rows, len(law.rows[1])
    listed = ("values", "crank_angles") if law.table is None else ("table",) * 2
    told, at = (f"{where}.{one}" for one in listed)
    if len(angles) != count or not 3 <= count <= MOST_ROWS:
        yield ModelError(
            told,
            Note(
                "got {values} values at {angles} crank angles; give 3 to {most} of each",
                values=count,
                angles=len(angles),
                most=MOST_ROWS,
            ),
        )
    elif any(b - a <= CLOSED for a, b in pairwise(angles)):
        yield ModelError(at, Note("the crank angles must rise from row to row"))
    elif angles[-1] - angles[0] > law.period * (1 + CLOSED):
        yield ModelError(
            at,
            Note(
                "got crank angles over {span:.6g} deg, more than the {period:.6g} deg of a cycle",
                span=degrees(angles[-1] - angles[0]),
                period=degrees(law.period),
            ),
        )
    elif law._is_closed:
        yield from _wrong_return(told, law, values[0], values[-1])
