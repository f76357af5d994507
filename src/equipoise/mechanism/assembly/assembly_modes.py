"""Assembly modes of dyads where the file leaves them out, and parallel cranks.

A side fits that brings the links where ``[position]`` has them, or where their own axes have them:
whoever draws all links in the frame's axes has drawn crank angle 0.  Where neither decides, a side
does without which the crank cannot turn fully.  All of it becomes one error, with lines that can be
pasted into the file.

A four-bar of equal opposite sides comes into line twice a turn, where its links may go on parallel
or crossed; the file says which.  A third crank between the same two bodies has nothing left to
decide: its pins are where the others bring them.
"""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import chain, product
from math import ceil, degrees, pi
from typing import Any

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.errors import EquipoiseError, ModelError, Paste, noted
from equipoise.i18n import Note, series, to_say
from equipoise.mechanism.assembly.builder import Builder, Group, Outer
from equipoise.mechanism.assembly.joints import Structure
from equipoise.mechanism.assembly.steps import KernelCall, State, initial_state, p, planar, run, u
from equipoise.mechanism.checks import MODE, MODES, meant
from equipoise.mechanism.formulas import kernels
from equipoise.mechanism.parts.machine import Machine
from equipoise.quantities import number

STEPS_PER_TURN = 360
"""Crank angles in a turn, on the way from 0 to that of the position in the file."""
ROUGH, CLEARER = 0.25, 0.5
"""Largest distance, in sizes of the machine, from a place that a side fits; and its greatest share
of the other side's."""
MOST_TRIED = 4
"""Open sides of which every combination is tried."""
ANGLES = tuple(np.radians(np.arange(0.0, 360.0, 30.0)).tolist())
"""Crank angles at which links are tried whose assembly mode is undetermined."""
STRETCHED = 1e-6
"""Squared sine of a transmission angle up to which both sides are the same."""
SMALL = 1e4
"""Sizes of the machine beside which rounding of coordinates is seen as such."""
BARE = re.compile("[A-Za-z0-9_-]+")

LEADING = to_say("{sentence}, such as")
TURNS = Note("the crank turns fully with this side alone")
IN_POSITION, AS_DRAWN = Note("as in [position]"), Note("as drawn")


@dataclass
class Choice:
    """A side that the file leaves out, or gives in words of another dyad.

    inner : name of the inner joint.  words : of the two sides.  meaning : what they say.
    given : what the file has.
    side : the number of the word that is taken.  why : what decides it; None where nothing does.
    gives : what each side leads to; None where the links cannot be joined.
    group : with the side that is taken.
    """

    inner: str
    words: tuple[str, str]
    meaning: Note
    given: str | None
    side: int
    why: Note | None
    gives: tuple[Note | None, ...]
    group: Group

    @property
    def joint(self) -> str:
        """Key of the dyad in the table of sides."""
        return self.group.joint

    @property
    def wrong(self) -> Note:
        return Note("missing") if self.given is None else Note("got {given!r}", given=self.given)

    @property
    def wrong_at_joint(self) -> Note:
        """What is wrong, with the joint where it is."""
        if self.given is None:
            return Note("{joint} is missing", joint=self.joint)
        return Note("{joint} got {given!r}", joint=self.joint, given=self.given)

    def lines(self, taken: str) -> Iterator[Note]:
        """Lines for the table of sides; both sides where the assembly mode is undetermined.

        taken : entries of earlier joints on which what these sides give depends.
        """
        yield Note("# {remark}", remark=self.meaning)
        for k in (self.side,) if self.why else (0, 1):
            entry: Note | str = self.entry(k)
            if k != self.side:
                entry = Note("# or {entry}", entry=entry)
            remark = self.gives[k]
            if remark and taken:
                remark = Note("{place}, with {entries}", place=remark, entries=taken)
            if remark and self.why:
                remark = Note("{first}; {second}", first=remark, second=self.why)
            if remark := remark or self.why:
                entry = Note("{entry}  # {remark}", entry=entry, remark=remark)
            yield noted(entry)

    def entry(self, k: int) -> str:
        """In the table of sides, with one of the words."""
        return f'{key_text(self.joint)} = "{self.words[k]}"'


def key_text(name: str) -> str:
    """A name as a key of a file."""
    return name if BARE.fullmatch(name) else json.dumps(name, ensure_ascii=False)


