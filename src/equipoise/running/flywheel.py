"""The steady state of a crank with its motor, and the flywheel for a wanted fluctuation.

A heavy flywheel lets a crank come to its steady speed only over thousands of turns.  But one cycle
says what becomes of a speed, and of the motor's current or lag, and the state that it leaves as it
is follows by a few cycles.

Where the drive gives one torque T at every angle, T is the mean of what resists it, and the energy

    E(q) = E_0 + int (T + Q(q, q.)) dq = J(q) q.^2 / 2

gives the speed at every crank angle q exactly; E_0 follows from the mean speed.  A motor gives less
torque the faster it turns: then the run itself is followed into its steady state.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import field, replace
from functools import cache, cached_property
from math import ceil, inf, nan, pi
from typing import Any

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.errors import ResponseError, UsageError
from equipoise.i18n import Note
from equipoise.mechanism.parts.machine import Machine
from equipoise.mechanism.parts.motors import Motor
from equipoise.running.collocation import NODES, POINTS, TO_CHEBYSHEV, integral_to, polynomials
from equipoise.running.drivers import Driver
from equipoise.running.equation import CrankEquation
from equipoise.running.integration import Gained, Integration, Limits
from equipoise.signals import Array
from equipoise.vibration.coupled import StallError, mean_stall_note
from equipoise.vibration.exact import solve_exact
from equipoise.vibration.forced import chosen_model
from equipoise.vibration.steady import fastest

EVEN, FAR = 1e-7, 1e3
"""Share of the difference from its speed that a crank loses in a turn under a torque that is as
good as constant; speed over that of the crank at which that torque would have fallen to 0."""

CLOSE = 1e-9
"""Share of the state by which the last step of the search may change it."""
NUDGE = 1e-4
"""Share of the state by which it is changed for slopes: far above the rounding of a cycle."""
FARTHEST = 0.5
"""Share of the speed by which a step may change it."""
MOST_CYCLES = 40

InitialState = tuple[float, float, float | None]
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
        self.driver = Driver.of(self.equation.machine)
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

        guess : state from which it is looked for; that at the usual speed if None.

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
    def _step(residual: Array, slopes: Array) -> tuple[Array, bool]:
        """Step of a state, and whether cycles come nearer to where it leads."""
        if np.max(np.abs(np.linalg.eigvals(slopes))) >= 1:
            return residual, False
        return np.linalg.solve(np.eye(len(residual)) - slopes, residual), True

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

    def start_of(self, state: Array) -> InitialState:
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


DENSE = 48
"""Places in a piece at which extremes are read, beside the nodes: a few hundredths of a degree."""
ROUNDS, SAME = 60, 1e-13
"""Of the iteration where what resists depends on the speed; share of the speed that is rounding."""
LARGEST, MANY_TIMES = 1e6, 4.0
"""Inertia looked for at most, over the estimate or the machine's own, and the factor from one try
to the next."""
MOST_TURNS = 400
"""Of a motor's crank, followed on the way to its steady states, of all inertias together."""
FIRST_CYCLES = 4
"""Followed before it is tried whether a steady state is near by; then four times as many."""
SPEEDS = 48
"""At which the torque of a motor is held against what resists, up to its fastest."""
WHOLE, TO_NODES = integral_to(1.0, -1.0), integral_to(POINTS, -1.0)
"""Integral over a piece, and up to each of its nodes, by values at the nodes."""
DENSELY = polynomials(np.linspace(-1.0, 1.0, DENSE + 1))[:, :NODES] @ TO_CHEBYSHEV
"""Values at many places of a piece by those at its nodes."""


