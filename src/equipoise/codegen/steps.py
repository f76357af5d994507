"""The steps of a linkage in terms, in order: motion, applied forces, joint forces.

What each design has of its own is a slot, with a function that finds it in the design's linkage.
A motion that no design changes is that of the base, as rows over the crank angle: where joints hold
more than a motion needs, lengths have to agree, and designs of a loop differ in masses, speed and
what acts only.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from functools import partial
from itertools import chain
from typing import Any

import numpy as np

from equipoise.codegen.coupled import (
    TracedCurve,
    slotted,
    trace_displacement,
    trace_relation,
    trace_rolled,
)
from equipoise.codegen.loops import trace_loop_forces, trace_loops
from equipoise.codegen.redundant_forces import trace_shared
from equipoise.codegen.strokes import TracedStrokes, trace_pushes
from equipoise.codegen.terms import VectorTerm, angle_of, rotation
from equipoise.codegen.trace import FAR, LinkageReader, Trace, running_angle
from equipoise.dataclass import dataclass
from equipoise.errors import MassError
from equipoise.keys import with_fields
from equipoise.mechanism.assembly.contacts import Displacement, RelationCall, RollingCall
from equipoise.mechanism.assembly.linkage import Linkage
from equipoise.mechanism.assembly.loopgroup import LoopForces
from equipoise.mechanism.assembly.loops import LoopGroup
from equipoise.mechanism.assembly.redundant_reactions import RedundantReactions
from equipoise.mechanism.assembly.steps import (
    KernelCall,
    Rotation,
    RunningAngle,
    Step,
    demand_names,
    p,
    planar,
    resultant,
    size_of_bodies,
    u,
)
from equipoise.mechanism.dynamics.forces import inertia_moved, massless
from equipoise.mechanism.dynamics.loads import (
    axis_of,
    load_at,
    load_on_links,
    own_axis,
    preload_on_links,
    preload_rate,
    soil_at,
)
from equipoise.mechanism.dynamics.out_of_plane import (
    contacts,
    held_across,
    held_between,
    held_preload,
    statics,
)
from equipoise.mechanism.dynamics.reactions import (
    Acting,
    HoldingWrench,
    added_up,
    holding_wrench,
)
from equipoise.mechanism.formulas import kernels
from equipoise.mechanism.kinematics.indicators import loads_of
from equipoise.mechanism.kinematics.motion import ROUNDING, StateBodies, track_of
from equipoise.mechanism.kinematics.tip import surface_of, tip_link
from equipoise.mechanism.parts.element_kinds import Element, ForceElement
from equipoise.mechanism.parts.field import PARTS
from equipoise.mechanism.parts.joint_kinds import joint_kinds
from equipoise.mechanism.parts.links import moments_across
from equipoise.mechanism.parts.machine import FRAME, Drive, FurtherDrive, Load
from equipoise.signals import Array

SURFACE = "surface"
"""Name of the slot of the soil's height in the frame."""
ANGLE_MARGIN = 0.4
"""Added to the cosine of an angle, which is watched as that of a running angle is: beyond 154 deg
from its middle a design is computed by itself."""


def trace_load(trace: Trace, number: int, load: Load) -> list[Acting]:
    """What the load of this number, from 1 on, exerts at each of its ends on a link."""
    x, y, torque = (
        trace.row(f"load {number} {key}", partial(_part_of_load, load, key))
        for key in ("x", "y", "torque")
    )
    own = 1.0 + 0j
    if load.axes == "slider":

        def turn(linkage: Linkage) -> Any:
            return own_axis(linkage.machine.loads[number - 1], linkage.machine)

        own = trace.slot(f"load {number} axes", turn, vector=True)
    axis = axis_of(load, TracedBodies(trace, f"loads[{number}]"), own)
    return [*load_on_links(load, VectorTerm(x, y) * axis, torque)]


def _part_of_load(load: Load, key: str, theta: Array) -> Array:
    force, torque = load_at(load, theta)
    return np.asarray({"x": force.real, "y": force.imag, "torque": torque}[key] + 0.0 * theta)


