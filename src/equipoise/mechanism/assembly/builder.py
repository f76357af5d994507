"""What assembling a linkage keeps track of: bodies and points known so far, and groups of steps."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import field, replace
from typing import Any, Literal

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.i18n import Note
from equipoise.mechanism.assembly.joints import Structure
from equipoise.mechanism.assembly.steps import (
    KernelCall,
    Reaction,
    RunningAngle,
    State,
    Step,
    demand_names,
    initial_state,
    p,
    pin_reaction,
    planar,
    run,
    size_of_bodies,
    u,
)
from equipoise.mechanism.checks import MODE, MODES
from equipoise.mechanism.formulas import kernels
from equipoise.mechanism.parts.machine import Machine, Slider


@dataclass(frozen=True)
class Group:
    """Links that are solved together.

    kind : by a dyad's kernel, by their coupling, by Newton's method on loop equations, or, of a
        link that too many joints hold, by two of its pins.
    motion : steps that find their position and derivatives.
    forces : steps that find the reactions in their joints, once all later groups are done.
    margin : name of the dyad's assembly margin, the squared sine of its transmission angle,
        negative where it cannot be closed; None for others.
    joint : key of the dyad in the table of sides, and its name in outputs: its inner joint.
    point : of an inner joint that slides, the point that stands for it where no other dyad has
        that.  dead : says what the links do where the margin is zero.
    through : whether they go on through change points, where the margin is zero.
    jams : whether they come to no place where the margin is zero, instead of to two branches.
    equal : whether they close a four-bar of equal opposite sides, so that they could.
    peaked : whether the margin can dip within less than a step of crank angles, as it does where a
        block passes the pivot of its guide.
    """

    kind: Literal["dyad", "coupled", "loops", "pointed", "hung"]
    links: tuple[str, ...]
    motion: tuple[Step, ...]
    forces: tuple[Step, ...]
    reactions: tuple[Reaction, ...]
    margin: str | None = None
    joint: str = ""
    point: str = ""
    dead: Note | str = ""
    through: bool = False
    jams: bool = False
    equal: bool = False
    peaked: bool = False


@dataclass(frozen=True)
class Guide:
    """A sliding joint seen from a known body.

    The line runs through point `base` of the known body along the unit vector `along` in that
    body's axes; the other link's `point` stays on it, and its x axis has the direction `turn`
    relative to the line.
    """

    name: str
    base: str
    along: complex
    point: str
    turn: complex

    @classmethod
    def seen_from(cls, slider: Slider, known: str) -> Guide:
        """The line is the same whichever of the two bodies is known."""
        if slider.on == known:
            along, turn = np.exp(1j * slider.direction), np.exp(1j * slider.angle)
            return cls(slider.name, slider.through, along, slider.point, turn)
        along, turn = np.exp(-1j * slider.angle), np.exp(-1j * slider.direction)
        return cls(slider.name, slider.point, along, slider.through, turn)


@dataclass(frozen=True)
class Outer:
    """Joint of an unknown link to a known body: a pin at `point`, or else a guide through it."""

    link: str
    body: str
    point: str
    guide: Guide | None = None

    @property
    def rail(self) -> Guide:
        """The guide of what is no pin."""
        assert self.guide is not None
        return self.guide

    @property
    def inputs(self) -> tuple[str, ...]:
        """Names of what a dyad has to know of it: a point, and how the body of a guide turns."""
        return p(self.point) if self.guide is None else (*p(self.point), *u(self.body))

    def reaction(self, at: str = "") -> Reaction:
        """What it exerts on the link: of a guide, at a point that has to be given."""
        if self.guide is None:
            return pin_reaction(self.point, self.link, self.body)
        return guide_reaction(self.guide, self.link, self.body, at)


@dataclass
class Builder:
    """Bodies and points known so far.

    rank : body -> position in the order of solution.  anchors : body -> the point from which its
    other points are reached and about which its moments are taken.  sides : entries of the table
    of sides that were asked for.  missing : joints whose side the file does not give -> words of
    the two sides, what they mean, what the file has.  motion : steps so far.  given_state :
    references at crank angle 0, of a machine of the same build, whose branch is taken over.
    mode : of four-bars of equal opposite sides whose own entry is missing, one of `MODES`.
    tried : joint -> side that is taken, whatever the file has.  pinned : inner pins of dyads.
    """

    machine: Machine
    rank: dict[str, int] = field(default_factory=dict)
    anchors: dict[str, str] = field(default_factory=dict)
    points: set[str] = field(default_factory=set)
    motion: list[Step] = field(default_factory=list)
    sides: set[str] = field(default_factory=set)
    missing: dict[str, tuple[tuple[str, str], Note, str | None]] = field(default_factory=dict)
    running: set[str] = field(default_factory=set)
    given_state: State = field(default_factory=dict)
    mode: str | None = None
    tried: Mapping[str, str] = field(default_factory=dict)
    pinned: set[str] = field(default_factory=set)
    _now: State = field(init=False)
    _ran: int = field(init=False, default=0)

    def __post_init__(self) -> None:
        self._now = initial_state(self.machine, np.zeros(1)) | self.given_state

    @property
    def now(self) -> State:
        """State at crank angle 0 that the steps so far lead to; run when someone asks."""
        with np.errstate(all="ignore"):
            run(self.motion[self._ran :], self._now)
        self._ran = len(self.motion)
        return self._now

    def add(self, anchors: dict[str, str], points: Iterable[str] = ()) -> None:
        """Record links as known, in the order given, with their anchors."""
        for link in anchors:
            self.rank[link] = len(self.rank)
        self.anchors.update(anchors)
        self.points.update(points)

    def arm(self, link: str, origin: str, point: str) -> complex:
        """Vector from one point of a link to another, in the link's axes."""
        points = self.machine.assembled_points(link)
        return planar(points[point]) - planar(points[origin])

    def size(self) -> Any:
        """Size of the largest body, m; 1 where all are points."""
        return size_of_bodies(self.machine)

    def reach(self, body: str, point: str) -> list[Step]:
        """Calls that make a point of a known body available."""
        if point in self.points:
            return []
        self.points.add(point)
        anchor = self.anchors[body]
        arm = self.arm(body, anchor, point)
        return [KernelCall(kernels.point, (*p(anchor), *u(body)), (arm,), p(point))]

    def running_angle(self, body: str) -> list[Step]:
        """Calls that make the running angle of a known body available."""
        if body in self.running:
            return []
        self.running.add(body)
        return [RunningAngle(body)]

    def anchored(self, group: Group, joints: Structure) -> Group:
        """The group with anchors of its links that are points of their own, as the machine has
        them, also where it was solved from one that stands for such a point in a joint.
        """
        for rider in joints.riders.values():
            for link, points in rider.constraints.items():
                own = points.get(self.anchors.get(link, "")) if link in group.links else None
                if own is not None:
                    steps = (*group.motion, *self.reach(link, own))
                    group = replace(group, motion=steps)
                    self.anchors[link] = own
        return group

    def carrier_of(self, bodies: Iterable[str]) -> str:
        """Among the known bodies at a pin, the one that carries it: the first to be solved."""
        return min((b for b in bodies if b in self.rank), key=lambda b: self.rank[b])

    def short(self, slider: Slider) -> str:
        """The point that stands for a sliding joint in the table of sides; "" where it is the
        name of another joint.
        """
        names = self.pinned.union(slider.name for slider in self.machine.sliders)
        return "" if slider.point in names else slider.point

    def side(self, joint: str, words: tuple[str, str], meaning: Note, point: str = "") -> float:
        """+1 or -1 for the side on which the file assembles a dyad; +1 where that is missing.

        point : stands for the joint where the file has no entry of the joint's own name.
        """
        given = self.machine.assembly
        entry = point if point in given and joint not in given else joint
        side = self.tried.get(joint, given.get(entry))
        if side is None and words == MODES and self.mode is not None:
            self.sides.add(joint)
            joint = entry = MODE
            side = self.mode
        self.sides.add(entry)
        if side not in words:
            self.missing[joint] = (words, meaning, side)
        return -1.0 if side == words[1] else 1.0

    def hand_over(self, reaction: Reaction) -> KernelCall:
        """Call that passes a reaction on to the body that exerts it."""
        demand, anchor = demand_names(reaction.by), self.anchors[reaction.by]
        kernel = kernels.transfer if reaction.couple is None else kernels.transfer_couple
        inputs = (*demand, f"p({anchor})", f"p({reaction.at})", *reaction.outputs)
        return KernelCall(kernel, inputs, (), demand)


def guide_reaction(guide: Guide, on: str, by: str, at: str) -> Reaction:
    key = f"({guide.name}/{on})"
    return Reaction(guide.name, "slider", on, by, at, f"R{key}", f"C{key}")


def outer_joints(builder: Builder, joints: Structure, link: str) -> list[Outer]:
    """Joints of an unknown link to known bodies."""
    result = []
    for point in builder.machine.assembled_points(link):
        known = [body for body in joints.pins.get(point, ()) if body in builder.rank]
        if known:
            result.append(Outer(link, builder.carrier_of(known), point))
    for slider in joints.sliders:
        other = slider.on if slider.link == link else slider.link
        if link in (slider.link, slider.on) and other in builder.rank:
            guide = Guide.seen_from(slider, other)
            result.append(Outer(link, other, guide.base, guide))
    return result
