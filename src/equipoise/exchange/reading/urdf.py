"""URDF, the robots of ROS: links on joints, a tree."""

from __future__ import annotations

from collections import Counter
from typing import Literal
from xml.etree.ElementTree import Element

import numpy as np

from equipoise.errors import ModelError
from equipoise.exchange.reading.imported import Read
from equipoise.exchange.reading.markup import called, number, numbers
from equipoise.exchange.reading.planar import planar
from equipoise.exchange.reading.spatial import (
    MOST,
    WORLD,
    Frame3,
    Joint3,
    Lump,
    Solid,
    Space,
    SpatialOptions,
    by_euler,
    direction,
)
from equipoise.i18n import Note
from equipoise.signals import Array

KINDS: dict[str | None, Literal["hinge", "slide"]] = {
    "revolute": "hinge",
    "continuous": "hinge",
    "prismatic": "slide",
}


def read(root: Element, options: SpatialOptions) -> Read:
    """The machine of a robot, with all joints at 0.

    Raises
    ------
    ModelError : it is no tree, or does not move in one plane.
    """
    space = Space(root.get("name") or "")
    links = {_named(part): part for part in root.findall("link")}
    joints = {_named(part): part for part in root.findall("joint")}
    ends = {name: (_end(joint, "parent", links), _end(joint, "child", links))
            for name, joint in joints.items()}  # fmt: skip
    _check_tree(links, ends)
    root_link = next(iter(links.keys() - {child for _, child in ends.values()}))
    _add(space, links[root_link], Frame3())
    if root_link != WORLD:
        space.rigid.append((WORLD, root_link))
    left = dict(ends)
    while left:
        name = next(name for name, (parent, _) in left.items() if parent in space.solids)
        parent, child = left.pop(name)
        _hang(space, joints[name], parent, links[child])
    _mimics(space, joints)
    driven = root.find("transmission/joint")
    space.driven = "" if driven is None else driven.get("name", "")
    space.note(Note("gravity is taken to act against z"))
    return planar(space, options)


def _named(element: Element) -> str:
    name = element.get("name")
    if not name:
        raise ModelError(element.tag, Note("it has no name; give name"))
    return name


def _end(joint: Element, tag: str, links: dict[str, Element]) -> str:
    """The link at an end of a joint."""
    result = joint.find(tag)
    name = "" if result is None else result.get("link", "")
    if name not in links:
        raise ModelError(
            called(joint), Note("its {tag} {name!r} is no link of the file", tag=tag, name=name)
        )
    return name


def _check_tree(links: dict[str, Element], ends: dict[str, tuple[str, str]]) -> None:
    if len(links) > MOST:
        raise ModelError("", Note("there are more than {most} links; give a linkage", most=MOST))
    if not links:
        raise ModelError("", Note("there is no link in it; give a robot with links"))
    for child, count in Counter(child for _, child in ends.values()).items():
        if count > 1:
            raise ModelError(
                f"link {child!r}",
                Note("it hangs on {count} joints; URDF has trees only", count=count),
            )
    roots = [*(links.keys() - {child for _, child in ends.values()})]
    known = {*roots[:1]}
    for _ in ends:
        known |= {child for parent, child in ends.values() if parent in known}
    if len(roots) != 1 or known != links.keys():
        lost = next(iter(sorted(links.keys() - known)), "")
        raise ModelError(f"link {lost!r}", Note("it does not hang on the others; give one tree"))


def _add(space: Space, link: Element, axes: Frame3) -> None:
    name = _named(link)
    solid = Solid(name, axes, _mass(link, axes))
    if name == WORLD:
        space.solids.pop(WORLD)
    space.add(solid)


def _mass(link: Element, axes: Frame3) -> Lump | None:
    inertial = link.find("inertial")
    if inertial is None:
        still = len(link) == 0  # a mere name for a place
        return Lump(0.0, axes.origin, np.zeros((3, 3))) if still else None
    mass, inertia = inertial.find("mass"), inertial.find("inertia")
    if mass is None or inertia is None:
        raise ModelError(called(link), Note("its inertial lacks mass or inertia; give both"))
    xx, xy, xz, yy, yz, zz = (number(inertia, f"i{key}", "0")
                              for key in ("xx", "xy", "xz", "yy", "yz", "zz"))  # fmt: skip
    moments = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
    return Lump(number(mass, "value"), np.zeros(3), moments).placed(axes @ _origin(inertial))


def _origin(element: Element) -> Frame3:
    origin = element.find("origin")
    if origin is None:
        return Frame3()
    place = np.array(numbers(origin, "xyz", "0 0 0", (3,)))
    return Frame3(place, by_euler(numbers(origin, "rpy", "0 0 0", (3,)), "XYZ"))


def _hang(space: Space, joint: Element, parent: str, link: Element) -> None:
    name, kind, child = _named(joint), joint.get("type"), _named(link)
    axes = space.solids[parent].axes @ _origin(joint)
    _add(space, link, axes)
    dynamics = joint.find("dynamics")
    if dynamics is not None and any(
        number(dynamics, name, "0") for name in ("damping", "friction")
    ):
        space.note(Note("damping and friction of joints are left out"))
    if kind == "fixed":
        solid = space.solids[child]
        solid.lump = solid.lump or Lump(0.0, axes.origin, np.zeros((3, 3)))
        space.rigid.append((parent, child))
        space.solids[parent].points[child] = axes.origin
    elif kind in KINDS:
        space.join(Joint3(name, KINDS[kind], parent, child, axes.origin, _axis(joint, axes)))
    elif kind == "planar":
        space.loose.append(child)
    else:
        known = ", ".join([*map(str, KINDS), "fixed", "planar"])
        raise ModelError(
            called(joint), Note("it is of type {kind!r}; give {known}", kind=kind, known=known)
        )


def _axis(joint: Element, axes: Frame3) -> Array:
    axis = joint.find("axis")
    given = (1.0, 0.0, 0.0) if axis is None else numbers(axis, "xyz", "1 0 0", (3,))
    values: Array = axes.turn @ direction(called(joint), given)
    return values


def _mimics(space: Space, joints: dict[str, Element]) -> None:
    for name, joint in joints.items():
        mimic = joint.find("mimic")
        if mimic is None:
            continue
        other = mimic.get("joint", "")
        hinges = [item for item in (name, other)
                  if item in space.joints and space.joints[item].kind == "hinge"]  # fmt: skip
        if len(hinges) < 2:
            raise ModelError(called(joint), Note("it mimics what is no hinge; leave it out"))
        space.sums.append((called(joint), {name: 1.0, other: -number(mimic, "multiplier", "1")}))
