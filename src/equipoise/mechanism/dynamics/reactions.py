"""Joint forces: the pass over the links, and forces that statics leaves open.

The groups are run in reverse order; each hands what its outer joints must supply to the bodies
that carry them, and the pass ends at drive and frame.  It is linear in the demands.  Loads, soil
and springs make demands of their own.  What bodies and drives exert is read of the pass alike for a
machine and for its parameters.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import field, replace
from functools import cached_property
from itertools import compress
from math import degrees
from typing import Any, ClassVar

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.displays import Brief
from equipoise.errors import RangeError, UsageError
from equipoise.i18n import Note, all_of, to_say
from equipoise.mechanism.assembly.joints import Structure
from equipoise.mechanism.assembly.linkage import Linkage
from equipoise.mechanism.assembly.redundant_reactions import CHANGE_POINT_OFFSET, IDLE, WEAK
from equipoise.mechanism.assembly.steps import Reaction, State, demand_names, resultant, run
from equipoise.mechanism.checks import NamedItems
from equipoise.mechanism.formulas import kernels
from equipoise.mechanism.kinematics.cylinders import pushes
from equipoise.mechanism.kinematics.motion import Motion
from equipoise.mechanism.parts.couplings import Coupling, coupling_kinds
from equipoise.mechanism.parts.joint_properties import JOINTS
from equipoise.mechanism.parts.machine import FRAME, Machine
from equipoise.signals import Array

ANGLES = 7
"""In a cycle, at which it is looked for forces that hold each other."""

LEAST_SQUARES = to_say(
    "the forces in {joints} are statically indeterminate, because of redundant constraints: "
    "reported are those of least squares; drive torque, shaking force and moment, and the "
    "resultant load on the frame do not depend on this choice"
)
WITH_GUIDES = to_say(
    "the forces in {joints} are statically indeterminate, because of redundant constraints: "
    "reported are those of least squares, with moments in guides counted as forces at "
    "{reach:.4g} mm; drive torque, shaking force and moment, and the resultant load on the frame "
    "do not depend on this choice"
)
LEAST_ENERGY = to_say(
    "the forces in {joints} are statically indeterminate, because of redundant constraints: "
    "reported are those of least energy by the stiffness of the joints; drive torque, shaking "
    "force and moment, and the resultant load on the frame do not depend on this choice"
)


@dataclass(frozen=True)
class IndeterminateReactions:
    """Joints by name, in the order of outputs.

    open : forces that statics leaves open.  unbounded : forces that grow without bound.
    at : crank angle (rad) towards which they do.  links : that lie in line there.
    by_stiffness : whether open forces are shared by the stiffness of joints, not by least squares.
    reach : distance (m) at which a moment in a guide counts as a force; 0 without guides.
    """

    open: tuple[str, ...] = ()
    unbounded: tuple[str, ...] = ()
    at: float = 0.0
    links: tuple[str, ...] = ()
    by_stiffness: bool = False
    reach: float = 0.0

    def notes(self) -> Iterator[Note]:
        """A sentence on each."""
        if self.open:
            rule = LEAST_SQUARES if self.reach == 0 else WITH_GUIDES
            rule = LEAST_ENERGY if self.by_stiffness else rule
            yield Note(rule, joints=all_of([*self.open], commas=True), reach=self.reach * 1e3)
        if self.unbounded:
            yield Note(
                "the forces in {joints} are unbounded at crank angle {angle:.4g} deg, where "
                "{links} lie in line without another support, so none are reported; a further "
                "crank or rod that is not in line there would support them",
                joints=all_of([*self.unbounded], commas=True),
                angle=degrees(self.at),
                links=all_of([repr(link) for link in self.links]),
            )


def indeterminate_reactions(linkage: Linkage) -> IndeterminateReactions:
    """Statically indeterminate reactions of a linkage; computed once and kept with it."""
    return _cached(linkage, _compute)


def idle_teeth_notes(linkage: Linkage, solved: State) -> Iterator[Note]:
    """Note on teeth whose force is reported as zero at some crank angles: neither flank agrees."""
    names = [coupling.name for coupling in linkage.joints.couplings]
    idle = [name for name in names if np.any(solved.get(IDLE.format(name), False))]
    if idle:
        yield Note(
            "at some crank angles neither flank of {names} can carry the force shared with the "
            "joints; it is reported as zero there",
            names=all_of(idle, commas=True),
        )


def refuse_unbounded(linkage: Linkage, output: str) -> None:
    """Raise a `UsageError` for an output of a joint whose force has no bound."""
    result = _cached(linkage, _growing)
    if any(output.partition(".")[2].startswith(name) for name in result.unbounded):
        *_, text = result.notes()
        raise UsageError(text)


def hidden(motion: Motion) -> tuple[str, ...]:
    """Joints whose force has no bound at some of the crank angles of a motion, or between them."""
    shared, result = motion.linkage.shared, _cached(motion.linkage, _growing)
    if shared is None or not result.unbounded:
        return ()
    bounded = not motion.whole_cycle and np.all(shared.strength(motion.state) > WEAK)
    return () if bounded else result.unbounded


def _cached(
    linkage: Linkage, find: Callable[[Linkage], IndeterminateReactions]
) -> IndeterminateReactions:
    name = find.__name__
    if name not in linkage.memory:
        linkage.memory[name] = find(linkage)
    result: IndeterminateReactions = linkage.memory[name]
    return result


def _compute(linkage: Linkage) -> IndeterminateReactions:
    shared = linkage.shared
    if shared is None:
        return IndeterminateReactions()
    open_ones = shared.open_joints(_somewhere(linkage)) if shared.count else frozenset()
    return replace(
        _cached(linkage, _growing),
        open=_named(linkage, open_ones),
        by_stiffness=bool(shared.compliance),
        reach=shared.group.size if linkage.joints.sliders else 0.0,
    )


def _growing(linkage: Linkage) -> IndeterminateReactions:
    """Forces without bound alone, which every analysis of joint forces has to know."""
    shared, through = linkage.shared, [group for group in linkage.groups if group.through]
    if shared is None or not through or not _turns(linkage):
        return IndeterminateReactions()
    weakest = [linkage.weakest.get(group.joint, (0.0, 0.0))[1] for group in through]
    weak = shared.strength(linkage.solve(np.array(weakest))) < WEAK
    for group, at in compress(zip(through, weakest, strict=True), weak):
        growing = shared.growing_joints(
            linkage.solve(np.array([at - CHANGE_POINT_OFFSET, at + CHANGE_POINT_OFFSET]))
        )
        names = _named(linkage, growing)
        return IndeterminateReactions(unbounded=names, at=at % (2 * np.pi), links=group.links)
    return IndeterminateReactions()


def _named(linkage: Linkage, forces: frozenset[str]) -> tuple[str, ...]:
    return tuple(name for name, item in linkage.named_reactions if item.force in forces)


def _turns(linkage: Linkage) -> bool:
    try:
        return linkage.cycle.turns > 0
    except RangeError:
        return False


def _somewhere(linkage: Linkage) -> State:
    """The linkage at some crank angles of no meaning that it can reach."""
    share = (np.arange(ANGLES) + 0.37) / ANGLES
    try:
        return linkage.solve(share * 2 * np.pi * linkage.cycle.turns)
    except RangeError as error:
        low, high = error.ranges[0]
        return run(linkage.motion, linkage.start(low + share * (high - low)))


PUSH, TORQUE = "push({})", "M({})"  # what drives exert on their links
"""Name of the force of a drive that pushes, among the values of a pass."""
Demand = tuple[Any, Any]
"""Force (complex) and moment about a link's anchor, each (..., N) or the same at all angles."""


