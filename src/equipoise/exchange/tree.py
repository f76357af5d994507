"""A machine as a tree: every link hangs on another body by one joint, and pins close the loops.

Programs for multibody systems want it so.  The drive hangs on the frame by its pivot; sliders are
all in the tree, since most programs close loops at pins only.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from functools import cached_property
from typing import Any, Literal, TypeVar

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.errors import MassError, UsageError
from equipoise.exchange.formats import Job
from equipoise.i18n import Note
from equipoise.mechanism.assembly.joints import Structure, joined
from equipoise.mechanism.assembly.linkage import assemble
from equipoise.mechanism.dynamics.forces import massless
from equipoise.mechanism.dynamics.loads import own_axis
from equipoise.mechanism.kinematics.motion import Motion, PlacedBodies, move
from equipoise.mechanism.parts.bodies import inertia_of
from equipoise.mechanism.parts.bushings import Bushing
from equipoise.mechanism.parts.couplings import Coupling, Turning
from equipoise.mechanism.parts.element_kinds import Element
from equipoise.mechanism.parts.machine import FRAME, Link, Load, Machine, Slider, Vector
from equipoise.mechanism.parts.support import Mount, Row, SpaceVector, Support
from equipoise.signals import Array
from equipoise.vibration.free import modes
from equipoise.vibration.linkages import rows_of

TreeJointKind = Literal["hinge", "slide"]
PartT = TypeVar("PartT", bound=Element)


@dataclass(frozen=True)
class TreeJoint:
    """A joint between two bodies: a pin, or a slider."""

    first: str
    second: str
    pin: str = ""
    slider: Slider | None = None


@dataclass(frozen=True)
class Hung:
    """A link on the body that carries it.

    at : of the joint in the link's axes, m.
    along : direction of a slide in the link's axes, rad.
    place, angle : of the link's axes in the frame, m (complex) and rad, where it is drawn.
    rate : of the joint's coordinate, rad/s or m/s.
    """

    name: str
    parent: str
    kind: TreeJointKind
    at: Vector
    along: float
    place: complex
    angle: float
    rate: float


@dataclass(frozen=True)
class LoopClosure:
    """A pin that closes a loop, between two bodies."""

    pin: str
    first: str
    second: str


@dataclass(frozen=True)
class Tree:
    """One linkage of a machine, drawn at a crank angle.

    motion : at that crank angle alone, without acceleration of the crank.
    links : parents before children.
    suffix : behind every name, so that those of rows differ.
    flywheel : moment of inertia that turns with its drive's link, kg m2: the first row has that.
    """

    machine: Machine
    motion: Motion
    links: tuple[Hung, ...]
    loops: tuple[LoopClosure, ...]
    row: Row
    suffix: str
    flywheel: float

    @cached_property
    def hung(self) -> Mapping[str, Hung]:
        return {link.name: link for link in self.links}

    def slide_of(self, slider: Slider) -> Hung:
        """The link whose joint is a slider, be it the one that slides or its guide."""
        ends = {slider.link, slider.on}
        slides = (link for link in self.links if link.kind == "slide")
        return next(link for link in slides if {link.name, link.parent} == ends)

    def pose(self, body: str) -> tuple[complex, float]:
        """Origin (complex, m) and angle of a body's axes in the axes of the frame."""
        return (0j, 0.0) if body == FRAME else (self.hung[body].place, self.hung[body].angle)

    def relative_pose(self, link: Hung) -> tuple[complex, float]:
        """Origin and angle of a link's axes in those of its parent; in the frame's of the file."""
        (place, angle), shift = self.pose(link.parent), 0j
        if link.parent == FRAME:
            shift = complex(*self.row.offset)
        return (link.place - place) * np.exp(-1j * angle) + shift, link.angle - angle

    def across(self, link: Hung) -> float:
        """z of a link's axes from those of its parent, m; in the frame of the file."""
        links = self.machine.links
        below = -self.row.lateral if link.parent == FRAME else links[link.parent].plane
        return links[link.name].plane - below

    def turning(self, body: str) -> Iterator[str]:
        """Links whose hinges add up to the angle of a body: from it down to the frame."""
        while body != FRAME:
            link = self.hung[body]
            if link.kind == "hinge":
                yield body
            body = link.parent

    def angle_between(self, body: str, on: str) -> dict[str, float]:
        """Link -> factor of its hinge in the angle of a body against another."""
        factors = dict[str, float]()
        for item, share in ((body, 1.0), (on, -1.0)):
            for link in self.turning(item):
                factors[link] = factors.get(link, 0.0) + share
        return {link: factor for link, factor in factors.items() if factor}

    @property
    def proportions(self) -> Iterator[tuple[str, dict[str, float]]]:
        """Of each coupling of links that turn its name, and link -> factor of its hinge in a sum
        that is 0.
        """
        for coupling in self.machine.couplings:
            if not isinstance(coupling, Turning):
                continue
            factors = dict[str, float]()
            for body, share in turning_shares(coupling):
                for link in self.turning(body):
                    factors[link] = factors.get(link, 0.0) + share
            yield coupling.name, {link: share for link, share in factors.items() if share}

    def on_ground(self, parts: Sequence[PartT], job: Job) -> Iterator[tuple[int, PartT]]:
        """Parts of a kind between a link and what stands still, by number; a note names others."""
        for number, part in enumerate(parts, 1):
            if part.bodies[1] == FRAME and self.machine.support is None:
                yield number, part
            else:
                job.leave_out(Note("{parts} on a body that moves", parts=Note(part.group)))

    def rest_angle(self, number: int, bushing: Bushing) -> float:
        """Angle of a bushing's link, counted from where it is drawn, at which its springs exert no
        torque, rad; 0 of one without torsional stiffness.
        """
        if not bushing.torsional_stiffness:
            return 0.0
        deflection = torsional_deflection(self.motion, number, bushing)
        return float(bushing.torque / bushing.torsional_stiffness - deflection)


