"""Everything that is wrong with a machine as a whole: of each part, and of all together."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from typing import Any

from equipoise.errors import ModelError
from equipoise.i18n import Note
from equipoise.keys import wrong_values
from equipoise.mechanism.checks import Bodies, numbered, too_many, unknown_link, wrong_text
from equipoise.mechanism.parts.couplings import coupling_kinds
from equipoise.mechanism.parts.drive_checks import wrong_drive, wrong_further, wrong_together
from equipoise.mechanism.parts.element_kinds import part_kinds
from equipoise.mechanism.parts.field import wrong_planting
from equipoise.mechanism.parts.force_elements import wrong_axes, wrong_load
from equipoise.mechanism.parts.joint_kinds import JointKind, wrong_names
from equipoise.mechanism.parts.joint_properties import wrong_joint
from equipoise.mechanism.parts.links import wrong_link, wrong_points
from equipoise.mechanism.parts.places import wrong_position
from equipoise.mechanism.parts.planes import wrong_planes
from equipoise.mechanism.parts.sliders import wrong_slider
from equipoise.mechanism.parts.support import wrong_support

MOST = {"links": 100, "points": 2000, "sliders": 200, "loads": 500, "joints": 500,
        "drives": 20, "constraints": 200}  # fmt: skip
"""Far beyond any machine; they keep a file of nonsense from running for hours."""
LISTS: Mapping[str, Callable[[str, Any, Bodies], Iterator[ModelError]]] = {
    "sliders": wrong_slider,
    "loads": wrong_load,
}
"""What is wrong with each of the lists; couplings and elements say it themselves."""


def validate_machine(machine: Any) -> Iterator[ModelError]:
    """Everything that is wrong with the values of a machine, the first things first."""
    bodies = machine.bodies
    yield from _too_much(machine)
    yield from wrong_values("", machine)
    yield from wrong_points("frame", machine.frame)
    if not machine.links:
        yield ModelError("links", Note("there is no link; give at least the drive's"))
    for name, link in machine.links.items():
        yield from wrong_link(f"links.{name}", name, link)
    yield from unknown_link("drive.link", machine.drive.link, bodies)
    yield from wrong_together(machine.drive, machine.drives)
    for name, wrong in LISTS.items():
        for where, item in numbered(name, getattr(machine, name)):
            yield from wrong(where, item, bodies)
    for where, item in numbered("loads", machine.loads):
        yield from wrong_axes(where, item, machine.sliders)
    placed: list[tuple[str, Any]] = [
        pair
        for table in part_kinds(type(machine))
        for pair in numbered(table, getattr(machine, table))
    ]
    for where, item in placed:
        yield from item.problems(where, bodies)
    for where, item in numbered("constraints", machine.constraints):
        yield from item.problems(where, bodies)
    for where, item in numbered("joints", machine.joints):
        yield from wrong_joint(where, item, ("joints", *coupling_kinds(type(machine))))
    sliders = [slider.name for slider in machine.sliders]
    joints = [(where, item) for where, item in placed if isinstance(item, JointKind)]
    yield from wrong_names(joints, bodies, sliders)
    for where, item in numbered("drives", machine.drives):
        yield from wrong_further(where, item, bodies, sliders)
    yield from wrong_position(machine.position, bodies)
    yield from wrong_planting(machine.planting, bodies)
    yield from wrong_drive(machine.drive, bodies, sliders)
    yield from wrong_planes(machine)
    yield from wrong_support(machine.support, machine.rows)
    if machine.balance is not None:
        yield from machine.balance.problems(machine)


def _too_much(machine: Any) -> Iterator[ModelError]:
    points = [(body, point) for body, points in machine.bodies.items() for point in points]
    yield from too_many("links", machine.links, MOST["links"])
    yield from too_many("points", points, MOST["points"])
    for what in ("sliders", "loads", "joints", "drives", "constraints"):
        yield from too_many(what, getattr(machine, what), MOST[what])
    for table, kind in part_kinds(type(machine)).items():
        yield from too_many(table, getattr(machine, table), kind.most)
    yield from wrong_text("title", machine.title)
    for body, names in machine.bodies.items():
        yield from wrong_text("links", body)
        for point in names:
            yield from wrong_text(f"points of {body}", point)
