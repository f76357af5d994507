"""What drives a machine, as frozen values: how driven links move over the crank angle."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import cached_property
from importlib import import_module
from math import copysign
from typing import Any, ClassVar, Literal

from equipoise.errors import ModelError
from equipoise.i18n import Note, to_say
from equipoise.keys import (
    NO_INERTIA,
    Conditions,
    Frozen,
    Listing,
    Number,
    Quantity,
    Table,
    Text,
    declared,
    key,
)
from equipoise.mechanism.checks import Bodies, bodies_at, unknown, unknown_link, wrong_speeds
from equipoise.mechanism.couplings import as_fraction
from equipoise.mechanism.force_elements import Motor, wrong_motor
from equipoise.mechanism.laws import MOST_TURNS, AngleLaw, LengthLaw, wrong_law


@declared
class Drive(Frozen):
    """The link that is driven, or that tells the pose of a machine that is pushed.

    The crank angle is the phase of the cycle, and turns at `speed`.  Without a motion of its own
    the driven link's angle is the crank angle; with one it follows that law.  A stroke is the
    length of a cylinder between two points, or the travel of a sliding joint, whose force drives.
    """

    called = to_say("{what} of the drive")
    file_order = ("link", "speed", "speeds")
    conditions: ClassVar[Conditions] = {
        "dependentRequired": {"between": ["stroke"], "slider": ["stroke"], "start": ["stroke"]}
    }

    link: str = key(
        Text(of="link"),
        "the driven link; it shares exactly one point with the frame, about which it turns; of a "
        "machine that a cylinder drives a link that does so and whose angle tells the pose",
        example="crank",
    )
    speed: float = key("angular speed", "positive is counterclockwise", example="193 rpm")
    acceleration: float = key(
        "angular acceleration", "of the crank, at every crank angle analysed", default=0.0
    )
    flywheel: float = key(
        "inertia",
        "of what turns with the driven link beside it",
        default=0.0,
        at_least=0,
        why=NO_INERTIA,
    )
    motor: Motor | None = key(Table(Motor, headed=True), "what drives it", default=None)
    speeds: tuple[float, ...] = key(
        Listing(Quantity("angular speed"), (2,), 'a list such as ["150 rpm", "240 rpm"]'),
        "the slowest and the fastest at which the machine runs, in the direction of `speed`; over "
        "these it is judged, swept and balanced",
        default=(),
        example=["150 rpm", "240 rpm"],
        above=0,
    )
    motion: AngleLaw | None = key(
        Table(AngleLaw, headed=True),
        "how the driven link's angle goes with the crank angle, which turns at `speed`; they are "
        "the same where it is left out",
        default=None,
    )
    between: tuple[str, str] | None = key(
        Listing(Text(of="point"), (2,)),
        "points of two bodies that a cylinder without mass drives, by the length between them; at "
        "a pin of several bodies it acts on the first of these",
        default=None,
        example=["A", "B"],
    )
    slider: str = key(
        Text(),
        "a sliding joint that is driven instead, by its travel, such as `rod on barrel`",
        default="",
        example="rod on barrel",
    )
    stroke: LengthLaw | None = key(
        Table(LengthLaw, headed=True),
        "length of the cylinder, or travel of the sliding joint, over the cycle; `speed` tells how "
        "fast the cycle goes on",
        default=None,
    )
    start: float | None = key(
        "angle",
        "of the link at crank angle 0, roughly, where a stroke can be had in several poses",
        default=None,
        word=to_say("angle at the start"),
    )

    @property
    def crank(self) -> str:
        """The link whose angle is the crank angle; empty where none is."""
        return self.link if self.motion is None and self.stroke is None else ""

    @property
    def pushes(self) -> bool:
        """Whether a force drives the machine, and not a torque."""
        return self.stroke is not None

    @property
    def effort(self) -> str:
        """The output that tells what the drive exerts."""
        return "drive_force" if self.pushes else "drive_torque"

    @property
    def effort_in(self) -> Literal["force", "torque"]:
        """What that measures."""
        return "force" if self.pushes else "torque"

    def ends(self, bodies: Bodies) -> tuple[str, str]:
        """The bodies between which a cylinder acts."""
        assert self.between is not None
        at = bodies_at(bodies)
        first, second = (at[point] for point in self.between)
        return first[0], next((body for body in second if body != first[0]), first[0])

    @property
    def range(self) -> tuple[float, float] | None:
        """The slowest and the fastest speed, rad/s, with the sign of `speed`; None if not told."""
        if not self.speeds:
            return None
        slow, fast = self.speeds
        return copysign(slow, self.speed), copysign(fast, self.speed)

    def turned(self, crank_angle: Any) -> tuple[Any, Any, Any]:
        """Angle of the driven link at crank angles (...), and its two derivatives by them."""
        return (crank_angle, 1.0, 0.0) if self.motion is None else self.motion.value(crank_angle)

    @property
    def turns(self) -> int:
        """Turns of the crank after which the drive is back."""
        return next((law.turns for law in (self.motion, self.stroke) if law), 1)


@declared
class FurtherDrive(Frozen):
    """Another driven link, whose motion has a common period with the crank angle."""

    called = to_say("{what} of the drive of the {link}")
    conditions: ClassVar[Conditions] = {
        "dependentSchemas": {"motion": {"properties": {"ratio": False, "start": False}}}
    }

    link: str = key(
        Text(of="link"),
        "the driven link; it shares exactly one point with the frame, about which it turns",
        example="second crank",
    )
    ratio: float = key(
        Number(),
        "turns in a turn of the crank; negative turns the other way",
        default=1.0,
        word=to_say("turns in a turn of the crank"),
    )
    start: float = key(
        "angle", "in the frame at crank angle 0", default=0.0, word=to_say("angle at the start")
    )
    motion: AngleLaw | None = key(
        Table(AngleLaw, headed=True),
        "how its angle goes with the crank angle, instead of `ratio` and `start`",
        default=None,
    )

    def turned(self, crank_angle: Any) -> tuple[Any, Any, Any]:
        """Its angle at crank angles (...), and its two derivatives by them."""
        if self.motion is not None:
            return self.motion.value(crank_angle)
        return self.ratio * crank_angle + self.start, self.ratio, 0.0

    @property
    def turns(self) -> int:
        """Turns of the crank after which it moves as before."""
        if self.motion is not None:
            return self.motion.turns
        exact = as_fraction(self.ratio)
        return 1 if exact is None else exact.denominator


class Driven:
    """What is driven of a machine."""

    drive: Drive
    drives: tuple[FurtherDrive, ...]

    @cached_property
    def turning(self) -> Any:
        """What tells the angle of the drive's link where a stroke does; None elsewhere."""
        if not self.drive.pushes:
            return None
        return import_module("equipoise.mechanism.cylinders").commanded(self)  # which needs this

    def moved(self, crank_angle: Any) -> dict[str, tuple[Any, Any, Any]]:
        """Angle of each driven link at crank angles (...), and its two derivatives by them."""
        found = {drive.link: drive.turned(crank_angle) for drive in self.driven}
        if self.turning is not None:
            found[self.drive.link] = self.turning.value(crank_angle)
        return found

    @property
    def driven(self) -> tuple[Drive | FurtherDrive, ...]:
        """All drives; the crank angle is that of the first."""
        return (self.drive, *self.drives)

    @property
    def told_drives(self) -> list[str]:
        """Links that a torque drives, where there is more to tell than of one crank."""
        return [] if self.has_crank or self.drive.pushes else [one.link for one in self.driven]

    @property
    def has_crank(self) -> bool:
        """Whether one link alone is driven and turns with the crank angle."""
        return not (self.drives or self.drive.motion or self.drive.pushes)


