"""Springs between links and frame: what is refused, their force, and what it is linear in."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import equipoise as eq
from equipoise.errors import ModelError, UsageError
from equipoise.mechanism.applied import spring_force
from equipoise.mechanism.assessment import remarks
from equipoise.mechanism.parameters import spring_columns
from support.machines import make
from unit.mechanism.build import ORIGIN, crank_rocker

FRAME = {"A": ORIGIN, "D": (1.0, 0.0), "S": (0.4, 2.5)}
FOUR = replace(crank_rocker(), frame=FRAME)
SPRING = eq.Spring("coupler", "C", "S", 300.0, 0.7)
THETA = np.linspace(0.1, 6.2, 9)


def sprung(**changes: Any) -> eq.Machine:
    return FOUR.with_springs([replace(SPRING, **changes)])


# -- what is refused -------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("changes", "where", "words"),
    [
        ({"link": "couple"}, ".link", "no link is called 'couple'; did you mean 'coupler'?"),
        ({"point": "X"}, ".point", "no point of coupler is called 'X'; there are 'B', 'C'"),
        ({"to": "B"}, ".to", "no point of the frame is called 'B'; there are 'A', 'D', 'S'"),
        ({"link": "rocker", "point": "D"}, ".point",
         "'D' is pinned to the frame, where a spring does nothing; give a point that moves"),
        ({"stiffness": 0.0}, ".stiffness", "got 0 N/m; give more than 0"),
        ({"stiffness": -3.0}, ".stiffness", "got -3 N/m; give more than 0"),
        ({"stiffness": np.inf}, ".stiffness", "got inf; give a finite number"),
        ({"free_length": -0.1}, ".free_length",
         "got -0.1 m; a length cannot be negative, give 0 or more"),
        ({"free_length": np.nan}, ".free_length", "got nan; give a finite number"),
    ],
)  # fmt: skip
def test_bad_springs(changes: dict[str, Any], where: str, words: str) -> None:
    with pytest.raises(ModelError) as caught:
        sprung(**changes)
    assert str(caught.value) == f"springs[1]{where}: {words}"


def test_at_most_200() -> None:
    assert len(FOUR.with_springs([SPRING] * 200).springs) == 200
    with pytest.raises(ModelError, match="springs: got 201; at most 200 are computed with"):
        FOUR.with_springs([SPRING] * 201)


def test_springs_leave_the_motion_as_it_is() -> None:
    """Nothing is solved again, and the frame's point is in use."""
    linkage = eq.mechanism.assemble(FOUR)
    assert eq.mechanism.assemble(sprung()).groups is linkage.groups
    assert list(remarks(linkage)) == ["frame.points.S is not used by any joint or spring"]
    assert not list(remarks(eq.mechanism.assemble(sprung())))


# -- force -----------------------------------------------------------------------------------------


def test_force_towards_the_frame() -> None:
    machine = sprung()
    motion = eq.move(machine, THETA)
    force = spring_force(motion, machine.springs[0])
    along = complex(*FRAME["S"]) - motion.points["C"].place
    np.testing.assert_allclose(np.abs(force), 300 * np.abs(np.abs(along) - 0.7), rtol=1e-13)
    np.testing.assert_allclose(np.angle(force), np.angle(along), rtol=1e-13)


def test_a_spring_shorter_than_its_free_length_pushes() -> None:
    machine = sprung(free_length=9.0)
    motion = eq.move(machine, THETA)
    along = complex(*FRAME["S"]) - motion.points["C"].place
    pull = (spring_force(motion, machine.springs[0]) / along).real
    assert np.all(pull < 0)


def lone_crank(free_length: float) -> eq.Machine:
    """A crank whose end passes the hook at 90 deg."""
    return eq.Machine(
        "crank",
        eq.Drive("crank", 10.0),
        {"A": ORIGIN, "S": (0.0, 0.3)},
        {"crank": eq.Link({"A": ORIGIN, "B": (0.3, 0.0)}, 1.0, ORIGIN, 1.0)},
        springs=(eq.Spring("crank", "B", "S", 50.0, free_length),),
        gravity=ORIGIN,
    )


