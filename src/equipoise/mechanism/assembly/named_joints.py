"""Joints by the names of their forces, and the properties that the model file gives them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from equipoise.errors import ModelError
from equipoise.i18n import Note
from equipoise.mechanism.assembly.joints import Structure, name_in_outputs
from equipoise.mechanism.assembly.steps import Reaction
from equipoise.mechanism.checks import numbered, unknown
from equipoise.mechanism.parts.joint_properties import (
    JointProperties,
    family_of,
    wrong_of_kind,
)
from equipoise.mechanism.parts.machine import Machine

ReactionsByName = dict[str, list[Reaction]]


def named_joints(joints: Structure, reactions: Sequence[Reaction]) -> ReactionsByName:
    """Joints by the names of their forces in outputs; a pin of several links by its point too,
    which stands for all of its forces.
    """
    named: ReactionsByName = {}
    for reaction in reactions:
        if joints.hides(reaction.name, reaction.on, reaction.by):
            continue
        family = family_of(reaction.kind)
        for name in dict.fromkeys((name_in_outputs(joints, reaction), reaction.name)):
            named.setdefault(family + name, []).append(reaction)
    return named


def joint_names(joints: Structure) -> set[str]:
    """Names that forces of joints may have in outputs, in whatever order links are solved."""
    names = {name for point, bodies in joints.pins.items() for name in _pin_names(joints, point)
             if not joints.hides(point, *bodies)}  # fmt: skip
    names |= {family_of("slider") + slider.name for slider in joints.sliders
              if not joints.hides(slider.name, slider.link, slider.on)}  # fmt: skip
    return names | {f"{coupling.table}.{coupling.name}" for coupling in joints.couplings}


def pin_radii(joints: Structure, given: Iterable[JointProperties]) -> dict[str, float]:
    """Radii of pins by point, m; of a pin of several links the largest that is given."""
    radii: dict[str, float] = {}
    by_name = {name: point for point in joints.pins for name in _pin_names(joints, point)}
    for item in given:
        if item.radius is not None and (point := by_name.get(item.joint)) is not None:
            if point in joints.riders:
                rider = joints.riders[point]
                point = rider.held[rider.link][point]
            radii[point] = max(item.radius, radii.get(point, 0.0))
    return radii


def _pin_names(joints: Structure, point: str) -> set[str]:
    """Names of a pin's forces in outputs, and of the whole pin."""
    whole, bodies = family_of("pin") + point, joints.pins[point]
    return {whole, *(f"{whole}/{body}" for body in bodies if len(bodies) > 2)}


def given_properties(
    machine: Machine, joints: Structure, reactions: Sequence[Reaction]
) -> Iterator[tuple[str, Reaction, JointProperties]]:
    """Joints of which the model file gives properties, with the place of these in the file.

    Raises
    ------
    ModelError : there is no such joint, it is named twice, or it has no such property.
    """
    named, tables = named_joints(joints, reactions), dict[str, str]()
    varying = {(coupling.table, coupling.name) for coupling in machine.gears
               if coupling.special}  # fmt: skip
    for where, item in numbered("joints", machine.joints):
        if item.joint not in named:
            raise ModelError(f"{where}.joint", unknown(item.joint, named, "joint"))
        for joint in named[item.joint]:
            if (before := tables.setdefault(joint.force, where)) != where:
                note = Note(
                    "{joint!r} has its properties in {before}; give them in one table",
                    joint=item.joint,
                    before=before,
                )
                raise ModelError(f"{where}.joint", note)
            in_slot = joint.name in joints.riders
            varies = (joint.kind, joint.name) in varying
            for problem in wrong_of_kind(where, item, joint.kind, in_slot, varies):
                raise problem
            yield where, joint, item
