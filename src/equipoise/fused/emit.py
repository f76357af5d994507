"""From a linkage and signals to source: every step becomes a line, every signal an expression."""

from __future__ import annotations

from equipoise.errors import UsageError
from equipoise.fused.demands import write_demands, write_joints
from equipoise.fused.figures import Gathered
from equipoise.fused.motion import Written, write_motion
from equipoise.fused.signals import expression, needs_forces, needs_joints
from equipoise.fused.source import Source, written
from equipoise.mechanism.linkage import Linkage
from equipoise.mechanism.steps import Call, Rotation, RunningAngle


def can_emit(linkage: Linkage) -> bool:
    """Whether the steps of a linkage can be written out: no group of loops, no soil."""
    machine = linkage.machine
    soil = machine.planting is not None and machine.planting.soil is not None
    return not soil and all(isinstance(s, Call | RunningAngle | Rotation) for s in linkage.motion)


def emit(linkage: Linkage, gathered: Gathered) -> Source:
    """Write out the steps of a linkage, with the signals that are gathered.

    Raises
    ------
    UsageError : there is no such signal, or a loop cannot have it or this linkage.
    MassError : it needs masses, and the machine lacks some.
    """
    if not can_emit(linkage):
        raise UsageError("groups of loops, and fingers in soil, cannot be computed in a loop")
    writer = Written(linkage)
    write_motion(writer)
    if any(map(needs_forces, gathered.signals)):
        write_demands(writer)
    if any(map(needs_joints, gathered.signals)):
        write_joints(writer)
    signals = [writer.sheet.put(f"signal {s}", expression(writer, s)) for s in gathered.signals]
    return written(writer.sheet, signals, writer.numbers(), gathered)
