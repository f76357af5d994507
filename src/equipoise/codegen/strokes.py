"""Drives that push, in terms: angles of the links that they push, and the forces that it takes.

The angles are those at which all lengths are as commanded, by Newton's method from those of the
base at the same crank angle; the motion's own steps are run for the lengths and for how these
change as one of the links turns.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import partial, reduce
from typing import Any

import numpy as np

from equipoise.codegen.loops import ARRIVED, Minors
from equipoise.codegen.terms import greatest, rotation
from equipoise.codegen.trace import Trace
from equipoise.mechanism.assembly.linkage import Linkage
from equipoise.mechanism.assembly.loops import LoopGroup
from equipoise.mechanism.assembly.steps import demand_names, size_of_bodies
from equipoise.mechanism.checks import FRAME
from equipoise.mechanism.dynamics.reactions import PUSH
from equipoise.mechanism.formulas import kernels
from equipoise.mechanism.kinematics.cylinders import push_lines
from equipoise.mechanism.kinematics.motion import pushed_length, slider_of
from equipoise.mechanism.parts.drives import Drive, FurtherDrive
from equipoise.mechanism.parts.element_kinds import Placed
from equipoise.signals import Array

Pusher = Drive | FurtherDrive
Turned = tuple[Any, Any, Any, Any]
"""Angle of a driven link, its rotation, and its two derivatives by crank angle."""
SPEED = "push speed({})"
"""How fast a drive pushes its ends apart, m/s, among the values of the state."""
ROUNDS = 5
"""Of Newton's method from the base's angles."""


def can_trace_strokes(linkage: Linkage) -> bool:
    """Whether drives that push can be traced: beside dyads alone."""
    machine = linkage.machine
    loops = any(isinstance(step, LoopGroup) for step in linkage.motion)
    return not machine.pushers or not (machine.couplings or loops or linkage.shared)


class TracedStrokes:
    """Links that are pushed.

    steps : runs the steps of the motion, from what is driven by its links.
    others : what is driven by its angle.
    """

    def __init__(
        self,
        trace: Trace,
        steps: Callable[[Mapping[str, Turned]], None],
        others: Mapping[str, Turned],
    ) -> None:
        self.trace, self.steps, self.others = trace, steps, others
        self.pushers = trace.machine.pushers
        self.resting = {link: (*turned[:2], 0.0, 0.0) for link, turned in others.items()}

    def turned(self) -> dict[str, Turned]:
        """The links that are pushed."""
        trace, count = self.trace, len(self.pushers)
        wanted = [
            [trace.row(f"stroke {place}({item.link})", partial(_commanded, item, place))
             for item in self.pushers] for place in range(3)
        ]  # fmt: skip
        q = [
            trace.row(f"angle({item.link})", partial(_turned, trace.linkage, item.link))
            for item in self.pushers
        ]
        still, units = [0.0] * count, np.eye(count).tolist()
        for _ in range(ROUNDS):
            minors, lengths = self.levers(q, units)
            gaps = [goal - length for goal, length in zip(wanted[0], lengths, strict=True)]
            q = [item + step for item, step in zip(q, minors.solve(gaps), strict=True)]
        minors, lengths = self.levers(q, units)
        size = trace.slot("size", lambda linkage: size_of_bodies(linkage.machine))
        left = [goal - length for goal, length in zip(wanted[0], lengths, strict=True)]
        farthest = reduce(greatest, [abs(gap) for gap in left])
        trace.running["strokes arrive"] = 1.0 - farthest * (1 / (ARRIVED * size))
        by_others = [first for _, first, _ in self.lengths(q, still, self.others)]
        rates = minors.solve([a - b for a, b in zip(wanted[1], by_others, strict=True)])
        bent = [second for *_, second in self.lengths(q, rates, self.others)]
        bends = minors.solve([a - b for a, b in zip(wanted[2], bent, strict=True)])
        return self.driven(q, rates, bends)

    def levers(self, q: Sequence[Any], units: list[list[float]]) -> tuple[Minors, list[Any]]:
        """Derivatives of the lengths by the links' angles, and the lengths."""
        columns = [self.lengths(q, unit, self.resting) for unit in units]
        rows = [[column[k][1] for column in columns] for k in range(len(units))]
        return Minors(rows), [length for length, *_ in columns[0]]

    def lengths(
        self, q: Sequence[Any], rates: Sequence[Any], others: Mapping[str, Turned]
    ) -> list[tuple[Any, Any, Any]]:
        """Lengths with both derivatives, where the links do not accelerate."""
        trace, state = self.trace, self.trace.state
        trace.state = dict(state)
        self.steps({**others, **self.driven(q, rates, [0.0] * len(q))})
        values = [_length(trace, item) for item in self.pushers]
        trace.state = state
        return values

    def driven(
        self, q: Sequence[Any], rates: Sequence[Any], bends: Sequence[Any]
    ) -> dict[str, Turned]:
        """Links by angles and their derivatives."""
        values = zip(self.pushers, q, rates, bends, strict=True)
        return {item.link: (at, rotation(at), w, a) for item, at, w, a in values}


