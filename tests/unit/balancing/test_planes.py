"""Counterweights in two planes of a shaft."""

from __future__ import annotations

from math import cos, radians, sin

import numpy as np
import pytest

import equipoise as eq
from equipoise.mechanism.balance import AddedMass, Balance, Objective, Weight
from equipoise.mechanism.bodies import Body
from equipoise.mechanism.model import Drive, Link, Machine
from equipoise.mechanism.parts import Bearing

UNBALANCES = ((8.0, 0.3, 0.0, 0.0), (6.0, 0.2, 90.0, 0.4), (5.0, 0.4, 200.0, 0.9))
"""Mass (kg), radius (m), direction (deg) and plane (m) of what is eccentric on a shaft."""
PLANES = (0.1, 0.8)


def eccentric(mass: float, radius: float, direction: float, plane: float) -> Body:
    there = radius * cos(radians(direction)), radius * sin(radians(direction))
    return Body("point", at=there, mass=mass, plane=plane)


def rotor(*more: Body) -> Machine:
    """Return a shaft in two bearings with what is eccentric on it."""
    bodies = (*(eccentric(*one) for one in UNBALANCES), *more)
    return Machine(
        title="rotor",
        drive=Drive("shaft", 40.0),
        frame={"A": (0.0, 0.0)},
        links={"shaft": Link({"A": (0.0, 0.0)}, bodies=bodies)},
        gravity=(0.0, 0.0),
        bearings={"left": Bearing("shaft", -0.1), "right": Bearing("shaft", 1.0)},
    )


def textbook() -> list[complex]:
    """Return the two unbalances (kg m) by moments about each balancing plane in turn: Dalby's
    method of the reference plane, The Balancing of Engines, 1902.
    """
    given = [(mass * radius * np.exp(1j * radians(way)), z) for mass, radius, way, z in UNBALANCES]
    left, right = PLANES
    return [
        -sum(one * (z - right) for one, z in given) / (left - right),
        -sum(one * (z - left) for one, z in given) / (right - left),
    ]


def test_textbook_weights_leave_nothing() -> None:
    """To rounding: no force in either bearing at any angle."""
    weights = [
        Body("point", at=(moment.real / 2, moment.imag / 2), mass=2.0, plane=plane)
        for moment, plane in zip(textbook(), PLANES, strict=True)
    ]
    before, after = eq.analyze(rotor(), 24), eq.analyze(rotor(*weights), 24)
    for name in ("bearings.left", "bearings.right", "shaking_force", "rocking_moment"):
        assert after.summary[name].peak < 1e-13 * before.summary[name].peak


@pytest.mark.parametrize(
    "wanted", [("shaking_force", "rocking_moment"), ("bearings.left", "bearings.right")]
)
def test_balance_finds_them(wanted: tuple[str, str]) -> None:
    """Whether the frame or both bearings are to be quiet; to the digits of the solver."""
    plan = Balance(
        masses=[
            AddedMass("shaft", "A", Weight("point", 0.25, at_most=40.0, plane=z)) for z in PLANES
        ],
        objectives=[Objective(name) for name in wanted],
    )
    found = eq.balance(rotor().with_balance(plan))
    added = found.machine.links["shaft"].bodies[len(UNBALANCES) :]
    assert [body.plane for body in added] == [*PLANES]
    for body, moment in zip(added, textbook(), strict=True):
        assert body.mass * complex(*body.at) == pytest.approx(moment, rel=1e-7)
    for name in wanted:
        assert eq.analyze(found.machine, 24).summary[name].peak < 1e-3


def test_a_weight_beside_a_link_of_numbers_makes_bodies_of_it() -> None:
    """Its own mass becomes one of them."""
    machine = rotor().with_link("shaft", mass=2.0, center_of_mass=(0.01, 0.0), inertia=0.3)
    machine = machine.with_link("shaft", plane=0.2)
    plan = Balance(
        masses=[AddedMass("shaft", "A", Weight("point", 0.1, at_most=5.0, plane=0.5))],
        objectives=[Objective("shaking_force")],
    )
    own, added = eq.balance(machine.with_balance(plan)).machine.links["shaft"].bodies
    assert (own.mass, own.at, own.inertia, own.plane) == (2.0, (0.01, 0.0), 0.3, None)
    assert added.plane == 0.5
    assert added.mass * complex(*added.at) == pytest.approx(-0.02, rel=1e-7)
