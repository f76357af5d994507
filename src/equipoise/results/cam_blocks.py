"""What an analysis shows of cams: radius of curvature, pressure angle, where followers lift."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from dataclasses import replace
from math import ceil, copysign, degrees, floor, isfinite, log10, pi
from typing import TYPE_CHECKING

import numpy as np

from equipoise.i18n import Note, all_of, say
from equipoise.mechanism.assembly.cam_shapes import fits_of, sharpest
from equipoise.mechanism.dynamics.cam_contacts import PER_TURN, LetGo, let_go
from equipoise.mechanism.dynamics.forces import Forces, forces, massless
from equipoise.mechanism.kinematics.motion import move
from equipoise.mechanism.outputs.declared import body_named
from equipoise.mechanism.parts.cams import Cam
from equipoise.mechanism.parts.machine import Machine
from equipoise.quantities import PER_RPM, angle, format_quantity
from equipoise.results.blocks import Block, Cell, Column, Notes, Table, Value
from equipoise.results.machine_blocks import largest, smallest

if TYPE_CHECKING:
    from equipoise.mechanism.assembly.joints import Structure
    from equipoise.mechanism.dynamics.cam_contacts import CamFigures
    from equipoise.mechanism.parts.machine import Machine
    from equipoise.results.analysis import Analysis


def cam_blocks(analysis: Analysis) -> Iterator[Block]:
    """Shape, pressure angle and contact force of each cam; where followers lift off."""
    rows: list[tuple[Cell, ...]] = []
    motion, solved = analysis.resolved.motion, analysis.resolved.solved
    by_name: Mapping[str, CamFigures] = analysis.part_figures[Cam.list_name]
    limited = any(cam.lift_off_speed is not None for cam in by_name.values())
    for name, item in by_name.items():
        steep = motion.figures(abs(analysis.outputs[f"cams.{name}.pressure_angle"].resolved))
        row: tuple[Cell, ...] = (
            name.replace(" to ", " → "),
            Value(item.least_radius),
            largest(steep),
        )
        if solved is not None:
            force = motion.figures(solved.cams[name].normal)
            speed = item.lift_off_speed
            limit = None if speed is None else Value(speed, at=item.lift_off_at)
            row = (*row, smallest(force), largest(force), limit)
        rows.append(row)
    force_heads = (say("smallest contact force"), say("largest"))
    columns = (
        "",
        Column(say("least radius of curvature"), "length"),
        Column(say("largest pressure angle"), "angle"),
        *(Column(head, "force") for head in force_heads),
        Column(say("lifts off from"), "angular speed", "rpm"),
    )
    width = len(rows[0]) - (len(rows[0]) == len(columns) and not limited)
    title = say("Cams; largest and smallest with the crank angle")
    yield Table.of(title, columns[:width], (row[:width] for row in rows))
    if solved is not None and (lost := lost_contacts(solved)):
        yield Notes(lost)


def cam_descriptions(machine: Machine, joints: Structure) -> Iterator[str]:
    """A sentence on each cam: its law, follower and closure, and its least radius of curvature."""
    for fit in fits_of(machine, joints):
        cam, (radius, where) = fit.cam, sharpest(fit)
        low, high = (
            format_quantity(extreme, cam.law.dimension) for extreme in cam.law.curve.extremes
        )
        yield say(
            "cam: {driver} moves {driven} from {low} to {high}, {rides}, closed by {closed_by}; "
            "least radius of curvature {radius}, at cam angle {angle} deg",
            driver=cam.driver,
            driven=cam.driven,
            low=low,
            high=high,
            rides=cam.rides,
            closed_by=cam.closed_by,
            radius=format_quantity(radius, "length", "mm"),
            angle=f"{degrees(where):.4g}",
        )


LEAST_EFFECT = 1e-6
"""Contact force over preload below which a spring does not act on a follower, but for rounding."""


def lost_contacts(forces: Forces) -> tuple[Note, ...]:
    """Where springs do not keep followers on their cams, at the speed analysed."""
    sprung = any(forces.motion.machine.force_elements)
    return tuple(lift_off_note(item, sprung) for item in let_go(forces) if item.ranges)


def lift_off_note(let_go: LetGo, sprung: bool) -> Note:
    """Note on the crank angles at which a follower lifts off its cam, at the analysed speed.

    sprung : whether the file has springs at all, which may then be too weak.
    """
    ranges = [
        Note("at every crank angle")
        if b - a >= 2 * pi
        else Note("at crank angles from {low} to {high}", low=angle(a), high=angle(b))
        for a, b in let_go.ranges
    ]
    return Note(
        "{follower} lifts off {cam} {ranges}, where it would have to be held by up to {force}; "
        "{limit}",
        follower=let_go.cam.driven,
        cam=body_named(let_go.cam.driver),
        ranges=all_of(ranges),
        force=format_quantity(-let_go.least[0], "force"),
        limit=_limit(let_go.speed, sprung),
    )


def _limit(speed: float, sprung: bool) -> Note:
    if speed == 0 and sprung:
        return Note("its springs are too weak even at rest")
    if speed == 0:
        return Note("no [[springs]] press on it")
    rpm = speed / PER_RPM
    if sprung:
        return Note("its springs hold it up to {speed:.4g} rpm", speed=rpm)
    return Note("without [[springs]] it stays there up to {speed:.4g} rpm", speed=rpm)


def preloads_to_hold(machine: Machine) -> Iterator[Note]:
    """Of each follower that lifts off at the file's speed, a preload that holds it there.

    Contact forces are linear in the preload of a spring, so that one more analysis gives the
    preload that each crank angle needs.  Of the springs with which no follower lifts off that was
    held before, the one that needs the least change is named; none where there is no such spring.
    """
    if not machine.cams or massless(machine):
        return
    present = forces(move(machine, PER_TURN))
    speed = abs(machine.drive.speed)
    at_speed = {item.cam.name for item in let_go(present) if item.speed >= speed}
    for item in let_go(present):
        changes = []
        for number, spring in enumerate(machine.springs if item.ranges else ()):
            if spring.stiffness is not None and (added := _needed(present, item.cam, number)):
                changes.append((abs(added), (spring.preload or 0.0) + added, number))
        for _, preload, number in sorted(changes):
            if _holds(_with_preload(machine, number, preload), at_speed | {item.cam.name}):
                spring = machine.springs[number]
                yield Note(
                    "a preload of {preload} instead of {given} of the spring from {point} to {to} "
                    "just holds {follower} on {cam} at {speed:.4g} rpm",
                    preload=format_quantity(preload, "force", "N"),
                    given=format_quantity(spring.preload or 0.0, "force", "N"),
                    point=spring.point,
                    to=spring.to,
                    follower=item.cam.driven,
                    cam=body_named(item.cam.driver),
                    speed=speed / PER_RPM,
                )
                break


def _holds(machine: Machine, names: Collection[str]) -> bool:
    """Whether the followers of cams of these names stay on them at the file's speed."""
    limits = {item.cam.name: item.speed for item in let_go(forces(move(machine, PER_TURN)))}
    return all(limits[name] >= abs(machine.drive.speed) for name in names)


