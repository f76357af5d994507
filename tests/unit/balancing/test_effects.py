"""Columns of every output against analyses of machines that are changed.

Outputs are linear in the numbers, so that a change of any size must be met, to 1e-9 of the largest
value.  Gears press along the tangent here: which flank touches is no linear matter.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import equipoise as eq
from equipoise.balancing.effects import ANGLES, Effects
from equipoise.balancing.problem import Problem
from equipoise.errors import UsageError
from equipoise.mechanism.balance import AddedMass, Balance, CenterMove, SpringChoice, Weight
from support.machines import make

EXACT = 1e-9
KINDS = (
    "crank_rocker",
    "slider_crank",
    "geared_counterweight",
    "stephenson",
    "watt",
    "quick_return",
    "geared_five_bar",
)


def subject(kind: str, seed: int) -> Problem:
    """Masses and a centre free on every link, and a spring."""
    machine = make(kind, seed).machine
    gears = tuple(replace(gear, pressure_angle=0.0) for gear in machine.gears)
    machine = replace(machine, gears=gears)
    point, link = next(
        (point, name)
        for name, link in reversed(machine.links.items())
        for point in link.points
        if point not in machine.frame
    )
    to = list(machine.frame)[-1]
    masses = [
        AddedMass(name, list(link.points)[-1], Weight()) for name, link in machine.links.items()
    ]
    heavy = max(machine.links, key=lambda name: machine.links[name].mass or 0.0)
    plan = Balance(
        moves=(CenterMove(heavy),),
        masses=tuple(masses),
        springs=(SpringChoice(link, point, to, 500.0),),
    )
    return Problem.of(machine, plan)


def some_numbers(problem: Problem, seed: int) -> list[np.ndarray]:
    """Every number anywhere that a body can have."""
    rng, found = np.random.default_rng(seed), []
    for part in problem.parts:
        numbers = rng.uniform(0.1, 0.4, part.count)
        if part.count == 4:
            numbers[3] += numbers[1] ** 2 / numbers[0] + numbers[2] ** 2 / numbers[0]
        found.append(part.tightened(numbers, np.ones(part.count, bool)))
    return found


@pytest.mark.parametrize("seed", [3, 8])
@pytest.mark.parametrize("kind", KINDS)
def test_every_output_is_that_of_the_changed_machine(kind: str, seed: int) -> None:
    problem = subject(kind, seed)
    numbers = some_numbers(problem, seed)
    changed = problem.machine_with(numbers)
    assert len(changed.springs) == len(problem.machine.springs) + 1
    forces = eq.forces(eq.move(changed, ANGLES, acceleration=0.0))
    x = np.concatenate(numbers)
    about = list(changed.frame)[-1]
    there = eq.analyze(changed, ANGLES, acceleration=0.0, about=about).forces
    wanted = {
        ("shaking_force", None): forces.shaking_force.value,
        ("shaking_force.x", None): forces.shaking_force.x,
        ("shaking_force.y", None): forces.shaking_force.y,
        ("shaking_moment", None): forces.shaking_moment,
        ("shaking_moment", about): there.shaking_moment,
        ("frame_force", None): forces.frame_force.value,
        ("frame_force.y", None): forces.frame_force.y,
        ("frame_moment", None): forces.frame_moment,
        ("frame_moment", about): there.frame_moment,
        ("drive_torque", None): forces.drive_torque,
        **{(f"joints.{name}", None): joint.value for name, joint in forces.joints.items()},
    }
    for (output, pole), values in wanted.items():
        signal = problem.effects.signal(output, pole)
        assert signal.turns == forces.motion.turns
        error = np.max(np.abs(signal.at(x) - values)) / np.max(np.abs(values))
        assert error < EXACT, (output, pole)


@pytest.mark.parametrize("kind", ["crank_rocker", "stephenson"])
def test_moment_of_weight(kind: str) -> None:
    problem = subject(kind, 2)
    numbers = some_numbers(problem, 2)
    changed = eq.forces(eq.move(problem.machine_with(numbers), ANGLES, acceleration=0.0))
    found = problem.effects.weight_moment(changed.about).at(np.concatenate(numbers))
    scale = np.max(np.abs(changed.weight_moment))
    assert scale > 0
    assert np.max(np.abs(found - changed.weight_moment)) < EXACT * scale


def test_springs_that_are_there_already_load_the_frame() -> None:
    machine = eq.load("spring-balanced-crank")
    assert machine.springs
    forces = eq.forces(eq.move(machine, ANGLES, acceleration=0.0))
    for about in (None, *machine.frame):
        wanted = eq.analyze(machine, ANGLES, acceleration=0.0, about=about).forces.frame_moment
        found = Effects(machine, ()).signal("frame_moment", about).start
        assert np.max(np.abs(found - wanted)) < EXACT * np.max(np.abs(wanted))
    assert np.max(np.abs(forces.springs["rocker"][1])) > 0


def test_another_speed() -> None:
    """Inertia by the square, weight not at all."""
    problem = subject("crank_rocker", 1)
    twice = problem.effects.at(2 * problem.machine.drive.speed)
    for output in ("shaking_force", "shaking_moment"):
        one, other = problem.effects.signal(output), twice.signal(output)
        assert np.allclose(other.start, 4 * one.start, rtol=0, atol=EXACT * np.max(abs(one.start)))
        assert np.allclose(other.columns, 4 * one.columns)
    weight = problem.effects.signal("frame_force").columns
    weight = weight - problem.effects.signal("shaking_force").columns
    again = twice.signal("frame_force").columns - twice.signal("shaking_force").columns
    assert np.max(np.abs(weight)) > 0
    assert np.allclose(
        again, weight, rtol=0, atol=1e-9 * np.max(np.abs(twice.signal("frame_force").columns))
    )


def test_component_of_a_joint() -> None:
    effects = subject("crank_rocker", 1).effects
    name = next(iter(eq.forces(effects.motion).joints))
    whole = effects.signal(f"joints.{name}")
    assert np.array_equal(effects.signal(f"joints.{name}.y").columns, whole.columns.imag)


@pytest.mark.parametrize("output", ["shaking", "joints.Z", "drive_torque.x", "shaking_moment.y"])
def test_what_there_is_not(output: str) -> None:
    with pytest.raises(UsageError):
        subject("crank_rocker", 1).effects.signal(output)