def _commanded(pusher: Pusher, place: int, theta: Array) -> Array:
    assert pusher.stroke is not None
    return np.asarray(pusher.stroke.value(theta)[place] + 0.0 * theta)


def _turned(linkage: Linkage, link: str, theta: Array) -> Array:
    return np.asarray(linkage.machine.moved(theta)[link][0])


def _length(trace: Trace, pusher: Pusher) -> tuple[Any, Any, Any]:
    """Length that a drive pushes, m, and both derivatives by crank angle."""
    along = rotation(_direction(trace, pusher)) if pusher.slider else 1.0
    return pushed_length(trace.machine, pusher, trace.point, trace.state, along)


def _direction(trace: Trace, pusher: Pusher) -> Any:
    """Direction of a sliding joint that is driven, in the axes of the body that it is on, rad; 0 of
    a drive between points.
    """
    if not pusher.slider:
        return 0.0
    name = f"direction of {pusher.slider}"
    return trace.slot(name, lambda linkage: slider_of(linkage.machine, pusher).direction)


# -- forces ----------------------------------------------------------------------------------------


def trace_pushes(trace: Trace, at: Placed, steps: Callable[[], None]) -> None:
    """Add the forces in all joints and ``push(link)`` of each drive that pushes: as large as it
    takes for its link to need no torque.

    at : has the bodies.  steps : runs the steps of the forces, which end at the torque of each
        drive.
    """
    pushers, before = trace.machine.pushers, trace.state
    links = trace.linkage.joints.bodies[1:]
    torques = [demand_names(item.link)[1] for item in pushers]

    def passed(demands: Mapping[str, tuple[Any, Any]]) -> list[Any]:
        """Torques that the links need."""
        trace.state = dict(before)
        for link in links:
            trace.put(demand_names(link), demands.get(link, (0j, 0.0)))
        steps()
        return [trace.state[name] for name in torques]

    given = {link: tuple(before[name] for name in demand_names(link)) for link in links}
    units = [_unit(trace, at, item) for item in pushers]
    columns = [passed(unit) for unit in units]
    rows = [[column[k] for column in columns] for k in range(len(pushers))]
    forces = Minors(rows).solve([-torque for torque in passed(given)])
    for force, unit in zip(forces, units, strict=True):
        for link, (push, turning) in unit.items():
            own = given[link]
            given[link] = own[0] + force * push, own[1] + force * turning
    passed(given)
    for item, force in zip(pushers, forces, strict=True):
        trace.state[PUSH.format(item.link)] = force
        trace.state[SPEED.format(item.link)] = _length(trace, item)[1] * trace.rate("speed")


def _unit(trace: Trace, at: Placed, pusher: Pusher) -> dict[str, tuple[Any, Any]]:
    """What holds 1 N of a drive against each moving link that it pushes, about its anchor."""
    lines = push_lines(trace.machine, pusher, at, _direction(trace, pusher))
    return {
        link: kernels.load_demand(trace.body(link)[0], place, way, 0.0)
        for link, place, way in lines
        if link != FRAME
    }
