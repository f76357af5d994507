"""What a machine that is made still lacks: one sentence, with what to do."""

from __future__ import annotations

from equipoise.mechanism.joints import Structure, held_too_often, undetermined
from equipoise.mechanism.model import FRAME
from equipoise.web.sketch import Sketch

BEGIN = "nothing moves yet: draw a link from a point of the frame"
HELD_NOWHERE = "nothing holds the machine: pin a point of it to the frame"


def lacking(sketch: Sketch) -> str:
    """What is missing before a sketch can be computed; empty where nothing is, as far as joints
    and the drive are concerned.
    """
    if not sketch.links:
        return BEGIN
    joints = sketch.joints
    if not any(FRAME in bodies for bodies in joints.pins.values()):
        return HELD_NOWHERE
    mobility, drive = sketch.mobility, sketch.drive
    if mobility > 1:
        return f"{_counted(mobility - 1)} too many: {_loose(sketch, joints)}"
    if mobility < 1:
        held = _all_of(held_too_often(joints, drive.link if drive else ""))
        told = "no free motion" if not mobility else f"{_counted(1 - mobility)} too few"
        return f"{told}: too many joints hold {held}; free one of its points"
    if drive is None:
        return f"no drive: choose the crank, {_cranks(sketch)}"
    return ""


def moves(sketch: Sketch) -> str:
    """What is told of mobility: one free motion is what a machine has."""
    return _counted(sketch.mobility)


def _counted(number: int) -> str:
    return f"{number} free motion{'' if number == 1 else 's'}"


def _loose(sketch: Sketch, joints: Structure) -> str:
    """What moves besides, and what to do about it."""
    drive = sketch.drive.link if sketch.drive else ""
    left = undetermined(joints, drive)
    sliding = {one.point for one in sketch.sliders}
    for link in left:
        ends = [point for point in sketch.links[link].points if point not in joints.pins]
        held = len(sketch.links[link].points) - len(ends)
        held += sum(link in (slider.link, slider.on) for slider in sketch.sliders)
        free = [point for point in ends if point not in sliding]
        if held < 2 and free:
            return f"{free[-1]} of {link} hangs free; pin it to something"
    if not drive and (cranks := _pivoted(sketch)):
        return (
            f"{_all_of(left)} can move freely; choose the crank, such as {cranks[0]}, or add joints"
        )
    return f"{_all_of(left or list(sketch.links))} can move freely; add a link or another joint"


def _pivoted(sketch: Sketch) -> list[str]:
    """Links that could be the crank."""
    return [
        name
        for name, link in sketch.links.items()
        if sum(point in sketch.frame for point in link.points) == 1 and len(link.points) > 1
    ]


def _cranks(sketch: Sketch) -> str:
    cranks = _pivoted(sketch)
    return " or ".join(cranks) if cranks else "a link that is pinned to the frame at one point"


def _all_of(names: tuple[str, ...] | list[str]) -> str:
    names = [name for name in names if name]
    if len(names) < 2:
        return "".join(names) or "the links"
    return f"{', '.join(names[:-1])} and {names[-1]}"