def trace_soil(trace: Trace) -> Iterator[Acting]:
    """What the soil exerts on the tip of each planting arm."""
    planting = trace.machine.planting
    if planting is None or planting.soil is None:
        return
    surface = trace.slot(SURFACE, lambda linkage: surface_of(linkage.machine), cyclic=True)
    forward = trace.slot("forward", _forward)
    given = {part: trace.slot(f"soil {part}", partial(_of_soil, part)) for part in PARTS}
    soil = with_fields(planting.soil, **given)
    at = TracedBodies(trace, "planting")
    for arm in planting.every_arm:
        link = tip_link(trace.machine, arm.tip)
        force = soil_at(soil, at, (link, arm.tip), surface, forward)
        yield link, arm.tip, force, 0.0


def _forward(linkage: Linkage) -> Any:
    machine = linkage.machine
    assert machine.planting is not None
    return machine.planting.forward(machine.drive.speed)


def _of_soil(part: str, linkage: Linkage) -> Any:
    planting = linkage.machine.planting
    assert planting is not None
    return getattr(planting.soil, part)


@dataclass(frozen=True)
class TracedBodies(StateBodies):
    """Bodies in terms, for the outputs of an element and what it exerts.

    name : of the element.
    """

    trace: Trace
    name: str

    @property
    def state(self) -> Mapping[str, Any]:
        return self.trace.state

    @property
    def speed(self) -> Any:
        return self.trace.rate("speed")

    def curve(self, joint: str) -> TracedCurve:
        return TracedCurve(self.trace, track_of(self.trace.linkage, joint))

    def point(self, body: str, point: str) -> Any:
        """A point in the frame."""
        on_frame = body == FRAME
        return self.trace.state[f"p({point})"] if on_frame else self.trace.point(body, point)[0]

    def velocity(self, body: str, point: str) -> Any:
        """Velocity of a point in the frame, m/s."""
        if body == FRAME:
            return 0j
        return self.trace.point(body, point)[1] * self.speed

    def angle(self, body: str, on: str, middle: Any) -> Any:
        """Angle of a body from the x axis of another, within half a turn of `middle`."""
        away = self.away(body, on, middle)
        self.trace.running[f"{self.name}, {body} on {on}"] = away.real + ANGLE_MARGIN
        return middle + angle_of(away)

    def within(self, value: Any, ends: tuple[Any, Any], wrong: str) -> None:
        """Watch a value, so that a design in which it leaves its range is computed by itself."""
        for what, margin in (("lower", value - ends[0]), ("upper", ends[1] - value)):
            self.trace.running[f"{self.name}, {what} end"] = margin + (FAR + ROUNDING)


def trace_limits(trace: Trace) -> None:
    """Watch whether pins stay in their slots."""
    for table in joint_kinds(type(trace.machine)):
        for number in range(len(getattr(trace.machine, table))):
            element, at = traced_element(trace, table, number)
            element.values(at)


def trace_element(trace: Trace, table: str, number: int) -> Iterator[Acting]:
    """What a force element exerts at each of its ends on a link.

    table, number : its list in the file, and its place there from 0.
    """
    element, at = traced_element(trace, table, number)
    assert isinstance(element, ForceElement)
    yield from element.on_links(at)


def traced_element(trace: Trace, table: str, number: int) -> tuple[Element, TracedBodies]:
    """An element with terms for its numbers, and the bodies between which it acts."""
    name = f"{table}[{number}]"

    def read(linkage: Linkage) -> Element:
        element: Element = getattr(linkage.machine, table)[number]
        return element

    element: Element = slotted(trace, read(trace.linkage), name, read)
    return element, TracedBodies(trace, name)


def trace_preload(trace: Trace, number: int) -> Iterator[Acting]:
    """What the preload of the coupling of this number exerts on its links, if it has one."""
    coupling = trace.machine.couplings[number]
    if not coupling.preload:
        return

    def rate(linkage: Linkage) -> Any:
        return preload_rate(linkage, linkage.machine.couplings[number])

    at = TracedBodies(trace, coupling.name)
    rate_term = trace.slot(f"preload rate({number})", rate)
    yield from preload_on_links(trace.linkage, coupling, rate_term, at)


