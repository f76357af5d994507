"""From a machine to its steps: the drive first, then whatever the known bodies determine next.

Links are taken in the smallest groups that can be solved: a coupled link, a dyad, and only where
neither fits a group for Newton's method.  Each group becomes steps for motion and, in reverse
order, steps for forces.

This ends, whatever the file: a round of `_grouped` takes at least one link out of those that are
unknown, and reads only what earlier rounds have solved.  Where sides are missing, each combination
of at most `sides.MOST_TRIED` of them is grouped once more, by `_grouped` and `_linked` alone;
neither checks sides, so that nothing that is tried tries anything itself.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from copy import copy
from dataclasses import field, replace
from functools import partial
from typing import Any

import numpy as np

from equipoise.dataclass import dataclass, remembered
from equipoise.displays import Brief
from equipoise.errors import ChangePointError, ModelError, RangeError
from equipoise.i18n import Note, series
from equipoise.keys.kinds import choice
from equipoise.mechanism.assembly import assembly_modes
from equipoise.mechanism.assembly.assembly_modes import surplus_cranks
from equipoise.mechanism.assembly.builder import Builder, Group
from equipoise.mechanism.assembly.cycle import Cycle, close, weakest
from equipoise.mechanism.assembly.groups import has_two_known_pins, hung, next_group
from equipoise.mechanism.assembly.joints import (
    Structure,
    drive_pivot,
    given_properties,
    name_in_outputs,
    pin_radii,
    structure,
)
from equipoise.mechanism.assembly.loops import BranchError
from equipoise.mechanism.assembly.reach import with_cures
from equipoise.mechanism.assembly.redundant_reactions import RedundantReactions, shared
from equipoise.mechanism.assembly.steps import (
    Reaction,
    State,
    Step,
    initial_state,
    needed_references,
    pin_reaction,
    run,
    selects_flank,
)
from equipoise.mechanism.checks import MODE, MODES, meant
from equipoise.mechanism.parts.machine import FRAME, LINKAGE, Machine

NO_PARALLELS = Note(
    "no two links of this linkage close a four-bar of equal opposite sides with known ones, so "
    "there are no change points to pass; leave it out"
)
TWICE = Note(
    "the inner joints of two dyads are both called {name!r}, so that one entry would be of both; "
    "rename the point, or give the guide another label"
)
DECIDED = Note(
    "the joint forces of this linkage are statically determinate; leave the stiffness out"
)
NOTHING: Mapping[str, Any] = {}


@dataclass(frozen=True, repr=False)
class Linkage(Brief):
    """A machine in the order in which it is computed.

    pivot : the drive link's point in the frame.
    anchors : body -> point about which its moments are taken.
    groups : what is solved after the drive, in order.
    reference_cycle : of a machine that differs by little; loops are followed sooner from there.
    shared : all joints at once, where forces do not follow group by group.
    memory : what was computed of it elsewhere and takes time, by name, such as its cycle.
    """

    machine: Machine
    joints: Structure
    pivot: str
    anchors: Mapping[str, str]
    groups: tuple[Group, ...]
    reference_cycle: Cycle | None = None
    shared: RedundantReactions | None = None
    memory: dict[str, Any] = field(default_factory=dict, init=False, repr=False, compare=False)

    @remembered
    def grounded(self) -> tuple[str, ...]:
        """Driven links that turn about points of the frame."""
        hung = {link for group in self.groups if group.kind == "hung" for link in group.links}
        return tuple(item.link for item in self.machine.driven if item.link not in hung)

    @remembered
    def motion(self) -> tuple[Step, ...]:
        """Steps from the drive's rotation to that of every link."""
        return tuple(step for group in self.groups for step in group.motion)

    @remembered
    def needed_references(self) -> list[str]:
        return needed_references(self.motion)

    @remembered
    def forces(self) -> tuple[Step, ...]:
        """Steps from what each link needs to every joint force; the drive link comes last."""
        if self.shared is not None:
            decided = self.shared.decided
            return (*(step for group in decided for step in group.forces), self.shared)
        return tuple(step for group in reversed(self.groups) for step in group.forces)

    @remembered
    def forces_on_flanks(self) -> tuple[Step, ...]:
        """Force steps without those that select the loaded flanks, or strands."""
        return tuple(step for step in self.forces if not selects_flank(step))

    @remembered
    def reactions(self) -> tuple[Reaction, ...]:
        """Every joint, the pins of the drives first."""
        if self.shared is not None:
            decided = self.shared.decided
            return (
                *self.shared.reactions,
                *(reaction for group in decided for reaction in group.reactions),
            )
        drives = (pin_reaction(self.anchors[link], link, FRAME) for link in self.grounded)
        return (*drives, *(reaction for group in self.groups for reaction in group.reactions))

    @remembered
    def named_reactions(self) -> tuple[tuple[str, Reaction], ...]:
        """Joints by their names in outputs."""
        return tuple(
            (name_in_outputs(self.joints, reaction), reaction)
            for reaction in self.reactions
            if not self.joints.hides(reaction.name, reaction.on, reaction.by)
        )

    @remembered
    def pin_radii(self) -> Mapping[str, float]:
        """Radii of pins that the file gives, by point, m."""
        return pin_radii(self.joints, self.machine.joints)

    @remembered
    def cycle(self) -> Cycle:
        """The closed motion.

        Raises
        ------
        RangeError, ChangePointError, MotionError : the crank cannot turn fully, or the motion does
            not repeat; of a crank, the sentence says where it stops and what could be done.
        """
        try:
            return self.close()
        except (RangeError, ChangePointError, BranchError) as error:
            error.explain = partial(with_cures, self, copy(error))
            raise

    def close(self) -> Cycle:
        """The closed motion, which is kept; its errors say only where the turn ends."""
        if "cycle" not in self.memory:
            check = None if self.shared is None else self.shared.check
            self.memory["cycle"] = close(self.machine, self.groups, self.reference_cycle, check)
        cycle: Cycle = self.memory["cycle"]
        return cycle

    @remembered
    def weakest(self) -> Mapping[str, tuple[float, float]]:
        """Inner joint of a dyad -> smallest squared sine of its transmission angle over a cycle,
        and the crank angle of it, rad.

        Raises
        ------
        RangeError, ChangePointError, MotionError : as of `cycle`.
        """
        return weakest(self.machine, self.groups, self.cycle)

    def of(self, machine: Machine) -> Linkage:
        """Linkage of a machine that differs in nothing but masses, speed or gravity."""
        same = replace(self, machine=machine)
        same.memory.update(self.memory)
        return same

    def start(self, theta: np.ndarray) -> State:
        """State in which only the frame and the driven links are known."""
        return initial_state(self.machine, theta)

    def solve(self, theta: np.ndarray) -> State:
        """State with every link known at the crank angles theta (N,), rad."""
        state = self.start(theta)
        cycle = self.cycle
        for name in self.needed_references:
            state[f"reference({name})"] = cycle.reference(name, theta)
        return run(self.motion, state)


