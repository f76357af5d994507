"""Drives that push: a cylinder between two points, or a driven sliding joint.

The stroke is commanded, a length over the crank angle.  One link that turns about a point of the
frame determines the pose of the machine, so that everything else is computed as if that link were
driven: its angle is the one at which the length is as commanded, found by Newton's method on the
length, of which the linkage gives both derivatives.

Beside other drives the angles of all links that are pushed are those at which all lengths are as
commanded, by Newton's method, followed from where they start.  Their derivatives follow from those
of the lengths, each of which the linkage gives at any rates of these links.

See `docs/theory.md`, "Drives that push".
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from itertools import pairwise
from math import ceil, degrees, pi
from typing import Any

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.errors import ModelError
from equipoise.i18n import Note, all_of
from equipoise.mechanism.assembly.linkage import Linkage, assemble
from equipoise.mechanism.assembly.reach import reach
from equipoise.mechanism.assembly.steps import run, u
from equipoise.mechanism.formulas.rolling import Levels
from equipoise.mechanism.kinematics.motion import Motion, PlacedBodies, slider_of
from equipoise.mechanism.kinematics.swinging import Followed
from equipoise.mechanism.parts.drives import Drive, FurtherDrive
from equipoise.mechanism.parts.element_kinds import Placed
from equipoise.mechanism.parts.laws import LengthLaw
from equipoise.mechanism.parts.machine import Machine
from equipoise.quantities import angle, format_exact
from equipoise.signals import Array


def ends_of(machine: Machine, drive: Drive | FurtherDrive) -> tuple[str, str]:
    """The bodies that a drive pushes apart."""
    if drive.slider:
        slider = slider_of(machine, drive)
        return slider.on, slider.link
    return drive.ends(machine.bodies)


def pushes(motion: Motion, drive: Drive | FurtherDrive) -> list[tuple[str, Array, Array]]:
    """Bodies that a force of 1 N of a drive acts on, with its place (N,) and direction (N,)."""
    direction = slider_of(motion.machine, drive).direction if drive.slider else 0.0
    return push_lines(motion.machine, drive, PlacedBodies(motion, ""), direction)


def push_lines(
    machine: Machine, drive: Drive | FurtherDrive, at: Placed, direction: Any
) -> list[tuple[str, Any, Any]]:
    """Bodies that a force of 1 N of a drive acts on, with its place and direction, as arrays or
    terms.

    direction : of a sliding joint that is driven, in the axes of the body that it is on, rad.
    """
    if drive.slider:
        slider = slider_of(machine, drive)
        place = at.point(slider.link, slider.point)
        way = at.turned(slider.on, direction) + 0 * place
        return [(slider.link, place, way), (slider.on, place, -way)]
    ends = drive.ends(machine.bodies)
    a, b = (at.point(*end) for end in zip(ends, drive.between or (), strict=True))
    way = (b - a) * (1 / abs(b - a))
    return [(ends[1], b, way), (ends[0], a, -way)]


STEP = pi / 360
"""rad: between angles of the link at which the length is looked at."""
INSIDE = 1e-7
"""rad: how far from where a dyad is stretched out."""
ITERATIONS, SETTLED = 60, 1e-15
"""Of Newton's method; the last change in the angle, rad."""
SQUARED = 1e-9
"""rad: a change of Newton's method after which only rounding is left, as errors square."""
HALVINGS = 36
"""Of the step in which a dead point lies."""
AGREES = 1e-9
"""Of the length: what rounding may miss."""
DEAD = 1e-9
"""Of the length's range: how near to its end the stroke may come."""


@dataclass(frozen=True)
class CrankOffset:
    """A crank that stands at another angle than 0 at crank angle 0."""

    link: str
    by: float

    def moved(self, crank_angle: Any) -> dict[str, tuple[Any, Any, Any]]:
        """Angle of the link and its two derivatives."""
        theta = np.asarray(crank_angle)
        return {self.link: (theta + self.by, np.ones(theta.shape), np.zeros(theta.shape))}


