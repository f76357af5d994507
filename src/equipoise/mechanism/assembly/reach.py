"""Whether a crank can turn fully, how far it can be turned, and what could be done about it.

The linkage is followed from a crank angle at which it can be put together, to either side, until a
dyad is stretched out or folded, or the loop equations of a group have no solution.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from itertools import pairwise
from math import acos, degrees, floor, log10, pi, radians, sin
from typing import Any, Protocol

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.errors import ChangePointError, MotionError, Paste, RangeError, at_place
from equipoise.i18n import Note, all_of, to_say
from equipoise.mechanism.assembly.assembly_modes import key_text
from equipoise.mechanism.assembly.builder import Group
from equipoise.mechanism.assembly.loops import BranchError
from equipoise.mechanism.assembly.steps import (
    State,
    Step,
    initial_state,
    needed_references,
    planar,
    run,
)
from equipoise.mechanism.checks import MODES
from equipoise.mechanism.parts.joint_kinds import BEYOND
from equipoise.mechanism.parts.laws import AngleLaw
from equipoise.mechanism.parts.machine import Machine
from equipoise.quantities import format_quantity
from equipoise.signals import EQUAL, Array, highest_at

MOST_DIPS = 6
"""Lowest dips of a dyad's margin that are looked at between the points of the grid."""
MOST_RANGES = 4
"""Ranges of crank angle that a sentence lists; a cycle of many turns may have hundreds."""
WITHOUT_CURE = Note("{reason}; change a length or direction")
CHANGE_POINT = 1e-10
"""Squared sine of a transmission angle below which a dyad counts as stretched out or folded."""


