"""MJCF, the models of MuJoCo: a tree of bodies in the plane x y, whose loops `connect` closes.

Bodies have the axes of their links, so that every number of the file is there again; coordinates of
joints count from the position that is drawn.  Loops, gears and the drive's speed are held softly,
as MuJoCo holds everything but its tree.  A mount is an actuator between a site of the support and
one of the ground: its force keeps its direction, as `support.mounts` has it.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from math import pi
from xml.etree import ElementTree as ET

import numpy as np

from equipoise.exchange.formats import Job
from equipoise.exchange.tree import (
    Hung,
    Tree,
    constant_loads,
    moment_of,
    place_of,
    preloads,
    pull_of,
    push_of,
    tensor_of,
    trees,
    weighed,
)
from equipoise.i18n import Note
from equipoise.mechanism.assembly.linkage import assemble
from equipoise.mechanism.dynamics.forces import forces
from equipoise.mechanism.kinematics.friction_joints import rubbing_joints
from equipoise.mechanism.kinematics.motion import move
from equipoise.mechanism.parts.links import Link, size_of
from equipoise.mechanism.parts.machine import FRAME, Machine
from equipoise.mechanism.parts.support import FREEDOMS, Support, unit_vector
from equipoise.signals import Array

STEPS = 2000
"""Steps of the integration in a turn of the crank: so many that loops, whose errors die out over
some steps, come apart by less than a thousandth of the size of the linkage."""
LIGHT = 1e-8
"""Mass over that of all links, inertia over that times the square of their size: what a link gets
that has less, since MuJoCo refuses bodies without and computes badly with hardly any."""
SOFT, SLOW = 4, 2.0
"""Steps in which an error of a constraint dies out, and its damping over the critical one; with
less the integration may explode."""
STIFF = 1e4
"""Drive torque at its peak over what the speed falls behind by at that torque, over the speed: the
servo then adds less to the error than the soft constraints."""
BASE = "support"
FAR = 1e30
"""Of a force: no limit."""


def export_bytes(job: Job) -> str:
    """The file's text."""
    machine = weighed(job.machine)
    trees_of_links = trees(job)
    root = ET.Element("mujoco", model=str(machine.title))
    _options(root, machine)
    world = ET.SubElement(root, "worldbody")
    base = world if machine.support is None else _support(world, machine, machine.support)
    for name, (x, y) in machine.frame.items():
        for tree in trees_of_links:
            dx, dy = tree.row.offset
            _site(base, f"{FRAME} {name}{tree.suffix}", (x + dx, y + dy, tree.row.lateral))
    for tree in trees_of_links:
        _links(base, tree, job)
        _constraints(root, tree)
        for write in job.writers("mjcf"):
            write(root, tree, job)
        _drags(root, tree)
        _loads(root, world, tree, job)
    _shaft(root, trees_of_links)
    if machine.support is not None:
        _mounts(root, world, base, machine)
    _drive(root, trees_of_links[0], job)
    _start(root, trees_of_links, machine)
    ET.indent(root)
    return ET.tostring(root, encoding="unicode") + "\n"


def _options(root: ET.Element, machine: Machine) -> None:
    step = 2 * pi / (abs(machine.drive.speed) or 1.0) / STEPS
    ET.SubElement(root, "compiler", angle="radian", inertiafromgeom="false", balanceinertia="false")
    option = ET.SubElement(
        root,
        "option",
        gravity=_row((*machine.gravity, 0.0)),
        timestep=repr(step),
        integrator="implicitfast",
        iterations="200",
        tolerance="1e-14",
    )
    ET.SubElement(option, "flag", contact="disable")
    default = ET.SubElement(root, "default")
    softness = {"solref": _row((SOFT * step, SLOW)), "solimp": "0.9999 0.9999 0.001 0.5 2"}
    ET.SubElement(default, "equality", softness)
    for kind in ("joint", "tendon"):  # so that drag has its full size at any speed worth the name
        ET.SubElement(default, kind, solreffriction=softness["solref"])
    ET.SubElement(default, "geom", contype="0", conaffinity="0", rgba="0.35 0.5 0.65 1")


def _row(values: Sequence[float]) -> str:
    return " ".join(repr(float(value)) for value in values)


def _site(body: ET.Element, name: str, place: Sequence[float]) -> None:
    ET.SubElement(body, "site", name=name, pos=_row((*place, 0.0)[:3]))