@dataclass(frozen=True, eq=False, repr=False)
class VectorSignal(Brief):
    """A planar vector against crank angle; `value` is complex, x + i y, (..., N)."""

    value: Array

    @property
    def x(self) -> Array:
        return self.value.real

    @property
    def y(self) -> Array:
        return self.value.imag

    @property
    def size(self) -> Array:
        """Length of the vector."""
        return np.abs(self.value)

    @property
    def direction(self) -> Array:
        """Angle of the vector from the x axis, rad."""
        return np.angle(self.value)


@dataclass(frozen=True, eq=False, repr=False)
class JointForce(VectorSignal):
    """Force in a pin, N: exerted on body `on` by body `by`."""

    on: str
    by: str


@dataclass(frozen=True, eq=False, repr=False)
class SliderForce(JointForce):
    """Force in a sliding joint, N.

    normal : its part across the line, positive to the left of the line's direction.
    moment : couple about the slider's point, N m.
    """

    normal: Array
    moment: Array


@dataclass(frozen=True, eq=False, repr=False)
class SlotForce(JointForce):
    """Force of a slot on a pin, N.

    normal : it across the slot; positive away from the centre of a circular one.
    """

    normal: Array


@dataclass(frozen=True, eq=False, repr=False)
class CouplingForce(JointForce):
    """Force of a coupling on its driven body, N, without preloads.

    parts : of it, by name, as `Coupling.parts` has them; attributes too, such as `tangential`.
    """

    parts: Mapping[str, Array]

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_") or name not in self.parts:
            raise AttributeError(f"{name!r} is no part of this force")
        return self.parts[name]