@dataclass(frozen=True)
class Flywheel:
    """A flywheel on the crank, beside what turns with it already.

    wanted : coefficient of fluctuation, highest less lowest speed over the mean.
    present : the same of the machine as it is; infinite where it nearly stands still on the way.
    inertia : of the flywheel, kg m2; 0 where none is needed.
    estimate : as textbooks have it, largest less smallest work of the drive's torque about its
        mean at constant speed, over wanted times speed squared, less what turns already, kg m2.
    work : that largest less smallest work, J.
    speed : mean speed of the crank with it, rad/s: that of the drive, or with a motor the one that
        follows from its curve.
    existing : flywheel on the crank that the machine has, to which it is added, kg m2.
    """

    wanted: float
    present: float
    inertia: float
    estimate: float
    work: float
    speed: float
    existing: float = 0.0

    @property
    def total(self) -> float:
        """Both flywheels on the crank together, kg m2."""
        return self.existing + self.inertia

    def to_dict(self) -> dict[str, Any]:
        """As plain values in SI units."""
        present = self.present if self.present < inf else None
        return vars(self) | {"present": present, "total": self.total}


@dataclass(frozen=True, eq=False)
class SteadyCycle:
    """The steady state of a machine under a constant torque of its drive, at its mean speed.

    added : moment of inertia on the crank beside its own, kg m2.
    """

    equation: CrankEquation
    added: float = 0.0

    @property
    def mean_speed(self) -> float:
        """Of the crank, rad/s, without its sense."""
        return abs(self.equation.machine.drive.speed)

    @cached_property
    def _halves(self) -> Array:
        """Half the width (P, 1) of the pieces, rad."""
        table = self.equation.table
        return np.asarray((table.highs - table.lows)[:, None] / 2)

    @property
    def _inertia(self) -> Array:
        return np.asarray(self.equation.table.values[0] + self.added)

    def _integral(self, values: Array) -> float:
        return float(np.sum(self._halves * values * WHOLE))

    def _torque(self, speed: Array) -> Array:
        """Of all but the drive at the nodes (P, NODES), about its mean, N m."""
        torque, driving = self._torque_and_mean(speed)
        return torque + driving

    def resisting(self, speed: float) -> float:
        """Mean torque, N m, that the drive needs at a constant speed of the crank, rad/s, without
        its sense.
        """
        sense = float(np.sign(self.equation.machine.drive.speed))
        _, driving = self._torque_and_mean(np.full_like(self._inertia, sense * speed))
        return sense * driving

    def _torque_and_mean(self, speed: Array) -> tuple[Array, float]:
        """Torque of all but the drive at the nodes (P, NODES), and the drive's mean that holds
        against it, N m.
        """
        values, driving = self.equation.table.values, 0.0
        if self.equation.friction is not None:
            values = np.concatenate([self._inertia[None], values[1:]])
        sense = float(np.sign(self.equation.machine.drive.speed))
        for _ in range(ROUNDS if self.equation.friction is not None else 1):
            each = self.equation.torques(values, speed, driving, sense)
            torque = np.sum(each, axis=0) + np.zeros_like(speed)
            before, driving = driving, -self._integral(torque) / self.equation.period
            if abs(driving - before) <= SAME * abs(driving):
                break
        return np.asarray(torque), driving

    def _work(self, torque: Array) -> Array:
        """Done since the crank angle 0 at the nodes (P, NODES), J."""
        inside = self._halves * (torque @ TO_NODES.T)
        ends = self._halves[:, 0] * (torque @ WHOLE)
        return np.asarray(inside + np.concatenate([[0.0], np.cumsum(ends)[:-1]])[:, None])

    @cached_property
    def speed(self) -> Array | None:
        """At the nodes (P, NODES), rad/s, without its sense; None where it would nearly stand still
        at a place, and still be faster than that in the mean.

        Raises
        ------
        ResponseError : what resists depends on the speed so much that no steady state is met.
        """
        sense = float(np.sign(self.equation.machine.drive.speed))
        speed = np.full_like(self._inertia, self.mean_speed)
        for _ in range(ROUNDS):
            before = speed
            values = self._of_energy(self._work(self._torque(sense * speed)))
            if values is None:
                return None
            speed = values
            if np.max(np.abs(speed - before)) <= SAME * self.mean_speed:
                return speed
        raise ResponseError(
            Note("there is no steady state, because the resistance varies too much with speed")
        )

    def _of_energy(self, work: Array) -> Array | None:
        """Speed at the nodes for the work done there, such that its mean is right."""
        from scipy.optimize import brentq

        inertia, period = self._inertia, self.equation.period

        def at(least: float) -> Array:
            energy = work - np.min(work) + least
            return np.asarray(np.sqrt(np.maximum(energy, 1e-300) * 2 / inertia))

        def misfit(least: float) -> float:
            return period / self._integral(1 / at(least)) - self.mean_speed

        high = float(np.max(inertia)) * self.mean_speed**2 / 2
        low = 1e-9 * (high + float(np.ptp(work)))
        if misfit(low) > 0:
            return None
        return at(brentq(misfit, low, 2 * high + low, xtol=1e-16 * high, rtol=1e-14))

    @cached_property
    def fluctuation(self) -> float:
        """Highest less lowest speed, over the mean; infinite where there is no `speed`."""
        if self.speed is None:
            return inf
        return float(np.ptp(self.speed @ DENSELY.T)) / self.mean_speed


