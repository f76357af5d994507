"""The steady state of a crank with its motor, by shooting: a cycle that ends as it begins.

A heavy flywheel lets a crank come to its steady speed only over thousands of turns.  But one cycle
says what becomes of a speed, and of the motor's current or lag, and the state that it leaves as it
is follows by a few cycles.
"""

from __future__ import annotations

from dataclasses import field
from math import inf, pi

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.running.drivers import Driver
from equipoise.running.equation import CrankEquation
from equipoise.running.integration import Gained, Integration, Limits
from equipoise.signals import Array

CLOSE = 1e-9
"""Share of the state by which the last step of the search may change it."""
NUDGE = 1e-4
"""Share of the state by which it is changed for slopes: far above the rounding of a cycle."""
FARTHEST = 0.5
"""Share of the speed by which a step may change it."""
MOST_CYCLES = 40


Start = tuple[float, float, float | None]
"""Speed, rad/s, current, A, and lag, rad, with which `Integration.follow` begins."""


class Stopped(Exception):
    """The crank does not come to the end of a cycle."""


@dataclass(eq=False)
class Shooting:
    """Cycles of a machine with a motor, from states at their begin.

    A state is the speed over a usual one, then, where the motor has it, its current over that of a
    motor at rest, or its lag over the one at which its torque is the largest.

    speed : a usual one of the crank, rad/s, with its sense.
    cycles : how many were followed.
    """

    equation: CrankEquation
    speed: float
    cycles: int = 0
    before: dict[tuple[float, ...], Gained] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self.driver = Driver(self.equation.machine)
        circuit, servo = self.driver.circuit, self.driver.servo
        self.sizes, self.first = [self.speed], [1.0]
        if self.driver.lags and circuit is not None:
            self.sizes.append(circuit.voltage / circuit.resistance)
            lasting = float(self.driver.current(np.asarray(self.speed)))
            self.first.append(lasting / self.sizes[1])
        elif servo is not None and servo.angle_gain:
            self.sizes.append(servo.torque_limit / servo.angle_gain)
            self.first.append(0.0)

    def steady(self, guess: Array | None = None) -> tuple[Array, Array] | None:
        """The state at the begin of a cycle that ends as it begins, and to which others come, and
        rows of its track, as of `Integration`; None where none is met.

        near : state from which it is looked for; that at the usual speed if None.

        By Newton's method with Broyden's slopes.  Where those say that cycles lead away from a
        state near by, to which the crank never comes, it is let run on instead, by more and more
        such cycles at once.
        """
        state = np.array(self.first) if guess is None else guess
        try:
            end, track = self._cycle(state)
            nudges = NUDGE * np.eye(len(state))
            slopes = np.array([self._cycle(state + nudge)[0] - end for nudge in nudges]).T / NUDGE
            ahead = 1.0
            while self.cycles < MOST_CYCLES:
                step, is_stable = self._step(end - state, slopes)
                ahead = 1.0 if is_stable else 2 * ahead
                step *= ahead
                if is_stable and np.max(np.abs(step)) <= CLOSE * state[0]:
                    return state, track
                step *= min(1.0, FARTHEST * state[0] / float(np.max(np.abs(step))))
                before, state = end, state + step
                end, track = self._cycle(state)
                if np.max(np.abs(step)) > NUDGE * state[0]:  # of shorter steps, slopes are rounding
                    slopes += np.outer(end - before - slopes @ step, step) / (step @ step)
        except Stopped:
            pass
        return None

    @staticmethod
    def _step(missed: Array, slopes: Array) -> tuple[Array, bool]:
        """Step of a state, and whether cycles come nearer to where it leads."""
        if np.max(np.abs(np.linalg.eigvals(slopes))) >= 1:
            return missed, False
        return np.linalg.solve(np.eye(len(missed)) - slopes, missed), True

    def _cycle(self, state: Array) -> tuple[Array, Array]:
        """The state at the end of a cycle that begins in another, and rows of its track.

        Raises
        ------
        Stopped : the crank stands still on the way.
        """
        self.cycles += 1
        if not state[0] > 0:
            raise Stopped
        start = self.start_of(state)
        limits = Limits(inf, self.equation.period / (2 * pi), inf, inf, steady=False)
        run = Integration(self.equation, self.driver, limits)
        run.cycle_before = self.before
        run.follow(0.0, *start)
        end = run.events[-1]
        if len(run.events) > 1 or end.kind != "turns" or end.crank_angle * start[0] < 0:
            raise Stopped
        return self.end_of(run), np.vstack(run.track)

    def start_of(self, state: Array) -> Start:
        """What is followed from a state on; the lag is None without a servo motor."""
        speed, *others = (np.array(self.sizes) * state).tolist()
        current = others[0] if self.driver.lags else 0.0
        lag = None if self.driver.servo is None else others[0] if others else 0.0
        return speed, current, lag

    def end_of(self, run: Integration) -> Array:
        """The state in which a run has ended."""
        end = run.events[-1]
        ends = [end.speed]
        if len(self.sizes) > 1 and self.driver.lags:
            ends.append(float(run.track[-1][-1, 3]))
        elif len(self.sizes) > 1:
            ends.append(run.driver.lag_at(end.crank_angle, end.time))
        return np.array(ends) / self.sizes