@dataclass(frozen=True)
class FullTurn:
    """What is known of a cycle while groups are looked at, one after the other.

    theta : grid of crank angles over so many turns, rad.
    reference : values near those at any crank angles, by name.
    done : the groups so far, the one that is looked at among them.
    """

    machine: Machine
    turns: int
    theta: Array
    reference: Callable[[str, Array], Array]
    done: Sequence[Group]

    def check(self, group: Group, margin: Array) -> None:
        """Check that the margin of a group stays above zero.

        margin : at the crank angles of the grid (N,); -inf where the group cannot be closed.

        Raises
        ------
        RangeError, ChangePointError : it does not.
        """
        least = np.min(margin)
        # Between two points a margin dips by an eighth of its second difference, so it is followed
        # closely only where it comes near zero.  One with peaks between them shows no such thing.
        dip = 1.0 if group.peaked else np.max(np.abs(np.diff(margin, 2)))
        if least > CHANGE_POINT and least > dip:
            return
        smallest, at = self.smallest(group, margin)
        names = all_of([repr(link) for link in group.links])
        if smallest < -CHANGE_POINT:
            raise self.range_error(group, margin, at, names)
        if smallest < CHANGE_POINT and not group.through:
            reason = (jam if group.jams else bifurcation)(at, group.dead)
            message = Note(WITHOUT_CURE, reason=reason)
            joint = group.joint if group.equal else ""
            raise ChangePointError(message, at, joint, reason=reason)

    def smallest(self, group: Group, margin: Array) -> tuple[float, float]:
        """Smallest value of a dyad's margin between the points of the grid, and its angle."""
        inner = margin[1:-1]
        dips = 1 + np.flatnonzero((inner <= margin[:-2]) & (inner <= margin[2:]))
        ends = [0] if margin[0] <= margin[1] else []
        least = float(np.min(margin))
        lowest = sorted([*ends, *dips], key=lambda k: max(margin[k], least + EQUAL))[:MOST_DIPS]
        pairs = self.zoom(group, self.theta[lowest]) if lowest else []
        pairs.append((float(self.theta[highest_at(-margin)]), least))
        angles, values = np.array(sorted(pairs)).T
        k = highest_at(-values, smooth=False)
        return float(np.min(values)), float(angles[k])

    def zoom(self, group: Group, angles: Array) -> list[tuple[float, float]]:
        """Close in on dips of a dyad's margin, near crank angles (D,): the angle and the value."""
        values, width = angles, self.theta[1]
        for _ in range(4):
            samples = angles[:, None] + np.linspace(-width, width, 41)
            result = self.margin(group, samples.ravel()).reshape(samples.shape)
            best = np.arange(len(samples)), np.argmin(result, axis=1)
            angles, values, width = samples[best], result[best], width / 18
        return [*zip(angles.tolist(), values.tolist(), strict=True)]

    def margin(self, group: Group, theta: Array) -> Array:
        """A dyad's margin at any crank angles."""
        assert group.margin is not None
        return np.broadcast_to(self.state(theta)[group.margin], theta.shape)

    def state(self, theta: Array) -> State:
        """What is known at any crank angles of the groups so far."""
        state = initial_state(self.machine, theta)
        for earlier in self.done:
            for name in needed_references(earlier.motion):
                state[f"reference({name})"] = self.reference(name, theta)
        with np.errstate(all="ignore"):
            for earlier in self.done:
                run(earlier.motion, state)
        return state

    def range_error(self, group: Group, margin: Array, dip: float, names: Note | str) -> RangeError:
        """Error on the crank angles, rad, between which a dyad closes; it does not at `dip`."""
        if not np.any(margin > 0):
            note = self.never_joined(group, names)
            return RangeError(note.about("links-cannot-be-joined-at-any-crank-angle"))
        period = 2 * pi * self.turns
        theta, where = np.unique([*self.theta[:-1], dip % period], return_index=True)
        good = np.append(margin[:-1] > 0, False)[where]
        before = np.roll(theta, 1)
        before[0] -= period
        rising = np.flatnonzero(good & ~np.roll(good, 1))
        falling = np.flatnonzero(~good & np.roll(good, 1))
        starts = [self.crossing(group, before[k], theta[k]) for k in rising]
        stops = [self.crossing(group, before[k], theta[k]) for k in falling]
        ranges = []
        for begin in starts:
            later = [stop for stop in stops if stop > begin]
            ranges.append((begin, min(later)) if later else (begin - period, min(stops)))
        if not self.machine.crank_turns:
            return RangeError(self.beyond(dip, names), tuple(ranges))
        between = _only_between(ranges, names)
        return RangeError(between, tuple(ranges), lengths=self.lengths(group))

    def never_joined(self, group: Group, names: Note | str) -> Note:
        """Note that a dyad closes at no crank angle, and on the lengths with which it would."""
        lengths = self.lengths(group)
        if lengths is None:
            return Note(
                "{names} cannot be joined at any crank angle; check their lengths and "
                "where their pins are",
                names=names,
            )
        return Note(
            "{names} cannot be joined at any crank angle: {lengths}", names=names, lengths=lengths
        )

    def lengths(self, group: Group) -> Note | None:
        """Note on the distance of a dyad's outer pins over the cycle and on the permitted distance;
        None of a dyad with another joint than pins.
        """
        if [reaction.kind for reaction in group.reactions] != ["pin"] * 3:
            return None
        spans = [*self._spans(group)]
        if len(spans) != 2:  # where one of the links is none of the file
            return None
        (item, first, own), (other, second, its) = spans
        state = self.state(self.theta)
        apart = np.abs(state[f"p({first})"] - state[f"p({second})"])
        return Note(
            "{first} and {second} are {least} to {most} apart; "
            "with {own} from {first} to {joint} in links.{one}.points and "
            "{its} from {second} to {joint} in links.{other}.points they have to be "
            "{low} to {high} apart",
            first=first,
            second=second,
            joint=group.reactions[-1].at,
            one=key_text(item),
            other=key_text(other),
            least=_length(float(np.min(apart))),
            most=_length(float(np.max(apart))),
            own=_length(own),
            its=_length(its),
            low=_length(abs(own - its)),
            high=_length(own + its),
        )

    def _spans(self, group: Group) -> Iterator[tuple[str, str, float]]:
        """Of each link of a dyad of pins its name, its outer pin, and the length from that to the
        inner one, m.
        """
        *outer, inner = group.reactions
        for pin in outer:
            link = next((body for body in (pin.on, pin.by) if body in group.links), "")
            points = self.machine.points_of(link) if link in self.machine.links else {}
            if {pin.at, inner.at} <= points.keys():  # as of no rider in a slot
                length = abs(planar(points[inner.at]) - planar(points[pin.at]))
                yield link, pin.at, float(length)

    def beyond(self, dip: float, names: Note | str) -> Note:
        """Note that the drive's prescribed motion reaches angles where a dyad cannot close."""
        link = self.machine.drive.link
        moved, *_ = self.machine.moved(np.array([dip]))[link]
        return Note(
            "{names} do not reach each other with {link!r} at {angle}, to which it is moved at "
            "crank angle {at}; let it move less",
            names=names,
            link=link,
            angle=_in_degrees(float(np.ravel(moved)[0])),
            at=_in_degrees(dip),
        )

    def crossing(self, group: Group, low: float, high: float) -> float:
        """Crank angle between two others at which a dyad's margin passes zero."""
        for _ in range(5):
            samples = np.linspace(low, high, 41)
            sign = self.margin(group, samples) > 0
            k = int(np.argmax(sign != sign[0]))
            if k == 0:
                break
            low, high = float(samples[k - 1]), float(samples[k])
        return 0.5 * (low + high)


