"""Steady state: the periodic solution of the equations, and the guess its search starts from."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import replace
from itertools import pairwise
from math import ceil, copysign, pi

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.errors import ResponseError
from equipoise.i18n import Note
from equipoise.mechanism.assembly.linkage import assemble
from equipoise.mechanism.dynamics.forces import forces
from equipoise.mechanism.kinematics.jumps import resolved
from equipoise.mechanism.kinematics.motion import move
from equipoise.mechanism.parts.machine import Machine
from equipoise.mechanism.parts.motors import Motor
from equipoise.signals import Array
from equipoise.vibration.collocation import NOTHING, RULE, BoundaryConditions, Orbit, System, solve
from equipoise.vibration.coupled import Coupled, StallError, Torque, mean_stall_note
from equipoise.vibration.linear import Linear
from equipoise.vibration.linkages import rows_of

Guess = Callable[[Array], Array]

NO_STEADY_STATE = Note(
    "no steady state was found; the machine may not settle into one. Look at it from rest "
    "(`equipoise simulate`), or try another speed or more damping"
)
SAMPLES = 720
"""In a turn, at which a solution is read off."""
INTERVALS = 36
"""In a turn, to begin with."""
MOST_INTERVALS, MOST_SWINGS = 4000, 400
"""Intervals of a turn, and swings of the softest mode in a cycle, beyond which a solution takes
minutes."""
FINE = 1e-11
"""Residual of an interval at which it is left as it is."""
SHORTEST = 1e-3
"""Share of an interval, beside a jump, within which none ends; rad, from the ends of a period."""
ROUNDS = 14
"""Of refinement: where a contact opens or a load sets in, intervals are cut in four."""
NEUTRAL = 1 + 1e-6
"""Multiplier up to which nothing grows, whatever rounding says."""
PROGRESS, PATIENCE = 0.7, 3
"""Share of the residual above which a finer mesh has brought nothing, and how often in a row."""
FAR_BEYOND = 100
"""Times the fastest speed of a motor, above which a solution is none: its curve is not known there,
and beside such speeds the rest is rounding.
"""
LOOSE = 1e-6
"""Change of the solution above which Newton's method has not found one."""


@dataclass(frozen=True, eq=False)
class Steady:
    """A periodic solution against crank angle.

    residual : of the worst interval, the share by which the equations are not met between nodes,
        times the interval's share of the period.
    """

    orbit: Orbit
    residual: float

    def multipliers(self, count: int) -> Array:
        """Floquet multipliers (count,) of the first `count` states: by what a disturbance has
        grown after one period; the largest first.
        """
        values = np.linalg.eigvals(self.orbit.monodromy[:count, :count])
        return np.asarray(values[np.argsort(-np.abs(values), kind="stable")])


def steady(
    system: System,
    guesses: Iterable[Guess],
    turns: int,
    conditions: BoundaryConditions,
    swings: float = 0.0,
    jumps: Array | tuple[()] = (),
) -> Steady:
    """Find the periodic solution on a mesh that is refined where the equations are not met.

    Parameters
    ----------
    guesses : states (n, M) against the crank's turning (M,), rad; the next is tried where one leads
        nowhere, or to a solution that is not stable, such as a support balanced on its head.
    swings : how often the support swings freely in a turn; the mesh has to follow that.
    jumps : (J,) turnings at which the equations jump, rad, where intervals begin and end.

    Raises
    ------
    ResponseError : there is none that Newton's method could find.
    """
    if not swings <= MOST_SWINGS:
        raise ResponseError(
            Note(
                "the support swings freely {swings:.3g} times in a turn of the crank, more "
                "often than the {most_swings} that the exact equations follow; for so slow "
                "a crank choose the moment model",
                swings=swings,
                most_swings=MOST_SWINGS,
            )
        )
    intervals = (INTERVALS + ceil(swings)) * turns
    points = _mesh(intervals, 2 * pi * turns, np.asarray(jumps, dtype=float))
    orbit = _first(_tried(system, points, guess, conditions) for guess in guesses)
    return _refined(system, orbit, conditions, 2 * intervals + MOST_INTERVALS * turns)


