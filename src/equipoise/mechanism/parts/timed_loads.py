"""Loads over the time of a run, as frozen values with their checks."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Callable, Iterator
from typing import Any, ClassVar, Literal

from equipoise.errors import ModelError
from equipoise.i18n import Note, to_say
from equipoise.keys import (
    Conditions,
    Frozen,
    Listing,
    Number,
    Quantity,
    TextKind,
    declared,
    key,
    lacks,
)
from equipoise.mechanism.checks import (
    FRAME,
    Bodies,
    Vector,
    unknown_body,
    unknown_link,
    unknown_point,
)
from equipoise.mechanism.parts.lines import AlongLine, wrong_line
from equipoise.mechanism.parts.ramps import wrong_rows


@declared
class TimedLoad(AlongLine, Frozen):
    """A force at a point of a link, or a torque on a link, that changes with the time of a run.

    It is `force` or `torque` times a factor, linear between rows; before the first row and after
    the last nothing acts.  An analysis at constant speed knows no time and leaves it out.
    """

    called = to_say("{what} of load {number} over time")
    file_order = ("link", "point", "on", "force", "torque", "axes", "toward", "times", "factors")
    conditions: ClassVar[Conditions] = {
        "oneOf": [{"required": [name]} for name in ("force", "torque")],
        "dependentRequired": {
            "force": ["point"],
            "axes": ["point"],
            "toward": ["point"],
            "point": ["force"],
        },
        "dependentSchemas": {"toward": lacks("axes")},
    }

    link: str = key(TextKind(of="link"), "the loaded link", example="ram")
    times: tuple[float, ...] = key(
        Listing(Quantity("time"), right=Note('a list such as ["0 s", "0.5 s"]')),
        "from the start of the run, rising",
        example=["0 s", "0.5 s"],
    )
    factors: tuple[float, ...] = key(
        Listing(Number(), right=Note("a list such as [0, 1]")),
        "by which force or torque is multiplied at these times; linear between them, and 0 before "
        "the first and after the last",
        example=[0, 1],
    )
    point: str | None = key(
        TextKind(of="point", on="link"), "where a force acts; not for torques", default=None
    )
    on: str = key(
        TextKind(of="body"),
        "what bears its opposite, in the same line: the frame, or a link",
        default=FRAME,
        word=to_say("other body"),
    )
    force: Vector | None = key(
        Listing(Quantity("force"), (2,)), "along x and y of the frame, or of `axes`", default=None
    )
    torque: float | None = key("torque", "positive counterclockwise", default=None)
    axes: Literal["link"] | None = key(
        TextKind(("link",)),
        "`link` for a force in the axes of the loaded link, which turns with it; those of the "
        "frame where left out",
        default=None,
    )
    toward: str | None = key(
        TextKind(of="point", on="on"),
        "point of `on`, towards which the x axis of the force points from `point`, wherever both "
        "are: a force above 0 pulls them together; in the place of `axes`",
        default=None,
        example="S",
    )

    @property
    def bearer(self) -> str:
        return self.on

    def axes_angle(self, sliders: Any) -> float:
        """From the x axis of its link to the one along which its force is given, rad."""
        return 0.0

    def line_after(self, instant: float) -> Callable[[Any], Any]:
        """The line that its factor follows just after an instant, s, by the time, s."""
        row = bisect_right(self.times, instant)
        if not 0 < row < len(self.times):
            return lambda time: 0.0 * time
        first, factor = self.times[row - 1], self.factors[row - 1]
        slope = (self.factors[row] - factor) / (self.times[row] - first)
        return lambda time: factor + slope * (time - first)


def wrong_timed_load(where: str, load: TimedLoad, bodies: Bodies) -> Iterator[ModelError]:
    """Everything that is wrong with a load over time."""
    if problem := [*unknown_link(f"{where}.link", load.link, bodies)]:
        yield from problem
        return
    yield from unknown_body(f"{where}.on", load.on, bodies)
    if load.on == load.link:
        yield ModelError(f"{where}.on", Note("{link!r} cannot push itself", link=load.link))
    if (load.force is None) == (load.torque is None):
        yield ModelError(where, Note("give exactly one of force and torque"))
    elif load.force is not None and load.point is None:
        yield ModelError(f"{where}.point", Note("missing; a force acts at a point of the link"))
    elif load.force is None and load.point is not None:
        yield ModelError(
            f"{where}.point", Note("a torque acts on a link, not at a point; leave it out")
        )
    elif load.force is None and load.axes is not None:
        yield ModelError(f"{where}.axes", Note("goes with a force; leave it out"))
    if load.point is not None:
        yield from unknown_point(f"{where}.point", load.point, load.link, bodies)
    yield from wrong_line(where, load, bodies)
    yield from wrong_rows(f"{where}.times", ("times", "factors"), load.times, load.factors)
    if load.times and load.times[0] < 0:
        yield ModelError(f"{where}.times", Note("a run begins at 0 s; give times of 0 or more"))
