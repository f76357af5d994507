"""Links beside each other: out-of-plane moments, planes of joints, couples in joints.

With R the force and C the couple that a joint in the plane z exerts on a link, and Q the sum of
z times the forces that the link needs, every link asks for sum(z R + C) = Q.  Forces are complex,
x + i y, so that i times such a sum is the moment about x and y.

A chain that closes has more couples than equations.  A pin in the frame is taken for as stiff as
its bearings, which bear whatever its link needs; a link without one hands its couple on by its
joints, in equal shares (least squares).  Where all that acts on such a link lies in one plane there
is none to hand on, and nothing is open.

A force in the plane z has the moment i z F about the axes x and y, complex as all planar vectors
are.  Everything here is linear in the demands, as the forces in the plane are.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import field, replace
from functools import cached_property, partial
from itertools import chain
from typing import Any

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.decompositions import pinv
from equipoise.i18n import Note, all_of
from equipoise.mechanism.assembly.steps import p, u
from equipoise.mechanism.checks import FRAME, NamedItems, numbered
from equipoise.mechanism.dynamics.loads import (
    acting_elements,
    acting_load,
    acting_preloads,
    load_on_links,
    soil_loads,
)
from equipoise.mechanism.dynamics.reactions import (
    PUSH,
    Acting,
    JointForce,
    JointReactions,
    VectorSignal,
    full,
)
from equipoise.mechanism.formulas import kernels
from equipoise.mechanism.kinematics.cylinders import ends_of, pushes
from equipoise.mechanism.kinematics.indicators import loads_of
from equipoise.mechanism.kinematics.motion import Motion
from equipoise.mechanism.parts.joint_properties import JOINTS
from equipoise.mechanism.parts.links import Mechanism, masses_of, moments_across
from equipoise.mechanism.parts.loads import Load
from equipoise.signals import Array


@dataclass(frozen=True)
class BodyContact:
    """Where the body `by` exerts a force on the body `on`: in which plane (m), and whether it can
    exert a couple across it, as pins and sliders can.
    """

    name: str
    on: str
    by: str
    plane: float
    bears: bool

    @property
    def ends(self) -> tuple[str, str]:
        """Both bodies."""
        return self.on, self.by


def contacts(linkage: Any) -> tuple[BodyContact, ...]:
    """Every joint and push of a linkage, as `exerted_in` has them.

    A joint lies in the plane of the link that no joint holds in the frame; one with the frame in
    that of its link; one of two links that are alike midway between them.
    """
    machine, order = linkage.machine, linkage.joints.bodies.index
    ends = {name: _ends(linkage, item) for name, item in linkage.named_reactions
            if item.kind in JOINTS}  # fmt: skip
    on_frame = {end for both in ends.values() for end in both if FRAME in both}
    body_contacts = []
    for name, entry in linkage.named_reactions:
        if entry.kind not in JOINTS:
            plane = machine.links[entry.on].plane
            body_contacts.append(BodyContact(name, entry.on, entry.by, plane, False))
            continue
        by, on = sorted(ends[name], key=order)
        points = {entry.on: entry.at, entry.by: entry.at}
        if rider := linkage.joints.riders.get(entry.name):
            points = {body: next(iter(own.values())) for body, own in rider.constraints.items()}
            by, on = rider.on, rider.link
        elif entry.kind == "slider":
            slider = next(s for s in machine.sliders if s.name == entry.name)
            points = {slider.link: slider.point, slider.on: slider.through}
        body_contacts.append(
            BodyContact(name, on, by, _plane_between(machine, points, on_frame), True)
        )
    return tuple(body_contacts)


def pushing(linkage: Any) -> Iterator[BodyContact]:
    """Every drive that pushes: along a sliding joint in the plane of that, and between two points
    in the plane of a link's, midway between those of two links.
    """
    machine, planes = (
        linkage.machine,
        {contact.name: contact.plane for contact in contacts(linkage)},
    )
    for drive in machine.pushers:
        by, on = ends_of(machine, drive)
        if drive.slider:
            plane = planes[drive.slider]
        else:
            points = zip((by, on), drive.between, strict=True)
            own_planes = [
                machine.links[body].plane_of(item) for body, item in points if body != FRAME
            ]
            plane = sum(own_planes) / len(own_planes)
        yield BodyContact(PUSH.format(drive.link), on, by, plane, False)


def _ends(linkage: Any, reaction: Any) -> tuple[str, str]:
    rider = linkage.joints.riders.get(reaction.name)
    return (reaction.on, reaction.by) if rider is None else (rider.link, rider.on)


def _plane_between(machine: Mechanism, points: Mapping[str, str], on_frame: set[str]) -> float:
    """Plane of a joint of two bodies, each with its point there."""
    ends = [(body, machine.links[body], point) for body, point in points.items() if body != FRAME]
    values = [link.planes[point] for _, link, point in ends if point in link.planes]
    loose = [link.plane for body, link, _ in ends if body not in on_frame]
    planes = values[:1] or (loose if len(loose) == 1 else [link.plane for _, link, _ in ends])
    return sum(planes) / len(planes)


@dataclass(frozen=True, eq=False)
class Statics:
    """Couples across the plane as sums of what the links need and of what the joints exert.

    contacts : K of them, pushing drives last, of which J bear couples.
    by_needed : (J, L) of sums Q of each link.
    by_plane : (J, K) of each contact's plane times force.
    """

    machine: Any
    contacts: tuple[BodyContact, ...]
    by_needed: Array
    by_plane: Array

    @property
    def links(self) -> tuple[str, ...]:
        return tuple(self.machine.links)

    @cached_property
    def bearing(self) -> tuple[BodyContact, ...]:
        """Those that bear couples."""
        return tuple(contact for contact in self.contacts if contact.bears)

    @cached_property
    def open(self) -> tuple[str, ...]:
        """Names of joints whose couples statics leaves open."""
        on_frame = {end for item in self.bearing for end in item.ends if FRAME in item.ends}
        free = [link for link in self.links if link not in on_frame]
        return tuple(_open(self.machine, self.contacts, free))

    def factors(self, number: int) -> tuple[dict[str, float], dict[str, float]]:
        """Of the couple of one of `bearing`: those of what links need, and of planes of contacts
        times their forces, by name.
        """
        needed = _used(self.by_needed[number], self.links)
        return needed, _used(self.by_plane[number], [contact.name for contact in self.contacts])

    def pin_of(self, link: str) -> tuple[int, BodyContact]:
        """The joint by which a link turns in its bearings, and its number among `bearing`."""
        return next(
            (k, item) for k, item in enumerate(self.bearing) if (item.on, item.by) == (link, FRAME)
        )

    def couples(self, needed: Mapping[str, Array], exerted: Mapping[str, Array]) -> dict[str, Any]:
        """Couple of each joint by name, as a sum of planes times forces, N m; of those that follow
        from the given forces.
        """
        values, planes = {}, {contact.name: contact.plane for contact in self.contacts}
        for number, item in enumerate(self.bearing):
            by_needed, by_plane = self.factors(number)
            levers = {k: factor * planes[k] for k, factor in by_plane.items() if planes[k]}
            if not {item.name, *levers} <= exerted.keys():
                continue
            terms = [factor * needed[link] for link, factor in by_needed.items()]
            terms += [lever * exerted[name] for name, lever in levers.items()]
            values[item.name] = sum(terms, start=0.0)
        return values

    def notes(self) -> Iterator[Note]:
        """A sentence on what is open."""
        if self.open:
            yield Note(
                "the tilting moments in {joints} are statically indeterminate, because forces on "
                "a link act in several planes and no joint connects it to the frame: reported "
                "are those of least squares; rocking moments do not depend on this choice",
                joints=all_of([*self.open], commas=True),
            )


def _used(row: Array, names: Sequence[str]) -> dict[str, float]:
    """Factors that are not rounding, by what they belong to."""
    least = 1e-12 * max(float(np.max(np.abs(row), initial=0.0)), 1e-300)
    return {name: float(f) for f, name in zip(row, names, strict=True) if abs(f) > least}


def _signs(links: Sequence[str], joints: Sequence[BodyContact]) -> Array:
    """(L, K): 1 where a joint acts on a link, -1 where the link is what acts."""
    return np.array(
        [[(joint.on == k) - (joint.by == k) for joint in joints] for k in links], dtype=float
    )


def statics(linkage: Any) -> Statics:
    """How couples go from link to link in a linkage."""
    machine, all_of = linkage.machine, (*contacts(linkage), *pushing(linkage))
    links, bearing = tuple(machine.links), [item for item in all_of if item.bears]
    signs = _signs(links, bearing)
    fixed = np.array([FRAME in (item.on, item.by) for item in bearing])
    is_so = np.any(signs[:, fixed] != 0, axis=1)
    values = np.zeros((len(bearing), len(links)))
    # first what links without a joint in the frame hand on, then what all others bear
    values[np.ix_(~fixed, ~is_so)] = pinv(signs[np.ix_(~is_so, ~fixed)])
    rest = np.eye(len(links)) - signs[:, ~fixed] @ values[~fixed]
    values[fixed] = pinv(signs[np.ix_(is_so, fixed)]) @ rest[is_so]
    return Statics(machine, all_of, values, -values @ _signs(links, all_of))


def _open(machine: Any, joints: Sequence[BodyContact], free: Sequence[str]) -> Iterator[str]:
    """Joints by which links hand couples on that could go another way as well."""
    bearing = [joint for joint in joints if joint.bears]
    for group in _chains(free, bearing):
        own = [item for item in bearing if group & {item.on, item.by}]
        if len(own) > len(group) and not all(_flat(machine, link, joints) for link in group):
            yield from (item.name for item in own)


def _chains(links: Iterable[str], joints: Sequence[BodyContact]) -> list[set[str]]:
    """Links in sets that hang together by joints among themselves."""
    groups = [{link} for link in links]
    for joint in joints:
        met = [group for group in groups if group & {joint.on, joint.by}]
        if len(met) == 2:
            met[0].update(met[1])
            groups.remove(met[1])
    return groups


def _flat(machine: Any, link: str, joints: Sequence[BodyContact]) -> bool:
    """Whether all that acts on a link lies in one plane."""
    body = machine.links[link]
    planes = {joint.plane for joint in joints if link in (joint.on, joint.by)}
    planes |= {plane for mass, _, plane in masses_of(body) if mass}
    planes |= {
        body.plane_of(item.point) for item in machine.loads if item.link == link and item.point
    }
    planes |= {
        plane_in(machine, item.link, item.point)
        for item in machine.loads
        if item.reaction == link and item.point
    }
    ends = (end for *_, element in machine.force_elements for end in element.points)
    planes |= {body.plane_of(point) for on, point in ends if on == link}
    planting = machine.planting
    if planting is not None and planting.soil is not None:
        planes |= {body.plane_of(arm.tip) for arm in planting.every_arm if arm.tip in body.points}
    return len(planes) <= 1


Needed = Mapping[str, Any]
"""Link -> sum of planes times the forces that it needs, N m, complex (..., N)."""

OF_FRAME = ("rocking_moment", "frame_rocking_moment")
"""Outputs of `OutOfPlaneMoments` that the frame feels."""


@dataclass(frozen=True, eq=False)
class OutOfPlaneMoments:
    """Moments and forces of links beside each other, arrays (..., N).

    inertia, weights, loads, springs : what each link needs, by what makes it.
    exerted : name -> force in each joint and mesh.
    outer : those of the loads that come from outside.
    """

    motion: Motion
    inertia: Needed
    weights: Needed
    loads: Needed
    springs: Needed
    exerted: Mapping[str, JointForce]
    outer: Needed = field(default_factory=dict)

    @cached_property
    def statics(self) -> Statics:
        """How couples go from link to link."""
        return statics(self.motion.linkage)

    @cached_property
    def rocking_moment(self) -> VectorSignal:
        """Minus the rate of change of angular momentum about x and y, in the plane 0, N m."""
        return self._on_frame(self.inertia)

    @cached_property
    def frame_rocking_moment(self) -> VectorSignal:
        """Moment of all joints and springs on the frame about x and y, in the plane 0, N m."""
        return self._on_frame(self.inertia, self.weights, self.outer)

    def _on_frame(self, *needed: Needed) -> VectorSignal:
        whole: Any = sum(value for item in needed for value in item.values())
        return VectorSignal(full(self.motion, -1j * whole, complex))

    @cached_property
    def _couples(self) -> dict[str, Any]:
        """Couple of each joint, as a sum of planes times forces."""
        total: dict[str, Any] = dict.fromkeys(self.motion.machine.links, 0.0)
        for needed in (self.inertia, self.weights, self.loads, self.springs):
            for link, value in needed.items():
                total[link] = total[link] + value
        return self.statics.couples(
            total, {k: joint_force.value for k, joint_force in self.exerted.items()}
        )

    @cached_property
    def tilting_moments(self) -> Mapping[str, JointForce]:
        """Moment about x and y in each joint, N m, about its own plane."""
        result = []
        for name, couple in self._couples.items():
            on, by = self.exerted[name].on, self.exerted[name].by
            result.append((name, JointForce(full(self.motion, 1j * couple, complex), on, by)))
        return NamedItems("joint", result)

    @cached_property
    def bearings(self) -> Mapping[str, JointForce]:
        """Force of each bearing on its link, N."""
        given = self.motion.machine.bearings
        result = {}
        for name, bearing in given.items():
            both = {at: item.plane for at, item in given.items() if item.link == bearing.link}
            other = sum(both.values()) - bearing.plane
            _, pin = self.statics.pin_of(bearing.link)
            if pin.name not in self._couples:
                continue
            force = self.exerted[pin.name]
            lever = (other - pin.plane) * force.value - self._couples[pin.name]
            result[name] = replace(force, value=lever / (other - bearing.plane))
        return NamedItems("bearing", result.items())


def exerted_in(solved: JointReactions) -> dict[str, JointForce]:
    """Force in each joint, and whatever else bodies push each other with, by name."""
    motion, by_name = solved.motion, dict(solved.joints)

    def put(name: str, force: Any, on: str, by: str) -> None:
        by_name[name] = JointForce(full(motion, force, complex), on, by)

    for name, item in motion.linkage.named_reactions:
        if item.kind not in JOINTS:
            put(name, solved.state[item.force], item.on, item.by)
    for drive in motion.machine.pushers:
        (on, _, way), (by, *_) = pushes(motion, drive)
        name = PUSH.format(drive.link)
        put(name, solved.state[name] * way, on, by)
    return by_name


def needed_by_inertia(motion: Motion, link: str, own: tuple[Any, Any]) -> Any:
    """What moves a link of these moments of its masses across the plane about its anchor."""
    _, p1, p2 = (motion.state[name] for name in p(motion.linkage.anchors[link]))
    rotation, w, a = (motion.state[name] for name in u(link))
    rates = motion.speed**2, motion.acceleration
    return kernels.inertia_demand(p1, p2, rotation, w, a, *rates, *own, 0.0)[0]


def masses_across(motion: Motion) -> tuple[dict[str, Any], dict[str, Any]]:
    """What inertia and weight of every link need."""
    gravity = complex(*motion.machine.gravity)
    inertia, weights = {}, {}
    for name, link in motion.machine.links.items():
        own = moments_across(link, motion.linkage.anchors[name])
        inertia[name] = needed_by_inertia(motion, name, own)
        weights[name] = kernels.weight_demand(motion.state[f"u({name})"], *own, gravity)[0]
    return inertia, weights


PlaneOf = Callable[[str, str | None], Any]
"""The plane of a link's point, m, or of the link: a number, or a term."""
HeldAcross = Iterable[tuple[str, Any]]
"""Links with what holds a force in its plane: minus the plane times the force, N m, complex."""


