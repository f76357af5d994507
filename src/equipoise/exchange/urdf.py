"""URDF: the tree of a linkage, in SI units; pins that close loops have no place in it.

A link's frame is at its joint there, with the axes of the link.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import atan2, hypot
from xml.etree import ElementTree as ET

import numpy as np

from equipoise.exchange.formats import Job
from equipoise.exchange.tree import Hung, Tree, tensor_of, trees, weighed
from equipoise.i18n import Note, to_say
from equipoise.mechanism.assembly.linkage import assemble
from equipoise.mechanism.kinematics.friction_joints import rubbing_joints
from equipoise.mechanism.kinematics.motion import move
from equipoise.mechanism.parts.links import size_of
from equipoise.mechanism.parts.machine import FRAME, Machine, Vector

EFFORT = 1e6
"""N or N m: URDF wants a limit of what slides."""


def export_bytes(job: Job) -> str:
    """The file's text."""
    machine, trees_of_links = weighed(job.machine), trees(job)
    root = ET.Element("robot", name=str(machine.title))
    ET.SubElement(root, "link", name=FRAME)
    for tree in trees_of_links:
        for link in tree.links:
            _link(root, tree, link)
            _joint(root, tree, link)
        _gears(root, tree, job)
        for loop in tree.loops:
            item, other = (_end(root, tree, body, loop.pin) for body in (loop.first, loop.second))
            job.leave_out(
                Note(
                    "the pin {pin} of {one!r} and {other!r}, which closes a loop; equipoise import "
                    'joins them with --pin "{pair}"',
                    pin=loop.pin,
                    one=loop.first,
                    other=loop.second,
                    pair=f"{item} = {other}",
                )
            )
    missing = {
        to_say("loads"): machine.loads,
        to_say("what the support stands on"): machine.support,
        to_say("the drive's speed"): machine.drive.speed,
    }
    for what, given in missing.items():
        if given:
            job.leave_out(Note(what))
    job.leave_out_soil()
    ET.indent(root)
    return ET.tostring(root, encoding="unicode") + "\n"


def _row(*values: float) -> str:
    return " ".join(repr(float(value)) for value in values)


def _link(root: ET.Element, tree: Tree, link: Hung) -> None:
    """Mass, and lines from its joint to its points to be seen."""
    body = tree.machine.links[link.name]
    part = ET.SubElement(root, "link", name=f"{link.name}{tree.suffix}")
    mass, (*center, across), tensor = tensor_of(body)
    inertial = ET.SubElement(part, "inertial")
    ET.SubElement(inertial, "origin", xyz=_row(*_from(link, center), across), rpy="0 0 0")
    ET.SubElement(inertial, "mass", value=repr(mass))
    axes = [(i, k) for i in range(3) for k in range(i, 3)]
    moments = {f"i{'xyz'[i]}{'xyz'[k]}": repr(float(tensor[i, k])) for i, k in axes}
    ET.SubElement(inertial, "inertia", moments)
    thin = size_of(body.points) / 40
    for place in body.points.values():
        _bar(part, _from(link, place), thin)


def _end(root: ET.Element, tree: Tree, body: str, pin: str) -> str:
    """Name of a link without mass that is fixed where a body has a pin that is left out."""
    parent, across = FRAME, tree.row.lateral
    place = complex(*tree.machine.bodies[body][pin])
    if body == FRAME:
        place += complex(*tree.row.offset)
    else:
        parent, across = f"{body}{tree.suffix}", 0.0
        place -= complex(*tree.hung[body].at)
    name = f"{body}{tree.suffix} {pin}"
    if all(link.get("name") != name for link in root.iter("link")):  # else a loop ends there too
        ET.SubElement(root, "link", name=name)
        joint = ET.SubElement(root, "joint", name=name, type="fixed")
        ET.SubElement(joint, "origin", xyz=_row(place.real, place.imag, across), rpy="0 0 0")
        ET.SubElement(joint, "parent", link=parent)
        ET.SubElement(joint, "child", link=name)
    return name


def _from(link: Hung, place: Sequence[float]) -> Vector:
    """A place in a link's axes, from its joint."""
    return place[0] - link.at[0], place[1] - link.at[1]


def _bar(part: ET.Element, end: Vector, thin: float) -> None:
    length = hypot(*end)
    if not length:
        return
    visual = ET.SubElement(part, "visual")
    middle, turned = (end[0] / 2, end[1] / 2, 0.0), (0.0, 0.0, atan2(end[1], end[0]))
    ET.SubElement(visual, "origin", xyz=_row(*middle), rpy=_row(*turned))
    ET.SubElement(ET.SubElement(visual, "geometry"), "box", size=_row(length, thin, thin))


def _joint(root: ET.Element, tree: Tree, link: Hung) -> None:
    """A hinge that turns without end, or a slide with the way of a turn to either side."""
    hinge = link.kind == "hinge"
    name = f"{link.name}{tree.suffix}"
    joint = ET.SubElement(root, "joint", name=name, type="continuous" if hinge else "prismatic")
    place, turned = tree.relative_pose(link)
    spot = place + complex(*link.at) * np.exp(1j * turned)
    if link.parent != FRAME:
        spot -= complex(*tree.hung[link.parent].at)
    origin = _row(spot.real, spot.imag, tree.across(link))
    ET.SubElement(joint, "origin", xyz=origin, rpy=_row(0.0, 0.0, turned))
    parent = FRAME if link.parent == FRAME else f"{link.parent}{tree.suffix}"
    ET.SubElement(joint, "parent", link=parent)
    ET.SubElement(joint, "child", link=name)
    along = (0.0, 0.0, 1.0) if hinge else (np.cos(link.along), np.sin(link.along), 0.0)
    ET.SubElement(joint, "axis", xyz=_row(*along))
    _dynamics(joint, tree, link)
    if not hinge:
        way = _way(tree.machine, link)
        limits = {"lower": -way, "upper": way, "effort": EFFORT, "velocity": EFFORT}
        ET.SubElement(joint, "limit", {key: repr(value) for key, value in limits.items()})


def _dynamics(joint: ET.Element, tree: Tree, link: Hung) -> None:
    """What resists in a joint whatever presses there: its damping and its drag."""
    for own in rubbing_joints(assemble(tree.machine)):
        if {own.on, own.by} == {link.name, link.parent} and own.slides == (link.kind != "hinge"):
            damping, drag = own.unloaded
            ET.SubElement(joint, "dynamics", damping=repr(damping), friction=repr(drag))


def _way(machine: Machine, link: Hung) -> float:
    """How far a slide goes over the whole cycle, m."""
    ends = {link.name, link.parent}
    slider = next(slider for slider in machine.sliders if {slider.link, slider.on} == ends)
    return float(np.ptp(move(machine).sliders[slider.name].travel))


def _gears(root: ET.Element, tree: Tree, job: Job) -> None:
    """A joint that follows another; of three URDF does not know."""
    for name, factors in tree.proportions:
        if len(factors) != 2:
            job.leave_out(Note("the gears {name}, which join more than two joints", name=name))
            continue
        (item, by), (other, share) = factors.items()
        joint = next(j for j in root.iter("joint") if j.get("name") == f"{item}{tree.suffix}")
        mimic = {"joint": f"{other}{tree.suffix}", "multiplier": repr(-share / by)}
        ET.SubElement(joint, "mimic", mimic)
