"""Forces in joints and couplings of a machine in a run, by the motion that it has followed."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from functools import cached_property
from itertools import pairwise

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.mechanism.dynamics.force_readings import ForceReadings
from equipoise.mechanism.dynamics.friction import with_friction
from equipoise.mechanism.dynamics.reactions import JointReactions, reactions
from equipoise.mechanism.kinematics.motion import move
from equipoise.mechanism.parts.machine import Machine
from equipoise.running.drive_angles import DriveAngles
from equipoise.running.drives_equation import DrivesEquation, DriveState
from equipoise.running.drives_linkage import References
from equipoise.running.equation import just_after
from equipoise.running.sources import plus
from equipoise.signals import Array

MOST_STATES = 4096
"""Of all rows, that are computed at once."""


@dataclass(frozen=True, eq=False)
class Passage:
    """States that a machine has passed in a run, at M instants.

    time : (M,) s, rising.  where : its drives, as of `DrivesEquation.placed`.
    references : (..., R, M), as of `DrivesEquation.at`.
    accelerations : of all coordinates of each row (C R, M); of a machine that has not been
        integrated by this equation None.
    torques : (C, M), N m, from which accelerations follow where they are None.
    """

    equation: DrivesEquation
    time: Array
    where: DriveAngles
    references: References
    accelerations: Array | None = None
    torques: Array | None = None

    def forces(self) -> Iterator[tuple[Array, PassedForces]]:
        """Places (K,) of some of the M instants, and forces in all rows there, by and by; not at
        rest, where static friction leaves forces open.
        """
        rows, moves = self.equation.rows.count, np.any(self.where.speeds, axis=0)
        times = {time for load in self.equation.machine.timed_loads for time in load.times}
        corners = np.searchsorted(self.time, sorted(times))
        for first, behind in pairwise(sorted({0, *corners.tolist(), len(self.time)})):
            places = first + np.flatnonzero(moves[first:behind])
            few = max(1, MOST_STATES // rows)
            for part in np.split(places, range(few, len(places), few)):
                if len(part):
                    yield part, PassedForces(rows, self._solved(part, float(self.time[first])))

    def _solved(self, places: Array, since: float) -> JointReactions:
        """Forces at some of the instants, after one from which loads over time follow a line."""
        equation = self.equation
        where = DriveAngles(*(values[..., places] for values in self.where))
        references = {name: values[..., places] for name, values in self.references.items()}
        state = equation.at(self.time[places], just_after(since), where, references)
        changes, pose = self._changes(state, places), state.pose
        demanded = (
            {link: (force * change, moment * change) for link, (force, moment) in unit.items()}
            for unit, change in zip(pose.accelerated, changes, strict=True)
        )
        total = plus(pose.turning, *state.demands, *demanded)
        solve = with_friction if equation.machine.rubs else reactions
        return solve(pose.moving, total)

    def _changes(self, state: DriveState, places: Array) -> Array:
        """Accelerations of all coordinates of each row (C, R K)."""
        if self.accelerations is not None:
            return self.accelerations[:, places].reshape(self.equation.coordinates, -1)
        assert self.torques is not None
        friction = self.equation.friction
        rubbing = 0 if friction is None else len(friction.names) * self.equation.rows.count
        torques = self.torques[:, places]
        return self.equation.accelerations(state, torques, np.zeros(rubbing))[0]


@dataclass(frozen=True, eq=False)
class PassedForces(ForceReadings):
    """Forces (R K) in K states of a run, one row after the other.

    rows : R.  reactions : what joints exert.
    """

    rows: int
    reactions: JointReactions

    @property
    def solved(self) -> JointReactions:
        return self.reactions

    @cached_property
    def count(self) -> int:
        """K."""
        return len(self.reactions.motion.crank_angle) // self.rows


def passage_of_crank(
    machine: Machine, time: Array, angle: Array, speed: Array, torque: Array
) -> Passage:
    """States of a machine with one crank on a fixed frame.

    angle, speed : of the crank (M,), rad and rad/s.  torque : of drive and brake (M,), N m.
    """
    crank = machine.drive if machine.drive.moves_freely else replace(machine.drive, free=True)
    equation = DrivesEquation(replace(machine, drive=crank))
    names, references = equation.linkage.needed_references, {}
    if names:
        states = [move(machine, angle + phase).state for phase in equation.rows.phases]
        for name in names:
            key = name if name in states[0] else f"phi({name})"
            each = [state[key] + np.zeros(len(time)) for state in states]
            references[name] = np.stack(each, axis=-2)
    where = equation.placed(time, angle[None], speed[None])
    return Passage(equation, time, where, references, torques=torque[None])