def share_of_mean(given: float | str) -> float:
    """A coefficient of fluctuation: a number, or a text such as ``"2 %"``.

    Raises
    ------
    UsageError : it is not between 0 and 1.
    """
    try:
        text = str(given).strip()
        share = float(text.removesuffix("%")) / (100 if text.endswith("%") else 1)
    except ValueError:
        share = nan
    if not 0 < share < 1:
        raise UsageError(
            Note(
                "got {given!r} for fluctuation; give more than 0 and less than 1, such as 0.02 or "
                '"2 %"',
                given=given,
            )
        )
    return share


def size_flywheel(
    machine: Machine,
    wanted: float,
    progress: Callable[[int, int], None] | None = None,
    support: bool = False,
) -> Flywheel:
    """A flywheel on the crank for a wanted fluctuation, by the steady state itself.

    wanted : coefficient of fluctuation, highest less lowest speed over the mean; 0.02 is 2 %.
    progress : called with the turns of the crank that were followed towards a steady state, and the
        most there can be.
    support : whether the support moves too, in the plane; else the frame is fixed.

    Raises
    ------
    MassError, MotionError, ModelError, UsageError, ResponseError : as `run.run`; or the wanted
        fluctuation is not between 0 and 1.
    StallError : the motor is too weak at every speed, however large the flywheel.
    """
    wanted = share_of_mean(wanted)
    machine = replace(machine, timed_loads=())  # which are over in a steady state
    equation = CrankEquation(machine)
    work, own = work_at_constant_speed(equation), equation.machine.drive.shaft_inertia
    needed = work / (wanted * machine.drive.speed**2)

    if machine.drive.motor is not None:
        _check_mean_torque(SteadyCycle(equation))
    supported = SupportedCycles(machine) if support else None
    motor = MotorCycles(machine, progress or (lambda done, most: None))

    @cache
    def fluctuation(added: float) -> float:
        if supported is not None:
            return supported.fluctuation(added)
        steady = SteadyCycle(equation, added)
        if machine.drive.motor is None or steady.fluctuation == inf:
            return steady.fluctuation
        return motor.fluctuation(steady)

    present = fluctuation(0.0)
    slower = motor.slower if supported is None else supported.slower
    about = max(needed * slower**2, own)
    least = 0.0 if present <= wanted else _least(fluctuation, wanted, about)
    slower = motor.slower if supported is None else supported.slower
    estimate, speed = max(needed - own, 0.0), machine.drive.speed / slower
    return Flywheel(wanted, present, least, estimate, work, speed, machine.drive.flywheel)