@dataclass(frozen=True, eq=False)
class Branch:
    """Angles of the link (K,) over which the length (K,) rises or falls all the way."""

    angles: Array
    lengths: Array

    @property
    def low(self) -> float:
        return float(np.min(self.lengths))

    @property
    def high(self) -> float:
        return float(np.max(self.lengths))

    @property
    def ends(self) -> tuple[float, float]:
        return float(self.angles[0]), float(self.angles[-1])

    def holds(self, low: float, high: float) -> bool:
        """Whether it has all lengths between two."""
        room = DEAD * (self.high - self.low)
        return self.low + room < low and high < self.high - room


@dataclass(frozen=True, eq=False)
class StrokeInverse:
    """Angle of the drive's link, rad, that follows from the stroke."""

    bare: Followed
    drive: Drive
    law: LengthLaw
    shift: float
    branch: Branch

    def value(self, crank_angle: Any) -> tuple[Array, Array, Array]:
        """The angle and its two derivatives by crank angle, at crank angles (...)."""
        theta = np.asarray(crank_angle, dtype=float)
        length, first, second = (np.ravel(part) for part in self.law.value(theta))
        at = self._inverse(length)
        _, slope, bend = self._lengths(at)
        w = first / slope
        parts = at + self.shift, w, (second - bend * w * w) / slope
        return tuple(part.reshape(theta.shape) for part in parts)  # type: ignore[return-value]

    def moved(self, crank_angle: Any) -> dict[str, tuple[Array, Array, Array]]:
        """Angle and rates of the driven link, by its name."""
        return {self.drive.link: self.value(crank_angle)}

    @property
    def windings(self) -> int:
        """Whole turns of the link in a cycle."""
        return 0

    def _lengths(self, at: Array) -> Levels:
        return _lengths(self.bare, at, self.drive)

    def _inverse(self, length: Array) -> Array:
        """Angles (N,) at which the length is as commanded: Newton's method between bounds."""
        angles, known = self.branch.angles, self.branch.lengths
        rising = known[-1] > known[0]
        order = slice(None) if rising else slice(None, None, -1)
        place = np.clip(np.searchsorted(known[order], length), 1, len(known) - 1)
        place = place if rising else len(known) - place
        low, high = angles[place - 1], angles[place]
        share = (length - known[place - 1]) / (known[place] - known[place - 1])
        at = low + np.clip(share, 0.0, 1.0) * (high - low)
        for _ in range(ITERATIONS):
            here, slope, _ = self._lengths(at)
            over = (here > length) == rising
            low, high = np.where(over, low, at), np.where(over, at, high)
            with np.errstate(all="ignore"):
                new = at - (here - length) / slope
            new = np.where((new >= low) & (new <= high), new, 0.5 * (low + high))
            change, at = np.max(np.abs(new - at), initial=0.0), new
            if change <= SQUARED:
                break
        return np.asarray(at)


def commanded_link(machine: Machine) -> StrokeInverse:
    """The angle of the drive's link that follows from its stroke.

    Raises
    ------
    ModelError : the stroke cannot be had, or in several ways of which none is chosen.
    MobilityError, MotionError : the linkage cannot be moved at all.
    """
    shift = _shift(machine)
    result = _commanded(machine, shift)
    if not machine.couplings:
        return result
    return _commanded(machine, _meshing(machine, float(result.value(0.0)[0])))


def _meshing(machine: Machine, guess: float) -> float:
    """Angle of the link at crank angle 0, where couplings are as they start: by secants."""
    drive, law = machine.drive, machine.drive.stroke
    assert law is not None
    wanted = float(law.value(0.0)[0])

    def over(shift: float) -> float:
        linkage = assemble(_turned(machine, shift))
        at = Followed.over(linkage, -STEP, STEP, STEP, ends_of(machine, drive))
        return float(_lengths(at, np.zeros(1), drive)[0][0]) - wanted

    old, new = guess, guess + STEP
    gap, there = over(old), over(new)
    for _ in range(ITERATIONS):
        if abs(gap - there) <= SETTLED * abs(wanted) or abs(new - old) <= SETTLED:
            break
        old, gap, new = new, there, new - there * (new - old) / (there - gap)
        there = over(new)
    if not abs(there) <= AGREES * abs(wanted + there):
        raise ModelError(
            "drive.stroke",
            Note(
                "it is {wanted} at crank angle 0, where couplings as they start make it {there}; "
                "give these another start",
                wanted=_shown(wanted),
                there=_shown(wanted + there),
            ),
        )
    return new


