"""The line between two points along which a load may act."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from equipoise.errors import ModelError
from equipoise.i18n import Note, key_names, to_say
from equipoise.mechanism.checks import FRAME, Bodies, unknown

MEETING = to_say(
    "{point!r} of {link!r} meets {to!r} at crank angle {angle:.6g} deg, where a load along their "
    "line has no direction; give another point"
)
"""What is wrong where the ends of a load meet."""


class AlongLine:
    """A load whose force may be given along the line from its `point` to the point `toward` of the
    body that bears its opposite.
    """

    link: str
    point: str | None
    axes: str | None
    toward: str | None
    force: Any

    @property
    def bearer(self) -> str | None:
        """The body that bears its opposite; None if none does."""
        raise NotImplementedError

    @property
    def force_key(self) -> str:
        """Key that gives its force."""
        return "force"

    @property
    def forces_across(self) -> tuple[Any, ...]:
        """Components of its force, N, across the line in which it may act."""
        return () if self.force is None else (self.force[1],)


def wrong_line(where: str, load: AlongLine, bodies: Bodies) -> Iterator[ModelError]:
    """What is wrong with the point towards which a load points."""
    body = load.bearer
    if load.toward is None or (body is not None and body not in bodies):
        return
    at = f"{where}.toward"
    if load.point is None:
        yield ModelError(at, Note("goes with a force; leave it out"))
    elif load.axes is not None:
        wrong = Note("{toward} gives the direction of the force already; leave it out",
                     **key_names("toward"))  # fmt: skip
        yield ModelError(f"{where}.axes", wrong)
    elif body is None:
        yield _without_bearer(where, load.link, load.toward, bodies)
    elif load.toward not in bodies[body]:
        kind = Note("point of {body}", body=body) if body != FRAME else "point of the frame"
        yield ModelError(at, unknown(load.toward, bodies[body], kind))
    elif load.toward in bodies.get(load.link, ()) or load.point in bodies[body]:
        wrong = Note("{link!r} and {on!r} are pinned there; give other points",
                     link=load.link, on=body)  # fmt: skip
        yield ModelError(at, wrong)
    elif any(load.forces_across):  # its opposite, at the other end, would leave a moment
        wrong = Note("a force in the line between two points has no component across it; "
                     "give 0 N as its y component")  # fmt: skip
        yield ModelError(f"{where}.{load.force_key}", wrong)


def _without_bearer(where: str, link: str, toward: str, bodies: Bodies) -> ModelError:
    """That no body is named that bears the opposite, with one that has the point."""
    names = [name for name, points in bodies.items()
             if toward in points and name != link]  # fmt: skip
    if not names:
        points = dict.fromkeys(point for each in bodies.values() for point in each)
        return ModelError(f"{where}.toward", unknown(toward, points, "point"))
    name = FRAME if FRAME in names else names[0]
    wrong = Note(
        "missing; add {example}, the body with the point {toward!r}, which bears the opposite",
        example=f'reaction = "{name}"',
        toward=toward,
    )
    return ModelError(f"{where}.reaction", wrong)
