"""MJCF, the models of MuJoCo: bodies in each other, whose loops `connect` and `weld` close."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from math import radians
from typing import Any
from xml.etree.ElementTree import Element

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.errors import ModelError, at_place
from equipoise.exchange.reading import spatial
from equipoise.exchange.reading.imported import Read
from equipoise.exchange.reading.markup import called, number, numbers
from equipoise.exchange.reading.planar import planar
from equipoise.exchange.reading.spatial import (
    WORLD,
    Frame3,
    Joint3,
    Loop3,
    Lump,
    Pull,
    Solid,
    Space,
    SpatialOptions,
    by_euler,
    by_quaternion,
    combined,
    direction,
    turned,
)
from equipoise.i18n import Note, to_say
from equipoise.signals import Array

UNREAD = {"include", "replicate", "composite", "flexcomp", "attach", "deformable"}
"""Elements that stand for others, which only MuJoCo makes of them."""
GRAVITY = "0 0 -9.81"
"""MuJoCo's."""
LOST = {"stiffness": to_say("springs"), "damping": to_say("damping"),
        "frictionloss": to_say("friction"), "armature": to_say("inertia of rotors")}  # fmt: skip
"""What joints may have beside, and what it is."""


def read(root: Element, options: SpatialOptions) -> Read:
    """The machine of a model.

    Raises
    ------
    ModelError : it has what is not read, or does not move in one plane.
    """
    for element in root.iter():
        if element.tag in UNREAD:
            raise ModelError(
                "",
                Note(
                    "<{tag}> is not read; save the whole model by mj_saveLastXML, and give that",
                    tag=element.tag,
                ),
            )
    return planar(_Model(root).space, options)


@dataclass(frozen=True)
class _Within:
    """Where an element stands: the body, its axes in space, and the class of its defaults."""

    body: str
    axes: Frame3
    kind: str = "main"


