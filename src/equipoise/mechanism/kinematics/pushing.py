"""What a drive that pushes acts on, and where its force is."""

from __future__ import annotations

import numpy as np

from equipoise.mechanism.assembly.steps import Array
from equipoise.mechanism.kinematics.motion import Motion
from equipoise.mechanism.parts.drives import Drive, FurtherDrive
from equipoise.mechanism.parts.machine import Machine, Slider


def slider_of(machine: Machine, drive: Drive | FurtherDrive) -> Slider:
    """The sliding joint that is driven."""
    return next(slider for slider in machine.sliders if slider.name == drive.slider)


def ends_of(machine: Machine, drive: Drive | FurtherDrive) -> tuple[str, str]:
    """The bodies that a drive pushes apart."""
    if drive.slider:
        slider = slider_of(machine, drive)
        return slider.on, slider.link
    return drive.ends(machine.bodies)


def pushes(motion: Motion, drive: Drive | FurtherDrive) -> list[tuple[str, Array, Array]]:
    """Bodies that a force of 1 N of a drive acts on, with its place (N,) and direction (N,)."""
    machine = motion.machine
    if drive.slider:
        slider = slider_of(machine, drive)
        at = motion.points[slider.point].place
        turn = motion.state[f"u({slider.on})"] * np.exp(1j * slider.direction)
        return [(slider.link, at, turn + 0 * at), (slider.on, at, -turn + 0 * at)]
    a, b = (motion.points[name].place for name in drive.between or ())
    way = (b - a) / np.abs(b - a)
    ends = drive.ends(machine.bodies)
    return [(ends[1], b, way), (ends[0], a, -way)]
