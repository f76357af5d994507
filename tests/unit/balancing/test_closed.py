"""First moments in closed form against the cone program, which must find the same: 1e-8."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import equipoise as eq
from equipoise.balancing.optimisation import balance
from equipoise.balancing.problem import Problem
from equipoise.balancing.solution import closed_form
from equipoise.mechanism.balance import (
    AddedMass,
    Balance,
    CenterMove,
    Limit,
    Objective,
    SpringChoice,
    Weight,
)

MACHINE = eq.load("yamashita-1")
GIVEN = AddedMass("crank", "A", Weight("point", mass=1.0))
SPREAD = AddedMass("rocker", "D", Weight("any", mass=0.4))
MOVE = CenterMove("coupler")
LIFT = Objective("shaking_force.y", "ripple")
FORCE = Objective("shaking_force")

PLANS = {
    "a moved centre": Balance(moves=(MOVE,), objectives=(LIFT,)),
    "a weight": Balance(masses=(GIVEN,), objectives=(FORCE,)),
    "both": Balance(masses=(GIVEN, SPREAD), moves=(MOVE,), objectives=(LIFT,)),
    "a joint": Balance(moves=(CenterMove("crank"),), objectives=(Objective("joints.A", "rms"),)),
    "squares of two": Balance(
        masses=(GIVEN,),
        moves=(MOVE,),
        objectives=(replace(LIFT, weight=2.0), Objective("shaking_force.x")),
        combine="squares",
    ),
}


@pytest.mark.parametrize("name", PLANS)
def test_the_cone_program_finds_the_same(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    found = balance(MACHINE, PLANS[name])
    assert (found.method, found.gap, found.looked_at) == ("closed form", 0.0, 0)
    monkeypatch.setattr("equipoise.balancing.solution.closed_form", lambda problem: None)
    program = balance(MACHINE, PLANS[name])
    assert program.method == "cone program"
    assert found.cost == pytest.approx(program.cost, abs=1e-8)
    assert found.cost <= program.cost + 1e-12
    assert program.bound <= found.cost + 1e-9


def test_the_least_squares_is_flat_there() -> None:
    """Any step of the coupler's centre makes it worse."""
    found = balance(MACHINE, PLANS["a moved centre"])
    x, y = found.machine.links["coupler"].center_of_mass
    for step in np.exp(1j * np.arange(0, 6, 0.5)) * 1e-4:
        place = (x + step.real, y + step.imag)
        beside = MACHINE.with_link("coupler", center_of_mass=place)
        assert Problem.value_of(beside, LIFT) > found.objectives[LIFT.name][1]


LIMITED = {
    "a limit": {"limits": (Limit(FORCE, ratio=2.0),)},
    "a sum of two": {"objectives": (LIFT, FORCE)},
    "a peak": {"objectives": (Objective("shaking_force.y", "peak"),)},
    "a room": {"masses": (AddedMass("crank", "A", Weight("point", 0.05, mass=1.0)),)},
    "an open mass": {"masses": (AddedMass("crank", "A", Weight("point", 0.05, at_most=1.0)),)},
    "a most of all mass": {"added_mass": 2.0},
    "a box": {"moves": (CenterMove("coupler", x=(-0.05, 0.05), y=(-0.05, 0.05)),)},
    "a disc": {
        "masses": (
            AddedMass("crank", "A", Weight("disc", 0.1, thickness=0.01, density=7850.0, mass=0.1)),
        )
    },
    "a spring": {"springs": (SpringChoice("rocker", "C", "A", 100.0),)},
    "inertia that counts": {"objectives": (Objective("shaking_moment"),)},
}


@pytest.mark.parametrize("why", LIMITED)
def test_there_is_none_with(why: str) -> None:
    plan = replace(PLANS["both"], **LIMITED[why])
    assert closed_form(Problem.of(MACHINE, plan)) is None
    assert closed_form(Problem.of(MACHINE, PLANS["both"])) is not None
