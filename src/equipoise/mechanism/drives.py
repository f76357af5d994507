"""What drives a machine, as a frozen value."""

from __future__ import annotations

from math import copysign

from equipoise.i18n import to_say
from equipoise.keys import NO_INERTIA, Frozen, Listing, Quantity, Table, Text, declared, key
from equipoise.mechanism.force_elements import Motor


@declared
class Drive(Frozen):
    """The link that is driven."""

    called = to_say("{what} of the drive")
    file_order = ("link", "speed", "speeds")

    link: str = key(
        Text(of="link"),
        "the driven link; it shares exactly one point with the frame, about which it turns",
        example="crank",
    )
    speed: float = key("angular speed", "positive is counterclockwise", example="193 rpm")
    acceleration: float = key(
        "angular acceleration", "of the driven link, at every crank angle analysed", default=0.0
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

    @property
    def range(self) -> tuple[float, float] | None:
        """The slowest and the fastest speed, rad/s, with the sign of `speed`; None if not told."""
        if not self.speeds:
            return None
        slow, fast = self.speeds
        return copysign(slow, self.speed), copysign(fast, self.speed)
