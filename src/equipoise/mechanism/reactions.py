"""Joint forces: the pass that turns what each link needs into the force in every joint.

The groups are run in reverse order; each hands what its outer joints must supply to the bodies
that carry them, and the pass ends at drive and frame.  It is linear in the demands.  Loads, soil
and springs make demands of their own.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from math import degrees
from typing import Any

import numpy as np

from equipoise.errors import ModelError
from equipoise.mechanism import kernels
from equipoise.mechanism.checks import Named
from equipoise.mechanism.field import Soil
from equipoise.mechanism.joint_forces import CamForce, JointForce, MeshForce, SliderForce
from equipoise.mechanism.loads import load_at
from equipoise.mechanism.model import FRAME
from equipoise.mechanism.motion import Motion
from equipoise.mechanism.pushing import pushes
from equipoise.mechanism.springs import Spring
from equipoise.mechanism.steps import Array, Call, Reaction, State, Step, run
from equipoise.mechanism.tip import surface_of, tip_link

PUSH = "D"
"""Name of the force of a drive that pushes, among the values of a pass."""
JOINTS = ("pin", "slider")
"""Kinds of reactions that are no push of a coupling."""
Demand = tuple[Any, Any]
"""Force (complex) and moment about a link's anchor, each (..., N) or the same at all angles."""


@dataclass(frozen=True, eq=False)
class Pass:
    """Joint forces of one run over the groups, for one demand or a stack of them.

    state : every value, by the names told in `mechanism.steps`; shapes (..., N).
    """

    motion: Motion
    state: State

    @cached_property
    def drive_torque(self) -> Array:
        """Torque of the drive on its link, N m."""
        return full(self.motion, self.state[f"M({self.motion.machine.drive.link})"], float)

    @cached_property
    def drive_force(self) -> Array:
        """Force with which the drive pushes its ends apart, or its sliding link ahead, N."""
        return full(self.motion, self.state[PUSH], float)

    @cached_property
    def frame_force(self) -> Array:
        """Sum of the forces of all joints on the frame, N, complex."""
        drive = self.motion.machine.drive.link
        return full(self.motion, -self.state[f"F({FRAME})"] - self.state[f"F({drive})"], complex)

    def frame_moment(self, about: complex) -> Array:
        """Moment of all joints and of the drive on the frame about a point, N m."""
        drive, pivot = self.motion.machine.drive.link, self.state[f"p({self.motion.linkage.pivot})"]
        about_pivot = -self.state[f"M({FRAME})"] - self.state[f"M({drive})"]
        moment: Array = about_pivot + kernels.cross(pivot - about, self.frame_force)
        return moment

    @property
    def joints(self) -> dict[str, JointForce]:
        """Pins and sliders, by name."""
        named = self.motion.linkage.named_reactions
        return Named("joint", ((n, self._joint(r)) for n, r in named if r.kind in JOINTS))

    @property
    def gears(self) -> dict[str, MeshForce]:
        """Pairs of gears, by name; the force is on the driven gear."""
        gears = (r for r in self.motion.linkage.reactions if r.kind == "gear")
        return Named("pair of gears", ((r.name, self._mesh(r)) for r in gears))

    @property
    def cams(self) -> dict[str, CamForce]:
        """Cams, by name; the force is on the follower."""
        cams = (r for r in self.motion.linkage.reactions if r.kind == "cam")
        return Named("cam", ((r.name, self._pressed(r)) for r in cams))

    @property
    def flanks(self) -> State:
        """Which flank of each pair of gears is in contact, by name in the state."""
        return {name: value for name, value in self.state.items() if name.startswith("flank(")}

    def _joint(self, reaction: Reaction) -> JointForce:
        order = self.motion.linkage.joints.bodies.index
        on, by, sign = reaction.on, reaction.by, 1
        if order(on) < order(by):
            on, by, sign = by, on, -1
        force = full(self.motion, sign * self.state[reaction.force], complex)
        if reaction.couple is None:
            return JointForce(force, on, by)
        slider = next(s for s in self.motion.machine.sliders if s.name == reaction.name)
        direction = self.state[f"u({slider.on})"] * np.exp(1j * slider.direction)
        at = self.state[f"p({reaction.at})"] - self.motion.points[slider.point].place
        moment = sign * self.state[reaction.couple] + kernels.cross(at, force)
        normal = kernels.cross(direction, force)
        return SliderForce(force, on, by, normal, full(self.motion, moment, float))

    def _mesh(self, reaction: Reaction) -> MeshForce:
        force = full(self.motion, self.state[reaction.force], complex)
        tangential = full(self.motion, self.state[f"T({reaction.name})"], float)
        gear = next(g for g in self.motion.machine.gears if g.name == reaction.name)
        pin = self.motion.linkage.joints.pins_between(gear.driven, gear.carrier)[0]
        lever = self.state[f"p({reaction.at})"] - self.state[f"p({pin})"]
        radial = -kernels.dot(lever, force) / abs(lever)
        return MeshForce(force, reaction.on, reaction.by, tangential, radial)

    def _pressed(self, reaction: Reaction) -> CamForce:
        force = full(self.motion, self.state[reaction.force], complex)
        normal = full(self.motion, self.state[f"T({reaction.name})"], float)
        return CamForce(force, reaction.on, reaction.by, normal)


