"""Blocks of an analysis on its cams: radii of curvature, pressure angles, and loss of contact."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from math import degrees
from typing import TYPE_CHECKING

from equipoise.i18n import say
from equipoise.mechanism.assembly.cam_shapes import fits_of, sharpest
from equipoise.mechanism.parts.cams import Cam
from equipoise.quantities import format_quantity
from equipoise.results.blocks import Block, Cell, Column, Notes, Table, Value
from equipoise.results.lost_contacts import lost_contacts
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
        steep = motion.figures(abs(analysis.outputs[f"cams.{name}.pressure_angle"].values))
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
