"""Forces in all joints against the equilibria of all free bodies, solved at once."""

from __future__ import annotations

from typing import Any

import numpy as np

from equipoise.mechanism.dynamics.parameters import regressor, values_across
from equipoise.mechanism.parts.machine import FRAME
from support import free_bodies, machines_planes
from support.analyses import (
    Subject,
    agree,
    every_apart,
    every_subject,
    force_size,
    moment_size,
    subject_of,
    vector,
)
from support.conformance import compared
from support.free_bodies import FreeBodies, Reaction
from support.poses import pins
from support.sources import FREE_BODIES

TOLERANCE = 1e-10
FLOOR = 1e-3
"""Part of the size of all forces below which an output counts as vanishing."""


def pairs(subject: Subject) -> dict[str, tuple[str, str]]:
    """Read which body holds which at the points of more than two bodies.

    The frame, or else the body whose motion is found first, holds the others, except that a gear
    on the axis of its carrier may be held by the carrier.
    """
    actual: dict[str, tuple[str, str]] = {}
    for label, bodies in pins(subject.machine).items():
        if len(bodies) < 3:
            continue
        names = [name for name in subject.forces.joints if name.startswith(f"{label}/")]
        joints = {name: subject.forces.joints[name] for name in names}
        assert len(joints) == len(bodies) - 1
        assert all(name == f"{label}/{joint.on}" for name, joint in joints.items())
        assert {body for joint in joints.values() for body in (joint.on, joint.by)} == set(bodies)
        assert FRAME not in {joint.on for joint in joints.values()}
        actual |= {name: (joint.on, joint.by) for name, joint in joints.items()}
    return actual


def same_forces(subject: Subject) -> None:
    """Compare every force and moment with the solution of the free bodies."""
    machine, poses, forces = subject.machine, subject.poses, subject.forces
    pushes = {name: vector(mesh) for name, mesh in forces.gears.items()}
    solved = free_bodies.solve(machine, poses, pairs(subject), pushes)
    force, moment = FLOOR * force_size(machine, poses), FLOOR * moment_size(machine, poses)
    assert set(forces.joints) == set(solved.joints)
    for family in ("gears", "racks"):
        assert set(getattr(forces, family)) == set(getattr(solved, family))
    for name, reaction in solved.joints.items():
        same_reaction(name, forces.joints[name], reaction, force, moment)
    for name, reaction in {**solved.gears, **solved.racks}.items():
        same_reaction(name, forces.solved.contacts[name], reaction, force, moment)
    for name, strands in solved.strands.items():
        belt = forces.belts[name]
        for what, got, want in zip(
            ("left", "right"), (belt.left, belt.right), strands, strict=True
        ):
            agree(f"{what} strand of {name}", got, want, TOLERANCE, force)
    same_totals(forces, solved, force, moment)
    masses = sum(link.mass or 0.0 for link in machine.links.values())
    weight = np.broadcast_to(masses * np.array(machine.gravity), solved.frame_force.shape)
    agree("weight", vector(forces.weight) + 0 * solved.frame_force, weight, TOLERANCE, force)


def same_reaction(name: str, got: Any, want: Reaction, force: float, moment: float) -> None:
    """Compare one contact, whichever of its bodies counts as acted on."""
    assert {got.on, got.by} == {want.on, want.by}
    sign = 1.0 if got.on == want.on else -1.0
    agree(f"force in {name}", vector(got), sign * want.force, TOLERANCE, force)
    if hasattr(got, "moment"):
        agree(f"couple in {name}", got.moment, sign * want.couple, TOLERANCE, moment)


def same_totals(forces: Any, solved: FreeBodies, force: float, moment: float) -> None:
    """Compare what the drives exert and what the frame bears."""
    for drive in forces.motion.machine.driven:
        size, wanted = (force if drive.pushes else moment), solved.drives[drive.link]
        agree(f"drive of {drive.link}", forces.drives[drive.link], wanted, TOLERANCE, size)
    first = forces.motion.machine.drive
    assert getattr(forces, first.effort) is forces.drives[first.link]
    agree("frame force", vector(forces.frame_force), solved.frame_force, TOLERANCE, force)
    agree("frame moment", forces.frame_moment, solved.frame_moment, TOLERANCE, moment)