# -- bodies ----------------------------------------------------------------------------------------


def _links(base: ET.Element, tree: Tree, job: Job) -> None:
    """Every link inside of the body that carries it; the mass of a flywheel is the support's."""
    machine, bodies = tree.machine, {FRAME: base}
    size = _size(machine)
    least = LIGHT * machine.mass, LIGHT * machine.mass * size**2
    for link in tree.links:
        place, turned = tree.relative_pose(link)
        name = f"{link.name}{tree.suffix}"
        spot = place.real, place.imag, tree.across(link)
        pose = {"pos": _row(spot), "euler": _row((0, 0, turned))}
        body = ET.SubElement(bodies[link.parent], "body", pose, name=name)
        bodies[link.name] = body
        _joint(body, name, link)
        mass, center, tensor = tensor_of(machine.links[link.name])
        if mass < least[0] or tensor[2, 2] < least[1]:
            job.leave_out(
                Note(
                    "that {link!r} has no mass or no inertia: MuJoCo requires some, and gets the "
                    "least that it accepts",
                    link=link.name,
                )
            )
        if link.name == machine.drive.link:
            tensor = tensor + tree.flywheel * np.eye(3)
        _inertial(body, max(mass, least[0]), center, _moments(tensor, least[1]))
        _shape(body, name, machine.links[link.name], size / 100)


def _moments(tensor: Array, least: float) -> Sequence[float]:
    """Moments of inertia, at least so large, and the products where there are any."""
    products = [float(tensor[place]) for place in ((0, 1), (0, 2), (1, 2))]
    moments = [max(float(item), least) for item in np.diagonal(tensor)]
    return [*moments, *products] if any(products) else moments


def _size(machine: Machine) -> float:
    """A length of the size of the links, m; for masses and lines that are to be small or thin."""
    return max(size_of(body) for body in machine.bodies.values())


def _joint(body: ET.Element, name: str, link: Hung) -> None:
    if link.kind == "hinge":
        ET.SubElement(body, "joint", name=name, type="hinge", axis="0 0 1", pos=_row((*link.at, 0)))
    else:
        along = _row((np.cos(link.along), np.sin(link.along), 0.0))
        ET.SubElement(body, "joint", name=name, type="slide", axis=along)


def _inertial(
    body: ET.Element, mass: float, center: Sequence[float], moments: Sequence[float]
) -> None:
    """Mass (kg), its centre, and moments of inertia about it, with products where there are six."""
    kind = "diaginertia" if len(moments) == 3 else "fullinertia"
    place = _row((*center, 0.0)[:3])
    ET.SubElement(body, "inertial", {"pos": place, "mass": repr(mass), kind: _row(moments)})


def _shape(body: ET.Element, name: str, link: Link, thin: float) -> None:
    """Sites at the points of a link, and lines from its first one to be seen."""
    first, *others = link.points.values()
    for point, place in link.points.items():
        _site(body, f"{name} {point}", (*place, link.plane_of(point) - link.plane))
    if not others:
        ET.SubElement(body, "geom", type="sphere", size=repr(2 * thin), pos=_row((*first, 0)))
    for place in others:
        ends = _row((*first, 0, *place, 0))
        ET.SubElement(body, "geom", type="capsule", size=repr(thin), fromto=ends)


def _support(world: ET.Element, machine: Machine, support: Support) -> ET.Element:
    """The body that carries the linkages, whose axes are the frame's."""
    base = ET.SubElement(world, "body", name=BASE)
    for name, direction in zip(FREEDOMS, np.vstack([np.eye(3)] * 2), strict=True):
        if name in support.coordinates:
            kind = "slide" if FREEDOMS.index(name) < 3 else "hinge"
            at = _row(support.reference)
            ET.SubElement(base, "joint", name=name, type=kind, axis=_row(direction), pos=at)
    moments = support.inertia or (moment_of(support),)
    x, y, z = moments if len(moments) == 3 else moments * 3
    xy, yz, zx = (-item for item in support.products or (0.0, 0.0, 0.0))
    z -= machine.drive.flywheel  # it turns with the crank, where it is written
    _inertial(base, support.mass, support.center_of_mass, (x, y, z, xy, zx, yz))
    for name, gauge in support.gauges.items():
        if gauge.point is not None:
            _site(base, f"gauge {name}", gauge.point)
    return base


# -- what holds and drives them --------------------------------------------------------------------