def _check_mean_torque(steady: SteadyCycle) -> None:
    """Refuse a motor that no flywheel helps: one that gives, at every constant speed, less than
    what resists there in the mean.

    Looking for a steady state would take hundreds of turns for each of many inertias, and meet
    none.
    """
    driver = Driver.of(steady.equation.machine)
    motor = steady.equation.machine.drive.motor
    assert motor is not None
    high = max(fastest(motor) / motor.ratio, steady.mean_speed)
    low = high / SPEEDS
    for _ in range(2):  # then about the best of them, as the curve may have a narrow top
        speeds = np.linspace(low, high, SPEEDS)
        given = driver.sense * driver.torque(driver.sense * speeds)
        needed = np.array([steady.resisting(float(speed)) for speed in speeds])
        k = int(np.argmin(needed - given))
        if needed[k] <= given[k]:
            return
        low, high = speeds[max(k - 1, 0)], speeds[min(k + 1, SPEEDS - 1)]
    raise StallError(mean_stall_note(float(needed[k]), float(given[k]), float(speeds[k])))


def _least(fluctuation: Callable[[float], float], wanted: float, about: float) -> float:
    """The inertia, kg m2, with which the fluctuation is the wanted one."""
    from scipy.optimize import brentq

    def misfit(added: float) -> float:
        return min(fluctuation(added), 10.0) - wanted

    low, high = 0.0, about
    while misfit(high) > 0:
        low, high = high, high * MANY_TIMES
        if high > LARGEST * about:
            raise ResponseError(Note("no flywheel of any size achieves this fluctuation"))
    return float(brentq(misfit, low, high, rtol=CLOSE))


@dataclass(eq=False)
class SupportedCycles:
    """Steady states of a machine whose support moves in the plane, by the exact equations; under a
    constant torque at the mean speed of its drive where it has no motor.

    slower : the speed of the drive over the mean speed with the motor, of the last one.

    Raises
    ------
    ModelError, UsageError : the exact model is not for such a machine.
    """

    machine: Machine
    slower: float = 1.0
    guess: Callable[[Array], Array] | None = None

    def __post_init__(self) -> None:
        if self.machine.support is not None and not self.machine.support.planar:
            raise UsageError(
                Note(
                    "a flywheel is sized on a support that moves in the plane of the drawing; "
                    "leave out the fluctuation or the support"
                )
            )
        drive = self.machine.drive
        motor = drive.motor and replace(drive.motor, mean_speed="free")
        self.machine = replace(self.machine, drive=replace(drive, motor=motor or self._even_motor))
        chosen_model(self.machine, "exact", drive=True)

    @property
    def _even_motor(self) -> Motor:
        inertia = float(np.mean(CrankEquation(self.machine).table.values[0]))
        speed = abs(self.machine.drive.speed)
        slope = EVEN * inertia * speed / (2 * pi)
        return Motor(FAR * speed, slope * FAR * speed, mean_speed="held")

    def fluctuation(self, added: float) -> float:
        """Highest less lowest speed over the mean, with an inertia, kg m2, on the crank beside its
        own; infinite where the motor stalls.

        Raises
        ------
        ResponseError : no steady state is met.
        """
        drive = self.machine.drive
        machine = replace(self.machine, drive=replace(drive, flywheel=drive.flywheel + added))
        solution = None
        if self.guess is not None:
            try:
                solution = solve_exact(machine, drive.speed, True, self.guess, patient=False)
            except ResponseError:
                self.guess = None
        try:
            solution = solution or solve_exact(machine, drive.speed, True)
        except StallError:
            return inf
        self.guess, self.slower = solution.steady.orbit.at, drive.speed / solution.speed
        readings = solution.response(brief=True).drive
        return readings.fluctuation