def chosen(
    builder: Builder, group: Group, assumed: Mapping[str, tuple[int, Note | None]]
) -> Choice:
    """The side of a group that fits, and else the one that is assumed, or the first."""
    both = [_with_side(group, word) for word in (1.0, -1.0)]
    side, why = assumed.get(group.joint, (0, None))
    position = builder.machine.position
    evidence = [] if position is None else [(position.crank_angle, IN_POSITION, _in_position)]
    for theta, text, distances in (*evidence, (0.0, AS_DRAWN, _as_drawn)):
        states = [_state(builder, item, theta) for item in both]
        gives = tuple(_given_by(builder, group, state, theta) for state in states)
        off = [max(distances(builder, group, state), default=np.inf) for state in states]
        best = int(off[1] < off[0])
        if all(gives) and off[best] <= min(ROUGH * float(builder.size()), CLEARER * off[1 - best]):
            side, why = best, text
            break
    else:
        for theta in ANGLES:  # the first at which the links can be joined
            gives = tuple(
                _given_by(builder, group, _state(builder, item, theta), theta) for item in both
            )
            if all(gives):
                break
    return Choice(group.joint, *builder.missing[group.joint], side, why, gives, both[side])


def _with_side(group: Group, side: float) -> Group:
    """A dyad's kernel takes its side as the last of its numbers."""
    *before, call = group.motion
    assert isinstance(call, KernelCall)
    call = replace(call, parameters=(*call.parameters[:-1], side))
    return replace(group, motion=(*before, call))


def _state(builder: Builder, group: Group, theta: float) -> State:
    """State at one crank angle, to which the links before are followed from 0."""
    path = np.linspace(0.0, theta, max(2, ceil(abs(theta) / (2 * pi) * STEPS_PER_TURN)))
    with np.errstate(all="ignore"):
        state = run([*builder.motion, *group.motion], initial_state(builder.machine, path))
    return {name: np.ravel(value)[-1] for name, value in state.items()}


def _given_by(builder: Builder, group: Group, state: State, theta: float) -> Note | None:
    """Where the joint is, or how a guide stands; None where the links cannot be joined."""
    assert group.margin is not None
    if not state[group.margin] > STRETCHED:
        return None
    pose = _pose(builder.machine, theta)
    name = f"p({group.joint})"
    if name in group.motion[-1].outputs:  # type: ignore[attr-defined]
        x, y = (number(1e3 * part, SMALL * 1e3 * builder.size()) for part in _parts(state[name]))
        return Note("at ({x}, {y}) mm {pose}", x=x, y=y, pose=pose)
    turn = degrees(np.angle(state[f"u({group.links[-1]})"]))
    link = group.links[-1]
    return Note("{link} at {angle} deg {pose}", link=link, angle=number(turn, 360.0), pose=pose)


def _pose(machine: Machine, theta: float) -> Note:
    """What poses the driven links: of those that are pushed the angle at which they are looked at,
    since what their strokes make of it is known only once the linkage is assembled.
    """
    if machine.turning is None:
        return Note("at crank angle {angle} deg", angle=number(degrees(theta)))
    angles = {link: float(angle) for link, (angle, *_) in machine.turning.moved(theta).items()}
    posed = [
        Note("{link} at {angle} deg", link=link, angle=number(degrees(angle), 360.0))
        for link, angle in angles.items()
    ]
    return Note("with {links}", links=series(posed))


def _parts(place: complex) -> tuple[float, float]:
    return float(np.real(place)), float(np.imag(place))


def _places(builder: Builder, link: str, state: State) -> dict[str, complex]:
    """Places of a link's points."""
    anchor = builder.anchors[link]
    start, turn = state[f"p({anchor})"], state[f"u({link})"]
    points = builder.machine.assembled_points(link)
    return {name: start + turn * builder.arm(link, anchor, name) for name in points}


def _in_position(builder: Builder, group: Group, state: State) -> Iterator[float]:
    """Distances of points, and of ends of links that turn, from where the file has them, m."""
    position = builder.machine.position
    assert position is not None
    for link in group.links:
        for name, place in _places(builder, link, state).items():
            if name in position.points:
                yield float(abs(place - complex(*position.points[name])))
        if link in position.angles:
            turn = np.exp(1j * position.angles[link])
            yield float(abs(state[f"u({link})"] - turn) * builder.size())


