"""Joint forces of a group of loops in terms.

The joints that close the loops follow by virtual work, from as many equations as there are unknowns
of the motion; what is left on each link its own joint in the tree supplies, the last links first.
"""

from __future__ import annotations

from collections.abc import Iterator
from operator import attrgetter
from typing import Any

import numpy as np

from equipoise.codegen.loops import Minors, group_of
from equipoise.codegen.trace import Trace
from equipoise.mechanism.assembly.linkage import Linkage
from equipoise.mechanism.assembly.loopgroup import LoopForces
from equipoise.mechanism.assembly.loops import Loop, Place, Poses
from equipoise.mechanism.formulas.kernels import cross, dot

Demand = tuple[Any, Any]


def trace_loop_forces(trace: Trace, number: int) -> None:
    """Forces of a group's joints, the step of this number of the linkage's ``forces``."""
    step = trace.linkage.forces[number]
    assert isinstance(step, LoopForces)
    _Forces(trace, step, number).put()


class _Forces:
    """Joints of a group whose numbers are terms.

    demands : what the joints of each link have to supply yet, about its anchor.
    """

    def __init__(self, trace: Trace, step: LoopForces, number: int) -> None:
        self.trace, self.step, self.solved = trace, step, group_of(trace, step.group)

        def read(linkage: Linkage) -> Any:
            return attrgetter("loops")(linkage.forces[number])

        self.loops: tuple[Loop, ...] = self.solved.slotted(step.loops, f"loops {number}", read)
        self.poses = self.solved.final
        self.demands: dict[str, Demand] = {
            link: (trace.state[f"F({link})"], trace.state[f"M({link})"])
            for link in step.group.links
        }
        closing = {_key(equation) for equation in step.group.equations}
        self.closing = [k for k, loop in enumerate(step.loops) if _key(loop) in closing]

    def put(self) -> None:
        """Add the forces to the state."""
        closing = [self.loops[k] for k in self.closing]
        strengths = iter(self.by_work(closing))
        for k, loop in zip(self.closing, closing, strict=True):
            units = loop.wrenches(self.poses, 0.0)
            parts = [next(strengths) for _ in units]
            pairs = [*zip(parts, units, strict=True)]
            force = sum(part * unit for part, (unit, _) in pairs)
            self.exert(k, force, sum(part * couple for part, (_, couple) in pairs))
        for place in reversed(self.step.group.tree):
            self.supply(place)

    def by_work(self, closing: list[Loop]) -> list[Any]:
        """Strengths of the joints that close the loops: on every motion that the tree leaves, they
        do the work that the links demand.
        """
        rows, right = [], []
        for unit in np.eye(len(self.solved.group.turning)).tolist():
            moved = self.solved.poses(self.solved.still, self.solved.reached, unit)
            rows.append([work for loop in closing for work in self.works(loop, moved)])
            right.append(sum(
                dot(force, moved[link].place[1]) + moment * moved[link].turn[1]
                for link, (force, moment) in self.demands.items()
            ))  # fmt: skip
        return Minors(rows).solve(right)

    def works(self, loop: Loop, moved: Poses) -> Iterator[Any]:
        """Work of a unit of each of a joint's unknowns, on both of its bodies."""
        at = loop.place(self.poses)
        ends = [(sign, moved[end.body]) for sign, end in ((1.0, loop.on), (-1.0, loop.by))
                if end.body in self.demands]  # fmt: skip
        for force, couple in loop.wrenches(self.poses, 0.0):
            yield sum(sign * _work(pose, at, force, couple) for sign, pose in ends)

    def supply(self, place: Place) -> None:
        """What the joint supplies by which the tree places a link: all that is left on it."""
        ends = {place.link, place.to.body}  # type: ignore[union-attr]
        k = next(k for k, loop in enumerate(self.step.loops)
                 if k not in self.closing and {loop.on.body, loop.by.body} == ends)  # fmt: skip
        loop, (force, moment) = self.loops[k], self.demands[place.link]
        sign = 1.0 if loop.on.body == place.link else -1.0
        couple = moment - cross(loop.place(self.poses) - self.poses[place.link].place[0], force)
        if loop.turns:
            (_, _), (across, _) = loop.wrenches(self.poses, 0.0)
            self.exert(k, dot(across, force) * sign * across, sign * couple)
        else:
            self.exert(k, sign * force, 0.0)

    def exert(self, k: int, force: Any, couple: Any) -> None:
        """Take what a joint exerts off what its links demand, and add it to the state."""
        loop, reaction = self.loops[k], self.step.reactions[k]
        self.trace.state.update(zip(reaction.outputs, (force, couple), strict=False))
        at = loop.place(self.poses)
        for sign, end in ((1.0, loop.on), (-1.0, loop.by)):
            if end.body in self.demands:
                left, moment = self.demands[end.body]
                turning = cross(at - self.poses[end.body].place[0], force) + couple
                self.demands[end.body] = left - sign * force, moment - sign * turning


def _key(loop: Loop) -> tuple[str, str, str]:
    return loop.name, loop.on.body, loop.by.body


def _work(pose: Any, at: Any, *wrench: Any) -> Any:
    """Work of a force at a place, and of a couple, on a body by the rates of a pose."""
    force, couple = wrench
    speed = pose.place[1] + 1j * pose.turn[1] * (at - pose.place[0])
    return dot(force, speed) + couple * pose.turn[1]
