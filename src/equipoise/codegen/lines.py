"""Lines for the steps of a linkage, in order: its motion, what each link demands of its joints, and
the pass over the joints.

What each design has of its own is a slot, with a function that finds it in the design's linkage.
"""

from __future__ import annotations

import inspect
from collections.abc import Iterator

import numpy as np

from equipoise.codegen.across import write_across
from equipoise.codegen.angles import write_running_angle
from equipoise.codegen.applied import Held, names, write_load, write_spring, write_tension
from equipoise.codegen.coupled import write_coupling, write_rolled
from equipoise.codegen.course import write_course
from equipoise.codegen.followers import write_displacement, write_swung
from equipoise.codegen.laws import write_law
from equipoise.codegen.loops import write_loops
from equipoise.codegen.source import Read
from equipoise.codegen.writer import Writer, links_of
from equipoise.errors import MassError
from equipoise.mechanism.assembly.cam_groups import Displacement
from equipoise.mechanism.assembly.gear_contacts import rolled
from equipoise.mechanism.assembly.newton import LoopGroup
from equipoise.mechanism.assembly.steps import (
    Call,
    Rotation,
    RunningAngle,
    Step,
    demand_names,
    planar,
    size_of_bodies,
    u,
)
from equipoise.mechanism.dynamics.forces import inertia_moved, massless
from equipoise.mechanism.formulas import cam_kernels, kernels
from equipoise.mechanism.parts.couplings import coupled
from equipoise.mechanism.parts.machine import FRAME, Drive, FurtherDrive

# -- motion ----------------------------------------------------------------------------------------


def write_motion(writer: Writer) -> None:
    """Write the steps from the crank angle to every link, or what they come to for all designs."""
    sheet, driven = writer.sheet, writer.machine.driven
    for name in writer.machine.frame:
        sheet.slot(f"p({name})", _frame_point(name), vector=True)
        sheet.put(f"p1({name})", "0j")
        sheet.put(f"p2({name})", "0j")
    if writer.fixed:
        write_course(writer)
        return
    moved = {FRAME: ("0.0", "1 + 0j", "0.0", "0.0")}
    for link, (angle, *values) in (moved | {d.link: _driven(writer, d) for d in driven}).items():
        for name, value in zip(u(link), values, strict=True):
            sheet.put(name, value)
        if writer.counted:
            sheet.put(f"phi({link})", angle)
    for number, step in enumerate(writer.linkage.motion):
        _write_step(writer, step, "motion", number)


def _driven(writer: Writer, drive: Drive | FurtherDrive) -> tuple[str, str, str, str]:
    """Angle, rotation and rates of a driven link, which no design changes."""
    sheet, turned = writer.sheet, drive.turned
    if writer.machine.has_crank:
        angle = sheet.row("theta", lambda theta: theta, "theta") if writer.counted else ""
        return angle, writer.turned(1.0), "1.0", "0.0"
    rows = {
        "angle": lambda theta: turned(theta)[0],
        "cos": lambda theta: np.cos(turned(theta)[0]),
        "sin": lambda theta: np.sin(turned(theta)[0]),
        "first": lambda theta: turned(theta)[1] + 0.0 * theta,
        "second": lambda theta: turned(theta)[2] + 0.0 * theta,
    }
    angle, cos, sin, *rates = (sheet.row(f"{name}({drive.link})", of) for name, of in rows.items())
    return angle, f"({cos} + 1j * {sin})", rates[0], rates[1]


def _frame_point(name: str) -> Read:
    return lambda found: planar(found.machine.frame[name])


def _write_step(writer: Writer, step: Step, steps: str, number: int) -> None:
    """Write a step, the one of this number of a linkage's ``motion`` or ``forces``."""
    sheet = writer.sheet
    if isinstance(step, RunningAngle):
        write_running_angle(writer.sheet, writer.linkage.cycle, step.link)
    elif isinstance(step, Rotation):
        if writer.counted and step.link not in writer.rotated:
            sheet.put(f"u({step.link})", f"rotation({writer.name(f'phi({step.link})')})")
    elif isinstance(step, Call):
        if step.kernel is coupled and links_of(step)[-1] in writer.loose:
            write_law(writer, step, number)
        elif step.kernel is coupled or (step.kernel is kernels.gear and not writer.counted):
            write_coupling(writer, step)
        elif step.kernel is rolled:
            write_rolled(writer, step, number)
        elif step.kernel is cam_kernels.swung and not writer.counted:
            write_swung(writer, step, number)
        else:
            _write_call(writer, step, steps, number)
    elif isinstance(step, Displacement):
        write_displacement(writer, step)
    elif isinstance(step, LoopGroup):
        write_loops(sheet, writer.linkage, number)
        writer.points.update(step.anchors)