def assemble(machine: Machine, guess: Cycle | None = None) -> Linkage:
    """Order the links of a machine into steps.  The result is kept with the machine.

    guess : motion of a machine of the same build that differs by little, if one is known.

    Raises
    ------
    MobilityError : the free motions are none, or two and more.
    ModelError : an assembly side is missing or idle, two pins coincide, a property is given of
        what is no such joint.
    """
    linkage: Linkage | None = machine.memory.get(LINKAGE)
    if linkage is None:
        linkage = replace(ordered(machine, structure(machine)), reference_cycle=guess)
        names = [name for name, _ in linkage.named_reactions]
        for name in names:
            if names.count(name) > 1:  # outputs go by the names of joints
                raise ModelError(
                    "links",
                    Note(
                        "two joints would be called {name!r} in the output; rename one, or give "
                        "a second guide a label",
                        name=name,
                    ),
                )
        decided = not (linkage.shared and linkage.shared.count)
        slots = machine.pins_in_slots
        for where, joint, item in given_properties(machine, linkage.joints, linkage.reactions):
            slot = slots.get(joint.name)
            if item.radius and slot and (wrong := slot.too_sharp(item.radius)):
                raise ModelError(f"{where}.radius", wrong)
            if decided and item.stiffness is not None:
                raise ModelError(f"{where}.stiffness", DECIDED)
        machine.memory[LINKAGE] = linkage
    return linkage


def ordered(
    machine: Machine,
    joints: Structure,
    start: Mapping[str, Any] = NOTHING,
) -> Linkage:
    """Order the links into steps, whose numbers are columns where those of the machine are.

    start : references at crank angle 0, so that running angles begin in the same turn as those.

    Raises
    ------
    MobilityError, ModelError : as of `assemble`.
    """
    grouping = _grouped(machine, joints, start or {})
    _check_sides(machine, joints, grouping)
    return _linked(machine, joints, grouping)


def _linked(machine: Machine, joints: Structure, grouping: Grouping) -> Linkage:
    builder = grouping.builder
    pivot, order = builder.anchors[FRAME], keyed(grouping.groups)
    whole = shared(builder, joints, pivot, order)
    return Linkage(machine, joints, pivot, builder.anchors, order, shared=whole)


def _check_sides(machine: Machine, joints: Structure, grouping: Grouping) -> None:
    """Raise a `ModelError` for sides that the file leaves out, and for entries of no dyad."""
    builder, groups, choices = grouping.builder, grouping.groups, grouping.choices
    held_kinds = ("pointed", "loops") if joints.surplus else ("pointed",)
    held_at = {point for group in groups if group.kind in held_kinds
               for link in group.links for point in machine.assembled_points(link)}  # fmt: skip
    sided = builder.sides | held_at  # of links that more joints hold lengths decide the side
    idle = [joint for joint in machine.assembly if joint not in sided]
    if choices:

        def turns_fully(tried: Mapping[str, str]) -> None:  # never by `ordered`, which asks again
            _linked(machine, joints, _grouped(machine, joints, tried=tried)).close()

        if decided := assembly_modes.decided(choices, turns_fully):
            choices = _grouped(machine, joints, assumed=decided).choices
        raise assembly_modes.missing(machine, choices, idle)
    for joint in idle:
        if joint == MODE and machine.assembly[joint] in MODES:
            raise ModelError(f"assembly.{joint}", NO_PARALLELS)
        dyads = series(sorted(builder.sides - {MODE})) or Note("no point")
        meeting = Note("the dyads of this linkage meet at {dyads}", dyads=dyads)
        hint = meant(joint, [*builder.sides]) or meeting
        raise ModelError(
            f"assembly.{joint}",
            Note(
                "no dyad has its inner joint there that could be assembled on two sides; {hint}",
                hint=hint,
            ),
        )


