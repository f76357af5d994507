"""What the motion does: shaking force and moment, drive torque, and the force in every joint.

Each link's inertia, weight, loads and springs make a demand, a force and a moment about the link's
anchor, that its joints must supply; `dynamics.reactions` turns demands into joint forces.  Because
that pass is linear in the demands, the shares of causes, links or parameters follow from one run on
a stack of their demands.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import field, fields, replace
from functools import cached_property
from math import copysign
from typing import Any

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.displays import Brief, Displayed
from equipoise.errors import MassError, UsageError
from equipoise.i18n import Note, key_names
from equipoise.mechanism.assembly.joints import given_properties
from equipoise.mechanism.assembly.linkage import assemble
from equipoise.mechanism.assembly.steps import Reaction, p, planar, resultant, u
from equipoise.mechanism.checks import unknown
from equipoise.mechanism.dynamics.friction import (
    unit_demands,
    with_friction,
    with_given_friction,
)
from equipoise.mechanism.dynamics.loads import (
    inner_demands,
    load_demands,
    outer_loads,
    spring_demands,
)
from equipoise.mechanism.dynamics.out_of_plane import (
    OF_FRAME,
    OutOfPlaneMoments,
    apart,
    exerted_in,
    loads_across,
    masses_across,
    pushes_across,
    springs_across,
)
from equipoise.mechanism.dynamics.reactions import (
    CouplingForces,
    Demand,
    ForceReadings,
    HasCouplings,
    JointForce,
    JointFriction,
    JointReactions,
    SliderForce,
    VectorSignal,
    demands_of,
    full,
    pushed,
    reactions,
)
from equipoise.mechanism.dynamics.section_loads import SectionLoads, section_loads
from equipoise.mechanism.formulas import kernels
from equipoise.mechanism.kinematics.friction_joints import STILL, rubbing_joints
from equipoise.mechanism.kinematics.motion import Motion
from equipoise.mechanism.parts.couplings import Coupling
from equipoise.mechanism.parts.element_kinds import force_kinds
from equipoise.mechanism.parts.joint_properties import JointProperties
from equipoise.mechanism.parts.links import in_frame
from equipoise.mechanism.parts.machine import Link, Machine, Vector
from equipoise.signals import Array

ELEMENTS: Mapping[str, str] = {
    kind.cause: kind.cause_label for kind in force_kinds(Machine).values()
}
"""Causes of force elements, which act between bodies, the frame too, with their labels; the first
are springs, with which preloads of couplings are listed."""
INERTIA = ("translation", "rotation")
"""Inertia of the centres of mass, inertia of rotation about them."""
EVERYWHERE = (*INERTIA, "weight", "load", "spring")
"""Causes that every machine has, be they 0; loads are those from outside."""
CAUSES = tuple(dict.fromkeys((*EVERYWHERE, *ELEMENTS, "friction")))
"""All of them, friction in joints as the last."""


@dataclass(frozen=True, eq=False, repr=False)
class Shares(HasCouplings, Brief):
    """Shares of outputs: arrays (..., N), whose first axes are the causes, links or parameters.

    drives : link -> torque of its drive, N m, of which `drive_torque` is the first.
    shaking_force, frame_force : complex, N.  shaking_moment, frame_moment, drive_torque : N m.
    drive_force : N, of a drive that pushes.
    joints : name -> force whose arrays have those axes; couplings : such names by list of the file.
    across : what links beside each other do; None where they all lie in one plane.
    """

    shaking_force: Array
    shaking_moment: Array
    frame_force: Array
    frame_moment: Array
    drive_torque: Array
    drives: Mapping[str, Array]
    joints: Mapping[str, JointForce]
    couplings: CouplingForces
    across: OutOfPlaneMoments | None
    drive_force: Array | None = field(default=None, kw_only=True)

    @property
    def of_machine(self) -> dict[str, Array]:
        """All but the forces in joints and couplings, by name."""
        known = {item.name: getattr(self, item.name) for item in fields(Shares)}
        if self.across is not None:
            known |= {name: getattr(self.across, name).value for name in OF_FRAME}
        return {name: value for name, value in known.items() if isinstance(value, np.ndarray)}


@dataclass(frozen=True, eq=False, repr=False)
class Split(Shares):
    """Outputs by cause and link: arrays (C, L, N), links in file order.

    causes : those of `CAUSES` that every machine has, and of the others those of this machine.

    Teeth are taken with the flank in contact that the whole load gives, and chains with the strand
    that pulls.
    """

    causes: tuple[str, ...]
    links: tuple[str, ...]

    def by_cause(self, output: str) -> dict[str, Array]:
        """An output, such as ``drive_torque`` or ``joints.B``, summed over links."""
        return dict(zip(self.causes, self._array(output).sum(axis=1), strict=True))

    def by_link(self, output: str) -> dict[str, Array]:
        """An output, such as ``drive_torque`` or ``joints.B``, summed over causes."""
        return dict(zip(self.links, self._array(output).sum(axis=0), strict=True))

    def _array(self, output: str) -> Array:
        of_machine = self.of_machine
        for name, joint in self.joints.items():
            of_machine[f"joints.{name}"] = joint.value
            if isinstance(joint, SliderForce):
                of_machine[f"joints.{name}.moment"] = joint.moment
        for name, effort in self.drives.items():
            of_machine |= {f"drives.{name}.{what}": effort for what in ("torque", "force")}
        for table, forces in self.couplings.items():
            for name, force in forces.items():
                of_machine[f"{table}.{name}"] = force.value
                of_machine |= {f"{table}.{name}.{part}": item for part, item in force.parts.items()}
        if self.across is not None:
            of_machine |= {
                f"bearings.{name}": bearing.value for name, bearing in self.across.bearings.items()
            }
        if output not in of_machine:
            raise UsageError(unknown(output, of_machine, "output"))
        return of_machine[output]


def ring_speed(motion: Motion, reaction: Reaction) -> Array:
    """Speed (N,) of one body of a pin against the other, rad/s; 0 where it rests."""
    turns = [motion.state[f"w({body})"] for body in (reaction.on, reaction.by)]
    rate = np.broadcast_to(np.asarray(turns[0] - turns[1], float), motion.crank_angle.shape)
    return np.where(np.abs(rate) > STILL, rate, 0.0) * motion.speed


def joint_properties(motion: Motion) -> dict[str, tuple[Reaction, JointProperties]]:
    """Joints of which the file says something, by name."""
    if not motion.machine.joints:
        return {}
    linkage = motion.linkage
    names = {item.force: name for name, item in linkage.named_reactions}
    given = given_properties(linkage.machine, linkage.joints, linkage.reactions)
    return {names[reaction.force]: (reaction, item) for _, reaction, item in given
            if reaction.force in names}  # fmt: skip


@dataclass(frozen=True, eq=False)
class PlainBearing:
    """A plain bearing over the crank angle.

    pressure : (N,) force over width times diameter, Pa.
    pressure_speed : (N,) that times the sliding speed, Pa m/s.
    """

    pressure: Array
    pressure_speed: Array


def plain_bearings(motion: Motion, joints: Mapping[str, JointForce]) -> Mapping[str, PlainBearing]:
    """Plain bearings by joint: pins whose radius and width are given."""
    by_name: dict[str, PlainBearing] = {}
    if all(item.width is None for item in motion.machine.joints):
        return by_name
    for name, (reaction, item) in joint_properties(motion).items():
        if item.width is not None and item.radius is not None and name in joints:
            pressure = joints[name].size / (item.width * 2 * item.radius)
            sliding = np.abs(ring_speed(motion, reaction)) * item.radius
            by_name[name] = PlainBearing(pressure, pressure * sliding)
    return by_name


@dataclass(frozen=True, eq=False, repr=False)
class Forces(ForceReadings, Displayed):
    """Forces of a machine in motion; arrays (N,), one value for each crank angle.

    motion : what they belong to.
    about : point of the frame's plane (m, complex) about which moments are taken.
    inertia, weights, loads, springs : link -> its demand, by what makes it; loads and springs
        only where there are.
    inner : those of the loads whose opposite the frame bears.
    rubs : whether friction in joints counts.
    """

    motion: Motion
    about: complex
    inertia: Mapping[str, Demand]
    weights: Mapping[str, Demand]
    loads: Mapping[str, Demand]
    springs: Mapping[str, Demand] = field(default_factory=dict)
    inner: Mapping[str, Demand] = field(default_factory=dict)
    rubs: bool = True

    @property
    def caption(self) -> str:
        """Of which machine, at how many crank angles, how fast."""
        return self.motion.caption

    @cached_property
    def shaking_force(self) -> VectorSignal:
        """Minus the rate of change of momentum, N."""
        return self._force(self.inertia)

    @cached_property
    def shaking_moment(self) -> Array:
        """Minus the rate of change of angular momentum about `about`, N m."""
        return self.shaking_moment_about(self.about)

    def shaking_moment_about(self, point: str | Vector | complex) -> Array:
        """Shaking moment, N m, about a point of the frame (its name) or (x, y) in m."""
        pole = in_frame(self.motion.machine.frame, point)
        return full(self.motion, -self.moment(self.inertia, pole), float)

    @cached_property
    def weight(self) -> VectorSignal:
        """Weight of all links, N: the same at every crank angle."""
        return self._force(self.weights)

    @cached_property
    def weight_moment(self) -> Array:
        """Moment of the weight about `about`, N m."""
        return full(self.motion, -self.moment(self.weights, self.about), float)

    @cached_property
    def solved(self) -> JointReactions:
        """The run over the joints that belongs to all demands together."""
        return self.solved_like(None)

    def solved_like(
        self, other: JointReactions | None, frictions: Mapping[str, JointFriction] | None = None
    ) -> JointReactions:
        """Forces with the flanks of couplings in contact that are so in another run.

        frictions : of joints by name, as in a machine of the same motion, instead of those that
            follow from these forces.
        """
        total = dict(self.inertia)
        for wrenches in (self.weights, self.loads, self.springs):
            for link, (force, moment) in wrenches.items():
                total[link] = (total[link][0] + force, total[link][1] + moment)
        if frictions is not None:
            return with_given_friction(self.motion, total, frictions, other)
        if self.rubs and self.motion.machine.rubs:
            return with_friction(self.motion, total, other)
        return reactions(self.motion, total, other)

    @property
    def frictions(self) -> Mapping[str, JointFriction]:
        """What joints resist their motion with, by name; of those that do."""
        return self.solved.friction

    @cached_property
    def plain_bearings(self) -> Mapping[str, PlainBearing]:
        """Pressure in pins whose radius and width are given, by name."""
        return plain_bearings(self.motion, self.joints)

    @cached_property
    def sections(self) -> Mapping[str, SectionLoads]:
        """Loads along links whose section is given, by link."""
        links = self.motion.machine.links.items()
        return {
            name: section_loads(self.motion, self.solved, name)
            for name, link in links
            if link.section is not None
        }

    @property
    def friction_loss(self) -> Array:
        """Power (N,) that all joints lose by friction, W."""
        losses = [friction.loss for friction in self.frictions.values()]
        return full(self.motion, sum(losses, start=np.zeros(())), float)

    @property
    def frame_force(self) -> VectorSignal:
        """Of all joints, springs and reactions of loads, N: the sum of shaking force, weight and
        loads from outside.
        """
        parts = (*self.springs.values(), *self.inner.values())
        return VectorSignal(self.solved.frame_force + sum(force for force, _ in parts))

    @property
    def frame_moment(self) -> Array:
        """Moment of all joints, springs, reactions of loads and of the drive on the frame about
        `about`, N m.
        """
        parts = self.moment(self.springs, self.about) + self.moment(self.inner, self.about)
        return np.asarray(self.solved.frame_moment(self.about) + parts)

    @property
    def outer(self) -> Forces:
        """Forces without what links and frame exert on each other: springs, and loads between."""
        outside = demands_of(self.motion, outer_loads(self.motion))
        return replace(self, loads=outside, springs={}, inner={})

    @property
    def flywheel_torque(self) -> float:
        """Torque that accelerates the flywheel, N m; rows on one shaft share it."""
        return self.motion.machine.drive.flywheel * self.motion.acceleration

    @property
    def power(self) -> Array:
        """Power fed in by all drives, W."""
        return np.asarray(sum(self._work_by_angle.values()) * self.motion.speed)

    @property
    def work(self) -> dict[str, float]:
        """Work of each drive in a cycle, J; crank angles have to be those of a whole cycle."""
        angle = 2 * np.pi * self.motion.turns * np.sign(self.motion.speed)
        return {
            link: float(self.motion.mean(column) * angle)
            for link, column in self._work_by_angle.items()
        }

    @property
    def work_both_ways(self) -> dict[str, float]:
        """Integral of the absolute power of each drive over a cycle, J, returned power counted like
        supplied: relative to it a `work` that is rounding differs from a loss by friction.
        """
        angle = 2 * np.pi * self.motion.turns
        return {
            link: float(self.motion.mean(np.abs(column)) * angle)
            for link, column in self._work_by_angle.items()
        }

    @cached_property
    def _work_by_angle(self) -> dict[str, Array]:
        """Work of each drive by crank angle (N,), N m, by the name of its link."""
        return {link: drive * self.motion.way(link) for link, drive in self.drives.items()}

    @cached_property
    def across(self) -> OutOfPlaneMoments:
        """What links beside each other do across the plane."""
        motion = self.motion
        loads = loads_across(motion)
        springs = springs_across(motion)
        outer = pushes_across(motion, outer_loads(motion))
        return OutOfPlaneMoments(
            motion, *masses_across(motion), loads, springs, exerted_in(self.solved), outer
        )

    @property
    def working_states(self) -> Sequence[WorkingState]:
        """States of the machine's duty, at the crank angles of these forces; these forces alone
        where it has no duty.
        """
        return self._duty_states if self.motion.machine.duty else (WorkingState(1.0, self),)

    @cached_property
    def _duty_states(self) -> Sequence[WorkingState]:
        return tuple(_duty_states(self))

    @cached_property
    def split(self) -> Split:
        """Every output by cause and by link."""
        return split(self)

    def at(
        self, speed: float | str | None = None, acceleration: float | str | None = None
    ) -> Forces:
        """Forces at another speed (rad/s) or acceleration (rad/s2), no position solved again."""
        return forces(self.motion.at(speed, acceleration), self.about)

    def _force(self, demands: Mapping[str, Demand]) -> VectorSignal:
        force, _ = self._resultant(demands, self.about)
        return VectorSignal(full(self.motion, -force, complex))

    def moment(self, demands: Mapping[str, Demand], about: complex) -> Any:
        """Moment of demands of links about a point, N m."""
        return self._resultant(demands, about)[1]

    def _resultant(self, demands: Mapping[str, Demand], about: complex) -> tuple[Any, Any]:
        state = self.motion.state
        return resultant(
            ((state[f"p({self.anchor(link)})"], *demand) for link, demand in demands.items()), about
        )

    def anchor(self, link: str) -> str:
        """The point of a link about which its demand's moment is taken."""
        return self.motion.linkage.anchors[link]