def _part(root: ET.Element, name: str) -> ET.Element:
    """The part of the file for things of a kind, made where it is not there yet."""
    result = root.find(name)
    return ET.SubElement(root, name) if result is None else result


def _constraints(root: ET.Element, tree: Tree) -> None:
    """Pins that close loops, and gears: sums of angles that stay what they are."""
    for loop in tree.loops:
        plane = _plane(tree, loop.second, loop.pin)
        ends = (
            _in_plane(root, tree, loop.first, loop.pin, plane),
            _place(tree, loop.second, loop.pin),
        )
        sites = {f"site{number}": name for number, name in enumerate(ends, 1)}
        ET.SubElement(_part(root, "equality"), "connect", sites)
    for gear, factors in tree.proportions:
        _constant_sum(
            root, f"{gear}{tree.suffix}", {f"{k}{tree.suffix}": v for k, v in factors.items()}
        )


def _place(tree: Tree, body: str, point: str) -> str:
    """Name of a point's site."""
    if body == FRAME:
        return f"{FRAME} {point}{tree.suffix}"
    return f"{body}{tree.suffix} {point}"


def _plane(tree: Tree, body: str, point: str) -> float:
    return 0.0 if body == FRAME else tree.machine.links[body].plane_of(point)


def _in_plane(root: ET.Element, tree: Tree, body: str, point: str, plane: float) -> str:
    """Name of a site of a point in a plane; of another where the point's own lies beside it."""
    name, beyond = _place(tree, body, point), plane - _plane(tree, body, point)
    other = f"{name} at {plane!r}"
    if not beyond:
        return name
    sites = {s.get("name"): (part, s) for part in root.iter() for s in part.findall("site")}
    if other not in sites:
        holder, site = sites[name]
        x, y, z = map(float, site.get("pos", "").split())
        _site(holder, other, (x, y, z + beyond))
    return other


def _constant_sum(root: ET.Element, name: str, factors: Mapping[str, float]) -> None:
    """A sum of coordinates of joints that stays what it is."""
    tendon = ET.SubElement(_part(root, "tendon"), "fixed", name=name)
    for joint, factor in factors.items():
        ET.SubElement(tendon, "joint", joint=joint, coef=repr(factor))
    ET.SubElement(_part(root, "equality"), "tendon", tendon1=name)


def springs(root: ET.Element, tree: Tree, job: Job) -> None:
    """Tendons with a stiffness."""
    for spring in tree.machine.springs:
        if spring.stiffness is None:
            job.leave_out_table(spring)
            continue
        rest = spring.free_length
        if spring.preload is not None:
            rest -= spring.preload / spring.stiffness
        if rest < 0:
            job.leave_out(Note("springs that pull at every length"))
            continue
        rates = {"stiffness": repr(spring.stiffness), "springlength": repr(rest)}
        _between(root, tree, spring.points, rates)


def torsion_springs(root: ET.Element, tree: Tree, job: Job) -> None:
    """Tendons as long as an angle, with a stiffness."""
    for number, torsion in enumerate(tree.machine.torsion_springs):
        if torsion.stiffness is None:
            job.leave_out_table(torsion)
            continue
        start_angle = float(tree.motion.element_values("torsion_springs", number)["angle"][0])
        rest = torsion.angle + torsion.preload / torsion.stiffness - start_angle
        rates = {"stiffness": repr(torsion.stiffness), "springlength": _row((rest, rest))}
        _turning(root, tree, (torsion.link, torsion.on), rates)


def _between(
    root: ET.Element,
    tree: Tree,
    ends: Sequence[tuple[str, str]],
    rates: Mapping[str, str],
) -> None:
    """A tendon between two points of bodies, in the plane of the first."""
    tendon = ET.SubElement(_part(root, "tendon"), "spatial", dict(rates))
    plane = _plane(tree, *ends[0])
    for body, point in ends:
        ET.SubElement(tendon, "site", site=_in_plane(root, tree, body, point, plane))


def _turning(
    root: ET.Element, tree: Tree, bodies: tuple[str, str], rates: Mapping[str, str]
) -> None:
    """A tendon whose length is the angle of a body less that of another."""
    tendon = ET.SubElement(_part(root, "tendon"), "fixed", dict(rates))
    for joint, factor in tree.angle_between(*bodies).items():
        ET.SubElement(tendon, "joint", joint=f"{joint}{tree.suffix}", coef=repr(factor))


