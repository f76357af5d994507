"""Physics of a machine that torques set in motion: its equation of motion, and energy."""

from __future__ import annotations

import numpy as np
import pytest

import equipoise as eq
from equipoise.running.equation import CrankEquation
from support.analyses import Subject, subject_of

KINDS = ("crank_rocker", "slider_crank", "stephenson", "watt", "quick_return", "scotch_yoke")
SUBJECTS = [f"{kind}:{seed}" for kind in KINDS for seed in range(2)]
SUBJECTS += ["crank_rocker in soil:0", "crank_rocker long:0", "watt-six-bar", "class-three"]
SUBJECTS += ["cam-pusher", "knife-drive", "rotary-transplanter", "four-stroke-engine"]
THETA = np.random.default_rng(7).uniform(-20.0, 40.0, 40)

every_subject = pytest.mark.parametrize("name", SUBJECTS)


def subject(name: str) -> Subject:
    return subject_of(name)


def _terms(equation: CrankEquation, q: float, speed: float, acceleration: float) -> list[float]:
    inertia, slope, torques = equation.at(q, speed)
    return [inertia * acceleration, slope * speed**2 / 2, -sum(torques)]


@every_subject
@pytest.mark.parametrize(("speed", "acceleration"), [(3.0, 0.0), (-2.0, 25.0), (40.0, -900.0)])
def test_the_equation_gives_the_torque_that_joint_forces_give(
    name: str, speed: float, acceleration: float
) -> None:
    """Inverse dynamics by the pass over all joints is the second route."""
    equation = CrankEquation(eq.Machine.with_rows(subject(name).machine, ()))
    motion = eq.move(equation.machine, THETA, speed, acceleration)
    wanted = eq.forces(motion).drive_torque
    terms = np.array([_terms(equation, q, speed, acceleration) for q in THETA])
    # terms may cancel; a table is as good as its largest value
    size = np.max(np.abs(terms)) + np.max(np.abs(wanted))
    assert np.max(np.abs(terms.sum(axis=1) - wanted)) < 1e-10 * size


@every_subject
def test_the_table_is_the_linkage_itself(name: str) -> None:
    equation = CrankEquation(subject(name).machine)
    inertia, slope = equation.inertia(THETA)
    table = np.array([equation.at(q, 1.0)[:2] for q in THETA])
    assert np.max(np.abs(table[:, 0] - inertia)) < 1e-11 * np.max(inertia)
    assert np.max(np.abs(table[:, 1] - slope)) < 1e-9 * np.max(inertia)