def held_across(acting: Iterable[Acting], plane: PlaneOf) -> HeldAcross:
    """What holds forces at points of links, each in the plane of its point."""
    for link, point, force, _ in acting:
        yield link, -(plane(link, point) * force)


def held_between(load: Load, acting: Iterable[Acting], plane: PlaneOf) -> HeldAcross:
    """What holds a load at both of its ends, in the plane of the loaded point."""
    return held_across(acting, lambda link, point: plane(load.link, load.point))


def held_preload(driven: str, acting: Iterable[Acting], plane: PlaneOf) -> HeldAcross:
    """What holds a coupling's preload at both of its ends, in the plane of the driven link."""
    return held_across(acting, lambda link, point: plane(driven, None))


def _summed(*held: HeldAcross) -> dict[str, Any]:
    values = dict[str, Any]()
    for link, value in chain(*held):
        values[link] = values.get(link, 0.0) + value
    return values


def plane_in(machine: Any, link: str, point: str | None) -> float:
    """Plane of a link's point, m, or of the link."""
    plane: float = machine.links[link].plane_of(point)
    return plane


def pushes_across(motion: Motion, acting: Iterable[Acting]) -> dict[str, Any]:
    """What holds forces at points of links."""
    return _summed(held_across(acting, partial(plane_in, motion.machine)))


