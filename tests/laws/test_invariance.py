"""The same machine described otherwise does the same."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from itertools import product
from typing import Any

import numpy as np
import pytest

import equipoise as eq
from equipoise.mechanism.parts.machine import FRAME
from laws import transforms
from laws.subjects import (
    ANGLES,
    IN_SOIL,
    STRANDS,
    forces,
    forces_of,
    is_force,
    machine_of,
    names,
    outputs,
    same,
    same_outputs,
    sizes,
    without_soil,
)
from laws.transforms import Units
from support.chosen import model_of

TOLERANCE = 1e-11
every_subject = pytest.mark.parametrize("name", names())


def scaled(
    result: eq.mechanism.Forces, force: complex = 1, moment: float = 1, flip: bool = False
) -> Any:
    """Outputs as another description must give them."""
    ahead = (r.name for r in result.motion.machine.racks if r.drives == "pinion")
    straight = ["cams/", *(f"racks/{rack}/" for rack in ahead)]
    straight += [f"joints/{slot.name}/" for slot in result.motion.machine.circular_slots]
    for name, value in outputs(result):
        if np.iscomplexobj(value):
            yield name, (np.conj(value) if flip else value) * force
        else:
            *family, part = name.split("/")
            if flip and part in STRANDS:  # a mirror swaps them
                part = STRANDS[1 - STRANDS.index(part)]
            size = abs(force) if is_force(name) else moment
            turns = part not in ("radial", *STRANDS) and not name.startswith(tuple(straight))
            yield "/".join([*family, part]), (-size if flip and turns else size) * value


def agree(got: eq.mechanism.Forces, want: dict[str, Any], tolerance: float = TOLERANCE) -> None:
    """Compare all outputs with what they must be, measured against the largest of each sort."""
    force, moment = sizes(got)
    values = dict(outputs(got))
    assert values.keys() == want.keys()
    for name, value in values.items():
        same(value, want[name], tolerance, force if is_force(name) else moment)


@every_subject
@pytest.mark.parametrize("shift", [0.7 - 0.3j, -2j])
def test_moving_the_frame(name: str, shift: complex) -> None:
    moved = forces(transforms.shifted(machine_of(name), shift))
    agree(moved, dict(scaled(forces_of(name))))
    for point, motion in forces_of(name).motion.points.items():
        same(moved.motion.points[point].place, motion.place + shift, TOLERANCE)
        same(moved.motion.points[point].velocity, motion.velocity, TOLERANCE, speed(name))


def speed(name: str) -> float:
    points = forces_of(name).motion.points.values()
    return max(float(np.max(np.abs(point.velocity))) for point in points)


@every_subject
@pytest.mark.parametrize("angle", [0.4, -2.3])
def test_turning_the_frame_with_gravity(name: str, angle: float) -> None:
    """Without soil, which stays level whichever way the machine is turned."""
    result = forces(without_soil(machine_of(name)))
    moved = forces(transforms.turned(machine_of(name), angle), ANGLES + angle)
    turn = np.exp(1j * angle)
    agree(moved, dict(scaled(result, turn)))
    for link, motion in result.motion.links.items():
        apart = moved.motion.links[link].angle - motion.angle - angle
        same(np.exp(1j * apart), np.ones(len(ANGLES)), TOLERANCE)


@every_subject
def test_mirror_image(name: str) -> None:
    moved = forces(transforms.mirrored(machine_of(name)), np.pi - ANGLES)
    agree(moved, dict(scaled(forces_of(name), -1, flip=True)))
    for point, motion in forces_of(name).motion.points.items():
        want = -np.conj(motion.velocity)
        same(moved.motion.points[point].velocity, want, TOLERANCE, speed(name))
    same(moved.power, forces_of(name).power, TOLERANCE, float(np.max(np.abs(moved.power))))


@every_subject
@pytest.mark.parametrize("units", [Units(1000, 1000, 1), Units(0.1, 5, 60)], ids=["mm-g", "slow"])
def test_other_units(name: str, units: Units) -> None:
    moved = forces(transforms.in_units(machine_of(name), units))
    agree(moved, dict(scaled(forces_of(name), units.force, units.moment)))


@every_subject
def test_other_axes_of_the_links(name: str) -> None:
    """Only the axes of driven links matter: they carry the crank angle."""
    machine, rng = machine_of(name), np.random.default_rng(4)
    for link in machine.links:
        if link not in [drive.link for drive in machine.driven]:
            shift = complex(*rng.normal(size=2)) * 0.1
            machine = transforms.with_axes(machine, link, float(rng.uniform(-3, 3)), shift)
    want = dict(outputs(forces_of(name)))
    actual, (force, moment) = forces(machine), sizes(forces_of(name))
    for key, value in outputs(actual):
        same(value, want[key], TOLERANCE, force if is_force(key) else moment)


@every_subject
def test_reversing_the_speed(name: str) -> None:
    """At each crank angle inertia knows only the speed's square; the power changes sign.

    Without soil, which pushes against the motion, so that its force changes sign; see below.
    """
    result = forces(without_soil(machine_of(name)))
    reverse = result.at(-result.motion.speed)
    agree(reverse, dict(scaled(result)))
    np.testing.assert_allclose(reverse.power, -result.power)
    for point, motion in result.motion.points.items():
        np.testing.assert_array_equal(reverse.motion.points[point].velocity, -motion.velocity)


@pytest.mark.parametrize("name", [IN_SOIL, "transplanter"])
def test_driving_backwards_reverses_the_soil(name: str) -> None:
    """With crank and machine reversed the tip runs back over the same ground.

    Only the travel has to be turned as well: `forward_speed` and `hill_spacing` tell its size.
    """
    machine = machine_of(name)
    assert machine.planting is not None
    back = machine.with_planting(travel=FLIP[machine.planting.travel])
    ahead, dry = dict(outputs(forces_of(name))), dict(outputs(forces(without_soil(machine))))
    want = {key: 2 * dry[key] - value for key, value in ahead.items()}
    assert any(np.any(value != ahead[key]) for key, value in want.items())
    agree(forces(back, speed=-machine.drive.speed), want)


# -- names and order -------------------------------------------------------------------------------


@every_subject
def test_other_names(name: str) -> None:
    """Names in the opposite alphabetical order, none of them old."""

    def other(old: str) -> str:
        return "".join(chr(0x17E - min(ord(c), 0x7E)) for c in old)

    moved = forces(transforms.renamed(machine_of(name), other))
    result = forces_of(name)
    for key in ("shaking_force", "shaking_moment", "drive_torque", "frame_force", "frame_moment"):
        got, want = dict(outputs(moved))[key], dict(outputs(result))[key]
        same(got, want, 1e-14, max(sizes(result)))
    assert [j.value.tolist() for j in moved.joints.values()] == [
        j.value.tolist() for j in result.joints.values()
    ]
    for family in ("joints", "gears"):
        bodies = [{other(j.on), other(j.by)} - {other(FRAME)}
                  for j in getattr(result, family).values()]  # fmt: skip
        assert bodies == [{j.on, j.by} - {FRAME} for j in getattr(moved, family).values()]


def test_other_names_of_joints_with_properties() -> None:
    """What joints of the model file have of their own stays with sliders and with pins."""
    machine = eq.load("plunger-pump")

    def other(old: str) -> str:
        return f"{old}-2"

    moved = transforms.renamed(machine, other)
    assert [joint.joint for joint in moved.joints] == [
        "joints.A-2", "joints.B-2", "joints.C-2", "joints.plunger-2 on frame"
    ]  # fmt: skip
    same(forces(moved).drive_torque, forces(machine).drive_torque, 1e-14)
    assert np.ptp(forces(machine).drive_torque - forces(machine.without_friction()).drive_torque)


@every_subject
def test_other_order_in_the_file(name: str) -> None:
    moved, actual = forces(transforms.reordered(machine_of(name))), forces_of(name)
    force, moment = sizes(actual)
    want = dict(outputs(actual))
    for key, value in outputs(moved):
        if "/" not in key:
            same(value, want[key], TOLERANCE, force if is_force(key) else moment)
    for key, joint in moved.joints.items():
        before = actual.joints.get(key)
        if before is not None and {before.on, before.by} == {joint.on, joint.by}:
            sign = 1 if before.on == joint.on else -1
            same(sign * joint.value, before.value, TOLERANCE, force)
    for key, mesh in moved.gears.items():
        same(mesh.value, actual.gears[key].value, TOLERANCE, force)


@every_subject
def test_joint_forces_act_on_the_later_body(name: str) -> None:
    """A joint of two bodies gives the force on the later one, and the frame comes first."""
    for result in (forces_of(name), forces(transforms.reordered(machine_of(name)))):
        order = [FRAME, *result.motion.machine.links]
        pins = result.motion.linkage.joints.pins
        for key, joint in result.joints.items():
            if "/" not in key and len(pins.get(key, "ab")) == 2:
                assert order.index(joint.by) < order.index(joint.on)


def slides(name: str) -> bool:
    """Whether a link slides on another, as with all seeds of a kind or with none."""
    first = name if ":" not in name else f"{name.partition(':')[0]}:0"
    machine = model_of(first) if first in eq.examples("linkage") else machine_of(first)
    return any(slider.on != FRAME for slider in machine.sliders)


SLIDING = [name for name in names() if slides(name)]


@pytest.mark.parametrize("name", SLIDING)
def test_sliders_given_from_the_other_link(name: str) -> None:
    """Which of two links is said to slide on which changes words, but no joint force."""
    machine = machine_of(name)
    swapped = transforms.swapped_sliders(machine)
    key_of = {old.name: new.name for old, new in zip(machine.sliders, swapped.sliders, strict=True)}
    moved = best(swapped, machine)
    result = forces_of(name)
    force, _ = sizes(result)
    for key, joint in result.joints.items():
        got = moved.joints[key_of.get(key, key)]
        assert {got.on, got.by} == {joint.on, joint.by}
        same(got.value * (1 if got.on == joint.on else -1), joint.value, TOLERANCE, force)
    same(moved.drive_torque, result.drive_torque, TOLERANCE, sizes(result)[1])


def best(swapped: eq.Machine, machine: eq.Machine) -> eq.mechanism.Forces:
    """Analyse with the assembly sides as the swapped file needs them.

    An RPR dyad's side goes by the slider's point and direction, which both are others now.
    """
    wanted = eq.move(machine, ANGLES).points
    for sides in other_sides(swapped, machine):
        try:
            result = forces(replace(swapped, assembly=sides))
        except eq.EquipoiseError:
            continue
        points = result.motion.points
        if all(np.allclose(points[p].place, wanted[p].place, atol=1e-9) for p in wanted):
            return result
    raise AssertionError("no assembly gives the same motion")


def other_sides(swapped: eq.Machine, machine: eq.Machine) -> Iterator[dict[str, str]]:
    """Assembly entries with or without the sliders' other names, each on either side."""
    pairs = zip(machine.sliders, swapped.sliders, strict=True)
    other = {old.point: new.point for old, new in pairs}
    for names_of in ({}, other):
        joints = [names_of.get(joint, joint) for joint in machine.assembly]
        either = [(side, FLIP.get(side, side)) for side in machine.assembly.values()]
        for sides in product(*either):
            yield dict(zip(joints, sides, strict=True))