class _Model:
    def __init__(self, root: Element) -> None:
        self.root = root
        compiler = _first(root, "compiler")
        if compiler.get("coordinate", "local") != "local":
            raise ModelError(
                "compiler",
                at_place(
                    "coordinate",
                    Note(
                        "got 'global', which MuJoCo has given up; give places and axes in those "
                        "of the body around them"
                    ),
                ),
            )
        self.degrees = compiler.get("angle", "degree") != "radian"
        self.order = compiler.get("eulerseq", "xyz")
        if len(self.order) != 3 or not set(self.order) <= set("xyzXYZ"):
            raise ModelError(
                "compiler", at_place("eulerseq", Note("give three letters such as xyz"))
            )
        self.from_geoms = compiler.get("inertiafromgeom", "auto")
        self.defaults = dict(_defaults(root))
        gravity = numbers(_first(root, "option"), "gravity", GRAVITY, (3,))
        self.space = Space(root.get("model") or "", gravity)
        self.sites: dict[str, tuple[str, Array]] = {}
        self.dofs: list[str] = []  # joints in the order of MuJoCo
        for world in root.findall("worldbody"):
            self._inside(world, _Within(WORLD, Frame3()))
        self._equalities()
        self._springs()
        self._driven()

    # -- bodies --------------------------------------------------------------------------------

    def _inside(self, parent: Element, at: _Within) -> list[Lump | None]:
        """What stands in a body or in axes of it; the masses of its shapes, `None` of meshes."""
        lumps: list[Lump | None] = []
        for element in parent:
            if element.tag == "body":
                self._body(element, at)
            elif element.tag == "frame":
                inner = replace(at, axes=at.axes @ self._axes(element))
                lumps += self._inside(element, self._of_class(element, inner))
            elif element.tag == "site":
                self._site(element, at)
            elif element.tag == "geom":
                node = self._with_defaults(element, at.kind)
                result = spatial.lumps(node, self._axes(node))
                lumps += [None if own is None else own.placed(at.axes) for own in result]
        return lumps

    def _body(self, element: Element, outside: _Within) -> None:
        name = element.get("name") or f"body {len(self.space.solids)}"
        solid = Solid(name, outside.axes @ self._axes(element))
        self.space.add(solid)
        at = self._of_class(element, _Within(name, solid.axes, outside.kind))
        joints = [self._with_defaults(part, at.kind) for part in element.findall("joint")]
        if element.find("freejoint") is not None:
            raise ModelError(
                called(element), Note("it moves freely in space; give a planar machine")
            )
        self._hang(element, joints, outside.body, solid)
        shapes = self._inside(element, at)
        lumps = [shape for shape in shapes if shape is not None]
        inertial = element.find("inertial")
        if inertial is not None and self.from_geoms != "true":
            solid.lump = self._inertial(inertial).placed(solid.axes)
        elif len(lumps) < len(shapes):
            self.space.note(Note("the masses of links with meshes and no inertial are left open"))
        elif lumps and self.from_geoms != "false":
            solid.lump = combined(lumps)
        elif not joints:
            solid.lump = Lump(0.0, solid.axes.origin, np.zeros((3, 3)))

    def _hang(self, element: Element, given: list[Element], parent: str, solid: Solid) -> None:
        """By its joints, one after the other, with bodies without mass between them."""
        joints = [self._joint(item, element, number, len(given), solid)
                  for number, item in enumerate(given, 1)]  # fmt: skip
        self.dofs += [joint.name for joint in joints]
        if not joints:
            self.space.rigid.append((parent, solid.name))
        if sorted(joint.kind for joint in joints) == ["hinge", "slide", "slide"]:
            self.space.loose.append(solid.name)
            return
        for joint in joints:
            last = joint is joints[-1]
            child = solid.name if last else f"{joint.name} carrier"
            if not last:
                none = Lump(0.0, solid.axes.origin, np.zeros((3, 3)))
                self.space.add(Solid(child, solid.axes, none))
            self.space.join(replace(joint, parent=parent, child=child))
            parent = child

    def _joint(
        self, element: Element, body: Element, number: int, count: int, solid: Solid
    ) -> Joint3:
        suffix = f" {number}" if count > 1 else ""
        name = element.get("name") or f"{body.get('name') or solid.name}{suffix}"
        kind = element.get("type", "hinge")
        if kind not in ("hinge", "slide"):
            raise ModelError(
                f"joint {name!r}", Note("it is of type {kind}; give hinge or slide", kind=kind)
            )
        for key, what in LOST.items():
            if any(numbers(element, key, "0")):
                self.space.note(Note("left out of joints: {what}", what=Note(what)))
        axis = solid.axes.turn @ direction(
            f"joint {name!r}", numbers(element, "axis", "0 0 1", (3,))
        )
        place = solid.axes.out(np.array(numbers(element, "pos", "0 0 0", (3,))))
        return Joint3(name, "hinge" if kind == "hinge" else "slide", "", "", place, axis)

    def _inertial(self, element: Element) -> Lump:
        axes = self._axes(element)
        if "fullinertia" in element.keys():  # noqa: SIM118 - an element is no dict
            xx, yy, zz, xy, xz, yz = numbers(element, "fullinertia", count=(6,))
            moments = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
        else:
            moments = np.diag(numbers(element, "diaginertia", "0 0 0", (3,)))
        return Lump(number(element, "mass"), np.zeros(3), moments).placed(axes)

    def _site(self, element: Element, at: _Within) -> None:
        node = self._with_defaults(element, at.kind)
        place = at.axes.out(np.array(numbers(node, "pos", "0 0 0", (3,))))
        if name := element.get("name"):
            self.sites[name] = at.body, place
            self.space.solids[at.body].points[name] = place

    # -- axes and defaults ---------------------------------------------------------------------

    def _axes(self, element: Element) -> Frame3:
        return Frame3(np.array(numbers(element, "pos", "0 0 0", (3,))), self._turn(element))

    def _turn(self, element: Element) -> Array:
        where, unit = called(element), radians if self.degrees else float
        if element.get("quat"):
            return by_quaternion(where, numbers(element, "quat", count=(4,)))
        if element.get("axisangle"):
            *axis, angle = numbers(element, "axisangle", count=(4,))
            return turned(direction(where, tuple(axis)), unit(angle))
        if element.get("euler"):
            angles = numbers(element, "euler", count=(3,))
            return by_euler(tuple(map(unit, angles)), self.order)
        if element.get("xyaxes"):
            both = numbers(element, "xyaxes", count=(6,))
            x, y = direction(where, both[:3]), np.array(both[3:])
            y = direction(where, tuple(y - (y @ x) * x))
            return np.column_stack([x, y, np.cross(x, y)])
        if element.get("zaxis"):
            return spatial.toward(direction(where, numbers(element, "zaxis", count=(3,))))
        return np.eye(3)

    def _of_class(self, element: Element, at: _Within) -> _Within:
        return replace(at, kind=element.get("childclass", at.kind))

    def _with_defaults(self, element: Element, kind: str) -> Element:
        """The element with what its class has and itself has not."""
        kind = element.get("class", kind)
        known = self.defaults.get(kind)
        if known is None and kind != "main":
            raise ModelError(
                called(element), Note("there is no class {kind!r} of defaults", kind=kind)
            )
        return Element(element.tag, {**(known or {}).get(element.tag, {}), **element.attrib})

    # -- what holds and drives -----------------------------------------------------------------

    def _equalities(self) -> None:
        equalities = (item for group in self.root.findall("equality") for item in group)
        for place, entry in enumerate(equalities, 1):
            if entry.get("active") == "false":
                continue
            name = entry.get("name") or f"{entry.tag} {place}"
            if entry.tag == "connect":
                self._connect(entry, name)
            elif entry.tag == "weld":
                if any(numbers(entry, "relpose", "0")[:7]):
                    raise ModelError(
                        name, Note("its relpose is not read; weld bodies as they are drawn")
                    )
                self.space.rigid.append(self._bodies(entry, name))
            elif entry.tag in ("joint", "tendon"):
                self._sum(entry, name)
            else:
                raise ModelError(
                    name, Note("<{tag}> is not read; give connect, weld or joint", tag=entry.tag)
                )

    def _connect(self, element: Element, name: str) -> None:
        if element.get("site1"):
            ends = [self._known(self.sites, element.get(key), name) for key in ("site1", "site2")]
            (first, place), (second, other) = ends
        else:
            first, second = self._bodies(element, name)
            axes = self.space.solids[first].axes
            place = other = axes.out(np.array(numbers(element, "anchor", None, (3,))))
        self.space.loops.append(Loop3(name, (first, second), (place, other)))

    def _bodies(self, element: Element, name: str) -> tuple[str, str]:
        if element.get("site1"):
            first, second = (self._known(self.sites, element.get(key), name)[0]
                             for key in ("site1", "site2"))  # fmt: skip
            return first, second
        first, second = element.get("body1", ""), element.get("body2", WORLD)
        for body in (first, second):
            self._known(self.space.solids, body, name)
        return first, second

    def _known(self, among: Mapping[Any, Any], name: str | None, where: str) -> Any:
        if name not in among:
            raise ModelError(
                where, Note("there is no {name!r} in the file that it could hold", name=name)
            )
        return among[name]

    def _sum(self, element: Element, name: str) -> None:
        """Joints whose angles are tied to each other."""
        if element.tag == "joint":
            first, second = element.get("joint1"), element.get("joint2")
            slope, *bent = (*numbers(element, "polycoef", "0 1 0 0 0"), 0.0, 0.0)[1:]
            factors = {first: 1.0} if second is None else {first: 1.0, second: -slope}
            straight = second is not None and not any(bent)
        else:
            fixed = {tendon.get("name"): tendon for tendon in self.root.findall("tendon/fixed")}
            tendon = self._known(fixed, element.get("tendon1"), name)
            factors = {part.get("joint"): number(part, "coef") for part in tendon}
            straight = element.get("tendon2") is None
        hinges = {key: joint for key, joint in self.space.joints.items() if joint.kind == "hinge"}
        if not straight or not factors.keys() <= hinges.keys():
            raise ModelError(
                name, Note("only angles of hinges in a straight line can be gears; leave it out")
            )
        self.space.sums.append((name, {key: factor for key, factor in factors.items() if key}))

    def _springs(self) -> None:
        for group in self.root.findall("tendon/spatial"):
            sites = [part.get("site", "") for part in group.findall("site")]
            if len(sites) != 2 or len(group) != 2:
                self.space.note(Note("tendons of more than two sites are left out"))
                continue
            ends = [(self._known(self.sites, site, called(group))[0], site) for site in sites]
            stiffness, *_ = numbers(group, "stiffness", "0")
            length, *rest = numbers(group, "springlength", "-1")
            if stiffness <= 0 or length < 0 or any(item != length for item in rest):
                self.space.note(
                    Note("tendons without a stiffness and one springlength are left out")
                )
                continue
            self.space.pulls.append(Pull((ends[0], ends[1]), stiffness, length))

    def _driven(self) -> None:
        """The hinge of an actuator, and its speed by the first key."""
        actuators = [item for group in self.root.findall("actuator") for item in group]
        known = [actuator.get("joint", "") for actuator in actuators]
        self.space.driven = next((item for item in known if item in self.space.joints), "")
        if left := [
            actuator for actuator in actuators if actuator.get("joint") != self.space.driven
        ]:
            self.space.note(Note("{count} other actuators are left out", count=len(left)))
        key = self.root.find("keyframe/key")
        rates = numbers(key, "qvel", "") if key is not None else ()
        if self.space.driven and len(rates) == len(self.dofs):
            self.space.speed = rates[self.dofs.index(self.space.driven)] or None


def _first(root: Element, tag: str) -> Element:
    """The attributes of all elements of a kind together, of which the last one counts."""
    merged = Element(tag)
    for part in root.findall(tag):
        merged.attrib.update(part.attrib)
    return merged


def _defaults(
    root: Element, known: Mapping[str, Mapping[str, str]] | None = None, top: bool = True
) -> Iterator[tuple[str, dict[str, dict[str, str]]]]:
    """Attributes by tag, by class; a class has those of the one around it too."""
    for element in root.findall("default"):
        own = {tag: dict(values) for tag, values in (known or {}).items()}
        for item in element:
            own[item.tag] = {**own.get(item.tag, {}), **item.attrib}
        yield from (
            (name, own) for name in (element.get("class", ""), "main" if top else "") if name
        )
        yield from _defaults(element, own, top=False)
