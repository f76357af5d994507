"""Points of the frame, and where the machine is roughly."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from math import hypot, isfinite
from typing import Any

from equipoise.errors import ModelError, UsageError
from equipoise.i18n import Note, to_say
from equipoise.keys import Frozen, Named, Point, Quantity, TextKind, declared, key
from equipoise.mechanism.checks import FRAME, Bodies, Vector, unknown, unknown_link


@declared
class Position(Frozen):
    """Where the machine is, roughly, at one crank angle: the start of Newton's method."""

    crank_angle: float = key(
        "angle", "at which it holds; 0 where gears are among these links", default=0.0
    )
    points: Mapping[str, Vector] = key(
        Named(Point(), by=TextKind(of="point", on="links")), "places in the frame", factory=dict
    )
    angles: Mapping[str, float] = key(
        Named(Quantity("angle"), by=TextKind(of="link")), "of links in the frame", factory=dict
    )


@declared
class Frame(Frozen):
    """The part that stands still; a machine has its points by name."""

    called = to_say("{what} of the frame")
    wanted = Note("a mapping of names to two numbers")

    points: Mapping[str, Vector] = key(
        Named(Point()),
        "points that stand still, in the frame's axes; a link with a point of that name is pinned "
        "there",
        example={"A": ["0 mm", "0 mm"]},
    )

    @classmethod
    def checked(cls, value: Any) -> Any:
        return Named(Point()).check(value)

    @classmethod
    def from_table(cls, given: dict[str, Any]) -> Mapping[str, Vector]:
        points: Mapping[str, Vector] = given["points"]
        return points

    @classmethod
    def to_table(cls, value: Any) -> dict[str, Any]:
        return {"points": value}


def wrong_position(position: Position | None, bodies: Bodies) -> Iterator[ModelError]:
    """Everything that is wrong with a rough pose."""
    if position is None:
        return
    known = {point: None for body, points in bodies.items() if body != FRAME for point in points}
    for point in position.points:
        if point not in known:
            yield ModelError(
                f"position.points.{point}", unknown(point, known, "point of a moving link")
            )
    for name in position.angles:
        yield from unknown_link(f"position.angles.{name}", name, bodies)


def in_frame(frame: Mapping[str, Vector], point: str | Vector | complex) -> complex:
    """A point of the frame by name, or any place by coordinates (m), as a complex number."""
    if isinstance(point, str):
        if point not in frame:
            raise UsageError(unknown(point, frame, "point of the frame"))
        return complex(*frame[point])
    try:
        place = point if isinstance(point, complex) else complex(*point)
    except (TypeError, ValueError, OverflowError):
        place = complex("nan")
    if not isfinite(hypot(place.real, place.imag)):
        raise UsageError(
            Note("got {point!r}; give a point of the frame or two finite coordinates", point=point)
        )
    return place
