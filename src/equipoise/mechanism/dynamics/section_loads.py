"""Loads along a link, its stress and loads at nodes, and how far it bends as a beam.

The link is cut across the line between two of its points.  Joints, springs, loads and drives act at
their places; a place beside the line, or beyond its ends, is joined to it by a rigid arm.  Mass
lies along the line as a uniform rod with a lump at each end: the three masses that have the link's
mass, centre of mass and moment of inertia, beside the line by as much as its centre of mass.  What
acts on the part before a cut, with weight and inertia, is held by what the part behind it exerts.

Whatever acts between two nodes, and weight and inertia of the mass spread along the line, goes to
both by linear shape functions: with the same sum, and the same moment about any point.  So the
bending moment at a node is that of the link cut there, and the forces in an element are the mean of
those along it.

The loads along a link, inertia among them, bend it as they would at rest: E I w'' = M with w = 0 at
both ends of the line, and stretch it by N / E A.  That holds while the link's first natural
frequency, of a beam that both ends hold as pins do, lies well above what excites it.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import cached_property
from itertools import chain, pairwise
from math import pi
from typing import Any, NamedTuple

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.mechanism.assembly.steps import p, planar
from equipoise.mechanism.dynamics.loads import (
    acting_elements,
    acting_loads,
    acting_preloads,
)
from equipoise.mechanism.dynamics.reactions import PUSH, TORQUE, Acting, JointReactions, full
from equipoise.mechanism.formulas.kernels import cross
from equipoise.mechanism.kinematics.cylinders import pushes
from equipoise.mechanism.kinematics.friction_joints import rubbing_joints
from equipoise.mechanism.kinematics.motion import Motion
from equipoise.mechanism.parts.links import Link
from equipoise.mechanism.parts.sections import LinkSection
from equipoise.signals import Array

CUTS = 41
"""Places along a link at which it is cut, beside those where something acts."""
SAME_PLACE = 9
"""Digits of a place, over the length of the line, beyond which two are the same."""
NO_FORCE = np.zeros((), complex)
FIBRES = ("left", "right")
"""Outermost fibres, as one looks from the first point to the second."""


@dataclass(frozen=True)
class MassAlongLine:
    """Mass of a link along its line: a uniform rod and a lump at each end, kg.

    aside : by which all of it lies to the left of the line, m.
    """

    rod: float
    first: float
    last: float
    aside: float

    @classmethod
    def of(cls, mass: float, center: complex, inertia: float, length: float) -> MassAlongLine:
        """With a mass, its centre from the first point along and beside the line, and its moment
        of inertia about that centre.
        """
        moment = mass * center.real
        rod = 6 * (moment * length - inertia - mass * center.real**2) / length**2
        last = (moment - rod * length / 2) / length
        return cls(rod, mass - rod - last, last, center.imag)

    @classmethod
    def of_link(cls, link: Link) -> MassAlongLine:
        """Along the line of a link with a section and a centre of mass."""
        assert link.section is not None and link.center_of_mass is not None
        first, second = (planar(link.points[name]) for name in link.section.ends(link.points))
        length, along = abs(second - first), (second - first) / abs(second - first)
        center = (planar(link.center_of_mass) - first) / along
        return cls.of(link.mass or 0.0, center, link.inertia or 0.0, length)


@dataclass(frozen=True, eq=False)
class Cut:
    """A place at which a link is cut.

    at : (N,) from its first point, m.  behind : whether what acts there lies before it.
    """

    at: Array
    behind: bool

    @property
    def fixed(self) -> bool:
        """Whether it is the same at all crank angles."""
        return bool(np.ptp(self.at) == 0)


class Loads(NamedTuple):
    """What the part of a link behind a cut exerts on the part before it, over crank angles (N,).

    axial : force, N, positive in tension.  shear : force, N, positive to the left of the line.
    bending : moment, N m, counterclockwise.
    """

    axial: Array
    shear: Array
    bending: Array


class Envelope(NamedTuple):
    """What is largest in size of all cuts of a link.

    stress, bending_moment : (N,) Pa and N m.  axial_force : (N,) with its sign, N.
    stresses : (2, K) over fibres and cuts, of all crank angles, Pa.
    tension, compression, shear : of all cuts and crank angles, N.
    """

    stress: Array
    bending_moment: Array
    axial_force: Array
    stresses: Array
    tension: float
    compression: float
    shear: float


@dataclass(frozen=True, eq=False)
class SectionLoads:
    """Loads in cuts of a link: (K, N) over places and crank angles.

    What is largest of all cuts is had of one cut after the other, as all of them together hold some
    hundred numbers a crank angle.

    section : of the link.  length : of its line, m.  mass : along it.
    cuts : (K,), two where something acts: before and behind.  The last is behind all of the link,
        where nothing is left to be held.
    field : weight less inertia of a unit of mass, see `_field`.
    ends : place, force and torque (N,) of all that acts at one place.
    """

    section: LinkSection
    length: float
    mass: MassAlongLine
    cuts: Sequence[Cut]
    field: tuple[Array, Array]
    ends: Sequence[tuple[Array, Array, Array]]

    def in_cut(self, cut: Cut) -> Loads:
        """Loads (N,) in a cut."""
        return _loads(cut, self.ends, self.field, self.mass, self.length)

    def in_fibres(self, loads: Loads) -> Array:
        """Normal stress (2, N) in the left and the right outermost fibre, Pa."""
        of = self.section
        bent = loads.bending * of.outermost / of.second_moment
        axial = loads.axial / of.area
        return of.stress_concentration * np.array([axial - bent, axial + bent])

    @cached_property
    def envelope(self) -> Envelope:
        """What is largest of all cuts."""
        zero = np.zeros(len(self.cuts[0].at))
        stress, bent, axial = zero, zero, zero
        stresses, ends = [], []
        for cut in self.cuts:
            loads = self.in_cut(cut)
            sizes = np.abs(self.in_fibres(loads))
            stresses.append(np.max(sizes, axis=1))
            stress = np.maximum(stress, np.max(sizes, axis=0))
            bent = np.maximum(bent, np.abs(loads.bending))
            axial = np.where(np.abs(loads.axial) > np.abs(axial), loads.axial, axial)
            ends.append((np.max(loads.axial), -np.min(loads.axial), np.max(np.abs(loads.shear))))
        most = np.max(ends, axis=0).tolist()
        return Envelope(stress, bent, axial, np.transpose(stresses), *most)

    @property
    def stress(self) -> Array:
        """Largest size of the normal stress anywhere along the link (N,), Pa."""
        return self.envelope.stress

    @property
    def bending_moment(self) -> Array:
        """Largest size of the bending moment along the link (N,), N m."""
        return self.envelope.bending_moment

    @property
    def axial_force(self) -> Array:
        """The axial force (N,) that is largest in size along the link, N."""
        return self.envelope.axial_force

    @property
    def places(self) -> Array:
        """Places of all cuts from the first point of the link, m."""
        return np.array([cut.at for cut in self.cuts])

    @property
    def fixed(self) -> Array:
        """(K,) whether a place is the same at all crank angles."""
        return np.array([cut.fixed for cut in self.cuts])

    @property
    def axial(self) -> Array:
        """Axial force in all cuts, N, positive in tension."""
        return np.array([self.in_cut(cut).axial for cut in self.cuts])

    @property
    def shear(self) -> Array:
        """Shear force in all cuts, N, positive to the left of the line."""
        return np.array([self.in_cut(cut).shear for cut in self.cuts])

    @property
    def bending(self) -> Array:
        """Bending moment in all cuts, N m, counterclockwise."""
        return np.array([self.in_cut(cut).bending for cut in self.cuts])

    @property
    def stresses(self) -> Array:
        """Normal stress (2, K, N) in the left and the right outermost fibre, Pa."""
        values = [self.in_fibres(self.in_cut(cut)) for cut in self.cuts]
        return np.stack(values, axis=1)


def section_loads(motion: Motion, solved: JointReactions, link: str) -> SectionLoads:
    """Loads along a link with a section.

    solved : forces in all joints, by which the link moves as it does.
    """
    body = motion.machine.links[link]
    assert body.section is not None
    first, second = (planar(body.points[name]) for name in body.section.ends(body.points))
    length, along = abs(second - first), (second - first) / abs(second - first)
    turn = full(motion, motion.state[f"u({link})"], complex) * along
    begin = motion.state[f"p({motion.linkage.anchors[link]})"]
    begin = begin + turn / along * (first - planar(body.points[motion.linkage.anchors[link]]))
    mass = MassAlongLine.of_link(body)
    still, growing = _field(motion, link, turn, begin, mass.aside)
    at: list[Array] = []
    ends: list[tuple[Array, Array, Array]] = []
    for place, force, torque in _acting_on(motion, solved, link):
        spot = full(motion, (place - begin) / turn, complex)
        inside = np.round(np.clip(spot.real / length, 0.0, 1.0), SAME_PLACE) * length + 0.0  # no -0
        own = full(motion, force / turn, complex)
        at.append(inside)
        ends.append((inside, own, full(motion, torque, float) + cross(spot - inside, own)))
    for lump, end in ((mass.first, 0.0), (mass.last, length)):
        own = lump * (still + growing * end)
        ends.append((np.full(len(turn), end), own, cross(1j * mass.aside, own)))
    return SectionLoads(
        body.section, length, mass, _cuts(at, length, len(turn)), (still, growing), ends
    )


def _cuts(at: Sequence[Array], length: float, count: int) -> list[Cut]:
    """Places along a line, each once, where several forces act on one; the last behind all of it.

    at : (N,) where something acts, m.  count : of crank angles.
    """
    last = Cut(np.broadcast_to(length, count), True)
    cuts = [Cut(np.broadcast_to(s, count), False) for s in np.linspace(0.0, length, CUTS)]
    cuts += [Cut(s, behind) for s in at for behind in (False, True)]
    by_place: dict[tuple[bytes, bool], Cut] = {}
    for cut in cuts:
        by_place.setdefault((cut.at.tobytes(), cut.behind), cut)
    by_place.pop((last.at.tobytes(), True), None)
    return [*by_place.values(), last]


def _field(
    motion: Motion, link: str, turn: Array, begin: Array, aside: float
) -> tuple[Array, Array]:
    """Weight less inertia of a unit of mass, in the axes of the line: at its begin, and by how much
    it grows along a unit of it (N,), m/s2 and 1/s2.
    """
    state, anchor = motion.state, motion.linkage.anchors[link]
    _, rate, curving = (state[name] for name in p(anchor))
    speed, gain = motion.speed, motion.acceleration
    turning = full(motion, state[f"w({link})"] * speed, float)
    spinning = full(motion, motion.links[link].angular_acceleration, float)
    growing = turning**2 - 1j * spinning
    # of the anchor, and from there to the begin of the line
    moved = (rate * gain + curving * speed**2) / turn
    from_anchor = (begin - state[f"p({anchor})"]) / turn
    still = complex(*motion.machine.gravity) / turn - moved + growing * (from_anchor + 1j * aside)
    return full(motion, still, complex), full(motion, growing, complex)


def _loads(
    cut: Cut,
    ends: Sequence[tuple[Array, Array, Array]],
    field: tuple[Array, Array],
    mass: MassAlongLine,
    length: float,
) -> Loads:
    """Axial force, shear force and moment (N,) in a cut, before or behind what acts there."""
    (q, k), density = field, mass.rod / length
    s = cut.at
    force = density * (q * s + k * s**2 / 2)
    moment = -density * (q.imag * s**2 / 2 + k.imag * s**3 / 6) - mass.aside * force.real
    for place, own, torque in ends:
        counts = place <= s if cut.behind else (place < s)
        force = force + counts * own
        moment = moment + counts * (torque + (place - s) * own.imag)
    return Loads(-force.real, -force.imag, -moment)


def _acting_on(motion: Motion, solved: JointReactions, link: str) -> Iterator[tuple[Any, Any, Any]]:
    """Place, force and torque of all that acts on a link but for its weight."""
    state = solved.state
    for reaction in motion.linkage.reactions:
        for body, sign in ((reaction.on, 1.0), (reaction.by, -1.0)):
            if body == link:
                couple = 0.0 if reaction.couple is None else state[reaction.couple]
                yield state[f"p({reaction.at})"], sign * state[reaction.force], sign * couple
    actings: Iterator[Acting] = chain(
        acting_loads(motion),
        acting_elements(motion),
        *(ends for _, ends in acting_preloads(motion)),
        _driving(motion, solved),
        _rubbing(motion, solved),
    )
    anchor = state[f"p({motion.linkage.anchors[link]})"]
    for body, point, force, torque in actings:
        if body == link:
            named = isinstance(point, str)
            place = anchor if point is None else motion.point(point).place if named else point
            yield place, force, torque


def _driving(motion: Motion, solved: JointReactions) -> Iterator[Acting]:
    """What drives and the flywheel exert."""
    machine, state = motion.machine, solved.state
    for drive in machine.driven:
        if drive.pushes:
            for body, place, way in pushes(motion, drive):
                yield body, place, state[PUSH.format(drive.link)] * way, 0.0
        else:
            yield drive.link, None, NO_FORCE, state[TORQUE.format(drive.link)]
    first = machine.drive
    if first.flywheel:
        spinning = motion.links[first.link].angular_acceleration
        yield first.link, None, NO_FORCE, -first.flywheel * spinning


def _rubbing(motion: Motion, solved: JointReactions) -> Iterator[Acting]:
    """What friction in joints exerts on both bodies of each."""
    for joint in rubbing_joints(motion.linkage):
        if joint.name not in solved.friction:
            continue
        effort = solved.friction[joint.name].effort
        for body, sign in ((joint.on, 1.0), (joint.by, -1.0)):
            if not joint.slides:
                torque = sign * effort * joint.lever(motion)
                yield body, solved.state[f"p({joint.reaction.at})"], NO_FORCE, torque
            else:
                along = joint.direction(motion)
                yield body, joint.place(motion), sign * effort * along, 0.0


ELEMENTS = 40
"""Along a link, about, beside places of joints and loads, which are nodes too."""
STUBBY = 0.5
"""Least length of these elements over the height of the section: where programs make solids of
them, a force on a short one would dent it."""
SAME_NODE = 1e-6
"""Share of the length of a link within which two places are one node."""


class NodalLoads(NamedTuple):
    """Loads at nodes (P,) of a link at one crank angle, in the axes of its line.

    force : complex, N, along the line and to the left of it.  couple : N m, counterclockwise.
    """

    force: Array
    couple: Array


def nodes_along(loads: SectionLoads, angle: int | None = None) -> Array:
    """Places (P,) of nodes from the first point of a link, rising, m.

    angle : number of the crank angle; None for nodes where something acts at all crank angles.
    """
    length = loads.length
    marks = [0.0]
    places = [at[angle or 0] for at, _, _ in loads.ends if angle is not None or np.ptp(at) == 0]
    for place in sorted([*map(float, places), length]):
        if place - marks[-1] > SAME_NODE * length:
            marks.append(place)
    marks[-1] = length
    size = max(length / ELEMENTS, STUBBY * 2 * loads.section.outermost)
    parts = [np.linspace(a, b, max(round((b - a) / size), 1) + 1)[:-1] for a, b in pairwise(marks)]
    return np.concatenate([*parts, [length]])


def nodal_loads(loads: SectionLoads, nodes: Array, angle: int) -> NodalLoads:
    """Loads at nodes (P,) along a link, at the crank angle of a number."""
    force, couple = np.zeros(len(nodes), complex), np.zeros(len(nodes))
    for places, forces, torques in loads.ends:
        after = int(np.clip(np.searchsorted(nodes, places[angle]), 1, len(nodes) - 1))
        share = (places[angle] - nodes[after - 1]) / (nodes[after] - nodes[after - 1])
        for node, weight in ((after - 1, 1 - share), (after, share)):
            force[node] += weight * forces[angle]
            couple[node] += weight * torques[angle]
    q, k = (part[angle] for part in loads.field)
    spread = loads.mass.rod / loads.length * (q + k * nodes)
    cells = np.diff(nodes)
    first = cells * (2 * spread[:-1] + spread[1:]) / 6
    last = cells * (spread[:-1] + 2 * spread[1:]) / 6
    for own, where in ((first, slice(None, -1)), (last, slice(1, None))):
        force[where] += own
        couple[where] -= loads.mass.aside * own.real  # it acts beside the line
    return NodalLoads(force, couple)


PARTS = 160
"""Parts of a line over which moments are summed by the trapezoidal rule: to 1e-4."""
ORDER, ADDED = 2, 0.1
"""Rigid links mislead where bending adds this share to what has this order of the crank: inertia of
linkages is of the first and second order above all."""


@dataclass(frozen=True, eq=False)
class ElasticLink:
    """A link as a beam, over crank angles (N,).

    natural_frequency : first one of bending in the plane, Hz; None without mass along the line.
    places : (P,) along the line, m.  deflection : (P, N) to the left of the line between the ends,
    m.  slope : (P, N) of it, rad.  stretch : (P, N) by which the line is longer up to there, m.
    """

    natural_frequency: float | None
    places: Array
    deflection: Array
    slope: Array
    stretch: Array

    def moved(self, place: complex) -> Array:
        """Displacement (N,) of a place of the link against the line between the ends, in the axes
        of that, complex, m.

        place : from the first point along the line and to the left of it, m.
        """
        inside = float(np.clip(place.real, 0.0, self.places[-1]))
        bent, turned, longer = (
            np.array([np.interp(inside, self.places, item) for item in values.T])
            for values in (self.deflection, self.slope, self.stretch)
        )
        return np.asarray(longer + 1j * bent + 1j * turned * (place - inside))


def natural_frequency(modulus: float, second_moment: float, mass: float, length: float) -> float:
    """First natural frequency, Hz, of a uniform beam on two pins: pi / 2 (E I / m L^3)^(1/2)."""
    return float(pi / 2 * (modulus * second_moment / (mass * length**3)) ** 0.5)


def _frequency(section: LinkSection, rod: float, length: float) -> float | None:
    """First natural frequency, Hz, of a section along which a mass (kg) is spread; None without a
    modulus, or where no mass is left to bend.
    """
    if section.elastic_modulus is None or rod <= 0:
        return None
    return natural_frequency(section.elastic_modulus, section.second_moment, rod, length)


def bending_frequency(link: Link) -> float | None:
    """First natural frequency, Hz, of a link on pins at both ends of its line; None without a
    section, a modulus or a mass along it.
    """
    if link.section is None or link.center_of_mass is None:
        return None
    first, second = (planar(link.points[name]) for name in link.section.ends(link.points))
    return _frequency(link.section, MassAlongLine.of_link(link).rod, abs(second - first))


def elastic_link(loads: SectionLoads) -> ElasticLink | None:
    """A link as a beam under its loads; None without a modulus."""
    section, length = loads.section, loads.length
    modulus, count = section.elastic_modulus, len(loads.cuts[0].at)
    if modulus is None:
        return None
    places = np.linspace(0.0, length, PARTS + 1)
    cuts = [loads.in_cut(Cut(np.broadcast_to(place, count), False)) for place in places[1:]]
    first = loads.in_cut(Cut(np.zeros(count), True))
    every = [first, *cuts]
    bent = _summed(np.array([item.bending for item in every]), length)
    slope = bent / (modulus * section.second_moment)
    deflection = _summed(slope, length)
    chord = deflection[-1] / length
    stretch = _summed(np.array([item.axial for item in every]), length) / (modulus * section.area)
    frequency = _frequency(section, loads.mass.rod, length)
    return ElasticLink(
        frequency, places, deflection - chord * places[:, None], slope - chord, stretch
    )


def _summed(values: Array, length: float) -> Array:
    """Integral (P, N) from the first place on."""
    steps = (values[:-1] + values[1:]) * (length / PARTS / 2)
    return np.concatenate([np.zeros((1, values.shape[1])), np.cumsum(steps, axis=0)])


def other_places(link: Link) -> Iterator[tuple[str, complex]]:
    """Points of a link but the ends of its line, from the first of these along the line."""
    assert link.section is not None
    ends = link.section.ends(link.points)
    first, second = (planar(link.points[name]) for name in ends)
    along = (second - first) / abs(second - first)
    for name, at in link.points.items():
        if name not in ends:
            yield name, (planar(at) - first) / along


def added_share(frequency: float, speed: float) -> float:
    """Share by which bending enlarges what excites a link at the second order of a speed, rad/s;
    infinite from its natural frequency on.
    """
    ratio = (ORDER * abs(speed) / (2 * pi * frequency)) ** 2
    return ratio / (1 - ratio) if ratio < 1 else float("inf")
