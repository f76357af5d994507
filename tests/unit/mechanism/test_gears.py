"""Gear pairs: what is refused, when the motion closes, and what the teeth bear."""

from __future__ import annotations

from dataclasses import replace
from math import pi, sqrt, tan

import numpy as np
import pytest

import equipoise as eq
from equipoise.errors import ModelError, MotionError
from equipoise.mechanism.parts.machine import FRAME
from support.refusals import refused
from unit.mechanism.build import ORIGIN, body, crank_rocker, heavy, machine, two_gears


def teeth(driver: int, driven: int, **more: object) -> eq.Gear:
    return eq.Gear("crank", "wheel", teeth=(driver, driven), **more)  # type: ignore[arg-type]


# -- cycles ----------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("gear", "turns", "winding"),
    [
        (teeth(20, 30), 3, -2),
        (teeth(30, 20), 2, -3),
        (teeth(20, 40), 2, -1),
        (teeth(40, 20), 1, -2),
        (teeth(17, 31, mesh="internal"), 31, 17),
        (eq.Gear("crank", "wheel", ratio=-0.75), 4, -3),
        (eq.Gear("crank", "wheel", ratio=1 / 3), 3, 1),
    ],
)
def test_motion_closes_after_several_turns(gear: eq.Gear, turns: int, winding: int) -> None:
    motion = eq.move(two_gears(gear), 36)
    assert motion.turns == turns
    assert len(motion.crank_angle) == 36 * turns
    assert motion.crank_angle[-1] == pytest.approx(2 * pi * turns * (1 - 1 / (36 * turns)))
    cycle = motion.linkage.cycle
    assert (cycle.windings["crank"], cycle.windings["wheel"]) == (turns, winding)
    ends = eq.move(two_gears(gear), [0.0, 2 * pi * turns]).links["wheel"].angle
    assert ends[1] - ends[0] == pytest.approx(2 * pi * winding)


def test_start_is_the_angle_at_crank_angle_0() -> None:
    motion = eq.move(two_gears(teeth(20, 30, start=0.7)), [0.0, 1.5, 3 * pi, -1.5])
    want = 0.7 - np.array([0.0, 1.0, 2 * pi, -1.0])
    np.testing.assert_allclose(motion.links["wheel"].angle, want, atol=1e-14)


def train(*gears: eq.Gear) -> eq.Machine:
    return machine(
        {"A": ORIGIN, "E": (0.5, 0.0), "F": (1.0, 0.0)},
        {"crank": heavy(A=ORIGIN), "wheel": heavy(E=ORIGIN), "last": heavy(F=ORIGIN)},
        gears=gears,
    )


def test_a_train_closes_when_all_of_it_has() -> None:
    motion = eq.move(train(teeth(20, 30), eq.Gear("wheel", "last", teeth=(20, 50))), 24)
    assert motion.turns == 15
    assert motion.linkage.cycle.windings["last"] == 4


def test_a_ratio_that_never_closes() -> None:
    with refused(MotionError, name="crank to wheel", speed_ratio=-3.14159):
        eq.move(two_gears(eq.Gear("crank", "wheel", ratio=-pi)), 36)


def test_a_ratio_that_closes_too_late() -> None:
    with refused(MotionError, longer=1009, most_turns=1000, ratio="-997/1009"):
        eq.move(two_gears(teeth(997, 1009)), 36)


def test_a_train_that_closes_too_late() -> None:
    given = train(teeth(36, 37), eq.Gear("wheel", "last", teeth=(40, 41)))
    with refused(MotionError, longer="1517"):
        eq.move(given, 4)