def trace_wrenches(trace: Trace, acting: Iterable[Acting]) -> list[HoldingWrench]:
    """What holds forces at points of links, and torques on them."""
    bodies = trace.machine.bodies

    def place_of(link: str, point: str) -> Any:
        body = link if point in bodies[link] else next(b for b in bodies if point in bodies[b])
        return TracedBodies(trace, point).point(body, point)

    return [holding_wrench(trace.body(item[0])[0], place_of, item) for item in acting]


@dataclass(frozen=True)
class TracedForces:
    """What acts on the links of a linkage beside its joints, in terms.

    loads : each with what it exerts at its ends.
    soil, elements : what the soil, and what force elements exert.
    preloads : driven link of each coupling, with what its preload exerts.
    """

    loads: Sequence[tuple[Load, list[Acting]]]
    soil: Sequence[Acting]
    elements: Sequence[Acting]
    preloads: Sequence[tuple[str, list[Acting]]]

    @classmethod
    def of(cls, trace: Trace) -> TracedForces:
        machine = trace.machine
        loads = enumerate(loads_of(trace.linkage), 1)
        couplings = enumerate(machine.couplings)
        return cls(
            [(load, trace_load(trace, k, load)) for k, load in loads],
            [*trace_soil(trace)],
            [
                acting
                for table, number, _ in machine.force_elements
                for acting in trace_element(trace, table, number)
            ],
            [(coupling.driven, [*trace_preload(trace, k)]) for k, coupling in couplings],
        )

    @property
    def outer(self) -> list[Acting]:
        """What comes from outside of the machine."""
        loads = (acting for load, acting in self.loads if load.is_external)
        return [*chain(*loads), *self.soil]

    @property
    def every(self) -> list[Acting]:
        """All of it, on every link."""
        loads, preloads = (acting for _, acting in self.loads), (ends for _, ends in self.preloads)
        return [*chain(*loads, self.soil, self.elements, *preloads)]


def trace_across(trace: Trace, acting: TracedForces) -> None:
    """Add ``Q(link)``, the sum of planes times forces that each link needs, and ``rocking
    moment`` and ``frame rocking moment`` of all of them.
    """
    machine, state = trace.machine, trace.state
    moving, needed = [], {}
    speed, acceleration = trace.rate("speed"), trace.rate("acceleration")
    for link in machine.links:
        _, p1, p2, turn, w, a = trace.body(link)
        mass, moment = (
            trace.slot(f"{key} across({link})", _moment(trace.linkage, link, place), place == 1)
            for place, key in enumerate(("mass", "moment"))
        )
        rates = (speed * speed, acceleration)
        inertia, _ = kernels.inertia_demand(p1, p2, turn, w, a, *rates, mass, moment, 0.0)
        weight, _ = kernels.weight_demand(turn, mass, moment, state["gravity"])
        moving.append(inertia)
        needed[link] = [inertia, weight]
    state["rocking moment"] = _about(moving)
    of_links, plane = [*chain(*needed.values())], partial(_plane, trace)
    outer = (value for _, value in held_across(acting.outer, plane))
    state["frame rocking moment"] = _about((*of_links, *outer))
    held = [held_across(acting.soil, plane), held_across(acting.elements, plane)]
    held += [held_between(load, ends, plane) for load, ends in acting.loads]
    held += [held_preload(driven, ends, plane) for driven, ends in acting.preloads]
    for link, value in chain(*held):
        needed[link].append(value)
    for link, values in needed.items():
        state[f"Q({link})"] = sum(values)


def _about(forces: Iterable[Any]) -> Any:
    """Moment on the frame about x and y."""
    return -1j * sum(forces)