def _as_drawn(builder: Builder, group: Group, state: State) -> Iterator[float]:
    """Distances of points from where the links' own axes have them, m."""
    for link in group.links:
        own = builder.machine.bodies.get(link, {})
        places = _places(builder, link, state)
        yield from (float(abs(places[name] - complex(*at))) for name, at in own.items())


def decided(
    choices: Sequence[Choice], turns_fully: Callable[[Mapping[str, str]], Any]
) -> dict[str, tuple[int, Note | None]]:
    """By inner joint, the sides without which the crank cannot turn fully, where nothing else
    decides.

    turns_fully : raises an `EquipoiseError` where the crank does not with these sides, by joint.
    """
    known = {choice.inner: choice.words[choice.side] for choice in choices}
    undecided = [choice for choice in choices if not choice.why]
    if not 0 < len(undecided) <= MOST_TRIED:
        return {}
    good: list[tuple[int, ...]] = []
    for numbers in product((0, 1), repeat=len(undecided)):
        taken = {item.inner: item.words[k] for item, k in zip(undecided, numbers, strict=True)}
        try:
            turns_fully(known | taken)
        except EquipoiseError:
            continue
        good.append(numbers)
    pairs = {}
    for entry, taken_sides in zip(undecided, zip(*good, strict=True), strict=False):
        alone = len(set(taken_sides)) == 1 and len(good) < 2 ** len(undecided)
        pairs[entry.inner] = (taken_sides[0], TURNS if alone else None)
    return pairs


def missing(machine: Machine, choices: Sequence[Choice], idle: Iterable[str] = ()) -> ModelError:
    """One error for all sides that are missing; `idle` are entries of joints that have none."""
    first = choices[0]
    if len(choices) == 1:
        where = f"assembly.{first.joint}"
        what = Note(
            '{sentence}; give "{first}" or "{second}": {meaning}',
            sentence=first.wrong,
            first=first.words[0],
            second=first.words[1],
            meaning=first.meaning,
        )
    else:
        where, parts = "assembly", series([choice.wrong_at_joint for choice in choices])
        what = Note("{parts}; give each its side in [assembly]", parts=parts)
    joints = [choice.joint for choice in choices]
    for name in idle:
        hint = meant(name, joints)
        entry = Note("{name!r} is no inner joint of a dyad", name=name)
        entry = Note("{sentence}; {hint}", sentence=entry, hint=hint) if hint else entry
        what = Note("{sentence} ({entry})", sentence=what, entry=entry)
    table = [] if machine.assembly else ["[assembly]"]
    taken: list[str] = []
    for item in choices:
        table += item.lines(", ".join(taken))
        if not item.why:
            taken.append(item.entry(item.side))
    error = ModelError(where, what).with_paste(Paste(tuple(table), LEADING))
    return error.with_topic("a-side-is-missing-in-assembly")


SAME_LENGTH = 1e-9
"""Of the larger one: difference of two lengths that count as the same."""
NEARLY = 0.05
"""Of the larger one: difference up to which two lengths are meant to be the same."""


@dataclass(frozen=True)
class Closed:
    """A four-bar that a dyad closes: of two known bodies that share the pin `pivot`, `here` with
    the first and `there` with the second of its outer pins.

    sides : ends of each side and its length, m, those opposite to each other side by side.
    """

    here: str
    there: str
    pivot: str
    sides: tuple[tuple[str, Any], ...]

    def apart(self) -> Any:
        """Difference of opposite sides, over the larger one; of two pairs the larger."""
        lengths = [length for _, length in self.sides]
        pairs = zip(lengths[::2], lengths[1::2], strict=True)
        return np.maximum(*(abs(a - b) / np.maximum(a, b) for a, b in pairs))

    @property
    def equal(self) -> bool:
        """Whether opposite sides have the same length."""
        return bool(np.all(self.apart() <= SAME_LENGTH))

    def misfit(self) -> Note:
        """Say which opposite sides differ, and by how much."""
        pairs = zip(self.sides[::2], self.sides[1::2], strict=True)
        (item, a), (other, b) = max(pairs, key=lambda pair: float(abs(pair[0][1] - pair[1][1])))
        return Note(
            "opposite sides of a parallel linkage are equal, and {one} is {a:.7g} mm, {other} "
            "{b:.7g} mm, {apart:.4g} mm apart; give both one length",
            one=item,
            a=a * 1e3,
            other=other,
            b=b * 1e3,
            apart=abs(a - b) * 1e3,
        )


