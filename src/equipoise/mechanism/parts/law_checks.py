"""What is wrong with motion laws."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from math import degrees

from equipoise.errors import ModelError
from equipoise.i18n import Note, key_names, to_say
from equipoise.mechanism.parts.laws import CLOSED, MOST_ROWS, Law
from equipoise.quantities import KINDS, Measured

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
