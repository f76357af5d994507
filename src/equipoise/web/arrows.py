"""Arrows at a point: its velocity, its acceleration, and the forces in its joints."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from equipoise.i18n import say
from equipoise.mechanism.outputs.spoken import body_named
from equipoise.quantities import Dimension, display
from equipoise.results.analysis import Analysis
from equipoise.web.block import Array, FloatBlock, Values


def points_of(analysis: Analysis) -> list[str]:
    """Points that arrows can be at: those that move, then those of the frame."""
    frame = analysis.machine.frame
    return sorted(analysis.motion.points, key=lambda name: name in frame)


def arrows_of(analysis: Analysis, point: str, block: FloatBlock) -> list[Values]:
    """What there is to show at a point; vectors over the crank angle go to the block.

    kind : ``velocity``, ``acceleration`` or ``force``.  array : its name in the block, (2 N,).
    """
    items = [*_arrows(analysis, point)]
    for entry, values in items:
        block.add(entry["array"], values)
    return [item for item, _ in items]


def _arrows(analysis: Analysis, point: str) -> Iterator[tuple[Values, Array]]:
    motion = analysis.motion.points.get(point)
    if motion is None:
        return
    if point not in analysis.machine.frame and analysis.motion.speed:
        moved: Mapping[str, tuple[Dimension, Array]] = {
            "velocity": ("speed", motion.velocity),
            "acceleration": ("acceleration", motion.acceleration_vector),
        }
        for kind, (dimension, values) in moved.items():
            label = analysis.outputs[f"points.{point}.{kind}"].label()
            yield _quantity(kind, f"arrow.{kind}", label, dimension), values
    joints = {} if analysis.solved is None else analysis.solved.joints
    for name in _joints_at(analysis, point, joints):
        joint = joints[name]
        label = analysis.outputs[f"joints.{name}"].label()
        label = say("{force}, on {body}", force=label, body=body_named(joint.on))
        yield _quantity("force", f"arrow.force.{name}", label, "force"), joint.value


def _quantity(kind: str, array: str, label: str, dimension: Dimension) -> Values:
    unit = display(dimension)
    return {"kind": kind, "array": array, "label": label, "unit": unit.name, "factor": unit.factor}


def _joints_at(analysis: Analysis, point: str, joints: Mapping[str, Any]) -> list[str]:
    """Names of pins and sliding joints at a point."""
    slides = {slider.name for slider in analysis.machine.sliders if slider.point == point}
    return [name for name in joints if name.partition("/")[0] == point or name in slides]
