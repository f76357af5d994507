"""Friction in joints against free bodies that are solved again until friction no longer changes."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

from equipoise.mechanism.assembly.steps import size_of_links
from secondroute.test_free_bodies import FLOOR, pairs
from support import friction_reference
from support.analyses import (
    EXAMPLES,
    Subject,
    agree,
    analysed,
    force_size,
    moment_size,
    subject_of,
    vector,
)
from support.friction_reference import rubbed
from support.machines import KINDS

TOLERANCE = 1e-10
SUBJECTS = [*EXAMPLES, *(f"{kind}:{seed}" for kind in KINDS for seed in range(2))]


@cache
def with_friction(name: str) -> Subject:
    """A machine all of whose pins and sliders rub."""
    plain = subject_of(name)
    machine = plain.machine
    if not plain.forces.joints:
        pytest.skip("it has no joints")
    joints = [joint for joint in plain.forces.joints if joint not in machine.riders]
    rng = np.random.default_rng([*name.encode()])
    force = max(float(np.max(joint.size)) for joint in plain.forces.joints.values())
    return analysed(rubbed(machine, joints, rng, size_of_links(machine), force))


@pytest.mark.parametrize("name", SUBJECTS)
def test_friction_obeys_its_law_with_the_forces_that_it_makes(name: str) -> None:
    subject = with_friction(name)
    machine, poses, forces = subject.machine, subject.poses, subject.forces
    solved, rubbing = friction_reference.solve(machine, poses, pairs(subject))
    force, moment = FLOOR * force_size(machine, poses), FLOOR * moment_size(machine, poses)
    assert {*rubbing} == {*forces.frictions}
    for key, want in rubbing.items():
        got = forces.frictions[key]
        sign = 1.0 if got.on == want.on else -1.0
        assert {got.on, got.by} == {want.on, want.by}
        size = moment if got.is_pin else force
        agree(f"friction in {key}", got.effort, sign * want.effort, TOLERANCE, size)
        agree(f"what presses in {key}", got.pressing, want.pressing, TOLERANCE, force)
    for key, reaction in solved.joints.items():
        got, extra = forces.joints[key], 0.0
        sign = 1.0 if got.on == reaction.on else -1.0
        if key in rubbing and not forces.frictions[key].is_pin:
            slider = next(item for item in machine.sliders if item.name == key)
            along = rubbing[key].effort[:, None] * friction_reference.line(slider, poses)
            extra = along if reaction.on == slider.link else -along
        agree(f"force in {key}", vector(got), sign * (reaction.force + extra), TOLERANCE, force)
    for drive in machine.driven:
        size = force if drive.pushes else moment
        agree(drive.link, forces.drives[drive.link], solved.drives[drive.link], TOLERANCE, size)