def closed_by(builder: Builder, first: Outer, second: Outer, pin: str) -> Closed | None:
    """The four-bar that two links with a pin between them close, if it is one."""
    points = builder.machine.assembled_points
    for here in (body for body in builder.rank if first.point in points(body)):
        for there in (body for body in builder.rank if second.point in points(body)):
            for pivot in () if here == there else points(here).keys() & points(there).keys():
                if pivot in (first.point, second.point):
                    continue
                ends = ((here, pivot, first.point), (second.link, second.point, pin),
                        (there, pivot, second.point), (first.link, first.point, pin))  # fmt: skip
                sides = ((f"{a}-{b}", abs(builder.arm(body, a, b))) for body, a, b in ends)
                return Closed(here, there, pivot, tuple(sides))
    return None


def parallel_by(builder: Builder, first: Outer, second: Outer, pin: str) -> Closed | None:
    """The four-bar of equal opposite sides that two links close, if they are to go on through its
    change points.

    Raises
    ------
    ModelError : the opposite sides are to be equal, and are not.
    """
    given = builder.machine.assembly.get(pin)
    wanted = given in MODES or (given is None and builder.mode is not None)
    closed = closed_by(builder, first, second, pin) if wanted or given is None else None
    if closed is None:
        return None
    if closed.equal:
        return closed
    if wanted and (given in MODES or np.all(closed.apart() <= NEARLY)):
        where = pin if given in MODES else MODE
        raise ModelError(f"assembly.{where}", closed.misfit())
    return None


def surplus_cranks(machine: Machine, joints: Structure) -> frozenset[str]:
    """Links beyond two that are equal and parallel cranks between the same two bodies."""
    between: dict[frozenset[str], list[tuple[str, Mapping[str, str]]]] = {}
    for link in sorted(machine.links, key=lambda link: link != machine.drive.link):
        pins = [(body, point) for point, bodies in joints.pins.items() if link in bodies
                for body in bodies if body != link]  # fmt: skip
        if len(pins) == len({body for body, _ in pins}) == len({pt for _, pt in pins}) == 2:
            between.setdefault(frozenset(body for body, _ in pins), []).append((link, dict(pins)))
    return frozenset(chain.from_iterable(_beyond(machine, *item) for item in between.items()))


def _beyond(
    machine: Machine, pair: frozenset[str], cranks: list[tuple[str, Mapping[str, str]]]
) -> Iterator[str]:
    """Of cranks between two bodies, those after the second that are parallel to the first."""
    here, there = pair
    ways = []
    for link, pins in cranks:
        points = machine.assembled_points(link)
        crank = abs(planar(points[pins[here]]) - planar(points[pins[there]]))
        a, b = (planar(machine.assembled_points(body)[pins[body]]) for body in (here, there))
        ways.append((link, crank, a, b))
    (_, size, a0, b0), *others = ways
    if not others or others[0][2] == a0:
        return
    turn = (others[0][3] - b0) / (others[0][2] - a0)
    if not abs(abs(turn) - 1) <= NEARLY:
        return
    for link, crank, a, b in others[1:]:
        far = NEARLY * max(size, crank, abs(a - a0))
        if abs(crank - size) <= NEARLY * size and abs(b - b0 - turn * (a - a0)) <= far:
            yield link


def pointed(builder: Builder, outers: list[Outer]) -> Group | None:
    """A link positioned by pins to known bodies at two points or more."""
    link, first = outers[0].link, outers[0].point
    second = max(
        (outer.point for outer in outers), key=lambda pt: abs(builder.arm(link, first, pt))
    )
    arm = builder.arm(link, first, second)
    if not arm:
        return None
    reach = [step for outer in outers for step in builder.reach(outer.body, outer.point)]
    builder.add({link: first})
    motion = KernelCall(kernels.pointed, (*p(first), *p(second)), (arm,), u(link))
    return Group(
        "pointed", (link,), (*reach, motion), (), tuple(item.reaction() for item in outers)
    )
