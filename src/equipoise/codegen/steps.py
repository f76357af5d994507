"""The steps of a linkage in terms, in order: its motion, what each link demands of its joints, and
the pass over the joints.

What each design has of its own is a slot, with a function that finds it in the design's linkage.
"""

from __future__ import annotations

import inspect
from collections.abc import Iterable
from functools import partial
from typing import Any

import numpy as np

from equipoise.codegen.across import trace_across
from equipoise.codegen.applied import (
    HoldingWrench,
    trace_element,
    trace_limits,
    trace_load,
    trace_preload,
)
from equipoise.codegen.coupled import (
    trace_coupling,
    trace_displacement,
    trace_law,
    trace_rolled,
    trace_swung,
)
from equipoise.codegen.loop_forces import trace_loop_forces
from equipoise.codegen.loops import trace_loops
from equipoise.codegen.prescribed import trace_prescribed
from equipoise.codegen.shared_forces import trace_shared
from equipoise.codegen.terms import rotation
from equipoise.codegen.trace import Array, Read, Trace, links_of, running_angle
from equipoise.errors import MassError
from equipoise.mechanism.assembly.cam_groups import Displacement
from equipoise.mechanism.assembly.flanks import rolled
from equipoise.mechanism.assembly.loopgroup import LoopForces
from equipoise.mechanism.assembly.newton import LoopGroup
from equipoise.mechanism.assembly.shared import RedundantReactions
from equipoise.mechanism.assembly.steps import (
    KernelCall,
    Rotation,
    RunningAngle,
    Step,
    demand_names,
    p,
    planar,
    size_of_bodies,
    u,
)
from equipoise.mechanism.dynamics.forces import inertia_moved, massless
from equipoise.mechanism.formulas import cam_kernels, kernels
from equipoise.mechanism.parts.couplings import coupled
from equipoise.mechanism.parts.machine import FRAME, Drive, FurtherDrive

# -- motion ----------------------------------------------------------------------------------------


def trace_motion(trace: Trace) -> None:
    """The steps from the crank angle to every link, or what they come to for all designs."""
    for name in trace.machine.frame:
        place = trace.slot(f"p({name})", partial(_frame_point, name), vector=True)
        trace.put(p(name), (place, 0j, 0j))
    if trace.fixed:
        trace_prescribed(trace)
    else:
        _trace_steps(trace)
    trace_limits(trace)


def _trace_steps(trace: Trace) -> None:
    driven = {drive.link: _driven(trace, drive) for drive in trace.machine.driven}
    for link, (angle, *values) in ({FRAME: (0.0, 1 + 0j, 0.0, 0.0)} | driven).items():
        trace.put(u(link), values)
        if trace.counted:
            trace.state[f"phi({link})"] = angle
    for number, step in enumerate(trace.linkage.motion):
        trace_step(trace, step, "motion", number)


def _driven(trace: Trace, drive: Drive | FurtherDrive) -> tuple[Any, Any, Any, Any]:
    """Angle, rotation and rates of a driven link, which no design changes."""
    if trace.machine.has_crank:
        return trace.theta, trace.turned(1.0), 1.0, 0.0
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
        if trace.counted and step.link not in trace.rotated:
            trace.state[f"u({step.link})"] = rotation(trace.state[f"phi({step.link})"])
    elif isinstance(step, KernelCall):
        if step.kernel is coupled and links_of(step)[-1] in trace.loose:
            trace_law(trace, step, number)
        elif step.kernel is coupled or (step.kernel is kernels.in_ratio and not trace.counted):
            trace_coupling(trace, step)
        elif step.kernel is rolled:
            trace_rolled(trace, step, number)
        elif step.kernel is cam_kernels.swung and not trace.counted:
            trace_swung(trace, step, number)
        else:
            _trace_call(trace, step, steps, number)
    elif isinstance(step, Displacement):
        trace_displacement(trace, step)
    elif isinstance(step, LoopGroup):
        trace_loops(trace, number)
    elif isinstance(step, LoopForces):
        (trace_shared if isinstance(step, RedundantReactions) else trace_loop_forces)(trace, number)


