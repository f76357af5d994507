"""Building a group for Newton's method: its loop equations, its start, and its joint forces."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import islice
from math import ceil, degrees, pi
from typing import Any

import numpy as np

from equipoise.errors import ModelError
from equipoise.mechanism import kernels
from equipoise.mechanism.groups import Mesh
from equipoise.mechanism.joints import Structure
from equipoise.mechanism.model import FRAME, Gear, Position, Slider
from equipoise.mechanism.newton import (
    End,
    GearLoop,
    Loop,
    LoopGroup,
    PinLoop,
    Pose,
    Poses,
    SlideLoop,
)
from equipoise.mechanism.steps import (
    Array,
    Builder,
    Group,
    Reaction,
    State,
    Step,
    initial_state,
    p,
    pin_reaction,
    run,
    u,
)


@dataclass(frozen=True)
class LoopForces:
    """Solves the free-body equations of a group: as many unknown joint forces as equations.

    reactions : of each loop.
    """

    group: LoopGroup
    loops: tuple[Loop, ...]
    reactions: tuple[Reaction, ...]

    def run(self, state: State) -> None:
        poses = self.poses(state)
        senses = self.senses(state, poses)
        strengths = self.solve(state, poses, senses)
        for loop, reaction, sense, parts in zip(
            self.loops, self.reactions, senses, strengths, strict=True
        ):
            units = zip(*loop.wrenches(poses, sense), strict=True)  # of forces, then of couples
            for name, unit in zip(reaction.outputs, units, strict=False):
                state[name] = sum(part * one for part, one in zip(parts, unit, strict=True))
            if isinstance(loop, GearLoop):
                state[f"p({reaction.at})"] = loop.place(poses)
                state[f"T({loop.name})"] = parts[0]

    def poses(self, state: State) -> Poses:
        poses = self.group.known_poses(state)
        for link, anchor in zip(self.group.links, self.group.anchors, strict=True):
            x, y, z = (state[name] for name in p(anchor))
            _, w, a = (state[name] for name in u(link))
            poses[link] = Pose((x, y, z), (state[f"phi({link})"], w, a))
        return poses

    def senses(self, state: State, poses: Poses) -> list[Any]:
        """Sign of each gear's tangential force, which does not depend on the pressure angle."""
        names = [f"flank({loop.name})" if isinstance(loop, GearLoop) else "" for loop in self.loops]
        if any(name and name not in state for name in names):
            strengths = self.solve(state, poses, [0.0] * len(self.loops))
            for name, parts in zip(names, strengths, strict=True):
                if name:
                    (state[name],) = kernels.flank(parts[0])
        return [state[name] if name else 0.0 for name in names]

    def solve(self, state: State, poses: Poses, senses: Sequence[Any]) -> list[list[Array]]:
        """Strength (..., N) of every unknown of each loop."""
        shape = np.shape(state["theta"])
        columns = [
            [np.broadcast_to(entry, shape) for entry in column]
            for loop, sense in zip(self.loops, senses, strict=True)
            for column in self.columns(loop, poses, sense)
        ]
        matrix = np.moveaxis(np.array(columns), (0, 1, 2), (2, 1, 0))
        solved = np.linalg.solve(matrix, self.demand(state)[..., None])[..., 0]
        strengths = iter(np.moveaxis(solved, -1, 0))
        return [list(islice(strengths, loop.unknowns)) for loop in self.loops]

    def columns(self, loop: Loop, poses: Poses, sense: Any) -> list[list[Any]]:
        """Force and moment about the anchor on each link, for a unit of each of its unknowns."""
        at = loop.place(poses)
        result = []
        for force, couple in loop.wrenches(poses, sense):
            column: list[Any] = []
            for link in self.group.links:
                sign = (link == loop.on.body) - (link == loop.by.body)
                moment = kernels.cross(at - poses[link].place[0], force) + couple
                column += [sign * np.real(force), sign * np.imag(force), sign * moment]
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


STEPS_PER_TURN = 360
"""Crank angles in a turn at which a branch is followed from one to the next."""
FAR = 0.25
"""Distance, in sizes of the machine, between a place in the file and the solution found from it."""


