"""Machines in which nothing moves but rotors: exciters, or rotors out of balance."""

from __future__ import annotations

from dataclasses import replace

import pytest

import equipoise as eq
from equipoise.balancing.advice import advise
from equipoise.balancing.outcome import benefit_sentences
from equipoise.mechanism.parts.balance import Balance, Objective
from equipoise.results.blocks import Text
from equipoise.results.rotors import rotor_sentence, unbalances
from equipoise.vibration.blocks import analysis_headline, response_headline

SIEVE = """
schema = 1
title = "Vibrating sieve"

[drive]
link = "shaft"
speed = "900 rpm"

[frame]
points.A = ["0 mm", "0 mm"]

[links.shaft]
points.A = ["0 mm", "0 mm"]
mass = "22 kg"
center_of_mass = ["{arm} mm", "0 mm"]
inertia = "0.05 kg m^2"

[support]
mass = "180 kg"
center_of_mass = ["0 mm", "-30 mm"]
inertia = "22 kg m^2"

[support.mounts.up]
point = ["-500 mm", "-200 mm"]
direction = "90 deg"
stiffness = "45 N/mm"
damping = "200 N s/m"

[support.mounts.across]
point = ["500 mm", "-200 mm"]
direction = "0 deg"
stiffness = "30 N/mm"
damping = "200 N s/m"

[support.mounts.right]
point = ["500 mm", "-200 mm"]
direction = "90 deg"
stiffness = "45 N/mm"
damping = "200 N s/m"

[support.gauges.deck]
point = ["0 mm", "100 mm"]
"""


def sieve(arm: float) -> eq.Machine:
    """A sieve whose shaft has its centre of mass so many mm from its pivot."""
    machine = eq.loads(SIEVE.replace("{arm}", str(arm)))
    assert isinstance(machine, eq.Machine)
    return machine


def test_an_exciter_is_not_robbed_of_its_unbalance() -> None:
    machine = sieve(14)
    advice = advise(machine)
    assert not advice.helps
    words = " ".join(benefit_sentences(advice))
    assert rotor_sentence(machine) in words
    assert "308" in rotor_sentence(machine)  # 22 kg at 14 mm, in kg mm
    assert "would be added" not in words


def test_the_vibration_of_an_exciter_is_no_verdict() -> None:
    machine = sieve(14)
    for blocks in (
        analysis_headline(eq.analyze(machine), alone=True),
        response_headline(eq.respond(machine), alone=True),
    ):
        texts = [block.text for block in blocks if isinstance(block, Text)]
        assert any(rotor_sentence(machine) in text for text in texts)
        assert not any("ISO 20816" in text for text in texts)


def test_what_was_asked_for_is_done_to_an_exciter_too() -> None:
    wish = Balance(objectives=(Objective("shaking_force"),))
    assert advise(sieve(14).with_balance(wish)).helps


def test_a_rotor_that_is_balanced_well_enough_is_judged_as_any_machine() -> None:
    # Grade G 6.3 at 94.25 rad/s ends at 0.0668 mm.
    assert not unbalances(sieve(0.066)) and unbalances(sieve(0.068))
    faster = sieve(0.066)
    faster = replace(faster, drive=replace(faster.drive, speeds=(90.0, 100.0)))
    assert unbalances(faster)


@pytest.mark.parametrize("name", ["yamashita-rig", "balance-shafts", "riding-transplanter"])
def test_linkages_are_no_rotors(name: str) -> None:
    assert not unbalances(eq.load(name))
