"""What is made of a record: quantities with a stiffness, notes, arguments that are refused."""

from __future__ import annotations

from dataclasses import astuple
from itertools import pairwise
from math import log, pi, sqrt
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import equipoise as eq
from equipoise.measured.decay import _on_methods, _on_record
from equipoise.measured.fits import FittedValue
from support.refusals import refused
from support.sentences import notes_by
from unit.measured.samples import OMEGA, held, noisy, simulated

NAMES = [
    "damped_angular_frequency",
    "natural_angular_frequency",
    "damped_frequency",
    "natural_frequency",
    "damping_ratio",
    "logarithmic_decrement",
    "decay_rate",
    "coulomb_displacement",
]


def test_quantities_follow_60_to_62() -> None:
    """From slope n, intercept m and beta alone, by both methods."""
    stiffness = 1000.0
    decay = eq.measured.identify_decay(simulated(noise=0.005), stiffness)
    for method in (decay.by_line, decay.by_record):
        beta = method["damped_angular_frequency"].value
        n = np.exp(-method["logarithmic_decrement"].value / 2)
        mass = stiffness / (beta**2 * ((log(n) / pi) ** 2 + 1))
        assert method["mass"].value == pytest.approx(mass, rel=1e-12)
        damping = -2 / pi * mass * beta * log(n)
        assert method["viscous_damping"].value == pytest.approx(damping, rel=1e-12)
        ratio = damping / (2 * sqrt(stiffness * mass))
        assert method["damping_ratio"].value == pytest.approx(ratio, rel=1e-12)
        assert method["natural_frequency"].value == pytest.approx(sqrt(stiffness / mass) / 2 / pi)
        assert method["decay_rate"].value == pytest.approx(damping / 2 / mass, rel=1e-12)
    n, m = decay.line["slope"].value, decay.line["intercept"].value
    force = -m * stiffness / (2 * (1 + n))
    assert decay.by_line["coulomb_force"].value == pytest.approx(force, rel=1e-12)


def test_names_by_kind() -> None:
    record = simulated(noise=0.005)
    assert list(eq.measured.identify_decay(record).by_record) == NAMES
    lengths = eq.measured.identify_decay(record, 1.0)
    assert list(lengths.by_line)[8:] == ["mass", "viscous_damping", "coulomb_force"]
    angles = eq.measured.identify_decay(record, 1.0, arm=2.0)
    assert list(angles.by_line)[8:] == ["inertia", "viscous_damping", "coulomb_torque"]


def test_an_arm_makes_angles_of_lengths() -> None:
    record = simulated(noise=0.005)
    turned = eq.measured.Record(record.time, record.displacement / 1.5, "angle")
    by_arm = eq.measured.identify_decay(record, 200.0, arm=1.5, spring_arm=2.0)
    by_angle = eq.measured.identify_decay(turned, 800.0)
    assert by_arm.stiffness == 800
    assert by_arm.kind == by_angle.kind == "angle"
    assert by_arm.record.unit == "rad"
    for name, quantity in by_angle.by_record.items():
        assert by_arm.by_record[name].value == pytest.approx(quantity.value, rel=1e-9)


def test_intervals_of_what_follows_from_others() -> None:
    """Twice the decrement has twice the interval; inertia is as uncertain as frequency squared."""
    decay = eq.measured.identify_decay(simulated(noise=0.005), 1000.0)
    for method in (decay.by_line, decay.by_record):
        relative = {name: (q.high - q.low) / q.value for name, q in method.items() if q.low}
        assert relative["mass"] == pytest.approx(2 * relative["natural_frequency"], rel=1e-6)
        assert relative["coulomb_force"] == pytest.approx(relative["coulomb_displacement"])
        for quantity in method.values():
            assert quantity.low < quantity.value < quantity.high


def test_to_dict() -> None:
    decay = eq.measured.identify_decay(simulated(noise=0.005), 1000.0)
    plain = decay.to_dict()
    assert plain["kind"] == "length"
    assert plain["samples"] == 1000
    assert plain["duration"] == pytest.approx(5.0)
    assert plain["stiffness"] == 1000
    heights = plain["half_swings"]["heights"]
    assert len(heights) == len(plain["half_swings"]["turning_points"]["time"]) - 1
    assert all(after < before for before, after in pairwise(heights))
    assert plain["by_record"]["mass"] == decay.by_record["mass"].to_dict()
    assert plain["notes"] == list(decay.notes)


def test_the_fitted_motion() -> None:
    record = simulated(noise=0.01, center=2.0)
    decay = eq.measured.identify_decay(record)
    exact = simulated(center=2.0).displacement
    part = record.time < decay.turns.time[-1]
    assert np.max(np.abs(decay.fitted(record.time) - exact)[part]) < 0.003
    assert decay.whole.motion.center == pytest.approx(2.0, abs=0.002)
    assert decay.whole.rms == pytest.approx(0.01, rel=0.1)
    assert decay.turns.noise == pytest.approx(0.01, rel=0.1)


# -- notes -----------------------------------------------------------------------------------------