def _plane(trace: Trace, link: str, point: str | None) -> Any:
    name = f"plane({link}/{point})"
    return trace.slot(name, lambda linkage: linkage.machine.links[link].plane_of(point))


def bearing_force(trace: Trace, bearing: str, exerted: Callable[[str], Any]) -> Any:
    """The force of a bearing: both of a link bear what its pin in the frame does, with its couple.

    Analyses have that couple as an output and take it as a number; here the plane of the pin is
    collected with those of other contacts first, as it cancels wherever the pin bears what its link
    needs, and no design has to read it.

    exerted : the force in a joint or mesh, by name.
    """
    given = trace.machine.bearings
    on_link = [name for name in given if given[name].link == given[bearing].link]
    first = on_link.index(bearing)
    own, other = (_bearing_plane(trace, on_link[k]) for k in (first, 1 - first))
    solved = statics(trace.linkage)
    number, pin = solved.pin_of(given[bearing].link)
    needed, by_plane = solved.factors(number)
    force = sum(factor * trace.state[f"Q({link})"] for link, factor in needed.items())
    for place, contact in enumerate(solved.contacts):
        factor = by_plane.get(contact.name, 0.0) + (contact.name == pin.name)
        if factor:
            force = force + factor * _joint_plane(trace, place) * exerted(contact.name)
    return (force - other * exerted(pin.name)) * (1 / (own - other))


def _bearing_plane(trace: Trace, name: str) -> Any:
    return trace.slot(f"plane of {name}", lambda linkage: linkage.machine.bearings[name].plane)


def _joint_plane(trace: Trace, place: int) -> Any:
    return trace.slot(f"plane of joint {place}", lambda linkage: contacts(linkage)[place].plane)


def _moment(linkage: Linkage, link: str, place: int) -> LinkageReader:
    anchor = linkage.anchors[link]
    return lambda linkage: moments_across(linkage.machine.links[link], anchor)[place]


# -- motion ----------------------------------------------------------------------------------------


def trace_frame(trace: Trace) -> None:
    """Points of the frame, which stand still."""
    for name in trace.machine.frame:
        place = trace.slot(f"p({name})", partial(_frame_point, name), vector=True)
        trace.put(p(name), (place, 0j, 0j))


def trace_motion(trace: Trace) -> None:
    """The steps from the crank angle to every link, or what they come to for all designs."""
    trace_frame(trace)
    if trace.fixed:
        trace_prescribed(trace)
    else:
        _trace_steps(trace)
    trace_limits(trace)


def _trace_steps(trace: Trace) -> None:
    machine = trace.machine
    driven = {item.link: _driven(trace, item) for item in machine.driven if not item.pushes}
    if machine.pushers:
        driven |= TracedStrokes(trace, partial(run_motion, trace), driven).turned()
    run_motion(trace, driven)


def run_motion(trace: Trace, driven: Mapping[str, tuple[Any, Any, Any, Any]]) -> None:
    """From the angles of driven links, with their rotations and rates, to every link."""
    for link, (angle, *values) in {FRAME: (0.0, 1 + 0j, 0.0, 0.0), **driven}.items():
        trace.put(u(link), values)
        trace.state[f"phi({link})"] = angle
    for number, step in enumerate(trace.linkage.motion):
        trace_step(trace, step, "motion", number)


def _driven(trace: Trace, drive: Drive | FurtherDrive) -> tuple[Any, Any, Any, Any]:
    """Angle, rotation and rates of a driven link, which no design changes."""
    if trace.machine.has_crank:
        return trace.theta, rotation(trace.theta), 1.0, 0.0
    angle, first, second = (
        trace.row(f"{name}({drive.link})", partial(_turned, drive, place))
        for place, name in enumerate(("angle", "first", "second"))
    )
    return angle, rotation(angle), first, second


def _turned(drive: Drive | FurtherDrive, place: int, theta: Array) -> Array:
    return np.asarray(drive.turned(theta)[place] + 0.0 * theta)


def _frame_point(name: str, linkage: Any) -> Any:
    return planar(linkage.machine.frame[name])