def _only_between(ranges: Sequence[tuple[float, float]], names: Note | str) -> Note:
    """Note on the ranges of crank angle, rad, in which a dyad closes; of many, on the first."""
    sentence = all_of(
        [
            Note("from {low} to {high}", low=_in_degrees(a), high=_in_degrees(b))
            for a, b in ranges[:MOST_RANGES]
        ]
    )
    if len(ranges) > MOST_RANGES:
        return Note(
            "the crank cannot turn fully: {names} reach each other only in {count} ranges of "
            "crank angle, the first {ranges}",
            names=names,
            count=len(ranges),
            ranges=sentence,
        )
    return Note(
        "the crank cannot turn fully: {names} reach each other only {ranges} of crank angle",
        names=names,
        ranges=sentence,
    )


def bifurcation(angle: float, dead: Note | str) -> Note:
    """Say at which crank angle, rad, a linkage can go on in two ways, and what it does there."""
    return Note(
        "change point at crank angle {angle}, a bifurcation: {dead} there, and the assembly mode "
        "after it is undetermined",
        angle=_in_degrees(angle),
        dead=dead,
    )


def jam(angle: float, dead: Note | str) -> Note:
    """Say at which crank angle, rad, a linkage comes to no place, and what it does there."""
    return Note(
        "the crank cannot turn fully: it jams at crank angle {angle}, where {dead}",
        angle=_in_degrees(angle),
        dead=dead,
    )


def _length(size: float) -> str:
    """A length, m, as readers see it; 99.99999999999999 mm, which is rounding, as 100.0 mm."""
    return format_quantity(float(f"{size:.9g}"), "length")


def _in_degrees(angle: float) -> str:
    return f"{degrees(angle):.2f} deg"


POINTS = 360
"""Crank angles in a turn at which the linkage is looked at."""
LEAST = 1e-4
"""rad: shortest swing; its ends are hardly distinct in a file."""
FINER, ROUNDS = 16, 6
"""Into how many parts the step is parted in which an end lies, and how often."""
LOOP_ROUNDS = 3
"""The same where Newton's method takes each step: to 1/4000 of a degree."""
STEPS_BEFORE_END, THINNER = 10, 4
"""Steps before an end, all of which are taken again, and one of so many before them."""


class Assembled(Protocol):
    """A machine in the order in which it is computed, as far as it is asked here."""

    @property
    def machine(self) -> Machine: ...
    @property
    def groups(self) -> Sequence[Group]: ...
    @property
    def motion(self) -> Sequence[Step]: ...
    @property
    def needed_references(self) -> list[str]: ...
    def close(self) -> Any: ...
    def start(self, theta: Array) -> State: ...


@dataclass(frozen=True)
class Reach:
    """The crank angles between which a crank can swing.

    low, high : rad, from less than a turn below 0 to more than 0.
    stops : what the links do at either end that keeps the crank from going on.
    others : how many more such ranges there are; in these other poses begin.
    """

    low: float
    high: float
    stops: tuple[Note | str, Note | str]
    others: int = 0

    @property
    def is_point(self) -> bool:
        """Whether it is too small for a motion."""
        return self.high - self.low < LEAST

    @property
    def note(self) -> Note:
        """The range and what ends it."""
        low, high, (first, second) = _in_degrees(self.low), _in_degrees(self.high), self.stops
        if str(first) == str(second):
            text = Note(
                "the crank cannot turn fully: it stops at {low} and at {high}, where {first}",
                low=low,
                high=high,
                first=first,
            )
        else:
            text = Note(
                "the crank cannot turn fully: it stops at {low} ({first}) and at {high} ({second})",
                low=low,
                high=high,
                first=first,
                second=second,
            )
        return Note("{reason}; there are other such ranges", reason=text) if self.others else text