def notes(record: eq.measured.Record) -> str:
    return "\n".join(eq.measured.identify_decay(record).notes)


NOTED: dict[str, tuple[dict[str, float], str, str]] = {
    "good": ({"duration": 2.6}, "", " "),
    "no friction": (
        {"duration": 2.6, "coulomb": 0.0},
        "Coulomb friction cannot be told from noise: its interval (whole record)",
        "viscous",
    ),
    "no damping": (
        {"duration": 2.6, "ratio": 0.0},
        "viscous damping cannot be told from noise",
        "Coulomb",
    ),
    "neither from the other": (
        {"duration": 1.3, "ratio": 0.01, "coulomb": 0.005, "noise": 0.04},
        "this record does not tell viscous damping from Coulomb friction",
        "negative",
    ),
    "not by the line": (
        {"duration": 1.3, "ratio": 0.01, "coulomb": 0.005, "noise": 0.01},
        "the line alone cannot tell",
        "negative",
    ),
}


@pytest.mark.parametrize(("values", "said", "unsaid"), NOTED.values(), ids=NOTED)
def test_terms_that_cannot_be_reported(values: dict[str, float], said: str, unsaid: str) -> None:
    """Where a term is lost in the noise it is told, and a good record has no note at all."""
    reported = notes(simulated(**{"noise": 0.005, **values}))
    assert said in reported
    assert unsaid not in reported


def test_parts_that_are_left_out() -> None:
    time = np.linspace(0.0, 8.0, 4000)
    reported = notes(noisy(time, held(time, 1.25)))
    assert "the first 1.25 s, before the largest half-swing, are left out" in reported
    assert "s are left out: the motion has stopped, or swings no more than the noise" in reported


def test_three_half_swings() -> None:
    """One line, no interval; the whole record has them all the same."""
    decay = eq.measured.identify_decay(simulated(duration=0.8, count=100, noise=0.002))
    assert len(decay.turns.heights) == 3
    assert decay.by_line["damping_ratio"].low is None
    assert not decay.by_line["decay_rate"].includes_zero
    assert decay.by_record["damping_ratio"].low is not None
    assert notes_by(_on_record, decay.notes)


def test_a_vibration_that_is_fed() -> None:
    """Growing by 1 % in all, which hardly shows."""
    time = np.linspace(0.0, 6.0, 3000)
    record = eq.measured.Record(time, np.exp(0.002 * time) * np.sin(OMEGA * time))
    reported = notes(record)
    assert "viscous damping comes out negative: something feeds the vibration" in reported
    assert "slope of 1 or more" in reported


def test_a_damping_that_is_neither() -> None:
    """Drag with the square of the speed."""
    time = np.linspace(0.0, 6.0, 3000)

    def pull(_: float, y: Any) -> list[float]:
        return [y[1], -(OMEGA**2) * y[0] - 0.12 * y[1] * abs(y[1])]

    moved = solve_ivp(pull, (0.0, 6.0), [1.0, 0.0], t_eval=time, rtol=1e-9, atol=1e-11).y[0]
    reported = notes(noisy(time, moved, 0.003))
    assert (
        "times their noise: viscous damping and Coulomb friction alone do not describe" in reported
    )
    assert "its intervals are widened for that" in reported


def test_methods_that_contradict_each_other() -> None:
    decay = eq.measured.identify_decay(simulated(noise=0.005))
    frequency = decay.by_record["natural_frequency"]
    assert not list(_on_methods(decay.by_line, decay.by_record))
    moved = FittedValue(*(1.1 * value for value in astuple(frequency)))
    texts = list(_on_methods(decay.by_line, {**decay.by_record, "natural_frequency": moved}))
    assert texts == [
        "line and whole record contradict each other on natural frequency: their intervals have "
        "nothing in common"
    ]
    assert not FittedValue(1.0).apart_from(moved)


# -- refused ---------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("arguments", "expected"),
    [
        ({"stiffness": 0.0}, {"place": "stiffness", "value": 0.0}),
        ({"stiffness": float("nan")}, {"place": "stiffness"}),
        ({"arm": -1.0}, {"place": "arm", "value": -1.0}),
        ({"confidence": 1.0}, {"place": "confidence", "confidence": 1.0}),
        ({"spring_arm": 1.0}, {"place": "spring_arm", "by": "_stiffness"}),
        ({"stiffness": 1.0, "spring_arm": 1.0}, {"place": "spring_arm", "by": "_stiffness"}),
        ({"stiffness": 1.0, "arm": 1.0, "spring_arm": 0.0}, {"place": "spring_arm", "value": 0.0}),
        ({"kind": "angle", "arm": 1.0}, {"place": "arm"}),
    ],
)
def test_arguments_that_cannot_be_used(arguments: dict[str, Any], expected: dict[str, Any]) -> None:
    options = {name: value for name, value in arguments.items() if name != "kind"}
    record = simulated(kind=arguments.get("kind", "length"))
    with refused(eq.EquipoiseError, **expected):
        eq.measured.identify_decay(record, **options)
