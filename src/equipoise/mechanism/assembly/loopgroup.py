"""Building a group for Newton's method: its loop equations, its start, and its joint forces."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import islice
from math import ceil, degrees, pi
from typing import Any

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.errors import ModelError
from equipoise.i18n import Note, key_names
from equipoise.mechanism.assembly.builder import Builder, Group
from equipoise.mechanism.assembly.contacts import contact_of
from equipoise.mechanism.assembly.joints import Structure, place_in_file
from equipoise.mechanism.assembly.loops import (
    CouplingLoop,
    End,
    Free,
    LinkAttachment,
    LoopEquation,
    LoopGroup,
    PinLoop,
    Poses,
    Riding,
    SlideLoop,
    TrackLoop,
    poses_in,
)
from equipoise.mechanism.assembly.steps import Reaction, State, Step, initial_state, run
from equipoise.mechanism.formulas import kernels
from equipoise.mechanism.parts.couplings import Coupling
from equipoise.mechanism.parts.joint_kinds import Rider
from equipoise.mechanism.parts.machine import FRAME, Position, Slider
from equipoise.signals import Array

STEPS_PER_TURN = 360
"""Crank angles in a turn at which a branch is followed from one to the next."""
FAR = 0.25
"""Distance, in sizes of the machine, between a place in the file and the solution found from it."""


@dataclass(frozen=True)
class LoopForces:
    """Solves the free-body equations of a group: as many unknown joint forces as equations.

    reactions : of each loop.
    """

    group: LoopGroup
    loops: tuple[LoopEquation, ...]
    reactions: tuple[Reaction, ...]

    def run(self, state: State) -> None:
        group = self.group
        own = zip(group.links, group.anchors, strict=True)
        poses = poses_in(state, (*group.known, *own))
        senses = self.senses(state, poses)
        self.put(state, poses, senses, self.solve(state, poses, senses))

    def put(
        self, state: State, poses: Poses, senses: Sequence[Any], strengths: Sequence[Sequence[Any]]
    ) -> None:
        """Add what joints exert to the state, by the strengths of the unknowns of each loop; arrays
        or terms.
        """
        for loop, reaction, sense, parts in zip(
            self.loops, self.reactions, senses, strengths, strict=True
        ):
            wrench = exerted(loop.wrenches(poses, sense), parts)
            state.update(zip(reaction.outputs, wrench, strict=False))
            if isinstance(loop, CouplingLoop):
                state[f"p({reaction.at})"] = loop.place(poses)
                state[f"T({loop.name})"] = parts[0]

    def senses(self, state: State, poses: Poses) -> list[Any]:
        """Sign of each coupling's push, which does not depend on the slant of its line."""
        names = [
            f"flank({loop.name})" if isinstance(loop, CouplingLoop) else "" for loop in self.loops
        ]
        if any(name and name not in state for name in names):
            strengths = self.solve(state, poses, [0.0] * len(self.loops))
            for name, parts in zip(names, strengths, strict=True):
                if name:
                    (state[name],) = kernels.flank(parts[0])
        return [state[name] if name else 0.0 for name in names]

    def solve(self, state: State, poses: Poses, senses: Sequence[Any]) -> list[list[Array]]:
        """Strength (..., N) of every unknown of each loop."""
        matrix = self.matrix(state, poses, senses)
        demand = self.demand(state)
        rows = demand.reshape(-1, *demand.shape[-2:])  # (R, N, 3 n): each matrix is factored once
        solved = np.linalg.solve(matrix, np.moveaxis(rows, 0, -1))
        strengths = iter(solved.transpose(1, 2, 0).reshape(matrix.shape[-1], *demand.shape[:-1]))
        return [list(islice(strengths, loop.unknowns)) for loop in self.loops]

    def matrix(self, state: State, poses: Poses, senses: Sequence[Any]) -> Array:
        """What each unknown adds to force and moment on each link, (N, 3 n, m)."""
        columns = self.columns(poses, senses)
        rows = 3 * len(self.group.links)
        matrix = np.zeros((len(columns), rows, *np.shape(state["theta"])))
        for column, entries in zip(matrix, columns, strict=True):
            for row, entry in entries.items():
                column[row] = entry
        return matrix.T

    def columns(self, poses: Poses, senses: Sequence[Any]) -> list[dict[int, Any]]:
        """What each unknown adds to force and moment on each link, by row; arrays or terms."""
        return [
            column
            for loop, sense in zip(self.loops, senses, strict=True)
            for column in self.columns_of(loop, poses, sense)
        ]

    def columns_of(self, loop: LoopEquation, poses: Poses, sense: Any) -> list[dict[int, Any]]:
        """Force and moment about the anchor on the links that it joins, by row, for a unit of each
        of its unknowns.
        """
        at = loop.place(poses)
        result = []
        for force, couple in loop.wrenches(poses, sense):
            column: dict[int, Any] = {}
            for number, link in enumerate(self.group.links):
                sign = (link == loop.on.body) - (link == loop.by.body)
                if not sign:
                    continue
                moment = kernels.cross(at - poses[link].place[0], force) + couple
                parts = np.real(force), np.imag(force), moment
                column |= {3 * number + row: sign * part for row, part in enumerate(parts)}
            result.append(column)
        return result

    def demand(self, state: State) -> Array:
        """(..., N, 3 n): force and moment about the anchor that the joints of each link supply."""
        parts = []
        for link in self.group.links:
            force, moment = state[f"F({link})"], state[f"M({link})"]
            parts += [np.real(force), np.imag(force), moment]
        count = np.shape(state["theta"])
        full = [np.broadcast_to(part, np.broadcast_shapes(np.shape(part), count)) for part in parts]
        return np.stack(np.broadcast_arrays(*full), axis=-1)


