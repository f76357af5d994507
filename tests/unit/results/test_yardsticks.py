"""What is large on a machine: figures against their yardsticks, and how these are declared."""

from __future__ import annotations

import re
from dataclasses import replace
from math import hypot, radians
from pathlib import Path

import numpy as np
import pytest

import equipoise as eq
import support.findings
from equipoise.mechanism.outputs.declared import DECLARED, declaring, output
from equipoise.mechanism.parts.balance import Balance, Limit, Objective
from equipoise.results.rotors import STEADY, speed_fluctuation
from equipoise.results.yardsticks import OF_OUTPUT, FigureAssessment, assess, sentence, verdict
from equipoise.running.equation import CrankEquation
from equipoise.running.flywheel import SteadyCycle
from equipoise.schema.files import json_text
from support.chosen import DISTINCT, few

WITH_GAUGES = ("riding-transplanter", "sieve")


def assessed(machine: eq.Machine) -> dict[str, FigureAssessment]:
    readings = eq.respond(machine).gauges if machine.support is not None else None
    return {item.figure: item for item in assess(eq.analyze(machine), readings)}


def pump() -> eq.Machine:
    """Without loads and support."""
    return eq.load("scotch-yoke")


@pytest.mark.parametrize(
    ("name", "figure"),
    [
        ("hydraulic-loader", "drive_force.peak"),
        ("twin-engine", "rocking_moment.peak"),
        ("cam-pusher", "shaking_moment.peak"),
        ("quick-return", "drive_torque.peak_to_peak"),
        ("sieve", "gauges.stand_along.velocity.rms"),
        ("scotch-yoke", "shaking_force.peak"),
    ],
)
def test_each_machine_has_the_verdict_of_its_kind(name: str, figure: str) -> None:
    """By what its outputs declare: nothing knows these machines."""
    result = verdict(tuple(assessed(eq.load(name)).values()))
    assert result is not None and result.figure == figure


def test_a_follower_that_lifts_off_is_the_verdict() -> None:
    """From its lift-off speed of 583 rpm on, and not below it."""
    machine = eq.load("cam-pusher")
    for rpm, figure in ((580, "shaking_moment.peak"), (590, "cams.crank to pusher.lift_off_speed")):
        result = verdict(tuple(assessed(machine.with_drive(speed=f"{rpm} rpm")).values()))
        assert result is not None and result.figure == figure


@pytest.mark.parametrize("name", few(sorted(eq.examples("linkage")), DISTINCT))
def test_figures_are_those_of_the_machine_readable_output(name: str) -> None:
    machine = eq.load(name)
    analysis = eq.analyze(machine)
    values = analysis.to_dict()
    readings = eq.respond(machine) if name in WITH_GAUGES else None
    result = assess(analysis, readings and readings.gauges)
    assert result and [item.excess for item in result] == sorted(
        (e.excess for e in result), reverse=True
    )
    for entry in result:
        name, _, measure = entry.figure.rpartition(".")
        if entry.output.startswith("gauges."):
            assert readings is not None
            velocity = readings.to_dict()["gauges"][entry.item]["velocity"]
            assert entry.value == pytest.approx(velocity["rms"])
        elif (table := entry.output.partition(".")[0]) in ("sections", "rolling_bearings"):
            assert entry.value == values[table][entry.item][measure]
        elif entry.is_contact:
            assert entry.value == values["cams"][entry.item]["lift_off_speed"]
        else:
            figures = values["summary"][name]
            assert entry.value == pytest.approx(figures[measure], rel=1e-12)
            if entry.crank_angle is None:  # of the mean torque beside that of the motor
                continue
            places = [figures[place] for place in ("peak_at", "max_at", "min_at")]
            assert entry.crank_angle in places
    json_text([item.to_dict() for item in result])


def test_a_force_that_shakes_is_measured_by_the_weight() -> None:
    """Which is the acceleration of the common centre of mass over gravity."""
    result = assessed(pump())["shaking_force.peak"]
    acceleration = eq.analyze(pump()).outputs
    ax, ay = (acceleration[f"mass_center.{axis}"].values for axis in ("ax", "ay"))
    assert result.ratio == pytest.approx(np.max(np.hypot(ax, ay)) / 9.80665)
    flat = assessed(replace(pump(), gravity=(0.0, 0.0)))["shaking_force.peak"]
    assert flat.ratio == pytest.approx(result.ratio)
    assert (result.unit, str(result.against)) == ("N", "the weight of the moving links")


