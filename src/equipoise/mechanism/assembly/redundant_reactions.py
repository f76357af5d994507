"""Forces that statics alone does not decide: all joints of a machine at once, by a stated rule.

Where joints hold links more often than they need be held, the free bodies have fewer equations than
unknowns.  Of all joint forces that hold the machine in balance, those are taken whose squares sum
up to the least, or, where the file gives joints a stiffness, that store the least energy in them.
The same free bodies serve a linkage that goes on through change points.  Links that hang on those,
and that statics decides, are left to their own steps, which hand on what their joints ask for.

Drive torque, and force and moment on the frame as a whole, follow from the demands alone.

Along which line teeth push depends on the sign of their push, and where joints share, how large
the push is depends on all these lines.  From the flanks that pushes without any slant ask for,
flanks are changed until all push the way they lie.  Teeth that push back on either flank bear
least where they bear nothing: they are idle there.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import cached_property
from math import degrees
from typing import Any

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.decompositions import singular_values, svd
from equipoise.errors import MobilityError, ModelError
from equipoise.i18n import Note, all_of, to_say
from equipoise.mechanism.assembly.builder import Builder, Group
from equipoise.mechanism.assembly.joints import (
    Structure,
    given_properties,
    name_in_outputs,
    no_motion,
)
from equipoise.mechanism.assembly.loopgroup import LoopForces, Maker
from equipoise.mechanism.assembly.loops import (
    CouplingLoop,
    LoopEquation,
    LoopGroup,
    Poses,
    poses_in,
)
from equipoise.mechanism.assembly.steps import (
    Reaction,
    State,
    demand_names,
    planar,
    resultant,
    running_angle,
)
from equipoise.mechanism.formulas import kernels
from equipoise.mechanism.parts.joint_properties import family_of
from equipoise.mechanism.parts.machine import FRAME, Machine
from equipoise.signals import Array

ROUNDED = 1e-11
"""Share of a singular value in the largest that rounding explains."""
CLEAR = 1e-8
"""The same of rows that clearly do not depend on each other."""
APART = 1e5
"""By how much, at most, products of rows let errors grow."""
ENTRIES_AT_ONCE = 2**20
"""Entries of matrices that are worked on at a time: what is in between takes several times that."""
STEPS_AT_ONCE = 3
"""Steps in which all flanks that do not agree are changed; after them one of each crank angle."""
NO_SIGN = 1e-12
"""Share of the largest push up to which one has no sign."""
AGREES = 1e-9
"""Misfit, in sizes of the machine or radians, that rounding of lengths explains."""

FIXED = to_say(
    "{second} of {link!r} comes {misfit:.4g} mm beside its pin, at crank angle {angle:.4g} deg; "
    "its points {first} and {second} are {given:.7g} mm apart, and {low:.7g} mm would fit"
)
MOVING = to_say(
    "{second} of {link!r} comes {misfit:.4g} mm beside its pin, at crank angle {angle:.4g} deg; "
    "its points {first} and {second} are {given:.7g} mm apart, and the others bring the pins "
    "{low:.7g} to {high:.7g} mm apart as the crank turns"
)
MISPLACED = to_say(
    "{name!r} of {link!r} is {misfit:.4g} mm beside where it should be at crank angle "
    "{angle:.4g} deg; give lengths that agree, or leave it out"
)
AHEAD = to_say(
    "{name!r} turns {link!r} {misfit:.4g} deg beside where other joints turn it at crank angle "
    "{angle:.4g} deg; give ratios that agree, or leave it out"
)
AT_START = to_say(
    "{name!r} starts {link!r} at {given:.6g} deg, where other joints have it at {found:.6g} deg; "
    "give it that start"
)
OPEN = 1e-9
"""Share of a joint in forces that hold each other, up to which it has none."""
WEAK = 1e-6
"""Smallest over largest stiffness against motion, up to which joints do not hold the machine."""
CHANGE_POINT_OFFSET = 1e-3
"""rad: how far from a change point it is looked at which forces grow without bound there."""
IDLE = "flank({}) idle"
"""Where teeth bear nothing on either flank (N,), in the state."""

SHARE = to_say(
    "{links} have one degree of freedom together, so the distribution of the torque among their "
    "drives is indeterminate; drive one of them"
)
LINED_UP = Note("parallel linkages can pass their change points with one drive only")


def min_norm(matrix: Array, right: Array) -> Array:
    """Least solutions (N, m, k) of equations (N, n, m) with right sides (N, n, k)."""
    values = np.empty((matrix.shape[0], matrix.shape[2], right.shape[2]))
    for some in in_blocks(matrix):
        values[some] = _least_by_products(matrix[some], right[some])
    return values


def in_blocks(matrix: Array) -> Iterator[slice]:
    """Slices of a stack of matrices (N, n, m), of as many as are worked on at a time."""
    step = max(1, ENTRIES_AT_ONCE // max(1, matrix[:1].size))
    return (slice(begin, begin + step) for begin in range(0, len(matrix), step))


def _least_by_products(matrix: Array, right: Array) -> Array:
    """By the products of rows, and by the rows themselves where products lose digits."""
    across = np.swapaxes(matrix, -1, -2)
    products = matrix @ across
    probe = np.cos(np.arange(matrix.shape[1]))  # of no meaning: shows how much errors can grow
    probe = np.broadcast_to(probe[:, None], (*matrix.shape[:2], 1))
    try:
        text = np.linalg.solve(products, np.concatenate([right, probe], axis=-1))
    except np.linalg.LinAlgError:
        return _least_by_rows(matrix, right)
    values = np.asarray(across @ text[..., :-1])
    sizes = np.max(np.abs(text[..., -1]), axis=-1) * np.trace(products, axis1=1, axis2=2)
    if not np.all(apart := sizes < APART):
        values[~apart] = _least_by_rows(matrix[~apart], right[~apart])
    return values


def _least_by_rows(matrix: Array, right: Array) -> Array:
    """By QR, and by singular values where rows nearly depend on each other."""
    across, triangle = np.linalg.qr(np.swapaxes(matrix, -1, -2))
    sizes = np.abs(np.diagonal(triangle, axis1=-2, axis2=-1))
    clear = np.min(sizes, axis=-1) > CLEAR * np.max(sizes, axis=-1)
    triangle[~clear] = np.eye(triangle.shape[-1])
    value = across @ np.linalg.solve(np.swapaxes(triangle, -1, -2), right)
    if not np.all(clear):
        value[~clear] = parts_of(matrix[~clear])[0] @ right[~clear]
    return np.asarray(value)


def parts_of(matrix: Array) -> tuple[Array, Array]:
    """Least-squares inverse of matrices (N, n, m), and unknowns (N, m, k) that they make nothing
    of.
    """
    left, sizes, right = svd(matrix, full_matrices=True)
    rank = sizes.shape[-1]
    significant = sizes > ROUNDED * sizes[:, :1]
    over = np.where(significant, 1 / np.where(significant, sizes, 1.0), 0.0)
    right = np.swapaxes(right, -1, -2)
    return right[..., :rank] * over[:, None] @ np.swapaxes(left, -1, -2), right[..., rank:]


def flank_iteration(pushes: Callable[[Array, Array], Array], senses: Array) -> tuple[Array, Array]:
    """Senses (G, N) that agree with the pushes that follow, and which of these are idle (G, N).

    pushes : those (G, N) of given senses, of which some are idle.  senses : to begin with.
    """
    idle = np.zeros(senses.shape, bool)
    changed = np.zeros(senses.shape, bool)
    for step in range(STEPS_AT_ONCE + len(senses) * (len(senses) + 2)):
        result = pushes(senses, idle)
        wrong = np.where(idle, 0.0, -result * senses)
        against = wrong > NO_SIGN * np.max(np.abs(result), initial=0.0)
        if not np.any(against):
            break
        if step >= STEPS_AT_ONCE:
            worst = np.arange(len(senses))[:, None] == np.argmax(wrong, axis=0)
            against &= worst
            given_up = against & changed
            idle |= given_up
            changed = (changed | against) & ~np.any(given_up, axis=0)
        senses = np.where(against, -senses, senses)
    return senses, idle


@dataclass(frozen=True)
class FitCondition:
    """What has to fit.

    loops : all joints.  groups : how the motion is solved.  size : of the machine, m.
    starts : of couplings by name, where the file has them start, rad or m; 0 if left out.
    """

    loops: tuple[LoopEquation, ...]
    groups: tuple[Group, ...]
    size: float
    starts: Mapping[str, float]

    def misfit(self, state: State, poses: Poses) -> Note | str:
        """Say which joint does not fit, and by how much; nothing where all do.

        state, poses : over the whole cycle.
        """
        theta, size = state["theta"], self.size
        poses = {body: replace(pose, angle=state.get(f"phi({body})", running_angle(state, body)))
                 for body, pose in poses.items()}  # fmt: skip
        misfits = [np.broadcast_to(gap(loop, poses, size), np.shape(theta)) for loop in self.loops]
        worst, at = np.unravel_index(np.argmax(misfits), np.shape(misfits))
        if misfits[worst][at] <= AGREES * size:
            return next(self.off_at_start(poses), "")
        sentence = too_short(self.groups, state, size)
        return sentence or _misfit_note(self.loops[worst], misfits[worst], theta, at, size)

    def off_at_start(self, poses: Poses) -> Iterator[Note]:
        """Say of couplings that start a link at another angle than other joints have it."""
        for loop in self.loops:
            if isinstance(loop, CouplingLoop) and not loop.slides:
                given, value = self.starts[loop.name], float(np.ravel(poses[loop.on.body].angle)[0])
                if given and abs(np.exp(1j * (given - value)) - 1) > AGREES:
                    yield Note(AT_START, name=loop.name, link=loop.on.body, given=degrees(given),
                               found=degrees(np.angle(np.exp(1j * value))))  # fmt: skip


def gap(loop: LoopEquation, poses: Poses, size: float) -> Any:
    """By how much a joint does not fit, m; an angle counts at the size of the machine."""
    if isinstance(loop, CouplingLoop):
        (value,) = loop.gaps(poses, 0)
        ahead = np.abs(value - np.ravel(value)[0])
        return ahead if loop.slides else ahead * size
    first, second = loop.gaps(poses, 0)
    if loop.turns:
        first = first * size
    return np.hypot(first, second)


def _misfit_note(loop: LoopEquation, misfit: Array, theta: Array, at: Any, size: float) -> Note:
    turned = isinstance(loop, CouplingLoop) and not loop.slides
    apart = degrees(misfit[at] / size) if turned else misfit[at] * 1e3
    template = AHEAD if turned else MISPLACED
    return Note(template, name=loop.name, link=loop.on.body, misfit=apart, angle=degrees(theta[at]))


def too_short(groups: Sequence[Group], state: State, size: float) -> Note | str:
    """Say of the link that two pins hold which distance of them is needed."""
    result = []
    for group in groups:
        if group.kind != "pointed":
            continue
        call: Any = group.motion[-1]
        first, second = call.inputs[0], call.inputs[3]
        needed = np.abs(state[second] - state[first]) + 0 * state["theta"]
        off = np.abs(needed - abs(call.parameters[0]))
        at = int(np.argmax(off))
        result.append((off[at], at, group.links[0], first[2:-1], second[2:-1], needed, call))
    if not result or (worst := max(result, key=lambda item: item[0]))[0] <= AGREES * size:
        return ""
    off, at, link, first, second, needed, call = worst
    low, high = float(np.min(needed)), float(np.max(needed))
    same = high - low <= AGREES * size
    template = FIXED if same else MOVING
    return Note(template, link=link, first=first, second=second,
                misfit=off * 1e3, angle=degrees(state["theta"][at]), low=low * 1e3,
                high=high * 1e3, given=abs(call.parameters[0]) * 1e3)  # fmt: skip


@dataclass(frozen=True)
class RedundantReactions(LoopForces):
    """The free bodies of links whose joints share what statics leaves open.

    group : these links and their joints.  pivot : of the first drive.
    drives : driven links.
    count : says that the joints hold too much; empty where they do not.
    names : joints as outputs call them, each with the name of its force.
    compliance : of each joint, m/N, by name of its force; empty where none is given.
    fit : what has to fit.  decided : groups whose forces are found before, by their own steps.
    """

    pivot: str
    drives: tuple[str, ...]
    count: Note | str
    names: Mapping[str, str]
    compliance: Mapping[str, float]
    fit: FitCondition
    decided: tuple[Group, ...]

    def run(self, state: State) -> None:
        force, moment = self.demanded(state)
        by_work = sum(
            kernels.drive_torque(state[f"p1({anchor})"], state[f"w({link})"],
                                 state[f"F({link})"], state[f"M({link})"])
            for link, anchor in zip(self.group.links, self.group.anchors, strict=True)
        )  # fmt: skip
        super().run(state)
        alone = len(self.drives) == 1
        turns_evenly = np.ndim(state[f"w({self.drives[0]})"]) == 0  # else it may do no work
        for drive, pin in self.pins.items():
            torque = by_work if alone and turns_evenly else state[f"torque({drive})"]
            own = state[pin.force]
            state[f"F({drive})"], state[f"M({drive})"] = own, torque
            if pin.by == FRAME:
                lever = state[f"p({pin.at})"] - state[f"p({self.pivot})"]
                force, moment = force - own, moment - torque - kernels.cross(lever, own)
        state[f"F({FRAME})"] = state[f"F({FRAME})"] + force
        state[f"M({FRAME})"] = state[f"M({FRAME})"] + moment

    def put(
        self, state: State, poses: Poses, senses: Sequence[Any], strengths: Sequence[Sequence[Any]]
    ) -> None:
        super().put(state, poses, senses, strengths)
        for loop, reaction in zip(self.loops, self.reactions, strict=True):
            state.setdefault(f"p({reaction.at})", loop.place(poses))

    @property
    def pins(self) -> dict[str, Reaction]:
        """The pin about which each driven link turns, by the link."""
        anchors = dict(zip(self.group.links, self.group.anchors, strict=True))
        pins = {
            (reaction.on, reaction.at): reaction
            for reaction in self.reactions
            if reaction.kind == "pin"
        }
        return {drive: pins[drive, anchors[drive]] for drive in self.drives}

    def demanded(self, state: State) -> tuple[Any, Any]:
        """Force and moment about the pivot that these links together need."""
        links = zip(self.group.links, self.group.anchors, strict=True)
        names = ((f"p({anchor})", *demand_names(link)) for link, anchor in links)
        demands = ((state[p], state[f], state[m]) for p, f, m in names)
        return resultant(demands, state[f"p({self.pivot})"])

    def poses(self, state: State) -> Poses:
        group = self.group
        return poses_in(state, (*group.known, *zip(group.links, group.anchors, strict=True)))

    def senses(self, state: State, poses: Poses) -> list[Any]:
        """Senses of pushes, with those that agree with each other once they are shared."""
        pairs = [(k, loop.name) for k, loop in enumerate(self.loops) if loop.switches]
        known = all(f"flank({name})" in state for _, name in pairs)
        senses = super().senses(state, poses)
        if known or not self.count:
            return senses

        def pushes(flanks: Array, idle: Array) -> Array:
            for (k, name), flank, off in zip(pairs, flanks, idle, strict=True):
                state[f"flank({name})"] = senses[k] = flank
                state[IDLE.format(name)] = off
            result = self.solve(state, poses, senses)
            return np.array([result[k][0] for k, _ in pairs])

        flank_iteration(pushes, np.array([senses[k] for k, _ in pairs]))
        return senses

    def idle(self, state: State) -> Array:
        """Unknowns that bear nothing (N, m): pushes of idle teeth."""
        none = np.zeros(np.shape(state["theta"]), bool)
        parts = [state.get(IDLE.format(loop.name), none)
                 for loop in self.loops for _ in range(loop.unknowns)]  # fmt: skip
        return np.stack([*parts, *[none] * len(self.drives)], axis=-1)

    def solve(self, state: State, poses: Poses, senses: Sequence[Any]) -> list[list[Array]]:
        matrix = self.balance(state, poses, senses)
        idle = self.idle(state)
        matrix *= ~idle[:, None]
        demand = self.demand(state) / self.rows
        right = np.moveaxis(demand.reshape(-1, *demand.shape[-2:]), 0, -1)
        if self.compliance:
            values = np.concatenate(
                [
                    self.by_stiffness(*parts_of(matrix[some]), idle[some]) @ right[some]
                    for some in in_blocks(matrix)
                ]
            )
        else:
            values = min_norm(matrix, right)
        values *= ~idle[..., None]  # of rounding
        values *= self.units[:, None]
        result = np.moveaxis(values, (-1, 1), (1, 0)).reshape(len(self.units), *demand.shape[:-1])
        count = len(self.drives)
        state.update((f"torque({drive})", item)
                     for drive, item in zip(self.drives, result[-count:], strict=True))  # fmt: skip
        strengths = iter(result)
        return [[next(strengths) for _ in range(loop.unknowns)] for loop in self.loops]

    @cached_property
    def rows(self) -> Array:
        """Units (3 n,) of the equations: moments are counted as forces at the largest distance of
        two joints on one body.
        """
        return np.tile([1.0, 1.0, self.group.size], len(self.group.links))

    @cached_property
    def units(self) -> Array:
        """Units (m,) of the unknowns, of which the last are the torques of the drives."""
        couples = [loop.turns and part == 0 for loop in self.loops for part in range(loop.unknowns)]
        return np.where([*couples, *[True] * len(self.drives)], self.group.size, 1.0)

    @cached_property
    def softness(self) -> Array:
        """Compliance (m,) of the unknowns, m/N; 0 of those that have none."""
        owners = zip(self.loops, self.reactions, strict=True)
        values = [self.compliance.get(reaction.force, 0.0)
                  for loop, reaction in owners for _ in range(loop.unknowns)]  # fmt: skip
        return np.array([*values, *[0.0] * len(self.drives)])

    def columns(self, poses: Poses, senses: Sequence[Any]) -> list[dict[int, Any]]:
        places = [3 * self.group.links.index(drive) + 2 for drive in self.drives]
        return [*super().columns(poses, senses), *({place: 1.0} for place in places)]

    def balance(self, state: State, poses: Poses, senses: Sequence[Any]) -> Array:
        """Equations (N, 3 n, m) of all free bodies without dimension."""
        matrix = self.matrix(state, poses, senses)
        matrix *= self.units / self.rows[:, None]
        return matrix

    def check(self, state: State) -> None:
        """Raise an error where a joint that is not needed for the motion does not fit, or where
        stiffness leaves forces open.
        """
        if not self.count:
            return
        if misfit := self.fit.misfit(state, self.poses(state)):
            raise MobilityError(Note("{count}: {reason}", count=self.count, reason=misfit))
        if len(self.drives) > 1:
            self.check_drives(state)
        if self.compliance:
            self.check_stiffness(state)

    def check_drives(self, state: State) -> None:
        """Raise a `ModelError` where the torques of several drives are statically indeterminate."""
        _, loose = parts_of(self.unsensed(state))
        share = np.max(np.abs(loose), axis=(0, -1), initial=0.0)[-len(self.drives) :]
        if np.any(share > OPEN):
            ones = zip(self.drives, share > OPEN, strict=True)
            names = [repr(link) for link, is_open in ones if is_open]
            raise ModelError("drives", Note(SHARE, links=all_of(names)))
        if np.min(self.strength(state)) < WEAK:
            raise ModelError("drives", LINED_UP)

    def check_stiffness(self, state: State) -> None:
        """Raise a `ModelError` where the stiffness of joints leaves forces open."""
        _, loose = parts_of(self.unsensed(state))
        _, energy = self.energy(loose)
        sizes, ways = np.linalg.eigh(energy)
        if np.any(sizes[..., 0] < AGREES * max(self.compliance.values())):
            left = np.max(np.abs(loose @ ways[..., :1]), axis=(0, -1))
            rigid = self.those(left > OPEN).difference(self.compliance)
            names = [name for name, force in self.names.items() if force in rigid]
            raise ModelError(
                "joints",
                Note(
                    "with the given stiffness the forces in {names} remain indeterminate; give "
                    "the stiffness of one of these, or of no joint at all",
                    names=all_of(names, commas=True),
                ),
            )

    def by_stiffness(self, inverse: Array, loose: Array, idle: Array) -> Array:
        """Of solutions that differ by `loose` forces (N, m, k), the one of least energy, in which
        those that are `idle` (N, m) vanish.
        """
        weighed, energy = self.energy(loose, idle)
        return np.asarray(inverse - loose @ np.linalg.solve(energy, weighed @ inverse))

    def energy(self, loose: Array, idle: Any = False) -> tuple[Array, Array]:
        """What unknowns (N, k, m), and loose forces themselves (N, k, k), store with loose ones."""
        soft = np.where(idle, np.max(self.softness), self.softness)
        weighed = np.swapaxes(loose * soft[..., None], -1, -2)
        return weighed, weighed @ loose

    # -- what statics decides ----------------------------------------------------------------------

    def open_joints(self, state: State) -> frozenset[str]:
        """Names of forces that statics leaves open at some crank angle."""
        _, loose = parts_of(self.unsensed(state))
        if not loose.shape[-1]:
            return frozenset()
        share = np.max(np.abs(loose), axis=(0, -1))
        return self.those(share > OPEN)

    def strength(self, state: State) -> Array:
        """How well the joints hold the machine (N,): 0 where a force in them has no bound."""
        sizes = singular_values(self.unsensed(state))
        return np.asarray(sizes[:, -1] / sizes[:, 0])

    def growing_joints(self, state: State) -> frozenset[str]:
        """Names of forces that grow without bound towards where the joints do not hold it."""
        _, _, unknowns = svd(self.unsensed(state), full_matrices=False)
        return self.those(np.max(np.abs(unknowns[:, -1]), axis=0) > CHANGE_POINT_OFFSET)

    def unsensed(self, state: State) -> Array:
        """The equations, for whatever flanks of couplings."""
        return self.balance(state, self.poses(state), [0.0] * len(self.loops))

    def those(self, flags_by_unknown: Array) -> frozenset[str]:
        """Names of forces by flags of the unknowns."""
        flags = iter(flags_by_unknown)
        owners = [
            (reaction.force, [next(flags) for _ in range(loop.unknowns)])
            for loop, reaction in zip(self.loops, self.reactions, strict=True)
        ]
        return frozenset(force for force, some in owners if any(some))


def _span_of_joints(machine: Machine, joints: Structure, apart: set[str]) -> float:
    """Largest distance of two joints on one body, m, among bodies that are not `apart`.

    A guide counts where its link slides; the point of its line that the file names says nothing of
    its size, and counts only where nothing else does.  1 where all joints of each body coincide.
    """
    ends = [(body, point) for point, bodies in joints.pins.items() for body in bodies]
    ends += [(slider.link, slider.point) for slider in joints.sliders]
    through = [(slider.on, slider.through) for slider in joints.sliders]

    def span(named: list[tuple[str, str]]) -> float:
        places: dict[str, list[complex]] = {}
        for body, point in named:
            if body not in apart:
                places.setdefault(body, []).append(planar(machine.assembled_points(body)[point]))
        return max((abs(a - b) for own in places.values() for a in own for b in own), default=0.0)

    return span(ends) or span(ends + through) or 1.0


def shared(
    builder: Builder, joints: Structure, pivot: str, groups: tuple[Group, ...]
) -> RedundantReactions | None:
    """The free bodies of a machine whose forces do not follow group by group; else None."""
    count = no_motion(joints) if joints.surplus else ""
    if not count and not any(group.through for group in groups):
        return None
    if builder.machine.drives and not count:
        raise ModelError("drives", LINED_UP)
    decided = _decided(builder, joints, groups)
    apart = {link for group in decided for link in group.links}
    links = tuple(body for body in builder.rank if body not in (FRAME, *apart))
    maker = Maker(builder, joints, links)
    maker.anchors = {link: builder.anchors[link] for link in links}
    loops = [loop for loop in maker.pinned_and_sliding()
             if apart.isdisjoint((loop.on.body, loop.by.body))]  # fmt: skip
    loops += [maker.coupling(coupling) for coupling in joints.couplings if coupling.driven in links]
    loops.sort(key=lambda loop: (loop.name, loop.on.body) != (pivot, links[0]))
    anchors = tuple(maker.anchors.values())
    size = _span_of_joints(builder.machine, joints, apart)
    whole = LoopGroup(links, anchors, ((FRAME, pivot),), (), tuple(loops), (), size)
    reactions = tuple(loop.reaction() for loop in loops)
    every = (*reactions, *(reaction for group in decided for reaction in group.reactions))
    named = {family_of(item.kind) + name_in_outputs(joints, item): item.force for item in every}
    given = given_properties(builder.machine, joints, every)
    compliance = {
        joint.force: 1 / item.stiffness for _, joint, item in given if item.stiffness is not None
    }
    starts = {coupling.name: coupling.start for coupling in joints.couplings}
    fit = FitCondition(whole.equations, groups, size, starts)
    drives = tuple(drive.link for drive in builder.machine.driven if drive.link in links)
    return RedundantReactions(
        whole, whole.equations, reactions, pivot, drives, count, named, compliance, fit, decided
    )


def _decided(builder: Builder, joints: Structure, groups: tuple[Group, ...]) -> tuple[Group, ...]:
    """Groups on which none of the others hangs, and which no joint more holds than they need."""
    left, result = set(builder.rank), []
    for group in reversed(groups):
        others = left.difference(group.links)
        own = group.kind != "pointed" and not group.through
        if own and joints.freedom(group.links, others) == 0:
            result.append(group)
            left = others
    return tuple(result)
