"""Machines of the same build solved together: designs of one linkage, or a single one.

Their steps differ in nothing but parameters.  With the parameters stacked, one run of the steps
solves all machines at all their crank angles.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np

from equipoise.mechanism import kernels
from equipoise.mechanism.linkage import Linkage
from equipoise.mechanism.model import FRAME
from equipoise.mechanism.steps import Call, State, Step, p, run, u

Array = np.ndarray[Any, Any]
Triple = tuple[Array, Array, Array]


class Family:
    """P linkages with the same links, joints and assembly.

    Their values in a state are (P, K), or broadcast to that.
    """

    def __init__(self, linkages: Sequence[Linkage]) -> None:
        self.linkages = tuple(linkages)
        self.first = self.linkages[0]
        self._arms: dict[tuple[str, str], Array] = {}
        self._frame = {
            name: column(complex(*k.machine.frame[name]) for k in self.linkages)
            for name in self.first.machine.frame
        }
        self.steps: list[Step] | None = None
        if all(isinstance(step, Call) for step in self.first.motion):
            self.steps = [
                _stacked(calls) for calls in zip(*(k.motion for k in linkages), strict=True)
            ]

    def solve(self, theta: Array) -> State:
        """Every link known at crank angles (P, K), rad."""
        if self.steps is None:
            return self._one_by_one(theta)
        with np.errstate(all="ignore"):
            return run(self.steps, self._start(theta))

    def point(self, state: State, link: str, point: str) -> Triple:
        """A point of a link and its derivatives by crank angle, (P, K)."""
        given = [state[name] for name in (*p(self.first.anchors[link]), *u(link))]
        values: Triple = kernels.point(*given, self._arm(link, point))  # type: ignore[call-arg]
        shape = np.shape(state["theta"])
        place, first, second = (np.broadcast_to(value, shape) for value in values)
        return place, first, second

    def _arm(self, link: str, point: str) -> Array:
        """Vector from a link's anchor to a point of it, in the link's axes, (P, 1)."""
        if (link, point) not in self._arms:
            bodies = (k.machine.points_of(link) for k in self.linkages)
            anchor = self.first.anchors[link]
            arms = (complex(*body[point]) - complex(*body[anchor]) for body in bodies)
            self._arms[link, point] = column(arms)
        return self._arms[link, point]

    def rates(self, state: State, link: str) -> tuple[Array, Array]:
        """First and second derivative of a link's angle by crank angle, (P, K)."""
        shape = np.shape(state["theta"])
        _, first, second = (np.broadcast_to(state[name], shape) for name in u(link))
        return first, second

    def numbers(self, state: State) -> Array:
        """Smallest own number of any dyad at each crank angle, (P, K); below 0 it is open."""
        names = [group.number for group in self.first.groups if group.number is not None]
        values = [np.broadcast_to(state[name], np.shape(state["theta"])) for name in names]
        smallest: Array = np.min([np.ones(np.shape(state["theta"])), *values], axis=0)
        return smallest

    def _start(self, theta: Array) -> State:
        state: State = {"theta": theta}
        for name, places in self._frame.items():
            state.update({f"p({name})": places, f"p1({name})": 0j, f"p2({name})": 0j})
        drive = self.first.machine.drive.link
        for link, rotation, rate in ((FRAME, 1 + 0j, 0.0), (drive, np.exp(1j * theta), 1.0)):
            state.update({f"u({link})": rotation, f"w({link})": rate, f"a({link})": 0.0})
        return state

    def _one_by_one(self, theta: Array) -> State:
        """Gears and loops follow their own cycle, which stacked parameters do not tell."""
        rows = [k.solve(row) for k, row in zip(self.linkages, theta, strict=True)]
        names = [name for name, value in rows[0].items() if np.ndim(value) < 2]
        return {
            name: np.array(
                [np.broadcast_to(row[name], t.shape) for row, t in zip(rows, theta, strict=True)]
            )
            for name in names
        }


def _stacked(calls: Sequence[Any]) -> Call:
    """The same call of all machines, with columns (P, 1) for parameters."""
    first = calls[0]
    columns = (column(values) for values in zip(*(c.parameters for c in calls), strict=True))
    return Call(first.kernel, first.inputs, tuple(columns), first.outputs)


def column(values: Iterable[Any]) -> Array:
    """One value for each machine, (P, 1)."""
    return np.array(list(values))[:, None]