def _trace_call(trace: Trace, step: KernelCall, steps: str, number: int) -> None:
    inputs = [trace.state[name] for name in step.inputs]
    known = list(inspect.signature(step.kernel).parameters)[len(inputs) :]
    numbers = [
        trace.slot(
            f"{parameter} of {step.outputs[-1]}",
            _parameter(steps, number, place),
            isinstance(value, complex | np.complexfloating),
        )
        for place, (parameter, value) in enumerate(zip(known, step.parameters, strict=True))
    ]
    trace.put(step.outputs, step.kernel(*inputs, *numbers))
    if step.kernel is kernels.rpr:
        size = trace.slot("size", lambda linkage: size_of_bodies(linkage.machine))
        way = (inputs[0] - inputs[3]) * (1 / size)
        trace.apart[step.outputs[-1]] = kernels.dot(way, way)


def _parameter(steps: str, number: int, place: int) -> Read:
    return lambda linkage: getattr(linkage, steps)[number].parameters[place]


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
    moving, weights = _inertia(trace)
    loads = [trace_load(trace, k, load) for k, load in enumerate(machine.loads, 1)]
    springs = [
        wrench
        for table, number, _ in machine.force_elements
        for wrench in trace_element(trace, table, number)
    ]
    springs += [held for k in range(len(machine.couplings)) for held in trace_preload(trace, k)]
    if machine.has_planes:
        trace_across(trace, [force for _, force, _ in loads], [force for _, force, _ in springs])
    _on_frame(trace, "shaking", moving)
    each = zip(machine.loads, loads, strict=True)
    outer = [held for load, held in each if load.reaction is None]
    _on_frame(trace, "frame", [*moving, *weights, *outer])
    for link in trace.linkage.joints.bodies[1:]:
        parts = [held for held in (*moving, *weights, *loads, *springs) if held[0] == link]
        force, moment = demand_names(link)
        state[force] = sum(force for _, force, _ in parts)
        state[moment] = sum(moment for _, _, moment in parts)
    if machine.has_crank:  # else work does not tell the torque of each drive
        state["drive torque"] = sum(_drive_torques(trace))


def _inertia(trace: Trace) -> tuple[list[HoldingWrench], list[HoldingWrench]]:
    """What moves every link, and what holds its weight."""
    speed, acceleration = trace.rate("speed"), trace.rate("acceleration")
    gravity = trace.slot("gravity", lambda linkage: planar(linkage.machine.gravity), vector=True)
    trace.state["gravity"] = gravity
    moving, weights = [], []
    for link in trace.machine.links:
        _, p1, p2, turn, w, a = trace.body(link)
        mass, moment, inertia = (
            trace.slot(f"{key}({link})", _inertial(trace, link, place), vector=place == 1)
            for place, key in enumerate(("mass", "moment", "inertia"))
        )
        rates, body = (speed * speed, acceleration), (mass, moment, inertia)
        moving.append((link, *kernels.inertia_demand(p1, p2, turn, w, a, *rates, *body)))
        weights.append((link, *kernels.weight_demand(turn, mass, moment, gravity)))
    return moving, weights


def _inertial(trace: Trace, link: str, place: int) -> Read:
    anchor = trace.linkage.anchors[link]
    return lambda linkage: inertia_moved(linkage.machine, link, anchor)[place]


def _on_frame(trace: Trace, what: str, demands: list[HoldingWrench]) -> None:
    """Force and moment, about the drive's pivot, that these demands exert on the frame."""
    pivot = trace.state[f"p({trace.linkage.pivot})"]
    trace.state[f"{what} force"] = -sum(force for _, force, _ in demands)
    trace.state[f"{what} moment"] = -sum(
        moment + kernels.cross(trace.body(link)[0] - pivot, force)
        for link, force, moment in demands
    )


def _drive_torques(trace: Trace) -> Iterable[Any]:
    """What each link takes of the drive torque."""
    for link in trace.machine.links:
        _, p1, _, _, w, _ = trace.body(link)
        yield kernels.drive_torque(p1, w, *(trace.state[name] for name in demand_names(link)))


def trace_joints(trace: Trace) -> None:
    """The pass from demands to the force in every joint."""
    trace.put(demand_names(FRAME), (0j, 0.0))
    for number, step in enumerate(trace.linkage.forces):
        trace_step(trace, step, "forces", number)
    for drive in trace.machine.driven:
        pivot = trace.linkage.anchors[drive.link]
        trace.state[f"R({pivot}/{drive.link})"] = trace.state[f"F({drive.link})"]
    if not trace.machine.has_crank:
        trace.state["drive torque"] = trace.state[f"M({trace.machine.drive.link})"]