def _shift(machine: Machine) -> float:
    """Angle of the link, rad, from which the linkage is followed."""
    drive, position = machine.drive, machine.position
    if drive.start is not None:
        return drive.start
    if position is None:
        return 0.0
    if drive.link in position.angles:
        return position.angles[drive.link]
    points = machine.links[drive.link].points
    known = {**machine.frame, **position.points}
    ends = [(complex(*points[point]), complex(*known[point])) for point in points if point in known]
    if len(ends) < 2:
        return 0.0
    return float(np.angle((ends[1][1] - ends[0][1]) / (ends[1][0] - ends[0][0])))


def _commanded(machine: Machine, shift: float) -> StrokeInverse:
    drive, law = machine.drive, machine.drive.stroke
    assert law is not None
    bare = _turned(machine, shift)
    linkage = assemble(bare)
    result = reach(linkage)
    low, high = (-pi, pi) if result is None else (result.low + INSIDE, result.high - INSIDE)
    far = high if result is not None else high + 2 * pi  # a turn may begin anywhere
    followed = Followed.over(linkage, low, far, STEP, ends_of(bare, drive))
    branches = _branches(lambda at: _lengths(followed, at, drive), low, high, result is None)
    return StrokeInverse(followed, drive, law, shift, _chosen(drive, law, branches, shift))


def _turned(machine: Machine, shift: float) -> Machine:
    """The machine as if its link were a crank, at an angle `shift` at crank angle 0."""
    drive = Drive(machine.drive.link, machine.drive.speed)
    position = machine.position and replace(machine.position, crank_angle=0.0)
    bare = replace(machine, drive=drive, position=position, loads=(), planting=None, balance=None,
                   support=None, rows=())  # fmt: skip
    return bare.with_turning(CrankOffset(drive.link, shift))


def _lengths(bare: Followed, theta: Array, drive: Drive) -> Levels:
    with np.errstate(all="ignore"):  # other links may be infinitely fast, at ends of the way
        return Motion(bare.linkage, theta, 1.0, 0.0, False, bare.solve(theta)).lengths(drive)


def _branches(
    known: Callable[[Array], Levels], low: float, high: float, whole: bool
) -> list[Branch]:
    """Parts of the way over which the length only rises or only falls.

    known : length and its derivatives at angles (N,).
    whole : whether the way is a turn, so that it may begin at any angle.
    """
    angles = np.linspace(low, high, max(3, round((high - low) / STEP) + 1))
    turns = _dead_points(known, angles)
    if whole and len(turns):
        return _branches(known, float(turns[0]), float(turns[0]) + 2 * pi, whole=False)
    ends = np.unique([low, *turns, high])
    parts = [angles[(angles > end) & (angles < other)] for end, other in pairwise(ends)]
    ways = [
        np.array([end, *part, other])
        for (end, other), part in zip(pairwise(ends), parts, strict=True)
        if len(part)
    ]
    return [Branch(way, known(way)[0]) for way in ways]


def _dead_points(known: Callable[[Array], Levels], angles: Array) -> Array:
    """Angles at which the length turns back, (D,)."""
    _, slope, _ = known(angles)
    left = np.flatnonzero(np.sign(slope[:-1]) != np.sign(slope[1:]))
    low, high = angles[left], angles[left + 1]
    for _ in range(HALVINGS if len(left) else 0):
        middle = 0.5 * (low + high)
        before = np.sign(known(middle)[1]) == np.sign(slope[left])
        low, high = np.where(before, middle, low), np.where(before, high, middle)
    return np.asarray(high)


