"""The motion of several drives from a start on, integrated in time.

SciPy's DOP853 goes from event to event: explicit and of order 8, because the equations are smooth
and not stiff, and tolerances are tight; or Radau, where a motor's current is far quicker than the
drives.  The work of everything that acts is integrated on the way, so that their sum can be held
against the kinetic energy of the linkage itself.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from math import inf, nan, pi
from typing import Any, NamedTuple

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.errors import ResponseError
from equipoise.i18n import Note
from equipoise.running.drives_equation import DriveAngles, DrivesEquation
from equipoise.running.equation import just_after
from equipoise.running.integration import Limits
from equipoise.signals import Array

RELATIVE, ABSOLUTE = 1e-11, 1e-13
"""Tolerances of a step, over the states and over their usual sizes."""
BETWEEN = 4
"""Instants read in a step."""
MOST_RATES = 200_000
"""Of the motion, computed in a run: half a minute; a turn takes some thousands."""
STEADY = 1e-6
"""Share by which speeds may differ from those a cycle before, in a steady state."""
AT_REST = 1e-6
"""Share of the usual speed, and of what gives it in a radian, below which a machine stands."""
DEAD = 1e-6
"""Squared sine of a transmission angle at which the motion is followed no further: the links of the
dyad run through their dead position so fast that steps become too short."""
BRAKED = 1e-3
"""Share of the usual speed near which a brake changes its sense."""
AT_EDGE = 1e-9
"""rad, within which crank angles are the same."""
STIFF = 1e-4
"""rad at the usual speed within which a motor's current follows the speed, below which an explicit
method takes thousands of steps in a turn."""
ELECTRIC = 3
"""Values of a motor's circuit: its current, and two works."""


@dataclass(frozen=True)
class DriveEvent:
    """What happens in a run of several drives.

    kind : ``off``, ``reversal``, ``steady``, ``standstill``, ``stall``, ``dead``, ``turns`` or
        ``time``; the last one of a run ended it.
    time : s.  crank_angle : rad.
    of : driven link that turns back, or joint of a dyad in its dead position; else empty.
    """

    kind: str
    time: float
    crank_angle: float
    of: str = ""


class Acting(NamedTuple):
    """What acts in a state.

    accelerations, torques : of all drives (N,), rad/s2 and N m.  others : torques (N,) on them of
        each source, and of a brake, N m.
    """

    where: DriveAngles
    accelerations: list[float]
    torques: list[float]
    others: list[list[float]]


