"""Steps of the computation, and what assembling a linkage keeps track of to make them.

A linkage is a sequence of kernel calls with named inputs and outputs.  NumPy runs the list as it
stands; because a step is nothing but names, numbers and a kernel, the same list can be written
out as flat source.

Names of values in a state
--------------------------
``p(B)``, ``p1(B)``, ``p2(B)``            point and its derivatives by crank angle
``u(rod)``, ``w(rod)``, ``a(rod)``        rotation of a link and its derivatives
``phi(gear)``                             running angle of a link, rad, counted through the turns
``F(rod)``, ``M(rod)``                    what the joints of a link must supply, about its anchor
``R(B/rod)``, ``C(B/rod)``                force and couple that a joint exerts on a link
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from functools import reduce
from typing import Any, Literal, Protocol

import numpy as np

from equipoise.i18n import Note
from equipoise.mechanism import kernels
from equipoise.mechanism.model import FRAME, Machine, Slider, Vector

Array = np.ndarray[Any, Any]
State = dict[str, Any]
Kernel = Callable[..., tuple[Any, ...]]


class Step(Protocol):
    """Anything that adds values to a state."""

    def run(self, state: State) -> None: ...


@dataclass(frozen=True)
class Call:
    """outputs = kernel(*inputs, *parameters)."""

    kernel: Kernel
    inputs: tuple[str, ...]
    parameters: tuple[Any, ...]
    outputs: tuple[str, ...]

    def run(self, state: State) -> None:
        values = self.kernel(*[state[name] for name in self.inputs], *self.parameters)
        state.update(zip(self.outputs, values, strict=True))


@dataclass(frozen=True)
class RunningAngle:
    """Angle of a link, counted on through the turns.

    The rotation itself tells the angle only up to whole turns; `reference(link)` in the state
    tells it to within half a turn.  Without one, neighbouring crank angles are taken to lie close
    together.
    """

    link: str

    @property
    def reference(self) -> str:
        return self.link

    def run(self, state: State) -> None:
        reference = state.get(f"reference({self.link})")
        state[f"phi({self.link})"] = running_angle(state, self.link, reference)


def running_angle(state: State, link: str, reference: Any = None) -> Array:
    """Angle of a link (N,), counted on from a reference, or else from angle to angle."""
    angle = plain_angle(state, link)
    if reference is None:
        return np.unwrap(angle)
    turns = np.round((reference - angle) / (2 * np.pi))
    running: Array = angle + 2 * np.pi * turns
    return running


def plain_angle(state: State, link: str) -> Array:
    """Angle of a link (N,) within half a turn of 0."""
    angle: Array = np.angle(state[f"u({link})"])
    return angle if np.ndim(angle) else np.full(np.shape(state["theta"]), angle)


@dataclass(frozen=True)
class Rotation:
    """u = exp(i phi): rotation of a link whose running angle is known."""

    link: str

    def run(self, state: State) -> None:
        state[f"u({self.link})"] = np.exp(1j * np.asarray(state[f"phi({self.link})"]))


def needed_references(steps: Iterable[Step]) -> list[str]:
    """Names of the references that these steps read: running angles, and poses of loop groups."""
    return [step.reference for step in steps if hasattr(step, "reference")]


def run(steps: Iterable[Step], state: State) -> State:
    """Run the steps on a state, which they extend."""
    for step in steps:
        step.run(state)
    return state


def p(point: str) -> tuple[str, str, str]:
    """Names of a point and its two derivatives."""
    return f"p({point})", f"p1({point})", f"p2({point})"


def u(link: str) -> tuple[str, str, str]:
    """Names of a link's rotation and its two derivatives."""
    return f"u({link})", f"w({link})", f"a({link})"


@dataclass(frozen=True)
class Reaction:
    """A joint's force, as the calls find it: on body `on`, by body `by`, at point `at`.

    name : of the joint; kind : "pin", "slider" or "gear".
    force, couple : names of values in the state; the couple is about `at`, None for pins.
    """

    name: str
    kind: str
    on: str
    by: str
    at: str
    force: str
    couple: str | None = None

    @property
    def outputs(self) -> tuple[str, ...]:
        """Names of what is to be found of it."""
        return (self.force,) if self.couple is None else (self.force, self.couple)


