"""Losses of gears and belts against torques of shafts by hand, and against power that goes in."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import equipoise as eq
from equipoise.errors import ModelError
from equipoise.mechanism import JointProperties
from equipoise.schema.files import to_csv
from support.refusals import refused
from unit.schema.samples import survives

LOSS, TORQUE = 0.04, 3.0
RATIO = {"gears": -0.5, "belts": 0.4}


def shafts(table: str, torque: float, loss: float | None = LOSS) -> eq.Machine:
    """Two shafts without mass, joined by gears or a belt; a torque acts on the second."""
    frame = {"A": (0.0, 0.0), "B": (0.3, 0.0)}
    links = {"crank": eq.Link({"A": (0, 0)}, 0, (0, 0), 0),
             "wheel": eq.Link({"B": (0, 0)}, 0, (0, 0), 0)}  # fmt: skip
    couplings: dict[str, Any] = {"gears": [eq.Gear("crank", "wheel", ratio=-0.5)]}
    if table == "belts":
        from equipoise.mechanism import Belt

        couplings = {"belts": [Belt("crank", "wheel", radii=(0.02, 0.05), tension=400.0)]}
    joints = ()
    if loss is not None:
        joints = (JointProperties(f"{table}.crank to wheel", mesh_loss=loss),)
    loads = [eq.Load("wheel", torque=torque)]
    drive = eq.Drive("crank", 20.0)
    return eq.Machine("shafts", drive, frame, links, loads=loads, joints=joints, **couplings)


@pytest.mark.parametrize("table", ["gears", "belts"])
@pytest.mark.parametrize("against", [True, False])
def test_torques_of_two_shafts(table: str, against: bool) -> None:
    """By hand: what the driver gives is what the load takes over 1 - loss; where the load drives,
    what comes back is what it gives over 1 + loss.
    """
    ratio = RATIO[table]
    torque = -np.sign(ratio) * TORQUE if against else np.sign(ratio) * TORQUE
    analysis = eq.analyze(shafts(table, torque), 12)
    share = 1 - LOSS if against else 1 + LOSS
    np.testing.assert_allclose(analysis.forces.drive_torque, -torque * ratio / share, rtol=1e-12)
    losses = analysis.losses
    assert losses is not None
    given = abs(torque * ratio * 20.0)
    drive = given / (1 - LOSS) if against else given
    assert losses.loss == pytest.approx(drive * LOSS if against else given * LOSS / (1 + LOSS))
    assert losses.efficiency == pytest.approx(1 - LOSS if against else 1 / (1 + LOSS))


@pytest.mark.parametrize(
    ("name", "joint"),
    [
        ("geared-counterweight", "gears.rocker to counterweight"),
        ("planetary-planting-arm", "gears.idler to planet"),
        ("planetary-planting-arm", "gears.frame to idler"),
    ],
)
def test_power_and_the_law(name: str, joint: str) -> None:
    """Power of drive and loads less what is lost goes into motion and height, at every crank
    angle; and what is lost is the share of the tangential force, as reported, times the speed of
    the pitch circle.
    """
    machine = eq.load(name)
    free = eq.analyze(machine, 36, acceleration=15.0)
    lossy = replace(machine, joints=(JointProperties(joint, mesh_loss=0.05),), balance=None)
    analysis = eq.analyze(lossy, 36, acceleration=15.0)
    pair = joint.partition(".")[2]
    friction = analysis.forces.frictions[pair]
    gained = analysis.forces.power - free.forces.power
    assert np.max(friction.loss) > 0 and np.min(friction.loss) >= 0
    np.testing.assert_allclose(
        gained, friction.loss, atol=1e-10 * np.max(np.abs(free.forces.power))
    )
    push = np.abs(analysis.forces.couplings["gears"][pair].parts["tangential"])
    gear = next(item for item in lossy.gears if item.name == pair)
    turns = {
        "frame": np.zeros(36),
        **{k: v.angular_velocity for k, v in analysis.motion.links.items()},
    }
    speed = turns[gear.driven] - turns[gear.carrier]
    np.testing.assert_allclose(
        friction.loss, 0.05 * push * np.abs(speed) * friction.reach, rtol=1e-9, atol=1e-12
    )


@pytest.mark.parametrize("ahead", [True, False])
def test_gears_of_varying_ratio_lose_a_share_of_the_power_that_they_pass(ahead: bool) -> None:
    """A load on the driven gear alone, without masses: what goes in is what comes out over what is
    left, at every crank angle, whatever the ratio of the moment.
    """
    machine = eq.load("elliptic-quick-return")
    (gear,) = machine.gears
    torque = TORQUE if ahead else -TORQUE
    massless = {name: replace(link, mass=0.0, inertia=0.0, center_of_mass=(0.0, 0.0), bodies=())
                for name, link in machine.links.items()}  # fmt: skip
    joint = JointProperties(f"gears.{gear.name}", mesh_loss=LOSS)
    bare = replace(machine, links=massless, joints=(joint,), balance=None, support=None,
                   loads=(eq.Load(gear.driven, torque=torque),), springs=())  # fmt: skip
    analysis = eq.analyze(bare, 36)
    turning = analysis.motion.links[gear.driven].angular_velocity
    taken = -torque * turning
    wanted = np.where(taken > 0, taken / (1 - LOSS), taken / (1 + LOSS))
    np.testing.assert_allclose(analysis.forces.power, wanted, atol=1e-10 * np.max(np.abs(wanted)))
    assert np.ptp(turning) > 0.1 * np.max(np.abs(turning))


def rack_and_pinion() -> eq.Machine:
    """A slider-crank without mass whose blade is a rack that swings a pinion against a torque."""
    crank = eq.Link({"A": (0.0, 0.0), "B": (0.05, 0.0)}, 0, (0, 0), 0)
    rod = eq.Link({"B": (0.0, 0.0), "C": (0.2, 0.0)}, 0, (0, 0), 0)
    bar, wheel = eq.Link({"C": (0, 0)}, 0, (0, 0), 0), eq.Link({"O": (0, 0)}, 0, (0, 0), 0)
    return eq.Machine(
        "rack", eq.Drive("crank", 20.0), {"A": (0.0, 0.0), "O": (0.2, 0.08)},
        {"crank": crank, "rod": rod, "bar": bar, "wheel": wheel}, assembly={"C": "forward"},
        sliders=(eq.mechanism.Slider("bar", "C", "frame", "A", 0.0),),
        racks=(eq.mechanism.Rack("wheel", "bar", 0.08, "left", drives="rack"),),
        loads=(eq.Load("wheel", torque=TORQUE),),
    )  # fmt: skip


@pytest.mark.parametrize("drives", ["rack", "pinion"])
def test_a_rack_loses_a_share_of_its_force_times_its_way(drives: str) -> None:
    """Driven either way; of the rack that drives, the force on the blade by hand: the pinion's
    torque over radius, over what is left of 1 where the pinion takes power, and more than 1 where
    it gives.
    """
    machine = rack_and_pinion() if drives == "rack" else eq.load("knife-drive")
    (rack,) = machine.racks
    free = eq.analyze(machine, 36)
    joints = (JointProperties(f"racks.{rack.name}", mesh_loss=LOSS),)
    analysis = eq.analyze(replace(machine, joints=joints, balance=None), 36)
    friction = analysis.forces.frictions[rack.name]
    size = np.max(np.abs(free.forces.power))
    np.testing.assert_allclose(
        analysis.forces.power - free.forces.power, friction.loss, atol=1e-10 * size
    )
    push = np.abs(analysis.forces.couplings["racks"][rack.name].parts["tangential"])
    speed = np.abs(analysis.motion.slider(machine.sliders[0]).velocity)
    np.testing.assert_allclose(friction.loss, LOSS * push * speed, rtol=1e-9, atol=1e-12 * size)
    assert np.max(friction.loss) > 1e-3 * size
    reported = analysis.outputs[f"racks.{rack.name}.friction_loss"]
    np.testing.assert_array_equal(reported.values, friction.loss)
    if drives == "rack":
        given = (
            -TORQUE * analysis.motion.links["wheel"].angular_velocity
        )  # power that the load takes
        wanted = np.where(given > 0, given / (1 - LOSS), given / (1 + LOSS))
        np.testing.assert_allclose(analysis.forces.power, wanted, atol=1e-10 * size)


def test_in_a_whole_cycle_what_goes_in_is_lost_or_taken() -> None:
    machine = eq.load("planetary-planting-arm")
    joints = [JointProperties(f"gears.{gear.name}", mesh_loss=0.03) for gear in machine.gears]
    losses = eq.analyze(replace(machine, joints=tuple(joints), balance=None)).losses
    assert losses is not None and len(losses.joints) == len(machine.gears)
    assert losses.drive + losses.loads == pytest.approx(losses.loss, rel=1e-6)
    assert {joint.wear_work for joint in losses.joints.values()} == {0.0}  # it is no sliding way


def test_they_are_reported_everywhere() -> None:
    machine = shafts("gears", TORQUE)
    survives(machine)
    analysis = eq.analyze(machine, 90)
    name = "gears.crank to wheel.friction_loss"
    assert (
        analysis.to_dict()["friction"]["joints"]["crank to wheel"]["loss"] == analysis.losses.loss
    )
    assert analysis.summary[name].mean == pytest.approx(analysis.losses.loss)
    assert f"{name} [W]" in to_csv(analysis).partition("\n")[0]
    assert not [item for item in analysis.outputs.names if item.startswith("joints.crank to wheel")]


@pytest.mark.parametrize(
    ("name", "joint", "expected"),
    [
        ("slider-crank-engine", "joints.B", {"place": "joints[1].mesh_loss", "joint": "joints.B"}),
    ],
)
def test_where_there_is_none(name: str, joint: str, expected: dict[str, Any]) -> None:
    machine = replace(eq.load(name), joints=(JointProperties(joint, mesh_loss=0.1),), balance=None)
    with refused(ModelError, **expected):
        eq.analyze(machine)
