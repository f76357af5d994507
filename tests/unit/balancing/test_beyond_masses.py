"""What helps where plates do not: flywheels, cylinders, mounts, lengths, shafts, half a piston."""

from __future__ import annotations

from dataclasses import fields, replace
from math import pi
from pathlib import Path

import numpy as np
import pytest

import equipoise as eq
import support.findings
from equipoise.balancing.advice import advise, gauge_aims
from equipoise.balancing.beyond_masses import Beyond
from equipoise.balancing.cylinder_sizes import MODULUS
from equipoise.balancing.first_order import balance_shafts_for
from equipoise.balancing.flywheels import RequiredFlywheel, flywheel_sentences, flywheels_for
from equipoise.balancing.outcome import benefit_sentences
from equipoise.balancing.policy import (
    BUCKLING_SAFETY,
    CYLINDER_PRESSURE,
    WORTH_SHAFTS,
)
from equipoise.balancing.poor_transmission import poor_transmission_for
from equipoise.balancing.problem import Problem
from equipoise.balancing.resonant_mounts import resonant_mounts_for
from equipoise.mechanism.parts.motors import Motor
from equipoise.results.blocks import Facts, Text
from equipoise.results.rotors import COARSE, STEADY
from equipoise.results.yardsticks import assess
from equipoise.running.flywheel import size_flywheel
from equipoise.vibration.blocks import response_headline
from equipoise.vibration.linear import Linear, around, resonances
from support.chosen import EXHAUSTIVE
from support.findings import advice_for

RPM = pi / 30
ADVISED = Path(support.findings.__file__).parent / "advised"


def beyond(name: str) -> Beyond:
    advice = advice_for(name)
    assert advice.advice is not None
    return advice.advice.beyond


def said(name: str) -> str:
    return " ".join(benefit_sentences(advice_for(name)))


# -- flywheels -------------------------------------------------------------------------------------


@pytest.mark.exhaustive(but=["slider-crank-engine-shares1-1", "press-shares3-3"])
@pytest.mark.parametrize(
    ("name", "shares", "ratio"),
    [
        ("brush-cutter-engine", (STEADY,), 1),
        ("slider-crank-engine", (STEADY,), 1),
        ("four-stroke-engine", (STEADY,), 1),
        ("press", (STEADY, COARSE), 3),
    ],
)
def test_a_flywheel_stores_the_work_that_the_torque_swings_by(
    name: str, shares: tuple[float, ...], ratio: int
) -> None:
    """By the speed of a crank that a steady torque drives: it swings within the share told.

    J(q) q.^2 / 2 is what the torque at constant speed leaves beside its mean, and J(q) w^2 / 2;
    J(q) is the torque that one rad/s^2 more takes.
    """
    machine = advice_for(name).original
    flywheels = beyond(name).flywheels
    assert flywheels is not None
    assert tuple(choice.fluctuation for choice in flywheels.choices) == shares
    analysis = eq.analyze(machine, 7200, acceleration=0.0)
    torque, speed = analysis.forces.drive_torque, machine.drive.speed
    faster = eq.analyze(machine.with_drive(flywheel=0.0), 7200, acceleration=1.0)
    linkage = faster.forces.drive_torque - torque
    for item in flywheels.choices:
        assert item.ratio == ratio
        inertia = machine.drive.flywheel + item.inertia * item.ratio**2
        gained = np.cumsum(np.mean(torque) - torque) * 2 * pi * analysis.motion.turns / len(torque)
        energy = (inertia + np.mean(linkage)) * speed**2 / 2 + gained - np.mean(gained)
        energy += (linkage - np.mean(linkage)) * speed**2 / 2
        speeds = np.sqrt(2 * energy / (inertia + linkage))
        swing = float(np.ptp(speeds) * np.mean(1 / speeds))
        assert 0.9 * item.fluctuation < swing < 1.01 * item.fluctuation  # rounded up to two digits


def test_a_flywheel_is_that_of_run() -> None:
    """Beside a linkage whose own inertia counts: 0.0285 kg m2, not the 0.032 of a torque alone."""
    machine = advice_for("four-stroke-engine").original
    flywheels = beyond("four-stroke-engine").flywheels
    assert flywheels is not None
    (first,) = flywheels.choices
    exact = size_flywheel(machine, STEADY)
    assert exact.inertia <= first.inertia < 1.1 * exact.inertia
    assert first.inertia < 0.95 * exact.estimate