def trace_step(trace: Trace, step: Step, steps: str, number: int) -> None:
    """A step, the one of this number of a linkage's ``motion`` or ``forces``."""
    if isinstance(step, RunningAngle):
        running_angle(trace, step.link)
    elif isinstance(step, Rotation):
        if step.link not in trace.rotated:
            trace.state[f"u({step.link})"] = rotation(trace.state[f"phi({step.link})"])
    elif isinstance(step, RelationCall):
        trace_relation(trace, step, number)
    elif isinstance(step, RollingCall):
        trace_rolled(trace, step, number)
    elif isinstance(step, KernelCall):
        _trace_call(trace, step, steps, number)
    elif isinstance(step, Displacement):
        trace_displacement(trace, step, number)
    elif isinstance(step, LoopGroup):
        trace_loops(trace, number)
    elif isinstance(step, LoopForces):
        (trace_shared if isinstance(step, RedundantReactions) else trace_loop_forces)(trace, number)


def _trace_call(trace: Trace, step: KernelCall, steps: str, number: int) -> None:
    inputs = [trace.state[name] for name in step.inputs]
    known = list(inspect.signature(step.kernel).parameters)[len(inputs) :]
    numbers = [
        value if isinstance(value, int) else trace.slot(
            f"{parameter} of {step.outputs[-1]}",
            _parameter(steps, number, place),
            isinstance(value, complex | np.complexfloating),
        )
        for place, (parameter, value) in enumerate(zip(known, step.parameters, strict=True))
    ]  # fmt: skip
    trace.put(step.outputs, step.kernel(*inputs, *numbers))
    if step.kernel is kernels.rpr:
        size = trace.slot("size", lambda linkage: size_of_bodies(linkage.machine))
        way = (inputs[0] - inputs[3]) * (1 / size)
        trace.apart[step.outputs[-1]] = kernels.dot(way, way)


def _parameter(steps: str, number: int, place: int) -> LinkageReader:
    return lambda linkage: getattr(linkage, steps)[number].parameters[place]


STANDING = 1e-13
"""Of the size of the machine, or of a rotation: what moves by less than this stands still."""
PROBED = 0.1 + np.arange(90) * 0.31
"""Crank angles (K,), rad, at which it is seen whether something moves."""


def trace_prescribed(trace: Trace) -> None:
    """Add where each link is, and the numbers of dyads."""
    linkage, probed = trace.linkage, trace.base.at(PROBED)
    size = float(size_of_bodies(linkage.machine))
    for link in linkage.joints.bodies:
        anchor = linkage.anchors[link]
        for name in () if f"p({anchor})" in trace.state else p(anchor):
            trace.state[name] = _vector(trace, name, size)
        turn, *rates = u(link)
        trace.state[turn] = _vector(trace, turn, 1.0)
        for name in rates:
            trace.state[name] = _number(trace, name, "real", 1.0)
    inputs = {
        name for step in linkage.forces if isinstance(step, KernelCall) for name in step.inputs
    }
    for name in sorted(inputs & probed.keys() - trace.state.keys()):
        vector = np.iscomplexobj(probed[name])
        trace.state[name] = (_vector(trace, name, size) if vector
                             else _number(trace, name, "real", 1.0))  # fmt: skip
    for group in linkage.groups:
        if group.margin is not None and not group.through:
            trace.state[group.margin] = _number(trace, group.margin, "real", 1.0)


def _vector(trace: Trace, name: str, size: float) -> VectorTerm:
    return VectorTerm(*(_number(trace, name, part, size) for part in ("real", "imag")))


def _number(trace: Trace, name: str, part: str, size: float) -> Any:
    """A number where it stands still, else a row."""
    values = trace.base.part(name, part, PROBED)
    middle = float(np.max(values) + np.min(values)) / 2
    if np.ptp(values) <= STANDING * size:
        return 0.0 if abs(middle) <= STANDING * size else middle
    return trace.base_row(name, part)


# -- forces ----------------------------------------------------------------------------------------


