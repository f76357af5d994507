"""A servo motor: a controller of speed and angle, within a limit of torque."""

from __future__ import annotations

from math import inf

from equipoise.i18n import to_say
from equipoise.keys import Frozen, declared, key


@declared
class ServoMotor(Frozen):
    """T = k_w (w_ref - w) + k_a (a_ref - a), within the limit of torque, of speed w and angle a.

    The reference speed w_ref rises evenly from the speed at the start; a_ref is its integral.
    """

    called = to_say("{what} of the motor")

    speed: float = key(
        "angular speed", "of the motor, that the controller holds", example="3000 rpm", above=0
    )
    torque_limit: float = key(
        "torque", "the largest of the motor, in either sense", example="7 N m", above=0
    )
    speed_gain: float = key(
        "torsional damping", "torque for a deviation of the speed", example="0.2 N m s/rad",
        above=0,
    )  # fmt: skip
    angle_gain: float = key(
        "torsional stiffness", "torque for the angle by which the motor lags behind the integral "
        "of its reference speed; `run` computes it", default=0.0, example="4 N m/rad", at_least=0,
    )  # fmt: skip
    acceleration: float | None = key(
        "angular acceleration", "with which the reference speed of a `run` changes from that at "
        "the start; at once where left out", default=None, example="300 rad/s^2", above=0,
    )  # fmt: skip

    @property
    def rows(self) -> tuple[tuple[float, ...], tuple[float, ...]]:
        """Speeds, rad/s, and torques, N m, between which and beyond the curve by speed alone is
        straight.
        """
        most, band = self.torque_limit, self.torque_limit / self.speed_gain
        speeds = [self.speed + share * band for share in (-2, -1, 1, 2)]
        return tuple(speeds), (most, most, -most, -most)

    @property
    def remembers(self) -> bool:
        """Whether the torque depends on time or angle, and not on speed alone."""
        return self.angle_gain > 0 or self.acceleration is not None

    @property
    def stall_torque(self) -> float:
        """Torque, N m, on a motor that is held at rest, once it is steady."""
        lasting = inf if self.angle_gain else self.speed_gain * self.speed
        return min(self.torque_limit, lasting)
