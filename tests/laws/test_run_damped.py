"""Runs that dampers and stops bring to rest, against closed solutions."""

from __future__ import annotations

from dataclasses import replace
from math import ceil, exp, log, pi, sqrt, tan

import numpy as np
import pytest

import equipoise as eq
from equipoise.errors import ModelError
from equipoise.mechanism.parts.dampers import Damper
from equipoise.mechanism.parts.torsion_dampers import TorsionDamper
from equipoise.running.blocks import verdict
from equipoise.running.integration import AT_EASE
from support.refusals import refused

MASS, ARM, OWN, GRAVITY = 2.0, 0.3, 0.05, 9.81
INERTIA = OWN + MASS * ARM**2
WEIGHT = MASS * GRAVITY * ARM


def pendulum(damping: float) -> eq.Machine:
    """One link that hangs straight down at crank angle -90 deg, with a damper at its pivot."""
    link = eq.Link({"A": (0.0, 0.0), "B": (1.0, 0.0)}, MASS, (ARM, 0.0), OWN)
    return eq.Machine(
        "pendulum",
        eq.Drive("crank", 10.0),
        {"A": (0.0, 0.0)},
        {"crank": link},
        gravity=(0.0, -GRAVITY),
        torsion_dampers=(TorsionDamper("crank", damping=damping),),
    )


def test_a_damped_pendulum_ends_at_rest_where_it_hangs() -> None:
    """Its swings shrink by the logarithmic decrement, until one is `AT_EASE` of the widest."""
    share, start = 0.2, 0.01  # so small that a swing takes as long as a small one to 6e-6 of it
    natural = sqrt(WEIGHT / INERTIA)
    run = eq.run(pendulum(2 * share * natural * INERTIA), speed=0.0, angle=start - pi / 2)
    shrinks = pi * share / sqrt(1 - share**2)
    swings = ceil(log(1 / AT_EASE) / shrinks) + 1
    half = pi / (natural * sqrt(1 - share**2))
    assert run.end.kind == "standstill"
    assert [event.kind for event in run.events[:-1]] == ["reversal"] * (swings - 1)
    assert run.end.time == pytest.approx(swings * half, rel=1e-5)
    left = start * exp(-shrinks * swings)
    assert abs(run.end.crank_angle + pi / 2) <= 1.1 * left
    assert "at crank angle 270" in verdict(run)


def test_a_pendulum_without_damping_never_comes_to_rest(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("equipoise.running.integration.MOST_REVERSALS", 6)
    run = eq.run(pendulum(0.0), speed=0.0, angle=1e-3 - pi / 2)
    assert run.end.kind == "reversal"
    assert "turned back 6 times" in verdict(run)


def test_a_crank_whose_weight_is_held_by_rounding_alone_stands_still() -> None:
    """Upright, where cos(pi / 2) is not quite 0."""
    run = eq.run(pendulum(0.1), speed=0.0, angle=pi / 2)
    assert run.end.kind == "standstill" and run.end.time == 0.0


@pytest.mark.exhaustive(but=["500.0"])
@pytest.mark.parametrize("damping", [50.0, 500.0])
def test_a_strong_damper_lets_a_pendulum_creep_down(damping: float) -> None:
    """Without inertia c phi. = -W sin(phi), so that tan(phi / 2) falls exponentially; inertia
    changes that by W J / c^2 of it, and its start by as much.
    """
    begin = 2.0
    run = eq.run(pendulum(damping), "30 s", speed=0.0, angle=begin - pi / 2)
    assert run.end.kind == "time"
    angle = run.crank_angle + pi / 2
    wanted = 2 * np.arctan(tan(begin / 2) * np.exp(-WEIGHT / damping * run.time))
    assert np.max(np.abs(angle - wanted)) < 3 * WEIGHT * INERTIA / damping**2
    assert run.energy_error < 1e-9


def test_a_damper_at_a_point_that_stands_still_is_called_a_damper() -> None:
    machine = eq.load("yamashita-1")
    frame = next(iter(set(machine.frame) & set(machine.links["rocker"].points)))
    other = next(point for point in machine.frame if point != frame)
    with refused(ModelError, "dampers[1].point"):
        replace(machine, dampers=(Damper("rocker", frame, other, damping=1.0),), balance=None)
