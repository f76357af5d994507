"""What an analysis shows of friction: what each joint loses, and what is left."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from equipoise.i18n import say
from equipoise.mechanism.outputs.declared import joint_named
from equipoise.quantities import Dimension, format_quantity, percent
from equipoise.results.blocks import Block, Cell, Column, Facts, Table, Value
from equipoise.results.machine_blocks import largest

if TYPE_CHECKING:
    from equipoise.results.analysis import Analysis


def friction_blocks(analysis: Analysis) -> Iterator[Block]:
    """Losses of all joints, and the efficiency."""
    whole = analysis.resolved
    losses, forces = whole.losses, whole.forces
    if losses is None:
        return
    total = losses.loss
    rows: list[tuple[Cell, ...]] = []
    for name, joint in losses.joints.items():
        friction = forces.frictions[name]
        kind: Dimension = "torque" if friction.is_pin else "force"
        figures = forces.motion.figures(abs(friction.effort))
        resists = largest(figures, dimension=kind)
        share = f"{percent(joint.loss / total)} %" if total else ""
        wears = Value(joint.wear_work) if friction.wears else None
        rows.append((joint_named(name), Value(joint.loss), share, resists, wears))
    columns = (
        "",
        Column(say("mean loss"), "power"),
        say("share"),
        say("largest friction"),
        Column(say("contact force times sliding way in a turn"), "energy"),
    )
    yield Table.of(say("Friction in joints; largest with its crank angle"), columns, rows)
    lines = [
        say(
            "drive gives {drive}, loads give {loads}, joints lose {loss} in the mean",
            drive=format_quantity(losses.drive, "power", "W"),
            loads=format_quantity(losses.loads, "power", "W"),
            loss=format_quantity(total, "power", "W"),
        )
    ]
    if losses.efficiency is not None:
        lines.append(say("efficiency {share} %", share=percent(losses.efficiency)))
    yield Facts(say("Power in the mean of a cycle"), tuple(lines))