def _chosen(drive: Drive, law: LengthLaw, branches: Sequence[Branch], shift: float) -> Branch:
    """The branch in which the stroke lies."""
    low, high = law.extremes
    matching_branches = [branch for branch in branches if branch.holds(low, high)]
    at_start = [item for item in matching_branches if _has(item, 0.0)]
    if drive.start is not None and len(matching_branches) > 1:
        matching_branches = at_start or matching_branches
    if len(matching_branches) == 1:
        return matching_branches[0]
    if matching_branches:
        values = [_range_note(item.ends, shift) for item in matching_branches]
        raise ModelError(
            "drive.start",
            Note(
                "the stroke is possible with {link!r} {ranges}; give its approximate angle at "
                "crank angle 0",
                link=drive.link,
                ranges=all_of(values),
            ),
        )
    widest = max(branches, key=lambda branch: branch.high - branch.low, default=None)
    if drive.start is not None:
        widest = next((branch for branch in branches if _has(branch, 0.0)), widest)
    assert widest is not None
    ends = {"low": low, "high": high, "least": widest.low, "most": widest.high}
    size = max(map(abs, ends.values()))  # of which rounding is left where a length is 0
    if drive.between and widest.high - widest.low < AGREES * size:
        raise ModelError(
            "drive.between",
            Note(
                "{a} and {b} are {length} apart wherever {link!r} stands; give points that come "
                "nearer to each other as it turns",
                a=drive.between[0],
                b=drive.between[1],
                length=_shown(widest.low),
                link=drive.link,
            ),
        )
    raise ModelError(
        "drive.stroke",
        Note(
            "it runs from {low} to {high}, and the linkage lets it be between {least} and {most} "
            "only; stay within these, short of the dead points at both ends",
            **{name: _shown(size * round(end / size, 9)) for name, end in ends.items()},
        ),
    )


def _shown(length: float) -> str:
    return format_exact(float(f"{length:.5g}"), "length") if np.isfinite(length) else "none"


def _has(branch: Branch, at: float) -> bool:
    """Whether an angle, or the same some turns on, is in a branch."""
    low, high = branch.ends
    return low <= at + 2 * pi * ceil((low - at) / (2 * pi)) <= high


def _range_note(ends: tuple[float, float], shift: float) -> Note:
    low, high = (angle(end + shift) for end in ends)
    return Note("from {low} to {high}", low=low, high=high)


# -- several drives --------------------------------------------------------------------------------

POINTS = 120
"""Crank angles in a turn from one of which to the next the links are followed."""
NEWTON_ROUNDS, NEWTON_SETTLED = 12, 1e-14
"""Of Newton's method; the last change in an angle, rad."""
FAR = 0.5
"""rad: by which no link moves between two of these crank angles, or from where it starts."""
CLOSED = 1e-9
"""rad: how near a link comes to where it was a cycle before."""
NO_LEVER = 1e-9
"""Smallest lever over the longest, above which strokes are independent."""


FOLLOWED = Note(
    "a stroke beside other drives goes with pins, guides and dyads, and with gears, belts and "
    "racks whose driver and carrier are the frame or links that are driven by their angle; "
    "others, and groups of loops, need one drive to be followed by"
)


@dataclass(frozen=True)
class RestingLinks:
    """Links that stand still at the angles at which they start."""

    at: dict[str, float]

    def moved(self, crank_angle: Any) -> dict[str, tuple[Any, Any, Any]]:
        """Angle of each link and its two derivatives."""
        none = np.zeros(np.shape(crank_angle))
        return {link: (none + at, none, none) for link, at in self.at.items()}