def test_ends_that_meet() -> None:
    sentence = (
        "springs: 'B' of 'crank' meets 'S' at crank angle 90 deg, where a spring with a free "
        "length points nowhere; give another point, or a free_length of 0"
    )
    with pytest.raises(ModelError) as caught:
        eq.analyze(lone_crank(0.1), 360)
    assert str(caught.value) == sentence
    found = eq.analyze(lone_crank(0.0), 360).forces
    assert found.drive_torque[90] == pytest.approx(0, abs=1e-14)
    with pytest.raises(ModelError, match="meets 'S' at crank angle 90 deg"):
        spring_columns(found.motion, "crank", "B", "S")


def test_torque_of_a_spring_on_a_crank() -> None:
    """k a c sin: a spring without a free length from a crank to a hook at c above its pivot."""
    found = eq.analyze(lone_crank(0.0), THETA).forces
    np.testing.assert_allclose(found.drive_torque, -50 * 0.3 * 0.3 * np.cos(THETA), atol=1e-14)
    force = 50 * (0.3j - 0.3 * np.exp(1j * THETA))
    np.testing.assert_allclose(found.joints["A"].value, -force, atol=1e-13)
    np.testing.assert_allclose(found.frame_force.value, 0, atol=1e-13)
    np.testing.assert_allclose(found.frame_moment, 0, atol=1e-13)


# -- columns ---------------------------------------------------------------------------------------


@pytest.mark.parametrize("kind", ["crank_rocker", "stephenson", "quick_return", "geared_coupler"])
def test_outputs_are_linear_in_stiffness_and_pull(kind: str) -> None:
    """Gears aside, whose flanks the whole load chooses: with it in place, they are too."""
    machine = make(kind, 3).machine
    machine = replace(machine, frame={**machine.frame, "far": (90.0, 40.0)}, springs=())
    link = list(machine.links)[-1]
    point = next(p for p in machine.links[link].points if p not in machine.frame)
    bare = eq.analyze(machine, THETA).forces
    spring = eq.Spring(link, point, "far", 0.4, 70.0)
    with_it = machine.with_springs([spring])
    found = eq.analyze(with_it, THETA).forces
    torque, joints = spring_columns(found.motion, link, point, "far")
    assert torque.shape == (2, len(THETA))
    factors = np.array([0.4, -0.4 * 70.0])
    size = float(np.max(np.abs(found.drive_torque)))
    np.testing.assert_allclose(bare.drive_torque + factors @ torque, found.drive_torque,
                               rtol=0, atol=1e-12 * size)  # fmt: skip
    if machine.gears:
        split = {name: found.split.by_cause(f"joints.{name}")["spring"] for name in found.joints}
    else:
        split = {name: joint.value - bare.joints[name].value
                 for name, joint in found.joints.items()}  # fmt: skip
    size = max(float(np.max(joint.size)) for joint in found.joints.values())
    assert joints.keys() == split.keys()
    for name, column in joints.items():
        assert column.shape == (2, len(THETA))
        np.testing.assert_allclose(factors @ column, split[name], rtol=0, atol=1e-11 * size)


def test_columns_need_no_masses() -> None:
    bare = replace(FOUR, links={name: eq.Link(link.points) for name, link in FOUR.links.items()})
    torque, _ = spring_columns(eq.move(bare, THETA), "coupler", "C", "S")
    wanted, _ = spring_columns(eq.move(FOUR, THETA), "coupler", "C", "S")
    np.testing.assert_array_equal(torque, wanted)


@pytest.mark.parametrize(
    ("ends", "words"),
    [
        (("couple", "C", "S"), "no link is called 'couple'"),
        (("coupler", "X", "S"), "no point of coupler is called 'X'"),
        (("coupler", "C", "B"), "no point of the frame is called 'B'"),
    ],
)
def test_columns_of_unknown_ends(ends: tuple[str, str, str], words: str) -> None:
    with pytest.raises(UsageError, match=words):
        spring_columns(eq.move(FOUR, THETA), *ends)