def reactions(motion: Motion, demands: Mapping[str, Demand], like: Pass | None = None) -> Pass:
    """Joint forces that meet the demands of all links.

    demands : link -> force and moment about its anchor, of shapes (..., N).
    like : a pass whose gears are in contact on the same flanks; without it the demands tell.
    """
    if motion.machine.drive.pushes:
        return _pushed(motion, demands, like)
    return _passed(motion, demands, like)


def _pushed(motion: Motion, demands: Mapping[str, Demand], like: Pass | None) -> Pass:
    """The same where a force drives: as large as it takes for the link to need no torque."""
    drive = f"M({motion.machine.drive.link})"
    acting = ((body, at, way, 0.0) for body, at, way in pushes(motion))
    units = demands_of(motion, acting)
    still = dict.fromkeys(motion.machine.links, (0j, 0.0)) | units
    force = -_passed(motion, demands, like).state[drive] / _passed(motion, still, like).state[drive]
    total = dict(demands)
    for body, (unit, turning) in units.items():
        own = demands.get(body, (0j, 0.0))
        total[body] = own[0] + force * unit, own[1] + force * turning
    found = _passed(motion, total, like)
    found.state.update({drive: 0.0 * force, PUSH: force})
    return found


def _passed(motion: Motion, demands: Mapping[str, Demand], like: Pass | None) -> Pass:
    """The run over the joints, which ends at a torque on the drive's link."""
    state = dict(motion.state)
    of_links = dict(demands)
    on_frame = of_links.pop(FRAME, (0j, 0.0))
    of_links[FRAME] = 0j, 0.0
    for link, (force, moment) in of_links.items():
        state[f"F({link})"], state[f"M({link})"] = force, moment
    known = {} if like is None else like.flanks
    state.update(known)

    def is_known(step: Step) -> bool:
        return isinstance(step, Call) and set(step.outputs) <= known.keys()

    run([step for step in motion.linkage.forces if not is_known(step)], state)
    for name, more in zip((f"F({FRAME})", f"M({FRAME})"), on_frame, strict=True):
        state[name] = state[name] + more
    drive = motion.machine.drive.link
    state[f"R({motion.linkage.pivot}/{drive})"] = state[f"F({drive})"]
    return Pass(motion, state)


def pushed(found: Pass) -> Array | None:
    """Force of a drive that pushes, None of any other."""
    return found.drive_force if found.motion.machine.drive.pushes else None


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

MEETING = 1e-12
"""Of the coordinates of its ends: where they are closer, rounding decides where a spring points."""


def load_demands(motion: Motion) -> dict[str, Demand]:
    """What holds the loads, for every link that has one."""
    return demands_of(motion, _loads(motion))


def spring_demands(motion: Motion) -> dict[str, Demand]:
    """What holds the springs, for every link that has one.

    Raises
    ------
    ModelError : the ends of a spring with a free length meet.
    """
    return demands_of(motion, _pulls(motion))