def test_a_flywheel_is_a_disc_that_can_be_turned_and_run() -> None:
    """Its mass and inertia by rings; its edge no faster than cast iron may be."""
    for name in ("four-stroke-engine", "press", "quick-return", "brush-cutter-engine"):
        flywheels = beyond(name).flywheels
        assert flywheels is not None
        for choice in flywheels.choices:
            rings = np.linspace(0, choice.diameter / 2, 20001)
            middle = (rings[1:] + rings[:-1]) / 2
            mass = 7850 * choice.thickness * 2 * pi * middle * np.diff(rings)
            assert np.sum(mass) == pytest.approx(choice.mass, rel=1e-6)
            inertia = np.sum(mass * middle**2)
            per_millimetre = inertia / choice.thickness * 1e-3  # which rounding up may add
            assert choice.inertia * (1 - 1e-6) <= inertia < choice.inertia + per_millimetre
            assert 1 / 30 * (1 - 1e-6) <= choice.thickness / choice.diameter <= 1 / 3
            speed = abs(advice_for(name).original.drive.speed) * choice.ratio
            assert speed * choice.diameter / 2 <= 40 * (1 + 1e-9)


def test_engines_get_their_flywheel_though_the_force_is_larger() -> None:
    """The torque of the four-stroke engine swings by 16 times its mean; its force is first."""
    flywheels = beyond("four-stroke-engine").flywheels
    assert flywheels is not None
    assert "Flywheel on crank: at least 0.029 kg m²" in said("four-stroke-engine")


def test_a_press_gets_the_torque_of_its_motor() -> None:
    """The work of its load in a turn, by the force and the way of the ram."""
    actual, machine = beyond("press").flywheels, advice_for("press").original
    assert actual is not None
    turned = np.radians(np.linspace(248, 268, 20001))
    motion = eq.move(machine, turned)
    work = -200e3 * np.ptp(motion.points["C"].place.imag)
    assert actual.mean_torque == pytest.approx(abs(work) / (2 * pi), rel=1e-3)
    assert actual.power == pytest.approx(actual.mean_torque * machine.drive.speed)
    assert "within 5 %" in said("press") and "within 20 %" in said("press")
    assert "A motor that permits this fluctuation then has to give 100 N m at crank" in said(
        "press"
    )


def test_a_resonance_is_left_where_it_is_far_and_the_gauges_read_little() -> None:
    """The press for dies reads 1.7 of 4.5 mm/s; order 3 at 154 rpm amplifies that, and is far."""
    press = advice_for("die-press").original
    assert beyond("die-press").mounts is None
    weak = press.with_support(
        mounts={
            name: replace(mount, stiffness=mount.stiffness / 2)
            for name, mount in press.support.mounts.items()
        }
    )
    advice = advise(weak).advice
    assert advice is not None and advice.beyond.mounts is not None
    assert any(item.output == "gauges.feed" and item.is_large for item in advice.before)


@EXHAUSTIVE  # On every change: the flywheel of `plunger-pump`, in `surface/test_balance.py`.
def test_a_flywheel_on_a_faster_shaft_names_what_is_assumed() -> None:
    """A pump without a motor has such a shaft only if its motor is there."""
    machine = eq.load("plunger-pump")
    alone = eq.analyze(machine, acceleration=0.0)
    flywheels = flywheels_for(alone, assess(alone))
    assert flywheels is not None and all(choice.is_shaft_assumed for choice in flywheels.choices)
    (first, *_) = flywheel_sentences(flywheels, "crank", machine.mass)
    assert "Flywheel on a shaft 4 times as fast as crank, which the file does not give" in first
    motor = Motor(stall_torque=60.0, no_load_speed=400.0, ratio=3.5)
    driven = eq.analyze(machine.with_drive(motor=motor), acceleration=0.0)
    flywheels = flywheels_for(driven, assess(driven))
    assert flywheels is not None
    assert all(choice.ratio == 3.5 and not choice.is_shaft_assumed for choice in flywheels.choices)
    (first, *_) = flywheel_sentences(flywheels, "crank", machine.mass)
    assert first.startswith("Flywheel on the shaft of the motor: ")