@dataclass(frozen=True, eq=False)
class MultiStrokeInverse:
    """Angles of P links that are pushed.

    linkage : solved where these links are held.  period : of the cycle, rad.
    """

    linkage: Linkage
    pushers: tuple[Drive | FurtherDrive, ...]
    period: float

    def lengths(self, theta: Array, q: Array, rate: Array, bend: Array) -> Array:
        """Lengths and both derivatives by crank angle, (3, P, N).

        q, rate, bend : (P, N), angles of the links and their derivatives by crank angle.
        """
        state = self.linkage.start(theta)
        for item, *rates in zip(self.pushers, q, rate, bend, strict=True):
            turned = np.exp(1j * rates[0]), rates[1], rates[2]
            state.update(zip(u(item.link), turned, strict=True))
            state[f"phi({item.link})"] = rates[0]
        with np.errstate(all="ignore"):
            motion = Motion(self.linkage, theta, 1.0, 0.0, False, run(self.linkage.motion, state))
            values = np.array([motion.lengths(pusher) for pusher in self.pushers])
        return np.swapaxes(values, 0, 1)

    def levers(self, theta: Array, q: Array) -> tuple[Array, Array, Array]:
        """Lengths (P, N), what the other drives add to their rates, and levers (N, P, P): the
        lengths' derivatives by the links' angles.
        """
        many, count = len(self.pushers), len(theta)
        rates = np.zeros((many, many + 1, count))
        rates[range(many), range(1, many + 1)] = 1.0
        again = np.tile(theta, many + 1), np.tile(q, many + 1)
        lengths = self.lengths(*again, rates.reshape(many, -1), np.zeros((many, again[0].size)))
        value, first, _ = lengths.reshape(3, many, many + 1, count)
        levers = np.moveaxis(first[:, 1:] - first[:, :1], -1, 0)
        return value[:, 0], first[:, 0], levers

    def commanded(self, theta: Array) -> Array:
        """What strokes command, with derivatives, (3, P, N)."""
        laws = [pusher.stroke.value(theta) for pusher in self.pushers if pusher.stroke is not None]
        return np.swapaxes(np.array(laws), 0, 1)

    def newton_angles(self, theta: Array, q: Array) -> tuple[Array, Array]:
        """Angles (P, N) of lengths as commanded, near others, and the last change (N,)."""
        wanted = self.commanded(theta)[0]
        for _ in range(NEWTON_ROUNDS):
            value, _, levers = self.levers(theta, q)
            change = _solved(levers, wanted - value)
            q = q + change
            if not np.max(np.abs(change)) > NEWTON_SETTLED * (1 + np.max(np.abs(q))):
                break
        return q, np.max(np.abs(change), axis=0)

    def rates(self, theta: Array, q: Array) -> tuple[Array, Array]:
        """Both derivatives of these angles by crank angle, (P, N)."""
        _, first, second = self.commanded(theta)
        _, by_others, levers = self.levers(theta, q)
        rate = _solved(levers, first - by_others)
        bent = self.lengths(theta, q, rate, np.zeros(q.shape))[2]
        return rate, _solved(levers, second - bent)


def _solved(levers: Array, right: Array) -> Array:
    """Solve for (P, N), NaN where no lever is."""
    size = np.max(np.abs(levers), axis=(1, 2))
    flat = ~(np.abs(np.linalg.det(levers)) > NO_LEVER * size ** len(right))
    levers = np.where(flat[:, None, None], np.eye(len(right)), levers)
    result = np.linalg.solve(levers, right.T[..., None])[..., 0].T
    return np.where(flat, np.nan, result)


@dataclass(frozen=True, eq=False)
class FollowedLinks:
    """The links followed over a cycle.

    theta : (K,) crank angles, rad.  q, rate : (P, K).
    """

    of: MultiStrokeInverse
    theta: Array
    q: Array
    rate: Array

    def moved(self, crank_angle: Any) -> dict[str, tuple[Array, Array, Array]]:
        """Angle of each link, and its two derivatives by crank angle, at crank angles (...)."""
        theta = np.asarray(crank_angle, dtype=float)
        at = np.ravel(theta) % self.of.period
        q, _ = self.of.newton_angles(at, self._between(at))
        rows = zip(q, *self.of.rates(at, q), strict=True)
        return {
            pusher.link: tuple(part.reshape(theta.shape) for part in row)
            for pusher, row in zip(self.of.pushers, rows, strict=True)
        }

    def _between(self, at: Array) -> Array:
        """Angles near those at crank angles (N,): cubics through what is known."""
        h = self.theta[1] - self.theta[0]
        left = np.minimum((at / h).astype(int), len(self.theta) - 2)
        t = at / h - left
        a, b = self.q[:, left], self.q[:, left + 1]
        v, w = h * self.rate[:, left], h * self.rate[:, left + 1]
        cubic: Array = a + t * (v + t * (3 * (b - a) - 2 * v - w + t * (2 * (a - b) + v + w)))
        return cubic