FLIP = {"forward": "backward", "backward": "forward"}


# -- loads and poles -------------------------------------------------------------------------------


@pytest.mark.parametrize("name", ["yamashita-1", "class-three", "geared-counterweight"])
def test_loads_add_up(name: str) -> None:
    """Two loads act as each by itself; a window of a whole turn acts always."""
    machine = machine_of(name)
    link, point = [(k, q) for k, v in machine.links.items() for q in v.points][-1]
    single, two = eq.Load(link, point, force=(30.0, -10.0)), eq.Load(link, torque=2.0)
    plain, first, second, both = (
        forces(replace(machine, loads=loads), speed=0.0, acceleration=0.0)
        for loads in ((), (single,), (two,), (single, two))
    )
    same(both.drive_torque - plain.drive_torque,
         first.drive_torque + second.drive_torque - 2 * plain.drive_torque,
         TOLERANCE, sizes(both)[1])  # fmt: skip
    always = replace(single, start=0.3, stop=0.3 + 2 * np.pi)
    table = eq.mechanism.LoadTable((0.0, 1.0), ((30.0, 30.0), (-10.0, -10.0)))
    tabulated = eq.Load(link, point, table=table, outside="wrap")
    for same_load in (always, tabulated):
        other = forces(replace(machine, loads=(same_load,)), speed=0.0, acceleration=0.0)
        same_outputs(other, first, 1e-14)


@pytest.mark.parametrize("name", ["yamashita-1", "scotch-yoke", "watt:0"])
def test_moments_about_another_pole(name: str) -> None:
    machine = machine_of(name)
    pole = (0.4, -0.1)
    actual, other = forces_of(name), forces(machine, about=pole)
    arm = actual.about - complex(*pole)
    for moment, force in (("shaking_moment", "shaking_force"), ("frame_moment", "frame_force")):
        lever = np.conj(arm) * getattr(actual, force).value
        same(getattr(other, moment), getattr(actual, moment) + lever.imag, TOLERANCE)
    same(actual.shaking_moment_about(pole), other.shaking_moment, 1e-13)
