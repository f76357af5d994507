"""Positions that other speeds and masses reuse, and demands of inertia, linear in the masses."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import equipoise as eq
from equipoise.mechanism.dynamics.forces import demand_of_inertia, forces, inertia_moved
from equipoise.mechanism.kinematics import motion as motions
from support.machines import KINDS, make
from unit.mechanism.build import crank_rocker, heavy, machine


def lengthened(base: eq.Machine) -> eq.Machine:
    crank = base.links["crank"]
    longer = replace(crank, points={name: (1.1 * x, y) for name, (x, y) in crank.points.items()})
    return replace(base, links={**base.links, "crank": longer})


def test_other_speeds_and_masses_reuse_positions_and_other_lengths_do_not() -> None:
    base = crank_rocker()
    motion = eq.move(base, 24)
    assert eq.move(base, 24, speed=3.0).state is motion.state
    assert eq.move(base.with_link("coupler", mass=2.0), 24).state is motion.state
    assert eq.move(base, 25).state is not motion.state
    other = eq.move(lengthened(base), 24)
    assert np.max(np.abs(other.points["B"].place)) > 1.05 * np.max(np.abs(motion.points["B"].place))


def test_machines_without_groups_do_not_share_positions() -> None:
    """A crank alone, which nothing follows."""
    cranks = [
        machine({"A": (x, 0.0)}, {"crank": heavy(A=(0.0, 0.0), B=(x, 0.0))}) for x in (1.0, 2.0)
    ]
    for crank, x in zip(cranks, (1.0, 2.0), strict=True):
        assert eq.move(crank, 24).points["B"].place[0] == pytest.approx(2 * x)


def test_nobody_writes_to_positions_that_others_reuse() -> None:
    motion = eq.move(crank_rocker(), 24)
    for values in (motion.crank_angle, motion.points["B"].place, motion.links["rocker"].angle_1):
        with pytest.raises(ValueError, match="read-only"):
            values[0] = 0.0


def test_forces_are_the_same_to_the_last_digit_whatever_was_computed_before() -> None:
    base = crank_rocker()
    first = eq.analyze(base, 24, speed=7.0).forces
    eq.analyze(base, 24, speed=3.0, acceleration=2.0).forces.split  # noqa: B018  it is cached
    again = eq.analyze(base, 24, speed=7.0).forces
    anew = eq.analyze(crank_rocker(), 24, speed=7.0).forces
    for other in (again, anew):
        np.testing.assert_array_equal(other.shaking_moment, first.shaking_moment)
        np.testing.assert_array_equal(other.drive_torque, first.drive_torque)
        for name, joint in first.joints.items():
            np.testing.assert_array_equal(other.joints[name].value, joint.value)


def test_long_cycles_are_not_kept(monkeypatch: pytest.MonkeyPatch) -> None:
    """They take as much memory as all that is computed of them."""
    monkeypatch.setattr(motions, "MOST_KEPT", 24)
    base = crank_rocker()
    kept, long = eq.move(base, 24), eq.move(base, 25)
    assert eq.move(base, 24).state is kept.state
    assert eq.move(base, 25).state is not long.state


RATES = [(0.0, 0.0), (3.0, 0.0), (0.0, 5.0), (3.0, 5.0)]


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize(("speed", "acceleration"), RATES)
def test_demands_of_inertia_are_those_of_the_kernel(
    kind: str, speed: float, acceleration: float
) -> None:
    motion = eq.move(make(kind, 0).machine, np.linspace(0.1, 0.3, 5), speed, acceleration)
    needed = forces(motion).inertia
    for link, (force, moment) in needed.items():
        own = inertia_moved(motion.machine, link, motion.linkage.anchors[link])
        wanted = demand_of_inertia(motion, link, speed**2, *own)
        for got, known in zip((force, moment), wanted, strict=True):
            assert np.max(np.abs(got - known)) <= 1e-12 * np.max(np.abs(known))