def test_a_flywheel_that_is_there_is_enough() -> None:
    machine = advice_for("brush-cutter-engine").original
    flywheels = beyond("brush-cutter-engine").flywheels
    assert flywheels is not None
    (first,) = flywheels.choices
    assert isinstance(first, RequiredFlywheel)
    heavy = eq.analyze(machine.with_drive(flywheel=1.1 * first.inertia))
    assert flywheels_for(heavy, assess(heavy)) is None


# -- cylinders -------------------------------------------------------------------------------------


@pytest.mark.parametrize(("name", "bore"), [("hydraulic-loader", 0.05), ("excavator", 0.14)])
def test_a_bore_holds_the_force_at_a_pressure(name: str, bore: float) -> None:
    """By the forces of a whole analysis; the next smaller in stock does not."""
    first = beyond(name).cylinder
    assert first is not None and first.bore == bore
    push, pull = (area * CYLINDER_PRESSURE * pi / 4 for area in (bore**2, bore**2 - first.rod**2))
    assert first.push <= push and first.pull <= pull
    smaller = {0.05: 0.04, 0.14: 0.125}[bore]
    assert first.push > smaller**2 * CYLINDER_PRESSURE * pi / 4 or first.pull > 0.6 * push
    assert f"At 200 bar a cylinder of {1e3 * bore:.3g}" in said(name).replace("50.0", "50")


def test_a_rod_does_not_buckle() -> None:
    """By the lowest eigenvalue of a strut with pins at both ends, in finite differences."""
    first = beyond("hydraulic-loader").cylinder
    assert first is not None and first.is_slender
    machine = advice_for("hydraulic-loader").original
    analysis = eq.analyze(machine)
    force = analysis.outputs["drive_force"].values
    motion = analysis.motion
    length = np.abs(motion.points["B"].place - motion.points["A"].place)
    k = int(np.argmax(np.maximum(force, 0) * length**2))
    nodes = 400
    step = length[k] / nodes
    bending = np.diag([2.0] * (nodes - 1)) - np.eye(nodes - 1, k=1) - np.eye(nodes - 1, k=-1)
    lowest = float(np.linalg.eigvalsh(bending)[0]) / step**2
    load = {rod: MODULUS * pi * rod**4 / 64 * lowest for rod in (first.rod, 0.028)}
    assert load[first.rod] >= BUCKLING_SAFETY * force[k] * (1 - 1e-4) > load[0.028]


def test_a_lever_is_longer_only_where_its_cylinder_can_be_built() -> None:
    """The loader's, closed 600 mm for a stroke of 450, has no room for more stroke."""
    first = beyond("hydraulic-loader").cylinder
    assert first is not None and first.lever is None and first.is_lever_stopped
    assert "has no room" in said("hydraulic-loader")
    assert "twice as long" not in said("hydraulic-loader")
    of_stick = beyond("excavator").cylinder
    assert of_stick is not None and of_stick.lever is not None
    lever = of_stick.lever
    assert lever.open - lever.closed + of_stick.dead <= lever.closed


def test_a_longer_lever_takes_the_force_of_virtual_work() -> None:
    """F dL = F' dL', with both lengths by the places of the pins, and differences for dL."""
    first, machine = beyond("excavator").cylinder, advice_for("excavator").original
    assert first is not None and first.lever is not None and first.pivot == "Q"
    analysis = eq.analyze(machine, 7200)
    places = {name: analysis.motion.points[name].place for name in "EFQ"}
    force = analysis.outputs["drives.stick.force"].values
    more = first.lever.distance / float(np.abs(places["F"] - places["Q"])[0])
    moved = dict(places)
    moved[first.lever.point] = places["Q"] + more * (places[first.lever.point] - places["Q"])
    old, new = (np.abs(at["F"] - at["E"]) for at in (places, moved))
    assert (float(np.min(new)), float(np.max(new))) == pytest.approx(
        (first.lever.closed, first.lever.open), rel=1e-4
    )
    moving = np.abs(np.gradient(old)) > 1e-3 * np.max(np.abs(np.gradient(old)))
    needed = force[moving] * np.gradient(old)[moving] / np.gradient(new)[moving]
    assert np.max(np.abs(needed)) == pytest.approx(first.lever.force, rel=2e-3)


# -- mounts ----------------------------------------------------------------------------------------