def reach(linkage: Assembled) -> Reach | None:
    """The range of a crank that cannot turn fully; None where it can.

    It is that in which crank angle 0 lies, or else the nearest to that.

    Raises
    ------
    RangeError : the linkage cannot be put together at any crank angle, or has couplings and cannot
        at crank angle 0, where these start.
    MotionError : its motion does not repeat.
    """
    try:
        linkage.close()
    except (RangeError, ChangePointError, BranchError) as error:
        return range_of(linkage, error)
    return None


def range_of(linkage: Assembled, stuck: MotionError) -> Reach:
    """The range of a crank whose turn ends with an error.

    Raises
    ------
    MotionError : `stuck`, where there is no such range.
    """
    start, others = _start(linkage, stuck)
    gaps = np.array([*_gaps(stuck)])
    low, first = _end(linkage, start, -1, gaps)
    high, second = _end(linkage, start, 1, gaps)
    if max(start - low, high - start) >= 2 * pi:  # on other branches, which a turn leads to
        raise stuck
    return Reach(low, high, (first, second), others)


def _gaps(stuck: MotionError) -> Iterator[float]:
    """Crank angles that cannot be passed, which may lie between two that are looked at."""
    if isinstance(stuck, ChangePointError):
        yield stuck.crank_angle
    for (_, end), (begin, _) in pairwise(_in_turn(stuck)):
        yield 0.5 * (end + begin)


def _in_turn(stuck: MotionError) -> list[tuple[float, float]]:
    """Ranges in which a crank can be, in order, and the first one a turn later."""
    ranges = sorted(stuck.ranges) if isinstance(stuck, RangeError) else []
    return [*ranges, *((low + 2 * pi, high + 2 * pi) for low, high in ranges[:1])]


def has_loops(linkage: Assembled) -> bool:
    """Whether a group is solved by its loop equations, from one crank angle to the next."""
    return any(group.kind == "loops" for group in linkage.groups)


def _start(linkage: Assembled, stuck: MotionError) -> tuple[float, int]:
    """A crank angle of the range, and how many other ranges there are."""
    if has_loops(linkage):
        return 0.0, 0
    theta = np.linspace(0.0, 2 * pi, POINTS, endpoint=False)
    good = _closed(linkage, theta)
    begins = int(np.sum(good & ~np.roll(good, 1)))
    if good[0]:
        return 0.0, max(begins - 1, 0)  # none begins where only narrow gaps are between
    if not begins or linkage.needed_references:
        raise stuck
    apart = np.round(np.minimum(theta, 2 * pi - theta)[good], 9)
    nearest = float(theta[good][np.argmin(apart)])
    return (nearest if nearest <= pi else nearest - 2 * pi), begins - 1


def _closed(linkage: Assembled, theta: Array) -> Array:
    """At which crank angles (N,) all dyads can be closed."""
    dyads = [item for item in linkage.groups if item.margin is not None]
    pairs = zip(margins_at(linkage, theta, through=True), dyads, strict=True)
    good = [margin > _least(group) for margin, group in pairs]
    return np.all(good, axis=0) if good else np.ones(theta.shape, bool)


def margins_at(linkage: Assembled, theta: Array, through: bool = False) -> list[Array]:
    """Squared sines (N,) of the transmission angle of each dyad at crank angles (N,), rad.

    through : with those that are carried through their dead positions by other joints.
    """
    with np.errstate(all="ignore"):
        state = run(linkage.motion, linkage.start(theta))
    return [
        np.broadcast_to(state[item.margin], theta.shape)
        for item in linkage.groups
        if item.margin is not None and (through or not item.through)
    ]


def _least(group: Group) -> float:
    """Margin that a dyad has to stay above; one that goes on through change points comes to 0."""
    return -CHANGE_POINT if group.through else CHANGE_POINT


def _end(linkage: Assembled, start: float, side: int, gaps: Array) -> tuple[float, Note | str]:
    """The crank angle up to which the linkage follows from a start, and what it does there."""
    steps = np.append(np.linspace(0.0, 2 * pi, POINTS + 1), side * (gaps - start) % (2 * pi))
    way = start + side * np.unique(steps)
    good = _followed(linkage, way)
    if good == len(way):
        return float(way[-1]), ""
    thinned = np.append(way[:good][:-STEPS_BEFORE_END:THINNER], way[:good][-STEPS_BEFORE_END:])
    way, good = np.append(thinned, way[good]), len(thinned)
    for _ in range(LOOP_ROUNDS if has_loops(linkage) else ROUNDS):
        last = way[good - 1]
        way = np.append(way[: good - 1], np.linspace(last, way[good], FINER + 1))
        good = _followed(linkage, way)
        if good == len(way):  # it is reached by smaller steps
            break
    return float(way[good - 1]), _stop(linkage, way[: good + 1])