@dataclass(frozen=True, eq=False, repr=False)
class JointFriction(Brief):
    """What a joint resists its motion with; arrays (N,).

    on, by : it acts on the first body.  is_pin : whether that turns, against the other.
    effort : torque in a pin, N m, or force along the line of a slider, the surface that pushes a
        follower, or the pitch curves of gears of varying ratio, N; by damping and drag too.
    pressing : what presses the surfaces on each other, N.
    rate : of the first body against the other, rad/s or m/s.
    reach : from the rate to the sliding speed: the radius of a pin, m; 1 of what slides.
    table : list of the file that has it, of a coupling; empty of a joint.
    wears : whether its surfaces slide by `rate` times `reach`: not of couplings, whose flanks
        slide otherwise than their pitch circles turn.
    """

    on: str
    by: str
    is_pin: bool
    effort: Array
    pressing: Array
    rate: Array
    reach: float
    table: str = ""
    wears: bool = True

    @cached_property
    def loss(self) -> Array:
        """Power lost, W."""
        return -self.effort * self.rate

    @property
    def sliding_power(self) -> Array:
        """What presses, times the sliding speed, W: its integral over time is what wears; 0 where
        `wears` is false.
        """
        if not self.wears:
            return 0.0 * self.pressing
        return self.pressing * np.abs(self.rate) * self.reach


CouplingForces = Mapping[str, Mapping[str, CouplingForce]]
"""Forces of couplings, by list of the file and name."""


@dataclass(frozen=True)
class Push:
    """What is found of a coupling's force among the values of a pass; see `Pushed`.

    preload : that counts, N.
    """

    state: Mapping[str, Any]
    reaction: Reaction
    joints: Structure
    coupling: Coupling
    preload: Any

    @property
    def force(self) -> Any:
        return self.state[self.reaction.force]

    @property
    def push(self) -> Any:
        return self.state[f"T({self.reaction.name})"]

    @property
    def sense(self) -> Any:
        return self.state[f"flank({self.reaction.name})"]

    @property
    def arm(self) -> Any:
        pin = self.joints.pins_between(self.coupling.driven, self.coupling.carrier)[0]
        return self.state[f"p({self.reaction.at})"] - self.state[f"p({pin})"]


