"""Building a group for Newton's method: its loop equations, its start, and its joint forces."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from math import ceil, degrees, pi

import numpy as np

from equipoise.errors import ModelError
from equipoise.i18n import Note
from equipoise.mechanism.assembly.builder import Builder, Group
from equipoise.mechanism.assembly.contacts import contact_of
from equipoise.mechanism.assembly.joints import Structure, place_in_file
from equipoise.mechanism.assembly.loop_forces import LoopForces
from equipoise.mechanism.assembly.loops import (
    CouplingLoop,
    End,
    Free,
    Hinge,
    Loop,
    PinLoop,
    Place,
    Poses,
    Rail,
    SlideLoop,
)
from equipoise.mechanism.assembly.newton import LoopGroup, poses_in
from equipoise.mechanism.assembly.steps import Reaction, Step, initial_state, pin_reaction, run
from equipoise.mechanism.formulas import kernels
from equipoise.mechanism.parts.couplings import Coupling
from equipoise.mechanism.parts.machine import FRAME, Position, Slider

STEPS_PER_TURN = 360
"""Crank angles in a turn at which a branch is followed from one to the next."""
FAR = 0.25
"""Distance, in sizes of the machine, between a place in the file and the solution found from it."""


def loop_group(
    builder: Builder, joints: Structure, links: tuple[str, ...], near: Position | None = None
) -> Group:
    """Make the group of these links, with `builder` knowing them afterwards.

    near : about where they are at crank angle 0, if not the file but others tell it.
    """
    maker = Maker(builder, joints, links)
    before, loops = maker.prepare()
    touched = {FRAME, *(end.body for loop in loops for end in (loop.on, loop.by))}
    touched |= {loop.carrier for loop in loops if isinstance(loop, CouplingLoop)}
    unsolved = LoopGroup(
        links,
        tuple(maker.anchors[link] for link in links),
        tuple((body, builder.anchors[body]) for body in builder.rank if body in touched),
        maker.tree(loops),
        tuple(loop for k, loop in enumerate(loops) if k not in maker.holds.values()),
        (),
        builder.size(),
    )
    told = builder.told.get(f"reference({unsolved.reference})")
    if told is not None:
        solved = replace(unsolved, start=told[:, 0])
    else:
        run(before, builder.now)
        solved, loops = _solve_start(builder, before, unsolved, loops, near)
    builder.add(maker.anchors, {maker.anchors[link] for link in links})
    builder.running.update(place.link for place in solved.tree if any(place.turning))
    reactions = tuple(maker.reaction(loop) for loop in loops)
    hand_over = tuple(builder.hand_over(one) for one in reactions if one.by not in links)
    reach = tuple(
        step
        for reaction in reactions
        if reaction.kind in ("pin", "slider")
        for step in builder.reach(reaction.on, reaction.at)
    )
    for loop in loops:
        reach += tuple(loop.after(builder) if isinstance(loop, CouplingLoop) else ())
    forces: tuple[Step, ...] = (LoopForces(solved, loops, reactions), *hand_over)
    return Group("loops", links, (*before, solved, *reach), forces, reactions)


@dataclass
class Maker:
    """Loop equations of some links, and what hangs on them.

    anchors : of each link.  holds : link -> number of the joint that tells where it is.
    """

    builder: Builder
    joints: Structure
    links: tuple[str, ...]

    def __post_init__(self) -> None:
        self.anchors = {}
        self.holds: dict[str, int] = {}
        for link in self.links:
            points = [*self.builder.machine.assembled_points(link)]
            self.anchors[link] = next((pt for pt in points if pt in self.joints.pins), points[0])

    def end(self, body: str, point: str) -> End:
        anchor = self.anchors.get(body) or self.builder.anchors[body]
        return End(body, point, self.builder.arm(body, anchor, point))

    def prepare(self) -> tuple[tuple[Step, ...], tuple[Loop, ...]]:
        """Steps that make the known bodies' angles available, and the loop equations."""
        self.hang(self.pinned_and_sliding())
        loops = self.pinned_and_sliding()  # from the anchors that this has found
        reachable = {*self.builder.rank, *self.links}
        before: list[Step] = []
        for one in self.joints.couplings:
            ends = {one.driver, one.driven, one.carrier}
            if ends <= reachable and ends & set(self.links):
                for body in self.roots(ends, loops):
                    before += self.builder.running_angle(body)
                loops.append(self.coupling(one))
        return tuple(before), tuple(loops)

    def pinned_and_sliding(self) -> list[Loop]:
        loops: list[Loop] = []
        for point, bodies in self.joints.pins.items():
            if free := [body for body in bodies if body in self.links]:
                known = [body for body in bodies if body in self.builder.rank]
                hub = self.builder.carrier_of(known) if known else free[0]
                held = [self.end(link, point) for link in free if link != hub]
                loops += [PinLoop(point, end, self.end(hub, point)) for end in held]
        for slider in self.joints.sliders:
            ends = {slider.link, slider.on}
            if ends <= {*self.builder.rank, *self.links} and ends & set(self.links):
                loops.append(self.slide(slider))
        return loops

    def hang(self, loops: list[Loop]) -> None:
        """Find for each link the joint that tells where it is, by the shortest way from a body
        that is known, and take the point in that joint for the link's anchor.
        """
        placed = set(self.builder.rank)
        while True:
            found: dict[str, int] = {}
            for k, loop in enumerate(loops):
                for end, other in ((loop.on, loop.by), (loop.by, loop.on)):
                    if end.body not in placed | found.keys() and other.body in placed:
                        found[end.body] = k
                        self.anchors[end.body] = end.point
            if not found:
                break
            self.holds |= found
            placed |= found.keys()

    def tree(self, loops: Sequence[Loop]) -> tuple[Place, ...]:
        """Where each link is; one that nothing but gears holds may be anywhere."""
        held = [self.place(link, loops[k]) for link, k in self.holds.items()]
        return (*held, *(Free(link) for link in self.links if link not in self.holds))

    def place(self, link: str, loop: Loop) -> Place:
        here = link == loop.on.body
        to = loop.by if here else loop.on
        if not isinstance(loop, SlideLoop):
            return Hinge(link, to)
        along, turn = loop.along, loop.turn
        if not here:
            along, turn = turn.conjugate(), along.conjugate()
        return Rail(link, to, along, turn, np.angle(along * turn))

    def roots(self, bodies: Iterable[str], loops: Sequence[Loop]) -> Iterator[str]:
        """Known bodies whose angles those of these bodies are counted from."""
        for body in bodies:
            if body in self.builder.rank:
                yield body
            elif isinstance(loop := loops[self.holds[body]], SlideLoop):
                yield from self.roots({loop.on.body, loop.by.body} - {body}, loops)

    def slide(self, slider: Slider) -> SlideLoop:
        """The link `on` is always one of the group; the line is the same seen from either."""
        link, guide = self.end(slider.link, slider.point), self.end(slider.on, slider.through)
        along, turn = np.exp(1j * slider.direction), np.exp(1j * slider.angle)
        if slider.link in self.links:
            return SlideLoop(slider.name, link, guide, along, turn)
        return SlideLoop(slider.name, guide, link, turn.conjugate(), along.conjugate())

    def coupling(self, coupling: Coupling) -> CouplingLoop:
        contact = contact_of(self.builder, self.joints, coupling)
        if coupling.driven not in self.links:
            raise ModelError(place_in_file(self.joints, coupling), coupling.backwards())
        return contact.loop(self.end)

    def reaction(self, loop: Loop) -> Reaction:
        on, by = loop.on.body, loop.by.body
        force = f"R({loop.name}/{on})"
        if isinstance(loop, PinLoop):
            return pin_reaction(loop.name, on, by)
        if isinstance(loop, SlideLoop):
            couple = f"C({loop.name}/{on})"
            return Reaction(loop.name, "slider", on, by, loop.on.point, force, couple)
        push = f"C({loop.name}/{on})" if loop.contact.couples else None
        return Reaction(loop.name, loop.kind, on, by, loop.at, force, push)


