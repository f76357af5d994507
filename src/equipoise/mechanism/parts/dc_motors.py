"""A direct-current motor with brushes or a permanent field, by its electric circuit."""

from __future__ import annotations

from typing import Any

from equipoise.i18n import to_say
from equipoise.keys import Frozen, declared, key


@declared
class DcMotor(Frozen):
    """A motor of constant field: L di/dt = U - R i - k w, and its torque is k i."""

    called = to_say("{what} of the motor")

    voltage: float = key("voltage", "of the supply", example="24 V", above=0)
    resistance: float = key("resistance", "of armature and leads", example="0.4 ohm", above=0)
    torque_constant: float = key(
        "torque constant", "torque for a current, and voltage for a speed", example="0.08 N m/A",
        above=0,
    )  # fmt: skip
    inductance: float = key(
        "inductance", "of the armature; `run` computes how the current follows", default=0.0,
        example="0.6 mH", at_least=0,
    )  # fmt: skip

    @property
    def no_load_speed(self) -> float:
        """Speed, rad/s, at which it takes no current."""
        return self.voltage / self.torque_constant

    @property
    def stall_torque(self) -> float:
        """Torque, N m, at standstill, once the current is steady."""
        return self.torque_constant * self.voltage / self.resistance

    def steady_current(self, speed: Any) -> Any:
        """Current (...), A, at speeds (...), rad/s, that last."""
        return (self.voltage - self.torque_constant * speed) / self.resistance