@dataclass(frozen=True, eq=False)
class WorkingState:
    """A machine in one state of its duty.

    share : of the operating time; the shares of all states sum up to 1.
    """

    share: float
    forces: Forces


def _duty_states(result: Forces) -> Iterator[WorkingState]:
    """States of the duty of a machine, at the crank angles of its forces."""
    motion, machine = result.motion, result.motion.machine
    total = sum(state.share for state in machine.duty)
    for state in machine.duty:
        speed = motion.speed if state.speed is None else copysign(state.speed, machine.drive.speed)
        loaded = replace(machine, loads=state.scaled(machine.loads), duty=())
        # loads do not move links, so that the positions are those of the analysis
        moving = replace(motion.at(speed), linkage=assemble(loaded))
        yield WorkingState(state.share / total, forces(moving, result.about))


def forces(motion: Motion, about: str | Vector | complex | None = None) -> Forces:
    """Forces of a machine in motion.

    Parameters
    ----------
    about : point about which moments are taken, a name or (x, y) in m; the drive pivot if None.

    Raises
    ------
    MassError : a link has no mass given.
    ModelError : the ends of a spring with a free length meet.
    UsageError : there is no such point.
    """
    machine = motion.machine
    if missing := massless(machine):
        raise MassError(missing)
    pole = in_frame(machine.frame, motion.linkage.pivot if about is None else about)
    rates = [
        (rate, _units(motion, k))
        for k, rate in enumerate((motion.speed**2, motion.acceleration))
        if rate
    ]
    inertia = {}
    for link in machine.links:
        own = inertia_moved(machine, link, motion.linkage.anchors[link])
        inertia[link] = _needed([(rate, units[link]) for rate, units in rates], *own)
    applied = (
        load_demands(motion),
        spring_demands(motion),
        inner_demands(motion),
    )
    return Forces(motion, pole, inertia, weight_demands(motion), *applied)


