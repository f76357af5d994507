"""What goes in comes out: power, forces and moments, and their parts, close."""

from __future__ import annotations

from dataclasses import replace
from itertools import chain, compress, repeat
from typing import Any

import numpy as np
import pytest

import equipoise as eq
from equipoise.mechanism.dynamics.forces import EVERYWHERE
from equipoise.mechanism.parts.dampers import Damper
from equipoise.mechanism.parts.resistances import Resistance
from equipoise.mechanism.parts.stops import Stop
from equipoise.mechanism.parts.torsion_dampers import TorsionDamper
from laws.subjects import (
    ANGLES,
    acting,
    along,
    families_of,
    forces,
    forces_of,
    gravity_power,
    is_force,
    kinetic_power,
    load_power,
    machine_of,
    names,
    outputs,
    same,
    same_outputs,
    sizes,
    spring_power,
    without_loads,
)
from support.loads import loads_by_end

TOLERANCE = 1e-12
RUNS = [(None, None), (-7.0, 0.0), (5.0, 60.0), (-3.0, -40.0), (0.0, 50.0)]
"""Speed and acceleration of the crank; None for the machine's own."""

every_subject = pytest.mark.parametrize("name", names())


@every_subject
@pytest.mark.parametrize(("speed", "acceleration"), RUNS)
def test_power_fed_in_is_the_rate_of_change_of_energy(
    name: str, speed: float | None, acceleration: float | None
) -> None:
    result = forces_of(name, speed, acceleration)
    rows = [*kinetic_power(result), *-gravity_power(result), *-load_power(result)]
    rows = [*rows, *-spring_power(result)]
    size = np.max(np.sum(np.abs(rows), axis=0) + np.abs(result.power))
    same(result.power, np.sum(rows, axis=0), TOLERANCE, float(size))


@pytest.mark.parametrize("name", sorted(eq.examples("linkage")))
def test_no_work_is_left_after_a_cycle(name: str) -> None:
    machine = replace(without_loads(machine_of(name)), springs=machine_of(name).springs)
    result = forces(machine, 720, acceleration=0.0)
    size = np.max(np.abs([*kinetic_power(result), result.power]))  # equal cranks keep their energy
    assert abs(np.mean(result.power)) < 1e-9 * size


@every_subject
def test_frame_bears_shaking_force_weight_and_loads(name: str) -> None:
    result = forces_of(name)
    loads = load_resultant(result)[0]
    parts = [result.shaking_force.value, result.weight.value, loads]
    same(result.frame_force.value, sum(parts), TOLERANCE, sizes(result)[0])


@every_subject
@pytest.mark.parametrize("about", [None, (0.3, -0.2)])
def test_moment_on_the_frame_closes(name: str, about: Any) -> None:
    machine = machine_of(name)
    actual = forces_of(name) if about is None else forces(machine, about=about)
    loads = load_resultant(actual)[1]
    parts = [actual.shaking_moment, actual.weight_moment, loads]
    same(actual.frame_moment, sum(parts), TOLERANCE, moment_scale(actual))


def load_resultant(result: eq.mechanism.Forces) -> tuple[Any, Any]:
    """Force and moment about the pole of all loads whose opposite the frame does not bear."""
    motion = result.motion
    total, turning = np.zeros(len(ANGLES), complex), np.zeros(len(ANGLES))
    outer = chain((load.reaction is None for load in loads_by_end(motion.machine)), repeat(True))
    for _, point, force, torque in compress(acting(result), outer):
        arm = 0.0 if point is None else motion.points[point].place - result.about
        total, turning = total + force, turning + torque + along(1j * arm, force)
    return total, turning


def moment_scale(result: eq.mechanism.Forces) -> float:
    """Largest moment: of any output, or of any joint's force about the pole."""
    centers = result.motion.mass_centers.values()
    reach = max(float(np.max(np.abs(center.place - result.about))) for center in centers)
    force, moment = sizes(result)
    return max(moment, force * reach)