@dataclass(frozen=True, eq=False)
class JointReactions:
    """Joint forces of one run over the groups, for one demand or a stack of them.

    state : every value, by the names listed in `mechanism.assembly.steps`; shapes (..., N).
    friction : of joints that resist their motion, by name; its arrays are (..., N).
    """

    motion: Motion
    state: State
    friction: Mapping[str, JointFriction] = field(default_factory=dict)

    @cached_property
    def drives(self) -> dict[str, Array]:
        """What each drive exerts, by the name of its link: a torque on that, N m, or the force
        with which it pushes its ends apart, or its sliding link ahead, N.
        """
        named = {item.link: PUSH if item.pushes else TORQUE for item in self.motion.machine.driven}
        return {
            link: full(self.motion, self.state[name.format(link)], float)
            for link, name in named.items()
        }

    @cached_property
    def drive_torque(self) -> Array:
        """Torque of the first drive on its link, N m; none where that pushes."""
        first = self.motion.machine.drive
        return 0.0 * self.drives[first.link] if first.pushes else self.drives[first.link]

    @property
    def drive_force(self) -> Array:
        """Force of the first drive, which pushes."""
        return self.drives[self.motion.machine.drive.link]

    @cached_property
    def frame_force(self) -> Array:
        """Sum of the forces of all joints on the frame, N, complex."""
        return full(self.motion, -self._on_frame(0j)[0], complex)

    def frame_moment(self, about: complex) -> Array:
        """Moment of all joints and of the drives on the frame about a point, N m."""
        return np.asarray(-self._on_frame(about)[1])

    def _on_frame(self, about: complex) -> tuple[Any, Any]:
        anchors = self.motion.linkage.anchors
        bodies = (FRAME, *self.motion.linkage.grounded)
        names = ((f"p({anchors[body]})", *demand_names(body)) for body in bodies)
        return resultant(
            ((self.state[p], self.state[f], self.state[m]) for p, f, m in names), about
        )

    @property
    def joints(self) -> dict[str, JointForce]:
        """Pins and sliders, by name, but those whose force has no bound."""
        left_out = hidden(self.motion)
        named = ((n, r) for n, r in self.motion.linkage.named_reactions if n not in left_out)
        return NamedItems("joint", ((n, self._joint(r)) for n, r in named if r.kind in JOINTS))

    def couplings(self, preload: Callable[[Coupling], Any]) -> CouplingForces:
        """Forces of couplings by list and name.

        preload : from a coupling to the preload, N, that counts.
        """
        kinds = coupling_kinds(type(self.motion.machine))
        coupling_forces: dict[str, dict[str, CouplingForce]] = {
            table: NamedItems(kind.noun, ()) for table, kind in kinds.items()
        }
        reactions = {
            reaction.name: reaction
            for reaction in self.motion.linkage.reactions
            if reaction.kind in kinds
        }
        for coupling in self.motion.machine.couplings:
            force = self._force(coupling, reactions[coupling.name], preload(coupling))
            coupling_forces[coupling.list_name][coupling.name] = force
        return coupling_forces

    def force_on(self, name: str) -> CouplingForce:
        """Force of a coupling by its name, without a preload."""
        groups = self.couplings(lambda _: 0.0).values()
        return next(group[name] for group in groups if name in group)

    @property
    def contacts(self) -> dict[str, JointForce]:
        """Forces at one place in every joint and coupling, by name."""
        pushing = {coupling.name for coupling in self.motion.machine.couplings if coupling.pushes}
        groups = self.couplings(lambda _: 0.0).values()
        forces = {name: item for group in groups for name, item in group.items() if name in pushing}
        return {**self.joints, **forces}

    @property
    def flanks(self) -> State:
        """Which side of each coupling bears, a flank or a strand, by name in the state."""
        return {name: value for name, value in self.state.items() if name.startswith("flank(")}

    def _joint(self, reaction: Reaction) -> JointForce:
        on, by, sign = read_on(self.motion.linkage.joints, reaction)
        force = full(self.motion, sign * self.state[reaction.force], complex)
        if rider := self.motion.linkage.joints.riders.get(by):
            normal = self.state[f"u({by})"] * rider.normal
            across = kernels.dot(normal, force)
            if (rubs := self.friction.get(by)) is not None:
                force = force - 1j * normal * rubs.effort
            return SlotForce(force, on, rider.on, across)
        if reaction.couple is None:
            return JointForce(force, on, by)
        slider = next(s for s in self.motion.machine.sliders if s.name == reaction.name)
        direction = self.state[f"u({slider.on})"] * np.exp(1j * slider.direction)
        point = self.motion.point(slider.point).place
        moment = moment_of_guide(self.state, reaction, point, (sign, force))
        normal = kernels.cross(direction, force)
        if (rubs := self.friction.get(slider.name)) is not None:
            force = force + (1.0 if rubs.on == on else -1.0) * rubs.effort * direction
        return SliderForce(force, on, by, normal, full(self.motion, moment, float))

    def _force(self, coupling: Coupling, reaction: Reaction, preload: Any) -> CouplingForce:
        at = Push(self.state, reaction, self.motion.linkage.joints, coupling, preload)
        parts = {name: full(self.motion, part, float) for name, part in coupling.parts(at).items()}
        force = full(self.motion, at.force, complex)
        rubs = self.friction.get(coupling.name)
        if rubs is not None and coupling.contact == "surface":
            force = force - 1j * self.state[f"normal({coupling.name})"] * rubs.effort
        return CouplingForce(force, reaction.on, reaction.by, parts)


