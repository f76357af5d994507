"""What is told where nothing meets all limits."""

from __future__ import annotations

import re

import pytest

import equipoise as eq
from equipoise.errors import UsageError
from equipoise.mechanism.balance import AddedMass, Balance, Limit, Measure, Objective, Weight

MACHINE = eq.load("yamashita-1")
CRANK = AddedMass("crank", "A", Weight("point", 0.05, at_most=0.9))
FORCE = Objective("shaking_force")


def limit(output: str, measure: Measure, **much: float) -> Limit:
    return Limit(Objective(output, measure), **much)


def refusal(*limits: Limit, **more: object) -> str:
    plan = Balance(masses=(CRANK,), objectives=(FORCE,), limits=limits, **more)  # type: ignore[arg-type]
    with pytest.raises(UsageError) as caught:
        eq.balance(MACHINE, plan)
    return str(caught.value)


def least_of(objective: Objective, *limits: Limit) -> float:
    plan = Balance(masses=(CRANK,), objectives=(objective,), limits=limits)
    return eq.balance(MACHINE, plan).objectives[objective.name][1]


def told_number(text: str) -> float:
    found = re.search(r"can become ([\d.e+-]+) ", text)
    assert found is not None, text
    return float(found[1])


def test_one_that_cannot_be_met() -> None:
    """With how small it can become at the least, which another program finds as well."""
    text = refusal(limit("shaking_force", "peak", ratio=0.01))
    assert text.startswith(
        "this limit cannot be met: peak of shaking_force at most 1 % of before; "
        "peak of shaking_force can become "
    )
    assert text.endswith(" N at the least")
    least = least_of(Objective("shaking_force", "peak"))
    assert told_number(text) == pytest.approx(least, rel=1e-3)


def test_absolute_limits_have_units() -> None:
    text = refusal(limit("joints.A", "peak", at_most=0.5))
    assert "peak of joints.A at most 0.5 N;" in text


def test_two_that_clash() -> None:
    """Each alone can be met, and a third that is harmless is not named."""
    x = limit("shaking_force.x", "rms", at_most=2.9)
    y = limit("shaking_force.y", "rms", ratio=0.26)
    harmless = limit("drive_torque", "peak", ratio=50.0)
    text = refusal(harmless, x, y)
    for one in (x, y):
        assert least_of(FORCE, one) > 0
    assert text.startswith("these limits clash: rms of shaking_force.x at most 2.9 N and ")
    assert " and rms of shaking_force.y at most 26 % of before; " in text
    assert "drive_torque" not in text
    assert text.endswith(" while the other is kept")
    assert told_number(text) == pytest.approx(least_of(x.objective, y), rel=1e-3)


def test_mass_that_is_lacking_is_named() -> None:
    """10 g in all cannot do it, 900 g can."""
    wish = limit("shaking_force", "rms", ratio=0.6)
    assert least_of(FORCE, wish) > 0
    text = refusal(wish, added_mass=0.01)
    assert "rms of shaking_force at most 60 % of before" in text
    assert "added mass at most 10 g" in text
    assert "can become" in text


def test_a_plan_that_contradicts_itself() -> None:
    given = AddedMass("crank", "A", Weight("point", 0.05, mass=0.5))
    plan = Balance(masses=(given, given), objectives=(FORCE,), added_mass=0.7)
    with pytest.raises(UsageError, match="added mass at most 700 g; allow more of it"):
        eq.balance(MACHINE, plan)
