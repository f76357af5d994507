"""An induction motor by Kloss' formula, from its breakdown torque and slip."""

from __future__ import annotations

from math import sqrt
from typing import Any

from equipoise.i18n import to_say
from equipoise.keys import Frozen, Number, declared, key


@declared
class InductionMotor(Frozen):
    """A three-phase motor on a net: T = 2 T_b / (s / s_b + s_b / s) with the slip s.

    Resistance of the stator, and how the current in it sets in, are left out.
    """

    called = to_say("{what} of the motor")

    synchronous_speed: float = key(
        "angular speed", "of the field; torque is 0 there", example="1500 rpm", above=0
    )
    breakdown_torque: float = key("torque", "the largest", example="42 N m", above=0)
    breakdown_slip: float = key(
        Number(), "share of the synchronous speed by which it is slower there", example=0.22,
        above=0, below=1,
    )  # fmt: skip

    def torque(self, speed: Any) -> Any:
        """Torque (...), N m, at speeds (...), rad/s."""
        slip, least = 1 - speed / self.synchronous_speed, self.breakdown_slip
        return 2 * self.breakdown_torque * slip * least / (slip * slip + least * least)

    @property
    def breakdown_speed(self) -> float:
        """Speed, rad/s, at which its torque is largest."""
        return self.synchronous_speed * (1 - self.breakdown_slip)

    def speed_at(self, torque: float) -> float | None:
        """Speed, rad/s, at which its torque falls through a value; None where it never does."""
        share = torque / self.breakdown_torque
        if abs(share) > 1:
            return None
        slip = self.breakdown_slip * share / (1 + sqrt(1 - share * share))
        return self.synchronous_speed * (1 - slip)