@pytest.mark.parametrize("ratio", [-0.47, -pi, sqrt(2), 1 / 7])
def test_a_rocker_drives_with_any_ratio(ratio: float) -> None:
    """A rocker comes back after one turn of the crank, and so does what it drives."""
    four = crank_rocker()
    given = replace(
        four,
        frame={**four.frame, "E": (2.0, 0.0)},
        links={**four.links, "weight": heavy(E=ORIGIN)},
        gears=(eq.Gear("rocker", "weight", ratio=ratio, start=0.4),),
    )
    motion = eq.move(given, 36)
    assert motion.turns == 1
    assert motion.linkage.cycle.windings["weight"] == 0
    rocker, weight = motion.links["rocker"].angle, motion.links["weight"].angle
    np.testing.assert_allclose(weight - 0.4, ratio * (rocker - rocker[0]), atol=1e-13)


def test_a_cycle_of_many_angles_is_refused() -> None:
    with refused(eq.EquipoiseError, most_angles="12903"):
        eq.move(two_gears(teeth(17, 31)), 40_000)


# -- refusals --------------------------------------------------------------------------------------


def test_gears_on_one_centre() -> None:
    given = machine(
        {"A": ORIGIN},
        {"crank": body(A=ORIGIN), "wheel": body(A=ORIGIN)},
        gears=(eq.Gear("crank", "wheel", ratio=-2.0),),
    )
    with refused(ModelError, "gears[1]", pin="A"):
        eq.mechanism.assemble(given)


# -- forces between teeth --------------------------------------------------------------------------


@pytest.mark.parametrize("torque", [6.0, -6.0])
@pytest.mark.parametrize(
    ("gear", "radius"),
    [
        (teeth(20, 30), 0.3),
        (teeth(20, 60, mesh="internal"), 0.75),
        (teeth(60, 20, mesh="internal"), 0.25),
    ],
)
def test_force_between_teeth(gear: eq.Gear, radius: float, torque: float) -> None:
    """The tooth force has a lever of the pitch radius and the slope of the pressure angle.

    External teeth, and those of a pinion in a ring, are pushed towards their own centre; a ring
    away from it.
    """
    given = two_gears(gear, gravity=(0.0, 0.0), loads=(eq.Load("wheel", torque=torque),))
    forces = eq.analyze(given, 12, speed=0.0).forces
    mesh = forces.gears["crank to wheel"]
    assert (mesh.on, mesh.by) == ("wheel", "crank")
    np.testing.assert_allclose(mesh.tangential, -torque / radius)
    inwards = -1 if gear.speed_ratio > 0 and gear.speed_ratio < 1 else 1
    np.testing.assert_allclose(mesh.radial, inwards * abs(torque) / radius * tan(pi / 9))
    np.testing.assert_allclose(forces.drive_torque, -torque * gear.speed_ratio)
    np.testing.assert_allclose(mesh.size, abs(torque) / radius / np.cos(pi / 9))
    np.testing.assert_allclose(forces.joints["E"].value, -mesh.value)
    np.testing.assert_allclose(forces.frame_moment, torque, atol=1e-13)


def test_a_gear_that_bears_nothing() -> None:
    links = two_gears(teeth(20, 30)).links
    still = two_gears(teeth(20, 30), gravity=(0.0, 0.0))
    still = still.with_link("wheel", center_of_mass=ORIGIN, inertia=0.0)
    mesh = eq.analyze(still, 12).forces.gears["crank to wheel"]
    assert not np.any(mesh.size)
    assert links["wheel"].inertia != 0


def test_pressure_angle_of_zero_pushes_across() -> None:
    given = two_gears(teeth(20, 30, pressure_angle=0.0))
    assert not np.any(np.abs(eq.analyze(given, 12).forces.gears["crank to wheel"].radial) > 1e-12)


def test_a_standing_sun() -> None:
    """A planet that rolls on a gear of the frame turns 1 + teeth ratio times with the carrier."""
    given = machine(
        {"A": ORIGIN},
        {"crank": heavy(A=ORIGIN, B=(0.2, 0.0)), "planet": heavy(B=ORIGIN)},
        gears=(eq.Gear(FRAME, "planet", teeth=(60, 20), carrier="crank"),),
    )
    motion = eq.move(given, 12)
    np.testing.assert_allclose(motion.links["planet"].angle_1, 4.0)
    assert motion.linkage.cycle.windings["planet"] == 4
