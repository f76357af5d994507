"""Cams against brute strength: the contact as equations of its own, and all free bodies at once."""

from __future__ import annotations

import numpy as np
import pytest

import equipoise as eq
from secondroute.test_free_bodies import FLOOR, same_reaction, same_totals
from secondroute.test_motion import same_links, same_point
from support import cams, free_bodies
from support.analyses import force_size, moment_size, subject_of
from support.machines_cams import ALL
from support.poses import from_motion

CAMS = [f"{kind}:{seed}" for kind in ALL for seed in range(10)]
CAMS.append("cam-pusher")


@pytest.mark.parametrize("name", CAMS)
def test_motion(name: str) -> None:
    """Only where the machine begins is taken from the motion itself."""
    subject = subject_of(name)
    first = from_motion(subject.machine, eq.analyze(subject.machine, angles=np.zeros(1)).motion)
    traced = cams.trace(subject.machine, subject.motion.crank_angle, first)
    same_links(subject, traced)
    for link, body in subject.machine.links.items():
        for label, local in body.points.items():
            same_point(subject, traced, link, label, local)


@pytest.mark.parametrize("name", CAMS)
def test_forces(name: str) -> None:
    subject = subject_of(name)
    machine, poses, forces = subject.machine, subject.poses, subject.forces
    solved = free_bodies.solve(machine, poses)
    force, moment = FLOOR * force_size(machine, poses), FLOOR * moment_size(machine, poses)
    assert set(forces.joints) == set(solved.joints)
    assert set(forces.cams) == set(solved.cams)
    for key, reaction in solved.joints.items():
        same_reaction(key, forces.joints[key], reaction, force, moment)
    for key, reaction in solved.cams.items():
        same_reaction(key, forces.cams[key], reaction, force, moment)
    same_totals(forces, solved, force, moment)