@dataclass(eq=False)
class MotorCycles:
    """Steady states of a machine with its motor's own curve, by the inertia that is added.

    progress : called with `turns` and the most there can be.
    first : state from which the next one is looked for.  cycles : how many were followed.
    turns : of the crank that were followed where no steady state was near by.
    slower : the speed of the drive over the mean speed with the motor, of the last one.
    """

    machine: Machine
    progress: Callable[[int, int], None] = lambda done, most: None
    first: Array | None = None
    cycles: int = 0
    turns: int = 0
    slower: float = 1.0

    def fluctuation(self, steady: SteadyCycle) -> float:
        """Highest less lowest speed over the mean; infinite where the motor stalls.

        steady : under a constant torque with the same inertia, near which the motor's is looked
            for first.

        Raises
        ------
        ResponseError : no steady state is met.
        """
        drive = replace(self.machine.drive, flywheel=self.machine.drive.flywheel + steady.added)
        shooting = Shooting(
            CrankEquation(replace(self.machine, drive=drive)), float(self.machine.drive.speed)
        )
        assert steady.speed is not None
        track = self._steady_track(shooting, self.first)
        if track is None:
            track = self._followed(shooting, float(np.sign(drive.speed) * steady.speed[0, 0]))
        if track is None:
            return inf
        mean = (track[-1, 1] - track[0, 1]) / (track[-1, 0] - track[0, 0])
        self.slower = float(drive.speed / mean)
        return _fluctuation_of(track)

    def _steady_track(self, shooting: Shooting, state: Array | None) -> Array | None:
        """Rows of the track of a steady cycle, met from a state near by; None where none is."""
        before, shooting.cycles = shooting.cycles, 0
        met = shooting.steady(state)
        self.cycles += shooting.cycles
        shooting.cycles += before
        if met is None:
            return None
        self.first, track = met
        return track

    def _followed(self, shooting: Shooting, speed: float) -> Array | None:
        """Rows of the track of a steady cycle that is met from a speed on, rad/s, cycle after
        cycle; None where the motor stalls.

        Raises
        ------
        ResponseError : it takes too many turns.
        """
        start: InitialState = (speed, 0.0, None)
        count = FIRST_CYCLES
        in_cycle = max(round(shooting.equation.period / (2 * pi)), 1)
        while (count := min(count, (MOST_TURNS - self.turns) // in_cycle)) > 0:
            run = self._turned(shooting.equation, start, count * in_cycle)
            self.cycles += len(run.begins)
            if run.events[-1].kind == "steady" and len(run.begins) > 1:
                rows, (begin, end) = np.vstack(run.track), (begin.time for begin in run.begins[-2:])
                return rows[(rows[:, 0] >= begin) & (rows[:, 0] <= end)]
            if run.events[-1].kind != "turns":
                return None
            state = shooting.end_of(run)
            track = self._steady_track(shooting, state) if state[0] > 0 else None
            if track is not None:
                return track
            start, count = shooting.start_of(state), 4 * count
        raise ResponseError(
            Note(
                "no steady state with the motor is met within {count} turns of the crank, for "
                "which a flywheel could be sized",
                count=MOST_TURNS,
            )
        )

    def _turned(self, equation: CrankEquation, start: InitialState, turns: int) -> Integration:
        """So many turns from speed, current and lag on, or until something ends the run before."""
        before = self.turns
        run = Integration(
            equation, Driver.of(equation.machine), Limits(inf, turns, inf, inf, steady=True)
        )
        run.on_turns = lambda done: self.progress(before + int(done), MOST_TURNS)
        speed, current, lag = start
        run.follow(0.0, speed, current, lag)
        self.turns += ceil(abs(run.events[-1].crank_angle) / (2 * pi))
        self.turns = min(self.turns, before + turns)
        self.progress(self.turns, MOST_TURNS)
        return run


def _fluctuation_of(track: Array) -> float:
    """Highest less lowest speed over the mean, of rows of a track over a cycle."""
    time, angle, speed = track[:, 0], track[:, 1], np.abs(track[:, 2])
    return float(np.ptp(speed) * (time[-1] - time[0]) / abs(angle[-1] - angle[0]))


def work_at_constant_speed(equation: CrankEquation) -> float:
    """Largest less smallest work of the drive's torque about its mean at constant speed, J.

    Within a cycle, with what accelerates the linkage: at constant speed the energy that the rest
    gives is W, the linkage takes J q.^2 / 2, and the drive the difference.
    """
    steady, speed = SteadyCycle(equation), equation.machine.drive.speed
    nodes = np.full_like(equation.table.values[0], speed)
    work = steady._work(steady._torque(nodes)) - equation.table.values[0] * speed**2 / 2
    return float(np.ptp(work @ DENSELY.T))
