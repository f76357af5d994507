"""A solver leaves what it is given as it was: cone programs, machines, tools and studies."""

from __future__ import annotations

from collections.abc import Callable
from copy import deepcopy
from dataclasses import fields, is_dataclass, replace
from typing import Any

import numpy as np
import pytest

import equipoise as eq
from equipoise.balancing.problem import Problem
from equipoise.handheld.design import design_tool
from equipoise.mechanism.parts.balance import AddedMass, Balance, Limit, Objective, Weight
from equipoise.schema.template import Template
from equipoise.studies.searching import search

CRANK = AddedMass("crank", "A", Weight("any", 0.06, at_most=0.8))
PLAN = Balance(
    masses=(CRANK,),
    objectives=(Objective("drive_torque", "peak"),),
    limits=(Limit(Objective("joints.D", "peak"), ratio=1.02),),
)
"""Whose rows of peaks are added while it is solved."""


def content(value: Any) -> Any:
    """What a value holds, by its fields, so that two of them can be compared."""
    if isinstance(value, np.ndarray):
        return value.shape, value.tobytes()
    if is_dataclass(value) and not isinstance(value, type):
        return {field.name: content(getattr(value, field.name)) for field in fields(value)}
    if isinstance(value, dict):
        return {key: content(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [content(item) for item in value]
    return value


def test_a_cone_program_stays_as_it_is() -> None:
    """Rows that a solution breaks are added to a copy."""
    program = Problem.of(eq.load("yamashita-1"), PLAN).built.program
    before = deepcopy(content(program))
    first = program.solve()
    assert first.cuts, "no rows were added, so that nothing is shown"
    assert content(program) == before
    again = program.solve()
    assert np.array_equal(again.x, first.x) and again.value == first.value


def geared() -> eq.Machine:
    """With few choices of gears."""
    machine = eq.load("balance-geared-a")
    assert machine.balance is not None
    (weight,) = machine.balance.geared
    few = replace(machine.balance, geared=(replace(weight, ratio=(1.0, 1.0)),))
    return machine.with_balance(few)


def study() -> eq.studies.Study:
    vary = eq.design.Variable("links.crank.mass", eq.design.Range(0.1, 0.3))
    return eq.studies.Study(
        title="",
        model=Template.load("yamashita-1"),
        vary=(vary,),
        outputs=(eq.studies.Output("drive_torque.rms", make="smallest"),),
        sampling=eq.studies.Sampling("sobol", 16),
    )


@pytest.mark.parametrize(
    ("given", "solve"),
    [
        pytest.param(lambda: eq.load("yamashita-1"), lambda m: eq.balance(m, PLAN), id="masses"),
        pytest.param(geared, eq.balance, id="gears"),
        pytest.param(
            lambda: eq.load("walking-transplanter"),
            lambda m: eq.balancing.choose_phases(m, [Objective("shaking_force")]),
            id="phases",
        ),
        pytest.param(lambda: eq.load("brush-cutter"), design_tool, id="tool"),
        pytest.param(study, lambda s: search(s, population=8, generations=2), id="study"),
    ],
)
def test_what_is_solved_stays_as_it_is(
    given: Callable[[], Any], solve: Callable[[Any], Any]
) -> None:
    model = given()
    before = deepcopy(model)
    solve(model)
    assert content(model) == content(before) == content(given())
