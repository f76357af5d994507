"""The motion of several drives from a start on, integrated in time.

Spans of time follow each other, each as long as polynomials resolve the motion in it, up to what
happens next: what is watched for are functions that fall below 0, whose zeros are sought on the
polynomials.  The work of everything that acts is integrated on the way, so that their sum can be
held against the kinetic energy of the linkage itself.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from math import inf, pi
from typing import NamedTuple

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.errors import LockError, ModelError, ResponseError
from equipoise.i18n import Note
from equipoise.running.collocation import (
    NODES,
    POINTS,
    NodeValues,
    TimeSpan,
    solved_span,
    unresolved,
)
from equipoise.running.drives_equation import (
    AT_CONTACT,
    DrivesEquation,
    DrivesRates,
    DrivesReadings,
)
from equipoise.running.drives_linkage import References, cannot_be_assembled
from equipoise.running.friction import NEAR_REST, leaving, settled_at
from equipoise.running.integration import Limits
from equipoise.running.sources import just_after
from equipoise.signals import Array

RESOLVED = 1e-9
"""Share of their sizes that the last coefficients of states, and of works, may be in a span."""
ORDER = 12
"""By which power of its width, about, the last coefficients of a span grow."""
FIRST_WIDTH = 0.05
"""rad at the usual speed, in the first span."""
SHORTEST = 1e-12
"""rad at the usual speed: a span in which nothing moves, over what changes suddenly."""
MOST_RETURNS = 20
"""Times that a crank turns back, after which a run of so many turns ends."""
MOST_SPANS = 5_000
"""Of a run: a minute or two; a turn takes some ten to fifty."""
TRACK_PLACES = np.linspace(-1.0, 1.0, 33)[1:]
"""Places of a span that the track records, from -1 to 1: lines between them with the right
angles and speeds at both ends are off by less than the integration is."""
LOOKED = 48
"""Parts of a span, in each of which it is seen whether something happens."""
STEADY = 1e-6
"""Share by which speeds may differ from those a cycle before, in a steady state."""
AT_REST = 1e-6
"""Share of the usual speed, and of what gives it in a radian, below which a machine stands."""
CREEPING = 1e-5
"""Share as of `AT_REST` of what gives speeds, below which a machine that is slower than near rest
is held by friction, which lets it creep there."""
DEAD = 1e-6
"""Squared sine of a transmission angle at which the motion is followed no further: the links of the
dyad run through their dead position so fast that spans become too short."""
AT_EDGE = 1e-9
"""rad, within which crank angles are the same."""
NEAR_REST_TIMES = 3.0
"""How often the time in which a joint is as fast as near rest fits into a span from there on."""
SHORTLY = 1e-3
"""Part of a span before an instant, from which on it is seen which way something goes there."""
ROUNDING = 1e-15
"""Share of a time within which a span ends at it."""
INSIDE = 1e-6
"""Share of the rate near rest, by which a joint has to be slower for it to be known."""


@dataclass(frozen=True)
class DriveEvent:
    """What happens in a run of several drives.

    kind : ``off``, ``reversal``, ``steady``, ``standstill``, ``stall``, ``dead``, ``lever``,
        ``swings``, ``turns`` or ``time``; the last one of a run ended it.
    time : s.  crank_angle : rad.
    of : driven link that turns back, joint of a dyad in its dead position, or links on which
        strokes have no lever; else empty.
    """

    kind: str
    time: float
    crank_angle: float
    of: str = ""


class SpanInstants(NamedTuple):
    """A span at K places.

    times : (K,) s.  states, rates : (n, K) and their rates by time.
    """

    times: Array
    states: Array
    rates: Array
    others: DrivesReadings


class DrivesTrack(NamedTuple):
    """Rows of the solution at K instants.

    time : (K,) s.  states : (n, K).  quadratures : (Q, K).  references : (..., K).
    torques, accelerations : as of `DrivesReadings`.
    """

    time: Array
    states: Array
    quadratures: Array
    torques: Array
    accelerations: Array
    references: References


class DriveWatch(NamedTuple):
    """Something that may happen: its kind, and what of; it does where `left` falls below 0."""

    kind: str
    of: str
    left: Callable[[SpanInstants], Array]


class DrivesIntegration:
    """Follow the drives of a machine.

    tracks : the solution, part by part.  marks : times, s, at which a cycle of the crank began.
    on_turns : called with the turns of the crank from the start, as often as these may change.
    """

    def __init__(self, equation: DrivesEquation, limits: Limits) -> None:
        self.equation, self.limits = equation, limits
        self.rates = DrivesRates(equation)
        self.drivers, self.usual = self.rates.drivers, self.rates.usual
        self.tracks: list[DrivesTrack] = []
        self.events: list[DriveEvent] = []
        self.marks: list[float] = []
        self.on_turns: Callable[[float], None] = lambda turns: None

    # -- from event to event -----------------------------------------------------------------------

    def follow(self, angles: Sequence[float], speeds: Sequence[float]) -> None:
        """Run from the unknowns, such as angles, rad, and their speeds, rad/s, until something
        ends it.
        """
        equation, rates = self.equation, self.rates
        for place, k in self._moved_drives:
            self.drivers[k].begins(angles[place], speeds[place])
        state = np.array([*angles, *speeds, *[0.0] * len(rates.lagging)])
        ramps = (driver.ramp_end for driver in self.drivers if driver.on)
        timed = {time for load in equation.machine.timed_loads for time in load.times}
        self.corners = sorted({*ramps, *timed} - {0.0})
        self.last_corner = max(self.corners, default=0.0)
        self._observe(0.0, state)
        references = equation.references_at_start()
        values = self._first_values(state, references)
        self.sizes, works = rates.sizes(self._usual_energy(state, references))
        self.works = works
        self.start = self.mark = self._crank_angle(0.0, state)
        self._mark_span = 2 * pi * equation.machine.turns_given
        gained = np.zeros(len(works))
        self._record(TimeSpan(0.0, 1.0, state, gained, values), np.array([-1.0]))
        self.width = FIRST_WIDTH / self.usual
        self._at_mark: Array | None = None
        self._begin_cycle(0.0, state)
        if self._activity(self._look_at(0.0, state, values))[0] < AT_REST:
            self._note(self._rest, 0.0, state)
            return
        self._spans(state, gained, values)

    def _spans(self, state: Array, gained: Array, first: NodeValues) -> None:
        """From a state and quadratures, with what is known there, until something ends the run."""
        time, before, goes_on = 0.0, (TimeSpan(0.0, 1.0, state, gained, first), -1.0), True
        for _ in range(MOST_SPANS):
            self.rates.since = time
            self._observe(time, state)
            moments = [(moment, kind) for kind, moment in self._times() if moment > time]
            until = min(moments)[0]
            due = sorted(kind for moment, kind in moments if moment - until <= ROUNDING * until)
            span = self._span((time, until), (state, gained), before)
            place, watch = self._first_in(span)
            at = np.array([place])
            self._record(span, np.append(TRACK_PLACES[place > TRACK_PLACES], place))
            self._note_reversals(span, place)
            if self._only_swings:
                goes_on = False
                self._note("swings", float(span.time(place)), span.states(at)[:, 0], self._crank)
            ended = place == 1.0 and until - span.time(1.0) <= ROUNDING * span.time(1.0)
            time = until if ended else float(span.time(place))
            state, gained = span.states(at)[:, 0], span.quadratures(at)[:, 0]
            self.on_turns(abs(self._crank_angle(time, state) - self.start) / (2 * pi))
            before = span, place
            events = [(kind, "") for kind in due] if ended else []
            for kind, of in events if watch is None else [(watch.kind, watch.of)]:
                if goes_on:
                    goes_on, state = self._happens((kind, of), (time, state, gained), before)
            if not goes_on:
                self.events.sort(key=lambda event: event.time)
                return
        raise ResponseError(
            Note("the motion takes too long to be followed; give a shorter time or fewer turns")
        )

    def _first_values(self, state: Array, references: References) -> NodeValues:
        """What is known at the start, at all nodes of a span that does not move."""
        nodes = {name: np.repeat(value, NODES, axis=-1) for name, value in references.items()}
        values = self.rates.at(np.zeros(NODES), np.repeat(state[:, None], NODES, axis=1), nodes)
        if values is None and isinstance(self.rates.failure, ModelError | LockError):
            raise self.rates.failure
        if values is None or np.any(self.rates.others(values.others).margins < DEAD):
            raise cannot_be_assembled()
        friction = self.equation.friction
        if friction is not None:
            slow = friction.slow
            self.rates.settled = settled_at(
                self.rates.others(values.others).joint_rates[:, 0], slow
            )
        return values

    def _span(
        self, times: tuple[float, float], start: tuple[Array, Array], before: tuple[TimeSpan, float]
    ) -> TimeSpan:
        """The motion over a span from a time on, up to another at most, s.

        start : states and quadratures.  before : the last span, and its place up to which it went.
        """
        time, until = times
        self._check_settled(before)
        most = min(until - time, self._time_near_rest(before))
        shortest, tried = SHORTEST / self.usual, 0
        while True:
            width = min(self.width, most)
            nodes = time + width * (POINTS + 1) / 2
            gain, references = before[0].beyond(before[1], nodes)
            guess = start[0][:, None] + gain, references
            span = solved_span(
                self.rates.at, (time, width), start, guess, self.sizes, self.rates.count
            )
            if width <= shortest:
                return span or self._passed(time, width, start, references)
            if span is None:
                self.width = width / 4
                continue
            share = RESOLVED / max(unresolved(span, self.sizes, self.works), 1e-30)
            change = 0.9 * share ** (1 / ORDER)
            if share >= 1:
                if width == self.width or change > 1:
                    self.width = max(self.width * min(change, 1.0), width * min(change, 3.0))
                return span
            tried += 1
            self.width = width * min(max(change, 0.2), 0.7 / tried)

    def _passed(
        self, time: float, width: float, start: tuple[Array, Array], references: References
    ) -> TimeSpan:
        """A span so short that nothing moves in it, over what changes suddenly.

        Raises
        ------
        ResponseError : the machine cannot be beyond.
        """
        state, _ = start
        values = self.rates.at(
            time + width * (POINTS + 1) / 2, np.repeat(state[:, None], NODES, axis=1), references
        )
        if values is not None:
            return TimeSpan(time, width, *start, values)
        if isinstance(self.rates.failure, ModelError):
            raise ResponseError(
                Note(
                    "after {time:g} s an element leaves the range for which it is given; give it a "
                    "wider one, or a shorter time",
                    time=time,
                )
            )
        if isinstance(self.rates.failure, LockError):
            raise self.rates.failure
        raise ResponseError(Note("the motion cannot be integrated beyond {t:g} s", t=time))

    def _first_in(self, span: TimeSpan) -> tuple[float, DriveWatch | None]:
        """Place in a span at which something happens first, and what; 1 where nothing does."""
        places = np.linspace(-1.0, 1.0, LOOKED + 1)
        margins = self._look(span, places)
        result: tuple[float, DriveWatch | None] = (1.0, None)
        for watch in self._watched():
            ends = self._fall(span, watch.left, places, watch.left(margins))
            if ends is not None and ends[0] < result[0]:
                place = self._zero(span, watch.left, ends)
                if place < result[0] or result[1] is None:
                    result = place, watch
        return result

    def _fall(
        self, span: TimeSpan, left: Callable[[SpanInstants], Array], places: Array, values: Array
    ) -> Array | None:
        """Two places of a span between which a function with values (K,) at places (K,) first falls
        below 0, be it between two of these alone; None where it does not.
        """
        falls = (values[1:] < 0) & (values[:-1] >= 0)
        first = int(np.argmax(falls)) if np.any(falls) else len(falls)
        before, at, after = values[:-2], values[1:-1], values[2:]
        curved = before - 2 * at + after
        dips = (
            (at >= 0) & (before >= at) & (after >= at) & (8 * at * curved < (after - before) ** 2)
        )
        for k in np.flatnonzero(dips[:first]):
            lowest = places[k + 1] + (before[k] - after[k]) / (2 * curved[k]) * (2 / LOOKED)
            if left(self._look(span, np.array([lowest])))[0] < 0:
                return np.array([places[k], lowest])
        return places[first : first + 2] if first < len(falls) else None

    def _zero(self, span: TimeSpan, left: Callable[[SpanInstants], Array], ends: Array) -> float:
        """Place between two at which a function of the instants of a span is 0."""
        from scipy.optimize import brentq

        def at(place: float) -> float:
            return float(left(self._look(span, np.array([place])))[0])

        return float(brentq(at, *ends.tolist(), xtol=1e-15))

    def _note_reversals(self, span: TimeSpan, until: float) -> None:
        """Note where drives turn back in a span, up to a place."""
        places = np.linspace(-1.0, until, LOOKED + 1)
        count = self.rates.count
        speeds = self._look(span, places).states[count : 2 * count]
        for row, drive in self._moved_drives:
            for k in np.flatnonzero(speeds[row, 1:] * speeds[row, :-1] < 0):
                at = self._zero(span, _value(count + row), places[k : k + 2])
                now = self._look(span, np.array([at]))
                if abs(now.rates[count + row, 0]) > AT_REST * self.usual**2:
                    link = self.equation.drives[drive].link
                    self._note("reversal", float(now.times[0]), now.states[:, 0], link)

    @property
    def _crank(self) -> str:
        """Name of the link whose turns are counted."""
        return self.equation.drives[0].link

    @property
    def _only_swings(self) -> bool:
        """Whether the crank has turned back so often, since the last corner of what is given over
        time, that the turns for which a run is to go on, and nothing else ends
        it, are not to be expected.
        """
        if self.limits.turns == inf or self.limits.time < inf:
            return False
        later = (event for event in self.events if event.time >= self.last_corner)
        kinds = [(event.kind, event.of) for event in later]
        return kinds.count(("reversal", self._crank)) >= MOST_RETURNS

    def _record(self, span: TimeSpan, places: Array) -> None:
        others = self.rates.others(span.others(places))
        self.tracks.append(
            DrivesTrack(
                span.time(places),
                span.states(places),
                span.quadratures(places),
                others.torques,
                others.accelerations,
                span.references(places),
            )
        )

    def _look(self, span: TimeSpan, places: Array) -> SpanInstants:
        others = self.rates.others(span.others(places))
        return SpanInstants(span.time(places), span.states(places), span.rates(places), others)

    def _look_at(self, time: float, state: Array, values: NodeValues) -> SpanInstants:
        """A state, with values at nodes that are all the same."""
        others = self.rates.others(values.others[:, :1])
        return SpanInstants(np.array([time]), state[:, None], values.rates[:, :1], others)

    def _crank_angle(self, time: float, state: Array) -> float:
        return float(self.rates.where(np.array([time]), state[:, None]).crank_angle[0])

    def _usual_energy(self, state: Array, references: References) -> float:
        """Kinetic energy at the start with all drives at the usual speed, J."""
        where = self.rates.where(np.zeros(1), state[:, None])
        where = self.equation.in_rows(np.zeros(1), where, references)
        speeds = np.zeros_like(where.angles)
        speeds[: len(self.drivers)] = self.usual
        return float(self.equation.energy(where._replace(speeds=speeds), references)[0]) or 1.0

    @property
    def _moved_drives(self) -> list[tuple[int, int]]:
        """Places, among the unknowns and among all drives, of the drives that are unknown."""
        drives = len(self.drivers)
        return [(row, k) for row, k in enumerate(self.equation.unknowns) if k < drives]

    # -- what may happen ---------------------------------------------------------------------------

    @property
    def _rest(self) -> str:
        return "stall" if any(driver.on for driver in self.drivers) else "standstill"

    def _observe(self, time: float, state: Array) -> None:
        """Set which servo motors are at their limits, and which mounts touch."""
        where = self.rates.where(np.array([time]), state[:, None])
        for k, driver in enumerate(self.drivers):
            if driver.controlled:
                driver.observe(float(where.speeds[k, 0]), float(where.angles[k, 0]), time)
        self.equation.mounts.observe(where.angles, where.speeds)

    def _check_settled(self, before: tuple[TimeSpan, float]) -> None:
        """Joints that are slow are not settled, whatever has been missed."""
        if (friction := self.equation.friction) is None:
            return
        others = self.rates.others(before[0].others(np.array([before[1]])))
        left = leaving(others.joint_rates, friction.slow, self.rates.settled)[:, 0]
        slow = (self.rates.settled != 0) & (left < -INSIDE)
        self.rates.settled = np.where(slow, 0.0, self.rates.settled)

    def _time_near_rest(self, before: tuple[TimeSpan, float]) -> float:
        """How long a span may be, s, to see how friction of joints near rest changes its sense."""
        friction, near_rest = self.equation.friction, self.rates.settled == 0
        if friction is None or not np.any(near_rest):
            return inf
        changes = self.rates.others(before[0].changes(before[1])[:, None]).joint_rates[:, 0]
        times = friction.slow / np.maximum(np.abs(changes), 1e-300)
        return NEAR_REST_TIMES * float(np.min(times[near_rest]))

    def _times(self) -> Iterator[tuple[str, float]]:
        """Moments, s, at which something is to happen."""
        limits, crank_speed = self.limits, abs(self.equation.machine.drive.speed)
        yield "time", limits.time
        since = self.rates.since
        yield "corner", next((time for time in self.corners if time > since), inf)
        on = any(driver.on for driver in self.drivers)
        yield "off", limits.off_time if on else inf
        if self.equation.by_crank or not crank_speed:
            return
        yield "turns", 2 * pi * limits.turns / crank_speed
        yield "off", 2 * pi * limits.off_turns / crank_speed if on else inf
        if self.equation.given:
            yield "mark", (abs(self.mark - self.start) + self._mark_span) / crank_speed

    def _watched(self) -> Iterator[DriveWatch]:
        """What may happen on the way."""
        equation = self.equation
        for k, (kind, what) in enumerate(equation.dead_positions):
            yield DriveWatch(kind, what, lambda now, k=k: now.others.margins[k] - DEAD)  # type: ignore[misc]
        for k, driver in enumerate(self.drivers):
            if driver.controlled:
                yield DriveWatch("limit", equation.drives[k].link, self._below_limit(k))
        for k in range(len(self.rates.settled)):
            yield DriveWatch("settled", str(k), self._settled_left(k))
        for mount in equation.mounts.one_sided:
            yield DriveWatch("contact", mount, self._contact_left(mount))
        if not equation.given:
            yield DriveWatch("rest", "", lambda now: self._activity(now) - AT_REST)
        if equation.by_crank:
            for kind, way, origin in self._crank_ways():
                yield DriveWatch(kind, "", _way_left(way, origin))

    def _below_limit(self, drive: int) -> Callable[[SpanInstants], Array]:
        """How far a servo motor is from where it comes to its limit of torque, or from it."""

        def left(now: SpanInstants) -> Array:
            where = self.rates.where(now.times, now.states)
            beyond = self.drivers[drive].beyond(where.speeds[drive], where.angles[drive], now.times)
            return -beyond

        return left

    def _contact_left(self, mount: str) -> Callable[[SpanInstants], Array]:
        """How far a one-sided mount is from letting go, or from touching."""

        def left(now: SpanInstants) -> Array:
            where = self.rates.where(now.times, now.states)
            return self.equation.mounts.left(mount, where.angles, where.speeds)

        return left

    def _settled_left(self, joint: int) -> Callable[[SpanInstants], Array]:
        """How far a joint with friction is from where the sense of its motion begins to change, or
        has changed.
        """
        friction = self.equation.friction
        assert friction is not None
        own, slow = slice(joint, joint + 1), friction.slow

        def left(now: SpanInstants) -> Array:
            rates = now.others.joint_rates[own]
            return np.asarray(leaving(rates, slow[own], self.rates.settled[own])[0])

        return left

    def _crank_ways(self) -> Iterator[tuple[str, float, float]]:
        """What is to happen after a way of the crank, rad, from an angle on."""
        on = any(driver.on for driver in self.drivers)
        yield "mark", self._mark_span, self.mark
        if self.limits.turns < inf:
            yield "turns", self.limits.turns * 2 * pi, self.start
        if on and self.limits.off_turns < inf:
            yield "off", self.limits.off_turns * 2 * pi, self.start

    @property
    def _holds_itself(self) -> bool:
        """Whether friction, or a brake, holds a machine at rest."""
        return self.equation.friction is not None or self.drivers[0].holding() > 0

    def _activity(self, now: SpanInstants) -> Array:
        """How far a machine is (K,) from a rest that lasts: speeds and accelerations over usual
        ones, or what a current is still to grow; 1 while a load or a reference changes with time.
        """
        if self.equation.given or (self.corners and self.corners[-1] > now.times[0]):
            return np.ones(len(now.times))
        count = self.rates.count
        slow, even = (NEAR_REST, CREEPING) if self._holds_itself else (AT_REST, AT_REST)
        own = self.equation.sizes()[:, None] * self.usual
        sizes = [*np.abs(now.states[count : 2 * count]) / own * (AT_REST / slow)]
        sizes += [*np.abs(now.rates[count : 2 * count]) / (own * self.usual) * (AT_REST / even)]
        where = self.rates.where(now.times, now.states)
        for k in self.rates.lagging:
            driver = self.drivers[k]
            if driver.lags and driver.circuit is not None:
                lasting = driver.current(where.speeds[k])
                short = np.abs(lasting - self.rates.current(k, now.states, where))
                sizes.append(short * driver.circuit.resistance / driver.circuit.voltage)
        return np.asarray(np.max(sizes, axis=0))

    # -- what happens ------------------------------------------------------------------------------

    def _happens(
        self,
        event: tuple[str, str],
        now: tuple[float, Array, Array],
        at: tuple[TimeSpan, float],
    ) -> tuple[bool, Array]:
        """Change what an event changes; whether the run goes on, and from which state.

        event : its kind and what it is of.  now : time, state and quadratures.
        at : span, and its place where that is.
        """
        (kind, of), (time, state, gained) = event, now
        kind = self._reached(kind, state)
        match kind:
            case "corner":
                self.corners = [corner for corner in self.corners if corner > just_after(time)]
            case "limit":
                self._limited(of, time, state)
            case "settled":
                self._settle(int(of), at)
            case "contact":
                self._touch(of, at)
            case "off":
                state = self._switch_off(time, state, gained)
            case _:
                return self._goes_on(kind, of, time, state), state
        return True, state

    def _goes_on(self, kind: str, of: str, time: float, state: Array) -> bool:
        """Whether the run goes on after a cycle, or what may end it, at a time."""
        if kind in ("mark", "turns") and abs(self._since_mark(time, state)) < AT_EDGE:
            goes_on = self._begin_cycle(time, state)
            if kind == "mark":
                return goes_on
        self._note(self._rest if kind == "rest" else kind, time, state, of)
        return False

    def _reached(self, kind: str, state: Array) -> str:
        """What happens in a state, where several things do so at the same crank angle."""
        if kind != "mark" or not self.equation.by_crank:
            return kind
        ways = ((name, way - abs(state[0] - origin)) for name, way, origin in self._crank_ways())
        return next((name for name, left in ways if name != "mark" and left < AT_EDGE), kind)

    def _limited(self, link: str, time: float, state: Array) -> None:
        """A servo motor comes to its limit of torque, or from it."""
        place = [drive.link for drive in self.equation.drives].index(link)
        where = self.rates.where(np.array([time]), state[:, None])
        each = float(where.speeds[place, 0]), float(where.angles[place, 0])
        self.drivers[place].observe(*each, time, reached=True)

    def _settle(self, joint: int, at: tuple[TimeSpan, float]) -> None:
        """The sense of a joint's motion begins to change, or has changed, at a place of a span."""
        others = self.rates.others(at[0].others(np.array([at[1]])))
        settled = self.rates.settled.copy()
        settled[joint] = 0.0 if settled[joint] else np.sign(others.joint_rates[joint, 0])
        self.rates.settled = settled

    def _touch(self, mount: str, at: tuple[TimeSpan, float]) -> None:
        """A one-sided mount lets go, or touches, at a place of a span, with all that do so then."""
        span, place = at
        now = self._look(span, np.array([place - SHORTLY, place]))
        where, mounts = self.rates.where(now.times, now.states), self.equation.mounts
        for name in mounts.one_sided:
            before, left = mounts.left(name, where.angles, where.speeds)
            if name == mount or (left <= AT_CONTACT and left < before):
                mounts.switch(name)

    def _since_mark(self, time: float, state: Array) -> float:
        """What is left of a cycle, rad."""
        return self._mark_span - abs(self._crank_angle(time, state) - self.mark)

    def _switch_off(self, time: float, state: Array, gained: Array) -> Array:
        """Without motors: what the field of their coils holds turns into heat."""
        self._note("off", time, state)
        state = state.copy()
        for row, k in enumerate(self.rates.lagging, 2 * self.rates.count):
            heat = 2 * self.rates.circuits.index(k) + 1
            gained[heat] += float(self.drivers[k].stored(state[row]))
            state[row] = 0.0
        for driver in self.drivers:
            driver.on = False
        return state

    def _begin_cycle(self, time: float, state: Array) -> bool:
        """Note the begin of a cycle; whether the run goes on, as it does before a steady state."""
        self.marks.append(time)
        self.mark = self._crank_angle(time, state)
        count = self.rates.count
        before, self._at_mark = self._at_mark, state[: 2 * count].copy()
        switched = min(self.limits.off_time, self.limits.off_turns) < inf
        on = any(driver.on for driver in self.drivers)
        if before is None or not self.limits.steady or self.corners or (switched and on):
            return True
        changes = self._at_mark - before
        drives, own = [row for row, _ in self._moved_drives], self.equation.sizes()
        turned = np.abs(changes[:count])
        turned[drives] = np.abs((changes[drives] + pi) % (2 * pi) - pi)
        turned, gained = turned / own, np.abs(changes[count:]) / (own * self.usual)
        if max(*turned, *gained) > STEADY:
            return True
        self._note("steady", time, state)
        return False

    def _note(self, kind: str, time: float, state: Array, of: str = "") -> None:
        self.events.append(DriveEvent(kind, time, self._crank_angle(time, state), of))


def _value(place: int) -> Callable[[SpanInstants], Array]:
    """A value of the state."""
    return lambda now: now.states[place]


def _way_left(way: float, origin: float) -> Callable[[SpanInstants], Array]:
    """What is left of a way of the crank from an angle, rad."""
    return lambda now: way - np.abs(now.states[0] - origin)


def joined(tracks: Sequence[DrivesTrack]) -> DrivesTrack:
    """All parts of a track, one after the other."""

    def whole(parts: Iterable[Array]) -> Array:
        return np.concatenate([*parts], axis=-1)

    return DrivesTrack(
        whole(track.time for track in tracks),
        whole(track.states for track in tracks),
        whole(track.quadratures for track in tracks),
        whole(track.torques for track in tracks),
        whole(track.accelerations for track in tracks),
        {name: whole(track.references[name] for track in tracks) for name in tracks[0].references},
    )
