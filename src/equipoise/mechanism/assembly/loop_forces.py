"""Forces in the joints of a group of loops: all free bodies of its links at once."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import islice
from typing import Any

import numpy as np

from equipoise.mechanism.assembly.loops import CouplingLoop, Loop, Poses
from equipoise.mechanism.assembly.newton import LoopGroup, poses_in
from equipoise.mechanism.assembly.steps import Array, Reaction, State
from equipoise.mechanism.formulas import joint_kernels, kernels


@dataclass(frozen=True)
class LoopForces:
    """Solves the free-body equations of a group: as many unknown joint forces as equations.

    reactions : of each loop.
    """

    group: LoopGroup
    loops: tuple[Loop, ...]
    reactions: tuple[Reaction, ...]

    def run(self, state: State) -> None:
        group = self.group
        own = zip(group.links, group.anchors, strict=True)
        poses = poses_in(state, (*group.known, *own))
        senses = self.senses(state, poses)
        strengths = self.solve(state, poses, senses)
        for loop, reaction, sense, parts in zip(
            self.loops, self.reactions, senses, strengths, strict=True
        ):
            units = zip(*loop.wrenches(poses, sense), strict=True)  # of forces, then of couples
            for name, unit in zip(reaction.outputs, units, strict=False):
                state[name] = sum(part * one for part, one in zip(parts, unit, strict=True))
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
                    (state[name],) = joint_kernels.flank(parts[0])
        return [state[name] if name else 0.0 for name in names]

    def solve(self, state: State, poses: Poses, senses: Sequence[Any]) -> list[list[Array]]:
        """Strength (..., N) of every unknown of each loop."""
        matrix = self.matrix(state, poses, senses)
        solved = np.linalg.solve(matrix, self.demand(state)[..., None])[..., 0]
        strengths = iter(np.moveaxis(solved, -1, 0))
        return [list(islice(strengths, loop.unknowns)) for loop in self.loops]

    def matrix(self, state: State, poses: Poses, senses: Sequence[Any], more: int = 0) -> Array:
        """What each unknown adds to force and moment on each link, (N, 3 n, m + more)."""
        columns = [
            column
            for loop, sense in zip(self.loops, senses, strict=True)
            for column in self.columns(loop, poses, sense)
        ]
        rows = 3 * len(self.group.links)
        matrix = np.zeros((len(columns) + more, rows, *np.shape(state["theta"])))
        for column, entries in zip(matrix, columns, strict=False):
            for row, entry in entries.items():
                column[row] = entry
        return matrix.T

    def columns(self, loop: Loop, poses: Poses, sense: Any) -> list[dict[int, Any]]:
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