def _write_call(writer: Writer, step: Call, steps: str, number: int) -> None:
    sheet = writer.sheet
    arguments = [writer.name(name) for name in step.inputs]
    known = list(inspect.signature(step.kernel).parameters)[len(arguments) :]
    for place, (parameter, value) in enumerate(zip(known, step.parameters, strict=True)):
        what = f"{parameter} of {step.outputs[-1]}"
        vector = isinstance(value, complex | np.complexfloating)
        arguments.append(sheet.slot(what, _parameter(steps, number, place), vector))
    sheet.call(step.kernel.__name__, arguments, step.outputs)
    if step.kernel is kernels.rpr:
        size = sheet.slot("size", lambda found: size_of_bodies(found.machine))
        way = f"({arguments[0]} - {arguments[3]}) * (1 / {size})"
        margin = step.outputs[-1]
        writer.apart[margin] = sheet.put(f"apart {margin}", f"dot({way}, {way})")
    writer.points.update(name[2:-1] for name in step.outputs if name.startswith("p("))


def _parameter(steps: str, number: int, place: int) -> Read:
    return lambda found: getattr(found, steps)[number].parameters[place]


# -- forces ----------------------------------------------------------------------------------------


def write_demands(writer: Writer) -> None:
    """Write what moves every link and what holds its weight, loads and springs.

    Then what the frame and the drive get, while the demands are still those of the links alone:
    ``shaking force``, ``shaking moment``, ``frame force``, ``frame moment`` and ``drive torque``.

    Raises
    ------
    MassError : a link has no mass given.
    """
    if missing := massless(writer.machine):
        raise MassError(missing)
    _write_inertia(writer)
    links, machine = list(writer.machine.links), writer.machine
    moving = [(link, *names(writer, "I", link)) for link in links]
    weights = [(link, *names(writer, "W", link)) for link in links]
    loads = [write_load(writer, k, load) for k, load in enumerate(machine.loads, 1)]
    springs = [
        held for k, one in enumerate(machine.springs) for held in write_spring(writer, k, one)
    ]
    springs += [held for k in range(len(machine.belts)) for held in write_tension(writer, k)]
    if machine.has_planes:
        held = [[force for _, force, _ in each] for each in (loads, springs)]
        write_across(writer.sheet, writer.linkage, writer.body, *held)
    _write_frame(writer, "shaking", moving)
    each = zip(machine.loads, loads, strict=True)
    outer = [held for load, held in each if load.reaction is None]
    _write_frame(writer, "frame", [*moving, *weights, *outer])
    for link in links:
        parts = [held for held in (*moving, *weights, *loads, *springs) if held[0] == link]
        force, moment = demand_names(link)
        writer.sheet.put(force, " + ".join(force for _, force, _ in parts))
        writer.sheet.put(moment, " + ".join(moment for _, _, moment in parts))
    if writer.machine.has_crank:  # else work does not tell the torque of each drive
        writer.sheet.put("drive torque", " + ".join(_drive_torques(writer)))


def _write_inertia(writer: Writer) -> None:
    sheet = writer.sheet
    speed, acceleration = writer.rate("speed"), writer.rate("acceleration")
    gravity = sheet.slot("gravity", lambda found: planar(found.machine.gravity), vector=True)
    speed2 = sheet.put("speed2", f"{speed} * {speed}")
    for link in writer.machine.links:
        _, p1, p2, turn, w, a = writer.body(link)
        inertial = [
            sheet.slot(f"{key}({link})", _inertia(writer, link, place), vector=place == 1)
            for place, key in enumerate(("mass", "moment", "inertia"))
        ]
        arguments = [p1, p2, turn, w, a, speed2, acceleration, *inertial]
        sheet.call("inertia_demand", arguments, (f"FI({link})", f"MI({link})"))
        arguments = [turn, *inertial[:2], gravity]
        sheet.call("weight_demand", arguments, (f"FW({link})", f"MW({link})"))


def _inertia(writer: Writer, link: str, place: int) -> Read:
    anchor = writer.linkage.anchors[link]
    return lambda found: inertia_moved(found.machine, link, anchor)[place]


def _write_frame(writer: Writer, what: str, demands: list[Held]) -> None:
    """Write force and moment, about the drive's pivot, that these demands exert on the frame."""
    pivot = writer.name(f"p({writer.linkage.pivot})")
    forces = " + ".join(force for _, force, _ in demands)
    moments = " + ".join(
        f"{moment} + cross({writer.body(link)[0]} - {pivot}, {force})"
        for link, force, moment in demands
    )
    writer.sheet.put(f"{what} force", f"-({forces})")
    writer.sheet.put(f"{what} moment", f"-({moments})")


def _drive_torques(writer: Writer) -> Iterator[str]:
    """What each link takes of the drive torque."""
    for link in writer.machine.links:
        _, p1, _, _, w, _ = writer.body(link)
        force, moment = (writer.name(name) for name in demand_names(link))
        yield f"drive_torque({p1}, {w}, {force}, {moment})"


def write_joints(writer: Writer) -> None:
    """Write the pass from demands to the force in every joint."""
    for name, nothing in zip(demand_names(FRAME), ("0j", "0.0"), strict=True):
        writer.sheet.put(name, nothing)
    for number, step in enumerate(writer.linkage.forces):
        _write_step(writer, step, "forces", number)
    for drive in writer.machine.driven:
        pivot = writer.linkage.anchors[drive.link]
        writer.sheet.put(f"R({pivot}/{drive.link})", writer.name(f"F({drive.link})"))
    if not writer.machine.has_crank:
        writer.sheet.put("drive torque", writer.name(f"M({writer.machine.drive.link})"))