def trees(job: Job) -> tuple[Tree, ...]:
    """Every linkage of a job's machine, drawn at its crank angle, with the first of the guides
    between two bodies.

    Raises
    ------
    MotionError : it cannot be drawn there.
    UsageError : sliders alone make a loop.
    """
    machine, joints = job.machine, _joints(job.machine)
    for slider in joints.sliders:
        if slider not in joints.needed.sliders:
            job.leave_out(
                Note(
                    "the guide {guide}: another guide constrains {link!r} in the same way",
                    guide=slider.name,
                    link=slider.link,
                )
            )
    rows = rows_of(machine)
    return tuple(
        _tree(
            machine,
            move(machine, [job.crank_angle + row.phase], acceleration=0.0),
            row,
            f" {number}" if len(rows) > 1 else "",
            machine.drive.flywheel if number == 1 else 0.0,
        )
        for number, row in enumerate(rows, 1)
    )


def weighed(machine: Machine) -> Machine:
    """The machine, all of whose links have a mass.

    Raises
    ------
    MassError : one has none.
    """
    if missing := massless(machine):
        raise MassError(missing)
    return machine


def mass_of(link: Link) -> tuple[float, Vector, float]:
    """Mass, centre of mass and inertia about it."""
    assert link.mass is not None and link.center_of_mass is not None and link.inertia is not None
    return link.mass, link.center_of_mass, link.inertia


def tensor_of(link: Link) -> tuple[float, list[float], Array]:
    """Mass, centre of mass (3,) from the link's axes, and inertia about it (3, 3): alike about all
    axes where the mass lies in one plane, as nothing is known of it.
    """
    mass, center, inertia = mass_of(link)
    if not any(body.plane is not None for body in link.bodies):
        return mass, [*center, 0.0], inertia * np.eye(3)
    parts = []
    for body in link.bodies:
        own, place, second = inertia_of(body, link.points)
        z = 0.0 if body.plane is None else body.plane - link.plane
        parts.append((own, np.array([place.real, place.imag, z]), second))
    middle = sum(own * place for own, place, _ in parts) / mass
    tensor = np.zeros((3, 3))
    for own, place, second in parts:
        arm = place - middle
        tensor += second * np.eye(3) + own * ((arm @ arm) * np.eye(3) - np.outer(arm, arm))
    return mass, middle.tolist(), tensor


def moment_of(support: Support) -> float:
    """Moment of inertia of a support about its centre of mass, in the plane, kg m2."""
    if support.pivot_inertia is None:
        return support.inertia[-1]
    assert support.pivot is not None
    arm = complex(*support.center_of_mass[:2]) - complex(*support.pivot)
    return support.pivot_inertia - support.mass * abs(arm) ** 2


def preloads(machine: Machine) -> Mapping[str, float]:
    """What each mount carries in the drawn position, N or N m: as the exact equations have it."""
    return modes(machine, "moment").preloads


def place_of(mount: Mount, support: Support) -> SpaceVector:
    """Point at which a mount pushes or turns a support, m: its own, or the reference."""
    return support.reference if mount.point is None else mount.point


def turning_shares(coupling: Coupling) -> tuple[tuple[str, float], ...]:
    """Bodies of a coupling in a fixed ratio, each with its share in a sum of angles that stays."""
    ratio = coupling.speed_ratio
    return (coupling.driven, 1.0), (coupling.driver, -ratio), (coupling.carrier, ratio - 1.0)


def torsional_deflection(motion: Motion, number: int, bushing: Bushing) -> float:
    """How far the link of a bushing has turned from its `angle` where a motion begins, rad.

    number : its place in the file, from 1.
    """
    *_, (turned, _) = bushing.ways(PlacedBodies(motion, f"bushings[{number}]"))
    return float(np.ravel(turned)[0])