@every_subject
def test_shaking_is_the_loss_of_momentum(name: str) -> None:
    result = forces_of(name)
    links, centers = result.motion.links, result.motion.mass_centers
    force, moment = np.zeros(len(ANGLES), complex), np.zeros(len(ANGLES))
    for key, link in result.motion.machine.links.items():
        change = (link.mass or 0.0) * centers[key].acceleration_vector
        force = force - change
        moment = moment - along(1j * (centers[key].place - result.about), change)
        moment = moment - (link.inertia or 0.0) * links[key].angular_acceleration
    same(result.shaking_force.value, force, TOLERANCE, sizes(result)[0])
    same(result.shaking_moment, moment, TOLERANCE, moment_scale(result))


# -- parts -----------------------------------------------------------------------------------------


@every_subject
def test_causes_and_links_add_up_to_every_output(name: str) -> None:
    result = forces_of(name)
    split = result.split
    shape = (len(split.causes), len(result.motion.machine.links), len(ANGLES))
    parts = dict(split_outputs(split))
    scale = split_scales(parts)
    for key, value in outputs(result):
        assert parts[key].shape == shape, key
        same(parts[key].sum(axis=(0, 1)), value, TOLERANCE, scale[is_force(key)])


def split_outputs(split: Any) -> Any:
    """Every array of a split or regressor by the names of `outputs`."""
    for key in ("shaking_force", "frame_force", "shaking_moment", "frame_moment", "drive_torque"):
        yield key, getattr(split, key)
    yield from families_of(split)


def split_scales(parts: dict[str, Any]) -> dict[bool, float]:
    """Largest moment and largest force among all parts."""
    scale = {True: 0.0, False: 0.0}
    for key, value in parts.items():
        largest = float(np.max(np.sum(np.abs(value), axis=tuple(range(value.ndim - 1)))))
        scale[is_force(key)] = max(scale[is_force(key)], largest)
    return scale


@pytest.mark.parametrize("name", ["geared-counterweight", "quick-return", "class-three"])
def test_split_by_cause_and_by_link_has_names(name: str) -> None:
    result = forces_of(name)
    joints = [f"joints.{name}" for name in result.joints]
    keys = ["drive_torque", "shaking_force", *joints, *(f"gears.{name}" for name in result.gears)]
    for key in keys:
        causes, links = result.split.by_cause(key), result.split.by_link(key)
        assert tuple(causes) == EVERYWHERE
        assert tuple(links) == tuple(result.motion.machine.links)
        same(sum(causes.values()), sum(links.values()), TOLERANCE, sizes(result)[0])


def test_each_kind_of_force_element_has_its_own_cause() -> None:
    """Its share is what an analysis loses without it, at every output; statics is linear."""
    machine = eq.load("spring-balanced-crank")
    lists = {
        "spring": {"springs": machine.springs},
        "damper": {
            "dampers": (Damper("rocker", "F", "S", 40.0),),
            "torsion_dampers": (TorsionDamper("coupler", "rocker", damping=0.1),),
        },
        "stop": {"stops": (Stop("rocker", "F", "S", 2e4, restitution=0.6, speed=0.4),)},
        "resistance": {
            "resistances": (Resistance("coupler", "C", "S", force=25.0, speed=0.05),),
        },
    }
    whole = replace(machine, **{key: given for own in lists.values() for key, given in own.items()})
    result = forces(whole)
    assert result.split.causes == (*EVERYWHERE, "damper", "stop", "resistance")
    for cause, own in lists.items():
        bare = forces(replace(whole, **dict.fromkeys(own, ())))
        share = result.split.by_cause("drive_torque")[cause]
        assert np.max(np.abs(share)) > 1e-3
        same(share, result.drive_torque - bare.drive_torque, TOLERANCE, sizes(result)[1])
        joint = result.split.by_cause("joints.C")[cause]
        lost = result.joints["C"].value - bare.joints["C"].value
        same(joint, lost, TOLERANCE, sizes(result)[0])