def keyed(groups: Sequence[Group]) -> tuple[Group, ...]:
    """Groups, of which each dyad has a key of its own in the table of sides and in outputs: its
    inner pin; the point of its inner sliding joint; or, where several dyads have that point, the
    name of that joint.

    Raises
    ------
    ModelError : a pin and a sliding joint are called the same.
    """
    dyads = [group.joint for group in groups if group.kind == "dyad"]
    for name, count in Counter(dyads).items():
        if count > 1:
            raise ModelError("assembly", Note(TWICE, name=name))
    points = Counter(group.point for group in groups)
    return tuple(
        replace(group, joint=group.point) if group.point and points[group.point] == 1 else group
        for group in groups
    )


def sides_at_position(machine: Machine, turning: Any = None) -> dict[str, str]:
    """The side of each dyad that has two, as the machine's rough position has it; what its table
    of sides says is left aside.

    turning : of `Machine`, the source of the angles of pushed links; that of their strokes
        depends on sides.

    Raises
    ------
    MobilityError, ModelError : as of `assemble`.
    """
    bare = replace(machine, assembly={})
    if turning is not None:
        bare = bare.with_turning(turning)
    joints = structure(bare)
    choices = _grouped(bare, joints).choices
    return {choice.group.joint: choice.words[choice.side] for choice in choices}


@dataclass(frozen=True)
class Grouping:
    """What the drives determine, group by group.

    choices : the sides that the file leaves out.
    """

    builder: Builder
    groups: tuple[Group, ...]
    choices: tuple[Any, ...]


def _grouped(
    machine: Machine,
    joints: Structure,
    start: Mapping[str, Any] = NOTHING,
    assumed: Mapping[str, tuple[int, Note | None]] = NOTHING,
    tried: Mapping[str, str] = NOTHING,
) -> Grouping:
    """What the drives determine.

    start : as of `ordered`.
    assumed : of joints, which of two sides to take where the file leaves it out, and why.
    tried : of joints, the side to take, whatever the file has.
    """
    mode = machine.assembly.get(MODE)
    named = {
        *joints.pins,
        *(name for slider in machine.sliders for name in (slider.name, slider.point)),
    }
    if mode not in (None, *MODES) and MODE not in named:  # else it is the side of that joint
        note = Note("got {leaf!r}; give {choice}", leaf=mode, choice=choice(MODES))
        raise ModelError(f"assembly.{MODE}", note)
    if mode not in MODES:
        mode = MODES[0] if joints.surplus else None
    drives = {machine.drive.link: drive_pivot(joints, machine.drive.link)}
    pushed = []
    for number, drive in enumerate(machine.drives, 1):
        if drive.pushes and not joints.pins_between(FRAME, drive.link):
            pushed.append(drive.link)
        else:
            drives[drive.link] = drive_pivot(joints, drive.link, f"drives[{number}].link")
    points, running = set(machine.frame), {FRAME, *drives}
    builder = Builder(machine, points=points, running=running, given_state=dict(start), mode=mode,
                      tried=tried)  # fmt: skip
    surplus: frozenset[str] = frozenset()
    if joints.surplus:
        surplus, joints = surplus_cranks(machine, joints), joints.needed
    builder.add({FRAME: drives[machine.drive.link], **drives})
    unknown = [link for link in (*machine.links, *joints.riders) if link not in drives]
    groups: list[Group] = []
    choices: list[assembly_modes.Choice] = []
    while unknown:
        try:
            ready = [
                link
                for link in unknown
                if link not in pushed
                and (link not in surplus or has_two_known_pins(builder, joints, link))
            ]
            waiting = [link for link in pushed if link in unknown]
            group = hung(builder, joints, waiting) or next_group(builder, joints, ready)
        except ModelError:
            if choices:  # sides come first: on a wrong one what hangs on it cannot be right
                raise assembly_modes.missing(machine, _with_keys(choices, groups)) from None
            raise
        if group.joint in builder.missing:
            choices.append(assembly_modes.chosen(builder, group, assumed))
            group = choices[-1].group
        group = builder.anchored(group, joints)
        groups.append(group)
        builder.motion += group.motion
        unknown = [link for link in unknown if link not in group.links]
    return Grouping(builder, tuple(groups), _with_keys(choices, groups))


def _with_keys(choices: Sequence[Any], groups: Sequence[Group]) -> tuple[Any, ...]:
    """Choices of sides whose groups have their final keys."""
    final = dict(zip((group.links for group in groups), keyed(groups), strict=True))
    return tuple(replace(choice, group=final[choice.group.links]) for choice in choices)
