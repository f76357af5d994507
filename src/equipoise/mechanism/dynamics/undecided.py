"""What statics does not tell of joints: forces that it leaves open, and forces without bound."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from itertools import compress
from math import degrees

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.errors import RangeError, UsageError
from equipoise.i18n import Note, all_of, to_say
from equipoise.mechanism.assembly.linkage import Linkage
from equipoise.mechanism.assembly.shared import CHANGE_POINT_OFFSET, IDLE, WEAK
from equipoise.mechanism.assembly.steps import State, run
from equipoise.mechanism.kinematics.motion import Motion

ANGLES = 7
"""In a cycle, at which it is looked for forces that hold each other."""


LEAST_SQUARES = to_say(
    "the forces in {joints} are statically indeterminate, because of redundant constraints: "
    "reported are those of least squares; drive torque, shaking force and moment, and the "
    "resultant load on the frame do not depend on this choice"
)
WITH_GUIDES = to_say(
    "the forces in {joints} are statically indeterminate, because of redundant constraints: "
    "reported are those of least squares, with moments in guides counted as forces at "
    "{reach:.4g} mm; drive torque, shaking force and moment, and the resultant load on the frame "
    "do not depend on this choice"
)
LEAST_ENERGY = to_say(
    "the forces in {joints} are statically indeterminate, because of redundant constraints: "
    "reported are those of least energy by the stiffness of the joints; drive torque, shaking "
    "force and moment, and the resultant load on the frame do not depend on this choice"
)


@dataclass(frozen=True)
class Undecided:
    """Joints by name, in the order of outputs.

    open : forces that statics leaves open.  unbounded : forces that grow without bound.
    at : crank angle (rad) towards which they do.  links : that lie in line there.
    by_stiffness : whether open forces are shared by the stiffness of joints, not by least squares.
    reach : distance (m) at which a moment in a guide counts as a force; 0 without guides.
    """

    open: tuple[str, ...] = ()
    unbounded: tuple[str, ...] = ()
    at: float = 0.0
    links: tuple[str, ...] = ()
    by_stiffness: bool = False
    reach: float = 0.0

    def told(self) -> Iterator[Note]:
        """A sentence on each."""
        if self.open:
            rule = LEAST_SQUARES if self.reach == 0 else WITH_GUIDES
            rule = LEAST_ENERGY if self.by_stiffness else rule
            yield Note(rule, joints=all_of([*self.open], commas=True), reach=self.reach * 1e3)
        if self.unbounded:
            yield Note(
                "the forces in {joints} are unbounded at crank angle {angle:.4g} deg, where "
                "{links} lie in line without another support, so none are reported; a further "
                "crank or rod that is not in line there would support them",
                joints=all_of([*self.unbounded], commas=True),
                angle=degrees(self.at),
                links=all_of([repr(link) for link in self.links]),
            )


def undecided(linkage: Linkage) -> Undecided:
    """What statics does not tell of the joints of a linkage; kept with it."""
    return _cached(linkage, _compute)


def idle_told(linkage: Linkage, solved: State) -> Iterator[Note]:
    """A sentence on teeth that bear nothing at some crank angles, as neither flank agrees."""
    names = [coupling.name for coupling in linkage.joints.couplings]
    idle = [name for name in names if np.any(solved.get(IDLE.format(name), False))]
    if idle:
        yield Note(
            "at some crank angles neither flank of {names} can carry the force shared with the "
            "joints; it is reported as zero there",
            names=all_of(idle, commas=True),
        )


def refuse_unbounded(linkage: Linkage, output: str) -> None:
    """Raise a `UsageError` for an output of a joint whose force has no bound."""
    result = _cached(linkage, _growing)
    if any(output.partition(".")[2].startswith(name) for name in result.unbounded):
        *_, text = result.told()
        raise UsageError(text)


def hidden(motion: Motion) -> tuple[str, ...]:
    """Joints whose force has no bound at some of the crank angles of a motion, or between them."""
    shared, result = motion.linkage.shared, _cached(motion.linkage, _growing)
    if shared is None or not result.unbounded:
        return ()
    bounded = not motion.whole_cycle and np.all(shared.strength(motion.state) > WEAK)
    return () if bounded else result.unbounded


def _cached(linkage: Linkage, find: Callable[[Linkage], Undecided]) -> Undecided:
    name = find.__name__
    if name not in linkage.memory:
        linkage.memory[name] = find(linkage)
    result: Undecided = linkage.memory[name]
    return result


def _compute(linkage: Linkage) -> Undecided:
    shared = linkage.shared
    if shared is None:
        return Undecided()
    open_ones = shared.open_joints(_somewhere(linkage)) if shared.count else frozenset()
    return replace(
        _cached(linkage, _growing),
        open=_named(linkage, open_ones),
        by_stiffness=bool(shared.compliance),
        reach=shared.group.size if linkage.joints.sliders else 0.0,
    )


def _growing(linkage: Linkage) -> Undecided:
    """Forces without bound alone, which every analysis of joint forces has to know."""
    shared, through = linkage.shared, [group for group in linkage.groups if group.through]
    if shared is None or not through or not _turns(linkage):
        return Undecided()
    weakest = [linkage.cycle.weakest.get(group.joint, (0.0, 0.0))[1] for group in through]
    weak = shared.strength(linkage.solve(np.array(weakest))) < WEAK
    for group, at in compress(zip(through, weakest, strict=True), weak):
        growing = shared.growing_joints(
            linkage.solve(np.array([at - CHANGE_POINT_OFFSET, at + CHANGE_POINT_OFFSET]))
        )
        names = _named(linkage, growing)
        return Undecided(unbounded=names, at=at % (2 * np.pi), links=group.links)
    return Undecided()


def _named(linkage: Linkage, forces: frozenset[str]) -> tuple[str, ...]:
    return tuple(name for name, item in linkage.named_reactions if item.force in forces)


def _turns(linkage: Linkage) -> bool:
    try:
        return linkage.cycle.turns > 0
    except RangeError:
        return False


def _somewhere(linkage: Linkage) -> State:
    """The linkage at some crank angles of no meaning that it can reach."""
    share = (np.arange(ANGLES) + 0.37) / ANGLES
    try:
        return linkage.solve(share * 2 * np.pi * linkage.cycle.turns)
    except RangeError as error:
        low, high = error.ranges[0]
        return run(linkage.motion, linkage.start(low + share * (high - low)))