def loop_group(builder: Builder, joints: Structure, links: tuple[str, ...]) -> Group:
    """Make the group of these links, with `builder` knowing them afterwards."""
    maker = _Maker(builder, joints, links)
    before, loops = maker.prepare()
    unsolved = LoopGroup(
        links,
        tuple(maker.anchors[link] for link in links),
        tuple((body, builder.anchors[body]) for body in builder.rank),
        loops,
        (),
        builder.size(),
    )
    run(before, builder.now)
    solved, loops = _solve_start(builder, before, unsolved, loops)
    builder.add(maker.anchors, {maker.anchors[link] for link in links})
    builder.running.update(links)
    reactions = tuple(maker.reaction(loop) for loop in loops)
    hand_over = tuple(builder.hand_over(one) for one in reactions if one.by not in links)
    reach = tuple(
        step
        for reaction in reactions
        if reaction.kind != "gear"
        for step in builder.reach(reaction.on, reaction.at)
    )
    forces: tuple[Step, ...] = (LoopForces(solved, loops, reactions), *hand_over)
    return Group("loops", links, (*before, solved, *reach), forces, reactions)


@dataclass
class _Maker:
    builder: Builder
    joints: Structure
    links: tuple[str, ...]

    def __post_init__(self) -> None:
        self.anchors = {}
        for link in self.links:
            points = [*self.builder.machine.links[link].points]
            self.anchors[link] = next((pt for pt in points if pt in self.joints.pins), points[0])

    def end(self, body: str, point: str) -> End:
        anchor = self.anchors.get(body) or self.builder.anchors[body]
        return End(body, point, self.builder.arm(body, anchor, point))

    def prepare(self) -> tuple[tuple[Step, ...], tuple[Loop, ...]]:
        """Steps that make the known bodies' angles available, and the loop equations."""
        reachable = {*self.builder.rank, *self.links}
        loops: list[Loop] = []
        for point, bodies in self.joints.pins.items():
            if free := [body for body in bodies if body in self.links]:
                known = [body for body in bodies if body in self.builder.rank]
                hub = self.builder.carrier_of(known) if known else free[0]
                held = [self.end(link, point) for link in free if link != hub]
                loops += [PinLoop(point, end, self.end(hub, point)) for end in held]
        for slider in self.joints.sliders:
            ends = {slider.link, slider.on}
            if ends <= reachable and ends & set(self.links):
                loops.append(self.slide(slider))
        before: list[Step] = []
        for gear in self.joints.gears:
            ends = {gear.driver, gear.driven, gear.carrier}
            if ends <= reachable and ends & set(self.links):
                for body in ends & self.builder.rank.keys():
                    before += self.builder.running_angle(body)
                loops.append(self.gear(gear))
        return tuple(before), tuple(loops)

    def slide(self, slider: Slider) -> SlideLoop:
        """The link `on` is always one of the group; the line is the same seen from either."""
        link, guide = self.end(slider.link, slider.point), self.end(slider.on, slider.through)
        if slider.link in self.links:
            return SlideLoop(slider.name, link, guide, slider.direction, slider.angle)
        return SlideLoop(slider.name, guide, link, -slider.angle, -slider.direction)

    def gear(self, gear: Gear) -> GearLoop:
        if gear.driven not in self.links:
            raise ModelError(
                f"gears[{self.joints.gears.index(gear) + 1}]",
                f"{gear.driven!r} is moved already by other joints; name the gear that is moved "
                "already first in between",
            )
        mesh = Mesh.of(self.builder, self.joints, gear)
        on, by = self.end(gear.driven, mesh.driven_pin), self.end(gear.driver, mesh.driver_pin)
        ratio = gear.speed_ratio
        return GearLoop(gear.name, on, by, gear.carrier, ratio, 0.0, mesh.lever, mesh.radial)

    def reaction(self, loop: Loop) -> Reaction:
        on, by = loop.on.body, loop.by.body
        force = f"R({loop.name}/{on})"
        if isinstance(loop, PinLoop):
            return pin_reaction(loop.name, on, by)
        if isinstance(loop, SlideLoop):
            couple = f"C({loop.name}/{on})"
            return Reaction(loop.name, "slider", on, by, loop.on.point, force, couple)
        return Reaction(loop.name, "gear", on, by, f"pitch({loop.name})", force)