def read_on(joints: Structure, reaction: Reaction) -> tuple[str, str, int]:
    """Body on which the force of a reaction is reported, the other one, and the sign of the force
    in a state: in joints the later body of the linkage, of a coupling the driven one.
    """
    order = joints.bodies.index
    if reaction.kind in JOINTS and order(reaction.on) < order(reaction.by):
        return reaction.by, reaction.on, -1
    return reaction.on, reaction.by, 1


def moment_of_guide(
    state: Mapping[str, Any], reaction: Reaction, point: Any, reported: tuple[int, Any]
) -> Any:
    """Moment of a guide about the point of its slider, N m, from a state of arrays or terms.

    point : place of that point, m.  reported : sign as of `read_on`, and the force with it.
    """
    sign, force = reported
    return sign * state[str(reaction.couple)] + kernels.cross(
        state[f"p({reaction.at})"] - point, force
    )


def reactions(
    motion: Motion, demands: Mapping[str, Demand], like: JointReactions | None = None
) -> JointReactions:
    """Joint forces that meet the demands of all links.

    demands : link -> force and moment about its anchor, of shapes (..., N).
    like : a pass whose couplings are in contact on the same flanks; without it the demands decide.
    """
    if motion.machine.pushers:
        return _pushed(motion, demands, like)
    return _passed(motion, demands, like)


def _pushed(
    motion: Motion, demands: Mapping[str, Demand], like: JointReactions | None
) -> JointReactions:
    """Reactions where forces drive: as large as it takes for their links to need no torque."""
    pushers = motion.machine.pushers
    torques = [TORQUE.format(pusher.link) for pusher in pushers]

    def needed(by: Mapping[str, Demand]) -> Array:
        """Torques (..., N, P) that the links need."""
        state = _passed(motion, by, like).state
        return np.stack([full(motion, state[name], float) for name in torques], -1)

    acting = [
        ((body, at, way, 0.0) for body, at, way in pushes(motion, pusher)) for pusher in pushers
    ]
    units = [demands_of(motion, item) for item in acting]
    none = dict.fromkeys(motion.machine.links, (0j, 0.0))
    levers = np.stack([needed(none | unit) for unit in units], -1)
    forces = np.linalg.solve(levers, -needed(demands)[..., None])[..., 0]
    total = dict(demands)
    for k, unit in enumerate(units):
        for body, (push, turning) in unit.items():
            own = total.get(body, (0j, 0.0))
            total[body] = own[0] + forces[..., k] * push, own[1] + forces[..., k] * turning
    passed = _passed(motion, total, like)
    for k, entry in enumerate(pushers):
        passed.state[torques[k]] = 0.0 * forces[..., k]
        passed.state[PUSH.format(entry.link)] = forces[..., k]
    return passed


