"""Joint forces of a group of links that no dyad solves: all free bodies at once."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from equipoise.mechanism import kernels
from equipoise.mechanism.loops import Array, GearLoop, Loop, Pose, Poses
from equipoise.mechanism.newton import LoopGroup
from equipoise.mechanism.steps import State, p, u


@dataclass(frozen=True)
class LoopForces:
    """Solves the free-body equations of a group: as many unknown joint forces as equations.

    outputs : for each loop, the names of its force and, of a slider, its couple.
    """

    group: LoopGroup
    loops: tuple[Loop, ...]
    outputs: tuple[tuple[str, ...], ...]

    def run(self, state: State) -> None:
        poses = self.poses(state)
        senses = self.senses(state, poses)
        strengths = self.solve(state, poses, senses)
        k = 0
        for loop, names, sense in zip(self.loops, self.outputs, senses, strict=True):
            wrenches = loop.wrenches(poses, sense)
            parts = [strengths[..., k + i] for i in range(loop.unknowns)]
            wrench = [
                sum(part * unit[i] for part, unit in zip(parts, wrenches, strict=True))
                for i in range(2)
            ]
            state.update(zip(names, wrench, strict=False))
            if isinstance(loop, GearLoop):
                state[f"p(pitch({loop.name}))"] = loop.place(poses)
                state[f"T({loop.name})"] = parts[0]
            k += loop.unknowns

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
            k = 0
            for loop, name in zip(self.loops, names, strict=True):
                if name:
                    (state[name],) = kernels.flank(strengths[..., k])
                k += loop.unknowns
        return [state[name] if name else 0.0 for name in names]

    def solve(self, state: State, poses: Poses, senses: Sequence[Any]) -> Array:
        """Strength of every unknown, (..., N, 3 n)."""
        shape = np.shape(state["theta"])
        columns = [
            [np.broadcast_to(entry, shape) for entry in column]
            for loop, sense in zip(self.loops, senses, strict=True)
            for column in self.columns(loop, poses, sense)
        ]
        matrix = np.moveaxis(np.array(columns), (0, 1, 2), (2, 1, 0))
        return np.linalg.solve(matrix, self.demand(state)[..., None])[..., 0]

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
