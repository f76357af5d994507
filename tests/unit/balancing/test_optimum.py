"""Refusals, prices of single limits, and the choice among equally good changes."""

from __future__ import annotations

import pytest

import equipoise as eq
from equipoise.balancing.balanced import Balanced, Price
from equipoise.errors import MassError, ModelError, UsageError
from equipoise.mechanism.balance import (
    AddedMass,
    Balance,
    CenterMove,
    Objective,
    SpringChoice,
    Weight,
)

MACHINE = eq.load("yamashita-1")
CRANK = AddedMass("crank", "A", Weight("any", 0.06, at_most=0.8))
LIFT = Objective("shaking_force.y", "ripple")
PLAN = Balance(masses=(CRANK,), objectives=(LIFT,))


@pytest.mark.parametrize(
    ("machine", "plan", "error", "words"),
    [
        (MACHINE, None, UsageError, "nothing is free to change"),
        (MACHINE, Balance(objectives=(LIFT,)), UsageError, "nothing is free to change"),
        (MACHINE, Balance(masses=(CRANK,)), UsageError, "nothing is to become small"),
        (MACHINE.with_drive(speed=0.0), PLAN, UsageError, "stands still"),
        (
            MACHINE,
            Balance(masses=(CRANK,), objectives=(Objective("joints.D"),)),
            UsageError,
            "nothing that is free to change has an effect on the rms of joints.D",
        ),
        (
            MACHINE,
            Balance(springs=(SpringChoice("rocker", "C", "A", 9.0),), objectives=(LIFT,)),
            UsageError,
            "has an effect on the ripple of shaking_force.y",
        ),
        (MACHINE, Balance(moves=(CenterMove("fork"),), objectives=(LIFT,)), ModelError, "fork"),
        (
            MACHINE.with_link("rocker", mass=None, center_of_mass=None, inertia=None),
            PLAN,
            MassError,
            "rocker",
        ),
    ],
)
def test_refusals(
    machine: eq.Machine, plan: Balance | None, error: type[Exception], words: str
) -> None:
    with pytest.raises(error, match=words):
        eq.balance(machine, plan)


def test_the_least_mass_of_equally_good_ones_is_taken() -> None:
    """A limit that is met with less: the first order of y alone takes one first moment."""
    wish = Objective("shaking_force.y", "rms", (1.0,))
    found = eq.balance(MACHINE, Balance(masses=(CRANK,), objectives=(wish,)))
    change = found.changes[0].values
    assert change["mass"] < 0.8
    assert change["moment"] == pytest.approx(0.06 * change["mass"], rel=1e-4)


def test_price_of_one_objective_is_in_its_unit() -> None:
    """N for each kg; the weight of the only objective does not count."""
    rms = Objective("shaking_force", "rms", weight=3.0)

    def force(most: float) -> Balanced:
        weight = AddedMass("crank", "A", Weight("any", 0.06, at_most=most))
        return eq.balance(MACHINE, Balance(masses=(weight,), objectives=(rms,)))

    values = [force(0.2 + step).objectives[rms.name][1] for step in (1e-4, -1e-4)]
    price = force(0.2).prices["mass on crank"]
    assert price.price == pytest.approx((values[1] - values[0]) / 2e-4, rel=1e-4)
    assert price.active
    assert price.used == pytest.approx(0.2)
    assert not Price(1.0, 0.5, 0.0).active


@pytest.mark.parametrize("shape", ["disc", "ring"])
def test_price_of_mass_cut_from_a_plate(shape: str) -> None:
    """Inertia grows with the square of the mass."""
    torque = Objective("drive_torque", "rms")

    def at(most: float) -> Balanced:
        inner = {"inner_radius": 0.01} if shape == "ring" else {}
        weight = Weight(shape, 0.05, thickness=0.008, density=7850.0, at_most=most, **inner)  # type: ignore[arg-type]
        return eq.balance(
            MACHINE, Balance(masses=(AddedMass("rocker", "D", weight),), objectives=(torque,))
        )

    values = [at(0.15 + step).objectives[torque.name][1] for step in (1e-3, -1e-3)]
    price = at(0.15).prices["mass on rocker"].price
    assert price == pytest.approx((values[1] - values[0]) / 2e-3, rel=1e-3)