def _solve_start(
    builder: Builder, before: tuple[Step, ...], group: LoopGroup, loops: tuple[Loop, ...]
) -> tuple[LoopGroup, tuple[Loop, ...]]:
    """The group with its solution at crank angle 0 and, from that, the offsets of its gears."""
    position = builder.machine.position
    if position is None:
        raise ModelError(
            "position",
            f"missing; no dyad solves {', '.join(group.links)}, so the file must say roughly "
            "where they are: crank_angle, and points or angles of these links",
        )
    gears = {gear.name: gear for gear in builder.machine.gears}
    meshes = [loop for loop in loops if isinstance(loop, GearLoop)]
    if meshes and position.crank_angle != 0:
        raise ModelError(
            "position.crank_angle",
            f"got {degrees(position.crank_angle):g} deg; give the position at 0 deg, where the "
            "start angle of the gears holds",
        )
    # Its gears stand still at the angle at which they start.
    stand_in = replace(
        group,
        equations=tuple(
            replace(loop, carrier=FRAME, ratio=0.0, offset=gears[loop.name].start)
            if isinstance(loop, GearLoop)
            else loop
            for loop in loops
        ),
    )
    steps = max(2, ceil(abs(position.crank_angle) / (2 * pi) * STEPS_PER_TURN))
    path = np.linspace(0.0, position.crank_angle, steps)
    state = initial_state(builder.machine, path)
    run([*builder.motion, *before], state)
    known = group.known_poses(state)
    guess = [x for link in group.links for x in _guess(builder, group, link, known, position)]
    backwards = {body: pose.pick(slice(None, None, -1)) for body, pose in known.items()}
    columns = stand_in.follow(np.array(guess), backwards, path[::-1])
    at_zero = columns[:, -1]
    if not meshes:
        at_zero[2::3] = np.angle(np.exp(1j * at_zero[2::3]))
    at_start = group.poses(known, columns[:, ::-1])
    solved = tuple(
        replace(loop, offset=float(np.ravel(loop.gaps(at_start, 0)[0])[0]))
        if isinstance(loop, GearLoop)
        else loop
        for loop in loops
    )
    _check_near(builder, group.poses(backwards, columns[:, :1]), position, group)
    start = tuple(float(x) for x in at_zero)
    return replace(group, start=start, equations=solved), solved


def _check_near(builder: Builder, poses: Poses, position: Position, group: LoopGroup) -> None:
    """A solution far from the position in the file may be another assembly of the links."""
    for link, anchor in zip(group.links, group.anchors, strict=True):
        for name in builder.machine.links[link].points.keys() & position.points.keys():
            found = complex(np.ravel(poses[link].point(builder.arm(link, anchor, name))[0])[0])
            if abs(found - complex(*position.points[name])) > FAR * group.size:
                raise ModelError(
                    f"position.points.{name}",
                    f"too rough: the links meet with {name} at ({found.real * 1e3:.4g}, "
                    f"{found.imag * 1e3:.4g}) mm; give a place nearer to where it is",
                )


def _guess(
    builder: Builder, group: LoopGroup, link: str, known: Poses, position: Position
) -> tuple[float, float, float]:
    """Rough position of a link's anchor and its angle, from the file and from known pins."""
    points = builder.machine.links[link].points
    given = [
        (complex(*points[name]), complex(*position.points[name]))
        for name in points
        if name in position.points
    ]
    for body, pose in known.items():
        for name in builder.machine.points_of(body):
            if name in points and name not in position.points:
                arm = builder.arm(body, builder.anchors[body], name)
                given.append((complex(*points[name]), complex(pose.point(arm)[0][-1])))
    anchor = complex(*points[group.anchors[group.links.index(link)]])
    angle = position.angles.get(link)
    if angle is None and len(given) >= 2:
        pairs = [(a - b, c - d) for a, c in given for b, d in given if a != b]
        local, world = max(pairs, key=lambda pair: abs(pair[0]))
        angle = float(np.angle(world / local)) if world else None
    if angle is None or not given:
        raise ModelError(
            "position",
            f"does not place {link!r} at crank angle {degrees(position.crank_angle):g} deg; give "
            f"two of its points ({', '.join(points)}), or one and its angle",
        )
    turn = np.exp(1j * angle)
    place = given[0][1] + turn * (anchor - given[0][0])
    return float(place.real), float(place.imag), float(angle)