def test_a_resonance_beside_the_speed_is_moved_first() -> None:
    """The sieve at 280 to 360 rpm beside 255 rpm: not a sector of plate."""
    actual, mounts = advice_for("sieve"), beyond("sieve").mounts
    assert not actual.helps and mounts is not None
    assert mounts.speed / RPM == pytest.approx(255, abs=1)
    assert np.array(mounts.avoid) / RPM == pytest.approx([221, 277.5], abs=0.5)
    assert mounts.mounts == ("front_along", "back_along")
    assert said("sieve").index("First move") < said("sieve").index("Leave the masses")
    words = "First move the resonance at 255 rpm, which amplifies the motion at 280 rpm too"
    first = said("sieve").index(words)  # and not that it is to keep away from speeds that it does
    assert first < said("sieve").index("2 times softer would take 45 % off")


SHAKER = """
schema = 1
title = "Shaker on soft mounts"
[drive]
link = "crank"
speed = "300 rpm"
[frame]
points.O = ["-300 mm", "0 mm"]
points.L = ["0 mm", "-100 mm"]
points.R = ["800 mm", "-100 mm"]
[links.crank]
points = ["O", "A"]
length = "12 mm"
mass = "4 kg"
center_of_mass = ["2 mm", "0 mm"]
inertia = "9000 kg mm^2"
[links.rod]
points = ["A", "C"]
length = "350 mm"
mass = "2 kg"
center_of_mass = ["175 mm", "0 mm"]
inertia = "22000 kg mm^2"
[links.left]
points = ["L", "C"]
length = "150 mm"
mass = "1 kg"
center_of_mass = ["75 mm", "0 mm"]
inertia = "2500 kg mm^2"
[links.pan]
points.C = ["0 mm", "0 mm"]
points.E = ["800 mm", "0 mm"]
mass = "45 kg"
center_of_mass = ["420 mm", "60 mm"]
inertia = "8 kg m^2"
[links.right]
points = ["R", "E"]
length = "150 mm"
mass = "1 kg"
center_of_mass = ["75 mm", "0 mm"]
inertia = "2500 kg mm^2"
[assembly]
C = "left"
E = "left"
[support]
mass = "160 kg"
center_of_mass = ["350 mm", "-200 mm"]
inertia = "28 kg m^2"
[support.mounts]
front = {point = ["900 mm", "-350 mm"], stiffness = "300 kN/m", damping = "600 N s/m"}
back = {point = ["-200 mm", "-350 mm"], stiffness = "300 kN/m", damping = "600 N s/m"}
[support.mounts.along]
point = ["350 mm", "-350 mm"]
direction = "0 deg"
stiffness = "240 kN/m"
damping = "600 N s/m"
[support.gauges]
middle = {point = ["350 mm", "-200 mm"], direction = "0 deg"}
end = {point = ["900 mm", "-100 mm"]}
"""
"""Resonances at 308, 507 and 650 rpm: the first moves the middle along, the others the end."""


@pytest.mark.exhaustive(but=["300-308-middle"])
@pytest.mark.parametrize(("speed", "resonance", "gauge"),
                         [(300, 308, "middle"), (500, 507, "end")])  # fmt: skip
def test_the_resonance_that_moves_the_machine_at_its_speed_is_named(
    tmp_path: Path, speed: int, resonance: int, gauge: str
) -> None:
    """Not the loudest of those beside it, each at its own gauge; and that gauge stands first."""
    path = tmp_path / "shaker.toml"
    path.write_text(SHAKER.replace("300 rpm", f"{speed} rpm"), encoding="utf-8")
    machine = eq.load(path)
    advised = advise(machine)
    assert advised.advice is not None
    mounts = advised.advice.beyond.mounts
    assert mounts is not None
    assert mounts.speed / RPM == pytest.approx(resonance, abs=1)
    assert mounts.avoid[0] < speed * RPM < mounts.avoid[1]
    assert next(iter(advised.aims)).output == f"gauges.{gauge}"
    shown = next(block for block in response_headline(eq.respond(machine), alone=True)
                 if isinstance(block, Facts))  # fmt: skip
    assert shown.items[0].startswith(f"{gauge}:")