def _pulls(motion: Motion) -> Iterator[Acting]:
    """Link, point and force of each end of a spring that is on a link."""
    for one in motion.machine.springs:
        force = spring_force(motion, one)
        yield one.link, one.point, force, 0.0
        if one.on != FRAME:
            yield one.on, one.to, -force, 0.0


def demands_of(motion: Motion, acting: Iterable[Acting]) -> dict[str, Demand]:
    """What holds forces (complex, N) and torques (N m), for every link that has one."""
    result: dict[str, Demand] = {}
    for link, point, force, torque in acting:
        anchor = motion.state[f"p({motion.linkage.anchors[link]})"]
        named = isinstance(point, str)
        at = anchor if point is None else motion.points[point].place if named else point
        f, m = kernels.load_demand(anchor, at, force, torque)
        before = result.get(link, (0.0, 0.0))
        result[link] = (before[0] + f, before[1] + m)
    return result


def _loads(motion: Motion) -> Iterator[Acting]:
    """Link, point, force and torque of each load."""
    machine = motion.machine
    for load in machine.loads:
        yield load.link, load.point, *load_at(load, motion.crank_angle)
    if machine.planting is not None and machine.planting.soil is not None:
        for arm in machine.planting.every_arm:
            yield tip_link(machine, arm.tip), arm.tip, soil_force(motion, arm.tip), 0.0


def soil_force(motion: Motion, tip: str | None = None) -> Array:
    """Force of the soil on a tip (N,), N, complex; 0 above the surface.

    tip : of any arm; of the first where not given.

    Raises
    ------
    ModelError : the machine has no `[planting]`.
    MotionError : its crank cannot turn fully, so that no lowest point tells where the surface is.
    """
    planting = motion.machine.planting
    if planting is None or planting.soil is None:
        return np.zeros(len(motion.crank_angle), complex)
    point = motion.points[tip or planting.tip]
    depth = surface_of(motion.machine) - point.y
    over_ground = point.velocity + planting.forward(motion.speed)
    speed = np.abs(over_ground)
    size = np.where(depth > 0, resistance(planting.soil, depth, speed), 0.0)
    against = np.divide(-over_ground, speed, out=np.zeros_like(over_ground), where=speed > 0)
    return size * against


def resistance(soil: Soil, depth: Array, speed: Array) -> Array:
    """Size of the force (N,), N, at depths (N,), m, and speeds over ground (N,), m/s."""
    size = soil.resistance + soil.per_depth * depth + soil.per_speed * speed
    size = size + soil.per_depth_and_speed * depth * speed
    if soil.table is not None:
        size = size + np.interp(depth, soil.table.depth, soil.table.resistance)
    return size


def spring_force(motion: Motion, spring: Spring) -> Any:
    """Force of a spring on its link's point (N,), N, complex; minus this on its other end.

    Raises
    ------
    ModelError : its ends meet, so that a spring with a free length points nowhere.
    """
    if spring.free_length:
        spring_direction(motion, spring.link, spring.point, spring.to)
    place, to = motion.points[spring.point].place, motion.points[spring.to].place
    return kernels.spring(place, to, spring.stiffness, spring.free_length)


def spring_vector(motion: Motion, point: str, to: str) -> Any:
    """From a point to another, both ends of a spring (N,), m, complex."""
    return motion.points[to].place - motion.points[point].place


def spring_direction(motion: Motion, link: str, point: str, to: str) -> Any:
    """Unit vector from a spring's end on a link to its other end (N,), complex.

    Raises
    ------
    ModelError : they meet.
    """
    along = spring_vector(motion, point, to)
    length = abs(along)
    coordinates = abs(motion.points[point].place) + abs(motion.points[to].place)
    meeting = length <= MEETING * coordinates
    if meeting.any():
        angle = degrees(motion.crank_angle[meeting.argmax()])
        raise ModelError(
            "springs",
            f"{point!r} of {link!r} meets {to!r} at crank angle {angle:.6g} deg, where a spring "
            "with a free length points nowhere; give another point, or a free_length of 0",
        )
    return along / length