def commanded_links(machine: Machine) -> FollowedLinks:
    """The angles of all links that are pushed.

    Raises
    ------
    ModelError : strokes cannot be had, from where their links start or further on.
    MobilityError : the linkage cannot be moved at all.
    """
    pushers = machine.pushers
    start = {pusher.link: pusher.start or 0.0 for pusher in pushers}
    bare = replace(machine, loads=(), planting=None, balance=None, support=None, rows=())
    bare = bare.with_turning(RestingLinks(start))
    linkage = assemble(bare)
    moved = {end for coupling in machine.couplings for end in (coupling.driver, coupling.carrier)}
    if linkage.needed_references or moved & start.keys():
        raise ModelError("drives", FOLLOWED)
    turns = np.lcm.reduce([drive.turns for drive in machine.driven])
    of = MultiStrokeInverse(linkage, pushers, float(2 * pi * turns))
    return _followed(of, np.array([*start.values()])[:, None], POINTS * int(turns))


def _followed(of: MultiStrokeInverse, start: Array, count: int) -> FollowedLinks:
    theta = np.linspace(0.0, of.period, count + 1)
    step = theta[1]
    q, change = of.newton_angles(theta[:1], start)
    if not np.all(change < NEWTON_SETTLED * 1e3) or np.max(np.abs(q - start)) > FAR:
        raise _not_had(of, start)
    items, rates, sense = [q], [], 0.0
    for k, at in enumerate(theta):
        here = np.array([at])
        rate, bend = of.rates(here, items[-1])
        lever = float(np.linalg.det(of.levers(here, items[-1])[2])[0])
        sense = sense or float(np.sign(lever))
        guess = items[-1] + step * rate + 0.5 * step**2 * bend
        rates.append(rate)
        if k == count:
            break
        new, change = of.newton_angles(theta[k + 1 : k + 2], guess)
        if not (
            lever * sense > 0 and change < NEWTON_SETTLED * 1e3 and np.max(np.abs(new - q)) < FAR
        ):
            raise _lost(of, float(at))
        items.append(new)
        q = new
    if np.max(np.abs(items[-1] - items[0])) > CLOSED:
        raise _lost(of, of.period)
    return FollowedLinks(of, theta, np.hstack(items), np.hstack(rates))


def _not_had(of: MultiStrokeInverse, start: Array) -> ModelError:
    wanted = of.commanded(np.zeros(1))[0, :, 0]
    there = of.levers(np.zeros(1), start)[0][:, 0]
    each = zip(of.pushers, start[:, 0], wanted, there, strict=True)
    notes = [
        Note(
            "with {link!r} at {angle} it is {there}, and the stroke begins at {wanted}",
            link=item.link,
            angle=angle(float(at)),
            there=_shown(length),
            wanted=_shown(asked),
        )
        for item, at, asked, length in each
    ]
    return ModelError(
        "drives",
        Note(
            "no angles were found at which strokes can begin: {reasons}; give each link its "
            "approximate angle there by start",
            reasons=all_of(notes),
        ),
    )


def _lost(of: MultiStrokeInverse, at: float) -> ModelError:
    links: Sequence[str] = [repr(pusher.link) for pusher in of.pushers]
    return ModelError(
        "drives",
        Note(
            "the strokes lead {links} to where links are stretched out, or a force has no lever, "
            "near crank angle {angle:.4g} deg; let them move less",
            links=all_of(links),
            angle=degrees(at),
        ),
    )