def weight_demands(motion: Motion, gravity: Array | complex | None = None) -> dict[str, Demand]:
    """What holds the weight of each link.

    gravity : m/s2, complex, in axes of the frame (N,) that tilts; that of the file if not given.
    """
    machine = motion.machine
    gravity = complex(*machine.gravity) if gravity is None else gravity
    return {
        link: kernels.weight_demand(
            motion.state[f"u({link})"],
            *inertia_about(machine.links[link], motion.linkage.anchors[link])[:2],
            gravity,
        )
        for link in machine.links
    }


UnitWrenches = tuple[Array, Array, Array, Array, Array]
"""Of a link: force for a unit of mass, and of first moment along x; moment for a unit of first
moment along x and along y, and of inertia."""
UNITS = "units({})"
"""Name of units in a state, by what they are for a unit of: 0, speed squared; 1, acceleration."""


def _units(motion: Motion, rate: int) -> Mapping[str, UnitWrenches]:
    """What units of inertial parameters demand; kept with the state, on which alone it depends."""
    name = UNITS.format(rate)
    if name not in motion.state:
        motion.state[name] = {link: _units_of(motion, link, rate) for link in motion.machine.links}
    units: Mapping[str, UnitWrenches] = motion.state[name]
    return units


def _units_of(motion: Motion, link: str, rate: int) -> UnitWrenches:
    mass, x, y, inertia = np.eye(4)[:, :, None]
    rates = (1.0, 0.0) if rate == 0 else (0.0, 1.0)
    force, turning = _inertia(motion, link, *rates, mass, x + 1j * y, inertia)
    return force[0], force[1], turning[1], turning[2], turning[3]