def _passed(
    motion: Motion, demands: Mapping[str, Demand], like: JointReactions | None
) -> JointReactions:
    """The run over the joints, which ends at a torque on the drive's link."""
    state = dict(motion.state)
    of_links = dict.fromkeys(motion.linkage.joints.riders, (0j, 0.0)) | dict(demands)
    on_frame = of_links.pop(FRAME, (0j, 0.0))
    of_links[FRAME] = 0j, 0.0
    for link, (force, moment) in of_links.items():
        state[f"F({link})"], state[f"M({link})"] = force, moment
    linkage = motion.linkage
    state.update({} if like is None else like.flanks)
    run(linkage.forces if like is None else linkage.forces_on_flanks, state)
    for name, on_ground in zip((f"F({FRAME})", f"M({FRAME})"), on_frame, strict=True):
        state[name] = state[name] + on_ground
    for drive in motion.machine.driven:
        state[f"R({motion.linkage.anchors[drive.link]}/{drive.link})"] = state[f"F({drive.link})"]
    return JointReactions(motion, state)


def pushed(reactions: JointReactions) -> Array | None:
    """Force of a drive that pushes, None of any other."""
    return reactions.drive_force if reactions.motion.machine.drive.pushes else None


def full(motion: Motion, value: Any, kind: type) -> Array:
    """Give a value that is the same at all crank angles its axis (N,)."""
    count = len(motion.crank_angle)
    if isinstance(value, np.ndarray) and value.ndim and value.shape[-1] == count:
        return value
    if np.ndim(value) == 0:
        return np.full(count, value, dtype=kind)
    return np.broadcast_to(value, (*np.shape(value)[:-1], count))


Acting = tuple[str, Any, Array, Any]
"""Link, its point, a place (N,) or None for a torque, force and torque."""


def demands_of(motion: Motion, acting: Iterable[Acting]) -> dict[str, Demand]:
    """What holds forces (complex, N) and torques (N m), for every link that has one."""

    def place_of(link: str, point: str) -> Array:
        return motion.point(point).place

    state, anchors = motion.state, motion.linkage.anchors
    return added_up(
        holding_wrench(state[f"p({anchors[item[0]]})"], place_of, item) for item in acting
    )


HoldingWrench = tuple[str, Any, Any]
"""Link, and force, N, and moment about its anchor, N m, that hold something against it."""


def holding_wrench(
    anchor: Any, place_of: Callable[[str, str], Any], acting: Acting
) -> HoldingWrench:
    """What holds a force at a point of a link, and a torque on it; arrays or terms.

    anchor : its place, m.  place_of : from a link and the name of a point to its place, m.
    """
    link, point, force, torque = acting
    at = anchor if point is None else place_of(link, point) if isinstance(point, str) else point
    return link, *kernels.load_demand(anchor, at, force, torque)


def added_up(wrenches: Iterable[HoldingWrench]) -> dict[str, Demand]:
    """Sum of the wrenches on each link that has some."""
    result: dict[str, Demand] = {}
    for link, force, moment in wrenches:
        before = result.get(link, (0.0, 0.0))
        result[link] = before[0] + force, before[1] + moment
    return result


class HasCouplings:
    """What has `couplings`: forces by list of the file, each of which is an attribute too."""

    couplings: Any

    def __getattr__(self, name: str) -> Any:
        if name in coupling_kinds(Machine):
            return self.couplings[name]
        raise AttributeError(f"{type(self).__name__} has no {name!r}")


class ForceReadings(HasCouplings, ABC):
    """What is read of a run over the joints, `solved`.

    preloads : whether it has the preloads of couplings.
    """

    preloads: ClassVar[bool] = True

    @property
    @abstractmethod
    def solved(self) -> JointReactions: ...

    @property
    def drive_torque(self) -> Array:
        """Torque of the first drive on its link, N m; times that link's speed it is its power."""
        return self.solved.drive_torque

    @property
    def drives(self) -> Mapping[str, Array]:
        """Torque of each drive on its link, N m, or its force, N, by the name of the link."""
        return self.solved.drives

    @property
    def drive_force(self) -> Array:
        """Force with which a drive pushes its ends apart, N; of one that does."""
        return self.solved.drive_force

    @cached_property
    def joints(self) -> Mapping[str, JointForce]:
        """Force in each pin and slider, by name, on the later body by the earlier one."""
        return self.solved.joints

    @cached_property
    def couplings(self) -> CouplingForces:
        """Force of each coupling on its driven body, by list of the file and name."""
        return self.solved.couplings(lambda item: item.preload if self.preloads else 0.0)
