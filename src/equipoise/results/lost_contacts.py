"""Where, and from which speed, followers of cams lift off: a sentence each."""

from __future__ import annotations

from math import pi

from equipoise.i18n import Note, all_of
from equipoise.mechanism.dynamics.cam_contacts import LetGo, let_go
from equipoise.mechanism.dynamics.forces import Forces, forces, massless
from equipoise.mechanism.kinematics.motion import move
from equipoise.mechanism.outputs.declared import body_named
from equipoise.mechanism.parts.machine import Machine
from equipoise.quantities import PER_RPM, angle, told


def lost_told(let_go: LetGo, sprung: bool) -> Note:
    """Where nothing keeps a cam's follower there, at the speed analysed.

    sprung : whether the file has springs at all, which may then be too weak.
    """
    ranges = [
        Note("at every crank angle")
        if b - a >= 2 * pi
        else Note("at crank angles from {low} to {high}", low=angle(a), high=angle(b))
        for a, b in let_go.ranges
    ]
    return Note(
        "{follower} lifts off {cam} {ranges}, where it would have to be held by up to {force}; "
        "{limit}",
        follower=let_go.cam.driven,
        cam=body_named(let_go.cam.driver),
        ranges=all_of(ranges),
        force=told(-let_go.least[0], "force"),
        limit=_limit(let_go.speed, sprung),
    )


def _limit(speed: float, sprung: bool) -> Note:
    if speed == 0 and sprung:
        return Note("its springs are too weak even at rest")
    if speed == 0:
        return Note("no [[springs]] press on it")
    rpm = speed / PER_RPM
    if sprung:
        return Note("its springs hold it up to {speed:.4g} rpm", speed=rpm)
    return Note("without [[springs]] it stays there up to {speed:.4g} rpm", speed=rpm)


def where_lost(machine: Machine) -> tuple[Note, ...]:
    """Where springs do not keep followers on their cams, at the file's speed."""
    if not machine.cams or massless(machine):
        return ()
    return lost_contacts(forces(move(machine)))


def lost_contacts(forces: Forces) -> tuple[Note, ...]:
    """Where springs do not keep followers on their cams, at the speed analysed."""
    sprung = any(forces.motion.machine.force_elements)
    return tuple(lost_told(item, sprung) for item in let_go(forces) if item.ranges)
