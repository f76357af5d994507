"""What drives a machine, as values with their checks: how driven links move with the crank."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from fractions import Fraction
from math import copysign
from typing import Any, ClassVar, Literal

from equipoise.dataclass import remembered
from equipoise.errors import ModelError
from equipoise.i18n import Note, to_say
from equipoise.keys import (
    NO_INERTIA,
    Flag,
    Frozen,
    KeyConditions,
    KeyTable,
    Listing,
    MenuItem,
    Number,
    Quantity,
    TextKind,
    declared,
    key,
)
from equipoise.mechanism.checks import Bodies, bodies_at, unknown, unknown_link, wrong_speeds
from equipoise.mechanism.parts import commanded
from equipoise.mechanism.parts.couplings import as_fraction
from equipoise.mechanism.parts.laws import MOST_TURNS, AngleLaw, LengthLaw, wrong_law
from equipoise.mechanism.parts.motors import Motor, wrong_motor


class Pushing:
    """What may push: a cylinder between two points, or a driven sliding joint."""

    between: tuple[str, str] | None
    slider: str
    stroke: LengthLaw | None
    motor: Motor | None
    free: bool

    @property
    def moves_freely(self) -> bool:
        """Whether its motion in a run of several drives follows from forces."""
        return self.free or self.motor is not None

    @property
    def pushes(self) -> bool:
        """Whether a force drives, and not a torque."""
        return self.stroke is not None

    @property
    def group(self) -> str:
        """What machines with such a drive are found by; empty for a crank."""
        return to_say("hydraulic cylinder") if self.between else ""

    @property
    def effort_in(self) -> Literal["force", "torque"]:
        """What it exerts."""
        return "force" if self.pushes else "torque"

    def ends(self, bodies: Bodies) -> tuple[str, str]:
        """The bodies between which a cylinder acts."""
        assert self.between is not None
        at = bodies_at(bodies)
        first, second = (at[point] for point in self.between)
        return first[0], next((body for body in second if body != first[0]), first[0])


def _between() -> Any:
    return key(
        Listing(TextKind(of="point"), (2,)),
        "points of two bodies that a cylinder without mass drives, by the length between them; at "
        "a pin of several bodies it acts on the first of these",
        default=None,
        example=["A", "B"],
    )


def _slider() -> Any:
    return key(
        TextKind(),
        "a sliding joint that is driven instead, by its travel, such as `rod on barrel`",
        default="",
        example="rod on barrel",
    )


def _stroke() -> Any:
    return key(
        KeyTable(LengthLaw, headed=True),
        "length of the cylinder, or travel of the sliding joint, over the cycle, which runs at "
        "`speed`",
        default=None,
    )


def _free() -> Any:
    return key(
        Flag(),
        "true where nothing drives it in `run`, so that it starts as given here and goes on as "
        "forces let it",
        default=False,
    )


@declared
class Drive(Pushing, Frozen):
    """The link that is driven, or that determines the pose of a machine that is pushed.

    The crank angle is the phase of the cycle, and turns at `speed`.  Without a motion of its own
    the driven link's angle is the crank angle; with one it follows that law.  A stroke is the
    length of a cylinder between two points, or the travel of a sliding joint, whose force drives.
    """

    called = to_say("{what} of the drive")
    menu_item = MenuItem(to_say("Cylinder …"), ({"link": "link", "between": "ends"},))
    file_order = ("link", "speed", "speeds")
    conditions: ClassVar[KeyConditions] = {
        "dependentRequired": {"between": ["stroke"], "slider": ["stroke"], "start": ["stroke"]}
    }

    link: str = key(
        TextKind(of="link"),
        "the driven link; it shares exactly one point with the frame, about which it turns; of a "
        "machine that a cylinder drives a link that does so and whose angle determines the pose",
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
    brake: float = key(
        "torque",
        "of a brake on the driven link, which `run` applies while no motor is on",
        default=0.0,
        example="5 N m",
        at_least=0,
    )
    motor: Motor | None = key(KeyTable(Motor, headed=True), "what drives it", default=None)
    speeds: tuple[float, ...] = key(
        Listing(Quantity("angular speed"), (2,), Note('a list such as ["150 rpm", "240 rpm"]')),
        "the slowest and the fastest at which the machine runs, in the direction of `speed`; over "
        "these it is judged, swept and balanced",
        default=(),
        example=["150 rpm", "240 rpm"],
        above=0,
        why=Note("give both as more than 0; they count in the direction of speed"),
    )
    motion: AngleLaw | None = key(
        KeyTable(AngleLaw, headed=True),
        "how the driven link's angle goes with the crank angle, which turns at `speed`; they are "
        "the same where it is left out",
        default=None,
    )
    free: bool = _free()
    between: tuple[str, str] | None = _between()
    slider: str = _slider()
    stroke: LengthLaw | None = _stroke()
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
    def effort(self) -> str:
        """Name of the output of what the drive exerts: a force or a torque."""
        return "drive_force" if self.pushes else "drive_torque"

    @property
    def shaft_inertia(self) -> float:
        """Moment of inertia of flywheel and rotor as the crank feels it, kg m^2."""
        return self.flywheel + (0.0 if self.motor is None else self.motor.reflected_inertia)

    @property
    def range(self) -> tuple[float, float] | None:
        """The slowest and the fastest speed, rad/s, with the sign of `speed`; None if not given."""
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
class FurtherDrive(Pushing, Frozen):
    """Another driven link, whose motion has a common period with the crank angle."""

    called = to_say("{what} of the drive of the {link}")
    conditions: ClassVar[KeyConditions] = {
        "dependentRequired": {"between": ["stroke"], "slider": ["stroke"]},
        "dependentSchemas": {
            "motion": {"properties": {"ratio": False, "start": False}},
            "stroke": {"properties": {"ratio": False, "motion": False}},
        },
    }

    link: str = key(
        TextKind(of="link"),
        "the driven link; it shares exactly one point with the frame, about which it turns; one "
        "that is pushed may turn about a point of another link",
        example="second crank",
    )
    ratio: float = key(
        Number(),
        "turns in a turn of the crank; negative turns the other way",
        default=1.0,
        word=to_say("turns in a turn of the crank"),
    )
    start: float = key(
        "angle",
        "in the frame at crank angle 0; of a link that is pushed, roughly",
        default=0.0,
        word=to_say("angle at the start"),
    )
    motion: AngleLaw | None = key(
        KeyTable(AngleLaw, headed=True),
        "how its angle goes with the crank angle, instead of `ratio` and `start`",
        default=None,
    )
    motor: Motor | None = key(
        KeyTable(Motor, headed=True),
        "what drives it in `run`, from its angle at crank angle 0 on; analyses take the motion "
        "that is given",
        default=None,
    )
    free: bool = _free()
    between: tuple[str, str] | None = _between()
    slider: str = _slider()
    stroke: LengthLaw | None = _stroke()

    def turned(self, crank_angle: Any) -> tuple[Any, Any, Any]:
        """Angle of a driven link at crank angles (...), and its two derivatives by them."""
        if self.motion is not None:
            return self.motion.value(crank_angle)
        return self.ratio * crank_angle + self.start, self.ratio, 0.0

    @property
    def turns(self) -> int:
        """Turns of the crank after which it moves as before."""
        if (law := self.motion or self.stroke) is not None:
            return law.turns
        exact = as_fraction(self.ratio)
        return 1 if exact is None else exact.denominator


TURNING = "turning"
"""In the memory of a machine."""


class Driven:
    """What is driven of a machine."""

    drive: Drive
    drives: tuple[FurtherDrive, ...]

    memory: dict[str, Any]

    @remembered
    def turning(self) -> Any:
        """The source of the angles of links that are pushed; None where none is."""
        return commanded.finders[0](self) if self.pushers else None

    def moved(self, crank_angle: Any) -> dict[str, tuple[Any, Any, Any]]:
        """Angle of each driven link at crank angles (...), and its two derivatives by them."""
        parts = {drive.link: drive.turned(crank_angle) for drive in self.driven}
        if self.turning is not None:
            parts |= self.turning.moved(crank_angle)
        return parts

    @property
    def laws(self) -> dict[str, AngleLaw | LengthLaw]:
        """Motion laws of the drives, by the names of their links."""
        each = ((item.link, item.motion or item.stroke) for item in self.driven)
        return {link: law for link, law in each if law is not None}

    @property
    def pushers(self) -> tuple[Drive | FurtherDrive, ...]:
        """Drives that push."""
        return tuple(drive for drive in self.driven if drive.pushes)

    @property
    def driven(self) -> tuple[Drive | FurtherDrive, ...]:
        """All drives; the crank angle is that of the first."""
        return (self.drive, *self.drives)

    @property
    def listed_drives(self) -> list[str]:
        """Links of all drives, where there is more than one crank or stroke; else empty."""
        alone = self.has_crank or (self.drive.pushes and not self.drives)
        return [] if alone else [item.link for item in self.driven]

    @property
    def has_crank(self) -> bool:
        """Whether one link alone is driven and turns with the crank angle."""
        return not self.drives and self.crank_turns

    @property
    def crank_turns(self) -> bool:
        """Whether the first driven link turns evenly; else the crank angle is a phase alone."""
        return not (self.drive.motion or self.drive.pushes)

    @property
    def only_swings(self) -> bool:
        """Whether every drive goes to and fro, so that no link is driven at a speed in rpm."""
        laws = [item.motion or item.stroke for item in self.driven]
        return all(law is not None and not law.windings for law in laws)


OF_CRANKS = Note("turns with the crank, and here the driven link has a motion; leave it out")


def wrong_together(first: Drive, others: Sequence[FurtherDrive]) -> Iterator[ModelError]:
    """Everything that is wrong with drives beside each other."""
    links = [first.link, *(item.link for item in others)]
    for number, link in enumerate(links[1:], 1):
        if link in links[:number]:
            note = Note("{link!r} has a drive already; leave one of them out", link=link)
            yield ModelError(f"drives[{number}].link", note)


def wrong_further(
    where: str, drive: FurtherDrive, bodies: Bodies, sliders: list[str]
) -> Iterator[ModelError]:
    """Everything that is wrong with a further drive."""
    yield from unknown_link(f"{where}.link", drive.link, bodies)
    yield from _wrong_push(where, drive, bodies, sliders)
    yield from _wrong_mover(where, drive)
    if drive.motor is not None and (drive.motion is not None or drive.pushes):
        yield ModelError(f"{where}.motor", OF_CRANKS)
    if drive.pushes:
        if drive.ratio != 1:
            yield ModelError(where, Note("give either stroke, or ratio"))
        return
    if drive.motion is not None:
        yield from wrong_law(f"{where}.motion", drive.motion)
        if drive.ratio != 1 or drive.start:
            yield ModelError(where, Note("give either motion, or ratio and start"))
    elif as_fraction(drive.ratio) is None or drive.turns > MOST_TURNS:
        limit_denominator = Fraction(drive.ratio).limit_denominator(MOST_TURNS)
        yield ModelError(
            f"{where}.ratio",
            Note(
                "got {ratio!r}, with which the motion does not repeat within {most} turns of the "
                "crank; give a fraction of small whole numbers to all digits, such as {near!r} for "
                "{fraction}",
                ratio=drive.ratio,
                most=MOST_TURNS,
                near=float(limit_denominator),
                fraction=str(limit_denominator),
            ),
        )


def wrong_drive(drive: Drive, bodies: Bodies, sliders: list[str]) -> Iterator[ModelError]:
    """Everything that is wrong with the drive, but for its link."""
    if drive.speeds:
        yield from wrong_speeds("drive.speeds", drive.speeds)
    yield from _wrong_push("drive", drive, bodies, sliders)
    yield from _wrong_mover("drive", drive)
    if drive.motion is not None:
        yield from wrong_law("drive.motion", drive.motion)
    if drive.motion is None and drive.stroke is None:
        return
    for name in ("motor", "flywheel", "brake"):
        if getattr(drive, name):
            yield ModelError(f"drive.{name}", OF_CRANKS)


def _wrong_mover(where: str, drive: Drive | FurtherDrive) -> Iterator[ModelError]:
    """What is wrong with a drive that moves freely."""
    if drive.motor is not None:
        yield from wrong_motor(f"{where}.motor", drive.motor)
    if drive.free and drive.motor is not None:
        yield ModelError(f"{where}.free", Note("a motor drives it; leave one of them out"))
    if drive.free and drive.pushes:
        note = Note("a stroke moves the link, and no run lets it go; leave one of them out")
        yield ModelError(f"{where}.free", note)


def _wrong_push(
    where: str, drive: Drive | FurtherDrive, bodies: Bodies, sliders: list[str]
) -> Iterator[ModelError]:
    """Everything that is wrong with a stroke and what has it."""
    law = drive.stroke
    if law is None:
        for name in ("between", "slider", "start") if where == "drive" else ("between", "slider"):
            if getattr(drive, name) not in (None, ""):
                note = Note(
                    "is given, but no stroke; say how long it is in [{place}]",
                    place=f"{where.partition('[')[0]}.stroke",
                )
                yield ModelError(f"{where}.{name}", note)
        return
    if (drive.between is None) == (not drive.slider):
        yield ModelError(f"{where}.stroke", Note("give either between or slider with it"))
    elif drive.motion is not None:
        yield ModelError(f"{where}.motion", Note("a stroke moves the link already; leave it out"))
    else:
        yield from _wrong_ends(where, drive, bodies, sliders)
        yield from wrong_law(f"{where}.stroke", law)


def _wrong_ends(
    where: str, drive: Drive | FurtherDrive, bodies: Bodies, sliders: list[str]
) -> Iterator[ModelError]:
    if drive.between is None:
        if drive.slider not in sliders:
            yield ModelError(f"{where}.slider", unknown(drive.slider, sliders, "slider"))
        return
    known = bodies_at(bodies)
    for number, point in enumerate(drive.between, 1):
        if point not in known:
            yield ModelError(f"{where}.between[{number}]", unknown(point, known, "point"))
            return
    first, second = drive.ends(bodies)
    if first == second:
        note = Note("both points are of {body!r}; give points of two bodies", body=first)
        yield ModelError(f"{where}.between", note)