def _solve_start(
    builder: Builder,
    before: tuple[Step, ...],
    group: LoopGroup,
    loops: tuple[Loop, ...],
    near: Position | None,
) -> tuple[LoopGroup, tuple[Loop, ...]]:
    """The group with its solution at crank angle 0 and, from that, the offsets of its gears."""
    position = near or builder.machine.position
    if position is None:
        raise ModelError(
            "position",
            Note(
                "missing; no dyad solves {names}, so the file must say roughly where they "
                "are: crank_angle, and points or angles of these links",
                names=", ".join(group.links),
            ),
        )
    meshes = {loop.name: loop for loop in loops if isinstance(loop, CouplingLoop) and loop.starts}
    if meshes and position.crank_angle != 0:
        raise ModelError(
            "position.crank_angle",
            Note(
                "got {crank_angle:g} deg; give the position at 0 deg, where the start "
                "angle of the gears holds",
                crank_angle=degrees(position.crank_angle),
            ),
        )
    standing = _standing(loops, {one.name: one.start for one in builder.machine.couplings})
    rough = replace(group, tree=tuple(map(Free, group.links)), equations=standing)
    steps = max(2, ceil(abs(position.crank_angle) / (2 * pi) * STEPS_PER_TURN))
    path = np.linspace(0.0, position.crank_angle, steps)
    state = initial_state(builder.machine, path)
    with np.errstate(all="ignore"):
        run([*builder.motion, *before], state)
        backwards = slice(None, None, -1)
        known = {
            body: pose.pick((..., backwards)) for body, pose in poses_in(state, group.known).items()
        }
        there = {body: pose.pick((..., 0)) for body, pose in known.items()}
        guess = [x for link in group.links for x in _guess(builder, group, link, there, position)]
        q = rough.solve(np.array(guess), there, path[-1])
        poses = rough.poses(there, q)
        _check_near(builder, poses, position, group)
        start = np.array([one for place in group.tree for one in place.values(poses)])
        if position.crank_angle != 0:
            start = group.follow(start, known, path[backwards])[0][:, -1]
        if not meshes:
            start[group.turning] = np.angle(np.exp(1j * start[group.turning]))
    meshed = {
        name: replace(loop, offset=float(loop.gaps(poses, 0)[0])) for name, loop in meshes.items()
    }
    loops, equations = (
        tuple(meshed.get(loop.name, loop) for loop in some) for some in (loops, group.equations)
    )
    return replace(group, start=start, equations=equations), loops


