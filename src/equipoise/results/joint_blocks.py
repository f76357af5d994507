"""Forces in joints and between teeth, as an analysis shows them."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from equipoise.i18n import say
from equipoise.mechanism.reactions import JointForce, SliderForce
from equipoise.mechanism.spoken import body_named, joint_named
from equipoise.mechanism.undecided import undecided
from equipoise.results.blocks import Block, Cell, Column, Notes, Table, Value
from equipoise.results.machine_blocks import largest
from equipoise.signals import figures

if TYPE_CHECKING:
    from equipoise.results.analysis import Analysis


def joint_blocks(analysis: Analysis) -> Iterator[Block]:
    """Forces in joints, and of which of them statics does not tell."""
    if analysis.forces.joints or analysis.forces.gears:
        yield joint_table(analysis)
    if told := tuple(undecided(analysis.motion.linkage).told()):
        yield Notes(told)


def joint_table(analysis: Analysis) -> Table:
    """The force in every joint and mesh."""
    forces = analysis.forces
    joints: dict[str, JointForce] = {**forces.joints, **forces.gears, **forces.cams}
    scale = analysis.summary["frame_moment"].peak
    rows: list[tuple[Cell, ...]] = []
    for name, joint in joints.items():
        found = figures(analysis.crank_angle, joint.size)
        couple = None
        if isinstance(joint, SliderForce):
            couple = Value(float(np.max(np.abs(joint.moment))), scale)
        named = say("teeth") if name in forces.gears else joint_named(name)
        named = say("cam") if name in forces.cams else named
        ends = f"{body_named(joint.by)} → {body_named(joint.on)}"
        rows.append((named, ends, Value(found.mean), Value(found.rms), largest(found), couple))
    labels = (say("mean"), say("RMS"), say("largest"))
    columns = ["", say("by → on"), *(Column(label, "force") for label in labels)]
    columns.append(Column(say("moment"), "torque"))
    shown = len(columns) if any(row[-1] is not None for row in rows) else -1
    title = say("Force in each joint; largest with its crank angle")
    return Table.of(title, columns[:shown], (row[:shown] for row in rows))