# -- checks ----------------------------------------------------------------------------------------


def wrong_together(first: Drive, others: Sequence[FurtherDrive]) -> Iterator[ModelError]:
    """Everything that is wrong with drives beside each other."""
    links = [first.link, *(one.link for one in others)]
    for number, link in enumerate(links[1:], 1):
        if link in links[:number]:
            told = Note("{link!r} has a drive already; leave one of them out", link=link)
            yield ModelError(f"drives[{number}].link", told)
    if others and first.pushes:
        yield ModelError("drives", Note("a stroke drives alone; leave either of them out"))


def wrong_further(where: str, drive: FurtherDrive, bodies: Bodies) -> Iterator[ModelError]:
    """Everything that is wrong with a further drive."""
    yield from unknown_link(f"{where}.link", drive.link, bodies)
    if drive.motion is not None:
        yield from wrong_law(f"{where}.motion", drive.motion)
        if drive.ratio != 1 or drive.start:
            yield ModelError(where, Note("give either motion, or ratio and start"))
    elif as_fraction(drive.ratio) is None or drive.turns > MOST_TURNS:
        yield ModelError(
            f"{where}.ratio",
            Note(
                "got {ratio!r}, with which the motion does not repeat within {most} turns of the "
                "crank; give a fraction of small whole numbers",
                ratio=drive.ratio,
                most=MOST_TURNS,
            ),
        )


def wrong_drive(drive: Drive, bodies: Bodies, sliders: list[str]) -> Iterator[ModelError]:
    """Everything that is wrong with the drive, but for its link."""
    if drive.speeds:
        yield from wrong_speeds("drive.speeds", drive.speeds)
    if drive.motor is not None:
        yield from wrong_motor("drive.motor", drive.motor)
    yield from _wrong_push(drive, bodies, sliders)
    if drive.motion is not None:
        yield from wrong_law("drive.motion", drive.motion)
    if drive.motion is None and drive.stroke is None:
        return
    for name, given in (("motor", drive.motor), ("flywheel", drive.flywheel)):
        if given:
            yield ModelError(
                f"drive.{name}",
                Note("turns with the crank, and here the driven link has a motion; leave it out"),
            )


def _wrong_push(drive: Drive, bodies: Bodies, sliders: list[str]) -> Iterator[ModelError]:
    """Everything that is wrong with a stroke and what has it."""
    law = drive.stroke
    if law is None:
        for name in ("between", "slider", "start"):
            if getattr(drive, name) not in (None, ""):
                told = Note("is given, but no stroke; say how long it is in [drive.stroke]")
                yield ModelError(f"drive.{name}", told)
        return
    if (drive.between is None) == (not drive.slider):
        yield ModelError("drive.stroke", Note("give either between or slider with it"))
    elif drive.motion is not None:
        yield ModelError("drive.motion", Note("a stroke moves the link already; leave it out"))
    else:
        yield from _wrong_ends(drive, bodies, sliders)
        yield from wrong_law("drive.stroke", law)


def _wrong_ends(drive: Drive, bodies: Bodies, sliders: list[str]) -> Iterator[ModelError]:
    if drive.between is None:
        if drive.slider not in sliders:
            yield ModelError("drive.slider", unknown(drive.slider, sliders, "slider"))
        return
    known = bodies_at(bodies)
    for number, point in enumerate(drive.between, 1):
        if point not in known:
            yield ModelError(f"drive.between[{number}]", unknown(point, known, "point"))
            return
    first, second = drive.ends(bodies)
    if first == second:
        told = Note("both points are of {body!r}; give points of two bodies", body=first)
        yield ModelError("drive.between", told)
