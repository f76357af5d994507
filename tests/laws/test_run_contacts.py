"""Contacts of stops in runs: closed forms of a wheel that bounces, alone and beside another."""

from __future__ import annotations

from dataclasses import replace
from math import pi, sqrt

import numpy as np
import pytest

import equipoise as eq
from equipoise.mechanism import Machine, Stop
from equipoise.mechanism.parts.machine import FurtherDrive
from equipoise.mechanism.parts.support import Row

INERTIA, RADIUS, STIFFNESS, SPEED, GAP = 0.5, 0.2, 4e5, 3.0, 0.6
"""kg m2, m, N/m, rad/s and rad."""


def wheel(restitution: float | None = None) -> Machine:
    """A wheel without weight, whose pin comes at the crank angle `GAP` to a stop in its way."""
    link = eq.Link({"A": (0.0, 0.0), "B": (RADIUS, 0.0)}, 1.0, (0.0, 0.0), INERTIA)
    at = RADIUS * np.exp(1j * GAP)
    stop = Stop("wheel", "B", "S", direction=GAP - pi / 2, stiffness=STIFFNESS)
    if restitution is not None:
        stop = replace(stop, restitution=restitution, speed=SPEED * RADIUS)
    return eq.Machine("wheel", eq.Drive("wheel", SPEED), {"A": (0.0, 0.0), "S": (at.real, at.imag)},
                      {"wheel": link}, gravity=(0.0, 0.0), stops=(stop,))  # fmt: skip


def test_a_wheel_meets_a_stop_and_is_thrown_back() -> None:
    """It comes after angle over speed, stays for half of a swing on the spring of the stop, which
    bears speed times the root of stiffness and reduced mass, and loses nothing.
    """
    run = eq.run(wheel(), "0.4 s", speed=SPEED)
    (contact,) = run.contacts
    mass = INERTIA / RADIUS**2
    assert contact.stop == "stops.1"
    assert contact.begin == pytest.approx(GAP / SPEED, rel=1e-9)
    assert contact.approach == pytest.approx(SPEED * RADIUS, rel=1e-6)
    # the pin leaves the line of the stop by a circle: 3 mm of pressing beside 200 mm
    assert contact.end == pytest.approx(contact.begin + pi * sqrt(mass / STIFFNESS), rel=1e-3)
    assert contact.force == pytest.approx(SPEED * RADIUS * sqrt(mass * STIFFNESS), rel=1e-3)
    assert run.crank_speed[-1] == pytest.approx(-SPEED, rel=1e-9)
    assert run.to_dict()["contacts"][0]["begin"] == contact.begin
    tables = "\n".join(map(str, run.blocks()))
    assert "Contacts of stops" in tables


def test_a_run_that_ends_on_a_stop_does_not_leave_it() -> None:
    run = eq.run(wheel(0.6), "0.202 s", speed=SPEED)
    (contact,) = run.contacts
    assert contact.end is None and contact.approach == pytest.approx(SPEED * RADIUS, rel=1e-6)
    later = eq.run(wheel(0.6), "0.4 s", speed=SPEED)
    assert later.contacts[0].begin == pytest.approx(contact.begin, rel=1e-9)
    assert later.crank_speed[-1] == pytest.approx(-0.6 * SPEED, rel=1e-2)


def beside_another(one: Machine) -> Machine:
    """The wheel, with another that turns on its own."""
    other = eq.Link({"C": (0.0, 0.0)}, 1.0, (0.0, 0.0), 1.0)
    return replace(
        one,
        frame={**one.frame, "C": (1.0, 0.0)},
        links={**one.links, "other": other},
        drives=(FurtherDrive("other", 5.0),),
        drive=replace(one.drive, free=True),
    )


@pytest.mark.parametrize("several", [False, True])
def test_a_contact_is_that_of_the_row_that_meets_its_stop(several: bool) -> None:
    """The second of two wheels on a shaft, which is ahead of the other, throws both back."""
    ahead = 0.3
    machine = replace(wheel(), rows=(Row(), Row(phase=ahead)))
    run = eq.run(beside_another(machine) if several else machine, "0.25 s", speed=SPEED)
    (contact,) = run.contacts
    assert contact.row == 2
    assert contact.begin == pytest.approx((GAP - ahead) / SPEED, rel=1e-7)
    mass = 2 * INERTIA / RADIUS**2
    assert contact.force == pytest.approx(SPEED * RADIUS * sqrt(mass * STIFFNESS), rel=1e-3)
    assert "B to S, row 2" in "\n".join(map(str, run.blocks()))


def test_a_run_of_several_drives_has_them() -> None:
    one = wheel()
    run = eq.run(beside_another(one), "0.4 s", speed=SPEED)
    (contact,) = run.contacts
    alone = eq.run(one, "0.4 s", speed=SPEED).contacts[0]
    assert contact.begin == pytest.approx(alone.begin, rel=1e-7)
    assert contact.end == pytest.approx(alone.end, rel=1e-6)
    assert contact.force == pytest.approx(alone.force, rel=1e-3)