@every_subject
def test_only_inertia_shakes(name: str) -> None:
    split = forces_of(name).split
    for key in ("shaking_force", "shaking_moment"):
        causes = split.by_cause(key)
        assert not np.any(causes["weight"])
        assert not np.any(causes["load"])
        assert not np.any(causes["spring"])
    assert not np.any(np.abs(split.by_cause("shaking_force")["rotation"]))


@pytest.mark.parametrize("name", ["geared-counterweight", "yamashita-1", "slider-crank-engine"])
def test_rotation_turns_without_force(name: str) -> None:
    """Inertia about the centres of mass gives a moment, weight gives no shaking."""
    machine = machine_of(name)
    points = replace(machine, links={
        key: replace(link, inertia=0.0) for key, link in machine.links.items()
    })  # fmt: skip
    whole, bare = forces_of(name), forces(points)
    rotation = whole.split.by_cause("drive_torque")["rotation"]
    same(whole.drive_torque - bare.drive_torque, rotation, 1e-11, sizes(whole)[1])


# -- parameters ------------------------------------------------------------------------------------


@every_subject
def test_outputs_are_linear_in_the_parameters(name: str) -> None:
    result = forces_of(name)
    regressor = eq.mechanism.regressor(result.motion)
    loads = dict(split_outputs(result.split))
    scale = split_scales({
        key: regressor.values[:, None] * value for key, value in split_outputs(regressor)
    })  # fmt: skip
    rows = dict(split_outputs(regressor))
    for key, value in outputs(result):
        of_loads = loads[key][EVERYWHERE.index("load") :].sum(axis=(0, 1))
        bound = max(scale[is_force(key)], sizes(result)[not is_force(key)])
        same(regressor.values @ rows[key] + of_loads, value, TOLERANCE, bound)


@pytest.mark.parametrize("name", ["yamashita-1", "class-three", "watt:0", "slider_on_rocker:1"])
def test_regressor_reports_other_masses(name: str) -> None:
    """Each column is the difference that one parameter makes."""
    machine = without_loads(machine_of(name))
    regressor = eq.mechanism.regressor(forces(machine).motion)
    rng = np.random.default_rng(5)
    for link in machine.links:
        x, y, mass, inertia = rng.uniform(0.01, 0.2, 4)
        machine = machine.with_link(link, mass=mass, center_of_mass=(x, y), inertia=inertia)
    other = forces(machine)
    values = eq.mechanism.regressor(other.motion).values
    force, moment = sizes(other)
    same(values @ regressor.frame_force, other.frame_force.value, 1e-11, force)
    same(values @ regressor.drive_torque, other.drive_torque, 1e-11, moment)


# -- another speed ---------------------------------------------------------------------------------


@every_subject
@pytest.mark.parametrize(("speed", "acceleration"), RUNS[1:])
def test_another_speed_is_a_fresh_analysis(name: str, speed: float, acceleration: float) -> None:
    fresh = forces_of(name, speed, acceleration)
    reused = forces_of(name).at(speed, acceleration)
    assert (reused.motion.speed, reused.motion.acceleration) == (speed, acceleration)
    same_outputs(reused, fresh, 1e-14)
    machine = machine_of(name).with_drive(speed=speed, acceleration=acceleration)
    same_outputs(forces(machine), fresh, 1e-14)


def test_another_speed_keeps_what_is_not_given() -> None:
    motion = forces_of("yamashita-1").motion
    assert motion.at(acceleration=3.0).speed == motion.speed
    assert motion.at(speed=3.0).acceleration == motion.acceleration


@every_subject
def test_inertia_grows_with_speed_squared(name: str) -> None:
    slow, fast = forces_of(name).at(2.0, 0.0), forces_of(name).at(6.0, 0.0)
    same(fast.shaking_force.value, 9 * slow.shaking_force.value, 1e-14, sizes(fast)[0])
    same(fast.shaking_moment, 9 * slow.shaking_moment, 1e-14, moment_scale(fast))