def acting_on_the_later(subject: Subject) -> None:
    """Check that joints of two bodies give the force on the later one; the frame comes first."""
    order = [FRAME, *subject.machine.links]
    sliders = {slider.name for slider in subject.machine.sliders}
    for name, joint in subject.forces.joints.items():
        assert hasattr(joint, "moment") == (name in sliders)
        if name in sliders or len(pins(subject.machine).get(name, ())) == 2:
            assert order.index(joint.by) < order.index(joint.on), name


@compared(
    FREE_BODIES, "forces and moments in all joints, drive torque, load on the frame", TOLERANCE
)
@every_subject
def test_forces_in_all_joints(name: str) -> None:
    subject = subject_of(name)
    same_forces(subject)
    acting_on_the_later(subject)


# -- links beside each other -----------------------------------------------------------------------


@compared(FREE_BODIES, "rocking moments, tilting moments in joints, forces of bearings", TOLERANCE)
@every_apart
def test_everything_across_the_plane(name: str) -> float:
    """Rocking moments, couples of joints and forces of bearings."""
    subject = subject_of(name)
    machine, poses, across = subject.machine, subject.poses, subject.forces.across
    flat = free_bodies.solve(machine, poses, pairs(subject))
    solved = machines_planes.solve(machine, poses, flat)
    span = max(abs(bearing.plane) for bearing in machine.bearings.values())
    force = FLOOR * force_size(machine, poses)
    moment = force * span
    assert set(across.tilting_moments) == set(solved.couples)
    assert set(across.bearings) == set(solved.bearings) == set(machine.bearings)
    actual = [
        agree("rocking", vector(across.rocking_moment), solved.rocking, TOLERANCE, moment),
        agree("frame", vector(across.frame_rocking_moment), solved.on_frame, TOLERANCE, moment),
    ]
    for key, want in solved.couples.items():
        got = across.tilting_moments[key]
        actual.append(agree(f"couple in {key}", vector(got), want, TOLERANCE, moment))
    for key, want in solved.bearings.items():
        actual.append(agree(key, vector(across.bearings[key]), want, TOLERANCE, force))
    return max(actual)


@every_apart
def test_parts_across_the_plane(name: str) -> None:
    """Splits by link are what each link alone does; parameters and what acts give the whole."""
    subject = subject_of(name)
    machine, poses, forces = subject.machine, subject.poses, subject.forces
    span = max(abs(bearing.plane) for bearing in machine.bearings.values())
    force = FLOOR * force_size(machine, poses)
    split, parameters = forces.split, regressor(forces.motion)
    inertial = split.across.rocking_moment.value[:2].sum(axis=0)
    own = dict(
        zip(
            machine.links,
            zip(inertial, split.across.frame_rocking_moment.value[2], strict=True),
            strict=True,
        )
    )
    for link in machine.links:
        wants = machines_planes.rocking_of(machine, poses, link)
        for value, want in zip(own[link], wants, strict=True):
            agree(link, np.column_stack([value.real, value.imag]), want, TOLERANCE, force * span)
    whole, acting = values_across(machine), slice(3, None)

    def reported_forces(across: Any) -> dict[str, Any]:
        actual = {"rocking": across.rocking_moment, "frame": across.frame_rocking_moment}
        return actual | {**across.tilting_moments} | {**across.bearings}

    causes, columns = reported_forces(split.across), reported_forces(parameters.across)
    for key, item in reported_forces(forces.across).items():
        got = whole @ columns[key].value + causes[key].value[acting].sum(axis=(0, 1))
        size = force if key in machine.bearings else force * span
        assert np.max(np.abs(got - item.value)) <= TOLERANCE * max(
            np.max(np.abs(item.value)), size
        ), key