# Mounts: `test_a_resonance_beside_the_speed_is_moved_first`.
@pytest.mark.exhaustive
def test_other_mounts_bring_what_is_reported() -> None:
    """By whole responses of the machine that stands on them; and no resonance is beside it."""
    machine, mounts = advice_for("sieve").original, beyond("sieve").mounts
    assert mounts is not None and mounts.factor == 0.5 and machine.support is not None
    soft = dict(machine.support.mounts)
    for name in mounts.mounts:
        first = soft[name]
        soft[name] = replace(first, stiffness=first.stiffness / 2, damping=first.damping / 2)
    changed = machine.with_support(mounts=soft)
    aims = gauge_aims(machine)
    left = []
    for first in aims:
        (speed,) = first.speeds
        name = first.output.removeprefix("gauges.")
        both = [eq.respond(each, speed).gauges[name].displacement.vibration_rms
                for each in (machine, changed)]  # fmt: skip
        left.append(float(both[1] / both[0]))
    assert 1 - np.mean(left) == pytest.approx(mounts.gain, rel=1e-3)
    for first in resonances(Linear.of(changed), *around(machine.drive, machine.drive.speed)):
        if first.is_loud and first.avoid is not None:
            assert not 280 * RPM / np.sqrt(2) < abs(first.speed) < 360 * RPM * np.sqrt(2)


# Mounts: `test_a_resonance_beside_the_speed_is_moved_first`.
@pytest.mark.exhaustive
def test_a_machine_far_from_its_resonances_keeps_its_mounts() -> None:
    """Twice as fast as the upper one of 255 and 656 rpm."""
    fast = eq.load("sieve").with_balance(None).with_drive(speed=1300 * RPM, speeds=())
    advice = advise(fast).advice
    assert advice is not None and advice.beyond.mounts is None


# Mounts: `test_a_resonance_beside_the_speed_is_moved_first`.
@pytest.mark.exhaustive
def test_where_phases_of_rows_bring_more_no_mounts_are_named() -> None:
    """A walking transplanter beside its resonance: two rows in turn leave 2 % of what it reads."""
    advice = advice_for("walking-transplanter")
    assert advice.helps and advice.gain > 0.95
    assert beyond("walking-transplanter").mounts is None


# Mounts: `test_a_resonance_beside_the_speed_is_moved_first`.
@pytest.mark.exhaustive
def test_a_resonance_that_matters_less_than_masses_is_not_moved_first() -> None:
    """193 rpm beside 119 rpm: a softer spring takes 23 % off, a counterweight 43 %."""
    actual, mounts = advice_for("yamashita-rig"), beyond("yamashita-rig").mounts
    assert actual.helps and mounts is not None and mounts.gain < actual.gain
    text = said("yamashita-rig")
    assert "The resonance at 119 rpm amplifies the motion at 193 rpm too: move it, or run" in text
    assert "First move" not in text
    assert "Mount spring 2 times softer would take 23 % off" in text


# Mounts: `test_a_resonance_beside_the_speed_is_moved_first`.
@pytest.mark.exhaustive
def test_a_damped_resonance_that_amplifies_by_half_is_named_beside_a_counterweight() -> None:
    """411 rpm with a damping of 0.2152, run at 300 rpm: 1.8 times what stiff mounts would leave;
    along and across alike.  Its edges by the equation of a mass on a spring and a damper.
    """
    actual, mounts = advice_for("exudyn-slider-crank"), beyond("exudyn-slider-crank").mounts
    assert actual.helps and mounts is not None
    assert mounts.mounts == ("along", "across") and mounts.factor == 2.0
    assert "First move the resonance at 411 rpm" in said("exudyn-slider-crank")
    assert mounts.away == mounts.avoid[0] < mounts.near < mounts.speed
    assert "or run below" in said("exudyn-slider-crank")
    mode = Linear.of(actual.original).modes[0]
    for speed, order in ((mounts.avoid[0], 0), (mounts.avoid[1], 2)):
        ratio = speed / mode.natural_frequency
        moved = 1 / abs(1 - ratio**2 + 2j * mode.damping_ratio * ratio)
        assert ratio**order * moved == pytest.approx(1.5, rel=1e-9)


# -- what is unbalanced ----------------------------------------------------------------------------


def force_of(machine: eq.Machine) -> np.ndarray:
    analysis = eq.analyze(machine, 720, acceleration=0.0)
    return np.asarray(analysis.forces.shaking_force.value)