def _needed(
    rates: Sequence[tuple[float, UnitWrenches]], mass: float, moment: complex, inertia: float
) -> Demand:
    """What a link with these inertial parameters needs for its motion, which is linear in them."""
    forces, moments = [], []
    for rate, (of_mass, of_moment, of_x, of_y, of_inertia) in rates:
        first, x, y = rate * moment, rate * moment.real, rate * moment.imag
        forces.append(complex(rate * mass) * of_mass + first * of_moment)
        moments.append((rate * inertia) * of_inertia + x * of_x + y * of_y)
    return (forces[0], moments[0]) if len(rates) == 1 else (sum(forces), sum(moments))


def massless(machine: Machine) -> Note | None:
    """Say which links lack masses; empty where none does."""
    missing = [name for name, link in machine.links.items() if not link.has_mass]
    if not missing:
        return None
    return Note(
        "forces need mass, {center_of_mass} and inertia of every link; missing for {links} (a link "
        "to be neglected has mass 0)",
        links=", ".join(missing),
        **key_names("center_of_mass"),
    )


def assumed_masses(machine: Machine) -> Note | None:
    """Say the masses of which links are assumed; empty where all are given."""
    assumed = [name for name, link in machine.links.items() if any(b.assumed for b in link.bodies)]
    if not assumed:
        return None
    return Note(
        "the masses of {links} are assumed, and with them all forces; give masses, bodies or "
        "sections instead",
        links=", ".join(assumed),
    )


