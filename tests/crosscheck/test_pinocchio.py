"""Shaking force, shaking moment and drive torque against Pinocchio's recursive Newton-Euler."""

from __future__ import annotations

import pytest

from support import pinocchio_engine
from support.analyses import (
    PLANTED,
    RANDOM,
    example_names,
    example_subject,
    planted_subject,
    random_subject,
)
from support.engines import same_totals


@pytest.mark.parametrize(("kind", "seed"), RANDOM)
def test_random_machine(kind: str, seed: int) -> None:
    same_totals(random_subject(kind, seed), pinocchio_engine.totals)


@pytest.mark.parametrize(("kind", "seed"), PLANTED)
def test_random_machine_in_soil(kind: str, seed: int) -> None:
    same_totals(planted_subject(kind, seed), pinocchio_engine.totals)


@pytest.mark.parametrize("name", example_names())
def test_example(name: str) -> None:
    same_totals(example_subject(name), pinocchio_engine.totals)