def test_half_of_what_reciprocates_is_a_choice_with_both_forces() -> None:
    """With the counterweight on the crank, by whole analyses."""
    machine, piston = advice_for("four-stroke-engine").original, beyond("four-stroke-engine").piston
    assert piston is not None and not piston.is_half
    reciprocates, turns = 260 + 230 * 28 / 95, 230 * 67 / 95
    balanced = (3200 * 4 - turns * 27) / (reciprocates * 27)
    assert piston.share == pytest.approx(balanced, abs=0.02)
    place = piston.moment / 10.0 * np.exp(1j * piston.direction)
    link = machine.links["crank"].with_added(10.0, (place.real, place.imag), 0.0)
    half = machine.with_link("crank", mass=link.mass, center_of_mass=link.center_of_mass,
                             inertia=link.inertia)  # fmt: skip
    for changed, along, across in (
        (machine, piston.along, piston.across),
        (half, piston.half_along, piston.half_across),
    ):
        force = force_of(changed)
        assert np.max(np.abs(force.imag)) == pytest.approx(along, rel=1e-3)
        assert np.max(np.abs(force.real)) == pytest.approx(across, rel=1e-3)
    assert "choose by what the mounts bear" in said("four-stroke-engine")


# Pistons of engines: `test_half_of_what_reciprocates_is_a_choice_with_both_forces`.
@pytest.mark.exhaustive
def test_a_piston_is_that_of_a_crank() -> None:
    """Not a knife that a crank drives by levers, and a belt the crank."""
    assert beyond("knife-drive").piston is None


@pytest.mark.parametrize("name", ["slider-crank-engine", "brush-cutter-engine"])
def test_engines_get_their_shaking_force_beside_the_torque(name: str) -> None:
    piston = beyond(name).piston
    assert piston is not None and piston.is_half
    force = force_of(advice_for(name).original)
    assert np.max(np.abs(force.imag)) == pytest.approx(piston.along, rel=1e-3)
    assert "Half of what reciprocates is balanced on crank already" in said(name)
    assert "Flywheel on crank" in said(name)