def constant_loads(job: Job, *, between: bool = False) -> Iterator[tuple[int, Load]]:
    """Constant loads by number; notes name the others, and soil, which are left out.

    between : whether the format can hold those whose opposite another link bears at the same point;
    all hold those in the line between two points.
    """
    job.leave_out_soil()
    for number, load in enumerate(job.machine.loads, 1):
        if not load.constant:
            job.leave_out(Note("load {number}, which is not constant", number=number))
            continue
        in_line = load.toward is not None
        if load.reaction_link is not None and not (between or in_line):
            note = Note("load {number}, whose opposite {link!r} bears", number=number,
                        link=load.reaction_link)  # fmt: skip
            job.leave_out(note)
            continue
        on_support = load.reaction == FRAME and job.machine.support is not None
        if on_support and (between or not in_line):
            job.leave_out(Note("the reaction of load {number} on the frame", number=number))
        yield number, load


def pull_of(load: Load) -> tuple[tuple[str, str], tuple[str, str], float] | None:
    """Where a load in the line between two points acts, the point that it is pulled to, and its
    force, N; None of other loads.
    """
    if load.toward is None or load.point is None or load.force is None:
        return None
    return (load.link, load.point), (load.reaction or FRAME, load.toward), load.force[0]


def push_of(load: Load, machine: Machine) -> tuple[str, complex, float]:
    """Point of its link where a constant load acts, its force, N, and torque, N m.

    The force is in the axes of the link where the load has any, else in those of the frame.
    """
    point = load.point or next(iter(machine.links[load.link].points))
    force = complex(*(load.force or (0.0, 0.0))) * own_axis(load, machine)
    return point, force, load.torque or 0.0


def _tree(machine: Machine, motion: Motion, row: Row, suffix: str, flywheel: float) -> Tree:
    tree_joints, loose = _spanned(machine)
    links = tuple(_hung(machine, motion, *outward) for outward in _outwards(tree_joints))
    return Tree(machine, motion, links, loose, row, suffix, flywheel)


def _joints(machine: Machine) -> Structure:
    """Pins and guides, without what is inside of joints in slots, which no file holds."""
    return joined(machine.bodies, machine.sliders, machine.couplings, {})


def _edges(machine: Machine) -> Iterator[TreeJoint]:
    """Joints, those first that are to be in the tree."""
    pivot, joints = assemble(machine).pivot, _joints(machine)
    yield TreeJoint(FRAME, machine.drive.link, pin=pivot)
    yield from (
        TreeJoint(slider.on, slider.link, slider=slider) for slider in joints.needed.sliders
    )
    for pin, (first, *others) in joints.pins.items():
        for other in others:
            if (pin, other) != (pivot, machine.drive.link):
                yield TreeJoint(first, other, pin=pin)


def _spanned(machine: Machine) -> tuple[list[TreeJoint], tuple[LoopClosure, ...]]:
    """Joints that hold every link once, and the pins that are left over."""
    group = {body: body for body in machine.bodies}
    spanning, loose = [], []
    for edge in _edges(machine):
        item, other = group[edge.first], group[edge.second]
        if item != other:
            spanning.append(edge)
            group = {body: item if root == other else root for body, root in group.items()}
        elif edge.slider is None:
            loose.append(LoopClosure(edge.pin, edge.first, edge.second))
        else:
            raise UsageError(
                Note(
                    "the slider {name} closes a loop of sliders alone, which only pins can "
                    "do in files of this kind; give another format",
                    name=edge.slider.name,
                )
            )
    return spanning, tuple(loose)


def _outwards(joints: list[TreeJoint]) -> Iterator[tuple[str, str, TreeJoint]]:
    """Link, parent and joint, from the frame outwards."""
    left, known = list(joints), [FRAME]
    for parent in known:
        for edge in [item for item in left if parent in (item.first, item.second)]:
            left.remove(edge)
            link = edge.second if edge.first == parent else edge.first
            known.append(link)
            yield link, parent, edge


def _hung(machine: Machine, motion: Motion, link: str, parent: str, edge: TreeJoint) -> Hung:
    bodies, at, along = machine.bodies, edge.pin, 0.0
    rate = _spin(motion, link) - _spin(motion, parent)
    if edge.slider is not None:
        slider = edge.slider
        rate = float(motion.sliders[slider.name].velocity[0])
        at, along = slider.point, -slider.angle
        if link == slider.on:
            at, along, rate = slider.through, slider.direction, -rate
    angle = float(motion.links[link].angle[0])
    point, own = next(iter(bodies[link].items()))
    place = complex(motion.points[point].place[0]) - complex(*own) * np.exp(1j * angle)
    return Hung(
        link,
        parent,
        "hinge" if edge.slider is None else "slide",
        bodies[link][at],
        along,
        complex(place),
        angle,
        rate,
    )


def _spin(motion: Motion, body: str) -> float:
    result: Any = 0.0 if body == FRAME else motion.links[body].angular_velocity[0]
    return float(result)
