"""What turns the crank: a motor by its curve or with its current, a servo with its controller.

Speeds and angles are the motor's, and positive in the sense in which it drives.
"""

from __future__ import annotations

from math import copysign, inf, log, sqrt

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.mechanism.parts.machine import Machine
from equipoise.mechanism.parts.motors import Motor, ServoMotor
from equipoise.signals import Array
from equipoise.vibration.steady import torque_on_crank


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


LIMIT_REACHED = 1e-9
"""Share of a servo motor's limit of torque within which it is at the limit."""


class Driver:
    """The drive of a machine: its torque on the crank by the crank's speed.

    sense : 1 where it turns the crank counterclockwise, -1 clockwise.  on : whether it is on.
    circuit : of a direct-current motor; None of any other.
    servo : of a servo motor; None of any other.
    limited : of a servo motor, 1 or -1 while it gives its limit of torque in or against the sense
        in which it drives, 0 between; the motion is smooth while that stays.
    brake : torque of the brake on the crank, N m, which acts while no motor is on; 0 without one.
    """

    def __init__(self, motor: Motor | None, speed: float, brake: float = 0.0) -> None:
        """motor : what drives it.  speed : with the sign of that at which it is to turn the driven
        link.  brake : torque of its brake, N m.
        """
        self.sense = copysign(1.0, speed)
        self.on = motor is not None
        self.brake = brake
        self._torque = None if motor is None else torque_on_crank(motor, speed)
        self.circuit = None if motor is None else motor.dc
        self.servo = None if motor is None else motor.servo
        self._gear = 1.0 if motor is None else self.sense * motor.ratio

    @classmethod
    def of(cls, machine: Machine) -> Driver:
        """Of the crank of a machine."""
        drive = machine.drive
        return cls(drive.motor, drive.speed, drive.brake)

    def begins(self, angle: float, speed: float, lag: float | None = None) -> None:
        """Start at a crank angle, rad, and speed, rad/s, at time 0.

        lag : of a servo motor behind its reference, rad, whose speed is constant then; it begins at
            the motor's own speed, without a lag, if None.
        """
        self._start = angle
        self.limited = 0
        if self.servo is not None:
            first = self._gear * speed if lag is None else self.servo.speed
            self._controller = Controller(self.servo, first, lag or 0.0)

    def torque(self, speed: Array) -> Array:
        """On the crank (...), N m, at its speed (...), rad/s, that lasts."""
        if self._torque is None or not self.on:
            return np.zeros_like(speed)
        if self.servo is not None and not np.any(speed):
            return np.full_like(speed, self._gear * self.servo.stall_torque)
        return self._torque(speed, np.zeros(()))

    def holding(self) -> float:
        """Torque of the brake, N m, that holds a crank at rest, and slows one that turns."""
        return 0.0 if self.on else self.brake

    # -- with its controller -----------------------------------------------------------------------

    @property
    def remembers(self) -> bool:
        """Whether its torque depends on time or angle besides speed: see `torque_at`."""
        return self.on and self.servo is not None and self.servo.remembers

    def torque_at(self, speed: Array, angle: Array, time: Array) -> Array:
        """On the crank (...), N m, at its speeds (...), rad/s, angles (...), rad, and times, s."""
        if not self.remembers:
            return self.torque(speed)
        turned = self._gear * (angle - self._start)
        own = self._controller.torque(self._gear * speed, turned, time)
        return np.asarray(self._gear * own)

    def lag_at(self, angle: float, time: float) -> float:
        """Of a servo motor behind its reference, rad, at a crank angle, rad, and time, s."""
        return float(self._controller.reference(time)[1]) - self._gear * (angle - self._start)

    @property
    def controlled(self) -> bool:
        """Whether a controller with a limit of torque drives."""
        return self.on and self.servo is not None

    def smooth_torque_at(self, speed: Array, angle: Array, time: Array) -> Array:
        """Torque (...), N m, as of `torque_at`, going on smoothly where `limited` would change."""
        assert self.servo is not None
        if self.limited:
            return np.full(np.shape(speed), self._gear * self.limited * self.servo.torque_limit)
        return self._gear * self._demand(speed, angle, time)

    def beyond(self, speed: Array, angle: Array, time: Array) -> Array:
        """By what share (...) of the limit of torque the state is beyond that in which `limited` is
        as it is; negative inside.
        """
        assert self.servo is not None
        share = self._demand(speed, angle, time) / self.servo.torque_limit
        return np.asarray(1 - self.limited * share if self.limited else np.abs(share) - 1)

    def observe(self, speed: float, angle: float, time: float, reached: bool = False) -> None:
        """Set `limited` by a state; `reached`: whether it is where that changes."""
        assert self.servo is not None
        share = float(self._demand(*map(np.asarray, (speed, angle, time))))
        share /= self.servo.torque_limit
        if reached:
            self.limited = 0 if self.limited else int(copysign(1, share))
        elif abs(abs(share) - 1) > LIMIT_REACHED:
            self.limited = int(copysign(1, share)) if abs(share) > 1 else 0

    def _demand(self, speed: Array, angle: Array, time: Array) -> Array:
        turned = self._gear * (angle - self._start)
        return self._controller.demand(self._gear * speed, turned, time)

    def driving_torque(self, speed: Array, current: Array, angle: Array, time: Array) -> Array:
        """On the crank (...), N m, by what it follows: its current (...), A, where that lags, its
        controller, as of `smooth_torque_at`, or else its speed alone.
        """
        if self.lags:
            return self.torque_of(current)
        if self.controlled:
            return self.smooth_torque_at(speed, angle, time)
        return self.torque(speed)

    @property
    def ramp_end(self) -> float:
        """Time, s, at which the controller's reference speed stops to change; 0 without a ramp."""
        return self._controller.ramp_end if self.remembers else 0.0

    # -- with its current --------------------------------------------------------------------------

    @property
    def lags(self) -> bool:
        """Whether its current follows its speed with a delay, and its torque the current."""
        return self.on and self.circuit is not None and self.circuit.inductance > 0

    @property
    def current_lag(self) -> float:
        """Time constant of a current that lags, s; infinite without one."""
        return (
            self.circuit.inductance / self.circuit.resistance if self.circuit and self.lags else inf
        )

    def torque_of(self, current: Array) -> Array:
        """On the crank (...), N m, of currents (...), A."""
        assert self.circuit is not None
        return np.asarray(self._gear * self.circuit.torque_constant * current)

    def current(self, speed: Array) -> Array:
        """Current (...), A, at speeds (...) of the crank, rad/s, that last."""
        if self.circuit is None or not self.on:
            return np.zeros_like(speed)
        return np.asarray(self.circuit.steady_current(self._gear * speed))

    def stored(self, current: Array) -> Array:
        """Energy (...), J, of the field of currents (...), A, which a switch turns into heat."""
        inductance = 0.0 if self.circuit is None else self.circuit.inductance
        return np.asarray(inductance * current**2 / 2)

    def electric_rates(self, current: Array, speed: Array) -> Array:
        """Rates (3, ...) by time of the current, A/s, of the work of the supply and of heat, W."""
        of = self.circuit
        if of is None or not self.on:
            return np.zeros((3, *np.shape(current)))
        left = of.voltage - of.resistance * current - of.torque_constant * self._gear * speed
        rate = left / of.inductance if self.lags else np.zeros_like(current)
        return np.array([rate, of.voltage * current, of.resistance * current**2])

    def currents(self, speed: Array, paths: Array, begin: float) -> Array:
        """Currents (N,), A, at the nodes of a piece that the crank passes at these speeds (N,).

        paths : (N, N), integrals by crank angle up to each node.  begin : current at their begin.
        """
        of = self.circuit
        assert of is not None
        slower = paths * (of.resistance / (of.inductance * speed))
        push = of.voltage - of.torque_constant * self._gear * speed
        right = begin + paths @ (push / (of.inductance * speed))
        return np.asarray(np.linalg.solve(np.eye(len(speed)) + slower, right))

    def until(self, torque: float, angle: float, time: float) -> tuple[float, Array]:
        """Time, s, at which its torque at standstill is so large, N m, from a time on, at a crank
        angle, rad; and current, A, work of the supply and heat, J, by then (3,).
        """
        if self.servo is not None:
            own, turned = torque / abs(self._gear), self._gear * (angle - self._start)
            return self._controller.time_until(own, turned, time), np.zeros(3)
        of = self.circuit
        assert of is not None
        most = of.voltage / of.resistance
        current = torque / (abs(self._gear) * of.torque_constant)
        lag = of.inductance / of.resistance
        time = -lag * log(1 - current / most)
        supply = of.voltage * (most * time - lag * current)
        return time, np.array([current, supply, supply - of.inductance * current**2 / 2])