class DrivesIntegration:
    """Follow the drives of a machine.

    track : time and state at the instants of the solution.  torques : of all drives there, N m.
    marks : times, s, at which a cycle of the crank began.
    on_turns : called with the turns of the crank from the start, as often as these may change.

    The state has angles and speeds of the unknowns, current and two works of each motor with a
    circuit, and works of all that acts, in the order of `works`.
    """

    def __init__(self, equation: DrivesEquation, limits: Limits) -> None:
        self.equation, self.limits = equation, limits
        self.drivers = equation.drivers()
        self.usual = abs(equation.machine.drive.speed) or 1.0
        self.circuits = [k for k, item in enumerate(self.drivers) if item.circuit is not None]
        braked = ["brake"] if self.drivers[0].brake and 0 in equation.unknowns else []
        turned = [
            drive.link
            for k, drive in enumerate(equation.drives)
            if drive.motor is not None or k in equation.given
        ]
        self.works = (
            *equation.program.sources, *braked, *(f"drives.{link}" for link in turned)
        )  # fmt: skip
        self.track: list[tuple[float, list[float]]] = []
        self.torques: list[list[float]] = []
        self.events: list[DriveEvent] = []
        self.marks: list[float] = []
        self.rates_left = MOST_RATES
        self.since = 0.0
        self.on_turns: Callable[[float], None] = lambda turns: None

    # -- the state ---------------------------------------------------------------------------------

    @property
    def _count(self) -> int:
        return len(self.equation.unknowns)

    def where(self, time: Any, state: Sequence[Any]) -> DriveAngles:
        """Angles of all drives in a state."""
        count = self._count
        return self.equation.placed(time, state[:count], state[count : 2 * count])

    def _crank_angle(self, time: float, state: Sequence[float]) -> float:
        return float(self.where(time, state).crank_angle)

    def _driving(self, time: float, where: DriveAngles, state: Sequence[float]) -> list[float]:
        """Torques (N,) of motors, N m; 0 of drives without one."""
        torques = [0.0] * len(self.drivers)
        for k, driver in enumerate(self.drivers):
            if not driver.on:
                continue
            if driver.lags:
                torques[k] = float(driver.torque_of(np.asarray(self._current(k, state))))
                continue
            each = (where.speeds[k], where.angles[k], time)
            torques[k] = float(driver.torque_at(*map(np.asarray, each)))
        return torques

    def _current(self, drive: int, state: Sequence[float]) -> float:
        return float(state[self.circuit_place(drive)][0])

    def circuit_place(self, drive: int) -> slice:
        """Of the values of a motor's circuit in the state."""
        first = 2 * self._count + ELECTRIC * self.circuits.index(drive)
        return slice(first, first + ELECTRIC)

    def _braking(self, where: DriveAngles) -> float:
        """Torque of the brake on the first drive, N m, which changes its sense smoothly."""
        speed, near = where.speeds[0], BRAKED * self.usual
        return float(-self.drivers[0].holding() * speed / (speed**2 + near**2) ** 0.5)

    def _acting(self, time: float, state: Sequence[float]) -> Acting | None:
        """What acts in a state; None where the machine cannot be."""
        equation, where = self.equation, self.where(time, state)
        equations = equation.at(time, just_after(self.since), where)
        if equations is None:
            return None
        torques = self._driving(time, where, state)
        others = [[*force] for force in equations.forces]
        total = [*torques]
        if "brake" in self.works:
            others.append([self._braking(where), *[0.0] * (len(torques) - 1)])
            total[0] += others[-1][0]
        accelerations = equation.accelerations(equations, where, total)
        for k, torque in equation.given_torques(equations, accelerations).items():
            torques[k] = torque
        return Acting(where, accelerations, torques, others)

    def rates(self, time: float, state: Any) -> list[float]:
        """Of the state by time; NaN of what a step tries beyond a dead position."""
        self.rates_left -= 1
        if self.rates_left < 0:
            raise ResponseError(
                Note("the motion takes too long to be followed; give a shorter time or fewer turns")
            )
        values = state.tolist()
        acting = self._acting(time, values) if np.isfinite(values).all() else None
        if acting is None:
            return [nan] * len(values)
        where, accelerations, torques, others = acting
        rates = [*values[self._count : 2 * self._count]]
        rates += [accelerations[k] for k in self.equation.unknowns]
        for k in self.circuits:
            driver, speed = self.drivers[k], np.asarray(where.speeds[k])
            current = self._current(k, values) if driver.lags else float(driver.current(speed))
            rates += driver.electric_rates(np.asarray(current), speed).tolist()
        powers = [
            sum(torque * speed for torque, speed in zip(other, where.speeds, strict=True))
            for other in others
        ]
        powers += [
            torques[k] * where.speeds[k]
            for k, drive in enumerate(self.equation.drives)
            if f"drives.{drive.link}" in self.works
        ]
        return [*rates, *powers]

    # -- from event to event -----------------------------------------------------------------------

    def follow(self, angles: Sequence[float], speeds: Sequence[float]) -> None:
        """Run from angles, rad, and speeds, rad/s, of the unknowns until something ends it."""
        equation = self.equation
        state = [*angles, *speeds]
        for place, k in enumerate(equation.unknowns):
            self.drivers[k].begins(angles[place], speeds[place])
        for k in self.circuits:
            driver = self.drivers[k]
            lasting = float(driver.current(np.asarray(speeds[equation.unknowns.index(k)])))
            state += [0.0 if driver.lags else lasting, 0.0, 0.0]
        state += [0.0] * len(self.works)
        self.start = self._crank_angle(0.0, state)
        ramps = (driver.ramp_end for driver in self.drivers if driver.on)
        timed = {time for load in equation.machine.timed_loads for time in load.times}
        self.corners = sorted({*ramps, *timed} - {0.0})
        self._mark_span = 2 * pi * equation.machine.turns_given
        self.mark = self.start
        if min((left(0.0, np.array(state)) for left in self._margins), default=1.0) < 0:
            raise ResponseError(
                Note(
                    "the links cannot be assembled at the angles of the drives at the start"
                ).about("links-cannot-be-joined-at-any-crank-angle")
            )
        self._record(0.0, state)
        self._at_mark: list[float] | None = None
        self._begin_cycle(0.0, state)
        if self._activity(0.0, state) < AT_REST:
            self._note(self._rest, 0.0, state)
            return
        time: float = 0.0
        while state:
            time, state = self._span(time, state)
            self.since = time

    def _record(self, time: float, state: Sequence[float]) -> None:
        acting = self._acting(time, state)
        self.track.append((time, [*state]))
        self.torques.append([nan] * len(self.drivers) if acting is None else acting.torques)

    @property
    def _rest(self) -> str:
        return "stall" if any(driver.on for driver in self.drivers) else "standstill"

    def _span(self, time: float, state: list[float]) -> tuple[float, list[float]]:
        """On to what happens next; no state where the run is over."""
        from scipy.integrate import solve_ivp

        until, last = min((moment, kind) for kind, moment in self._times() if moment > time)
        kinds, events = zip(*self._watched(time), strict=True)
        done = solve_ivp(
            self.rates,
            (time, until),
            np.array(state),
            "Radau" if self._is_stiff else "DOP853",
            dense_output=True,
            events=events,
            rtol=RELATIVE,
            atol=ABSOLUTE * self._sizes(len(state)),
        )
        if not done.success:
            raise ResponseError(
                Note("the motion cannot be integrated beyond {t:g} s", t=float(done.t[-1]))
            )
        shares = np.arange(1, BETWEEN + 1) / BETWEEN
        for begin, end in zip(done.t[:-1], done.t[1:], strict=True):
            for moment in (begin + (end - begin) * shares[:-1]).tolist():
                self._record(moment, done.sol(moment).tolist())
            self._record(float(end), done.sol(end).tolist())
        time, state, kind = float(done.t[-1]), done.y[:, -1].tolist(), last
        for hits, (name, of) in zip(done.t_events, kinds, strict=True):
            if name == "reversal":
                turned = ((moment, done.sol(moment).tolist()) for moment in hits.tolist())
                self.events += [item for at in turned if (item := self._turned_back(of, *at))]
            elif hits.size:
                kind = name
        self.events.sort(key=lambda event: event.time)
        self.on_turns(abs(self._crank_angle(time, state) - self.start) / (2 * pi))
        return time, self._happens(self._reached(kind, state), time, state)

    def _reached(self, kind: str, state: Sequence[float]) -> str:
        """What happens in a state, where several things do so at the same crank angle."""
        if kind != "mark" or not self.equation.by_crank:
            return kind
        return next(
            (
                name
                for name, way, origin in self._crank_ways()
                if name != "mark" and way - abs(state[0] - origin) < AT_EDGE
            ),
            kind,
        )

    def _turned_back(self, link: str, time: float, state: Sequence[float]) -> DriveEvent | None:
        """That a drive turns back; None of one that starts, or stands still but for rounding."""
        acting = self._acting(time, state)
        place = [drive.link for drive in self.equation.drives].index(link)
        if time == 0.0 or acting is None:
            return None
        if abs(acting.accelerations[place]) <= AT_REST * self.usual**2:
            return None
        return DriveEvent("reversal", time, float(acting.where.crank_angle), link)

    def _sizes(self, count: int) -> Array:
        """Usual sizes of a state."""
        energy = float(self.equation.energy(*self._arrays()).max()) or 1.0
        sizes = [1.0] * self._count + [self.usual] * self._count
        for k in self.circuits:
            circuit = self.drivers[k].circuit
            assert circuit is not None
            sizes += [circuit.voltage / circuit.resistance, energy, energy]
        return np.array([*sizes, *[energy] * (count - len(sizes))])

    def _arrays(self) -> tuple[Array, Array]:
        """Angles of the first instant, and usual speeds, of all drives (N, 1)."""
        where = self.where(*self.track[0])
        return np.array(where.angles)[:, None], np.full((len(where.angles), 1), self.usual)

    @property
    def _is_stiff(self) -> bool:
        return min(driver.current_lag for driver in self.drivers) * self.usual < STIFF

    def _times(self) -> Iterator[tuple[str, float]]:
        """Moments, s, at which something is to happen."""
        limits, pace = self.limits, abs(self.equation.machine.drive.speed)
        yield "time", limits.time
        yield "corner", next((time for time in self.corners if time > self.since), inf)
        on = any(driver.on for driver in self.drivers)
        yield "off", limits.off_time if on else inf
        if self.equation.by_crank or not pace:
            return
        yield "turns", 2 * pi * limits.turns / pace
        yield "off", 2 * pi * limits.off_turns / pace if on else inf
        if self.equation.given:
            yield "mark", (abs(self.mark - self.start) + self._mark_span) / pace

    def _watched(self, time: float) -> Iterator[tuple[tuple[str, str], Any]]:
        """What may happen on the way: its kind and what of, and a function that is 0 there."""
        count, equation = self._count, self.equation
        for k, place in enumerate(equation.unknowns, count):
            yield ("reversal", equation.drives[place].link), _value(k)
        for joint, left in zip(equation.program.dyads, self._margins, strict=True):
            yield ("dead", joint), _ending(left)
        for k, what in enumerate(equation.program.ranges):
            yield ("range", what), _ending(self._left(k, ranges=True))
        if not equation.given:
            yield ("rest", ""), _ending(lambda t, y: self._activity(t, y.tolist()) - AT_REST)
        if not equation.by_crank:
            return
        for kind, way, origin in self._crank_ways():
            yield (kind, ""), _ending(_way_left(way, origin))

    def _crank_ways(self) -> Iterator[tuple[str, float, float]]:
        """What is to happen after a way of the crank, rad, from an angle on."""
        on = any(driver.on for driver in self.drivers)
        yield "mark", self._mark_span, self.mark
        if self.limits.turns < inf:
            yield "turns", self.limits.turns * 2 * pi, self.start
        if on and self.limits.off_turns < inf:
            yield "off", self.limits.off_turns * 2 * pi, self.start

    @property
    def _margins(self) -> list[Callable[[float, Any], float]]:
        """How far each dyad is from its dead position."""
        return [self._left(number) for number in range(len(self.equation.program.dyads))]

    def _left(self, number: int, ranges: bool = False) -> Callable[[float, Any], float]:
        """How far a dyad is from its dead position, or a range from its end."""

        def left(time: float, state: Any) -> float:
            where = self.where(time, state.tolist())
            equations = self.equation.at(time, just_after(self.since), where)
            if equations is None:
                return -1.0
            return equations.ranges[number] if ranges else equations.margins[number] - DEAD

        return left

    def _activity(self, time: float, state: Sequence[float]) -> float:
        """How far a machine is from a rest that lasts: speeds and accelerations over usual ones, or
        what a current is still to grow; 1 while a load or a reference changes with time.
        """
        acting = self._acting(time, state)
        if acting is None or self.equation.given or (self.corners and self.corners[-1] > time):
            return 1.0
        speeds = acting.where.speeds
        sizes: list[float] = [abs(speed) / self.usual for speed in speeds]
        sizes += [abs(value) / self.usual**2 for value in acting.accelerations]
        for k in self.circuits:
            driver = self.drivers[k]
            if driver.lags and driver.circuit is not None:
                lasting = float(driver.current(np.asarray(speeds[k])))
                short = abs(lasting - self._current(k, state))
                sizes.append(short * driver.circuit.resistance / driver.circuit.voltage)
        return max(sizes)

    def _happens(self, kind: str, time: float, state: list[float]) -> list[float]:
        """Change what an event changes; the state to go on from, empty where the run is over."""
        if kind == "corner":
            self.corners = [corner for corner in self.corners if corner > just_after(time)]
            return state
        if kind in ("mark", "turns") and abs(self._since_mark(time, state)) < AT_EDGE:
            goes_on = self._begin_cycle(time, state)
            if kind == "mark":
                return state if goes_on else []
        if kind == "range":
            raise ResponseError(
                Note(
                    "after {time:g} s an element leaves the range for which it is given; give it a "
                    "wider one, or a shorter time",
                    time=time,
                )
            )
        if kind == "off":
            return self._switch_off(time, state)
        of = ""
        if kind == "dead":
            equations = self.equation.at(time, just_after(self.since), self.where(time, state))
            margins = [-1.0] if equations is None else [*equations.margins]
            of = self.equation.program.dyads[margins.index(min(margins))]
        self._note(self._rest if kind == "rest" else kind, time, state, of)
        return []

    def _since_mark(self, time: float, state: Sequence[float]) -> float:
        """What is left of a cycle, rad."""
        return self._mark_span - abs(self._crank_angle(time, state) - self.mark)

    def _switch_off(self, time: float, state: list[float]) -> list[float]:
        """Without motors: what the field of their coils holds turns into heat."""
        self._note("off", time, state)
        for k in self.circuits:
            current, supply, heat = state[self.circuit_place(k)]
            if self.drivers[k].lags:
                heat += float(self.drivers[k].stored(np.asarray(current)))
            state[self.circuit_place(k)] = [0.0, supply, heat]
        for driver in self.drivers:
            driver.on = False
        return state

    def _begin_cycle(self, time: float, state: list[float]) -> bool:
        """Note the begin of a cycle; whether the run goes on, as it does before a steady state."""
        self.marks.append(time)
        self.mark = self._crank_angle(time, state)
        before, self._at_mark = self._at_mark, [*state[: 2 * self._count]]
        switched = min(self.limits.off_time, self.limits.off_turns) < inf
        on = any(driver.on for driver in self.drivers)
        if before is None or not self.limits.steady or self.corners or (switched and on):
            return True
        changes = [after - now for after, now in zip(self._at_mark, before, strict=True)]
        turned = [abs((change + pi) % (2 * pi) - pi) for change in changes[: self._count]]
        gained = [abs(change) / self.usual for change in changes[self._count :]]
        if max(*turned, *gained) > STEADY:
            return True
        self._note("steady", time, state)
        return False

    def _note(self, kind: str, time: float, state: Sequence[float], of: str = "") -> None:
        self.events.append(DriveEvent(kind, time, self._crank_angle(time, state), of))


def _value(place: int) -> Callable[[float, Any], float]:
    """A value of the state."""
    return lambda _, state: float(state[place])


def _way_left(way: float, origin: float) -> Callable[[float, Any], float]:
    """What is left of a way of the crank from an angle, rad."""
    return lambda _, state: way - abs(float(state[0]) - origin)


def _ending(function: Callable[[float, Any], float]) -> Any:
    """A function whose fall below 0 ends a span of the integration."""

    def event(time: float, state: Any) -> float:
        return function(time, state)

    event.terminal, event.direction = True, -1.0  # type: ignore[attr-defined]
    return event
