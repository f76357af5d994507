"""Springs, as frozen values with their checks."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from equipoise.errors import ModelError
from equipoise.i18n import Note, to_say
from equipoise.keys import Frozen, Text, declared, key
from equipoise.mechanism.checks import FRAME, Bodies, unknown, unknown_body, unknown_link


@declared
class Spring(Frozen):
    """A linear spring without mass: it pulls `point` of `link` towards the point `to` of `on`."""

    called = to_say("{what} of spring {number}")

    link: str = key(Text(of="link"), "the link that it pulls", example="rocker")
    point: str = key(
        Text(of="point", on="link"),
        "its point on the link, not one that is pinned to the frame",
        example="C",
    )
    to: str = key(
        Text(of="point", on="on"),
        "its point on the frame, or on `on`",
        example="S",
        word=to_say("other point"),
    )
    stiffness: float = key("stiffness", "more than 0", example="2 kN/m", above=0)
    free_length: float = key(
        "length",
        "at which it exerts nothing; shorter it pushes",
        default=0.0,
        shown="0 m",
        at_least=0,
        why=Note("a length cannot be negative, give 0 or more"),
    )
    on: str = key(
        Text(of="body"), "the body of its other point", default=FRAME, word=to_say("other body")
    )

    @property
    def ends(self) -> tuple[tuple[str, str], ...]:
        """Link and point of each end that is on a link; it pulls the second the other way."""
        first = (self.link, self.point)
        return (first,) if self.on == FRAME else (first, (self.on, self.to))


def wrong_ends(where: str, spring: Any, bodies: Bodies) -> Iterator[ModelError]:
    """What is wrong with the two points of a spring, or of one that may be set."""
    link, point, to, on = spring.link, spring.point, spring.to, getattr(spring, "on", FRAME)
    problem = [
        *unknown_link(f"{where}.link", link, bodies),
        *unknown_body(f"{where}.on", on, bodies),
    ]
    if problem:
        yield from problem
        return
    points, frame = bodies[link], bodies[FRAME]
    if point not in points:
        sentence = unknown(point, points, Note("point of {body}", body=link))
        yield ModelError(f"{where}.point", sentence)
    elif on == link:
        yield ModelError(f"{where}.on", Note("{link!r} cannot pull on itself", link=link))
    elif to not in bodies[on]:
        of = "point of the frame" if on == FRAME else Note("point of {body}", body=on)
        yield ModelError(f"{where}.to", unknown(to, bodies[on], of))
    elif on != FRAME and (point in bodies[on] or to in points):
        yield ModelError(
            where, Note("{link!r} and {on!r} are pinned there; give other points", link=link, on=on)
        )
    elif point in frame and on == FRAME:
        yield ModelError(
            f"{where}.point",
            Note(
                "{point!r} is pinned to the frame, where a spring does nothing; give a "
                "point that moves",
                point=point,
            ),
        )