def inertia_about(body: Link, point: str) -> tuple[float, complex, float]:
    """Mass, first moment (complex) and moment of inertia of a link about one of its points.

    Columns where the numbers of the link are.
    """
    assert body.mass is not None and body.center_of_mass is not None and body.inertia is not None
    shift = planar(body.points[point]) - planar(body.center_of_mass)
    mass, moment, inertia = kernels.about(body.mass, 0.0, body.inertia, shift)
    return mass, moment, inertia


def inertia_moved(machine: Machine, link: str, point: str) -> tuple[float, complex, float]:
    """As `inertia_about`, with the flywheel that turns with the drive's link."""
    mass, moment, inertia = inertia_about(machine.links[link], point)
    return mass, moment, inertia + flywheel_on(machine, link)


def flywheel_on(machine: Machine, link: str) -> float:
    """Moment of inertia (kg m2) of what turns with a link beside it: the drive's flywheel."""
    return machine.drive.flywheel if link == machine.drive.link else 0.0


def demand_of_inertia(
    motion: Motion, link: str, speed2: float, mass: Any, moment: Any, inertia: Any
) -> Demand:
    """What moves a link with these inertial parameters about its anchor."""
    return _inertia(motion, link, speed2, motion.acceleration, mass, moment, inertia)


def _inertia(motion: Motion, link: str, *numbers: Any) -> Demand:
    """Demand of inertia at any speed squared and acceleration, which come first."""
    rates = (*p(motion.linkage.anchors[link])[1:], *u(link))
    force, turning = kernels.inertia_demand(*(motion.state[name] for name in rates), *numbers)
    return force, turning