def _mesh(intervals: int, period: float, jumps: Array) -> Array:
    """Ends of intervals, equally spaced but for jumps, to which the nearest ends move."""
    points = np.linspace(0.0, period, intervals + 1)
    inside = jumps[(jumps > SHORTEST) & (jumps < period - SHORTEST)]
    apart = np.min(np.abs(np.subtract.outer(points, inside)), axis=1, initial=np.inf)
    distinct = apart > SHORTEST * period / intervals
    distinct[[0, -1]] = True
    return np.unique(np.concatenate([points[distinct], inside]))


def _first(tried: Iterable[Orbit | None]) -> Orbit:
    """The first solution that is stable, or else the first."""
    unstable = None
    for orbit in tried:
        if orbit is not None and _dies_out(orbit):
            return orbit
        unstable = unstable or orbit
    if unstable is None:
        raise ResponseError(NO_STEADY_STATE)
    return unstable


def _refined(system: System, orbit: Orbit, conditions: BoundaryConditions, most: int) -> Steady:
    """The solution on a mesh of at most so many intervals, or a few more."""
    error, idle = _residuals(system, orbit), 0
    for _ in range(ROUNDS):
        coarse = error > max(FINE, orbit.change)  # below its last change the solution is rounding
        if not np.any(coarse) or len(orbit.points) > most:
            break
        finer = _tried(system, _cut(orbit.points, coarse), orbit.at, conditions)
        if finer is None:
            break
        before, orbit = float(np.max(error)), finer
        error = _residuals(system, orbit)
        idle = idle + 1 if np.max(error) > PROGRESS * before else 0
        if idle == PATIENCE:  # what is left is rounding
            break
    return Steady(orbit, float(np.max(error)))


def _tried(
    system: System, points: Array, guess: Guess, conditions: BoundaryConditions
) -> Orbit | None:
    with np.errstate(all="ignore"):
        try:
            orbit = solve(system, points, guess, conditions)
        except (np.linalg.LinAlgError, ResponseError):  # the second by a guess that takes too long
            return None
        return orbit if orbit.change < LOOSE and _goes_on(system, orbit) else None


def _goes_on(system: System, orbit: Orbit) -> bool:
    """Whether the crank turns on all the time, as it has to where its angle stands for the time,
    and at a speed that its motor knows of.
    """
    if not isinstance(system, Coupled) or system.torque is None:
        return True
    motor = system.machine.drive.motor
    assert motor is not None
    ways = [system.sense * system.crank_speed(of) for of in (orbit.starts, orbit.states)]
    most = FAR_BEYOND * (fastest(motor) / motor.ratio + abs(system.speed))
    return all(bool(np.all((way > 0) & (way < most))) for way in ways)


def _dies_out(orbit: Orbit) -> bool:
    """Whether disturbances do not grow; constants, such as the shift of a curve, have 1."""
    return bool(np.max(np.abs(np.linalg.eigvals(orbit.monodromy)), initial=0.0) < NEUTRAL)


def _residuals(system: System, orbit: Orbit) -> Array:
    """How far each interval (K,) is from the equations, beside the largest rate of each state."""
    steps = np.diff(orbit.points)
    scale = np.maximum(np.max(np.abs(orbit.slopes), axis=(1, 2)), NOTHING)
    worst = np.zeros(len(steps))
    for share in (RULE.nodes[0] / 2, 0.5, 1 - RULE.nodes[0] / 2):
        s = orbit.points[:-1] + share * steps
        residual = np.abs(orbit.slopes_at(share) - system.rates(s)(orbit.at(s))) / scale[:, None]
        worst = np.maximum(worst, np.max(residual, axis=0, initial=0.0))
    return np.asarray(worst * steps / (orbit.points[-1] - orbit.points[0]))


def _cut(points: Array, coarse: Array) -> Array:
    """The mesh with coarse intervals (K,) cut in four."""
    inner = points[:-1, None] + np.diff(points)[:, None] * np.array([0.25, 0.5, 0.75])
    return np.sort(np.concatenate([points, inner[coarse].ravel()]))


def torque_on_crank(motor: Motor, way: float) -> Torque:
    """Torque on the crank, N m, at its speed and a shift of the motor's curve, both rad/s.

    way : with the sign of the speed at which the motor is to turn the crank.
    """
    sense = copysign(1.0, way)
    smooth = motor.smooth_curve
    curve = _straight(motor) if smooth is None else smooth.torque

    def torque(speed: Array, shift: Array) -> Array:
        own = sense * motor.ratio * speed - shift
        value: Array = sense * motor.ratio * curve(own)
        return value

    return torque


