"""The crank's motion from a start on, from one piece of the crank angle to the next.

While the crank turns, its angle is the clock: in each piece of the table the kinetic energy is the
integral of the torques, and collocation at the table's own nodes needs no linkage between them.

    E(q) = J q.^2 / 2,    dE/dq = Q(q, q.) + T(q.),    dt/dq = 1 / q.

About standstill, where the angle is no clock, SciPy's DOP853 integrates in time to the piece's end:
explicit and of order 8, because the equation is smooth and not stiff there, and tolerances are
tight; or Radau, where a motor's current is far quicker than the crank, or dampers brake it at once.
The work of each source is integrated on the way, so that their sum can be held against the kinetic
energy of the linkage itself.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from itertools import pairwise
from math import copysign, inf, isfinite, nan, pi
from typing import Any

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.errors import ResponseError
from equipoise.i18n import Note
from equipoise.running.collocation import (
    AT_ENDS,
    ELECTRIC,
    INTEGRALS,
    NODES,
    ROW_PLACES,
    Instant,
    PieceMotion,
    TableRange,
    instant_of,
    roughness,
)
from equipoise.running.drivers import LIMIT_REACHED, Driver
from equipoise.running.equation import CrankEquation
from equipoise.running.sources import just_after, load_factors
from equipoise.signals import Array

RELATIVE, ABSOLUTE = 1e-11, 1e-13
"""Tolerances of a step in time, over the states and over their usual sizes."""
RESOLVED = 1e-9
"""Share of its largest value below which the last coefficients of 1 / speed have to lie in a piece
whose angle is the clock."""
WITH_CORNERS = 1e-7
"""The same with friction, whose torque has corners where what presses changes its side: time and
speed are off by less than that, and a piece takes a hundredth of the time that one in time does."""
HALVINGS = 6
"""After which a part of a piece whose motion is not resolved by angle is integrated in time."""
SPEEDING_UP = 1 / 16
"""Share of a piece that is integrated in time where the crank speeds up: from a rest on, 1 / speed
is resolved over parts as long as the way from that rest."""
CLOSE, MOST_ITERATIONS = 1e-13, 8
"""Change of the kinetic energy, over its largest, at which a piece is solved; it takes 3 rounds."""
QUICK = 1e-2
"""Share of what a round before missed, above which slopes are computed anew."""
NUDGE = 1e-6
"""Share of a speed by which it is changed for slopes, which only set how fast rounds converge."""
STEADY = 1e-6
"""Share by which the speed may differ from that a cycle before, in a steady state."""
MOST_PIECES, MOST_REVERSALS = 200_000, 200
LOOKED, EVEN, BEYOND = 1000, 0.01, 1.2
"""Pieces after which it is foreseen how many there will be; share by which two such spans may
differ while the motion goes on evenly; share of the most pieces, from which it is refused then.
"""
AT_REST = 1e-9
"""Share of the largest torque below which nothing sets the crank in motion."""
RESTING = 1e-14
"""Share of a time within which it is known when a load over time sets a crank in motion."""
AT_EASE = 1e-6
"""Share of the widest swing below which a crank that swings to and fro has come to rest: a
million-millionth of the energy is left, less than what the integration misses of it."""
SAMPLES = 72
"""In a cycle, from which sizes are read."""
PATIENCE, SLOW = 1000.0, 1e-6
"""rad at its usual speed, after which a crank that creeps along is looked at; share of that speed
below which it stands still then."""
AT_EDGE = 1e-11
"""rad, by which what is to happen has to be ahead."""
SAME = 1e-9
"""Of a cycle, within which a crank angle is its begin."""
TINY = 1e-300
STIFF = 1e-4
"""rad at the usual speed within which a motor's current follows the speed, below which an explicit
method takes thousands of steps to a piece."""
DAMPED = 0.1
"""rad at the usual speed within which dampers bring a speed to its lasting one, below which an
explicit method, whose steps are six times as long, takes too many of them until `PATIENCE`."""
BETWEEN = 6
"""Instants read in a step in time."""
MOST_RATES = 50_000
"""Of the motion, computed within one piece in time; usual are some hundred."""


@dataclass(frozen=True)
class Event:
    """What happens on the way.

    kind : ``off``, ``reversal``, ``steady``, ``standstill``, ``stall``, ``turns`` or ``time``; the
        last one of a run ended it.
    time : s.  crank_angle : rad.  speed : rad/s.
    """

    kind: str
    time: float
    crank_angle: float
    speed: float


@dataclass(frozen=True)
class Limits:
    """Where a run ends, and where its motor is switched off.

    time, off_time : s.  turns, off_turns : of the crank from the start on.
    steady : whether a run ends in a steady state.
    """

    time: float = inf
    turns: float = inf
    off_time: float = inf
    off_turns: float = inf
    steady: bool = True


CHECKED = 4 * NODES
"""Places of a piece at which it is seen whether a servo motor is at its limit of torque."""

Gained = tuple[Array, Array | None]
"""Kinetic energies (N,), J, gained up to the nodes of a part, and the inverse (N, N) of Newton's
method there."""


class Integration:
    """Follow a machine's crank.

    track : rows of time, angle, speed, current, its two works, and works, at the nodes of the
        solution.
    begins : instants at which a cycle begins.
    halts : crank angles at which the crank was at rest, rad.
    cycle_before : of each part, by its place, what was gained when it was passed last: near a
        steady state Newton's method takes a round or two from there.
    on_turns : called with the turns of the crank from the start, as often as these may change.
    """

    def __init__(self, equation: CrankEquation, driver: Driver, limits: Limits) -> None:
        self.equation, self.driver, self.limits = equation, driver, limits
        self.table = equation.table
        self.track: list[Array] = []
        self.events: list[Event] = []
        self.begins: list[Instant] = []
        self.direction = 1.0
        self.halvings = 0
        self.cycle_before: dict[tuple[float, ...], Gained] = {}
        self.halts: list[float] = []
        self.rates_left = MOST_RATES
        self.on_turns: Callable[[float], None] = lambda turns: None

    def follow(
        self, angle: float, speed: float, current: float = 0.0, lag: float | None = None
    ) -> None:
        """Run from a crank angle, rad, and speed, rad/s, until something ends it.

        current : of a motor whose current lags, A.  lag : of a servo motor, as of `Driver.begins`.
        """
        equation = self.equation
        self.start = angle
        inertia = float(np.max(equation.inertia(np.linspace(0.0, equation.period, SAMPLES))[0]))
        self.usual = usual = max(abs(speed), abs(equation.machine.drive.speed)) or 1.0
        works = len(equation.works) + bool(self.driver.brake) + 1
        energy = inertia * usual**2 / 2
        circuit = self.driver.circuit
        rated = 1.0 if circuit is None else circuit.voltage / circuit.resistance
        sizes = [1.0, usual, rated, *[energy] * (works + ELECTRIC - 1)]
        self.absolute = ABSOLUTE * np.array(sizes)
        now: Instant | None = Instant(0.0, angle, speed, np.zeros(works))
        assert now is not None
        if self.driver.on and self.driver.circuit is not None:
            lasting = self.driver.current(np.asarray(speed))
            now.electric[0] = current if self.driver.lags else lasting
        self.driver.begins(angle, speed, lag)
        self.since = 0.0
        self.corners = sorted({self.driver.ramp_end, *equation.times} - {0.0})
        self._record(now)
        self.direction = copysign(1.0, speed)
        if speed == 0.0:
            self.halts.append(angle)
            now = self._sets_off(now)
            if now is None:
                return
        now = self._switched_on(now)
        marks = [now]
        for k in range(1, MOST_PIECES + 1):
            before, self.since = now, now.time
            with np.errstate(over="ignore", invalid="ignore", divide="ignore"):  # of what is tried
                now = self._piece(now)
            if now is None:
                return
            if not isfinite(now.time + now.angle + now.speed):
                raise _not_beyond(before.time)
            self.on_turns(abs(now.angle - angle) / (2 * pi))
            if k % LOOKED == 0:
                marks = [*marks[-2:], now]
                self._foresee(marks, k)
        raise ResponseError(
            Note("the motion takes too long to be followed; give a shorter time or fewer turns")
        )

    def _foresee(self, marks: list[Instant], done: int) -> None:
        """Refuse what a motor keeps going evenly for far more pieces than can be followed.

        marks : the last instants, `LOOKED` pieces apart.  done : pieces so far.
        """
        limits, now = self.limits, marks[-1]
        stays_on = min(limits.off_time, limits.off_turns) == inf
        if len(marks) < 3 or limits.steady or not (self.driver.on and stays_on):
            return
        before, last = (
            [second.time - first.time, abs(second.angle - first.angle) / (2 * pi)]
            for first, second in pairwise(marks)
        )
        if any(abs(a - b) > EVEN * b for a, b in zip(before, last, strict=True)):
            return
        per_piece = [each / LOOKED for each in last]
        to_come = (limits.time - now.time, limits.turns - abs(now.angle - self.start) / (2 * pi))
        needed = done + min(a / max(b, TINY) for a, b in zip(to_come, per_piece, strict=True))
        if needed > BEYOND * MOST_PIECES:
            time, turns = (float(f"{MOST_PIECES * each:.2g}") for each in per_piece)
            asked = f"{limits.time:.6g} s" if limits.time < inf else f"{limits.turns:.6g} turns"
            raise ResponseError(
                Note(
                    "the motion takes too long to be followed; got {asked}, give about {time} or "
                    "{turns} turns of the crank at most",
                    asked=asked,
                    time=f"{time:g} s",
                    turns=f"{turns:g}",
                )
            )

    def _record(self, *instants: Instant) -> None:
        rows = [
            [instant.time, instant.angle, instant.speed, *instant.electric, *instant.work]
            for instant in instants
        ]
        self.track.append(np.array(rows))

    def _switched_on(self, now: Instant) -> Instant:
        """The instant itself, or, where a current has to grow first, or a reference to run ahead,
        when the crank leaves its rest.
        """
        driver = self.driver
        delayed = driver.lags or driver.remembers
        if not delayed or now.speed or self.direction != driver.sense:
            return now
        acting, holding = self._at_rest(now)
        needed = holding[driver.sense] - driver.sense * acting
        if needed <= 0:
            return now
        time, electric = driver.until(needed * (1 + AT_REST), now.angle, now.time)
        if time <= now.time:
            return now
        later = replace(now, time=time, electric=electric)
        self._record(later)
        return later

    # -- at rest -----------------------------------------------------------------------------------

    def _at_rest(self, now: Instant) -> tuple[float, dict[float, float]]:
        """Torques on a crank at rest as of `CrankEquation.at_rest`, at an instant."""
        factors = load_factors(self.equation.machine, now.time, self.since)
        return self.equation.at_rest(now.angle, factors)

    def _sets_off(self, now: Instant) -> Instant | None:
        """Choose the direction in which a crank at rest starts, and when: at once, or when a load
        over time sets it in motion; note why where it does not.
        """
        self.since = now.time
        kind, _ = self._held_by(now)
        moving = self._released(now)
        if moving is None:
            self._note(kind, now)
            return None
        if moving.time > now.time:
            self._record(moving)
        _, self.direction = self._held_by(moving)
        return moving

    def _released(self, now: Instant) -> Instant | None:
        """The instant from which a crank at rest is held no longer, before the run ends or the
        motor is switched off; None where it stays.
        """
        until = max(now.time, min(self.limits.time, self._off(self.limits.off_time)))
        corners = (time for time in self.corners if now.time < time < until)
        for begin, end in pairwise([now.time, *corners, until]):
            self.since = begin  # where a load may change suddenly
            begin_instant, free = replace(now, time=begin), replace(now, time=end)
            if not self._held_by(begin_instant)[0]:
                return begin_instant
            if end < inf and not self._held_by(free)[0]:
                return self._let_go(begin_instant, free)
        return None

    def _held_by(self, now: Instant) -> tuple[str, float]:
        """Why a crank at rest stays there, as the kind of an event, empty where it does not; and
        the sense in which it starts.
        """
        acting, holding = self._at_rest(now)
        driving = float(self.driver.torque(np.zeros(())))
        net = acting + driving
        sense = copysign(1.0, net)
        resistance = holding[sense] + self.driver.holding()
        resistance += AT_REST * max(self.equation.largest_at_rest, abs(driving))
        if abs(net) <= resistance:
            pushes = holding[sense] > 0 and self.driver.on and net * self.driver.sense > 0
            return "stall" if pushes else "standstill", sense
        return "stall" if self.driver.on and net * self.driver.sense < 0 else "", sense

    def _let_go(self, at_rest: Instant, free: Instant) -> Instant:
        """The instant between two from which a crank at rest is held no longer."""
        while free.time - at_rest.time > RESTING * free.time:
            middle = replace(at_rest, time=(at_rest.time + free.time) / 2)
            if self._held_by(middle)[0]:
                at_rest = middle
            else:
                free = middle
        return free

    # -- a piece -----------------------------------------------------------------------------------

    def _piece(self, begin: Instant) -> Instant | None:
        """To the end of the piece of the table, or to what happens before; None at the end."""
        if self.driver.controlled:
            self.driver.observe(begin.speed, begin.angle, begin.time)
        k, ahead = self.table.piece(begin.angle, self.direction)
        ends = float(self.table.lows[k]) + ahead, float(self.table.highs[k]) + ahead
        solution = None
        self.halvings = max(self.halvings - 1, 0)
        while solution is None and self.halvings <= HALVINGS:
            part = self._part(begin, k, ends)
            solution = self._by_angle(begin, part)
            self.halvings += solution is None
        if solution is None:
            edge = ends[self.direction > 0]
            far = 1.0 if self._slows(begin) else SPEEDING_UP
            return self._in_time(begin, begin.angle + far * (edge - begin.angle))
        x, kind = self._first_in(solution)
        if x == self.direction:
            self.track.append(solution.passed)
            return self._happens(kind, solution.at(x))
        before = (ROW_PLACES[self.direction] - x) * self.direction < 0
        end = solution.at(x)
        self.track.append(solution.passed[before])
        self._record(end)
        return self._happens(kind, end)

    def _part(self, begin: Instant, k: int, ends: tuple[float, float]) -> TableRange:
        """What is tried next of a piece: all of it, or its rest from an instant on, halved as
        often as `halvings` says.
        """
        first, far = ends[:: int(self.direction)]
        if not self.halvings and begin.angle == first:
            return TableRange(
                (k, self.direction), ends, self.table.values[:, k], self.table.coefficients[k][0]
            )
        far = begin.angle + (far - begin.angle) * 0.5**self.halvings
        low, high = min(begin.angle, far), max(begin.angle, far)
        half = (ends[1] - ends[0]) / 2
        places = (low - ends[0]) / half - 1, (high - ends[0]) / half - 1
        place = (k, self.direction, *(round(place, 9) for place in places))
        return TableRange(place, (low, high), *self.table.within(k, *places))

    def _slows(self, now: Instant) -> bool:
        """Whether the speed of the crank falls."""
        state = np.array([now.angle, now.speed, *now.electric])
        return self._rates(now.time, state)[1] * self.direction < 0

    def _by_angle(self, begin: Instant, part: TableRange) -> PieceMotion | None:
        """The motion in a piece; None where the crank is so slow that the angle is no clock."""
        paths = part.half * INTEGRALS[self.direction]
        began = float(part.coefficients @ AT_ENDS[-self.direction]) * begin.speed**2 / 2
        before = self.cycle_before.get(part.place)
        solution = before and self._iterated((begin, began), part, paths, before)
        if solution is None:
            anew = np.zeros(NODES), None
            solution = self._iterated((begin, began), part, paths, anew)
        if solution is None:
            return None
        self.cycle_before[part.place], speed, current, torques = solution
        pace = 1 / speed
        resolved = RESOLVED if self.equation.friction is None else WITH_CORNERS
        for smooth in (pace, current) if self.driver.lags else (pace,):
            if roughness(smooth) > resolved * np.abs(smooth).max():
                return None
        rates = np.concatenate(
            [pace[None], pace * self.driver.electric_rates(current, speed), torques]
        )
        return PieceMotion(begin, part, self.direction, began, rates, self.driver)

    def _iterated(
        self, start: tuple[Instant, float], part: TableRange, paths: Array, guess: Gained
    ) -> tuple[Gained, Array, Array, Array] | None:
        """Newton's method for the kinetic energies at the nodes of a piece: what it has gained up
        to them, speeds (N,), currents (N,) and torques (K, N) there; None where it has no solution.

        start : instant, and kinetic energy then, J.
        paths : (N, N), integrals by crank angle up to each node.
        guess : energies gained, and an inverse of Newton's method where one is known.
        """
        begin, began = start
        energy, inverse = began + guess[0], guess[1]
        before = inf
        for _ in range(MOST_ITERATIONS):
            if not energy.min() > 0:  # nor of what is no number
                return None
            speed = self.direction * np.sqrt(2 * energy / part.values[0])
            current = self._current(speed, paths, begin)
            driving = self._driving(speed, current, paths, begin)
            torques = self._torques(
                part.values, speed, driving, self._times_at(speed, paths, begin)
            )
            residual = began + paths @ torques.sum(axis=0) - energy
            most = float(np.abs(residual).max())
            if most <= CLOSE * energy.max():
                return (energy - began, inverse), speed, current, torques
            if inverse is None or most > QUICK * before:
                slopes = self._slopes(part.values, speed, torques, (paths, begin)) / energy
                inverse = np.linalg.inv(np.eye(NODES) - paths @ slopes)
            before = most
            energy = energy + inverse @ residual
        return None

    def _current(self, speed: Array, paths: Array, begin: Instant) -> Array:
        """Of the motor (N,), A, at the nodes of a piece that is passed at these speeds (N,)."""
        if self.driver.lags:
            return self.driver.currents(speed, paths, float(begin.electric[0]))
        return self.driver.current(speed)

    def _driving(self, speed: Array, current: Array, paths: Array, begin: Instant) -> Array:
        """Torque of the drive (N,), N m, at the nodes of a piece that is passed at these speeds
        (N,), with these currents (N,), A.
        """
        angle = time = speed
        if self.driver.controlled:  # else angle and time do not matter
            angle = begin.angle + paths @ np.ones(len(speed))
            time = begin.time + paths @ (1 / speed)
        return self.driver.driving_torque(speed, current, angle, time)

    def _slopes(
        self, values: Array, speed: Array, torques: Array, piece: tuple[Array, Instant]
    ) -> Array:
        """Of the sum of torques (N, N) at the nodes by the logarithm of the energy at each: only
        the same one, but for a motor whose torque depends on what was before.
        """

        def nudged(faster: Array) -> Array:
            current = self._current(faster, *piece)
            driving = self._driving(faster, current, *piece)
            changed = self._torques(values, faster, driving, self._times_at(faster, *piece))
            changed = changed - torques
            return np.asarray(np.sum(changed, axis=0) / (2 * NUDGE))

        if not (self.driver.lags or self.driver.remembers or self.equation.times):
            return np.diag(nudged(speed * (1 + NUDGE)))
        return np.stack([nudged(speed * (1 + NUDGE * own)) for own in np.eye(len(speed))], axis=1)

    def _times_at(self, speed: Array, paths: Array, begin: Instant) -> Array | float:
        """Times (N,), s, at the nodes of a piece that is passed at these speeds (N,); the begin's
        where nothing asks for them.
        """
        return begin.time + paths @ (1 / speed) if self.equation.times else begin.time

    def _torques(self, columns: Array, speed: Array, driving: Array, time: Array | float) -> Array:
        """Of each of the works, of the brake where there is one, and of the drive, (K + 1, ...) or
        (K + 2, ...); driving : of the drive (...), N m.  time : (...), s.
        """
        braking = self._braking()
        factors = load_factors(self.equation.machine, time, self.since)
        acting = driving + sum(braking)
        sources = self.equation.torques(columns, speed, acting, self.direction, factors)
        if braking:
            sources = np.concatenate([sources, np.full((1, *np.shape(speed)), braking[0])])
        return np.concatenate([sources, driving[None]])

    def _braking(self) -> list[float]:
        """Torque of the brake on a crank that turns as it does, N m; empty without a brake."""
        return [-self.direction * self.driver.holding()] if self.driver.brake else []

    def _first_in(self, solution: PieceMotion) -> tuple[float, str]:
        """Place in a part of a piece at which something happens first, and what."""
        from scipy.optimize import brentq

        at, begin, part, far = solution.at, solution.begin, solution.part, solution.sense
        ends, start = part.ends, (begin.angle - part.ends[0]) / part.half - 1
        pairs: list[tuple[float, str]] = []
        for kind, angle in self._angles():
            if ends[0] <= angle <= ends[1] and (angle - begin.angle) * far > AT_EDGE:
                pairs.append(((angle - ends[0]) / part.half - 1, kind))
        for kind, time in self._times():
            if begin.time < time < inf and time <= at(far).time:

                def left(x: float, time: float = time) -> float:
                    return at(x).time - time

                pairs.append((brentq(left, start, far, xtol=1e-15), kind))
        if self.driver.controlled and (limit := self._limit_in(start, solution.rows)) is not None:
            pairs.append((limit, "limit"))
        # of what happens at the edge itself the others come first
        return min([*pairs, (far, "edge")], key=lambda item: item[0] * far)

    def _limit_in(self, start: float, within: Callable[[Array], Array]) -> float | None:
        """Place in a piece, beyond its start, at which a servo motor comes to its limit of torque,
        or from it; None where it does not.
        """
        from scipy.optimize import brentq

        def beyond(places: Array) -> Array:
            time, angle, speed = within(places).T[:3]
            return self.driver.beyond(speed, angle, time)

        places = np.linspace(start, self.direction, CHECKED + 1)
        outside = beyond(places)
        if not np.any(over := outside[1:] > LIMIT_REACHED):
            return None
        k = int(np.argmax(over))
        if outside[k] >= 0:
            return float(places[k])
        ends = float(places[k]), float(places[k + 1])
        return float(brentq(lambda x: float(beyond(np.array([x]))[0]), *ends, xtol=1e-15))

    def _angles(self) -> Iterator[tuple[str, float]]:
        """Crank angles at which something is to happen."""
        for kind, turns in (
            ("turns", self.limits.turns),
            ("off", self._off(self.limits.off_turns)),
        ):
            if turns < inf:
                yield from ((kind, self.start + sign * 2 * pi * turns) for sign in (1, -1))

    def _times(self) -> Iterator[tuple[str, float]]:
        yield "time", self.limits.time
        yield "corner", next((time for time in self.corners if time > self.since), inf)
        yield "off", self._off(self.limits.off_time)

    def _off(self, limit: float) -> float:
        return limit if self.driver.on else inf

    # -- in time -----------------------------------------------------------------------------------

    def _in_time(self, begin: Instant, edge: float) -> Instant | None:
        """The motion in time to an edge, or to what happens before."""
        from scipy.integrate import solve_ivp

        marks = [(kind, angle) for kind, angle in [("edge", edge), *self._angles()]
                 if (angle - begin.angle) * self.direction > AT_EDGE]  # fmt: skip
        times = [(time, kind) for kind, time in self._times() if time > begin.time]
        until, last = min(times)
        events: list[Any] = [lambda _, y: self.direction * y[1]]
        events += [lambda _, y, angle=angle: y[0] - angle for _, angle in marks]
        if self.driver.controlled:
            marks.append(("limit", inf))
            events.append(lambda t, y: float(self.driver.beyond(y[1], y[0], np.asarray(t))))
            events[-1].direction = 1.0
        for event in events:
            event.terminal = True
        events[0].direction = -1.0
        span = begin.time, min(until, begin.time + PATIENCE / self.usual)
        state = [begin.angle, begin.speed, *begin.electric, *begin.work]
        self.rates_left = MOST_RATES
        done = solve_ivp(
            self._rates,
            span,
            state,
            "Radau" if self._is_stiff(begin, edge) else "DOP853",
            dense_output=True,
            events=events,
            rtol=RELATIVE,
            atol=self.absolute,
        )
        if not done.success or not np.all(np.isfinite(done.y)):
            raise _not_beyond(done.t[-1])
        shares = np.arange(1, BETWEEN + 1) / BETWEEN
        time = (done.t[:-1, None] + np.diff(done.t)[:, None] * shares).ravel()
        rows = np.column_stack([time, done.sol(time).T])
        end = np.append(done.t[-1], done.y[:, -1])
        if not self.driver.lags:
            rows[:, 3] = self.driver.current(rows[:, 2])
            end[3] = float(self.driver.current(end[2]))
        self.track.append(rows)
        kind = last if done.t[-1] >= until else "rest"
        for hit, (name, _) in zip(done.t_events, [("halt", 0.0), *marks], strict=True):
            kind = name if hit.size else kind
        instant = instant_of(end)
        return self._happens(kind, replace(instant, angle=edge) if kind == "edge" else instant)

    def _is_stiff(self, begin: Instant, edge: float) -> bool:
        """Whether something follows the speed far quicker than the crank turns to an edge."""
        if self.driver.current_lag * self.usual < STIFF:
            return True
        places = np.linspace(begin.angle, edge, 3)
        rate = self.equation.damping(places, begin.speed, self.direction)
        return self.usual < DAMPED * rate

    def _rates(self, time: float, state: Array) -> list[float]:
        if not np.all(np.isfinite(state[:2])):  # a try that has left all numbers
            return [nan] * len(state)
        self.rates_left -= 1
        if self.rates_left < 0:  # as of a motor a thousand million times too strong
            raise _not_beyond(time)
        angle, speed, driver = float(state[0]), float(state[1]), self.driver
        current = np.asarray(state[2] if driver.lags else driver.current(state[1]))
        electric = driver.electric_rates(current, state[1]).tolist()
        at = np.asarray(state[1]), current, state[0], np.asarray(time)
        driving = float(driver.driving_torque(*at))
        braking = self._braking()
        acting = driving + sum(braking)
        factors = load_factors(self.equation.machine, time, self.since)
        inertia, slope, torques = self.equation.at(angle, speed, acting, self.direction, factors)
        change = (float(np.sum(torques)) + acting - 0.5 * slope * speed * speed) / inertia
        powers = [torque * speed for torque in (*torques.tolist(), *braking, driving)]
        return [speed, change, *electric, *powers]

    # -- events ------------------------------------------------------------------------------------

    def _happens(self, kind: str, now: Instant) -> Instant | None:
        """Change what an event changes; the instant to go on from, None where the run is over."""
        if kind == "edge":
            return self._passes(now)
        if kind == "halt":
            return self._halts(now)
        if kind == "limit":
            self.driver.observe(now.speed, now.angle, now.time, reached=True)
            kind = "smooth"
        if kind == "corner":
            self.corners = [time for time in self.corners if time > just_after(now.time)]
            kind = "smooth"
        if kind == "smooth":  # the torque's law changes, and nothing happens that is reported
            return now
        if kind == "rest":
            if abs(now.speed) > SLOW * self.usual:
                return now
            kind = "standstill"
        self._note(kind, now)
        if kind != "off":
            return None
        left = float(self.driver.stored(now.electric[0]))
        self.driver.on = False
        self.corners = [time for time in self.corners if time in self.equation.times]
        current, supply, heat = now.electric
        return replace(now, electric=np.array([0.0 * current, supply, heat + left]))

    def _passes(self, now: Instant) -> Instant | None:
        """Over the edge of a piece, with which a cycle may begin, and a steady state be there."""
        cycles = now.angle / self.equation.period
        if abs(cycles - round(cycles)) > SAME:
            return now
        before = self.begins[-1] if self.begins else None
        self.begins.append(now)
        to_come = bool(self.corners) and self.corners[-1] in self.equation.times
        if not self.limits.steady or before is None or self._to_be_switched_off or to_come:
            return now
        if abs(now.speed - before.speed) > STEADY * abs(now.speed):
            return now
        self._note("steady", now)
        return None

    @property
    def _to_be_switched_off(self) -> bool:
        return min(self._off(self.limits.off_time), self._off(self.limits.off_turns)) < inf

    def _halts(self, now: Instant) -> Instant | None:
        """At speed 0: turn back, or stay."""
        now = replace(now, speed=0.0)
        if self.driver.remembers:
            return self._waits(now)
        if self.driver.on and self.direction == self.driver.sense:
            self._note("stall", now)
            return None
        moving = self._sets_off(now)
        if moving is None:
            return None
        now = moving
        self.halts.append(now.angle)
        if self._is_at_ease():
            self._note("standstill", now)
            return None
        self._note("reversal", now)
        return now if len(self.events) < MOST_REVERSALS else None

    def _is_at_ease(self) -> bool:
        """Whether the last swing is next to nothing beside the widest."""
        swings = np.abs(np.diff(self.halts))
        return len(swings) > 1 and bool(swings[-1] <= AT_EASE * np.max(swings))

    def _waits(self, now: Instant) -> Instant | None:
        """At speed 0, with a motor whose torque changes with time: turn back where it is too weak
        yet to hold the crank, stay until it is strong enough, or for good.
        """
        before = self.direction
        moving = self._sets_off(now)
        if moving is None:
            return None
        now = moving
        acting, holding = self._at_rest(now)
        driving = self.driver.torque_at(np.zeros(()), np.asarray(now.angle), np.asarray(now.time))
        net = acting + float(driving)
        if abs(net) > holding[copysign(1.0, net)]:
            self.direction = copysign(1.0, net)
            if self.direction != before:
                self._note("reversal", now)
            return now if len(self.events) < MOST_REVERSALS else None
        return self._switched_on(now)

    def _note(self, kind: str, now: Instant) -> None:
        self.events.append(Event(kind, now.time, now.angle, now.speed))


def _not_beyond(time: float) -> ResponseError:
    """The motion can be followed up to a time, s, and no further."""
    return ResponseError(Note("the motion cannot be integrated beyond {t:g} s", t=time))
