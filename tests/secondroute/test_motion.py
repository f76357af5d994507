"""Motion of random machines against Newton's method on all constraints at once."""

from __future__ import annotations

import numpy as np
import pytest

import equipoise as eq
from support import newton
from support.analyses import EXAMPLES, RANDOM, Subject, agree, subject_of
from support.chosen import model_of
from support.conformance import compared
from support.machines import make
from support.poses import Array, Poses, from_motion
from support.sources import NEWTON

TOLERANCE = 1e-10
GEARED = ["geared_coupler", "sun_and_planet", "geared_five_bar", "planetary_arm"]


def same_motion(subject: Subject, start: Array) -> None:
    """Compare links and points of a motion with the same machine followed by Newton's method."""
    traced = newton.trace(subject.machine, subject.motion.crank_angle, start)
    if subject.case is not None:
        assert subject.case.as_wanted(traced)
    same_links(subject, traced)
    for name, link in subject.machine.links.items():
        for label, local in link.points.items():
            same_point(subject, traced, name, label, local)


def same_links(subject: Subject, traced: Poses) -> None:
    """Compare angles, up to full turns, and their derivatives."""
    speed = abs(subject.machine.drive.speed)
    for name in subject.machine.links:
        link = subject.motion.links[name]
        turned = np.exp(1j * (link.angle - traced.angle[name]))
        agree(f"angle of {name}", turned, np.ones_like(turned), TOLERANCE)
        agree(f"angular velocity of {name}", link.angular_velocity, traced.omega[name],
              TOLERANCE, 0.01 * speed)  # fmt: skip
        agree(f"angular acceleration of {name}", link.angular_acceleration, traced.alpha[name],
              TOLERANCE, 0.01 * speed**2)  # fmt: skip


def same_point(
    subject: Subject, traced: Poses, name: str, label: str, local: tuple[float, float]
) -> None:
    """Compare position, velocity and acceleration of a point of a link."""
    point = subject.motion.points[label]
    size, speed = newton.reach(subject.machine), abs(subject.machine.drive.speed)
    pairs = [
        ("position", (point.x, point.y), traced.place(name, local), 1.0),
        ("velocity", (point.vx, point.vy), traced.speed(name, local), speed),
        ("acceleration", (point.ax, point.ay), traced.change(name, local), speed**2),
    ]
    for what, got, want, rate in pairs:
        agree(f"{what} of {label} on {name}", np.column_stack(got), want, TOLERANCE,
              0.01 * size * rate)  # fmt: skip


@compared(NEWTON, "motion of all links and points", TOLERANCE)
@pytest.mark.parametrize("name", RANDOM)
def test_random_machine(name: str) -> None:
    subject = subject_of(name)
    assert subject.case is not None
    same_motion(subject, subject.case.start())


@pytest.mark.exhaustive(but=["sun_and_planet", "planetary_arm"])
@pytest.mark.parametrize("kind", GEARED)
def test_gears_over_several_turns(kind: str) -> None:
    """After one turn geared links are elsewhere; `start` holds at crank angle 0 only."""
    case = make(kind, 1)
    motion = eq.analyze(case.machine, angles=np.linspace(0.3, 20, 24)).motion
    same_motion(Subject(case.machine, motion, None, case), case.start())


@compared(NEWTON, "motion of all links and points", TOLERANCE)
@pytest.mark.parametrize("name", [name for name in EXAMPLES if not model_of(name).cams])
def test_example(name: str) -> None:
    """Only the branch at crank angle 0 is taken from the motion itself."""
    subject = subject_of(name)
    first = from_motion(subject.machine, eq.analyze(subject.machine, angles=np.zeros(1)).motion)
    same_motion(subject, newton.coordinates(first, 0))