def exerted(units: Iterable[tuple[Any, Any]], strengths: Sequence[Any]) -> tuple[Any, Any]:
    """Force, and couple, that a joint exerts by the strengths of its unit forces and couples."""
    force, couple = (
        sum(strength * part for strength, part in zip(strengths, parts, strict=True))
        for parts in zip(*units, strict=True)
    )
    return force, couple


def loop_group(
    builder: Builder, joints: Structure, links: tuple[str, ...], guess: Position | None = None
) -> Group:
    """Make the group of these links, with `builder` knowing them afterwards.

    guess : approximate positions at crank angle 0, if they are not those of the file.
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
        tuple(link for link in links if link not in joints.riders),
    )
    text = builder.given_state.get(f"reference({unsolved.reference})")
    if text is not None:
        solved = replace(unsolved, start=text[:, 0])
    else:
        run(before, builder.now)
        solved, loops = _solve_start(builder, before, unsolved, loops, guess)
    builder.add(maker.anchors, {maker.anchors[link] for link in links})
    builder.running.update(place.link for place in solved.tree if place.counted)
    reactions = tuple(loop.reaction() for loop in loops)
    hand_over = tuple(
        builder.hand_over(reaction) for reaction in reactions if reaction.by not in links
    )
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

    anchors : of each link.  holds : link -> number of the joint that positions it.
    free : links of which no joint does.
    """

    builder: Builder
    joints: Structure
    links: tuple[str, ...]

    def __post_init__(self) -> None:
        self.anchors = {}
        self.holds: dict[str, int] = {}
        self.free: list[str] = []
        for link in self.links:
            points = [*self.builder.machine.assembled_points(link)]
            self.anchors[link] = next((pt for pt in points if pt in self.joints.pins), points[0])

    def end(self, body: str, point: str) -> End:
        anchor = self.anchors.get(body) or self.builder.anchors[body]
        return End(body, point, self.builder.arm(body, anchor, point))

    def prepare(self) -> tuple[tuple[Step, ...], tuple[LoopEquation, ...]]:
        """Steps that make the known bodies' angles available, and the loop equations."""
        self.hang(self.pinned_and_sliding())
        loops = self.pinned_and_sliding()  # from the anchors that this has found
        reachable = {*self.builder.rank, *self.links}
        before: list[Step] = []
        for coupling in self.joints.couplings:
            ends = {coupling.driver, coupling.driven, coupling.carrier}
            if ends <= reachable and ends & set(self.links):
                for body in self.roots(ends, loops):
                    before += self.builder.running_angle(body)
                loops.append(self.coupling(coupling))
        return tuple(before), tuple(loops)

    def pinned_and_sliding(self) -> list[LoopEquation]:
        loops: list[LoopEquation] = []
        for point, bodies in self.joints.pins.items():
            if free := [body for body in bodies if body in self.links]:
                known = [body for body in bodies if body in self.builder.rank]
                hub = self.builder.carrier_of(known) if known else free[0]
                ends_on_hub = [self.end(link, point) for link in free if link != hub]
                loops += [PinLoop(point, end, self.end(hub, point)) for end in ends_on_hub]
        for slider in self.joints.sliders:
            ends = {slider.link, slider.on}
            if ends <= {*self.builder.rank, *self.links} and ends & set(self.links):
                loops.append(self.slide(slider))
        for name, rider in self.joints.tracked.items():
            if name in self.links and rider.on in (*self.builder.rank, *self.links):
                loops.append(self.track(name, rider))
        return loops

    def hang(self, loops: list[LoopEquation]) -> None:
        """Find for each link the joint that positions it, by the shortest path from a body
        that is known, and take the point in that joint for the link's anchor.  A rider is placed
        by its track alone, and places nothing: no other joint determines its parameter.
        """
        placed = set(self.builder.rank)
        while True:
            counts: dict[str, int] = {}
            for k, loop in enumerate(loops):
                for end, other in ((loop.on, loop.by), (loop.by, loop.on)):
                    new = end.body not in placed | counts.keys() and other.body in placed
                    if new and self.places(loop, end):
                        counts[end.body] = k
                        self.anchors[end.body] = end.point
            self.holds |= counts
            placed |= counts.keys()
            if not counts:
                loose = (
                    link for link in self.links if link not in placed | self.joints.tracked.keys()
                )
                if (free := next(loose, None)) is None:
                    break
                self.free.append(free)
                placed.add(free)

    def places(self, loop: LoopEquation, end: End) -> bool:
        """Whether a joint may position the body at one of its ends."""
        if isinstance(loop, TrackLoop):
            return end is loop.on
        return self.joints.tracked.keys().isdisjoint((loop.on.body, loop.by.body))

    def tree(self, loops: Sequence[LoopEquation]) -> tuple[LinkAttachment, ...]:
        """Where each link is; one that nothing but couplings, or riders, holds may be anywhere."""
        constrained = [loops[k].placement(link) for link, k in self.holds.items()]
        return (*map(Free, self.free), *constrained)

    def roots(self, bodies: Iterable[str], loops: Sequence[LoopEquation]) -> Iterator[str]:
        """Known bodies whose angles those of these bodies are counted from."""
        for body in bodies:
            if body in self.builder.rank:
                yield body
            elif body in self.holds and isinstance(loop := loops[self.holds[body]], SlideLoop):
                yield from self.roots({loop.on.body, loop.by.body} - {body}, loops)

    def slide(self, slider: Slider) -> SlideLoop:
        """The link `on` is always one of the group; the line is the same seen from either."""
        link, guide = self.end(slider.link, slider.point), self.end(slider.on, slider.through)
        along, turn = np.exp(1j * slider.direction), np.exp(1j * slider.angle)
        if slider.link in self.links:
            return SlideLoop(slider.name, link, guide, along, turn)
        return SlideLoop(slider.name, guide, link, turn.conjugate(), along.conjugate())

    def track(self, name: str, rider: Rider) -> TrackLoop:
        track = rider.track
        assert track is not None
        turn = np.exp(1j * track.direction)
        ends = self.end(name, name), self.end(rider.on, track.base)
        return TrackLoop(f"track of {name}", *ends, track.curve, turn)

    def coupling(self, coupling: Coupling) -> CouplingLoop:
        contact = contact_of(self.builder, self.joints, coupling)
        if coupling.driven not in self.links:
            raise ModelError(place_in_file(self.joints, coupling), coupling.backwards())
        return contact.loop(self.end)


