"""What could be done about a crank that cannot turn fully, in lines for the file."""

from __future__ import annotations

from collections.abc import Sequence
from math import acos, degrees, floor, log10, radians, sin

import numpy as np

from equipoise.dataclass import dataclass
from equipoise.errors import ChangePointError, MotionError, Paste, RangeError, at_place
from equipoise.i18n import Note, to_say
from equipoise.mechanism.assembly.newton import BranchError
from equipoise.mechanism.assembly.reach import Assembled, Reach, has_loops, margins_at, range_of
from equipoise.mechanism.assembly.sides import key_text
from equipoise.mechanism.checks import MODES
from equipoise.mechanism.parts.joint_kinds import BEYOND
from equipoise.mechanism.parts.laws import AngleLaw
from equipoise.mechanism.parts.machine import Machine

TRANSMISSION, LEAST_SHARE = radians(40), 1 / 3
"""Smallest transmission angle of a dyad in a swing, as in Norton, Design of Machinery, 4.10, rad;
and the share of the range that has to be left for that."""
AWAY, SHORT = 0.1, 0.02
"""Of the range, that a crank stays away from both ends where transmission angles leave too little;
and where rough positions or starts of couplings lie in that, too."""
LOOKED_AT = 720
"""Crank angles of the range at which transmission angles are looked at."""
DIGITS = 3
"""Of the range, to which the ends of a swing are rounded."""

WITH_CURE = to_say("{reason}; {cure}")
LEADING = to_say("{sentence}; the motion below {room}")
KEEPS_ANGLES = Note(
    "keeps transmission angles of {least:.4g} deg and more", least=degrees(TRANSMISSION)
)
KEEPS_AWAY = Note("stays a tenth of the range away from both ends, near which forces grow without "
                  "bound")  # fmt: skip
KEEPS_SHORT = Note("stays 2 % of the range away from both ends, near which forces grow without "
                   "bound")  # fmt: skip
SWING = Note("change a length or direction, or let it swing by a motion in [drive]")
SWING_ALONE = Note("change a length or direction, or let it swing by a motion in [drive], without "
                   "motor and flywheel")  # fmt: skip
MODE_OR_SWING = Note(
    "say in [assembly] whether opposite links stay parallel or cross, or let the crank swing by a "
    "motion in [drive]"
)


def with_cures(linkage: Assembled, error: MotionError) -> MotionError:
    """An error that ends a crank's turn, with where the crank stops and lines for the file.

    The error itself where a drive has a motion already, or the crank can be nowhere.
    """
    machine = linkage.machine
    if not machine.has_crank or (isinstance(error, BranchError) and error.rider):
        return _in_its_slot(machine, error)
    try:
        reach = range_of(linkage, error)
    except MotionError:
        return error
    if reach.is_point:
        return error
    swing = swing_within(linkage, reach)
    lines = [motion_line(swing.law)]
    cure: Note = SWING_ALONE if machine.drive.motor or machine.drive.flywheel else SWING
    if not isinstance(error, ChangePointError):
        message = Note(WITH_CURE, reason=reach.note, cure=cure)
        if isinstance(error, RangeError):
            if error.lengths is not None:
                lengths = Note(WITH_CURE, reason=reach.note, cure=error.lengths)
                message = Note(WITH_CURE, reason=lengths, cure=cure)
            stuck: MotionError = RangeError(message, error.ranges, reason=reach.note)
        else:
            stuck = type(error)(message, reason=reach.note)
        return stuck.with_paste(_paste(lines, swing))
    if error.joint:
        cure = MODE_OR_SWING
        entry = key_text(error.joint)
        given = machine.assembly.get(error.joint, "")
        lines = [
            f'{entry} = "{MODES[0]}"  # in [assembly], instead of "{given}"',
            f'# or {entry} = "{MODES[1]}"',
            f"# or, in [drive]: {lines[0]}",
        ]
    message = Note(WITH_CURE, reason=error.reason, cure=cure)
    stuck = ChangePointError(message, error.crank_angle, error.joint, reason=error.reason)
    return stuck.with_paste(_paste(lines, swing))


