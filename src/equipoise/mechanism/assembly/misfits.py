"""Whether joints fit that the motion does not need: what others make of the links decides it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from math import degrees
from typing import Any

import numpy as np

from equipoise.i18n import Note, to_say
from equipoise.mechanism.assembly.builder import Group
from equipoise.mechanism.assembly.loops import CouplingLoop, Loop, Poses
from equipoise.mechanism.assembly.steps import Array, State, running_angle

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
BESIDE = to_say(
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


@dataclass(frozen=True)
class Fit:
    """What has to fit.

    loops : all joints.  groups : how the motion is solved.  size : of the machine, m.
    starts : of couplings by name, where the file has them start, rad or m; 0 if left out.
    """

    loops: tuple[Loop, ...]
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
        misfits = [np.broadcast_to(gap(one, poses, size), np.shape(theta)) for one in self.loops]
        worst, at = np.unravel_index(np.argmax(misfits), np.shape(misfits))
        if misfits[worst][at] <= AGREES * size:
            return next(self.off_at_start(poses), "")
        told = too_short(self.groups, state, size)
        return told or _beside(self.loops[worst], misfits[worst], theta, at, size)

    def off_at_start(self, poses: Poses) -> Iterator[Note]:
        """Say of couplings that start a link at another angle than other joints have it."""
        for loop in self.loops:
            if isinstance(loop, CouplingLoop) and not loop.slides:
                given, found = self.starts[loop.name], float(np.ravel(poses[loop.on.body].angle)[0])
                if given and abs(np.exp(1j * (given - found)) - 1) > AGREES:
                    yield Note(AT_START, name=loop.name, link=loop.on.body, given=degrees(given),
                               found=degrees(np.angle(np.exp(1j * found))))  # fmt: skip


def gap(loop: Loop, poses: Poses, size: float) -> Any:
    """By how much a joint does not fit, m; an angle counts at the size of the machine."""
    if isinstance(loop, CouplingLoop):
        (value,) = loop.gaps(poses, 0)
        ahead = np.abs(value - np.ravel(value)[0])
        return ahead if loop.slides else ahead * size
    first, second = loop.gaps(poses, 0)
    if loop.turns:
        first = first * size
    return np.hypot(first, second)


def _beside(loop: Loop, misfit: Array, theta: Array, at: Any, size: float) -> Note:
    turned = isinstance(loop, CouplingLoop) and not loop.slides
    apart = degrees(misfit[at] / size) if turned else misfit[at] * 1e3
    template = AHEAD if turned else BESIDE
    return Note(template, name=loop.name, link=loop.on.body, misfit=apart, angle=degrees(theta[at]))


def too_short(groups: Sequence[Group], state: State, size: float) -> Note | str:
    """Say of the link that two pins hold which distance of them is needed."""
    found = []
    for group in groups:
        if group.kind != "pointed":
            continue
        call: Any = group.motion[-1]
        first, second = call.inputs[0], call.inputs[3]
        needed = np.abs(state[second] - state[first]) + 0 * state["theta"]
        off = np.abs(needed - abs(call.parameters[0]))
        at = int(np.argmax(off))
        found.append((off[at], at, group.links[0], first[2:-1], second[2:-1], needed, call))
    if not found or (worst := max(found, key=lambda one: one[0]))[0] <= AGREES * size:
        return ""
    off, at, link, first, second, needed, call = worst
    low, high = float(np.min(needed)), float(np.max(needed))
    same = high - low <= AGREES * size
    template = FIXED if same else MOVING
    return Note(template, link=link, first=first, second=second,
                misfit=off * 1e3, angle=degrees(state["theta"][at]), low=low * 1e3,
                high=high * 1e3, given=abs(call.parameters[0]) * 1e3)  # fmt: skip
