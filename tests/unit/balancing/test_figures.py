"""Figures before and after, against analyses, responses and the planting figures."""

from __future__ import annotations

from dataclasses import replace
from math import pi

import numpy as np
import pytest

import equipoise as eq
from equipoise.balancing.figures import (
    equivalent_speeds,
    figures_of,
    planting_kept,
    signal_columns,
)
from equipoise.mechanism.balance import AddedMass, Balance, Objective, Weight

MACHINE = eq.load("yamashita-1")
LIFT = Objective("shaking_force.y", "ripple")


def test_equivalent_speed_of_what_is_gone() -> None:
    before = {"shaking_force.rms": 4.0, "shaking_moment.rms": 1.0, "drive_torque.rms": 2.0}
    after = {"shaking_force.rms": 1.0, "shaking_moment.rms": 1e-17, "drive_torque.rms": 1.0}
    assert equivalent_speeds(before, after, 10.0) == {"shaking_force.rms": 20.0}


def test_columns_cover_the_longer_cycle() -> None:
    """A shaft that is back after two turns."""
    gear = eq.Gear("crank", "wheel", ratio=-0.5)
    wheel = eq.Link({"W": (0.0, 0.0)}, 0.1, (0.01, 0.0), 1e-5)
    geared = replace(
        MACHINE,
        frame={**MACHINE.frame, "W": (0.1, 0.1)},
        links={**MACHINE.links, "wheel": wheel},
        gears=(gear,),
    )
    columns = signal_columns(MACHINE, geared)
    assert all(len(values) == 1440 for _, _, values in columns)
    before = {name: values for name, _, values in columns}["shaking_force.x.before"]
    assert before[:720] == pytest.approx(before[720:], abs=1e-9)


def test_planting_stays_as_it_is() -> None:
    machine = eq.load("transplanter")
    drive = machine.drive.link
    at = next(iter(machine.links[drive].points))
    plan = Balance(
        masses=(AddedMass(drive, at, Weight("any", 0.05, at_most=0.5)),), objectives=(LIFT,)
    )
    found = eq.balance(machine, plan)
    assert found.planting_kept is True
    assert any(name.startswith("planting.") for name in found.before)
    off = {name: value * (1 + 1e-6) for name, value in found.after.items()}
    assert planting_kept(found.before, off) is False
    assert planting_kept(found.before, {}) is False
    assert planting_kept({"mass": 1.0}, {"mass": 2.0}) is None


def test_figures_of_gauges_and_rows() -> None:
    machine = eq.load("riding-transplanter")
    figures = figures_of(machine)
    gauge = eq.respond(machine).gauges["roll"].displacement
    assert figures["gauges.roll.peak_to_peak"] == pytest.approx(gauge.peak_to_peak)
    angles = np.arange(720) * pi / 360
    force = sum(
        eq.forces(eq.move(machine, angles + row.phase, acceleration=0.0)).shaking_force.value
        for row in machine.rows
    )
    assert figures["rows.shaking_force.rms"] == pytest.approx(np.sqrt(np.mean(np.abs(force) ** 2)))
