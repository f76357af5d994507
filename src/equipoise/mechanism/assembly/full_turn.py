"""Whether a crank can turn fully: the margins of dyads, which must stay above zero over a cycle."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from math import degrees, pi
from typing import Any

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.errors import ChangePointError, RangeError
from equipoise.i18n import Note, all_of
from equipoise.mechanism.assembly.builder import Group
from equipoise.mechanism.assembly.sides import key_text
from equipoise.mechanism.assembly.steps import (
    Array,
    State,
    initial_state,
    needed_references,
    planar,
    run,
)
from equipoise.mechanism.parts.machine import Machine
from equipoise.quantities import told
from equipoise.signals import EQUAL, highest_at

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

    def weakest(self, group: Group, margin: Any) -> tuple[float, float]:
        """Smallest margin of a group, and its crank angle, where that stays above zero.

        margin : at the crank angles of the grid.

        Raises
        ------
        RangeError, ChangePointError : it does not.
        """
        margin = np.broadcast_to(margin, self.theta.shape)
        margin = np.where(np.isfinite(margin), margin, -np.inf)
        smallest, at = self.smallest(group, margin)
        names = all_of([repr(link) for link in group.links])
        if smallest < -CHANGE_POINT:
            raise self.range_error(group, margin, at, names)
        if smallest < CHANGE_POINT and not group.through:
            reason = (jam if group.jams else bifurcation)(at, group.dead)
            message = Note(WITHOUT_CURE, reason=reason)
            joint = group.joint if group.equal else ""
            raise ChangePointError(message, at, joint, reason=reason)
        return smallest, at

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
        """Tell between which crank angles a dyad can be closed; not at the angle `dip`."""
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
        """Tell that a dyad can be closed at no crank angle, and which lengths would do."""
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
        """Tell how far apart the outer pins of a dyad are as the crank turns, and how far they may
        be; None of a dyad with another joint than pins.
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
        """Tell that the drive's own motion leads where a dyad cannot be closed."""
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
    """Tell between which crank angles, rad, a dyad can be closed; the first of many."""
    sentence = all_of(
        [
            Note("from {low} to {high}", low=_in_degrees(a), high=_in_degrees(b))
            for a, b in ranges[:MOST_RANGES]
        ]
    )
    if len(ranges) > MOST_RANGES:
        return Note(
            "the crank cannot turn fully: {names} reach each other only in {count} ranges of "
            "crank angle, the first {told}",
            names=names,
            count=len(ranges),
            told=sentence,
        )
    return Note(
        "the crank cannot turn fully: {names} reach each other only {told} of crank angle",
        names=names,
        told=sentence,
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
    return told(float(f"{size:.9g}"), "length")


def _in_degrees(angle: float) -> str:
    return f"{degrees(angle):.2f} deg"
