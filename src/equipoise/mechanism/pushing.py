"""What a drive that pushes acts on: the length that it commands, and where its force is."""

from __future__ import annotations

import numpy as np

from equipoise.mechanism import kernels
from equipoise.mechanism.drives import Drive
from equipoise.mechanism.model import Machine, Slider
from equipoise.mechanism.motion import Motion
from equipoise.mechanism.steps import Array

Levels = tuple[Array, Array, Array]


def lengths(motion: Motion, drive: Drive | None = None) -> Levels:
    """Length between the points that a drive pushes apart, or travel of its sliding joint, m, and
    both derivatives by crank angle, each (N,).

    drive : that of the machine if not given.
    """
    drive = drive or motion.machine.drive
    if drive.slider:
        slid = motion.slider(slider_of(motion.machine, drive))
        return slid.travel, slid.travel_1, slid.travel_2
    a, b = (motion.point(name) for name in drive.between or ())
    d, d1, d2 = b.place - a.place, b.place_1 - a.place_1, b.place_2 - a.place_2
    length = np.abs(d)
    first = kernels.dot(d, d1) / length
    second = (np.abs(d1) ** 2 + kernels.dot(d, d2) - first**2) / length
    return length, first, second


def slider_of(machine: Machine, drive: Drive) -> Slider:
    """The sliding joint that is driven."""
    return next(one for one in machine.sliders if one.name == drive.slider)


def ends_of(machine: Machine, drive: Drive) -> tuple[str, str]:
    """The bodies that a drive pushes apart."""
    if drive.slider:
        one = slider_of(machine, drive)
        return one.on, one.link
    return drive.ends(machine.bodies)


def pushes(motion: Motion) -> list[tuple[str, Array, Array]]:
    """Bodies that a force of 1 N of the drive acts on, with its place (N,) and direction (N,)."""
    machine, drive = motion.machine, motion.machine.drive
    if drive.slider:
        one = slider_of(machine, drive)
        at = motion.points[one.point].place
        turn = motion.state[f"u({one.on})"] * np.exp(1j * one.direction)
        return [(one.link, at, turn + 0 * at), (one.on, at, -turn + 0 * at)]
    a, b = (motion.points[name].place for name in drive.between or ())
    way = (b - a) / np.abs(b - a)
    ends = drive.ends(machine.bodies)
    return [(ends[1], b, way), (ends[0], a, -way)]