def trace_demands(trace: Trace) -> None:
    """What moves every link and what holds its weight, loads and force elements.

    Then what the frame and the drive get, while the demands are still those of the links alone:
    ``shaking force``, ``shaking moment``, ``frame force``, ``frame moment`` and ``drive torque``.

    Raises
    ------
    MassError : a link has no mass given.
    """
    if missing := massless(trace.machine):
        raise MassError(missing)
    machine, state = trace.machine, trace.state
    moving, weights = trace_inertia(trace)
    acting = TracedForces.of(trace)
    if machine.has_planes:
        trace_across(trace, acting)
    _on_frame(trace, "shaking", moving)
    _on_frame(trace, "frame", [*moving, *weights, *trace_wrenches(trace, acting.outer)])
    demands = added_up([*moving, *weights, *trace_wrenches(trace, acting.every)])
    for link in trace.linkage.joints.bodies[1:]:
        state.update(zip(demand_names(link), demands.get(link, (0.0, 0.0)), strict=True))
    if machine.has_crank:  # else work does not determine the torque of each drive
        state["drive torque"] = sum(_drive_torques(trace))


def trace_inertia(trace: Trace) -> tuple[list[HoldingWrench], list[HoldingWrench]]:
    """What moves every link, and what holds its weight."""
    speed, acceleration = trace.rate("speed"), trace.rate("acceleration")
    gravity = trace.slot("gravity", lambda linkage: planar(linkage.machine.gravity), vector=True)
    trace.state["gravity"] = gravity
    moving, weights = [], []
    for link in trace.machine.links:
        _, p1, p2, turn, w, a = trace.body(link)
        body = inertial(trace, link)
        rates = (speed * speed, acceleration)
        moving.append((link, *kernels.inertia_demand(p1, p2, turn, w, a, *rates, *body)))
        weights.append((link, *kernels.weight_demand(turn, body[0], body[1], gravity)))
    return moving, weights


def inertial(trace: Trace, link: str) -> tuple[Any, Any, Any]:
    """Mass of a link, its moment and inertia about its anchor."""
    mass, moment, inertia = (
        trace.slot(f"{key}({link})", _inertial(trace, link, place), vector=place == 1)
        for place, key in enumerate(("mass", "moment", "inertia"))
    )
    return mass, moment, inertia


def _inertial(trace: Trace, link: str, place: int) -> LinkageReader:
    anchor = trace.linkage.anchors[link]
    return lambda linkage: inertia_moved(linkage.machine, link, anchor)[place]


def _on_frame(trace: Trace, what: str, demands: list[HoldingWrench]) -> None:
    """Force and moment, about the drive's pivot, that these demands exert on the frame."""
    wrenches = ((trace.body(link)[0], force, moment) for link, force, moment in demands)
    force, moment = resultant(wrenches, trace.state[f"p({trace.linkage.pivot})"])
    trace.state[f"{what} force"], trace.state[f"{what} moment"] = -force, -moment


def _drive_torques(trace: Trace) -> Iterable[Any]:
    """What each link takes of the drive torque."""
    for link in trace.machine.links:
        _, p1, _, _, w, _ = trace.body(link)
        yield kernels.drive_torque(p1, w, *(trace.state[name] for name in demand_names(link)))


def trace_joints(trace: Trace) -> None:
    """The pass from demands to the force in every joint."""
    if trace.machine.pushers:
        trace_pushes(trace, TracedBodies(trace, "drives"), partial(_run_forces, trace))
    else:
        _run_forces(trace)
    for drive in trace.machine.driven:
        pivot = trace.linkage.anchors[drive.link]
        trace.state[f"R({pivot}/{drive.link})"] = trace.state[f"F({drive.link})"]
    if not trace.machine.has_crank:
        trace.state["drive torque"] = trace.state[f"M({trace.machine.drive.link})"]


def _run_forces(trace: Trace) -> None:
    trace.put(demand_names(FRAME), (0j, 0.0))
    for number, step in enumerate(trace.linkage.forces):
        trace_step(trace, step, "forces", number)