def dampers(root: ET.Element, tree: Tree, job: Job) -> None:
    """Tendons with damping."""
    for damper in tree.machine.dampers:
        if damper.linear:
            _between(root, tree, damper.points, {"damping": repr(damper.damping)})
        else:
            job.leave_out_table(damper)


def torsion_dampers(root: ET.Element, tree: Tree, job: Job) -> None:
    """Tendons as long as an angle, with damping."""
    for torsion in tree.machine.torsion_dampers:
        if torsion.linear:
            rates = {"damping": repr(torsion.damping)}
            _turning(root, tree, (torsion.link, torsion.on), rates)
        else:
            job.leave_out_table(torsion)


def resistances(root: ET.Element, tree: Tree, job: Job) -> None:
    """Viscous ones, as forces on sites against their speeds along lines of the frame."""
    for number, item in tree.on_ground(tree.machine.resistances, job):
        if not item.linear:
            job.leave_out(Note("dry and one-way parts of resistances"))
        if not item.damping or item.one_way:
            continue
        site, other = (
            _place(tree, body, at) for body, at in ((item.link, item.point), (FRAME, item.to))
        )
        ways = (0.0, np.pi / 2) if item.direction is None else (item.direction,)
        for k, way in enumerate(ways):
            name = f"resistance {number}{' across' if k else ''}{tree.suffix}"
            _push(root, name, site, other, _along(way), (0.0, 0.0, -item.damping))


def bushings(root: ET.Element, tree: Tree, job: Job) -> None:
    """Pushes on sites by their way and speed in the axes of the frame, and turning tendons."""
    for number, item in tree.on_ground(tree.machine.bushings, job):
        site, other = _place(tree, item.link, item.point), _place(tree, FRAME, item.to)
        laws = zip(item.preload, item.stiffness, item.damping, strict=True)
        for k, (preload, stiffness, damping) in enumerate(laws):
            if preload or stiffness or damping:
                name = f"bushing {number}{' across' if k else ''}{tree.suffix}"
                gear = _along(item.direction + k * pi / 2)
                _push(root, name, site, other, gear, (preload, -stiffness, -damping))
        stiffness = item.torsional_stiffness or 0.0
        rates = {"stiffness": repr(stiffness), "damping": repr(item.torsional_damping or 0.0)}
        if stiffness:
            rest = tree.rest_angle(number, item)
            rates["springlength"] = _row((rest, rest))
        elif item.torque:
            gear = (0.0, 0.0, 0.0, 0.0, 0.0, item.torque)
            _push(
                root, f"bushing {number} turning{tree.suffix}", site, other, gear, (1.0, 0.0, 0.0)
            )
        if stiffness or item.torsional_damping:
            _turning(root, tree, (item.link, FRAME), rates)


def stops(root: ET.Element, tree: Tree, job: Job) -> None:
    """Pushes on sites that never pull; what contacts lose is a product of way and speed, which no
    actuator has.
    """
    for number, item in tree.on_ground(tree.machine.stops, job):
        if item.dissipation is not None:
            job.leave_out(Note("the restitution of stops: they lose nothing"))
        site, other = _place(tree, item.link, item.point), _place(tree, FRAME, item.to)
        push = (0.0, -item.stiffness, 0.0)
        name = f"stop {number}{tree.suffix}"
        _push(root, name, site, other, _along(item.direction), push, one_sided=True)


def _along(direction: float) -> tuple[float, ...]:
    """Factors of a push along a direction of the frame."""
    return float(np.cos(direction)), float(np.sin(direction)), 0.0, 0.0, 0.0, 0.0


def _drags(root: ET.Element, tree: Tree) -> None:
    """What resists in joints whatever presses there: of a slide that of its joint, of a pin, which
    may close a loop, that of a tendon as long as its angle.
    """
    for joint in rubbing_joints(assemble(tree.machine)):
        named = zip(("damping", "frictionloss"), joint.unloaded, strict=True)
        numbers = {name: repr(rate) for name, rate in named if rate}
        if joint.slider is None:
            _turning(root, tree, (joint.on, joint.by), numbers)
        else:
            name = f"{tree.slide_of(joint.slider).name}{tree.suffix}"
            slides = (item for item in root.iter("joint") if item.get("name") == name)
            next(slides).attrib.update(numbers)


