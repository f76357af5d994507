"""How a machine is run: start and end, loads over time, and the states of its working life."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import Any, ClassVar, Literal

from equipoise.errors import ModelError
from equipoise.i18n import Note, to_say
from equipoise.keys import (
    Flag,
    Frozen,
    KeyConditions,
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
from equipoise.mechanism.parts.loads import AlongLine, Load, wrong_line
from equipoise.mechanism.parts.row_laws import wrong_rows

MOST_TURNS = 10_000


@declared
class RunPlan(Frozen):
    """Start and end of a run; what is left out is as in a run of a file without this table."""

    called = to_say("{what} of the run")

    duration: float | None = key(
        "time", "after which the run ends", default=None, example="2 s", above=0
    )
    turns: float | None = key(
        Number(), "of the crank, after which the run ends; 10000 at most", default=None, example=30,
        above=0, below=MOST_TURNS + 1,
    )  # fmt: skip
    speed: float | None = key(
        "angular speed", "of the crank at the start; 0 with a motor, else the drive's, where left "
        "out", default=None, example="0 rpm",
    )  # fmt: skip
    angle: float = key("angle", "of the crank at the start", default=0.0)
    off: float | None = key(
        "time", "at which the motor is switched off", default=None, example="1.5 s", above=0
    )
    off_turns: float | None = key(
        Number(), "of the crank, after which the motor is switched off", default=None, example=20,
        above=0,
    )  # fmt: skip
    support: bool = key(
        Flag(), "whether the support moves too; else the frame is fixed", default=False
    )


@declared
class DutyState(Frozen):
    """One state of a machine's duty; lives of its bearings and links are those of all states
    together.
    """

    called = to_say("{what} of duty state {number}")

    share: float = key(
        Number(), "of the operating time, against the sum of all shares", example=0.3, above=0
    )
    speed: float | None = key(
        "angular speed", "of the crank, in the direction of the drive's speed, which it has where "
        "left out", default=None, example="150 rpm", above=0,
    )  # fmt: skip
    load_factor: float = key(
        Number(), "by which all `loads` are multiplied; 0 for none", default=1.0, at_least=0
    )

    def scaled(self, loads: tuple[Load, ...]) -> tuple[Load, ...]:
        """Loads of a machine as they are in this state."""
        return tuple(_scaled(load, self.load_factor) for load in loads)


def _scaled(load: Load, factor: float) -> Load:
    if load.force is not None:
        return replace(load, force=(load.force[0] * factor, load.force[1] * factor))
    if load.torque is not None:
        return replace(load, torque=load.torque * factor)
    for name, gas in (("gas", load.gas), ("indicator", load.indicator)):
        if gas is not None:
            beyond = (factor * (pressure - load.back_pressure) for pressure in gas.pressure)
            pressures = tuple(load.back_pressure + pressure for pressure in beyond)
            scaled: dict[str, Any] = {name: replace(gas, pressure=pressures)}
            return replace(load, **scaled)
    assert load.table is not None
    columns = tuple(tuple(value * factor for value in column) for column in load.table.values)
    return replace(load, table=replace(load.table, values=columns))


@declared
class TimedLoad(AlongLine, Frozen):
    """A force at a point of a link, or a torque on a link, that changes with the time of a run.

    It is `force` or `torque` times a factor, linear between rows; before the first row and after
    the last nothing acts.  An analysis at constant speed knows no time and leaves it out.
    """

    called = to_say("{what} of load {number} over time")
    file_order = ("link", "point", "on", "force", "torque", "axes", "toward", "times", "factors")
    conditions: ClassVar[KeyConditions] = {
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