@dataclass(frozen=True)
class Group:
    """Links that are solved together.

    kind : by a dyad's kernel, by their gear, or by Newton's method on loop equations.
    motion : steps that find their position and derivatives.
    forces : steps that find the reactions in their joints, once all later groups are done.
    margin : name of the dyad's assembly margin, the squared sine of its transmission angle,
        negative where it cannot be closed; None for others.
    joint : inner joint of the dyad.  dead : says what the links do where the margin is zero.
    """

    kind: Literal["dyad", "geared", "loops"]
    links: tuple[str, ...]
    motion: tuple[Step, ...]
    forces: tuple[Step, ...]
    reactions: tuple[Reaction, ...]
    margin: str | None = None
    joint: str = ""
    dead: Note | str = ""


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
    other points are reached and about which its moments are taken.  sides : joints whose
    assembly side was asked for.  missing : those of them that the file does not answer -> words
    of the two sides, what they mean, what the file has.  motion : steps so far.  told :
    references at crank angle 0, of a machine of the same build, whose branch is taken over.
    """

    machine: Machine
    rank: dict[str, int] = field(default_factory=dict)
    anchors: dict[str, str] = field(default_factory=dict)
    points: set[str] = field(default_factory=set)
    motion: list[Step] = field(default_factory=list)
    sides: set[str] = field(default_factory=set)
    missing: dict[str, tuple[tuple[str, str], str, str | None]] = field(default_factory=dict)
    running: set[str] = field(default_factory=set)
    told: State = field(default_factory=dict)
    _now: State = field(init=False)
    _ran: int = field(init=False, default=0)

    def __post_init__(self) -> None:
        self._now = initial_state(self.machine, np.zeros(1)) | self.told

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
        points = self.machine.points_of(link)
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
        return [Call(kernels.point, (*p(anchor), *u(body)), (arm,), p(point))]

    def running_angle(self, body: str) -> list[Step]:
        """Calls that make the running angle of a known body available."""
        if body in self.running:
            return []
        self.running.add(body)
        return [RunningAngle(body)]

    def carrier_of(self, bodies: Iterable[str]) -> str:
        """Among the known bodies at a pin, the one that carries it: the first to be solved."""
        return min((b for b in bodies if b in self.rank), key=lambda b: self.rank[b])

    def side(self, joint: str, words: tuple[str, str], meaning: str) -> float:
        """+1 or -1 for the side on which the file assembles a dyad; +1 where that is missing."""
        self.sides.add(joint)
        side = self.machine.assembly.get(joint)
        if side not in words:
            self.missing[joint] = (words, meaning, side)
        return -1.0 if side == words[1] else 1.0

    def hand_over(self, reaction: Reaction) -> Call:
        """Call that passes a reaction on to the body that exerts it."""
        demand, anchor = demand_names(reaction.by), self.anchors[reaction.by]
        kernel = kernels.transfer if reaction.couple is None else kernels.transfer_couple
        inputs = (*demand, f"p({anchor})", f"p({reaction.at})", *reaction.outputs)
        return Call(kernel, inputs, (), demand)


def planar(place: Vector) -> complex:
    """A vector as a complex number; of columns, a column of them."""
    x, y = place
    return x + 1j * y


def size_of_bodies(machine: Machine) -> Any:
    """Size of the largest body, m; 1 where all are points.  A column where some numbers are."""
    sizes = []
    for points in machine.bodies.values():
        xs, ys = zip(*points.values(), strict=True)
        spans = (reduce(np.maximum, v) - reduce(np.minimum, v) for v in (xs, ys))
        sizes.append(np.hypot(*spans))
    size = reduce(np.maximum, sizes)
    return size + (size == 0)


def demand_names(link: str) -> tuple[str, str]:
    """Names of what a link's joints must supply: force, and moment about its anchor."""
    return f"F({link})", f"M({link})"


def pin_reaction(point: str, on: str, by: str) -> Reaction:
    return Reaction(point, "pin", on, by, point, f"R({point}/{on})")


def guide_reaction(guide: Guide, on: str, by: str, at: str) -> Reaction:
    key = f"({guide.name}/{on})"
    return Reaction(guide.name, "slider", on, by, at, f"R{key}", f"C{key}")


def initial_state(machine: Machine, theta: Array) -> State:
    """State in which only the frame and the drive link are known, at crank angles (N,)."""
    state: State = {"theta": theta}
    for name, place in machine.frame.items():
        here = planar(place) + np.complex128()  # unlike Python's, it divides by 0 without an error
        state.update({f"p({name})": here, f"p1({name})": 0j, f"p2({name})": 0j})
    state.update({f"u({FRAME})": 1 + 0j, f"w({FRAME})": 0.0, f"a({FRAME})": 0.0})
    drive = machine.drive.link
    state.update({f"u({drive})": np.exp(1j * theta), f"w({drive})": 1.0, f"a({drive})": 0.0})
    state.update({f"phi({FRAME})": np.zeros_like(theta), f"phi({drive})": theta})
    return state
