"""What elements between two bodies share: between which they act, and what they are called by."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from equipoise.errors import ModelError
from equipoise.i18n import Note
from equipoise.mechanism.checks import FRAME, Bodies, unknown, unknown_body, unknown_link
from equipoise.mechanism.formulas.kernels import cross, dot
from equipoise.mechanism.parts.element_kinds import Placed


class BetweenPoints:
    """Between `point` of `link` and the point `to` of `on`."""

    link: str
    point: str
    to: str
    on: str

    @property
    def bodies(self) -> tuple[str, str]:
        """The link and the body of the other point."""
        return self.link, self.on

    @property
    def points(self) -> tuple[tuple[str, str], ...]:
        """Both bodies, each with its point."""
        return (self.link, self.point), (self.on, self.to)

    @property
    def label(self) -> Note:
        """Both points, which distinguish it from others of its kind."""
        return Note("{point} to {other}", point=self.point, other=self.to)

    @property
    def route(self) -> tuple[str, str]:
        """Both points."""
        return self.point, self.to

    def relative_motion(
        self, at: Placed, direction: Any
    ) -> tuple[Any, Any, tuple[tuple[Any, Any], ...]]:
        """Way from the other point to the point, m, complex in the frame; unit vector of a
        direction, rad from the x axis of the other body; and the ways along and across that in the
        axes of the other body, m, with their speeds there, m/s.
        """
        arm = at.point(self.link, self.point) - at.point(self.on, self.to)
        velocity = at.velocity(self.link, self.point) - at.velocity(self.on, self.to)
        along = at.turned(self.on, direction)
        rate = at.rate(self.on)
        ways = tuple(
            (dot(way, arm), dot(way, velocity) + cross(way, arm) * rate)
            for way in (along, 1j * along)
        )
        return arm, along, ways


def wrong_end_points(where: str, item: Any, bodies: Bodies, itself: Note) -> Iterator[ModelError]:
    """What is wrong with bodies and points of something between two points, of which the other is
    one of the frame where it names no body.

    itself : sentence for a link on itself.
    """
    link, point, to, on = item.link, item.point, item.to, getattr(item, "on", FRAME)
    wrong = [
        *unknown_link(f"{where}.link", link, bodies),
        *unknown_body(f"{where}.on", on, bodies),
    ]
    yield from wrong
    if wrong:
        return
    if link == on:
        yield ModelError(f"{where}.on", itself)
    if point not in bodies[link]:
        of = Note("point of {body}", body=link)
        yield ModelError(f"{where}.point", unknown(point, bodies[link], of))
    if to not in bodies[on]:
        kind: Note | str = "point of the frame"
        if on != FRAME:
            kind = Note("point of {body}", body=on)
        yield ModelError(f"{where}.to", unknown(to, bodies[on], kind))


class BetweenBodies:
    """Between `link` and `on`, whatever their places."""

    link: str
    on: str

    @property
    def bodies(self) -> tuple[str, str]:
        """The link and the other body."""
        return self.link, self.on

    @property
    def label(self) -> Note:
        """Both bodies, which distinguish it from others of its kind."""
        return Note("{link} on {on}", link=self.link, on=self.on)

    @property
    def route(self) -> tuple[str, str]:
        """From the other body to the link."""
        return self.on, self.link

    def wrong_bodies(self, where: str, bodies: Bodies) -> Iterator[ModelError]:
        """What is wrong with the link and the other body."""
        yield from unknown_link(f"{where}.link", self.link, bodies)
        yield from unknown_body(f"{where}.on", self.on, bodies)
        if self.link == self.on:
            wrong = Note("{link!r} cannot be turned against itself", link=self.link)
            yield ModelError(f"{where}.on", wrong)