def _straight(motor: Motor) -> Callable[[Array], Array]:
    """A curve of straight lines: torque by the motor's speed."""
    speeds, torques = _rows(motor)
    slopes = np.diff(torques) / np.diff(speeds)
    if len(slopes) == 1:  # the usual case, asked for at every step of a run
        low, first, slope = float(speeds[0]), float(torques[0]), float(slopes[0])
        return lambda own: np.asarray(first + slope * (own - low))

    def torque(own: Array) -> Array:
        k = np.clip(np.searchsorted(speeds, own.real, side="right") - 1, 0, len(slopes) - 1)
        value: Array = torques[k] + slopes[k] * (own - speeds[k])
        return value

    return torque


def _rows(motor: Motor) -> tuple[Array, Array]:
    """Speeds and torques between which the motor's curve is straight."""
    speeds, torques = motor.rows
    return np.array(speeds), np.array(torques)


def fastest(motor: Motor) -> float:
    """Highest speed of a motor's curve, rad/s."""
    smooth = motor.smooth_curve
    return float(_rows(motor)[0][-1]) if smooth is None else smooth.synchronous_speed


def speed_at(motor: Motor, torque: float) -> float:
    """Highest speed of the motor, rad/s, at which its torque, N m, falls through a value.

    Raises
    ------
    ResponseError : it never does.
    """
    smooth = motor.smooth_curve
    speed = _on_lines(motor, torque) if smooth is None else smooth.speed_at(torque)
    if speed is not None:
        return speed
    raise ResponseError(
        Note(
            "drive.motor: its torque nowhere falls through {torque:g} N m, which the "
            "machine takes in the mean; give a stronger motor, or a higher ratio",
            torque=torque,
        )
    )


def _on_lines(motor: Motor, torque: float) -> float | None:
    """Speed of a motor whose curve has straight lines; None where its torque never falls so far."""
    speeds, torques = _rows(motor)
    for k in range(len(speeds) - 2, -1, -1):
        slope = (torques[k + 1] - torques[k]) / (speeds[k + 1] - speeds[k])
        if slope >= 0:
            continue
        speed = speeds[k] + (torque - torques[k]) / slope
        low = -np.inf if k == 0 else speeds[k]
        high = np.inf if k == len(speeds) - 2 else speeds[k + 1]
        if low <= speed <= high:
            return float(speed)
    return None


SPEEDS, SLOWEST = 49, 1e-6
"""Speeds of the crank between which a motor's is looked for, from the highest down, and the lowest
of them over the highest."""
MOST_GROWTH = 10
"""Times that the highest of them is doubled where loads drive a machine faster than its motor."""
SAME_SPEED = 1e-12
"""Tolerance of the speed of a motor, over itself."""
ROUGH = 12
"""Orders of the linear response that do to start from."""


def equations(machine: Machine, speed: float, drive: bool) -> tuple[Coupled, Linear | None]:
    """The exact equations, and the linear ones about the same rest; None on solid ground.

    drive : whether the crank's speed follows from the motor.
    """
    motor = machine.drive.motor if drive else None
    torque = None if motor is None else torque_on_crank(motor, speed)
    loaded_at = speed
    if motor is not None and motor.mean_speed == "free" and machine.rubs:
        loaded_at, _ = motor_setting(machine, speed)
    if machine.support is None:
        assert torque is not None
        return replace(Coupled.on_ground(machine, speed, torque), loaded_at=loaded_at), None
    linear = Linear.of(machine)
    system = Coupled.on_support(linear.body, linear.rest, speed, torque)
    return replace(system, loaded_at=loaded_at), linear


def turns_of(machine: Machine) -> int:
    """Turns of the crank in a period."""
    return assemble(machine).cycle.turns


def conditions_of(system: Coupled) -> BoundaryConditions:
    """What closes a period: everything comes back, and the mean speed is held where it is."""
    conditions = BoundaryConditions.periodic(system.count)
    if system.torque is None:
        return conditions
    begin, end, value = conditions.begin.copy(), conditions.end.copy(), conditions.value.copy()
    time, shift = system.count - 2, system.count - 1
    begin[time], end[time] = 0.0, 0.0
    begin[time, time] = 1.0  # the time begins at 0
    begin[shift], end[shift] = 0.0, 0.0
    motor = system.machine.drive.motor
    assert motor is not None
    if motor.mean_speed == "held":
        end[shift, time] = 1.0
        value[shift] = 2 * pi * turns_of(system.machine) / abs(system.speed)
    else:
        begin[shift, shift] = 1.0
    return BoundaryConditions(begin, end, value)