def test_a_load_that_is_larger_takes_the_place_of_the_weight() -> None:
    """Not one that the frame bears: it does not shake the machine."""
    machine = pump()
    link = machine.sliders[0].link
    point = next(iter(machine.links[link].points))
    load = eq.Load(link, point, force=(3e4, 4e4))
    loaded = assessed(replace(machine, loads=(load,)))["shaking_force.peak"]
    inside = assessed(replace(machine, loads=(replace(load, reaction="frame"),)))
    assert loaded.yardstick == pytest.approx(5e4 / 4)
    assert str(loaded.against) == "a quarter of the largest load"
    assert inside["shaking_force.peak"].yardstick == pytest.approx(9.80665 * machine.mass)


def test_a_couple_is_measured_over_the_span_of_the_bearings() -> None:
    machine = eq.load("twin-engine")
    result = assessed(machine)["rocking_moment.peak"]
    planes = [bearing.plane for bearing in machine.bearings.values()]
    span = max(planes) - min(planes)
    rocking = eq.analyze(machine).forces.across.rocking_moment.value
    pair = np.max(np.abs(rocking)) / span
    assert result.ratio == pytest.approx(pair / (9.80665 * machine.mass))


def test_a_torque_is_measured_by_its_mean_where_there_is_work_to_do() -> None:
    analysis = eq.analyze(eq.load("quick-return"))
    torque = analysis.summary["drive_torque"]
    actual = {item.figure: item for item in assess(analysis)}["drive_torque.peak_to_peak"]
    assert actual.ratio == pytest.approx(torque.peak_to_peak / abs(torque.mean))
    idle = assessed(pump())["drive_torque.peak_to_peak"]
    assert idle.yardstick > 0 and str(idle.against) != "its mean"


NEAR_A_DEAD_POSITION = """schema = 1
title = "Swings near its dead positions"
[drive]
link = "crank"
speed = "200 rpm"
motion = { between = ["-181.9 deg", "21.9 deg"] }
[frame.points]
A = ["0 mm", "0 mm"]
D = { distance = "90 mm", direction = "-80 deg" }
[links.crank]
points = { A = ["0 mm", "0 mm"], B = ["100 mm", "0 mm"] }
mass = "200 g"
center_of_mass = ["12 mm", "0 mm"]
inertia = "30 kg mm^2"
[links.coupler]
points = { B = ["0 mm", "0 mm"], C = ["72 mm", "0 mm"] }
mass = "690 g"
center_of_mass = ["-50 mm", "-20 mm"]
inertia = "1500 kg mm^2"
[links.rocker]
points = { D = ["0 mm", "0 mm"], C = ["80 mm", "0 mm"] }
mass = "260 g"
center_of_mass = ["32 mm", "0 mm"]
inertia = "300 kg mm^2"
[assembly]
C = "left"
"""


def test_what_samples_leave_of_a_mean_of_nothing_is_no_yardstick() -> None:
    analysis = eq.analyze(eq.loads(NEAR_A_DEAD_POSITION))
    torque = analysis.summary["drives.crank.torque"]
    assert 0 < abs(torque.mean) < 0.01 * torque.rms  # no load does work: the true mean is 0
    actual = {item.figure: item for item in assess(analysis)}["drives.crank.torque.peak_to_peak"]
    assert str(actual.against) != "its mean"


def test_limits_of_gauges_are_their_yardsticks() -> None:
    """Those that the file gives; the velocity without one."""
    machine = eq.load("sieve")
    gauge = eq.respond(machine).gauges["stand"].displacement
    limit = Limit(Objective("gauges.stand", "ripple"), at_most=1e-4)
    result = assessed(machine.with_balance(Balance(limits=(limit,))))
    first = result["gauges.stand.rms"]
    assert first.is_limit and first.ratio == pytest.approx(float(gauge.vibration_rms) / 1e-4)
    assert "gauges.stand.velocity.rms" not in result
    assert "gauges.stand_along.velocity.rms" in result
    assert verdict(tuple(result.values())) is first


def test_a_linkage_without_masses_has_its_angles() -> None:
    machine = eq.load("yamashita-1")
    links = {name: replace(link, mass=None, center_of_mass=None, inertia=None)
             for name, link in machine.links.items()}  # fmt: skip
    result = assessed(replace(machine, links=links))
    assert [*result] == ["transmission.C.min"]
    (first,) = result.values()
    assert first.ratio == pytest.approx((radians(90) - first.value) / radians(50))