def _followed(linkage: Assembled, way: Array) -> int:
    """How many of the crank angles (N,) can be reached, one after the other."""
    count = _solvable(linkage, way) if has_loops(linkage) else len(way)
    bad = np.flatnonzero(~_closed(linkage, way[:count]))
    return max(int(bad[0]), 1) if len(bad) else count


def _solvable(linkage: Assembled, way: Array) -> int:
    """How many of the crank angles (N,) groups of loops can reach."""
    count = len(way)
    while count > 1:
        try:
            _closed(linkage, way[:count])
            break
        except BranchError as error:
            failed = int(np.argmin(np.abs(way[:count] - error.crank_angle)))
            count = max(min(failed, count - 1), 1)
    return count


def _stop(linkage: Assembled, way: Array) -> Note | str:
    """What keeps the crank from the last of some crank angles (N,)."""
    group = _stopping(linkage, way)
    if group.margin is not None:
        return group.dead
    links = [repr(link) for link in group.links]
    return Note("{links} can be moved no further", links=all_of(links))


def _stopping(linkage: Assembled, way: Array) -> Group:
    """The first group that cannot be had there; the last where rounding lets all be."""
    state = linkage.start(way)
    for group in linkage.groups:
        try:
            with np.errstate(all="ignore"):
                run(group.motion, state)
        except MotionError:
            return group
        if group.margin is not None and not np.ravel(state[group.margin])[-1] > _least(group):
            return group
    return linkage.groups[-1]


TRANSMISSION, LEAST_SHARE = radians(40), 1 / 3
"""Smallest transmission angle of a dyad in a swing, as in Norton, Design of Machinery, 4.10, rad;
and the share of the range that has to be left for that."""
AWAY, SHORT = 0.1, 0.02
"""Of the range, that a crank stays away from both ends where transmission angles leave too little;
and where rough positions or starts of couplings lie in that, too."""
LOOKED_AT = 720
"""Crank angles of the range at which transmission angles are looked at."""
DIGITS = 3
"""Of the range, to which the ends of a swing are rounded."""

WITH_CURE = to_say("{reason}; {cure}")
LEADING = to_say("{sentence}; the motion below {room}")
KEEPS_ANGLES = Note(
    "keeps transmission angles of {least:.4g} deg and more", least=degrees(TRANSMISSION)
)
KEEPS_AWAY = Note("stays a tenth of the range away from both ends, near which forces grow without "
                  "bound")  # fmt: skip
KEEPS_SHORT = Note("stays 2 % of the range away from both ends, near which forces grow without "
                   "bound")  # fmt: skip
SWING = Note("change a length or direction, or let it swing by a motion in [drive]")
SWING_ALONE = Note("change a length or direction, or let it swing by a motion in [drive], without "
                   "motor and flywheel")  # fmt: skip
MODE_OR_SWING = Note(
    "say in [assembly] whether opposite links stay parallel or cross, or let the crank swing by a "
    "motion in [drive]"
)


def with_cures(linkage: Assembled, error: MotionError) -> MotionError:
    """An error that ends a crank's turn, with where the crank stops and lines for the file.

    The error itself where a drive has a motion already, or the crank can be nowhere.
    """
    machine = linkage.machine
    if not machine.has_crank or (isinstance(error, BranchError) and error.rider):
        return _in_its_slot(machine, error)
    try:
        reach = range_of(linkage, error)
    except MotionError:
        return error
    if reach.is_point:
        return error
    swing = swing_within(linkage, reach)
    motion = motion_line(swing.law)
    cure: Note = SWING_ALONE if machine.drive.motor or machine.drive.flywheel else SWING
    if not isinstance(error, ChangePointError):
        message = Note(WITH_CURE, reason=reach.note, cure=cure)
        if isinstance(error, RangeError):
            if error.lengths is not None:
                lengths = Note(WITH_CURE, reason=reach.note, cure=error.lengths)
                message = Note(WITH_CURE, reason=lengths, cure=cure)
            stuck: MotionError = RangeError(message, error.ranges, reason=reach.note)
        else:
            stuck = type(error)(message, reason=reach.note)
        return stuck.with_paste(_paste([motion], swing))
    lines: list[Note | str] = [motion]
    if error.joint:
        cure = MODE_OR_SWING
        entry = key_text(error.joint)
        given = machine.assembly.get(error.joint, "")
        instead = Note('in [assembly], instead of "{given}"', given=given)
        lines = [
            Note("{entry}  # {remark}", entry=f'{entry} = "{MODES[0]}"', remark=instead),
            Note("# or {entry}", entry=f'{entry} = "{MODES[1]}"'),
            Note("# or, in [drive]: {entry}", entry=motion),
        ]
    message = Note(WITH_CURE, reason=error.reason, cure=cure)
    stuck = ChangePointError(message, error.crank_angle, error.joint, reason=error.reason)
    return stuck.with_paste(_paste(lines, swing))


