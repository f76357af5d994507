"""What drives a machine, as frozen values: how driven links move over the crank angle."""

from __future__ import annotations

from collections.abc import Iterator
from math import copysign
from typing import Any

from equipoise.errors import ModelError
from equipoise.i18n import Note, to_say
from equipoise.keys import NO_INERTIA, Frozen, Listing, Quantity, Table, Text, declared, key
from equipoise.mechanism.checks import wrong_speeds
from equipoise.mechanism.force_elements import Motor, wrong_motor
from equipoise.mechanism.laws import AngleLaw, wrong_law


@declared
class Drive(Frozen):
    """The link that is driven.

    The crank angle is the phase of the cycle, and turns at `speed`.  Without a motion of its own
    the driven link's angle is the crank angle; with one it follows that law.
    """

    called = to_say("{what} of the drive")
    file_order = ("link", "speed", "speeds")

    link: str = key(
        Text(of="link"),
        "the driven link; it shares exactly one point with the frame, about which it turns",
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
        """Turns of the crank after which the driven link moves as before."""
        return 1 if self.motion is None else self.motion.turns


# -- checks ----------------------------------------------------------------------------------------


def wrong_drive(drive: Drive) -> Iterator[ModelError]:
    """Everything that is wrong with the drive, but for its link."""
    if drive.speeds:
        yield from wrong_speeds("drive.speeds", drive.speeds)
    if drive.motor is not None:
        yield from wrong_motor("drive.motor", drive.motor)
    if drive.motion is None:
        return
    yield from wrong_law("drive.motion", drive.motion)
    for name, given in (("motor", drive.motor), ("flywheel", drive.flywheel)):
        if given:
            yield ModelError(
                f"drive.{name}",
                Note("turns with the crank, and here the driven link has a motion; leave it out"),
            )