def _with_preload(machine: Machine, number: int, preload: float) -> Machine:
    springs = [*machine.springs]
    springs[number] = replace(springs[number], preload=preload)
    return machine.with_springs(springs)


def _needed(present: Forces, cam: Cam, number: int) -> float:
    """Preload, N, to add to a spring so that a cam's contact force is nowhere below 0; 0 where no
    preload does that.

    It is rounded away from 0 to two digits: between samples the force is a little lower.
    """
    machine = present.motion.machine
    preloaded = _with_preload(machine, number, (machine.springs[number].preload or 0.0) + 1.0)
    normal = present.cams[cam.name].normal
    per_newton = forces(move(preloaded, PER_TURN)).cams[cam.name].normal - normal
    acts = np.abs(per_newton) > LEAST_EFFECT
    if np.any(normal[~acts] < 0):
        return 0.0
    bounds = -normal[acts] / per_newton[acts]
    rises = per_newton[acts] > 0
    low = float(np.max(bounds[rises], initial=-np.inf))
    high = float(np.min(bounds[~rises], initial=np.inf))
    added = low if low > 0 else high
    if not low <= high or not isfinite(added) or added == 0:
        return 0.0
    digit = 10.0 ** (floor(log10(abs(added))) - 1)
    return copysign(ceil(abs(added) / digit) * digit, added)
