"""Linear springs between two points, as frozen values with their checks."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any, ClassVar

from equipoise.errors import ModelError
from equipoise.i18n import Note, to_say
from equipoise.keys import TextKind, declared, key
from equipoise.mechanism.checks import FRAME, Bodies, unknown, unknown_body, unknown_link
from equipoise.mechanism.formulas import kernels
from equipoise.mechanism.parts.between import BetweenPoints
from equipoise.mechanism.parts.element_kinds import Placed
from equipoise.mechanism.parts.force_kinds import Action, ForceElement
from equipoise.quantities import Dimension, told

MEETING = to_say(
    "{point!r} of {link!r} meets {to!r} at crank angle {angle:.6g} deg, where a spring with a free "
    "length points nowhere; give another point, or a {free_length} of 0"
)


@declared
class Spring(BetweenPoints, ForceElement):
    """A linear spring without mass: it pulls `point` of `link` towards the point `to` of `on`."""

    called = to_say("{what} of spring {number}")

    title = to_say("Springs, each with its crank angle; below 0 they push their ends apart")
    group = to_say("springs")
    outputs: ClassVar[Mapping[str, tuple[Dimension, str]]] = {
        "pull": ("force", to_say("pull of spring {name}")),
        "length": ("length", to_say("length of spring {name}")),
    }
    headings: ClassVar[Mapping[str, tuple[str, str]]] = {
        "length": (to_say("shortest"), to_say("longest")),
        "pull": (to_say("smallest pull"), to_say("largest")),
    }

    link: str = key(TextKind(of="link"), "the link that it pulls", example="rocker")
    point: str = key(
        TextKind(of="point", on="link"),
        "its point on the link, not one that is pinned to the frame",
        example="C",
    )
    to: str = key(
        TextKind(of="point", on="on"),
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
        TextKind(of="body"), "the body of its other point", default=FRAME, word=to_say("other body")
    )

    @property
    def meeting(self) -> str:
        """What is wrong where its ends meet, of a spring with a free length."""
        return MEETING if self.free_length else ""

    def ends(self, at: Placed) -> tuple[Any, Any]:
        """Places of both ends in the frame, complex, m."""
        return at.point(self.link, self.point), at.point(self.on, self.to)

    def actions(self, at: Placed) -> Iterator[Action]:
        """Force on each end, N, complex; it has no torque."""
        force = kernels.spring(*self.ends(at), self.stiffness, self.free_length)
        yield self.link, self.point, force, 0.0
        yield self.on, self.to, -force, 0.0

    def values(self, at: Placed) -> Mapping[str, Any]:
        """Its length, m, and its pull, N, less than 0 where it pushes."""
        place, to = self.ends(at)
        length = kernels.length(to - place)
        return {"length": length, "pull": self.stiffness * (length - self.free_length)}

    def problems(self, where: str, bodies: Bodies) -> Iterator[ModelError]:
        """Everything that is wrong with its ends in a machine of these bodies."""
        return wrong_ends(where, self, bodies)

    def sentence(self) -> Note:
        """Its stiffness and its ends, for a report."""
        return Note(
            "Spring: {stiffness} from {point} of {link} to {to}",
            stiffness=told(self.stiffness, "stiffness", "N/m"),
            point=self.point,
            link=self.link,
            to=self.to,
        )

    def summary(self) -> str:
        """All its numbers, in a line of `check`."""
        free = f", free at {told(self.free_length, 'length')}" if self.free_length else ""
        stiffness = told(self.stiffness, "stiffness", "N/m")
        return f"spring: from {self.point} of {self.link} to {self.to}, {stiffness}{free}"

    def demands(self) -> Iterator[Any]:
        """What has to be true of stiffness and free length, or of columns of them."""
        yield (self.stiffness > 0) & (self.free_length >= 0)


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