def _loads(root: ET.Element, world: ET.Element, tree: Tree, job: Job) -> None:
    """Loads that are always the same."""
    for number, load in constant_loads(job):
        name = f"load {number}{tree.suffix}"
        if (pull := pull_of(load)) is not None:
            end, to, force_in_line = pull
            _between(root, tree, (end, to), {"name": name})  # a tendon that an actuator shortens
            _actuator(root, name, {"tendon": name}, (-force_in_line, 0.0, 0.0))
            continue
        point, force, torque = push_of(load, tree.machine)
        site, turns = _place(tree, load.link, point), load.axes is not None
        if not turns:
            _site(world, name, (0, 0, 0))
        gear = (force.real, force.imag, 0, 0, 0, torque)
        _push(root, name, site, None if turns else name, gear, (1.0, 0.0, 0.0))


def _push(
    root: ET.Element,
    name: str,
    site: str,
    against: str | None,
    gear: Sequence[float],
    push: Sequence[float],
    one_sided: bool = False,
) -> None:
    """A force on a site along a direction of another, or of its own where there is none: at the
    start, less by way and by speed.
    """
    where = {"site": site, "gear": _row(gear)}
    if one_sided:
        where["forcerange"] = _row((0.0, FAR))
    if against is not None:
        where["refsite"] = against
    _actuator(root, name, where, push)


def _actuator(root: ET.Element, name: str, where: Mapping[str, str], push: Sequence[float]) -> None:
    """An actuator without a control: its force at the start, by way and by speed."""
    law = {"gainprm": "0", "biastype": "affine", "biasprm": _row(push)}
    ET.SubElement(_part(root, "actuator"), "general", {"name": name, **where, **law})


def _drive(root: ET.Element, tree: Tree, job: Job) -> None:
    """The crank at constant speed, by a servo that no torque of the machine slows down much."""
    machine, speed = tree.machine, tree.machine.drive.speed
    job.leave_out_motor()
    torque = np.max(np.abs(forces(move(machine, acceleration=0.0)).drive_torque))
    stiff = STIFF * (float(torque) or 1.0) / (abs(speed) or 1.0)
    crank = f"{machine.drive.link}{tree.suffix}"
    ET.SubElement(_part(root, "actuator"), "velocity", name="drive", joint=crank, kv=repr(stiff))
    ET.SubElement(_part(root, "sensor"), "actuatorfrc", name="drive torque", actuator="drive")


def _shaft(root: ET.Element, trees: Sequence[Tree]) -> None:
    """Cranks of all rows turn together."""
    first, *others = (f"{tree.machine.drive.link}{tree.suffix}" for tree in trees)
    for crank in others:
        _constant_sum(root, f"shaft to {crank}", {crank: 1.0, first: -1.0})


def _mounts(root: ET.Element, world: ET.Element, base: ET.Element, machine: Machine) -> None:
    """Springs and dampers under the support, with what they carry at rest."""
    support, carried = machine.support, preloads(machine)
    assert support is not None
    for name, mount in support.mounts.items():
        place = place_of(mount, support)
        rates = (carried[name], -mount.spring, -mount.damper)
        if mount.axis is not None:
            turning = np.eye(6)[FREEDOMS.index(mount.axis)]
            gear = turning.tolist()
        else:
            gear = [*unit_vector(mount.direction), 0, 0, 0]
        _site(world, f"ground of {name}", place)
        _site(base, f"mount {name}", place)
        _push(root, f"mount {name}", f"mount {name}", f"ground of {name}", gear, rates,
              mount.one_sided)  # fmt: skip


def _start(root: ET.Element, trees: Sequence[Tree], machine: Machine) -> None:
    """Speeds of all joints where it is drawn, by the key `start`."""
    still = [] if machine.support is None else [0.0] * len(machine.support.coordinates)
    rates = [*still, *(rate for tree in trees for rate in _in_order(tree))]
    pushes = [0.0] * (len(root.findall("actuator/general")))
    control = [*pushes, machine.drive.speed]
    key = ET.SubElement(root, "keyframe")
    ET.SubElement(key, "key", name="start", qvel=_row(rates), ctrl=_row(control))


def _in_order(tree: Tree, parent: str = FRAME) -> Iterator[float]:
    """Rates in the order in which MuJoCo counts: a link, all that hangs on it, the next."""
    for link in tree.links:
        if link.parent == parent:
            yield link.rate
            yield from _in_order(tree, link.name)
