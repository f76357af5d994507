"""Forces in joints of a machine in a run, and contacts of parts that only push, or only pull.

Forces follow from the motion that the run has followed; contacts from these forces, or from the
gaps of elements: when parts meet and let go, and how hard.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from functools import cached_property
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.i18n import Note
from equipoise.mechanism.dynamics.friction import with_friction
from equipoise.mechanism.dynamics.reactions import ForceReadings, JointReactions, reactions
from equipoise.mechanism.dynamics.reduced import rated_ways
from equipoise.mechanism.kinematics.motion import move
from equipoise.mechanism.parts.element_kinds import rated_elements
from equipoise.mechanism.parts.machine import Machine
from equipoise.running.drives_equation import DrivesEquation, DriveState
from equipoise.running.drives_linkage import DriveAngles, References
from equipoise.running.sources import plus
from equipoise.signals import ROUNDING, Array

if TYPE_CHECKING:
    from equipoise.mechanism.kinematics.motion import Motion
    from equipoise.mechanism.parts.machine import Machine
    from equipoise.vibration.support_motion import SupportMotion

HALVINGS = 50
"""Of the time between two instants, in which a gap of 0 is looked for."""
Crossing = Callable[[int], float]
"""Time, s, at which contact changes between the instants before a place and at it."""

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
        state = equation.at(self.time[places], since, where, references)
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


@dataclass(frozen=True)
class RunContact:
    """A time for which a one-sided part is in contact.

    part : its name in outputs, such as ``stops.1``, ``cams.follower``, ``belts.wheel.left`` (a
        strand) or ``mounts.front``.
    row : number of its row, from 1; None of a machine without rows, and of mounts.
    parts : those that touch, for readers.
    begin : s, at which they meet, or the start of the run.
    end : s, at which they let go; None where the run ends first.
    approach : speed with which the gap closes at the begin, m/s; None of a part whose motion is
        computed as if it stayed in contact, and of mounts.
    force : the largest, N.
    """

    part: str
    row: int | None
    parts: Note
    begin: float
    end: float | None
    approach: float | None
    force: float

    def to_dict(self) -> dict[str, object]:
        """The machine-readable output, in SI units."""
        return {name: value for name, value in vars(self).items() if name != "parts"}


def contacts_of_elements(
    motions: Sequence[Motion], time: Array, rate: Array | float
) -> Iterator[RunContact]:
    """Contacts of force elements that only push.

    motions : of each row, at M instants of time (M,), s, rising.
    rate : by which derivatives of the motion become those by time, such as the speed of the crank
        (M,), rad/s.
    """
    machine = motions[0].machine
    one_sided = [item for item in rated_elements(machine) if item[2].one_sided]
    for row, motion in enumerate(motions, 1):
        for table, number, element in one_sided:
            gap, slope = rated_ways(motion, [(table, number, element)])
            opening = slope * rate
            force = np.asarray(element.efforts([(gap, opening)])[0])

            def crossing(k: int, gap: Array = gap, opening: Array = opening) -> float:
                return _zero(time, gap, opening, k)

            named = f"{table}.{number + 1}", _row(machine, row), element.label
            for begin, end, largest in _intervals(gap < 0, force, time, crossing):
                approach = -float(np.interp(begin, time, opening))
                yield RunContact(*named, begin, end, approach, largest)


def contacts_of_couplings(passage: Passage) -> Iterator[RunContact]:
    """Contacts of couplings that only push, or only pull: their bodies move as if these did not let
    go, and they do where they would have to hold, between instants by straight lines.
    """
    machine, time = passage.equation.machine, passage.time
    count = passage.equation.rows.count
    one_sided = [(coupling, part) for coupling in machine.couplings for part in coupling.one_sided]
    if not one_sided:
        return
    pressing, known = np.zeros((len(one_sided), count, len(time))), np.zeros(len(time), bool)
    for places, forces in passage.forces():
        known[places] = True
        for own, (coupling, part) in zip(pressing, one_sided, strict=True):
            values = getattr(forces.couplings[coupling.list_name][coupling.name], part)
            own[:, places] = np.reshape(values, (count, -1))
    if not np.any(known):
        return
    for (coupling, part), own in zip(one_sided, pressing[:, :, known], strict=True):
        for row, force in enumerate(own, 1):
            name = f"{coupling.list_name}.{coupling.name}"
            named = f"{name}.{part}" if len(coupling.one_sided) > 1 else name
            words = coupling.one_sided[part]
            for begin, end, largest in _by_force(force, time[known], time[0]):
                yield RunContact(named, _row(machine, row), words, begin, end, None, largest)


def contacts_of_mounts(support: SupportMotion, time: Array) -> Iterator[RunContact]:
    """Contacts of mounts that only push, whose letting go is part of the motion."""
    for contact, force in zip(support.mounted.contacts, support.smooth_forces, strict=True):
        if contact.one_sided:
            words = Note("mount {name}", name=contact.name)
            for begin, end, largest in _by_force(force, time, time[0]):
                yield RunContact(f"mounts.{contact.name}", None, words, begin, end, None, largest)


def _row(machine: Machine, row: int) -> int | None:
    return row if machine.rows else None


def _by_force(
    force: Array, time: Array, start: float
) -> Iterator[tuple[float, float | None, float]]:
    """Begin, end and largest force of each contact, where a force (M,) is above 0.

    start : s, at which the run starts, before the first instant where that is at rest.
    """
    touches = force > -ROUNDING * np.max(np.abs(force))

    def crossing(k: int) -> float:
        if k == 0:
            return float(start)
        before, at = force[k - 1 : k + 1]
        return float(time[k - 1] + (time[k] - time[k - 1]) * before / (before - at))

    return _intervals(touches, force, time, crossing)


def _intervals(
    touches: Array, force: Array, time: Array, crossing: Crossing
) -> Iterator[tuple[float, float | None, float]]:
    """Begin, end and largest force (of M,) of each contact, by whether parts touch (M,)."""
    padded = np.concatenate([[False], touches, [False]])
    edges = np.flatnonzero(padded[1:] != padded[:-1]).tolist()
    for first, behind in zip(edges[::2], edges[1::2], strict=True):
        end = crossing(behind) if behind < len(time) else None
        yield crossing(first), end, float(np.max(force[first:behind]))


def _zero(time: Array, gap: Array, opening: Array, k: int) -> float:
    """When a gap changes its sign between the instants before `k` and at it: a cubic by the values
    and speeds of both; the start of the run where `k` is 0.
    """
    if k == 0:
        return float(time[0])
    span = time[k] - time[k - 1]
    (a, b), (p, q) = gap[k - 1 : k + 1], opening[k - 1 : k + 1] * span

    def cubic(s: float) -> float:
        t = 1.0 - s
        return float(a * t * t * (1 + 2 * s) + b * s * s * (3 - 2 * s) + s * t * (p * t - q * s))

    low, high = 0.0, 1.0
    for _ in range(HALVINGS):
        middle = (low + high) / 2
        low, high = (middle, high) if (cubic(middle) < 0) == (a < 0) else (low, middle)
    return float(time[k - 1] + high * span)