def _standing(loops: Sequence[Loop], starts: Mapping[str, float]) -> tuple[Loop, ...]:
    """The same with gears that stand still at the angles at which they start."""
    return tuple(
        replace(loop, carrier=FRAME, kernel=kernels.gear, numbers=(0.0,), offset=starts[loop.name])
        if isinstance(loop, CouplingLoop) and loop.starts
        else loop
        for loop in loops
    )


def _check_near(builder: Builder, poses: Poses, position: Position, group: LoopGroup) -> None:
    """A solution far from the position in the file may be another assembly of the links."""
    for link, anchor in zip(group.links, group.anchors, strict=True):
        for name in builder.machine.assembled_points(link).keys() & position.points.keys():
            found = complex(poses[link].place_of(builder.arm(link, anchor, name)))
            if abs(found - complex(*position.points[name])) > FAR * group.size:
                raise ModelError(
                    f"position.points.{name}",
                    Note(
                        "too rough: the links meet with {name} at ({real:.4g}, {imag:.4g}) mm; "
                        "give a place nearer to where it is",
                        name=name,
                        real=found.real * 1000.0,
                        imag=found.imag * 1000.0,
                    ),
                )


def _guess(
    builder: Builder, group: LoopGroup, link: str, known: Poses, position: Position
) -> tuple[float, float, float]:
    """Rough position of a link's anchor and its angle, from the file and from known pins."""
    points = builder.machine.assembled_points(link)
    given = [
        (complex(*points[name]), complex(*position.points[name]))
        for name in points
        if name in position.points
    ]
    for body, pose in known.items():
        for name in builder.machine.assembled_points(body):
            if name in points and name not in position.points:
                arm = builder.arm(body, builder.anchors[body], name)
                given.append((complex(*points[name]), complex(pose.place_of(arm))))
    anchor = complex(*points[group.anchors[group.links.index(link)]])
    angle = position.angles.get(link)
    if angle is None and len(given) >= 2:
        pairs = [(a - b, c - d) for a, c in given for b, d in given if a != b]
        local, world = max(pairs, key=lambda pair: abs(pair[0]))
        angle = float(np.angle(world / local)) if world else None
    if angle is None or not given:
        raise ModelError(
            "position",
            Note(
                "does not place {link!r} at crank angle {crank_angle:g} deg; give two of "
                "its points ({names}), or one and its angle",
                link=link,
                crank_angle=degrees(position.crank_angle),
                names=", ".join(points),
            ),
        )
    turn = np.exp(1j * angle)
    place = given[0][1] + turn * (anchor - given[0][0])
    return float(place.real), float(place.imag), float(angle)
