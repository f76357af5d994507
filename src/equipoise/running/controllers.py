"""The controller of a servo motor in a run: its reference, and its torque by speed, angle and time.

Speeds and angles are the motor's, and positive in the sense in which it drives.
"""

from __future__ import annotations

from math import copysign, sqrt

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.mechanism.parts.servo_motors import ServoMotor
from equipoise.signals import Array


@dataclass(frozen=True)
class Controller:
    """Of a servo motor.

    first : speed, rad/s, at time 0, where its angle is 0.
    lag : rad, by which the angle is behind its reference then.
    """

    servo: ServoMotor
    first: float
    lag: float = 0.0

    @property
    def ramp_end(self) -> float:
        """Time, s, at which the reference speed is that of the servo motor."""
        servo = self.servo
        if servo.acceleration is None:
            return 0.0
        return abs(servo.speed - self.first) / servo.acceleration

    @property
    def rate(self) -> float:
        """Of the reference speed, rad/s^2, until then."""
        return copysign(self.servo.acceleration or 0.0, self.servo.speed - self.first)

    def reference(self, time: Array | float) -> tuple[Array, Array]:
        """Reference speed (...), rad/s, and angle (...), rad, at times (...), s."""
        servo, end = self.servo, self.ramp_end
        on_ramp = np.minimum(time, end)
        gained = self.rate * on_ramp
        angle = (self.first + gained / 2) * on_ramp + servo.speed * (time - on_ramp)
        speed = self.first + gained if end else np.full_like(on_ramp, servo.speed)
        return np.asarray(speed), np.asarray(angle + self.lag)

    def demand(self, speed: Array | float, angle: Array | float, time: Array | float) -> Array:
        """Torque (...), N m, without the limit, at speeds (...), rad/s, angles (...), rad, and
        times (...), s.
        """
        servo = self.servo
        wanted_speed, wanted_angle = self.reference(time)
        return np.asarray(
            servo.speed_gain * (wanted_speed - speed) + servo.angle_gain * (wanted_angle - angle)
        )

    def torque(self, speed: Array | float, angle: Array | float, time: Array | float) -> Array:
        """Torque (...), N m, at speeds (...), rad/s, angles (...), rad, and times (...), s."""
        most = self.servo.torque_limit
        return np.clip(self.demand(speed, angle, time), -most, most)

    def time_until(self, torque: float, angle: float, since: float) -> float:
        """Time, s, from `since` on, at which the torque on a motor held at rest at an angle, rad,
        reaches a value, N m, of at most the servo motor's `stall_torque`.
        """
        by_speed, by_angle = self.servo.speed_gain, self.servo.angle_gain

        def exceeds(time: float) -> float:
            speed, way = self.reference(time)
            return float(by_speed * speed + by_angle * (way - angle)) - torque

        if exceeds(since) >= 0:
            return since
        end = max(self.ramp_end, since)
        if (left := exceeds(end)) <= 0:
            return end - (left / (by_angle * self.servo.speed) if by_angle else 0.0)
        square = by_angle * self.rate / 2
        linear = by_speed * self.rate + by_angle * self.first
        constant = by_speed * self.first + by_angle * (self.lag - angle) - torque
        # of both roots that at which the torque rises
        return -2 * constant / (linear + sqrt(linear**2 - 4 * square * constant))