def left_with(force: np.ndarray, square: float, forward: float, backward: float) -> float:
    """RMS over that before of what two shafts leave, with the best phases in steps of 5 deg."""
    angle = 2 * pi * np.arange(len(force)) / len(force) * (len(force) // 720)
    ways = np.exp(1j * np.radians(np.arange(0, 360, 5)))
    ahead, against = (square * size for size in (forward, backward))
    left = min(
        float(np.mean(np.abs(force + s * ahead * np.exp(1j * angle)
                             + t * against * np.exp(-1j * angle)) ** 2))
        for s in ways for t in ways
    )  # fmt: skip
    return float(np.sqrt(left / np.mean(np.abs(force) ** 2)))


@pytest.mark.exhaustive(but=["four-stroke-engine"])
@pytest.mark.parametrize("name", ["balance-shafts", "four-stroke-engine"])
def test_balance_shafts_are_for_the_machine_that_is_advised(name: str) -> None:
    """With the counterweight where one is offered: for the machine as it is they over-balance."""
    actual, shafts = advice_for(name), beyond(name).shafts
    assert shafts is not None
    machine = actual.machine if actual.helps else actual.original
    square = machine.drive.speed**2
    left = left_with(force_of(machine), square, shafts.forward, shafts.backward)
    assert 1 - left == pytest.approx(shafts.gain, abs=2e-3)
    assert ("With that change" in said(name)) == actual.helps
    if actual.helps:
        (change,) = actual.changes
        turned = np.exp(-1j * np.radians(np.arange(0, 360, 0.5)))
        without = np.mean(force_of(actual.original) * turned)
        moment = change.values["moment"] / (np.abs(without) / square)
        assert shafts.forward == pytest.approx(abs(without) / square * (1 - moment), rel=0.02)


def test_no_shafts_are_named_where_the_counterweight_leaves_too_little_for_them() -> None:
    """A yoke shakes with 9.6 times its weight as it is, with 5.7 times beside the counterweight."""
    actual, machine = advice_for("scotch-yoke"), advice_for("scotch-yoke").original
    analyses = [eq.analyze(item, acceleration=0.0) for item in (machine, actual.machine)]
    before, after = (analysis.summary["shaking_force"].peak / (machine.mass * 9.80665)
                     for analysis in analyses)  # fmt: skip
    assert actual.helps and after < WORTH_SHAFTS < before
    assert balance_shafts_for(analyses[0], assess(analyses[0])) is not None
    assert beyond("scotch-yoke").shafts is None and "With that change" not in said("scotch-yoke")


# -- a weight on a slow crank ----------------------------------------------------------------------


# A weight against order 1: test_what_is_said_first.py.
@pytest.mark.exhaustive
def test_a_weight_on_a_slow_crank_takes_the_torque_of_order_1() -> None:
    """With it on the crank the swing is what is told, by a whole analysis."""
    machine, weight = advice_for("pump-jack").original, beyond("pump-jack").counterbalance
    assert weight is not None
    place = weight.moment / 1500 * np.exp(1j * weight.direction)
    link = machine.links["crank"].with_added(1500.0, (place.real, place.imag), 0.0)
    changed = machine.with_link("crank", mass=link.mass, center_of_mass=link.center_of_mass,
                                inertia=link.inertia)  # fmt: skip
    swings = [
        np.sqrt(item.summary["drive_torque"].rms ** 2 - item.summary["drive_torque"].mean ** 2)
        for item in map(eq.analyze, (machine, changed))
    ]
    assert 1 - swings[1] / swings[0] == pytest.approx(weight.gain, abs=1e-6)
    advice = advise(machine.with_drive(speed=60 * RPM)).advice
    assert advice is not None and advice.beyond.counterbalance is None


# -- transmission angles ---------------------------------------------------------------------------


# Transmission angles: `test_a_good_transmission_angle_is_not_mentioned` and tests/unit/results.
@pytest.mark.exhaustive
def test_a_poor_transmission_angle_names_joint_force_and_length() -> None:
    """Of the walking beam, though a counterweight helps it otherwise."""
    actual, poor = advice_for("walking-beam"), beyond("walking-beam").transmission
    assert actual.helps and poor is not None and poor.between is not None
    analysis = eq.analyze(actual.machine)
    assert poor.joint == "F"
    assert poor.transmission == analysis.outputs["transmission.F"].figures.min
    assert poor.force == analysis.summary["joints.F"].peak
    reported = said("walking-beam")
    assert "Transmission angle at F: 28.7° at crank angle 212.5° (usual: 40°)." in reported
    assert reported.count("Transmission angle at F: ") == 1
    short = " ".join(item.text for item in actual.headline(alone=True) if isinstance(item, Text)
                     and not item.is_detail)  # fmt: skip
    assert "Transmission angle at F: 28.7°" in short
    first, second = (complex(*actual.machine.links[poor.link].points[at]) for at in poor.between)
    place = first + (1 + poor.share) * (second - first)
    changed = actual.machine.with_point(poor.link, poor.between[1], (place.real, place.imag))
    angles = eq.analyze(changed, 720).outputs["transmission.F"].values
    worst = float(np.min(np.minimum(angles, pi - angles)))
    assert worst == pytest.approx(poor.mended, abs=2e-3) and worst > poor.transmission
    assert abs(place - first) == pytest.approx(poor.length)


def test_a_good_transmission_angle_is_not_mentioned() -> None:
    analysis = eq.analyze(eq.load("yamashita-1"))
    assert poor_transmission_for(analysis, assess(analysis)) is None
    assert "transmission angle" not in said("yamashita-1")


def test_values_of_aims_are_those_of_a_response() -> None:
    """What gauges read at the speeds of the sieve, in the gain of other mounts."""
    machine = advice_for("sieve").original
    (first, *_) = gauge_aims(machine)
    read = eq.respond(machine, first.speeds[0]).gauges[first.output.removeprefix("gauges.")]
    value = float(read.displacement.vibration_rms)
    assert Problem.value_of(machine, first) == pytest.approx(value, rel=1e-6)


# -- arms ------------------------------------------------------------------------------------------


def test_arms_that_hang_on_one_side_are_named_where_they_load_a_joint() -> None:
    """Both arms of a rotary transplanter, at a hundredth of its speed and at its own: their weight
    and their inertia on one side of the pins are a third of the force in B; not the idlers.
    """
    machine, arms = advice_for("rotary-transplanter").original, beyond("rotary-transplanter").arms
    assert arms is not None and arms.links == ("arm 1", "arm 2") and arms.pins == ("C", "E")
    assert arms.distance == pytest.approx(np.hypot(0.038, 0.004))
    before = eq.analyze(machine, 720, acceleration=0.0).summary["joints.B"].peak
    for name in arms.links:
        link = machine.links[name]
        opposite = tuple(-item for item in link.center_of_mass)
        twice = link.with_added(link.mass, opposite, 0.0)  # as heavy, with its mass on the pin
        about = link.inertia * twice.mass / link.mass
        machine = machine.with_link(name, mass=link.mass, center_of_mass=twice.center_of_mass,
                                    inertia=about * link.mass / twice.mass)  # fmt: skip
    after = eq.analyze(machine, 720, acceleration=0.0).summary["joints.B"].peak
    assert 1 - after / before == pytest.approx(arms.gain, abs=2e-3)
    assert "With the centre of mass of arm 1, arm 2 on C, E" in said("rotary-transplanter")


def test_a_machine_without_such_arms_is_not_warned_of_any() -> None:
    for name in ("hydraulic-loader", "yamashita-1", "planetary-planting-arm"):
        assert beyond(name).arms is None


@pytest.mark.exhaustive(
    but=[
        "inline-3-rows-ends",
        "sieve-mounts",
        "quick-return-flywheels",
        "hydraulic-loader-cylinder",
    ]
)
@pytest.mark.parametrize(
    ("name", "key"),
    [
        ("planetary-planting-arm", "spaced"),
        ("inline-3-rows", "ends"),
        ("rotary-transplanter", "arms"),
        ("hydraulic-loader", "cylinder"),
        ("quick-return", "flywheels"),
        ("sieve", "mounts"),
    ],
)
def test_every_answer_is_in_the_machine_readable_output(name: str, key: str) -> None:
    """As it is declared, with nothing else and nothing missing; null elsewhere."""
    answers = advice_for(name).to_dict()
    assert set(answers[key]) == set(Beyond.declared[key].of or {})
    assert answers[key].get("gain", 1.0) > 0.0
    others = advice_for("straw-walker").to_dict()
    assert key in others and others[key] is None
    assert {*Beyond.declared} == {field.name for field in fields(Beyond)}


SIEVE = """
schema = 1
title = "Sieve on hangers"
[drive]
link = "eccentric"
speed = "420 rpm"
[frame.points]
O = ["0 mm", "0 mm"]
A = ["500 mm", "300 mm"]
[links.eccentric]
points = { O = ["0 mm", "0 mm"], P = ["15 mm", "0 mm"] }
mass = "4 kg"
center_of_mass = ["4 mm", "0 mm"]
inertia = "0.02 kg m^2"
[links.rod]
points = { P = ["0 mm", "0 mm"], C = ["600 mm", "0 mm"] }
mass = "3 kg"
center_of_mass = ["280 mm", "0 mm"]
inertia = "0.12 kg m^2"
[links.hanger]
points = { A = ["0 mm", "0 mm"], C = ["300 mm", "0 mm"] }
mass = "46 kg"
center_of_mass = ["300 mm", "0 mm"]
inertia = "1 kg m^2"
[assembly]
C = "right"
[support]
mass = "160 kg"
center_of_mass = ["900 mm", "-100 mm"]
inertia = "40 kg m^2"
[support.mounts]
left_x = { point = ["100 mm", "-400 mm"], direction = "0 deg", stiffness = "60 N/mm" }
left_y = { point = ["100 mm", "-400 mm"], stiffness = "220 N/mm", damping = "1500 N s/m" }
right_x = { point = ["1700 mm", "-400 mm"], direction = "0 deg", stiffness = "60 N/mm" }
right_y = { point = ["1700 mm", "-400 mm"], stiffness = "220 N/mm", damping = "1500 N s/m" }
"""
"""A sieve on hangers whose frame heaves near its resonance, and surges far above its own."""


def test_a_resonance_counts_for_the_gauges_that_read_its_mode() -> None:
    """Of surge, heave and pitch, as they are read where a support has no gauges."""
    machine = eq.loads(SIEVE)
    modes = Linear.of(machine).modes
    mode = min(modes, key=lambda item: abs(item.natural_frequency - machine.drive.speed))
    largest = abs(mode.shape).argmax()
    assert machine.support is not None
    names = list(machine.support.readings)
    assert names[largest] == "heave"
    heave = resonant_mounts_for(machine, [machine.drive.speed], ["heave"], lambda _: 0.5)
    assert heave is not None
    assert heave.mounts == ("left_y", "right_y")
    assert resonant_mounts_for(machine, [machine.drive.speed], ["surge"], lambda _: 0.5) is None