def _in_its_slot(machine: Machine, error: MotionError) -> MotionError:
    """The error, which names the slot whose end a pin has reached, if that is what it is about."""
    if not isinstance(error, BranchError) or not error.rider:
        return error
    slot = machine.pins_in_slots[error.rider]
    place = next(f"{table}[{k + 1}]" for table, k, item in machine.elements if item is slot)
    return BranchError(at_place(place, Note(BEYOND, crank_angle=degrees(error.crank_angle))))


def _paste(lines: Sequence[str], swing: SwingWithin) -> Paste:
    return Paste(tuple(lines), LEADING, {"room": swing.room})


@dataclass(frozen=True)
class SwingWithin:
    """A motion by which a crank swings within what it can reach.

    law : a sine.  room : what its ends keep.
    """

    law: AngleLaw
    room: Note


def swing_within(linkage: Assembled, reach: Reach) -> SwingWithin:
    """A sine within what a crank can reach, with ends that a file can hold.

    Its ends keep transmission angles that a designer would take, where these leave enough of the
    range.  Where a rough position or starts of couplings say how the machine is at a crank angle,
    the crank is there at that angle as before.
    """
    machine, span = linkage.machine, reach.high - reach.low
    digits = max(0, DIGITS - floor(log10(degrees(span))))
    at = None
    if machine.couplings or machine.position is not None:
        at = 0.0 if machine.position is None else degrees(machine.position.crank_angle)
    choices = [(reach.low + share * span, reach.high - share * span, room)
               for share, room in ((AWAY, KEEPS_AWAY), (SHORT, KEEPS_SHORT))]  # fmt: skip
    if (good := _well_transmitted(linkage, *choices[0][:2])) is not None:
        choices.insert(0, (*good, KEEPS_ANGLES))
    ends = [(round(degrees(low), digits), round(degrees(high), digits), room)
            for low, high, room in choices]  # fmt: skip
    holding = (end for end in ends if at is not None and end[0] < at < end[1])
    low, high, room = next(holding, ends[0])
    phase = 0.0
    if at is not None and low < at < high:
        phase = at - degrees(acos((low + high - 2 * at) / (high - low)))
    return SwingWithin(AngleLaw(between=(radians(low), radians(high)), phase=radians(phase)), room)


def _well_transmitted(linkage: Assembled, low: float, high: float) -> tuple[float, float] | None:
    """The longest part of a range, rad, in which all transmission angles are large enough; None
    where it is too short, or groups of loops have none.
    """
    if has_loops(linkage):
        return None
    theta = np.linspace(low, high, LOOKED_AT + 1)
    good = np.all([margin >= sin(TRANSMISSION) ** 2 for margin in margins_at(linkage, theta)],
                  axis=0)  # fmt: skip
    edges = np.flatnonzero(
        np.diff(np.concatenate([[False], np.broadcast_to(good, theta.shape), [False]]))
    )
    begins, ends = edges[::2], edges[1::2] - 1
    if not len(begins):
        return None
    k = int(np.argmax(ends - begins))
    if theta[ends[k]] - theta[begins[k]] < LEAST_SHARE * (high - low):
        return None
    return float(theta[begins[k]]), float(theta[ends[k]])


def motion_line(law: AngleLaw) -> str:
    """A law that swings, as a key of the drive in a file."""
    assert law.between is not None
    ends = ", ".join(f'"{_clean(end)} deg"' for end in law.between)
    phase = f', phase = "{_clean(law.phase)} deg"' if law.phase else ""
    return f"motion = {{ between = [{ends}]{phase} }}"


def _clean(angle: float) -> str:
    return f"{degrees(angle):.9g}"