def test_an_output_is_assessed_where_it_is_declared_to_be() -> None:
    with declaring():
        output("thrust", "force", "thrust", yardstick="weight")(
            lambda result: result.forces.shaking_force.x
        )
        actual = assessed(pump())
    shaking = eq.analyze(pump()).forces.shaking_force.x
    assert actual["thrust.peak"].value == pytest.approx(np.max(np.abs(shaking)))
    declared = {value.yardstick for value in DECLARED.values()} - {""}
    assert declared == {*OF_OUTPUT, "vibration"}


def test_of_rows_all_together_count() -> None:
    """And the support is a part of what is shaken."""
    machine = eq.load("riding-transplanter")
    result = assessed(machine)
    assert "shaking_force.peak" not in result and "drive_torque.peak_to_peak" not in result
    support = machine.support
    assert support is not None
    weight = (4 * machine.mass + support.mass) * hypot(*machine.gravity)
    assert result["rows.shaking_force.peak"].yardstick == pytest.approx(weight)


def test_figures_beside_their_yardsticks_in_words() -> None:
    said = {value.figure: sentence(value) for value in assessed(eq.load("twin-engine")).values()}
    assert said["rocking_moment.peak"] == (
        "Rocking moment, peak: 116 N m at crank angle 90.0°, 32 times the weight of the moving "
        "links at the span"
    )
    share = "16 % of the weight of the moving links at the span"
    assert said["shaking_moment.peak"].endswith(share)
    angles = assessed(eq.load("cam-pusher"))
    assert sentence(angles["transmission.C.min"]) == (
        "Transmission angle at C, smallest: 29.7° at crank angle 270.0°; the usual limit: 40.0°"
    )
    lift_off = sentence(angles["cams.crank to pusher.lift_off_speed"])
    assert lift_off.endswith("; the speed of the crank: 240 rpm")


def test_a_figure_and_its_limit_stand_in_one_unit() -> None:
    """A gauge that moves 4.7 mm, with limits of 80 nm, 80 micrometres and 12 m."""
    machine = eq.load("sieve")
    for most in (80e-9, 80e-6, 12.0):
        aim = Objective("gauges.stand", "peak_to_peak")
        limited = machine.with_balance(Balance(limits=(Limit(aim, at_most=most),)))
        words = sentence(assessed(limited)["gauges.stand.peak_to_peak"])
        units = re.findall(r"[\d.]+(?:e[+-]\d+)? (\S?m)\b", words)
        assert len(units) == 2 and len({*units}) == 1, words


def test_a_torque_that_loads_swing_is_judged_by_their_work() -> None:
    """A press whose links weigh more at its throw than its mean torque is; turned without its load
    it only swings its links.
    """
    press = eq.load(Path(support.findings.__file__).parent / "advised" / "stamping-press.toml")
    result = assessed(press)["drive_torque.peak_to_peak"]
    assert str(result.against) == "its mean" and result.yardstick < 60 < result.ratio
    idle = assessed(replace(press, loads=()))["drive_torque.peak_to_peak"]
    assert str(idle.against) == "the weight of the moving links at the throw of the crank"


def test_a_torque_that_the_flywheel_evens_out_is_not_large() -> None:
    """By what turns, held against the steady state itself; without the flywheel it is large."""
    machine = eq.load("air-compressor")
    analysis = eq.analyze(machine)
    exact = SteadyCycle(CrankEquation(machine)).fluctuation
    # of 360 crank angles, and of a speed that is taken as even for the mean
    assert speed_fluctuation(analysis) == pytest.approx(exact, rel=5e-3)
    first = verdict(assess(analysis))
    assert first is not None and first.output != "drive_torque"
    (torque,) = (entry for entry in assess(analysis) if entry.output == "drive_torque")
    assert torque.ratio == pytest.approx(exact / STEADY, rel=5e-3)
    assert sentence(torque).endswith("it is 4.0 %")
    light = eq.analyze(replace(machine, drive=replace(machine.drive, flywheel=0.0)))
    first = verdict(assess(light))
    assert first is not None and first.output == "drive_torque" and first.is_swing_about_mean


def test_the_fluctuation_where_the_reduced_inertia_varies() -> None:
    """What the mean speed leaves open is an energy, and no square of a speed: beside a flywheel of
    30 and 8 times the mean of an inertia that changes over the cycle.
    """
    machine = eq.load("geared-counterweight")
    own = float(np.mean(CrankEquation(machine).table.values[0]))
    for share, close in ((30, 2e-3), (8, 5e-3)):
        heavy = replace(machine, drive=replace(machine.drive, flywheel=share * own))
        exact = SteadyCycle(CrankEquation(heavy)).fluctuation
        assert speed_fluctuation(eq.analyze(heavy)) == pytest.approx(exact, rel=close)