def loads_across(motion: Motion) -> dict[str, Any]:
    """What holds loads and the soil: both ends of a load between links in its own plane."""
    plane = partial(plane_in, motion.machine)
    held = [held_across(soil_loads(motion), plane)]
    for where, load in numbered("loads", loads_of(motion.linkage)):
        ends = load_on_links(load, *acting_load(motion, where, load))
        held.append(held_between(load, ends, plane))
    return _summed(*held)


def springs_across(motion: Motion) -> dict[str, Any]:
    """What holds force elements, and preloads of couplings, in the plane of their driven link."""
    plane = partial(plane_in, motion.machine)
    preloads = (held_preload(driven, ends, plane) for driven, ends in acting_preloads(motion))
    return _summed(held_across(acting_elements(motion), plane), *preloads)


def apart(
    whole: OutOfPlaneMoments, exerted: Mapping[str, JointForce], shape: tuple[int, ...]
) -> OutOfPlaneMoments:
    """What links do across the plane, by cause and link: arrays of a shape (C, L, N)."""

    def by(cause: int, needed: Needed) -> Needed:
        result = {}
        for k, link in enumerate(whole.motion.machine.links):
            result[link] = np.zeros(shape, complex)
            result[link][cause, k] = needed.get(link, 0.0)
        return result

    parts = (whole.inertia, whole.weights, whole.loads, whole.springs, whole.outer)
    inertia, weights, loads, springs, outer = map(by, (0, 2, 3, 4, 3), parts)
    return OutOfPlaneMoments(whole.motion, inertia, weights, loads, springs, exerted, outer)
