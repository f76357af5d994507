"""Machines that are pushed, against Newton's method, free bodies and a power balance."""

from __future__ import annotations

import numpy as np
import pytest

import equipoise as eq
from equipoise.mechanism.parts.machine import FRAME
from laws.subjects import gravity_power, kinetic_power, load_power, spring_power
from laws.subjects import same as alike
from secondroute.test_free_bodies import acting_on_the_later, same_forces
from secondroute.test_motion import same_motion
from support import newton
from support.analyses import ANGLES, Subject
from support.machines_strokes import SLIDING, TOGETHER, TURNING, stroked, together
from support.poses import from_motion

SUBJECTS = [(kind, False) for kind in (*TURNING, *TOGETHER)] + [(kind, True) for kind in SLIDING]
each = pytest.mark.parametrize(("kind", "by_slider"), SUBJECTS)
SEEDS = (0, 1)


def subject_of(kind: str, seed: int, by_slider: bool) -> Subject:
    case = together(kind, seed) if kind in TOGETHER else stroked(kind, seed, by_slider)
    analysis = eq.analyze(case.machine, angles=ANGLES)
    return Subject(case.machine, analysis.motion, analysis, case)


def turned_alike(machine: eq.Machine, q: np.ndarray) -> np.ndarray:
    """Coordinates in whose angles no whole turns lie between the bodies of a sliding joint."""
    place = {name: 3 * k + 2 for k, name in enumerate(machine.links)}
    for slider in machine.sliders * len(machine.sliders):
        base = 0.0 if slider.on == FRAME else q[place[slider.on]]
        gap = base + slider.direction + slider.angle - q[place[slider.link]]
        q[place[slider.link]] += 2 * np.pi * np.round(gap / (2 * np.pi))
    return q


@pytest.mark.exhaustive(
    but=[
        "0-arm-False",
        "0-slider_on_rocker-False",
        "0-torsion_slider_on_rocker-True",
        "0-belted_five_bar-False",
        "0-swinging_block-True",
        "0-sun_and_planet-False",
    ]
)
@each
@pytest.mark.parametrize("seed", SEEDS)
def test_motion_forces_and_power(kind: str, seed: int, by_slider: bool) -> None:
    """Only the branch at crank angle 0 is taken from the motion itself."""
    subject = subject_of(kind, seed, by_slider)
    first = from_motion(subject.machine, eq.move(subject.machine, [0.0]))
    same_motion(subject, turned_alike(subject.machine, newton.coordinates(first, 0)))
    same_forces(subject)
    acting_on_the_later(subject)
    forces = subject.forces
    rows = [*kinetic_power(forces), *-gravity_power(forces), *-load_power(forces)]
    rows = [*rows, *-spring_power(forces)]
    size = np.max(np.sum(np.abs(rows), axis=0) + np.abs(forces.power))
    alike(forces.power, np.sum(rows, axis=0), 1e-12, float(size))
    assert np.any(forces.drive_torque) != subject.machine.drive.pushes