def split(whole: Forces) -> Split:
    """Run the joints once for every cause and link."""
    motion, links = whole.motion, tuple(whole.inertia)
    causes = _causes_of(whole)
    shape = (len(causes), len(links), len(motion.crank_angle))
    demands = _split_demands(whole, causes, shape)
    frictions = _split_frictions(whole, causes, shape)
    solved = reactions(motion, _with_friction(whole, demands, frictions, shape), whole.solved)
    solved = replace(solved, friction=frictions)

    def preload_shares(coupling: Coupling) -> Array:
        """With the springs, and with the driven link."""
        own = np.zeros(shape)
        own[causes.index("spring"), links.index(coupling.driven)] = coupling.preload
        return own

    inertial = np.isin(causes, INERTIA)[:, None, None]
    # A spring's pull on the frame and what it makes the joints bear there cancel.
    on_frame = ~np.isin(causes, [*ELEMENTS])[:, None, None]
    frame_force = np.broadcast_to(on_frame * solved.frame_force, shape).copy()
    frame_moment = np.broadcast_to(on_frame * solved.frame_moment(whole.about), shape).copy()
    for link, demand in whole.inner.items():
        at = causes.index("load"), links.index(link)
        frame_force[at] += demand[0]
        frame_moment[at] += whole.moment({link: demand}, whole.about)
    return Split(
        inertial * -sum(force for force, _ in demands.values()),
        inertial * -whole.moment(demands, whole.about),
        frame_force,
        frame_moment,
        solved.drive_torque,
        solved.drives,
        solved.joints,
        solved.couplings(preload_shares),
        apart(whole.across, exerted_in(solved), shape) if motion.machine.has_planes else None,
        causes,
        links,
        drive_force=pushed(solved),
    )


def _causes_of(whole: Forces) -> tuple[str, ...]:
    """Of `CAUSES` those that every machine has, and those of the others that this one has."""
    own = {element.cause for _, _, element in whole.motion.machine.force_elements}
    own |= {*EVERYWHERE, *(("friction",) if whole.frictions else ())}
    return tuple(cause for cause in CAUSES if cause in own)


def _split_demands(
    whole: Forces, causes: Sequence[str], shape: tuple[int, ...]
) -> dict[str, Demand]:
    """Demands of each link by cause and link, (C, L, N), but for friction."""
    motion, demands = whole.motion, {}
    elements = {cause: spring_demands(motion, cause=cause) for cause in causes if cause in ELEMENTS}
    for k, link in enumerate(whole.inertia):
        force, moment = np.zeros(shape, complex), np.zeros(shape)
        by_cause = dict(zip(EVERYWHERE, _demands_everywhere(whole, link), strict=False))
        by_cause |= {cause: own[link] for cause, own in elements.items() if link in own}
        for cause, (f, m) in by_cause.items():
            c = causes.index(cause)
            force[c, k], moment[c, k] = f, m
        demands[link] = (force, moment)
    return demands


def _demands_everywhere(whole: Forces, link: str) -> list[Demand]:
    """Demands of a link in the order of `EVERYWHERE`, up to loads."""
    motion = whole.motion
    body = motion.machine.links[link]
    mass, moment, _ = inertia_about(body, whole.anchor(link))
    as_point = abs(moment) ** 2 / mass if mass else 0.0
    turning = (body.inertia or 0.0) + flywheel_on(motion.machine, link)
    speed2 = motion.speed**2
    return [
        demand_of_inertia(motion, link, speed2, mass, moment, as_point),
        demand_of_inertia(motion, link, speed2, 0.0, 0.0, turning),
        whole.weights[link],
        whole.loads.get(link, (0j, 0.0)),
    ]


def _with_friction(
    whole: Forces,
    demands: Mapping[str, Demand],
    frictions: Mapping[str, JointFriction],
    shape: tuple[int, ...],
) -> dict[str, Demand]:
    """Demands of a shape (C, L, N), with what holds friction on both bodies of each joint."""
    motion, total = whole.motion, dict(demands)
    joints = rubbing_joints(motion.linkage) if frictions else ()
    for joint, unit in zip(joints, unit_demands(motion, joints), strict=True):
        effort = frictions[joint.name].effort
        for body, own in unit.items():
            before = total.get(body) or (np.zeros(shape, complex), np.zeros(shape))
            force, moment = (part + effort * item for part, item in zip(before, own, strict=True))
            total[body] = force, moment
    return total


def _split_frictions(
    whole: Forces, causes: Sequence[str], shape: tuple[int, ...]
) -> dict[str, JointFriction]:
    """The friction of each joint, (C, L, N)."""
    links, joint_frictions = tuple(whole.inertia), {}
    for name, friction in whole.frictions.items():
        owner = friction.on if friction.on in links else friction.by
        effort = np.zeros(shape)
        effort[causes.index("friction"), links.index(owner)] = friction.effort
        joint_frictions[name] = replace(friction, effort=effort)
    return joint_frictions
