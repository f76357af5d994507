"""Balancing with friction in joints, which makes outputs nonlinear in the masses."""

from __future__ import annotations

from dataclasses import replace
from typing import Literal

import numpy as np
import pytest

import equipoise as eq
from equipoise.balancing.problem import Problem
from equipoise.mechanism.parts.balance import (
    AddedMass,
    Balance,
    CenterMove,
    Limit,
    Objective,
    Weight,
)

PUMP = eq.load("plunger-pump")
# with more friction than a pump would have, so that it matters where masses are
RUBBING = replace(
    PUMP,
    joints=tuple(replace(joint, friction=4 * (joint.friction or 0.0)) for joint in PUMP.joints),
)
SECTOR = Weight("sector", radius=0.034, thickness=0.012, density=7850.0)


@pytest.mark.parametrize("measure", ["rms", "peak"])
def test_no_place_nearby_is_better(measure: Literal["rms", "peak"]) -> None:
    """Of centres of mass about that of the result, each with the friction that it has itself."""
    objective, box = Objective("joints.A", measure), (-0.02, 0.02)
    plan = Balance(moves=(CenterMove("crank", x=box, y=box),), objectives=(objective,))

    def value_at(place: complex) -> float:
        moved = RUBBING.with_link("crank", center_of_mass=(place.real, place.imag))
        return Problem.value_of(moved, objective)

    balanced = eq.balance(RUBBING, plan)
    without = eq.balance(RUBBING.without_friction(), plan)
    own, other = (complex(*found.changes[0].values["to"]) for found in (balanced, without))
    after = value_at(own)
    assert after == pytest.approx(balanced.objectives[objective.name][1], rel=1e-9)
    assert after < value_at(other) * (1 + 1e-9)
    around = [own + radius * np.exp(1j * np.arange(5)) for radius in (1e-4, 1e-3)]
    inside = [place for place in np.concatenate(around) if abs(place.real) < 0.02 > abs(place.imag)]
    assert len(inside) > 3
    # each step takes friction for known, so that its own change with the masses is left out
    assert after <= min(map(value_at, inside)) * (1 + 1e-4)


def test_limits_are_kept_with_friction() -> None:
    """Of a force that was 0.8 % above its limit while the optimum was computed without friction."""
    limited = Objective("joints.A", "peak")
    plan = Balance(
        masses=(AddedMass("crank", "A", SECTOR),),
        objectives=(Objective("drive_torque"),),
        limits=(Limit(limited, ratio=1.0),),
    )
    for machine in (PUMP, RUBBING):
        balanced = eq.balance(machine, plan)
        before = Problem.value_of(machine, limited)
        assert Problem.value_of(balanced.machine, limited) <= before * (1 + 1e-7)
        assert balanced.gap < 1e-6
        assert balanced.cost < 1
        (note,) = (note for note in balanced.notes if "nonlinear" in note)
        assert "drive_torque and joints.A" in note
