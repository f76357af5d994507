"""What could be done about a crank that cannot turn fully, in lines for the file."""

from __future__ import annotations

from math import acos, degrees, floor, log10, radians

from equipoise.errors import PASTE, ChangePointError, MotionError, RangeError
from equipoise.i18n import Note, to_say
from equipoise.mechanism.assembly.reach import Assembled, Reach, range_of
from equipoise.mechanism.assembly.sides import key_text
from equipoise.mechanism.checks import MODES
from equipoise.mechanism.parts.laws import AngleLaw
from equipoise.mechanism.parts.machine import Machine

SHORT = 0.02
"""Of the range, that a crank stays away from both ends, where forces grow without bound."""
DIGITS = 3
"""Of the range, to which the ends of a swing are rounded."""

WITH_LINES = to_say("{reason}; {cure}{lines}")
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
    if not machine.has_crank:
        return error
    try:
        found = range_of(linkage, error)
    except MotionError:
        return error
    if found.is_point:
        return error
    law = swing_law(machine, found)
    lines = [motion_line(law)]
    cure: Note = SWING_ALONE if machine.drive.motor or machine.drive.flywheel else SWING
    if not isinstance(error, ChangePointError):
        message = Note(WITH_LINES, reason=found.note, cure=cure, lines=_pasted(lines))
        if isinstance(error, RangeError):
            return RangeError(message, error.ranges, reason=found.note)
        return type(error)(message, reason=found.note)
    if error.joint:
        cure = MODE_OR_SWING
        entry = key_text(error.joint)
        given = machine.assembly.get(error.joint, "")
        lines = [
            f'{entry} = "{MODES[0]}"  # in [assembly], instead of "{given}"',
            f'# or {entry} = "{MODES[1]}"',
            f"# or, in [drive]: {lines[0]}",
        ]
    message = Note(WITH_LINES, reason=error.reason, cure=cure, lines=_pasted(lines))
    return ChangePointError(message, error.crank_angle, error.joint, reason=error.reason)


def _pasted(lines: list[str]) -> str:
    return PASTE + "\n".join(lines)


def swing_law(machine: Machine, found: Reach) -> AngleLaw:
    """A sine a little short of what a crank can reach, with ends that a file can hold.

    Where a rough position or starts of couplings say how the machine is at a crank angle, the crank
    is there at that angle as before.
    """
    short = SHORT * (found.high - found.low)
    span = degrees(found.high - found.low)
    digits = max(0, DIGITS - floor(log10(span)))
    low, high = (round(degrees(end), digits) for end in (found.low + short, found.high - short))
    phase = 0.0
    if machine.couplings or machine.position is not None:
        at = 0.0 if machine.position is None else degrees(machine.position.crank_angle)
        if low < at < high:
            level = (low + high - 2 * at) / (high - low)
            phase = at - degrees(acos(level))
    return AngleLaw(between=(radians(low), radians(high)), phase=radians(phase))


def motion_line(law: AngleLaw) -> str:
    """A law that swings, as a key of the drive in a file."""
    assert law.between is not None
    ends = ", ".join(f'"{_clean(end)} deg"' for end in law.between)
    phase = f', phase = "{_clean(law.phase)} deg"' if law.phase else ""
    return f"motion = {{ between = [{ends}]{phase} }}"


def _clean(angle: float) -> str:
    return f"{degrees(angle):.9g}"
