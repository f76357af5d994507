"""Contacts of stops in runs: closed forms of a wheel that bounces, alone and beside another."""

from __future__ import annotations

from dataclasses import replace
from math import pi, sqrt

import numpy as np
import pytest

import equipoise as eq
from equipoise.mechanism import Machine, Stop
from equipoise.mechanism.dynamics.cam_contacts import let_go
from equipoise.mechanism.parts.belts import Belt
from equipoise.mechanism.parts.joint_properties import JointProperties
from equipoise.mechanism.parts.machine import FurtherDrive
from equipoise.mechanism.parts.run_plans import TimedLoad
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
    assert contact.part == "stops.1"
    assert contact.begin == pytest.approx(GAP / SPEED, rel=1e-9)
    assert contact.approach == pytest.approx(SPEED * RADIUS, rel=1e-6)
    # the pin leaves the line of the stop by a circle: 3 mm of pressing beside 200 mm
    assert contact.end == pytest.approx(contact.begin + pi * sqrt(mass / STIFFNESS), rel=1e-3)
    assert contact.force == pytest.approx(SPEED * RADIUS * sqrt(mass * STIFFNESS), rel=1e-3)
    assert run.crank_speed[-1] == pytest.approx(-SPEED, rel=1e-9)
    assert run.to_dict()["contacts"][0]["begin"] == contact.begin
    tables = "\n".join(map(str, run.blocks()))
    assert "Contacts of one-sided parts" in tables


def test_a_run_that_ends_on_a_stop_does_not_leave_it() -> None:
    run = eq.run(wheel(0.6), "0.202 s", speed=SPEED)
    (contact,) = run.contacts
    assert contact.end is None and contact.approach == pytest.approx(SPEED * RADIUS, rel=1e-6)
    later = eq.run(wheel(0.6), "0.4 s", speed=SPEED)
    assert later.contacts[0].begin == pytest.approx(contact.begin, rel=1e-9)
    assert later.crank_speed[-1] == pytest.approx(-0.6 * SPEED, rel=1e-2)


def beside_another(item: Machine) -> Machine:
    """The wheel, with another that turns on its own."""
    other = eq.Link({"Z": (0.0, 0.0)}, 1.0, (0.0, 0.0), 1.0)
    return replace(
        item,
        frame={**item.frame, "Z": (1.0, 0.0)},
        links={**item.links, "other": other},
        drives=(FurtherDrive("other", 5.0),),
        drive=replace(item.drive, free=True),
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
    first = wheel()
    run = eq.run(beside_another(first), "0.4 s", speed=SPEED)
    (contact,) = run.contacts
    alone = eq.run(first, "0.4 s", speed=SPEED).contacts[0]
    assert contact.begin == pytest.approx(alone.begin, rel=1e-7)
    assert contact.end == pytest.approx(alone.end, rel=1e-6)
    assert contact.force == pytest.approx(alone.force, rel=1e-3)


@pytest.mark.parametrize("several", [False, True])
def test_a_follower_lets_go_where_its_spring_is_too_weak(several: bool) -> None:
    """A flywheel keeps the speed, at which the analysis says between which crank angles contact is
    lost; friction in a pin makes what presses depend on forces.
    """
    speed = 700 * pi / 30
    machine = eq.load("cam-pusher")
    joints = (JointProperties("joints.C", radius=0.005, friction=0.1),)
    machine = replace(
        machine, drive=replace(machine.drive, speed=speed, flywheel=1e6), joints=joints
    )
    (lost,) = let_go(eq.analyze(machine).forces)
    ((down, up),) = lost.ranges
    run = eq.run(beside_another(machine) if several else machine, turns=1.2, speed=speed)
    first, second = run.contacts
    assert first.part == "cams.crank to pusher" and first.begin == 0 and first.approach is None
    assert first.end is not None and second.end is None
    # straight lines between instants of the run, and between 360 of the analysis
    assert [first.end * speed, second.begin * speed] == pytest.approx([down, up], abs=2e-3)
    assert "pusher on crank" in "\n".join(map(str, run.blocks()))


def test_a_strand_of_a_belt_goes_slack() -> None:
    """A torque that rises evenly turns the driven of two equal wheels: the belt's pull accelerates
    the other one, and takes half of itself off the tension of one strand.
    """
    radius, tension, rise = 0.1, 50.0, 100.0
    links = {name: eq.Link({point: (0.0, 0.0)}, 1.0, (0.0, 0.0), inertia)
             for name, point, inertia in (("driver", "A", 0.3), ("driven", "C", 0.1))}  # fmt: skip
    machine = eq.Machine(
        "belt", eq.Drive("driver", 1.0), {"A": (0.0, 0.0), "C": (0.5, 0.0)}, links,
        gravity=(0.0, 0.0),
        belts=(Belt("driver", "driven", radii=(radius, radius), tension=tension),),
        timed_loads=(TimedLoad("driven", times=(0.0, 1.0), factors=(0.0, 1.0), torque=rise),),
    )  # fmt: skip
    run = eq.run(machine, 0.5, speed=0.0)
    assert {contact.begin for contact in run.contacts} == {0.0}, "at rest, where forces are open"
    slack = 2 * tension * radius * (0.3 + 0.1) / 0.3 / rise
    ends = {contact.part: contact.end for contact in run.contacts}
    assert sum(end is None for end in ends.values()) == 1
    assert [end for end in ends.values() if end] == [pytest.approx(slack, rel=1e-9)]
    tight = max(contact.force for contact in run.contacts)
    assert tight == pytest.approx(tension + 0.5 * rise * 0.3 / 0.4 / radius / 2, rel=1e-9)