def from_linear(
    system: Coupled, linear: Linear | None, setting: tuple[float, float] | None, s: Array
) -> Array:
    """States of the linear response, with the crank's speed constant.

    setting : with a motor, mean speed and shift of its curve.
    """
    states = []
    if linear is not None:
        moved, theta = linear.motion(system.speed).upto(ROUGH), system.sense * s
        states = [*moved.values(theta), *(moved.derivative() * system.speed).values(theta)]
    return np.stack(states) if setting is None else with_motor(states, setting, s)


def with_motor(states: Iterable[Array], setting: tuple[float, float], s: Array) -> Array:
    """States of the support with those of a motor that runs evenly."""
    speed, shift = setting
    return np.stack([*states, np.full_like(s, speed), s / abs(speed), np.full_like(s, shift)])


def motor_setting(machine: Machine, speed: float) -> tuple[float, float]:
    """Mean speed of the crank and shift of the motor's curve, rad/s, if the speed were constant.

    Raises
    ------
    StallError : the mean torque is that of the curve beyond standstill, at which no motor drives.
    ResponseError : the curve nowhere falls through it.
    """
    motor = machine.drive.motor
    assert motor is not None
    if motor.mean_speed == "held":
        return speed, motor.ratio * abs(speed) - _own_speed(machine, motor, speed)
    return copysign(_free_speed(machine, motor, abs(speed)), speed), 0.0


def _free_speed(machine: Machine, motor: Motor, nominal: float) -> float:
    """Highest speed of the crank, rad/s, at which the mean torque that it needs at that speed comes
    up to what a motor gives there.

    Raises
    ------
    StallError, ResponseError : as of `motor_setting`.
    """
    from scipy.optimize import brentq

    sense, given = copysign(1.0, machine.drive.speed), torque_on_crank(motor, machine.drive.speed)

    def missing(speed: float) -> float:
        own = sense * float(given(np.array(sense * speed), np.zeros(())))
        return _mean_torque(machine, speed) - own

    high, growth = max(fastest(motor) / motor.ratio, nominal), 0
    while missing(high) <= 0:  # loads drive the machine, beyond the motor's curve
        if growth == MOST_GROWTH:
            speed_at(motor, _mean_torque(machine, nominal) / motor.ratio)  # says what it needs
            raise ResponseError(NO_STEADY_STATE)
        high, growth = 2 * high, growth + 1
    speeds = _tried_speeds(motor, high)
    deficits = [missing(high)]
    for fast, slow in pairwise(speeds):
        deficits.append(missing(slow))
        if deficits[-1] <= 0:
            return float(brentq(missing, slow, fast, rtol=SAME_SPEED))
    worst = speeds[int(np.argmin(deficits))]
    needed = _mean_torque(machine, worst)
    raise StallError(mean_stall_note(needed, needed - min(deficits), worst))


def _tried_speeds(motor: Motor, high: float) -> list[float]:
    """Speeds of the crank, rad/s, falling from the highest: evenly, and where the motor's curve has
    its corners or its top, beside which it may be narrow.
    """
    smooth = motor.smooth_curve
    corners = motor.rows[0] if smooth is None else (smooth.breakdown_speed,)
    own = [corner / motor.ratio for corner in corners]
    even = [*np.linspace(high, 0.0, SPEEDS)[:-1].tolist(), high * SLOWEST]
    return sorted({*even, *(speed for speed in own if 0 < speed < high)}, reverse=True)


def _own_speed(machine: Machine, motor: Motor, speed: float) -> float:
    """Speed of a motor, rad/s, at which its curve has the mean torque of a speed of the crank."""
    torque = _mean_torque(machine, abs(speed))
    own = speed_at(motor, torque / motor.ratio)
    if own < 0:
        most = motor.ratio * motor.largest_torque
        raise StallError(mean_stall_note(torque, most, abs(speed)))
    return own


def _mean_torque(machine: Machine, speed: float) -> float:
    """Mean torque, N m, that the crank needs at a constant speed, rad/s, both as sizes in the sense
    of the drive; of all rows.
    """
    sense = copysign(1.0, machine.drive.speed)
    motion = resolved(move(machine, SAMPLES, sense * speed, 0.0))
    return sense * float(motion.mean(forces(motion).drive_torque)) * len(rows_of(machine))