def _in_its_slot(machine: Machine, error: MotionError) -> MotionError:
    """The error, which names the slot whose end a pin has reached, if that is what it is about."""
    if not isinstance(error, BranchError) or not error.rider:
        return error
    slot = machine.pins_in_slots[error.rider]
    place = next(f"{table}[{k + 1}]" for table, k, item in machine.elements if item is slot)
    return BranchError(at_place(place, Note(BEYOND, crank_angle=degrees(error.crank_angle))))


def _paste(lines: Sequence[Note | str], swing: SwingWithin) -> Paste:
    return Paste(tuple(lines), LEADING, {"room": swing.room})


@dataclass(frozen=True)
class SwingWithin:
    """A motion by which a crank swings within what it can reach.

    law : a sine.  room : what its ends keep.
    """

    law: AngleLaw
    room: Note


def swing_within(linkage: Assembled, reach: Reach) -> SwingWithin:
    """A sine within what a crank can reach, with ends that a file can hold.

    Its ends keep transmission angles that a designer would take, where these leave enough of the
    range.  Where a rough position or starts of couplings say how the machine is at a crank angle,
    the crank is there at that angle as before.
    """
    machine, span = linkage.machine, reach.high - reach.low
    digits = max(0, DIGITS - floor(log10(degrees(span))))
    at = None
    if machine.couplings or machine.position is not None:
        at = 0.0 if machine.position is None else degrees(machine.position.crank_angle)
    choices = [(reach.low + share * span, reach.high - share * span, room)
               for share, room in ((AWAY, KEEPS_AWAY), (SHORT, KEEPS_SHORT))]  # fmt: skip
    if (good := _well_transmitted(linkage, *choices[0][:2])) is not None:
        choices.insert(0, (*good, KEEPS_ANGLES))
    ends = [(round(degrees(low), digits), round(degrees(high), digits), room)
            for low, high, room in choices]  # fmt: skip
    holding = (end for end in ends if at is not None and end[0] < at < end[1])
    low, high, room = next(holding, ends[0])
    phase = 0.0
    if at is not None and low < at < high:
        phase = at - degrees(acos((low + high - 2 * at) / (high - low)))
    return SwingWithin(AngleLaw(between=(radians(low), radians(high)), phase=radians(phase)), room)


def _well_transmitted(linkage: Assembled, low: float, high: float) -> tuple[float, float] | None:
    """The longest part of a range, rad, in which all transmission angles are large enough; None
    where it is too short, or groups of loops have none.
    """
    if has_loops(linkage):
        return None
    theta = np.linspace(low, high, LOOKED_AT + 1)
    good = np.all([margin >= sin(TRANSMISSION) ** 2 for margin in margins_at(linkage, theta)],
                  axis=0)  # fmt: skip
    edges = np.flatnonzero(
        np.diff(np.concatenate([[False], np.broadcast_to(good, theta.shape), [False]]))
    )
    begins, ends = edges[::2], edges[1::2] - 1
    if not len(begins):
        return None
    k = int(np.argmax(ends - begins))
    if theta[ends[k]] - theta[begins[k]] < LEAST_SHARE * (high - low):
        return None
    return float(theta[begins[k]]), float(theta[ends[k]])


def motion_line(law: AngleLaw) -> str:
    """A law that swings, as a key of the drive in a file."""
    assert law.between is not None
    ends = ", ".join(f'"{_clean(end)} deg"' for end in law.between)
    phase = f', phase = "{_clean(law.phase)} deg"' if law.phase else ""
    return f"motion = {{ between = [{ends}]{phase} }}"


def _clean(angle: float) -> str:
    return f"{degrees(angle):.9g}"