def _solve_start(
    builder: Builder,
    before: tuple[Step, ...],
    group: LoopGroup,
    loops: tuple[LoopEquation, ...],
    start_guess: Position | None,
) -> tuple[LoopGroup, tuple[LoopEquation, ...]]:
    """The group with its solution at crank angle 0 and, from that, the offsets of its couplings."""
    position = start_guess or builder.machine.position
    if position is None:
        raise ModelError(
            "position",
            Note(
                "missing; no dyad solves {names}, so the file must say roughly where they "
                "are: {crank_angle}, and points or angles of these links",
                **key_names("crank_angle"),
                names=", ".join(group.visible_links),
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
    standing = _standing(
        loops, {coupling.name: coupling.start for coupling in builder.machine.couplings}
    )
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
        tree, guess = _rough(builder, group, loops, there, position)
        rough = replace(group, tree=tree, equations=standing)
        q = rough.solve(np.array(guess), there, path[-1])
        poses = rough.poses(there, q)
        _check_near(builder, poses, position, group)
        start = np.array([item for place in group.tree for item in place.values(poses)])
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


def _standing(
    loops: Sequence[LoopEquation], starts: Mapping[str, float]
) -> tuple[LoopEquation, ...]:
    """Joints for rough poses: couplings stand still as they start, and riders are
    on their tracks already.
    """
    return tuple(
        replace(
            loop, carrier=FRAME, kernel=kernels.in_ratio, numbers=(0.0,), offset=starts[loop.name]
        )
        if isinstance(loop, CouplingLoop) and loop.starts
        else loop
        for loop in loops
        if not isinstance(loop, TrackLoop)
    )


def _rough(
    builder: Builder,
    group: LoopGroup,
    loops: Sequence[LoopEquation],
    known: Poses,
    position: Position,
) -> tuple[tuple[LinkAttachment, ...], list[float]]:
    """Every link where it pleases but for riders on their tracks, and about where all of them are.

    What is inside of joints is where the links that the file places have it.
    """
    poses, anchors = dict(known), dict(zip(group.links, group.anchors, strict=True))
    riding = [place for place in group.tree if isinstance(place, Riding)]
    free = set(group.links).difference(place.link for place in riding)
    values: list[float] = []
    links = [
        *group.visible_links,
        *(link for link in group.links if link not in group.visible_links),
    ]
    links = [link for link in links if link in free]
    for link in links:
        visible = known if link in group.visible_links else poses
        x, y, angle = _guess(builder, anchors, link, visible, position)
        values += [x, y, angle]
        here = (x, y, (np.exp(1j * angle), angle))
        poses[link] = Free(link).pose(poses, here, [0.0] * 3, [0.0] * 3)
    for place in riding:
        ends = ((loop.on, loop.by) for loop in loops if isinstance(loop, PinLoop))
        pin = next(b if a.body == place.link else a for a, b in ends
                   if place.link in (a.body, b.body))  # fmt: skip
        values.append(place.nearest(poses, poses[pin.body].place_of(pin.arm)))
    return (*map(Free, links), *riding), values


def _check_near(builder: Builder, poses: Poses, position: Position, group: LoopGroup) -> None:
    """A solution far from the position in the file may be another assembly of the links."""
    for name, way in group.ways_from(position, builder.machine, poses, builder.arm):
        if abs(way) > FAR * group.size:
            result = complex(*position.points[name]) + complex(way)
            raise ModelError(
                f"position.points.{name}",
                Note(
                    "too rough: the links meet with {name} at ({real:.4g}, {imag:.4g}) mm; "
                    "give a place nearer to where it is",
                    name=name,
                    real=result.real * 1000.0,
                    imag=result.imag * 1000.0,
                ),
            )


def _guess(
    builder: Builder, anchors: Mapping[str, str], link: str, known: Poses, position: Position
) -> tuple[float, float, float]:
    """Rough position of a link's anchor and its angle, from the file and from known pins.

    anchors : of the links of the group.
    """
    anchors = {**builder.anchors, **anchors}
    points = builder.machine.assembled_points(link)
    given = [
        (complex(*points[name]), complex(*position.points[name]))
        for name in points
        if name in position.points
    ]
    for body, pose in known.items():
        for name in builder.machine.assembled_points(body):
            if name in points and name not in position.points:
                arm = builder.arm(body, anchors[body], name)
                given.append((complex(*points[name]), complex(pose.place_of(arm))))
    anchor = complex(*points[anchors[link]])
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
                names=", ".join(builder.machine.bodies.get(link, points)),
            ),
        )
    turn = np.exp(1j * angle)
    place = given[0][1] + turn * (anchor - given[0][0])
    return float(place.real), float(place.imag), float(angle)
